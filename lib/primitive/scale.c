/* SPDX-License-Identifier: BSD-3-Clause */
#include "primitive/scale.h"

#include "math/vec3.h"
#include "primitive/turn_counter.h"
#include "primitive/user.h"

#include <math.h>

double se3di_model_get_size(const se3di_model *model)
{
    double size = 1e-6;
    for (size_t k = 0; k < model->row_count; ++k) {
        for (uint32_t t = 0; t < model->rows[k].term_count; ++t) {
            const se3di_term *term = &model->terms[model->rows[k].term_begin + t];
            size = fmax(size, fmax(se3di_norm(term->s_i), se3di_norm(term->s_j)));
        }
    }
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        if (model->bodies[k].state == 0) {
            size = fmax(size, fmin(1e3 * size, se3di_norm(model->frames[k].r)));
        }
    }
    return size;
}

uint32_t se3di_row_get_owner(const se3di_model *model, uint32_t row)
{
    uint32_t k = 0;
    while (row >= model->constraints[k].row_begin + model->constraints[k].row_count) {
        ++k;
    }
    return k;
}

int32_t se3di_row_get_type(const se3di_model *model, uint32_t row)
{
    const se3di_row *r = &model->rows[row];
    return r->term_count > 0 ? model->terms[r->term_begin].type : -1;
}

double se3di_row_get_scale(const se3di_model *model, uint32_t row, double size)
{
    switch (se3di_row_get_type(model, row)) {
    case SE3DI_PRIMITIVE_D:
        return size * size;
    case SE3DI_PRIMITIVE_DP2:
    case SE3DI_PRIMITIVE_CD:
    case SE3DI_PRIMITIVE_TRIPLE:
        return size;
    default:
        return 1.0;
    }
}

const char *se3di_row_get_unit(const se3di_model *model, uint32_t row)
{
    switch (se3di_row_get_type(model, row)) {
    case SE3DI_PRIMITIVE_D:
        return " m^2";
    case SE3DI_PRIMITIVE_DP2:
    case SE3DI_PRIMITIVE_CD:
    case SE3DI_PRIMITIVE_TRIPLE:
        return " m";
    case SE3DI_PRIMITIVE_ANGLE:
        return " rad";
    default:
        return "";
    }
}

/* Of a callback's row, whose unit nobody knows: relative to what a displacement of the size, or of
 * 1 rad, makes of it. */
static double measure_user(const se3di_model *model, uint32_t row, double size)
{
    const se3di_constraint *constraint = &model->constraints[se3di_row_get_owner(model, row)];
    const uint32_t r = row - constraint->row_begin;
    se3di_user_values values;
    double largest = 0.0;
    if (se3di_user_eval(model, constraint, model->time, SE3DI_USER_PHI | SE3DI_USER_JACOBIAN,
                        &values) < 0) {
        return HUGE_VAL;
    }
    for (uint32_t k = 0; k < se3di_user_body_count(constraint); ++k) {
        const double *block = se3di_user_row(constraint, &values, r, k);
        largest = fmax(largest, fmax(size * se3di_norm(block), se3di_norm(block + 3)));
    }
    return largest > 0.0 ? fabs(values.phi[r]) / largest : HUGE_VAL;
}

double se3di_row_measure(const se3di_model *model, uint32_t row, double size)
{
    const se3di_row *r = &model->rows[row];
    if (r->term_count == 0) {
        return measure_user(model, row, size);
    }
    return fabs(se3di_row_violation(model, r, r->value)) / se3di_row_get_scale(model, row, size);
}

void se3di_left_out_follow(se3di_model *model)
{
    const double size = model->left_out_count > 0 ? se3di_model_get_size(model) : 0.0;
    for (uint32_t k = 0; model->left_out_count > 0 && k < model->row_count; ++k) {
        const int depends = model->rows[k].left_out == SE3DI_ROW_DEPENDENT;
        const double gap = depends ? se3di_row_measure(model, k, size) : 0.0;
        if (gap > model->left_out_gap && isfinite(gap)) {
            model->left_out_gap = gap;
            model->left_out_row = k;
        }
    }
}
