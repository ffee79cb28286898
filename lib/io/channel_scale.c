/* SPDX-License-Identifier: BSD-3-Clause */
/* How large the numbers of a channel are where they are not small: products of the model's length,
 * its mass, and one second or the time in which gravity crosses the length. */
#include <math.h>

#include "io/elementary.h"
#include "io/model.h"

typedef struct sizes {
    double length, rate, mass; /* [m], [1/s], [kg] */
} sizes;

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static sizes measure(const se3d_system *system)
{
    sizes s = {0.0, 1.0, 0.0};
    double r[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < se3d_system_count_bodies(system); ++k) {
        se3d_body body = {0, 0};
        double mass = 0.0, inertia[6];
        int32_t fixed = 0;
        se3d_system_get_body(system, k, &body);
        se3d_body_get_position(system, body, r);
        se3d_body_get_mass(system, body, &mass, inertia);
        se3d_body_get_fixed(system, body, &fixed);
        s.length = fmax(s.length, norm(r));
        s.mass += fixed ? 0.0 : mass;
    }
    for (size_t k = 0; k < se3d_system_count_markers(system); ++k) {
        se3d_marker marker = {0, 0};
        se3d_system_get_marker(system, k, &marker);
        se3d_marker_get_position(system, marker, r);
        s.length = fmax(s.length, norm(r));
    }
    double gravity[3] = {0.0, 0.0, 0.0};
    se3d_system_get_gravity(system, gravity);
    s.length = s.length > 0.0 ? s.length : 1.0;
    s.mass = s.mass > 0.0 ? s.mass : 1.0;
    s.rate = fmax(1.0, sqrt(norm(gravity) / s.length));
    return s;
}

/* Powers of the sizes in a quantity's unit; none: an angle, a parameter of a turn. Of what may be a
 * translation or a rotation, `lever` takes the larger. */
typedef struct unit {
    int length, rate, mass, lever;
} unit;

static const unit units[] = {
    [SE3DI_BODY_POSITION] = {1, 0, 0, 0},
    [SE3DI_BODY_VELOCITY] = {1, 1, 0, 0},
    [SE3DI_BODY_ANGULAR_VELOCITY] = {0, 1, 0, 0},
    [SE3DI_BODY_ACCELERATION] = {1, 2, 0, 0},
    [SE3DI_BODY_ANGULAR_ACCELERATION] = {0, 2, 0, 0},
    [SE3DI_BODY_CONTACT_FORCE] = {1, 2, 1, 0},
    [SE3DI_MARKER_POSITION] = {1, 0, 0, 0},
    [SE3DI_MARKER_VELOCITY] = {1, 1, 0, 0},
    [SE3DI_MARKER_ACCELERATION] = {1, 2, 0, 0},
    [SE3DI_WRENCH_FORCE] = {1, 2, 1, 0},
    [SE3DI_WRENCH_TORQUE] = {2, 2, 1, 0},
    [SE3DI_REACTION_FORCE] = {1, 2, 1, 0},
    [SE3DI_REACTION_TORQUE] = {2, 2, 1, 0},
    [SE3DI_JOINT_ANGLE_RATE] = {0, 1, 0, 0},
    [SE3DI_JOINT_DISPLACEMENT] = {1, 0, 0, 0},
    [SE3DI_JOINT_DISPLACEMENT_RATE] = {1, 1, 0, 0},
    [SE3DI_DRIVER_VALUE] = {0, 0, 0, 1},
    [SE3DI_DRIVER_EFFORT] = {1, 2, 1, 1},
    [SE3DI_FORCE_COORDINATE] = {0, 0, 0, 1},
    [SE3DI_FORCE_RATE] = {0, 1, 0, 1},
    [SE3DI_FORCE_VALUE] = {1, 2, 1, 1},
    [SE3DI_ENERGY_KINETIC] = {2, 2, 1, 0},
    [SE3DI_ENERGY_POTENTIAL] = {2, 2, 1, 0},
    [SE3DI_ENERGY_TOTAL] = {2, 2, 1, 0},
    [SE3DI_ENERGY_DISSIPATED] = {2, 2, 1, 0},
    [SE3DI_ENERGY_BALANCE] = {2, 2, 1, 0},
    [SE3DI_WORK_ACTUATORS] = {2, 2, 1, 0},
    [SE3DI_WORK_DRIVERS] = {2, 2, 1, 0},
    [SE3DI_VIOLATION_POSITION] = {1, 0, 0, 0},
    [SE3DI_VIOLATION_VELOCITY] = {1, 1, 0, 0},
    [SE3DI_VIOLATION_ACCELERATION] = {1, 2, 0, 0},
    [SE3DI_CONTACTS_FORCE_MAX] = {1, 2, 1, 0},
    [SE3DI_ITERATIONS] = {0, 0, 0, 0},
};

double se3di_channel_get_scale(const se3di_channel *channel, const se3d_system *system)
{
    const sizes s = measure(system);
    const unit u = units[channel->quantity];
    const double lever = u.lever ? fmax(1.0, s.length) : 1.0;
    return io_pow(s.length, u.length) * io_pow(s.rate, u.rate) * io_pow(s.mass, u.mass) * lever;
}
