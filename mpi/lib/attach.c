/* SPDX-License-Identifier: BSD-3-Clause */
/* libse3d-mpi: which sets are shared.                                                docs/mpi.md */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/system_internal.h"
#include "team.h"

static void give_up(se3di_particles *set, const char *why)
{
    team_fail(team_of(set), "particles", why);
}

static void destroy(team *t)
{
    if (!t) {
        return;
    }
    for (int q = 0; t->to && q < t->size; ++q) {
        free(t->to[q].data);
    }
    boxes_destroy(&t->boxes);
    free(t->number);
    free(t->peers);
    free(t->seen);
    free(t->values);
    free(t->requests);
    free(t->to);
    free(t->came.data);
    free(t->from);
    free(t->histories);
    free(t->touches);
    free(t->table);
    free(t->removed);
    free(t->arrivals);
    free(t->clump_arrivals.data);
    free(t->seen_clumps);
    free(t->seen_ends);
    free(t->ties);
    free(t->ends);
    free(t->end_of);
    free(t->gone);
    free(t->share.fresh);
    free(t->share.sums);
    free(t->share.powers);
    free(t);
}

static void forget(se3di_particles *set)
{
    team *t = team_of(set);
    int ended = 0;
    set->share = NULL;
    (void)MPI_Finalized(&ended);
    if (!ended) {
        (void)MPI_Comm_free(&t->comm);
    }
    destroy(t);
}

static team *create(int rank, int size)
{
    team *t = calloc(1, sizeof *t);
    if (!t) {
        return NULL;
    }
    t->rank = rank;
    t->size = size;
    const size_t n = (size_t)size;
    t->peers = calloc(n, sizeof *t->peers);
    t->requests = calloc(2 * n, sizeof(MPI_Request));
    t->to = calloc(n, sizeof *t->to);
    t->from = calloc(n + 1, sizeof *t->from);
    if (!t->peers || !t->requests || !t->to || !t->from || !boxes_create(&t->boxes, size)) {
        destroy(t);
        return NULL;
    }
    t->share = (se3di_share){.ctx = t,
                             .spread = team_spread,
                             .gather = team_gather,
                             .migrate = team_migrate,
                             .border = team_border,
                             .insert = team_insert,
                             .renew = team_renew,
                             .largest = team_largest,
                             .add = team_add,
                             .part = team_part,
                             .agree = team_agree,
                             .settle = team_settle,
                             .give_up = give_up,
                             .forget = forget};
    return t;
}

static se3d_status attach_set(se3d_system *system, se3di_particles *set, MPI_Comm comm)
{
    int rank = 0, size = 1;
    if (MPI_Comm_rank(comm, &rank) != MPI_SUCCESS || MPI_Comm_size(comm, &size) != MPI_SUCCESS) {
        return SE3DI_FAIL(system, SE3D_ERR_IO, "MPI does not know the processes");
    }
    team *t = create(rank, size);
    if (!t) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for what processes share");
    }
    if (MPI_Comm_dup(comm, &t->comm) != MPI_SUCCESS) {
        destroy(t);
        return SE3DI_FAIL(system, SE3D_ERR_IO, "MPI made no copy of the communicator");
    }
    set->share = &t->share;
    return SE3D_OK;
}

se3d_status se3d_mpi_attach(se3d_system *system, MPI_Comm comm)
{
    char own[48];
    SE3DI_EDIT(system);
    (void)snprintf(own, sizeof own, "%d.%d.%d", SE3D_VERSION_MAJOR, SE3D_VERSION_MINOR,
                   SE3D_VERSION_PATCH);
    if (strcmp(se3d_version_get_text(), own) != 0) {
        return SE3DI_FAIL(system, SE3D_ERR_STATE, "libse3d-mpi is of version %s, libse3d of %s",
                          own, se3d_version_get_text());
    }
    for (se3di_particles *set = system->model.sets; set; set = set->next) {
        if (set->share) {
            return SE3DI_FAIL(system, SE3D_ERR_STATE, "the particles are shared already");
        }
    }
    for (se3di_particles *set = system->model.sets; set; set = set->next) {
        const se3d_status status = attach_set(system, set, comm);
        if (status < 0) {
            se3d_mpi_detach(system);
            return status;
        }
    }
    return SE3D_OK;
}

void se3d_mpi_detach(se3d_system *system)
{
    if (system && se3di_enter(system, SE3DI_BUSY_FREE, __func__) < 0) {
        return; /* who steps would go on with what is gone */
    }
    for (se3di_particles *set = system ? system->model.sets : NULL; set; set = set->next) {
        if (set->share) {
            forget(set);
        }
    }
}

se3d_status se3d_mpi_get_stats(const se3d_particles *particles, se3d_mpi_stats *stats)
{
    static const se3d_mpi_stats none = {0.0, 0.0, 0, 0, 0, 0, 0};
    if (!particles || !stats) {
        return SE3D_ERR_NULL;
    }
    /* a set is the first member of what the user has */
    const se3di_particles *set = (const se3di_particles *)(const void *)particles;
    *stats = set->share ? team_of(set)->stats : none;
    return SE3D_OK;
}
