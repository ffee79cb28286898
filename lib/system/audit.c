/* SPDX-License-Identifier: BSD-3-Clause */
/* The audit of energy when values of elements change between two steps. Elements evaluate
 * callbacks: the system is busy while they do. */
#include "assembly/energy.h"
#include "contact/bodies/body_contacts.h"
#include "force/force.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

/* If a callback failed before or after the change, the work of the change is not known: the
 * audit begins anew. */
static void count(se3di_model *model, uint32_t first, uint32_t last, double change)
{
    if (!isfinite(change)) {
        memset(model->work, 0, sizeof model->work);
        model->work_valid = 0;
        return;
    }
    for (uint32_t k = first; k <= last; ++k) {
        model->work[k] += change;
    }
}

double se3di_audit_force(const se3di_model *model, const se3di_force *force)
{
    se3di_effect effect;
    effect.wants_derivative = 0;
    if (model->work_valid <= 0) {
        return 0.0;
    }
    const int32_t level = se3di_busy_raise(model->busy, SE3DI_BUSY_CALL);
    const se3d_status status = se3di_force_eval(model, force, model->time, &effect);
    se3di_busy_restore(model->busy, level);
    return status < 0 ? (double)NAN : effect.potential;
}

void se3di_audit_force_change(se3di_model *model, const se3di_force *force, double before)
{
    count(model, 1, 1, se3di_audit_force(model, force) - before);
}

double se3di_audit_forces(const se3di_model *model)
{
    double potential;
    if (model->work_valid <= 0) {
        return 0.0;
    }
    const int32_t level = se3di_busy_raise(model->busy, SE3DI_BUSY_CALL);
    const se3d_status status = se3di_forces_potential(model, model->time, &potential);
    se3di_busy_restore(model->busy, level);
    return status < 0 ? (double)NAN : potential + se3di_kinetic_energy(model);
}

void se3di_audit_change(se3di_model *model, double before)
{
    count(model, 1, 1, se3di_audit_forces(model) - before);
}

double se3di_audit_contacts(const se3di_model *model)
{
    if (model->work_valid <= 0) {
        return 0.0;
    }
    const int32_t level = se3di_busy_raise(model->busy, SE3DI_BUSY_CALL);
    const double energy = se3di_contacts_potential(model, model->time);
    se3di_busy_restore(model->busy, level);
    return energy;
}

/* All that goes into contacts counts as dissipated but for what their springs hold. */
void se3di_audit_contacts_change(se3di_model *model, double before)
{
    count(model, 0, 1, se3di_audit_contacts(model) - before);
}
