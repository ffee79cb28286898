/* SPDX-License-Identifier: BSD-3-Clause */
/* The events of a run: collected and written. */
#include "io/run/run_events.h"

#include <string.h>

#include "io/base/number.h"
#include "io/channel/event.h"

bool se3di_event_list_is_wanted(const se3d_model *model)
{
    bool moves = false, breaks = false;
    for (size_t k = 0; k < model->analysis_count; ++k) {
        moves = moves || se3di_analysis_has_motion(&model->analyses[k]);
    }
    for (size_t k = 0; k < model->element_count; ++k) {
        breaks = breaks || model->elements[k].break_channel;
    }
    return moves && (breaks || model->event_count > 0);
}

se3d_status se3di_event_list_open(se3di_event_list *events, se3di_iopool *pool, const char *path,
                                  const se3di_csv_mark *mark)
{
    static const char *const columns[] = {"time", "event", "channel", "value", "direction"};
    enum { COUNT = sizeof columns / sizeof *columns };
    const se3d_status status = mark ? se3di_csv_continue(&events->csv, pool, path, COUNT, mark)
                                    : se3di_csv_open(&events->csv, pool, path, COUNT);
    if (status < 0) {
        return status;
    }
    events->is_open = true;
    for (size_t k = 0; k < COUNT && !mark; ++k) {
        se3di_csv_put_name(&events->csv, columns[k], k + 1 == COUNT);
    }
    return SE3D_OK;
}

static void write_row(se3di_csv *csv, const se3d_run_event *event)
{
    char number[SE3DI_NUMBER_SIZE];
    number[se3di_number_format(event->time, number)] = '\0';
    se3di_csv_put_name(csv, number, false);
    se3di_csv_put_name(csv, event->name, false);
    se3di_csv_put_name(csv, event->channel, false);
    number[se3di_number_format(event->value, number)] = '\0';
    se3di_csv_put_name(csv, number, false);
    se3di_csv_put_name(csv, event->direction > 0 ? "rising" : "falling", true);
    ++csv->rows;
}

size_t se3di_run_event_count_kinds(const se3d_model *model)
{
    return model->event_count + model->element_count;
}

void se3di_run_event_set_kind(const se3d_model *model, size_t kind, se3d_run_event *event)
{
    if (kind < model->event_count) {
        event->name = model->events[kind].name;
        event->channel = model->events[kind].channel;
        return;
    }
    const se3di_element_entry *joint = &model->elements[kind - model->event_count];
    event->name = joint->name;
    event->channel = joint->break_channel ? joint->break_channel : joint->name;
}

size_t se3di_run_event_find_kind(const se3d_model *model, const char *name, bool broke)
{
    const size_t begin = broke ? model->event_count : 0;
    const size_t end = broke ? se3di_run_event_count_kinds(model) : model->event_count;
    size_t k = begin;
    while (k + 1 < end &&
           strcmp(broke ? model->elements[k - begin].name : model->events[k].name, name) != 0) {
        ++k;
    }
    return k;
}

se3d_status se3di_event_list_collect(se3di_event_list *events, se3di_iopool *pool,
                                     const se3d_model *model, se3d_solver *solver, size_t analysis)
{
    const size_t count = se3d_solver_count_event_records(solver);
    for (size_t k = events->collected; k < count; ++k) {
        se3d_event_record record;
        se3d_run_event *grown =
            se3di_iopool_grow(pool, events->list, events->count, &events->capacity, sizeof *grown);
        if (!grown) {
            return SE3D_ERR_NO_MEMORY;
        }
        events->list = grown;
        se3d_solver_get_event_record(solver, k, &record);
        const bool broke = record.joint.index1 != 0;
        events->list[events->count] = (se3d_run_event){.time = record.time,
                                                       .value = broke ? 1.0 : record.value,
                                                       .analysis = analysis,
                                                       .direction = record.direction,
                                                       .stopped = record.action == SE3D_EVENT_STOP};
        se3di_run_event_set_kind(model, se3di_run_event_find_kind(model, record.name, broke),
                                 &events->list[events->count]);
        write_row(&events->csv, &events->list[events->count++]);
        events->collected = k + 1;
    }
    return SE3D_OK;
}
