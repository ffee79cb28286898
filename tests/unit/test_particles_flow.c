/* SPDX-License-Identifier: BSD-3-Clause */
/* Sources, sinks, tags, and what has left: counted, without overlap, the same however a run is cut.
 */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>

#define MOST 3000

typedef struct filled {
    bed bed;
    se3d_fill_def fill;
    double r[3 * MOST], v[3 * MOST], radius[MOST];
    size_t count;
} filled;

static filled b; /* large */

static void open_bed(double gravity, const se3d_particles_def *def)
{
    const double down[3] = {0.0, 0.0, -gravity};
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    bed_open(&b.bed, SE3D_CONTACT_LAW_HOOKE, down, def, &stuff);
    b.fill = se3d_fill_def_default();
    b.fill.material = b.bed.material;
    b.fill.radius_min = b.fill.radius_max = 0.005;
    b.fill.upper[0] = b.fill.upper[1] = 0.1;
    b.fill.upper[2] = 0.02;
    b.fill.seed = 3;
    CHECK(se3d_particles_set_step(b.bed.particles, 4e-5) == SE3D_OK);
}

static void read_bed(void)
{
    b.count = se3d_particles_count(b.bed.particles);
    CHECK(b.count <= MOST);
    CHECK(se3d_particles_get_all(b.bed.particles, b.count, b.r, b.v, NULL) == SE3D_OK);
    CHECK(se3d_particles_get_radii(b.bed.particles, b.count, b.radius) == SE3D_OK);
}

static se3d_particles_source_def source_of(double rate)
{
    se3d_particles_source_def def = se3d_particles_source_def_default();
    def.fill = &b.fill;
    def.rate = rate;
    return def;
}

static se3d_particles_source_stats stats_of(uint32_t source)
{
    se3d_particles_source_stats stats = {0, 0, 0.0, 0.0};
    CHECK(se3d_particles_get_source_stats(b.bed.particles, source, &stats) == SE3D_OK);
    return stats;
}

/* The largest overlap of two particles. */
static double worst_overlap(void)
{
    double worst = -HUGE_VAL;
    for (size_t i = 0; i < b.count; ++i) {
        for (size_t j = i + 1; j < b.count; ++j) {
            double square = 0.0;
            for (size_t a = 0; a < 3; ++a) {
                double d = b.r[3 * i + a] - b.r[3 * j + a];
                square += d * d;
            }
            worst = fmax(worst, b.radius[i] + b.radius[j] - sqrt(square));
        }
    }
    return worst;
}

static void source_gives_its_rate_with_its_velocity(void)
{
    uint32_t source = 7;
    open_bed(10.0, NULL);
    b.fill.velocity[0] = 0.25;
    b.fill.velocity[2] = -1.5;
    b.fill.tag = 5;
    se3d_particles_source_def def = source_of(250.0);
    def.start = 0.1;
    def.stop = 0.5;
    CHECK(se3d_particles_add_source(b.bed.particles, &def, &source) == SE3D_OK);
    CHECK(source == 0);
    CHECK(se3d_particles_run(b.bed.particles, 0.0998) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == 0);
    CHECK(se3d_particles_run(b.bed.particles, 0.3001) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == 50);
    read_bed();
    CHECK(worst_overlap() <= 0.0);
    for (size_t k = 0; k < b.count; ++k) { /* v_z^2 - v_0^2 = 2 g (z_0 - z), z_0 in the region */
        double z0 = b.r[3 * k + 2] + (b.v[3 * k + 2] * b.v[3 * k + 2] - 2.25) / 20.0;
        CHECK_NEAR(b.v[3 * k], 0.25, 1e-14);
        CHECK(z0 > 0.005 - 1e-6 && z0 < 0.015 + 1e-6);
    }
    CHECK(se3d_particles_run(b.bed.particles, 0.8) == SE3D_OK);
    se3d_particles_tally tally;
    CHECK(se3d_particles_get_tally(b.bed.particles, 5, &tally) == SE3D_OK);
    CHECK(stats_of(0).inserted == 100 && tally.count == 100 && stats_of(0).deferred == 0);
    CHECK_NEAR(tally.mass, stats_of(0).mass, 1e-12);
    CHECK(se3d_particles_get_tally(b.bed.particles, 0, &tally) == SE3D_OK);
    CHECK(tally.count == 0 && !(tally.energy > 0.0));
    bed_close(&b.bed);
}

static void rate_may_be_a_function_and_a_mass(void)
{
    const double radii[3] = {0.002, 0.003, 0.004}, weights[3] = {4.0, 2.0, 1.0};
    se3d_particles_source_def def;
    open_bed(10.0, NULL);
    b.fill.radii = radii;
    b.fill.weights = weights;
    b.fill.radius_count = 3;
    b.fill.velocity[2] = -1.0;
    def = source_of(0.0);
    def.per_mass = 1;
    CHECK(se3d_function_create_expression(b.bed.system, "0.3*t", &def.function) == SE3D_OK);
    CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
    CHECK(se3d_function_destroy(b.bed.system, def.function) == SE3D_ERR_IN_USE);
    CHECK(se3d_particles_run(b.bed.particles, 1.0) == SE3D_OK);
    /* 0.15 kg, but for less than the mass of one. */
    CHECK(stats_of(0).mass <= 0.15 + 1e-9 && stats_of(0).mass > 0.15 - 7e-4);
    CHECK(stats_of(0).deferred == 0);
    read_bed();
    double of[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < b.count; ++k) {
        of[(int)(b.radius[k] * 1000.0 + 0.5) - 2] += 1.0 / (double)b.count;
    }
    CHECK(b.count > 300);
    CHECK_NEAR(of[0], 4.0 / 7.0, 0.08);
    CHECK_NEAR(of[1], 2.0 / 7.0, 0.08);
    CHECK_NEAR(of[2], 1.0 / 7.0, 0.08);
    CHECK(se3d_particles_remove_source(b.bed.particles, 0) == SE3D_OK);
    CHECK(se3d_function_destroy(b.bed.system, def.function) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, 1.1) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == b.count);
    bed_close(&b.bed);
}

static void what_finds_no_room_waits(void)
{
    open_bed(0.0, NULL);
    se3d_shape_def wall = se3d_shape_def_default(); /* a ball in the middle of the region */
    se3d_shape ball;
    wall.material = b.bed.material;
    wall.radius = 0.02;
    wall.position[0] = wall.position[1] = 0.05;
    CHECK(se3d_shape_create_sphere(b.bed.system, &wall, &ball) == SE3D_OK);
    b.fill.count = 1000;
    se3d_particles_source_def def = source_of(2000.0);
    CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, 0.2) == SE3D_OK);
    read_bed();
    CHECK(b.count > 60 && b.count < 120);
    CHECK(worst_overlap() <= 0.0);
    for (size_t k = 0; k < b.count; ++k) {
        double x = b.r[3 * k] - 0.05, y = b.r[3 * k + 1] - 0.05, z = b.r[3 * k + 2];
        CHECK(sqrt(x * x + y * y + z * z) >= 0.025);
    }
    CHECK(stats_of(0).deferred > 0 && stats_of(0).deferred <= b.count + 1); /* each once */
    CHECK_NEAR(stats_of(0).waiting + (double)stats_of(0).inserted, 400.0, 1e-6);
    CHECK(stats_of(0).inserted == b.count);
    bed_close(&b.bed);
}

static void source_ends_at_its_maximum(void)
{
    open_bed(10.0, NULL);
    b.fill.count = 30;
    se3d_particles_source_def def = source_of(500.0);
    def.every = 0.02;
    CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, 0.0204) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == 1); /* the next are due 20 ms after the first */
    CHECK(se3d_particles_run(b.bed.particles, 0.0234) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) > 8);
    CHECK(se3d_particles_run(b.bed.particles, 0.4) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == 30 && stats_of(0).waiting <= 0.0);
    bed_close(&b.bed);
}

/* A chute: particles fall from a source through a heap on a plate into a sink. */
static void open_chute(int threads)
{
    se3d_particles_def set = se3d_particles_def_default();
    se3d_shape_def plate = se3d_shape_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    se3d_shape shape;
    set.threads = threads;
    open_bed(10.0, &set);
    plate.material = b.bed.material;
    plate.size[0] = plate.size[1] = 0.06;
    plate.size[2] = 0.01;
    plate.position[0] = plate.position[1] = 0.05;
    plate.position[2] = -0.05;
    CHECK(se3d_shape_create_box(b.bed.system, &plate, &shape) == SE3D_OK);
    sink.normal[2] = 1.0;
    sink.point[2] = -0.12;
    CHECK(se3d_particles_add_sink(b.bed.particles, &sink, NULL) == SE3D_OK);
    se3d_particles_source_def def = source_of(1500.0);
    b.fill.radius_min = 0.003;
    b.fill.velocity[2] = -0.5;
    CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
}

static void chute_gives_the_same_bits_however_it_is_run(void)
{
    se3d_particles *copy;
    open_chute(1);
    CHECK(se3d_particles_step(b.bed.particles, 6000) == SE3D_OK);
    uint64_t hash = se3d_particles_hash(b.bed.particles);
    uint64_t lost = 0;
    CHECK(se3d_particles_get_sink_count(b.bed.particles, 0, &lost) == SE3D_OK);
    CHECK(lost > 50);
    CHECK(stats_of(0).inserted == lost + se3d_particles_count(b.bed.particles));
    bed_close(&b.bed);
    open_chute(3); /* other threads, in pieces, over a copy */
    for (size_t done = 0; done < 3600; done += 300) {
        CHECK(se3d_particles_step(b.bed.particles, 300) == SE3D_OK);
    }
    CHECK(se3d_particles_clone(b.bed.particles, &copy) == SE3D_OK);
    CHECK(se3d_particles_step(b.bed.particles, 1333) == SE3D_OK);
    CHECK(se3d_particles_restore(b.bed.particles, copy) == SE3D_OK);
    se3d_particles_destroy(copy);
    CHECK(se3d_particles_step(b.bed.particles, 2400) == SE3D_OK);
    CHECK(se3d_particles_hash(b.bed.particles) == hash);
    bed_close(&b.bed);
}

static void snapshots_and_clones_of_the_system_include_sources(void)
{
    se3d_system *clone;
    se3d_snapshot *snapshot;
    se3d_particles *other;
    open_chute(1);
    CHECK(se3d_particles_run(b.bed.particles, 0.1) == SE3D_OK);
    CHECK(se3d_snapshot_create(b.bed.system, &snapshot) == SE3D_OK);
    CHECK(se3d_system_clone(b.bed.system, &clone) == SE3D_OK);
    CHECK(se3d_system_get_particles(clone, 0, &other) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, 0.2) == SE3D_OK);
    CHECK(se3d_particles_run(other, 0.2) == SE3D_OK);
    uint64_t hash = se3d_particles_hash(b.bed.particles);
    CHECK(se3d_particles_hash(other) == hash);
    CHECK(se3d_snapshot_restore(snapshot, b.bed.system) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, 0.2) == SE3D_OK);
    CHECK(se3d_particles_hash(b.bed.particles) == hash);
    se3d_snapshot_destroy(snapshot);
    se3d_system_destroy(clone);
    bed_close(&b.bed);
}

static void insertion_does_not_disturb_others(void)
{
    double z[2] = {0.0, 0.0};
    for (int feeding = 0; feeding < 2; ++feeding) {
        const double r[3] = {1.0, 0.0, 0.0}, radius = 0.01;
        se3d_shape_def plane = se3d_shape_def_default();
        se3d_shape shape;
        uint32_t first;
        open_bed(10.0, NULL);
        plane.material = b.bed.material;
        plane.normal[2] = 1.0;
        plane.position[2] = -0.015;
        CHECK(se3d_shape_create_plane(b.bed.system, &plane, &shape) == SE3D_OK);
        CHECK(!se3d_particles_add(b.bed.particles, b.bed.material, 1, r, &radius, NULL, NULL,
                                  &first));
        se3d_particles_source_def def = source_of(1000.0);
        if (feeding) {
            CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
        }
        CHECK(se3d_particles_run(b.bed.particles, 0.1) == SE3D_OK);
        read_bed();
        CHECK(feeding ? b.count > 50 : b.count == 1);
        z[feeding] = b.r[2];
        bed_close(&b.bed);
    }
    CHECK_NEAR(z[1], z[0], 1e-15);
}

static void sinks_remove_what_is_in_their_region(void)
{
    const double r[15] = {0.0, 0.0, 0.0, 0.9, 0.9, 0.0, 2.0, 0.0,
                          0.0, 2.9, 0.9, 0.0, 5.0, 0.0, 0.0};
    const double radius[5] = {0.01, 0.01, 0.01, 0.01, 0.01};
    const uint32_t tagged[2] = {0, 4};
    se3d_particles_sink_def box = se3d_particles_sink_def_default(), ball = box, plane = box;
    uint64_t count[3];
    uint32_t number;
    open_bed(0.0, NULL);
    CHECK(!se3d_particles_add(b.bed.particles, b.bed.material, 5, r, radius, NULL, NULL, NULL));
    CHECK(se3d_particles_set_tags(b.bed.particles, 2, tagged, 9) == SE3D_OK);
    for (int a = 0; a < 3; ++a) {
        box.lower[a] = ball.lower[a] = -1.0;
        box.upper[a] = ball.upper[a] = 1.0;
    }
    box.lower[0] += 2.0;
    box.upper[0] += 2.0;
    ball.region = SE3D_FILL_REGION_SPHERE;
    plane.normal[0] = -2.0;
    plane.point[0] = 4.0;
    CHECK(!se3d_particles_add_sink(b.bed.particles, &box, &number) && number == 0);
    CHECK(!se3d_particles_add_sink(b.bed.particles, &ball, &number) && number == 1);
    CHECK(!se3d_particles_add_sink(b.bed.particles, &plane, &number) && number == 2);
    CHECK(se3d_particles_step(b.bed.particles, 1) == SE3D_OK);
    for (uint32_t k = 0; k < 3; ++k) {
        CHECK(se3d_particles_get_sink_count(b.bed.particles, k, &count[k]) == SE3D_OK);
    }
    CHECK(count[0] == 2 && count[1] == 1 && count[2] == 1);
    uint32_t ids[1], tags[1];
    CHECK(se3d_particles_get_ids(b.bed.particles, 1, ids) == SE3D_OK && ids[0] == 1);
    CHECK(se3d_particles_get_tags(b.bed.particles, 1, tags) == SE3D_OK && tags[0] == 0);
    se3d_particles_tally tally;
    CHECK(se3d_particles_get_tally(b.bed.particles, 9, &tally) == SE3D_OK);
    CHECK(tally.lost == 2 && tally.count == 0);
    CHECK(se3d_particles_get_tally(b.bed.particles, 0, &tally) == SE3D_OK);
    CHECK(tally.lost == 2 && tally.count == 1);
    se3d_particles_stats stats;
    CHECK(se3d_particles_get_stats(b.bed.particles, &stats) == SE3D_OK);
    CHECK(stats.lost == 4 && stats.left == 4);
    bed_close(&b.bed);
}

static void what_leaves_an_open_domain_is_counted(void)
{
    se3d_particles_def def = se3d_particles_def_default();
    const double r[6] = {0.0, 0.0, 0.0, 0.5, 0.0, 0.0}, radius[2] = {0.01, 0.01};
    const double v[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    se3d_particles_stats stats;
    def.lower[0] = -1.0;
    def.upper[0] = 1.0;
    open_bed(0.0, &def);
    CHECK(!se3d_particles_add(b.bed.particles, b.bed.material, 2, r, radius, v, NULL, NULL));
    CHECK(se3d_particles_run(b.bed.particles, 0.4) == SE3D_OK);
    CHECK(se3d_particles_get_stats(b.bed.particles, &stats) == SE3D_OK && stats.left == 0);
    CHECK(se3d_particles_run(b.bed.particles, 0.6) == SE3D_OK);
    CHECK(se3d_particles_get_stats(b.bed.particles, &stats) == SE3D_OK);
    CHECK(stats.left == 1 && stats.lost == 0 && se3d_particles_count(b.bed.particles) == 2);
    bed_close(&b.bed);
}

/* Two particles fall: one onto a plate, one beside it. */
static void fall_without_end_is_counted(void)
{
    for (int floor = 0; floor < 2; ++floor) {
        const double r[6] = {0.0, 0.0, 0.1, 0.5, 0.0, 0.1}, radius[2] = {0.01, 0.01};
        se3d_shape_def def = se3d_shape_def_default();
        se3d_shape shape;
        se3d_particles_stats stats;
        open_bed(10.0, NULL);
        def.material = b.bed.material;
        def.size[0] = def.size[1] = 0.2;
        def.size[2] = 0.02;
        CHECK(se3d_shape_create_box(b.bed.system, &def, &shape) == SE3D_OK);
        def.normal[2] = 1.0;
        def.position[2] = -20.0;
        if (floor) {
            CHECK(se3d_shape_create_plane(b.bed.system, &def, &shape) == SE3D_OK);
        }
        CHECK(!se3d_particles_add(b.bed.particles, b.bed.material, 2, r, radius, NULL, NULL, NULL));
        CHECK(se3d_particles_run(b.bed.particles, 0.1) == SE3D_OK);
        CHECK(se3d_particles_get_stats(b.bed.particles, &stats) == SE3D_OK && stats.left == 0);
        CHECK(se3d_particles_run(b.bed.particles, 1.0) == SE3D_OK);
        CHECK(se3d_particles_get_stats(b.bed.particles, &stats) == SE3D_OK);
        CHECK(stats.left == (floor ? 0 : 1));
        bed_close(&b.bed);
    }
}

/* verlet finds its step from a source that has given nothing yet, and feeds it. */
static void verlet_moves_what_a_source_gives(void)
{
    se3d_solver_def how = se3d_solver_def_default();
    se3d_solver *solver;
    open_bed(10.0, NULL);
    CHECK(se3d_particles_set_step(b.bed.particles, 0.0) == SE3D_OK);
    b.fill.velocity[2] = -1.0;
    se3d_particles_source_def def = source_of(300.0);
    CHECK(se3d_particles_add_source(b.bed.particles, &def, NULL) == SE3D_OK);
    how.analysis = SE3D_ANALYSIS_DYNAMICS;
    how.method = SE3D_METHOD_VERLET;
    CHECK(!SE3D_FAILED(se3d_solver_create(b.bed.system, &how, &solver)));
    double step = 0.0;
    CHECK(se3d_particles_get_step(b.bed.particles, &step) == SE3D_OK && step > 1e-6 && step < 1e-3);
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.5)));
    CHECK(se3d_particles_count(b.bed.particles) == 150 ||
          se3d_particles_count(b.bed.particles) == 149);
    read_bed();
    CHECK(worst_overlap() <= 0.0);
    se3d_solver_destroy(solver);
    bed_close(&b.bed);
}

/* What the particles do to a body, as one number. */
static double wrench_on(se3d_body body)
{
    double force[3], torque[3];
    CHECK(se3d_particles_get_wrench(b.bed.particles, body, force, torque) == SE3D_OK);
    return fabs(force[0]) + fabs(force[1]) + fabs(force[2]) + fabs(torque[0]) + fabs(torque[1]) +
           fabs(torque[2]);
}

/* A bead slides on a heavy block, without weight, towards x = 0.1. */
static void open_slide(int has_sink, int has_source, se3d_body *block)
{
    const double at[3] = {0.09, 0.0, 0.00499}, v[3] = {1.0, 0.0, 0.0};
    se3d_particles_def domain = se3d_particles_def_default();
    se3d_body_def heavy = se3d_body_def_default();
    se3d_shape_def box = se3d_shape_def_default();
    se3d_shape shape;
    domain.boundary[0] = has_sink ? SE3D_DOMAIN_BOUNDARY_SINK : SE3D_DOMAIN_BOUNDARY_OPEN;
    domain.lower[0] = -1.0;
    domain.upper[0] = 0.1;
    open_bed(0.0, &domain);
    heavy.mass = heavy.inertia[0] = heavy.inertia[1] = heavy.inertia[2] = 10.0;
    heavy.position[2] = -0.5;
    box.size[0] = box.size[1] = box.size[2] = 1.0;
    box.material = b.bed.material;
    CHECK(se3d_body_create(b.bed.system, &heavy, block) == SE3D_OK);
    box.body = *block;
    CHECK(se3d_shape_create_box(b.bed.system, &box, &shape) == SE3D_OK);
    bed_add(&b.bed, at, 0.005, v, NULL);
    if (has_source) {
        se3d_particles_source_def late = source_of(1.0);
        late.start = 5.0;
        CHECK(se3d_particles_add_source(b.bed.particles, &late, NULL) == SE3D_OK);
    }
}

/* The bead goes over a sink or is taken away, with a source that waits or without one: nothing
 * pushes the block any more. */
static void shapes_are_rid_of_what_has_left(void)
{
    const uint32_t bead = 0;
    for (int way = 0; way < 4; ++way) {
        se3d_body block;
        se3d_solver_def how = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        double before[3], after[3];
        open_slide(!(way & 2), way & 1, &block);
        how.method = SE3D_METHOD_VERLET;
        CHECK(se3d_solver_create(b.bed.system, &how, &solver) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 1e-4) == SE3D_OK);
        CHECK(wrench_on(block) > 0.01);
        CHECK(!(way & 2) || se3d_particles_remove(b.bed.particles, 1, &bead) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.02) == SE3D_OK);
        CHECK(se3d_particles_count(b.bed.particles) == 0);
        CHECK(wrench_on(block) == 0.0);
        CHECK(se3d_body_get_velocity(b.bed.system, block, before) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.03) == SE3D_OK);
        CHECK(se3d_body_get_velocity(b.bed.system, block, after) == SE3D_OK);
        CHECK(after[2] < 0.0 && memcmp(before, after, sizeof after) == 0);
        se3d_solver_destroy(solver);
        bed_close(&b.bed);
    }
}

int main(void)
{
    RUN(source_gives_its_rate_with_its_velocity);
    RUN(rate_may_be_a_function_and_a_mass);
    RUN(what_finds_no_room_waits);
    RUN(source_ends_at_its_maximum);
    RUN(chute_gives_the_same_bits_however_it_is_run);
    RUN(snapshots_and_clones_of_the_system_include_sources);
    RUN(insertion_does_not_disturb_others);
    RUN(sinks_remove_what_is_in_their_region);
    RUN(what_leaves_an_open_domain_is_counted);
    RUN(fall_without_end_is_counted);
    RUN(verlet_moves_what_a_source_gives);
    RUN(shapes_are_rid_of_what_has_left);
    return check_finish();
}
