/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: what they do to the bodies, one file per type. A wrench is a force at the centre
 * of mass in the ground frame [N] and a torque in the body frame [N m], 6 numbers per body, indexed
 * by dense body. */
#ifndef SE3DI_FORCE_H
#define SE3DI_FORCE_H

#include "model/model.h"

/* State of a spring element. */
typedef struct se3di_spring_state {
    double coordinate; /* length [m] or angle [rad] */
    double rate;
    double value;        /* f [N] or n [N m] */
    double potential;    /* of k [J] */
    double direction[3]; /* tsda: from i to j, unit; rsda: axis; ground frame */
    double pull[3];      /* tsda: the force on point i, ground frame */
} se3di_spring_state;

/* Evaluate a tsda or rsda. @return OK, SINGULAR (the points of a tsda with a free length or an
 * actuator coincide), NOT_FINITE, CALLBACK */
se3d_status se3di_tsda_state(const se3di_model *model, const se3di_force *force, double t,
                             se3di_spring_state *state);
se3d_status se3di_rsda_state(const se3di_model *model, const se3di_force *force, double t,
                             se3di_spring_state *state);

/* Add the element's wrenches. */
se3d_status se3di_tsda_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench);
se3d_status se3di_rsda_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench);
se3d_status se3di_load_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench);
void se3di_gravity_add(const se3di_model *model, double *wrench);

/* Wrenches of gravity and all elements on all bodies, [bodies * 6]. On failure *failed is the
 * element. */
se3d_status se3di_forces_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed);

/* Potential energy of gravity (zero at the ground origin) and springs [J]. */
se3d_status se3di_forces_potential(const se3di_model *model, double t, double *potential);

/* The name of an element's type as in the model file. */
const char *se3di_force_type_name(int32_t type);

/* Add force F (ground frame) at point s (body frame) of a body. */
void se3di_wrench_add_at(const se3di_frame *frame, const double s[3], const double F[3],
                         double wrench[6]);

#endif
