/* SPDX-License-Identifier: BSD-3-Clause */
/* What the page of `se3d live` is told, as JSON. All are NULL if there is no memory; free them. */
#ifndef SE3D_TOOL_LIVE_TEXT_H
#define SE3D_TOOL_LIVE_TEXT_H

#include <stdint.h>
#include <stdio.h>

#include "io/live/live.h"

typedef struct live_status {
    uint64_t version, sequence; /* of the scene, of the state */
    uint64_t list;              /* version of the names of the sliders */
    int running;
    double speed;                               /* 0: as fast as it goes */
    char file_trouble[SE3DI_LIVE_MESSAGE_SIZE]; /* why the file is not the model that is shown */
    char run_trouble[SE3DI_LIVE_MESSAGE_SIZE];  /* what has happened to that */
} live_status;

/* The places and numbers of now. */
char *live_text_of_state(se3di_live *model, const live_status *s, size_t *size);
/* The names of the sliders. */
char *live_text_of_sliders(const se3di_live *model);
/* What the page draws; the beginning with its version is left to the caller. */
char *live_text_of_scene(se3di_live *model);
/* Close what open_memstream gave, and take its `data`. */
char *live_text_take(FILE *file, char **data);

#endif
