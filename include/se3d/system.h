/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems: creation, gravity, time, energy, errors, copies. */
#ifndef SE3D_SYSTEM_H
#define SE3D_SYSTEM_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a system is made with. @since 0.1 */
typedef struct se3d_system_def {
    size_t struct_size;
    const se3d_allocator *allocator; /* copied; NULL: malloc */
    se3d_log_callback log;           /* NULL: silent */
    void *log_ctx;
    double gravity[3]; /* ground frame [m/s^2], default (0, 0, -9.81) */
    double time;       /* [s], default 0 */
} se3d_system_def;

/* Fill `def` (of `size` bytes) with the defaults. Safe. @since 0.1 */
SE3D_API void se3d_system_def_init(se3d_system_def *def, size_t size);

static inline se3d_system_def se3d_system_def_default(void)
{
    se3d_system_def def;
    se3d_system_def_init(&def, sizeof def);
    return def;
}

/* Create an empty system (the ground only). `def` may be NULL.
 * @return OK, NULL (out), INVALID_ARGUMENT, NO_MEMORY. Safe. @since 0.1 */
SE3D_API se3d_status se3d_system_create(const se3d_system_def *def, se3d_system **out);

/* Destroy a system and its elements; NULL is fine. Solvers and clones of its particle sets that
 * still live are empty then: their calls return STATE, and destroying them is fine as long as the
 * allocator lives. From within a callback of the system nothing is destroyed, and a message (STATE)
 * says so. @since 0.1 */
SE3D_API void se3d_system_destroy(se3d_system *system);

/* Make an independent copy with the same allocator; handles are valid on both.
 * @return OK, NULL, NO_MEMORY, STATE (from within a callback that sees a trial state). Reader.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_clone(const se3d_system *system, se3d_system **out);

/* Return the message of the last failing call on this system, "" if none; never NULL. The text is
 * valid until the next call. Reader. @since 0.1 */
SE3D_API const char *se3d_system_get_error(const se3d_system *system);

/* Return the status of the last failing call on this system. Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_error_status(const se3d_system *system);

/* Return 1 while a call works on the system (a run, an analysis, a query that evaluates callbacks),
 * that is: from within callbacks; else 0, also for NULL. Which calls are then refused with STATE:
 * docs/api.md, "Callbacks". Reader. @since 0.1 */
SE3D_API int32_t se3d_system_is_busy(const se3d_system *system);

/* Say that what callbacks compute has changed since the last step: they must be pure functions of
 * their arguments, and methods keep what they gave. The next step begins with what they give now;
 * what elements remember stays. Setters of values do this by themselves. @return OK, NULL.
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_system_touch(se3d_system *system);

/* Set the gravitational acceleration [m/s^2], ground frame. The next step begins with it.
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_system_set_gravity(se3d_system *system, const double gravity[3]);
SE3D_API se3d_status se3d_system_get_gravity(const se3d_system *system, double gravity[3]);

/* Make components of the gravitational acceleration functions of time; a null function keeps the
 * component of se3d_system_set_gravity. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_system_set_gravity_function(se3d_system *system,
                                                      const se3d_function gravity[3]);

/* Set the time [s] at which functions of time are evaluated, also of the system's particle sets.
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_system_set_time(se3d_system *system, double time);
SE3D_API se3d_status se3d_system_get_time(const se3d_system *system, double *time);

/* Get the handle of the ground, the immovable body 0 named "ground". Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_ground(const se3d_system *system, se3d_body *ground);

/* Count the elements of a system; bodies include the ground. Zero for NULL. Reader. @since 0.1 */
SE3D_API size_t se3d_system_count_bodies(const se3d_system *system);
SE3D_API size_t se3d_system_count_markers(const se3d_system *system);
SE3D_API size_t se3d_system_count_constraints(const se3d_system *system);
SE3D_API size_t se3d_system_count_forces(const se3d_system *system);

/* Get the element at `index` (creation order, < count). Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_body(const se3d_system *system, size_t index, se3d_body *body);
SE3D_API se3d_status se3d_system_get_marker(const se3d_system *system, size_t index,
                                            se3d_marker *marker);
SE3D_API se3d_status se3d_system_get_constraint(const se3d_system *system, size_t index,
                                                se3d_constraint *constraint);
SE3D_API se3d_status se3d_system_get_force(const se3d_system *system, size_t index,
                                           se3d_force *force);

/* Energies [J]; potential includes gravity (zero at the ground origin) and springs; dissipated is
 * the integral since the start of the run. @since 0.1 */
typedef struct se3d_energy {
    double kinetic;
    double potential;
    double total;
    double dissipated;
} se3d_energy;

SE3D_API se3d_status se3d_system_get_energy_sized(const se3d_system *system, se3d_energy *energy,
                                                  size_t size);
static inline se3d_status se3d_system_get_energy(const se3d_system *system, se3d_energy *energy)
{
    return se3d_system_get_energy_sized(system, energy, sizeof *energy);
}

/* Work since the start of the run [J]: kinetic + potential + dissipated - actuators - drivers is
 * constant to the integrator's order. Gravity that changes in time counts as an actuator. Inverse
 * dynamics integrates powers by Gauss-Lobatto's rule of order 6 over its steps; kinematics computes
 * no works. Where a callback fails while a value is set they begin anew at zero. @since 0.1 */
typedef struct se3d_work {
    double dissipated;
    double actuators; /* h of springs, loads, callbacks; particles on bodies */
    double drivers;
} se3d_work;

/* @return OK, NULL, STATE (the last analysis was kinematics). Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_work_sized(const se3d_system *system, se3d_work *work,
                                                size_t size);
static inline se3d_status se3d_system_get_work(const se3d_system *system, se3d_work *work)
{
    return se3d_system_get_work_sized(system, work, sizeof *work);
}

/* Get the largest violation over all equations: [0] |Phi|, [1] |Phi_q qdot - nu|,
 * [2] |Phi_q qddot - gamma|, at the present state. Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_violation(const se3d_system *system, double violation[3]);

/* A hash of the state (time, positions, velocities, accelerations, multipliers): equal bits, equal
 * hash. Zero for NULL. Reader. @since 0.1 */
SE3D_API uint64_t se3d_system_hash(const se3d_system *system);

/* @return as se3d_system_clone. Reader. @since 0.1 */
SE3D_API se3d_status se3d_snapshot_create(const se3d_system *system, se3d_snapshot **out);
/* Put the state back. @return OK, NULL, STATE (the model has changed since). Exclusive. @since 0.1
 */
SE3D_API se3d_status se3d_snapshot_restore(const se3d_snapshot *snapshot, se3d_system *system);
/* Destroy; NULL is fine. @since 0.1 */
SE3D_API void se3d_snapshot_destroy(se3d_snapshot *snapshot);

#ifdef __cplusplus
}
#endif
#endif
