/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over particles. */
#include "particles/average.h"

#include "base/sized.h"
#include "system/particles.h"

#include <string.h>

#define SIZE_LEAST 1e-30
#define SIZE_MOST  1e30

static int is_box(const double lower[3], const double upper[3])
{
    int is = 1;
    for (int a = 0; a < 3; ++a) {
        is = is && lower[a] >= -SIZE_MOST && upper[a] <= SIZE_MOST &&
             upper[a] - lower[a] >= SIZE_LEAST;
    }
    return is;
}

se3d_status se3d_particles_get_average_sized(const se3d_particles *particles, const double lower[3],
                                             const double upper[3], int32_t tag,
                                             se3d_average *average, size_t size)
{
    SE3DI_OWNED(particles);
    if (!lower || !upper || !average) {
        return SE3D_ERR_NULL;
    }
    if (!is_box(lower, upper) || tag < -1 || tag >= SE3D_PARTICLES_TAGS) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_average_box box = {.tag = tag, .contacts = se3di_particles_are_current(particles)};
    se3d_average full;
    se3di_reading reading;
    memcpy(box.lower, lower, sizeof box.lower);
    memcpy(box.upper, upper, sizeof box.upper);
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    se3di_particles_average(&particles->set, &box, &full);
    SE3DI_TRY(se3di_read_end(&reading, SE3D_OK));
    return se3di_sized_give(average, size, &full, sizeof full);
}
