/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles during a run. In dynamics the solver moves them with the bodies; in
 * kinematics they follow the bodies, whose motion is given. */
#include "io/run/run_particles.h"

#include <math.h>

#include "io/base/pool.h"
#include "io/model/model.h"
#include "io/model/tagged.h"

se3d_status se3di_tagged_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time)
{
    const se3di_tagged *particles = model->particles;
    if (def->analysis == SE3D_ANALYSIS_DYNAMICS) {
        return se3d_solver_run(solver, time);
    }
    double now = 0.0;
    double step = 0.0;
    se3d_status status = se3d_particles_get_time(particles->set, &now);
    if (status >= 0) {
        status = se3d_particles_get_step(particles->set, &step);
    }
    const double whole =
        particles->moving_walls && step > 0.0 ? fmax(1.0, ceil((time - now) / step - 1e-9)) : 1.0;
    se3d_status last = SE3D_OK;
    for (double k = 1.0; k <= whole && status >= 0; k += 1.0) {
        const double target = k < whole ? now + (time - now) * (k / whole) : time;
        last = se3d_solver_run(solver, target);
        status = last;
        double reached = target; /* less if an event has stopped the bodies */
        if (status >= 0) {
            status = se3d_system_get_time(model->system, &reached);
        }
        if (status >= 0 && reached > now) {
            status = se3d_particles_run(particles->set, reached);
        }
        if (last == SE3D_INFO_EVENT) {
            break;
        }
    }
    return status < 0 ? status : last;
}

/* Of one name. */
static se3d_status sum_up(const se3di_tagged *particles, uint32_t tag, se3d_run_particles *sum)
{
    se3d_particles_tally tally;
    se3d_status status = se3d_particles_get_tally(particles->set, tag, &tally);
    *sum = (se3d_run_particles){.name = tag > 0 ? particles->sets[tag] : "particles"};
    if (status >= 0) {
        sum->count = tally.count;
        sum->left = tally.lost + tally.outside;
    }
    for (uint32_t k = 0; k < particles->source_count && status >= 0; ++k) {
        se3d_particles_source_stats stats;
        if (particles->source_tags[k] == tag) {
            status = se3d_particles_get_source_stats(particles->set, k, &stats);
            sum->inserted += status >= 0 ? stats.inserted : 0;
            sum->deferred += status >= 0 ? stats.deferred : 0;
        }
    }
    return status;
}

se3d_status se3di_tagged_sum_up(const se3di_tagged *particles, se3di_iopool *pool,
                                se3d_run_particles **out, size_t *count)
{
    se3d_run_particles *sums = se3di_iopool_array(pool, particles->set_count, sizeof *sums);
    se3d_status status = sums ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    *count = 0;
    for (uint32_t tag = 0; tag < particles->set_count && status >= 0; ++tag) {
        se3d_run_particles *sum = &sums[*count];
        status = sum_up(particles, tag, sum);
        *count += sum->count + sum->left + sum->inserted > 0 ? 1 : 0;
    }
    *out = sums;
    return status;
}
