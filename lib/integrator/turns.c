/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/turns.h"

#include "force/measure.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define COUNTED_MAX 3.0 /* rad, less than half a turn */

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
    return floor(longest / unit * (1.0 + 1e-12)) * unit;
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

se3d_status se3di_turns_check(const se3di_equations *equations, double h, double most)
{
    const se3di_model *model = equations->assembly.model;
    for (size_t k = 0; k < model->angle_count; ++k) {
        se3di_term term = model->angles[k].term;
        se3di_measure measure;
        term.angle = -1;
        se3di_measure_term(model, &term, 0, &measure);
        const double turn = fabs(h * measure.rate);
        if (turn > COUNTED_MAX) {
            return fail(equations, "joint", name_of_angle(model, k), turn, fabs(h), COUNTED_MAX);
        }
    }
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const double turn = fabs(h) * se3di_norm(model->frames[k].w);
        if (turn > most) {
            const char *name = model->bodies[k].name;
            return fail(equations, "body", name ? name : "without a name", turn, fabs(h), most);
        }
    }
    return SE3D_OK;
}
