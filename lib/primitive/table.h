/* SPDX-License-Identifier: BSD-3-Clause */
/* Declares the functions of all primitives, and defines those of one for both formulations. */
#ifndef SE3DI_PRIMITIVE_TABLE_H
#define SE3DI_PRIMITIVE_TABLE_H

#include "primitive/primitive.h"

#define SE3DI_ON_TERM const se3di_term *t, const se3di_frame *i, const se3di_frame *j

#define SE3DI_PRIMITIVE_DECLARE(TYPE, name)                                                        \
    double se3di_primitive_##name##_value(SE3DI_ON_TERM);                                          \
    void se3di_primitive_##name##_jacobian_romega(SE3DI_ON_TERM, double phi_i[6],                  \
                                                  double phi_j[6]);                                \
    void se3di_primitive_##name##_jacobian_rp(SE3DI_ON_TERM, double phi_i[7], double phi_j[7]);    \
    double se3di_primitive_##name##_gamma_romega(SE3DI_ON_TERM);                                   \
    double se3di_primitive_##name##_gamma_rp(SE3DI_ON_TERM);                                       \
    void se3di_primitive_##name##_curvature_romega(SE3DI_ON_TERM, double lambda, double H[144]);   \
    void se3di_primitive_##name##_curvature_rp(SE3DI_ON_TERM, double lambda, double H[196]);

SE3DI_PRIMITIVE_LIST(SE3DI_PRIMITIVE_DECLARE)

#undef SE3DI_PRIMITIVE_DECLARE

/* The functions `name` of both formulations from one, `either`, that takes the way (kernel.h). */
#define SE3DI_PRIMITIVE_JACOBIANS(name, either)                                                    \
    void se3di_primitive_##name##_jacobian_romega(SE3DI_ON_TERM, double phi_i[6], double phi_j[6]) \
    {                                                                                              \
        either(SE3DI_WAY_ROMEGA, t, i, j, phi_i, phi_j);                                           \
    }                                                                                              \
    void se3di_primitive_##name##_jacobian_rp(SE3DI_ON_TERM, double phi_i[7], double phi_j[7])     \
    {                                                                                              \
        either(SE3DI_WAY_RP, t, i, j, phi_i, phi_j);                                               \
    }

#define SE3DI_PRIMITIVE_GAMMAS(name, either)                                                       \
    double se3di_primitive_##name##_gamma_romega(SE3DI_ON_TERM)                                    \
    {                                                                                              \
        return either(SE3DI_WAY_ROMEGA, t, i, j);                                                  \
    }                                                                                              \
    double se3di_primitive_##name##_gamma_rp(SE3DI_ON_TERM)                                        \
    {                                                                                              \
        return either(SE3DI_WAY_RP, t, i, j);                                                      \
    }

#define SE3DI_PRIMITIVE_CURVATURES(name, either)                                                   \
    void se3di_primitive_##name##_curvature_romega(SE3DI_ON_TERM, double lambda, double H[144])    \
    {                                                                                              \
        either(SE3DI_WAY_ROMEGA, t, i, j, lambda, H);                                              \
    }                                                                                              \
    void se3di_primitive_##name##_curvature_rp(SE3DI_ON_TERM, double lambda, double H[196])        \
    {                                                                                              \
        either(SE3DI_WAY_RP, t, i, j, lambda, H);                                                  \
    }

#endif
