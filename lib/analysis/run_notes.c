/* SPDX-License-Identifier: BSD-3-Clause */
/* What the log is told of a run, once. */
#include "analysis/run_end.h"

#include "analysis/crowd.h"
#include "analysis/stiffness.h"
#include "base/log.h"
#include "contact/bodies/crowd.h"
#include "force/force.h"
#include "nonlinear/ranks.h"

#include <math.h>
#include <stdio.h>

#define SHAKEN_STEPS 500  /* on which the average of the steps is taken */
#define SHAKEN_ANGLE 2.0  /* of the vibration in a step that follows it, at most [rad] */
#define SHAKEN_RATIO 1e3  /* of vibrations that nobody wants to see, at least, to the motion */
#define LEFT_OUT_MAX 1e-4 /* how far rows that are left out may be off, relative */

/* The log is told if the tolerance that is asked for is smaller than what the method reaches. */
void se3di_run_tell_reach(se3di_run *run)
{
    const se3di_integration *integration = &run->integration;
    const double tolerance = se3di_integration_get_tolerance(integration, run->model);
    if (tolerance > integration->settings.tolerance && run->told_reach != integration->method) {
        run->told_reach = integration->method;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_TOLERANCE,
                        "t = %g s: the tolerance %g is smaller than what %s reaches; %.3g is used",
                        run->model->time, integration->settings.tolerance,
                        integration->method->name, tolerance);
    }
}

void se3di_run_tell_bodies(se3di_run *run)
{
    const se3di_integrator *method = run->integration.method;
    if (run->formulation->id == SE3D_FORMULATION_JOINT && !run->picks_formulation &&
        !method->is_explicit && run->told_bodies != method) {
        run->told_bodies = method;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_METHOD,
                        "t = %g s: %s works with the coordinates of bodies, as r-omega: joint "
                        "coordinates are integrated by dop853, gauss, rk45 and rk4",
                        run->model->time, method->name);
    }
}

void se3di_run_tell_step(se3di_run *run)
{
    const se3di_integration *integration = &run->integration;
    const se3di_integrator *method = integration->method;
    if (method->takes_crowd && !(integration->settings.step > 0.0) && run->told_step != method &&
        !(se3di_integration_get_tolerance(integration, run->model) > 0.0)) {
        run->told_step = method;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_STEP,
                        "t = %g s: no step is given: %s takes %g s and estimates no error",
                        run->model->time, method->name, integration->settings.step_most);
    }
}

void se3di_run_tell_crowd(se3di_run *run)
{
    const se3di_integrator *method = run->integration.method;
    if (run->told_crowd == method) {
        return;
    }
    const int is_crowd = se3di_crowd_has(run->model, SE3DI_CROWD) && se3di_crowd_suits(run->model);
    if (method->takes_crowd && run->automatic) {
        const char *why = run->left ? "bodies that touch have long held the steps short"
                                    : "its state has been stepped so";
        char many[64];
        snprintf(many, sizeof many, "%d free bodies or more are at each other", SE3DI_CROWD);
        run->told_crowd = method;
        why = is_crowd && se3di_bodies_crowd(run->model) ? many : why;
        se3di_log_write(run->error, SE3D_LOG_INFO, SE3D_LOG_METHOD,
                        "t = %g s: %s: %s takes them, of order 1; with a tolerance, each contact "
                        "is followed",
                        run->model->time, why, method->name);
    }
    if (!method->takes_crowd && is_crowd &&
        run->integration.settings.leaves_crowd == SE3DI_CROWD_NONE) {
        run->told_crowd = method;
        se3di_log_write(run->error, SE3D_LOG_INFO, SE3D_LOG_METHOD,
                        "t = %g s: %s follows each contact of the many bodies that may touch; "
                        "convex takes steps of milliseconds",
                        run->model->time, method->name);
    }
}

void se3di_run_tell_held(se3di_run *run)
{
    const se3di_integration *integration = &run->integration;
    const se3di_integrator *method = integration->method;
    if (method == &se3di_integrator_gauss && integration->settings.leaves_stiff == 0 &&
        run->model->history_tag == se3di_run_get_history_tag(run) && run->told_held != method &&
        method->is_held(integration)) {
        run->told_held = method;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_STEP,
                        "t = %g s: the iterations of %s limit its steps: the motion is stiff; "
                        "radau takes longer ones",
                        run->model->time, method->name);
    }
}

void se3di_run_tell_shaken(se3di_run *run, double begin, uint64_t steps)
{
    const se3di_integration *integration = &run->integration;
    const se3di_model *model = run->model;
    const se3di_force *force;
    run->shaken_steps += run->equations.counters.steps - steps;
    run->shaken_time += fabs(model->time - begin);
    if (run->shaken_steps < SHAKEN_STEPS || run->told_shaken == integration->method) {
        return;
    }
    const double h = run->shaken_time / (double)run->shaken_steps;
    const double rate = se3di_stiffness_vibration(model, &force);
    const int is_controlled = se3di_integration_get_tolerance(integration, model) > 0.0;
    if (is_controlled && h * rate < SHAKEN_ANGLE &&
        rate > SHAKEN_RATIO * se3di_stiffness_motion(model)) {
        run->told_shaken = integration->method;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_STEP,
                        "t = %g s: the steps of %s are %.2g s on the average, as short as to "
                        "follow a vibration of %.2g rad/s; it may be that of %s \"%s\", which is "
                        "stiff and hardly damped: damp it, or take a joint in its place",
                        model->time, integration->method->name, h, rate,
                        se3di_force_class_of(force)->name, force->name ? force->name : "");
    }
    run->shaken_steps = 0;
    run->shaken_time = 0.0;
}

/* A row that was left out constrains the mechanism after all. */
static void warn_of_rows(se3di_run *run)
{
    se3di_model *model = run->model;
    char name[128];
    if (!(model->left_out_gap > LEFT_OUT_MAX) || run->told_left_out) {
        return;
    }
    run->told_left_out = 1;
    se3di_row_name(model, model->left_out_row, name, sizeof name);
    se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_LEFT_OUT,
                    "t = %g s: the equation %s was left out, as it seemed to be redundant but for "
                    "the digits of its data, but the mechanism has left it by %.2g of its size: "
                    "give positions, axes and dimensions more digits",
                    model->time, name, model->left_out_gap);
}

/* Which rows are not among the equations. */
static void tell_rows(se3di_run *run)
{
    char rows[400];
    const unsigned count = run->model->left_out_count - run->model->broken_count;
    if (count == 0 || run->told_redundant) {
        return;
    }
    run->told_redundant = 1;
    se3di_ranks_describe(run->model, rows, sizeof rows);
    se3di_log_write(
        run->error, SE3D_LOG_INFO, SE3D_LOG_LEFT_OUT,
        "t = %g s: %u equation%s redundant but for the digits of %s data, and left out: "
        "%s",
        run->model->time, count, count == 1 ? " is" : "s are", count == 1 ? "its" : "their", rows);
}

se3d_status se3di_run_inform(se3di_run *run)
{
    tell_rows(run);
    warn_of_rows(run);
    run->equations.redundant |= run->model->left_out_count > run->model->broken_count;
    if (run->equations.redundant && !run->told_redundant) {
        run->told_redundant = 1;
        se3di_log_write(run->error, SE3D_LOG_WARNING, SE3D_LOG_REDUNDANT,
                        "t = %g s: there are redundant constraints; their reactions are the "
                        "minimum-norm ones; se3d_check names them",
                        run->model->time);
    }
    run->model->history_redundant = run->equations.redundant;
    return run->equations.redundant ? SE3D_INFO_REDUNDANT : SE3D_OK;
}
