# SPDX-License-Identifier: BSD-3-Clause
# Memory that is missing on one process, before and within steps, ends all with a message: nobody waits for it.
# Run with SE3D_MPI_PROGRAM and SE3D_BUILD_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"
share_test memory

share 2 1000000
holds "enough memory" test "$status" -eq 0
count=$(sed -n 's/ allocations//p' "$dir/out")
holds "it allocates" test "${count:-0}" -gt 20
for k in "$count" $((count - 1)) $((count - 3)) $((count / 2)); do
    share 2 "$k"
    holds "allocation $k fails: $status" test "$status" -ne 0 -a "$status" -ne 124
    holds "allocation $k: no word of memory: $(head -3 "$dir/err")" grep -q 'memory' "$dir/err"
    holds "allocation $k: MPI itself failed" sh -c '! grep -q "error occurred in MPI" "$1"' sh "$dir/err"
done
finish
