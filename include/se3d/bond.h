/* SPDX-License-Identifier: BSD-3-Clause */
/* Bonds: elastic beams between the centres of particles, or from one to a shape, that may break.
 * Equations: docs/theory/bonds.md.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_BOND_H
#define SE3D_BOND_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How stiff a bond of section A, second moments I = A radius^2/4, J = 2 I and length L is.
 * @since 0.1 */
typedef enum se3d_bond_law {
    SE3D_BOND_LAW_BEAM = 0,     /* Timoshenko's beam: E A/L, 12 E I/(L^3 (1 + Phi)), E I/L, G J/L,
                                * Phi = 12 E I/(k G A L^2), k = 6 (1 + nu)/(7 + 6 nu) */
    SE3D_BOND_LAW_SLENDER = 1,  /* Euler and Bernoulli's: Phi = 0 */
    SE3D_BOND_LAW_PARALLEL = 2, /* Potyondy and Cundall's parallel bond: kn A, ks A, kn I, ks J */
    SE3D_BOND_LAW_SPRINGS = 3   /* as given, whatever the section: `springs`, `dampers`, `limits` */
} se3d_bond_law;

/* What bonds are made like. Strengths are those of the outermost fibre, of the beams at the worse
 * end, of parallel bonds in the middle: tension is N/A + M radius/I, shear is Q/A + T radius/J. Of
 * springs they are shares of the limits, N/N_max + M/M_max and Q/Q_max + T/T_max in the middle: the
 * bond breaks when their sum is above 1. @since 0.1 */
typedef struct se3d_bond_def {
    size_t struct_size;
    int32_t law;             /* se3d_bond_law */
    int32_t contact;         /* not 0: what is bonded touches, too; default 0: it does not */
    double radius;           /* of the section [m]; 0: `ratio` of the smaller sphere's */
    double ratio;            /* > 0, default 1 */
    double young;            /* beams: E [Pa] > 0 */
    double poisson;          /* beams: nu [1], > -1 and <= 0.5 */
    double normal_stiffness; /* parallel: kn [Pa/m] > 0 */
    double shear_stiffness;  /* parallel: ks [Pa/m] > 0 */
    double damping;          /* part of the critical one [1], 0 to 1: of each of the four springs
                              * with the masses at its ends */
    double tensile_strength; /* [Pa]; 0: it does not break so */
    double shear_strength;   /* [Pa]; 0: it does not break so */
    double gap;              /* of se3d_particles_bond_near and _bond_shape: the most between two
                              * surfaces [m], with 1e-9 of the radius for rounding */
    /* Of springs: normal, shear, bending, twisting. @since 0.1 */
    double springs[4]; /* > 0 [N/m], [N/m], [N m], [N m] */
    double dampers[4]; /* >= 0, beside `damping` [N s/m], [N s/m], [N m s], [N m s] */
    double limits[4];  /* [N], [N], [N m], [N m]; 0: it holds any */
    int32_t smooth;    /* not 0: with the share s of the limits that is reached, all that the bond
                        * does is times 1 - s^4, so that it has let go when it breaks. @since 0.1 */
    int32_t reserved;
} se3d_bond_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_bond_def_default. @since 0.1 */
SE3D_API void se3d_bond_def_init(se3d_bond_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_bond_def se3d_bond_def_default(void)
{
    se3d_bond_def def;
    se3d_bond_def_init(&def, sizeof def);
    return def;
}

/* Bond particles, two by two, as they are: bonds begin without load. They are a group of their
 * own. Spheres of one clump, and two that are bonded, are not bonded.
 * @param[in] count   of bonds
 * @param[in] first   [count] ids
 * @param[in] second  [count] ids
 * @param[out] group  its number, from 0; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_bond(se3d_particles *particles, const se3d_bond_def *def,
                                         size_t count, const uint32_t *first,
                                         const uint32_t *second, uint32_t *group);

/* Bond all particles of one tag with those of another one, or with each other, if no more than
 * `gap` is between their surfaces, in the order of their ids. Those of one clump, and those that
 * are bonded, are left out.
 * @param[in] tag_1   of the ones; -1: all
 * @param[in] tag_2   of the others; -1: all
 * @param[out] added  the number of new bonds; NULL: not wanted
 * @param[out] group  their group; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_bond_near(se3d_particles *particles, const se3d_bond_def *def,
                                              int32_t tag_1, int32_t tag_2, size_t *added,
                                              uint32_t *group);

/* Bond all particles of a tag to a shape that they can touch, each to the nearest point of its
 * surface, if no more than `gap` is between; what they do there acts on its body.
 * @param[in] tag     of the particles; -1: all
 * @param[out] added  the number of new bonds; NULL: not wanted
 * @param[out] group  their group; NULL: not wanted
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_bond_shape(se3d_particles *particles, const se3d_bond_def *def,
                                               se3d_shape shape, int32_t tag, size_t *added,
                                               uint32_t *group);

/* Count the groups of bonds of a set. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_particles_count_bond_groups(const se3d_particles *particles);

/* What there is of a group of bonds, and what became of it. The energy of particles, and of bonds,
 * changes by what goes to `dissipated` and `released`. @since 0.1 */
typedef struct se3d_bond_stats {
    uint64_t count;    /* of bonds that hold */
    uint64_t torn;     /* broken by tension so far */
    uint64_t sheared;  /* by shear */
    uint64_t lost;     /* with a particle or shape that is gone */
    double energy;     /* stored [J] */
    double dissipated; /* by damping so far [J] */
    double released;   /* stored in bonds when they broke, or were lost [J] */
    double tension;    /* the largest [Pa], of springs [1]; < 0 if all are pressed */
    double shear;      /* the largest [Pa], of springs [1] */
} se3d_bond_stats;

/* As se3d_particles_get_bond_stats, told the size of *stats in bytes. @return as
 * se3d_particles_get_bond_stats, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_bond_stats_sized(const se3d_particles *particles,
                                                         int32_t group, se3d_bond_stats *stats,
                                                         size_t size);

/* Get what there is of a group of bonds, as of the last step.
 * @param[in] group  its number; -1: all together
 * @return OK, NULL, INVALID_ARGUMENT (no such group).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_bond_stats(const se3d_particles *particles,
                                                        int32_t group, se3d_bond_stats *stats)
{
    return se3d_particles_get_bond_stats_sized(particles, group, stats, sizeof *stats);
}

/* A bond as it was in the last step, without damping but in force and torque. @since 0.1 */
typedef struct se3d_particles_bond_state {
    uint32_t i, j;  /* ids of the particles; j UINT32_MAX: a shape */
    uint32_t group; /* its number */
    uint32_t reserved;
    se3d_shape shape; /* null: particle j */
    double place[3];  /* of its second end, the image nearest to the first, ground frame [m] */
    double force[3];  /* on j, ground frame [N] */
    double torque[3]; /* on j, about its centre or the point of the shape, ground frame [N m] */
    double length;    /* without load [m] */
    double radius;    /* of the section [m] */
    double tension;   /* [Pa], of springs [1] */
    double shear;     /* [Pa], of springs [1] */
    double energy;    /* stored [J] */
} se3d_particles_bond_state;

/* Count the bonds that hold. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_particles_count_bonds(const se3d_particles *particles);

/* As se3d_particles_get_bonds, told the size of an element in bytes. @return as
 * se3d_particles_get_bonds, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_bonds_sized(const se3d_particles *particles, size_t count,
                                                    se3d_particles_bond_state *bonds, size_t size);

/* List the bonds that hold, in the order in which they were made.
 * @param[in] count   must be se3d_particles_count_bonds
 * @param[out] bonds  [count]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_bonds(const se3d_particles *particles, size_t count,
                                                   se3d_particles_bond_state *bonds)
{
    return se3d_particles_get_bonds_sized(particles, count, bonds, sizeof *bonds);
}

#ifdef __cplusplus
}
#endif
#endif
