/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of channels at the present state. */
#include <string.h>

#include "io/channel/channel.h"
#include "io/channel/channel_flow.h"

static se3d_status eval_body(const se3di_channel *c, const se3d_system *system, double value[4])
{
    double torque[3];
    switch (c->quantity) {
    case SE3DI_BODY_POSITION:
        return se3d_body_get_position(system, c->body, value);
    case SE3DI_BODY_ORIENTATION:
        return se3d_body_get_orientation(system, c->body, value);
    case SE3DI_BODY_VELOCITY:
        return se3d_body_get_velocity(system, c->body, value);
    case SE3DI_BODY_ANGULAR_VELOCITY:
        return se3d_body_get_angular_velocity(system, c->body, value);
    case SE3DI_BODY_ACCELERATION:
        return se3d_body_get_acceleration(system, c->body, value);
    case SE3DI_BODY_ANGULAR_ACCELERATION:
        return se3d_body_get_angular_acceleration(system, c->body, value);
    case SE3DI_BODY_CONTACT_FORCE:
        return se3d_body_get_contact_wrench(system, c->body, value, torque);
    case SE3DI_MARKER_POSITION:
        return se3d_marker_get_position(system, c->marker, value);
    case SE3DI_MARKER_VELOCITY:
        return se3d_marker_get_velocity(system, c->marker, value);
    default:
        return se3d_marker_get_acceleration(system, c->marker, value);
    }
}

/* What an element does to its body j at its point there; the system knows it at the centre of
 * mass. */
static se3d_status eval_wrench(const se3di_channel *c, const se3d_system *system, double value[4])
{
    double w[6];
    double r[3];
    double at[3];
    se3d_status status = se3d_force_get_wrench(system, c->force, 1, w);
    if (status >= 0) {
        status = se3d_body_get_position(system, c->body, r);
    }
    if (status >= 0) {
        status = se3d_body_get_point(system, c->body, c->point, at);
    }
    if (status < 0) {
        return status;
    }
    const double s[3] = {at[0] - r[0], at[1] - r[1], at[2] - r[2]};
    for (size_t k = 0; k < 3; ++k) {
        const size_t i = (k + 1) % 3;
        const size_t j = (k + 2) % 3;
        value[k] =
            c->quantity == SE3DI_WRENCH_FORCE ? w[k] : w[3 + k] - (s[i] * w[j] - s[j] * w[i]);
    }
    return SE3D_OK;
}

static se3d_status eval_element(const se3di_channel *c, const se3d_system *system, double value[4])
{
    double other[3];
    se3d_status status;
    switch (c->quantity) {
    case SE3DI_REACTION_FORCE:
        return se3d_constraint_get_reaction(system, c->constraint, value, other);
    case SE3DI_WRENCH_FORCE:
    case SE3DI_WRENCH_TORQUE:
        return eval_wrench(c, system, value);
    case SE3DI_REACTION_TORQUE:
        return se3d_constraint_get_reaction(system, c->constraint, other, value);
    case SE3DI_JOINT_ANGLE:
    case SE3DI_JOINT_ANGLE_RATE:
        status = se3d_joint_get_coordinate(system, c->constraint, SE3D_JOINT_COORDINATE_ANGLE,
                                           &other[0], &other[1], &other[2]);
        value[0] = other[c->quantity == SE3DI_JOINT_ANGLE_RATE];
        return status;
    case SE3DI_JOINT_DISPLACEMENT:
    case SE3DI_JOINT_DISPLACEMENT_RATE:
        status =
            se3d_joint_get_coordinate(system, c->constraint, SE3D_JOINT_COORDINATE_DISPLACEMENT,
                                      &other[0], &other[1], &other[2]);
        value[0] = other[c->quantity == SE3DI_JOINT_DISPLACEMENT_RATE];
        return status;
    case SE3DI_DRIVER_VALUE:
        return se3d_driver_get_value(system, c->constraint, value);
    case SE3DI_DRIVER_EFFORT:
        return se3d_driver_get_effort(system, c->constraint, value);
    default:
        status = se3d_force_get_state(system, c->force, &other[0], &other[1], &other[2]);
        value[0] = other[c->quantity == SE3DI_FORCE_COORDINATE ? 0
                         : c->quantity == SE3DI_FORCE_RATE     ? 1
                                                               : 2];
        return status;
    }
}

static se3d_status eval_work(const se3di_channel *c, const se3d_system *system, double value[4])
{
    se3d_energy energy = {0.0, 0.0, 0.0, 0.0};
    se3d_work work = {0.0, 0.0, 0.0};
    se3d_status status = se3d_system_get_work(system, &work);
    if (status >= 0) {
        status = se3d_system_get_energy(system, &energy);
    }
    value[0] =
        c->quantity == SE3DI_WORK_ACTUATORS ? work.actuators
        : c->quantity == SE3DI_WORK_DRIVERS
            ? work.drivers
            : energy.kinetic + energy.potential + work.dissipated - work.actuators - work.drivers;
    return status;
}

static se3d_status eval_particles(const se3di_channel *c, double value[4])
{
    se3d_particles_stats stats = {.steps = 0};
    se3d_particles_energy energy = {0.0, 0.0, 0.0};
    se3d_status status = se3d_particles_get_stats(c->particles, &stats);
    if (status >= 0) {
        status = se3d_particles_get_energy(c->particles, &energy);
    }
    value[0] = c->quantity == SE3DI_PARTICLES_COUNT  ? (double)se3d_particles_count(c->particles)
               : c->quantity == SE3DI_PARTICLES_LOST ? (double)stats.lost
               : c->quantity == SE3DI_PARTICLES_LEFT
                   ? (double)stats.left
                   : energy.translation + energy.rotation + energy.potential;
    return status;
}

/* The number of points, or the largest force at one. */
static se3d_status eval_contacts(const se3di_channel *c, const se3d_system *system, double value[4])
{
    se3d_particles_stats stats = {.steps = 0};
    se3d_status status = SE3D_OK;
    if (c->quantity == SE3DI_CONTACTS_FORCE_MAX) {
        return se3d_system_get_contact_force_max(system, value);
    }
    if (c->particles) {
        status = se3d_particles_get_stats(c->particles, &stats);
    }
    value[0] = (double)(se3d_system_count_contacts(system) + stats.contacts);
    return status;
}

static se3d_status eval_energy(const se3di_channel *c, const se3d_system *system, double value[4])
{
    se3d_energy energy = {0.0, 0.0, 0.0, 0.0};
    const se3d_status status = se3d_system_get_energy(system, &energy);
    value[0] = c->quantity == SE3DI_ENERGY_KINETIC     ? energy.kinetic
               : c->quantity == SE3DI_ENERGY_POTENTIAL ? energy.potential
               : c->quantity == SE3DI_ENERGY_TOTAL     ? energy.total
                                                       : energy.dissipated;
    return status;
}

static se3d_status eval_violation(const se3di_channel *c, const se3d_system *system,
                                  double value[4])
{
    double violation[3] = {0.0, 0.0, 0.0};
    const se3d_status status = se3d_system_get_violation(system, violation);
    value[0] = violation[c->quantity == SE3DI_VIOLATION_POSITION   ? 0
                         : c->quantity == SE3DI_VIOLATION_VELOCITY ? 1
                                                                   : 2];
    return status;
}

se3d_status se3di_channel_eval(const se3di_channel *channel, const se3d_system *system,
                               const se3d_solver_stats *stats, double value[4])
{
    memset(value, 0, 4 * sizeof *value);
    switch (se3di_channel_get_group(channel)) {
    case SE3DI_GROUP_BODY:
        return eval_body(channel, system, value);
    case SE3DI_GROUP_ELEMENT:
        return eval_element(channel, system, value);
    case SE3DI_GROUP_ENERGY:
        return eval_energy(channel, system, value);
    case SE3DI_GROUP_WORK:
        return eval_work(channel, system, value);
    case SE3DI_GROUP_VIOLATION:
        return eval_violation(channel, system, value);
    case SE3DI_GROUP_CONTACTS:
        return eval_contacts(channel, system, value);
    case SE3DI_GROUP_PARTICLES:
        return eval_particles(channel, value);
    case SE3DI_GROUP_FLOW:
        return se3di_grains_eval(channel, value);
    case SE3DI_GROUP_SOLVER:
        break;
    }
    const bool steps = channel->quantity == SE3DI_STEPS;
    value[0] = !stats ? 0.0 : steps ? (double)stats->steps : (double)stats->iterations;
    return SE3D_OK;
}
