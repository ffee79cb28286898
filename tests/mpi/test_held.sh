# SPDX-License-Identifier: BSD-3-Clause
# Clumps and bonds over 1, 2, 3 and 4 processes, and with two threads: the same hash and the same files; and resumed on
# another number of processes. SE3D_RANKS: other numbers of processes.
# Run with SE3D_MPI_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"

for model in clumps bonds; do
    for ranks in ${SE3D_RANKS:-1 2 3 4}; do
        share "$ranks" run "$source/tests/mpi/$model.yaml" -o "$dir/$model.$ranks"
        holds "$model run on $ranks processes" test "$status" -eq 0
        sed -n 's/.*hash //p' "$dir/out" >"$dir/$model.$ranks/hash"
        holds "$model have a hash on $ranks processes" test -s "$dir/$model.$ranks/hash"
        sed -n 's/.* \([0-9]*\) changed hands.*/\1/p' "$dir/out" >>"$dir/changed"
        holds "$model are the same on $ranks processes" diff -r "$dir/$model.1" "$dir/$model.$ranks"
    done
done
holds "particles changed hands" grep -q '[1-9]' "$dir/changed"

# column FILE NAME: the last value.
column() {
    awk -F, -v name="$2" 'NR == 1 {for (k = 1; k <= NF; ++k) if ($k == name) at = k} END {print $at}' "$1"
}
for name in particles.lost feed.count; do
    holds "clumps: $name" test "$(column "$dir/clumps.1/clumps.csv" $name)" -gt 0
done
for name in glue.count glue.torn glue.lost hold.count knot.count particles.lost; do
    holds "bonds: $name" test "$(column "$dir/bonds.1/bonds.csv" $name)" -gt 0
done

# As one process without others has them, but for rounding: what is counted is the same.
"$SE3D_PROGRAM" run "$source/tests/mpi/bonds.yaml" -o "$dir/alone" -q
for name in glue.count glue.torn glue.lost hold.count; do
    holds "bonds: $name as without MPI" \
        test "$(column "$dir/bonds.1/bonds.csv" $name)" = "$(column "$dir/alone/bonds.csv" $name)"
done

share 2 run "$source/tests/mpi/bonds.yaml" -o "$dir/threads" --set contact.threads=2
sed -n 's/.*hash //p' "$dir/out" >"$dir/threads/hash"
holds "two threads in each of two processes give the same" diff -r "$dir/bonds.1" "$dir/threads"

# There are clumps among the bonded ones, too.
path=$source/tests/mpi/bonds.yaml
share 3 run "$path" -o "$dir/killed" --checkpoint 0 &
here=$!
kill_one "$path" "$dir/killed"
wait $here
share 2 run "$path" -o "$dir/killed" --resume
holds "two processes go on with what three had begun" test "$status" -eq 0
sed -n 's/.*hash //p' "$dir/out" >"$dir/killed/hash"
holds "the files are the same" diff -r "$dir/bonds.1" "$dir/killed"

finish
