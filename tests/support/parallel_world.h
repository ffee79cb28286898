/* SPDX-License-Identifier: BSD-3-Clause */
/* Random trees of revolutes about parallel axes, which move in planes. */
#ifndef SE3D_TESTS_PARALLEL_WORLD_H
#define SE3D_TESTS_PARALLEL_WORLD_H

#include "support/tree_world.h"

/* A revolute whose axis is `axis`, up to its sign on either body, but for `tilt`. */
static inline void tree_add_parallel(tree_world *w, int i, int j, const double axis[3], double tilt)
{
    double at[3], along[3], tilted[3];
    se3d_joint_def def = se3d_joint_def_default();
    tree_vector(w, at, 3, 1.5);
    se3di_scale(tree_below(w, 2) ? 1.0 : -1.0, axis, along);
    def.angle0 = tree_uniform(w, -4.0, 4.0);
    def.body_i = w->bodies[i];
    def.body_j = w->bodies[j];
    tree_to_body(w, i, at, along, def.point_i, def.axis_i);
    se3di_scale(tree_below(w, 2) ? 1.0 : -1.0, axis, tilted);
    tilted[0] += tilt;
    tilted[1] -= 0.3 * tilt;
    tree_to_body(w, j, at, tilted, def.point_j, def.axis_j);
    CHECK(!se3d_joint_create_revolute(w->system, &def, &w->joints[w->joint_count++]));
}

/* Bodies of any inertia, anywhere along the axes; several of them may hang on the ground or on one
 * body. */
static inline void tree_make_parallel(tree_world *w, uint64_t seed, double tilt)
{
    double axis[3], gravity[3];
    tree_world_init(w, seed, 0, 0);
    tree_unit(w, axis, 3);
    tree_vector(w, gravity, 3, 10.0);
    CHECK(!se3d_system_set_gravity(w->system, gravity));
    for (int k = 1; k <= 1 + (int)(seed % TREE_BODIES_MAX); ++k) {
        tree_add_body(w);
        const int other = k > 1 && tree_below(w, 3) == 0 ? tree_below(w, k) : k - 1;
        const int turned = tree_below(w, 2);
        tree_add_parallel(w, turned ? k : other, turned ? other : k, axis, k == 2 ? tilt : 0.0);
    }
}

#endif
