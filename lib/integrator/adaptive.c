/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/adaptive.h"

#include "assembly/user.h"
#include "contact/bodies/pace.h"
#include "integrator/kink_step.h"
#include "integrator/pulse_step.h"
#include "integrator/state.h"
#include "math/steps.h"

#include <math.h>

int se3di_adaptive_ends(const se3di_integration *integration, const se3di_adaptive_history *at)
{
    return at->renewed > 0.0 || integration->equations->assembly.model->contacts.pair_count > 0;
}

double se3di_adaptive_pace(se3di_adaptive *step, double h)
{
    const se3di_model *model = step->integration->equations->assembly.model;
    return se3di_contacts_pace(model, SE3DI_PACE_ADAPTIVE, se3di_state_limit_turn(model, 0.0, h));
}

double se3di_adaptive_least(const se3di_adaptive *step, double t)
{
    return step->methods->least * fmax(1e-3, fabs(t));
}

double se3di_adaptive_limit(const se3di_integration *integration, double h)
{
    const double limit = integration->settings.step;
    return limit > 0.0 && h > limit ? limit : h;
}

se3d_status se3di_adaptive_blame(const se3di_integration *integration, double t, double h,
                                 se3d_status cause)
{
    const se3di_equations *equations = integration->equations;
    if (cause >= 0) {
        cause = se3di_error_set(equations->error, SE3D_ERR_STEP_SIZE,
                                "t = %g s: the step fell to %.3g s: the tolerance %g cannot be met "
                                "here; the motion is not smooth",
                                t, h, integration->settings.tolerance);
    }
    se3di_contacts_blame(equations->assembly.model, equations->error);
    return cause;
}

int se3di_adaptive_may_shrink(se3d_status status)
{
    return status != SE3D_ERR_INTERRUPTED && status != SE3D_ERR_NO_MEMORY &&
           status != SE3D_ERR_CALLBACK;
}

/* The step is tried once. @return OK with *error above 1: it is rejected */
static se3d_status attempt(se3di_adaptive *step, double h, double *error)
{
    *error = HUGE_VAL;
    step->fraction = 0.0;
    SE3DI_TRY(step->methods->attempt(step, h, error));
    return *error <= 1.0 ? step->methods->accept(step, h, *error) : SE3D_OK;
}

/* Shorter and shorter steps, the first one of `next` to step->t. */
static se3d_status try_steps(se3di_adaptive *step, double next)
{
    const se3di_adaptive_class *methods = step->methods;
    se3di_equations *equations = step->integration->equations;
    const double begin = step->at->time;
    const double least = se3di_adaptive_least(step, begin);
    step->resumed = 0.0;
    for (step->tries = 1;; ++step->tries) {
        const double h = se3di_step_length(begin, step->t, next);
        double error;
        SE3DI_TRY(se3di_equations_try_step(equations, begin));
        const se3d_status status = attempt(step, h, &error);
        if (status < 0 ? !se3di_adaptive_may_shrink(status) : error <= 1.0) {
            return status;
        }
        ++equations->counters.rejected;
        step->at->rejected = 1.0;
        const int has_turned = status >= 0 && step->fraction > 0.0;
        next = h * (has_turned ? step->fraction : methods->shrink(step, h, status, error));
        if (!(next > least)) {
            return methods->surrender(step, h, status, error);
        }
        step->at->next = next;
        step->t = begin + next;
    }
}

static se3d_status advance(se3di_adaptive *step, double t_end)
{
    const se3di_adaptive_history before = *step->at;
    const double rest = t_end - before.time;
    const double paced = step->methods->pace(step, before.next);
    const int ends = step->ends && rest > 0.0 && paced > rest;
    const double whole = ends ? rest : paced;
    const double most =
        se3di_pulse_step(&step->integration->equations->assembly, before.time, whole);
    const int is_cut = ends && !(most < whole);
    step->t = is_cut ? t_end : before.time + most;
    const double h = se3di_kink_step(step->integration, before.time, most, 2.0 * most, &step->t);
    if (step->integration->at_kink) {
        return SE3D_OK;
    }
    const se3d_status status = try_steps(step, h);
    if (status < 0) { /* nothing is learnt from attempts that end the run */
        *step->at = before;
        return status;
    }
    step->at->rejected = 0.0;
    step->at->next = fmax(step->at->next, step->resumed);
    if (is_cut && step->tries == 1) {
        step->at->next = fmax(paced, step->at->next);
    }
    return SE3D_OK;
}

static int has_failed_beyond(const se3di_equations *equations, se3d_status status, double t_end)
{
    const se3di_user_failure *failure = &equations->assembly.model->user_failure;
    if (status == SE3D_ERR_INTERRUPTED || status == SE3D_ERR_NO_MEMORY) {
        return 0;
    }
    return failure->status == SE3D_ERR_CALLBACK
               ? status < 0 && failure->time > t_end
               : status == SE3D_ERR_CALLBACK && equations->assembly.time > t_end;
}

int se3di_adaptive_may_cut(se3di_equations *equations, se3d_status status, double t_end,
                           const se3di_error *told)
{
    if (!has_failed_beyond(equations, status, t_end)) {
        return 0;
    }
    *equations->error = *told;
    se3di_user_begin(equations->assembly.model);
    ++equations->counters.rejected;
    return 1;
}

se3d_status se3di_adaptive_advance(se3di_adaptive *step, double t_end)
{
    se3di_equations *equations = step->integration->equations;
    const se3di_error told = *equations->error;
    const int may_pass = !step->ends && t_end > step->at->time;
    const se3d_status status = advance(step, t_end);
    if (!may_pass || !se3di_adaptive_may_cut(equations, status, t_end, &told)) {
        return status;
    }
    step->ends = 1;
    return advance(step, t_end);
}
