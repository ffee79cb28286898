/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d live MODEL: a page on this machine in which the model runs. This thread runs the model; that
 * of the server (live_server.c) answers the page with the texts that it is given here. */
#define _XOPEN_SOURCE 700

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"

#if defined(SE3D_HAS_MICROHTTPD)

#include <errno.h>
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

typedef struct live {
    se3d_model_options how;
    se3di_live *model;
    live_server *server;
    int watch;
    int wake[2];
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
} live;

static double clock_now(void)
{
    struct timespec t = {0, 0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void look_at_files(live *l);

/* Whether a reading has become useless: a file was saved, or other numbers have waited for long. */
static int is_useless(live *l)
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
    live *l = ctx;
    if (l->is_reading) {
        l->is_left = l->is_left || interrupt_came() || is_useless(l);
        return l->is_left;
    }
    return interrupt_came() || clock_now() > l->deadline ||
           (l->is_stepping && live_server_has_words(l->server, NULL));
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

/* Files that a reading has found mistakes in: "FILE:LINE:COLUMN: ..." in every line. */
static void watch_wrong_files(const live *l)
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
static int watch_files(const live *l)
{
    int good = 1;
    for (size_t k = 0; se3di_live_get_file(l->model, k); ++k) {
        good = live_watch_add(l->watch, se3di_live_get_file(l->model, k)) && good;
    }
    watch_wrong_files(l);
    return good;
}

/* The names of the sliders have a version of their own: it stays while their numbers change. */
static int show_sliders(live *l)
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
static int show_scene(live *l)
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
static void tell_failure(live *l, se3di_live_beginning beginning, const char *why)
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
static int read_again(live *l, se3di_live_beginning beginning)
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
    const live *l = ctx;
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

static void look_at_files(live *l)
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
static void read_what_is_due(live *l)
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

static void stop(live *l, const char *why)
{
    l->status.running = 0;
    l->until = (double)NAN;
    snprintf(l->status.run_trouble, sizeof l->status.run_trouble, "%s", why);
}

/* Go to a time of the model, as far as it comes within so long. */
static void advance(live *l, double until, double budget)
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
static void go_step(live *l)
{
    l->is_stepping = 1;
    advance(l, l->until, STEP_MAX);
    l->is_stepping = 0;
    if (se3di_live_get_time(l->model) >= l->until) {
        l->until = (double)NAN;
    }
}

static void go_on(live *l)
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

static void want(live *l, reading what)
{
    l->wanted = what > l->wanted ? what : l->wanted;
}

static void do_run(live *l, const order *o)
{
    (void)o;
    if (se3di_live_has_motion(l->model)) {
        l->status.running = 1;
        l->status.run_trouble[0] = '\0';
        l->until = (double)NAN;
        l->last = clock_now();
    }
}

static void do_pause(live *l, const order *o)
{
    (void)o;
    l->status.running = 0;
    l->until = (double)NAN;
}

/* Steps that wait are one that is longer. */
static void do_step(live *l, const order *o)
{
    const double from = isnan(l->until) ? se3di_live_get_time(l->model) : l->until;
    (void)o;
    l->status.running = 0;
    l->status.run_trouble[0] = '\0';
    l->until = from + PICTURE * (l->status.speed > 0.0 ? l->status.speed : 1.0);
}

static void do_reset(live *l, const order *o)
{
    (void)o;
    l->until = (double)NAN;
    want(l, READ_RESET);
}

static void do_anew(live *l, const order *o)
{
    (void)o;
    l->until = (double)NAN;
    want(l, READ_ANEW);
}

static void do_speed(live *l, const order *o)
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

static void do_set(live *l, const order *o)
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

static void do_pull(live *l, const order *o)
{
    if (is_version(o, l->status.version) &&
        se3di_live_pull(l->model, as_index(o->numbers[1]), o->numbers + 2, o->numbers + 5)) {
        l->is_touched = 1;
    }
}

static void do_release(live *l, const order *o)
{
    (void)o;
    l->is_touched = se3di_live_release(l->model) || l->is_touched;
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

/* Block the signals that ask for an end. */
static void hold_signals(sigset_t *before)
{
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    sigaddset(&held, SIGTERM);
    sigaddset(&held, SIGHUP);
    sigprocmask(SIG_BLOCK, &held, before);
}

/* Wait for the user, a file, a signal, or so long (negative: for ever). */
static void wait_for(live *l, double seconds)
{
    fd_set ready;
    sigset_t awake;
    char ignored[64];
    const double rest = fmax(seconds, 0.0);
    struct timespec time = {(time_t)rest, (long)(1e9 * (rest - floor(rest)))};
    const int most = l->watch > l->wake[0] ? l->watch : l->wake[0];
    FD_ZERO(&ready);
    FD_SET(l->wake[0], &ready);
    if (l->watch >= 0) {
        FD_SET(l->watch, &ready);
    }
    hold_signals(&awake); /* none comes between the question and the answer */
    if (!interrupt_came()) {
        (void)pselect(most + 1, &ready, NULL, NULL, seconds < 0.0 ? NULL : &time, &awake);
    }
    sigprocmask(SIG_SETMASK, &awake, NULL);
    while (read(l->wake[0], ignored, sizeof ignored) > 0) {
    }
}

/* What has changed while the model stands acts from now on: forces and accelerations follow. */
static void settle(live *l)
{
    if (l->is_touched && se3di_live_has_motion(l->model)) {
        advance(l, se3di_live_get_time(l->model), STEP_MAX);
    }
    l->is_touched = 0;
}

/* One turn. @return how long to wait, negative: for ever. */
static double turn(live *l)
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

static void loop(live *l)
{
    while (!interrupt_came()) {
        const double rest = turn(l);
        wait_for(l, live_server_has_words(l->server, NULL) ? 0.0 : rest);
    }
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

/* @return false: nobody has learned the address. */
static int tell_address(const options *o, const char *address)
{
    const int good = printf("%s\n", address) >= 0 &&
                     (o->quiet || printf("shows %s in a browser on this machine until Ctrl-C\n",
                                         o->model) >= 0) &&
                     fflush(stdout) == 0;
    if (!good) {
        fprintf(stderr, "se3d live: the address cannot be written: %s\n", strerror(errno));
    }
    return good;
}

static void begin_watching(live *l)
{
    l->watch = live_watch_create();
    if (l->watch < 0 || !watch_files(l)) {
        fprintf(stderr,
                "se3d live: files that are saved may not be noticed (%s): `reset` reads them\n",
                strerror(errno));
    }
}

/* The thread of the server has no signals. */
static live_server *make_server(const live *l, int port, const char *page, size_t size,
                                char *address)
{
    sigset_t before;
    hold_signals(&before);
    live_server *server = live_server_create(port, page, size, l->wake[1], address);
    sigprocmask(SIG_SETMASK, &before, NULL);
    return server;
}

static int serve(live *l, const options *o, const char *page, size_t size)
{
    char address[LIVE_ADDRESS_SIZE];
    const int port = o->port ? (int)strtol(o->port, NULL, 10) : 0;
    int code = EXIT_FAILED;
    if (!make_wake(l)) {
        perror("se3d live");
        return EXIT_FAILED;
    }
    interrupt_begin();
    l->server = make_server(l, port, page, size, address);
    if (!l->server) {
        return EXIT_FAILED;
    }
    begin_watching(l);
    l->status.running = se3di_live_has_motion(l->model);
    l->last = clock_now();
    if (!show_scene(l)) {
        fputs("se3d live: out of memory, or the model cannot be drawn\n", stderr);
    } else {
        publish(l);
        if (tell_address(o, address)) {
            loop(l);
            code = EXIT_DONE;
        }
    }
    live_server_destroy(l->server);
    free(l->scene);
    free(l->sliders);
    return code;
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

/* Files that are opened must not get the numbers of standard ones that are closed. */
static void open_standard_files(void)
{
    for (int k = 0; k < 3; ++k) {
        if (fcntl(k, F_GETFD) < 0) {
            (void)open("/dev/null", k == 1 ? O_RDONLY : O_RDWR); /* writing the address fails */
        }
    }
}

static int show_model(const options *o)
{
    open_standard_files();
    char why[SE3DI_LIVE_MESSAGE_SIZE];
    size_t size = 0;
    live *l = calloc(1, sizeof *l);
    char *page = l ? make_page(&size) : NULL;
    int code = EXIT_FAILED;
    if (page) {
        l->how = options_get_model(o);
        l->status.speed = 1.0;
        l->deadline = HUGE_VAL;
        l->until = (double)NAN;
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
