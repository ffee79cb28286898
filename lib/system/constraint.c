/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: what primitives, joints and drivers have in common: names, counts, values and
 * Jacobians of their equations. */
#include "joint/user.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

#define PI     3.1415926535897932384626433832795
#define TWO_PI 6.283185307179586476925286766559

static const se3di_constraint *find(const se3d_system *system, se3d_constraint constraint)
{
    uint32_t index =
        se3di_slots_find(&system->model.constraint_slots, constraint.index1, constraint.generation);
    return index == SE3DI_NO_INDEX ? NULL : &system->model.constraints[index];
}

se3d_status se3d_constraint_destroy(se3d_system *system, se3d_constraint constraint)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_constraint(system, "constraint", constraint, &index));
    const se3di_constraint *found = &system->model.constraints[index];
    if (found->users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                          "'%.64s' (%s) is used by %u driver(s), coupler(s) or force(s), destroy "
                          "them first",
                          found->name ? found->name : "", found->type, found->users);
    }
    se3di_model_remove_constraint(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_constraint_find(const se3d_system *system, const char *name,
                                 se3d_constraint *constraint)
{
    if (constraint) {
        *constraint = (se3d_constraint){0, 0};
    }
    if (!system || !name || !constraint) {
        return SE3D_ERR_NULL;
    }
    se3di_handle handle = {0, 0};
    SE3DI_TRY(se3di_find_named(&system->model.constraint_slots, name, &handle));
    *constraint = (se3d_constraint){handle.index1, handle.generation};
    return SE3D_OK;
}

/* Find a constraint for a getter with one output. */
static se3d_status find_for(const se3d_system *system, se3d_constraint constraint,
                            const void *output, const se3di_constraint **found)
{
    *found = NULL;
    if (!system || !output) {
        return SE3D_ERR_NULL;
    }
    *found = find(system, constraint);
    return *found ? SE3D_OK : SE3D_ERR_STALE_HANDLE;
}

se3d_status se3d_constraint_get_name(const se3d_system *system, se3d_constraint constraint,
                                     const char **name)
{
    const se3di_constraint *found;
    se3d_status status = find_for(system, constraint, name, &found);
    if (name) {
        *name = !found ? NULL : found->name ? found->name : "";
    }
    return status;
}

se3d_status se3d_constraint_get_type(const se3d_system *system, se3d_constraint constraint,
                                     const char **type)
{
    const se3di_constraint *found;
    se3d_status status = find_for(system, constraint, type, &found);
    if (type) {
        *type = found ? found->type : NULL;
    }
    return status;
}

se3d_status se3d_constraint_count_equations(const se3d_system *system, se3d_constraint constraint,
                                            size_t *count)
{
    const se3di_constraint *found;
    se3d_status status = find_for(system, constraint, count, &found);
    if (count) {
        *count = found ? found->row_count : 0;
    }
    return status;
}

se3d_status se3d_constraint_get_equation_name(const se3d_system *system, se3d_constraint constraint,
                                              size_t k, const char **name)
{
    if (name) {
        *name = NULL;
    }
    const se3di_constraint *found;
    SE3DI_TRY(find_for(system, constraint, name, &found));
    if (k >= found->row_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *name = system->model.rows[found->row_begin + k].name;
    return SE3D_OK;
}

se3d_status se3d_constraint_count_bodies(const se3d_system *system, se3d_constraint constraint,
                                         size_t *count)
{
    const se3di_constraint *found;
    se3d_status status = find_for(system, constraint, count, &found);
    if (count) {
        *count = found ? found->body_count : 0;
    }
    return status;
}

se3d_status se3d_constraint_get_body(const se3d_system *system, se3d_constraint constraint,
                                     size_t slot, se3d_body *body)
{
    if (body) {
        *body = (se3d_body){0, 0};
    }
    const se3di_constraint *found;
    SE3DI_TRY(find_for(system, constraint, body, &found));
    if (slot >= found->body_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_handle handle = se3di_slots_handle(&system->model.body_slots, found->bodies[slot]);
    *body = (se3d_body){handle.index1, handle.generation};
    return SE3D_OK;
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

/* The same of row r of a constraint. */
static se3d_status equation_eval(const se3di_model *model, const se3di_constraint *constraint,
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

static void null_numbers(double *values, size_t count)
{
    for (size_t k = 0; values && k < count; ++k) {
        values[k] = 0.0;
    }
}

static int is_formulation(se3d_formulation formulation)
{
    return formulation == SE3D_FORMULATION_ROMEGA || formulation == SE3D_FORMULATION_RP;
}

se3d_status se3d_constraint_eval(const se3d_system *system, se3d_constraint constraint,
                                 se3d_formulation formulation, double *phi, double *nu,
                                 double *gamma)
{
    const se3di_constraint *found;
    SE3DI_TRY(find_for(system, constraint, system, &found));
    double *outputs[3] = {phi, nu, gamma};
    for (int k = 0; k < 3; ++k) {
        null_numbers(outputs[k], found->row_count);
    }
    if (!is_formulation(formulation)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_reading reading;
    se3d_status status = se3di_read_begin(system, &reading);
    SE3DI_TRY(status);
    for (uint32_t r = 0; r < found->row_count && status == SE3D_OK; ++r) {
        double result[3];
        status = equation_eval(&system->model, found, r, formulation, result);
        for (int k = 0; k < 3 && status == SE3D_OK; ++k) {
            if (outputs[k]) {
                outputs[k][r] = result[k];
            }
        }
    }
    for (int k = 0; k < 3 && status != SE3D_OK; ++k) {
        null_numbers(outputs[k], found->row_count);
    }
    return se3di_read_end(&reading, status);
}

/* Jacobian of a row with respect to one body: 3 + 3 (r-omega) or 3 + 4 (r-p) numbers. */
static void row_jacobian(const se3di_model *model, const se3di_row *row,
                         se3d_formulation formulation, uint32_t body, double out[7])
{
    int width = formulation == SE3D_FORMULATION_RP ? 7 : 6;
    null_numbers(out, 7);
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
    null_numbers(out, 7);
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

static se3d_status equation_jacobian(const se3di_model *model, const se3di_constraint *constraint,
                                     uint32_t r, se3d_formulation formulation, uint32_t body,
                                     double out[7])
{
    if (se3di_is_user(constraint)) {
        return user_jacobian(model, constraint, r, formulation, body, out);
    }
    row_jacobian(model, &model->rows[constraint->row_begin + r], formulation, body, out);
    return se3di_is_finite(out, 7) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3d_constraint_eval_jacobian(const se3d_system *system, se3d_constraint constraint,
                                          se3d_formulation formulation, size_t slot, double *phi_r,
                                          double *phi_rotation)
{
    const se3di_constraint *found;
    SE3DI_TRY(find_for(system, constraint, system, &found));
    if (!is_formulation(formulation)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    size_t width = formulation == SE3D_FORMULATION_RP ? 4 : 3;
    null_numbers(phi_r, found->row_count * 3);
    null_numbers(phi_rotation, found->row_count * width);
    if (slot >= found->body_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_reading reading;
    se3d_status status = se3di_read_begin(system, &reading);
    SE3DI_TRY(status);
    for (uint32_t r = 0; r < found->row_count && status == SE3D_OK; ++r) {
        double row[7];
        status = equation_jacobian(&system->model, found, r, formulation, found->bodies[slot], row);
        if (phi_r) {
            memcpy(phi_r + 3 * r, row, 3 * sizeof *row);
        }
        if (phi_rotation) {
            memcpy(phi_rotation + width * r, row + 3, width * sizeof *row);
        }
    }
    if (status < 0) {
        null_numbers(phi_r, found->row_count * 3);
        null_numbers(phi_rotation, found->row_count * width);
    }
    return se3di_read_end(&reading, status);
}

se3d_status se3d_constraint_get_multipliers(const se3d_system *system, se3d_constraint constraint,
                                            double *lambda)
{
    const se3di_constraint *found;
    SE3DI_TRY(find_for(system, constraint, lambda, &found));
    memcpy(lambda, system->model.lambda + found->row_begin, found->row_count * sizeof *lambda);
    return SE3D_OK;
}

void se3di_constraint_wrench(const se3di_model *model, const se3di_constraint *constraint,
                             uint32_t body, double force[3], double torque[3])
{
    double moment[3] = {0.0, 0.0, 0.0}; /* body frame */
    null_numbers(force, 3);
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        double row[7];
        double lambda = model->lambda[constraint->row_begin + r];
        if (equation_jacobian(model, constraint, r, SE3D_FORMULATION_ROMEGA, body, row) < 0) {
            row[0] = row[3] = (double)NAN; /* the caller reports NOT_FINITE */
        }
        se3di_add_scaled(-lambda, row, force);
        se3di_add_scaled(-lambda, row + 3, moment);
    }
    se3di_mul(model->frames[body].A, moment, torque);
}
