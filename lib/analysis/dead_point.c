/* SPDX-License-Identifier: BSD-3-Clause */
/* The limit is found by bisection of the times at which the positions can be met. It is a dead
 * point where the velocities grow without bound towards it. The driver is the one on whose equation
 * the solution of C M^-1 C^T l = nu leans the most: there the matrix loses its rank, and l grows
 * along what it loses.  docs/theory/kinematics.md */
#include "analysis/dead_point.h"

#include "math/vec3.h"
#include "nonlinear/against.h"
#include "primitive/scale.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BISECTIONS 40

static int can_be(se3d_status status)
{
    return status == SE3D_ERR_INCONSISTENT || status == SE3D_ERR_NO_CONVERGENCE ||
           status == SE3D_ERR_SINGULAR || status == SE3D_ERR_STEP_SIZE ||
           status == SE3D_ERR_STEP_COUNT;
}

/* The size of all velocities [1/s], of translations over the size of the model. */
static double measure_speed(const se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    const double size = se3di_model_get_size(model);
    double square = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *frame = &model->frames[k];
        if (model->bodies[k].state == 0) {
            square += se3di_dot(frame->v, frame->v) / (size * size) + se3di_dot(frame->w, frame->w);
        }
    }
    return sqrt(square);
}

/* The driven equation on which the velocities lean the most; row_count: there is none. */
static uint32_t find_driver(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    const double size = se3di_model_get_size(model);
    uint32_t found = assembly->row_count;
    double most = 0.0;
    if (se3di_assembly_eval_functions(&equations->assembly, model->time, NULL) < 0) {
        return found;
    }
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * k + 1];
    }
    if (se3di_equations_factor(equations) < 0 || se3di_equations_solve(equations) < 0) {
        return found;
    }
    for (uint32_t k = 0; k < assembly->timed_count; ++k) {
        const uint32_t row = assembly->timed_rows[k];
        const double lean = fabs(equations->l[row]) * se3di_row_get_scale(model, row, size);
        if (lean > most) {
            most = lean;
            found = row;
        }
    }
    return found;
}

static int correct(se3di_equations *equations, double t)
{
    int converged = 0;
    return se3di_position_correct(equations, t, &converged) >= 0 && converged;
}

/* Positions and velocities at t, from the accepted ones. If these are far away (a method has come
 * to the dead point by long steps) Newton fails near it: the way is gone in parts, each a quarter
 * of the rest. */
static int is_met(se3di_equations *equations, double t, double *speed)
{
    const double from = equations->assembly.model->time;
    int met = correct(equations, t);
    if (!met) {
        double rest = t - from;
        se3di_state_restore(equations);
        for (met = 1; met && rest > 1e-9 * (t - from); rest *= 0.25) {
            met = correct(equations, t - rest);
        }
        met = met && correct(equations, t);
    }
    if (met && speed) {
        *speed = se3di_velocity_solve(equations, t) < 0 ? HUGE_VAL : measure_speed(equations);
    }
    se3di_state_restore(equations);
    return met;
}

/* The last time before t_end at which the positions can be met from the accepted ones. */
static double find_limit(se3di_equations *equations, double t_end)
{
    double low = equations->assembly.model->time;
    double high = t_end;
    for (int k = 0; k <= BISECTIONS && high - low > 1e-10 * fabs(high); ++k) {
        const double t = k == 0 ? high : 0.5 * (low + high);
        if (is_met(equations, t, NULL)) {
            low = t;
        } else {
            high = t;
        }
    }
    return low;
}

/* Whether no prescribed value jumps behind t: that is another reason. */
static int is_smooth(const se3di_equations *equations, double t, double way)
{
    const se3di_assembly *assembly = &equations->assembly;
    const double size = se3di_model_get_size(assembly->model);
    for (uint32_t k = 0; k < assembly->timed_count; ++k) {
        const uint32_t row = assembly->timed_rows[k];
        const se3di_function *f = &assembly->model->functions[assembly->model->rows[row].function];
        const double after = t + 1e-6 * way;
        double jet[3];
        double jet_after[3];
        if (se3di_function_eval(f, &t, jet, NULL) < 0 ||
            se3di_function_eval(f, &after, jet_after, NULL) < 0 ||
            fabs(jet_after[0] - jet[0]) > 1e-3 * se3di_row_get_scale(assembly->model, row, size)) {
            return 0;
        }
    }
    return 1;
}

/* The time of the dead point before t_end; HUGE_VAL if there is none. */
static double find_dead_point(se3di_equations *equations, double t_end)
{
    const double way = t_end - equations->assembly.model->time;
    const double before = measure_speed(equations);
    double speed = 0.0;
    const double t = find_limit(equations, t_end);
    const int is_here = !(t > equations->assembly.model->time);
    const int ends =
        t < t_end && is_smooth(equations, t, way) && (is_here || is_met(equations, t, &speed));
    return ends && (speed > 10.0 * before || before * way > 3.0) ? t : HUGE_VAL;
}

static void describe(const se3di_model *model, uint32_t row, char *text, size_t size)
{
    const se3di_constraint *c = &model->constraints[se3di_row_get_owner(model, row)];
    snprintf(text, size, "%s %.80s", c->type, c->name ? c->name : "without a name");
}

se3d_status se3di_dead_point_explain(se3di_equations *equations, double t_end, se3d_status status)
{
    const se3di_model *model = equations->assembly.model;
    double jet[3];
    char name[128] = "";
    if (!can_be(status) || equations->assembly.timed_count == 0 || !(t_end > model->time)) {
        return status;
    }
    se3di_error before = *equations->error;
    se3di_state_accept(equations);
    const uint32_t row = find_driver(equations);
    const double t = find_dead_point(equations, t_end);
    *equations->error = before;
    if (!(t < t_end) || row == equations->assembly.row_count ||
        se3di_against_is_twice(model, row) ||
        se3di_function_eval(&model->functions[model->rows[row].function], &t, jet, NULL) < 0) {
        return status;
    }
    describe(model, row, name, sizeof name);
    return se3di_error_set(
        equations->error, status,
        "t = %.9g s: %s has reached a dead point of the mechanism at t = %.6g s, "
        "where its value is %.6g%s: it cannot drive the mechanism beyond it",
        model->time, name, t, jet[0], se3di_row_get_unit(model, row));
}
