/* SPDX-License-Identifier: BSD-3-Clause */
#include "force/measure.h"

#include "joint/rows.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"

#include <string.h>

static void pair_velocity(const se3di_frame *i, const se3di_frame *j, double u[12])
{
    se3di_copy(i->v, u);
    se3di_copy(i->w, u + 3);
    se3di_copy(j->v, u + 6);
    se3di_copy(j->w, u + 9);
}

void se3di_velocity_pair(const se3di_model *model, const se3di_force *force, double u[12])
{
    pair_velocity(&model->frames[force->body_i], &model->frames[force->body_j], u);
}

static double dot12(const double *a, const double *b)
{
    double sum = 0.0;
    for (int k = 0; k < 12; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

static void measure_rate(const se3di_model *model, const se3di_term *term, se3di_measure *measure)
{
    const se3di_frame *i = &model->frames[term->body_i];
    const se3di_frame *j = &model->frames[term->body_j];
    se3di_primitives[term->type].jacobian_romega(term, i, j, measure->g, measure->g + 6);
    pair_velocity(i, j, measure->u);
    measure->rate = dot12(measure->g, measure->u);
}

void se3di_measure_term(const se3di_model *model, const se3di_term *term, int wants_H,
                        se3di_measure *measure)
{
    measure->value = se3di_term_value(model, term);
    measure_rate(model, term, measure);
    if (wants_H) {
        memset(measure->H, 0, sizeof measure->H);
        se3di_primitives[term->type].curvature_romega(
            term, &model->frames[term->body_i], &model->frames[term->body_j], 1.0, measure->H);
    }
}

void se3di_length_term(const se3di_force *force, se3di_term *term)
{
    *term = (se3di_term){.type = SE3DI_PRIMITIVE_D,
                         .angle = -1,
                         .coefficient = 1.0,
                         .body_i = force->body_i,
                         .body_j = force->body_j};
    se3di_copy(force->s_i, term->s_i);
    se3di_copy(force->s_j, term->s_j);
}

/* The direction from one point to the other is lost. */
static int coincide(const se3di_model *model, const se3di_force *force, double l)
{
    const double size = se3di_norm(model->frames[force->body_i].r) + se3di_norm(force->s_i);
    return l < 1e-14 * (1.0 + size);
}

/* l = sqrt(D):  l_q = D_q / (2 l),  l_qq = D_qq / (2 l) - l_q^T l_q / l */
int se3di_measure_length(const se3di_model *model, const se3di_force *force, int wants_H,
                         se3di_measure *measure)
{
    se3di_term term;
    se3di_length_term(force, &term);
    se3di_measure_term(model, &term, wants_H, measure);
    double l = sqrt(measure->value);
    measure->value = l;
    if (coincide(model, force, l)) {
        memset(measure->g, 0, sizeof measure->g);
        measure->rate = 0.0;
        return 0;
    }
    for (int k = 0; k < 12; ++k) {
        measure->g[k] *= 0.5 / l;
    }
    measure->rate *= 0.5 / l;
    for (int k = 0; wants_H && k < 144; ++k) {
        measure->H[k] = (0.5 * measure->H[k] - measure->g[k / 12] * measure->g[k % 12]) / l;
    }
    return 1;
}

void se3di_measure_begin(const se3di_model *model, const se3di_force *force, se3di_term *term)
{
    if (force->coordinate == SE3D_JOINT_COORDINATE_ANGLE) {
        *term = model->angles[force->angle].term;
        term->angle = force->angle;
        term->coefficient = 1.0;
    } else {
        const se3di_constraint *joint = &model->constraints[force->joint];
        se3di_displacement_term_init(term, &joint->frames, joint->bodies);
    }
}

void se3di_measure_gradient(const se3di_model *model, const se3di_force *force,
                            se3di_measure *measure)
{
    se3di_term term;
    se3di_measure_begin(model, force, &term);
    measure->value = 0.0;
    measure_rate(model, &term, measure);
}

int se3di_measure_force(const se3di_model *model, const se3di_force *force, int wants_H,
                        se3di_measure *measure)
{
    se3di_term term;
    if (force->coordinate == SE3DI_FORCE_LENGTH) {
        return se3di_measure_length(model, force, wants_H, measure);
    }
    se3di_measure_begin(model, force, &term);
    se3di_measure_term(model, &term, wants_H, measure);
    return 1;
}

int se3di_measure_value(const se3di_model *model, const se3di_force *force, double *value)
{
    se3di_term term;
    if (force->coordinate == SE3DI_FORCE_LENGTH) {
        se3di_length_term(force, &term);
        *value = sqrt(se3di_term_value(model, &term));
        return !coincide(model, force, *value);
    }
    se3di_measure_begin(model, force, &term);
    *value = se3di_term_value(model, &term);
    return 1;
}

void se3di_measure_joint(const se3di_model *model, uint32_t joint, int32_t coordinate, int wants_H,
                         se3di_measure *measure)
{
    const se3di_constraint *constraint = &model->constraints[joint];
    se3di_term term;
    if (coordinate == SE3D_JOINT_COORDINATE_ANGLE) {
        term = model->angles[constraint->angle].term;
        term.angle = constraint->angle;
        term.coefficient = 1.0;
    } else {
        se3di_displacement_term_init(&term, &constraint->frames, constraint->bodies);
    }
    se3di_measure_term(model, &term, wants_H, measure);
}

/* g . qddot of the bodies of the element. */
static double along(const se3di_model *model, const se3di_force *force, const double g[12])
{
    const double *a_i = model->acceleration + 6 * (size_t)force->body_i;
    const double *a_j = model->acceleration + 6 * (size_t)force->body_j;
    double sum = 0.0;
    for (int k = 0; k < 6; ++k) {
        sum += g[k] * a_i[k] + g[6 + k] * a_j[k];
    }
    return sum;
}

/* u . H u */
static double length_curve(const se3di_measure *measure)
{
    double sum = 0.0;
    for (int k = 0; k < 144; ++k) {
        sum += measure->u[k / 12] * measure->H[k] * measure->u[k % 12];
    }
    return sum;
}

double se3di_measure_curve(const se3di_model *model, const se3di_force *force)
{
    se3di_term term;
    se3di_measure measure;
    if (force->coordinate == SE3DI_FORCE_LENGTH) {
        return se3di_measure_length(model, force, 1, &measure) ? length_curve(&measure) : 0.0;
    }
    se3di_measure_begin(model, force, &term);
    return -se3di_primitives[term.type].gamma_romega(&term, &model->frames[term.body_i],
                                                     &model->frames[term.body_j]);
}

double se3di_measure_acceleration(const se3di_model *model, const se3di_force *force)
{
    se3di_measure measure;
    return se3di_measure_force(model, force, 0, &measure)
               ? along(model, force, measure.g) + se3di_measure_curve(model, force)
               : 0.0;
}

void se3di_effect_add(se3di_effect *effect, const se3di_measure *measure, const se3di_law *law)
{
    const double *g = measure->g;
    effect->coordinate = measure->value;
    effect->rate = measure->rate;
    effect->value = law->n;
    effect->slope[0] = law->n_x;
    effect->slope[1] = law->n_rate;
    for (int k = 0; k < 12; ++k) {
        effect->wrench[k] -= law->n * g[k];
    }
    if (!effect->wants_derivative) {
        return;
    }
    double slope[12]; /* dn/dq */
    for (int c = 0; c < 12; ++c) {
        double rate_q = 0.0;
        for (int r = 0; r < 12; ++r) {
            rate_q += measure->u[r] * measure->H[12 * r + c];
        }
        slope[c] = law->n_x * g[c] + law->n_rate * rate_q;
    }
    for (int r = 0; r < 12; ++r) {
        for (int c = 0; c < 12; ++c) {
            effect->K[12 * r + c] -= g[r] * slope[c] + law->n * measure->H[12 * r + c];
            effect->D[12 * r + c] -= law->n_rate * g[r] * g[c];
        }
    }
}
