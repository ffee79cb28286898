/* SPDX-License-Identifier: BSD-3-Clause */
/* State: the rate z' = f(t, s_1, s_2, ...) of a user-defined state, as a force on the carrier whose
 * velocity z is:
 *
 *     wrench on j = (m f, 0, 0, 0, 0, 0)       D of a signal s = z:  dz/dv = (1, 0, 0)
 *
 * No work is done and nothing dissipated. States of tyres are slips that lag, see force/tyre.c.
 * docs/theory/states.md */
#include "model/state.h"
#include "force/signal.h"
#include "force/tyre.h"

static se3d_status eval_state(const se3di_model *model, const se3di_force *force, double t,
                              se3di_effect *effect)
{
    double jet[3] = {0.0, 0.0, 0.0};
    if (force->tyre_index >= 0) {
        const se3di_force *tyre = &model->forces[force->tyre_index];
        se3di_tyre_lag lag = {.wants_derivative = 0};
        SE3DI_TRY(se3di_tyre_lag_eval(model, tyre, t, force->coordinate, &lag));
        jet[0] = lag.rate;
    } else if (force->function[0] >= 0) {
        SE3DI_TRY(se3di_law_eval(model, &model->functions[force->function[0]], &t, effect->notes,
                                 jet, NULL));
    }
    effect->coordinate = se3di_state_value(model, force);
    effect->value = jet[0];
    effect->wrench[6] = SE3DI_CARRIER_MASS * jet[0];
    return SE3D_OK;
}

/* None; the callback of a user may fail all the same. */
static se3d_status find_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential)
{
    double jet[3];
    *potential = 0.0;
    if (force->tyre_index < 0 && se3di_law_has_callback(model, force)) {
        SE3DI_TRY(
            se3di_law_eval(model, &model->functions[force->function[0]], &t, NULL, jet, NULL));
    }
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_state = {
    .name = "state",
    .eval = eval_state,
    .find_potential = find_potential,
};
