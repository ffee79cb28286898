/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/recursion.h"

#include "math/vec3.h"
#include "tree/core.h"

#include <string.h>

void se3di_tree_bias(const se3di_tree *tree, uint32_t node, double bias[6])
{
    const se3di_tree_node *n = &tree->nodes[node];
    memcpy(bias, tree->links[node].c, 6 * sizeof *bias);
    for (size_t k = 0; n->flags & SE3DI_TREE_GIVEN && k < 6; ++k) {
        bias[k] += tree->S[6 * (size_t)n->v + k] * tree->given[n->v];
    }
}

static int is_given(const se3di_tree_node *n)
{
    return (n->flags & SE3DI_TREE_GIVEN) != 0;
}

static double dot6(const double *a, const double *b)
{
    return se3di_dot(a, b) + se3di_dot(a + 3, b + 3);
}

/* Motion of P from the parent's; wrench about the parent's point from one about P. */
static void carry_motion(const double *parent, const double d[3], double *out)
{
    double x[3];
    se3di_cross(parent, d, x);
    se3di_copy(parent, out);
    se3di_add(parent + 3, x, out + 3);
}

static void add_shifted(const double *wrench, const double d[3], double *to)
{
    double x[3];
    se3di_cross(d, wrench + 3, x);
    for (int k = 0; k < 3; ++k) {
        to[k] += wrench[k] + x[k];
        to[3 + k] += wrench[3 + k];
    }
}

static void base_motion(const se3di_tree *tree, uint32_t i, const double *motion, double *out)
{
    const int32_t parent = tree->nodes[i].parent;
    memset(out, 0, 6 * sizeof *out);
    if (parent >= 0) {
        carry_motion(motion + 6 * (size_t)parent, tree->links[i].d, out);
    }
}

/* Forces from the leaves to the root. */
static void add_up(const se3di_tree *tree, double *force)
{
    for (uint32_t i = tree->count; i-- > 0;) {
        const int32_t parent = tree->nodes[i].parent;
        if (parent >= 0) {
            add_shifted(force + 6 * (size_t)i, tree->links[i].d, force + 6 * (size_t)parent);
        }
    }
}

/* ---- with articulated inertias ---- */

/* y from efforts with articulated inertias, D y = effort - S.p. */
static void gather(se3di_tree *tree, const double *effort, double *y)
{
    double *p = tree->scratch;
    memset(p, 0, 6 * (size_t)tree->count * sizeof *p);
    for (uint32_t i = tree->count; i-- > 0;) {
        const se3di_tree_node *n = &tree->nodes[i];
        double *own = p + 6 * (size_t)i;
        for (int32_t j = n->v_count - 1; j >= 0; --j) {
            const size_t v = n->v + (size_t)j;
            if (is_given(n)) {
                y[v] = 0.0;
                continue;
            }
            y[v] = (effort[v] - dot6(tree->S + 6 * v, own)) / tree->D[v];
            for (size_t k = 0; k < 6; ++k) {
                own[k] += tree->U[6 * v + k] * y[v];
            }
        }
        if (n->parent >= 0) {
            add_shifted(own, tree->links[i].d, p + 6 * (size_t)n->parent);
        }
    }
}

void se3di_tree_spread(const se3di_tree *tree, const double *y, double *x)
{
    double *motion = tree->scratch;
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *n = &tree->nodes[i];
        double *a = motion + 6 * (size_t)i;
        base_motion(tree, i, motion, a);
        for (int32_t j = 0; j < n->v_count; ++j) {
            const size_t v = n->v + (size_t)j;
            const double added = y[v]; /* x may be y */
            x[v] = is_given(n) ? 0.0 : added - dot6(tree->U + 6 * v, a) / tree->D[v];
            for (size_t k = 0; k < 6; ++k) {
                a[k] += tree->S[6 * v + k] * x[v];
            }
        }
    }
}

void se3di_tree_solve(se3di_tree *tree, const double *effort, double *x)
{
    gather(tree, effort, x);
    se3di_tree_spread(tree, x, x);
}

/* ---- with the bodies' own inertias ---- */

/* Mass, its first moments and moments of inertia about P: xx yy zz xy xz yz, ground axes. */
typedef struct composite {
    double mass, h[3], I[6];
} composite;

static void own_composite(const se3di_tree *tree, uint32_t i, composite *o)
{
    const se3di_tree_node *n = &tree->nodes[i];
    const se3di_tree_link *link = &tree->links[i];
    const double *J = n->J;
    const double full[9] = {J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2]};
    double WJ[9];
    se3di_mat_mul(link->W, full, WJ);
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; ++k) {
        o->I[k] = se3di_dot(WJ + 3 * row[k], link->W + 3 * column[k]);
    }
    o->mass = n->mass;
    se3di_scale(n->mass, link->s, o->h);
}

/* Wrench about P that a motion of the whole takes. */
static void composite_mul(const composite *c, const double *a, double *f)
{
    const double *I = c->I;
    double x[3];
    se3di_cross(c->h, a + 3, x);
    f[0] = I[0] * a[0] + I[3] * a[1] + I[4] * a[2] + x[0];
    f[1] = I[3] * a[0] + I[1] * a[1] + I[5] * a[2] + x[1];
    f[2] = I[4] * a[0] + I[5] * a[1] + I[2] * a[2] + x[2];
    se3di_cross(a, c->h, x);
    for (int k = 0; k < 3; ++k) {
        f[3 + k] = c->mass * a[3 + k] + x[k];
    }
}

/* What is beyond a joint moves to the parent's point at -d. */
static void composite_add(const composite *c, const double d[3], composite *to)
{
    const double m = c->mass;
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    const double square = 2.0 * se3di_dot(d, c->h) + m * se3di_dot(d, d);
    for (int k = 0; k < 6; ++k) {
        const int r = row[k], s = column[k];
        to->I[k] +=
            c->I[k] + (r == s ? square : 0.0) - d[r] * c->h[s] - c->h[r] * d[s] - m * d[r] * d[s];
    }
    for (int k = 0; k < 3; ++k) {
        to->h[k] += c->h[k] + m * d[k];
    }
    to->mass += m;
}

/* composites [nodes] in the scratch */
static composite *build_composites(se3di_tree *tree)
{
    _Static_assert(sizeof(composite) <= 12 * sizeof(double), "fits into the scratch");
    composite *all = (composite *)(void *)tree->scratch;
    for (uint32_t i = 0; i < tree->count; ++i) {
        own_composite(tree, i, &all[i]);
    }
    for (uint32_t i = tree->count; i-- > 0;) {
        if (tree->nodes[i].parent >= 0) {
            composite_add(&all[i], tree->links[i].d, &all[tree->nodes[i].parent]);
        }
    }
    return all;
}

void se3di_tree_mul(se3di_tree *tree, const double *x, double *out)
{
    double *motion = tree->scratch, *force = tree->scratch + 6 * (size_t)tree->count;
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *n = &tree->nodes[i];
        double *a = motion + 6 * (size_t)i;
        composite own;
        base_motion(tree, i, motion, a);
        for (size_t v = n->v; v < n->v + (size_t)n->v_count; ++v) {
            for (size_t k = 0; k < 6; ++k) {
                a[k] += tree->S[6 * v + k] * x[v];
            }
        }
        own_composite(tree, i, &own);
        composite_mul(&own, a, force + 6 * (size_t)i);
    }
    add_up(tree, force);
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *n = &tree->nodes[i];
        for (size_t v = n->v; v < n->v + (size_t)n->v_count; ++v) {
            out[v] = dot6(tree->S + 6 * v, force + 6 * (size_t)i) + tree->armature[v] * x[v];
        }
    }
}

/* Elements of a column of M: a freedom with all those between it and the ground. */
static void fill_column(const se3di_tree *tree, uint32_t i, size_t v, double f[6], double *M)
{
    const size_t n = tree->v_count;
    int32_t node = (int32_t)i;
    while (node >= 0) {
        const se3di_tree_node *at = &tree->nodes[node];
        double shifted[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
        for (size_t u = at->v; u < at->v + (size_t)at->v_count; ++u) {
            M[v * n + u] = M[u * n + v] = dot6(tree->S + 6 * u, f);
        }
        add_shifted(f, tree->links[node].d, shifted);
        memcpy(f, shifted, sizeof shifted);
        node = at->parent;
    }
}

void se3di_tree_mass_matrix(se3di_tree *tree, double *M)
{
    const size_t n = tree->v_count;
    const composite *all = build_composites(tree);
    memset(M, 0, n * n * sizeof *M);
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *node = &tree->nodes[i];
        for (size_t v = node->v; v < node->v + (size_t)node->v_count; ++v) {
            double f[6];
            composite_mul(&all[i], tree->S + 6 * v, f);
            fill_column(tree, i, v, f, M);
        }
    }
    for (size_t v = 0; v < n; ++v) {
        M[v * n + v] += tree->armature[v];
    }
}

void se3di_tree_momentum_matrix(se3di_tree *tree, const double point[3], double *H)
{
    const composite *all = build_composites(tree);
    const size_t n = tree->v_count;
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *node = &tree->nodes[i];
        double arm[3];
        se3di_sub(tree->links[i].P, point, arm);
        for (size_t v = node->v; v < node->v + (size_t)node->v_count; ++v) {
            double f[6], x[3];
            composite_mul(&all[i], tree->S + 6 * v, f);
            se3di_cross(arm, f + 3, x);
            se3di_add(f, x, f);
            for (size_t k = 0; k < 6; ++k) {
                H[k * n + v] = f[k];
            }
        }
    }
}

double se3di_tree_centre(const se3di_tree *tree, double centre[3])
{
    double mass = 0.0, sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < tree->count; ++i) {
        double r[3];
        se3di_add(tree->links[i].P, tree->links[i].s, r);
        se3di_add_scaled(tree->nodes[i].mass, r, sum);
        mass += tree->nodes[i].mass;
    }
    se3di_scale(mass > 0.0 ? 1.0 / mass : 0.0, sum, centre);
    return mass;
}

/* ---- forces along the freedoms ---- */

static void along_freedoms(const se3di_tree *tree, const double *force, double *out)
{
    for (uint32_t i = 0; i < tree->count; ++i) {
        const se3di_tree_node *n = &tree->nodes[i];
        for (size_t v = n->v; v < n->v + (size_t)n->v_count; ++v) {
            out[v] = dot6(tree->S + 6 * v, force + 6 * (size_t)i);
        }
    }
}

void se3di_tree_project(se3di_tree *tree, const double *wrench, double *out)
{
    memcpy(tree->scratch, wrench, 6 * (size_t)tree->count * sizeof *wrench);
    add_up(tree, tree->scratch);
    along_freedoms(tree, tree->scratch, out);
}

void se3di_tree_efforts(const se3di_tree *tree, const double *qddot, double *joint, double *effort)
{
    tree->core->transmit(tree, tree->acts ? tree->wrench : NULL, 0, joint);
    along_freedoms(tree, joint, effort);
    for (uint32_t v = 0; v < tree->v_count; ++v) {
        effort[v] += tree->armature[v] * qddot[v];
    }
}

/* ---- points ---- */

void se3di_tree_point(const se3di_tree *tree, uint32_t body, const double local[3], double point[3])
{
    const se3di_frame *frame = &tree->model->frames[body];
    se3di_mul(frame->A, local, point);
    se3di_add(frame->r, point, point);
}

/* A freedom's motion of what is at `point`: angular, linear. */
static void motion_at(const se3di_tree *tree, const double *S, int32_t node, const double point[3],
                      double motion[6])
{
    double arm[3];
    se3di_sub(point, tree->links[node].P, arm);
    carry_motion(S, arm, motion);
}

void se3di_tree_jacobian(const se3di_tree *tree, uint32_t body, const double point[3], double *J)
{
    const size_t n = tree->v_count;
    memset(J, 0, 6 * n * sizeof *J);
    for (int32_t node = tree->node_of[body]; node >= 0; node = tree->nodes[node].parent) {
        const se3di_tree_node *at = &tree->nodes[node];
        for (size_t v = at->v; v < at->v + (size_t)at->v_count; ++v) {
            double motion[6];
            motion_at(tree, tree->S + 6 * v, node, point, motion);
            for (size_t k = 0; k < 6; ++k) {
                J[k * n + v] = motion[k];
            }
        }
    }
}

/* Angular velocity of what a freedom's direction is fixed in: the child, or the parent where both
 * are not the same. */
static const double *turns_with(const se3di_tree *tree, const se3di_tree_node *n, int32_t node,
                                size_t freedom)
{
    static const double rest[3] = {0.0, 0.0, 0.0};
    const int in_parent = (n->type == SE3DI_TREE_UNIVERSAL && freedom == 0) ||
                          (n->type == SE3DI_TREE_PLANAR && freedom < 2);
    if ((in_parent && n->parent < 0) || (n->type == SE3DI_TREE_FREE && freedom < 3)) {
        return rest;
    }
    return tree->links[in_parent ? n->parent : node].w;
}

void se3di_tree_jacobian_rate(const se3di_tree *tree, uint32_t body, const double point[3],
                              double *rate)
{
    const size_t n = tree->v_count;
    const int32_t own = tree->node_of[body];
    double arm[3], velocity[3];
    memset(rate, 0, 6 * n * sizeof *rate);
    if (own < 0) {
        return;
    }
    se3di_sub(point, tree->links[own].P, arm);
    se3di_cross(tree->links[own].w, arm, velocity);
    se3di_add(velocity, tree->links[own].v, velocity); /* of the point */
    for (int32_t node = own; node >= 0; node = tree->nodes[node].parent) {
        const se3di_tree_node *at = &tree->nodes[node];
        double apart[3];
        se3di_sub(velocity, tree->links[node].v, apart);
        for (size_t j = 0; j < (size_t)at->v_count; ++j) {
            const double *S = tree->S + 6 * (at->v + j), *w = turns_with(tree, at, node, j);
            double turned[6], motion[6], x[3];
            se3di_cross(w, S, turned);
            se3di_cross(w, S + 3, turned + 3);
            motion_at(tree, turned, node, point, motion);
            se3di_cross(S, apart, x);
            se3di_add(motion + 3, x, motion + 3);
            for (size_t k = 0; k < 6; ++k) {
                rate[k * n + at->v + j] = motion[k];
            }
        }
    }
}

void se3di_tree_add_transposed(const se3di_tree *tree, uint32_t body, const double point[3],
                               const double wrench[6], double *out)
{
    for (int32_t node = tree->node_of[body]; node >= 0; node = tree->nodes[node].parent) {
        const se3di_tree_node *at = &tree->nodes[node];
        for (size_t v = at->v; v < at->v + (size_t)at->v_count; ++v) {
            double motion[6];
            motion_at(tree, tree->S + 6 * v, node, point, motion);
            out[v] += dot6(motion, wrench);
        }
    }
}
