/* SPDX-License-Identifier: BSD-3-Clause */
/* Handles: owners are pointers to incomplete types, elements of a system are small ids by value.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_HANDLES_H
#define SE3D_HANDLES_H

#include "se3d/base.h"

/* A model with its state; destroy with se3d_system_destroy. @since 0.1 */
typedef struct se3d_system se3d_system;
/* An analysis of one system; destroy with se3d_solver_destroy. @since 0.1 */
typedef struct se3d_solver se3d_solver;
/* Particles of a system, which destroys them with itself unless se3d_particles_destroy did before.
 * @since 0.1 */
typedef struct se3d_particles se3d_particles;

/* A saved state of a system, which continues bit-identically when it is restored there or on a
 * clone; destroy with se3d_snapshot_destroy. @since 0.1 */
typedef struct se3d_snapshot se3d_snapshot;
/* A linearised system; destroy with se3d_modes_destroy. It keeps nothing of its system.
 * @since 0.1 */
typedef struct se3d_modes se3d_modes;
/* Joint coordinates of a system, and what follows from them without a step; destroy with
 * se3d_coordinates_destroy. @since 0.1 */
typedef struct se3d_coordinates se3d_coordinates;
/* Many states of one system side by side; destroy with se3d_batch_destroy. It keeps nothing of its
 * system. @since 0.1 */
typedef struct se3d_batch se3d_batch;
/* A report on the constraints of a system; destroy with se3d_check_destroy. @since 0.1 */
typedef struct se3d_check se3d_check;
/* A compiled expression, immutable; destroy with se3d_expression_destroy. @since 0.1 */
typedef struct se3d_expression se3d_expression;

/* ---- Owners of libse3d-io (se3d/io.h). ---- */

/* A model file that was read; destroy with se3d_model_destroy. @since 0.1 */
typedef struct se3d_model se3d_model;
/* The report on a run of a model; destroy with se3d_run_destroy. @since 0.1 */
typedef struct se3d_run se3d_run;
/* The motion of a model as a 3-D scene: make it, record during a run, write it; destroy with
 * se3d_scene_destroy. @since 0.1 */
typedef struct se3d_scene se3d_scene;

/* ---- Elements: all zero is null. A handle of a destroyed element, or of another system, is always
 * detected. ---- */

/* A rigid body. @since 0.1 */
typedef struct se3d_body {
    uint32_t index1;
    uint32_t generation;
} se3d_body;

/* A point with a frame on a body. @since 0.1 */
typedef struct se3d_marker {
    uint32_t index1;
    uint32_t generation;
} se3d_marker;

/* A function of time or of a force element's variables. @since 0.1 */
typedef struct se3d_function {
    uint32_t index1;
    uint32_t generation;
} se3d_function;

/* A primitive constraint, a joint or a driver. @since 0.1 */
typedef struct se3d_constraint {
    uint32_t index1;
    uint32_t generation;
} se3d_constraint;

/* A force element. @since 0.1 */
typedef struct se3d_force {
    uint32_t index1;
    uint32_t generation;
} se3d_force;

/* A material of shapes and particles. @since 0.1 */
typedef struct se3d_material {
    uint32_t index1;
    uint32_t generation;
} se3d_material;

/* A shape on a body, for contact. @since 0.1 */
typedef struct se3d_shape {
    uint32_t index1;
    uint32_t generation;
} se3d_shape;

/* A wheel on its upright. @since 0.1 */
typedef struct se3d_wheel {
    uint32_t index1;
    uint32_t generation;
} se3d_wheel;

/* A road under tyres. @since 0.1 */
typedef struct se3d_road {
    uint32_t index1;
    uint32_t generation;
} se3d_road;

/* A user-defined state. @since 0.1 */
typedef struct se3d_state {
    uint32_t index1;
    uint32_t generation;
} se3d_state;

/* An event of one solver. @since 0.1 */
typedef struct se3d_event {
    uint32_t index1;
    uint32_t generation;
} se3d_event;

#endif
