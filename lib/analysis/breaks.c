/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/breaks.h"

#include "assembly/energy.h"
#include "base/log.h"
#include "base/text.h"
#include "contact/bodies/body_contacts.h"
#include "joint/equation.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define EQUAL 1e-9 /* parts of limits that differ by less are reached together */

static int may_break(const se3di_model *model, const se3di_constraint *joint)
{
    return (joint->break_limit[0] > 0.0 || joint->break_limit[1] > 0.0) &&
           !se3di_is_broken(joint, model->rows);
}

static const char *name_of(const se3di_constraint *joint)
{
    return joint->name ? joint->name : "";
}

/* Its rotor would leave the mass matrix with it. */
static int carries_armature(const se3di_model *model, uint32_t joint)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_ARMATURE &&
            model->forces[k].joint == (int32_t)joint) {
            return 1;
        }
    }
    return 0;
}

static int has_armatures(const se3di_model *model)
{
    int found = 0;
    for (size_t k = 0; k < model->force_slots.count && !found; ++k) {
        found = model->forces[k].type == SE3DI_FORCE_ARMATURE;
    }
    return found;
}

se3d_status se3di_breaks_check(const se3di_run *run)
{
    const se3di_model *model = run->model;
    const int is_driven = se3di_analysis_is(run->analysis, SE3DI_ANALYSIS_IS_DRIVEN);
    const int looks =
        is_driven || (run->analysis == SE3D_ANALYSIS_DYNAMICS && has_armatures(model));
    for (uint32_t k = 0; looks && k < model->constraint_slots.count; ++k) {
        const se3di_constraint *joint = &model->constraints[k];
        if (may_break(model, joint) && is_driven) {
            return se3di_error_set(run->error, SE3D_ERR_UNSUPPORTED,
                                   "joint '%.64s' (%s) may break, which a motion that drivers "
                                   "prescribe does not follow: take its limits off, or run "
                                   "dynamics",
                                   name_of(joint), joint->type);
        }
        const int is_broken = se3di_is_broken(joint, model->rows);
        if ((may_break(model, joint) || is_broken) && carries_armature(model, k)) {
            return se3di_error_set(run->error, SE3D_ERR_UNSUPPORTED,
                                   "joint '%.64s' (%s) %s and carries an armature: a joint that "
                                   "breaks cannot have one",
                                   name_of(joint), joint->type,
                                   is_broken ? "is broken" : "may break");
        }
    }
    return SE3D_OK;
}

/* Crossings of joints that were listed otherwise are not known by their places any more. */
static void forget_hits(se3di_events *events)
{
    size_t kept = 0;
    for (size_t k = 0; k < events->hit_count; ++k) {
        if (events->hits[k].event < events->slots.count) {
            events->hits[kept++] = events->hits[k];
        }
    }
    events->hit_count = kept;
}

/* How many joints may break in the run. */
static size_t count_breaks(const se3di_run *run)
{
    const se3di_model *model = run->model;
    size_t count = 0;
    for (uint32_t k = 0; k < model->constraint_slots.count; ++k) {
        count += (size_t)may_break(model, &model->constraints[k]);
    }
    return run->analysis == SE3D_ANALYSIS_DYNAMICS ? count : 0;
}

/* Joints, their limits and whether they are broken change with these. */
static int is_listed(se3di_events *events)
{
    const se3di_model *model = events->run->model;
    const uint64_t now[3] = {model->topology_version, model->break_version, model->inputs_version};
    uint64_t *listed = events->break_versions;
    const int is = events->break_count == 0 && memcmp(listed, now, sizeof now) == 0;
    memcpy(listed, now, sizeof now);
    return is;
}

se3d_status se3di_breaks_list(se3di_events *events)
{
    if (is_listed(events)) {
        return SE3D_OK;
    }
    const se3di_model *model = events->run->model;
    const size_t first = events->slots.count, before = events->break_count;
    const size_t count = count_breaks(events->run);
    int same = count == before;
    void *list = events->list;
    events->break_count = 0;
    const se3d_status status =
        count == 0 ? SE3D_OK
                   : se3di_array_reserve(&model->allocator, &list, &events->capacity, first + count,
                                         sizeof *events->list);
    events->list = list;
    SE3DI_TRY(status);
    for (uint32_t k = 0; events->break_count < count; ++k) {
        if (may_break(model, &model->constraints[k])) {
            const size_t at = first + events->break_count++;
            same = same && events->list[at].joint == k + 1;
            events->list[at] = (se3di_event){.name = model->constraints[k].name,
                                             .level = 1.0,
                                             .direction = SE3D_EVENT_RISING,
                                             .joint = k + 1};
        }
    }
    if (!same) {
        forget_hits(events);
    }
    return SE3D_OK;
}

double se3di_break_measure(const se3di_model *model, uint32_t joint)
{
    const se3di_constraint *constraint = &model->constraints[joint];
    double wrench[6], largest = 0.0;
    se3di_constraint_reaction(model, constraint, 1, NULL, wrench);
    for (int k = 0; k < 2; ++k) {
        const double limit = constraint->break_limit[k];
        if (limit > 0.0) {
            const double part = se3di_norm(wrench + 3 * k) / limit;
            largest = part > largest || isnan(part) ? part : largest;
        }
    }
    return largest;
}

int se3di_breaks_end_steps(const se3di_events *events)
{
    const se3di_run *run = events->run;
    return !events->dense && (run->model->sets || run->integration.method->takes_crowd);
}

se3d_status se3di_breaks_keep_name(se3di_events *events, const char *name, const char **kept)
{
    const se3d_allocator *allocator = &events->run->model->allocator;
    void *names = events->names;
    const se3d_status status = se3di_array_reserve(allocator, &names, &events->name_capacity,
                                                   events->name_count + 1, sizeof *events->names);
    events->names = names;
    SE3DI_TRY(status);
    char *copy = se3di_text_copy(allocator, name);
    if (!copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    events->names[events->name_count++] = copy;
    *kept = copy;
    return SE3D_OK;
}

/* Of a step that ends later, what elements and contacts remember is that of the present time. */
static se3d_status take_memories(se3di_events *events)
{
    se3di_model *model = events->run->model;
    if (!events->dense || !(model->history[SE3DI_HISTORY_TIME] > model->time)) {
        return SE3D_OK;
    }
    se3di_forces_show(model, 1);
    se3di_forces_stay(model);
    return model->contacts.pair_count > 0
               ? se3di_contacts_show(model, model->time, events->run->error)
               : SE3D_OK;
}

se3d_status se3di_breaks_name_record(se3di_events *events, uint32_t joint,
                                     se3d_event_record *record)
{
    const se3di_model *model = events->run->model;
    const se3di_handle handle = se3di_slots_handle(&model->constraint_slots, joint);
    record->joint = (se3d_constraint){handle.index1, handle.generation};
    record->name = "";
    return se3di_breaks_keep_name(events, name_of(&model->constraints[joint]), &record->name);
}

/* What springs on the joint hold is lost. */
static se3d_status let_go(se3di_model *model, uint32_t joint)
{
    double before, after;
    SE3DI_TRY(se3di_forces_potential(model, model->time, &before));
    se3di_model_break(model, joint, 1);
    SE3DI_TRY(se3di_forces_potential(model, model->time, &after));
    model->work[0] += model->work_valid > 0 ? before - after : 0.0;
    return SE3D_OK;
}

/* One joint, loaded to `part` of its limits. */
static se3d_status break_one(se3di_events *events, uint32_t joint, double part)
{
    se3di_run *run = events->run;
    se3di_model *model = run->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    se3d_event_record record = {.time = model->time, .value = part, .direction = SE3D_EVENT_RISING};
    double wrench[6];
    if (se3di_breaks_name_record(events, joint, &record) < 0) {
        return se3di_error_set(run->error, SE3D_ERR_NO_MEMORY, "no memory for an event");
    }
    SE3DI_TRY(se3di_events_add_record(events, &record));
    se3di_constraint_reaction(model, constraint, 1, NULL, wrench);
    SE3DI_TRY(let_go(model, joint));
    se3di_log_write(run->error, SE3D_LOG_INFO, SE3D_LOG_BROKEN,
                    "t = %.9g s: joint '%.64s' (%s) broke, under a force of %.6g N and a moment of "
                    "%.6g N m",
                    model->time, name_of(constraint), constraint->type, se3di_norm(wrench),
                    se3di_norm(wrench + 3));
    return SE3D_OK;
}

se3d_status se3di_breaks_happen(se3di_events *events)
{
    se3di_model *model = events->run->model;
    const se3di_event *list = events->list + events->slots.count;
    double most = 0.0;
    events->looked = 0;
    events->hit_count = 0;
    for (size_t k = 0; k < events->break_count; ++k) {
        most = fmax(most, se3di_break_measure(model, list[k].joint - 1));
    }
    SE3DI_TRY(take_memories(events));
    for (size_t k = 0; k < events->break_count; ++k) {
        const uint32_t joint = list[k].joint - 1;
        const double part = se3di_break_measure(model, joint);
        if (part >= (1.0 - EQUAL) * most) {
            SE3DI_TRY(break_one(events, joint, part));
        }
    }
    return SE3D_OK;
}
