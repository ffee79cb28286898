/* SPDX-License-Identifier: BSD-3-Clause */
/* What the model is given of the steps of the Newmark family: states between their ends, and
 * accelerations and multipliers that are exact for the positions and velocities. */
#include "integrator/newmark.h"

#include "assembly/loads.h"
#include "force/friction.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define BALANCE 48.0 /* h^2/48 (a off by h^2 a''/8): h^4 a''/384, as cubics are off by */

static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

/* Hermite's cubic from 0 at s = 0 to x at s = 1 with the slopes u, v there; and its slope. */
static void eval_cubic(const double x[3], const double u[3], const double v[3], double s,
                       double out[3], double slope[3])
{
    const double r = 1.0 - s;
    for (int k = 0; k < 3; ++k) {
        out[k] = s * s * (1.0 + 2.0 * r) * x[k] + s * r * (r * u[k] - s * v[k]);
        slope[k] = 6.0 * s * r * x[k] + r * (1.0 - 3.0 * s) * u[k] + s * (1.0 - 3.0 * r) * v[k];
    }
}

/* A body on its way from y0 to y1 in h: position and the logarithm of its turn along cubics. */
static void interpolate_body(const double *y0, const double *y1, double h, double s, double *y)
{
    double x[3], u[3], v[3], slope[3], turn[3], T[9];
    for (int k = 0; k < 3; ++k) {
        x[k] = y1[k] - y0[k];
        u[k] = h * y0[7 + k];
        v[k] = h * y1[7 + k];
    }
    eval_cubic(x, u, v, s, y, slope);
    for (int k = 0; k < 3; ++k) {
        y[k] += y0[k];
        y[7 + k] = slope[k] / h;
        u[k] = h * y0[10 + k];
    }
    se3di_quat_log(y0 + 3, y1 + 3, x);
    se3di_exp_tangent_inverse(x, T);
    se3di_mul(T, y1 + 10, v);
    se3di_scale(h, v, v);
    eval_cubic(x, u, v, s, turn, slope);
    se3di_quat_rotate(y0 + 3, turn, y + 3);
    se3di_exp_tangent(turn, T);
    se3di_mul(T, slope, y + 10);
    se3di_scale(1.0 / h, y + 10, y + 10);
}

se3di_newmark_history se3di_newmark_get_history(const se3di_assembly *assembly)
{
    const size_t count = se3di_state_count(assembly), n = assembly->unknown_count;
    double *numbers = assembly->model->history;
    se3di_newmark_history past = {.header = (se3di_newmark_header *)(void *)numbers};
    past.y = numbers + SE3DI_NEWMARK_HEADER;
    past.y_begin = past.y + count;
    past.a = past.y_begin + count;
    past.vdot = past.a + n;
    past.vdot_begin = past.vdot + n;
    past.lambda = past.vdot_begin + n;
    past.lambda_begin = past.lambda + assembly->row_count;
    return past;
}

void se3di_newmark_interpolate(const se3di_integration *integration, double t, double *y)
{
    const se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    const double begin = past.header->at.begin, end = past.header->end;
    const size_t count = se3di_state_count(assembly);
    if (!(t > begin && t < end)) { /* the ends to the bit */
        copy(y, t < end ? past.y_begin : past.y, count);
        return;
    }
    const double s = (t - begin) / (end - begin);
    size_t at = 0;
    for (; at + SE3DI_STATE_WORK < count; at += SE3DI_STATE_SIZE) {
        interpolate_body(past.y_begin + at, past.y + at, end - begin, s, y + at);
    }
    for (int k = 0; k < SE3DI_STATE_WORK; ++k, ++at) { /* along a parabola, as the rule */
        const double first = (end - begin) * past.header->power_begin[k];
        y[at] = past.y_begin[at] + s * (first + s * (past.y[at] - past.y_begin[at] - first));
    }
}

/* Forces that depend on what was before: they belong to the steps. */
static int remembers(const se3di_model *model)
{
    return se3di_forces_have_memory(model) || model->contacts.pair_count > 0;
}

/* Whether the accelerations in equations->x, solved for at a state between two steps, differ from
 * those of the steps by no more than they differ among themselves: with stiff forces what the state
 * is off by counts for more. */
static int are_plausible(const se3di_equations *equations, const double *guess,
                         const se3di_newmark_history *past)
{
    double change = 0.0, off = 0.0, size = 0.0;
    for (uint32_t k = 0; k < equations->assembly.unknown_count; ++k) {
        change = fmax(change, fabs(past->vdot[k] - past->vdot_begin[k]));
        off = fmax(off, fabs(equations->x[k] - guess[k]));
        size = fmax(size, fabs(guess[k]));
    }
    return off <= change + 1e-6 * size;
}

/* What is out of balance of M vdot + Phi_q^T lambda = Q at the model's state into equations->b, and
 * how far positions are off their constraints into ->phi. */
static se3d_status eval_balance(se3di_equations *equations, double t, const double *vdot,
                                double *size)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_follow_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, assembly->model->lambda, equations->b);
    se3di_assembly_subtract_mass(assembly, vdot, equations->b);
    se3di_assembly_eval_phi(assembly, equations->phi);
    *size = 0.0;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        *size = se3di_larger(*size, fabs(equations->b[k]));
    }
    return SE3D_OK;
}

/* The displacement z by which the forces balance the accelerations vdot, over `weight`, into
 * equations->x, and multipliers into ->l: (M/weight + K) z + Phi_q^T l = b, Phi_q z = -Phi. */
static se3d_status find_balance(se3di_integration *integration, double t, const double *vdot,
                                double weight)
{
    se3di_equations *equations = integration->equations;
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_newton_weights weights = {.position = weight};
    double *none = integration->work + assembly->unknown_count;
    memset(none, 0, assembly->unknown_count * sizeof *none);
    SE3DI_TRY(se3di_newton_factor(&integration->newton, t, vdot, assembly->model->lambda, none,
                                  &weights));
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k] / weight;
    }
    return se3di_newton_solve_displacement(&integration->newton);
}

/* Velocities that ring bend the cubics of positions, by nothing that is seen in the motion, but
 * stiff forces make much of it: the positions of the model's state are moved to where forces
 * balance the accelerations vdot, along the stiff directions; along others by no more than what
 * cubics are off by. If that makes nothing better, the state is left as it was. */
static se3d_status balance(se3di_integration *integration, double t, const double *vdot)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_header *header = se3di_newmark_get_history(assembly).header;
    const double last = header->end - header->at.begin, weight = last * last / BALANCE;
    double *lambda = integration->work + 7 * (size_t)assembly->unknown_count;
    double before, after;
    se3di_equations_save(equations);
    copy(lambda, model->lambda, assembly->row_count);
    se3d_status status = eval_balance(equations, t, vdot, &before);
    status = status < 0 ? status : find_balance(integration, t, vdot, weight);
    for (size_t k = 0; status >= 0 && k < assembly->body_count; ++k) {
        double dq[6];
        for (size_t c = 0; c < 6; ++c) {
            dq[c] = weight * equations->x[6 * k + c];
        }
        assembly->formulation->move(&model->frames[assembly->free_body[k]], dq);
    }
    for (uint32_t k = 0; status >= 0 && k < assembly->row_count; ++k) {
        model->lambda[k] += equations->l[k];
    }
    status = status < 0 ? status : se3di_state_project(equations, t, &header->scale, 1e-15, 0);
    status = status < 0 ? status : eval_balance(equations, t, vdot, &after);
    if (status < 0 || !(after < before)) {
        se3di_equations_restore(equations);
        copy(model->lambda, lambda, assembly->row_count);
    }
    return status;
}

/* Accelerations and multipliers of the model's state at t, a part s on the way from the beginning
 * of the last step to its end. @return OK, or what the user's code or the memory has failed with */
static se3d_status set_accelerations(se3di_integration *integration, double t, double s)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_model *model = assembly->model;
    const se3di_newmark_history past = se3di_newmark_get_history(assembly);
    double *guess = integration->work;
    se3di_error ignored = {0};
    se3di_error *error = equations->error;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        guess[k] = s > 0.0 ? past.vdot[k] - (1.0 - s) * (past.vdot[k] - past.vdot_begin[k])
                           : past.vdot_begin[k]; /* to the bit */
    }
    equations->error = &ignored;
    const int solves = !remembers(model);
    se3d_status status = solves ? se3di_acceleration_solve(equations, t) : SE3D_OK;
    const int is_exact =
        solves && status >= 0 && (s >= 1.0 || are_plausible(equations, guess, &past));
    if (!is_exact) {
        for (uint32_t k = 0; k < assembly->row_count; ++k) {
            model->lambda[k] =
                s > 0.0 ? past.lambda[k] - (1.0 - s) * (past.lambda[k] - past.lambda_begin[k])
                        : past.lambda_begin[k];
        }
        se3di_assembly_set_acceleration(assembly, guess);
        if (model->shows_before) {
            se3di_frictions_take_loads(model, model->lambda);
        }
        if (solves && status >= 0 && s > 0.0) {
            status = balance(integration, t, guess);
        }
    }
    equations->error = error;
    if (status == SE3D_ERR_CALLBACK || status == SE3D_ERR_NO_MEMORY) {
        return ignored.status == status ? se3di_error_set(error, status, "%s", ignored.message)
                                        : status;
    }
    return SE3D_OK;
}

se3d_status se3di_newmark_publish(se3di_integration *integration, double t)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    const se3di_newmark_header *header = se3di_newmark_get_history(assembly).header;
    const double end = header->end, last = end - header->at.begin;
    double *y =
        integration->work + 7 * (size_t)assembly->unknown_count + 2 * (size_t)assembly->row_count;
    const int is_end = !(end - t > SE3DI_NEWMARK_SAME_TIME * last);
    se3di_newmark_interpolate(integration, is_end ? end : t, y);
    se3di_forces_show(assembly->model, !is_end);
    se3di_state_set(assembly, y);
    const int is_bent = !is_end && se3di_loads_are_stiff(assembly->model); /* `balance` */
    const double rough = is_bent ? 0.0
                                 : se3di_state_rough(assembly->model, integration->shows_motion,
                                                     integration->settings.tolerance);
    const double *work = y + se3di_state_count(assembly) - SE3DI_STATE_WORK;
    if (!is_end && t > header->at.begin) { /* not the end of the step before */
        SE3DI_TRY(se3di_state_project(equations, t, &header->scale, fmax(1e-15, rough), 0));
    }
    if (rough > 0.0) {
        se3di_angles_accept(assembly->model);
        return se3di_state_conclude_motion(equations, work, t);
    }
    SE3DI_TRY(set_accelerations(integration, t, is_end ? 1.0 : (t - header->at.begin) / last));
    se3di_angles_accept(assembly->model);
    return se3di_state_conclude(equations, work, t);
}
