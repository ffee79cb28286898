/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of joint types. */
#include "joint/joint.h"

#define ROW(name, flags) [SE3DI_JOINT_TYPE_##name] = {#name, se3di_##name##_build, flags},
const se3di_joint_type se3di_joint_types[SE3DI_JOINT_TYPE_COUNT] = {SE3DI_JOINT_LIST(ROW)};
