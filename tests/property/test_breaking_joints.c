/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints that break where their reaction passes a limit: when, what goes on from there, and who
 * keeps it. */
#include <stdlib.h>

#include "base/hash.h"
#include "check.h"
#include "support/mechanisms.h"
#include "support/methods.h"
#include "system/system_internal.h"

#define G      9.81
#define MASS   2.0
#define LENGTH 1.5
#define J_OWN  0.4 /* about the centre of mass */

static se3d_constraint hang(world *w, joint_create create, const char *name, se3d_body i,
                            se3d_body j, const double at[3], double force, double moment)
{
    se3d_joint_def def = se3d_joint_def_default();
    const double axis[3] = {0.0, 0.0, 1.0};
    se3d_constraint joint;
    def.name = name;
    def.body_i = i;
    def.body_j = j;
    def.break_force = force;
    def.break_moment = moment;
    MUST(w, se3d_joint_def_set_frame(w->system, &def, at, axis, NULL));
    MUST(w, create(w->system, &def, &joint));
    return joint;
}

/* A pendulum that is let go horizontally; the angle is from there. */
static world swing_up(double force, se3d_constraint *pin, se3d_body *bob)
{
    world w = world_create();
    const double origin[3] = {0.0, 0.0, 0.0};
    se3d_body_def def = se3d_body_def_default();
    def.mass = MASS;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = J_OWN;
    def.position[0] = LENGTH;
    MUST(&w, se3d_body_create(w.system, &def, bob));
    *pin = hang(&w, se3d_joint_create_revolute, "pin", w.ground, *bob, origin, force, 0.0);
    return w;
}

/* |R|^2 = (m g)^2 (s^2 (1 + 2 b)^2 + (1 - s^2) (1 - b)^2), s = sin(angle), b = m l^2/(J + m l^2) */
static double break_angle(double force)
{
    const double b = MASS * LENGTH * LENGTH / (J_OWN + MASS * LENGTH * LENGTH);
    const double f2 = force * force / (MASS * MASS * G * G), low = (1.0 - b) * (1.0 - b);
    return asin(sqrt((f2 - low) / ((1.0 + 2.0 * b) * (1.0 + 2.0 * b) - low)));
}

static void use(world *w, int32_t method, int32_t formulation, double step)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.step = step;
    se3d_solver_destroy(w->solver);
    w->solver = NULL;
    MUST(w, se3d_solver_create(w->system, &def, &w->solver));
}

static double energy_gap(const world *w)
{
    se3d_energy energy;
    se3d_work work;
    MUST(w, se3d_system_get_energy(w->system, &energy));
    MUST(w, se3d_system_get_work(w->system, &work));
    return energy.kinetic + energy.potential + work.dissipated - work.actuators - work.drivers;
}

/* The bob flies from the angle as it should. */
static void check_flight(const world *w, se3d_body bob, double angle, double since,
                         double tolerance)
{
    const double b = MASS * LENGTH * LENGTH / (J_OWN + MASS * LENGTH * LENGTH);
    const double rate = sqrt(2.0 * G * b * sin(angle) / LENGTH), v = rate * LENGTH;
    double r[3], u[3], spin[3];
    MUST(w, se3d_body_get_position(w->system, bob, r));
    MUST(w, se3d_body_get_velocity(w->system, bob, u));
    MUST(w, se3d_body_get_angular_velocity(w->system, bob, spin));
    CHECK_NEAR(r[0], LENGTH * cos(angle) - v * sin(angle) * since, tolerance);
    CHECK_NEAR(r[1], -LENGTH * sin(angle) - v * cos(angle) * since - 0.5 * G * since * since,
               tolerance);
    CHECK_NEAR(u[0], -v * sin(angle), 4.0 * tolerance);
    CHECK_NEAR(u[1], -v * cos(angle) - G * since, 4.0 * tolerance);
    CHECK_NEAR(spin[2], -rate, 4.0 * tolerance);
}

static const struct {
    int32_t method;
    double step, tolerance;
} methods[] = {{SE3D_METHOD_DOP853, 0.0, 1e-6},  {SE3D_METHOD_RADAU, 0.0, 1e-6},
               {SE3D_METHOD_BDF, 0.0, 1e-4},     {SE3D_METHOD_GAUSS, 0.0, 1e-6},
               {SE3D_METHOD_RK45, 0.0, 1e-4},    {SE3D_METHOD_RK4, 2e-3, 1e-6},
               {SE3D_METHOD_HHT, 2e-3, 1e-3},    {SE3D_METHOD_GENERALIZED_ALPHA, 2e-3, 1e-3},
               {SE3D_METHOD_RATTLE, 2e-3, 1e-3}, {SE3D_METHOD_VERLET, 2e-3, 1e-3},
               {SE3D_METHOD_CONVEX, 5e-4, 2e-2}};

static void a_pendulum_breaks_at_the_angle_of_its_limit_by_every_method(void)
{
    const double force = 2.2 * MASS * G, angle = break_angle(force), t_end = 1.2;
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        for (int32_t formulation = 0; *se3d_formulation_get_name(formulation); ++formulation) {
            const double tolerance = methods[m].tolerance;
            se3d_constraint pin;
            se3d_body bob;
            se3d_event_record record;
            int32_t broken = -1;
            double f[3], torque[3];
            world w = swing_up(force, &pin, &bob);
            use(&w, methods[m].method, formulation, methods[m].step);
            const se3d_status status = se3d_solver_run(w.solver, t_end);
            check_that(status == SE3D_OK, se3d_method_get_name(methods[m].method), __FILE__,
                       __LINE__);
            CHECK(se3d_solver_count_event_records(w.solver) == 1);
            MUST(&w, se3d_solver_get_event_record(w.solver, 0, &record));
            CHECK(strcmp(record.name, "pin") == 0 && record.joint.index1 == pin.index1);
            CHECK(record.event.index1 == 0 && record.direction == SE3D_EVENT_RISING);
            CHECK_NEAR(record.value, 1.0, methods[m].method == SE3D_METHOD_CONVEX ? 1e-2 : 1e-9);
            MUST(&w, se3d_joint_get_broken(w.system, pin, &broken));
            CHECK(broken == 1);
            check_flight(&w, bob, angle, t_end - record.time, tolerance);
            MUST(&w, se3d_constraint_get_reaction(w.system, pin, f, torque));
            CHECK(f[0] == 0.0 && f[1] == 0.0 && torque[2] == 0.0);
            CHECK_NEAR(energy_gap(&w), 0.0, 20.0 * tolerance);
            world_destroy(&w);
        }
    }
}

/* The same by single steps, and from a copy, bytes and a snapshot of the way. */
static void what_broke_stays_broken_in_copies_and_is_whole_in_what_was_before(void)
{
    const double force = 2.2 * MASS * G;
    se3d_constraint pin;
    se3d_body bob;
    se3d_snapshot *whole = NULL, *apart = NULL;
    se3d_system *copy = NULL;
    int32_t broken = -1;
    world w = swing_up(force, &pin, &bob);
    use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT, 0.0);
    MUST(&w, se3d_solver_run(w.solver, 0.3));
    MUST(&w, se3d_snapshot_create(w.system, &whole));
    const uint64_t before = se3d_system_hash(w.system);
    MUST(&w, se3d_solver_run(w.solver, 1.0));
    const uint64_t after = se3d_system_hash(w.system);
    MUST(&w, se3d_snapshot_create(w.system, &apart));
    MUST(&w, se3d_system_clone(w.system, &copy));
    CHECK(se3d_joint_get_broken(copy, pin, &broken) == SE3D_OK && broken == 1);
    CHECK(se3d_system_hash(copy) == after);
    se3di_row *row =
        &copy->model.rows[0]; /* bodies that have been apart may touch: another state */
    CHECK((row->left_out & SE3DI_ROW_BROKEN) != 0);
    row->left_out ^= SE3DI_ROW_PARTED;
    CHECK(se3d_system_hash(copy) != after);
    row->left_out ^= SE3DI_ROW_PARTED;
    CHECK(se3d_system_hash(copy) == after);
    MUST(&w, se3d_snapshot_restore(whole, w.system));
    MUST(&w, se3d_joint_get_broken(w.system, pin, &broken));
    CHECK(broken == 0 && se3d_system_hash(w.system) == before);
    MUST(&w, se3d_solver_run(w.solver, 1.0));
    CHECK(se3d_system_hash(w.system) == after);
    CHECK(se3d_snapshot_restore(whole, copy) == SE3D_OK);
    CHECK(se3d_joint_get_broken(copy, pin, &broken) == SE3D_OK && broken == 0);
    CHECK(se3d_snapshot_restore(apart, copy) == SE3D_OK);
    CHECK(se3d_joint_get_broken(copy, pin, &broken) == SE3D_OK && broken == 1);
    CHECK(se3d_system_hash(copy) == after);
    se3d_system_destroy(copy);
    se3d_snapshot_destroy(whole);
    se3d_snapshot_destroy(apart);
    world_destroy(&w);
}

static void a_solver_that_is_written_and_read_knows_what_broke_and_what_will(void)
{
    const double force = 2.2 * MASS * G;
    static unsigned char bytes[1 << 16];
    static unsigned char state[1 << 16];
    for (int part = 0; part < 2; ++part) {
        se3d_constraint pin, again;
        se3d_body bob;
        size_t size = 0, state_size = 0;
        se3d_event_record record;
        world w = swing_up(force, &pin, &bob), v = swing_up(force, &again, &bob);
        se3d_snapshot *snapshot = NULL, *read = NULL;
        use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
        use(&v, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
        MUST(&w, se3d_solver_run(w.solver, part ? 0.9 : 0.3));
        MUST(&w, se3d_snapshot_create(w.system, &snapshot));
        MUST(&w, se3d_snapshot_write(snapshot, NULL, 0, &state_size));
        CHECK(state_size <= sizeof state);
        MUST(&w, se3d_snapshot_write(snapshot, state, sizeof state, &state_size));
        MUST(&w, se3d_solver_write(w.solver, bytes, sizeof bytes, &size));
        MUST(&v, se3d_snapshot_read(v.system, state, state_size, &read));
        MUST(&v, se3d_snapshot_restore(read, v.system));
        MUST(&v, se3d_solver_read(v.solver, bytes, size));
        MUST(&w, se3d_solver_run(w.solver, 1.1));
        MUST(&v, se3d_solver_run(v.solver, 1.1));
        CHECK(se3d_system_hash(w.system) == se3d_system_hash(v.system));
        CHECK(se3d_solver_count_event_records(v.solver) == 1);
        MUST(&v, se3d_solver_get_event_record(v.solver, 0, &record));
        CHECK(strcmp(record.name, "pin") == 0 && record.joint.index1 == again.index1);
        se3d_snapshot_destroy(snapshot);
        se3d_snapshot_destroy(read);
        world_destroy(&w);
        world_destroy(&v);
    }
}

#define LINKS 8

/* A chain that hangs, pulled at its end by k t: the first pin carries all, and breaks. */
static void the_first_link_of_a_chain_that_is_pulled_breaks(void)
{
    const double limit = 200.0, pull = 50.0, weight = LINKS * MASS * G;
    const int32_t ways[] = {SE3D_FORMULATION_JOINT, SE3D_FORMULATION_ROMEGA, SE3D_FORMULATION_AUTO};
    for (size_t way = 0; way < sizeof ways / sizeof *ways; ++way) {
        world w = world_create();
        se3d_body before = w.ground, body = w.ground;
        se3d_constraint pin[LINKS];
        se3d_event_record record;
        for (int k = 0; k < LINKS; ++k) {
            const double top[2] = {0.0, -0.5 * k}, at[3] = {0.0, -0.5 * k, 0.0};
            body = add_bar(&w, NULL, top, -0.5 * PI, 0.5, MASS);
            pin[k] = hang(&w, se3d_joint_create_revolute, NULL, before, body, at, limit, 0.0);
            before = body;
        }
        se3d_load_def load = se3d_load_def_default();
        se3d_force force;
        MUST(&w, se3d_function_create_expression(w.system, "-50*t", &load.function[1]));
        load.body = body;
        MUST(&w, se3d_force_create_load(w.system, &load, &force));
        use(&w, SE3D_METHOD_AUTO, ways[way], 0.0);
        const double when = (limit - weight) / pull, t_end = when + 0.5;
        CHECK(se3d_solver_run(w.solver, t_end) == SE3D_OK);
        CHECK(se3d_solver_count_event_records(w.solver) == 1);
        MUST(&w, se3d_solver_get_event_record(w.solver, 0, &record));
        CHECK_NEAR(record.time, when, 1e-9);
        CHECK(record.joint.index1 == pin[0].index1 && strcmp(record.name, "") == 0);
        double sum = 0.0, r[3], reaction[3];
        for (size_t k = 0; k < LINKS; ++k) {
            se3d_body one;
            MUST(&w, se3d_constraint_get_body(w.system, pin[k], 1, &one));
            MUST(&w, se3d_body_get_position(w.system, one, r));
            sum += r[1] / LINKS;
        }
        /* M a = M g + k t, from rest at `when`; what the next pin carries is all but one link's */
        const double s = 0.5, F = limit - weight;
        CHECK_NEAR(sum,
                   -0.25 * LINKS - 0.5 * G * s * s -
                       (0.5 * F * s * s + pull * s * s * s / 6.0) / (LINKS * MASS),
                   1e-7);
        MUST(&w, se3d_constraint_get_reaction(w.system, pin[1], reaction, NULL));
        CHECK_NEAR(reaction[1], (F + pull * s) / LINKS, 1e-6); /* pulls its body j along */
        world_destroy(&w);
    }
}

/* A plate on three parallel rods, one too many: each carries a third; when the middle one goes the
 * others carry a half, which is too much for them, and they go at the same time. */
static void rods_of_a_bridge_break_in_a_cascade(void)
{
    const double limits[3] = {60.0, 40.0, 60.0};
    const int32_t ways[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU, SE3D_METHOD_HHT,
                            SE3D_METHOD_VERLET, SE3D_METHOD_CONVEX};
    for (int strong = 0; strong < 2; ++strong) {
        for (size_t m = 0; m < sizeof ways / sizeof *ways; ++m) {
            world w = world_create();
            se3d_body plate;
            se3d_constraint rod[3];
            se3d_load_def load = se3d_load_def_default();
            se3d_force force;
            const double left[2] = {-1.0, -1.0};
            plate = add_bar(&w, "plate", left, 0.0, 2.0, 3.0);
            for (int k = 0; k < 3; ++k) {
                se3d_joint_def def = se3d_joint_def_default();
                def.body_i = w.ground;
                def.body_j = plate;
                def.point_i[0] = def.point_j[0] = k - 1.0;
                def.distance = 1.0;
                def.break_force = limits[k] + (strong && k != 1 ? 10.0 : 0.0);
                MUST(&w, se3d_joint_create_distance(w.system, &def, &rod[k]));
            }
            MUST(&w, se3d_function_create_expression(w.system, "-100*t", &load.function[1]));
            load.body = plate;
            MUST(&w, se3d_force_create_load(w.system, &load, &force));
            use(&w, ways[m], SE3D_FORMULATION_ROMEGA, ways[m] < 2 ? 0.0 : 1e-3);
            const se3d_status status = se3d_solver_run(w.solver, 1.0);
            check_that(status >= 0, se3d_method_get_name(ways[m]), __FILE__, __LINE__);
            const size_t count = se3d_solver_count_event_records(w.solver);
            const double first = (120.0 - 3.0 * G) / 100.0;
            se3d_event_record record;
            CHECK(count == (strong ? 1u : 3u));
            MUST(&w, se3d_solver_get_event_record(w.solver, 0, &record));
            CHECK(record.joint.index1 == rod[1].index1);
            CHECK_NEAR(record.time, first, ways[m] == SE3D_METHOD_CONVEX ? 2e-3 : 1e-6);
            for (size_t k = 1; k < count; ++k) {
                se3d_event_record next;
                MUST(&w, se3d_solver_get_event_record(w.solver, k, &next));
                CHECK_NEAR(next.time, record.time, 1.1e-3);
            }
            world_destroy(&w);
        }
    }
}

static void what_acts_on_a_joint_ends_with_it_and_its_spring_is_lost(void)
{
    const double origin[3] = {0.0, 0.0, 0.0};
    const int32_t ways[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU, SE3D_METHOD_HHT};
    for (size_t m = 0; m < sizeof ways / sizeof *ways; ++m) {
        world w = world_create();
        se3d_constraint pin, motor;
        se3d_rsda_def spring = se3d_rsda_def_default();
        se3d_driver_def drive = se3d_driver_def_default();
        se3d_friction_def friction = se3d_friction_def_default();
        se3d_force force;
        int32_t broken;
        double spin[3];
        const double from[2] = {0.0, 0.0};
        se3d_body bar = add_bar(&w, NULL, from, 0.0, 1.0, MASS);
        pin = hang(&w, se3d_joint_create_revolute, "pin", w.ground, bar, origin, 30.0, 0.0);
        drive.joint = pin;
        MUST(&w, se3d_function_create_expression(w.system, "2*t*t", &drive.function));
        MUST(&w, se3d_driver_create(w.system, &drive, &motor));
        spring.joint = pin;
        spring.k = 3.0;
        MUST(&w, se3d_force_create_rsda(w.system, &spring, &force));
        friction.joint = pin;
        friction.mu = 0.1;
        friction.radius = 0.02;
        MUST(&w, se3d_force_create_friction(w.system, &friction, &force));
        use(&w, ways[m], SE3D_FORMULATION_ROMEGA, m < 2 ? 0.0 : 1e-3);
        const se3d_status status = se3d_solver_run(w.solver, 3.0);
        check_that(status == SE3D_OK, se3d_method_get_name(ways[m]), __FILE__, __LINE__);
        CHECK(se3d_solver_count_event_records(w.solver) == 1);
        MUST(&w, se3d_joint_get_broken(w.system, motor, &broken));
        CHECK(broken == 1);
        se3d_event_record record;
        MUST(&w, se3d_solver_get_event_record(w.solver, 0, &record));
        MUST(&w, se3d_body_get_angular_velocity(w.system, bar, spin));
        CHECK_NEAR(spin[2], 4.0 * record.time, m < 2 ? 1e-6 : 1e-3); /* it turns on as it was */
        se3d_energy energy;
        MUST(&w, se3d_system_get_energy(w.system, &energy));
        CHECK_NEAR(energy_gap(&w), 0.0, m < 2 ? 1e-4 : 5e-2);
        world_destroy(&w);
    }
}

/* A driver whose value or rate follows a body prescribes nothing, and is met, once its joint is
 * broken, also where its function has no value any more. */
static void a_driver_of_signals_ends_with_its_joint(void)
{
    static const char *const laws[] = {"t^2*(2 + 0.1*x) + 0*sqrt(2.5 - t)",
                                       "4*t*(1 + 0.05*x) + 0*sqrt(2.5 - t)"};
    static const char *const names[] = {"t", "x"};
    static const int32_t ways[][2] = {{SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA},
                                      {SE3D_METHOD_DOP853, SE3D_FORMULATION_RP},
                                      {SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT},
                                      {SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA}};
    for (size_t k = 0; k < 2 * sizeof ways / sizeof *ways; ++k) {
        const double origin[3] = {0.0, 0.0, 0.0}, from[2] = {0.0, 0.0}, aside[2] = {0.0, 3.0};
        world w = world_create();
        se3d_constraint pin, motor;
        se3d_driver_def drive = se3d_driver_def_default();
        se3d_function_def law = se3d_function_def_default();
        double violation[3];
        int32_t broken;
        double spin[3];
        const se3d_body bar = add_bar(&w, NULL, from, 0.0, 1.0, MASS);
        const se3d_signal signal = {.kind = SE3D_SIGNAL_POINT_POSITION,
                                    .body = add_bar(&w, NULL, aside, 0.0, 1.0, 500.0)};
        pin = hang(&w, se3d_joint_create_revolute, "pin", w.ground, bar, origin, 30.0, 0.0);
        law.expression = laws[k % 2];
        law.variables = names;
        law.variable_count = 2;
        law.signals = &signal;
        law.signal_count = 1;
        drive.joint = pin;
        drive.is_rate = k % 2;
        MUST(&w, se3d_function_create(w.system, &law, &drive.function));
        MUST(&w, se3d_driver_create(w.system, &drive, &motor));
        use(&w, ways[k / 2][0], ways[k / 2][1], 0.0);
        MUST(&w, se3d_solver_run(w.solver, 2.0));
        CHECK(se3d_solver_count_event_records(w.solver) == 1);
        MUST(&w, se3d_joint_get_broken(w.system, motor, &broken));
        CHECK(broken == 1);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK(violation[0] == 0.0 && violation[1] == 0.0 && violation[2] == 0.0);
        MUST(&w, se3d_body_get_angular_velocity(w.system, bar, spin));
        const double before = spin[2];
        MUST(&w, se3d_solver_run(w.solver, 3.0));
        MUST(&w, se3d_body_get_angular_velocity(w.system, bar, spin));
        CHECK(before > 0.1);
        CHECK_NEAR(spin[2], before, 1e-9);
        world_destroy(&w);
    }
}

static void add_forces_on(world *w, se3d_constraint pin)
{
    se3d_force force;
    se3d_rsda_def spring = se3d_rsda_def_default();
    spring.joint = pin;
    spring.k = 3.0;
    MUST(w, se3d_force_create_rsda(w->system, &spring, &force));
    se3d_friction_def friction = se3d_friction_def_default();
    friction.joint = pin;
    friction.limit = 1.0;
    MUST(w, se3d_force_create_friction(w->system, &friction, &force));
    se3d_stop_def stop = se3d_stop_def_default();
    stop.joint = pin;
    stop.upper = 0.01;
    stop.k = 1e4;
    MUST(w, se3d_force_create_stop(w->system, &stop, &force));
    se3d_effort_def effort = se3d_effort_def_default();
    effort.joint = pin;
    effort.value = 4.0;
    MUST(w, se3d_force_create_effort(w->system, &effort, &force));
}

/* All that can be made on the angle of a hinge, and a gear with another one. */
static void load_hinge(world *w, se3d_constraint pin, se3d_constraint other,
                       se3d_constraint made[2])
{
    se3d_driver_def drive = se3d_driver_def_default();
    se3d_coupler_def gear = se3d_coupler_def_default();
    drive.joint = pin;
    MUST(w, se3d_function_create_expression(w->system, "sin(t)", &drive.function));
    MUST(w, se3d_driver_create(w->system, &drive, &made[0]));
    gear.joint[0] = pin;
    gear.joint[1] = other;
    gear.ratio[0] = 1.0;
    gear.ratio[1] = -2.0;
    gear.count = 2;
    MUST(w, se3d_joint_create_coupler(w->system, &gear, &made[1]));
    add_forces_on(w, pin);
}

/* A bar on a hinge that broke, and a pendulum. */
static world fall_aside(se3d_constraint hinges[2], se3d_body *bar)
{
    const double origin[3] = {0.0, 0.0, 0.0}, aside[3] = {0.0, 4.0, 0.0};
    world w = world_create();
    *bar = add_bar(&w, NULL, origin, 0.0, 1.0, MASS);
    hinges[0] = hang(&w, se3d_joint_create_revolute, "pin", w.ground, *bar, origin, 1e9, 0.0);
    hinges[1] = hang(&w, se3d_joint_create_revolute, "other", w.ground,
                     add_bar(&w, NULL, aside, 0.0, 1.0, MASS), aside, 0.0, 0.0);
    MUST(&w, se3d_joint_set_broken(w.system, hinges[0], 1));
    return w;
}

static void what_is_made_on_a_broken_joint_does_nothing(void)
{
    const struct {
        int32_t method, formulation;
        double step;
    } ways[] = {{SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0},
                {SE3D_METHOD_DOP853, SE3D_FORMULATION_RP, 0.0},
                {SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT, 0.0},
                {SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA, 0.0},
                {SE3D_METHOD_HHT, SE3D_FORMULATION_RP, 1e-3},
                {SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-3}};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        se3d_constraint hinges[2], made[2];
        se3d_body bar;
        double r[3], spin[3], violation[3];
        int32_t broken;
        world w = fall_aside(hinges, &bar);
        load_hinge(&w, hinges[0], hinges[1], made);
        for (int c = 0; c < 2; ++c) {
            MUST(&w, se3d_joint_get_broken(w.system, made[c], &broken));
            CHECK(broken == 1);
        }
        use(&w, ways[k].method, ways[k].formulation, ways[k].step);
        const se3d_status status = se3d_solver_run(w.solver, 0.5);
        check_that(status == SE3D_OK, se3d_method_get_name(ways[k].method), __FILE__, __LINE__);
        MUST(&w, se3d_body_get_position(w.system, bar, r));
        MUST(&w, se3d_body_get_angular_velocity(w.system, bar, spin));
        CHECK_NEAR(r[0], 0.5, 1e-12);
        CHECK_NEAR(r[1], -0.125 * G, 1e-9);
        CHECK_NEAR(spin[2], 0.0, 1e-12);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK_NEAR(violation[0] + violation[1], 0.0, 1e-7); /* the pendulum's */
        world_destroy(&w);
    }
}

static void an_armature_on_a_broken_joint_is_refused(void)
{
    se3d_constraint hinges[2];
    se3d_body bar;
    se3d_armature_def armature = se3d_armature_def_default();
    se3d_force force;
    world w = fall_aside(hinges, &bar);
    armature.joint = hinges[0];
    armature.inertia = 0.1;
    MUST(&w, se3d_force_create_armature(w.system, &armature, &force));
    use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(se3d_solver_run(w.solver, 0.5) == SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "'pin' (revolute) is broken and carries");
    MUST(&w, se3d_joint_set_broken(w.system, hinges[0], 0));
    MUST(&w, se3d_joint_set_break(w.system, hinges[0], 0.0, 0.0));
    CHECK(se3d_solver_run(w.solver, 0.5) == SE3D_OK);
    world_destroy(&w);
}

static se3d_check_summary summarize(world *w)
{
    se3d_check *check = NULL;
    se3d_check_summary summary = {.struct_size = sizeof summary};
    CHECK(se3d_check_create(w->system, &check) >= 0);
    CHECK(se3d_check_get_summary(check, &summary) == SE3D_OK);
    se3d_check_destroy(check);
    return summary;
}

/* The state of a system in that of another one. */
static void carry(world *from, world *to)
{
    static unsigned char state[1 << 16];
    se3d_snapshot *snapshot = NULL, *read = NULL;
    size_t size = 0;
    MUST(from, se3d_snapshot_create(from->system, &snapshot));
    MUST(from, se3d_snapshot_write(snapshot, state, sizeof state, &size));
    MUST(to, se3d_snapshot_read(to->system, state, size, &read));
    MUST(to, se3d_snapshot_restore(read, to->system));
    se3d_snapshot_destroy(snapshot);
    se3d_snapshot_destroy(read);
}

/* Four of five equations of `other` twice, so that redundant ones are seen. */
static void double_hinge(world *w)
{
    const double aside[3] = {0.0, 4.0, 0.0};
    se3d_body pendulum;
    se3d_constraint other, again;
    MUST(w, se3d_constraint_find(w->system, "other", &other));
    MUST(w, se3d_constraint_get_body(w->system, other, 1, &pendulum));
    again = hang(w, se3d_joint_create_revolute, "again", w->ground, pendulum, aside, 0.0, 0.0);
    CHECK(again.index1 != 0);
}

static void a_broken_joint_that_is_removed_leaves_no_trace(void)
{
    se3d_constraint hinges[2], other[2];
    se3d_body bar;
    world w = fall_aside(hinges, &bar), v = fall_aside(other, &bar);
    double_hinge(&w);
    double_hinge(&v);
    CHECK(summarize(&w).equations == 10 && summarize(&w).redundant == 5);
    MUST(&w, se3d_constraint_destroy(w.system, hinges[0]));
    MUST(&v, se3d_constraint_destroy(v.system, other[0]));
    CHECK(summarize(&w).equations == 10 && summarize(&w).redundant == 5);
    use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(se3d_solver_run(w.solver, 0.3) == SE3D_INFO_REDUNDANT);
    carry(&w, &v);
    CHECK(se3d_system_hash(w.system) == se3d_system_hash(v.system));
    world_destroy(&w);
    world_destroy(&v);
}

/* Bytes of w's solver are read by v's; what was written twice is the same. */
static void hand_over(world *w, world *v)
{
    static unsigned char bytes[2][1 << 16];
    size_t size[2] = {0, 0};
    MUST(w, se3d_solver_write(w->solver, bytes[0], sizeof bytes[0], &size[0]));
    MUST(v, se3d_solver_read(v->solver, bytes[0], size[0]));
    MUST(v, se3d_solver_write(v->solver, bytes[1], sizeof bytes[1], &size[1]));
    CHECK(size[0] == size[1] && memcmp(bytes[0], bytes[1], size[0]) == 0);
}

static void a_record_outlives_its_joint_and_solvers_that_are_read(void)
{
    const double force = 2.2 * MASS * G;
    world worlds[3];
    se3d_event_record record;
    for (int k = 0; k < 3; ++k) {
        se3d_constraint pin;
        se3d_body bob;
        worlds[k] = swing_up(force, &pin, &bob);
        use(&worlds[k], SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
        if (k == 0) {
            MUST(&worlds[k], se3d_solver_run(worlds[k].solver, 0.9));
        }
        MUST(&worlds[k], se3d_constraint_destroy(worlds[k].system, pin));
    }
    MUST(&worlds[0], se3d_solver_run(worlds[0].solver, 1.0));
    carry(&worlds[0], &worlds[1]);
    carry(&worlds[0], &worlds[2]);
    hand_over(&worlds[0], &worlds[1]);
    hand_over(&worlds[1], &worlds[2]);
    CHECK(se3d_solver_count_event_records(worlds[2].solver) == 1);
    MUST(&worlds[2], se3d_solver_get_event_record(worlds[2].solver, 0, &record));
    CHECK(strcmp(record.name, "pin") == 0 && record.joint.index1 == 0);
    uint64_t first = 0;
    for (int k = 0; k < 3; ++k) {
        MUST(&worlds[k], se3d_solver_run(worlds[k].solver, 1.2));
        first = k == 0 ? se3d_system_hash(worlds[k].system) : first;
        CHECK(se3d_system_hash(worlds[k].system) == first);
        world_destroy(&worlds[k]);
    }
}

/* Whatever a word says, what is taken can be written and read again. */
static void made_up_places_of_joints_do_no_harm(void)
{
    static unsigned char bytes[1 << 14], made[1 << 14];
    size_t size = 0, again = 0, taken = 0;
    se3d_constraint pin;
    se3d_body bob;
    world w = swing_up(2.2 * MASS * G, &pin, &bob);
    use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
    MUST(&w, se3d_solver_run(w.solver, 0.9));
    MUST(&w, se3d_solver_write(w.solver, bytes, sizeof bytes, &size));
    for (size_t at = 16; at + 16 <= size; at += 8) {
        for (int value = 0; value < 3; ++value) { /* joints there are: one */
            memcpy(made, bytes, size);
            memset(made + at, value == 2 ? 0xFF : 0, 4);
            made[at] = (unsigned char)(value == 2 ? 0xFF : value);
            const uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, made, size - 8);
            for (int k = 0; k < 8; ++k) {
                made[size - 8 + (size_t)k] = (unsigned char)(sum >> (8 * k));
            }
            if (se3d_solver_read(w.solver, made, size) < 0) {
                continue;
            }
            ++taken;
            MUST(&w, se3d_solver_write(w.solver, made, sizeof made, &again));
            MUST(&w, se3d_solver_read(w.solver, made, again));
        }
    }
    CHECK(taken > 50);
    world_destroy(&w);
}

/* Which joints may break is the model's matter: it may be another one than in the last run. */
static void limits_that_change_after_a_run_do_not_spoil_its_bytes(void)
{
    for (int part = 0; part < 3; ++part) {
        const double force = part == 1 ? 0.0 : 1e6;
        se3d_constraint pin[2];
        se3d_body bob;
        world w = swing_up(force, &pin[0], &bob), v = swing_up(force, &pin[1], &bob);
        use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
        use(&v, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0);
        MUST(&w, se3d_solver_run(w.solver, 0.3));
        const double changed = part == 1 ? 2.2 * MASS * G : part == 2 ? 0.0 : 3.0 * MASS * G;
        MUST(&w, se3d_joint_set_break(w.system, pin[0], changed, 0.0));
        MUST(&v, se3d_joint_set_break(v.system, pin[1], changed, 0.0));
        carry(&w, &v);
        hand_over(&w, &v);
        MUST(&w, se3d_solver_run(w.solver, 1.2));
        MUST(&v, se3d_solver_run(v.solver, 1.2));
        CHECK(se3d_system_hash(w.system) == se3d_system_hash(v.system));
        CHECK(se3d_solver_count_event_records(v.solver) == (part == 1 ? 1u : 0u));
        world_destroy(&w);
        world_destroy(&v);
    }
}

static void a_joint_is_broken_and_mended_by_hand(void)
{
    se3d_constraint pin;
    se3d_body bob;
    double r[3];
    int32_t broken;
    se3d_joint_def def = se3d_joint_def_default();
    world w = swing_up(0.0, &pin, &bob);
    use(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT, 0.0);
    MUST(&w, se3d_solver_run(w.solver, 0.2));
    MUST(&w, se3d_joint_set_broken(w.system, pin, 1));
    MUST(&w, se3d_joint_get_broken(w.system, pin, &broken));
    CHECK(broken == 1);
    MUST(&w, se3d_solver_run(w.solver, 0.4));
    MUST(&w, se3d_body_get_position(w.system, bob, r));
    CHECK(hypot(r[0], r[1]) > 1.01 * LENGTH);
    MUST(&w, se3d_joint_get_def(w.system, pin, &def));
    MUST(&w, se3d_joint_set_def(w.system, pin, &def));
    MUST(&w, se3d_joint_get_broken(w.system, pin, &broken));
    CHECK(broken == 1);
    MUST(&w, se3d_joint_set_broken(w.system, pin, 0));
    MUST(&w, se3d_joint_set_def(w.system, pin, &def));
    MUST(&w, se3d_joint_get_broken(w.system, pin, &broken));
    CHECK(broken == 0);
    MUST(&w, se3d_solver_run(w.solver, 0.6));
    MUST(&w, se3d_body_get_position(w.system, bob, r));
    CHECK_NEAR(hypot(r[0], r[1]), LENGTH, 1e-9);
    CHECK(se3d_solver_count_event_records(w.solver) == 0);
    world_destroy(&w);
}

/* A limit that is set below the load breaks the joint where the next run begins. */
static void a_limit_that_is_passed_already_breaks_at_once(void)
{
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        se3d_constraint pin;
        se3d_body bob;
        se3d_event_record record = {0};
        world w = swing_up(0.0, &pin, &bob);
        use(&w, methods[m].method, SE3D_FORMULATION_ROMEGA, methods[m].step);
        MUST(&w, se3d_solver_run(w.solver, 0.5));
        MUST(&w, se3d_joint_set_break(w.system, pin, 1.0, 0.0));
        MUST(&w, se3d_solver_run(w.solver, 0.6));
        CHECK(se3d_solver_count_event_records(w.solver) == 1);
        (void)se3d_solver_get_event_record(w.solver, 0, &record);
        CHECK_NEAR(record.time, 0.5, 1e-15);
        CHECK(record.value > 1.5);
        world_destroy(&w);
    }
}

static void kinematics_and_joints_with_armatures_are_refused(void)
{
    se3d_constraint pin, motor;
    se3d_body bob;
    se3d_driver_def drive = se3d_driver_def_default();
    se3d_solver_def def = se3d_solver_def_default();
    se3d_armature_def armature = se3d_armature_def_default();
    se3d_force force;
    world w = swing_up(100.0, &pin, &bob);
    drive.joint = pin;
    MUST(&w, se3d_driver_create(w.system, &drive, &motor));
    CHECK(se3d_joint_set_break(w.system, motor, 1.0, 0.0) == SE3D_ERR_INVALID_ARGUMENT);
    def.analysis = SE3D_ANALYSIS_KINEMATICS;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    CHECK(se3d_solver_run(w.solver, 1.0) == SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "'pin' (revolute) may break");
    MUST(&w, se3d_joint_set_break(w.system, pin, 0.0, 0.0));
    CHECK(se3d_solver_run(w.solver, 1.0) == SE3D_OK);
    MUST(&w, se3d_joint_set_break(w.system, pin, 0.0, 5.0));
    armature.joint = pin;
    armature.inertia = 0.1;
    MUST(&w, se3d_force_create_armature(w.system, &armature, &force));
    use(&w, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0);
    CHECK(se3d_solver_run(w.solver, 2.0) == SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "armature");
    world_destroy(&w);
}

int main(void)
{
    RUN(a_pendulum_breaks_at_the_angle_of_its_limit_by_every_method);
    RUN(what_broke_stays_broken_in_copies_and_is_whole_in_what_was_before);
    RUN(a_solver_that_is_written_and_read_knows_what_broke_and_what_will);
    RUN(the_first_link_of_a_chain_that_is_pulled_breaks);
    RUN(rods_of_a_bridge_break_in_a_cascade);
    RUN(what_acts_on_a_joint_ends_with_it_and_its_spring_is_lost);
    RUN(a_driver_of_signals_ends_with_its_joint);
    RUN(what_is_made_on_a_broken_joint_does_nothing);
    RUN(an_armature_on_a_broken_joint_is_refused);
    RUN(a_broken_joint_that_is_removed_leaves_no_trace);
    RUN(a_record_outlives_its_joint_and_solvers_that_are_read);
    RUN(made_up_places_of_joints_do_no_harm);
    RUN(limits_that_change_after_a_run_do_not_spoil_its_bytes);
    RUN(a_joint_is_broken_and_mended_by_hand);
    RUN(a_limit_that_is_passed_already_breaks_at_once);
    RUN(kinematics_and_joints_with_armatures_are_refused);
    return check_finish();
}
