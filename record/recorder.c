/* SPDX-License-Identifier: BSD-3-Clause */
/* The recorder. Its data are global, as a program has one recording: it is a library of its own. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include "recorder.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "format.h"
#include "record.h"
#include "se3d/se3d.h"

typedef struct object {
    const void *pointer;
    size_t kind;
    uint32_t id;
} object;

typedef struct variables { /* of the number of variables of a function or expression */
    uint64_t key;
    size_t count;
} variables;

static struct recorder {
    pthread_mutex_t lock;
    atomic_int active;
    int file, failed;
    off_t length; /* of the pieces that are whole */
    pid_t process;
    object *objects; /* those that live, in no order */
    size_t object_count, object_capacity;
    uint32_t next_object, next_callback;
    variables *memories;
    size_t memory_count, memory_capacity;
    recorder_callback *callbacks;
} recorder = {.lock = PTHREAD_MUTEX_INITIALIZER, .file = -1};

static atomic_uint next_thread;
static _Thread_local uint32_t thread_number; /* from 1 */
static _Thread_local int call_depth;         /* above 0: libse3d calls itself */
static _Thread_local int callback_depth;     /* callbacks of the host that run */
static _Thread_local int is_quiet;           /* what is called is our question */

/* ---- Pieces. ---- */

static int is_active(void)
{
    return atomic_load(&recorder.active) && recorder.process == getpid();
}

static int write_whole(const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        const ssize_t n = write(recorder.file, at, size);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return -1;
        }
        at += n;
        size -= (size_t)n;
    }
    return 0;
}

/* The recording ends with its last whole piece; nobody else would learn of it. */
static void give_up(void)
{
    const char *why = errno ? strerror(errno) : "out of memory";
    if (recorder.failed) {
        return;
    }
    recorder.failed = 1;
    fprintf(stderr, "se3d-record: the recording ends here: %s\n", why);
    if (ftruncate(recorder.file, recorder.length) != 0) {
        fprintf(stderr, "se3d-record: its last call is not whole: %s\n", strerror(errno));
    }
}

/* Within the lock. */
static void write_piece(format_kind kind, const bytes *content)
{
    bytes piece = {0};
    if (recorder.failed) {
        return;
    }
    if (thread_number == 0) {
        thread_number = atomic_fetch_add(&next_thread, 1) + 1;
    }
    bytes_put_u32(&piece, (uint32_t)content->size);
    bytes_put_u32(&piece, thread_number);
    bytes_put_u8(&piece, (unsigned)kind);
    bytes_put(&piece, content->data, content->size);
    errno = 0;
    if (content->failed || piece.failed || content->size > UINT32_MAX ||
        write_whole(piece.data, piece.size) != 0) {
        give_up();
    } else {
        recorder.length += (off_t)piece.size;
    }
    bytes_free(&piece);
}

static void put_name(bytes *out, const char *name)
{
    bytes_put_u32(out, (uint32_t)strlen(name));
    bytes_put(out, name, strlen(name));
}

static int write_head(void)
{
    bytes head = {0};
    bytes_put(&head, FORMAT_MAGIC, 8);
    put_name(&head, se3d_version_get_text());
    bytes_put_u32(&head, (uint32_t)layout_function_count);
    for (size_t k = 0; k < layout_function_count; ++k) {
        put_name(&head, layout_functions[k].name);
    }
    const int result = head.failed ? -1 : write_whole(head.data, head.size);
    recorder.length = (off_t)head.size;
    bytes_free(&head);
    return result;
}

int se3d_record_begin(const char *path)
{
    int result = -1;
    pthread_mutex_lock(&recorder.lock);
    if (path && !atomic_load(&recorder.active)) {
        recorder.file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        recorder.process = getpid();
        recorder.failed = 0;
        ++call_depth;
        result = recorder.file >= 0 ? write_head() : -1;
        --call_depth;
        if (result != 0 && recorder.file >= 0) {
            close(recorder.file);
        }
        atomic_store(&recorder.active, result == 0);
    }
    pthread_mutex_unlock(&recorder.lock);
    return result;
}

int se3d_record_end(void)
{
    int result = -1;
    pthread_mutex_lock(&recorder.lock);
    if (atomic_load(&recorder.active)) {
        atomic_store(&recorder.active, 0);
        result = close(recorder.file) == 0 && !recorder.failed ? 0 : -1;
        recorder.object_count = 0;
    }
    pthread_mutex_unlock(&recorder.lock);
    return result;
}

__attribute__((constructor)) static void begin_by_environment(void)
{
    const char *path = getenv("SE3D_RECORD");
    if (!dlsym(RTLD_NEXT, "se3d_version_get_text")) {
        return; /* a program that starts ours, or is started by it */
    }
    if (path && *path && se3d_record_begin(path) != 0) {
        fprintf(stderr, "se3d-record: %s cannot be written\n", path);
    }
}

/* ---- Names of objects and callbacks. ---- */

static object *find_object(size_t kind, const void *pointer)
{
    for (size_t k = recorder.object_count; k-- > 0;) {
        if (recorder.objects[k].pointer == pointer && recorder.objects[k].kind == kind) {
            return &recorder.objects[k];
        }
    }
    return NULL;
}

/* One more element at the end of an array; NULL: no memory. */
static void *append(void *array, size_t *count, size_t *capacity, size_t size)
{
    void **place = array;
    if (*count == *capacity) {
        void *more = realloc(*place, (2 * *capacity + 16) * size);
        if (!more) {
            give_up();
            return NULL;
        }
        *place = more;
        *capacity = 2 * *capacity + 16;
    }
    return (char *)*place + (*count)++ * size;
}

static uint32_t name_known(layout_walk *walk, size_t kind, const void *pointer)
{
    const object *found = find_object(kind, pointer);
    (void)walk;
    return !pointer ? FORMAT_NULL : found ? found->id : FORMAT_UNKNOWN;
}

static uint32_t name_new(layout_walk *walk, size_t kind, const void *pointer)
{
    const object *found = find_object(kind, pointer);
    (void)walk;
    if (pointer && !found) {
        object *o =
            append(&recorder.objects, &recorder.object_count, &recorder.object_capacity, sizeof *o);
        if (!o) {
            return FORMAT_UNKNOWN;
        }
        *o = (object){.pointer = pointer, .kind = kind, .id = ++recorder.next_object};
        found = o;
    }
    return pointer ? found->id : FORMAT_NULL;
}

static void forget_object(size_t kind, const void *pointer)
{
    object *found = find_object(kind, pointer);
    if (found) {
        *found = recorder.objects[--recorder.object_count];
    }
}

static const void *context_place(const layout_item *item, const void *base, int is_member)
{
    return is_member ? (const char *)base + item->partner : layout_parameter(base, item->partner);
}

/* The callback of ours that stands at `at`, NULL: it is none. */
static recorder_callback *ours(const layout_item *item, const void *at, const void *ctx_place)
{
    recorder_function function;
    void *ctx;
    memcpy(&function, at, sizeof function);
    memcpy(&ctx, ctx_place, sizeof ctx);
    return function == recorder_callbacks[item->number] ? ctx : NULL;
}

static uint32_t name_callback(layout_walk *walk, const layout_item *item, const void *at,
                              const void *base)
{
    const recorder_callback *callback = ours(item, at, context_place(item, base, walk->in_struct));
    return callback ? callback->id : FORMAT_NULL;
}

/* ---- Allocators of the host: which of their allocations fail is written. ---- */

typedef struct recorder_allocator { /* as long as the program */
    se3d_allocator mine, host;
    uint32_t id;
    atomic_ullong count;
} recorder_allocator;

static void *note_failure(recorder_allocator *a, uint64_t number, void *memory)
{
    if (!memory && !is_quiet && is_active()) {
        bytes content = {0};
        bytes_put_u32(&content, a->id);
        bytes_put_u64(&content, number);
        pthread_mutex_lock(&recorder.lock);
        write_piece(FORMAT_FAIL, &content);
        pthread_mutex_unlock(&recorder.lock);
        bytes_free(&content);
    }
    return memory;
}

static void *allocate(void *ctx, size_t size)
{
    recorder_allocator *a = ctx;
    const uint64_t number = atomic_fetch_add(&a->count, 1);
    return note_failure(a, number, a->host.alloc(a->host.ctx, size));
}

static void *reallocate(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    recorder_allocator *a = ctx;
    const uint64_t number = atomic_fetch_add(&a->count, 1);
    return note_failure(a, number, a->host.realloc(a->host.ctx, memory, old_size, new_size));
}

static void release(void *ctx, void *memory, size_t size)
{
    recorder_allocator *a = ctx;
    a->host.free(a->host.ctx, memory, size);
}

static uint32_t name_allocator(layout_walk *walk, const void *allocator)
{
    const se3d_allocator *a = allocator;
    (void)walk;
    return a && a->alloc == allocate ? ((const recorder_allocator *)a->ctx)->id : FORMAT_NULL;
}

/* Replace the allocator that `at` points to a pointer to; one that lacks a function is refused. */
static void replace_allocator(unsigned char *at)
{
    const se3d_allocator *host;
    memcpy(&host, at, sizeof host);
    recorder_allocator *a =
        host && host->alloc && host->realloc && host->free && host->alloc != allocate
            ? calloc(1, sizeof *a)
            : NULL;
    if (a) {
        a->mine = (se3d_allocator){allocate, reallocate, release, a};
        a->host = *host;
        a->id = ++recorder.next_callback;
        host = &a->mine;
        memcpy(at, &host, sizeof host);
    }
}

static uint64_t key_of(const void *key, size_t size)
{
    uint64_t value = 0;
    memcpy(&value, key, size < sizeof value ? size : sizeof value);
    return value;
}

static size_t recall(const layout_walk *walk, const void *key, size_t size)
{
    const uint64_t value = key_of(key, size);
    (void)walk;
    for (size_t k = recorder.memory_count; k-- > 0;) {
        if (recorder.memories[k].key == value) {
            return recorder.memories[k].count;
        }
    }
    return 1; /* of a text: the time */
}

static layout_walk walk_of(uint32_t (*name_owner)(layout_walk *, size_t, const void *))
{
    return (layout_walk){.name_owner = name_owner,
                         .name_callback = name_callback,
                         .name_allocator = name_allocator,
                         .recall = recall};
}

/* ---- Callbacks of ours in the place of the host's. ---- */

/* Replace the function at `at` and its context; `definition` is that which the callback keeps. */
static void replace(const layout_item *item, void *at, void *ctx_place, void *definition)
{
    recorder_function function;
    memcpy(&function, at, sizeof function);
    if (!function || ours(item, at, ctx_place)) {
        return;
    }
    recorder_callback *callback = malloc(sizeof *callback);
    if (!callback) {
        give_up();
        return;
    }
    *callback = (recorder_callback){.next = recorder.callbacks,
                                    .function = function,
                                    .definition = definition,
                                    .type = &layout_callbacks[item->number],
                                    .id = ++recorder.next_callback};
    memcpy(&callback->ctx, ctx_place, sizeof callback->ctx);
    recorder.callbacks = callback;
    memcpy(at, &recorder_callbacks[item->number], sizeof function);
    memcpy(ctx_place, &callback, sizeof callback);
}

static int has_callbacks(const layout_item *item)
{
    int found = 0;
    for (size_t k = 0; item->of && k < item->of->member_count; ++k) {
        found |= item->of->members[k].kind == LAYOUT_CALLBACK ||
                 item->of->members[k].kind == LAYOUT_ALLOCATOR;
    }
    return found;
}

/* Let the call see a copy of a definition with callbacks, which stays for them. */
static void replace_in_copy(const layout_item *item, void *argument)
{
    const unsigned char *original;
    memcpy(&original, argument, sizeof original);
    if (!original) {
        return;
    }
    const layout_struct *s = item->of;
    const size_t said = layout_said(s, original, s->size);
    unsigned char *copy = said <= s->size + 4096 ? calloc(1, said + s->size) : NULL;
    if (!copy) {
        return;
    }
    memcpy(copy, original, said);
    for (size_t k = 0; k < s->member_count; ++k) {
        const layout_item *member = &s->members[k];
        if (member->kind == LAYOUT_CALLBACK && layout_has(s, member, said)) {
            replace(member, copy + member->offset, copy + member->partner, copy);
        } else if (member->kind == LAYOUT_ALLOCATOR && layout_has(s, member, said)) {
            replace_allocator(copy + member->offset);
        }
    }
    memcpy(argument, &copy, sizeof copy);
}

static void replace_callbacks(const layout_function *f, void *const *arguments)
{
    for (size_t k = 0; k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        if (item->kind == LAYOUT_CALLBACK) {
            replace(item, arguments[k], arguments[item->partner], NULL);
        } else if (item->pointer && item->way == LAYOUT_IN && has_callbacks(item)) {
            replace_in_copy(item, arguments[k]);
        }
    }
}

/* What the library gives back is the host's again. */
static void restore_callbacks(const layout_item *item, void *argument)
{
    unsigned char *at;
    memcpy(&at, argument, sizeof at);
    for (size_t k = 0; at && has_callbacks(item) && k < item->of->member_count; ++k) {
        const layout_item *member = &item->of->members[k];
        if (member->kind == LAYOUT_CALLBACK &&
            layout_has(item->of, member, layout_said(item->of, at, item->of->size))) {
            recorder_callback *callback = ours(member, at + member->offset, at + member->partner);
            if (callback) {
                memcpy(at + member->offset, &callback->function, sizeof callback->function);
                memcpy(at + member->partner, &callback->ctx, sizeof callback->ctx);
            }
        }
    }
}

/* ---- Calls. ---- */

void recorder_find(const char *name, void *next, size_t size)
{
    void *symbol = dlsym(RTLD_NEXT, name);
    if (!symbol) {
        fprintf(stderr, "se3d-record: no library behind libse3d-record has %s\n", name);
        abort();
    }
    memcpy(next, &symbol, size);
}

void recorder_get(const recorder_callback *callback, void *host, size_t size)
{
    memcpy(host, &callback->function, size);
}

/* What a program made of a system is compared even if it looked at nothing. */
static void write_hash(const layout_function *f, void *const *arguments)
{
    const void *system = *(void *const *)arguments[0];
    const object *known = find_object(f->parameters[0].number, system);
    if (strcmp(f->name, "se3d_system_destroy") == 0 && callback_depth == 0 && known) {
        bytes content = {0};
        bytes_put_u32(&content, known->id);
        bytes_put_u64(&content, se3d_system_hash(system));
        write_piece(FORMAT_HASH, &content);
        bytes_free(&content);
    }
}

void recorder_enter(recorder_call *call, const layout_function *f, void *const *arguments)
{
    *call = (recorder_call){.depth = call_depth, .arguments = arguments};
    if (call_depth++ == 0 && !is_quiet && is_active()) {
        bytes content = {0};
        layout_walk walk = walk_of(name_known);
        call->function = f;
        is_quiet = 1;
        pthread_mutex_lock(&recorder.lock);
        replace_callbacks(f, arguments);
        bytes_put_u32(&content, (uint32_t)(f - layout_functions));
        layout_write_all(&walk, f, arguments, LAYOUT_IN, &content);
        if (f->destroys) {
            write_hash(f, arguments);
        }
        write_piece(FORMAT_CALL, &content);
        if (f->destroys && callback_depth == 0) { /* its address may be used anew at once */
            forget_object(f->parameters[0].number, *(void *const *)arguments[0]);
        }
        pthread_mutex_unlock(&recorder.lock);
        is_quiet = 0;
        bytes_free(&content);
    }
}

static void remember(const layout_function *f, const layout_walk *walk, void *const *arguments)
{
    for (size_t k = 0; f->remembers && k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        const void *pointer = item->way == LAYOUT_OUT ? *(void *const *)arguments[k] : NULL;
        if (pointer && (item->kind == LAYOUT_HANDLE || item->kind == LAYOUT_OWNER)) {
            variables *m = append(&recorder.memories, &recorder.memory_count,
                                  &recorder.memory_capacity, sizeof *m);
            if (m) {
                *m = (variables){.key = key_of(pointer, item->size),
                                 .count = f->remembers(walk, arguments)};
            }
        }
    }
}

static int has_failed(const layout_function *f, const void *result)
{
    return f->has_status && *(const se3d_status *)result < 0;
}

void recorder_leave(recorder_call *call, const void *result)
{
    const layout_function *f = call->function;
    if (f) {
        bytes content = {0};
        layout_walk walk = walk_of(name_new);
        is_quiet = 1;
        pthread_mutex_lock(&recorder.lock);
        if (f->result) {
            layout_write(&walk, f->result, result, call->arguments, &content);
        }
        if (!has_failed(f, result)) {
            layout_write_all(&walk, f, call->arguments, LAYOUT_OUT, &content);
            remember(f, &walk, call->arguments);
        }
        for (size_t k = 0; k < f->parameter_count; ++k) {
            if (f->parameters[k].pointer && f->parameters[k].way != LAYOUT_IN) {
                restore_callbacks(&f->parameters[k], call->arguments[k]);
            }
        }
        write_piece(FORMAT_RETURN, &content);
        pthread_mutex_unlock(&recorder.lock);
        is_quiet = 0;
        bytes_free(&content);
    }
    call_depth = call->depth;
}

void recorder_callback_enter(recorder_answer *answer, recorder_callback *callback,
                             void *const *arguments)
{
    *answer = (recorder_answer){.depth = call_depth, .arguments = arguments};
    if (is_quiet || !is_active()) {
        return;
    }
    bytes content = {0};
    layout_walk walk = walk_of(name_known);
    walk.definition = callback->definition;
    walk.without_handles = 1;
    pthread_mutex_lock(&recorder.lock);
    layout_write_all(&walk, callback->type, arguments, LAYOUT_IN, &content);
    answer->callback = callback;
    answer->hash = bytes_hash(content.data, content.size);
    content.size = 0;
    bytes_put_u32(&content, callback->id);
    bytes_put_u64(&content, answer->hash);
    if (!callback->type->is_concurrent) {
        write_piece(FORMAT_CALLBACK, &content);
    }
    pthread_mutex_unlock(&recorder.lock);
    bytes_free(&content);
    call_depth = callback->type->is_concurrent;
    ++callback_depth;
}

void recorder_callback_leave(recorder_answer *answer, const void *result)
{
    call_depth = answer->depth;
    if (!answer->callback) {
        return;
    }
    bytes content = {0};
    layout_walk walk = walk_of(name_known);
    walk.definition = answer->callback->definition;
    walk.is_whole = 1;
    --callback_depth;
    bytes_put_u32(&content, answer->callback->id);
    bytes_put_u64(&content, answer->hash);
    if (result) {
        layout_write(&walk, answer->callback->type->result, result, answer->arguments, &content);
    }
    pthread_mutex_lock(&recorder.lock);
    layout_write_all(&walk, answer->callback->type, answer->arguments, LAYOUT_OUT, &content);
    write_piece(FORMAT_ANSWER, &content);
    pthread_mutex_unlock(&recorder.lock);
    bytes_free(&content);
}

void recorder_note(const char *name, int ends)
{
    if (call_depth == 0 && is_active()) {
        bytes content = {0};
        bytes_put_u8(&content, (unsigned)ends);
        put_name(&content, name);
        pthread_mutex_lock(&recorder.lock);
        write_piece(FORMAT_NOTE, &content);
        pthread_mutex_unlock(&recorder.lock);
        bytes_free(&content);
    }
}
