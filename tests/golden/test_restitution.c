/* SPDX-License-Identifier: BSD-3-Clause */
/* The given restitution is the restitution obtained: every method at its own step and tolerance,
 * both laws, slow and fast, shapes on a plane and on each other, in one point of contact or in
 * many. Closed form: central impacts. The bound is 1e-3. */
#include "check.h"
#include "se3d/se3d.h"

enum { SPHERE, BOX, CAPSULE, CYLINDER, CAPSULE_SIDE, CYLINDER_SIDE, KINDS };

typedef struct impact {
    int32_t method, law;
    int kind, pair;
    double e, speed;
} impact;

static se3d_body add(se3d_system *system, se3d_material material, int kind, double z, double v)
{
    se3d_body_def def = se3d_body_def_default();
    se3d_shape_def shape_def = se3d_shape_def_default();
    se3d_body body;
    se3d_shape shape;
    def.mass = 0.5;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 5e-4;
    def.position[2] = z;
    def.velocity[2] = v;
    if (kind >= CAPSULE_SIDE) {
        def.orientation[0] = def.orientation[1] = sqrt(0.5);
    }
    CHECK(se3d_body_create(system, &def, &body) == SE3D_OK);
    shape_def.body = body;
    shape_def.material = material;
    shape_def.radius = 0.05;
    shape_def.length = shape_def.size[0] = shape_def.size[1] = shape_def.size[2] = 0.1;
    int capsule = kind == CAPSULE || kind == CAPSULE_SIDE;
    CHECK((kind == SPHERE ? se3d_shape_create_sphere(system, &shape_def, &shape)
           : kind == BOX  ? se3d_shape_create_box(system, &shape_def, &shape)
           : capsule      ? se3d_shape_create_capsule(system, &shape_def, &shape)
                          : se3d_shape_create_cylinder(system, &shape_def, &shape)) == SE3D_OK);
    return body;
}

/* The relative speed after a central impact over that before. */
static double obtained(const impact *m)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    const double none[3] = {0.0, 0.0, 0.0};
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(system, none) == SE3D_OK);
    contact.law = m->law;
    CHECK(se3d_system_set_contact(system, &contact) == SE3D_OK);
    def.density = 1000.0;
    def.restitution = m->e;
    def.stiffness = 2e6;
    def.young = 2e8;
    CHECK(se3d_material_create(system, &def, &material) == SE3D_OK);
    double half = m->kind == CAPSULE ? 0.1 : 0.05;
    double flight = 0.01 * (1.0 + 0.37 * m->e);
    double z = half + flight * m->speed + (m->pair ? half : 0.0);
    se3d_body falling = add(system, material, m->kind, z, -m->speed), other = {0};
    if (m->pair) {
        other = add(system, material, m->kind, 0.0, 0.0);
    } else {
        se3d_shape_def plane = se3d_shape_def_default();
        se3d_shape shape;
        plane.material = material;
        CHECK(se3d_shape_create_plane(system, &plane, &shape) == SE3D_OK);
    }
    se3d_solver_def solver_def = se3d_solver_def_default();
    solver_def.method = m->method;
    CHECK(se3d_solver_create(system, &solver_def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, flight + 0.03) >= 0);
    double v[3], u[3] = {0.0, 0.0, 0.0};
    CHECK(se3d_body_get_velocity(system, falling, v) == SE3D_OK);
    CHECK(!m->pair || se3d_body_get_velocity(system, other, u) == SE3D_OK);
    CHECK(!m->pair || fabs(v[2] + u[2] + m->speed) < 1e-9 * m->speed); /* momentum */
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return (v[2] - u[2]) / m->speed;
}

static void check_method(int32_t method)
{
    const int stride = check_is_long() ? 1 : 5; /* each value of each, not all pairs */
    for (int k = method % stride; k < 8 * KINDS * 4; k += stride) {
        impact m = {.method = method,
                    .law = k & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                    .pair = k >> 1 & 1,
                    .speed = k >> 2 & 1 ? 10.0 : 0.1,
                    .kind = (k >> 3) % KINDS,
                    .e = 0.3 + 0.2 * ((k >> 3) / KINDS)};
        CHECK_NEAR(obtained(&m), m.e, 1e-3);
    }
}

static void explicit_methods_give_the_restitution_typed(void)
{
    check_method(SE3D_METHOD_VERLET);
    check_method(SE3D_METHOD_RATTLE);
    check_method(SE3D_METHOD_DOP853);
    check_method(SE3D_METHOD_RK45);
}

static void implicit_methods_give_the_restitution_typed(void)
{
    check_method(SE3D_METHOD_GENERALIZED_ALPHA);
    check_method(SE3D_METHOD_HHT);
    check_method(SE3D_METHOD_BDF);
    check_method(SE3D_METHOD_RADAU);
}

/* A ball of 2 cm at 100 m/s towards a plate of 1 mm that hangs in the air. */
static se3d_status shoot(int32_t method, double step, double *left, char *message)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_material_def def = se3d_material_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material material;
    se3d_shape shape;
    const double none[3] = {0.0, 0.0, 0.0};
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(system, none) == SE3D_OK);
    contact.overlap_limit = 0.9;
    CHECK(se3d_system_set_contact(system, &contact) == SE3D_OK);
    def.density = 1000.0;
    def.stiffness = 1e10;
    def.restitution = 0.8;
    CHECK(se3d_material_create(system, &def, &material) == SE3D_OK);
    se3d_body_def ball = se3d_body_def_default();
    se3d_body body;
    ball.mass = 0.03;
    ball.inertia[0] = ball.inertia[1] = ball.inertia[2] = 4.8e-6;
    ball.position[2] = 3.0;
    ball.velocity[2] = -100.0;
    CHECK(se3d_body_create(system, &ball, &body) == SE3D_OK);
    se3d_shape_def sphere = se3d_shape_def_default(), plate = sphere;
    sphere.name = "ball";
    sphere.body = body;
    sphere.material = plate.material = material;
    sphere.radius = 0.02;
    plate.name = "plate";
    plate.size[0] = plate.size[1] = 1.0;
    plate.size[2] = 1e-3;
    CHECK(se3d_shape_create_sphere(system, &sphere, &shape) == SE3D_OK);
    CHECK(se3d_shape_create_box(system, &plate, &shape) == SE3D_OK);
    se3d_solver_def solver_def = se3d_solver_def_default();
    solver_def.method = method;
    solver_def.step = step;
    CHECK(se3d_solver_create(system, &solver_def, &solver) == SE3D_OK);
    se3d_status status = se3d_solver_run(solver, 0.06);
    double v[3];
    CHECK(se3d_body_get_velocity(system, body, v) == SE3D_OK);
    *left = v[2];
    snprintf(message, 200, "%s", se3d_system_get_error(system));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return status;
}

static void fast_balls_do_not_pass_through_thin_plates(void)
{
    char message[200];
    double v;
    for (int32_t method = SE3D_METHOD_AUTO; method <= SE3D_METHOD_VERLET; ++method) {
        CHECK(shoot(method, 0.0, &v, message) >= 0);
        CHECK_NEAR(v, 80.0, 0.1);
    }
    static const int32_t fixed[4] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT,
                                     SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};
    for (int k = 0; k < 4; ++k) {
        CHECK(shoot(fixed[k], 7e-4, &v, message) == SE3D_ERR_STEP_SIZE);
        CHECK_NEAR(v, -100.0, 1e-9);
        CHECK_CONTAINS(message, "ball");
        CHECK_CONTAINS(message, "plate");
        CHECK_CONTAINS(message, "0.029");
    }
}

int main(void)
{
    RUN(fast_balls_do_not_pass_through_thin_plates);
    RUN(explicit_methods_give_the_restitution_typed);
    RUN(implicit_methods_give_the_restitution_typed);
    return check_finish();
}
