/* SPDX-License-Identifier: BSD-3-Clause */
/* What stands side by side in lanes as the corners of a vehicle do: leaves of a tree beside deeper
 * nodes, rows of four loops on their way down. The bits are those of each alone. */
#include "support/tree_world.h"

#include "nonlinear/equations.h"
#include "tree/core.h"
#include "tree/loop_core.h"
#include "tree/loops.h"
#include "tree/recursion.h"

#include <string.h>

enum { FREEDOMS = 6 * TREE_BODIES_MAX };
enum { REVOLUTE, SPHERICAL, PRISMATIC };

typedef struct place {
    tree_world world;
    se3di_model *model;
    se3di_tree tree;
    double wrench[6 * (TREE_BODIES_MAX + 1)];
} place;

static void begin_world(tree_world *w, uint64_t seed)
{
    *w = (tree_world){.count = 1, .seed = 7919u + 104729u * seed};
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &w->bodies[0]));
}

/* At the poses of the bodies, with random wrenches on them. */
static void begin(place *p)
{
    p->model = &p->world.system->model;
    CHECK(!se3di_tree_init(&p->tree, p->model, 1, NULL));
    se3di_tree_refresh(&p->tree);
    tree_vector(&p->world, p->wrench, 6 * p->world.count, 1.0);
}

static void end(place *p)
{
    se3di_tree_destroy(&p->tree);
    tree_world_destroy(&p->world);
}

/* ---- leaves ---- */

/* What a core makes: frames, inertias times freedoms, accelerations. */
typedef struct outcome {
    se3di_frame frames[TREE_BODIES_MAX + 1], shown[TREE_BODIES_MAX + 1];
    double U[6 * FREEDOMS], D[FREEDOMS], e[FREEDOMS], qddot[FREEDOMS];
} outcome;

static void run_core(place *p, const se3di_tree_core *core, outcome *o)
{
    se3di_tree *tree = &p->tree;
    const size_t v = tree->v_count * sizeof(double), frames = tree->body_count * sizeof *o->frames;
    memset(o, 0, sizeof *o);
    tree->core = core;
    memcpy(o->shown, p->model->frames, frames);
    memcpy(o->frames, p->model->frames, frames);
    se3di_tree_show(tree, tree->q, tree->qdot, o->shown);
    se3di_tree_place(tree, tree->q, tree->qdot, o->frames);
    se3di_tree_take_wrenches(tree, o->frames, p->wrench);
    CHECK(!se3di_tree_factor(tree, NULL));
    memcpy(o->U, tree->U, 6 * v);
    memcpy(o->D, tree->D, v);
    memcpy(o->e, tree->e, v);
    se3di_tree_accelerate(tree, tree->e, o->qddot);
}

/* Two arms on a body, and two on a slide of it, whose joints are alike; `carries`: the first arm
 * has one more, so that it cannot wait for those of the slide. */
static void build_arms(tree_world *w, uint64_t seed, int carries)
{
    begin_world(w, seed);
    for (int k = 1; k <= 6 + carries; ++k) {
        tree_add_body(w);
    }
    tree_add_joint(w, 1, 2, &tree_kinds[REVOLUTE]);
    tree_add_joint(w, 1, 3, &tree_kinds[REVOLUTE]);
    tree_add_joint(w, 1, 4, &tree_kinds[PRISMATIC]);
    tree_add_joint(w, 4, 5, &tree_kinds[REVOLUTE]);
    tree_add_joint(w, 4, 6, &tree_kinds[REVOLUTE]);
    if (carries) {
        tree_add_joint(w, 2, 7, &tree_kinds[REVOLUTE]);
    }
}

static int has_body(const place *p, const se3di_tree_pack *pack, uint32_t body)
{
    int has = 0;
    for (int k = 0; k < SE3DI_TREE_PACK; ++k) {
        has |= p->tree.nodes[pack->node[k]].body == body;
    }
    return has;
}

static void leaves_stand_beside_deeper_nodes_with_the_bits_of_nodes_alone(void)
{
    for (uint64_t n = 0; n < 20; ++n) {
        place p;
        outcome best, alone;
        const int carries = (int)(n % 2);
        build_arms(&p.world, n, carries);
        begin(&p);
        const se3di_tree_core *const core = p.tree.core;
        run_core(&p, core, &best);
        run_core(&p, se3di_tree_core_portable(), &alone);
        CHECK(memcmp(&best, &alone, sizeof best) == 0);
        CHECK(memcmp(best.frames, best.shown, p.tree.body_count * sizeof *best.frames) == 0);
        if (core->has_packs) {
            CHECK(p.tree.pack_count == 1 && p.tree.pack_max >= 1);
            CHECK(has_body(&p, p.tree.packs, 3) && has_body(&p, p.tree.packs, 5));
            CHECK(has_body(&p, p.tree.packs, carries ? 7 : 2) && has_body(&p, p.tree.packs, 6));
        }
        end(&p);
    }
}

/* Nodes on the ground have no parent to gather, and do not wait. */
static void leaves_on_the_ground_do_not_wait(void)
{
    place p;
    outcome best, alone;
    begin_world(&p.world, 3);
    for (int k = 1; k <= 5; ++k) {
        tree_add_body(&p.world);
    }
    tree_add_joint(&p.world, 0, 1, &tree_kinds[REVOLUTE]);
    tree_add_joint(&p.world, 0, 2, &tree_kinds[REVOLUTE]);
    tree_add_joint(&p.world, 0, 3, &tree_kinds[PRISMATIC]);
    tree_add_joint(&p.world, 3, 4, &tree_kinds[REVOLUTE]);
    tree_add_joint(&p.world, 3, 5, &tree_kinds[REVOLUTE]);
    begin(&p);
    CHECK(p.tree.pack_count == 0);
    run_core(&p, p.tree.core, &best);
    run_core(&p, se3di_tree_core_portable(), &alone);
    CHECK(memcmp(&best, &alone, sizeof best) == 0);
    end(&p);
}

/* ---- loops ---- */

/* Four arms on a body that is free, or on the ground, each with an upright that a ball holds to the
 * arm and another to that body; `odd`: the last arm has a joint of another kind. */
static void build_corners(tree_world *w, uint64_t seed, int kind, int is_free, int odd)
{
    const int root = is_free;
    begin_world(w, seed);
    for (int k = 0; k < 8 + is_free; ++k) {
        tree_add_body(w);
    }
    for (int k = 0; k < 4; ++k) {
        const int arm = root + 1 + 2 * k, own = odd && k == 3 ? (kind + 2) % 4 : kind;
        tree_add_joint(w, root, arm, &tree_kinds[own]);
        tree_add_joint(w, root, arm + 1, &tree_kinds[SPHERICAL]);
        tree_add_joint(w, arm, arm + 1, &tree_kinds[SPHERICAL]);
    }
}

static void solve(place *p, se3di_tree_loops *loops, const se3di_loop_core *core, double *qddot)
{
    loops->system.core = core;
    CHECK(!se3di_tree_factor(&p->tree, NULL));
    CHECK(se3di_tree_loops_factor(loops) >= 0);
    CHECK(se3di_tree_loops_accelerate(loops, qddot) >= 0);
}

/* Numbers of rows; of lanes without a row zeros may have either sign. */
static int are_equal(const double *a, const double *b, size_t count)
{
    int equal = 1;
    for (size_t k = 0; k < count; ++k) {
        equal &= !(a[k] < b[k]) && !(a[k] > b[k]);
    }
    return equal;
}

/* By lanes for loops where there are, and one after the other. Returns whether the rows were clear
 * of each other. */
static int compare_cores(place *p, se3di_tree_loops *loops)
{
    static double Y[2][SE3DI_STRIP * 2 * FREEDOMS];
    double c[2][SE3DI_STRIP * 8], weight[2][SE3DI_STRIP * 8], qddot[2][FREEDOMS];
    const se3di_loop_core *const avx2 = se3di_loop_core_avx2();
    const se3di_loop_system *s = &loops->system;
    const size_t rows = SE3DI_STRIP * (size_t)s->row_strips, numbers = SE3DI_STRIP * s->quad_count;
    CHECK(s->row_strips == 4 && numbers <= sizeof Y[0] / sizeof Y[0][0]);
    for (int k = 0; k < 2; ++k) {
        solve(p, loops, k == 0 && avx2 ? avx2 : se3di_loop_core_portable(), qddot[k]);
        memcpy(Y[k], s->Y, numbers * sizeof **Y);
        memcpy(c[k], s->c, rows * sizeof **c);
        memcpy(weight[k], s->weight, rows * sizeof **weight);
    }
    CHECK(are_equal(Y[0], Y[1], numbers));
    CHECK(are_equal(c[0], c[1], rows) && are_equal(weight[0], weight[1], rows));
    CHECK(memcmp(qddot[0], qddot[1], p->tree.v_count * sizeof **qddot) == 0);
    return loops->is_clear;
}

static void loops_side_by_side_have_the_bits_of_loops_alone(void)
{
    static const double g[3] = {1.0, -9.0, 2.0};
    int clear = 0, tried = 0;
    for (int n = 0; n < 5 * 2 * 2 * 4; ++n) {
        place p;
        se3di_equations e;
        se3di_tree_loops loops;
        const int kind = n % 5 == SPHERICAL ? REVOLUTE : n % 5, odd = n / 20 % 2;
        build_corners(&p.world, (uint64_t)n, kind, n / 10 % 2, odd);
        begin(&p);
        CHECK(!se3di_equations_init(&e, p.model, &se3di_formulation_romega, 1, NULL));
        CHECK(!se3di_tree_loops_init(&loops, &p.tree, &e.assembly, NULL));
        CHECK(loops.system.team_count == !odd);
        se3di_tree_place(&p.tree, p.tree.q, p.tree.qdot, p.model->frames);
        se3di_tree_take_wrenches(&p.tree, p.model->frames, p.wrench);
        clear += compare_cores(&p, &loops);
        se3di_tree_pull(&p.tree, g);
        clear += compare_cores(&p, &loops);
        tried += 2;
        se3di_tree_loops_destroy(&loops);
        se3di_equations_destroy(&e);
        end(&p);
    }
    CHECK(clear > tried / 2);
}

int main(void)
{
    RUN(leaves_stand_beside_deeper_nodes_with_the_bits_of_nodes_alone);
    RUN(leaves_on_the_ground_do_not_wait);
    RUN(loops_side_by_side_have_the_bits_of_loops_alone);
    return check_finish();
}
