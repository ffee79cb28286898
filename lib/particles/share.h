/* SPDX-License-Identifier: BSD-3-Clause */
/* A set that is spread over processes while it moves. Each has some particles of its own, and
 * copies of those of others that these may touch: ghosts. Between runs the set is whole everywhere.
 *
 * The hooks are called by all processes at the same places, in the same order. The order of sums is
 * that of the whole: particles of a cell stand in the order of their numbers, the two sides of a
 * pair are added in turn, and what walls get is added up without rounding. So nothing depends on
 * who has which particles.                                                           docs/mpi.md */
#ifndef SE3DI_PARTICLES_SHARE_H
#define SE3DI_PARTICLES_SHARE_H

#include "particles/set.h"

typedef struct se3di_share {
    int32_t is_spread; /* 0: the set is whole here */
    uint32_t owned;    /* own particles have the ids below this, ghosts the others */
    /* The first clumps; their spheres are own particles. Of the others, which are ghosts, only q
     * and A are renewed: x, v and spin are those of when the lists were made. */
    uint32_t owned_clumps;
    se3d_status told;       /* of the call under way, which has failed for all; else 0 */
    const uint32_t *number; /* [id] their ids in the whole */
    uint64_t total;         /* own particles of all processes */
    size_t ids;             /* of the whole so far */
    double *sums;           /* [slabs most * walls * 6 * SE3DI_EXACT_PARTS] */
    se3di_exact (*powers)[SE3DI_AUDIT_KINDS + 1]; /* [slabs most] as power of a slab; or NULL */
    double steps[SE3DI_EXACT_PARTS]; /* 3/2 2^52 times what the parts are multiples of */
    double (*fresh)[4]; /* [fresh_count] places and radii of what sources have inserted */
    size_t fresh_count; /* since lists were made; all processes know of it */
    void *ctx;
    /* A run begins: lists are made anew, and what is not carried is refused; *why says what. */
    se3d_status (*spread)(se3di_particles *set, const char **why);
    void (*gather)(se3di_particles *set); /* and ends */
    /* Lists are to be made anew: history has been collected, order[] is 0 for what goes. Particles
     * come to whom they belong, ghosts are gone. */
    void (*migrate)(se3di_particles *set);
    /* Ghosts as far as `reach` from the places of the own ones, and the history. */
    void (*border)(se3di_particles *set, double reach);
    /* Of the `spheres` that a source has just appended, which are one clump or a free one, and are
     * taken out again: they are their owner's when lists are made. */
    void (*insert)(se3di_particles *set, size_t spheres, int is_clump);
    void (*renew)(se3di_particles *set); /* places, velocities and turns of ghosts */
    /* A bond goes, with its fate: all processes that have it say so. */
    void (*part)(se3di_particles *set, const se3di_bond *bond);
    void (*largest)(const se3di_particles *set, size_t count,
                    double *values);                                       /* of all processes */
    void (*add)(const se3di_particles *set, size_t count, double *values); /* without rounding */
    /* The worst status of all, and what it is about. */
    se3d_status (*agree)(se3di_particles *set, se3d_status status);
    /* The worst status of all, with the message of the first process that has it; also between
     * runs. */
    se3d_status (*settle)(se3di_particles *set, se3d_status status, se3di_error *error);
    void (*give_up)(se3di_particles *set, const char *why); /* ends all processes */
    void (*forget)(se3di_particles *set);                   /* the set goes */
} se3di_share;

static inline int se3di_share_is_spread(const se3di_particles *set)
{
    return set->share && set->share->is_spread;
}

/* Particle k is a copy of another process's. */
static inline int se3di_share_is_ghost(const se3di_particles *set, size_t k)
{
    return se3di_share_is_spread(set) && set->spins[k].id >= set->share->owned;
}

/* What particle k is called in the whole. */
static inline uint32_t se3di_share_number(const se3di_particles *set, size_t k)
{
    const uint32_t id = set->spins[k].id;
    return se3di_share_is_spread(set) ? set->share->number[id] : id;
}

/* Particles of all processes. */
static inline size_t se3di_share_total(const se3di_particles *set)
{
    return se3di_share_is_spread(set) ? (size_t)set->share->total : set->count;
}

/* The largest values of all processes; NaN if one is NaN. */
static inline void se3di_share_largest(const se3di_particles *set, size_t count, double *values)
{
    if (se3di_share_is_spread(set)) {
        set->share->largest(set, count, values);
    }
}

static inline se3d_status se3di_share_agree(se3di_particles *set, se3d_status status)
{
    return se3di_share_is_spread(set) ? set->share->agree(set, status) : status;
}

/* Clumps that are moved here: the first ones. */
static inline size_t se3di_share_clumps(const se3di_particles *set)
{
    return se3di_share_is_spread(set) ? set->share->owned_clumps : set->clump_count;
}

/* What a wall gets, force and torque, to the exact sums: in parts that are multiples of powers of
 * two. */
static inline void se3di_share_add_to_wall(const se3di_particles *set, uint32_t wall,
                                           const double force[3], const double torque[3])
{
    double *sum = set->share->sums + (size_t)(6 * SE3DI_EXACT_PARTS) * wall;
    for (int a = 0; a < 6; ++a) {
        double rest = a < 3 ? force[a] : torque[a - 3];
        for (int n = 0; n < SE3DI_EXACT_PARTS; ++n) {
            const double step = set->share->steps[n], part = (rest + step) - step;
            sum[SE3DI_EXACT_PARTS * a + n] += part;
            rest -= part;
        }
    }
}

/* Sums over all processes, which do not depend on who has what. */
static inline void se3di_share_add_exactly(const se3di_particles *set, size_t count,
                                           se3di_exact *sums)
{
    for (size_t k = 0; k < count; ++k) {
        se3di_exact_carry(&sums[k]);
    }
    if (se3di_share_is_spread(set) && count > 0) {
        set->share->add(set, count * SE3DI_EXACT_SIZE, sums->part);
    }
}

static inline void se3di_share_gather(se3di_particles *set)
{
    if (se3di_share_is_spread(set)) {
        set->share->gather(set);
    }
}

#endif
