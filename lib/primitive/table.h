/* SPDX-License-Identifier: BSD-3-Clause */
/* Declares the functions that every primitive has; primitive.c lists them in the table. */
#ifndef SE3DI_PRIMITIVE_TABLE_H
#define SE3DI_PRIMITIVE_TABLE_H

#include "primitive/primitive.h"

#define SE3DI_PRIMITIVE_DECLARE(name)                                                              \
    double se3di_primitive_##name##_value(const se3di_term *t, const se3di_frame *i,               \
                                          const se3di_frame *j);                                   \
    void se3di_primitive_##name##_jacobian_romega(const se3di_term *t, const se3di_frame *i,       \
                                                  const se3di_frame *j, double phi_i[6],           \
                                                  double phi_j[6]);                                \
    void se3di_primitive_##name##_jacobian_rp(const se3di_term *t, const se3di_frame *i,           \
                                              const se3di_frame *j, double phi_i[7],               \
                                              double phi_j[7]);                                    \
    double se3di_primitive_##name##_gamma_romega(const se3di_term *t, const se3di_frame *i,        \
                                                 const se3di_frame *j);                            \
    double se3di_primitive_##name##_gamma_rp(const se3di_term *t, const se3di_frame *i,            \
                                             const se3di_frame *j);                                \
    void se3di_primitive_##name##_curvature_romega(const se3di_term *t, const se3di_frame *i,      \
                                                   const se3di_frame *j, double lambda,            \
                                                   double H[144]);                                 \
    void se3di_primitive_##name##_curvature_rp(const se3di_term *t, const se3di_frame *i,          \
                                               const se3di_frame *j, double lambda,                \
                                               double H[196]);

SE3DI_PRIMITIVE_DECLARE(dp1)
SE3DI_PRIMITIVE_DECLARE(dp2)
SE3DI_PRIMITIVE_DECLARE(d)
SE3DI_PRIMITIVE_DECLARE(cd)
SE3DI_PRIMITIVE_DECLARE(angle)
SE3DI_PRIMITIVE_DECLARE(triple)

#undef SE3DI_PRIMITIVE_DECLARE

#endif
