/* SPDX-License-Identifier: BSD-3-Clause */
/* libse3d: constrained rigid multibody dynamics in three dimensions. Include this one header.
 *
 * Conventions: SI units, radians, right-handed frames. The ground is a body. A body's frame sits at
 * its centre of mass; p = (e0,e1,e2,e3), scalar first, maps body to ground; angular velocities are
 * in the body frame. For every element between two bodies, i is the reference and j moves:
 * coordinates are of j relative to i, and reactions act on j (body i receives the opposite).
 *
 * Parameters: an object or a handle names what the call is about, a definition says what to make,
 * `out` or a handle's address receives what was made. Texts are UTF-8, end with a zero byte and are
 * copied. Other parameters are described at each function; [in], [out] and units in brackets.
 *
 * Returns: after @return stand the statuses without SE3D_ or SE3D_ERR_. NULL means that a required
 * pointer is NULL. Functions that change or evaluate something of a system also return STATE if
 * they are called within a callback that does not allow it (docs/api.md, "Callbacks"), and so do
 * those of a solver, particle set or event whose system is gone.
 *
 * Threads: distinct systems are independent. A function may run concurrently with others that take
 * the same object by a pointer to const, as it does itself (a Reader); it needs objects that it
 * takes otherwise for itself (Exclusive); without objects it is Safe. If a function differs, its
 * comment says which it is, and why in parentheses.
 *
 * Errors: a call that takes a system and fails records a message: se3d_system_get_error. Arguments
 * are always checked; on failure of an editing call nothing changed and handle outputs are null. */
#ifndef SE3D_SE3D_H
#define SE3D_SE3D_H

#include "se3d/average.h"
#include "se3d/base.h"
#include "se3d/batch.h"
#include "se3d/body.h"
#include "se3d/bond.h"
#include "se3d/cell.h"
#include "se3d/check.h"
#include "se3d/clump.h"
#include "se3d/constraint.h"
#include "se3d/contact.h"
#include "se3d/coordinates.h"
#include "se3d/elementary.h"
#include "se3d/event.h"
#include "se3d/expression.h"
#include "se3d/field.h"
#include "se3d/flow.h"
#include "se3d/force.h"
#include "se3d/function.h"
#include "se3d/handles.h"
#include "se3d/joint.h"
#include "se3d/material.h"
#include "se3d/modes.h"
#include "se3d/particles.h"
#include "se3d/road.h"
#include "se3d/servo.h"
#include "se3d/shape.h"
#include "se3d/solver.h"
#include "se3d/state.h"
#include "se3d/system.h"
#include "se3d/tyre.h"
#include "se3d/wall_map.h"
#include "se3d/wheel.h"

#endif
