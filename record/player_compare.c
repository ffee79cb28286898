/* SPDX-License-Identifier: BSD-3-Clause */
/* What a call returned and gave, beside what it did when it was recorded. */
#include <stdio.h>
#include <string.h>

#include "player_parts.h"
#include "se3d/se3d.h"

/* Of a handle, which ends with 12 bits that differ from system to system and run to run; systems
 * that followed each other at one address had the same. */
#define UNSALTED 0x000fffffffffffffu

/* What is compared, for messages. */
typedef struct subject {
    const char *outer, *name; /* the parameter, NULL; the member or parameter */
    size_t index;
} subject;

static int compare_item(stage *s, const layout_item *item, const unsigned char *at,
                        const void *base, const char *outer, bytes_reader *r);

static int cut(stage *s)
{
    return stage_end(s, PLAYER_MALFORMED, "the recording is damaged here");
}

static int differs(stage *s, subject what, const char *now, const char *then)
{
    char name[160];
    snprintf(name, sizeof name, "%s%s%s[%zu]", what.outer ? what.outer : "", what.outer ? "." : "",
             what.name, what.index);
    return s->options->is_free
               ? 0
               : stage_end(s, PLAYER_DIFFERS, "%s is %s, and %s when recorded", name, now, then);
}

static void print_number(const layout_item *item, const unsigned char *at, char *text, size_t size)
{
    double real = 0.0;
    uint64_t whole = 0;
    if (item->is_real) {
        memcpy(&real, at, sizeof real);
        snprintf(text, size, "%.17g", real);
    } else if (item->size == 4) {
        int32_t value;
        memcpy(&value, at, sizeof value);
        snprintf(text, size, "%d", (int)value);
    } else {
        memcpy(&whole, at, item->size < sizeof whole ? item->size : sizeof whole);
        snprintf(text, size, "%llu", (unsigned long long)whole);
    }
}

static int compare_numbers(stage *s, const layout_item *item, const unsigned char *at, size_t count,
                           const char *outer, bytes_reader *r)
{
    const unsigned form = item->pointer ? bytes_get_u8(r) : 0;
    const size_t all = layout_times(count, item->size);
    const unsigned char *from = form == 0 ? bytes_get(r, all) : NULL;
    if (form == 1) {
        const uint64_t then = bytes_get_u64(r);
        return then != bytes_hash(at, all) && !r->failed
                   ? differs(s, (subject){outer, item->name, 0}, "another array",
                             "one of another hash")
                   : 0;
    }
    if (!from) {
        return cut(s);
    }
    for (size_t k = 0; k < count; ++k) {
        if (memcmp(from + k * item->size, at + k * item->size, item->size) != 0) {
            char now[40], then[40];
            print_number(item, at + k * item->size, now, sizeof now);
            print_number(item, from + k * item->size, then, sizeof then);
            return differs(s, (subject){outer, item->name, k}, now, then);
        }
    }
    return 0;
}

static int compare_text(stage *s, subject what, const char *now, size_t length, int is_null,
                        bytes_reader *r)
{
    const uint32_t size = bytes_get_u32(r);
    const int was_null = size == UINT32_MAX;
    const unsigned char *from = bytes_get(r, was_null ? 0 : size);
    if (r->failed) {
        return cut(s);
    }
    if (was_null != is_null || (!is_null && (size != length || memcmp(from, now, length) != 0))) {
        char then[160], text[160];
        snprintf(then, sizeof then, "\"%.*s\"", was_null ? 0 : (int)(size < 150 ? size : 150),
                 (const char *)from);
        snprintf(text, sizeof text, "\"%.*s\"", (int)(length < 150 ? length : 150),
                 is_null ? "" : now);
        return differs(s, what, text, then);
    }
    return 0;
}

static int compare_handle(stage *s, const layout_item *item, subject what, const unsigned char *at,
                          bytes_reader *r)
{
    const unsigned char *from = bytes_get(r, item->size);
    uint64_t then = 0, now = 0;
    if (!from) {
        return cut(s);
    }
    memcpy(&then, from, sizeof then);
    memcpy(&now, at, sizeof now);
    if ((then == 0) != (now == 0) || ((then ^ now) & UNSALTED) != 0) {
        const int result = differs(s, what, "another handle", "one of another element");
        if (result != 0) {
            return result;
        }
    }
    if (then != 0 && map_set(&s->handle_of[item->number], then, now) != 0) {
        return stage_end(s, PLAYER_NO_MEMORY, "out of memory");
    }
    return 0;
}

static int compare_owner(stage *s, const layout_item *item, subject what, const unsigned char *at,
                         bytes_reader *r)
{
    const uint32_t id = bytes_get_u32(r);
    void *now;
    memcpy(&now, at, sizeof now);
    if (r->failed) {
        return cut(s);
    }
    if ((id == FORMAT_NULL) != (now == NULL)) {
        return differs(s, what, now ? "an object" : "none", now ? "none" : "an object");
    }
    return now ? stage_bind(s, id, item->number, now, s->parent) : 0;
}

static int compare_struct(stage *s, const layout_item *item, const unsigned char *at, size_t stride,
                          bytes_reader *r)
{
    const layout_struct *of = item->of;
    bytes_get_u64(r);
    const uint32_t count = bytes_get_u32(r);
    if (r->failed || count > of->member_count) {
        return cut(s);
    }
    for (uint32_t k = 0; k < count; ++k) {
        const layout_item *member = &of->members[k];
        if (!layout_has(of, member, stride)) {
            return differs(s, (subject){item->name, member->name, 0}, "left out", "there");
        }
        if (compare_item(s, member, at + member->offset, at, item->name, r) != 0) {
            return -1;
        }
    }
    return 0;
}

static int compare_element(stage *s, const layout_item *item, subject what, const unsigned char *at,
                           size_t stride, bytes_reader *r)
{
    const char *text = NULL;
    switch (item->kind) {
    case LAYOUT_TEXT:
        memcpy(&text, at, sizeof text);
        return compare_text(s, what, text, text ? strlen(text) : 0, !text, r);
    case LAYOUT_CHARACTERS:
        text = (const char *)at;
        return compare_text(s, what, text, layout_characters(text, item->size), 0, r);
    case LAYOUT_HANDLE:
        return compare_handle(s, item, what, at, r);
    case LAYOUT_OWNER:
        return compare_owner(s, item, what, at, r);
    case LAYOUT_STRUCT:
        return compare_struct(s, item, at, stride, r);
    case LAYOUT_CALLBACK:
    case LAYOUT_ALLOCATOR:
        bytes_get_u32(r);
        return r->failed ? cut(s) : 0;
    case LAYOUT_BYTES:
    case LAYOUT_CONTEXT:
        break;
    }
    return 0;
}

static int compare_elements(stage *s, const layout_item *item, const unsigned char *at,
                            size_t count, const void *base, const char *outer, bytes_reader *r)
{
    if (item->kind == LAYOUT_BYTES) {
        return compare_numbers(s, item, at, count, outer, r);
    }
    const size_t stride = layout_stride(&s->walk, item, base);
    for (size_t k = 0; k < count; ++k) {
        const size_t said = item->of ? layout_said(item->of, at + k * stride, stride) : 0;
        if (compare_element(s, item, (subject){outer, item->name, k}, at + k * stride, said, r) !=
            0) {
            return -1;
        }
    }
    return 0;
}

static int compare_item(stage *s, const layout_item *item, const unsigned char *at,
                        const void *base, const char *outer, bytes_reader *r)
{
    if (!item->pointer) {
        return compare_elements(s, item, at, item->count, base, outer, r);
    }
    const unsigned char *pointer;
    memcpy(&pointer, at, sizeof pointer);
    const unsigned was_there = bytes_get_u8(r);
    if (r->failed || (was_there != 0) != (pointer != NULL)) {
        return cut(s);
    }
    if (!pointer) {
        return 0;
    }
    const size_t count = layout_count(&s->walk, item, base, 0);
    const uint64_t then = bytes_get_u64(r);
    if (r->failed) {
        return cut(s);
    }
    if (then != count) {
        char texts[2][32];
        snprintf(texts[0], sizeof texts[0], "%zu long", count);
        snprintf(texts[1], sizeof texts[1], "%llu", (unsigned long long)then);
        return s->options->is_free
                   ? 1
                   : differs(s, (subject){outer, item->name, 0}, texts[0], texts[1]);
    }
    return compare_elements(s, item, pointer, count, base, outer, r);
}

int player_bind_all(stage *s, const layout_function *f, const player_arguments *a)
{
    for (size_t k = 0; k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        void **place, *pointer;
        memcpy(&place, a->slots[k], sizeof place);
        if (item->kind == LAYOUT_OWNER && item->pointer && place) {
            memcpy(&pointer, place, sizeof pointer);
            if (pointer && stage_bind(s, FORMAT_UNKNOWN, item->number, pointer, s->parent) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

static void remember(stage *s, const layout_function *f, const player_arguments *a)
{
    for (size_t k = 0; f->remembers && k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        const unsigned char *place;
        uint64_t key = 0;
        memcpy(&place, a->slots[k], sizeof place);
        if (item->way == LAYOUT_OUT && place &&
            (item->kind == LAYOUT_HANDLE || item->kind == LAYOUT_OWNER)) {
            memcpy(&key, place, sizeof key);
            map_set(&s->variables_of, key, f->remembers(&s->walk, a->at));
        }
    }
}

static int compare_outputs(stage *s, const layout_function *f, player_arguments *a, bytes_reader *r)
{
    for (size_t k = 0; k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        if (item->way & LAYOUT_OUT) {
            const int result = compare_item(s, item, a->slots[k], a->at, NULL, r);
            if (result != 0) {
                return result;
            }
        }
    }
    return 0;
}

int player_compare(stage *s, const layout_function *f, player_arguments *a, bytes_reader *r)
{
    int32_t then = 0, now = 0;
    int result = 0;
    s->is_quiet = 1;
    if (f->has_status) {
        bytes_reader ahead = *r;
        then = (int32_t)bytes_get_u32(&ahead);
        memcpy(&now, a->result, sizeof now);
        if (now >= 0) {
            remember(s, f, a);
        }
    }
    if (f->has_status && then != now && !s->options->is_free) {
        result = stage_end(s, PLAYER_DIFFERS, "it returned %d (%s), and %d (%s) when recorded",
                           (int)now, se3d_status_get_text((se3d_status)now), (int)then,
                           se3d_status_get_text((se3d_status)then));
    } else if (f->result) {
        result = compare_item(s, f->result, a->result, a->at, NULL, r);
    }
    if (result == 0 && now >= 0 && then >= 0) {
        result = compare_outputs(s, f, a, r);
    }
    if (player_bind_all(s, f, a) != 0) {
        result = -1;
    }
    s->is_quiet = 0;
    return result < 0 ? -1 : 0;
}
