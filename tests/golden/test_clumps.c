/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps against closed forms: masses of overlapping spheres, a sphere of one, impacts of rods, the
 * free top; and what must hold whatever they do: momentum, energy, periods, spheres that stay where
 * their clump has them. */
#include <stdlib.h>

#include "check.h"
#include "math/quaternion.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#define PI 3.1415926535897932384626433832795

static const double none[3] = {0.0, 0.0, 0.0}, down[3] = {0.0, 0.0, -9.81};

static se3d_material_def stuff(double restitution, double friction)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2000.0;
    def.stiffness = 1e5;
    def.young = 1e8;
    def.friction = friction;
    def.restitution = restitution;
    return def;
}

static uint32_t add_template(const bed *b, size_t count, const double *r, const double *radius)
{
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index = 77;
    def.count = count;
    def.r = r;
    def.radius = radius;
    CHECK(!se3d_particles_add_clump_template(b->particles, &def, &index));
    return index;
}

static se3d_clump_template_info info_of(const bed *b, uint32_t index)
{
    se3d_clump_template_info info;
    CHECK(!se3d_particles_get_clump_template(b->particles, index, &info));
    return info;
}

static void open_bed(bed *b, const double gravity[3], double restitution, double friction)
{
    const se3d_material_def material = stuff(restitution, friction);
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, gravity, NULL, &material);
}

/* Integrals of rho^2 x^k and rho^4 over a sphere of radius R, cut at x = c of its centre. */
static void cut_sphere(double R, double c, double out[4])
{
    /* rho^2 = R^2 - x^2 over x from c to R */
    const double c3 = c * c * c, c5 = c3 * c * c, R3 = R * R * R, R5 = R3 * R * R;
    out[0] = R * R * (R - c) - (R3 - c3) / 3.0;
    out[1] = R * R * (R * R - c * c) / 2.0 - (R3 * R - c3 * c) / 4.0;
    out[2] = R * R * (R3 - c3) / 3.0 - (R5 - c5) / 5.0;
    out[3] = R3 * R * (R - c) - 2.0 * R * R * (R3 - c3) / 3.0 + (R5 - c5) / 5.0;
}

/* Two spheres that overlap: each is cut by the plane between them. */
static void overlapping_spheres_count_once(void)
{
    static const double radii[2] = {0.5, 0.5};
    for (int k = 0; k < 8; ++k) {
        bed b;
        open_bed(&b, none, 0.5, 0.5);
        const double half = 0.07 * k, s = 1.0 / sqrt(3.0);
        double axis[3] = {k % 3 == 0, k % 3 == 1, k % 3 == 2};
        for (int a = 0; k >= 4 && a < 3; ++a) {
            axis[a] = s; /* slanted: no line of the integration is along it */
        }
        double r[6], I[4];
        for (int a = 0; a < 3; ++a) {
            r[a] = 1.0 + half * axis[a];
            r[3 + a] = 1.0 - half * axis[a];
        }
        const se3d_clump_template_info info = info_of(&b, add_template(&b, 2, r, radii));
        cut_sphere(0.5, -half, I);
        const double volume = 2.0 * PI * I[0];
        const double along = PI * I[3]; /* 2 * pi/2 * integral of rho^4 */
        const double across =
            0.5 * along + 2.0 * PI * (I[2] + 2.0 * half * I[1] + half * half * I[0]);
        CHECK_NEAR(info.volume / volume, 1.0, 5e-5);
        CHECK_NEAR(info.mass / volume, 1.0, 5e-5);
        CHECK_NEAR(info.radius, 0.5 + half, 1e-6);
        for (int a = 0; a < 3; ++a) {
            const double n2 = axis[a] * axis[a], m = axis[a] * axis[(a + 1) % 3];
            CHECK_NEAR(info.centre[a], 1.0, 1e-6);
            CHECK_NEAR(info.inertia[a] / across, 1.0 + n2 * (along / across - 1.0), 6e-5);
            CHECK_NEAR(info.inertia[3 + a] / across, m * (along / across - 1.0), 6e-5);
        }
        bed_close(&b);
    }
}

static void apart_and_inside_are_exact(void)
{
    bed b;
    open_bed(&b, none, 0.5, 0.5);
    const double V = 4.0 / 3.0 * PI * 0.001, r[6] = {-0.1, 0.0, 0.0, 0.1, 0.0, 0.0};
    const double radii[2] = {0.1, 0.1}, nested[2] = {0.1, 0.05};
    se3d_clump_template_info info = info_of(&b, add_template(&b, 2, r, radii));
    CHECK_NEAR(info.volume / V, 2.0, 1e-14);
    CHECK_NEAR(info.inertia[0] / V, 2.0 * 0.4 * 0.01, 1e-15);
    CHECK_NEAR(info.inertia[1] / V, 2.0 * 0.4 * 0.01 + 2.0 * 0.01, 1e-15);
    const double centred[6] = {0.0};
    info = info_of(&b, add_template(&b, 2, centred, nested));
    CHECK_NEAR(info.volume / V, 1.0, 5e-5);
    CHECK_NEAR(info.inertia[2] / V, 0.4 * 0.01, 1e-7);
    bed_close(&b);
}

/* What is given counts, whatever the spheres are. */
static void given_masses_are_taken(void)
{
    bed b;
    open_bed(&b, none, 0.5, 0.5);
    const double r[6] = {0.0, 0.0, 0.0, 0.1, 0.0, 0.0}, radii[2] = {0.1, 0.1};
    const double J[6] = {0.02, 0.03, 0.04, 0.001, -0.002, 0.003};
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index;
    double mass = 0.0;
    def.count = 2;
    def.r = r;
    def.radius = radii;
    def.mass = 3.0;
    def.centre[1] = 0.05;
    memcpy(def.inertia, J, sizeof J);
    CHECK(!se3d_particles_add_clump_template(b.particles, &def, &index));
    const se3d_clump_template_info info = info_of(&b, index);
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(info.inertia[k], J[k], 1e-16);
    }
    CHECK_NEAR(info.centre[1], 0.05, 0.0);
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 1, none, NULL, NULL, NULL));
    CHECK(!se3d_particles_get_clump_ids(b.particles, 1, NULL, NULL, &mass));
    CHECK_NEAR(mass, 3.0, 0.0);
    /* the sphere at the origin of the template is below the centre of mass */
    double x[6];
    CHECK(!se3d_particles_get_all(b.particles, 2, x, NULL, NULL));
    CHECK_NEAR(x[1], -0.05, 1e-15);
    CHECK_NEAR(x[3], 0.1, 1e-15);
    bed_close(&b);
}

/* A clump of one sphere does what the sphere does: with spin, friction and damping, on a plane. */
static void a_clump_of_one_sphere_is_that_sphere(void)
{
    static const double up[3] = {0.0, 0.0, 1.0}, at[3] = {0.0, 0.0, 0.06}, v[3] = {0.7, 0.2, -1.0},
                        w[3] = {3.0, -8.0, 20.0}, R = 0.05;
    for (int law = 0; law < 2; ++law) {
        bed b[2];
        double x[2][3], u[2][3], s[2][3];
        for (int k = 0; k < 2; ++k) {
            const se3d_material_def material = stuff(0.6, 0.4);
            bed_open(&b[k], law, down, NULL, &material);
            (void)bed_add_plane(&b[k], none, up);
            if (k == 0) {
                bed_add(&b[k], at, R, v, w);
            } else {
                CHECK(!se3d_particles_add_clumps(b[k].particles, add_template(&b[k], 1, none, &R),
                                                 b[k].material, 1, at, NULL, v, w));
            }
            CHECK(!se3d_particles_set_step(b[k].particles, 2e-5));
            CHECK(!se3d_particles_step(b[k].particles, 15000)); /* several bounces */
            CHECK(!se3d_particles_get_all(b[k].particles, 1, x[k], u[k], s[k]));
        }
        CHECK(x[0][2] < 0.06 && x[0][0] > 0.05);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(x[1][a], x[0][a], 1e-10);
            CHECK_NEAR(u[1][a], u[0][a], 1e-9);
            CHECK_NEAR(s[1][a], s[0][a], 1e-8);
        }
        bed_close(&b[0]);
        bed_close(&b[1]);
    }
}

/* A rod of `count` spheres comes down at an angle, without friction: the end that touches leaves at
 * e times its speed, J = (1 + e) u m*, 1/m* = 1/m + (L sin)^2/I. The softer the spheres the more it
 * turns meanwhile. */
static void check_rod(size_t count, double angle, double e, int32_t law)
{
    enum { MOST = 5 };
    static const double up[3] = {0.0, 0.0, 1.0};
    const double R = 0.01, h = R * (count == 2 ? 1.0 : 0.6), u = 1e-2;
    double r[3 * MOST] = {0.0}, radii[MOST], x[3] = {0.0}, v[3] = {0.0, 0.0, -u}, w[3];
    const double axis[3] = {0.0, 1.0, 0.0};
    double q[4], mass;
    bed b;
    se3d_material_def material = stuff(e, 0.0);
    material.stiffness = 1e7;
    material.young = 1e11;
    bed_open(&b, law, none, NULL, &material);
    (void)bed_add_plane(&b, none, up);
    for (size_t k = 0; k < count; ++k) {
        radii[k] = R;
        r[3 * k] = h * (2.0 * (double)k - (double)(count - 1));
    }
    const uint32_t index = add_template(&b, count, r, radii);
    const se3d_clump_template_info info = info_of(&b, index);
    const double arm = h * (double)(count - 1) * cos(angle); /* of the force about the centre */
    se3di_quat_from_axis_angle(axis, angle, q);              /* the end at +x goes down */
    x[2] = R + h * (double)(count - 1) * sin(angle) + 1e-9;
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 1, x, q, v, NULL));
    CHECK(!se3d_particles_get_clump_ids(b.particles, 1, NULL, NULL, &mass));
    CHECK_NEAR(mass, 2000.0 * info.volume, 1e-15);
    const double I = 2000.0 * info.inertia[1], mobility = 1.0 / mass + arm * arm / I;
    const double J = (1.0 + e) * u / mobility;
    double step, force[3];
    CHECK(!se3d_particles_get_step(b.particles, &step));
    do {
        CHECK(!se3d_particles_step(b.particles, 5));
        CHECK(!se3d_particles_get_clump_forces(b.particles, 1, force, NULL));
    } while (force[2] > 0.0);
    CHECK(!se3d_particles_get_clumps(b.particles, 1, NULL, NULL, v, w));
    CHECK_NEAR((v[2] + u) * mass / J, 1.0, 2e-3);
    CHECK_NEAR(w[1] * I / (-J * arm), 1.0, 2e-3); /* the end that touched comes up */
    CHECK_NEAR(v[0], 0.0, 1e-12);
    CHECK_NEAR(w[0] + w[2], 0.0, 1e-9);
    bed_close(&b);
}

static void rods_bounce_by_newtons_law(void)
{
    for (int law = 0; law < 2; ++law) {
        check_rod(2, 0.3, 1.0, law);
        check_rod(2, 0.9, 0.4, law);
        check_rod(5, 0.5, 1.0, law);
        check_rod(5, 0.2, 0.6, law);
    }
}

/* Two dimers that meet with their ends, offset: the pair has the mobility of both. */
static void two_dimers_keep_the_restitution(void)
{
    const double R = 0.01, radii[2] = {R, R}, r[6] = {-R, 0.0, 0.0, R, 0.0, 0.0}, e = 0.5;
    const double x[6] = {0.0, 0.0, 0.0, 2.0 * R, 0.0, 2.0 * R + 1e-9};
    const double u = 1e-2, v[6] = {0.0, 0.0, 0.5 * u, 0.0, 0.0, -0.5 * u};
    bed b;
    se3d_material_def material = stuff(e, 0.0);
    material.stiffness = 1e7;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    const uint32_t index = add_template(&b, 2, r, radii);
    const se3d_clump_template_info info = info_of(&b, index);
    double after[6], w[6], step;
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 2, x, NULL, v, NULL));
    CHECK(!se3d_particles_get_step(b.particles, &step));
    CHECK(!se3d_particles_run(b.particles, 400.0 * step));
    CHECK(!se3d_particles_get_clumps(b.particles, 2, NULL, NULL, after, w));
    const double mass = 2000.0 * info.mass, I = 2000.0 * info.inertia[1];
    const double J = (1.0 + e) * u / (2.0 / mass + 2.0 * R * R / I);
    CHECK_NEAR((after[2] - 0.5 * u) * mass / -J, 1.0, 2e-3);
    CHECK_NEAR((after[5] + 0.5 * u) * mass / J, 1.0, 2e-3);
    CHECK_NEAR(w[1] * I / (J * R), 1.0, 2e-3);
    CHECK_NEAR(w[4] * I / (J * R), 1.0, 2e-3);
    bed_close(&b);
}

/* An asymmetric top that nothing touches, beside a body of the library with the same inertia. */
static double top_error(double step, double *drift)
{
    static const double r[9] = {0.0, 0.0, 0.0, 0.08, 0.01, 0.0, 0.02, 0.06, 0.03},
                        radii[3] = {0.03, 0.02, 0.025}, w[3] = {2.0, 30.0, 1.0};
    static const double turned[4] = {0.8, 0.36, 0.48, 0.0};
    const double time = 0.5;
    bed b;
    double e[4], p[4], spin[3], L0[3], L1[3], before, error = 0.0;
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    se3d_solver *solver;
    se3d_particles_energy energy;
    se3d_material_def soft = stuff(0.5, 0.5);
    soft.stiffness = 1.0; /* any step will do: nothing touches */
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &soft);
    const uint32_t index = add_template(&b, 3, r, radii);
    const se3d_clump_template_info info = info_of(&b, index);
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 1, none, turned, NULL, w));
    CHECK(!se3d_particles_set_step(b.particles, step));
    CHECK(!se3d_particles_get_energy(b.particles, &energy));
    before = energy.rotation;
    CHECK(!se3d_particles_run(b.particles, time));
    CHECK(!se3d_particles_get_energy(b.particles, &energy));
    CHECK(!se3d_particles_get_clumps(b.particles, 1, NULL, e, NULL, spin));
    *drift = fabs(energy.rotation / before - 1.0);
    se3d_particles_destroy(b.particles);
    /* the body's spin is given in the ground frame, too */
    def.mass = 2000.0 * info.mass;
    for (int k = 0; k < 6; ++k) {
        def.inertia[k] = 2000.0 * info.inertia[k];
    }
    memcpy(def.orientation, turned, sizeof turned);
    double A[9], J[9];
    se3di_quat_to_matrix(turned, A);
    se3di_mul_transposed(A, w, def.angular_velocity);
    CHECK(!se3d_body_create(b.system, &def, &body));
    se3d_solver_def settings = se3d_solver_def_default();
    settings.method = SE3D_METHOD_DOP853;
    settings.tolerance = 1e-11;
    CHECK(!se3d_solver_create(b.system, &settings, &solver));
    CHECK(se3d_solver_run(solver, time) >= 0);
    CHECK(!se3d_body_get_orientation(b.system, body, p));
    const double sign = p[0] * e[0] + p[1] * e[1] + p[2] * e[2] + p[3] * e[3] < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 4; ++k) {
        error = fmax(error, fabs(p[k] - sign * e[k]));
    }
    /* the angular momentum stays to rounding */
    const double *j = def.inertia;
    const double full[9] = {j[0], j[3], j[5], j[3], j[1], j[4], j[5], j[4], j[2]};
    memcpy(J, full, sizeof J);
    double local[3];
    se3di_mul(J, def.angular_velocity, local);
    se3di_mul(A, local, L0);
    se3di_quat_to_matrix(e, A);
    se3di_mul_transposed(A, spin, local);
    double inside[3];
    se3di_mul(J, local, inside);
    se3di_mul(A, inside, L1);
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(L1[a], L0[a], 1e-12 * se3di_norm(L0));
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(b.system);
    return error;
}

static void the_free_top_converges_to_a_body(void)
{
    double drift[3];
    const double coarse = top_error(2e-3, &drift[0]), fine = top_error(1e-3, &drift[1]),
                 finest = top_error(1e-4, &drift[2]);
    CHECK(coarse > 1e-5 && coarse < 0.05);
    CHECK_NEAR(coarse / fine, 4.0, 0.25);
    CHECK_NEAR(fine / finest, 100.0, 3.0);
    CHECK(drift[0] < 2e-3 && drift[0] / drift[1] > 3.0 && drift[2] < 1e-5);
}

/* Momentum, angular momentum and energy of all clumps. */
static void sums(const bed *b, double p[3], double L[3], double *energy)
{
    enum { MOST = 64 };
    const size_t n = se3d_particles_count_clumps(b->particles);
    double r[3 * MOST], e[4 * MOST], v[3 * MOST], w[3 * MOST], mass[MOST];
    uint32_t templates[MOST];
    se3d_particles_energy kinetic;
    CHECK(n <= MOST && !se3d_particles_get_clumps(b->particles, n, r, e, v, w) &&
          !se3d_particles_get_clump_ids(b->particles, n, NULL, templates, mass) &&
          !se3d_particles_get_energy(b->particles, &kinetic));
    *energy = kinetic.translation + kinetic.rotation;
    for (int a = 0; a < 3; ++a) {
        p[a] = L[a] = 0.0;
    }
    for (size_t k = 0; k < n; ++k) {
        const se3d_clump_template_info info = info_of(b, templates[k]);
        const double scale = mass[k] / info.mass, *j = info.inertia;
        const double J[9] = {j[0], j[3], j[5], j[3], j[1], j[4], j[5], j[4], j[2]};
        double A[9], local[3], inside[3], own[3], orbit[3];
        se3di_quat_to_matrix(e + 4 * k, A);
        se3di_mul_transposed(A, w + 3 * k, local);
        se3di_mul(J, local, inside);
        se3di_mul(A, inside, own);
        se3di_cross(r + 3 * k, v + 3 * k, orbit);
        for (int a = 0; a < 3; ++a) {
            p[a] += mass[k] * v[3 * k + (size_t)a];
            L[a] += scale * own[a] + mass[k] * orbit[a];
        }
    }
}

/* A cloud that shrinks into collisions, elastic and without friction, or neither. */
static void collisions_keep_what_they_must(void)
{
    static const double r[9] = {0.0, 0.0, 0.0, 0.012, 0.0, 0.0, 0.0, 0.01, 0.004},
                        radii[3] = {0.01, 0.008, 0.007};
    for (int k = 0; k < 2; ++k) {
        bed b;
        double p[2][3], L[2][3], energy[2], x[3 * 64], v[3 * 64], scale = 0.0;
        open_bed(&b, none, k ? 1.0 : 0.5, k ? 0.0 : 0.5);
        se3d_fill_def fill = se3d_fill_def_default();
        fill.material = b.material;
        fill.clump = 1 + add_template(&b, 3, r, radii);
        fill.count = 30;
        for (int a = 0; a < 3; ++a) {
            fill.lower[a] = -0.08;
            fill.upper[a] = 0.08;
        }
        CHECK(!se3d_particles_fill_random(b.particles, &fill));
        CHECK(se3d_particles_count(b.particles) == 90);
        CHECK(!se3d_particles_get_clumps(b.particles, 30, x, NULL, NULL, NULL));
        for (int n = 0; n < 90; ++n) {
            v[n] = -x[n] * 30.0;
        }
        CHECK(!se3d_particles_set_clumps(b.particles, 30, NULL, NULL, v, NULL));
        double step;
        CHECK(!se3d_particles_get_step(b.particles, &step));
        CHECK(!se3d_particles_set_step(b.particles, k ? 0.1 * step : step));
        sums(&b, p[0], L[0], &energy[0]);
        do { /* until they are apart again */
            CHECK(!se3d_particles_step(b.particles, 3000));
        } while (se3d_particles_count_contacts(b.particles) > 0);
        sums(&b, p[1], L[1], &energy[1]);
        for (int a = 0; a < 3; ++a) {
            scale = fmax(scale, fabs(p[0][a]));
        }
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(p[1][a], p[0][a], 1e-13);
            CHECK_NEAR(L[1][a], L[0][a], 1e-14);
        }
        if (k) {
            CHECK_NEAR(energy[1] / energy[0], 1.0, 2e-3);
        } else {
            CHECK(energy[1] < 0.9 * energy[0]);
        }
        bed_close(&b);
    }
}

/* Spheres are where their clump has them, also across periods, and never touch each other. */
static void spheres_stay_with_their_clump(void)
{
    static const double r[6] = {-0.008, 0.0, 0.0, 0.008, 0.0, 0.0}, radii[2] = {0.01, 0.01};
    se3d_particles_def def = se3d_particles_def_default();
    const se3d_material_def material = stuff(0.5, 0.5);
    bed b;
    for (int a = 0; a < 3; ++a) {
        def.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        def.upper[a] = 0.1;
    }
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    const uint32_t index = add_template(&b, 2, r, radii);
    const double x[3] = {0.0, 0.05, 0.1}, v[3] = {0.7, 0.0, 1.1}, w[3] = {0.0, 60.0, 20.0};
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 1, x, NULL, v, w));
    CHECK(!se3d_particles_set_step(b.particles, 1e-4));
    for (int k = 0; k < 60; ++k) {
        double at[6], centre[3], e[4], A[9];
        CHECK(!se3d_particles_step(b.particles, 70));
        CHECK(se3d_particles_count_contacts(b.particles) == 0);
        CHECK(!se3d_particles_get_all(b.particles, 2, at, NULL, NULL));
        CHECK(!se3d_particles_get_clumps(b.particles, 1, centre, e, NULL, NULL));
        se3di_quat_to_matrix(e, A);
        for (size_t a = 0; a < 3; ++a) {
            for (size_t n = 0; n < 2; ++n) {
                const double off = at[3 * n + a] - centre[a] - A[3 * a] * r[3 * n];
                CHECK_NEAR(off - 0.1 * nearbyint(off / 0.1), 0.0, 1e-13);
            }
            const double flown = x[a] + v[a] * 1e-4 * 70 * (k + 1), off = centre[a] - flown;
            CHECK_NEAR(off - 0.1 * nearbyint(off / 0.1), 0.0, 1e-11);
        }
    }
    /* a sphere in its way across the border is met on both sides */
    const double stop[3] = {0.05, 0.05, 0.05};
    bed_add(&b, stop, 0.02, none, none);
    CHECK(!se3d_particles_step(b.particles, 2000));
    double u[9];
    CHECK(!se3d_particles_get_all(b.particles, 3, NULL, u, NULL));
    CHECK(se3di_norm(u + 6) > 0.0);
    bed_close(&b);
}

/* A few fall onto a floor with friction and come to rest: it carries their weight, the last of them
 * turns no more, and what is left of the energy is that of places. */
static void a_heap_comes_to_rest(void)
{
    static const double r[6] = {-0.006, 0.0, 0.0, 0.006, 0.0, 0.0}, radii[2] = {0.01, 0.008},
                        up[3] = {0.0, 0.0, 1.0};
    bed b;
    double force[3], torque[3], sum[3] = {0.0}, mass[8], F[24];
    se3d_body ground;
    se3d_particles_energy energy;
    se3d_material_def material = stuff(0.3, 0.6);
    material.stiffness = 2e3;
    material.rolling_friction = 0.1;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    (void)bed_add_plane(&b, none, up);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b.material;
    fill.clump = 1 + add_template(&b, 2, r, radii);
    fill.count = 8;
    fill.lower[0] = fill.lower[1] = -0.03;
    fill.upper[0] = fill.upper[1] = 0.03;
    fill.upper[2] = 0.09;
    CHECK(!se3d_particles_fill_random(b.particles, &fill));
    CHECK(!se3d_particles_run(b.particles, 1.5));
    CHECK(!se3d_system_get_ground(b.system, &ground));
    CHECK(!se3d_particles_get_wrench(b.particles, ground, force, torque));
    CHECK(!se3d_particles_get_energy(b.particles, &energy));
    CHECK(!se3d_particles_get_clump_ids(b.particles, 8, NULL, NULL, mass));
    CHECK(!se3d_particles_get_clump_forces(b.particles, 8, F, NULL));
    for (size_t k = 0; k < 8; ++k) {
        CHECK_NEAR(F[3 * k + 2] / (mass[k] * 9.81), 1.0, 1e-3);
        se3di_add(sum, F + 3 * k, sum);
    }
    CHECK_NEAR(force[2], -8.0 * 9.81 * mass[0], 1e-4);
    CHECK_NEAR(force[2], -sum[2], 1e-12);
    CHECK(energy.translation + energy.rotation < 1e-8);
    bed_close(&b);
}

/* They go as one: by a sink, by the id of any sphere; tags are of all. */
static void clumps_leave_whole(void)
{
    static const double r[6] = {-0.01, 0.0, 0.0, 0.01, 0.0, 0.0}, radii[2] = {0.01, 0.01};
    const double x[9] = {0.0, 0.0, 0.1, 0.0, 0.1, 0.1, 0.0, 0.2, 0.1};
    bed b;
    uint32_t ids[6], tags[8], of[8];
    const uint32_t second = 3;
    uint64_t count;
    se3d_particles_stats stats;
    se3d_particles_tally tally;
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    open_bed(&b, down, 0.5, 0.5);
    const uint32_t index = add_template(&b, 2, r, radii);
    bed_add(&b, none, 0.01, none, none);
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 3, x, NULL, NULL, NULL));
    bed_add(&b, x + 6, 0.005, none, none);
    CHECK(!se3d_particles_get_clump_ids(b.particles, 3, ids, NULL, NULL));
    CHECK(ids[0] == 1 && ids[1] == 3 && ids[2] == 5);
    CHECK(!se3d_particles_set_tags(b.particles, 1, &second, 9));
    CHECK(!se3d_particles_get_tags(b.particles, 8, tags));
    CHECK(tags[3] == 9 && tags[4] == 9 && tags[2] == 0 && tags[5] == 0);
    CHECK(!se3d_particles_get_tally(b.particles, 9, &tally));
    CHECK(tally.count == 2);
    CHECK_NEAR(tally.mass, 2.0 * 2000.0 * 4.0 / 3.0 * PI * 1e-6, 1e-15);
    CHECK_NEAR(tally.energy, tally.mass * 9.81 * 0.1, 1e-15);
    CHECK(tally.kinetic == 0.0 && tally.rotation == 0.0);
    const uint32_t gone = 2; /* the second sphere of the first */
    CHECK(!se3d_particles_remove(b.particles, 1, &gone));
    CHECK(se3d_particles_count(b.particles) == 6 && se3d_particles_count_clumps(b.particles) == 2);
    CHECK(!se3d_particles_get_clump_of(b.particles, 6, of));
    CHECK(of[0] == UINT32_MAX && of[1] == 3 && of[2] == 3 && of[3] == 5 && of[4] == 5 &&
          of[5] == UINT32_MAX);
    sink.normal[1] = -1.0;
    sink.point[1] = 0.15; /* what is beyond it */
    CHECK(!se3d_particles_add_sink(b.particles, &sink, NULL));
    CHECK(!se3d_particles_step(b.particles, 10));
    CHECK(se3d_particles_count(b.particles) == 3 && se3d_particles_count_clumps(b.particles) == 1);
    CHECK(!se3d_particles_get_sink_count(b.particles, 0, &count) && count == 3);
    CHECK(!se3d_particles_get_stats(b.particles, &stats) && stats.clumps == 1 && stats.lost == 3);
    CHECK(!se3d_particles_get_clump_ids(b.particles, 1, ids, NULL, NULL) && ids[0] == 3);
    bed_close(&b);
}

/* Orientations of a fill are uniform: the mean of A^2 is 1/3 in every element, and depend on the
 * seed and the number only; scales follow the radius. */
static void fills_turn_at_random(void)
{
    static const double r[6] = {-0.01, 0.0, 0.0, 0.01, 0.0, 0.0}, radii[2] = {0.01, 0.01};
    bed b;
    size_t added;
    double mean[9] = {0.0}, sum[9] = {0.0};
    open_bed(&b, none, 0.5, 0.5);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b.material;
    fill.clump = 1 + add_template(&b, 2, r, radii);
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 1.0;
    fill.radius_min = 0.02;
    fill.radius_max = 0.04;
    fill.seed = 5;
    CHECK(!se3d_particles_fill_lattice(b.particles, &fill, &added) && added > 1000);
    const size_t n = se3d_particles_count_clumps(b.particles);
    double *e = malloc(4 * n * sizeof *e), *mass = malloc(n * sizeof *mass);
    CHECK(n == added && e && mass);
    CHECK(!se3d_particles_get_clumps(b.particles, n, NULL, e, NULL, NULL));
    CHECK(!se3d_particles_get_clump_ids(b.particles, n, NULL, NULL, mass));
    const double unit = 2000.0 * info_of(&b, 0).mass;
    double most = 0.0, least = 1e9;
    for (size_t k = 0; k < n; ++k) {
        double A[9];
        se3di_quat_to_matrix(e + 4 * k, A);
        for (int a = 0; a < 9; ++a) {
            mean[a] += A[a] * A[a] / (double)n;
            sum[a] += A[a] / (double)n;
        }
        most = fmax(most, mass[k] / unit);
        least = fmin(least, mass[k] / unit);
    }
    CHECK(most < 8.0 + 1e-9 && most > 7.5 && least >= 1.0 - 1e-12 && least < 1.1);
    for (int a = 0; a < 9; ++a) {
        CHECK_NEAR(mean[a], 1.0 / 3.0, 5.0 * 0.3 / sqrt((double)n));
        CHECK_NEAR(sum[a], 0.0, 5.0 * 0.6 / sqrt((double)n));
    }
    free(e);
    free(mass);
    bed_close(&b);
}

/* Clumps of one, two and three spheres in turn that fall on a floor, far apart: those in [first,
 * end). Returns their states, one after the other. */
enum { FALLING = 21, FALLING_STATE = 13 };

static void run_falling(int first, int end, double *states)
{
    static const double r[9] = {0.0, 0.0, 0.0, 0.004, 0.0, 0.0, 0.0, 0.003, 0.002},
                        radii[3] = {0.004, 0.003, 0.0025}, up[3] = {0.0, 0.0, 1.0};
    se3d_particles_def set = se3d_particles_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    bed b;
    set.step = 2e-5;
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    stuff.friction = 0.4;
    stuff.restitution = 0.6;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, &set, &stuff);
    (void)bed_add_plane(&b, none, up);
    for (uint32_t k = 1; k <= 3; ++k) {
        se3d_clump_def def = se3d_clump_def_default();
        def.count = k;
        def.r = r;
        def.radius = radii;
        CHECK(se3d_particles_add_clump_template(b.particles, &def, NULL) == SE3D_OK);
    }
    for (int k = first; k < end; ++k) {
        const double x[3] = {0.05 * k, 0.0, 0.012}, v[3] = {0.1, 0.03 * k, -0.2};
        const double e[4] = {0.8, 0.0, 0.6, 0.0}, w[3] = {3.0 * k, 20.0, -5.0};
        CHECK(se3d_particles_add_clumps(b.particles, (uint32_t)(k % 3), b.material, 1, x, e, v,
                                        w) == SE3D_OK);
    }
    CHECK(se3d_particles_step(b.particles, 3000) == SE3D_OK);
    const size_t count = (size_t)(end - first);
    double *to = states;
    CHECK(se3d_particles_get_clumps(b.particles, count, to, to + 3 * count, to + 7 * count,
                                    to + 10 * count) == SE3D_OK);
    bed_close(&b);
}

/* Some are moved side by side, whatever they are made like. */
static void clumps_beside_others_move_as_alone(void)
{
    double all[FALLING_STATE * FALLING], alone[FALLING_STATE];
    static const int begin[4] = {0, 3, 7, 10}, size[4] = {3, 4, 3, 3}; /* of r, e, v, w */
    run_falling(0, FALLING, all);
    for (int k = 0; k < FALLING; ++k) {
        run_falling(k, k + 1, alone);
        CHECK(alone[2] < 0.012);
        for (int part = 0; part < 4; ++part) {
            CHECK(memcmp(all + begin[part] * FALLING + size[part] * k, alone + begin[part],
                         (size_t)size[part] * sizeof *all) == 0);
        }
    }
}

int main(void)
{
    RUN(overlapping_spheres_count_once);
    RUN(apart_and_inside_are_exact);
    RUN(given_masses_are_taken);
    RUN(a_clump_of_one_sphere_is_that_sphere);
    RUN(rods_bounce_by_newtons_law);
    RUN(two_dimers_keep_the_restitution);
    RUN(the_free_top_converges_to_a_body);
    RUN(collisions_keep_what_they_must);
    RUN(spheres_stay_with_their_clump);
    RUN(a_heap_comes_to_rest);
    RUN(clumps_leave_whole);
    RUN(fills_turn_at_random);
    RUN(clumps_beside_others_move_as_alone);
    return check_finish();
}
