/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches of mechanisms with loops: the motion of a solver, loops that stay closed, the same bits
 * in any lane, and what is refused. */
#include "check.h"
#include "se3d/se3d.h"
#include "system/system_internal.h"
#include "tree/lanes.h"
#include "tree/loops.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FOUR_BARS, LEANING, BALLS, KINDS, STATES = 19, NUMBERS = 32 };

typedef struct mechanism {
    se3d_system *system;
    se3d_body ground, bar[6];
    int count;
    double plane[9]; /* rows: two directions in the plane, its normal */
} mechanism;

static void put(const mechanism *m, const double x[2], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = x[0] * m->plane[k] + x[1] * m->plane[3 + k];
    }
}

/* A bar between two points, which are its ends a and b. */
static se3d_body add_bar(mechanism *m, const double a[2], const double b[2])
{
    se3d_body_def def = se3d_body_def_default();
    const double middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
    put(m, middle, def.position);
    def.mass = 1.0 + 0.1 * m->count;
    for (int k = 0; k < 3; ++k) {
        def.inertia[k] = 0.2 + 0.03 * k;
    }
    CHECK(!se3d_body_create(m->system, &def, &m->bar[m->count]));
    return m->bar[m->count++];
}

static void join(const mechanism *m, se3d_body i, se3d_body j, const double at[2], int is_ball,
                 const double axis[3])
{
    se3d_joint_def def = se3d_joint_def_default();
    const se3d_body bodies[2] = {i, j};
    double point[3], *own[2] = {def.point_i, def.point_j};
    se3d_constraint joint;
    put(m, at, point);
    for (int k = 0; k < 2; ++k) {
        double r[3];
        CHECK(!se3d_body_get_position(m->system, bodies[k], r));
        for (int c = 0; c < 3; ++c) {
            own[k][c] = point[c] - r[c];
        }
    }
    def.body_i = i;
    def.body_j = j;
    memcpy(def.axis_i, axis, sizeof def.axis_i);
    memcpy(def.axis_j, axis, sizeof def.axis_j);
    CHECK(!(is_ball ? se3d_joint_create_spherical : se3d_joint_create_revolute)(m->system, &def,
                                                                                &joint));
}

/* Two four-bars in a row, the second on the first; or one with balls at the coupler and a rocker
 * that turns about another axis. `even`: a parallelogram. */
static mechanism make(int kind, int even)
{
    static const double tops[3][2] = {{0.1, 0.5}, {1.2, 0.8}, {2.3, 0.55}};
    static const double even_tops[3][2] = {{0.0, 0.7}, {1.0, 0.7}, {2.0, 0.7}};
    static const double lean[9] = {0.6, 0.0, 0.8, 0.48, 0.8, -0.36, -0.64, 0.6, 0.48};
    static const double upright[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    static const double gravity[3] = {0.4, -9.81, 0.3};
    mechanism m = {.count = 0};
    memcpy(m.plane, kind == LEANING ? lean : upright, sizeof m.plane);
    CHECK(!se3d_system_create(NULL, &m.system));
    CHECK(!se3d_system_set_gravity(m.system, gravity));
    CHECK(!se3d_system_get_ground(m.system, &m.ground));
    const double tilted[3] = {0.0, 0.28, 0.96}, *normal = m.plane + 6;
    const double(*const top)[2] = even ? even_tops : tops;
    const double feet[3][2] = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}};
    for (int k = 0; k < (kind == BALLS ? 2 : 3); ++k) {
        const se3d_body post = add_bar(&m, feet[k], top[k]);
        join(&m, m.ground, post, feet[k], 0, kind == BALLS && k > 0 ? tilted : normal);
        if (k > 0) {
            const se3d_body left = m.bar[k > 1 ? m.count - 3 : 0];
            const se3d_body coupler = add_bar(&m, top[k - 1], top[k]);
            join(&m, left, coupler, top[k - 1], kind == BALLS, normal);
            join(&m, coupler, post, top[k], kind == BALLS, normal);
        }
    }
    return m;
}

static void run_alone(se3d_system *system, double end)
{
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    def.formulation = SE3D_FORMULATION_ROMEGA;
    def.method = SE3D_METHOD_DOP853;
    def.tolerance = 1e-12;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(se3d_solver_run(solver, end) >= 0);
    se3d_solver_destroy(solver);
}

/* State k of the batch, as the positions of the bodies; returns the largest violation. */
static double show(mechanism *m, const se3d_batch *b, size_t k, double *positions)
{
    se3d_coordinates *c;
    double q[NUMBERS], qdot[NUMBERS], gaps[3];
    CHECK(!se3d_batch_get_state(b, k, 1, q, qdot));
    CHECK(!se3d_coordinates_create(m->system, &c));
    CHECK(!se3d_coordinates_set(c, q, qdot));
    se3d_coordinates_destroy(c);
    for (int i = 0; i < m->count; ++i) {
        CHECK(!se3d_body_get_position(m->system, m->bar[i], positions + 3 * i));
    }
    CHECK(!se3d_system_get_violation(m->system, gaps));
    return fmax(gaps[0], gaps[1]);
}

static void loops_move_as_those_of_a_solver(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        mechanism m = make(kind, 0);
        se3d_system *other;
        se3d_batch *b;
        double positions[18];
        CHECK(!se3d_system_clone(m.system, &other));
        CHECK(!se3d_batch_create(m.system, 2, 1, &b));
        CHECK(!se3d_batch_step(b, SE3D_METHOD_DOP853, 0.01, 40));
        run_alone(other, 0.4);
        CHECK(show(&m, b, 1, positions) < 1e-13);
        for (int i = 0; i < m.count; ++i) {
            double r[3];
            CHECK(!se3d_body_get_position(other, m.bar[i], r));
            for (int c = 0; c < 3; ++c) {
                CHECK_NEAR(positions[3 * i + c], r[c], 1e-10);
            }
        }
        se3d_batch_destroy(b);
        se3d_system_destroy(other);
        se3d_system_destroy(m.system);
    }
}

/* Accelerations of each state are those that coordinates have; efforts, masses and springs act. */
static void accelerations_are_those_of_the_constrained_motion(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        mechanism m = make(kind, 0);
        se3d_tsda_def spring = se3d_tsda_def_default();
        se3d_force force;
        se3d_batch *b;
        se3d_coordinates *c;
        double effort[NUMBERS] = {0.7, -0.3, 1.1}, mine[NUMBERS], theirs[NUMBERS];
        spring.body_i = m.ground;
        spring.body_j = m.bar[1];
        spring.point_i[1] = 2.0;
        spring.k = 40.0;
        spring.c = 3.0;
        CHECK(!se3d_force_create_tsda(m.system, &spring, &force));
        CHECK(!se3d_batch_create(m.system, 1, 1, &b));
        CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 7));
        CHECK(!se3d_batch_set_efforts(b, 0, 1, effort));
        CHECK(!se3d_batch_compute_accelerations(b, mine));
        CHECK(show(&m, b, 0, theirs) < 1e-12);
        CHECK(!se3d_coordinates_create(m.system, &c));
        CHECK(!se3d_coordinates_compute_accelerations(c, effort, theirs));
        for (size_t v = 0; v < se3d_coordinates_count(c); ++v) {
            CHECK_NEAR(mine[v], theirs[v], 1e-10 * (1.0 + fabs(theirs[v])));
        }
        CHECK(se3d_batch_compute_efforts(b, NULL, mine) == SE3D_ERR_UNSUPPORTED);
        se3d_coordinates_destroy(c);
        se3d_batch_destroy(b);
        se3d_system_destroy(m.system);
    }
}

/* State k of `count`, by hand off the loops by a little. */
static void run_some(const mechanism *m, size_t first, size_t count, int threads, double *q)
{
    se3d_batch *b;
    double own[NUMBERS], gravity[3] = {0.0, -9.81, 0.5};
    CHECK(!se3d_batch_create(m->system, count, threads, &b));
    const size_t n = se3d_batch_count_positions(b);
    CHECK(!se3d_batch_get_state(b, 0, 1, own, NULL));
    for (size_t k = 0; k < count; ++k) {
        double moved[NUMBERS];
        memcpy(moved, own, sizeof moved);
        moved[0] += 0.01 * (double)(first + k);
        gravity[0] = 0.1 * (double)(first + k);
        CHECK(!se3d_batch_set_state(b, k, 1, moved, NULL));
        CHECK(!se3d_batch_set_gravity(b, k, 1, gravity));
    }
    CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 5));
    CHECK(!se3d_batch_get_state(b, 0, count, q + first * n, NULL));
    se3d_batch_destroy(b);
}

static void bits_do_not_depend_on_count_lane_and_threads(void)
{
    static double q[STATES * NUMBERS], other[STATES * NUMBERS];
    static const size_t sizes[] = {1, 2, 5, 9};
    for (int kind = 0; kind < KINDS; ++kind) {
        mechanism m = make(kind, 0);
        memset(q, 0, sizeof q);
        run_some(&m, 0, STATES, 1, q);
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k) {
            memset(other, 0, sizeof other);
            for (size_t first = 0; first < STATES; first += sizes[k]) {
                const size_t rest = STATES - first;
                run_some(&m, first, rest < sizes[k] ? rest : sizes[k], 1 + (int)k, other);
            }
            CHECK(memcmp(q, other, sizeof q) == 0);
        }
        se3d_system_destroy(m.system);
    }
}

/* Rows, accelerations and corrections of one state in all lanes: qddot, then dq [width]. */
static void solve_in_lanes(const se3di_tree_loops *loops, int32_t width, double *out)
{
    enum { ROOM = 65536 };
    static double rows[ROOM], state[2][8 * NUMBERS], pulls[24 + 8], gaps[8 + 8];
    const se3di_tree *tree = loops->tree;
    se3di_lane_loops lane_loops;
    se3di_lanes lanes;
    const se3di_lane_core *core = se3di_lane_core_find(width);
    const size_t n = (size_t)width;
    CHECK(!se3di_lane_loops_init(&lane_loops, loops));
    CHECK(!se3di_lanes_init(&lanes, tree, core, 0));
    CHECK(se3di_lane_loops_room(&lane_loops) * n < ROOM - 8);
    se3di_lanes_take_loops(&lanes, &lane_loops, se3di_lanes_align(rows));
    double *q = se3di_lanes_align(state[0]), *qdot = se3di_lanes_align(state[1]);
    for (size_t k = 0; k < n * NUMBERS - 8; ++k) {
        q[k] = k / n < tree->q_count ? tree->q[k / n] : 0.0;
        qdot[k] = 0.3 * (double)(k / n) - 0.7;
    }
    double *gravity = se3di_lanes_align(pulls);
    for (size_t k = 0; k < 3 * n; ++k) {
        gravity[k] = 9.0 - (double)(k / n);
    }
    double *result = calloc(8 * 2 * NUMBERS + 8, sizeof *result);
    double *qddot = se3di_lanes_align(result), *dq = qddot + n * tree->v_count;
    se3di_lanes_load(&lanes, gravity, 0);
    core->place(&lanes, q, qdot);
    se3di_lanes_accelerate(&lanes, NULL, qddot);
    core->find_gaps(&lanes, 1, se3di_lanes_align(gaps));
    core->correct(&lanes, dq);
    memcpy(out, qddot, 2 * n * tree->v_count * sizeof *out);
    free(result);
    se3di_lanes_destroy(&lanes);
    se3di_lane_loops_destroy(&lane_loops);
}

static void bits_do_not_depend_on_the_width(void)
{
    static const int32_t widths[] = {1, 4, 8};
    static double one[8 * 2 * NUMBERS], many[8 * 2 * NUMBERS];
    for (int kind = 0; kind < KINDS; ++kind) {
        mechanism m = make(kind, 0);
        se3di_model *model = &m.system->model;
        se3di_tree tree;
        se3di_assembly assembly;
        se3di_tree_loops loops;
        CHECK(!se3di_tree_init(&tree, model, 0, NULL));
        CHECK(!se3di_assembly_init(&assembly, model, &se3di_formulation_romega, 0, NULL));
        CHECK(!se3di_tree_loops_init(&loops, &tree, &assembly, NULL));
        CHECK(se3di_tree_loops_need_links_only(&loops));
        se3di_tree_get(&tree, tree.q, tree.qdot);
        solve_in_lanes(&loops, 1, one);
        CHECK(fabs(one[0]) > 0.0);
        for (int k = 1; k < 3; ++k) {
            const size_t width = (size_t)widths[k];
            if (!se3di_lane_core_find(widths[k])) {
                continue;
            }
            solve_in_lanes(&loops, widths[k], many);
            for (size_t c = 0; c < 2 * tree.v_count * width; ++c) {
                CHECK(memcmp(&many[c], &one[c / width], sizeof *one) == 0);
            }
        }
        se3di_tree_loops_destroy(&loops);
        se3di_assembly_destroy(&assembly);
        se3di_tree_destroy(&tree);
        se3d_system_destroy(m.system);
    }
}

/* A parallelogram that lies flat: what closes it is not one motion. */
static void a_state_at_a_singular_position_fails_alone(void)
{
    mechanism m = make(FOUR_BARS, 1);
    se3d_batch *b;
    double q[3 * NUMBERS];
    int32_t status[3];
    CHECK(!se3d_batch_create(m.system, 3, 1, &b));
    const size_t n = se3d_batch_count_positions(b);
    CHECK(!se3d_batch_get_state(b, 0, 3, q, NULL));
    CHECK(n == 5);
    const double quarter = 1.57079632679489656;
    se3d_coordinates *c;
    CHECK(!se3d_coordinates_create(m.system, &c));
    for (size_t k = 0; k < n; ++k) { /* posts lie down, couplers keep their direction */
        se3d_body body;
        double r[3];
        CHECK(!se3d_coordinates_get_entry(c, k, NULL, &body, NULL, NULL, NULL));
        CHECK(!se3d_body_get_position(m.system, body, r));
        q[n + k] += r[1] < 0.5 ? -quarter : quarter;
    }
    se3d_coordinates_destroy(c);
    CHECK(!se3d_batch_set_state(b, 1, 1, q + n, NULL));
    CHECK(se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 1) == SE3D_ERR_NO_CONVERGENCE);
    CHECK(!se3d_batch_get_status(b, 0, 3, status));
    CHECK(status[0] == SE3D_OK && status[1] == SE3D_ERR_NO_CONVERGENCE && status[2] == SE3D_OK);
    CHECK(!se3d_batch_set_state(b, 1, 1, q, NULL));
    CHECK(!se3d_batch_step(b, SE3D_METHOD_RK4, 0.01, 1));
    se3d_batch_destroy(b);
    se3d_system_destroy(m.system);
}

/* Whatever the length of the steps: a state is on its loops, or says that it is not moved. */
static void steps_that_are_too_long_leave_no_loop_open(void)
{
    static const double steps[] = {0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8};
    int refused = 0;
    for (int trial = 0; trial < 14 * KINDS; ++trial) {
        mechanism m = make(trial % KINDS, 0);
        se3d_batch *b;
        double positions[18];
        CHECK(!se3d_batch_create(m.system, 1, 1, &b));
        const int32_t method = trial / KINDS < 7 ? SE3D_METHOD_RK4 : SE3D_METHOD_DOP853;
        for (int k = 0; k < 4; ++k) {
            refused += se3d_batch_step(b, method, steps[trial / KINDS % 7], 1) < 0;
            CHECK(show(&m, b, 0, positions) < 1e-7);
        }
        se3d_batch_destroy(b);
        se3d_system_destroy(m.system);
    }
    CHECK(refused > 0);
}

/* Four pins about axes that are not parallel have equations besides those of points. */
static void loops_that_need_more_are_named(void)
{
    static const double ends[4][2] = {{0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}};
    static const double axes[4][3] = {
        {0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}, {0.0, 0.6, 0.8}, {0.6, 0.8, 0.0}};
    mechanism m = {.count = 0, .plane = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    se3d_batch *b;
    CHECK(!se3d_system_create(NULL, &m.system));
    CHECK(!se3d_system_get_ground(m.system, &m.ground));
    se3d_body last = m.ground;
    for (int k = 0; k < 3; ++k) {
        const se3d_body bar = add_bar(&m, ends[k], ends[k + 1]);
        join(&m, last, bar, ends[k], 0, axes[k]);
        last = bar;
    }
    join(&m, last, m.ground, ends[3], 0, axes[3]);
    CHECK(se3d_batch_create(m.system, 1, 1, &b) == SE3D_ERR_UNSUPPORTED && !b);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "closes a loop");
    se3d_system_destroy(m.system);
}

int main(void)
{
    RUN(loops_move_as_those_of_a_solver);
    RUN(accelerations_are_those_of_the_constrained_motion);
    RUN(bits_do_not_depend_on_count_lane_and_threads);
    RUN(bits_do_not_depend_on_the_width);
    RUN(a_state_at_a_singular_position_fails_alone);
    RUN(steps_that_are_too_long_leave_no_loop_open);
    RUN(loops_that_need_more_are_named);
    return check_finish();
}
