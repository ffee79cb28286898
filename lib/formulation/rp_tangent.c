/* SPDX-License-Identifier: BSD-3-Clause */
/* The r-p formulation with its normalisation eliminated in closed form, for methods whose unknowns
 * are accelerations or corrections only. On the tangent of |p| = 1, with |p| = 1 exact,
 *
 *     pddot = 1/2 G^T alpha - (pdot.pdot) p        dp = 1/2 G^T alpha
 *
 * so that the body block 1/4 G (4 G^T J G) G^T = J is constant, and a row (Phi_p, gamma) of r-p is
 *
 *     (1/2 Phi_p G^T) alpha = gamma + (pdot.pdot) Phi_p p
 *
 * The unknowns are those of r-omega, alpha = wdot; the Jacobians, velocity terms and the way p
 * moves are those of r-p; torques act as they are: 1/2 G (2 G^T n) = n.
 * docs/theory/formulations.md */
#include "formulation/formulation.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

/* 1/2 G x for x in the space of p */
static void project(const double p[4], const double x[4], double out[3])
{
    se3di_g_mul(p, x, out);
    se3di_scale(0.5, out, out);
}

static double dot4(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

static void mass(const se3di_body *body, const se3di_frame *frame, double *H)
{
    se3di_formulation_romega.mass(body, frame, H);
}

/* 1/2 G (-4 Gdot^T J w) */
static void velocity_terms(const se3di_body *body, const se3di_frame *frame, double *b)
{
    const double *J = body->J;
    double w[3], turned[4];
    se3di_quat_angular_velocity(frame->p, frame->pdot, w);
    const double momentum[3] = {J[0] * w[0] + J[3] * w[1] + J[5] * w[2],
                                J[3] * w[0] + J[1] * w[1] + J[4] * w[2],
                                J[5] * w[0] + J[4] * w[1] + J[2] * w[2]};
    se3di_g_transposed_mul(frame->pdot, momentum, turned);
    b[0] = b[1] = b[2] = 0.0;
    project(frame->p, turned, b + 3);
    se3di_scale(-4.0, b + 3, b + 3);
}

static void jacobian(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                     double *phi_i, double *phi_j)
{
    double full_i[7], full_j[7];
    se3di_primitives[term->type].jacobian_rp(term, i, j, full_i, full_j);
    se3di_copy(full_i, phi_i);
    se3di_copy(full_j, phi_j);
    project(i->p, full_i + 3, phi_i + 3);
    project(j->p, full_j + 3, phi_j + 3);
}

static double gamma_of(const se3di_term *term, const se3di_frame *i, const se3di_frame *j)
{
    double phi_i[7], phi_j[7];
    se3di_primitives[term->type].jacobian_rp(term, i, j, phi_i, phi_j);
    return se3di_primitives[term->type].gamma_rp(term, i, j) +
           dot4(i->pdot, i->pdot) * dot4(phi_i + 3, i->p) +
           dot4(j->pdot, j->pdot) * dot4(phi_j + 3, j->p);
}

/* The derivative of Phi_q^T lambda to a turn of the body frame, which is what it is in r-omega. */
static void curvature(const se3di_term *term, const se3di_frame *i, const se3di_frame *j,
                      double lambda, double *H)
{
    se3di_formulation_romega.curvature(term, i, j, lambda, H);
}

static void move(se3di_frame *frame, const double *dq)
{
    double dp[4];
    se3di_add(frame->r, dq, frame->r);
    se3di_g_transposed_mul(frame->p, dq + 3, dp);
    for (int k = 0; k < 4; ++k) {
        frame->p[k] += 0.5 * dp[k];
    }
    (void)se3di_quat_normalize(frame->p, frame->p);
    se3di_frame_update(frame);
}

static void get_velocity(const se3di_frame *frame, double *qdot)
{
    se3di_copy(frame->v, qdot);
    se3di_quat_angular_velocity(frame->p, frame->pdot, qdot + 3);
}

static void set_velocity(se3di_frame *frame, const double *qdot)
{
    se3di_copy(qdot, frame->v);
    se3di_quat_rate(frame->p, qdot + 3, frame->pdot);
    se3di_quat_angular_velocity(frame->p, frame->pdot, frame->w);
}

const se3di_formulation se3di_formulation_rp_tangent = {
    .name = "rp",
    .id = SE3D_FORMULATION_RP,
    .size = 6,
    .block = 6,
    .mass = mass,
    .velocity_terms = velocity_terms,
    .add_wrench = se3di_formulation_add_plain,
    .jacobian = jacobian,
    .gamma = gamma_of,
    .curvature = curvature,
    .move = move,
    .normalisation = se3di_formulation_no_normalisation,
    .get_velocity = get_velocity,
    .set_velocity = set_velocity,
    .get_acceleration = se3di_formulation_get_plain,
    .set_acceleration = se3di_formulation_set_plain,
};
