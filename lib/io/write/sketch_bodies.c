/* SPDX-License-Identifier: BSD-3-Clause */
/* The bodies of a sketch: outlines, links, frames, numbers. */
#include "io/write/sketch_sheet.h"

#include <math.h>

/* The axes of a frame, as far as they are seen. */
static void put_frame(const se3di_sketch *s, size_t body)
{
    static const char *const kinds[3] = {"thin x", "thin y", "thin z"};
    const double *pose = s->poses + SE3DI_POSE * body;
    const se3di_spot at = se3di_sketch_project(&s->view, pose);
    const double length = (body == 0 ? 34.0 : 20.0) / s->view.scale;
    for (int i = 0; i < 3; ++i) {
        const char name[2] = {"xyz"[i], '\0'};
        double tip[3] = {0.0, 0.0, 0.0};
        tip[i] = length;
        se3di_drawing_to_ground(pose, tip, tip);
        const se3di_spot end = se3di_sketch_project(&s->view, tip);
        se3di_svg_line(s->file, kinds[i], at, end);
        if (body == 0 && fabs(end.x - at.x) + fabs(end.y - at.y) > 6.0) {
            se3di_svg_text(s->file, "small",
                           (se3di_spot){at.x + 1.25 * (end.x - at.x) - 3.0,
                                        at.y + 1.25 * (end.y - at.y) + 4.0},
                           name);
        }
    }
}

/* Colours as in scenes. */
static const char *kind_of(size_t body)
{
    static const char *const kinds[7] = {"link b0", "link b1", "link b2", "link b3",
                                         "link b4", "link b5", "link b6"};
    return kinds[(body - 1) % 7];
}

/* The links of a body. @return how many, and the middle of the longest one. */
static size_t put_links(const se3di_sketch *s, size_t body, se3di_spot *middle)
{
    const se3di_parts *parts = &s->looks[body].links;
    size_t count = 0;
    double longest = 0.0;
    for (size_t k = 0; k < parts->count; ++k) {
        se3di_spot ends[2];
        if (parts->list[k].unit != SE3DI_UNIT_CYLINDER) {
            continue; /* the round end of a bar */
        }
        for (int i = 0; i < 2; ++i) {
            double at[3];
            se3di_sketch_get_link_end(s, body, &parts->list[k], i, at);
            ends[i] = se3di_sketch_project(&s->view, at);
        }
        se3di_svg_line(s->file, kind_of(body), ends[0], ends[1]);
        ++count;
        const double length = fabs(ends[1].x - ends[0].x) + fabs(ends[1].y - ends[0].y);
        if (length > longest) {
            longest = length;
            *middle = (se3di_spot){0.5 * (ends[0].x + ends[1].x), 0.5 * (ends[0].y + ends[1].y)};
        }
    }
    return count;
}

/* From the joints of a body with one place to its centre of mass. */
static void put_arms(const se3di_sketch *s, size_t body, se3di_spot center)
{
    for (size_t e = 0; e < s->model->element_count; ++e) {
        const se3di_element_entry *entry = &s->model->elements[e];
        for (int j = 0; entry->drawn > 0 && j < 2; ++j) {
            if (se3di_drawing_is_body(s->model, body, j ? entry->body_j : entry->body_i)) {
                se3di_svg_line(s->file, kind_of(body), se3di_sketch_spot_of(s, entry, j == 1),
                               center);
            }
        }
    }
}

static void put_body(se3di_sketch *s, size_t body)
{
    const se3di_body_entry *entry = &s->model->bodies[body];
    const se3di_spot center = se3di_sketch_project(&s->view, s->poses + SE3DI_POSE * body);
    se3di_spot middle = center;
    char number[24];
    char name[SE3DI_SKETCH_TEXT];
    double mass = 0.0;
    snprintf(number, sizeof number, "%zu", body);
    se3di_sketch_shorten(entry->name, name);
    se3di_svg_open(s->file, "body", entry->name);
    se3di_spot at = {-15.0, -13.0}; /* the number, from the middle */
    if (put_links(s, body, &middle) > 0) {
        at = (se3di_spot){13.0, 15.0};
    } else {
        put_arms(s, body, center);
    }
    put_frame(s, body);
    se3di_svg_circle(s->file, "open", center, 3.0);
    at.x += middle.x;
    at.y += middle.y;
    se3di_svg_circle(s->file, "open", at, 8.5);
    se3di_svg_text(s->file, "number", (se3di_spot){at.x, at.y + 4.0}, number);
    se3di_svg_close(s->file);
    (void)se3d_body_get_mass(s->model->system, entry->body, &mass, NULL);
    se3di_sketch_add_line(s, "%zu  %s, %.4g kg", body, name, mass);
}

void se3di_sketch_put_bodies(se3di_sketch *s)
{
    se3di_sketch_add_line(s, "#Bodies");
    se3di_sketch_add_line(s, "0  ground");
    double low[2] = {0.0, 0.0}; /* not used any more */
    double high[2] = {0.0, 0.0};
    for (size_t k = 0; k < s->model->body_count; ++k) {
        if (s->looks[k].shapes.count > 0) { /* below all else */
            se3di_svg_open(s->file, "shape", s->model->bodies[k].name);
            se3di_sketch_put_shapes(s, k, s->file, low, high);
            se3di_svg_close(s->file);
        }
    }
    se3di_svg_open(s->file, "ground", "ground");
    put_frame(s, 0);
    se3di_svg_close(s->file);
    for (size_t k = 1; k < s->model->body_count; ++k) {
        put_body(s, k);
    }
}
