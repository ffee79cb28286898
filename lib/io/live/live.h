/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that runs while someone looks at it: it goes on in short pieces, its numbers may be
 * changed on the way, a body may be pulled, and its file may be read again. */
#ifndef SE3D_IO_LIVE_H
#define SE3D_IO_LIVE_H

#include <stdbool.h>
#include <stdio.h>

#include "se3d/io.h"

typedef struct se3di_live se3di_live;

/* A number that may be changed while the model runs. */
typedef struct se3di_live_slider {
    const char *name;
    char unit[40];
    double value;      /* now */
    double start;      /* in the file */
    bool is_parameter; /* the model must be read again: se3di_live_read */
} se3di_live_slider;

enum { SE3DI_LIVE_MESSAGE_SIZE = 2000 };

/* What a model begins with that is read again. */
typedef enum se3di_live_beginning {
    SE3DI_LIVE_ANEW = 0,     /* all as in the file */
    SE3DI_LIVE_CHANGED = 1,  /* the same; if the files are as they were, nothing changes */
    SE3DI_LIVE_RESET = 2,    /* the numbers that were set, at the start */
    SE3DI_LIVE_GOING_ON = 3, /* the numbers that were set, where the bodies are */
} se3di_live_beginning;

/* Read a model and stand at its start. `options` must stay; its `report` and `log` are not used.
 * `interrupt` (not NULL) is asked within runs and readings whether to end them, `message` gets why
 * there is none.
 * @return NULL: `message` says why. */
se3di_live *se3di_live_create(const char *path, const se3d_model_options *options,
                              se3d_interrupt interrupt, void *ctx,
                              char message[SE3DI_LIVE_MESSAGE_SIZE]);
void se3di_live_destroy(se3di_live *live);

/* Read the file again; the interrupt is asked whether to leave it. Going on ends a pull. @return
 * false: nothing has changed, `message` says why. True with a message: the model could not go on
 * where it was and is at its start. */
bool se3di_live_read(se3di_live *live, se3di_live_beginning beginning,
                     char message[SE3DI_LIVE_MESSAGE_SIZE]);
/* How often a model has taken the place of another one. */
uint64_t se3di_live_count_readings(const se3di_live *live);
/* Numbers that were set since the model was read are forgotten, unless they act already. */
void se3di_live_take_back(se3di_live *live);
/* Paths of the files that the model was read from, NULL behind the last; one may be there twice. */
const char *se3di_live_get_file(const se3di_live *live, size_t k);

/* Whether it has an analysis in which time passes. */
bool se3di_live_has_motion(const se3di_live *live);
double se3di_live_get_time(const se3di_live *live);
/* Run to a time, or until the interrupt asks for an end. @return false: it cannot go on, `message`
 * says why; it stands where it has come to. */
bool se3di_live_run(se3di_live *live, double time, char message[SE3DI_LIVE_MESSAGE_SIZE]);

size_t se3di_live_count_sliders(const se3di_live *live);
const se3di_live_slider *se3di_live_get_slider(const se3di_live *live, size_t k);
/* Set a number: of an input at once, if time passes; of a parameter with the next se3di_live_read.
 * @return false: it is not finite, or there is none. */
bool se3di_live_set(se3di_live *live, size_t k, double value);

/* Pull body `body`, as scenes count them, at a point of it by a spring to a place in the ground
 * frame. @return false: this cannot be pulled. */
bool se3di_live_pull(se3di_live *live, size_t body, const double point[3], const double place[3]);
/* @return whether something was pulled. */
bool se3di_live_release(se3di_live *live);

/* Write its scene, glTF, as it is before anything moves. @return false: out of memory, or the file
 * says why. */
bool se3di_live_put_scene(se3di_live *live, FILE *file);
/* The places of all: of each body position and Euler parameters (7 numbers), then of each part of
 * an element between two bodies, in the order of the scene, position, Euler parameters and scale
 * (10), then how far each road whose heights are functions has risen (1). */
size_t se3di_live_count_places(const se3di_live *live);
void se3di_live_get_places(se3di_live *live, double *places);
/* Particles: as many as there are now. */
size_t se3di_live_count_particles(const se3di_live *live);
/* Centres and radii, [count][4]. @return false: out of memory. */
bool se3di_live_get_particles(const se3di_live *live, float *places);
/* The box around them at the start; infinite, low > high: there were none. @return false: the model
 * has no particles. */
bool se3di_live_get_particle_box(const se3di_live *live, double low[3], double high[3]);
/* Numbers of the channels of the first results file that has some; NaN: not known now. */
size_t se3di_live_count_columns(const se3di_live *live);
const char *se3di_live_get_column(const se3di_live *live, size_t k);
void se3di_live_get_values(se3di_live *live, double *values);

#endif
