/* SPDX-License-Identifier: BSD-3-Clause */
/* What rests and what rolls, in many methods: a box on an incline, in equilibrium, a billiard ball.
 */
#include "check.h"
#include "se3d/se3d.h"

#define G 9.81
#define K 1e5

typedef struct scene {
    se3d_system *system;
    se3d_body body;
    se3d_solver *solver;
} scene;

/* A box of .2 m and 2 kg (or a ball of that width) at r, turned about y, on a plane that leans. */
static scene begin(int ball, double slope, double mu, const double r[3], const double v[3])
{
    scene s = {0};
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    se3d_shape shape;
    CHECK(se3d_system_create(NULL, &s.system) == SE3D_OK);
    def.density = 250.0;
    def.friction = mu;
    def.restitution = 0.3;
    def.stiffness = K;
    CHECK(se3d_material_create(s.system, &def, &material) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = 2.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] =
        ball ? 0.4 * 2.0 * 0.01 : 2.0 * 0.04 / 6.0;
    memcpy(body.position, r, sizeof body.position);
    memcpy(body.velocity, v, sizeof body.velocity);
    body.orientation[0] = cos(0.5 * slope);
    body.orientation[2] = sin(0.5 * slope);
    CHECK(se3d_body_create(s.system, &body, &s.body) == SE3D_OK);
    se3d_shape_def solid = se3d_shape_def_default(), plane = solid;
    solid.body = s.body;
    solid.material = plane.material = material;
    solid.radius = 0.1;
    solid.size[0] = solid.size[1] = solid.size[2] = 0.2;
    plane.normal[0] = sin(slope);
    plane.normal[2] = cos(slope);
    CHECK((ball ? se3d_shape_create_sphere(s.system, &solid, &shape)
                : se3d_shape_create_box(s.system, &solid, &shape)) == SE3D_OK);
    CHECK(se3d_shape_create_plane(s.system, &plane, &shape) == SE3D_OK);
    return s;
}

static void run(scene *s, int32_t analysis, int32_t method, double t)
{
    if (!s->solver) {
        se3d_solver_def def = se3d_solver_def_default();
        def.analysis = analysis;
        def.method = method;
        CHECK(se3d_solver_create(s->system, &def, &s->solver) == SE3D_OK);
    }
    se3d_status status = se3d_solver_run(s->solver, t);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(s->system));
    }
}

static void end(scene *s)
{
    se3d_solver_destroy(s->solver);
    se3d_system_destroy(s->system);
}

static void a_box_stays_on_an_incline_in_every_method(void)
{
    const double slope = 20.0 * 3.14159265358979323846 / 180.0, none[3] = {0.0, 0.0, 0.0};
    const double height = 0.1 - 2.0 * G * cos(slope) / (4.0 * K);
    const double r[3] = {height * sin(slope), 0.0, height * cos(slope)};
    for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_VERLET; ++method) {
        double before[3], after[3];
        scene s = begin(0, slope, 0.5, r, none);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 3.0);
        CHECK(se3d_body_get_position(s.system, s.body, before) == SE3D_OK);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 5.0);
        CHECK(se3d_body_get_position(s.system, s.body, after) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(after[a], before[a], 1e-9);
            CHECK_NEAR(after[a], r[a], 2e-4); /* the friction springs */
        }
        end(&s);
    }
}

/* Sliding without rolling at first: 5/7 of the speed in the end. */
static void a_billiard_ball_rolls_with_five_sevenths_in_every_method(void)
{
    const double r[3] = {0.0, 0.0, 0.1 - 2.0 * G / K}, v0[3] = {1.0, 0.0, 0.0};
    const double arm = r[2] / 0.1;
    for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_VERLET; ++method) {
        double v[3], w[3];
        scene s = begin(1, 0.0, 0.3, r, v0);
        run(&s, SE3D_ANALYSIS_DYNAMICS, method, 0.5);
        CHECK(se3d_body_get_velocity(s.system, s.body, v) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, s.body, w) == SE3D_OK);
        CHECK_NEAR(v[0], 1.0 / (1.0 + 0.4 / (arm * arm)), 2e-4);
        CHECK_NEAR(v[0], w[1] * r[2], 5e-4); /* the spring swings still */
        end(&s);
    }
}

/* Equilibrium finds the overlap that carries the weight. */
static void equilibrium_of_a_ball_finds_the_overlap(void)
{
    const double r[3] = {0.0, 0.0, 0.0999}, none[3] = {0.0, 0.0, 0.0};
    double at[3], force[3], torque[3];
    scene s = begin(1, 0.0, 0.5, r, none);
    run(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO, 0.0);
    CHECK(se3d_body_get_position(s.system, s.body, at) == SE3D_OK);
    CHECK(se3d_body_get_contact_wrench(s.system, s.body, force, torque) == SE3D_OK);
    CHECK_NEAR(at[2], 0.1 - 2.0 * G / K, 1e-9);
    CHECK_NEAR(force[2], 2.0 * G, 1e-6);
    end(&s);
}

static void equilibrium_of_a_box_finds_the_overlap(void)
{
    const double r[3] = {0.0, 0.0, 0.0999}, none[3] = {0.0, 0.0, 0.0};
    double at[3];
    scene s = begin(0, 0.0, 0.5, r, none);
    run(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO, 0.0);
    CHECK(se3d_body_get_position(s.system, s.body, at) == SE3D_OK);
    CHECK_NEAR(at[2], 0.1 - 2.0 * G / (4.0 * K), 1e-9);
    end(&s);
}

int main(void)
{
    RUN(a_box_stays_on_an_incline_in_every_method);
    RUN(a_billiard_ball_rolls_with_five_sevenths_in_every_method);
    RUN(equilibrium_of_a_ball_finds_the_overlap);
    RUN(equilibrium_of_a_box_finds_the_overlap);
    return check_finish();
}
