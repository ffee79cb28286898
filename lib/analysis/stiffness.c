/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/stiffness.h"

#include "force/force.h"
#include "math/inertia.h"
#include "math/vec3.h"
#include "nonlinear/equations.h"

#include <math.h>

#define STIFF_RATIO                                                                                \
    2e4 /* of the rates: bodies that are held by joints decay more slowly than free ones */

/* tr(M^-1 D) of one body of an element, D 6 x 6 of 12 x 12 (minus the derivative of its wrench). */
static double body_rate(const se3di_body *body, const double *D)
{
    double J[9], column[3], rate = 0.0;
    if (body->fixed) {
        return 0.0;
    }
    se3di_inertia_matrix(body->J, J);
    for (int c = 0; c < 3; ++c) {
        const double turning[3] = {D[12 * 3 + 3 + c], D[12 * 4 + 3 + c], D[12 * 5 + 3 + c]};
        se3di_solve3(J, turning, column);
        rate -= D[13 * c] / body->mass + column[c];
    }
    return rate;
}

double se3di_stiffness_rate(const se3di_model *model)
{
    double fastest = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        se3di_effect effect;
        if (force->type != SE3DI_FORCE_TSDA && force->type != SE3DI_FORCE_RSDA &&
            force->type != SE3DI_FORCE_BUSHING) {
            continue;
        }
        effect.wants_derivative = 1;
        if (se3di_force_eval(model, force, model->time, &effect) < 0) {
            continue; /* the analysis itself will say so */
        }
        const double rate = body_rate(&model->bodies[force->body_i], effect.D) +
                            body_rate(&model->bodies[force->body_j], effect.D + 6 * 13);
        fastest = rate > fastest ? rate : fastest; /* not where it is NaN */
    }
    return fastest;
}

double se3di_stiffness_motion(const se3di_model *model)
{
    double spin = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        spin = fmax(spin, se3di_norm(model->frames[k].w));
    }
    const double pendulum = sqrt(se3di_norm(model->gravity) / se3di_model_get_size(model));
    return fmax(fmax(spin, pendulum), spin + pendulum > 0.0 ? 0.0 : 1.0);
}

int se3di_stiffness_is_stiff(const se3di_model *model)
{
    return se3di_stiffness_rate(model) > STIFF_RATIO * se3di_stiffness_motion(model);
}
