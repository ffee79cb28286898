/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact: materials, the law between them, and shapes on bodies.
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

/* What a material is made with. The restitution given is the one obtained, at any velocity; pairs
 * of materials mix: geometric means of friction and restitution, springs in series. @since 0.1 */
typedef struct se3d_material_def {
    size_t struct_size;
    double density;            /* [kg/m^3] > 0, required */
    double friction;           /* >= 0, default 0.5 */
    double restitution;        /* 0.01 .. 1, default 0.5 */
    double rolling_friction;   /* >= 0: resisting moment over R* Fn */
    double torsional_friction; /* >= 0: the same about the normal */
    double stiffness;          /* [N/m] > 0, required for hooke: of two spheres of this material */
    double tangential_ratio;   /* kt/kn >= 0, default 2/7 */
    double young;              /* [Pa] > 0, required for hertz_mindlin */
    double poisson;            /* 0 .. 0.5, default 0.3 */
    double cohesion;           /* >= 0 [J/m^3]: attraction per area of contact, 2 pi R* overlap */
    double adhesion; /* >= 0 [J/m^2]: work of adhesion; pull-off force 3/2 pi R* adhesion */
} se3d_material_def;

SE3D_API void se3d_material_def_init(se3d_material_def *def, size_t size);

static inline se3d_material_def se3d_material_def_default(void)
{
    se3d_material_def def;
    se3d_material_def_init(&def, sizeof def);
    return def;
}

/* Create a material; what the system's law needs must be given. @return OK, NULL, INVALID_ARGUMENT,
 * NO_MEMORY. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_material_create(se3d_system *system, const se3d_material_def *def,
                                          se3d_material *material);
/* Give a material other values, between steps: the handle stays, contacts keep what they remember,
 * and the next step begins with the new values. Particles keep the mass that they were made with.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_material_set(se3d_system *system, se3d_material material,
                                       const se3d_material_def *def);
/* Get its values; struct_size must be set. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * Reader. @since 0.1 */
SE3D_API se3d_status se3d_material_get(const se3d_system *system, se3d_material material,
                                       se3d_material_def *def);
/* Destroy. @return OK, NULL, STALE_HANDLE, IN_USE (a shape or a set of particles uses it).
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_material_destroy(se3d_system *system, se3d_material material);

/* What holds for a pair of materials instead of the mixing rules; negative: the rule, the default.
 * @since 0.1 */
typedef struct se3d_material_pair_def {
    size_t struct_size;
    double friction, restitution, rolling_friction, torsional_friction;
    double stiffness; /* hooke [N/m] */
    double cohesion, adhesion;
} se3d_material_pair_def;

SE3D_API void se3d_material_pair_def_init(se3d_material_pair_def *def, size_t size);

static inline se3d_material_pair_def se3d_material_pair_def_default(void)
{
    se3d_material_pair_def def;
    se3d_material_pair_def_init(&def, sizeof def);
    return def;
}

/* Say what holds between two materials (which may be the same). @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_material_set_pair(se3d_system *system, se3d_material a, se3d_material b,
                                            const se3d_material_pair_def *def);

/* What a shape is made with; every kind takes its own of the last fields. Its frame is at its
 * centre.
 * @since 0.1 */
typedef struct se3d_shape_def {
    size_t struct_size;
    const char *name;       /* copied; NULL or unique among the shapes */
    se3d_body body;         /* null: the ground */
    se3d_material material; /* null: nothing touches it */
    double position[3];     /* body frame [m] */
    double orientation[4];  /* shape -> body, Euler parameters; default (1,0,0,0) */
    double normal[3];       /* plane: instead of an orientation, body frame; zero: the shape's z */
    double size[3];         /* box: full lengths [m] > 0 */
    double radius;          /* sphere, capsule, cylinder [m] > 0 */
    double length;          /* along the shape's z: capsule, between the centres of its caps (>= 0);
                               cylinder (> 0) [m] */
    uint32_t group, mask;   /* a and b touch if a.group & b.mask and b.group & a.mask; default 1 and
                               all ones */
    const double *vertices; /* mesh, hull: [3 * vertex_count], shape frame [m], copied */
    size_t vertex_count;
    const uint32_t *triangles; /* mesh: [3 * triangle_count] indices of vertices, copied */
    size_t triangle_count;
} se3d_shape_def;

SE3D_API void se3d_shape_def_init(se3d_shape_def *def, size_t size);

static inline se3d_shape_def se3d_shape_def_default(void)
{
    se3d_shape_def def;
    se3d_shape_def_init(&def, sizeof def);
    return def;
}

/* Create a shape; it moves with its body. A plane is infinite, and solid behind its normal.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_sphere(se3d_system *system, const se3d_shape_def *def,
                                              se3d_shape *shape);
SE3D_API se3d_status se3d_shape_create_box(se3d_system *system, const se3d_shape_def *def,
                                           se3d_shape *shape);
SE3D_API se3d_status se3d_shape_create_capsule(se3d_system *system, const se3d_shape_def *def,
                                               se3d_shape *shape);
SE3D_API se3d_status se3d_shape_create_cylinder(se3d_system *system, const se3d_shape_def *def,
                                                se3d_shape *shape);
SE3D_API se3d_status se3d_shape_create_plane(se3d_system *system, const se3d_shape_def *def,
                                             se3d_shape *shape);
/* The convex hull of at least four points that are not in one plane. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_hull(se3d_system *system, const se3d_shape_def *def,
                                            se3d_shape *shape);

/* A surface of triangles: everything touches it but other meshes where neither of the two is convex
 * (se3d_system_count_passing_meshes). Where it is closed it has an outside, else two sides; convex
 * is what is closed, the hull of its vertices, and of at most 1000 triangles. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_mesh(se3d_system *system, const se3d_shape_def *def,
                                            se3d_shape *shape);

/* Destroy. @return OK, NULL, STALE_HANDLE. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_shape_destroy(se3d_system *system, se3d_shape shape);
/* Find by name. @return OK, NULL, NOT_FOUND (*shape is null). Reader. @since 0.1 */
SE3D_API se3d_status se3d_shape_find(const se3d_system *system, const char *name,
                                     se3d_shape *shape);
/* Get the name, "" where it has none; it lives as long as the shape. Reader. @since 0.1 */
SE3D_API se3d_status se3d_shape_get_name(const se3d_system *system, se3d_shape shape,
                                         const char **name);
/* Get the body that it is on. Reader. @since 0.1 */
SE3D_API se3d_status se3d_shape_get_body(const se3d_system *system, se3d_shape shape,
                                         se3d_body *body);
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
/* Get the point of a shape's surface nearest to `position`, the outward normal there, and the
 * distance [m], negative inside; ground frame. Reader. @since 0.1 */
SE3D_API se3d_status se3d_shape_get_nearest(const se3d_system *system, se3d_shape shape,
                                            const double position[3], double point[3],
                                            double normal[3], double *distance);

#ifdef __cplusplus
}
#endif
#endif
