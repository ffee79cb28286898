/* SPDX-License-Identifier: BSD-3-Clause */
/* `se3d replay`: make the calls of a recording again. docs/recording.md */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "options.h"
#include "outcome.h"

#if defined(SE3D_HAS_RECORD)
#include "player.h"

static unsigned char *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    unsigned char *data = NULL;
    size_t capacity = 0;
    *size = 0;
    while (file && !feof(file) && !ferror(file)) {
        if (*size == capacity) {
            unsigned char *more = realloc(data, 2 * capacity + 65536);
            if (!more) {
                break;
            }
            data = more;
            capacity = 2 * capacity + 65536;
        }
        *size += fread(data + *size, 1, capacity - *size, file);
    }
    if (!file || !feof(file) || ferror(file)) {
        free(data);
        data = NULL;
    }
    if (file) {
        fclose(file);
    }
    return data;
}

static void print_call(void *ctx, size_t number, const char *name, int is_after, int status)
{
    (void)ctx;
    if (!is_after) {
        printf("%zu %s\n", number, name);
    } else if (status != 0) {
        printf("%zu %s: %d, %s\n", number, name, status, se3d_status_get_text((se3d_status)status));
    }
    fflush(stdout); /* it may be the last word */
}

static void print_report(const options *o, player_verdict verdict, const player_report *report)
{
    if (verdict != PLAYER_SAME && report->name) {
        complain("se3d replay: %s: call %zu, %s: %s\n", o->model, report->number, report->name,
                 report->message);
    } else if (verdict != PLAYER_SAME) {
        complain("se3d replay: %s: %s\n", o->model, report->message);
    } else if (!o->quiet && !o->json) {
        put_count(report->calls - report->left_out, "call", "calls", ", ");
        put_count(report->callbacks, "callback", "callbacks", ", ");
        put_count(report->hashes, "hash", "hashes",
                  o->unchecked ? " compared; nothing else was\n" : ": all as recorded\n");
        if (report->left_out > 0) {
            put_count(report->left_out, "call", "calls", " left out, whose objects are missing\n");
        }
        if (report->ends_within) {
            printf("the recording ends within call %zu, %s, which has returned now\n",
                   report->calls, report->name ? report->name : "none");
        }
    }
}

static int replay(const options *o)
{
    const player_options how = {.is_free = o->unchecked, .told = o->list ? print_call : NULL};
    player_report report;
    size_t size;
    unsigned char *data = read_whole(o->model, &size);
    if (!data) {
        complain("se3d replay: %s: %s\n", o->model, strerror(errno ? errno : ENOMEM));
        return EXIT_USAGE;
    }
    const player_verdict verdict = player_play(data, size, &how, &report);
    free(data);
    print_report(o, verdict, &report);
    return verdict == PLAYER_SAME      ? EXIT_DONE
           : verdict == PLAYER_DIFFERS ? EXIT_FAILED
                                       : EXIT_USAGE;
}
#else
static int replay(const options *o)
{
    (void)o;
    complain("se3d replay: this program was built without recordings (Linux, python3)\n");
    return EXIT_USAGE;
}
#endif

static int command_replay(int count, char *const *words)
{
    options o;
    const int code = options_read(&o, &replay_entry, count, words);
    if (code == EXIT_DONE && !o.help && o.list && o.json) {
        return options_refuse_both(&replay_entry, "--list");
    }
    return code != EXIT_DONE || o.help ? code : replay(&o);
}

const command_entry replay_entry = {
    .name = "replay",
    .run = command_replay,
    .operands = "FILE",
    .files = "se3drec",
    .summary = "make the calls of a recording again and compare",
    .text = "Makes every call of libse3d again that a program made while it was recorded, with "
            "the same arguments, and compares statuses, results and outputs. Callbacks answer as "
            "they did. The first call that differs is named.\n\n"
            "A program is recorded by SE3D_RECORD=FILE LD_PRELOAD=libse3d-record.so PROGRAM, "
            "or by se3d_record_begin of that library.",
    .options =
        (const command_option[]){{"--list", NULL, NULL, "print every call before it is made"},
                                 {"--unchecked", NULL, NULL,
                                  "compare nothing, and leave out calls whose objects are "
                                  "missing: for recordings of which calls were taken away"},
                                 {0}},
    .examples = (const command_example[]){{"replay bug.se3drec", "whether it happens here, too"},
                                          {"replay --list bug.se3drec", "its calls"},
                                          {0}},
    .exits = "0 done, all as recorded; 1 a call differs; 2 bad usage or recording.",
};
