/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact in every analysis, in closed form: what a press needs, how a box on its corners vibrates,
 * how deep a ball sinks, and what readers see at the start and where an event stops a run. */
#include "se3d/event.h"
#include "se3d/modes.h"
#include "support/scene.h"

static void solve_analysis(scene *s, int32_t analysis, int32_t formulation, double step)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.formulation = formulation;
    def.step = step;
    CHECK(se3d_solver_create(s->system, &def, &s->solver) == SE3D_OK);
}

/* A carriage that a driver moves along `axis` with f(t), and a ball fixed to it at r: shapes of
 * bodies that a joint connects with the ground would not touch it. */
static se3d_body press(scene *s, const double r[3], const double axis[3], const char *f,
                       se3d_constraint *motor)
{
    const double J[3] = {1.0, 1.0, 1.0}, up[3] = {0.0, 0.0, 0.3};
    se3d_body carriage = scene_body(s, 3.0, J, up, scene_zero);
    se3d_body ball = scene_ball(s, 0.1, 2.0, r, scene_zero);
    se3d_joint_def guide = se3d_joint_def_default(), weld = guide;
    se3d_driver_def drive = se3d_driver_def_default();
    se3d_constraint joint;
    guide.body_i = scene_ground(s);
    guide.body_j = weld.body_i = carriage;
    weld.body_j = ball;
    CHECK(se3d_joint_def_set_frame(s->system, &guide, up, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_def_set_frame(s->system, &weld, r, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_prismatic(s->system, &guide, &joint) == SE3D_OK);
    drive.joint = joint;
    drive.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    CHECK(se3d_function_create_expression(s->system, f, &drive.function) == SE3D_OK);
    CHECK(se3d_driver_create(s->system, &drive, motor) == SE3D_OK);
    CHECK(se3d_joint_create_fixed(s->system, &weld, &joint) == SE3D_OK);
    return ball;
}

static const int32_t driven[2] = {SE3D_ANALYSIS_KINEMATICS, SE3D_ANALYSIS_INVERSE_DYNAMICS};

/* Pressed in and out without damping: effort = M (g + z'') - k overlap. */
static void a_press_needs_what_the_contact_gives(void)
{
    const double k = 1e5, axis[3] = {0.0, 0.0, 1.0}, r[3] = {0.0, 0.0, 0.1 + 1e-3};
    for (int n = 0; n < 4; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 1.0, k);
        se3d_constraint motor;
        double force[3], torque[3], effort, most;
        scene_floor(&s, 0.0);
        se3d_body ball = press(&s, r, axis, "-2e-3 * (1 - cos(5 * t))", &motor);
        solve_analysis(&s, driven[n % 2], n / 2, 0.02);
        for (int step = 0; step <= 12; ++step) {
            const double t = 0.1 * step, z = 1e-3 - 2e-3 * (1.0 - cos(5.0 * t));
            const double push = fmax(0.0, -k * z), az = -0.05 * cos(5.0 * t);
            scene_run(&s, t);
            CHECK(se3d_body_get_contact_wrench(s.system, ball, force, torque) == SE3D_OK);
            CHECK(se3d_driver_get_effort(s.system, motor, &effort) == SE3D_OK);
            CHECK(se3d_system_get_contact_force_max(s.system, &most) == SE3D_OK);
            CHECK_NEAR(force[2], push, 1e-6);
            CHECK_NEAR(most, push, 1e-6);
            CHECK_NEAR(effort, 5.0 * (G + az) - push, 1e-6);
            CHECK(se3d_system_count_contacts(s.system) == (push > 0.0));
        }
        scene_end(&s);
    }
}

/* To and fro along the floor: a spring of stiffness kt that yields at mu N, with its hysteresis. */
static void a_ball_that_is_dragged_sticks_and_slips(void)
{
    const double k = 1e5, kt = 2.0 / 7.0 * k, mu = 0.5, overlap = 2e-4, a = 1e-3;
    const double axis[3] = {1.0, 0.0, 0.0}, r[3] = {0.0, 0.0, 0.1 - overlap};
    const double cap = mu * k * overlap;
    for (int n = 0; n < 4; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 1.0, k);
        se3d_constraint motor;
        double force[3], torque[3], effort, spring = 0.0, last = 0.0;
        scene_floor(&s, 0.0);
        se3d_body ball = press(&s, r, axis, "1e-3 * sin(2 * t)", &motor);
        solve_analysis(&s, driven[n % 2], n / 2, 0.01);
        for (int step = 0; step <= 300; ++step) {
            const double t = 0.01 * step, x = a * sin(2.0 * t);
            spring = fmax(-cap, fmin(cap, spring + kt * (x - last)));
            last = x;
            scene_run(&s, t);
            CHECK(se3d_body_get_contact_wrench(s.system, ball, force, torque) == SE3D_OK);
            CHECK(se3d_driver_get_effort(s.system, motor, &effort) == SE3D_OK);
            CHECK_NEAR(force[0], -spring, 1e-6);
            CHECK_NEAR(effort, -5.0 * 4.0 * x + spring, 1e-6);
        }
        scene_end(&s);
    }
}

/* Shapes far inside each other: no force means anything there. */
static void driven_bodies_may_not_overlap_too_much(void)
{
    const double axis[3] = {0.0, 0.0, 1.0}, r[3] = {0.0, 0.0, 0.11};
    for (int n = 0; n < 2; ++n) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 1.0, 1e5);
        se3d_constraint motor;
        double at[3], time;
        scene_floor(&s, 0.0);
        se3d_body ball = press(&s, r, axis, "-0.1 * t", &motor);
        solve_analysis(&s, driven[n], SE3D_FORMULATION_ROMEGA, 0.01);
        CHECK(se3d_solver_run(s.solver, 1.0) == SE3D_ERR_STEP_SIZE);
        CHECK_CONTAINS(se3d_system_get_error(s.system), "floor");
        CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
        CHECK_NEAR(at[2], 0.08, 2e-3); /* the last state that may be: 0.2 of the radius */
        CHECK(se3d_system_get_time(s.system, &time) == SE3D_OK);
        CHECK_NEAR(at[2], 0.11 - 0.1 * time, 1e-12);
        scene_end(&s);
    }
}

static int has_frequency(const se3d_modes *modes, double wanted)
{
    for (size_t k = 0; k < se3d_modes_count(modes); ++k) {
        se3d_eigenvalue value;
        CHECK(se3d_modes_get_eigenvalue(modes, k, &value) == SE3D_OK);
        if (fabs(value.frequency / wanted - 1.0) < 1e-4) {
            return 1;
        }
    }
    fprintf(stderr, "  no mode of %.9g Hz\n", wanted);
    return 0;
}

/* On four springs k, kt under the corners (+-a, +-b, -h): heave, yaw, and two pairs of sway with
 * pitch or roll, in which the rise of the corners by h angle^2/2 gives back weight. */
static void a_box_vibrates_on_its_corners(void)
{
    const double k = 1e6, kt = 2.0 / 7.0 * k, m = 2.0, size[3] = {0.3, 0.2, 0.1};
    const double sink = m * G / (4.0 * k), h = 0.05 - sink;
    const double r[3] = {0.0, 0.0, h};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 1.0, k);
    se3d_modes *modes = NULL;
    scene_box(&s, size, m, r, scene_zero);
    scene_floor(&s, 0.0);
    solve_analysis(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_FORMULATION_ROMEGA, 0.0);
    scene_run(&s, 0.0);
    CHECK(se3d_modes_create(s.system, NULL, &modes) == SE3D_OK);
    CHECK(se3d_modes_count(modes) == 6);
    CHECK(has_frequency(modes, sqrt(4.0 * k / m) / (2.0 * PI)));
    const double Jz = m * (size[0] * size[0] + size[1] * size[1]) / 12.0;
    const double square = 0.25 * (size[0] * size[0] + size[1] * size[1]);
    CHECK(has_frequency(modes, sqrt(4.0 * kt * square / Jz) / (2.0 * PI)));
    for (int axis = 0; axis < 2; ++axis) { /* m x'' , J angle'' of x - h angle and a angle */
        const double a = 0.5 * size[axis], w = size[axis];
        const double J = m * (w * w + size[2] * size[2]) / 12.0;
        const double K11 = 4.0 * kt / m, K12 = 4.0 * kt * h;
        const double K22 = (4.0 * kt * h * h + 4.0 * k * a * a - m * G * h) / J;
        const double mean = 0.5 * (K11 + K22), apart = 0.5 * (K11 - K22);
        const double root = sqrt(apart * apart + K12 * K12 / (m * J));
        CHECK(has_frequency(modes, sqrt(mean - root) / (2.0 * PI)));
        CHECK(has_frequency(modes, sqrt(mean + root) / (2.0 * PI)));
    }
    se3d_modes_destroy(modes);
    scene_end(&s);
}

/* Hertz: m g = 4/3 E* sqrt(R) overlap^1.5; of the same material 1/E* = 2 (1 - nu^2)/E. */
static void a_ball_sinks_in_as_hertz_says(void)
{
    const double R = 0.1, m = 2.0, K = 4.0 / 3.0 * 1e7 / (2.0 * 0.91) * sqrt(R);
    const double sink = pow(m * G / K, 2.0 / 3.0), r[3] = {0.0, 0.0, R - 1e-5};
    scene s = scene_begin(SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.5, 1.0, 1e5);
    se3d_modes *modes = NULL;
    double at[3];
    se3d_body ball = scene_ball(&s, R, m, r, scene_zero);
    scene_floor(&s, 0.0);
    solve_analysis(&s, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_FORMULATION_ROMEGA, 0.0);
    scene_run(&s, 0.0);
    CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
    CHECK_NEAR(at[2], R - sink, 1e-9);
    CHECK(se3d_modes_create(s.system, NULL, &modes) == SE3D_OK);
    CHECK(has_frequency(modes, sqrt(1.5 * K * sqrt(sink) / m) / (2.0 * PI)));
    se3d_modes_destroy(modes);
    scene_end(&s);
}

/* The force that readers see is the one that the accelerations come from: m (a + g). */
static void check_force(const scene *s, se3d_body ball, double tolerance)
{
    double a[3], force[3], torque[3];
    CHECK(se3d_body_get_acceleration(s->system, ball, a) == SE3D_OK);
    CHECK(se3d_body_get_contact_wrench(s->system, ball, force, torque) == SE3D_OK);
    CHECK(force[2] > 1.0);
    CHECK_NEAR(force[2], 2.0 * (a[2] + G), tolerance);
}

static void forces_are_known_before_the_first_step(void)
{
    static const int32_t analyses[2] = {SE3D_ANALYSIS_DYNAMICS, SE3D_ANALYSIS_ASSEMBLY};
    const double r[3] = {0.0, 0.0, 0.0999}, v[3] = {0.0, 0.0, -0.1};
    for (int k = 0; k < 2; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, 1e5);
        se3d_body ball = scene_ball(&s, 0.1, 2.0, r, v);
        scene_floor(&s, 0.0);
        solve_analysis(&s, analyses[k], SE3D_FORMULATION_ROMEGA, 0.0);
        scene_run(&s, 0.0);
        check_force(&s, ball, 1e-9);
        CHECK(se3d_system_count_contacts(s.system) == 1);
        scene_end(&s);
    }
}

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3] = {0.0, 0.0, 0.0};
    const se3d_status status = se3d_body_get_position(system, *(const se3d_body *)ctx, r);
    *value = r[2];
    return status;
}

/* If an event on the position stops the run contacts are those of that instant. */
static void forces_are_those_of_where_an_event_stops(void)
{
    const double r[3] = {0.0, 0.0, 0.1}, v[3] = {0.0, 0.0, -0.5};
    for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_RK4; ++method) {
        for (int given = 0; given < 2; ++given) {
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, 1e5);
            se3d_event_def def = se3d_event_def_default();
            se3d_event event;
            double at[3];
            se3d_body ball = scene_ball(&s, 0.1, 2.0, r, v);
            scene_floor(&s, 0.0);
            scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, given ? 1e-4 : 0.0, 1e-7);
            def.value = get_height;
            def.ctx = &ball;
            def.level = 0.099;
            def.action = SE3D_EVENT_STOP;
            CHECK(se3d_event_create(s.solver, &def, &event) == SE3D_OK);
            CHECK(se3d_solver_run(s.solver, 0.1) == SE3D_INFO_EVENT);
            CHECK(se3d_body_get_position(s.system, ball, at) == SE3D_OK);
            CHECK_NEAR(at[2], 0.099, 1e-9);
            int before = check_failures;
            check_force(&s, ball, 0.05);
            se3d_contact contact;
            CHECK(se3d_system_count_contacts(s.system) == 1);
            CHECK(se3d_system_get_contacts(s.system, 1, &contact) == SE3D_OK);
            CHECK_NEAR(contact.overlap, 0.001, 1e-9);
            if (check_failures > before) {
                fprintf(stderr, "  method %d, step given: %d\n", (int)method, given);
            }
            scene_end(&s);
        }
    }
}

int main(void)
{
    RUN(a_press_needs_what_the_contact_gives);
    RUN(a_ball_that_is_dragged_sticks_and_slips);
    RUN(driven_bodies_may_not_overlap_too_much);
    RUN(a_box_vibrates_on_its_corners);
    RUN(a_ball_sinks_in_as_hertz_says);
    RUN(forces_are_known_before_the_first_step);
    RUN(forces_are_those_of_where_an_event_stops);
    return check_finish();
}
