/* SPDX-License-Identifier: BSD-3-Clause */
/* Binary glTF 2.0 files: a header, a JSON chunk and a chunk of numbers, little-endian. */
#include "io/glb.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/csv.h"

enum { NUMBER_FLOAT = 5126, NUMBER_SHORT = 5122, NUMBER_INDEX = 5123 };

void se3di_glb_init(se3di_glb *glb, se3di_iopool *pool)
{
    memset(glb, 0, sizeof *glb);
    glb->pool = pool;
    for (size_t k = 0; k < SE3DI_GLB_MESH_COUNT; ++k) {
        glb->unit[k][0] = glb->unit[k][1] = glb->unit[k][2] = -1;
    }
}

void se3di_glb_put_bytes(se3di_glb *glb, se3di_bytes *bytes, const void *data, size_t size)
{
    size_t capacity = bytes->capacity ? bytes->capacity : 1024;
    while (capacity < bytes->count + size) {
        capacity *= 2;
    }
    if (capacity != bytes->capacity) {
        char *grown = se3di_iopool_alloc(glb->pool, capacity);
        if (!grown) {
            glb->failed = true;
            return;
        }
        if (bytes->count > 0) {
            memcpy(grown, bytes->data, bytes->count);
        }
        bytes->data = grown;
        bytes->capacity = capacity;
    }
    memcpy(bytes->data + bytes->count, data, size);
    bytes->count += size;
}

void se3di_glb_put(se3di_glb *glb, se3di_bytes *bytes, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (length > 0) {
        se3di_glb_put_bytes(glb, bytes, text,
                            (size_t)length < sizeof text ? (size_t)length : sizeof text - 1);
    }
}

void se3di_glb_put_text(se3di_glb *glb, se3di_bytes *bytes, const char *text)
{
    se3di_glb_put_bytes(glb, bytes, "\"", 1);
    for (; *text; ++text) {
        const unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            se3di_glb_put(glb, bytes, "\\%c", c);
        } else if (c < ' ') {
            se3di_glb_put(glb, bytes, "\\u%04x", (unsigned)c);
        } else {
            se3di_glb_put_bytes(glb, bytes, text, 1);
        }
    }
    se3di_glb_put_bytes(glb, bytes, "\"", 1);
}

void se3di_glb_put_number(se3di_glb *glb, se3di_bytes *bytes, double value)
{
    char text[48];
    const size_t length = se3di_number_format(isfinite(value) ? (double)(float)value : 0.0, text);
    se3di_glb_put_bytes(glb, bytes, text, length);
}

static void put_little(se3di_glb *glb, uint32_t value, size_t size)
{
    const unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8),
                                    (unsigned char)(value >> 16), (unsigned char)(value >> 24)};
    se3di_glb_put_bytes(glb, &glb->binary, bytes, size);
}

static long begin(se3di_glb *glb, size_t size, int target)
{
    const bool first = glb->accessor_count == 0;
    while (glb->binary.count % 4 != 0) {
        put_little(glb, 0, 1);
    }
    se3di_glb_put(glb, &glb->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu",
                  first ? "" : ",", glb->binary.count, size);
    if (target != 0) {
        se3di_glb_put(glb, &glb->views, ",\"target\":%d", target);
    }
    se3di_glb_put(glb, &glb->views, "}");
    return (long)glb->accessor_count;
}

static void put_range(se3di_glb *glb, const double *values, size_t count, size_t width)
{
    for (int largest = 0; largest < 2; ++largest) {
        se3di_glb_put(glb, &glb->accessors, largest ? "],\"max\":[" : ",\"min\":[");
        for (size_t i = 0; i < width; ++i) {
            float best = (float)values[i];
            for (size_t k = 1; k < count; ++k) {
                const float value = (float)values[k * width + i];
                best = (largest ? value > best : value < best) ? value : best;
            }
            se3di_glb_put(glb, &glb->accessors, i > 0 ? "," : "");
            se3di_glb_put_number(glb, &glb->accessors, (double)best);
        }
    }
    se3di_glb_put(glb, &glb->accessors, "]");
}

static void describe(se3di_glb *glb, long view, int number, size_t count, const char *type)
{
    se3di_glb_put(glb, &glb->accessors,
                  "%s{\"bufferView\":%ld,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
                  view > 0 ? "," : "", view, number, count, type);
    ++glb->accessor_count;
}

long se3di_glb_add_floats(se3di_glb *glb, const double *values, size_t count, se3di_glb_type type,
                          int target)
{
    const size_t width = (size_t)type;
    const long view = begin(glb, count * width * 4, target);
    for (size_t k = 0; k < count * width; ++k) {
        const float value = isfinite(values[k]) ? (float)values[k] : 0.0F;
        uint32_t bits = 0;
        memcpy(&bits, &value, sizeof bits);
        put_little(glb, bits, 4);
    }
    describe(glb, view, NUMBER_FLOAT, count, type == SE3DI_GLB_SCALAR ? "SCALAR" : "VEC3");
    put_range(glb, values, count, width);
    se3di_glb_put(glb, &glb->accessors, "}");
    return view;
}

long se3di_glb_add_rotations(se3di_glb *glb, const double *values, size_t count)
{
    const long view = begin(glb, count * 8, 0);
    for (size_t k = 0; k < 4 * count; ++k) {
        const long value = lround(32767.0 * fmax(-1.0, fmin(1.0, values[k])));
        put_little(glb, (uint32_t)(value & 0xffff), 2);
    }
    describe(glb, view, NUMBER_SHORT, count, "VEC4");
    se3di_glb_put(glb, &glb->accessors, ",\"normalized\":true}");
    return view;
}

enum { VERTICES_MAX = 1024, AROUND = 32, RINGS = 16, TURNS = 8 };

typedef struct unit_mesh {
    double points[3 * VERTICES_MAX];
    double normals[3 * VERTICES_MAX];
    uint16_t indices[6 * VERTICES_MAX];
    size_t points_count;
    size_t indices_count;
} unit_mesh;

static const double pi = 3.14159265358979323846;

static void put_vertex(unit_mesh *m, double x, double y, double z, const double n[3])
{
    const double p[3] = {x, y, z};
    memcpy(&m->points[3 * m->points_count], p, sizeof p);
    if (n) {
        memcpy(&m->normals[3 * m->points_count], n, 3 * sizeof *n);
    }
    ++m->points_count;
}

static void put_triangle(unit_mesh *m, size_t a, size_t b, size_t c)
{
    m->indices[m->indices_count++] = (uint16_t)a;
    m->indices[m->indices_count++] = (uint16_t)b;
    m->indices[m->indices_count++] = (uint16_t)c;
}

static void make_box(unit_mesh *m)
{
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
            const size_t first = m->points_count;
            double n[3] = {0.0, 0.0, 0.0};
            n[axis] = side;
            for (int k = 0; k < 4; ++k) {
                double p[3];
                p[axis] = 0.5 * side;
                p[(axis + 1) % 3] = (k == 1 || k == 2) ? 0.5 : -0.5;
                p[(axis + 2) % 3] = k >= 2 ? 0.5 : -0.5;
                put_vertex(m, p[0], p[1], p[2], n);
            }
            const size_t flip = side > 0 ? 0 : 1;
            put_triangle(m, first, first + 1 + flip, first + 2 - flip);
            put_triangle(m, first, first + 2 + flip, first + 3 - flip);
        }
    }
}

static void put_quads(unit_mesh *m, size_t first, size_t rings)
{
    for (size_t i = 0; i < rings; ++i) {
        for (size_t k = 0; k < AROUND; ++k) {
            const size_t a = first + i * (AROUND + 1) + k;
            const size_t b = a + AROUND + 1;
            put_triangle(m, a, a + 1, b + 1);
            put_triangle(m, a, b + 1, b);
        }
    }
}

static void make_sphere(unit_mesh *m)
{
    for (int i = 0; i <= RINGS; ++i) {
        for (int k = 0; k <= AROUND; ++k) {
            const double polar = pi - pi * i / RINGS;
            const double turn = 2.0 * pi * k / AROUND;
            const double n[3] = {sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)};
            put_vertex(m, n[0], n[1], n[2], n);
        }
    }
    put_quads(m, 0, RINGS);
}

static void make_cylinder(unit_mesh *m)
{
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k <= AROUND; ++k) {
            const double turn = 2.0 * pi * k / AROUND;
            const double n[3] = {cos(turn), sin(turn), 0.0};
            put_vertex(m, n[0], n[1], i - 0.5, n);
        }
    }
    put_quads(m, 0, 1);
    for (int i = 0; i < 2; ++i) {
        const size_t first = m->points_count;
        const double n[3] = {0.0, 0.0, i == 0 ? -1.0 : 1.0};
        for (int k = 0; k < AROUND; ++k) {
            const double turn = 2.0 * pi * k / AROUND;
            put_vertex(m, cos(turn), sin(turn), i - 0.5, n);
        }
        for (size_t k = 1; k + 1 < AROUND; ++k) {
            put_triangle(m, first, first + k + (i == 0), first + k + (i == 1));
        }
    }
}

static void make_spring(unit_mesh *m)
{
    const int count = TURNS * 24;
    put_vertex(m, 0.0, 0.0, -0.5, NULL);
    for (int k = 0; k <= count; ++k) {
        const double turn = 2.0 * pi * TURNS * k / count;
        put_vertex(m, cos(turn), sin(turn), -0.4 + 0.8 * k / count, NULL);
    }
    put_vertex(m, 0.0, 0.0, 0.5, NULL);
}

static void make_grid(unit_mesh *m)
{
    for (int k = -10; k <= 10; ++k) {
        put_vertex(m, k, -10.0, 0.0, NULL);
        put_vertex(m, k, 10.0, 0.0, NULL);
        put_vertex(m, -10.0, k, 0.0, NULL);
        put_vertex(m, 10.0, k, 0.0, NULL);
    }
}

static void add_unit(se3di_glb *glb, se3di_glb_mesh mesh)
{
    static void (*const make[])(unit_mesh *) = {make_box, make_sphere, make_cylinder, make_spring,
                                                make_grid};
    unit_mesh *m = se3di_iopool_alloc(glb->pool, sizeof *m);
    if (!m) {
        glb->failed = true;
        return;
    }
    make[mesh](m);
    glb->unit[mesh][0] =
        se3di_glb_add_floats(glb, m->points, m->points_count, SE3DI_GLB_VEC3, 34962);
    if (m->indices_count > 0) {
        glb->unit[mesh][1] =
            se3di_glb_add_floats(glb, m->normals, m->points_count, SE3DI_GLB_VEC3, 34962);
        glb->unit[mesh][2] = begin(glb, m->indices_count * 2, 34963);
        for (size_t k = 0; k < m->indices_count; ++k) {
            put_little(glb, m->indices[k], 2);
        }
        describe(glb, glb->unit[mesh][2], NUMBER_INDEX, m->indices_count, "SCALAR");
        se3di_glb_put(glb, &glb->accessors, "}");
    }
}

size_t se3di_glb_add_mesh(se3di_glb *glb, se3di_glb_mesh mesh, const double color[4])
{
    const size_t index = glb->mesh_count++;
    if (glb->unit[mesh][0] < 0) {
        add_unit(glb, mesh);
    }
    se3di_glb_put(glb, &glb->meshes, "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%ld",
                  index > 0 ? "," : "", glb->unit[mesh][0]);
    if (glb->unit[mesh][1] >= 0) {
        se3di_glb_put(glb, &glb->meshes, ",\"NORMAL\":%ld},\"indices\":%ld", glb->unit[mesh][1],
                      glb->unit[mesh][2]);
    } else {
        se3di_glb_put(glb, &glb->meshes, "},\"mode\":%d", mesh == SE3DI_GLB_GRID ? 1 : 3);
    }
    se3di_glb_put(glb, &glb->meshes, ",\"material\":%zu}]}", index);
    se3di_glb_put(glb, &glb->materials,
                  "%s{\"pbrMetallicRoughness\":{\"metallicFactor\":0.1,\"roughnessFactor\":0.6,"
                  "\"baseColorFactor\":[",
                  index > 0 ? "," : "");
    for (size_t k = 0; k < 4; ++k) {
        se3di_glb_put(glb, &glb->materials, k > 0 ? "," : "");
        se3di_glb_put_number(glb, &glb->materials, color[k]);
    }
    se3di_glb_put(glb, &glb->materials, "]},\"doubleSided\":true%s}",
                  color[3] < 1.0 ? ",\"alphaMode\":\"BLEND\"" : "");
    return index;
}

static void put_head(unsigned char *at, uint32_t value)
{
    for (int k = 0; k < 4; ++k) {
        at[k] = (unsigned char)(value >> (8 * k));
    }
}

static bool write_chunk(FILE *file, const se3di_bytes *bytes, const char *type)
{
    unsigned char head[8];
    put_head(head, (uint32_t)bytes->count);
    memcpy(head + 4, type, 4);
    return fwrite(head, 1, 8, file) == 8 &&
           fwrite(bytes->data, 1, bytes->count, file) == bytes->count;
}

static bool write_file(const char *path, const se3di_bytes *json, const se3di_bytes *binary)
{
    unsigned char head[12] = {'g', 'l', 'T', 'F'};
    char partial[4200];
    errno = 0;
    const int length = snprintf(partial, sizeof partial, "%s.partial", path);
    FILE *file = length > 0 && (size_t)length < sizeof partial ? fopen(partial, "wb") : NULL;
    if (!file) {
        return false;
    }
    put_head(head + 4, 2);
    put_head(head + 8, (uint32_t)(28 + json->count + binary->count));
    bool good = fwrite(head, 1, sizeof head, file) == sizeof head &&
                write_chunk(file, json, "JSON") && write_chunk(file, binary, "BIN\0");
    good = fclose(file) == 0 && good;
#if defined(_WIN32)
    remove(path); /* rename does not replace there */
#endif
    if (!good || rename(partial, path) != 0) {
        const int why = errno;
        remove(partial);
        errno = why ? why : EIO;
        return false;
    }
    return true;
}

bool se3di_glb_write(se3di_glb *glb, const se3di_bytes *rest, const char *path)
{
    static const char *const names[] = {",\"bufferViews\":[", "],\"accessors\":[", "],\"meshes\":[",
                                        "],\"materials\":["};
    const se3di_bytes *const parts[] = {&glb->views, &glb->accessors, &glb->meshes,
                                        &glb->materials};
    se3di_bytes json = {NULL, 0, 0};
    while (glb->binary.count % 4 != 0) {
        put_little(glb, 0, 1);
    }
    se3di_glb_put(glb, &json,
                  "{\"asset\":{\"version\":\"2.0\",\"generator\":\"libse3d %s\"},"
                  "\"buffers\":[{\"byteLength\":%zu}]",
                  se3d_version_get_text(), glb->binary.count);
    for (size_t k = 0; k < 4; ++k) {
        se3di_glb_put(glb, &json, "%s", names[k]);
        se3di_glb_put_bytes(glb, &json, parts[k]->data ? parts[k]->data : "", parts[k]->count);
    }
    se3di_glb_put(glb, &json, "]");
    se3di_glb_put_bytes(glb, &json, rest->data, rest->count);
    se3di_glb_put(glb, &json, "}");
    while (json.count % 4 != 0) {
        se3di_glb_put(glb, &json, " ");
    }
    if (glb->failed) {
        errno = ENOMEM;
        return false;
    }
    return write_file(path, &json, &glb->binary);
}
