/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint coordinates against the maximal ones on random trees of all joint types: poses and
 * velocities that coordinates give meet the joints, reading gives the coordinates back, and
 * accelerations are those of the KKT system. */
#include "support/tree_world.h"

#include "assembly/loads.h"
#include "model/state.h"
#include "nonlinear/equations.h"
#include "tree/core.h"
#include "tree/loop_core.h"
#include "tree/loops.h"
#include "tree/recursion.h"

#include <stddef.h>
#include <stdlib.h>

enum { MECHANISMS = 120, NUMBERS = 7 * (TREE_BODIES_MAX + 1) };

static double largest(const double *values, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(values[k]));
    }
    return most;
}

static double difference(const double *a, const double *b, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
    }
    return most;
}

/* The mechanism somewhere else: coordinates moved at random, by turns and more. */
static void shake(tree_world *w, se3di_tree *tree, double *q, double *qdot)
{
    double dq[NUMBERS];
    se3di_tree_get(tree, q, NULL);
    tree_vector(w, dq, (int)tree->v_count, 4.0);
    tree_vector(w, qdot, (int)tree->v_count, 2.0);
    se3di_tree_move(tree, q, dq, q);
    se3di_tree_place(tree, q, qdot, w->system->model.frames);
}

static void follow_turns(const se3di_tree *tree, const double *q)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        if (n->angle >= 0) {
            tree->model->angles[n->angle].theta = q[n->q + (n->type == SE3DI_TREE_PLANAR ? 2 : 0)];
        }
    }
}

#define ROWS_MAX (16 * TREE_BODIES_MAX)

typedef struct case_of {
    tree_world world;
    se3di_model *model;
    se3di_tree tree;
    double q[NUMBERS], qdot[NUMBERS];
    int loops, clear; /* it has some; their rows were clear of each other */
    int left_out;     /* nodes that no driver drives */
} case_of;

static void begin_closed(case_of *c, uint64_t seed, int loops)
{
    tree_world_init(&c->world, seed, 1 + (int)(seed % TREE_BODIES_MAX), loops);
    c->loops = c->clear = c->left_out = 0;
    c->model = &c->world.system->model;
    CHECK(!se3di_tree_init(&c->tree, c->model, 1, NULL));
    shake(&c->world, &c->tree, c->q, c->qdot);
    follow_turns(&c->tree, c->q);
}

static void begin(case_of *c, uint64_t seed)
{
    begin_closed(c, seed, 0);
}

static void end(case_of *c)
{
    se3di_tree_destroy(&c->tree);
    tree_world_destroy(&c->world);
}

static void every_body_is_a_node_and_parents_come_first(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        begin(&c, seed);
        CHECK(c.tree.count + 1 == c.model->body_slots.count);
        for (uint32_t k = 0; k < c.tree.count; ++k) {
            CHECK(c.tree.nodes[k].parent < (int32_t)k);
            CHECK(c.tree.node_of[c.tree.nodes[k].body] == (int32_t)k);
        }
        end(&c);
    }
}

static void coordinates_give_states_that_meet_the_joints(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        se3di_equations e;
        begin(&c, seed);
        CHECK(!se3di_equations_init(&e, c.model, &se3di_formulation_romega, 1, NULL));
        CHECK(!se3di_assembly_eval_functions(&e.assembly, 0.0, NULL));
        se3di_assembly_eval_phi(&e.assembly, e.c);
        CHECK_NEAR(largest(e.c, e.assembly.row_count), 0.0, 1e-11);
        se3di_assembly_eval_jacobian(&e.assembly);
        se3di_assembly_get_velocity(&e.assembly, e.x);
        se3di_assembly_mul(&e.assembly, e.x, e.c);
        CHECK_NEAR(largest(e.c, e.assembly.row_count), 0.0, 1e-10);
        se3di_equations_destroy(&e);
        end(&c);
    }
}

static void reading_gives_the_coordinates_back(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        double q[NUMBERS], qdot[NUMBERS], turned[NUMBERS], zero[NUMBERS] = {0.0};
        se3di_frame frames[TREE_BODIES_MAX + 1];
        begin(&c, seed);
        se3di_tree_get(&c.tree, q, qdot);
        CHECK_NEAR(difference(qdot, c.qdot, c.tree.v_count), 0.0, 1e-10);
        /* universal joints come back within one turn */
        se3di_tree_place(&c.tree, q, qdot, frames);
        for (size_t k = 1; k < c.model->body_slots.count; ++k) {
            CHECK_NEAR(difference(frames[k].r, c.model->frames[k].r, 3), 0.0, 1e-11);
            CHECK_NEAR(difference(frames[k].A, c.model->frames[k].A, 9), 0.0, 1e-12);
            CHECK_NEAR(difference(frames[k].w, c.model->frames[k].w, 3), 0.0, 1e-10);
            CHECK_NEAR(difference(frames[k].v, c.model->frames[k].v, 3), 0.0, 1e-10);
        }
        for (uint32_t k = 0; k < c.tree.count; ++k) {
            const se3di_tree_node *n = &c.tree.nodes[k];
            if (n->type != SE3DI_TREE_UNIVERSAL && n->type != SE3DI_TREE_SPHERICAL &&
                n->type != SE3DI_TREE_FREE) {
                CHECK_NEAR(difference(q + n->q, c.q + n->q, (size_t)n->q_count), 0.0, 1e-11);
            }
        }
        se3di_tree_refresh(&c.tree); /* changes nothing */
        se3di_tree_move(&c.tree, q, zero, turned);
        se3di_tree_place(&c.tree, turned, qdot, frames);
        for (size_t k = 1; k < c.model->body_slots.count; ++k) {
            CHECK_NEAR(difference(frames[k].p, c.model->frames[k].p, 4), 0.0, 1e-12);
        }
        end(&c);
    }
}

/* Angles and displacements of the tree are those of the joints. */
static void coordinates_are_those_of_the_joints(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        begin(&c, seed);
        for (uint32_t k = 0; k < c.tree.count; ++k) {
            const se3di_tree_node *n = &c.tree.nodes[k];
            const int has_angle = n->angle >= 0 && n->type != SE3DI_TREE_PLANAR;
            for (int s = 0; s < c.world.joint_count; ++s) {
                const se3d_constraint joint = c.world.joints[s];
                const uint32_t index =
                    se3di_slots_find(&c.model->constraint_slots, joint.index1, joint.generation);
                double value, rate;
                if ((int32_t)index != n->constraint) {
                    continue;
                }
                if (has_angle) {
                    CHECK(!se3d_joint_get_coordinate(
                        c.world.system, joint, SE3D_JOINT_COORDINATE_ANGLE, &value, &rate, NULL));
                    CHECK_NEAR(value, c.q[n->q], 1e-11);
                    CHECK_NEAR(rate, c.qdot[n->v], 1e-10);
                }
                if (n->type == SE3DI_TREE_PRISMATIC || n->type == SE3DI_TREE_CYLINDRICAL) {
                    const uint32_t at = n->type == SE3DI_TREE_PRISMATIC ? 0 : 1;
                    CHECK(!se3d_joint_get_coordinate(c.world.system, joint,
                                                     SE3D_JOINT_COORDINATE_DISPLACEMENT, &value,
                                                     &rate, NULL));
                    CHECK_NEAR(value, c.q[n->q + at], 1e-11);
                    CHECK_NEAR(rate, c.qdot[n->v + at], 1e-10);
                }
            }
        }
        end(&c);
    }
}

/* Accelerations of the tree at the state that was placed, into `acceleration` of bodies. */
static void accelerate(case_of *c, double *acceleration)
{
    double wrench[6 * (TREE_BODIES_MAX + 1)];
    uint32_t failed;
    CHECK(!se3di_loads_eval(c->model, 0.0, wrench, &failed));
    se3di_tree_take_wrenches(&c->tree, c->model->frames, wrench);
    CHECK(!se3di_tree_factor(&c->tree, NULL));
    se3di_tree_accelerate(&c->tree, c->tree.e, c->tree.qddot);
    se3di_tree_get_accelerations(&c->tree, c->model->frames, acceleration);
}

static void accelerations_are_those_of_the_maximal_equations(void)
{
    double worst = 0.0;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        se3di_equations e;
        double acceleration[6 * (TREE_BODIES_MAX + 1)];
        begin(&c, seed);
        accelerate(&c, acceleration);
        CHECK(!se3di_equations_init(&e, c.model, &se3di_formulation_romega, 1, NULL));
        CHECK(se3di_acceleration_solve(&e, 0.0) >= 0);
        const size_t count = 6 * c.model->body_slots.count;
        const double scale = 1.0 + largest(c.model->acceleration, count);
        const double off = difference(acceleration, c.model->acceleration, count) / scale;
        CHECK_NEAR(off, 0.0, 1e-11);
        worst = fmax(worst, off);
        se3di_equations_destroy(&e);
        end(&c);
    }
    printf("largest difference of accelerations: %.2g\n", worst);
}

/* What a tree finds of accelerations: of coordinates, of bodies, and what the joints exert. */
typedef struct findings {
    double qddot[NUMBERS], acceleration[6 * (TREE_BODIES_MAX + 1)], joint[6 * TREE_BODIES_MAX];
} findings;

static void find(case_of *c, const double *effort, findings *f)
{
    se3di_tree *tree = &c->tree;
    CHECK(!se3di_tree_factor(tree, effort));
    se3di_tree_accelerate(tree, tree->e, f->qddot);
    se3di_tree_get_accelerations(tree, c->model->frames, f->acceleration);
    tree->core->transmit(tree, tree->acts ? tree->wrench : NULL, 0, f->joint);
}

static double compare_findings(const se3di_tree *tree, const findings *a, const findings *b)
{
    const size_t v = tree->v_count, bodies = 6 * tree->body_count, joints = 6 * (size_t)tree->count;
    double off = difference(a->qddot, b->qddot, v) / (1.0 + largest(a->qddot, v));
    off = fmax(off, difference(a->acceleration, b->acceleration, bodies) /
                        (1.0 + largest(a->acceleration, bodies)));
    return fmax(off, difference(a->joint, b->joint, joints) / (1.0 + largest(a->joint, joints)));
}

/* Weights as wrenches with frames, and gravity that pulls without. */
static void gravity_needs_neither_wrenches_nor_frames(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        se3di_tree_link links[TREE_BODIES_MAX];
        double wrench[6 * (TREE_BODIES_MAX + 1)] = {0.0}, effort[NUMBERS], back[NUMBERS];
        findings a, b;
        begin(&c, seed);
        tree_vector(&c.world, effort, (int)c.tree.v_count, 5.0);
        for (uint32_t k = 0; k < c.tree.count; ++k) {
            const se3di_tree_node *n = &c.tree.nodes[k];
            se3di_scale(n->mass, c.model->gravity, wrench + 6 * n->body);
        }
        se3di_tree_take_wrenches(&c.tree, c.model->frames, wrench);
        find(&c, effort, &a);
        memcpy(links, c.tree.links, c.tree.count * sizeof *links);
        memset(c.tree.links, -1, c.tree.count * sizeof *links); /* not a number */
        se3di_tree_place(&c.tree, c.q, c.qdot, NULL);
        for (uint32_t k = 0; k < c.tree.count; ++k) {
            CHECK(memcmp(&links[k], &c.tree.links[k], offsetof(se3di_tree_link, a)) == 0);
        }
        se3di_tree_pull(&c.tree, c.model->gravity);
        find(&c, effort, &b);
        CHECK_NEAR(compare_findings(&c.tree, &a, &b), 0.0, 1e-11);
        se3di_tree_propagate(&c.tree, b.qddot);
        se3di_tree_efforts(&c.tree, b.qddot, b.joint, back);
        const double scale = 1.0 + largest(b.joint, 6 * (size_t)c.tree.count);
        CHECK_NEAR(difference(effort, back, c.tree.v_count) / scale, 0.0, 1e-11);
        end(&c);
    }
}

/* The equations of the loops without regularisation, at both instruction levels, and by the KKT
 * solver: the same accelerations. */
static void compare_systems(case_of *c, se3di_tree_loops *loops)
{
    const se3di_loop_core *const avx2 = se3di_loop_core_avx2();
    double other[6 * TREE_BODIES_MAX];
    if (!loops->is_clear) {
        return;
    }
    for (int k = 0; k < 2; ++k) {
        loops->system.core = k > 0 && avx2 ? avx2 : se3di_loop_core_portable();
        CHECK(se3di_tree_loops_factor(loops) == SE3D_OK && loops->is_clear);
        CHECK(!se3di_tree_loops_accelerate(loops, other));
        CHECK(memcmp(other, c->tree.qddot, c->tree.v_count * sizeof *other) == 0);
    }
    loops->system.is_there = 0;
    CHECK(se3di_tree_loops_factor(loops) >= 0 && !loops->is_clear);
    CHECK(se3di_tree_loops_accelerate(loops, other) >= 0);
    CHECK_NEAR(difference(other, c->tree.qddot, c->tree.v_count) /
                   (1.0 + largest(other, c->tree.v_count)),
               0.0, 1e-10);
    loops->system.is_there = 1;
    CHECK(se3di_tree_loops_factor(loops) == SE3D_OK);
    CHECK(!se3di_tree_loops_accelerate(loops, other));
}

static void solve_closed(case_of *c, se3di_tree_loops *loops, double *qddot)
{
    CHECK(!se3di_tree_factor(&c->tree, NULL));
    CHECK(se3di_tree_loops_factor(loops) >= 0);
    CHECK(se3di_tree_loops_accelerate(loops, qddot) >= 0);
}

/* Gravity as weights of the bodies, and as an acceleration of the ground: the same motion, with and
 * without the KKT solver. */
static void compare_pull(case_of *c, se3di_tree_loops *loops)
{
    static const double g[3] = {1.0, -9.0, 2.0};
    double weight[6 * (TREE_BODIES_MAX + 1)] = {0.0}, weighed[6 * TREE_BODIES_MAX];
    double pulled[6 * TREE_BODIES_MAX];
    const int32_t is_there = loops->system.is_there;
    for (size_t k = 0; k < 3 * c->model->body_slots.count; ++k) {
        weight[k / 3 * 6 + k % 3] = c->model->bodies[k / 3].mass * g[k % 3];
    }
    se3di_tree_take_wrenches(&c->tree, c->model->frames, weight);
    solve_closed(c, loops, weighed);
    se3di_tree_pull(&c->tree, g);
    for (int32_t k = is_there; k >= 0; --k) {
        loops->system.is_there = k;
        solve_closed(c, loops, pulled);
        CHECK_NEAR(difference(weighed, pulled, c->tree.v_count) /
                       (1.0 + largest(weighed, c->tree.v_count)),
                   0.0, 1e-10);
    }
    loops->system.is_there = is_there;
}

/* Of all rows, or (driven) of loops and drivers. */
static void find_multipliers(const case_of *c, se3di_tree_loops *loops, int driven, double *lambda)
{
    double joint[6 * TREE_BODIES_MAX], wrench[6 * TREE_BODIES_MAX];
    memcpy(wrench, c->tree.wrench, 6 * (size_t)c->tree.count * sizeof *wrench);
    se3di_tree_loops_add_wrenches(loops, loops->lambda, driven, wrench);
    c->tree.core->transmit(&c->tree, wrench, driven, joint);
    memcpy(lambda, loops->lambda, c->model->row_count * sizeof *lambda);
    se3di_tree_multipliers(&c->tree, joint, NULL, driven, lambda);
}

/* Those of drivers are the same to the bit where others are left out. */
static void compare_driven(case_of *c, se3di_tree_loops *loops, const double *lambda)
{
    double other[ROWS_MAX] = {0.0};
    find_multipliers(c, loops, 1, other);
    for (uint32_t k = 0; k < c->tree.count; ++k) {
        const int32_t driver = c->tree.nodes[k].driver;
        c->left_out += !c->tree.nodes[k].is_driven;
        if (driver >= 0) {
            const uint32_t row = c->model->constraints[driver].row_begin;
            CHECK(memcmp(lambda + row, other + row, sizeof *other) == 0);
        }
    }
}

/* The same state, both ways: the largest difference of accelerations, and that of multipliers, both
 * relative to the largest. Returns 0 where the constraints depend on each other. */
static int compare_closed(case_of *c, double time, double *accelerations, double *multipliers)
{
    se3di_equations e;
    se3di_tree_loops loops;
    double acceleration[6 * (TREE_BODIES_MAX + 1)];
    double wrench[6 * (TREE_BODIES_MAX + 1)], lambda[ROWS_MAX] = {0.0};
    uint32_t failed;
    const size_t count = 6 * c->model->body_slots.count, rows = c->model->row_count;
    CHECK(!se3di_equations_init(&e, c->model, &se3di_formulation_romega, 1, NULL));
    if (se3di_acceleration_solve(&e, time) != SE3D_OK || e.redundant) {
        se3di_equations_destroy(&e);
        return 0;
    }
    CHECK(!se3di_tree_loops_init(&loops, &c->tree, &e.assembly, NULL));
    CHECK(!se3di_loads_eval(c->model, time, wrench, &failed));
    se3di_tree_take_wrenches(&c->tree, c->model->frames, wrench);
    se3di_tree_take_given(&c->tree, &e.assembly);
    CHECK(!se3di_tree_factor(&c->tree, NULL));
    CHECK(se3di_tree_loops_factor(&loops) >= 0);
    CHECK(se3di_tree_loops_accelerate(&loops, c->tree.qddot) >= 0);
    se3di_tree_get_accelerations(&c->tree, c->model->frames, acceleration);
    *accelerations = difference(acceleration, c->model->acceleration, count) /
                     (1.0 + largest(c->model->acceleration, count));
    c->clear += loops.is_clear;
    c->loops += loops.row_count > 0;
    compare_systems(c, &loops);
    compare_pull(c, &loops);
    se3di_tree_take_wrenches(&c->tree, c->model->frames, wrench);
    solve_closed(c, &loops, c->tree.qddot);
    find_multipliers(c, &loops, 0, lambda);
    compare_driven(c, &loops, lambda);
    *multipliers =
        difference(lambda, c->model->lambda, rows) / (1.0 + largest(c->model->lambda, rows));
    se3di_tree_loops_destroy(&loops);
    se3di_equations_destroy(&e);
    return 1;
}

static void loops_and_reactions_are_those_of_the_maximal_equations(void)
{
    double worst[2] = {0.0, 0.0};
    int tried = 0, closed = 0, clear = 0;
    for (uint64_t seed = 0; seed < 3 * MECHANISMS; ++seed) {
        case_of c;
        double off[2];
        begin_closed(&c, seed, (int)(seed % 4));
        uint32_t rows = 0;
        for (uint32_t k = 0; k < c.tree.constraint_count; ++k) {
            rows += c.tree.tree_of[k] < 0 ? c.model->constraints[k].row_count : 0;
        }
        if ((rows + 3 <= c.tree.v_count || rows == 0) &&
            compare_closed(&c, 0.0, &off[0], &off[1])) {
            CHECK_NEAR(off[0], 0.0, 1e-11);
            CHECK_NEAR(off[1], 0.0, 1e-11);
            worst[0] = fmax(worst[0], off[0]);
            worst[1] = fmax(worst[1], off[1]);
            ++tried;
            closed += c.loops;
            clear += c.clear;
        }
        end(&c);
    }
    CHECK(tried > MECHANISMS);
    CHECK(clear > closed * 3 / 4 && closed > MECHANISMS / 2);
    printf("%d mechanisms, largest difference of accelerations %.2g, of multipliers %.2g\n", tried,
           worst[0], worst[1]);
}

/* Drivers of most of the joints with an angle or a displacement. */
static void drive(tree_world *w, const se3di_tree *tree)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        for (int s = 0; s < w->joint_count; ++s) {
            const uint32_t index = se3di_slots_find(&w->system->model.constraint_slots,
                                                    w->joints[s].index1, w->joints[s].generation);
            se3d_driver_def def = se3d_driver_def_default();
            se3d_constraint driver;
            if ((int32_t)index != n->constraint || n->v_count > 2 || n->v_count < 1 ||
                n->type == SE3DI_TREE_UNIVERSAL || tree_below(w, 3) == 0) {
                continue;
            }
            def.joint = w->joints[s];
            def.coordinate = n->type == SE3DI_TREE_PRISMATIC ? SE3D_JOINT_COORDINATE_DISPLACEMENT
                                                             : SE3D_JOINT_COORDINATE_ANGLE;
            CHECK(!se3d_function_create_expression(w->system, "sin(3*t)", &def.function));
            CHECK(!se3d_driver_create(w->system, &def, &driver));
        }
    }
}

static void prescribed_coordinates_move_as_their_drivers_say(void)
{
    int given = 0, left_out = 0;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        double off[2];
        begin_closed(&c, seed, seed % 3 == 0);
        drive(&c.world, &c.tree);
        se3di_tree_destroy(&c.tree);
        CHECK(!se3di_tree_init(&c.tree, c.model, 1, NULL));
        shake(&c.world, &c.tree, c.q, c.qdot);
        follow_turns(&c.tree, c.q);
        uint32_t rows = c.tree.given_count;
        for (uint32_t k = 0; k < c.tree.constraint_count; ++k) {
            rows += c.tree.tree_of[k] < 0 ? c.model->constraints[k].row_count : 0;
        }
        if (rows + 2 <= c.tree.v_count && compare_closed(&c, 0.4, &off[0], &off[1])) {
            CHECK_NEAR(off[0], 0.0, 1e-11);
            CHECK_NEAR(off[1], 0.0, 1e-11);
            given += (int)c.tree.given_count;
            left_out += c.left_out;
        }
        end(&c);
    }
    CHECK(given > 50 && left_out > 50);
}

/* Two bars and a coupler between two pivots, all hinges parallel: five equations close it, of which
 * two are independent, and where it is flat the pose adds one dependence more. */
static void build_window(tree_world *w, double angle)
{
    const double axis[3] = {0.0, 0.0, 1.0}, gravity[3] = {0.0, -9.81, 0.0};
    const double c = cos(angle), s = sin(angle);
    const double centres[3][3] = {
        {0.5 * c, 0.5 * s, 0.0}, {c + 0.5, s, 0.0}, {1 + 0.5 * c, 0.5 * s, 0.0}};
    const double pins[4][3] = {{0.0, 0.0, 0.0}, {c, s, 0.0}, {1 + c, s, 0.0}, {1.0, 0.0, 0.0}};
    const int sides[4][2] = {{0, 1}, {1, 2}, {2, 3}, {0, 3}};
    *w = (tree_world){.count = 1};
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &w->bodies[0]));
    CHECK(!se3d_system_set_gravity(w->system, gravity));
    for (int k = 0; k < 3; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = 1.0;
        def.inertia[0] = 1e-3;
        def.inertia[1] = def.inertia[2] = 1.0 / 12.0;
        memcpy(def.position, centres[k], sizeof def.position);
        def.orientation[0] = k == 1 ? 1.0 : cos(0.5 * angle);
        def.orientation[3] = k == 1 ? 0.0 : sin(0.5 * angle);
        def.velocity[0] = k == 1 ? -2.0 * s : -s;
        def.velocity[1] = k == 1 ? 2.0 * c : c;
        def.angular_velocity[2] = k == 1 ? 0.0 : 2.0;
        CHECK(!se3d_body_create(w->system, &def, &w->bodies[w->count++]));
    }
    for (int k = 0; k < 4; ++k) {
        se3d_joint_def def = se3d_joint_def_default();
        def.body_i = w->bodies[sides[k][0]];
        def.body_j = w->bodies[sides[k][1]];
        CHECK(!se3d_joint_def_set_frame(w->system, &def, pins[k], axis, NULL));
        CHECK(!se3d_joint_create_revolute(w->system, &def, &w->joints[w->joint_count++]));
    }
}

static void redundant_loops_and_singular_positions_give_the_same_accelerations(void)
{
    const double angles[5] = {1.0, 2.5, 1e-3, 1e-7, 0.0};
    for (int k = 0; k < 5; ++k) {
        tree_world w;
        se3di_tree tree;
        se3di_tree_loops loops;
        se3di_equations e;
        double acceleration[24], wrench[24];
        uint32_t failed;
        build_window(&w, angles[k]);
        se3di_model *model = &w.system->model;
        CHECK(!se3di_tree_init(&tree, model, 1, NULL));
        CHECK(tree.v_count == 3);
        CHECK(!se3di_equations_init(&e, model, &se3di_formulation_romega, 1, NULL));
        CHECK(se3di_acceleration_solve(&e, 0.0) >= 0);
        CHECK(!se3di_tree_loops_init(&loops, &tree, &e.assembly, NULL));
        CHECK(loops.row_count == 5);
        se3di_tree_get(&tree, tree.q, tree.qdot);
        se3di_tree_place(&tree, tree.q, tree.qdot, model->frames);
        CHECK(!se3di_loads_eval(model, 0.0, wrench, &failed));
        se3di_tree_take_wrenches(&tree, model->frames, wrench);
        CHECK(!se3di_tree_factor(&tree, NULL));
        CHECK(se3di_tree_loops_factor(&loops) >= 0);
        CHECK(se3di_tree_loops_accelerate(&loops, tree.qddot) >= 0);
        se3di_tree_get_accelerations(&tree, model->frames, acceleration);
        CHECK_NEAR(difference(acceleration, model->acceleration, 24), 0.0, k < 3 ? 1e-11 : 1e-6);
        se3di_tree_loops_destroy(&loops);
        se3di_equations_destroy(&e);
        se3di_tree_destroy(&tree);
        tree_world_destroy(&w);
    }
}

/* Rows of the loops times x, those that are kept. */
static void rows_mul(const se3di_tree_loops *loops, const double *x, double *c)
{
    const size_t columns = loops->tree->v_count;
    double G[6 * TREE_BODIES_MAX];
    for (uint32_t k = 0; k < loops->count; ++k) {
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            memset(G, 0, columns * sizeof *G);
            se3di_tree_loops_row(loops, k, (size_t)loops->kept[loops->row_begin[k] + (uint32_t)r],
                                 G);
            *c = 0.0;
            for (size_t v = 0; v < columns; ++v) {
                *c += G[v] * x[v];
            }
            ++c;
        }
    }
}

/* dq changes the rows by c, and no motion within the constraints has anything to do with it: x with
 * G x = 0 has x^T M dq = 0. By both ways of solving. */
static void corrections_are_the_least_ones(void)
{
    int tried[2] = {0, 0};
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        se3di_equations e;
        se3di_tree_loops loops;
        double dq[6 * TREE_BODIES_MAX], x[6 * TREE_BODIES_MAX], Mx[6 * TREE_BODIES_MAX];
        double wanted[16 * TREE_BODIES_MAX], got[16 * TREE_BODIES_MAX];
        begin_closed(&c, seed, 1 + (int)(seed % 3));
        CHECK(!se3di_equations_init(&e, c.model, &se3di_formulation_romega, 1, NULL));
        CHECK(!se3di_tree_loops_init(&loops, &c.tree, &e.assembly, NULL));
        const size_t n = c.tree.v_count;
        for (int way = 0; way < 2 && loops.row_count + 3 <= n; ++way) {
            loops.system.is_there &= way == 0;
            CHECK(!se3di_tree_factor(&c.tree, NULL));
            if (se3di_tree_loops_factor(&loops) != SE3D_OK ||
                se3di_tree_loops_count_dependent(&loops) > 0) {
                continue;
            }
            for (size_t k = 0; k < n; ++k) {
                x[k] = sin(1.0 + (double)k + (double)seed);
            }
            rows_mul(&loops, x, wanted);
            CHECK(se3di_tree_loops_correct(&loops, wanted, dq) >= 0);
            rows_mul(&loops, dq, got);
            const size_t rows = loops.count > 0 ? (size_t)loops.kept_begin[loops.count - 1] +
                                                      (size_t)loops.kept_count[loops.count - 1]
                                                : 0;
            CHECK_NEAR(difference(wanted, got, rows) / (1.0 + largest(wanted, rows)), 0.0, 1e-9);
            double along = 0.0, size = 1.0;
            for (size_t k = 0; k < n; ++k) {
                x[k] -= dq[k];
            }
            se3di_tree_mul(&c.tree, x, Mx);
            for (size_t k = 0; k < n; ++k) {
                along += Mx[k] * dq[k];
                size += fabs(Mx[k] * dq[k]);
            }
            CHECK_NEAR(along / size, 0.0, 1e-9);
            tried[way] += loops.row_count > 0;
        }
        se3di_tree_loops_destroy(&loops);
        se3di_equations_destroy(&e);
        end(&c);
    }
    CHECK(tried[0] > MECHANISMS / 4 && tried[1] > MECHANISMS / 4);
}

static void all_instruction_levels_give_the_same_bits(void)
{
    const se3di_tree_core *cores[3] = {se3di_tree_core_portable(), se3di_tree_core_avx2(),
                                       se3di_tree_core_avx512()};
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        double first[6 * (TREE_BODIES_MAX + 1)] = {0.0}, other[6 * (TREE_BODIES_MAX + 1)];
        begin(&c, seed);
        for (int k = 0; k < 3; ++k) {
            if (!cores[k]) {
                continue;
            }
            c.tree.core = cores[k];
            se3di_tree_place(&c.tree, c.q, c.qdot, c.model->frames);
            accelerate(&c, k == 0 ? first : other);
            CHECK(k == 0 ||
                  memcmp(first, other, 6 * c.model->body_slots.count * sizeof *first) == 0);
        }
        end(&c);
    }
}

/* The largest squares of velocities and angular velocities of the nodes' bodies. */
static void find_largest(const se3di_tree *tree, double squares[2])
{
    squares[0] = squares[1] = 0.0;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_frame *frame = &tree->model->frames[tree->nodes[k].body];
        squares[0] = fmax(squares[0], se3di_dot(frame->v, frame->v));
        squares[1] = fmax(squares[1], se3di_dot(frame->w, frame->w));
    }
}

/* From rest, velocities are a change of velocities, and the rates of positions by them are one of
 * positions: both move the bodies alike. In either lane, beside one that is not a number. */
static void changes_are_measured_at_the_bodies(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        double of_q[2 * NUMBERS] = {0.0}, of_qdot[2 * NUMBERS] = {0.0}, none[2 * NUMBERS];
        double room[SE3DI_TREE_CHANGES_ROOM * TREE_BODIES_MAX], parts[2][4], squares[2];
        double states[2];
        begin(&c, seed);
        for (int k = 0; k < 2 * NUMBERS; ++k) {
            none[k] = (double)NAN;
        }
        find_largest(&c.tree, squares);
        memcpy(c.tree.q, c.q, c.tree.q_count * sizeof *c.q);
        se3di_tree_rates(&c.tree, c.q, c.qdot, of_q);
        memcpy(of_qdot + c.tree.q_count, c.qdot, c.tree.v_count * sizeof *c.qdot);
        const double *const both[2] = {of_q, of_qdot}, *const broken[2] = {none, of_q};
        se3di_tree_measure(&c.tree, both, room, parts, states);
        CHECK(states[0] == 0.0 && states[1] == 0.0);
        CHECK_NEAR(parts[0][0], squares[0], 1e-13 * squares[0]);
        CHECK_NEAR(4.0 * parts[0][1], squares[1], 1e-13 * squares[1]);
        CHECK(parts[0][2] == 0.0 && parts[0][3] == 0.0);
        CHECK(parts[1][0] == 0.0 && parts[1][1] == 0.0);
        CHECK_NEAR(parts[1][2], squares[0], 1e-13 * squares[0]);
        CHECK_NEAR(parts[1][3], squares[1], 1e-13 * squares[1]);
        const double before[2] = {parts[0][0], parts[0][1]};
        se3di_tree_measure(&c.tree, broken, room, parts, states);
        CHECK(parts[1][0] == before[0] && parts[1][1] == before[1]);
        for (int k = 0; k < 4 && c.tree.v_count > 0; ++k) {
            CHECK(isnan(parts[0][k]));
        }
        end(&c);
    }
}

/* Four bodies on the ground, each with one more, or two with two (`shared`), by joints of a kind
 * (-1: none): `aligned`, along axes of the bodies where the kind can be. */
static void build_rows_of_four(tree_world *w, int first, int second, int aligned, int shared)
{
    const int kinds[2] = {first, second};
    *w = (tree_world){.count = 1, .seed = 7919u};
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &w->bodies[0]));
    for (int k = 1; k <= 8; ++k) {
        const int kind = kinds[k > 4], other = k <= 4 ? 0 : shared ? 1 + k % 2 : k - 4;
        const double upright[4] = {1.0, 0.0, 0.0, 0.0};
        double at[3];
        tree_add_body(w);
        if (aligned) {
            CHECK(!se3d_body_set_orientation(w->system, w->bodies[k], upright));
        }
        if (kind < 0) {
            continue;
        }
        if (!aligned || tree_kinds[kind].square) {
            tree_add_joint(w, other, k, &tree_kinds[kind]);
            continue;
        }
        se3d_joint_def def = se3d_joint_def_default();
        def.body_i = w->bodies[other];
        def.body_j = w->bodies[k];
        def.pitch = 0.2;
        CHECK(!se3d_body_get_position(w->system, w->bodies[k], at));
        CHECK(!se3d_joint_def_set_frame(w->system, &def, at, (double[]){0.0, 0.0, 1.0}, NULL));
        CHECK(!tree_kinds[kind].create(w->system, &def, &w->joints[w->joint_count++]));
    }
}

/* What a core places, into copies: links, freedoms, frames (NULL: none are wanted). */
static void place_by(const se3di_tree_core *core, case_of *c, int wants_frames,
                     se3di_tree_link *links, double *S, se3di_frame *frames)
{
    se3di_tree *tree = &c->tree;
    memset(tree->links, 0, tree->count * sizeof *tree->links);
    memset(tree->S, 0, 6 * tree->v_count * sizeof *tree->S);
    memset(frames, 0, tree->body_count * sizeof *frames);
    tree->core = core;
    se3di_tree_place(tree, c->q, c->qdot, wants_frames ? frames : NULL);
    memcpy(links, tree->links, tree->count * sizeof *links);
    memcpy(S, tree->S, 6 * tree->v_count * sizeof *S);
}

/* Frames without what accelerations need are those that are placed, from links of no state. */
static void check_shown(const se3di_tree_core *core, case_of *c, const se3di_frame *placed)
{
    se3di_tree *tree = &c->tree;
    se3di_frame frames[TREE_BODIES_MAX + 1];
    for (uint32_t k = 0; k < tree->count; ++k) {
        memset(&tree->links[k], 0xff, sizeof *tree->links);
    }
    memset(frames, 0, sizeof frames);
    tree->core = core;
    se3di_tree_show(tree, c->q, c->qdot, frames);
    CHECK(memcmp(frames, placed, tree->body_count * sizeof *frames) == 0);
}

#define FACTORS (6 + 6 + 6 + 4) /* of a freedom: U, V, acceleration of the link; D, R, e, qddot */

/* What a core makes of the state that was placed last and of `wrench`, into a copy. */
static void factor_by(const se3di_tree_core *core, case_of *c, const double *wrench,
                      const double *effort, double *out)
{
    se3di_tree *tree = &c->tree;
    const size_t v = tree->v_count;
    double *const from[] = {tree->D, tree->R, tree->e, tree->qddot, tree->U, tree->V};
    memset(tree->V, 0, 6 * v * sizeof *tree->V);
    tree->core = core;
    se3di_tree_take_wrenches(tree, c->model->frames, wrench);
    CHECK(!se3di_tree_factor(tree, effort));
    se3di_tree_accelerate(tree, tree->e, tree->qddot);
    for (size_t k = 0; k < sizeof from / sizeof *from; ++k) {
        const size_t count = k < 4 ? v : 6 * v;
        memcpy(out, from[k], count * sizeof *out);
        out += count;
    }
}

/* Also with the moments of inertia of one of four diagonal, so that three are left, and with
 * branches. */
static void inertias_side_by_side_have_the_bits_of_inertias_alone(void)
{
    uint32_t packs = 0, threes = 0;
    for (int n = 0; n < 4 * 9 * 8 * 2; ++n) {
        case_of c;
        double factors[2][FACTORS * NUMBERS] = {{0.0}};
        double wrench[6 * (TREE_BODIES_MAX + 1)] = {0.0}, effort[NUMBERS];
        build_rows_of_four(&c.world, n / 8 % 9 - 1, n / 72, n % 2, n / 4 % 2);
        c.model = &c.world.system->model;
        if (n / 2 % 2) {
            memset(c.model->bodies[6].J + 3, 0, 3 * sizeof *c.model->bodies[6].J);
        }
        CHECK(!se3di_tree_init(&c.tree, c.model, 1, NULL));
        shake(&c.world, &c.tree, c.q, c.qdot);
        tree_vector(&c.world, wrench, 6 * (c.world.count - 1), 1.0);
        tree_vector(&c.world, effort, (int)c.tree.v_count, 1.0);
        se3di_tree_place(&c.tree, c.q, c.qdot, c.model->frames);
        const se3di_tree_core *const best = c.tree.core;
        factor_by(se3di_tree_core_portable(), &c, wrench, effort, factors[0]);
        factor_by(best, &c, wrench, effort, factors[1]);
        CHECK(memcmp(factors[0], factors[1], sizeof factors[0]) == 0);
        for (uint32_t k = 0; k < c.tree.pack_count; ++k) {
            packs += c.tree.packs[k].factors != 0;
            threes += c.tree.packs[k].node[2] == c.tree.packs[k].node[3];
        }
        end(&c);
    }
    CHECK(!se3di_tree_core_avx2() || (packs > 900 && threes > 50));
}

/* Also with an angle beyond where lanes find its sine themselves. */
static void nodes_side_by_side_have_the_bits_of_nodes_alone(void)
{
    uint32_t packs = 0;
    for (int n = 0; n < 2 * 9 * 8 * 2; ++n) {
        case_of c;
        se3di_tree_link links[2][TREE_BODIES_MAX];
        double S[2][6 * NUMBERS];
        se3di_frame frames[2][TREE_BODIES_MAX + 1];
        build_rows_of_four(&c.world, n / 4 % 9 - 1, n / 36, n % 2, 0);
        c.model = &c.world.system->model;
        CHECK(!se3di_tree_init(&c.tree, c.model, 1, NULL));
        shake(&c.world, &c.tree, c.q, c.qdot);
        c.q[c.tree.nodes[3].q] += n / 2 % 2 ? 2e5 : 0.0;
        const se3di_tree_core *const best = c.tree.core;
        for (int frame = 0; frame < 2; ++frame) {
            place_by(se3di_tree_core_portable(), &c, frame, links[0], S[0], frames[0]);
            place_by(best, &c, frame, links[1], S[1], frames[1]);
            CHECK(memcmp(links[0], links[1], c.tree.count * sizeof *links[0]) == 0);
            CHECK(memcmp(S[0], S[1], 6 * c.tree.v_count * sizeof *S[0]) == 0);
            CHECK(memcmp(frames[0], frames[1], c.tree.body_count * sizeof *frames[0]) == 0);
        }
        check_shown(se3di_tree_core_portable(), &c, frames[0]);
        check_shown(best, &c, frames[0]);
        packs += c.tree.pack_count;
        CHECK(c.tree.pack_count <= c.tree.pack_max && c.tree.pack_max == 2);
        end(&c);
    }
    CHECK(!se3di_tree_core_avx2() || packs > 500);
}

static void frames_alone_have_the_bits_of_frames_with_links(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        se3di_tree_link links[TREE_BODIES_MAX];
        double S[6 * NUMBERS];
        se3di_frame frames[TREE_BODIES_MAX + 1];
        begin(&c, seed);
        const se3di_tree_core *const best = c.tree.core;
        place_by(best, &c, 1, links, S, frames);
        check_shown(se3di_tree_core_portable(), &c, frames);
        check_shown(best, &c, frames);
        end(&c);
    }
}

/* z' = f to the bit, by one coordinate more; the accelerations of the others stay. */
static void a_state_is_a_node_of_one_coordinate(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        case_of c;
        const se3d_state_def def = se3d_state_def_default();
        se3d_state state;
        double wrench[6 * (TREE_BODIES_MAX + 2)] = {0.0}, before[NUMBERS], qddot[NUMBERS];
        begin(&c, seed);
        const uint32_t q = c.tree.q_count, v = c.tree.v_count;
        tree_vector(&c.world, wrench, 6 * (c.world.count - 1), 1.0);
        se3di_tree_take_wrenches(&c.tree, c.model->frames, wrench);
        CHECK(!se3di_tree_factor(&c.tree, NULL));
        se3di_tree_accelerate(&c.tree, c.tree.e, before);
        se3di_tree_destroy(&c.tree);
        CHECK(!se3d_state_create(c.world.system, &def, &state));
        CHECK(!se3di_tree_init(&c.tree, c.model, 1, NULL));
        const uint32_t body = c.tree.nodes[c.tree.count - 1].body;
        CHECK(c.tree.q_count == q + 1 && c.tree.v_count == v + 1);
        CHECK(c.model->bodies[body].state != 0);
        c.q[q] = 3.0;
        c.qdot[v] = -2.0;
        se3di_tree_place(&c.tree, c.q, c.qdot, c.model->frames);
        se3di_tree_get(&c.tree, c.q, c.qdot);
        CHECK(c.q[q] == 3.0 && c.qdot[v] == -2.0);
        wrench[6 * body] = SE3DI_CARRIER_MASS * 0.7;
        se3di_tree_take_wrenches(&c.tree, c.model->frames, wrench);
        CHECK(!se3di_tree_factor(&c.tree, NULL));
        se3di_tree_accelerate(&c.tree, c.tree.e, qddot);
        CHECK(qddot[v] == 0.7 && memcmp(before, qddot, v * sizeof *qddot) == 0);
        end(&c);
    }
}

int main(void)
{
    RUN(every_body_is_a_node_and_parents_come_first);
    RUN(coordinates_give_states_that_meet_the_joints);
    RUN(reading_gives_the_coordinates_back);
    RUN(coordinates_are_those_of_the_joints);
    RUN(accelerations_are_those_of_the_maximal_equations);
    RUN(gravity_needs_neither_wrenches_nor_frames);
    RUN(loops_and_reactions_are_those_of_the_maximal_equations);
    RUN(prescribed_coordinates_move_as_their_drivers_say);
    RUN(redundant_loops_and_singular_positions_give_the_same_accelerations);
    RUN(corrections_are_the_least_ones);
    RUN(all_instruction_levels_give_the_same_bits);
    RUN(changes_are_measured_at_the_bodies);
    RUN(nodes_side_by_side_have_the_bits_of_nodes_alone);
    RUN(frames_alone_have_the_bits_of_frames_with_links);
    RUN(inertias_side_by_side_have_the_bits_of_inertias_alone);
    RUN(a_state_is_a_node_of_one_coordinate);
    return check_finish();
}
