/* SPDX-License-Identifier: BSD-3-Clause */
/* Markers: points with a frame on a body. */
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#include <string.h>

void se3d_marker_def_init(se3d_marker_def *def, size_t size)
{
    se3d_marker_def defaults = {.struct_size = size, .orientation = {1.0, 0.0, 0.0, 0.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

se3d_status se3d_marker_create(se3d_system *system, const se3d_marker_def *def, se3d_marker *marker)
{
    SE3DI_CREATE(system, marker);
    se3d_marker_def full = se3d_marker_def_default();
    se3di_marker data = {0};
    SE3DI_TRY(se3di_check_def(system, "marker def", def, &full, sizeof full));
    SE3DI_TRY(se3di_find_body(system, "body", full.body, &data.body));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.marker_slots,
                                   se3di_model_owner(&system->model, data.body),
                                   "marker of this body", full.name));
    SE3DI_TRY(se3di_check_finites(system, "position", full.position, 3));
    SE3DI_TRY(se3di_check_orientation(system, "orientation", full.orientation, data.p));
    se3di_copy(full.position, data.s);
    memcpy(&data.name, &full.name, sizeof data.name); /* copied by the model */
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_marker(&system->model, &data, &handle);
    return se3di_give_created(system, added, "a marker", handle, marker);
}

se3d_status se3d_marker_destroy(se3d_system *system, se3d_marker marker)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_marker(system, "marker", marker, &index));
    se3di_model_remove_marker(&system->model, index);
    return SE3D_OK;
}

static se3d_status find_reader(const se3d_system *system, se3d_marker marker, const void *out,
                               const se3di_marker **data)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, marker), SE3DI_HANDLE(marker), out, &index));
    *data = &system->model.markers[index];
    return SE3D_OK;
}

se3d_status se3d_marker_find(const se3d_system *system, se3d_body body, const char *name,
                             se3d_marker *marker)
{
    uint32_t index;
    if (marker) {
        *marker = (se3d_marker){0, 0};
    }
    if (!name) {
        return SE3D_ERR_NULL;
    }
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, body), SE3DI_HANDLE(body), marker, &index));
    const se3di_slots *slots = &system->model.marker_slots;
    const uint32_t found =
        se3di_slots_find_name(slots, se3di_model_owner(&system->model, index), name);
    return se3di_read_handle(slots, found, marker);
}

se3d_status se3d_marker_get_name(const se3d_system *system, se3d_marker marker, const char **name)
{
    const se3di_marker *data = NULL;
    const se3d_status status = find_reader(system, marker, name, &data);
    return se3di_give_name(status, data ? data->name : NULL, name);
}

se3d_status se3d_marker_get_body(const se3d_system *system, se3d_marker marker, se3d_body *body)
{
    if (body) {
        *body = (se3d_body){0, 0};
    }
    const se3di_marker *data;
    SE3DI_TRY(find_reader(system, marker, body, &data));
    return se3d_system_get_body(system, data->body, body);
}

se3d_status se3d_marker_get_position(const se3d_system *system, se3d_marker marker, double r[3])
{
    const se3di_marker *data;
    SE3DI_TRY(find_reader(system, marker, r, &data));
    const se3di_floats host = se3di_floats_set();
    const se3di_frame *frame = &system->model.frames[data->body];
    se3di_mul(frame->A, data->s, r);
    se3di_add(frame->r, r, r);
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_marker_get_velocity(const se3d_system *system, se3d_marker marker, double v[3])
{
    const se3di_marker *data;
    SE3DI_TRY(find_reader(system, marker, v, &data));
    const se3di_floats host = se3di_floats_set();
    const se3di_frame *frame = &system->model.frames[data->body];
    double local[3];
    se3di_cross(frame->w, data->s, local);
    se3di_mul(frame->A, local, v);
    se3di_add(frame->v, v, v);
    se3di_floats_restore(host);
    return SE3D_OK;
}

/* a + A (wdot x s + w x (w x s)) */
se3d_status se3d_marker_get_acceleration(const se3d_system *system, se3d_marker marker, double a[3])
{
    const se3di_marker *data;
    SE3DI_TRY(find_reader(system, marker, a, &data));
    SE3DI_TRY(se3di_check_solved(system));
    const se3di_floats host = se3di_floats_set();
    const se3di_frame *frame = &system->model.frames[data->body];
    const double *acceleration = system->model.acceleration + 6 * (size_t)data->body;
    double turning[3];
    double local[3];
    double centripetal[3];
    se3di_cross(frame->w, data->s, turning);
    se3di_cross(frame->w, turning, centripetal);
    se3di_cross(acceleration + 3, data->s, local);
    se3di_add(local, centripetal, local);
    se3di_mul(frame->A, local, a);
    se3di_add(acceleration, a, a);
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_marker_get_orientation(const se3d_system *system, se3d_marker marker, double p[4])
{
    const se3di_marker *data;
    SE3DI_TRY(find_reader(system, marker, p, &data));
    const se3di_floats host = se3di_floats_set();
    se3di_quat_mul(system->model.frames[data->body].p, data->p, p);
    se3di_floats_restore(host);
    return SE3D_OK;
}
