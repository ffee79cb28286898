/* SPDX-License-Identifier: BSD-3-Clause */
/* How far each particle and wall may move before lists are made anew: its reach. Two that are
 * nearer than their reaches together are in the list; two that touch later were nearer then. So
 * few fast particles cost the others neither long lists nor many. A step wears a reach by the part
 * of it that the particle moved; the largest parts of all steps are added up.
 *                                                                      docs/theory/particles.md */
#include "particles/reach.h"

#include "math/vec3.h"
#include "particles/cell.h"
#include "particles/share.h"
#include "particles/slabs.h"

#include <math.h>
#include <string.h>

/* Active blocks are expected to last about this many steps, the list this many. */
#define NEAR_STEPS 60.0
#define LIST_STEPS 240.0
/* The least small reach over the skin. */
#define NEAR_LEAST 0.01
/* The part of the largest speed that any particle may soon have: who is hit is fast at once. */
#define SHARE 0.03
/* What is left of a list's reach, over what active blocks want of it, so that it is used again. */
#define LEFT_LEAST  0.5
#define SQUARE_MOST 1e300 /* of an inverse reach: nothing may move */

static double speed_of(const se3di_particles *set, const se3di_particle *particle)
{
    return se3di_domain_strains(set) ? se3di_domain_speed(set, particle) : se3di_norm(particle->v);
}

/* How far a particle may go in so many steps. */
static double way(const se3di_particles *set, const se3di_particle *particle, double steps)
{
    return steps * (speed_of(set, particle) * set->drift + SHARE * set->pace);
}

static double clamp(double value, double least, double most)
{
    return value < least ? least : value < most ? value : most; /* NaN becomes most */
}

/* The farthest that a wall's surface is from where it was, where particles may touch it: of a plane
 * at the corners of the box of all particles, of others at most |shift| + angle * bound. */
static double wall_shift(const se3di_particles *set, const se3di_wall *wall, const double x[3],
                         const double R[9])
{
    const se3di_shape_pose *now = &wall->pose;
    if (memcmp(x, now->x, sizeof now->x) == 0 && memcmp(R, now->R, sizeof now->R) == 0) {
        return 0.0;
    }
    double shift[3];
    se3di_sub(now->x, x, shift);
    if (!se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE)) {
        double turn = 0.0;
        for (int k = 0; k < 9; ++k) {
            turn += (now->R[k] - R[k]) * (now->R[k] - R[k]);
        }
        return se3di_norm(shift) + sqrt(0.5 * turn) * wall->shape.bound;
    }
    double most = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double change = 0.0;
        for (int a = 0; a < 3; ++a) {
            const double p =
                corner >> a & 1 ? set->high[a] + set->stretch : set->low[a] - set->stretch;
            change += now->R[3 * a + 2] * (p - now->x[a]) - R[3 * a + 2] * (p - x[a]);
        }
        most = fmax(most, fabs(change));
    }
    return most;
}

/* How far a wall comes in a step, by how far it came since the last choice. It may be at rest for a
 * few steps: some of what was expected then stays. */
static double wall_pace(const se3di_particles *set, const se3di_wall *wall)
{
    const double shift = wall_shift(set, wall, wall->near_x, wall->near_R);
    const uint64_t since = set->steps - set->steps_near;
    const double pace = shift / (since > 1 ? (double)since : 1.0);
    return pace > 0.5 * wall->pace ? pace : 0.5 * wall->pace;
}

void se3di_particles_stretch(se3di_particles *set, double room)
{
    set->stretch = clamp(LIST_STEPS * (1.0 + SHARE) * set->pace, 0.5 * set->skin, set->skin);
    if (set->stretch > 0.5 * room) {
        set->stretch = 0.5 * room;
    }
}

static void reach_of_slab(se3di_particles *set, uint32_t s)
{
    double *reach = se3di_particles_reach(set);
    const double most = set->stretch < set->skin ? set->stretch : set->skin;
    const double least = 0.5 * set->skin < most ? 0.5 * set->skin : most;
    for (uint32_t k = set->slabs[s].begin; k < set->slabs[s].end; ++k) {
        reach[k] = clamp(way(set, &set->particles[k], LIST_STEPS), least, most);
    }
}

void se3di_particles_set_reach(se3di_particles *set)
{
    se3di_particles_each_slab(set, reach_of_slab);
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        wall->reach =
            clamp(LIST_STEPS * wall_pace(set, wall), 2.0 * NEAR_LEAST * set->skin, set->skin);
    }
}

/* What is left of a particle's reach. */
static double rest_of(const se3di_particles *set, size_t k)
{
    double shift[3];
    if (se3di_domain_strains(set)) {
        return se3di_particles_reach(set)[k] - se3di_domain_shift(set, k);
    }
    se3di_sub(set->particles[k].x, set->origin + 3 * k, shift);
    return se3di_particles_reach(set)[k] - se3di_norm(shift);
}

static double wanted_of(const se3di_particles *set, size_t k)
{
    const double wanted = way(set, &set->particles[k], NEAR_STEPS);
    const double least = NEAR_LEAST * set->skin;
    return wanted < least ? least : wanted;
}

static double wall_rest(const se3di_particles *set, const se3di_wall *wall)
{
    return wall->reach - wall_shift(set, wall, wall->old_x, wall->old_R);
}

static double wall_wanted(const se3di_particles *set, const se3di_wall *wall)
{
    const double wanted = NEAR_STEPS * wall_pace(set, wall);
    const double least = NEAR_LEAST * set->skin;
    return wanted < least ? least : wanted;
}

static double smaller(double a, double b)
{
    return b < a ? b : a;
}

static void wear_of_slab(se3di_particles *set, uint32_t s)
{
    double *wear = se3di_particles_wear(set);
    for (uint32_t k = set->slabs[s].begin; k < set->slabs[s].end; ++k) {
        const double most = smaller(wanted_of(set, k), rest_of(set, k));
        wear[k] = most > 0.0 ? most : 0.0;
    }
}

void se3di_particles_set_wear(se3di_particles *set, double scale)
{
    se3di_particles_each_slab(set, wear_of_slab);
    double *wear = se3di_particles_wear(set);
    for (size_t k = 0; scale < 1.0 && k < set->count; ++k) {
        wear[k] *= scale;
    }
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        wall->near_reach = scale * fmax(0.0, smaller(wall_wanted(set, wall), wall_rest(set, wall)));
    }
}

static void begin_slab(se3di_particles *set, uint32_t s)
{
    double *wear = se3di_particles_wear(set);
    for (uint32_t k = set->slabs[s].begin; k < set->slabs[s].end; ++k) {
        const double square = wear[k] * wear[k];
        wear[k] = square * SQUARE_MOST > 1.0 ? 1.0 / square : SQUARE_MOST;
    }
}

void se3di_particles_begin_wear(se3di_particles *set)
{
    se3di_particles_each_slab(set, begin_slab);
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        wall->pace = wall_pace(set, wall);
        se3di_copy(wall->pose.x, wall->near_x);
        memcpy(wall->near_R, wall->pose.R, sizeof wall->near_R);
    }
    set->worn = 0.0;
    set->steps_near = set->steps;
}

int se3di_particles_blocks_hold(const se3di_particles *set)
{
    int hold = set->worn < 1.0;
    for (size_t k = 0; hold && k < set->wall_count; ++k) {
        const se3di_wall *wall = &set->walls[k];
        const double shift = wall_shift(set, wall, wall->near_x, wall->near_R);
        hold = shift == 0.0 || shift < wall->near_reach;
    }
    return hold;
}

int se3di_particles_list_holds(const se3di_particles *set)
{
    int hold = isfinite(set->worn);
    for (size_t k = 0; hold && k < set->wall_count; ++k) {
        const se3di_wall *wall = &set->walls[k];
        hold = wall_rest(set, wall) >= LEFT_LEAST * wall_wanted(set, wall);
    }
    for (size_t k = 0; hold && k < set->count; ++k) {
        hold = se3di_share_is_ghost(set, k) || rest_of(set, k) >= LEFT_LEAST * wanted_of(set, k);
    }
    double fails = !hold;
    se3di_share_largest(set, 1, &fails);
    return !(fails > 0.0);
}
