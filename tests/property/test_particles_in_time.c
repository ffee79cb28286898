/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles and bodies stay at one time, whatever ends a run of verlet. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/text_model.h"

#define STEP 1e-4
#define TIME 0.005

static long asked, ends_at;

static int32_t is_over(void *ctx)
{
    (void)ctx;
    return ++asked == ends_at;
}

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    se3d_particles *particles;
} world;

/* A bar on a pin, pulled by an actuator, and a particle that flies at 1 m/s without a contact. */
static void make(world *w, const char *actuator)
{
    static const char *const variables[] = {"t", "l", "ldot"};
    const double at[3] = {5.0, 0.0, 0.0}, v[3] = {1.0, 0.0, 0.0}, radius = 0.02;
    se3d_body ground, bar;
    se3d_constraint pin;
    se3d_force pull;
    se3d_material stone;
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &ground));
    se3d_body_def body = se3d_body_def_default();
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.position[0] = 0.5;
    CHECK(!se3d_body_create(w->system, &body, &bar));
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = ground;
    joint.body_j = bar;
    joint.point_j[0] = -0.5;
    joint.axis_i[1] = joint.axis_j[1] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_revolute(w->system, &joint, &pin));
    se3d_tsda_def tsda = se3d_tsda_def_default();
    se3d_function_def function = se3d_function_def_default();
    tsda.body_i = ground;
    tsda.body_j = bar;
    tsda.point_i[2] = 1.0;
    function.expression = actuator;
    function.variables = variables;
    function.variable_count = 3;
    CHECK(!se3d_function_create(w->system, &function, &tsda.h));
    CHECK(!se3d_force_create_tsda(w->system, &tsda, &pull));
    se3d_material_def material = se3d_material_def_default();
    material.density = 2500.0;
    material.stiffness = 1e4;
    CHECK(!se3d_material_create(w->system, &material, &stone));
    se3d_particles_def set = se3d_particles_def_default();
    CHECK(!se3d_particles_create(w->system, &set, &w->particles));
    CHECK(!se3d_particles_add(w->particles, stone, 1, at, &radius, v, NULL, NULL));
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_VERLET;
    def.step = STEP;
    def.interrupt = is_over;
    asked = ends_at = 0;
    CHECK(!se3d_solver_create(w->system, &def, &w->solver));
}

static void destroy(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_particles_destroy(w->particles);
    se3d_system_destroy(w->system);
}

/* The particle is where it flies to in the time of the system. */
static void check_time(const world *w)
{
    double time, own, x[3], v[3], spin[3];
    CHECK(!se3d_system_get_time(w->system, &time));
    CHECK(!se3d_particles_get_time(w->particles, &own));
    CHECK(!se3d_particles_get_all(w->particles, 1, x, v, spin));
    CHECK(time == own);
    CHECK_NEAR(x[0] - 5.0, time, 1e-12);
    CHECK_NEAR(v[2], -9.81 * time, 1e-12);
}

static void interrupted_at_any_question_they_are_at_one_time(void)
{
    long count = 1;
    for (long k = 0; k < count; k += 1 + count / 60) {
        world w;
        make(&w, "0.1*sqrt(1 - t)");
        ends_at = k;
        const se3d_status status = se3d_solver_run(w.solver, TIME);
        CHECK(status == (k > 0 ? SE3D_ERR_INTERRUPTED : SE3D_OK));
        count = k > 0 ? count : asked;
        check_time(&w);
        ends_at = 0;
        CHECK(!se3d_solver_run(w.solver, TIME));
        check_time(&w);
        destroy(&w);
    }
    CHECK(count > 50);
}

static void stopped_by_a_formula_they_are_at_one_time(void)
{
    static const char *const actuators[] = {"sqrt(0.00305-t)", "1/(0.0031-t)^2*sqrt(0.0031-t)",
                                            "log(0.00235-t)"};
    for (size_t k = 0; k < sizeof actuators / sizeof *actuators; ++k) {
        world w;
        double time;
        make(&w, actuators[k]);
        CHECK(se3d_solver_run(w.solver, TIME) == SE3D_ERR_NOT_FINITE);
        CHECK(!se3d_system_get_time(w.system, &time));
        CHECK(time > 0.002);
        check_time(&w);
        destroy(&w);
    }
}

/* A linkage whose friction raises its own load without end: mu above 1 on a rod at 45 degrees. */
static const char jamming[] =
    "se3d: 1\nbodies:\n"
    "  - {name: block, mass: 1, inertia: [1, 1, 1]}\n"
    "  - {name: rod, mass: 1, inertia: [0.1, 0.1, 0.1], position: [-0.5, 0, 0.5]}\n"
    "  - {name: push, mass: 1, inertia: [1, 1, 1], position: [-1, 0, 1]}\n"
    "joints:\n"
    "  - {name: x, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, "
    "0]}\n"
    "  - {name: a, type: revolute, body_i: block, body_j: rod, at: [0, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: b, type: spherical, body_i: rod, body_j: push, at: [-1, 0, 1]}\n"
    "  - {name: z, type: prismatic, body_i: ground, body_j: push, at: [-1, 0, 1], axis: [0, 0, "
    "1]}\n"
    "drivers: [{name: m, joint: z, value: \"-0.1*t\"}]\n"
    "forces: [{name: f, type: friction, joint: x, mu: 1.2},\n"
    "  {type: force, body: block, value: [-7, 0, 0]}]\n"
    "analysis: {type: dynamics, duration: 1, method: verlet}\n";

static void stopped_by_friction_that_jams_they_are_at_one_time(void)
{
    text_model m = text_model_open(jamming, -1, -1, 1e-3);
    const double at[3] = {5.0, 0.0, 0.0}, v[3] = {1.0, 0.0, 0.0}, radius = 0.02;
    world w = {.system = m.system, .solver = m.solver};
    se3d_material stone;
    se3d_material_def material = se3d_material_def_default();
    material.density = 2500.0;
    material.stiffness = 1e4;
    CHECK(!se3d_material_create(w.system, &material, &stone));
    se3d_particles_def set = se3d_particles_def_default();
    CHECK(!se3d_particles_create(w.system, &set, &w.particles));
    CHECK(!se3d_particles_add(w.particles, stone, 1, at, &radius, v, NULL, NULL));
    CHECK(se3d_solver_run(m.solver, 0.1) == SE3D_ERR_NO_CONVERGENCE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "friction jams");
    check_time(&w);
    se3d_particles_destroy(w.particles);
    text_model_close(&m);
}

int main(void)
{
    RUN(stopped_by_friction_that_jams_they_are_at_one_time);
    RUN(interrupted_at_any_question_they_are_at_one_time);
    RUN(stopped_by_a_formula_they_are_at_one_time);
    return check_finish();
}
