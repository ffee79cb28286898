/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic cells that strain. */
#include "particles/cell.h"

#include "base/sized.h"
#include "math/elementary.h"
#include "particles/average.h"
#include "particles/energy.h"
#include "particles/list.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

#define MOST      1e30
#define RATE_MOST 1e12

void se3d_cell_def_init(se3d_cell_def *def, size_t size)
{
    se3d_cell_def defaults = {
        .struct_size = size, .gradient = 2, .rate_max = {1.0, 1.0, 1.0}, .shear_rate_max = 1.0};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_servo(se3d_system *system, const se3d_cell_def *def, int a)
{
    if (!def->servo[a]) {
        return SE3D_OK;
    }
    if (def->rate[a] != 0.0) {
        return SE3DI_FAIL_OF(system, "rate", SE3D_ERR_INVALID_ARGUMENT,
                             "[%d] = %g 1/s, must be 0 beside servo: the stress gives it", a,
                             def->rate[a]);
    }
    if (!(def->rate_max[a] > 0.0)) {
        return SE3DI_FAIL_OF(system, "rate_max", SE3D_ERR_INVALID_ARGUMENT,
                             "[%d] = %g 1/s, must be > 0 with servo", a, def->rate_max[a]);
    }
    if (def->gain[a] == 0.0 && def->stress[a] == 0.0) {
        return SE3DI_FAIL_OF(system, "gain", SE3D_ERR_INVALID_ARGUMENT,
                             "[%d] = 0, must be > 0 with stress[%d] = 0", a, a);
    }
    return SE3D_OK;
}

static se3d_status check_shear_servo(se3d_system *system, const se3d_cell_def *def)
{
    SE3DI_TRY(se3di_check_range(system, "shear_stress", def->shear_stress, -MOST, MOST));
    SE3DI_TRY(se3di_check_range(system, "shear_rate_max", def->shear_rate_max, 0.0, RATE_MOST));
    SE3DI_TRY(se3di_check_range(system, "shear_gain", def->shear_gain, 0.0, MOST));
    if (!def->shear_servo) {
        return SE3D_OK;
    }
    if (def->shear_rate != 0.0) {
        return SE3DI_FAIL_OF(system, "shear_rate", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g 1/s, must be 0 beside shear_servo: the stress gives it",
                             def->shear_rate);
    }
    if (!(def->shear_rate_max > 0.0)) {
        return SE3DI_FAIL_OF(system, "shear_rate_max", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g 1/s, must be > 0 with shear_servo", def->shear_rate_max);
    }
    if (def->shear_gain == 0.0 && def->shear_stress == 0.0) {
        return SE3DI_FAIL_OF(system, "shear_gain", SE3D_ERR_INVALID_ARGUMENT,
                             " = 0, must be > 0 with shear_stress = 0");
    }
    return SE3D_OK;
}

/* Axes that keep the volume have no rate of their own, and leave one that has. */
static se3d_status check_volume(se3d_system *system, const se3d_cell_def *def)
{
    for (int a = 0; a < 3; ++a) {
        if (def->volume[a] && (def->servo[a] || def->rate[a] != 0.0)) {
            return SE3DI_FAIL_OF(system, "volume", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%d] = %d, must be 0 beside a rate or servo of this axis", a,
                                 (int)def->volume[a]);
        }
    }
    if (def->volume[0] && def->volume[1] && def->volume[2]) {
        return SE3DI_FAIL_OF(system, "volume", SE3D_ERR_INVALID_ARGUMENT,
                             " is set for all axes, must leave one that strains as it is told");
    }
    return SE3D_OK;
}

static se3d_status check_axes(se3d_system *system, const se3d_cell_def *def)
{
    if (def->flow < 0 || def->flow > 2) {
        return SE3DI_FAIL_OF(system, "flow", SE3D_ERR_INVALID_ARGUMENT, " = %d, must be 0, 1 or 2",
                             (int)def->flow);
    }
    if (def->gradient < 0 || def->gradient > 2 || def->gradient == def->flow) {
        return SE3DI_FAIL_OF(system, "gradient", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 0, 1 or 2, and not flow = %d", (int)def->gradient,
                             (int)def->flow);
    }
    return SE3D_OK;
}

static se3d_status check_cell(se3d_system *system, const se3d_cell_def *def)
{
    SE3DI_TRY(se3di_check_range(system, "start", def->start, -MOST, MOST));
    SE3DI_TRY(se3di_check_range(system, "shear_rate", def->shear_rate, -RATE_MOST, RATE_MOST));
    for (int a = 0; a < 3; ++a) {
        SE3DI_TRY(se3di_check_range(system, "rate", def->rate[a], -RATE_MOST, RATE_MOST));
        SE3DI_TRY(se3di_check_range(system, "stress", def->stress[a], -MOST, MOST));
        SE3DI_TRY(se3di_check_range(system, "rate_max", def->rate_max[a], 0.0, RATE_MOST));
        SE3DI_TRY(se3di_check_range(system, "gain", def->gain[a], 0.0, MOST));
        SE3DI_TRY(check_servo(system, def, a));
    }
    SE3DI_TRY(check_shear_servo(system, def));
    SE3DI_TRY(check_volume(system, def));
    return check_axes(system, def);
}

static int shears(const se3d_cell_def *def)
{
    return def->shear_rate != 0.0 || def->shear_servo;
}

/* What of the set the stage does not fit. */
static se3d_status check_set(const se3d_particles *particles, const se3d_cell_def *def)
{
    const se3di_particles *set = &particles->set;
    const se3di_domain *cell = &set->cell;
    for (int a = 0; a < 3; ++a) {
        if (set->boundary[a] != SE3DI_BOUNDARY_PERIODIC) {
            return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                              "the domain is not periodic along %c, must be along all axes to "
                              "strain",
                              "xyz"[a]);
        }
    }
    for (size_t k = 0; k < set->count; ++k) {
        if (se3di_particle_is_fixed(&set->particles[k])) {
            return SE3DI_FAIL(
                particles->system, SE3D_ERR_STATE,
                "particle %u is fixed, which those of a domain that strains cannot be",
                set->spins[k].id);
        }
    }
    if (cell->count == SE3D_CELL_STAGES) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                          "the cell has %d stages, which is the most", SE3D_CELL_STAGES);
    }
    if (cell->count > 0 && !(def->start > cell->stages[cell->count - 1].start)) {
        return SE3DI_FAIL_OF(particles->system, "start", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be after that of the stage before, %g s", def->start,
                             cell->stages[cell->count - 1].start);
    }
    for (size_t k = 0; k < cell->count && shears(def); ++k) {
        if ((cell->stages[k].rates.shear != 0.0 || cell->stages[k].shear_servo) &&
            (cell->flow != def->flow || cell->gradient != def->gradient)) {
            return SE3DI_FAIL_OF(particles->system, "flow", SE3D_ERR_INVALID_ARGUMENT,
                                 " = %d and gradient = %d, must be %d and %d, as in stage %zu",
                                 (int)def->flow, (int)def->gradient, (int)cell->flow,
                                 (int)cell->gradient, k);
        }
    }
    return SE3D_OK;
}

static se3di_domain_stage make_stage(const se3d_cell_def *def)
{
    se3di_domain_stage stage = {.start = def->start,
                                .rates = {.shear = def->shear_rate},
                                .shear_servo = def->shear_servo != 0,
                                .shear_stress = def->shear_stress,
                                .shear_most = def->shear_rate_max,
                                .shear_gain = def->shear_gain};
    for (int a = 0; a < 3; ++a) {
        stage.rates.along[a] = def->rate[a];
        stage.servo[a] = def->servo[a] != 0;
        stage.volume[a] = def->volume[a] != 0;
        stage.stress[a] = def->stress[a];
        stage.most[a] = def->rate_max[a];
        stage.gain[a] = def->gain[a];
    }
    return stage;
}

static void begin_cell(se3di_particles *set)
{
    se3di_domain *cell = &set->cell;
    memset(cell, 0, sizeof *cell);
    cell->stage = SE3D_CELL_STAGES;
    for (int a = 0; a < 3; ++a) {
        cell->centre[a] = 0.5 * (set->lower[a] + set->upper[a]);
        cell->first[a] = set->upper[a] - set->lower[a];
    }
    cell->since = (se3di_domain_map){{1.0, 1.0, 1.0}, 0.0};
}

se3d_status se3d_particles_add_cell_stage(se3d_particles *particles, const se3d_cell_def *def,
                                          uint32_t *out)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3di_particles *set = &particles->set;
    se3di_domain *cell = &set->cell;
    se3d_cell_def full = se3d_cell_def_default();
    SE3DI_TRY(se3di_check_def(system, "cell def", def, &full, sizeof full));
    SE3DI_TRY(check_cell(system, &full));
    SE3DI_TRY(check_set(particles, &full));
    if (se3di_particles_collect(set) < 0) { /* the lists are made anew, slabs along the gradient */
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a cell");
    }
    if (cell->count == 0) {
        begin_cell(set);
        cell->flow = full.flow;
        cell->gradient = full.gradient;
    } else if (shears(&full)) {
        cell->flow = full.flow;
        cell->gradient = full.gradient;
    }
    cell->stages[cell->count] = make_stage(&full);
    if (out) {
        *out = (uint32_t)cell->count;
    }
    ++cell->count;
    set->force_valid = 0;
    ++system->model.topology_version; /* snapshots from before do not have it */
    return SE3D_OK;
}

static double solid_volume(const se3di_particles *set)
{
    double sum = 0.0;
    size_t id = 0;
    for (size_t n = 0; n < set->count; ++n) {
        sum += se3di_particles_volume(set, se3di_particles_next(set, &id));
    }
    return sum;
}

static void fill_state(const se3di_particles *set, se3d_cell_state *state)
{
    const se3di_domain *cell = &set->cell;
    state->volume = se3di_domain_volume(set);
    state->solid_fraction = state->volume > 0.0 ? solid_volume(set) / state->volume : 0.0;
    memcpy(state->lower, set->lower, sizeof state->lower);
    memcpy(state->upper, set->upper, sizeof state->upper);
    state->stage = SE3D_CELL_STAGES;
    if (cell->count == 0) {
        return;
    }
    for (int a = 0; a < 3; ++a) {
        state->strain[a] = se3di_log((set->upper[a] - set->lower[a]) / cell->first[a]);
        state->rate[a] = cell->rates.along[a];
        state->kinetic_energy += 0.5 * cell->kinetic[a];
    }
    se3di_domain_stress(set, state->stress);
    state->offset = cell->offset;
    state->shear_strain = cell->shear;
    state->shear_rate = cell->rates.shear;
    state->work = cell->work;
    state->stage = cell->stage;
}

se3d_status se3d_particles_get_cell_sized(const se3d_particles *particles, se3d_cell_state *state,
                                          size_t size)
{
    if (!particles || !state) {
        return SE3D_ERR_NULL;
    }
    se3d_cell_state full;
    memset(&full, 0, sizeof full);
    const se3di_floats host = se3di_floats_set();
    fill_state(&particles->set, &full);
    se3di_floats_restore(host);
    return se3di_sized_give(state, size, &full, sizeof full);
}
