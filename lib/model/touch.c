/* SPDX-License-Identifier: BSD-3-Clause */
/* What no longer holds when something of a model has changed: versions, what steps remember, which
 * rows broken joints leave out. */
#include "model/edit.h"
#include "model/state.h"

#include <string.h>

void se3di_model_touch_state(se3di_model *model)
{
    model->settled &= ~SE3DI_SETTLED;
    model->history_tag = 0;
    ++model->history_stamp;
    ++model->poses_version;
    model->work_valid = se3di_has_work(model) ? SE3DI_WORK_LEFT : SE3DI_WORK_NONE;
    if (!model->remembers) {
        return;
    }
    model->remembers = model->shows_before = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        memset(model->forces[k].state, 0, sizeof model->forces[k].state);
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        memset(model->shapes[k].force, 0, sizeof model->shapes[k].force);
        memset(model->shapes[k].torque, 0, sizeof model->shapes[k].torque);
    }
    model->contacts.count = 0;
    model->contacts.step = 0.0;
}

void se3di_model_follow_breaks(se3di_model *model)
{
    model->left_out_count = model->broken_count = 0;
    for (size_t k = 0; k < model->row_count; ++k) {
        model->left_out_count += model->rows[k].left_out != 0;
        model->broken_count += (model->rows[k].left_out & SE3DI_ROW_BROKEN) != 0;
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const int32_t joint = model->forces[k].joint;
        model->forces[k].released =
            joint >= 0 && se3di_is_broken(&model->constraints[joint], model->rows);
    }
    model->contacts.version = 0; /* others may touch */
    ++model->break_version;
}

void se3di_model_take_all_rows(se3di_model *model)
{
    for (size_t k = 0; model->left_out_count > 0 && k < model->row_count; ++k) {
        model->rows[k].left_out &= SE3DI_ROW_BREAKS;
    }
    model->left_out_count = model->broken_count;
    model->left_out_row = 0;
    model->left_out_gap = 0.0;
    model->ranks_known = 0;
}

/* It prescribes a coordinate of the joint, or couples it to others. */
static int acts_on(const se3di_constraint *constraint, uint32_t joint)
{
    int acts = 0;
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        acts |= constraint->joints[k] == (int32_t)joint;
    }
    return acts;
}

/* Of what acts on several joints, one that is broken is enough. */
static int acts_on_broken(const se3di_model *model, const se3di_constraint *constraint)
{
    int broken = 0;
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        const int32_t joint = constraint->joints[k];
        broken |= joint >= 0 && se3di_is_broken(&model->constraints[joint], model->rows);
    }
    return broken;
}

/* What is broken already stays as it is: its bodies may have been apart. */
void se3di_constraint_leave_out(se3di_model *model, const se3di_constraint *constraint, int broken)
{
    if (broken && se3di_is_broken(constraint, model->rows)) {
        return;
    }
    for (uint32_t k = 0; k < constraint->row_count; ++k) {
        const uint32_t row = constraint->row_begin + k;
        model->rows[row].left_out = broken ? SE3DI_ROW_BROKEN : 0;
        model->lambda[row] = 0.0;
    }
}

void se3di_model_break(se3di_model *model, uint32_t joint, int32_t broken)
{
    se3di_constraint_leave_out(model, &model->constraints[joint], broken);
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (acts_on(constraint, joint)) {
            se3di_constraint_leave_out(model, constraint, acts_on_broken(model, constraint));
        }
    }
    se3di_model_follow_breaks(model);
    se3di_model_take_all_rows(model);
    model->history_tag = 0;
    ++model->history_stamp;
}

void se3di_model_touch_poses(se3di_model *model)
{
    se3di_model_take_all_rows(model);
    se3di_model_touch_state(model);
}

/* Elements came or went: of those that are there, what acts on a broken joint does not. */
static void follow_edit(se3di_model *model)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (acts_on_broken(model, constraint)) {
            se3di_constraint_leave_out(model, constraint, 1);
        }
    }
    se3di_model_follow_breaks(model);
}

void se3di_model_touch(se3di_model *model)
{
    ++model->topology_version;
    if (model->broken_count > 0) {
        follow_edit(model);
    }
    se3di_model_touch_poses(model);
}

/* The next version, another one than of any clone: states go from one to the other, and with them
 * which version they belong to. Versions are only compared. */
static void renew(const se3di_model *model, uint64_t *version)
{
    *version = *version * UINT64_C(6364136223846793005) + 2 * (uint64_t)(uintptr_t)model + 1;
}

void se3di_model_touch_inputs(se3di_model *model)
{
    renew(model, &model->inputs_version);
    model->settled &= ~SE3DI_SETTLED;
}

void se3di_model_touch_contact(se3di_model *model)
{
    renew(model, &model->contact_version);
    se3di_model_touch_inputs(model);
}

void se3di_model_touch_values(se3di_model *model)
{
    renew(model, &model->values_version);
    se3di_model_touch_inputs(model);
}
