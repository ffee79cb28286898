/* SPDX-License-Identifier: BSD-3-Clause */
/* The rows of the misuse table: calls, definitions and their members. A new public function is a
 * CALL and a row; a new def a define_ function and a list of members. */
#ifndef SE3D_TESTS_MISUSE_CALLS_H
#define SE3D_TESTS_MISUSE_CALLS_H

#include "misuse/misuse_batch.h"
#include "misuse/misuse_definitions.h"
#include "misuse/misuse_elements.h"
#include "misuse/misuse_events.h"
#include "misuse/misuse_fields.h"
#include "misuse/misuse_inputs.h"
#include "misuse/misuse_particles.h"
#include "misuse/misuse_roads.h"
#include "misuse/misuse_world.h"

static void define_summary(arguments *a)
{
    a->storage.struct_size = sizeof(se3d_check_summary);
}

CALL(body_get_position, a->system, a->use.body, a->out[0])
CALL(body_get_velocity, a->system, a->use.body, a->out[0])
CALL(body_get_angular_velocity, a->system, a->use.body, a->out[0])
CALL(body_get_acceleration, a->system, a->use.body, a->out[0])
CALL(body_get_angular_acceleration, a->system, a->use.body, a->out[0])
CALL(body_get_orientation, a->system, a->use.body, a->out[0])
CALL(body_get_motion, a->system, a->use.body, a->out[0])
CALL(body_set_position, a->system, a->use.body, a->in)
CALL(body_set_velocity, a->system, a->use.body, a->in)
CALL(body_set_angular_velocity, a->system, a->use.body, a->in)
CALL(body_set_orientation, a->system, a->use.body, a->in)
CALL(body_create, a->system, a->def, a->out[0])
CALL(body_find, a->system, a->text, a->out[0])
CALL(body_get_name, a->system, a->use.body, a->out[0])
CALL(body_get_fixed, a->system, a->use.body, a->out[0])
CALL(body_get_held, a->system, a->use.body, a->out[0])
CALL(body_set_held, a->system, a->use.body, 1)
CALL(body_get_point, a->system, a->use.body, a->in, a->out[0])
CALL(body_get_mass, a->system, a->use.body, a->out[0], a->out[1])
CALL(marker_create, a->system, a->def, a->out[0])
CALL(marker_destroy, a->system, a->use.marker)
CALL(marker_get_name, a->system, a->use.marker, a->out[0])
CALL(marker_get_position, a->system, a->use.marker, a->out[0])
CALL(marker_get_velocity, a->system, a->use.marker, a->out[0])
CALL(marker_get_acceleration, a->system, a->use.marker, a->out[0])
CALL(marker_get_orientation, a->system, a->use.marker, a->out[0])
CALL(marker_get_body, a->system, a->use.marker, a->out[0])
CALL(primitive_create, a->system, a->def, a->out[0])
CALL(user_constraint_create, a->system, a->def, a->out[0])
CALL(constraint_destroy, a->system, a->use.driver)
CALL(constraint_find, a->system, a->text, a->out[0])
CALL(constraint_get_name, a->system, a->use.pin, a->out[0])
CALL(constraint_get_type, a->system, a->use.pin, a->out[0])
CALL(constraint_count_equations, a->system, a->use.pin, a->out[0])
CALL(constraint_count_bodies, a->system, a->use.pin, a->out[0])
CALL(constraint_get_multipliers, a->system, a->use.pin, a->out[0])
CALL(constraint_get_equation_name, a->system, a->use.pin, a->index, a->out[0])
CALL(constraint_get_body, a->system, a->use.pin, a->index, a->out[0])
CALL(constraint_eval, a->system, a->use.pin, SE3D_FORMULATION_RP, a->out[0], a->out[1], a->out[2])
CALL(constraint_eval_jacobian, a->system, a->use.pin, SE3D_FORMULATION_RP, a->index, a->out[0],
     a->out[1])
CALL(constraint_get_reaction, a->system, a->use.pin, a->out[0], a->out[1])
CALL(constraint_get_reaction_at, a->system, a->use.pin, a->index, a->in, (se3d_marker){0, 0},
     a->out[0])
CALL(driver_get_value, a->system, a->use.driver, a->out[0])
CALL(driver_get_effort, a->system, a->use.driver, a->out[0])
CALL(driver_create, a->system, a->def, a->out[0])
CALL(joint_get_coordinate, a->system, a->use.pin, SE3D_JOINT_COORDINATE_ANGLE, a->out[0], a->out[1],
     a->out[2])
CALL(joint_set_break, a->system, a->use.pin, a->number, 0.0)
CALL(joint_set_broken, a->system, a->use.pin, 0)
CALL(joint_get_broken, a->system, a->use.pin, a->out[0])
/* What the lists create: the call and its definition. */
#define CREATE_WITH(function, name)                                                                \
    CALL(function, a->system, a->def, a->out[0])                                                   \
    static void define_##name(arguments *a)                                                        \
    {                                                                                              \
        const site at = site_of(a);                                                                \
        fill_##name(&at, &a->storage);                                                             \
    }
#define CREATE_JOINT(type, flags) CREATE_WITH(joint_create_##type, type)
#define CREATE_FORCE(name, def)   CREATE_WITH(force_create_##name, name)
#define DEFINE_VARIANT(variant, name)                                                              \
    static void define_##variant(arguments *a)                                                     \
    {                                                                                              \
        const site at = site_of(a);                                                                \
        fill_##variant(&at, &a->storage);                                                          \
    }
SE3DI_JOINT_LIST(CREATE_JOINT)
FORCE_LIST(CREATE_FORCE)
FORCE_VARIANT_LIST(DEFINE_VARIANT)

CALL(joint_create_coupler, a->system, a->def, a->out[0])
CALL(joint_create_rack_pinion, a->system, NULL, a->use.pin, a->use.slide, a->number, a->out[0])
CALL(force_destroy, a->system, a->use.force)
CALL(force_find, a->system, a->text, a->out[0])
CALL(force_get_name, a->system, a->use.force, a->out[0])
CALL(force_get_type, a->system, a->use.force, a->out[0])
CALL(force_get_state, a->system, a->use.force, a->out[0], a->out[1], a->out[2])
CALL(force_get_power, a->system, a->use.force, a->out[0], a->out[1], a->out[2])
CALL(force_get_wrench, a->system, a->use.force, a->index, a->out[0])
CALL(function_create, a->system, a->def, a->out[0])
CALL(function_create_expression, a->system, "2*t", a->out[0])
CALL(function_destroy, a->system, a->use.function)
CALL(function_eval, a->system, a->use.function, a->in, a->out[0])
static se3d_status call_solver_create(arguments *a)
{
    se3d_status status = se3d_solver_create(a->system, a->def, a->out[0]);
    se3d_solver *made = NULL;
    if (status >= 0) {
        memcpy(&made, a->out[0], sizeof made);
        se3d_solver_destroy(made);
    }
    return status;
}
CALL(solver_run, a->solver, a->number)
CALL(solver_set_shown, a->solver, (int32_t)a->index)
/* Of two empty systems: those of the arguments have nothing that could be followed. */
static se3d_status call_solver_follow(arguments *a)
{
    se3d_system *systems[2] = {NULL, NULL};
    se3d_solver *solvers[2] = {NULL, NULL};
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_KINEMATICS;
    for (int k = 0; k < 2 && a->solver; ++k) {
        CHECK(!se3d_system_create(NULL, &systems[k]));
        CHECK(!se3d_solver_create(systems[k], &def, &solvers[k]));
        CHECK(!se3d_solver_run(solvers[k], 0.0));
    }
    const se3d_status status = se3d_solver_follow(solvers[0], solvers[1]);
    for (int k = 0; k < 2; ++k) {
        se3d_solver_destroy(solvers[k]);
        se3d_system_destroy(systems[k]);
    }
    return status;
}
CALL(solver_step, a->solver, a->number)
CALL(solver_get_stats, a->solver, a->out[0])
CALL(solver_get_start_change, a->solver, a->out[0])
CALL(solver_get_method, a->solver, a->out[0])
CALL(solver_get_formulation, a->solver, a->out[0])
CALL(solver_get_tolerance, a->solver, a->out[0])
CALL(solver_get_step, a->solver, a->out[0])
CALL(solver_get_switch, a->solver, a->out[0], a->out[1])
CALL(solver_get_foresight, a->solver, a->out[0])
CALL(solver_write, a->solver, NULL, 0, a->out[0])
static se3d_status call_solver_read(arguments *a)
{
    static unsigned char bytes[10000];
    size_t size = 0;
    CHECK(!a->solver || se3d_solver_write(a->solver, bytes, sizeof bytes, &size) <= 0);
    return se3d_solver_read(a->solver, a->in ? bytes : NULL, size);
}
static se3d_status call_check_create(arguments *a)
{
    se3d_status status = se3d_check_create(a->system, a->out[0]);
    se3d_check *made = NULL;
    if (status >= 0) {
        memcpy(&made, a->out[0], sizeof made);
        se3d_check_destroy(made);
    }
    return status;
}
CALL(check_get_summary, a->check, (void *)&a->storage)
CALL(check_get_message, a->check, a->index, a->out[0])
static se3d_status call_snapshot_create(arguments *a)
{
    se3d_status status = se3d_snapshot_create(a->system, a->out[0]);
    se3d_snapshot *made = NULL;
    if (status >= 0) {
        memcpy(&made, a->out[0], sizeof made);
        se3d_snapshot_destroy(made);
    }
    return status;
}
CALL(snapshot_restore, a->snapshot, a->system)
CALL(snapshot_write, a->snapshot, NULL, 0, a->out[0])
static se3d_status call_snapshot_read(arguments *a)
{
    static unsigned char bytes[20000];
    size_t size = 0;
    se3d_snapshot *made = NULL, *read = NULL;
    CHECK(!a->system || !se3d_snapshot_create(a->system, &made));
    CHECK(!a->system || !se3d_snapshot_write(made, bytes, sizeof bytes, &size));
    se3d_snapshot_destroy(made);
    const se3d_status status = se3d_snapshot_read(a->system, a->in ? bytes : NULL, size, a->out[0]);
    if (status >= 0) {
        memcpy(&read, a->out[0], sizeof read);
        se3d_snapshot_destroy(read);
    }
    return status;
}
static se3d_status call_system_clone(arguments *a)
{
    se3d_status status = se3d_system_clone(a->system, a->out[0]);
    se3d_system *made = NULL;
    if (status >= 0) {
        memcpy(&made, a->out[0], sizeof made);
        se3d_system_destroy(made);
    }
    return status;
}
CALL(system_set_gravity, a->system, a->in)
CALL(system_get_gravity, a->system, a->out[0])
CALL(system_set_log, a->system, NULL, NULL)
CALL(system_set_kept, a->system, 0)
CALL(system_set_replacing, a->system, 0)
CALL(system_set_time, a->system, a->number)
CALL(system_get_time, a->system, a->out[0])
CALL(system_get_ground, a->system, a->out[0])
CALL(system_get_body, a->system, a->index, a->out[0])
CALL(system_get_marker, a->system, a->index, a->out[0])
CALL(system_get_constraint, a->system, a->index, a->out[0])
CALL(system_get_force, a->system, a->index, a->out[0])
CALL(system_get_wheel, a->system, a->index, a->out[0])
CALL(system_get_road, a->system, a->index, a->out[0])
CALL(road_create, a->system, a->def, a->out[0])
CALL(road_destroy, a->system, a->use.road)
CALL(road_get_name, a->system, a->use.road, a->out[0])
CALL(road_find, a->system, a->text, a->out[0])
CALL(wheel_find, a->system, a->text, a->out[0])
CALL(state_set_size, a->system, a->use.state, a->number)
CALL(road_get_height, a->system, a->use.road, a->number, 1.0, a->out[0])
CALL(state_create, a->system, a->def, a->out[0])
CALL(state_destroy, a->system, a->use.state)
CALL(state_find, a->system, a->text ? "taken state" : NULL, a->out[0])
CALL(state_set_rate, a->system, a->use.state, a->use.function)
CALL(state_set_output, a->system, a->use.state, a->use.function)
CALL(state_set_input, a->system, a->use.state, a->use.function)
CALL(state_set_value, a->system, a->use.state, a->number)
CALL(state_get_value, a->system, a->use.state, (int32_t)a->index, a->out[0])
CALL(state_get_rate, a->system, a->use.state, a->out[0])
CALL(wheel_create, a->system, a->def, a->out[0])
CALL(wheel_destroy, a->system, a->use.wheel)
CALL(wheel_get_name, a->system, a->use.wheel, a->out[0])
CALL(wheel_get_measures, a->system, a->use.wheel, a->index, SE3D_WHEEL_MEASURES, a->out[0])
CALL(system_get_energy, a->system, a->out[0])
CALL(system_get_violation, a->system, a->out[0])
CALL(expression_eval, a->expression, a->in, a->out[0])
CALL(expression_eval_time, a->expression, a->in, a->out[0])
CALL(expression_eval_gradient, a->expression, a->in, a->out[0], a->out[1])

/* ---- functions whose cases do not fit the letters ---- */

static se3d_status check_body_destroy(arguments *a)
{
    CHECK(se3d_body_destroy(NULL, a->use.body) == SE3D_ERR_NULL);
    CHECK(se3d_body_destroy(a->system, a->use.body) == SE3D_ERR_IN_USE);
    CHECK(se3d_body_destroy(a->system, ground_of(a)) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_body_destroy(a->system, (se3d_body){0, 0}) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_constraint_destroy(a->system, a->use.pin) == SE3D_ERR_IN_USE);
    se3d_body_def def = body_def("short-lived");
    se3d_body body;
    CHECK(!se3d_body_create(a->system, &def, &body));
    CHECK(!se3d_body_destroy(a->system, body));
    CHECK(se3d_body_destroy(a->system, body) == SE3D_ERR_STALE_HANDLE);
    return SE3D_OK;
}

static se3d_status check_body_set_mass(arguments *a)
{
    const double good[6] = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0}, flat[6] = {1.0, 1.0, 5.0, 0.0, 0.0, 0.0};
    const double masses[4] = {0.0, -1.0, (double)NAN, (double)INFINITY};
    CHECK(se3d_body_set_mass(NULL, a->use.body, 1.0, good) == SE3D_ERR_NULL);
    CHECK(se3d_body_set_mass(a->system, a->use.body, 1.0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_body_set_mass(a->system, (se3d_body){0, 0}, 1.0, good) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_body_set_mass(a->system, a->use.body, 1.0, flat) == SE3D_ERR_INVALID_ARGUMENT);
    for (int k = 0; k < 4; ++k) {
        CHECK(se3d_body_set_mass(a->system, a->use.body, masses[k], good) ==
              SE3D_ERR_INVALID_ARGUMENT);
    }
    CHECK_CONTAINS(se3d_system_get_error(a->system), "mass = inf");
    double mass = 0.0;
    CHECK(!se3d_body_get_mass(a->system, a->use.body, &mass, NULL) && mass == 2.0);
    return se3d_body_set_mass(a->system, a->use.body, 3.0, good);
}

static se3d_status check_body_get_all(arguments *a)
{
    size_t count = se3d_system_count_bodies(a->system);
    CHECK(se3d_body_get_all(NULL, count, a->out[0], NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_body_get_all(a->system, count + 1, a->out[0], NULL, NULL, NULL) ==
          SE3D_ERR_INVALID_ARGUMENT);
    return se3d_body_get_all(a->system, count, a->out[0], a->out[1], a->out[2], a->out[3]);
}

static se3d_status check_body_set_all(arguments *a)
{
    size_t count = se3d_system_count_bodies(a->system);
    double r[6] = {0.0}, bad[6] = {0.0, 0.0, 0.0, 0.0, (double)NAN, 0.0};
    uint64_t hash = se3d_system_hash(a->system);
    CHECK(se3d_body_set_all(NULL, count, r, NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_body_set_all(a->system, count - 1, r, NULL, NULL, NULL) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_body_set_all(a->system, count, bad, NULL, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_body_set_all(a->system, count, NULL, NULL, bad, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_body_set_all(a->system, count, NULL, NULL, NULL, bad) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "finite");
    CHECK(se3d_system_hash(a->system) == hash);
    return se3d_body_set_all(a->system, count, r, NULL, NULL, NULL);
}

static se3d_status check_joint_def_set_frame(arguments *a)
{
    const double at[3] = {0.0, 0.0, 0.0}, z[3] = {0.0, 0.0, 1.0}, bad[3] = {0.0, (double)NAN, 1.0};
    se3d_joint_def def = se3d_joint_def_default();
    const se3d_system *s = a->system;
    CHECK(se3d_joint_def_set_frame(s, &def, at, z, NULL) == SE3D_ERR_STALE_HANDLE);
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    CHECK(se3d_joint_def_set_frame(NULL, &def, at, z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(s, NULL, at, z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(s, &def, NULL, z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(s, &def, at, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(s, &def, bad, z, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(s, &def, at, bad, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(s, &def, at, at, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(s, &def, at, z, bad) == SE3D_ERR_INVALID_ARGUMENT);
    return se3d_joint_def_set_frame(s, &def, at, z, NULL);
}

static se3d_status check_joint_create_gear(arguments *a)
{
    se3d_constraint second, gear = {7, 7};
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    CHECK(!se3d_joint_create_revolute(a->system, &def, &second));
    size_t count = se3d_system_count_constraints(a->system);
    CHECK(se3d_joint_create_gear(NULL, NULL, a->use.pin, second, 2.0, &gear) == SE3D_ERR_NULL);
    CHECK(gear.index1 == 0 && gear.generation == 0);
    CHECK(se3d_joint_create_gear(a->system, NULL, a->use.pin, second, 2.0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_create_gear(a->system, NULL, (se3d_constraint){0, 0}, second, 2.0, &gear) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_joint_create_gear(a->system, NULL, a->use.slide, second, 2.0, &gear) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_create_gear(a->system, NULL, a->use.pin, second, (double)NAN, &gear) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_create_gear(a->system, "taken", a->use.pin, second, 2.0, &gear) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_system_count_constraints(a->system) == count);
    return se3d_joint_create_gear(a->system, NULL, a->use.pin, second, 2.0, &gear);
}

static se3d_status check_system_create(arguments *a)
{
    se3d_system *system = a->system;
    se3d_system_def def = se3d_system_def_default();
    CHECK(se3d_system_create(NULL, NULL) == SE3D_ERR_NULL);
    def.time = (double)NAN;
    CHECK(se3d_system_create(&def, &system) == SE3D_ERR_INVALID_ARGUMENT && !system);
    def = se3d_system_def_default();
    def.gravity[1] = (double)INFINITY;
    CHECK(se3d_system_create(&def, &system) == SE3D_ERR_INVALID_ARGUMENT && !system);
    def = se3d_system_def_default();
    def.struct_size = 0;
    CHECK(se3d_system_create(&def, &system) == SE3D_ERR_INVALID_ARGUMENT && !system);
    CHECK(!se3d_system_create(NULL, &system));
    se3d_system_destroy(system);
    return SE3D_OK;
}

static se3d_status check_describe_left_out(arguments *a)
{
    char text[4] = "abc";
    CHECK(se3d_system_describe_left_out(NULL, text, sizeof text) == SE3D_ERR_NULL);
    CHECK(se3d_system_describe_left_out(a->system, NULL, 4) == SE3D_ERR_NULL);
    CHECK(se3d_system_describe_left_out(a->system, text, 0) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(text[0] == 'a');
    CHECK(!se3d_system_describe_left_out(a->system, text, sizeof text) && text[0] == '\0');
    return SE3D_OK;
}

static se3d_status check_system_get_work(arguments *a)
{
    se3d_work work;
    memset(&work, 0, sizeof work);
    CHECK(se3d_system_get_work(NULL, &work) == SE3D_ERR_NULL);
    CHECK(se3d_system_get_work(a->system, NULL) == SE3D_ERR_NULL);
    return SE3D_OK;
}

static se3d_status check_system_set_gravity_function(arguments *a)
{
    se3d_function g[3] = {{0, 0}, {0, 0}, a->use.function};
    CHECK(se3d_system_set_gravity_function(NULL, g) == SE3D_ERR_NULL);
    CHECK(se3d_system_set_gravity_function(a->system, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_set_gravity_function(a->system, g));
    CHECK(se3d_function_destroy(a->system, g[2]) == SE3D_ERR_IN_USE);
    g[1].index1 = 77;
    CHECK(se3d_system_set_gravity_function(a->system, g) == SE3D_ERR_STALE_HANDLE);
    return SE3D_OK;
}

static se3d_status check_expression_create(arguments *a)
{
    se3d_expression *expression = a->expression;
    se3d_expression_error error;
    se3d_expression_def def = se3d_expression_def_default();
    CHECK(se3d_expression_create(NULL, &expression, &error) == SE3D_ERR_NULL && !expression);
    CHECK(se3d_expression_create(&def, &expression, &error) == SE3D_ERR_NULL && !expression);
    def.text = "1+";
    CHECK(se3d_expression_create(&def, NULL, &error) == SE3D_ERR_NULL);
    CHECK(se3d_expression_create(&def, &expression, &error) == SE3D_ERR_EXPRESSION && !expression);
    CHECK(error.column == 3 && error.message[0]);
    def.struct_size = 0;
    CHECK(se3d_expression_create(&def, &expression, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    return SE3D_OK;
}

static se3d_status destroying_null_is_fine(arguments *a)
{
    (void)a;
    se3d_system_destroy(NULL);
    se3d_solver_destroy(NULL);
    se3d_snapshot_destroy(NULL);
    se3d_check_destroy(NULL);
    se3d_expression_destroy(NULL);
    return SE3D_OK;
}

static se3d_status counting_null_gives_zero(arguments *a)
{
    CHECK(se3d_system_count_bodies(NULL) == 0 && se3d_system_count_bodies(a->system) == 2);
    CHECK(se3d_system_count_markers(NULL) == 0 && se3d_system_count_markers(a->system) == 1);
    CHECK(se3d_system_count_constraints(NULL) == 0 &&
          se3d_system_count_constraints(a->system) == 4);
    CHECK(se3d_system_count_forces(NULL) == 0 && se3d_system_count_forces(a->system) == 1);
    CHECK(se3d_system_count_states(NULL) == 0 && se3d_system_count_states(a->system) == 1);
    CHECK(se3d_system_count_wheels(NULL) == 0 && se3d_system_count_wheels(a->system) == 1);
    CHECK(se3d_system_count_roads(NULL) == 0 && se3d_system_count_roads(a->system) == 1);
    CHECK(se3d_check_count_messages(NULL) == 0 && se3d_check_count_messages(a->check) > 0);
    CHECK(se3d_system_hash(NULL) == 0 && se3d_system_hash(a->system) != 0);
    CHECK(se3d_expression_is_constant(NULL) == 0);
    CHECK(se3d_system_is_busy(NULL) == 0 && se3d_system_is_busy(a->system) == 0);
    return SE3D_OK;
}

static se3d_status motions_reject_null(arguments *a)
{
    const se3d_body_motion m = {.p = {1.0, 0.0, 0.0, 0.0}};
    const double x[3] = {0.0, 0.0, 0.0};
    double out[18] = {0.0};
    (void)a;
    CHECK(se3d_motion_get_rotation(NULL, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_rotation(&m, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_point(NULL, x, out, out, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_point(&m, NULL, out, out, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_point(&m, x, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_motion_get_jacobian(NULL, x, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_jacobian(&m, NULL, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_get_jacobian(&m, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_force(NULL, x, x, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_force(&m, NULL, x, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_force(&m, x, NULL, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_force(&m, x, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_torque(NULL, x, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_torque(&m, NULL, out) == SE3D_ERR_NULL);
    CHECK(se3d_motion_add_torque(&m, x, NULL) == SE3D_ERR_NULL);
    return SE3D_OK;
}

static se3d_status texts_are_never_null(arguments *a)
{
    CHECK_CONTAINS(se3d_status_get_text(SE3D_OK), "success");
    CHECK(se3d_status_get_text((se3d_status)-99) && se3d_status_get_text((se3d_status)99));
    CHECK(se3d_text_get_character(NULL) == 0 && se3d_text_get_character("") == 0);
    CHECK_CONTAINS(se3d_version_get_text(), ".");
    CHECK(se3d_version_number() == SE3D_VERSION_NUMBER && SE3D_VERSION_NUMBER >= 1000);
    CHECK(strcmp(se3d_method_get_name(SE3D_METHOD_RK4), "rk4") == 0);
    CHECK(strcmp(se3d_method_get_name(SE3D_METHOD_AUTO), "auto") == 0);
    CHECK(strcmp(se3d_method_get_name(-1), "") == 0 && !*se3d_method_get_name(INT32_MAX));
    CHECK(strcmp(se3d_analysis_get_name(SE3D_ANALYSIS_EQUILIBRIUM), "equilibrium") == 0);
    CHECK(!*se3d_analysis_get_name(-1) && !*se3d_analysis_get_name(INT32_MAX));
    CHECK(strcmp(se3d_formulation_get_name(SE3D_FORMULATION_RP), "rp") == 0);
    CHECK(!*se3d_formulation_get_name(-7) && !*se3d_formulation_get_name(99));
    CHECK(se3d_system_get_error(NULL) != NULL);
    CHECK(strcmp(se3d_system_get_error_field(NULL), "") == 0);
    CHECK(se3d_system_get_error_status(NULL) == SE3D_ERR_NULL ||
          se3d_system_get_error_status(NULL) == SE3D_OK);
    CHECK(strcmp(se3d_expression_get_text(NULL), "") == 0);
    CHECK(strcmp(se3d_expression_get_text(a->expression), "2*t") == 0);
    return SE3D_OK;
}

static se3d_status unknown_functions_are_not_a_number(arguments *a)
{
    (void)a;
    for (int32_t k = 0; k <= SE3D_ELEMENTARY_POW; ++k) {
        CHECK(!isnan(se3d_elementary_eval(k, 0.5, 0.5)));
        CHECK(isnan(se3d_elementary_eval(k, (double)NAN, 0.5)));
    }
    CHECK(isnan(se3d_elementary_eval(-1, 0.5, 0.5)) && isnan(se3d_elementary_eval(15, 0.5, 0.5)));
    CHECK(isnan(se3d_elementary_eval(INT32_MAX, 0.5, 0.5)));
    return SE3D_OK;
}

/* An older caller's def is smaller, a newer one's larger: exactly `size` bytes are written. */
#define CHECK_INIT(type) CHECK_INIT_OF(se3d_##type##_def)
#define CHECK_INIT_OF(type)                                                                        \
    do {                                                                                           \
        unsigned char bytes[1600];                                                                 \
        type def;                                                                                  \
        type##_init(NULL, sizeof def);                                                             \
        for (size_t size = 16; size < sizeof def + 64; size += 8) {                                \
            memset(bytes, 0x5A, sizeof bytes);                                                     \
            memset(&def, 0, sizeof def);                                                           \
            type##_init((void *)bytes, size);                                                      \
            CHECK(memcmp(bytes, &size, sizeof size) == 0);                                         \
            size_t beyond = size;                                                                  \
            while (beyond < sizeof bytes && bytes[beyond] == 0x5A) {                               \
                ++beyond;                                                                          \
            }                                                                                      \
            CHECK(beyond == sizeof bytes);                                                         \
        }                                                                                          \
    } while (0)

#define CHECK_FORCE_INIT(name, def) CHECK_INIT(def);

static se3d_status definitions_are_never_overrun(arguments *a)
{
    (void)a;
    CHECK_INIT(system);
    CHECK_INIT(body);
    CHECK_INIT(marker);
    CHECK_INIT(wheel);
    CHECK_INIT(road);
    CHECK_INIT(state);
    CHECK_INIT(primitive);
    CHECK_INIT(user_constraint);
    CHECK_INIT(joint);
    CHECK_INIT(coupler);
    CHECK_INIT(driver);
    FORCE_LIST(CHECK_FORCE_INIT)
    CHECK_INIT(function);
    CHECK_INIT(solver);
    CHECK_INIT(event);
    CHECK_INIT(expression);
    CHECK_INIT(particles);
    CHECK_INIT(particles_source);
    CHECK_INIT(particles_sink);
    CHECK_INIT(flow);
    CHECK_INIT(servo);
    CHECK_INIT(clump);
    CHECK_INIT(material);
    CHECK_INIT(material_pair);
    CHECK_INIT(shape);
    CHECK_INIT_OF(se3d_contact_settings);
    CHECK_INIT(fill);
    CHECK_INIT(modes);
    return SE3D_OK;
}

#define JOINT_ROW(type, flags)                                                                     \
    {"se3d_joint_create_" #type, call_joint_create_##type, "SDh0", define_##type, joint_fields},
#define FORCE_ROWS(name, def)                                                                      \
    {"se3d_force_create_" #name, call_force_create_##name, "SDh0", define_##name, name##_fields},  \
        {"se3d_" #def "_def_init", definitions_are_never_overrun, "", NULL, NULL},
#define FORCE_VARIANT_ROW(variant, name)                                                           \
    {"se3d_force_create_" #name, call_force_create_##name, "SDh0", define_##variant,               \
     variant##_fields},
#define SHAPE_ROW(KIND, name, traits)                                                              \
    {"se3d_shape_create_" #name, shapes_reject_misuse, "", NULL, NULL},

static const row rows[] = {
    SE3DI_JOINT_LIST(JOINT_ROW) FORCE_LIST(FORCE_ROWS) FORCE_VARIANT_LIST(FORCE_VARIANT_ROW)
        SE3DI_SHAPE_LIST(SHAPE_ROW){"se3d_body_get_position", call_body_get_position, "sbo0", NULL,
                                    NULL},
    {"se3d_body_get_velocity", call_body_get_velocity, "sbo0", NULL, NULL},
    {"se3d_body_get_angular_velocity", call_body_get_angular_velocity, "sbo0", NULL, NULL},
    {"se3d_body_get_acceleration", call_body_get_acceleration, "sbo0", NULL, NULL},
    {"se3d_body_get_angular_acceleration", call_body_get_angular_acceleration, "sbo0", NULL, NULL},
    {"se3d_body_get_orientation", call_body_get_orientation, "sbo0", NULL, NULL},
    {"se3d_body_set_position", call_body_set_position, "Sbi3", NULL, NULL},
    {"se3d_body_set_velocity", call_body_set_velocity, "Sbi3", NULL, NULL},
    {"se3d_body_set_angular_velocity", call_body_set_angular_velocity, "Sbi3", NULL, NULL},
    {"se3d_body_set_orientation", call_body_set_orientation, "Sbi4", NULL, NULL},
    {"se3d_body_create", call_body_create, "SDh0", define_body, body_fields},
    {"se3d_body_find", call_body_find, "sth0", NULL, NULL},
    {"se3d_body_get_name", call_body_get_name, "sbo0", NULL, NULL},
    {"se3d_body_get_fixed", call_body_get_fixed, "sbo0", NULL, NULL},
    {"se3d_body_get_held", call_body_get_held, "sbo0", NULL, NULL},
    {"se3d_body_set_held", call_body_set_held, "Sb", NULL, NULL},
    {"se3d_body_get_point", call_body_get_point, "sbjo0", NULL, NULL},
    {"se3d_body_get_mass", call_body_get_mass, "sb", NULL, NULL},
    {"se3d_marker_create", call_marker_create, "SDh0", define_marker, marker_fields},
    {"se3d_marker_destroy", call_marker_destroy, "Sm", NULL, NULL},
    {"se3d_marker_get_name", call_marker_get_name, "smo0", NULL, NULL},
    {"se3d_marker_get_position", call_marker_get_position, "smo0", NULL, NULL},
    {"se3d_marker_get_velocity", call_marker_get_velocity, "smo0", NULL, NULL},
    {"se3d_marker_get_acceleration", call_marker_get_acceleration, "smo0", NULL, NULL},
    {"se3d_marker_get_orientation", call_marker_get_orientation, "smo0", NULL, NULL},
    {"se3d_marker_get_body", call_marker_get_body, "smh0", NULL, NULL},
    {"se3d_primitive_create", call_primitive_create, "SDh0", define_primitive, primitive_fields},
    {"se3d_user_constraint_create", call_user_constraint_create, "SDh0", define_user_constraint,
     user_constraint_fields},
    {"se3d_constraint_destroy", call_constraint_destroy, "Sc", NULL, NULL},
    {"se3d_constraint_find", call_constraint_find, "sth0", NULL, NULL},
    {"se3d_constraint_get_name", call_constraint_get_name, "sco0", NULL, NULL},
    {"se3d_constraint_get_type", call_constraint_get_type, "sco0", NULL, NULL},
    {"se3d_constraint_count_equations", call_constraint_count_equations, "sco0", NULL, NULL},
    {"se3d_constraint_count_bodies", call_constraint_count_bodies, "sco0", NULL, NULL},
    {"se3d_constraint_get_multipliers", call_constraint_get_multipliers, "sco0", NULL, NULL},
    {"se3d_constraint_get_equation_name", call_constraint_get_equation_name, "scxo0", NULL, NULL},
    {"se3d_constraint_get_body", call_constraint_get_body, "scxh0", NULL, NULL},
    {"se3d_constraint_eval", call_constraint_eval, "sc", NULL, NULL},
    {"se3d_constraint_eval_jacobian", call_constraint_eval_jacobian, "scx", NULL, NULL},
    {"se3d_constraint_get_reaction", call_constraint_get_reaction, "sc", NULL, NULL},
    {"se3d_constraint_get_reaction_at", call_constraint_get_reaction_at, "scxjo0", NULL, NULL},
    {"se3d_driver_get_value", call_driver_get_value, "sco0", NULL, NULL},
    {"se3d_driver_get_effort", call_driver_get_effort, "sco0", NULL, NULL},
    {"se3d_driver_create", call_driver_create, "SDh0", define_driver, driver_fields},
    {"se3d_joint_get_coordinate", call_joint_get_coordinate, "sc", NULL, NULL},
    {"se3d_joint_set_break", call_joint_set_break, "Scn", NULL, NULL},
    {"se3d_joint_set_broken", call_joint_set_broken, "Sc", NULL, NULL},
    {"se3d_joint_get_broken", call_joint_get_broken, "sco0", NULL, NULL},
    {"se3d_joint_create_coupler", call_joint_create_coupler, "SDh0", define_coupler,
     coupler_fields},
    {"se3d_joint_create_rack_pinion", call_joint_create_rack_pinion, "Scdnh0", NULL, NULL},
    {"se3d_force_destroy", call_force_destroy, "SF", NULL, NULL},
    {"se3d_force_find", call_force_find, "sth0", NULL, NULL},
    {"se3d_force_get_name", call_force_get_name, "sFo0", NULL, NULL},
    {"se3d_force_get_type", call_force_get_type, "sFo0", NULL, NULL},
    {"se3d_force_get_state", call_force_get_state, "sF", NULL, NULL},
    {"se3d_force_get_power", call_force_get_power, "sF", NULL, NULL},
    {"se3d_force_get_wrench", call_force_get_wrench, "sFxo0", NULL, NULL},
    {"se3d_function_create", call_function_create, "SDh0", define_function, function_fields},
    {"se3d_function_create_expression", call_function_create_expression, "Sh0", NULL, NULL},
    {"se3d_function_destroy", call_function_destroy, "Sf", NULL, NULL},
    {"se3d_function_eval", call_function_eval, "sfjo0", NULL, NULL},
    {"se3d_solver_create", call_solver_create, "SDh0", define_solver, solver_fields},
    {"se3d_solver_run", call_solver_run, "vn", NULL, NULL},
    {"se3d_solver_set_shown", call_solver_set_shown, "vx", NULL, NULL},
    {"se3d_solver_follow", call_solver_follow, "v", NULL, NULL},
    {"se3d_solver_step", call_solver_step, "vn", NULL, NULL},
    {"se3d_solver_get_stats", call_solver_get_stats, "vo0", NULL, NULL},
    {"se3d_solver_get_start_change", call_solver_get_start_change, "vo0", NULL, NULL},
    {"se3d_solver_get_method", call_solver_get_method, "vo0", NULL, NULL},
    {"se3d_solver_get_formulation", call_solver_get_formulation, "vo0", NULL, NULL},
    {"se3d_solver_get_tolerance", call_solver_get_tolerance, "vo0", NULL, NULL},
    {"se3d_solver_get_step", call_solver_get_step, "vo0", NULL, NULL},
    {"se3d_solver_get_switch", call_solver_get_switch, "vo0o1", NULL, NULL},
    {"se3d_solver_get_foresight", call_solver_get_foresight, "vo0", NULL, NULL},
    {"se3d_solver_write", call_solver_write, "vo0", NULL, NULL},
    {"se3d_solver_read", call_solver_read, "vj", NULL, NULL},
    {"se3d_check_create", call_check_create, "Sh0", NULL, NULL},
    {"se3d_check_get_summary", call_check_get_summary, "k", define_summary, NULL},
    {"se3d_check_get_message", call_check_get_message, "ko0", NULL, NULL},
    {"se3d_snapshot_create", call_snapshot_create, "sh0", NULL, NULL},
    {"se3d_snapshot_restore", call_snapshot_restore, "Sp", NULL, NULL},
    {"se3d_snapshot_write", call_snapshot_write, "po0", NULL, NULL},
    {"se3d_snapshot_read", call_snapshot_read, "Sjh0", NULL, NULL},
    {"se3d_system_clone", call_system_clone, "sh0", NULL, NULL},
    {"se3d_system_set_gravity", call_system_set_gravity, "Si3", NULL, NULL},
    {"se3d_system_get_gravity", call_system_get_gravity, "so0", NULL, NULL},
    {"se3d_system_set_log", call_system_set_log, "S", NULL, NULL},
    {"se3d_system_set_kept", call_system_set_kept, "S", NULL, NULL},
    {"se3d_system_set_replacing", call_system_set_replacing, "S", NULL, NULL},
    {"se3d_system_set_time", call_system_set_time, "Sn", NULL, NULL},
    {"se3d_system_get_time", call_system_get_time, "so0", NULL, NULL},
    {"se3d_system_get_ground", call_system_get_ground, "sh0", NULL, NULL},
    {"se3d_system_get_body", call_system_get_body, "sxh0", NULL, NULL},
    {"se3d_system_get_marker", call_system_get_marker, "sxh0", NULL, NULL},
    {"se3d_system_get_constraint", call_system_get_constraint, "sxh0", NULL, NULL},
    {"se3d_system_get_force", call_system_get_force, "sxh0", NULL, NULL},
    {"se3d_system_get_wheel", call_system_get_wheel, "sxh0", NULL, NULL},
    {"se3d_system_get_road", call_system_get_road, "sxh0", NULL, NULL},
    {"se3d_road_create", call_road_create, "SDh0", define_road, road_fields},
    {"se3d_road_create", roads_reject_misuse, "", NULL, NULL},
    {"se3d_road_destroy", call_road_destroy, "Sr", NULL, NULL},
    {"se3d_road_get_name", call_road_get_name, "sro0", NULL, NULL},
    {"se3d_road_find", call_road_find, "sth0", NULL, NULL},
    {"se3d_wheel_find", call_wheel_find, "sth0", NULL, NULL},
    {"se3d_state_set_size", call_state_set_size, "Szn", NULL, NULL},
    {"se3d_body_get_motion", call_body_get_motion, "sbo0", NULL, NULL},
    {"se3d_road_get_height", call_road_get_height, "srno0", NULL, NULL},
    {"se3d_state_create", call_state_create, "SDh0", define_state, state_fields},
    {"se3d_state_destroy", call_state_destroy, "Sz", NULL, NULL},
    {"se3d_state_find", call_state_find, "sth0", NULL, NULL},
    {"se3d_state_set_rate", call_state_set_rate, "Sz", NULL, NULL},
    {"se3d_state_set_output", call_state_set_output, "Sz", NULL, NULL},
    {"se3d_state_set_input", call_state_set_input, "Sz", NULL, NULL},
    {"se3d_state_set_value", call_state_set_value, "Szn", NULL, NULL},
    {"se3d_state_get_value", call_state_get_value, "szxo0", NULL, NULL},
    {"se3d_state_get_rate", call_state_get_rate, "szo0", NULL, NULL},
    {"se3d_wheel_create", call_wheel_create, "SDh0", define_wheel, wheel_fields},
    {"se3d_wheel_destroy", call_wheel_destroy, "Sw", NULL, NULL},
    {"se3d_wheel_get_name", call_wheel_get_name, "swo0", NULL, NULL},
    {"se3d_wheel_get_measures", call_wheel_get_measures, "swxo0", NULL, NULL},
    {"se3d_system_get_energy", call_system_get_energy, "so0", NULL, NULL},
    {"se3d_system_get_violation", call_system_get_violation, "so0", NULL, NULL},
    {"se3d_expression_eval", call_expression_eval, "ejo0", NULL, NULL},
    {"se3d_expression_eval_time", call_expression_eval_time, "ejo0", NULL, NULL},
    {"se3d_expression_eval_gradient", call_expression_eval_gradient, "ejo0o1", NULL, NULL},
    {"se3d_body_destroy", check_body_destroy, "", NULL, NULL},
    {"se3d_body_set_mass", check_body_set_mass, "", NULL, NULL},
    {"se3d_body_get_all", check_body_get_all, "", NULL, NULL},
    {"se3d_body_set_all", check_body_set_all, "", NULL, NULL},
    {"se3d_joint_def_set_frame", check_joint_def_set_frame, "", NULL, NULL},
    {"se3d_joint_create_gear", check_joint_create_gear, "", NULL, NULL},
    {"se3d_system_create", check_system_create, "", NULL, NULL},
    {"se3d_system_describe_left_out", check_describe_left_out, "", NULL, NULL},
    {"se3d_system_get_work", check_system_get_work, "", NULL, NULL},
    {"se3d_force_set_value", setters_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_value", setters_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_parameter", setters_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_parameter", setters_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_bushing", setters_reject_misuse, "", NULL, NULL},
    {"se3d_body_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_body_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_marker_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_marker_find", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_user_constraint_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_user_constraint_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_joint_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_coupler_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_driver_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_primitive_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_road_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_wheel_set_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_road_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_functions", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_function", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_shape_set_material", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_shape_set_filter", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_tsda", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_rsda", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_load", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_bushing_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_friction", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_stop", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_effort", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_armature", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_callback", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_set_tyre", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_marker_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_joint_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_coupler_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_driver_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_primitive_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_tsda", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_rsda", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_load", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_bushing_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_friction", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_stop", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_effort", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_armature", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_tyre", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_force_get_callback", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_function_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_function_get_signal", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_state_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_state_get_name", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_state", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_wheel_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_gravity_function", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_material_get_pair", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_materials", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_material", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_def", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_type", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_shapes", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_shape", definitions_reject_misuse, "", NULL, NULL},
    {"se3d_expression_write", expressions_are_written_again, "", NULL, NULL},
    {"se3d_force_get_bushing", setters_reject_misuse, "", NULL, NULL},
    {"se3d_effort_set", setters_reject_misuse, "", NULL, NULL},
    {"se3d_tyre_coefficients_init", setters_reject_misuse, "", NULL, NULL},
    {"se3d_tyre_coefficient_find", setters_reject_misuse, "", NULL, NULL},
    {"se3d_tyre_get_several", setters_reject_misuse, "", NULL, NULL},
    {"se3d_tyre_get_some", setters_reject_misuse, "", NULL, NULL},
    {"se3d_tyre_get_values", setters_reject_misuse, "", NULL, NULL},
    {"se3d_effort_get", setters_reject_misuse, "", NULL, NULL},
    {"se3d_effort_count", setters_reject_misuse, "", NULL, NULL},
    {"se3d_effort_set_all", setters_reject_misuse, "", NULL, NULL},
    {"se3d_function_set_constant", setters_reject_misuse, "", NULL, NULL},
    {"se3d_constraint_set_value", setters_reject_misuse, "", NULL, NULL},
    {"se3d_system_touch", setters_reject_misuse, "", NULL, NULL},
    {"se3d_system_set_gravity_function", check_system_set_gravity_function, "", NULL, NULL},
    {"se3d_expression_create", check_expression_create, "", NULL, NULL},
    {"se3d_system_destroy", destroying_null_is_fine, "", NULL, NULL},
    {"se3d_solver_destroy", destroying_null_is_fine, "", NULL, NULL},
    {"se3d_snapshot_destroy", destroying_null_is_fine, "", NULL, NULL},
    {"se3d_check_destroy", destroying_null_is_fine, "", NULL, NULL},
    {"se3d_expression_destroy", destroying_null_is_fine, "", NULL, NULL},
    {"se3d_system_count_bodies", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_markers", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_constraints", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_forces", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_states", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_roads", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_count_wheels", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_check_count_messages", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_hash", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_system_is_busy", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_expression_is_constant", counting_null_gives_zero, "", NULL, NULL},
    {"se3d_status_get_text", texts_are_never_null, "", NULL, NULL},
    {"se3d_elementary_eval", unknown_functions_are_not_a_number, "", NULL, NULL},
    {"se3d_text_get_character", texts_are_never_null, "", NULL, NULL},
    {"se3d_version_number", texts_are_never_null, "", NULL, NULL},
    {"se3d_version_get_text", texts_are_never_null, "", NULL, NULL},
    {"se3d_method_get_name", texts_are_never_null, "", NULL, NULL},
    {"se3d_analysis_get_name", texts_are_never_null, "", NULL, NULL},
    {"se3d_formulation_get_name", texts_are_never_null, "", NULL, NULL},
    {"se3d_system_get_error", texts_are_never_null, "", NULL, NULL},
    {"se3d_system_get_error_field", texts_are_never_null, "", NULL, NULL},
    {"se3d_system_get_error_status", texts_are_never_null, "", NULL, NULL},
    {"se3d_expression_get_text", texts_are_never_null, "", NULL, NULL},
    {"se3d_system_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_body_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_marker_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_state_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_road_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_wheel_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_primitive_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_user_constraint_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_joint_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_coupler_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_driver_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_function_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_solver_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_expression_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_material_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_material_pair_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_shape_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_contact_settings_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_fill_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_modes_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_event_create", events_reject_misuse, "", NULL, NULL},
    {"se3d_event_destroy", events_reject_misuse, "", NULL, NULL},
    {"se3d_event_get_name", events_reject_misuse, "", NULL, NULL},
    {"se3d_event_get_def", events_reject_misuse, "", NULL, NULL},
    {"se3d_solver_count_events", events_reject_misuse, "", NULL, NULL},
    {"se3d_solver_get_event", events_reject_misuse, "", NULL, NULL},
    {"se3d_motion_get_rotation", motions_reject_null, "", NULL, NULL},
    {"se3d_motion_get_point", motions_reject_null, "", NULL, NULL},
    {"se3d_motion_get_jacobian", motions_reject_null, "", NULL, NULL},
    {"se3d_motion_add_force", motions_reject_null, "", NULL, NULL},
    {"se3d_motion_add_torque", motions_reject_null, "", NULL, NULL},
    {"se3d_solver_count_event_records", events_reject_misuse, "", NULL, NULL},
    {"se3d_solver_get_event_record", events_reject_misuse, "", NULL, NULL},
    {"se3d_solver_clear_event_records", events_reject_misuse, "", NULL, NULL},
    {"se3d_event_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_batch_create", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_destroy", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_count", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_count_positions", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_count_velocities", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_count_lanes", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_count_single_forces", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_get_error", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_set_state", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_get_state", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_set_time", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_get_time", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_set_efforts", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_set_gravity", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_set_mass", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_step", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_get_status", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_compute_accelerations", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_batch_compute_efforts", batch_rejects_misuse, "", NULL, NULL},
    {"se3d_coordinates_create", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_destroy", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_count", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_count_positions", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_count_loop_rows", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_get_entry", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_get", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_set", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_move", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_accelerations", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_efforts", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_gravity", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_mass_matrix", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_multiply_mass", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_solve_mass", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_jacobian", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_transposed", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_momentum", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_loop_jacobian", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_coordinates_compute_null_space", coordinates_reject_misuse, "", NULL, NULL},
    {"se3d_modes_create", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_destroy", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_follow", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_count", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_count_freedoms", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_get_eigenvalue", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_get_shape", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_get_matrix", modes_reject_misuse, "", NULL, NULL},
    {"se3d_modes_get_transfer", modes_reject_misuse, "", NULL, NULL},
    {"se3d_particles_create", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_destroy", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_clone", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_restore", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_add", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_remove", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_set_all", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_step", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_run", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_set_step", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_hash", particles_reject_misuse, "", NULL, NULL},
    {"se3d_particles_count", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_count_contacts", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_ids", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_radii", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_all", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_forces", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_contacts", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_step", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_time", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_dissipation", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_energy", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_stats", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_wrench", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_system_set_contact", materials_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_contact", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_create", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_destroy", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_set", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_find", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_get_name", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_get", materials_reject_misuse, "", NULL, NULL},
    {"se3d_material_set_pair", materials_reject_misuse, "", NULL, NULL},
    {"se3d_shape_destroy", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_find", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_name", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_body", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_wrench", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_set_surface_motion", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_surface_motion", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_shape_get_nearest", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_contacts", contacts_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_passing_meshes", contacts_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_contacts", contacts_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_contact_force_max", contacts_reject_misuse, "", NULL, NULL},
    {"se3d_body_get_contact_wrench", shapes_reject_misuse, "", NULL, NULL},
    {"se3d_particles_find", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_name", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_system_count_particles", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_system_get_particles", particle_readers_reject_misuse, "", NULL, NULL},
    {"se3d_particles_add_source", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_source_stats", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_remove_source", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_add_sink", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_sink_count", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_remove_sink", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_set_tags", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_set_fixed", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_tags", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_materials", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_tally", flows_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_average", averages_reject_misuse, "", NULL, NULL},
    {"se3d_particles_add_clump_template", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_clump_template", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_add_clumps", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_count_clumps", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_clump_ids", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_clump_of", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_clumps", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_set_clumps", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_clump_forces", clumps_reject_misuse, "", NULL, NULL},
    {"se3d_clump_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_source_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_field_grid_init", fields_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_fields", fields_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_wall_map", wall_maps_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_wall_corners", wall_maps_reject_misuse, "", NULL, NULL},
    {"se3d_bond_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_bond", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_bond_near", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_bond_shape", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_count_bond_groups", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_count_bonds", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_bond_stats", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_bonds", bonds_reject_misuse, "", NULL, NULL},
    {"se3d_cell_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_add_cell_stage", cells_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_cell", cells_reject_misuse, "", NULL, NULL},
    {"se3d_servo_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_add_servo", servos_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_servo", servos_reject_misuse, "", NULL, NULL},
    {"se3d_flow_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_add_flow", passages_reject_misuse, "", NULL, NULL},
    {"se3d_particles_get_flow", passages_reject_misuse, "", NULL, NULL},
    {"se3d_particles_sink_def_init", definitions_are_never_overrun, "", NULL, NULL},
    {"se3d_particles_fill_lattice", fills_reject_misuse, "", NULL, NULL},
    {"se3d_particles_fill_random", fills_reject_misuse, "", NULL, NULL},
};

#endif
