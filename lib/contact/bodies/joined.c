/* SPDX-License-Identifier: BSD-3-Clause */
/* Which shapes a constraint keeps from touching: all of the two bodies that it joins; with a fixed
 * body only those that overlap at the joint itself. There a point of the one body is held to a
 * point of the other, and where the first is deeper within its shape than the second is away from
 * the other shape (a pin in its post, a slider on its rail), the two overlap however the joint
 * moves. Elsewhere an arm that falls meets the floor. docs/theory/body-contact.md */
#include "contact/bodies/joined.h"

#include "contact/shape/mesh.h"
#include "contact/shape/shape.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define ROUNDING 1e-9 /* of the size: shapes that meet at a joint do not overlap there */

/* Of a point of the body from its shape, negative inside. */
static double distance_from(const se3di_shape *s, const double point[3])
{
    double d[3], local[3], at[3], n[3], distance;
    se3di_sub(point, s->x, d);
    se3di_mul_transposed(s->A, d, local);
    se3di_shape_nearest(s, local, at, n, &distance);
    if (se3di_shape_is(s, SE3DI_SHAPE_IS_SURFACE) && s->closed != 0) {
        double u[3], v[3];
        const uint32_t *t = s->triangles + 3 * se3di_mesh_nearest(s, local, at, &distance);
        se3di_sub(s->vertices + 3 * (size_t)t[1], s->vertices + 3 * (size_t)t[0], u);
        se3di_sub(s->vertices + 3 * (size_t)t[2], s->vertices + 3 * (size_t)t[0], v);
        se3di_cross(u, v, n);
        se3di_sub(local, at, d);
        distance *= s->closed * se3di_dot(d, n) < 0.0 ? -1.0 : 1.0;
    }
    return distance;
}

/* Points are held to each other, not only directions, or at a distance. */
static int holds_points(const se3di_model *model, const se3di_constraint *c)
{
    int holds = 0;
    for (uint32_t k = 0; k < c->term_count; ++k) {
        const int32_t type = model->terms[c->term_begin + k].type;
        if (type == SE3DI_PRIMITIVE_D) {
            return 0;
        }
        holds = holds || type == SE3DI_PRIMITIVE_DP2 || type == SE3DI_PRIMITIVE_CD;
    }
    return holds;
}

static int overlap_at_joint(const se3di_constraint *c, const se3di_shape *a, const se3di_shape *b)
{
    const int turned = c->bodies[0] != a->body;
    const double apart = distance_from(a, turned ? c->frames.point_j : c->frames.point_i) +
                         distance_from(b, turned ? c->frames.point_i : c->frames.point_j);
    return apart < -ROUNDING * fmin(a->bound, b->bound);
}

int se3di_joint_keeps_apart(const se3di_model *model, const se3di_constraint *c,
                            const se3di_shape *a, const se3di_shape *b)
{
    int has_a = 0, has_b = 0;
    if (c->row_count > 0 && model->rows[c->row_begin].left_out & SE3DI_ROW_PARTED) {
        return 0; /* it broke */
    }
    for (uint32_t n = 0; n < c->body_count; ++n) {
        has_a |= c->bodies[n] == a->body;
        has_b |= c->bodies[n] == b->body;
    }
    if (!has_a || !has_b) {
        return 0;
    }
    if (!model->bodies[a->body].fixed && !model->bodies[b->body].fixed) {
        return 1;
    }
    if (strcmp(c->type, "fixed") == 0) {
        return 1; /* where they overlap they always do */
    }
    return c->body_count == 2 && holds_points(model, c) && overlap_at_joint(c, a, b);
}

int se3di_shapes_are_joined(const se3di_model *model, uint32_t a, uint32_t b)
{
    const se3di_shape *s = &model->shapes[a], *t = &model->shapes[b];
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        if (se3di_joint_keeps_apart(model, &model->constraints[k], s, t)) {
            return 1;
        }
    }
    return 0;
}

se3d_status se3di_joints_gather(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    const size_t bodies = model->body_slots.count;
    SE3DI_TRY(se3di_array_reserve_at(&model->allocator, &c->joint_begin, &c->begin_capacity,
                                     bodies + 2, sizeof *c->joint_begin));
    size_t *begin = c->joint_begin, total = 0;
    memset(begin, 0, (bodies + 2) * sizeof *begin);
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *one = &model->constraints[k];
        total += one->body_count;
        for (uint32_t n = 0; n < one->body_count; ++n) {
            ++begin[one->bodies[n] + 2];
        }
    }
    SE3DI_TRY(se3di_array_reserve_at(&model->allocator, &c->joints, &c->joints_capacity, total,
                                     sizeof *c->joints));
    for (size_t b = 2; b < bodies + 2; ++b) {
        begin[b] += begin[b - 1];
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *one = &model->constraints[k];
        for (uint32_t n = 0; n < one->body_count; ++n) {
            c->joints[begin[one->bodies[n] + 1]++] = (uint32_t)k;
        }
    }
    return SE3D_OK;
}

int se3di_joints_keep_apart(const se3di_model *model, uint32_t a, uint32_t b)
{
    const se3di_body_contacts *c = &model->contacts;
    const se3di_shape *s = &model->shapes[a], *t = &model->shapes[b];
    const size_t *i = c->joint_begin + s->body, *j = c->joint_begin + t->body;
    const size_t *fewer = i[1] - i[0] < j[1] - j[0] ? i : j;
    for (size_t k = fewer[0]; k < fewer[1]; ++k) {
        if (se3di_joint_keeps_apart(model, &model->constraints[c->joints[k]], s, t)) {
            return 1;
        }
    }
    return 0;
}
