/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether bodies that touch limit the steps of a method, or will as many of them do: what
 * `auto` leaves it for. */
#ifndef SE3DI_CROWD_WATCH_H
#define SE3DI_CROWD_WATCH_H

#include "model/model.h"

/* Kept in the history of a method. */
typedef struct se3di_crowd_watch {
    double counted; /* steps, */
    double since;   /* from this time on [s] */
    double tiny;    /* steps in a row that were much too short */
} se3di_crowd_watch;

/* What steps are short. */
typedef struct se3di_crowd_pace {
    double steps;      /* in a row, of SE3DI_CROWD bodies, */
    double brief;      /* on the average, of any model, */
    double brief_each; /* or for each of its many bodies [s], */
    double brief_most; /* but no longer than this [s] */
} se3di_crowd_pace;

/* After an accepted step, step[0] to step[1]. Returns 1 if the method is to be left for `crowd`, a
 * reason SE3DI_CROWD_. */
int se3di_crowd_watch_step(se3di_crowd_watch *watch, const se3di_model *model, int32_t crowd,
                           const double step[2], const se3di_crowd_pace *pace);

#endif
