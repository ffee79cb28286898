/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: primitives as constraints of their own. */
#include "joint/draft.h"
#include "math/vec3.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

#include <string.h>

void se3d_primitive_def_init(se3d_primitive_def *def, size_t size)
{
    se3d_primitive_def full = {.struct_size = size};
    se3di_def_init(def, size, &full, sizeof full);
}

static se3d_status check_vector(se3d_system *system, const char *what, const double v[3],
                                double out[3])
{
    double unit[3];
    SE3DI_TRY(se3di_check_direction(system, what, v, unit));
    se3di_copy(v, out); /* the length counts: Phi is as the user wrote it */
    return SE3D_OK;
}

/* Directions and points that the type uses; the others are ignored. */
static se3d_status fill_term(se3d_system *system, const se3d_primitive_def *def, se3di_term *term)
{
    int dp1 = def->type == SE3D_PRIMITIVE_DP1;
    if (dp1 || def->type == SE3D_PRIMITIVE_DP2) {
        SE3DI_TRY(check_vector(system, "a_i", def->a_i, term->a_i));
    }
    if (dp1) {
        return check_vector(system, "a_j", def->a_j, term->a_j);
    }
    if (def->type == SE3D_PRIMITIVE_CD) {
        SE3DI_TRY(check_vector(system, "c", def->c, term->c));
    }
    SE3DI_TRY(se3di_check_finites(system, "point_i", def->point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", def->point_j, 3));
    se3di_copy(def->point_i, term->s_i);
    se3di_copy(def->point_j, term->s_j);
    return SE3D_OK;
}

static se3d_status check_value(se3d_system *system, int type, double value, int32_t function)
{
    SE3DI_TRY(se3di_check_prescribed(system, value, function));
    if (type == SE3D_PRIMITIVE_D && function < 0 && !(value > 0.0)) {
        return SE3DI_FAIL_OF(system, "value", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g m^2, must be > 0 (a squared distance; points that coincide "
                             "are three cd)",
                             value);
    }
    return SE3D_OK;
}

se3d_status se3d_constraint_set_value(se3d_system *system, se3d_constraint handle, double value)
{
    SE3DI_SET(system);
    uint32_t index;
    se3di_model *model = &system->model;
    SE3DI_TRY(se3di_find_constraint(system, "constraint", handle, &index));
    const se3di_constraint *constraint = &model->constraints[index];
    if (!constraint->has_value) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "a %s constraint has no value to set, must be a driver, a primitive or a "
                          "coupler",
                          constraint->type);
    }
    se3di_row *row = &model->rows[constraint->row_begin];
    if (row->function >= 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "the value of the %s is a function, set that", constraint->type);
    }
    SE3DI_TRY(check_value(system, model->terms[row->term_begin].type, value, -1));
    if (memcmp(&row->value, &value, sizeof value) != 0) {
        row->value = value;
        se3di_model_touch_values(model);
    }
    return SE3D_OK;
}

se3d_status se3d_primitive_create(se3d_system *system, const se3d_primitive_def *user,
                                  se3d_constraint *constraint)
{
    SE3DI_CREATE(system, constraint);
    se3d_primitive_def def = se3d_primitive_def_default();
    uint32_t bodies[2];
    int32_t function;
    se3di_draft draft;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def.name));
    if (def.type < SE3D_PRIMITIVE_DP1 || def.type > SE3D_PRIMITIVE_CD) {
        return SE3DI_FAIL_OF(system, "type", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be one of se3d_primitive_type (0 to 3)", (int)def.type);
    }
    SE3DI_TRY(se3di_find_body(system, "body_i", def.body_i, &bodies[0]));
    SE3DI_TRY(se3di_find_body(system, "body_j", def.body_j, &bodies[1]));
    SE3DI_TRY(se3di_check_distinct(system, bodies));
    se3di_term term = {.type = def.type, .angle = -1, .body_i = bodies[0], .body_j = bodies[1]};
    SE3DI_TRY(fill_term(system, &def, &term));
    SE3DI_TRY(se3di_find_function(system, "function", def.function, 1, &function));
    SE3DI_TRY(check_value(system, def.type, def.value, function));
    se3di_primitive_draft(def.name, &term, (se3di_prescribed){def.value, function}, &draft);
    return se3di_constraint_add(system, &draft, constraint);
}
