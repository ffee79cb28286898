/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run does silently and its user should know. */
#ifndef SE3D_TOOL_NOTES_H
#define SE3D_TOOL_NOTES_H

#include "se3d/io.h"

enum { NOTES_MAX = 8, NOTE_SIZE = 700 };

typedef struct notes {
    size_t count;
    char text[NOTES_MAX][NOTE_SIZE];
} notes;

/* After a run, at the state that it has come to. */
void notes_collect(notes *n, se3d_model *model, const se3d_run *run);

#endif
