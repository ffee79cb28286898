/* SPDX-License-Identifier: BSD-3-Clause */
/* Bars, arms and plates: what they weigh and look like. A bar of length L whose section has the
 * area A and the second moments Ix = int y^2, Iy = int x^2 about its middle weighs, z along it,
 *
 *     V = A L      Jx/rho = L Ix + A L^3/12      Jy/rho = L Iy + A L^3/12      Jz/rho = L (Ix + Iy)
 *
 * round: A = pi (R^2 - r^2), Ix = Iy = pi (R^4 - r^4)/4; flat: A = w h - w' h',
 * Ix = (w h^3 - w' h'^3)/12, Iy = (h w^3 - h' w'^3)/12, with r, w', h' of the hollow. A plate is a
 * short bar whose section is a polygon, the sum of the triangles from one corner: of a triangle of
 * area a with the corners p, q, s of the sum u, int x x^T = a (p p^T + q q^T + s s^T + u u^T)/12.
 * The two bars of an arm overlap where they meet: both count there. */
#include "io/read/bars.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/shapes.h"
#include "math/vec3.h"

#define PI   3.14159265358979323846
#define FLAT 1e-6 /* of its size: how far a corner of a plate may be off its plane */

static double norm(const double v[3])
{
    return io_hypot(io_hypot(v[0], v[1]), v[2]);
}

/* Unit columns x, y, z with z along `z` and x in the plane of z and `across`. @return the length of
 * z, 0: the two have no plane */
static double make_axes(const double z[3], const double across[3], double A[9])
{
    const double length = norm(z);
    double x[3], y[3];
    se3di_cross(z, across, y);
    const double size = norm(y);
    if (!(length > 0.0) || !(size > 1e-9 * length * norm(across))) {
        return 0.0;
    }
    se3di_cross(y, z, x);
    for (int k = 0; k < 3; ++k) {
        A[3 * k] = x[k] / (size * length);
        A[3 * k + 1] = y[k] / size;
        A[3 * k + 2] = z[k] / length;
    }
    return length;
}

/* Axes of a leg, z from its point to `to`. @return its length, 0: it has none, or no direction x */
static double leg_axes(const se3di_bar *bar, size_t leg, double A[9])
{
    double z[3], across[3];
    se3di_sub(bar->to, bar->from[leg], z);
    memcpy(across, bar->across, sizeof across);
    if (!(norm(across) > 0.0)) { /* horizontal; of an upright leg along x */
        const bool upright = io_hypot(z[0], z[1]) <= 1e-9 * norm(z);
        across[0] = upright ? 1.0 : 0.0 - z[1];
        across[1] = upright ? 0.0 : z[0];
    }
    return make_axes(z, across, A);
}

/* ---- sections -------------------------------------------------------------------------------*/

/* About its middle: the area, int x^2, int y^2, int x y. */
typedef struct section {
    double area, xx, yy, xy;
} section;

static section round_section(double radius, double wall)
{
    const double R = radius * radius;
    const double inner = wall > 0.0 ? radius - wall : 0.0;
    const double r = inner * inner;
    const double second = 0.25 * PI * (R - r) * (R + r);
    return (section){PI * (R - r), second, second, 0.0};
}

static section flat_section(double w, double h, double wall)
{
    const double a = wall > 0.0 ? w - 2.0 * wall : 0.0;
    const double b = wall > 0.0 ? h - 2.0 * wall : 0.0;
    return (section){w * h - a * b, (h * w * w * w - b * a * a * a) / 12.0,
                     (w * h * h * h - a * b * b * b) / 12.0, 0.0};
}

/* Of the polygon of a plate in the plane of x and y of A, with its middle in the ground. */
static section plate_section(const se3di_bar *bar, const double A[9], double middle[3])
{
    section s = {0.0, 0.0, 0.0, 0.0};
    double mean[2] = {0.0, 0.0};
    double corner[SE3DI_PLATE_CORNERS_MAX][2];
    for (size_t k = 0; k < bar->corner_count; ++k) {
        double d[3];
        se3di_sub(bar->corners[k], bar->corners[0], d);
        for (int i = 0; i < 2; ++i) {
            corner[k][i] = A[i] * d[0] + A[3 + i] * d[1] + A[6 + i] * d[2];
        }
    }
    for (size_t k = 1; k + 1 < bar->corner_count; ++k) { /* corner 0 is the origin */
        const double *p = corner[k], *q = corner[k + 1];
        const double area = 0.5 * (p[0] * q[1] - p[1] * q[0]);
        const double u[2] = {p[0] + q[0], p[1] + q[1]};
        s.area += area;
        mean[0] += area * u[0] / 3.0;
        mean[1] += area * u[1] / 3.0;
        s.xx += area * (p[0] * p[0] + q[0] * q[0] + u[0] * u[0]) / 12.0;
        s.yy += area * (p[1] * p[1] + q[1] * q[1] + u[1] * u[1]) / 12.0;
        s.xy += area * (p[0] * p[1] + q[0] * q[1] + u[0] * u[1]) / 12.0;
    }
    mean[0] /= s.area;
    mean[1] /= s.area;
    s.xx -= s.area * mean[0] * mean[0];
    s.yy -= s.area * mean[1] * mean[1];
    s.xy -= s.area * mean[0] * mean[1];
    for (int k = 0; k < 3; ++k) {
        middle[k] = bar->corners[0][k] + A[3 * k] * mean[0] + A[3 * k + 1] * mean[1];
    }
    return s;
}

/* ---- mass -----------------------------------------------------------------------------------*/

/* Of density 1: the volume, its centre, the inertia about it along the axes of the ground. */
typedef struct solid {
    double volume, centre[3], J[9];
} solid;

static solid make_solid(const section *s, double length, const double A[9], const double centre[3])
{
    solid out = {.volume = s->area * length};
    const double bend = out.volume * length * length / 12.0;
    const double own[9] = {length * s->yy + bend,
                           0.0 - length * s->xy,
                           0.0,
                           0.0 - length * s->xy,
                           length * s->xx + bend,
                           0.0,
                           0.0,
                           0.0,
                           length * (s->xx + s->yy)};
    memcpy(out.centre, centre, sizeof out.centre);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 9; ++k) {
                out.J[3 * i + j] += A[3 * i + k / 3] * own[k] * A[3 * j + k % 3];
            }
        }
    }
    return out;
}

/* Normal of a plate: the sum over its triangles, twice its area. */
static void plate_normal(const se3di_bar *bar, double n[3])
{
    memset(n, 0, 3 * sizeof *n);
    for (size_t k = 1; k + 1 < bar->corner_count; ++k) {
        double p[3], q[3], part[3];
        se3di_sub(bar->corners[k], bar->corners[0], p);
        se3di_sub(bar->corners[k + 1], bar->corners[0], q);
        se3di_cross(p, q, part);
        for (int i = 0; i < 3; ++i) {
            n[i] += part[i];
        }
    }
}

static double plate_axes(const se3di_bar *bar, double A[9])
{
    double n[3], side[3];
    plate_normal(bar, n);
    se3di_sub(bar->corners[1], bar->corners[0], side);
    return make_axes(n, side, A);
}

static solid part_of(const se3di_bar *bar, size_t k)
{
    double A[9], middle[3];
    if (bar->corner_count > 0) {
        plate_axes(bar, A);
        const section s = plate_section(bar, A, middle);
        return make_solid(&s, bar->thickness, A, middle);
    }
    const section s = bar->radius > 0.0 ? round_section(bar->radius, bar->wall)
                                        : flat_section(bar->width, bar->thickness, bar->wall);
    for (int i = 0; i < 3; ++i) {
        middle[i] = 0.5 * (bar->from[k][i] + bar->to[i]);
    }
    const double length = leg_axes(bar, k, A);
    return make_solid(&s, length, A, middle);
}

double se3di_bar_weigh(const se3di_bar *bar, double centre[3], double inertia[6])
{
    static const int place[6] = {0, 4, 8, 1, 5, 2};
    const size_t count = bar->corner_count > 0 ? 1 : bar->leg_count;
    solid parts[SE3DI_BAR_LEGS];
    double J[9] = {0.0};
    double volume = 0.0;
    memset(centre, 0, 3 * sizeof *centre);
    for (size_t k = 0; k < count; ++k) {
        parts[k] = part_of(bar, k);
        volume += parts[k].volume;
    }
    for (size_t k = 0; k < count; ++k) {
        for (int i = 0; i < 3; ++i) {
            centre[i] += parts[k].volume / volume * parts[k].centre[i];
        }
    }
    for (size_t k = 0; k < count; ++k) {
        double d[3];
        se3di_sub(parts[k].centre, centre, d);
        for (int i = 0; i < 9; ++i) {
            const double square = i % 4 == 0 ? se3di_dot(d, d) : 0.0;
            J[i] += parts[k].J[i] + parts[k].volume * (square - d[i / 3] * d[i % 3]);
        }
    }
    for (int i = 0; i < 6; ++i) {
        inertia[i] = J[place[i]] / volume;
    }
    return volume;
}

/* ---- reading --------------------------------------------------------------------------------*/

bool se3di_is_bar(const se3di_node *body)
{
    return se3di_node_get(body, "from") || se3di_node_get(body, "plate");
}

static bool has(const se3di_node *node, const char *key)
{
    return se3di_node_get(node, key) != NULL;
}

/* None of the keys stands beside `beside`. */
static bool refuse(se3di_reader *reader, const se3di_node *node, const char *const *keys,
                   const char *beside, const char *why)
{
    for (; *keys; ++keys) {
        if (has(node, *keys)) {
            return se3di_reader_fail_key(reader, node, *keys, "cannot be combined with `%s`: %s",
                                         beside, why);
        }
    }
    return true;
}

static bool need(se3di_reader *reader, const se3di_node *node, const char *key, const char *what)
{
    return has(node, key) ||
           se3di_reader_fail_key(reader, node, key, "is missing, %s needs it [m]", what);
}

static bool check_section(se3di_reader *reader, const se3di_node *node, const se3di_bar *bar)
{
    static const char *const flat[] = {"width", "thickness", "across", NULL};
    const bool round = has(node, "radius");
    if (!round && !has(node, "width") && !has(node, "thickness")) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing: a bar from point to point needs a `radius`, or "
                                     "`width` and `thickness` [m]");
    }
    if (round ? !refuse(reader, node, flat, "radius", "a bar is round or flat")
              : !need(reader, node, "width", "a flat bar") ||
                    !need(reader, node, "thickness", "a flat bar")) {
        return false;
    }
    const double half = round ? bar->radius : 0.5 * fmin(bar->width, bar->thickness);
    if (bar->wall > half) {
        return se3di_reader_fail_key(reader, node, "wall",
                                     "is %g m, must be at most half of the section, %g m",
                                     bar->wall, half);
    }
    return true;
}

static bool read_legs(se3di_reader *reader, const se3di_node *node, se3di_bar *bar)
{
    double A[9];
    if (!has(node, "to")) {
        return se3di_reader_fail_key(reader, node, "to",
                                     "is missing, a bar goes from a point to a point");
    }
    bar->leg_count = has(node, "from_2") ? 2 : 1;
    if (!se3di_read_key_vector(reader, node, "from", bar->from[0]) ||
        !se3di_read_key_vector(reader, node, "from_2", bar->from[1]) ||
        !check_section(reader, node, bar)) {
        return false;
    }
    for (size_t leg = 0; leg < bar->leg_count; ++leg) {
        const char *key = leg == 0 ? "from" : "from_2";
        double d[3];
        se3di_sub(bar->to, bar->from[leg], d);
        if (!(norm(d) > 0.0)) {
            return se3di_reader_fail_key(reader, node, key,
                                         "is where `to` is, the bar has no "
                                         "length");
        }
        if (!(leg_axes(bar, leg, A) > 0.0)) {
            return se3di_reader_fail_key(reader, node, "across",
                                         "goes along the bar from `%s`, must go across it", key);
        }
    }
    return true;
}

/* Flat, and turning the same way at every corner. */
static bool check_corners(se3di_reader *reader, const se3di_node *list, const se3di_bar *bar)
{
    const size_t n = bar->corner_count;
    double A[9], normal[3];
    double size = 0.0;
    plate_normal(bar, normal);
    for (size_t k = 1; k < n; ++k) {
        double d[3];
        se3di_sub(bar->corners[k], bar->corners[0], d);
        size = fmax(size, norm(d));
    }
    if (!(norm(normal) > 1e-9 * size * size) || !(plate_axes(bar, A) > 0.0)) {
        return se3di_reader_fail(reader, list, "has its corners on one line, must have an area");
    }
    const se3di_node *node = list->first;
    for (size_t k = 0; k < n; ++k, node = node->next) {
        double d[3], before[3], after[3], turn[3];
        se3di_sub(bar->corners[k], bar->corners[0], d);
        se3di_sub(bar->corners[k], bar->corners[(k + n - 1) % n], before);
        se3di_sub(bar->corners[(k + 1) % n], bar->corners[k], after);
        se3di_cross(before, after, turn);
        const double off = fabs(d[0] * A[2] + d[1] * A[5] + d[2] * A[8]);
        if (off > FLAT * size) {
            return se3di_reader_fail(reader, node,
                                     "is %.3g m off the plane of the others, a plate is flat", off);
        }
        if (!(se3di_dot(turn, normal) > 0.0)) {
            return se3di_reader_fail(reader, node,
                                     "turns the other way than the others, or is on a straight "
                                     "line: list the corners of a convex plate one after the other "
                                     "around it");
        }
    }
    return true;
}

static bool read_plate(se3di_reader *reader, const se3di_node *node, se3di_bar *bar)
{
    static const char *const others[] = {"from", "to",    "from_2", "radius",
                                         "wall", "width", "across", NULL};
    const se3di_node *list = se3di_node_get(node, "plate");
    if (!refuse(reader, node, others, "plate", "a plate has corners and a thickness") ||
        !need(reader, node, "thickness", "a plate")) {
        return false;
    }
    if (list->kind != SE3DI_NODE_LIST || list->count < 3 || list->count > SE3DI_PLATE_CORNERS_MAX) {
        return se3di_reader_fail(reader, list, "must be a list of 3 to %d points, its corners",
                                 SE3DI_PLATE_CORNERS_MAX);
    }
    for (const se3di_node *corner = list->first; corner; corner = corner->next) {
        if (!se3di_read_vector(reader, corner, 3, bar->corners[bar->corner_count++])) {
            return false;
        }
    }
    return check_corners(reader, list, bar);
}

bool se3di_read_bar(se3di_reader *reader, const se3di_node *body, se3di_bar *bar)
{
    static const char *const own[] = {"to",      "from_2",    "radius",   "wall",
                                      "width",   "thickness", "across",   "body_from",
                                      "body_to", "spin",      "material", "contact"};
    static const char *const placed[] = {"position", "orientation", NULL};
    static const char *const weighed[] = {"inertia", NULL};
    int32_t touches = 1; /* is asked for by the shapes */
    memset(bar, 0, sizeof *bar);
    for (size_t k = 0; !se3di_is_bar(body) && k < sizeof own / sizeof *own; ++k) {
        if (has(body, own[k]) && !body->incomplete) {
            return se3di_reader_fail_key(reader, body, own[k],
                                         "has no effect without `from`, the beginning of a bar, or "
                                         "`plate`");
        }
    }
    if (!se3di_is_bar(body)) {
        return true;
    }
    const char *by = has(body, "plate") ? "plate" : "from";
    return refuse(reader, body, placed, by,
                  "the points say where the body is, at its centre of mass with the axes of the "
                  "ground") &&
           refuse(reader, body, weighed, by,
                  "it follows from the points, the section and the mass") &&
           se3di_read_key(reader, body, &se3di_object_body, NULL, "contact", &touches) &&
           se3di_read_fields(reader, body, &se3di_object_body, NULL, "se3di_bar", bar) &&
           (has(body, "plate") ? read_plate(reader, body, bar) : read_legs(reader, body, bar));
}

/* ---- drawing --------------------------------------------------------------------------------*/

static const se3d_model_shape plain_shape = {
    .scale = 1.0, .orientation = {1.0, 0.0, 0.0, 0.0}, .color = {-1.0, -1.0, -1.0}, .file = ""};

/* A map with what contact asks of a shape, as the body says it. */
static const se3di_node *describe(se3di_reader *reader, const se3di_node *body)
{
    static const char *const keys[] = {"material", "contact"};
    se3di_node *map = se3di_iopool_array(reader->pool, 3, sizeof *map);
    if (!map) {
        se3di_reader_fail_memory(reader);
        return NULL;
    }
    map[0] = *body;
    map[0].first = map[0].last = NULL;
    map[0].count = 0;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; ++k) {
        const se3di_node *said = se3di_node_get(body, keys[k]);
        if (said) {
            se3di_node *child = &map[++map[0].count];
            *child = *said;
            child->next = NULL;
            if (map[0].last) {
                map[0].last->next = child;
            } else {
                map[0].first = child;
            }
            map[0].last = child;
        }
    }
    return map;
}

static bool add_leg(se3di_reader *reader, const se3di_node *node, const se3di_bar *bar, size_t leg,
                    const double centre[3], size_t entry)
{
    const bool round = bar->radius > 0.0;
    se3di_shape_entry made = {.shape = plain_shape, .opacity = 1.0};
    se3d_model_shape *shape = &made.shape;
    double A[9];
    const double length = leg_axes(bar, leg, A);
    shape->type = round ? SE3D_SHAPE_CYLINDER : SE3D_SHAPE_BOX;
    shape->radius = bar->radius;
    shape->length = round ? length : 0.0;
    shape->size[0] = bar->width;
    shape->size[1] = bar->thickness;
    shape->size[2] = round ? 0.0 : length;
    for (int k = 0; k < 3; ++k) {
        shape->position[k] = 0.5 * (bar->from[leg][k] + bar->to[k]) - centre[k];
    }
    se3di_rotation_from_matrix(A, shape->orientation);
    se3di_flip_vector(&reader->part->place, shape->position);
    se3di_flip_orientation(&reader->part->place, shape->orientation);
    return se3di_add_shape(reader, node, entry, &made);
}

/* Triangles of a plate: corner k on both sides is point 2 k and 2 k + 1. */
static void put_triangles(size_t n, bool mirrored, uint32_t *triangles)
{
    uint32_t(*t)[3] = (uint32_t(*)[3])triangles;
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t next = k + 1 < n ? k + 1 : 0;
        if (k + 2 < n) { /* the faces, as fans from corner 0 */
            const uint32_t faces[2][3] = {{0, 2 * k + 4, 2 * k + 2}, {1, 2 * k + 3, 2 * k + 5}};
            memcpy(t, faces, sizeof faces);
            t += 2;
        }
        const uint32_t sides[2][3] = {{2 * k, 2 * next, 2 * next + 1},
                                      {2 * k, 2 * next + 1, 2 * k + 1}};
        memcpy(t, sides, sizeof sides);
        t += 2;
    }
    for (uint32_t *each = triangles; mirrored && each < (uint32_t *)t; each += 3) {
        const uint32_t other = each[1];
        each[1] = each[2];
        each[2] = other;
    }
}

/* A plate is a mesh of its corners on both sides, and touches as their hull. */
static bool add_plate(se3di_reader *reader, const se3di_node *node, const se3di_bar *bar,
                      const double centre[3], size_t entry)
{
    const size_t n = bar->corner_count;
    const se3di_placement *place = &reader->part->place;
    se3di_shape_entry made = {.shape = plain_shape, .opacity = 1.0, .convex = 1};
    se3di_mesh *mesh = se3di_iopool_alloc(reader->pool, sizeof *mesh);
    double A[9];
    if (mesh) {
        mesh->points = se3di_iopool_array(reader->pool, 6 * n, sizeof *mesh->points);
        mesh->triangles = se3di_iopool_array(reader->pool, 12 * n, sizeof *mesh->triangles);
    }
    if (!mesh || !mesh->points || !mesh->triangles) {
        return se3di_reader_fail_memory(reader);
    }
    plate_axes(bar, A);
    mesh->file = mesh->model = "";
    mesh->mirror = place->mirror;
    mesh->scale = 1.0;
    mesh->point_count = 2 * n;
    mesh->triangle_count = 4 * n - 4;
    for (size_t k = 0; k < 2 * n; ++k) {
        double *p = mesh->points + 3 * k;
        for (int i = 0; i < 3; ++i) {
            p[i] = bar->corners[k / 2][i] - centre[i] +
                   (k % 2 == 0 ? -0.5 : 0.5) * bar->thickness * A[3 * i + 2];
        }
        se3di_flip_vector(place, p);
        for (int i = 0; i < 3; ++i) {
            mesh->low[i] = k == 0 ? p[i] : fmin(mesh->low[i], p[i]);
            mesh->high[i] = k == 0 ? p[i] : fmax(mesh->high[i], p[i]);
        }
    }
    put_triangles(n, place->mirror >= 0, mesh->triangles);
    made.shape.type = SE3D_SHAPE_MESH;
    made.mesh = mesh;
    return se3di_add_shape(reader, node, entry, &made);
}

bool se3di_add_bar_shapes(se3di_reader *reader, const se3di_node *body, const se3di_bar *bar,
                          size_t entry)
{
    double centre[3], inertia[6];
    const se3di_node *node = describe(reader, body);
    if (!node) {
        return false;
    }
    se3di_bar_weigh(bar, centre, inertia);
    if (bar->corner_count > 0) {
        return add_plate(reader, node, bar, centre, entry);
    }
    for (size_t leg = 0; leg < bar->leg_count; ++leg) {
        if (!add_leg(reader, node, bar, leg, centre, entry)) {
            return false;
        }
    }
    return true;
}
