/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/counting.h"

#include <stdlib.h>
#include <string.h>

/* Before every block: its size, in the room of the strictest alignment. */
typedef union header {
    size_t size;
    max_align_t align;
} header;

static int fails(support_counting *counting)
{
    ++counting->calls;
    int hit = counting->fail_at > 0 && (counting->for_ever ? counting->calls >= counting->fail_at
                                                           : counting->calls == counting->fail_at);
    if (counting->seed) {
        counting->seed = counting->seed * UINT64_C(6364136223846793005) + 1442695040888963407U;
        hit = (counting->seed >> 33) % counting->one_in == 0;
    }
    counting->failed += hit ? 1 : 0;
    return hit;
}

static void *counting_alloc(void *ctx, size_t size)
{
    support_counting *counting = ctx;
    header *block = fails(counting) ? NULL : malloc(sizeof *block + size);
    if (!block) {
        return NULL;
    }
    block->size = size;
    ++counting->live;
    counting->bytes += size;
    memset(block + 1, 0xA5, size); /* nobody may rely on zeros */
    return block + 1;
}

static void counting_free(void *ctx, void *memory, size_t size)
{
    support_counting *counting = ctx;
    if (memory) {
        header *block = (header *)memory - 1;
        counting->wrong += block->size != size ? 1 : 0;
        --counting->live;
        counting->bytes -= block->size;
        memset(memory, 0x5A, block->size);
        free(block);
    }
}

static void *counting_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    void *copy = counting_alloc(ctx, new_size);
    if (copy && memory) {
        memcpy(copy, memory, old_size < new_size ? old_size : new_size);
        counting_free(ctx, memory, old_size);
    }
    return copy;
}

se3d_allocator support_counting_allocator(support_counting *counting)
{
    return (se3d_allocator){.alloc = counting_alloc,
                            .realloc = counting_realloc,
                            .free = counting_free,
                            .ctx = counting};
}
