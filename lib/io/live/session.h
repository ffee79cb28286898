/* SPDX-License-Identifier: BSD-3-Clause */
/* A model that was read and brought to where it begins, with all that it is shown with. */
#ifndef SE3D_IO_SESSION_H
#define SE3D_IO_SESSION_H

#include "io/channel/channel.h"
#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/fmi/variables.h"
#include "io/live/live.h"
#include "io/write/drawing.h"

typedef struct se3di_session {
    se3di_iopool pool;
    se3d_model *model;
    se3d_solver *solver; /* NULL: no time passes */
    se3d_solver_stats stats;
    se3di_sample sample; /* answers at the present state */
    se3di_fmi_variables variables;
    se3di_live_slider *sliders;
    size_t *slider_variables; /* [slider_count] places in the list of variables */
    bool *is_set;             /* [slider_count] by the user */
    double *held;             /* [slider_count] what the model was made with, or has been set to, */
    bool *held_is_set;        /* [slider_count] and whether the user had set it */
    size_t slider_count;
    const se3di_output_entry *output; /* whose channels are shown; NULL: none */
    const char **columns;
    size_t column_count;
    bool is_prepared;  /* the sample and the variables are there */
    bool shows_all;    /* some channel needs accelerations or multipliers */
    se3di_poses start; /* one sample */
    double start_time; /* of it */
    se3di_sizes sizes;
    size_t between_count;
    se3di_rise *rises; /* of roads */
    size_t rise_count;
    size_t analysis;           /* that runs */
    double particle_box[2][3]; /* around the particles at the start; empty: low > high */
    double *poses;             /* of the present state */
} se3di_session;

/* What sessions are made of. */
typedef struct se3di_session_source {
    const char *path;
    const se3d_model_options *options;
    se3d_interrupt interrupt; /* of runs */
    void *ctx;
} se3di_session_source;

/* Make a session to take the place of `now` (NULL: the first). @return `now` if it is to stay;
 * NULL: `message` says why there is none. */
se3di_session *se3di_session_make(const se3di_session_source *from, se3di_session *now,
                                  se3di_live_beginning beginning, char *message);
/* Radii, [n], centres, [n][3], and velocities, [2 n][3], of all particles. @return false: out of
 * memory */
bool se3di_session_get_particles(const se3di_session *s, double *numbers);
void se3di_session_destroy(se3di_session *s);
/* The state of the system has changed: channels are asked anew. */
void se3di_session_renew(se3di_session *s);
/* "WHAT: why", with the message of the system if it has one. @return false */
bool se3di_session_say(char *message, const se3di_session *s, const char *what, se3d_status status);

#endif
