# SPDX-License-Identifier: BSD-3-Clause
# Clumps, bonds, and what is told of particles (flows, audits, servo walls) over 1, 2, 3 and 4 processes, and with two
# threads: the same hash and the same files; and resumed on another number of processes. SE3D_RANKS: other numbers of processes.
# Run with SE3D_MPI_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"

few='1 3 4' # two go on below
[ -z "${SE3D_LONG:-}" ] || few='1 2 3 4'
: "${SE3D_RANKS:=$few}"
for model in clumps bonds told; do
    for ranks in $SE3D_RANKS; do
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
for name in gate.count gate.mass level.mass_rate plate.force plate.position dissipation.torsion; do
    holds "told: $name" test "$(column "$dir/told.1/told.csv" $name | awk '{print ($1 != 0)}')" -eq 1
done

# As one process without others has them, but for rounding: what is counted is the same.
for model in bonds told; do
    "$SE3D_PROGRAM" run "$source/tests/mpi/$model.yaml" -o "$dir/alone" -q
done
for name in glue.count glue.torn glue.lost hold.count; do
    holds "bonds: $name as without MPI" \
        test "$(column "$dir/bonds.1/bonds.csv" $name)" = "$(column "$dir/alone/bonds.csv" $name)"
done

# near NAME: in the second row, before small differences have grown.
near() {
    for side in told.1 alone; do
        head -n 3 "$dir/$side/told.csv" >"$dir/$side.head"
    done
    awk -v a="$(column "$dir/told.1.head" "$1")" -v b="$(column "$dir/alone.head" "$1")" \
        'BEGIN {d = a - b; s = a + b; exit !(d * d <= 1e-24 * s * s)}'
}
for name in gate.count gate.mass level.count level.mass_rate plate.position dissipation.normal \
    dissipation.tangential dissipation.rolling dissipation.torsion; do
    holds "told: $name as without MPI" near $name
done

share 2 run "$source/tests/mpi/bonds.yaml" -o "$dir/threads" --set contact.threads=2
sed -n 's/.*hash //p' "$dir/out" >"$dir/threads/hash"
holds "two threads in each of two processes give the same" diff -r "$dir/bonds.1" "$dir/threads"

# There are clumps among the bonded ones, too.
for model in bonds told; do
    path=$source/tests/mpi/$model.yaml
    run_killed 3 "$path" "$dir/killed.$model"
    share 2 run "$path" -o "$dir/killed.$model" --resume
    holds "$model: two processes go on with what three had begun" test "$status" -eq 0
    sed -n 's/.*hash //p' "$dir/out" >"$dir/killed.$model/hash"
    holds "$model: the files are the same" diff -r "$dir/$model.1" "$dir/killed.$model"
done

finish
