/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations on copies of the system, and queries: what must agree. */
#include "calls.h"

#include <math.h>
#include <stdlib.h>

enum { BODIES_MAX = CALLS_KEPT + 1, COORDINATES_MAX = 7 * CALLS_KEPT };

/* How far three formulations may be apart, over the size of what they compute. */
#define AGREEMENT 1e-5

/* A copy has the same state, and goes on with the same bits. */
void calls_clone(calls *c)
{
    se3d_system *copy = NULL;
    se3d_solver *solvers[2] = {NULL, NULL};
    se3d_status status[2] = {SE3D_OK, SE3D_OK};
    if (!calls_ended(c, se3d_system_clone(c->system, &copy))) {
        FUZZ_MUST(!copy);
        return;
    }
    se3d_system *const systems[2] = {c->system, copy};
    FUZZ_MUST(se3d_system_hash(copy) == se3d_system_hash(c->system));
    const long left = c->memory.left;
    c->memory.left = -1;
    for (int k = 0; k < 2; ++k) {
        c->patience.left = CALLS_STEPS;
        status[k] = se3d_solver_create(systems[k], &c->solver_def, &solvers[k]);
        if (status[k] >= 0) {
            status[k] = se3d_solver_step(solvers[k], 2e-3);
        }
    }
    FUZZ_MUST(status[0] == status[1]);
    FUZZ_MUST_SAY(se3d_system_hash(copy) == se3d_system_hash(c->system), "a copy goes on alike");
    for (int k = 0; k < 2; ++k) {
        se3d_solver_destroy(solvers[k]);
    }
    se3d_system_destroy(copy);
    c->memory.left = left;
    fuzz_check_finite(c->system, "after a step beside a copy");
    (void)calls_ended(c, status[0]);
}

typedef struct outcome {
    se3d_status status;
    size_t count;
    double r[3 * BODIES_MAX], v[3 * BODIES_MAX], w[3 * BODIES_MAX];
} outcome;

static outcome run_formulation(calls *c, int32_t formulation)
{
    outcome o = {.status = SE3D_OK};
    se3d_system *copy = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    double time;
    def.method = SE3D_METHOD_DOP853;
    def.formulation = formulation;
    def.tolerance = 1e-9;
    def.interrupt = fuzz_interrupt;
    def.interrupt_ctx = &c->patience;
    c->patience.left = CALLS_STEPS;
    o.status = se3d_system_clone(c->system, &copy);
    FUZZ_MUST(o.status >= 0);
    FUZZ_MUST(!se3d_system_get_time(copy, &time));
    o.status = se3d_solver_create(copy, &def, &solver);
    if (o.status >= 0) {
        o.status = se3d_solver_run(solver, time + 0.02);
        fuzz_check_finite(copy, "after a run of a formulation");
    }
    o.count = se3d_system_count_bodies(copy);
    FUZZ_MUST(o.count <= BODIES_MAX);
    FUZZ_MUST(!se3d_body_get_all(copy, o.count, o.r, NULL, o.v, o.w));
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
    return o;
}

static double get_distance(const double *a, const double *b, size_t count)
{
    double most = 0.0, size = 1.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
        size = fmax(size, fabs(a[k]));
    }
    return most / size;
}

/* A constrained start that fits, and equations that all count: there the motion is one. */
static int is_regular(calls *c)
{
    se3d_check *check = NULL;
    se3d_check_summary summary = {.struct_size = sizeof summary};
    double violation[3] = {1.0, 1.0, 1.0};
    const se3d_status status = se3d_check_create(c->system, &check);
    int regular = status == SE3D_OK && !se3d_check_get_summary(check, &summary) &&
                  summary.redundant == 0 && c->force_count == 0 && c->shape_count == 0;
    se3d_check_destroy(check);
    regular = regular && se3d_system_get_violation(c->system, violation) >= 0;
    return regular && violation[0] < 1e-9 && violation[1] < 1e-9;
}

/* r-omega, r-p and joint coordinates give the same motion. */
void calls_agree(calls *c)
{
    static const int32_t all[] = {SE3D_FORMULATION_ROMEGA, SE3D_FORMULATION_RP,
                                  SE3D_FORMULATION_JOINT};
    outcome first = {.status = SE3D_OK};
    const long left = c->memory.left;
    c->memory.left = -1;
    if (is_regular(c)) {
        for (size_t k = 0; k < sizeof all / sizeof *all; ++k) {
            const outcome o = run_formulation(c, all[k]);
            const size_t n = 3 * o.count;
            if (k == 0) {
                first = o;
            } else if (o.status == SE3D_OK && first.status == SE3D_OK) {
                FUZZ_MUST(get_distance(o.r, first.r, n) < AGREEMENT);
                FUZZ_MUST(get_distance(o.v, first.v, n) < AGREEMENT);
                FUZZ_MUST(get_distance(o.w, first.w, n) < AGREEMENT);
            }
        }
    }
    c->memory.left = left;
}

static void check_all(const double *x, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        FUZZ_MUST(isfinite(x[k]));
    }
}

/* States of a batch that begin alike stay alike to the bit, whatever lane they are in. */
void calls_batch(calls *c)
{
    se3d_batch *batch = NULL;
    const size_t states = 1 + calls_pick(c, 9);
    double q[2][COORDINATES_MAX], qdot[2][COORDINATES_MAX];
    if (!calls_ended(c, se3d_batch_create(c->system, states, 1, &batch))) {
        FUZZ_MUST(!batch);
        return;
    }
    const size_t nq = se3d_batch_count_positions(batch), nv = se3d_batch_count_velocities(batch);
    FUZZ_MUST(nq <= COORDINATES_MAX && nv <= nq);
    const se3d_status status = se3d_batch_step(batch, SE3D_METHOD_RK4, 1e-3, 3);
    FUZZ_MUST(status >= 0 || se3d_batch_get_error(batch)[0]);
    FUZZ_MUST(!se3d_batch_get_state(batch, 0, 1, q[0], qdot[0]));
    FUZZ_MUST(!se3d_batch_get_state(batch, states - 1, 1, q[1], qdot[1]));
    check_all(q[0], nq);
    check_all(qdot[0], nv);
    for (size_t k = 0; k < nq; ++k) {
        FUZZ_MUST(q[0][k] == q[1][k]);
    }
    for (size_t k = 0; k < nv; ++k) {
        FUZZ_MUST(qdot[0][k] == qdot[1][k]);
    }
    se3d_batch_destroy(batch);
}

/* Mass matrix: what multiplies and what solves undo each other. */
void calls_coordinates(calls *c)
{
    se3d_coordinates *coordinates = NULL;
    double x[COORDINATES_MAX], y[COORDINATES_MAX], z[COORDINATES_MAX];
    if (!calls_ended(c, se3d_coordinates_create(c->system, &coordinates))) {
        FUZZ_MUST(!coordinates);
        return;
    }
    const size_t n = se3d_coordinates_count(coordinates);
    const uint64_t before = calls_state(c);
    FUZZ_MUST(n <= COORDINATES_MAX);
    for (size_t k = 0; k < n; ++k) {
        x[k] = 1.0 + 0.1 * (double)k;
    }
    FUZZ_MUST(!se3d_coordinates_multiply_mass(coordinates, x, y));
    if (!se3d_coordinates_solve_mass(coordinates, y, z)) {
        FUZZ_MUST(get_distance(z, x, n) < AGREEMENT);
    }
    if (calls_ended(c, se3d_coordinates_compute_accelerations(coordinates, NULL, z))) {
        check_all(z, n);
    }
    FUZZ_MUST(calls_state(c) == before);
    se3d_coordinates_destroy(coordinates);
}

void calls_check(calls *c)
{
    se3d_check *check = NULL;
    se3d_check_summary summary = {.struct_size = sizeof summary};
    const uint64_t before = calls_state(c);
    if (calls_ended(c, se3d_check_create(c->system, &check))) {
        FUZZ_MUST(!se3d_check_get_summary(check, &summary));
        FUZZ_MUST(summary.rank + summary.redundant == summary.equations);
        FUZZ_MUST(summary.freedoms + summary.rank == 6 * summary.bodies);
    }
    se3d_check_destroy(check);
    FUZZ_MUST(calls_state(c) == before);
}

void calls_modes(calls *c)
{
    se3d_modes *modes = NULL;
    if (calls_ended(c, se3d_modes_create(c->system, NULL, &modes))) {
        for (size_t k = 0; k < se3d_modes_count(modes); ++k) {
            se3d_eigenvalue value;
            FUZZ_MUST(!se3d_modes_get_eigenvalue(modes, k, &value));
            FUZZ_MUST(isfinite(value.real) && isfinite(value.imaginary));
        }
    }
    se3d_modes_destroy(modes);
}

/* Getters of what an analysis left, which may refuse; what they give is finite. */
void calls_query(calls *c)
{
    const size_t k = calls_pick(c, CALLS_KEPT);
    double a[6], b[3];
    if (se3d_body_get_acceleration(c->system, c->bodies[k], a) >= 0) {
        check_all(a, 3);
    }
    if (se3d_constraint_get_reaction(c->system, c->joints[k], a, b) >= 0) {
        check_all(a, 3);
        check_all(b, 3);
    }
    if (se3d_force_get_wrench(c->system, c->forces[k], 0, a) >= 0) {
        check_all(a, 6);
    }
    if (se3d_driver_get_effort(c->system, c->joints[k], a) >= 0) {
        check_all(a, 1);
    }
}
