/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/direction.h"

#include "math/vec3.h"

#include <math.h>
#include <string.h>

se3d_status se3di_finites_check(const char *what, const double *values, int count,
                                se3di_error *error)
{
    for (int k = 0; k < count; ++k) {
        if (!isfinite(values[k])) {
            return se3di_error_set_of(error, what, SE3D_ERR_INVALID_ARGUMENT,
                                      "[%d] = %g, must be finite", k, values[k]);
        }
    }
    return SE3D_OK;
}

se3d_status se3di_direction_read(const char *what, const double values[3], double unit[3],
                                 se3di_error *error)
{
    SE3DI_TRY(se3di_finites_check(what, values, 3, error));
    if (se3di_is_unit(values, 3)) {
        memcpy(unit, values, 3 * sizeof *unit);
        return SE3D_OK;
    }
    if (!se3di_unit(values, unit)) {
        return se3di_error_set_of(error, what, SE3D_ERR_INVALID_ARGUMENT,
                                  " = [%g, %g, %g], must be a direction (not zero)", values[0],
                                  values[1], values[2]);
    }
    return SE3D_OK;
}
