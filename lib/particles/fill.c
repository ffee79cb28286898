/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/fill.h"

#include "base/floats.h"
#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/draw.h"
#include "particles/piece.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define TRIES 2000 /* to find room for one particle */

se3di_radii se3di_fill_radii(const se3d_fill_def *def)
{
    return (se3di_radii){def->radius_min, def->radius_max, def->radii, def->weights,
                         def->radius_count};
}

se3di_region se3di_fill_region(const se3d_fill_def *def)
{
    se3di_region region = {.kind = def->region, .axis = def->axis};
    memcpy(region.lower, def->lower, sizeof region.lower);
    memcpy(region.upper, def->upper, sizeof region.upper);
    return region;
}

/* The piece of this number, which has no place yet. */
static se3di_piece piece_of(const se3d_fill_def *def, uint32_t material, double radius,
                            size_t number)
{
    se3di_piece piece = {
        .clump = def->clump, .material = material, .tag = def->tag, .radius = radius};
    if (piece.clump > 0) {
        se3di_piece_turn(&piece, def->orientation, def->seed, number);
    }
    return piece;
}

typedef struct lattice {
    double spacing, margin[3]; /* margin: from the walls of the box */
    size_t n[3];
} lattice;

/* Along an axis with less room than the spacing, but enough for one, these stand in the middle. */
static double lattice_init(lattice *l, const se3d_fill_def *def)
{
    double total = 1.0;
    const double least = def->radius_max + def->jitter;
    l->spacing = def->spacing > 0.0 ? def->spacing : 2.2 * def->radius_max;
    for (int a = 0; a < 3; ++a) {
        const double width = def->upper[a] - def->lower[a];
        const double slack = se3di_region_slack(def->lower[a], l->spacing);
        l->margin[a] = fmax(0.5 * l->spacing, least);
        if (width < 2.0 * l->margin[a] - slack && width >= 2.0 * least - slack) {
            l->margin[a] = 0.5 * width;
        }
        if (se3di_region_is_flat(def->lower, def->upper, a)) {
            l->margin[a] = 0.0;
        }
        const double room = width - 2.0 * l->margin[a];
        double n = room < -slack ? 0.0 : floor((room + slack) / l->spacing) + 1.0;
        l->n[a] = n < 2e9 ? (size_t)n : (size_t)2e9;
        total *= n;
    }
    return total;
}

/* Point k of the lattice; returns whether the region holds whatever may be there. */
static int lattice_point(const lattice *l, const se3d_fill_def *def, size_t k, double x[3])
{
    const size_t at[3] = {k % l->n[0], k / l->n[0] % l->n[1], k / (l->n[0] * l->n[1])};
    for (int a = 0; a < 3; ++a) {
        x[a] = def->lower[a] + l->margin[a] + l->spacing * (double)at[a];
    }
    const se3di_region region = se3di_fill_region(def);
    return se3di_region_holds(&region, x, def->radius_max + sqrt(3.0) * def->jitter);
}

double se3di_lattice_count(const se3d_fill_def *def)
{
    lattice l;
    return lattice_init(&l, def);
}

size_t se3di_lattice_measure(const se3d_fill_def *def, size_t *points)
{
    lattice l;
    double x[3];
    const double total = lattice_init(&l, def);
    size_t wanted = 0;
    for (*points = 0;
         *points < (size_t)fmin(total, 1e18) && (def->count == 0 || wanted < def->count);
         ++*points) {
        wanted += lattice_point(&l, def, *points, x) ? 1 : 0;
    }
    return wanted;
}

void se3di_lattice_fill(se3di_particles *set, const se3d_fill_def *def, uint32_t material,
                        size_t points)
{
    lattice l;
    double x[3];
    uint64_t state = def->seed;
    const se3di_radii radii = se3di_fill_radii(def);
    size_t number = 0;
    (void)lattice_init(&l, def);
    for (size_t k = 0; k < points; ++k) {
        if (lattice_point(&l, def, k, x)) {
            double radius = se3di_radii_draw(&radii, &state);
            for (int a = 0; a < 3; ++a) {
                const double by = def->jitter * (2.0 * se3di_random_draw(&state) - 1.0);
                x[a] += se3di_region_is_flat(def->lower, def->upper, a) ? 0.0 : by;
            }
            se3di_piece piece = piece_of(def, material, radius, number++);
            se3di_copy(x, piece.x);
            se3di_piece_append(set, &piece, def->velocity);
        }
    }
}

double se3di_fill_most(const se3di_particles *set, const se3d_fill_def *def)
{
    double most = 1.0, volume = 4.0 / 3.0 * 3.1415926535897932384626433832795; /* over radius^3 */
    for (int a = 0; a < 3; ++a) {
        const double width = def->upper[a] - def->lower[a];
        const int flat = se3di_region_is_flat(def->lower, def->upper, a);
        most *= (flat ? 2.0 * def->radius_max : width) / def->radius_min;
    }
    if (def->clump > 0) {
        const se3di_clump_template *of = &set->templates[def->clump - 1];
        volume = of->volume / (of->bound * of->bound * of->bound);
    }
    return most / volume;
}

/* Cells over the region with chains of the particles in them. */
typedef struct packing {
    se3di_particles *set;
    const se3d_fill_def *def;
    double size;
    int cells[3];
    uint32_t *head; /* [cells] particle, SE3DI_NO_INDEX: none */
    uint32_t *next; /* [room] */
    size_t head_count, room;
} packing;

static int cell_along(const packing *p, double x, int a)
{
    double at = (x - p->def->lower[a]) / p->size;
    return at <= 0.0 ? 0 : at >= p->cells[a] - 1 ? p->cells[a] - 1 : (int)at;
}

static void enter(packing *p, size_t k)
{
    double x[3];
    se3di_copy(p->set->particles[k].x, x);
    for (int a = 0; a < 3; ++a) {
        if (p->set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) { /* the image nearest to the region */
            const double period = p->set->upper[a] - p->set->lower[a];
            const double off = x[a] - 0.5 * (p->def->lower[a] + p->def->upper[a]);
            x[a] -= period * se3di_nearest(off / period);
        }
        if (x[a] < p->def->lower[a] - p->size || x[a] > p->def->upper[a] + p->size) {
            return; /* too far to matter; those just outside are in the border cells */
        }
    }
    size_t cell =
        ((size_t)cell_along(p, x[2], 2) * (size_t)p->cells[1] + (size_t)cell_along(p, x[1], 1)) *
            (size_t)p->cells[0] +
        (size_t)cell_along(p, x[0], 0);
    p->next[k] = p->head[cell];
    p->head[cell] = (uint32_t)k;
}

static int cell_is_free(const packing *p, size_t cell, const double x[3], double radius)
{
    for (uint32_t k = p->head[cell]; k != SE3DI_NO_INDEX; k = p->next[k]) {
        const se3di_particle *g = &p->set->particles[k];
        double d[3];
        se3di_sub(g->x, x, d);
        se3di_particles_wrap(p->set, d);
        if (se3di_dot(d, d) < (g->radius + radius) * (g->radius + radius)) {
            return 0;
        }
    }
    return 1;
}

static int has_room(const packing *p, const double x[3], double radius)
{
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
        low[a] = cell_along(p, x[a] - p->size, a);
        high[a] = cell_along(p, x[a] + p->size, a);
        if (p->set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            /* images are in the border cells of the other side: a whole row is searched there */
            const double period = p->set->upper[a] - p->set->lower[a];
            const int whole = p->def->upper[a] - p->def->lower[a] > period;
            int border = whole || low[a] == 0 || high[a] == p->cells[a] - 1;
            low[a] = border ? 0 : low[a];
            high[a] = border ? p->cells[a] - 1 : high[a];
        }
    }
    for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
            for (int c = low[0]; c <= high[0]; ++c) {
                size_t cell =
                    ((size_t)z * (size_t)p->cells[1] + (size_t)y) * (size_t)p->cells[0] + (size_t)c;
                if (!cell_is_free(p, cell, x, radius)) {
                    return 0;
                }
            }
        }
    }
    return 1;
}

static int is_free(const packing *p, const se3di_piece *piece)
{
    const size_t spheres = se3di_piece_count(p->set, piece->clump);
    for (size_t k = 0; k < spheres; ++k) {
        double x[3];
        const double radius = se3di_piece_sphere(p->set, piece, k, x);
        if (!has_room(p, x, radius)) {
            return 0;
        }
    }
    return 1;
}

static se3d_status packing_init(packing *p, se3di_particles *set, const se3d_fill_def *def)
{
    double largest = def->radius_max;
    for (size_t k = 0; k < set->count; ++k) {
        largest = fmax(largest, set->particles[k].radius);
    }
    *p = (packing){.set = set, .def = def, .size = 2.0 * largest, .head_count = 1};
    p->room = set->count + def->count * se3di_piece_count(set, def->clump);
    for (int a = 0; a < 3; ++a) {
        double parts = floor((def->upper[a] - def->lower[a]) / p->size);
        p->cells[a] = parts < 1.0 ? 1 : (int)fmin(parts, 400.0);
        p->size = fmax(p->size, (def->upper[a] - def->lower[a]) / p->cells[a]);
    }
    for (int a = 0; a < 3; ++a) {
        p->head_count *= (size_t)p->cells[a];
    }
    p->head = se3di_alloc(&set->allocator, p->head_count, sizeof *p->head);
    p->next = se3di_alloc(&set->allocator, p->room, sizeof *p->next);
    if (!p->head || !p->next) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < p->head_count; ++k) {
        p->head[k] = SE3DI_NO_INDEX;
    }
    for (size_t k = 0; k < set->count; ++k) {
        enter(p, k);
    }
    return SE3D_OK;
}

static int place(packing *p, uint32_t material, size_t number, uint64_t *state)
{
    const se3d_fill_def *def = p->def;
    const se3di_radii radii = se3di_fill_radii(def);
    const se3di_region region = se3di_fill_region(def);
    se3di_piece piece = piece_of(def, material, se3di_radii_draw(&radii, state), number);
    for (int try = 0; try < TRIES; ++try) {
        se3di_region_draw(&region, piece.radius, state, piece.x);
        if (se3di_region_holds(&region, piece.x, piece.radius) && is_free(p, &piece)) {
            const size_t before = p->set->count;
            se3di_piece_append(p->set, &piece, def->velocity);
            for (size_t k = before; k < p->set->count; ++k) {
                enter(p, k);
            }
            return 1;
        }
    }
    return 0;
}

se3d_status se3di_random_fill(se3di_particles *set, const se3d_fill_def *def, uint32_t material,
                              size_t *placed)
{
    const size_t count = set->count;
    const size_t ids = set->id_count, clumps = set->clump_count;
    packing p;
    se3d_status status = packing_init(&p, set, def);
    uint64_t state = def->seed;
    for (*placed = 0; *placed < def->count && status == SE3D_OK; ++*placed) {
        if (!place(&p, material, *placed, &state)) {
            status = SE3D_ERR_NO_CONVERGENCE;
            break;
        }
    }
    if (status < 0) { /* nothing changed */
        set->count = count;
        set->id_count = ids;
        set->clump_count = clumps;
        (void)se3di_clumps_index(set); /* ids are used again */
    }
    se3di_free(&set->allocator, p.head, p.head_count, sizeof *p.head);
    se3di_free(&set->allocator, p.next, p.room, sizeof *p.next);
    return status;
}
