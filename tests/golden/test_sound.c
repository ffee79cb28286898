/* SPDX-License-Identifier: BSD-3-Clause */
/* Sound in a ring of squeezed beads, standing waves of small amplitude in closed form: with the
 * stiffness k = dF/d(overlap) of a contact, N beads of mass m swing in wave n at
 *
 *     omega = 2 sqrt(k/m) sin(pi n/N),   k = kn (hooke), 3/2 sqrt(R* overlap) 4/3 E* (Hertz)
 *
 * so that long waves of Hertz' law go with the sixth root of the force (Coste, Falcon and Fauve,
 * Phys. Rev. E 56, 1997). Steps of h swing with 2/h asin(omega h/2). */
#include "support/bed.h"

#include <math.h>

#define PI     3.1415926535897932384626433832795
#define BEADS  16
#define RADIUS 0.01

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2e4;
    def.young = 1e9;
    def.poisson = 0.25;
    def.restitution = 1.0;
    return def;
}

/* A ring with this overlap of neighbours, each of which moves by the wave. */
static void open_ring(bed *b, int32_t law, double overlap, int wave, double speed)
{
    static const double none[3] = {0.0, 0.0, 0.0};
    const se3d_material_def material = stuff();
    const double pitch = 2.0 * RADIUS - overlap;
    se3d_particles_def def = se3d_particles_def_default();
    def.boundary[0] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    def.upper[0] = BEADS * pitch;
    bed_open(b, law, none, &def, &material);
    for (int k = 0; k < BEADS; ++k) {
        const double r[3] = {k * pitch, 0.0, 0.0};
        const double v[3] = {speed * cos(2.0 * PI * wave * k / BEADS), 0.0, 0.0};
        bed_add(b, r, RADIUS, v, NULL);
    }
}

/* The part of the wave in the velocities. */
static double wave_of(const bed *b, int wave)
{
    double v[3 * BEADS], sum = 0.0, norm = 0.0;
    CHECK(!se3d_particles_get_all(b->particles, BEADS, NULL, v, NULL));
    for (int k = 0; k < BEADS; ++k) {
        const double of = cos(2.0 * PI * wave * k / BEADS);
        sum += v[3 * k] * of;
        norm += of * of;
    }
    return sum / norm;
}

/* After 5 1/4 periods it is at zero: what is there tells how much the frequency is off. */
static void check_wave(int32_t law, double overlap, int wave)
{
    bed b;
    const se3d_material_def of = stuff();
    const double mass = of.density * 4.0 / 3.0 * PI * pow(RADIUS, 3.0), turns = 5.25;
    const double shared = 0.5 * of.young / (1.0 - of.poisson * of.poisson);
    const double k =
        law == SE3D_CONTACT_LAW_HOOKE ? of.stiffness : 2.0 * shared * sqrt(0.5 * RADIUS * overlap);
    const double exact = 2.0 * sqrt(k / mass) * sin(PI * wave / BEADS);
    const double speed = 1e-4 * exact * overlap;
    double step;
    open_ring(&b, law, overlap, wave, speed);
    CHECK(!se3d_particles_get_step(b.particles, &step));
    const double omega = 2.0 / step * asin(0.5 * exact * step);
    CHECK(se3d_particles_run(b.particles, 2.0 * PI * turns / omega) >= 0);
    CHECK_NEAR(asin(wave_of(&b, wave) / speed) / (2.0 * PI * turns), 0.0, 5e-6);
    CHECK(se3d_particles_run(b.particles, 2.0 * PI * 5.5 / omega) >= 0);
    CHECK_NEAR(wave_of(&b, wave) / speed, -1.0, 1e-3); /* and it has lost nothing */
    bed_close(&b);
}

static void waves_swing_as_the_contacts_are_stiff(void)
{
    static const int waves[4] = {1, 2, 5, 8};
    static const double overlaps[3] = {1e-5, 1e-4, 1e-3}; /* over the radius */
    for (int n = 0; n < 4; ++n) {
        for (int k = 0; k < 3; ++k) {
            check_wave(SE3D_CONTACT_LAW_HERTZ_MINDLIN, overlaps[k] * RADIUS, waves[n]);
        }
        check_wave(SE3D_CONTACT_LAW_HOOKE, 1e-3 * RADIUS, waves[n]);
    }
}

int main(void)
{
    RUN(waves_swing_as_the_contacts_are_stiff);
    return check_finish();
}
