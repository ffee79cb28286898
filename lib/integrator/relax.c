/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/relax.h"

#include "math/quaternion.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define FAST 1e4 /* (rate times step)^2 */

se3di_fastness se3di_relax_measure(const se3di_newton *newton, double c, double h)
{
    const se3di_tangent *tangent = &newton->tangent;
    const se3di_assembly *assembly = &newton->equations->assembly;
    const size_t block = (size_t)assembly->formulation->block;
    se3di_fastness fast = {0.0, 0.0};
    for (size_t k = 0; k < assembly->body_count; ++k) {
        for (size_t j = 0; j < block; ++j) {
            const size_t place = k * block * block + j * (block + 1);
            const double M = tangent->M[place], K = tangent->K[place];
            const double decay = ((tangent->D[place] - c * c * K) / M - 1.0) * (h / c);
            fast.spring2 = fmax(fast.spring2, fabs(K) / M * h * h);
            fast.damper2 = fmax(fast.damper2, decay * decay);
        }
    }
    return fast;
}

int se3di_is_fast(const se3di_fastness *fast)
{
    return fmax(fast->spring2, fast->damper2) > FAST;
}

se3di_fastness se3di_relax_trust(const se3di_equations *equations, se3di_fastness fast)
{
    fast.spring2 = se3di_kkt_has_loop(equations->kkt) ? 0.0 : fast.spring2;
    return fast;
}

double se3di_relax_noise(const se3di_fastness *fast, const se3di_state_scale *scale, double h)
{
    const double rate = 16.0 * DBL_EPSILON / h * fast->spring2 / (1.0 + fast->spring2);
    return rate * scale->length / scale->speed + rate / scale->spin;
}

/* Positions by c^2 x, and velocities by `velocity` times x. */
static void shift_state(se3di_equations *equations, double c, double velocity, double *six)
{
    se3di_assembly *assembly = &equations->assembly;
    const double *x = equations->x;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        six[k] = c * c * x[k];
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->move(frame, six + 6 * (size_t)k);
        se3di_quat_normalize(frame->p, frame->p);
        se3di_frame_update(frame);
    }
    se3di_assembly_get_velocity(assembly, six);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        six[k] += velocity * x[k];
    }
    se3di_assembly_set_velocity(assembly, six);
}

/* M (a - a') to the right-hand side; the multipliers of a to `lambda`. */
static se3d_status eval_difference(se3di_equations *equations, const se3di_relaxation *r,
                                   double *difference, double *lambda)
{
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_kkt_settings before = se3di_state_begin(equations, 1e-8, 1e-15);
    const se3d_status status = se3di_state_evaluate(equations, r->t);
    se3di_state_end(equations, &before);
    SE3DI_TRY(status);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        difference[k] = r->vdot[k] - equations->x[k];
    }
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    se3di_assembly_subtract_mass(assembly, difference, equations->b);
    if (assembly->row_count > 0) {
        memcpy(lambda, equations->l, assembly->row_count * sizeof *lambda);
        memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    }
    return SE3D_OK;
}

se3d_status se3di_relax(se3di_integration *integration, const se3di_relaxation *r)
{
    se3di_equations *equations = integration->equations;
    se3di_newton *newton = &integration->newton;
    const size_t n = equations->assembly.unknown_count;
    const double c = r->c;
    const se3di_newton_weights weights = {.velocity = c, .position = c * c};
    double *six = r->work, *none = six + n, *lambda = none + n;
    if (!se3di_is_fast(&r->fast)) {
        return SE3D_OK;
    }
    memset(none, 0, n * sizeof *none);
    SE3DI_TRY(eval_difference(equations, r, six, lambda));
    newton->tangent.is_convex = 1; /* forces that are out of balance are no stiffness */
    const se3d_status status = se3di_newton_factor(newton, r->t, r->vdot, lambda, none, &weights);
    newton->tangent.is_convex = 0;
    SE3DI_TRY(status);
    SE3DI_TRY(se3di_newton_solve(newton));
    shift_state(equations, c, r->fast.damper2 > FAST ? c : 0.0, six);
    return SE3D_OK;
}

se3d_status se3di_relax_state(se3di_integration *integration, const se3di_relaxation *r,
                              const se3di_state_scale *scale, double *y)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const size_t bodies = se3di_state_count(assembly) - SE3DI_STATE_WORK;
    double work[SE3DI_STATE_WORK];
    se3di_state_set(assembly, y);
    SE3DI_TRY(se3di_state_project(integration->equations, r->t, scale, 1e-15, 0));
    SE3DI_TRY(se3di_relax(integration, r));
    memcpy(work, y + bodies, sizeof work);
    se3di_state_get(assembly, y);
    memcpy(y + bodies, work, sizeof work);
    return SE3D_OK;
}
