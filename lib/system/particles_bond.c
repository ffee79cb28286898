/* SPDX-License-Identifier: BSD-3-Clause */
/* Bonds of particles. */
#include "particles/bond.h"

#include "base/sized.h"
#include "base/sort.h"
#include "math/over.h"
#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/list.h"
#include "particles/step.h"
#include "particles/sync.h"
#include "particles/wall.h"
#include "se3d/bond.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

#define PI       3.1415926535897932384626433832795
#define MOST     1e30
#define LEAST    1e-30
#define ROUNDING 1e-9 /* of a radius: what touches may be that far apart */
#define BINS     1e9

void se3d_bond_def_init(se3d_bond_def *def, size_t size)
{
    se3d_bond_def defaults = {.struct_size = size, .ratio = 1.0};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_positive(se3d_system *system, const char *what, double value)
{
    if (!(value > 0.0)) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = %g, must be > 0", value);
    }
    return se3di_check_range(system, what, value, LEAST, MOST);
}

static se3d_status check_springs(se3d_system *system, const se3d_bond_def *def)
{
    for (int k = 0; k < 4; ++k) {
        SE3DI_TRY(check_positive(system, "springs", def->springs[k]));
        SE3DI_TRY(se3di_check_range(system, "dampers", def->dampers[k], 0.0, MOST));
        SE3DI_TRY(se3di_check_range(system, "limits", def->limits[k], 0.0, MOST));
    }
    return SE3D_OK;
}

static se3d_status check_stiffness(se3d_system *system, const se3d_bond_def *def)
{
    if (def->law < SE3D_BOND_LAW_BEAM || def->law > SE3D_BOND_LAW_SPRINGS) {
        return SE3DI_FAIL_OF(system, "law", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be an se3d_bond_law", (int)def->law);
    }
    if (def->law == SE3D_BOND_LAW_SPRINGS) {
        return check_springs(system, def);
    }
    if (def->law == SE3D_BOND_LAW_PARALLEL) {
        SE3DI_TRY(check_positive(system, "normal_stiffness", def->normal_stiffness));
        return check_positive(system, "shear_stiffness", def->shear_stiffness);
    }
    SE3DI_TRY(check_positive(system, "young", def->young));
    if (!(def->poisson > -1.0 && def->poisson <= 0.5)) {
        return SE3DI_FAIL_OF(system, "poisson", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be > -1 and <= 0.5", def->poisson);
    }
    return SE3D_OK;
}

static se3d_status check_bond(se3d_system *system, const se3d_bond_def *def)
{
    SE3DI_TRY(check_stiffness(system, def));
    SE3DI_TRY(se3di_check_range(system, "radius", def->radius, 0.0, MOST));
    SE3DI_TRY(check_positive(system, "ratio", def->ratio));
    SE3DI_TRY(se3di_check_range(system, "damping", def->damping, 0.0, 1.0));
    SE3DI_TRY(se3di_check_range(system, "tensile_strength", def->tensile_strength, 0.0, MOST));
    SE3DI_TRY(se3di_check_range(system, "shear_strength", def->shear_strength, 0.0, MOST));
    return se3di_check_range(system, "gap", def->gap, 0.0, MOST);
}

static se3d_status no_memory(se3d_particles *particles)
{
    return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory for bonds");
}

/* Normal, shear, bending and twisting springs of a bond of this radius and length. */
static void find_stiffness(const se3d_bond_def *def, double r, double L, double k[4])
{
    const double A = PI * r * r, I = 0.25 * A * r * r, J = 2.0 * I;
    if (def->law == SE3D_BOND_LAW_SPRINGS) {
        memcpy(k, def->springs, 4 * sizeof *k);
        return;
    }
    if (def->law == SE3D_BOND_LAW_PARALLEL) {
        k[0] = def->normal_stiffness * A;
        k[1] = def->shear_stiffness * A;
        k[2] = def->normal_stiffness * I;
        k[3] = def->shear_stiffness * J;
        return;
    }
    const double E = def->young, nu = def->poisson, G = E / (2.0 * (1.0 + nu));
    const double shape = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
    const double Phi =
        def->law == SE3D_BOND_LAW_BEAM ? se3di_over(12.0 * E * I, shape * G * A * L * L) : 0.0;
    k[0] = se3di_over(E * A, L);
    k[1] = se3di_over(12.0 * E * I, L * L * L * (1.0 + Phi));
    k[2] = se3di_over(E * I, L);
    k[3] = se3di_over(G * J, L);
}

static se3d_status check_place(se3d_particles *particles, const se3d_bond_def *def,
                               const se3di_bond_place *place, double radius)
{
    double k[4];
    const double length = se3di_norm(place->way);
    if (!(length > 0.0)) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                          "the ends of the bond of particle %u are in the same place",
                          place->first);
    }
    find_stiffness(def, radius, length, k);
    for (int n = 0; n < 4; ++n) {
        if (!(k[n] > 0.0 && k[n] < MOST)) {
            return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                              "the bond of particle %u, of radius %g m and length %g m, has a "
                              "stiffness of %g, must be > 0 and < %g",
                              place->first, radius, length, k[n], MOST);
        }
    }
    return SE3D_OK;
}

/* The section of a bond of particle i with particle j, or with a wall. */
static double section(const se3di_particles *set, const se3d_bond_def *def, uint32_t i, uint32_t j)
{
    double smaller = set->particles[i].radius;
    if (j != SE3DI_NO_INDEX) {
        smaller = fmin(smaller, set->particles[j].radius);
    }
    return def->radius > 0.0 ? def->radius : def->ratio * smaller;
}

/* The way from the centre of i to that of the nearest image of j. */
static void get_way(const se3di_particles *set, uint32_t i, uint32_t j, double way[3])
{
    se3di_sub(set->particles[j].x, set->particles[i].x, way);
    se3di_particles_wrap(set, way);
}

/* Ids two by two, as tuples of numbers. */
typedef struct pair_list {
    int32_t *ids;
    size_t count, capacity; /* of pairs; of numbers */
} pair_list;

static void drop(const se3di_particles *set, pair_list *pairs)
{
    se3di_free(&set->allocator, pairs->ids, pairs->capacity, sizeof *pairs->ids);
}

static se3d_status add_pair(const se3di_particles *set, pair_list *pairs, uint32_t i, uint32_t j)
{
    void *memory = pairs->ids;
    const se3d_status status = se3di_array_reserve(&set->allocator, &memory, &pairs->capacity,
                                                   2 * pairs->count + 2, sizeof *pairs->ids);
    pairs->ids = memory;
    SE3DI_TRY(status);
    pairs->ids[2 * pairs->count] = (int32_t)(i < j ? i : j);
    pairs->ids[2 * pairs->count + 1] = (int32_t)(i < j ? j : i);
    ++pairs->count;
    return SE3D_OK;
}

/* Room for so many bonds of a new group. */
static se3d_status begin_group(se3d_particles *particles, const se3d_bond_def *def, size_t count)
{
    se3di_particles *set = &particles->set;
    if (count > UINT32_MAX / 4 - set->bond_count) {
        return SE3DI_FAIL_OF(particles->system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, a set has at most 2^30 bonds", count);
    }
    if (se3di_bonds_reserve(set, count) < 0 || se3di_particles_collect(set) < 0) {
        return no_memory(particles);
    }
    set->bond_groups[set->bond_group_count++] = (se3di_bond_group){
        .touches = def->contact != 0,
        .middle = def->law >= SE3D_BOND_LAW_PARALLEL,
        .springs = def->law == SE3D_BOND_LAW_SPRINGS,
        .smooth = def->law == SE3D_BOND_LAW_SPRINGS && def->smooth != 0,
        .tension = def->tensile_strength,
        .shear = def->shear_strength,
        .damping = def->damping,
    };
    se3di_bond_group *group = &set->bond_groups[set->bond_group_count - 1];
    for (int k = 0; k < 4; ++k) {
        group->limits[k] = def->limits[k] > 0.0 ? def->limits[k] : HUGE_VAL;
        group->dampers[k] = group->springs ? def->dampers[k] : 0.0;
    }
    return SE3D_OK;
}

static void make_bond(se3di_particles *set, const se3d_bond_def *def, const se3di_bond_place *place,
                      double radius)
{
    const se3di_bond like = {.group = (uint32_t)set->bond_group_count - 1, .radius = radius};
    se3di_bonds_append(set, place, &like);
    se3di_bond *bond = &set->bonds[set->bond_count - 1];
    find_stiffness(def, bond->radius, bond->length, bond->stiffness);
    se3di_bond_damp(set, bond);
}

static void end_group(se3d_particles *particles, uint32_t *group)
{
    se3di_particles *set = &particles->set;
    (void)se3di_bonds_index(set);
    if (group) {
        *group = (uint32_t)set->bond_group_count - 1;
    }
    set->bonds_changed = 1;
    set->force_valid = 0;
    ++particles->system->model.topology_version; /* snapshots from before do not have them */
}

static se3di_bond_place place_of(const se3di_particles *set, uint32_t i, uint32_t j)
{
    se3di_bond_place place = {.first = i, .second = j};
    get_way(set, set->index_of[i], set->index_of[j], place.way);
    return place;
}

/* Bond the pairs: all, or nothing. */
static se3d_status bond_pairs(se3d_particles *particles, const se3d_bond_def *def,
                              const int32_t *ids, size_t count, uint32_t *group)
{
    se3di_particles *set = &particles->set;
    for (size_t k = 0; k < count; ++k) {
        const uint32_t i = (uint32_t)ids[2 * k], j = (uint32_t)ids[2 * k + 1];
        const se3di_bond_place place = place_of(set, i, j);
        SE3DI_TRY(check_place(particles, def, &place,
                              section(set, def, set->index_of[i], set->index_of[j])));
    }
    SE3DI_TRY(begin_group(particles, def, count));
    for (size_t k = 0; k < count; ++k) {
        const uint32_t i = (uint32_t)ids[2 * k], j = (uint32_t)ids[2 * k + 1];
        const se3di_bond_place place = place_of(set, i, j);
        make_bond(set, def, &place, section(set, def, set->index_of[i], set->index_of[j]));
    }
    end_group(particles, group);
    return SE3D_OK;
}

static int is_live(const se3di_particles *set, uint32_t id)
{
    return id < set->id_count && set->index_of[id] != SE3DI_NO_INDEX;
}

/* Spheres of one body, or bonded already. */
static int are_one(const se3di_particles *set, uint32_t i, uint32_t j)
{
    const se3di_clump *clump = se3di_clump_find(set, set->index_of[i]);
    return i == j || (clump && clump == se3di_clump_find(set, set->index_of[j])) ||
           se3di_bonds_join(set, i, j);
}

static se3d_status check_pair(se3d_particles *particles, size_t k, uint32_t i, uint32_t j)
{
    const se3di_particles *set = &particles->set;
    if (!is_live(set, i) || !is_live(set, j)) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                          "bond %zu: particles %u and %u, must both be live", k, i, j);
    }
    if (are_one(set, i, j)) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                          "bond %zu: particles %u and %u, must be two bodies that are not bonded",
                          k, i, j);
    }
    return SE3D_OK;
}

/* Whether a pair is there twice. */
static se3d_status check_twice(se3d_particles *particles, const pair_list *pairs)
{
    for (size_t k = 1; k < pairs->count; ++k) {
        const int32_t *at = pairs->ids + 2 * k;
        if (at[0] == at[-2] && at[1] == at[-1]) {
            return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                              "particles %d and %d are to be bonded twice", (int)at[0], (int)at[1]);
        }
    }
    return SE3D_OK;
}

static se3d_status list_pairs(se3d_particles *particles, size_t count, const uint32_t *first,
                              const uint32_t *second, pair_list *pairs)
{
    for (size_t k = 0; k < count; ++k) {
        SE3DI_TRY(check_pair(particles, k, first[k], second[k]));
        if (add_pair(&particles->set, pairs, first[k], second[k]) < 0) {
            return no_memory(particles);
        }
    }
    se3di_sort_tuples(pairs->ids, pairs->count, 2);
    return check_twice(particles, pairs);
}

se3d_status se3d_particles_bond(se3d_particles *particles, const se3d_bond_def *def, size_t count,
                                const uint32_t *first, const uint32_t *second, uint32_t *group)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3d_bond_def full = se3d_bond_def_default();
    pair_list pairs = {NULL, 0, 0};
    SE3DI_TRY(se3di_check_def(system, "bond def", def, &full, sizeof full));
    SE3DI_TRY(check_bond(system, &full));
    if (count > 0) {
        SE3DI_TRY(se3di_check_pointer(system, "first", first));
        SE3DI_TRY(se3di_check_pointer(system, "second", second));
    }
    se3d_status status = list_pairs(particles, count, first, second, &pairs);
    if (status >= 0) {
        status = bond_pairs(particles, &full, pairs.ids, count, group);
    }
    drop(&particles->set, &pairs);
    return status;
}

static se3d_status check_tag_or_all(se3d_particles *particles, const char *what, int32_t tag)
{
    if (tag < -1 || tag >= SE3D_PARTICLES_TAGS) {
        return SE3DI_FAIL_OF(particles->system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be from -1 to %d", (int)tag, SE3D_PARTICLES_TAGS - 1);
    }
    return SE3D_OK;
}

static int is_of(const se3di_particles *set, size_t k, int32_t tag)
{
    return tag < 0 || set->spins[k].tag == tag;
}

/* Who may be near whom: particles sorted into bins along an axis. */
typedef struct near_search {
    const se3d_bond_def *def;
    int32_t tag_1, tag_2;
    int32_t *order; /* [2 * count] bin, index */
    int axis;
    int all;    /* bins do not tell */
    double bin; /* [m] */
} near_search;

static double largest_radius(const se3di_particles *set)
{
    double radius = 0.0;
    for (size_t k = 0; k < set->count; ++k) {
        radius = fmax(radius, set->particles[k].radius);
    }
    return radius;
}

/* The image of particle k that is within the period. */
static void get_home(const se3di_particles *set, size_t k, double x[3])
{
    se3di_copy(set->particles[k].x, x);
    se3di_particles_come_home(set, x);
}

/* The longest axis; in a cell that strains the one along which images are not shifted. */
static void choose_axis(const se3di_particles *set, near_search *s)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double x[3];
    for (size_t k = 0; k < set->count; ++k) {
        get_home(set, k, x);
        for (int a = 0; a < 3; ++a) {
            low[a] = fmin(low[a], x[a]);
            high[a] = fmax(high[a], x[a]);
        }
    }
    for (int a = 1; a < 3; ++a) {
        s->axis = high[a] - low[a] > high[s->axis] - low[s->axis] ? a : s->axis;
    }
    s->axis = set->cell.count > 0 ? 3 - set->cell.flow - set->cell.gradient : s->axis;
    const double extent = high[s->axis] - low[s->axis];
    s->bin = fmax(2.0 * largest_radius(set) * (1.0 + ROUNDING) + s->def->gap, extent / BINS);
    s->all = !(extent > 4.0 * s->bin);
    for (size_t k = 0; k < set->count; ++k) {
        get_home(set, k, x);
        const double bin = floor((x[s->axis] - low[s->axis]) / s->bin);
        s->order[2 * k] = (int32_t)(bin < BINS ? bin : BINS);
        s->order[2 * k + 1] = (int32_t)k;
    }
    se3di_sort_tuples(s->order, set->count, 2);
}

static se3d_status try_pair(const se3di_particles *set, const near_search *s, uint32_t i,
                            uint32_t j, pair_list *pairs)
{
    const int fits = (is_of(set, i, s->tag_1) && is_of(set, j, s->tag_2)) ||
                     (is_of(set, i, s->tag_2) && is_of(set, j, s->tag_1));
    double way[3];
    if (!fits) {
        return SE3D_OK;
    }
    get_way(set, i, j, way);
    const double smaller = fmin(set->particles[i].radius, set->particles[j].radius);
    const double reach =
        set->particles[i].radius + set->particles[j].radius + s->def->gap + ROUNDING * smaller;
    if (se3di_norm(way) > reach || are_one(set, set->spins[i].id, set->spins[j].id)) {
        return SE3D_OK;
    }
    return add_pair(set, pairs, set->spins[i].id, set->spins[j].id);
}

static se3d_status search(const se3di_particles *set, const near_search *s, pair_list *pairs)
{
    const int32_t last = set->count > 0 ? s->order[2 * set->count - 2] : 0;
    const int periodic = set->boundary[s->axis] == SE3DI_BOUNDARY_PERIODIC;
    for (size_t k = 0; k < set->count; ++k) {
        const uint32_t i = (uint32_t)s->order[2 * k + 1];
        const int32_t bin = s->order[2 * k];
        size_t n = k + 1;
        for (; n < set->count && (s->all || s->order[2 * n] <= bin + 1); ++n) {
            SE3DI_TRY(try_pair(set, s, i, (uint32_t)s->order[2 * n + 1], pairs));
        }
        /* across the period, from the other end: bins are no narrower than the reach */
        const int across = periodic && !s->all && bin <= 1;
        for (size_t m = set->count; across && m-- > n && s->order[2 * m] >= last - 1;) {
            SE3DI_TRY(try_pair(set, s, i, (uint32_t)s->order[2 * m + 1], pairs));
        }
    }
    return SE3D_OK;
}

/* The pairs that are near, in the order of their ids. */
static se3d_status find_near(se3d_particles *particles, near_search *s, pair_list *pairs)
{
    const se3di_particles *set = &particles->set;
    s->order = se3di_alloc(&set->allocator, 2 * set->count, sizeof *s->order);
    if (!s->order) {
        return no_memory(particles);
    }
    choose_axis(set, s);
    const se3d_status status = search(set, s, pairs);
    se3di_free(&set->allocator, s->order, 2 * set->count, sizeof *s->order);
    se3di_sort_tuples(pairs->ids, pairs->count, 2);
    return status < 0 ? no_memory(particles) : SE3D_OK;
}

se3d_status se3d_particles_bond_near(se3d_particles *particles, const se3d_bond_def *def,
                                     int32_t tag_1, int32_t tag_2, size_t *added, uint32_t *group)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3d_bond_def full = se3d_bond_def_default();
    pair_list pairs = {NULL, 0, 0};
    near_search s = {.def = &full, .tag_1 = tag_1, .tag_2 = tag_2};
    SE3DI_TRY(se3di_check_def(system, "bond def", def, &full, sizeof full));
    SE3DI_TRY(check_bond(system, &full));
    SE3DI_TRY(check_tag_or_all(particles, "tag_1", tag_1));
    SE3DI_TRY(check_tag_or_all(particles, "tag_2", tag_2));
    se3d_status status = find_near(particles, &s, &pairs);
    if (status >= 0) {
        status = bond_pairs(particles, &full, pairs.ids, pairs.count, group);
    }
    if (status >= 0 && added) {
        *added = pairs.count;
    }
    drop(&particles->set, &pairs);
    return status;
}

se3d_status se3di_particles_find_wall(se3d_particles *particles, se3d_shape shape, uint32_t *wall)
{
    se3d_system *system = particles->system;
    se3di_particles *set = &particles->set;
    if (se3di_slots_find(&system->model.shape_slots, shape.index1, shape.generation) ==
        SE3DI_NO_INDEX) {
        return SE3DI_FAIL_OF(system, "shape", SE3D_ERR_STALE_HANDLE, " does not name a live shape");
    }
    if (se3di_particles_sync(set, &system->model) < 0) {
        return no_memory(particles);
    }
    se3di_particles_move_walls(set, system->model.frames);
    for (uint32_t w = 0; w < set->wall_count; ++w) {
        if (set->walls[w].handle.index1 == shape.index1) {
            *wall = w;
            return SE3D_OK;
        }
    }
    return SE3DI_FAIL_OF(system, "shape", SE3D_ERR_INVALID_ARGUMENT,
                         ": particles do not touch it, by its group, mask or material");
}

/* The bond of particle k with the nearest point of a wall; returns 0 if that is too far. */
static int place_on_wall(const se3di_particles *set, const se3d_bond_def *def, uint32_t w, size_t k,
                         se3di_bond_place *place)
{
    const se3di_particle *particle = &set->particles[k];
    const double reach = particle->radius * (1.0 + ROUNDING) + def->gap;
    double home[3], x[3], normal[3];
    get_home(set, k, home);
    se3di_particles_image(set, &set->walls[w], home, reach, x);
    *place = (se3di_bond_place){.first = set->spins[k].id, .second = SE3DI_NO_INDEX, .wall = w};
    const double distance = se3di_wall_nearest(&set->walls[w], x, place->x, normal);
    se3di_sub(place->x, x, place->way);
    return distance <= reach;
}

/* With `make` 0 the bonds are counted and checked; else they are made. */
static se3d_status bond_wall(se3d_particles *particles, const se3d_bond_def *def, uint32_t w,
                             int32_t tag, int make, size_t *count)
{
    se3di_particles *set = &particles->set;
    *count = 0;
    for (size_t id = 0; id < set->id_count; ++id) {
        const uint32_t k = set->index_of[id];
        se3di_bond_place place;
        if (k == SE3DI_NO_INDEX || !is_of(set, k, tag) || !place_on_wall(set, def, w, k, &place)) {
            continue;
        }
        const double radius = section(set, def, k, SE3DI_NO_INDEX);
        if (make) {
            make_bond(set, def, &place, radius);
        } else {
            SE3DI_TRY(check_place(particles, def, &place, radius));
        }
        ++*count;
    }
    return SE3D_OK;
}

se3d_status se3d_particles_bond_shape(se3d_particles *particles, const se3d_bond_def *def,
                                      se3d_shape shape, int32_t tag, size_t *added, uint32_t *group)
{
    SE3DI_EDIT_OF(particles);
    se3d_bond_def full = se3d_bond_def_default();
    uint32_t wall = 0;
    size_t count;
    SE3DI_TRY(se3di_check_def(particles->system, "bond def", def, &full, sizeof full));
    SE3DI_TRY(check_bond(particles->system, &full));
    SE3DI_TRY(check_tag_or_all(particles, "tag", tag));
    SE3DI_TRY(se3di_particles_find_wall(particles, shape, &wall));
    SE3DI_TRY(bond_wall(particles, &full, wall, tag, 0, &count));
    SE3DI_TRY(begin_group(particles, &full, count));
    (void)bond_wall(particles, &full, wall, tag, 1, &count);
    end_group(particles, group);
    if (added) {
        *added = count;
    }
    return SE3D_OK;
}

size_t se3d_particles_count_bond_groups(const se3d_particles *particles)
{
    return particles ? particles->set.bond_group_count : 0;
}

size_t se3d_particles_count_bonds(const se3d_particles *particles)
{
    return particles ? particles->set.bond_count : 0;
}

static void add_group(const se3di_bond_group *group, se3d_bond_stats *stats)
{
    stats->torn += group->torn;
    stats->sheared += group->sheared;
    stats->lost += group->lost;
    stats->dissipated += group->dissipated;
    stats->released += group->released;
}

static void add_bond(const se3di_bond *bond, se3d_bond_stats *stats)
{
    const int first = stats->count == 0;
    ++stats->count;
    stats->energy += bond->energy;
    stats->dissipated += bond->dissipated;
    stats->tension = first ? bond->stress[0] : fmax(stats->tension, bond->stress[0]);
    stats->shear = fmax(stats->shear, bond->stress[1]);
}

se3d_status se3d_particles_get_bond_stats_sized(const se3d_particles *particles, int32_t group,
                                                se3d_bond_stats *stats, size_t size)
{
    se3d_bond_stats full;
    if (!particles || !stats) {
        return SE3D_ERR_NULL;
    }
    const se3di_particles *set = &particles->set;
    if (group < -1 || (group >= 0 && (size_t)group >= set->bond_group_count)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memset(&full, 0, sizeof full);
    for (size_t k = 0; k < set->bond_group_count; ++k) {
        if (group < 0 || k == (size_t)group) {
            add_group(&set->bond_groups[k], &full);
        }
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        if (group < 0 || set->bonds[k].group == (uint32_t)group) {
            add_bond(&set->bonds[k], &full);
        }
    }
    return se3di_sized_give(stats, size, &full, sizeof full);
}

static void fill_state(const se3di_particles *set, const se3di_bond *bond,
                       se3d_particles_bond_state *out)
{
    const se3di_bond_end *i = &set->bond_ends[bond->end[0]], *j = &set->bond_ends[bond->end[1]];
    memset(out, 0, sizeof *out);
    out->i = i->id;
    out->j = j->id == SE3DI_NO_INDEX ? UINT32_MAX : j->id;
    out->group = bond->group;
    out->shape = (se3d_shape){j->shape.index1, j->shape.generation};
    se3di_copy(bond->place, out->place);
    se3di_copy(bond->force, out->force);
    se3di_copy(bond->torque[1], out->torque);
    out->length = bond->length;
    out->radius = bond->radius;
    out->tension = bond->stress[0];
    out->shear = bond->stress[1];
    out->energy = bond->energy;
}

se3d_status se3d_particles_get_bonds_sized(const se3d_particles *particles, size_t count,
                                           se3d_particles_bond_state *bonds, size_t size)
{
    if (!particles || !bonds) {
        return SE3D_ERR_NULL;
    }
    if (count != particles->set.bond_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    for (size_t k = 0; k < count; ++k) {
        se3d_particles_bond_state full;
        fill_state(&particles->set, &particles->set.bonds[k], &full);
        SE3DI_TRY(se3di_sized_give((char *)bonds + k * size, size, &full, sizeof full));
    }
    return SE3D_OK;
}
