/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of particles where memory fails: they are complete or did not begin, nothing is lost, and
 * steady ones ask for none. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/counting.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 1500
#define STEP  1e-4

typedef struct world {
    support_counting counting;
    se3d_allocator allocator;
    se3d_system *system;
    se3d_particles *particles;
    se3d_body bucket;
} world;

static void add_shape(world *w, se3d_material material, se3d_body body, const double size[3],
                      const double at[3])
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.material = material;
    def.body = body;
    memcpy(def.size, size, sizeof def.size);
    memcpy(def.position, at, sizeof def.position);
    CHECK(se3d_shape_create_box(w->system, &def, &shape) == SE3D_OK);
}

/* Particles fall into a bucket that hangs on a spring; a mesh is in it, and particles roll with
 * friction. */
static se3d_status do_nothing(void *ctx, double t, const se3d_body_motion motion[2],
                              double wrench[12], double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)wrench, (void)K, (void)D;
    return SE3D_OK;
}

/* With a callback the particles are kept before each step of verlet. */
static void add_callback(const world *w)
{
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_force made;
    CHECK(se3d_system_get_ground(w->system, &def.body_i) == SE3D_OK);
    def.body_j = w->bucket;
    def.callback = do_nothing;
    CHECK(se3d_force_create_callback(w->system, &def, &made) == SE3D_OK);
}

/* Two spheres that overlap. */
static uint32_t add_template(const world *w)
{
    static const double r[6] = {0.0, 0.0, 0.0, 0.004, 0.0, 0.0}, radii[2] = {0.005, 0.004};
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index = 0;
    def.count = 2;
    def.r = r;
    def.radius = radii;
    CHECK(se3d_particles_add_clump_template(w->particles, &def, &index) == SE3D_OK);
    return index;
}

static void open_world(world *w, int rolling)
{
    static const double tray[12] = {-0.04, -0.04, 0.005, 0.04,  -0.04, 0.005,
                                    0.04,  0.04,  0.005, -0.04, 0.04,  0.005};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    se3d_system_def def = se3d_system_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    memset(w, 0, sizeof *w);
    w->allocator = support_counting_allocator(&w->counting);
    def.allocator = &w->allocator;
    CHECK(se3d_system_create(&def, &w->system) == SE3D_OK);
    stuff.density = 2500.0;
    stuff.stiffness = 2e3;
    stuff.rolling_friction = rolling ? 0.1 : 0.0;
    CHECK(se3d_material_create(w->system, &stuff, &material) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = 0.5;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1e-3;
    CHECK(se3d_body_create(w->system, &body, &w->bucket) == SE3D_OK);
    add_callback(w);
    const double bottom[3] = {0.1, 0.1, 0.01}, side[3] = {0.01, 0.1, 0.1},
                 front[3] = {0.1, 0.01, 0.1};
    const double places[5][3] = {
        {0, 0, 0}, {-0.05, 0, 0.05}, {0.05, 0, 0.05}, {0, -0.05, 0.05}, {0, 0.05, 0.05}};
    for (int k = 0; k < 5; ++k) {
        add_shape(w, material, w->bucket, k == 0 ? bottom : k < 3 ? side : front, places[k]);
    }
    se3d_shape_def mesh = se3d_shape_def_default();
    se3d_shape shape;
    mesh.material = material;
    mesh.body = w->bucket;
    mesh.vertices = tray;
    mesh.vertex_count = 4;
    mesh.triangles = faces;
    mesh.triangle_count = 2;
    CHECK(se3d_shape_create_mesh(w->system, &mesh, &shape) == SE3D_OK);
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    CHECK(se3d_system_get_ground(w->system, &spring.body_i) == SE3D_OK);
    spring.body_j = w->bucket;
    spring.point_i[2] = 1.0;
    spring.k = 500.0;
    spring.l0 = 1.0;
    CHECK(se3d_force_create_tsda(w->system, &spring, &force) == SE3D_OK);
    se3d_particles_def set = se3d_particles_def_default();
    set.step = STEP;
    CHECK(se3d_particles_create(w->system, &set, &w->particles) == SE3D_OK);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = material;
    fill.radius_min = 0.004;
    fill.radius_max = 0.006;
    fill.lower[0] = fill.lower[1] = -0.04;
    fill.upper[0] = fill.upper[1] = 0.04;
    fill.lower[2] = 0.02;
    fill.upper[2] = 0.1;
    fill.jitter = 0.0005;
    CHECK(se3d_particles_fill_lattice(w->particles, &fill, NULL) == SE3D_OK);
    fill.lower[2] = 0.12;
    fill.upper[2] = 0.15;
    se3d_particles_source_def source = se3d_particles_source_def_default();
    if (rolling) {
        fill.clump = 1 + add_template(w);
        fill.radius_min = fill.radius_max = 0.0;
    }
    source.fill = &fill;
    source.rate = 120.0;
    CHECK(se3d_particles_add_source(w->particles, &source, NULL) == SE3D_OK);
}

static void close_world(world *w)
{
    se3d_system_destroy(w->system);
    CHECK(w->counting.live == 0 && w->counting.wrong == 0);
}

/* Step to the end in spite of failures: allocation k fails (and the next `more`). Returns how many
 * failed. */
static size_t run_world(world *w, int bodies, size_t k, size_t more, double z[2])
{
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    size_t failures = 0, calls = 0;
    double time = 0.0;
    how.analysis = SE3D_ANALYSIS_DYNAMICS;
    how.method = SE3D_METHOD_VERLET;
    how.step = STEP;
    if (bodies) {
        CHECK(!SE3D_FAILED(se3d_solver_create(w->system, &how, &solver)));
    }
    w->counting.calls = w->counting.failed = 0;
    w->counting.fail_at = k;
    w->counting.for_ever = more > 0;
    for (size_t step = 0; step < STEPS && calls < STEPS + 100; ++calls) {
        se3d_status status =
            bodies ? se3d_solver_step(solver, STEP) : se3d_particles_step(w->particles, 1);
        CHECK(status >= 0 || status == SE3D_ERR_NO_MEMORY);
        if (status < 0 && ++failures > more) {
            w->counting.fail_at = 0;
            w->counting.for_ever = 0;
        }
        CHECK(se3d_particles_get_time(w->particles, &time) == SE3D_OK);
        size_t now = (size_t)lround(time / STEP);
        CHECK(now == step || now == step + 1); /* complete, or not begun */
        CHECK(status < 0 || now == step + 1);
        CHECK_NEAR(time, (double)now * STEP, 1e-12);
        if (bodies) {
            double other;
            CHECK(se3d_system_get_time(w->system, &other) == SE3D_OK);
            CHECK_NEAR(other, time, 1e-15); /* none of them is ahead */
        }
        step = now;
    }
    w->counting.fail_at = 0;
    w->counting.for_ever = 0;
    double *r = malloc(3 * 2000 * sizeof *r);
    size_t count = se3d_particles_count(w->particles);
    CHECK(count < 2000 && se3d_particles_get_all(w->particles, count, r, NULL, NULL) == SE3D_OK);
    z[0] = z[1] = 0.0;
    for (size_t i = 0; i < count; ++i) {
        z[0] += r[3 * i + 2] / (double)count;
    }
    free(r);
    double at[3];
    CHECK(se3d_body_get_position(w->system, w->bucket, at) == SE3D_OK);
    z[1] = at[2];
    se3d_solver_destroy(solver);
    return failures;
}

static void steps_survive_failed_allocations(int bodies, int rolling)
{
    double expected[2], z[2];
    world w;
    open_world(&w, rolling);
    CHECK(run_world(&w, bodies, 0, 0, expected) == 0);
    const size_t calls = w.counting.calls;
    const size_t count = se3d_particles_count(w.particles);
    close_world(&w);
    CHECK(calls > 20);
    size_t failures = 0;
    for (size_t k = 1; k <= calls; k += 1 + k / 8) {
        for (size_t more = 0; more < (bodies ? 1 : 8); more += 7) { /* once, and for a while */
            open_world(&w, rolling);
            failures += run_world(&w, bodies, k, more, z);
            /* The motion is chaotic, its means are not: a lost kick or drift would show. */
            CHECK_NEAR(z[0], expected[0], 1e-3);
            CHECK_NEAR(z[1], expected[1], 1e-4);
            size_t here = se3d_particles_count(w.particles);
            CHECK(here + 2 >= count && here <= count + 2); /* one clump */
            close_world(&w);
        }
    }
    CHECK(failures > 20);
}

static void steps_of_particles_survive_failed_allocations(void)
{
    steps_survive_failed_allocations(0, 1);
}

static void steps_of_verlet_survive_failed_allocations(void)
{
    steps_survive_failed_allocations(1, 0);
}

/* While all fall freely every step is known: a failed one leaves no half kick. */
static void failed_step_of_a_free_fall_is_exact(void)
{
    for (size_t k = 1; k < 60; ++k) {
        world w;
        double r[6] = {0.0, 0.0, 5.0, 0.0, 0.0, 5.0099}, v[6], radius[2] = {0.005, 0.005};
        se3d_material material;
        open_world(&w, 0);
        CHECK(se3d_particles_remove_source(w.particles, 0) == SE3D_OK);
        size_t count = se3d_particles_count(w.particles);
        uint32_t ids[2000];
        CHECK(se3d_particles_get_ids(w.particles, count, ids) == SE3D_OK);
        se3d_material *all = calloc(count, sizeof *all);
        CHECK(se3d_particles_get_materials(w.particles, count, all) == SE3D_OK);
        material = all[0];
        free(all);
        CHECK(se3d_particles_remove(w.particles, count, ids) == SE3D_OK);
        r[5] = 5.02;
        CHECK(!se3d_particles_add(w.particles, material, 2, r, radius, NULL, NULL, NULL));
        w.counting.calls = 0;
        w.counting.fail_at = k;
        size_t failures = 0;
        for (int step = 0; step < 400; ++step) {
            double time;
            se3d_status status = se3d_particles_step(w.particles, 1);
            failures += status < 0;
            CHECK(se3d_particles_get_time(w.particles, &time) == SE3D_OK);
            CHECK(se3d_particles_get_all(w.particles, 2, r, v, NULL) == SE3D_OK);
            CHECK_NEAR(v[2], -9.81 * time, 1e-12);
            CHECK_NEAR(r[2], 5.0 - 0.5 * 9.81 * time * time, 1e-12);
        }
        CHECK((failures > 0) == (w.counting.failed > 0));
        close_world(&w);
        if (failures == 0) {
            CHECK(k > 5);
            return;
        }
    }
    CHECK(0);
}

static void steady_steps_of_verlet_allocate_nothing(void)
{
    world w;
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver;
    se3d_particles_stats before, after;
    size_t most = 0;
    open_world(&w, 1);
    CHECK(se3d_particles_remove_source(w.particles, 0) == SE3D_OK);
    how.analysis = SE3D_ANALYSIS_DYNAMICS;
    how.method = SE3D_METHOD_VERLET;
    how.step = STEP;
    CHECK(!SE3D_FAILED(se3d_solver_create(w.system, &how, &solver)));
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.65)));
    CHECK(se3d_particles_get_stats(w.particles, &before) == SE3D_OK);
    w.counting.calls = 0;
    for (int k = 0; k < 1000; ++k) {
        CHECK(!SE3D_FAILED(se3d_solver_step(solver, STEP)));
        const size_t contacts = se3d_particles_count_contacts(w.particles);
        most = contacts > most ? contacts : most;
    }
    CHECK(w.counting.calls == 0);
    CHECK(se3d_particles_get_stats(w.particles, &after) == SE3D_OK);
    CHECK(after.rebuilds > before.rebuilds + 2); /* the bucket swings */
    CHECK(most > 100);
    se3d_solver_destroy(solver);
    close_world(&w);
}

/* Whichever allocation fails, nothing of the bed that is read is left, and the system stays as it
 * was. */
static void reading_a_bed_survives_failed_allocations(void)
{
    static unsigned char bytes[2000000];
    double z[2];
    size_t size = 0;
    se3d_snapshot *snapshot = NULL;
    world w;
    open_world(&w, 1);
    CHECK(run_world(&w, 1, 0, 0, z) == 0);
    CHECK(!se3d_snapshot_create(w.system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, bytes, sizeof bytes, &size));
    se3d_snapshot_destroy(snapshot);
    const uint64_t hash = se3d_system_hash(w.system);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    size_t k = 0;
    while (status < 0 && k < 1000) {
        w.counting.calls = 0;
        w.counting.fail_at = ++k;
        status = se3d_snapshot_read(w.system, bytes, size, &snapshot);
        w.counting.fail_at = 0;
        CHECK(status == SE3D_OK || (status == SE3D_ERR_NO_MEMORY && !snapshot));
        CHECK(se3d_system_hash(w.system) == hash);
    }
    CHECK(status == SE3D_OK && k > 20);
    se3d_snapshot_destroy(snapshot);
    close_world(&w);
}

int main(void)
{
    RUN(reading_a_bed_survives_failed_allocations);
    RUN(failed_step_of_a_free_fall_is_exact);
    RUN(steps_of_particles_survive_failed_allocations);
    RUN(steps_of_verlet_survive_failed_allocations);
    RUN(steady_steps_of_verlet_allocate_nothing);
    return check_finish();
}
