/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/wheel_load.h"

#include "base/alloc.h"
#include "force/measure.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

void se3di_wheel_ride_init(se3di_wheel_motion *motion, const se3di_model *model,
                           const se3di_wheel *wheel, const double rates[2])
{
    *motion = (se3di_wheel_motion){.model = model,
                                   .wheel = wheel,
                                   .released = {wheel->travel, -1, -1},
                                   .prescribed = {{wheel, SE3DI_WHEEL_TRAVEL, rates[0]}},
                                   .prescribed_count = 1};
    if (wheel->opposite >= 0) {
        const se3di_wheel *opposite = &model->wheels[wheel->opposite];
        motion->released[1] = opposite->travel;
        motion->prescribed[1] = (se3di_wheel_prescription){opposite, SE3DI_WHEEL_TRAVEL, rates[1]};
        motion->prescribed_count = 2;
    }
}

static double dot6(const double *a, const double *b)
{
    return se3di_dot(a, b) + se3di_dot(a + 3, b + 3);
}

double se3di_wheel_spring_rate(const se3di_wheel_motion *motion, const se3di_wheel *wheel)
{
    se3di_measure length;
    if (wheel->spring < 0) {
        return (double)NAN;
    }
    const se3di_force *spring = &motion->model->forces[wheel->spring];
    if (!se3di_measure_length(motion->model, spring, 0, &length)) {
        return (double)NAN;
    }
    return dot6(length.g, motion->velocity + 6 * (size_t)spring->body_i) +
           dot6(length.g + 6, motion->velocity + 6 * (size_t)spring->body_j);
}

/* Whether an element is one of the suspension: between its bodies and the chassis, no friction, and
 * not from the ground, as a road that carries the wheel is. */
static int is_suspension(const se3di_wheel_motion *motion, const se3di_force *force)
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    int moves = 0;
    if (force->type == SE3DI_FORCE_FRICTION || force->type == SE3DI_FORCE_LOAD ||
        force->type == SE3DI_FORCE_TORQUE) {
        return 0;
    }
    for (int b = 0; b < 2; ++b) {
        if (motion->model->bodies[bodies[b]].fixed && bodies[b] != motion->wheel->chassis) {
            return 0;
        }
        moves |= motion->column[bodies[b]] >= 0;
    }
    return moves;
}

/* sums {Q . u, u . K u + Q . b} */
static se3d_status add_force(const se3di_wheel_motion *motion, const se3di_model *rest,
                             const se3di_force *force, double sums[2])
{
    se3di_effect effect = {.wants_derivative = 1};
    double u[12];
    double b[12];
    if (!is_suspension(motion, force)) {
        return SE3D_OK;
    }
    memcpy(u, motion->velocity + 6 * (size_t)force->body_i, 6 * sizeof *u);
    memcpy(u + 6, motion->velocity + 6 * (size_t)force->body_j, 6 * sizeof *u);
    memcpy(b, motion->acceleration + 6 * (size_t)force->body_i, 6 * sizeof *b);
    memcpy(b + 6, motion->acceleration + 6 * (size_t)force->body_j, 6 * sizeof *b);
    SE3DI_TRY(se3di_force_eval(rest, force, rest->time, &effect));
    for (size_t r = 0; r < 12; ++r) {
        double change = 0.0;
        for (size_t c = 0; c < 12; ++c) {
            change += effect.K[12 * r + c] * u[c];
        }
        sums[0] += effect.wrench[r] * u[r];
        sums[1] += u[r] * change + effect.wrench[r] * b[r];
    }
    return SE3D_OK;
}

static se3d_status add_all(const se3di_wheel_motion *motion, const se3di_model *rest,
                           double sums[2])
{
    double g[3];
    SE3DI_TRY(se3di_gravity_eval(rest, rest->time, g, NULL));
    for (size_t k = 0; k < rest->body_slots.count; ++k) {
        if (motion->column[k] >= 0) {
            sums[0] += rest->bodies[k].mass * se3di_dot(g, motion->velocity + 6 * k);
            sums[1] += rest->bodies[k].mass * se3di_dot(g, motion->acceleration + 6 * k);
        }
    }
    for (size_t k = 0; k < rest->force_slots.count; ++k) {
        SE3DI_TRY(add_force(motion, rest, &rest->forces[k], sums));
    }
    return SE3D_OK;
}

/* The same with all bodies at rest, so that dampers do nothing. */
static se3d_status add_at_rest(const se3di_wheel_motion *motion, double sums[2])
{
    const se3d_allocator *allocator = &motion->model->allocator;
    const size_t bodies = motion->model->body_slots.count;
    se3di_model rest = *motion->model; /* only looked at */
    rest.frames = se3di_alloc(allocator, bodies, sizeof *rest.frames);
    if (!rest.frames) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(rest.frames, motion->model->frames, bodies * sizeof *rest.frames);
    for (size_t k = 0; k < bodies; ++k) {
        const double zero[3] = {0.0, 0.0, 0.0};
        if (motion->model->bodies[k].state != 0) {
            continue;
        }
        se3di_copy(zero, rest.frames[k].v);
        se3di_copy(zero, rest.frames[k].w);
        se3di_frame_update(&rest.frames[k]);
    }
    const se3d_status status = add_all(motion, &rest, sums);
    se3di_free(allocator, rest.frames, bodies, sizeof *rest.frames);
    return status;
}

se3d_status se3di_wheel_load(se3di_wheel_motion *motion, const double rates[2], double *load,
                             double *rate)
{
    double sums[2] = {0.0, 0.0};
    SE3DI_TRY(se3di_wheel_motion_change(motion, rates));
    const int exists = motion->exists;
    if (exists) {
        SE3DI_TRY(se3di_wheel_motion_curve(motion));
        SE3DI_TRY(add_at_rest(motion, sums));
    }
    *load = exists ? 0.0 - sums[0] : (double)NAN;
    *rate = exists && motion->exists ? 0.0 - sums[1] : (double)NAN;
    return SE3D_OK;
}
