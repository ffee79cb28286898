/* SPDX-License-Identifier: BSD-3-Clause */
/* What presses in a joint, from its reaction on body j: F perpendicular to the axis u and the
 * moment M about the joint point, which is carried by two places at +-length/2 on the axis,
 *
 *     N = |F/2 + u x M/length| + |F/2 - u x M/length|       |F| if no length is given
 *       + 2 |M_u|/width                                     a guide on two rails
 *
 * and on an angle  radius N + thrust_radius |F_u|, the moment on pin and shoulder.
 * docs/theory/friction.md */
#include "force/friction.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

#include <math.h>
#include <string.h>

/* R of force and torque (about the joint point) on body j. */
static void split(const double u[3], const double F[3], const double T[3], double *R)
{
    R[6] = se3di_dot(u, F);
    R[7] = se3di_dot(u, T);
    se3di_copy(F, R);
    se3di_copy(T, R + 3);
    se3di_add_scaled(-R[6], u, R);
    se3di_add_scaled(-R[7], u, R + 3);
}

static void row_reaction(const se3di_model *model, const se3di_force *force, uint32_t r,
                         double R[SE3DI_FRICTION_PARTS])
{
    const se3di_constraint *joint = &model->constraints[force->joint];
    const se3di_row *row = &model->rows[joint->row_begin + r];
    const se3di_frame *j = &model->frames[joint->bodies[1]];
    double F[3] = {0.0}, n[3] = {0.0}, T[3], arm[3], moment[3], u[3];
    for (uint32_t k = 0; k < row->term_count; ++k) {
        const se3di_term *term = &model->terms[row->term_begin + k];
        double phi_i[6], phi_j[6];
        se3di_primitives[term->type].jacobian_romega(term, &model->frames[term->body_i],
                                                     &model->frames[term->body_j], phi_i, phi_j);
        se3di_add_scaled(term->coefficient, phi_j, F);
        se3di_add_scaled(term->coefficient, phi_j + 3, n);
    }
    se3di_mul(j->A, n, T);
    se3di_mul(j->A, joint->frames.point_j, arm);
    se3di_cross(F, arm, moment); /* (r - P) x F */
    se3di_add(T, moment, T);
    se3di_mul(model->frames[joint->bodies[0]].A, joint->frames.axis_i, u);
    split(u, F, T, R);
}

void se3di_friction_reaction_rows(const se3di_model *model, const se3di_force *force, double *rows)
{
    const uint32_t count = model->constraints[force->joint].row_count;
    for (uint32_t r = 0; r < count; ++r) {
        row_reaction(model, force, r, rows + (size_t)r * SE3DI_FRICTION_PARTS);
    }
}

void se3di_friction_reaction(const se3di_model *model, const se3di_force *force,
                             const double *lambda, double R[SE3DI_FRICTION_PARTS])
{
    const se3di_constraint *joint = &model->constraints[force->joint];
    memset(R, 0, SE3DI_FRICTION_PARTS * sizeof *R);
    for (uint32_t r = 0; r < joint->row_count; ++r) {
        double row[SE3DI_FRICTION_PARTS];
        row_reaction(model, force, r, row);
        for (int k = 0; k < SE3DI_FRICTION_PARTS; ++k) {
            R[k] -= lambda[joint->row_begin + r] * row[k];
        }
    }
}

/* |v|, and s times its gradient added to `to`. */
static double length_of(const double v[3], double s, double to[3])
{
    const double size = se3di_norm(v);
    if (size > 0.0) {
        se3di_add_scaled(s / size, v, to);
    }
    return size;
}

static double sign_of(double x)
{
    return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
}

double se3di_friction_load(const se3di_model *model, const se3di_force *force,
                           const double R[SE3DI_FRICTION_PARTS],
                           double gradient[SE3DI_FRICTION_PARTS])
{
    const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    const double arm = turns ? force->radius : 1.0;
    double g[SE3DI_FRICTION_PARTS] = {0.0}, N;
    if (force->length > 0.0) {
        const se3di_constraint *joint = &model->constraints[force->joint];
        double u[3], couple[3], place[3], slope[3];
        se3di_mul(model->frames[joint->bodies[0]].A, joint->frames.axis_i, u);
        se3di_cross(u, R + 3, couple);
        N = 0.0;
        for (int k = 0; k < 2; ++k) {
            const double s = (k ? -1.0 : 1.0) / force->length, none[3] = {0.0};
            for (int c = 0; c < 3; ++c) {
                place[c] = 0.5 * R[c] + s * couple[c];
            }
            se3di_copy(none, slope);
            N += length_of(place, 1.0, slope);
            se3di_add_scaled(0.5, slope, g);
            se3di_cross(slope, u, place); /* d(s . u x M)/dM = s x u */
            se3di_add_scaled(s, place, g + 3);
        }
    } else {
        N = length_of(R, 1.0, g);
    }
    if (force->width > 0.0 && !turns) {
        N += 2.0 * fabs(R[7]) / force->width;
        g[7] = 2.0 * sign_of(R[7]) / force->width;
    }
    for (int k = 0; k < SE3DI_FRICTION_PARTS && gradient; ++k) {
        gradient[k] = arm * g[k];
    }
    if (gradient && turns) {
        gradient[6] = force->thrust_radius * sign_of(R[6]);
    }
    return arm * N + (turns ? force->thrust_radius * fabs(R[6]) : 0.0);
}

void se3di_frictions_take_loads(se3di_model *model, const double *lambda)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_force *force = &model->forces[k];
        if (se3di_friction_has_load(force)) {
            double R[SE3DI_FRICTION_PARTS];
            se3di_friction_reaction(model, force, lambda, R);
            force->state[SE3DI_FRICTION_LOAD] = se3di_friction_load(model, force, R, NULL);
        }
    }
}
