/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/fmi/before.h"

#include <float.h>
#include <math.h>

#include "io/channel/event.h"

static se3d_status run_analysis(se3d_model *model, const se3di_analysis_entry *entry, double start,
                                se3d_interrupt interrupt, void *ctx)
{
    const double end = start + entry->analysis.duration;
    se3d_solver_def def = entry->solver;
    se3d_solver *solver = NULL;
    def.horizon = fabs(end) > 0.0 ? end : DBL_MIN; /* 0 means none */
    def.interrupt = interrupt;
    def.interrupt_ctx = ctx;
    se3d_status status = se3d_system_set_time(model->system, start);
    status =
        status < 0 || entry->modes.file ? status : se3d_solver_create(model->system, &def, &solver);
    if (status >= 0 && solver && se3di_analysis_has_motion(entry)) {
        status = se3di_events_create(model, solver, NULL, NULL);
    }
    status = status < 0 || !solver ? status : se3d_solver_run(solver, end);
    se3d_solver_destroy(solver);
    return status;
}

se3d_status se3di_fmi_run_before(se3d_model *model, size_t index, se3d_interrupt interrupt,
                                 void *ctx, double *start, size_t *failed)
{
    se3d_status status = SE3D_OK;
    double time = 0.0;
    for (size_t k = 0; k <= index && k < model->analysis_count && status >= 0; ++k) {
        const se3di_analysis_entry *entry = &model->analyses[k];
        time = isnan(entry->analysis.start) ? time : entry->analysis.start;
        if (k < index) {
            status = run_analysis(model, entry, time, interrupt, ctx);
            se3d_system_get_time(model->system, &time);
            *failed = k;
        }
    }
    *start = time;
    return status < 0 ? status : SE3D_OK;
}
