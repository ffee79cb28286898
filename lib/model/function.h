/* SPDX-License-Identifier: BSD-3-Clause */
/* What the model needs of its functions besides their value. */
#ifndef SE3DI_MODEL_FUNCTION_H
#define SE3DI_MODEL_FUNCTION_H

#include "model/model.h"

/* Give back what the function owns. */
void se3di_function_release(const se3d_allocator *allocator, se3di_function *function);

/* `function` is a bitwise copy of another: replace what it points to by its own copies. On failure
 * it owns nothing. */
se3d_status se3di_function_own(const se3d_allocator *allocator, se3di_function *function);

#endif
