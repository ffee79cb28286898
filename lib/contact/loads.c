/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/loads.h"

#include <string.h>

se3d_status se3di_loads_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed)
{
    SE3DI_TRY(se3di_forces_eval(model, t, wrench, failed));
    se3di_contacts_add_wrenches(model, wrench);
    return SE3D_OK;
}

se3d_status se3di_loads_potential(const se3di_model *model, double t, double *potential)
{
    SE3DI_TRY(se3di_forces_potential(model, t, potential));
    *potential += se3di_contacts_potential(model);
    return SE3D_OK;
}

se3d_status se3di_loads_power(const se3di_model *model, double t, double power[3])
{
    SE3DI_TRY(se3di_power_eval(model, t, power));
    power[0] += se3di_contacts_power(model);
    return SE3D_OK;
}

se3d_status se3di_work_accept(se3di_model *model, double h)
{
    double power[3];
    SE3DI_TRY(se3di_loads_power(model, model->time, power));
    if (model->work_valid <= 0) {
        memset(model->work, 0, sizeof model->work);
        model->work[0] = se3di_contacts_potential(model);
    }
    for (int k = 0; k < 3; ++k) {
        model->work[k] += model->work_valid > 0 ? 0.5 * h * (model->power[k] + power[k]) : 0.0;
        model->power[k] = power[k];
    }
    model->work_valid = 1;
    return SE3D_OK;
}

double se3di_work_lost(const se3di_model *model)
{
    return model->work_valid > 0 ? model->work[0] - se3di_contacts_potential(model)
                                 : model->work[0];
}

se3d_status se3di_loads_prepare(se3di_model *model, double t, se3di_error *error)
{
    return se3di_contacts_prepare(model, t, error);
}

void se3di_loads_accept(se3di_model *model)
{
    se3di_forces_accept(model);
    se3di_contacts_accept(model);
}

int se3di_loads_are_stiff(const se3di_model *model)
{
    return model->force_slots.count > 0 || model->contacts.pair_count > 0;
}
