/* SPDX-License-Identifier: BSD-3-Clause */
/* A host that traps divisions by zero (feenableexcept) is not killed: nothing divides by zero if
 * all is well, in any analysis and method. */
#define _GNU_SOURCE
#include <fenv.h>
#include <stdio.h>

#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/methods.h"

static const char *const models[] = {"bar_rsda_tsda",
                                     "double_pendulum",
                                     "fourbar",
                                     "incline_friction",
                                     "pendulum",
                                     "pendulum_events",
                                     "quarter_car",
                                     "spatial_slider_crank",
                                     "planar_slider_crank",
                                     "bar_equilibrium",
                                     "tsda_mass",
                                     "flyball_governor",
                                     "pushed_grains",
                                     "landing_gear",
                                     "andrews"};

/* Analyses that came to their end. */
static int runs;

static void run(const char *model, const char *method, const char *formulation)
{
    char path[300];
    se3d_model *read = NULL;
    se3d_model_error error;
    se3d_model_options how = se3d_model_options_default();
    how.duration = method ? "0.02" : NULL;
    how.method = method;
    how.tolerance = method ? "1e-6" : NULL; /* whatever the method: some are of low order */
    how.formulation = formulation;
    how.analysis = method ? "dynamics" : NULL;
    snprintf(path, sizeof path, "examples/models/%s.yaml", model);
    if (SE3D_FAILED(se3d_model_read_file(path, &how, &read, &error))) {
        CHECK(method != NULL); /* that one takes no such method */
        return;
    }
    for (size_t k = 0; k < se3d_model_count_analyses(read); ++k) {
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        if (SE3D_FAILED(se3d_model_get_solver(read, k, &def)) ||
            SE3D_FAILED(se3d_solver_create(se3d_model_get_system(read), &def, &solver))) {
            continue;
        }
        double time = 0.0;
        se3d_system_get_time(se3d_model_get_system(read), &time);
        runs += !SE3D_FAILED(se3d_solver_run(solver, time)) &&
                !SE3D_FAILED(se3d_solver_run(solver, time + 0.02));
        se3d_solver_destroy(solver);
    }
    se3d_model_destroy(read);
}

static void divisions_are_not_by_zero(void)
{
#if defined(__GLIBC__) && defined(FE_DIVBYZERO)
    CHECK(feenableexcept(FE_DIVBYZERO) >= 0);
    for (size_t k = 0; k < sizeof models / sizeof *models; ++k) {
        run(models[k], NULL, "romega");
        for (int32_t m = 0; m < method_count(); ++m) {
            run(models[k], se3d_method_get_name(m), "romega");
        }
        run(models[k], "radau", "rp");
    }
    fedisableexcept(FE_DIVBYZERO);
    CHECK(runs > 80);
#else
    run(models[0], NULL, "romega");
#endif
}

int main(void)
{
    RUN(divisions_are_not_by_zero);
    return check_finish();
}
