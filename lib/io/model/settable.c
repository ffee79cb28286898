/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/model/settable.h"

static se3d_status set_load(const se3d_model *model, se3d_force force, size_t component, double to)
{
    double value[3];
    const se3d_status status = se3d_force_get_value(model->system, force, value);
    value[component] = to;
    return status < 0 ? status : se3d_force_set_value(model->system, force, value);
}

se3d_status se3di_element_set(const se3d_model *model, size_t element, size_t component,
                              double value)
{
    const se3di_element_entry *e = &model->elements[element];
    if (e->kind == SE3DI_ELEMENT_DRIVER) {
        return e->rate.index1 ? se3d_function_set_constant(model->system, e->rate, value)
                              : se3d_constraint_set_value(model->system, e->constraint, value);
    }
    return e->body.index1 == 0 ? se3d_effort_set(model->system, e->force, value)
                               : set_load(model, e->force, component, value);
}
