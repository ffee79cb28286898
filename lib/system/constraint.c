/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: what primitives, joints and drivers have in common: names, counts, values and
 * Jacobians of their equations. */
#include "joint/equation.h"
#include "system/definition.h"
#include "system/system_internal.h"

#include <string.h>

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
                          "'%.64s' (%s) is used by %u driver(s), coupler(s), force(s) or wheel(s), "
                          "destroy them first",
                          found->name ? found->name : "", found->type, found->users);
    }
    se3di_model_remove_constraint(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_constraint_find(const se3d_system *system, const char *name,
                                 se3d_constraint *constraint)
{
    return se3di_read_named(SE3DI_SLOTS(system, constraint), name, constraint);
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
    const se3d_status status = find_for(system, constraint, name, &found);
    return se3di_give_name(status, found ? found->name : NULL, name);
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

/* Of what was found, 0 if nothing was. */
static se3d_status give_count(se3d_status found, size_t own, size_t *count)
{
    if (count) {
        *count = own;
    }
    return found;
}

se3d_status se3d_constraint_count_equations(const se3d_system *system, se3d_constraint constraint,
                                            size_t *count)
{
    const se3di_constraint *found;
    const se3d_status status = find_for(system, constraint, count, &found);
    return give_count(status, found ? found->row_count : 0, count);
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
    const se3d_status status = find_for(system, constraint, count, &found);
    return give_count(status, found ? found->body_count : 0, count);
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
    *body = se3di_body_handle(&system->model, found->bodies[slot]);
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
        status = se3di_equation_eval(&system->model, found, r, formulation, result);
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
        status = se3di_equation_jacobian(&system->model, found, r, formulation, found->bodies[slot],
                                         row);
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
    SE3DI_TRY(se3di_check_solved(system));
    memcpy(lambda, system->model.lambda + found->row_begin, found->row_count * sizeof *lambda);
    return SE3D_OK;
}
