/* SPDX-License-Identifier: BSD-3-Clause */
/* After a run that failed: why, and back to the last accepted state. */
#include "analysis/crowd.h"
#include "analysis/dead_point.h"
#include "analysis/run_end.h"

#include "assembly/user.h"
#include "integrator/explicit_step.h"
#include "nonlinear/jump.h"

#include <math.h>
#include <string.h>

/* The last accepted step that a method with dense output may show, which has gone on to t_end at
 * least; with events, the last one that they were looked for in. */
static double last_accepted(const se3di_run *run, double t_end)
{
    const se3di_model *model = run->model;
    const int has_history =
        run->integration.method->advance && model->history_tag == se3di_run_get_history_tag(run);
    if (!has_history || run->steps_once) {
        return run->before.time;
    }
    if (run->equations.watch) {
        return run->events.reached;
    }
    if (model->history_inputs != model->inputs_version) { /* that step was under other loads */
        return run->before.time;
    }
    const int passed = model->history[SE3DI_HISTORY_TIME] > t_end;
    if (passed && model->contacts.pair_count > 0) { /* they remember the end of the step */
        return run->before.time;
    }
    return model->history[passed ? SE3DI_HISTORY_BEGIN : SE3DI_HISTORY_TIME];
}

/* The state at t: the end of an accepted step, or the beginning of the one after it. */
static se3d_status show_accepted(se3di_run *run, double t)
{
    se3di_user_begin(run->model);
    return run->integration.method->run(&run->integration, t);
}

static void restore_before(se3di_run *run)
{
    se3di_model *model = run->model;
    if (run->before_version == model->topology_version && se3di_saved_fits(&run->before, model) &&
        se3di_saved_reserve(&run->before, model) >= 0) {
        se3di_saved_restore(&run->before, model);
        if (run->before_waits) {
            se3di_explicit_come_back(&run->integration);
        }
        se3di_events_forget(&run->events, model->time);
    }
}

/* After a failure: the state of the last accepted step, to the bit; or, if its accelerations
 * cannot be computed any more, that of before the call. Methods without dense output, and steps of
 * kinematics, have come back to theirs by themselves. */
static void recover(se3di_run *run, double t_end)
{
    se3di_model *model = run->model;
    const se3di_integrator *method = run->integration.method;
    const se3di_error cause = *run->error;
    if (run->prepared && run->shows_row) { /* by the same interpolation as what was there */
        ++run->guard.muted;
        (void)show_accepted(run, run->events.reached);
        --run->guard.muted;
        *run->error = cause;
        return;
    }
    if (!run->prepared || !run->has_before) {
        return;
    }
    if (run->analysis == SE3D_ANALYSIS_DYNAMICS && method->advance) {
        const double t = last_accepted(run, t_end);
        ++run->guard.muted;
        if (!(t > run->before.time) || show_accepted(run, t) < 0) {
            restore_before(run);
        }
        --run->guard.muted;
    } else if (!(model->time > run->before.time) ||
               !se3di_analysis_is(run->analysis, SE3DI_ANALYSIS_HAS_MOTION)) {
        restore_before(run);
    }
    *run->error = cause;
}

/* If dynamics fails near a prescribed value or rate that jumps, that is why. */
static void blame_jump(const se3di_run *run, double t_end)
{
    const double now = run->model->time;
    const double near = fmax(2.0 * run->integration.settings.step, t_end - now);
    const double range[2] = {now - 1e-9 * fabs(now), now + near}; /* steps may pass t_end */
    se3di_jump jump;
    char text[300];
    if (run->error->cause != SE3DI_CAUSE_JUMP && /* it was not refused */
        se3di_jump_find(&run->equations.assembly, range, 16, 1, &jump)) {
        se3di_jump_format(run->model, &jump, text, sizeof text - sizeof " (");
        se3di_error_wrap(run->error, strcat(text, " ("), ")");
    }
}

/* What touches has more in it than the method can follow. */
static void advise_convex(const se3di_run *run, se3d_status status)
{
    const int stuck = status == SE3D_ERR_STEP_SIZE || status == SE3D_ERR_NO_CONVERGENCE ||
                      status == SE3D_ERR_STEP_COUNT;
    if (stuck && run->error->cause != SE3DI_CAUSE_APART && run->model->contacts.pair_count > 0 &&
        !run->integration.method->takes_crowd && se3di_crowd_suits(run->model)) {
        se3di_error_wrap(run->error, "",
                         "; method convex takes bodies that touch at steps of milliseconds");
    }
}

/* A callback that failed is the reason for whatever else did. */
static se3d_status explain(se3di_run *run, se3d_status status, double t_end)
{
    se3di_model *model = run->model;
    if (status < 0 && run->guard.came) {
        return se3di_error_set(run->error, SE3D_ERR_INTERRUPTED, "interrupted at t = %.9g s",
                               model->time);
    }
    if (status == SE3D_ERR_CALLBACK && model->user_failure.status >= 0) {
        se3di_user_find_failure(model); /* the one that failed as the power was computed */
    }
    if (status < 0 && model->user_failure.status == SE3D_ERR_CALLBACK) {
        return se3di_user_report(model, run->error);
    }
    if (status < 0 && status != SE3D_ERR_NO_MEMORY && status != SE3D_ERR_CALLBACK &&
        run->analysis == SE3D_ANALYSIS_DYNAMICS && !run->refused &&
        se3di_assembly_fits(&run->equations.assembly)) {
        blame_jump(run, t_end);
        advise_convex(run, status);
    }
    return status;
}

se3d_status se3di_run_fail(se3di_run *run, se3d_status status, double t_end)
{
    status = explain(run, status, t_end);
    if (run->error->status != status) { /* the powers of elements have no message of their own */
        se3di_error_set(run->error, status,
                        "t = %.9g s: a function or callback failed, or is not finite, while the "
                        "work of forces and drivers was computed",
                        run->model->time);
    }
    recover(run, t_end);
    if (run->analysis == SE3D_ANALYSIS_DYNAMICS && run->prepared &&
        se3di_assembly_fits(&run->equations.assembly)) {
        return se3di_dead_point_explain(&run->equations, t_end, status); /* from where it is now */
    }
    return status;
}
