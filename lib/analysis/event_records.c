/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of events that happened. */
#include "analysis/events.h"

#include "analysis/run.h"
#include "base/text.h"

void se3di_events_clear(se3di_events *events)
{
    for (size_t k = 0; k < events->name_count; ++k) {
        se3di_text_free(&events->run->model->allocator, events->names[k]);
    }
    events->name_count = events->record_count = 0;
}

se3d_status se3di_events_add_record(se3di_events *events, const se3d_event_record *record)
{
    void *records = events->records;
    const se3d_status status =
        se3di_array_reserve(&events->run->model->allocator, &records, &events->record_capacity,
                            events->record_count + 1, sizeof *events->records);
    events->records = records;
    if (status < 0) {
        return se3di_error_set(events->run->error, status, "no memory for an event");
    }
    events->records[events->record_count++] = *record;
    return SE3D_OK;
}
