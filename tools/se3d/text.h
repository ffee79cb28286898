/* SPDX-License-Identifier: BSD-3-Clause */
/* Texts from files and command lines as other languages may hold them. Whatever the text is, the
 * reader of that language sees one string and nothing else. */
#ifndef SE3D_TOOL_TEXT_H
#define SE3D_TOOL_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* Bytes of the character at `text`, 0 where it is none that may be shown: bytes that are not UTF-8,
 * control characters, ends of lines and paragraphs, marks that change the direction of writing. */
size_t text_get_length(const char *text);
/* True where all characters may be shown. */
int text_is_plain(const char *text);
/* Replace what may not be shown by '?', in place. */
void text_clean(char *text);

/* A string of JSON with its quotes, valid UTF-8 whatever the bytes are. */
void text_put_json(FILE *file, const char *text);
/* The same for a script element of a page: nothing in it can end the element. */
void text_put_script(FILE *file, const char *text);
/* A string of gnuplot with its quotes: single ones, in which nothing is replaced or run. */
void text_put_gnuplot(FILE *file, const char *text);

#endif
