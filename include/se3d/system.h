/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems: creation, gravity, time, energy, errors, copies.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_SYSTEM_H
#define SE3D_SYSTEM_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a system. @since 0.1 */
typedef struct se3d_system_def {
    size_t struct_size;
    const se3d_allocator *allocator; /* copied; NULL: malloc */
    se3d_log_callback log;           /* NULL: silent */
    void *log_ctx;                   /* of `log` */
    double gravity[3];               /* ground frame [m/s^2], default (0, 0, -9.81) */
    double time;                     /* [s], default 0 */
} se3d_system_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_system_def_default. @since 0.1 */
SE3D_API void se3d_system_def_init(se3d_system_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_system_def se3d_system_def_default(void)
{
    se3d_system_def def;
    se3d_system_def_init(&def, sizeof def);
    return def;
}

/* Create an empty system, which holds the ground only. `def` may be NULL. @return OK, NULL
 * (out), INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_system_create(const se3d_system_def *def, se3d_system **out);

/* Destroy a system and its elements; NULL is fine. Solvers and clones of its particle sets that
 * still live are empty then: their calls return STATE, and they may be destroyed as long as the
 * allocator lives. Within a callback of the system, or if its owner keeps it, nothing is
 * destroyed, and a message (STATE) says so. @since 0.1 */
SE3D_API void se3d_system_destroy(se3d_system *system);

/* Keep a system that is handed out: se3d_system_destroy, and se3d_particles_destroy of the sets
 * that it has by now, destroy nothing and leave a message (STATE) until it is kept no longer. So
 * models keep theirs. A clone is not kept.
 * @param[in] kept  not 0: from now on; 0: no longer, before it is destroyed
 * @return OK, NULL, STATE (within a callback). @since 0.1 */
SE3D_API se3d_status se3d_system_set_kept(se3d_system *system, int32_t kept);

/* Let elements be defined again: as long as this is on, bodies, markers, constraints, force
 * elements (not states), wheels and roads that are created with the name of one of their kind take
 * its place, with its handle, and all else stays. A body also takes the state of its definition;
 * what was made of its pose (joints, drivers, forces, markers, wheels and roads on it) does not
 * follow, and is defined again after it. Then the system is to the bit one that was built so from
 * the start, if it has not moved yet. What has another structure (a joint of another type, other
 * rows) fails with INVALID_ARGUMENT, and what was there stays as it was; so does, with IN_USE, a
 * joint on other bodies with drivers, couplers, force elements or signals on it: these go first.
 * Drivers and couplers of a joint that is defined again at another place are defined again after
 * it; until then this mode does not end, and no analysis runs (STATE, with the name). A clone does
 * not replace.
 * @param[in] on  not 0: from now on; 0: no longer
 * @return OK, NULL, STATE (within a callback; or a driver or coupler is still made of what its
 *         joint was before, and `on` is 0). @since 0.1 */
SE3D_API se3d_status se3d_system_set_replacing(se3d_system *system, int32_t on);

/* Make an independent copy with the same allocator; handles are valid on both. @return OK, NULL,
 * NO_MEMORY, STATE (within a callback that sees a trial state). @since 0.1 */
SE3D_API se3d_status se3d_system_clone(const se3d_system *system, se3d_system **out);

/* Let another log be told from now on, in place of that of se3d_system_def; a clone begins with the
 * log of its system, which has to live as long.
 * @param[in] log  NULL: silent
 * @param[in] ctx  of `log`
 * @return OK, NULL (system), STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_set_log(se3d_system *system, se3d_log_callback log, void *ctx);

/* Get the message of the last call on this system that failed. @return the text, "" if none
 * failed; valid until the next call. @since 0.1 */
SE3D_API const char *se3d_system_get_error(const se3d_system *system);

/* Get the status of the last call on this system that failed. @return the status; OK if none
 * failed, NULL for NULL. @since 0.1 */
SE3D_API se3d_status se3d_system_get_error_status(const se3d_system *system);

/* Get what the last call on this system that failed was about: the name of an argument or of a
 * member of a definition ("mass", "position"), with which its message begins. @return the name, ""
 * if it was about none, none failed or `system` is NULL; valid until the next call. @since 0.1 */
SE3D_API const char *se3d_system_get_error_field(const se3d_system *system);

/* Tell whether a call works on the system (a run, an analysis, a query that evaluates
 * callbacks): this is so within callbacks. Which calls are then refused with STATE: docs/api.md,
 * "Callbacks". @return 1 if so, else 0, also for NULL. @since 0.1 */
SE3D_API int32_t se3d_system_is_busy(const se3d_system *system);

/* Say that what callbacks compute has changed since the last step: they must be pure functions
 * of their arguments, and methods keep what they gave. The next step begins with what they give
 * now; what elements remember stays. Setters of values do this by themselves. @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_touch(se3d_system *system);

/* Set the gravitational acceleration. The next step begins with it.
 * @param[in] gravity  ground frame [m/s^2]
 * @return OK, NULL, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_set_gravity(se3d_system *system, const double gravity[3]);

/* Get the gravitational acceleration that was set; functions of gravity do not count.
 * @param[out] gravity  ground frame [m/s^2]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_gravity(const se3d_system *system, double gravity[3]);

/* Make components of the gravitational acceleration functions of time.
 * @param[in] gravity  of x, y, z, ground frame [m/s^2]; null: the component stays that of
 *                     se3d_system_set_gravity
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not of one variable).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_set_gravity_function(se3d_system *system,
                                                      const se3d_function gravity[3]);

/* Get the functions of the components of gravity.
 * @param[out] gravity  of x, y, z; null: a constant, that of se3d_system_get_gravity
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_gravity_function(const se3d_system *system,
                                                      se3d_function gravity[3]);

/* Set the time at which functions of time are evaluated, also that of the system's particle sets.
 * @param[in] time  [s]
 * @return OK, NULL, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_set_time(se3d_system *system, double time);

/* Get the time of a system.
 * @param[out] time  [s]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_time(const se3d_system *system, double *time);

/* Get the ground, the immovable body 0 named "ground". @return OK, NULL. @since 0.1 */
SE3D_API se3d_status se3d_system_get_ground(const se3d_system *system, se3d_body *ground);

/* Count the bodies of a system, the ground included. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_bodies(const se3d_system *system);

/* Count the markers of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_markers(const se3d_system *system);

/* Count the constraints of a system: primitives, joints, couplers, drivers and user-defined
 * ones. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_constraints(const se3d_system *system);

/* Count the force elements of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_forces(const se3d_system *system);

/* Get a body of a system, in the order of creation.
 * @param[in] index  from 0, the ground; below se3d_system_count_bodies
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_body(const se3d_system *system, size_t index, se3d_body *body);

/* Get a marker of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_markers
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_marker(const se3d_system *system, size_t index,
                                            se3d_marker *marker);

/* Get a constraint of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_constraints
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_constraint(const se3d_system *system, size_t index,
                                                se3d_constraint *constraint);

/* Get a force element of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_forces
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_force(const se3d_system *system, size_t index,
                                           se3d_force *force);

/* Energies [J]; potential includes gravity (zero at the ground origin) and springs; dissipated is
 * the integral since the start of the run. @since 0.1 */
typedef struct se3d_energy {
    double kinetic;    /* of translation and rotation */
    double potential;  /* of gravity, springs and contacts */
    double total;      /* kinetic + potential */
    double dissipated; /* since the start of the run */
} se3d_energy;

/* As se3d_system_get_energy, told the size of *energy in bytes. @return as
 * se3d_system_get_energy, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_system_get_energy_sized(const se3d_system *system, se3d_energy *energy,
                                                  size_t size);

/* Get the energies of a system at its present state. @return OK, NULL, CALLBACK, NOT_FINITE.
 * @since 0.1 */
static inline se3d_status se3d_system_get_energy(const se3d_system *system, se3d_energy *energy)
{
    return se3d_system_get_energy_sized(system, energy, sizeof *energy);
}

/* Work since the start of the run [J]: kinetic + potential + dissipated - actuators - drivers is
 * constant to the integrator's order. Gravity that changes in time counts as an actuator. Inverse
 * dynamics integrates powers by Gauss-Lobatto's rule of order 6 over its steps; kinematics computes
 * no works. If a callback fails while a value is set they begin anew at zero. @since 0.1 */
typedef struct se3d_work {
    double dissipated; /* by dampers, friction and contacts */
    double actuators;  /* h of springs, loads, callbacks; particles on bodies [J] */
    double drivers;    /* by constraints with a function */
} se3d_work;

/* As se3d_system_get_work, told the size of *work in bytes. @return as se3d_system_get_work, and
 * INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_system_get_work_sized(const se3d_system *system, se3d_work *work,
                                                size_t size);

/* Get the works done in a system since the start of the run. @return OK, NULL, STATE (the last
 * analysis was kinematics), CALLBACK, NOT_FINITE (of the energy of a callback). @since 0.1 */
static inline se3d_status se3d_system_get_work(const se3d_system *system, se3d_work *work)
{
    return se3d_system_get_work_sized(system, work, sizeof *work);
}

/* Get the largest violation over all equations at the present state, in the units of the equations.
 * @param[out] violation  [0] |Phi| [m, m^2, 1, rad], [1] |Phi_q qdot - nu|, [2] |Phi_q qddot -
 *                        gamma|; in no frame
 * @return OK, NULL, STATE, CALLBACK, NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_violation(const se3d_system *system, double violation[3]);

/* Compute a hash of the state (time, positions, velocities, accelerations and multipliers if they
 * are shown, particles): equal bits, equal hash. @return the hash; 0 for NULL. @since 0.1 */
SE3D_API uint64_t se3d_system_hash(const se3d_system *system);

/* Save the state of a system. @return OK, NULL, NO_MEMORY, STATE (within a callback that sees a
 * trial state). @since 0.1 */
SE3D_API se3d_status se3d_snapshot_create(const se3d_system *system, se3d_snapshot **out);

/* Put a saved state back. @return OK, NULL, STATE (the model has changed since), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_snapshot_restore(const se3d_snapshot *snapshot, se3d_system *system);

/* Write a saved state as bytes, which are the same on every machine. They hold the state, particles
 * and their contacts included, not the elements, nor their values.
 * @param[out] bytes    [*size]; NULL: only *size is told
 * @param[in] capacity  of `bytes`
 * @param[out] size     how many bytes it takes
 * @return OK, NULL, INVALID_ARGUMENT (capacity).
 * @since 0.1 */
SE3D_API se3d_status se3d_snapshot_write(const se3d_snapshot *snapshot, void *bytes,
                                         size_t capacity, size_t *size);

/* Read what se3d_snapshot_write wrote, in this program or another, for a system with the same
 * elements, made in the same order. After se3d_snapshot_restore it continues with the same bits if
 * the values of its elements are the same, too, and the library is of the same version; sets of
 * particles may have another number of threads, and get the particles that were there then,
 * whatever they hold. Bytes that are damaged or malformed are refused.
 * @param[in] bytes  [size]
 * @param[in] size   of `bytes`
 * @return OK, NULL, INVALID_ARGUMENT (no such bytes), STATE (of another model), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_snapshot_read(se3d_system *system, const void *bytes, size_t size,
                                        se3d_snapshot **out);

/* Destroy a saved state; NULL is fine. @since 0.1 */
SE3D_API void se3d_snapshot_destroy(se3d_snapshot *snapshot);

#ifdef __cplusplus
}
#endif
#endif
