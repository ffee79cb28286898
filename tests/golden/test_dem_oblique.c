/* SPDX-License-Identifier: BSD-3-Clause */
/* Oblique impacts, sticking, slipping and both, on a wall and of two spheres, against an integrator
 * of one contact written from docs/theory/contact-laws.md, with steps 100 times finer. */
#include "check.h"
#include "se3d/se3d.h"

#define PI      3.1415926535897932384626433832795
#define RADIUS  0.005
#define DENSITY 2500.0
#define KN      4e4
#define YOUNG   1e8
#define POISSON 0.3

/* A sphere above a wall, or one of two whose other is where half a turn about y through the origin
 * brings it. In the plane x, z; spin about y. */
typedef struct impact {
    double share; /* relative over own velocity: 1 wall, 2 pair */
    double kn, kt, friction;
    int hertz, reserved;
} impact;

typedef struct state {
    double x, z, vx, vz, w, xi;
} state;

static double mass(void)
{
    return DENSITY * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;
}

/* From the surface of the wall, or from the point between the two. */
static double distance(const impact *c, double x, double z)
{
    return c->share > 1.5 ? hypot(x, z) : z;
}

static state rates(const impact *c, state *s)
{
    double arm = distance(c, s->x, s->z);
    double overlap = c->share * (RADIUS - arm);
    double nx = c->share > 1.5 ? s->x / arm : 0.0;
    double nz = c->share > 1.5 ? s->z / arm : 1.0;
    double slip = s->vx * nz - s->vz * nx - arm * s->w;
    state rate = {.x = s->vx, .z = s->vz};
    if (overlap <= 0.0) {
        return rate;
    }
    double scale = c->hertz ? sqrt(RADIUS / c->share * overlap) : 1.0;
    double normal = c->kn * scale * overlap;
    double tangent = -c->kt * scale * s->xi;
    if (fabs(tangent) > c->friction * normal) {
        tangent = copysign(c->friction * normal, tangent);
        s->xi = -tangent / (c->kt * scale);
    }
    rate.vx = (normal * nx + tangent * nz) / mass();
    rate.vz = (normal * nz - tangent * nx) / mass();
    rate.w = -arm * tangent / (0.4 * mass() * RADIUS * RADIUS);
    rate.xi = c->share * slip;
    return rate;
}

static state moved(state s, state rate, double h)
{
    return (state){s.x + h * rate.x,   s.z + h * rate.z, s.vx + h * rate.vx,
                   s.vz + h * rate.vz, s.w + h * rate.w, s.xi + h * rate.xi};
}

/* Midpoint rule until they part. */
static state reference(const impact *c, state s, double h)
{
    do {
        state middle = moved(s, rates(c, &s), 0.5 * h);
        s = moved(s, rates(c, &middle), h);
    } while (distance(c, s.x, s.z) < RADIUS);
    return s;
}

static se3d_material make(se3d_system *system, const impact *c)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = c->hertz ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
    CHECK(se3d_system_set_contact(system, &contact) == SE3D_OK);
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    stuff.density = DENSITY;
    stuff.stiffness = KN;
    stuff.young = YOUNG;
    stuff.poisson = POISSON;
    stuff.friction = c->friction;
    stuff.restitution = 1.0;
    CHECK(se3d_material_create(system, &stuff, &material) == SE3D_OK);
    return material;
}

/* The same by the library; *step becomes the one it took. */
static state library(const impact *c, state s, double divide, double *step)
{
    se3d_system_def def = se3d_system_def_default();
    se3d_system *system;
    se3d_particles *particles;
    const int pair = c->share > 1.5;
    def.gravity[2] = 0.0;
    CHECK(se3d_system_create(&def, &system) == SE3D_OK);
    se3d_material material = make(system, c);
    CHECK(se3d_particles_create(system, NULL, &particles) == SE3D_OK);
    const double r[6] = {0.0, 0.0, s.z, 0.0, 0.0, -s.z}, radius[2] = {RADIUS, RADIUS};
    const double v[6] = {s.vx, 0.0, s.vz, -s.vx, 0.0, -s.vz}, w[6] = {0, s.w, 0, 0, s.w, 0};
    CHECK(se3d_particles_add(particles, material, pair ? 2 : 1, r, radius, v, w, NULL) == SE3D_OK);
    if (!pair) {
        se3d_shape_def plane = se3d_shape_def_default();
        se3d_shape shape;
        plane.material = material;
        CHECK(se3d_shape_create_plane(system, &plane, &shape) == SE3D_OK);
    }
    CHECK(se3d_particles_get_step(particles, step) == SE3D_OK);
    *step /= divide;
    CHECK(se3d_particles_set_step(particles, *step) == SE3D_OK);
    double x[6], u[6], spin[6];
    do {
        CHECK(se3d_particles_step(particles, 1) == SE3D_OK);
        CHECK(se3d_particles_get_all(particles, pair ? 2 : 1, x, u, spin) == SE3D_OK);
    } while (distance(c, x[0], x[2]) < RADIUS);
    if (pair) {
        CHECK_NEAR(u[3], -u[0], 1e-12);
        CHECK_NEAR(spin[4], spin[1], 1e-9);
    }
    se3d_particles_destroy(particles);
    se3d_system_destroy(system);
    return (state){x[0], x[2], u[0], u[2], spin[1], 0.0};
}

static double difference(const state *a, const state *b)
{
    return fmax(fmax(fabs(a->vz - b->vz), fabs(a->vx - b->vx)), RADIUS * fabs(a->w - b->w));
}

static impact kind(int k, double friction)
{
    double e_star = YOUNG / (2.0 * (1.0 - POISSON * POISSON));
    double g_star = YOUNG / (4.0 * (2.0 - POISSON) * (1.0 + POISSON));
    int hertz = k & 1;
    return (impact){.share = k & 2 ? 2.0 : 1.0,
                    .kn = hertz ? 4.0 / 3.0 * e_star : KN,
                    .kt = hertz ? 8.0 * g_star : 2.0 / 7.0 * KN,
                    .friction = friction,
                    .hertz = hertz};
}

static void oblique_impacts_are_those_of_a_finer_integrator(void)
{
    static const double frictions[4] = {1e6, 0.5, 0.2, 0.05}; /* sticks; both; slips */
    static const double speeds[3] = {0.1, 0.4, 1.5};
    double change = 0.0;
    for (int k = 0; k < 4 * 4 * 3; ++k) {
        impact c = kind(k & 3, frictions[k >> 2 & 3]);
        state start = {0.0, RADIUS, speeds[k >> 4], -1.0, 10.0, 0.0};
        double coarse, fine;
        state a = library(&c, start, 4.0, &coarse);
        state b = library(&c, start, 16.0, &fine);
        state r = reference(&c, start, coarse / 100.0);
        CHECK(difference(&a, &r) < 2e-3);
        CHECK(difference(&b, &r) < 2e-4);
        change = fmax(change, fabs(r.vx - start.vx));
    }
    CHECK(change > 0.3);
}

/* The whole time at the cap: dv = -mu (1 + e) vn, and the spin that goes with the arm. */
static void sliding_impacts_obey_coulomb_exactly(void)
{
    for (int k = 0; k < 2; ++k) { /* on a wall: the normal does not turn */
        impact c = kind(k, 0.05);
        state start = {0.0, RADIUS, 4.0, -1.0, 0.0, 0.0};
        double step;
        state end = library(&c, start, 16.0, &step);
        CHECK_NEAR(end.vz, 1.0, 1e-4);
        CHECK_NEAR(start.vx - end.vx, 0.05 * (end.vz - start.vz), 2e-4); /* it starts at rest */
        CHECK(end.w > 0.0);
    }
}

/* With kt = 2/7 kn a linear contact of a solid sphere swings as fast across as along the normal, so
 * that the ratio of the forces stays what it was: whoever slips less than 7/2 mu vn sticks, and the
 * point of contact comes back with the opposite velocity; whoever slips more slides to the end. The
 * impacts at all angles and spins of Chung and Ooi (2011), tests 4 to 8, in closed form. */
static void linear_impacts_at_any_angle_and_spin_are_in_closed_form(void)
{
    const double mu = 0.3, vn = 0.01; /* slow: the arm stays R */
    int sticks = 0, slides = 0;
    for (int k = -30; k <= 30; ++k) {
        const impact c = kind(0, mu);
        const double slip = 0.08 * k * vn * (1.0 + 1e-3); /* of the point of contact */
        const double part = (k & 3) / 3.0;                /* of it by spin */
        state start = {0.0, RADIUS, (1.0 - part) * slip, -vn, -part * slip / RADIUS, 0.0};
        const double most = 2.0 * mu * vn, stuck = 4.0 / 7.0 * slip;
        const double change = fabs(stuck) < most ? stuck : copysign(most, slip);
        double step;
        state end = library(&c, start, 16.0, &step);
        CHECK_NEAR(end.vz / vn, 1.0, 1e-4);
        CHECK_NEAR((start.vx - end.vx) / vn, change / vn, 1e-3);
        CHECK_NEAR(0.4 * RADIUS * (end.w - start.w) / vn, change / vn, 1e-3);
        sticks += fabs(stuck) < most;
        slides += fabs(stuck) > most;
    }
    CHECK(sticks > 10 && slides > 10);
}

int main(void)
{
    RUN(oblique_impacts_are_those_of_a_finer_integrator);
    RUN(sliding_impacts_obey_coulomb_exactly);
    RUN(linear_impacts_at_any_angle_and_spin_are_in_closed_form);
    return check_finish();
}
