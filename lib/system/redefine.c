/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: elements that are defined again. The element that a creation would add takes the
 * place of the one that is there, with its handle, its name and all that refers to it. */
#include "joint/joint.h"
#include "system/definition.h"
#include "system/system_internal.h"

#include <string.h>

#define REDEFINE(kind, name, definition, create)                                                   \
    se3d_status se3d_##name(se3d_system *system, se3d_##kind kind, const definition *def)          \
    {                                                                                              \
        uint32_t index;                                                                            \
        se3d_##kind same;                                                                          \
        SE3DI_EDIT(system);                                                                        \
        SE3DI_TRY(se3di_find_##kind(system, #kind, kind, &index));                                 \
        system->model.target = index + 1;                                                          \
        const se3d_status status = create(system, def, &same);                                     \
        system->model.target = 0;                                                                  \
        return status;                                                                             \
    }

/* A body that is held stays so: definitions do not say it. */
static se3d_status create_body(se3d_system *system, const se3d_body_def *def, se3d_body *body)
{
    const uint32_t index = system->model.target - 1;
    if (index == 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "the ground cannot be defined again");
    }
    const int32_t held = system->model.bodies[index].held;
    SE3DI_TRY(se3d_body_create(system, def, body));
    system->model.bodies[index].held = held;
    return SE3D_OK;
}

/* A joint of the same type. Drivers and couplers have copies of what their joints are made of. */
static se3d_status create_joint(se3d_system *system, const se3d_joint_def *def,
                                se3d_constraint *joint)
{
    static const struct {
        const char *type;
        se3d_status (*create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);
    } table[] = {
#define JOINT(name, flags) {#name, se3d_joint_create_##name},
        SE3DI_JOINT_LIST(JOINT)
#undef JOINT
    };
    const se3di_model *model = &system->model;
    const uint32_t index = model->target - 1;
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        for (int c = 0; c < SE3D_COUPLER_TERMS_MAX; ++c) {
            if (model->constraints[k].joints[c] == (int32_t)index) {
                return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                                  "the joint has drivers or couplers, which are made of what it is "
                                  "now; destroy them first");
            }
        }
    }
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].type, model->constraints[index].type) == 0) {
            return table[k].create(system, def, joint);
        }
    }
    return SE3DI_FAIL_OF(system, "constraint", SE3D_ERR_INVALID_ARGUMENT,
                         " is a %s, must be a joint between two bodies",
                         model->constraints[index].type);
}

REDEFINE(body, body_set_def, se3d_body_def, create_body)
REDEFINE(marker, marker_set_def, se3d_marker_def, se3d_marker_create)
REDEFINE(road, road_set_def, se3d_road_def, se3d_road_create)
REDEFINE(wheel, wheel_set_def, se3d_wheel_def, se3d_wheel_create)
REDEFINE(constraint, joint_set_def, se3d_joint_def, create_joint)
REDEFINE(constraint, coupler_set_def, se3d_coupler_def, se3d_joint_create_coupler)
REDEFINE(constraint, driver_set_def, se3d_driver_def, se3d_driver_create)
REDEFINE(constraint, primitive_set_def, se3d_primitive_def, se3d_primitive_create)
REDEFINE(constraint, user_constraint_set_def, se3d_user_constraint_def, se3d_user_constraint_create)
REDEFINE(force, force_set_tsda, se3d_tsda_def, se3d_force_create_tsda)
REDEFINE(force, force_set_rsda, se3d_rsda_def, se3d_force_create_rsda)
REDEFINE(force, force_set_bushing_def, se3d_bushing_def, se3d_force_create_bushing)
REDEFINE(force, force_set_friction, se3d_friction_def, se3d_force_create_friction)
REDEFINE(force, force_set_stop, se3d_stop_def, se3d_force_create_stop)
REDEFINE(force, force_set_effort, se3d_effort_def, se3d_force_create_effort)
REDEFINE(force, force_set_armature, se3d_armature_def, se3d_force_create_armature)
REDEFINE(force, force_set_callback, se3d_force_callback_def, se3d_force_create_callback)
REDEFINE(force, force_set_tyre, se3d_tyre_def, se3d_force_create_tyre)

/* A force or a torque, as the element is one. */
static se3d_status create_load(se3d_system *system, const se3d_load_def *def, se3d_force *force)
{
    const se3di_force *data = &system->model.forces[system->model.target - 1];
    return data->type == SE3DI_FORCE_TORQUE ? se3d_force_create_torque(system, def, force)
                                            : se3d_force_create_load(system, def, force);
}
REDEFINE(force, force_set_load, se3d_load_def, create_load)
