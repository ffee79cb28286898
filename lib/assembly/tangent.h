/* SPDX-License-Identifier: BSD-3-Clause */
/* The derivatives of the equations of motion, in the pattern of the KKT matrix with couplings: with
 *
 *     R = M(q) vdot + Phi_q^T lambda - Q(q, qdot, t) - velocity terms
 *     K = dR/dq,  D = dR/dqdot,  M
 *
 * at given vdot and lambda; in r-omega to virtual rotations in the body frame, in r-p to p (on the
 * tangent of |p| = 1; the normalisation keeps dp there). K holds the Jacobians of the force
 * elements, the curvature of the constraints and, in r-p, of the mass terms; D those of forces and
 * gyroscopic terms.  docs/theory/tangent.md */
#ifndef SE3DI_TANGENT_H
#define SE3DI_TANGENT_H

#include "assembly/assembly.h"

typedef struct se3di_tangent {
    const se3di_assembly *assembly;
    size_t coupling_count;
    size_t coupling_capacity;
    int32_t *coupling;   /* [2 * couplings] free bodies i < j, increasing */
    int32_t *joint_pair; /* [constraints] coupling of the bodies of a fused joint, -1: none */
    uint8_t *is_filled;  /* [couplings] something may not be zero; of many that may touch few do */
    int32_t is_convex;   /* K without negative curvature (r-omega): assembly/convex.h */
    int32_t reserved;
    const double *excess; /* [forces] of n in a wrench -n g, that is no curvature; NULL: none */
    /* Blocks [block * block]: of the bodies; of the couplings: rows of i, columns of j, and rows of
     * j, columns of i. */
    double *M, *M_upper, *M_lower; /* couplings: NULL without armatures */
    double *K, *K_upper, *K_lower;
    double *D, *D_upper, *D_lower;
} se3di_tangent;

/* Analyse the couplings and allocate; on failure nothing is held. */
se3d_status se3di_tangent_init(se3di_tangent *tangent, const se3di_assembly *assembly);
void se3di_tangent_destroy(se3di_tangent *tangent);

/* Evaluate M, K and D at the state of the model. vdot [unknowns] (r-p: with the multipliers of the
 * normalisation), lambda [rows]. @return OK, SINGULAR, NOT_FINITE, CALLBACK of a force element or
 * user constraint, which `error` names */
se3d_status se3di_tangent_eval(se3di_tangent *tangent, double t, const double *vdot,
                               const double *lambda, se3di_error *error);
/* rows, laid out as C: += c d(Phi_q qdot)/dq, but for those of user constraints. Formulations with
 * velocities (v, w) only. */
void se3di_assembly_add_rate_gradient(const se3di_assembly *assembly, double c, double *rows);
/* out += s K x */
void se3di_tangent_add_stiffness(const se3di_tangent *tangent, double s, const double *x,
                                 double *out);
/* out += s D x */
void se3di_tangent_add_damping(const se3di_tangent *tangent, double s, const double *x,
                               double *out);

#endif
