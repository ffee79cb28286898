/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles against bodies that give way: the given restitution is the one obtained, however light
 * the body is and wherever it is hit. */
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

static const double particle_mass = 2500.0 * 4.0 / 3.0 * PI * R * R * R;

/* A box of 0.1 x 0.1 x 0.04 m with its top at z = 0, `ratio` times as heavy as a particle. */
static void open_scene(scene *s, se3d_contact_law law, double ratio, se3d_material *material)
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
    body.mass = ratio * particle_mass;
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

/* A particle falls on the box at x, y with 1 m/s; returns how fast it leaves the point it hit. */
static double rebound(se3d_contact_law law, double ratio, double x, double y)
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
        se3d_contact_law law = k & 4 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
        CHECK_NEAR(rebound(law, ratio[k % 4], 0.0, 0.0), 0.5, 4e-3);
        CHECK_NEAR(rebound(law, ratio[k % 4], 0.03, 0.02), 0.5, 1e-2);
    }
}

/* A spring with a little friction, without memory. */
static se3d_status spring_law(void *ctx, const se3d_contact_input *in, se3d_contact_output *out)
{
    (void)ctx;
    out->force = 1e5 * in->overlap;
    for (int a = 0; a < 3; ++a) {
        out->tangential[a] = -0.5 * in->slip[a];
    }
    return SE3D_OK;
}

/* A body of a box, a mesh, a cylinder and a sphere in a row along y, seven times as heavy as a
 * particle. */
static void add_shapes(const scene *s, se3d_material material)
{
    static const double corners[12] = {0.01,  0.0,   0.0,   -0.01, 0.01, -0.01,
                                       -0.01, -0.01, -0.01, -0.01, 0.0,  0.014};
    static const uint32_t faces[12] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.body = s->body;
    def.material = material;
    def.size[0] = def.size[1] = def.size[2] = 0.02;
    def.radius = 0.01;
    def.length = 0.02;
    def.vertices = corners;
    def.vertex_count = 4;
    def.triangles = faces;
    def.triangle_count = 4;
    def.position[1] = -0.036;
    CHECK(se3d_shape_create_box(s->system, &def, &shape) == SE3D_OK);
    def.position[1] = -0.012;
    CHECK(se3d_shape_create_mesh(s->system, &def, &shape) == SE3D_OK);
    def.position[1] = 0.012;
    CHECK(se3d_shape_create_cylinder(s->system, &def, &shape) == SE3D_OK);
    def.position[1] = 0.036;
    CHECK(se3d_shape_create_sphere(s->system, &def, &shape) == SE3D_OK);
}

#define PERIOD    0.2
#define PARTICLES 8

/* Eight particles hit the body at x from both sides in a domain with a period along x; writes their
 * velocities and spins and those of the body, and the forces on the particles at a moment. */
static void collide(double x, int callback, double out[6 * PARTICLES + 6],
                    double press[3 * PARTICLES])
{
    scene s = {0};
    se3d_system_def world = se3d_system_def_default();
    world.gravity[2] = 0.0;
    CHECK(se3d_system_create(&world, &s.system) == SE3D_OK);
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = callback ? SE3D_CONTACT_LAW_CALLBACK : SE3D_CONTACT_LAW_HOOKE;
    contact.callback = callback ? spring_law : NULL;
    contact.step = 5e-6;
    CHECK(se3d_system_set_contact(s.system, &contact) == SE3D_OK);
    se3d_material_def stuff = se3d_material_def_default();
    se3d_material material;
    stuff.density = 2500.0;
    stuff.stiffness = 1e5;
    CHECK(se3d_material_create(s.system, &stuff, &material) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = 7.0 * particle_mass;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1e-4 * particle_mass * 20.0;
    body.position[0] = x;
    CHECK(se3d_body_create(s.system, &body, &s.body) == SE3D_OK);
    add_shapes(&s, material);
    se3d_particles_def domain = se3d_particles_def_default();
    domain.boundary[0] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    domain.lower[0] = -0.5 * PERIOD;
    domain.upper[0] = 0.5 * PERIOD;
    CHECK(se3d_particles_create(s.system, &domain, &s.particles) == SE3D_OK);
    for (int k = 0; k < PARTICLES; ++k) {
        const double side = k % 2 ? 1.0 : -1.0, radius = R;
        double at = x + side * (0.0215 + 0.0003 * k);
        at -= PERIOD * floor(at / PERIOD + 0.5);
        const double r[3] = {at, -0.036 + 0.024 * (k / 2), 0.002 * side};
        const double v[3] = {-side, 0.1, 0.2}, w[3] = {10.0, 20.0 * side, -15.0};
        CHECK(se3d_particles_add(s.particles, material, 1, r, &radius, v, w, NULL) == SE3D_OK);
    }
    go(&s, 0.0025);
    CHECK(se3d_particles_get_forces(s.particles, PARTICLES, press, NULL) == SE3D_OK);
    CHECK(se3d_solver_run(s.solver, 0.008) == SE3D_OK);
    CHECK(se3d_particles_get_all(s.particles, PARTICLES, NULL, out, out + 3 * PARTICLES) ==
          SE3D_OK);
    CHECK(se3d_body_get_velocity(s.system, s.body, out + 6 * PARTICLES) == SE3D_OK);
    CHECK(se3d_body_get_angular_velocity(s.system, s.body, out + 6 * PARTICLES + 3) == SE3D_OK);
    close_scene(&s);
}

/* The place of the body in the period makes no difference, nor do particles that meet it across. */
static void shapes_are_repeated_with_the_period(void)
{
    for (int callback = 0; callback < 2; ++callback) {
        double inside[6 * PARTICLES + 6], there[6 * PARTICLES + 6];
        double press[3 * PARTICLES], press_there[3 * PARTICLES], scale = 0.0;
        collide(0.0, callback, inside, press);
        const double places[4] = {0.1, -0.1, 0.0931, -0.088};
        for (int k = 0; k < 4; ++k) {
            collide(places[k], callback, there, press_there);
            for (int n = 0; n < 6 * PARTICLES + 6; ++n) {
                CHECK_NEAR(there[n], inside[n], 1e-7 * (1.0 + fabs(inside[n])));
            }
            for (int n = 0; n < 3 * PARTICLES; ++n) {
                CHECK_NEAR(press_there[n], press[n], 1e-5);
                scale = fmax(scale, fabs(press[n]));
            }
        }
        CHECK(scale > 1.0);
        for (int n = 0; n < PARTICLES; ++n) { /* all have been stopped or thrown back */
            CHECK(inside[3 * n] * (n % 2 ? 1.0 : -1.0) > -0.5);
        }
    }
}

int main(void)
{
    RUN(shapes_are_repeated_with_the_period);
    RUN(restitution_is_what_was_typed_on_bodies_that_give_way);
    return check_finish();
}
