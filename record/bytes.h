/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytes that grow as they are written, and a reader that does not go beyond their end. */
#ifndef SE3D_RECORD_BYTES_H
#define SE3D_RECORD_BYTES_H

#include <stddef.h>
#include <stdint.h>

typedef struct bytes {
    unsigned char *data;
    size_t size, capacity;
    int failed; /* no memory */
} bytes;

void bytes_free(bytes *b);
void bytes_put(bytes *b, const void *data, size_t size);
void bytes_put_u8(bytes *b, unsigned value);
void bytes_put_u32(bytes *b, uint32_t value);
void bytes_put_u64(bytes *b, uint64_t value);

typedef struct bytes_reader {
    const unsigned char *at, *end;
    int failed; /* it ended too early, or a number was out of range */
} bytes_reader;

/* The next `size` bytes; NULL and failed if there are not so many. */
const unsigned char *bytes_get(bytes_reader *r, size_t size);
unsigned bytes_get_u8(bytes_reader *r);
uint32_t bytes_get_u32(bytes_reader *r);
uint64_t bytes_get_u64(bytes_reader *r);

uint64_t bytes_hash(const void *data, size_t size);

#endif
