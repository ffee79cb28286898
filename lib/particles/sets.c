/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/sets.h"

#include "force/force.h"
#include "math/vec3.h"
#include "particles/bond.h"
#include "particles/cell.h"
#include "particles/flow.h"
#include "particles/kept.h"
#include "particles/passage.h"
#include "particles/servo.h"
#include "particles/share.h"
#include "particles/step.h"
#include "particles/sweep.h"
#include "particles/sync.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Beyond this many automatic steps a contact is not resolved and may gain energy. */
#define STEP_LIMIT_HOOKE 15.0
#define STEP_LIMIT_HERTZ 30.0

/* The set in a message: " of ", "sand". */
static const char *set_name(const se3di_particles *set, const char **of)
{
    *of = set->name ? " of " : "";
    return set->name ? set->name : "";
}

/* A step beyond stability fails with STEP_SIZE. */
static se3d_status check_step(const se3di_particles *set, const se3di_model *model, double h,
                              se3di_error *error)
{
    const char *of;
    const char *name = set_name(set, &of);
    double safe = se3di_particles_safe_step(set, model);
    double limit =
        safe * (set->law == SE3DI_LAW_HERTZ_MINDLIN ? STEP_LIMIT_HERTZ : STEP_LIMIT_HOOKE);
    const double bonds = se3di_bonds_step(set);
    if (h > SE3DI_BONDS_STABLE * bonds) {
        return se3di_error_set(error, SE3D_ERR_STEP_SIZE,
                               "step = %g s at time %g s is too large, the bonds%s%.80s need at "
                               "most %g s (automatic: %g s)",
                               h, set->time, of, name, SE3DI_BONDS_STABLE * bonds, bonds);
    }
    if (h > limit) {
        return se3di_error_set(error, SE3D_ERR_STEP_SIZE,
                               "step = %g s at time %g s is too large, the contacts%s%.80s need at "
                               "most %g s (automatic: %g s)",
                               h, set->time, of, name, limit, safe);
    }
    return SE3D_OK;
}

static const char *wall_name(const se3di_particles *set, uint32_t wall)
{
    const char *name = set->walls[wall].shape.name;
    return name ? name : "without a name";
}

static se3d_status report_overlap(const se3di_particles *set, se3di_error *error)
{
    const char *of;
    const char *name = set_name(set, &of);
    char with[112];
    if (set->failed_wall == SE3DI_NO_INDEX) {
        (void)snprintf(with, sizeof with, "particle %u", set->failed_with);
    } else {
        (void)snprintf(with, sizeof with, "the shape %.80s", wall_name(set, set->failed_wall));
    }
    return se3di_error_set(
        error, SE3D_ERR_STEP_SIZE,
        "particle %u%s%.80s and %s overlap by %g of the smaller radius at time %g s "
        "(overlap_limit: %g); %s",
        set->failed, of, name, with, set->failed_amount, set->failed_time, set->overlap_limit,
        set->failed_placed ? "they were placed with this overlap; move them apart"
                           : "try a stiffer material, a smaller step if one is given, or a larger "
                             "overlap_limit for grains that are soft");
}

/* Record why a step of particles failed; returns `status`. */
static se3d_status report(const se3di_particles *set, se3d_status status, se3di_error *error)
{
    const char *of;
    const char *name = set_name(set, &of);
    switch (status) {
    case SE3D_ERR_STEP_SIZE:
        return report_overlap(set, error);
    case SE3D_ERR_NOT_FINITE:
        return se3di_error_set(error, status,
                               "the state of particle %u%s%.80s is not finite at time %g s; try a "
                               "smaller step",
                               set->failed, of, name, set->time);
    case SE3D_ERR_CALLBACK:
        if (set->law_failure.wall) {
            return se3di_error_set(error, status,
                                   "the law of contact failed for particle %u%s%.80s and the shape "
                                   "%.80s at time %g s",
                                   set->law_failure.i, of, name, wall_name(set, set->law_failure.j),
                                   set->time);
        }
        return se3di_error_set(error, status,
                               "the law of contact failed for the particles %u and %u%s%.80s at "
                               "time %g s",
                               set->law_failure.i, set->law_failure.j, of, name, set->time);
    case SE3D_ERR_UNSUPPORTED:
        return se3di_error_set(error, status,
                               "the domain%s%.80s is shorter along a periodic axis than %g of the "
                               "largest radii, or has grown without end",
                               of, name, SE3DI_PERIOD_LEAST);
    default:
        return se3di_error_set(error, status, "no memory for contacts%s%.80s at time %g s", of,
                               name, set->time);
    }
}

/* A cell that strains holds spheres alone. */
static se3d_status check_cell(const se3di_particles *set, se3di_error *error)
{
    const char *of;
    const char *name = set_name(set, &of);
    const char *what = set->wall_count > 0    ? "touch shapes"
                       : set->clump_count > 0 ? "are clumps"
                       : set->flow_count > 0  ? "are counted by flows"
                                              : NULL;
    if (se3di_domain_strains(set) && what) {
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                               "the particles%s%.80s %s, but are in a cell that strains", of, name,
                               what);
    }
    return SE3D_OK;
}

static se3d_status check_audit(const se3di_particles *set, se3di_error *error)
{
    if (set->audits && set->law == SE3DI_LAW_CALLBACK) {
        const char *of;
        const char *name = set_name(set, &of);
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                               "the particles%s%.80s are audited, but a law of the user's own does "
                               "not tell what it stores",
                               of, name);
    }
    return SE3D_OK;
}

static se3d_status check_servos(const se3di_particles *set, se3di_error *error)
{
    for (size_t k = 0; k < set->servo_count; ++k) {
        if (set->law == SE3DI_LAW_CALLBACK && !(set->servos[k].gain > 0.0)) {
            const char *of;
            const char *name = set_name(set, &of);
            return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                   "servo wall %zu%s%.80s has no gain, and a law of the user's own "
                                   "does not tell the stiffness that would give one",
                                   k, of, name);
        }
    }
    return SE3D_OK;
}

/* What a set touches, where the model has it now. */
static se3d_status place_set(se3di_particles *set, const se3di_model *model, se3di_error *error)
{
    se3d_status status = se3di_particles_sync(set, model);
    if (status < 0) {
        return report(set, status, error);
    }
    SE3DI_TRY(check_cell(set, error));
    SE3DI_TRY(check_audit(set, error));
    SE3DI_TRY(check_servos(set, error));
    se3di_particles_move_walls(set, model->frames);
    se3di_particles_free_walls(set, NULL);
    return SE3D_OK;
}

/* A set that several processes share is spread over them. */
static se3d_status spread_set(se3di_particles *set, se3di_error *error)
{
    const char *why = NULL;
    const se3d_status status =
        set->share && !set->share->is_spread ? set->share->spread(set, &why) : SE3D_OK;
    if (status < 0 && why) {
        const char *of;
        const char *name = set_name(set, &of);
        return se3di_error_set(error, status, "particles%s%.80s that several processes share %s",
                               of, name, why);
    }
    return status < 0 ? report(set, status, error) : status;
}

/* Before a step of length h begins: what its sources give, how its servo walls press. */
static se3d_status aim_set(se3di_particles *set, const se3di_model *model, double h,
                           se3di_error *error)
{
    const char *what = "the rate of a source";
    se3d_status status = se3di_sources_aim(set, model, h);
    if (status >= 0) {
        what = "the load of a servo wall";
        status = se3di_servos_aim(set, model, h);
    }
    if (status < 0) {
        const char *of;
        const char *name = set_name(set, &of);
        return se3di_error_set(error, status, "%s%s%.80s cannot be computed at time %g s", what, of,
                               name, set->time + 0.5 * h);
    }
    return status;
}

double se3di_particles_want_step(const se3di_particles *set, const se3di_model *model)
{
    if (set->step > 0.0 || model->contact.step > 0.0) {
        return set->step > 0.0 ? set->step : model->contact.step;
    }
    double safe = fmin(se3di_particles_safe_step(set, model), se3di_bonds_step(set));
    return isfinite(safe) ? safe : 0.0;
}

/* What fails in one process fails in all. */
static se3d_status settle(se3di_particles *set, se3d_status status, se3di_error *error)
{
    if (!set->share) {
        return status;
    }
    return set->share->told < 0 ? set->share->told : set->share->settle(set, status, error);
}

static se3di_particles *first_shared(const se3di_model *model)
{
    se3di_particles *set = model->sets;
    while (set && !set->share) {
        set = set->next;
    }
    return set;
}

se3d_status se3di_sets_settle(const se3di_model *model, se3d_status status, se3di_error *error)
{
    se3di_particles *set = first_shared(model);
    return set ? settle(set, status, error) : status;
}

static void forget_told(se3di_particles *set)
{
    if (set->share) {
        set->share->told = SE3D_OK;
    }
}

/* Whichever set was told of a failure, none remembers it in the next call. */
se3d_status se3di_sets_conclude(const se3di_model *model, se3d_status status, se3di_error *error)
{
    status = se3di_sets_settle(model, status, error);
    for (se3di_particles *set = model->sets; set; set = set->next) {
        forget_told(set);
    }
    return status;
}

/* What a step begins with. */
static se3d_status begin_step(se3di_particles *set, const se3di_model *model, double h,
                              se3di_error *error)
{
    SE3DI_TRY(se3di_gravity_eval(model, set->time, set->gravity, NULL));
    return aim_set(set, model, h, error);
}

static se3d_status run_steps(se3di_particles *set, const se3di_model *model, double length,
                             size_t steps, se3di_error *error)
{
    const int varies =
        set->source_count > 0 || set->servo_count > 0 || se3di_model_gravity_varies(model);
    size_t done = 0;
    do {
        const size_t now = varies ? 1 : steps;
        SE3DI_TRY(settle(set, begin_step(set, model, length, error), error));
        const se3d_status status = se3di_particles_advance(set, length, now, NULL);
        if (status < 0) {
            return report(set, status, error);
        }
        done += now;
    } while (done < steps);
    return SE3D_OK;
}

se3d_status se3di_particles_run(se3di_particles *set, const se3di_model *model, double h,
                                double length, size_t steps, se3di_error *error)
{
    se3d_status status = check_step(set, model, h, error);
    status = status < 0 ? status : place_set(set, model, error);
    status = settle(set, status, error);
    status = status < 0 ? status : spread_set(set, error);
    status = status < 0 ? status : run_steps(set, model, length, steps, error);
    se3di_share_gather(set);
    status = settle(set, status, error);
    forget_told(set);
    return status;
}

static se3d_status place(se3di_particles *set, const se3di_model *model, double h,
                         se3di_error *error)
{
    SE3DI_TRY(check_step(set, model, h, error));
    SE3DI_TRY(se3di_gravity_eval(model, set->time, set->gravity, NULL));
    SE3DI_TRY(place_set(set, model, error));
    se3di_particles_free_walls(set, model);
    return SE3D_OK;
}

static se3d_status begin(se3di_particles *set, const se3di_model *model, double h,
                         se3di_error *error)
{
    set->time = model->time;
    if (se3di_particles_is_idle(set)) {
        return SE3D_OK;
    }
    SE3DI_TRY(settle(set, place(set, model, h, error), error));
    SE3DI_TRY(spread_set(set, error));
    se3d_status status = se3di_particles_prepare(set);
    return status < 0 ? report(set, status, error) : SE3D_OK;
}

void se3di_sets_end(se3di_model *model)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        se3di_share_gather(set);
    }
}

se3d_status se3di_sets_begin(se3di_model *model, double h, se3di_error *error)
{
    se3d_status status = SE3D_OK;
    for (se3di_particles *set = model->sets; set && status >= 0; set = set->next) {
        status = begin(set, model, h, error);
    }
    if (status < 0) {
        se3di_sets_end(model);
    }
    return status;
}

se3d_status se3di_sets_keep(se3di_model *model, se3di_error *error)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        if (se3di_particles_keep(set) < 0) {
            return se3di_error_set(error, SE3D_ERR_NO_MEMORY, "no memory for a step");
        }
    }
    return SE3D_OK;
}

void se3di_sets_come_back(se3di_model *model)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        se3di_particles_come_back(set);
    }
}

void se3di_sets_move(se3di_model *model, int kicks, double h)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        se3di_particles_move(set, kicks, h);
    }
}

se3d_status se3di_sets_aim(se3di_model *model, double h, se3di_error *error)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        SE3DI_TRY(aim_set(set, model, h, error));
    }
    return SE3D_OK;
}

se3d_status se3di_sets_forces(se3di_model *model, double t, double h, se3di_error *error,
                              se3d_status *late)
{
    *late = SE3D_OK;
    for (se3di_particles *set = model->sets; set; set = set->next) {
        set->time = t;
        ++set->steps;
        se3di_flows_tick(set);
        if (se3di_particles_is_idle(set)) {
            continue;
        }
        const se3d_status drawn = se3di_gravity_eval(model, t, set->gravity, NULL);
        SE3DI_TRY(se3di_model_gravity_varies(model) ? settle(set, drawn, error) : drawn);
        se3di_particles_move_walls(set, model->frames);
        se3di_particles_free_walls(set, model);
        se3d_status status = se3di_particles_forces(set, h);
        if (status < 0 && !se3di_particles_is_complete(set, status)) {
            return report(set, status, error);
        }
        if (status < 0 && *late == SE3D_OK) {
            *late = report(set, status, error);
        }
    }
    return SE3D_OK;
}

void se3di_sets_kick(se3di_model *model, double h)
{
    for (se3di_particles *set = model->sets; set; set = set->next) {
        se3di_particles_kick(set, h);
    }
}

void se3di_sets_push(const se3di_model *model, double *push)
{
    memset(push, 0, 6 * model->body_slots.count * sizeof *push);
    for (const se3di_particles *set = model->sets; set; set = set->next) {
        for (size_t k = 0; k < set->wall_count && !se3di_particles_is_idle(set); ++k) {
            const se3di_wall *wall = &set->walls[k];
            double torque[3];
            se3di_mul_transposed(model->frames[wall->shape.body].A, wall->torque, torque);
            se3di_add(push + 6 * wall->shape.body, wall->force, push + 6 * wall->shape.body);
            se3di_add(push + 6 * wall->shape.body + 3, torque, push + 6 * wall->shape.body + 3);
        }
    }
}

double se3di_sets_power(const se3di_model *model, const double *push)
{
    double power = 0.0;
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        if (!model->bodies[b].fixed) {
            power += se3di_dot(push + 6 * b, model->frames[b].v) +
                     se3di_dot(push + 6 * b + 3, model->frames[b].w);
        }
    }
    return power;
}

double se3di_sets_step(const se3di_model *model)
{
    double step = 0.0;
    for (const se3di_particles *set = model->sets; set; set = set->next) {
        double wanted = se3di_particles_want_step(set, model);
        step = wanted > 0.0 && !(step > 0.0 && step < wanted) ? wanted : step;
    }
    return step;
}
