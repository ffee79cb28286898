/* SPDX-License-Identifier: BSD-3-Clause */
#include "nonlinear/friction_system.h"

#include "nonlinear/friction_box.h"
#include "nonlinear/friction_internal.h"

#include <math.h>
#include <string.h>

#define PARTS SE3DI_FRICTION_PARTS

typedef se3di_friction_system friction;

/* memcpy if count may be zero and the pointers NULL. */
static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

/* Allocation. */

#define ARRAYS 24
#define MARKS  7 /* arrays of int32_t */

#define RESTING 1e-9 /* of the accelerations without friction: all that moves is rounding */

static void list_arrays(friction *s, const se3di_assembly *assembly, double **list[ARRAYS],
                        size_t size[ARRAYS])
{
    const size_t m = s->count, n = assembly->unknown_count, rows = assembly->row_count;
    struct {
        double **place;
        size_t size;
    } const parts[ARRAYS] = {
        {&s->n, m},      {&s->centre, m},    {&s->share, m},
        {&s->kept, m},   {&s->Q, 16 * m},    {&s->b, n},
        {&s->c, rows},   {&s->x, n},         {&s->l, rows},
        {&s->X, m * n},  {&s->L, m * rows},  {&s->R, m * (m + 1) * PARTS},
        {&s->a, m},      {&s->W, m * m},     {&s->J, m * (m + 1)},
        {&s->limit, m},  {&s->stiff, m},     {&s->guess, m},
        {&s->loaded, m}, {&s->P, m * m},     {&s->work, SE3DI_FRICTION_BOX_WORK(m)},
        {&s->work_x, n}, {&s->work_l, rows}, {&s->probes, 4 * SE3DI_FRICTION_PROBES * m},
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
    memset(s->holds, 0, MARKS * count * sizeof *s->holds);
}

static uint32_t count_elements(const se3di_model *model)
{
    uint32_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += model->forces[k].type == SE3DI_FORCE_FRICTION;
    }
    return count;
}

static size_t count_machine(const se3di_assembly *assembly)
{
    return 2 * (size_t)assembly->body_count + assembly->row_count + 1;
}

static int32_t find_machine(const friction *s, int32_t body)
{
    while (s->machine[body] != body) {
        body = s->machine[body];
    }
    return body;
}

static void join(friction *s, int32_t i, int32_t j)
{
    if (i >= 0 && j >= 0) {
        const int32_t a = find_machine(s, i), b = find_machine(s, j);
        s->machine[a < b ? b : a] = a < b ? a : b;
    }
}

/* What constraints and friction join, directly or by others. */
static void list_machines(friction *s, const se3di_assembly *assembly)
{
    const int32_t bodies = (int32_t)assembly->body_count;
    s->turns = s->machine + bodies;
    s->row_machine = s->turns + bodies;
    for (int32_t k = 0; k < bodies; ++k) {
        s->machine[k] = k;
    }
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        for (int32_t e = assembly->joint_begin[j]; e < assembly->joint_begin[j + 1]; ++e) {
            join(s, assembly->joint_body[assembly->joint_begin[j]], assembly->joint_body[e]);
        }
    }
    for (uint32_t k = 0; k < s->count; ++k) {
        const se3di_force *force = &assembly->model->forces[s->element[k]];
        join(s, assembly->free_index[force->body_i], assembly->free_index[force->body_j]);
    }
    for (int32_t k = 0; k < bodies; ++k) {
        s->machine[k] = find_machine(s, k);
    }
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const se3di_constraint *constraint = &assembly->model->constraints[j];
        const int32_t begin = assembly->joint_begin[j], end = assembly->joint_begin[j + 1];
        const int32_t own = end > begin ? s->machine[assembly->joint_body[begin]] : -1;
        for (uint32_t r = 0; r < constraint->row_count; ++r) {
            s->row_machine[constraint->row_begin + r] = own;
        }
    }
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
    s->element = se3di_alloc(allocator, 2 * s->count, sizeof *s->element);
    s->holds = se3di_alloc(allocator, MARKS * s->count, sizeof *s->holds);
    s->machine = se3di_alloc(allocator, count_machine(assembly), sizeof *s->machine);
    complete = s->element && s->holds && s->machine;
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
    s->unknown = s->element + s->count;
    s->rests = s->holds + s->count;
    s->stays = s->rests + s->count;
    s->slides = s->stays + s->count;
    s->at = s->slides + s->count;
    s->fixed = s->at + s->count;
    s->turn = s->fixed + s->count;
    list_elements(s, assembly->model);
    list_machines(s, assembly);
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
    se3di_free(allocator, s->element, 2 * s->count, sizeof *s->element);
    se3di_free(allocator, s->holds, MARKS * s->count, sizeof *s->holds);
    se3di_free(allocator, s->machine, s->machine ? count_machine(assembly) : 0, sizeof *s->machine);
    memset(s, 0, sizeof *s);
}

/* Units. */

void se3di_friction_unit(const se3di_assembly *assembly, const se3di_force *force, double Q[16])
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
    const se3di_force *force = se3di_friction_element(equations, k);
    double Q[16];
    se3di_friction_unit(assembly, force, Q);
    return dot_unit(assembly, force, Q, equations->x) + se3di_measure_curve(assembly->model, force);
}

static int32_t machine_of(const se3di_equations *equations, uint32_t u)
{
    const friction *s = &equations->friction;
    const int32_t *free = equations->assembly.free_index;
    const se3di_force *force = se3di_friction_element(equations, s->unknown[u]);
    const int32_t i = free[force->body_i], at = i >= 0 ? i : free[force->body_j];
    return at >= 0 ? s->machine[at] : -1;
}

/* Machines side by side are solved for together. Returns how often. */
static int32_t take_turns(se3di_equations *equations)
{
    friction *s = &equations->friction;
    int32_t turns = 0;
    memset(s->turns, 0, equations->assembly.body_count * sizeof *s->turns);
    for (uint32_t u = 0; u < s->active; ++u) {
        const int32_t own = machine_of(equations, u);
        s->turn[u] = own >= 0 ? s->turns[own]++ : 0;
        turns = s->turn[u] < turns ? turns : s->turn[u] + 1;
    }
    return turns;
}

/* What of a solution belongs to the machine of an unknown. */
static void take_own(se3di_equations *equations, uint32_t u)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    const size_t block = (size_t)assembly->formulation->block;
    const int32_t own = machine_of(equations, u);
    for (size_t k = 0; k < n; ++k) {
        s->X[u * n + k] = s->machine[k / block] == own ? equations->x[k] : 0.0;
    }
    for (size_t r = 0; r < rows; ++r) {
        s->L[u * rows + r] = s->row_machine[r] == own ? equations->l[r] : 0.0;
    }
}

/* The solution for a unit force against each unknown's coordinate. */
static se3d_status solve_units(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const int32_t turns = take_turns(equations);
    for (int32_t turn = 0; turn < turns; ++turn) {
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        for (size_t r = 0; r < assembly->row_count; ++r) {
            equations->c[r] = 0.0;
        }
        for (uint32_t u = 0; u < s->active; ++u) {
            const uint32_t k = s->unknown[u];
            const se3di_force *force = se3di_friction_element(equations, k);
            if (s->turn[u] == turn) {
                se3di_friction_unit(assembly, force, s->Q + 16 * (size_t)k);
                add_unit(assembly, force, s->Q + 16 * (size_t)k, -1.0, equations->b);
            }
        }
        SE3DI_TRY(se3di_equations_solve(equations));
        for (uint32_t u = 0; u < s->active; ++u) {
            if (s->turn[u] == turn) {
                take_own(equations, u);
            }
        }
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
        const se3di_force *force = se3di_friction_element(equations, k);
        const double *Q = s->Q + 16 * (size_t)k;
        double *R = s->R + (size_t)u * (s->active + 1) * PARTS;
        const int32_t own = machine_of(equations, u);
        s->a[u] = dot_unit(assembly, force, Q, s->x) + se3di_measure_curve(assembly->model, force);
        se3di_friction_reaction(assembly->model, force, s->l, R);
        for (uint32_t v = 0; v < s->active; ++v) {
            if (machine_of(equations, v) != own) {
                s->W[(size_t)u * s->active + v] = 0.0;
                memset(R + (size_t)(v + 1) * PARTS, 0, PARTS * sizeof *R);
                continue;
            }
            s->W[(size_t)u * s->active + v] = dot_unit(assembly, force, Q, s->X + v * n);
            se3di_friction_reaction(assembly->model, force, s->L + v * rows,
                                    R + (size_t)(v + 1) * PARTS);
        }
    }
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
        const se3di_force *force = se3di_friction_element(equations, k);
        if (s->holds[k] || s->rests[k] || (!se3di_friction_sticks(force) && force->mu > 0.0)) {
            s->unknown[s->active++] = k;
        }
    }
}

se3d_status se3di_friction_respond(se3di_equations *equations)
{
    list_unknowns(equations);
    if (equations->friction.active > 0) {
        keep_solution(equations);
        SE3DI_TRY(solve_units(equations));
        eval_responses(equations);
        se3di_friction_weigh(equations);
    }
    return SE3D_OK;
}

/* f: of units against those that hold, which change their accelerations or rates by what is in
 * f. */
static void solve_holds(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const uint32_t m = s->active;
    for (uint32_t u = 0; u < m; ++u) {
        const int holds = s->holds[s->unknown[u]] && se3di_friction_has_leverage(equations, u);
        const double unit = holds ? 1.0 / s->W[(size_t)u * m + u] : 0.0;
        s->f[u] *= unit;
        for (uint32_t v = 0; v < m; ++v) {
            s->J[(size_t)u * m + v] =
                u == v ? 1.0 : (s->holds[s->unknown[v]] ? unit * s->W[(size_t)u * m + v] : 0.0);
        }
    }
    se3di_friction_solve_dense(s);
}

int se3di_friction_arrest(se3di_equations *equations)
{
    friction *s = &equations->friction;
    se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count;
    int moves = 0;
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        se3di_measure measure;
        (void)se3di_measure_force(assembly->model, se3di_friction_element(equations, k), 0,
                                  &measure);
        s->f[u] = -measure.rate;
        moves |= s->holds[k] && fabs(measure.rate) > 0.0;
    }
    if (!moves) {
        return 0;
    }
    solve_holds(equations);
    se3di_assembly_get_velocity(assembly, equations->b);
    for (uint32_t u = 0; u < s->active; ++u) {
        for (size_t c = 0; c < n; ++c) {
            equations->b[c] += s->f[u] * s->X[u * n + c];
        }
    }
    se3di_assembly_set_velocity(assembly, equations->b);
    return 1;
}

static double largest_of(const double *x, size_t count)
{
    double largest = 0.0;
    for (size_t k = 0; k < count; ++k) {
        largest = fmax(largest, fabs(x[k]));
    }
    return largest;
}

/* All that moves is rounding: that against the rows is taken away, too. */
static se3d_status refine_rows(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    if (rows == 0 || !(largest_of(equations->x, n) < RESTING * largest_of(s->x, n))) {
        return SE3D_OK;
    }
    copy(s->work_x, equations->x, n);
    copy(s->work_l, equations->l, rows);
    memset(equations->b, 0, n * sizeof *equations->b);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    for (size_t r = 0; r < rows; ++r) {
        equations->c[r] = s->c[r] - equations->c[r];
    }
    const se3d_status status = se3di_equations_solve(equations);
    for (size_t c = 0; c < n; ++c) {
        equations->x[c] = s->work_x[c] + (status < 0 ? 0.0 : equations->x[c]);
    }
    for (size_t r = 0; r < rows; ++r) {
        equations->l[r] = s->work_l[r] + (status < 0 ? 0.0 : equations->l[r]);
    }
    copy(equations->b, s->b, n);
    copy(equations->c, s->c, rows);
    return status;
}

/* Accelerations of what holds, which are rounding of the forces that it holds, become rounding of
 * themselves: over a long time, and in steps that grow with it, a block would creep away by 1e-14
 * of what pulls at it. */
static void refine(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    (void)refine_rows(equations); /* else as it is */
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        const se3di_force *force = se3di_friction_element(equations, k);
        s->f[u] = -dot_unit(assembly, force, s->Q + 16 * (size_t)k, equations->x) -
                  se3di_measure_curve(assembly->model, force);
    }
    solve_holds(equations);
    for (uint32_t u = 0; u < s->active; ++u) {
        const double part = s->holds[s->unknown[u]] ? s->f[u] : 0.0;
        s->n[u] += part;
        for (size_t c = 0; c < n; ++c) {
            equations->x[c] += part * s->X[u * n + c];
        }
        for (size_t c = 0; c < rows; ++c) {
            equations->l[c] += part * s->L[u * rows + c];
        }
    }
}

void se3di_friction_combine(se3di_equations *equations)
{
    friction *s = &equations->friction;
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count, rows = assembly->row_count;
    copy(equations->b, s->b, n);
    copy(equations->c, s->c, rows);
    copy(equations->x, s->x, n);
    copy(equations->l, s->l, rows);
    for (uint32_t u = 0; u < s->active; ++u) {
        for (size_t c = 0; c < n; ++c) {
            equations->x[c] += s->n[u] * s->X[u * n + c];
        }
        for (size_t c = 0; c < rows; ++c) {
            equations->l[c] += s->n[u] * s->L[u * rows + c];
        }
    }
    if (s->is_rigid == 1) {
        refine(equations);
    }
    for (uint32_t u = 0; u < s->active; ++u) {
        const uint32_t k = s->unknown[u];
        se3di_force *force = se3di_friction_element(equations, k);
        add_unit(assembly, force, s->Q + 16 * (size_t)k, -s->n[u], equations->b);
        if (s->holds[k]) {
            se3di_friction_hold(assembly->model, force, s->n[u]);
        }
    }
    se3di_frictions_take_loads(assembly->model, equations->l);
}

void se3di_friction_system_begin(se3di_equations *equations)
{
    friction *s = &equations->friction;
    for (uint32_t k = 0; k < s->count && !equations->assembly.model->steps_apart; ++k) {
        se3di_force *force = se3di_friction_element(equations, k);
        const int sticks = se3di_friction_sticks(force) && force->state[SE3DI_FRICTION_SET] > 0.0;
        s->holds[k] = (s->is_rigid && sticks) || s->rests[k];
        force->state[SE3DI_FRICTION_LOAD] = 0.0;
        if (s->holds[k]) {
            se3di_friction_silence(force);
        }
    }
}

se3d_status se3di_friction_system_finish(se3di_equations *equations, double t)
{
    if (equations->friction.count == 0 || equations->assembly.model->steps_apart) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_friction_respond(equations));
    if (equations->friction.active == 0) {
        se3di_frictions_take_loads(equations->assembly.model, equations->l);
        return SE3D_OK;
    }
    if (!se3di_friction_solve_forces(equations)) {
        return se3di_friction_refuse(equations, t);
    }
    se3di_friction_combine(equations);
    return SE3D_OK;
}

int se3di_friction_system_stand(se3di_equations *equations)
{
    const friction *s = &equations->friction;
    return s->is_rigid && s->count > 0 && s->active > 0 && se3di_friction_arrest(equations);
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
    se3di_friction_unit(assembly, force, Q);
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
