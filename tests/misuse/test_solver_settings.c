/* SPDX-License-Identifier: BSD-3-Clause */
/* Settings of solvers and times of runs that are nonsense: refused before anything is done, with
 * the value and what is allowed. */
#include "check.h"
#include "se3d/se3d.h"

static se3d_system *open_system(void)
{
    se3d_system *system = NULL;
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_body_create(system, &def, &body) == SE3D_OK);
    return system;
}

static void refuse(se3d_system *system, const se3d_solver_def *def, const char *name)
{
    se3d_solver *solver = NULL;
    CHECK(se3d_solver_create(system, def, &solver) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(solver == NULL);
    CHECK_CONTAINS(se3d_system_get_error(system), name);
    CHECK_CONTAINS(se3d_system_get_error(system), "must be");
    se3d_solver_destroy(solver);
}

static void numbers_out_of_range_are_refused(void)
{
    static const struct {
        const char *name;
        size_t offset;
        double values[9];
        size_t count;
    } rows[] = {
        {"step = ",
         offsetof(se3d_solver_def, step),
         {-1.0, -1e-320, 1e-320, 1e-300, 9e-16, -1e308, (double)NAN, (double)INFINITY,
          -(double)INFINITY},
         9},
        {"tolerance = ",
         offsetof(se3d_solver_def, tolerance),
         {-1e-6, 1e-320, 1e-30, 9e-15, 0.11, 1e10, 1e308, (double)NAN, (double)INFINITY},
         9},
        {"spectral_radius = ",
         offsetof(se3d_solver_def, spectral_radius),
         {-1e-320, -1.0, 1.0000001, 1e308, (double)NAN, (double)INFINITY},
         6},
        {"alpha = ",
         offsetof(se3d_solver_def, alpha),
         {-0.34, 1e-320, 1.0, -1e308, (double)NAN, -(double)INFINITY},
         6},
    };
    se3d_system *system = open_system();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (size_t i = 0; i < rows[k].count; ++i) {
            se3d_solver_def def = se3d_solver_def_default();
            memcpy((char *)&def + rows[k].offset, &rows[k].values[i], sizeof(double));
            refuse(system, &def, rows[k].name);
        }
    }
    se3d_solver_def def = se3d_solver_def_default();
    def.iterations_max = SIZE_MAX;
    refuse(system, &def, "iterations_max = ");
    def = se3d_solver_def_default();
    def.horizon = (double)NAN;
    refuse(system, &def, "horizon = ");
    def.horizon = (double)INFINITY;
    refuse(system, &def, "horizon = ");
    se3d_system_destroy(system);
}

static void a_method_takes_only_the_orders_it_has(void)
{
    static const struct {
        int32_t method, good[3], bad[4];
        const char *list;
    } rows[] = {
        {SE3D_METHOD_AUTO, {0, 0, 0}, {1, 4, -1, INT32_MIN}, "must be 0 with method auto"},
        {SE3D_METHOD_BDF, {0, 1, 5}, {6, 9, -1, INT32_MAX}, "0, 1, 2, 3, 4, 5 with method bdf"},
        {SE3D_METHOD_RATTLE, {0, 2, 4}, {1, 3, 32, 34}, "0, 2, 4 with method rattle"},
        {SE3D_METHOD_RADAU, {0, 5, 5}, {9, 4, 37, -5}, "0, 5 with method radau"},
        {SE3D_METHOD_DOP853, {0, 8, 8}, {7, 5, 40, -8}, "0, 8 with method dop853"},
        {SE3D_METHOD_GAUSS, {0, 8, 16}, {4, 12, 32, -8}, "0, 8, 16 with method gauss"},
        {SE3D_METHOD_RK45, {0, 5, 5}, {4, 8, 31, -1}, "0, 5 with method rk45"},
        {SE3D_METHOD_RK4, {0, 4, 4}, {5, 3, 36, -4}, "0, 4 with method rk4"},
        {SE3D_METHOD_HHT, {0, 2, 2}, {1, 3, 4, -2}, "0, 2 with method hht"},
        {SE3D_METHOD_GENERALIZED_ALPHA, {0, 2, 2}, {1, 3, 4, -2}, "method generalized_alpha"},
        {SE3D_METHOD_VERLET, {0, 2, 2}, {1, 3, 4, -2}, "0, 2 with method verlet"},
    };
    se3d_system *system = open_system();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        se3d_solver_def def = se3d_solver_def_default();
        def.method = rows[k].method;
        for (size_t i = 0; i < 3; ++i) {
            se3d_solver *solver = NULL;
            def.order = rows[k].good[i];
            CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
            se3d_solver_destroy(solver);
        }
        for (size_t i = 0; i < 4; ++i) {
            def.order = rows[k].bad[i];
            refuse(system, &def, "order = ");
            CHECK_CONTAINS(se3d_system_get_error(system), rows[k].list);
        }
    }
    se3d_system_destroy(system);
}

static void steps_that_do_not_move_the_time_or_are_too_many_are_refused(void)
{
    static const double steps[] = {0.0, -1.0, 1e-320, 1e-300, (double)NAN, (double)INFINITY,
                                   1e-9 /* beside 1e9 s */};
    se3d_system *system = open_system();
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_RATTLE;
    def.step = 1e-12;
    CHECK(se3d_system_set_time(system, 1e9) == SE3D_OK);
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    for (size_t k = 0; k < sizeof steps / sizeof *steps; ++k) {
        CHECK(se3d_solver_step(solver, steps[k]) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "h = ");
    }
    CHECK(se3d_solver_run(solver, 1e9 + 1.0) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "takes 1e+12 steps of 1e-12 s");
    CHECK(se3d_solver_run(solver, (double)NAN) == SE3D_ERR_INVALID_ARGUMENT);
    double time = 0.0;
    CHECK(se3d_system_get_time(system, &time) == SE3D_OK);
    CHECK_NEAR(time, 1e9, 0.0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* A spring of 1e24 N/m: 1e11 oscillations a second. */
static void a_motion_that_would_take_billions_of_steps_is_given_up(void)
{
    se3d_system *system = open_system();
    se3d_solver *solver = NULL;
    se3d_body body;
    se3d_body ground;
    se3d_force force;
    se3d_tsda_def spring = se3d_tsda_def_default();
    const double r[3] = {1.0, 0.0, 0.0};
    CHECK(se3d_system_get_body(system, 1, &body) == SE3D_OK);
    CHECK(se3d_system_get_ground(system, &ground) == SE3D_OK);
    CHECK(se3d_body_set_position(system, body, r) == SE3D_OK);
    spring.body_i = ground;
    spring.body_j = body;
    spring.k = 1e24;
    spring.l0 = 0.5;
    CHECK(se3d_force_create_tsda(system, &spring, &force) == SE3D_OK);
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_DOP853;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_STEP_COUNT);
    CHECK_CONTAINS(se3d_system_get_error(system), "steps were tried since t = 0 s");
    CHECK_CONTAINS(se3d_system_get_error(system), "would be needed to t = 1 s");
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(numbers_out_of_range_are_refused);
    RUN(a_method_takes_only_the_orders_it_has);
    RUN(a_motion_that_would_take_billions_of_steps_is_given_up);
    RUN(steps_that_do_not_move_the_time_or_are_too_many_are_refused);
    return check_finish();
}
