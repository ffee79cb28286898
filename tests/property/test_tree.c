/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint coordinates against the maximal ones on random trees of all joint types: poses and
 * velocities that coordinates give meet the joints, reading gives the coordinates back, and
 * accelerations are those of the KKT system. */
#include "support/tree_world.h"

#include "assembly/loads.h"
#include "nonlinear/equations.h"
#include "tree/core.h"
#include "tree/tree.h"

#include <stdlib.h>

enum { MECHANISMS = 120, NUMBERS = 7 * TREE_BODIES_MAX };

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

typedef struct case_of {
    tree_world world;
    se3di_model *model;
    se3di_tree tree;
    double q[NUMBERS], qdot[NUMBERS];
} case_of;

static void begin(case_of *c, uint64_t seed)
{
    tree_world_init(&c->world, seed, 1 + (int)(seed % TREE_BODIES_MAX), 0);
    c->model = &c->world.system->model;
    CHECK(!se3di_tree_init(&c->tree, c->model, NULL));
    shake(&c->world, &c->tree, c->q, c->qdot);
    follow_turns(&c->tree, c->q);
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
        CHECK(!se3di_equations_init(&e, c.model, &se3di_formulation_romega, NULL));
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
        CHECK(!se3di_equations_init(&e, c.model, &se3di_formulation_romega, NULL));
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

int main(void)
{
    RUN(every_body_is_a_node_and_parents_come_first);
    RUN(coordinates_give_states_that_meet_the_joints);
    RUN(reading_gives_the_coordinates_back);
    RUN(coordinates_are_those_of_the_joints);
    RUN(accelerations_are_those_of_the_maximal_equations);
    RUN(all_instruction_levels_give_the_same_bits);
    return check_finish();
}
