/* SPDX-License-Identifier: BSD-3-Clause */
/* Characters of texts that come from files: UTF-8 by RFC 3629. */
#ifndef SE3D_IO_TEXT_H
#define SE3D_IO_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The code of the character at `text`. @return its bytes, 0 where they are not UTF-8. */
size_t se3di_text_decode(const char *text, uint32_t *code);
/* True for a character that may be shown: no control character, no end of a line or paragraph, no
 * mark that changes the direction of writing, no code that is no character. */
bool se3di_text_is_shown(uint32_t code);
/* True where the whole text is UTF-8 and may be shown. */
bool se3di_text_is_plain(const char *text);

#endif
