/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids of uniform density. That inside a closed mesh is the sum of the tetrahedra from any point
 * to its triangles a b c, negative ones included (the divergence theorem). With s = a + b + c:
 *
 *     V = a . (b x c) / 6
 *     int x dV = V s / 4
 *     int x x^T dV = V (a a^T + b b^T + c c^T + s s^T) / 20
 *
 * It is closed if triangles pass every edge as often one way as the other. */
#include "io/read/solid.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/model/mesh.h"
#include "io/read/shape_kinds.h"

static void set_diagonal(double x, double y, double z, double inertia[9])
{
    memset(inertia, 0, 9 * sizeof *inertia);
    inertia[0] = x;
    inertia[4] = y;
    inertia[8] = z;
}

static void measure_simple(const se3d_model_shape *shape, double density, se3di_solid *solid)
{
    const se3di_shape_row *row = se3di_shape_row_of(shape);
    const double *size = shape->size;
    if (row->weigh) {
        double J[3];
        row->weigh(shape, density, &solid->mass, J);
        set_diagonal(J[0], J[1], J[2], solid->inertia);
    }
    solid->size = shape->radius + shape->length + size[0] + size[1] + size[2];
}

/* An edge between points of different places. */
typedef struct edge {
    uint32_t low, high; /* low < high: the first points at these places */
    uint32_t count;     /* of triangles; 0: a free entry */
    int32_t sum;        /* of those that pass it from low to high, less the others */
} edge;

typedef struct seam {
    const se3di_mesh *mesh;
    uint32_t *first;               /* [point_count] the first point at the same place */
    uint32_t *table;               /* [table_size] first points + 1, by place; 0: free */
    edge *edges;                   /* [edges_size] */
    size_t table_size, edges_size; /* powers of two */
} seam;

static uint64_t mix(uint64_t hash, uint64_t value)
{
    hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 29;
}

static uint64_t hash_place(const double p[3])
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
        const double value = p[k] + 0.0; /* -0 is 0 */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = mix(hash, bits);
    }
    return hash;
}

static bool is_same_place(const double *a, const double *b)
{
    return !(a[0] < b[0] || a[0] > b[0] || a[1] < b[1] || a[1] > b[1] || a[2] < b[2] ||
             a[2] > b[2]);
}

static size_t power_above(size_t count)
{
    size_t size = 16;
    while (size < count) {
        size *= 2;
    }
    return size;
}

static void weld_points(seam *s)
{
    const double *points = s->mesh->points;
    for (uint32_t k = 0; k < s->mesh->point_count; ++k) {
        const double *p = points + 3 * (size_t)k;
        size_t at = hash_place(p) & (s->table_size - 1);
        while (s->table[at] != 0 && !is_same_place(points + 3 * (size_t)(s->table[at] - 1), p)) {
            at = (at + 1) & (s->table_size - 1);
        }
        if (s->table[at] == 0) {
            s->table[at] = k + 1;
        }
        s->first[k] = s->table[at] - 1;
    }
}

/* The entry of edge `side` of a triangle, NULL if its ends coincide; *way: 1 from low to high. */
static edge *find_edge(const seam *s, size_t triangle, size_t side, int32_t *way)
{
    const uint32_t *t = s->mesh->triangles + 3 * triangle;
    const uint32_t from = s->first[t[side]];
    const uint32_t to = s->first[t[(side + 1) % 3]];
    const uint32_t low = from < to ? from : to;
    const uint32_t high = from < to ? to : from;
    if (from == to) {
        return NULL;
    }
    size_t at = mix(mix(0, low), high) & (s->edges_size - 1);
    while (s->edges[at].count > 0 && (s->edges[at].low != low || s->edges[at].high != high)) {
        at = (at + 1) & (s->edges_size - 1);
    }
    s->edges[at].low = low;
    s->edges[at].high = high;
    *way = from < to ? 1 : -1;
    return &s->edges[at];
}

static bool fail_edge(se3di_reader *reader, const se3di_node *node, const se3di_mesh *mesh,
                      const edge *e)
{
    const double *a = mesh->points + 3 * (size_t)e->low;
    const double *b = mesh->points + 3 * (size_t)e->high;
    const char *why =
        e->count == 1 ? "has one triangle only, must have two: the surface is open"
        : e->count == 2
            ? "is passed twice in the same direction: one of its two triangles is inverted"
            : "has triangles that do not pass it equally often in both directions";
    return se3di_reader_fail_key(
        reader, node, "file",
        "`%.200s` does not enclose a solid with a mass: the edge from [%.9g, %.9g, %.9g] to [%.9g, "
        "%.9g, %.9g] %s; repair it, or give the body mass and inertia",
        mesh->file, a[0], a[1], a[2], b[0], b[1], b[2], why);
}

static bool check_closed(se3di_reader *reader, const se3di_node *node, const se3di_mesh *mesh)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &reader->pool->allocator);
    const size_t sides = 3 * mesh->triangle_count;
    seam s = {.mesh = mesh};
    s.table_size = power_above(2 * mesh->point_count);
    s.edges_size = power_above(2 * sides);
    s.first = se3di_iopool_array(&pool, mesh->point_count, sizeof *s.first);
    s.table = se3di_iopool_array(&pool, s.table_size, sizeof *s.table);
    s.edges = se3di_iopool_array(&pool, s.edges_size, sizeof *s.edges);
    bool good = s.first && s.table && s.edges;
    if (!good) {
        se3di_reader_fail_memory(reader);
    } else {
        int32_t way = 0;
        weld_points(&s);
        for (size_t k = 0; k < sides; ++k) {
            edge *e = find_edge(&s, k / 3, k % 3, &way);
            if (e) {
                ++e->count;
                e->sum += way;
            }
        }
        for (size_t k = 0; good && k < sides; ++k) {
            const edge *e = find_edge(&s, k / 3, k % 3, &way);
            good = !e || e->sum == 0 || fail_edge(reader, node, mesh, e);
        }
    }
    se3di_iopool_destroy(&pool);
    return good;
}

/* Volume, first and second moments {xx, yy, zz, xy, yz, xz} about `origin`. */
typedef struct moments {
    double volume, first[3], second[6];
} moments;

static const int first_of[6] = {0, 1, 2, 0, 1, 0};
static const int second_of[6] = {0, 1, 2, 1, 2, 2};

static void add_tetrahedron(const se3di_mesh *mesh, size_t triangle, const double origin[3],
                            moments *m)
{
    double x[4][3]; /* the corners and their sum */
    for (int k = 0; k < 3; ++k) {
        for (size_t c = 0; c < 3; ++c) {
            const size_t point = mesh->triangles[3 * triangle + c];
            x[c][k] = mesh->points[3 * point + (size_t)k] - origin[k];
        }
        x[3][k] = x[0][k] + x[1][k] + x[2][k];
    }
    const double *a = x[0];
    const double *b = x[1];
    const double *c = x[2];
    const double volume = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0])) /
                          6.0;
    m->volume += volume;
    for (int k = 0; k < 3; ++k) {
        m->first[k] += 0.25 * volume * x[3][k];
    }
    for (int k = 0; k < 6; ++k) {
        const int i = first_of[k];
        const int j = second_of[k];
        m->second[k] +=
            0.05 * volume * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + x[3][i] * x[3][j]);
    }
}

static bool measure_mesh(se3di_reader *reader, const se3di_node *node, const se3di_mesh *mesh,
                         double density, se3di_solid *solid)
{
    double origin[3]; /* in the middle: far from it digits would be lost */
    double box = 1.0;
    moments m = {0};
    if (!check_closed(reader, node, mesh)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        origin[k] = 0.5 * (mesh->low[k] + mesh->high[k]);
        box *= mesh->high[k] - mesh->low[k];
        solid->size += mesh->high[k] - mesh->low[k];
    }
    for (size_t k = 0; k < mesh->triangle_count; ++k) {
        add_tetrahedron(mesh, k, origin, &m);
    }
    if (!(fabs(m.volume) > 1e-9 * box)) {
        return se3di_reader_fail_key(reader, node, "file",
                                     "`%.200s` does not enclose a volume, which a body with that "
                                     "`density` needs; or give the body mass and inertia",
                                     mesh->file);
    }
    solid->mass = density * fabs(m.volume);
    double spread[6]; /* int x x^T dm about the centre; a surface all inverted bounds the same */
    for (int k = 0; k < 3; ++k) {
        solid->centre[k] = origin[k] + m.first[k] / m.volume;
    }
    for (int k = 0; k < 6; ++k) {
        const double shift = m.first[first_of[k]] * m.first[second_of[k]] / m.volume;
        spread[k] = solid->mass * (m.second[k] - shift) / m.volume;
    }
    set_diagonal(spread[1] + spread[2], spread[2] + spread[0], spread[0] + spread[1],
                 solid->inertia);
    solid->inertia[1] = solid->inertia[3] = -spread[3];
    solid->inertia[5] = solid->inertia[7] = -spread[4];
    solid->inertia[2] = solid->inertia[6] = -spread[5];
    return true;
}

bool se3di_solid_measure(se3di_reader *reader, const se3di_node *node,
                         const se3d_model_shape *shape, const se3di_mesh *mesh, double density,
                         se3di_solid *solid)
{
    memset(solid, 0, sizeof *solid);
    if (mesh && !mesh->of && density > 0.0) { /* a heightfield encloses nothing */
        return measure_mesh(reader, node, mesh, density, solid);
    }
    measure_simple(shape, density, solid);
    return true;
}
