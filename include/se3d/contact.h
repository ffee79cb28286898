/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact: the law between materials (se3d/material.h) and what shapes (se3d/shape.h) do by it.
 *
 * Every shape with a material touches particles (se3d/particles.h) and the shapes of other bodies.
 * One law holds for all contacts of a system, or for some pairs of materials another one
 * (se3d_material_set_pair): a penalty force along the normal, and friction by a spring with
 * history, capped by Coulomb.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_CONTACT_H
#define SE3D_CONTACT_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Laws of contact. Fn never pulls but by cohesion; Ft is a spring with history and a damper, capped
 * at friction * Fn. @since 0.1 */
typedef enum se3d_contact_law {
    SE3D_CONTACT_LAW_HOOKE = 0,         /* linear: stiffness, tangential_ratio */
    SE3D_CONTACT_LAW_HERTZ_MINDLIN = 1, /* Hertz with Tsuji-type damping, Mindlin: young, poisson */
    SE3D_CONTACT_LAW_CALLBACK = 2       /* user-defined; materials need nothing for it */
} se3d_contact_law;

/* A contact as a user-defined law sees it: of two particles, of a particle and a shape, of two
 * shapes. Forces and velocities are of the second of the two relative to the first, ground frame.
 * @since 0.1 */
typedef struct se3d_contact_input {
    se3d_material material_1, material_2; /* of the first and the second */
    double step;      /* by which the spring has been stretched since the last call [s]; 0: none */
    double overlap;   /* [m] > 0 */
    double normal[3]; /* unit vector from the first to the second, ground frame */
    double velocity;  /* along the normal [m/s], < 0: approaching */
    double slip[3];   /* velocity in the tangent plane at the point [m/s] */
    double spin[3];   /* angular velocity, ground frame [rad/s] */
    double radius;    /* reduced: 1/R* = 1/R1 + 1/R2 [m]; of a flat face: R = infinite */
    double mass;      /* effective along the normal [kg] */
    double spring[3]; /* slip summed up since the contact began, in the tangent plane [m] */
    double friction;  /* of the two materials [1] */
    double onset;     /* in the step in which they meet: 0 .. 1 for bodies, 0.5 .. 1.5 for
                         particles. Damping times this acts for the part of the step in which they
                         touch, and is continuous, as implicit methods need it; else 1 */
    double lag; /* velocity and slip are of so long ago [s]: particles, half a step; bodies, 0.
                   A damping c then acts as c + lag c^2/(2 mass) does */
} se3d_contact_input;

/* The result of a law of contact; all zero, and the spring as in the input, when it is called.
 * @since 0.1 */
typedef struct se3d_contact_output {
    double force;         /* along the normal on the second [N] */
    double tangential[3]; /* in the tangent plane on the second [N] */
    double moment[3];     /* on the second, about the point of contact [N m] */
    double spring[3];     /* what is remembered of it [m] */
} se3d_contact_output;

/* Compute the force of a contact. It must be a pure function of its input (call
 * se3d_system_touch if it has to change between steps), may be called from several threads at a
 * time, and also by queries and for derivatives (of implicit methods, by differences).
 * @return OK, or a negative status: the analysis ends with CALLBACK, whose message names the two.
 * @since 0.1 */
typedef se3d_status (*se3d_contact_callback)(void *ctx, const se3d_contact_input *input,
                                             se3d_contact_output *output);

/* The settings of all contacts of a system. @since 0.1 */
typedef struct se3d_contact_settings {
    size_t struct_size;
    int32_t law; /* se3d_contact_law */
    int32_t reserved;
    double step;          /* of verlet and of particles [s]; 0: automatic, from the stiffness */
    double overlap_limit; /* allowed overlap over the smaller radius; default 0.2 */
    se3d_contact_callback callback; /* SE3D_CONTACT_LAW_CALLBACK, which needs a step > 0 */
    void *ctx;                      /* of `callback` */
} se3d_contact_settings;

/* Fill `settings`, of `size` bytes, with the defaults: see
 * se3d_contact_settings_default. @since 0.1 */
SE3D_API void se3d_contact_settings_init(se3d_contact_settings *settings, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_contact_settings se3d_contact_settings_default(void)
{
    se3d_contact_settings settings;
    se3d_contact_settings_init(&settings, sizeof settings);
    return settings;
}

/* Set the law of contact of a system. Every material must have what the law needs. @return OK,
 * NULL, INVALID_ARGUMENT. @since 0.1 */
SE3D_API se3d_status se3d_system_set_contact(se3d_system *system,
                                             const se3d_contact_settings *settings);

/* Get the law of contact of a system. Set settings->struct_size before the call. @return OK,
 * NULL, INVALID_ARGUMENT (struct_size). @since 0.1 */
SE3D_API se3d_status se3d_system_get_contact(const se3d_system *system,
                                             se3d_contact_settings *settings);

/* Get what all contacts of the last step did to a shape.
 * @param[out] force   ground frame [N]
 * @param[out] torque  about the centre of mass of the body of the shape, ground frame [N m]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_wrench(const se3d_system *system, se3d_shape shape,
                                           double force[3], double torque[3]);

/* Get what all contacts of the last step did to a body: the sum over its shapes.
 * @param[out] force   ground frame [N]
 * @param[out] torque  about the centre of mass, ground frame [N m]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_contact_wrench(const se3d_system *system, se3d_body body,
                                                  double force[3], double torque[3]);
/* A point where shapes of two bodies touch. @since 0.1 */
typedef struct se3d_contact {
    se3d_shape shape_i, shape_j; /* that touch */
    double point[3];             /* ground frame [m] */
    double normal[3];            /* unit vector from i to j, ground frame */
    double overlap;              /* [m] > 0 */
    double force[3];             /* on j at the point, ground frame [N] */
} se3d_contact;

/* Count the points where shapes of two bodies touch, at the last accepted state. Those of
 * particles: se3d_particles_count_contacts. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_contacts(const se3d_system *system);

/* As se3d_system_get_contacts, told the size of an element in bytes. @return as
 * se3d_system_get_contacts, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_system_get_contacts_sized(const se3d_system *system, size_t count,
                                                    se3d_contact *contacts, size_t size);

/* List the points of contact between bodies at the last accepted state.
 * @param[in] count      must be se3d_system_count_contacts
 * @param[out] contacts  [count]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
static inline se3d_status se3d_system_get_contacts(const se3d_system *system, size_t count,
                                                   se3d_contact *contacts)
{
    return se3d_system_get_contacts_sized(system, count, contacts, sizeof *contacts);
}

/* Count the pairs of meshes that pass through each other: materials, groups and joints would let
 * them touch, but neither is closed (se3d_shape_create_mesh).
 * @param[out] i  a shape of the first pair, null if there is none; NULL: not wanted
 * @param[out] j  the other one; NULL: not wanted
 * @return the number; 0 for NULL.
 * @since 0.1 */
SE3D_API size_t se3d_system_count_passing_meshes(const se3d_system *system, se3d_shape *i,
                                                 se3d_shape *j);

/* Get the largest force at one point of contact, of bodies and of particles.
 * @param[out] force  its magnitude [N]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_contact_force_max(const se3d_system *system, double *force);

#ifdef __cplusplus
}
#endif
#endif
