/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/run/run_record.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *se3di_run_copy_text(se3di_runner *r, const char *text)
{
    const char *copy = se3di_iopool_copy(&r->run->pool, text, strlen(text));
    return copy ? copy : "";
}

static const char *name_of_body(se3di_runner *r, se3d_body body)
{
    const char *name = "";
    if (SE3D_FAILED(se3d_body_get_name(r->model->system, body, &name))) {
        return "";
    }
    return se3di_run_copy_text(r, name[0] ? name : "without a name");
}

static const char *copy_left_out(se3di_runner *r)
{
    char rows[600] = "";
    se3d_system_describe_left_out(r->model->system, rows, sizeof rows);
    return se3di_run_copy_text(r, rows);
}

/* How the start was changed, and which equations do not count. */
static void record_start(se3di_runner *r, se3d_run_analysis *done)
{
    se3d_start_change change;
    memset(&change, 0, sizeof change);
    if (r->solver) {
        se3d_solver_get_start_change(r->solver, &change);
    }
    const double numbers[8] = {change.position,      change.rotation,
                               change.velocity,      change.angular_velocity,
                               change.most_position, change.most_rotation,
                               change.most_velocity, change.most_angular_velocity};
    memcpy(done->start_change, numbers, sizeof numbers);
    done->left_out = copy_left_out(r);
    done->moved = name_of_body(r, change.moved);
    done->deflected = name_of_body(r, change.deflected);
}

/* A given step that particles are too stiff for has been shortened. */
static void warn_of_step(const se3di_runner *r, const se3di_analysis_entry *entry, double step)
{
    char text[200];
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_system_get_contact(r->model->system, &contact);
    if (r->model->log && !(contact.step > 0.0) && r->model->particles && step > 0.0 &&
        step < 0.999 * entry->solver.step) {
        snprintf(text, sizeof text,
                 "steps of %.3g s in place of %.3g s, which contacts of particles do not allow; "
                 "only the `step` of `contact` sets longer ones",
                 step, entry->solver.step);
        r->model->log(r->model->log_ctx, SE3D_LOG_WARNING, SE3D_LOG_STEP, text);
    }
}

void se3di_run_record(se3di_runner *r, const se3di_analysis_entry *entry, double cpu_time,
                      se3d_run_analysis *done)
{
    const char *method = "";
    const char *left = "";
    done->left_at = (double)NAN;
    se3d_system_get_time(r->model->system, &r->time);
    done->end = r->time;
    done->cpu_time = cpu_time;
    if (r->solver) {
        se3d_solver_get_stats(r->solver, &done->stats);
        se3d_solver_get_formulation(r->solver, &done->formulation);
        if (entry->solver.analysis == SE3D_ANALYSIS_DYNAMICS) {
            se3d_solver_get_method(r->solver, &method);
            se3d_solver_get_switch(r->solver, &done->left_at, &left);
            se3d_solver_get_tolerance(r->solver, &done->reached);
            se3d_solver_get_step(r->solver, &done->step);
            warn_of_step(r, entry, done->step);
            const double asked = entry->solver.tolerance > 0.0 ? entry->solver.tolerance : 1e-6;
            done->tolerance = done->reached > 0.0 ? asked : 0.0;
        }
    }
    done->method = se3di_run_copy_text(r, method ? method : "");
    done->left = se3di_run_copy_text(r, left);
    record_start(r, done);
}
