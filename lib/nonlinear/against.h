/* SPDX-License-Identifier: BSD-3-Clause */
/* Which equations contradict each other: two drivers of one coordinate, a driver of what a joint
 * locks. docs/theory/redundancy.md */
#ifndef SE3DI_AGAINST_H
#define SE3DI_AGAINST_H

#include "nonlinear/equations.h"

/* " with b.angle, a.cd_x" and who drives what: the rows that a row cannot be met with; "" if that
 * is not to be seen. gap [rows]: what all are off by at their least violation. */
void se3di_against_describe(const se3di_model *model, const double *gap, uint32_t row, char *text,
                            size_t size);

/* Whether a row is that of a driver whose coordinate another one drives, too. */
int se3di_against_is_twice(const se3di_model *model, uint32_t row);

/* Whether two drivers of one coordinate are there, as long as the structure does not change. */
int se3di_against_can_be(const se3di_model *model);

/* Fails with INCONSISTENT if two drivers of one coordinate, of the time alone, part on the way from
 * the present time to t_end. */
se3d_status se3di_against_refuse(const se3di_assembly *assembly, double t_end, se3di_error *error);

/* The same of velocities that could not be made to follow the rates of drivers, at t; of what they
 * are off by, in equations->c: the largest, relative to the scales of the rows times `rate`. */
se3d_status se3di_against_check_rates(se3di_equations *equations, double t, double gap, double rate,
                                      double length);

#endif
