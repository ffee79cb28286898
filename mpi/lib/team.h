/* SPDX-License-Identifier: BSD-3-Clause */
/* What a process knows of a set that several share. Memory is the process's own; if it is missing,
 * or a message fails, all processes end. */
#ifndef SE3DM_TEAM_H
#define SE3DM_TEAM_H

#include <mpi.h>

#include "base/error.h"
#include "boxes.h"
#include "particles/share.h"
#include "se3d/mpi.h"

/* Bytes to be sent, or that have come. */
typedef struct bytes {
    unsigned char *data;
    size_t count, capacity;
} bytes;

/* A particle on its way. */
typedef struct mover {
    uint32_t number, reserved;
    se3di_particle particle;
    se3di_spin spin;
} mover;

/* The history of a pair, by numbers; j >= SE3DI_CARRY_WALL: with a wall. */
typedef struct history {
    uint32_t i, j;
    double xi[3], rho[4];
} history;

/* A bond on its way: its ends are those of the whole. */
typedef struct tie {
    se3di_bond bond;
    se3di_bond_end wall; /* the second end, if that is on one */
    uint32_t sphere[2];  /* numbers; SE3DI_NO_INDEX: on a wall */
} tie;

/* A bond that went, in this step. */
typedef struct parting {
    uint64_t step;
    se3di_bond bond;
} parting;

typedef struct span {
    size_t from, count;
} span;

/* Another process with which ghosts are exchanged. */
typedef struct peer {
    int rank;
    uint32_t first, count;       /* ids of its particles here */
    size_t sent, sent_count;     /* of those that it sees, in team.seen */
    span clumps, ends;           /* its clumps and ends of bonds here, */
    span sent_clumps, sent_ends; /* and those that it sees */
    double *out, *in;            /* in team.values */
} peer;

typedef struct team {
    se3di_share share;
    MPI_Comm comm;
    int rank, size;
    boxes boxes;
    uint32_t *number;
    size_t number_capacity;
    peer *peers; /* [size] the first peer_count */
    size_t peer_count;
    uint32_t *seen; /* ids of own particles that others see */
    size_t seen_capacity;
    uint32_t *seen_clumps, *seen_ends; /* the same */
    size_t seen_clump_capacity, seen_end_capacity;
    double *values; /* places and velocities on their way */
    size_t value_capacity;
    MPI_Request *requests; /* [2 * size] */
    bytes *to;             /* [size] */
    bytes came;            /* from all, in the order of ranks, */
    size_t *from;          /* [size + 1] where that of each begins */
    history *histories;    /* of what came, until the ghosts are here */
    size_t history_count, history_capacity;
    se3di_mesh_pair *touches; /* the same on meshes; i: number */
    size_t touch_count, touch_capacity;
    tie *ties; /* bonds that have come, */
    size_t tie_count, tie_capacity;
    se3di_bond_end *ends; /* [end_count] and all ends of the whole when the run began */
    size_t end_count, end_capacity;
    uint32_t *end_of; /* own id -> end, while ghosts are chosen */
    size_t end_of_capacity;
    parting *gone; /* [set->bonds_gone] */
    size_t gone_capacity;
    uint32_t *table; /* hash of numbers -> index */
    size_t table_size;
    int32_t from_whole; /* all have all: nothing need be sent */
    int32_t reserved;
    size_t ids;      /* of the whole */
    mover *arrivals; /* of `fresh`, those that are this process's */
    size_t arrival_count, arrival_capacity, fresh_capacity;
    bytes clump_arrivals; /* the same: clumps, each with its spheres */
    uint64_t clump_arrival_count;
    uint64_t lost, lost_of[SE3D_PARTICLES_TAGS];
    uint64_t *removed; /* [sinks] as the last three, when the run began */
    size_t sum_capacity, power_capacity, removed_capacity;
    se3d_mpi_stats stats;
    double begun;
} team;

/* message.c */
void team_fail(const team *t, const char *what, const char *why) __attribute__((noreturn));
/* Room for `count` elements; those that are there stay. */
void team_reserve(const team *t, void *array, size_t *capacity, size_t count, size_t size);
void bytes_put(const team *t, bytes *to, const void *data, size_t size);
void team_exchange(team *t); /* team.to -> team.came */
/* What all have, one after the other. */
void team_collect(team *t, const bytes *own);
void team_largest(const se3di_particles *set, size_t count, double *values);
void team_add(const se3di_particles *set, size_t count, double *values);
void team_add_counts(team *t, uint64_t *counts, int count);
se3d_status team_agree(se3di_particles *set, se3d_status status);
se3d_status team_settle(se3di_particles *set, se3d_status status, se3di_error *error);
void team_renew(se3di_particles *set);

/* migrate.c */
void team_migrate(se3di_particles *set);
void team_border(se3di_particles *set, double reach);
/* The particle of a number, while all still lie where their ids say; SE3DI_NO_INDEX: not here. */
uint32_t team_find(const team *t, uint32_t number);
void team_append(se3di_particles *set, const mover *m);
mover team_mover_of(const se3di_particles *set, size_t k);
/* Whether this process tells `owner`: if everyone has everything only what stays is looked at. */
static inline int team_is_sent(const team *t, int owner)
{
    return owner >= 0 && (!t->from_whole || owner == t->rank);
}

/* arrive.c */
void team_insert(se3di_particles *set, size_t spheres, int is_clump);
void team_forget_arrivals(team *t);

/* tied.c: clumps */
uint32_t team_count_spheres(const se3di_particles *set, const se3di_clump *clump);
/* One whose spheres are appended next. */
void team_append_clump(se3di_particles *set, const se3di_clump *clump);
void team_index_clumps(se3di_particles *set);
/* ... and bonds: those of own first ends, and own ends, for the whole; */
void team_pack_ties(const se3di_particles *set, bytes *out);
void team_pack_ends(const se3di_particles *set, bytes *out);
/* ends and bonds [size] to whom they belong from now on; `owner_of`: -1 of what goes; */
typedef int (*team_owner)(const se3di_particles *set, size_t k);
void team_send_bonds(se3di_particles *set, team_owner owner_of, bytes *ends, bytes *ties);
/* and to their places, when all spheres are here: ends by the numbers of these, then bonds. */
void team_append_ends(se3di_particles *set, const se3di_bond_end *ends, size_t count);
void team_restore_bonds(se3di_particles *set);
void team_part(se3di_particles *set, const se3di_bond *bond);
/* A run begins: bonds and their ends are called what they are in the whole. */
void team_begin_bonds(se3di_particles *set);
/* It ends: from what all have. The ties are sorted on the way, and what all have written down. */
typedef struct all_bonds {
    const se3di_bond_end *ends;
    tie *ties;
    parting *gone;
    size_t end_count, tie_count, gone_count;
} all_bonds;
void team_fill_bonds(se3di_particles *set, const all_bonds *all);
/* How far ghosts have to reach, and how far own spheres may be outside of the own box. */
void team_reach(const se3di_particles *set, double *reach, double *beyond);

/* whole.c */
se3d_status team_spread(se3di_particles *set, const char **why);
void team_gather(se3di_particles *set);

static inline team *team_of(const se3di_particles *set)
{
    return set->share->ctx;
}

static inline history history_of(const se3di_particles *set, const se3di_carry *carry, size_t k)
{
    history h = {carry->i, carry->j, {carry->xi[0], carry->xi[1], carry->xi[2]}, {0.0}};
    for (size_t a = 0; set->carry_rolling && a < 4; ++a) {
        h.rho[a] = set->carry_roll[4 * k + a];
    }
    return h;
}

#endif
