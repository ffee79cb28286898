/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels: what can be written to a results file, by name. */
#ifndef SE3D_IO_CHANNEL_H
#define SE3D_IO_CHANNEL_H

#include "io/base/pool.h"
#include "io/document/unit.h"
#include "se3d/io.h"

/* What a channel may give: columns; the question that is asked of the system for it, and the first
 * of its numbers in the answer; how it changes in time; and its unit as powers of the model's
 * length, of 1/s and of its mass; of what may be a translation or a rotation, the last number takes
 * the larger. */
/* clang-format off */
#define SE3DI_QUANTITY_LIST(X)                                                                     \
    X(BODY_POSITION, 3, ITSELF, 0, MOTION, 1, 0, 0, 0)                                             \
    X(BODY_ORIENTATION, 4, ITSELF, 0, MOTION, 0, 0, 0, 0)                                          \
    X(BODY_VELOCITY, 3, ITSELF, 0, MOTION, 1, 1, 0, 0)                                             \
    X(BODY_ANGULAR_VELOCITY, 3, ITSELF, 0, MOTION, 0, 1, 0, 0)                                     \
    X(BODY_ACCELERATION, 3, ITSELF, 0, SOLVED, 1, 2, 0, 0)                                         \
    X(BODY_ANGULAR_ACCELERATION, 3, ITSELF, 0, SOLVED, 0, 2, 0, 0)                                 \
    X(BODY_CONTACT_FORCE, 3, ITSELF, 0, SOLVED, 1, 2, 1, 0)                                        \
    X(MARKER_POSITION, 3, ITSELF, 0, MOTION, 1, 0, 0, 0)                                           \
    X(MARKER_VELOCITY, 3, ITSELF, 0, MOTION, 1, 1, 0, 0)                                           \
    X(MARKER_ACCELERATION, 3, ITSELF, 0, SOLVED, 1, 2, 0, 0)                                       \
    X(MARKER_ORIENTATION, 4, ITSELF, 0, MOTION, 0, 0, 0, 0)                                        \
    X(MARKER_ANGULAR_VELOCITY, 3, ITSELF, 0, MOTION, 0, 1, 0, 0)                                   \
    X(MARKER_ANGULAR_ACCELERATION, 3, ITSELF, 0, SOLVED, 0, 2, 0, 0)                               \
    X(WRENCH_FORCE, 3, WRENCH, 0, LOADED, 1, 2, 1, 0)                                              \
    X(WRENCH_TORQUE, 3, WRENCH, 3, LOADED, 2, 2, 1, 0)                                             \
    X(REACTION_FORCE, 3, REACTION, 0, SOLVED, 1, 2, 1, 0)                                          \
    X(REACTION_TORQUE, 3, REACTION, 3, SOLVED, 2, 2, 1, 0)                                         \
    X(JOINT_ANGLE, 1, JOINT_ANGLE, 0, MOTION, 0, 0, 0, 0)                                          \
    X(JOINT_ANGLE_RATE, 1, JOINT_ANGLE, 1, MOTION, 0, 1, 0, 0)                                     \
    X(JOINT_DISPLACEMENT, 1, JOINT_DISPLACEMENT, 0, MOTION, 1, 0, 0, 0)                            \
    X(JOINT_DISPLACEMENT_RATE, 1, JOINT_DISPLACEMENT, 1, MOTION, 1, 1, 0, 0)                       \
    X(JOINT_BROKEN, 1, JOINT_BROKEN, 0, JUMPS, 0, 0, 0, 0)                                         \
    X(DRIVER_VALUE, 1, DRIVER_VALUE, 0, LOADED, 0, 0, 0, 1)                                        \
    X(DRIVER_EFFORT, 1, DRIVER_EFFORT, 0, SOLVED, 1, 2, 1, 1)                                      \
    X(FORCE_COORDINATE, 1, FORCE, 0, MOTION, 0, 0, 0, 1)                                           \
    X(FORCE_RATE, 1, FORCE, 1, MOTION, 0, 1, 0, 1)                                                 \
    X(FORCE_VALUE, 1, FORCE, 2, LOADED, 1, 2, 1, 1)                                                \
    X(ARMATURE_COORDINATE, 1, ARMATURE_MOTION, 0, MOTION, 0, 0, 0, 1)                              \
    X(ARMATURE_RATE, 1, ARMATURE_MOTION, 1, MOTION, 0, 1, 0, 1)                                    \
    X(ARMATURE_EFFORT, 1, FORCE, 2, SOLVED, 1, 2, 1, 1)                                            \
    X(STATE_VALUE, 1, STATE_VALUE, 0, MOTION, 0, 0, 0, 0)                                          \
    X(STATE_INPUT, 1, STATE_INPUT, 0, MOTION, 0, 0, 0, 0)                                          \
    X(STATE_RATE, 1, STATE_RATE, 0, MOTION, 0, 1, 0, 0)                                            \
    X(STATE_ITSELF, 1, STATE_ITSELF, 0, MOTION, 0, 0, 0, 0)                                        \
    X(WHEEL_CAMBER, 1, WHEEL_POSE, 0, MOTION, 0, 0, 0, 0)                                          \
    X(WHEEL_INCLINATION, 1, WHEEL_POSE, 1, MOTION, 0, 0, 0, 0)                                     \
    X(WHEEL_STEER, 1, WHEEL_POSE, 2, MOTION, 0, 0, 0, 0)                                           \
    X(WHEEL_TOE, 1, WHEEL_POSE, 3, MOTION, 0, 0, 0, 0)                                             \
    X(WHEEL_TRAVEL, 1, WHEEL_POSE, 4, MOTION, 1, 0, 0, 0)                                          \
    X(WHEELBASE_CHANGE, 1, WHEEL_POSE, 5, MOTION, 1, 0, 0, 0)                                      \
    X(WHEEL_TRACK_CHANGE, 1, WHEEL_POSE, 6, MOTION, 1, 0, 0, 0)                                    \
    X(WHEEL_ACKERMANN_ERROR, 1, WHEEL_POSE, 7, MOTION, 0, 0, 0, 0)                                 \
    X(WHEEL_CONTACT, 3, WHEEL_POSE, 8, MOTION, 1, 0, 0, 0)                                         \
    X(WHEEL_CASTER, 1, WHEEL_AXIS, 0, MOTION, 0, 0, 0, 0)                                          \
    X(WHEEL_KINGPIN_INCLINATION, 1, WHEEL_AXIS, 1, MOTION, 0, 0, 0, 0)                             \
    X(WHEEL_SCRUB_RADIUS, 1, WHEEL_AXIS, 2, MOTION, 1, 0, 0, 0)                                    \
    X(WHEEL_MECHANICAL_TRAIL, 1, WHEEL_AXIS, 3, MOTION, 1, 0, 0, 0)                                \
    X(WHEEL_CAMBER_GRADIENT, 1, WHEEL_RIDE, 0, MOTION, -1, 0, 0, 0)                                \
    X(WHEEL_TOE_GRADIENT, 1, WHEEL_RIDE, 1, MOTION, -1, 0, 0, 0)                                   \
    X(WHEEL_TRACK_GRADIENT, 1, WHEEL_RIDE, 2, MOTION, 0, 0, 0, 0)                                  \
    X(WHEELBASE_GRADIENT, 1, WHEEL_RIDE, 3, MOTION, 0, 0, 0, 0)                                    \
    X(WHEEL_FRONT_SWING_ARM, 1, WHEEL_RIDE, 4, MOTION, 1, 0, 0, 0)                                 \
    X(WHEEL_FRONT_CENTER_HEIGHT, 1, WHEEL_RIDE, 5, MOTION, 1, 0, 0, 0)                             \
    X(WHEEL_SIDE_SWING_ARM, 1, WHEEL_RIDE, 6, MOTION, 1, 0, 0, 0)                                  \
    X(WHEEL_SIDE_CENTER_HEIGHT, 1, WHEEL_RIDE, 7, MOTION, 1, 0, 0, 0)                              \
    X(WHEEL_ROLL_CENTER_HEIGHT, 1, WHEEL_RIDE, 8, MOTION, 1, 0, 0, 0)                              \
    X(WHEEL_ANTI_DIVE, 1, WHEEL_RIDE, 9, MOTION, 0, 0, 0, 0)                                       \
    X(WHEEL_ANTI_LIFT, 1, WHEEL_RIDE, 10, MOTION, 0, 0, 0, 0)                                      \
    X(WHEEL_ANTI_SQUAT, 1, WHEEL_RIDE, 11, MOTION, 0, 0, 0, 0)                                     \
    X(WHEEL_MOTION_RATIO, 1, WHEEL_RIDE, 12, MOTION, 0, 0, 0, 0)                                   \
    X(WHEEL_LOAD, 1, WHEEL_LOAD, 0, MOTION, 1, 2, 1, 0)                                            \
    X(WHEEL_RATE, 1, WHEEL_LOAD, 1, MOTION, 0, 2, 1, 0)                                            \
    X(WHEEL_ROLL_RATE, 1, WHEEL_LOAD, 2, MOTION, 2, 2, 1, 0)                                       \
    X(TYRE_FX, 1, TYRE, 0, MOTION, 1, 2, 1, 0)                                                     \
    X(TYRE_FY, 1, TYRE, 1, MOTION, 1, 2, 1, 0)                                                     \
    X(TYRE_FZ, 1, TYRE, 2, MOTION, 1, 2, 1, 0)                                                     \
    X(TYRE_MX, 1, TYRE, 3, MOTION, 2, 2, 1, 0)                                                     \
    X(TYRE_MY, 1, TYRE, 4, MOTION, 2, 2, 1, 0)                                                     \
    X(TYRE_MZ, 1, TYRE, 5, MOTION, 2, 2, 1, 0)                                                     \
    X(TYRE_SLIP_RATIO, 1, TYRE, 6, MOTION, 0, 0, 0, 0)                                             \
    X(TYRE_SLIP_ANGLE, 1, TYRE, 7, MOTION, 0, 0, 0, 0)                                             \
    X(TYRE_INCLINATION, 1, TYRE_PLACE, 0, MOTION, 0, 0, 0, 0)                                      \
    X(TYRE_DEFLECTION, 1, TYRE_PLACE, 1, MOTION, 1, 0, 0, 0)                                       \
    X(TYRE_LOADED_RADIUS, 1, TYRE_PLACE, 2, MOTION, 1, 0, 0, 0)                                    \
    X(TYRE_ROLLING_RADIUS, 1, TYRE_PLACE, 3, MOTION, 1, 0, 0, 0)                                   \
    X(TYRE_SPEED, 1, TYRE_PLACE, 4, MOTION, 1, 1, 0, 0)                                            \
    X(TYRE_CONTACT, 3, TYRE_PLACE, 5, MOTION, 1, 0, 0, 0)                                          \
    X(TYRE_LAGGED_RATIO, 1, TYRE_PLACE, 8, MOTION, 0, 0, 0, 0)                                     \
    X(TYRE_LAGGED_ANGLE, 1, TYRE_PLACE, 9, MOTION, 0, 0, 0, 0)                                     \
    X(TYRE_TURN_SLIP, 1, TYRE_PLACE, 10, MOTION, -1, 0, 0, 0)                                      \
    X(ENERGY_KINETIC, 1, ENERGY, 0, MOTION, 2, 2, 1, 0)                                            \
    X(ENERGY_POTENTIAL, 1, ENERGY, 1, MOTION, 2, 2, 1, 0)                                          \
    X(ENERGY_TOTAL, 1, ENERGY, 2, MOTION, 2, 2, 1, 0)                                              \
    X(ENERGY_DISSIPATED, 1, ENERGY, 3, LOADED, 2, 2, 1, 0)                                         \
    X(ENERGY_BALANCE, 1, WORK, 2, LOADED, 2, 2, 1, 0)                                              \
    X(WORK_ACTUATORS, 1, WORK, 0, LOADED, 2, 2, 1, 0)                                              \
    X(WORK_DRIVERS, 1, WORK, 1, LOADED, 2, 2, 1, 0)                                                \
    X(VIOLATION_POSITION, 1, VIOLATION, 0, SOLVED, 1, 0, 0, 0)                                     \
    X(VIOLATION_VELOCITY, 1, VIOLATION, 1, SOLVED, 1, 1, 0, 0)                                     \
    X(VIOLATION_ACCELERATION, 1, VIOLATION, 2, SOLVED, 1, 2, 0, 0)                                 \
    X(CONTACTS_COUNT, 1, CONTACTS_COUNT, 0, JUMPS, 0, 0, 0, 0)                                     \
    X(CONTACTS_FORCE_MAX, 1, CONTACTS_FORCE_MAX, 0, SOLVED, 1, 2, 1, 0)                            \
    X(PARTICLES_COUNT, 1, PARTICLES, 0, JUMPS, 0, 0, 0, 0)                                         \
    X(PARTICLES_LOST, 1, PARTICLES, 1, JUMPS, 0, 0, 0, 0)                                          \
    X(PARTICLES_ENERGY, 1, PARTICLES, 3, SOLVED, 2, 2, 1, 0)                                       \
    X(PARTICLES_LEFT, 1, PARTICLES, 2, JUMPS, 0, 0, 0, 0)                                          \
    X(PARTICLES_KINETIC, 1, PARTICLES, 4, SOLVED, 2, 2, 1, 0)                                      \
    X(PARTICLES_ROTATION, 1, PARTICLES, 5, SOLVED, 2, 2, 1, 0)                                     \
    X(SET_COUNT, 1, TALLY, 0, JUMPS, 0, 0, 0, 0)                                                   \
    X(SET_LOST, 1, TALLY, 1, JUMPS, 0, 0, 0, 0)                                                    \
    X(SET_LEFT, 1, TALLY, 2, JUMPS, 0, 0, 0, 0)                                                    \
    X(SET_MASS, 1, TALLY, 3, JUMPS, 0, 0, 1, 0)                                                    \
    X(SET_ENERGY, 1, TALLY, 4, SOLVED, 2, 2, 1, 0)                                                 \
    X(SET_KINETIC, 1, TALLY, 5, SOLVED, 2, 2, 1, 0)                                                \
    X(SET_ROTATION, 1, TALLY, 6, SOLVED, 2, 2, 1, 0)                                               \
    X(SET_INSERTED, 1, SOURCES, 0, JUMPS, 0, 0, 0, 0)                                              \
    X(SET_DEFERRED, 1, SOURCES, 1, JUMPS, 0, 0, 0, 0)                                              \
    X(SET_WAITING, 1, SOURCES, 2, JUMPS, 0, 0, 0, 0)                                               \
    X(SINK_COUNT, 1, SINK, 0, JUMPS, 0, 0, 0, 0)                                                   \
    X(REGION_COUNT, 1, AVERAGE, 0, JUMPS, 0, 0, 0, 0)                                              \
    X(REGION_MASS, 1, AVERAGE, 1, JUMPS, 0, 0, 1, 0)                                               \
    X(REGION_SOLID_FRACTION, 1, AVERAGE, 2, SOLVED, 0, 0, 0, 0)                                    \
    X(REGION_COORDINATION, 1, AVERAGE, 3, JUMPS, 0, 0, 0, 0)                                       \
    X(REGION_TEMPERATURE, 1, AVERAGE, 4, JUMPS, 2, 2, 0, 0)                                        \
    X(REGION_VELOCITY, 3, AVERAGE, 5, JUMPS, 1, 1, 0, 0)                                           \
    X(REGION_MASS_FLUX, 3, AVERAGE, 8, JUMPS, -2, 1, 1, 0)                                         \
    X(REGION_STRESS, 3, AVERAGE, 11, JUMPS, -1, 2, 1, 0)                                           \
    X(REGION_SHEAR, 3, AVERAGE, 14, JUMPS, -1, 2, 1, 0)                                            \
    X(FLOW_COUNT, 1, PASSED, 0, JUMPS, 0, 0, 0, 0)                                                 \
    X(FLOW_FORWARD, 1, PASSED, 1, JUMPS, 0, 0, 0, 0)                                               \
    X(FLOW_BACKWARD, 1, PASSED, 2, JUMPS, 0, 0, 0, 0)                                              \
    X(FLOW_MASS, 1, PASSED, 3, JUMPS, 0, 0, 1, 0)                                                  \
    X(FLOW_MOMENTUM, 3, PASSED, 4, JUMPS, 1, 1, 1, 0)                                              \
    X(FLOW_COUNT_RATE, 1, PASSED, 7, JUMPS, 0, 1, 0, 0)                                            \
    X(FLOW_MASS_RATE, 1, PASSED, 8, JUMPS, 0, 1, 1, 0)                                             \
    X(FLOW_MOMENTUM_RATE, 3, PASSED, 9, JUMPS, 1, 2, 1, 0)                                         \
    X(SERVO_POSITION, 1, SERVO, 0, JUMPS, 1, 0, 0, 0)                                              \
    X(SERVO_SPEED, 1, SERVO, 1, JUMPS, 1, 1, 0, 0)                                                 \
    X(SERVO_FORCE, 1, SERVO, 2, JUMPS, 1, 2, 1, 0)                                                 \
    X(SERVO_WANTED, 1, SERVO, 3, JUMPS, 1, 2, 1, 0)                                                \
    X(SERVO_WORK, 1, SERVO, 4, JUMPS, 2, 2, 1, 0)                                                  \
    X(BOND_COUNT, 1, BONDS, 0, JUMPS, 0, 0, 0, 0)                                                  \
    X(BOND_BROKEN, 1, BONDS, 1, JUMPS, 0, 0, 0, 0)                                                 \
    X(BOND_TORN, 1, BONDS, 2, JUMPS, 0, 0, 0, 0)                                                   \
    X(BOND_SHEARED, 1, BONDS, 3, JUMPS, 0, 0, 0, 0)                                                \
    X(BOND_LOST, 1, BONDS, 4, JUMPS, 0, 0, 0, 0)                                                   \
    X(BOND_ENERGY, 1, BONDS, 5, SOLVED, 2, 2, 1, 0)                                                \
    X(BOND_DISSIPATED, 1, BONDS, 6, JUMPS, 2, 2, 1, 0)                                             \
    X(BOND_RELEASED, 1, BONDS, 7, JUMPS, 2, 2, 1, 0)                                               \
    X(BOND_TENSION, 1, BONDS, 8, SOLVED, -1, 2, 1, 0)                                              \
    X(BOND_SHEAR, 1, BONDS, 9, SOLVED, -1, 2, 1, 0)                                                \
    X(CELL_LENGTH, 3, CELL, 0, JUMPS, 1, 0, 0, 0)                                                  \
    X(CELL_OFFSET, 1, CELL, 3, JUMPS, 1, 0, 0, 0)                                                  \
    X(CELL_STRAIN, 3, CELL, 4, JUMPS, 0, 0, 0, 0)                                                  \
    X(CELL_SHEAR_STRAIN, 1, CELL, 7, JUMPS, 0, 0, 0, 0)                                            \
    X(CELL_RATE, 3, CELL, 8, JUMPS, 0, 1, 0, 0)                                                    \
    X(CELL_SHEAR_RATE, 1, CELL, 11, JUMPS, 0, 1, 0, 0)                                             \
    X(CELL_STRESS, 3, CELL, 12, JUMPS, -1, 2, 1, 0)                                                \
    X(CELL_SHEAR, 3, CELL, 15, JUMPS, -1, 2, 1, 0)                                                 \
    X(CELL_VOLUME, 1, CELL, 18, JUMPS, 3, 0, 0, 0)                                                 \
    X(CELL_SOLID_FRACTION, 1, CELL, 19, JUMPS, 0, 0, 0, 0)                                         \
    X(CELL_KINETIC, 1, CELL, 20, JUMPS, 2, 2, 1, 0)                                                \
    X(CELL_WORK, 1, CELL, 21, JUMPS, 2, 2, 1, 0)                                                   \
    X(DISSIPATION_NORMAL, 1, DISSIPATION, 0, JUMPS, 2, 2, 1, 0)                                    \
    X(DISSIPATION_TANGENTIAL, 1, DISSIPATION, 1, JUMPS, 2, 2, 1, 0)                                \
    X(DISSIPATION_ROLLING, 1, DISSIPATION, 2, JUMPS, 2, 2, 1, 0)                                   \
    X(DISSIPATION_TORSION, 1, DISSIPATION, 3, JUMPS, 2, 2, 1, 0)                                   \
    X(DISSIPATION_BONDS, 1, DISSIPATION, 4, JUMPS, 2, 2, 1, 0)                                     \
    X(DISSIPATION_TOTAL, 1, DISSIPATION, 5, JUMPS, 2, 2, 1, 0)                                     \
    X(DISSIPATION_ELASTIC, 1, DISSIPATION, 6, SOLVED, 2, 2, 1, 0)                                  \
    X(DISSIPATION_WALL_WORK, 1, DISSIPATION, 7, JUMPS, 2, 2, 1, 0)                                 \
    X(STEPS, 1, SOLVER, 0, JUMPS, 0, 0, 0, 0)                                                      \
    X(ITERATIONS, 1, SOLVER, 1, JUMPS, 0, 0, 0, 0)
/* clang-format on */

#define SE3DI_QUANTITY(name, width, question, first, nature, length, rate, mass, lever)            \
    SE3DI_##name,
typedef enum se3di_quantity {
    SE3DI_QUANTITY_LIST(SE3DI_QUANTITY) SE3DI_QUANTITY_COUNT
} se3di_quantity;
#undef SE3DI_QUANTITY

/* What is asked of the system: one answer may serve many channels. */
typedef enum se3di_question {
    SE3DI_ASK_ITSELF, /* of bodies and markers: nothing but the channel's own numbers */
    SE3DI_ASK_REACTION,
    SE3DI_ASK_WRENCH,
    SE3DI_ASK_JOINT_ANGLE,
    SE3DI_ASK_JOINT_DISPLACEMENT,
    SE3DI_ASK_JOINT_BROKEN,
    SE3DI_ASK_DRIVER_VALUE,
    SE3DI_ASK_DRIVER_EFFORT,
    SE3DI_ASK_ARMATURE_MOTION,
    SE3DI_ASK_FORCE,
    SE3DI_ASK_STATE_VALUE,
    SE3DI_ASK_STATE_INPUT,
    SE3DI_ASK_STATE_RATE,
    SE3DI_ASK_STATE_ITSELF,
    SE3DI_ASK_WHEEL_POSE, /* the groups of se3d_wheel_measure */
    SE3DI_ASK_WHEEL_AXIS,
    SE3DI_ASK_WHEEL_RIDE,
    SE3DI_ASK_WHEEL_LOAD,
    SE3DI_ASK_TYRE,       /* se3d_tyre_value up to the slips, */
    SE3DI_ASK_TYRE_PLACE, /* and those from the inclination on */
    SE3DI_ASK_ENERGY,
    SE3DI_ASK_WORK,
    SE3DI_ASK_VIOLATION,
    SE3DI_ASK_CONTACTS_COUNT,
    SE3DI_ASK_CONTACTS_FORCE_MAX,
    SE3DI_ASK_PARTICLES,
    SE3DI_ASK_TALLY,   /* of a set */
    SE3DI_ASK_SOURCES, /* of a set */
    SE3DI_ASK_SINK,
    SE3DI_ASK_AVERAGE, /* of a region */
    SE3DI_ASK_PASSED,  /* of a flow */
    SE3DI_ASK_DISSIPATION,
    SE3DI_ASK_CELL,
    SE3DI_ASK_SERVO,
    SE3DI_ASK_BONDS, /* of a group */
    SE3DI_ASK_SOLVER,
    SE3DI_QUESTION_COUNT
} se3di_question;

/* How it changes. */
typedef enum se3di_quantity_nature {
    SE3DI_NATURE_MOTION, /* follows from time, positions and velocities */
    SE3DI_NATURE_LOADED, /* continuously: forces of elements (without friction) and works, if a run
                            shows the motion */
    SE3DI_NATURE_SOLVED, /* continuously, but forces or accelerations must be solved for */
    SE3DI_NATURE_JUMPS   /* counts, and what is proportional to them */
} se3di_quantity_nature;

typedef enum se3di_motion { SE3DI_MOTION_UNKNOWN, SE3DI_TRANSLATION, SE3DI_ROTATION } se3di_motion;

struct se3di_combination;

/* The body or marker that a motion is relative to (io/channel/relative.h). */
typedef struct se3di_reference {
    bool given;
    bool is_marker;
    se3d_body body;
    se3d_marker marker;
} se3di_reference;

typedef struct se3di_channel {
    const char *name;
    const struct se3di_combination *combination; /* of other channels; NULL: a quantity */
    se3di_quantity quantity;
    se3d_body body;
    se3d_marker marker;
    se3d_constraint constraint;
    se3d_force force;
    se3d_wheel wheel;
    se3d_state state;
    const se3d_particles *particles;
    const struct se3di_tagged *tagged; /* of sets and sinks */
    uint32_t index;                    /* tag of a set, number of a sink, region, ... */
    se3di_motion motion;               /* of the coordinate of an element */
    double point[3];                   /* of `body`, where a wrench acts */
    se3di_reference reference;         /* of a motion */
} se3di_channel;

/* A number made of others. */
typedef struct se3di_combination {
    const se3d_expression *expression; /* of the time and the parts; NULL: the first part itself */
    const se3di_channel *parts;        /* [count]; none is a combination */
    const size_t *components;          /* [count] of the parts, which are taken */
    size_t count;
} se3di_combination;

/* Find what `name` means. If it means nothing, `problem` gets what is allowed. */
bool se3di_channel_find(const se3d_model *model, const char *name, se3di_channel *channel,
                        char *problem, size_t problem_size);
/* The same for one number: a channel of one column, or a component of another as in
 * "bar.position.z".
 */
bool se3di_channel_find_number(se3d_model *model, const char *name, se3di_channel *channel,
                               size_t *component, char *problem, size_t problem_size);
/* What is asked for it, and the first of its numbers in the answer. */
se3di_question se3di_channel_get_question(const se3di_channel *channel, size_t *first);
/* Whether its numbers change in time continuously, unlike counts. */
bool se3di_channel_is_continuous(const se3di_channel *channel);
/* Whether they follow from time, positions and velocities. */
bool se3di_channel_is_of_motion(const se3di_channel *channel);
/* Whether a state that a run shows without accelerations and multipliers has them. */
bool se3di_channel_is_shown(const se3di_channel *channel);
/* How large its numbers are if they are not small, in the present state. */
double se3di_channel_get_scale(const se3di_channel *channel, const se3d_system *system);
/* Of a quantity, as far as its unit is known: what may be a translation or a rotation has none. */
se3di_dimension se3di_channel_get_dimension(const se3di_channel *channel);
/* What a results file shows of which nothing else is said: elements of a kind. */
enum { SE3DI_CHANNEL_ELEMENTS = 100 };
/* Every channel of the first `most` bodies, constraints and forces. @return NULL: out of memory. */
se3di_channel *se3di_channel_list_all(se3d_model *model, size_t most, size_t *count);

size_t se3di_channel_get_width(const se3di_channel *channel);
/* Write the name of column k to `text`. */
void se3di_channel_format_column(const se3di_channel *channel, size_t k, char *text, size_t size);
struct se3di_sample;
/* Compute the channel's numbers at the state of the sample (io/channel/sample.h). */
se3d_status se3di_channel_eval(const se3di_channel *channel, struct se3di_sample *sample,
                               double value[4]);

#endif
