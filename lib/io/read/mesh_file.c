/* SPDX-License-Identifier: BSD-3-Clause */
/* Readers of triangles. Files are data from anywhere: every count, index and number is checked. */
#include "io/read/mesh_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/model/mesh.h"
#include "io/model/model.h"

enum { FACE_CORNERS_MAX = 64, STL_HEAD = 84, STL_RECORD = 50 };

typedef struct scanner {
    se3di_reader *reader;
    const se3di_node *shape;
    const char *file;
    const char *at, *end;
    size_t line;
    double scale;
    se3di_mesh *mesh;
} scanner;

static bool fail(const scanner *s, const char *what)
{
    return se3di_reader_fail_key(s->reader, s->shape, "file", "`%.200s`, line %zu: %s", s->file,
                                 s->line, what);
}

static bool add_point(scanner *s, const double p[3])
{
    se3di_mesh *m = s->mesh;
    const double q[3] = {s->scale * p[0], s->scale * p[1], s->scale * p[2]};
    if (!(isfinite(q[0]) && isfinite(q[1]) && isfinite(q[2]))) {
        return fail(s, "a coordinate is not a finite number");
    }
    double *grown = se3di_iopool_grow(&s->reader->model->pool, m->points, m->point_count,
                                      &m->point_capacity, 3 * sizeof *grown);
    if (!grown) {
        return se3di_reader_fail_memory(s->reader);
    }
    m->points = grown;
    for (int a = 0; a < 3; ++a) {
        m->points[3 * m->point_count + (size_t)a] = q[a];
        m->low[a] = m->point_count > 0 ? fmin(m->low[a], q[a]) : q[a];
        m->high[a] = m->point_count > 0 ? fmax(m->high[a], q[a]) : q[a];
    }
    ++m->point_count;
    return true;
}

static bool add_triangle(scanner *s, uint32_t a, uint32_t b, uint32_t c)
{
    se3di_mesh *m = s->mesh;
    uint32_t *grown = se3di_iopool_grow(&s->reader->model->pool, m->triangles, m->triangle_count,
                                        &m->triangle_capacity, 3 * sizeof *grown);
    if (!grown) {
        return se3di_reader_fail_memory(s->reader);
    }
    m->triangles = grown;
    uint32_t *to = grown + 3 * m->triangle_count++;
    to[0] = a;
    to[1] = b;
    to[2] = c;
    return true;
}

static void skip_blanks(scanner *s)
{
    while (s->at < s->end && (*s->at == ' ' || *s->at == '\t' || *s->at == '\r')) {
        ++s->at;
    }
}

static void next_line(scanner *s)
{
    while (s->at < s->end && *s->at != '\n') {
        ++s->at;
    }
    s->at += s->at < s->end;
    ++s->line;
}

/* A word at the beginning of what is left of the line. */
static bool take_word(scanner *s, const char *word)
{
    const size_t length = strlen(word);
    skip_blanks(s);
    if ((size_t)(s->end - s->at) < length || memcmp(s->at, word, length) != 0) {
        return false;
    }
    const char *after = s->at + length;
    if (after < s->end && !strchr(" \t\r\n", *after)) {
        return false;
    }
    s->at = after;
    return true;
}

static bool is_digit(const scanner *s)
{
    return s->at < s->end && *s->at >= '0' && *s->at <= '9';
}

static bool take_sign(scanner *s)
{
    const bool negative = s->at < s->end && *s->at == '-';
    s->at += negative || (s->at < s->end && *s->at == '+');
    return negative;
}

/* A whole number; saturates. */
static bool take_integer(scanner *s, long *value)
{
    const bool negative = take_sign(s);
    if (!is_digit(s)) {
        return false;
    }
    *value = 0;
    for (; is_digit(s); ++s->at) {
        *value = *value > 1000000000L ? *value : 10 * *value + (*s->at - '0');
    }
    *value = negative ? -*value : *value;
    return true;
}

/* Decimal, with a point in every locale. */
static bool take_number(scanner *s, double *value)
{
    long exponent = 0;
    int digits = 0;
    double sum = 0.0;
    skip_blanks(s);
    const bool negative = take_sign(s);
    for (; is_digit(s); ++s->at, ++digits) {
        sum = 10.0 * sum + (*s->at - '0');
    }
    int after = 0;
    if (s->at < s->end && *s->at == '.') {
        for (++s->at; is_digit(s); ++s->at, ++digits, ++after) {
            sum = 10.0 * sum + (*s->at - '0');
        }
    }
    if (digits == 0) {
        return false;
    }
    if (s->at < s->end && (*s->at == 'e' || *s->at == 'E')) {
        ++s->at;
        if (!take_integer(s, &exponent)) {
            return false;
        }
    }
    exponent -= after;
    sum =
        exponent < 0 ? sum / io_pow(10.0, -(double)exponent) : sum * io_pow(10.0, (double)exponent);
    *value = negative ? -sum : sum;
    return true;
}

static bool take_point(scanner *s)
{
    double p[3];
    for (int a = 0; a < 3; ++a) {
        if (!take_number(s, &p[a])) {
            return fail(s, "must have three numbers here");
        }
    }
    return add_point(s, p);
}

static float float_at(const unsigned char *bytes)
{
    const uint32_t bits = (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                          (uint32_t)bytes[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static size_t count_at(const char *text)
{
    const unsigned char *b = (const unsigned char *)text;
    return (size_t)b[0] | (size_t)b[1] << 8 | (size_t)b[2] << 16 | (size_t)b[3] << 24;
}

/* Lines are triangles in the messages of a binary file. */
static bool read_binary_stl(scanner *s)
{
    const size_t count = count_at(s->at + 80);
    const unsigned char *record = (const unsigned char *)s->at + STL_HEAD;
    for (s->line = 1; s->line <= count; ++s->line, record += STL_RECORD) {
        const uint32_t first = (uint32_t)s->mesh->point_count;
        for (int corner = 0; corner < 3; ++corner) {
            const unsigned char *p = record + 12 + 12 * corner;
            const double point[3] = {(double)float_at(p), (double)float_at(p + 4),
                                     (double)float_at(p + 8)};
            if (!add_point(s, point)) {
                return false;
            }
        }
        if (!add_triangle(s, first, first + 1, first + 2)) {
            return false;
        }
    }
    return true;
}

static bool read_ascii_stl(scanner *s)
{
    size_t corners = 0;
    for (; s->at < s->end; next_line(s)) {
        if (take_word(s, "vertex")) {
            if (!take_point(s)) {
                return false;
            }
            ++corners;
        } else if (take_word(s, "endloop")) {
            const uint32_t n = (uint32_t)s->mesh->point_count;
            if (corners != 3) {
                return fail(s, "a facet must have three vertices");
            }
            corners = 0;
            if (!add_triangle(s, n - 3, n - 2, n - 1)) {
                return false;
            }
        }
    }
    return corners == 0 || fail(s, "the file ends in a facet");
}

/* v, v/t, v//n, v/t/n; counted from 1, or from the last one backwards. */
static bool take_corner(scanner *s, uint32_t *index)
{
    long value;
    const long count = (long)s->mesh->point_count;
    if (!take_integer(s, &value) || value == 0 || value > count || value < -count) {
        return fail(s, "a face must name vertices that were given before");
    }
    *index = (uint32_t)(value > 0 ? value - 1 : count + value);
    while (s->at < s->end && !strchr(" \t\r\n", *s->at)) {
        ++s->at;
    }
    skip_blanks(s);
    return true;
}

static bool read_face(scanner *s)
{
    uint32_t corner[FACE_CORNERS_MAX];
    size_t count = 0;
    for (skip_blanks(s); s->at < s->end && *s->at != '\n'; ++count) {
        if (count == FACE_CORNERS_MAX) {
            return fail(s, "a face has more than 64 corners");
        }
        if (!take_corner(s, &corner[count])) {
            return false;
        }
    }
    if (count < 3) {
        return fail(s, "a face must have three corners or more");
    }
    for (size_t k = 1; k + 1 < count; ++k) {
        if (!add_triangle(s, corner[0], corner[k], corner[k + 1])) {
            return false;
        }
    }
    return true;
}

static bool read_obj(scanner *s)
{
    for (; s->at < s->end; next_line(s)) {
        if ((take_word(s, "v") && !take_point(s)) || (take_word(s, "f") && !read_face(s))) {
            return false;
        }
    }
    return true;
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text);
    const size_t size = strlen(end);
    bool same = length >= size;
    for (size_t k = 0; same && k < size; ++k) {
        const char c = text[length - size + k];
        same = (c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c) == end[k];
    }
    return same;
}

static bool read_text(scanner *s, size_t bytes)
{
    const size_t mark = se3di_byte_order_mark_length(s->at, bytes); /* a binary file has none */
    if (ends_with(s->file, ".obj")) {
        s->at += mark;
        return read_obj(s);
    }
    if (!ends_with(s->file, ".stl")) {
        return fail(s, "must end in .stl or .obj");
    }
    if (bytes >= STL_HEAD && (bytes - STL_HEAD) / STL_RECORD == count_at(s->at + 80) &&
        (bytes - STL_HEAD) % STL_RECORD == 0) {
        return read_binary_stl(s);
    }
    s->at += mark;
    return take_word(s, "solid")
               ? read_ascii_stl(s)
               : fail(s, "is neither an ASCII STL file nor a binary one of the length that its "
                         "count of triangles says");
}

static bool read_file(scanner *s)
{
    se3di_iopool pool; /* of the text */
    char *text = NULL;
    size_t size = 0;
    se3di_iopool_init(&pool, &s->reader->pool->allocator);
    bool good = se3di_read_attachment(s->reader, s->shape, "file", s->file, &pool, &text, &size);
    if (good) {
        s->at = text;
        s->end = text + size;
        good = read_text(s, size) &&
               (s->mesh->triangle_count > 0 || fail(s, "the file has no triangles"));
    }
    se3di_iopool_destroy(&pool);
    return good;
}

const se3di_mesh *se3di_read_mesh(se3di_reader *reader, const se3di_node *shape, const char *file,
                                  double scale)
{
    se3d_model *model = reader->model;
    se3di_mesh *mesh = model->meshes;
    while (mesh && (strcmp(mesh->file, file) != 0 || strcmp(mesh->model, reader->file) != 0 ||
                    mesh->scale < scale || mesh->scale > scale || mesh->mirror >= 0)) {
        mesh = mesh->next;
    }
    if (mesh) {
        return mesh;
    }
    mesh = se3di_iopool_alloc(&model->pool, sizeof *mesh);
    if (!mesh) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    scanner s = {
        .reader = reader, .shape = shape, .file = file, .line = 1, .scale = scale, .mesh = mesh};
    if (!read_file(&s)) {
        return NULL;
    }
    mesh->file = file;
    mesh->model = reader->file;
    mesh->mirror = -1;
    mesh->source = NULL;
    mesh->scale = scale;
    mesh->next = model->meshes;
    model->meshes = mesh;
    return mesh;
}

/* Its triangles run the other way round then. */
static void copy_mirrored(const se3di_mesh *mesh, int axis, se3di_mesh *copy)
{
    memcpy(copy->points, mesh->points, 3 * mesh->point_count * sizeof *mesh->points);
    memcpy(copy->triangles, mesh->triangles, 3 * mesh->triangle_count * sizeof *mesh->triangles);
    for (size_t k = 0; k < mesh->point_count; ++k) {
        copy->points[3 * k + (size_t)axis] = 0.0 - copy->points[3 * k + (size_t)axis];
    }
    for (size_t k = 0; k < mesh->triangle_count; ++k) {
        copy->triangles[3 * k + 1] = mesh->triangles[3 * k + 2];
        copy->triangles[3 * k + 2] = mesh->triangles[3 * k + 1];
    }
    copy->low[axis] = 0.0 - mesh->high[axis];
    copy->high[axis] = 0.0 - mesh->low[axis];
}

#define FACETS 64 /* of a funnel */

/* It has its corners once: the two triangles of a facet are (a, b, top a) and (top b, top a, b). */
static void fill_funnel(const se3d_model_shape *shape, se3di_mesh *mesh)
{
    const double radius[2] = {shape->bottom_radius, shape->top_radius};
    const double wide = fmax(radius[0], radius[1]);
    for (uint32_t k = 0; k < FACETS; ++k) {
        const double angle = 6.283185307179586 * k / FACETS;
        const uint32_t a = 2 * k, b = 2 * ((k + 1) % FACETS);
        const uint32_t facet[6] = {a, b, a + 1, b + 1, a + 1, b};
        memcpy(mesh->triangles + 6 * (size_t)k, facet, sizeof facet);
        for (size_t end = 0; end < 2; ++end) {
            double *point = mesh->points + 3 * (a + end);
            point[0] = radius[end] * io_cos(angle);
            point[1] = radius[end] * io_sin(angle);
            point[2] = (end == 0 ? -0.5 : 0.5) * shape->length;
        }
    }
    for (int a = 0; a < 3; ++a) {
        mesh->high[a] = a < 2 ? wide : 0.5 * shape->length;
        mesh->low[a] = -mesh->high[a];
    }
}

const se3di_mesh *se3di_make_funnel(se3di_reader *reader, const se3d_model_shape *shape)
{
    se3di_iopool *pool = &reader->model->pool;
    se3di_mesh *mesh = se3di_iopool_alloc(pool, sizeof *mesh);
    if (mesh) {
        mesh->points = se3di_iopool_array(pool, 2 * FACETS, 3 * sizeof *mesh->points);
        mesh->triangles = se3di_iopool_array(pool, 2 * FACETS, 3 * sizeof *mesh->triangles);
    }
    if (!mesh || !mesh->points || !mesh->triangles) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    mesh->point_count = mesh->triangle_count = 2 * (size_t)FACETS;
    fill_funnel(shape, mesh);
    return mesh;
}

const se3di_mesh *se3di_mirror_mesh(se3di_reader *reader, const se3di_mesh *mesh, int axis)
{
    se3d_model *model = reader->model;
    for (se3di_mesh *known = model->meshes; known; known = known->next) {
        if (known->mirror == axis && known->source == mesh) {
            return known;
        }
    }
    se3di_mesh *copy = se3di_iopool_alloc(&model->pool, sizeof *copy);
    if (copy) {
        *copy = *mesh;
        copy->points =
            se3di_iopool_array(&model->pool, mesh->point_count, 3 * sizeof *copy->points);
        copy->triangles =
            se3di_iopool_array(&model->pool, mesh->triangle_count, 3 * sizeof *copy->triangles);
    }
    if (!copy || !copy->points || !copy->triangles) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    copy_mirrored(mesh, axis, copy);
    copy->mirror = axis;
    copy->source = mesh;
    copy->heights = NULL;
    copy->next = model->meshes;
    model->meshes = copy;
    return copy;
}
