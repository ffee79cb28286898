/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/crowd_watch.h"

#include "contact/bodies/crowd.h"

#include <math.h>

#define TINY   2e-6 /* s, a step that no touch of its own needs: contacts come and go */
#define TINIES 20.0 /* such steps in a row tell, and need not wait for the others */
#define LEAST  12.0 /* steps of which an average says something, however much work they are */

/* The last steps were short, or on a mesh the last TINIES tiny, and something touches at their end.
 * If bodies are many, or two meshes at each other, a step is the work of many, and fewer are waited
 * for; meshes may hold steps short before they touch. What is short grows with the bodies that
 * touch, or, of free bodies alone, with all of them: each has its share of each step. */
static int is_slow(se3di_crowd_watch *watch, const se3di_model *model, int32_t crowd,
                   const double step[2], const se3di_crowd_pace *pace)
{
    const double t = step[1], all = (double)se3di_bodies_free(model);
    watch->counted += 1.0;
    watch->tiny = t - step[0] < TINY ? watch->tiny + 1.0 : 0.0;
    const double work = crowd == SE3DI_CROWD_SLOW ? 1.0 : se3di_bodies_work(model);
    if (watch->counted < fmax(LEAST, pace->steps / (work * fmax(1.0, all / SE3DI_CROWD)))) {
        return crowd == SE3DI_CROWD_ROUGH && watch->tiny >= TINIES && se3di_bodies_touch(model);
    }
    const double least = work > 1.0 ? 1.0 : 0.0;
    const double touching = fmax(least, (double)se3di_bodies_touching(model));
    const double each = pace->brief_each * (crowd == SE3DI_CROWD_NEAR ? all : touching);
    const double brief = touching > 0.0 ? fmax(pace->brief, fmin(pace->brief_most, each)) : 0.0;
    const int is_slow = t - watch->since < brief * watch->counted;
    watch->counted = 0.0;
    watch->since = t;
    return is_slow;
}

int se3di_crowd_watch_step(se3di_crowd_watch *watch, const se3di_model *model, int32_t crowd,
                           const double step[2], const se3di_crowd_pace *pace)
{
    const int is_dense =
        (crowd == SE3DI_CROWD_NEAR || crowd == SE3DI_CROWD_DENSE) && se3di_bodies_crowd(model);
    const int may_be_slow = crowd != SE3DI_CROWD_NONE && crowd != SE3DI_CROWD_DENSE;
    return is_dense || (may_be_slow && is_slow(watch, model, crowd, step, pace));
}
