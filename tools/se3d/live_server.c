/* SPDX-License-Identifier: BSD-3-Clause */
/* Who may ask: every address begins with the token, which only the user's terminal was told; the
 * header Host must name this server, so that a name that another server lets point here (DNS
 * rebinding) is of no use; and Origin, which browsers send, must be this page's. All that is read
 * is bounded: headers by the memory of a connection, bodies by LIVE_WORDS_SIZE, connections and
 * words that wait by their number. */
#define _XOPEN_SOURCE 700

#include "live_server.h"
#include "outcome.h"

#if defined(SE3D_HAS_MICROHTTPD)

#include <arpa/inet.h>
#include <errno.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>

enum {
    TOKEN_BYTES = 16,
    TOKEN_LENGTH = 2 * TOKEN_BYTES,
    WORDS_MAX = 64,       /* that wait to be taken */
    WAITERS_MAX = 8,      /* requests for the next state */
    CONNECTIONS_MAX = 32, /* at once */
    CONNECTION_BYTES = 16384,
    IDLE_SECONDS = 15, /* a connection that says nothing is closed */
    WATCHED_SECONDS = 2
};

static const char policy[] =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src "
    "'self'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

typedef struct text {
    char *data; /* NULL: none yet */
    size_t size;
} text;

/* What is kept of a request while its parts come. */
typedef struct request {
    struct MHD_Connection *connection;
    size_t used;
    int is_too_long;
    int is_due; /* it is answered now, even if there is nothing new */
    char body[LIVE_WORDS_SIZE];
} request;

struct live_server {
    struct MHD_Daemon *daemon;
    pthread_mutex_t lock; /* of all below */
    text scene, state;
    uint64_t sequence;
    request *waiters[WAITERS_MAX];
    size_t waiter_count;
    char words[WORDS_MAX][LIVE_WORDS_SIZE];
    size_t first, count; /* of the words that wait */
    time_t seen;         /* when a state was last asked for */
    int is_closing;
    /* set once */
    const char *page;
    size_t page_size;
    int wake;
    char token[TOKEN_LENGTH + 1];
    char hosts[4][40]; /* "127.0.0.1:1234", with localhost; without a port if it is 80, or empty */
};

static time_t now(void)
{
    struct timespec t = {0, 0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec;
}

/* ---- answers --------------------------------------------------------------------------------*/

static enum MHD_Result answer(struct MHD_Connection *connection, unsigned code, const char *type,
                              const char *data, size_t size)
{
    static const char *const headers[][2] = {
        {MHD_HTTP_HEADER_CACHE_CONTROL, "no-store"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Content-Security-Policy", policy},
    };
    struct MHD_Response *response =
        MHD_create_response_from_buffer(size, (void *)(uintptr_t)data, MHD_RESPMEM_MUST_COPY);
    if (!response) {
        return MHD_NO;
    }
    (void)MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
    for (size_t k = 0; k < sizeof headers / sizeof *headers; ++k) {
        (void)MHD_add_response_header(response, headers[k][0], headers[k][1]);
    }
    if (code == MHD_HTTP_METHOD_NOT_ALLOWED) {
        (void)MHD_add_response_header(response, MHD_HTTP_HEADER_ALLOW, "GET, POST");
    }
    const enum MHD_Result result = MHD_queue_response(connection, code, response);
    MHD_destroy_response(response);
    return result;
}

static enum MHD_Result refuse(struct MHD_Connection *connection, unsigned code, const char *why)
{
    return answer(connection, code, "text/plain; charset=utf-8", why, strlen(why));
}

/* ---- who asks -------------------------------------------------------------------------------*/

typedef struct question {
    const live_server *server;
    size_t hosts;
    int is_foreign;
} question;

static int is_own_host(const live_server *s, const char *name)
{
    for (size_t k = 0; k < sizeof s->hosts / sizeof *s->hosts; ++k) {
        if (s->hosts[k][0] && strcmp(name, s->hosts[k]) == 0) {
            return 1;
        }
    }
    return 0;
}

static enum MHD_Result look_at_header(void *cls, enum MHD_ValueKind kind, const char *key,
                                      const char *value)
{
    question *q = cls;
    (void)kind;
    value = value ? value : "";
    if (strcasecmp(key, MHD_HTTP_HEADER_HOST) == 0) {
        ++q->hosts;
        q->is_foreign = q->is_foreign || !is_own_host(q->server, value);
    } else if (strcasecmp(key, MHD_HTTP_HEADER_ORIGIN) == 0) {
        q->is_foreign = q->is_foreign || strncmp(value, "http://", 7) != 0 ||
                        !is_own_host(q->server, value + 7);
    } else if (strcasecmp(key, "Sec-Fetch-Site") == 0) {
        q->is_foreign =
            q->is_foreign || (strcmp(value, "same-origin") != 0 && strcmp(value, "none") != 0);
    }
    return MHD_YES;
}

static int is_foreign(const live_server *s, struct MHD_Connection *connection)
{
    question q = {s, 0, 0};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, look_at_header, &q);
    return q.is_foreign || q.hosts != 1;
}

/* The part of an address behind "/TOKEN/"; NULL: the token is wrong. All of it is compared, so that
 * the time does not tell how much is right. */
static const char *skip_token(const live_server *s, const char *url)
{
    unsigned wrong = 0;
    if (strlen(url) < TOKEN_LENGTH + 2 || url[0] != '/' || url[TOKEN_LENGTH + 1] != '/') {
        return NULL;
    }
    for (size_t k = 0; k < TOKEN_LENGTH; ++k) {
        wrong |= (unsigned)(unsigned char)url[k + 1] ^ (unsigned)(unsigned char)s->token[k];
    }
    return wrong ? NULL : url + TOKEN_LENGTH + 2;
}

/* ---- what is asked --------------------------------------------------------------------------*/

static uint64_t read_after(struct MHD_Connection *connection)
{
    const char *value = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "after");
    uint64_t after = 0;
    for (size_t k = 0; value && k < 18 && value[k] >= '0' && value[k] <= '9'; ++k) {
        after = 10 * after + (uint64_t)(value[k] - '0');
    }
    return after;
}

static void wake(const live_server *s)
{
    const char one = 1;
    const ssize_t ignored = write(s->wake, &one, 1); /* a full pipe wakes as well */
    (void)ignored;
}

/* Let a request wait for the next state; the oldest one goes if there are too many. */
static void let_wait(live_server *s, request *r)
{
    if (s->waiter_count == WAITERS_MAX) {
        request *oldest = s->waiters[0];
        memmove(s->waiters, s->waiters + 1, (WAITERS_MAX - 1) * sizeof *s->waiters);
        --s->waiter_count;
        oldest->is_due = 1;
        MHD_resume_connection(oldest->connection);
    }
    s->waiters[s->waiter_count++] = r;
    MHD_suspend_connection(r->connection);
}

static enum MHD_Result answer_state(live_server *s, request *r)
{
    enum MHD_Result result = MHD_YES;
    const uint64_t after = read_after(r->connection);
    pthread_mutex_lock(&s->lock);
    const int was_watched = now() - s->seen <= WATCHED_SECONDS;
    s->seen = now();
    if (s->is_closing) {
        result = refuse(r->connection, MHD_HTTP_SERVICE_UNAVAILABLE, "the program ends\n");
    } else if (s->state.data && (s->sequence != after || r->is_due)) {
        result =
            answer(r->connection, MHD_HTTP_OK, "application/json", s->state.data, s->state.size);
    } else {
        let_wait(s, r);
    }
    pthread_mutex_unlock(&s->lock);
    if (!was_watched) {
        wake(s);
    }
    return result;
}

/* How much of the words says what they are about: of two that pull, or set the same number, the
 * later one counts. 0: all count. */
static size_t measure_kind(const char *words)
{
    if (strncmp(words, "pull ", 5) == 0) {
        return 5;
    }
    if (strncmp(words, "set ", 4) != 0) {
        return 0;
    }
    const size_t list = 4 + strcspn(words + 4, " ");
    return words[list] ? list + 1 + strcspn(words + list + 1, " ") + 1 : 0;
}

/* Words of the same kind that wait, with nothing but such words behind them. */
static char *find_same(live_server *s, const char *words)
{
    const size_t kind = measure_kind(words);
    for (size_t k = s->count; kind > 0 && k-- > 0;) {
        char *other = s->words[(s->first + k) % WORDS_MAX];
        if (measure_kind(other) == 0) {
            break;
        }
        if (strncmp(words, other, kind) == 0) {
            return other;
        }
    }
    return NULL;
}

/* @return false: too many wait. */
static int let_words_wait(live_server *s, const char *words)
{
    pthread_mutex_lock(&s->lock);
    char *to = find_same(s, words);
    if (!to && s->count < WORDS_MAX) {
        to = s->words[(s->first + s->count++) % WORDS_MAX];
    }
    if (to) {
        snprintf(to, LIVE_WORDS_SIZE, "%s", words);
    }
    pthread_mutex_unlock(&s->lock);
    if (to) {
        wake(s);
    }
    return to != NULL;
}

static enum MHD_Result answer_get(live_server *s, request *r, const char *what)
{
    enum MHD_Result result = MHD_NO;
    if (what[0] == '\0') { /* a page that is read again pulls at nothing */
        (void)let_words_wait(s, "release");
        return answer(r->connection, MHD_HTTP_OK, "text/html; charset=utf-8", s->page,
                      s->page_size);
    }
    if (strcmp(what, "state") == 0) {
        return answer_state(s, r);
    }
    if (strcmp(what, "scene") != 0) {
        return refuse(r->connection, MHD_HTTP_NOT_FOUND, "there is nothing of this name\n");
    }
    pthread_mutex_lock(&s->lock);
    result = s->scene.data ? answer(r->connection, MHD_HTTP_OK, "application/json", s->scene.data,
                                    s->scene.size)
                           : refuse(r->connection, MHD_HTTP_SERVICE_UNAVAILABLE, "not yet\n");
    pthread_mutex_unlock(&s->lock);
    return result;
}

static enum MHD_Result take_words(live_server *s, request *r)
{
    if (r->is_too_long) {
        return refuse(r->connection, MHD_HTTP_CONTENT_TOO_LARGE, "too many words\n");
    }
    if (memchr(r->body, '\0', r->used)) {
        return refuse(r->connection, MHD_HTTP_BAD_REQUEST, "these are no words\n");
    }
    r->body[r->used] = '\0';
    if (!let_words_wait(s, r->body)) {
        return refuse(r->connection, MHD_HTTP_SERVICE_UNAVAILABLE, "too many words wait\n");
    }
    return answer(r->connection, MHD_HTTP_OK, "text/plain; charset=utf-8", "", 0);
}

/* The first call for a request, before its body comes. @return not NULL: why it is refused. */
static const char *find_fault(const live_server *s, struct MHD_Connection *connection,
                              const char *method, const char *what, unsigned *code)
{
    const int posts = strcmp(method, MHD_HTTP_METHOD_POST) == 0;
    if (is_foreign(s, connection)) {
        *code = MHD_HTTP_FORBIDDEN;
        return "this server answers its own page only\n";
    }
    if (!what) {
        *code = MHD_HTTP_FORBIDDEN;
        return "the address has no valid token: take the one that `se3d live` has printed\n";
    }
    if (!posts && strcmp(method, MHD_HTTP_METHOD_GET) != 0) {
        *code = MHD_HTTP_METHOD_NOT_ALLOWED;
        return "GET or POST\n";
    }
    if (posts && strcmp(what, "do") != 0) {
        *code = MHD_HTTP_NOT_FOUND;
        return "there is nothing of this name\n";
    }
    return NULL;
}

static enum MHD_Result begin(const live_server *s, struct MHD_Connection *connection,
                             const char *method, const char *what, void **context)
{
    unsigned code = 0;
    const char *fault = find_fault(s, connection, method, what, &code);
    if (fault) {
        return refuse(connection, code, fault);
    }
    request *r = calloc(1, sizeof *r);
    if (!r) {
        return MHD_NO;
    }
    r->connection = connection;
    *context = r;
    return MHD_YES;
}

static enum MHD_Result handle(void *cls, struct MHD_Connection *connection, const char *url,
                              const char *method, const char *version, const char *data,
                              size_t *size, void **context)
{
    live_server *s = cls;
    request *r = *context;
    const char *what = skip_token(s, url);
    (void)version;
    if (!r) {
        return begin(s, connection, method, what, context);
    }
    if (*size > 0) {
        const size_t room = sizeof r->body - 1 - r->used;
        r->is_too_long = r->is_too_long || *size > room;
        if (!r->is_too_long) {
            memcpy(r->body + r->used, data, *size);
            r->used += *size;
        }
        *size = 0;
        return MHD_YES;
    }
    return strcmp(method, MHD_HTTP_METHOD_POST) == 0 ? take_words(s, r) : answer_get(s, r, what);
}

static void forget(void *cls, struct MHD_Connection *connection, void **context,
                   enum MHD_RequestTerminationCode code)
{
    (void)cls;
    (void)connection;
    (void)code;
    free(*context);
    *context = NULL;
}

/* ---- the program's side ---------------------------------------------------------------------*/

static int make_token(char token[TOKEN_LENGTH + 1])
{
    unsigned char bytes[TOKEN_BYTES];
    FILE *file = fopen("/dev/urandom", "rb");
    const int good = file && fread(bytes, 1, sizeof bytes, file) == sizeof bytes;
    if (file) {
        fclose(file);
    }
    for (size_t k = 0; good && k < TOKEN_BYTES; ++k) {
        snprintf(token + 2 * k, 3, "%02x", bytes[k]);
    }
    return good;
}

static int listen_at(live_server *s, int port)
{
    struct sockaddr_in place;
    memset(&place, 0, sizeof place);
    place.sin_family = AF_INET;
    place.sin_port = htons((uint16_t)port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    /* poll, not epoll: that overlooks clients who have gone until they are timed out, and these
     * fill the places of others */
    s->daemon = MHD_start_daemon(
        MHD_USE_POLL | MHD_USE_INTERNAL_POLLING_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL,
        handle, s, MHD_OPTION_SOCK_ADDR, (struct sockaddr *)&place, MHD_OPTION_NOTIFY_COMPLETED,
        forget, NULL, MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS_MAX,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_BYTES, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)IDLE_SECONDS, MHD_OPTION_END);
    return s->daemon != NULL;
}

live_server *live_server_create(int port, const char *page, size_t size, int wake_end,
                                char address[LIVE_ADDRESS_SIZE])
{
    live_server *s = calloc(1, sizeof *s);
    if (!s || !make_token(s->token)) {
        complain("se3d live: no memory, or no random numbers for the token\n");
        free(s);
        return NULL;
    }
    pthread_mutex_init(&s->lock, NULL);
    s->page = page;
    s->page_size = size;
    s->wake = wake_end;
    s->seen = now() - 1000;
    errno = 0;
    if (!listen_at(s, port)) {
        complain("se3d live: no server on port %d of 127.0.0.1: %s\n", port,
                 strerror(errno ? errno : EADDRNOTAVAIL));
        pthread_mutex_destroy(&s->lock);
        free(s);
        return NULL;
    }
    const union MHD_DaemonInfo *info = MHD_get_daemon_info(s->daemon, MHD_DAEMON_INFO_BIND_PORT);
    const unsigned bound = info ? info->port : (unsigned)port;
    snprintf(s->hosts[0], sizeof s->hosts[0], "127.0.0.1:%u", bound);
    snprintf(s->hosts[1], sizeof s->hosts[1], "localhost:%u", bound);
    if (bound == 80) { /* clients leave it out */
        snprintf(s->hosts[2], sizeof s->hosts[2], "127.0.0.1");
        snprintf(s->hosts[3], sizeof s->hosts[3], "localhost");
    }
    snprintf(address, LIVE_ADDRESS_SIZE, "http://%s/%s/", s->hosts[0], s->token);
    return s;
}

static void resume_all(live_server *s)
{
    for (size_t k = 0; k < s->waiter_count; ++k) {
        MHD_resume_connection(s->waiters[k]->connection);
    }
    s->waiter_count = 0;
}

void live_server_destroy(live_server *s)
{
    if (!s) {
        return;
    }
    pthread_mutex_lock(&s->lock);
    s->is_closing = 1;
    resume_all(s);
    pthread_mutex_unlock(&s->lock);
    MHD_stop_daemon(s->daemon);
    pthread_mutex_destroy(&s->lock);
    free(s->scene.data);
    free(s->state.data);
    free(s);
}

void live_server_set_scene(live_server *s, char *data, size_t size)
{
    pthread_mutex_lock(&s->lock);
    free(s->scene.data);
    s->scene = (text){data, size};
    pthread_mutex_unlock(&s->lock);
}

void live_server_set_state(live_server *s, char *data, size_t size, uint64_t sequence)
{
    pthread_mutex_lock(&s->lock);
    free(s->state.data);
    s->state = (text){data, size};
    s->sequence = sequence;
    resume_all(s);
    pthread_mutex_unlock(&s->lock);
}

int live_server_take(live_server *s, char words[LIVE_WORDS_SIZE])
{
    pthread_mutex_lock(&s->lock);
    const int some = s->count > 0;
    if (some) {
        memcpy(words, s->words[s->first], LIVE_WORDS_SIZE);
        s->first = (s->first + 1) % WORDS_MAX;
        --s->count;
    }
    pthread_mutex_unlock(&s->lock);
    return some;
}

static int is_one_of(const char *words, const char *const *verbs)
{
    const size_t length = strcspn(words, " ");
    for (; *verbs; ++verbs) {
        if (strlen(*verbs) == length && strncmp(words, *verbs, length) == 0) {
            return 1;
        }
    }
    return 0;
}

int live_server_has_words(live_server *s, const char *const *verbs)
{
    pthread_mutex_lock(&s->lock);
    int some = !verbs && s->count > 0;
    for (size_t k = 0; verbs && k < s->count && !some; ++k) {
        some = is_one_of(s->words[(s->first + k) % WORDS_MAX], verbs);
    }
    pthread_mutex_unlock(&s->lock);
    return some;
}

int live_server_is_watched(live_server *s)
{
    pthread_mutex_lock(&s->lock);
    const int watched = s->waiter_count > 0 || now() - s->seen <= WATCHED_SECONDS;
    pthread_mutex_unlock(&s->lock);
    return watched;
}

#else
typedef int live_server_is_left_out; /* a file of C has a declaration */
#endif
