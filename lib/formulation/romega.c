/* SPDX-License-Identifier: BSD-3-Clause */
/* The r-omega formulation (Haug 1989, sec. 11.3): Newton-Euler equations with the angular velocity
 * in the body frame,
 *
 *     [m I  0] [a   ]                [F            ]
 *     [0    J] [wdot] + C^T lambda = [n - w x (J w)]
 *
 * The mass block is constant; orientations move on the group, p <- p exp(dpi).
 * docs/theory/formulations.md */
#include "formulation/formulation.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

static void mass(const se3di_body *body, const se3di_frame *frame, double *H)
{
    (void)frame;
    double J[9];
    se3di_inertia_matrix(body->J, J);
    memset(H, 0, 36 * sizeof *H);
    for (int r = 0; r < 3; ++r) {
        H[7 * r] = body->mass;
        for (int c = 0; c < 3; ++c) {
            H[6 * (r + 3) + c + 3] = J[3 * r + c];
        }
    }
}

static void velocity_terms(const se3di_body *body, const se3di_frame *frame, double *b)
{
    const double *J = body->J;
    const double *w = frame->w;
    double momentum[3] = {J[0] * w[0] + J[3] * w[1] + J[5] * w[2],
                          J[3] * w[0] + J[1] * w[1] + J[4] * w[2],
                          J[5] * w[0] + J[4] * w[1] + J[2] * w[2]};
    b[0] = b[1] = b[2] = 0.0;
    se3di_cross(momentum, w, b + 3);
}

static void jacobian(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                     double *phi_i, double *phi_j)
{
    se3di_primitives[term->type].jacobian_romega(term, i, j, phi_i, phi_j);
}

static double gamma_of(const se3di_term *term, const se3di_frame *i, const se3di_frame *j)
{
    return se3di_primitives[term->type].gamma_romega(term, i, j);
}

static void curvature(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                      double lambda, double *H)
{
    se3di_primitives[term->type].curvature_romega(term, i, j, lambda, H);
}

static void move(se3di_frame *frame, const double *dq)
{
    se3di_add(frame->r, dq, frame->r);
    se3di_quat_rotate(frame->p, dq + 3, frame->p);
    se3di_quat_normalize(frame->p, frame->p);
    se3di_frame_update(frame);
}

static void get_velocity(const se3di_frame *frame, double *qdot)
{
    se3di_copy(frame->v, qdot);
    se3di_copy(frame->w, qdot + 3);
}

static void set_velocity(se3di_frame *frame, const double *qdot)
{
    se3di_copy(qdot, frame->v);
    se3di_copy(qdot + 3, frame->w);
    se3di_quat_rate(frame->p, frame->w, frame->pdot);
}

double se3di_formulation_no_normalisation(const se3di_frame *frame)
{
    (void)frame;
    return 0.0;
}

void se3di_formulation_get_plain(const se3di_frame *frame, const double *qddot,
                                 double acceleration[6])
{
    (void)frame;
    memcpy(acceleration, qddot, 6 * sizeof *qddot);
}

void se3di_formulation_set_plain(const se3di_frame *frame, const double acceleration[6],
                                 double *qddot)
{
    (void)frame;
    memcpy(qddot, acceleration, 6 * sizeof *qddot);
}

void se3di_formulation_add_plain(const se3di_frame *frame, const double force[3],
                                 const double torque[3], double *Q)
{
    (void)frame;
    se3di_add(Q, force, Q);
    se3di_add(Q + 3, torque, Q + 3);
}

#define ROMEGA_TABLE                                                                               \
    .size = 6, .block = 6, .mass = mass, .velocity_terms = velocity_terms,                         \
    .add_wrench = se3di_formulation_add_plain, .jacobian = jacobian, .gamma = gamma_of,            \
    .curvature = curvature, .move = move, .normalisation = se3di_formulation_no_normalisation,     \
    .get_velocity = get_velocity, .set_velocity = set_velocity,                                    \
    .get_acceleration = se3di_formulation_get_plain,                                               \
    .set_acceleration = se3di_formulation_set_plain

const se3di_formulation se3di_formulation_romega = {
    .name = "romega",
    .id = SE3D_FORMULATION_ROMEGA,
    ROMEGA_TABLE,
};

/* Equations of bodies are those of r-omega. */
const se3di_formulation se3di_formulation_joint = {
    .name = "joint",
    .id = SE3D_FORMULATION_JOINT,
    ROMEGA_TABLE,
};

const se3di_formulation *se3di_formulation_find(int32_t id)
{
    switch (id) {
    case SE3D_FORMULATION_ROMEGA:
        return &se3di_formulation_romega;
    case SE3D_FORMULATION_RP:
        return &se3di_formulation_rp;
    case SE3D_FORMULATION_JOINT:
        return &se3di_formulation_joint;
    default:
        return NULL;
    }
}

const se3di_formulation *se3di_formulation_reduce(const se3di_formulation *formulation)
{
    return formulation == &se3di_formulation_rp ? &se3di_formulation_rp_tangent : formulation;
}
