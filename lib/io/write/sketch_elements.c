/* SPDX-License-Identifier: BSD-3-Clause */
/* The joints and force elements of a sketch: symbols, letters, and words for all. */
#include "io/write/sketch_sheet.h"

#include <math.h>

#include "io/document/document.h"

/* A, B, ..., Z, AA, ... */
static void make_letter(size_t k, char out[8])
{
    char back[8];
    size_t length = 0;
    for (++k; k > 0 && length < 6; k = (k - 1) / 26) {
        back[length++] = (char)('A' + (k - 1) % 26);
    }
    for (size_t i = 0; i < length; ++i) {
        out[i] = back[length - 1 - i];
    }
    out[length] = '\0';
}

static const char *type_of(const se3di_element_entry *entry)
{
    const se3di_node *type = entry->node ? se3di_node_get(entry->node, "type") : NULL;
    return type && type->text ? type->text : "";
}

static bool is_ground(const se3di_sketch *s, se3d_body body)
{
    int32_t fixed = 0;
    return se3di_drawing_is_body(s->model, 0, body) ||
           (se3d_body_get_fixed(s->model->system, body, &fixed) >= 0 && fixed);
}

static bool has_symbol(const se3di_element_entry *entry)
{
    return se3di_joint_get_look(entry) != SE3DI_JOINT_NONE;
}

/* A, B, ... in the order of the file. */
static void get_letter(const se3di_sketch *s, const se3di_element_entry *entry, char letter[8])
{
    size_t count = 0;
    for (const se3di_element_entry *e = s->model->elements; e < entry; ++e) {
        count += has_symbol(e);
    }
    make_letter(count, letter);
}

/* Letters of joints that are one place stand in a row. */
static void put_letter(se3di_sketch *s, se3di_spot at, double away, const char *letter)
{
    int beside = 0;
    for (size_t k = 0; k < s->joint_count; ++k) {
        beside += fabs(s->joints[k].x - at.x) < 14.0 && fabs(s->joints[k].y - at.y) < 12.0;
    }
    s->joints[s->joint_count++] = at;
    se3di_svg_text(s->file, "letter", (se3di_spot){at.x + 9.0 + away + 13.0 * beside, at.y - 10.0},
                   letter);
}

static bool is_driven(const se3di_sketch *s, const se3di_element_entry *joint)
{
    for (size_t e = 0; e < s->model->element_count; ++e) {
        const se3di_element_entry *entry = &s->model->elements[e];
        if (entry->kind == SE3DI_ELEMENT_DRIVER &&
            entry->driven.index1 == joint->constraint.index1) {
            return true;
        }
    }
    return false;
}

static se3di_symbol make_symbol(const se3di_sketch *s, const se3di_element_entry *entry)
{
    double axis[3];
    se3di_symbol symbol = {s->file, se3di_sketch_spot_of(s, entry, true), {0.0, -1.0}, 1.0};
    se3di_sketch_get_axis(s->model, s->poses, entry, axis);
    double x = 0.0;
    double y = 0.0;
    double size = 0.0;
    for (int c = 0; c < 3; ++c) {
        x += s->view.right[c] * axis[c];
        y -= s->view.up[c] * axis[c];
        size += axis[c] * axis[c];
    }
    if (size > 0.0) {
        symbol.seen = sqrt(x * x + y * y);
        if (symbol.seen > 1e-9) {
            symbol.along = (se3di_spot){x / symbol.seen, y / symbol.seen};
        }
    }
    return symbol;
}

static void tell_joint(se3di_sketch *s, const se3di_element_entry *entry)
{
    char name[SE3DI_SKETCH_TEXT];
    char letter[8] = "-";
    size_t equations = 0;
    (void)se3d_constraint_count_equations(s->model->system, entry->constraint, &equations);
    se3di_sketch_shorten(entry->name, name);
    if (has_symbol(entry)) {
        get_letter(s, entry, letter);
        se3di_sketch_add_line(s, "%s  %s: %s %zu-%zu, leaves %d", letter, name, type_of(entry),
                              se3di_drawing_find_body(s->model, entry->body_i),
                              se3di_drawing_find_body(s->model, entry->body_j), 6 - (int)equations);
    } else {
        se3di_sketch_add_line(s, "%s  %s: %s, takes %zu", letter, name, type_of(entry), equations);
    }
}

static void put_joint(se3di_sketch *s, const se3di_element_entry *entry)
{
    char letter[8];
    char kind[60];
    const se3di_joint_look look = se3di_joint_get_look(entry);
    const se3di_symbol symbol = make_symbol(s, entry);
    const se3di_spot first = se3di_sketch_spot_of(s, entry, false);
    snprintf(kind, sizeof kind, "joint %.40s", type_of(entry));
    se3di_svg_open(s->file, kind, entry->name);
    if (is_ground(s, entry->body_i) || is_ground(s, entry->body_j)) {
        se3di_symbol_put_ground(s->file, is_ground(s, entry->body_i) ? first : symbol.at);
    }
    if (se3di_drawing_count_between(entry) > 0) {
        se3di_svg_line(s->file, "link", first, symbol.at);
        se3di_svg_circle(s->file, "open", first, 5.0);
    }
    se3di_symbol_put_joint(&symbol, look);
    if (is_driven(s, entry)) {
        se3di_symbol_put_driver(s->file, symbol.at);
    }
    get_letter(s, entry, letter);
    put_letter(s, symbol.at, is_driven(s, entry) ? 10.0 : 0.0, letter);
    se3di_svg_close(s->file);
}

/* What is large first, so that nothing is hidden. */
void se3di_sketch_put_joints(se3di_sketch *s)
{
    for (int pass = 0; pass < 2; ++pass) {
        for (size_t e = 0; e < s->model->element_count; ++e) {
            const se3di_joint_look look = se3di_joint_get_look(&s->model->elements[e]);
            const bool is_large = look == SE3DI_JOINT_SLIDER || look == SE3DI_JOINT_SLEEVE ||
                                  look == SE3DI_JOINT_SCREW || look == SE3DI_JOINT_PLATE;
            if (look != SE3DI_JOINT_NONE && is_large == (pass == 0)) {
                put_joint(s, &s->model->elements[e]);
            }
        }
    }
}

static void put_between(const se3di_sketch *s, const se3di_element_entry *entry)
{
    const se3di_spot a = se3di_sketch_spot_of(s, entry, false);
    const se3di_spot b = se3di_sketch_spot_of(s, entry, true);
    const size_t count = se3di_drawing_count_between(entry); /* 1: a spring, 2: a damper, 3: both */
    se3di_svg_open(s->file, "force tsda", entry->name);
    if (is_ground(s, entry->body_i) || is_ground(s, entry->body_j)) {
        se3di_symbol_put_ground(s->file, is_ground(s, entry->body_i) ? a : b);
    }
    if (count != 2) {
        se3di_symbol_put_spring(s->file, a, b, count == 3 ? -8.0 : 0.0);
    }
    if (count >= 2) {
        se3di_symbol_put_damper(s->file, a, b, count == 3 ? 8.0 : 0.0);
    }
    se3di_svg_close(s->file);
}

void se3di_sketch_put_elements(se3di_sketch *s)
{
    static const char *const heads[SE3DI_ELEMENT_KINDS] = {
        "Joints", "Constraints", "Drivers", "Forces", "Wheels", "States", "Roads"};
    char name[SE3DI_SKETCH_TEXT];
    for (int kind = SE3DI_ELEMENT_JOINT; kind < SE3DI_ELEMENT_KINDS; ++kind) {
        bool any = false;
        for (size_t e = 0; e < s->model->element_count; ++e) {
            const se3di_element_entry *entry = &s->model->elements[e];
            if ((int)entry->kind != kind) {
                continue;
            }
            if (!any) {
                se3di_sketch_add_line(s, "#%s", heads[kind]);
                any = true;
            }
            if (kind == SE3DI_ELEMENT_JOINT || kind == SE3DI_ELEMENT_CONSTRAINT) {
                tell_joint(s, entry);
                continue;
            }
            if (kind == SE3DI_ELEMENT_FORCE && entry->drawn == 3) {
                put_between(s, entry);
            }
            se3di_sketch_shorten(entry->name, name);
            se3di_sketch_add_line(s, "-  %s%s%s", name, type_of(entry)[0] ? ": " : "",
                                  type_of(entry));
        }
    }
}
