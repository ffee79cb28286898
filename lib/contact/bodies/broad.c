/* SPDX-License-Identifier: BSD-3-Clause */
/* Pairs of shapes whose bounds, larger by a margin, overlap are listed by sweep and prune along x;
 * the list holds as long as no shape has moved by half the margin. A visit that finds more movement
 * (a long step, or no list) looks at all pairs instead, in the same order, with the same result. */
#include "contact/bodies/broad.h"

#include "contact/bodies/body_contacts.h"
#include "contact/bodies/joined.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define MARGIN  0.3          /* of the smallest bound */
#define CLEARLY (1.0 + 1e-9) /* of a square: beyond any rounding */

static void center_of(const se3di_model *model, uint32_t shape, double x[3])
{
    const se3di_shape *s = &model->shapes[shape];
    const se3di_frame *frame = &model->frames[s->body];
    if (s->x[0] == 0.0 && s->x[1] == 0.0 && s->x[2] == 0.0) {
        se3di_copy(frame->r, x);
        return;
    }
    se3di_mul(frame->A, s->x, x);
    se3di_add(frame->r, x, x);
}

static int are_open_meshes(const se3di_shape *a, const se3di_shape *b)
{
    return se3di_shape_is(a, SE3DI_SHAPE_IS_SURFACE) && se3di_shape_is(b, SE3DI_SHAPE_IS_SURFACE) &&
           !se3di_narrow_is_known(a, b);
}

static int is_plane(const se3di_shape *s)
{
    return se3di_shape_is(s, SE3DI_SHAPE_IS_HALF_SPACE);
}

/* As far as it is the user's to say, but for joints. */
static int are_free_to_touch(const se3di_model *model, uint32_t a, uint32_t b)
{
    const se3di_shape *s = &model->shapes[a];
    const se3di_shape *t = &model->shapes[b];
    return s->body != t->body && se3di_shapes_meet(s, t) &&
           !(model->bodies[s->body].fixed && model->bodies[t->body].fixed);
}

static int are_meant_to_touch(const se3di_model *model, uint32_t a, uint32_t b)
{
    return are_free_to_touch(model, a, b) && !se3di_shapes_are_joined(model, a, b);
}

int se3di_shapes_may_touch(const se3di_model *model, uint32_t a, uint32_t b)
{
    return se3di_narrow_is_known(&model->shapes[a], &model->shapes[b]) &&
           are_meant_to_touch(model, a, b);
}

int se3di_shapes_pass_through(const se3di_model *model, uint32_t a, uint32_t b)
{
    return are_open_meshes(&model->shapes[a], &model->shapes[b]) && are_meant_to_touch(model, a, b);
}

/* For centres x, y of the shapes i, j. */
static double gap_bound(const se3di_model *model, uint32_t i, const double x[3], uint32_t j,
                        const double y[3])
{
    const se3di_shape *s[2] = {&model->shapes[i], &model->shapes[j]};
    double d[3];
    se3di_sub(y, x, d);
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *plane = s[k];
        if (is_plane(plane)) {
            const double up[3] = {plane->A[2], plane->A[5], plane->A[8]};
            double n[3];
            se3di_mul(model->frames[plane->body].A, up, n);
            return (k ? -1.0 : 1.0) * se3di_dot(n, d) - s[1 - k]->bound;
        }
    }
    return se3di_norm(d) - s[0]->bound - s[1]->bound;
}

double se3di_shapes_gap_bound(const se3di_model *model, uint32_t i, uint32_t j)
{
    double x[3], y[3];
    center_of(model, i, x);
    center_of(model, j, y);
    return gap_bound(model, i, x, j, y);
}

/* Find the pose of a shape. @return the shape */
static const se3di_shape *place(const se3di_model *model, uint32_t shape, se3di_shape_pose *at)
{
    const se3di_shape *s = &model->shapes[shape];
    se3di_shape_place(s, &model->frames[s->body], at);
    return s;
}

double se3di_shapes_gap(const se3di_model *model, uint32_t i, uint32_t j, double normal[3])
{
    se3di_shape_pose at[2];
    const se3di_shape *const s[2] = {place(model, i, &at[0]), place(model, j, &at[1])};
    return se3di_narrow_gap(s[0], &at[0], s[1], &at[1], normal);
}

int se3di_shapes_are_beyond(const se3di_model *model, uint32_t i, uint32_t j, double distance)
{
    se3di_shape_pose at[2];
    const se3di_shape *const s[2] = {place(model, i, &at[0]), place(model, j, &at[1])};
    return se3di_narrow_is_beyond(s[0], &at[0], s[1], &at[1], distance);
}

/* Never of one body: the planes of a drum would all be. */
static int near(const se3di_model *model, uint32_t i, uint32_t j, double margin)
{
    return model->shapes[i].body != model->shapes[j].body &&
           se3di_shapes_gap_bound(model, i, j) < margin;
}

/* The same where they were when the list was made. */
static int were_near(const se3di_model *model, uint32_t i, uint32_t j, double margin)
{
    const double *reference = model->contacts.reference;
    return model->shapes[i].body != model->shapes[j].body &&
           gap_bound(model, i, reference + 3 * (size_t)i, j, reference + 3 * (size_t)j) < margin;
}

/* The list of pairs covers the present poses, with a share of the margin left. */
static int list_holds(const se3di_model *model, double share)
{
    const se3di_body_contacts *c = &model->contacts;
    double room = share * share * c->margin * c->margin;
    if (c->version != model->topology_version) {
        return 0;
    }
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        double x[3], d[3];
        int plane = is_plane(&model->shapes[k]);
        if (plane && model->bodies[model->shapes[k].body].fixed) {
            continue;
        }
        center_of(model, k, x);
        se3di_sub(x, c->reference + 3 * (size_t)k, d);
        if (plane || !(se3di_dot(d, d) < room)) { /* planes that move are looked at always */
            return 0;
        }
    }
    return 1;
}

se3d_status se3di_broad_visit(const se3di_model *model, se3di_pair_visitor visitor, void *ctx)
{
    const se3di_body_contacts *c = &model->contacts;
    uint32_t shapes = (uint32_t)model->shape_slots.count;
    if (shapes < 2) {
        return SE3D_OK;
    }
    if (list_holds(model, 0.5)) {
        for (size_t k = 0; k < c->pair_count; ++k) {
            if (se3di_contact_is_frozen(model, c->pairs[2 * k], c->pairs[2 * k + 1]) ||
                near(model, c->pairs[2 * k], c->pairs[2 * k + 1], 0.0)) {
                SE3DI_TRY(visitor(ctx, c->pairs[2 * k], c->pairs[2 * k + 1]));
            }
        }
        return SE3D_OK;
    }
    for (uint32_t i = 0; i < shapes; ++i) {
        for (uint32_t j = i + 1; j < shapes; ++j) {
            if (near(model, i, j, 0.0) && se3di_shapes_may_touch(model, i, j)) {
                SE3DI_TRY(visitor(ctx, i, j));
            }
        }
    }
    return SE3D_OK;
}

/* The lower end of a shape along x. */
static double lower_end(const se3di_model *model, uint32_t shape)
{
    const se3di_shape *s = &model->shapes[shape];
    return is_plane(s) ? -HUGE_VAL : model->contacts.reference[3 * (size_t)shape] - s->bound;
}

/* Nearly sorted from the last time. */
static void sort_order(se3di_model *model, int fresh)
{
    uint32_t *order = model->contacts.order;
    uint32_t shapes = (uint32_t)model->shape_slots.count;
    for (uint32_t k = 0; k < shapes; ++k) {
        uint32_t at = k;
        uint32_t shape = fresh ? k : order[k];
        double low = lower_end(model, shape);
        for (; at > 0 && lower_end(model, order[at - 1]) > low; --at) {
            order[at] = order[at - 1];
        }
        order[at] = shape;
    }
}

static int is_before(const uint32_t *a, const uint32_t *b)
{
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

/* Let the pair at `root` sink in the heap of `count`. */
static void sink(uint32_t *pairs, size_t root, size_t count)
{
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        child += child + 1 < count && is_before(pairs + 2 * child, pairs + 2 * (child + 1));
        if (!is_before(pairs + 2 * root, pairs + 2 * child)) {
            return;
        }
        for (size_t k = 0; k < 2; ++k) {
            uint32_t t = pairs[2 * root + k];
            pairs[2 * root + k] = pairs[2 * child + k];
            pairs[2 * child + k] = t;
        }
        root = child;
    }
}

/* In place: the library's qsort may allocate. */
static void sort_pairs(uint32_t *pairs, size_t count)
{
    for (size_t k = count / 2; k > 0; --k) {
        sink(pairs, k - 1, count);
    }
    for (size_t last = count; last > 1; --last) {
        for (size_t k = 0; k < 2; ++k) {
            uint32_t t = pairs[k];
            pairs[k] = pairs[2 * (last - 1) + k];
            pairs[2 * (last - 1) + k] = t;
        }
        sink(pairs, 0, last - 1);
    }
}

static se3d_status add_pair(se3di_model *model, uint32_t a, uint32_t b)
{
    se3di_body_contacts *c = &model->contacts;
    void *pairs = c->pairs;
    se3d_status status = se3di_array_reserve(&model->allocator, &pairs, &c->pair_capacity,
                                             c->pair_count + 1, 2 * sizeof *c->pairs);
    c->pairs = pairs;
    SE3DI_TRY(status);
    c->pairs[2 * c->pair_count] = a < b ? a : b;
    c->pairs[2 * c->pair_count++ + 1] = a < b ? b : a;
    return SE3D_OK;
}

/* What the sweep reads of each shape, one after the other. */
static void line_up(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *s = &model->shapes[c->order[k]];
        double *at = c->swept + 4 * k;
        se3di_copy(c->reference + 3 * (size_t)c->order[k], at);
        at[3] = s->bound;
        if (is_plane(s)) { /* as wide as anything */
            at[0] = 0.0;
            at[3] = HUGE_VAL;
        }
    }
}

/* Clearly farther apart than `margin`. */
static int are_apart(const double *a, const double *b, double margin)
{
    const double reach = a[3] + b[3] + margin;
    double d[3];
    se3di_sub(b, a, d);
    return se3di_dot(d, d) > CLEARLY * (reach * reach);
}

/* As se3di_shapes_may_touch. */
static int may_touch(const se3di_model *model, uint32_t a, uint32_t b)
{
    return se3di_narrow_is_known(&model->shapes[a], &model->shapes[b]) &&
           are_free_to_touch(model, a, b) && !se3di_joints_keep_apart(model, a, b);
}

static se3d_status sweep(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    uint32_t shapes = (uint32_t)model->shape_slots.count;
    c->pair_count = 0;
    SE3DI_TRY(se3di_joints_gather(model));
    line_up(model);
    for (uint32_t k = 0; k < shapes; ++k) {
        const double *a = c->swept + 4 * (size_t)k, *b = a + 4;
        const double high = a[0] + a[3] + c->margin;
        for (uint32_t m = k + 1; m < shapes && !(b[0] - b[3] > high); ++m, b += 4) {
            if (!are_apart(a, b, c->margin) &&
                were_near(model, c->order[k], c->order[m], c->margin) &&
                may_touch(model, c->order[k], c->order[m])) {
                SE3DI_TRY(add_pair(model, c->order[k], c->order[m]));
            }
        }
    }
    sort_pairs(c->pairs, c->pair_count);
    return SE3D_OK;
}

static se3d_status reserve(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    const se3d_allocator *allocator = &model->allocator;
    const size_t shapes = model->shape_slots.count;
    SE3DI_TRY(se3di_array_reserve_at(allocator, &c->reference, &c->reference_capacity, shapes,
                                     3 * sizeof *c->reference));
    SE3DI_TRY(
        se3di_array_reserve_at(allocator, &c->order, &c->order_capacity, shapes, sizeof *c->order));
    return se3di_array_reserve_at(allocator, &c->swept, &c->swept_capacity, shapes,
                                  4 * sizeof *c->swept);
}

se3d_status se3di_broad_update(se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    int fresh = c->version != model->topology_version;
    if (list_holds(model, 0.25)) {
        return SE3D_OK;
    }
    c->version = 0;
    SE3DI_TRY(reserve(model));
    double least = HUGE_VAL;
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        center_of(model, k, c->reference + 3 * (size_t)k);
        least = model->shapes[k].bound > 0.0 ? fmin(least, model->shapes[k].bound) : least;
    }
    c->margin = least < HUGE_VAL ? MARGIN * least : 0.0;
    sort_order(model, fresh);
    SE3DI_TRY(sweep(model));
    c->version = model->topology_version;
    return SE3D_OK;
}
