/* SPDX-License-Identifier: BSD-3-Clause */
/* Motion relative to a frame that moves itself. With d = r - r0, A0 the frame's orientation, w0 and
 * alpha0 its angular velocity and acceleration, all in the ground frame (Goldstein, Classical
 * Mechanics, section 4.10):
 *
 *     position      A0^T d
 *     velocity      A0^T u,  u = v - v0 - w0 x d
 *     acceleration  A0^T (a - a0 - alpha0 x d - w0 x (w0 x d) - 2 w0 x u)
 *     orientation   A0^T A
 *     angular velocity and acceleration   A0^T (w - w0),  A0^T (alpha - alpha0 - w0 x w) */
#include "io/channel/relative.h"

#include <stdio.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/model/model.h"
#include "math/vec3.h"

/* Of a point with axes; all vectors in the ground frame. */
typedef struct motion {
    double r[3], v[3], a[3];
    double A[9]; /* to ground, row-major */
    double w[3], alpha[3];
} motion;

bool se3di_channel_can_be_relative(const se3di_channel *channel)
{
    switch (channel->quantity) {
    case SE3DI_BODY_POSITION:
    case SE3DI_BODY_ORIENTATION:
    case SE3DI_BODY_VELOCITY:
    case SE3DI_BODY_ANGULAR_VELOCITY:
    case SE3DI_BODY_ACCELERATION:
    case SE3DI_BODY_ANGULAR_ACCELERATION:
    case SE3DI_MARKER_POSITION:
    case SE3DI_MARKER_ORIENTATION:
    case SE3DI_MARKER_VELOCITY:
    case SE3DI_MARKER_ANGULAR_VELOCITY:
    case SE3DI_MARKER_ACCELERATION:
    case SE3DI_MARKER_ANGULAR_ACCELERATION:
        return !channel->reference.given;
    default:
        return false;
    }
}

bool se3di_reference_find(const se3d_model *model, const char *name, se3di_reference *reference,
                          char *problem, size_t size)
{
    char head[320];
    size_t index = 0;
    snprintf(head, sizeof head, "%s", name);
    char *marker = strchr(head, '.');
    if (marker) {
        *marker++ = '\0';
    }
    if (!se3di_ionames_find(&model->body_names, head, &index)) {
        snprintf(problem, size, "`%.60s` behind @ is unknown, must be a body or body.marker", head);
        return false;
    }
    const se3di_body_entry *body = &model->bodies[index];
    *reference = (se3di_reference){.given = true, .body = body->body};
    if (marker && !se3di_ionames_find(&body->markers, marker, &index)) {
        snprintf(problem, size, "`%.60s` has no marker named `%.60s`", body->name, marker);
        return false;
    }
    if (marker) {
        reference->is_marker = true;
        reference->marker = model->markers[index].marker;
    }
    return true;
}

/* Angular velocity and, if asked for, acceleration of a body, turned to the ground frame. */
static se3d_status get_turning(const se3d_system *system, se3d_body body, bool accelerates,
                               motion *m)
{
    double p[4];
    double A[9];
    double w[3];
    double alpha[3] = {0.0, 0.0, 0.0};
    se3d_status status = se3d_body_get_orientation(system, body, p);
    status = status < 0 ? status : se3d_body_get_angular_velocity(system, body, w);
    if (status >= 0 && accelerates) {
        status = se3d_body_get_angular_acceleration(system, body, alpha);
    }
    if (status >= 0) {
        se3di_rotation_to_matrix(p, A);
        se3di_mul(A, w, m->w);
        se3di_mul(A, alpha, m->alpha);
    }
    return status;
}

static se3d_status get_motion(const se3d_system *system, const se3di_reference *of,
                              bool accelerates, motion *m)
{
    double p[4];
    se3d_body body = of->body;
    memset(m, 0, sizeof *m);
    se3d_status status = of->is_marker ? se3d_marker_get_body(system, of->marker, &body) : SE3D_OK;
    status = status < 0 ? status : get_turning(system, body, accelerates, m);
    if (status < 0) {
        return status;
    }
    if (of->is_marker) {
        status = se3d_marker_get_position(system, of->marker, m->r);
        status = status < 0 ? status : se3d_marker_get_orientation(system, of->marker, p);
        status = status < 0 ? status : se3d_marker_get_velocity(system, of->marker, m->v);
        if (status >= 0 && accelerates) {
            status = se3d_marker_get_acceleration(system, of->marker, m->a);
        }
    } else {
        status = se3d_body_get_position(system, body, m->r);
        status = status < 0 ? status : se3d_body_get_orientation(system, body, p);
        status = status < 0 ? status : se3d_body_get_velocity(system, body, m->v);
        if (status >= 0 && accelerates) {
            status = se3d_body_get_acceleration(system, body, m->a);
        }
    }
    if (status >= 0) {
        se3di_rotation_to_matrix(p, m->A);
    }
    return status;
}

static void get_orientation(const motion *m, const motion *of, double p[4])
{
    double A[9];
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
            A[3 * i + j] =
                of->A[i] * m->A[j] + of->A[3 + i] * m->A[3 + j] + of->A[6 + i] * m->A[6 + j];
        }
    }
    se3di_rotation_from_matrix(A, p);
}

static void get_angular_acceleration(const motion *m, const motion *of, double out[3])
{
    double turned[3];
    se3di_cross(of->w, m->w, turned);
    for (size_t k = 0; k < 3; ++k) {
        out[k] = m->alpha[k] - of->alpha[k] - turned[k];
    }
}

/* d, u and the relative acceleration of the head of this file. */
static void get_translation(const motion *m, const motion *of, double d[3], double u[3],
                            double a[3])
{
    double swept[3];
    double euler[3];
    double inner[3];
    double coriolis[3];
    for (size_t k = 0; k < 3; ++k) {
        d[k] = m->r[k] - of->r[k];
    }
    se3di_cross(of->w, d, swept);
    se3di_cross(of->alpha, d, euler);
    se3di_cross(of->w, swept, inner);
    for (size_t k = 0; k < 3; ++k) {
        u[k] = m->v[k] - of->v[k] - swept[k];
    }
    se3di_cross(of->w, u, coriolis);
    for (size_t k = 0; k < 3; ++k) {
        a[k] = m->a[k] - of->a[k] - euler[k] - inner[k] - 2.0 * coriolis[k];
    }
}

se3d_status se3di_relative_eval(const se3di_channel *channel, const se3d_system *system,
                                double value[4])
{
    const se3di_quantity q = channel->quantity;
    const bool accelerates = q == SE3DI_BODY_ACCELERATION || q == SE3DI_MARKER_ACCELERATION ||
                             q == SE3DI_BODY_ANGULAR_ACCELERATION ||
                             q == SE3DI_MARKER_ANGULAR_ACCELERATION;
    const se3di_reference self = {
        .is_marker = channel->marker.index1 != 0, .body = channel->body, .marker = channel->marker};
    motion m;
    motion of;
    double d[3];
    double u[3];
    double a[3];
    se3d_status status = get_motion(system, &self, accelerates, &m);
    status = status < 0 ? status : get_motion(system, &channel->reference, accelerates, &of);
    if (status < 0) {
        return status;
    }
    get_translation(&m, &of, d, u, a);
    switch (q) {
    case SE3DI_BODY_POSITION:
    case SE3DI_MARKER_POSITION:
        se3di_mul_transposed(of.A, d, value);
        break;
    case SE3DI_BODY_VELOCITY:
    case SE3DI_MARKER_VELOCITY:
        se3di_mul_transposed(of.A, u, value);
        break;
    case SE3DI_BODY_ACCELERATION:
    case SE3DI_MARKER_ACCELERATION:
        se3di_mul_transposed(of.A, a, value);
        break;
    case SE3DI_BODY_ORIENTATION:
    case SE3DI_MARKER_ORIENTATION:
        get_orientation(&m, &of, value);
        break;
    case SE3DI_BODY_ANGULAR_VELOCITY:
    case SE3DI_MARKER_ANGULAR_VELOCITY:
        for (size_t k = 0; k < 3; ++k) {
            u[k] = m.w[k] - of.w[k];
        }
        se3di_mul_transposed(of.A, u, value);
        break;
    default:
        get_angular_acceleration(&m, &of, a);
        se3di_mul_transposed(of.A, a, value);
        break;
    }
    return SE3D_OK;
}
