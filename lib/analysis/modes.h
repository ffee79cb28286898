/* SPDX-License-Identifier: BSD-3-Clause */
/* A model linearised about its present motion: matrices over its freedoms, modes, inputs and
 * outputs, state space, transfer functions.
 *
 * Inputs and outputs are both vectors g over displacements in body axes: a force e at s does the
 * work g . dq, and the displacement of the point along e is g . dq, g = (A^T e, s x A^T e); a
 * torque and a rotation have g = (0, A^T e).  docs/theory/modes.md */
#ifndef SE3DI_MODES_H
#define SE3DI_MODES_H

#include "analysis/eigen_modes.h"
#include "model/model.h"
#include "nonlinear/equations.h"
#include "se3d/modes.h"

typedef struct se3di_modes {
    se3d_allocator allocator;
    size_t f, n, inputs, outputs, bodies; /* bodies: dense */
    size_t lowest;                        /* modes that are asked for; 0: all, and matrices */
    int32_t is_sparse;                    /* shapes are over unknowns; no matrices */
    int32_t reserved;
    se3di_eigen eigen;
    double *M, *D, *K; /* [f f] */
    double *Z;         /* [f n], rows */
    double *b;         /* [inputs f] */
    double *c;         /* [outputs f] */
    double *A;         /* [2 f 2 f] */
    double *B;         /* [inputs 2 f], by input */
    int32_t *quantity; /* [outputs] */
    int32_t *free;     /* [bodies] -1: fixed */
    double *rotation;  /* [bodies 9] */
    double *largest;   /* [eigen.room 2] largest component of each mode, complex */
} se3di_modes;

/* A point (a body's axes) or a body, and a unit vector (ground frame) there. */
typedef struct se3di_modes_port {
    uint32_t body;
    int32_t turns; /* a torque or a rotation; else a force or a displacement of the point */
    double point[3];
    double direction[3];
} se3di_modes_port;

/* Linearise at the present state. `ports` are the inputs, then the outputs, whose quantities
 * (se3d_modes_quantity) follow; none if only the `lowest` modes are asked for, not 0. On failure
 * nothing is held. */
se3d_status se3di_modes_init(se3di_modes *modes, se3di_model *model, se3di_error *error,
                             size_t inputs, size_t outputs, const se3di_modes_port *ports,
                             const int32_t *quantity, size_t lowest);
void se3di_modes_destroy(se3di_modes *modes);
/* What comes before linearising at the present state: ranks, a look at the poses, accelerations. */
se3d_status se3di_modes_prepare(se3di_equations *equations);

/* Displacement and rotation of a body in mode k, ground frame, such that the largest component of
 * the mode is 1. */
void se3di_modes_shape(const se3di_modes *modes, size_t k, size_t body, double real[6],
                       double imaginary[6]);
/* Rows and columns of a matrix (se3d_modes_matrix), one of its entries. */
void se3di_modes_size(const se3di_modes *modes, int32_t matrix, size_t size[2]);
double se3di_modes_entry(const se3di_modes *modes, int32_t matrix, size_t r, size_t c);
/* Transfer function at the angular frequency w [rad/s]: {real, imaginary}; 0 on failure.
 * @return OK, SINGULAR, NO_MEMORY */
se3d_status se3di_modes_transfer(const se3di_modes *modes, size_t input, size_t output, double w,
                                 double h[2]);

#endif
