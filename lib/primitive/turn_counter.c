/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint angles that count turns: the principal value of the angle primitive is taken nearest to the
 * angle of the last accepted state. */
#include "primitive/turn_counter.h"

#include "base/floats.h"
#include "primitive/primitive.h"
#include "primitive/scale.h"

#include <math.h>

#define TWO_PI 6.283185307179586476925286766559

double se3di_angle_value(const se3di_model *model, uint32_t angle)
{
    const se3di_angle *counter = &model->angles[angle];
    const se3di_term *term = &counter->term;
    double principal =
        counter->offset + se3di_primitives[SE3DI_PRIMITIVE_ANGLE].value(
                              term, &model->frames[term->body_i], &model->frames[term->body_j]);
    return principal + TWO_PI * se3di_nearest((counter->theta - principal) / TWO_PI);
}

double se3di_term_value(const se3di_model *model, const se3di_term *term)
{
    if (term->type == SE3DI_PRIMITIVE_ANGLE && term->angle >= 0) {
        return term->coefficient * se3di_angle_value(model, (uint32_t)term->angle);
    }
    return term->coefficient * se3di_primitives[term->type].value(term,
                                                                  &model->frames[term->body_i],
                                                                  &model->frames[term->body_j]);
}

double se3di_row_violation(const se3di_model *model, const se3di_row *row, double f)
{
    double sum = -f;
    for (uint32_t k = 0; k < row->term_count; ++k) {
        sum += se3di_term_value(model, &model->terms[row->term_begin + k]);
    }
    return row->wrap ? sum - TWO_PI * se3di_nearest(sum / TWO_PI) : sum;
}

void se3di_angles_accept(se3di_model *model)
{
    for (size_t k = 0; k < model->angle_count; ++k) {
        model->angles[k].theta = se3di_angle_value(model, (uint32_t)k);
    }
    se3di_left_out_follow(model);
}
