/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/integrator.h"

#include <math.h>
#include <stddef.h>

static const se3di_integrator *const methods[] = {[SE3D_METHOD_AUTO] = &se3di_integrator_dop853,
#define ROW(METHOD, name) [SE3D_METHOD_##METHOD] = &se3di_integrator_##name,
                                                  SE3DI_METHOD_LIST(ROW)
#undef ROW
};

#define COUNT_ONE(METHOD, name) +1
_Static_assert(sizeof methods / sizeof *methods == 1 SE3DI_METHOD_LIST(COUNT_ONE),
               "se3d_method numbers the methods of the list without a gap");
#undef COUNT_ONE

const se3di_integrator *se3di_integrator_find(int32_t method)
{
    const int32_t count = (int32_t)(sizeof methods / sizeof *methods);
    return method >= 0 && method < count ? methods[method] : NULL;
}

const se3di_integrator *se3di_integrator_of_history(uint64_t tag)
{
    const uint64_t method = tag / SE3DI_HISTORY_TAGS;
    return method != SE3D_METHOD_AUTO && method <= INT32_MAX
               ? se3di_integrator_find((int32_t)method)
               : NULL;
}

int se3di_integration_must_leave(const se3di_integration *integration)
{
    const se3di_integrator_settings *settings = &integration->settings;
    return (settings->leaves_stiff || settings->leaves_crowd) && integration->method->is_held &&
           integration->method->is_held(integration);
}

double se3di_integration_get_tolerance(const se3di_integration *integration,
                                       const se3di_model *model)
{
    const se3di_integrator *method = integration->method;
    const double reach = method->get_reach ? method->get_reach(integration, model) : method->reach;
    const int is_controlled =
        reach > 0.0 && !(method->fixes_step && integration->settings.step > 0.0);
    return is_controlled ? fmax(integration->settings.tolerance, reach) : 0.0;
}
