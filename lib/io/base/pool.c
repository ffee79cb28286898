/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of one model: blocks in a list, cut from the front; nothing is given back before the end.
 */
#include "io/base/pool.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

struct se3di_iopool_block {
    struct se3di_iopool_block *next;
    size_t size; /* of the whole block */
    size_t used; /* from the start of the block */
};

static const size_t block_size = 32768;

static void *malloc_alloc(void *ctx, size_t size)
{
    (void)ctx;
    return malloc(size);
}

static void *malloc_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    (void)ctx;
    (void)old_size;
    return realloc(memory, new_size);
}

static void malloc_free(void *ctx, void *memory, size_t size)
{
    (void)ctx;
    (void)size;
    free(memory);
}

void se3di_iopool_init(se3di_iopool *pool, const se3d_allocator *allocator)
{
    const se3d_allocator standard = {malloc_alloc, malloc_realloc, malloc_free, NULL};
    pool->allocator = allocator ? *allocator : standard;
    pool->blocks = NULL;
    pool->is_short = false;
}

void se3di_iopool_destroy(se3di_iopool *pool)
{
    while (pool->blocks) {
        struct se3di_iopool_block *block = pool->blocks;
        pool->blocks = block->next;
        pool->allocator.free(pool->allocator.ctx, block, block->size);
    }
}

const se3d_allocator *se3di_iopool_lend(const se3di_iopool *pool)
{
    return pool->allocator.alloc == malloc_alloc ? NULL : &pool->allocator;
}

static size_t round_up(size_t size)
{
    const size_t unit = _Alignof(max_align_t);
    return (size + unit - 1) / unit * unit;
}

static void *refuse(se3di_iopool *pool)
{
    pool->is_short = true;
    return NULL;
}

void *se3di_iopool_take(se3di_iopool *pool, size_t size)
{
    struct se3di_iopool_block *block = pool->blocks;
    const size_t head = round_up(sizeof *block);
    if (size > SIZE_MAX / 2) {
        return refuse(pool);
    }
    size = round_up(size ? size : 1);
    if (!block || block->size - block->used < size) {
        const size_t total = head + size > block_size ? head + size : block_size;
        struct se3di_iopool_block *added = pool->allocator.alloc(pool->allocator.ctx, total);
        if (!added) {
            return refuse(pool);
        }
        added->size = total;
        added->used = head;
        added->next = block;
        pool->blocks = block = added;
    }
    void *memory = (char *)block + block->used;
    block->used += size;
    return memory;
}

void *se3di_iopool_alloc(se3di_iopool *pool, size_t size)
{
    void *memory = se3di_iopool_take(pool, size);
    return memory ? memset(memory, 0, size) : NULL;
}

void *se3di_iopool_array(se3di_iopool *pool, size_t count, size_t size)
{
    return count > SIZE_MAX / 2 / size ? refuse(pool) : se3di_iopool_alloc(pool, count * size);
}

char *se3di_iopool_copy(se3di_iopool *pool, const char *text, size_t length)
{
    char *copy = se3di_iopool_take(pool, length + 1);
    if (copy && length > 0) {
        memcpy(copy, text, length);
    }
    if (copy) {
        copy[length] = '\0';
    }
    return copy;
}

void *se3di_iopool_grow(se3di_iopool *pool, void *array, size_t count, size_t *capacity,
                        size_t size)
{
    if (count < *capacity) {
        return array;
    }
    const size_t larger = *capacity ? *capacity * 2 : 8;
    void *grown = se3di_iopool_array(pool, larger, size);
    if (grown) {
        if (count > 0) {
            memcpy(grown, array, count * size);
        }
        *capacity = larger;
    }
    return grown;
}

bool se3di_iobytes_put(se3di_iobytes *bytes, se3di_iopool *pool, const void *data, size_t size)
{
    if (size == 0) {
        return true;
    }
    if (size > bytes->capacity - bytes->count) {
        const size_t capacity = 2 * (bytes->count + size) + 64;
        unsigned char *grown = se3di_iopool_take(pool, capacity);
        if (!grown) {
            return false;
        }
        if (bytes->count > 0) {
            memcpy(grown, bytes->data, bytes->count);
        }
        bytes->data = grown;
        bytes->capacity = capacity;
    }
    memcpy(bytes->data + bytes->count, data, size);
    bytes->count += size;
    return true;
}

bool se3di_iotext_put(se3di_iotext *t, se3di_iopool *pool, const char *text)
{
    const size_t length = strlen(text);
    se3di_iobytes bytes = {(unsigned char *)t->text, t->used, t->room};
    if (!se3di_iobytes_put(&bytes, pool, text,
                           length + 1)) { /* with its zero, which is written over */
        return false;
    }
    t->text = (char *)bytes.data;
    t->room = bytes.capacity;
    t->used += length;
    const char *line = strrchr(text, '\n');
    t->column = line ? strlen(line + 1) : t->column + length;
    return true;
}

static size_t name_hash(const char *name)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (const char *c = name; *c; ++c) {
        hash = (hash ^ (unsigned char)*c) * UINT64_C(1099511628211);
    }
    return (size_t)hash;
}

/* The entry of `name`, or the free one where it belongs; capacity > count. */
static struct se3di_ionames_entry *name_slot(const se3di_ionames *names, const char *name)
{
    size_t k = name_hash(name) & (names->capacity - 1);
    while (names->entries[k].name && strcmp(names->entries[k].name, name) != 0) {
        k = (k + 1) & (names->capacity - 1);
    }
    return &names->entries[k];
}

bool se3di_ionames_add(se3di_ionames *names, se3di_iopool *pool, const char *name, size_t index)
{
    if (names->count * 2 >= names->capacity) {
        se3di_ionames larger = {0};
        larger.capacity = names->capacity ? names->capacity * 2 : 16;
        larger.entries = se3di_iopool_array(pool, larger.capacity, sizeof *larger.entries);
        if (!larger.entries) {
            return false;
        }
        for (size_t k = 0; k < names->capacity; ++k) {
            if (names->entries[k].name) {
                *name_slot(&larger, names->entries[k].name) = names->entries[k];
            }
        }
        names->entries = larger.entries;
        names->capacity = larger.capacity;
    }
    struct se3di_ionames_entry *slot = name_slot(names, name);
    slot->name = name;
    slot->index = index;
    ++names->count;
    return true;
}

bool se3di_ionames_find(const se3di_ionames *names, const char *name, size_t *index)
{
    if (names->capacity == 0) {
        return false;
    }
    const struct se3di_ionames_entry *slot = name_slot(names, name);
    if (slot->name && index) {
        *index = slot->index;
    }
    return slot->name != NULL;
}
