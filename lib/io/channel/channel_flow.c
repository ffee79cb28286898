/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of sets and sinks of particles. */
#include "io/channel/channel_flow.h"

#include "io/channel/channel.h"
#include "io/model/tagged.h"
#include "se3d/average.h"
#include "se3d/bond.h"
#include "se3d/cell.h"
#include "se3d/flow.h"
#include "se3d/servo.h"

/* What the sources of the set have done. */
se3d_status se3di_tagged_ask_sources(const se3di_channel *c, double numbers[3])
{
    for (uint32_t k = 0; k < c->tagged->source_count; ++k) {
        se3d_particles_source_stats stats;
        if (c->tagged->source_tags[k] != c->index) {
            continue;
        }
        const se3d_status status = se3d_particles_get_source_stats(c->particles, k, &stats);
        if (status < 0) {
            return status;
        }
        numbers[0] += (double)stats.inserted;
        numbers[1] += (double)stats.deferred;
        numbers[2] += stats.waiting;
    }
    return SE3D_OK;
}

se3d_status se3di_tagged_ask_tally(const se3di_channel *c, double numbers[7])
{
    se3d_particles_tally tally;
    const se3d_status status = se3d_particles_get_tally(c->particles, c->index, &tally);
    if (status >= 0) {
        numbers[0] = (double)tally.count;
        numbers[1] = (double)tally.lost;
        numbers[2] = (double)(tally.lost + tally.outside);
        numbers[3] = tally.mass;
        numbers[4] = tally.energy;
        numbers[5] = tally.kinetic;
        numbers[6] = tally.rotation;
    }
    return status;
}

se3d_status se3di_tagged_ask_sink(const se3di_channel *c, double *count)
{
    uint64_t absorbed = 0;
    const se3d_status status = se3d_particles_get_sink_count(c->particles, c->index, &absorbed);
    *count = (double)absorbed;
    return status;
}

/* Stress is that of contacts and motion together: xx, yy, zz, then yz, zx, xy. */
se3d_status se3di_tagged_ask_average(const se3di_channel *c, double numbers[17])
{
    static const int order[6] = {0, 1, 2, 4, 5, 3};
    const se3di_region_entry *region = &c->tagged->regions[c->index];
    se3d_average average;
    const se3d_status status = se3d_particles_get_average(c->particles, region->lower,
                                                          region->upper, region->tag, &average);
    if (status >= 0) {
        numbers[0] = (double)average.count;
        numbers[1] = average.mass;
        numbers[2] = average.solid_fraction;
        numbers[3] = average.coordination;
        numbers[4] = average.temperature;
        for (int k = 0; k < 3; ++k) {
            numbers[5 + k] = average.velocity[k];
            numbers[8 + k] = average.mass_flux[k];
        }
        for (int k = 0; k < 6; ++k) {
            numbers[11 + k] = average.kinetic_stress[order[k]] + average.contact_stress[order[k]];
        }
    }
    return status;
}

se3d_status se3di_tagged_ask_passed(const se3di_channel *c, double numbers[12])
{
    se3d_flow_stats stats;
    const se3d_status status = se3d_particles_get_flow(c->particles, c->index, &stats);
    if (status >= 0) {
        numbers[0] = (double)stats.forward - (double)stats.backward;
        numbers[1] = (double)stats.forward;
        numbers[2] = (double)stats.backward;
        numbers[3] = stats.mass;
        numbers[7] = stats.count_rate;
        numbers[8] = stats.mass_rate;
        for (int k = 0; k < 3; ++k) {
            numbers[4 + k] = stats.momentum[k];
            numbers[9 + k] = stats.momentum_rate[k];
        }
    }
    return status;
}

se3d_status se3di_tagged_ask_dissipation(const se3di_channel *c, double numbers[8])
{
    se3d_particles_dissipation d;
    const se3d_status status = se3d_particles_get_dissipation(c->particles, &d);
    if (status >= 0) {
        numbers[0] = d.normal;
        numbers[1] = d.tangential;
        numbers[2] = d.rolling;
        numbers[3] = d.torsion;
        numbers[4] = d.bonds;
        numbers[5] = d.normal + d.tangential + d.rolling + d.torsion + d.bonds;
        numbers[6] = d.elastic;
        numbers[7] = d.wall_work;
    }
    return status;
}

se3d_status se3di_tagged_ask_servo(const se3di_channel *c, double numbers[5])
{
    se3d_servo_state servo;
    const se3d_status status = se3d_particles_get_servo(c->particles, c->index, &servo);
    if (status >= 0) {
        numbers[0] = servo.position;
        numbers[1] = servo.speed;
        numbers[2] = servo.force;
        numbers[3] = servo.wanted;
        numbers[4] = servo.work;
    }
    return status;
}

/* Stresses in the order of a region's. */
se3d_status se3di_tagged_ask_cell(const se3di_channel *c, double numbers[22])
{
    static const int order[6] = {0, 1, 2, 4, 5, 3};
    se3d_cell_state cell;
    const se3d_status status = se3d_particles_get_cell(c->particles, &cell);
    if (status >= 0) {
        numbers[3] = cell.offset;
        numbers[7] = cell.shear_strain;
        numbers[11] = cell.shear_rate;
        numbers[18] = cell.volume;
        numbers[19] = cell.solid_fraction;
        numbers[20] = cell.kinetic_energy;
        numbers[21] = cell.work;
        for (int k = 0; k < 3; ++k) {
            numbers[k] = cell.upper[k] - cell.lower[k];
            numbers[4 + k] = cell.strain[k];
            numbers[8 + k] = cell.rate[k];
        }
        for (int k = 0; k < 6; ++k) {
            numbers[12 + k] = cell.stress[order[k]];
        }
    }
    return status;
}

se3d_status se3di_tagged_ask_bonds(const se3di_channel *c, double numbers[10])
{
    se3d_bond_stats stats;
    const se3d_status status =
        se3d_particles_get_bond_stats(c->particles, (int32_t)c->index, &stats);
    if (status >= 0) {
        numbers[0] = (double)stats.count;
        numbers[1] = (double)(stats.torn + stats.sheared);
        numbers[2] = (double)stats.torn;
        numbers[3] = (double)stats.sheared;
        numbers[4] = (double)stats.lost;
        numbers[5] = stats.energy;
        numbers[6] = stats.dissipated;
        numbers[7] = stats.released;
        numbers[8] = stats.tension;
        numbers[9] = stats.shear;
    }
    return status;
}
