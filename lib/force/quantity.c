/* SPDX-License-Identifier: BSD-3-Clause */
#include "force/quantity.h"

#include "force/signal.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

enum { PAIR = SE3DI_QUANTITY_PAIR };

static void take_measure(const se3di_measure *m, se3di_quantity *out)
{
    out->value = m->value;
    memcpy(out->q, m->g, sizeof out->q);
    memcpy(out->H, m->H, sizeof out->H);
}

void se3di_quantity_take_joint(const se3di_model *model, uint32_t joint, int32_t coordinate,
                               se3di_quantity *out)
{
    se3di_measure m;
    se3di_measure_joint(model, joint, coordinate, 1, &m);
    memcpy(out->bodies, model->constraints[joint].bodies, sizeof out->bodies);
    take_measure(&m, out);
}

/* e . (r + A s): q = (e, s x a), a = A^T e, and with da = a x dtheta
 * H = a s^T - (s . a) 1 of rotations. */
static void curve_point(const se3di_frame *frame, const se3di_signal *signal, se3di_quantity *out)
{
    const double *A = frame->A, *s = signal->point;
    const double a[3] = {A[3 * signal->component], A[3 * signal->component + 1],
                         A[3 * signal->component + 2]};
    const double sa = se3di_dot(s, a);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            out->H[PAIR * (9 + r) + 9 + c] = a[r] * s[c] - (r == c ? sa : 0.0);
        }
    }
}

/* p_k: q = 1/2 row k of G(p)^T, which is linear in p, and dp = 1/2 G^T dtheta. */
static void curve_orientation(const se3di_frame *frame, const se3di_signal *signal,
                              se3di_quantity *out)
{
    for (int c = 0; c < 3; ++c) {
        double e[3] = {0.0, 0.0, 0.0}, dp[4], G[12];
        e[c] = 0.5;
        se3di_g_transposed_mul(frame->p, e, dp);
        se3di_g_matrix(dp, G);
        for (int r = 0; r < 3; ++r) {
            out->H[PAIR * (9 + r) + 9 + c] = 0.5 * G[4 * r + signal->component];
        }
    }
}

se3d_status se3di_quantity_take(const se3di_model *model, const se3di_signal *signal, double t,
                                se3di_quantity *out)
{
    if (signal->kind == SE3D_SIGNAL_JOINT_COORDINATE) {
        se3di_quantity_take_joint(model, signal->joint, signal->component, out);
        return SE3D_OK;
    }
    if (signal->kind == SE3D_SIGNAL_FORCE_COORDINATE) {
        se3di_measure m;
        se3di_signal_bodies(model, signal, out->bodies);
        if (!se3di_measure_force(model, &model->forces[signal->force], 1, &m)) {
            return SE3D_ERR_NOT_FINITE;
        }
        take_measure(&m, out);
        return SE3D_OK;
    }
    se3di_signal_value value;
    const se3di_frame *frame = &model->frames[signal->body];
    SE3DI_TRY(se3di_signal_eval(model, signal, t, 1, &value));
    out->value = value.value;
    memcpy(out->bodies, value.bodies, sizeof out->bodies);
    memcpy(out->q, value.q, sizeof out->q);
    memset(out->H, 0, sizeof out->H);
    if (signal->kind == SE3D_SIGNAL_ORIENTATION) {
        curve_orientation(frame, signal, out);
    } else {
        curve_point(frame, signal, out);
    }
    return SE3D_OK;
}

void se3di_quantity_move(const se3di_model *model, se3di_quantity *out)
{
    double u[PAIR];
    for (int b = 0; b < 2; ++b) {
        se3di_copy(model->frames[out->bodies[b]].v, u + 6 * b);
        se3di_copy(model->frames[out->bodies[b]].w, u + 6 * b + 3);
    }
    out->rate = out->curve = 0.0;
    for (int r = 0; r < PAIR; ++r) {
        double row = 0.0;
        for (int c = 0; c < PAIR; ++c) {
            row += out->H[PAIR * r + c] * u[c];
        }
        out->rate += out->q[r] * u[r];
        out->curve += u[r] * row;
    }
}

/* Places of the bodies of a quantity in the driver's list; body_count: it is the ground, which is
 * not in the list. */
static void find_places(const se3di_constraint *constraint, const se3di_quantity *one,
                        uint32_t place[2])
{
    for (int b = 0; b < 2; ++b) {
        place[b] = 0;
        while (place[b] < constraint->body_count &&
               constraint->bodies[place[b]] != one->bodies[b]) {
            ++place[b];
        }
    }
}

void se3di_quantity_add_row(const se3di_constraint *constraint, const se3di_quantity *one,
                            double by, double *row)
{
    uint32_t place[2];
    find_places(constraint, one, place);
    for (int k = 0; k < PAIR; ++k) {
        if (place[k / 6] < constraint->body_count) {
            row[6 * place[k / 6] + (uint32_t)k % 6] += by * one->q[k];
        }
    }
}

void se3di_quantity_add_curvature(const se3di_constraint *constraint, const se3di_quantity *one,
                                  double by, double *H)
{
    const uint32_t n = 6 * constraint->body_count;
    uint32_t place[2];
    find_places(constraint, one, place);
    for (int k = 0; k < PAIR * PAIR; ++k) {
        const uint32_t r = place[k / PAIR / 6], c = place[k % PAIR / 6];
        if (r < constraint->body_count && c < constraint->body_count) {
            H[n * (6 * r + (uint32_t)(k / PAIR) % 6) + 6 * c + (uint32_t)k % 6] += by * one->H[k];
        }
    }
}

int se3di_quantity_add_body(se3di_constraint *constraint, uint32_t body)
{
    for (uint32_t k = 0; k < constraint->body_count; ++k) {
        if (constraint->bodies[k] == body) {
            return 1;
        }
    }
    if (constraint->body_count == SE3DI_NODE_BODIES_MAX) {
        return 0;
    }
    constraint->bodies[constraint->body_count++] = body;
    return 1;
}
