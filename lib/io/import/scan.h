/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers and words in texts of other formats, the same in every locale. */
#ifndef SE3D_IO_IMPORT_SCAN_H
#define SE3D_IO_IMPORT_SCAN_H

#include <stdbool.h>
#include <stddef.h>

#define SE3DI_SCAN_LARGEST 1e40 /* of a number in a model file */

/* Read a decimal number at the start of `text`; D for the exponent is fine if `fortran`.
 * @return its length, 0: there is none, or it is not finite or beyond 1e40. */
size_t se3di_scan_number(const char *text, bool fortran, double *value);
/* Read numbers separated by blanks. @return how many there are, -1: something else is there. */
int se3di_scan_numbers(const char *text, double *values, int room);
/* Compare without regard to case. */
bool se3di_scan_equal(const char *a, const char *b);
/* The same for the first `length` characters of a, which are all of b. */
bool se3di_scan_equal_part(const char *a, size_t length, const char *b);
/* Whether `text` begins with `part`, without regard to case. */
bool se3di_scan_begins(const char *text, const char *part);
/* Whether the text begins with a number and has no letters but those of exponents and degrees. */
bool se3di_scan_numeric(const char *text);

#endif
