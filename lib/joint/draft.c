/* SPDX-License-Identifier: BSD-3-Clause */
#include "joint/draft.h"

#include "joint/equation.h"
#include "joint/rows.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

/* distance of points, relative to their distance from the origin + 1 m */
#define COINCIDENT 1e-12

int se3di_joint_frames_complete(const se3di_model *model, const uint32_t bodies[2], double angle,
                                const double *ref_i, const double *ref_j, se3di_joint_frames *f)
{
    if (!se3di_joint_triad_take(f->axis_i, ref_i, f->ref_i, f->third_i)) {
        return 1;
    }
    if (ref_j) {
        return se3di_joint_triad_take(f->axis_j, ref_j, f->ref_j, f->third_j) ? 0 : 2;
    }
    se3di_joint_ref_match(f, angle, &model->frames[bodies[0]], &model->frames[bodies[1]], f->ref_j);
    se3di_cross(f->axis_j, f->ref_j, f->third_j);
    return 0;
}

double se3di_joint_present_distance(const se3di_model *model, const uint32_t bodies[2],
                                    const se3di_joint_frames *f)
{
    const se3di_frame *i = &model->frames[bodies[0]];
    const se3di_frame *j = &model->frames[bodies[1]];
    double P_i[3], P_j[3], d[3];
    se3di_mul(i->A, f->point_i, P_i);
    se3di_mul(j->A, f->point_j, P_j);
    se3di_add(P_i, i->r, P_i);
    se3di_add(P_j, j->r, P_j);
    se3di_sub(P_j, P_i, d);
    const double distance = se3di_norm(d);
    const double scale = 1.0 + se3di_norm(P_i) + se3di_norm(P_j);
    return distance > COINCIDENT * scale ? distance : 0.0;
}

void se3di_draft_close(const se3di_model *model, se3di_draft *draft)
{
    se3di_row *row = &draft->rows[draft->row_count - 1];
    row->value = 0.0;
    for (uint32_t k = row->term_begin; k < row->term_begin + row->term_count; ++k) {
        const se3di_term *term = &draft->terms[k];
        const int is_own = term->type == SE3DI_PRIMITIVE_ANGLE && term->angle < 0;
        row->value += is_own ? term->coefficient * draft->angle.theta /* it counts turns */
                             : se3di_term_value(model, term);
    }
}

static int is_zero(const double v[3])
{
    return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

void se3di_joint_draft(const se3di_model *model, const se3di_joint_type *type,
                       const se3d_joint_def *def, se3di_draft *draft)
{
    const uint32_t *bodies = draft->constraint.bodies;
    const se3di_joint_frames *f = &draft->constraint.frames;
    draft->constraint.has_displacement = (type->flags & SE3DI_JOINT_DISPLACEMENT) != 0;
    draft->constraint.angle0 = def->angle0;
    draft->constraint.pitch = def->pitch;
    draft->constraint.distance = def->distance;
    if (type->flags & SE3DI_JOINT_ANGLE) {
        double offset = is_zero(def->ref_j) ? 0.0 : def->angle0;
        draft->has_angle = 1;
        se3di_joint_angle_init(f, bodies, offset, &draft->angle);
        draft->angle.theta = se3di_joint_angle_start(&draft->angle, &model->frames[bodies[0]],
                                                     &model->frames[bodies[1]], def->angle0);
    }
    type->build(f, def, draft);
    if (type->flags & (SE3DI_JOINT_PITCH | SE3DI_JOINT_OFFSET)) {
        se3di_draft_close(model, draft);
    }
    if (type->flags & SE3DI_JOINT_OFFSET) {
        se3di_row *row = &draft->rows[draft->row_count - 1];
        row->value = copysign(def->distance, row->value); /* the side of the present pose */
    }
}

/* Point and direction of a joint in one body's frame. */
static void set_side(const se3di_frame *frame, const double at[3], const double axis[3],
                     double point_out[3], double axis_out[3])
{
    double d[3];
    se3di_sub(at, frame->r, d);
    se3di_mul_transposed(frame->A, d, point_out);
    se3di_mul_transposed(frame->A, axis, axis_out);
}

int se3di_joint_def_place(const se3di_frame *i, const se3di_frame *j, const double at[3],
                          const double axis[3], const double *ref, se3d_joint_def *def)
{
    double square[3], third[3];
    if (ref && !se3di_joint_triad_build(axis, ref, square, third)) {
        return 0;
    }
    set_side(i, at, axis, def->point_i, def->axis_i);
    set_side(j, at, axis, def->point_j, def->axis_j);
    memset(def->ref_i, 0, sizeof def->ref_i);
    memset(def->ref_j, 0, sizeof def->ref_j); /* zero: the angle at the present pose is angle0 */
    if (ref) {
        se3di_mul_transposed(i->A, square, def->ref_i);
    }
    return 1;
}

/* A row whose value is the user's. */
static se3di_row *add_prescribed(se3di_draft *draft, const char *name, se3di_prescribed prescribed)
{
    se3di_row *row = se3di_draft_add_row(draft, name, prescribed.value);
    row->function = prescribed.function;
    draft->constraint.has_value = 1;
    return row;
}

void se3di_primitive_draft(const char *name, const se3di_term *term, se3di_prescribed prescribed,
                           se3di_draft *draft)
{
    const char *type = se3di_primitives[term->type].name;
    se3di_draft_init(draft, type, name, term->body_i, term->body_j);
    se3di_copy(term->s_i, draft->constraint.frames.point_i);
    se3di_copy(term->s_j, draft->constraint.frames.point_j);
    (void)add_prescribed(draft, type, prescribed);
    se3di_draft_add_term(draft, term, 1.0);
}

void se3di_driver_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                        const char *name, se3di_prescribed prescribed, se3di_draft *draft)
{
    const se3di_constraint *source = &model->constraints[joint];
    const int is_angle = coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    se3di_term term;
    (void)se3di_coordinate_term(model, joint, coordinate, &term);
    se3di_draft_init(draft, "driver", name, source->bodies[0], source->bodies[1]);
    draft->constraint.frames = source->frames;
    draft->constraint.joints[0] = (int32_t)joint;
    add_prescribed(draft, is_angle ? "angle" : "displacement", prescribed)->wrap = is_angle;
    se3di_draft_add_term(draft, &term, 1.0);
}

void se3di_coupler_draft(const char *type, const char *name, se3di_draft *draft)
{
    se3di_draft_init(draft, type, name, 0, 0);
    draft->constraint.body_count = 0;
    se3di_draft_add_row(draft, type, 0.0);
}

/* Each body is listed once, in the order of the joints; reactions are reported at the points of the
 * first joint. */
static void add_bodies(se3di_constraint *constraint, const se3di_constraint *joint)
{
    for (uint32_t b = 0; b < 2; ++b) {
        uint32_t k = 0;
        while (k < constraint->body_count && constraint->bodies[k] != joint->bodies[b]) {
            ++k;
        }
        if (k == constraint->body_count) {
            constraint->bodies[constraint->body_count++] = joint->bodies[b];
        }
    }
}

void se3di_coupler_add_term(const se3di_model *model, uint32_t joint, const se3di_term *term,
                            double ratio, se3di_draft *draft)
{
    const se3di_constraint *source = &model->constraints[joint];
    if (draft->term_count == 0) {
        draft->constraint.frames = source->frames;
    }
    add_bodies(&draft->constraint, source);
    draft->constraint.joints[draft->term_count] = (int32_t)joint;
    se3di_draft_add_term(draft, term, ratio);
}

void se3di_user_draft(const se3d_user_constraint_def *def, const uint32_t *bodies,
                      se3di_draft *draft)
{
    static const char *const names[SE3D_USER_EQUATIONS_MAX] = {"user_0", "user_1", "user_2",
                                                               "user_3", "user_4", "user_5"};
    const int is_single = def->body_count == 1; /* the ground is its other body */
    se3di_draft_init(draft, "user", def->name, 0, bodies[0]);
    draft->constraint.callback = def->callback;
    draft->constraint.ctx = def->ctx;
    draft->constraint.user_first = is_single ? 1u : 0u;
    draft->constraint.body_count = is_single ? 2u : (uint32_t)def->body_count;
    for (int32_t k = 0; k < def->body_count && !is_single; ++k) {
        draft->constraint.bodies[k] = bodies[k];
    }
    for (int32_t r = 0; r < def->equation_count; ++r) {
        se3di_draft_add_row(draft, names[r], 0.0);
    }
}
