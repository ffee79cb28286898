/* SPDX-License-Identifier: BSD-3-Clause */
/* Materials: what shapes and particles are made of, and what holds between two of them.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_MATERIAL_H
#define SE3D_MATERIAL_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a material. The restitution given is the one obtained, at any velocity; pairs
 * of materials mix: geometric means of friction and restitution, springs in series. @since 0.1 */
typedef struct se3d_material_def {
    size_t struct_size;
    double density;            /* [kg/m^3] > 0, required */
    double friction;           /* >= 0, default 0.5 */
    double restitution;        /* 0.01 .. 1, default 0.5 */
    double rolling_friction;   /* >= 0: resisting moment over R* Fn */
    double torsional_friction; /* >= 0: the same about the normal */
    double stiffness;          /* [N/m] > 0, required for hooke: of two spheres of this material */
    double tangential_ratio;   /* hooke: kt/kn, 0 .. 10, default 2/7 */
    double young;              /* [Pa] > 0, required for hertz_mindlin */
    double poisson;            /* 0 .. 0.5, default 0.3 */
    double cohesion;           /* >= 0 [J/m^3]: attraction per area of contact, 2 pi R* overlap */
    double adhesion;  /* >= 0 [J/m^2]: work of adhesion; pull-off force 3/2 pi R* adhesion */
    const char *name; /* copied; NULL or unique among materials */
    /* What follows is the law's own where it is 0, and not there at all below 0. @since 0.1 */
    double damping_ratio;          /* [1] of critical damping, in place of a restitution >= 0.01 */
    double tangential_ratio_hertz; /* [1] <= 10, hertz_mindlin: kt/kn; 3 (1 - nu)/(2 - nu) */
    double tangential_damping;     /* [1] <= 10, over that along the normal */
    double rolling_ratio;          /* [1] <= 100, stiffness of rolling and torsion over kt; 1 */
    double rolling_damping;        /* [1] <= 10, over sqrt(m* stiffness of rolling); 1.2 */
    /* Of particles, in place of a restitution: hooke [1/s], damping over m*; hertz_mindlin
     * [1/(m s)], over m* sqrt(R* overlap). Of two the mean, or of the one that has it. */
    double damping_rate;
    /* [N/m], kt in place of tangential_ratio; of hertz_mindlin at any overlap. Of two in series, or
     * of the one that has it. @since 0.1 */
    double tangential_stiffness;
    /* [N/m], of rolling and torsion in place of rolling_ratio; hertz_mindlin at any overlap, and so
     * is their damping. Of two in series, or of the one that has it. @since 0.1 */
    double rolling_stiffness;
} se3d_material_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_material_def_default. @since 0.1 */
SE3D_API void se3d_material_def_init(se3d_material_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_material_def se3d_material_def_default(void)
{
    se3d_material_def def;
    se3d_material_def_init(&def, sizeof def);
    return def;
}

/* Create a material. What the system's law needs must be given. @return OK, NULL,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_material_create(se3d_system *system, const se3d_material_def *def,
                                          se3d_material *material);

/* Change a material, for all shapes and particles made of it. The next step begins with it;
 * def->name is not looked at.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. @since 0.1 */
SE3D_API se3d_status se3d_material_set(se3d_system *system, se3d_material material,
                                       const se3d_material_def *def);

/* Get a material. Set def->struct_size before the call.
 * @param[out] def  its name (NULL: none) is valid as long as the material lives
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_material_get(const se3d_system *system, se3d_material material,
                                       se3d_material_def *def);

/* Find a material by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_material_find(const se3d_system *system, const char *name,
                                        se3d_material *material);

/* Get the name of a material.
 * @param[out] name  "" if it has none; valid as long as the material lives
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_material_get_name(const se3d_system *system, se3d_material material,
                                            const char **name);

/* Count the materials of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_materials(const se3d_system *system);

/* Get a material of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_materials
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_material(const se3d_system *system, size_t index,
                                              se3d_material *material);

/* Destroy a material. @return OK, NULL, STALE_HANDLE, IN_USE (a shape or a set of particles uses
 * it). @since 0.1 */
SE3D_API se3d_status se3d_material_destroy(se3d_system *system, se3d_material material);

/* The definition of a pair of materials, instead of the mixing rules; a negative number stands for
 * the rule, the default. @since 0.1 */
typedef struct se3d_material_pair_def {
    size_t struct_size;
    double friction, restitution, rolling_friction, torsional_friction; /* [1] */
    double stiffness;                                                   /* hooke [N/m] */
    double cohesion, adhesion;                                          /* [J/m^3], [J/m^2] */
    /* In place of what the materials say of themselves; 0 is none. @since 0.1 */
    double damping_ratio;      /* [1] of critical damping, in place of a restitution >= 0.01 */
    double damping_rate;       /* of particles [1/s], hertz_mindlin [1/(m s)]: as of a material */
    double tangential_ratio;   /* [1] <= 10, kt/kn of either law */
    double tangential_damping; /* [1] <= 10, over that along the normal */
    double rolling_ratio;      /* [1] <= 100, stiffness of rolling and torsion over kt */
    double rolling_damping;    /* [1] <= 10, over sqrt(m* stiffness of rolling) */
    double young, poisson;     /* hertz_mindlin, as if both were of it: [Pa] > 0, [1] <= 0.5 */
    /* SE3D_CONTACT_LAW_HOOKE or _HERTZ_MINDLIN, whose materials must have what it needs, in place
     * of the system's law; not in place of a law of the user's own. @since 0.1 */
    int32_t law;
    int32_t reserved;
    double tangential_stiffness; /* [N/m], in place of tangential_ratio. @since 0.1 */
    double rolling_stiffness;    /* [N/m], in place of rolling_ratio. @since 0.1 */
} se3d_material_pair_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_material_pair_def_default. @since 0.1 */
SE3D_API void se3d_material_pair_def_init(se3d_material_pair_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_material_pair_def se3d_material_pair_def_default(void)
{
    se3d_material_pair_def def;
    se3d_material_pair_def_init(&def, sizeof def);
    return def;
}

/* Set what holds between two materials, which may be the same. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT. @since 0.1 */
SE3D_API se3d_status se3d_material_set_pair(se3d_system *system, se3d_material a, se3d_material b,
                                            const se3d_material_pair_def *def);

/* Get what was set of a pair of materials. Set def->struct_size before the call.
 * @param[out] def  negative numbers: the mixing rules
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_material_get_pair(const se3d_system *system, se3d_material a,
                                            se3d_material b, se3d_material_pair_def *def);

#ifdef __cplusplus
}
#endif
#endif
