/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion that is continued is the same to the last bit, whoever continues it: the solver that
 * began it, a new one, one of a clone, or the first one after a snapshot was restored. By every
 * method, at equal steps and by error control, with redundant rows, friction and contact. */
#include "check.h"
#include "support/ball_on_floor.h"
#include "support/models.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLAIN, REDUNDANT, FRICTION, CONTACT, TURNS, MECHANISMS };

static const char *const mechanisms[MECHANISMS] = {"plain", "redundant", "friction", "contact",
                                                   "turns"};

static void add_ball(se3d_system *system)
{
    const double v[3] = {0.2, 0.0, 0.0};
    (void)add_ball_of(system, add_floor_of(system, 1000.0, 1e5, 0.0), 0.004, 0.105, v);
}

/* Two shafts behind each other on universal joints, a third on a ball, which turn many times. */
static void add_shafts(se3d_system *system, se3d_body shafts[3])
{
    se3d_body before;
    CHECK(!se3d_system_get_ground(system, &before));
    for (int k = 0; k < 3; ++k) {
        se3d_body_def def = se3d_body_def_default();
        se3d_joint_def joint = se3d_joint_def_default();
        se3d_constraint made;
        def.mass = 1.0;
        def.inertia[0] = 0.01;
        def.inertia[1] = 0.02;
        def.inertia[2] = 0.025;
        def.position[0] = 0.2 * (k + 1);
        def.angular_velocity[1] = 300.0;
        def.velocity[2] = -300.0 * def.position[0];
        CHECK(!se3d_body_create(system, &def, &shafts[k]));
        joint.body_i = before;
        joint.body_j = shafts[k];
        joint.point_i[0] = k > 0 ? 0.1 : 0.0;
        joint.point_j[0] = k > 0 ? -0.1 : -0.2;
        joint.axis_i[1] = joint.axis_j[0] = 1.0;
        joint.axis_i[2] = joint.axis_j[2] = 0.0;
        CHECK(!(k < 2 ? se3d_joint_create_universal(system, &joint, &made)
                      : se3d_joint_create_spherical(system, &joint, &made)));
        before = shafts[k];
    }
}

static se3d_system *make(int mechanism)
{
    support_model model;
    se3d_system *system = NULL;
    if (mechanism == TURNS) {
        se3d_body shafts[3];
        CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
        add_shafts(system, shafts);
        return system;
    }
    if (mechanism == CONTACT) {
        CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
        add_ball(system);
        return system;
    }
    support_model_make(&model, mechanism == REDUNDANT ? "four_bar" : "double_pendulum", 1);
    if (mechanism == FRICTION) {
        se3d_friction_def def = se3d_friction_def_default();
        se3d_force force;
        def.joint = model.joints[0];
        def.limit = 0.5;
        CHECK(se3d_force_create_friction(model.system, &def, &force) == SE3D_OK);
    }
    CHECK(se3d_system_clone(model.system, &system) == SE3D_OK);
    support_model_destroy(&model);
    return system;
}

typedef struct row {
    int32_t method, order;
} row;

static const row rows[] = {
    {SE3D_METHOD_GENERALIZED_ALPHA, 0},
    {SE3D_METHOD_HHT, 0},
    {SE3D_METHOD_DOP853, 0},
    {SE3D_METHOD_RK45, 0},
    {SE3D_METHOD_RK4, 0},
    {SE3D_METHOD_BDF, 0},
    {SE3D_METHOD_RADAU, 0},
    {SE3D_METHOD_RATTLE, 2},
    {SE3D_METHOD_RATTLE, 4},
    {SE3D_METHOD_VERLET, 0},
    {SE3D_METHOD_CONVEX, 0},
    {SE3D_METHOD_GAUSS, 8},
    {SE3D_METHOD_GAUSS, 16},
    {SE3D_METHOD_AUTO, 0},
};

typedef struct trial {
    int mechanism, adaptive;
    row method;
} trial;

static se3d_solver *solver_of(se3d_system *system, const trial *t)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = t->method.method;
    def.order = t->method.order;
    def.step = t->adaptive ? 0.0 : 1e-3;
    def.tolerance = t->adaptive ? 1e-5 : 0.0;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    return solver;
}

/* Bits of the motion from here on, and what the runs say. */
typedef struct course {
    uint64_t hash;
    int32_t status[3];
} course;

static course follow(se3d_system *system, se3d_solver *solver)
{
    static const double times[3] = {0.0213, 0.03, 0.0385};
    course c = {.hash = 0};
    for (int k = 0; k < 3; ++k) {
        c.status[k] = se3d_solver_run(solver, times[k]);
        c.hash = 31 * c.hash + se3d_system_hash(system);
    }
    return c;
}

/* What a program that is started anew does: the same model, the state from bytes. */
static course continue_elsewhere(const se3d_snapshot *snapshot, const trial *t)
{
    static unsigned char bytes[100000];
    se3d_system *system = make(t->mechanism);
    se3d_snapshot *read = NULL;
    size_t size = 0;
    CHECK(se3d_snapshot_write(snapshot, NULL, 0, &size) == SE3D_OK && size <= sizeof bytes);
    CHECK(se3d_snapshot_write(snapshot, bytes, size - 1, &size) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_snapshot_write(snapshot, bytes, sizeof bytes, &size) == SE3D_OK);
    CHECK(se3d_snapshot_read(system, bytes, size, &read) == SE3D_OK);
    CHECK(se3d_snapshot_restore(read, system) == SE3D_OK);
    se3d_snapshot_destroy(read);
    se3d_solver *solver = solver_of(system, t);
    const course found = follow(system, solver);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return found;
}

static int is_same(const course *a, const course *b)
{
    return a->hash == b->hash && memcmp(a->status, b->status, sizeof a->status) == 0;
}

static void check_trial(const trial *t)
{
    se3d_system *system = make(t->mechanism), *clone = NULL;
    se3d_solver *solver = solver_of(system, t);
    se3d_snapshot *snapshot = NULL;
    const se3d_status begun = se3d_solver_run(solver, 0.0137);
    CHECK(begun >= 0);
    CHECK(se3d_system_clone(system, &clone) == SE3D_OK);
    CHECK(se3d_snapshot_create(system, &snapshot) == SE3D_OK);
    se3d_solver *other = solver_of(clone, t);
    const course first = follow(system, solver), cloned = follow(clone, other);
    CHECK(se3d_snapshot_restore(snapshot, system) == SE3D_OK);
    const course again = follow(system, solver);
    se3d_solver_destroy(solver);
    CHECK(se3d_snapshot_restore(snapshot, system) == SE3D_OK);
    solver = solver_of(system, t);
    const course renewed = follow(system, solver);
    const course elsewhere = continue_elsewhere(snapshot, t);
    const int holds = is_same(&first, &cloned) && is_same(&first, &again) &&
                      is_same(&first, &renewed) && is_same(&first, &elsewhere) &&
                      first.status[0] >= 0;
    CHECK(holds);
    CHECK(t->mechanism != REDUNDANT || cloned.status[2] == SE3D_INFO_REDUNDANT);
    if (!holds) {
        fprintf(stderr,
                "%s, method %d, adaptive %d: clone %d, restored %d, new %d, elsewhere %d, "
                "status %d\n",
                mechanisms[t->mechanism], (int)t->method.method, t->adaptive,
                is_same(&first, &cloned), is_same(&first, &again), is_same(&first, &renewed),
                is_same(&first, &elsewhere), (int)first.status[0]);
    }
    se3d_solver_destroy(solver);
    se3d_solver_destroy(other);
    se3d_snapshot_destroy(snapshot);
    se3d_system_destroy(clone);
    se3d_system_destroy(system);
}

static void whoever_continues_gets_the_same_bits(void)
{
    for (int mechanism = 0; mechanism < MECHANISMS; ++mechanism) {
        for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
            for (int adaptive = 0; adaptive < 2; ++adaptive) {
                const trial t = {mechanism, adaptive, rows[k]};
                if (mechanism < FRICTION || rows[k].order != 4) { /* back in time */
                    check_trial(&t);
                }
            }
        }
    }
}

static void get_signs(const se3d_system *system, const se3d_body shafts[3], double p[12])
{
    for (int k = 0; k < 3; ++k) {
        CHECK(!se3d_body_get_orientation(system, shafts[k], p + 4 * k));
    }
}

/* p and -p are the same pose; whatever begins anew on the way keeps the one that was shown. */
static void bodies_keep_the_sign_of_p(void)
{
    for (int32_t method = 0; *se3d_method_get_name(method); ++method) {
        for (int start = 0; start < 2; ++start) {
            const trial t = {TURNS, 1, {method, 0}};
            se3d_system *system = NULL;
            se3d_body shafts[3];
            double before[12], after[12];
            CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
            add_shafts(system, shafts);
            for (int k = 0; start > 0 && k < 3; ++k) {
                static const double other[4] = {-1.0, 0.0, 0.0, 0.0};
                CHECK(!se3d_body_set_orientation(system, shafts[k], other));
            }
            get_signs(system, shafts, before);
            for (int k = 1; k < 50; ++k) {
                se3d_solver *solver = solver_of(system, &t);
                CHECK(se3d_solver_run(solver, 1e-3 * k) >= 0);
                get_signs(system, shafts, after);
                for (int b = 0; b < 3; ++b) {
                    const double *p = before + 4 * b, *q = after + 4 * b;
                    CHECK(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] > 0.5);
                }
                memcpy(before, after, sizeof before);
                if (k % 3 == 0) {
                    CHECK(!se3d_system_touch(system));
                }
                se3d_solver_destroy(solver);
            }
            se3d_system_destroy(system);
        }
    }
}

/* In the plane x-z: a parallelogram, whose bars meet on a line as it falls, and another. */
static const double folding[4][2] = {{0.0, 0.0}, {0.6, 0.8}, {2.6, 0.8}, {2.0, 0.0}};
static const double swinging[4][2] = {{0.0, 0.0}, {0.3, 0.4}, {1.6, 1.1}, {2.0, 0.0}};

static se3d_body add_bar(se3d_system *system, const double from[2], const double to[2])
{
    const double x = to[0] - from[0], z = to[1] - from[1];
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    def.mass = 9.865 * sqrt(x * x + z * z);
    def.inertia[0] = def.inertia[1] = def.inertia[2] = def.mass * (x * x + z * z) / 12.0;
    def.position[0] = 0.5 * (from[0] + to[0]);
    def.position[2] = 0.5 * (from[1] + to[1]);
    CHECK(!se3d_body_create(system, &def, &body));
    return body;
}

static void pin(se3d_system *system, const se3d_body bodies[2], const double at[2])
{
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint made;
    double *const points[2] = {def.point_i, def.point_j};
    def.body_i = bodies[0];
    def.body_j = bodies[1];
    for (int k = 0; k < 2; ++k) {
        double r[3] = {0.0, 0.0, 0.0};
        CHECK(!se3d_body_get_position(system, bodies[k], r));
        points[k][0] = at[0] - r[0];
        points[k][2] = at[1] - r[2];
    }
    def.axis_i[1] = def.axis_j[1] = 1.0;
    def.axis_i[2] = def.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_revolute(system, &def, &made));
}

static se3d_system *make_four_bar(const double p[4][2])
{
    static const double gravity[3] = {0.0, 0.0, -9.81};
    se3d_system *system = NULL;
    se3d_body chain[5];
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_set_gravity(system, gravity));
    CHECK(!se3d_system_get_ground(system, &chain[0]));
    for (int k = 0; k < 3; ++k) {
        chain[k + 1] = add_bar(system, p[k], p[k + 1]);
    }
    chain[4] = chain[0];
    for (int k = 0; k < 4; ++k) {
        pin(system, chain + k, p[k]);
    }
    return system;
}

static se3d_solver *gauss_of(se3d_system *system, int32_t formulation, double tolerance)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = SE3D_METHOD_GAUSS;
    def.formulation = formulation;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(system, &def, &solver));
    return solver;
}

/* Stages in lanes leave no factors of the state: a solver that has made such steps knows no more of
 * dependent rows than one that has not. */
static void steps_of_loops_in_lanes_go_on_alike(void)
{
    static const int32_t formulations[] = {SE3D_FORMULATION_JOINT, SE3D_FORMULATION_AUTO};
    for (int f = 0; f < 2; ++f) {
        se3d_system *system = make_four_bar(folding), *clone = NULL;
        se3d_solver *solver = gauss_of(system, formulations[f], 1e-12), *other;
        for (int k = 0; k < 20; ++k) {
            CHECK(se3d_solver_step(solver, 0.02) >= 0);
        }
        CHECK(!se3d_system_clone(system, &clone));
        other = gauss_of(clone, formulations[f], 1e-12);
        for (int k = 20; k < 23; ++k) {
            CHECK(se3d_solver_step(solver, 0.02) >= 0 && se3d_solver_step(other, 0.02) >= 0);
            CHECK(se3d_system_hash(system) == se3d_system_hash(clone));
        }
        se3d_solver_destroy(solver);
        se3d_solver_destroy(other);
        se3d_system_destroy(clone);
        se3d_system_destroy(system);
    }
}

/* Functions of gravity come and go without a rebuild: they do not choose the formulation. */
static void gravity_that_begins_or_ends_to_vary_starts_nothing_anew(void)
{
    for (int begins = 0; begins < 2; ++begins) {
        se3d_system *system = make_four_bar(swinging), *clone = NULL;
        se3d_function varying[3] = {{0}, {0}, {0}}, none[3] = {{0}, {0}, {0}};
        CHECK(!se3d_function_create_expression(system, "0.5*sin(t)", &varying[0]));
        CHECK(!se3d_system_set_gravity_function(system, begins ? none : varying));
        se3d_solver *solver = gauss_of(system, SE3D_FORMULATION_AUTO, 1e-8), *other;
        CHECK(se3d_solver_run(solver, 0.25) >= 0);
        CHECK(!se3d_system_set_gravity_function(system, begins ? varying : none));
        CHECK(!se3d_system_clone(system, &clone));
        other = gauss_of(clone, SE3D_FORMULATION_AUTO, 1e-8);
        for (int k = 6; k < 11; ++k) {
            CHECK(se3d_solver_run(solver, 0.05 * k) >= 0 && se3d_solver_run(other, 0.05 * k) >= 0);
            CHECK(se3d_system_hash(system) == se3d_system_hash(clone));
        }
        se3d_solver_destroy(solver);
        se3d_solver_destroy(other);
        se3d_system_destroy(clone);
        se3d_system_destroy(system);
    }
}

static uint64_t count_solutions(const se3d_solver *solver)
{
    se3d_solver_stats stats;
    CHECK(!se3d_solver_get_stats(solver, &stats));
    return stats.factorizations;
}

/* A run to the present makes the state consistent; what goes on from there, whoever does, leaves it
 * as it is, unless somebody has set something since. */
static void a_state_is_made_consistent_once(void)
{
    for (int changes = 0; changes < 3; ++changes) {
        static const double gravity[3] = {0.0, 1.0, 0.0}, v[3] = {0.0, 1.0, 0.0};
        se3d_system *systems[3] = {NULL};
        se3d_body shafts[3];
        CHECK(!se3d_system_create(NULL, &systems[0]));
        add_shafts(systems[0], shafts);
        se3d_solver *first = gauss_of(systems[0], SE3D_FORMULATION_JOINT, 1e-6);
        CHECK(!se3d_system_clone(systems[0], &systems[2]));
        CHECK(se3d_solver_run(first, 0.0) >= 0);
        CHECK(!se3d_system_clone(systems[0], &systems[1]));
        const uint64_t before = count_solutions(first);
        CHECK(before > 0);
        for (int k = 0; k < 3; ++k) {
            CHECK(changes != 1 || !se3d_system_set_gravity(systems[k], gravity));
            CHECK(changes != 2 || !se3d_body_set_velocity(systems[k], shafts[2], v));
        }
        CHECK(se3d_solver_run(first, 0.02) >= 0);
        CHECK((count_solutions(first) == before) == (changes == 0));
        for (int k = 1; k < 3; ++k) { /* in the last one nobody has been before */
            se3d_solver *other = gauss_of(systems[k], SE3D_FORMULATION_JOINT, 1e-6);
            CHECK(se3d_solver_run(other, 0.02) >= 0);
            CHECK(se3d_system_hash(systems[k]) == se3d_system_hash(systems[0]) ||
                  (k == 2 && changes > 0));
            CHECK((count_solutions(other) == 0) == (k == 1 && changes == 0));
            se3d_solver_destroy(other);
        }
        se3d_solver_destroy(first);
        for (int k = 0; k < 3; ++k) {
            se3d_system_destroy(systems[k]);
        }
    }
}

int main(void)
{
    RUN(whoever_continues_gets_the_same_bits);
    RUN(steps_of_loops_in_lanes_go_on_alike);
    RUN(gravity_that_begins_or_ends_to_vary_starts_nothing_anew);
    RUN(bodies_keep_the_sign_of_p);
    RUN(a_state_is_made_consistent_once);
    return check_finish();
}
