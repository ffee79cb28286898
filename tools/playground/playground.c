/* SPDX-License-Identifier: BSD-3-Clause */
/* What the loop has of the operating system is played here: the server (live_server.h) by texts
 * that wait to be taken, files that are saved (live_watch.h) by a flag; there are no interrupts. */
#include "playground.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interrupt.h"
#include "live_loop.h"
#include "live_server.h"
#include "live_watch.h"

enum { WORDS_MAX = 64 };

struct live_server {
    char *scene, *state; /* NULL: none since it was taken */
    char words[WORDS_MAX][LIVE_WORDS_SIZE];
    size_t first, count; /* of the words that wait */
    int is_watched;
};

/* What the page plays with: one of each, as a page has one worker. */
static live_server page = {.is_watched = 1};
static live_loop *model;
static int is_saved;
static char message[SE3DI_LIVE_MESSAGE_SIZE];
static char *taken;

/* ---- what the loop talks to -----------------------------------------------------------------*/

static void replace(char **text, char *with)
{
    free(*text);
    *text = with;
}

void live_server_set_scene(live_server *server, char *text, size_t size)
{
    (void)size;
    replace(&server->scene, text);
}

void live_server_set_state(live_server *server, char *text, size_t size, uint64_t sequence)
{
    (void)size;
    (void)sequence;
    replace(&server->state, text);
}

int live_server_take(live_server *server, char words[LIVE_WORDS_SIZE])
{
    if (server->count == 0) {
        return 0;
    }
    memcpy(words, server->words[server->first], LIVE_WORDS_SIZE);
    server->first = (server->first + 1) % WORDS_MAX;
    --server->count;
    return 1;
}

/* Nothing comes while the worker works. */
int live_server_has_words(live_server *server, const char *const *verbs)
{
    return !verbs && server->count > 0;
}

int live_server_is_watched(live_server *server)
{
    return server->is_watched;
}

int live_watch_add(int watch, const char *path)
{
    (void)watch;
    (void)path;
    return 1;
}

unsigned live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    const unsigned found = is_saved ? LIVE_WATCH_SAVED : 0;
    (void)watch;
    (void)is_meant;
    (void)ctx;
    is_saved = 0;
    return found;
}

int interrupt_came(void)
{
    return 0;
}

/* ---- what the worker calls ------------------------------------------------------------------*/

const char *se3d_play_open(const char *path)
{
    const se3d_model_options how = {.struct_size = sizeof how};
    message[0] = '\0';
    live_loop_destroy(model);
    model = live_loop_create(path, &how, message);
    if (model && !(live_loop_watch(model, 1) && live_loop_begin(model, &page))) {
        live_loop_destroy(model);
        model = NULL;
        snprintf(message, sizeof message, "out of memory, or the model cannot be drawn");
    }
    return message;
}

void se3d_play_save(void)
{
    is_saved = 1;
}

void se3d_play_watch(int is_watched)
{
    page.is_watched = is_watched;
}

int se3d_play_say(const char *words)
{
    const size_t length = strlen(words);
    if (page.count == WORDS_MAX || length >= LIVE_WORDS_SIZE) {
        return 0;
    }
    memcpy(page.words[(page.first + page.count) % WORDS_MAX], words, length + 1);
    ++page.count;
    return 1;
}

double se3d_play_turn(void)
{
    return model ? live_loop_turn(model) : -1.0;
}

static const char *take(char **text)
{
    replace(&taken, *text);
    *text = NULL;
    return taken ? taken : "";
}

const char *se3d_play_take_scene(void)
{
    return take(&page.scene);
}

const char *se3d_play_take_state(void)
{
    return take(&page.state);
}
