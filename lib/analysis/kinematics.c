/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion under drivers (kinematics and inverse dynamics): at each time the positions follow from a
 * prediction by Newton, then velocities, accelerations and multipliers from one factorisation each
 * (Haug 1989, ch. 3, 11). docs/theory/kinematics.md */
#include "analysis/run.h"

#include "analysis/driver_step.h"
#include "analysis/friction_start.h"
#include "analysis/singular.h"
#include "assembly/energy.h"
#include "assembly/loads.h"
#include "integrator/turns.h"
#include "math/steps.h"
#include "nonlinear/jump.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define TURN_MAX     0.3 /* rad a body may turn in one step, so that the branch is kept */
#define HALVINGS_MAX 6
#define NEAR         1e-8 /* probe: velocities are no longer exact */
#define AT           1e-5 /* probe: they do not follow from the constraints */
#define STEPS_MAX    2e4  /* of one run; a motion that asks for more runs into a locked position */

/* Poses at t + h on the parabola of the present velocities and accelerations. */
static void predict(se3di_equations *equations, double h)
{
    se3di_assembly *assembly = &equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_get_acceleration(assembly, equations->b);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->x[k] = h * (equations->x[k] + 0.5 * h * equations->b[k]);
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->move(frame, equations->x + k * block);
    }
}

se3d_status se3di_kinematics_advance(se3di_equations *equations, double t)
{
    predict(equations, t - equations->assembly.model->time);
    SE3DI_TRY(se3di_state_solve(equations, t));
    if (equations->audits) {
        SE3DI_TRY(se3di_friction_follow(equations, t));
    }
    equations->assembly.model->time = t;
    return SE3D_OK;
}

/* The state at t by the motion on both sides; on failure that of before. */
static se3d_status pass(se3di_equations *equations, double t)
{
    se3di_model *model = equations->assembly.model;
    double start = model->time;
    se3di_state_restore(equations);
    se3d_status status = se3di_singular_pass(equations, t);
    if (status < 0) {
        se3di_state_restore(equations);
        model->time = start;
    }
    return status;
}

/* The state at t from the accepted one; if the constraints lose rank by another way. */
static se3d_status reach(se3di_equations *equations, double t)
{
    se3di_model *model = equations->assembly.model;
    double start = model->time;
    double off = 0.0;
    uint32_t body;
    se3d_status status = se3di_kinematics_advance(equations, t);
    if (status >= 0) {
        status = se3di_equations_probe(equations, &off, &body);
    }
    if (status == SE3D_ERR_CALLBACK || (status >= 0 && off <= NEAR)) {
        return status;
    }
    se3di_error reason = *equations->error;
    model->time = start;
    se3d_status passed = pass(equations, t);
    if (passed >= 0 || passed == SE3D_ERR_NO_MEMORY || off > AT) {
        return passed;
    }
    *equations->error = reason;
    return status < 0 ? status : se3di_kinematics_advance(equations, t);
}

/* Through the nodes of Gauss-Lobatto's rule with four points; the works by it. */
static se3d_status step_with_works(se3di_equations *equations, double h)
{
    static const double nodes[3] = {0.27639320225002103036, 0.72360679774997896964, 1.0};
    static const double weights[3] = {5.0 / 12.0, 5.0 / 12.0, 1.0 / 12.0};
    se3di_model *model = equations->assembly.model;
    const double start = model->time;
    double work[3], power[3];
    for (int k = 0; k < 3; ++k) {
        work[k] = model->work[k] + h * model->power[k] / 12.0;
    }
    for (int node = 0; node < 3; ++node) {
        se3d_status status = reach(equations, start + nodes[node] * h);
        status = status < 0 ? status : se3di_loads_power(model, model->time, power);
        if (status < 0) {
            model->time = start;
            return status;
        }
        se3di_angles_accept(model);
        se3di_stops_accept(model);
        for (int k = 0; k < 3; ++k) {
            work[k] += h * weights[node] * power[k];
        }
    }
    memcpy(model->work, work, sizeof model->work);
    memcpy(model->power, power, sizeof model->power);
    return SE3D_OK;
}

/* Through one step, without what contacts remember of its end. */
static se3d_status pass_step(se3di_equations *equations, double h)
{
    if (equations->audits) {
        return step_with_works(equations, h);
    }
    SE3DI_TRY(reach(equations, equations->assembly.model->time + h));
    se3di_angles_accept(equations->assembly.model);
    return SE3D_OK;
}

se3d_status se3di_kinematics_step(se3di_equations *equations, double h)
{
    se3di_model *model = equations->assembly.model;
    const double start = model->time;
    SE3DI_TRY(se3di_turns_check(equations, h, HUGE_VAL));
    SE3DI_TRY(pass_step(equations, h));
    const se3d_status status = se3di_contacts_prepare(model, model->time, equations->error);
    if (status < 0) {
        model->time = start;
        return status;
    }
    se3di_contacts_accept(model);
    ++equations->counters.steps;
    return SE3D_OK;
}

/* A step of less than the rounding of the time would be made for ever. */
static int moves_on(const se3di_equations *equations, double h)
{
    const double t = equations->assembly.model->time;
    return t + h > t;
}

/* Length of the next step: at most `step`, at least `shortest`, and no body turns by more than
 * TURN_MAX. */
static double choose_step(const se3di_equations *equations, double remaining, double step,
                          double shortest)
{
    const se3di_assembly *assembly = &equations->assembly;
    double h = step > 0.0 ? remaining / se3di_steps_count(remaining, step,
                                                          assembly->model->time + remaining)
                          : remaining;
    double turn = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        const double *w = assembly->model->frames[body].w;
        const double *wdot = assembly->model->acceleration + 6 * body + 3;
        for (int c = 0; c < 3; ++c) {
            turn = fmax(turn, h * (fabs(w[c]) + 0.5 * h * fabs(wdot[c])));
        }
    }
    double slow = turn > TURN_MAX ? h / ceil(turn / TURN_MAX) : h;
    h = fmin(remaining, fmax(slow, shortest));
    return moves_on(equations, h) ? h : remaining;
}

static int shorter_may_help(se3d_status status)
{
    return status < 0 && status != SE3D_ERR_CALLBACK && status != SE3D_ERR_SINGULAR &&
           status != SE3D_ERR_NO_MEMORY && status != SE3D_ERR_INTERRUPTED;
}

/* A step of h from the accepted state, or of a half of it, of a quarter ...; *h becomes the one
 * that was made, to t_end exactly if `last` stays. */
static se3d_status step_or_less(se3di_equations *equations, double t_end, double *h, int *last)
{
    const se3di_model *model = equations->assembly.model;
    se3d_status status = SE3D_OK;
    for (int k = 0; k <= HALVINGS_MAX; ++k, *h *= 0.5) {
        const double whole = t_end - model->time;
        const double wanted = *h * (1.0 + 1e-9) >= whole ? whole : *h;
        *h = se3di_driver_step(equations, wanted);
        *last = !(*h < whole);
        SE3DI_TRY(se3di_equations_try_step(equations, model->time));
        status = se3di_kinematics_step(equations, *h);
        if (status >= 0) {
            return status;
        }
        if (!shorter_may_help(status)) {
            break;
        }
        ++equations->counters.rejected;
        se3di_equations_come_back(equations);
        if (!moves_on(equations, 0.5 * *h)) {
            break;
        }
    }
    return status;
}

se3d_status se3di_kinematics_run(se3di_equations *equations, double t_end, double step)
{
    se3di_model *model = equations->assembly.model;
    double shortest = (t_end - model->time) / STEPS_MAX;
    shortest = step > 0.0 ? fmin(shortest, step) : shortest;
    while (model->time < t_end) {
        double h = choose_step(equations, t_end - model->time, step, shortest);
        SE3DI_TRY(se3di_jump_refuse(&equations->assembly, model->time + h, h, equations->error));
        int last = 0;
        se3di_state_accept(equations);
        SE3DI_TRY(se3di_equations_keep(equations));
        SE3DI_TRY(se3di_watch_begin(equations));
        const se3d_status stepped = step_or_less(equations, t_end, &h, &last);
        if (stepped < 0) {
            se3di_equations_come_back(equations);
            return stepped;
        }
        if (last) {
            model->time = t_end;
        }
        const se3d_status status = se3di_watch_end(equations);
        if (status != SE3D_OK) {
            return status;
        }
    }
    return SE3D_OK;
}
