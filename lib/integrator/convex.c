/* SPDX-License-Identifier: BSD-3-Clause */
/* convex: for many contacts of bodies at steps of milliseconds. The velocities at the end of a
 * step are the optimum of a convex problem (convex.h). What nothing touches, each machine by
 * itself, is of order 2: loads and constraints act in the middle of the step,
 *
 *     q_m = q_0 + h/2 v_0,    v_1 = v_0 + h a(q_m),    q_1 = q_m + h/2 v_1
 *
 * Else they act at its start, contacts at its end, and bodies move by v_1. Then positions and
 * velocities are projected onto their constraints.
 *                                                                      docs/theory/convex.md */
#include "integrator/convex.h"

#include "assembly/armature.h"
#include "assembly/energy.h"
#include "assembly/loads.h"
#include "assembly/user.h"
#include "contact/bodies/pace.h"
#include "force/force.h"
#include "force/friction.h"
#include "integrator/kink_step.h"
#include "integrator/state.h"
#include "integrator/turns.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/steps.h"
#include "math/vec3.h"
#include "particles/sets.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define VECTORS       8 /* of unknowns */
#define ROW_VECTORS   3
#define TURN_MAX      3.0   /* rad, of a body in a step */
#define PROJECTED     1e-15 /* of lengths: what is left across the constraints */
#define HALVINGS      8     /* of a step in which shapes meet too fast, */
#define GAIN_HALVINGS 3     /* or which gives energy */

static size_t work_count(const se3di_assembly *assembly)
{
    (void)assembly;
    return 1;
}

static void share_work(se3di_convex *c, const se3di_assembly *assembly)
{
    double **vectors[VECTORS] = {&c->start,    &c->aim,   &c->v,       &c->change,
                                 &c->gradient, &c->moved, &c->carried, &c->chord};
    double *next = c->work;
    for (int k = 0; k < VECTORS; ++k) {
        *vectors[k] = next;
        next += assembly->unknown_count;
    }
    c->lambda = next;
    c->aimed = next + assembly->row_count;
    c->recoil = c->aimed + assembly->row_count;
    c->push = c->recoil + assembly->row_count;
}

/* The room of a step, which lasts as long as the run is prepared. */
static se3d_status open_room(se3di_integration *integration)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    if (!integration->convex) {
        integration->convex = se3di_alloc(allocator, 1, sizeof *integration->convex);
    }
    se3di_convex *c = integration->convex;
    if (!c) {
        return SE3D_ERR_NO_MEMORY;
    }
    void *work = c->work, *touched = c->touched;
    const size_t count = /* there is memory, also where nothing is free */
        1 + VECTORS * (size_t)assembly->unknown_count + ROW_VECTORS * (size_t)assembly->row_count +
        6 * (size_t)assembly->dense_count;
    se3d_status status =
        se3di_array_reserve(allocator, &work, &c->work_capacity, count, sizeof(double));
    c->work = work;
    SE3DI_TRY(status);
    status = se3di_array_reserve(allocator, &touched, &c->touched_capacity,
                                 assembly->body_count + 1, sizeof *c->touched);
    c->touched = touched;
    SE3DI_TRY(status);
    if (c->work) {
        share_work(c, assembly);
    }
    c->sleeps = integration->settings.sleeps;
    c->controls = integration->settings.controls_error && !(integration->settings.step > 0.0);
    return se3di_convex_bed(c, assembly);
}

static se3d_status open_convex(se3di_integration *integration)
{
    se3di_equations *equations = integration->equations;
    const se3di_model *model = equations->assembly.model;
    const char *what = model->sets                                ? "particles beside bodies"
                       : model->contact.law == SE3DI_LAW_CALLBACK ? "user-defined laws of contact"
                                                                  : NULL;
    if (what) {
        return se3di_error_set(equations->error, SE3D_ERR_UNSUPPORTED,
                               "method convex does not know %s; try verlet, or auto", what);
    }
    return open_room(integration) < 0
               ? se3di_error_set(equations->error, SE3D_ERR_NO_MEMORY, "no memory for a step")
               : SE3D_OK;
}

/* The velocities at the start. */
static void begin(const se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        double *v0 = c->start + 6 * (size_t)k;
        se3di_copy(frame->v, v0);
        se3di_copy(frame->w, v0 + 3);
        if (c->asleep[k]) {
            memset(v0, 0, 6 * sizeof *v0);
        }
    }
}

/* The chord that ended in a step had a part across the constraints, as the one that begins has:
 * both together are along them. */
static void recall_chords(const se3di_convex *c, const se3di_assembly *assembly)
{
    const double *history = assembly->model->history;
    const double *chord = history + 1 + assembly->body_count;
    const int goes_on = assembly->row_count > 0 && history[0] > 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        c->chord[k] = goes_on && !c->drifts[k / 6] ? c->h / history[0] * chord[k] : 0.0;
    }
}

/* What loads make of the velocities of what drifts, or of all else, as they are at the time t. */
static se3d_status aim(se3di_convex *c, se3di_equations *equations, int drifts, double t)
{
    se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    double *terms = c->change;
    SE3DI_TRY(se3di_assembly_eval_elements(assembly, t, equations->error));
    if (!drifts) {
        SE3DI_TRY(se3di_gravity_eval(model, t, c->gravity, NULL));
    }
    memset(terms, 0, assembly->unknown_count * sizeof *terms);
    se3di_armatures_add_terms(assembly, terms);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        const double *v0 = c->start + 6 * (size_t)k;
        double *v = c->aim + 6 * (size_t)k, *load = terms + 6 * (size_t)k, J[9];
        if (c->drifts[k] != drifts) {
            continue;
        }
        memcpy(v, v0, 6 * sizeof *v);
        if (c->asleep[k]) {
            continue;
        }
        se3di_add(load, assembly->wrench + 6 * (size_t)body, load);
        se3di_add(load + 3, assembly->wrench + 6 * (size_t)body + 3, load + 3);
        se3di_add_scaled(c->h / model->bodies[body].mass, load, v);
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_convex_turn_freely(J, v0 + 3, load + 3, c->h, v + 3);
    }
    return SE3D_OK;
}

/* C, and what C v is to be at the end of the step, of what drifts or of all else. If nothing
 * touches C is that in the middle, where the mean of v at both ends has the rates that are
 * prescribed. Else it is that at the start, and v is the chord to the end, which is the rate in
 * the middle: f_t + h/2 gamma. */
static se3d_status aim_rows(se3di_convex *c, se3di_equations *equations, int drifts, double t)
{
    se3di_assembly *assembly = &equations->assembly;
    if (!c->is_bound) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_rows(assembly, c->lambda);
    if (drifts) {
        se3di_assembly_mul(assembly, c->start, c->lambda);
    }
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const int32_t body = se3di_convex_joined(assembly, j);
        const uint32_t first = assembly->model->constraints[j].row_begin;
        for (uint32_t k = first; body >= 0 && c->drifts[body] == drifts &&
                                 k < first + (uint32_t)assembly->joint_rows[j];
             ++k) {
            const double rate = assembly->f[3 * (size_t)k + 1];
            c->aimed[k] = drifts ? 2.0 * rate - c->lambda[k] : rate + 0.5 * c->h * c->lambda[k];
        }
    }
    return SE3D_OK;
}

/* A body by `share` of a step with velocity v, which it has then. */
static void move_body(const se3di_convex *c, se3di_frame *frame, const double *v, double share)
{
    double turn[3], p[4];
    se3di_add_scaled(share * c->h, v, frame->r);
    se3di_scale(share * c->h, v + 3, turn);
    memcpy(p, frame->p, sizeof p);
    se3di_quat_rotate(p, turn, frame->p);
    se3di_quat_normalize(frame->p, frame->p);
    se3di_copy(v, frame->v);
    se3di_copy(v + 3, frame->w);
    se3di_frame_update(frame);
    se3di_quat_rate(frame->p, frame->w, frame->pdot);
}

/* What nothing touches to where loads and constraints act in the middle of the step, with the
 * velocities that are to be expected there. */
static void drift(const se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        se3di_frame *frame = &assembly->model->frames[body];
        const double *a = assembly->model->acceleration + 6 * (size_t)body;
        if (!c->drifts[k]) {
            continue;
        }
        move_body(c, frame, c->start + 6 * (size_t)k, 0.5);
        se3di_add_scaled(0.5 * c->h, a, frame->v);
        se3di_add_scaled(0.5 * c->h, a + 3, frame->w);
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
}

/* What a row presses with along its rate in `aimed`, which is done with. */
static double take_work(const se3di_convex *c, uint32_t row)
{
    const double work = c->lambda[row] * c->aimed[row];
    c->aimed[row] = 0.0;
    return work;
}

/* What drives the mechanism does in the step [J]: what rows that change in time press with, along
 * the mean of their rates at both ends, as impulses of contacts do; with them what took the chord
 * before from across the constraints, which is no power of rows that do not change. Those rates are
 * in `aimed` after it, the mean of the velocities in `change`. */
static double drive(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    double *mean = c->change, *rate = c->aimed, sum = 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        mean[k] = 0.5 * (c->start[k] + c->chord[k] + c->v[k]);
    }
    if (assembly->timed_count > 0) {
        se3di_assembly_mul_mass(assembly, c->chord, c->moved);
        for (size_t k = 0; k < assembly->unknown_count; ++k) {
            sum -= c->moved[k] * mean[k];
        }
    }
    se3di_assembly_mul(assembly, mean, rate);
    for (uint32_t k = 0; k < assembly->timed_count; ++k) {
        sum -= take_work(c, assembly->timed_rows[k]);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *user = &model->constraints[k];
        if (se3di_is_user(user) && !se3di_is_broken(user, model->rows)) {
            for (uint32_t row = user->row_begin; row < user->row_begin + user->row_count; ++row) {
                sum -= take_work(c, row);
            }
        }
    }
    return sum;
}

/* The bodies to the end of the step. */
static void move(const se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        if (!c->asleep[k]) {
            move_body(c, frame, c->v + 6 * (size_t)k, c->drifts[k] ? 0.5 : 1.0);
        }
    }
}

/* Onto the constraints, as near as rounding of the places of bodies lets them. */
static se3d_status project(se3di_equations *equations, double t1)
{
    const se3di_model *model = equations->assembly.model;
    se3di_state_scale scale = {.length = se3di_state_length(model), .speed = 1e-12, .spin = 1e-12};
    double far = scale.length;
    for (uint32_t k = 0; k < equations->assembly.body_count; ++k) {
        const se3di_frame *frame = &model->frames[equations->assembly.free_body[k]];
        if (se3di_state_is_carrier(&equations->assembly, k)) {
            continue;
        }
        scale.speed = fmax(scale.speed, se3di_norm(frame->v));
        scale.spin = fmax(scale.spin, se3di_norm(frame->w));
        far = fmax(far, se3di_norm(frame->r));
    }
    return se3di_state_project(equations, t1, &scale, PROJECTED * far / scale.length, 0);
}

/* What is across the constraints in the chord of a step. */
static void keep_chords(const se3di_convex *c, const se3di_assembly *assembly)
{
    double *chord = assembly->model->history + 1 + assembly->body_count;
    for (uint32_t k = 0; k < assembly->body_count; ++k, chord += 6) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        const double *v = c->v + 6 * (size_t)k;
        if (c->drifts[k] || !c->linked[k]) {
            memset(chord, 0, 6 * sizeof *chord);
        } else {
            se3di_sub(v, frame->v, chord);
            se3di_sub(v + 3, frame->w, chord + 3);
        }
    }
}

/* What the impulses of contacts from `first` on pressed with in the step, on the average. */
static void push_by_rows(const se3di_convex *c, const se3di_assembly *assembly, size_t first)
{
    double *by_place = c->change;
    memset(by_place, 0, assembly->unknown_count * sizeof *by_place);
    for (size_t k = first; k < c->contact_count; ++k) {
        se3di_convex_press(&c->contacts[k], 1.0 / c->h, c->contacts[k].impulse, by_place);
    }
    for (size_t k = 0; k < assembly->body_count; ++k) {
        double *push = c->push + 6 * (size_t)assembly->free_body[k];
        const double *own = by_place + 6 * (size_t)c->place[k];
        for (int e = 0; e < 6; ++e) {
            push[e] += own[e];
        }
    }
}

/* What the impulses pressed with in the step, where they did, less what the contacts at its end do:
 * a point that has moved on would turn a shaft that nothing turned. */
static void find_push(const se3di_convex *c, const se3di_assembly *assembly, double t1)
{
    const se3di_model *model = assembly->model;
    const size_t count = 6 * (size_t)assembly->dense_count;
    memset(c->push, 0, count * sizeof *c->push);
    if (model->contacts.count > 0) { /* else all pairs would be looked at once more */
        se3di_contacts_add_wrenches(model, t1, c->push, NULL);
    }
    for (size_t k = 0; k < count; ++k) {
        c->push[k] = 0.0 - c->push[k];
    }
    for (size_t k = 0; k < c->shape_count; ++k) {
        const se3di_convex_contact *contact = &c->contacts[k];
        for (int e = 0; e < 2; ++e) {
            if (contact->free[e] >= 0) {
                const uint32_t body = assembly->free_body[c->body_at[contact->free[e]]];
                se3di_contact_push(&model->frames[body], contact->arm[e], (e ? 1.0 : -1.0) / c->h,
                                   contact->impulse, c->push + 6 * (size_t)body);
            }
        }
    }
}

/* Accelerations and multipliers on the constraints. */
static se3d_status accelerate_bound(const se3di_convex *c, se3di_equations *equations, double t1)
{
    se3di_model *model = equations->assembly.model;
    const se3d_status status = se3di_acceleration_solve(equations, t1);
    equations->assembly.push = NULL;
    se3di_convex_stay(c, equations);
    se3di_frictions_take_loads(model, model->lambda);
    return status;
}

/* Without constraints each body has its own equations; what sleeps has none. */
static se3d_status accelerate(const se3di_convex *c, se3di_equations *equations, double t1)
{
    se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    if (assembly->row_count > 0) {
        find_push(c, assembly, t1);
        if (c->shape_count < c->contact_count) {
            push_by_rows(c, assembly, c->shape_count);
        }
        assembly->push = c->push;
        if (c->is_bound) {
            return accelerate_bound(c, equations, t1);
        }
    } else if (c->roll_end < c->contact_count) {
        memset(c->push, 0, 6 * (size_t)assembly->dense_count * sizeof *c->push);
        push_by_rows(c, assembly, c->roll_end);
        assembly->push = c->push;
    }
    const se3d_status status = se3di_assembly_eval_wrenches(assembly, t1, equations->error);
    assembly->push = NULL;
    SE3DI_TRY(status);
    ++equations->counters.evaluations;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t at = assembly->free_body[k];
        const double *w = model->frames[at].w, *wrench = assembly->wrench + 6 * (size_t)at;
        double *a = model->acceleration + 6 * (size_t)at, J[9], L[3], gyro[3], torque[3];
        if (c->asleep[k]) {
            continue;
        }
        se3di_inertia_matrix(model->bodies[at].J, J);
        se3di_mul(J, w, L);
        se3di_cross(w, L, gyro);
        se3di_sub(wrench + 3, gyro, torque);
        se3di_scale(1.0 / model->bodies[at].mass, wrench, a);
        se3di_solve3(J, torque, a + 3);
    }
    return SE3D_OK;
}

/* What the step has become, at t1. */
static se3d_status conclude(se3di_convex *c, se3di_equations *equations, double t1)
{
    se3di_model *model = equations->assembly.model;
    const double taken = se3di_convex_work(c, &equations->assembly);
    se3di_contacts_begin(model, 0.0, 1.0, 0);
    model->contacts.frozen = c->asleep_count > 0 ? c->frozen : NULL;
    se3di_convex_follow(c, model);
    model->contacts.followed = c->followed;
    model->contacts.followed_count = c->followed_count;
    se3d_status status = se3di_state_prepare(equations, t1);
    model->contacts.followed = NULL;
    model->contacts.followed_count = 0;
    if (status >= 0) {
        se3di_convex_record(c, model);
        status = se3di_convex_store(c, &equations->assembly, taken, equations->error);
    }
    model->contacts.frozen = NULL;
    SE3DI_TRY(status);
    model->time = t1;
    se3di_angles_accept(model);
    se3di_convex_accept_friction(c, &equations->assembly);
    se3di_loads_accept(model);
    model->contacts.frozen = c->asleep_count > 0 ? c->frozen : NULL;
    const se3d_status accelerated = accelerate(c, equations, t1);
    model->contacts.frozen = NULL;
    SE3DI_TRY(accelerated);
    SE3DI_TRY(se3di_user_report(model, equations->error));
    model->work[0] +=
        taken + se3di_convex_stopped(c, model) + se3di_convex_rubbed(c, &equations->assembly);
    model->work[1] += se3di_convex_fed(c);
    const double driven = model->work_valid > 0 ? model->work[2] + c->driven : 0.0;
    SE3DI_TRY(se3di_work_accept(model, c->h));
    model->work[2] = driven;
    model->history[0] = c->h;
    se3di_convex_doze(c, &equations->assembly);
    return SE3D_OK;
}

/* Everything sleeps. */
static void wait(const se3di_convex *c, se3di_model *model, double t1)
{
    model->time = model->contacts.time = t1;
    model->history[0] = c->h;
}

/* Velocities without contacts and constraints, and constraints: those of what touches at the start,
 * then those of all else half a step on. */
static se3d_status aim_all(se3di_convex *c, se3di_equations *equations, double t1)
{
    const se3di_assembly *assembly = &equations->assembly;
    const double t0 = assembly->model->time;
    if (c->drifting < assembly->body_count || assembly->body_count == 0) {
        SE3DI_TRY(aim(c, equations, 0, t0));
        SE3DI_TRY(aim_rows(c, equations, 0, t0));
    }
    if (c->drifting > 0) {
        const double t = 0.5 * (t0 + t1);
        drift(c, assembly);
        SE3DI_TRY(aim(c, equations, 1, t));
        SE3DI_TRY(aim_rows(c, equations, 1, t));
    }
    return SE3D_OK;
}

static se3d_status try_step(se3di_convex *c, se3di_equations *equations, double t1)
{
    const se3di_assembly *assembly = &equations->assembly;
    c->model = assembly->model;
    SE3DI_TRY(se3di_convex_find_drifting(c, assembly, equations->error));
    begin(c, assembly);
    recall_chords(c, assembly);
    c->gripped = se3di_convex_grip_energy(c, assembly);
    SE3DI_TRY(aim_all(c, equations, t1));
    SE3DI_TRY(se3di_convex_collect(c, assembly, equations->error));
    SE3DI_TRY(se3di_convex_collect_rolling(c, assembly, equations->error));
    c->roll_end = c->contact_count;
    SE3DI_TRY(se3di_convex_collect_stops(c, assembly, equations->error));
    c->stop_end = c->contact_count;
    SE3DI_TRY(se3di_convex_collect_friction(c, assembly, equations->error));
    se3di_convex_hold(c, assembly->model);
    SE3DI_TRY(se3di_convex_solve(c, equations));
    c->driven = c->is_bound ? drive(c, assembly) : 0.0;
    move(c, assembly);
    SE3DI_TRY(c->is_bound ? project(equations, t1) : SE3D_OK);
    se3di_convex_stay(c, equations);
    if (c->may_part && se3di_convex_gains(c, assembly)) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: a step of %g s gives energy", assembly->model->time,
                               c->h);
    }
    keep_chords(c, assembly);
    return conclude(c, equations, t1);
}

static se3d_status advance(se3di_integration *integration, double t1)
{
    se3di_equations *equations = integration->equations;
    se3di_convex *c = integration->convex;
    c->h = t1 - equations->assembly.model->time;
    se3di_convex_wake(c, &equations->assembly);
    if (se3di_convex_rests(c, &equations->assembly)) {
        c->contact_count = 0;
        wait(c, equations->assembly.model, t1);
        ++equations->counters.steps;
        return SE3D_OK;
    }
    se3d_status status = se3di_equations_keep(equations);
    equations->assembly.model->steps_apart = 1;
    status = status < 0 ? status : try_step(c, equations, t1);
    equations->assembly.model->steps_apart = 0;
    if (status < 0) {
        se3di_equations_come_back(equations);
        return status;
    }
    ++equations->counters.steps;
    return SE3D_OK;
}

/* Whether anything may move so fast that a look at all pairs is due. */
static int is_fast(const se3di_model *model, double h)
{
    double fastest = 0.0, smallest = HUGE_VAL;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        const se3di_frame *frame = &model->frames[shape->body];
        const double reach = shape->bound + se3di_norm(shape->x);
        const double turning = reach < HUGE_VAL ? reach * se3di_norm(frame->w) : 0.0;
        fastest = fmax(fastest, se3di_norm(frame->v) + turning);
        smallest = fmin(smallest, se3di_shape_contact_size(shape));
    }
    return 2.0 * fastest * h > smallest;
}

static se3d_status check_step(se3di_integration *integration, double h)
{
    const se3di_equations *equations = integration->equations;
    const se3di_model *model = equations->assembly.model;
    SE3DI_TRY(se3di_turns_check(equations, h, TURN_MAX));
    return is_fast(model, h)
               ? se3di_shapes_check_step(model, SE3DI_PACE_IMPLICIT, h, equations->error)
               : SE3D_OK;
}

static se3d_status take_step(se3di_integration *integration, double t1)
{
    se3di_equations *equations = integration->equations;
    const double t0 = equations->assembly.model->time;
    SE3DI_TRY(se3di_equations_try_step(equations, t0));
    SE3DI_TRY(check_step(integration, t1 - t0));
    SE3DI_TRY(se3di_watch_begin(equations));
    SE3DI_TRY(advance(integration, t1));
    return se3di_watch_end(equations);
}

/* What meets too fast for a step, and would overlap too much or pass through, meets in its halves,
 * and so does what jams so that no velocities are found, or whips on its joints. */
static se3d_status take_in_parts(se3di_integration *integration, double t1, int halvings)
{
    const se3di_model *model = integration->equations->assembly.model;
    const double t0 = model->time, h = t1 - t0, middle = 0.5 * (t0 + t1);
    integration->convex->may_part = halvings > HALVINGS - GAIN_HALVINGS;
    const se3d_status status = take_step(integration, t1);
    const int may_halve = (status == SE3D_ERR_STEP_SIZE || status == SE3D_ERR_NO_CONVERGENCE) &&
                          !(model->time > t0); /* it may be an event that was not found */
    if (!may_halve || halvings == 0 || !(middle > t0 && middle < t1)) {
        return status;
    }
    SE3DI_TRY(se3di_turns_check(integration->equations, h, TURN_MAX)); /* these are refused */
    const se3d_status first = take_in_parts(integration, middle, halvings - 1);
    return first == SE3D_OK ? take_in_parts(integration, t1, halvings - 1) : first;
}

/* Equal steps of at most `most`. */
static se3d_status run_steps(se3di_integration *integration, double t_end, double most)
{
    const se3di_model *model = integration->equations->assembly.model;
    se3d_status status = open_convex(integration);
    while (model->time < t_end && status >= 0 && status != SE3D_INFO_EVENT) {
        const double rest = t_end - model->time;
        double h = rest / se3di_steps_count(rest, most, t_end);
        double t1 = rest > (1.0 + 1e-9) * h ? model->time + h : t_end;
        h = se3di_kink_step(integration, model->time, h, fmin(2.0 * h, rest), &t1);
        if (integration->at_kink) {
            break;
        }
        status = take_in_parts(integration, t1, HALVINGS);
    }
    return status;
}

static se3d_status take_whole(se3di_integration *integration, double t1)
{
    return take_in_parts(integration, t1, HALVINGS);
}

/* All are awake. */
static void rouse(se3di_integration *integration)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    memset(assembly->model->history + 1, 0, (size_t)assembly->body_count * sizeof(double));
}

/* What contacts, stops and friction do is counted by steps, not by powers. */
static se3d_status renew(se3di_integration *integration)
{
    se3di_model *model = integration->equations->assembly.model;
    double contacts[2];
    se3di_contacts_power(model, model->time, contacts);
    model->power[0] -= contacts[0] + se3di_convex_apart_power(model);
    model->power[1] -= contacts[1];
    rouse(integration);
    return SE3D_OK;
}

static se3d_status start(se3di_integration *integration, double h)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    double *kept = assembly->model->history;
    kept[0] = h;
    memset(kept + 1, 0, (se3di_convex_history_count(assembly) - 1) * sizeof *kept);
    SE3DI_TRY(open_convex(integration));
    return renew(integration);
}

static se3d_status step(se3di_integration *integration, double h)
{
    return run_steps(integration, integration->equations->assembly.model->time + h, h);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    const se3di_model *model = integration->equations->assembly.model;
    double h = integration->settings.step > 0.0 ? integration->settings.step
                                                : integration->settings.step_most;
    h = model->contact.step > 0.0 ? fmin(h, model->contact.step) : h;
    const double count = se3di_steps_count(t_end - model->time, h, t_end);
    if (count > SE3DI_STEPS_MOST) {
        return se3di_error_set(integration->equations->error, SE3D_ERR_STEP_COUNT,
                               "a step of %g s needs %g steps from t = %g s to %g s, must be at "
                               "most %g; try another step",
                               h, count, model->time, t_end, SE3DI_STEPS_MOST);
    }
    SE3DI_TRY(open_convex(integration));
    if (integration->convex->controls) {
        return se3di_convex_control(integration, take_whole, t_end, h);
    }
    return run_steps(integration, t_end, h);
}

const se3di_integrator se3di_integrator_convex = {
    .name = "convex",
    .tag = SE3D_METHOD_CONVEX,
    .history_count = se3di_convex_history_count,
    .work_count = work_count,
    .start = start,
    .renew = renew,
    .step = step,
    .run = run,
    .is_reduced = 1,
    .get_reach = se3di_convex_get_reach,
    .fixes_step = 1,
    .orders = 1u << 1,
    .moves_first = 1,
    .takes_crowd = 1,
};
