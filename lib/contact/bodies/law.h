/* SPDX-License-Identifier: BSD-3-Clause */
/* Penalty laws: what two materials become when they touch.         docs/theory/contact-laws.md */
#ifndef SE3DI_CONTACT_LAW_H
#define SE3DI_CONTACT_LAW_H

#include "model/model.h"

/* The restitution of a material, as given or by its damping ratio (of critical damping at the
 * stiffness of the overlap, 2 ratio sqrt(m* dFn/d overlap)). */
double se3di_material_restitution(se3di_contact_law law, const se3di_material *material);

/* The law of a pair of materials, where `of_all` is the system's. */
se3di_contact_law se3di_pair_law(se3di_contact_law of_all, const se3di_override *over);

/* Mix two materials: geometric means of friction and restitution, springs in series for stiffness
 * (twice, so that equal ones give themselves). `over` may be NULL. */
void se3di_pair_mix(se3di_contact_law of_all, const se3di_material *a, const se3di_material *b,
                    const se3di_override *over, se3di_pair *pair);

/* Fill the model's table of pairs from its materials and what the user said of them. */
void se3di_pair_mix_all(se3di_model *model);

/* What holds between two shapes (dense). */
const se3di_pair *se3di_pair_of(const se3di_model *model, uint32_t i, uint32_t j);

/* The longest time of a step that resolves a contact of two spheres (a wall: radius_b and mass_b
 * infinite): 1/50 of the contact's time (hooke), 1/40 of Rayleigh's time (hertz_mindlin), of which
 * the lightest partner, `reduced_mass`, may leave less. `over`: what the user said of the pair. */
double se3di_pair_step(const se3di_material *a, const se3di_override *over, const se3di_pair *pair,
                       double radius, double mass, double reduced_mass);

#endif
