/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts with meshes are followed while their bodies hardly move on each other, instead of looked
 * for: with x_i and x_j the places of the two bodies that a point was, and d by how much they have
 * parted in the step,
 *
 *     delta' = delta - n . d,    n turns with body i
 *
 * until the bodies have moved on each other by HELD of the least overlap. So much at most is missed
 * of what else may have come to touch. The record has how far they have moved: the same bits follow
 * from a snapshot.                                                       docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/shape/shape.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define HELD  0.01 /* of the least overlap of a pair of shapes */
#define PARTS 6    /* numbers of a contact: normal and stretch in the frame of body i */

static int is_body(const se3di_shape *shape)
{
    return !se3di_shape_is(shape, SE3DI_SHAPE_IS_BALL | SE3DI_SHAPE_IS_HALF_SPACE) &&
           !se3di_surface_moves(shape);
}

/* A mesh and what has more than one point of contact with it: others are looked at fast. */
static int is_slow(const se3di_model *model, const se3di_body_contact *r)
{
    const se3di_shape *i = &model->shapes[r->shape_i], *j = &model->shapes[r->shape_j];
    const int has_mesh =
        se3di_shape_is(i, SE3DI_SHAPE_IS_SURFACE) || se3di_shape_is(j, SE3DI_SHAPE_IS_SURFACE);
    return has_mesh && is_body(i) && is_body(j);
}

static const se3di_frame *frame_of(const se3di_model *model, const se3di_body_contact *r, int k)
{
    return &model->frames[model->shapes[k ? r->shape_j : r->shape_i].body];
}

/* The point half way between the two places, and the stretch between them. */
static void find_places(const se3di_model *model, const se3di_body_contact *r, double middle[3],
                        double stretch[3])
{
    double x[2][3];
    for (int k = 0; k < 2; ++k) {
        const se3di_frame *frame = frame_of(model, r, k);
        se3di_mul(frame->A, k ? r->anchor_j : r->anchor_i, x[k]);
        se3di_add(x[k], frame->r, x[k]);
    }
    se3di_sub(x[1], x[0], stretch);
    se3di_add(x[0], x[1], middle);
    se3di_scale(0.5, middle, middle);
}

se3d_status se3di_convex_mark(se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    const size_t count = model->contacts.count;
    void *marks = c->marks, *followed = c->followed;
    c->followed_count = 0;
    se3d_status status = se3di_array_reserve(&model->allocator, &marks, &c->mark_capacity, count,
                                             PARTS * sizeof *c->marks);
    c->marks = marks;
    SE3DI_TRY(status);
    status = se3di_array_reserve(&model->allocator, &followed, &c->followed_capacity, count,
                                 sizeof *c->followed);
    c->followed = followed;
    SE3DI_TRY(status);
    for (size_t k = 0; k < count; ++k) {
        const se3di_body_contact *r = &model->contacts.list[k];
        double middle[3], stretch[3];
        if (is_slow(model, r)) {
            const double *A = frame_of(model, r, 0)->A;
            find_places(model, r, middle, stretch);
            se3di_mul_transposed(A, r->normal, c->marks + PARTS * k);
            se3di_mul_transposed(A, stretch, c->marks + PARTS * k + 3);
        }
    }
    return SE3D_OK;
}

/* By how much the bodies have turned on each other since the record, and how they are now. */
static double turn_since(const se3di_model *model, const se3di_body_contact *r, double now[4])
{
    const double *pi = frame_of(model, r, 0)->p;
    const double back[4] = {pi[0], -pi[1], -pi[2], -pi[3]};
    double less = 0.0, more = 0.0;
    se3di_quat_mul(back, frame_of(model, r, 1)->p, now);
    for (int k = 0; k < 4; ++k) {
        less += (now[k] - r->turn[k]) * (now[k] - r->turn[k]);
        more += (now[k] + r->turn[k]) * (now[k] + r->turn[k]);
    }
    return 2.0 * sqrt(fmin(less, more));
}

/* The contact at the end of the step. */
static void follow(const se3di_model *model, const se3di_body_contact *r, const double *mark,
                   se3di_body_contact *out)
{
    const double *A = frame_of(model, r, 0)->A;
    const double reach = fmin(model->shapes[r->shape_i].bound, model->shapes[r->shape_j].bound);
    double stretch[3], before[3];
    *out = *r;
    find_places(model, r, out->point, stretch);
    se3di_mul(A, mark, out->normal);
    se3di_mul(A, mark + 3, before);
    se3di_sub(stretch, before, stretch);
    out->overlap -= se3di_dot(stretch, out->normal);
    out->moved += se3di_norm(stretch) + reach * turn_since(model, r, out->turn);
}

static int is_pair(const se3di_body_contact *a, const se3di_body_contact *b)
{
    return a->shape_i == b->shape_i && a->shape_j == b->shape_j;
}

/* All contacts of a pair of shapes, or none of them. */
static size_t follow_pair(se3di_convex *c, const se3di_model *model, size_t first)
{
    const se3di_body_contact *list = model->contacts.list;
    const size_t kept = c->followed_count;
    int holds = is_slow(model, &list[first]) &&
                !se3di_contact_is_frozen(model, list[first].shape_i, list[first].shape_j);
    double least = HUGE_VAL, most = 0.0;
    size_t k = first;
    for (; k < model->contacts.count && is_pair(&list[first], &list[k]); ++k) {
        holds = holds && list[k].kind == SE3DI_CONTACT_STEPPED;
        if (holds) {
            se3di_body_contact *out = &c->followed[c->followed_count++];
            follow(model, &list[k], c->marks + PARTS * k, out);
            least = fmin(least, out->overlap);
            most = fmax(most, out->moved);
        }
    }
    if (!holds || !(most < HELD * least)) {
        c->followed_count = kept;
    }
    return k;
}

void se3di_convex_follow(se3di_convex *c, const se3di_model *model)
{
    c->followed_count = 0;
    for (size_t k = 0; k < model->contacts.count;) {
        k = follow_pair(c, model, k);
    }
}
