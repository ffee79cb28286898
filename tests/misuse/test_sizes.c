/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures that the library fills grow at their end. A caller that was compiled with a smaller
 * one is not overrun, and finds zeros where this library knows nothing of what is new to it. */
#include <stdlib.h>

#include "misuse/callback_world.h"
#include "se3d/import.h"
#include "se3d/io.h"

#define MARK 0xA5

typedef struct place {
    world w;
    se3d_system *pair; /* of particles that touch */
    se3d_particles *particles;
    se3d_modes *modes;
    se3d_model *model;
    se3d_run *run;
    se3d_model_import *import;
} place;

#define FILL(name, type, ...)                                                                      \
    static se3d_status do_##name(place *p, void *out, size_t size)                                 \
    {                                                                                              \
        return se3d_##name##_sized(__VA_ARGS__, out, size);                                        \
    }                                                                                              \
    static se3d_status plain_##name(place *p, void *out)                                           \
    {                                                                                              \
        return se3d_##name(__VA_ARGS__, (type *)out);                                              \
    }
FILL(system_get_energy, se3d_energy, p->w.system)
FILL(system_get_work, se3d_work, p->w.system)
FILL(solver_get_stats, se3d_solver_stats, p->w.solver)
FILL(solver_get_start_change, se3d_start_change, p->w.solver)
FILL(solver_get_event_record, se3d_event_record, p->w.solver, 0)
FILL(modes_get_eigenvalue, se3d_eigenvalue, p->modes, 0)
FILL(system_get_contacts, se3d_contact, p->w.system, 1)
FILL(particles_get_source_stats, se3d_particles_source_stats, p->w.particles, 0)
FILL(particles_get_tally, se3d_particles_tally, p->w.particles, 0)
static const double low[3] = {0.0, 0.0, 0.0}, high[3] = {1.0, 1.0, 1.0};
FILL(particles_get_average, se3d_average, p->w.particles, low, high, -1)
FILL(particles_get_flow, se3d_flow_stats, p->w.particles, 0)
FILL(particles_get_servo, se3d_servo_state, p->w.particles, 0)
FILL(particles_get_cell, se3d_cell_state, p->w.particles)
FILL(particles_get_bond_stats, se3d_bond_stats, p->w.particles, -1)
FILL(particles_get_clump_template, se3d_clump_template_info, p->w.particles, 0)
FILL(particles_get_contacts, se3d_particles_contact, p->particles, 1)
FILL(particles_get_energy, se3d_particles_energy, p->w.particles)
FILL(particles_get_dissipation, se3d_particles_dissipation, p->particles)
FILL(particles_get_stats, se3d_particles_stats, p->w.particles)
FILL(model_get_analysis, se3d_model_analysis, p->model, 0)
FILL(model_get_output, se3d_model_output, p->model, 0)
FILL(model_get_shape, se3d_model_shape, p->model, 0)
FILL(model_get_picture, se3d_model_picture, p->model, 0)
FILL(run_get_analysis, se3d_run_analysis, p->run, 0)
FILL(run_get_particles, se3d_run_particles, p->run, 0)
FILL(run_get_event, se3d_run_event, p->run, 0)
#if defined(SE3D_HAS_EXPAT)
FILL(model_import_get_note, se3d_model_import_note, p->import, 0)
#endif
FILL(run_get_file, se3d_run_file, p->run, 0)
FILL(run_get_summary, se3d_run_summary, p->run, 0)

typedef struct filler {
    const char *name;
    se3d_status (*fill)(place *p, void *out, size_t size);
    se3d_status (*plain)(place *p, void *out);
    size_t size;
} filler;

#define ROW(name, type)                                                                            \
    {                                                                                              \
#name, do_##name, plain_##name, sizeof(type)                                               \
    }
static const filler fillers[] = {
    ROW(system_get_energy, se3d_energy),
    ROW(system_get_work, se3d_work),
    ROW(solver_get_stats, se3d_solver_stats),
    ROW(solver_get_start_change, se3d_start_change),
    ROW(solver_get_event_record, se3d_event_record),
    ROW(modes_get_eigenvalue, se3d_eigenvalue),
    ROW(system_get_contacts, se3d_contact),
    ROW(particles_get_source_stats, se3d_particles_source_stats),
    ROW(particles_get_tally, se3d_particles_tally),
    ROW(particles_get_average, se3d_average),
    ROW(particles_get_flow, se3d_flow_stats),
    ROW(particles_get_servo, se3d_servo_state),
    ROW(particles_get_cell, se3d_cell_state),
    ROW(particles_get_bond_stats, se3d_bond_stats),
    ROW(particles_get_clump_template, se3d_clump_template_info),
    ROW(particles_get_contacts, se3d_particles_contact),
    ROW(particles_get_energy, se3d_particles_energy),
    ROW(particles_get_dissipation, se3d_particles_dissipation),
    ROW(particles_get_stats, se3d_particles_stats),
    ROW(model_get_analysis, se3d_model_analysis),
    ROW(model_get_output, se3d_model_output),
    ROW(model_get_shape, se3d_model_shape),
    ROW(model_get_picture, se3d_model_picture),
    ROW(run_get_analysis, se3d_run_analysis),
    ROW(run_get_particles, se3d_run_particles),
    ROW(run_get_event, se3d_run_event),
    ROW(run_get_file, se3d_run_file),
    ROW(run_get_summary, se3d_run_summary),
#if defined(SE3D_HAS_EXPAT)
    ROW(model_import_get_note, se3d_model_import_note),
#endif
};

static const char text[] =
    "se3d: 1\n"
    "materials: [{name: stone, density: 2000, stiffness: 1e5}]\n"
    "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], shapes: [{type: sphere, radius: 1}]}]\n"
    "particles: [{material: stone, radius: 0.01, packing: lattice, count: 2, lower: [5, 5, 5], "
    "upper: [6, 6, 6]}]\n"
    "analysis: {type: dynamics, method: verlet, duration: 0.02}\n"
    "events: [{name: low, channel: block.position.z, value: -1e-4}]\n"
    "output: [{file: a.csv, channels: [block.position]}, {plot: a.svg},\n"
    "  {summary: s.csv, channels: [block.position, {twice: 2*block.position.z}]}]\n";

static void open_pair(place *p)
{
    const double r[6] = {0.0, 0.0, 0.0, 0.019, 0.0, 0.0}, radius[2] = {0.01, 0.01};
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    stuff.density = 1000.0;
    stuff.stiffness = 1e4;
    CHECK(!se3d_system_create(NULL, &p->pair));
    CHECK(!se3d_material_create(p->pair, &stuff, &material));
    se3d_particles_def audited = se3d_particles_def_default();
    audited.audit = 1;
    CHECK(!se3d_particles_create(p->pair, &audited, &p->particles));
    CHECK(!se3d_particles_add(p->particles, material, 2, r, radius, NULL, NULL, NULL));
    CHECK(!se3d_particles_step(p->particles, 1));
}

static void open_import(place *p)
{
#if defined(SE3D_HAS_EXPAT)
    static const char robot[] = "<robot name=\"r\"><link name=\"a\"/><gazebo/></robot>";
    CHECK(!se3d_model_import_text(robot, strlen(robot), "r.urdf", NULL, &p->import, NULL));
#else
    p->import = NULL;
#endif
}

static void open_place(place *p)
{
    char folder[800];
    se3d_model_error error;
    se3d_run_options how = se3d_run_options_default();
    snprintf(folder, sizeof folder, "%s/sizes", check_scratch());
    how.directory = folder;
    memset(p, 0, sizeof *p);
    open_pair(p);
    open_import(p);
    world_open(&p->w, SE3D_METHOD_VERLET);
    CHECK(!se3d_solver_run(p->w.solver, 0.005));
    CHECK(!se3d_modes_create(p->w.system, NULL, &p->modes));
    if (se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &p->model, &error) < 0 ||
        se3d_model_run(p->model, &how, &p->run, &error) < 0) {
        fprintf(stderr, "%s\n", error.message);
        CHECK(0);
    }
}

static void close_place(place *p)
{
    se3d_model_import_destroy(p->import);
    se3d_run_destroy(p->run);
    se3d_model_destroy(p->model);
    se3d_modes_destroy(p->modes);
    se3d_system_destroy(p->pair);
    world_close(&p->w);
}

static int are(const unsigned char *bytes, size_t from, size_t to, unsigned char value)
{
    for (size_t k = from; k < to; ++k) {
        if (bytes[k] != value) {
            return 0;
        }
    }
    return 1;
}

static void structures_are_filled_as_far_as_both_know_them(void)
{
    place p;
    open_place(&p);
    for (size_t k = 0; k < sizeof fillers / sizeof *fillers; ++k) {
        const filler *f = &fillers[k];
        unsigned char full[512], other[1024];
        memset(full, 0, sizeof full);
        const se3d_status status = f->plain(&p, full);
        if (status != SE3D_OK) {
            fprintf(stderr, "%s: %s\n", f->name, se3d_status_get_text(status));
            CHECK(0);
        }
        for (size_t size = 1; size <= f->size + 64; ++size) {
            const size_t common = size < f->size ? size : f->size;
            memset(other, MARK, sizeof other);
            CHECK(f->fill(&p, other, size) == SE3D_OK);
            CHECK(memcmp(other, full, common) == 0);
            CHECK(are(other, common, size, 0) && are(other, size, sizeof other, MARK));
        }
        CHECK(f->fill(&p, other, 0) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK(f->fill(&p, other, (size_t)1 << 40) == SE3D_ERR_INVALID_ARGUMENT);
    }
    close_place(&p);
}

/* Those that are said to be final. */
static void what_may_not_grow_has_not(void)
{
    CHECK(sizeof(se3d_solver_stats) == 16 * sizeof(uint64_t));
    CHECK(sizeof(se3d_body_motion) == 13 * sizeof(double));
    CHECK(sizeof(se3d_expression_error) == sizeof(size_t) + 256);
    CHECK(sizeof(se3d_model_error) == 2 * sizeof(size_t) + 1024);
}

int main(void)
{
    RUN(structures_are_filled_as_far_as_both_know_them);
    RUN(what_may_not_grow_has_not);
    return check_finish();
}
