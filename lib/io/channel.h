/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels: what can be written to a results file, by name. */
#ifndef SE3D_IO_CHANNEL_H
#define SE3D_IO_CHANNEL_H

#include "io/pool.h"
#include "se3d/io.h"

typedef enum se3di_quantity {
    SE3DI_BODY_POSITION,
    SE3DI_BODY_ORIENTATION,
    SE3DI_BODY_VELOCITY,
    SE3DI_BODY_ANGULAR_VELOCITY,
    SE3DI_BODY_ACCELERATION,
    SE3DI_BODY_ANGULAR_ACCELERATION,
    SE3DI_BODY_CONTACT_FORCE,
    SE3DI_MARKER_POSITION,
    SE3DI_MARKER_VELOCITY,
    SE3DI_MARKER_ACCELERATION,
    SE3DI_WRENCH_FORCE,
    SE3DI_WRENCH_TORQUE,
    SE3DI_REACTION_FORCE,
    SE3DI_REACTION_TORQUE,
    SE3DI_JOINT_ANGLE,
    SE3DI_JOINT_ANGLE_RATE,
    SE3DI_JOINT_DISPLACEMENT,
    SE3DI_JOINT_DISPLACEMENT_RATE,
    SE3DI_DRIVER_VALUE,
    SE3DI_DRIVER_EFFORT,
    SE3DI_FORCE_COORDINATE,
    SE3DI_FORCE_RATE,
    SE3DI_FORCE_VALUE,
    SE3DI_ENERGY_KINETIC,
    SE3DI_ENERGY_POTENTIAL,
    SE3DI_ENERGY_TOTAL,
    SE3DI_ENERGY_DISSIPATED,
    SE3DI_ENERGY_BALANCE,
    SE3DI_WORK_ACTUATORS,
    SE3DI_WORK_DRIVERS,
    SE3DI_VIOLATION_POSITION,
    SE3DI_VIOLATION_VELOCITY,
    SE3DI_VIOLATION_ACCELERATION,
    SE3DI_CONTACTS_COUNT,
    SE3DI_CONTACTS_FORCE_MAX,
    SE3DI_PARTICLES_COUNT,
    SE3DI_PARTICLES_LOST,
    SE3DI_PARTICLES_ENERGY,
    SE3DI_PARTICLES_LEFT,
    SE3DI_SET_COUNT,
    SE3DI_SET_LOST,
    SE3DI_SET_LEFT,
    SE3DI_SET_MASS,
    SE3DI_SET_ENERGY,
    SE3DI_SET_INSERTED,
    SE3DI_SET_DEFERRED,
    SE3DI_SET_WAITING,
    SE3DI_SINK_COUNT,
    SE3DI_STEPS,
    SE3DI_ITERATIONS
} se3di_quantity;

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

/* Find what `name` means. Where it means nothing, `problem` gets what is allowed. */
bool se3di_channel_find(const se3d_model *model, const char *name, se3di_channel *channel,
                        char *problem, size_t problem_size);
/* The same for one number: a channel of one column, or a component of another as in
 * "bar.position.z".
 */
bool se3di_channel_find_number(se3d_model *model, const char *name, se3di_channel *channel,
                               size_t *component, char *problem, size_t problem_size);
/* Whether its numbers change in time continuously, unlike counts. */
bool se3di_channel_is_continuous(const se3di_channel *channel);
/* Whether they follow from time, positions and velocities. */
bool se3di_channel_is_of_motion(const se3di_channel *channel);
/* How large its numbers are where they are not small, in the present state. */
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
