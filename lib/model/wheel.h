/* SPDX-License-Identifier: BSD-3-Clause */
/* Wheels on their uprights. Data only; what is measured is in analysis/wheel.h. */
#ifndef SE3DI_MODEL_WHEEL_H
#define SE3DI_MODEL_WHEEL_H

#include <stdint.h>

typedef struct se3di_wheel {
    char *name;
    uint32_t body, chassis;
    int32_t travel, steering; /* constraints that are let go; -1: none */
    int32_t spring;           /* force element, -1: none */
    int32_t opposite;         /* wheel, -1: none */
    double center[3];         /* frame of the body */
    double axis[3];           /* unit, out of the vehicle, frame of the body */
    double vehicle[9];        /* rows: forward, left, up; frame of the chassis */
    double road[3];           /* unit normal, ground frame */
    double radius, width;
    double lower[3], upper[3]; /* steer axis, frame of the body; equal: none */
    double center0[3];         /* given pose, from the chassis' origin, vehicle axes */
    double contact0[3];
    double wheelbase, cg_height, brake_share, drive_share;
} se3di_wheel;

#endif
