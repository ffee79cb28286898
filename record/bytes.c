/* SPDX-License-Identifier: BSD-3-Clause */
#include "bytes.h"

#include <stdlib.h>
#include <string.h>

void bytes_free(bytes *b)
{
    free(b->data);
    memset(b, 0, sizeof *b);
}

static int reserve(bytes *b, size_t more)
{
    if (b->failed || more > SIZE_MAX / 2 - b->size) {
        b->failed = 1;
        return 0;
    }
    if (b->size + more > b->capacity) {
        size_t capacity = 2 * (b->size + more) + 64;
        unsigned char *data = realloc(b->data, capacity);
        if (!data) {
            b->failed = 1;
            return 0;
        }
        b->data = data;
        b->capacity = capacity;
    }
    return 1;
}

void bytes_put(bytes *b, const void *data, size_t size)
{
    if (size > 0 && reserve(b, size)) {
        memcpy(b->data + b->size, data, size);
        b->size += size;
    }
}

static void put_number(bytes *b, uint64_t value, size_t size)
{
    unsigned char data[8];
    for (size_t k = 0; k < size; ++k) {
        data[k] = (unsigned char)(value >> (8 * k));
    }
    bytes_put(b, data, size);
}

void bytes_put_u8(bytes *b, unsigned value)
{
    put_number(b, value, 1);
}

void bytes_put_u32(bytes *b, uint32_t value)
{
    put_number(b, value, 4);
}

void bytes_put_u64(bytes *b, uint64_t value)
{
    put_number(b, value, 8);
}

const unsigned char *bytes_get(bytes_reader *r, size_t size)
{
    const unsigned char *at = r->at;
    if (r->failed || size > (size_t)(r->end - r->at)) {
        r->failed = 1;
        return NULL;
    }
    r->at += size;
    return at;
}

static uint64_t get_number(bytes_reader *r, size_t size)
{
    const unsigned char *data = bytes_get(r, size);
    uint64_t value = 0;
    for (size_t k = 0; data && k < size; ++k) {
        value |= (uint64_t)data[k] << (8 * k);
    }
    return value;
}

unsigned bytes_get_u8(bytes_reader *r)
{
    return (unsigned)get_number(r, 1);
}

uint32_t bytes_get_u32(bytes_reader *r)
{
    return (uint32_t)get_number(r, 4);
}

uint64_t bytes_get_u64(bytes_reader *r)
{
    return get_number(r, 8);
}

uint64_t bytes_hash(const void *data, size_t size)
{
    const unsigned char *at = data;
    uint64_t hash = 14695981039346656037u; /* FNV-1a */
    for (size_t k = 0; k < size; ++k) {
        hash = (hash ^ at[k]) * 1099511628211u;
    }
    return hash;
}
