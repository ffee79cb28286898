/* SPDX-License-Identifier: BSD-3-Clause */
/* The two formulations behind one table: what the unknowns of a body are and how they act on its
 * pose.
 *
 *     r-omega: q = (r, pi):  6 unknowns, velocities (v, w), w in the body frame;
 *                            virtual rotations A exp(tilde)
 *     r-p:     q = (r, p):   7 unknowns, velocities (v, pdot),
 *                            and the multiplier of 1/2 (p.p - 1) = 0
 *
 * `block` is the size of a body's block in the KKT system: 6, or 7 + 1 with the normalisation in
 * the last row and column.  docs/theory/formulations.md */
#ifndef SE3DI_FORMULATION_H
#define SE3DI_FORMULATION_H

#include "model/model.h"
#include "primitive/primitive.h"

#define SE3DI_BLOCK_MAX 8

typedef struct se3di_formulation {
    const char *name; /* "romega" */
    int32_t id;       /* se3d_formulation */
    int32_t size;     /* unknowns per body: 6 or 7 */
    int32_t block;    /* with normalisation: 6 or 8 */

    /* Mass block [block * block], row-major, with the normalisation row and column. */
    void (*mass)(const se3di_body *body, const se3di_frame *frame, double *H);
    /* Minus the velocity terms of the equations of motion, [block]; normalisation: -pdot.pdot. */
    void (*velocity_terms)(const se3di_body *body, const se3di_frame *frame, double *b);
    /* Add a force [N] (ground frame, at the centre of mass) and a torque [N m] (body frame) to Q
     * [block]. */
    void (*add_wrench)(const se3di_frame *frame, const double force[3], const double torque[3],
                       double *Q);
    /* Jacobian, gamma and curvature of a primitive, with strides of `size`. */
    void (*jacobian)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                     double *phi_i, double *phi_j);
    double (*gamma)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j);
    void (*curvature)(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                      double lambda, double *H);
    /* frame <- frame moved by dq [size] (positions only; A follows, w and v stay). */
    void (*move)(se3di_frame *frame, const double *dq);
    /* Right-hand side of the normalisation for a position correction; 0 in r-omega. */
    double (*normalisation)(const se3di_frame *frame);
    void (*get_velocity)(const se3di_frame *frame, double *qdot);
    /* Sets v, w and pdot. */
    void (*set_velocity)(se3di_frame *frame, const double *qdot);
    /* Unknown accelerations qddot [size] -> a, wdot. */
    void (*get_acceleration)(const se3di_frame *frame, const double *qddot, double acceleration[6]);
    /* a, wdot -> qddot [size]. */
    void (*set_acceleration)(const se3di_frame *frame, const double acceleration[6], double *qddot);
} se3di_formulation;

extern const se3di_formulation se3di_formulation_romega;
extern const se3di_formulation se3di_formulation_rp;
/* r-omega, for runs in joint coordinates, see integrator/motion.h. */
extern const se3di_formulation se3di_formulation_joint;
/* r-p with the normalisation eliminated: 6 unknowns per body, and the curvature of r-omega. */
extern const se3di_formulation se3di_formulation_rp_tangent;

/* By se3d_formulation; NULL if there is none. */
const se3di_formulation *se3di_formulation_find(int32_t id);
/* What formulations with unknowns (v, w) or their equal share: no normalisation, accelerations that
 * are the unknowns' own, wrenches that act on them as they are. */
double se3di_formulation_no_normalisation(const se3di_frame *frame);
void se3di_formulation_get_plain(const se3di_frame *frame, const double *qddot,
                                 double acceleration[6]);
void se3di_formulation_set_plain(const se3di_frame *frame, const double acceleration[6],
                                 double *qddot);
void se3di_formulation_add_plain(const se3di_frame *frame, const double force[3],
                                 const double torque[3], double *Q);
/* The same formulation in the fewest unknowns, for methods whose state is (r, p, v, w). */
const se3di_formulation *se3di_formulation_reduce(const se3di_formulation *formulation);

#endif
