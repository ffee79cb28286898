/* SPDX-License-Identifier: BSD-3-Clause */
/* What violations of equations are measured by. */
#ifndef SE3DI_PRIMITIVE_SCALE_H
#define SE3DI_PRIMITIVE_SCALE_H

#include "model/model.h"

/* A length of the model [m]: how far its joints are from its bodies' centres. */
double se3di_model_get_size(const se3di_model *model);
/* The constraint (dense index) that a row is of. */
uint32_t se3di_row_get_owner(const se3di_model *model, uint32_t row);
/* Type of the first term of a row; -1 if it has none (a callback's). */
int32_t se3di_row_get_type(const se3di_model *model, uint32_t row);
/* What a violation of a row is measured by: 1 for angles and cosines, `size` for lengths, its
 * square for squared lengths; and its unit with a space before it ("" for cosines). */
double se3di_row_get_scale(const se3di_model *model, uint32_t row, double size);
const char *se3di_row_get_unit(const se3di_model *model, uint32_t row);

/* How far a row without a function of time is off, relative to its scale, or to its Jacobian if it
 * is a callback's; not finite if that fails. */
double se3di_row_measure(const se3di_model *model, uint32_t row, double size);
/* A state was accepted: note the largest violation of the rows that are left out. */
void se3di_left_out_follow(se3di_model *model);

#endif
