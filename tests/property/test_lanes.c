/* SPDX-License-Identifier: BSD-3-Clause */
/* Several states of a tree in lanes against the same states one after the other, on random trees of
 * all joint types: the same bits at every width, in every lane, whatever is in the others. */
#include "support/parallel_world.h"

#include "assembly/loads.h"
#include "tree/core.h"
#include "tree/lanes.h"
#include "tree/packs.h"
#include "tree/recursion.h"

enum { MECHANISMS = 60, STATES = SE3DI_LANES_MAX, NUMBERS = 7 * TREE_BODIES_MAX };
enum { LOADS = 6 * (TREE_BODIES_MAX + 1), LANE_NUMBERS = SE3DI_LANES_MAX * LOADS };

static const int32_t widths[] = {1, 4, 8};

/* States of one tree, and what each of them gives alone. */
typedef struct states_of {
    tree_world world;
    se3di_model *model;
    se3di_tree tree;
    double q[STATES][NUMBERS], qdot[STATES][NUMBERS], effort[STATES][NUMBERS];
    double loads[STATES][LOADS];
    double qddot[STATES][NUMBERS], held[STATES][NUMBERS], rates[STATES][NUMBERS];
    double squares[STATES][4];
} states_of;

/* The largest squares of velocities, angular ones, and accelerations of both, of all bodies. */
static void survey_alone(const states_of *s, double squares[4])
{
    double rate[6];
    memset(squares, 0, 4 * sizeof *squares);
    for (uint32_t i = 0; i < s->tree.count; ++i) {
        const se3di_frame *frame = &s->model->frames[s->tree.nodes[i].body];
        se3di_tree_link_acceleration(&s->tree, i, frame, rate);
        squares[0] = fmax(squares[0], se3di_dot(frame->v, frame->v));
        squares[1] = fmax(squares[1], se3di_dot(frame->w, frame->w));
        squares[2] = fmax(squares[2], se3di_dot(rate, rate));
        squares[3] = fmax(squares[3], se3di_dot(rate + 3, rate + 3));
    }
}

static void solve_alone(states_of *s, int k)
{
    double joint[6 * TREE_BODIES_MAX];
    uint32_t failed;
    se3di_tree *tree = &s->tree;
    se3di_tree_place(tree, s->q[k], s->qdot[k], s->model->frames);
    CHECK(!se3di_loads_eval(s->model, 0.0, s->loads[k], &failed));
    se3di_tree_take_wrenches(tree, s->model->frames, s->loads[k]);
    CHECK(!se3di_tree_factor(tree, s->effort[k]));
    se3di_tree_accelerate(tree, tree->e, s->qddot[k]);
    survey_alone(s, s->squares[k]);
    se3di_tree_propagate(tree, s->effort[k]);
    se3di_tree_efforts(tree, s->effort[k], joint, s->held[k]);
    se3di_tree_rates(tree, s->q[k], s->qdot[k], s->rates[k]);
}

/* Which the tree takes from the model whenever it is refreshed. */
static void set_armatures(states_of *s, uint64_t seed)
{
    for (uint32_t v = 0; seed % 3 == 0 && v < s->tree.v_count; ++v) {
        s->tree.armature[v] = 0.1 * v;
    }
    se3di_tree_find_packs(&s->tree);
    se3di_tree_fill_packs(&s->tree);
}

/* far: one state is some 1e5 m and turns away. */
static void begin(states_of *s, uint64_t seed, int far)
{
    double dq[NUMBERS];
    tree_world_init(&s->world, seed, 1 + (int)(seed % TREE_BODIES_MAX), 0);
    s->model = &s->world.system->model;
    CHECK(!se3di_tree_init(&s->tree, s->model, 1, NULL));
    set_armatures(s, seed);
    for (int k = 0; k < STATES; ++k) {
        se3di_tree_get(&s->tree, s->q[k], NULL);
        tree_vector(&s->world, dq, (int)s->tree.v_count, far && k == 3 ? 4e5 : 4.0);
        tree_vector(&s->world, s->qdot[k], (int)s->tree.v_count, 2.0);
        tree_vector(&s->world, s->effort[k], (int)s->tree.v_count, 5.0);
        se3di_tree_move(&s->tree, s->q[k], dq, s->q[k]);
        solve_alone(s, k);
    }
}

static void end(states_of *s)
{
    se3di_tree_destroy(&s->tree);
    tree_world_destroy(&s->world);
}

/* State (lane + shift) mod STATES of each number into the lanes. */
static void pack(const double *from, size_t stride, size_t count, int width, int shift, double *to)
{
    for (size_t c = 0; c < count; ++c) {
        for (int lane = 0; lane < width; ++lane) {
            to[c * (size_t)width + (size_t)lane] =
                from[(size_t)((lane + shift) % STATES) * stride + c];
        }
    }
}

static int are_equal(const double *lanes, const double *alone, size_t stride, size_t count,
                     int width, int shift)
{
    double expected[LANE_NUMBERS];
    pack(alone, stride, count, width, shift, expected);
    for (size_t k = 0; k < count * (size_t)width; ++k) {
        if (lanes[k] != expected[k]) { /* zeros of either sign are the same */
            return 0;
        }
    }
    return 1;
}

#define PACK(what, count, to)                                                                      \
    pack(s->what[0], sizeof *s->what / sizeof(double), count, w, shift, to)
#define EQUAL(lanes, what, count)                                                                  \
    are_equal(lanes, s->what[0], sizeof *s->what / sizeof(double), count, w, shift)

static void compare(states_of *s, const se3di_lane_core *core, int shift)
{
    _Alignas(SE3DI_LANES_ALIGN) double q[LANE_NUMBERS], qdot[LANE_NUMBERS], effort[LANE_NUMBERS];
    _Alignas(SE3DI_LANES_ALIGN) double out[LANE_NUMBERS], verdict[SE3DI_LANES_MAX];
    const int w = core->width;
    _Alignas(SE3DI_LANES_ALIGN) double squares[4 * SE3DI_LANES_MAX];
    const size_t v = s->tree.v_count;
    se3di_lanes lanes;
    CHECK(!se3di_lanes_init(&lanes, &s->tree, core, 1));
    PACK(q, s->tree.q_count, q);
    PACK(qdot, v, qdot);
    PACK(effort, v, effort);
    core->place(&lanes, q, qdot);
    PACK(loads, 6 * s->tree.body_count, lanes.loads);
    core->take_wrenches(&lanes);
    se3di_lanes_accelerate(&lanes, effort, out);
    CHECK(EQUAL(out, qddot, v));
    core->survey(&lanes, squares);
    for (int k = 0; k < 4 * w; ++k) {
        const double alone = s->squares[(k % w + shift) % STATES][k / w];
        CHECK_NEAR(squares[k] / (1.0 + alone), alone / (1.0 + alone), 1e-9);
    }
    core->find_efforts(&lanes, effort, out);
    CHECK(EQUAL(out, held, v));
    core->find_rates(&lanes, q, qdot, out);
    CHECK(EQUAL(out, rates, s->tree.q_count));
    core->check(v, effort, verdict);
    for (int lane = 0; lane < w; ++lane) {
        CHECK(verdict[lane] == 1.0);
    }
    se3di_lanes_destroy(&lanes);
}

static void a_state_has_the_same_bits_in_every_lane_and_alone(void)
{
    static states_of s;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        begin(&s, seed, 1);
        for (size_t k = 0; k < sizeof widths / sizeof *widths; ++k) {
            const se3di_lane_core *core = se3di_lane_core_find(widths[k]);
            for (int shift = 0; core && shift < STATES; shift += 1 + (int)seed % 3) {
                compare(&s, core, shift);
            }
        }
        end(&s);
    }
}

/* With nothing but gravity, which may differ between the lanes, and masses that do. */
static void lanes_may_have_gravity_and_masses_of_their_own(void)
{
    static states_of s;
    const se3di_lane_core *core = se3di_lane_core_widest();
    const int w = core->width;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        _Alignas(SE3DI_LANES_ALIGN) double q[LANE_NUMBERS], qdot[LANE_NUMBERS], out[LANE_NUMBERS];
        _Alignas(SE3DI_LANES_ALIGN) double gravity[3 * SE3DI_LANES_MAX];
        _Alignas(SE3DI_LANES_ALIGN) double inertias[7 * TREE_BODIES_MAX * SE3DI_LANES_MAX];
        se3di_lanes lanes;
        begin(&s, seed, 0);
        CHECK(!se3di_lanes_init(&lanes, &s.tree, core, 0));
        pack(s.q[0], NUMBERS, s.tree.q_count, w, 0, q);
        pack(s.qdot[0], NUMBERS, s.tree.v_count, w, 0, qdot);
        for (int lane = 0; lane < w; ++lane) {
            for (int c = 0; c < 3; ++c) {
                gravity[c * w + lane] = (1.0 + lane) * s.model->gravity[c];
            }
            for (uint32_t k = 0; k < s.tree.count; ++k) {
                double *to = inertias + 7 * (size_t)k * (size_t)w + lane;
                to[0] = (1.0 + lane) * s.tree.nodes[k].mass;
                for (int c = 0; c < 6; ++c) {
                    to[(1 + c) * w] = (1.0 + lane) * s.tree.nodes[k].J[c];
                }
            }
        }
        lanes.inertias = inertias;
        core->place(&lanes, q, qdot);
        se3di_lanes_load(&lanes, gravity, 0);
        se3di_lanes_accelerate(&lanes, NULL, out);
        for (int lane = 0; lane < w; ++lane) {
            se3di_tree_place(&s.tree, s.q[lane], s.qdot[lane], s.model->frames);
            double *f = s.tree.wrench;
            for (uint32_t k = 0; k < s.tree.count; ++k) {
                s.tree.nodes[k].mass *= 1.0 + lane;
                for (int c = 0; c < 6; ++c) {
                    s.tree.nodes[k].J[c] *= 1.0 + lane;
                }
                double g[3];
                se3di_scale(1.0 + lane, s.model->gravity, g);
                se3di_scale(s.tree.nodes[k].mass, g, f + 6 * k + 3);
                se3di_cross(s.tree.links[k].s, f + 6 * k + 3, f + 6 * k);
            }
            se3di_tree_fill_packs(&s.tree);
            CHECK(!se3di_tree_factor(&s.tree, NULL));
            se3di_tree_accelerate(&s.tree, s.tree.e, s.tree.qddot);
            double largest = 1.0;
            for (uint32_t v = 0; v < s.tree.v_count; ++v) {
                largest = fmax(largest, fabs(s.tree.qddot[v]));
            }
            for (uint32_t v = 0; v < s.tree.v_count; ++v) {
                CHECK_NEAR(out[v * (uint32_t)w + (uint32_t)lane] / largest,
                           s.tree.qddot[v] / largest, 1e-12);
            }
            se3di_tree_refresh(&s.tree);
            set_armatures(&s, seed);
        }
        se3di_lanes_destroy(&lanes);
        end(&s);
    }
}

/* A lane that is not finite, or whose coordinates have no inertia, leaves the others alone. */
static void what_fails_stays_in_its_lane(void)
{
    static states_of s;
    const se3di_lane_core *core = se3di_lane_core_widest();
    const int w = core->width, shift = 0;
    states_of *const all = &s;
    for (uint64_t seed = 1; seed < MECHANISMS; ++seed) {
        _Alignas(SE3DI_LANES_ALIGN) double q[LANE_NUMBERS], qdot[LANE_NUMBERS], out[LANE_NUMBERS];
        _Alignas(SE3DI_LANES_ALIGN) double effort[LANE_NUMBERS], verdict[SE3DI_LANES_MAX];
        se3di_lanes lanes;
        begin(&s, seed, 1);
        const size_t v = s.tree.v_count;
        const int bad = (int)seed % w;
        CHECK(!se3di_lanes_init(&lanes, &s.tree, core, 1));
        pack(all->q[0], NUMBERS, s.tree.q_count, w, shift, q);
        pack(all->qdot[0], NUMBERS, v, w, shift, qdot);
        pack(all->effort[0], NUMBERS, v, w, shift, effort);
        for (size_t k = 0; k < s.tree.q_count; ++k) {
            q[k * (size_t)w + (size_t)bad] = k % 2 ? (double)INFINITY : (double)NAN;
        }
        core->place(&lanes, q, qdot);
        pack(all->loads[0], LOADS, 6 * s.tree.body_count, w, shift, lanes.loads);
        core->take_wrenches(&lanes);
        se3di_lanes_accelerate(&lanes, effort, out);
        core->check(v, out, verdict);
        for (int lane = 0; lane < w; ++lane) {
            for (size_t k = 0; lane != bad && k < v; ++k) {
                CHECK(out[k * (size_t)w + (size_t)lane] == s.qddot[lane][k]);
            }
            CHECK(lane == bad ? v == 0 || verdict[lane] != 1.0 : verdict[lane] == 1.0);
        }
        se3di_lanes_destroy(&lanes);
        end(&s);
    }
}

static void a_coordinate_without_inertia_is_told_in_its_lane(void)
{
    static states_of s;
    const se3di_lane_core *core = se3di_lane_core_widest();
    const int w = core->width;
    _Alignas(SE3DI_LANES_ALIGN) double q[LANE_NUMBERS], qdot[LANE_NUMBERS], out[LANE_NUMBERS];
    _Alignas(SE3DI_LANES_ALIGN) double inertias[7 * TREE_BODIES_MAX * SE3DI_LANES_MAX];
    _Alignas(SE3DI_LANES_ALIGN) double gravity[3 * SE3DI_LANES_MAX] = {0.0};
    _Alignas(SE3DI_LANES_ALIGN) double verdict[SE3DI_LANES_MAX];
    se3di_lanes lanes;
    begin(&s, 11, 1);
    CHECK(s.tree.v_count > 0);
    CHECK(!se3di_lanes_init(&lanes, &s.tree, core, 0));
    pack(s.q[0], NUMBERS, s.tree.q_count, w, 0, q);
    pack(s.qdot[0], NUMBERS, s.tree.v_count, w, 0, qdot);
    for (uint32_t k = 0; k < s.tree.count; ++k) {
        for (int lane = 0; lane < w; ++lane) {
            double *to = inertias + 7 * (size_t)k * (size_t)w + lane;
            const double sign = lane == w - 1 ? -1.0 : 1.0; /* nothing that would move */
            to[0] = sign * s.tree.nodes[k].mass;
            for (int c = 0; c < 6; ++c) {
                to[(1 + c) * w] = sign * s.tree.nodes[k].J[c];
            }
        }
    }
    lanes.inertias = inertias;
    core->place(&lanes, q, qdot);
    se3di_lanes_load(&lanes, gravity, 0);
    se3di_lanes_accelerate(&lanes, NULL, out);
    core->check(s.tree.v_count, out, verdict);
    for (int lane = 0; lane < w; ++lane) {
        CHECK((verdict[lane] == 1.0) == (lane != w - 1));
    }
    se3di_lanes_destroy(&lanes);
    end(&s);
}

static void sums_and_unit_quaternions_are_those_of_doubles(void)
{
    _Alignas(SE3DI_LANES_ALIGN) double a[24], b[24], out[24];
    for (size_t k = 0; k < sizeof widths / sizeof *widths; ++k) {
        const se3di_lane_core *core = se3di_lane_core_find(widths[k]);
        for (int c = 0; core && c < 24; ++c) {
            a[c] = 0.1 * c;
            b[c] = 1.0 / (c + 1);
        }
        if (core) {
            core->add(24u / (size_t)widths[k], a, 0.3, b, out);
        }
        for (int c = 0; core && c < 24; ++c) {
            CHECK(out[c] == a[c] + 0.3 * b[c]);
        }
    }
}

/* Masses and moments of inertia of each lane's own. */
static void spread_inertias(const se3di_tree *tree, size_t w, double *inertias)
{
    for (size_t k = 0; k < tree->count * 7 * w; ++k) {
        const se3di_tree_node *n = &tree->nodes[k / w / 7];
        const size_t c = k / w % 7;
        inertias[k] = (c == 0 ? n->mass : n->J[c - 1]) * (1.0 + 0.1 * (double)(k % w));
    }
}

/* Accelerations of all lanes, by `effort` (NULL: none) with inertias of their own, sizes of the
 * rates as changes, how fast all moves, and the efforts that give these accelerations. */
enum { SURVEY = SE3DI_LANES_MAX, SIZES = 5 * SE3DI_LANES_MAX };

static void fall(const se3di_tree *tree, const se3di_lane_core *core, int in_plane, const double *q,
                 const double *effort, double *qddot, double *sizes, double *needed)
{
    static _Alignas(SE3DI_LANES_ALIGN) double inertias[7 * LANE_NUMBERS];
    const double *qdot = q + tree->q_count * (size_t)core->width;
    static const double scale[3] = {0.7, 1.3, 0.9};
    _Alignas(SE3DI_LANES_ALIGN) double gravity[3 * SE3DI_LANES_MAX], change[LANE_NUMBERS];
    _Alignas(SE3DI_LANES_ALIGN) double of_all[SE3DI_LANES_MAX], of_rates[SE3DI_LANES_MAX];
    const size_t w = (size_t)core->width, count = tree->v_count * w;
    se3di_lanes lanes;
    CHECK(!se3di_lanes_init(&lanes, tree, core, 0));
    for (size_t k = 0; k < 3 * w; ++k) {
        gravity[k] = tree->model->gravity[k / w] * (double)(1 + k % w);
    }
    se3di_lanes_load(&lanes, gravity, 0);
    if (in_plane) {
        se3di_lanes_take_plane(&lanes);
        CHECK(lanes.plane);
    }
    lanes.wants_points = 1;
    if (effort) {
        spread_inertias(tree, w, inertias);
        lanes.inertias = inertias;
    }
    core->place(&lanes, q, qdot);
    se3di_lanes_accelerate(&lanes, effort, qddot);
    core->survey(&lanes, sizes + SURVEY);
    core->find_efforts(&lanes, qddot, needed);
    core->place(&lanes, q, qdot);
    memcpy(change, qdot, count * sizeof *change);
    memcpy(change + count, qddot, count * sizeof *change);
    core->measure(&lanes, q, change, scale, sizes);
    memset(change, 0, count * sizeof *change);
    core->measure(&lanes, q, change, scale, of_all);
    core->measure_rates(&lanes, change, scale, of_rates);
    CHECK(memcmp(of_all, of_rates, w * sizeof *of_all) == 0 && of_all[0] > 0.0);
    se3di_lanes_destroy(&lanes);
}

/* The largest difference, relative to the largest number. */
static double part_between(const double *a, const double *b, size_t count)
{
    double most = 0.0, largest = 1.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
        largest = fmax(largest, fabs(b[k]));
    }
    return most / largest;
}

/* Positions, then velocities, then efforts; those of lane 0 are the same at every width. */
static void spread_parallel(tree_world *world, size_t w, size_t freedoms, uint64_t seed, double *y)
{
    static const double most[3] = {3.0, 4.0, 20.0};
    uint64_t same = seed + 1;
    for (size_t k = 0; k < 3 * freedoms * w; ++k) {
        uint64_t *from = k % w == 0 ? &same : &world->seed;
        y[k] = most[k / w / freedoms] * check_random(from);
    }
}

static void trees_of_parallel_axes_move_in_a_plane_as_in_space(void)
{
    for (uint64_t seed = 0; seed < 3 * MECHANISMS; ++seed) {
        _Alignas(SE3DI_LANES_ALIGN) double y[3 * LANE_NUMBERS], out[2][LANE_NUMBERS];
        _Alignas(SE3DI_LANES_ALIGN) double needed[2][LANE_NUMBERS], sizes[2][SIZES];
        double alone[2][NUMBERS];
        tree_world world;
        se3di_tree tree;
        tree_make_parallel(&world, seed, 0.0);
        CHECK(!se3di_tree_init(&tree, &world.system->model, 1, NULL));
        CHECK(se3di_tree_is_planar(&tree));
        for (size_t n = 0; n < sizeof widths / sizeof *widths; ++n) {
            const se3di_lane_core *core = se3di_lane_core_find(widths[n]);
            const size_t w = (size_t)widths[n], count = tree.v_count * w;
            const double *effort = seed % 2 ? y + 2 * count : NULL;
            if (!core) {
                continue;
            }
            spread_parallel(&world, w, tree.v_count, seed, y);
            for (int k = 0; k < 2; ++k) {
                fall(&tree, core, k, y, effort, out[k], sizes[k], needed[k]);
            }
            CHECK_NEAR(part_between(out[1], out[0], count), 0.0, 1e-11);
            CHECK_NEAR(part_between(needed[1], needed[0], count), 0.0, 1e-10);
            for (size_t k = 0; k < count; ++k) {
                CHECK_NEAR(needed[1][k], effort ? effort[k] : 0.0, 1e-8);
            }
            for (size_t lane = 0; lane < w; ++lane) {
                CHECK_NEAR(sizes[1][lane] / sizes[0][lane], 1.0, 1e-10);
            }
            for (size_t k = SURVEY; k < SURVEY + 4 * w; ++k) {
                CHECK_NEAR((sizes[1][k] - sizes[0][k]) / (1.0 + sizes[0][k]), 0.0, 1e-9);
            }
            for (size_t k = 0; k < tree.v_count; ++k) {
                CHECK(w == 1 || (out[1][k * w] == alone[0][k] && needed[1][k * w] == alone[1][k]));
                alone[0][k] = out[1][k * w];
                alone[1][k] = needed[1][k * w];
            }
        }
        se3di_tree_destroy(&tree);
        tree_world_destroy(&world);
    }
}

static void axes_that_are_not_parallel_do_not_move_in_a_plane(void)
{
    for (uint64_t seed = 1; seed < TREE_BODIES_MAX; ++seed) { /* two bodies or more */
        tree_world world;
        se3di_tree tree;
        tree_make_parallel(&world, seed, 1e-9);
        CHECK(!se3di_tree_init(&tree, &world.system->model, 1, NULL));
        int hangs = 0; /* a tilt on the ground is the plane of its own root */
        for (uint32_t k = 0; k < tree.count; ++k) {
            hangs += tree.nodes[k].parent >= 0 && (tree.nodes[k].T[2] != 0.0) &&
                     fabs(tree.nodes[k].T[2]) + fabs(tree.nodes[k].T[5]) > 1e-12;
        }
        CHECK(se3di_tree_is_planar(&tree) == (hangs == 0));
        se3di_tree_destroy(&tree);
        tree_world_destroy(&world);
    }
}

int main(void)
{
    RUN(a_state_has_the_same_bits_in_every_lane_and_alone);
    RUN(lanes_may_have_gravity_and_masses_of_their_own);
    RUN(what_fails_stays_in_its_lane);
    RUN(a_coordinate_without_inertia_is_told_in_its_lane);
    RUN(trees_of_parallel_axes_move_in_a_plane_as_in_space);
    RUN(axes_that_are_not_parallel_do_not_move_in_a_plane);
    RUN(sums_and_unit_quaternions_are_those_of_doubles);
    return check_finish();
}
