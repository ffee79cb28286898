/* SPDX-License-Identifier: BSD-3-Clause */
#include "contact/narrow/bracket.h"

#include <math.h>

#define EXACT 1e-15 /* of the first bracket */
#define LOOKS 200

int se3di_bracket_look(se3di_bracket *b)
{
    const double before = b->next;
    const double secant =
        b->low + (b->high - b->low) * (b->slope_low / (b->slope_low - b->slope_high));
    const int slow = b->count % 3 == 2 && b->high - b->low > 0.25 * b->width;
    if (b->count == 0) {
        b->exact = EXACT * (b->high - b->low);
    }
    if (b->count % 3 == 2) {
        b->width = b->high - b->low;
    }
    b->next = slow || !(secant > b->low && secant < b->high) ? 0.5 * (b->low + b->high) : secant;
    ++b->count;
    return b->count <= LOOKS && (b->count < 2 || fabs(b->next - before) > b->exact);
}

int se3di_bracket_take(se3di_bracket *b, double slope)
{
    if (!(b->low < b->next && b->next < b->high) || !(fabs(slope) > 0.0)) {
        return 0;
    }
    if (slope < 0.0) {
        b->slope_high *= b->last < 0 ? 0.5 : 1.0;
        b->low = b->next;
        b->slope_low = slope;
        b->last = -1;
    } else {
        b->slope_low *= b->last > 0 ? 0.5 : 1.0;
        b->high = b->next;
        b->slope_high = slope;
        b->last = 1;
    }
    return 1;
}
