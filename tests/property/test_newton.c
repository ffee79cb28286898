/* SPDX-License-Identifier: BSD-3-Clause */
/* Newton's iteration of the implicit methods, on a mechanism that spins fast, with joints that have
 * curvature of every kind and a spring and damper that are stiff enough to need the matrix: where
 * every iteration factors the exact matrix anew, corrections fall quadratically. radau's matrix is
 * one for three stages: there they fall linearly, at the rate its coefficients were made for. */
#include <stdlib.h>

#include "check.h"
#include "support/world.h"
#include "system/solver.h"

typedef struct world {
    se3d_system *system;
    se3d_body ground, body[2];
} world;

static void must(const world *w, se3d_status status)
{
    world_must(w->system, status, "a call of the test");
}

static void add_body(world *w, int k, const double r[3], const double spin[3])
{
    se3d_body_def def = se3d_body_def_default();
    def.mass = 2.0 + k;
    def.inertia[0] = 0.3;
    def.inertia[1] = 0.5 + 0.1 * k;
    def.inertia[2] = 0.4;
    def.inertia[3] = 0.03;
    memcpy(def.position, r, sizeof def.position);
    memcpy(def.angular_velocity, spin, sizeof def.angular_velocity);
    must(w, se3d_body_create(w->system, &def, &w->body[k]));
}

static void add_joint(const world *w, joint_create create, se3d_body i, se3d_body j,
                      const double at[3], const double axis[3])
{
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    def.body_i = i;
    def.body_j = j;
    must(w, se3d_joint_def_set_frame(w->system, &def, at, axis, NULL));
    if (create == se3d_joint_create_universal) { /* the cross: its arms are normal */
        def.axis_j[0] = axis[1];
        def.axis_j[1] = -axis[0];
        def.axis_j[2] = 0.0;
    }
    must(w, create(w->system, &def, &joint));
}

static world open_world(void)
{
    world w;
    const double A[3] = {0.0, 0.0, 0.0}, B[3] = {1.0, 0.0, 0.0};
    const double z[3] = {0.0, 0.0, 1.0}, x[3] = {1.0, 0.0, 0.0};
    must(&w, se3d_system_create(NULL, &w.system));
    must(&w, se3d_system_get_ground(w.system, &w.ground));
    add_body(&w, 0, (const double[3]){0.5, 0.0, 0.0}, (const double[3]){0.0, 0.0, 9.0});
    add_body(&w, 1, (const double[3]){1.0, 0.4, 0.2}, (const double[3]){8.0, -5.0, 3.0});
    add_joint(&w, se3d_joint_create_revolute, w.ground, w.body[0], A, z);
    add_joint(&w, se3d_joint_create_universal, w.body[0], w.body[1], B, x);
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    spring.body_i = w.ground;
    spring.body_j = w.body[1];
    spring.point_i[1] = 2.0;
    spring.point_j[2] = 0.3;
    spring.k = 4e4;
    spring.c = 300.0;
    spring.l0 = 1.5;
    must(&w, se3d_force_create_tsda(w.system, &spring, &force));
    return w;
}

static se3di_newton_trace follow_step(int32_t method, int32_t formulation, double h)
{
    world w = open_world();
    se3d_solver *solver;
    se3di_newton_trace trace = {.count = 0};
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.tolerance = 1e-9;
    def.step = h;
    def.order = method == SE3D_METHOD_BDF ? 1 : 0;
    must(&w, se3d_solver_create(w.system, &def, &solver));
    must(&w, se3d_solver_run(solver, 0.0));
    if (method == SE3D_METHOD_BDF) { /* whose first step is one of radau */
        must(&w, se3d_solver_step(solver, h));
    }
    solver->run.integration.newton.trace = &trace;
    must(&w, se3d_solver_step(solver, h));
    se3d_solver_destroy(solver);
    se3d_system_destroy(w.system);
    if (getenv("SE3D_TEST_VERBOSE")) {
        for (int32_t k = 0; k < trace.count; ++k) {
            fprintf(stderr, "%s %d %d: %d %.3e\n", check_case, (int)method, (int)formulation,
                    (int)k, trace.size[k]);
        }
    }
    return trace;
}

/* The order of convergence, by the three corrections before rounding shows. */
static double order_of(const se3di_newton_trace *trace, double rounding)
{
    double order = 0.0;
    for (int32_t k = 0; k + 2 < trace->count && trace->size[k + 2] > rounding; ++k) {
        order =
            log(trace->size[k + 2] / trace->size[k + 1]) / log(trace->size[k + 1] / trace->size[k]);
    }
    return order;
}

static void exact_matrices_converge_quadratically(void)
{
    static const struct {
        int32_t method;
        double h, rounding;
    } rows[] = {
        {SE3D_METHOD_GENERALIZED_ALPHA, 0.004, 1e-6},
        {SE3D_METHOD_HHT, 0.004, 1e-6},
        {SE3D_METHOD_BDF, 0.004, 1e-12},
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_RP; ++f) {
            const se3di_newton_trace trace = follow_step(rows[k].method, f, rows[k].h);
            CHECK(trace.count >= 4 && trace.count <= 8);
            CHECK(order_of(&trace, rows[k].rounding) > 1.75);
        }
    }
}

/* |M(z)^3|^(1/3) <= 0.37 on the left half-plane, and 0.03 at |z| = 0.2. */
static void radau_converges_at_its_rate(void)
{
    for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_RP; ++f) {
        for (int stiff = 0; stiff < 2; ++stiff) {
            const se3di_newton_trace trace =
                follow_step(SE3D_METHOD_RADAU, f, stiff ? 0.008 : 0.001);
            const double least = 1e-11;
            int32_t last = 0;
            while (last + 1 < trace.count && trace.size[last + 1] > least) {
                ++last;
            }
            CHECK(last >= 2);
            CHECK(pow(trace.size[last] / trace.size[0], 1.0 / last) < (stiff ? 0.22 : 0.03));
        }
    }
}

int main(void)
{
    RUN(exact_matrices_converge_quadratically);
    RUN(radau_converges_at_its_rate);
    return check_finish();
}
