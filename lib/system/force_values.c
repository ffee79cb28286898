/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of force elements: checked when they are created, set and read between steps. */
#include "force/force.h"
#include "force/stop.h"
#include "math/vec3.h"
#include "system/force_internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define BIT(type) (1u << (type))
#define SPRINGS   (BIT(SE3DI_FORCE_TSDA) | BIT(SE3DI_FORCE_RSDA))
#define STOP      BIT(SE3DI_FORCE_STOP)
#define FRICTION  BIT(SE3DI_FORCE_FRICTION)
#define TYRE      BIT(SE3DI_FORCE_TYRE)
#define ARMATURE  BIT(SE3DI_FORCE_ARMATURE)

#define PRESLIDING 1e-9 /* [m, rad] if none is given */

/* By se3d_force_parameter: its name, the types of elements that have it, and where. */
typedef struct parameter {
    const char *name;
    uint32_t types;
    uint32_t reserved;
    size_t offset;
} parameter;

static const parameter parameters[] = {
    [SE3D_FORCE_PARAMETER_K] = {"k", SPRINGS | STOP | TYRE, 0, offsetof(se3di_force, k)},
    [SE3D_FORCE_PARAMETER_C] = {"c", SPRINGS | TYRE, 0, offsetof(se3di_force, c)},
    [SE3D_FORCE_PARAMETER_REST] = {"rest", SPRINGS, 0, offsetof(se3di_force, rest)},
    [SE3D_FORCE_PARAMETER_PRELOAD] = {"preload", SPRINGS, 0, offsetof(se3di_force, preload)},
    [SE3D_FORCE_PARAMETER_LOWER] = {"lower", STOP, 0, offsetof(se3di_force, low)},
    [SE3D_FORCE_PARAMETER_UPPER] = {"upper", STOP, 0, offsetof(se3di_force, high)},
    [SE3D_FORCE_PARAMETER_RESTITUTION] = {"restitution", STOP, 0,
                                          offsetof(se3di_force, restitution)},
    [SE3D_FORCE_PARAMETER_MU] = {"mu", FRICTION | TYRE, 0, offsetof(se3di_force, mu)},
    [SE3D_FORCE_PARAMETER_MU_STATIC] = {"mu_static", FRICTION, 0, offsetof(se3di_force, mu_static)},
    [SE3D_FORCE_PARAMETER_RADIUS] = {"radius", FRICTION, 0, offsetof(se3di_force, radius)},
    [SE3D_FORCE_PARAMETER_LIMIT] = {"limit", FRICTION, 0, offsetof(se3di_force, limit)},
    [SE3D_FORCE_PARAMETER_VISCOUS] = {"viscous", FRICTION, 0, offsetof(se3di_force, viscous)},
    [SE3D_FORCE_PARAMETER_PRESLIDING] = {"presliding", FRICTION, 0,
                                         offsetof(se3di_force, presliding)},
    [SE3D_FORCE_PARAMETER_INERTIA] = {"inertia", ARMATURE, 0, offsetof(se3di_force, value)},
    [SE3D_FORCE_PARAMETER_IMPACT] = {"impact", STOP, 0, offsetof(se3di_force, state)},
    [SE3D_FORCE_PARAMETER_LENGTH] = {"length", FRICTION, 0, offsetof(se3di_force, length)},
    [SE3D_FORCE_PARAMETER_WIDTH] = {"width", FRICTION, 0, offsetof(se3di_force, width)},
    [SE3D_FORCE_PARAMETER_THRUST_RADIUS] = {"thrust_radius", FRICTION, 0,
                                            offsetof(se3di_force, thrust_radius)},
};

#define PARAMETERS ((int32_t)(sizeof parameters / sizeof parameters[0]))

static se3d_status check_not_negative(se3d_system *system, const char *what, double value)
{
    if (!(isfinite(value) && value >= 0.0)) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be finite and >= 0", value);
    }
    return SE3D_OK;
}

static se3d_status check_spring(se3d_system *system, const se3di_force *data)
{
    const int is_length = data->type == SE3DI_FORCE_TSDA;
    SE3DI_TRY(se3di_check_finite(system, "k", data->k));
    SE3DI_TRY(se3di_check_finite(system, "c", data->c));
    SE3DI_TRY(se3di_check_finite(system, is_length ? "l0" : "theta0", data->rest));
    SE3DI_TRY(se3di_check_finite(system, "preload", data->preload));
    if (is_length && data->rest < 0.0) {
        return SE3DI_FAIL_OF(system, "l0", SE3D_ERR_INVALID_ARGUMENT, " = %g m, must be >= 0",
                             data->rest);
    }
    return SE3D_OK;
}

static se3d_status check_friction(se3d_system *system, se3di_force *data)
{
    SE3DI_TRY(check_not_negative(system, "mu", data->mu));
    SE3DI_TRY(check_not_negative(system, "mu_static", data->mu_static));
    SE3DI_TRY(check_not_negative(system, "radius", data->radius));
    SE3DI_TRY(check_not_negative(system, "limit", data->limit));
    SE3DI_TRY(check_not_negative(system, "viscous", data->viscous));
    SE3DI_TRY(check_not_negative(system, "presliding", data->presliding));
    SE3DI_TRY(check_not_negative(system, "length", data->length));
    SE3DI_TRY(check_not_negative(system, "width", data->width));
    SE3DI_TRY(check_not_negative(system, "thrust_radius", data->thrust_radius));
    if (data->mu_static > 0.0 && data->mu_static < data->mu) {
        return SE3DI_FAIL_OF(system, "mu_static", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be at least mu = %g (0: the same)", data->mu_static,
                             data->mu);
    }
    data->mu_static = fmax(data->mu, data->mu_static);
    data->presliding = data->presliding > 0.0 ? data->presliding : PRESLIDING;
    return SE3D_OK;
}

static se3d_status check_stop(se3d_system *system, se3di_force *data)
{
    if (!(data->low < data->high)) {
        return SE3DI_FAIL_OF(system, "lower", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g and upper = %g, lower must be below upper", data->low,
                             data->high);
    }
    if (!(isfinite(data->k) && data->k > 0.0)) {
        return SE3DI_FAIL_OF(system, "k", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be finite and > 0", data->k);
    }
    if (!(data->restitution >= 0.01 && data->restitution <= 1.0)) {
        return SE3DI_FAIL_OF(system, "restitution", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be from 0.01 to 1", data->restitution);
    }
    SE3DI_TRY(check_not_negative(system, "impact", data->state[0]));
    data->c = se3di_stop_damping(data->restitution);
    return SE3D_OK;
}

static se3d_status check_tyre(se3d_system *system, const se3di_force *data)
{
    if (!(isfinite(data->k) && data->k > 0.0)) {
        return SE3DI_FAIL_OF(system, "k", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be finite and > 0", data->k);
    }
    if (!(isfinite(data->mu) && data->mu > 0.0 && data->mu >= data->tyre->mu_min)) {
        return SE3DI_FAIL_OF(system, "mu", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be finite, > 0 and at least mu_min = %g", data->mu,
                             data->tyre->mu_min);
    }
    return check_not_negative(system, "c", data->c);
}

se3d_status se3di_force_check_values(se3d_system *system, se3di_force *data)
{
    if (data->type == SE3DI_FORCE_STOP) {
        return check_stop(system, data);
    }
    if (data->type == SE3DI_FORCE_TYRE) {
        return check_tyre(system, data);
    }
    if (data->type == SE3DI_FORCE_ARMATURE) {
        return check_not_negative(system, "inertia", data->value[0]);
    }
    return data->type == SE3DI_FORCE_FRICTION ? check_friction(system, data)
                                              : check_spring(system, data);
}

/* Symmetric, or the energy of the bushing has no meaning. */
static se3d_status check_symmetric(se3d_system *system, const double K[36])
{
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < r; ++c) {
            double gap = fabs(K[6 * r + c] - K[6 * c + r]);
            if (gap > 1e-9 * (fabs(K[6 * r + c]) + fabs(K[6 * c + r]))) {
                return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                                  "K[%d][%d] = %g and K[%d][%d] = %g, K must be symmetric", r, c,
                                  K[6 * r + c], c, r, K[6 * c + r]);
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_force_take_bushing(se3d_system *system, const double K[36], const double C[36],
                                     se3di_force *data)
{
    SE3DI_TRY(se3di_check_finites(system, "K", K, 36));
    SE3DI_TRY(se3di_check_finites(system, "C", C, 36));
    SE3DI_TRY(check_symmetric(system, K));
    memcpy(data->K, K, sizeof data->K);
    memcpy(data->C, C, sizeof data->C);
    return SE3D_OK;
}

/* The element `changed` for the one at `index`, of which it is a copy. */
static void replace(se3di_model *model, uint32_t index, const se3di_force *changed)
{
    se3di_force *force = &model->forces[index];
    if (force->type == SE3DI_FORCE_ARMATURE) {
        const double energy = se3di_audit_forces(model);
        *force = *changed;
        se3di_audit_change(model, energy);
        ++model->masses_version;
    } else {
        const double before = se3di_audit_force(model, force);
        *force = *changed;
        se3di_audit_force_change(model, force, before);
    }
    se3di_model_touch_inputs(model);
}

/* An element to change: a copy of it. */
static se3d_status find_writer(se3d_system *system, se3d_force handle, uint32_t *index,
                               se3di_force *data)
{
    SE3DI_TRY(se3di_find_force(system, "force", handle, index));
    *data = system->model.forces[*index];
    return SE3D_OK;
}

static se3d_status fail_type(se3d_system *system, const se3di_force *data, const char *what)
{
    return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "a %s element has no %s",
                      se3di_force_class_of(data)->name, what);
}

static int is_load(const se3di_force *data)
{
    return data->type == SE3DI_FORCE_LOAD || data->type == SE3DI_FORCE_TORQUE;
}

se3d_status se3d_force_set_value(se3d_system *system, se3d_force force, const double value[3])
{
    SE3DI_SET(system);
    uint32_t index;
    se3di_force data;
    SE3DI_TRY(find_writer(system, force, &index, &data));
    SE3DI_TRY(se3di_check_pointer(system, "value", value));
    if (!is_load(&data)) {
        return fail_type(system, &data, "value");
    }
    SE3DI_TRY(se3di_check_finites(system, "value", value, 3));
    if (memcmp(data.value, value, sizeof data.value) != 0) {
        se3di_copy(value, system->model.forces[index].value);
        se3di_model_touch_inputs(&system->model);
    }
    return SE3D_OK;
}

se3d_status se3d_force_set_parameter(se3d_system *system, se3d_force force, int32_t which,
                                     double value)
{
    SE3DI_SET(system);
    uint32_t index;
    se3di_force data;
    SE3DI_TRY(find_writer(system, force, &index, &data));
    if (which < 0 || which >= PARAMETERS) {
        return SE3DI_FAIL_OF(system, "parameter", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be one of se3d_force_parameter", (int)which);
    }
    const parameter *p = &parameters[which];
    if (!(p->types & BIT(data.type))) {
        return fail_type(system, &data, p->name);
    }
    const int follows = which == SE3D_FORCE_PARAMETER_MU && data.type == SE3DI_FORCE_FRICTION &&
                        !(data.mu_static > data.mu);
    double *at = (double *)(void *)((char *)&data + p->offset);
    if (memcmp(at, &value, sizeof value) == 0) {
        return SE3D_OK;
    }
    *at = value;
    data.mu_static = follows ? value : data.mu_static;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    replace(&system->model, index, &data);
    if (which == SE3D_FORCE_PARAMETER_IMPACT) {
        system->model.remembers = 1;
    }
    return SE3D_OK;
}

se3d_status se3d_force_set_bushing(se3d_system *system, se3d_force force, const double K[36],
                                   const double C[36])
{
    SE3DI_SET(system);
    uint32_t index;
    se3di_force data;
    SE3DI_TRY(find_writer(system, force, &index, &data));
    SE3DI_TRY(se3di_check_pointer(system, "K", K));
    SE3DI_TRY(se3di_check_pointer(system, "C", C));
    if (data.type != SE3DI_FORCE_BUSHING) {
        return fail_type(system, &data, "K and C");
    }
    SE3DI_TRY(se3di_force_take_bushing(system, K, C, &data));
    replace(&system->model, index, &data);
    return SE3D_OK;
}

se3d_status se3d_force_get_value(const se3d_system *system, se3d_force force, double value[3])
{
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, value, &data));
    if (!is_load(data)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_copy(data->value, value);
    return SE3D_OK;
}

se3d_status se3d_force_get_parameter(const se3d_system *system, se3d_force force, int32_t which,
                                     double *value)
{
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, value, &data));
    if (which < 0 || which >= PARAMETERS || !(parameters[which].types & BIT(data->type))) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memcpy(value, (const char *)data + parameters[which].offset, sizeof *value);
    return SE3D_OK;
}

static se3d_status find_effort(se3d_system *system, se3d_force force, uint32_t *index)
{
    SE3DI_TRY(se3di_find_force(system, "force", force, index));
    const se3di_force *data = &system->model.forces[*index];
    return data->type == SE3DI_FORCE_EFFORT ? SE3D_OK : fail_type(system, data, "effort");
}

/* @return whether it is another one */
static int take_effort(se3di_model *model, uint32_t index, double value)
{
    double *at = &model->forces[index].value[0];
    if (memcmp(at, &value, sizeof value) == 0) {
        return 0;
    }
    *at = value;
    return 1;
}

se3d_status se3d_effort_set(se3d_system *system, se3d_force force, double value)
{
    SE3DI_TRY(se3di_enter_past(system, SE3DI_BUSY_EVENT, __func__));
    uint32_t index;
    SE3DI_TRY(find_effort(system, force, &index));
    SE3DI_TRY(se3di_check_finite(system, "value", value));
    if (take_effort(&system->model, index, value)) {
        se3di_model_touch_inputs(&system->model);
    }
    return SE3D_OK;
}

se3d_status se3d_effort_get(const se3d_system *system, se3d_force force, double *value)
{
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, value, &data));
    if (data->type != SE3DI_FORCE_EFFORT) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *value = data->value[0];
    return SE3D_OK;
}

static size_t count_efforts(const se3di_model *model)
{
    size_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += model->forces[k].type == SE3DI_FORCE_EFFORT;
    }
    return count;
}

se3d_status se3d_effort_count(const se3d_system *system, size_t *count)
{
    if (count) {
        *count = 0;
    }
    if (!system || !count) {
        return SE3D_ERR_NULL;
    }
    *count = count_efforts(&system->model);
    return SE3D_OK;
}

se3d_status se3d_effort_set_all(se3d_system *system, size_t count, const double *values)
{
    SE3DI_TRY(se3di_enter_past(system, SE3DI_BUSY_EVENT, __func__));
    se3di_model *model = &system->model;
    const size_t efforts = count_efforts(model);
    if (count != efforts) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be %zu, one for each effort", count, efforts);
    }
    if (count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_pointer(system, "values", values));
    SE3DI_TRY(se3di_check_finites(system, "values", values, (int)count));
    int changes = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_EFFORT) {
            changes |= take_effort(model, k, *values++);
        }
    }
    if (changes) {
        se3di_model_touch_inputs(model);
    }
    return SE3D_OK;
}

se3d_status se3d_force_get_bushing(const se3d_system *system, se3d_force force, double K[36],
                                   double C[36])
{
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, K && C ? K : NULL, &data));
    if (data->type != SE3DI_FORCE_BUSHING) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memcpy(K, data->K, sizeof data->K);
    memcpy(C, data->C, sizeof data->C);
    return SE3D_OK;
}

se3d_status se3di_force_check_pair(se3d_system *system, const se3di_force *data)
{
    if (data->body_i == data->body_j) {
        return SE3DI_FAIL_OF(system, "body_i", SE3D_ERR_INVALID_ARGUMENT,
                             " and body_j are the same body, must differ");
    }
    return SE3D_OK;
}

se3d_status se3di_force_find_reader(const se3d_system *system, se3d_force force, const void *out,
                                    const se3di_force **data)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, force), SE3DI_HANDLE(force), out, &index));
    *data = &system->model.forces[index];
    return (*data)->type == SE3DI_FORCE_STATE ? SE3D_ERR_STALE_HANDLE : SE3D_OK;
}
