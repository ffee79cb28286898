/* SPDX-License-Identifier: BSD-3-Clause */
/* Callbacks that are defined up to the end of a run only: no method needs them beyond it. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/methods.h"
#include "support/parts.h"

/* Callbacks report a failure beyond this time. */
static double last;

static se3d_status may_fail(double t)
{
    return t > last ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)motion, (void)K, (void)D;
    wrench[6] = *(const double *)ctx * sin(t);
    return may_fail(t);
}

static se3d_status wave(void *ctx, const double *x, double jet[3], double *gradient)
{
    const double size = *(const double *)ctx;
    jet[0] = size * sin(x[0]);
    jet[1] = size * cos(x[0]);
    jet[2] = -size * sin(x[0]);
    if (gradient) {
        gradient[0] = jet[1];
    }
    return may_fail(x[0]);
}

/* The height of a body. */
static se3d_status level(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                         double *jacobian, double *nu, double *gamma)
{
    (void)ctx, (void)nu, (void)gamma;
    if (phi) {
        phi[0] = bodies[0].r[2];
    }
    if (jacobian) {
        jacobian[2] = 1.0;
    }
    return may_fail(t);
}

enum { KIND_FORCE, KIND_DRIVER, KIND_CONSTRAINT, KINDS };
static const char *const kinds[KINDS] = {"force", "driver", "constraint"};

static void add_force(se3d_system *system, se3d_body body, double *size)
{
    se3d_force_callback_def force = se3d_force_callback_def_default();
    se3d_force made;
    CHECK(!se3d_system_get_ground(system, &force.body_i));
    force.body_j = body;
    force.callback = push;
    force.ctx = size;
    CHECK(!se3d_force_create_callback(system, &force, &made));
}

static void add_driver(se3d_system *system, se3d_body body, double *size)
{
    se3d_function_def function = se3d_function_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_constraint made;
    function.callback = wave;
    function.ctx = size;
    driver.joint = part_hinge(system, "hinge", body, -0.5);
    CHECK(!se3d_function_create(system, &function, &driver.function));
    CHECK(!se3d_driver_create(system, &driver, &made));
}

static void add_level(se3d_system *system, se3d_body body)
{
    se3d_user_constraint_def user = se3d_user_constraint_def_default();
    se3d_constraint made;
    user.callback = level;
    user.bodies[0] = body;
    CHECK(!se3d_user_constraint_create(system, &user, &made));
}

static se3d_system *make(int kind, double *size)
{
    se3d_system *system;
    CHECK(!se3d_system_create(NULL, &system));
    const double none[3] = {0.0};
    CHECK(!se3d_system_set_gravity(system, none));
    const se3d_body body = part_body(system, "body", 0.5, 0.0);
    if (kind == KIND_FORCE) {
        add_force(system, body, size);
    } else if (kind == KIND_DRIVER) {
        add_driver(system, body, size);
    } else {
        add_level(system, body);
        const double v[3] = {1.0, 0.0, 0.0};
        CHECK(!se3d_body_set_velocity(system, body, v));
    }
    return system;
}

static se3d_solver *solve(se3d_system *system, int32_t method, int32_t formulation, double step)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.step = step;
    (void)se3d_solver_create(system, &def, &solver);
    return solver;
}

/* `parts`: 0: one step. */
static se3d_status go(se3d_solver *solver, double end, int parts)
{
    last = end;
    if (parts == 0) {
        return se3d_solver_step(solver, end);
    }
    se3d_status status = SE3D_OK;
    for (int k = 1; k <= parts && status >= 0; ++k) {
        status = se3d_solver_run(solver, k == parts ? end : end * k / parts);
    }
    return status;
}

typedef struct way {
    int32_t method, formulation;
    double step;
    int parts; /* as of `go` */
} way;

static void run_to_end(int kind, double size, const way *by)
{
    const double end = by->parts > 0 ? 0.2 : 1e-3;
    double t = end;
    se3d_system *system = make(kind, &size);
    se3d_solver *solver = solve(system, by->method, by->formulation, by->step);
    const se3d_status status = solver ? go(solver, end, by->parts) : SE3D_OK;
    if (status < 0) {
        fprintf(stderr, "%s, formulation %d, %s of size %g, step %g, %d parts: %s\n",
                se3d_method_get_name(by->method), (int)by->formulation, kinds[kind], size, by->step,
                by->parts, se3d_system_get_error(system));
        CHECK(0);
    }
    CHECK(!solver || se3d_system_get_error_status(system) == SE3D_OK);
    CHECK(!solver || !se3d_system_get_time(system, &t));
    CHECK(t >= end && t <= end);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void no_method_needs_callbacks_beyond_the_end(void)
{
    static const int parts[] = {0, 1, 7};
    for (int32_t n = 0; n < 12 * method_count(); ++n) {
        for (int k = 0; k < 2 * KINDS; ++k) {
            const way by = {n / 12, n / 6 % 2, n / 3 % 2 ? 3e-3 : 0.0, parts[n % 3]};
            run_to_end(k / 2, k % 2 ? 0.3 : 0.0, &by);
        }
    }
}

int main(void)
{
    RUN(no_method_needs_callbacks_beyond_the_end);
    return check_finish();
}
