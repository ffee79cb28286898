/* SPDX-License-Identifier: BSD-3-Clause */
/* Arrays that are compressed in pieces, so many that their tree has three levels:
 * test_unit_hdf5_pieces FILE leaves them for tests/cli/test_hdf5.sh, which reads them back. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"
#include "io/base/file.h"
#include "io/write/hdf5.h"
#include "support/scratch.h"

enum { ROWS = 5000, COLUMNS = 3 };

static const char *kept;

/* Element (row, column) is 10 row + column. */
static void put_table(se3di_hdf5 *h, const char *name, uint64_t piece, size_t width)
{
    const se3di_hdf5_shape shape = {SE3DI_HDF5_DOUBLE, 0, 2, {ROWS, COLUMNS}, piece};
    const size_t array = se3di_hdf5_add_array(h, 0, name, &shape);
    unsigned char *bytes = malloc(8 * width);
    size_t used = 0;
    uint64_t at = 0;
    CHECK(bytes);
    for (int k = 0; bytes && k < ROWS * COLUMNS; ++k) { /* `width` values at a time */
        se3di_hdf5_put_value(bytes + 8 * used++, shape.type, 10 * (k / COLUMNS) + k % COLUMNS);
        if (used == width || k + 1 == ROWS * COLUMNS) {
            se3di_hdf5_write(h, array, at, bytes, 8 * used);
            at += 8 * used;
            used = 0;
        }
    }
    free(bytes);
}

static void many_pieces_have_a_tree(void)
{
    char path[512];
    se3di_hdf5 h;
    snprintf(path, sizeof path, "%s", kept ? kept : scratch_path("se3d_pieces.h5"));
    if (!se3di_deflate_is_there()) {
        CHECK(!se3di_hdf5_open(&h, NULL, path, 6) && errno == ENOTSUP);
        return;
    }
    CHECK(se3di_hdf5_open(&h, NULL, path, 6));
    put_table(&h, "one", 1, 7);      /* rows of a piece: 5000 of them, in 79 nodes, in 2, in 1 */
    put_table(&h, "some", 64, 4096); /* 79, the last of which is shorter */
    put_table(&h, "all", ROWS, ROWS * COLUMNS);
    put_table(&h, "chosen", 0, 1000);
    const se3di_hdf5_shape small = {SE3DI_HDF5_INT32, 0, 1, {3}, 0};
    const size_t array = se3di_hdf5_add_array(&h, 0, "small", &small);
    const unsigned char values[12] = {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0};
    se3di_hdf5_write(&h, array, 0, values, sizeof values);
    CHECK(se3di_hdf5_close(&h));
    if (!kept) {
        se3di_file_remove(path);
    }
}

/* All of them, and nothing else; compressed and not. */
static void values_come_in_their_order(void)
{
    enum { SIZE = 10000 };
    static const unsigned char bytes[SIZE + 1];
    static const size_t parts[5][2] = {
        {SIZE / 2, SIZE - SIZE / 2}, {SIZE / 2, SIZE - SIZE / 2 + 1}, {1, 1}, {1, 0}, {0, 0}};
    const se3di_hdf5_shape shape = {SE3DI_HDF5_UINT8, 0, 1, {SIZE}, 0};
    for (int way = 0; way < (se3di_deflate_is_there() ? 12 : 6); ++way) {
        const int k = way % 6 < 5 ? way % 6 : 0, gap = way % 6 == 5;
        se3di_hdf5 h;
        CHECK(se3di_hdf5_open(&h, NULL, scratch_path("se3d_order.h5"), way / 6));
        const size_t array = se3di_hdf5_add_array(&h, 0, "a", &shape);
        se3di_hdf5_write(&h, array, 0, bytes, parts[k][0]);
        se3di_hdf5_write(&h, array, parts[k][0] + (size_t)gap, bytes, parts[k][1] - (size_t)gap);
        const bool is_good = k == 0 && !gap;
        CHECK(se3di_hdf5_close(&h) == is_good);
        CHECK(is_good || errno == EIO);
    }
    se3di_file_remove(scratch_path("se3d_order.h5"));
}

int main(int argc, char **argv)
{
    kept = argc > 1 ? argv[1] : NULL;
    RUN(many_pieces_have_a_tree);
    RUN(values_come_in_their_order);
    return check_finish();
}
