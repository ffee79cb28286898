/* SPDX-License-Identifier: BSD-3-Clause */
/* What the model needs of its functions besides their value. */
#ifndef SE3DI_MODEL_FUNCTION_H
#define SE3DI_MODEL_FUNCTION_H

#include "model/model.h"
#include "model/spline.h"

/* Give back what the function owns. */
void se3di_function_release(const se3d_allocator *allocator, se3di_function *function);

/* `function` is a bitwise copy of another: replace what it points to by its own copies. On failure
 * it owns nothing. */
se3d_status se3di_function_own(const se3d_allocator *allocator, se3di_function *function);

/* The table of a function that has one. */
static inline se3di_spline se3di_function_table(const se3di_function *function)
{
    const size_t n = function->table_count;
    return (se3di_spline){.x = function->table,
                          .y = function->table + n,
                          .m = function->table + 2 * n,
                          .n = n,
                          .kind = function->table_kind,
                          .periodic = function->table_periodic};
}

#endif
