/* SPDX-License-Identifier: BSD-3-Clause */
/* Impacts that slide from beginning to end: whatever the restitution, law and method, friction
 * takes mu times what the normal force gives (Coulomb; closed form), and no energy comes from it.
 */
#include "support/scene.h"

#define MU     0.4
#define ALONG  5.0 /* m/s; it stops at 7/2 mu (1 + e) of INTO */
#define INTO   1.0
#define RADIUS 0.05
#define FLIGHT 1e-3 /* s */

static const double restitutions[5] = {0.9, 0.7, 0.5, 0.3, 0.1};

/* What it slides on; PAIR: a ball like it. */
enum { PLANE, MESH, BODY, PAIR, PARTNERS };

typedef struct impact {
    int32_t law, method, formulation;
    double e;
    int partner;
} impact;

static scene begin(const impact *m, double gravity)
{
    /* two balls so hard that their normal hardly turns while they touch: 1e-5 s */
    se3d_material_def stuff = scene_stuff(MU, m->e, m->partner == PAIR ? 3e10 : 1e7);
    const double g[3] = {0.0, 0.0, -gravity};
    stuff.young = m->partner == PAIR ? 1e14 : 1e10;
    scene s = scene_begin_with(NULL, m->law, &stuff);
    CHECK(se3d_system_set_gravity(s.system, g) == SE3D_OK);
    return s;
}

static void floor_for(scene *s, int partner)
{
    static const double points[12] = {-1.0, -1.0, 0.0, 1.0,  -1.0, 0.0,
                                      1.0,  1.0,  0.0, -1.0, 1.0,  0.0};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    static const double size[3] = {2.0, 2.0, 0.4}, below[3] = {0.0, 0.0, -0.2};
    if (partner == PLANE) {
        scene_floor(s, 0.0);
    } else if (partner == MESH) {
        scene_mesh_on(s, scene_ground(s), points, 4, faces, 2);
    } else if (partner == BODY) {
        (void)scene_box_on(s, scene_ground(s), size, below);
    }
}

/* What friction took of the velocity along, over mu times what the impact gave across. */
static void check_ratio(const impact *m, const double before[3], const double after[3])
{
    const double across = after[2] - before[2];
    CHECK_NEAR(across, (m->partner == PAIR ? 0.5 : 1.0) * (1.0 + m->e) * INTO,
               1e-3 * (1.0 + m->e) * INTO);
    CHECK_NEAR((before[0] - after[0]) / (MU * across), 1.0, 1e-3);
}

static double energy_of(const double v[3], const double w[3], double mass)
{
    const double j = 0.4 * mass * RADIUS * RADIUS;
    return 0.5 * mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) +
           0.5 * j * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
}

static void bodies_slide(const impact *m)
{
    scene s = begin(m, 0.0);
    const double v[3] = {ALONG, 0.0, -INTO}, mass = 0.5;
    const double r[3] = {-FLIGHT * ALONG, 0.0,
                         (m->partner == PAIR ? 2.0 : 1.0) * RADIUS + FLIGHT * INTO};
    double lost = energy_of(v, scene_zero, mass), u[3], w[3];
    se3d_body ball = scene_ball(&s, RADIUS, mass, r, v), other = {0};
    if (m->partner == PAIR) {
        other = scene_ball(&s, RADIUS, mass, scene_zero, scene_zero);
    } else {
        floor_for(&s, m->partner);
    }
    /* convex takes an impact in one step, on which the normal of two balls turns */
    const int turns = m->method == SE3D_METHOD_CONVEX && m->partner == PAIR;
    scene_solve(&s, m->method, m->formulation, turns ? 2e-6 : 0.0, 0.0);
    if (scene_run(&s, 3.0 * FLIGHT)) {
        CHECK(se3d_body_get_velocity(s.system, ball, u) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, ball, w) == SE3D_OK);
        check_ratio(m, v, u);
        lost -= energy_of(u, w, mass);
        if (m->partner == PAIR) {
            CHECK(se3d_body_get_velocity(s.system, other, u) == SE3D_OK);
            CHECK(se3d_body_get_angular_velocity(s.system, other, w) == SE3D_OK);
            lost -= energy_of(u, w, mass);
        }
        CHECK(lost > 0.5 * MU * mass * INTO * ALONG * 0.5);
    }
    scene_end(&s);
}

static void check_methods(const int32_t *methods, int count, int32_t formulation)
{
    for (int k = 0; k < count * 40; ++k) {
        impact m = {.method = methods[k / 40],
                    .formulation = formulation,
                    .law = k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                    .partner = k / 2 % PARTNERS,
                    .e = restitutions[k % 40 / 8]};
        bodies_slide(&m);
    }
}

static void bodies_that_slide_lose_mu_times_the_normal_impulse_in_explicit_methods(void)
{
    static const int32_t methods[6] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45,   SE3D_METHOD_RK4,
                                       SE3D_METHOD_VERLET, SE3D_METHOD_RATTLE, SE3D_METHOD_AUTO};
    check_methods(methods, 6, SE3D_FORMULATION_ROMEGA);
}

static void bodies_that_slide_lose_mu_times_the_normal_impulse_in_implicit_methods(void)
{
    static const int32_t methods[5] = {SE3D_METHOD_RADAU, SE3D_METHOD_GENERALIZED_ALPHA,
                                       SE3D_METHOD_HHT, SE3D_METHOD_BDF, SE3D_METHOD_CONVEX};
    check_methods(methods, 5, SE3D_FORMULATION_ROMEGA);
}

static void bodies_that_slide_lose_mu_times_the_normal_impulse_in_other_coordinates(void)
{
    static const int32_t methods[4] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RK4,
                                       SE3D_METHOD_RADAU};
    check_methods(methods, 3, SE3D_FORMULATION_JOINT);
    check_methods(methods, 4, SE3D_FORMULATION_RP);
}

static void particles_slide(const impact *m, int partner, int portable)
{
    scene s = begin(m, 0.0);
    se3d_particles *set;
    se3d_particles_def def = se3d_particles_def_default();
    double v[6] = {ALONG, 0.0, -INTO}, radius[2] = {RADIUS, RADIUS}, step, u[6], w[6];
    double r[6] = {0.0, 0.0, (m->partner == PAIR ? 2.0 : 1.0) * RADIUS};
    const double mass = 1000.0 * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;
    const size_t count = m->partner == PAIR ? 2 : 1;
    def.portable = portable;
    floor_for(&s, partner);
    CHECK(se3d_particles_create(s.system, &def, &set) == SE3D_OK);
    CHECK(se3d_particles_add(set, s.material, count, r, radius, v, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_get_step(set, &step) == SE3D_OK);
    r[0] -= 3.3 * step * ALONG;
    r[2] += 3.3 * step * INTO;
    CHECK(se3d_particles_set_all(set, count, r, NULL, NULL) == SE3D_OK);
    int steps = 0;
    do {
        CHECK(se3d_particles_step(set, 5) == SE3D_OK);
    } while (++steps < 10000 && (steps < 4 || se3d_particles_count_contacts(set) > 0));
    CHECK(se3d_particles_get_all(set, count, NULL, u, w) == SE3D_OK);
    check_ratio(m, v, u);
    double lost = energy_of(v, scene_zero, mass) - energy_of(u, w, mass);
    lost -= m->partner == PAIR ? energy_of(u + 3, w + 3, mass) : 0.0;
    CHECK(lost > 0.5 * MU * mass * INTO * ALONG * 0.5);
    se3d_particles_destroy(set);
    scene_end(&s);
}

static void particles_that_slide_lose_mu_times_the_normal_impulse(void)
{
    for (int k = 0; k < 5 * 4 * PARTNERS; ++k) {
        const int partner = k / 4 % PARTNERS;
        impact m = {.law = k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                    .partner = partner,
                    .e = restitutions[k / 4 / PARTNERS]};
        particles_slide(&m, partner, k >> 1 & 1);
    }
}

/* Energy after an impact that comes at any angle, with any spin: what the restitution takes is
 * gone, and friction gives nothing. */
static void check_energy(int32_t law, int32_t method, double e, double along, double spin)
{
    const impact m = {.law = law, .method = method, .e = e};
    const double v[3] = {along, 0.0, -INTO}, r[3] = {0.0, 0.0, RADIUS + FLIGHT * INTO}, mass = 0.5;
    const double w[3] = {0.0, spin, 0.0};
    double u[3], turn[3];
    scene s = begin(&m, 0.0);
    se3d_body ball = scene_ball(&s, RADIUS, mass, r, v);
    CHECK(se3d_body_set_angular_velocity(s.system, ball, w) == SE3D_OK);
    scene_floor(&s, 0.0);
    scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    if (scene_run(&s, 3.0 * FLIGHT)) {
        const double before = energy_of(v, w, mass);
        CHECK(se3d_body_get_velocity(s.system, ball, u) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, ball, turn) == SE3D_OK);
        const double left = before - 0.5 * mass * INTO * INTO * (1.0 - e * e);
        CHECK(energy_of(u, turn, mass) < left + 1e-3 * before);
    }
    scene_end(&s);
}

static void friction_gives_no_energy_at_any_incidence(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU};
    for (int k = 0; k < 2 * 2 * 3 * 5 * 3; ++k) {
        const double e = 1.0 - 0.45 * (k / 4 % 3);
        check_energy(k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                     methods[k >> 1 & 1], e, 0.7 * (k / 12 % 5), 30.0 * (k / 60 - 1));
    }
}

int main(void)
{
    RUN(bodies_that_slide_lose_mu_times_the_normal_impulse_in_explicit_methods);
    RUN(bodies_that_slide_lose_mu_times_the_normal_impulse_in_implicit_methods);
    RUN(bodies_that_slide_lose_mu_times_the_normal_impulse_in_other_coordinates);
    RUN(particles_that_slide_lose_mu_times_the_normal_impulse);
    RUN(friction_gives_no_energy_at_any_incidence);
    return check_finish();
}
