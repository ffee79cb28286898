/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps on open trees leave accelerations and multipliers to be computed until somebody reads them:
 * nobody sees a difference, to the bit, whoever reads when, and whatever happens in between. */
#include "support/tree_world.h"

#include "se3d/se3d.h"

#include <string.h>

enum { TREES = 24, STEPS = 12, NUMBERS = 6 * TREE_BODIES_MAX + 6 * TREE_BODIES_MAX };
#define H 1e-3

static uint64_t tree; /* the mechanism that is looked at */
static int failures;  /* steps that failed on purpose */
static int32_t stepper = SE3D_METHOD_RK4;

typedef struct setting {
    tree_world world;
    se3d_system *system;
    se3d_solver *solver;
    uint64_t seed; /* of the efforts */
} setting;

static void add_effort(setting *s, se3d_constraint joint)
{
    se3d_effort_def def = se3d_effort_def_default();
    se3d_force force;
    def.joint = joint;
    def.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    if (se3d_force_create_effort(s->system, &def, &force) < 0) {
        def.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
        (void)se3d_force_create_effort(s->system, &def, &force); /* or the joint has neither */
    }
}

static se3d_solver *make_solver(se3d_system *system, int32_t method, int32_t formulation)
{
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    CHECK(!se3d_solver_create(system, &def, &solver));
    return solver;
}

static void begin(setting *s, uint64_t seed)
{
    tree_world_init(&s->world, seed, 1 + (int)(seed % TREE_BODIES_MAX), 0);
    s->system = s->world.system;
    s->seed = seed;
    for (int k = 0; k < s->world.joint_count; ++k) {
        add_effort(s, s->world.joints[k]);
    }
    s->solver = make_solver(s->system, stepper, SE3D_FORMULATION_JOINT);
}

static void end(setting *s)
{
    se3d_solver_destroy(s->solver);
    tree_world_destroy(&s->world);
}

static void push(setting *s, double scale)
{
    double values[TREE_BODIES_MAX];
    size_t count;
    CHECK(!se3d_effort_count(s->system, &count));
    for (size_t k = 0; k < count; ++k) {
        values[k] = scale * check_random(&s->seed);
    }
    CHECK(!se3d_effort_set_all(s->system, count, values));
}

static void step(setting *s)
{
    CHECK(!se3d_solver_step(s->solver, H));
}

/* All accelerations and multipliers. */
static size_t read_all(const se3d_system *system, const tree_world *w, double out[NUMBERS])
{
    size_t n = 0;
    for (int k = 1; k < w->count; ++k, n += 6) {
        CHECK(!se3d_body_get_acceleration(system, w->bodies[k], out + n));
        CHECK(!se3d_body_get_angular_acceleration(system, w->bodies[k], out + n + 3));
    }
    for (int k = 0; k < w->joint_count; ++k) {
        size_t count;
        CHECK(!se3d_constraint_count_equations(system, w->joints[k], &count));
        CHECK(!se3d_constraint_get_multipliers(system, w->joints[k], out + n));
        n += count;
    }
    return n;
}

static void check_same(const setting *a, const setting *b)
{
    double x[NUMBERS], y[NUMBERS];
    const size_t count = read_all(a->system, &a->world, x);
    CHECK(read_all(b->system, &b->world, y) == count);
    CHECK(memcmp(x, y, count * sizeof *x) == 0);
    CHECK(se3d_system_hash(a->system) == se3d_system_hash(b->system));
}

static void check_same_counts(const setting *a, const setting *b)
{
    se3d_solver_stats x, y;
    CHECK(!se3d_solver_get_stats(a->solver, &x));
    CHECK(!se3d_solver_get_stats(b->solver, &y));
    CHECK(x.evaluations == y.evaluations && x.steps == y.steps);
}

/* Every third step has the efforts of the one before it. */
static void readers_change_no_bit(void)
{
    setting a, b;
    double t, numbers[NUMBERS];
    begin(&a, tree);
    begin(&b, tree);
    for (int k = 0; k < STEPS; ++k) {
        if (k % 3 != 2) {
            push(&a, 5.0);
            push(&b, 5.0);
        }
        step(&a);
        step(&b);
        (void)read_all(a.system, &a.world, numbers);
    }
    check_same_counts(&a, &b);
    CHECK(!se3d_system_get_time(b.system, &t));
    CHECK(!se3d_solver_run(a.solver, t + 10.5 * H));
    CHECK(!se3d_solver_run(b.solver, t + 10.5 * H));
    check_same(&a, &b);
    end(&a);
    end(&b);
}

/* What a step has ended with is shown with the efforts of that step. */
static void later_efforts_do_not_act_before(void)
{
    setting a, b;
    double x[NUMBERS], y[NUMBERS];
    begin(&a, tree);
    begin(&b, tree);
    for (int k = 0; k < STEPS; ++k) {
        step(&a);
        step(&b);
        const size_t count = read_all(a.system, &a.world, x);
        push(&a, 5.0);
        push(&b, 5.0);
        CHECK(read_all(b.system, &b.world, y) == count);
        CHECK(memcmp(x, y, count * sizeof *x) == 0);
    }
    step(&a);
    step(&b);
    check_same(&a, &b);
    end(&a);
    end(&b);
}

static void clones_and_snapshots_go_on(void)
{
    setting a, b;
    se3d_snapshot *snapshot;
    begin(&a, tree);
    for (int k = 0; k < STEPS; ++k) {
        push(&a, 5.0);
        step(&a);
    }
    b = a;
    CHECK(!se3d_system_clone(a.system, &b.system));
    b.solver = make_solver(b.system, stepper, SE3D_FORMULATION_JOINT);
    b.world.system = b.system;
    CHECK(!se3d_snapshot_create(a.system, &snapshot));
    for (int k = 0; k < STEPS; ++k) {
        if (k != 1) {
            push(&a, 5.0);
            push(&b, 5.0);
        }
        step(&a);
        step(&b);
    }
    const uint64_t hash = se3d_system_hash(b.system);
    CHECK(se3d_system_hash(a.system) == hash);
    CHECK(!se3d_snapshot_restore(snapshot, a.system));
    CHECK(!se3d_snapshot_restore(snapshot, b.system));
    push(&a, 5.0);
    push(&b, 5.0);
    step(&a);
    step(&b);
    check_same(&a, &b);
    se3d_snapshot_destroy(snapshot);
    end(&a);
    end(&b);
}

/* The equations of the bodies give the same. */
static void they_are_those_of_the_bodies(void)
{
    setting a;
    se3d_system *copy;
    double t, x[NUMBERS], y[NUMBERS], most = 0.0, apart = 0.0;
    begin(&a, tree);
    for (int k = 0; k < 3; ++k) {
        push(&a, 5.0);
        step(&a);
    }
    CHECK(!se3d_system_clone(a.system, &copy));
    se3d_solver *solver = make_solver(copy, stepper, SE3D_FORMULATION_ROMEGA);
    CHECK(!se3d_system_get_time(copy, &t));
    CHECK(!se3d_solver_run(solver, t));
    const size_t count = read_all(a.system, &a.world, x);
    CHECK(read_all(copy, &a.world, y) == count);
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(y[k]));
        apart = fmax(apart, fabs(x[k] - y[k]));
    }
    CHECK(apart <= 1e-10 * most);
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
    end(&a);
}

/* Turns overflow. */
static se3d_status step_too_far(setting *s)
{
    push(s, 1e308);
    return se3d_solver_step(s->solver, 1.0);
}

/* And what it shows is what it has shown before. */
static void a_failure_comes_back(void)
{
    setting a, b;
    begin(&a, tree);
    begin(&b, tree);
    for (int k = 0; k < 2; ++k) {
        push(&a, 5.0);
        push(&b, 5.0);
        step(&a);
        step(&b);
    }
    if (step_too_far(&a) < 0) {
        ++failures;
        check_same(&a, &b);
        push(&b, 1.0); /* as many random numbers */
        push(&a, 5.0);
        push(&b, 5.0);
        step(&a);
        step(&b);
        check_same(&a, &b);
    }
    end(&a);
    end(&b);
}

static void solvers_take_turns(void)
{
    setting a, b;
    begin(&a, tree);
    begin(&b, tree);
    se3d_solver *const solvers[2] = {b.solver,
                                     make_solver(b.system, stepper, SE3D_FORMULATION_JOINT)};
    for (int k = 0; k < STEPS; ++k) {
        if (k % 3 != 2) {
            push(&a, 5.0);
            push(&b, 5.0);
        }
        step(&a);
        CHECK(!se3d_solver_step(solvers[k % 2], H));
    }
    check_same(&a, &b);
    se3d_solver_destroy(solvers[1]);
    end(&a);
    end(&b);
}

/* After the solver is gone, and at the same time by a run to the present time. */
static void what_is_left_outlives_its_solver(void)
{
    setting a, b;
    double x[NUMBERS], y[NUMBERS];
    begin(&a, tree);
    begin(&b, tree);
    push(&a, 5.0);
    push(&b, 5.0);
    step(&a);
    step(&b);
    const size_t count = read_all(a.system, &a.world, x);
    se3d_solver_destroy(b.solver);
    b.solver = NULL;
    CHECK(read_all(b.system, &b.world, y) == count);
    CHECK(memcmp(x, y, count * sizeof *x) == 0);
    end(&a);
    end(&b);
}

/* Of a value at a level that is never reached. */
static se3d_status find_time(void *ctx, const se3d_system *system, double *value)
{
    (void)ctx;
    return se3d_system_get_time(system, value);
}

static void watch(setting *s)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.value = find_time;
    def.level = 1e9;
    CHECK(!se3d_event_create(s->solver, &def, &event));
}

/* A step that is watched leaves nothing, one that is not does; works are summed alike. */
static void events_change_no_bit(void)
{
    static const int32_t methods[] = {SE3D_METHOD_RK4, SE3D_METHOD_RK45, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_GAUSS};
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
        setting a, b;
        se3d_work done[2];
        stepper = methods[m];
        begin(&a, tree);
        begin(&b, tree);
        watch(&b);
        for (int k = 0; k < STEPS; ++k) {
            if (k % 3 == 0) {
                push(&a, 5.0);
                push(&b, 5.0);
            }
            step(&a);
            step(&b);
        }
        check_same(&a, &b);
        CHECK(!se3d_system_get_work(a.system, &done[0]));
        CHECK(!se3d_system_get_work(b.system, &done[1]));
        CHECK(memcmp(&done[0], &done[1], sizeof done[0]) == 0);
        end(&a);
        end(&b);
    }
    stepper = SE3D_METHOD_RK4;
}

int main(void)
{
    for (tree = 1; tree <= TREES; ++tree) {
        RUN(readers_change_no_bit);
        RUN(later_efforts_do_not_act_before);
        RUN(clones_and_snapshots_go_on);
        RUN(they_are_those_of_the_bodies);
        RUN(a_failure_comes_back);
        RUN(solvers_take_turns);
        RUN(what_is_left_outlives_its_solver);
        RUN(events_change_no_bit);
    }
    CHECK(failures > TREES / 2);
    return check_finish();
}
