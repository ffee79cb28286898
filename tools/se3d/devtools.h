/* SPDX-License-Identifier: BSD-3-Clause */
/* A page in headless Chromium, driven by its DevTools protocol over a pipe: JSON messages that end
 * with a zero byte, on its descriptors 3 (from us) and 4 (to us). */
#ifndef SE3D_TOOL_DEVTOOLS_H
#define SE3D_TOOL_DEVTOOLS_H

#include "child.h"

typedef struct devtools {
    child chromium;
    char *buffer; /* what was read: a message, then the beginning of the next ones */
    size_t used;
    size_t capacity;
    size_t message; /* length of the message at its head, with the zero; 0: none */
    unsigned number;
    char session[80];
} devtools;

/* The name of Chromium on this system: $SE3D_CHROMIUM or the first that is found; NULL: none. */
const char *devtools_find_chromium(void);

/* Start Chromium with a profile in `folder` and open a file (an absolute path). */
int devtools_open(devtools *d, const char *program, const char *folder, const char *page);
/* The value of a JavaScript expression that yields a text without quotes; it must not contain
 * quotes (") or backslashes itself. @return the text, yours to change until the next call; NULL: it
 * failed. */
char *devtools_evaluate(devtools *d, const char *expression);
void devtools_close(devtools *d);

#endif
