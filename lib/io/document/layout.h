/* SPDX-License-Identifier: BSD-3-Clause */
/* The layout of a model file: indentation, spaces and empty lines in one way, and nothing else. */
#ifndef SE3D_IO_LAYOUT_H
#define SE3D_IO_LAYOUT_H

#include "io/document/document.h"

/* Lay a text out anew: lines stay lines, in their order, with their comments and the characters of
 * their values. A text whose values would become others (one with keys after `?`, say) stays as it
 * is. What was laid out stays as it is, too.
 * @param[out] out  in the pool, ends with 0
 * @return OK, MODEL, NO_MEMORY, with `error` filled. */
se3d_status se3di_layout_make(se3di_iopool *pool, const char *file, const char *text, size_t length,
                              char **out, size_t *out_length, se3d_model_error *error);

#endif
