/* SPDX-License-Identifier: BSD-3-Clause */
/* libse3d: constrained rigid multibody dynamics in three dimensions. Include this one header.
 *
 * Conventions: SI units, radians, right-handed frames. The ground is a body. A body's frame sits at
 * its centre of mass; p = (e0,e1,e2,e3), scalar first, maps body to ground; angular velocities are
 * in the body frame. For every element between two bodies, i is the reference and j moves:
 * coordinates are of j relative to i, and reactions act on j (body i receives the opposite).
 *
 * Threads: distinct systems are independent. On one system, functions taking `const se3d_system *`
 * ("Reader") may run concurrently with each other; all others ("Exclusive") need exclusive access.
 *
 * Errors: a call that takes a system and fails records a message: se3d_system_get_error. Arguments
 * are always checked; on failure of an editing call nothing changed and handle outputs are null. */
#ifndef SE3D_SE3D_H
#define SE3D_SE3D_H

#include "se3d/base.h"
#include "se3d/body.h"
#include "se3d/check.h"
#include "se3d/constraint.h"
#include "se3d/contact.h"
#include "se3d/elementary.h"
#include "se3d/event.h"
#include "se3d/expression.h"
#include "se3d/force.h"
#include "se3d/function.h"
#include "se3d/handles.h"
#include "se3d/joint.h"
#include "se3d/material.h"
#include "se3d/modes.h"
#include "se3d/particles.h"
#include "se3d/shape.h"
#include "se3d/solver.h"
#include "se3d/system.h"

#endif
