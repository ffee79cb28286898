/* SPDX-License-Identifier: BSD-3-Clause */
/* A page in headless Chromium. */
#include "devtools.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "process.h"

enum { ANSWER_SECONDS = 120, MESSAGE_MAX = 1 << 28 };

const char *devtools_find_chromium(void)
{
    static const char *const names[] = {"chromium", "chromium-browser", "google-chrome",
                                        "google-chrome-stable"};
    const char *given = getenv("SE3D_CHROMIUM");
    if (given && given[0]) {
        return process_is_found(given) ? given : NULL;
    }
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        if (process_is_found(names[k])) {
            return names[k];
        }
    }
    return NULL;
}

/* Bring the next message to the head of the buffer. @return NULL: none came. */
static char *read_message(devtools *d)
{
    memmove(d->buffer, d->buffer + d->message, d->used - d->message);
    d->used -= d->message;
    d->message = 0;
    for (size_t looked = 0;;) {
        const char *end = memchr(d->buffer + looked, '\0', d->used - looked);
        if (end) {
            d->message = (size_t)(end - d->buffer) + 1;
            return d->buffer;
        }
        looked = d->used;
        if (d->used == d->capacity) {
            char *grown = d->capacity < MESSAGE_MAX ? realloc(d->buffer, 2 * d->capacity) : NULL;
            if (!grown) {
                return NULL;
            }
            d->buffer = grown;
            d->capacity *= 2;
        }
        const size_t count =
            child_read(&d->chromium, d->buffer + d->used, d->capacity - d->used, ANSWER_SECONDS);
        if (count == 0) {
            return NULL;
        }
        d->used += count;
    }
}

/* Send a command with its parameters (a JSON object) and wait for the answer. */
static char *call(devtools *d, const char *method, const char *parameters)
{
    char head[300];
    char mark[40];
    const unsigned number = ++d->number;
    int length = snprintf(
        head, sizeof head, "{\"id\":%u,\"method\":\"%s\",%s%s%s\"params\":", number, method,
        d->session[0] ? "\"sessionId\":\"" : "", d->session, d->session[0] ? "\"," : "");
    if (length < 0 || !child_write(&d->chromium, head, (size_t)length) ||
        !child_write(&d->chromium, parameters, strlen(parameters)) ||
        !child_write(&d->chromium, "}", 2)) {
        return NULL;
    }
    length = snprintf(mark, sizeof mark, "{\"id\":%u,", number);
    for (char *message = read_message(d); message; message = read_message(d)) {
        if (strncmp(message, mark, (size_t)length) == 0) {
            return strstr(message, "\"error\":{") == message + length ? NULL : message;
        }
    }
    return NULL;
}

/* The text after `key` (with its colon) up to the next quote; ended in place. */
static char *cut_text(char *message, const char *key)
{
    char *found = message ? strstr(message, key) : NULL;
    char *text = found ? found + strlen(key) : NULL;
    char *end = text && *text == '"' ? strchr(text + 1, '"') : NULL;
    if (!end) {
        return NULL;
    }
    *end = '\0';
    return text + 1;
}

char *devtools_evaluate(devtools *d, const char *expression)
{
    char parameters[1024];
    snprintf(parameters, sizeof parameters, "{\"expression\":\"%.900s\",\"returnByValue\":true}",
             expression);
    return cut_text(call(d, "Runtime.evaluate", parameters), "\"value\":");
}

/* A file's address: bytes that mean something there are written as %xx. */
static void make_address(const char *path, char *address, size_t size)
{
    size_t used = (size_t)snprintf(address, size, "file://");
    for (const char *c = path; *c && used + 4 < size; ++c) {
        const int plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                          (*c >= '0' && *c <= '9') || strchr("/-_.", *c) != NULL;
        used += (size_t)snprintf(address + used, size - used, plain ? "%c" : "%%%02X",
                                 (unsigned)(unsigned char)*c);
    }
}

static int attach(devtools *d, const char *page)
{
    char address[3 * 4096 + 8];
    char parameters[3 * 4096 + 64];
    make_address(page, address, sizeof address);
    snprintf(parameters, sizeof parameters, "{\"url\":\"%s\"}", address);
    const char *target = cut_text(call(d, "Target.createTarget", parameters), "\"targetId\":");
    if (!target) {
        return 0;
    }
    snprintf(parameters, sizeof parameters, "{\"targetId\":\"%.80s\",\"flatten\":true}", target);
    const char *session = cut_text(call(d, "Target.attachToTarget", parameters), "\"sessionId\":");
    if (session) {
        snprintf(d->session, sizeof d->session, "%s", session);
    }
    return session != NULL;
}

int devtools_open(devtools *d, const char *program, const char *folder, const char *page)
{
    char profile[4200];
    char temporary[4200];
    snprintf(temporary, sizeof temporary, "TMPDIR=%.4000s", folder);
    snprintf(profile, sizeof profile, "--user-data-dir=%.4000s/profile", folder);
    /* The page is ours and opens nothing: it needs no sandbox, which containers often refuse. */
    const char *const words[] = {"env",
                                 temporary, /* what it leaves goes with the folder */
                                 program,
                                 "--headless",
                                 "--no-sandbox",
                                 "--disable-gpu",
                                 "--enable-unsafe-swiftshader",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-sync",
                                 "--disable-breakpad",
                                 "--disable-dev-shm-usage",
                                 "--remote-debugging-pipe",
                                 profile,
                                 "about:blank",
                                 NULL};
    memset(d, 0, sizeof *d);
    d->capacity = 1 << 20;
    d->buffer = malloc(d->capacity);
    return d->buffer && child_start(&d->chromium, words, 3, 4, 1) && attach(d, page);
}

void devtools_close(devtools *d)
{
    static const char bye[] = "{\"id\":0,\"method\":\"Browser.close\"}";
    if (d->chromium.id != 0) {
        child_write(&d->chromium, bye, sizeof bye);
        child_finish(&d->chromium, 5);
    }
    free(d->buffer);
    d->buffer = NULL;
}
