/* SPDX-License-Identifier: BSD-3-Clause */
/* The audit of energy where values of elements change between two steps. Elements evaluate
 * callbacks: the system is busy while they do. */
#include "contact/loads.h"
#include "system/system_internal.h"

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
    return status < 0 ? 0.0 : effect.potential;
}

void se3di_audit_force_change(se3di_model *model, const se3di_force *force, double before)
{
    model->work[1] += se3di_audit_force(model, force) - before;
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
    return status < 0 ? 0.0 : potential + se3di_kinetic_energy(model);
}

void se3di_audit_change(se3di_model *model, double before)
{
    model->work[1] += se3di_audit_forces(model) - before;
}

double se3di_audit_contacts(const se3di_model *model)
{
    if (model->work_valid <= 0) {
        return 0.0;
    }
    const int32_t level = se3di_busy_raise(model->busy, SE3DI_BUSY_CALL);
    const double energy = se3di_contacts_potential(model);
    se3di_busy_restore(model->busy, level);
    return energy;
}

/* All that goes into contacts counts as dissipated but for what their springs hold. */
void se3di_audit_contacts_change(se3di_model *model, double before)
{
    const double change = se3di_audit_contacts(model) - before;
    model->work[0] += change;
    model->work[1] += change;
}
