/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/fused.h"

#include "math/vec3.h"

#include <string.h>

#define BLOCK 6 /* r-omega */

static int same(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int is_cd(const se3di_term *term, const se3di_term *first, int axis)
{
    return term->type == SE3DI_PRIMITIVE_CD && term->coefficient == 1.0 &&
           term->body_i == first->body_i && term->body_j == first->body_j &&
           same(term->s_i, first->s_i) && same(term->s_j, first->s_j) &&
           term->c[0] == (axis == 0 ? 1.0 : 0.0) && term->c[1] == (axis == 1 ? 1.0 : 0.0) &&
           term->c[2] == (axis == 2 ? 1.0 : 0.0);
}

static int is_dp1(const se3di_term *term, const se3di_term *first, const se3di_term *direction)
{
    return term->type == SE3DI_PRIMITIVE_DP1 && term->coefficient == 1.0 &&
           term->body_i == first->body_i && term->body_j == first->body_j &&
           same(term->a_j, direction->a_j);
}

int se3di_fused_fits(const se3di_assembly *assembly, uint32_t joint)
{
    const se3di_model *model = assembly->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    const se3di_term *terms = model->terms + constraint->term_begin;
    if (assembly->formulation->block != BLOCK || constraint->term_count != constraint->row_count ||
        (constraint->row_count != 3 && constraint->row_count != 5) ||
        terms[0].body_i == terms[0].body_j) {
        return 0;
    }
    int fits = 1;
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        const se3di_row *row = &model->rows[constraint->row_begin + r];
        fits = fits && row->term_count == 1 && row->term_begin == constraint->term_begin + r;
        fits = fits && (r < 3 ? is_cd(&terms[r], &terms[0], (int)r)
                              : is_dp1(&terms[r], &terms[0], &terms[3]));
    }
    return fits;
}

/* Rows of a point that moves with a body, sign s: [s I, s s x (rows of A)]. */
static inline void put_point(double *restrict block, const se3di_frame *frame, const double p[3],
                             double s)
{
    const double q[3] = {s * p[0], s * p[1], s * p[2]};
    for (int k = 0; k < 3; ++k, block += BLOCK) {
        const double *a = frame->A + 3 * k;
        block[0] = block[1] = block[2] = 0.0;
        block[k] = s;
        block[3] = q[1] * a[2] - q[2] * a[1];
        block[4] = q[2] * a[0] - q[0] * a[2];
        block[5] = q[0] * a[1] - q[1] * a[0];
    }
}

/* w x (w x p) = w (w.p) - p (w.w) */
static inline void turn_twice(const double w[3], const double p[3], double out[3])
{
    const double along = se3di_dot(w, p), square = se3di_dot(w, w);
    for (int k = 0; k < 3; ++k) {
        out[k] = w[k] * along - p[k] * square;
    }
}

static inline void put_direction(double *block, const double a[3], const double l[3])
{
    block[0] = block[1] = block[2] = 0.0;
    se3di_cross(a, l, block + 3);
}

static void eval_directions(const se3di_term *terms, const se3di_frame *i, const se3di_frame *j,
                            double *block_i, double *block_j, double *gamma)
{
    double world[3], rate[3], rate_rate[3], turned[3];
    double l[3], l1[3], l2[3];
    const double *a_j = terms[0].a_j;
    se3di_mul(j->A, a_j, world);
    se3di_mul_transposed(i->A, world, l);
    if (gamma) {
        se3di_cross(j->w, a_j, rate);
        turn_twice(j->w, a_j, rate_rate);
        se3di_mul(j->A, rate, turned);
        se3di_mul_transposed(i->A, turned, l1);
        se3di_mul(j->A, rate_rate, turned);
        se3di_mul_transposed(i->A, turned, l2);
    }
    for (int k = 0; k < 2; ++k) {
        const double *a_i = terms[k].a_i;
        if (block_i) {
            put_direction(block_i + k * BLOCK, a_i, l);
        }
        if (block_j) {
            se3di_mul(i->A, a_i, world);
            se3di_mul_transposed(j->A, world, turned);
            put_direction(block_j + k * BLOCK, a_j, turned);
        }
        if (gamma) {
            se3di_cross(i->w, a_i, rate);
            turn_twice(i->w, a_i, rate_rate);
            gamma[k] -= se3di_dot(l, rate_rate) + se3di_dot(a_i, l2) + 2.0 * se3di_dot(rate, l1);
        }
    }
}

void se3di_fused_eval(se3di_assembly *assembly, uint32_t joint, double *gamma)
{
    const se3di_model *model = assembly->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    const se3di_term *terms = model->terms + constraint->term_begin;
    const se3di_term_place *place = &assembly->places[constraint->term_begin];
    const size_t *offset = assembly->block_offset + assembly->joint_begin[joint];
    const se3di_frame *i = &model->frames[terms[0].body_i];
    const se3di_frame *j = &model->frames[terms[0].body_j];
    double *block_i = place->slot_i >= 0 ? assembly->C + offset[place->slot_i] : NULL;
    double *block_j = place->slot_j >= 0 ? assembly->C + offset[place->slot_j] : NULL;
    if (block_i) {
        put_point(block_i, i, terms[0].s_i, -1.0);
    }
    if (block_j) {
        put_point(block_j, j, terms[0].s_j, 1.0);
    }
    if (gamma) {
        double local[3], arm_i[3], arm_j[3];
        const double *f = assembly->f + 3 * (size_t)constraint->row_begin;
        turn_twice(i->w, terms[0].s_i, local);
        se3di_mul(i->A, local, arm_i);
        turn_twice(j->w, terms[0].s_j, local);
        se3di_mul(j->A, local, arm_j);
        for (uint32_t k = 0; k < constraint->row_count; ++k) {
            gamma[k] = f[3 * k + 2] + (k < 3 ? arm_i[k] - arm_j[k] : 0.0);
        }
    }
    if (constraint->row_count == 5) {
        eval_directions(terms + 3, i, j, block_i ? block_i + 3 * BLOCK : NULL,
                        block_j ? block_j + 3 * BLOCK : NULL, gamma ? gamma + 3 : NULL);
    }
}
