/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies as links: bars between the places of a body, so that an A-arm is an A.
 *
 * Of a body without shapes the places are its joints, the ends of its springs and rods, and its
 * markers. Seen along the direction in which they are flattest, the bars follow the outline (the
 * convex hull in that plane); every place within it gets a bar to the nearest one. Of a body with
 * shapes only what lies beside them gets a bar, to the shape or a bar that is nearer. */
#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/write/drawing_part.h"

typedef struct place {
    double r[3];
    double flat[2];  /* in the plane */
    double near[3];  /* the nearest point of what is drawn so far, */
    double distance; /* its distance */
    bool done;
} place;

typedef struct web {
    se3di_lister *l;
    place *places;
    size_t count, capacity;
    double size; /* of the box around them */
} web;

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static void add_place(web *w, const double r[3])
{
    for (size_t k = 0; k < w->count; ++k) {
        if (distance(w->places[k].r, r) <= 0.3 * w->l->sizes->radius) {
            return;
        }
    }
    place *grown = se3di_iopool_grow(w->l->pool, w->places, w->count, &w->capacity, sizeof *grown);
    if (!grown) {
        w->l->failed = true;
        return;
    }
    memset(&grown[w->count], 0, sizeof *grown);
    w->places = grown;
    w->places[w->count].distance = HUGE_VAL;
    memcpy(w->places[w->count++].r, r, 3 * sizeof *r);
}

/* Joints and ends of springs of the body, and its markers if there is nothing else of it. */
static void find_places(web *w, bool bare)
{
    const se3d_model *model = w->l->model;
    const size_t k = w->l->body;
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const bool is_i = se3di_drawing_is_body(model, k, entry->body_i);
        const bool is_j = se3di_drawing_is_body(model, k, entry->body_j);
        if ((!is_i && !is_j) || (se3di_joint_get_look(entry) == SE3DI_JOINT_NONE &&
                                 se3di_drawing_count_between(entry) == 0)) {
            continue;
        }
        if (is_i) {
            add_place(w, entry->point_i);
        }
        if (is_j) {
            add_place(w, entry->point_j);
        }
    }
    for (size_t m = 0; m < model->marker_count && bare && !w->l->unmarked; ++m) {
        if (model->markers[m].body == k) {
            add_place(w, model->markers[m].position);
        }
    }
}

/* Note that something is drawn from `a` to `b`. */
static void come_near(web *w, const double a[3], const double b[3])
{
    const double square = distance(a, b) * distance(a, b);
    for (size_t k = 0; k < w->count; ++k) {
        place *p = &w->places[k];
        double at[3];
        double part = 0.0;
        for (int i = 0; i < 3 && square > 0.0; ++i) {
            part += (p->r[i] - a[i]) * (b[i] - a[i]) / square;
        }
        for (int i = 0; i < 3; ++i) {
            at[i] = a[i] + fmin(1.0, fmax(0.0, part)) * (b[i] - a[i]);
        }
        if (!p->done && distance(at, p->r) < p->distance) {
            p->distance = distance(at, p->r);
            memcpy(p->near, at, sizeof at);
        }
    }
}

/* A bar with round ends. */
static void add_bar(web *w, const double a[3], const double b[3])
{
    se3di_lister *l = w->l;
    const double r = 0.7 * l->sizes->radius;
    se3di_part bar = se3di_part_make("link", SE3DI_UNIT_CYLINDER, l->usual);
    se3di_part end = se3di_part_make("link", SE3DI_UNIT_SPHERE, l->usual);
    se3di_part_span(&bar, a, b, r);
    se3di_part_stretch(&end, r, r, r);
    se3di_lister_add(l, &bar);
    memcpy(end.position, a, sizeof end.position);
    se3di_lister_add(l, &end);
    come_near(w, a, b);
}

/* Join all places that are not yet, the nearest first. */
static void join_rest(web *w)
{
    for (;;) {
        place *next = NULL;
        for (size_t k = 0; k < w->count; ++k) {
            place *p = &w->places[k];
            if (!p->done && p->distance < HUGE_VAL && (!next || p->distance < next->distance)) {
                next = p;
            }
        }
        if (!next || w->l->failed) {
            return;
        }
        next->done = true;
        if (next->distance > w->l->sizes->radius) {
            add_bar(w, next->r, next->near);
        } else {
            come_near(w, next->r, next->r);
        }
    }
}

/* The axes in the plane of the places: the two longest of their covariance, by turning about the
 * third (Jacobi's rotations). */
static void find_plane(const web *w, const double middle[3], double axes[9])
{
    double C[9] = {0.0};
    double V[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    for (size_t k = 0; k < w->count; ++k) {
        for (int i = 0; i < 9; ++i) {
            C[i] +=
                (w->places[k].r[i / 3] - middle[i / 3]) * (w->places[k].r[i % 3] - middle[i % 3]);
        }
    }
    for (int turn = 0; turn < 24; ++turn) {
        const int p = turn % 3 == 2 ? 1 : 0;
        const int q = turn % 3 == 0 ? 1 : 2;
        const double angle = 0.5 * io_atan2(2.0 * C[3 * p + q], C[3 * q + q] - C[3 * p + p]);
        const double c = io_cos(angle);
        const double s = io_sin(angle);
        for (int i = 0; i < 3; ++i) {
            const double a = C[3 * i + p];
            const double b = C[3 * i + q];
            const double u = V[3 * i + p];
            const double v = V[3 * i + q];
            C[3 * i + p] = c * a - s * b;
            C[3 * i + q] = s * a + c * b;
            V[3 * i + p] = c * u - s * v;
            V[3 * i + q] = s * u + c * v;
        }
        for (int i = 0; i < 3; ++i) {
            const double a = C[3 * p + i];
            const double b = C[3 * q + i];
            C[3 * p + i] = c * a - s * b;
            C[3 * q + i] = s * a + c * b;
        }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 3; ++i) {
        for (int j = i + 1; j < 3; ++j) {
            if (C[4 * order[j]] > C[4 * order[i]]) {
                const int held = order[i];
                order[i] = order[j];
                order[j] = held;
            }
        }
    }
    for (int i = 0; i < 9; ++i) {
        axes[i] = V[3 * (i % 3) + order[i / 3]];
    }
}

/* > 0: `c` is to the left of the way from `a` to `b`. */
static double side_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* The place after `from` on the outline, which has all others on its left. */
static size_t get_next(const web *w, size_t from)
{
    const double *a = w->places[from].flat;
    size_t best = from == 0 ? 1 : 0;
    for (size_t k = 0; k < w->count; ++k) {
        const double *b = w->places[best].flat;
        const double *c = w->places[k].flat;
        const double side = side_of(a, b, c);
        const double far_b = io_hypot(b[0] - a[0], b[1] - a[1]);
        const double far_c = io_hypot(c[0] - a[0], c[1] - a[1]);
        const double flat = 1e-9 * w->size * w->size;
        if (k != from && (side < -flat || (side <= flat && far_c > far_b))) {
            best = k;
        }
    }
    return best;
}

/* Bars along the outline of the places. @return false: they are on a line, or not enough. */
static bool add_outline(web *w)
{
    double middle[3] = {0.0, 0.0, 0.0};
    double axes[9];
    double width = 0.0;
    size_t first = 0;
    for (size_t k = 0; k < w->count; ++k) {
        for (int i = 0; i < 3; ++i) {
            middle[i] += w->places[k].r[i] / (double)w->count;
        }
    }
    find_plane(w, middle, axes);
    for (size_t k = 0; k < w->count; ++k) {
        place *p = &w->places[k];
        for (int i = 0; i < 2; ++i) {
            p->flat[i] = 0.0;
            for (int j = 0; j < 3; ++j) {
                p->flat[i] += axes[3 * i + j] * (p->r[j] - middle[j]);
            }
        }
        width = fmax(width, fabs(p->flat[1]));
        const double before = p->flat[0] - w->places[first].flat[0];
        const double same = 1e-9 * w->size;
        if (before < -same || (before <= same && p->flat[1] < w->places[first].flat[1])) {
            first = k; /* a corner, also where several are the first */
        }
    }
    if (w->count < 3 || width < 2.0 * w->l->sizes->radius) {
        return false;
    }
    size_t at = first;
    for (size_t k = 0; k < w->count; ++k) {
        const size_t next = get_next(w, at);
        const bool closed = next == first || w->places[next].done;
        w->places[at].done = w->places[next].done = true;
        add_bar(w, w->places[at].r, w->places[next].r);
        at = next;
        if (closed) {
            break;
        }
    }
    return true;
}

static void add_centre(se3di_lister *l, double radius)
{
    se3di_part ball = se3di_part_make("center", SE3DI_UNIT_SPHERE, l->usual);
    se3di_part_stretch(&ball, radius, radius, radius);
    se3di_lister_add(l, &ball);
}

/* A body without shapes: what all its places span; its centre of mass where they do not. */
static void add_frame(web *w)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    const double ball = w->count == 0 ? 0.04 * w->l->sizes->extent : 2.0 * w->l->sizes->radius;
    double reach = 0.0;
    for (size_t k = 0; k < w->count; ++k) {
        reach = fmax(reach, distance(w->places[k].r, origin));
        w->size = fmax(w->size, distance(w->places[k].r, w->places[0].r));
    }
    if (w->count > 0 && !add_outline(w)) {
        w->places[0].done = true;
        come_near(w, w->places[0].r, w->places[0].r);
    }
    join_rest(w);
    if (w->count < 2 || reach > 1.2 * w->size) { /* the mass is not where the places are */
        add_place(w, origin);
        for (size_t k = 0; k + 1 < w->count; ++k) {
            double *r = w->places[k].r;
            come_near(w, r, r);
        }
        join_rest(w);
        add_centre(w->l, ball);
    }
}

/* What the shapes leave out. */
static void add_arms(web *w)
{
    const se3d_model *model = w->l->model;
    for (size_t s = 0; s < model->shape_count; ++s) {
        const se3di_shape_entry *entry = &model->shapes[s];
        if (!se3di_drawing_is_body(model, w->l->body, entry->shape.body)) {
            continue;
        }
        for (size_t k = 0; k < w->count; ++k) {
            double near[3];
            const double far = se3di_shape_reach(entry, w->places[k].r, near);
            if (far < w->places[k].distance) {
                w->places[k].distance = far;
                memcpy(w->places[k].near, near, sizeof near);
            }
        }
    }
    join_rest(w);
}

void se3di_lister_add_links(se3di_lister *l, bool bare)
{
    web w = {l, NULL, 0, 0, 0.0};
    find_places(&w, bare);
    if (bare) {
        add_frame(&w);
    } else {
        add_arms(&w);
    }
}
