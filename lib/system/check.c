/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of arguments at the public boundary. */
#include "base/text.h"
#include "joint/joint.h"
#include "math/direction.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

void se3di_def_init(void *def, size_t size, const void *defaults, size_t full)
{
    if (def && size >= sizeof size) {
        memset(def, 0, size);
        memcpy(def, defaults, size < full ? size : full);
    }
}

se3d_status se3di_check_range(se3d_system *system, const char *what, double value, double low,
                              double high)
{
    if (isfinite(value) && value >= low && value <= high) {
        return SE3D_OK;
    }
    return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                         " = %g, must be finite, >= %g and <= %g", value, low, high);
}

se3d_status se3di_check_finite(se3d_system *system, const char *what, double value)
{
    if (isfinite(value)) {
        return SE3D_OK;
    }
    return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = %g, must be finite", value);
}

se3d_status se3di_check_finites(se3d_system *system, const char *what, const double *values,
                                int count)
{
    const se3d_status status = se3di_finites_check(what, values, count, &system->error);
    return status < 0 ? se3di_log_error(&system->error, status) : SE3D_OK;
}

se3d_status se3di_check_direction(se3d_system *system, const char *what, const double values[3],
                                  double unit[3])
{
    const se3d_status status = se3di_direction_read(what, values, unit, &system->error);
    return status < 0 ? se3di_log_error(&system->error, status) : SE3D_OK;
}

se3d_status se3di_check_axes(se3d_system *system, const double forward[3], const char *what,
                             const double up[3], double axes[9])
{
    double x[3];
    SE3DI_TRY(se3di_check_direction(system, "forward", forward, x));
    SE3DI_TRY(se3di_check_direction(system, what, up, axes + 6));
    if (!se3di_joint_triad_take(axes + 6, x, axes, axes + 3)) {
        return SE3DI_FAIL_OF(system, "forward", SE3D_ERR_INVALID_ARGUMENT,
                             " = (%g, %g, %g) and %s = (%g, %g, %g) are parallel, must be two "
                             "directions",
                             forward[0], forward[1], forward[2], what, up[0], up[1], up[2]);
    }
    return SE3D_OK;
}

se3d_status se3di_check_orientation(se3d_system *system, const char *what, const double p[4],
                                    double unit[4])
{
    SE3DI_TRY(se3di_check_finites(system, what, p, 4));
    double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    if (!(fabs(norm - 1.0) <= 1e-6)) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = [%g, %g, %g, %g] has length %.9g, must be unit Euler parameters "
                             "(length 1 within 1e-6)",
                             p[0], p[1], p[2], p[3], norm);
    }
    const int is_unit = se3di_is_unit(p, 4);
    for (int k = 0; k < 4; ++k) {
        unit[k] = is_unit ? p[k] : p[k] / norm;
    }
    return SE3D_OK;
}

se3d_status se3di_check_pointer(se3d_system *system, const char *what, const void *pointer)
{
    return pointer ? SE3D_OK : SE3DI_FAIL_OF(system, what, SE3D_ERR_NULL, " is NULL");
}

se3d_status se3di_check_def(se3d_system *system, const char *what, const void *def, void *copy,
                            size_t full_size)
{
    SE3DI_TRY(se3di_check_pointer(system, what, def));
    size_t size;
    memcpy(&size, def, sizeof size);
    const se3di_sized_verdict verdict = se3di_sized_take(def, copy, full_size);
    if (verdict == SE3DI_SIZED_UNKNOWN) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " has %zu bytes, of which this library (%s) knows %zu: what a newer "
                             "header adds must be zero",
                             size, se3d_version_get_text(), full_size);
    }
    if (verdict != SE3DI_SIZED_FITS) {
        return SE3DI_FAIL_OF(
            system, what, SE3D_ERR_INVALID_ARGUMENT,
            ".struct_size = %zu, must be set by its _default function (%zu in this "
            "version)",
            size, full_size);
    }
    return SE3D_OK;
}

static se3d_status find(se3d_system *system, const se3di_slots *slots, const char *what,
                        se3di_handle handle, uint32_t *index)
{
    *index = se3di_slots_find(slots, handle.index1, handle.generation);
    if (*index != SE3DI_NO_INDEX) {
        return SE3D_OK;
    }
    const char *reason =
        handle.index1 == 0 ? "is the null handle" : "was destroyed or belongs to another system";
    return SE3DI_FAIL_OF(system, what, SE3D_ERR_STALE_HANDLE, " %s", reason);
}

#define FIND_PLAIN(kind)                                                                           \
    se3d_status se3di_find_##kind(se3d_system *system, const char *what, se3d_##kind handle,       \
                                  uint32_t *index)                                                 \
    {                                                                                              \
        return find(system, &system->model.kind##_slots, what, SE3DI_HANDLE(handle), index);       \
    }
SE3DI_PLAIN_LIST(FIND_PLAIN)

se3d_status se3di_find_force(se3d_system *system, const char *what, se3d_force handle,
                             uint32_t *index)
{
    SE3DI_TRY(find(system, &system->model.force_slots, what, SE3DI_HANDLE(handle), index));
    return system->model.forces[*index].type == SE3DI_FORCE_STATE
               ? SE3DI_FAIL_OF(system, what, SE3D_ERR_STALE_HANDLE,
                               " is a state, must be a force element")
               : SE3D_OK;
}

static se3d_status find_function(se3d_system *system, const char *what, se3d_function function,
                                 uint32_t variables, int takes_signals, int32_t *index)
{
    *index = -1;
    if (function.index1 == 0 && function.generation == 0) {
        return SE3D_OK;
    }
    uint32_t dense;
    SE3DI_TRY(find(system, &system->model.function_slots, what, SE3DI_HANDLE(function), &dense));
    const se3di_function *found = &system->model.functions[dense];
    const uint32_t count = found->variable_count - found->signal_count;
    if (found->signal_count > 0 && !takes_signals) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " is a function of %u signals, which only the law of a force element "
                             "(h, function) and the value of a driver may be",
                             found->signal_count);
    }
    if (count > variables) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " is a function of %u variables, at most %u are allowed here", count,
                             variables);
    }
    *index = (int32_t)dense;
    return SE3D_OK;
}

se3d_status se3di_find_function(se3d_system *system, const char *what, se3d_function function,
                                uint32_t variables, int32_t *index)
{
    return find_function(system, what, function, variables, 0, index);
}

se3d_status se3di_find_law(se3d_system *system, const char *what, se3d_function function,
                           uint32_t variables, int32_t *index)
{
    return find_function(system, what, function, variables, 1, index);
}

se3d_status se3di_check_name(se3d_system *system, const char *name)
{
    if (name[0] == '\0' || strchr(name, '.') || !se3di_text_is_plain(name)) {
        return SE3DI_FAIL_OF(system, "name", SE3D_ERR_INVALID_ARGUMENT,
                             " = \"%.64s\", must be UTF-8, not empty, and have no '.' or control "
                             "characters",
                             name);
    }
    return SE3D_OK;
}

/* Whether a name of these may be given again. */
static int may_be_replaced(const se3di_model *model, const se3di_slots *slots)
{
    return model->replaces && (slots == &model->body_slots || slots == &model->marker_slots ||
                               slots == &model->constraint_slots || slots == &model->force_slots ||
                               slots == &model->wheel_slots || slots == &model->road_slots);
}

se3d_status se3di_fail_added(se3d_system *system, se3d_status added, const char *what)
{
    if (added == SE3D_ERR_IN_USE) {
        return SE3DI_FAIL(system, added,
                          "%s on other bodies cannot take the place of this one, as drivers, "
                          "couplers or force elements on it or signals of functions are made of "
                          "the bodies that it has now; destroy them first",
                          what);
    }
    if (added == SE3D_ERR_INVALID_ARGUMENT && system->model.target > 0) {
        return SE3DI_FAIL(
            system, added,
            "%s of another kind, body or structure cannot take the place of this one; "
            "destroy it and create another one",
            what);
    }
    return added == SE3D_ERR_INVALID_ARGUMENT
               ? SE3DI_FAIL_OF(system, "name", added,
                               " is taken by another kind of element, which %s cannot replace",
                               what)
               : SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for %s", what);
}

se3d_status se3di_check_new_name(se3d_system *system, const se3di_slots *slots, uint32_t owner,
                                 const char *what, const char *name)
{
    if (!name || system->model.target > 0) { /* what is defined again keeps its name */
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_name(system, name));
    if (!may_be_replaced(&system->model, slots) &&
        se3di_slots_find_name(slots, owner, name) != SE3DI_NO_INDEX) {
        return SE3DI_FAIL_OF(system, "name", SE3D_ERR_INVALID_ARGUMENT,
                             " = \"%.64s\" is taken by another %s, must be unique", name, what);
    }
    return SE3D_OK;
}

_Static_assert(sizeof(se3d_body) == sizeof(se3di_handle) &&
                   offsetof(se3d_body, generation) == offsetof(se3di_handle, generation),
               "public handles are written as internal ones");

static se3d_status give(const se3di_slots *slots, uint32_t index, void *handle)
{
    se3di_handle found = {0, 0};
    if (index != SE3DI_NO_INDEX) {
        found = se3di_slots_handle(slots, index);
    }
    memcpy(handle, &found, sizeof found);
    return index == SE3DI_NO_INDEX ? SE3D_ERR_INVALID_ARGUMENT : SE3D_OK;
}

se3d_status se3di_read_named(const se3di_slots *slots, const char *name, void *handle)
{
    if (handle) {
        (void)give(slots, SE3DI_NO_INDEX, handle);
    }
    return slots && name && handle ? give(slots, se3di_slots_find_name(slots, 0, name), handle)
                                   : SE3D_ERR_NULL;
}

se3d_status se3di_give_created(se3d_system *system, se3d_status added, const char *what,
                               se3di_handle created, void *handle)
{
    if (added < 0) {
        return se3di_fail_added(system, added, what);
    }
    memcpy(handle, &created, sizeof created);
    return SE3D_OK;
}

se3d_status se3di_read_handle(const se3di_slots *slots, size_t index, void *handle)
{
    if (handle) {
        (void)give(slots, SE3DI_NO_INDEX, handle);
    }
    return slots && handle
               ? give(slots, index < slots->count ? (uint32_t)index : SE3DI_NO_INDEX, handle)
               : SE3D_ERR_NULL;
}

se3d_status se3di_read_index(const se3di_slots *slots, se3di_handle handle, const void *out,
                             uint32_t *index)
{
    if (!slots || !out) {
        return SE3D_ERR_NULL;
    }
    *index = se3di_slots_find(slots, handle.index1, handle.generation);
    return *index == SE3DI_NO_INDEX ? SE3D_ERR_STALE_HANDLE : SE3D_OK;
}
