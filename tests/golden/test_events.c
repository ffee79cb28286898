/* SPDX-License-Identifier: BSD-3-Clause */
/* Events against closed forms, in every method and both formulations. */
#include "check.h"
#include "support/models.h"

typedef struct probe {
    se3d_body body;
    se3d_constraint joint;
    int calls;
} probe;

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3];
    probe *p = ctx;
    ++p->calls;
    const se3d_status status = se3d_body_get_position(system, p->body, r);
    *value = r[2];
    return status;
}

static se3d_status get_speed_up(void *ctx, const se3d_system *system, double *value)
{
    double v[3];
    const se3d_status status = se3d_body_get_velocity(system, ((probe *)ctx)->body, v);
    *value = v[2];
    return status;
}

static se3d_status get_angle(void *ctx, const se3d_system *system, double *value)
{
    double rate, second;
    const probe *p = ctx;
    return se3d_joint_get_coordinate(system, p->joint, SE3D_JOINT_COORDINATE_ANGLE, value, &rate,
                                     &second);
}

static se3d_status get_pull(void *ctx, const se3d_system *system, double *value)
{
    double force[3], torque[3];
    const probe *p = ctx;
    const se3d_status status = se3d_constraint_get_reaction(system, p->joint, force, torque);
    *value = force[2];
    return status;
}

typedef struct method {
    int32_t method;
    double step;
    double tolerance; /* of the method */
    double time;      /* of the located times */
} method;

/* A parabola is exact for all but the multistep formula, which starts at order 1. */
static const method fall_methods[] = {
    {SE3D_METHOD_DOP853, 0.0, 1e-8, 1e-12},  {SE3D_METHOD_RK45, 0.0, 1e-8, 1e-12},
    {SE3D_METHOD_RK4, 0.0, 1e-8, 1e-12},     {SE3D_METHOD_GENERALIZED_ALPHA, 0.013, 0.0, 1e-12},
    {SE3D_METHOD_HHT, 0.013, 0.0, 1e-12},    {SE3D_METHOD_GENERALIZED_ALPHA, 0.0, 1e-6, 1e-12},
    {SE3D_METHOD_BDF, 0.0, 1e-9, 1e-6},      {SE3D_METHOD_RADAU, 0.0, 1e-8, 1e-12},
    {SE3D_METHOD_RATTLE, 0.013, 0.0, 1e-12}, {SE3D_METHOD_VERLET, 0.013, 0.0, 1e-12},
    {SE3D_METHOD_GAUSS, 0.0, 1e-5, 1e-12},   {SE3D_METHOD_GAUSS, 0.0, 1e-8, 1e-12},
};
#define FALL_METHODS (sizeof fall_methods / sizeof fall_methods[0])

static se3d_solver *make_solver(se3d_system *system, const method *m, int32_t formulation)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = m->method;
    def.step = m->step;
    def.tolerance = m->tolerance;
    def.formulation = formulation;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    return solver;
}

static se3d_event add_event(se3d_solver *solver, const char *name, se3d_event_value value, probe *p,
                            double level, int32_t direction, int32_t action)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.name = name;
    def.value = value;
    def.ctx = p;
    def.level = level;
    def.direction = direction;
    def.action = action;
    def.motion_only = value != get_pull;
    CHECK(se3d_event_create(solver, &def, &event) == SE3D_OK);
    return event;
}

static se3d_event_record get_record(se3d_solver *solver, size_t k)
{
    se3d_event_record record;
    memset(&record, 0, sizeof record);
    CHECK(se3d_solver_get_event_record(solver, k, &record) == SE3D_OK);
    return record;
}

/* A free body, z = 10 + v t - g t^2/2. */
static se3d_system *make_ball(double v, probe *p)
{
    se3d_system *system = NULL;
    se3d_body_def def = se3d_body_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    def.name = "ball";
    def.mass = 2.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
    def.position[2] = 10.0;
    def.velocity[2] = v;
    def.angular_velocity[0] = 1.0;
    CHECK(se3d_body_create(system, &def, &p->body) == SE3D_OK);
    return system;
}

static double get_time(const se3d_system *system)
{
    double t = -1.0;
    se3d_system_get_time(system, &t);
    return t;
}

static void a_fall_stops_at_a_height_in_every_method(void)
{
    const double exact = sqrt(2.0 * 7.0 / 9.81);
    for (size_t k = 0; k < 2 * FALL_METHODS; ++k) {
        const method *m = &fall_methods[k / 2];
        probe p = {.calls = 0};
        double r[3];
        se3d_system *system = make_ball(0.0, &p);
        se3d_solver *solver = make_solver(system, m, (int32_t)(k % 2));
        add_event(solver, "plane", get_height, &p, 3.0, SE3D_EVENT_ANY, SE3D_EVENT_STOP);
        CHECK(se3d_solver_run(solver, 2.0) == SE3D_INFO_EVENT);
        CHECK_NEAR(get_time(system), exact, m->time);
        se3d_body_get_position(system, p.body, r);
        CHECK_NEAR(r[2], 3.0, 1e-14);
        CHECK(se3d_solver_count_event_records(solver) == 1);
        const se3d_event_record record = get_record(solver, 0);
        CHECK(record.time == get_time(system) && record.value == r[2]);
        CHECK(record.direction == SE3D_EVENT_FALLING && record.action == SE3D_EVENT_STOP);
        CHECK_CONTAINS(record.name, "plane");
        CHECK(se3d_solver_run(solver, 2.0) == SE3D_OK); /* not the same one again */
        CHECK(get_time(system) == 2.0);
        CHECK(se3d_solver_count_event_records(solver) == 1);
        se3d_body_get_position(system, p.body, r);
        CHECK_NEAR(r[2], 10.0 - 0.5 * 9.81 * 4.0, 20.0 * m->time);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

static void both_ways_through_a_level_are_told_apart(void)
{
    const double v = 9.81; /* up and down through 12: t = 1 -+ sqrt(1 - 4/9.81) */
    const double half = sqrt(1.0 - 4.0 / 9.81);
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        const method *m = &fall_methods[k];
        for (int32_t direction = -1; direction <= 1; ++direction) {
            probe p = {.calls = 0};
            se3d_system *system = make_ball(v, &p);
            se3d_solver *solver = make_solver(system, m, 0);
            add_event(solver, NULL, get_height, &p, 12.0, direction, SE3D_EVENT_RECORD);
            CHECK(se3d_solver_run(solver, 2.5) == SE3D_OK);
            const size_t count = se3d_solver_count_event_records(solver);
            CHECK(count == (direction == 0 ? 2 : 1));
            for (size_t n = 0; n < count; ++n) {
                const se3d_event_record record = get_record(solver, n);
                const int rises = direction > 0 || (direction == 0 && n == 0);
                CHECK(record.direction == (rises ? SE3D_EVENT_RISING : SE3D_EVENT_FALLING));
                CHECK_NEAR(record.time, rises ? 1.0 - half : 1.0 + half, m->time);
                CHECK(record.name[0] == '\0');
            }
            se3d_solver_destroy(solver);
            se3d_system_destroy(system);
        }
    }
}

/* The steps of dop853 on a parabola grow to a second and more: up and down within one. */
static void two_crossings_in_one_step_are_both_found(void)
{
    const double above[3] = {1e-1, 1e-3, 1e-6};
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        for (int n = 0; n < 3; ++n) {
            probe p = {.calls = 0};
            se3d_system *system = make_ball(9.81, &p);
            se3d_solver *solver = make_solver(system, &fall_methods[k], 0);
            const double top = 10.0 + 0.5 * 9.81;
            add_event(solver, "top", get_height, &p, top - above[n], 0, SE3D_EVENT_RECORD);
            CHECK(se3d_solver_run(solver, 3.0) == SE3D_OK);
            const int multistep = fall_methods[k].method == SE3D_METHOD_BDF;
            if (multistep && n == 2) { /* its error is larger */
                se3d_solver_destroy(solver);
                se3d_system_destroy(system);
                continue;
            }
            CHECK(se3d_solver_count_event_records(solver) == 2);
            const double half = sqrt(2.0 * above[n] / 9.81);
            const double slack = (multistep ? 1e-6 : 1e-13) / half;
            CHECK_NEAR(get_record(solver, 0).time, 1.0 - half, slack);
            CHECK_NEAR(get_record(solver, 1).time, 1.0 + half, slack);
            se3d_solver_destroy(solver);
            se3d_system_destroy(system);
        }
    }
}

static void what_begins_at_its_level_has_not_crossed_it(void)
{
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        probe p = {.calls = 0};
        se3d_system *system = make_ball(4.905, &p);
        se3d_solver *solver = make_solver(system, &fall_methods[k], 0);
        add_event(solver, "back", get_height, &p, 10.0, 0, SE3D_EVENT_RECORD);
        for (int n = 1; n <= 10; ++n) {
            CHECK(se3d_solver_run(solver, 0.15 * n) == SE3D_OK);
        }
        CHECK(se3d_solver_count_event_records(solver) == 1);
        const se3d_event_record record = get_record(solver, 0);
        CHECK_NEAR(record.time, 1.0, fall_methods[k].time);
        CHECK(record.direction == SE3D_EVENT_FALLING);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* The run ends where the event is: v = -4.905 + 9.81 t is exact in binary at t = 0.5 or nearly so.
 */
static void an_event_at_the_end_of_a_run_happens_once(void)
{
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        probe p = {.calls = 0};
        se3d_system *system = make_ball(0.0, &p);
        se3d_solver *solver = make_solver(system, &fall_methods[k], 0);
        const double g[3] = {0.0, 0.0, -8.0};
        se3d_system_set_gravity(system, g);
        add_event(solver, "end", get_height, &p, 10.0 - 0.5 * 8.0 * 0.25, 0, SE3D_EVENT_RECORD);
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.75) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 1.0) == SE3D_OK);
        CHECK(se3d_solver_count_event_records(solver) == 1);
        CHECK_NEAR(get_record(solver, 0).time, 0.5, fall_methods[k].time);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* Ten planes, in any order of creation. */
static void events_in_one_step_come_in_order_of_time(void)
{
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        probe p = {.calls = 0};
        se3d_system *system = make_ball(0.0, &p);
        se3d_solver *solver = make_solver(system, &fall_methods[k], 0);
        for (int n = 0; n < 10; ++n) {
            add_event(solver, NULL, get_height, &p, 9.0 - (n * 7) % 10, 0, SE3D_EVENT_RECORD);
        }
        CHECK(se3d_solver_run(solver, 2.0) == SE3D_OK);
        CHECK(se3d_solver_count_event_records(solver) == 10);
        for (size_t n = 0; n < 10; ++n) {
            CHECK_NEAR(get_record(solver, n).time, sqrt(2.0 * (1.0 + (double)n) / 9.81),
                       fall_methods[k].time);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* At each stop the velocity is turned round: t_n = t_0 (1 + 2 e + 2 e^2 + ...). */
static void a_ball_bounces_by_restarting(void)
{
    const double e = 0.7, t0 = sqrt(20.0 / 9.81);
    for (size_t k = 0; k < 2 * FALL_METHODS; ++k) {
        const method *m = &fall_methods[k / 2];
        probe p = {.calls = 0};
        se3d_system *system = make_ball(0.0, &p);
        se3d_solver *solver = make_solver(system, m, (int32_t)(k % 2));
        add_event(solver, "floor", get_height, &p, 0.0, 0, SE3D_EVENT_STOP);
        double expected = t0, flight = 2.0 * t0;
        int bounces = 0;
        while (bounces < 12 && se3d_solver_run(solver, 20.0) == SE3D_INFO_EVENT) {
            double v[3];
            CHECK_NEAR(get_time(system), expected, 20.0 * m->time);
            se3d_body_get_velocity(system, p.body, v);
            v[2] *= -e;
            se3d_body_set_velocity(system, p.body, v);
            flight *= e;
            expected += flight;
            ++bounces;
        }
        CHECK(bounces == 12);
        CHECK(se3d_solver_count_event_records(solver) == 12);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

static se3d_status bounce(void *ctx, se3d_system *system, const se3d_event_record *record)
{
    double v[3];
    probe *p = ctx;
    ++p->calls;
    CHECK(record->direction == SE3D_EVENT_FALLING && record->time == get_time(system));
    se3d_body_get_velocity(system, p->body, v);
    v[2] = -v[2];
    return p->calls == 5 ? SE3D_INFO_EVENT : se3d_body_set_velocity(system, p->body, v);
}

static void a_callback_may_change_the_state_and_stop(void)
{
    const double t0 = sqrt(20.0 / 9.81);
    for (size_t k = 0; k < FALL_METHODS; ++k) {
        const method *m = &fall_methods[k];
        probe p = {.calls = 0}, counted = {.calls = 0};
        se3d_system *system = make_ball(0.0, &p);
        se3d_solver *solver = make_solver(system, m, 0);
        se3d_event_def def = se3d_event_def_default();
        se3d_event event;
        counted.body = p.body;
        def.value = get_height;
        def.ctx = &p;
        p.calls = 0;
        def.callback = bounce;
        def.callback_ctx = &counted;
        CHECK(se3d_event_create(solver, &def, &event) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 100.0) == SE3D_INFO_EVENT);
        CHECK(counted.calls == 5);
        CHECK_NEAR(get_time(system), 9.0 * t0, 300.0 * m->time);
        CHECK(se3d_solver_count_event_records(solver) == 5);
        CHECK(get_record(solver, 3).action == SE3D_EVENT_RECORD);
        CHECK(get_record(solver, 4).action == SE3D_EVENT_STOP);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* The complete elliptic integral of the first kind, by the arithmetic-geometric mean. */
static double quarter_period(double k)
{
    double a = 1.0, b = sqrt(1.0 - k * k);
    for (int n = 0; n < 30; ++n) {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return 1.5707963267948966 / a;
}

/* A bar about its end, released at rest at theta0 from the lowest position; axis x. */
static se3d_system *make_pendulum(double theta0, probe *p)
{
    se3d_system *system = NULL;
    se3d_body_def def = se3d_body_def_default();
    se3d_joint_def pin = se3d_joint_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    def.mass = 1.5;
    def.inertia[0] = def.inertia[1] = 0.5; /* m L^2/3 with L = 1 */
    def.inertia[2] = 0.01;
    def.orientation[0] = cos(0.5 * theta0);
    def.orientation[1] = sin(0.5 * theta0);
    def.position[1] = sin(theta0);
    def.position[2] = -cos(theta0);
    CHECK(se3d_body_create(system, &def, &p->body) == SE3D_OK);
    pin.body_j = p->body;
    se3d_system_get_ground(system, &pin.body_i);
    pin.point_j[2] = 1.0;
    pin.axis_i[0] = pin.axis_j[0] = 1.0;
    pin.axis_i[2] = pin.axis_j[2] = 0.0;
    pin.ref_i[1] = pin.ref_j[1] = 1.0;
    CHECK(se3d_joint_create_revolute(system, &pin, &p->joint) == SE3D_OK);
    return system;
}

static const method swing_methods[] = {
    {SE3D_METHOD_DOP853, 0.0, 1e-10, 1e-9}, {SE3D_METHOD_RK45, 0.0, 1e-10, 1e-9},
    {SE3D_METHOD_RK4, 0.0, 1e-10, 1e-9},    {SE3D_METHOD_GENERALIZED_ALPHA, 1e-3, 0.0, 1e-5},
    {SE3D_METHOD_HHT, 1e-3, 0.0, 1e-4},     {SE3D_METHOD_BDF, 0.0, 1e-9, 1e-6},
    {SE3D_METHOD_RADAU, 0.0, 1e-10, 1e-9},  {SE3D_METHOD_RATTLE, 1e-3, 0.0, 1e-5},
    {SE3D_METHOD_VERLET, 1e-3, 0.0, 1e-5},  {SE3D_METHOD_GAUSS, 0.0, 1e-10, 1e-9},
};
#define SWING_METHODS (sizeof swing_methods / sizeof swing_methods[0])

/* omega^2 = m g L/(m L^2 + m L^2/3) */
static void a_pendulum_passes_its_lowest_point_when_the_elliptic_integral_says(void)
{
    const double theta0 = 1.2;
    const double quarter = quarter_period(sin(0.5 * theta0)) / sqrt(9.81 * 0.75);
    for (size_t k = 0; k < 2 * SWING_METHODS; ++k) {
        const method *m = &swing_methods[k / 2];
        probe p = {.calls = 0};
        se3d_system *system = make_pendulum(theta0, &p);
        se3d_solver *solver = make_solver(system, m, (int32_t)(k % 2));
        add_event(solver, "lowest", get_angle, &p, 0.0, SE3D_EVENT_ANY, SE3D_EVENT_RECORD);
        add_event(solver, "turn", get_speed_up, &p, 0.0, SE3D_EVENT_FALLING, SE3D_EVENT_STOP);
        CHECK(se3d_solver_run(solver, 1.9 * quarter) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 4.0) == SE3D_INFO_EVENT); /* at rest on the other side */
        CHECK_NEAR(get_time(system), 2.0 * quarter, 3.0 * m->time);
        double violation[3];
        se3d_system_get_violation(system, violation);
        CHECK_NEAR(violation[0], 0.0, 1e-9);
        CHECK_NEAR(violation[1], 0.0,
                   m->method == SE3D_METHOD_GENERALIZED_ALPHA || m->method == SE3D_METHOD_HHT
                       ? 1e-4
                       : 1e-9);
        while (se3d_solver_run(solver, 4.0) == SE3D_INFO_EVENT) {
        }
        size_t passed = 0;
        for (size_t n = 0; n < se3d_solver_count_event_records(solver); ++n) {
            const se3d_event_record record = get_record(solver, n);
            if (strcmp(record.name, "lowest") == 0) {
                CHECK_NEAR(record.time, (2.0 * (double)passed + 1.0) * quarter, 10.0 * m->time);
                CHECK_NEAR(record.value, 0.0, 1e-14);
                CHECK(record.direction == (passed % 2 ? 1 : -1));
                ++passed;
            }
        }
        CHECK(passed == (size_t)(0.5 * (4.0 / quarter + 1.0)));
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* The pull of the pin on the bar: m g + m L w^2 at the lowest point, its largest; it is cos, so an
 * event of multipliers. w^2 = 2 omega^2 (cos theta - cos theta0); the vertical component is
 * m g - m L (theta'' sin theta - w^2 cos theta) */
static double vertical_pull(double theta, double theta0)
{
    const double o = 9.81 * 0.75, m = 1.5;
    const double w2 = 2.0 * o * (cos(theta) - cos(theta0));
    return m * 9.81 + m * (-o * sin(theta) * sin(theta) + w2 * cos(theta));
}

static void a_reaction_crosses_its_level_where_the_closed_form_does(void)
{
    const double theta0 = 1.2, wanted = 0.5;
    const double level = vertical_pull(wanted, theta0);
    for (size_t k = 0; k < 2 * SWING_METHODS; ++k) {
        const method *m = &swing_methods[k / 2];
        probe p = {.calls = 0};
        double angle = 0.0;
        se3d_system *system = make_pendulum(theta0, &p);
        se3d_solver *solver = make_solver(system, m, (int32_t)(k % 2));
        add_event(solver, "pull", get_pull, &p, level, SE3D_EVENT_RISING, SE3D_EVENT_STOP);
        CHECK(se3d_solver_run(solver, 4.0) == SE3D_INFO_EVENT);
        get_angle(&p, system, &angle);
        CHECK_NEAR(angle, wanted, 100.0 * m->time);
        CHECK_NEAR(get_record(solver, 0).value, level, 1e-9 * level);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* The mechanism that its driver moves: theta = theta0 + 2 sin(3 t). */
static void a_driven_angle_crosses_when_its_driver_does(void)
{
    for (int32_t k = 0; k < 4; ++k) {
        probe p = {.calls = 0};
        se3d_system *system = make_pendulum(0.0, &p);
        se3d_driver_def drive = se3d_driver_def_default();
        se3d_constraint driver;
        drive.joint = p.joint;
        CHECK(se3d_function_create_expression(system, "2*sin(3*t)", &drive.function) == SE3D_OK);
        CHECK(se3d_driver_create(system, &drive, &driver) == SE3D_OK);
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        def.analysis = k < 2 ? SE3D_ANALYSIS_KINEMATICS : SE3D_ANALYSIS_INVERSE_DYNAMICS;
        def.formulation = k % 2;
        CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
        add_event(solver, "one", get_angle, &p, 1.0, 0, SE3D_EVENT_RECORD);
        add_event(solver, "back", get_angle, &p, 0.0, SE3D_EVENT_FALLING, SE3D_EVENT_STOP);
        CHECK(se3d_solver_run(solver, 3.0) == SE3D_INFO_EVENT);
        const double pi = 3.14159265358979323846;
        CHECK_NEAR(get_time(system), pi / 3.0, 1e-14);
        CHECK(se3d_solver_count_event_records(solver) == 3);
        CHECK_NEAR(get_record(solver, 0).time, pi / 18.0, 1e-14);
        CHECK_NEAR(get_record(solver, 1).time, 5.0 * pi / 18.0, 1e-14);
        CHECK(se3d_solver_run(solver, 3.0) == SE3D_OK);
        CHECK(se3d_solver_count_event_records(solver) == 5);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

int main(void)
{
    RUN(a_fall_stops_at_a_height_in_every_method);
    RUN(both_ways_through_a_level_are_told_apart);
    RUN(two_crossings_in_one_step_are_both_found);
    RUN(what_begins_at_its_level_has_not_crossed_it);
    RUN(an_event_at_the_end_of_a_run_happens_once);
    RUN(events_in_one_step_come_in_order_of_time);
    RUN(a_ball_bounces_by_restarting);
    RUN(a_callback_may_change_the_state_and_stop);
    RUN(a_pendulum_passes_its_lowest_point_when_the_elliptic_integral_says);
    RUN(a_reaction_crosses_its_level_where_the_closed_form_does);
    RUN(a_driven_angle_crosses_when_its_driver_does);
    return check_finish();
}
