/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/user.h"

#include "math/quaternion.h"

#include <stdio.h>
#include <string.h>

void se3di_user_begin(se3di_model *model)
{
    model->user_failure = (se3di_user_failure){0};
}

se3d_status se3di_user_report(se3di_model *model, se3di_error *error)
{
    const se3di_user_failure failure = model->user_failure;
    if (failure.status >= 0) {
        return SE3D_OK;
    }
    if (failure.status == SE3D_ERR_NOT_FINITE) {
        se3di_user_begin(model);
    }
    const char *name = model->constraints[failure.constraint].name;
    char number[32];
    snprintf(number, sizeof number, "%u", failure.constraint);
    if (model->constraints[failure.constraint].law_class) {
        return se3di_error_set(error, failure.status,
                               "t = %g s: the value of driver %.80s is not finite", failure.time,
                               name ? name : number);
    }
    return se3di_error_set(
        error, failure.status, "t = %g s: the callback of user constraint %.80s %s", failure.time,
        name ? name : number,
        failure.status == SE3D_ERR_CALLBACK ? "reports a failure"
                                            : "wrote a number that is not finite");
}

void se3di_user_find_failure(se3di_model *model)
{
    for (uint32_t k = 0; k < model->constraint_slots.count && model->user_failure.status >= 0;
         ++k) {
        se3di_user_values values;
        if (se3di_is_user(&model->constraints[k]) &&
            se3di_user_eval(model, &model->constraints[k], model->time, SE3DI_USER_NU, &values) ==
                SE3D_ERR_CALLBACK) {
            model->user_failure = (se3di_user_failure){
                .time = model->time, .status = SE3D_ERR_CALLBACK, .constraint = k};
        }
    }
}

static se3d_status eval(const se3di_assembly *assembly, uint32_t k, int wanted,
                        se3di_user_values *values)
{
    se3di_model *model = assembly->model;
    if (se3di_is_broken(&model->constraints[k], model->rows)) { /* it prescribes nothing */
        memset(values, 0, sizeof *values);
        return SE3D_OK;
    }
    if (model->user_failure.status == SE3D_ERR_CALLBACK) { /* it is not called again */
        memset(values, 0, sizeof *values);
        return SE3D_ERR_CALLBACK;
    }
    se3d_status status =
        se3di_user_eval(model, &model->constraints[k], assembly->time, wanted, values);
    if (status < 0 && model->user_failure.status >= 0) {
        model->user_failure = (se3di_user_failure){
            .time = assembly->time, .status = (int32_t)status, .constraint = k};
    }
    return status;
}

void se3di_user_eval_phi(const se3di_assembly *assembly, double *phi)
{
    const se3di_constraint *constraints = assembly->model->constraints;
    for (uint32_t k = 0; assembly->user_count > 0 && k < assembly->constraint_count; ++k) {
        se3di_user_values values;
        if (se3di_is_user(&constraints[k])) {
            (void)eval(assembly, k, SE3DI_USER_PHI, &values);
            memcpy(phi + constraints[k].row_begin, values.phi,
                   constraints[k].row_count * sizeof *phi);
        }
    }
}

void se3di_user_eval_gamma(const se3di_assembly *assembly, double *gamma)
{
    const se3di_constraint *constraints = assembly->model->constraints;
    for (uint32_t k = 0; assembly->user_count > 0 && k < assembly->constraint_count; ++k) {
        se3di_user_values values;
        if (se3di_is_user(&constraints[k])) {
            (void)eval(assembly, k, SE3DI_USER_GAMMA, &values);
            memcpy(gamma + constraints[k].row_begin, values.gamma,
                   constraints[k].row_count * sizeof *gamma);
        }
    }
}

/* row [block]: six numbers of a callback in the unknowns of the formulation */
static void put_row(const se3di_assembly *assembly, const se3di_frame *frame, const double *from,
                    double *row)
{
    memset(row, 0, (size_t)assembly->formulation->block * sizeof *row);
    memcpy(row, from, 3 * sizeof *row);
    if (assembly->formulation->size == 6) {
        memcpy(row + 3, from + 3, 3 * sizeof *row);
        return;
    }
    double turned[4];
    se3di_g_transposed_mul(frame->p, from + 3, turned);
    for (int c = 0; c < 4; ++c) {
        row[3 + c] = 2.0 * turned[c];
    }
}

static void eval_joint(se3di_assembly *assembly, uint32_t joint)
{
    const se3di_constraint *constraint = &assembly->model->constraints[joint];
    se3di_user_values values;
    (void)eval(assembly, joint, SE3DI_USER_JACOBIAN | SE3DI_USER_NU, &values);
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        const uint32_t row = constraint->row_begin + r;
        assembly->f[3 * (size_t)row + 1] = assembly->model->rows[row].left_out ? 0.0 : values.nu[r];
    }
    int32_t place =
        assembly->joint_begin[joint]; /* the free bodies follow in the callback's order */
    for (uint32_t k = 0; k < se3di_user_body_count(constraint); ++k) {
        uint32_t body = constraint->bodies[constraint->user_first + k];
        if (assembly->free_index[body] < 0) {
            continue;
        }
        double *block = assembly->C + assembly->block_offset[place++];
        for (uint32_t r = 0; r < constraint->row_count; ++r) {
            put_row(assembly, &assembly->model->frames[body],
                    se3di_user_row(constraint, &values, r, k),
                    block + r * (size_t)assembly->formulation->block);
        }
    }
}

void se3di_user_eval_jacobian(se3di_assembly *assembly)
{
    for (uint32_t k = 0; assembly->user_count > 0 && k < assembly->constraint_count; ++k) {
        if (se3di_is_user(&assembly->model->constraints[k])) {
            eval_joint(assembly, k);
        }
    }
}
