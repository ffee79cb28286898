/* SPDX-License-Identifier: BSD-3-Clause */
/* The neighbour list: particles sorted by slab, size class and cell, and for each the partners
 * nearer than the skin.
 *
 * Every size class has cells of its own size, whose layers along the main axis divide a slab, so
 * that a slab is a range of cells in every class and sorting by cell sorts by slab. A particle
 * looks into the cells of every class within its reach, of its own slab (behind itself) and of the
 * next one: every pair is found once and belongs to the lower slab. A cell that is sheared has its
 * slabs along the gradient: what is beyond the last one lies in the first, shifted along the flow.
 *                                                                      docs/theory/particles.md */

#include "particles/grid.h"
#include "particles/bond.h"
#include "particles/cell.h"
#include "particles/clump.h"
#include "particles/flow.h"
#include "particles/list.h"
#include "particles/memory.h"
#include "particles/reach.h"
#include "particles/share.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

#define EXTENT_MOST 1e100 /* of a period: one that grows without end is refused */
#define CELLS_LEAST 1024  /* what even a few particles may need when they spread */

typedef struct grid_class {
    double radius;  /* largest of the class; 0: empty */
    double size[3]; /* of a cell, along fast, slow, main */
    int cells[2];   /* along fast, slow */
    int layers;     /* of a slab, along main */
    uint32_t offset;
} grid_class;

typedef struct grid {
    int axis[3]; /* fast, slow, main */
    int periodic[3];
    double low[3], extent[3]; /* by fast, slow, main */
    double thickness;
    int slabs;
    uint32_t per_slab; /* cells */
    grid_class classes[SE3DI_PARTICLE_CLASSES];
} grid;

/* Size class: 0 holds radii in (largest/2, largest], each next one half of that. */
static int class_of(double radius, double largest)
{
    int c = 0;
    for (double limit = 0.5 * largest; radius <= limit && c < SE3DI_PARTICLE_CLASSES - 1;
         limit *= 0.5) {
        ++c;
    }
    return c;
}

/* Whether x is beyond an end of the domain that is a sink. */
static int is_beyond(const se3di_particles *set, const double x[3])
{
    for (int a = 0; a < 3; ++a) {
        if (set->boundary[a] == SE3DI_BOUNDARY_SINK &&
            !(x[a] >= set->lower[a] && x[a] <= set->upper[a])) {
            return 1;
        }
    }
    return 0;
}

/* Periodic positions back into the period; particles beyond a sink are marked in order[]. Spheres
 * of a clump leave together, when its centre of mass does. */
static size_t leave(se3di_particles *set)
{
    size_t gone = 0;
    for (size_t k = 0; k < set->clump_count; ++k) {
        se3di_particles_come_home(set, set->clumps[k].x);
    }
    for (size_t k = 0; k < set->count; ++k) {
        if (se3di_share_is_ghost(set, k)) {
            set->order[k] = 0;
            continue;
        }
        if (se3di_domain_strains(set)) {
            se3di_domain_come_home(set, set->particles[k].x, set->particles[k].v);
        } else {
            se3di_particles_come_home(set, set->particles[k].x);
        }
        const se3di_clump *clump = se3di_clump_find(set, k);
        const double *x = clump ? clump->x : set->particles[k].x;
        set->order[k] = !is_beyond(set, x);
        uint32_t sink = set->order[k] ? se3di_sinks_find(set, x) : SE3DI_NO_INDEX;
        if (sink != SE3DI_NO_INDEX) {
            ++set->sinks[sink].count;
            set->order[k] = 0;
        }
        if (set->order[k] == 0) {
            ++set->lost_of[set->spins[k].tag];
            ++gone;
        }
    }
    return gone;
}

static void remove_gone(se3di_particles *set)
{
    size_t gone = leave(set);
    if (se3di_share_is_spread(set)) {
        set->share->migrate(set);
        set->lost += gone;
    } else if (gone > 0) {
        unsigned char *keep = (unsigned char *)set->key; /* scratch */
        for (size_t k = 0; k < set->count; ++k) {
            keep[k] = (unsigned char)set->order[k];
        }
        se3di_particles_filter(set, keep);
        set->lost += gone;
    }
}

/* The box of all centres and the largest radius; of a set that is spread, over all processes. */
static double measure_box(se3di_particles *set)
{
    double most[7] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL, 0.0};
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_particle *particle = &set->particles[k];
        most[6] = fmax(most[6], particle->radius);
        for (int a = 0; a < 3; ++a) {
            most[a] = fmax(most[a], -particle->x[a]);
            most[3 + a] = fmax(most[3 + a], particle->x[a]);
        }
    }
    se3di_share_largest(set, 7, most);
    for (int a = 0; a < 3 && most[6] > 0.0; ++a) {
        set->low[a] = -most[a];
        set->high[a] = most[3 + a];
    }
    return most[6];
}

/* The mean radius over all processes, rounded so that it depends on no order. */
static double mean_of_all(se3di_particles *set, double largest)
{
    double parts[2] = {0.0, (double)set->count};
    for (size_t k = 0; k < set->count; ++k) {
        parts[0] += floor(set->particles[k].radius / largest * 0x1p20 + 0.5);
    }
    set->share->add(set, 2, parts);
    return parts[1] > 0.0 ? parts[0] / parts[1] * 0x1p-20 * largest : 0.0;
}

/* The skin for radii whose largest is known. */
static double choose_skin(se3di_particles *set, double largest)
{
    double sum = 0.0;
    if (se3di_share_is_spread(set)) {
        return set->skin_ratio * 2.0 * mean_of_all(set, largest);
    }
    for (size_t k = 0; k < set->count; ++k) {
        sum += set->particles[k].radius;
    }
    return set->count > 0 ? set->skin_ratio * 2.0 * sum / (double)set->count : 0.0;
}

/* Notes whether all particles are of one material; returns whether that holds for those here.
 * most: of the materials and of what they are below the largest number. */
static int measure_materials(se3di_particles *set, double most[2])
{
    const unsigned first = set->count > 0 ? set->spins[0].material : 0;
    size_t k = 1;
    while (k < set->count && set->spins[k].material == first) {
        ++k;
    }
    const int same = k >= set->count;
    set->single = same && set->count > 0 ? first + 1 : 0;
    most[0] = set->count > 0 ? (double)first : 0.0;
    most[1] = set->count > 0 ? (double)(UINT16_MAX - first) : 0.0;
    return same;
}

/* Box of all centres, largest and mean radius, uniformity, classes in use. */
static double measure(se3di_particles *set, grid *g)
{
    enum { DIFFERS = SE3DI_PARTICLE_CLASSES, FIXED, STUFF, SIZE = STUFF + 2 };
    const double largest = measure_box(set);
    double most[SIZE] = {0.0};
    double *differs = &most[DIFFERS];
    const int same = measure_materials(set, &most[STUFF]);
    *differs = set->clump_count > 0 || !same ? 1.0 : 0.0;
    for (size_t k = 0; k < set->count; ++k) {
        const double radius = set->particles[k].radius;
        double *of_class = &most[class_of(radius, largest)];
        *of_class = fmax(*of_class, radius);
        *differs = radius == largest ? *differs : 1.0;
        most[FIXED] = se3di_particle_is_fixed(&set->particles[k]) ? 1.0 : most[FIXED];
    }
    se3di_share_largest(set, SIZE, most);
    for (int c = 0; c < SE3DI_PARTICLE_CLASSES; ++c) {
        g->classes[c].radius = most[c];
    }
    const int several = most[STUFF] + most[STUFF + 1] > UINT16_MAX;
    set->single = several ? 0 : set->single; /* those of other ranks come here */
    set->fixed = most[FIXED] > 0.0;
    set->uniform = !several && !(*differs > 0.0) && !set->fixed;
    set->skin = choose_skin(set, largest);
    return largest;
}

/* The longest axis that is not periodic is the main one; the gradient of a cell that strains. */
static void choose_axes(const se3di_particles *set, grid *g)
{
    int main_axis = 0;
    double best = -1.0;
    for (int a = 0; a < 3; ++a) {
        double length = set->high[a] - set->low[a];
        int open = set->boundary[a] != SE3DI_BOUNDARY_PERIODIC;
        if (open && length > best) {
            best = length;
            main_axis = a;
        }
    }
    main_axis = se3di_domain_strains(set) ? set->cell.gradient : main_axis;
    g->axis[2] = main_axis;
    g->axis[0] = main_axis == 0 ? 1 : 0;
    g->axis[1] = main_axis == 2 ? 1 : 2;
    for (int k = 0; k < 3; ++k) {
        int a = g->axis[k];
        g->periodic[k] = set->boundary[a] == SE3DI_BOUNDARY_PERIODIC;
        g->low[k] = g->periodic[k] ? set->lower[a] : set->low[a];
        g->extent[k] = g->periodic[k] ? set->upper[a] - set->lower[a] : set->high[a] - set->low[a];
    }
}

static int division(double length, double size, double most)
{
    double parts = floor(length / size);
    return parts < 1.0 ? 1 : (int)fmin(parts, most);
}

/* Cells of all classes at `scale` times the least size. */
static double divide(const se3di_particles *set, grid *g, double largest, double scale)
{
    double reach = 2.0 * (largest + set->stretch);
    g->slabs = division(g->extent[2], reach, SE3DI_PARTICLE_SLABS_MAX);
    if (g->periodic[2]) { /* all axes are */
        g->slabs = g->slabs < 4 ? 1 : g->slabs - g->slabs % 2;
    }
    g->thickness = fmax(g->extent[2], reach) / g->slabs;
    if (g->periodic[2]) {
        g->thickness = g->extent[2] / g->slabs;
    }
    double total = 0.0;
    for (int c = 0; c < SE3DI_PARTICLE_CLASSES; ++c) {
        grid_class *here = &g->classes[c];
        if (here->radius <= 0.0) {
            continue;
        }
        double size = scale * (2.0 * here->radius + set->skin);
        here->offset = (uint32_t)fmin(total, 4e9);
        for (int k = 0; k < 2; ++k) {
            here->cells[k] = division(g->extent[k], size, 1e6);
            here->size[k] = fmax(g->extent[k], 1e-3 * size) / here->cells[k];
        }
        here->layers = division(g->thickness, size, 1e6);
        here->size[2] = g->thickness / here->layers;
        total += (double)here->cells[0] * here->cells[1] * here->layers;
    }
    g->per_slab = (uint32_t)fmin(total, 4e9);
    return total * g->slabs;
}

static int clamp_index(double x, int count)
{
    return x <= 0.0 ? 0 : x >= count - 1 ? count - 1 : (int)x;
}

static uint32_t cell_of(const grid *g, const double x[3], int c)
{
    const grid_class *here = &g->classes[c];
    double z = x[g->axis[2]] - g->low[2];
    int slab = clamp_index(z / g->thickness, g->slabs);
    int layer = clamp_index((z - slab * g->thickness) / here->size[2], here->layers);
    int slow = clamp_index((x[g->axis[1]] - g->low[1]) / here->size[1], here->cells[1]);
    int fast = clamp_index((x[g->axis[0]] - g->low[0]) / here->size[0], here->cells[0]);
    return (uint32_t)slab * g->per_slab + here->offset +
           ((uint32_t)(layer * here->cells[1] + slow)) * (uint32_t)here->cells[0] + (uint32_t)fast;
}

/* Put the records in the order of order[] (new -> old), cycle by cycle; then order[] is old -> new.
 */
static void permute(se3di_particles *set)
{
    size_t n = set->count;
    uint32_t *order = set->order;
    for (size_t k = 0; k < n; ++k) {
        set->key[order[k]] = (uint32_t)k;
    }
    for (size_t start = 0; start < n; ++start) {
        se3di_particle particle = set->particles[start];
        se3di_spin spin = set->spins[start];
        size_t k = start;
        while (order[k] != start) {
            size_t from = order[k];
            set->particles[k] = set->particles[from];
            set->spins[k] = set->spins[from];
            order[k] = (uint32_t)k; /* done */
            k = from;
        }
        set->particles[k] = particle;
        set->spins[k] = spin;
        order[k] = (uint32_t)k;
    }
    for (size_t k = 0; k < n; ++k) {
        set->index_of[set->spins[k].id] = (uint32_t)k;
    }
    set->order = set->key;
    set->key = order;
}

/* The particles of each cell, in order[], by their numbers: cells[c + 1] is where cell c ends. */
static void sort_cells(se3di_particles *set, size_t total)
{
    uint32_t begin = 0;
    for (size_t c = 0; c < total; ++c) {
        const uint32_t end = set->cells[c + 1];
        for (uint32_t k = begin + 1; k < end; ++k) {
            const uint32_t here = set->order[k], number = se3di_share_number(set, here);
            uint32_t at = k;
            for (; at > begin && se3di_share_number(set, set->order[at - 1]) > number; --at) {
                set->order[at] = set->order[at - 1];
            }
            set->order[at] = here;
        }
        begin = end;
    }
}

/* Sort by cell, stably; cells[] becomes the first particle of each. */
static void sort(se3di_particles *set, const grid *g, double largest, size_t total)
{
    memset(set->cells, 0, (total + 2) * sizeof *set->cells);
    for (size_t k = 0; k < set->count; ++k) {
        int c = class_of(set->particles[k].radius, largest);
        set->key[k] = cell_of(g, set->particles[k].x, c);
        ++set->cells[set->key[k] + 2];
    }
    for (size_t k = 1; k <= total; ++k) {
        set->cells[k + 1] += set->cells[k];
    }
    for (size_t k = 0; k < set->count; ++k) {
        set->order[set->cells[set->key[k] + 1]++] = (uint32_t)k;
    }
    if (se3di_share_is_spread(set)) {
        sort_cells(set, total);
    }
    permute(set);
    se3di_particles_remap(set, set->order);
    set->slab_count = (uint32_t)g->slabs;
    for (int s = 0; s < g->slabs; ++s) {
        memset(&set->slabs[s], 0, sizeof set->slabs[s]);
        set->slabs[s].begin = set->cells[(size_t)s * g->per_slab];
        set->slabs[s].end = set->cells[(size_t)(s + 1) * g->per_slab];
    }
}

/* One search: what particle i sees of one class. */
typedef struct search {
    const grid *g;
    const grid_class *c;
    uint32_t i;
    double x[3]; /* relative to the grid, by fast, slow, main */
    double reach;
    int whole; /* 0, 1: along fast, slow everything is searched; -1: neither */
} search;

/* Append those of cells [begin, end) of the sorted particles that are near. */
static void append(se3di_particles *set, const search *q, uint32_t begin, uint32_t end)
{
    const se3di_particle *gi = &set->particles[q->i];
    const double *stretch = se3di_particles_reach(set);
    double border = gi->radius + stretch[q->i];
    const int ghost = se3di_share_is_ghost(set, q->i);
    int wraps = q->g->periodic[0] || q->g->periodic[1] || q->g->periodic[2];
    const se3di_clump *own = se3di_clump_find(set, q->i);
    const int bonded = set->bond_count > 0, fixed = se3di_particle_is_fixed(gi);
    for (uint32_t j = begin; j < end; ++j) {
        const se3di_particle *gj = &set->particles[j];
        double d[3] = {gi->x[0] - gj->x[0], gi->x[1] - gj->x[1], gi->x[2] - gj->x[2]};
        if (wraps) {
            se3di_particles_wrap(set, d);
        }
        double reach = border + gj->radius + stretch[j];
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach &&
            !(own && se3di_clump_find(set, j) == own) && !(ghost && se3di_share_is_ghost(set, j)) &&
            !(bonded && se3di_bonds_part(set, q->i, j)) &&
            !(fixed && se3di_particle_is_fixed(gj))) {
            set->list[set->list_count++] = j;
        }
    }
}

/* Indices of cells within reach along an axis; on a periodic one they may be beyond the ends, but
 * never name a cell twice. */
static void window(const search *q, int k, int *from, int *to)
{
    double size = q->c->size[k];
    int count = q->c->cells[k];
    double low = floor((q->x[k] - q->reach) / size);
    double high = floor((q->x[k] + q->reach) / size);
    if (q->whole == k) {
        *from = 0;
        *to = count - 1;
    } else if (q->g->periodic[k]) {
        *from = (int)low;
        *to = high - low >= count ? *from + count - 1 : (int)high;
    } else {
        *from = clamp_index(low, count);
        *to = clamp_index(high, count);
    }
}

static int wrapped(int index, int count)
{
    int rest = index % count;
    return rest < 0 ? rest + count : rest;
}

/* Rows of cells of one layer: `row0` is the layer's first cell, `least` the first particle allowed.
 */
static se3d_status search_layer(se3di_particles *set, const search *q, uint32_t row0,
                                uint32_t least)
{
    int from[2], to[2];
    window(q, 0, &from[0], &to[0]);
    window(q, 1, &from[1], &to[1]);
    const int across = q->c->cells[0];
    for (int y = from[1]; y <= to[1]; ++y) {
        uint32_t row = row0 + (uint32_t)(wrapped(y, q->c->cells[1]) * across);
        int x = from[0];
        while (x <= to[0]) { /* in pieces where the window wraps */
            int begin = wrapped(x, across);
            int length = to[0] - x + 1;
            length = begin + length > across ? across - begin : length;
            uint32_t first = set->cells[row + (uint32_t)begin];
            uint32_t end = set->cells[row + (uint32_t)(begin + length)];
            first = first < least ? least : first;
            if (first < end) {
                SE3DI_TRY(se3di_particles_grow(set, &set->list, &set->list_capacity,
                                               set->list_count + (end - first)));
                append(set, q, first, end);
            }
            x += length;
        }
    }
    return SE3D_OK;
}

/* The layers of slab `s` (its position without wrapping `at`) within reach. */
static se3d_status search_slab(se3di_particles *set, const search *q, int s, int at, uint32_t least)
{
    const grid *g = q->g;
    double z = q->x[2] - at * g->thickness;
    double size = q->c->size[2];
    double low = floor((z - q->reach) / size);
    double high = floor((z + q->reach) / size);
    int from = low <= 0.0 ? 0 : low >= q->c->layers ? q->c->layers : (int)low;
    int to = high < 0.0 ? -1 : high >= q->c->layers ? q->c->layers - 1 : (int)high;
    if (g->slabs == 1 && g->periodic[2]) {
        from = 0; /* a short period: everything, distances tell */
        to = q->c->layers - 1;
    }
    for (int layer = from; layer <= to; ++layer) {
        uint32_t row0 = (uint32_t)s * g->per_slab + q->c->offset +
                        (uint32_t)(layer * q->c->cells[1] * q->c->cells[0]);
        SE3DI_TRY(search_layer(set, q, row0, least));
    }
    return SE3D_OK;
}

/* The first slab beyond the last one: in a cell that strains, shifted. */
static se3d_status search_beyond(se3di_particles *set, const search *q, int s)
{
    search beyond = *q;
    for (int k = 0; k < 2 && se3di_domain_strains(set); ++k) {
        beyond.x[k] -= q->g->axis[k] == set->cell.flow ? set->cell.offset : 0.0;
    }
    return search_slab(set, &beyond, 0, s + 1, 0);
}

/* Partners of particle i of slab s. */
static se3d_status search_particle(se3di_particles *set, const grid *g, int s, uint32_t i)
{
    const se3di_particle *particle = &set->particles[i];
    search q = {.g = g, .i = i, .whole = -1};
    if (se3di_domain_strains(set) && g->slabs == 1) {
        q.whole = g->axis[0] == set->cell.flow ? 0 : 1;
    }
    for (int k = 0; k < 3; ++k) {
        q.x[k] = particle->x[g->axis[k]] - g->low[k];
    }
    for (int c = 0; c < SE3DI_PARTICLE_CLASSES; ++c) {
        q.c = &g->classes[c];
        if (q.c->radius <= 0.0) {
            continue;
        }
        q.reach = particle->radius + q.c->radius + se3di_particles_reach(set)[i] + set->stretch;
        SE3DI_TRY(search_slab(set, &q, s, s, i + 1));
        if (s + 1 < g->slabs) {
            SE3DI_TRY(search_slab(set, &q, s + 1, s + 1, 0));
        } else if (g->periodic[2] && g->slabs > 1) {
            SE3DI_TRY(search_beyond(set, &q, s));
        }
    }
    return SE3D_OK;
}

static se3d_status search_all(se3di_particles *set, const grid *g)
{
    set->list_count = 0;
    for (int s = 0; s < g->slabs; ++s) {
        for (uint32_t i = set->slabs[s].begin; i < set->slabs[s].end; ++i) {
            set->first[i] = (uint32_t)set->list_count;
            SE3DI_TRY(search_particle(set, g, s, i));
        }
    }
    set->first[set->count] = (uint32_t)set->list_count;
    return SE3D_OK;
}

/* Few particles in a large space: larger cells, so that there are not many more cells than
 * particles; also if there is no memory for so many. */
static se3d_status divide_all(se3di_particles *set, grid *g, double largest, size_t *cells)
{
    double total = divide(set, g, largest, 1.0);
    for (double scale = 1.25; scale < 1e30; scale *= 1.25) {
        if (total <= 4.0 * (double)se3di_share_total(set) + 1e4) {
            *cells = (size_t)total;
            size_t needed = *cells + 2 < CELLS_LEAST ? CELLS_LEAST : *cells + 2;
            if (se3di_particles_grow(set, &set->cells, &set->cell_capacity, needed) == SE3D_OK) {
                return SE3D_OK;
            }
            set->starved = 1;
        }
        total = divide(set, g, largest, scale);
    }
    return SE3D_ERR_NO_MEMORY;
}

/* If memory is missing, a smaller skin makes shorter lists: at last of those that touch, which
 * were in the list before. */
static se3d_status list_all(se3di_particles *set, const grid *g)
{
    const double least = 1e-3 * set->skin;
    for (;;) {
        se3di_particles_set_reach(set);
        se3d_status status = se3di_share_total(set) > 0 ? search_all(set, g) : SE3D_OK;
        if (status == SE3D_OK) {
            status = se3di_particles_list_walls(set);
        }
        if (status != SE3D_ERR_NO_MEMORY || !(set->skin > 0.0)) {
            return status;
        }
        set->starved = 1;
        set->skin = set->skin > least ? 0.5 * set->skin : 0.0;
    }
}

se3d_status se3di_particles_rebuild(se3di_particles *set)
{
    SE3DI_TRY(se3di_particles_collect(set));
    remove_gone(set);
    grid g = {.slabs = 1};
    double largest = measure(set, &g);
    set->slab_count = 0;
    if (se3di_share_total(set) > 0) {
        size_t cells = 0;
        double room = HUGE_VAL; /* for the reaches of two */
        choose_axes(set, &g);
        for (int k = 0; k < 3; ++k) { /* no pair may meet twice */
            if (g.periodic[k] &&
                !(g.extent[k] >= SE3DI_PERIOD_LEAST * largest && g.extent[k] < EXTENT_MOST)) {
                return SE3D_ERR_UNSUPPORTED;
            }
            if (g.periodic[k]) {
                room = fmin(room, 0.4999 * g.extent[k] - 2.0 * largest);
            }
        }
        set->skin = fmin(set->skin, room);
        se3di_particles_stretch(set, room);
        if (se3di_share_is_spread(set)) {
            set->share->border(set, 2.0 * (largest + set->stretch) * (1.0 + 1e-9));
        }
        SE3DI_TRY(divide_all(set, &g, largest, &cells));
        sort(set, &g, largest, cells);
    }
    SE3DI_TRY(list_all(set, &g));
    for (size_t k = 0; k < set->count; ++k) {
        memcpy(set->origin + 3 * k, set->particles[k].x, sizeof set->particles[k].x);
    }
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        memcpy(wall->old_x, wall->pose.x, sizeof wall->old_x);
        memcpy(wall->old_R, wall->pose.R, sizeof wall->old_R);
    }
    se3di_domain_begin_list(set);
    set->bonds_changed = 0;
    ++set->rebuilds;
    return se3di_particles_activate(set);
}
