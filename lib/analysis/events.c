/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/events.h"

#include "analysis/breaks.h"
#include "analysis/run.h"
#include "base/busy.h"
#include "base/floats.h"
#include "contact/bodies/body_contacts.h"
#include "integrator/state.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The samples of a step; more finely after its beginning if a value begins at its level, which
 * it may reach again soon. */
static const double plain_nodes[] = {0.0, 0.25, 0.5, 0.75, 1.0};
static const double fine_nodes[] = {0.0, 1e-4, 1e-2, 0.1, 0.25, 0.5, 0.75, 1.0};

void se3di_events_init(se3di_events *events, struct se3di_run *run, se3d_system *system,
                       uint32_t salt)
{
    events->run = run;
    events->system = system;
    se3di_slots_init(&events->slots, salt);
}

void se3di_events_destroy(se3di_events *events)
{
    const se3d_allocator *allocator = &events->run->model->allocator;
    for (size_t k = 0; k < events->slots.count; ++k) {
        se3di_text_free(allocator, events->list[k].name);
    }
    se3di_events_clear(events);
    se3di_free(allocator, events->names, events->name_capacity, sizeof *events->names);
    se3di_free(allocator, events->list, events->capacity, sizeof *events->list);
    se3di_free(allocator, events->records, events->record_capacity, sizeof *events->records);
    se3di_free(allocator, events->hits, events->hit_capacity, sizeof *events->hits);
    se3di_free(allocator, events->g, events->g_capacity, sizeof *events->g);
    se3di_free(allocator, events->y, events->y_capacity, sizeof *events->y);
    se3di_saved_destroy(&events->from, allocator);
    se3di_saved_destroy(&events->to, allocator);
    se3di_slots_destroy(&events->slots, allocator);
}

se3d_status se3di_events_add(se3di_events *events, const char *name, const se3di_event *event,
                             se3di_handle *handle)
{
    const se3d_allocator *allocator = &events->run->model->allocator;
    const size_t count = events->slots.count;
    void *list = events->list;
    SE3DI_TRY(se3di_slots_reserve(&events->slots, allocator));
    se3d_status status =
        se3di_array_reserve(allocator, &list, &events->capacity, count + 1, sizeof *events->list);
    events->list = list;
    SE3DI_TRY(status);
    char *copy = name ? se3di_text_copy(allocator, name) : NULL;
    if (name && !copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    events->list[count] = *event;
    events->list[count].name = copy;
    *handle = se3di_slots_add(&events->slots);
    events->break_count = 0; /* they are listed anew before a run */
    events->looked = 0;
    return SE3D_OK;
}

void se3di_events_remove(se3di_events *events, uint32_t event)
{
    const se3di_handle handle = se3di_slots_handle(&events->slots, event);
    size_t kept = 0;
    for (size_t k = 0; k < events->record_count; ++k) {
        const se3d_event_record *record = &events->records[k];
        if (record->event.index1 != handle.index1) {
            events->records[kept++] = *record;
        }
    }
    events->record_count = kept;
    se3di_text_free(&events->run->model->allocator, events->list[event].name);
    memmove(&events->list[event], &events->list[event + 1],
            (events->slots.count - event - 1) * sizeof *events->list);
    se3di_slots_remove(&events->slots, event);
    events->break_count = 0;
    events->looked = 0;
}

static se3d_status reserve(se3di_events *events, double **data, size_t *capacity, size_t count)
{
    void *grown = *data;
    const se3d_status status =
        se3di_array_reserve(&events->run->model->allocator, &grown, capacity, count, sizeof **data);
    *data = grown;
    return status;
}

se3d_status se3di_events_prepare(se3di_events *events)
{
    SE3DI_TRY(se3di_breaks_list(events));
    const size_t count = se3di_events_count(events);
    const se3di_model *model = events->run->model;
    const size_t states = se3di_state_count(&events->run->equations.assembly);
    void *hits = events->hits;
    if (count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(reserve(events, &events->g, &events->g_capacity, SE3DI_CROSSING_NODES * count));
    SE3DI_TRY(reserve(events, &events->y, &events->y_capacity, states));
    const se3d_status status =
        se3di_array_reserve(&model->allocator, &hits, &events->hit_capacity,
                            SE3DI_CROSSINGS_MAX * count, sizeof *events->hits);
    events->hits = hits;
    return status;
}

static const char *name_of(const se3di_event *event)
{
    return event->name ? event->name : "without a name";
}

/* Call the user's value. */
static se3d_status call_value(se3di_events *events, const se3di_event *event, double *value)
{
    se3di_run *run = events->run;
    const int32_t level = se3di_busy_raise(run->model->busy, SE3DI_BUSY_VALUE);
    const se3d_status status = event->value(event->ctx, events->system, value);
    se3di_floats_resume();
    se3di_busy_restore(run->model->busy, level);
    return status >= 0 ? SE3D_OK
                       : se3di_error_set(run->error, SE3D_ERR_CALLBACK,
                                         "t = %g s: the value of the event %.100s could not be "
                                         "computed",
                                         run->model->time, name_of(event));
}

/* The value at the model's state, less the level, with the contacts that it shows. */
static se3d_status eval_shown(se3di_events *events, uint32_t k, double *g)
{
    const se3di_event *event = &events->list[k];
    const double t = events->run->model->time;
    double value = 0.0;
    if (event->joint > 0) {
        value = se3di_break_measure(events->run->model, event->joint - 1);
    } else {
        SE3DI_TRY(call_value(events, event, &value));
    }
    if (!isfinite(value)) {
        return se3di_error_set(events->run->error, SE3D_ERR_NOT_FINITE,
                               "t = %g s: the value of the event %.100s is not finite", t,
                               name_of(event));
    }
    *g = value - event->level;
    return SE3D_OK;
}

static uint32_t count_kind(const se3di_events *events, uint32_t from, uint32_t to, int motion)
{
    uint32_t count = 0;
    for (uint32_t k = from; k < to; ++k) {
        count += !events->list[k].motion_only == !motion;
    }
    return count;
}

/* The events from..to-1 of which motion_only is `motion`, at a node: g of the first is given. What
 * contacts remember is that of the end of a dense step; values that may use forces within it see
 * the contacts that are there, found once for all. */
static se3d_status eval_kind(se3di_events *events, uint32_t from, uint32_t to, int motion,
                             double *g, size_t stride)
{
    se3di_run *run = events->run;
    const int shows = events->dense && !motion && count_kind(events, from, to, motion) > 0;
    se3d_status status = SE3D_OK;
    if (shows) {
        SE3DI_TRY(se3di_contacts_show(run->model, run->model->time, run->error));
    }
    for (uint32_t k = from; k < to && status >= 0; ++k) {
        if (!events->list[k].motion_only == !motion) {
            status = eval_shown(events, k, &g[stride * (k - from)]);
        }
    }
    if (shows) {
        se3di_contacts_hide(run->model);
    }
    return status;
}

static se3d_status eval_one(se3di_events *events, uint32_t k, double *g)
{
    return eval_kind(events, k, k + 1, events->list[k].motion_only, g, 0);
}

/* Hermite's interpolation of n numbers: values a, b and derivatives da, db at the ends of h. */
static void hermite(const double *ends[4], double h, double s, int n, double *out)
{
    const double u = 1.0 - s;
    for (int k = 0; k < n; ++k) {
        out[k] = u * u * (1.0 + 2.0 * s) * ends[0][k] + s * s * (1.0 + 2.0 * u) * ends[1][k] +
                 h * s * u * (u * ends[2][k] - s * ends[3][k]);
    }
}

/* Positions to order 5: what the accelerations at the ends add to the cubic. */
static void add_quintic(const double *ends[6], double h, double s, double out[3])
{
    const double u = 1.0 - s;
    for (int k = 0; k < 3; ++k) {
        const double d = (ends[1][k] - ends[0][k]) / h;                        /* mean slope */
        const double a0 = (6.0 * d - 4.0 * ends[2][k] - 2.0 * ends[3][k]) / h; /* of the cubic */
        const double a1 = (2.0 * ends[2][k] + 4.0 * ends[3][k] - 6.0 * d) / h;
        const double e0 = ends[4][k] - a0, e1 = ends[5][k] - a1;
        out[k] += 0.5 * h * h * s * s * u * u * (u * e0 + s * e1);
    }
}

/* The model's state at t between the ends of the watched step, without its constraints. */
static void interpolate_watched(se3di_events *events, double t)
{
    se3di_model *model = events->run->model;
    const double h = events->to.time - events->from.time;
    const double s = (t - events->from.time) / h;
    const se3di_frame *from = events->from.frames.data, *to = events->to.frames.data;
    const double *acceleration[2] = {events->from.acceleration.data, events->to.acceleration.data};
    const double *lambda[2] = {events->from.lambda.data, events->to.lambda.data};
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const double *a = acceleration[0] + 6 * k, *b = acceleration[1] + 6 * k;
        const se3di_frame *p = &from[k], *q = &to[k];
        se3di_frame *frame = &model->frames[k];
        double turn[4];
        if (model->bodies[k].fixed) {
            continue;
        }
        hermite((const double *[4]){p->r, q->r, p->v, q->v}, h, s, 3, frame->r);
        add_quintic((const double *[6]){p->r, q->r, p->v, q->v, a, b}, h, s, frame->r);
        hermite((const double *[4]){p->v, q->v, a, b}, h, s, 3, frame->v);
        hermite((const double *[4]){p->p, q->p, p->pdot, q->pdot}, h, s, 4, turn);
        hermite((const double *[4]){p->w, q->w, a + 3, b + 3}, h, s, 3, frame->w);
        se3di_quat_normalize(turn, frame->p);
        se3di_frame_update(frame);
        for (size_t c = 0; c < 6; ++c) {
            model->acceleration[6 * k + c] = (1.0 - s) * a[c] + s * b[c];
        }
    }
    for (size_t k = 0; k < model->row_count; ++k) {
        model->lambda[k] = (1.0 - s) * lambda[0][k] + s * lambda[1][k];
    }
    for (int k = 0; k < 3; ++k) {
        model->work[k] = (1.0 - s) * events->from.work[k] + s * events->to.work[k];
    }
    model->time = t;
}

static se3d_status go_back(se3di_events *events, const se3di_saved *saved)
{
    se3di_model *model = events->run->model;
    SE3DI_TRY(se3di_saved_reserve(saved, model));
    se3di_saved_restore(saved, model);
    return SE3D_OK;
}

/* A rough state at t, at least good enough to see where a value changes its sign. */
static se3d_status set_rough(se3di_events *events, double t)
{
    const se3di_integration *integration = &events->run->integration;
    se3di_assembly *assembly = &events->run->equations.assembly;
    if (!events->dense) {
        interpolate_watched(events, t);
        return SE3D_OK;
    }
    integration->method->interpolate(integration, t, events->y);
    se3di_state_set(assembly, events->y);
    memcpy(assembly->model->work, events->y + se3di_state_count(assembly) - SE3DI_STATE_WORK,
           sizeof assembly->model->work);
    assembly->model->time = t;
    return SE3D_OK;
}

/* Particles cannot: their sets are too large to be kept in every step. */
static int can_go_back(const se3di_events *events)
{
    return !events->run->model->sets || events->run->analysis != SE3D_ANALYSIS_DYNAMICS;
}

/* The state at t as the method gives it: consistent in all levels. */
static se3d_status set_exact(se3di_events *events, double t)
{
    se3di_run *run = events->run;
    if (events->dense) {
        SE3DI_TRY(run->integration.method->run(&run->integration, t));
    } else if (t >= events->to.time) {
        SE3DI_TRY(go_back(events, &events->to));
    } else if (!can_go_back(events)) {
        return set_rough(events, t);
    } else {
        SE3DI_TRY(go_back(events, &events->from));
        if (t > events->from.time) {
            SE3DI_TRY(se3di_run_make_step(run, t - events->from.time));
            run->model->time = t;
        }
    }
    return run->equations.redundant ? se3di_multipliers_reduce(&run->equations) : SE3D_OK;
}

static se3d_status eval_rough(void *ctx, double t, double *g)
{
    se3di_events *events = ctx;
    const int exact = events->dense && !events->list[events->looking_for].motion_only;
    SE3DI_TRY(exact ? set_exact(events, t) : set_rough(events, t));
    return eval_one(events, events->looking_for, g);
}

static se3d_status eval_exact(void *ctx, double t, double *g)
{
    se3di_events *events = ctx;
    SE3DI_TRY(set_exact(events, t));
    return eval_one(events, events->looking_for, g);
}

/* The event is on record at t: what it does from there is new. */
static int has_happened_at(const se3di_events *events, uint32_t k, double t)
{
    if (events->list[k].joint > 0) {
        return 0;
    }
    const se3di_handle handle = se3di_slots_handle(&events->slots, k);
    for (size_t n = events->record_count; n > 0 && events->records[n - 1].time >= t; --n) {
        const se3d_event_record *record = &events->records[n - 1];
        if (!(record->time > t) && record->event.index1 == handle.index1) {
            return 1;
        }
    }
    return 0;
}

/* Values of all events at node `node`, which is the state of the model. */
static se3d_status eval_node(se3di_events *events, int node)
{
    const uint32_t count = se3di_events_count(events);
    double *g = &events->g[node];
    SE3DI_TRY(eval_kind(events, 0, count, 1, g, SE3DI_CROSSING_NODES));
    return eval_kind(events, 0, count, 0, g, SE3DI_CROSSING_NODES);
}

/* This near to the level no side of it can be told: as asked for, at least its rounding. */
static double band_of(const se3di_event *event)
{
    return fmax(event->hysteresis, 4.0 * DBL_EPSILON * fabs(event->level));
}

/* On which side of its level an event's value was last seen up to t within the step that was looked
 * at; 0: at none. */
static int32_t side_at(const se3di_events *events, uint32_t k, double t)
{
    const double *g = &events->g[SE3DI_CROSSING_NODES * k];
    const double band = band_of(&events->list[k]);
    const se3di_handle handle = se3di_slots_handle(&events->slots, k);
    double since = events->t[0];
    int32_t side = 0;
    for (int node = 0; node < events->node_count && events->t[node] <= t; ++node) {
        if (fabs(g[node]) > band) {
            side = g[node] > 0.0 ? 1 : -1;
            since = events->t[node];
        }
    }
    for (size_t n = 0; n < events->record_count; ++n) {
        const se3d_event_record *record = &events->records[n];
        if (record->event.index1 == handle.index1 && record->time > since && record->time <= t) {
            side = record->direction;
        }
    }
    return side;
}

void se3di_events_renew(se3di_events *events, uint64_t stamp)
{
    const double t = events->run->model->time;
    const int knows = events->slots.count > 0 && events->looked_stamp == stamp;
    if (knows && events->looked && events->looked_time > t) {
        for (uint32_t k = 0; k < events->slots.count; ++k) {
            events->list[k].side = side_at(events, k, t);
        }
        events->looked_time = t;
    }
    events->looked = 0;
    if (knows) {
        events->looked_stamp = events->run->model->history_stamp;
    }
}

/* The step from `begin` follows the one that was looked at last. */
static int follows(const se3di_events *events, double begin)
{
    return events->looked_stamp == events->run->model->history_stamp &&
           !(events->looked_time < begin) && !(events->looked_time > begin);
}

/* The values at the first node are there: those that begin at their level, and the nodes. */
static void choose_nodes(se3di_events *events, double begin, double end)
{
    const int goes_on = follows(events, begin);
    int fine = 0;
    for (uint32_t k = 0; k < se3di_events_count(events); ++k) {
        double *g = &events->g[SE3DI_CROSSING_NODES * k];
        se3di_event *event = &events->list[k];
        const int happened = has_happened_at(events, k, begin);
        *g = happened ? 0.0 : *g;
        event->side = goes_on && !happened ? event->side : 0;
        event->side = event->joint > 0 ? -1 : event->side;
        fine |= !(fabs(*g) > band_of(event));
    }
    const double *s = fine ? fine_nodes : plain_nodes;
    events->node_count = fine ? (int)(sizeof fine_nodes / sizeof *fine_nodes)
                              : (int)(sizeof plain_nodes / sizeof *plain_nodes);
    for (int k = 0; k < events->node_count; ++k) {
        events->t[k] = begin + s[k] * (end - begin);
    }
    events->t[events->node_count - 1] = end;
}

static void add_hit(se3di_events *events, double t, uint32_t event, int32_t direction)
{
    size_t at = events->hit_count++;
    for (; at > 0 && events->hits[at - 1].time > t; --at) {
        events->hits[at] = events->hits[at - 1];
    }
    events->hits[at] = (se3di_event_hit){t, event, direction};
}

/* Crossings of one event, into the list of hits. */
static se3d_status find_hits(se3di_events *events, uint32_t k)
{
    se3di_crossings found;
    se3di_event *event = &events->list[k];
    const se3di_crossing_function function = {.rough = eval_rough,
                                              .exact = eval_exact,
                                              .ctx = events,
                                              .t = events->t,
                                              .g = &events->g[SE3DI_CROSSING_NODES * k],
                                              .count = events->node_count,
                                              .band = band_of(event),
                                              .direction = event->direction,
                                              .side = event->side};
    events->looking_for = k;
    SE3DI_TRY(se3di_crossings_find(&function, &found));
    event->side = found.side;
    for (int n = 0; n < found.count; ++n) {
        add_hit(events, found.list[n].t, k, found.list[n].direction);
    }
    return SE3D_OK;
}

/* The joint holds what it is loaded with at the beginning of a step, or breaks there, as one does
 * that is loaded with what others held which broke. */
static se3d_status find_break(se3di_events *events, uint32_t k)
{
    const double *g = &events->g[SE3DI_CROSSING_NODES * k];
    const int last = events->node_count - 1;
    if (g[0] > 0.0) {
        add_hit(events, events->t[0], k, 1);
        return SE3D_OK;
    }
    if (!se3di_breaks_end_steps(events)) {
        return find_hits(events, k);
    }
    if (g[last] > 0.0) {
        add_hit(events, events->t[last], k, 1);
    }
    return SE3D_OK;
}

static se3d_status find_all_hits(se3di_events *events)
{
    events->hit_count = 0;
    for (uint32_t k = 0; k < se3di_events_count(events); ++k) {
        SE3DI_TRY(events->list[k].joint > 0 ? find_break(events, k) : find_hits(events, k));
    }
    events->looked_time = events->t[events->node_count - 1];
    events->looked_stamp = events->run->model->history_stamp;
    return SE3D_OK;
}

/* Looking for events is not counted as steps and iterations of the run. */
static void keep_counters(se3di_events *events, const se3di_counters *before)
{
    se3di_counters *now = &events->run->equations.counters;
    now->steps = before->steps;
    now->rejected = before->rejected;
    now->iterations = before->iterations;
}

static se3d_status add_record(se3di_events *events, const se3di_event_hit *hit,
                              se3d_event_record **record)
{
    const se3di_event *event = &events->list[hit->event];
    const se3di_handle handle = se3di_slots_handle(&events->slots, hit->event);
    double g = 0.0;
    SE3DI_TRY(set_exact(events, hit->time));
    SE3DI_TRY(eval_one(events, hit->event, &g));
    const se3d_event_record happened = {.time = hit->time,
                                        .value = g + event->level,
                                        .name = event->name ? event->name : "",
                                        .event = {handle.index1, handle.generation},
                                        .direction = hit->direction,
                                        .action = event->action};
    SE3DI_TRY(se3di_events_add_record(events, &happened));
    *record = &events->records[events->record_count - 1];
    return SE3D_OK;
}

/* Whether readers are to see other contacts than those of the end of the step. */
static int has_own_contacts(const se3di_events *events)
{
    return events->dense && events->run->model->contacts.pair_count > 0;
}

/* Let the user's callback act on the state of a hit, with the contacts there. What it has changed
 * begins anew, with these contacts. */
static se3d_status call_back(se3di_events *events, const se3di_event *event,
                             const se3d_event_record *record, int *changed)
{
    se3di_model *model = events->run->model;
    const uint64_t stamp = model->history_stamp, inputs = model->inputs_version;
    const int shows = has_own_contacts(events);
    if (shows) {
        SE3DI_TRY(se3di_contacts_show(model, model->time, events->run->error));
    }
    const int32_t level = se3di_busy_raise(model->busy, SE3DI_BUSY_EVENT);
    const se3d_status status = event->callback(event->callback_ctx, events->system, record);
    se3di_floats_resume();
    se3di_busy_restore(model->busy, level);
    *changed = model->history_stamp != stamp || model->inputs_version != inputs;
    if (shows && !*changed) {
        se3di_contacts_hide(model);
    }
    return status;
}

/* The run ends within a step, in the state of a hit: with the contacts there, from which the next
 * run begins anew; those of the end of the step are not of its past. */
static se3d_status stay(se3di_events *events)
{
    se3di_model *model = events->run->model;
    if (has_own_contacts(events)) {
        SE3DI_TRY(se3di_contacts_show(model, model->time, events->run->error));
        model->history_tag = 0;
        ++model->history_stamp;
    }
    return SE3D_OK;
}

/* Record a hit; the model is in the state there. *stop: the run ends; *changed: the callback has
 * changed the state. */
static se3d_status happen(se3di_events *events, const se3di_event_hit *hit, int *stop, int *changed)
{
    se3d_event_record *record = NULL;
    const se3di_event *event = &events->list[hit->event];
    if (event->joint > 0) {
        *changed = 1;
        SE3DI_TRY(set_exact(events, hit->time));
        return se3di_breaks_happen(events);
    }
    SE3DI_TRY(add_record(events, hit, &record));
    if (event->callback) {
        const se3d_event_record shown = *record;
        const se3d_status status = call_back(events, event, &shown, changed);
        if (status < 0) {
            return se3di_error_set(events->run->error, SE3D_ERR_CALLBACK,
                                   "t = %g s: the callback of the event %.100s failed", hit->time,
                                   name_of(event));
        }
        record->action = status == SE3D_INFO_EVENT ? SE3D_EVENT_STOP : record->action;
    }
    *stop |= record->action == SE3D_EVENT_STOP;
    return SE3D_OK;
}

/* Report the hits after t0 and not after t_end. @return INFO_EVENT: the run ends at the last of
 * them, where the model is. */
static se3d_status report(se3di_events *events, double t0, double t_end)
{
    int stop = 0, changed = 0;
    double last = t_end;
    for (size_t k = 0; k < events->hit_count && !changed; ++k) {
        se3di_event_hit *hit = &events->hits[k];
        if (hit->time > t_end && hit->time - t_end <= 4.0 * DBL_EPSILON * fabs(t_end)) {
            hit->time = t_end; /* but for rounding: what follows may begin anew there */
        }
        const int comes =
            hit->time > t0 || (events->list[hit->event].joint > 0 && !(hit->time < t0));
        if (comes && hit->time <= last) {
            SE3DI_TRY(happen(events, hit, &stop, &changed));
            last = stop ? hit->time : last; /* what happens at the same time does so too */
        }
    }
    if (stop && !changed) {
        SE3DI_TRY(stay(events));
    }
    events->goes_on = changed && !stop;
    return stop || changed ? SE3D_INFO_EVENT : SE3D_OK;
}

/* Values of all events at t, as eval_rough: the state is set once for all of a kind. */
static se3d_status eval_ahead(se3di_events *events, int node, double t)
{
    const uint32_t count = se3di_events_count(events);
    double *g = &events->g[node];
    if (count_kind(events, 0, count, 1) > 0) {
        SE3DI_TRY(set_rough(events, t));
        SE3DI_TRY(eval_kind(events, 0, count, 1, g, SE3DI_CROSSING_NODES));
    }
    if (count_kind(events, 0, count, 0) > 0) {
        SE3DI_TRY(set_exact(events, t));
        SE3DI_TRY(eval_kind(events, 0, count, 0, g, SE3DI_CROSSING_NODES));
    }
    return SE3D_OK;
}

/* The hits of the step of dense output that is ahead. */
static se3d_status look_ahead(se3di_events *events)
{
    const se3di_model *model = events->run->model;
    const double begin = model->history[SE3DI_HISTORY_BEGIN];
    const double end = model->history[SE3DI_HISTORY_TIME];
    if (events->looked && events->looked_stamp == model->history_stamp &&
        !(events->looked_time < end) && !(events->looked_time > end)) {
        return SE3D_OK;
    }
    events->looked = 0;
    SE3DI_TRY(eval_ahead(events, 0, begin));
    choose_nodes(events, begin, end);
    for (int node = 1; node < events->node_count; ++node) {
        SE3DI_TRY(eval_ahead(events, node, events->t[node]));
    }
    SE3DI_TRY(find_all_hits(events));
    events->looked = 1;
    return SE3D_OK;
}

void se3di_events_forget(se3di_events *events, double t)
{
    size_t *count = &events->record_count;
    while (*count > 0 && events->records[*count - 1].time > t) {
        --*count;
    }
    events->looked = 0;
    ++events->run->model->history_stamp;
}

se3d_status se3di_events_run(se3di_events *events, double t_end)
{
    se3di_run *run = events->run;
    const se3di_integrator *method = run->integration.method;
    const double *history = run->model->history;
    double t = run->model->time;
    events->dense = 1;
    events->reached = t;
    while (t < t_end) {
        if (!(history[SE3DI_HISTORY_TIME] > t)) {
            if (se3di_integration_must_leave(&run->integration)) {
                return method->run(&run->integration, t);
            }
            SE3DI_TRY(method->advance(&run->integration, t_end));
            if (run->integration.at_kink) {
                return method->run(&run->integration, t);
            }
        }
        const se3di_counters before = run->equations.counters;
        se3d_status status = look_ahead(events);
        status = status < 0 ? status : report(events, t, t_end);
        keep_counters(events, &before);
        if (status != SE3D_OK) {
            return status;
        }
        t = fmin(t_end, history[SE3DI_HISTORY_TIME]);
        events->reached = history[SE3DI_HISTORY_TIME] > t_end ? events->reached : t;
    }
    return se3di_run_show(run, t_end);
}

se3d_status se3di_events_begin_step(void *ctx)
{
    se3di_events *events = ctx;
    const se3di_model *model = events->run->model;
    if (se3di_events_count(events) == 0) {
        return SE3D_OK;
    }
    events->dense = 0;
    if (se3di_saved_fill(&events->from, model, &model->allocator) < 0) {
        return se3di_error_set(events->run->error, SE3D_ERR_NO_MEMORY, "no memory for events");
    }
    return eval_node(events, 0);
}

static se3d_status look_back(se3di_events *events)
{
    choose_nodes(events, events->from.time, events->to.time);
    SE3DI_TRY(eval_node(events, events->node_count - 1));
    for (int node = 1; node + 1 < events->node_count; ++node) {
        SE3DI_TRY(set_rough(events, events->t[node]));
        SE3DI_TRY(eval_node(events, node));
    }
    return find_all_hits(events);
}

se3d_status se3di_events_end_step(void *ctx)
{
    se3di_events *events = ctx;
    se3di_run *run = events->run;
    const se3di_model *model = run->model;
    if (se3di_events_count(events) == 0) {
        return SE3D_OK;
    }
    if (se3di_saved_fill(&events->to, model, &model->allocator) < 0) {
        return se3di_error_set(run->error, SE3D_ERR_NO_MEMORY, "no memory for events");
    }
    const se3di_counters before = run->equations.counters;
    ++run->guard.muted; /* the step is accepted: an end now would lose what happened in it */
    se3d_status status = look_back(events);
    status = status < 0 ? status : report(events, events->from.time, events->to.time);
    --run->guard.muted;
    keep_counters(events, &before);
    const int stays = status == SE3D_INFO_EVENT && (can_go_back(events) || events->goes_on);
    if (!stays) {
        SE3DI_TRY(go_back(events, &events->to));
    }
    return status;
}
