/* SPDX-License-Identifier: BSD-3-Clause */
/* Messages between the processes, and what all agree on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/quaternion.h"
#include "team.h"

#define STATE_SIZE 9 /* numbers of a ghost: place, velocity, angular velocity */
#define TURN_SIZE  4 /* of a clump, or of an end of a bond */

void team_fail(const team *t, const char *what, const char *why)
{
    fprintf(stderr, "se3d-mpi: process %d of %d: %s: %s; all processes end\n", t->rank, t->size,
            what, why);
    fflush(stderr);
    MPI_Abort(t->comm, 1);
    abort(); /* not reached */
}

static void check(const team *t, int code)
{
    if (code != MPI_SUCCESS) {
        team_fail(t, "MPI", "a message failed");
    }
}

void team_reserve(const team *t, void *array, size_t *capacity, size_t count, size_t size)
{
    void *data;
    if (count <= *capacity) {
        return;
    }
    const size_t grown = count + count / 4 + 16;
    memcpy(&data, array, sizeof data);
    data = grown > SIZE_MAX / size ? NULL : realloc(data, grown * size);
    if (!data) {
        team_fail(t, "particles", "memory is missing");
    }
    memcpy(array, &data, sizeof data);
    *capacity = grown;
}

void bytes_put(const team *t, bytes *to, const void *data, size_t size)
{
    team_reserve(t, &to->data, &to->capacity, to->count + size, 1);
    if (size > 0) {
        memcpy(to->data + to->count, data, size);
    }
    to->count += size;
}

/* MPI counts in int. */
static int small(const team *t, size_t count)
{
    if (count > 0x7fffffff) {
        team_fail(t, "particles", "a message is longer than 2 GB: take more processes");
    }
    return (int)count;
}

static void make_room(team *t)
{
    t->came.count = t->from[t->size];
    team_reserve(t, &t->came.data, &t->came.capacity, t->came.count + 1, 1);
}

void team_exchange(team *t)
{
    const double begun = MPI_Wtime();
    int *counts = calloc(2 * (size_t)t->size, sizeof *counts);
    if (!counts) {
        team_fail(t, "particles", "memory is missing");
    }
    int *const there = counts + t->size;
    for (int q = 0; q < t->size; ++q) {
        counts[q] = small(t, t->to[q].count);
    }
    check(t, MPI_Alltoall(counts, 1, MPI_INT, there, 1, MPI_INT, t->comm));
    t->from[0] = 0;
    for (int q = 0; q < t->size; ++q) {
        t->from[q + 1] = t->from[q] + (size_t)there[q];
    }
    make_room(t);
    int active = 0;
    for (int q = 0; q < t->size; ++q) {
        if (there[q] > 0 && q != t->rank) {
            check(t, MPI_Irecv(t->came.data + t->from[q], there[q], MPI_BYTE, q, 1, t->comm,
                               &t->requests[active++]));
        }
    }
    for (int q = 0; q < t->size; ++q) {
        if (counts[q] > 0 && q != t->rank) {
            check(t, MPI_Isend(t->to[q].data, counts[q], MPI_BYTE, q, 1, t->comm,
                               &t->requests[active++]));
        }
    }
    if (counts[t->rank] > 0) {
        memcpy(t->came.data + t->from[t->rank], t->to[t->rank].data, t->to[t->rank].count);
    }
    check(t, MPI_Waitall(active, t->requests, MPI_STATUSES_IGNORE));
    free(counts);
    t->stats.waited += MPI_Wtime() - begun;
}

void team_collect(team *t, const bytes *own)
{
    const double begun = MPI_Wtime();
    int *counts = calloc(2 * (size_t)t->size, sizeof *counts);
    if (!counts) {
        team_fail(t, "particles", "memory is missing");
    }
    int *const places = counts + t->size;
    int size = small(t, own->count);
    check(t, MPI_Allgather(&size, 1, MPI_INT, counts, 1, MPI_INT, t->comm));
    t->from[0] = 0;
    for (int q = 0; q < t->size; ++q) {
        places[q] = small(t, t->from[q]);
        t->from[q + 1] = t->from[q] + (size_t)counts[q];
    }
    make_room(t);
    check(t, MPI_Allgatherv(own->data, size, MPI_BYTE, t->came.data, counts, places, MPI_BYTE,
                            t->comm));
    free(counts);
    t->stats.waited += MPI_Wtime() - begun;
}

void team_largest(const se3di_particles *set, size_t count, double *values)
{
    team *t = team_of(set);
    const double begun = MPI_Wtime();
    for (size_t k = 0; k < count; ++k) { /* MPI says nothing of NaN */
        values[k] = isnan(values[k]) ? HUGE_VAL : values[k];
    }
    check(t, MPI_Allreduce(MPI_IN_PLACE, values, small(t, count), MPI_DOUBLE, MPI_MAX, t->comm));
    t->stats.waited += MPI_Wtime() - begun;
}

void team_add(const se3di_particles *set, size_t count, double *values)
{
    team *t = team_of(set);
    const double begun = MPI_Wtime();
    check(t, MPI_Allreduce(MPI_IN_PLACE, values, small(t, count), MPI_DOUBLE, MPI_SUM, t->comm));
    t->stats.waited += MPI_Wtime() - begun;
}

void team_add_counts(team *t, uint64_t *counts, int count)
{
    check(t, MPI_Allreduce(MPI_IN_PLACE, counts, count, MPI_UINT64_T, MPI_SUM, t->comm));
}

/* What a failure is about. */
typedef struct failure {
    double amount, time;
    uint32_t failed, with, wall;
    int32_t status, placed, reserved;
} failure;

static int is_worse(const failure *a, const failure *b)
{
    if (a->status != b->status) {
        return a->status < b->status;
    }
    if (a->amount < b->amount || a->amount > b->amount) {
        return a->amount > b->amount;
    }
    return a->failed < b->failed || (a->failed == b->failed && a->with < b->with);
}

se3d_status team_agree(se3di_particles *set, se3d_status status)
{
    team *t = team_of(set);
    const failure own = {set->failed_amount, set->failed_time, set->failed,        set->failed_with,
                         set->failed_wall,   (int32_t)status,  set->failed_placed, 0};
    failure *all = calloc((size_t)t->size, sizeof *all);
    if (!all) {
        team_fail(t, "particles", "memory is missing");
    }
    check(t, MPI_Allgather(&own, sizeof own, MPI_BYTE, all, sizeof own, MPI_BYTE, t->comm));
    failure worst = all[0];
    for (int q = 1; q < t->size; ++q) {
        worst = is_worse(&all[q], &worst) ? all[q] : worst;
    }
    free(all);
    if (worst.status < 0) {
        set->failed = worst.failed;
        set->failed_with = worst.with;
        set->failed_wall = worst.wall;
        set->failed_amount = worst.amount;
        set->failed_time = worst.time;
        set->failed_placed = worst.placed;
    }
    return (se3d_status)worst.status;
}

se3d_status team_settle(se3di_particles *set, se3d_status status, se3di_error *error)
{
    team *t = team_of(set);
    struct {
        int status, rank;
    } own = {(int)status, t->rank}, worst;
    se3di_error told = {.message = ""};
    check(t, MPI_Allreduce(&own, &worst, 1, MPI_2INT, MPI_MINLOC, t->comm));
    if (worst.status >= 0) {
        return status;
    }
    t->share.told = (se3d_status)worst.status;
    if (error->status == status) { /* else the message is an older one */
        memcpy(told.message, error->message, sizeof told.message);
        memcpy(told.field, error->field, sizeof told.field);
    }
    check(t, MPI_Bcast(told.message, sizeof told.message, MPI_CHAR, worst.rank, t->comm));
    check(t, MPI_Bcast(told.field, sizeof told.field, MPI_CHAR, worst.rank, t->comm));
    if (worst.rank != t->rank && told.message[0]) {
        (void)se3di_error_set(error, (se3d_status)worst.status, "%s", told.message);
        memcpy(error->field, told.field, sizeof told.field);
    }
    return (se3d_status)worst.status;
}

static size_t count_sent(const peer *p)
{
    return STATE_SIZE * p->sent_count + TURN_SIZE * (p->sent_clumps.count + p->sent_ends.count);
}

static size_t count_received(const peer *p)
{
    return STATE_SIZE * p->count + TURN_SIZE * (p->clumps.count + p->ends.count);
}

static void pack(const se3di_particles *set, const peer *p)
{
    const team *t = team_of(set);
    double *out = p->out;
    for (size_t k = 0; k < p->sent_count; ++k, out += STATE_SIZE) {
        const uint32_t index = set->index_of[t->seen[p->sent + k]];
        memcpy(out, set->particles[index].x, 3 * sizeof *out);
        memcpy(out + 3, set->particles[index].v, 3 * sizeof *out);
        memcpy(out + 6, set->spins[index].w, 3 * sizeof *out);
    }
    for (size_t k = 0; k < p->sent_clumps.count; ++k, out += TURN_SIZE) {
        memcpy(out, set->clumps[t->seen_clumps[p->sent_clumps.from + k]].q, 4 * sizeof *out);
    }
    for (size_t k = 0; k < p->sent_ends.count; ++k, out += TURN_SIZE) {
        memcpy(out, set->bond_ends[t->seen_ends[p->sent_ends.from + k]].q, 4 * sizeof *out);
    }
}

static void unpack(se3di_particles *set, const peer *p)
{
    const double *in = p->in;
    for (uint32_t id = p->first; id < p->first + p->count; ++id, in += STATE_SIZE) {
        const uint32_t index = set->index_of[id];
        memcpy(set->particles[index].x, in, 3 * sizeof *in);
        memcpy(set->particles[index].v, in + 3, 3 * sizeof *in);
        memcpy(set->spins[index].w, in + 6, 3 * sizeof *in);
        set->loads[index] = (se3di_load){{0.0}, {0.0}};
    }
    for (size_t k = 0; k < p->clumps.count; ++k, in += TURN_SIZE) {
        se3di_clump *clump = &set->clumps[p->clumps.from + k];
        memcpy(clump->q, in, sizeof clump->q);
        se3di_quat_to_matrix(clump->q, clump->A);
    }
    for (size_t k = 0; k < p->ends.count; ++k, in += TURN_SIZE) {
        memcpy(set->bond_ends[p->ends.from + k].q, in, 4 * sizeof *in);
    }
}

/* The buffers of all peers lie one after the other. */
static void place_values(team *t)
{
    size_t size = 0;
    for (size_t k = 0; k < t->peer_count; ++k) {
        size += count_sent(&t->peers[k]) + count_received(&t->peers[k]);
    }
    team_reserve(t, &t->values, &t->value_capacity, size + 1, sizeof *t->values);
    double *at = t->values;
    for (size_t k = 0; k < t->peer_count; ++k) {
        peer *p = &t->peers[k];
        p->out = at;
        p->in = at + count_sent(p);
        at = p->in + count_received(p);
    }
}

void team_renew(se3di_particles *set)
{
    team *t = team_of(set);
    const double begun = MPI_Wtime();
    int active = 0;
    place_values(t);
    for (size_t k = 0; k < t->peer_count; ++k) {
        const peer *p = &t->peers[k];
        check(t, MPI_Irecv(p->in, small(t, count_received(p)), MPI_DOUBLE, p->rank, 2, t->comm,
                           &t->requests[active++]));
    }
    for (size_t k = 0; k < t->peer_count; ++k) {
        const peer *p = &t->peers[k];
        pack(set, p);
        check(t, MPI_Isend(p->out, small(t, count_sent(p)), MPI_DOUBLE, p->rank, 2, t->comm,
                           &t->requests[active++]));
        t->stats.bytes += count_sent(p) * sizeof(double);
    }
    check(t, MPI_Waitall(active, t->requests, MPI_STATUSES_IGNORE));
    for (size_t k = 0; k < t->peer_count; ++k) {
        unpack(set, &t->peers[k]);
    }
    t->stats.waited += MPI_Wtime() - begun;
}
