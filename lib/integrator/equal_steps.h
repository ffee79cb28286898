/* SPDX-License-Identifier: BSD-3-Clause */
/* The length of the equal steps of rattle and verlet where nobody has given one. It is chosen once,
 * by trial steps ahead from the state that the run begins with, and is part of the history: clones
 * and snapshots go on with it. The error of a step is that of velocities in a unit of time in which
 * they change by themselves, relative to the largest ones, by the change of accelerations a over
 * the step,
 *
 *     order 2   e = h |a_1 - a_0| / (12 |v|)        order 4   e = 5 e_2^2
 *
 * and aims at the tolerance. What was chosen is watched: where a part of the motion has much
 * more, and not only a place in it, steps become half as long from there on, and the log says so.
 * Steps that contacts or stops shorten, and accelerations that jump, say nothing of it: a step in
 * which they do is made in parts instead (lie_verlet.h).
 * docs/theory/rattle.md */
#ifndef SE3DI_EQUAL_STEPS_H
#define SE3DI_EQUAL_STEPS_H

#include "se3d/base.h"

/* At the beginning of the history of methods with `chooses_step`. */
enum {
    SE3DI_EQUAL_STEP,  /* in use [s]; 0: none was chosen */
    SE3DI_EQUAL_FIRST, /* the one that was chosen [s] */
    SE3DI_EQUAL_SPEED, /* the largest so far [m/s], */
    SE3DI_EQUAL_SPIN,  /* [rad/s] */
    SE3DI_EQUAL_OVER,  /* steps of late with too large an error; below 0: with a very small one */
    SE3DI_EQUAL_TOLD,  /* as much was told of, over the tolerance */
    SE3DI_EQUAL_HEADER
};

struct se3di_integration;
struct se3di_model;

/* Nobody has given a step, neither of the method nor of contacts; nor do particles choose it. */
int se3di_equal_steps_are_chosen(const struct se3di_integration *integration);
/* The smallest tolerance that chosen steps meet: below it they would be so many that their rounding
 * adds up to more. 0: none are chosen. */
double se3di_equal_steps_reach(const struct se3di_integration *integration,
                               const struct se3di_model *model);
/* Choose the step of a run to t_end, if that is to be done: the model, its history and memories
 * are as they were but for the choice. @return OK, NO_MEMORY, INTERRUPTED */
se3d_status se3di_equal_steps_choose(struct se3di_integration *integration, double t_end);
/* The next of equal steps of at most `most` to t_end, or shorter if contacts or stops want it
 * to be (settings.step is not given). */
double se3di_equal_steps_next(struct se3di_integration *integration, double most, double t_end);
/* After such a step of h, whose start is in equations->kept. */
void se3di_equal_steps_watch(struct se3di_integration *integration, double h);
/* What such a step of h, whose start is in equations->kept, changes accelerations by, times h,
 * relative to the tolerance. A smooth one has no more than *most; nor has one in which friction
 * changes if it is short enough for that. */
double se3di_equal_steps_review(const struct se3di_integration *integration, double h,
                                double *most);
/* The length of equal steps as given, of verlet also by contacts or particles [s]; 0: it is not.
 * If bodies move, particles alone ask for no more than 0.001 s. */
double se3di_equal_steps_given(const struct se3di_integration *integration,
                               const struct se3di_model *model);
/* The length of equal steps of a run on the model, given or chosen [s]; 0: none is chosen yet, or
 * the method adapts it. */
double se3di_equal_steps_get(const struct se3di_integration *integration,
                             const struct se3di_model *model);

#endif
