/* SPDX-License-Identifier: BSD-3-Clause */
/* What armatures (force/armature.c) add to the equations of the bodies: with g = dx/dq of the
 * coordinate x of a joint and xddot = g . qddot - gamma,
 *
 *     M += a g^T g        velocity terms += a gamma g^T
 *
 * in the blocks of its two bodies and in one that couples them.  docs/theory/armature.md */
#ifndef SE3DI_ASSEMBLY_ARMATURE_H
#define SE3DI_ASSEMBLY_ARMATURE_H

#include "assembly/assembly.h"
#include "force/measure.h"

/* An armature at the state of the model, in the unknowns of the formulation. */
typedef struct se3di_armature {
    double inertia;               /* [kg m^2, kg] */
    double gamma;                 /* xddot = g . qddot - gamma */
    double g[2][SE3DI_BLOCK_MAX]; /* of body i and body j */
    int32_t body[2];              /* free, -1: fixed */
} se3di_armature;

/* Count them and the pairs of free bodies that they couple; with `element` and `pair` list them,
 * pairs (2 numbers each) increasing and none twice. */
void se3di_armatures_count(se3di_assembly *assembly);
void se3di_armatures_list(se3di_assembly *assembly);

void se3di_armature_eval(const se3di_assembly *assembly, uint32_t index, se3di_armature *out);
/* H and H_pair += a g^T g */
void se3di_armatures_add_mass(se3di_assembly *assembly);
/* b [unknowns] += a gamma g^T */
void se3di_armatures_add_terms(const se3di_assembly *assembly, double *b);
/* out [unknowns] -= a g^T g x, at the state of the model */
void se3di_armatures_subtract(const se3di_assembly *assembly, const double *x, double *out);
/* out [unknowns] += s H_pair x: the part of H that couples bodies */
void se3di_armatures_add_coupled(const se3di_assembly *assembly, double s, const double *x,
                                 double *out);
/* 1/2 a xdot^2 of all armatures of a model. */
double se3di_armatures_energy(const se3di_model *model);
/* As a force element with derivatives: a xddot against the coordinate at accelerations (a, wdot) of
 * its bodies [12]. */
void se3di_armature_effect(const se3di_model *model, const se3di_force *force,
                           const double acceleration[12], se3di_effect *effect);

#endif
