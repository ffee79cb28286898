/* SPDX-License-Identifier: BSD-3-Clause */
/* The channels that a model has, for those who look for a name. */
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/sized.h"
#include "io/channel/channel.h"
#include "io/model/model.h"

enum { ELEMENTS_MAX = 10000 };

/* What is an angle though expressions take it for a number. */
static const char *angle_unit(se3di_quantity quantity)
{
    switch (quantity) {
    case SE3DI_WHEEL_CAMBER:
    case SE3DI_WHEEL_INCLINATION:
    case SE3DI_WHEEL_STEER:
    case SE3DI_WHEEL_TOE:
    case SE3DI_WHEEL_ACKERMANN_ERROR:
    case SE3DI_WHEEL_CASTER:
    case SE3DI_WHEEL_KINGPIN_INCLINATION:
    case SE3DI_TYRE_SLIP_ANGLE:
    case SE3DI_TYRE_INCLINATION:
        return "rad";
    case SE3DI_WHEEL_CAMBER_GRADIENT:
    case SE3DI_WHEEL_TOE_GRADIENT:
        return "rad/m";
    default:
        return NULL;
    }
}

/* "m/s^2": what stands in brackets in "an acceleration [m/s^2]". */
static const char *find_unit(se3di_iopool *pool, const se3di_channel *channel)
{
    char text[120];
    const char *angle = angle_unit(channel->quantity);
    if (angle) {
        return angle;
    }
    se3di_dimension_describe(se3di_channel_get_dimension(channel), text, sizeof text);
    const char *begin = strchr(text, '[');
    const char *end = begin ? strchr(begin, ']') : NULL;
    return end ? se3di_iopool_copy(pool, begin + 1, (size_t)(end - begin - 1)) : "";
}

se3d_status se3d_model_list_channels(se3d_model *model, size_t *count)
{
    size_t found = 0;
    if (!model || !count) {
        return SE3D_ERR_NULL;
    }
    *count = 0;
    if (model->listed) {
        *count = model->listed_count;
        return SE3D_OK;
    }
    const se3di_channel *all = se3di_channel_list_all(model, ELEMENTS_MAX, &found);
    se3d_model_channel *list = se3di_iopool_array(&model->pool, found, sizeof *list);
    if (!all || !list) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < found; ++k) {
        list[k].name = all[k].name;
        list[k].width = se3di_channel_get_width(&all[k]);
        list[k].unit = find_unit(&model->pool, &all[k]);
        if (!list[k].unit) {
            return SE3D_ERR_NO_MEMORY;
        }
    }
    model->listed = list;
    model->listed_count = *count = found;
    return SE3D_OK;
}

se3d_status se3d_model_get_listed_channel_sized(const se3d_model *model, size_t k,
                                                se3d_model_channel *channel, size_t size)
{
    return SE3DI_IO_GIVE_ENTRY(channel, size, model, k, listed_count, listed[k]);
}
