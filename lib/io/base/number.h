/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as text that every reader of them reads alike. */
#ifndef SE3D_IO_NUMBER_H
#define SE3D_IO_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

enum { SE3DI_NUMBER_SIZE = 40 };

/* Write a number as "%.17g" with a point in every locale; `text` has SE3DI_NUMBER_SIZE bytes.
 * printf alone takes the decimal point of the host program. @return its length. */
size_t se3di_number_format(double value, char *text);

/* Read a decimal number, with a point in every locale. @return false: `text` is none, or it is not
 * finite. */
bool se3di_number_parse(const char *text, double *value);

#endif
