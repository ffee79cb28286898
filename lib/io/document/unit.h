/* SPDX-License-Identifier: BSD-3-Clause */
/* Units and dimensions of the numbers in a model file. */
#ifndef SE3D_IO_UNIT_H
#define SE3D_IO_UNIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Exponents; an angle counts as one, so that it is told from a number. */
typedef struct se3di_dimension {
    int8_t length, mass, time, angle;
} se3di_dimension;

/* In SI units a value is value * times / over: 30 mm are 30 / 1000, rounded once. */
typedef struct se3di_measure {
    se3di_dimension dimension;
    double times, over;
} se3di_measure;

/* What numbers without a unit are in: those of a file. */
typedef struct se3di_units {
    se3di_measure length, mass, time, angle, force;
    bool are_si;
} se3di_units;

se3di_units se3di_units_si(void);
/* The unit of a dimension in these units: a force and what is made of it in that of the force. */
se3di_measure se3di_units_of(const se3di_units *units, se3di_dimension dimension);

/* The unit that the text begins with, "kN/m" or "kg*m^2"; with `blanks` also "N m/rad". @return
 * its length, 0 if it is none or beyond what is allowed. */
size_t se3di_unit_parse(const char *text, bool blanks, se3di_measure *unit);
/* The k-th word for a unit, NULL behind the last. */
const char *se3di_unit_word(size_t k);

bool se3di_dimension_is_none(se3di_dimension d);
/* The same but for the angle, which counts only between angles and numbers. */
bool se3di_dimension_fits(se3di_dimension a, se3di_dimension b);
/* Each exponent of a plus `factor` times that of b. @return false: beyond what is allowed. */
bool se3di_dimension_add(se3di_dimension a, se3di_dimension b, int factor, se3di_dimension *sum);
/* Write "a length [m]". */
void se3di_dimension_describe(se3di_dimension d, char *text, size_t size);

#endif
