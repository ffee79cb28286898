/* SPDX-License-Identifier: BSD-3-Clause */
/* Sources that insert particles during a run, sinks that remove them, and what has left.
 *
 * A source owes rate * h more after every step; what is due is inserted after the drift and before
 * the forces, where it overlaps with no particle and no wall, so that no force changes by it. If
 * no place is found in TRIES draws the particle waits for the next step, with its radius: neither
 * the rate nor the distribution of the radii suffers.                  docs/theory/particles.md */

#include "particles/flow.h"

#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/draw.h"
#include "particles/piece.h"
#include "particles/share.h"
#include "particles/wall.h"

#include <math.h>

#define TRIES 100

se3d_status se3di_sources_aim(se3di_particles *set, const se3di_model *model, double h)
{
    for (size_t k = 0; k < set->source_count; ++k) {
        se3di_source *source = &set->sources[k];
        double jet[3], t = set->time + 0.5 * h;
        if (source->function.index1 == 0 || source->stopped) {
            continue;
        }
        uint32_t index = se3di_slots_find(&model->function_slots, source->function.index1,
                                          source->function.generation);
        SE3DI_TRY(se3di_function_eval(&model->functions[index], &t, jet, NULL));
        source->rate = fmax(0.0, jet[0]);
    }
    return SE3D_OK;
}

/* Particles that may touch one of a source, to order[]. */
static size_t gather(se3di_particles *set, const se3di_source *source)
{
    size_t count = 0;
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_particle *g = &set->particles[k];
        double d[3], away = -HUGE_VAL;
        if (se3di_share_is_ghost(set, k)) {
            continue; /* its owner looks */
        }
        for (int a = 0; a < 3; ++a) {
            d[a] = g->x[a] - 0.5 * (source->region.lower[a] + source->region.upper[a]);
        }
        se3di_particles_wrap(set, d);
        for (int a = 0; a < 3; ++a) {
            double half = 0.5 * (source->region.upper[a] - source->region.lower[a]);
            away = fmax(away, fabs(d[a]) - half - g->radius);
        }
        if (away < 0.0) {
            set->order[count++] = (uint32_t)k;
        }
    }
    return count;
}

static int has_room(const se3di_particles *set, const double x[3], double radius, size_t near)
{
    for (size_t k = 0; k < near; ++k) {
        const se3di_particle *g = &set->particles[set->order[k]];
        double d[3];
        se3di_sub(g->x, x, d);
        se3di_particles_wrap(set, d);
        if (se3di_dot(d, d) < (g->radius + radius) * (g->radius + radius)) {
            return 0;
        }
    }
    for (size_t k = 0; se3di_share_is_spread(set) && k < set->share->fresh_count; ++k) {
        const double *other = set->share->fresh[k];
        double d[3];
        se3di_sub(other, x, d);
        se3di_particles_wrap(set, d);
        if (se3di_dot(d, d) < (other[3] + radius) * (other[3] + radius)) {
            return 0;
        }
    }
    for (size_t k = 0; k < set->wall_count; ++k) {
        double image[3];
        se3di_particles_image(set, &set->walls[k], x, radius, image);
        if (se3di_wall_distance(&set->walls[k], image) < radius) {
            return 0;
        }
    }
    return 1;
}

static int is_free(const se3di_particles *set, const se3di_piece *piece, size_t near)
{
    const size_t spheres = se3di_piece_count(set, piece->clump);
    for (size_t k = 0; k < spheres; ++k) {
        double x[3];
        const double radius = se3di_piece_sphere(set, piece, k, x);
        if (!has_room(set, x, radius, near)) {
            return 0;
        }
    }
    return 1;
}

/* In all processes. */
static int is_free_for_all(se3di_particles *set, const se3di_piece *piece, size_t near)
{
    double taken = !is_free(set, piece, near);
    se3di_share_largest(set, 1, &taken);
    return !(taken > 0.0);
}

static int find_place(se3di_particles *set, se3di_source *source, size_t near, se3di_piece *piece)
{
    for (int try = 0; try < TRIES; ++try) {
        se3di_region_draw(&source->region, piece->radius, &source->seed, piece->x);
        if (se3di_region_holds(&source->region, piece->x, piece->radius) &&
            is_free_for_all(set, piece, near)) {
            return 1;
        }
    }
    return 0;
}

/* The next one, which has no place yet. */
static se3di_piece next_of(se3di_source *source)
{
    if (!(source->next > 0.0)) {
        source->next = se3di_radii_draw(&source->radii, &source->seed);
    }
    se3di_piece piece = {.clump = source->clump,
                         .material = source->material,
                         .tag = source->tag,
                         .radius = source->next};
    if (piece.clump > 0) {
        se3di_piece_turn(&piece, source->turn, source->turns, source->inserted);
    }
    return piece;
}

/* What the next one takes from what is owed. */
static double price(const se3di_particles *set, se3di_source *source)
{
    const se3di_piece next = next_of(source);
    return source->per_mass ? se3di_piece_mass(set, &next) : 1.0;
}

static int is_due(const se3di_particles *set, se3di_source *source)
{
    return source->inserted < source->maximum && source->owed > 0.0 &&
           source->owed >= price(set, source) * (1.0 - 1e-9);
}

/* Room for one more of `spheres`; a quarter more than that if memory has to grow. */
static se3d_status make_room(se3di_particles *set, size_t spheres)
{
    size_t wanted = set->count + spheres;
    if (wanted > set->capacity || set->id_count + spheres > set->index_capacity) {
        wanted += set->count / 4 + 32;
    }
    SE3DI_TRY(se3di_clumps_reserve(set, set->id_count + spheres, 1));
    return se3di_particles_reserve(set, wanted);
}

static se3d_status insert(se3di_particles *set, se3di_source *source, double h)
{
    size_t capacity = set->capacity;
    size_t near = gather(set, source);
    while (is_due(set, source)) {
        double v[3];
        se3di_piece piece = next_of(source);
        const double cost = price(set, source), mass = se3di_piece_mass(set, &piece);
        const size_t spheres = se3di_piece_count(set, piece.clump);
        if (!find_place(set, source, near, &piece)) {
            source->deferred += source->waiting ? 0u : 1u;
            source->waiting = 1;
            return SE3D_OK;
        }
        SE3DI_TRY(make_room(set, spheres));
        for (int a = 0; a < 3; ++a) { /* half a kick is still to come */
            v[a] = source->velocity[a] - 0.5 * h * set->gravity[a];
        }
        se3di_piece_append(set, &piece, v);
        source->owed -= cost;
        source->mass +=
            source->clump > 0 ? mass : 1.0 / set->particles[set->count - 1].inverse_mass;
        source->next = 0.0;
        source->waiting = 0;
        ++source->inserted;
        const int spread = se3di_share_is_spread(set);
        if (spread) {
            set->share->insert(set, spheres, source->clump > 0);
        }
        if (set->capacity != capacity) { /* order[] is a new one */
            capacity = set->capacity;
            near = gather(set, source);
        } else if (!spread) {
            for (size_t k = spheres; k > 0; --k) {
                set->order[near++] = (uint32_t)(set->count - k);
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_sources_feed(se3di_particles *set, double h)
{
    const double t1 = set->time;
    for (size_t k = 0; k < set->source_count; ++k) {
        se3di_source *source = &set->sources[k];
        double active = fmin(t1, source->stop) - fmax(t1 - h, source->start);
        if (source->stopped || !(active > 0.0)) {
            continue;
        }
        source->owed += source->rate * active;
        if (t1 < source->due * (1.0 - 1e-12) || !is_due(set, source)) {
            continue;
        }
        source->due = t1 + source->every;
        SE3DI_TRY(insert(set, source, h));
    }
    return SE3D_OK;
}

static int sink_holds(const se3di_sink *sink, const double x[3])
{
    double d[3];
    if (sink->plane) {
        se3di_sub(x, sink->point, d);
        return se3di_dot(d, sink->normal) < 0.0;
    }
    for (int a = 0; a < 3; ++a) {
        if (!(x[a] >= sink->region.lower[a] && x[a] <= sink->region.upper[a])) {
            return 0;
        }
    }
    return se3di_region_holds(&sink->region, x, 0.0);
}

uint32_t se3di_sinks_find(const se3di_particles *set, const double x[3])
{
    for (size_t k = 0; k < set->sink_count; ++k) {
        if (!set->sinks[k].stopped && sink_holds(&set->sinks[k], x)) {
            return (uint32_t)k;
        }
    }
    return SE3DI_NO_INDEX;
}

/* Nothing is below that could stop it: it is lower than all walls and than where particles came
 * from, by more than their size, and in front of no plane that faces up. */
static int falls_for_ever(const se3di_particles *set, const double x[3])
{
    double g = se3di_norm(set->gravity), low = 0.0, high = 0.0, down[3];
    if (!(g > 0.0)) {
        return 0;
    }
    se3di_scale(1.0 / g, set->gravity, down);
    for (int a = 0; a < 3; ++a) {
        low += fmin(down[a] * set->home_low[a], down[a] * set->home_high[a]);
        high += fmax(down[a] * set->home_low[a], down[a] * set->home_high[a]);
    }
    for (size_t k = 0; k < set->wall_count; ++k) {
        const se3di_wall *wall = &set->walls[k];
        double depth = se3di_dot(down, wall->pose.x);
        if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE)) {
            const double n[3] = {wall->pose.R[2], wall->pose.R[5], wall->pose.R[8]};
            double d[3];
            se3di_sub(x, wall->pose.x, d);
            if (se3di_dot(n, down) < -1e-6 && se3di_dot(n, d) > 0.0) {
                return 0;
            }
            continue;
        }
        low = fmin(low, depth - wall->shape.bound);
        high = fmax(high, depth + wall->shape.bound);
    }
    return se3di_dot(down, x) > high + (high - low);
}

int se3di_particles_is_out(const se3di_particles *set, size_t k)
{
    const double *x = set->particles[k].x;
    int bounded = 0;
    for (int a = 0; a < 3; ++a) {
        int given = set->upper[a] > set->lower[a];
        bounded = bounded || given;
        if (set->boundary[a] == SE3DI_BOUNDARY_OPEN && given &&
            !(x[a] >= set->lower[a] && x[a] <= set->upper[a])) {
            return 1;
        }
    }
    return !bounded && falls_for_ever(set, x);
}
