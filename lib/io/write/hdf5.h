/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes HDF5 files, version 1.8 of their format: groups, arrays that lie in one piece or are
 * compressed in pieces, attributes. The same content makes the same bytes. docs/hdf5.md */
#ifndef SE3D_IO_HDF5_H
#define SE3D_IO_HDF5_H

#include <stdio.h>

#include "io/base/deflate.h"
#include "io/base/pool.h"

/* X(NAME, number, bytes); TEXT is UTF-8 of a fixed size, filled up with zeros. */
#define SE3DI_HDF5_TYPE_LIST(X)                                                                    \
    X(DOUBLE, 0, 8)                                                                                \
    X(SINGLE, 1, 4)                                                                                \
    X(INT64, 2, 8)                                                                                 \
    X(INT32, 3, 4)                                                                                 \
    X(UINT8, 4, 1)                                                                                 \
    X(TEXT, 5, 0)

typedef enum se3di_hdf5_type {
#define SE3DI_HDF5_TYPE(NAME, number, bytes) SE3DI_HDF5_##NAME = number,
    SE3DI_HDF5_TYPE_LIST(SE3DI_HDF5_TYPE)
#undef SE3DI_HDF5_TYPE
} se3di_hdf5_type;

/* What an array holds; rank 0: one value, without dimensions. */
typedef struct se3di_hdf5_shape {
    se3di_hdf5_type type;
    size_t text_size; /* of TEXT, at least 1 */
    int rank;
    uint64_t dims[4];
    uint64_t piece; /* how much of the first dimension is compressed together; 0: some 64 kB */
} se3di_hdf5_shape;

typedef struct se3di_hdf5 {
    FILE *file;
    const char *path;
    se3di_iopool pool;
    struct se3di_hdf5_node *nodes; /* groups and arrays; 0 is the root */
    size_t count, capacity;
    uint64_t end; /* of what places are given to */
    uint64_t at;  /* where the file stands */
    int failure;  /* errno of the first failure */
    int compression;
    se3di_deflate deflate;
    unsigned char *shuffled; /* [shuffled_size] */
    size_t shuffled_size;
} se3di_hdf5;

/* Begin a file under a temporary name. Its arrays are compressed if `compression` is not 0, at most
 * 9. @return false: errno says why; nothing is left. */
bool se3di_hdf5_open(se3di_hdf5 *h, const se3d_allocator *allocator, const char *path,
                     int compression);
/* Add a group, in one of lower number; 0: in the root. @return its number; 0 after a failure. */
size_t se3di_hdf5_add_group(se3di_hdf5 *h, size_t group, const char *name);
/* Add an array, for which there is place now. @return its number; 0 after a failure. */
size_t se3di_hdf5_add_array(se3di_hdf5 *h, size_t group, const char *name,
                            const se3di_hdf5_shape *shape);
/* Write values of an array as the file has them, little-endian, from byte `first` of it on, which
 * is where the last ones ended. All of them, before the file is closed: else that fails, EIO. */
void se3di_hdf5_write(se3di_hdf5 *h, size_t array, uint64_t first, const void *bytes, size_t size);
/* Give a group or an array an attribute. `values`: numbers, of which there are as many as the shape
 * says, or the text. */
void se3di_hdf5_add_attribute(se3di_hdf5 *h, size_t node, const char *name,
                              const se3di_hdf5_shape *shape, const void *values);
/* How many bytes a value takes; put one there, little-endian. */
size_t se3di_hdf5_size_of(const se3di_hdf5_shape *shape);
void se3di_hdf5_put_value(unsigned char *at, se3di_hdf5_type type, double value);
/* Complete the file and give it its name, or leave nothing. @return false: errno says why. */
bool se3di_hdf5_close(se3di_hdf5 *h);

#endif
