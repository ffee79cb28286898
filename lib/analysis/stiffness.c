/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/stiffness.h"

#include "force/force.h"
#include "math/inertia.h"
#include "math/vec3.h"
#include "nonlinear/equations.h"

#include <math.h>

#define STIFF_RATIO                                                                                \
    2e4 /* of the rates: bodies that are held by joints decay more slowly than free ones */

#define STEP_ANGLE 0.1 /* of the fastest oscillation in an explicit step [rad] */

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

/* The largest over springs, dampers and bushings of tr(M^-1 D) or of sqrt tr(M^-1 K). */
static void measure(const se3di_model *model, double *decay, double *oscillation)
{
    *decay = *oscillation = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        se3di_effect effect;
        if (!(se3di_force_class_of(force)->traits & SE3DI_FORCE_IS_ELASTIC)) {
            continue;
        }
        effect.wants_derivative = 1;
        if (se3di_force_eval(model, force, model->time, &effect) < 0) {
            continue; /* the analysis itself will say so */
        }
        const double rate = body_rate(&model->bodies[force->body_i], effect.D) +
                            body_rate(&model->bodies[force->body_j], effect.D + 6 * 13);
        const double square = body_rate(&model->bodies[force->body_i], effect.K) +
                              body_rate(&model->bodies[force->body_j], effect.K + 6 * 13);
        *decay = rate > *decay ? rate : *decay; /* not if it is NaN */
        *oscillation = square > *oscillation * *oscillation ? sqrt(square) : *oscillation;
    }
}

double se3di_stiffness_step(const se3di_model *model)
{
    double decay, oscillation;
    measure(model, &decay, &oscillation);
    const double rate = decay + oscillation;
    return rate > 0.0 ? STEP_ANGLE / rate : HUGE_VAL; /* a host may trap divisions by 0 */
}

/* The rate of the motion that one wants to see [1/s]: of a pendulum as long as the model is large,
 * and of the spins; 1 at least, as a spin by rounding is none. */
static double rate_of_motion(const se3di_model *model)
{
    double spin = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        spin = fmax(spin, se3di_norm(model->frames[k].w));
    }
    const double pendulum = sqrt(se3di_norm(model->gravity) / se3di_model_get_size(model));
    return fmax(fmax(spin, pendulum), 1.0);
}

int se3di_stiffness_is_stiff(const se3di_model *model)
{
    double decay, oscillation;
    measure(model, &decay, &oscillation);
    return decay > STIFF_RATIO * rate_of_motion(model);
}
