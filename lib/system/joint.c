/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: joints and their coordinates. */
#include "joint/joint.h"

#include "joint/rows.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

#include <string.h>

#define COINCIDENT                                                                                 \
    1e-12 /* distance of points, relative to their distance from the origin + 1 m                  \
           */

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

/* The triad of one body; `ref` zero: chosen. */
static se3d_status check_triad(se3d_system *system, const char *what, const double axis[3],
                               const double ref[3], double ref_out[3], double third[3])
{
    double unit[3];
    if (is_zero(ref)) {
        se3di_joint_triad_build(axis, NULL, ref_out, third);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_direction(system, what, ref, unit));
    if (!se3di_joint_triad_build(axis, unit, ref_out, third)) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = [%g, %g, %g] is parallel to its axis, must not be", ref[0], ref[1],
                             ref[2]);
    }
    return SE3D_OK;
}

static se3d_status check_frames(se3d_system *system, const se3d_joint_def *def, uint32_t flags,
                                const uint32_t bodies[2], se3di_joint_frames *f)
{
    SE3DI_TRY(se3di_check_finites(system, "point_i", def->point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", def->point_j, 3));
    SE3DI_TRY(se3di_check_direction(system, "axis_i", def->axis_i, f->axis_i));
    SE3DI_TRY(se3di_check_direction(system, "axis_j", def->axis_j, f->axis_j));
    SE3DI_TRY(se3di_check_finite(system, "angle0", def->angle0));
    se3di_copy(def->point_i, f->point_i);
    se3di_copy(def->point_j, f->point_j);
    SE3DI_TRY(check_triad(system, "ref_i", f->axis_i, def->ref_i, f->ref_i, f->third_i));
    if (!is_zero(def->ref_j)) {
        return check_triad(system, "ref_j", f->axis_j, def->ref_j, f->ref_j, f->third_j);
    }
    /* joints without an angle coordinate keep the present one, zero */
    double angle = flags & SE3DI_JOINT_ANGLE ? def->angle0 : 0.0;
    const se3di_frame *frames = system->model.frames;
    se3di_joint_ref_match(f, angle, &frames[bodies[0]], &frames[bodies[1]], f->ref_j);
    se3di_cross(f->axis_j, f->ref_j, f->third_j);
    return SE3D_OK;
}

static double present_distance(const se3di_joint_frames *f, const se3di_frame *i,
                               const se3di_frame *j, double *scale)
{
    double P_i[3], P_j[3], d[3];
    se3di_mul(i->A, f->point_i, P_i);
    se3di_mul(j->A, f->point_j, P_j);
    se3di_add(P_i, i->r, P_i);
    se3di_add(P_j, j->r, P_j);
    se3di_sub(P_j, P_i, d);
    *scale = 1.0 + se3di_norm(P_i) + se3di_norm(P_j);
    return se3di_norm(d);
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
        double scale;
        const se3di_frame *frames = system->model.frames;
        def->distance = present_distance(f, &frames[bodies[0]], &frames[bodies[1]], &scale);
        if (!(def->distance > COINCIDENT * scale)) {
            return SE3DI_FAIL_OF(system, "distance", SE3D_ERR_INVALID_ARGUMENT,
                                 " = 0 m and the points coincide at the present pose, must be "
                                 "> 0 (points that coincide are a spherical joint)");
        }
    }
    return SE3D_OK;
}

/* The constant of the last row (screw) such that the row holds at the present pose. */
static void close_last_row(se3di_draft *draft, const se3di_frame *frames)
{
    se3di_row *row = &draft->rows[draft->row_count - 1];
    row->value = 0.0;
    for (uint32_t k = row->term_begin; k < row->term_begin + row->term_count; ++k) {
        const se3di_term *term = &draft->terms[k];
        double value = term->type == SE3DI_PRIMITIVE_ANGLE
                           ? draft->angle.theta
                           : se3di_primitives[term->type].value(term, &frames[term->body_i],
                                                                &frames[term->body_j]);
        row->value += term->coefficient * value;
    }
}

static void draft_build(const se3di_model *model, const se3di_joint_type *type,
                        const se3d_joint_def *def, se3di_draft *draft)
{
    const uint32_t *bodies = draft->constraint.bodies;
    const se3di_joint_frames *f = &draft->constraint.frames;
    draft->constraint.has_displacement = (type->flags & SE3DI_JOINT_DISPLACEMENT) != 0;
    draft->constraint.angle0 = def->angle0;
    if (type->flags & SE3DI_JOINT_ANGLE) {
        double offset = is_zero(def->ref_j) ? 0.0 : def->angle0;
        draft->has_angle = 1;
        se3di_joint_angle_init(f, bodies, offset, &draft->angle);
        draft->angle.theta = se3di_joint_angle_start(&draft->angle, &model->frames[bodies[0]],
                                                     &model->frames[bodies[1]], def->angle0);
    }
    type->build(f, def, draft);
    if (type->flags & SE3DI_JOINT_PITCH) {
        close_last_row(draft, model->frames);
    }
    if (type->flags & SE3DI_JOINT_OFFSET) {
        se3di_row *row = &draft->rows[draft->row_count - 1];
        close_last_row(draft, model->frames);
        row->value = copysign(def->distance, row->value); /* the side of the present pose */
    }
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
    se3di_draft_init(&draft, type->name, bodies[0], bodies[1]);
    draft.constraint.name = (char *)(uintptr_t)def.name; /* copied below, never written to */
    SE3DI_TRY(check_frames(system, &def, type->flags, bodies, &draft.constraint.frames));
    SE3DI_TRY(check_parameters(system, type->flags, bodies, &draft.constraint.frames, &def));
    draft_build(&system->model, type, &def, &draft);
    return se3di_constraint_add(system, &draft, joint);
}

#define CREATE(name, flags)                                                                        \
    se3d_status se3d_joint_create_##name(se3d_system *system, const se3d_joint_def *def,           \
                                         se3d_constraint *joint)                                   \
    {                                                                                              \
        return joint_create(system, __func__, SE3DI_JOINT_TYPE_##name, def, joint);                \
    }
SE3DI_JOINT_LIST(CREATE)

/* Point and directions of the joint in one body's frame. */
static void set_side(const se3di_frame *frame, const double at[3], const double axis[3],
                     double point_out[3], double axis_out[3])
{
    double d[3];
    se3di_sub(at, frame->r, d);
    se3di_mul_transposed(frame->A, d, point_out);
    se3di_mul_transposed(frame->A, axis, axis_out);
}

static int is_direction(const double v[3])
{
    return se3di_is_finite(v, 3) && fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))) >= 1e-150;
}

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
    if (!se3di_is_finite(at, 3) || !is_direction(axis) || (ref && !is_direction(ref))) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    double unit[3], square[3], third[3];
    se3di_scale(1.0 / fmax(fabs(axis[0]), fmax(fabs(axis[1]), fabs(axis[2]))), axis, unit);
    se3di_scale(1.0 / se3di_norm(unit), unit, unit);
    if (ref && !se3di_joint_triad_build(unit, ref, square, third)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    set_side(&system->model.frames[i], at, unit, def->point_i, def->axis_i);
    set_side(&system->model.frames[j], at, unit, def->point_j, def->axis_j);
    memset(def->ref_i, 0, sizeof def->ref_i);
    memset(def->ref_j, 0, sizeof def->ref_j); /* zero: the angle at the present pose is angle0 */
    if (ref) {
        se3di_mul_transposed(system->model.frames[i].A, square, def->ref_i);
    }
    return SE3D_OK;
}

/* First and second time derivative of a term of coefficient 1 at the present motion. */
static void term_rates(const se3di_model *model, const se3di_term *term, double *rate,
                       double *acceleration)
{
    const se3di_primitive *primitive = &se3di_primitives[term->type];
    const uint32_t bodies[2] = {term->body_i, term->body_j};
    double phi[2][6];
    primitive->jacobian_romega(term, &model->frames[bodies[0]], &model->frames[bodies[1]], phi[0],
                               phi[1]);
    *rate = 0.0;
    *acceleration =
        -primitive->gamma_romega(term, &model->frames[bodies[0]], &model->frames[bodies[1]]);
    for (int b = 0; b < 2; ++b) {
        const se3di_frame *frame = &model->frames[bodies[b]];
        const double *a = &model->acceleration[6 * bodies[b]];
        *rate += se3di_dot(phi[b], frame->v) + se3di_dot(phi[b] + 3, frame->w);
        *acceleration += se3di_dot(phi[b], a) + se3di_dot(phi[b] + 3, a + 3);
    }
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
    results[0] = se3di_term_value(model, &term);
    term_rates(model, &term, &results[1], &results[2]);
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
