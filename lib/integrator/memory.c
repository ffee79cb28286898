/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/memory.h"

#include "assembly/energy.h"
#include "contact/bodies/body_contacts.h"
#include "force/friction.h"
#include "force/measure.h"
#include "force/stop.h"
#include "integrator/hold_review.h"
#include "math/inertia.h"
#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STANDING        1e-2  /* of the tolerance: slower is standing still */
#define ROUNDING        4e-15 /* of a coordinate, over the step, in the mean rate */
#define SPRING_ROUNDING 2e-15 /* of the place of a contact, in the stretch of its springs */
#define LANDING                                                                                    \
    0.5 /* of the tolerance: how far beyond the turn, or before the stop, a step is aimed */

static se3di_force *element_of(const se3di_equations *equations, uint32_t k)
{
    return &equations->assembly.model->forces[equations->friction.element[k]];
}

/* The rate along its direction at the part s of a step, of the parabola that has those of its ends
 * and the way between. */
typedef struct excursion {
    double begin, end, mean;
} excursion;

static double eval_excursion(const excursion *e, double s)
{
    return e->begin * (1.0 - s * (4.0 - 3.0 * s)) + e->end * s * (3.0 * s - 2.0) +
           6.0 * e->mean * s * (1.0 - s);
}

/* It has turned within the step, and turned again: it sticks there, or slips the other way. */
static void review_excursion(const excursion *e, double allowed, se3di_memory_end *end)
{
    const double bend = e->begin + e->end - 2.0 * e->mean;
    if (!(bend > 0.0)) {
        return;
    }
    const double place = (2.0 * e->begin + e->end - 3.0 * e->mean) / (3.0 * bend);
    if (!(place > 0.0) || !(place < 1.0)) {
        return;
    }
    const double against = -eval_excursion(e, place);
    double before = 0.0, after = place;
    if (!(against > allowed)) {
        return;
    }
    for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (before + after);
        if (eval_excursion(e, middle) > -LANDING * allowed) {
            before = middle;
        } else {
            after = middle;
        }
    }
    end->error = se3di_larger(end->error, against / allowed);
    end->fraction = end->fraction > 0.0 ? fmin(end->fraction, after) : after;
}

/* It slips against its direction: friction has driven since its motion turned within the step. */
static int review_slip(const se3di_force *force, const se3di_measure *measure,
                       const se3di_memory_step *step, se3di_memory_end *end)
{
    const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    const double allowed = step->tolerance * (turns ? step->scale->spin : step->scale->speed);
    const double mode = force->state[SE3DI_FRICTION_MODE], against = -mode * measure->rate;
    const double before = mode * force->state[SE3DI_FRICTION_RATE];
    if (!(against > 0.0)) {
        const double way = measure->value - force->state[SE3DI_FRICTION_ANCHOR];
        const double size = fabs(measure->value) + (turns ? 1.0 : step->scale->length);
        const excursion e = {before, -against, mode * way / step->h};
        const double blur = step->blur * (turns ? 1.0 : step->scale->length);
        review_excursion(&e, allowed + (ROUNDING * size + blur) / step->h, end);
        return 0;
    }
    end->error = se3di_larger(end->error, against / allowed);
    if (before > 0.0 && against > allowed) {
        const double fraction = (before + LANDING * allowed) / (before + against);
        end->fraction = end->fraction > 0.0 ? fmin(end->fraction, fraction) : fraction;
    }
    return 1;
}

/* So slow stands still. */
static double slowness_of(const se3di_force *force, const se3di_state_scale *scale,
                          double tolerance)
{
    const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    return STANDING * fmin(tolerance, 1e-6) * (turns ? scale->spin : scale->speed);
}

/* It sticks: whether it cannot, -1 if it has begun to move, as only what has no leverage does. */
static int32_t review_stick(const se3di_equations *equations, uint32_t k, double rate,
                            double slowness)
{
    const se3di_force *force = element_of(equations, k);
    if (equations->friction.is_rigid && fabs(rate) > slowness &&
        !se3di_friction_system_can_hold(equations, k)) {
        return -1;
    }
    int is_known;
    const int is_exceeded = se3di_hold_is_exceeded(equations, k, &is_known);
    return is_known ? is_exceeded
                    : fabs(se3di_friction_get(equations->assembly.model, force)) >
                          se3di_friction_limit(force, 0);
}

/* Which elements may have to change: friction.rests. *since: the part of the step before its end
 * for which that is so, at most. @return how many */
static uint32_t review(se3di_equations *equations, const se3di_memory_step *step,
                       se3di_memory_end *end, uint32_t *broken, double *since)
{
    const se3di_state_scale *scale = step->scale;
    const double tolerance = step->tolerance;
    const se3di_model *model = equations->assembly.model;
    uint32_t count = 0;
    *broken = 0;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        const se3di_force *force = element_of(equations, k);
        int32_t changes = 0;
        se3di_measure measure;
        (void)se3di_measure_force(model, force, 0, &measure);
        if (!se3di_friction_sticks(force)) {
            changes = review_slip(force, &measure, step, end);
        } else if (force->state[SE3DI_FRICTION_SET] > 0.0) {
            changes =
                review_stick(equations, k, measure.rate, slowness_of(force, scale, tolerance));
            *broken += changes != 0;
            *since = changes < 0 ? 1.0 : *since;
        }
        equations->friction.rests[k] = changes;
        count += changes != 0;
    }
    return count;
}

static int stands(const se3di_equations *equations, uint32_t k, const se3di_state_scale *scale,
                  double tolerance)
{
    const se3di_force *force = element_of(equations, k);
    se3di_measure measure;
    (void)se3di_measure_force(equations->assembly.model, force, 0, &measure);
    return fabs(measure.rate) <= slowness_of(force, scale, tolerance);
}

/* What has begun to move slips as it moves; the others are left to be decided. */
static void let_go(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        if (equations->friction.rests[k] < 0) {
            se3di_force *force = element_of(equations, k);
            se3di_measure measure;
            (void)se3di_measure_force(model, force, 0, &measure);
            const double mode = copysign(1.0, measure.rate);
            se3di_friction_set(model, force, mode, mode * se3di_friction_limit(force, 1));
            equations->friction.rests[k] = 0;
        }
    }
}

/* What is on the way back to its direction, as where it starts, has not turned; nor has what stands
 * and is not driven back. */
static uint32_t drop_returning(se3di_equations *equations, const se3di_state_scale *scale,
                               double tolerance)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        const double mode = element_of(equations, k)->state[SE3DI_FRICTION_MODE];
        if (!equations->friction.rests[k] || !(fabs(mode) > 0.0)) {
            ;
        } else if (mode * se3di_friction_system_acceleration(equations, k) > 0.0 ||
                   (stands(equations, k, scale, tolerance) &&
                    mode * se3di_friction_system_moves(equations, k) >= 0.0)) {
            equations->friction.rests[k] = 0;
        }
        count += (uint32_t)(equations->friction.rests[k] != 0);
    }
    return count;
}

/* If one element changes, all that stand still are decided with it: they hold each other. */
static void add_standing(se3di_equations *equations, const se3di_state_scale *scale,
                         double tolerance)
{
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        const se3di_force *force = element_of(equations, k);
        if (force->state[SE3DI_FRICTION_SET] > 0.0 &&
            (se3di_friction_sticks(force) || stands(equations, k, scale, tolerance))) {
            equations->friction.rests[k] = 1;
        }
    }
}

/* @return with the accelerations of the new modes */
static se3d_status change_modes(se3di_equations *equations, double t,
                                const se3di_state_scale *scale, double tolerance,
                                se3di_memory_end *end)
{
    if (drop_returning(equations, scale, tolerance) > 0) {
        let_go(equations);
        add_standing(equations, scale, tolerance);
        SE3DI_TRY(se3di_friction_system_decide(equations, t));
        SE3DI_TRY(se3di_state_evaluate(equations, t));
        end->has_changed = end->has_moved = 1;
    }
    se3di_assembly_set_acceleration(&equations->assembly, equations->x);
    if (equations->assembly.row_count > 0) {
        memcpy(equations->assembly.model->lambda, equations->l,
               equations->assembly.row_count * sizeof *equations->l);
    }
    return SE3D_OK;
}

double se3di_memory_review_stops(const se3di_model *model, double h, double tolerance,
                                 const se3di_state_scale *scale, double *fraction)
{
    double worst = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
        double part = 0.0;
        if (!se3di_stop_acts(force)) {
            continue;
        }
        const double gap = se3di_stop_review(model, force, h, &part);
        const double error = gap / (tolerance * (turns ? scale->spin : scale->speed));
        if (error > 1.0) {
            part *= 1.0 - LANDING / error;
            *fraction = *fraction > 0.0 ? fmin(*fraction, part) : part;
        }
        worst = se3di_larger(worst, error);
    }
    return worst;
}

int se3di_memory_meets_stop(const se3di_model *model)
{
    int meets = 0;
    for (size_t k = 0; k < model->force_slots.count && !meets; ++k) {
        const se3di_force *force = &model->forces[k];
        meets = se3di_stop_acts(force) && se3di_stop_changes(model, force);
    }
    return meets;
}

/* What the springs of contacts do, as they would be remembered, times a sign. */
typedef struct springs {
    double sign, h;
    double noise; /* what rounding makes of velocities in the step, relative to the scales */
    const se3di_state_scale *scale;
    double *wrench; /* [bodies * 6] */
    const se3di_assembly *assembly;
    const double *begin; /* the state that the step begins with */
} springs;

/* What a spring is off by makes vibrations of its own frequency: it acts for their time at most. By
 * how many times the step is longer. */
static double outlast(const springs *s, const se3di_encounter *e)
{
    return fmax(1.0, s->h * sqrt(se3di_pair_kt(&e->pair, e->s) * e->inverse_mass));
}

static void add_wrench(const springs *s, const se3di_encounter *e, double scale,
                       const double wrench[12])
{
    scale /= outlast(s, e);
    for (size_t k = 0; k < 12; ++k) {
        s->wrench[6 * (size_t)e->body[k / 6] + k % 6] += scale * wrench[k];
    }
}

/* Marks are known to the rounding of where they are. */
static void add_noise(springs *s, const se3di_encounter *e)
{
    const double arm = fmax(se3di_norm(e->arm[0]), se3di_norm(e->arm[1]));
    const double size = se3di_norm(e->at->point) + arm;
    const double force =
        SPRING_ROUNDING * size * e->pair.kt * se3di_pair_tangent(&e->pair, e->s) / outlast(s, e);
    const double least = fmin(s->scale->speed, arm * s->scale->spin);
    if (least > 0.0) {
        s->noise = fmax(s->noise, s->h * force * e->alone / least);
    }
}

/* The velocity of a body at the place of a contact where the step began. */
static void velocity_before(const springs *s, const se3di_encounter *e, int k, double v[3])
{
    const int32_t at = s->assembly->free_index[e->body[k]];
    double w[3];
    memset(v, 0, 3 * sizeof *v);
    if (at >= 0) {
        const double *rates = s->begin + SE3DI_STATE_SIZE * (size_t)at + 7;
        se3di_mul(s->assembly->model->frames[e->body[k]].A, rates + 3, w);
        se3di_cross(w, e->arm[k], v);
        se3di_add(v, rates, v);
    }
}

/* The contact's friction dissipated where the step began. */
static int dissipated(const springs *s, const se3di_encounter *e)
{
    double v[2][3];
    for (int k = 0; k < 2; ++k) {
        velocity_before(s, e, k, v[k]);
    }
    se3di_sub(v[1], v[0], v[1]);
    se3di_add(v[1], e->drift, v[1]);
    return se3di_dot(e->pull, v[1]) < 0.0;
}

/* A contact at its cap whose friction has begun to drive has turned within the step, and its spring
 * should have begun to unload there: after v/2 (time since then) of the way, at most v h/2. One
 * that drove already is at a cap that falls faster than the spring unloads. */
static void add_overshoot(const springs *s, const se3di_encounter *e)
{
    const double pull = se3di_norm(e->pull);
    if (!e->memory || !(e->give < 1.0) || !(se3di_dot(e->pull, e->vt) > 0.0) || !dissipated(s, e)) {
        return;
    }
    const double way = 0.5 * s->h * se3di_norm(e->vt);
    const double lost = fmin(se3di_pair_kt(&e->pair, e->s) * way, e->give * pull);
    se3di_encounter part = *e;
    double wrench[12];
    se3di_scale(lost / pull, e->pull, part.force);
    memset(part.moment, 0, sizeof part.moment);
    se3di_encounter_wrench(&part, wrench);
    add_wrench(s, e, 1.0, wrench);
}

/* As it would be remembered; of the step as a whole (sign 1) also what it overshoots by. */
static se3d_status add_spring(void *ctx, const se3di_encounter *e)
{
    springs *s = ctx;
    double wrench[12];
    se3di_encounter_spring(e, wrench);
    add_wrench(s, e, s->sign, wrench);
    add_noise(s, e);
    if (s->sign > 0.0) {
        add_overshoot(s, e);
    }
    return SE3D_OK;
}

/* What a change of the wrenches on the bodies does to their velocities in h, largest of all. */
static double effect_of(const se3di_model *model, const double *wrench, double h,
                        const se3di_state_scale *scale)
{
    double worst = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k, wrench += 6) {
        const se3di_body *body = &model->bodies[k];
        double J[9], turn[3];
        if (body->fixed || body->state != 0) {
            continue;
        }
        se3di_inertia_matrix(body->J, J);
        se3di_solve3(J, wrench + 3, turn);
        const double part =
            h * (se3di_norm(wrench) / (body->mass * scale->speed) + se3di_norm(turn) / scale->spin);
        worst = se3di_larger(worst, part);
    }
    return worst;
}

se3d_status se3di_memory_review_contacts(se3di_equations *equations, const se3di_memory_step *step,
                                         double within, double *error)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    double *wrench = assembly->wrench;
    const size_t count = 6 * model->body_slots.count;
    se3di_error ignored = {0};
    const se3d_status status = se3di_contacts_show(model, within, &ignored);
    se3di_equations_restore(equations);
    *error = HUGE_VAL;
    if (status == SE3D_ERR_STEP_SIZE) {
        return SE3D_OK;
    }
    if (status < 0) {
        return se3di_error_set(equations->error, status, "%s", ignored.message);
    }
    memset(wrench, 0, count * sizeof *wrench);
    springs s = {.sign = -1.0,
                 .h = step->h,
                 .scale = step->scale,
                 .wrench = wrench,
                 .assembly = assembly,
                 .begin = step->begin};
    (void)se3di_contacts_visit(model, step->t, add_spring, &s);
    se3di_contacts_hide(model);
    s.sign = 1.0;
    (void)se3di_contacts_visit(model, step->t, add_spring, &s);
    const double effect = effect_of(model, wrench, step->h, step->scale);
    *error = fmax(0.0, effect - s.noise) / step->tolerance;
    return SE3D_OK;
}

double se3di_memory_get_fraction(double error)
{
    return fmax(0.1, 0.9 / sqrt(error));
}

se3d_status se3di_memory_settle(se3di_equations *equations, const se3di_memory_step *step,
                                se3di_memory_end *end)
{
    const double t = step->t, h = step->h, tolerance = step->tolerance, *lambda = step->lambda;
    double since = 1.0;
    const se3di_state_scale *scale = step->scale;
    double *memory = step->memory, *work = step->work;
    se3di_model *model = equations->assembly.model;
    uint32_t broken = 0;
    *end = (se3di_memory_end){0};
    se3di_model_save_memory(model, memory);
    end->has_moved = se3di_friction_system_stand(equations);
    end->error = se3di_memory_review_stops(model, h, tolerance, scale, &end->fraction);
    equations->friction.has_end = 0;
    if (end->error <= 1.0) {
        const se3d_status status = se3di_hold_review(equations, step, end, &since);
        if (status < 0) {
            se3di_model_restore_memory(model, memory);
            return status;
        }
    }
    if (equations->friction.count > 0) {
        se3di_frictions_take_loads(model, lambda);
        if (equations->assembly.row_count > 0 && lambda != model->lambda) {
            memcpy(model->lambda, lambda, equations->assembly.row_count * sizeof *lambda);
        }
    }
    const uint32_t count = review(equations, step, end, &broken, &since);
    if (count > 0 && end->error <= 1.0) {
        se3d_status status = se3di_loads_power(model, t, end->power);
        status = status < 0 ? status : se3di_state_evaluate(equations, t);
        memcpy(work, equations->x, equations->assembly.unknown_count * sizeof *work);
        status = status < 0 ? status : change_modes(equations, t, scale, tolerance, end);
        if (status < 0) {
            memset(equations->friction.rests, 0,
                   equations->friction.count * sizeof *equations->friction.rests);
            se3di_model_restore_memory(model, memory);
            return status;
        }
        const double change =
            broken > 0 ? se3di_hold_change(equations, work, since * h, scale) / tolerance : 0.0;
        end->error = se3di_larger(end->error, change);
    } else if (count > 0) {
        memset(equations->friction.rests, 0,
               equations->friction.count * sizeof *equations->friction.rests);
    }
    se3di_forces_accept(model);
    for (size_t k = 0; k < model->force_slots.count; ++k) { /* modes had changed already */
        memcpy(model->forces[k].state + SE3DI_FORCE_BEFORE, memory + SE3DI_FORCE_STATES * k,
               SE3DI_FORCE_BEFORE * sizeof *memory);
    }
    return SE3D_OK;
}
