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

static const command_option common[] = {
    {"--quiet", "-q", NULL, "print nothing but errors, and what was asked for"},
    {"--json", NULL, NULL, "print the outcome as JSON: status, message, files"},
    {"--version", "-V", NULL, "print the version"},
    {"--help", "-h", NULL, "print this text"},
};

enum { COMMON = sizeof common / sizeof *common };

static int is_called(const command_option *o, const char *name)
{
    return strcmp(o->name, name) == 0 || (o->alias && strcmp(o->alias, name) == 0);
}

static const command_option *find_own(const command_entry *c, const char *name)
{
    for (const command_option *o = c->options; o->name; ++o) {
        if (is_called(o, name)) {
            return o;
        }
    }
    return NULL;
}

const command_option *command_find_common(const char *name)
{
    for (size_t k = 0; k < COMMON; ++k) {
        if (is_called(&common[k], name)) {
            return &common[k];
        }
    }
    return NULL;
}

/* One that all have, but not if the command has its own of that name. */
static int is_of(const command_entry *c, const command_option *o)
{
    return !find_own(c, o->name) && !(c->only_prints && strcmp(o->name, "--json") == 0);
}

const command_option *command_find_option(const command_entry *c, const char *name)
{
    const command_option *own = find_own(c, name), *other = command_find_common(name);
    return own ? own : other && is_of(c, other) ? other : NULL;
}

const command_option *command_get_option(const command_entry *c, size_t k)
{
    size_t passed = 0;
    while (c->options[passed].name) {
        if (passed == k) {
            return &c->options[k];
        }
        ++passed;
    }
    for (size_t n = 0; n < COMMON; ++n) {
        if (is_of(c, &common[n]) && passed++ == k) {
            return &common[n];
        }
    }
    return NULL;
}
