/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies at rest sleep in convex: they stay to the bit, wake when something touches or changes
 * them, and what happens is what happens without. */
#include "support/scene.h"
#include "support/text_model.h"

#define STEP 1e-3
#define HIGH 5

typedef struct pile {
    scene s;
    se3d_body box[HIGH + 2]; /* a stack, one beside it, a ball above that falls later */
} pile;

static void solve(pile *p, int sleep)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_CONVEX;
    def.step = STEP;
    def.sleep = sleep;
    CHECK(se3d_solver_create(p->s.system, &def, &p->s.solver) == SE3D_OK);
}

static pile pile_up(int sleep, double high)
{
    const double size[3] = {0.1, 0.1, 0.1};
    pile p = {.s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5)};
    se3d_contact_settings settings = se3d_contact_settings_default();
    settings.overlap_limit = 0.5; /* the ball is fast */
    CHECK(se3d_system_set_contact(p.s.system, &settings) == SE3D_OK);
    for (int k = 0; k < HIGH; ++k) {
        const double r[3] = {1e-3 * (k % 2), 0.0, 0.05 + 0.1001 * k};
        p.box[k] = scene_box(&p.s, size, 1.0, r, scene_zero);
    }
    const double beside[3] = {5.0, 0.0, 0.05}, above[3] = {0.0, 0.0, high};
    p.box[HIGH] = scene_box(&p.s, size, 1.0, beside, scene_zero);
    p.box[HIGH + 1] = scene_ball(&p.s, 0.1, 0.02, above, scene_zero);
    scene_floor(&p.s, 0.0);
    solve(&p, sleep);
    return p;
}

static double speed(const pile *p, int k)
{
    double v[3];
    CHECK(se3d_body_get_velocity(p->s.system, p->box[k], v) == SE3D_OK);
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static int count_still(const pile *p)
{
    int still = 0;
    for (int k = 0; k <= HIGH; ++k) {
        const double v = speed(p, k);
        still += !(v > 0.0);
    }
    return still;
}

static double gap(const pile *p)
{
    se3d_energy energy;
    se3d_work work;
    CHECK(se3d_system_get_energy(p->s.system, &energy) == SE3D_OK);
    CHECK(se3d_system_get_work(p->s.system, &work) == SE3D_OK);
    return energy.total + work.dissipated - work.actuators - work.drivers;
}

/* The ball is still falling: the others have come to rest. */
static void what_rests_sleeps_and_is_where_it_is_without(void)
{
    pile p = pile_up(1, 100.0), q = pile_up(0, 100.0);
    double r[3], u[3], before[3], force[3], torque[3];
    scene_run(&p.s, 1.45);
    scene_run(&q.s, 1.45);
    CHECK(count_still(&p) == HIGH + 1 && count_still(&q) == 0);
    CHECK(speed(&p, HIGH + 1) > 12.0);
    for (int k = 0; k <= HIGH; ++k) {
        CHECK(se3d_body_get_position(p.s.system, p.box[k], r) == SE3D_OK);
        CHECK(se3d_body_get_position(q.s.system, q.box[k], u) == SE3D_OK);
        for (int c = 0; c < 3; ++c) {
            CHECK_NEAR(r[c], u[c], 2e-6);
        }
        CHECK(se3d_body_get_contact_wrench(p.s.system, p.box[k], force, torque) == SE3D_OK);
        CHECK_NEAR(force[2], G, 1e-3 * G);
    }
    CHECK(se3d_system_count_contacts(p.s.system) == se3d_system_count_contacts(q.s.system));
    CHECK(se3d_body_get_position(p.s.system, p.box[2], before) == SE3D_OK);
    scene_run(&p.s, 1.5);
    CHECK(se3d_body_get_position(p.s.system, p.box[2], r) == SE3D_OK);
    CHECK(memcmp(r, before, sizeof r) == 0);
    CHECK_NEAR(gap(&p), gap(&q), 1e-5);
    scene_end(&p.s);
    scene_end(&q.s);
}

/* Both piles to t, where the uppermost boxes are as fast; how fast. */
static double run_both(pile *p, pile *q, double t)
{
    double v[3], w[3];
    scene_run(&p->s, t);
    scene_run(&q->s, t);
    CHECK(se3d_body_get_velocity(p->s.system, p->box[HIGH - 1], v) == SE3D_OK);
    CHECK(se3d_body_get_velocity(q->s.system, q->box[HIGH - 1], w) == SE3D_OK);
    CHECK_NEAR(v[2], w[2], 1e-3 + 0.02 * fabs(w[2]));
    return fabs(v[2]);
}

/* It falls onto the stack after 1.52 s: the same step sees it as without sleep, and the box beside
 * goes on sleeping. */
static void what_is_touched_wakes_with_its_island(void)
{
    pile p = pile_up(1, 12.0), q = pile_up(0, 12.0);
    double most = 0.0;
    scene_run(&p.s, 1.5);
    scene_run(&q.s, 1.5);
    CHECK(count_still(&p) == HIGH + 1);
    for (double t = 1.5 + STEP; t < 1.6; t += STEP) {
        most = fmax(most, run_both(&p, &q, t));
    }
    CHECK(most > 0.02);
    CHECK(count_still(&p) == 1 && !(speed(&p, HIGH) > 0.0));
    scene_end(&p.s);
    scene_end(&q.s);
}

static void what_is_set_wakes(void)
{
    const double push[3] = {0.5, 0.0, 0.0}, down[3] = {0.0, 3.0, -G};
    pile p = pile_up(1, 100.0);
    double r[3], u[3];
    scene_run(&p.s, 1.6);
    CHECK(count_still(&p) == HIGH + 1);
    CHECK(se3d_body_get_position(p.s.system, p.box[HIGH], r) == SE3D_OK);
    CHECK(se3d_body_set_velocity(p.s.system, p.box[HIGH], push) == SE3D_OK);
    scene_run(&p.s, 1.7);
    CHECK(se3d_body_get_position(p.s.system, p.box[HIGH], u) == SE3D_OK);
    CHECK(u[0] > r[0] + 5e-3);
    scene_run(&p.s, 3.2);
    CHECK(count_still(&p) == HIGH + 1);
    CHECK(se3d_system_set_gravity(p.s.system, down) == SE3D_OK); /* below the angle of friction */
    scene_run(&p.s, 3.2 + 2.0 * STEP);
    CHECK(count_still(&p) == 0);
    scene_end(&p.s);
}

/* What a load acts on does not sleep, nor what it touches. */
static void what_loads_may_move_stays_awake(void)
{
    pile p = pile_up(1, 100.0);
    se3d_load_def load = se3d_load_def_default();
    se3d_force force;
    double v[3];
    CHECK(se3d_function_create_expression(p.s.system, "max(0, 20*(t - 1.6))", &load.function[0]) ==
          SE3D_OK);
    load.body = p.box[HIGH];
    CHECK(se3d_force_create_load(p.s.system, &load, &force) == SE3D_OK);
    scene_run(&p.s, 1.6);
    CHECK(count_still(&p) == HIGH);
    scene_run(&p.s, 2.0);
    CHECK(se3d_body_get_velocity(p.s.system, p.box[HIGH], v) == SE3D_OK);
    CHECK(v[0] > 0.1); /* it slides from 1.845 s on */
    scene_end(&p.s);
}

static void a_snapshot_knows_what_sleeps(void)
{
    pile p = pile_up(1, 100.0);
    se3d_snapshot *snapshot = NULL;
    scene_run(&p.s, 1.6);
    CHECK(se3d_snapshot_create(p.s.system, &snapshot) == SE3D_OK);
    scene_run(&p.s, 2.2);
    const uint64_t hash = se3d_system_hash(p.s.system);
    CHECK(se3d_snapshot_restore(snapshot, p.s.system) == SE3D_OK);
    CHECK(count_still(&p) == HIGH + 1);
    scene_run(&p.s, 2.2);
    CHECK(se3d_system_hash(p.s.system) == hash);
    se3d_snapshot_destroy(snapshot);
    scene_end(&p.s);
}

/* The ball hangs on a rod above the stack, is pulled ever harder, and falls when the rod breaks. */
static double drop(pile *p, int sleep)
{
    se3d_joint_def rod = se3d_joint_def_default();
    se3d_load_def load = se3d_load_def_default();
    se3d_constraint made;
    se3d_force force;
    *p = pile_up(sleep, 0.9);
    rod.body_i = scene_ground(&p->s);
    rod.body_j = p->box[HIGH + 1];
    rod.point_i[2] = 2.0;
    rod.distance = 1.1;
    rod.break_force = 0.6;
    CHECK(se3d_joint_create_distance(p->s.system, &rod, &made) == SE3D_OK);
    CHECK(se3d_function_create_expression(p->s.system, "-0.25*t", &load.function[2]) == SE3D_OK);
    load.body = p->box[HIGH + 1];
    CHECK(se3d_force_create_load(p->s.system, &load, &force) == SE3D_OK);
    return (0.6 - 0.02 * G) / 0.25;
}

static void a_joint_that_breaks_wakes_what_its_load_falls_on(void)
{
    pile p, q;
    double most = 0.0;
    se3d_event_record record;
    se3d_snapshot *snapshot = NULL;
    const double when = drop(&p, 1); /* 1.615 s; it falls by 0.3 m */
    CHECK_NEAR(drop(&q, 0), when, 0.0);
    scene_run(&p.s, 1.6);
    scene_run(&q.s, 1.6);
    CHECK(count_still(&p) == HIGH + 1);
    for (int k = 0; k < 300; ++k) { /* what breaks wakes all: those that are not hit sleep again */
        const double t = 1.6 + STEP * (k + 1);
        if (k == 100) {
            CHECK(se3d_snapshot_create(p.s.system, &snapshot) == SE3D_OK);
        }
        most = fmax(most, run_both(&p, &q, t));
    }
    CHECK(se3d_solver_count_event_records(p.s.solver) == 1);
    CHECK(se3d_solver_get_event_record(p.s.solver, 0, &record) == SE3D_OK);
    CHECK_NEAR(record.time, when, 1.5 * STEP);
    CHECK(most > 0.02);
    CHECK(!(speed(&p, HIGH) > 0.0));
    const uint64_t hash = se3d_system_hash(p.s.system);
    CHECK(se3d_snapshot_restore(snapshot, p.s.system) == SE3D_OK);
    for (int k = 100; k < 300; ++k) {
        scene_run(&p.s, 1.6 + STEP * (k + 1));
    }
    CHECK(se3d_system_hash(p.s.system) == hash);
    se3d_snapshot_destroy(snapshot);
    scene_end(&p.s);
    scene_end(&q.s);
}

/* Two rods with a stop and friction in their joint lie on the ground, a pendulum swings elsewhere,
 * or what would be one falls, and a ball falls on one of the rods at 1.43 s; %s: what the joint is
 * loaded with. */
static text_model lay_down(int sleep, const char *load, int swings)
{
    char text[2048];
    (void)snprintf(
        text, sizeof text,
        "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.5, restitution: 0.3, stiffness: "
        "1.0e+6}]\ncontact: {overlap_limit: 0.5}\nbodies:\n"
        "  - {name: ground, shapes: [{type: plane, material: m}]}\n"
        "  - {name: a, position: [0, 0, 0.0501], shapes: [{type: box, size: [0.4, 0.1, 0.1], "
        "material: m}]}\n"
        "  - {name: b, position: [0.45, 0, 0.0501], shapes: [{type: box, size: [0.4, 0.1, 0.1], "
        "material: m}]}\n"
        "  - {name: p, mass: 1, inertia: [0.01, 0.01, 0.01], position: [-3, 0, 3]}\n"
        "  - {name: c, position: [0.6, 0, 10.2], shapes: [{type: sphere, radius: 0.05, material: "
        "m}]}\njoints:\n"
        "  - {name: j, type: revolute, body_i: a, body_j: b, at: [0.225, 0, 0.05], axis: [0, 1, "
        "0]}\n%s"
        "forces:\n  - {name: s, type: stop, joint: j, lower: -0.001, upper: 1, k: 1.0e+4, "
        "restitution: 0.1}\n"
        "  - {name: f, type: friction, joint: j, limit: 0.5, viscous: 0.1}\n"
        "  - {name: e, type: effort, joint: j, value: %s}\n"
        "analysis: {type: dynamics, duration: 3, sleep: %s}\noutput: [{file: r.csv, channels: "
        "[a.position, b.position, b.velocity, p.position, j.force, energy.balance, f.force]}]\n",
        swings ? "  - {name: q, type: revolute, body_i: ground, body_j: p, at: [-2, 0, 3], axis: "
                 "[0, 1, 0]}\n"
               : "",
        load, sleep ? "true" : "false");
    return text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
}

static void get_vector(const text_model *m, size_t channel, double out[3])
{
    for (size_t k = 0; k < 3; ++k) {
        out[k] = text_model_get(m, channel, k);
    }
}

static int is_still(const text_model *m)
{
    double v[3];
    get_vector(m, 2, v);
    return !(fabs(v[0]) + fabs(v[1]) + fabs(v[2]) > 0.0);
}

static uint64_t count_factors(const text_model *m)
{
    se3d_solver_stats stats;
    CHECK(se3d_solver_get_stats(m->solver, &stats) == SE3D_OK);
    return stats.factorizations;
}

/* To the bit, and the motion of what is awake does not depend on it. While no constraint acts on
 * that, none is solved for. */
static void sleep_until_something_falls(const char *load, int swings)
{
    text_model p = lay_down(1, load, swings), q = lay_down(0, load, swings);
    double first[5][3], now[3], other[3], most = 0.0;
    CHECK(text_model_run(&p, 1.2) && text_model_run(&q, 1.2));
    CHECK(is_still(&p) && !is_still(&q));
    for (size_t k = 0; k < 5; ++k) {
        get_vector(&p, k, first[k]);
    }
    const uint64_t factors = count_factors(&p);
    CHECK(text_model_run(&p, 1.4) && text_model_run(&q, 1.4));
    CHECK(swings ? count_factors(&p) > factors : count_factors(&p) == factors);
    for (size_t k = 0; k < 5; ++k) {
        get_vector(&p, k, now);
        get_vector(&q, k, other);
        for (int c = 0; c < 3; ++c) {
            CHECK(k == 3 || !(fabs(now[c] - first[k][c]) > 0.0));
            CHECK_NEAR(now[c], other[c], k == 4 ? 0.05 : k == 3 ? 1e-13 : 1e-5);
        }
    }
    for (int step = 1; step <= 200; ++step) {
        CHECK(text_model_run(&p, 1.4 + STEP * step) && text_model_run(&q, 1.4 + STEP * step));
        get_vector(&p, 2, now);
        get_vector(&q, 2, other);
        for (int c = 0; c < 3; ++c) {
            most = fmax(most, fabs(now[c]));
            CHECK_NEAR(now[c], other[c], 1e-3 + 0.02 * fabs(other[c]));
        }
        CHECK_NEAR(text_model_get(&p, 5, 0), text_model_get(&q, 5, 0), 1e-6);
    }
    CHECK(most > 0.1);
    text_model_close(&p);
    text_model_close(&q);
}

/* Also with loads that are functions of their joint alone. */
static void machines_at_rest_sleep_until_something_falls_on_them(void)
{
    sleep_until_something_falls("0.2", 1);
    sleep_until_something_falls("0.2", 0);
    sleep_until_something_falls("0.2 - 0.05*qdot - 0.3*q", 1);
}

/* What is loaded by a function of time stays awake, with all that is joined to it. */
static void machines_that_something_may_move_stay_awake(void)
{
    text_model p = lay_down(1, "30*t", 1);
    CHECK(text_model_run(&p, 1.2));
    CHECK(!is_still(&p));
    text_model_close(&p);
}

/* A box glides and turns on ice, slower than what falls asleep: what it moves with is lost. */
static void what_it_moved_with_is_counted(void)
{
    text_model m = text_model_open(
        "se3d: 1\nmaterials: [{name: ice, density: 1000, friction: 0, restitution: 0.3, stiffness: "
        "1.0e+6}]\ncontact: {}\nbodies:\n"
        "  - {name: ground, shapes: [{type: plane, material: ice}]}\n"
        "  - {name: a, position: [0, 0, 0.05], velocity: [5.0e-6, 0, 0], angular_velocity: [0, 0, "
        "3.0e-5], shapes: [{type: box, size: [0.2, 0.1, 0.1], material: ice}]}\n"
        "analysis: {type: dynamics, duration: 3, sleep: true}\noutput: [{file: r.csv, channels: "
        "[a.velocity, energy.balance, energy.kinetic]}]\n",
        SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
    double before = 0.0, moves = 0.0;
    int step = 0;
    for (; step < 2000 && (step == 0 || fabs(text_model_get(&m, 0, 0)) > 0.0); ++step) {
        before = step ? text_model_get(&m, 1, 0) : 0.0;
        moves = step ? text_model_get(&m, 2, 0) : 0.0;
        CHECK(text_model_run(&m, STEP * (step + 1)));
    }
    CHECK(step > 250 && step < 2000);
    CHECK_NEAR(moves, 0.5 * 2.0 * (25e-12 + 0.05 / 12.0 * 9e-10), 1e-14);
    CHECK_NEAR(text_model_get(&m, 1, 0), before, 1e-14);
    text_model_close(&m);
}

int main(void)
{
    RUN(what_rests_sleeps_and_is_where_it_is_without);
    RUN(what_is_touched_wakes_with_its_island);
    RUN(what_is_set_wakes);
    RUN(what_loads_may_move_stays_awake);
    RUN(a_snapshot_knows_what_sleeps);
    RUN(machines_at_rest_sleep_until_something_falls_on_them);
    RUN(machines_that_something_may_move_stay_awake);
    RUN(what_it_moved_with_is_counted);
    RUN(a_joint_that_breaks_wakes_what_its_load_falls_on);
    return check_finish();
}
