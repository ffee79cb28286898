/* SPDX-License-Identifier: BSD-3-Clause */
/* Servo walls: shapes that move along an axis of their body so that particles press them with a
 * given force or stress. Equations: docs/theory/servos.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_SERVO_H
#define SE3D_SERVO_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Servo walls of a set at most. @since 0.1 */
#define SE3D_PARTICLES_SERVOS 32

/* A servo wall: its speed is gain times what is missing of the load, at most speed_max. The set
 * alone sees where it is: other bodies and pictures see the shape where its body has it. @since 0.1
 */
typedef struct se3d_servo_def {
    size_t struct_size;
    se3d_shape shape;       /* that the set touches; one servo a shape */
    double axis[3];         /* along which it presses, frame of its body; a direction */
    double load;            /* wanted: force on the particles along axis [N], or stress [Pa] */
    se3d_function function; /* of time, in place of `load`; null: none */
    double area;            /* the load is a stress on this area [m^2]; 0: a force */
    double speed_max;       /* [m/s] > 0 */
    double gain;  /* speed over missing force [m/(N s)] >= 0; 0: by the stiffness and the damping
                   * of all contacts that there may be */
    double start; /* at rest before [s] */
} se3d_servo_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_servo_def_default. @since 0.1 */
SE3D_API void se3d_servo_def_init(se3d_servo_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_servo_def se3d_servo_def_default(void)
{
    se3d_servo_def def;
    se3d_servo_def_init(&def, sizeof def);
    return def;
}

/* Make a shape a servo wall. It stays where it is when the shape is destroyed, and while the set is
 * empty. A law of contact of the user's own has no stiffness: it needs a gain.
 * @param[out] servo  its number, from 0; NULL: not wanted
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_servo(se3d_particles *particles, const se3d_servo_def *def,
                                              uint32_t *servo);

/* A servo wall as it is now. @since 0.1 */
typedef struct se3d_servo_state {
    double position; /* along axis, from where its body has the shape [m] */
    double speed;    /* of the last step [m/s] */
    double force;    /* on the particles along axis, in the last step [N] */
    double wanted;   /* of it [N] */
    double work;     /* of that force by the motion along axis [J] */
} se3d_servo_state;

/* As se3d_particles_get_servo, told the size of *state in bytes. @return as
 * se3d_particles_get_servo, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_servo_sized(const se3d_particles *particles, uint32_t servo,
                                                    se3d_servo_state *state, size_t size);

/* Get the state of a servo wall.
 * @param[in] servo  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such servo).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_servo(const se3d_particles *particles, uint32_t servo,
                                                   se3d_servo_state *state)
{
    return se3d_particles_get_servo_sized(particles, servo, state, sizeof *state);
}

#ifdef __cplusplus
}
#endif
#endif
