/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact: the law between materials (se3d/material.h) and what shapes (se3d/shape.h) do by it.
 *
 * Every shape with a material touches particles (se3d/particles.h) and the shapes of other bodies.
 * One law holds for all contacts of a system: a penalty force along the normal, and friction by a
 * spring with history, capped by Coulomb. */
#ifndef SE3D_CONTACT_H
#define SE3D_CONTACT_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Force laws. Fn never pulls but by cohesion; Ft is a spring with history and a damper, capped at
 * friction * Fn.
 * @since 0.1 */
typedef enum se3d_contact_law {
    SE3D_CONTACT_LAW_HOOKE = 0,         /* linear: stiffness, tangential_ratio */
    SE3D_CONTACT_LAW_HERTZ_MINDLIN = 1, /* Hertz with Tsuji-type damping, Mindlin: young, poisson */
    SE3D_CONTACT_LAW_CALLBACK = 2       /* the user's, of which materials need nothing */
} se3d_contact_law;

/* A contact as a law of the user's sees it: of two particles, of a particle and a shape, of two
 * shapes. Forces and velocities are of the second of the two relative to the first, ground frame.
 * @since 0.1 */
typedef struct se3d_contact_input {
    se3d_material material_1, material_2;
    double step;      /* by which the spring has been stretched since the last call [s]; 0: none */
    double overlap;   /* [m] > 0 */
    double normal[3]; /* from the first to the second */
    double velocity;  /* along the normal [m/s], < 0: approaching */
    double slip[3];   /* velocity in the tangent plane at the point [m/s] */
    double spin[3];   /* angular velocity, ground frame [rad/s] */
    double radius;    /* reduced: 1/R* = 1/R1 + 1/R2 [m]; of a flat face: R = infinite */
    double mass;      /* effective along the normal [kg] */
    double spring[3]; /* slip summed up since the contact began, in the tangent plane [m] */
    double friction;  /* of the two materials */
    double onset;     /* in the step in which they meet: from 0 to 1 for bodies, 0.5 to 1.5 for
                         particles. Damping times this acts for the part of the step in which they
                         touch, and is continuous, as implicit methods need it; else 1 */
    double lag; /* velocity and slip are of so long ago [s]: particles, half a step; bodies, 0.
                   A damping c then acts as c + lag c^2/(2 mass) does */
} se3d_contact_input;

/* What a law gives; all zero, and the spring as in the input, when it is called. @since 0.1 */
typedef struct se3d_contact_output {
    double force;         /* along the normal on the second [N] */
    double tangential[3]; /* in the tangent plane on the second [N] */
    double moment[3];     /* on the second, about the point of contact [N m] */
    double spring[3];     /* what is remembered of it [m] */
} se3d_contact_output;

/* Compute the force of a contact. It must be a pure function of its input (call
 * se3d_system_touch where it has to change between steps), may be called from several threads at a
 * time, and also by queries and for derivatives (of implicit methods, by differences).
 * Return OK, or a negative status: the step ends, and CALLBACK names the two. */
typedef se3d_status (*se3d_contact_callback)(void *ctx, const se3d_contact_input *input,
                                             se3d_contact_output *output);

/* What holds for all contacts of a system. @since 0.1 */
typedef struct se3d_contact_settings {
    size_t struct_size;
    int32_t law; /* se3d_contact_law */
    int32_t reserved;
    double step;          /* of verlet and of particles [s]; 0: automatic, from the stiffness */
    double overlap_limit; /* allowed overlap over the smaller radius; default 0.2 */
    se3d_contact_callback callback; /* SE3D_CONTACT_LAW_CALLBACK, which needs a step > 0 */
    void *ctx;
} se3d_contact_settings;

SE3D_API void se3d_contact_settings_init(se3d_contact_settings *settings, size_t size);

static inline se3d_contact_settings se3d_contact_settings_default(void)
{
    se3d_contact_settings settings;
    se3d_contact_settings_init(&settings, sizeof settings);
    return settings;
}

/* Set them. Every material must have what the law needs. @return OK, NULL, INVALID_ARGUMENT.
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_system_set_contact(se3d_system *system,
                                             const se3d_contact_settings *settings);
/* Get them; struct_size must be set. @return OK, NULL, INVALID_ARGUMENT. Reader. @since 0.1 */
SE3D_API se3d_status se3d_system_get_contact(const se3d_system *system,
                                             se3d_contact_settings *settings);

/* Get the force of all contacts on a shape [N] and its moment about the centre of mass of the
 * shape's body [N m], ground frame, of the last step. Reader. @since 0.1 */
SE3D_API se3d_status se3d_shape_get_wrench(const se3d_system *system, se3d_shape shape,
                                           double force[3], double torque[3]);
/* The same, summed over all shapes of a body. Reader. @since 0.1 */
SE3D_API se3d_status se3d_body_get_contact_wrench(const se3d_system *system, se3d_body body,
                                                  double force[3], double torque[3]);
/* A point where shapes of two bodies touch. @since 0.1 */
typedef struct se3d_contact {
    se3d_shape shape_i, shape_j;
    double point[3];  /* ground frame [m] */
    double normal[3]; /* from i to j, ground frame */
    double overlap;   /* [m] > 0 */
    double force[3];  /* on j at the point, ground frame [N] */
} se3d_contact;

/* Count the points of contact between bodies at the last accepted state, and list them (`count`
 * must be that number). Those of particles: se3d_particles_get_contacts.
 * @return OK, NULL, INVALID_ARGUMENT. Reader. @since 0.1 */
SE3D_API size_t se3d_system_count_contacts(const se3d_system *system);
SE3D_API se3d_status se3d_system_get_contacts_sized(const se3d_system *system, size_t count,
                                                    se3d_contact *contacts, size_t size);
static inline se3d_status se3d_system_get_contacts(const se3d_system *system, size_t count,
                                                   se3d_contact *contacts)
{
    return se3d_system_get_contacts_sized(system, count, contacts, sizeof *contacts);
}
/* Count the pairs of meshes that pass through each other: materials, groups and joints would let
 * them touch, but neither is convex. The first pair to *i and *j (NULL: not wanted; null handles
 * where there is none). @return the count; 0 where system is NULL. Reader. @since 0.1 */
SE3D_API size_t se3d_system_count_passing_meshes(const se3d_system *system, se3d_shape *i,
                                                 se3d_shape *j);
/* Get the largest force at one point of contact, of bodies and of particles [N]. Reader.
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_contact_force_max(const se3d_system *system, double *force);

#ifdef __cplusplus
}
#endif
#endif
