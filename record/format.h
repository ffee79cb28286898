/* SPDX-License-Identifier: BSD-3-Clause */
/* The format of a recording. Numbers are little-endian.
 *
 *     "se3drec1"                              8 bytes
 *     version of the library                  u32 length, text
 *     number of functions, names              u32, each u32 length, text
 *     pieces                                  u32 length, u32 thread, u8 kind, content
 *
 * The content of a piece:
 *
 *     CALL      u32 function, parameters that go in
 *     RETURN    result, parameters that come out
 *     CALLBACK  u32 callback object, u64 hash of what it is given
 *     ANSWER    u32 callback object, u64 the same hash, result, what it gives
 *     FAIL      u32 allocator, u64 which of its allocations failed, from 0
 *     HASH      u32 system, u64 hash of its state, before it is destroyed
 *     NOTE      u8 0: a function of libse3d-io begins, 1: ends; u32 length, its name
 *
 * A call within another one stands between the pieces of that one; threads are told apart by their
 * number. Every piece is written before what it tells of happens, or as soon as it has: a recording
 * of a program that crashes ends with the call that crashed. */
#ifndef SE3D_RECORD_FORMAT_H
#define SE3D_RECORD_FORMAT_H

#define FORMAT_MAGIC "se3drec1"

typedef enum format_kind {
    FORMAT_CALL = 0,
    FORMAT_RETURN = 1,
    FORMAT_CALLBACK = 2,
    FORMAT_ANSWER = 3,
    FORMAT_FAIL = 4,
    FORMAT_NOTE = 5,
    FORMAT_HASH = 6
} format_kind;

#define FORMAT_PIECE_HEAD 9           /* bytes before the content */
#define FORMAT_NULL       0           /* of objects, callbacks and allocators, which count from 1 */
#define FORMAT_UNKNOWN    0xffffffffu /* an object that no call gave */

#endif
