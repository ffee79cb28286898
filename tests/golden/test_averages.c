/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over particles against closed forms: lattices in a period, a pile that rests, gases. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#define PI 3.1415926535897932384626433832795

static const double none[3] = {0.0, 0.0, 0.0}, down[3] = {0.0, 0.0, -10.0};

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 1000.0;
    def.stiffness = 1e4;
    def.restitution = 0.2;
    return def;
}

static se3d_average average_of(const bed *b, const double low[3], const double high[3], int32_t tag)
{
    se3d_average average;
    CHECK(!se3d_particles_get_average(b->particles, low, high, tag, &average));
    return average;
}

/* A cubic lattice that overlaps with its images: every sphere has six contacts of force k d, and
 * the stress is that of one along each axis in a cell. A box that is moved holds the same. */
static void a_lattice_in_a_period(void)
{
    enum { N = 4 };
    const double R = 0.01, a = 0.019, L = N * a, overlap = 2.0 * R - a;
    se3d_particles_def def = se3d_particles_def_default();
    const se3d_material_def material = stuff();
    bed b;
    for (int k = 0; k < 3; ++k) {
        def.boundary[k] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        def.upper[k] = L;
    }
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    for (int k = 0; k < N * N * N; ++k) {
        const double r[3] = {a * (k % N + 0.3), a * (k / N % N + 0.5), a * (k / N / N + 0.8)};
        bed_add(&b, r, R, none, none);
    }
    const double volume = 4.0 / 3.0 * PI * R * R * R, pressure = 1e4 * overlap * a / (a * a * a);
    for (int k = 0; k < 4; ++k) {
        double low[3], high[3];
        CHECK(!se3d_particles_step(b.particles, 3)); /* they balance */
        for (int c = 0; c < 3; ++c) {
            low[c] = 0.013 * k * (c + 1) - 0.02;
            high[c] = low[c] + L;
        }
        const se3d_average average = average_of(&b, low, high, -1);
        CHECK(average.count == N * N * N);
        CHECK_NEAR(average.coordination, 6.0, 0.0);
        CHECK_NEAR(average.solid_fraction, N * N * N * volume / (L * L * L), 1e-12);
        for (int c = 0; c < 6; ++c) {
            CHECK_NEAR(average.contact_stress[c] / pressure, c < 3 ? 1.0 : 0.0, 1e-9);
        }
    }
    /* a slab of it: the same stress, whatever it cuts */
    const double low[3] = {0.0, 0.0, 0.011}, high[3] = {L, L, 0.017};
    const se3d_average slab = average_of(&b, low, high, -1);
    CHECK_NEAR(slab.contact_stress[2] / pressure, 1.0, 1e-9);
    bed_close(&b);
}

/* Three spheres on top of each other on a floor: the stress times the area is the weight above, in
 * the mean over the height. */
static void a_pile_carries_its_weight(void)
{
    const double R = 0.01, up[3] = {0.0, 0.0, 1.0}, m = 1000.0 * 4.0 / 3.0 * PI * R * R * R;
    const se3d_material_def material = stuff();
    double z[9];
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    (void)bed_add_plane(&b, none, up);
    for (int k = 0; k < 3; ++k) {
        const double r[3] = {0.0, 0.0, R * (2 * k + 1)};
        bed_add(&b, r, R, none, none);
    }
    const uint32_t top = 2;
    CHECK(!se3d_particles_set_tags(b.particles, 1, &top, 3));
    CHECK(!se3d_particles_run(b.particles, 0.5));
    CHECK(!se3d_particles_get_all(b.particles, 3, z, NULL, NULL));
    /* from inside the lowest to inside the highest */
    const double low[3] = {-0.02, -0.03, 0.004}, high[3] = {0.02, 0.03, 0.045};
    const double weight = m * 10.0, area = 0.04 * 0.06, height = high[2] - low[2];
    const double sum =
        3.0 * weight * (z[2] - low[2]) + 2.0 * weight * (z[5] - z[2]) + weight * (high[2] - z[5]);
    se3d_average average = average_of(&b, low, high, -1);
    CHECK(average.count == 2);
    CHECK_NEAR(average.mass, 2.0 * m, 1e-15);
    CHECK_NEAR(average.coordination, 2.0, 0.0);
    CHECK_NEAR(average.contact_stress[2] / (sum / area / height), 1.0, 1e-6);
    CHECK_NEAR(average.contact_stress[0], 0.0, 1e-12);
    /* all of the middle one, a half of those at the ends: planes cut caps */
    const double half[3] = {-0.02, -0.03, z[2]}, end[3] = {0.02, 0.03, z[8]};
    average = average_of(&b, half, end, -1);
    CHECK_NEAR(average.solid_fraction * area * (z[8] - z[2]) / (m / 1000.0), 2.0, 1e-12);
    /* of the one with a tag: its contact with the one below */
    average = average_of(&b, half, end, 3);
    CHECK(average.count == 0);
    CHECK_NEAR(average.contact_stress[2] * area * (z[8] - z[2]) / (weight * (z[8] - z[5])), 1.0,
               1e-6);
    bed_close(&b);
}

/* Sums over what moves freely. */
static void a_gas_has_a_temperature(void)
{
    enum { N = 200 };
    const se3d_material_def material = stuff();
    const double low[3] = {0.0, 0.0, 0.0}, high[3] = {0.5, 1.0, 1.0};
    double r[3 * N], v[3 * N], mean[3] = {0.0}, stress[6] = {0.0}, temperature = 0.0, mass = 0.0;
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    uint64_t count = 0;
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b.material;
    fill.radius_min = 0.01;
    fill.radius_max = 0.02;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 1.0;
    fill.count = N;
    CHECK(!se3d_particles_fill_random(b.particles, &fill));
    double radius[N];
    CHECK(!se3d_particles_get_all(b.particles, N, r, NULL, NULL));
    CHECK(!se3d_particles_get_radii(b.particles, N, radius));
    for (int k = 0; k < 3 * N; ++k) {
        v[k] = 1.0 + 0.1 * (k % 3) + 0.01 * ((k * 7919) % 101);
    }
    CHECK(!se3d_particles_set_all(b.particles, N, NULL, v, NULL));
    for (int pass = 0; pass < 2; ++pass) {
        for (int k = 0; k < N; ++k) {
            const double m = 1000.0 * 4.0 / 3.0 * PI * radius[k] * radius[k] * radius[k];
            if (!(r[3 * k] < 0.5)) {
                continue;
            }
            count += pass == 0;
            mass += pass == 0 ? m : 0.0;
            for (int a = 0; a < 3; ++a) {
                const double u = v[3 * k + a] - mean[a];
                temperature += pass == 1 ? u * u / 3.0 / (double)count : 0.0;
            }
            for (int c = 0; c < 6; ++c) {
                const double x = v[3 * k + row[c]] - mean[row[c]],
                             y = v[3 * k + column[c]] - mean[column[c]];
                stress[c] += pass == 1 ? m * x * y / 0.5 : 0.0;
            }
        }
        for (int a = 0; pass == 0 && a < 3; ++a) {
            for (int k = 0; k < N; ++k) {
                const double m = 1000.0 * 4.0 / 3.0 * PI * radius[k] * radius[k] * radius[k];
                mean[a] += r[3 * k] < 0.5 ? m * v[3 * k + a] / mass : 0.0;
            }
        }
    }
    const se3d_average average = average_of(&b, low, high, -1);
    CHECK(average.count == count && count > 50 && count < 150);
    CHECK_NEAR(average.mass / mass, 1.0, 1e-12);
    CHECK_NEAR(average.temperature / temperature, 1.0, 1e-12);
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(average.velocity[a], mean[a], 1e-12);
        CHECK_NEAR(average.mass_flux[a], mass * mean[a] / 0.5, 1e-9);
    }
    for (int c = 0; c < 6; ++c) {
        CHECK_NEAR(average.kinetic_stress[c], stress[c], 1e-9);
    }
    CHECK_NEAR(average.coordination, 0.0, 0.0);
    bed_close(&b);
}

/* A clump is one particle; what its spheres share counts once; its branch is from its centre. */
static void clumps_are_one_particle(void)
{
    static const double r[6] = {-0.01, 0.0, 0.0, 0.01, 0.0, 0.0}, radii[2] = {0.015, 0.015},
                        up[3] = {0.0, 0.0, 1.0}, at[3] = {0.0, 0.0, 0.015};
    const double low[3] = {-0.1, -0.1, 0.0}, high[3] = {0.1, 0.1, 0.1};
    const se3d_material_def material = stuff();
    se3d_clump_def def = se3d_clump_def_default();
    se3d_clump_template_info info;
    uint32_t index;
    bed b;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
    (void)bed_add_plane(&b, none, up);
    def.count = 2;
    def.r = r;
    def.radius = radii;
    CHECK(!se3d_particles_add_clump_template(b.particles, &def, &index));
    CHECK(!se3d_particles_get_clump_template(b.particles, index, &info));
    CHECK(!se3d_particles_add_clumps(b.particles, index, b.material, 1, at, NULL, NULL, NULL));
    CHECK(!se3d_particles_run(b.particles, 0.6));
    const se3d_average average = average_of(&b, low, high, -1);
    CHECK(average.count == 1);
    CHECK_NEAR(average.coordination, 2.0, 0.0);
    CHECK_NEAR(average.mass, 1000.0 * info.volume, 1e-15);
    CHECK_NEAR(average.solid_fraction * 0.004 / info.volume, 1.0, 2e-3); /* sunk in a little */
    double x[3];
    CHECK(!se3d_particles_get_clumps(b.particles, 1, x, NULL, NULL, NULL));
    /* the weight over the height of the centre, from both contacts */
    CHECK_NEAR(average.contact_stress[2] * 0.004 / (10.0 * average.mass * x[2]), 1.0, 1e-6);
    CHECK_NEAR(average.contact_stress[0], 0.0, 1e-9); /* their arms along x balance */
    bed_close(&b);
}

int main(void)
{
    RUN(a_lattice_in_a_period);
    RUN(a_pile_carries_its_weight);
    RUN(a_gas_has_a_temperature);
    RUN(clumps_are_one_particle);
    return check_finish();
}
