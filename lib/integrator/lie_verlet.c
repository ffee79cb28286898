/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/lie_verlet.h"

#include "contact/loads.h"
#include "integrator/state.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define POSITION_ITERATIONS 60

size_t se3di_lie_verlet_history_count(const se3di_assembly *assembly)
{
    (void)assembly;
    return 1; /* nothing but its mark: the state is all */
}

size_t se3di_lie_verlet_work_count(const se3di_assembly *assembly)
{
    return 6 * (size_t)assembly->dense_count + assembly->row_count +
           6 * (size_t)assembly->body_count + assembly->unknown_count;
}

se3d_status se3di_lie_verlet_start(se3di_integration *integration, double h)
{
    (void)h;
    integration->equations->assembly.model->history[0] = 0.0;
    return SE3D_OK;
}

se3di_lie_verlet se3di_lie_verlet_begin(se3di_integration *integration, int force_iterations)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    se3di_lie_verlet m = {.equations = integration->equations,
                          .assembly = assembly,
                          .force_iterations = force_iterations,
                          .wrench = integration->work};
    m.lambda = m.wrench + 6 * (size_t)assembly->dense_count;
    m.half = m.lambda + assembly->row_count;
    m.last = m.half + 6 * (size_t)assembly->body_count;
    return m;
}

/* J xi + s h/2 xi x J xi + h^2/4 xi (xi.J xi) */
static void trivialised_momentum(const double J[9], const double xi[3], double h, double s,
                                 double out[3])
{
    double momentum[3], gyro[3];
    se3di_mul(J, xi, momentum);
    se3di_cross(xi, momentum, gyro);
    const double along = 0.25 * h * h * se3di_dot(xi, momentum);
    for (int k = 0; k < 3; ++k) {
        out[k] = momentum[k] + 0.5 * s * h * gyro[k] + along * xi[k];
    }
}

/* xi of a momentum, by Newton. */
static se3d_status solve_mean_rate(const double J[9], const double momentum[3], double h,
                                   double xi[3])
{
    se3di_solve3(J, momentum, xi);
    double before = HUGE_VAL;
    for (int iteration = 0; iteration < 50; ++iteration) {
        double f[3], m[3], D[9], dxi[3];
        trivialised_momentum(J, xi, h, 1.0, f);
        se3di_sub(momentum, f, f);
        se3di_mul(J, xi, m);
        const double along = 0.25 * h * h * se3di_dot(xi, m);
        const double X[9] = {0, -xi[2], xi[1], xi[2], 0, -xi[0], -xi[1], xi[0], 0};
        const double P[9] = {0, -m[2], m[1], m[2], 0, -m[0], -m[1], m[0], 0};
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                double XJ = X[3 * r] * J[c] + X[3 * r + 1] * J[3 + c] + X[3 * r + 2] * J[6 + c];
                D[3 * r + c] = J[3 * r + c] + 0.5 * h * (XJ - P[3 * r + c]) +
                               (r == c ? along : 0.0) + 0.5 * h * h * xi[r] * m[c];
            }
        }
        se3di_solve3(D, f, dxi);
        se3di_add(xi, dxi, xi);
        double size = se3di_norm(dxi), scale = se3di_norm(xi);
        if (!isfinite(size)) {
            return SE3D_ERR_NOT_FINITE;
        }
        if (size <= 1e-15 * scale || (size <= 1e-12 * scale && size >= 0.5 * before)) {
            return SE3D_OK;
        }
        before = size;
    }
    return SE3D_ERR_NO_CONVERGENCE;
}

/* q_1, v_h and L_1 without its last half kick, for the multipliers `lambda`; the frames hold q_0
 * before (equations->saved), q_1 and the velocities in the middle of the step after. */
static se3d_status drift(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    size_t block = (size_t)assembly->formulation->block;
    double h = m->h;
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    se3di_assembly_add_transposed(assembly, 1.0, m->lambda, equations->b);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        const se3di_frame *from = &equations->saved[body];
        se3di_frame *frame = &model->frames[body];
        double force[3], torque[3], momentum[3], J[9], xi[3];
        double *half = m->half + 6 * (size_t)k;
        se3di_state_split_force(assembly, from, equations->b + k * block, force, torque);
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_mul(J, from->w, momentum);
        for (int c = 0; c < 3; ++c) {
            const double *applied = m->wrench + 6 * (size_t)body;
            half[c] = from->v[c] + 0.5 * h * (applied[c] - force[c]) / model->bodies[body].mass;
            momentum[c] += 0.5 * h * (applied[3 + c] - torque[c]);
            frame->r[c] = from->r[c] + h * half[c];
        }
        SE3DI_TRY(solve_mean_rate(J, momentum, h, xi));
        trivialised_momentum(J, xi, h, -1.0, half + 3);
        const double turn[4] = {1.0, 0.5 * h * xi[0], 0.5 * h * xi[1], 0.5 * h * xi[2]};
        se3di_copy(half, frame->v);
        se3di_copy(xi, frame->w);
        se3di_quat_mul(from->p, turn, frame->p);
        se3di_quat_normalize(frame->p, frame->p);
        se3di_frame_update(frame);
    }
    return SE3D_OK;
}

/* lambda_0 with Phi(q_1) = 0: Newton with the matrix of q_0. */
static se3d_status solve_positions(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    double before = HUGE_VAL;
    for (int iteration = 0; iteration < POSITION_ITERATIONS; ++iteration) {
        SE3DI_TRY(drift(m));
        se3di_assembly_eval_phi(assembly, equations->c);
        double worst = 0.0;
        for (uint32_t k = 0; k < assembly->row_count; ++k) {
            worst = fmax(worst, fabs(equations->c[k]));
            equations->c[k] *= 2.0 / (m->h * m->h);
        }
        if (!isfinite(worst) || worst > 1e3 * before) {
            return SE3D_ERR_NO_CONVERGENCE;
        }
        if (worst <= 1e-15 || (worst <= 1e-12 && worst >= 0.5 * before)) {
            return SE3D_OK;
        }
        before = worst;
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        ++equations->counters.iterations;
        for (uint32_t k = 0; k < assembly->row_count; ++k) {
            m->lambda[k] -= equations->l[k];
        }
    }
    return before <= 1e-9 ? SE3D_OK : SE3D_ERR_NO_CONVERGENCE;
}

/* The last half kick with the applied wrench of the present velocities. */
static void kick(se3di_lie_verlet *m)
{
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        se3di_frame *frame = &model->frames[body];
        const double *half = m->half + 6 * (size_t)k;
        const double *applied = assembly->wrench + 6 * (size_t)body;
        double momentum[3], J[9];
        for (int c = 0; c < 3; ++c) {
            frame->v[c] = half[c] + 0.5 * m->h * applied[c] / model->bodies[body].mass;
            momentum[c] = half[3 + c] + 0.5 * m->h * applied[3 + c];
        }
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_solve3(J, momentum, frame->w);
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
}

/* min |qdot - kicked|_M with Phi_q qdot = nu. */
static se3d_status project_velocities(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul_mass(assembly, equations->x, equations->b);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * (size_t)k + 1];
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    se3di_assembly_set_velocity(assembly, equations->x);
    return SE3D_OK;
}

/* v_1 and w_1; iterated where forces depend on them. */
static se3d_status solve_velocities(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    size_t unknowns = assembly->unknown_count;
    for (int iteration = 0; iteration < m->force_iterations; ++iteration) {
        SE3DI_TRY(se3di_assembly_eval_forces(assembly, m->t1, equations->b, equations->error));
        se3di_assembly_get_velocity(assembly, m->last);
        kick(m);
        SE3DI_TRY(project_velocities(m));
        double change = 0.0, size = 0.0;
        for (size_t k = 0; k < unknowns; ++k) {
            change = fmax(change, fabs(equations->x[k] - m->last[k]));
            size = fmax(size, fabs(equations->x[k]));
        }
        if (!se3di_loads_are_stiff(assembly->model) || change <= 1e-13 * size) {
            break;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_lie_verlet_drift(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    se3di_equations_save(equations);
    if (assembly->row_count > 0) {
        memcpy(m->lambda, model->lambda, assembly->row_count * sizeof *m->lambda);
    }
    SE3DI_TRY(se3di_equations_factor(equations));
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, model->time, equations->b, equations->error));
    memcpy(m->wrench, assembly->wrench, 6 * (size_t)assembly->dense_count * sizeof *m->wrench);
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, m->t1, equations->error));
    se3d_status status = solve_positions(m);
    if (status < 0) {
        return se3di_error_set(equations->error, status,
                               "t = %g s: the positions did not converge in a step of %g s; try a "
                               "smaller step",
                               m->t1, m->h);
    }
    return SE3D_OK;
}

/* From the velocities in the middle of the step to those that they lead to at its end. */
static void predict_velocities(se3di_lie_verlet *m)
{
    for (uint32_t k = 0; k < m->assembly->body_count; ++k) {
        uint32_t body = m->assembly->free_body[k];
        const se3di_frame *from = &m->equations->saved[body];
        se3di_frame *frame = &m->assembly->model->frames[body];
        for (int c = 0; c < 3; ++c) {
            frame->v[c] = 2.0 * frame->v[c] - from->v[c];
            frame->w[c] = 2.0 * frame->w[c] - from->w[c];
        }
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
}

se3d_status se3di_lie_verlet_kick(se3di_lie_verlet *m)
{
    predict_velocities(m);
    SE3DI_TRY(se3di_equations_factor(m->equations));
    return solve_velocities(m);
}

se3d_status se3di_lie_verlet_finish(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_model *model = assembly->model;
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, m->t1, equations->b, equations->error));
    se3di_assembly_eval_gamma(assembly, equations->c);
    SE3DI_TRY(se3di_equations_solve(equations));
    ++equations->counters.evaluations;
    se3di_assembly_set_acceleration(assembly, equations->x);
    if (assembly->row_count > 0) {
        memcpy(model->lambda, equations->l, assembly->row_count * sizeof *equations->l);
    }
    SE3DI_TRY(se3di_loads_prepare(model, m->t1, equations->error));
    model->time = m->t1;
    se3di_angles_accept(model);
    se3di_loads_accept(model);
    return se3di_work_accept(model, m->h);
}
