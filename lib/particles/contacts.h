/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts of the present lists as they are now; nothing changes. */
#ifndef SE3DI_PARTICLES_CONTACTS_H
#define SE3DI_PARTICLES_CONTACTS_H

#include "particles/set.h"

/* Counts all, writes the first `capacity`. */
se3d_status se3di_particles_contacts(const se3di_particles *set, size_t capacity, void *contacts,
                                     size_t size, size_t *count, double *force_max);

/* Visit all, in the order of that list. */
void se3di_particles_visit_contacts(const se3di_particles *set,
                                    void (*visit)(void *ctx, const se3d_particles_contact *contact),
                                    void *ctx);

#endif
