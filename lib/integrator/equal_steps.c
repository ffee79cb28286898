/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/equal_steps.h"

#include "assembly/user.h"
#include "base/log.h"
#include "contact/bodies/pace.h"
#include "force/friction.h"
#include "integrator/aside.h"
#include "integrator/integrator.h"
#include "integrator/kink_step.h"
#include "integrator/pulse_step.h"
#include "integrator/state.h"
#include "math/steps.h"
#include "math/vec3.h"
#include "model/state.h"
#include "particles/sets.h"

#include <math.h>
#include <string.h>

#define TRIALS_MAX  2000  /* steps that are tried */
#define TRIAL_ERROR 1e-4  /* of a trial step */
#define SHORTEST    1e-9  /* trial, of the run */
#define STEP_LONG   1e-3  /* s: not longer, unless the trials came to the end of a long run */
#define SPAN_PART   1e-2  /* of that run */
#define TURN_MOST   1.0   /* rad, of a body in a step */
#define ADD_UP      20.0  /* rad of the motion, over which the errors of steps add up */
#define FACTOR_4    5.0   /* the error of order 4 over the square of that of order 2 */
#define MUCH        4.0   /* over the tolerance, */
#define JUMPS       20.0  /* over the tolerance, for a jump: 0.6 are aimed at */
#define PHASE       0.3   /* rad of the motion that it is so in: the step was too long */
#define CALM        6.3   /* rad of that motion without it: the step may be longer again */
#define PART_LEAST  1e-3  /* of the first step */
#define REACH_2     1e-10 /* of order 2, */
#define REACH_4     1e-11 /* and of order 4 */

static int are_chosen(const se3di_integration *integration, const se3di_model *model)
{
    return integration->method->chooses_step && !(integration->settings.step > 0.0) &&
           !(model->contact.step > 0.0) && !model->sets;
}

int se3di_equal_steps_are_chosen(const se3di_integration *integration)
{
    return are_chosen(integration, integration->equations->assembly.model);
}

double se3di_equal_steps_reach(const se3di_integration *integration, const se3di_model *model)
{
    return !are_chosen(integration, model)    ? 0.0
           : integration->settings.order == 4 ? REACH_4
                                              : REACH_2;
}

static double tolerance_of(const se3di_integration *integration)
{
    return se3di_integration_get_tolerance(integration, integration->equations->assembly.model);
}

/* Of steps of which 0 is none. */
static double shorter(double a, double b)
{
    return a > 0.0 && !(b > 0.0 && b < a) ? a : b;
}

static int moves_bodies(const se3di_model *model)
{
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        if (!model->bodies[k].fixed) {
            return 1;
        }
    }
    return 0;
}

double se3di_equal_steps_given(const se3di_integration *integration, const se3di_model *model)
{
    const se3di_integrator *method = integration->method;
    const double step =
        method->fixes_step || method->chooses_step ? integration->settings.step : 0.0;
    if (!method->takes_particles) {
        return step;
    }
    const double asked = shorter(step, model->contact.step);
    const double all = shorter(asked, se3di_sets_step(model));
    return asked > 0.0 || !moves_bodies(model) ? all : fmin(all, STEP_LONG);
}

double se3di_equal_steps_get(const se3di_integration *integration, const se3di_model *model)
{
    const se3di_integrator *method = integration->method;
    const double given = se3di_equal_steps_given(integration, model);
    if (given > 0.0) {
        const double most = integration->settings.step_most;
        return integration->settings.step > 0.0 || !(most > 0.0) ? given : fmin(given, most);
    }
    return are_chosen(integration, model) &&
                   se3di_integrator_of_history(model->history_tag) == method
               ? model->history[SE3DI_EQUAL_STEP]
               : 0.0;
}

double se3di_equal_steps_next(se3di_integration *integration, double most, double t_end)
{
    const se3di_model *model = integration->equations->assembly.model;
    const double rest = t_end - model->time;
    const double equal = rest / se3di_steps_count(rest, most, t_end);
    const se3di_pace_kind kind =
        integration->method->is_implicit ? SE3DI_PACE_IMPLICIT : SE3DI_PACE_EXPLICIT;
    const double h = se3di_contacts_next_step(model, kind, most, t_end);
    integration->is_paced = h < (1.0 - 1e-9) * equal;
    return h;
}

/* How much the accelerations of a body (dense index) have changed since `before`: of its centre
 * [0], of its turn [1]. */
static void get_change(const se3di_model *model, uint32_t body, const double *before,
                       double change[2])
{
    double d[6];
    for (size_t c = 0; c < 6; ++c) {
        d[c] = model->acceleration[6 * (size_t)body + c] - before[6 * (size_t)body + c];
    }
    change[0] = se3di_norm(d);
    change[1] = se3di_norm(d + 3);
}

/* The largest speeds so far, or what accelerations make on the way of the mechanism's length and a
 * turn of 1 rad; and the third derivatives of the motion in the step, of centres, of turns, and of
 * user-defined states relative to their sizes.
 * @return the error of a step of order 2 */
static double measure(const se3di_equations *equations, double h, double speed[2], double jerk[3])
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    double v = 1e-12, w = 1e-12, a = 0.0, wdot = 0.0, z = 0.0, most[2] = {0.0, 0.0};
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        const double *acceleration = model->acceleration + 6 * (size_t)body;
        double change[2];
        get_change(model, body, equations->kept.acceleration.data, change);
        if (model->bodies[body].state != 0) {
            z = fmax(z, change[0] / h / se3di_state_size(model, body));
            continue;
        }
        most[0] = fmax(most[0], change[0]);
        most[1] = fmax(most[1], change[1]);
        v = fmax(v, se3di_norm(model->frames[body].v));
        w = fmax(w, se3di_norm(model->frames[body].w));
        a = fmax(a, se3di_norm(acceleration));
        wdot = fmax(wdot, se3di_norm(acceleration + 3));
    }
    speed[0] = fmax(speed[0], fmax(v, sqrt(a * se3di_state_length(model))));
    speed[1] = fmax(speed[1], fmax(w, sqrt(wdot)));
    jerk[0] = most[0] / h;
    jerk[1] = most[1] / h;
    jerk[2] = z;
    return h * h / 12.0 * fmax(fmax(jerk[0] / speed[0], jerk[1] / speed[1]), z);
}

/* Of the motion, relative to the tolerance, if its steps have the error e2 in order 2. */
static double error_of(const se3di_integration *integration, double e2)
{
    const double e = integration->settings.order == 4 ? FACTOR_4 * e2 * e2 : e2;
    return ADD_UP * e / tolerance_of(integration);
}

/* The error e2 that a step may have. */
static double most_of(const se3di_integration *integration)
{
    const double e = tolerance_of(integration) / ADD_UP;
    return integration->settings.order == 4 ? sqrt(e / FACTOR_4) : e;
}

/* 1, 2 or 5 times a power of ten: rows at round times then divide into equal steps. */
static double round_down(double h)
{
    double power = 1.0;
    while (power > h) {
        power /= 10.0;
    }
    while (10.0 * power <= h) {
        power *= 10.0;
    }
    return h >= 5.0 * power ? 5.0 * power : h >= 2.0 * power ? 2.0 * power : power;
}

typedef struct trial {
    se3di_integration *integration;
    double begin, t_end, h;
    double speed[2], jerk[3]; /* the largest so far */
    double most_spin;
    double last, last_h; /* error and length of the attempt before, which was refused; 0: none */
} trial;

static double largest_spin(const se3di_model *model)
{
    double spin = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        spin = fmax(spin, se3di_norm(model->frames[k].w));
    }
    return spin;
}

/* Some friction has come to a stand, broken loose or turned since the kept state. */
static int friction_changed(const se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    const double *before = equations->kept.memory.data;
    int changed = 0;
    for (size_t k = 0; k < model->force_slots.count && !changed; ++k) {
        const se3di_force *force = &model->forces[k];
        changed = force->type == SE3DI_FORCE_FRICTION &&
                  fabs(force->state[SE3DI_FRICTION_MODE] -
                       before[SE3DI_FORCE_STATES * k + SE3DI_FRICTION_MODE]) > 0.0;
    }
    return changed;
}

/* The step was made: is it exact enough to go on from it, and what does it say? */
static void judge(trial *t, double h)
{
    se3di_equations *equations = t->integration->equations;
    double speed[2] = {t->speed[0], t->speed[1]}, jerk[3];
    const double e = measure(equations, h, speed, jerk);
    const int jumps = friction_changed(equations) ||
                      (t->last_h > 0.0 && e * t->last_h > t->last * h * sqrt(h / t->last_h) &&
                       h < 0.5 * t->last_h);
    if (e > TRIAL_ERROR && !jumps && h > SHORTEST * (t->t_end - t->begin)) {
        t->last = e;
        t->last_h = h;
        t->h = h * fmax(0.1, fmin(0.4, 0.8 * sqrt(TRIAL_ERROR / e)));
        se3di_equations_come_back(equations);
        return;
    }
    memcpy(t->speed, speed, sizeof speed);
    t->most_spin = fmax(t->most_spin, largest_spin(equations->assembly.model));
    t->last_h = 0.0;
    if (!jumps) {
        t->jerk[0] = fmax(t->jerk[0], jerk[0]);
        t->jerk[1] = fmax(t->jerk[1], jerk[1]);
        t->jerk[2] = fmax(t->jerk[2], jerk[2]);
        t->h = fmin(2.0 * h, 0.8 * h * sqrt(TRIAL_ERROR / fmax(e, 1e-30)));
    }
}

/* A bare step, which nobody counts or watches. */
static se3d_status try_step(trial *t, double h)
{
    se3di_integration *integration = t->integration;
    integration->at_kink = 0;
    const se3d_status status = integration->method->step(integration, h);
    if (status >= 0 && !integration->at_kink) {
        judge(t, h);
    } else if (status < 0) {
        t->h = 0.25 * h;
    }
    return status;
}

static int ends_trials(se3d_status status)
{
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED ||
           status == SE3D_ERR_CALLBACK;
}

/* Steps ahead until the end, or until there were enough. */
static se3d_status try_steps(trial *t)
{
    se3di_integration *integration = t->integration;
    const se3di_model *model = integration->equations->assembly.model;
    for (int k = 0; k < TRIALS_MAX && model->time < t->t_end; ++k) {
        const double spin = largest_spin(model);
        const double most = t->h * spin > TURN_MOST ? TURN_MOST / spin : t->h;
        const double next = se3di_equal_steps_next(integration, most, t->t_end);
        const double h = se3di_pulse_step(&integration->equations->assembly, model->time, next);
        const double longest = t->h, jerk[3] = {t->jerk[0], t->jerk[1], t->jerk[2]};
        if (!(model->time + h > model->time)) {
            return SE3D_OK;
        }
        const se3d_status status = try_step(t, h);
        if (ends_trials(status) || integration->at_kink) { /* verlet goes no further */
            return status;
        }
        if (integration->is_paced) { /* by contacts or stops, in which accelerations jump */
            memcpy(t->jerk, jerk, sizeof jerk);
            t->h = status < 0 ? t->h : longest;
        }
        if (status < 0 && !(h > SHORTEST * (t->t_end - t->begin))) {
            return SE3D_OK;
        }
    }
    return SE3D_OK;
}

/* With the model's state kept. */
static se3d_status choose(trial *t)
{
    se3di_aside quiet;
    se3di_aside_begin(&quiet, t->integration->equations);
    return se3di_aside_end(&quiet, try_steps(t));
}

/* The longest step that has no larger error than it may have, relative to the largest speeds. */
static double wanted_step(const trial *t)
{
    const double motion = fmax(t->jerk[0] / t->speed[0], t->jerk[1] / t->speed[1]);
    const double rate = fmax(motion, t->jerk[2]); /* squared */
    return sqrt(12.0 * most_of(t->integration) / fmax(rate, 1e-300));
}

/* What the trials say, as a round number. */
static double conclude(const trial *t, int came_to_end)
{
    const se3di_integration *integration = t->integration;
    const double span = t->t_end - t->begin, stable = integration->settings.step_most;
    double longest = came_to_end ? fmax(STEP_LONG, SPAN_PART * span) : STEP_LONG;
    longest = fmin(longest, stable);
    longest = t->most_spin * longest > TURN_MOST ? TURN_MOST / t->most_spin : longest;
    return round_down(fmax(fmin(wanted_step(t), longest), SHORTEST * span));
}

/* The steps begin behind a kink; nothing is known of them before it was passed. */
static int is_at_kink(se3di_integration *integration)
{
    const double t = integration->equations->assembly.model->time;
    double end = t;
    (void)se3di_kink_step(integration, t, STEP_LONG, STEP_LONG * SHORTEST, &end);
    const int is_there = integration->at_kink;
    integration->at_kink = 0;
    return is_there;
}

se3d_status se3di_equal_steps_choose(se3di_integration *integration, double t_end)
{
    se3di_equations *equations = integration->equations;
    se3di_model *model = equations->assembly.model;
    if (!se3di_equal_steps_are_chosen(integration) || model->history[SE3DI_EQUAL_STEP] > 0.0 ||
        is_at_kink(integration)) {
        return SE3D_OK;
    }
    if (se3di_saved_fill(&integration->before_trials, model, &model->allocator) < 0) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_MEMORY, "no memory to choose a step");
    }
    trial t = {.integration = integration,
               .begin = model->time,
               .t_end = t_end,
               .h = fmin(STEP_LONG, integration->settings.step_most),
               .speed = {1e-12, 1e-12}};
    integration->foresees = 1;
    const se3d_status status = choose(&t);
    integration->at_kink = 0;
    const int came_to_end = !(model->time < t_end);
    const se3d_status room = se3di_saved_reserve(&integration->before_trials, model);
    if (room >= 0) {
        se3di_saved_restore(&integration->before_trials, model);
    }
    SE3DI_TRY(status);
    SE3DI_TRY(room);
    se3di_user_begin(model);
    model->history[SE3DI_EQUAL_STEP] = model->history[SE3DI_EQUAL_FIRST] =
        conclude(&t, came_to_end);
    model->history[SE3DI_EQUAL_SPEED] = t.speed[0];
    model->history[SE3DI_EQUAL_SPIN] = t.speed[1];
    return SE3D_OK;
}

/* Twice the step from here on, at most the first one. */
static void lengthen(se3di_integration *integration)
{
    double *header = integration->equations->assembly.model->history;
    header[SE3DI_EQUAL_OVER] = 0.0;
    header[SE3DI_EQUAL_STEP] = integration->settings.step_most =
        fmin(2.0 * header[SE3DI_EQUAL_STEP], header[SE3DI_EQUAL_FIRST]);
}

/* Half the step from here on, if it is not very short already. */
static void shorten(se3di_integration *integration, double part)
{
    const se3di_model *model = integration->equations->assembly.model;
    double *header = model->history;
    const double before = header[SE3DI_EQUAL_STEP];
    header[SE3DI_EQUAL_OVER] = 0.0;
    if (before > PART_LEAST * header[SE3DI_EQUAL_FIRST]) {
        header[SE3DI_EQUAL_STEP] = integration->settings.step_most = 0.5 * before;
    }
    const double told = header[SE3DI_EQUAL_FIRST] / before * part;
    if (told < 10.0 * header[SE3DI_EQUAL_TOLD]) {
        return;
    }
    header[SE3DI_EQUAL_TOLD] = told;
    se3di_log_write(integration->equations->error, SE3D_LOG_WARNING, SE3D_LOG_STEP,
                    "t = %g s: the step of %.3g s that %s chose at its start is too long here: the "
                    "error of a step is %.2g, the tolerance %g; steps of %.3g s follow",
                    model->time, before, integration->method->name,
                    part * tolerance_of(integration), tolerance_of(integration),
                    header[SE3DI_EQUAL_STEP]);
}

/* How many steps that are MUCH too long a motion of so much phase is: of frequency w, in equal
 * steps of h, it has the error (w h)^2/12. Singular positions are passed in less. */
static double steps_of_phase(const se3di_integration *integration, double phase)
{
    return fmax(3.0, phase / sqrt(12.0 * MUCH * most_of(integration)));
}

/* Steps of late that were too long, or, below zero, that could have been of twice the length if
 * they were shortened before. */
static double count_step(const se3di_integration *integration, const double *header, double part)
{
    const double over = header[SE3DI_EQUAL_OVER];
    const double of_twice = integration->settings.order == 4 ? 16.0 : 4.0;
    const int can_grow = header[SE3DI_EQUAL_STEP] < header[SE3DI_EQUAL_FIRST];
    if (part > MUCH && !integration->is_paced) {
        return fmax(0.0, over) + 1.0;
    }
    if (over > 0.0) {
        return fmax(0.0, over - 1.0);
    }
    return can_grow && of_twice * part <= 1.0 ? over - 1.0 : 0.0;
}

void se3di_equal_steps_watch(se3di_integration *integration, double h)
{
    se3di_equations *equations = integration->equations;
    double *header = equations->assembly.model->history;
    if (!se3di_equal_steps_are_chosen(integration) || !(header[SE3DI_EQUAL_STEP] > 0.0)) {
        return;
    }
    double speed[2] = {header[SE3DI_EQUAL_SPEED], header[SE3DI_EQUAL_SPIN]}, jerk[3];
    const double e2 = measure(equations, h, speed, jerk);
    header[SE3DI_EQUAL_SPEED] = speed[0];
    header[SE3DI_EQUAL_SPIN] = speed[1];
    const double part = error_of(integration, e2);
    header[SE3DI_EQUAL_OVER] = count_step(integration, header, part);
    if (header[SE3DI_EQUAL_OVER] >= steps_of_phase(integration, PHASE)) {
        shorten(integration, part);
    } else if (-header[SE3DI_EQUAL_OVER] >= steps_of_phase(integration, CALM)) {
        lengthen(integration);
    }
}

double se3di_equal_steps_review(const se3di_integration *integration, double h, double *most)
{
    const se3di_equations *equations = integration->equations;
    const double *header = equations->assembly.model->history;
    double speed[2] = {header[SE3DI_EQUAL_SPEED], header[SE3DI_EQUAL_SPIN]}, jerk[3];
    *most = HUGE_VAL;
    if (!se3di_equal_steps_are_chosen(integration) || !(header[SE3DI_EQUAL_STEP] > 0.0)) {
        return 0.0;
    }
    if (friction_changed(equations)) {
        *most = 1.0;
    } else if (!integration->is_paced) {
        *most = JUMPS;
    }
    return 12.0 * measure(equations, h, speed, jerk) / tolerance_of(integration);
}
