/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of convex with control of their error. Each is tried whole, and then made in two halves: by
 * how much the places of the bodies differ, relative to their sizes, is the error of the whole
 * step, of which the halves have about half as much. In an impact it is the way that is made until
 * it is noticed, so such steps become as short as that asks for. */
#include "assembly/user.h"
#include "integrator/adaptive.h"
#include "integrator/aside.h"
#include "integrator/convex.h"
#include "integrator/kink_step.h"
#include "integrator/state.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define KEPT    7     /* numbers of each body in the history */
#define REACH   1e-6  /* below it, steps are too short for their rounding and for what meets */
#define PART    0.1   /* of the tolerance: the error of a step */
#define LOOSE   1e-3  /* a tolerance: from here on impacts may be those of one step */
#define SAFETY  0.9   /* of the step that would just do */
#define LEAST   1e-5  /* of the longest step */
#define ROUNDED 1e-14 /* of the time: so much longer than its rounding */
#define SHRINK  0.1
#define GROWTH  4.0

size_t se3di_convex_history_count(const se3di_assembly *assembly)
{
    return 2 + KEPT * (size_t)assembly->body_count;
}

double se3di_convex_get_reach(const se3di_integration *integration, const se3di_model *model)
{
    (void)model;
    return integration->settings.controls_error ? REACH : 0.0;
}

/* The length that a step was to have after the last one. */
static double *next_of(const se3di_assembly *assembly)
{
    return assembly->model->history + se3di_convex_history_count(assembly) - 1;
}

static se3d_status keep(se3di_integration *integration)
{
    se3di_equations *equations = integration->equations;
    se3di_convex *c = integration->convex;
    const se3di_assembly *assembly = &equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    void *ended = c->ended;
    se3d_status status =
        se3di_array_reserve(allocator, &ended, &c->ended_capacity,
                            2 * (size_t)assembly->body_count + 1, sizeof *c->ended);
    c->ended = ended;
    c->struck = (uint8_t *)(c->ended ? c->ended + assembly->body_count : NULL);
    status = status < 0 ? status
                        : se3di_saved_fill(&integration->before_trials, assembly->model, allocator);
    return status < 0 ? se3di_error_set(equations->error, status, "no memory for a step") : SE3D_OK;
}

/* The model has had this state, and its room. */
static void come_back(const se3di_integration *integration)
{
    se3di_model *model = integration->equations->assembly.model;
    se3di_saved_restore(&integration->before_trials, model);
    se3di_user_begin(model);
}

static void keep_ends(se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        c->ended[k] = assembly->model->frames[assembly->free_body[k]];
    }
}

/* Islands in which something was an impact, whose velocities no short step makes continuous. */
static void mark_struck(se3di_convex *c, const se3di_assembly *assembly)
{
    for (size_t k = 0; k < c->island_count; ++k) {
        c->islands[k].is_struck = 0;
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        const se3di_convex_contact *contact = &c->contacts[k];
        const int is_impact =
            contact->way == SE3DI_CONVEX_IMPACT || contact->way == SE3DI_CONVEX_TRACED;
        for (int e = 0; e < 2 && is_impact && se3di_norm(contact->impulse) > 0.0; ++e) {
            if (contact->free[e] >= 0) { /* a place */
                const int32_t body = c->body_at[contact->free[e]];
                c->struck[body] = 1;
                if (c->number[body] >= 0) {
                    c->islands[c->number[body]].is_struck = 1;
                }
            }
        }
    }
    for (uint32_t body = 0; body < assembly->body_count && c->contact_count > 0; ++body) {
        c->struck[body] |= c->number[body] >= 0 && c->islands[c->number[body]].is_struck;
    }
}

static double size_of(const se3di_convex *c, uint32_t body, double length)
{
    return c->reach[body] > 0.0 && c->reach[body] < HUGE_VAL ? c->reach[body] : length;
}

/* How deep, over their sizes, bodies are that have met within the step, in which their contact did
 * nothing yet. */
static double measure_met(const se3di_convex *c, const se3di_assembly *assembly, double length)
{
    const se3di_model *model = assembly->model;
    double most = 0.0;
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *r = &model->contacts.list[k];
        const int32_t free[2] = {assembly->free_index[model->shapes[r->shape_i].body],
                                 assembly->free_index[model->shapes[r->shape_j].body]};
        for (int e = 0; e < 2; ++e) {
            if (r->kind == SE3DI_CONTACT_NEW && free[e] >= 0) {
                most = fmax(most, r->overlap / size_of(c, (uint32_t)free[e], length));
            }
        }
    }
    return most;
}

/* Of the whole step, relative to what it may be: places over sizes, velocities over the largest
 * speed, or that of a fall by its size. */
static double measure(const se3di_convex *c, const se3di_assembly *assembly, double tolerance)
{
    const double length = se3di_state_length(assembly->model);
    double places = tolerance < LOOSE ? measure_met(c, assembly, length) : 0.0;
    double speed = 1e-12, change = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        const se3di_frame *ended = &c->ended[k];
        const double size = size_of(c, k, length);
        double d[3], e[3];
        se3di_sub(frame->r, ended->r, d);
        se3di_quat_log(ended->p, frame->p, e);
        places = fmax(places, fmax(se3di_norm(d) / size, se3di_norm(e)));
        speed = fmax(speed, se3di_norm(frame->v) + size * se3di_norm(frame->w));
        speed = fmax(speed, sqrt(size * se3di_norm(c->gravity)));
        se3di_sub(frame->v, ended->v, d);
        se3di_sub(frame->w, ended->w, e);
        if (!c->struck[k]) {
            change = fmax(change, se3di_norm(d) + size * se3di_norm(e));
        } else if (tolerance < LOOSE) {
            return HUGE_VAL;
        }
    }
    return fmax(places, change / speed) / (PART * tolerance);
}

/* The whole step and its halves, at whose end the model is left.
 * @return OK, or a failure that ends the run; *made: how it went */
static se3d_status try_both(se3di_integration *integration, se3di_convex_stepper step, double t1,
                            double *error, se3d_status *made)
{
    se3di_equations *equations = integration->equations;
    se3di_convex *c = integration->convex;
    const double middle = 0.5 * (equations->assembly.model->time + t1);
    se3di_aside aside;
    se3di_aside_begin(&aside, equations);
    *made = step(integration, t1);
    memset(c->struck, 0, equations->assembly.body_count);
    if (*made >= 0) {
        keep_ends(c, &equations->assembly);
        mark_struck(c, &equations->assembly);
        come_back(integration);
        *made = step(integration, middle);
    }
    if (*made >= 0) {
        mark_struck(c, &equations->assembly);
        *made = step(integration, t1);
    }
    if (*made >= 0) {
        mark_struck(c, &equations->assembly);
        *error = measure(c, &equations->assembly,
                         se3di_integration_get_tolerance(integration, equations->assembly.model));
    }
    const se3d_status ends = se3di_aside_end(&aside, *made);
    return ends >= 0 && *made < 0 && !se3di_adaptive_may_shrink(*made)
               ? se3di_error_set(equations->error, *made, "%s", aside.ignored.message)
               : ends;
}

/* By how much the next step may be longer than one that erred so: errors are of order 2. */
static double factor_of(double error)
{
    return fmin(GROWTH, fmax(SHRINK, SAFETY / sqrt(fmax(error, 1e-12))));
}

/* What the trial has come to; if steps are watched, once more, for which nobody counts. */
static se3d_status accept(se3di_integration *integration, se3di_convex_stepper step, double t1)
{
    se3di_equations *equations = integration->equations;
    if (!equations->watch) {
        equations->counters.steps += 2;
        return SE3D_OK;
    }
    come_back(integration);
    const double middle = 0.5 * (equations->assembly.model->time + t1);
    se3di_guard none = {0}, *guard = equations->guard ? equations->guard : &none;
    const double tried = guard->steps;
    ++guard->muted; /* an end between the halves would be one within a step */
    se3d_status status = step(integration, middle);
    status = status == SE3D_OK ? step(integration, t1) : status;
    --guard->muted;
    guard->steps = tried;
    return status;
}

/* A step to t1, or a shorter one. */
static se3d_status advance(se3di_integration *integration, se3di_convex_stepper step, double t1,
                           double least)
{
    se3di_equations *equations = integration->equations;
    const double begin = equations->assembly.model->time, whole = t1 - begin;
    const double wanted = *next_of(&equations->assembly);
    SE3DI_TRY(keep(integration));
    for (double h = whole;;) {
        double error = HUGE_VAL;
        se3d_status made = SE3D_OK;
        SE3DI_TRY(se3di_equations_try_step(equations, begin));
        const se3d_status ends = try_both(integration, step, t1, &error, &made);
        if (ends >= 0 && made >= 0 && (error <= 1.0 || h <= least)) {
            const se3d_status status = accept(integration, step, t1);
            const double next = h * factor_of(error);
            if (status >= 0) {
                *next_of(&equations->assembly) =
                    h < whole ? next : fmax(next, fmin(wanted, 2.0 * next));
            }
            return status;
        }
        come_back(integration);
        if (ends < 0 || (made < 0 && h <= least)) {
            return ends < 0 ? ends : step(integration, t1); /* it says why */
        }
        ++equations->counters.rejected;
        h = fmax(least, h * fmin(0.7, factor_of(error)));
        t1 = begin + h;
    }
}

se3d_status se3di_convex_control(se3di_integration *integration, se3di_convex_stepper step,
                                 double t_end, double most)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_model *model = assembly->model;
    se3d_status status = SE3D_OK;
    while (model->time < t_end && status == SE3D_OK) {
        const double rest = t_end - model->time, next = *next_of(assembly);
        const double least = fmax(LEAST * most, ROUNDED * fabs(model->time));
        double h = next > 0.0 ? fmax(least, fmin(next, most)) : most;
        h = h >= rest ? rest : fmin(h, fmax(0.5 * rest, least));
        double t1 = rest > (1.0 + 1e-9) * h ? model->time + h : t_end;
        (void)se3di_kink_step(integration, model->time, h, fmin(2.0 * h, rest), &t1);
        if (integration->at_kink) {
            break;
        }
        status = advance(integration, step, t1, least);
    }
    return status;
}
