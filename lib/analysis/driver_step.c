/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/driver_step.h"

#include "base/floats.h"
#include "nonlinear/jump.h"

#include <math.h>

#define APART_MAX 0.3   /* rad, or of the size of the model: what is found from the prediction */
#define TURN_MAX  3.0   /* rad that an angle may change by so that its turns are counted */
#define RESOLVED  1e-15 /* relative length of the shortest step */
#define TWO_PI    6.283185307179586

/* How far the value at t + h is from the parabola at t, in units of the row's scale; 0 if it
 * cannot be computed, which is reported when it is used. */
static double measure(const se3di_model *model, uint32_t row, double h, double scale)
{
    const se3di_function *function = &model->functions[model->rows[row].function];
    const double end = model->time + h;
    double jet[3], jet_end[3];
    if (se3di_function_eval(function, &model->time, jet, NULL) < 0 ||
        se3di_function_eval(function, &end, jet_end, NULL) < 0) {
        return 0.0;
    }
    const double way = jet_end[0] - jet[0];
    const double apart = jet_end[0] - (jet[0] + h * (jet[1] + 0.5 * h * jet[2]));
    const double turns = TWO_PI * se3di_nearest(apart / TWO_PI);
    const int is_tooth = model->rows[row].wrap && fabs(turns) > 0.0 &&
                         fabs(apart - turns) <= APART_MAX &&
                         se3di_jump_is_between(function, model->time, end);
    if (is_tooth) { /* whole turns of a saw-tooth are no motion */
        return fabs(apart - turns);
    }
    if (model->rows[row].wrap && fabs(way) > TURN_MAX && fabs(h * jet[1]) <= TURN_MAX) {
        return HUGE_VAL; /* more than its rate told: the turn would be lost */
    }
    return fabs(apart) / scale;
}

double se3di_driver_step(const se3di_equations *equations, double h)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    const double size = assembly->timed_count > 0 ? se3di_model_get_size(model) : 1.0;
    for (uint32_t k = 0; k < assembly->timed_count; ++k) {
        const uint32_t row = assembly->timed_rows[k];
        const double scale = se3di_row_get_scale(model, row, size);
        while (measure(model, row, h, scale) > APART_MAX &&
               0.5 * h > RESOLVED * (1e-3 + fabs(model->time))) {
            h *= 0.5;
        }
    }
    return h;
}
