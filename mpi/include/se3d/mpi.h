/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles over several processes of MPI (libse3d-mpi).                                docs/mpi.md
 *
 * Every process makes the same system by the same calls and attaches it. From then on all of them
 * call the same functions in the same order. While a run is under way each process moves its part
 * of the particles; when the call returns every one has all of them again, and reads the same bits,
 * whatever the number of processes and threads. Bodies are moved by all alike.
 *
 * Threads: MPI must have been initialised at least with MPI_THREAD_FUNNELED, by the thread that
 * makes the calls. */
#ifndef SE3D_MPI_H
#define SE3D_MPI_H

#include <mpi.h>

#include "se3d/se3d.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Share the particles of a system among the processes of `comm`, of which a copy is made. Sets that
 * are created later are not shared; snapshots, clones and copies are whole. What is not carried
 * (cells that strain, laws by callback) is refused when a run begins (UNSUPPORTED, the message says
 * what). A call that fails in one process, also by a callback of its own, fails in all, with that
 * message. Exclusive; collective.
 * @return OK, NULL, STATE (attached already, called from a callback, or the library is of another
 *         version), NO_MEMORY, IO (MPI failed).
 * @since 0.1 */
SE3D_API se3d_status se3d_mpi_attach(se3d_system *system, MPI_Comm comm);

/* Undo it: the system goes on in each process alone. NULL is fine; from within a callback of the
 * system it does nothing. Collective. @since 0.1 */
SE3D_API void se3d_mpi_detach(se3d_system *system);

/* What one process has done since it was attached, of one set of particles. @since 0.1 */
typedef struct se3d_mpi_stats {
    double elapsed;      /* in runs [s] */
    double waited;       /* of these in messages and in waiting for others [s] */
    uint64_t owned;      /* particles at the end of the last run */
    uint64_t ghosts;     /* copies of others' */
    uint64_t migrations; /* lists made anew, when particles may change hands */
    uint64_t moved;      /* particles that changed hands */
    uint64_t bytes;      /* sent for ghosts between that */
} se3d_mpi_stats;

/* Get what this process has done with a set. Reader.
 * @param[out] stats  all 0 if the set is not shared
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_mpi_get_stats(const se3d_particles *particles, se3d_mpi_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
