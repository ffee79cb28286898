/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of one model: blocks that live until the model is destroyed, from its allocator. */
#ifndef SE3D_IO_POOL_H
#define SE3D_IO_POOL_H

#include <stdbool.h>

#include "se3d/base.h"

/* Lets the compiler check the arguments of a function that takes a format. */
#if defined(__GNUC__)
#define SE3DI_IO_FORMAT(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define SE3DI_IO_FORMAT(text, first)
#endif

typedef struct se3di_iopool {
    se3d_allocator allocator;
    struct se3di_iopool_block *blocks;
    bool is_short; /* memory was refused: what was made since may lack something */
} se3di_iopool;

/* `allocator` NULL: malloc. */
void se3di_iopool_init(se3di_iopool *pool, const se3d_allocator *allocator);
void se3di_iopool_destroy(se3di_iopool *pool);
/* The allocator for what libse3d makes: NULL, its own, where both would call malloc. */
const se3d_allocator *se3di_iopool_lend(const se3di_iopool *pool);
/* Memory that is not zeroed, aligned as malloc's; NULL when there is none. Of a large block only
 * what is written costs anything. */
void *se3di_iopool_take(se3di_iopool *pool, size_t size);
/* Zeroed memory; NULL when there is none. */
void *se3di_iopool_alloc(se3di_iopool *pool, size_t size);
/* Zeroed array; NULL when there is none or count * size overflows. */
void *se3di_iopool_array(se3di_iopool *pool, size_t count, size_t size);
char *se3di_iopool_copy(se3di_iopool *pool, const char *text, size_t length);
/* Return `array` (of *capacity elements) or a larger copy of it, with room for count + 1. */
void *se3di_iopool_grow(se3di_iopool *pool, void *array, size_t count, size_t *capacity,
                        size_t size);

/* A text that grows at its end. */
typedef struct se3di_iotext {
    char *text; /* ends with a zero; NULL: nothing yet */
    size_t used, room;
    size_t column; /* after the last line break */
} se3di_iotext;

/* @return false: no memory, nothing changed. */
bool se3di_iotext_put(se3di_iotext *t, se3di_iopool *pool, const char *text);

/* Bytes that grow in a pool. */
typedef struct se3di_iobytes {
    unsigned char *data;
    size_t count, capacity;
} se3di_iobytes;

/* Append bytes. @return false: no memory, nothing changed. */
bool se3di_iobytes_put(se3di_iobytes *bytes, se3di_iopool *pool, const void *data, size_t size);

/* Names to indices: open addressing over texts that the caller keeps. */
typedef struct se3di_ionames {
    struct se3di_ionames_entry {
        const char *name;
        size_t index;
    } * entries;
    size_t capacity; /* 0 or a power of two */
    size_t count;
} se3di_ionames;

/* Add a name that is not there yet. @return false: out of memory. */
bool se3di_ionames_add(se3di_ionames *names, se3di_iopool *pool, const char *name, size_t index);
bool se3di_ionames_find(const se3di_ionames *names, const char *name, size_t *index);

#endif
