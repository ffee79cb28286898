/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a method may step where shapes touch or come near each other.
 * docs/theory/body-contact.md */
#ifndef SE3DI_CONTACT_PACE_H
#define SE3DI_CONTACT_PACE_H

#include "contact/bodies/body_contacts.h"

typedef enum se3di_pace_kind {
    SE3DI_PACE_EXPLICIT, /* fixed steps: every contact is followed through its oscillation */
    SE3DI_PACE_IMPLICIT, /* fixed steps: impacts are, resting contacts limit nothing */
    SE3DI_PACE_ADAPTIVE  /* with control of the error: no contact that begins is stepped over */
} se3di_pace_kind;

/* The longest step from the last accepted state, at most h. */
double se3di_contacts_pace(const se3di_model *model, se3di_pace_kind kind, double h);
/* A step on the way to t_end, of at most h: equal ones if no contact asks for less. */
double se3di_contacts_next_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                double t_end);

/* Whether a step of h that was asked for follows the contacts: none is beyond stability (explicit
 * methods), no shape may pass through another one.
 * @return OK, STEP_SIZE (the message names the two shapes) */
se3d_status se3di_shapes_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                    se3di_error *error);
/* The same, and that it follows the impacts on stops. */
se3d_status se3di_contacts_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                      se3di_error *error);

/* Add to the message of a step that failed which shapes are as deep in each other as is allowed, or
 * have the largest contact force, or, if none touch, are about to; nothing if it tells a depth. */
void se3di_contacts_blame(const se3di_model *model, se3di_error *error);

#endif
