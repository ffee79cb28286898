/* SPDX-License-Identifier: BSD-3-Clause */
/* Declares the functions of all primitives. */
#ifndef SE3DI_PRIMITIVE_TABLE_H
#define SE3DI_PRIMITIVE_TABLE_H

#include "primitive/primitive.h"

#define SE3DI_PRIMITIVE_DECLARE(TYPE, name)                                                        \
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

SE3DI_PRIMITIVE_LIST(SE3DI_PRIMITIVE_DECLARE)

#undef SE3DI_PRIMITIVE_DECLARE

#endif
