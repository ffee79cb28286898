/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of explicit methods in joint coordinates: y = (q, qdot) and the works.
 *
 * qddot comes from articulated bodies and the rows of loops that the tree does not imply; with
 * friction that needs the loads of joints, and with loops at the tightest tolerances, from the
 * equations of the bodies, which have all rows: it is what these accelerations are at the joints,
 *
 *     S qddot = (alpha, a) - (alpha_p, a_p + alpha_p x d) - c    least squares, exact on the tree
 *
 * Only loops need projection.  docs/theory/joint_coordinates.md */
#include "integrator/joint_projection.h"
#include "integrator/motion.h"

#include "assembly/energy.h"
#include "base/floats.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"
#include "tree/core.h"
#include "tree/loops.h"
#include "tree/recursion.h"

#include <math.h>
#include <string.h>

#define FREEDOMS_MAX 6
#define TURN         6.283185307179586
#define MODERATE     1e200 /* squares of coordinates and rates */

static size_t count(const se3di_equations *equations)
{
    const se3di_tree *tree = equations->tree;
    return (size_t)tree->q_count + tree->v_count + SE3DI_STATE_WORK;
}

/* The place of the quaternion of a node among the positions, < 0: it has none. */
static ptrdiff_t place_of_quaternion(const se3di_tree_node *node)
{
    return node->type == SE3DI_TREE_FREE        ? (ptrdiff_t)node->q + 3
           : node->type == SE3DI_TREE_SPHERICAL ? (ptrdiff_t)node->q
                                                : -1;
}

static double *quaternion_of(const se3di_tree_node *node, double *q)
{
    const ptrdiff_t at = place_of_quaternion(node);
    return at < 0 ? NULL : q + at;
}

static void normalise(const se3di_tree *tree, double *q)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        double *p = quaternion_of(&tree->nodes[k], q);
        if (p) {
            se3di_quat_normalize(p, p);
        }
    }
}

/* tree->q, tree->qdot and the links are the state that was set last. */
static void place(se3di_equations *equations)
{
    se3di_tree *tree = equations->tree;
    se3di_tree_place(tree, tree->q, tree->qdot, equations->assembly.model->frames);
    equations->is_placed = 1;
}

static void take_state(se3di_tree *tree, const double *y)
{
    memcpy(tree->q, y, tree->q_count * sizeof *y);
    memcpy(tree->qdot, y + tree->q_count, tree->v_count * sizeof *y);
    normalise(tree, tree->q);
}

static void set(se3di_equations *equations, const double *y)
{
    take_state(equations->tree, y);
    place(equations);
}

static void take(se3di_equations *equations, const double *y)
{
    take_state(equations->tree, y);
    equations->is_placed = 0;
}

/* Of coordinates and rates that are, unit quaternions among them, the frames are finite. */
static int are_moderate(size_t count, const double *x)
{
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    size_t k = 0;
    for (; k + 4 <= count; k += 4) {
        for (size_t m = 0; m < 4; ++m) {
            sum[m] += x[k + m] * x[k + m];
        }
    }
    for (; k < count; ++k) {
        sum[0] += x[k] * x[k];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]) < MODERATE;
}

static int set_frames(se3di_equations *equations, const double *y)
{
    se3di_tree *tree = equations->tree;
    take_state(tree, y);
    se3di_tree_show(tree, tree->q, tree->qdot, equations->assembly.model->frames);
    equations->is_placed = 0;
    return are_moderate(tree->q_count, tree->q) && are_moderate(tree->v_count, tree->qdot);
}

/* Unit length may round to another neighbour twice, so that the whole state is compared. */
static void set_again(se3di_equations *equations, const double *y)
{
    const se3di_tree *tree = equations->tree;
    const size_t size = tree->v_count * sizeof *y;
    double *before = equations->joint_before;
    memcpy(before, tree->q, tree->q_count * sizeof *before);
    const int is_same = memcmp(tree->qdot, y + tree->q_count, size) == 0;
    take_state(equations->tree, y);
    if (!is_same || !equations->is_placed ||
        memcmp(tree->q, before, tree->q_count * sizeof *before) != 0) {
        place(equations);
    }
}

static void keep(se3di_equations *equations, double *y)
{
    const se3di_tree *tree = equations->tree;
    memcpy(y, tree->q, tree->q_count * sizeof *y);
    memcpy(y + tree->q_count, tree->qdot, tree->v_count * sizeof *y);
}

/* The same, but the frames of the model stay. */
static void place_aside(se3di_equations *equations)
{
    se3di_tree *tree = equations->tree;
    se3di_tree_place(tree, tree->q, tree->qdot, tree->frames);
    equations->is_placed = 1;
}

/* Nothing is placed twice: a step ends where the next one begins. Else the coordinates may be some
 * turns from those that a tree which has just been made reads from the frames. */
static void stand(se3di_equations *equations, const double *y)
{
    se3di_tree *tree = equations->tree;
    const size_t q_size = tree->q_count * sizeof *y, v_size = tree->v_count * sizeof *y;
    if (equations->is_placed && memcmp(tree->q, y, q_size) == 0 &&
        memcmp(tree->qdot, y + tree->q_count, v_size) == 0) {
        return;
    }
    memcpy(tree->q, y, q_size);
    memcpy(tree->qdot, y + tree->q_count, v_size);
    se3di_tree_match_signs(tree);
    equations->is_placed = 1;
}

/* The coordinates are the angles; others are those of joints that close loops, and of forces. */
static void accept_angles(se3di_equations *equations)
{
    const se3di_tree *tree = equations->tree;
    se3di_model *model = equations->assembly.model;
    if (tree->angle_count != model->angle_count) {
        se3di_angles_accept(model);
        return;
    }
    for (uint32_t k = 0; k < tree->angle_count; ++k) {
        const int32_t at = tree->counted[k];
        model->angles[k].theta = at >= 0 ? tree->q[at] : se3di_angle_value(model, k);
    }
    se3di_left_out_follow(model);
}

static void get(se3di_equations *equations, double *y)
{
    se3di_tree *tree = equations->tree;
    const se3di_model *model = equations->assembly.model;
    se3di_tree_get(tree, tree->q, tree->qdot);
    normalise(tree, tree->q);
    se3di_tree_match_turns(tree, tree->q); /* which places it aside */
    equations->is_placed = 1;
    keep(equations, y);
    memcpy(y + tree->q_count + tree->v_count, model->work, sizeof model->work);
}

static const double *get_rates(se3di_equations *equations, const double *derivative, double *out)
{
    se3di_tree *tree = equations->tree;
    const se3di_assembly *assembly = &equations->assembly;
    static const double none[3] = {0.0, 0.0, 0.0};
    se3di_tree_pull(tree, none); /* whatever was evaluated before */
    se3di_tree_propagate(tree, derivative + tree->q_count);
    for (uint32_t k = 0; k < tree->count; ++k) {
        const uint32_t body = tree->nodes[k].body;
        se3di_tree_link_acceleration(tree, k, &assembly->model->frames[body],
                                     out + SE3DI_STATE_SIZE * (size_t)assembly->free_index[body] +
                                         7);
    }
    return out;
}

/* Rates of positions and works beside the accelerations of bodies. */
static se3d_status complete(se3di_equations *equations, double t, const double *l,
                            double *derivative)
{
    const se3di_tree *tree = equations->tree;
    se3di_tree_rates(tree, tree->q, tree->qdot, derivative);
    return se3di_state_powers(&equations->assembly, t, l,
                              derivative + tree->q_count + tree->v_count);
}

/* Rates of quaternions that are not normalised are as much too large. */
static void move(const se3di_equations *equations, const double *y, double *derivative)
{
    const se3di_tree *tree = equations->tree;
    se3di_tree_rates(tree, y, y + tree->q_count, derivative);
    for (uint32_t k = 0; k < tree->count; ++k) {
        const ptrdiff_t at = place_of_quaternion(&tree->nodes[k]);
        if (at >= 0) {
            const double *p = y + at;
            const double size = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
            double *rate = derivative + at;
            for (int c = 0; c < 4; ++c) {
                rate[c] /= size;
            }
        }
    }
}

/* ---- accelerations of bodies -> joints ---- */

/* Of a node's point: angular, linear. */
static void point_acceleration(const se3di_tree_link *link, const se3di_frame *frame,
                               const double acceleration[6], double a[6])
{
    double turning[3], x[3];
    se3di_mul(frame->A, acceleration + 3, a);
    se3di_cross(a, link->s, x);
    se3di_sub(acceleration, x, a + 3);
    se3di_cross(link->w, link->s, turning);
    se3di_cross(link->w, turning, x);
    se3di_sub(a + 3, x, a + 3);
}

/* The part of a node's acceleration that its own freedoms make. */
static void own_acceleration(const se3di_tree *tree, const se3di_tree_node *node, double own[6])
{
    const se3di_tree_link *link = &tree->links[node - tree->nodes];
    double x[3];
    for (int k = 0; k < 6; ++k) {
        own[k] = link->a[k] - link->c[k];
    }
    if (node->parent >= 0) {
        const double *a = tree->links[node->parent].a;
        se3di_cross(a, link->d, x);
        for (int k = 0; k < 3; ++k) {
            own[k] -= a[k];
            own[3 + k] -= a[3 + k] + x[k];
        }
    }
}

/* x: G x = x with G symmetric and positive [n * n], by Cholesky; G is overwritten. */
static void solve_small(int n, double *G, double *x)
{
    for (int r = 0; r < n; ++r) {
        for (int c = 0; c <= r; ++c) {
            double sum = G[n * r + c];
            for (int k = 0; k < c; ++k) {
                sum -= G[n * r + k] * G[n * c + k];
            }
            G[n * r + c] = c < r ? sum / G[n * c + c] : sqrt(sum);
        }
        for (int k = 0; k < r; ++k) {
            x[r] -= G[n * r + k] * x[k];
        }
        x[r] /= G[n * r + r];
    }
    for (int r = n - 1; r >= 0; --r) {
        for (int k = r + 1; k < n; ++k) {
            x[r] -= G[n * k + r] * x[k];
        }
        x[r] /= G[n * r + r];
    }
}

static void fit(const double *S, int n, const double own[6], double *qddot)
{
    double G[FREEDOMS_MAX * FREEDOMS_MAX];
    for (int r = 0; r < n; ++r) {
        qddot[r] = 0.0;
        for (int k = 0; k < 6; ++k) {
            qddot[r] += S[6 * r + k] * own[k];
        }
        for (int c = 0; c <= r; ++c) {
            G[n * r + c] = 0.0;
            for (int k = 0; k < 6; ++k) {
                G[n * r + c] += S[6 * r + k] * S[6 * c + k];
            }
        }
    }
    solve_small(n, G, qddot);
}

static se3d_status derive(se3di_equations *equations, double t, const double *l, double *derivative)
{
    se3di_tree *tree = equations->tree;
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_frame *frames = assembly->model->frames;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *node = &tree->nodes[k];
        const double *x = equations->x + 6 * (size_t)assembly->free_index[node->body];
        double own[6];
        point_acceleration(&tree->links[k], &frames[node->body], x, tree->links[k].a);
        own_acceleration(tree, node, own);
        fit(tree->S + 6 * (size_t)node->v, node->v_count, own,
            derivative + tree->q_count + node->v);
    }
    return complete(equations, t, l, derivative);
}

/* ---- evaluation ---- */

/* Nothing but the tree constrains the motion, and nothing that acts depends on multipliers. */
static int is_open(const se3di_equations *equations)
{
    return equations->is_open_tree;
}

/* Accelerations come from the equations of the bodies: friction needs the loads of joints, loops
 * are to have the least noise, or there is an armature on no coordinate of the tree. */
static int is_loaded(const se3di_equations *equations)
{
    return equations->friction.count > 0 || equations->tree->foreign_armature >= 0 ||
           (equations->has_loops && !equations->takes_rows);
}

/* Multipliers of all rows, from those of the loops and what joints transmit; driven: of loops and
 * drivers, which is all that powers need. */
static void transmit(se3di_equations *equations, int driven, double *l)
{
    const se3di_tree *tree = equations->tree;
    const size_t wrenches = 6 * (size_t)tree->count;
    double *joint = equations->joint_moves, *wrench = joint + wrenches;
    const double *acting = tree->acts ? tree->wrench : NULL;
    if (equations->has_loops) {
        const double *lambda = equations->loops.lambda;
        memcpy(l, lambda, equations->assembly.row_count * sizeof *lambda);
        if (acting) {
            memcpy(wrench, acting, wrenches * sizeof *wrench);
        } else {
            memset(wrench, 0, wrenches * sizeof *wrench);
        }
        se3di_tree_loops_add_wrenches(&equations->loops, lambda, driven, wrench);
        acting = wrench;
    }
    if (tree->given_count > 0 || !driven) {
        tree->core->transmit(tree, acting, driven, joint);
        se3di_tree_multipliers(tree, joint, se3di_tree_effort(tree), driven, l);
    }
}

/* The same into equations->l, if drivers have a power: of all rows if elements remember, or
 * users have constraints. */
static const double *find_multipliers(se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    if (assembly->timed_count == 0 && assembly->user_count == 0) {
        return NULL;
    }
    const int driven = assembly->user_count == 0 && !se3di_forces_have_memory(assembly->model);
    transmit(equations, driven, equations->l);
    return equations->l;
}

/* By the links alone; near singular positions all rows are needed, and with them the frames. */
static se3d_status factor_loops(se3di_equations *equations)
{
    if (equations->is_placed) {
        return se3di_tree_loops_factor(&equations->loops);
    }
    if (se3di_tree_loops_factor_links(&equations->loops)) {
        return SE3D_OK;
    }
    place(equations);
    return se3di_tree_loops_factor(&equations->loops);
}

/* Accelerations of the tree from what acts; with loops their multipliers, too. */
static se3d_status solve_motion(se3di_equations *equations, double *qddot)
{
    se3di_tree *tree = equations->tree;
    SE3DI_TRY(se3di_tree_factor(tree, se3di_tree_effort(tree)));
    if (!equations->has_loops) {
        se3di_tree_accelerate(tree, tree->e, qddot);
        return SE3D_OK;
    }
    SE3DI_TRY(factor_loops(equations));
    return se3di_tree_loops_accelerate(&equations->loops, qddot);
}

/* Rates of positions and works beside the accelerations of the tree; `power`: of elements. */
static se3d_status complete_tree(se3di_equations *equations, double t, const double power[2],
                                 double *derivative)
{
    const se3di_tree *tree = equations->tree;
    double *works = derivative + tree->q_count + tree->v_count;
    se3di_tree_rates(tree, tree->q, tree->qdot, derivative);
    memcpy(works, power, 2 * sizeof *works);
    return se3di_state_complete_powers(&equations->assembly, t, find_multipliers(equations), works);
}

/* With all that acts in the tree. */
static se3d_status finish(se3di_equations *equations, double t, double power[2], double *derivative)
{
    se3di_tree *tree = equations->tree;
    double *qddot = derivative + tree->q_count;
    for (uint32_t v = 0; tree->has_efforts && v < tree->v_count; ++v) {
        power[1] += tree->effort[v] * tree->qdot[v];
    }
    se3d_status status = solve_motion(equations, qddot);
    for (uint32_t k = 0; k < tree->v_count && status >= 0; ++k) {
        status = isfinite(qddot[k]) ? status : SE3D_ERR_NOT_FINITE;
    }
    if (status < 0) {
        return se3di_error_set(equations->error, status,
                               "t = %g s: the equations are singular or not finite", t);
    }
    return complete_tree(equations, t, power, derivative);
}

/* Loops whose rows come from the links, without functions of time. */
static int has_plain_loops(const se3di_equations *equations)
{
    return equations->has_loops && !is_loaded(equations) && equations->tree->given_count == 0 &&
           equations->assembly.timed_count == 0 && equations->assembly.user_count == 0 &&
           se3di_tree_loops_need_links_only(&equations->loops);
}

/* Gravity and efforts are all that acts: no frame of a body is needed. */
static int falls(const se3di_equations *equations)
{
    return (is_open(equations) || has_plain_loops(equations)) && !equations->assembly.push &&
           se3di_tree_falls(equations->tree);
}

/* With the efforts of the last sums. */
static se3d_status fall_again(se3di_equations *equations, double t, double *derivative)
{
    double power[2] = {0.0, 0.0};
    se3di_tree_pull(equations->tree, equations->assembly.model->gravity);
    return finish(equations, t, power, derivative);
}

static se3d_status evaluate_fall(se3di_equations *equations, double t, double *derivative)
{
    se3di_tree_sum_efforts(equations->tree);
    return fall_again(equations, t, derivative);
}

/* With what acts in `sums`. */
static se3d_status evaluate_sums(se3di_equations *equations, double t, se3di_force_sums *sums,
                                 double *derivative)
{
    se3di_assembly *assembly = &equations->assembly;
    SE3DI_TRY(se3di_assembly_sum_loads(assembly, t, sums, equations->error));
    se3di_tree_take_wrenches(equations->tree, assembly->model->frames, assembly->wrench);
    return finish(equations, t, sums->power, derivative);
}

static se3d_status evaluate_tree(se3di_equations *equations, double t, double *derivative)
{
    se3di_tree *tree = equations->tree;
    ++equations->counters.evaluations;
    equations->assembly.time = t;
    if (falls(equations)) {
        return evaluate_fall(equations, t, derivative);
    }
    if (!is_open(equations)) {
        SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
        se3di_tree_take_given(tree, &equations->assembly);
    }
    se3di_force_sums sums = se3di_tree_sums(tree);
    return evaluate_sums(equations, t, &sums, derivative);
}

static se3d_status evaluate(se3di_equations *equations, double t, double *derivative)
{
    if (!is_loaded(equations)) {
        return evaluate_tree(equations, t, derivative);
    }
    SE3DI_TRY(se3di_state_evaluate(equations, t));
    return derive(equations, t, equations->l, derivative);
}

static se3d_status evaluate_at(se3di_equations *equations, double t, const double *y,
                               double *derivative)
{
    if (!falls(equations)) {
        set(equations, y);
        return evaluate(equations, t, derivative);
    }
    se3di_tree *tree = equations->tree;
    take_state(tree, y);
    se3di_tree_place(tree, tree->q, tree->qdot, NULL);
    equations->is_placed = 0;
    ++equations->counters.evaluations;
    return evaluate_fall(equations, t, derivative);
}

/* ---- projection ---- */

/* Angles and quaternions continue those before: what is interpolated between must not jump. */
static void continue_turns(const se3di_tree *tree, double *q, double *before)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *node = &tree->nodes[k];
        double *p = quaternion_of(node, q), *old = quaternion_of(node, before);
        if (p && p[0] * old[0] + p[1] * old[1] + p[2] * old[2] + p[3] * old[3] < 0.0) {
            for (int c = 0; c < 4; ++c) {
                p[c] = -p[c];
            }
        }
        for (int c = 0; node->type == SE3DI_TREE_UNIVERSAL && c < 2; ++c) {
            q[node->q + (uint32_t)c] +=
                TURN *
                se3di_nearest((before[node->q + (uint32_t)c] - q[node->q + (uint32_t)c]) / TURN);
        }
    }
}

static void follow(se3di_equations *equations)
{
    se3di_tree_get(equations->tree, NULL, equations->tree->qdot);
    place(equations);
}

/* By the equations of the bodies, which are factored. */
static se3d_status project_bodies(se3di_equations *equations, double t,
                                  const se3di_state_scale *scale, double accuracy, int is_factored)
{
    se3di_tree *tree = equations->tree;
    SE3DI_TRY(se3di_state_project(equations, t, scale, accuracy, is_factored));
    double *before = equations->joint_before;
    memcpy(before, tree->q, tree->q_count * sizeof *before);
    se3di_tree_get(tree, tree->q, tree->qdot);
    normalise(tree, tree->q);
    continue_turns(tree, tree->q, before);
    place(equations);
    return SE3D_OK;
}

/* Near singular positions the equations of the bodies are the softer ones: in 40 windows exact rows
 * of loops made 2e-5 J of rounding. */
static se3d_status project(se3di_equations *equations, double t, const se3di_state_scale *scale,
                           double accuracy, int is_factored)
{
    if (is_open(equations)) {
        return SE3D_OK;
    }
    if (is_loaded(equations)) {
        return project_bodies(equations, t, scale, accuracy, is_factored);
    }
    const int is_near =
        equations->has_loops && is_factored && se3di_tree_loops_is_near(&equations->loops);
    const se3d_status status =
        is_near ? SE3D_INFO_REDUNDANT
                : se3di_joint_project(equations, t, scale, accuracy, is_factored);
    return status > 0 ? project_bodies(equations, t, scale, accuracy, 0) : status;
}

static se3d_status measure_gap(se3di_equations *equations, double t, const se3di_state_scale *scale,
                               double *gap)
{
    *gap = 0.0;
    return is_open(equations)     ? SE3D_OK
           : is_loaded(equations) ? se3di_state_measure_gap(equations, t, scale, gap)
                                  : se3di_joint_measure_gap(equations, t, scale, gap);
}

/* ---- what a change is for the bodies ---- */

/* A change of positions as one along the freedoms: turns of quaternions in the child's frame. */
static void make_displacement(const se3di_tree_node *node, const double *q, const double *change,
                              double dq[FREEDOMS_MAX])
{
    const int has_way = node->type == SE3DI_TREE_FREE;
    if (!has_way && node->type != SE3DI_TREE_SPHERICAL) {
        memcpy(dq, change + node->q, (size_t)node->v_count * sizeof *dq);
        return;
    }
    const size_t at = node->q + (has_way ? 3u : 0u);
    if (has_way) {
        se3di_copy(change + node->q, dq);
    }
    se3di_g_mul(q + at, change + at, dq + (has_way ? 3 : 0));
    se3di_scale(2.0, dq + (has_way ? 3 : 0), dq + (has_way ? 3 : 0));
}

/* (turn, way of the point) of a node that moves by dq on a parent that moves by `parent`. */
static void carry(const double *S, int n, const double d[3], const double *dq, const double *parent,
                  double out[6])
{
    double x[3] = {0.0, 0.0, 0.0};
    if (parent) {
        se3di_cross(parent, d, x);
    }
    for (int k = 0; k < 3; ++k) {
        out[k] = parent ? parent[k] : 0.0;
        out[3 + k] = parent ? parent[3 + k] + x[k] : 0.0;
    }
    for (int c = 0; c < n; ++c) {
        for (int k = 0; k < 6; ++k) {
            out[k] += dq[c] * S[6 * c + k];
        }
    }
}

/* Half a turn, or a turn: `turn` times it, to p or w; the way of the centre of mass to r or v. */
static void put(const double motion[6], const double s[3], double turn, double *way, double *angle)
{
    double x[3];
    se3di_cross(motion, s, x);
    se3di_add(motion + 3, x, way);
    se3di_scale(turn, motion, angle);
}

/* The rate of a change is taken in the frames that move with it: the difference is a turn of the
 * velocities, which the turn itself measures as much. */
static const double *spread(se3di_equations *equations, const double *change, double *out)
{
    const se3di_tree *tree = equations->tree;
    const se3di_assembly *assembly = &equations->assembly;
    double(*way)[6] = (double(*)[6])(void *)equations->joint_moves, (*rate)[6] = way + tree->count;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *node = &tree->nodes[k];
        const se3di_tree_link *link = &tree->links[k];
        const double *S = tree->S + 6 * (size_t)node->v;
        const size_t p = node->parent >= 0 ? (size_t)node->parent : 0;
        const int is_rooted = node->parent < 0;
        double *to = out + SE3DI_STATE_SIZE * (size_t)assembly->free_index[node->body];
        double dq[FREEDOMS_MAX];
        make_displacement(node, tree->q, change, dq);
        carry(S, node->v_count, link->d, dq, is_rooted ? NULL : way[p], way[k]);
        carry(S, node->v_count, link->d, change + tree->q_count + node->v,
              is_rooted ? NULL : rate[p], rate[k]);
        put(way[k], link->s, 0.5, to, to + 3);
        to[6] = 0.0;
        put(rate[k], link->s, 1.0, to + 7, to + 10);
    }
    memcpy(out + se3di_state_count(assembly) - SE3DI_STATE_WORK,
           change + tree->q_count + tree->v_count, SE3DI_STATE_WORK * sizeof *out);
    return out;
}

static void measure(const se3di_equations *equations, const double *const change[2], double *room,
                    double parts[2][4], double states[2])
{
    se3di_tree_measure(equations->tree, change, room, parts, states);
}

static void show(se3di_equations *equations, const double *y, double *bodies)
{
    se3di_tree *tree = equations->tree;
    const se3di_assembly *assembly = &equations->assembly;
    take_state(tree, y);
    place_aside(equations);
    for (uint32_t k = 0; k < assembly->body_count; ++k, bodies += SE3DI_STATE_SIZE) {
        se3di_state_pack(&tree->frames[assembly->free_body[k]], bodies);
    }
    memcpy(bodies, y + tree->q_count + tree->v_count, SE3DI_STATE_WORK * sizeof *bodies);
}

/* Also with drivers, and with loops none of whose rows the tree implies: where the rows are clear
 * of each other they have one solution. */
static int may_report(const se3di_equations *equations)
{
    return is_open(equations) ||
           (!is_loaded(equations) && (!equations->has_loops || equations->loops.is_whole));
}

static int report(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    if (equations->has_loops && se3di_tree_loops_is_near(&equations->loops)) {
        return 0;
    }
    se3di_tree_get_accelerations(equations->tree, model->frames, model->acceleration);
    transmit(equations, 0, model->lambda);
    return 1;
}

/* A force element without functions and memory. */
static int is_plain(const se3di_force *force)
{
    const int32_t type = force->type;
    int plain = type == SE3DI_FORCE_EFFORT || type == SE3DI_FORCE_ARMATURE ||
                type == SE3DI_FORCE_TSDA || type == SE3DI_FORCE_RSDA ||
                type == SE3DI_FORCE_BUSHING || type == SE3DI_FORCE_LOAD ||
                type == SE3DI_FORCE_TORQUE;
    for (int k = 0; plain && k < SE3DI_FORCE_FUNCTIONS; ++k) {
        plain = force->function[k] < 0;
    }
    return plain;
}

static int are_all_plain(const se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    int all = is_open(equations) && !equations->tree->has_others && !equations->assembly.push &&
              model->shape_slots.count <= 1 && !se3di_model_gravity_varies(model);
    for (size_t k = 0; all && k < model->force_slots.count; ++k) {
        all = is_plain(&model->forces[k]);
    }
    return all;
}

/* A wheel is measured at the end of every step. */
static int can_wait(const se3di_equations *equations)
{
    return equations->assembly.model->wheel_slots.count == 0 && are_all_plain(equations);
}

static se3d_status evaluate_again(se3di_equations *equations, double t, double *derivative)
{
    if (falls(equations)) {
        return fall_again(equations, t, derivative);
    }
    se3di_force_sums sums = se3di_tree_sums_again(equations->tree);
    return evaluate_sums(equations, t, &sums, derivative);
}

static void keep_efforts(se3di_equations *equations)
{
    const se3di_tree *tree = equations->tree;
    memcpy(tree->effort_before, tree->effort, tree->v_count * sizeof *tree->effort);
}

static void come_back(se3di_equations *equations)
{
    const se3di_tree *tree = equations->tree;
    memcpy(tree->effort, tree->effort_before, tree->v_count * sizeof *tree->effort);
}

static double count_dependent(const se3di_equations *equations)
{
    return is_loaded(equations)   ? se3di_kkt_get_dependent_rows(equations->kkt)
           : equations->has_loops ? se3di_tree_loops_count_dependent(&equations->loops)
                                  : 0.0;
}

const se3di_motion se3di_motion_joints = {
    .count = count,
    .get = get,
    .set = set,
    .set_again = set_again,
    .take = take,
    .set_frames = set_frames,
    .get_rates = get_rates,
    .evaluate = evaluate,
    .evaluate_at = evaluate_at,
    .derive = derive,
    .move = move,
    .spread = spread,
    .measure = measure,
    .project = project,
    .measure_gap = measure_gap,
    .keep = keep,
    .stand = stand,
    .follow = follow,
    .accept_angles = accept_angles,
    .show = show,
    .finds_all = is_open,
    .may_report = may_report,
    .are_all_plain = are_all_plain,
    .can_wait = can_wait,
    .report = report,
    .evaluate_again = evaluate_again,
    .keep_efforts = keep_efforts,
    .come_back = come_back,
    .count_dependent = count_dependent,
};
