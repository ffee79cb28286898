/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring and damper written as a callback, by the helpers for callbacks, is the tsda of the same
 * numbers: forces, energies, powers and works, in every method. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/methods.h"
#include "support/parts.h"

#include <math.h>

#define K    90.0 /* N/m */
#define C    0.75 /* N s/m */
#define L0   0.4  /* m */
#define PUSH 3.0  /* N, of an actuator within the spring */

static const double hook[3] = {0.3, 0.1, -0.2}, anchor[3] = {0.1, -0.2, 0.9};

/* The line from the anchor to the hook: its length, direction and rate. */
static double measure(const se3d_body_motion motion[2], double direction[3], double *rate)
{
    double at[2][3], v[2][3], length = 0.0;
    CHECK(!se3d_motion_get_point(&motion[0], anchor, at[0], v[0], NULL));
    CHECK(!se3d_motion_get_point(&motion[1], hook, at[1], v[1], NULL));
    for (int k = 0; k < 3; ++k) {
        length = hypot(length, at[1][k] - at[0][k]);
    }
    *rate = 0.0;
    for (int k = 0; k < 3; ++k) {
        direction[k] = (at[1][k] - at[0][k]) / length;
        *rate += direction[k] * (v[1][k] - v[0][k]);
    }
    return length;
}

static se3d_status pull(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *Kd, double *Dd)
{
    double e[3], force[3], against[3], rate;
    const double f = K * (measure(motion, e, &rate) - L0) + C * rate + PUSH;
    (void)ctx, (void)t, (void)Kd, (void)Dd;
    for (int k = 0; k < 3; ++k) {
        force[k] = f * e[k];
        against[k] = -force[k];
    }
    CHECK(!se3d_motion_add_force(&motion[0], anchor, force, wrench));
    return se3d_motion_add_force(&motion[1], hook, against, wrench + 6);
}

static se3d_status store(void *ctx, double t, const se3d_body_motion motion[2], double *potential,
                         double *dissipated)
{
    double e[3], rate;
    const double x = measure(motion, e, &rate) - L0;
    (void)t;
    *potential = 0.5 * K * x * x;
    *dissipated = C * rate * rate;
    return ctx ? SE3D_ERR_STATE : SE3D_OK;
}

/* h of a tsda: counts as an actuator, as what a callback does beside its energy. */
static se3d_function make_push(se3d_system *system)
{
    static const char *const names[3] = {"t", "l", "rate"};
    se3d_function_def h = se3d_function_def_default();
    se3d_function made;
    h.variables = names;
    h.variable_count = 3;
    h.constant = PUSH;
    CHECK(!se3d_function_create(system, &h, &made));
    return made;
}

static se3d_force add_force(se3d_system *system, int by_callback, se3d_body ground, se3d_body body)
{
    se3d_force made;
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force_callback_def user = se3d_force_callback_def_default();
    spring.body_i = user.body_i = ground;
    spring.body_j = user.body_j = body;
    memcpy(spring.point_i, anchor, sizeof anchor);
    memcpy(spring.point_j, hook, sizeof hook);
    spring.k = K;
    spring.c = C;
    spring.l0 = L0;
    spring.h = make_push(system);
    user.callback = pull;
    user.energy = store;
    CHECK(!(by_callback ? se3d_force_create_callback(system, &user, &made)
                        : se3d_force_create_tsda(system, &spring, &made)));
    return made;
}

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    se3d_force force;
} world;

static world build(int by_callback, int32_t method)
{
    world w = {0};
    const double spin[3] = {0.5, -1.0, 2.0}, v[3] = {0.2, 0.1, 0.0};
    se3d_body ground;
    se3d_solver_def how = se3d_solver_def_default();
    CHECK(!se3d_system_create(NULL, &w.system));
    CHECK(!se3d_system_get_ground(w.system, &ground));
    const se3d_body body = part_body(w.system, "swing", 0.1, 0.2);
    CHECK(!se3d_body_set_angular_velocity(w.system, body, spin));
    CHECK(!se3d_body_set_velocity(w.system, body, v));
    w.force = add_force(w.system, by_callback, ground, body);
    how.method = method;
    how.step = 1e-3;
    how.tolerance = 1e-8;
    CHECK(!se3d_solver_create(w.system, &how, &w.solver));
    return w;
}

static void finish(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
}

static void check_same(const world *user, const world *made, double within)
{
    se3d_energy energy[2];
    se3d_work work[2];
    double power[2][3];
    const world *both[2] = {user, made};
    for (int k = 0; k < 2; ++k) {
        CHECK(!se3d_system_get_energy(both[k]->system, &energy[k]));
        CHECK(!se3d_system_get_work(both[k]->system, &work[k]));
        CHECK(!se3d_force_get_power(both[k]->system, both[k]->force, &power[k][0], &power[k][1],
                                    &power[k][2]));
    }
    CHECK_NEAR(energy[0].potential, energy[1].potential, within);
    CHECK_NEAR(energy[0].dissipated, energy[1].dissipated, within);
    CHECK_NEAR(work[0].dissipated, work[1].dissipated, within);
    CHECK_NEAR(work[0].actuators, work[1].actuators, within);
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(power[0][k], power[1][k], 1e-7 + within);
    }
    CHECK(fabs(work[1].actuators) > 1e-3 && work[1].dissipated > 1e-3);
}

/* Methods of second order with steps of 1 ms integrate powers by the trapezoidal rule, of a
 * callback with that of its energy; convex linearises springs in a step, and callbacks not. */
static double tolerance_of(const char *method)
{
    static const char *const second[] = {"generalized_alpha", "hht", "rattle", "verlet"};
    double within = strcmp(method, "convex") == 0 ? 2e-2 : 1e-6;
    for (int k = 0; k < 4; ++k) {
        within = strcmp(method, second[k]) == 0 ? 1e-3 : within;
    }
    return within;
}

static void a_callback_accounts_as_the_element_that_it_is(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        const double within = tolerance_of(se3d_method_get_name(method));
        world user = build(1, method), made = build(0, method);
        for (int k = 1; k <= 3; ++k) {
            CHECK(se3d_solver_run(user.solver, 0.1 * k) >= 0);
            CHECK(se3d_solver_run(made.solver, 0.1 * k) >= 0);
            check_same(&user, &made, within);
        }
        finish(&user);
        finish(&made);
    }
}

/* A change of another element in the middle of a run, and the state in other hands. */
static void the_account_survives_edits_of_values_and_snapshots(void)
{
    const double g[3] = {1.0, 0.0, -3.0};
    world user = build(1, SE3D_METHOD_DOP853);
    se3d_snapshot *middle = NULL;
    CHECK(!se3d_solver_run(user.solver, 0.1));
    const double balance = part_balance(user.system);
    CHECK(!se3d_system_set_gravity(user.system, g));
    CHECK_NEAR(part_balance(user.system), balance, 1e-12);
    CHECK(!se3d_snapshot_create(user.system, &middle));
    CHECK(!se3d_solver_run(user.solver, 0.3));
    CHECK_NEAR(part_balance(user.system), balance, 1e-6);
    CHECK(!se3d_snapshot_restore(middle, user.system));
    CHECK_NEAR(part_balance(user.system), balance, 1e-12);
    CHECK(!se3d_solver_run(user.solver, 0.2));
    CHECK_NEAR(part_balance(user.system), balance, 1e-6);
    se3d_snapshot_destroy(middle);
    finish(&user);
}

/* What is added, moved or destroyed between two runs: works stay, or change with the energies. */
static void the_account_survives_edits_of_elements_and_states(void)
{
    const double away[3] = {5.0, 0.0, 0.0}, nearer[3] = {0.2, 0.0, 0.3};
    world user = build(1, SE3D_METHOD_DOP853);
    se3d_load_def load = se3d_load_def_default();
    se3d_force made;
    se3d_work before, after;
    load.body = part_body(user.system, "other", 3.0, 0.0);
    CHECK(!se3d_solver_run(user.solver, 0.5));
    CHECK(!se3d_system_get_work(user.system, &before));
    CHECK(fabs(before.actuators) > 1e-3);
    CHECK(!se3d_body_set_position(user.system, load.body, away));
    CHECK(!se3d_force_create_load(user.system, &load, &made));
    CHECK(!se3d_system_get_work(user.system, &after));
    CHECK_NEAR(after.actuators, before.actuators, 1e-12);
    CHECK_NEAR(after.dissipated, before.dissipated, 1e-12);

    se3d_body swing;
    se3d_snapshot *left = NULL;
    CHECK(!se3d_body_find(user.system, "swing", &swing));
    double balance = part_balance(user.system), g[3] = {0.0, 0.0, 0.0};
    CHECK(!se3d_system_set_gravity(user.system, g));
    balance = part_balance(user.system);
    CHECK(!se3d_body_set_position(user.system, swing, nearer));
    CHECK_NEAR(part_balance(user.system), balance, 1e-12);
    CHECK(!se3d_snapshot_create(user.system, &left));
    CHECK(!se3d_solver_run(user.solver, 0.6));
    CHECK(!se3d_snapshot_restore(left, user.system));
    CHECK_NEAR(part_balance(user.system), balance, 1e-12);
    CHECK(!se3d_force_destroy(user.system, user.force));
    CHECK_NEAR(part_balance(user.system), balance, 1e-12);
    se3d_snapshot_destroy(left);
    finish(&user);
}

static void an_energy_that_fails_ends_the_call(void)
{
    world user = build(1, SE3D_METHOD_DOP853);
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_energy energy;
    se3d_work work;
    double power;
    CHECK(!se3d_solver_run(user.solver, 0.1));
    CHECK(!se3d_force_get_callback(user.system, user.force, &def));
    CHECK(def.energy == store);
    def.ctx = &user;
    CHECK(!se3d_force_set_callback(user.system, user.force, &def));
    CHECK(se3d_system_get_energy(user.system, &energy) == SE3D_ERR_CALLBACK);
    CHECK(se3d_force_get_power(user.system, user.force, NULL, NULL, &power) == SE3D_ERR_CALLBACK);
    CHECK(se3d_system_get_work(user.system, &work) == SE3D_ERR_CALLBACK);
    CHECK(se3d_solver_run(user.solver, 0.2) == SE3D_ERR_CALLBACK);
    finish(&user);
}

/* Jacobian and centripetal acceleration against differences along a motion. */
static void points_of_motions_are_consistent(void)
{
    se3d_system *system = NULL;
    se3d_body_motion m;
    CHECK(!se3d_system_create(NULL, &system));
    const se3d_body body = part_body(system, "b", 0.3, -0.2);
    const double p[4] = {0.5, 0.5, -0.5, 0.5}, v[3] = {1.0, 2.0, 3.0}, w[3] = {0.5, -1.5, 1.0};
    CHECK(!se3d_body_set_orientation(system, body, p));
    CHECK(!se3d_body_set_velocity(system, body, v));
    CHECK(!se3d_body_set_angular_velocity(system, body, w));
    double A[9], at[3], ground[3], velocity[3], inward[3], jacobian[18];
    CHECK(!se3d_body_get_motion(system, body, &m));
    CHECK(!se3d_motion_get_rotation(&m, A));
    CHECK(!se3d_motion_get_point(&m, hook, at, velocity, inward));
    CHECK(!se3d_motion_get_jacobian(&m, hook, jacobian));
    CHECK(!se3d_body_get_point(system, body, hook, ground));
    for (int r = 0; r < 3; ++r) {
        double sum = 0.0, turned = m.r[r];
        for (int c = 0; c < 3; ++c) {
            sum += jacobian[6 * r + c] * v[c] + jacobian[6 * r + 3 + c] * w[c];
            turned += A[3 * r + c] * hook[c];
        }
        CHECK_NEAR(at[r], ground[r], 1e-15);
        CHECK_NEAR(turned, ground[r], 1e-15);
        CHECK_NEAR(sum, velocity[r], 1e-14);
    }
    /* w x (w x s) = w (w.s) - s (w.w), turned */
    const double ws = w[0] * hook[0] + w[1] * hook[1] + w[2] * hook[2];
    const double ww = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    for (int r = 0; r < 3; ++r) {
        double expected = 0.0;
        for (int c = 0; c < 3; ++c) {
            expected += A[3 * r + c] * (w[c] * ws - hook[c] * ww);
        }
        CHECK_NEAR(inward[r], expected, 1e-14);
    }
    double wrench[6] = {1.0, 0.0, 0.0, 0.0, 0.0, 2.0};
    const double torque[3] = {A[2], A[5], A[8]}; /* about the z axis of the body */
    CHECK(!se3d_motion_add_torque(&m, torque, wrench));
    CHECK_NEAR(wrench[5], 3.0, 1e-15);
    CHECK_NEAR(wrench[3], 0.0, 1e-15);
    se3d_system_destroy(system);
}

/* The tsda is made a weak one elsewhere, and then what it is in `made`. */
static void an_element_defined_again_is_one_built_so(void)
{
    world made = build(0, SE3D_METHOD_DOP853), other = build(0, SE3D_METHOD_DOP853);
    se3d_tsda_def def = se3d_tsda_def_default(), weak;
    CHECK(!se3d_force_get_tsda(other.system, other.force, &def));
    weak = def;
    weak.k = 1.0;
    weak.h = (se3d_function){0, 0};
    weak.point_i[0] = 2.0;
    CHECK(!se3d_force_set_tsda(other.system, other.force, &weak));
    CHECK(!se3d_solver_run(made.solver, 0.2));
    CHECK(!se3d_function_destroy(other.system, def.h)); /* nothing uses it any more */
    def.h = make_push(other.system);
    CHECK(!se3d_force_set_tsda(other.system, other.force, &def));
    CHECK(!se3d_solver_run(other.solver, 0.2));
    CHECK(se3d_system_hash(made.system) == se3d_system_hash(other.system));
    CHECK(se3d_function_destroy(other.system, def.h) == SE3D_ERR_IN_USE);
    finish(&made);
    finish(&other);
}

int main(void)
{
    RUN(a_callback_accounts_as_the_element_that_it_is);
    RUN(the_account_survives_edits_of_values_and_snapshots);
    RUN(the_account_survives_edits_of_elements_and_states);
    RUN(an_energy_that_fails_ends_the_call);
    RUN(points_of_motions_are_consistent);
    RUN(an_element_defined_again_is_one_built_so);
    return check_finish();
}
