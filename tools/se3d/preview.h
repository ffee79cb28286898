/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run of a model's particles will take, from its first steps. */
#ifndef SE3D_TOOL_PREVIEW_H
#define SE3D_TOOL_PREVIEW_H

#include <se3d/io.h>
#include <se3d/particles.h>

#include "soft.h"

/* One set of particles. */
typedef struct preview {
    const char *name; /* "" without one */
    uint64_t count, clumps, bytes;
    double radius_min, radius_max; /* [m] */
    double step;                   /* [s]; 0: not known yet, as nothing is there */
    double automatic;              /* the step that it would choose [s] */
    soft held;                     /* how fast they may hit; infinite: not known */
} preview;

/* The first dynamics analysis of the model. */
typedef struct preview_pace {
    int is_known;   /* 0: there is none, nothing moved, or it fails: `message` */
    double step;    /* of the first steps [s] */
    double steps;   /* to the end of all dynamics */
    double seconds; /* that they take at the pace of the first ones, by the clock */
    char message[600];
} preview_pace;

/* Look at a set of the model. @return 0 if the set cannot be read */
int preview_look(const se3d_model *model, size_t index, preview *out);

/* Run the first steps of the model, whose state is of no use then, for a fraction of a second. */
void preview_try(const se3d_model *model, preview_pace *out);

#endif
