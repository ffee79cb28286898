/* SPDX-License-Identifier: BSD-3-Clause */
/* The texts of the reference, which are Markdown, for readers of a terminal. */
#ifndef SE3D_TOOL_PLAIN_H
#define SE3D_TOOL_PLAIN_H

#include <stddef.h>

/* Copy a text without the addresses of its links: "[text](place)" becomes "text". */
void plain_copy(const char *text, char *out, size_t size);

#endif
