/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction that sticks, stops that give their restitution, stiff springs that keep the step,
 * curves, preloads, gravity in time, copies. */
#include "check.h"

#include "se3d/se3d.h"
#include "support/world.h"

typedef struct slide {
    se3d_system *system;
    se3d_body ground, block;
    se3d_constraint joint;
    se3d_force force;
} slide;

/* A block on a prismatic joint down a slope: positive displacement is downhill. */
static void build_slide(slide *s, double slope)
{
    const double at[3] = {0.0, 0.0, 0.0};
    const double axis[3] = {cos(slope), 0.0, -sin(slope)};
    CHECK(se3d_system_create(NULL, &s->system) == SE3D_OK);
    CHECK(se3d_system_get_ground(s->system, &s->ground) == SE3D_OK);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 2.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
    CHECK(se3d_body_create(s->system, &def, &s->block) == SE3D_OK);
    s->joint =
        world_join(s->system, se3d_joint_create_prismatic, NULL, s->ground, s->block, at, axis);
}

static void add_friction(slide *s, double mu)
{
    se3d_friction_def def = se3d_friction_def_default();
    def.joint = s->joint;
    def.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def.mu = mu;
    CHECK(se3d_force_create_friction(s->system, &def, &s->force) == SE3D_OK);
}

static void run(slide *s, double t_end, double step, se3d_solver_stats *stats)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_GENERALIZED_ALPHA;
    def.step = step;
    CHECK(se3d_solver_create(s->system, &def, &solver) == SE3D_OK);
    se3d_status status = se3d_solver_run(solver, t_end);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(s->system));
    }
    CHECK(status == SE3D_OK);
    if (stats) {
        CHECK(se3d_solver_get_stats(solver, stats) == SE3D_OK);
    }
    se3d_solver_destroy(solver);
}

static void get(const slide *s, double x[3])
{
    CHECK(se3d_joint_get_coordinate(s->system, s->joint, SE3D_JOINT_COORDINATE_DISPLACEMENT, &x[0],
                                    &x[1], &x[2]) == SE3D_OK);
}

static void a_block_below_the_friction_angle_does_not_creep(void)
{
    for (int k = 0; k < 3; ++k) {
        slide s = {0};
        double x[3];
        build_slide(&s, atan(0.3) * (0.2 + 0.39 * k));
        add_friction(&s, 0.3);
        run(&s, 10.0, 0.01, NULL);
        get(&s, x);
        CHECK_NEAR(x[0], 0.0, 1e-11);
        CHECK_NEAR(x[1], 0.0, 1e-9);
        CHECK_NEAR(x[2], 0.0, 1e-6);
        se3d_system_destroy(s.system);
    }
}

static void a_block_above_the_friction_angle_slides_with_the_right_acceleration(void)
{
    slide s = {0};
    double x[3];
    double a = 9.81 * (sin(0.5) - 0.3 * cos(0.5));
    build_slide(&s, 0.5);
    add_friction(&s, 0.3);
    run(&s, 1.0, 0.01, NULL);
    get(&s, x);
    CHECK_NEAR(x[2], a, 1e-9);
    CHECK_NEAR(x[1], a, 1e-9);
    CHECK_NEAR(x[0], 0.5 * a, 1e-9);
    se3d_work work;
    CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
    CHECK_NEAR(work.dissipated, 0.3 * 2.0 * 9.81 * cos(0.5) * 0.5 * a, 1e-6);
    se3d_system_destroy(s.system);
}

/* Uphill with 1 m/s: it stops after v^2 / (2 g (sin + mu cos)) and stays where it stopped. */
static void a_sliding_block_stops_and_stays(void)
{
    slide s = {0};
    double x[3], later[3];
    const double slope = 0.2;
    const double v0[3] = {-cos(slope), 0.0, sin(slope)};
    double distance = 1.0 / (2.0 * 9.81 * (sin(slope) + 0.4 * cos(slope)));
    build_slide(&s, slope);
    add_friction(&s, 0.4);
    CHECK(se3d_body_set_velocity(s.system, s.block, v0) == SE3D_OK);
    run(&s, 0.5, 1e-4, NULL);
    get(&s, x);
    CHECK_NEAR(x[0], -distance, 1e-6);
    run(&s, 2.5, 1e-3, NULL);
    get(&s, later);
    CHECK_NEAR(later[0], x[0], 2e-9);
    CHECK_NEAR(later[1], 0.0, 1e-9);
    se3d_system_destroy(s.system);
}

static double bounce(double mass, double restitution, double speed, double step)
{
    slide s = {0};
    double x[3];
    const double none[3] = {0.0, 0.0, 0.0};
    const double v0[3] = {speed, 0.0, 0.0};
    build_slide(&s, 0.0);
    CHECK(se3d_system_set_gravity(s.system, none) == SE3D_OK);
    const double inertia[6] = {0.1, 0.1, 0.1, 0.0, 0.0, 0.0};
    CHECK(se3d_body_set_mass(s.system, s.block, mass, inertia) == SE3D_OK);
    CHECK(se3d_body_set_velocity(s.system, s.block, v0) == SE3D_OK);
    se3d_stop_def def = se3d_stop_def_default();
    def.joint = s.joint;
    def.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def.upper = 0.01 * speed;
    def.k = 1e5;
    def.restitution = restitution;
    CHECK(se3d_force_create_stop(s.system, &def, &s.force) == SE3D_OK);
    run(&s, 0.2, step, NULL);
    get(&s, x);
    se3d_system_destroy(s.system);
    return -x[1] / speed;
}

static void a_stop_gives_the_restitution_that_was_asked_for(void)
{
    const double e[] = {0.05, 0.3, 0.5, 0.7, 0.9, 1.0};
    for (size_t k = 0; k < sizeof e / sizeof e[0]; ++k) {
        CHECK_NEAR(bounce(2.0, e[k], 1.0, 1e-5), e[k], 2e-4);
    }
    CHECK_NEAR(bounce(20.0, 0.5, 0.2, 1e-5), 0.5, 2e-4);
}

/* A mass between a soft spring and ones of 1e2 .. 1e9 N/m, and a pendulum with a lever: the step is
 * kept, and Newton needs few iterations at every stiffness. */
static void stiffness_keeps_the_step_and_the_iterations(void)
{
    for (double k = 1e2; k < 2e9; k *= 10.0) {
        slide s = {0};
        se3d_force force;
        se3d_solver_stats stats;
        const double at[3] = {0.0, 0.0, 0.0};
        const double axis[3] = {0.3, 1.0, 0.2};
        build_slide(&s, 0.4);
        se3d_body_def body = se3d_body_def_default();
        body.mass = 1.0;
        body.inertia[0] = 0.2;
        body.inertia[1] = 0.3;
        body.inertia[2] = 0.4;
        body.position[0] = 0.5;
        body.angular_velocity[2] = 1.0;
        se3d_body arm;
        CHECK(se3d_body_create(s.system, &body, &arm) == SE3D_OK);
        se3d_joint_def joint = se3d_joint_def_default();
        joint.body_i = s.block;
        joint.body_j = arm;
        CHECK(se3d_joint_def_set_frame(s.system, &joint, at, axis, NULL) == SE3D_OK);
        se3d_constraint hinge;
        CHECK(se3d_joint_create_spherical(s.system, &joint, &hinge) == SE3D_OK);
        se3d_tsda_def spring = se3d_tsda_def_default();
        spring.body_i = s.ground;
        spring.body_j = s.block;
        spring.point_i[0] = 1.0;
        spring.k = k;
        spring.l0 = 1.0;
        CHECK(se3d_force_create_tsda(s.system, &spring, &force) == SE3D_OK);
        spring.body_j = arm;
        spring.point_i[1] = 1.0;
        spring.point_j[2] = 0.3;
        spring.k = 50.0;
        CHECK(se3d_force_create_tsda(s.system, &spring, &force) == SE3D_OK);
        run(&s, 1.0, 0.01, &stats);
        CHECK(stats.steps == 100);
        CHECK(stats.rejected == 0);
        CHECK(stats.iterations <= 4 * stats.steps);
        se3d_system_destroy(s.system);
    }
}

static void curves_and_preload_add_to_the_spring(void)
{
    slide s = {0};
    double l, rate, f, potential;
    const double x[4] = {-1.0, 0.0, 1.0, 2.0};
    const double y[4] = {-3.0, 0.0, 3.0, 6.0};
    build_slide(&s, 0.0);
    se3d_function line;
    se3d_function_def curve = se3d_function_def_default();
    curve.table_x = x;
    curve.table_y = y;
    curve.table_count = 4;
    CHECK(se3d_function_create(s.system, &curve, &line) == SE3D_OK);
    se3d_tsda_def def = se3d_tsda_def_default();
    def.body_i = s.ground;
    def.body_j = s.block;
    def.point_i[0] = 2.5;
    def.l0 = 1.0;
    def.k = 10.0;
    def.preload = 7.0;
    def.spring = line;
    CHECK(se3d_force_create_tsda(s.system, &def, &s.force) == SE3D_OK);
    CHECK(se3d_force_get_state(s.system, s.force, &l, &rate, &f) == SE3D_OK);
    CHECK_NEAR(f, 7.0 + 13.0 * 1.5, 1e-12);
    CHECK(se3d_force_get_power(s.system, s.force, &potential, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(potential, 7.0 * 1.5 + 0.5 * 13.0 * 1.5 * 1.5, 1e-12);
    CHECK(se3d_function_destroy(s.system, line) == SE3D_ERR_IN_USE);
    CHECK(se3d_force_destroy(s.system, s.force) == SE3D_OK);
    CHECK(se3d_function_destroy(s.system, line) == SE3D_OK);
    se3d_system_destroy(s.system);
}

/* g_x = 2 t on a horizontal slide: x = t^3 / 3; its work is counted as an actuator's. */
/* What a force that acts in a point `at` of the ground does to the body at r. */
static void check_wrench(se3d_system *system, se3d_force force, const double r[3],
                         const double at[3], const double f[3])
{
    double wrench[6], opposite[6];
    const double arm[3] = {at[0] - r[0], at[1] - r[1], at[2] - r[2]};
    CHECK(!se3d_force_get_wrench(system, force, 1, wrench));
    CHECK(!se3d_force_get_wrench(system, force, 0, opposite));
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        CHECK_NEAR(wrench[k], f[k], 1e-13);
        CHECK_NEAR(opposite[k], -f[k], 1e-13);
        CHECK_NEAR(wrench[3 + k], arm[l] * f[m] - arm[m] * f[l], 1e-13);
    }
}

/* Between points that coincide, without a free length, c acts against the whole velocity of the
 * point: v + w x arm. */
static void a_spring_without_length_damps_in_every_direction(void)
{
    se3d_system *system = NULL;
    se3d_force force;
    se3d_body_def body = se3d_body_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    const double at[3] = {0.0, 0.0, 0.0}, c = 3.0;
    const double rate[3] = {1.0 + -1.0 * -0.3 - 2.0 * 0.2, 2.0 + 2.0 * 0.1 - 0.5 * -0.3,
                            3.0 + 0.5 * 0.2 - -1.0 * 0.1};
    double power;
    CHECK(!se3d_system_create(NULL, &system) && !se3d_system_get_ground(system, &spring.body_i));
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    for (int k = 0; k < 3; ++k) {
        static const double v[3] = {1.0, 2.0, 3.0}, w[3] = {0.5, -1.0, 2.0};
        static const double arm[3] = {0.1, 0.2, -0.3};
        body.velocity[k] = v[k];
        body.angular_velocity[k] = w[k];
        body.position[k] = -arm[k];
        spring.point_j[k] = arm[k];
    }
    CHECK(!se3d_body_create(system, &body, &spring.body_j));
    spring.k = 7.0;
    spring.c = c;
    CHECK(!se3d_force_create_tsda(system, &spring, &force));
    const double f[3] = {-c * rate[0], -c * rate[1], -c * rate[2]};
    check_wrench(system, force, body.position, at, f);
    CHECK(!se3d_force_get_power(system, force, NULL, &power, NULL));
    CHECK_NEAR(power, c * (rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2]), 1e-12);
    se3d_system_destroy(system);
}

/* Along the axes of its frame on body i, which is turned by 90 degrees about z: its x is y. */
static void a_bushing_acts_along_its_own_axes(void)
{
    static const double at[3] = {0.5, 0.25, -0.25}, moved[3] = {0.01, 0.02, 0.03};
    se3d_system *system = NULL;
    se3d_force force;
    se3d_body_def body = se3d_body_def_default();
    se3d_bushing_def mount = se3d_bushing_def_default();
    CHECK(!se3d_system_create(NULL, &system) && !se3d_system_get_ground(system, &mount.body_i));
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    memcpy(body.position, at, sizeof at);
    CHECK(!se3d_body_create(system, &body, &mount.body_j));
    for (int k = 0; k < 3; ++k) {
        mount.point_i[k] = at[k] - moved[k];
        mount.K[7 * k] = 100.0 * (k + 1);
    }
    mount.orientation_i[0] = mount.orientation_j[0] = sqrt(0.5);
    mount.orientation_i[3] = mount.orientation_j[3] = sqrt(0.5);
    CHECK(!se3d_force_create_bushing(system, &mount, &force));
    const double f[3] = {-200.0 * moved[0], -100.0 * moved[1], -300.0 * moved[2]};
    double wrench[6];
    CHECK(!se3d_force_get_wrench(system, force, 1, wrench));
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(wrench[k], f[k], 1e-13);
    }
    se3d_system_destroy(system);
}

static void gravity_may_be_a_function_of_time(void)
{
    slide s = {0};
    double x[3];
    se3d_work work;
    se3d_energy energy;
    se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
    build_slide(&s, 0.0);
    CHECK(se3d_function_create_expression(s.system, "2*t", &gravity[0]) == SE3D_OK);
    CHECK(se3d_system_set_gravity_function(s.system, gravity) == SE3D_OK);
    CHECK(se3d_function_destroy(s.system, gravity[0]) == SE3D_ERR_IN_USE);
    run(&s, 1.0, 1e-3, NULL);
    get(&s, x);
    CHECK_NEAR(x[0], 1.0 / 3.0, 1e-6);
    CHECK_NEAR(x[1], 1.0, 1e-6);
    CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
    CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
    CHECK_NEAR(energy.total, work.actuators, 1e-5);
    se3d_system_destroy(s.system);
}

/* An rsda on axes counts turns and needs no joint; removing it gives its angle back. */
static void an_rsda_on_axes_counts_turns(void)
{
    slide s = {0};
    double theta, rate, n;
    const double none[3] = {0.0, 0.0, 0.0};
    se3d_body rotor;
    CHECK(se3d_system_create(NULL, &s.system) == SE3D_OK);
    CHECK(se3d_system_get_ground(s.system, &s.ground) == SE3D_OK);
    CHECK(se3d_system_set_gravity(s.system, none) == SE3D_OK);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 1.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    def.angular_velocity[2] = 10.0;
    CHECK(se3d_body_create(s.system, &def, &rotor) == SE3D_OK);
    se3d_rsda_def spring = se3d_rsda_def_default();
    spring.body_i = s.ground;
    spring.body_j = rotor;
    spring.axis_i[2] = 1.0;
    spring.c = 0.0;
    spring.k = 0.25;
    CHECK(se3d_force_create_rsda(s.system, &spring, &s.force) == SE3D_OK);
    run(&s, 2.0, 1e-3, NULL);
    CHECK(se3d_force_get_state(s.system, s.force, &theta, &rate, &n) == SE3D_OK);
    CHECK_NEAR(theta, 20.0 * sin(1.0), 1e-4); /* 2.7 turns */
    CHECK_NEAR(rate, 10.0 * cos(1.0), 1e-4);
    CHECK_NEAR(n, 0.25 * theta, 1e-12);
    CHECK(se3d_force_destroy(s.system, s.force) == SE3D_OK);
    CHECK(se3d_force_create_rsda(s.system, &spring, &s.force) == SE3D_OK);
    se3d_system_destroy(s.system);
}

/* Snapshots and clones carry what friction and stops remember. */
static void copies_continue_bit_identically(void)
{
    slide s = {0};
    const double v0[3] = {1.0, 0.0, 0.0};
    build_slide(&s, 0.0);
    add_friction(&s, 0.4);
    CHECK(se3d_body_set_velocity(s.system, s.block, v0) == SE3D_OK);
    run(&s, 0.2, 1e-3, NULL);
    se3d_snapshot *snapshot = NULL;
    slide copy = s;
    CHECK(se3d_snapshot_create(s.system, &snapshot) == SE3D_OK);
    CHECK(se3d_system_clone(s.system, &copy.system) == SE3D_OK);
    run(&s, 0.4, 1e-3, NULL);
    uint64_t hash = se3d_system_hash(s.system);
    se3d_work before, after;
    CHECK(se3d_system_get_work(s.system, &before) == SE3D_OK);
    run(&copy, 0.4, 1e-3, NULL);
    CHECK(se3d_system_hash(copy.system) == hash);
    CHECK(se3d_snapshot_restore(snapshot, s.system) == SE3D_OK);
    run(&s, 0.4, 1e-3, NULL);
    CHECK(se3d_system_hash(s.system) == hash);
    CHECK(se3d_system_get_work(s.system, &after) == SE3D_OK);
    CHECK(memcmp(&before, &after, sizeof before) == 0);
    se3d_snapshot_destroy(snapshot);
    se3d_system_destroy(copy.system);
    se3d_system_destroy(s.system);
}

int main(void)
{
    RUN(a_block_below_the_friction_angle_does_not_creep);
    RUN(a_block_above_the_friction_angle_slides_with_the_right_acceleration);
    RUN(a_sliding_block_stops_and_stays);
    RUN(a_stop_gives_the_restitution_that_was_asked_for);
    RUN(stiffness_keeps_the_step_and_the_iterations);
    RUN(curves_and_preload_add_to_the_spring);
    RUN(a_spring_without_length_damps_in_every_direction);
    RUN(a_bushing_acts_along_its_own_axes);
    RUN(gravity_may_be_a_function_of_time);
    RUN(an_rsda_on_axes_counts_turns);
    RUN(copies_continue_bit_identically);
    return check_finish();
}
