/* SPDX-License-Identifier: BSD-3-Clause */
/* Sources and sinks of particles, tags and what is there of each. */
#include "force/force.h"
#include "math/vec3.h"
#include "particles/energy.h"
#include "particles/fill.h"
#include "particles/flow.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

void se3d_particles_source_def_init(se3d_particles_source_def *def, size_t size)
{
    se3d_particles_source_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_particles_sink_def_init(se3d_particles_sink_def *def, size_t size)
{
    se3d_particles_sink_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_source(se3d_particles *p, const se3d_particles_source_def *def,
                                se3d_particles_source_def *full, int32_t *function)
{
    se3d_system *system = p->system;
    SE3DI_TRY(se3di_check_def(system, "source def", def, full, sizeof *full));
    SE3DI_TRY(se3di_check_pointer(system, "fill", full->fill));
    SE3DI_TRY(se3di_check_range(system, "rate", full->rate, 0.0, 1e30));
    SE3DI_TRY(se3di_find_function(system, "function", full->function, 1, function));
    SE3DI_TRY(se3di_check_range(system, "start", full->start, -1e30, 1e30));
    SE3DI_TRY(se3di_check_range(system, "stop", full->stop, -1e30, 1e30));
    return se3di_check_range(system, "every", full->every, 0.0, 1e30);
}

/* A copy of the table of radii. */
static se3d_status copy_radii(se3d_particles *p, const se3d_fill_def *fill, se3di_source *source)
{
    size_t n = fill->radius_count;
    source->radii = se3di_fill_radii(fill);
    source->radii.radii = source->radii.weights = NULL;
    if (n == 0) {
        return SE3D_OK;
    }
    source->table = se3di_alloc(&p->set.allocator, 2 * n, sizeof(double));
    if (!source->table) {
        return SE3DI_FAIL(p->system, SE3D_ERR_NO_MEMORY, "no memory for a source");
    }
    for (size_t k = 0; k < n; ++k) {
        source->table[k] = fill->radii[k];
        source->table[n + k] = fill->weights ? fill->weights[k] : 1.0;
    }
    source->radii.radii = source->table;
    source->radii.weights = source->table + n;
    return SE3D_OK;
}

static se3d_status grow(se3d_particles *p, void **data, size_t *capacity, size_t needed,
                        size_t size)
{
    if (se3di_array_reserve(&p->set.allocator, data, capacity, needed, size) < 0) {
        return SE3DI_FAIL(p->system, SE3D_ERR_NO_MEMORY, "no memory for a source or a sink");
    }
    return SE3D_OK;
}

se3d_status se3d_particles_add_source(se3d_particles *particles,
                                      const se3d_particles_source_def *def, uint32_t *out)
{
    SE3DI_EDIT_OF(particles);
    se3di_particles *set = &particles->set;
    se3di_model *model = &particles->system->model;
    se3d_particles_source_def full = se3d_particles_source_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    int32_t function = -1;
    uint32_t material;
    SE3DI_TRY(check_source(particles, def, &full, &function));
    SE3DI_TRY(se3di_check_fill(particles, full.fill, &fill, &material));
    void *memory = set->sources;
    se3d_status status = grow(particles, &memory, &set->source_capacity, set->source_count + 1,
                              sizeof *set->sources);
    set->sources = memory;
    SE3DI_TRY(status);
    se3di_source source = {.region = se3di_fill_region(&fill),
                           .material = material,
                           .tag = fill.tag,
                           .rate = full.rate,
                           .per_mass = full.per_mass != 0,
                           .start = full.start,
                           .stop = full.stop > 0.0 || full.stop < 0.0 ? full.stop : HUGE_VAL,
                           .every = full.every,
                           .due = -HUGE_VAL,
                           .maximum = fill.count > 0 ? fill.count : UINT64_MAX,
                           .seed = fill.seed,
                           .clump = fill.clump,
                           .turns = fill.seed};
    se3di_copy(fill.velocity, source.velocity);
    memcpy(source.turn, fill.orientation, sizeof source.turn);
    SE3DI_TRY(copy_radii(particles, &fill, &source));
    if (function >= 0) {
        source.function = (se3di_handle){full.function.index1, full.function.generation};
        ++model->functions[function].users;
    }
    set->sources[set->source_count] = source;
    if (out) {
        *out = (uint32_t)set->source_count;
    }
    ++set->source_count;
    ++model->topology_version; /* snapshots from before do not have it */
    return SE3D_OK;
}

se3d_status se3d_particles_get_source_stats_sized(const se3d_particles *particles, uint32_t source,
                                                  se3d_particles_source_stats *stats, size_t size)
{
    if (!particles || !stats) {
        return SE3D_ERR_NULL;
    }
    if (source >= particles->set.source_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_source *s = &particles->set.sources[source];
    const se3d_particles_source_stats full = {
        .inserted = s->inserted,
        .deferred = s->deferred,
        .mass = s->mass,
        .waiting = s->inserted < s->maximum ? fmax(0.0, s->owed) : 0.0};
    return se3di_sized_give(stats, size, &full, sizeof full);
}

/* There is a source (a sink) of this number. */
static se3d_status check_number(se3d_particles *p, const char *what, uint32_t number, size_t count)
{
    if (number >= count) {
        return SE3DI_FAIL_OF(p->system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = %u, must be less than their number, %zu", number, count);
    }
    return SE3D_OK;
}

se3d_status se3d_particles_remove_source(se3d_particles *particles, uint32_t source)
{
    SE3DI_EDIT_OF(particles);
    SE3DI_TRY(check_number(particles, "source", source, particles->set.source_count));
    se3di_source *s = &particles->set.sources[source];
    se3di_model *model = &particles->system->model;
    uint32_t function =
        se3di_slots_find(&model->function_slots, s->function.index1, s->function.generation);
    if (function != SE3DI_NO_INDEX) {
        --model->functions[function].users;
    }
    s->function = (se3di_handle){0, 0};
    s->stopped = 1;
    ++model->topology_version;
    return SE3D_OK;
}

se3d_status se3d_particles_add_sink(se3d_particles *particles, const se3d_particles_sink_def *def,
                                    uint32_t *out)
{
    SE3DI_EDIT_OF(particles);
    se3d_system *system = particles->system;
    se3di_particles *set = &particles->set;
    se3d_particles_sink_def full = se3d_particles_sink_def_default();
    SE3DI_TRY(se3di_check_def(system, "sink def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_finites(system, "point", full.point, 3));
    SE3DI_TRY(se3di_check_finites(system, "normal", full.normal, 3));
    const double length = se3di_norm(full.normal);
    const se3d_fill_def box = {.region = full.region, .axis = full.axis};
    se3di_sink sink = {.region = se3di_fill_region(&box), .plane = length > 0.0};
    if (sink.plane) {
        se3di_scale(1.0 / length, full.normal, sink.normal);
        se3di_copy(full.point, sink.point);
    } else {
        SE3DI_TRY(
            se3di_check_region(particles, full.lower, full.upper, full.region, full.axis, 0.0));
        se3di_copy(full.lower, sink.region.lower);
        se3di_copy(full.upper, sink.region.upper);
    }
    void *memory = set->sinks;
    se3d_status status =
        grow(particles, &memory, &set->sink_capacity, set->sink_count + 1, sizeof *set->sinks);
    set->sinks = memory;
    SE3DI_TRY(status);
    set->sinks[set->sink_count] = sink;
    if (out) {
        *out = (uint32_t)set->sink_count;
    }
    ++set->sink_count;
    ++system->model.topology_version;
    return SE3D_OK;
}

se3d_status se3d_particles_get_sink_count(const se3d_particles *particles, uint32_t sink,
                                          uint64_t *count)
{
    if (!particles || !count) {
        return SE3D_ERR_NULL;
    }
    if (sink >= particles->set.sink_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *count = particles->set.sinks[sink].count;
    return SE3D_OK;
}

se3d_status se3d_particles_remove_sink(se3d_particles *particles, uint32_t sink)
{
    SE3DI_EDIT_OF(particles);
    SE3DI_TRY(check_number(particles, "sink", sink, particles->set.sink_count));
    particles->set.sinks[sink].stopped = 1;
    ++particles->system->model.topology_version;
    return SE3D_OK;
}

se3d_status se3d_particles_get_tally_sized(const se3d_particles *particles, uint32_t tag,
                                           se3d_particles_tally *tally, size_t size)
{
    SE3DI_OWNED(particles);
    if (!tally) {
        return SE3D_ERR_NULL;
    }
    if (tag >= SE3D_PARTICLES_TAGS) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    double g[3];
    SE3DI_TRY(se3di_particles_gravity(particles, g));
    const se3di_floats host = se3di_floats_set();
    const se3d_particles_tally full = se3di_particles_tally(&particles->set, tag, g);
    se3di_floats_restore(host);
    return se3di_sized_give(tally, size, &full, sizeof full);
}
