/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700

#include "live_loop.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "interrupt.h"
#include "live_text.h"
#include "live_watch.h"
#include "process.h"

#define PICTURE  (1.0 / 60.0) /* s between pictures */
#define BUDGET   0.05         /* s that the model may work for one */
#define STEP_MAX 3.0          /* s that it may work for a step before it is shown */
#define LAG_MAX  0.1          /* s of the clock that are made up for */
#define FAST     1.0          /* s that are asked for at once if it goes as fast as it can */
#define PATIENCE 0.5          /* s that a reading may take while other numbers wait */
#define LOOK     0.01         /* s between looks at files and words within a reading */
#define LOST     0.25         /* s between looks for a folder that has gone */

/* What is to be read, unless a file was saved. */
typedef enum reading { READ_NOTHING, READ_GOING_ON, READ_RESET, READ_ANEW } reading;

struct live_loop {
    se3d_model_options how;
    se3di_live *model;
    live_server *server;
    int watch;
    char *scene;   /* the text that the page has, without its version, */
    char *sliders; /* and the names in it */
    live_status status;
    double last; /* when the model went on [s of the clock] */
    double deadline;
    double until; /* the end of a step [s of the model]; NaN: none */
    reading wanted;
    int is_saved;   /* a file */
    int is_lost;    /* a folder that was watched has gone */
    int is_touched; /* something acts that did not when the numbers were taken */
    int is_new;     /* something is to be told */
    int is_stepping;
    /* of a reading */
    int is_reading, is_of_file, is_left;
    double begun, looked; /* [s of the clock] */
};

static double clock_now(void)
{
    struct timespec t = {0, 0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void look_at_files(live_loop *l);

/* Whether a reading has become useless: a file was saved, or other numbers have waited for long. */
static int is_useless(live_loop *l)
{
    static const char *const verbs[] = {"set", "reset", "anew", NULL};
    const double now = clock_now();
    if (now - l->looked < LOOK) {
        return 0;
    }
    l->looked = now;
    look_at_files(l);
    return l->is_saved ||
           (!l->is_of_file && now - l->begun > PATIENCE && live_server_has_words(l->server, verbs));
}

static int is_over(void *ctx)
{
    live_loop *l = ctx;
    if (l->is_reading) {
        l->is_left = l->is_left || interrupt_came() || is_useless(l);
        return l->is_left;
    }
    return interrupt_came() || clock_now() > l->deadline ||
           (l->is_stepping && live_server_has_words(l->server, NULL));
}

/* Tell the page where all is. */
static void publish(live_loop *l)
{
    size_t size = 0;
    ++l->status.sequence;
    char *data = live_text_of_state(l->model, &l->status, &size);
    if (data) {
        live_server_set_state(l->server, data, size, l->status.sequence);
    }
    l->is_new = 0;
}

/* Files that a reading has found mistakes in: "FILE:LINE:COLUMN: ..." in every line. */
static void watch_wrong_files(const live_loop *l)
{
    char path[SE3DI_LIVE_MESSAGE_SIZE];
    for (const char *line = l->status.file_trouble; *line;) {
        const size_t length = strcspn(line, "\n");
        size_t end = 0;
        while (end + 1 < length && !(line[end] == ':' && strchr("123456789", line[end + 1]))) {
            ++end;
        }
        if (end > 0 && end + 1 < length) {
            memcpy(path, line, end);
            path[end] = '\0';
            (void)live_watch_add(l->watch, path);
        }
        line += length + (line[length] == '\n');
    }
}

/* @return false: errno says why some folder cannot be watched. */
static int watch_files(const live_loop *l)
{
    int good = 1;
    for (size_t k = 0; se3di_live_get_file(l->model, k); ++k) {
        good = live_watch_add(l->watch, se3di_live_get_file(l->model, k)) && good;
    }
    watch_wrong_files(l);
    return good;
}

/* The names of the sliders have a version of their own: it stays while their numbers change. */
static int show_sliders(live_loop *l)
{
    char *names = live_text_of_sliders(l->model);
    if (names && !(l->sliders && strcmp(names, l->sliders) == 0)) {
        ++l->status.list;
        free(l->sliders);
        l->sliders = names;
        return 1;
    }
    free(names);
    return names != NULL;
}

/* After the model was read: another scene is another version. @return false: out of memory. */
static int show_scene(live_loop *l)
{
    char *scene = show_sliders(l) ? live_text_of_scene(l->model) : NULL;
    if (!scene || (l->scene && strcmp(scene, l->scene) == 0)) {
        const int same = scene != NULL;
        free(scene);
        return same;
    }
    const size_t room = strlen(scene) + 100;
    char *text = malloc(room);
    if (!text) {
        free(scene);
        return 0;
    }
    const int size = snprintf(text, room, "{\"version\":%llu,\"list\":%llu,%s",
                              (unsigned long long)(l->status.version + 1),
                              (unsigned long long)l->status.list, scene);
    ++l->status.version;
    free(l->scene);
    l->scene = scene;
    live_server_set_scene(l->server, text, (size_t)size);
    return 1;
}

/* ---- the model ------------------------------------------------------------------------------*/

/* Numbers that a model cannot be made with are not those of the file. */
static void tell_failure(live_loop *l, se3di_live_beginning beginning, const char *why)
{
    if (beginning != SE3DI_LIVE_GOING_ON) {
        snprintf(l->status.file_trouble, sizeof l->status.file_trouble, "%s", why);
        watch_wrong_files(l);
        return;
    }
    se3di_live_take_back(l->model);
    if (strcmp(why, l->status.file_trouble) != 0) {
        snprintf(l->status.run_trouble, sizeof l->status.run_trouble, "%s", why);
    }
}

/* @return false: it was left before its end. */
static int read_again(live_loop *l, se3di_live_beginning beginning)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    const uint64_t before = se3di_live_count_readings(l->model);
    l->is_reading = 1;
    l->is_left = 0;
    l->is_of_file = beginning == SE3DI_LIVE_CHANGED;
    l->begun = l->looked = clock_now();
    const int good = se3di_live_read(l->model, beginning, why);
    l->is_reading = 0;
    if (!good && l->is_left) {
        return 0;
    }
    l->is_new = 1;
    l->is_touched = 0;
    if (!good) {
        tell_failure(l, beginning, why);
        return 1;
    }
    l->status.file_trouble[0] = '\0';
    if (se3di_live_count_readings(l->model) == before) {
        return 1;
    }
    snprintf(l->status.run_trouble, sizeof l->status.run_trouble, "%s",
             show_scene(l) ? why : "out of memory");
    l->status.running = l->status.running && se3di_live_has_motion(l->model);
    l->until = (double)NAN;
    l->is_lost = !watch_files(l) && l->watch >= 0;
    return 1;
}

static int has_ending(const char *name, const char *ending)
{
    const size_t length = strlen(name);
    const size_t end = strlen(ending);
    return length > end && strcmp(name + length - end, ending) == 0;
}

/* A file of the model, or one that may become one. */
static int is_of_model(void *ctx, const char *name)
{
    const live_loop *l = ctx;
    if (has_ending(name, ".yaml") || has_ending(name, ".yml") || has_ending(name, ".json")) {
        return 1;
    }
    for (size_t k = 0; se3di_live_get_file(l->model, k); ++k) {
        if (strcmp(path_get_name(se3di_live_get_file(l->model, k)), name) == 0) {
            return 1;
        }
    }
    return strstr(l->status.file_trouble, name) != NULL;
}

static void look_at_files(live_loop *l)
{
    const unsigned found = live_watch_take(l->watch, is_of_model, l);
    l->is_saved = l->is_saved || (found & LIVE_WATCH_SAVED);
    l->is_lost = l->is_lost || (found & LIVE_WATCH_LOST);
    if (l->is_lost && watch_files(l)) { /* it is back, maybe with other files */
        l->is_lost = 0;
        l->is_saved = 1;
    }
}

/* If a file was saved and the model is another one now, it begins anew. */
static void read_what_is_due(live_loop *l)
{
    static const se3di_live_beginning beginnings[] = {
        [READ_GOING_ON] = SE3DI_LIVE_GOING_ON,
        [READ_RESET] = SE3DI_LIVE_RESET,
        [READ_ANEW] = SE3DI_LIVE_ANEW,
    };
    if (l->is_saved) {
        const uint64_t before = se3di_live_count_readings(l->model);
        l->is_saved = 0;
        if (!read_again(l, SE3DI_LIVE_CHANGED)) {
            l->is_saved = 1;
            return;
        }
        if (se3di_live_count_readings(l->model) != before) {
            l->wanted = READ_NOTHING;
        }
    }
    if (l->wanted != READ_NOTHING && read_again(l, beginnings[l->wanted])) {
        l->wanted = READ_NOTHING;
    }
}

static void stop(live_loop *l, const char *why)
{
    l->status.running = 0;
    l->until = (double)NAN;
    snprintf(l->status.run_trouble, sizeof l->status.run_trouble, "%s", why);
}

/* Go to a time of the model, as far as it comes within so long. */
static void advance(live_loop *l, double until, double budget)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    l->deadline = clock_now() + budget;
    if (!se3di_live_run(l->model, until, why)) {
        stop(l, why);
    }
    l->is_new = 1;
    l->is_touched = 0;
}

/* Steps end where words come: these are obeyed first. */
static void go_step(live_loop *l)
{
    l->is_stepping = 1;
    advance(l, l->until, STEP_MAX);
    l->is_stepping = 0;
    if (se3di_live_get_time(l->model) >= l->until) {
        l->until = (double)NAN;
    }
}

static void go_on(live_loop *l)
{
    const double now = clock_now();
    const double passed = fmin(now - l->last, LAG_MAX);
    l->last = now;
    if (l->status.speed > 0.0) {
        advance(l, se3di_live_get_time(l->model) + passed * l->status.speed, BUDGET);
        return;
    }
    do {
        advance(l, se3di_live_get_time(l->model) + FAST, now + PICTURE - clock_now());
    } while (l->status.running && clock_now() < now + PICTURE && !interrupt_came());
}

/* ---- what the user wants --------------------------------------------------------------------*/

enum { NUMBERS_MAX = 8 };

/* Words of the page: a verb and numbers. */
typedef struct order {
    char verb[16];
    double numbers[NUMBERS_MAX];
    size_t count;
} order;

/* @return false: this is no order. */
static int read_order(const char *words, order *o)
{
    const size_t length = strcspn(words, " ");
    if (length == 0 || length >= sizeof o->verb) {
        return 0;
    }
    memcpy(o->verb, words, length);
    o->verb[length] = '\0';
    o->count = 0;
    for (const char *at = words + length; *at;) {
        char *end = NULL;
        const double value = strtod(at + 1, &end);
        if (*at != ' ' || o->count == NUMBERS_MAX || end == at + 1 || !isfinite(value)) {
            return 0;
        }
        o->numbers[o->count++] = value;
        at = end;
    }
    return 1;
}

/* A number as the place in a list; a large one if it is none. */
static size_t as_index(double value)
{
    return value >= 0.0 && value < 1e6 && !(floor(value) < value) ? (size_t)value : SIZE_MAX;
}

static void want(live_loop *l, reading what)
{
    l->wanted = what > l->wanted ? what : l->wanted;
}

static void do_run(live_loop *l, const order *o)
{
    (void)o;
    if (se3di_live_has_motion(l->model)) {
        l->status.running = 1;
        l->status.run_trouble[0] = '\0';
        l->until = (double)NAN;
        l->last = clock_now();
    }
}

static void do_pause(live_loop *l, const order *o)
{
    (void)o;
    l->status.running = 0;
    l->until = (double)NAN;
}

/* Steps that wait are one that is longer. */
static void do_step(live_loop *l, const order *o)
{
    const double from = isnan(l->until) ? se3di_live_get_time(l->model) : l->until;
    (void)o;
    l->status.running = 0;
    l->status.run_trouble[0] = '\0';
    l->until = from + PICTURE * (l->status.speed > 0.0 ? l->status.speed : 1.0);
}

static void do_reset(live_loop *l, const order *o)
{
    (void)o;
    l->until = (double)NAN;
    want(l, READ_RESET);
}

static void do_anew(live_loop *l, const order *o)
{
    (void)o;
    l->until = (double)NAN;
    want(l, READ_ANEW);
}

static void do_speed(live_loop *l, const order *o)
{
    if (!(o->numbers[0] < 0.0) && !(o->numbers[0] > 1000.0)) {
        l->status.speed = o->numbers[0];
    }
}

/* The first number of an order that names something: the version that it means. */
static int is_version(const order *o, uint64_t version)
{
    return fabs(o->numbers[0] - (double)version) < 0.5;
}

static void do_set(live_loop *l, const order *o)
{
    const size_t k = as_index(o->numbers[1]);
    if (!is_version(o, l->status.list) || !se3di_live_set(l->model, k, o->numbers[2])) {
        return;
    }
    if (se3di_live_get_slider(l->model, k)->is_parameter || !se3di_live_has_motion(l->model)) {
        want(l, READ_GOING_ON);
    } else {
        l->is_touched = 1;
    }
}

static void do_pull(live_loop *l, const order *o)
{
    if (is_version(o, l->status.version) &&
        se3di_live_pull(l->model, as_index(o->numbers[1]), o->numbers + 2, o->numbers + 5)) {
        l->is_touched = 1;
    }
}

static void do_release(live_loop *l, const order *o)
{
    (void)o;
    l->is_touched = se3di_live_release(l->model) || l->is_touched;
}

static void obey(live_loop *l, const char *words)
{
    static const struct {
        const char *verb;
        size_t count; /* of numbers */
        void (*act)(live_loop *l, const order *o);
    } orders[] = {{"run", 0, do_run},     {"pause", 0, do_pause}, {"step", 0, do_step},
                  {"reset", 0, do_reset}, {"anew", 0, do_anew},   {"release", 0, do_release},
                  {"speed", 1, do_speed}, {"set", 3, do_set},     {"pull", 8, do_pull}};
    order o;
    if (!read_order(words, &o)) {
        return;
    }
    for (size_t k = 0; k < sizeof orders / sizeof *orders; ++k) {
        if (strcmp(orders[k].verb, o.verb) == 0 && orders[k].count == o.count) {
            orders[k].act(l, &o);
            l->is_new = 1;
        }
    }
}

/* What has changed while the model stands acts from now on: forces and accelerations follow. */
static void settle(live_loop *l)
{
    if (l->is_touched && se3di_live_has_motion(l->model)) {
        advance(l, se3di_live_get_time(l->model), STEP_MAX);
    }
    l->is_touched = 0;
}

double live_loop_turn(live_loop *l)
{
    char words[LIVE_WORDS_SIZE];
    const double begin = clock_now();
    while (l->wanted < READ_RESET && live_server_take(l->server, words)) {
        obey(l, words); /* what comes behind a reset is meant for what that reads */
    }
    look_at_files(l);
    read_what_is_due(l);
    const int is_watched = live_server_is_watched(l->server);
    const int moves = l->status.running && is_watched;
    if (!is_watched) {
        (void)se3di_live_release(l->model);
    }
    if (!isnan(l->until) && se3di_live_has_motion(l->model)) {
        go_step(l);
    } else if (moves) {
        go_on(l);
    } else {
        settle(l);
    }
    if (l->is_new) {
        publish(l);
    }
    if (l->wanted != READ_NOTHING || l->is_saved || !isnan(l->until)) {
        return 0.0;
    }
    return moves ? fmax(begin + PICTURE - clock_now(), 0.0) : l->is_lost ? LOST : -1.0;
}

/* ---- beginning and end ----------------------------------------------------------------------*/

live_loop *live_loop_create(const char *path, const se3d_model_options *how,
                            char message[SE3DI_LIVE_MESSAGE_SIZE])
{
    live_loop *l = calloc(1, sizeof *l);
    if (!l) {
        snprintf(message, SE3DI_LIVE_MESSAGE_SIZE, "out of memory");
        return NULL;
    }
    l->how = *how;
    l->watch = -1;
    l->status.speed = 1.0;
    l->deadline = HUGE_VAL;
    l->until = (double)NAN;
    l->model = se3di_live_create(path, &l->how, is_over, l, message);
    if (!l->model) {
        free(l);
        return NULL;
    }
    return l;
}

void live_loop_destroy(live_loop *l)
{
    if (l) {
        se3di_live_destroy(l->model);
        free(l->scene);
        free(l->sliders);
        free(l);
    }
}

int live_loop_watch(live_loop *l, int watch)
{
    l->watch = watch;
    return watch < 0 || watch_files(l);
}

int live_loop_begin(live_loop *l, live_server *server)
{
    l->server = server;
    l->status.running = se3di_live_has_motion(l->model);
    l->last = clock_now();
    if (!show_scene(l)) {
        return 0;
    }
    publish(l);
    return 1;
}
