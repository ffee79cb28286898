/* SPDX-License-Identifier: BSD-3-Clause */
/* What pages that show a scene are made of: the files of tools/viewer, and three.js. */
#ifndef SE3D_TOOL_PAGE_H
#define SE3D_TOOL_PAGE_H

#include <stdio.h>

enum { PAGE_PATH = 4096 };

typedef struct page_parts {
    char viewer[PAGE_PATH]; /* folder of the files */
    char cache[PAGE_PATH];  /* folder of three.js */
    int is_passing;         /* the cache is a folder of this page alone */
    const char *command;    /* for messages */
} page_parts;

/* Find the parts; three.js is made if it is not there. @return the exit code, after a message if it
 * failed. */
int page_begin(page_parts *p, const char *command);
void page_end(const page_parts *p);
/* Write the page to where its own data begin, and from their end on, with one more script at its
 * end (NULL: none). A page that `asks_nobody` may load nothing, whatever its data say. @return
 * false after a message. */
int page_put_begin(FILE *file, const page_parts *p, int asks_nobody);
int page_put_end(FILE *file, const page_parts *p, const char *script);
/* Write another file of tools/viewer. */
int page_put_part(FILE *file, const page_parts *p, const char *name);
/* A file with a zero behind it; NULL: it cannot be read. Free it. */
char *page_read_whole(const char *path, size_t *size);

#endif
