/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of spheres against closed forms: collision time, restitution, Hertz (Chung and Ooi 2011,
 * tests 1 and 2), rolling and slipping, static stacks. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#define PI 3.1415926535897932384626433832795
#define G  9.81

/* Gravity g downwards. */
static void open_bed(bed *b, se3d_contact_law law, double g, const se3d_material_def *material)
{
    const double down[3] = {0.0, 0.0, -g};
    bed_open(b, (int32_t)law, down, NULL, material);
}

static se3d_shape floor_at(bed *b, double z, double nx, double nz)
{
    const double at[3] = {0.0, 0.0, z}, normal[3] = {nx, 0.0, nz};
    return bed_add_plane(b, at, normal);
}

static void add(bed *b, double x, double z, double radius, const double v[3], const double w[3])
{
    const double r[3] = {x, 0.0, z};
    bed_add(b, r, radius, v, w);
}

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2.5e4;
    def.young = 1e9;
    def.poisson = 0.3;
    def.friction = 0.5;
    def.restitution = 1.0;
    return def;
}

static double mass_of(double radius)
{
    return 2500.0 * 4.0 / 3.0 * PI * radius * radius * radius;
}

/* Head-on impact at relative velocity `v`; returns the restitution, writes time and overlap. */
static double impact(se3d_contact_law law, const se3d_material_def *def, int wall, double radius,
                     double v, double divide, double out[3])
{
    bed b;
    open_bed(&b, law, 0.0, def);
    const double down[3] = {0.0, 0.0, wall ? -v : -0.5 * v}, up[3] = {0.0, 0.0, 0.5 * v};
    double step;
    add(&b, 0.0, wall ? radius : 2.0 * radius, radius, down, NULL);
    if (wall) {
        floor_at(&b, 0.0, 0.0, 1.0);
    } else {
        add(&b, 0.0, 0.0, radius, up, NULL);
    }
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    step /= divide;
    CHECK(se3d_particles_set_step(b.particles, step) == SE3D_OK);
    double z[6], u[6], f[6];
    size_t n = se3d_particles_count(b.particles);
    long steps = 0;
    out[0] = out[1] = 0.0;
    do {
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        CHECK(se3d_particles_get_all(b.particles, n, z, u, NULL) == SE3D_OK);
        CHECK(se3d_particles_get_forces(b.particles, n, f, NULL) == SE3D_OK);
        out[0] = fmax(out[0], wall ? radius - z[2] : 2.0 * radius - (z[2] - z[5]));
        out[1] = fmax(out[1], f[2]);
        ++steps;
    } while (steps < 10000000 && se3d_particles_count_contacts(b.particles) > 0);
    out[2] = (double)steps * step;
    bed_close(&b);
    return (wall ? u[2] : u[2] - u[5]) / v;
}

static void restitution_typed_is_restitution_obtained(void)
{
    static const double es[4] = {0.3, 0.5, 0.7, 0.9};
    for (int k = 0; k < 32; ++k) {
        se3d_contact_law law = k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
        double v = k & 4 ? 10.0 : 0.1;
        se3d_material_def def = stuff();
        def.restitution = es[k >> 3];
        def.stiffness = 4e6; /* 10 m/s within the allowed overlap */
        double out[3];
        double e = impact(law, &def, (k & 2) != 0, 0.005, v,
                          law == SE3D_CONTACT_LAW_HOOKE ? 8.0 : 16.0, out);
        CHECK_NEAR(e, def.restitution, 1e-3);
    }
}

static void restitution_converges_with_the_step(void)
{
    se3d_material_def def = stuff();
    double out[3];
    def.restitution = 0.7;
    double coarse = fabs(impact(SE3D_CONTACT_LAW_HOOKE, &def, 0, 0.005, 0.1, 1.0, out) - 0.7);
    double fine = fabs(impact(SE3D_CONTACT_LAW_HOOKE, &def, 0, 0.005, 0.1, 16.0, out) - 0.7);
    CHECK(coarse < 1e-2);
    CHECK(fine < coarse / 8.0);
}

static void linear_contact_lasts_half_a_period(void)
{
    se3d_material_def def = stuff();
    double out[3];
    double e = impact(SE3D_CONTACT_LAW_HOOKE, &def, 0, 0.005, 1.0, 20.0, out);
    double rate = sqrt(2.5e4 / (0.5 * mass_of(0.005)));
    CHECK_NEAR(e, 1.0, 1e-6);
    CHECK_NEAR(out[2] * rate / PI, 1.0, 2e-3); /* whole steps */
    CHECK_NEAR(out[0] * rate, 1.0, 1e-4);
    e = impact(SE3D_CONTACT_LAW_HOOKE, &def, 1, 0.005, 1.0, 20.0, out);
    CHECK_NEAR(out[2] * sqrt(2.5e4 / mass_of(0.005)) / PI, 1.0, 2e-3);
    CHECK_NEAR(e, 1.0, 1e-6);
}

static void elastic_impacts_are_those_of_hertz(void)
{
    static const struct {
        double young, poisson, density, radius, v, overlap, force, time;
        int wall;
    } rows[] = {
        {48e9, 0.20, 2800.0, 0.01, 20.0, 274.113e-6, 10696.9, 40.339e-6, 0},
        {20e9, 0.25, 2500.0, 0.01, 20.0, 368.304e-6, 7108.2, 54.201e-6, 0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        se3d_material_def def = stuff();
        def.young = rows[k].young;
        def.poisson = rows[k].poisson;
        def.density = rows[k].density;
        double out[3];
        double e = impact(SE3D_CONTACT_LAW_HERTZ_MINDLIN, &def, rows[k].wall, rows[k].radius,
                          rows[k].v, 40.0, out);
        CHECK_NEAR(e, 1.0, 1e-5);
        CHECK_NEAR(out[0] / rows[k].overlap, 1.0, 1e-4);
        CHECK_NEAR(out[1] / rows[k].force, 1.0, 1e-4);
        CHECK_NEAR(out[2] / rows[k].time, 1.0, 3e-3);
    }
}

static void impact_on_a_rigid_wall_is_that_of_hertz(void)
{
    /* Al alloy on a rigid wall: a wall 1e9 times as stiff. */
    se3d_material_def def = stuff();
    def.young = 70e9;
    def.poisson = 0.30;
    def.density = 2699.0;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.0, &def);
    const double v[3] = {0.0, 0.0, -0.2};
    se3d_material rigid;
    def.young = 70e18;
    CHECK(se3d_material_create(b.system, &def, &rigid) == SE3D_OK);
    add(&b, 0.0, 0.1, 0.1, v, NULL);
    se3d_material soft = b.material;
    b.material = rigid;
    floor_at(&b, 0.0, 0.0, 1.0);
    b.material = soft;
    double step = 731.66e-6 / 4000.0;
    CHECK(se3d_particles_set_step(b.particles, step) == SE3D_OK);
    double overlap = 0.0, force = 0.0, r[3], f[3];
    long steps = 0;
    do {
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        CHECK(se3d_particles_get_all(b.particles, 1, r, NULL, NULL) == SE3D_OK);
        CHECK(se3d_particles_get_forces(b.particles, 1, f, NULL) == SE3D_OK);
        overlap = fmax(overlap, 0.1 - r[2]);
        force = fmax(force, f[2]);
        ++steps;
    } while (steps < 100000 && se3d_particles_count_contacts(b.particles) > 0);
    CHECK_NEAR(overlap / 49.717e-6, 1.0, 1e-4);
    CHECK_NEAR(force / 11369.9, 1.0, 1e-4);
    CHECK_NEAR((double)steps * step / 731.66e-6, 1.0, 1e-3);
    bed_close(&b);
}

/* A sphere at rest in its dent on the floor. */
static void settle_on_floor(bed *b, double radius, double g, const double v[3], const double w[3])
{
    add(b, 0.0, radius - mass_of(radius) * g / 2.5e4, radius, v, w);
}

static void slipping_becomes_rolling(void)
{
    se3d_material_def def = stuff();
    def.friction = 0.3;
    def.restitution = 0.1;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, &def);
    const double v0 = 1.0, v[3] = {1.0, 0.0, 0.0};
    settle_on_floor(&b, 0.005, G, v, NULL);
    floor_at(&b, 0.0, 0.0, 1.0);
    double t = 2.0 * v0 / (7.0 * 0.3 * G), r[3], u[3], w[3];
    CHECK(se3d_particles_run(b.particles, 0.5 * t) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, r, u, w) == SE3D_OK);
    CHECK_NEAR(u[0], v0 - 0.3 * G * 0.5 * t, 1e-4); /* still slips */
    CHECK(se3d_particles_run(b.particles, 1.5 * t) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, r, u, w) == SE3D_OK);
    CHECK_NEAR(u[0], 5.0 / 7.0 * v0, 1e-3);
    CHECK_NEAR(w[1] * 0.005, u[0], 2e-3);
    CHECK_NEAR(r[0], 12.0 / 49.0 * v0 * v0 / (0.3 * G) + 5.0 / 7.0 * v0 * 0.5 * t, 3e-4);
    bed_close(&b);
}

static void spin_on_the_spot_becomes_rolling(void)
{
    se3d_material_def def = stuff();
    def.restitution = 0.1;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, &def);
    const double w0[3] = {0.0, 100.0, 0.0};
    double u[3];
    settle_on_floor(&b, 0.005, G, NULL, w0);
    floor_at(&b, 0.0, 0.0, 1.0);
    CHECK(se3d_particles_run(b.particles, 0.2) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, u, NULL) == SE3D_OK);
    CHECK_NEAR(u[0], 2.0 / 7.0 * 100.0 * 0.005, 1e-3);
    bed_close(&b);
}

/* Acceleration down an incline after it has become steady. */
static double incline(double angle, double mu, double rolling)
{
    se3d_material_def def = stuff();
    def.friction = mu;
    def.restitution = 0.1;
    def.rolling_friction = rolling;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 0.0, &def);
    const double g[3] = {G * sin(angle), 0.0, -G * cos(angle)};
    CHECK(se3d_system_set_gravity(b.system, g) == SE3D_OK);
    settle_on_floor(&b, 0.005, G * cos(angle), NULL, NULL);
    floor_at(&b, 0.0, 0.0, 1.0);
    double u0[3], u1[3];
    CHECK(se3d_particles_run(b.particles, 0.1) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, u0, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.3) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, u1, NULL) == SE3D_OK);
    bed_close(&b);
    return (u1[0] - u0[0]) / 0.2;
}

static void sphere_rolls_or_slips_down_an_incline(void)
{
    double a = atan(3.5 * 0.1);
    CHECK_NEAR(incline(0.9 * a, 0.1, 0.0), 5.0 / 7.0 * G * sin(0.9 * a), 5e-3);
    CHECK_NEAR(incline(1.2 * a, 0.1, 0.0), G * (sin(1.2 * a) - 0.1 * cos(1.2 * a)), 5e-3);
}

static void rolling_resistance_slows_and_holds(void)
{
    double a = 0.2;
    CHECK_NEAR(incline(a, 0.5, 0.1), 5.0 / 7.0 * G * (sin(a) - 0.1 * cos(a)), 5e-3);
    CHECK_NEAR(incline(0.05, 0.5, 0.1), 0.0, 1e-9);
}

static void torsional_resistance_stops_spin_about_the_normal(void)
{
    se3d_material_def def = stuff();
    def.restitution = 0.1;
    def.torsional_friction = 0.05;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, &def);
    const double w0[3] = {0.0, 0.0, 50.0};
    double w[3];
    settle_on_floor(&b, 0.005, G, NULL, w0);
    floor_at(&b, 0.0, 0.0, 1.0);
    /* I wdot = -mu_t R m g */
    double rate = 0.05 * G / (0.4 * 0.005);
    CHECK(se3d_particles_run(b.particles, 0.1) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, NULL, w) == SE3D_OK);
    CHECK_NEAR(w[2], 50.0 - rate * 0.1, 0.05);
    CHECK(se3d_particles_run(b.particles, 0.5) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, NULL, w) == SE3D_OK);
    CHECK_NEAR(w[2], 0.0, 1e-3);
    bed_close(&b);
}

static void two_spheres_squeezed_between_walls_balance(void)
{
    se3d_material_def def = stuff();
    def.stiffness = 1000.0;
    def.restitution = 0.05;
    def.density = 20000.0;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, &def);
    add(&b, 0.0, 0.45e-3, 0.5e-3, NULL, NULL);
    def.density = 10000.0;
    CHECK(se3d_material_create(b.system, &def, &b.material) == SE3D_OK);
    add(&b, 0.0, 1.35e-3, 0.5e-3, NULL, NULL);
    floor_at(&b, 0.0, 0.0, 1.0);
    floor_at(&b, 1.8e-3, 0.0, -1.0);
    CHECK(se3d_particles_run(b.particles, 0.2) == SE3D_OK);
    double r[6];
    CHECK(se3d_particles_get_all(b.particles, 2, r, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(r[2], 433.247725e-6, 2e-12);
    CHECK_NEAR(r[5], 1366.598180e-6, 2e-12);
    bed_close(&b);
}

static void chain_stands_as_it_must(se3d_contact_law law)
{
    se3d_material_def def = stuff();
    def.restitution = 0.05;
    def.young = 1e8;
    bed b;
    open_bed(&b, law, G, &def);
    const int n = 10;
    const double R = 0.005, weight = mass_of(R) * G;
    double modulus = 1e8 / (2.0 * (1.0 - 0.09));
    double expected[10];
    for (int k = 0; k < n; ++k) {
        int carried = n - k;
        double radius = k == 0 ? R : 0.5 * R; /* R*: the wall's is R */
        double hertz = pow(carried * weight / (4.0 / 3.0 * modulus * sqrt(radius)), 2.0 / 3.0);
        double overlap = law == SE3D_CONTACT_LAW_HOOKE ? carried * weight / 2.5e4 : hertz;
        expected[k] = (k == 0 ? R : expected[k - 1] + 2.0 * R) - overlap;
        add(&b, 0.0, (2.0 * k + 1.0) * R, R, NULL, NULL);
    }
    se3d_shape bottom = floor_at(&b, 0.0, 0.0, 1.0);
    CHECK(se3d_particles_run(b.particles, 2.0) == SE3D_OK);
    double r[30], force[3], torque[3];
    CHECK(se3d_particles_get_all(b.particles, 10, r, NULL, NULL) == SE3D_OK);
    for (int k = 0; k < n; ++k) {
        CHECK_NEAR(r[3 * k + 2], expected[k], 1e-11);
        CHECK_NEAR(r[3 * k], 0.0, 1e-15);
    }
    CHECK(se3d_shape_get_wrench(b.system, bottom, force, torque) == SE3D_OK);
    CHECK_NEAR(force[2] / (n * weight), -1.0, 1e-7);
    bed_close(&b);
}

static void hooke_chain_stands_as_it_must(void)
{
    chain_stands_as_it_must(SE3D_CONTACT_LAW_HOOKE);
}

static void hertz_chain_stands_as_it_must(void)
{
    chain_stands_as_it_must(SE3D_CONTACT_LAW_HERTZ_MINDLIN);
}

static void stack_does_not_creep(void)
{
    se3d_material_def def = stuff();
    def.restitution = 0.05;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, &def);
    for (int k = 0; k < 10; ++k) {
        add(&b, 0.0, 0.005 * (2.0 * k + 1.0), 0.005, NULL, NULL);
    }
    floor_at(&b, 0.0, 0.0, 1.0);
    double before[30], after[30];
    CHECK(se3d_particles_run(b.particles, 2.0) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 10, before, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 3.0) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 10, after, NULL, NULL) == SE3D_OK);
    for (int k = 0; k < 30; ++k) {
        CHECK_NEAR(after[k], before[k], 1e-10); /* of a radius of 5 mm, in 1 s */
    }
    bed_close(&b);
}

static void impact_without_slip_reverses_the_contact_point(void)
{
    se3d_material_def def = stuff();
    def.friction = 1e6;
    def.stiffness = 2.5e8; /* the arm is shorter by the overlap: small */
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 0.0, &def);
    const double v[3] = {0.3, 0.0, -1.0}, w[3] = {0.0, 20.0, 0.0};
    add(&b, 0.0, 0.005, 0.005, v, w);
    floor_at(&b, 0.0, 0.0, 1.0);
    double step, u[3], s[3];
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.particles, step / 50.0) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 50 * 100) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, u, s) == SE3D_OK);
    CHECK_NEAR(u[0] - s[1] * 0.005, -(v[0] - w[1] * 0.005), 1e-3);
    CHECK_NEAR(u[2], 1.0, 1e-5);
    /* the angular momentum about the contact point does not change */
    CHECK_NEAR(u[0] + 0.4 * 0.005 * s[1], v[0] + 0.4 * 0.005 * w[1], 1e-3);
    bed_close(&b);
}

static void sliding_impact_obeys_coulomb(void)
{
    se3d_material_def def = stuff();
    def.friction = 0.1;
    def.stiffness = 2.5e8; /* the arm is shorter by the overlap: small */
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 0.0, &def);
    const double v[3] = {5.0, 0.0, -1.0};
    add(&b, 0.0, 0.005, 0.005, v, NULL);
    floor_at(&b, 0.0, 0.0, 1.0);
    double step, u[3], s[3];
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.particles, step / 20.0) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 20 * 100) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, NULL, u, s) == SE3D_OK);
    CHECK_NEAR(u[0], 5.0 - 0.1 * 2.0, 2e-4); /* dv = -mu (1 + e) vn */
    CHECK_NEAR(s[1] * 0.005 * 0.4, 0.1 * 2.0, 2e-4);
    bed_close(&b);
}

/* One that comes down at speed `in` along z, with speed along x and spin about y, on a wall
 * (`other` = 0) or on a sphere at rest; `out` has the same three afterwards. */
static void glance(const se3d_material_def *def, double radius, double other, const double in[3],
                   double out[3])
{
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.0, def);
    const double v[3] = {in[1], 0.0, -in[0]}, w[3] = {0.0, in[2], 0.0};
    add(&b, 0.0, radius, radius, v, w);
    if (other > 0.0) {
        add(&b, 0.0, -other, other, NULL, NULL);
    } else {
        floor_at(&b, 0.0, 0.0, 1.0);
    }
    double step, u[6], s[6];
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.particles, step / 8.0) == SE3D_OK);
    long steps = 0;
    do {
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
    } while (++steps < 100000 && se3d_particles_count_contacts(b.particles) > 0);
    CHECK(se3d_particles_get_all(b.particles, se3d_particles_count(b.particles), NULL, u, s) ==
          SE3D_OK);
    out[0] = u[2];
    out[1] = u[0];
    out[2] = s[1];
    bed_close(&b);
}

/* The kinds of Chung and Ooi's tests 3 to 8. Slip of more than 7/2 mu (1 + e) vn lasts all the
 * impact: the tangential impulse is mu times the normal one; less slip: it is smaller. */
static void oblique_and_spinning_impacts_are_those_of_coulomb(void)
{
    static const struct {
        double young, poisson, density, radius, other, mu, e, in[3];
        int slides;
    } rows[] = {
        {380e9, 0.23, 4000.0, 0.0025, 0.0, 0.092, 0.98, {3.9, 0.0, 0.0}, 0},       /* normal */
        {380e9, 0.23, 4000.0, 0.0025, 0.0, 0.092, 0.98, {1.95, 3.3775, 0.0}, 1},   /* 60 deg */
        {380e9, 0.23, 4000.0, 0.0025, 0.0, 0.092, 0.98, {3.8408, 0.6772, 0.0}, 0}, /* 10 deg */
        {208e9, 0.30, 7850.0, 1e-5, 0.0, 0.3, 1.0, {5.0, 13.737, 0.0}, 1},         /* 70 deg */
        {70e9, 0.33, 2700.0, 0.1, 0.0, 0.4, 0.5, {0.2, 0.0, 12.0}, 1},             /* spin */
        {120e9, 0.35, 8900.0, 0.1, 0.0, 0.4, 0.5, {0.2, 0.0, -12.0}, 1},           /* other way */
        {70e9, 0.33, 2700.0, 0.1, 0.1, 0.4, 0.5, {0.2, 0.0, 12.0}, 1},             /* a pair */
        {70e9, 0.33, 2700.0, 0.1, 0.5, 0.4, 0.5, {0.2, 0.0, 12.0}, 1},             /* unequal */
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        se3d_material_def def = stuff();
        def.young = rows[k].young;
        def.poisson = rows[k].poisson;
        def.density = rows[k].density;
        def.friction = rows[k].mu;
        def.restitution = rows[k].e;
        const double R = rows[k].radius, *in = rows[k].in;
        const double ratio = rows[k].other > 0.0 ? pow(R / rows[k].other, 3.0) : 0.0;
        const double dv = (1.0 + rows[k].e) * in[0] / (1.0 + ratio); /* of the first, along z */
        const double slip = in[1] - R * in[2];
        double out[3];
        glance(&def, R, rows[k].other, in, out);
        CHECK_NEAR((out[0] + in[0]) / dv, 1.0, 2e-3);
        double share = (in[1] - out[1]) / (copysign(rows[k].mu, slip) * dv);
        double turned = 0.4 * R * (out[2] - in[2]);
        CHECK_NEAR(turned / dv, (in[1] - out[1]) / dv, 8e-3 * rows[k].mu); /* R - delta */
        if (rows[k].slides) {
            CHECK_NEAR(share, 1.0, 2e-3);
        } else {
            CHECK(share > -1e-9 && share < 0.99);
        }
    }
}

int main(void)
{
    RUN(restitution_typed_is_restitution_obtained);
    RUN(restitution_converges_with_the_step);
    RUN(linear_contact_lasts_half_a_period);
    RUN(elastic_impacts_are_those_of_hertz);
    RUN(impact_on_a_rigid_wall_is_that_of_hertz);
    RUN(slipping_becomes_rolling);
    RUN(spin_on_the_spot_becomes_rolling);
    RUN(sphere_rolls_or_slips_down_an_incline);
    RUN(rolling_resistance_slows_and_holds);
    RUN(torsional_resistance_stops_spin_about_the_normal);
    RUN(two_spheres_squeezed_between_walls_balance);
    RUN(hooke_chain_stands_as_it_must);
    RUN(hertz_chain_stands_as_it_must);
    RUN(stack_does_not_creep);
    RUN(impact_without_slip_reverses_the_contact_point);
    RUN(sliding_impact_obeys_coulomb);
    RUN(oblique_and_spinning_impacts_are_those_of_coulomb);
    return check_finish();
}
