/* SPDX-License-Identifier: BSD-3-Clause */
/* What is driven against something that cannot give way, or against what jams before that, is no
 * impact of one step: no impulse changes the speed by which it goes on, and one that were to would
 * be as large as the stiffness of the step, not of the contact, makes it. Such contacts, which are
 * known by their impulses at the optimum, follow their laws: the spring and the damper of the
 * materials.                                                            docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/vec3.h"

#include <math.h>

#define JAMS 300.0 /* of what would stop the two bodies by themselves */

static int is_impact(const se3di_convex_contact *contact)
{
    return contact->record && contact->way == SE3DI_CONVEX_IMPACT;
}

/* By how much impacts are to change the velocities of their points, at most. */
static double find_change(const se3di_convex *c, const se3di_convex_island *island)
{
    double most = 0.0;
    for (size_t k = island->contact; k < island->contact_end; ++k) {
        const se3di_convex_contact *contact = se3di_convex_at(c, k);
        const double speed = -se3di_dot(contact->before, contact->normal);
        most = is_impact(contact) ? fmax(most, speed + contact->rebound) : most;
    }
    return most;
}

static void follow_law(const se3di_convex *c, se3di_convex_contact *contact)
{
    const double speed = -se3di_dot(contact->before, contact->normal);
    se3di_convex_set_law(contact, c->model);
    se3di_convex_follow_law(contact, c->model, c->h, fmax(0.0, speed), 0.0);
}

int se3di_convex_free_jams(const se3di_convex *c, const se3di_convex_island *island)
{
    const double change = find_change(c, island);
    int are_freed = 0;
    for (size_t k = island->contact; k < island->contact_end && change > 0.0; ++k) {
        se3di_convex_contact *contact = se3di_convex_at(c, k);
        const double normal = se3di_dot(contact->impulse, contact->normal);
        if (is_impact(contact) && contact->record->inverse_mass * normal > JAMS * change) {
            follow_law(c, contact);
            are_freed = 1;
        }
    }
    return are_freed;
}
