/* SPDX-License-Identifier: BSD-3-Clause */
/* Handles: owners are pointers to incomplete types, elements of a system are small ids by value. */
#ifndef SE3D_HANDLES_H
#define SE3D_HANDLES_H

#include "se3d/base.h"

/* A model with its state; destroy with se3d_system_destroy. */
typedef struct se3d_system se3d_system;
/* An analysis of one system; destroy with se3d_solver_destroy. */
typedef struct se3d_solver se3d_solver;
/* Particles of a system, which destroys them with itself unless se3d_particles_destroy did before.
 */
typedef struct se3d_particles se3d_particles;

/* Elements: all zero is null. A handle of a destroyed element, or of another system, is always
 * detected. */
typedef struct se3d_body {
    uint32_t index1;
    uint32_t generation;
} se3d_body;

/* A point with a frame on a body. */
typedef struct se3d_marker {
    uint32_t index1;
    uint32_t generation;
} se3d_marker;

/* A function of time or of a force element's variables. */
typedef struct se3d_function {
    uint32_t index1;
    uint32_t generation;
} se3d_function;

/* A primitive constraint, a joint or a driver. */
typedef struct se3d_constraint {
    uint32_t index1;
    uint32_t generation;
} se3d_constraint;

/* A force element. */
typedef struct se3d_force {
    uint32_t index1;
    uint32_t generation;
} se3d_force;

/* What shapes and particles are made of. */
typedef struct se3d_material {
    uint32_t index1;
    uint32_t generation;
} se3d_material;

/* A shape on a body, for contact. */
typedef struct se3d_shape {
    uint32_t index1;
    uint32_t generation;
} se3d_shape;

/* The two formulations; both give the same motion. */
typedef enum se3d_formulation {
    SE3D_FORMULATION_ROMEGA = 0, /* unknowns: position and virtual rotation (angular velocity) */
    SE3D_FORMULATION_RP = 1      /* unknowns: position and Euler parameters with p.p - 1 = 0 */
} se3d_formulation;

#endif
