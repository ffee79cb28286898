/* SPDX-License-Identifier: BSD-3-Clause */
/* Grains against bodies that give way: the restitution typed is the one obtained, however light the
 * body is and wherever it is hit. */
#include "check.h"
#include "se3d/se3d.h"

#define R  0.01
#define PI 3.14159265358979323846

typedef struct scene {
    se3d_system *system;
    se3d_particles *particles;
    se3d_body body;
    se3d_solver *solver;
} scene;

static const double grain_mass = 2500.0 * 4.0 / 3.0 * PI * R * R * R;

/* A box of 0.1 x 0.1 x 0.04 m with its top at z = 0, `ratio` times as heavy as a grain. */
static void open_scene(scene *s, se3d_law law, double ratio, se3d_material *material)
{
    se3d_system_def def = se3d_system_def_default();
    def.gravity[2] = 0.0;
    CHECK(se3d_system_create(&def, &s->system) == SE3D_OK);
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = (int32_t)law;
    CHECK(se3d_system_set_contact(s->system, &contact) == SE3D_OK);
    se3d_material_def what = se3d_material_def_default();
    what.density = 2500.0;
    what.stiffness = 1e5;
    what.young = 1e8;
    what.friction = 0.0;
    what.restitution = 0.5;
    CHECK(se3d_material_create(s->system, &what, material) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = ratio * grain_mass;
    body.inertia[0] = body.inertia[1] = body.mass * (0.01 + 0.0016) / 12.0;
    body.inertia[2] = body.mass * 0.02 / 12.0;
    body.position[2] = -0.02;
    CHECK(se3d_body_create(s->system, &body, &s->body) == SE3D_OK);
    se3d_shape_def box = se3d_shape_def_default();
    se3d_shape shape;
    box.body = s->body;
    box.material = *material;
    box.size[0] = box.size[1] = 0.1;
    box.size[2] = 0.04;
    CHECK(se3d_shape_create_box(s->system, &box, &shape) == SE3D_OK);
    CHECK(se3d_particles_create(s->system, NULL, &s->particles) == SE3D_OK);
}

static void close_scene(scene *s)
{
    se3d_solver_destroy(s->solver);
    se3d_particles_destroy(s->particles);
    se3d_system_destroy(s->system);
}

static void go(scene *s, double time)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_VERLET;
    CHECK(se3d_solver_create(s->system, &def, &s->solver) == SE3D_OK);
    CHECK(se3d_solver_run(s->solver, time) == SE3D_OK);
}

/* A grain falls on the box at x, y with 1 m/s; returns how fast it leaves the point that it hit. */
static double rebound(se3d_law law, double ratio, double x, double y)
{
    scene s;
    se3d_material material;
    open_scene(&s, law, ratio, &material);
    const double r[3] = {x, y, R + 1e-5}, down[3] = {0.0, 0.0, -1.0}, radius = R;
    CHECK(se3d_particles_add(s.particles, material, 1, r, &radius, down, NULL, NULL) == SE3D_OK);
    go(&s, 0.004);
    double v[3], u[3], w[3];
    CHECK(se3d_particles_count_contacts(s.particles) == 0);
    CHECK(se3d_particles_get_all(s.particles, 1, NULL, v, NULL) == SE3D_OK);
    CHECK(se3d_body_get_velocity(s.system, s.body, u) == SE3D_OK);
    CHECK(se3d_body_get_angular_velocity(s.system, s.body, w) == SE3D_OK);
    CHECK_NEAR(v[2] + ratio * u[2], -1.0, 1e-12); /* momentum */
    close_scene(&s);
    return v[2] - (u[2] + w[0] * y - w[1] * x); /* w is that of a box that has hardly turned */
}

static void restitution_is_what_was_typed_on_bodies_that_give_way(void)
{
    const double ratio[4] = {1e6, 10.0, 1.0, 0.2};
    for (int k = 0; k < 8; ++k) {
        se3d_law law = k & 4 ? SE3D_LAW_HERTZ_MINDLIN : SE3D_LAW_HOOKE;
        CHECK_NEAR(rebound(law, ratio[k % 4], 0.0, 0.0), 0.5, 4e-3);
        CHECK_NEAR(rebound(law, ratio[k % 4], 0.03, 0.02), 0.5, 1e-2);
    }
}

int main(void)
{
    RUN(restitution_is_what_was_typed_on_bodies_that_give_way);
    return check_finish();
}
