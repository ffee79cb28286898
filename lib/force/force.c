/* SPDX-License-Identifier: BSD-3-Clause */
/* All force elements of a model together, and gravity. */
#include "force/force.h"

#include "math/vec3.h"

#include <string.h>

void se3di_wrench_add_at(const se3di_frame *frame, const double s[3], const double F[3],
                         double wrench[6])
{
    double local[3];
    double moment[3];
    se3di_add(wrench, F, wrench);
    se3di_mul_transposed(frame->A, F, local);
    se3di_cross(s, local, moment);
    se3di_add(wrench + 3, moment, wrench + 3);
}

void se3di_gravity_add(const se3di_model *model, double *wrench)
{
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        se3di_add_scaled(model->bodies[b].mass, model->gravity, wrench + 6 * b);
    }
}

static se3d_status add(const se3di_model *model, const se3di_force *force, double t, double *wrench)
{
    switch (force->type) {
    case SE3DI_FORCE_TSDA:
        return se3di_tsda_add(model, force, t, wrench);
    case SE3DI_FORCE_RSDA:
        return se3di_rsda_add(model, force, t, wrench);
    default:
        return se3di_load_add(model, force, t, wrench);
    }
}

se3d_status se3di_forces_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed)
{
    memset(wrench, 0, 6 * model->body_slots.count * sizeof *wrench);
    se3di_gravity_add(model, wrench);
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        *failed = k;
        SE3DI_TRY(add(model, &model->forces[k], t, wrench));
    }
    return SE3D_OK;
}

se3d_status se3di_forces_potential(const se3di_model *model, double t, double *potential)
{
    *potential = 0.0;
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        *potential -= model->bodies[b].mass * se3di_dot(model->gravity, model->frames[b].r);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        se3di_spring_state state = {0};
        if (force->type == SE3DI_FORCE_TSDA) {
            SE3DI_TRY(se3di_tsda_state(model, force, t, &state));
        } else if (force->type == SE3DI_FORCE_RSDA) {
            SE3DI_TRY(se3di_rsda_state(model, force, t, &state));
        }
        *potential += state.potential;
    }
    return SE3D_OK;
}

const char *se3di_force_type_name(int32_t type)
{
    static const char *const names[] = {"tsda", "rsda", "force", "torque"};
    return names[type];
}
