/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/loads.h"

se3d_status se3di_loads_sum(const se3di_model *model, double t, se3di_force_sums *sums)
{
    SE3DI_TRY(se3di_forces_sum(model, t, sums));
    se3di_contacts_add_wrenches(model, t, sums->wrench, NULL);
    return SE3D_OK;
}

se3d_status se3di_loads_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed)
{
    se3di_force_sums sums = {.wrench = wrench};
    const se3d_status status = se3di_loads_sum(model, t, &sums);
    *failed = sums.failed;
    return status;
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
