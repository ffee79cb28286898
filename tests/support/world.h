/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies, joints and solvers of a system in few words; the test program stops if a call fails. */
#ifndef SE3D_TESTS_SUPPORT_WORLD_H
#define SE3D_TESTS_SUPPORT_WORLD_H

#include "check.h"
#include "se3d/se3d.h"

#include <stdlib.h>

/* Stop the test program where building a model fails: nothing after it would mean anything. */
static inline void world_must(const se3d_system *system, se3d_status status, const char *text)
{
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s: %s: %s\n", check_case, text,
                system ? se3d_system_get_error(system) : "");
        exit(1);
    }
}
typedef se3d_status (*joint_create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

/* A joint at a point of the ground frame, with the axis given. */
static inline se3d_constraint world_join(se3d_system *system, joint_create create, const char *name,
                                         se3d_body i, se3d_body j, const double at[3],
                                         const double axis[3])
{
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.name = name;
    def.body_i = i;
    def.body_j = j;
    world_must(system, se3d_joint_def_set_frame(system, &def, at, axis, NULL), "set_frame");
    world_must(system, create(system, &def, &joint), "create");
    return joint;
}

/* A body at rest with principal moments of inertia J. */
static inline se3d_body world_add_body(se3d_system *system, double mass, const double J[3],
                                       const double r[3])
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.mass = mass;
    memcpy(def.inertia, J, 3 * sizeof *J);
    memcpy(def.position, r, sizeof def.position);
    world_must(system, se3d_body_create(system, &def, &body), "se3d_body_create");
    return body;
}

/* A solver with the other settings at their defaults. */
static inline se3d_solver *world_solver(se3d_system *system, int32_t analysis, int32_t method,
                                        int32_t formulation, double step)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.method = method;
    def.formulation = formulation;
    def.step = step;
    world_must(system, se3d_solver_create(system, &def, &solver), "se3d_solver_create");
    return solver;
}

#endif
