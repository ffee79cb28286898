/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d live MODEL: a page on this machine in which the model runs. This thread runs the model; that
 * of the server (live_server.c) answers the page with the texts that it is given here. */
#define _XOPEN_SOURCE 700

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"

#if defined(SE3D_HAS_MICROHTTPD)

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

#include "interrupt.h"
#include "io/live/live.h"
#include "live_server.h"
#include "live_text.h"
#include "live_watch.h"
#include "page.h"
#include "process.h"

#define PICTURE (1.0 / 60.0) /* s between pictures */
#define BUDGET  0.05         /* s that the model may work for one */
#define LAG_MAX 0.1          /* s of the clock that are made up for */
#define FAST    1.0          /* s that are asked for at once if it goes as fast as it can */

typedef struct live {
    se3d_model_options how;
    se3di_live *model;
    live_server *server;
    int watch;
    int wake[2];
    sigset_t awake; /* the signals that are let in while this thread waits */
    char *scene;    /* the text that the page has, without its version */
    live_status status;
    double last; /* when the model went on [s of the clock] */
    double deadline;
    int is_stale; /* a parameter was set */
    int is_new;   /* something is to be told */
} live;

static double clock_now(void)
{
    struct timespec t = {0, 0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int is_over(void *ctx)
{
    const live *l = ctx;
    return interrupt_came() || clock_now() > l->deadline;
}

/* Tell the page where all is. */
static void publish(live *l)
{
    size_t size = 0;
    ++l->status.sequence;
    char *data = live_text_of_state(l->model, &l->status, &size);
    if (data) {
        live_server_set_state(l->server, data, size, l->status.sequence);
    }
    l->is_new = 0;
}

static void watch_files(const live *l)
{
    for (size_t k = 0; se3di_live_get_file(l->model, k); ++k) {
        live_watch_add(l->watch, se3di_live_get_file(l->model, k));
    }
}

/* After the model was read: another scene is another version. @return false: out of memory. */
static int show_scene(live *l)
{
    char *scene = live_text_of_scene(l->model);
    if (!scene || (l->scene && strcmp(scene, l->scene) == 0)) {
        const int same = scene != NULL;
        free(scene);
        return same;
    }
    const size_t room = strlen(scene) + 60;
    char *text = malloc(room);
    if (!text) {
        free(scene);
        return 0;
    }
    const int size = snprintf(text, room, "{\"version\":%llu,%s",
                              (unsigned long long)(l->status.version + 1), scene);
    ++l->status.version;
    free(l->scene);
    l->scene = scene;
    live_server_set_scene(l->server, text, (size_t)size);
    return 1;
}

/* ---- the model ------------------------------------------------------------------------------*/

static void read_again(live *l, se3di_live_beginning beginning)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    l->deadline = HUGE_VAL;
    l->is_new = 1;
    l->is_stale = 0;
    if (!se3di_live_read(l->model, beginning, why)) {
        memcpy(l->status.trouble, why, sizeof why);
        return;
    }
    snprintf(l->status.trouble, sizeof l->status.trouble, "%s",
             show_scene(l) ? "" : "out of memory");
    l->status.running = l->status.running && se3di_live_has_motion(l->model);
    watch_files(l);
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
    const live *l = ctx;
    if (has_ending(name, ".yaml") || has_ending(name, ".yml") || has_ending(name, ".json")) {
        return 1;
    }
    for (size_t k = 0; se3di_live_get_file(l->model, k); ++k) {
        if (strcmp(path_get_name(se3di_live_get_file(l->model, k)), name) == 0) {
            return 1;
        }
    }
    return 0;
}

/* A file was saved: if the model is another one now, it begins anew. */
static void look_at_files(live *l)
{
    if (live_watch_take(l->watch, is_of_model, l)) {
        read_again(l, SE3DI_LIVE_CHANGED);
    }
}

static void stop(live *l, const char *why)
{
    l->status.running = 0;
    snprintf(l->status.trouble, sizeof l->status.trouble, "%s", why);
}

/* Let so much time pass in the model, as far as it comes within its budget. */
static void advance(live *l, double time, double budget)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    l->deadline = clock_now() + budget;
    if (!se3di_live_run(l->model, se3di_live_get_time(l->model) + time, why)) {
        stop(l, why);
    }
    l->is_new = 1;
}

static void go_on(live *l)
{
    const double now = clock_now();
    const double passed = fmin(now - l->last, LAG_MAX);
    l->last = now;
    if (l->status.speed > 0.0) {
        advance(l, passed * l->status.speed, BUDGET);
    } else {
        advance(l, FAST, PICTURE);
    }
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

static void do_run(live *l, const order *o)
{
    (void)o;
    if (se3di_live_has_motion(l->model)) {
        l->status.running = 1;
        l->status.trouble[0] = '\0';
        l->last = clock_now();
    }
}

static void do_pause(live *l, const order *o)
{
    (void)o;
    l->status.running = 0;
}

static void do_step(live *l, const order *o)
{
    (void)o;
    l->status.running = 0;
    l->status.trouble[0] = '\0';
    advance(l, PICTURE * (l->status.speed > 0.0 ? l->status.speed : 1.0), 60.0 * BUDGET);
}

static void do_reset(live *l, const order *o)
{
    (void)o;
    read_again(l, SE3DI_LIVE_RESET);
}

static void do_anew(live *l, const order *o)
{
    (void)o;
    read_again(l, SE3DI_LIVE_ANEW);
}

static void do_speed(live *l, const order *o)
{
    if (!(o->numbers[0] < 0.0) && !(o->numbers[0] > 1000.0)) {
        l->status.speed = o->numbers[0];
    }
}

/* The first number of an order that names something: the version that it means. */
static int is_of_now(const live *l, const order *o)
{
    return fabs(o->numbers[0] - (double)l->status.version) < 0.5;
}

static void do_set(live *l, const order *o)
{
    const size_t k = as_index(o->numbers[1]);
    if (is_of_now(l, o) && se3di_live_set(l->model, k, o->numbers[2])) {
        l->is_stale = l->is_stale || se3di_live_get_slider(l->model, k)->is_parameter;
    }
}

static void do_pull(live *l, const order *o)
{
    if (is_of_now(l, o)) {
        (void)se3di_live_pull(l->model, as_index(o->numbers[1]), o->numbers + 2, o->numbers + 5);
    }
}

static void do_release(live *l, const order *o)
{
    (void)o;
    se3di_live_release(l->model);
}

static void obey(live *l, const char *words)
{
    static const struct {
        const char *verb;
        size_t count; /* of numbers */
        void (*act)(live *l, const order *o);
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

/* ---- the loop -------------------------------------------------------------------------------*/

/* Wait for the user, a file, a signal, or so long (negative: for ever). */
static void wait_for(live *l, double seconds)
{
    fd_set ready;
    char ignored[64];
    const double rest = fmax(seconds, 0.0);
    struct timespec time = {(time_t)rest, (long)(1e9 * (rest - floor(rest)))};
    const int most = l->watch > l->wake[0] ? l->watch : l->wake[0];
    FD_ZERO(&ready);
    FD_SET(l->wake[0], &ready);
    if (l->watch >= 0) {
        FD_SET(l->watch, &ready);
    }
    (void)pselect(most + 1, &ready, NULL, NULL, seconds < 0.0 ? NULL : &time, &l->awake);
    while (read(l->wake[0], ignored, sizeof ignored) > 0) {
    }
}

static void loop(live *l)
{
    char words[LIVE_WORDS_SIZE];
    while (!interrupt_came()) {
        const double begin = clock_now();
        while (live_server_take(l->server, words)) {
            obey(l, words);
        }
        if (l->is_stale) {
            read_again(l, SE3DI_LIVE_GOING_ON);
        }
        look_at_files(l);
        const int moves = l->status.running && live_server_is_watched(l->server);
        if (moves) {
            go_on(l);
        }
        if (l->is_new) {
            publish(l);
        }
        wait_for(l, moves ? fmax(begin + PICTURE - clock_now(), 0.0) : -1.0);
    }
}

/* Signals come to this thread only, and only while it waits. */
static void hold_signals(live *l)
{
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    sigaddset(&held, SIGTERM);
    sigaddset(&held, SIGHUP);
    sigprocmask(SIG_BLOCK, &held, &l->awake);
}

static int make_wake(live *l)
{
    if (pipe(l->wake) != 0) {
        return 0;
    }
    for (int k = 0; k < 2; ++k) {
        fcntl(l->wake[k], F_SETFL, O_NONBLOCK);
        fcntl(l->wake[k], F_SETFD, FD_CLOEXEC);
    }
    return 1;
}

static int serve(live *l, const options *o, const char *page, size_t size)
{
    char address[LIVE_ADDRESS_SIZE];
    const int port = o->port ? (int)strtol(o->port, NULL, 10) : 0;
    if (!make_wake(l)) {
        perror("se3d live");
        return EXIT_FAILED;
    }
    interrupt_begin();
    hold_signals(l);
    l->server = live_server_create(port, page, size, l->wake[1], address);
    if (!l->server) {
        return EXIT_FAILED;
    }
    l->watch = live_watch_create();
    l->status.running = se3di_live_has_motion(l->model);
    l->last = clock_now();
    watch_files(l);
    if (show_scene(l)) {
        publish(l);
        printf("%s\n", address);
        if (!o->quiet) {
            printf("shows %s in a browser on this machine until Ctrl-C\n", o->model);
        }
        fflush(stdout);
        loop(l);
    }
    live_server_destroy(l->server);
    free(l->scene);
    return EXIT_DONE;
}

static char *make_page(size_t *size)
{
    char *data = NULL;
    page_parts *parts = malloc(sizeof *parts);
    if (!parts || page_begin(parts, "live") != EXIT_DONE) {
        free(parts);
        return NULL;
    }
    FILE *file = open_memstream(&data, size);
    const int good = file && page_put_begin(file, parts) &&
                     page_put_part(file, parts, "live.html") &&
                     page_put_end(file, parts, "live.js");
    page_end(parts);
    free(parts);
    data = file ? live_text_take(file, &data) : NULL;
    if (!good) {
        free(data);
        data = NULL;
    }
    return data;
}

static int show_model(const options *o)
{
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    size_t size = 0;
    live *l = calloc(1, sizeof *l);
    char *page = l ? make_page(&size) : NULL;
    int code = EXIT_FAILED;
    if (page) {
        l->how = options_get_model(o);
        l->status.speed = 1.0;
        l->deadline = HUGE_VAL;
        l->model = se3di_live_create(o->model, &l->how, is_over, l, why);
        code = EXIT_USAGE;
        if (l->model) {
            code = serve(l, o, page, size);
        } else {
            fprintf(stderr, "%s\n", why);
        }
        se3di_live_destroy(l->model);
    }
    free(page);
    free(l);
    return code;
}

#else

static int show_model(const options *o)
{
    (void)o;
    fputs(
        "se3d live: this program was built without libmicrohttpd; on Debian and Ubuntu: apt-get "
        "install libmicrohttpd-dev, then build it again. `se3d run` and `se3d view` work without\n",
        stderr);
    return EXIT_FAILED;
}

#endif

/* Whether the port is one and the model a file; if not, says so. */
static int is_possible(const options *o)
{
    char *end = NULL;
    const long port = o->port ? strtol(o->port, &end, 10) : 0;
    if (o->port && (end == o->port || *end || port < 0 || port > 65535)) {
        fprintf(stderr, "se3d live: --port %s: must be 0 to 65535; 0: one that is free\n", o->port);
        return 0;
    }
    if (strcmp(o->model, "-") == 0) {
        fputs("se3d live: standard input cannot be read again; give a file\n", stderr);
        return 0;
    }
    return 1;
}

static int command_live(int count, char *const *words)
{
    options o;
    const int code = options_read(&o, &live_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    return is_possible(&o) ? show_model(&o) : EXIT_USAGE;
}

const command_entry live_entry = {
    .name = "live",
    .run = command_live,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "run a model while you look at it and change it",
    .text = "Prints the address of a page in which the model runs in real time, until Ctrl-C. When "
            "the model file, or one that it includes, is saved, the page shows the new model; if "
            "it is wrong, the old one with the message. Sliders set parameters, efforts and loads; "
            "a body is pulled with Ctrl and the mouse. Only this machine can ask, and only with "
            "the token in the address. docs/live.md has the rest.",
    .options =
        (const command_option[]){
            {"--port", NULL, "N", "of 127.0.0.1 (default 0: one that is free)"},
            COMMAND_OPTION_SET,
            {"--analysis", NULL, "T", "instead of those of the model: {analyses}"},
            COMMAND_OPTIONS_OF_SOLVERS,
            COMMAND_OPTION_QUIET,
            {0}},
    .examples = (const command_example[]){{"live pendulum.yaml", "open the address that it prints"},
                                          {"live car.yaml --port 8000", "always the same port"},
                                          {0}},
    .exits = "0 done, ended by Ctrl-C; 1 no server, or built without it; 2 bad usage or model.",
};
