/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements and linearisation: wrong arguments are refused with the value in the message and
 * change nothing; failing allocations leave nothing behind. */
#include "check.h"

#include "se3d/modes.h"
#include "se3d/se3d.h"
#include "support/counting.h"
#include "support/world.h"

typedef struct world {
    support_counting counting;
    se3d_allocator allocator;
    se3d_system *system;
    se3d_body ground, body;
    se3d_constraint joint;
} world;

static void build(world *w)
{
    const double at[3] = {0.0, 0.0, 0.0};
    const double axis[3] = {1.0, 0.0, 0.0};
    *w = (world){0};
    w->allocator = support_counting_allocator(&w->counting);
    se3d_system_def def = se3d_system_def_default();
    def.allocator = &w->allocator;
    CHECK(se3d_system_create(&def, &w->system) == SE3D_OK);
    CHECK(se3d_system_get_ground(w->system, &w->ground) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[2] = -0.5;
    CHECK(se3d_body_create(w->system, &body, &w->body) == SE3D_OK);
    w->joint =
        world_join(w->system, se3d_joint_create_revolute, NULL, w->ground, w->body, at, axis);
}

static void finish(world *w)
{
    se3d_system_destroy(w->system);
    CHECK(w->counting.live == 0 && w->counting.bytes == 0 && w->counting.wrong == 0);
}

static void refused(world *w, se3d_status status, se3d_status expected, const char *part)
{
    CHECK(status == expected);
    CHECK_CONTAINS(se3d_system_get_error(w->system), part);
    CHECK(se3d_system_count_forces(w->system) == 0);
}

static void bushings_are_checked(void)
{
    world w;
    build(&w);
    se3d_force force = {7, 7};
    se3d_bushing_def good = se3d_bushing_def_default();
    good.body_i = w.ground;
    good.body_j = w.body;
    CHECK(se3d_force_create_bushing(NULL, &good, &force) == SE3D_ERR_NULL);
    CHECK(force.index1 == 0 && force.generation == 0);
    refused(&w, se3d_force_create_bushing(w.system, NULL, &force), SE3D_ERR_NULL, "bushing def");
    refused(&w, se3d_force_create_bushing(w.system, &good, NULL), SE3D_ERR_NULL, "force");
    se3d_bushing_def bad = good;
    bad.body_j = w.ground;
    refused(&w, se3d_force_create_bushing(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "same body");
    bad = good;
    bad.K[7] = (double)NAN;
    refused(&w, se3d_force_create_bushing(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "K[7] = nan");
    bad = good;
    bad.K[1] = 3.0;
    refused(&w, se3d_force_create_bushing(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "symmetric");
    bad = good;
    bad.orientation_i[0] = 2.0;
    refused(&w, se3d_force_create_bushing(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "orientation_i");
    CHECK(se3d_force_create_bushing(w.system, &good, &force) == SE3D_OK);
    const char *type;
    CHECK(se3d_force_get_type(w.system, force, &type) == SE3D_OK);
    CHECK(strcmp(type, "bushing") == 0);
    double wrench[6];
    CHECK(se3d_force_get_state(w.system, force, NULL, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_force_get_wrench(w.system, force, 2, wrench) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_force_get_wrench(w.system, force, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_force_destroy(w.system, force) == SE3D_OK);
    CHECK(se3d_force_get_wrench(w.system, force, 0, wrench) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_get_power(w.system, force, NULL, NULL, NULL) == SE3D_ERR_STALE_HANDLE);
    finish(&w);
}

static void friction_is_checked(void)
{
    world w;
    build(&w);
    se3d_force force;
    se3d_friction_def good = se3d_friction_def_default();
    good.joint = w.joint;
    good.mu = 0.3;
    se3d_friction_def bad = good;
    bad.mu = -0.1;
    refused(&w, se3d_force_create_friction(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "mu = -0.1");
    bad = good;
    bad.mu_static = 0.2;
    refused(&w, se3d_force_create_friction(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "at least mu = 0.3");
    bad = good;
    bad.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    refused(&w, se3d_force_create_friction(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "displacement");
    bad = good;
    bad.joint = (se3d_constraint){0, 0};
    refused(&w, se3d_force_create_friction(w.system, &bad, &force), SE3D_ERR_STALE_HANDLE, "joint");
    CHECK(se3d_force_create_friction(w.system, &good, &force) == SE3D_OK);
    CHECK(se3d_constraint_destroy(w.system, w.joint) == SE3D_ERR_IN_USE);
    finish(&w);
}

static void stops_and_callbacks_are_checked(void)
{
    world w;
    build(&w);
    se3d_force force;
    se3d_stop_def good = se3d_stop_def_default();
    good.joint = w.joint;
    good.upper = 1.0;
    good.k = 10.0;
    se3d_stop_def bad = good;
    bad.lower = 2.0;
    refused(&w, se3d_force_create_stop(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "lower = 2");
    bad = good;
    bad.k = 0.0;
    refused(&w, se3d_force_create_stop(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT, "k = 0");
    bad = good;
    bad.restitution = 1.5;
    refused(&w, se3d_force_create_stop(w.system, &bad, &force), SE3D_ERR_INVALID_ARGUMENT,
            "restitution = 1.5");
    se3d_force_callback_def callback = se3d_force_callback_def_default();
    callback.body_i = w.ground;
    callback.body_j = w.body;
    refused(&w, se3d_force_create_callback(w.system, &callback, &force), SE3D_ERR_NULL, "callback");
    se3d_rsda_def rsda = se3d_rsda_def_default();
    rsda.body_i = w.ground;
    rsda.body_j = w.body;
    refused(&w, se3d_force_create_rsda(w.system, &rsda, &force), SE3D_ERR_INVALID_ARGUMENT,
            "axis_i");
    rsda.axis_i[0] = rsda.ref_i[0] = 1.0;
    refused(&w, se3d_force_create_rsda(w.system, &rsda, &force), SE3D_ERR_INVALID_ARGUMENT,
            "parallel");
    finish(&w);
}

static void a_tsda_without_direction_is_an_error_only_where_it_needs_one(void)
{
    world w;
    build(&w);
    se3d_force force;
    double wrench[6];
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.body_i = w.ground;
    spring.body_j = w.body;
    spring.point_j[2] = 0.5; /* the points coincide */
    spring.k = 10.0;
    CHECK(se3d_force_create_tsda(w.system, &spring, &force) == SE3D_OK);
    CHECK(se3d_force_get_wrench(w.system, force, 1, wrench) == SE3D_OK);
    CHECK(se3d_force_destroy(w.system, force) == SE3D_OK);
    spring.l0 = 1.0;
    spring.name = "strut";
    CHECK(se3d_force_create_tsda(w.system, &spring, &force) == SE3D_OK);
    CHECK(se3d_force_get_wrench(w.system, force, 1, wrench) == SE3D_ERR_SINGULAR);
    se3d_solver *solver;
    CHECK(se3d_solver_create(w.system, NULL, &solver) != SE3D_OK);
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(se3d_solver_create(w.system, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 0.1) == SE3D_ERR_SINGULAR);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "strut (tsda)");
    CHECK_CONTAINS(se3d_system_get_error(w.system), "coincide");
    se3d_solver_destroy(solver);
    finish(&w);
}

static void linearisation_is_checked(void)
{
    world w;
    build(&w);
    se3d_modes *modes = NULL;
    se3d_modes_input input = {.body = w.body, .direction = {0.0, 0.0, 0.0}};
    se3d_modes_output output = {.body = w.body, .quantity = 9, .direction = {1.0, 0.0, 0.0}};
    se3d_modes_def def = se3d_modes_def_default();
    CHECK(se3d_modes_create(NULL, NULL, &modes) == SE3D_ERR_NULL);
    CHECK(se3d_modes_create(w.system, NULL, NULL) == SE3D_ERR_NULL);
    def.input_count = 1;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_ERR_NULL);
    def.inputs = &input;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "inputs[].direction");
    input.direction[1] = 1.0;
    def.outputs = &output;
    def.output_count = 1;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "outputs[0].quantity = 9");
    output.quantity = SE3D_MODES_ROTATION;
    output.body.generation ^= 1u;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_ERR_STALE_HANDLE);
    CHECK(modes == NULL);
    CHECK(se3d_modes_count(NULL) == 0 && se3d_modes_count_freedoms(NULL) == 0);
    output.body = w.body;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_OK);
    se3d_eigenvalue value;
    double re, im;
    CHECK(se3d_modes_get_eigenvalue(modes, 1, &value) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_shape(modes, 0, 2, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_transfer(modes, 1, 0, 1.0, &re, &im) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_transfer(modes, 0, 0, (double)NAN, &re, &im) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_transfer(modes, 0, 0, 1.0, NULL, &im) == SE3D_ERR_NULL);
    se3d_modes_destroy(modes);
    se3d_modes_destroy(NULL);
    finish(&w);
}

static se3d_status make_axes(world *w)
{
    se3d_force force;
    se3d_rsda_def rsda = se3d_rsda_def_default();
    rsda.name = "axes";
    rsda.body_i = w->ground;
    rsda.body_j = w->body;
    rsda.axis_i[0] = 1.0;
    return se3d_force_create_rsda(w->system, &rsda, &force);
}

static se3d_status make_friction(world *w)
{
    se3d_force force;
    se3d_friction_def def = se3d_friction_def_default();
    def.name = "friction";
    def.joint = w->joint;
    def.mu = 0.1;
    def.radius = 0.1;
    return se3d_force_create_friction(w->system, &def, &force);
}

static se3d_status make_modes(world *w)
{
    se3d_modes *modes = NULL;
    se3d_modes_input input = {.body = w->body, .direction = {0.0, 1.0, 0.0}};
    se3d_modes_def def = se3d_modes_def_default();
    def.inputs = &input;
    def.input_count = 1;
    se3d_status status = se3d_modes_create(w->system, &def, &modes);
    CHECK((status < 0) == (modes == NULL));
    se3d_modes_destroy(modes);
    return status;
}

static se3d_status analyse(world *w, int32_t analysis, int32_t method)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.method = method;
    def.step = 0.01;
    se3d_status status = se3d_solver_create(w->system, &def, &solver);
    status = status >= 0 ? se3d_solver_run(solver, 0.02) : status;
    se3d_solver_destroy(solver);
    return status;
}

static se3d_status make_equilibrium(world *w)
{
    return analyse(w, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO);
}

static se3d_status make_dynamics(world *w)
{
    se3d_status status = make_friction(w);
    return status < 0 ? status : analyse(w, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_HHT);
}

static void failing_allocations_leave_nothing_behind(void)
{
    se3d_status (*const operation[])(world *) = {make_axes, make_friction, make_modes,
                                                 make_equilibrium, make_dynamics};
    for (size_t o = 0; o < sizeof operation / sizeof operation[0]; ++o) {
        size_t failures = 0;
        for (size_t k = 0; k < 1000; ++k) {
            world w;
            build(&w);
            w.counting.fail_at = w.counting.calls + 1 + k;
            w.counting.for_ever = 1;
            se3d_status status = operation[o](&w);
            int done = status >= 0;
            CHECK(done || status == SE3D_ERR_NO_MEMORY);
            w.counting.fail_at = 0;
            finish(&w);
            failures += !done;
            if (done) {
                break;
            }
        }
        CHECK(failures > 0 && failures < 1000);
    }
}

int main(void)
{
    RUN(bushings_are_checked);
    RUN(friction_is_checked);
    RUN(stops_and_callbacks_are_checked);
    RUN(a_tsda_without_direction_is_an_error_only_where_it_needs_one);
    RUN(linearisation_is_checked);
    RUN(failing_allocations_leave_nothing_behind);
    return check_finish();
}
