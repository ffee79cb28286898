/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytes packed by Deflate (RFC 1951), and the checksum that archives keep of them. */
#ifndef SE3D_IO_INFLATE_H
#define SE3D_IO_INFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* No packed byte makes more bytes than this. */
enum { SE3DI_INFLATE_MOST = 1032 };

/* Unpack exactly `size` bytes from exactly `packed_size`. @return false: the bytes are damaged, or
 * make more or fewer. Nothing is read or written beyond the arrays. */
bool se3di_inflate(const unsigned char *packed, size_t packed_size, unsigned char *bytes,
                   size_t size);
/* CRC-32 of ISO 3309, reflected polynomial 0xedb88320. */
uint32_t se3di_crc32(const unsigned char *bytes, size_t size);

#endif
