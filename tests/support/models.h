/* SPDX-License-Identifier: BSD-3-Clause */
/* Mechanisms that many tests and benches need, built through the public API.
 *
 * A plan is the mechanism as plain data, in a pose that satisfies its joints; it can be turned,
 * moved and renumbered before a system is built from it. */
#ifndef SE3D_TESTS_SUPPORT_MODELS_H
#define SE3D_TESTS_SUPPORT_MODELS_H

#include "se3d/se3d.h"

typedef se3d_status (*support_joint_create)(se3d_system *system, const se3d_joint_def *def,
                                            se3d_constraint *joint);

typedef struct support_body {
    double mass, inertia[6];
    double position[3], orientation[4];
    double velocity[3], angular_velocity[3];
} support_body;

typedef struct support_joint {
    support_joint_create create;
    int i, j; /* plan index of the bodies, -1: the ground */
    double at[3], axis[3];
    double axis_j[3];  /* not zero: the axis on body j (universal) */
    const char *drive; /* NULL, or the angle as an expression in t */
} support_joint;

typedef struct support_plan {
    int body_count, joint_count;
    double gravity[3];
    support_body *bodies;
    support_joint *joints;
} support_plan;

/* A system built from a plan; arrays in the order of the plan. */
typedef struct support_model {
    se3d_system *system;
    se3d_body ground;
    se3d_body *bodies;
    se3d_constraint *joints;
    se3d_constraint *drivers; /* [joint_count], null if the joint has none */
    int body_count, joint_count;
} support_model;

/* The mechanisms, by name; `count`: links of a chain, four-bars in a row (others ignore it).
 *
 *     pendulum, double_pendulum, heavy_top, four_bar, slider_crank, chain_revolute, chain_ball
 *     driven_pendulum, driven_double_pendulum (one driver: rheonomic, one freedom left),
 *     driven_four_bar, driven_slider_crank (determined by their drivers) */
void support_plan_make(support_plan *plan, const char *name, int count);
void support_plan_destroy(support_plan *plan);

/* Turn the whole mechanism, gravity included, by Euler parameters and move it. */
void support_plan_transform(support_plan *plan, const double turn[4], const double shift[3]);

/* Build; `reversed`: bodies and joints are created in the opposite order. On failure `model` is
 * empty. */
se3d_status support_model_create(support_model *model, const support_plan *plan,
                                 const se3d_allocator *allocator, int reversed);
void support_model_destroy(support_model *model);

/* Plan and model at once; aborts the test program where that fails. */
void support_model_make(support_model *model, const char *name, int count);

#endif
