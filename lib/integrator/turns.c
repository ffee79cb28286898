/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/turns.h"

#include "force/measure.h"
#include "math/elementary.h"
#include "math/over.h"
#include "math/vec3.h"

#include <math.h>

#define COUNTED_MAX 3.0 /* rad, less than half a turn */
#define FAR_BELOW   0.1 /* of it: an angle whose bodies turn less is not measured */

/* Of the joint, or of the element that has a counter of its own. */
static const char *name_of_angle(const se3di_model *model, size_t angle)
{
    const char *name = NULL;
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        if (model->constraints[k].angle == (int32_t)angle) {
            name = model->constraints[k].name;
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].owns_angle && model->forces[k].angle == (int32_t)angle) {
            name = model->forces[k].name;
        }
    }
    return name ? name : "without a name";
}

/* To three digits: what is printed differs from the step that was too long, and can be typed. */
static double round_down(double longest)
{
    const double unit = se3di_pow(10.0, floor(se3di_log10(longest)) - 2.0);
    return floor(se3di_over(longest, unit) * (1.0 + 1e-12)) * unit;
}

static se3d_status fail(const se3di_equations *equations, const char *what, const char *name,
                        double turn, double h, double most)
{
    return se3di_error_set(
        equations->error, SE3D_ERR_STEP_SIZE,
        "t = %g s: %s %.80s turns by %.3g rad in a step of %.9g s, more than %g; the step must be "
        "at most %g s",
        equations->assembly.model->time, what, name, turn, h, most, round_down(h * most / turn));
}

/* The bodies of an angle turn far too little for it to turn by too much: it turns as they do where
 * its directions are in one plane, faster by the inverse cosine where they have left it. */
static int turns_little(const se3di_model *model, const se3di_term *term, double h)
{
    const double *w_i = model->frames[term->body_i].w, *w_j = model->frames[term->body_j].w;
    const double square = 2.0 * h * h * (se3di_dot(w_i, w_i) + se3di_dot(w_j, w_j));
    return square < FAR_BELOW * FAR_BELOW * COUNTED_MAX * COUNTED_MAX;
}

static se3d_status check_bodies(const se3di_equations *equations, double h, double most)
{
    const se3di_model *model = equations->assembly.model;
    for (size_t k = 0; most < HUGE_VAL && k < model->body_slots.count; ++k) {
        const double turn = fabs(h) * se3di_norm(model->frames[k].w);
        if (turn > most) {
            const char *name = model->bodies[k].name;
            return fail(equations, "body", name ? name : "without a name", turn, fabs(h), most);
        }
    }
    return SE3D_OK;
}

se3d_status se3di_turns_check(const se3di_equations *equations, double h, double most)
{
    const se3di_model *model = equations->assembly.model;
    for (size_t k = 0; k < model->angle_count; ++k) {
        if (turns_little(model, &model->angles[k].term, h)) {
            continue;
        }
        se3di_term term = model->angles[k].term;
        se3di_measure measure;
        term.angle = -1;
        se3di_measure_term(model, &term, 0, &measure);
        const double turn = fabs(h * measure.rate);
        if (turn > COUNTED_MAX) {
            return fail(equations, "joint", name_of_angle(model, k), turn, fabs(h), COUNTED_MAX);
        }
    }
    return check_bodies(equations, h, most);
}
