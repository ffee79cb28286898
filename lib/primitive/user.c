/* SPDX-License-Identifier: BSD-3-Clause */
#include "primitive/user.h"

#include "base/floats.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

#define STEP 1e-6 /* of central differences; [m], [rad] */

/* What the callback sees of its bodies. */
static void get_motion(const se3di_model *model, const se3di_constraint *constraint,
                       se3d_body_motion motion[SE3D_USER_BODIES_MAX])
{
    for (uint32_t k = 0; k < se3di_user_body_count(constraint); ++k) {
        const uint32_t body = constraint->bodies[constraint->user_first + k];
        se3di_frame_get_motion(&model->frames[body], &motion[k]);
    }
}

/* Values that are not finite are a failure; on failure all are zero.
 * @return OK, status, NOT_FINITE */
static se3d_status take(const se3di_constraint *constraint, se3d_status status,
                        se3di_user_values *values)
{
    const int rows = (int)constraint->row_count;
    const int numbers = 6 * rows * (int)se3di_user_body_count(constraint);
    const int is_finite = se3di_is_finite(values->phi, rows) && se3di_is_finite(values->nu, rows) &&
                          se3di_is_finite(values->gamma, rows) &&
                          se3di_is_finite(values->jacobian, numbers);
    if (status < 0 || !is_finite) {
        memset(values, 0, sizeof *values);
        return status < 0 ? status : SE3D_ERR_NOT_FINITE;
    }
    return SE3D_OK;
}

/* Call with `motion`; what is not wanted is zero, and so is all on failure.
 * @return OK, CALLBACK, NOT_FINITE */
static se3d_status call(const se3di_constraint *constraint, double t,
                        const se3d_body_motion *motion, int wanted, se3di_user_values *values)
{
    memset(values, 0, sizeof *values);
    se3d_status status = constraint->callback(
        constraint->ctx, t, motion, wanted & SE3DI_USER_PHI ? values->phi : NULL,
        wanted & SE3DI_USER_JACOBIAN ? values->jacobian : NULL,
        wanted & SE3DI_USER_NU ? values->nu : NULL,
        wanted & SE3DI_USER_GAMMA ? values->gamma : NULL);
    se3di_floats_resume();
    return take(constraint, status < 0 ? SE3D_ERR_CALLBACK : SE3D_OK, values);
}

se3d_status se3di_user_eval(const se3di_model *model, const se3di_constraint *constraint, double t,
                            int wanted, se3di_user_values *values)
{
    se3d_body_motion motion[SE3D_USER_BODIES_MAX];
    if (constraint->law_class) {
        memset(values, 0, sizeof *values);
        return take(constraint, constraint->law_class->eval(model, constraint, t, wanted, values),
                    values);
    }
    get_motion(model, constraint, motion);
    return call(constraint, t, motion, wanted, values);
}

/* Displace coordinate k (0 .. 5 of the first body, 6 .. 11 of the second, ...). */
static void displace(se3d_body_motion *motion, uint32_t k, double by)
{
    se3d_body_motion *m = &motion[k / 6];
    if (k % 6 < 3) {
        m->r[k % 6] += by;
    } else {
        double theta[3] = {0.0, 0.0, 0.0};
        theta[k % 6 - 3] = by;
        se3di_quat_rotate(m->p, theta, m->p);
    }
}

/* g += s Phi_q^T lambda */
static void add_forces(const se3di_constraint *constraint, const se3di_user_values *values,
                       const double *lambda, double s, double *g)
{
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        for (uint32_t k = 0; k < se3di_user_body_count(constraint); ++k) {
            const double *row = se3di_user_row(constraint, values, r, k);
            for (uint32_t c = 0; c < 6; ++c) {
                g[6 * k + c] += s * lambda[r] * row[c];
            }
        }
    }
}

/* Of a law, whose Jacobian is one row. */
static se3d_status law_curvature(const se3di_model *model, const se3di_constraint *constraint,
                                 double t, double lambda, double *H, double *g)
{
    const uint32_t n = 6 * se3di_user_body_count(constraint);
    memset(H, 0, (size_t)n * n * sizeof *H);
    memset(g, 0, n * sizeof *g);
    SE3DI_TRY(constraint->law_class->curvature(model, constraint, t, lambda, H, g));
    for (uint32_t k = 0; k < n; ++k) {
        g[k] *= lambda;
    }
    return se3di_is_finite(H, (int)(n * n)) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_user_curvature(const se3di_model *model, const se3di_constraint *constraint,
                                 double t, const double *lambda, double *H, double *g)
{
    uint32_t n = 6 * se3di_user_body_count(constraint);
    se3d_body_motion motion[SE3D_USER_BODIES_MAX];
    se3d_body_motion moved[SE3D_USER_BODIES_MAX];
    se3di_user_values values;
    if (constraint->law_class) {
        return law_curvature(model, constraint, t, lambda[0], H, g);
    }
    get_motion(model, constraint, motion);
    SE3DI_TRY(call(constraint, t, motion, SE3DI_USER_JACOBIAN, &values));
    memset(g, 0, n * sizeof *g);
    add_forces(constraint, &values, lambda, 1.0, g);
    for (uint32_t k = 0; k < n; ++k) {
        double column[6 * SE3D_USER_BODIES_MAX] = {0.0};
        for (int side = 0; side < 2; ++side) {
            double by = side == 0 ? STEP : -STEP;
            memcpy(moved, motion, sizeof moved);
            displace(moved, k, by);
            SE3DI_TRY(call(constraint, t, moved, SE3DI_USER_JACOBIAN, &values));
            add_forces(constraint, &values, lambda, 0.5 / by, column);
        }
        for (uint32_t r = 0; r < n; ++r) {
            H[n * r + k] = column[r];
        }
    }
    return SE3D_OK;
}
