/* SPDX-License-Identifier: BSD-3-Clause */
/* Many bodies at each other, where following each contact takes long. */
#ifndef SE3DI_CONTACT_CROWD_H
#define SE3DI_CONTACT_CROWD_H

#include "model/model.h"

#define SE3DI_CROWD      10 /* free bodies */
#define SE3DI_CROWD_HELD 3  /* if following contacts holds steps short, but on a mesh */

/* What a method is left for. */
enum {
    SE3DI_CROWD_NONE = 0,
    SE3DI_CROWD_NEAR = 1,  /* as soon as SE3DI_CROWD free bodies are at each other, or as SLOW */
    SE3DI_CROWD_SLOW = 2,  /* when contacts, of SE3DI_CROWD_HELD or more, make it slow */
    SE3DI_CROWD_ROUGH = 3, /* the same on a mesh: as soon as contacts that come and go do */
    SE3DI_CROWD_DENSE = 4  /* as NEAR, but not as SLOW */
};

/* So many free bodies touch something, or are a small part of their size from doing so while bounds
 * overlap: those of balls do only if they touch. */
int se3di_bodies_crowd(const se3di_model *model);
size_t se3di_bodies_free(const se3di_model *model);
/* The free bodies that touch something at the accepted state, but for balls that touch balls, up to
 * 64. */
size_t se3di_bodies_touching(const se3di_model *model);
/* Anything touches at the accepted state; balls that touch balls do not count, as they may pass
 * impacts on to each other (Newton's cradle). */
int se3di_bodies_touch(const se3di_model *model);
/* What a step at the accepted state takes, roughly, over one in which no bounds of two meshes
 * overlap. */
double se3di_bodies_work(const se3di_model *model);

#endif
