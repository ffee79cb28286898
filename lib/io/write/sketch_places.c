/* SPDX-License-Identifier: BSD-3-Clause */
/* The places on its sheet of all that a sketch shows. */
#include "io/write/sketch_sheet.h"

#include <math.h>
#include <string.h>

/* [px] */
#define MARGIN 60.0
#define TITLE  24.0

/* A body of more shapes is put together of them: its links say more. */
enum { SHAPES_MAX = 40 };

static void get_end(const se3di_sketch *s, const se3di_element_entry *entry, bool is_j, double r[3])
{
    const size_t k = se3di_drawing_find_body(s->model, is_j ? entry->body_j : entry->body_i);
    se3di_drawing_to_ground(s->poses + SE3DI_POSE * k, is_j ? entry->point_j : entry->point_i, r);
}

se3di_spot se3di_sketch_spot_of(const se3di_sketch *s, const se3di_element_entry *entry, bool is_j)
{
    double r[3];
    get_end(s, entry, is_j, r);
    return se3di_sketch_project(&s->view, r);
}

static void widen(const se3di_sketch *s, const double r[3], double low[2], double high[2])
{
    const se3di_spot p = se3di_sketch_project(&s->view, r);
    low[0] = fmin(low[0], p.x);
    low[1] = fmin(low[1], p.y);
    high[0] = fmax(high[0], p.x);
    high[1] = fmax(high[1], p.y);
}

void se3di_sketch_get_link_end(const se3di_sketch *s, size_t body, const se3di_part *part, int end,
                               double r[3])
{
    const double at[3] = {0.0, 0.0, (end - 0.5) * part->scale[2]};
    double placed[SE3DI_POSE];
    memcpy(placed, part->position, sizeof part->position);
    memcpy(placed + 3, part->orientation, sizeof part->orientation);
    se3di_drawing_to_ground(placed, at, r);
    se3di_drawing_to_ground(s->poses + SE3DI_POSE * body, r, r);
}

void se3di_sketch_list_looks(se3di_sketch *s)
{
    se3di_poses poses = {s->poses, s->model->body_count, 1, NULL};
    for (size_t body = 0; body < s->model->body_count; ++body) {
        se3di_drawn *of = &s->looks[body];
        se3di_lister lister = {.model = s->model,
                               .pool = &s->pool,
                               .parts = &of->shapes,
                               .sizes = &s->sizes,
                               .poses = &poses,
                               .body = body};
        for (size_t k = 0; k < s->model->shape_count; ++k) {
            const se3di_shape_entry *entry = &s->model->shapes[k];
            const bool has_ends =
                entry->shape.type != SE3D_SHAPE_PLANE && !(entry->mesh && entry->mesh->heights);
            if (has_ends && se3di_drawing_is_body(s->model, body, entry->shape.body)) {
                se3di_lister_add_shape(&lister, entry);
            }
        }
        lister.unmarked = of->shapes.count > 0;
        lister.parts = &of->links;
        if (body > 0) {
            se3di_lister_add_links(&lister, true);
        }
        of->shapes.count = of->shapes.count > SHAPES_MAX ? 0 : of->shapes.count;
        s->failed = s->failed || lister.failed;
    }
}

void se3di_sketch_put_shapes(se3di_sketch *s, size_t body, FILE *file, double low[2],
                             double high[2])
{
    const se3di_parts *shapes = &s->looks[body].shapes;
    for (size_t k = 0; k < shapes->count; ++k) {
        s->failed = !se3di_sketch_put_shape(file, &s->view, s->poses + SE3DI_POSE * body,
                                            &shapes->list[k], &s->pool, low, high) ||
                    s->failed;
    }
}

/* The box around all that is drawn. */
static void enclose(se3di_sketch *s, double low[2], double high[2])
{
    double r[3];
    for (size_t k = 0; k < s->model->body_count; ++k) {
        const se3di_parts *links = &s->looks[k].links;
        widen(s, s->poses + SE3DI_POSE * k, low, high);
        se3di_sketch_put_shapes(s, k, NULL, low, high);
        for (size_t p = 0; p < links->count; ++p) {
            for (int end = 0; links->list[p].unit == SE3DI_UNIT_CYLINDER && end < 2; ++end) {
                se3di_sketch_get_link_end(s, k, &links->list[p], end, r);
                widen(s, r, low, high);
            }
        }
    }
    for (size_t e = 0; e < s->model->element_count; ++e) {
        for (int j = 0; s->model->elements[e].drawn > 0 && j < 2; ++j) {
            get_end(s, &s->model->elements[e], j == 1, r);
            widen(s, r, low, high);
        }
    }
}

void se3di_sketch_fit(se3di_sketch *s)
{
    double low[2] = {HUGE_VAL, HUGE_VAL};
    double high[2] = {-HUGE_VAL, -HUGE_VAL};
    s->view.scale = 1.0;
    s->view.origin = (se3di_spot){0.0, 0.0};
    enclose(s, low, high);
    const double wide = high[0] - low[0];
    const double tall = high[1] - low[1];
    const double least = 1e-9 * s->sizes.extent;
    const double x = wide > least ? (s->width - 2.0 * MARGIN) / wide : HUGE_VAL;
    const double y = tall > least ? (s->height - 2.0 * MARGIN - TITLE) / tall : HUGE_VAL;
    s->view.scale = fmin(x, y) < HUGE_VAL ? fmin(x, y) : 100.0;
    s->view.origin.x = 0.5 * s->width - 0.5 * (low[0] + high[0]) * s->view.scale;
    s->view.origin.y = 0.5 * (s->height + TITLE) - 0.5 * (low[1] + high[1]) * s->view.scale;
}
