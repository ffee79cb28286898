/* SPDX-License-Identifier: BSD-3-Clause */
/* Flows of particles through planes, disks and rectangles: what has passed is what is on the other
 * side, however the particles went there and however the run is cut. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>

#define PI    3.14159265358979323846
#define COUNT 216

static const double none[3] = {0.0, 0.0, 0.0};

static se3d_material_def beads(void)
{
    se3d_material_def material = se3d_material_def_default();
    material.density = 2500.0;
    material.stiffness = 2e4;
    return material;
}

static uint32_t add_flow(const bed *b, const se3d_flow_def *def)
{
    uint32_t flow = 99;
    CHECK(se3d_particles_add_flow(b->particles, def, &flow) == SE3D_OK);
    return flow;
}

static se3d_flow_stats flow_of(const bed *b, uint32_t flow)
{
    se3d_flow_stats stats;
    CHECK(se3d_particles_get_flow(b->particles, flow, &stats) == SE3D_OK);
    return stats;
}

/* A slanted opening: 0 a plane, 1 a disk, 2 a rectangle. */
static se3d_flow_def opening(int kind)
{
    se3d_flow_def def = se3d_flow_def_default();
    def.point[0] = 0.05;
    def.point[1] = def.point[2] = 0.06;
    def.normal[0] = 2.0;
    def.normal[1] = 0.6;
    if (kind == 1) {
        def.radius = 0.04;
    } else if (kind == 2) {
        def.size[0] = 0.05;
        def.size[1] = 0.09;
        def.along[2] = 1.0;
        def.along[0] = 0.5;
    }
    return def;
}

/* Whether a straight way from x by d passes the opening: 1, -1, 0. */
static int passes(const se3d_flow_def *def, const double x[3], const double d[3])
{
    const double *n = def->normal, *e = def->along;
    const double n2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double h = 0.0, speed = 0.0, en = 0.0;
    for (int a = 0; a < 3; ++a) {
        h += n[a] * (x[a] - def->point[a]);
        speed += n[a] * d[a];
        en += e[a] * n[a] / n2;
    }
    if ((h >= 0.0) == (h + speed >= 0.0)) {
        return 0;
    }
    double at[3], u[3], square = 0.0, along = 0.0, length = 0.0;
    for (int a = 0; a < 3; ++a) {
        at[a] = x[a] - d[a] * h / speed - def->point[a];
        u[a] = e[a] - en * n[a];
        square += at[a] * at[a];
        along += at[a] * u[a];
        length += u[a] * u[a];
    }
    along /= sqrt(fmax(length, 1e-300));
    const double across = sqrt(fmax(0.0, square - along * along));
    const int inside = def->radius > 0.0 ? square < def->radius * def->radius
                       : def->size[0] > 0.0
                           ? fabs(along) < 0.5 * def->size[0] && across < 0.5 * def->size[1]
                           : 1;
    return !inside ? 0 : speed > 0.0 ? 1 : -1;
}

/* In free flight, by the straight lines from beginning to end. */
static void free_flight_is_counted_exactly(void)
{
    for (int kind = 0; kind < 3; ++kind) {
        bed b;
        se3d_material_def material = beads();
        const se3d_flow_def def = opening(kind);
        const double time = 0.02;
        uint64_t seed = 3;
        uint64_t forward = 0, backward = 0;
        double mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};
        material.stiffness = 1e-8; /* for long steps */
        bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
        const uint32_t flow = add_flow(&b, &def);
        for (int k = 0; k < COUNT; ++k) {
            const double radius = 1e-6; /* they do not meet */
            double r[3], v[3], d[3];
            for (int a = 0; a < 3; ++a) {
                r[a] = 0.06 + 0.06 * check_random(&seed);
                v[a] = 4.0 * check_random(&seed);
                d[a] = time * v[a];
            }
            bed_add(&b, r, radius, v, none);
            const int way = passes(&def, r, d);
            const double m = 2500.0 * 4.0 / 3.0 * PI * radius * radius * radius;
            forward += way > 0;
            backward += way < 0;
            mass += way * m;
            for (int a = 0; a < 3; ++a) {
                momentum[a] += way * m * v[a];
            }
        }
        CHECK(se3d_particles_set_step(b.particles, 1e-4) == SE3D_OK);
        CHECK(se3d_particles_run(b.particles, time) == SE3D_OK);
        const se3d_flow_stats stats = flow_of(&b, flow);
        CHECK(forward > 0 && backward > 0 && forward + backward > 8);
        CHECK(stats.forward == forward && stats.backward == backward);
        CHECK_NEAR(stats.mass, mass, 1e-25);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(stats.momentum[a], momentum[a], 1e-24);
        }
        CHECK_NEAR(stats.mass_rate, mass / time, 1e-22); /* before the first window is over */
        CHECK_NEAR(stats.count_rate, ((double)forward - (double)backward) / time, 1e-6);
        bed_close(&b);
    }
}

/* Particles that collide in a box with periods, a plane and a funnel. */
static void open_gas(bed *b, int32_t threads, int clumps)
{
    const se3d_material_def material = beads();
    static const double r[6] = {0.0, 0.0, 0.0, 0.003, 0.0, 0.0}, radii[2] = {0.003, 0.003};
    se3d_particles_def set = se3d_particles_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    size_t added;
    set.threads = threads;
    for (int a = 0; a < 3; ++a) {
        set.boundary[a] = a < 2 ? SE3D_DOMAIN_BOUNDARY_PERIODIC : SE3D_DOMAIN_BOUNDARY_OPEN;
        set.lower[a] = 0.0;
        set.upper[a] = a < 2 ? 0.12 : 1.0;
        fill.upper[a] = 0.12;
    }
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, (const double[3]){0.0, 0.0, -9.81}, &set, &material);
    (void)bed_add_plane(b, none, (const double[3]){0.0, 0.0, 1.0});
    fill.material = b->material;
    fill.radius_min = 0.004;
    fill.radius_max = 0.006;
    fill.count = COUNT;
    fill.jitter = 0.0005;
    fill.velocity[2] = -0.5;
    fill.spacing = 0.0145;
    if (clumps) {
        se3d_clump_def def = se3d_clump_def_default();
        uint32_t index;
        def.count = 2;
        def.r = r;
        def.radius = radii;
        CHECK(se3d_particles_add_clump_template(b->particles, &def, &index) == SE3D_OK);
        fill.clump = index + 1;
    }
    CHECK(se3d_particles_fill_lattice(b->particles, &fill, &added) == SE3D_OK);
    size_t n = se3d_particles_count(b->particles);
    double *v = calloc(3 * n, sizeof *v);
    uint64_t seed = 8;
    for (size_t k = 0; v && k < 3 * n; ++k) {
        v[k] = check_random(&seed);
    }
    CHECK(clumps || se3d_particles_set_all(b->particles, n, NULL, v, NULL) == SE3D_OK);
    free(v);
}

static void add_flows(const bed *b)
{
    se3d_flow_def def = se3d_flow_def_default();
    def.point[2] = 0.05;
    def.normal[2] = 1.0;
    def.window = 0.004;
    CHECK(add_flow(b, &def) == 0);
    def = opening(2);
    def.window = 0.003;
    CHECK(add_flow(b, &def) == 1);
}

static int count_above(const bed *b, double height, int clumps)
{
    const size_t n = se3d_particles_count(b->particles);
    double *r = calloc(3 * n, sizeof *r);
    int above = 0;
    CHECK(r && se3d_particles_get_all(b->particles, n, r, NULL, NULL) == SE3D_OK);
    for (size_t k = 0; k < n; ++k) {
        const double z = clumps ? 0.5 * (r[3 * k + 2] + r[3 * (k ^ 1) + 2]) : r[3 * k + 2];
        above += z >= height && (!clumps || k % 2 == 0);
    }
    free(r);
    return above;
}

static void what_has_passed_is_on_the_other_side(void)
{
    for (int clumps = 0; clumps < 2; ++clumps) {
        bed b;
        open_gas(&b, 1, clumps);
        const int before = count_above(&b, 0.05, clumps);
        add_flows(&b);
        CHECK(se3d_particles_run(b.particles, 0.02) == SE3D_OK);
        const se3d_flow_stats stats = flow_of(&b, 0);
        const int after = count_above(&b, 0.05, clumps);
        CHECK(stats.backward > 10);
        CHECK((int)stats.forward - (int)stats.backward == after - before);
        bed_close(&b);
    }
}

static void threads_and_cuts_do_not_change_sums(void)
{
    for (int clumps = 0; clumps < 2; ++clumps) {
        se3d_flow_stats stats[3][2];
        for (int k = 0; k < 3; ++k) {
            bed b;
            open_gas(&b, k == 1 ? 3 : 1, clumps);
            add_flows(&b);
            CHECK(se3d_particles_set_step(b.particles, 1e-5) == SE3D_OK);
            for (int n = 0; n < (k == 2 ? 40 : 1); ++n) {
                CHECK(se3d_particles_step(b.particles, k == 2 ? 25 : 1000) == SE3D_OK);
            }
            stats[k][0] = flow_of(&b, 0);
            stats[k][1] = flow_of(&b, 1);
            bed_close(&b);
        }
        CHECK(stats[0][0].backward > 5);
        CHECK(clumps || stats[0][1].forward + stats[0][1].backward > 0);
        CHECK(memcmp(stats[0], stats[1], sizeof stats[0]) == 0);
        CHECK(memcmp(stats[0], stats[2], sizeof stats[0]) == 0);
    }
}

/* A row of particles that pass one after the other at a known rate. */
static void rates_are_those_of_whole_windows(void)
{
    bed b;
    const se3d_material_def material = beads();
    se3d_flow_def def = se3d_flow_def_default();
    def.point[0] = 0.5005;
    def.normal[0] = -1.0;
    def.window = 0.1;
    def.tag = 0;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    CHECK(se3d_particles_set_step(b.particles, 1e-5) == SE3D_OK);
    const uint32_t all = add_flow(&b, &def);
    def.tag = 3;
    const uint32_t tagged = add_flow(&b, &def);
    const double m = 2500.0 * 4.0 / 3.0 * PI * 1e-9;
    for (int k = 0; k < 200; ++k) { /* a hundred in a second */
        const double r[3] = {0.01 * k, 0.0, 0.0}, v[3] = {-1.0, 0.0, 0.0};
        bed_add(&b, r, 1e-3, v, none);
    }
    CHECK(se3d_particles_run(b.particles, 0.357) == SE3D_OK);
    const se3d_flow_stats stats = flow_of(&b, all), others = flow_of(&b, tagged);
    CHECK(stats.forward == 35 && stats.backward == 0);
    CHECK_NEAR(stats.count_rate, 100.0, 1e-6);
    CHECK_NEAR(stats.mass_rate, 100.0 * m, 1e-8 * m);
    CHECK_NEAR(stats.momentum_rate[0], -100.0 * m, 1e-9 * m);
    CHECK(others.forward == 0 && !(others.mass_rate > 0.0));
    bed_close(&b);
}

#define PLANES 15

/* Planes across the period, at its borders, about them and elsewhere; the last one at an angle. */
static void add_planes(const bed *b)
{
    static const double places[PLANES] = {0.0,        1e-3,   -1e-3, 0.003, 0.01,
                                          0.3,        0.5001, 1.0,   0.999, 1.001,
                                          1.0 + 1e-9, 0.995,  -0.25, 2.625, 0.0};
    for (int k = 0; k < PLANES; ++k) {
        se3d_flow_def def = se3d_flow_def_default();
        def.point[0] = places[k];
        def.point[1] = 0.5;
        def.normal[0] = 1.0;
        def.normal[2] = k == PLANES - 1 ? 0.7 : 0.0;
        CHECK(add_flow(b, &def) == (uint32_t)k);
    }
}

/* A sphere or a clump on a straight way round the period, along the border of the other one: each
 * plane is met each time. */
static void go_round(double speed, int clump, int32_t threads)
{
    static const double radii[2] = {0.01, 0.01}, balls[6] = {0.01, 0.0, 0.0, -0.01, 0.0, 0.0};
    const double r[3] = {0.3005, 0.0, 0.0}, v[3] = {speed, 0.0, 0.0};
    bed b;
    se3d_particles_def set = se3d_particles_def_default();
    se3d_material_def material = beads();
    material.stiffness = 1e-3;
    set.threads = threads;
    for (int a = 0; a < 3; ++a) {
        set.boundary[a] = a < 2 ? SE3D_DOMAIN_BOUNDARY_PERIODIC : SE3D_DOMAIN_BOUNDARY_OPEN;
        set.lower[a] = a < 2 ? 0.0 : -0.5;
        set.upper[a] = a < 2 ? 1.0 : 0.5;
    }
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &set, &material);
    if (clump) {
        se3d_clump_def def = se3d_clump_def_default();
        def.count = 2;
        def.r = balls;
        def.radius = radii;
        CHECK(se3d_particles_add_clump_template(b.particles, &def, NULL) == SE3D_OK);
        CHECK(se3d_particles_add_clumps(b.particles, 0, b.material, 1, r, NULL, v, NULL) ==
              SE3D_OK);
    } else {
        bed_add(&b, r, 0.01, v, none);
    }
    add_planes(&b);
    CHECK(se3d_particles_set_step(b.particles, 3e-3) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 3.0) == SE3D_OK);
    for (uint32_t k = 0; k < PLANES; ++k) {
        const se3d_flow_stats stats = flow_of(&b, k);
        CHECK(stats.forward == (speed > 0.0 ? 3u : 0u));
        CHECK(stats.backward == (speed > 0.0 ? 0u : 3u));
    }
    bed_close(&b);
}

static void planes_at_borders_of_a_period_miss_nothing(void)
{
    for (int k = 0; k < 4; ++k) {
        go_round(k % 2 == 0 ? 1.0 : -1.0, k / 2, 1 + 2 * (k & 1));
    }
}

/* A disk at a border is one with its part beyond it. */
static void disks_go_through_borders(void)
{
    static const double y[4] = {0.95, 0.05, 0.85, 0.15};
    bed b;
    se3d_particles_def set = se3d_particles_def_default();
    const se3d_material_def material = beads();
    se3d_flow_def def = se3d_flow_def_default();
    set.boundary[1] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    for (int a = 0; a < 3; ++a) {
        set.lower[a] = a == 1 ? 0.0 : -1.0;
        set.upper[a] = 1.0;
    }
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &set, &material);
    for (int k = 0; k < 4; ++k) {
        bed_add(&b, (const double[3]){-0.01, y[k], 0.0}, 0.01, (const double[3]){1.0, 0.0, 0.0},
                none);
    }
    def.normal[0] = 1.0;
    def.radius = 0.1;
    const uint32_t low = add_flow(&b, &def);
    def.point[1] = 1.0;
    const uint32_t high = add_flow(&b, &def);
    def.radius = 0.0;
    def.size[0] = 0.32;
    def.size[1] = 0.1;
    def.along[1] = 1.0;
    const uint32_t wide = add_flow(&b, &def);
    CHECK(se3d_particles_set_step(b.particles, 1e-4) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.02) == SE3D_OK);
    CHECK(flow_of(&b, low).forward == 2 && flow_of(&b, high).forward == 2);
    CHECK(flow_of(&b, wide).forward == 4);
    bed_close(&b);
}

int main(void)
{
    RUN(free_flight_is_counted_exactly);
    RUN(what_has_passed_is_on_the_other_side);
    RUN(threads_and_cuts_do_not_change_sums);
    RUN(rates_are_those_of_whole_windows);
    RUN(planes_at_borders_of_a_period_miss_nothing);
    RUN(disks_go_through_borders);
    return check_finish();
}
