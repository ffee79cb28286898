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

static void the_load_is_that_of_the_middle_of_a_step(void)
{
    const double h = 1e-5;
    press p;
    open_press(&p, 3, SE3D_CONTACT_LAW_HOOKE);
    p.def.function = function_of(&p, "500*t");
    add_lid(&p, 6.0 * R + 0.005);
    CHECK(!se3d_particles_set_step(p.b.particles, h));
    for (int k = 1; k <= 3; ++k) {
        run(&p, 20.0 * h * k);
        CHECK_NEAR(get(&p).wanted, 500.0 * (20.0 * k - 0.5) * h, 1e-12);
    }
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

/* A lid on a body that a driver tilts about x. */
static se3d_solver *open_tilting(press *p)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def hinge = se3d_joint_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_solver_def method = se3d_solver_def_default();
    se3d_solver *solver;
    se3d_constraint motion;
    open_press(p, 1, SE3D_CONTACT_LAW_HOOKE);
    body.position[2] = 2.0 * R;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_body_create(p->b.system, &body, &shape.body));
    shape.material = p->b.material;
    shape.normal[2] = -1.0;
    CHECK(!se3d_shape_create_plane(p->b.system, &shape, &p->def.shape));
    CHECK(!se3d_system_get_ground(p->b.system, &hinge.body_i));
    hinge.body_j = shape.body;
    hinge.point_i[2] = 2.0 * R;
    hinge.axis_i[0] = hinge.axis_j[0] = 1.0;
    hinge.axis_i[2] = hinge.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_revolute(p->b.system, &hinge, &driver.joint));
    driver.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    driver.function = function_of(p, "20*t");
    CHECK(!se3d_driver_create(p->b.system, &driver, &motion));
    p->def.load = 1.5;
    CHECK(!se3d_particles_add_servo(p->b.particles, &p->def, &p->servo));
    method.method = SE3D_METHOD_VERLET;
    CHECK(!se3d_solver_create(p->b.system, &method, &solver));
    return solver;
}

/* Read into another system, whose bodies are elsewhere, a servo has the force along its axis. */
static void snapshots_hold_the_axis_of_a_servo(void)
{
    press p, q;
    unsigned char bytes[20000];
    size_t size = 0;
    se3d_snapshot *snapshot = NULL;
    se3d_solver *solver = open_tilting(&p), *other = open_tilting(&q);
    CHECK(se3d_solver_run(solver, 0.01) >= 0);
    CHECK(!se3d_snapshot_create(p.b.system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, bytes, sizeof bytes, &size) && size <= sizeof bytes);
    se3d_snapshot_destroy(snapshot);
    CHECK(!se3d_snapshot_read(q.b.system, bytes, size, &snapshot));
    CHECK(!se3d_snapshot_restore(snapshot, q.b.system));
    CHECK(get(&p).force > 0.1);
    CHECK_NEAR(get(&q).force, get(&p).force, 0.0);
    CHECK_NEAR(get(&q).work, get(&p).work, 0.0);
    se3d_snapshot_destroy(snapshot);
    se3d_solver_destroy(solver);
    se3d_solver_destroy(other);
    bed_close(&p.b);
    bed_close(&q.b);
}

/* The same shapes and as many servos, but on other ones, or along another axis. */
static void snapshots_of_other_servos_are_refused(void)
{
    size_t size = 0;
    unsigned char bytes[20000];
    for (int k = 0; k < 4; ++k) {
        static const double high[3] = {0.0, 0.0, 2.0 * R}, down[3] = {0.0, 0.0, -1.0};
        press p;
        se3d_snapshot *snapshot = NULL;
        open_press(&p, 1, SE3D_CONTACT_LAW_HOOKE);
        const se3d_shape low = bed_add_plane(&p.b, high, down);
        p.def.shape = bed_add_plane(&p.b, high, down);
        p.def.shape = k == 1 ? low : p.def.shape;
        p.def.axis[1] = k == 2 ? 0.1 : 0.0;
        p.def.load = k == 3 ? 2.0 : 1.0; /* that is no more than a number */
        CHECK(!se3d_particles_add_servo(p.b.particles, &p.def, &p.servo));
        if (k == 0) {
            CHECK(!se3d_snapshot_create(p.b.system, &snapshot));
            CHECK(!se3d_snapshot_write(snapshot, bytes, sizeof bytes, &size));
        } else {
            CHECK(se3d_snapshot_read(p.b.system, bytes, size, &snapshot) ==
                  (k == 3 ? SE3D_OK : SE3D_ERR_STATE));
        }
        se3d_snapshot_destroy(snapshot);
        bed_close(&p.b);
    }
}

/* The lid stops where it is when the last particle goes. */
static void lid_of_an_emptied_set_rests(void)
{
    static const uint32_t ids[2] = {0, 1};
    press p;
    open_press(&p, 2, SE3D_CONTACT_LAW_HOOKE);
    p.def.load = 3.0;
    add_lid(&p, 4.0 * R);
    run(&p, 0.002);
    const se3d_servo_state before = get(&p);
    CHECK(before.speed > 1e-3 && before.force > 0.1);
    CHECK(!se3d_particles_remove(p.b.particles, 2, ids));
    for (int k = 0; k < 2; ++k) {
        CHECK_NEAR(get(&p).speed, 0.0, 0.0);
        CHECK_NEAR(get(&p).force, 0.0, 0.0);
        CHECK_NEAR(get(&p).position, before.position, 0.0);
        CHECK_NEAR(get(&p).work, before.work, 1e-15);
        run(&p, 0.01);
    }
    bed_close(&p.b);
}

static se3d_status push_back(void *ctx, const se3d_contact_input *input, se3d_contact_output *out)
{
    (void)ctx;
    out->force = 1e4 * input->overlap;
    return SE3D_OK;
}

/* Nothing tells how stiff a law of the user's own is. */
static void own_laws_need_a_gain(void)
{
    for (int k = 0; k < 2; ++k) {
        press p;
        se3d_contact_settings law = se3d_contact_settings_default();
        open_press(&p, 1, SE3D_CONTACT_LAW_HOOKE);
        law.law = SE3D_CONTACT_LAW_CALLBACK;
        law.callback = push_back;
        law.step = 1e-5;
        CHECK(!se3d_system_set_contact(p.b.system, &law));
        p.def.gain = k == 0 ? 0.0 : 1e-2;
        p.def.load = 1.0;
        add_lid(&p, 2.0 * R);
        CHECK(se3d_particles_run(p.b.particles, 1e-3) == (k == 0 ? SE3D_ERR_UNSUPPORTED : SE3D_OK));
        if (k == 0) {
            CHECK_CONTAINS(se3d_system_get_error(p.b.system), "servo wall 0 has no gain");
        }
        bed_close(&p.b);
    }
}

/* Bonds are stiffer than contacts by far: the lid must not jump over what it is to press with. */
static void bonds_count_for_the_gain(void)
{
    static const double none[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
    press p;
    se3d_bond_def bond = se3d_bond_def_default();
    size_t added = 0;
    open_press(&p, 1, SE3D_CONTACT_LAW_HOOKE);
    bond.law = SE3D_BOND_LAW_PARALLEL;
    bond.normal_stiffness = bond.shear_stiffness = 3e10;
    bond.damping = 0.3;
    bond.gap = 1e-6;
    p.def.load = -2.0;
    add_lid(&p, 2.0 * R);
    const se3d_shape floor = bed_add_plane(&p.b, none, up);
    CHECK(!se3d_particles_bond_shape(p.b.particles, &bond, p.def.shape, -1, &added, NULL));
    CHECK(!se3d_particles_bond_shape(p.b.particles, &bond, floor, -1, &added, NULL) && added == 1);
    for (int k = 1; k <= 40; ++k) {
        run(&p, 0.0002 * k);
        CHECK(get(&p).force > -2.2 && get(&p).force < 0.2);
    }
    CHECK_NEAR(get(&p).force, -2.0, 1e-3);
    bed_close(&p.b);
}

int main(void)
{
    RUN(row_is_pressed_as_wanted_and_stores_the_work);
    RUN(lid_comes_at_its_speed_and_follows_its_load);
    RUN(the_load_is_that_of_the_middle_of_a_step);
    RUN(walls_of_a_body_that_moves_keep_their_force);
    RUN(snapshots_hold_the_axis_of_a_servo);
    RUN(snapshots_of_other_servos_are_refused);
    RUN(lid_of_an_emptied_set_rests);
    RUN(own_laws_need_a_gain);
    RUN(bonds_count_for_the_gain);
    return check_finish();
}
