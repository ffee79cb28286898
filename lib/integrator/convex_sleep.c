/* SPDX-License-Identifier: BSD-3-Clause */
/* Islands of bodies and machines at rest sleep: they stay where they are, to the bit, with the
 * contacts and forces that they had, and are neither looked at nor solved for. An island falls
 * asleep when all of its bodies have been slower than SLOW for LONG and some of them touch
 * something. A body that something may set in motion without touching it (elements and constraints
 * that are functions of time or of other bodies' states, gravity that changes, a surface that
 * moves) does not, and so does not what touches it or is joined to it. What touches a sleeping
 * body wakes its whole island before the step in which it acts; whatever is set wakes all (renew,
 * start).
 *
 * The history has how long each body has been at rest, or ASLEEP.        docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/shape/shape.h"
#include "expression/expression.h"
#include "integrator/state.h"
#include "math/vec3.h"
#include "primitive/user.h"

#include <math.h>
#include <string.h>

#define SLOW   1e-5 /* m/s, of any point of a body */
#define LONG   0.25 /* s */
#define ASLEEP (-1.0)

/* Times at rest of the free bodies. */
static double *times_of(const se3di_assembly *assembly)
{
    return assembly->model->history + 1;
}

static void mark_body(const se3di_assembly *assembly, uint32_t body, uint8_t *marks)
{
    const int32_t free = assembly->free_index[body];
    if (free >= 0) {
        marks[free] = 1;
    }
}

static int is_constant(const se3di_function *function)
{
    return !function->expression && !function->callback && !function->table && !function->integral;
}

/* Whether a constraint may move what is at rest. */
static int drives(const se3di_model *model, const se3di_constraint *constraint)
{
    int drives = se3di_is_user(constraint);
    for (uint32_t k = 0; k < constraint->row_count && !drives; ++k) {
        const int32_t function = model->rows[constraint->row_begin + k].function;
        drives = function >= 0 && !is_constant(&model->functions[function]);
    }
    return drives;
}

/* Whether a function is one of what the element measures between its bodies alone, for certain: not
 * of its first variable, which may be the time. */
static int is_own(const se3di_function *function)
{
    return function->expression && !function->integral && function->signal_count == 0 &&
           !se3di_expression_reads(function->expression, 1u);
}

/* Whether an element may. */
static int urges(const se3di_model *model, const se3di_force *force)
{
    int urges = force->type == SE3DI_FORCE_CALLBACK || force->type == SE3DI_FORCE_STATE;
    for (int k = 0; k < SE3DI_FORCE_FUNCTIONS && !urges; ++k) {
        const se3di_function *function =
            force->function[k] >= 0 ? &model->functions[force->function[k]] : NULL;
        urges = function && !is_constant(function) && !is_own(function);
    }
    return urges;
}

static void link_all(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    memset(c->linked, 0, assembly->body_count);
    memset(c->urged, 0, assembly->body_count);
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const int is_urged = drives(model, &model->constraints[j]);
        for (int32_t e = assembly->joint_begin[j]; e < assembly->joint_begin[j + 1]; ++e) {
            c->linked[assembly->joint_body[e]] = 1;
            c->urged[assembly->joint_body[e]] |= (uint8_t)is_urged;
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        for (int side = 0; side < 2; ++side) {
            const uint32_t body = side ? force->body_j : force->body_i;
            mark_body(assembly, body, c->linked);
            if (urges(model, force)) {
                mark_body(assembly, body, c->urged);
            }
        }
    }
}

static void measure_reaches(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    memset(c->reach, 0, assembly->body_count * sizeof *c->reach);
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        const int32_t free = assembly->free_index[shape->body];
        if (free >= 0) {
            c->reach[free] = fmax(c->reach[free], shape->bound + se3di_norm(shape->x));
        }
    }
    const double length = se3di_state_length(model);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        c->reach[k] = c->linked[k] ? fmax(c->reach[k], length) : c->reach[k];
    }
}

se3d_status se3di_convex_bed(se3di_convex *c, const se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    const size_t bodies = assembly->body_count;
    void *bytes = c->asleep, *nest = c->nest, *reach = c->reach;
    se3d_status status = se3di_array_reserve(allocator, &bytes, &c->sleep_capacity,
                                             4 * bodies + assembly->dense_count + 1, 1);
    c->asleep = bytes;
    SE3DI_TRY(status);
    status = se3di_array_reserve(allocator, &nest, &c->nest_capacity, bodies + 1, sizeof *c->nest);
    c->nest = nest;
    SE3DI_TRY(status);
    status =
        se3di_array_reserve(allocator, &reach, &c->reach_capacity, bodies + 1, sizeof *c->reach);
    c->reach = reach;
    SE3DI_TRY(status);
    c->linked = c->asleep + bodies;
    c->drifts = c->linked + bodies;
    c->urged = c->drifts + bodies;
    c->frozen = c->urged + bodies;
    memset(c->asleep, 0, bodies);
    c->asleep_count = 0;
    link_all(c, assembly);
    if (c->sleeps || c->controls) {
        measure_reaches(c, assembly);
    }
    return SE3D_OK;
}

static int32_t find_nest(const se3di_convex *c, int32_t body)
{
    while (c->nest[body] != body) {
        c->nest[body] = c->nest[c->nest[body]];
        body = c->nest[body];
    }
    return body;
}

static void join(const se3di_convex *c, int32_t i, int32_t j)
{
    if (i >= 0 && j >= 0) {
        const int32_t a = find_nest(c, i), b = find_nest(c, j);
        c->nest[a < b ? b : a] = a < b ? a : b;
    }
}

/* What constraints and elements join. */
static void join_links(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const int32_t first = se3di_convex_joined(assembly, j);
        for (int32_t e = assembly->joint_begin[j]; first >= 0 && e < assembly->joint_begin[j + 1];
             ++e) {
            join(c, first, assembly->joint_body[e]);
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        join(c, assembly->free_index[model->forces[k].body_i],
             assembly->free_index[model->forces[k].body_j]);
    }
}

/* Bodies that touch or are joined are of one nest, called by its first body. */
static void find_nests(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        c->nest[k] = (int32_t)k;
    }
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *r = &model->contacts.list[k];
        join(c, assembly->free_index[model->shapes[r->shape_i].body],
             assembly->free_index[model->shapes[r->shape_j].body]);
    }
    join_links(c, assembly);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        c->nest[k] = find_nest(c, (int32_t)k);
    }
}

/* A mark on any body of a nest becomes one of its first body. */
static void spread(const se3di_convex *c, uint32_t count, uint8_t *marks)
{
    for (uint32_t k = count; k-- > 0;) {
        marks[c->nest[k]] |= marks[k];
    }
}

/* Whether a constraint acts on anything but what sleeps. */
static int is_bound(const se3di_convex *c, const se3di_assembly *assembly)
{
    int is_bound = c->asleep_count == 0 && assembly->row_count > 0;
    for (uint32_t j = 0; j < assembly->constraint_count && !is_bound; ++j) {
        const int32_t body = se3di_convex_joined(assembly, j);
        is_bound = body < 0 || !c->asleep[body];
    }
    return is_bound;
}

static void freeze(se3di_convex *c, const se3di_assembly *assembly)
{
    c->asleep_count = 0;
    for (uint32_t k = 0; k < assembly->dense_count; ++k) {
        const int32_t free = assembly->free_index[k];
        c->frozen[k] = free < 0 || c->asleep[free];
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        c->asleep_count += c->asleep[k];
    }
    c->is_bound = is_bound(c, assembly);
}

void se3di_convex_wake(se3di_convex *c, const se3di_assembly *assembly)
{
    double *times = times_of(assembly);
    uint8_t *awake = c->touched; /* of the step before */
    const size_t before = c->asleep_count;
    size_t sleepers = 0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        times[k] = c->sleeps ? times[k] : 0.0;
        c->asleep[k] = times[k] < 0.0;
        awake[k] = !c->asleep[k];
        sleepers += c->asleep[k];
    }
    if (sleepers > 0 && (sleepers < assembly->body_count || before != sleepers)) {
        find_nests(c, assembly);
        spread(c, assembly->body_count, awake);
        for (uint32_t k = 0; k < assembly->body_count; ++k) {
            if (c->asleep[k] && awake[c->nest[k]]) {
                times[k] = 0.0;
                c->asleep[k] = 0;
            }
        }
    }
    freeze(c, assembly);
}

int se3di_convex_rests(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    int rests = c->asleep_count > 0 && c->asleep_count == assembly->body_count;
    for (size_t k = 0; k < model->force_slots.count && rests; ++k) {
        rests = !urges(model, &model->forces[k]); /* on what is fixed */
    }
    return rests;
}

/* How long each body has been at rest. */
static void count_times(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    const int changes = se3di_model_gravity_varies(model) || model->state_count > 0;
    double *times = times_of(assembly);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &model->frames[assembly->free_body[k]];
        const double turning =
            c->reach[k] < HUGE_VAL ? c->reach[k] * se3di_norm(frame->w) : HUGE_VAL;
        const int stays = (c->linked[k] ? !c->urged[k] : c->touched[k]) && !changes;
        const int rests = stays && se3di_norm(frame->v) + turning < SLOW;
        if (!c->asleep[k]) {
            times[k] = rests ? times[k] + c->h : 0.0;
        }
    }
}

/* Which nests do not sleep: [first bodies] of `restless`. */
static void find_restless(const se3di_convex *c, const se3di_assembly *assembly, uint8_t *restless)
{
    const se3di_model *model = assembly->model;
    const double *times = times_of(assembly);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        restless[k] = !c->asleep[k] && !(times[k] >= LONG);
    }
    spread(c, assembly->body_count, c->drifts);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        restless[k] |= c->drifts[c->nest[k]]; /* it hangs */
    }
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *r = &model->contacts.list[k];
        const int moves = se3di_surface_moves(&model->shapes[r->shape_i]) ||
                          se3di_surface_moves(&model->shapes[r->shape_j]);
        for (int side = 0; moves && side < 2; ++side) {
            const uint32_t shape = side ? r->shape_j : r->shape_i;
            const int32_t free = assembly->free_index[model->shapes[shape].body];
            if (free >= 0) {
                restless[free] = 1;
            }
        }
    }
    spread(c, assembly->body_count, restless);
}

/* What it still moves with is lost. */
static void stop(se3di_model *model, uint32_t body)
{
    const double *J = model->bodies[body].J;
    se3di_frame *frame = &model->frames[body];
    const double *v = frame->v, *w = frame->w;
    model->work[0] += 0.5 * model->bodies[body].mass * se3di_dot(v, v) +
                      0.5 * (J[0] * w[0] * w[0] + J[1] * w[1] * w[1] + J[2] * w[2] * w[2]) +
                      J[3] * w[0] * w[1] + J[4] * w[1] * w[2] + J[5] * w[0] * w[2];
    memset(frame->v, 0, sizeof frame->v);
    memset(frame->w, 0, sizeof frame->w);
    memset(frame->pdot, 0, sizeof frame->pdot);
    memset(model->acceleration + 6 * (size_t)body, 0, 6 * sizeof *model->acceleration);
}

/* Positions, velocities, accelerations and multipliers of what sleeps, to the bit: they were among
 * the unknowns of all constraints. */
void se3di_convex_stay(const se3di_convex *c, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_saved *kept = &equations->kept;
    const se3di_frame *frames = kept->frames.data;
    const double *accelerations = kept->acceleration.data, *lambda = kept->lambda.data;
    se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->body_count && c->asleep_count > 0; ++k) {
        const uint32_t body = assembly->free_body[k];
        if (c->asleep[k]) {
            model->frames[body] = frames[body];
            memcpy(model->acceleration + 6 * (size_t)body, accelerations + 6 * (size_t)body,
                   6 * sizeof *accelerations);
        }
    }
    for (uint32_t j = 0; j < assembly->constraint_count && c->asleep_count > 0; ++j) {
        const int32_t body = se3di_convex_joined(assembly, j);
        const se3di_constraint *constraint = &model->constraints[j];
        if (body >= 0 && c->asleep[body]) {
            memcpy(model->lambda + constraint->row_begin, lambda + constraint->row_begin,
                   constraint->row_count * sizeof *lambda);
        }
    }
}

int se3di_convex_element_sleeps(const se3di_convex *c, const se3di_assembly *assembly,
                                const se3di_force *force)
{
    const int32_t i = assembly->free_index[force->body_i];
    const int32_t body = i >= 0 ? i : assembly->free_index[force->body_j];
    return body >= 0 && c->asleep[body];
}

void se3di_convex_doze(se3di_convex *c, const se3di_assembly *assembly)
{
    double *times = times_of(assembly);
    uint8_t *restless = c->touched;
    size_t ready = 0;
    if (!c->sleeps) {
        return;
    }
    count_times(c, assembly);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        ready += times[k] >= LONG;
    }
    if (ready == 0) {
        return;
    }
    find_nests(c, assembly);
    find_restless(c, assembly, restless);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        if (!c->asleep[k] && !restless[c->nest[k]]) {
            times[k] = ASLEEP;
            stop(assembly->model, assembly->free_body[k]);
        }
    }
}
