/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies: creation, mass, state. */
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

void se3d_body_def_init(se3d_body_def *def, size_t size)
{
    se3d_body_def defaults = {.struct_size = size, .orientation = {1.0, 0.0, 0.0, 0.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

se3d_status se3di_check_mass(se3d_system *system, double mass, const double inertia[6])
{
    if (!(isfinite(mass) && mass > 0.0)) {
        return SE3DI_FAIL_OF(system, "mass", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g kg, must be finite and > 0", mass);
    }
    SE3DI_TRY(se3di_check_finites(system, "inertia", inertia, 6));
    double moments[3];
    se3di_inertia_principal(inertia, moments);
    int verdict = se3di_inertia_is_physical(inertia);
    if (verdict == SE3DI_INERTIA_NOT_TRIANGLE) {
        return SE3DI_FAIL_OF(system, "inertia", SE3D_ERR_INVALID_ARGUMENT,
                             " has principal moments %g, %g, %g kg m^2, the largest must not "
                             "exceed the sum of the others",
                             moments[0], moments[1], moments[2]);
    }
    if (verdict != SE3DI_INERTIA_PHYSICAL || !(moments[0] > 1e-14 * moments[2])) {
        return SE3DI_FAIL_OF(system, "inertia", SE3D_ERR_INVALID_ARGUMENT,
                             " has principal moments %g, %g, %g kg m^2, must be > 0", moments[0],
                             moments[1], moments[2]);
    }
    return SE3D_OK;
}

se3d_status se3d_body_create(se3d_system *system, const se3d_body_def *def, se3d_body *body)
{
    SE3DI_CREATE(system, body);
    se3d_body_def full = se3d_body_def_default();
    SE3DI_TRY(se3di_check_def(system, "body def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.body_slots, 0, "body", full.name));
    se3di_frame frame = {0};
    if (!full.fixed) {
        SE3DI_TRY(se3di_check_mass(system, full.mass, full.inertia));
    }
    SE3DI_TRY(se3di_check_finites(system, "position", full.position, 3));
    SE3DI_TRY(se3di_check_orientation(system, "orientation", full.orientation, frame.p));
    SE3DI_TRY(se3di_check_finites(system, "velocity", full.velocity, 3));
    SE3DI_TRY(se3di_check_finites(system, "angular_velocity", full.angular_velocity, 3));
    static const double none[3] = {0.0, 0.0, 0.0};
    if (full.fixed && (memcmp(full.velocity, none, sizeof none) != 0 ||
                       memcmp(full.angular_velocity, none, sizeof none) != 0)) {
        return SE3DI_FAIL_OF(system, "velocity", SE3D_ERR_INVALID_ARGUMENT,
                             " and angular_velocity of a fixed body must be zero");
    }
    se3di_copy(full.position, frame.r);
    se3di_copy(full.velocity, frame.v);
    se3di_copy(full.angular_velocity, frame.w);
    se3di_frame_update(&frame);
    char *name = NULL;
    memcpy(&name, &full.name, sizeof name); /* copied by the model, never written through */
    se3di_body data = {.name = name, .fixed = full.fixed != 0};
    if (!data.fixed) {
        data.mass = full.mass;
        memcpy(data.J, full.inertia, sizeof data.J);
    }
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_body(&system->model, &data, &frame, &handle);
    return se3di_give_created(system, added, "a body", handle, body);
}

se3d_status se3d_body_destroy(se3d_system *system, se3d_body body)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_body(system, "body", body, &index));
    if (index == 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "the ground cannot be destroyed");
    }
    const se3di_body *data = &system->model.bodies[index];
    if (data->users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                          "body %s is used by %u markers, constraints, forces, shapes, wheels or "
                          "roads; "
                          "destroy them first",
                          data->name ? data->name : "without a name", data->users);
    }
    se3di_model_remove_body(&system->model, index);
    return SE3D_OK;
}

/* Index for a reader, which records no message. */
static se3d_status find_reader(const se3d_system *system, se3d_body body, const void *out,
                               uint32_t *index)
{
    return se3di_read_index(SE3DI_SLOTS(system, body), SE3DI_HANDLE(body), out, index);
}

se3d_status se3d_body_find(const se3d_system *system, const char *name, se3d_body *body)
{
    return se3di_read_named(SE3DI_SLOTS(system, body), name, body);
}

se3d_status se3d_body_get_name(const se3d_system *system, se3d_body body, const char **name)
{
    uint32_t index;
    const se3d_status status = find_reader(system, body, name, &index);
    return se3di_give_name(status, status < 0 ? NULL : system->model.bodies[index].name, name);
}

se3d_status se3d_body_get_fixed(const se3d_system *system, se3d_body body, int32_t *fixed)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, fixed, &index));
    *fixed = system->model.bodies[index].fixed;
    return SE3D_OK;
}

se3d_status se3d_body_set_held(se3d_system *system, se3d_body body, int32_t held)
{
    uint32_t index;
    SE3DI_SET(system);
    SE3DI_TRY(se3di_find_body(system, "body", body, &index));
    system->model.bodies[index].held = held != 0;
    return SE3D_OK;
}

se3d_status se3d_body_get_held(const se3d_system *system, se3d_body body, int32_t *held)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, held, &index));
    *held = system->model.bodies[index].held;
    return SE3D_OK;
}

se3d_status se3d_body_get_mass(const se3d_system *system, se3d_body body, double *mass,
                               double inertia[6])
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, mass ? (const void *)mass : inertia, &index));
    if (mass) {
        *mass = system->model.bodies[index].mass;
    }
    if (inertia) {
        memcpy(inertia, system->model.bodies[index].J, 6 * sizeof *inertia);
    }
    return SE3D_OK;
}

se3d_status se3d_body_set_mass(se3d_system *system, se3d_body body, double mass,
                               const double inertia[6])
{
    SE3DI_SET(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_body(system, "body", body, &index));
    SE3DI_TRY(se3di_check_pointer(system, "inertia", inertia));
    if (system->model.bodies[index].fixed) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "a fixed body has no mass to set");
    }
    SE3DI_TRY(se3di_check_mass(system, mass, inertia));
    se3di_model *model = &system->model;
    const double before = se3di_audit_forces(model);
    model->bodies[index].mass = mass;
    memcpy(model->bodies[index].J, inertia, 6 * sizeof *inertia);
    se3di_audit_change(model, before);
    ++model->masses_version;
    se3di_model_touch_contact(model); /* its damping goes by the mass */
    return SE3D_OK;
}

/* `count` numbers at `offset` in the frame of a body. */
static inline se3d_status give_of_frame(const se3d_system *system, se3d_body body, size_t offset,
                                        size_t count, double *out)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, out, &index));
    memcpy(out, (const char *)&system->model.frames[index] + offset, count * sizeof *out);
    return SE3D_OK;
}

/* Three of the six accelerations of a body, from `first` on. */
static inline se3d_status give_acceleration(const se3d_system *system, se3d_body body, size_t first,
                                            double *out)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, out, &index));
    SE3DI_TRY(se3di_check_solved(system));
    se3di_copy(system->model.acceleration + 6 * (size_t)index + first, out);
    return SE3D_OK;
}

se3d_status se3d_body_get_position(const se3d_system *system, se3d_body body, double r[3])
{
    return give_of_frame(system, body, offsetof(se3di_frame, r), 3, r);
}

se3d_status se3d_body_get_orientation(const se3d_system *system, se3d_body body, double p[4])
{
    return give_of_frame(system, body, offsetof(se3di_frame, p), 4, p);
}

se3d_status se3d_body_get_velocity(const se3d_system *system, se3d_body body, double v[3])
{
    return give_of_frame(system, body, offsetof(se3di_frame, v), 3, v);
}

se3d_status se3d_body_get_angular_velocity(const se3d_system *system, se3d_body body, double w[3])
{
    return give_of_frame(system, body, offsetof(se3di_frame, w), 3, w);
}

se3d_status se3d_body_get_acceleration(const se3d_system *system, se3d_body body, double a[3])
{
    return give_acceleration(system, body, 0, a);
}

se3d_status se3d_body_get_angular_acceleration(const se3d_system *system, se3d_body body,
                                               double alpha[3])
{
    return give_acceleration(system, body, 3, alpha);
}

se3d_status se3d_body_get_point(const se3d_system *system, se3d_body body, const double local[3],
                                double ground[3])
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, body, local ? (const void *)ground : NULL, &index));
    const se3di_floats host = se3di_floats_set();
    double turned[3];
    se3di_mul(system->model.frames[index].A, local, turned);
    se3di_add(system->model.frames[index].r, turned, ground);
    se3di_floats_restore(host);
    return SE3D_OK;
}

/* A vector to set on a movable body: everything checked. */
static se3d_status find_writer(se3d_system *system, se3d_body body, const char *what,
                               const double *values, uint32_t *index)
{
    SE3DI_TRY(se3di_find_body(system, "body", body, index));
    return se3di_check_pointer(system, what, values);
}

static se3d_status check_movable(se3d_system *system, uint32_t index, const char *what)
{
    if (index == 0) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " of the ground cannot be set");
    }
    return SE3D_OK;
}

/* The same of a velocity. */
static se3d_status find_moving(se3d_system *system, se3d_body body, const char *what,
                               const double *values, uint32_t *index)
{
    SE3DI_TRY(find_writer(system, body, what, values, index));
    if (system->model.bodies[*index].fixed) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " of a fixed body cannot be set");
    }
    return se3di_check_finites(system, what, values, 3);
}

se3d_status se3d_body_set_position(se3d_system *system, se3d_body body, const double r[3])
{
    uint32_t index;
    SE3DI_SET(system);
    SE3DI_TRY(find_writer(system, body, "position", r, &index));
    SE3DI_TRY(check_movable(system, index, "position"));
    SE3DI_TRY(se3di_check_finites(system, "position", r, 3));
    se3di_copy(r, system->model.frames[index].r);
    se3di_model_touch_poses(&system->model);
    return SE3D_OK;
}

se3d_status se3d_body_set_orientation(se3d_system *system, se3d_body body, const double p[4])
{
    uint32_t index;
    double unit[4];
    SE3DI_SET(system);
    SE3DI_TRY(find_writer(system, body, "orientation", p, &index));
    SE3DI_TRY(check_movable(system, index, "orientation"));
    SE3DI_TRY(se3di_check_orientation(system, "orientation", p, unit));
    memcpy(system->model.frames[index].p, unit, sizeof unit);
    se3di_frame_update(&system->model.frames[index]);
    se3di_model_touch_poses(&system->model);
    return SE3D_OK;
}

se3d_status se3d_body_set_velocity(se3d_system *system, se3d_body body, const double v[3])
{
    uint32_t index;
    SE3DI_SET(system);
    SE3DI_TRY(find_moving(system, body, "velocity", v, &index));
    se3di_copy(v, system->model.frames[index].v);
    se3di_model_touch_state(&system->model);
    return SE3D_OK;
}

se3d_status se3d_body_set_angular_velocity(se3d_system *system, se3d_body body, const double w[3])
{
    uint32_t index;
    SE3DI_SET(system);
    SE3DI_TRY(find_moving(system, body, "angular_velocity", w, &index));
    se3di_copy(w, system->model.frames[index].w);
    se3di_frame_update(&system->model.frames[index]);
    se3di_model_touch_state(&system->model);
    return SE3D_OK;
}

/* The next body from `dense` on that is not a state's. */
static size_t skip_carriers(const se3di_model *model, size_t dense)
{
    while (model->bodies[dense].state != 0) {
        ++dense;
    }
    return dense;
}

se3d_status se3d_body_get_all(const se3d_system *system, size_t count, double *r, double *p,
                              double *v, double *w)
{
    if (!system) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    if (count != model->body_slots.count - model->state_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    for (size_t k = 0, dense = 0; k < count; ++k, ++dense) {
        dense = skip_carriers(model, dense);
        const se3di_frame *frame = &model->frames[dense];
        if (r) {
            se3di_copy(frame->r, r + 3 * k);
        }
        if (p) {
            memcpy(p + 4 * k, frame->p, sizeof frame->p);
        }
        if (v) {
            se3di_copy(frame->v, v + 3 * k);
        }
        if (w) {
            se3di_copy(frame->w, w + 3 * k);
        }
    }
    return SE3D_OK;
}

/* The three numbers of body k in an array over all bodies, or NULL. */
static se3d_status check_of_body(se3d_system *system, size_t k, const char *what,
                                 const double *values)
{
    for (size_t c = 3 * k; values && c < 3 * k + 3; ++c) {
        if (!isfinite(values[c])) {
            return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g (body %zu), must be finite", c, values[c], k);
        }
    }
    return SE3D_OK;
}

/* Everything is checked before anything is written. */
static se3d_status check_all(se3d_system *system, const double *r, const double *p, const double *v,
                             const double *w)
{
    const se3di_model *model = &system->model;
    const size_t count = model->body_slots.count - model->state_count;
    for (size_t k = 0, dense = 0; k < count; ++k, ++dense) {
        double unit[4];
        dense = skip_carriers(model, dense);
        if (model->bodies[dense].fixed) {
            continue;
        }
        SE3DI_TRY(check_of_body(system, k, "position", r));
        SE3DI_TRY(check_of_body(system, k, "velocity", v));
        SE3DI_TRY(check_of_body(system, k, "angular_velocity", w));
        if (p) {
            SE3DI_TRY(se3di_check_orientation(system, "orientation", p + 4 * k, unit));
        }
    }
    return SE3D_OK;
}

se3d_status se3d_body_set_all(se3d_system *system, size_t count, const double *r, const double *p,
                              const double *v, const double *w)
{
    SE3DI_SET(system);
    const se3di_model *model = &system->model;
    if (count != model->body_slots.count - model->state_count) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be the number of bodies, %zu", count,
                             model->body_slots.count - model->state_count);
    }
    SE3DI_TRY(check_all(system, r, p, v, w));
    for (size_t k = 0, dense = 0; k < count; ++k, ++dense) {
        dense = skip_carriers(model, dense);
        se3di_frame *frame = &model->frames[dense];
        if (model->bodies[dense].fixed) {
            continue;
        }
        if (r) {
            se3di_copy(r + 3 * k, frame->r);
        }
        if (p) {
            se3di_quat_normalize(p + 4 * k, frame->p);
        }
        if (v) {
            se3di_copy(v + 3 * k, frame->v);
        }
        if (w) {
            se3di_copy(w + 3 * k, frame->w);
        }
        se3di_frame_update(frame);
    }
    if (r || p) {
        se3di_model_touch_poses(&system->model);
    }
    se3di_model_touch_state(&system->model);
    return SE3D_OK;
}
