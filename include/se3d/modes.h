/* SPDX-License-Identifier: BSD-3-Clause */
/* Small motions about an equilibrium or a steady motion: eigenvalues, mode shapes, state-space
 * matrices, transfer functions.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_MODES_H
#define SE3D_MODES_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A force at a point of a body, or a torque on it, along a direction. @since 0.1 */
typedef struct se3d_modes_input {
    se3d_body body;    /* that it acts on */
    int32_t is_torque; /* not 0: a torque */
    int32_t reserved;
    double point[3];     /* force: where it acts, body frame [m] */
    double direction[3]; /* ground frame; made a unit vector */
} se3d_modes_input;

/* The quantity of an output. @since 0.1 */
typedef enum se3d_modes_quantity {
    SE3D_MODES_POSITION = 0, /* of a point, along the direction [m] */
    SE3D_MODES_VELOCITY = 1,
    SE3D_MODES_ACCELERATION = 2,
    SE3D_MODES_ROTATION = 3, /* of the body, about the direction [rad] */
    SE3D_MODES_ANGULAR_VELOCITY = 4,
    SE3D_MODES_ANGULAR_ACCELERATION = 5
} se3d_modes_quantity;

/* A component of the motion of a body, as a change from the present one. @since 0.1 */
typedef struct se3d_modes_output {
    se3d_body body;   /* that moves */
    int32_t quantity; /* se3d_modes_quantity */
    int32_t reserved;
    double point[3];     /* body frame [m] */
    double direction[3]; /* ground frame; made a unit vector */
} se3d_modes_output;

/* The definition of the linearisation; both lists may be empty. Copied. @since 0.1 */
typedef struct se3d_modes_def {
    size_t struct_size;
    const se3d_modes_input *inputs;   /* [input_count] */
    size_t input_count;               /* default 0 */
    const se3d_modes_output *outputs; /* [output_count] */
    size_t output_count;              /* default 0 */
    size_t lowest; /* not 0: only that many modes of the lowest |s|, as far as there are; no lists
                      then, and matrices are 0 x 0. Of large models at rest without damping they
                      are found without dense matrices. Default 0: all */
} se3d_modes_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_modes_def_default. @since 0.1 */
SE3D_API void se3d_modes_def_init(se3d_modes_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_modes_def se3d_modes_def_default(void)
{
    se3d_modes_def def;
    se3d_modes_def_init(&def, sizeof def);
    return def;
}

/* Linearise a system at its present state: an equilibrium (run that analysis first), or a motion
 * that is steady, so that small motions beside it have constant coefficients: in axes that turn
 * with the bodies, as of a governor (directions then turn with the body); in those of what carries
 * a body, as of a rotor in a gimbal; or in axes that do not turn. They are tried in this order; a
 * motion that is steady in none of these is refused (STATE). Accelerations and multipliers of the
 * present state are computed; poses that are open by more than 1e-3 of the size are refused
 * (INCONSISTENT), and so are drivers whose rates follow signals (UNSUPPORTED). `def` may be NULL.
 * @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE, STATE, INCONSISTENT, SINGULAR, NOT_FINITE,
 * UNSUPPORTED, NO_CONVERGENCE, CALLBACK, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_modes_create(se3d_system *system, const se3d_modes_def *def,
                                       se3d_modes **out);

/* Destroy a linearised system; NULL is fine. @since 0.1 */
SE3D_API void se3d_modes_destroy(se3d_modes *modes);

/* Count modes: one for each real eigenvalue and each conjugate pair. @return the number; 0 for
 * NULL. @since 0.1 */
SE3D_API size_t se3d_modes_count(const se3d_modes *modes);

/* Count degrees of freedom. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_modes_count_freedoms(const se3d_modes *modes);

/* An eigenvalue s = real + i imaginary, imaginary >= 0. @since 0.1 */
typedef struct se3d_eigenvalue {
    double real;      /* [1/s]; > 0: unstable */
    double imaginary; /* of the damped oscillation [rad/s] */
    double frequency; /* |s| / (2 pi), the undamped natural frequency [Hz] */
    double damping;   /* ratio -real / |s|; 0 for s = 0 */
} se3d_eigenvalue;

/* As se3d_modes_get_eigenvalue, told the size of *eigenvalue in bytes. @return as
 * se3d_modes_get_eigenvalue, and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_modes_get_eigenvalue_sized(const se3d_modes *modes, size_t k,
                                                     se3d_eigenvalue *eigenvalue, size_t size);

/* Get the eigenvalue of a mode, in the order of increasing |s|.
 * @param[in] k  the mode, from 0, below se3d_modes_count
 * @return OK, NULL, INVALID_ARGUMENT (k).
 * @since 0.1 */
static inline se3d_status se3d_modes_get_eigenvalue(const se3d_modes *modes, size_t k,
                                                    se3d_eigenvalue *eigenvalue)
{
    return se3d_modes_get_eigenvalue_sized(modes, k, eigenvalue, sizeof *eigenvalue);
}

/* Get the eigenvalues that the modes of one system have in another one, whose data differ a little:
 * masses, points, stiffnesses. They are those of the other system to second order in what differs,
 * so that their derivatives with respect to the data are exact, and which mode is which is never
 * mistaken. The other system is linearised at its present state, as se3d_modes_create does.
 * docs/theory/modes.md
 * @param[in] system      another system with the same bodies and freedoms
 * @param[in] count       se3d_modes_count
 * @param[out] real       [count] real parts [1/s]; NaN: the mode is no smooth function of the data,
 *                        as its eigenvalue is 0 or not a single one
 * @param[out] imaginary  [count] imaginary parts [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count), STATE (other bodies or freedoms), UNSUPPORTED (the
 *         lowest modes of a large model), INCONSISTENT, SINGULAR, NOT_FINITE, NO_CONVERGENCE,
 *         CALLBACK, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_modes_follow(const se3d_modes *modes, se3d_system *system, size_t count,
                                       double *real, double *imaginary);

/* Get what a mode does to a body: the displacement of its centre of mass and its rotation vector,
 * as complex numbers. The largest component of the mode is 1. NULL arrays are skipped.
 * @param[in] k           the mode, from 0
 * @param[in] body        its index, as se3d_system_get_body counts
 * @param[out] real       real parts, ground frame [m, rad]
 * @param[out] imaginary  imaginary parts, ground frame [m, rad]
 * @return OK, NULL, INVALID_ARGUMENT (k, body).
 * @since 0.1 */
SE3D_API se3d_status se3d_modes_get_shape(const se3d_modes *modes, size_t k, size_t body,
                                          double real[6], double imaginary[6]);

/* Matrices, row-major. With f freedoms the state is (y, y'), m = 2 f:
 * x' = A x + B u, outputs = C x + D u;  Mr y'' + Dr y' + Kr y = inputs. @since 0.1 */
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

/* Get a matrix of the linearised equations, or only its size.
 * @param[in] matrix    se3d_modes_matrix
 * @param[out] rows     of the matrix
 * @param[out] columns  of the matrix
 * @param[out] values   [rows * columns] row-major, SI units [1]; NULL: only the size
 * @param[in] capacity  numbers that `values` has room for
 * @return OK, NULL, INVALID_ARGUMENT (matrix, capacity).
 * @since 0.1 */
SE3D_API se3d_status se3d_modes_get_matrix(const se3d_modes *modes, int32_t matrix, size_t *rows,
                                           size_t *columns, double *values, size_t capacity);

/* Get the transfer function from an input to an output.
 * @param[in] input       index in the inputs of the definition
 * @param[in] output      index in the outputs of the definition
 * @param[in] frequency   [Hz]
 * @param[out] real       real part [unit of the output over that of the input]
 * @param[out] imaginary  imaginary part [unit of the output over that of the input]
 * @return OK, NULL, INVALID_ARGUMENT, SINGULAR (undamped resonance), NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_modes_get_transfer(const se3d_modes *modes, size_t input, size_t output,
                                             double frequency, double *real, double *imaginary);

#ifdef __cplusplus
}
#endif
#endif
