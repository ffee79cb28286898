/* SPDX-License-Identifier: BSD-3-Clause */
/* Programs that run beside this one and are spoken to through pipes. */
#ifndef SE3D_TOOL_CHILD_H
#define SE3D_TOOL_CHILD_H

#include <stddef.h>

typedef struct child {
    long id; /* 0: not running */
    int to;  /* what we write, it reads; -1: none */
    int from;
} child;

/* Start a program, with the ends of two pipes as its descriptors `reads` and `writes` (-1: no such
 * pipe). `mute`: what it prints is dropped. @return false: errno says why. */
int child_start(child *c, const char *const *words, int reads, int writes, int mute);
/* Write all of it. @return false: the program is gone. */
int child_write(child *c, const void *data, size_t size);
/* Read what there is, waiting for at most so many seconds. @return bytes; 0 at the end, after that
 * time, or after an interrupt. */
size_t child_read(child *c, void *data, size_t size, int seconds);
/* Close the pipes and wait for the end, at most so many seconds; then end it and all it started.
 * @return its exit code, -1 if it did not end by itself. */
int child_finish(child *c, int seconds);

void child_pause(int milliseconds);

/* Make a fresh folder for temporary files. @return false: errno says why. */
int folder_make_temporary(char *path, size_t size);
/* Remove a folder with all that is in it; what others still write there is waited for. */
void folder_remove(const char *path);

#endif
