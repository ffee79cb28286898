/* SPDX-License-Identifier: BSD-3-Clause */
#include "joint/equation.h"

#include "joint/rows.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"
#include "primitive/user.h"

#include <math.h>
#include <string.h>

#define PI     3.1415926535897932384626433832795
#define TWO_PI 6.283185307179586476925286766559

int se3di_coordinate_term(const se3di_model *model, uint32_t joint, int32_t coordinate,
                          se3di_term *term)
{
    const se3di_constraint *constraint = &model->constraints[joint];
    if (coordinate == SE3D_JOINT_COORDINATE_ANGLE && constraint->angle >= 0) {
        *term = model->angles[constraint->angle].term;
        term->angle = constraint->angle;
        return 1;
    }
    if (coordinate == SE3D_JOINT_COORDINATE_DISPLACEMENT && constraint->has_displacement) {
        se3di_displacement_term_init(term, &constraint->frames, constraint->bodies);
        return 1;
    }
    return 0;
}

void se3di_term_motion(const se3di_model *model, const se3di_term *term, int count,
                       double motion[3])
{
    const se3di_primitive *primitive = &se3di_primitives[term->type];
    const uint32_t bodies[2] = {term->body_i, term->body_j};
    const se3di_frame *i = &model->frames[bodies[0]];
    const se3di_frame *j = &model->frames[bodies[1]];
    double phi[2][6];
    primitive->jacobian_romega(term, i, j, phi[0], phi[1]);
    motion[0] = se3di_term_value(model, term);
    motion[1] = 0.0;
    motion[2] = count > 2 ? -primitive->gamma_romega(term, i, j) : 0.0;
    for (int b = 0; b < 2; ++b) {
        const se3di_frame *frame = &model->frames[bodies[b]];
        const double *a = &model->acceleration[6 * bodies[b]];
        motion[1] += se3di_dot(phi[b], frame->v) + se3di_dot(phi[b] + 3, frame->w);
        if (count > 2) { /* else another reader may be at the accelerations */
            motion[2] += se3di_dot(phi[b], a) + se3di_dot(phi[b] + 3, a + 3);
        }
    }
}

se3d_status se3di_row_prescribed(const se3di_model *model, const se3di_row *row, double jet[3])
{
    jet[0] = row->value;
    jet[1] = jet[2] = 0.0;
    if (row->function < 0) {
        return SE3D_OK;
    }
    return se3di_function_eval(&model->functions[row->function], &model->time, jet, NULL);
}

/* phi, nu, gamma of one row. */
static se3d_status row_eval(const se3di_model *model, const se3di_row *row,
                            se3d_formulation formulation, double result[3])
{
    double jet[3];
    SE3DI_TRY(se3di_row_prescribed(model, row, jet));
    double phi = -jet[0];
    double gamma = jet[2];
    for (uint32_t k = row->term_begin; k < row->term_begin + row->term_count; ++k) {
        const se3di_term *term = &model->terms[k];
        const se3di_primitive *primitive = &se3di_primitives[term->type];
        const se3di_frame *i = &model->frames[term->body_i];
        const se3di_frame *j = &model->frames[term->body_j];
        double g = formulation == SE3D_FORMULATION_RP ? primitive->gamma_rp(term, i, j)
                                                      : primitive->gamma_romega(term, i, j);
        phi += se3di_term_value(model, term);
        gamma += term->coefficient * g;
    }
    if (row->wrap) {
        phi = remainder(phi, TWO_PI);
        phi = phi <= -PI ? phi + TWO_PI : phi;
    }
    result[0] = phi;
    result[1] = jet[1];
    result[2] = gamma;
    return se3di_is_finite(result, 3) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_equation_eval(const se3di_model *model, const se3di_constraint *constraint,
                                uint32_t r, se3d_formulation formulation, double result[3])
{
    if (!se3di_is_user(constraint)) {
        return row_eval(model, &model->rows[constraint->row_begin + r], formulation, result);
    }
    se3di_user_values values;
    SE3DI_TRY(se3di_user_eval(model, constraint, model->time,
                              SE3DI_USER_PHI | SE3DI_USER_NU | SE3DI_USER_GAMMA, &values));
    result[0] = values.phi[r];
    result[1] = values.nu[r];
    result[2] = values.gamma[r];
    return SE3D_OK;
}

/* Jacobian of a row with respect to one body: 3 + 3 (r-omega) or 3 + 4 (r-p) numbers. */
static void row_jacobian(const se3di_model *model, const se3di_row *row,
                         se3d_formulation formulation, uint32_t body, double out[7])
{
    int width = formulation == SE3D_FORMULATION_RP ? 7 : 6;
    memset(out, 0, 7 * sizeof *out);
    for (uint32_t k = row->term_begin; k < row->term_begin + row->term_count; ++k) {
        const se3di_term *term = &model->terms[k];
        const se3di_primitive *primitive = &se3di_primitives[term->type];
        const uint32_t bodies[2] = {term->body_i, term->body_j};
        double phi[2][7];
        (width == 7 ? primitive->jacobian_rp : primitive->jacobian_romega)(
            term, &model->frames[bodies[0]], &model->frames[bodies[1]], phi[0], phi[1]);
        for (int b = 0; b < 2; ++b) {
            for (int c = 0; c < width && bodies[b] == body; ++c) {
                out[c] += term->coefficient * phi[b][c];
            }
        }
    }
}

/* The same of row r of a user constraint. */
static se3d_status user_jacobian(const se3di_model *model, const se3di_constraint *constraint,
                                 uint32_t r, se3d_formulation formulation, uint32_t body,
                                 double out[7])
{
    se3di_user_values values;
    memset(out, 0, 7 * sizeof *out);
    SE3DI_TRY(se3di_user_eval(model, constraint, model->time, SE3DI_USER_JACOBIAN, &values));
    for (uint32_t k = constraint->user_first; k < constraint->body_count; ++k) {
        const double *row = se3di_user_row(constraint, &values, r, k - constraint->user_first);
        if (constraint->bodies[k] != body) {
            continue;
        }
        memcpy(out, row, 6 * sizeof *out);
        if (formulation == SE3D_FORMULATION_RP) {
            se3di_g_transposed_mul(model->frames[body].p, row + 3, out + 3);
            for (int c = 3; c < 7; ++c) {
                out[c] *= 2.0;
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_equation_jacobian(const se3di_model *model, const se3di_constraint *constraint,
                                    uint32_t r, se3d_formulation formulation, uint32_t body,
                                    double out[7])
{
    if (se3di_is_user(constraint)) {
        return user_jacobian(model, constraint, r, formulation, body, out);
    }
    row_jacobian(model, &model->rows[constraint->row_begin + r], formulation, body, out);
    return se3di_is_finite(out, 7) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* What a constraint does to one body: force and moment about the centre of mass, ground frame. Not
 * a number if a callback fails. */
static void compute_wrench(const se3di_model *model, const se3di_constraint *constraint,
                           uint32_t body, double force[3], double torque[3])
{
    double moment[3] = {0.0, 0.0, 0.0}; /* body frame */
    memset(force, 0, 3 * sizeof *force);
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        double row[7];
        double lambda = model->lambda[constraint->row_begin + r];
        if (se3di_equation_jacobian(model, constraint, r, SE3D_FORMULATION_ROMEGA, body, row) < 0) {
            row[0] = row[3] = (double)NAN; /* the caller reports NOT_FINITE */
        }
        se3di_add_scaled(-lambda, row, force);
        se3di_add_scaled(-lambda, row + 3, moment);
    }
    se3di_mul(model->frames[body].A, moment, torque);
}

void se3di_constraint_reaction(const se3di_model *model, const se3di_constraint *constraint,
                               size_t slot, const double *point, double wrench[6])
{
    uint32_t body = constraint->bodies[slot];
    double P[3], arm[3], moment[3];
    if (point) {
        se3di_copy(point, P);
    } else {
        const se3di_frame *j = &model->frames[constraint->bodies[1]];
        se3di_mul(j->A, constraint->frames.point_j, P);
        se3di_add(P, j->r, P);
    }
    compute_wrench(model, constraint, body, wrench, wrench + 3);
    se3di_sub(model->frames[body].r, P, arm);
    se3di_cross(arm, wrench, moment);
    se3di_add(wrench + 3, moment, wrench + 3);
}

/* |Phi|, |Phi_q qdot - nu| and |Phi_q qddot - gamma| of one equation, in r-omega. */
static se3d_status measure_row(const se3di_model *model, const se3di_row *row, double gap[3])
{
    double jet[3];
    SE3DI_TRY(se3di_row_prescribed(model, row, jet));
    gap[0] = se3di_row_violation(model, row, jet[0]);
    gap[1] = -jet[1];
    gap[2] = -jet[2];
    for (uint32_t k = 0; k < row->term_count; ++k) {
        const se3di_term *term = &model->terms[row->term_begin + k];
        const se3di_primitive *primitive = &se3di_primitives[term->type];
        const se3di_frame *i = &model->frames[term->body_i];
        const se3di_frame *j = &model->frames[term->body_j];
        const double *a_i = model->acceleration + 6 * term->body_i;
        const double *a_j = model->acceleration + 6 * term->body_j;
        double phi_i[6];
        double phi_j[6];
        primitive->jacobian_romega(term, i, j, phi_i, phi_j);
        gap[1] += term->coefficient * (se3di_dot(phi_i, i->v) + se3di_dot(phi_i + 3, i->w) +
                                       se3di_dot(phi_j, j->v) + se3di_dot(phi_j + 3, j->w));
        gap[2] += term->coefficient *
                  (se3di_dot(phi_i, a_i) + se3di_dot(phi_i + 3, a_i + 3) + se3di_dot(phi_j, a_j) +
                   se3di_dot(phi_j + 3, a_j + 3) - primitive->gamma_romega(term, i, j));
    }
    return SE3D_OK;
}

static void take_largest(const double gap[3], double violation[3])
{
    for (int level = 0; level < 3; ++level) {
        violation[level] = fmax(violation[level], fabs(gap[level]));
    }
}

/* The same of the equations of a user constraint, into `violation`. */
static se3d_status measure_user(const se3di_model *model, const se3di_constraint *constraint,
                                double violation[3])
{
    se3di_user_values values;
    SE3DI_TRY(se3di_user_eval(
        model, constraint, model->time,
        SE3DI_USER_PHI | SE3DI_USER_JACOBIAN | SE3DI_USER_NU | SE3DI_USER_GAMMA, &values));
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        double gap[3] = {values.phi[r], -values.nu[r], -values.gamma[r]};
        for (uint32_t k = 0; k < se3di_user_body_count(constraint); ++k) {
            uint32_t body = constraint->bodies[constraint->user_first + k];
            const double *row = se3di_user_row(constraint, &values, r, k);
            const double *a = model->acceleration + 6 * body;
            const se3di_frame *frame = &model->frames[body];
            gap[1] += se3di_dot(row, frame->v) + se3di_dot(row + 3, frame->w);
            gap[2] += se3di_dot(row, a) + se3di_dot(row + 3, a + 3);
        }
        take_largest(gap, violation);
    }
    return SE3D_OK;
}

se3d_status se3di_violation_measure(const se3di_model *model, double violation[3])
{
    violation[0] = violation[1] = violation[2] = 0.0;
    for (size_t k = 0; k < model->row_count; ++k) {
        double gap[3] = {0.0, 0.0, 0.0};
        if (!(model->rows[k].left_out & SE3DI_ROW_BROKEN)) {
            SE3DI_TRY(measure_row(model, &model->rows[k], gap));
        }
        take_largest(gap, violation);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (se3di_is_user(constraint) && !se3di_is_broken(constraint, model->rows)) {
            SE3DI_TRY(measure_user(model, constraint, violation));
        }
    }
    return SE3D_OK;
}
