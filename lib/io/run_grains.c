/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles during a run. In dynamics the solver moves them with the bodies; in
 * kinematics they follow the bodies, whose motion is given. */
#include <math.h>
#include <string.h>

#include "io/grains.h"

se3d_status se3di_grains_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time)
{
    const se3di_grains *grains = model->grains;
    if (def->analysis == SE3D_ANALYSIS_DYNAMICS) {
        return se3d_solver_run(solver, time);
    }
    double now = 0.0;
    double step = 0.0;
    se3d_status status = se3d_particles_get_time(grains->set, &now);
    if (status >= 0) {
        status = se3d_particles_get_step(grains->set, &step);
    }
    const double whole =
        grains->moving_walls && step > 0.0 ? fmax(1.0, ceil((time - now) / step - 1e-9)) : 1.0;
    se3d_status last = SE3D_OK;
    for (double k = 1.0; k <= whole && status >= 0; k += 1.0) {
        const double target = k < whole ? now + (time - now) * (k / whole) : time;
        last = se3d_solver_run(solver, target);
        status = last;
        double reached = target; /* less where an event has stopped the bodies */
        if (status >= 0) {
            status = se3d_system_get_time(model->system, &reached);
        }
        if (status >= 0 && reached > now) {
            status = se3d_particles_run(grains->set, reached);
        }
        if (last == SE3D_INFO_EVENT) {
            break;
        }
    }
    return status < 0 ? status : last;
}

const char *se3di_grains_get_column(size_t k)
{
    static const char *const names[SE3DI_GRAIN_COLUMNS] = {
        "time", "id", "radius", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"};
    return names[k];
}

se3d_status se3di_grains_get_rows(const se3di_grains *grains, se3di_iopool *pool, double **rows,
                                  size_t *count)
{
    enum { WIDTH = SE3DI_GRAIN_COLUMNS };
    const size_t n = se3d_particles_count(grains->set);
    uint32_t *ids = se3di_iopool_array(pool, n + 1, sizeof *ids);
    double *numbers = se3di_iopool_array(pool, 10 * n + 1, sizeof *numbers);
    double *out = se3di_iopool_array(pool, WIDTH * n + 1, sizeof *out);
    double time = 0.0;
    if (!ids || !numbers || !out) {
        return SE3D_ERR_NO_MEMORY;
    }
    double *vectors[3] = {numbers + n, numbers + 4 * n, numbers + 7 * n};
    se3d_status status = se3d_particles_get_time(grains->set, &time);
    if (status >= 0) {
        status = se3d_particles_get_ids(grains->set, n, ids);
    }
    if (status >= 0) {
        status = se3d_particles_get_radii(grains->set, n, numbers);
    }
    if (status >= 0) {
        status = se3d_particles_get_all(grains->set, n, vectors[0], vectors[1], vectors[2]);
    }
    for (size_t k = 0; k < n && status >= 0; ++k) {
        double *row = out + WIDTH * k;
        row[0] = time;
        row[1] = (double)ids[k];
        row[2] = numbers[k];
        for (size_t v = 0; v < 3; ++v) {
            memcpy(row + 3 + 3 * v, vectors[v] + 3 * k, 3 * sizeof *row);
        }
    }
    *rows = out;
    *count = status < 0 ? 0 : n;
    return status;
}
