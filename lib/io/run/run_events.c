/* SPDX-License-Identifier: BSD-3-Clause */
/* The events of a run: collected and written. */
#include "io/run/run_events.h"

#include <string.h>

#include "io/base/number.h"
#include "io/channel/event.h"

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

/* The model's event of that name: every event of its solvers is one. */
static const se3di_event_entry *find(const se3d_model *model, const char *name)
{
    size_t k = 0;
    while (k + 1 < model->event_count && strcmp(model->events[k].name, name) != 0) {
        ++k;
    }
    return &model->events[k];
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
        const se3di_event_entry *entry = find(model, record.name);
        events->list[events->count] = (se3d_run_event){.name = entry->name,
                                                       .channel = entry->channel,
                                                       .time = record.time,
                                                       .value = record.value,
                                                       .analysis = analysis,
                                                       .direction = record.direction,
                                                       .stopped = record.action == SE3D_EVENT_STOP};
        write_row(&events->csv, &events->list[events->count++]);
        events->collected = k + 1;
    }
    return SE3D_OK;
}
