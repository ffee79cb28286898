/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/left_out.h"

#include <string.h>

void se3di_left_out_clear_values(const se3di_assembly *assembly, double *values)
{
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; model->left_out_count > 0 && k < assembly->row_count; ++k) {
        values[k] = model->rows[k].left_out ? 0.0 : values[k];
    }
}

static void clear_joint(const se3di_assembly *assembly, uint32_t joint, double *C)
{
    const size_t n = (size_t)assembly->formulation->block;
    const se3di_row *rows = assembly->model->rows + assembly->model->constraints[joint].row_begin;
    for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
        double *block = C + assembly->block_offset[k];
        for (int32_t r = 0; r < assembly->joint_rows[joint]; ++r, block += n) {
            if (rows[r].left_out) {
                memset(block, 0, n * sizeof *block);
            }
        }
    }
}

void se3di_left_out_clear_blocks(const se3di_assembly *assembly, double *C)
{
    const uint32_t count = assembly->model->left_out_count > 0 ? assembly->constraint_count : 0;
    for (uint32_t joint = 0; joint < count; ++joint) {
        clear_joint(assembly, joint, C);
    }
}
