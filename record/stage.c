/* SPDX-License-Identifier: BSD-3-Clause */
#include "stage.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t recall(const layout_walk *walk, const void *key, size_t size)
{
    const stage *s = (const stage *)walk;
    uint64_t value = 0;
    memcpy(&value, key, size < sizeof value ? size : sizeof value);
    const uint64_t *found = map_find(&s->variables_of, value);
    return found ? (size_t)*found : 1;
}

static uint32_t name_owner(layout_walk *walk, size_t kind, const void *pointer)
{
    const stage_object *o = stage_find_pointer((stage *)walk, kind, pointer);
    return !pointer ? FORMAT_NULL : o ? o->id : FORMAT_UNKNOWN;
}

/* Callbacks are given no callbacks and no allocators. */
static uint32_t name_callback(layout_walk *walk, const layout_item *item, const void *at,
                              const void *base)
{
    (void)walk, (void)item, (void)at, (void)base;
    return FORMAT_NULL;
}

static uint32_t name_allocator(layout_walk *walk, const void *allocator)
{
    (void)walk, (void)allocator;
    return FORMAT_NULL;
}

void stage_init(stage *s, const player_options *options, player_report *report)
{
    memset(s, 0, sizeof *s);
    s->walk = (layout_walk){.name_owner = name_owner,
                            .name_callback = name_callback,
                            .name_allocator = name_allocator,
                            .recall = recall,
                            .without_handles = 1};
    s->options = options;
    s->report = report;
    s->at = SCORE_NONE;
    atomic_flag_clear(&s->locked);
}

int stage_end(stage *s, player_verdict verdict, const char *format, ...)
{
    if (s->verdict == PLAYER_SAME) {
        va_list list;
        va_start(list, format);
        vsnprintf(s->report->message, sizeof s->report->message, format, list);
        va_end(list);
        s->verdict = verdict;
        s->report->number = s->number;
        s->report->name = s->name;
    }
    return -1;
}

void *stage_take(stage *s, size_t size, int is_whole)
{
    stage_block **list = is_whole ? &s->whole : &s->part;
    const size_t largest = s->options->largest > 0 ? s->options->largest : (size_t)1 << 28;
    if (size > largest) {
        stage_end(s, PLAYER_MALFORMED, "an argument has %zu bytes, at most %zu", size, largest);
        return NULL;
    }
    stage_block *block = calloc(1, sizeof *block + size);
    if (!block) {
        stage_end(s, PLAYER_NO_MEMORY, "out of memory");
        return NULL;
    }
    block->next = *list;
    *list = block;
    return block->data;
}

void stage_release(stage_block **blocks)
{
    while (*blocks) {
        stage_block *next = (*blocks)->next;
        free(*blocks);
        *blocks = next;
    }
}

/* ---- Objects. ---- */

stage_object *stage_find(stage *s, uint32_t id)
{
    const uint64_t *index = map_find(&s->object_of, id);
    return index ? &s->objects[*index] : NULL;
}

stage_object *stage_find_pointer(stage *s, size_t kind, const void *pointer)
{
    for (size_t k = s->object_count; pointer && k-- > 0;) {
        stage_object *o = &s->objects[k];
        if (o->pointer == pointer && o->kind == kind && o->lives) {
            return o;
        }
    }
    return NULL;
}

size_t stage_index(const stage *s, const stage_object *object)
{
    return object ? (size_t)(object - s->objects) + 1 : 0;
}

static stage_object *add_object(stage *s)
{
    if (s->object_count == s->object_capacity) {
        const size_t capacity = 2 * s->object_capacity + 16;
        stage_object *more = realloc(s->objects, capacity * sizeof *more);
        if (!more) {
            stage_end(s, PLAYER_NO_MEMORY, "out of memory");
            return NULL;
        }
        s->objects = more;
        s->object_capacity = capacity;
    }
    return &s->objects[s->object_count++];
}

int stage_bind(stage *s, uint32_t id, size_t kind, void *pointer, size_t parent)
{
    const int is_named = id != FORMAT_UNKNOWN && id != FORMAT_NULL;
    stage_object *o = stage_find_pointer(s, kind, pointer);
    if (o && (!is_named || o->id == id)) {
        return 0;
    }
    if (o) {
        return stage_end(s, PLAYER_DIFFERS, "it gave object %u, and %u when recorded",
                         (unsigned)o->id, (unsigned)id);
    }
    o = add_object(s);
    if (!o) {
        return -1;
    }
    *o = (stage_object){pointer, kind, parent, 1, is_named ? id : FORMAT_UNKNOWN};
    if (is_named && map_set(&s->object_of, id, s->object_count - 1) != 0) {
        return stage_end(s, PLAYER_NO_MEMORY, "out of memory");
    }
    return 0;
}

static int is_kind(const stage_object *o, const char *name)
{
    return strcmp(layout_owners[o->kind], name) == 0;
}

void stage_kill(stage *s, stage_object *object)
{
    object->lives = 0;
    for (size_t k = 0; k < s->object_count; ++k) { /* a system takes its particles with it */
        stage_object *o = &s->objects[k];
        if (o->parent == stage_index(s, object) && is_kind(o, "se3d_particles") &&
            is_kind(object, "se3d_system")) {
            o->lives = 0;
        }
    }
}

/* The function that destroys objects of a kind. */
static size_t destroyer_of(size_t kind)
{
    size_t k = 0;
    while (k < layout_function_count &&
           !(layout_functions[k].destroys && layout_functions[k].parameters[0].number == kind)) {
        ++k;
    }
    return k;
}

static void destroy_all(stage *s, int systems)
{
    for (size_t k = s->object_count; k-- > 0;) {
        stage_object *o = &s->objects[k];
        const size_t f = destroyer_of(o->kind);
        if (o->lives && is_kind(o, "se3d_system") == systems && f < layout_function_count) {
            void *arguments[] = {&o->pointer};
            player_calls[f](arguments, NULL);
            stage_kill(s, o);
        }
    }
}

void stage_clear(stage *s)
{
    s->is_quiet = 1;
    destroy_all(s, 0);
    destroy_all(s, 1);
    free(s->objects);
    free(s->checks);
    map_free(&s->object_of);
    for (size_t k = 0; k < STAGE_HANDLE_KINDS; ++k) {
        map_free(&s->handle_of[k]);
    }
    map_free(&s->variables_of);
    map_free(&s->callback_of);
    stage_release(&s->whole);
    stage_release(&s->part);
    score_free(&s->score);
}

stage_callback *stage_add_callback(stage *s, uint32_t id, const layout_item *item,
                                   const void *definition)
{
    if (map_find(&s->callback_of, id)) {
        stage_end(s, PLAYER_MALFORMED, "callback %u is there already", (unsigned)id);
        return NULL;
    }
    stage_callback *c = stage_take(s, sizeof *c, 1);
    if (!c) {
        return NULL;
    }
    *c = (stage_callback){s, &layout_callbacks[item->number], definition, id, SCORE_NONE};
    if (map_set(&s->callback_of, id, (uint64_t)(uintptr_t)c) != 0) {
        stage_end(s, PLAYER_NO_MEMORY, "out of memory");
        return NULL;
    }
    return c;
}

typedef struct stage_allocator {
    se3d_allocator functions;
    const stage *of;
    uint32_t id;
    atomic_ullong count;
} stage_allocator;

static int fails(stage_allocator *a)
{
    return map_find(&a->of->score.failures, score_key(a->id, atomic_fetch_add(&a->count, 1))) !=
           NULL;
}

static void *allocate(void *ctx, size_t size)
{
    return fails(ctx) ? NULL : malloc(size);
}

static void *reallocate(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    (void)old_size;
    return fails(ctx) ? NULL : realloc(memory, new_size);
}

static void release(void *ctx, void *memory, size_t size)
{
    (void)ctx, (void)size;
    free(memory);
}

const se3d_allocator *stage_add_allocator(stage *s, uint32_t id)
{
    stage_allocator *a = stage_take(s, sizeof *a, 1);
    if (a) {
        a->functions = (se3d_allocator){allocate, reallocate, release, a};
        a->of = s;
        a->id = id;
    }
    return a ? &a->functions : NULL;
}
