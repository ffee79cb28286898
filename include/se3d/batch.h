/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: many states of one system, stepped side by side in the lanes of vector registers and by
 * several threads: samples of a study, environments of a learner, trials of a controller.
 *
 * A batch is a copy of a system without couplers, drivers, contact, particles, friction and stops,
 * whose joints form a tree, or loops that pins in planes or balls close. States with loops are
 * moved onto them when they are set and after each step; one that comes to a position at which the
 * equations of the loops depend on each other fails. Each state has positions q and velocities qdot
 * in the joint coordinates of se3d/coordinates.h (the same numbers in the same order), a time,
 * efforts along the coordinates, and may have gravity and masses of its own. A state has the same
 * bits for any number of states and threads, wherever it stands.
 *
 * Arrays of several states are row-major: those of one state lie together. Gravity, efforts,
 * springs with dampers between points and on coordinates of joints, and loads are computed in lanes
 * if no function of time or of the state is in them; if one force element is something else, all
 * are evaluated state by state, which is slower. Functions and callbacks of force elements are
 * called by several threads at a time if the batch has several.
 * docs/theory/lanes.md
 *
 * Threads: the rule of se3d/se3d.h; a batch is independent of its system. */
#ifndef SE3D_BATCH_H
#define SE3D_BATCH_H

#include "se3d/handles.h"
#include "se3d/solver.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Create a batch whose states are all as the system is now, without efforts of their own. All
 * memory that steps need is taken here. The system may change or go afterwards.
 * @param[in] system   errors of this call are recorded there
 * @param[in] count    states, >= 1
 * @param[in] threads  1 ... 1024; results do not depend on it
 * @param[out] out     NULL on failure
 * @return OK, NULL, INVALID_ARGUMENT, STATE, NO_MEMORY, UNSUPPORTED (elements that a batch cannot
 * have; the message names one).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_create(se3d_system *system, size_t count, int32_t threads,
                                       se3d_batch **out);

/* Destroy a batch; NULL is fine. Within one of its callbacks nothing is destroyed, and a message
 * (STATE) says so. @since 0.1 */
SE3D_API void se3d_batch_destroy(se3d_batch *batch);

/* Count the states. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_batch_count(const se3d_batch *batch);

/* Count the positions of a state. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_batch_count_positions(const se3d_batch *batch);

/* Count the velocities of a state. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_batch_count_velocities(const se3d_batch *batch);

/* Count the states that are computed at once: 8, 4 or 1, as the processor allows.
 * @return the number; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_batch_count_lanes(const se3d_batch *batch);

/* Count the force elements that are evaluated state by state because lanes cannot compute one of
 * them: all of them, or 0.
 * @return the number; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_batch_count_single_forces(const se3d_batch *batch);

/* Get the message of the last failure. @return the text, "" if none failed; valid until the next
 * call on this batch. @since 0.1 */
SE3D_API const char *se3d_batch_get_error(const se3d_batch *batch);

/* Set states, which go on from there even if they had failed. NULL ones stay as they are.
 * @param[in] first  state, from 0
 * @param[in] count  of states; first + count <= se3d_batch_count
 * @param[in] q      [count x positions] [rad, m]; quaternions are made unit ones
 * @param[in] qdot   [count x velocities] [rad/s, m/s]
 * @return OK, NULL (batch), STATE, INVALID_ARGUMENT (range; a quaternion of zero or too long),
 * NOT_FINITE; nothing is set then. States from which the loops do not close have failed
 * (NO_CONVERGENCE): se3d_batch_get_status.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_set_state(se3d_batch *batch, size_t first, size_t count,
                                          const double *q, const double *qdot);

/* Get states. NULL ones are skipped.
 * @param[in] first   state, from 0
 * @param[in] count   of states
 * @param[out] q      [count x positions]
 * @param[out] qdot   [count x velocities]
 * @return OK, NULL (batch), STATE (within a callback), INVALID_ARGUMENT (range).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_get_state(const se3d_batch *batch, size_t first, size_t count,
                                          double *q, double *qdot);

/* Set the times of states.
 * @param[in] first  state, from 0
 * @param[in] count  of states
 * @param[in] time   [count] [s]
 * @return OK, NULL, STATE, INVALID_ARGUMENT (range), NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_set_time(se3d_batch *batch, size_t first, size_t count,
                                         const double *time);

/* Get the times of states.
 * @param[in] first  state, from 0
 * @param[in] count  of states
 * @param[out] time  [count] [s]
 * @return OK, NULL, STATE (within a callback), INVALID_ARGUMENT (range).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_get_time(const se3d_batch *batch, size_t first, size_t count,
                                         double *time);

/* Set what acts along the coordinates from now on, besides force elements.
 * @param[in] first   state, from 0
 * @param[in] count   of states
 * @param[in] effort  [count x velocities] [N m, N]; of a free body: force (ground frame) and torque
 *                    (body frame) on it
 * @return OK, NULL, STATE, INVALID_ARGUMENT (range), NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_set_efforts(se3d_batch *batch, size_t first, size_t count,
                                            const double *effort);

/* Set the gravity of states; components that the system has functions for keep these.
 * @param[in] first    state, from 0
 * @param[in] count    of states
 * @param[in] gravity  [count x 3] ground frame [m/s^2]
 * @return OK, NULL, STATE, INVALID_ARGUMENT (range), NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_set_gravity(se3d_batch *batch, size_t first, size_t count,
                                            const double *gravity);

/* Set the mass and inertia of a body in states. The first call takes memory for all states.
 * @param[in] body     of the system that the batch was made of; not fixed
 * @param[in] first    state, from 0
 * @param[in] count    of states
 * @param[in] mass     [count] [kg], > 0
 * @param[in] inertia  [count x 6] about the centre of mass, body frame: xx yy zz xy yz xz [kg m^2]
 * @return OK, NULL, STATE, STALE_HANDLE, INVALID_ARGUMENT (range, a fixed body, mass, no inertia of
 * a body), NO_MEMORY; nothing is set then.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_set_mass(se3d_batch *batch, se3d_body body, size_t first,
                                         size_t count, const double *mass, const double *inertia);

/* Take equal steps with all states that have not failed. A state whose step fails keeps the one
 * before it and is left alone from then on, until it is set; the others do not notice.
 * @param[in] method  SE3D_METHOD_RK4, SE3D_METHOD_RK45 or SE3D_METHOD_DOP853: of order 4, 5 and 8
 * @param[in] step    length [s], > 0
 * @param[in] steps   their number
 * @return OK, or that of the first state that has failed, also before (the message says which), of
 * NOT_FINITE, SINGULAR, NO_CONVERGENCE, CALLBACK; NULL, STATE, INVALID_ARGUMENT, UNSUPPORTED
 * (method).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_step(se3d_batch *batch, se3d_method method, double step,
                                     uint64_t steps);

/* Get the statuses of states: why they failed.
 * @param[in] first    state, from 0
 * @param[in] count    of states
 * @param[out] status  [count] se3d_status; OK: it has not
 * @return OK, NULL, STATE (within a callback), INVALID_ARGUMENT (range).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_get_status(const se3d_batch *batch, size_t first, size_t count,
                                           int32_t *status);

/* Compute the accelerations of all states, efforts included.
 * @param[out] qddot  [states x velocities]; zero for states that fail
 * @return OK, or that of the first state that has failed, also before and while it was set,
 * of NOT_FINITE, SINGULAR, CALLBACK; NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_compute_accelerations(se3d_batch *batch, double *qddot);

/* Compute the efforts that give accelerations, against inertia and force elements: inverse dynamics
 * of all states, of trees: with loops many efforts give the same accelerations. Efforts that were
 * set take no part.
 * @param[in] qddot    [states x velocities]; NULL: zero
 * @param[out] effort  [states x velocities]; zero for states that fail
 * @return OK, or that of the first state that has failed, also before, of NOT_FINITE, SINGULAR,
 * CALLBACK; NULL, STATE, UNSUPPORTED (loops).
 * @since 0.1 */
SE3D_API se3d_status se3d_batch_compute_efforts(se3d_batch *batch, const double *qddot,
                                                double *effort);

#ifdef __cplusplus
}
#endif
#endif
