/* SPDX-License-Identifier: BSD-3-Clause */
/* What only long use would show: energy and constraints that drift, memory that grows, handles that
 * run out, edits that add up.
 *
 *     SE3D_STEPS=10000000 build/dev/tests/test_property_long_runs [METHOD]
 *
 * makes so many steps of 1 ms by each method (or that one), a tenth as many systems and elements,
 * a hundredth as many edits, and prints what it finds; 604800000 steps are a week. */
#include <time.h>

#include "support/counting.h"
#include "support/mechanisms.h"
#include "support/methods.h"

static const double step = 1e-3;
static const char *only; /* this method */

static size_t steps(size_t part)
{
    const char *text = getenv("SE3D_STEPS");
    const size_t all = text ? strtoull(text, NULL, 10) : 2000;
    return all / part;
}

static world open_world(support_counting *counting)
{
    world w = {NULL, {0, 0}, NULL};
    const se3d_allocator allocator = support_counting_allocator(counting);
    se3d_system_def def = se3d_system_def_default();
    def.allocator = &allocator;
    def.gravity[1] = -9.81;
    def.gravity[2] = 0.0;
    MUST(&w, se3d_system_create(&def, &w.system));
    MUST(&w, se3d_system_get_ground(w.system, &w.ground));
    return w;
}

/* A bar on a ball joint, which swings and turns in space. */
static se3d_body add_swing(world *w)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    const double axis[3] = {0.0, 0.0, 1.0};
    const double spin[3] = {0.0, 1.0, 0.5};
    const double velocity[3] = {0.0, 0.25, -0.5};
    const se3d_body bar = add_bar(w, "bar", origin, 0.0, 1.0, 1.0);
    add_joint(w, se3d_joint_create_spherical, "ball", w->ground, bar, origin, axis);
    MUST(w, se3d_body_set_velocity(w->system, bar, velocity));
    MUST(w, se3d_body_set_angular_velocity(w->system, bar, spin));
    return bar;
}

static double energy_of(const world *w)
{
    se3d_energy energy;
    MUST(w, se3d_system_get_energy(w->system, &energy));
    return energy.total;
}

/* What energy may change by in units of the weight times the length: 1 ms steps of methods with a
 * fixed step, or errors of 1e-6 that are chosen, over the seconds of the run. */
static double drift_allowed(int32_t method, double seconds)
{
    switch (method) {
    case SE3D_METHOD_RATTLE:
    case SE3D_METHOD_VERLET:
    case SE3D_METHOD_GAUSS: /* keep it for ever */
        return 1e-5;
    case SE3D_METHOD_CONVEX: /* of order 2, like the next */
    case SE3D_METHOD_GENERALIZED_ALPHA:
    case SE3D_METHOD_HHT: /* damp high frequencies */
        return 1e-4 * seconds + 1e-5;
    default:
        return 1e-6 * seconds + 1e-9;
    }
}

static void run_long(int32_t method, size_t count)
{
    support_counting counting = {0};
    world w = open_world(&counting);
    double violation[3] = {0.0}, most[2] = {0.0}, drift = 0.0;
    add_swing(&w);
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.step = step;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    MUST(&w, se3d_solver_step(w.solver, step));
    const double energy = energy_of(&w);
    const clock_t begun = clock();
    size_t calls = 0, bytes = 0;
    for (size_t k = 1; k < count; ++k) {
        if (k == count / 10 + 10) { /* all is there by then */
            calls = counting.calls;
            bytes = counting.bytes;
        }
        const se3d_status status = se3d_solver_step(w.solver, step);
        if (status < 0) {
            fprintf(stderr, "%s: step %zu: %s\n", se3d_method_get_name(method), k,
                    se3d_system_get_error(w.system));
            CHECK(status >= 0);
            break;
        }
        if (k % 64 == 0 || k + 1 == count) {
            MUST(&w, se3d_system_get_violation(w.system, violation));
            most[0] = fmax(most[0], violation[0]);
            most[1] = fmax(most[1], violation[1]);
            drift = fmax(drift, fabs(energy_of(&w) - energy) / 9.81);
        }
    }
    CHECK(drift < drift_allowed(method, step * (double)count));
    CHECK(most[0] < 1e-9);
    CHECK(most[1] < 1e-8);
    CHECK(counting.calls == calls && counting.bytes == bytes);
    double time = 0.0;
    MUST(&w, se3d_system_get_time(w.system, &time));
    CHECK_NEAR(time, step * (double)count, 1e-14 * step * (double)count);
    if (getenv("SE3D_STEPS")) {
        printf("%-18s %zu steps: energy %.1e of weight and length, positions %.1e m, velocities "
               "%.1e m/s, %zu bytes, %.2f us a step\n",
               se3d_method_get_name(method), count, drift, most[0], most[1], bytes,
               1e6 * (double)(clock() - begun) / CLOCKS_PER_SEC / (double)count);
        fflush(stdout);
    }
    world_destroy(&w);
    CHECK(counting.live == 0 && counting.wrong == 0);
}

static void steps_of_every_method_keep_energy_constraints_and_memory(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        if (!only || strcmp(only, se3d_method_get_name(method)) == 0) {
            run_long(method, steps(1));
        }
    }
}

/* One element of each kind comes and goes: handles stay unique and memory does not grow. */
static void elements_come_and_go(void)
{
    support_counting counting = {0};
    world w = open_world(&counting);
    const double from[2] = {0.0, 0.0};
    const se3d_body first = add_swing(&w);
    size_t bytes = 0;
    se3d_body before = first;
    for (size_t k = 0; k < steps(10); ++k) {
        const se3d_body bar = add_bar(&w, "guest", from, 0.0, 1.0, 1.0);
        const se3d_constraint pin = add_pin(&w, "pin", first, bar, 1.0, 0.0);
        se3d_tsda_def spring = se3d_tsda_def_default();
        se3d_force force;
        spring.body_i = w.ground;
        spring.body_j = bar;
        spring.point_j[0] = 0.5;
        spring.k = 1.0;
        MUST(&w, se3d_force_create_tsda(w.system, &spring, &force));
        se3d_constraint driver;
        se3d_driver_def turn = se3d_driver_def_default();
        turn.joint = pin;
        MUST(&w, se3d_function_create_expression(w.system, "t", &turn.function));
        MUST(&w, se3d_driver_create(w.system, &turn, &driver));
        CHECK(k == 0 || bar.index1 != before.index1 || bar.generation != before.generation);
        before = bar;
        double position[3];
        MUST(&w, se3d_constraint_destroy(w.system, driver));
        MUST(&w, se3d_function_destroy(w.system, turn.function));
        MUST(&w, se3d_force_destroy(w.system, force));
        MUST(&w, se3d_constraint_destroy(w.system, pin));
        MUST(&w, se3d_body_destroy(w.system, bar));
        CHECK(se3d_body_get_position(w.system, bar, position) == SE3D_ERR_STALE_HANDLE);
        bytes = k == 2 ? counting.bytes : bytes;
    }
    CHECK(counting.bytes == bytes);
    world_destroy(&w);
    CHECK(counting.live == 0 && counting.wrong == 0);
}

static void systems_come_and_go(void)
{
    support_counting counting = {0};
    double position[3], first[3] = {0.0};
    for (size_t k = 0; k < steps(10); ++k) {
        world w = open_world(&counting);
        const se3d_body bar = add_swing(&w);
        use_solver(&w, SE3D_ANALYSIS_DYNAMICS, SE3D_FORMULATION_AUTO);
        MUST(&w, se3d_solver_step(w.solver, step));
        MUST(&w, se3d_body_get_position(w.system, bar, position));
        if (k == 0) {
            memcpy(first, position, sizeof first);
        }
        CHECK(memcmp(first, position, sizeof first) == 0);
        world_destroy(&w);
        CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
    }
}

/* A mass that is changed and changed back, and a body that comes and goes, between all steps. */
static void edits_between_steps_add_nothing_up(void)
{
    support_counting counting = {0};
    world w = open_world(&counting);
    const se3d_body bar = add_swing(&w);
    double mass, inertia[6], violation[3];
    size_t bytes = 0, last = 0;
    use_solver(&w, SE3D_ANALYSIS_DYNAMICS, SE3D_FORMULATION_AUTO);
    MUST(&w, se3d_solver_step(w.solver, step));
    const double energy = energy_of(&w);
    MUST(&w, se3d_body_get_mass(w.system, bar, &mass, inertia));
    for (size_t k = 0; k < steps(100); ++k) {
        const double from[2] = {5.0, 5.0};
        MUST(&w, se3d_body_set_mass(w.system, bar, 2.0 * mass, inertia));
        MUST(&w, se3d_body_set_mass(w.system, bar, mass, inertia));
        const se3d_body guest = add_bar(&w, "guest", from, 0.0, 1.0, 1.0);
        MUST(&w, se3d_solver_step(w.solver, step));
        MUST(&w, se3d_body_destroy(w.system, guest));
        last = counting.bytes;
        bytes = k == 2 ? last : bytes;
    }
    MUST(&w, se3d_solver_step(w.solver, step));
    MUST(&w, se3d_system_get_violation(w.system, violation));
    CHECK(violation[0] < 1e-9 && violation[1] < 1e-8);
    CHECK_NEAR(energy_of(&w), energy, 1e-6 * (1.0 + step * (double)steps(100)));
    CHECK(last == bytes);
    world_destroy(&w);
    CHECK(counting.live == 0 && counting.wrong == 0);
}

int main(int argc, char **argv)
{
    only = argc > 1 ? argv[1] : NULL;
    RUN(steps_of_every_method_keep_energy_constraints_and_memory);
    if (!only) {
        RUN(elements_come_and_go);
        RUN(systems_come_and_go);
        RUN(edits_between_steps_add_nothing_up);
    }
    return check_finish();
}
