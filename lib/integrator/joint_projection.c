/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints of the tree hold by themselves. Prescribed coordinates take their values; then
 *
 *     q:     min |dq|_M     with  Phi(q + dq) = 0           (Newton)
 *     qdot:  min |dqdot|_M  with  Phi_q (qdot + dqdot) = nu
 *
 * over the other coordinates and the rows of loops that the tree does not imply, by the factors of
 * the accelerations: dq = M^-1 G^T (G M^-1 G^T)^-1 (-Phi).  docs/theory/joint_coordinates.md */
#include "integrator/joint_projection.h"

#include "assembly/user.h"
#include "math/larger.h"
#include "math/vec3.h"
#include "primitive/scale.h"
#include "primitive/turn_counter.h"

#include <math.h>

#define NEWTON_MAX 6
#define RATES_MAX  3
#define FASTER     1e-2 /* Newton by factors from near falls by more, */
#define SLOWER     0.5
#define ROUNDING   1e-15 /* unless what is left is rounding: of the mechanism's reach, or a turn */

static void place(se3di_equations *equations)
{
    se3di_tree *tree = equations->tree;
    se3di_tree_place(tree, tree->q, tree->qdot, equations->assembly.model->frames);
    equations->is_placed = 1;
}

static se3d_status factor(se3di_equations *equations, double t)
{
    se3di_tree *tree = equations->tree;
    ++equations->counters.factorizations;
    se3d_status status = se3di_tree_factor(tree, NULL);
    status = status < 0 ? status : se3di_tree_loops_factor(&equations->loops);
    if (status < 0) {
        return status == SE3D_ERR_CALLBACK
                   ? status
                   : se3di_error_set(equations->error, status,
                                     "t = %g s: the equations are singular or not finite", t);
    }
    return se3di_tree_loops_is_near(&equations->loops) ? SE3D_INFO_REDUNDANT : SE3D_OK;
}

/* c -> tree->qddot, which is free here: the change of q or qdot. */
static se3d_status correct(se3di_equations *equations, double t)
{
    ++equations->counters.solves;
    const se3d_status status =
        se3di_tree_loops_correct(&equations->loops, equations->c, equations->tree->qddot);
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: the linear equations could not be solved", t)
                      : SE3D_OK;
}

/* How far a prescribed coordinate is off, and the rate that it is to have: its equation is linear
 * in it. @return the factor of the equation */
static double eval_prescribed(const se3di_equations *equations, const se3di_tree_node *n,
                              double *off, double *rate)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_model *model = assembly->model;
    const size_t row = model->constraints[n->driver].row_begin;
    const double coefficient = model->terms[model->rows[row].term_begin].coefficient;
    const double *f = assembly->f + 3 * row;
    *rate = f[1] / coefficient;
    *off = se3di_row_violation(model, &model->rows[row], f[0]) / coefficient;
    return coefficient;
}

/* What the frames make of a coordinate that is right. */
static int is_rounding(double off, double q)
{
    return fabs(off) <= ROUNDING * fmax(1.0, fabs(q));
}

/* A prescribed coordinate is what its driver says. */
static void take_prescribed(se3di_equations *equations)
{
    se3di_tree *tree = equations->tree;
    int has_moved = 0;
    for (uint32_t k = 0; tree->given_count > 0 && k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        double off, rate;
        if (!(n->flags & SE3DI_TREE_GIVEN)) {
            continue;
        }
        (void)eval_prescribed(equations, n, &off, &rate);
        if (!is_rounding(off, tree->q[n->q])) {
            tree->q[n->q] -= off;
            has_moved = 1;
        }
        has_moved |= rate != tree->qdot[n->v];
        tree->qdot[n->v] = rate;
    }
    if (has_moved) {
        place(equations);
    }
}

/* How far a displacement goes, or turns, in units of the mechanism. */
static double largest_shift(const se3di_tree *tree, double length)
{
    double largest = 0.0;
    for (uint32_t v = 0; v < tree->v_count; ++v) {
        const double *S = tree->S + 6 * (size_t)v;
        const double way = sqrt(se3di_dot(S + 3, S + 3)) / length, turn = sqrt(se3di_dot(S, S));
        const double size = fabs(tree->qddot[v]) * fmax(way, turn);
        largest = size <= largest ? largest : size; /* NaN stays */
    }
    return largest;
}

/* The rounding of positions, relative to the scale. */
static double rounding_of(const se3di_equations *equations, double length)
{
    const se3di_tree *tree = equations->tree;
    double reach = length;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const double *r = equations->assembly.model->frames[tree->nodes[k].body].r;
        reach = fmax(reach, fmax(fabs(r[0]), fmax(fabs(r[1]), fabs(r[2]))));
    }
    return ROUNDING * reach / length;
}

static se3d_status move(se3di_equations *equations, double t, double length, double *moved)
{
    se3di_tree *tree = equations->tree;
    SE3DI_TRY(correct(equations, t));
    *moved = fmax(*moved, largest_shift(tree, length));
    if (!(*moved < 0.5)) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: the step leaves the constraints, it is too large", t);
    }
    se3di_tree_move(tree, tree->q, tree->qddot, tree->q);
    place(equations);
    return SE3D_OK;
}

static se3d_status project_positions(se3di_equations *equations, double t, double length,
                                     double accuracy, int *is_factored)
{
    const double rounding = rounding_of(equations, length);
    double moved = 0.0, gap = se3di_tree_loops_eval_gap(&equations->loops, length, equations->c);
    for (int k = 0; k < NEWTON_MAX && gap > accuracy; ++k) {
        const double before = gap;
        const se3d_status status = *is_factored ? SE3D_OK : factor(equations, t);
        if (status != SE3D_OK) {
            return status;
        }
        SE3DI_TRY(move(equations, t, length, &moved));
        gap = se3di_tree_loops_eval_gap(&equations->loops, length, equations->c);
        *is_factored = gap < FASTER * before || gap <= rounding; /* else with new rows */
        if (!(gap < SLOWER * before)) {
            break;
        }
    }
    if (!(gap <= fmax(1e-8, accuracy))) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: the positions did not converge: the constraints are off "
                               "by %.3g; the step is too large or the mechanism is locked",
                               t, gap);
    }
    return SE3D_OK;
}

static se3d_status project_rates(se3di_equations *equations, double t,
                                 const se3di_state_scale *scale, double accuracy, int is_factored)
{
    se3di_tree *tree = equations->tree;
    se3di_tree_loops *loops = &equations->loops;
    const double rate = fmax(scale->speed / scale->length, scale->spin);
    double before = HUGE_VAL;
    se3di_tree_loops_eval_rows(loops);
    for (int k = 0; k < RATES_MAX; ++k) {
        const double gap = se3di_tree_loops_eval_rate_gap(loops, scale->length, rate, equations->c);
        if (!(gap > accuracy) || !(gap < 0.5 * before)) {
            break;
        }
        before = gap;
        const se3d_status status = is_factored ? SE3D_OK : factor(equations, t);
        if (status != SE3D_OK) {
            return status;
        }
        is_factored = 1;
        SE3DI_TRY(correct(equations, t));
        for (uint32_t v = 0; v < tree->v_count; ++v) {
            tree->qdot[v] += tree->qddot[v];
        }
        place(equations);
        if (se3di_state_has_rates(equations)) {
            se3di_tree_loops_eval_rows(loops); /* those of such drivers depend on velocities */
            is_factored = 0;
        }
    }
    return se3di_state_check_rates(equations, t, scale);
}

se3d_status se3di_joint_project(se3di_equations *equations, double t,
                                const se3di_state_scale *scale, double accuracy, int is_factored)
{
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    take_prescribed(equations);
    if (!equations->has_loops) {
        return SE3D_OK;
    }
    const se3d_status status =
        project_positions(equations, t, scale->length, accuracy, &is_factored);
    return status != SE3D_OK ? status : project_rates(equations, t, scale, accuracy, is_factored);
}

/* The largest of prescribed coordinates and their rates. */
static double measure_prescribed(const se3di_equations *equations, double length, double rate)
{
    const se3di_tree *tree = equations->tree;
    const se3di_model *model = equations->assembly.model;
    double worst = 0.0;
    for (uint32_t k = 0; tree->given_count > 0 && k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        double off, wanted;
        if (n->flags & SE3DI_TREE_GIVEN) {
            const double factor = eval_prescribed(equations, n, &off, &wanted);
            const double faster = fabs(wanted - tree->qdot[n->v]) / rate;
            const uint32_t row = model->constraints[n->driver].row_begin;
            const double unit = fabs(factor) / se3di_row_get_scale(model, row, length);
            worst = se3di_larger(worst, unit * se3di_larger(fabs(off), faster));
        }
    }
    return worst;
}

se3d_status se3di_joint_measure_gap(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale, double *gap)
{
    const double rate = fmax(scale->speed / scale->length, scale->spin);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    *gap = measure_prescribed(equations, scale->length, rate);
    if (!equations->has_loops) {
        return SE3D_OK;
    }
    se3di_tree_loops *loops = &equations->loops;
    *gap = se3di_larger(*gap, se3di_tree_loops_eval_gap(loops, scale->length, equations->c));
    se3di_tree_loops_eval_rows(loops);
    const double rates = se3di_tree_loops_eval_rate_gap(loops, scale->length, rate, equations->c);
    *gap = se3di_larger(*gap, rates);
    return se3di_user_report(equations->assembly.model, equations->error);
}
