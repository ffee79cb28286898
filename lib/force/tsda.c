/* SPDX-License-Identifier: BSD-3-Clause */
/* TSDA: translational spring-damper-actuator between point s_i of body i and s_j of body j,
 *
 *     d = r_j + A_j s_j - r_i - A_i s_i,  l = |d|,  ldot = d . ddot / l
 *     f = k (l - l0) + c ldot + h(t, l, ldot)      F_i = f d/l,  F_j = -f d/l
 *
 * (Haug 1989, sec. 11.4.) At l = 0 the direction is lost; with l0 = 0 and neither preload, curve
 * nor actuator the force is k d + c ddot, whose limit is regular in k.  docs/theory/springs.md */
#include "force/measure.h"
#include "primitive/primitive.h"

#include <string.h>

/* Coinciding points: the potential k D / 2, and c against the relative velocity in every direction.
 */
static void eval_at_zero(const se3di_model *model, const se3di_force *force, se3di_effect *effect)
{
    se3di_term term;
    se3di_measure d;
    double H[144] = {0.0};
    double rate[12] = {0.0};
    se3di_length_term(force, &term);
    se3di_measure_term(model, &term, 1, &d);
    memcpy(H, d.H, sizeof H);
    for (int r = 0; r < 12; ++r) {
        for (int c = 0; c < 12; ++c) {
            rate[r] += 0.5 * H[12 * r + c] * d.u[c]; /* at d = 0, D_qq / 2 = d_q^T d_q */
        }
        effect->wrench[r] = -0.5 * force->k * d.g[r] - force->c * rate[r];
        effect->power[0] += force->c * d.u[r] * rate[r];
    }
    for (int k = 0; effect->wants_derivative && k < 144; ++k) {
        effect->K[k] = -0.5 * force->k * H[k];
        effect->D[k] = -0.5 * force->c * H[k];
    }
}

static se3d_status eval_tsda(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    se3di_measure measure;
    se3di_law law;
    if (!se3di_measure_length(model, force, effect->wants_derivative, &measure)) {
        int directed = force->rest > 0.0 || force->preload != 0.0 || force->function[0] >= 0 ||
                       force->function[3] >= 0 || force->function[4] >= 0;
        if (directed) {
            return SE3D_ERR_SINGULAR;
        }
        eval_at_zero(model, force, effect);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_spring_law(model, force, t, &measure, effect, &law));
    se3di_effect_add(effect, &measure, &law);
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_tsda = {
    .name = "tsda",
    .eval = eval_tsda,
    .find_potential = se3di_spring_find_potential,
    .traits = SE3DI_FORCE_IS_SCALAR | SE3DI_FORCE_IS_ELASTIC | SE3DI_FORCE_HOLDS,
};
