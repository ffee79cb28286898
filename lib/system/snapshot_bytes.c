/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots as bytes: the same on every machine (64-bit words, least byte first), with a mark, a
 * version, the structure of the model that they belong to, and a checksum. Only the format is
 * versioned: what methods keep is read by the version of the library that wrote it. */
#include "system/snapshot.h"

#include "base/coder.h"
#include "base/hash.h"
#include "integrator/integrator.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "particles/bytes.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

#define MASS_MOST 1e100 /* of the two of a contact: the inverse is divided by */
#define MARK      UINT64_C(0x50414E5344334553) /* "SE3DSNAP" */
#define VERSION   UINT64_C(12)
/* Rotation matrices are those of the Euler parameters to this. */
#define SAME_ROTATION 1e-9

static void code_scalars(se3di_coder *c, se3di_saved *s)
{
    uint64_t redundant = (uint64_t)s->history_redundant;
    se3di_code_numbers(c, &s->time, 1);
    se3di_code_numbers(c, &s->time_rest, 1);
    se3di_code_numbers(c, &s->rest_time, 1);
    se3di_code_numbers(c, s->work, 3);
    se3di_code_numbers(c, s->power, 3);
    se3di_code_numbers(c, &s->contact_step, 1);
    se3di_code_numbers(c, &s->contact_time, 1);
    se3di_code_numbers(c, &s->left_out_gap, 1);
    se3di_code_word(c, &s->history_tag);
    se3di_code_word(c, &redundant);
    se3di_code_word(c, &s->history_inputs);
    se3di_code_word(c, &s->history_values);
    se3di_code_int32(c, &s->settled);
    se3di_code_int32(c, &s->work_valid);
    se3di_code_int32(c, &s->ranks_known);
    se3di_code_int32(c, &s->shows_before);
    se3di_code_uint32(c, &s->left_out_count);
    se3di_code_uint32(c, &s->left_out_row);
    s->history_redundant = (int64_t)redundant;
}

/* Every array: where it is, bytes of an element, numbers in it. */
typedef struct saved_array {
    se3di_saved_array *array;
    size_t size;
} saved_array;

#define ARRAYS 12

static void list_arrays(se3d_snapshot *snapshot, saved_array list[ARRAYS])
{
    se3di_saved *s = &snapshot->state;
    se3di_snapshot_near *near = &snapshot->near;
    const saved_array arrays[] = {
        {&s->frames, sizeof(se3di_frame)},
        {&s->acceleration, sizeof(double)},
        {&s->lambda, sizeof(double)},
        {&s->turns, sizeof(double)},
        {&s->memory, sizeof(double)},
        {&s->history, sizeof(double)},
        {&s->wrench, sizeof(double)},
        {&s->left_out, sizeof(uint8_t)},
        {&s->contacts, sizeof(se3di_body_contact)},
        {&near->reference, sizeof(double)},
        {&near->pairs, sizeof(uint32_t)},
        {&near->order, sizeof(uint32_t)},
    };
    _Static_assert(sizeof arrays == ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void code_contact(se3di_coder *c, se3di_body_contact *contact)
{
    se3di_code_uint32(c, &contact->shape_i);
    se3di_code_uint32(c, &contact->shape_j);
    se3di_code_uint32(c, &contact->feature);
    se3di_code_int32(c, &contact->kind);
    se3di_code_numbers(c, contact->anchor_i, 3);
    se3di_code_numbers(c, contact->anchor_j, 3);
    se3di_code_numbers(c, contact->roll, 3);
    se3di_code_numbers(c, &contact->twist, 1);
    se3di_code_numbers(c, contact->turn, 4);
    se3di_code_numbers(c, contact->point, 3);
    se3di_code_numbers(c, contact->normal, 3);
    se3di_code_numbers(c, &contact->overlap, 1);
    se3di_code_numbers(c, &contact->inverse_mass, 1);
    se3di_code_numbers(c, contact->force, 3);
    se3di_code_numbers(c, contact->torque, 3);
    se3di_code_numbers(c, &contact->energy, 1);
    se3di_code_numbers(c, contact->spin, 2);
    se3di_code_numbers(c, contact->wander, 3);
    se3di_code_numbers(c, &contact->moved, 1);
}

/* Only of a joint that is broken the bodies have been apart since. */
static int is_row_flag(uint32_t flag)
{
    return flag <= SE3DI_ROW_BROKEN || flag == SE3DI_ROW_BREAKS;
}

static void code_array(se3di_coder *c, const saved_array *a, size_t numbers)
{
    uint8_t *bytes = a->array->data;
    se3di_body_contact *contacts = a->array->data;
    uint32_t *indices = a->array->data;
    for (size_t k = 0; k < a->array->count; ++k) {
        if (a->size == sizeof *contacts) {
            code_contact(c, contacts + k);
        } else if (a->size == sizeof *indices) {
            se3di_code_uint32(c, indices + k);
        } else if (a->size == sizeof *bytes) {
            uint32_t flag = bytes[k];
            se3di_code_uint32(c, &flag);
            c->failed |= !is_row_flag(flag);
            if (c->in) {
                bytes[k] = (uint8_t)(flag & UINT8_MAX);
            }
        } else {
            se3di_code_numbers(c, (double *)a->array->data + k * numbers, numbers);
        }
    }
}

_Static_assert(sizeof(se3di_frame) == 26 * sizeof(double) &&
                   sizeof(se3di_frame) != sizeof(se3di_body_contact),
               "frames are written as numbers");

/* Give the arrays, which are empty, the lengths that were read. */
static se3d_status make_room(const se3di_coder *c, saved_array arrays[ARRAYS],
                             const uint64_t count[ARRAYS], const se3d_allocator *allocator)
{
    for (int k = 0; k < ARRAYS; ++k) {
        const size_t left = c->at < c->size ? c->size - c->at : 0; /* bytes may have ended */
        if (count[k] > left / SE3DI_CODER_WORD) { /* an element has a word at least */
            return SE3D_ERR_INVALID_ARGUMENT;
        }
        se3di_saved_array *a = arrays[k].array;
        SE3DI_TRY(se3di_array_reserve(allocator, &a->data, &a->capacity, (size_t)count[k],
                                      arrays[k].size));
        a->count = (size_t)count[k];
    }
    return SE3D_OK;
}

static se3d_status code_state(se3di_coder *c, se3d_snapshot *snapshot)
{
    saved_array arrays[ARRAYS];
    uint64_t count[ARRAYS];
    list_arrays(snapshot, arrays);
    se3di_code_word(c, &snapshot->structure);
    code_scalars(c, &snapshot->state);
    se3di_code_numbers(c, &snapshot->near.margin, 1);
    for (int k = 0; k < ARRAYS; ++k) {
        count[k] = arrays[k].array->count;
        se3di_code_word(c, &count[k]);
    }
    SE3DI_TRY(c->in ? make_room(c, arrays, count, &snapshot->allocator) : SE3D_OK);
    for (int k = 0; k < ARRAYS; ++k) {
        code_array(c, &arrays[k], arrays[k].size / sizeof(double));
    }
    return SE3D_OK;
}

se3d_status se3d_snapshot_write(const se3d_snapshot *snapshot, void *bytes, size_t capacity,
                                size_t *size)
{
    if (size) {
        *size = 0;
    }
    if (!snapshot || !size) {
        return SE3D_ERR_NULL;
    }
    se3d_snapshot copy = *snapshot; /* writing changes nothing of what it points to */
    copy.state.history_inputs = snapshot->inputs_version - snapshot->state.history_inputs;
    copy.state.history_values = snapshot->values_version - snapshot->state.history_values;
    se3di_coder measure = {.size = SIZE_MAX};
    uint64_t mark = MARK, version = VERSION, sum = 0;
    (void)code_state(&measure, &copy);
    se3di_sets_write(&measure, snapshot->sets);
    *size = measure.at + 3 * sizeof(uint64_t);
    if (!bytes || capacity < *size) {
        return bytes ? SE3D_ERR_INVALID_ARGUMENT : SE3D_OK;
    }
    se3di_coder c = {.out = bytes, .size = *size};
    se3di_code_word(&c, &mark);
    se3di_code_word(&c, &version);
    (void)code_state(&c, &copy);
    se3di_sets_write(&c, snapshot->sets);
    sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, c.at);
    se3di_code_word(&c, &sum);
    return SE3D_OK;
}

/* ---- reading ---- */

static int are_finite(const se3di_saved_array *array, size_t numbers)
{
    const double *values = array->data;
    for (size_t k = 0; k < array->count * numbers; ++k) {
        if (!isfinite(values[k])) {
            return 0;
        }
    }
    return 1;
}

/* Matrices and rates of the Euler parameters, which are of unit length. */
static int are_poses(const se3di_saved_array *array)
{
    const se3di_frame *frames = array->data;
    for (size_t k = 0; k < array->count; ++k) {
        se3di_frame own = frames[k];
        se3di_frame_update(&own);
        const double size = sqrt(own.p[0] * own.p[0] + own.p[1] * own.p[1] + own.p[2] * own.p[2] +
                                 own.p[3] * own.p[3]);
        const double fast = 1.0 + se3di_norm(own.w);
        int holds = fabs(size - 1.0) <= SAME_ROTATION;
        for (int i = 0; i < 9; ++i) {
            holds &= fabs(own.A[i] - frames[k].A[i]) <= SAME_ROTATION;
        }
        for (int i = 0; i < 4; ++i) {
            holds &= fabs(own.pdot[i] - frames[k].pdot[i]) <= SAME_ROTATION * fast;
        }
        if (!holds) {
            return 0;
        }
    }
    return 1;
}

static double sum_of(const double *x, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; ++k) {
        sum += fabs(x[k]);
    }
    return sum;
}

static int are_contacts(const se3di_saved *state, const se3di_model *model)
{
    const se3di_body_contact *list = state->contacts.data;
    for (size_t k = 0; k < state->contacts.count; ++k) {
        const se3di_body_contact *c = &list[k];
        const double sum = sum_of(c->anchor_i, 3) + sum_of(c->anchor_j, 3) + sum_of(c->roll, 3) +
                           sum_of(c->turn, 4) + sum_of(c->point, 3) + sum_of(c->normal, 3) +
                           sum_of(c->force, 3) + sum_of(c->torque, 3) + sum_of(c->spin, 2) +
                           fabs(c->twist) + fabs(c->overlap) + fabs(c->inverse_mass) +
                           fabs(c->energy) + sum_of(c->wander, 3) + fabs(c->moved);
        if (!isfinite(sum) || !(c->inverse_mass > 1.0 / MASS_MOST) ||
            list[k].shape_i >= list[k].shape_j || list[k].shape_j >= model->shape_slots.count ||
            list[k].kind < SE3DI_CONTACT_LAWFUL || list[k].kind > SE3DI_CONTACT_PARTING) {
            return 0;
        }
    }
    return 1;
}

static int are_near(const se3di_snapshot_near *near, const se3di_model *model)
{
    const uint32_t *pairs = near->pairs.data, *order = near->order.data;
    const size_t shapes = near->order.count;
    if (near->reference.count != 3 * shapes || near->pairs.count % 2 != 0 ||
        (shapes != model->shape_slots.count && (shapes != 0 || near->pairs.count != 0))) {
        return 0;
    }
    for (size_t k = 0; k < near->pairs.count; k += 2) {
        if (pairs[k] >= pairs[k + 1] || pairs[k + 1] >= shapes) {
            return 0;
        }
    }
    for (size_t k = 0; k < shapes; ++k) {
        if (order[k] >= shapes) {
            return 0;
        }
    }
    return isfinite(near->margin) && are_finite(&near->reference, 1);
}

/* What broke did so with all of its rows. */
static int break_whole(const se3di_saved *state, const se3di_model *model)
{
    const uint8_t *flags = state->left_out.data;
    for (size_t k = 0; state->left_out.count > 0 && k < model->constraint_slots.count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        uint32_t broken = 0;
        for (uint32_t r = 0; r < c->row_count; ++r) {
            broken += (flags[c->row_begin + r] & SE3DI_ROW_BROKEN) != 0;
        }
        if (broken > 0 && broken < c->row_count) {
            return 0;
        }
    }
    return 1;
}

static int are_left_out(const se3di_saved *state, const se3di_model *model)
{
    const uint8_t *flags = state->left_out.data;
    size_t count = 0;
    for (size_t k = 0; k < state->left_out.count; ++k) {
        count += flags[k] != 0;
    }
    return count == state->left_out_count &&
           (state->left_out.count == 0 || state->left_out.count == model->row_count) &&
           break_whole(state, model) &&
           (state->left_out_row < model->row_count ||
            (state->left_out_row == 0 && !(state->left_out_gap > 0.0)));
}

static int are_numbers(const se3di_saved *s)
{
    return isfinite(s->time + s->time_rest + s->rest_time + s->contact_step + s->contact_time +
                    s->left_out_gap) &&
           isfinite(sum_of(s->work, 3) + sum_of(s->power, 3)) && are_finite(&s->frames, 26) &&
           are_finite(&s->acceleration, 1) && are_finite(&s->lambda, 1) &&
           are_finite(&s->turns, 1) && are_finite(&s->memory, 1) && are_finite(&s->wrench, 1) &&
           are_finite(&s->history, 1);
}

/* Numbers that lists are found by are what they must be, whoever wrote the bytes. */
static int is_sound(const se3d_snapshot *snapshot, const se3di_model *model)
{
    const se3di_saved *state = &snapshot->state;
    const se3di_integrator *integrator = se3di_integrator_of_history(state->history_tag);
    const int is_known = state->history_tag == 0 ? state->history.count == 0 : integrator != NULL;
    return is_known && are_numbers(state) && are_poses(&state->frames) &&
           are_contacts(state, model) && are_near(&snapshot->near, model) &&
           are_left_out(state, model) &&
           (state->history_tag == 0 || !integrator->is_sound ||
            integrator->is_sound(state->history.data, state->history.count));
}

static se3d_status fail(se3d_system *system, const char *why)
{
    return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "bytes = %s", why);
}

static se3d_status check_frame(se3d_system *system, se3di_coder *c)
{
    uint64_t mark = 0, version = 0, sum = 0;
    if (c->size < 3 * sizeof(uint64_t)) {
        return fail(system, "too few, must be those of a snapshot");
    }
    se3di_code_word(c, &mark);
    se3di_code_word(c, &version);
    if (mark != MARK) {
        return fail(system, "no snapshot, must begin with SE3DSNAP");
    }
    if (version != VERSION) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "bytes = a snapshot of version %llu, must be of version %llu",
                          (unsigned long long)version, (unsigned long long)VERSION);
    }
    se3di_coder end = {.in = c->in + c->size - 8, .size = 8};
    se3di_code_word(&end, &sum);
    c->size -= 8;
    return sum == se3di_hash_bytes(SE3DI_HASH_START, c->in, c->size)
               ? SE3D_OK
               : fail(system, "damaged or cut, their checksum is another one");
}

/* The versions of what acts, which are written relative to those of the model. */
static void take_versions(se3d_snapshot *snapshot, const se3di_model *model)
{
    snapshot->topology_version = model->topology_version;
    snapshot->inputs_version = model->inputs_version;
    snapshot->values_version = model->values_version;
    snapshot->state.history_inputs = model->inputs_version - snapshot->state.history_inputs;
    snapshot->state.history_values = model->values_version - snapshot->state.history_values;
}

static se3d_status fail_other(se3d_system *system, const se3d_snapshot *snapshot)
{
    return SE3DI_FAIL(system, SE3D_ERR_STATE,
                      "the snapshot is of another model (%zu bodies, %zu equations; here %zu and "
                      "%zu): elements must be the same and made in the same order",
                      snapshot->state.frames.count, snapshot->state.lambda.count,
                      system->model.body_slots.count, (size_t)system->model.row_count);
}

static se3d_status fail_read(se3d_system *system, const se3d_snapshot *snapshot, se3d_status status)
{
    switch (status) {
    case SE3D_ERR_NO_MEMORY:
        return SE3DI_FAIL(system, status, "no memory for a snapshot");
    case SE3D_ERR_STATE:
        return fail_other(system, snapshot);
    default:
        return fail(system, "malformed, lengths do not add up or lists name what is not there");
    }
}

static se3d_status read_state(se3d_system *system, se3di_coder *c, se3d_snapshot *snapshot)
{
    const se3di_model *model = &system->model;
    se3d_status status = code_state(c, snapshot);
    if (status >= 0 && c->failed) {
        status = SE3D_ERR_INVALID_ARGUMENT;
    }
    if (status >= 0 && (snapshot->structure != se3di_snapshot_structure(model) ||
                        !se3di_saved_fits(&snapshot->state, model))) {
        status = SE3D_ERR_STATE;
    }
    if (status >= 0) {
        status = se3di_sets_read(c, model, &snapshot->sets);
    }
    if (status >= 0 && (c->failed || c->at != c->size)) {
        status = SE3D_ERR_INVALID_ARGUMENT;
    }
    if (status < 0) {
        return fail_read(system, snapshot, status);
    }
    if (!is_sound(snapshot, model)) {
        return fail(system, "malformed, they hold numbers that no state has");
    }
    take_versions(snapshot, model);
    return SE3D_OK;
}

se3d_status se3d_snapshot_read(se3d_system *system, const void *bytes, size_t size,
                               se3d_snapshot **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "bytes", bytes));
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3di_coder c = {.in = bytes, .size = size};
    SE3DI_TRY(check_frame(system, &c));
    se3d_snapshot *snapshot = se3di_alloc(&system->model.allocator, 1, sizeof *snapshot);
    if (!snapshot) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a snapshot");
    }
    snapshot->allocator = system->model.allocator;
    const se3d_status status = read_state(system, &c, snapshot);
    if (status < 0) {
        se3d_snapshot_destroy(snapshot);
        return status;
    }
    *out = snapshot;
    return SE3D_OK;
}
