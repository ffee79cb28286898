/* SPDX-License-Identifier: BSD-3-Clause */
/* The r-p formulation (Haug 1989, sec. 11.4; ME751): Euler parameters as coordinates,
 *
 *     [m I  0       0] [a   ]                [F                            ]
 *     [0    4G^TJG  p] [pdd ] + C^T lambda = [2 G^T n + 8 Gdot^T J Gdot p  ]
 *     [0    p^T     0] [lp  ]                [-pdot.pdot                   ]
 *
 * with the normalisation (p.p - 1)/2 = 0 as last row. With w = 2 G pdot and Gdot p = -G pdot the
 * velocity term is 8 Gdot^T J Gdot p = -4 Gdot^T J w.  docs/theory/formulations.md */
#include "formulation/formulation.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/euler_norm.h"

#include <string.h>

static void mass(const se3di_body *body, const se3di_frame *frame, double *H)
{
    double J[9];
    double G[12];
    double JG[12];
    se3di_inertia_matrix(body->J, J);
    se3di_g_matrix(frame->p, G);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            JG[4 * r + c] = J[3 * r] * G[c] + J[3 * r + 1] * G[4 + c] + J[3 * r + 2] * G[8 + c];
        }
    }
    memset(H, 0, 64 * sizeof *H);
    for (int r = 0; r < 3; ++r) {
        H[9 * r] = body->mass;
    }
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            H[8 * (r + 3) + c + 3] =
                4.0 * (G[r] * JG[c] + G[4 + r] * JG[4 + c] + G[8 + r] * JG[8 + c]);
        }
        H[8 * (r + 3) + 7] = frame->p[r];
        H[8 * 7 + r + 3] = frame->p[r];
    }
}

static void velocity_terms(const se3di_body *body, const se3di_frame *frame, double *b)
{
    const double *J = body->J;
    double w[3];
    se3di_quat_angular_velocity(frame->p, frame->pdot, w);
    double momentum[3] = {J[0] * w[0] + J[3] * w[1] + J[5] * w[2],
                          J[3] * w[0] + J[1] * w[1] + J[4] * w[2],
                          J[5] * w[0] + J[4] * w[1] + J[2] * w[2]};
    double turned[4];
    se3di_g_transposed_mul(frame->pdot, momentum, turned);
    b[0] = b[1] = b[2] = 0.0;
    for (int k = 0; k < 4; ++k) {
        b[3 + k] = -4.0 * turned[k];
    }
    b[7] = 0.5 * se3di_euler_norm_gamma(frame->pdot);
}

static void add_wrench(const se3di_frame *frame, const double force[3], const double torque[3],
                       double *Q)
{
    double turned[4];
    se3di_g_transposed_mul(frame->p, torque, turned);
    se3di_add(Q, force, Q);
    for (int k = 0; k < 4; ++k) {
        Q[3 + k] += 2.0 * turned[k];
    }
}

static void jacobian(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                     double *phi_i, double *phi_j)
{
    se3di_primitives[term->type].jacobian_rp(term, i, j, phi_i, phi_j);
}

static double gamma_of(const se3di_term *term, const se3di_frame *i, const se3di_frame *j)
{
    return se3di_primitives[term->type].gamma_rp(term, i, j);
}

static void curvature(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                      double lambda, double *H)
{
    se3di_primitives[term->type].curvature_rp(term, i, j, lambda, H);
}

/* p need not stay unit on the way: the normalisation is one of the equations. */
static void move(se3di_frame *frame, const double *dq)
{
    se3di_add(frame->r, dq, frame->r);
    for (int k = 0; k < 4; ++k) {
        frame->p[k] += dq[3 + k];
    }
    se3di_quat_to_matrix(frame->p, frame->A);
}

static double normalisation(const se3di_frame *frame)
{
    return -0.5 * se3di_euler_norm_value(frame->p);
}

static void get_velocity(const se3di_frame *frame, double *qdot)
{
    se3di_copy(frame->v, qdot);
    memcpy(qdot + 3, frame->pdot, 4 * sizeof *qdot);
}

static void set_velocity(se3di_frame *frame, const double *qdot)
{
    se3di_copy(qdot, frame->v);
    memcpy(frame->pdot, qdot + 3, 4 * sizeof *qdot);
    se3di_quat_angular_velocity(frame->p, frame->pdot, frame->w);
}

/* w = 2 G pdot, so wdot = 2 G pddot (Gdot pdot = 0). */
static void get_acceleration(const se3di_frame *frame, const double *qddot, double acceleration[6])
{
    se3di_copy(qddot, acceleration);
    se3di_quat_angular_velocity(frame->p, qddot + 3, acceleration + 3);
}

static void set_acceleration(const se3di_frame *frame, const double acceleration[6], double *qddot)
{
    se3di_copy(acceleration, qddot);
    se3di_quat_acceleration(frame->p, frame->w, acceleration + 3, qddot + 3);
}

const se3di_formulation se3di_formulation_rp = {
    .name = "rp",
    .id = SE3D_FORMULATION_RP,
    .size = 7,
    .block = 8,
    .mass = mass,
    .velocity_terms = velocity_terms,
    .add_wrench = add_wrench,
    .jacobian = jacobian,
    .gamma = gamma_of,
    .curvature = curvature,
    .move = move,
    .normalisation = normalisation,
    .get_velocity = get_velocity,
    .set_velocity = set_velocity,
    .get_acceleration = get_acceleration,
    .set_acceleration = set_acceleration,
};
