/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/start_change.h"

#include "base/log.h"
#include "integrator/state.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROUNDING 1e-9 /* of size and speed: what a start with ten digits says */

/* The angle between two orientations [rad]. */
static double angle_between(const double p[4], const double q[4])
{
    double dot = 0.0, square = 0.0;
    for (int k = 0; k < 4; ++k) {
        dot += p[k] * q[k];
    }
    for (int k = 0; k < 4; ++k) {
        const double d = q[k] - (dot < 0.0 ? -p[k] : p[k]);
        square += d * d;
    }
    return 2.0 * sqrt(square) < 1e-3 ? 2.0 * sqrt(square) : 2.0 * se3di_acos(fmin(1.0, fabs(dot)));
}

static double difference(const double a[3], const double b[3])
{
    double d[3];
    se3di_sub(b, a, d);
    return se3di_norm(d);
}

static double largest_speed(const se3di_model *model, const se3di_frame *given, double length)
{
    double speed = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *now = &model->frames[k];
        if (model->bodies[k].state != 0) {
            continue;
        }
        speed = fmax(speed, se3di_norm(given[k].v) + length * se3di_norm(given[k].w));
        speed = fmax(speed, se3di_norm(now->v) + length * se3di_norm(now->w));
    }
    return speed;
}

/* The change {translation, rotation} of body k to the sums; the body is kept if it is the most. */
static void take(const double change[2], double length, se3di_handle body, double sums[2],
                 double most[2], se3di_handle *which)
{
    sums[0] = se3di_hypot(sums[0], change[0]);
    sums[1] = se3di_hypot(sums[1], change[1]);
    if (change[0] + length * change[1] > most[0] + length * most[1]) {
        memcpy(most, change, 2 * sizeof *most);
        *which = body;
    }
}

/* Someone gave velocities: if all are zero, none was. */
static int has_velocities(const se3di_model *model, const se3di_frame *given)
{
    double sum = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        sum += model->bodies[k].state == 0 ? se3di_norm(given[k].v) + se3di_norm(given[k].w) : 0.0;
    }
    return sum > 0.0;
}

/* What is not more than rounding counts as zero. */
static void drop(double sums[2], double most[2], se3di_handle *which)
{
    sums[0] = sums[1] = most[0] = most[1] = 0.0;
    *which = (se3di_handle){0, 0};
}

void se3di_start_change_measure(const se3di_model *model, const se3di_frame *given, int driven,
                                se3di_start_change *change)
{
    const double length = se3di_state_length(model);
    const double speed = largest_speed(model, given, length);
    double moved[2] = {0.0, 0.0}, deflected[2] = {0.0, 0.0};
    *change = (se3di_start_change){.time = model->time};
    for (uint32_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *from = &given[k], *to = &model->frames[k];
        const double place[2] = {difference(from->r, to->r), angle_between(from->p, to->p)};
        const double rate[2] = {difference(from->v, to->v), difference(from->w, to->w)};
        const se3di_handle body = se3di_slots_handle(&model->body_slots, k);
        take(place, length, body, moved, change->most_position, &change->moved);
        take(rate, length, body, deflected, change->most_velocity, &change->deflected);
    }
    if (!(moved[0] + length * moved[1] > ROUNDING * length)) {
        drop(moved, change->most_position, &change->moved);
    }
    if (driven || !has_velocities(model, given) ||
        !(deflected[0] + length * deflected[1] > ROUNDING * speed)) {
        drop(deflected, change->most_velocity, &change->deflected);
    }
    change->position = moved[0];
    change->rotation = moved[1];
    change->velocity = deflected[0];
    change->angular_velocity = deflected[1];
}

static const char *name_of(const se3di_model *model, se3di_handle body, char text[32])
{
    const uint32_t k = se3di_slots_find(&model->body_slots, body.index1, body.generation);
    snprintf(text, 32, "number %u", (unsigned)k);
    return k != SE3DI_NO_INDEX && model->bodies[k].name ? model->bodies[k].name : text;
}

void se3di_start_change_log(const se3di_model *model, const se3di_start_change *change,
                            se3d_log_level level, se3di_error *error)
{
    char text[32];
    if (change->moved.index1 != 0) {
        se3di_log_write(
            error, level, SE3D_LOG_START,
            "t = %g s: the given positions do not fit the constraints and were moved by "
            "%.3g m and %.3g rad in all, body %.64s most, by %.3g m and %.3g rad",
            change->time, change->position, change->rotation, name_of(model, change->moved, text),
            change->most_position[0], change->most_position[1]);
    }
    if (change->deflected.index1 != 0) {
        se3di_log_write(
            error, level, SE3D_LOG_START,
            "t = %g s: the given velocities do not fit the constraints and were changed "
            "by %.3g m/s and %.3g rad/s in all, of body %.64s most, by %.3g m/s and "
            "%.3g rad/s",
            change->time, change->velocity, change->angular_velocity,
            name_of(model, change->deflected, text), change->most_velocity[0],
            change->most_velocity[1]);
    }
}
