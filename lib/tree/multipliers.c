/* SPDX-License-Identifier: BSD-3-Clause */
/* Multipliers of the joints on the tree, from what the joints exert.
 *
 * With F and N the force and the moment about P_j that a joint exerts on body j, axis, ref and
 * third of body i, sigma = axis_i . axis_j, all constraint forces being -Phi_q^T lambda:
 *
 *     cd_x, cd_y, cd_z    lambda = -F
 *     dp2 along a_i       lambda = -a_i . F
 *     dp1_a, dp1_b        lambda = -sigma third . N,   sigma ref . N
 *     dp1_c               lambda = (third_i . third_j) axis . N
 *     dp1 (universal)     lambda = (axis_i x axis_j) . N
 *     screw               lambda = -axis . F
 *     driver              lambda = -(S . (N, F) + armature qddot - effort) / coefficient
 *                                                             docs/theory/joint_coordinates.md */
#include "math/vec3.h"
#include "tree/recursion.h"

/* Directions of a joint, ground frame, and what it exerts on body j. */
typedef struct exertion {
    double ref[3], third[3], axis[3], third_j[3], axis_j[3];
    double sigma;
    double N[3], F[3];
} exertion;

static void measure(const se3di_tree *tree, const se3di_tree_node *n, const double *joint,
                    exertion *x)
{
    const se3di_constraint *c = &tree->model->constraints[n->constraint];
    const se3di_joint_frames *f = &c->frames;
    const se3di_frame *i = &tree->model->frames[c->bodies[0]];
    const se3di_frame *j = &tree->model->frames[c->bodies[1]];
    const int32_t type = n->type;
    *x = (exertion){.sigma = 1.0};
    if (type != SE3DI_TREE_SPHERICAL && type != SE3DI_TREE_UNIVERSAL) {
        se3di_mul(i->A, f->ref_i, x->ref);
        se3di_mul(i->A, f->third_i, x->third);
    }
    if (type != SE3DI_TREE_SPHERICAL) {
        se3di_mul(i->A, f->axis_i, x->axis);
        se3di_mul(j->A, f->axis_j, x->axis_j);
        x->sigma = se3di_dot(x->axis, x->axis_j) < 0.0 ? -1.0 : 1.0;
    }
    if (type == SE3DI_TREE_FIXED || type == SE3DI_TREE_PRISMATIC) {
        se3di_mul(j->A, f->third_j, x->third_j);
    }
    se3di_copy(joint, x->N);
    se3di_copy(joint + 3, x->F);
    if (n->is_reversed) { /* about P_i, on body i: the opposite acts on j */
        double P_j[3], arm[3], moment[3];
        se3di_mul(j->A, f->point_j, P_j);
        se3di_add(P_j, j->r, P_j);
        se3di_sub(tree->links[tree->node_of[n->body]].P, P_j, arm);
        se3di_cross(arm, x->F, moment);
        se3di_add(x->N, moment, x->N);
        se3di_scale(-1.0, x->N, x->N);
        se3di_scale(-1.0, x->F, x->F);
    }
}

static double *write_force(const double F[3], double *l)
{
    se3di_scale(-1.0, F, l);
    return l + 3;
}

static double *write_point(const exertion *x, double *l)
{
    return write_force(x->F, l);
}

/* The rows of a revolute that is not reversed, in the frame of body i, where its directions are
 * constant. */
static void write_revolute(const se3di_tree *tree, const se3di_tree_node *n, const double *joint,
                           double *l)
{
    const se3di_constraint *c = &tree->model->constraints[n->constraint];
    double N[3];
    se3di_mul_transposed(tree->model->frames[c->bodies[0]].A, joint, N);
    l = write_force(joint + 3, l);
    l[0] = -n->sigma * se3di_dot(c->frames.third_i, N);
    l[1] = n->sigma * se3di_dot(c->frames.ref_i, N);
}

static double *write_parallel(const exertion *x, double *l)
{
    l[0] = -x->sigma * se3di_dot(x->third, x->N);
    l[1] = x->sigma * se3di_dot(x->ref, x->N);
    return l + 2;
}

static double *write_line(const exertion *x, double *l)
{
    l[0] = -se3di_dot(x->ref, x->F);
    l[1] = -se3di_dot(x->third, x->F);
    return l + 2;
}

static void write_turn(const exertion *x, double *l)
{
    const double sign = se3di_dot(x->third, x->third_j) < 0.0 ? -1.0 : 1.0;
    l[0] = sign * se3di_dot(x->axis, x->N);
}

static void write_joint(int32_t type, const exertion *x, double *l)
{
    double cross[3];
    switch (type) {
    case SE3DI_TREE_FIXED:
        write_turn(x, write_parallel(x, write_point(x, l)));
        break;
    case SE3DI_TREE_REVOLUTE:
        (void)write_parallel(x, write_point(x, l));
        break;
    case SE3DI_TREE_PRISMATIC:
        write_turn(x, write_line(x, write_parallel(x, l)));
        break;
    case SE3DI_TREE_SCREW:
        l = write_line(x, write_parallel(x, l));
        l[0] = -se3di_dot(x->axis, x->F);
        break;
    case SE3DI_TREE_CYLINDRICAL:
        (void)write_line(x, write_parallel(x, l));
        break;
    case SE3DI_TREE_UNIVERSAL:
        se3di_cross(x->axis, x->axis_j, cross);
        l = write_point(x, l);
        l[0] = se3di_dot(cross, x->N);
        break;
    case SE3DI_TREE_SPHERICAL:
        (void)write_point(x, l);
        break;
    default: /* planar */
        l = write_parallel(x, l);
        l[0] = -se3di_dot(x->axis, x->F);
        break;
    }
}

/* Of the constraint of a joint. */
static void write_multipliers(const se3di_tree *tree, const se3di_tree_node *n, const double *f,
                              double *lambda)
{
    double *l = lambda + tree->model->constraints[n->constraint].row_begin;
    exertion x;
    if (!n->is_reversed && n->type == SE3DI_TREE_REVOLUTE) {
        write_revolute(tree, n, f, l);
    } else if (!n->is_reversed && n->type == SE3DI_TREE_SPHERICAL) {
        (void)write_force(f + 3, l);
    } else {
        measure(tree, n, f, &x);
        write_joint(n->type, &x, l);
    }
}

void se3di_tree_multipliers(const se3di_tree *tree, const double *joint, const double *effort,
                            int driven, double *lambda)
{
    const se3di_model *model = tree->model;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        const double *f = joint + 6 * (size_t)k;
        if (n->constraint >= 0 && !driven) {
            write_multipliers(tree, n, f, lambda);
        }
        if (n->driver >= 0) {
            const uint32_t row = model->constraints[n->driver].row_begin;
            const double *S = tree->S + 6 * (size_t)n->v;
            const double along = se3di_dot(S, f) + se3di_dot(S + 3, f + 3);
            const double rotor = tree->armature[n->v] * tree->given[n->v];
            lambda[row] = -(along + rotor - (effort ? effort[n->v] : 0.0)) /
                          model->terms[model->rows[row].term_begin].coefficient;
        }
    }
}
