/* SPDX-License-Identifier: BSD-3-Clause */
#include "nonlinear/friction_system.h"

#include "force/friction.h"
#include "force/measure.h"
#include "nonlinear/equations.h"

#include <math.h>
#include <string.h>

#define PARTS             SE3DI_FRICTION_PARTS
#define ITERATIONS_MAX    50
#define ROUNDS_MAX        100
#define ROUNDS_TOGETHER   20    /* then one element at a time changes */
#define LEVERAGE_MIN      1e-10 /* of a force on its own coordinate, over that on the free bodies */
#define ACCURACY          1e-14
#define SHARING           1e-7 /* relative stiffness against one element holding all */
#define ACCURACY_ACCEPTED 1e-10

typedef se3di_friction_system friction;

/* memcpy if count may be zero and the pointers NULL. */
static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

/* Allocation. */

#define ARRAYS 13

static void list_arrays(friction *s, const se3di_assembly *assembly, double **list[ARRAYS],
                        size_t size[ARRAYS])
{
    const size_t m = s->count, n = assembly->unknown_count, rows = assembly->row_count;
    struct {
        double **place;
        size_t size;
    } const parts[ARRAYS] = {
        {&s->n, m},           {&s->shared, m},
        {&s->Q, 16 * m},      {&s->b, n},
        {&s->c, rows},        {&s->x, n},
        {&s->l, rows},        {&s->X, m * n},
        {&s->L, m * rows},    {&s->R, m * (m + 1) * PARTS},
        {&s->a, m},           {&s->W, m * m},
        {&s->J, m * (m + 1)},
    };
    for (int k = 0; k < ARRAYS; ++k) {
        list[k] = parts[k].place;
        size[k] = parts[k].size;
    }
}

static void list_elements(friction *s, const se3di_model *model)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_FRICTION) {
            s->element[count++] = k;
        }
    }
    memset(s->holds, 0, count * sizeof *s->holds);
    memset(s->rests, 0, count * sizeof *s->rests);
}

static uint32_t count_elements(const se3di_model *model)
{
    uint32_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += model->forces[k].type == SE3DI_FORCE_FRICTION;
    }
    return count;
}

se3d_status se3di_friction_system_init(friction *s, const se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    double **list[ARRAYS];
    size_t size[ARRAYS];
    int complete = 1;
    *s = (friction){.count = count_elements(assembly->model)};
    if (s->count == 0) {
        return SE3D_OK;
    }
    s->element = se3di_alloc(allocator, s->count, sizeof *s->element);
    s->unknown = se3di_alloc(allocator, s->count, sizeof *s->unknown);
    s->holds = se3di_alloc(allocator, s->count, sizeof *s->holds);
    s->rests = se3di_alloc(allocator, s->count, sizeof *s->rests);
    complete = s->element && s->unknown && s->holds && s->rests;
    list_arrays(s, assembly, list, size);
    for (int k = 0; k < ARRAYS && complete; ++k) {
        *list[k] = se3di_alloc(allocator, size[k], sizeof(double));
        complete = *list[k] != NULL;
    }
    if (!complete) {
        se3di_friction_system_destroy(s, assembly);
        return SE3D_ERR_NO_MEMORY;
    }
    s->f = s->J + (size_t)s->count * s->count;
    list_elements(s, assembly->model);
    return SE3D_OK;
}

void se3di_friction_system_destroy(friction *s, const se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    double **list[ARRAYS];
    size_t size[ARRAYS];
    list_arrays(s, assembly, list, size);
    for (int k = 0; k < ARRAYS; ++k) {
        se3di_free(allocator, *list[k], size[k], sizeof(double));
    }
    se3di_free(allocator, s->element, s->count, sizeof *s->element);
    se3di_free(allocator, s->unknown, s->count, sizeof *s->unknown);
    se3di_free(allocator, s->holds, s->count, sizeof *s->holds);
    se3di_free(allocator, s->rests, s->count, sizeof *s->rests);
    memset(s, 0, sizeof *s);
}

/* Units. */

static se3di_force *element_of(const se3di_equations *equations, uint32_t k)
{
    return &equations->assembly.model->forces[equations->friction.element[k]];
}

/* Generalised force of a unit on the coordinate, on bodies i and j; zero on fixed ones. */
static void eval_unit(const se3di_assembly *assembly, const se3di_force *force, double Q[16])
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    se3di_measure measure;
    memset(Q, 0, 16 * sizeof *Q);
    (void)se3di_measure_force(assembly->model, force, 0, &measure);
    for (int k = 0; k < 2; ++k) {
        if (assembly->free_index[bodies[k]] >= 0) {
            assembly->formulation->add_wrench(&assembly->model->frames[bodies[k]],
                                              measure.g + 6 * k, measure.g + 6 * k + 3, Q + 8 * k);
        }
    }
}

/* b += n Q */
static void add_unit(const se3di_assembly *assembly, const se3di_force *force, const double Q[16],
                     double n, double *b)
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    const size_t block = (size_t)assembly->formulation->block;
    for (size_t k = 0; k < 2; ++k) {
        const int32_t at = assembly->free_index[bodies[k]];
        for (size_t c = 0; at >= 0 && c < block; ++c) {
            b[(size_t)at * block + c] += n * Q[8 * k + c];
        }
    }
}

static double dot_unit(const se3di_assembly *assembly, const se3di_force *force, const double Q[16],
                       const double *x)
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    const size_t block = (size_t)assembly->formulation->block;
    double sum = 0.0;
    for (size_t k = 0; k < 2; ++k) {
        const int32_t at = assembly->free_index[bodies[k]];
        for (size_t c = 0; at >= 0 && c < block; ++c) {
            sum += x[(size_t)at * block + c] * Q[8 * k + c];
        }
    }
    return sum;
}

double se3di_friction_system_acceleration(const se3di_equations *equations, uint32_t k)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_force *force = element_of(equations, k);
    double Q[16];
    eval_unit(assembly, force, Q);
    return dot_unit(assembly, force, Q, equations->x) + se3di_measure_curve(assembly->model, force);
}

/* The solution for a unit force against each unknown's coordinate. */
static se3d_status solve_units(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        eval_unit(assembly, element_of(equations, k), s->Q + 16 * (size_t)k);
        memset(equations->b, 0, n * sizeof *equations->b);
        for (size_t r = 0; r < rows; ++r) {
            equations->c[r] = 0.0;
        }
        add_unit(assembly, element_of(equations, k), s->Q + 16 * (size_t)k, -1.0, equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        copy(s->X + u * n, equations->x, n);
        copy(s->L + u * rows, equations->l, rows);
    }
    return SE3D_OK;
}

/* Reactions and accelerations of every unknown, without friction and by every unit. */
static void eval_responses(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        const se3di_force *force = element_of(equations, k);
        const double *Q = s->Q + 16 * (size_t)k;
        double *R = s->R + (size_t)u * (s->active + 1) * PARTS;
        s->a[u] = dot_unit(assembly, force, Q, s->x) + se3di_measure_curve(assembly->model, force);
        se3di_friction_reaction(assembly->model, force, s->l, R);
        for (uint32_t v = 0; v < s->active; ++v) {
            s->W[(size_t)u * s->active + v] = dot_unit(assembly, force, Q, s->X + v * n);
            se3di_friction_reaction(assembly->model, force, s->L + v * rows,
                                    R + (size_t)(v + 1) * PARTS);
        }
    }
}

/* The load of the unknown u under n, and its slopes to all n. */
static double eval_load(const se3di_equations *equations, uint32_t u, double *slope)
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
    const double load = se3di_friction_load(equations->assembly.model,
                                            element_of(equations, s->unknown[u]), sum, gradient);
    for (uint32_t v = 0; v < s->active && slope; ++v) {
        slope[v] = 0.0;
        for (int c = 0; c < PARTS; ++c) {
            slope[v] += gradient[c] * R[(size_t)(v + 1) * PARTS + (size_t)c];
        }
    }
    return load;
}

/* A force that has no leverage on its own coordinate cannot hold it. */
static int has_leverage(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const se3di_force *force = element_of(equations, s->unknown[u]);
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

/* J x = f, x into f, by elimination with pivots; what cannot be told is zero. */
static void solve_dense(friction *s)
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

/* The row of an unknown that is held: its acceleration over its own leverage, which is a force.
 * Several may hold one freedom: what is added to the diagonal makes them share it. @return the
 * residual relative to its parts */
static double eval_held(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const double *W = s->W + (size_t)u * s->active;
    const double unit = has_leverage(equations, u) ? 1.0 / W[u] : 0.0;
    double *row = s->J + (size_t)u * s->active, size = fabs(unit * s->a[u]);
    s->f[u] = -unit * s->a[u];
    for (uint32_t v = 0; v < s->active; ++v) {
        row[v] = unit * W[v];
        s->f[u] -= row[v] * s->n[v];
        size = fmax(size, fabs(row[v] * s->n[v]));
    }
    s->f[u] -= SHARING * (s->n[u] - s->shared[u]);
    row[u] += SHARING;
    row[u] = unit > 0.0 || unit < 0.0 ? row[u] : 1.0;
    return size > 0.0 ? fabs(s->f[u]) / size : 0.0;
}

/* The same of one that slips. */
static double eval_slipping(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const se3di_force *force = element_of(equations, s->unknown[u]);
    const double way = force->state[SE3DI_FRICTION_MODE], factor = way * force->mu;
    double *row = s->J + (size_t)u * s->active;
    double wanted = factor * eval_load(equations, u, row), size = 0.0;
    wanted += s->rests[s->unknown[u]] ? way * force->limit : 0.0; /* else in b */
    s->f[u] = wanted - s->n[u];
    for (uint32_t v = 0; v < s->active; ++v) {
        size = fmax(size, fabs(factor * row[v] * s->n[v])); /* what cancels leaves rounding */
        row[v] = (v == u ? 1.0 : 0.0) - factor * row[v];
    }
    size = fmax(size, fmax(fabs(wanted), fabs(s->n[u])));
    return size > 0.0 ? fabs(s->f[u]) / size : 0.0;
}

/* The largest relative residual of n; with the Newton matrix. */
static double eval_system(const se3di_equations *equations)
{
    const friction *s = &equations->friction;
    double largest = 0.0;
    for (uint32_t u = 0; u < s->active; ++u) {
        const double part =
            s->holds[s->unknown[u]] ? eval_held(equations, u) : eval_slipping(equations, u);
        largest = part <= largest ? largest : part; /* NaN stays */
    }
    return largest;
}

/* n of the unknowns, from where it is. */
static se3d_status iterate(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    double before = HUGE_VAL;
    for (int k = 0; k < ITERATIONS_MAX; ++k) {
        const double residual = eval_system(equations);
        if (residual <= ACCURACY || (residual <= ACCURACY_ACCEPTED && residual >= 0.5 * before)) {
            return SE3D_OK;
        }
        before = residual;
        solve_dense(s);
        for (uint32_t u = 0; u < s->active; ++u) {
            s->n[u] += s->f[u];
        }
    }
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: friction jams: it and the reaction that it follows from "
                           "raise each other without end",
                           t);
}

/* n of the unknowns; the second time corrects by what sharing has left. */
static se3d_status solve_forces(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    int any = 0;
    memset(s->n, 0, s->active * sizeof *s->n);
    memset(s->shared, 0, s->active * sizeof *s->shared);
    SE3DI_TRY(iterate(equations, t));
    for (uint32_t u = 0; u < s->active; ++u) {
        any |= s->holds[s->unknown[u]];
    }
    memcpy(s->shared, s->n, s->active * sizeof *s->n);
    return any ? iterate(equations, t) : SE3D_OK;
}

/* The whole solution, and what the elements know of it. */
static void combine(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    copy(equations->b, s->b, n);
    copy(equations->c, s->c, rows);
    copy(equations->x, s->x, n);
    copy(equations->l, s->l, rows);
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        add_unit(assembly, element_of(equations, k), s->Q + 16 * (size_t)k, -s->n[u], equations->b);
        for (size_t c = 0; c < n; ++c) {
            equations->x[c] += s->n[u] * s->X[u * n + c];
        }
        for (size_t c = 0; c < rows; ++c) {
            equations->l[c] += s->n[u] * s->L[u * rows + c];
        }
    }
    se3di_frictions_take_loads(assembly->model, equations->l);
}

static void keep_solution(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    copy(s->b, equations->b, assembly->unknown_count);
    copy(s->c, equations->c, assembly->row_count);
    copy(s->x, equations->x, assembly->unknown_count);
    copy(s->l, equations->l, assembly->row_count);
}

static void list_unknowns(se3di_equations *equations)
{
    friction *s = &equations->friction;
    s->active = 0;
    for (uint32_t k = 0; k < s->count; ++k) {
        const se3di_force *force = element_of(equations, k);
        if (s->holds[k] || s->rests[k] || (!se3di_friction_sticks(force) && force->mu > 0.0)) {
            s->unknown[s->active++] = k;
        }
    }
}

void se3di_friction_system_begin(se3di_equations *equations)
{
    friction *s = &equations->friction;
    for (uint32_t k = 0; k < s->count; ++k) {
        se3di_force *force = element_of(equations, k);
        const int sticks = se3di_friction_sticks(force) && force->state[SE3DI_FRICTION_SET] > 0.0;
        s->holds[k] = (s->is_rigid && sticks) || s->rests[k];
        force->state[SE3DI_FRICTION_LOAD] = 0.0;
        if (s->holds[k]) {
            se3di_friction_silence(force);
        }
    }
}

/* What is held gives this force from now on, whatever moves. */
static void set_held(se3di_equations *equations)
{
    const friction *s = &equations->friction;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        if (s->holds[k]) {
            se3di_friction_hold(equations->assembly.model, element_of(equations, k), s->n[u]);
        }
    }
}

se3d_status se3di_friction_system_finish(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    if (s->count == 0) {
        return SE3D_OK;
    }
    list_unknowns(equations);
    if (s->active == 0) {
        se3di_frictions_take_loads(equations->assembly.model, equations->l);
        return SE3D_OK;
    }
    keep_solution(equations);
    SE3DI_TRY(solve_units(equations));
    eval_responses(equations);
    SE3DI_TRY(solve_forces(equations, t));
    combine(equations);
    set_held(equations);
    return SE3D_OK;
}

/* The acceleration of the coordinate of the unknown u under n. */
static double acceleration_of(const friction *s, uint32_t u)
{
    double sum = s->a[u];
    for (uint32_t v = 0; v < s->active; ++v) {
        sum += s->W[(size_t)u * s->active + v] * s->n[v];
    }
    return sum;
}

/* How much the unknown u, at rest, contradicts what is assumed of it, relative; *mode: what it
 * should do instead. */
static double contradiction(const se3di_equations *equations, uint32_t u, double *mode)
{
    const friction *s = &equations->friction;
    const se3di_force *force = element_of(equations, s->unknown[u]);
    const double way = force->state[SE3DI_FRICTION_MODE], a = acceleration_of(s, u);
    *mode = 0.0;
    if (!s->holds[s->unknown[u]]) { /* it slips to where it does not go */
        return fmax(0.0, -way * a / (fabs(s->a[u]) + fabs(a)) - ACCURACY_ACCEPTED);
    }
    if (!has_leverage(equations, u)) {
        *mode = a > 0.0 ? 1.0 : -1.0;
        return fabs(a) > SE3DI_FRICTION_REST ? 1.0 : 0.0;
    }
    const double limit = force->mu_static * eval_load(equations, u, NULL) + force->limit;
    *mode = s->n[u] > 0.0 ? 1.0 : -1.0;
    return fmax(0.0, 1.0 - limit / fabs(s->n[u]) - ACCURACY_ACCEPTED);
}

/* Correct what contradicts, all or (where that goes round) the worst. @return how many */
static uint32_t correct_modes(se3di_equations *equations, int together)
{
    friction *s = &equations->friction;
    uint32_t changes = 0, worst = 0;
    double most = 0.0, mode;
    for (uint32_t u = 0; u < s->active; ++u) {
        const double size = s->rests[s->unknown[u]] ? contradiction(equations, u, &mode) : 0.0;
        worst = size > most ? u : worst;
        most = fmax(most, size);
    }
    for (uint32_t u = 0; u < s->active && most > 0.0; ++u) {
        const uint32_t k = s->unknown[u];
        if (s->rests[k] && (together || u == worst) && contradiction(equations, u, &mode) > 0.0) {
            element_of(equations, k)->state[SE3DI_FRICTION_MODE] = mode;
            s->holds[k] = !(fabs(mode) > 0.0);
            ++changes;
        }
    }
    return changes;
}

/* The velocities that make what holds stand still. */
static void arrest(se3di_equations *equations)
{
    friction *s = &equations->friction;
    se3di_assembly *assembly = &equations->assembly;
    const uint32_t m = s->active;
    const size_t n = assembly->unknown_count;
    for (uint32_t u = 0; u < m; ++u) {
        const int holds = s->holds[s->unknown[u]] && has_leverage(equations, u);
        const double unit = holds ? 1.0 / s->W[(size_t)u * m + u] : 0.0;
        se3di_measure measure;
        (void)se3di_measure_force(assembly->model, element_of(equations, s->unknown[u]), 0,
                                  &measure);
        s->f[u] = -unit * measure.rate;
        for (uint32_t v = 0; v < m; ++v) {
            s->J[(size_t)u * m + v] =
                u == v ? 1.0 : (s->holds[s->unknown[v]] ? unit * s->W[(size_t)u * m + v] : 0.0);
        }
    }
    solve_dense(s);
    se3di_assembly_get_velocity(assembly, equations->b);
    for (uint32_t u = 0; u < m; ++u) {
        for (size_t c = 0; c < n; ++c) {
            equations->b[c] += s->f[u] * s->X[u * n + c];
        }
    }
    se3di_assembly_set_velocity(assembly, equations->b);
}

/* What was at rest knows what it does now. */
static void settle(se3di_equations *equations)
{
    friction *s = &equations->friction;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        se3di_force *force = element_of(equations, k);
        if (s->rests[k]) {
            se3di_friction_set(equations->assembly.model, force, force->state[SE3DI_FRICTION_MODE],
                               s->n[u]);
        }
    }
}

static se3d_status decide(se3di_equations *equations, double t)
{
    SE3DI_TRY(solve_forces(equations, t));
    for (int round = 0; round < ROUNDS_MAX; ++round) {
        if (correct_modes(equations, round < ROUNDS_TOGETHER) == 0) {
            return SE3D_OK;
        }
        SE3DI_TRY(solve_forces(equations, t));
    }
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: friction jams: what it holds and what slips do not agree", t);
}

static se3d_status decide_rests(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    se3di_assembly *assembly = &equations->assembly;
    for (uint32_t k = 0; k < s->count; ++k) {
        if (s->rests[k]) {
            se3di_friction_silence(element_of(equations, k));
        }
    }
    se3di_friction_system_begin(equations);
    se3di_assembly_eval_gamma(assembly, equations->c);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, t, equations->b, equations->error));
    SE3DI_TRY(se3di_equations_solve(equations));
    list_unknowns(equations);
    keep_solution(equations);
    SE3DI_TRY(solve_units(equations));
    eval_responses(equations);
    SE3DI_TRY(decide(equations, t));
    combine(equations);
    set_held(equations);
    arrest(equations);
    settle(equations);
    return SE3D_OK;
}

se3d_status se3di_friction_system_decide(se3di_equations *equations, double t)
{
    friction *s = &equations->friction;
    const se3d_status status = decide_rests(equations, t);
    memset(s->rests, 0, s->count * sizeof *s->rests); /* or they would hold what comes next */
    return status;
}

/* The columns of one element: d n / d lambda_r times its unit force, on the bodies of its joint. */
static void add_columns(const se3di_assembly *assembly, const se3di_force *force,
                        const double *lambda, double *B)
{
    const se3di_model *model = assembly->model;
    const size_t block = (size_t)assembly->formulation->block;
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    double R[PARTS], gradient[PARTS], Q[16], rows[SE3DI_KKT_MAX_JOINT_ROWS * PARTS];
    se3di_friction_reaction(model, force, lambda, R);
    se3di_friction_reaction_rows(model, force, rows);
    (void)se3di_friction_load(model, force, R, gradient);
    eval_unit(assembly, force, Q);
    for (int32_t at = assembly->joint_begin[force->joint];
         at < assembly->joint_begin[force->joint + 1]; ++at) {
        const int second = assembly->free_index[bodies[1]] == assembly->joint_body[at];
        double *entry = B + assembly->block_offset[at];
        for (int32_t r = 0; r < assembly->joint_rows[force->joint]; ++r) {
            double slope = 0.0;
            for (int c = 0; c < PARTS; ++c) {
                slope -= gradient[c] * rows[r * PARTS + c];
            }
            slope *= force->state[SE3DI_FRICTION_MODE] * force->mu;
            for (size_t c = 0; c < block; ++c) {
                entry[(size_t)r * block + c] += slope * Q[8 * second + (int)c];
            }
        }
    }
}

int se3di_frictions_add_columns(const se3di_assembly *assembly, const double *lambda, double *B)
{
    const se3di_model *model = assembly->model;
    int any = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        if (se3di_friction_has_load(force) && force->mu > 0.0 && !se3di_friction_sticks(force)) {
            add_columns(assembly, force, lambda, B);
            any = 1;
        }
    }
    return any;
}
