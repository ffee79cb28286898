/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions that a suspension can do with its chassis at rest: velocities in the null space of the
 * constraints but those that are let go, and the accelerations along them,
 *
 *     Phi_q qdot = 0,  g_k . qdot = rate_k       Phi_q qddot = gamma(qdot) - f_tt,  d2 g_k = 0
 *
 * with prescribed coordinates k. Of several the shortest is taken (rotations times the wheel's
 * radius): what nothing moves stays. Only the bodies that joints connect with the wheel's, not
 * beyond the chassis and fixed bodies, take part. docs/theory/wheel.md */
#ifndef SE3DI_WHEEL_MOTION_H
#define SE3DI_WHEEL_MOTION_H

#include "linsol/rank.h"
#include "model/model.h"

enum { SE3DI_WHEEL_COORDINATES = 2 };

/* A coordinate that is prescribed. */
typedef enum se3di_wheel_coordinate {
    SE3DI_WHEEL_TRAVEL, /* of the wheel centre along the vehicle's up */
    SE3DI_WHEEL_TURN,   /* of the body about the vehicle's up */
    SE3DI_WHEEL_LENGTH  /* of the spring */
} se3di_wheel_coordinate;

typedef struct se3di_wheel_prescription {
    const se3di_wheel *wheel;
    se3di_wheel_coordinate coordinate;
    double rate;
} se3di_wheel_prescription;

typedef struct se3di_wheel_motion {
    const se3di_model *model;
    const se3di_wheel *wheel;
    int32_t released[3]; /* constraints, -1 */
    int32_t exists;      /* such a motion does */
    se3di_wheel_prescription prescribed[SE3DI_WHEEL_COORDINATES];
    size_t prescribed_count;
    int32_t *column; /* [bodies] first unknown, -1: at rest */
    uint8_t *used;   /* [constraints] */
    size_t columns, rows;
    se3di_least_norm factors; /* of the equations */
    double *velocity;         /* [bodies * 6]: v (ground frame), w (body frame) */
    double *acceleration;     /* [bodies * 6], by se3di_wheel_motion_curve */
} se3di_wheel_motion;

/* Find the motion of model, wheel, released and prescribed, which the caller has filled in. On
 * failure nothing is held. @return OK, NO_MEMORY, NOT_FINITE, CALLBACK */
se3d_status se3di_wheel_motion_find(se3di_wheel_motion *motion);
/* The motion with other rates of what is prescribed. */
se3d_status se3di_wheel_motion_change(se3di_wheel_motion *motion, const double *rates);
/* Its accelerations. */
se3d_status se3di_wheel_motion_curve(se3di_wheel_motion *motion);
void se3di_wheel_motion_destroy(se3di_wheel_motion *motion);

/* Vehicle axes in the ground frame: rows x, y, z. */
void se3di_wheel_axes(const se3di_model *model, const se3di_wheel *wheel, double axes[9]);

#endif
