/* SPDX-License-Identifier: BSD-3-Clause */
/* The forces of friction elements in given modes, with their loads, by Newton's method:
 *
 *     hold    a_k(n) + S_k (n_k - centre_k) = 0      S: several may hold one freedom
 *     slip    n_k = +-(mu_k L_k(n) + limit)          L: convex, with kinks at reactions of zero
 *
 * It begins at n = 0. If it does not converge it goes along s mu_k, s from 0 to 1, so that the
 * solution is the one that begins at mu = 0. If that branch ends before s = 1, friction jams. */
#include "nonlinear/friction_internal.h"

#include "math/larger.h"

#include <math.h>
#include <string.h>

#define PARTS             SE3DI_FRICTION_PARTS
#define ITERATIONS_MAX    30
#define LEVERAGE_MIN      1e-10 /* of a force on its own coordinate, over that on the free bodies */
#define ACCURACY          1e-14
#define ACCURACY_ACCEPTED 1e-10
#define NEGLIGIBLE        1e-2 /* of a force that would hold its coordinate */
#define SHARING           1e-7 /* relative stiffness against one element holding all, and */
#define SHARING_RANGE     1e4  /* the most that a weaker element has of it */
#define CENTRES           8
#define ADVANCE           0.25 /* of s; halved if it fails, */
#define ADVANCE_MIN       1e-3 /* to this */

typedef se3di_friction_system friction;

double se3di_friction_eval_load(const se3di_equations *equations, uint32_t u, double *slope)
{
    const friction *s = &equations->friction;
    const double *R = s->R + (size_t)u * (s->active + 1) * PARTS;
    double sum[PARTS], gradient[PARTS];
    memcpy(sum, R, sizeof sum);
    for (uint32_t v = 0; v < s->active; ++v) {
        for (int c = 0; c < PARTS; ++c) {
            sum[c] += s->n[v] * R[(size_t)(v + 1) * PARTS + (size_t)c];
        }
    }
    const double load = se3di_friction_load(
        equations->assembly.model, se3di_friction_element(equations, s->unknown[u]), sum, gradient);
    for (uint32_t v = 0; v < s->active && slope; ++v) {
        slope[v] = 0.0;
        for (int c = 0; c < PARTS; ++c) {
            slope[v] += gradient[c] * R[(size_t)(v + 1) * PARTS + (size_t)c];
        }
    }
    return load;
}

int se3di_friction_has_leverage(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const se3di_force *force = se3di_friction_element(equations, s->unknown[u]);
    const se3di_model *model = equations->assembly.model;
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    double alone = 0.0;
    se3di_measure measure;
    (void)se3di_measure_force(model, force, 0, &measure);
    for (int k = 0; k < 2; ++k) {
        const se3di_body *body = &model->bodies[bodies[k]];
        const double J = fmax(body->J[0], fmax(body->J[1], body->J[2]));
        for (int c = 0; c < 6 && !body->fixed; ++c) {
            const double g = measure.g[6 * k + c];
            alone += g * g / (c < 3 ? body->mass : J);
        }
    }
    return -s->W[(size_t)u * s->active + u] > LEVERAGE_MIN * alone;
}

void se3di_friction_solve_dense(friction *s)
{
    const uint32_t m = s->active;
    double *J = s->J, *f = s->f;
    double largest = 0.0;
    for (size_t k = 0; k < (size_t)m * m; ++k) {
        largest = fmax(largest, fabs(J[k]));
    }
    for (uint32_t k = 0; k < m; ++k) {
        uint32_t p = k;
        for (uint32_t r = k + 1; r < m; ++r) {
            p = fabs(J[(size_t)r * m + k]) > fabs(J[(size_t)p * m + k]) ? r : p;
        }
        for (uint32_t c = 0; c < m && p != k; ++c) {
            const double keep = J[(size_t)k * m + c];
            J[(size_t)k * m + c] = J[(size_t)p * m + c];
            J[(size_t)p * m + c] = keep;
        }
        const double keep = f[k];
        f[k] = f[p];
        f[p] = keep;
        if (!(fabs(J[(size_t)k * m + k]) > 1e-13 * largest)) {
            J[(size_t)k * m + k] = 0.0;
            continue;
        }
        for (uint32_t r = k + 1; r < m; ++r) {
            const double factor = J[(size_t)r * m + k] / J[(size_t)k * m + k];
            if (fabs(factor) <= 0.0) {
                continue; /* it is of another machine */
            }
            for (uint32_t c = k; c < m; ++c) {
                J[(size_t)r * m + c] -= factor * J[(size_t)k * m + c];
            }
            f[r] -= factor * f[k];
        }
    }
    for (uint32_t k = m; k-- > 0;) {
        for (uint32_t c = k + 1; c < m; ++c) {
            f[k] -= J[(size_t)k * m + c] * f[c];
        }
        f[k] = fabs(J[(size_t)k * m + k]) > 0.0 ? f[k] / J[(size_t)k * m + k] : 0.0;
    }
}

/* As springs of the presliding would: each in proportion to its stiffness F / presliding, with the
 * loads that are there without friction. */
void se3di_friction_weigh(se3di_equations *equations)
{
    friction *s = &equations->friction;
    double largest = 0.0;
    memset(s->n, 0, s->active * sizeof *s->n);
    for (uint32_t u = 0; u < s->active; ++u) {
        const se3di_force *force = se3di_friction_element(equations, s->unknown[u]);
        const double limit =
            force->mu_static * se3di_friction_eval_load(equations, u, NULL) + force->limit;
        s->share[u] = fmax(0.0, -s->W[(size_t)u * s->active + u]) * limit / force->presliding;
        largest = fmax(largest, s->share[u]);
    }
    for (uint32_t u = 0; u < s->active; ++u) {
        const double weaker = s->share[u] > 0.0 ? largest / s->share[u] : SHARING_RANGE;
        s->share[u] = SHARING * fmin(weaker, SHARING_RANGE);
    }
}

/* The row of an unknown that is held: its acceleration over its own leverage, which is a force.
 * @return the residual relative to its parts */
static double eval_held(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const double *W = s->W + (size_t)u * s->active;
    const double unit = se3di_friction_has_leverage(equations, u) ? 1.0 / W[u] : 0.0;
    double *row = s->J + (size_t)u * s->active, size = fabs(unit * s->a[u]);
    s->f[u] = -unit * s->a[u];
    for (uint32_t v = 0; v < s->active; ++v) {
        row[v] = unit * W[v];
        s->f[u] -= row[v] * s->n[v];
        size = fmax(size, fabs(row[v] * s->n[v]));
    }
    s->f[u] -= s->share[u] * (s->n[u] - s->centre[u]);
    row[u] += s->share[u];
    row[u] = unit > 0.0 || unit < 0.0 ? row[u] : 1.0;
    return size > 0.0 ? fabs(s->f[u]) / size : 0.0;
}

/* A force against the coordinate of an unknown that would be as much as what holds any of them: if
 * nothing presses a joint its reaction is rounding of such forces, and its size has a kink at 0. */
static double find_size(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    double largest = 0.0;
    if (!se3di_friction_has_leverage(equations, u)) {
        return 0.0;
    }
    for (uint32_t v = 0; v < s->active; ++v) {
        const double own = -s->W[(size_t)v * (s->active + 1)];
        if (se3di_friction_has_leverage(equations, v)) {
            largest = fmax(largest, fmax(fabs(s->a[v]) / sqrt(own), sqrt(own) * fabs(s->n[v])));
        }
    }
    return largest / sqrt(-s->W[(size_t)u * (s->active + 1)]);
}

/* The same of one that slips, or stays at the limit of what it can hold. */
static double eval_slipping(const se3di_equations *equations, uint32_t u, double part)
{
    const friction *s = &equations->friction;
    const uint32_t k = s->unknown[u];
    const se3di_force *force = se3di_friction_element(equations, k);
    const double way = force->state[SE3DI_FRICTION_MODE];
    const double factor = part * way * (s->stays[k] ? force->mu_static : force->mu);
    double *row = s->J + (size_t)u * s->active;
    double wanted = factor * se3di_friction_eval_load(equations, u, row);
    double size = NEGLIGIBLE * find_size(equations, u);
    wanted += s->rests[k] ? way * force->limit : 0.0; /* else in b */
    s->f[u] = wanted - s->n[u];
    for (uint32_t v = 0; v < s->active; ++v) {
        size = fmax(size, fabs(factor * row[v] * s->n[v])); /* what cancels leaves rounding */
        row[v] = (v == u ? 1.0 : 0.0) - factor * row[v];
    }
    size = fmax(size, fmax(fabs(wanted), fabs(s->n[u])));
    return size > 0.0 ? fabs(s->f[u]) / size : 0.0;
}

/* The largest relative residual of n, loads counting in part; with the Newton matrix. */
static double eval_system(const se3di_equations *equations, double part)
{
    const friction *s = &equations->friction;
    double largest = 0.0;
    for (uint32_t u = 0; u < s->active; ++u) {
        const double residual =
            s->holds[s->unknown[u]] ? eval_held(equations, u) : eval_slipping(equations, u, part);
        largest = se3di_larger(largest, residual);
    }
    return largest;
}

/* n of the unknowns, from where it is. @return whether it converged */
static int iterate(se3di_equations *equations, double part)
{
    friction *s = &equations->friction;
    double before = HUGE_VAL;
    for (int k = 0; k < ITERATIONS_MAX; ++k) {
        const double residual = eval_system(equations, part);
        if (residual <= ACCURACY || (residual <= ACCURACY_ACCEPTED && residual >= 0.5 * before)) {
            return 1;
        }
        before = residual;
        se3di_friction_solve_dense(s);
        for (uint32_t u = 0; u < s->active; ++u) {
            s->n[u] += s->f[u];
        }
    }
    return 0;
}

/* Along the branch that begins without the loads' friction. */
static int follow_branch(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const size_t bytes = s->active * sizeof *s->n;
    double part = 0.0, advance = ADVANCE;
    memset(s->n, 0, bytes);
    if (!iterate(equations, 0.0)) {
        return 0;
    }
    while (part < 1.0) {
        const double next = fmin(1.0, part + advance);
        memcpy(s->kept, s->n, bytes);
        if (iterate(equations, next)) {
            part = next;
            advance *= 1.5;
        } else {
            memcpy(s->n, s->kept, bytes);
            advance *= 0.5;
        }
        if (advance < ADVANCE_MIN) {
            return 0;
        }
    }
    return 1;
}

/* What sharing bends is taken back by moving its centre. */
static int centre(se3di_equations *equations)
{
    friction *s = &equations->friction;
    double change = HUGE_VAL;
    int any = 0;
    for (uint32_t u = 0; u < s->active; ++u) {
        any |= s->holds[s->unknown[u]];
    }
    for (int step = 0; any && step < CENTRES && change > 1e-13; ++step) {
        double largest = 0.0;
        memcpy(s->centre, s->n, s->active * sizeof *s->n);
        if (!iterate(equations, 1.0)) {
            return 0;
        }
        change = 0.0;
        for (uint32_t u = 0; u < s->active; ++u) {
            change = se3di_larger(change, fabs(s->n[u] - s->centre[u]));
            largest = fmax(largest, fabs(s->n[u]));
        }
        change = largest > 0.0 ? change / largest : 0.0;
    }
    return 1;
}

int se3di_friction_solve_forces(se3di_equations *equations)
{
    friction *s = &equations->friction;
    memset(s->n, 0, s->active * sizeof *s->n);
    memset(s->centre, 0, s->active * sizeof *s->centre);
    return (iterate(equations, 1.0) || follow_branch(equations)) && centre(equations);
}

se3d_status se3di_friction_refuse(const se3di_equations *equations, double t)
{
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: friction jams: it and the reaction that it follows from "
                           "raise each other without end",
                           t);
}
