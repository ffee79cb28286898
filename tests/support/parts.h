/* SPDX-License-Identifier: BSD-3-Clause */
/* Small parts of systems, and what their accounts leave over. */
#ifndef SE3D_TESTS_SUPPORT_PARTS_H
#define SE3D_TESTS_SUPPORT_PARTS_H

#include "check.h"
#include "se3d/se3d.h"

/* A hinge about y at the origin, x beside the centre of the body. */
static inline se3d_constraint part_hinge(se3d_system *system, const char *name, se3d_body body,
                                         double x)
{
    se3d_joint_def pin = se3d_joint_def_default();
    se3d_constraint made;
    pin.name = name;
    CHECK(!se3d_system_get_ground(system, &pin.body_i));
    pin.body_j = body;
    pin.point_j[0] = x;
    pin.axis_i[1] = pin.axis_j[1] = 1.0;
    pin.axis_i[2] = pin.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_revolute(system, &pin, &made));
    return made;
}

/* A body of 2 kg. */
static inline se3d_body part_body(se3d_system *system, const char *name, double x, double z)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.name = name;
    def.mass = 2.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
    def.position[0] = x;
    def.position[2] = z;
    CHECK(!se3d_body_create(system, &def, &body));
    return body;
}

/* What the energies and works leave over. */
static inline double part_balance(const se3d_system *system)
{
    se3d_energy energy;
    se3d_work work;
    CHECK(!se3d_system_get_energy(system, &energy));
    CHECK(!se3d_system_get_work(system, &work));
    return energy.total + work.dissipated - work.actuators - work.drivers;
}

/* A user constraint that asks for nothing. */
static inline se3d_status part_no_equation(void *ctx, double t, const se3d_body_motion *bodies,
                                           double *phi, double *jacobian, double *nu, double *gamma)
{
    (void)ctx, (void)t, (void)bodies, (void)phi, (void)jacobian, (void)nu, (void)gamma;
    return SE3D_OK;
}

#endif
