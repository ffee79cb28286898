/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: linear relations of joint coordinates (coupler, gear, rack and pinion). One row
 * that copies the coordinates of the joints as terms; angles keep the joints' turn counters, so
 * that the relation holds over any number of turns.  docs/theory/joints.md */
#include "joint/draft.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void se3d_coupler_def_init(se3d_coupler_def *def, size_t size)
{
    se3d_coupler_def full = {.struct_size = size};
    se3di_def_init(def, size, &full, sizeof full);
}

static se3d_status check_term(se3d_system *system, const se3d_coupler_def *def, size_t k,
                              se3di_draft *draft)
{
    char what[48];
    uint32_t joint;
    se3di_term term;
    snprintf(what, sizeof what, "joint[%zu]", k);
    SE3DI_TRY(se3di_find_constraint(system, what, def->joint[k], &joint));
    snprintf(what, sizeof what, "coordinate[%zu]", k);
    SE3DI_TRY(se3di_check_coordinate(system, what, joint, def->coordinate[k], &term));
    snprintf(what, sizeof what, "ratio[%zu]", k);
    SE3DI_TRY(se3di_check_finite(system, what, def->ratio[k]));
    if (def->ratio[k] == 0.0) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = 0, must not be 0");
    }
    for (size_t i = 0; i < k; ++i) {
        if (def->joint[i].index1 == def->joint[k].index1 &&
            def->coordinate[i] == def->coordinate[k]) {
            return SE3DI_FAIL_OF(system, "joint", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] and joint[%zu] are the same coordinate of one joint, "
                                 "must be different",
                                 i, k);
        }
    }
    se3di_coupler_add_term(&system->model, joint, &term, def->ratio[k], draft);
    return SE3D_OK;
}

/* A draft of one row without its value. */
static se3d_status draft_build(se3d_system *system, const char *type, const se3d_coupler_def *def,
                               se3di_draft *draft)
{
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def->name));
    if (def->count < 1 || def->count > SE3D_COUPLER_TERMS_MAX) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT, " = %zu, must be 1 to %d",
                             def->count, SE3D_COUPLER_TERMS_MAX);
    }
    se3di_coupler_draft(type, def->name, draft);
    for (size_t k = 0; k < def->count; ++k) {
        SE3DI_TRY(check_term(system, def, k, draft));
    }
    return SE3D_OK;
}

/* Checks that the three creators share; `*joint` becomes the null handle. */
static se3d_status check_call(se3d_system *system, const char *function, se3d_constraint *joint)
{
    if (joint) {
        *joint = (se3d_constraint){0, 0};
    }
    SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, function));
    return se3di_check_pointer(system, "joint", joint);
}

/* What is defined again stays a gear, or a rack and pinion. */
static const char *type_of(const se3d_system *system)
{
    static const char *const others[] = {"gear", "rack_pinion"};
    const se3di_model *model = &system->model;
    for (size_t k = 0; k < 2 && model->target > 0; ++k) {
        if (strcmp(model->constraints[model->target - 1].type, others[k]) == 0) {
            return others[k];
        }
    }
    return "coupler";
}

se3d_status se3d_joint_create_coupler(se3d_system *system, const se3d_coupler_def *user,
                                      se3d_constraint *joint)
{
    SE3DI_TRY(check_call(system, __func__, joint));
    se3d_coupler_def def = se3d_coupler_def_default();
    se3di_draft draft;
    int32_t function;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(draft_build(system, type_of(system), &def, &draft));
    SE3DI_TRY(se3di_find_function(system, "function", def.function, 1, &function));
    SE3DI_TRY(se3di_check_prescribed(system, def.value, function));
    draft.constraint.has_value = 1;
    draft.rows[0].function = function;
    draft.rows[0].value = def.value;
    return se3di_constraint_add(system, &draft, joint);
}

/* Two terms whose sum keeps its present value. */
static se3d_status create_pair(se3d_system *system, const char *type, const se3d_coupler_def *def,
                               se3d_constraint *joint)
{
    se3di_draft draft;
    SE3DI_TRY(draft_build(system, type, def, &draft));
    se3di_draft_close(&system->model, &draft);
    const double value = draft.rows[0].value;
    if (!isfinite(value)) {
        return SE3DI_FAIL(system, SE3D_ERR_NOT_FINITE, "the present value of a %s is %g", type,
                          value);
    }
    return se3di_constraint_add(system, &draft, joint);
}

static se3d_status check_factor(se3d_system *system, const char *what, double factor)
{
    SE3DI_TRY(se3di_check_finite(system, what, factor));
    return factor != 0.0
               ? SE3D_OK
               : SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = 0, must not be 0");
}

se3d_status se3d_joint_create_gear(se3d_system *system, const char *name, se3d_constraint joint_1,
                                   se3d_constraint joint_2, double ratio, se3d_constraint *joint)
{
    SE3DI_TRY(check_call(system, __func__, joint));
    SE3DI_TRY(check_factor(system, "ratio", ratio));
    se3d_coupler_def def = se3d_coupler_def_default();
    def.name = name;
    def.count = 2;
    def.joint[0] = joint_1;
    def.joint[1] = joint_2;
    def.ratio[0] = ratio;
    def.ratio[1] = 1.0;
    return create_pair(system, "gear", &def, joint);
}

se3d_status se3d_joint_create_rack_pinion(se3d_system *system, const char *name,
                                          se3d_constraint pinion, se3d_constraint rack,
                                          double radius, se3d_constraint *joint)
{
    SE3DI_TRY(check_call(system, __func__, joint));
    SE3DI_TRY(check_factor(system, "radius", radius));
    se3d_coupler_def def = se3d_coupler_def_default();
    def.name = name;
    def.count = 2;
    def.joint[0] = pinion;
    def.joint[1] = rack;
    def.coordinate[1] = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def.ratio[0] = -radius;
    def.ratio[1] = 1.0;
    return create_pair(system, "rack_pinion", &def, joint);
}
