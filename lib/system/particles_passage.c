/* SPDX-License-Identifier: BSD-3-Clause */
/* Flows of particles through planes, disks and rectangles. */
#include "particles/passage.h"

#include "base/sized.h"
#include "math/vec3.h"
#include "se3d/flow.h"
#include "system/particles.h"

#define SIZE_MOST 1e30

void se3d_flow_def_init(se3d_flow_def *def, size_t size)
{
    se3d_flow_def defaults = {.struct_size = size, .window = 0.1, .tag = -1};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* The directions of a rectangle's edges. */
static se3d_status read_edges(se3d_system *system, const se3d_flow_def *def, se3di_flow *flow)
{
    double along[3];
    se3di_copy(def->along, along);
    se3di_add_scaled(-se3di_dot(along, flow->normal), flow->normal, along);
    const double length = se3di_norm(along);
    if (!(length > 1e-9 * se3di_norm(def->along))) {
        return SE3DI_FAIL_OF(
            system, "along", SE3D_ERR_INVALID_ARGUMENT,
            " = (%g, %g, %g), must be a direction that is not that of normal = (%g, %g, %g)",
            def->along[0], def->along[1], def->along[2], def->normal[0], def->normal[1],
            def->normal[2]);
    }
    se3di_scale(1.0 / length, along, flow->along);
    se3di_cross(flow->normal, flow->along, flow->across);
    flow->half[0] = 0.5 * def->size[0];
    flow->half[1] = 0.5 * def->size[1];
    return SE3D_OK;
}

static se3d_status check_flow(se3d_system *system, const se3d_flow_def *def)
{
    SE3DI_TRY(se3di_check_finites(system, "point", def->point, 3));
    SE3DI_TRY(se3di_check_finites(system, "normal", def->normal, 3));
    SE3DI_TRY(se3di_check_finites(system, "along", def->along, 3));
    SE3DI_TRY(se3di_check_range(system, "radius", def->radius, 0.0, SIZE_MOST));
    SE3DI_TRY(se3di_check_range(system, "size[0]", def->size[0], 0.0, SIZE_MOST));
    SE3DI_TRY(se3di_check_range(system, "size[1]", def->size[1], 0.0, SIZE_MOST));
    SE3DI_TRY(se3di_check_range(system, "window", def->window, 1e-30, SIZE_MOST));
    if ((def->size[0] > 0.0) != (def->size[1] > 0.0)) {
        return SE3DI_FAIL_OF(system, "size", SE3D_ERR_INVALID_ARGUMENT,
                             " = (%g, %g) m, both must be > 0 or both 0", def->size[0],
                             def->size[1]);
    }
    if (def->radius > 0.0 && def->size[0] > 0.0) {
        return SE3DI_FAIL_OF(system, "radius", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g m, must be 0 beside a size: a flow is a disk or a rectangle",
                             def->radius);
    }
    if (def->tag < -1 || def->tag >= SE3D_PARTICLES_TAGS) {
        return SE3DI_FAIL_OF(system, "tag", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be from -1 to %d", (int)def->tag,
                             SE3D_PARTICLES_TAGS - 1);
    }
    return SE3D_OK;
}

static se3d_status make_flow(se3d_system *system, const se3d_flow_def *def, double time,
                             se3di_flow *flow)
{
    const double length = se3di_norm(def->normal);
    *flow =
        (se3di_flow){.radius = def->radius, .window = def->window, .tag = def->tag, .begun = time};
    if (!(length > 1e-100 && length < 1e100)) {
        return SE3DI_FAIL_OF(system, "normal", SE3D_ERR_INVALID_ARGUMENT,
                             " = (%g, %g, %g), must be a direction", def->normal[0], def->normal[1],
                             def->normal[2]);
    }
    se3di_scale(1.0 / length, def->normal, flow->normal);
    se3di_copy(def->point, flow->point);
    return def->size[0] > 0.0 ? read_edges(system, def, flow) : SE3D_OK;
}

se3d_status se3d_particles_add_flow(se3d_particles *particles, const se3d_flow_def *def,
                                    uint32_t *out)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3di_particles *set = &particles->set;
    se3d_flow_def full = se3d_flow_def_default();
    se3di_flow flow;
    SE3DI_TRY(se3di_check_def(system, "flow def", def, &full, sizeof full));
    SE3DI_TRY(check_flow(system, &full));
    SE3DI_TRY(make_flow(system, &full, set->time, &flow));
    if (set->flow_count == SE3D_PARTICLES_FLOWS) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "the set has %d flows, which is the most", SE3D_PARTICLES_FLOWS);
    }
    void *memory = set->flows;
    const se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->flow_capacity,
                                                   set->flow_count + 1, sizeof *set->flows);
    set->flows = memory;
    if (status < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a flow");
    }
    set->flows[set->flow_count] = flow;
    if (out) {
        *out = (uint32_t)set->flow_count;
    }
    ++set->flow_count;
    ++system->model.topology_version; /* snapshots from before do not have it */
    return SE3D_OK;
}

se3d_status se3d_particles_get_flow_sized(const se3d_particles *particles, uint32_t flow,
                                          se3d_flow_stats *stats, size_t size)
{
    if (!particles || !stats) {
        return SE3D_ERR_NULL;
    }
    if (flow >= particles->set.flow_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_flow *f = &particles->set.flows[flow];
    const se3di_floats host = se3di_floats_set();
    const se3di_flow_rates rates =
        f->has_rates ? f->rates : se3di_flow_rates_since(f, particles->set.time);
    se3di_floats_restore(host);
    se3d_flow_stats full = {.forward = f->total.forward,
                            .backward = f->total.backward,
                            .mass = f->total.mass,
                            .count_rate = rates.count,
                            .mass_rate = rates.mass};
    se3di_copy(f->total.momentum, full.momentum);
    se3di_copy(rates.momentum, full.momentum_rate);
    return se3di_sized_give(stats, size, &full, sizeof full);
}
