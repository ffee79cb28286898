/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of a constraint under construction, one primitive each. Term points are the joint points of
 * the draft's frames; body i and body j are its first two bodies. */
#ifndef SE3DI_JOINT_ROWS_H
#define SE3DI_JOINT_ROWS_H

#include "model/model.h"

/* Begin a draft between two bodies: no rows, no angle, refers to no joints and no functions. The
 * name (NULL: none) stays the caller's. */
void se3di_draft_init(se3di_draft *draft, const char *type, const char *name, uint32_t body_i,
                      uint32_t body_j);

/* Add an equation `sum of its terms = value`; names are static. */
se3di_row *se3di_draft_add_row(se3di_draft *draft, const char *name, double value);
/* Add a copy of `term` to the last equation. */
void se3di_draft_add_term(se3di_draft *draft, const se3di_term *term, double coefficient);

/* a_i . a_j = 0 */
void se3di_row_add_dp1(se3di_draft *draft, const char *name, const double a_i[3],
                       const double a_j[3]);
/* a_i . d = 0 */
void se3di_row_add_dp2(se3di_draft *draft, const char *name, const double a_i[3]);
/* d . (a_i x a_j) = 0 */
void se3di_row_add_triple(se3di_draft *draft, const char *name, const double a_i[3],
                          const double a_j[3]);
/* d . d = distance^2 */
void se3di_row_add_d(se3di_draft *draft, double distance);

/* cd_x, cd_y, cd_z: the joint points coincide. */
void se3di_row_add_spherical(se3di_draft *draft);
/* dp1_a, dp1_b: axis_j is perpendicular to ref_i and third_i, that is parallel to axis_i. */
void se3di_row_add_perpendicular1(se3di_draft *draft);
/* dp2_a, dp2_b: d is perpendicular to ref_i and third_i: P_j is on the line through P_i along
 * axis_i. */
void se3di_row_add_perpendicular2(se3di_draft *draft);
/* dp1_a, dp1_b, dp1_c: the two triads coincide. */
void se3di_row_add_orientation(se3di_draft *draft);

/* The term axis_i . d (displacement of a joint). */
void se3di_displacement_term_init(se3di_term *term, const se3di_joint_frames *frames,
                                  const uint32_t bodies[2]);

#endif
