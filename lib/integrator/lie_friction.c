/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/lie_friction.h"

#include "force/friction.h"
#include "force/measure.h"
#include "math/larger.h"
#include "nonlinear/friction_system.h"

#include <math.h>
#include <string.h>

#define SWEEPS          1000
#define MODE_ITERATIONS 10
#define LOAD_ITERATIONS 50  /* while loads do not come closer to each other, */
#define LOAD_MOST       500 /* and in all */
#define LOAD_ACCURACY   1e-12
#define LOAD_ROUNDED    4    /* so often: it is rounding */
#define LOAD_ROUNDING   1e-9 /* changes that stay: a load of large reactions that cancel */

static uint32_t count_elements(const se3di_model *model)
{
    uint32_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += model->forces[k].type == SE3DI_FORCE_FRICTION;
    }
    return count;
}

size_t se3di_lie_friction_work_count(const se3di_model *model)
{
    size_t count = count_elements(model);
    return count > 0 ? count * (21 + count) : 0;
}

size_t se3di_lie_friction_history_count(const se3di_model *model)
{
    return count_elements(model);
}

void se3di_lie_friction_start(const se3di_model *model, double *history)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_FRICTION) {
            *history++ = se3di_friction_get(model, &model->forces[k]);
        }
    }
}

se3di_lie_friction se3di_lie_friction_begin(se3di_equations *equations, double *work,
                                            double *history)
{
    se3di_lie_friction f = {.equations = equations, .history = history};
    f.count = count_elements(equations->assembly.model);
    if (f.count > 0) {
        f.n = work;
        f.mode = f.n + f.count;
        f.free = f.mode + f.count;
        f.limit = f.free + f.count;
        f.load = f.limit + f.count;
        f.Q = f.load + f.count;
        f.W = f.Q + 16 * (size_t)f.count;
    }
    return f;
}

/* The next friction element after *at (the first from 0), of which there is one. */
static se3di_force *next_element(const se3di_lie_friction *f, size_t *at)
{
    se3di_force *forces = f->equations->assembly.model->forces;
    while (forces[*at].type != SE3DI_FORCE_FRICTION) {
        ++*at;
    }
    return &forces[(*at)++];
}

/* b += n Q; or returns Q . b if `dot` is set. */
static double visit_blocks(const se3di_assembly *assembly, const se3di_force *force,
                           const double Q[16], double n, int dot, double *b)
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    const int block = assembly->formulation->block;
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        int32_t at = assembly->free_index[bodies[k]];
        for (int c = 0; at >= 0 && c < block; ++c) {
            double *entry = b + (size_t)at * (size_t)block + c;
            sum += *entry * Q[8 * k + c];
            *entry += dot ? 0.0 : n * Q[8 * k + c];
        }
    }
    return sum;
}

/* The next element, and the coordinate that it acts on. */
static const se3di_force *next_measured(const se3di_lie_friction *f, size_t *at,
                                        se3di_measure *measure)
{
    const se3di_force *force = next_element(f, at);
    (void)se3di_measure_force(f->equations->assembly.model, force, 0, measure);
    return force;
}

/* Forces are evaluated without it at the present positions. */
static void silence(const se3di_lie_friction *f)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_friction_silence(next_element(f, &at));
    }
}

void se3di_lie_friction_take(se3di_lie_friction *f)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        f->mode[k] = next_element(f, &at)->state[2];
        f->n[k] = f->history[k];
    }
    silence(f);
}

void se3di_lie_friction_add_wrenches(const se3di_lie_friction *f)
{
    const se3di_assembly *assembly = &f->equations->assembly;
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_measure measure;
        const se3di_force *force = next_measured(f, &at, &measure);
        for (uint32_t c = 0; c < 6; ++c) {
            assembly->wrench[6 * force->body_i + c] -= f->n[k] * measure.g[c];
            assembly->wrench[6 * force->body_j + c] -= f->n[k] * measure.g[6 + c];
        }
    }
}

se3d_status se3di_lie_friction_prepare(se3di_lie_friction *f)
{
    se3di_equations *equations = f->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t at = 0;
    silence(f);
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_friction_unit(assembly, next_element(f, &at), f->Q + 16 * (size_t)k);
    }
    at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        const se3di_force *force = next_element(f, &at);
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
        (void)visit_blocks(assembly, force, f->Q + 16 * (size_t)k, 1.0, 0, equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        size_t other = 0;
        for (uint32_t j = 0; j < f->count; ++j) {
            const se3di_force *element = next_element(f, &other);
            f->W[(size_t)j * f->count + k] =
                visit_blocks(assembly, element, f->Q + 16 * (size_t)j, 0.0, 1, equations->x);
        }
    }
    return SE3D_OK;
}

/* n within the limits with free - W n = 0 inside; `fixed`: those that slip keep +-limit. */
static void solve_box(se3di_lie_friction *f, int fixed)
{
    double change = 1.0;
    for (int sweep = 0; change > 1e-15 && sweep < SWEEPS; ++sweep) {
        change = 0.0;
        for (uint32_t k = 0; k < f->count; ++k) {
            const double *row = f->W + (size_t)k * f->count, limit = f->limit[k];
            double rest = f->free[k], n = f->n[k];
            for (uint32_t j = 0; j < f->count; ++j) {
                rest -= row[j] * f->n[j];
            }
            n = row[k] > 0.0 ? fmin(fmax(n + rest / row[k], -limit), limit) : 0.0;
            n = fixed && fabs(f->mode[k]) > 0.0 ? f->mode[k] * limit : n;
            change = se3di_larger(change, limit > 0.0 ? fabs(n - f->n[k]) / limit : 0.0);
            f->n[k] = n;
        }
    }
}

static void set_limits(se3di_lie_friction *f)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        f->limit[k] = se3di_friction_limit(next_element(f, &at), fabs(f->mode[k]) > 0.0);
    }
}

/* What has reached its limit slips, what slips and stays inside sticks. Returns how many begin to
 * slip: their limit changes. */
static uint32_t set_modes(se3di_lie_friction *f)
{
    uint32_t begun = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        const double slips = fabs(f->n[k]) >= f->limit[k] && f->limit[k] > 0.0;
        begun += slips > fabs(f->mode[k]);
        f->mode[k] = slips > 0.0 ? copysign(1.0, f->n[k]) : 0.0;
    }
    return begun;
}

void se3di_lie_friction_solve_velocities(se3di_lie_friction *f, double h)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_measure measure;
        const se3di_force *force = next_measured(f, &at, &measure);
        f->free[k] = 2.0 / h * measure.rate;
        f->load[k] = force->state[1];
    }
    set_limits(f);
    solve_box(f, 0);
    for (int k = 0; k < MODE_ITERATIONS && set_modes(f) > 0; ++k) {
        set_limits(f);
        solve_box(f, 0);
    }
}

/* The solution of equations->b, c becomes the model's. */
static se3d_status solve(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(se3di_equations_solve(equations));
    se3di_assembly_set_acceleration(assembly, equations->x);
    if (assembly->row_count > 0) {
        memcpy(assembly->model->lambda, equations->l, assembly->row_count * sizeof *equations->l);
    }
    return SE3D_OK;
}

/* equations->b += sign sum_k n_k Q_k */
static void add_forces(const se3di_lie_friction *f, double sign)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        const se3di_force *force = next_element(f, &at);
        (void)visit_blocks(&f->equations->assembly, force, f->Q + 16 * (size_t)k, sign * f->n[k], 0,
                           f->equations->b);
    }
}

/* The largest change of a load relative to the largest. */
static double take_loads(se3di_lie_friction *f)
{
    const se3di_model *model = f->equations->assembly.model;
    double change = 0.0, largest = 0.0;
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_force *force = next_element(f, &at);
        if (se3di_friction_has_load(force)) {
            double R[SE3DI_FRICTION_PARTS], *load = &force->state[SE3DI_FRICTION_LOAD];
            const double before = *load;
            se3di_friction_reaction(model, force, model->lambda, R);
            *load = se3di_friction_load(model, force, R, NULL);
            change = se3di_larger(change, fabs(*load - before));
            largest = fmax(largest, *load);
        }
    }
    return largest > 0.0 ? change / largest : 0.0;
}

se3d_status se3di_lie_friction_solve_accelerations(se3di_lie_friction *f)
{
    const se3di_model *model = f->equations->assembly.model;
    SE3DI_TRY(solve(f->equations));
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        f->free[k] = se3di_measure_acceleration(model, next_element(f, &at));
    }
    double before = HUGE_VAL;
    for (int iteration = 0, stays = 0; f->count > 0; ++iteration) {
        set_limits(f);
        solve_box(f, 1);
        for (int k = 0; k < MODE_ITERATIONS && set_modes(f) > 0; ++k) {
            set_limits(f);
            solve_box(f, 1);
        }
        add_forces(f, -1.0);
        SE3DI_TRY(solve(f->equations));
        add_forces(f, 1.0);
        const double change = take_loads(f);
        stays += !(change < before);
        before = fmin(change, before);
        if (change <= LOAD_ACCURACY || (change <= LOAD_ROUNDING && stays > LOAD_ROUNDED)) {
            break;
        }
        if (stays > LOAD_ITERATIONS || iteration >= LOAD_MOST) {
            return se3di_friction_refuse(f->equations, model->time);
        }
    }
    return SE3D_OK;
}

double se3di_lie_friction_change(const se3di_lie_friction *f)
{
    double change = 0.0, largest = 0.0;
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        const double load = next_element(f, &at)->state[1];
        change = se3di_larger(change, fabs(load - f->load[k]));
        largest = fmax(largest, load);
    }
    return largest > 0.0 ? change / largest : 0.0;
}

void se3di_lie_friction_accept(const se3di_lie_friction *f)
{
    size_t at = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        se3di_friction_set(f->equations->assembly.model, next_element(f, &at), f->mode[k], f->n[k]);
        f->history[k] = f->n[k];
    }
}
