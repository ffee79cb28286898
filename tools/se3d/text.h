/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts from files and command lines as other languages may hold them. Whatever the text is, the
 * reader of that language sees one string and nothing else. */
#ifndef SE3D_TOOL_TEXT_H
#define SE3D_TOOL_TEXT_H

#include <stdio.h>

/* True if all are characters of se3d_text_get_character. */
int text_is_plain(const char *text);
/* Replace what may not be shown by '?', in place. */
void text_clean(char *text);

/* What can be shown of a text, on a terminal. */
void text_put_plain(FILE *file, const char *text);
/* A string of JSON with its quotes, valid UTF-8 whatever the bytes are. */
void text_put_json(FILE *file, const char *text);
/* The same for a script element of a page: nothing in it can end the element. */
void text_put_script(FILE *file, const char *text);
/* A string of gnuplot with its quotes: single ones, in which nothing is replaced or run. */
void text_put_gnuplot(FILE *file, const char *text);

#endif
