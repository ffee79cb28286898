/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts of names and messages. */
#ifndef SE3DI_BASE_TEXT_H
#define SE3DI_BASE_TEXT_H

#include "se3d/base.h"

/* True if all of it are characters of se3d_text_get_character. */
int se3di_text_is_plain(const char *text);
/* Replace what is not such a character by '?', byte by byte. */
void se3di_text_make_plain(char *text);

#endif
