/* SPDX-License-Identifier: BSD-3-Clause */
/* All contacts between the shapes of different bodies: which shapes may touch, where they do, and
 * what it does to the bodies.
 *
 * Evaluations read the model only, so that readers may run at the same time. What contacts remember
 * (model->contacts) changes when a state is accepted: se3di_contacts_prepare does all that can
 * fail, se3di_contacts_accept the rest.                              docs/theory/body-contact.md */
#ifndef SE3DI_CONTACT_BODY_CONTACTS_H
#define SE3DI_CONTACT_BODY_CONTACTS_H

#include "contact/bodies/encounter.h"

/* Before forces are asked for at the poses of the model several times: what surfaces touch, where
 * they have been reserved (met.h). */
void se3di_contacts_look(se3di_model *model);

/* Called for every point of contact of the model's state, which is that at t, in an order that
 * depends on the model only. */
typedef se3d_status (*se3di_contact_visitor)(void *ctx, const se3di_encounter *encounter);
se3d_status se3di_contacts_visit(const se3di_model *model, double t, se3di_contact_visitor visitor,
                                 void *ctx);

/* Whether two shapes may touch at all: materials, groups and masks, not of one body, not joined
 * (joined.h), bodies not both fixed. */
int se3di_shapes_may_touch(const se3di_model *model, uint32_t a, uint32_t b);
/* Two meshes that would have contact if meshes had any with each other. */
int se3di_shapes_pass_through(const se3di_model *model, uint32_t a, uint32_t b);
/* How messages call a shape: by its name, or that of its body. */
const char *se3di_shape_describe(const se3di_model *model, uint32_t shape);
/* How messages tell that two shapes (dense) are as deep in each other as the settings allow. */
#define SE3DI_DEPTH_SIZE 256
void se3di_contacts_describe_depth(const se3di_model *model, const uint32_t shapes[2],
                                   double overlap, char text[SE3DI_DEPTH_SIZE]);

/* Add the wrenches of all contacts, [bodies * 6] as those of force elements. `power` gets what
 * se3di_contacts_power tells; NULL: it is not asked for. */
void se3di_contacts_add_wrenches(const se3di_model *model, double t, double *wrench,
                                 double power[2]);
/* Add `share` of a force (ground frame) at `arm` from the centre of mass to the wrench of a
 * body. */
void se3di_contact_push(const se3di_frame *frame, const double arm[3], double share,
                        const double force[3], double wrench[6]);
/* How stiff one that is remembered is along its normal [N/m]; of a user's law, of which the force
 * alone is known, that over the overlap. */
double se3di_contact_stiffness(const se3di_model *model, const se3di_body_contact *contact);
/* Energy of their springs [J]. */
double se3di_contacts_potential(const se3di_model *model, double t);
/* Power that goes into them [W]: into springs, and lost; of that what the drives of surfaces that
 * move on their bodies give. */
void se3di_contacts_power(const se3di_model *model, double t, double power[2]);

/* Memory that the state at t will need, if it does not have many more contacts than the last one:
 * for methods that cannot go back once they have moved something. */
se3d_status se3di_contacts_reserve(se3di_model *model, double t, se3di_error *error);
/* A step of length h begins (0: not known, or control of the error finds where contact begins).
 * `weight` is what the method gives to the forces at the end of a step (1: nothing is corrected):
 * the damping of a contact that begins within it is made such that its impulse is right to second
 * order. With `jumps` it need not be continuous, for explicit methods. */
void se3di_contacts_begin(se3di_model *model, double h, double weight, int jumps);
/* Whether contacts began or ended with the state that was accepted. */
int se3di_contacts_changed(const se3di_model *model);
/* The state of the model at t is about to be accepted. On failure nothing is remembered of it.
 * @return OK, NO_MEMORY, STEP_SIZE (two shapes overlap too much: the message names them) */
se3d_status se3di_contacts_prepare(se3di_model *model, double t, se3di_error *error);
/* The same however much they overlap: if poses are only looked at. */
se3d_status se3di_contacts_prepare_any(se3di_model *model, double t, se3di_error *error);
void se3di_contacts_accept(se3di_model *model);
/* The forces of the contacts of the accepted state, which is the model's, as they are with what was
 * remembered of it: those that the accelerations there are made of, which what was remembered
 * before may have made others. Nothing else changes. */
void se3di_contacts_renew_forces(se3di_model *model);
/* Let readers see the contacts of the present state, which lies within a step that was accepted,
 * among the pairs of that step; what is remembered is kept until se3di_contacts_hide. On failure
 * nothing is shown, and there is nothing to hide. @return as se3di_contacts_prepare */
se3d_status se3di_contacts_show(se3di_model *model, double t, se3di_error *error);
void se3di_contacts_hide(se3di_model *model);

#endif
