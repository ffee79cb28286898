/* SPDX-License-Identifier: BSD-3-Clause */
/* Binary glTF 2.0 files: a header, a JSON chunk and a chunk of numbers, little-endian. */
#include "io/write/glb.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/little.h"
#include "io/base/number.h"
#include "io/base/pool.h"
#include "io/model/mesh.h"
#include "io/write/drawing.h"
#include "io/write/unit_mesh.h"

enum { NUMBER_FLOAT = 5126, NUMBER_SHORT = 5122, NUMBER_INDEX = 5123, NUMBER_LONG_INDEX = 5125 };

void se3di_glb_init(se3di_glb *glb, se3di_iopool *pool)
{
    memset(glb, 0, sizeof *glb);
    glb->pool = pool;
    for (size_t k = 0; k < SE3DI_UNIT_COUNT; ++k) {
        glb->unit[k][0] = glb->unit[k][1] = glb->unit[k][2] = -1;
    }
}

void se3di_glb_put_bytes(se3di_glb *glb, se3di_iobytes *bytes, const void *data, size_t size)
{
    glb->failed = glb->failed || !se3di_iobytes_put(bytes, glb->pool, data, size);
}

void se3di_glb_put(se3di_glb *glb, se3di_iobytes *bytes, const char *format, ...)
{
    char text[1024];
    va_list list;
    if (!strchr(format, '%')) {
        se3di_glb_put_bytes(glb, bytes, format, strlen(format));
        return;
    }
    va_start(list, format);
    const int length = vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (length > 0) {
        se3di_glb_put_bytes(glb, bytes, text,
                            (size_t)length < sizeof text ? (size_t)length : sizeof text - 1);
    }
}

void se3di_glb_put_text(se3di_glb *glb, se3di_iobytes *bytes, const char *text)
{
    se3di_glb_put_bytes(glb, bytes, "\"", 1);
    while (*text) { /* valid UTF-8 whatever the bytes are */
        const size_t length = se3d_text_get_character(text);
        if (*text == '"' || *text == '\\') {
            se3di_glb_put(glb, bytes, "\\%c", *text);
        } else if (length > 0) {
            se3di_glb_put_bytes(glb, bytes, text, length);
        } else if ((unsigned char)*text < 0x80) {
            se3di_glb_put(glb, bytes, "\\u%04x", (unsigned)*text);
        } else {
            se3di_glb_put(glb, bytes, "\\ufffd");
        }
        text += length > 0 ? length : 1;
    }
    se3di_glb_put_bytes(glb, bytes, "\"", 1);
}

void se3di_glb_put_number(se3di_glb *glb, se3di_iobytes *bytes, double value)
{
    char text[48];
    const size_t length = se3di_number_format(isfinite(value) ? (double)(float)value : 0.0, text);
    se3di_glb_put_bytes(glb, bytes, text, length);
}

/* Numbers on their way into the binary chunk, many at a time. */
typedef struct batch {
    se3di_glb *glb;
    size_t used;
    unsigned char bytes[1024];
} batch;

static void flush(batch *b)
{
    se3di_glb_put_bytes(b->glb, &b->glb->binary, b->bytes, b->used);
    b->used = 0;
}

/* Two bytes or four, which compilers make one store of. */
static void put_little(batch *b, uint32_t value, size_t size)
{
    if (b->used + size > sizeof b->bytes) {
        flush(b);
    }
    unsigned char *at = b->bytes + b->used;
    if (size == 2) {
        at[0] = (unsigned char)value;
        at[1] = (unsigned char)(value >> 8);
    } else {
        at[0] = (unsigned char)value;
        at[1] = (unsigned char)(value >> 8);
        at[2] = (unsigned char)(value >> 16);
        at[3] = (unsigned char)(value >> 24);
    }
    b->used += size;
}

/* Up to a multiple of four bytes. */
static void pad(se3di_glb *glb, se3di_iobytes *bytes, const char *with)
{
    se3di_glb_put_bytes(glb, bytes, with, (4 - bytes->count % 4) % 4);
}

static long begin(se3di_glb *glb, size_t size, int target)
{
    const bool first = glb->accessor_count == 0;
    pad(glb, &glb->binary, "\0\0\0");
    se3di_glb_put(glb, &glb->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu",
                  first ? "" : ",", glb->binary.count, size);
    if (target != 0) {
        se3di_glb_put(glb, &glb->views, ",\"target\":%d", target);
    }
    se3di_glb_put(glb, &glb->views, "}");
    return (long)glb->accessor_count;
}

/* The nearest 32-bit number; 0 if it is none. */
static float to_float(double value)
{
    const double most = (double)FLT_MAX;
    if (!isfinite(value)) {
        return 0.0F;
    }
    return value > most ? FLT_MAX : value < -most ? -FLT_MAX : (float)value;
}

/* The least and the largest of each component. */
static void put_range(se3di_glb *glb, float range[2][3], size_t width)
{
    for (int largest = 0; largest < 2; ++largest) {
        se3di_glb_put(glb, &glb->accessors, largest ? "],\"max\":[" : ",\"min\":[");
        for (size_t i = 0; i < width; ++i) {
            se3di_glb_put(glb, &glb->accessors, i > 0 ? "," : "");
            se3di_glb_put_number(glb, &glb->accessors, (double)range[largest][i]);
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
    batch numbers = {.glb = glb};
    float range[2][3] = {{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}};
    for (size_t i = 0; i < width; ++i) {
        range[0][i] = range[1][i] = to_float(values[i]);
    }
    for (size_t k = 0; k < count; ++k, values += width) {
        for (size_t i = 0; i < width; ++i) {
            const float value = to_float(values[i]);
            uint32_t bits = 0;
            memcpy(&bits, &value, sizeof bits);
            put_little(&numbers, bits, 4);
            range[0][i] = value < range[0][i] ? value : range[0][i];
            range[1][i] = value > range[1][i] ? value : range[1][i];
        }
    }
    flush(&numbers);
    describe(glb, view, NUMBER_FLOAT, count, type == SE3DI_GLB_SCALAR ? "SCALAR" : "VEC3");
    put_range(glb, range, width);
    se3di_glb_put(glb, &glb->accessors, "}");
    return view;
}

/* A component of a unit quaternion in steps of 1/32767, halves away from zero. */
static int32_t to_short(double x)
{
    const double cut = !(x < 1.0) ? 1.0 : x < -1.0 ? -1.0 : x;
    const double size = 32767.0 * fabs(cut);
    const int32_t whole = (int32_t)size;
    const int32_t near = whole + (size - whole >= 0.5);
    return cut < 0.0 ? -near : near;
}

long se3di_glb_add_rotations(se3di_glb *glb, const double *values, size_t count)
{
    const long view = begin(glb, count * 8, 0);
    batch numbers = {.glb = glb};
    for (size_t k = 0; k < 4 * count; ++k) {
        put_little(&numbers, (uint32_t)to_short(values[k]) & 0xffff, 2);
    }
    flush(&numbers);
    describe(glb, view, NUMBER_SHORT, count, "VEC4");
    se3di_glb_put(glb, &glb->accessors, ",\"normalized\":true}");
    return view;
}

static void add_unit(se3di_glb *glb, se3di_unit_shape mesh)
{
    se3di_unit_mesh *m = se3di_iopool_alloc(glb->pool, sizeof *m);
    if (!m) {
        glb->failed = true;
        return;
    }
    se3di_unit_mesh_make(m, mesh);
    glb->unit[mesh][0] =
        se3di_glb_add_floats(glb, m->points, m->points_count, SE3DI_GLB_VEC3, 34962);
    if (m->indices_count > 0) {
        glb->unit[mesh][1] =
            se3di_glb_add_floats(glb, m->normals, m->points_count, SE3DI_GLB_VEC3, 34962);
        glb->unit[mesh][2] = begin(glb, m->indices_count * 2, 34963);
        batch numbers = {.glb = glb};
        for (size_t k = 0; k < m->indices_count; ++k) {
            put_little(&numbers, m->indices[k], 2);
        }
        flush(&numbers);
        describe(glb, glb->unit[mesh][2], NUMBER_INDEX, m->indices_count, "SCALAR");
        se3di_glb_put(glb, &glb->accessors, "}");
    }
}

/* The unit normal of a triangle; z if it has no area. */
static void get_normal(const double *const p[3], double n[3])
{
    double a[3];
    double b[3];
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        a[i] = p[1][i] - p[0][i];
        b[i] = p[2][i] - p[0][i];
        largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    }
    for (int i = 0; i < 3 && largest > 0.0; ++i) { /* no square overflows or vanishes */
        a[i] /= largest;
        b[i] /= largest;
    }
    n[0] = a[1] * b[2] - a[2] * b[1];
    n[1] = a[2] * b[0] - a[0] * b[2];
    n[2] = a[0] * b[1] - a[1] * b[0];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const bool flat = length > 0.0 && isfinite(length);
    for (int i = 0; i < 3; ++i) {
        n[i] = flat ? n[i] / length : (double)(i == 2);
    }
}

/* What becomes of a surface: vertices, of which one point has as many as it has normals. */
typedef struct smoothing {
    const se3di_mesh *mesh;
    double *flat;             /* [3 * triangles] their normals, by the area that is seen */
    size_t *first;            /* [points + 1] where the corners of a point begin in `corners` */
    size_t *corners;          /* [3 * triangles] by points */
    size_t *vertex;           /* [3 * triangles] of each corner */
    double *points, *normals; /* [3 * vertices] */
    size_t count;
} smoothing;

/* The corners of every point (a counting sort), and the normals of all triangles. */
static void sort_corners(smoothing *s)
{
    const se3di_mesh *mesh = s->mesh;
    const size_t count = 3 * mesh->triangle_count;
    for (size_t k = 0; k < count; ++k) {
        ++s->first[mesh->triangles[k] + 1];
    }
    for (size_t k = 0; k < mesh->point_count; ++k) {
        s->first[k + 1] += s->first[k];
    }
    for (size_t k = count; k-- > 0;) { /* from the end, so that the list begins with the first */
        s->corners[--s->first[mesh->triangles[k] + 1]] = k;
    }
    for (size_t k = 0; k < mesh->point_count; ++k) { /* all have moved by one */
        s->first[k] = s->first[k + 1];
    }
    s->first[mesh->point_count] = count;
    for (size_t k = 0; k < mesh->triangle_count; ++k) {
        const double *p[3];
        for (size_t c = 0; c < 3; ++c) {
            p[c] = mesh->points + 3 * (size_t)mesh->triangles[3 * k + c];
        }
        get_normal(p, s->flat + 3 * k);
    }
}

/* A point of so many triangles is no point of a smooth surface; it would take long. */
static bool is_crowded(const smoothing *s, size_t point)
{
    return s->first[point + 1] - s->first[point] > 64;
}

/* The normal at a corner: the mean of the triangles around its point that bend by less than 30
 * degrees from its own; edges that are sharper stay so. */
static void get_smooth(const smoothing *s, size_t corner, double n[3])
{
    const double *own = s->flat + corner / 3 * 3;
    const size_t point = s->mesh->triangles[corner];
    double sum[3] = {0.0, 0.0, 0.0};
    for (size_t k = s->first[point]; k < s->first[point + 1] && !is_crowded(s, point); ++k) {
        const double *other = s->flat + s->corners[k] / 3 * 3;
        if (own[0] * other[0] + own[1] * other[1] + own[2] * other[2] > 0.866) {
            for (int i = 0; i < 3; ++i) {
                sum[i] += other[i];
            }
        }
    }
    const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (int i = 0; i < 3; ++i) {
        n[i] = length > 0.0 ? sum[i] / length : own[i];
    }
}

/* One vertex for all corners of a point that have one normal. */
static void join_corners(smoothing *s, size_t point)
{
    const size_t begin = s->count;
    for (size_t k = s->first[point]; k < s->first[point + 1]; ++k) {
        double n[3];
        size_t v = is_crowded(s, point) ? s->count : begin;
        get_smooth(s, s->corners[k], n);
        while (v < s->count &&
               !(fabs(s->normals[3 * v] - n[0]) + fabs(s->normals[3 * v + 1] - n[1]) +
                     fabs(s->normals[3 * v + 2] - n[2]) <
                 1e-6)) {
            ++v;
        }
        if (v == s->count) {
            memcpy(s->points + 3 * v, s->mesh->points + 3 * point, sizeof n);
            memcpy(s->normals + 3 * v, n, sizeof n);
            ++s->count;
        }
        s->vertex[s->corners[k]] = v;
    }
}

static long add_indices(se3di_glb *glb, const size_t *vertex, size_t count, size_t most)
{
    const size_t size = most > UINT16_MAX ? 4 : 2;
    const long view = begin(glb, count * size, 34963);
    batch numbers = {.glb = glb};
    for (size_t k = 0; k < count; ++k) {
        put_little(&numbers, (uint32_t)vertex[k], size);
    }
    flush(&numbers);
    describe(glb, view, size == 4 ? NUMBER_LONG_INDEX : NUMBER_INDEX, count, "SCALAR");
    se3di_glb_put(glb, &glb->accessors, "}");
    return view;
}

static void add_surface(se3di_glb *glb, const se3di_mesh *mesh, long accessors[3])
{
    const size_t count = 3 * mesh->triangle_count;
    smoothing s = {.mesh = mesh};
    s.flat = se3di_iopool_array(glb->pool, count, sizeof *s.flat);
    s.first = se3di_iopool_array(glb->pool, mesh->point_count + 2, sizeof *s.first);
    s.corners = se3di_iopool_array(glb->pool, count, sizeof *s.corners);
    s.vertex = se3di_iopool_array(glb->pool, count, sizeof *s.vertex);
    s.points = se3di_iopool_array(glb->pool, count, 3 * sizeof *s.points);
    s.normals = se3di_iopool_array(glb->pool, count, 3 * sizeof *s.normals);
    if (!s.flat || !s.first || !s.corners || !s.vertex || !s.points || !s.normals) {
        glb->failed = true;
        return;
    }
    sort_corners(&s);
    for (size_t k = 0; k < mesh->point_count; ++k) {
        join_corners(&s, k);
    }
    accessors[0] = se3di_glb_add_floats(glb, s.points, s.count, SE3DI_GLB_VEC3, 34962);
    accessors[1] = se3di_glb_add_floats(glb, s.normals, s.count, SE3DI_GLB_VEC3, 34962);
    accessors[2] = add_indices(glb, s.vertex, count, s.count);
}

/* Accessors of positions, normals and indices, made when they are first asked for. */
static const long *find_surface(se3di_glb *glb, const se3di_part *part)
{
    if (!part->mesh) {
        if (glb->unit[part->unit][0] < 0) {
            add_unit(glb, part->unit);
        }
        return glb->unit[part->unit];
    }
    for (size_t k = 0; k < glb->surface_count; ++k) {
        if (glb->surfaces[k].mesh == part->mesh) {
            return glb->surfaces[k].accessors;
        }
    }
    struct se3di_glb_surface made = {part->mesh, {-1, -1, -1}};
    struct se3di_glb_surface *grown = se3di_iopool_grow(
        glb->pool, glb->surfaces, glb->surface_count, &glb->surface_capacity, sizeof *grown);
    if (!grown) {
        glb->failed = true;
        return glb->unit[part->unit];
    }
    add_surface(glb, part->mesh, made.accessors);
    glb->surfaces = grown;
    glb->surfaces[glb->surface_count] = made;
    return glb->surfaces[glb->surface_count++].accessors;
}

/* The number of a mesh that looks so, or of all. */
static size_t find_look(const se3di_glb *glb, const struct se3di_glb_look *look)
{
    size_t k = 0;
    while (k < glb->mesh_count &&
           (glb->looks[k].surface != look->surface || glb->looks[k].style != look->style ||
            memcmp(glb->looks[k].color, look->color, sizeof look->color) != 0)) {
        ++k;
    }
    return k;
}

static void put_material(se3di_glb *glb, const struct se3di_glb_look *look)
{
    static const double metals[] = {
        [SE3DI_STYLE_PAINT] = 0.1, [SE3DI_STYLE_STEEL] = 0.8, [SE3DI_STYLE_RUBBER] = 0.0,
        [SE3DI_STYLE_GLASS] = 0.0, [SE3DI_STYLE_SAND] = 0.0,  [SE3DI_STYLE_WIRE] = 0.0};
    static const double roughs[] = {
        [SE3DI_STYLE_PAINT] = 0.6,  [SE3DI_STYLE_STEEL] = 0.35, [SE3DI_STYLE_RUBBER] = 0.95,
        [SE3DI_STYLE_GLASS] = 0.05, [SE3DI_STYLE_SAND] = 1.0,   [SE3DI_STYLE_WIRE] = 1.0};
    se3di_glb_put(glb, &glb->materials, "%s{\"pbrMetallicRoughness\":{\"metallicFactor\":",
                  glb->mesh_count > 0 ? "," : "");
    se3di_glb_put_number(glb, &glb->materials, metals[look->style]);
    se3di_glb_put(glb, &glb->materials, ",\"roughnessFactor\":");
    se3di_glb_put_number(glb, &glb->materials, roughs[look->style]);
    se3di_glb_put(glb, &glb->materials, ",\"baseColorFactor\":[");
    for (size_t k = 0; k < 4; ++k) {
        se3di_glb_put(glb, &glb->materials, k > 0 ? "," : "");
        se3di_glb_put_number(glb, &glb->materials, look->color[k]);
    }
    se3di_glb_put(glb, &glb->materials, "]},\"doubleSided\":true%s%s}",
                  look->color[3] < 1.0 ? ",\"alphaMode\":\"BLEND\"" : "",
                  look->style == SE3DI_STYLE_WIRE ? ",\"extras\":{\"style\":\"wire\"}" : "");
}

/* For who bends the wire of a coil, or draws what is closed and round in another way. */
static const char *const unit_names[SE3DI_UNIT_COUNT] = {
    "\"name\":\"box\",",  "\"name\":\"sphere\",", "\"name\":\"cylinder\",", "\"name\":\"coil\",",
    "\"name\":\"grid\",", "\"name\":\"cone\",",   "\"name\":\"sphere\","};

/* Parts of one surface, colour and style share a mesh. */
size_t se3di_glb_add_mesh(se3di_glb *glb, const se3di_part *part)
{
    const long *surface = find_surface(glb, part);
    struct se3di_glb_look look = {surface[0], {0.0}, part->style, 0};
    memcpy(look.color, part->color, sizeof look.color);
    const size_t index = find_look(glb, &look);
    if (index < glb->mesh_count) {
        return index;
    }
    struct se3di_glb_look *grown = se3di_iopool_grow(glb->pool, glb->looks, glb->mesh_count,
                                                     &glb->look_capacity, sizeof *grown);
    if (!grown) {
        glb->failed = true;
        return 0;
    }
    glb->looks = grown;
    glb->looks[index] = look;
    se3di_glb_put(glb, &glb->meshes, "%s{%s\"primitives\":[{\"attributes\":{\"POSITION\":%ld",
                  index > 0 ? "," : "", part->mesh ? "" : unit_names[part->unit], surface[0]);
    if (surface[2] >= 0) {
        se3di_glb_put(glb, &glb->meshes, ",\"NORMAL\":%ld},\"indices\":%ld", surface[1],
                      surface[2]);
    } else if (surface[1] >= 0) {
        se3di_glb_put(glb, &glb->meshes, ",\"NORMAL\":%ld}", surface[1]);
    } else {
        se3di_glb_put(glb, &glb->meshes, "},\"mode\":1");
    }
    se3di_glb_put(glb, &glb->meshes, ",\"material\":%zu}]}", index);
    put_material(glb, &look);
    return glb->mesh_count++;
}

static void write_chunk(FILE *file, const se3di_iobytes *bytes, const char *type)
{
    unsigned char head[8];
    se3di_little_put(head, (uint32_t)bytes->count, 4);
    memcpy(head + 4, type, 4);
    fwrite(head, 1, 8, file);
    fwrite(bytes->data, 1, bytes->count, file);
}

static void write_file(FILE *file, const se3di_iobytes *json, const se3di_iobytes *binary)
{
    unsigned char head[12] = {'g', 'l', 'T', 'F'};
    se3di_little_put(head + 4, 2, 4);
    se3di_little_put(head + 8, (uint32_t)(28 + json->count + binary->count), 4);
    fwrite(head, 1, sizeof head, file);
    write_chunk(file, json, "JSON");
    write_chunk(file, binary, "BIN\0");
}

bool se3di_glb_write(se3di_glb *glb, const se3di_iobytes *rest, FILE *file)
{
    static const char *const names[] = {",\"bufferViews\":[", "],\"accessors\":[", "],\"meshes\":[",
                                        "],\"materials\":["};
    const se3di_iobytes *const parts[] = {&glb->views, &glb->accessors, &glb->meshes,
                                          &glb->materials};
    se3di_iobytes json = {NULL, 0, 0};
    pad(glb, &glb->binary, "\0\0\0");
    se3di_glb_put(glb, &json,
                  "{\"asset\":{\"version\":\"2.0\",\"generator\":\"libse3d %s\"},"
                  "\"buffers\":[{\"byteLength\":%zu}]",
                  se3d_version_get_text(), glb->binary.count);
    for (size_t k = 0; k < 4; ++k) {
        se3di_glb_put(glb, &json, "%s", names[k]);
        se3di_glb_put_bytes(glb, &json, parts[k]->data, parts[k]->count);
    }
    se3di_glb_put(glb, &json, "]");
    se3di_glb_put_bytes(glb, &json, rest->data, rest->count);
    se3di_glb_put(glb, &json, "}");
    pad(glb, &json, "   ");
    if (glb->failed) {
        errno = ENOMEM;
        return false;
    }
    if (json.count > UINT32_MAX / 2 || glb->binary.count > UINT32_MAX / 2) { /* sizes are 32 bits */
        errno = EFBIG;
        return false;
    }
    write_file(file, &json, &glb->binary);
    return true;
}
