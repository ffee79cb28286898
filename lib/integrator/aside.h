/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps on trial, from which the caller comes back: nobody counts or watches them, nor hears of
 * their failures, but an interruption stays one. */
#ifndef SE3DI_ASIDE_H
#define SE3DI_ASIDE_H

#include "nonlinear/equations.h"

typedef struct se3di_aside {
    se3di_equations *equations;
    const se3di_watch *watch;
    se3di_error *error;
    se3di_counters counters;
    se3di_guard guard;
    se3di_error ignored;
} se3di_aside;

/* To be ended before `aside` goes. */
static inline void se3di_aside_begin(se3di_aside *aside, se3di_equations *equations)
{
    *aside = (se3di_aside){.equations = equations,
                           .watch = equations->watch,
                           .error = equations->error,
                           .counters = equations->counters};
    if (equations->guard) {
        aside->guard = *equations->guard;
    }
    equations->watch = NULL;
    equations->error = &aside->ignored;
}

/* @return `status` if it ends the run, told as it was; else OK */
static inline se3d_status se3di_aside_end(const se3di_aside *aside, se3d_status status)
{
    se3di_equations *equations = aside->equations;
    equations->watch = aside->watch;
    equations->error = aside->error;
    equations->counters.steps = aside->counters.steps;
    if (equations->guard) {
        const int32_t came = equations->guard->came;
        *equations->guard = aside->guard;
        equations->guard->came = came;
    }
    return status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED
               ? se3di_error_set(aside->error, status, "%s", aside->ignored.message)
               : SE3D_OK;
}

#endif
