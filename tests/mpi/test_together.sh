# SPDX-License-Identifier: BSD-3-Clause
# What fails in one process alone ends the call in all of them, with its message, and none waits: test_alone.c.
# Run with SE3D_MPI_PROGRAM and SE3D_BUILD_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"
share_test alone

share 2
holds "one of two fails alone: $(tail -n 3 "$dir/err")" test "$status" -eq 0
finish
