/* SPDX-License-Identifier: BSD-3-Clause */
#include "nonlinear/kink.h"

#include "assembly/energy.h"
#include "base/log.h"

#include <math.h>
#include <string.h>

#define LEAST 1e-6 /* relative: smaller ones are no jump */

/* The impulses of the constraints since equations->probe, the velocities before:
 * C^T L = M (v- - v+). */
static se3d_status find_impulses(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_get_velocity(assembly, equations->x);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->probe[k] = equations->x[k] - equations->probe[k];
        equations->b[k] = 0.0;
    }
    se3di_assembly_subtract_inertia(assembly, equations->probe, equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    return se3di_equations_solve(equations);
}

/* Whether the rate of this row jumps there. */
static int jumps(const se3di_model *model, uint32_t row, const se3di_kink *kink)
{
    const se3di_function *function = &model->functions[model->rows[row].function];
    double before[3], after[3];
    if (row == kink->row) {
        return 1;
    }
    return !function->callback &&
           se3di_function_eval(function, &kink->t_before, before, NULL) >= 0 &&
           se3di_function_eval(function, &kink->t, after, NULL) >= 0 &&
           fabs(after[1] - before[1]) > LEAST * fmax(fmax(fabs(before[1]), fabs(after[1])), 1e-3);
}

static void tell(const se3di_equations *equations, const se3di_kink *kink, double work)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    for (uint32_t timed = 0; timed < assembly->timed_count; ++timed) {
        const uint32_t row = assembly->timed_rows[timed];
        const int turns = strcmp(se3di_row_get_unit(model, row), " rad") == 0;
        char name[128];
        if (!jumps(model, row, kink)) {
            continue;
        }
        se3di_row_name(model, row, name, sizeof name);
        se3di_log_write(equations->error, SE3D_LOG_WARNING, SE3D_LOG_KINK,
                        "t = %.9g s: the rate of %s jumps: an impulse of %.6g %s acts, a reaction "
                        "without bound for no time, and all impulses do the work %.6g J",
                        kink->t, name, -equations->l[row], turns ? "N m s" : "N s", work);
    }
}

/* A value that jumps, with its rate or alone, is no motion. */
static se3d_status refuse_value(const se3di_equations *equations, const se3di_kink *kink)
{
    const double t = equations->assembly.model->time;
    const double length = fmax(kink->t - t, kink->t - kink->t_before);
    return se3di_jump_refuse(&equations->assembly, kink->t, length, equations->error);
}

se3d_status se3di_kink_pass(se3di_equations *equations, const se3di_kink *kink)
{
    se3di_model *model = equations->assembly.model;
    const double before = se3di_kinetic_energy(model);
    SE3DI_TRY(refuse_value(equations, kink));
    model->time = kink->t;
    se3di_assembly_get_velocity(&equations->assembly, equations->probe);
    SE3DI_TRY(se3di_velocity_solve(equations, kink->t));
    SE3DI_TRY(find_impulses(equations));
    const double work = se3di_kinetic_energy(model) - before;
    model->work[2] += work;
    tell(equations, kink, work);
    return SE3D_OK;
}
