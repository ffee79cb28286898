/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/newmark.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "contact/bodies/pace.h"
#include "integrator/turns.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define TURN_MAX    3.0  /* rad, of a body in a step */
#define TURN_WANTED 0.5  /* if the step is chosen */
#define SPAN_LEAST  0.5  /* from a_n to a, over the step */
#define FIRST_STEP  0.3  /* of the root of the tolerance, over the rates */
#define PART_LEAST  0.01 /* of an equal step that does not converge */
#define JUMP_ERROR  30.0 /* over the tolerance, where the acceleration jumps */

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

se3di_newmark_history se3di_newmark_get_history(const se3di_assembly *assembly)
{
    const size_t count = se3di_state_count(assembly), n = assembly->unknown_count;
    se3di_newmark_history past = {.header = assembly->model->history};
    past.y = past.header + SE3DI_NEWMARK_HEADER;
    past.y_begin = past.y + count;
    past.a = past.y_begin + count;
    past.vdot = past.a + n;
    past.vdot_begin = past.vdot + n;
    past.lambda = past.vdot_begin + n;
    past.lambda_begin = past.lambda + assembly->row_count;
    return past;
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

static double shift_of(const se3di_newmark *method)
{
    return method->alpha_m - method->alpha_f;
}

/* a_n is vdot of the start itself, where that leaves it far enough from a; else it is moved to the
 * place that it has at equal steps of h. */
static se3d_status place_start(se3di_integration *integration, const se3di_newmark *method,
                               double h)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const double shift = shift_of(method);
    past.header[SE3DI_NEWMARK_PLACE] = 0.0;
    if (1.0 + shift >= SPAN_LEAST) {
        copy(past.a, past.vdot, assembly->unknown_count);
        return SE3D_OK;
    }
    SE3DI_TRY(estimate_jerk(integration, h, past.vdot, past.a));
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        past.a[k] = past.vdot[k] + shift * h * past.a[k];
    }
    past.header[SE3DI_NEWMARK_PLACE] = shift * h;
    return SE3D_OK;
}

/* vdot, lambda and a of the model's state, from which steps go on as from a start. */
static se3d_status restart(se3di_integration *integration, const se3di_newmark *method, double h)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
    copy(past.vdot, equations->x, assembly->unknown_count);
    copy(past.lambda, model->lambda, assembly->row_count);
    SE3DI_TRY(place_start(integration, method, h));
    se3di_assembly_set_acceleration(assembly, past.vdot);
    copy(model->lambda, past.lambda, assembly->row_count);
    past.header[SE3DI_NEWMARK_LAST] = 0.0;
    past.header[SE3DI_NEWMARK_REDUNDANT] = equations->redundant ? 1.0 : 0.0;
    return SE3D_OK;
}

/* The largest velocities of the model's state, or what its accelerations make on the way of its
 * length and a turn of 1 rad: [0] of translation, [1] of rotation. */
static void find_scales(const se3di_assembly *assembly, const double *vdot, double scale[2])
{
    const double length = assembly->model->history[SE3DI_NEWMARK_LENGTH];
    double a = 0.0, wdot = 0.0;
    scale[0] = scale[1] = 1e-12;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        scale[0] = fmax(scale[0], se3di_norm(frame->v));
        scale[1] = fmax(scale[1], se3di_norm(frame->w));
        a = fmax(a, se3di_norm(vdot + 6 * k));
        wdot = fmax(wdot, se3di_norm(vdot + 6 * k + 3));
    }
    scale[0] = fmax(scale[0], sqrt(a * length));
    scale[1] = fmax(scale[1], sqrt(wdot));
}

/* Grow the scales of velocities to those of the accepted state, which is the model's. */
static void grow_scales(const se3di_assembly *assembly, const se3di_newmark_history *past)
{
    double scale[2];
    find_scales(assembly, past->vdot, scale);
    for (int k = 0; k < 2; ++k) {
        double *kept = &past->header[SE3DI_NEWMARK_SPEED + k];
        *kept = fmax(0.95 * *kept, scale[k]);
    }
}

/* The accepted state is the model's own. */
static se3d_status adopt(se3di_integration *integration, const se3di_newmark *method, double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const double next = past.header[SE3DI_NEWMARK_NEXT];
    se3di_forces_stay(model);
    SE3DI_TRY(restart(integration, method, h));
    const double redundant = past.header[SE3DI_NEWMARK_REDUNDANT];
    const double place = past.header[SE3DI_NEWMARK_PLACE];
    memset(past.header, 0, SE3DI_NEWMARK_HEADER * sizeof *past.header);
    past.header[SE3DI_NEWMARK_TIME] = past.header[SE3DI_NEWMARK_BEGIN] = model->time;
    past.header[SE3DI_NEWMARK_END] = model->time;
    past.header[SE3DI_NEWMARK_PLACE] = place;
    past.header[SE3DI_NEWMARK_REDUNDANT] = redundant;
    past.header[SE3DI_NEWMARK_LENGTH] = se3di_state_length(model);
    past.header[SE3DI_NEWMARK_NEXT] = next;
    copy(past.header + SE3DI_NEWMARK_POWER, model->power, SE3DI_STATE_WORK);
    se3di_state_get(assembly, past.y);
    copy(past.y_begin, past.y, se3di_state_count(assembly));
    grow_scales(assembly, &past);
    return SE3D_OK;
}

/* A first step that is small against all that turns. */
static double first_step(const se3di_integration *integration, const double *header)
{
    const double rate =
        header[SE3DI_NEWMARK_SPIN] + header[SE3DI_NEWMARK_SPEED] / header[SE3DI_NEWMARK_LENGTH];
    return fmin(1e-3, FIRST_STEP * sqrt(integration->settings.tolerance) / (1.0 + rate));
}

se3d_status se3di_newmark_start(se3di_integration *integration, const se3di_newmark *method,
                                double h)
{
    double *header = integration->equations->assembly.model->history;
    header[SE3DI_NEWMARK_NEXT] = 0.0;
    SE3DI_TRY(adopt(integration, method, h));
    header[SE3DI_NEWMARK_NEXT] = first_step(integration, header);
    return SE3D_OK;
}

se3d_status se3di_newmark_renew(se3di_integration *integration, const se3di_newmark *method)
{
    double *header = integration->equations->assembly.model->history;
    SE3DI_TRY(adopt(integration, method,
                    integration->settings.step > 0.0 ? integration->settings.step
                                                     : header[SE3DI_NEWMARK_NEXT]));
    header[SE3DI_NEWMARK_RENEWED] = 1.0;
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
    copy(model->power, past->header + SE3DI_NEWMARK_POWER, SE3DI_STATE_WORK);
    copy(model->lambda, past->lambda, assembly->row_count);
    se3di_assembly_set_acceleration(assembly, past->vdot);
    model->time = past->header[SE3DI_NEWMARK_END];
    se3di_angles_accept(model);
}

/* alpha_m, beta, gamma of the step: such that a is at t + shift h, where a_n is at t_n + d_n. */
static void set_coefficients(se3di_newmark_step *step, const se3di_newmark *method, double place)
{
    const double h = step->h;
    const double span = h + shift_of(method) * h - place;
    step->alpha_f = method->alpha_f;
    step->alpha_m = (shift_of(method) + method->alpha_f) * h / span;
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
    double *place = &past->header[SE3DI_NEWMARK_PLACE];
    if (!(*place < 0.0) || h + shift * h - *place >= SPAN_LEAST * h) {
        return;
    }
    const double ratio = (SPAN_LEAST + shift) * h / *place;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        past->a[k] = past->vdot[k] + ratio * (past->a[k] - past->vdot[k]);
    }
    *place *= ratio;
}

/* vdot goes on as in the last step. */
static void predict(se3di_newmark_step *step)
{
    const se3di_newmark_history past = se3di_newmark_get_history(step->assembly);
    const double last = past.header[SE3DI_NEWMARK_LAST];
    const double ratio = last > 0.0 ? step->h / last : 0.0;
    for (uint32_t k = 0; k < step->assembly->unknown_count; ++k) {
        step->vdot[k] = past.vdot[k] + ratio * (past.vdot[k] - past.vdot_begin[k]);
    }
    copy(step->lambda, past.lambda, step->assembly->row_count);
}

static se3di_newmark_step begin_step(se3di_integration *integration, const se3di_newmark *method,
                                     double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const size_t n = assembly->unknown_count;
    se3di_newmark_step step = {.integration = integration,
                               .equations = integration->equations,
                               .assembly = assembly,
                               .h = h,
                               .t = past.header[SE3DI_NEWMARK_END] + h,
                               .length = past.header[SE3DI_NEWMARK_LENGTH],
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
    move_history(assembly, &past, shift_of(method), h);
    set_coefficients(&step, method, past.header[SE3DI_NEWMARK_PLACE]);
    integration->equations->redundant |= past.header[SE3DI_NEWMARK_REDUNDANT] > 0.0;
    se3di_assembly_get_velocity(assembly, step.v_n);
    predict(&step);
    return step;
}

/* The local error of velocities in a unit of time in which they change by themselves, relative to
 * the tolerance: from the third derivative of the motion, by differences of velocities. */
static double estimate_error(const se3di_newmark_step *step)
{
    const se3di_newmark_history past = se3di_newmark_get_history(step->assembly);
    const double *header = past.header;
    const double last = header[SE3DI_NEWMARK_LAST], h = step->h;
    const double place = header[SE3DI_NEWMARK_PLACE] / h;
    const double span = (0.5 - place) / step->gamma;
    const double constant = fabs(0.5 * place + step->beta * span - 1.0 / 6.0) + 1.0 / 12.0;
    double worst = 0.0, scale[2];
    find_scales(step->assembly, step->vdot, scale);
    for (size_t k = 0; k < step->assembly->unknown_count; ++k) {
        const se3di_frame *frame = &step->assembly->model->frames[step->assembly->free_body[k / 6]];
        const double v = k % 6 < 3 ? frame->v[k % 6] : frame->w[k % 6 - 3];
        const double before = past.y_begin[SE3DI_STATE_SIZE * (k / 6) + 7 + k % 6];
        const double mean = last > 0.0 ? (step->v_n[k] - before) / last : step->vdot_n[k];
        const double jerk = 2.0 * fabs((v - step->v_n[k]) / h - mean) / (h + last);
        const size_t kind = k % 6 / 3;
        const double size = jerk / fmax(scale[kind], header[SE3DI_NEWMARK_SPEED + kind]);
        worst = size <= worst ? worst : size; /* NaN stays */
    }
    return constant * h * h * worst /
           fmax(step->integration->settings.tolerance, SE3DI_NEWMARK_REACH);
}

/* All that may fail is done. */
static void accept(se3di_newmark_step *step, const se3di_newmark *method)
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
    past.header[SE3DI_NEWMARK_BEGIN] = past.header[SE3DI_NEWMARK_END];
    past.header[SE3DI_NEWMARK_TIME] = past.header[SE3DI_NEWMARK_END] = model->time = step->t;
    copy(past.header + SE3DI_NEWMARK_POWER + SE3DI_STATE_WORK, past.header + SE3DI_NEWMARK_POWER,
         SE3DI_STATE_WORK);
    past.header[SE3DI_NEWMARK_PLACE] = shift_of(method) * step->h;
    past.header[SE3DI_NEWMARK_LAST] = step->h;
    past.header[SE3DI_NEWMARK_RENEWED] = 0.0;
    past.header[SE3DI_NEWMARK_REDUNDANT] = step->equations->redundant ? 1.0 : 0.0;
    se3di_angles_accept(model);
    se3di_loads_accept(model);
    ++step->equations->counters.steps;
}

/* What follows from the accepted state. */
static se3d_status conclude(se3di_newmark_step *step, const se3di_newmark *method)
{
    se3di_assembly *assembly = step->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    se3d_status status = SE3D_OK;
    if (se3di_contacts_changed(model)) { /* accelerations have jumped */
        status = restart(step->integration, method, step->h);
    }
    status = status < 0 ? status : se3di_work_accept(model, step->h);
    copy(past.header + SE3DI_NEWMARK_POWER, model->power, SE3DI_STATE_WORK);
    se3di_state_get(assembly, past.y);
    grow_scales(assembly, &past);
    return status;
}

/* One step of h to t from the accepted state; on failure that is the model's. With an error, as
 * estimated, above `most` (0: any) it fails with STEP_SIZE. */
static se3d_status step_to(se3di_integration *integration, const se3di_newmark *method, double h,
                           double t, double most)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    SE3DI_TRY(se3di_equations_keep(equations));
    se3di_newmark_step step = begin_step(integration, method, h);
    step.t = t;
    se3di_contacts_begin(model, h, step.velocity / h, 0);
    se3di_equations_save(equations);
    se3d_status status = se3di_newmark_solve(&step);
    integration->error = HUGE_VAL;
    if (status >= 0) {
        integration->error = most > 0.0 ? estimate_error(&step) : 0.0;
        const int is_refused = !(integration->error <= most);
        status = is_refused ? SE3D_ERR_STEP_SIZE : se3di_state_prepare(equations, t);
        integration->error = status < 0 && !is_refused ? HUGE_VAL : integration->error;
    }
    if (status >= 0) {
        accept(&step, method);
        status = conclude(&step, method);
    }
    if (status < 0) {
        se3di_equations_come_back(equations);
    }
    return status;
}

se3d_status se3di_newmark_make_step(se3di_integration *integration, const se3di_newmark *method,
                                    double h)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    double *header = past.header;
    const double t0 = assembly->model->time;
    if (fabs(header[SE3DI_NEWMARK_TIME] - t0) <=
        SE3DI_NEWMARK_SAME_TIME * header[SE3DI_NEWMARK_LAST]) {
        header[SE3DI_NEWMARK_TIME] = header[SE3DI_NEWMARK_END] = t0;
        load(assembly, &past);
    } else {
        SE3DI_TRY(adopt(integration, method, h));
    }
    SE3DI_TRY(step_to(integration, method, h, t0 + h, 0.0));
    return se3di_newmark_publish(integration, t0 + h);
}

/* Steps of the length asked for, at equal distances from where they began. One that does not
 * converge (a singular position) is made in parts, a half or less of what remains of it. */
static se3d_status advance_equally(se3di_integration *integration, const se3di_newmark *method,
                                   double longest)
{
    se3di_equations *equations = integration->equations;
    const se3di_model *model = equations->assembly.model;
    double *header = model->history;
    double *count = &header[SE3DI_NEWMARK_COUNT], h = integration->settings.step;
    if (fabs(header[SE3DI_NEWMARK_EQUAL] - h) > SE3DI_NEWMARK_SAME_TIME * h) {
        header[SE3DI_NEWMARK_ORIGIN] = header[SE3DI_NEWMARK_END];
        header[SE3DI_NEWMARK_EQUAL] = h;
        *count = 0.0;
    }
    SE3DI_TRY(se3di_equations_try_step(equations, model->time));
    SE3DI_TRY(se3di_contacts_check_step(model, SE3DI_PACE_IMPLICIT, h, equations->error));
    SE3DI_TRY(se3di_turns_check(equations, h, TURN_MAX));
    for (double part = fmin(floor(*count) + 1.0 - *count, longest / h);; part *= 0.5) {
        const double to = *count + part;
        const se3d_status status =
            step_to(integration, method, part * h, header[SE3DI_NEWMARK_ORIGIN] + to * h, 0.0);
        if (status >= 0) {
            *count = to;
        }
        if (status != SE3D_ERR_NO_CONVERGENCE || part <= PART_LEAST) {
            return status;
        }
    }
}

/* From the error of a step; a rejected one is at least shortened by a fifth. */
static double next_step(double h, double error)
{
    const double factor = isfinite(error) ? 0.9 / sqrt(fmax(error, 1e-6)) : 0.25;
    if (error <= 1.0) { /* equal steps where they do */
        return factor > 1.2 ? h * fmin(2.0, factor) : fmin(1.0, factor) * h;
    }
    return h * fmin(0.8, fmax(0.1, factor));
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

static se3d_status fail_small(const se3di_integration *integration, double t, se3d_status cause)
{
    const se3di_model *model = integration->equations->assembly.model;
    if (cause == SE3D_ERR_STEP_SIZE && isfinite(integration->error)) {
        cause =
            se3di_error_set(integration->equations->error, cause,
                            "t = %g s: the step fell to %.3g s: the tolerance %g cannot be "
                            "met here; the motion is not smooth",
                            t, model->history[SE3DI_NEWMARK_NEXT], integration->settings.tolerance);
    }
    se3di_contacts_blame(model, integration->equations->error);
    return cause;
}

/* What the error of the next attempt may be, relative to the tolerance: where the one of the last
 * two has fallen with h, not with its square, the acceleration jumps, and no step gets over that
 * with a small error. */
static double get_most(const double h[2], const double error[2])
{
    const double ratio = h[0] / h[1];
    const int jumps = isfinite(error[0]) && isfinite(error[1]) && error[1] > 0.0 &&
                      error[0] / error[1] < ratio * sqrt(ratio);
    return jumps ? JUMP_ERROR : 1.0;
}

static se3d_status advance_by_error(se3di_integration *integration, const se3di_newmark *method,
                                    double longest)
{
    se3di_equations *equations = integration->equations;
    double *header = equations->assembly.model->history;
    double *next = &header[SE3DI_NEWMARK_NEXT];
    const double t = header[SE3DI_NEWMARK_END], before = *next;
    double tried[2] = {0.0, 0.0}, errors[2] = {HUGE_VAL, HUGE_VAL};
    for (;;) {
        const double h = limit_step(integration, fmin(*next, longest));
        const double most = get_most(tried, errors);
        SE3DI_TRY(se3di_equations_try_step(equations, t));
        const se3d_status status = step_to(integration, method, h, t + h, most);
        if (status >= 0) {
            const double wanted = next_step(h, integration->error);
            *next = h < *next ? fmin(*next, fmax(2.0 * h, wanted)) : wanted;
            if (most > 1.0) { /* differences over the jump say nothing of what follows */
                *next = h;
                header[SE3DI_NEWMARK_LAST] = 0.0;
            }
            return status;
        }
        if (status == SE3D_ERR_INTERRUPTED || status == SE3D_ERR_NO_MEMORY) {
            *next = before;
            return status;
        }
        ++equations->counters.rejected;
        tried[0] = tried[1];
        errors[0] = errors[1];
        tried[1] = h;
        errors[1] = integration->error;
        *next = next_step(h, integration->error);
        if (!(*next > 1e-12 * fmax(1e-3, fabs(t)))) {
            const se3d_status failed = fail_small(integration, t, status);
            *next = before; /* nothing is learnt from attempts that end the run */
            return failed;
        }
    }
}

se3d_status se3di_newmark_advance(se3di_integration *integration, const se3di_newmark *method,
                                  double t_end)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    double *header = past.header;
    const double last = header[SE3DI_NEWMARK_END] - header[SE3DI_NEWMARK_BEGIN];
    if (t_end - header[SE3DI_NEWMARK_END] <= SE3DI_NEWMARK_SAME_TIME * last) {
        header[SE3DI_NEWMARK_TIME] = t_end;
        return SE3D_OK;
    }
    load(assembly, &past);
    /* what acts has changed, and may soon do so again: not past the end of the run */
    const double longest =
        header[SE3DI_NEWMARK_RENEWED] > 0.0 ? t_end - header[SE3DI_NEWMARK_END] : HUGE_VAL;
    return integration->settings.step > 0.0 ? advance_equally(integration, method, longest)
                                            : advance_by_error(integration, method, longest);
}

se3d_status se3di_newmark_run(se3di_integration *integration, const se3di_newmark *method,
                              double t_end)
{
    const double *header = integration->equations->assembly.model->history;
    se3d_status status = SE3D_OK;
    while (header[SE3DI_NEWMARK_TIME] < t_end && status >= 0) {
        status = se3di_newmark_advance(integration, method, t_end);
    }
    return status < 0 ? status : se3di_newmark_publish(integration, t_end);
}
