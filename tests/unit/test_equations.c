/* SPDX-License-Identifier: BSD-3-Clause */
/* What can be asked of equations whose functions fail or that have no value: it is refused, and
 * its numbers are zero. */
#include "property/test_joint_world.h"

#include "joint/equation.h"
#include "primitive/scale.h"
#include "primitive/user.h"
#include "se3d/io.h"

/* A callback that can be told to fail. */
typedef struct failing {
    int fails;
} failing;

static se3d_status line(void *ctx, const double *x, double jet[3], double *gradient)
{
    const failing *f = ctx;
    jet[0] = 0.1 * x[0];
    jet[1] = 0.1;
    jet[2] = 0.0;
    if (gradient) {
        gradient[0] = 0.1;
    }
    return f->fails ? SE3D_ERR_CALLBACK : SE3D_OK;
}

/* The x coordinate of the body is 1. */
static se3d_status at_one(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                          double *jacobian, double *nu, double *gamma)
{
    const failing *f = ctx;
    (void)t;
    (void)nu;
    (void)gamma;
    if (phi) {
        phi[0] = bodies[0].r[0] - 1.0;
    }
    if (jacobian) {
        jacobian[0] = 1.0;
    }
    return f->fails ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static void check_fails(const world *w, se3d_constraint constraint, se3d_status status)
{
    double phi[6], phi_r[18], violation[3];
    CHECK(se3d_constraint_eval(w->system, constraint, SE3D_FORMULATION_ROMEGA, phi, NULL, NULL) ==
          status);
    CHECK(phi[0] == 0.0);
    if (status == SE3D_ERR_CALLBACK) {
        CHECK(se3d_system_get_violation(w->system, violation) == status);
    }
    if (status == SE3D_ERR_NOT_FINITE) {
        CHECK(se3d_constraint_eval_jacobian(w->system, constraint, SE3D_FORMULATION_ROMEGA, 1,
                                            phi_r, NULL) == status);
        CHECK(phi_r[0] == 0.0);
    }
}

static void a_driver_whose_function_fails_has_no_equation(void)
{
    const double upwards[3] = {0.0, 0.0, 1.0};
    failing f = {0};
    world w;
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_driver_def def = se3d_driver_def_default();
    se3d_function_def law = se3d_function_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver;
    se3d_constraint driver;
    double phi;
    world_init(&w, 3);
    joint.body_i = w.ground;
    joint.body_j = w.body[0];
    CHECK(!se3d_joint_def_set_frame(w.system, &joint, w.system->model.frames[1].r, upwards, NULL));
    CHECK(!se3d_joint_create_revolute(w.system, &joint, &def.joint));
    law.callback = line;
    law.ctx = &f;
    CHECK(!se3d_function_create(w.system, &law, &def.function));
    CHECK(!se3d_driver_create(w.system, &def, &driver));
    CHECK(!se3d_solver_create(w.system, &how, &solver));
    CHECK(se3d_solver_run(solver, 0.0) >= 0);
    CHECK(!se3d_constraint_eval(w.system, driver, SE3D_FORMULATION_RP, &phi, NULL, NULL));
    f.fails = 1;
    check_fails(&w, driver, SE3D_ERR_CALLBACK);
    se3d_solver_destroy(solver);
    world_destroy(&w);
}

static void a_constraint_whose_callback_fails_has_no_reaction(void)
{
    failing f = {0};
    world w;
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver;
    se3d_constraint constraint;
    double force[3], torque[3], phi_r[3];
    const double r[3] = {1.0, 0.0, 0.0}, v[3] = {0.0, 0.0, 0.0};
    world_init(&w, 3);
    CHECK(!se3d_body_set_position(w.system, w.body[0], r));
    CHECK(!se3d_body_set_velocity(w.system, w.body[0], v));
    def.callback = at_one;
    def.ctx = &f;
    def.bodies[0] = w.body[0];
    CHECK(!se3d_user_constraint_create(w.system, &def, &constraint));
    CHECK(!se3d_solver_create(w.system, &how, &solver));
    CHECK(se3d_solver_run(solver, 0.0) >= 0);
    CHECK(!se3d_constraint_get_reaction(w.system, constraint, force, torque));
    f.fails = 1;
    CHECK(se3d_constraint_get_reaction(w.system, constraint, force, torque) < 0);
    CHECK(force[0] == 0.0 && torque[0] == 0.0);
    CHECK(se3d_constraint_eval_jacobian(w.system, constraint, SE3D_FORMULATION_RP, 1, phi_r,
                                        NULL) == SE3D_ERR_CALLBACK);
    check_fails(&w, constraint, SE3D_ERR_CALLBACK);
    se3d_solver_destroy(solver);
    world_destroy(&w);
}

/* The direction that the angle is measured to is along the axis. */
static void an_angle_without_a_direction_has_no_equation(void)
{
    const double upright[4] = {1.0, 0.0, 0.0, 0.0};
    const double over[4] = {0.5, 0.5, 0.5, 0.5}; /* x to y to z to x */
    world w;
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_driver_def def = se3d_driver_def_default();
    se3d_constraint driver;
    world_init(&w, 3);
    CHECK(!se3d_body_set_orientation(w.system, w.body[0], upright));
    joint.body_i = w.ground;
    joint.body_j = w.body[0];
    joint.ref_i[0] = joint.ref_j[1] = 1.0;
    CHECK(!se3d_joint_create_revolute(w.system, &joint, &def.joint));
    CHECK(!se3d_driver_create(w.system, &def, &driver));
    CHECK(!se3d_body_set_orientation(w.system, w.body[0], over));
    check_fails(&w, driver, SE3D_ERR_NOT_FINITE);
    world_destroy(&w);
}

static void numbers_that_overflow_are_not_given(void)
{
    const double far[3] = {1e200, 0.0, 0.0};
    world w;
    se3d_primitive_def def = se3d_primitive_def_default();
    se3d_constraint square;
    double phi;
    world_init(&w, 3);
    def.type = SE3D_PRIMITIVE_D;
    def.body_i = w.ground;
    def.body_j = w.body[0];
    def.value = 4.0;
    CHECK(!se3d_primitive_create(w.system, &def, &square));
    CHECK(!se3d_body_set_position(w.system, w.body[0], far));
    CHECK(se3d_constraint_eval(w.system, square, SE3D_FORMULATION_RP, &phi, NULL, NULL) ==
          SE3D_ERR_NOT_FINITE);
    CHECK(phi == 0.0);
    world_destroy(&w);
}

/* The distance of a joint that gives none is the present one, which must be one. */
static void points_that_coincide_have_no_distance(void)
{
    const double at[3] = {0.5, 0.0, 0.0};
    world w;
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint link;
    world_init(&w, 3);
    CHECK(!se3d_body_set_position(w.system, w.body[0], at));
    def.body_i = w.ground;
    def.body_j = w.body[0];
    def.point_i[0] = 0.5;
    CHECK(se3d_joint_create_distance(w.system, &def, &link) == SE3D_ERR_INVALID_ARGUMENT);
    def.point_i[0] = 0.0;
    CHECK(!se3d_joint_create_distance(w.system, &def, &link));
    world_destroy(&w);
}

/* Beside points that are far away the distance that rounding leaves is none. */
static void far_points_coincide_to_rounding(void)
{
    static const double place[2][2] = {{1e6, 0.0}, {0.0, 1e6}}; /* of the point, of the body */
    const double upright[4] = {1.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < 2; ++k) {
        const double at[3] = {place[k][1], 0.0, 0.0};
        world w;
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint link;
        world_init(&w, 3);
        CHECK(!se3d_body_set_orientation(w.system, w.body[0], upright));
        CHECK(!se3d_body_set_position(w.system, w.body[0], at));
        def.body_i = w.ground;
        def.body_j = w.body[0];
        def.point_i[0] = 1e6;
        def.point_j[0] = place[k][0];
        def.point_j[1] = 1.5e-6;
        CHECK(se3d_joint_create_distance(w.system, &def, &link) == SE3D_ERR_INVALID_ARGUMENT);
        def.point_j[1] = 5e-6;
        CHECK(!se3d_joint_create_distance(w.system, &def, &link));
        world_destroy(&w);
    }
}

/* What bodies must do is [phi, nu, gamma]; the row asks for x and for the turn about z. */
static se3d_status swept(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                         double *jacobian, double *nu, double *gamma)
{
    (void)ctx, (void)t, (void)bodies;
    if (phi) {
        phi[0] = 0.25;
    }
    if (jacobian) {
        jacobian[0] = 1.0;
        jacobian[5] = 2.0;
    }
    if (nu) {
        nu[0] = 0.5;
    }
    if (gamma) {
        gamma[0] = -0.75;
    }
    return SE3D_OK;
}

static void violations_of_user_constraints_are_those_of_their_rows(void)
{
    const double v[3] = {3.0, 0.0, 0.0}, omega[3] = {0.0, 0.0, 1.5};
    world w;
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    se3d_constraint constraint;
    double violation[3];
    world_init(&w, 3);
    def.callback = swept;
    def.bodies[0] = w.body[2];
    CHECK(!se3d_user_constraint_create(w.system, &def, &constraint));
    CHECK(!se3d_body_set_velocity(w.system, w.body[2], v));
    CHECK(!se3d_body_set_angular_velocity(w.system, w.body[2], omega));
    double *a = w.system->model.acceleration + 6 * (size_t)world_index(&w, w.body[2]);
    a[0] = 7.0;
    a[5] = -0.5;
    CHECK(!se3di_violation_measure(&w.system->model, violation));
    CHECK_NEAR(violation[0], 0.25, 1e-15);
    CHECK_NEAR(violation[1], 3.0 + 2.0 * 1.5 - 0.5, 1e-15);
    CHECK_NEAR(violation[2], 7.0 - 2.0 * 0.5 + 0.75, 1e-15);
    world_destroy(&w);
}

/* The size of a model is that of the longest arm, on either body; rows of squares are measured by
 * its square. */
static void rows_are_measured_by_the_size_of_the_model(void)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    for (int side = 0; side < 2; ++side) {
        world w;
        se3d_primitive_def def = se3d_primitive_def_default();
        se3d_constraint square;
        world_init(&w, 3);
        for (int k = 0; k < WORLD_BODIES; ++k) {
            CHECK(!se3d_body_set_position(w.system, w.body[k], origin));
        }
        def.type = SE3D_PRIMITIVE_D;
        def.body_i = w.body[0];
        def.body_j = w.body[1];
        (side ? def.point_j : def.point_i)[1] = 3.0;
        def.value = 18.0;
        CHECK(!se3d_primitive_create(w.system, &def, &square));
        const se3di_model *model = &w.system->model;
        const double size = se3di_model_get_size(model);
        CHECK_NEAR(size, 3.0, 1e-15);
        CHECK_NEAR(se3di_row_get_scale(model, 0, size), 9.0, 1e-14);
        CHECK_NEAR(se3di_row_violation(model, &model->rows[0], 18.0), 9.0 - 18.0, 1e-14);
        CHECK_NEAR(se3di_row_measure(model, 0, size), 1.0, 1e-14);
        world_destroy(&w);
    }
}

/* By a driver whose value follows another joint, angle = sqrt(x): it has no curvature where the
 * root has no value, nor where the multiplier makes it too large. */
static void curvatures_that_are_not_finite_are_refused(void)
{
    static const char text[] =
        "se3d: 1\nbodies:\n  - {name: a, mass: 1, inertia: [1, 1, 1]}\n"
        "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [1e-4, 0, 0]}\njoints:\n"
        "  - {name: ja, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: jb, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [1, 0, "
        "0]}\n"
        "drivers: [{name: d, joint: ja, value: 'sqrt(jb.displacement + 1e-4)'}]\n"
        "analysis: {type: dynamics, duration: 1}\n";
    const double before[3] = {-1.0, 0.0, 0.0}, one = 1.0, huge = 1e305;
    double H[24 * 24], g[24];
    se3d_model *read = NULL;
    se3d_model_error error;
    se3d_constraint driver;
    se3d_body body;
    CHECK(!se3d_model_read_text(text, sizeof text - 1, "m.yaml", NULL, &read, &error));
    se3d_system *system = se3d_model_get_system(read);
    CHECK(!se3d_constraint_find(system, "d", &driver));
    CHECK(!se3d_body_find(system, "b", &body));
    const se3di_constraint *law = &system->model.constraints[driver.index1 - 1];
    CHECK(se3di_user_body_count(law) <= 4);
    CHECK(!se3di_user_curvature(&system->model, law, 0.0, &one, H, g));
    CHECK(se3di_user_curvature(&system->model, law, 0.0, &huge, H, g) == SE3D_ERR_NOT_FINITE);
    CHECK(!se3d_body_set_position(system, body, before));
    CHECK(se3di_user_curvature(&system->model, law, 0.0, &one, H, g) == SE3D_ERR_NOT_FINITE);
    se3d_model_destroy(read);
}

/* Inputs are refused before it comes to that. */
static void the_body_of_a_singular_mass_matrix_is_named(void)
{
    for (int named = 0; named < 2; ++named) {
        world w;
        se3d_solver *solver;
        se3d_solver_def how = se3d_solver_def_default();
        world_init(&w, 3);
        how.formulation = SE3D_FORMULATION_ROMEGA;
        how.method = SE3D_METHOD_DOP853;
        CHECK(!se3d_solver_create(w.system, &how, &solver));
        se3di_body *body = &w.system->model.bodies[2];
        memset(body->J, 0, sizeof body->J);
        char *const name = body->name, odd[] = "odd";
        body->name = named ? odd : NULL;
        CHECK(se3d_solver_run(solver, 0.1) == SE3D_ERR_SINGULAR);
        CHECK(strstr(se3d_system_get_error(w.system), named ? "body odd" : "body number 2"));
        body->name = name;
        se3d_solver_destroy(solver);
        world_destroy(&w);
    }
}

int main(void)
{
    RUN(a_driver_whose_function_fails_has_no_equation);
    RUN(a_constraint_whose_callback_fails_has_no_reaction);
    RUN(an_angle_without_a_direction_has_no_equation);
    RUN(numbers_that_overflow_are_not_given);
    RUN(points_that_coincide_have_no_distance);
    RUN(far_points_coincide_to_rounding);
    RUN(violations_of_user_constraints_are_those_of_their_rows);
    RUN(rows_are_measured_by_the_size_of_the_model);
    RUN(curvatures_that_are_not_finite_are_refused);
    RUN(the_body_of_a_singular_mass_matrix_is_named);
    return check_finish();
}
