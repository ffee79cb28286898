/* SPDX-License-Identifier: BSD-3-Clause */
#include "layout.h"

#include <string.h>

#include "se3d/se3d.h"

#define SHORT_FORM 512 /* bytes of an output beyond which its hash is kept */

size_t layout_find(const char *name)
{
    size_t k = 0;
    while (k < layout_function_count && strcmp(layout_functions[k].name, name) != 0) {
        ++k;
    }
    return k;
}

size_t layout_times(size_t a, size_t b)
{
    return b != 0 && a > SIZE_MAX / b ? SIZE_MAX : a * b;
}

size_t layout_at_most(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t layout_characters(const char *text, size_t size)
{
    const char *end = text ? memchr(text, '\0', size) : NULL;
    return end ? (size_t)(end - text) : text ? size : 0;
}

size_t layout_equations(const void *system, const void *constraint)
{
    se3d_constraint c;
    size_t count = 0;
    memcpy(&c, constraint, sizeof c);
    return SE3D_FAILED(se3d_constraint_count_equations(system, c, &count)) ? 0 : count;
}

size_t layout_recall(const layout_walk *walk, const void *key, size_t size)
{
    return walk->recall ? walk->recall(walk, key, size) : 1;
}

const void *layout_parameter(const void *base, size_t n)
{
    return ((void *const *)base)[n];
}

size_t layout_count(const layout_walk *walk, const layout_item *item, const void *base, int before)
{
    layout_length length = before && item->room ? item->room : item->length;
    return length ? length(walk, base) : item->count;
}

size_t layout_stride(const layout_walk *walk, const layout_item *item, const void *base)
{
    return item->stride ? item->stride(walk, base) : item->size;
}

int layout_has(const layout_struct *s, const layout_item *member, size_t size)
{
    const size_t whole =
        member->pointer ? sizeof(void *) : layout_times(member->size, member->count);
    return size >= s->size || member->offset + whole <= size;
}

size_t layout_said(const layout_struct *s, const void *structure, size_t stride)
{
    size_t size = stride;
    if (s->is_sized && stride >= sizeof size) {
        memcpy(&size, structure, sizeof size);
        size = size < sizeof size ? sizeof size : size;
    }
    return size;
}

static void write_text(const char *text, bytes *out)
{
    const size_t length = text ? strlen(text) : 0;
    bytes_put_u32(out, text ? (uint32_t)length : UINT32_MAX);
    bytes_put(out, text, length);
}

static void write_struct(layout_walk *walk, const layout_struct *s, const unsigned char *at,
                         size_t stride, bytes *out)
{
    const size_t said = layout_said(s, at, stride);
    uint32_t count = 0;
    bytes_put_u64(out, said);
    while (count < s->member_count && layout_has(s, &s->members[count], said)) {
        ++count;
    }
    bytes_put_u32(out, count);
    const int outside = walk->in_struct;
    walk->in_struct = 1;
    for (uint32_t k = 0; k < count; ++k) {
        layout_write(walk, &s->members[k], at + s->members[k].offset, at, out);
    }
    walk->in_struct = outside;
}

/* One element that is no number. */
static void write_element(layout_walk *walk, const layout_item *item, const unsigned char *at,
                          const void *base, size_t stride, bytes *out)
{
    const void *pointer = NULL;
    switch (item->kind) {
    case LAYOUT_TEXT:
        memcpy(&pointer, at, sizeof pointer);
        write_text(pointer, out);
        break;
    case LAYOUT_CHARACTERS:
        bytes_put_u32(out, (uint32_t)layout_characters((const char *)at, item->size));
        bytes_put(out, at, layout_characters((const char *)at, item->size));
        break;
    case LAYOUT_HANDLE:
        bytes_put(out, at, walk->without_handles ? 0 : item->size);
        break;
    case LAYOUT_OWNER:
        memcpy(&pointer, at, sizeof pointer);
        bytes_put_u32(out, walk->name_owner(walk, item->number, pointer));
        break;
    case LAYOUT_STRUCT:
        write_struct(walk, item->of, at, stride, out);
        break;
    case LAYOUT_CALLBACK:
        bytes_put_u32(out, walk->name_callback(walk, item, at, base));
        break;
    case LAYOUT_ALLOCATOR:
        memcpy(&pointer, at, sizeof pointer);
        bytes_put_u32(out, walk->name_allocator(walk, pointer));
        break;
    case LAYOUT_BYTES:
    case LAYOUT_CONTEXT:
        break;
    }
}

static void write_elements(layout_walk *walk, const layout_item *item, const unsigned char *at,
                           const void *base, size_t count, bytes *out)
{
    const size_t stride = layout_stride(walk, item, base), all = layout_times(count, item->size);
    if (item->kind != LAYOUT_BYTES) {
        for (size_t k = 0; k < count; ++k) {
            write_element(walk, item, at + k * stride, base, stride, out);
        }
    } else if (!item->pointer) {
        bytes_put(out, at, all);
    } else if (walk->short_form && all > SHORT_FORM) {
        bytes_put_u8(out, 1);
        bytes_put_u64(out, bytes_hash(at, all));
    } else {
        bytes_put_u8(out, 0);
        bytes_put(out, at, all);
    }
}

void layout_write(layout_walk *walk, const layout_item *item, const void *at, const void *base,
                  bytes *out)
{
    if (!item->pointer) {
        write_elements(walk, item, at, base, item->count, out);
        return;
    }
    const unsigned char *pointer = NULL;
    memcpy(&pointer, at, sizeof pointer);
    bytes_put_u8(out, pointer != NULL);
    if (pointer) {
        const size_t count = layout_count(walk, item, base, 0);
        bytes_put_u64(out, count);
        write_elements(walk, item, pointer, base, count, out);
    }
}

/* Of an output only whether it is wanted, and how large its structure says it is. */
static void write_wish(const layout_item *item, const void *at, bytes *out)
{
    const unsigned char *pointer = NULL;
    memcpy(&pointer, at, sizeof pointer);
    bytes_put_u8(out, pointer != NULL);
    if (pointer && item->kind == LAYOUT_STRUCT && item->of->is_sized && !item->stride) {
        bytes_put_u64(out, layout_said(item->of, pointer, item->size));
    }
}

void layout_write_all(layout_walk *walk, const layout_function *f, void *const *arguments,
                      layout_way way, bytes *out)
{
    walk->short_form = way == LAYOUT_OUT && !walk->is_whole;
    for (size_t k = 0; k < f->parameter_count; ++k) {
        const layout_item *item = &f->parameters[k];
        if (item->way & way) {
            layout_write(walk, item, arguments[k], arguments, out);
        } else if (way == LAYOUT_IN) {
            write_wish(item, arguments[k], out);
        }
    }
}
