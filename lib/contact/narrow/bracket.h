/* SPDX-License-Identifier: BSD-3-Clause */
/* The place where a slope is zero, between one where it is negative and one where it is positive:
 * by secants that keep both (the Illinois rule), by halves if these do not close in (a slope that
 * jumps). */
#ifndef SE3DI_CONTACT_NARROW_BRACKET_H
#define SE3DI_CONTACT_NARROW_BRACKET_H

typedef struct se3di_bracket {
    double low, high, slope_low, slope_high;
    double next, width; /* where to look; what was left two looks ago */
    double exact;       /* a step so small is none */
    int count, last;    /* -1: the lower end moved last, 1: the upper */
} se3di_bracket;

/* Returns 0 if there is no other place to look at, or it was looked at often enough. */
int se3di_bracket_look(se3di_bracket *b);
/* Take the slope at `next`; returns 0 if there is nothing between the ends, or it is the place. */
int se3di_bracket_take(se3di_bracket *b, double slope);

#endif
