/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/sketch.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/write/drawing.h"
#include "io/write/sketch_view.h"

/* [px] */
#define WIDTH  760.0
#define HEIGHT 560.0
#define MARGIN 60.0
#define TITLE  24.0
#define LEGEND 330.0 /* of a column */
#define LINE   16.0

enum { LINES_MAX = 240, ROWS_USUAL = 48, COLUMNS_MAX = 4, TEXT_SIZE = 300, NAME_MAX_LENGTH = 28 };
/* A body of more shapes is put together of them: its links say more. */
enum { SHAPES_MAX = 40 };

/* What is drawn of a body: links, and given shapes with ends. */
typedef struct drawn {
    se3di_parts links, shapes;
} drawn;

typedef struct sketch {
    const se3d_model *model;
    FILE *file;
    se3di_iopool pool;
    double *poses;
    drawn *looks; /* [body_count] */
    se3di_sizes sizes;
    se3di_sketch_view view;
    double width, height; /* of the picture without its legend [px] */
    size_t rows;          /* of a column of the legend */
    se3di_spot *joints;   /* [joint_count] where letters stand */
    size_t joint_count;
    char (*lines)[TEXT_SIZE]; /* of the legend; one that begins with # is a heading */
    size_t line_count, lines_left_out;
    bool failed; /* out of memory */
} sketch;

/* ---- texts ----------------------------------------------------------------------------------*/

/* A name that is cut if it is long. */
static void shorten(const char *name, char out[TEXT_SIZE])
{
    size_t used = 0;
    for (int k = 0; k < NAME_MAX_LENGTH && *name; ++k) {
        const size_t length = se3d_text_get_character(name);
        const size_t taken = length > 0 ? length : 1;
        memcpy(out + used, name, taken);
        used += taken;
        name += taken;
    }
    snprintf(out + used, TEXT_SIZE - used, "%s", *name ? "..." : "");
}

SE3DI_IO_FORMAT(2, 3)
static void add_line(sketch *s, const char *format, ...)
{
    va_list arguments;
    if (s->line_count == LINES_MAX) {
        ++s->lines_left_out;
        return;
    }
    va_start(arguments, format);
    vsnprintf(s->lines[s->line_count++], TEXT_SIZE, format, arguments);
    va_end(arguments);
}

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

/* ---- places ---------------------------------------------------------------------------------*/

static void get_end(const sketch *s, const se3di_element_entry *entry, bool is_j, double r[3])
{
    const size_t k = se3di_drawing_find_body(s->model, is_j ? entry->body_j : entry->body_i);
    se3di_drawing_to_ground(s->poses + SE3DI_POSE * k, is_j ? entry->point_j : entry->point_i, r);
}

static se3di_spot spot_of(const sketch *s, const se3di_element_entry *entry, bool is_j)
{
    double r[3];
    get_end(s, entry, is_j, r);
    return se3di_sketch_project(&s->view, r);
}

static void widen(const sketch *s, const double r[3], double low[2], double high[2])
{
    const se3di_spot p = se3di_sketch_project(&s->view, r);
    low[0] = fmin(low[0], p.x);
    low[1] = fmin(low[1], p.y);
    high[0] = fmax(high[0], p.x);
    high[1] = fmax(high[1], p.y);
}

/* End 0 or 1 of a link, which is a cylinder. */
static void get_link_end(const sketch *s, size_t body, const se3di_part *part, int end, double r[3])
{
    const double at[3] = {0.0, 0.0, (end - 0.5) * part->scale[2]};
    double placed[SE3DI_POSE];
    memcpy(placed, part->position, sizeof part->position);
    memcpy(placed + 3, part->orientation, sizeof part->orientation);
    se3di_drawing_to_ground(placed, at, r);
    se3di_drawing_to_ground(s->poses + SE3DI_POSE * body, r, r);
}

/* Of a body with shapes no bars lead to markers, which may be anywhere. */
static void list_looks(sketch *s)
{
    se3di_poses poses = {s->poses, s->model->body_count, 1, NULL};
    for (size_t body = 0; body < s->model->body_count; ++body) {
        drawn *of = &s->looks[body];
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

/* The outlines of the shapes of a body, which are drawn or only widen a box. */
static void put_shapes(sketch *s, size_t body, FILE *file, double low[2], double high[2])
{
    const se3di_parts *shapes = &s->looks[body].shapes;
    for (size_t k = 0; k < shapes->count; ++k) {
        s->failed = !se3di_sketch_put_shape(file, &s->view, s->poses + SE3DI_POSE * body,
                                            &shapes->list[k], &s->pool, low, high) ||
                    s->failed;
    }
}

/* The box around all that is drawn. */
static void enclose(sketch *s, double low[2], double high[2])
{
    double r[3];
    for (size_t k = 0; k < s->model->body_count; ++k) {
        const se3di_parts *links = &s->looks[k].links;
        widen(s, s->poses + SE3DI_POSE * k, low, high);
        put_shapes(s, k, NULL, low, high);
        for (size_t p = 0; p < links->count; ++p) {
            for (int end = 0; links->list[p].unit == SE3DI_UNIT_CYLINDER && end < 2; ++end) {
                get_link_end(s, k, &links->list[p], end, r);
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

/* Let all that is drawn fill its part of the sheet. */
static void fit(sketch *s)
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

/* ---- bodies ---------------------------------------------------------------------------------*/

/* The axes of a frame, as far as they are seen. */
static void put_frame(const sketch *s, size_t body)
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
static size_t put_links(const sketch *s, size_t body, se3di_spot *middle)
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
            get_link_end(s, body, &parts->list[k], i, at);
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
static void put_arms(const sketch *s, size_t body, se3di_spot center)
{
    for (size_t e = 0; e < s->model->element_count; ++e) {
        const se3di_element_entry *entry = &s->model->elements[e];
        for (int j = 0; entry->drawn > 0 && j < 2; ++j) {
            if (se3di_drawing_is_body(s->model, body, j ? entry->body_j : entry->body_i)) {
                se3di_svg_line(s->file, kind_of(body), spot_of(s, entry, j == 1), center);
            }
        }
    }
}

static void put_body(sketch *s, size_t body)
{
    const se3di_body_entry *entry = &s->model->bodies[body];
    const se3di_spot center = se3di_sketch_project(&s->view, s->poses + SE3DI_POSE * body);
    se3di_spot middle = center;
    char number[24];
    char name[TEXT_SIZE];
    double mass = 0.0;
    snprintf(number, sizeof number, "%zu", body);
    shorten(entry->name, name);
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
    add_line(s, "%zu  %s, %.4g kg", body, name, mass);
}

static void put_bodies(sketch *s)
{
    add_line(s, "#Bodies");
    add_line(s, "0  ground");
    double low[2] = {0.0, 0.0}; /* not used any more */
    double high[2] = {0.0, 0.0};
    for (size_t k = 0; k < s->model->body_count; ++k) {
        if (s->looks[k].shapes.count > 0) { /* below all else */
            se3di_svg_open(s->file, "shape", s->model->bodies[k].name);
            put_shapes(s, k, s->file, low, high);
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

/* ---- joints and forces ----------------------------------------------------------------------*/

static bool is_ground(const sketch *s, se3d_body body)
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
static void get_letter(const sketch *s, const se3di_element_entry *entry, char letter[8])
{
    size_t count = 0;
    for (const se3di_element_entry *e = s->model->elements; e < entry; ++e) {
        count += has_symbol(e);
    }
    make_letter(count, letter);
}

/* Letters of joints that are one place stand in a row. */
static void put_letter(sketch *s, se3di_spot at, double away, const char *letter)
{
    int beside = 0;
    for (size_t k = 0; k < s->joint_count; ++k) {
        beside += fabs(s->joints[k].x - at.x) < 14.0 && fabs(s->joints[k].y - at.y) < 12.0;
    }
    s->joints[s->joint_count++] = at;
    se3di_svg_text(s->file, "letter", (se3di_spot){at.x + 9.0 + away + 13.0 * beside, at.y - 10.0},
                   letter);
}

static bool is_driven(const sketch *s, const se3di_element_entry *joint)
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

static se3di_symbol make_symbol(const sketch *s, const se3di_element_entry *entry)
{
    double axis[3];
    se3di_symbol symbol = {s->file, spot_of(s, entry, true), {0.0, -1.0}, 1.0};
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

static void tell_joint(sketch *s, const se3di_element_entry *entry)
{
    char name[TEXT_SIZE];
    char letter[8] = "-";
    size_t equations = 0;
    (void)se3d_constraint_count_equations(s->model->system, entry->constraint, &equations);
    shorten(entry->name, name);
    if (has_symbol(entry)) {
        get_letter(s, entry, letter);
        add_line(s, "%s  %s: %s %zu-%zu, leaves %d", letter, name, type_of(entry),
                 se3di_drawing_find_body(s->model, entry->body_i),
                 se3di_drawing_find_body(s->model, entry->body_j), 6 - (int)equations);
    } else {
        add_line(s, "%s  %s: %s, takes %zu", letter, name, type_of(entry), equations);
    }
}

static void put_joint(sketch *s, const se3di_element_entry *entry)
{
    char letter[8];
    char kind[60];
    const se3di_joint_look look = se3di_joint_get_look(entry);
    const se3di_symbol symbol = make_symbol(s, entry);
    const se3di_spot first = spot_of(s, entry, false);
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
static void put_joints(sketch *s)
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

static void put_between(const sketch *s, const se3di_element_entry *entry)
{
    const se3di_spot a = spot_of(s, entry, false);
    const se3di_spot b = spot_of(s, entry, true);
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

static void put_elements(sketch *s)
{
    static const char *const heads[SE3DI_ELEMENT_KINDS] = {
        "Joints", "Constraints", "Drivers", "Forces", "Wheels", "States", "Roads"};
    char name[TEXT_SIZE];
    for (int kind = SE3DI_ELEMENT_JOINT; kind < SE3DI_ELEMENT_KINDS; ++kind) {
        bool any = false;
        for (size_t e = 0; e < s->model->element_count; ++e) {
            const se3di_element_entry *entry = &s->model->elements[e];
            if ((int)entry->kind != kind) {
                continue;
            }
            if (!any) {
                add_line(s, "#%s", heads[kind]);
                any = true;
            }
            if (kind == SE3DI_ELEMENT_JOINT || kind == SE3DI_ELEMENT_CONSTRAINT) {
                tell_joint(s, entry);
                continue;
            }
            if (kind == SE3DI_ELEMENT_FORCE && entry->drawn == 3) {
                put_between(s, entry);
            }
            shorten(entry->name, name);
            add_line(s, "-  %s%s%s", name, type_of(entry)[0] ? ": " : "", type_of(entry));
        }
    }
}

/* ---- the sheet ------------------------------------------------------------------------------*/

/* How many degrees of freedom there are, and what is wrong. */
static se3d_status tell_freedoms(sketch *s)
{
    se3d_check *check = NULL;
    se3d_check_summary sum = {.struct_size = sizeof sum};
    se3d_status status = se3d_check_create(s->model->system, &check);
    status = status < 0 ? status : se3d_check_get_summary(check, &sum);
    se3d_check_destroy(check);
    if (status >= 0) {
        add_line(s, "#Degrees of freedom: %zu", sum.freedoms);
        add_line(s, "6 x %zu bodies - %zu equations of rank %zu", sum.bodies, sum.equations,
                 sum.rank);
        if (sum.redundant > 0) {
            add_line(s, "%zu redundant, %zu inconsistent (see se3d check)", sum.redundant,
                     sum.inconsistent);
        }
    }
    return status < 0 ? status : SE3D_OK;
}

static void put_legend(const sketch *s)
{
    double y = 28.0;
    double x = s->width + 10.0;
    for (size_t k = 0; k < s->line_count; ++k) {
        const bool is_head = s->lines[k][0] == '#';
        if (k > 0 && k % s->rows == 0) {
            y = 28.0;
            x += LEGEND;
        }
        y += is_head && k % s->rows > 0 ? 6.0 : 0.0;
        se3di_svg_text(s->file, is_head ? "head" : "small", (se3di_spot){x, y},
                       s->lines[k] + is_head);
        y += LINE;
    }
    if (s->lines_left_out > 0) {
        char rest[60];
        snprintf(rest, sizeof rest, "and %zu more", s->lines_left_out);
        se3di_svg_text(s->file, "small", (se3di_spot){x, y}, rest);
    }
}

/* How large the sheet is. The number of lines is known when all is listed: an upper bound of it
 * is enough. @return its width with the legend, of which a long one has several columns. */
static double lay_out(sketch *s)
{
    const size_t all = 16 + s->model->body_count + s->model->element_count;
    const size_t most = all < LINES_MAX ? all : LINES_MAX;
    size_t columns = 1;
    while (columns < COLUMNS_MAX &&
           columns * (columns > 1 ? columns * ROWS_USUAL / 2 : ROWS_USUAL) < most) {
        ++columns;
    }
    s->rows = (most + columns - 1) / columns;
    s->height = fmax(HEIGHT, 60.0 + (LINE + 2.0) * (double)s->rows);
    s->width = round(WIDTH / HEIGHT * s->height);
    return s->width + LEGEND * (double)columns;
}

static se3d_status prepare(sketch *s, const double view[2])
{
    const se3d_model *model = s->model;
    s->poses = se3di_iopool_array(&s->pool, model->body_count, SE3DI_POSE * sizeof *s->poses);
    s->joints = se3di_iopool_array(&s->pool, model->element_count + 1, sizeof *s->joints);
    s->lines = se3di_iopool_array(&s->pool, LINES_MAX, sizeof *s->lines);
    s->looks = se3di_iopool_array(&s->pool, model->body_count, sizeof *s->looks);
    if (!s->poses || !s->joints || !s->lines || !s->looks) {
        return SE3D_ERR_NO_MEMORY;
    }
    const se3d_status status = se3di_drawing_get_poses(model, s->poses);
    const se3di_poses poses = {s->poses, model->body_count, 1, NULL};
    if (status >= 0) {
        se3di_drawing_measure(model, &poses, &s->sizes);
        se3di_sketch_turn(&s->view, view, model, s->poses);
        list_looks(s);
        fit(s);
    }
    return status;
}

se3d_status se3di_sketch_put(se3d_model *model, const double view[2], FILE *file)
{
    sketch s = {.model = model, .file = file};
    const char *title = model->title[0] ? model->title : model->name;
    se3di_iopool_init(&s.pool, &model->pool.allocator);
    const double width = lay_out(&s);
    se3d_status status = prepare(&s, view);
    status = status < 0 ? status : tell_freedoms(&s);
    if (status >= 0) {
        se3di_svg_begin(file, width, s.height, title);
        se3di_svg_text(file, "title", (se3di_spot){16.0, 28.0}, title);
        put_bodies(&s);
        put_elements(&s);
        put_joints(&s);
        put_legend(&s);
        se3di_svg_end(file);
    }
    se3di_iopool_destroy(&s.pool);
    return status < 0 ? status : s.failed ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}
