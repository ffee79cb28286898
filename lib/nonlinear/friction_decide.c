/* SPDX-License-Identifier: BSD-3-Clause */
/* Which elements that stand still stick, and to where the others begin to slip: with loads as they
 * are, a convex problem that has a solution and ends (friction_box.h); with its modes, the forces
 * and loads (friction_newton.c), which are the next ones; until nothing contradicts. If that
 * goes round, loads move half the way. An element that begins to slip under mu_static is at mu from
 * then on, so that this ends, too.  docs/theory/friction.md */
#include "nonlinear/friction_box.h"
#include "nonlinear/friction_internal.h"

#include <math.h>
#include <string.h>

#define ROUNDS_MAX   100
#define ROUNDS_WHOLE 10   /* then loads move half the way */
#define MOVING       1e-9 /* of the parts of an acceleration: less is rounding */
#define NOISE        1e-12

typedef se3di_friction_system friction;

static se3di_force *element_of(const se3di_equations *equations, uint32_t u)
{
    return se3di_friction_element(equations, equations->friction.unknown[u]);
}

/* The acceleration of the coordinate of the unknown u under n, and the size of its parts. */
static double acceleration_of(const friction *s, uint32_t u, const double *n, double *size)
{
    double sum = s->a[u];
    *size = fabs(sum);
    for (uint32_t v = 0; v < s->active; ++v) {
        const double part = s->W[(size_t)u * s->active + v] * n[v];
        sum += part;
        *size += fabs(part);
    }
    return sum;
}

/* The largest part of an acceleration of coordinates of the same kind: what rounding is of. */
static double scale_of(const se3di_equations *equations, uint32_t u, const double *n)
{
    const friction *s = &equations->friction;
    double largest = 0.0;
    for (uint32_t v = 0; v < s->active; ++v) {
        if (element_of(equations, v)->coordinate == element_of(equations, u)->coordinate) {
            const double own = s->W[(size_t)v * s->active + v] * n[v];
            largest = fmax(largest, fabs(s->a[v]) + fabs(own));
        }
    }
    return largest;
}

/* -1, 0 or 1: whereto the coordinate moves under n. */
static int direction_of(const se3di_equations *equations, uint32_t u, const double *n)
{
    double size;
    const double a = acceleration_of(&equations->friction, u, n, &size);
    double still = fmax(MOVING * size, NOISE * scale_of(equations, u, n));
    if (!se3di_friction_has_leverage(equations, u)) {
        still = fmax(still, SE3DI_FRICTION_REST);
    }
    return a > still ? 1 : a < -still ? -1 : 0;
}

/* The unknown that an element is, or `active`. */
static uint32_t unknown_of(const friction *s, uint32_t k)
{
    uint32_t u = 0;
    while (u < s->active && s->unknown[u] != k) {
        ++u;
    }
    return u;
}

int se3di_friction_system_moves(const se3di_equations *equations, uint32_t k)
{
    const friction *s = &equations->friction;
    const uint32_t u = unknown_of(s, k);
    return u < s->active ? direction_of(equations, u, s->n) : 0;
}

int se3di_friction_system_can_hold(const se3di_equations *equations, uint32_t k)
{
    const uint32_t u = unknown_of(&equations->friction, k);
    return u < equations->friction.active && se3di_friction_has_leverage(equations, u);
}

/* What the unknown u can hold with, or slips with where it has begun to, under the loads of n. */
static double limit_of(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const se3di_force *force = element_of(equations, u);
    const int slides = s->slides[s->unknown[u]];
    return (slides ? force->mu : force->mu_static) * se3di_friction_eval_load(equations, u, NULL) +
           force->limit;
}

/* Limits, and the force of those that are not in question, under the loads of n. */
static void set_limits(const se3di_equations *equations, double *guess)
{
    const friction *s = &equations->friction;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        const se3di_force *force = element_of(equations, u);
        const int is_free = s->rests[k] || s->holds[k];
        s->fixed[u] = !is_free || !se3di_friction_has_leverage(equations, u);
        s->limit[u] = s->rests[k] ? limit_of(equations, u) : HUGE_VAL;
        if (!s->rests[k]) {
            guess[u] = force->state[SE3DI_FRICTION_MODE] * force->mu *
                       se3di_friction_eval_load(equations, u, NULL);
        } else if (s->fixed[u]) {
            guess[u] = s->at[u] * s->limit[u];
        }
    }
}

/* What the solution under the present limits changes in them. @return whether anything */
static int follow_limits(const se3di_equations *equations, const double *guess)
{
    const friction *s = &equations->friction;
    int changes = 0;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        if (!s->rests[k]) {
            continue;
        }
        const int way = direction_of(equations, u, guess);
        if (s->fixed[u]) { /* it cannot hold: it slips to where it goes */
            changes |= way != s->at[u];
            s->at[u] = way;
        } else if (s->at[u] != 0 && way == s->at[u] && !s->slides[k]) {
            const se3di_force *force = element_of(equations, u);
            s->slides[k] = 1;
            changes |= force->mu < force->mu_static;
        }
    }
    return changes;
}

/* The modes, by convex problems with the loads of n; `guess`: their forces. */
static void choose_modes(se3di_equations *equations, double *guess)
{
    friction *s = &equations->friction;
    const uint32_t m = s->active;
    const se3di_friction_box box = {m,        0,     s->P,     s->a,  s->limit,
                                    s->stiff, s->at, s->fixed, guess, s->work};
    for (uint32_t u = 0; u < m; ++u) {
        s->at[u] = s->slides[s->unknown[u]] = 0;
    }
    for (uint32_t pass = 0; pass <= m; ++pass) {
        set_limits(equations, guess);
        se3di_friction_box_solve(&box);
        if (!follow_limits(equations, guess)) {
            break;
        }
    }
    for (uint32_t u = 0; u < m; ++u) {
        const uint32_t k = s->unknown[u];
        if (s->rests[k]) {
            element_of(equations, u)->state[SE3DI_FRICTION_MODE] = s->at[u];
            s->holds[k] = s->at[u] == 0;
            s->stays[k] = s->at[u] != 0 && direction_of(equations, u, guess) != s->at[u];
        }
    }
}

/* Whether n contradicts what is assumed of the unknown u, at rest. */
static int contradicts(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const uint32_t k = s->unknown[u];
    const int way = direction_of(equations, u, s->n);
    const double mode = element_of(equations, u)->state[SE3DI_FRICTION_MODE];
    if (s->stays[k]) {
        return way != 0;
    }
    if (!s->holds[k]) { /* it slips to where it does not go */
        return mode * way < 0.0;
    }
    return se3di_friction_has_leverage(equations, u)
               ? fabs(s->n[u]) > limit_of(equations, u) * (1.0 + MOVING)
               : way != 0;
}

static int has_contradictions(const se3di_equations *equations)
{
    const friction *s = &equations->friction;
    for (uint32_t u = 0; u < s->active; ++u) {
        if (s->rests[s->unknown[u]] && contradicts(equations, u)) {
            return 1;
        }
    }
    return 0;
}

/* The problem of choose_modes, but for its limits. */
static void set_up(const se3di_equations *equations)
{
    const friction *s = &equations->friction;
    const uint32_t m = s->active;
    for (uint32_t u = 0; u < m; ++u) {
        for (uint32_t v = 0; v < m; ++v) {
            s->P[(size_t)u * m + v] = -0.5 * (s->W[(size_t)u * m + v] + s->W[(size_t)v * m + u]);
        }
        s->stiff[u] = s->share[u] * fmax(0.0, s->P[(size_t)u * m + u]);
    }
}

static se3d_status decide(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    const size_t bytes = s->active * sizeof *s->n;
    int solved = 0;
    set_up(equations);
    memset(s->n, 0, bytes);
    for (int round = 0; round < ROUNDS_MAX; ++round) {
        memset(s->guess, 0, bytes);
        memcpy(s->loaded, s->n, bytes);
        choose_modes(equations, s->guess);
        solved = se3di_friction_solve_forces(equations);
        if (solved && !has_contradictions(equations)) {
            return SE3D_OK;
        }
        const double *next = solved ? s->n : s->guess, part = round < ROUNDS_WHOLE ? 1.0 : 0.5;
        for (uint32_t u = 0; u < s->active; ++u) {
            s->n[u] = s->loaded[u] + part * (next[u] - s->loaded[u]);
        }
    }
    return solved ? se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                                    "t = %g s: friction jams: what it holds and what slips do not "
                                    "agree",
                                    t)
                  : se3di_friction_refuse(equations, t);
}

/* What was at rest knows what it does now. What stays at its limit slips, though nothing moves: the
 * others hold what is left. */
static void settle(se3di_equations *equations)
{
    friction *s = &equations->friction;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        se3di_force *force = element_of(equations, u);
        if (s->rests[k]) {
            se3di_friction_set(equations->assembly.model, force, force->state[SE3DI_FRICTION_MODE],
                               s->n[u]);
        }
    }
}

static se3d_status decide_rests(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    se3di_assembly *assembly = &equations->assembly;
    for (uint32_t k = 0; k < s->count; ++k) {
        if (s->rests[k]) {
            se3di_friction_silence(se3di_friction_element(equations, k));
        }
    }
    se3di_friction_system_begin(equations);
    se3di_assembly_eval_gamma(assembly, equations->c);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, t, equations->b, equations->error));
    SE3DI_TRY(se3di_equations_solve(equations));
    SE3DI_TRY(se3di_friction_respond(equations));
    SE3DI_TRY(decide(equations, t));
    se3di_friction_combine(equations);
    (void)se3di_friction_arrest(equations);
    settle(equations);
    return SE3D_OK;
}

se3d_status se3di_friction_system_decide(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    const se3d_status status = decide_rests(equations, t);
    memset(s->rests, 0, s->count * sizeof *s->rests); /* or they would hold what comes next */
    memset(s->stays, 0, s->count * sizeof *s->stays);
    return status;
}
