/* SPDX-License-Identifier: BSD-3-Clause */
/* The list of commands, and what is found in their tables. */
#include "command.h"

#include <string.h>

const command_entry *command_get(size_t k)
{
    static const command_entry *const list[] = {
        &run_entry,   &check_entry, &evaluate_entry, &explain_entry, &channels_entry,
        &new_entry,   &fmt_entry,   &plot_entry,     &sketch_entry,  &view_entry,
        &live_entry,  &video_entry, &study_entry,    &report_entry,  &import_entry,
        &write_entry, &fmu_entry,   &replay_entry,   &help_entry,    &completion_entry,
    };
    return k < sizeof list / sizeof *list ? list[k] : NULL;
}

const command_entry *command_find(const char *name)
{
    for (size_t k = 0; command_get(k); ++k) {
        if (strcmp(command_get(k)->name, name) == 0) {
            return command_get(k);
        }
    }
    return NULL;
}

const command_option *command_find_option(const command_entry *c, const char *name)
{
    for (const command_option *o = c->options; o->name; ++o) {
        if (strcmp(o->name, name) == 0 || (o->alias && strcmp(o->alias, name) == 0)) {
            return o;
        }
    }
    return NULL;
}
