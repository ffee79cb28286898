/* SPDX-License-Identifier: BSD-3-Clause */
/* Random mechanisms for tests of joint coordinates: trees of all joint types either way round, with
 * random frames and axes that may be opposite, springs, and joints that close loops. */
#ifndef SE3D_TESTS_TREE_WORLD_H
#define SE3D_TESTS_TREE_WORLD_H

#include "check.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#define TREE_BODIES_MAX 12

typedef struct tree_world {
    se3d_system *system;
    se3d_body bodies[TREE_BODIES_MAX + 1]; /* [0] the ground */
    int count;                             /* with the ground */
    se3d_constraint joints[2 * TREE_BODIES_MAX];
    int joint_count;
    uint64_t seed;
} tree_world;

typedef se3d_status (*tree_joint_create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

/* Those that may be on a tree come first. */
static const struct tree_kind {
    tree_joint_create create;
    int taken;  /* freedoms */
    int square; /* axes at right angles */
} tree_kinds[] = {
    {se3d_joint_create_revolute, 5, 0},      {se3d_joint_create_spherical, 3, 0},
    {se3d_joint_create_prismatic, 5, 0},     {se3d_joint_create_cylindrical, 4, 0},
    {se3d_joint_create_universal, 4, 1},     {se3d_joint_create_planar, 3, 0},
    {se3d_joint_create_screw, 5, 0},         {se3d_joint_create_fixed, 6, 0},
    {se3d_joint_create_point_on_line, 2, 0}, {se3d_joint_create_point_on_plane, 1, 0},
    {se3d_joint_create_parallel, 2, 0},      {se3d_joint_create_perpendicular, 1, 1},
    {se3d_joint_create_orientation, 3, 0},
};
enum { TREE_KINDS = 8, TREE_ALL_KINDS = sizeof tree_kinds / sizeof *tree_kinds };

static inline double tree_uniform(tree_world *w, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + check_random(&w->seed));
}

static inline int tree_below(tree_world *w, int count)
{
    const int k = (int)tree_uniform(w, 0.0, count);
    return k < count ? k : count - 1;
}

static inline void tree_vector(tree_world *w, double *v, int count, double scale)
{
    for (int k = 0; k < count; ++k) {
        v[k] = tree_uniform(w, -scale, scale);
    }
}

static inline void tree_unit(tree_world *w, double *v, int count)
{
    double square = 0.0;
    while (square < 0.1) {
        tree_vector(w, v, count, 1.0);
        square = 0.0;
        for (int k = 0; k < count; ++k) {
            square += v[k] * v[k];
        }
    }
    for (int k = 0; k < count; ++k) {
        v[k] /= sqrt(square);
    }
}

static inline void tree_add_body(tree_world *w)
{
    se3d_body_def def = se3d_body_def_default();
    const double a = tree_uniform(w, 0.1, 1.0), b = tree_uniform(w, 0.1, 1.0);
    const double c = tree_uniform(w, 0.1, 1.0);
    tree_vector(w, def.position, 3, 1.0);
    tree_unit(w, def.orientation, 4);
    def.mass = tree_uniform(w, 0.5, 5.0);
    def.inertia[0] = b + c;
    def.inertia[1] = a + c;
    def.inertia[2] = a + b;
    tree_vector(w, def.inertia + 3, 3, 0.1);
    tree_vector(w, def.velocity, 3, 1.0);
    tree_vector(w, def.angular_velocity, 3, 1.0);
    CHECK(!se3d_body_create(w->system, &def, &w->bodies[w->count++]));
}

/* A point and a direction of the ground in the frame of body k. */
static inline void tree_to_body(const tree_world *w, int k, const double point[3],
                                const double axis[3], double local_point[3], double local_axis[3])
{
    double r[3], p[4], A[9], d[3];
    CHECK(!se3d_body_get_position(w->system, w->bodies[k], r));
    CHECK(!se3d_body_get_orientation(w->system, w->bodies[k], p));
    se3di_quat_to_matrix(p, A);
    se3di_sub(point, r, d);
    se3di_mul_transposed(A, d, local_point);
    se3di_mul_transposed(A, axis, local_axis);
}

/* Between two bodies at their present poses, which it leaves possible. */
static inline void tree_add_joint(tree_world *w, int i, int j, const struct tree_kind *kind)
{
    double at[3], axis[3], other[3], along;
    se3d_joint_def def = se3d_joint_def_default();
    tree_vector(w, at, 3, 1.5);
    tree_unit(w, axis, 3);
    tree_unit(w, other, 3);
    along = se3di_dot(axis, other);
    for (int c = 0; c < 3; ++c) {
        other[c] = kind->square ? other[c] - along * axis[c] : axis[c];
    }
    if (!kind->square && tree_below(w, 3) == 0) {
        se3di_scale(-1.0, other, other);
    }
    def.angle0 = tree_uniform(w, -4.0, 4.0);
    def.pitch = tree_uniform(w, 0.05, 0.5);
    def.body_i = w->bodies[i];
    def.body_j = w->bodies[j];
    tree_to_body(w, i, at, axis, def.point_i, def.axis_i);
    tree_to_body(w, j, at, other, def.point_j, def.axis_j);
    CHECK(!kind->create(w->system, &def, &w->joints[w->joint_count++]));
}

static inline void tree_add_spring(tree_world *w, int i, int j)
{
    se3d_tsda_def def = se3d_tsda_def_default();
    se3d_force force;
    def.body_i = w->bodies[i];
    def.body_j = w->bodies[j];
    tree_vector(w, def.point_i, 3, 1.0);
    tree_vector(w, def.point_j, 3, 1.0);
    def.k = tree_uniform(w, 0.0, 50.0);
    def.c = tree_uniform(w, 0.0, 3.0);
    def.l0 = tree_uniform(w, 0.0, 2.0);
    CHECK(!se3d_force_create_tsda(w->system, &def, &force));
}

/* Bodies, each joined to an earlier one or to nothing; `loops` more joints of few equations. */
static inline void tree_world_init(tree_world *w, uint64_t seed, int bodies, int loops)
{
    double gravity[3];
    *w = (tree_world){.seed = seed * 2654435761u + 7919u, .count = 1};
    check_random(&w->seed);
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &w->bodies[0]));
    tree_vector(w, gravity, 3, 10.0);
    CHECK(!se3d_system_set_gravity(w->system, gravity));
    for (int k = 1; k <= bodies; ++k) {
        tree_add_body(w);
        const int other = tree_below(w, 3) == 0 ? tree_below(w, k) : k - 1;
        const int turned = tree_below(w, 2);
        if (tree_below(w, 8) > 0) {
            tree_add_joint(w, turned ? k : other, turned ? other : k,
                           &tree_kinds[tree_below(w, TREE_KINDS)]);
        }
        if (tree_below(w, 3) == 0) {
            tree_add_spring(w, tree_below(w, k), k);
        }
    }
    for (int k = 0; k < loops; ++k) {
        const int i = tree_below(w, w->count), j = tree_below(w, w->count);
        if (i != j) {
            tree_add_joint(w, i, j,
                           &tree_kinds[TREE_KINDS + tree_below(w, TREE_ALL_KINDS - TREE_KINDS)]);
        }
    }
}

static inline void tree_world_destroy(tree_world *w)
{
    se3d_system_destroy(w->system);
}

#endif
