/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/memory.h"

#include "force/measure.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

static int has_friction(const se3di_model *model)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_FRICTION) {
            return 1;
        }
    }
    return 0;
}

double se3di_memory_overshoot(const se3di_model *model, const se3di_state_scale *scale)
{
    double largest = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        se3di_measure measure;
        if (force->type != SE3DI_FORCE_FRICTION) {
            continue;
        }
        (void)se3di_measure_force(model, force, 0, &measure);
        const double unit = force->coordinate == SE3D_COORDINATE_ANGLE ? scale->spin : scale->speed;
        largest = fmax(largest, -force->state[2] * measure.rate / unit);
    }
    return largest;
}

se3d_status se3di_memory_settle(se3di_integration *integration, double t, double h,
                                const se3di_state_scale *scale, double *work, double *error)
{
    se3di_equations *equations = integration->equations;
    const se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    se3di_model_save_memory(model, integration->newton.memory);
    *error = 0.0;
    if (!has_friction(model)) {
        se3di_forces_accept(model);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_state_evaluate(equations, t));
    memcpy(work, equations->x, assembly->unknown_count * sizeof *work);
    if (assembly->row_count > 0) { /* the loads */
        memcpy(model->lambda, equations->l, assembly->row_count * sizeof *model->lambda);
    }
    *error = se3di_memory_overshoot(model, scale);
    se3di_forces_accept(model);
    const se3d_status status = se3di_state_evaluate(equations, t);
    if (status < 0) {
        se3di_memory_undo(integration);
        return status;
    }
    for (size_t k = 0; k < assembly->unknown_count; k += 6) {
        double change[6];
        for (size_t c = 0; c < 6; ++c) {
            change[c] = h * (equations->x[k + c] - work[k + c]);
        }
        const double part =
            se3di_norm(change) / scale->speed + se3di_norm(change + 3) / scale->spin;
        *error = part <= *error ? *error : part; /* NaN stays */
    }
    return SE3D_OK;
}

void se3di_memory_undo(se3di_integration *integration)
{
    se3di_model_restore_memory(integration->equations->assembly.model, integration->newton.memory);
}
