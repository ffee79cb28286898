/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments from the bytes of a recording. */
#include <stdlib.h>
#include <string.h>

#include "player_parts.h"
#include "se3d/se3d.h"

#define GROWTH 4096 /* bytes by which a structure of a later version may be larger */

static int read_item(stage *s, const layout_item *item, unsigned char *at, player_place place,
                     bytes_reader *r);

static int missing(stage *s, const char *what, unsigned id)
{
    if (s->options->is_free) {
        s->is_missing = 1;
        return -1;
    }
    return stage_end(s, PLAYER_MALFORMED, "no call gave %s %u, or it was destroyed", what, id);
}

static int check_reader(stage *s, const bytes_reader *r)
{
    return r->failed ? stage_end(s, PLAYER_MALFORMED, "the recording is damaged here") : 0;
}

static int read_text(stage *s, unsigned char *to, player_place place, bytes_reader *r)
{
    const uint32_t length = bytes_get_u32(r);
    char *text = NULL;
    if (length != UINT32_MAX) {
        const unsigned char *from = bytes_get(r, length);
        text = from ? stage_take(s, (size_t)length + 1, place.is_whole) : NULL;
        if (!text) {
            check_reader(s, r);
            return -1;
        }
        memcpy(text, from, length);
    }
    memcpy(to, &text, sizeof text);
    return check_reader(s, r);
}

static int read_handle(stage *s, const layout_item *item, unsigned char *to, bytes_reader *r)
{
    const unsigned char *from = bytes_get(r, item->size);
    uint64_t bits = 0;
    if (!from) {
        return check_reader(s, r);
    }
    memcpy(&bits, from, sizeof bits);
    const uint64_t *now = map_find(&s->handle_of[item->number], bits);
    memcpy(to, now ? now : &bits, sizeof bits);
    return 0;
}

static int read_owner(stage *s, const layout_item *item, unsigned char *to, bytes_reader *r)
{
    const uint32_t id = bytes_get_u32(r);
    const stage_object *o = id == FORMAT_NULL ? NULL : stage_find(s, id);
    if (check_reader(s, r) != 0) {
        return -1;
    }
    if (id != FORMAT_NULL && (!o || !o->lives || o->kind != item->number)) {
        return missing(s, layout_owners[item->number], (unsigned)id);
    }
    void *pointer = o ? o->pointer : NULL;
    memcpy(to, &pointer, sizeof pointer);
    return 0;
}

/* Bytes of memory for a structure that says it has `said`. */
static size_t room_of(const layout_struct *of, uint64_t said)
{
    return said > of->size && said <= of->size + GROWTH ? (size_t)said : of->size;
}

static int read_struct(stage *s, const layout_struct *of, unsigned char *to, player_place place,
                       bytes_reader *r)
{
    const uint64_t said = bytes_get_u64(r);
    const uint32_t count = bytes_get_u32(r);
    if (check_reader(s, r) != 0) {
        return -1;
    }
    if (count > of->member_count ||
        (count > 0 && !layout_has(of, &of->members[count - 1], (size_t)said))) {
        return stage_end(s, PLAYER_MALFORMED, "%s has more members than its size", of->name);
    }
    place.base = to;
    place.is_member = 1;
    for (uint32_t k = 0; k < count; ++k) {
        if (read_item(s, &of->members[k], to + of->members[k].offset, place, r) != 0) {
            return -1;
        }
    }
    if (of->is_sized && layout_said(of, to, of->size) != said) {
        return stage_end(s, PLAYER_MALFORMED, "%s says two sizes", of->name);
    }
    return 0;
}

static int read_callback(stage *s, const layout_item *item, unsigned char *to, player_place place,
                         bytes_reader *r)
{
    uint32_t id = bytes_get_u32(r);
    const int asks = s->options->interrupts > 0 &&
                     strcmp(layout_callbacks[item->number].name, "se3d_interrupt") == 0;
    if (check_reader(s, r) != 0 || (id == FORMAT_NULL && !asks)) {
        return r->failed ? -1 : 0;
    }
    if (id == FORMAT_NULL || id == FORMAT_UNKNOWN) { /* ours, which limits the work */
        s->interrupter =
            (stage_callback){s, &layout_callbacks[item->number], NULL, FORMAT_UNKNOWN, SCORE_NONE};
    }
    stage_callback *c = id == FORMAT_NULL || id == FORMAT_UNKNOWN
                            ? &s->interrupter
                            : stage_add_callback(s, id, item, place.is_member ? place.base : NULL);
    if (!c) {
        return -1;
    }
    unsigned char *ctx = place.is_member ? place.base + item->partner
                                         : ((unsigned char **)(void *)place.base)[item->partner];
    memcpy(to, &player_answers[item->number], sizeof player_answers[item->number]);
    memcpy(ctx, &c, sizeof c);
    return 0;
}

/* In the place of the host's: allocations fail that failed. */
static int read_allocator(stage *s, unsigned char *to, bytes_reader *r)
{
    const uint32_t id = bytes_get_u32(r);
    const se3d_allocator *allocator = NULL;
    if (id != FORMAT_NULL && !r->failed) {
        allocator = stage_add_allocator(s, id);
        if (!allocator) {
            return -1;
        }
    }
    memcpy(to, &allocator, sizeof allocator);
    return check_reader(s, r);
}

static int read_characters(stage *s, const layout_item *item, unsigned char *to, bytes_reader *r)
{
    const uint32_t length = bytes_get_u32(r);
    const unsigned char *from = bytes_get(r, length);
    if (!from || length > item->size) {
        return stage_end(s, PLAYER_MALFORMED, "`%s` is too long", item->name);
    }
    memcpy(to, from, length);
    return 0;
}

static int read_element(stage *s, const layout_item *item, unsigned char *to, player_place place,
                        bytes_reader *r)
{
    switch (item->kind) {
    case LAYOUT_TEXT:
        return read_text(s, to, place, r);
    case LAYOUT_CHARACTERS:
        return read_characters(s, item, to, r);
    case LAYOUT_HANDLE:
        return read_handle(s, item, to, r);
    case LAYOUT_OWNER:
        return read_owner(s, item, to, r);
    case LAYOUT_STRUCT:
        return read_struct(s, item->of, to, place, r);
    case LAYOUT_CALLBACK:
        return read_callback(s, item, to, place, r);
    case LAYOUT_ALLOCATOR:
        return read_allocator(s, to, r);
    case LAYOUT_BYTES:
    case LAYOUT_CONTEXT:
        break;
    }
    return 0;
}

static int read_elements(stage *s, const layout_item *item, unsigned char *to, size_t count,
                         player_place place, bytes_reader *r)
{
    if (item->kind == LAYOUT_BYTES) {
        const unsigned form = item->pointer ? bytes_get_u8(r) : 0;
        const unsigned char *from = bytes_get(r, layout_times(count, item->size));
        if (!from || form != 0) {
            return stage_end(s, PLAYER_MALFORMED, "the recording is damaged here");
        }
        memcpy(to, from, count * item->size);
        return 0;
    }
    for (size_t k = 0; k < count; ++k) {
        if (read_element(s, item, to + k * item->size, place, r) != 0) {
            return -1;
        }
    }
    return 0;
}

static int has_callback(const layout_struct *of)
{
    int found = 0;
    for (size_t k = 0; of && k < of->member_count; ++k) {
        found |= of->members[k].kind == LAYOUT_CALLBACK;
    }
    return found;
}

/* Lengths follow from other values, which may come later: they are checked at the end. */
static int check_later(stage *s, const layout_item *item, const void *base, size_t count)
{
    if (s->check_count == s->check_capacity) {
        const size_t capacity = 2 * s->check_capacity + 16;
        stage_check *more = realloc(s->checks, capacity * sizeof *more);
        if (!more) {
            return stage_end(s, PLAYER_NO_MEMORY, "out of memory");
        }
        s->checks = more;
        s->check_capacity = capacity;
    }
    s->checks[s->check_count++] = (stage_check){item, base, count};
    return 0;
}

static int read_pointer(stage *s, const layout_item *item, unsigned char *at, player_place place,
                        bytes_reader *r)
{
    const unsigned is_there = bytes_get_u8(r);
    if (!is_there || r->failed) {
        return check_reader(s, r);
    }
    const uint64_t count = bytes_get_u64(r);
    bytes_reader ahead = *r;
    size_t size = layout_times((size_t)count, item->size);
    if (r->failed || count > (uint64_t)(r->end - r->at)) {
        return stage_end(s, PLAYER_MALFORMED, "`%s` goes beyond the recording", item->name);
    }
    if (item->kind == LAYOUT_STRUCT && count == 1) {
        size = room_of(item->of, bytes_get_u64(&ahead));
    }
    place.is_whole |= has_callback(item->of);
    unsigned char *memory = stage_take(s, size, place.is_whole);
    if (!memory || check_later(s, item, place.base, (size_t)count) != 0) {
        return -1;
    }
    memcpy(at, &memory, sizeof memory);
    return read_elements(s, item, memory, (size_t)count, place, r);
}

static int read_item(stage *s, const layout_item *item, unsigned char *at, player_place place,
                     bytes_reader *r)
{
    return item->pointer ? read_pointer(s, item, at, place, r)
                         : read_elements(s, item, at, item->count, place, r);
}

/* Whether an output is wanted, and how large its structure says it is: until its memory is there
 * the slot holds a mark, and the size behind it. */
static int read_wish(stage *s, const layout_item *item, unsigned char *slot, bytes_reader *r)
{
    const uint64_t is_there = bytes_get_u8(r);
    uint64_t said = 0;
    if (is_there && item->kind == LAYOUT_STRUCT && item->of->is_sized && !item->stride) {
        said = bytes_get_u64(r);
    }
    memcpy(slot, &is_there, sizeof is_there);
    memcpy(slot + sizeof is_there, &said, sizeof said);
    return check_reader(s, r);
}

/* Only functions without a result take any size that they are told. */
static int make_room(stage *s, const layout_item *item, int takes_any, unsigned char *slot,
                     const void *base)
{
    uint64_t is_there, said;
    memcpy(&is_there, slot, sizeof is_there);
    memcpy(&said, slot + sizeof is_there, sizeof said);
    if (!is_there) {
        return 0;
    }
    const size_t count = layout_count(&s->walk, item, base, 1);
    size_t stride = layout_stride(&s->walk, item, base);
    if (item->kind == LAYOUT_STRUCT) {
        stride = item->stride ? (takes_any || stride <= item->size + GROWTH ? stride : item->size)
                              : room_of(item->of, said);
    }
    unsigned char *memory = stage_take(s, layout_times(count, stride), 0);
    if (!memory) {
        return -1;
    }
    if (item->kind == LAYOUT_STRUCT && item->of->is_sized && !item->stride) {
        memcpy(memory, &said, sizeof said);
    }
    memcpy(slot, &memory, sizeof memory);
    return 0;
}

static int run_checks(stage *s)
{
    for (size_t k = 0; k < s->check_count; ++k) {
        const stage_check *c = &s->checks[k];
        if (layout_count(&s->walk, c->item, c->base, 0) != c->count) {
            return s->options->is_free
                       ? missing(s, "array", 0)
                       : stage_end(s, PLAYER_MALFORMED, "`%s` has %zu elements, which is wrong",
                                   c->item->name, c->count);
        }
    }
    return 0;
}

int player_read_arguments(stage *s, const layout_function *f, player_arguments *a, bytes_reader *r)
{
    const player_place place = {(unsigned char *)a->at, 0, 0};
    int result = 0;
    s->is_missing = 0;
    s->check_count = 0;
    memset(a, 0, sizeof *a);
    for (size_t k = 0; k < f->parameter_count; ++k) {
        a->at[k] = a->slots[k];
    }
    for (size_t k = 0; k < f->parameter_count && result == 0; ++k) {
        const layout_item *item = &f->parameters[k];
        result = item->way & LAYOUT_IN ? read_item(s, item, a->slots[k], place, r)
                                       : read_wish(s, item, a->slots[k], r);
    }
    s->is_quiet = 1;
    result = result == 0 ? run_checks(s) : result;
    for (size_t k = 0; k < f->parameter_count && result == 0; ++k) {
        if (!(f->parameters[k].way & LAYOUT_IN)) {
            result = make_room(s, &f->parameters[k], !f->result, a->slots[k], a->at);
        }
    }
    s->is_quiet = 0;
    return result;
}
