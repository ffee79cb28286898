/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/sketch_view.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "math/vec3.h"

#define RADIAN   0.017453292519943295 /* of a degree */
#define PARALLEL 1e-3                 /* rad between axes that count as parallel */

static void look_from(se3di_sketch_view *v, double azimuth, double elevation)
{
    const double ca = io_cos(azimuth);
    const double sa = io_sin(azimuth);
    const double ce = io_cos(elevation);
    const double se = io_sin(elevation);
    const double right[3] = {-sa, ca, 0.0};
    const double up[3] = {-ca * se, -sa * se, ce};
    const double toward[3] = {ca * ce, sa * ce, se};
    memcpy(v->right, right, sizeof right);
    memcpy(v->up, up, sizeof up);
    memcpy(v->toward, toward, sizeof toward);
}

void se3di_sketch_get_axis(const se3d_model *model, const double *poses,
                           const se3di_element_entry *entry, double axis[3])
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    const size_t i = se3di_drawing_find_body(model, entry->body_i);
    double from[3];
    double to[3];
    se3di_drawing_to_ground(poses + SE3DI_POSE * i, zero, from);
    se3di_drawing_to_ground(poses + SE3DI_POSE * i, entry->axis_i, to);
    double length = 0.0;
    for (int c = 0; c < 3; ++c) {
        axis[c] = to[c] - from[c];
        length += axis[c] * axis[c];
    }
    for (int c = 0; c < 3 && length > 0.0; ++c) {
        axis[c] /= sqrt(length);
    }
}

/* Whether all joints move in planes across one direction, which is that of the pins. */
static bool is_planar(const se3d_model *model, const double *poses, double normal[3])
{
    bool found = false;
    for (int pass = 0; pass < 2; ++pass) {
        for (size_t e = 0; e < model->element_count; ++e) {
            const se3di_joint_look look = se3di_joint_get_look(&model->elements[e]);
            double axis[3];
            if (look == SE3DI_JOINT_NONE || look == SE3DI_JOINT_BLOCK) {
                continue;
            }
            se3di_sketch_get_axis(model, poses, &model->elements[e], axis);
            const double along = fabs(se3di_dot(axis, normal));
            if (look == SE3DI_JOINT_PIN && !found) {
                memcpy(normal, axis, sizeof axis);
                found = true;
            } else if (pass == 1 &&
                       !(look == SE3DI_JOINT_PIN
                             ? along > 1.0 - 0.5 * PARALLEL * PARALLEL
                             : (look == SE3DI_JOINT_SLIDER || look == SE3DI_JOINT_ON_LINE) &&
                                   along < PARALLEL)) {
                return false;
            }
        }
    }
    return found;
}

/* From where a direction points to the eye: x or z forwards, y backwards, so that x is to the right
 * or upright axes are upright. */
static void look_along(se3di_sketch_view *v, const double normal[3])
{
    double n[3] = {normal[0], normal[1], normal[2]};
    int most = 0;
    for (int c = 1; c < 3; ++c) {
        most = fabs(n[c]) > fabs(n[most]) + 1e-9 ? c : most;
    }
    const double sign = (n[most] < 0.0) == (most == 1) ? 1.0 : -1.0;
    for (int c = 0; c < 3; ++c) {
        n[c] *= sign;
    }
    const double flat = sqrt(n[0] * n[0] + n[1] * n[1]);
    look_from(v, flat > 1e-9 ? io_atan2(n[1], n[0]) : -90.0 * RADIAN, io_atan2(n[2], flat));
}

enum { PLACES_MOST = 100 };

/* The points of the first joints in the ground frame. */
static size_t list_places(const se3d_model *model, const double *poses, double places[][3])
{
    size_t count = 0;
    for (size_t e = 0; e < model->element_count && count < PLACES_MOST; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (se3di_joint_get_look(entry) != SE3DI_JOINT_NONE) {
            const size_t j = se3di_drawing_find_body(model, entry->body_j);
            se3di_drawing_to_ground(poses + SE3DI_POSE * j, entry->point_j, places[count++]);
        }
    }
    return count;
}

/* How far the nearest two of the places are apart as they are seen, those left out that are
 * one. */
static double measure_gap(const se3di_sketch_view *v, double places[][3], size_t count)
{
    double least = HUGE_VAL;
    for (size_t a = 0; a < count; ++a) {
        for (size_t b = 0; b < a; ++b) {
            double d[3];
            for (int c = 0; c < 3; ++c) {
                d[c] = places[a][c] - places[b][c];
            }
            const double x = se3di_dot(v->right, d);
            const double y = se3di_dot(v->up, d);
            if (se3di_dot(d, d) > 1e-12) {
                least = fmin(least, x * x + y * y);
            }
        }
    }
    return least;
}

void se3di_sketch_turn(se3di_sketch_view *view, const double angles[2], const se3d_model *model,
                       const double *poses)
{
    double places[PLACES_MOST][3];
    double normal[3] = {0.0, 0.0, 0.0};
    double best[2] = {-60.0 * RADIAN, 25.0 * RADIAN};
    if (angles) {
        look_from(view, angles[0], angles[1]);
        return;
    }
    if (is_planar(model, poses, normal)) {
        look_along(view, normal);
        return;
    }
    const size_t count = list_places(model, poses, places);
    look_from(view, best[0], best[1]);
    double most = measure_gap(view, places, count);
    for (int k = 0; k < 8; ++k) {
        const double azimuth = (k < 4 ? -75.0 + 15.0 * k : 15.0 + 15.0 * (k - 4)) * RADIAN;
        look_from(view, azimuth, 25.0 * RADIAN);
        const double gap = measure_gap(view, places, count);
        if (gap > 1.2 * most) {
            most = gap;
            best[0] = azimuth;
        }
    }
    look_from(view, best[0], best[1]);
}

se3di_spot se3di_sketch_project(const se3di_sketch_view *v, const double r[3])
{
    const se3di_spot spot = {v->origin.x + v->scale * se3di_dot(v->right, r),
                             v->origin.y - v->scale * se3di_dot(v->up, r)};
    return spot;
}
