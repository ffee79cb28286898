/* SPDX-License-Identifier: BSD-3-Clause */
/* Cohesion between bodies: the same law as between particles, and its energy. */
#include "check.h"
#include "se3d/se3d.h"

#define R    0.01
#define MASS 0.02

typedef struct couple {
    se3d_system *system;
    se3d_body ball;
    se3d_solver *solver;
} couple;

/* A ball whose lowest point is at z above a plane, without gravity. */
static couple begin(int32_t law, double cohesion, double adhesion, double e, double z, double v)
{
    couple c = {0};
    const double none[3] = {0.0, 0.0, 0.0};
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    se3d_shape shape;
    CHECK(se3d_system_create(NULL, &c.system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(c.system, none) == SE3D_OK);
    contact.law = law;
    CHECK(se3d_system_set_contact(c.system, &contact) == SE3D_OK);
    def.density = 1000.0;
    def.restitution = e;
    def.stiffness = 1e5;
    def.young = 1e8;
    def.cohesion = cohesion;
    def.adhesion = adhesion;
    CHECK(se3d_material_create(c.system, &def, &material) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = MASS;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.4 * MASS * R * R;
    body.position[2] = R + z;
    body.velocity[2] = v;
    CHECK(se3d_body_create(c.system, &body, &c.ball) == SE3D_OK);
    se3d_shape_def sphere = se3d_shape_def_default(), plane = sphere;
    sphere.body = c.ball;
    sphere.material = plane.material = material;
    sphere.radius = R;
    CHECK(se3d_shape_create_sphere(c.system, &sphere, &shape) == SE3D_OK);
    CHECK(se3d_shape_create_plane(c.system, &plane, &shape) == SE3D_OK);
    return c;
}

static void solve(couple *c, int32_t analysis, int32_t method, double tolerance)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.method = method;
    def.tolerance = tolerance;
    CHECK(se3d_solver_create(c->system, &def, &c->solver) == SE3D_OK);
}

static void end(couple *c)
{
    se3d_solver_destroy(c->solver);
    se3d_system_destroy(c->system);
}

/* E = kn s delta of the two laws for young 1e8, poisson .3 on itself. */
static double elastic(int32_t law, double delta)
{
    double stiffness = 4.0 / 3.0 * 1e8 / (2.0 * (1.0 - 0.09));
    return law == SE3D_CONTACT_LAW_HOOKE ? 1e5 * delta : stiffness * sqrt(R * delta) * delta;
}

static double force_at(int32_t law, double cohesion, double adhesion, double delta)
{
    couple c = begin(law, cohesion, adhesion, 0.5, -delta, 0.0);
    double force[3], torque[3];
    solve(&c, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, 1e-6);
    CHECK(se3d_solver_run(c.solver, 0.0) >= 0); /* the state as it is */
    CHECK(se3d_solver_step(c.solver, 1e-12) >= 0);
    CHECK(se3d_body_get_contact_wrench(c.system, c.ball, force, torque) == SE3D_OK);
    end(&c);
    return force[2];
}

static void attraction_is_that_of_particles(void)
{
    const double pi = 3.14159265358979323846;
    for (int32_t law = 0; law < 2; ++law) {
        for (int k = 1; k < 6; ++k) {
            double delta = 2e-5 * k, E = elastic(law, delta);
            double area = 2.0 * pi * R * delta, pull = 1.5 * pi * 50.0 * R;
            CHECK_NEAR(force_at(law, 3e6, 0.0, delta), E - 3e6 * area, 1e-6 * E);
            CHECK_NEAR(force_at(law, 0.0, 50.0, delta), E - 2.0 * sqrt(pull * E), 1e-6 * E);
        }
    }
}

/* What is needed to part: a ball that leaves too slowly stays; the work is that of the law. */
static void parting_takes_the_work_of_the_law(void)
{
    static const int32_t methods[3] = {SE3D_METHOD_DOP853, SE3D_METHOD_VERLET,
                                       SE3D_METHOD_GENERALIZED_ALPHA};
    for (int k = 0; k < 12; ++k) {
        int32_t law = k & 1, fast = k >> 1 & 1;
        double pull = 1.5 * 3.14159265358979323846 * 50.0 * R, delta = 1e-6;
        for (int step = 0; step < 100; ++step) { /* at rest: E = 4 Fc */
            delta *= pow(4.0 * pull / elastic(law, delta), law ? 2.0 / 3.0 : 1.0);
        }
        double work = law ? 6.0 / 35.0 / sqrt(R) * elastic(law, delta) * sqrt(R) * delta
                          : elastic(law, delta) * delta / 6.0;
        double v0 = sqrt(2.0 * work / MASS) * (fast ? 1.2 : 0.9), v[3];
        couple c = begin(law, 0.0, 50.0, 1.0, -delta, v0);
        se3d_energy before, after;
        solve(&c, SE3D_ANALYSIS_DYNAMICS, methods[k / 4], k / 4 ? 0.0 : 1e-9);
        CHECK(se3d_solver_run(c.solver, 0.0) >= 0);
        CHECK(se3d_system_get_energy(c.system, &before) == SE3D_OK);
        CHECK(se3d_solver_run(c.solver, 0.02) >= 0);
        CHECK(se3d_system_get_energy(c.system, &after) == SE3D_OK);
        CHECK(se3d_body_get_velocity(c.system, c.ball, v) == SE3D_OK);
        CHECK((se3d_system_count_contacts(c.system) == 0) == (fast == 1));
        double left = sqrt(fmax(0.0, v0 * v0 - 2.0 * work / MASS));
        CHECK(!fast || fabs(v[2] - left) < 2e-3 * v0);
        CHECK_NEAR(after.total + after.dissipated, before.total, 4e-3 * work);
        end(&c);
    }
}

/* Friction is capped by the repulsion: a ball that sticks can be carried by adhesion alone. */
static void a_ball_hangs_where_it_sticks(void)
{
    static const int32_t methods[4] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_RADAU,
                                       SE3D_METHOD_BDF, SE3D_METHOD_VERLET};
    for (int k = 0; k < 4; ++k) {
        const double up[3] = {0.3, 0.0, 9.81};
        double r[3], force[3], torque[3];
        couple c = begin(SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.0, 50.0, 0.3, -2e-5, 0.0);
        CHECK(se3d_system_set_gravity(c.system, up) == SE3D_OK);
        solve(&c, SE3D_ANALYSIS_DYNAMICS, methods[k], 0.0);
        CHECK(se3d_solver_run(c.solver, 0.5) >= 0);
        CHECK(se3d_body_get_position(c.system, c.ball, r) == SE3D_OK);
        CHECK(r[2] < R);
        CHECK(se3d_body_get_contact_wrench(c.system, c.ball, force, torque) == SE3D_OK);
        CHECK_NEAR(force[2], -MASS * 9.81, 1e-3 * MASS * 9.81);
        end(&c);
    }
}

int main(void)
{
    RUN(attraction_is_that_of_particles);
    RUN(parting_takes_the_work_of_the_law);
    RUN(a_ball_hangs_where_it_sticks);
    return check_finish();
}
