/* SPDX-License-Identifier: BSD-3-Clause */
/* Coordinates of the tree: what a node takes from the model, q and qdot from frames and back, and
 * what does not depend on the instruction level.              docs/theory/joint_coordinates.md */
#include "math/elementary.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"
#include "tree/core.h"
#include "tree/packs.h"
#include "tree/recursion.h"

#include <math.h>
#include <string.h>

#define SAME 1e-15 /* of components of unit vectors */
#define TURN 6.283185307179586

/* ---- joint frames ---- */

/* (ref, third, axis) of a joint on body i or j as columns. */
static void triad_of(const se3di_joint_frames *frames, int is_j, double T[9])
{
    const double *ref = is_j ? frames->ref_j : frames->ref_i;
    const double *third = is_j ? frames->third_j : frames->third_i;
    const double *axis = is_j ? frames->axis_j : frames->axis_i;
    for (int k = 0; k < 3; ++k) {
        T[3 * k] = ref[k];
        T[3 * k + 1] = third[k];
        T[3 * k + 2] = axis[k];
    }
}

static void negate_columns(double T[9], double x, double y, double z)
{
    for (int k = 0; k < 3; ++k) {
        T[3 * k] *= x;
        T[3 * k + 1] *= y;
        T[3 * k + 2] *= z;
    }
}

static int has_axis(int32_t type)
{
    return type == SE3DI_TREE_REVOLUTE || type == SE3DI_TREE_SCREW ||
           type == SE3DI_TREE_CYLINDRICAL || type == SE3DI_TREE_PLANAR;
}

/* The signs of the directions of j along those of i: joints hold also after half turns. */
static void signs_of(const se3di_model *model, const se3di_tree_node *n, const double Ti[9],
                     const double Tj[9], double sign[3])
{
    const se3di_constraint *c = &model->constraints[n->constraint];
    double ground_i[9], ground_j[9];
    se3di_mat_mul(model->frames[c->bodies[0]].A, Ti, ground_i);
    se3di_mat_mul(model->frames[c->bodies[1]].A, Tj, ground_j);
    for (int k = 0; k < 3; ++k) {
        const double along = ground_i[k] * ground_j[k] + ground_i[3 + k] * ground_j[3 + k] +
                             ground_i[6 + k] * ground_j[6 + k];
        sign[k] = along < 0.0 ? -1.0 : 1.0;
    }
    if (has_axis(n->type)) {
        sign[0] = 1.0; /* any turn about the axis */
    }
    sign[1] = sign[0] * sign[2];
}

/* The triads on parent and child, in their bodies, that coincide where the joint is at zero, the
 * third direction along the one that coordinates are counted about. */
static void triads_of(const se3di_model *model, const se3di_tree_node *n, double parent[9],
                      double child[9])
{
    static const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    if (n->constraint < 0 || n->type == SE3DI_TREE_SPHERICAL) {
        memcpy(parent, unit, sizeof unit);
        memcpy(child, unit, sizeof unit);
        return;
    }
    const se3di_joint_frames *f = &model->constraints[n->constraint].frames;
    double sign[3];
    triad_of(f, n->is_reversed, parent);
    triad_of(f, !n->is_reversed, child);
    if (n->type == SE3DI_TREE_UNIVERSAL) {
        return;
    }
    if (n->is_reversed) { /* seen from j, i turns the other way: about the opposite axis */
        signs_of(model, n, child, parent, sign);
        negate_columns(child, 1.0, -1.0, -1.0);
        negate_columns(parent, sign[0], -sign[1], -sign[2]);
    } else {
        signs_of(model, n, parent, child, sign);
        negate_columns(child, sign[0], sign[1], sign[2]);
    }
}

/* If the third direction of T is one of the body's, up to rounding, the two others may be, too:
 * T <- T turned about it. Returns the angle of the old first direction. */
static double straighten(double T[9])
{
    int axis = -1;
    for (int k = 0; k < 3; ++k) {
        if (fabs(fabs(T[3 * k + 2]) - 1.0) <= SAME) {
            axis = k;
        }
    }
    if (axis < 0) {
        return 0.0;
    }
    const double sign = T[3 * axis + 2] < 0.0 ? -1.0 : 1.0;
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const double angle = se3di_atan2(sign * T[3 * y], T[3 * x]);
    memset(T, 0, 9 * sizeof *T);
    T[3 * x] = 1.0;
    T[3 * y + 1] = sign;
    T[3 * axis + 2] = sign;
    return angle;
}

/* If `T` and `model_of` have the same third direction, T <- model_of; the angle as above. */
static double align(const double model_of[9], double T[9])
{
    for (int k = 0; k < 3; ++k) {
        if (fabs(T[3 * k + 2] - model_of[3 * k + 2]) > SAME) {
            return 0.0;
        }
    }
    double x[2] = {0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
        x[0] += T[3 * k] * model_of[3 * k];
        x[1] += T[3 * k] * model_of[3 * k + 1];
    }
    memcpy(T, model_of, 9 * sizeof *T);
    return se3di_atan2(x[1], x[0]);
}

/* ---- constants of a node ---- */

static int is_unit(const double T[9])
{
    for (int k = 0; k < 9; ++k) {
        if (fabs(T[k] - (k % 4 == 0 ? 1.0 : 0.0)) > SAME) {
            return 0;
        }
    }
    return 1;
}

/* Triad of a node in its body, from B. */
static void own_triad(const se3di_tree_node *n, double T[9])
{
    const double back[4] = {n->B[0], -n->B[1], -n->B[2], -n->B[3]};
    se3di_quat_to_matrix(back, T);
}

/* C and r: how the joint sits on the parent's triad, or on the ground. */
static void place_on_parent(const se3di_tree *tree, se3di_tree_node *n, const double T[9],
                            const double point[3])
{
    double base[9], relative[9], arm[3];
    n->flags &= ~SE3DI_TREE_ALIGNED_PARENT;
    if (n->parent < 0) {
        const se3di_frame *frame = &tree->model->frames[n->parent_body];
        se3di_mat_mul(frame->A, T, relative);
        se3di_mul(frame->A, point, n->r);
        se3di_add(n->r, frame->r, n->r);
    } else {
        const se3di_tree_node *parent = &tree->nodes[n->parent];
        double turned[9];
        own_triad(parent, base);
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                turned[3 * r + c] = base[3 * c + r];
            }
        }
        se3di_mat_mul(turned, T, relative);
        se3di_mul(turned, point, arm);
        se3di_add(arm, parent->s, n->r); /* from the joint point over the centre of mass */
        n->flags |= is_unit(relative) ? SE3DI_TREE_ALIGNED_PARENT : 0;
    }
    se3di_quat_from_matrix(relative, n->C);
    se3di_quat_to_matrix(n->C, n->T);
}

/* Moments of inertia about the joint point, in the triad T; s is set. */
static void turn_inertia(const se3di_tree_node *n, const double T[9], double m, const double own[6],
                         double moments[6])
{
    double J[9], JT[9], turned[9], X[9];
    const double *s = n->s;
    se3di_inertia_matrix(own, J);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            turned[3 * r + c] = T[3 * c + r];
        }
    }
    se3di_mat_mul(J, T, JT);
    se3di_mat_mul(turned, JT, X);
    const double square = se3di_dot(s, s);
    for (int k = 0; k < 3; ++k) {
        moments[k] = X[4 * k] + m * (square - s[k] * s[k]);
    }
    moments[3] = X[1] - m * s[0] * s[1];
    moments[4] = X[2] - m * s[0] * s[2];
    moments[5] = X[5] - m * s[1] * s[2];
}

void se3di_tree_inertia_of(const se3di_tree_node *node, double mass, const double own[6],
                           double moments[6])
{
    double T[9];
    own_triad(node, T);
    turn_inertia(node, T, mass, own, moments);
}

void se3di_tree_to_triad(const se3di_tree_node *node, const double local[3], double x[3])
{
    double T[9];
    own_triad(node, T);
    se3di_mul_transposed(T, local, x);
}

static void take_inertia(const se3di_body *body, se3di_tree_node *n, const double T[9])
{
    n->mass = body->mass;
    turn_inertia(n, T, body->mass, body->J, n->J);
    n->flags &= ~SE3DI_TREE_DIAGONAL;
    n->flags |= n->J[3] == 0.0 && n->J[4] == 0.0 && n->J[5] == 0.0 ? SE3DI_TREE_DIAGONAL : 0;
}

static void take_screw(const se3di_model *model, se3di_tree_node *n)
{
    if (n->type != SE3DI_TREE_SCREW) {
        return;
    }
    const se3di_constraint *c = &model->constraints[n->constraint];
    const se3di_row *row = &model->rows[c->row_begin + c->row_count - 1];
    const se3di_term *terms = &model->terms[row->term_begin]; /* displacement, angle */
    n->lead = -terms[1].coefficient / terms[0].coefficient;
    n->base = row->value / terms[0].coefficient;
}

/* Which of the two ways a revolute is put together; no motion changes it. */
static void take_side(const se3di_model *model, se3di_tree_node *n)
{
    n->sigma = 1.0;
    if (n->type == SE3DI_TREE_REVOLUTE) {
        const se3di_constraint *c = &model->constraints[n->constraint];
        double i[3], j[3];
        se3di_mul(model->frames[c->bodies[0]].A, c->frames.axis_i, i);
        se3di_mul(model->frames[c->bodies[1]].A, c->frames.axis_j, j);
        n->sigma = se3di_dot(i, j) < 0.0 ? -1.0 : 1.0;
    }
}

static void refresh_node(se3di_tree *tree, se3di_tree_node *n)
{
    const se3di_model *model = tree->model;
    double on_parent[9], on_child[9];
    double at_parent[3] = {0.0, 0.0, 0.0}, at_child[3] = {0.0, 0.0, 0.0};
    triads_of(model, n, on_parent, on_child);
    n->zero = n->angle >= 0 ? model->angles[n->angle].offset : 0.0;
    if (n->constraint >= 0) {
        const se3di_joint_frames *f = &model->constraints[n->constraint].frames;
        se3di_copy(n->is_reversed ? f->point_j : f->point_i, at_parent);
        se3di_copy(n->is_reversed ? f->point_i : f->point_j, at_child);
    }
    if (has_axis(n->type)) {
        n->zero += straighten(on_child);
    }
    if (has_axis(n->type) && n->type != SE3DI_TREE_PLANAR && n->parent >= 0) {
        double base[9];
        own_triad(&tree->nodes[n->parent], base);
        n->zero -= align(base, on_parent);
    }
    double triad[4];
    se3di_quat_from_matrix(on_child, triad);
    n->B[0] = triad[0];
    for (int k = 1; k < 4; ++k) {
        n->B[k] = -triad[k];
    }
    n->flags &= ~SE3DI_TREE_ALIGNED_BODY;
    if (is_unit(on_child)) {
        n->flags |= SE3DI_TREE_ALIGNED_BODY;
    }
    se3di_mul_transposed(on_child, at_child, n->s);
    se3di_scale(-1.0, n->s, n->s);
    take_inertia(&model->bodies[n->body], n, on_child);
    place_on_parent(tree, n, on_parent, at_parent);
    take_screw(model, n);
    take_side(model, n);
}

/* Whether the frame that was placed has -p where the model's has p. */
static int is_opposite(const se3di_tree *tree, const se3di_tree_node *n)
{
    const double *p = tree->model->frames[n->body].p, *own = tree->frames[n->body].p;
    return p[0] * own[0] + p[1] * own[1] + p[2] * own[2] + p[3] * own[3] < 0.0;
}

void se3di_tree_match_turns(se3di_tree *tree, double *q)
{
    double *carried = tree->scratch; /* 1: a joint on the way to the node has been turned */
    int has_turned = 0;
    se3di_tree_place(tree, q, tree->qdot, tree->frames);
    for (uint32_t k = 0; tree->keeps_turns && k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        carried[k] = n->parent >= 0 ? carried[n->parent] : 0.0;
        if (n->type == SE3DI_TREE_UNIVERSAL && is_opposite(tree, n) != (carried[k] > 0.0)) {
            q[n->q] += q[n->q] > 0.0 ? -TURN : TURN;
            carried[k] = 1.0 - carried[k];
            has_turned = 1;
        }
    }
    if (has_turned) {
        se3di_tree_place(tree, q, tree->qdot, tree->frames);
    }
}

/* p and -p are the same pose: the body keeps the one that it has. */
void se3di_tree_match_signs(se3di_tree *tree)
{
    se3di_tree_match_turns(tree, tree->q);
    for (uint32_t k = 0; k < tree->count; ++k) {
        se3di_tree_node *n = &tree->nodes[k];
        const double sign = is_opposite(tree, n) ? -1.0 : 1.0;
        for (int c = 0; c < 4; ++c) {
            n->B[c] *= sign;
        }
    }
    se3di_tree_fill_packs(tree);
}

int32_t se3di_tree_component(const se3di_tree_node *node, int32_t coordinate)
{
    const int is_angle = coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    switch (node->type) {
    case SE3DI_TREE_REVOLUTE:
        return is_angle ? 0 : -1;
    case SE3DI_TREE_SCREW:
        return is_angle ? 0 : -1;
    case SE3DI_TREE_PRISMATIC:
        return is_angle ? -1 : 0;
    case SE3DI_TREE_CYLINDRICAL:
        return is_angle ? 0 : 1;
    case SE3DI_TREE_PLANAR:
        return is_angle ? 2 : -1;
    default:
        return -1;
    }
}

static int moves(const se3di_tree *tree, const se3di_force *force)
{
    return tree->node_of[force->body_i] >= 0 || tree->node_of[force->body_j] >= 0;
}

static void take_armatures(se3di_tree *tree)
{
    const se3di_model *model = tree->model;
    memset(tree->armature, 0, tree->v_count * sizeof *tree->armature);
    tree->foreign_armature = -1;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        if (force->type != SE3DI_FORCE_ARMATURE) {
            continue;
        }
        const int32_t place = tree->tree_of[force->joint];
        const se3di_tree_node *n = place >= 0 ? &tree->nodes[place] : NULL;
        const int32_t component = n ? se3di_tree_component(n, force->coordinate) : -1;
        if (component >= 0) {
            tree->armature[n->v + (uint32_t)component] += force->value[0];
        } else if (moves(tree, force)) {
            tree->foreign_armature = (int32_t)k;
        }
    }
}

void se3di_tree_refresh(se3di_tree *tree)
{
    take_armatures(tree);
    for (uint32_t k = 0; k < tree->count; ++k) {
        refresh_node(tree, &tree->nodes[k]);
    }
    se3di_tree_find_packs(tree);
    se3di_tree_get(tree, tree->q, tree->qdot);
    se3di_tree_match_signs(tree);
}

/* ---- frames -> coordinates ---- */

/* Relative motion at a joint, in the ground frame. */
typedef struct relative_motion {
    double parent[9], child[9]; /* triads of the joint */
    double d[3];                /* point on the parent -> point on the child */
    double w[3], v[3];          /* of the child's point, seen from the parent */
} relative_motion;

static void point_motion(const se3di_frame *frame, const double s[3], double P[3], double v[3])
{
    double arm[3], turning[3];
    se3di_mul(frame->A, s, arm);
    se3di_add(frame->r, arm, P);
    se3di_cross(frame->w, s, turning);
    se3di_mul(frame->A, turning, v);
    se3di_add(v, frame->v, v);
}

static void measure(const se3di_tree *tree, const se3di_tree_node *n, relative_motion *m)
{
    const se3di_model *model = tree->model;
    const se3di_frame *p = &model->frames[n->parent_body], *c = &model->frames[n->body];
    const se3di_joint_frames *f = &model->constraints[n->constraint].frames;
    double T_parent[9], T_child[9], P[3], Q[3], v_p[3], v_c[3], w_p[3], w_c[3], x[3];
    triads_of(model, n, T_parent, T_child);
    se3di_mat_mul(p->A, T_parent, m->parent);
    se3di_mat_mul(c->A, T_child, m->child);
    point_motion(p, n->is_reversed ? f->point_j : f->point_i, P, v_p);
    point_motion(c, n->is_reversed ? f->point_i : f->point_j, Q, v_c);
    se3di_sub(Q, P, m->d);
    se3di_mul(p->A, p->w, w_p);
    se3di_mul(c->A, c->w, w_c);
    se3di_sub(w_c, w_p, m->w);
    se3di_cross(w_p, m->d, x);
    se3di_sub(v_c, v_p, m->v);
    se3di_sub(m->v, x, m->v);
}

static double along(const double T[9], int column, const double x[3])
{
    return T[column] * x[0] + T[3 + column] * x[1] + T[6 + column] * x[2];
}

static void get_free(const se3di_frame *frame, double *q, double *qdot)
{
    memcpy(q, frame->r, sizeof frame->r);
    memcpy(q + 3, frame->p, sizeof frame->p);
    memcpy(qdot, frame->v, sizeof frame->v);
    memcpy(qdot + 3, frame->w, sizeof frame->w);
}

static void get_carrier(const se3di_frame *frame, double *q, double *qdot)
{
    q[0] = frame->r[0];
    qdot[0] = frame->v[0];
}

static void get_spherical(const se3di_tree *tree, const se3di_tree_node *n,
                          const relative_motion *m, double *q, double *qdot)
{
    const double *p = tree->model->frames[n->parent_body].p;
    const double back[4] = {p[0], -p[1], -p[2], -p[3]};
    se3di_quat_mul(back, tree->model->frames[n->body].p, q);
    se3di_quat_normalize(q, q);
    for (int k = 0; k < 3; ++k) {
        qdot[k] = along(m->child, k, m->w);
    }
}

static void get_universal(const relative_motion *m, double *q, double *qdot)
{
    double axis[3], parent_axis[3];
    for (int k = 0; k < 3; ++k) {
        axis[k] = m->child[3 * k + 2];
        parent_axis[k] = m->parent[3 * k + 2];
    }
    q[0] = se3di_atan2(along(m->parent, 1, axis), along(m->parent, 0, axis));
    q[1] = se3di_atan2(along(m->child, 0, parent_axis), along(m->child, 1, parent_axis));
    qdot[0] = se3di_dot(parent_axis, m->w);
    qdot[1] = se3di_dot(axis, m->w);
}

static void get_node(const se3di_tree *tree, const se3di_tree_node *n, double *q, double *qdot)
{
    const se3di_model *model = tree->model;
    relative_motion m;
    if (n->type == SE3DI_TREE_FREE) {
        get_free(&model->frames[n->body], q, qdot);
        return;
    }
    if (n->type == SE3DI_TREE_CARRIER) {
        get_carrier(&model->frames[n->body], q, qdot);
        return;
    }
    measure(tree, n, &m);
    const double angle = n->angle >= 0 ? se3di_angle_value(model, (uint32_t)n->angle) : 0.0;
    switch (n->type) {
    case SE3DI_TREE_REVOLUTE:
    case SE3DI_TREE_SCREW:
        q[0] = angle;
        qdot[0] = along(m.parent, 2, m.w);
        break;
    case SE3DI_TREE_PRISMATIC:
        q[0] = along(m.parent, 2, m.d);
        qdot[0] = along(m.parent, 2, m.v);
        break;
    case SE3DI_TREE_CYLINDRICAL:
        q[0] = angle;
        q[1] = along(m.parent, 2, m.d);
        qdot[0] = along(m.parent, 2, m.w);
        qdot[1] = along(m.parent, 2, m.v);
        break;
    case SE3DI_TREE_UNIVERSAL:
        get_universal(&m, q, qdot);
        break;
    case SE3DI_TREE_SPHERICAL:
        get_spherical(tree, n, &m, q, qdot);
        break;
    case SE3DI_TREE_PLANAR:
        for (int k = 0; k < 2; ++k) {
            q[k] = along(m.parent, k, m.d);
            qdot[k] = along(m.parent, k, m.v);
        }
        q[2] = angle;
        qdot[2] = along(m.parent, 2, m.w);
        break;
    default:
        break;
    }
}

void se3di_tree_get(se3di_tree *tree, double *q, double *qdot)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        double position[7], velocity[6];
        get_node(tree, n, position, velocity);
        if (q) {
            memcpy(q + n->q, position, (size_t)n->q_count * sizeof *q);
        }
        if (qdot) {
            memcpy(qdot + n->v, velocity, (size_t)n->v_count * sizeof *qdot);
        }
    }
}

/* ---- rates and displacements ---- */

void se3di_tree_rates(const se3di_tree *tree, const double *q, const double *qdot, double *rates)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        const double *from = qdot + n->v;
        double *to = rates + n->q;
        if (n->type == SE3DI_TREE_SPHERICAL) {
            se3di_quat_rate(q + n->q, from, to);
        } else if (n->type == SE3DI_TREE_FREE) {
            se3di_copy(from, to);
            se3di_quat_rate(q + n->q + 3, from + 3, to + 3);
        } else if (n->v_count == 1) { /* most are */
            to[0] = from[0];
        } else {
            memcpy(to, from, (size_t)n->v_count * sizeof *to);
        }
    }
}

static void turn(const double *q, const double *dq, double *out)
{
    se3di_quat_rotate(q, dq, out);
    se3di_quat_normalize(out, out);
}

void se3di_tree_move(const se3di_tree *tree, const double *q, const double *dq, double *out)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        const double *from = q + n->q, *by = dq + n->v;
        double *to = out + n->q;
        if (n->type == SE3DI_TREE_SPHERICAL) {
            turn(from, by, to);
        } else if (n->type == SE3DI_TREE_FREE) {
            se3di_add(from, by, to);
            turn(from + 3, by + 3, to + 3);
        } else {
            for (int32_t c = 0; c < n->v_count; ++c) {
                to[c] = from[c] + by[c];
            }
        }
    }
}

/* ---- what the recursions are called by ---- */

void se3di_tree_place(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames)
{
    tree->core->place(tree, q, qdot, frames);
}

void se3di_tree_show(se3di_tree *tree, const double *q, const double *qdot, se3di_frame *frames)
{
    tree->core->show(tree, q, qdot, frames);
}

se3di_force_sums se3di_tree_sums(se3di_tree *tree)
{
    if (!tree->has_efforts) {
        return (se3di_force_sums){.along = NULL};
    }
    memset(tree->effort, 0, tree->v_count * sizeof *tree->effort);
    return (se3di_force_sums){.along = tree->along, .effort = tree->effort};
}

se3di_force_sums se3di_tree_sums_again(se3di_tree *tree)
{
    return (se3di_force_sums){
        .along = tree->has_efforts ? tree->along : NULL, .effort = tree->effort, .has_efforts = 1};
}

double se3di_tree_sum_turns(const se3di_tree *tree, const double *rates)
{
    static const int8_t turning[SE3DI_TREE_JOINT_COUNT][2] = {
        /* the first one, and behind the last */
        [SE3DI_TREE_FREE] = {3, 6},      [SE3DI_TREE_REVOLUTE] = {0, 1},
        [SE3DI_TREE_SCREW] = {0, 1},     [SE3DI_TREE_CYLINDRICAL] = {0, 1},
        [SE3DI_TREE_UNIVERSAL] = {0, 2}, [SE3DI_TREE_SPHERICAL] = {0, 3},
        [SE3DI_TREE_PLANAR] = {2, 3}};
    double sum = 0.0;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        for (int c = turning[n->type][0]; c < turning[n->type][1]; ++c) {
            sum += fabs(rates[n->v + (uint32_t)c]);
        }
    }
    return sum;
}

int se3di_tree_falls(const se3di_tree *tree)
{
    const se3di_model *model = tree->model;
    int falls = !tree->has_states && model->shape_slots.count <= 1 &&
                model->wheel_slots.count == 0 && !se3di_model_gravity_varies(model);
    for (uint32_t k = 0; falls && k < tree->force_count; ++k) {
        const se3di_force *force = &model->forces[k];
        falls = force->type == SE3DI_FORCE_ARMATURE ||
                (tree->along[k] >= 0 && se3di_force_is_number(force));
    }
    return falls;
}

void se3di_tree_sum_efforts(se3di_tree *tree)
{
    if (!tree->has_efforts) {
        return;
    }
    memset(tree->effort, 0, tree->v_count * sizeof *tree->effort);
    for (uint32_t k = 0; k < tree->force_count; ++k) {
        if (tree->along[k] >= 0) {
            tree->effort[tree->along[k]] += tree->model->forces[k].value[0];
        }
    }
}

void se3di_tree_pull(se3di_tree *tree, const double g[3])
{
    tree->acts = 0;
    se3di_copy(g, tree->pull);
}

void se3di_tree_take_wrenches(se3di_tree *tree, const se3di_frame *frames, const double *wrench)
{
    static const double none[3] = {0.0, 0.0, 0.0};
    se3di_tree_pull(tree, none);
    tree->acts = 1;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const uint32_t body = tree->nodes[k].body;
        const double *from = wrench + 6 * (size_t)body;
        double *to = tree->wrench + 6 * (size_t)k;
        double torque[3];
        se3di_mul(frames[body].A, from + 3, torque);
        se3di_cross(tree->links[k].s, from, to);
        se3di_add(to, torque, to);
        se3di_copy(from, to + 3);
    }
}

se3d_status se3di_tree_factor(se3di_tree *tree, const double *effort)
{
    return tree->core->factor(tree, effort) ? SE3D_OK : SE3D_ERR_SINGULAR;
}

void se3di_tree_measure(const se3di_tree *tree, const double *const change[2], double *room,
                        double parts[2][4], double states[2])
{
    tree->core->measure(tree, change, room, parts, states);
}

void se3di_tree_accelerate(se3di_tree *tree, const double *e, double *qddot)
{
    tree->core->accelerate(tree, e, qddot);
}

void se3di_tree_propagate(se3di_tree *tree, const double *qddot)
{
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *n = &tree->nodes[i];
        se3di_tree_link *link = &tree->links[i];
        double *a = link->a;
        memcpy(a, link->c, sizeof link->c);
        if (n->parent < 0) {
            se3di_sub(a + 3, tree->pull, a + 3);
        } else {
            const double *from = tree->links[n->parent].a;
            double x[3];
            se3di_cross(from, link->d, x);
            for (int k = 0; k < 3; ++k) {
                a[k] += from[k];
                a[3 + k] += from[3 + k] + x[k];
            }
        }
        for (int32_t j = 0; j < n->v_count; ++j) {
            const size_t v = n->v + (size_t)j;
            for (size_t k = 0; k < 6; ++k) {
                a[k] += tree->S[6 * v + k] * qddot[v];
            }
        }
    }
}

void se3di_tree_link_acceleration(const se3di_tree *tree, uint32_t node, const se3di_frame *frame,
                                  double out[6])
{
    const se3di_tree_link *link = &tree->links[node];
    double turning[3], x[3];
    se3di_cross(link->a, link->s, x);
    se3di_add(link->a + 3, x, out);
    se3di_add(out, tree->pull, out);
    se3di_cross(link->w, link->s, turning);
    se3di_cross(link->w, turning, x);
    se3di_add(out, x, out);
    se3di_mul_transposed(frame->A, link->a, out + 3);
}

void se3di_tree_get_accelerations(const se3di_tree *tree, const se3di_frame *frames,
                                  double *acceleration)
{
    memset(acceleration, 0, 6 * (size_t)tree->body_count * sizeof *acceleration);
    for (uint32_t i = 0; i < tree->count; ++i) {
        const uint32_t body = tree->nodes[i].body;
        se3di_tree_link_acceleration(tree, i, &frames[body], acceleration + 6 * (size_t)body);
    }
}
