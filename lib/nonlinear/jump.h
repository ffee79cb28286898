/* SPDX-License-Identifier: BSD-3-Clause */
/* Prescribed values that jump (floor, mod, sign, if): no motion follows them. */
#ifndef SE3DI_JUMP_H
#define SE3DI_JUMP_H

#include "assembly/assembly.h"

typedef struct se3di_jump {
    uint32_t row;
    int32_t derivative; /* 0: the value, 1: the rate */
    double t, before, after;
} se3di_jump;

/* Look for a jump of a value between t0 and t1, in `parts` equal parts and up to the derivative
 * `highest`. Returns 1 if there is one. */
int se3di_jump_find(const se3di_assembly *assembly, const double range[2], int parts, int highest,
                    se3di_jump *jump);
/* Whether a function jumps between t0 and t1, by whole turns also. */
int se3di_jump_is_between(const se3di_function *function, double t0, double t1);
/* Refuse a value that jumps from the present time to t_end, looking every `step` (but not too
 * often): INCONSISTENT with a message. Otherwise it would tear the mechanism apart, or off its
 * branch. */
se3d_status se3di_jump_refuse(const se3di_assembly *assembly, double t_end, double step,
                              se3di_error *error);
/* "the value of drive.angle jumps from 0 to 2 at t = 0.95 s". */
void se3di_jump_format(const se3di_model *model, const se3di_jump *jump, char *text, size_t size);

/* A rate (or value) that jumps, between neighbouring times. */
typedef struct se3di_kink {
    double t, t_before;
    uint32_t row;
    int32_t derivative; /* 1: the rate jumps, 0: the value */
} se3di_kink;

/* The first such jump after `from` and not after `to`. What is found in which part of time does not
 * depend on where the search begins and ends. Returns whether there is one. Functions by callback
 * are not looked at. */
int se3di_kink_find(const se3di_assembly *assembly, double from, double to, se3di_kink *kink);

#endif
