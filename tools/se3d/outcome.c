/* SPDX-License-Identifier: BSD-3-Clause */
/* Messages, files and colours. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#include <unistd.h>
#endif
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "outcome.h"
#include "text.h"

enum { MESSAGE_SIZE = 8192, FILES_MAX = 256, STDERR = 2 };

static struct {
    char message[MESSAGE_SIZE];
    char *files[FILES_MAX];
    size_t count; /* of files */
    size_t complaints;
    int wants_json, is_told;
} outcome;

/* https://no-color.org: any value that is not empty. */
static int has_colours(void)
{
#if defined(_WIN32)
    return 0; /* its consoles show the codes, unless they are told not to */
#else
    const char *never = getenv("NO_COLOR");
    const char *terminal = getenv("TERM");
    return isatty(STDERR) && !(never && *never) && terminal && *terminal &&
           strcmp(terminal, "dumb") != 0;
#endif
}

const char *colour_get(colour which)
{
    static const char *const codes[] = {"\033[0m", "\033[1;31m", "\033[1;35m", "\033[1;32m",
                                        "\033[1;36m"};
    return has_colours() ? codes[which] : "";
}

/* The length of what a message begins with: "se3d run", "car.yaml:3:7", 0: nothing. */
static size_t find_head(const char *text)
{
    const char *end = strstr(text, ": ");
    return end && memchr(text, '\n', (size_t)(end - text)) == NULL ? (size_t)(end - text) : 0;
}

static void put_line(const char *text, size_t length)
{
    for (size_t k = 0; k < length;) {
        const size_t size = se3d_text_get_character(text + k);
        fwrite(size > 0 ? text + k : "?", 1, size > 0 ? size : 1, stderr);
        k += size > 0 ? size : 1;
    }
}

static void put_lines(const char *text, colour head)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        const size_t first = find_head(text);
        fputs(first > 0 ? colour_get(head) : "", stderr);
        put_line(text, first);
        fputs(first > 0 ? colour_get(COLOUR_NONE) : "", stderr);
        put_line(text + first, length - first);
        text += length;
        if (*text) {
            fputc('\n', stderr);
            ++text;
        }
    }
}

void complain(const char *format, ...)
{
    char text[MESSAGE_SIZE];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    put_lines(text, COLOUR_ERROR);
    ++outcome.complaints;
    const size_t used = strlen(outcome.message);
    snprintf(outcome.message + used, sizeof outcome.message - used, "%s", text);
}

size_t outcome_count_complaints(void)
{
    return outcome.complaints;
}

void warn(const char *format, ...)
{
    char text[MESSAGE_SIZE];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    char *word = strstr(text, "warning: ");
    if (!word || !*colour_get(COLOUR_WARNING)) {
        put_lines(text, COLOUR_NONE);
        return;
    }
    put_line(text, (size_t)(word - text));
    put_lines(word, COLOUR_WARNING);
}

int outcome_add_file(const char *path, int quiet, const char *end)
{
    if (outcome.wants_json && outcome.count < FILES_MAX) {
        const size_t size = strlen(path) + 1;
        char *copy = malloc(size);
        if (copy) {
            memcpy(copy, path, size);
            outcome.files[outcome.count++] = copy;
        }
    }
    if (quiet || outcome.wants_json) {
        return 0;
    }
    fputs("wrote ", stdout);
    text_put_plain(stdout, path);
    fputs(end, stdout);
    return 1;
}

void outcome_want_json(void)
{
    outcome.wants_json = 1;
}

int outcome_wants_json(void)
{
    return outcome.wants_json;
}

void outcome_tell(void)
{
    outcome.is_told = 1;
}

void outcome_end(const char *command, int code)
{
    if (outcome.wants_json && !outcome.is_told) {
        printf("{\"status\": \"%s\", \"command\": ", code == EXIT_DONE            ? "done"
                                                     : outcome.message[0] == '\0' ? "failed"
                                                                                  : "error");
        text_put_json(stdout, command);
        const size_t length = strlen(outcome.message);
        if (length > 0 && outcome.message[length - 1] == '\n') {
            outcome.message[length - 1] = '\0';
        }
        fputs(", \"message\": ", stdout);
        text_put_json(stdout, outcome.message);
        fputs(", \"files\": [", stdout);
        for (size_t k = 0; k < outcome.count; ++k) {
            fputs(k > 0 ? ", " : "", stdout);
            text_put_json(stdout, outcome.files[k]);
        }
        fputs("]}\n", stdout);
    }
    for (size_t k = 0; k < outcome.count; ++k) {
        free(outcome.files[k]);
    }
    outcome.count = 0;
}
