/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/start_moved.h"

#include "math/vec3.h"
#include "primitive/scale.h"

#include <math.h>
#include <stdio.h>

#define PART_LEAST 0.05 /* of the model's size: smaller moves are none */

/* The farthest of what is on body k from its centre of mass [m]. */
static double reach_of(const se3di_model *model, uint32_t k)
{
    const se3di_body *body = &model->bodies[k];
    const double spread =
        body->mass > 0.0 ? (body->J[0] + body->J[1] + body->J[2]) / body->mass : 0.0;
    double reach = sqrt(fmax(spread, 0.0));
    for (size_t i = 0; i < model->constraint_slots.count; ++i) {
        const se3di_constraint *joint = &model->constraints[i];
        for (uint32_t n = 0; n < joint->term_count; ++n) {
            const se3di_term *term = &model->terms[joint->term_begin + n];
            reach = fmax(reach, term->body_i == k ? se3di_norm(term->s_i) : 0.0);
            reach = fmax(reach, term->body_j == k ? se3di_norm(term->s_j) : 0.0);
        }
    }
    for (size_t i = 0; i < model->force_slots.count; ++i) {
        const se3di_force *force = &model->forces[i];
        reach = fmax(reach, force->body_i == k ? se3di_norm(force->s_i) : 0.0);
        reach = fmax(reach, force->body_j == k ? se3di_norm(force->s_j) : 0.0);
    }
    return reach;
}

int se3di_start_moved_describe(const se3di_model *model, const se3di_frame *given, char *text,
                               size_t size)
{
    const double least = PART_LEAST * se3di_model_get_size(model);
    double ratio = 1.0, moved = 0.0, length = 0.0;
    uint32_t most = 0;
    char number[32];
    for (uint32_t k = 0; k < model->body_slots.count; ++k) {
        double d[3];
        se3di_sub(model->frames[k].r, given[k].r, d);
        const double distance = se3di_norm(d);
        if (model->bodies[k].fixed || model->bodies[k].state != 0 || !(distance > least)) {
            continue;
        }
        const double own = 2.0 * reach_of(model, k);
        if (own > 0.0 && distance > ratio * own) {
            ratio = distance / own;
            moved = distance;
            length = own;
            most = k;
        }
    }
    snprintf(number, sizeof number, "number %u", (unsigned)most);
    snprintf(text, size,
             "body %.100s was moved by %.3g m to fit the constraints, more than its size, %.3g m: "
             "see whether its position and the points of its joints are right",
             model->bodies[most].name ? model->bodies[most].name : number, moved, length);
    return moved > 0.0;
}
