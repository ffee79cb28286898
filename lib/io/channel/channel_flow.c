/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of sets and sinks of particles. */
#include "io/channel/channel_flow.h"

#include "io/channel/channel.h"
#include "io/model/grains.h"

/* What the sources of a set have done. */
static se3d_status sum_sources(const se3di_channel *c, double *value)
{
    for (uint32_t k = 0; k < c->grains->source_count; ++k) {
        se3d_particles_source_stats stats;
        if (c->grains->source_tags[k] != c->index) {
            continue;
        }
        const se3d_status status = se3d_particles_get_source_stats(c->particles, k, &stats);
        if (status < 0) {
            return status;
        }
        *value += c->quantity == SE3DI_SET_INSERTED   ? (double)stats.inserted
                  : c->quantity == SE3DI_SET_DEFERRED ? (double)stats.deferred
                                                      : stats.waiting;
    }
    return SE3D_OK;
}

se3d_status se3di_grains_eval(const se3di_channel *c, double *value)
{
    se3d_particles_tally tally;
    uint64_t count = 0;
    se3d_status status;
    *value = 0.0;
    if (c->quantity == SE3DI_SINK_COUNT) {
        status = se3d_particles_get_sink_count(c->particles, c->index, &count);
        *value = (double)count;
        return status;
    }
    if (c->quantity == SE3DI_SET_INSERTED || c->quantity == SE3DI_SET_DEFERRED ||
        c->quantity == SE3DI_SET_WAITING) {
        return sum_sources(c, value);
    }
    status = se3d_particles_get_tally(c->particles, c->index, &tally);
    if (status >= 0) {
        *value = c->quantity == SE3DI_SET_COUNT  ? (double)tally.count
                 : c->quantity == SE3DI_SET_LOST ? (double)tally.lost
                 : c->quantity == SE3DI_SET_LEFT ? (double)(tally.lost + tally.outside)
                 : c->quantity == SE3DI_SET_MASS ? tally.mass
                                                 : tally.energy;
    }
    return status;
}
