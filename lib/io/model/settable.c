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

se3d_status se3di_rate_get_place(const se3d_model *model, se3d_function rate, double *time,
                                 double *place)
{
    double jet[3] = {0.0, 0.0, 0.0};
    se3d_system_get_time(model->system, time);
    const se3d_status status = se3d_function_eval(model->system, rate, time, jet);
    *place = jet[0];
    return status;
}

/* Set a rate at a time. */
static se3d_status set_rate(const se3d_model *model, se3d_function rate, double time, double value)
{
    const se3d_status status = se3d_system_set_time(model->system, time);
    return status < 0 ? status : se3d_function_set_constant(model->system, rate, value);
}

/* A second of what is missing, until the bits are those. */
se3d_status se3di_rate_put_place(const se3d_model *model, se3d_function rate, double time,
                                 double place, double value)
{
    const double one = 1.0;
    double jet[3] = {0.0, 0.0, 0.0};
    se3d_status status = set_rate(model, rate, one, 0.0);
    for (int tries = 0; tries < 4 && status >= 0; ++tries) {
        status = se3d_function_eval(model->system, rate, &one, jet);
        if (status < 0 || !(jet[0] != place)) {
            break;
        }
        status = set_rate(model, rate, 0.0, place - jet[0]);
        status = status < 0 ? status : set_rate(model, rate, one, 0.0);
    }
    return status < 0 ? status : set_rate(model, rate, time, value);
}
