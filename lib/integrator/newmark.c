/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/newmark.h"
#include "integrator/adaptive.h"
#include "integrator/kink_step.h"
#include "integrator/memory.h"
#include "integrator/state.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "contact/bodies/pace.h"
#include "integrator/turns.h"
#include "math/over.h"
#include "math/steps.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define TURN_MAX    3.0  /* rad, of a body in a step */
#define TURN_WANTED 0.5  /* if the step is chosen */
#define SPAN_LEAST  0.5  /* from a_n to a, over the step */
#define FIRST_STEP  0.3  /* of the root of the tolerance, over the rates */
#define PART_LEAST  0.01 /* of an equal step that does not converge */
#define SHIFT_MAX   0.1  /* of the motion of an equal step, by z */
#define JUMP_ERROR  360. /* over the tolerance, if the acceleration jumps: 30 a radian */

/* memcpy if count may be zero and the pointers NULL. */
static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

size_t se3di_newmark_history_count(const se3di_assembly *assembly)
{
    return SE3DI_NEWMARK_HEADER + 2 * se3di_state_count(assembly) +
           3 * (size_t)assembly->unknown_count + 2 * (size_t)assembly->row_count;
}

/* v_n, vdot, a, x, z, b, dz [n]; lambda, c [rows]; y. */
size_t se3di_newmark_work_count(const se3di_assembly *assembly)
{
    return 7 * (size_t)assembly->unknown_count + 2 * (size_t)assembly->row_count +
           se3di_state_count(assembly);
}

/* The third derivative of the motion at the start, from accelerations at h/2 and h along the
 * parabola; zero if they cannot be evaluated. */
static se3d_status estimate_jerk(se3di_integration *integration, double h, const double *vdot,
                                 double *jerk)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    const uint32_t n = assembly->unknown_count;
    double *v_n = integration->work, *v = v_n + n;
    const double t = assembly->model->time;
    const double weight[2] = {4.0, -1.0};
    se3d_status status = SE3D_OK;
    se3di_error ignored = {0};
    se3di_error *error = equations->error;
    equations->error = &ignored;
    se3di_assembly_get_velocity(assembly, v_n);
    se3di_equations_save(equations);
    for (uint32_t k = 0; k < n; ++k) {
        jerk[k] = -3.0 * vdot[k] / h;
    }
    for (int stage = 0; stage < 2; ++stage) {
        const double s = 0.5 * h * (stage + 1);
        se3di_equations_restore(equations);
        for (uint32_t k = 0; k < assembly->body_count; ++k) {
            double dq[6];
            for (size_t c = 0; c < 6; ++c) {
                const size_t at = 6 * (size_t)k + c;
                dq[c] = s * v_n[at] + 0.5 * s * s * vdot[at];
                v[at] = v_n[at] + s * vdot[at];
            }
            assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]], dq);
        }
        se3di_assembly_set_velocity(assembly, v);
        status = se3di_acceleration_solve(equations, t + s);
        if (status < 0) {
            memset(jerk, 0, n * sizeof *jerk);
            break;
        }
        for (uint32_t k = 0; k < n; ++k) {
            jerk[k] += weight[stage] * equations->x[k] / h;
        }
    }
    se3di_equations_restore(equations);
    equations->error = error;
    if (status == SE3D_ERR_CALLBACK || status == SE3D_ERR_NO_MEMORY) {
        if (error) {
            *error = ignored; /* not a matter of the motion */
        }
        return status;
    }
    return SE3D_OK;
}

static se3di_newmark_header *header_of(const se3di_integration *integration)
{
    return se3di_newmark_get_history(&integration->equations->assembly).header;
}

/* delta */
static double shift_of(const se3di_integration *integration)
{
    const se3di_newmark method = integration->method->newmark(&integration->settings);
    return method.alpha_m - method.alpha_f;
}

/* a_n is vdot of the start itself, if that leaves it far enough from a; else it is moved to the
 * place that it has at equal steps of h. */
static se3d_status place_start(se3di_integration *integration, double h)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const double shift = shift_of(integration);
    past.header->place = 0.0;
    if (1.0 + shift >= SPAN_LEAST) {
        copy(past.a, past.vdot, assembly->unknown_count);
        return SE3D_OK;
    }
    const se3di_error told = *integration->equations->error;
    const double rest = integration->end - integration->equations->assembly.model->time;
    se3d_status status = estimate_jerk(integration, h, past.vdot, past.a);
    if (rest > 0.0 && rest < h &&
        se3di_adaptive_may_cut(integration->equations, status, integration->end, &told)) {
        integration->foresees = 1;
        status = estimate_jerk(integration, rest, past.vdot, past.a);
    }
    SE3DI_TRY(status);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        past.a[k] = past.vdot[k] + shift * h * past.a[k];
    }
    past.header->place = shift * h;
    return SE3D_OK;
}

/* vdot, lambda and a of the model's state, from which steps go on as from a start. */
static se3d_status restart(se3di_integration *integration, double h)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
    copy(past.vdot, equations->x, assembly->unknown_count);
    copy(past.lambda, model->lambda, assembly->row_count);
    SE3DI_TRY(place_start(integration, h));
    se3di_assembly_set_acceleration(assembly, past.vdot);
    copy(model->lambda, past.lambda, assembly->row_count);
    past.header->last = 0.0;
    past.header->redundant = equations->redundant ? 1.0 : 0.0;
    return SE3D_OK;
}

/* Grow the scales of velocities to those of the accepted state, which is the model's. */
static void grow_scales(const se3di_assembly *assembly, const se3di_newmark_history *past)
{
    double scale[2];
    se3di_newmark_find_scales(assembly, past->vdot, scale);
    se3di_state_scale *kept = &past->header->scale;
    kept->speed = fmax(0.95 * kept->speed, scale[0]);
    kept->spin = fmax(0.95 * kept->spin, scale[1]);
}

/* The accepted state is the model's own. */
static se3d_status adopt(se3di_integration *integration, double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const double next = past.header->at.next;
    se3di_forces_stay(model);
    SE3DI_TRY(restart(integration, h));
    const double redundant = past.header->redundant;
    const double place = past.header->place;
    memset(past.header, 0, sizeof *past.header);
    past.header->at.time = past.header->at.begin = model->time;
    past.header->end = model->time;
    past.header->place = place;
    past.header->redundant = redundant;
    past.header->scale.length = se3di_state_length(model);
    past.header->at.next = next;
    copy(past.header->power, model->power, SE3DI_STATE_WORK);
    se3di_state_get(assembly, past.y);
    copy(past.y_begin, past.y, se3di_state_count(assembly));
    grow_scales(assembly, &past);
    return SE3D_OK;
}

/* A first step that is small against all that turns. */
static double first_step(const se3di_integration *integration, const se3di_newmark_header *header)
{
    const double rate = header->scale.spin + header->scale.speed / header->scale.length;
    return fmin(1e-3, FIRST_STEP * sqrt(integration->settings.tolerance) / (1.0 + rate));
}

se3d_status se3di_newmark_start(se3di_integration *integration, double h)
{
    se3di_newmark_header *header = header_of(integration);
    header->at.next = 0.0;
    SE3DI_TRY(adopt(integration, h));
    header->at.next = first_step(integration, header);
    return SE3D_OK;
}

se3d_status se3di_newmark_renew(se3di_integration *integration)
{
    se3di_newmark_header *header = header_of(integration);
    SE3DI_TRY(adopt(integration, integration->settings.step > 0.0 ? integration->settings.step
                                                                  : header->at.next));
    header->at.renewed = 1.0;
    return SE3D_OK;
}

/* The model is in the accepted state of the history, to the bit. */
static void load(se3di_assembly *assembly, const se3di_newmark_history *past)
{
    se3di_model *model = assembly->model;
    const double *y = past->y;
    se3di_forces_show(model, 0);
    for (uint32_t k = 0; k < assembly->body_count; ++k, y += SE3DI_STATE_SIZE) {
        se3di_frame *frame = &model->frames[assembly->free_body[k]];
        copy(frame->r, y, 3);
        copy(frame->p, y + 3, 4);
        copy(frame->v, y + 7, 3);
        copy(frame->w, y + 10, 3);
        se3di_frame_update(frame);
    }
    copy(model->work, y, SE3DI_STATE_WORK);
    copy(model->power, past->header->power, SE3DI_STATE_WORK);
    copy(model->lambda, past->lambda, assembly->row_count);
    se3di_assembly_set_acceleration(assembly, past->vdot);
    model->time = past->header->end;
    se3di_angles_accept(model);
}

/* alpha_m, beta, gamma of the step: such that a is at t + shift h, where a_n is at t_n + d_n. */
static void set_coefficients(se3di_newmark_step *step, double place)
{
    const se3di_integration *integration = step->integration;
    const se3di_newmark method = integration->method->newmark(&integration->settings);
    const double h = step->h, shift = shift_of(integration);
    const double span = h + shift * h - place;
    step->alpha_f = method.alpha_f;
    step->alpha_m = (shift + method.alpha_f) * h / span;
    step->gamma = (0.5 * h - place) / span;
    step->beta = 0.25 * (step->gamma + 0.5) * (step->gamma + 0.5);
    const double part = (1.0 - step->alpha_f) / (1.0 - step->alpha_m);
    step->velocity = h * step->gamma * part;
    step->position = h * h * step->beta * part;
}

/* A step much longer than the last one, of a method with strong damping: a_n is moved. */
static void move_history(const se3di_assembly *assembly, const se3di_newmark_history *past,
                         double shift, double h)
{
    double *place = &past->header->place;
    if (!(*place < 0.0) || h + shift * h - *place >= SPAN_LEAST * h) {
        return;
    }
    const double ratio = (SPAN_LEAST + shift) * h / *place;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        past->a[k] = past->vdot[k] + ratio * (past->a[k] - past->vdot[k]);
    }
    *place *= ratio;
}

static se3di_newmark_step begin_step(se3di_integration *integration, double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const size_t n = assembly->unknown_count;
    se3di_newmark_step step = {.integration = integration,
                               .equations = integration->equations,
                               .assembly = assembly,
                               .h = h,
                               .t = past.header->end + h,
                               .length = past.header->scale.length,
                               .a_n = past.a,
                               .vdot_n = past.vdot,
                               .v_n = integration->work};
    step.vdot = step.v_n + n;
    step.a = step.vdot + n;
    step.x = step.a + n;
    step.z = step.x + n;
    step.b = step.z + n;
    step.dz = step.b + n;
    step.lambda = step.dz + n;
    step.c = step.lambda + assembly->row_count;
    move_history(assembly, &past, shift_of(integration), h);
    set_coefficients(&step, past.header->place);
    integration->equations->redundant |= past.header->redundant > 0.0;
    se3di_assembly_get_velocity(assembly, step.v_n);
    se3di_newmark_predict(&step);
    return step;
}

/* All that may fail is done. */
static void accept(se3di_newmark_step *step)
{
    se3di_assembly *assembly = step->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const uint32_t n = assembly->unknown_count;
    copy(past.y_begin, past.y, se3di_state_count(assembly));
    copy(past.vdot_begin, past.vdot, n);
    copy(past.lambda_begin, past.lambda, assembly->row_count);
    copy(past.a, step->a, n);
    copy(past.vdot, step->vdot, n);
    copy(past.lambda, step->lambda, assembly->row_count);
    copy(model->lambda, step->lambda, assembly->row_count);
    se3di_assembly_set_acceleration(assembly, step->vdot);
    past.header->at.begin = past.header->end;
    past.header->at.time = past.header->end = model->time = step->t;
    copy(past.header->power_begin, past.header->power, SE3DI_STATE_WORK);
    past.header->place = shift_of(step->integration) * step->h;
    past.header->last = step->h;
    past.header->at.renewed = 0.0;
    past.header->redundant = step->equations->redundant ? 1.0 : 0.0;
    se3di_angles_accept(model);
    if (step->settles) { /* force elements: have */
        se3di_contacts_accept(model);
    } else {
        se3di_loads_accept(model);
    }
    ++step->equations->counters.steps;
}

/* What follows from the accepted state, in which friction may have changed. */
static se3d_status conclude(se3di_newmark_step *step, const se3di_memory_end *end)
{
    se3di_assembly *assembly = step->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    double h = step->h;
    se3d_status status = SE3D_OK;
    if (end->has_changed) {
        se3di_work_take(model, h, end->power);
        h = 0.0; /* what follows is of the next step */
    }
    if (end->has_changed || se3di_contacts_changed(model)) {
        status = restart(step->integration, step->h);
    }
    status = status < 0 ? status : se3di_work_accept(model, h);
    copy(past.header->power, model->power, SE3DI_STATE_WORK);
    se3di_state_get(assembly, past.y);
    grow_scales(assembly, &past);
    return status;
}

/* An impact on a stop begins within the step, and not at the speed that the step begins with:
 * integration->fraction is the part to where it begins. */
static int misses_impact(const se3di_newmark_step *step, double tolerance)
{
    se3di_integration *integration = step->integration;
    const se3di_state_scale *scale = &header_of(integration)->scale;
    const double error = se3di_memory_review_stops(step->assembly->model, step->h, tolerance, scale,
                                                   &integration->fraction);
    return error > 1.0;
}

/* What friction remembers of the end. */
static se3d_status settle(se3di_newmark_step *step, double tolerance, se3di_memory_end *end)
{
    se3di_integration *integration = step->integration;
    const se3di_newmark_history past = se3di_newmark_get_history(step->assembly);
    const se3di_memory_step memory = {.t = step->t,
                                      .h = step->h,
                                      .tolerance = tolerance,
                                      .begin = past.y,
                                      .lambda = step->lambda,
                                      .scale = &past.header->scale,
                                      .memory = integration->newton.memory,
                                      .work = step->dz};
    SE3DI_TRY(se3di_memory_settle(step->equations, &memory, end));
    if (end->error <= 1.0) {
        return SE3D_OK;
    }
    integration->fraction = end->fraction;
    integration->error = end->error;
    return SE3D_ERR_STEP_SIZE;
}

/* A step with an error above `most`, or whose forces act otherwise within it, is made again, up to
 * where they do if that is known: STEP_SIZE. */
static se3d_status review(se3di_newmark_step *step, double most, se3di_memory_end *end)
{
    const se3di_integration *integration = step->integration;
    const double tolerance = fmax(integration->settings.tolerance, SE3DI_NEWMARK_REACH);
    if (most > 0.0 && misses_impact(step, tolerance)) {
        return SE3D_ERR_STEP_SIZE;
    }
    if (!(integration->error <= most)) {
        return SE3D_ERR_STEP_SIZE;
    }
    return step->settles ? settle(step, tolerance, end) : SE3D_OK;
}

/* A step of given length that leaves the branch of the motion at a singular position. */
static se3d_status check_branch(const se3di_newmark_step *step)
{
    if (se3di_newmark_measure_shift(step, 1) <= SHIFT_MAX) {
        return SE3D_OK;
    }
    return se3di_error_set(step->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: a step of %g s leaves the motion: bodies meet their joints "
                           "elsewhere than their velocities lead (a singular position, or the step "
                           "is too long); try a smaller one",
                           step->t, step->h);
}

/* One step of h to t from the accepted state; on failure that is the model's. With an error, as
 * estimated, above `most` (0: any) it fails with STEP_SIZE. */
static se3d_status step_to(se3di_integration *integration, double h, double t, double most)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    SE3DI_TRY(se3di_equations_keep(equations));
    se3di_newmark_step step = begin_step(integration, h);
    se3di_memory_end end = {0};
    step.t = t;
    step.settles = most > 0.0 && equations->friction.count > 0;
    se3di_contacts_begin(model, h, step.velocity / h, 0);
    se3di_equations_save(equations);
    se3d_status status = se3di_newmark_solve(&step);
    integration->error = HUGE_VAL;
    integration->fraction = 0.0;
    if (status >= 0) {
        status = most > 0.0 ? se3di_newmark_estimate(&step, most, &integration->error)
                            : check_branch(&step);
    }
    if (status >= 0 && !(most > 0.0)) {
        integration->error = 0.0;
    }
    if (status >= 0) {
        status = review(&step, most, &end);
        if (status >= 0) {
            status = se3di_state_prepare(equations, t);
            integration->error = status < 0 ? HUGE_VAL : integration->error;
        }
    }
    if (status >= 0) {
        accept(&step);
        status = conclude(&step, &end);
    }
    if (status < 0) {
        se3di_equations_come_back(equations);
    }
    return status;
}

/* What a shorter step may get over: it ends elsewhere. */
static int may_be_divided(se3d_status status)
{
    return status == SE3D_ERR_NO_CONVERGENCE || status == SE3D_ERR_SINGULAR ||
           status == SE3D_ERR_NOT_FINITE;
}

/* To t, in one step of h if that can be; on failure the state is that after the last part, from
 * which the call comes back to where it began (analysis/run_failure.c). */
static se3d_status step_in_parts(se3di_integration *integration, double h, double t)
{
    const se3di_newmark_header *header = header_of(integration);
    double part = h;
    for (;;) {
        const double rest = t - header->end;
        const int is_last = rest <= (1.0 + SE3DI_NEWMARK_SAME_TIME) * part;
        const double length = is_last ? (part == h ? h : rest) : part;
        const se3d_status status =
            step_to(integration, length, is_last ? t : header->end + part, 0.0);
        if (status >= 0 && is_last) {
            return SE3D_OK;
        }
        if (status < 0 && (!may_be_divided(status) || part <= PART_LEAST * h)) {
            return status;
        }
        part = status < 0 ? 0.5 * part : part;
    }
}

se3d_status se3di_newmark_make_step(se3di_integration *integration, double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    se3di_newmark_header *header = past.header;
    const double t0 = assembly->model->time;
    if (fabs(header->at.time - t0) <= SE3DI_NEWMARK_SAME_TIME * header->last) {
        header->at.time = header->end = t0;
        load(assembly, &past);
    } else {
        SE3DI_TRY(adopt(integration, h));
    }
    SE3DI_TRY(step_in_parts(integration, h, t0 + h));
    header->equal = 0.0; /* steps of a run begin anew */
    return se3di_newmark_publish(integration, t0 + h);
}

/* Steps of the length asked for, at equal distances from where they began. One that does not
 * converge (a singular position) is made in parts, a half or less of what remains of it. */
static se3d_status advance_equally(se3di_integration *integration, double longest)
{
    se3di_equations *equations = integration->equations;
    const se3di_model *model = equations->assembly.model;
    se3di_newmark_header *header = header_of(integration);
    double *count = &header->count, h = integration->settings.step;
    if (fabs(header->equal - h) > SE3DI_NEWMARK_SAME_TIME * h) {
        header->origin = header->end;
        header->equal = h;
        *count = 0.0;
    }
    SE3DI_TRY(se3di_equations_try_step(equations, model->time));
    SE3DI_TRY(se3di_contacts_check_step(model, SE3DI_PACE_IMPLICIT, h, equations->error));
    SE3DI_TRY(se3di_turns_check(equations, h, TURN_MAX));
    double part = floor(*count) + 1.0 - *count;
    part = fmin(part > SE3DI_NEWMARK_SAME_TIME ? part : 1.0, longest / h);
    double end = header->origin + (*count + part) * h;
    const double most = se3di_kink_step(integration, header->end, part * h, 2.0 * part * h, &end);
    if (integration->at_kink) {
        return SE3D_OK;
    }
    part = most < part * h ? most / h : part;
    for (;; part *= 0.5, end = header->origin + (*count + part) * h) {
        const double length = se3di_step_length(header->end, end, part * h);
        const se3d_status status = step_to(integration, length, end, 0.0);
        if (status >= 0) {
            *count += part;
        }
        if (!may_be_divided(status) || part <= PART_LEAST) {
            return status;
        }
    }
}

static double factor_of(double error)
{
    return isfinite(error) ? 0.9 / sqrt(fmax(error, 1e-6)) : 0.25;
}

/* From the error of an accepted step; equal ones where they do. */
static double next_step(double h, double error)
{
    const double factor = factor_of(error);
    return error <= 1.0 ? (factor > 1.2 ? h * fmin(2.0, factor) : fmin(1.0, factor) * h)
                        : h * fmin(0.8, fmax(0.1, factor));
}

/* No contact is stepped over, and nothing turns too far. */
static double limit_step(const se3di_integration *integration, double h)
{
    const se3di_model *model = integration->equations->assembly.model;
    double spin = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        spin = fmax(spin, se3di_norm(model->frames[k].w));
    }
    h = h * spin > TURN_WANTED ? TURN_WANTED / spin : h;
    h = se3di_state_limit_turn(model, 0.0, h);
    return se3di_contacts_pace(model, SE3DI_PACE_ADAPTIVE, h);
}

/* What the error of the next attempt may be, relative to the tolerance: if the one of the last
 * two has fallen with h, not with its square, the acceleration jumps, and no step gets over that
 * with a small error. */
static double get_most(const double h[2], const double error[2])
{
    const double ratio = se3di_over(h[0], h[1]);
    const int jumps = isfinite(error[0]) && isfinite(error[1]) && error[1] > 0.0 &&
                      error[0] / error[1] < ratio * sqrt(ratio);
    return jumps ? JUMP_ERROR : 1.0;
}

/* ---- in the loop of all methods ---- */

typedef struct controlled_step {
    se3di_adaptive step; /* first, so that it is found from the loop's */
    double longest;
    double tried[2], errors[2]; /* of the last two attempts */
    double most;                /* what the error of this one may be */
} controlled_step;

static controlled_step *get_step(se3di_adaptive *step)
{
    return (controlled_step *)(void *)step;
}

static double pace(se3di_adaptive *step, double h)
{
    return limit_step(step->integration, fmin(h, get_step(step)->longest));
}

static se3d_status try_step(se3di_adaptive *step, double h, double *error)
{
    controlled_step *s = get_step(step);
    s->most = get_most(s->tried, s->errors);
    const se3d_status status = step_to(step->integration, h, step->t, s->most);
    *error = status < 0 ? HUGE_VAL : 0.0;
    step->fraction = step->integration->fraction;
    if (status == SE3D_ERR_STEP_SIZE && step->fraction > 0.0) {
        return SE3D_OK; /* it is tried again up to the impact */
    }
    s->tried[0] = s->tried[1];
    s->errors[0] = s->errors[1];
    s->tried[1] = h;
    s->errors[1] = step->integration->error;
    return status;
}

/* It is taken already. */
static se3d_status take(se3di_adaptive *step, double h, double error)
{
    double *next = &step->at->next;
    const double wanted = next_step(h, step->integration->error);
    (void)error;
    *next = h < *next ? fmin(*next, fmax(2.0 * h, wanted)) : wanted;
    if (get_step(step)->most > 1.0) { /* differences over the jump say nothing of what follows */
        *next = h;
        header_of(step->integration)->last = 0.0;
    }
    return SE3D_OK;
}

/* By a fifth at least. */
static double shrink(se3di_adaptive *step, double h, se3d_status status, double error)
{
    (void)h;
    (void)status;
    (void)error;
    return fmin(0.8, fmax(0.1, factor_of(step->integration->error)));
}

static se3d_status surrender(se3di_adaptive *step, double h, se3d_status status, double error)
{
    const int is_error = status == SE3D_ERR_STEP_SIZE && isfinite(step->integration->error);
    (void)error;
    return se3di_adaptive_blame(step->integration, step->at->time, h, is_error ? SE3D_OK : status);
}

/* To t_end at most if it `ends` there. */
static se3d_status advance_by_error(se3di_integration *integration, double t_end, int ends)
{
    static const se3di_adaptive_class methods = {pace, try_step, take, shrink, surrender, 1e-12};
    const double end = header_of(integration)->end;
    controlled_step s = {.longest = ends ? t_end - end : HUGE_VAL, .errors = {HUGE_VAL, HUGE_VAL}};
    s.step = (se3di_adaptive){.methods = &methods,
                              .integration = integration,
                              .at = &header_of(integration)->at,
                              .ends = ends};
    s.step.at->time = end;
    return se3di_adaptive_advance(&s.step, t_end);
}

/* Not past t_end if `ends`, or if a callback fails there. */
static se3d_status advance_to_end(se3di_integration *integration, double t_end, int ends)
{
    se3di_equations *equations = integration->equations;
    const double rest = t_end - header_of(integration)->end;
    const se3di_error told = *equations->error;
    const se3d_status status = advance_equally(integration, ends ? rest : HUGE_VAL);
    if (ends || !se3di_adaptive_may_cut(equations, status, t_end, &told)) {
        return status;
    }
    const se3di_newmark_history past = se3di_newmark_get_history(&equations->assembly);
    load(&equations->assembly, &past);
    return advance_equally(integration, rest);
}

se3d_status se3di_newmark_advance(se3di_integration *integration, double t_end)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    se3di_newmark_header *header = past.header;
    const double last = header->end - header->at.begin, rest = t_end - header->end;
    if (rest <= SE3DI_NEWMARK_SAME_TIME * last) {
        double end;
        (void)se3di_kink_step(integration, header->end, rest, rest, &end);
        if (integration->at_kink) {
            return SE3D_OK;
        }
        header->at.time = t_end;
        return SE3D_OK;
    }
    load(assembly, &past);
    const int ends = se3di_adaptive_ends(integration, &header->at);
    return integration->settings.step > 0.0 ? advance_to_end(integration, t_end, ends)
                                            : advance_by_error(integration, t_end, ends);
}

se3d_status se3di_newmark_run(se3di_integration *integration, double t_end)
{
    const se3di_newmark_header *header = header_of(integration);
    se3d_status status = SE3D_OK;
    while (header->at.time < t_end && status >= 0 && !integration->at_kink) {
        status = se3di_newmark_advance(integration, t_end);
    }
    return status < 0 ? status : se3di_newmark_publish(integration, fmin(t_end, header->at.time));
}
