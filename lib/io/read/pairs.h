/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints between two bodies. */
#ifndef SE3D_IO_PAIRS_H
#define SE3D_IO_PAIRS_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* What a type needs to be said about it. */
enum { POINT = 1, AXIS_I = 2, AXIS_J = 4, AXIS_2 = 8, DISTANCE = 16, PITCH = 32 };

/* Joint types, X(name, what must be said of it, what it looks like: a se3di_joint_look): those that
 * have axes, those of points only, and the intermediate constraints that are made like joints. */
#define SE3DI_TURNING_LIST(X)                                                                      \
    X(fixed, 0, BLOCK)                                                                             \
    X(revolute, POINT | AXIS_I | AXIS_J, PIN)                                                      \
    X(prismatic, POINT | AXIS_I | AXIS_J, SLIDER)                                                  \
    X(cylindrical, POINT | AXIS_I | AXIS_J, SLEEVE)                                                \
    X(spherical, POINT, BALL)                                                                      \
    X(universal, POINT | AXIS_I | AXIS_J | AXIS_2, CROSS)                                          \
    X(planar, POINT | AXIS_I | AXIS_J, PLATE)                                                      \
    X(screw, POINT | AXIS_I | AXIS_J | PITCH, SCREW)                                               \
    X(point_on_line, POINT | AXIS_I, ON_LINE)                                                      \
    X(point_on_plane, POINT | AXIS_I, ON_PLANE)                                                    \
    X(revolute_spherical, POINT | AXIS_I | DISTANCE, BALL)                                         \
    X(revolute_cylindrical, POINT | AXIS_I | AXIS_J | AXIS_2 | DISTANCE, PIN)                      \
    X(parallel, AXIS_I | AXIS_J, NONE)                                                             \
    X(perpendicular, AXIS_I | AXIS_J | AXIS_2, NONE)                                               \
    X(orientation, 0, NONE)
#define SE3DI_DISTANCE_LIST(X) X(distance, POINT | DISTANCE, BALL)
#define SE3DI_PERPENDICULAR_LIST(X)                                                                \
    X(perpendicular1, AXIS_I | AXIS_J | AXIS_2, NONE)                                              \
    X(perpendicular2, POINT | AXIS_I, ON_PLANE)

/* One that a pair of bodies carries: used for joints and two of the constraints. */
bool se3di_read_pair(se3di_reader *reader, const se3di_node *node, const char *type,
                     se3di_element_entry *entry);

#endif
