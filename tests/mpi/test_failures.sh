# SPDX-License-Identifier: BSD-3-Clause
# What several processes do not carry is refused by name, one that fails or is killed ends all with
# a message, and a run is resumed on another number of processes.
# Run with SE3D_MPI_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"

column=$source/tests/mpi/column.yaml

# refuses WHAT: the model in $dir/refused.yaml
refuses() {
    share 2 run "$dir/refused.yaml" -o "$dir/refused"
    holds "refused: $1" test "$status" -eq 2
    holds "the message says $1" grep -q "that several processes share .*$1" "$dir/err"
    holds "$1: it is said once" test "$(grep -c 'several processes share' "$dir/err")" -eq 1
}

cp "$source/examples/models/triaxial.yaml" "$dir/refused.yaml"
refuses 'in a cell'

# What the first process cannot write ends all.
: >"$dir/file"
share 2 run "$column" -o "$dir/file/results"
holds "a folder that cannot be made ends the run" test "$status" -eq 1
holds "the message says why" grep -q 'results.*cannot be written: .*all processes end' "$dir/err"

share 2 run "$column" -o "$dir/failed" --set materials.glass.stiffness=20
holds "an overlap ends the run" test "$status" -eq 1
holds "the message names the particles" grep -q 'particle [0-9]* .*overlap' "$dir/err"
share 1 run "$column" -o "$dir/failed" --set materials.glass.stiffness=20
grep -o 'particle [0-9]* .*' "$dir/err" >"$dir/err1"
share 3 run "$column" -o "$dir/failed" --set materials.glass.stiffness=20
grep -o 'particle [0-9]* .*' "$dir/err" >"$dir/err3"
holds "it names the same ones on three processes" cmp "$dir/err1" "$dir/err3"

# Killed in the midst: the others end, and mpirun says why; resumed on fewer, as if nothing had been.
long=analysis.duration=0.02
run_killed 3 "$column" "$dir/killed" --set $long

share 2 run "$column" -o "$dir/killed" --set $long --resume
holds "two processes go on with what three had begun" test "$status" -eq 0
share 1 run "$column" -o "$dir/whole" --set $long
holds "the files are the same" diff -r "$dir/whole" "$dir/killed"

finish
