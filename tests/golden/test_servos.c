/* SPDX-License-Identifier: BSD-3-Clause */
/* Servo walls press particles as wanted: planes, boxes and meshes, of the ground and of bodies.
 * Spheres in a row between a floor and a servo wall are springs in a row. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>

#define R 0.01

typedef struct press {
    bed b;
    se3d_servo_def def;
    uint32_t servo;
    size_t count;
} press;

/* The floor z = 0 and `count` spheres on it, one above the other, that just touch. */
static void open_press(press *p, size_t count, int32_t law)
{
    static const double none[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
    se3d_material_def stuff = se3d_material_def_default();
    p->def = se3d_servo_def_default();
    p->count = count;
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    stuff.young = 1e7;
    stuff.restitution = 0.3;
    bed_open(&p->b, law, none, NULL, &stuff);
    bed_add_plane(&p->b, none, up);
    for (size_t k = 0; k < count; ++k) {
        const double r[3] = {0.0, 0.0, R * (2.0 * (double)k + 1.0)};
        bed_add(&p->b, r, R, NULL, NULL);
    }
    p->def.axis[2] = -2.0;
    p->def.speed_max = 0.05;
}

static se3d_function function_of(const press *p, const char *text)
{
    se3d_function function;
    CHECK(!se3d_function_create_expression(p->b.system, text, &function));
    return function;
}

/* A plane that looks down at height z. */
static void add_lid(press *p, double z)
{
    const double at[3] = {0.0, 0.0, z}, down[3] = {0.0, 0.0, -1.0};
    p->def.shape = bed_add_plane(&p->b, at, down);
    CHECK(!se3d_particles_add_servo(p->b.particles, &p->def, &p->servo));
}

static void run(press *p, double t)
{
    const se3d_status status = se3d_particles_run(p->b.particles, t);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(p->b.system));
    }
    CHECK(status >= 0);
}

static se3d_servo_state get(const press *p)
{
    se3d_servo_state state;
    CHECK(!se3d_particles_get_servo(p->b.particles, p->servo, &state));
    return state;
}

/* The sum of the overlaps of a row with the floor at 0 and a lid at z. */
static double overlaps(const press *p, double lid)
{
    double z[30], sum;
    CHECK(!se3d_particles_get_all(p->b.particles, p->count, z, NULL, NULL));
    sum = R - z[2] + z[3 * p->count - 1] + R - lid;
    for (size_t k = 1; k < p->count; ++k) {
        sum += 2.0 * R - (z[3 * k + 2] - z[3 * k - 1]);
    }
    return sum;
}

/* A row is pressed slowly: the force is what is wanted, the work what springs in a row hold. */
static void row_is_pressed_as_wanted_and_stores_the_work(void)
{
    static const int32_t laws[2] = {SE3D_CONTACT_LAW_HOOKE, SE3D_CONTACT_LAW_HERTZ_MINDLIN};
    static const double stored[2] = {0.5, 0.4};
    for (int k = 0; k < 2; ++k) {
        press p;
        se3d_function ramp;
        open_press(&p, 4, laws[k]);
        ramp = function_of(&p, "2*step(t, 0, 0, 0.4, 1)");
        p.def.function = ramp;
        add_lid(&p, 8.0 * R);
        run(&p, 0.45);
        const se3d_servo_state s = get(&p);
        CHECK_NEAR(s.wanted, 2.0, 1e-12);
        CHECK_NEAR(s.force, 2.0, 1e-3);
        CHECK_NEAR(s.speed, 0.0, 1e-4);
        const double give = overlaps(&p, 8.0 * R - s.position);
        CHECK(give > 1e-4);
        CHECK_NEAR(s.position / give, 1.0, 1e-9);
        CHECK_NEAR(s.work / (stored[k] * s.force * give), 1.005, 5e-3);
        bed_close(&p.b);
    }
}

/* It comes at its largest speed, then has the stress, and lets go if it is to. */
static void lid_comes_at_its_speed_and_follows_its_load(void)
{
    press p;
    open_press(&p, 3, SE3D_CONTACT_LAW_HOOKE);
    p.def.area = 0.02;
    p.def.start = 0.01;
    p.def.function = function_of(&p, "100 - 130*step(t, 0.5, 0, 0.51, 1)");
    add_lid(&p, 6.0 * R + 0.005);
    run(&p, 0.01);
    CHECK_NEAR(get(&p).position, 0.0, 0.0);
    run(&p, 0.06);
    CHECK_NEAR(get(&p).position, 0.05 * 0.05, 1e-5);
    CHECK_NEAR(get(&p).force, 0.0, 0.0);
    run(&p, 0.5);
    CHECK_NEAR(get(&p).force, 100.0 * 0.02, 1e-5);
    const double pressed = get(&p).position;
    run(&p, 0.6);
    CHECK_NEAR(get(&p).force, 0.0, 1e-12); /* pulling finds nothing to hold */
    CHECK(get(&p).speed < -0.01 && get(&p).position < pressed - 0.001);
    bed_close(&p.b);
}

static void make_box(press *p, se3d_shape_def *def)
{
    def->size[0] = def->size[1] = 0.05;
    def->size[2] = 0.02;
    def->position[2] += 0.01;
    CHECK(!se3d_shape_create_box(p->b.system, def, &p->def.shape));
}

/* Two triangles that look down. */
static void make_mesh(press *p, se3d_shape_def *def)
{
    static const double corners[12] = {-0.03, -0.03, 0.0, 0.04,  -0.03, 0.0,
                                       0.04,  0.03,  0.0, -0.03, 0.03,  0.0};
    static const uint32_t triangles[6] = {0, 2, 1, 0, 3, 2};
    def->vertices = corners;
    def->vertex_count = 4;
    def->triangles = triangles;
    def->triangle_count = 2;
    CHECK(!se3d_shape_create_mesh(p->b.system, def, &p->def.shape));
}

/* The shape is on a body that a driver moves: the wall goes back on it and keeps the force. */
static void walls_of_a_body_that_moves_keep_their_force(void)
{
    for (int mesh = 0; mesh < 2; ++mesh) {
        press p;
        se3d_body_def body = se3d_body_def_default();
        se3d_joint_def slide = se3d_joint_def_default();
        se3d_driver_def driver = se3d_driver_def_default();
        se3d_shape_def shape = se3d_shape_def_default();
        se3d_solver_def method = se3d_solver_def_default();
        se3d_solver *solver;
        se3d_constraint joint, motion;
        open_press(&p, 2, SE3D_CONTACT_LAW_HOOKE);
        body.position[2] = 4.0 * R;
        body.mass = 1.0;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        CHECK(!se3d_body_create(p.b.system, &body, &shape.body));
        shape.material = p.b.material;
        if (mesh) {
            make_mesh(&p, &shape);
        } else {
            make_box(&p, &shape);
        }
        CHECK(!se3d_system_get_ground(p.b.system, &slide.body_i));
        slide.body_j = shape.body;
        slide.point_i[2] = 4.0 * R;
        CHECK(!se3d_joint_create_prismatic(p.b.system, &slide, &joint));
        driver.joint = joint;
        driver.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
        driver.function = function_of(&p, "0.001*sin(4*t)");
        CHECK(!se3d_driver_create(p.b.system, &driver, &motion));
        p.def.load = 1.5;
        p.def.speed_max = 0.5;
        CHECK(!se3d_particles_add_servo(p.b.particles, &p.def, &p.servo));
        method.method = SE3D_METHOD_VERLET;
        CHECK(!se3d_solver_create(p.b.system, &method, &solver));
        for (int k = 1; k <= 8; ++k) {
            double force[3], torque[3], at[3];
            CHECK(se3d_solver_run(solver, 0.05 + 0.1 * k) >= 0);
            CHECK(!se3d_body_get_position(p.b.system, shape.body, at));
            CHECK_NEAR(get(&p).force, 1.5, 0.15); /* the wall goes at up to 4 mm/s */
            CHECK(!se3d_body_get_contact_wrench(p.b.system, shape.body, force, torque));
            CHECK_NEAR(force[2], get(&p).force, 1e-12);
            CHECK_NEAR(overlaps(&p, at[2] - get(&p).position), 3e-4 * force[2], 3e-5);
        }
        se3d_solver_destroy(solver);
        bed_close(&p.b);
    }
}

int main(void)
{
    RUN(row_is_pressed_as_wanted_and_stores_the_work);
    RUN(lid_comes_at_its_speed_and_follows_its_load);
    RUN(walls_of_a_body_that_moves_keep_their_force);
    return check_finish();
}
