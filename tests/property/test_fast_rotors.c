/* SPDX-License-Identifier: BSD-3-Clause */
/* Rotors and chains of pins that turn many times in a run, by the method that takes the longest
 * steps (gauss, without frames between them): crossings of angles are found, digits are those of
 * the tolerance, and what goes on from a copy goes on to the bit. */
#include "check.h"
#include "se3d/se3d.h"

#include <math.h>
#include <string.h>

#define PINS 4

typedef struct pins {
    se3d_system *system;
    se3d_constraint pin[PINS];
    se3d_body last;
} pins;

/* Links of 2 `half` one after the other, pins along y, at `rate` [rad/s] as one rigid body. */
static void make_pins(pins *p, int count, double half, double rate)
{
    const double gravity[3] = {0.0, 0.0, -9.81}, axis[3] = {0.0, 1.0, 0.0};
    se3d_body before;
    CHECK(!se3d_system_create(NULL, &p->system));
    CHECK(!se3d_system_set_gravity(p->system, gravity));
    CHECK(!se3d_system_get_ground(p->system, &before));
    for (int k = 0; k < count; ++k) {
        const double at[3] = {2.0 * half * k, 0.0, 0.0};
        se3d_body_def body = se3d_body_def_default();
        se3d_joint_def joint = se3d_joint_def_default();
        body.mass = 1.0 + 0.1 * k;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
        body.position[0] = at[0] + half;
        body.angular_velocity[1] = rate;
        body.velocity[2] = -rate * body.position[0];
        CHECK(!se3d_body_create(p->system, &body, &p->last));
        joint.body_i = before;
        joint.body_j = p->last;
        CHECK(!se3d_joint_def_set_frame(p->system, &joint, at, axis, NULL));
        CHECK(!se3d_joint_create_revolute(p->system, &joint, &p->pin[k]));
        before = p->last;
    }
}

static se3d_solver *make_solver(se3d_system *system, se3d_method method, double tolerance)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = method;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(system, &def, &solver));
    return solver;
}

static double angle_of(const pins *p, int k)
{
    double angle = NAN, rate, acceleration;
    CHECK(!se3d_joint_get_coordinate(p->system, p->pin[k], SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                     &rate, &acceleration));
    return angle;
}

static se3d_status tell_angle(void *ctx, const se3d_system *system, double *value)
{
    double rate, acceleration;
    return se3d_joint_get_coordinate(system, *(const se3d_constraint *)ctx,
                                     SE3D_JOINT_COORDINATE_ANGLE, value, &rate, &acceleration);
}

/* How often an angle crosses a level in 1 s, and when it last does. */
static size_t count_crossings(se3d_method method, double tolerance, double rate, double level,
                              double *time)
{
    pins p;
    make_pins(&p, 1, 0.02, rate);
    se3d_solver *solver = make_solver(p.system, method, tolerance);
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.value = tell_angle;
    def.ctx = &p.pin[0];
    def.level = level;
    def.motion_only = 1;
    CHECK(!se3d_event_create(solver, &def, &event));
    CHECK(!se3d_solver_run(solver, 1.0));
    const size_t count = se3d_solver_count_event_records(solver);
    for (size_t k = 0; k < count; ++k) {
        se3d_event_record record;
        CHECK(!se3d_solver_get_event_record(solver, k, &record));
        *time = record.time;
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(p.system);
    return count;
}

static void crossings_of_angles_are_found_however_many_turns_a_step_might_take(void)
{
    for (int k = 0; k < 10; ++k) {
        const double rate = 2.0 + 6.0 * k;
        for (int l = 0; l < 8; ++l) {
            const double level = rate * (l + 0.5) / 8.0;
            double time = 0.0, known = 0.0;
            const size_t count = count_crossings(SE3D_METHOD_AUTO, 0.0, rate, level, &time);
            CHECK(count == count_crossings(SE3D_METHOD_DOP853, 1e-10, rate, level, &known));
            CHECK(fabs(time - known) < 1e-5);
        }
    }
}

static void digits_are_those_of_the_tolerance_however_fast_it_turns(void)
{
    static const double rates[] = {36.0, 193.0, 1021.0, 2349.0};
    for (int k = 0; k < 4; ++k) {
        for (int links = 1; links <= 2; ++links) {
            for (double tolerance = 1e-3; tolerance > 1e-10; tolerance *= 1e-3) {
                pins p, exact;
                make_pins(&p, links, 0.05, rates[k]);
                make_pins(&exact, links, 0.05, rates[k]);
                se3d_solver *solver = make_solver(p.system, SE3D_METHOD_GAUSS, tolerance);
                se3d_solver *other = make_solver(exact.system, SE3D_METHOD_DOP853, 1e-12);
                CHECK(!se3d_solver_run(solver, 1.0) && !se3d_solver_run(other, 1.0));
                const double error = fabs(angle_of(&p, 0) - angle_of(&exact, 0));
                CHECK(error < 10.0 * tolerance);
                se3d_solver_destroy(solver);
                se3d_solver_destroy(other);
                se3d_system_destroy(p.system);
                se3d_system_destroy(exact.system);
            }
        }
    }
}

static void place_of(const se3d_system *system, se3d_body body, double x[3])
{
    CHECK(!se3d_body_get_position(system, body, x));
}

static void what_goes_on_from_a_copy_goes_on_to_the_bit(void)
{
    for (int steps = 1; steps < 60; ++steps) {
        pins p;
        se3d_system *copy = NULL;
        se3d_snapshot *snapshot = NULL;
        double here[3], there[3], again[3];
        make_pins(&p, PINS, 0.5, 0.0);
        se3d_solver *solver = make_solver(p.system, SE3D_METHOD_GAUSS, 0.0);
        for (int k = 0; k < steps; ++k) {
            CHECK(!se3d_solver_step(solver, 0.005));
        }
        CHECK(!se3d_system_clone(p.system, &copy));
        CHECK(!se3d_snapshot_create(p.system, &snapshot));
        se3d_solver *other = make_solver(copy, SE3D_METHOD_GAUSS, 0.0);
        CHECK(!se3d_solver_run(solver, 3.0) && !se3d_solver_run(other, 3.0));
        place_of(p.system, p.last, here);
        place_of(copy, p.last, there);
        CHECK(!se3d_snapshot_restore(snapshot, p.system));
        CHECK(!se3d_solver_run(solver, 3.0));
        place_of(p.system, p.last, again);
        CHECK(!memcmp(here, there, sizeof here) && !memcmp(here, again, sizeof here));
        se3d_solver_destroy(solver);
        se3d_solver_destroy(other);
        se3d_snapshot_destroy(snapshot);
        se3d_system_destroy(p.system);
        se3d_system_destroy(copy);
    }
}

int main(void)
{
    RUN(crossings_of_angles_are_found_however_many_turns_a_step_might_take);
    RUN(digits_are_those_of_the_tolerance_however_fast_it_turns);
    RUN(what_goes_on_from_a_copy_goes_on_to_the_bit);
    return check_finish();
}
