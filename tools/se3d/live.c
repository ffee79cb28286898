/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d live MODEL: a page on this machine in which the model runs. This thread runs the model
 * (live_loop.c); that of the server (live_server.c) answers the page with the texts that it is
 * given. */
#define _XOPEN_SOURCE 700

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "outcome.h"

#if defined(SE3D_HAS_MICROHTTPD)

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

#include "interrupt.h"
#include "live_loop.h"
#include "live_server.h"
#include "live_text.h"
#include "live_watch.h"
#include "page.h"

typedef struct live {
    live_loop *loop;
    live_server *server;
    int watch;
    int wake[2];
} live;

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

static void loop(live *l)
{
    while (!interrupt_came()) {
        const double rest = live_loop_turn(l->loop);
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
    if (o->json) {
        outcome_tell();
        fputs("{\"status\": \"running\", \"address\": ", stdout);
        json_put_text(address);
        fputs("}\n", stdout);
    }
    const int good =
        (o->json || printf("%s\n", address) >= 0) &&
        (o->quiet || o->json ||
         printf("shows %s in a browser on this machine until Ctrl-C\n", o->model) >= 0) &&
        fflush(stdout) == 0;
    if (!good) {
        complain("se3d live: the address cannot be written: %s\n", strerror(errno));
    }
    return good;
}

static void begin_watching(live *l)
{
    l->watch = live_watch_create();
    if (l->watch < 0 || !live_loop_watch(l->loop, l->watch)) {
        warn("se3d live: files that are saved may not be noticed (%s): `reset` reads them\n",
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
    if (!live_loop_begin(l->loop, l->server)) {
        complain("se3d live: out of memory, or the model cannot be drawn\n");
    } else if (tell_address(o, address)) {
        loop(l);
        code = EXIT_DONE;
    }
    live_server_destroy(l->server);
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
    const int good = file && page_put_begin(file, parts, 0) &&
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
    char *page = make_page(&size);
    if (!page) {
        return EXIT_FAILED;
    }
    const se3d_model_options how = options_get_model(o);
    live l = {.loop = live_loop_create(o->model, &how, why), .watch = -1};
    int code = EXIT_USAGE;
    if (l.loop) {
        code = serve(&l, o, page, size);
    } else {
        complain("%s\n", why);
    }
    live_loop_destroy(l.loop);
    free(page);
    return code;
}

#else

static int show_model(const options *o)
{
    (void)o;
    complain(
        "se3d live: this program was built without libmicrohttpd; on Debian and Ubuntu: apt-get "
        "install libmicrohttpd-dev, then build it again. `se3d run` and `se3d view` work "
        "without\n");
    return EXIT_FAILED;
}

#endif

/* Whether the port is one and the model a file; if not, says so. */
static int is_possible(const options *o)
{
    char *end = NULL;
    const long port = o->port ? strtol(o->port, &end, 10) : 0;
    if (o->port && (end == o->port || *end || port < 0 || port > 65535)) {
        complain("se3d live: --port %s: must be 0 to 65535; 0: one that is free\n", o->port);
        return 0;
    }
    if (strcmp(o->model, "-") == 0) {
        complain("se3d live: standard input cannot be read again; give a file\n");
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
            {"--json", NULL, NULL, "print the address as JSON"},
            COMMAND_OPTION_SET,
            {"--analysis", NULL, "T", "instead of those of the model: {analyses}"},
            COMMAND_OPTIONS_OF_SOLVERS,
            {0}},
    .examples = (const command_example[]){{"live pendulum.yaml", "open the address that it prints"},
                                          {"live car.yaml --port 8000", "always the same port"},
                                          {0}},
    .exits = "0 done, ended by Ctrl-C; 1 no server, or built without it; 2 bad usage or model.",
};
