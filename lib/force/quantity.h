/* SPDX-License-Identifier: BSD-3-Clause */
/* Coordinates and signals of positions with first and second derivatives: what drivers that follow
 * signals are made of.  docs/theory/signals.md */
#ifndef SE3DI_FORCE_QUANTITY_H
#define SE3DI_FORCE_QUANTITY_H

#include "model/model.h"

enum { SE3DI_QUANTITY_PAIR = 12 };

/* Its derivatives are to the displacements (dr, dtheta) of two bodies. */
typedef struct se3di_quantity {
    double value, rate;
    double curve; /* u . H u: of its second derivative in time what no acceleration makes */
    uint32_t bodies[2];
    double q[SE3DI_QUANTITY_PAIR];
    double H[SE3DI_QUANTITY_PAIR * SE3DI_QUANTITY_PAIR]; /* derivative of q */
} se3di_quantity;

/* A coordinate of a joint. */
void se3di_quantity_take_joint(const se3di_model *model, uint32_t joint, int32_t coordinate,
                               se3di_quantity *out);
/* A signal of positions. @return OK, NOT_FINITE: the points of a length coincide */
se3d_status se3di_quantity_take(const se3di_model *model, const se3di_signal *signal, double t,
                                se3di_quantity *out);
/* Rate and curve at the velocities of the model. */
void se3di_quantity_move(const se3di_model *model, se3di_quantity *out);
/* row [6 * bodies of the constraint] += by q; the ground is none of them */
void se3di_quantity_add_row(const se3di_constraint *constraint, const se3di_quantity *one,
                            double by, double *row);
/* H [n * n] += by H of the quantity, n = 6 * bodies */
void se3di_quantity_add_curvature(const se3di_constraint *constraint, const se3di_quantity *one,
                                  double by, double *H);
/* Let the constraint take part of a body, once. @return 0: it has too many */
int se3di_quantity_add_body(se3di_constraint *constraint, uint32_t body);

#endif
