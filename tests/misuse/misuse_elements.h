/* SPDX-License-Identifier: BSD-3-Clause */
/* Definitions of elements that are right, and their fields that can be wrong. */
#ifndef SE3D_TESTS_MISUSE_ELEMENTS_H
#define SE3D_TESTS_MISUSE_ELEMENTS_H

#include "misuse/misuse_definitions.h"
#include "misuse/misuse_fields.h"
#include "support/parts.h"

static void define_body(arguments *a)
{
    se3d_body_def def = body_def("new");
    STORE(def);
}
static const field body_fields[] = {NAME(se3d_body_def),
                                    NUMBERS(se3d_body_def, mass),
                                    NUMBERS(se3d_body_def, inertia),
                                    NUMBERS(se3d_body_def, position),
                                    NUMBERS(se3d_body_def, orientation),
                                    NUMBERS(se3d_body_def, velocity),
                                    NUMBERS(se3d_body_def, angular_velocity),
                                    FIELDS_END};

static void define_marker(arguments *a)
{
    se3d_marker_def def = se3d_marker_def_default();
    def.body = a->use.body;
    STORE(def);
}
static const field marker_fields[] = {NAME(se3d_marker_def), BODY(se3d_marker_def, body),
                                      NUMBERS(se3d_marker_def, position),
                                      NUMBERS(se3d_marker_def, orientation), FIELDS_END};

static void define_state(arguments *a)
{
    se3d_state_def def = se3d_state_def_default();
    def.rate = a->use.function;
    STORE(def);
}
static const field state_fields[] = {NAME(se3d_state_def),
                                     FUNCTION(se3d_state_def, rate),
                                     FUNCTION(se3d_state_def, output),
                                     FUNCTION(se3d_state_def, input),
                                     NUMBERS(se3d_state_def, initial),
                                     NUMBERS(se3d_state_def, size),
                                     FIELDS_END};

static void define_wheel(arguments *a)
{
    se3d_wheel_def def = se3d_wheel_def_default();
    def.body = a->use.body;
    def.chassis = ground_of(a);
    def.radius = 0.3;
    def.travel = a->use.primitive;
    def.steering = a->use.pin;
    def.spring = a->use.force;
    STORE(def);
}
static const field wheel_fields[] = {NAME(se3d_wheel_def),
                                     BODY(se3d_wheel_def, body),
                                     BODY(se3d_wheel_def, chassis),
                                     NUMBERS(se3d_wheel_def, center),
                                     NUMBERS(se3d_wheel_def, axis),
                                     NUMBERS(se3d_wheel_def, forward),
                                     NUMBERS(se3d_wheel_def, up),
                                     NUMBERS(se3d_wheel_def, radius),
                                     NUMBERS(se3d_wheel_def, width),
                                     NUMBERS(se3d_wheel_def, steer_lower),
                                     NUMBERS(se3d_wheel_def, steer_upper),
                                     NUMBERS(se3d_wheel_def, wheelbase),
                                     NUMBERS(se3d_wheel_def, cg_height),
                                     NUMBERS(se3d_wheel_def, brake_share),
                                     NUMBERS(se3d_wheel_def, drive_share),
                                     FIELDS_END};

static void define_road(arguments *a)
{
    se3d_road_def def = se3d_road_def_default();
    def.body = a->use.body;
    def.height = a->use.function;
    STORE(def);
}
static const field road_fields[] = {NAME(se3d_road_def),
                                    BODY(se3d_road_def, body),
                                    NUMBERS(se3d_road_def, point),
                                    NUMBERS(se3d_road_def, normal),
                                    NUMBERS(se3d_road_def, forward),
                                    FUNCTION(se3d_road_def, height),
                                    FIELDS_END};

static void define_primitive(arguments *a)
{
    se3d_primitive_def def = se3d_primitive_def_default();
    def.type = SE3D_PRIMITIVE_CD;
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    def.a_i[0] = def.a_j[1] = def.c[2] = 1.0;
    def.function = a->use.function;
    STORE(def);
}
static const field primitive_fields[] = {NAME(se3d_primitive_def),
                                         BODY(se3d_primitive_def, body_i),
                                         BODY(se3d_primitive_def, body_j),
                                         NUMBERS(se3d_primitive_def, point_i),
                                         NUMBERS(se3d_primitive_def, point_j),
                                         NUMBERS(se3d_primitive_def, c),
                                         FUNCTION(se3d_primitive_def, function),
                                         FIELDS_END};

static void define_driver(arguments *a)
{
    se3d_driver_def def = se3d_driver_def_default();
    def.joint = a->use.pin;
    STORE(def);
}
static const field driver_fields[] = {NAME(se3d_driver_def), JOINT(se3d_driver_def, joint),
                                      NUMBERS(se3d_driver_def, value),
                                      FUNCTION(se3d_driver_def, function), FIELDS_END};

static void define_coupler(arguments *a)
{
    se3d_coupler_def def = se3d_coupler_def_default();
    def.joint[0] = a->use.pin;
    def.joint[1] = a->use.slide;
    def.coordinate[1] = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def.ratio[0] = def.ratio[1] = 1.0;
    def.count = 2;
    STORE(def);
}
static const field coupler_fields[] = {
    NAME(se3d_coupler_def),
    {"joint", offsetof(se3d_coupler_def, joint), sizeof(se3d_constraint), 1, 'c'},
    {"ratio", offsetof(se3d_coupler_def, ratio), sizeof(double), 2, 'd'},
    NUMBERS(se3d_coupler_def, value),
    FUNCTION(se3d_coupler_def, function),
    FIELDS_END};

static void define_user_constraint(arguments *a)
{
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    def.bodies[0] = ground_of(a);
    def.bodies[1] = a->use.body;
    def.body_count = 2;
    def.callback = part_no_equation;
    STORE(def);
}
static const field user_constraint_fields[] = {
    NAME(se3d_user_constraint_def), BODY(se3d_user_constraint_def, bodies[0]),
    BODY(se3d_user_constraint_def, bodies[1]), FIELDS_END};

static void define_function(arguments *a)
{
    se3d_function_def def = se3d_function_def_default();
    STORE(def);
}
static const field function_fields[] = {NUMBERS(se3d_function_def, constant), FIELDS_END};

static void define_solver(arguments *a)
{
    se3d_solver_def def = se3d_solver_def_default();
    STORE(def);
}
static const field solver_fields[] = {
    NUMBERS(se3d_solver_def, step), NUMBERS(se3d_solver_def, tolerance),
    NUMBERS(se3d_solver_def, spectral_radius), NUMBERS(se3d_solver_def, alpha), FIELDS_END};

#endif
