/* SPDX-License-Identifier: BSD-3-Clause */
/* All contacts between the shapes of different bodies: which shapes may touch, where they do, and
 * what it does to the bodies.
 *
 * Evaluations read the model only, so that readers may run at the same time. What contacts remember
 * (model->contacts) changes when a state is accepted: se3di_contacts_prepare does all that can
 * fail, se3di_contacts_accept the rest.                              docs/theory/body-contact.md */
#ifndef SE3DI_CONTACT_BODY_CONTACTS_H
#define SE3DI_CONTACT_BODY_CONTACTS_H

#include "contact/encounter.h"

/* Called for every point of contact, in an order that depends on the model only. */
typedef se3d_status (*se3di_contact_visitor)(void *ctx, const se3di_encounter *encounter);
se3d_status se3di_contacts_visit(const se3di_model *model, se3di_contact_visitor visitor,
                                 void *ctx);

/* Whether two shapes may touch at all: materials, groups and masks, not of one body, bodies not
 * joined and not both fixed. */
int se3di_shapes_may_touch(const se3di_model *model, uint32_t a, uint32_t b);
/* Any do. */
int se3di_contacts_possible(const se3di_model *model);

/* Add the wrenches of all contacts, [bodies * 6] as those of force elements. */
void se3di_contacts_add_wrenches(const se3di_model *model, double *wrench);
/* Energy of their springs [J]. */
double se3di_contacts_potential(const se3di_model *model);
/* Power that goes into them [W]: into springs, and lost. */
double se3di_contacts_power(const se3di_model *model);

/* A step of length h begins (0: not known, or control of the error finds where contact begins). */
void se3di_contacts_begin(se3di_model *model, double h);
/* Memory that the state at t will need, where it has not many more contacts than the last one: for
 * methods that cannot go back once they have moved something. */
se3d_status se3di_contacts_reserve(se3di_model *model, double t, se3di_error *error);
/* The state of the model at t is about to be accepted. On failure nothing is remembered of it.
 * @return OK, NO_MEMORY, STEP_SIZE (two shapes overlap too much: the message names them) */
se3d_status se3di_contacts_prepare(se3di_model *model, double t, se3di_error *error);
void se3di_contacts_accept(se3di_model *model);

#endif
