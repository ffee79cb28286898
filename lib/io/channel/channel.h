/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels: what can be written to a results file, by name. */
#ifndef SE3D_IO_CHANNEL_H
#define SE3D_IO_CHANNEL_H

#include "io/base/pool.h"
#include "se3d/io.h"

/* What a channel may give: columns, what computes it, how it changes in time, and its unit as
 * powers of the model's length, of 1/s and of its mass; of what may be a translation or a rotation,
 * the last number takes the larger. */
/* clang-format off */
#define SE3DI_QUANTITY_LIST(X)                                                                     \
    X(BODY_POSITION, 3, BODY, MOTION, 1, 0, 0, 0)                                                  \
    X(BODY_ORIENTATION, 4, BODY, MOTION, 0, 0, 0, 0)                                               \
    X(BODY_VELOCITY, 3, BODY, MOTION, 1, 1, 0, 0)                                                  \
    X(BODY_ANGULAR_VELOCITY, 3, BODY, MOTION, 0, 1, 0, 0)                                          \
    X(BODY_ACCELERATION, 3, BODY, SOLVED, 1, 2, 0, 0)                                              \
    X(BODY_ANGULAR_ACCELERATION, 3, BODY, SOLVED, 0, 2, 0, 0)                                      \
    X(BODY_CONTACT_FORCE, 3, BODY, SOLVED, 1, 2, 1, 0)                                             \
    X(MARKER_POSITION, 3, BODY, MOTION, 1, 0, 0, 0)                                                \
    X(MARKER_VELOCITY, 3, BODY, MOTION, 1, 1, 0, 0)                                                \
    X(MARKER_ACCELERATION, 3, BODY, SOLVED, 1, 2, 0, 0)                                            \
    X(WRENCH_FORCE, 3, ELEMENT, SOLVED, 1, 2, 1, 0)                                                \
    X(WRENCH_TORQUE, 3, ELEMENT, SOLVED, 2, 2, 1, 0)                                               \
    X(REACTION_FORCE, 3, ELEMENT, SOLVED, 1, 2, 1, 0)                                              \
    X(REACTION_TORQUE, 3, ELEMENT, SOLVED, 2, 2, 1, 0)                                             \
    X(JOINT_ANGLE, 1, ELEMENT, MOTION, 0, 0, 0, 0)                                                 \
    X(JOINT_ANGLE_RATE, 1, ELEMENT, MOTION, 0, 1, 0, 0)                                            \
    X(JOINT_DISPLACEMENT, 1, ELEMENT, MOTION, 1, 0, 0, 0)                                          \
    X(JOINT_DISPLACEMENT_RATE, 1, ELEMENT, MOTION, 1, 1, 0, 0)                                     \
    X(DRIVER_VALUE, 1, ELEMENT, SOLVED, 0, 0, 0, 1)                                                \
    X(DRIVER_EFFORT, 1, ELEMENT, SOLVED, 1, 2, 1, 1)                                               \
    X(FORCE_COORDINATE, 1, ELEMENT, MOTION, 0, 0, 0, 1)                                            \
    X(FORCE_RATE, 1, ELEMENT, MOTION, 0, 1, 0, 1)                                                  \
    X(FORCE_VALUE, 1, ELEMENT, SOLVED, 1, 2, 1, 1)                                                 \
    X(ENERGY_KINETIC, 1, ENERGY, MOTION, 2, 2, 1, 0)                                               \
    X(ENERGY_POTENTIAL, 1, ENERGY, MOTION, 2, 2, 1, 0)                                             \
    X(ENERGY_TOTAL, 1, ENERGY, MOTION, 2, 2, 1, 0)                                                 \
    X(ENERGY_DISSIPATED, 1, ENERGY, SOLVED, 2, 2, 1, 0)                                            \
    X(ENERGY_BALANCE, 1, WORK, SOLVED, 2, 2, 1, 0)                                                 \
    X(WORK_ACTUATORS, 1, WORK, SOLVED, 2, 2, 1, 0)                                                 \
    X(WORK_DRIVERS, 1, WORK, SOLVED, 2, 2, 1, 0)                                                   \
    X(VIOLATION_POSITION, 1, VIOLATION, SOLVED, 1, 0, 0, 0)                                        \
    X(VIOLATION_VELOCITY, 1, VIOLATION, SOLVED, 1, 1, 0, 0)                                        \
    X(VIOLATION_ACCELERATION, 1, VIOLATION, SOLVED, 1, 2, 0, 0)                                    \
    X(CONTACTS_COUNT, 1, CONTACTS, JUMPS, 0, 0, 0, 0)                                              \
    X(CONTACTS_FORCE_MAX, 1, CONTACTS, SOLVED, 1, 2, 1, 0)                                         \
    X(PARTICLES_COUNT, 1, PARTICLES, JUMPS, 0, 0, 0, 0)                                            \
    X(PARTICLES_LOST, 1, PARTICLES, JUMPS, 0, 0, 0, 0)                                             \
    X(PARTICLES_ENERGY, 1, PARTICLES, SOLVED, 2, 2, 1, 0)                                          \
    X(PARTICLES_LEFT, 1, PARTICLES, JUMPS, 0, 0, 0, 0)                                             \
    X(SET_COUNT, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                       \
    X(SET_LOST, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                        \
    X(SET_LEFT, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                        \
    X(SET_MASS, 1, FLOW, JUMPS, 0, 0, 1, 0)                                                        \
    X(SET_ENERGY, 1, FLOW, SOLVED, 2, 2, 1, 0)                                                     \
    X(SET_INSERTED, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                    \
    X(SET_DEFERRED, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                    \
    X(SET_WAITING, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                     \
    X(SINK_COUNT, 1, FLOW, JUMPS, 0, 0, 0, 0)                                                      \
    X(STEPS, 1, SOLVER, JUMPS, 0, 0, 0, 0)                                                         \
    X(ITERATIONS, 1, SOLVER, JUMPS, 0, 0, 0, 0)
/* clang-format on */

#define SE3DI_QUANTITY(name, width, group, nature, length, rate, mass, lever) SE3DI_##name,
typedef enum se3di_quantity {
    SE3DI_QUANTITY_LIST(SE3DI_QUANTITY) SE3DI_QUANTITY_COUNT
} se3di_quantity;
#undef SE3DI_QUANTITY

/* What computes it. */
typedef enum se3di_quantity_group {
    SE3DI_GROUP_BODY, /* and markers */
    SE3DI_GROUP_ELEMENT,
    SE3DI_GROUP_ENERGY,
    SE3DI_GROUP_WORK,
    SE3DI_GROUP_VIOLATION,
    SE3DI_GROUP_CONTACTS,
    SE3DI_GROUP_PARTICLES,
    SE3DI_GROUP_FLOW, /* sets and sinks */
    SE3DI_GROUP_SOLVER
} se3di_quantity_group;

/* How it changes. */
typedef enum se3di_quantity_nature {
    SE3DI_NATURE_MOTION, /* follows from time, positions and velocities */
    SE3DI_NATURE_SOLVED, /* continuously, but forces or accelerations must be solved for, or work
                            summed */
    SE3DI_NATURE_JUMPS   /* counts, and what is proportional to them */
} se3di_quantity_nature;

typedef struct se3di_channel {
    const char *name;
    se3di_quantity quantity;
    se3d_body body;
    se3d_marker marker;
    se3d_constraint constraint;
    se3d_force force;
    const se3d_particles *particles;
    const struct se3di_grains *grains; /* of sets and sinks */
    uint32_t index;                    /* tag of a set, number of a sink */
    uint32_t reserved;
    double point[3]; /* of `body`, where a wrench acts */
} se3di_channel;

/* Find what `name` means. If it means nothing, `problem` gets what is allowed. */
bool se3di_channel_find(const se3d_model *model, const char *name, se3di_channel *channel,
                        char *problem, size_t problem_size);
/* The same for one number: a channel of one column, or a component of another as in
 * "bar.position.z".
 */
bool se3di_channel_find_number(se3d_model *model, const char *name, se3di_channel *channel,
                               size_t *component, char *problem, size_t problem_size);
se3di_quantity_group se3di_channel_get_group(const se3di_channel *channel);
/* Whether its numbers change in time continuously, unlike counts. */
bool se3di_channel_is_continuous(const se3di_channel *channel);
/* Whether they follow from time, positions and velocities. */
bool se3di_channel_is_of_motion(const se3di_channel *channel);
/* How large its numbers are if they are not small, in the present state. */
double se3di_channel_get_scale(const se3di_channel *channel, const se3d_system *system);
/* Every channel of the first 100 bodies, constraints and forces. @return NULL: out of memory. */
se3di_channel *se3di_channel_list_all(se3d_model *model, size_t *count);

size_t se3di_channel_get_width(const se3di_channel *channel);
/* Write the name of column k to `text`. */
void se3di_channel_format_column(const se3di_channel *channel, size_t k, char *text, size_t size);
/* Compute the channel's numbers at the present state. */
se3d_status se3di_channel_eval(const se3di_channel *channel, const se3d_system *system,
                               const se3d_solver_stats *stats, double value[4]);

#endif
