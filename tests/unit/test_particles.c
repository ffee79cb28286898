/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles: editing, neighbours against a search of all pairs, conservation, walls, failures. */
#include "check.h"
#include "contact/bodies/restitution.h"
#include "particles/grid.h"
#include "particles/wall.h"
#include "se3d/se3d.h"
#include "support/bed.h"
#include "system/particles.h"

#include <stdlib.h>

#define PI 3.1415926535897932384626433832795

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2.5e4;
    def.young = 1e8;
    def.friction = 0.5;
    def.restitution = 0.7;
    return def;
}

static const double none[3] = {0.0, 0.0, 0.0}, down[3] = {0.0, 0.0, -9.81};

static se3d_shape plane_at(bed *b, double x, double y, double z, double nx, double ny, double nz)
{
    const double point[3] = {x, y, z}, normal[3] = {nx, ny, nz};
    return bed_add_plane(b, point, normal);
}

static void box_around(bed *b, double width)
{
    plane_at(b, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    plane_at(b, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
    plane_at(b, width, 0.0, 0.0, -1.0, 0.0, 0.0);
    plane_at(b, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0);
    plane_at(b, 0.0, width, 0.0, 0.0, -1.0, 0.0);
}

static se3d_fill_def region(const bed *b, double width, double height, double small, double large)
{
    se3d_fill_def def = se3d_fill_def_default();
    def.material = b->material;
    def.radius_min = small;
    def.radius_max = large;
    def.upper[0] = def.upper[1] = width;
    def.upper[2] = height;
    def.seed = 7;
    return def;
}

static void restitution_and_damping_are_inverse(void)
{
    /* Clipped values of Tsuji's formula: data of the literature. */
    static const double typed[4] = {0.3, 0.5, 0.7, 0.9},
                        obtained[4] = {0.397141, 0.550283, 0.718201, 0.902026};
    for (int k = 0; k < 4; ++k) {
        double l = log(typed[k]);
        double alpha = -sqrt(5.0) * l / sqrt(PI * PI + l * l);
        CHECK_NEAR(se3di_restitution_hertz(alpha), obtained[k], 1e-6);
    }
    for (double e = 0.01; e <= 1.0; e += 0.0099) {
        CHECK_NEAR(se3di_restitution_hertz(se3di_restitution_hertz_damping(e)), e, 1e-8);
        CHECK_NEAR(se3di_restitution_hooke(se3di_restitution_hooke_damping(e)), e, 1e-8);
    }
    CHECK_NEAR(se3di_restitution_hooke(1.0), exp(-2.0), 1e-12);
}

/* Every pair nearer than its reaches is in the list, once, and owned by a slab as it must be. */
static void check_list(const se3di_particles *set)
{
    const double *stretch = se3di_particles_reach(set);
    size_t expected = 0, found = 0;
    for (size_t i = 0; i < set->count; ++i) {
        for (size_t j = i + 1; j < set->count; ++j) {
            double d[3];
            for (int a = 0; a < 3; ++a) {
                d[a] = set->particles[i].x[a] - set->particles[j].x[a];
            }
            se3di_particles_wrap(set, d);
            const double reach =
                set->particles[i].radius + set->particles[j].radius + stretch[i] + stretch[j];
            expected += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach;
        }
    }
    unsigned char *slab = calloc(set->count, 1);
    for (uint32_t s = 0; slab && s < set->slab_count; ++s) {
        for (uint32_t k = set->slabs[s].begin; k < set->slabs[s].end; ++k) {
            slab[k] = (unsigned char)s;
        }
    }
    for (size_t i = 0; slab && i < set->count; ++i) {
        for (uint32_t k = set->first[i]; k < set->first[i + 1]; ++k) {
            uint32_t j = set->list[k] & ~SE3DI_LIST_ACTIVE;
            uint32_t ahead = (slab[j] + set->slab_count - slab[i]) % set->slab_count;
            CHECK(ahead == 1 || (ahead == 0 && j > i));
            for (uint32_t m = set->first[i]; m < k; ++m) {
                CHECK((set->list[m] & ~SE3DI_LIST_ACTIVE) != j);
            }
            ++found;
        }
    }
    free(slab);
    CHECK(found == expected && expected > 0);
}

static void neighbours_are_those_of_a_search_of_all_pairs(void)
{
    for (int k = 0; k < 24; ++k) {
        se3d_particles_def def = se3d_particles_def_default();
        bed b;
        se3d_material_def material = stuff();
        for (int a = 0; a < 3; ++a) {
            def.boundary[a] =
                k >> a & 1 ? SE3D_DOMAIN_BOUNDARY_PERIODIC : SE3D_DOMAIN_BOUNDARY_OPEN;
            def.upper[a] = a == 2 ? 1.2 : 0.5;
        }
        bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
        double ratio = k < 8 ? 1.0 : k < 16 ? 3.0 : 25.0;
        se3d_fill_def fill = region(&b, 0.5, 1.2, 0.05 / ratio, 0.05);
        fill.count = k < 8 ? 60 : 100;
        CHECK(se3d_particles_fill_random(b.particles, &fill) == SE3D_OK);
        if (k >= 16) {
            fill.radius_max = 0.004;
            fill.count = 600;
            CHECK(se3d_particles_fill_random(b.particles, &fill) == SE3D_OK);
        }
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        CHECK(se3d_particles_count_contacts(b.particles) == 0); /* nothing overlaps */
        check_list(&b.particles->set);
        bed_close(&b);
    }
}

/* A cloud that shrinks into collisions: sums of momentum about the origin. */
static void sum(const bed *b, double momentum[3], double angular[3], double *kinetic)
{
    size_t n = se3d_particles_count(b->particles);
    double *r = malloc(9 * n * sizeof *r), *radius = malloc(n * sizeof *radius);
    double *v = r + 3 * n, *w = r + 6 * n;
    CHECK(se3d_particles_get_all(b->particles, n, r, v, w) == SE3D_OK);
    CHECK(se3d_particles_get_radii(b->particles, n, radius) == SE3D_OK);
    memset(momentum, 0, 3 * sizeof *momentum);
    memset(angular, 0, 3 * sizeof *angular);
    for (size_t k = 0; k < n; ++k) {
        double m = 2500.0 * 4.0 / 3.0 * PI * radius[k] * radius[k] * radius[k];
        double spin = 0.4 * m * radius[k] * radius[k];
        for (int a = 0; a < 3; ++a) {
            int p = (a + 1) % 3, q = (a + 2) % 3;
            momentum[a] += m * v[3 * k + (size_t)a];
            angular[a] +=
                spin * w[3 * k + (size_t)a] + m * (r[3 * k + (size_t)p] * v[3 * k + (size_t)q] -
                                                   r[3 * k + (size_t)q] * v[3 * k + (size_t)p]);
        }
    }
    se3d_particles_energy energy;
    CHECK(se3d_particles_get_energy(b->particles, &energy) == SE3D_OK);
    *kinetic = energy.translation + energy.rotation;
    free(r);
    free(radius);
}

static void free_cloud(se3d_contact_law law, double restitution, double rolling, int portable,
                       double ratio)
{
    se3d_particles_def def = se3d_particles_def_default();
    def.portable = portable;
    se3d_material_def material = stuff();
    material.restitution = restitution;
    material.rolling_friction = material.torsional_friction = rolling;
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = (int32_t)law;
    CHECK(se3d_system_set_contact(b.system, &contact) == SE3D_OK);
    se3d_fill_def fill = region(&b, 0.12, 0.12, 0.005 / ratio, 0.005);
    fill.count = 500;
    CHECK(se3d_particles_fill_random(b.particles, &fill) == SE3D_OK);
    double state[9 * 500];
    double *v = state + 1500, *w = state + 3000;
    uint64_t seed = 5;
    CHECK(se3d_particles_get_all(b.particles, 500, state, NULL, NULL) == SE3D_OK);
    for (size_t k = 0; k < 1500; ++k) {
        v[k] = 0.3 * check_random(&seed) - 5.0 * (state[k] - 0.06);
        w[k] = 30.0 * check_random(&seed);
    }
    CHECK(se3d_particles_set_all(b.particles, 500, NULL, v, w) == SE3D_OK);
    double p0[3], l0[3], e0, p1[3], l1[3], e1;
    sum(&b, p0, l0, &e0);
    uint64_t contacts = 0;
    for (int k = 0; k < 20; ++k) {
        se3d_particles_stats stats;
        CHECK(se3d_particles_step(b.particles, 100) == SE3D_OK);
        CHECK(se3d_particles_get_stats(b.particles, &stats) == SE3D_OK);
        contacts += stats.contacts;
    }
    CHECK(contacts > 20);
    sum(&b, p1, l1, &e1);
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(p1[a], p0[a], 1e-14); /* of 0.3 kg m/s exchanged */
        CHECK_NEAR(l1[a], l0[a], 1e-15);
    }
    CHECK(e1 < e0 * (restitution < 1.0 ? 0.95 : 1.001));
    bed_close(&b);
}

static void free_cloud_conserves_momentum_and_angular_momentum(void)
{
    for (int k = 0; k < 16; ++k) {
        free_cloud(k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                   k & 2 ? 0.6 : 1.0, k & 4 ? 0.1 : 0.0, (k & 8) != 0, k & 2 ? 1.0 : 4.0);
    }
}

static void frictionless_elastic_cloud_keeps_its_energy(void)
{
    se3d_material_def material = stuff();
    material.friction = 0.0;
    material.restitution = 1.0;
    double drift[2];
    for (int fine = 0; fine < 2; ++fine) {
        bed b;
        bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
        const double r[6] = {0.0, 0.0, 0.0, 0.0099, 0.002, 0.0}, radius[2] = {0.005, 0.005};
        const double v[6] = {0.5, 0.0, 0.0, -0.5, 0.0, 0.0};
        CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, v, NULL, NULL) == SE3D_OK);
        double p[3], l[3], e0, e1, step;
        sum(&b, p, l, &e0);
        CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
        CHECK(se3d_particles_set_step(b.particles, fine ? step / 4.0 : step) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 1000) == SE3D_OK);
        CHECK(se3d_particles_count_contacts(b.particles) == 0);
        sum(&b, p, l, &e1);
        /* They start overlapped: that energy is known. */
        double d = sqrt(0.0099 * 0.0099 + 0.002 * 0.002);
        double overlap = 0.01 - d > 0.0 ? 0.01 - d : 0.0;
        drift[fine] = fabs(e1 / (e0 + 0.5 * 2.5e4 * overlap * overlap) - 1.0);
        bed_close(&b);
    }
    CHECK(drift[0] < 2e-3);
    CHECK(drift[1] < drift[0] / 3.0 + 1e-12);
}

static void settled_box_weighs_what_it_holds(void)
{
    se3d_material_def material = stuff();
    material.restitution = 0.1;
    material.stiffness = 2.5e3; /* long steps */
    material.rolling_friction = 0.05;
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    box_around(&b, 0.044);
    se3d_fill_def fill = region(&b, 0.044, 0.055, 0.004, 0.005);
    fill.jitter = 0.0004;
    size_t count;
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, &count) == SE3D_OK);
    CHECK(count == 4 * 4 * 5);
    CHECK(se3d_particles_run(b.particles, 1.0) == SE3D_OK);
    double force[3], torque[3], weight = 0.0, radius[80];
    CHECK(se3d_particles_get_radii(b.particles, count, radius) == SE3D_OK);
    for (size_t k = 0; k < count; ++k) {
        weight += 2500.0 * 4.0 / 3.0 * PI * radius[k] * radius[k] * radius[k] * 9.81;
    }
    se3d_body ground;
    CHECK(se3d_system_get_ground(b.system, &ground) == SE3D_OK);
    CHECK(se3d_particles_get_wrench(b.particles, ground, force, torque) == SE3D_OK);
    CHECK_NEAR(force[2] / weight, -1.0, 1e-6);
    CHECK_NEAR(force[0] / weight, 0.0, 1e-6);
    /* contacts as exported are those forces */
    size_t contacts = se3d_particles_count_contacts(b.particles);
    se3d_particles_contact *list = malloc(contacts * sizeof *list);
    CHECK(se3d_particles_get_contacts(b.particles, contacts, list) == SE3D_OK);
    double on_walls = 0.0;
    size_t walls = 0;
    for (size_t k = 0; k < contacts; ++k) {
        on_walls += list[k].shape.index1 ? list[k].force[2] : 0.0;
        walls += list[k].shape.index1 != 0;
    }
    CHECK(walls > 16 && contacts - walls > 100);
    CHECK_NEAR(on_walls / weight, 1.0, 1e-5);
    free(list);
    bed_close(&b);
}

/* The largest change of a coordinate since the last call; r: [6 * n], then and now. */
static double distance_moved(const bed *b, size_t n, double *r)
{
    double most = 0.0;
    CHECK(se3d_particles_get_all(b->particles, n, r + 3 * n, NULL, NULL) == SE3D_OK);
    for (size_t k = 0; k < 3 * n; ++k) {
        most = fmax(most, fabs(r[3 * n + k] - r[k]));
    }
    memcpy(r, r + 3 * n, 3 * n * sizeof *r);
    return most;
}

static void pile_does_not_creep(void)
{
    se3d_material_def material = stuff();
    material.restitution = 0.05;
    material.stiffness = 2.5e3;        /* long steps */
    material.rolling_friction = 0.005; /* one that lies alone would roll for ever */
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    box_around(&b, 0.044);
    se3d_fill_def fill = region(&b, 0.044, 0.055, 0.005, 0.005);
    fill.jitter = 0.0004;
    fill.seed = 1;
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, NULL) == SE3D_OK);
    size_t n = se3d_particles_count(b.particles);
    double *r = calloc(6 * n, sizeof *r), t = 1.5, moved;
    do { /* until the last one that rolled in its cage lies */
        CHECK(se3d_particles_run(b.particles, t) == SE3D_OK);
        moved = distance_moved(&b, n, r);
        t += 0.5;
    } while (moved > 1e-10 && t < 8.0);
    CHECK_NEAR(moved, 0.0, 1e-10);
    CHECK(se3d_particles_run(b.particles, t + 0.5) == SE3D_OK);
    CHECK_NEAR(distance_moved(&b, n, r), 0.0, 2e-10); /* in 1 s */
    free(r);
    bed_close(&b);
}

static void body_with_a_wall_carries_the_particles_and_feels_them(void)
{
    se3d_material_def material = stuff();
    material.restitution = 0.1;
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    se3d_body_def body = se3d_body_def_default();
    se3d_body tray;
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[0] = 1.0;
    CHECK(se3d_body_create(b.system, &body, &tray) == SE3D_OK);
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape wall;
    def.body = tray;
    def.material = b.material;
    def.size[0] = def.size[1] = 0.2;
    def.size[2] = 0.02;
    CHECK(se3d_shape_create_box(b.system, &def, &wall) == SE3D_OK);
    CHECK(se3d_body_destroy(b.system, tray) == SE3D_ERR_IN_USE);
    const double r[3] = {1.05, 0.02, 0.015}, radius = 0.005;
    CHECK(se3d_particles_add(b.particles, b.material, 1, r, &radius, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.5) == SE3D_OK);
    double weight = 2500.0 * 4.0 / 3.0 * PI * 1.25e-7 * 9.81, force[3], torque[3];
    CHECK(se3d_shape_get_wrench(b.system, wall, force, torque) == SE3D_OK);
    CHECK_NEAR(force[2] / weight, -1.0, 1e-6);
    CHECK_NEAR(torque[0] / weight, -0.02, 1e-6);
    CHECK_NEAR(torque[1] / weight, 0.05, 1e-6);
    /* Move the tray up slowly by more than the skin: the particle goes with it. */
    const double v[3] = {0.0, 0.0, 0.1};
    double at[3] = {1.0, 0.0, 0.0}, x[3], step;
    CHECK(se3d_body_set_velocity(b.system, tray, v) == SE3D_OK);
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    while (at[2] < 0.0035) {
        at[2] += v[2] * step;
        CHECK(se3d_body_set_position(b.system, tray, at) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
    }
    CHECK(se3d_particles_get_all(b.particles, 1, x, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(x[2] - at[2], 0.015, 2e-6);
    CHECK(at[2] > 0.003);
    CHECK(se3d_shape_destroy(b.system, wall) == SE3D_OK);
    CHECK(se3d_shape_destroy(b.system, wall) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_particles_run(b.particles, 2.0) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, x, NULL, NULL) == SE3D_OK);
    CHECK(x[2] < -1.0); /* nothing holds it */
    CHECK(se3d_body_destroy(b.system, tray) == SE3D_OK);
    bed_close(&b);
}

static void particles_are_added_and_removed_while_others_touch(void)
{
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    plane_at(&b, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    const double r[6] = {0.0, 0.0, 0.0049, 0.0, 0.0, 0.0148}, radius[2] = {0.005, 0.005};
    uint32_t first, ids[3];
    CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, NULL, NULL, &first) == SE3D_OK);
    CHECK(first == 0);
    CHECK(se3d_particles_run(b.particles, 0.3) == SE3D_OK);
    double before[6], after[9];
    CHECK(se3d_particles_get_all(b.particles, 2, before, NULL, NULL) == SE3D_OK);
    const double far[3] = {1.0, 0.0, 0.005};
    CHECK(se3d_particles_add(b.particles, b.material, 1, far, radius, NULL, NULL, &first) ==
          SE3D_OK);
    CHECK(first == 2 && se3d_particles_count(b.particles) == 3);
    CHECK(se3d_particles_run(b.particles, 0.4) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 3, after, NULL, NULL) == SE3D_OK);
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(after[k], before[k], 1e-8);
    }
    const uint32_t gone = 1;
    CHECK(se3d_particles_remove(b.particles, 1, &gone) == SE3D_OK);
    CHECK(se3d_particles_remove(b.particles, 1, &gone) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_count(b.particles) == 2);
    CHECK(se3d_particles_get_ids(b.particles, 2, ids) == SE3D_OK);
    CHECK(ids[0] == 0 && ids[1] == 2);
    CHECK(se3d_particles_run(b.particles, 0.6) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 2, after, NULL, NULL) == SE3D_OK);
    CHECK(after[2] > before[2]); /* relieved */
    CHECK(se3d_particles_get_all(b.particles, 3, after, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    bed_close(&b);
}

static void particles_that_leave_are_counted(void)
{
    se3d_particles_def def = se3d_particles_def_default();
    def.boundary[2] = SE3D_DOMAIN_BOUNDARY_SINK;
    def.lower[2] = -0.5;
    def.upper[2] = 10.0;
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, &def, &material);
    se3d_fill_def fill = region(&b, 0.1, 0.1, 0.005, 0.005);
    size_t count;
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, &count) == SE3D_OK);
    CHECK(count == 729);
    CHECK(se3d_particles_run(b.particles, 0.3) == SE3D_OK);
    CHECK(se3d_particles_count(b.particles) == 729);
    CHECK(se3d_particles_run(b.particles, 0.6) == SE3D_OK);
    se3d_particles_stats stats;
    CHECK(se3d_particles_get_stats(b.particles, &stats) == SE3D_OK);
    CHECK(stats.lost == 729 && se3d_particles_count(b.particles) == 0);
    CHECK(se3d_particles_step(b.particles, 10) == SE3D_OK); /* an empty set is fine */
    bed_close(&b);
}

static void pair_overrides_hold(void)
{
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    pair.restitution = 0.3;
    CHECK(se3d_material_set_pair(b.system, b.material, b.material, &pair) == SE3D_OK);
    const double r[6] = {0.0, 0.0, 0.0, 0.0105, 0.0, 0.0}, radius[2] = {0.005, 0.005};
    const double v[6] = {0.1, 0.0, 0.0, -0.1, 0.0, 0.0};
    CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, v, NULL, NULL) == SE3D_OK);
    double u[6], step;
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.particles, step / 8.0) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 8 * 600) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 2, NULL, u, NULL) == SE3D_OK);
    CHECK_NEAR((u[3] - u[0]) / 0.2, 0.3, 1e-3);
    bed_close(&b);
}

static void too_much_overlap_names_particle_and_time(void)
{
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    const double r[9] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.012, 0.0, 0.0};
    const double radius[3] = {0.005, 0.005, 0.005};
    const double v[9] = {0.0, 0.0, 0.0, 50.0, 0.0, 0.0, -50.0, 0.0, 0.0};
    CHECK(se3d_particles_add(b.particles, b.material, 3, r, radius, v, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.1) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(b.system), "particle 1 and particle 2 overlap by 0.");
    CHECK_CONTAINS(se3d_system_get_error(b.system), "at time ");
    CHECK_CONTAINS(se3d_system_get_error(b.system), "(overlap_limit: 0.2); try a stiffer material");
    CHECK(se3d_particles_set_step(b.particles, 1.0) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 1) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(b.system), "step = 1 s");
    bed_close(&b);
}

static void what_was_placed_into_another_is_told_so(void)
{
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape post;
    def.name = "post";
    def.material = b.material;
    def.size[0] = def.size[1] = def.size[2] = 0.1;
    CHECK(se3d_shape_create_box(b.system, &def, &post) == SE3D_OK);
    const double r[6] = {0.3, 0.0, 0.0, 0.052, 0.0, 0.0}, radius[2] = {0.005, 0.005};
    CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.1) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(b.system),
                   "particle 1 and the shape post overlap by 0.6 ");
    CHECK_CONTAINS(se3d_system_get_error(b.system), "they were placed with this overlap");
    bed_close(&b);
}

/* An overlap beyond the limit is told when the step that ends with it is complete: the state is
 * the one of a run that allows it, and goes on like that one. */
static void run_goes_on_after_too_much_overlap(void)
{
    se3d_material_def material = stuff();
    se3d_contact_settings contact = se3d_contact_settings_default();
    const double r[6] = {0.0, 0.0, 0.0, 0.0101, 0.001, 0.0}, radius[2] = {0.005, 0.005};
    const double v[6] = {3.0, 0.0, 0.0, -3.0, 0.0, 0.0};
    bed strict, free;
    material.stiffness = 1e5;
    bed_open(&strict, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    bed_open(&free, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    contact.overlap_limit = 0.05;
    CHECK(se3d_system_set_contact(strict.system, &contact) == SE3D_OK);
    contact.overlap_limit = 1.0;
    CHECK(se3d_system_set_contact(free.system, &contact) == SE3D_OK);
    for (int k = 0; k < 2; ++k) {
        bed *b = k ? &free : &strict;
        CHECK(se3d_particles_add(b->particles, b->material, 2, r, radius, v, NULL, NULL) ==
              SE3D_OK);
    }
    CHECK(se3d_particles_step(strict.particles, 100000) == SE3D_ERR_STEP_SIZE);
    se3d_particles_stats stats;
    CHECK(se3d_particles_get_stats(strict.particles, &stats) == SE3D_OK);
    CHECK(stats.steps > 5 && stats.steps < 1000);
    CHECK(se3d_particles_step(free.particles, (size_t)stats.steps) == SE3D_OK);
    CHECK(se3d_particles_hash(strict.particles) == se3d_particles_hash(free.particles));
    for (int k = 0; k < 2; ++k) {
        bed *b = k ? &free : &strict;
        double step;
        CHECK(se3d_system_set_contact(b->system, &contact) == SE3D_OK);
        CHECK(se3d_particles_get_step(b->particles, &step) == SE3D_OK);
        CHECK(se3d_particles_set_step(b->particles, 0.5 * step) == SE3D_OK);
        CHECK(se3d_particles_step(b->particles, 400) == SE3D_OK);
        CHECK(se3d_particles_count_contacts(b->particles) == 0);
    }
    CHECK(se3d_particles_hash(strict.particles) == se3d_particles_hash(free.particles));
    bed_close(&strict);
    bed_close(&free);
}

static void packing_that_cannot_fit_changes_nothing(void)
{
    se3d_material_def material = stuff();
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    se3d_fill_def fill = region(&b, 0.05, 0.05, 0.005, 0.005);
    fill.count = 200;
    CHECK(se3d_particles_fill_random(b.particles, &fill) == SE3D_ERR_NO_CONVERGENCE);
    CHECK(se3d_particles_count(b.particles) == 0);
    fill.count = 30;
    CHECK(se3d_particles_fill_random(b.particles, &fill) == SE3D_OK);
    CHECK(se3d_particles_count(b.particles) == 30);
    bed_close(&b);
}

int main(void)
{
    RUN(restitution_and_damping_are_inverse);
    RUN(neighbours_are_those_of_a_search_of_all_pairs);
    RUN(free_cloud_conserves_momentum_and_angular_momentum);
    RUN(frictionless_elastic_cloud_keeps_its_energy);
    RUN(settled_box_weighs_what_it_holds);
    RUN(pile_does_not_creep);
    RUN(body_with_a_wall_carries_the_particles_and_feels_them);
    RUN(particles_are_added_and_removed_while_others_touch);
    RUN(particles_that_leave_are_counted);
    RUN(pair_overrides_hold);
    RUN(too_much_overlap_names_particle_and_time);
    RUN(what_was_placed_into_another_is_told_so);
    RUN(run_goes_on_after_too_much_overlap);
    RUN(packing_that_cannot_fit_changes_nothing);
    return check_finish();
}
