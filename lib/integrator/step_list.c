/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/step_list.h"

#include "integrator/kink_step.h"
#include "math/steps.h"

void se3di_step_list_begin(const se3di_integration *integration, double t)
{
    se3di_step_list *steps = integration->record;
    if (steps) {
        steps->count = 0;
        steps->begin = t;
        ++steps->number;
    }
}

se3d_status se3di_step_list_note(const se3di_integration *integration, double end)
{
    se3di_step_list *steps = integration->record;
    if (!steps) {
        return SE3D_OK;
    }
    void *ends = steps->ends;
    const se3d_status status =
        se3di_array_reserve(&integration->equations->assembly.model->allocator, &ends,
                            &steps->capacity, steps->count + 1, sizeof(double));
    steps->ends = ends;
    if (status < 0) {
        return se3di_error_set(integration->equations->error, status,
                               "no memory for a list of steps");
    }
    steps->ends[steps->count++] = end;
    return SE3D_OK;
}

se3d_status se3di_step_list_next(se3di_integration *integration, double begin, double *h,
                                 double *end)
{
    const se3di_step_list *steps = integration->repeat;
    size_t *k = &integration->repeated;
    if (integration->repeated_number != steps->number) {
        integration->repeated_number = steps->number;
        *k = 0;
    }
    while (*k < steps->count && !(steps->ends[*k] > begin)) {
        ++*k;
    }
    if (*k == steps->count || begin < steps->begin) {
        return se3di_step_list_fail(integration);
    }
    const double whole = steps->ends[*k] - begin;
    *end = steps->ends[*k];
    *h = se3di_kink_step(integration, begin, whole, whole, end);
    if (integration->at_kink) {
        *h = 0.0;
        return SE3D_OK;
    }
    *h = se3di_step_length(begin, *end, *h);
    return se3di_equations_try_step(integration->equations, begin);
}

se3d_status se3di_step_list_fail(const se3di_integration *integration)
{
    return se3di_error_set(integration->equations->error, SE3D_ERR_STEP_SIZE,
                           "t = %g s: the step of another run cannot be repeated from here",
                           integration->equations->assembly.model->time);
}
