/* SPDX-License-Identifier: BSD-3-Clause */
/* Manoeuvres of the Formula SAE car of examples/fsae with a driver: what must hold whatever the
 * tyres are. Coarse tolerances: the balances hold to a few per cent because the wheels' spins, the
 * arms and the pitch take a little. */
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "support/parts.h"

#define G 9.81

static const char *const tyres[4] = {"fl_tyre", "fr_tyre", "rl_tyre", "rr_tyre"};

typedef struct drive {
    se3d_model *model;
    se3d_system *system;
    se3d_solver *solver;
    se3d_body chassis;
    double mass;
} drive;

static int open_drive(const char *name, drive *d)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    char path[800];
    se3d_model_error error = {0};
    se3d_solver_def def = se3d_solver_def_default();
    *d = (drive){.mass = 0.0};
    snprintf(path, sizeof path, "%s/examples/fsae/%s.yaml", source ? source : ".", name);
    const se3d_status status = se3d_model_read_file(path, NULL, &d->model, &error);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", error.message);
        return 0;
    }
    d->system = se3d_model_get_system(d->model);
    CHECK(!se3d_model_get_solver(d->model, 0, &def));
    def.tolerance = 1e-4;
    CHECK(!se3d_solver_create(d->system, &def, &d->solver));
    CHECK(!se3d_body_find(d->system, "chassis", &d->chassis));
    for (size_t k = 1; k < se3d_system_count_bodies(d->system); ++k) {
        double mass = 0.0, inertia[6];
        se3d_body body;
        CHECK(!se3d_system_get_body(d->system, k, &body));
        CHECK(!se3d_body_get_mass(d->system, body, &mass, inertia));
        d->mass += mass;
    }
    return d->solver != NULL;
}

static void close_drive(drive *d)
{
    se3d_solver_destroy(d->solver);
    se3d_model_destroy(d->model);
}

static void run(drive *d, double t)
{
    const se3d_status status = se3d_solver_run(d->solver, t);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(d->system));
    }
}

static double tell(const drive *d, int tyre, size_t which)
{
    double value = 0.0;
    se3d_force force;
    CHECK(!se3d_force_find(d->system, tyres[tyre], &force));
    CHECK(!se3d_tyre_get_values(d->system, force, which, 1, &value));
    return value;
}

static double sum_tyres(const drive *d, size_t which)
{
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        sum += tell(d, k, which);
    }
    return sum;
}

/* Of the chassis: position, speed, yaw rate, and how far it slips to the left. */
typedef struct motion {
    double r[3], speed, yaw, slip;
} motion;

static motion watch(const drive *d)
{
    motion m;
    double v[3], w[3], ahead[3];
    static const double x[3] = {1.0, 0.0, 0.0};
    CHECK(!se3d_body_get_position(d->system, d->chassis, m.r));
    CHECK(!se3d_body_get_velocity(d->system, d->chassis, v));
    CHECK(!se3d_body_get_angular_velocity(d->system, d->chassis, w));
    CHECK(!se3d_body_get_point(d->system, d->chassis, x, ahead));
    const double a[2] = {ahead[0] - m.r[0], ahead[1] - m.r[1]};
    m.speed = sqrt(v[0] * v[0] + v[1] * v[1]);
    m.yaw = w[2];
    m.slip = atan2(a[0] * v[1] - a[1] * v[0], a[0] * v[0] + a[1] * v[1]);
    return m;
}

/* No tyre gives more than its grip, whatever the directions of its slip. */
static void forces_are_within_the_grip(const drive *d)
{
    for (int k = 0; k < 4; ++k) {
        CHECK(hypot(tell(d, k, SE3D_TYRE_FX), tell(d, k, SE3D_TYRE_FY)) <
              1.8 * tell(d, k, SE3D_TYRE_FZ));
    }
}

static void a_step_of_the_hand_wheel_leads_to_a_steady_turn(void)
{
    drive d;
    if (!open_drive("step_steer", &d)) {
        return;
    }
    run(&d, 3.9);
    const double before = part_balance(d.system);
    const motion straight = watch(&d);
    CHECK(straight.speed > 8.5 && straight.speed < 10.0);
    CHECK_NEAR(straight.yaw, 0.0, 1e-3);
    CHECK_NEAR(straight.r[1], 0.0, 1e-3);
    CHECK_NEAR(tell(&d, 0, SE3D_TYRE_FZ), tell(&d, 1, SE3D_TYRE_FZ), 1.0);
    run(&d, 6.0);
    const motion turn = watch(&d);
    const double side = sum_tyres(&d, SE3D_TYRE_FY);
    CHECK(turn.r[1] > 3.0 && turn.yaw > 0.4);
    CHECK_NEAR(side, d.mass * turn.speed * turn.yaw, 0.04 * side); /* m v r */
    CHECK_NEAR(sum_tyres(&d, SE3D_TYRE_FZ), d.mass * G, 0.01 * d.mass * G);
    CHECK(tell(&d, 1, SE3D_TYRE_FZ) > tell(&d, 0, SE3D_TYRE_FZ) + 300.0); /* the outer one */
    CHECK(tell(&d, 3, SE3D_TYRE_FZ) > tell(&d, 2, SE3D_TYRE_FZ) + 100.0);
    forces_are_within_the_grip(&d);
    run(&d, 6.5);
    CHECK_NEAR(watch(&d).yaw, turn.yaw, 0.02 * turn.yaw);
    CHECK_NEAR(part_balance(d.system), before, 0.5); /* of some 15 kJ */
    close_drive(&d);
}

/* He looks ahead and steers by that: the radius is met within a few per cent at every speed, the
 * lateral acceleration is v^2/R. */
static void the_driver_follows_a_circle_faster_and_faster(void)
{
    drive d;
    double speed = 0.0;
    if (!open_drive("circle", &d)) {
        return;
    }
    for (double t = 3.0; t < 5.5; t += 0.5) {
        run(&d, t);
        const motion m = watch(&d);
        const double radius = hypot(m.r[0], m.r[1] - 15.0);
        CHECK_NEAR(radius, 15.0, 0.3);
        CHECK_NEAR(m.yaw, m.speed / radius, 0.02 * m.yaw);
        CHECK(m.speed > speed + 0.3);
        speed = m.speed;
        forces_are_within_the_grip(&d);
    }
    CHECK_NEAR(sum_tyres(&d, SE3D_TYRE_FY), d.mass * speed * speed / 15.0,
               0.06 * d.mass * speed * speed / 15.0);
    close_drive(&d);
}

static void the_car_brakes_in_a_turn_and_stands(void)
{
    drive d;
    if (!open_drive("brake_turn", &d)) {
        return;
    }
    run(&d, 5.0);
    const double before = part_balance(d.system);
    const motion turn = watch(&d);
    run(&d, 5.5);
    motion m = watch(&d);
    const double force = -sum_tyres(&d, SE3D_TYRE_FX);
    forces_are_within_the_grip(&d);
    CHECK(fabs(m.slip) < 0.1 && m.yaw > 0.2 && m.yaw < turn.yaw);
    run(&d, 6.0);
    const double slowing = (m.speed - watch(&d).speed) / 0.5;
    CHECK(slowing > 4.0);
    CHECK_NEAR(force / d.mass, slowing, 0.1 * slowing);
    run(&d, 7.0);
    m = watch(&d);
    CHECK(m.speed < 0.05);
    CHECK(m.r[1] > 10.0);
    CHECK_NEAR(sum_tyres(&d, SE3D_TYRE_FZ), d.mass * G, 0.03 * d.mass * G); /* it still rocks */
    CHECK_NEAR(part_balance(d.system), before, 0.5);
    close_drive(&d);
}

int main(void)
{
    RUN(a_step_of_the_hand_wheel_leads_to_a_steady_turn);
    RUN(the_driver_follows_a_circle_faster_and_faster);
    RUN(the_car_brakes_in_a_turn_and_stands);
    return check_finish();
}
