/* SPDX-License-Identifier: BSD-3-Clause */
/* Fixed particles: what meets one meets a wall that does not give way; a base of them moves as it
 * is told, and what it gives to a bed that it shears is in the energy balance. */
#include "support/bed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define G      9.81
#define RADIUS 0.01
#define EDGE   6 /* particles of the base along x and y */

static const double down[3] = {0.0, 0.0, -G}, none[3] = {0.0, 0.0, 0.0};

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2e4;
    def.young = 1e7;
    def.restitution = 0.6;
    return def;
}

static void fix(bed *b, uint32_t first, size_t count, int32_t fixed)
{
    uint32_t ids[EDGE * EDGE];
    for (size_t k = 0; k < count; ++k) {
        ids[k] = first + (uint32_t)k;
    }
    CHECK(!se3d_particles_set_fixed(b->particles, count, ids, fixed));
}

/* The restitution that is given, with the whole mass of the other one, by both laws and also if all
 * are alike; with half of it .6 would come out as .49 by hooke. */
static void ball_leaves_a_fixed_one_by_its_restitution(void)
{
    for (int32_t k = 0; k < 4; ++k) {
        bed b;
        se3d_particles_def def = se3d_particles_def_default();
        const se3d_material_def material = stuff();
        const double high[3] = {0.0, 0.0, 2.01 * RADIUS}, v[3] = {0.0, 0.0, -0.5};
        double r[6], u[6];
        def.portable = k / 2;
        bed_open(&b, k % 2, none, &def, &material);
        bed_add(&b, none, RADIUS, none, NULL);
        bed_add(&b, high, RADIUS, v, NULL);
        fix(&b, 0, 1, 1);
        CHECK(se3d_particles_run(b.particles, 0.02) >= 0);
        CHECK(se3d_particles_count_contacts(b.particles) == 0);
        CHECK(!se3d_particles_get_all(b.particles, 2, r, u, NULL));
        CHECK_NEAR(u[5] / 0.5, 0.6, 2e-3);
        CHECK(memcmp(r, none, sizeof none) == 0 && memcmp(u, none, sizeof none) == 0);
        bed_close(&b);
    }
}

/* What neither gives way nor moves freely does nothing to each other, whatever they overlap. */
static void fixed_ones_in_a_wall_press_on_nothing(void)
{
    bed b;
    const se3d_particles_def def = se3d_particles_def_default();
    const se3d_material_def material = stuff();
    const double in[3] = {0.0, 0.0, 0.5 * RADIUS}, on[3] = {0.0, 0.0, 2.4 * RADIUS};
    const double up[3] = {0.0, 0.0, 1.0};
    double r[6], u[6];
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, &def, &material);
    bed_add_plane(&b, none, up);
    bed_add(&b, in, RADIUS, none, NULL);
    bed_add(&b, on, RADIUS, none, NULL);
    fix(&b, 0, 1, 1);
    CHECK(se3d_particles_run(b.particles, 0.05) >= 0);
    CHECK(se3d_particles_count_contacts(b.particles) <= 1); /* of the two */
    CHECK(!se3d_particles_get_all(b.particles, 2, r, u, NULL));
    CHECK(memcmp(r, in, sizeof in) == 0 && fabs(u[5]) < 1.0);
    bed_close(&b);
}

static void bytes_tell_who_has_just_been_fixed(void)
{
    bed b;
    const se3d_particles_def def = se3d_particles_def_default();
    const se3d_material_def material = stuff();
    const double above[3] = {0.0, 0.0, 1.99 * RADIUS};
    se3d_snapshot *kept = NULL, *copy = NULL;
    size_t size = 0;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, &def, &material);
    bed_add(&b, none, RADIUS, none, NULL);
    bed_add(&b, above, RADIUS, none, NULL);
    CHECK(se3d_particles_run(b.particles, 0.001) >= 0);
    fix(&b, 1, 1, 1);
    CHECK(!se3d_snapshot_create(b.system, &kept) && !se3d_snapshot_write(kept, NULL, 0, &size));
    void *bytes = malloc(size);
    CHECK(bytes && !se3d_snapshot_write(kept, bytes, size, &size));
    CHECK(!se3d_snapshot_read(b.system, bytes, size, &copy));
    free(bytes);
    se3d_snapshot_destroy(copy);
    se3d_snapshot_destroy(kept);
    bed_close(&b);
}

/* Under gravity, through each other; once let go they fall. */
static void fixed_ones_go_on_until_they_are_let_go(void)
{
    bed b;
    const se3d_material_def material = stuff();
    const double v[3] = {0.1, 0.0, 0.2}, back[3] = {0.015, 0.0, 0.0}, w[3] = {0.0, 3.0, 0.0};
    double r[6], u[6], spin[6];
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    bed_add(&b, none, RADIUS, v, w);
    bed_add(&b, back, RADIUS, none, NULL);
    fix(&b, 0, 2, 1);
    CHECK(se3d_particles_run(b.particles, 0.1) >= 0);
    CHECK(!se3d_particles_get_all(b.particles, 2, r, u, spin));
    CHECK_NEAR(r[0], 0.01, 1e-15);
    CHECK_NEAR(r[2], 0.02, 1e-15);
    CHECK(memcmp(u, v, sizeof v) == 0 && memcmp(spin, w, sizeof w) == 0);
    CHECK(memcmp(r + 3, back, sizeof back) == 0);
    fix(&b, 1, 1, 0);
    CHECK(se3d_particles_run(b.particles, 0.2) >= 0);
    CHECK(!se3d_particles_get_all(b.particles, 2, r, u, spin));
    CHECK_NEAR(u[5], -0.1 * G, 1e-9);
    CHECK_NEAR(u[2], 0.2, 0.0);
    bed_close(&b);
}

static double all_of(const bed *b)
{
    se3d_particles_dissipation d;
    se3d_particles_energy e;
    CHECK(!se3d_particles_get_dissipation(b->particles, &d));
    CHECK(!se3d_particles_get_energy(b->particles, &e));
    return e.translation + e.rotation + e.potential + d.elastic + d.normal + d.tangential -
           d.wall_work;
}

/* Particles on a base that goes along x with .3 m/s, periodic along x and y. */
static void open_sheared(bed *b, int32_t threads)
{
    se3d_particles_def def = se3d_particles_def_default();
    const se3d_material_def material = stuff();
    const double v[3] = {0.3, 0.0, 0.0};
    se3d_fill_def fill = se3d_fill_def_default();
    def.threads = threads;
    def.audit = 1;
    def.boundary[0] = def.boundary[1] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    def.upper[0] = def.upper[1] = EDGE * 2.0 * RADIUS;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, down, &def, &material);
    for (int k = 0; k < EDGE * EDGE; ++k) {
        const double r[3] = {(2 * (k % EDGE) + 1) * RADIUS, (2 * (k / EDGE) + 1) * RADIUS, 0.0};
        bed_add(b, r, RADIUS, v, NULL);
    }
    fix(b, 0, EDGE * EDGE, 1);
    fill.material = b->material;
    fill.upper[0] = fill.upper[1] = def.upper[0];
    fill.lower[2] = RADIUS;
    fill.upper[2] = 0.12;
    fill.radius_min = 0.008;
    fill.radius_max = RADIUS;
    fill.jitter = 0.0005;
    CHECK(!se3d_particles_fill_lattice(b->particles, &fill, NULL));
}

/* Written as bytes and read by a system of the same make. */
static void move_on(const bed *from, bed *to)
{
    se3d_snapshot *snapshot = NULL, *read = NULL;
    size_t size = 0;
    CHECK(!se3d_snapshot_create(from->system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, NULL, 0, &size));
    void *bytes = malloc(size);
    CHECK(!se3d_snapshot_write(snapshot, bytes, size, &size));
    CHECK(!se3d_snapshot_read(to->system, bytes, size, &read));
    CHECK(!se3d_snapshot_restore(read, to->system));
    se3d_snapshot_destroy(snapshot);
    se3d_snapshot_destroy(read);
    free(bytes);
}

static void base_shears_a_bed(void)
{
    bed one, three;
    double r[3 * 400], v[3 * 400];
    open_sheared(&one, 1);
    open_sheared(&three, 3);
    const double before = all_of(&one);
    CHECK(se3d_particles_run(one.particles, 0.15) >= 0);
    move_on(&one, &three);
    CHECK(se3d_particles_run(one.particles, 0.3) >= 0);
    CHECK(se3d_particles_run(three.particles, 0.3) >= 0);
    CHECK(se3d_particles_hash(one.particles) == se3d_particles_hash(three.particles));
    se3d_particles_dissipation d;
    CHECK(!se3d_particles_get_dissipation(one.particles, &d));
    CHECK(d.wall_work > 0.05 * (d.normal + d.tangential));
    CHECK_NEAR((all_of(&one) - before) / (d.normal + d.tangential), 0.0, 2e-3);
    const size_t count = se3d_particles_count(one.particles);
    double mean = 0.0;
    CHECK(count > 100 && count <= 400);
    CHECK(!se3d_particles_get_all(one.particles, count, r, v, NULL));
    for (size_t k = 0; k < count; ++k) {
        const int base = k < EDGE * EDGE;
        CHECK(!base || (r[3 * k + 2] == 0.0 && v[3 * k] == 0.3 && v[3 * k + 2] == 0.0));
        CHECK(r[3 * k + 2] >= 0.0); /* nothing falls through */
        mean += base ? 0.0 : v[3 * k] / (double)(count - EDGE * EDGE);
    }
    CHECK(mean > 0.1 && mean < 0.3);
    bed_close(&one);
    bed_close(&three);
}

static void clumps_and_cells_refuse(void)
{
    bed b;
    const se3d_material_def material = stuff();
    se3d_particles_def def = se3d_particles_def_default();
    const se3d_cell_def cell = se3d_cell_def_default();
    const uint32_t ids[3] = {0, 1, 2};
    for (int a = 0; a < 3; ++a) {
        def.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        def.upper[a] = 0.2;
    }
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    bed_add(&b, none, RADIUS, none, NULL);
    fix(&b, 0, 1, 1);
    CHECK(se3d_particles_add_cell_stage(b.particles, &cell, NULL) == SE3D_ERR_STATE);
    fix(&b, 0, 1, 0);
    const double r[6] = {0.0, 0.0, 0.0, RADIUS, 0.0, 0.0}, radius[2] = {RADIUS, RADIUS};
    se3d_clump_def clump = se3d_clump_def_default();
    const double at[3] = {0.1, 0.1, 0.1};
    uint32_t template;
    clump.r = r;
    clump.radius = radius;
    clump.count = 2;
    CHECK(!se3d_particles_add_clump_template(b.particles, &clump, &template));
    CHECK(!se3d_particles_add_clumps(b.particles, template, b.material, 1, at, NULL, NULL, NULL));
    CHECK(se3d_particles_set_fixed(b.particles, 3, ids, 1) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(strstr(se3d_system_get_error(b.system), "is a sphere of a clump"));
    CHECK(!se3d_particles_set_fixed(b.particles, 3, ids, 0));
    bed_close(&b);
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    bed_add(&b, none, RADIUS, none, NULL);
    CHECK(!se3d_particles_add_cell_stage(b.particles, &cell, NULL));
    CHECK(se3d_particles_set_fixed(b.particles, 1, ids, 1) == SE3D_ERR_STATE);
    bed_close(&b);
}

int main(void)
{
    RUN(ball_leaves_a_fixed_one_by_its_restitution);
    RUN(fixed_ones_in_a_wall_press_on_nothing);
    RUN(bytes_tell_who_has_just_been_fixed);
    RUN(fixed_ones_go_on_until_they_are_let_go);
    RUN(base_shears_a_bed);
    RUN(clumps_and_cells_refuse);
    return check_finish();
}
