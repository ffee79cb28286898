/* SPDX-License-Identifier: BSD-3-Clause */
/* Small motions about an equilibrium or a steady motion: eigenvalues, mode shapes, state-space
 * matrices, transfer functions. */
#ifndef SE3D_MODES_H
#define SE3D_MODES_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A force at a point of a body, or a torque on it, along a direction. */
typedef struct se3d_modes_input {
    se3d_body body;
    int32_t is_torque; /* not 0: a torque */
    int32_t reserved;
    double point[3];     /* force: where it acts, body frame [m] */
    double direction[3]; /* ground frame, made unit */
} se3d_modes_input;

typedef enum se3d_modes_quantity {
    SE3D_MODES_POSITION = 0, /* of a point, along the direction [m] */
    SE3D_MODES_VELOCITY = 1,
    SE3D_MODES_ACCELERATION = 2,
    SE3D_MODES_ROTATION = 3, /* of the body, about the direction [rad] */
    SE3D_MODES_ANGULAR_VELOCITY = 4,
    SE3D_MODES_ANGULAR_ACCELERATION = 5
} se3d_modes_quantity;

/* A component of the motion of a body, as a change from the present one. */
typedef struct se3d_modes_output {
    se3d_body body;
    int32_t quantity; /* se3d_modes_quantity */
    int32_t reserved;
    double point[3];     /* body frame [m] */
    double direction[3]; /* ground frame, made unit */
} se3d_modes_output;

/* What the linearisation is made with; both lists may be empty. Copied. @since 0.1 */
typedef struct se3d_modes_def {
    size_t struct_size;
    const se3d_modes_input *inputs;
    size_t input_count;
    const se3d_modes_output *outputs;
    size_t output_count;
} se3d_modes_def;

SE3D_API void se3d_modes_def_init(se3d_modes_def *def, size_t size);

static inline se3d_modes_def se3d_modes_def_default(void)
{
    se3d_modes_def def;
    se3d_modes_def_init(&def, sizeof def);
    return def;
}

/* Linearise at the present state: an equilibrium (run the analysis first), or a motion that is
 * steady in the axes of the bodies, as a rotor's or a governor's; directions then turn with the
 * body. `def` may be NULL. Computes accelerations and multipliers at the present state.
 * @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE, INCONSISTENT, SINGULAR, NOT_FINITE,
 * NO_CONVERGENCE, CALLBACK, NO_MEMORY. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_modes_create(se3d_system *system, const se3d_modes_def *def,
                                       se3d_modes **out);
SE3D_API void se3d_modes_destroy(se3d_modes *modes);

/* Count modes: one for each real eigenvalue and each conjugate pair. Zero for NULL. Reader. @since
 * 0.1 */
SE3D_API size_t se3d_modes_count(const se3d_modes *modes);
/* Count degrees of freedom. Zero for NULL. Reader. @since 0.1 */
SE3D_API size_t se3d_modes_count_freedoms(const se3d_modes *modes);

/* An eigenvalue s = real + i imaginary, imaginary >= 0. */
typedef struct se3d_eigenvalue {
    double real;      /* [1/s]; > 0: unstable */
    double imaginary; /* of the damped oscillation [rad/s] */
    double frequency; /* |s| / (2 pi), the undamped natural frequency [Hz] */
    double damping;   /* ratio -real / |s|; 0 for s = 0 */
} se3d_eigenvalue;

/* Get mode k, in the order of increasing |s|. Reader. @since 0.1 */
SE3D_API se3d_status se3d_modes_get_eigenvalue_sized(const se3d_modes *modes, size_t k,
                                                     se3d_eigenvalue *eigenvalue, size_t size);
static inline se3d_status se3d_modes_get_eigenvalue(const se3d_modes *modes, size_t k,
                                                    se3d_eigenvalue *eigenvalue)
{
    return se3d_modes_get_eigenvalue_sized(modes, k, eigenvalue, sizeof *eigenvalue);
}
/* Get the shape of mode k at the body of dense index `body` (as se3d_system_get_body counts):
 * displacement of its centre of mass and rotation vector, ground frame, real and imaginary parts.
 * The largest component of the mode is 1. Either may be NULL. Reader. @since 0.1 */
SE3D_API se3d_status se3d_modes_get_shape(const se3d_modes *modes, size_t k, size_t body,
                                          double real[6], double imaginary[6]);

/* Matrices, row-major. With f freedoms the state is (y, y'), m = 2 f:
 * x' = A x + B u, outputs = C x + D u;  Mr y'' + Dr y' + Kr y = inputs. */
typedef enum se3d_modes_matrix {
    SE3D_MODES_A = 0,         /* m x m */
    SE3D_MODES_B = 1,         /* m x inputs */
    SE3D_MODES_C = 2,         /* outputs x m */
    SE3D_MODES_D = 3,         /* outputs x inputs */
    SE3D_MODES_MASS = 4,      /* f x f */
    SE3D_MODES_DAMPING = 5,   /* f x f */
    SE3D_MODES_STIFFNESS = 6, /* f x f */
    SE3D_MODES_BASIS = 7      /* 6 per movable body x f: displacement and rotation, body frame */
} se3d_modes_matrix;

/* Get size and, where `values` is not NULL, the matrix (of `capacity` numbers, at least rows *
 * columns). Reader. @since 0.1 */
SE3D_API se3d_status se3d_modes_get_matrix(const se3d_modes *modes, int32_t matrix, size_t *rows,
                                           size_t *columns, double *values, size_t capacity);

/* Get the transfer function from an input to an output at a frequency [Hz]. @return OK, NULL,
 * INVALID_ARGUMENT, SINGULAR (undamped resonance), NO_MEMORY. Reader. @since 0.1 */
SE3D_API se3d_status se3d_modes_get_transfer(const se3d_modes *modes, size_t input, size_t output,
                                             double frequency, double *real, double *imaginary);

#ifdef __cplusplus
}
#endif
#endif
