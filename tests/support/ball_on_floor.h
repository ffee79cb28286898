/* SPDX-License-Identifier: BSD-3-Clause */
/* A floor and a ball that touches it, or nearly, in a system that has other things. */
#ifndef SE3D_TESTS_SUPPORT_BALL_ON_FLOOR_H
#define SE3D_TESTS_SUPPORT_BALL_ON_FLOOR_H

#include <string.h>

#include "check.h"
#include "se3d/se3d.h"

/* A plane z = height of a new material. */
static inline se3d_material add_floor_of(se3d_system *system, double density, double stiffness,
                                         double height)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def plane = se3d_shape_def_default();
    se3d_shape made;
    stuff.density = density;
    stuff.stiffness = stiffness;
    CHECK(!se3d_material_create(system, &stuff, &plane.material));
    plane.position[2] = height;
    CHECK(!se3d_shape_create_plane(system, &plane, &made));
    return plane.material;
}

static inline void add_sphere_on(se3d_system *system, se3d_body body, se3d_material material,
                                 double radius)
{
    se3d_shape_def sphere = se3d_shape_def_default();
    se3d_shape made;
    sphere.body = body;
    sphere.material = material;
    sphere.radius = radius;
    CHECK(!se3d_shape_create_sphere(system, &sphere, &made));
}

/* A ball of 1 kg with a radius of 0.1 m. */
static inline se3d_body add_ball_of(se3d_system *system, se3d_material material, double inertia,
                                    double height, const double v[3])
{
    se3d_body_def ball = se3d_body_def_default();
    se3d_body body;
    ball.mass = 1.0;
    ball.inertia[0] = ball.inertia[1] = ball.inertia[2] = inertia;
    ball.position[2] = height;
    memcpy(ball.velocity, v, sizeof ball.velocity);
    CHECK(!se3d_body_create(system, &ball, &body));
    add_sphere_on(system, body, material, 0.1);
    return body;
}

#endif
