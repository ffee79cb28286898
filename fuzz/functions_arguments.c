/* SPDX-License-Identifier: BSD-3-Clause */
/* Arguments, good and bad, by the layout of a parameter: numbers that are not, are huge or are
 * tiny, handles of nothing, of what is gone and of another system, sizes of other versions. Memory
 * and objects are there, as the library may ask for that. */
#include "functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "se3d/se3d.h"

enum { OUTPUT_MOST = 1 << 18, NESTED_MOST = 3 };

typedef struct context { /* of a callback */
    functions *of;
    const layout_function *type;
    const void *definition;
} context;

static void make_items(functions *f, const layout_item *items, size_t count, void *const *places,
                       unsigned char *structure, size_t depth);

/* ------------------------------------------------------------------ values */

static double make_real(functions *f)
{
    static const double good[] = {1.0, 0.5, 0.0, 2.0, 0.1, -1.0, 1e-3, 0.02, 1000.0, 3.0};
    static const double bad[] = {
        (double)NAN, (double)INFINITY, -(double)INFINITY, 1e308, -1e308, 5e-324, -0.0, 1e16,
        1e-16,       -1e-300};
    const unsigned b = functions_byte(f);
    return b < 225 ? good[b % 10] : bad[b % 10];
}

static void make_integer(functions *f, const layout_item *item, void *at)
{
    static const int64_t good[] = {0, 1, 2, 3, 1, 4, 6, 8},
                         bad[] = {-1,        INT32_MAX, INT32_MIN, INT64_MAX,
                                  INT64_MIN, 100,       1000000,   255};
    const unsigned b = functions_byte(f);
    const int64_t value = b < 225 ? good[b % 8] : bad[b % 8];
    if (item->size == 4) {
        const int32_t narrow = value > INT32_MAX   ? INT32_MAX
                               : value < INT32_MIN ? INT32_MIN
                                                   : (int32_t)value;
        memcpy(at, &narrow, sizeof narrow);
    } else if (item->size == 8) {
        memcpy(at, &value, sizeof value);
    } else {
        memset(at, (int)value, item->size);
    }
}

static const char *make_text(functions *f)
{
    static const char *const texts[] = {
        "a", "b",         "t",    "2*t",   "sin(3*t)",    "x + t",  "",  "x",
        "y", "1/(t - t)", "\xff", "a.b.c", "1e999*t + (", "ground", "0", "c"};
    static const size_t count = sizeof texts / sizeof *texts;
    const unsigned b = functions_byte(f);
    if (b == 255) {
        char *text = functions_take(f, 2000);
        memset(text, 'a', 1999);
        return text;
    }
    return b < 200 ? texts[b % count] : NULL;
}

static void make_handle(functions *f, const layout_item *item, void *at)
{
    const size_t kind = item->number % FUNCTIONS_KINDS, made = f->handle_count[kind];
    const unsigned b = functions_byte(f);
    uint64_t bits = 0;
    if (b >= 250) { /* of another kind, or of nothing */
        bits = b & 1 ? f->handles[b % 7][0] : (uint64_t)functions_byte(f) << 32 | functions_byte(f);
    } else if (b < 235 && made > 0) {
        bits = f->handles[kind][b % (made < FUNCTIONS_KEPT ? made : FUNCTIONS_KEPT)];
    }
    memcpy(at, &bits, sizeof bits);
}

static void *find_object(functions *f, size_t kind)
{
    void *found[FUNCTIONS_OBJECTS];
    size_t count = 0;
    for (size_t k = 0; k < f->object_count; ++k) {
        if (f->objects[k].lives && f->objects[k].kind == kind) {
            found[count++] = f->objects[k].pointer;
        }
    }
    const unsigned b = functions_byte(f);
    return count > 0 && b < 250 ? found[b % count] : NULL;
}

/* ------------------------------------------------------------------ callbacks and memory */

static void *take(void *ctx, size_t size)
{
    functions *f = ctx;
    void *memory = f->allocations == 0 ? NULL : malloc(size);
    f->allocations -= f->allocations >= 0;
    f->live += memory != NULL;
    return memory;
}

static void *retake(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    functions *f = ctx;
    void *grown = f->allocations == 0 ? NULL : realloc(memory, new_size);
    (void)old_size;
    f->allocations -= f->allocations >= 0;
    f->live += grown != NULL && memory == NULL;
    return grown;
}

static void give(void *ctx, void *memory, size_t size)
{
    functions *f = ctx;
    (void)size;
    f->live -= memory != NULL;
    free(memory);
}

const se3d_allocator *functions_allocator(functions *f)
{
    se3d_allocator *mine = functions_take(f, sizeof *mine);
    *mine = (se3d_allocator){take, retake, give, f};
    return mine;
}

static int is_interrupt(const layout_item *item)
{
    return strcmp(layout_callbacks[item->number].name, "se3d_interrupt") == 0;
}

static void make_callback(functions *f, const layout_item *item, void *at, unsigned char *structure,
                          void *const *places)
{
    player_function function = player_answers[item->number];
    context *c = functions_take(f, sizeof *c);
    *c = (context){f, &layout_callbacks[item->number], structure};
    const int often = !f->is_other_version && functions_byte(f) < 40;
    if (!often && !is_interrupt(item)) {
        function = NULL;
    }
    memcpy(at, &function, sizeof function);
    void *partner = structure ? structure + item->partner : places[item->partner];
    memcpy(partner, &c, sizeof(void *));
}

/* Outputs of a callback; those of several threads do not take from the input. */
static void answer_output(functions *f, const layout_function *type, const layout_item *item,
                          unsigned char *to, size_t count)
{
    if (item->kind == LAYOUT_BYTES && item->is_real) {
        for (size_t k = 0; k < count; ++k) {
            const double value = type->is_concurrent ? 0.25 : make_real(f);
            memcpy(to + k * sizeof value, &value, sizeof value);
        }
    } else if (item->kind == LAYOUT_BYTES) {
        memset(to, 0, layout_times(count, item->size));
    }
}

void player_answer(void *ctx, void *const *arguments, void *result)
{
    const context *c = ctx;
    functions *f = c->of;
    f->walk.definition = c->definition;
    for (size_t k = 0; k < c->type->parameter_count; ++k) {
        const layout_item *item = &c->type->parameters[k];
        unsigned char *to = NULL;
        if (item->pointer && item->way == LAYOUT_OUT) {
            memcpy(&to, arguments[k], sizeof to);
        }
        if (to) {
            answer_output(f, c->type, item, to, layout_count(&f->walk, item, arguments, 0));
        }
    }
    if (strcmp(c->type->name, "se3d_interrupt") == 0) {
        const int stops = --f->left.left < 0;
        memcpy(result, &stops, sizeof stops);
    } else if (!c->type->is_concurrent) {
        const unsigned b = functions_byte(f);
        const int32_t wrong[] = {SE3D_ERR_CALLBACK, 77, -1000, 1};
        if (result && c->type->has_status && b >= 240) {
            memcpy(result, &wrong[b % 4], sizeof wrong[0]);
        }
        if (b % 16 == 5 && f->depth < 2) {
            ++f->depth;
            functions_call(f);
            --f->depth;
        }
    }
}

/* ------------------------------------------------------------------ structures and arrays */

/* Bytes of a structure of another version follow it, as zeros or not. */
static unsigned char *make_struct(functions *f, const layout_item *item, size_t depth)
{
    const layout_struct *s = item->of;
    unsigned char *at = functions_take(f, 2 * s->size);
    char name[100];
    snprintf(name, sizeof name, "%s_init", s->name);
    const size_t init = layout_find(name);
    size_t size = s->size;
    if (init < layout_function_count) {
        void *arguments[] = {&at, &size};
        player_calls[init](arguments, NULL);
    } else if (s->is_sized) {
        memcpy(at, &size, sizeof size);
    }
    const unsigned b = functions_byte(f);
    f->is_other_version = s->is_sized && b >= 240; /* members that count may not be seen */
    if (depth < NESTED_MOST) {
        make_items(f, s->members, s->member_count, NULL, at, depth + 1);
    }
    f->is_other_version = 0;
    const size_t sizes[] = {0, 7, s->size - 8, s->size + 8, 2 * s->size, SIZE_MAX};
    if (s->is_sized && b >= 240) {
        memcpy(at, &sizes[b % 6], sizeof size);
        at[s->size] = b & 8 ? 1 : 0;
    } else if (s->is_sized) {
        memcpy(at, &size, sizeof size);
    }
    return at;
}

/* One element. */
static void make_element(functions *f, const layout_item *item, unsigned char *at,
                         unsigned char *structure, void *const *places, size_t depth)
{
    const void *pointer = NULL;
    switch (item->kind) {
    case LAYOUT_BYTES:
        if (item->is_real) {
            const double value = make_real(f);
            memcpy(at, &value, sizeof value);
        } else {
            make_integer(f, item, at);
        }
        break;
    case LAYOUT_TEXT:
        pointer = make_text(f);
        memcpy(at, &pointer, sizeof pointer);
        break;
    case LAYOUT_CHARACTERS:
        memset(at, 'a', item->size / 2);
        break;
    case LAYOUT_HANDLE:
        make_handle(f, item, at);
        break;
    case LAYOUT_OWNER:
        pointer = find_object(f, item->number);
        memcpy(at, &pointer, sizeof pointer);
        break;
    case LAYOUT_STRUCT:
        if (depth < NESTED_MOST) {
            make_items(f, item->of->members, item->of->member_count, NULL, at, depth + 1);
        }
        break;
    case LAYOUT_CALLBACK:
        make_callback(f, item, at, structure, places);
        break;
    case LAYOUT_ALLOCATOR:
        pointer = functions_allocator(f);
        memcpy(at, &pointer, sizeof pointer);
        break;
    case LAYOUT_CONTEXT:
        break;
    }
}

/* An array that goes in, or room for one that comes out. */
static void make_pointer(functions *f, const layout_item *item, unsigned char *at, const void *base,
                         unsigned char *structure, size_t depth)
{
    const int goes_in = !item->way || item->way & LAYOUT_IN;
    const size_t count = layout_count(&f->walk, item, base, 1);
    const size_t stride = layout_stride(&f->walk, item, base);
    unsigned char *made = NULL;
    if (functions_byte(f) >= 250 || count > (goes_in ? FUNCTIONS_LONGEST : OUTPUT_MOST) ||
        layout_times(count, stride) > OUTPUT_MOST) {
        memset(at, 0, sizeof(void *)); /* none, or more than there is */
        return;
    }
    if (item->kind == LAYOUT_STRUCT && goes_in && count <= 1 && !item->stride) {
        made = make_struct(f, item, depth);
    } else {
        made = functions_take(f, count * stride);
        for (size_t k = 0; goes_in && k < count; ++k) {
            make_element(f, item, made + k * stride, structure, NULL, depth);
        }
    }
    memcpy(at, &made, sizeof made);
}

static int keeps_default(functions *f, const layout_item *item, const unsigned char *structure)
{
    return structure && item->kind != LAYOUT_HANDLE && item->kind != LAYOUT_CALLBACK &&
           functions_byte(f) < 130;
}

/* Parameters of a call at `places`, or members of a structure: first what tells lengths. */
static void make_items(functions *f, const layout_item *items, size_t count, void *const *places,
                       unsigned char *structure, size_t depth)
{
    for (int pointers = 0; pointers < 2; ++pointers) {
        for (size_t k = 0; k < count; ++k) {
            const layout_item *item = &items[k];
            unsigned char *at = structure ? structure + item->offset : places[k];
            if ((item->pointer != 0) != pointers || item->kind == LAYOUT_CONTEXT ||
                strcmp(item->name, "struct_size") == 0) {
                continue;
            }
            if (pointers) {
                make_pointer(f, item, at, structure ? (const void *)structure : places, structure,
                             depth);
            } else if (!keeps_default(f, item, structure)) {
                for (size_t n = 0; n < item->count; ++n) {
                    make_element(f, item, at + n * item->size, structure, places, depth);
                }
            }
        }
    }
}

void functions_make_arguments(functions *f, const layout_function *call, void **arguments)
{
    for (size_t k = 0; k < call->parameter_count; ++k) {
        const layout_item *item = &call->parameters[k];
        arguments[k] = functions_take(f, item->pointer ? sizeof(void *) : item->size * item->count);
    }
    make_items(f, call->parameters, call->parameter_count, arguments, NULL, 0);
}
