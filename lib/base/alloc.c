/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

static void *default_alloc(void *ctx, size_t size)
{
    (void)ctx;
    return malloc(size);
}

static void *default_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    (void)ctx;
    (void)old_size;
    return realloc(memory, new_size);
}

static void default_free(void *ctx, void *memory, size_t size)
{
    (void)ctx;
    (void)size;
    free(memory);
}

se3d_allocator se3di_alloc_default(void)
{
    return (se3d_allocator){default_alloc, default_realloc, default_free, NULL};
}

void *se3di_alloc(const se3d_allocator *allocator, size_t count, size_t size)
{
    if (size != 0 && count > SIZE_MAX / size) {
        return NULL;
    }
    /* An empty array still gets an address, so that NULL always means failure. */
    size_t bytes = count * size > 0 ? count * size : 1;
    void *memory = allocator->alloc(allocator->ctx, bytes);
    if (memory) {
        memset(memory, 0, bytes);
    }
    return memory;
}

void se3di_free(const se3d_allocator *allocator, void *memory, size_t count, size_t size)
{
    if (memory) {
        allocator->free(allocator->ctx, memory, count * size > 0 ? count * size : 1);
    }
}

se3d_status se3di_array_reserve(const se3d_allocator *allocator, void **data, size_t *capacity,
                                size_t needed, size_t size)
{
    if (needed <= *capacity) {
        return SE3D_OK;
    }
    size_t grown = *capacity + *capacity / 2 + 4;
    if (grown < needed) {
        grown = needed;
    }
    if (grown > SIZE_MAX / size) {
        return SE3D_ERR_NO_MEMORY;
    }
    void *memory = *data ? allocator->realloc(allocator->ctx, *data, *capacity * size, grown * size)
                         : allocator->alloc(allocator->ctx, grown * size);
    if (!memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    memset((char *)memory + *capacity * size, 0, (grown - *capacity) * size);
    *data = memory;
    *capacity = grown;
    return SE3D_OK;
}

se3d_status se3di_array_reserve_at(const se3d_allocator *allocator, void *place, size_t *capacity,
                                   size_t needed, size_t size)
{
    void *data;
    memcpy(&data, place, sizeof data);
    const se3d_status status = se3di_array_reserve(allocator, &data, capacity, needed, size);
    memcpy(place, &data, sizeof data);
    return status;
}

se3d_status se3di_arrays_alloc(const se3d_allocator *allocator, const se3di_array *list, int count)
{
    for (int k = 0; k < count; ++k) {
        *list[k].data = se3di_alloc(allocator, list[k].count, list[k].size);
        if (!*list[k].data) {
            return SE3D_ERR_NO_MEMORY;
        }
    }
    return SE3D_OK;
}

void se3di_arrays_free(const se3d_allocator *allocator, const se3di_array *list, int count)
{
    for (int k = 0; k < count; ++k) {
        se3di_free(allocator, *list[k].data, list[k].count, list[k].size);
        *list[k].data = NULL;
    }
}

char *se3di_text_copy(const se3d_allocator *allocator, const char *text)
{
    size_t length = strlen(text) + 1;
    char *copy = se3di_alloc(allocator, length, 1);
    if (copy) {
        memcpy(copy, text, length);
    }
    return copy;
}

void se3di_text_free(const se3d_allocator *allocator, char *text)
{
    if (text) {
        se3di_free(allocator, text, strlen(text) + 1, 1);
    }
}
