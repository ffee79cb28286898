/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: drivers, coordinate of a joint = f(t). One row of one term: the joint's angle (Phi
 * is taken modulo 2 pi: regular at every angle, no constraint is ever exchanged) or displacement.
 * The effort is -lambda, because the driver's virtual work on body j is -lambda per unit of the
 * coordinate.  docs/theory/reactions.md */
#include "joint/draft.h"
#include "joint/equation.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

void se3d_driver_def_init(se3d_driver_def *def, size_t size)
{
    se3d_driver_def full = {.struct_size = size};
    se3di_def_init(def, size, &full, sizeof full);
}

se3d_status se3d_driver_create(se3d_system *system, const se3d_driver_def *user,
                               se3d_constraint *driver)
{
    SE3DI_CREATE(system, driver);
    se3d_driver_def def = se3d_driver_def_default();
    uint32_t joint;
    se3di_term term;
    int32_t function;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def.name));
    SE3DI_TRY(se3di_find_constraint(system, "joint", def.joint, &joint));
    SE3DI_TRY(se3di_check_coordinate(system, "coordinate", joint, def.coordinate, &term));
    SE3DI_TRY(se3di_find_function(system, "function", def.function, 1, &function));
    SE3DI_TRY(se3di_check_prescribed(system, def.value, function));
    se3di_draft draft;
    se3di_driver_draft(&system->model, joint, def.coordinate, def.name,
                       (se3di_prescribed){def.value, function}, &draft);
    return se3di_constraint_add(system, &draft, driver);
}

/* The single row of a constraint. */
static se3d_status find_row(const se3d_system *system, se3d_constraint driver, const double *output,
                            uint32_t *row)
{
    if (!system || !output) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index = se3di_slots_find(&model->constraint_slots, driver.index1, driver.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    *row = model->constraints[index].row_begin;
    return model->constraints[index].row_count == 1 ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_driver_get_value(const se3d_system *system, se3d_constraint driver, double *value)
{
    if (value) {
        *value = 0.0;
    }
    uint32_t index;
    SE3DI_TRY(find_row(system, driver, value, &index));
    double jet[3];
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(
        &reading, se3di_row_prescribed(&system->model, &system->model.rows[index], jet)));
    *value = jet[0];
    return SE3D_OK;
}

se3d_status se3d_driver_get_effort(const se3d_system *system, se3d_constraint driver,
                                   double *effort)
{
    if (effort) {
        *effort = 0.0;
    }
    uint32_t index;
    SE3DI_TRY(find_row(system, driver, effort, &index));
    SE3DI_TRY(se3di_check_solved(system));
    *effort = -system->model.lambda[index];
    return SE3D_OK;
}
