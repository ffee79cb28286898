/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: joints and their coordinates. */
#include "joint/draft.h"
#include "joint/equation.h"
#include "joint/rows.h"
#include "math/vec3.h"
#include "system/coordinate.h"
#include "system/definition.h"
#include "system/system_internal.h"

#include <float.h>

void se3d_joint_def_init(se3d_joint_def *def, size_t size)
{
    se3d_joint_def full = {
        .struct_size = size, .axis_i = {0.0, 0.0, 1.0}, .axis_j = {0.0, 0.0, 1.0}};
    se3di_def_init(def, size, &full, sizeof full);
}

static int is_zero(const double v[3])
{
    return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

/* A reference direction; NULL if it is zero and so is chosen. */
static se3d_status check_ref(se3d_system *system, const char *what, const double ref[3],
                             double unit[3], const double **given)
{
    *given = is_zero(ref) ? NULL : unit;
    return *given ? se3di_check_direction(system, what, ref, unit) : SE3D_OK;
}

static se3d_status check_frames(se3d_system *system, const se3d_joint_def *def, uint32_t flags,
                                const uint32_t bodies[2], se3di_joint_frames *f)
{
    double unit_i[3], unit_j[3];
    const double *ref_i, *ref_j;
    SE3DI_TRY(se3di_check_finites(system, "point_i", def->point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", def->point_j, 3));
    SE3DI_TRY(se3di_check_direction(system, "axis_i", def->axis_i, f->axis_i));
    SE3DI_TRY(se3di_check_direction(system, "axis_j", def->axis_j, f->axis_j));
    SE3DI_TRY(se3di_check_finite(system, "angle0", def->angle0));
    SE3DI_TRY(check_ref(system, "ref_i", def->ref_i, unit_i, &ref_i));
    SE3DI_TRY(check_ref(system, "ref_j", def->ref_j, unit_j, &ref_j));
    se3di_copy(def->point_i, f->point_i);
    se3di_copy(def->point_j, f->point_j);
    /* joints without an angle coordinate keep the present one, zero */
    const double angle = flags & SE3DI_JOINT_ANGLE ? def->angle0 : 0.0;
    const int parallel =
        se3di_joint_frames_complete(&system->model, bodies, angle, ref_i, ref_j, f);
    const double *ref = parallel == 1 ? def->ref_i : def->ref_j;
    return parallel == 0
               ? SE3D_OK
               : SE3DI_FAIL_OF(system, parallel == 1 ? "ref_i" : "ref_j", SE3D_ERR_INVALID_ARGUMENT,
                               " = [%g, %g, %g] is parallel to its axis, must not be", ref[0],
                               ref[1], ref[2]);
}

/* Check what the joint type needs besides frames; a distance of 0 becomes the present one. */
static se3d_status check_parameters(se3d_system *system, uint32_t flags, const uint32_t bodies[2],
                                    const se3di_joint_frames *f, se3d_joint_def *def)
{
    SE3DI_TRY(se3di_check_finite(system, "pitch", def->pitch));
    SE3DI_TRY(se3di_check_finite(system, "distance", def->distance));
    if ((flags & SE3DI_JOINT_PITCH) && def->pitch == 0.0) {
        return SE3DI_FAIL_OF(system, "pitch", SE3D_ERR_INVALID_ARGUMENT,
                             " = 0 m, must not be 0 (a screw without advance is a revolute)");
    }
    if (!(flags & (SE3DI_JOINT_DISTANCE | SE3DI_JOINT_OFFSET))) {
        return SE3D_OK;
    }
    if (def->distance < 0.0) {
        return SE3DI_FAIL_OF(system, "distance", SE3D_ERR_INVALID_ARGUMENT, " = %g m, must be %s",
                             def->distance,
                             flags & SE3DI_JOINT_OFFSET ? ">= 0 (0: the axes meet)"
                                                        : "> 0 (or 0: as at the present pose)");
    }
    if ((flags & SE3DI_JOINT_DISTANCE) && def->distance == 0.0) {
        def->distance = se3di_joint_present_distance(&system->model, bodies, f);
        if (!(def->distance > 0.0)) {
            return SE3DI_FAIL_OF(system, "distance", SE3D_ERR_INVALID_ARGUMENT,
                                 " = 0 m and the points coincide at the present pose, must be "
                                 "> 0 (points that coincide are a spherical joint)");
        }
    }
    return SE3D_OK;
}

static se3d_status check_limits(se3d_system *system, double force, double moment)
{
    SE3DI_TRY(se3di_check_range(system, "break_force", force, 0.0, DBL_MAX));
    return se3di_check_range(system, "break_moment", moment, 0.0, DBL_MAX);
}

static se3d_status joint_create(se3d_system *system, const char *function, se3di_joint_type_id id,
                                const se3d_joint_def *user, se3d_constraint *joint)
{
    if (joint) {
        *joint = (se3d_constraint){0, 0};
    }
    SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, function));
    SE3DI_TRY(se3di_check_pointer(system, "joint", joint));
    const se3di_joint_type *type = &se3di_joint_types[id];
    se3d_joint_def def = se3d_joint_def_default();
    uint32_t bodies[2];
    se3di_draft draft;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def.name));
    SE3DI_TRY(se3di_find_body(system, "body_i", def.body_i, &bodies[0]));
    SE3DI_TRY(se3di_find_body(system, "body_j", def.body_j, &bodies[1]));
    SE3DI_TRY(se3di_check_distinct(system, bodies));
    se3di_draft_init(&draft, type->name, def.name, bodies[0], bodies[1]);
    SE3DI_TRY(check_frames(system, &def, type->flags, bodies, &draft.constraint.frames));
    SE3DI_TRY(check_parameters(system, type->flags, bodies, &draft.constraint.frames, &def));
    SE3DI_TRY(check_limits(system, def.break_force, def.break_moment));
    se3di_joint_draft(&system->model, type, &def, &draft);
    draft.constraint.break_limit[0] = def.break_force;
    draft.constraint.break_limit[1] = def.break_moment;
    return se3di_constraint_add(system, &draft, joint);
}

#define CREATE(name, flags)                                                                        \
    se3d_status se3d_joint_create_##name(se3d_system *system, const se3d_joint_def *def,           \
                                         se3d_constraint *joint)                                   \
    {                                                                                              \
        return joint_create(system, __func__, SE3DI_JOINT_TYPE_##name, def, joint);                \
    }
SE3DI_JOINT_LIST(CREATE)

se3d_status se3d_joint_def_set_frame(const se3d_system *system, se3d_joint_def *def,
                                     const double at[3], const double axis[3], const double *ref)
{
    if (!system || !def || !at || !axis) {
        return SE3D_ERR_NULL;
    }
    const se3di_slots *slots = &system->model.body_slots;
    uint32_t i = se3di_slots_find(slots, def->body_i.index1, def->body_i.generation);
    uint32_t j = se3di_slots_find(slots, def->body_j.index1, def->body_j.generation);
    if (i == SE3DI_NO_INDEX || j == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    double unit[3], any[3];
    if (!se3di_is_finite(at, 3) || !se3di_is_finite(axis, 3) || !se3di_unit(axis, unit) ||
        (ref && !(se3di_is_finite(ref, 3) && se3di_unit(ref, any)))) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_frame *frames = system->model.frames;
    return se3di_joint_def_place(&frames[i], &frames[j], at, unit, ref, def)
               ? SE3D_OK
               : SE3D_ERR_INVALID_ARGUMENT;
}

/* A joint between two bodies. */
static se3d_status find_pair(se3d_system *system, se3d_constraint joint, uint32_t *index)
{
    SE3DI_TRY(se3di_find_constraint(system, "joint", joint, index));
    const char *type = system->model.constraints[*index].type;
    return se3di_is_joint_type(type)
               ? SE3D_OK
               : SE3DI_FAIL_OF(system, "joint", SE3D_ERR_INVALID_ARGUMENT,
                               " is a %s, must be a joint between two bodies", type);
}

se3d_status se3d_joint_set_break(se3d_system *system, se3d_constraint joint, double force,
                                 double moment)
{
    SE3DI_SET(system);
    uint32_t index;
    SE3DI_TRY(find_pair(system, joint, &index));
    SE3DI_TRY(check_limits(system, force, moment));
    system->model.constraints[index].break_limit[0] = force;
    system->model.constraints[index].break_limit[1] = moment;
    se3di_model_touch_inputs(&system->model);
    return SE3D_OK;
}

se3d_status se3d_joint_get_broken(const se3d_system *system, se3d_constraint joint, int32_t *broken)
{
    uint32_t index;
    if (broken) {
        *broken = 0;
    }
    SE3DI_TRY(
        se3di_read_index(SE3DI_SLOTS(system, constraint), SE3DI_HANDLE(joint), broken, &index));
    *broken = se3di_is_broken(&system->model.constraints[index], system->model.rows);
    return SE3D_OK;
}

se3d_status se3d_joint_set_broken(se3d_system *system, se3d_constraint joint, int32_t broken)
{
    SE3DI_SET(system);
    uint32_t index;
    SE3DI_TRY(find_pair(system, joint, &index));
    if (broken != 0 && broken != 1) {
        return SE3DI_FAIL_OF(system, "broken", SE3D_ERR_INVALID_ARGUMENT, " = %d, must be 0 or 1",
                             (int)broken);
    }
    se3di_model *model = &system->model;
    if (se3di_is_broken(&model->constraints[index], model->rows) == broken) {
        return SE3D_OK;
    }
    se3di_model_break(model, index, broken);
    if (!broken) {
        se3di_model_touch_poses(model);
    }
    return SE3D_OK;
}

se3d_status se3d_joint_get_coordinate(const se3d_system *system, se3d_constraint joint,
                                      se3d_joint_coordinate coordinate, double *value, double *rate,
                                      double *acceleration)
{
    double *outputs[3] = {value, rate, acceleration};
    double results[3];
    for (int k = 0; k < 3; ++k) {
        if (outputs[k]) {
            *outputs[k] = 0.0;
        }
    }
    if (!system) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index = se3di_slots_find(&model->constraint_slots, joint.index1, joint.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    se3di_term term;
    if (!se3di_coordinate_term(model, index, (int32_t)coordinate, &term)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    SE3DI_TRY(acceleration ? se3di_check_solved(system) : SE3D_OK);
    se3di_term_motion(model, &term, acceleration ? 3 : 2, results);
    if (!se3di_is_finite(results, 3)) {
        return SE3D_ERR_NOT_FINITE;
    }
    for (int k = 0; k < 3; ++k) {
        if (outputs[k]) {
            *outputs[k] = results[k];
        }
    }
    return SE3D_OK;
}
