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

static double quantity_scale(const se3di_channel *channel, const sizes *s)
{
    const quantity *q = &quantities[channel->quantity];
    const double lever = q->lever ? fmax(1.0, s->length) : 1.0;
    return io_pow(s->length, q->length) * io_pow(s->rate, q->rate) * io_pow(s->mass, q->mass) *
           lever;
}

/* How much an expression changes if each part changes by its scale, where they are as large. */
static double combination_scale(const se3di_combination *c, const sizes *s)
{
    double x[SE3D_EXPRESSION_VARIABLE_MAX] = {0.0};
    double gradient[SE3D_EXPRESSION_VARIABLE_MAX];
    double value = 0.0;
    double sum = 0.0;
    for (size_t k = 0; k < c->count; ++k) {
        x[k + 1] = quantity_scale(&c->parts[k], s);
        sum = fmax(sum, x[k + 1]);
    }
    if (!c->expression || se3d_expression_eval_gradient(c->expression, x, &value, gradient) < 0) {
        return sum;
    }
    sum = 0.0;
    for (size_t k = 1; k <= c->count; ++k) {
        sum += fabs(gradient[k]) * x[k];
    }
    return sum > 0.0 ? sum : 1.0;
}

double se3di_channel_get_scale(const se3di_channel *channel, const se3d_system *system)
{
    const sizes s = measure(system);
    return channel->combination ? combination_scale(channel->combination, &s)
                                : quantity_scale(channel, &s);
}

size_t se3di_channel_get_width(const se3di_channel *channel)
{
    return channel->combination ? 1 : (size_t)quantities[channel->quantity].width;
}

se3di_question se3di_channel_get_question(const se3di_channel *channel, size_t *first)
{
    *first = quantities[channel->quantity].first;
    return quantities[channel->quantity].question;
}

/* The least smooth of what it is made of. */
static se3di_quantity_nature nature_of(const se3di_channel *channel)
{
    const se3di_combination *c = channel->combination;
    se3di_quantity_nature nature = SE3DI_NATURE_MOTION;
    if (!c) {
        return quantities[channel->quantity].nature;
    }
    for (size_t k = 0; k < c->count; ++k) {
        const se3di_quantity_nature part = quantities[c->parts[k].quantity].nature;
        nature = part > nature ? part : nature;
    }
    return nature;
}

bool se3di_channel_is_continuous(const se3di_channel *channel)
{
    return nature_of(channel) != SE3DI_NATURE_JUMPS;
}

bool se3di_channel_is_of_motion(const se3di_channel *channel)
{
    return nature_of(channel) == SE3DI_NATURE_MOTION;
}

bool se3di_channel_is_shown(const se3di_channel *channel)
{
    const se3di_quantity_nature nature = nature_of(channel);
    return nature == SE3DI_NATURE_MOTION || nature == SE3DI_NATURE_LOADED;
}

se3di_dimension se3di_channel_get_dimension(const se3di_channel *channel)
{
    const quantity *q = &quantities[channel->quantity];
    const bool turns = channel->quantity == SE3DI_JOINT_ANGLE ||
                       channel->quantity == SE3DI_JOINT_ANGLE_RATE ||
                       channel->quantity == SE3DI_BODY_ANGULAR_VELOCITY ||
                       channel->quantity == SE3DI_BODY_ANGULAR_ACCELERATION;
    se3di_dimension d = {(int8_t)q->length, (int8_t)q->mass, (int8_t)-q->rate, (int8_t)turns};
    if (!q->lever) {
        return d;
    }
    const bool rotates = channel->motion == SE3DI_ROTATION;
    d.length = (int8_t)(q->mass ? 1 + rotates : !rotates);
    d.angle = (int8_t)(!q->mass && rotates);
    return channel->motion == SE3DI_MOTION_UNKNOWN ? (se3di_dimension){0, 0, 0, 0} : d;
}
