/* SPDX-License-Identifier: BSD-3-Clause */
/* What is driven against something that cannot give way, or against what jams before that, is no
 * impact of one step: no impulse changes the speed by which it goes on, and one that were to would
 * be as large as the stiffness of the step, not of the contact, makes it. Such contacts, which are
 * known by their impulses at the optimum, follow their laws: the spring and the damper of the
 * materials.                                                            docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/bodies/law.h"
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

/* By its law: what the implicit step damps by itself is taken from the law's damper. */
static void follow_law(const se3di_convex *c, se3di_convex_contact *contact)
{
    const se3di_body_contact *record = contact->record;
    const se3di_pair *pair = se3di_pair_of(c->model, record->shape_i, record->shape_j);
    const double h = c->h;
    const double speed = fmax(0.0, -se3di_dot(contact->before, contact->normal));
    se3di_convex_set_law(contact, c->model);
    const double middle = contact->overlap + 0.5 * h * speed;
    const double share = contact->power > 1.0 ? sqrt(middle) : 1.0;
    const double stiffness = contact->stiffness * share * (contact->power > 1.0 ? 1.5 : 1.0);
    const double root = sqrt(contact->stiffness * share / pair->kn / record->inverse_mass);
    const double yields = h * contact->tangential;
    contact->way = SE3DI_CONVEX_SPRING;
    contact->is_short = 0;
    se3di_convex_set_attraction(contact, c->model, h, speed);
    contact->damping = fmax(0.0, pair->dn * root - 0.5 * h * stiffness);
    contact->drag = h * (yields + fmax(0.0, pair->dt * root - 0.5 * yields));
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
