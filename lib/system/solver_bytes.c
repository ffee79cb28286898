/* SPDX-License-Identifier: BSD-3-Clause */
/* What a solver knows beside the state of its system, as bytes: what it has counted and told, the
 * method it has come to, its events with their records and what was seen of the step under way. */
#include "analysis/breaks.h"
#include "base/coder.h"
#include "base/hash.h"
#include "system/solver.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#define MARK    UINT64_C(0x564C4F5344334553) /* "SE3DSOLV" */
#define VERSION UINT64_C(10)
#define FRAME   (3 * sizeof(uint64_t)) /* mark, version, checksum */

static void code_counters(se3di_coder *c, se3di_run *run)
{
    se3di_counters *n = &run->equations.counters;
    uint64_t *const words[] = {&n->steps,       &n->rejected,       &n->iterations,
                               &n->evaluations, &n->factorizations, &n->solves};
    se3di_guard *g = &run->guard;
    double *const numbers[] = {&g->begin, &g->end, &g->steps, &g->half, &g->half_time, &g->next};
    for (int k = 0; k < 6; ++k) {
        se3di_code_word(c, words[k]);
        se3di_code_numbers(c, numbers[k], 1);
    }
    se3di_code_flag(c, &run->integration.owes);
    se3di_code_flag(c, &run->integration.foresees);
    if (c->in && g->steps > 0.0 && isfinite(run->horizon)) { /* which may be another one now */
        g->end = run->horizon;
    }
}

/* A method by its number; 0: none. */
static void code_method(se3di_coder *c, const se3di_integrator **method)
{
    uint32_t tag = *method ? (uint32_t)(*method)->tag : 0;
    int32_t has = *method != NULL;
    se3di_code_flag(c, &has);
    se3di_code_uint32(c, &tag);
    if (c->in) {
        *method = has && tag <= INT32_MAX ? se3di_integrator_find((int32_t)tag) : NULL;
        c->failed |= has && !*method;
    }
}

/* A body by its place; none: as many as there are. */
static void code_body(se3di_coder *c, const se3di_slots *slots, se3di_handle *body)
{
    const uint32_t found = se3di_slots_find(slots, body->index1, body->generation);
    uint32_t place = found == SE3DI_NO_INDEX ? (uint32_t)slots->count : found;
    se3di_code_uint32(c, &place);
    if (c->in) {
        c->failed |= place > slots->count;
        *body = place < slots->count ? se3di_slots_handle(slots, place) : (se3di_handle){0, 0};
    }
}

static void code_start(se3di_coder *c, se3di_run *run)
{
    se3di_start_change *start = &run->start;
    se3di_code_numbers(c, &start->time, 1);
    se3di_code_numbers(c, &start->position, 1);
    se3di_code_numbers(c, &start->rotation, 1);
    se3di_code_numbers(c, &start->velocity, 1);
    se3di_code_numbers(c, &start->angular_velocity, 1);
    se3di_code_numbers(c, start->most_position, 2);
    se3di_code_numbers(c, start->most_velocity, 2);
    code_body(c, &run->model->body_slots, &start->moved);
    code_body(c, &run->model->body_slots, &start->deflected);
}

/* The name of a joint that is gone, a word for each character. */
static void code_name(se3di_coder *c, se3di_events *events, const char **name)
{
    const se3d_allocator *allocator = &events->run->model->allocator;
    size_t length = c->in ? 0 : strlen(*name);
    se3di_code_count(c, &length, 1.0);
    char *text = c->in ? se3di_alloc(allocator, length + 1, 1) : NULL;
    c->failed |= c->in && !text;
    for (size_t k = 0; k < length; ++k) {
        uint32_t character = c->in ? 0 : (unsigned char)(*name)[k];
        se3di_code_uint32(c, &character);
        c->failed |= character == 0 || character > UCHAR_MAX;
        if (text) {
            text[k] = (char)(unsigned char)(character & UCHAR_MAX);
        }
    }
    if (text) {
        c->failed |= c->failed || se3di_breaks_keep_name(events, text, name) < 0;
        se3di_free(allocator, text, length + 1, 1);
    }
}

/* Of a joint that broke by its place, or as many as there are and its name if it is gone. */
static void code_broken(se3di_coder *c, se3di_events *events, se3d_event_record *record)
{
    const se3di_slots *slots = &events->run->model->constraint_slots;
    const uint32_t found = se3di_slots_find(slots, record->joint.index1, record->joint.generation);
    uint32_t joint = found == SE3DI_NO_INDEX ? (uint32_t)slots->count : found;
    se3di_code_uint32(c, &joint);
    if (c->in) {
        record->event = (se3d_event){0, 0};
        record->joint = (se3d_constraint){0, 0};
        record->name = "";
        c->failed |= joint > slots->count;
    }
    if (joint == slots->count) {
        code_name(c, events, &record->name);
    } else if (c->in && !c->failed) {
        c->failed |= se3di_breaks_name_record(events, joint, record) < 0;
    }
}

static void code_event(se3di_coder *c, const se3di_events *events, se3d_event_record *record)
{
    uint32_t event =
        se3di_slots_find(&events->slots, record->event.index1, record->event.generation);
    se3di_code_uint32(c, &event);
    if (c->in && event < events->slots.count) {
        const se3di_handle handle = se3di_slots_handle(&events->slots, event);
        const char *name = events->list[event].name;
        record->event = (se3d_event){handle.index1, handle.generation};
        record->joint = (se3d_constraint){0, 0};
        record->name = name ? name : "";
    }
    c->failed |= event >= events->slots.count;
}

static void code_record(se3di_coder *c, se3di_events *events, se3d_event_record *record)
{
    int32_t broke = !c->in && record->event.index1 == 0;
    se3di_code_flag(c, &broke);
    if (broke) {
        code_broken(c, events, record);
    } else {
        code_event(c, events, record);
    }
    se3di_code_numbers(c, &record->time, 1);
    se3di_code_numbers(c, &record->value, 1);
    se3di_code_int32(c, &record->direction);
    se3di_code_int32(c, &record->action);
}

/* Which event a crossing is of: the user's by its place, a joint that may break by the joint's. In
 * the bytes these follow one another; @return whether there is such an event. */
static int code_crossed(se3di_coder *c, const se3di_events *events, uint32_t *event)
{
    const size_t own = events->slots.count, joints = events->run->model->constraint_slots.count;
    uint32_t place = *event;
    if (!c->in && *event >= own) {
        place = (uint32_t)own + events->list[*event].joint - 1;
    }
    se3di_code_uint32(c, &place);
    c->failed |= place >= own + joints;
    if (!c->in || place < own) {
        *event = place;
        return !c->failed;
    }
    *event = (uint32_t)own;
    while (*event < se3di_events_count(events) &&
           events->list[*event].joint != place - (uint32_t)own + 1) {
        ++*event;
    }
    return *event < se3di_events_count(events);
}

/* The crossings of the step that was looked at last; those of a joint that may not break any more
 * are not taken. */
static void code_hits(se3di_coder *c, se3di_events *events, size_t count)
{
    const size_t room = SE3DI_CROSSINGS_MAX * (size_t)se3di_events_count(events);
    size_t kept = 0;
    for (size_t k = 0; k < count && !(c->in && c->failed); ++k) {
        se3di_event_hit hit = c->in ? (se3di_event_hit){0} : events->hits[k];
        se3di_code_numbers(c, &hit.time, 1);
        const int is_there = code_crossed(c, events, &hit.event);
        se3di_code_int32(c, &hit.direction);
        if (c->in && is_there) {
            c->failed |= kept >= room;
            if (!c->failed) {
                events->hits[kept++] = hit;
            }
        }
    }
    events->hit_count = c->in ? kept : events->hit_count;
}

/* The step that was looked at last. Loads of joints are not asked for again. */
static void code_look(se3di_coder *c, se3di_events *events)
{
    int32_t follows = events->looked_stamp == events->run->model->history_stamp;
    se3di_code_flag(c, &follows);
    se3di_code_flag(c, &events->dense);
    se3di_code_flag(c, &events->looked);
    se3di_code_int32(c, &events->node_count);
    se3di_code_numbers(c, &events->reached, 1);
    se3di_code_numbers(c, &events->looked_time, 1);
    se3di_code_numbers(c, events->t, SE3DI_CROSSING_NODES);
    if (events->node_count != 0 && events->slots.count > 0) { /* of a solver that has run */
        se3di_code_numbers(c, events->g, SE3DI_CROSSING_NODES * events->slots.count);
    }
    if (c->in) {
        events->looked_stamp =
            follows ? events->run->model->history_stamp : events->run->model->history_stamp - 1;
        c->failed |= events->node_count < 0 || events->node_count > SE3DI_CROSSING_NODES;
    }
}

/* Lengths: of the events there are, of crossings seen in the step, of the records. Crossings of a
 * step that is not the last one any more are of no use, and their events may be gone. */
static se3d_status code_lengths(se3di_coder *c, se3di_events *events, size_t *hits)
{
    const int follows = events->looked_stamp == events->run->model->history_stamp;
    size_t count = events->slots.count, records = events->record_count;
    *hits = follows && events->looked ? events->hit_count : 0;
    se3di_code_count(c, &count, 1.0);
    se3di_code_count(c, hits, 3.0);
    se3di_code_count(c, &records, 5.0);
    if (!c->in) {
        return SE3D_OK;
    }
    if (c->failed || count != events->slots.count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_events_clear(events);
    events->hit_count = 0;
    void *memory = events->records;
    const se3d_status status =
        se3di_array_reserve(&events->run->model->allocator, &memory, &events->record_capacity,
                            records, sizeof *events->records);
    events->records = memory;
    SE3DI_TRY(status);
    events->record_count = records;
    return SE3D_OK;
}

static se3d_status code_events(se3di_coder *c, se3di_events *events)
{
    size_t hits;
    SE3DI_TRY(code_lengths(c, events, &hits));
    for (size_t k = 0; k < events->slots.count; ++k) {
        se3di_code_int32(c, &events->list[k].side);
    }
    code_look(c, events);
    code_hits(c, events, hits);
    for (size_t k = 0; k < events->record_count; ++k) {
        code_record(c, events, &events->records[k]);
    }
    return c->failed && c->in ? SE3D_ERR_INVALID_ARGUMENT : SE3D_OK;
}

/* *method: the one in use, which `auto` would now choose by another state. */
static se3d_status code_solver(se3di_coder *c, se3di_run *run, const se3di_integrator **method)
{
    int32_t analysis = run->analysis;
    se3di_code_int32(c, &analysis);
    if (analysis != run->analysis) {
        return SE3D_ERR_STATE;
    }
    code_method(c, method);
    code_counters(c, run);
    code_method(c, &run->left);
    se3di_code_numbers(c, &run->left_at, 1);
    se3di_code_flag(c, &run->determined);
    code_start(c, run);
    return code_events(c, &run->events);
}

se3d_status se3d_solver_write(const se3d_solver *solver, void *bytes, size_t capacity, size_t *size)
{
    if (size) {
        *size = 0;
    }
    if (!solver || !size) {
        return SE3D_ERR_NULL;
    }
    if (!solver->system) {
        return SE3D_ERR_STATE;
    }
    se3di_pending_complete(solver->system->model.pending);
    se3di_run copy = solver->run; /* what it points to is only looked at */
    se3di_coder measure = {.size = SIZE_MAX};
    uint64_t mark = MARK, version = VERSION;
    (void)code_solver(&measure, &copy, &copy.integration.method);
    *size = measure.at + FRAME;
    if (!bytes || capacity < *size) {
        return bytes ? SE3D_ERR_INVALID_ARGUMENT : SE3D_OK;
    }
    se3di_coder c = {.out = bytes, .size = *size};
    se3di_code_word(&c, &mark);
    se3di_code_word(&c, &version);
    (void)code_solver(&c, &copy, &copy.integration.method);
    uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, c.at);
    se3di_code_word(&c, &sum);
    return SE3D_OK;
}

static se3d_status check_frame(se3d_system *system, se3di_coder *c)
{
    uint64_t mark = 0, version = 0, sum = 0;
    const char *why = "too few, must be those of a solver";
    if (c->size >= FRAME) {
        se3di_coder end = {.in = c->in + c->size - sizeof sum, .size = sizeof sum};
        se3di_code_word(c, &mark);
        se3di_code_word(c, &version);
        se3di_code_word(&end, &sum);
        c->size -= sizeof sum;
        why = mark != MARK         ? "no solver, must begin with SE3DSOLV"
              : version != VERSION ? "a solver of another version"
              : sum != se3di_hash_bytes(SE3DI_HASH_START, c->in, c->size)
                  ? "damaged or cut, their checksum is another one"
                  : NULL;
    }
    return why ? SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "bytes = %s", why) : SE3D_OK;
}

/* What a solver that could not be read is left with. */
static void forget(se3di_run *run)
{
    run->equations.counters = (se3di_counters){0};
    se3di_events_clear(&run->events);
    run->events.hit_count = 0;
    run->events.looked = run->events.node_count = 0;
    run->events.looked_stamp = run->model->history_stamp - 1;
    run->left = NULL;
    run->determined = 0;
}

static se3d_status read_solver(se3d_solver *solver, se3di_coder *c)
{
    se3d_system *system = solver->system;
    SE3DI_TRY(se3di_run_prepare(&solver->run));
    const se3di_integrator *method = NULL;
    se3d_status status = code_solver(c, &solver->run, &method);
    if (status >= 0 && (c->failed || c->at != c->size)) {
        status = SE3D_ERR_INVALID_ARGUMENT;
    }
    if (status >= 0 && method) { /* last: what fails before has not changed it */
        status = se3di_run_take_method(&solver->run, method);
    }
    if (status >= 0) {
        return status;
    }
    forget(&solver->run);
    switch (status) {
    case SE3D_ERR_NO_MEMORY:
        return SE3DI_FAIL(system, status, "no memory for the records of a solver");
    case SE3D_ERR_STATE:
        return SE3DI_FAIL(system, status, "the bytes are of a solver of another analysis");
    default:
        return SE3DI_FAIL(system, status, "bytes = malformed, or of a solver with other events");
    }
}

se3d_status se3d_solver_read(se3d_solver *solver, const void *bytes, size_t size)
{
    SE3DI_EDIT_OF(solver);
    SE3DI_TRY(se3di_check_pointer(solver->system, "bytes", bytes));
    se3di_coder c = {.in = bytes, .size = size};
    SE3DI_TRY(check_frame(solver->system, &c));
    se3di_work_begin(solver->system);
    return se3di_work_end(solver->system, read_solver(solver, &c));
}
