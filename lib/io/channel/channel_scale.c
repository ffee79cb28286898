/* SPDX-License-Identifier: BSD-3-Clause */
/* What is known of each quantity, and how large its numbers are if they are not small: products
 * of the model's length, its mass, and one second or the time in which gravity crosses the
 * length. */
#include <math.h>

#include "io/base/elementary.h"
#include "io/channel/channel.h"

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

typedef struct quantity {
    se3di_question question;
    size_t first;
    se3di_quantity_nature nature;
    int width, length, rate, mass, lever;
} quantity;

#define QUANTITY(name, width, question, first, nature, length, rate, mass, lever)                  \
    [SE3DI_##name] = {SE3DI_ASK_##question,                                                        \
                      (first),                                                                     \
                      SE3DI_NATURE_##nature,                                                       \
                      (width),                                                                     \
                      (length),                                                                    \
                      (rate),                                                                      \
                      (mass),                                                                      \
                      (lever)},
static const quantity quantities[SE3DI_QUANTITY_COUNT] = {SE3DI_QUANTITY_LIST(QUANTITY)};
#undef QUANTITY

double se3di_channel_get_scale(const se3di_channel *channel, const se3d_system *system)
{
    const sizes s = measure(system);
    const quantity *q = &quantities[channel->quantity];
    const double lever = q->lever ? fmax(1.0, s.length) : 1.0;
    return io_pow(s.length, q->length) * io_pow(s.rate, q->rate) * io_pow(s.mass, q->mass) * lever;
}

size_t se3di_channel_get_width(const se3di_channel *channel)
{
    return (size_t)quantities[channel->quantity].width;
}

se3di_question se3di_channel_get_question(const se3di_channel *channel, size_t *first)
{
    *first = quantities[channel->quantity].first;
    return quantities[channel->quantity].question;
}

bool se3di_channel_is_continuous(const se3di_channel *channel)
{
    return quantities[channel->quantity].nature != SE3DI_NATURE_JUMPS;
}

bool se3di_channel_is_of_motion(const se3di_channel *channel)
{
    return quantities[channel->quantity].nature == SE3DI_NATURE_MOTION;
}
