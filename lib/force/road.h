/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads under tyres: how high they are, and the plane that a wheel finds below itself.
 * docs/theory/road.md */
#ifndef SE3DI_FORCE_ROAD_H
#define SE3DI_FORCE_ROAD_H

#include "math/dual.h"
#include "model/model.h"

/* A road over a point of its frame. */
typedef struct se3di_road_height {
    double h;       /* [m] */
    double x, y, t; /* dh/dx, dh/dy [1], dh/dt [m/s] */
    double xx, xy, yy, xt, yt;
} se3di_road_height;

/* `wants_curvature` 0: without second derivatives. @return OK, NOT_FINITE, CALLBACK */
se3d_status se3di_road_eval(const se3di_model *model, const se3di_road *road, const double at[3],
                            int wants_curvature, se3di_road_height *height);
/* Of a grid or a mesh; at: t, x, y. */
void se3di_road_eval_surface(const se3di_road *road, const double at[3], se3di_road_height *height);

/* What a plane depends on: numbers of duals. */
enum {
    SE3DI_ROAD_CENTER = 0, /* of the wheel, frame of the road, */
    SE3DI_ROAD_AXIS = 3,   /* its axis there, */
    SE3DI_ROAD_TIME = 6
};

typedef struct se3di_road_wheel {
    double center[3], axis[3]; /* frame of the road, the axis to the left */
    double time, radius;
    double length, width; /* of what it rolls over obstacles with; length 0: it touches a point */
} se3di_road_wheel;

/* What stands for the road below a wheel, frame of the road. */
typedef struct se3di_road_plane {
    se3di_dual point[3], normal[3];
    se3di_dual rise; /* velocity of the road, up */
} se3di_road_plane;

/* The wheel does not lie on its side. @return as se3di_road_eval */
se3d_status se3di_road_find_plane(const se3di_model *model, const se3di_road *road,
                                  const se3di_road_wheel *wheel, se3di_road_plane *plane);

#endif
