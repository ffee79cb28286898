# SPDX-License-Identifier: BSD-3-Clause
# Particles over 1, 2, 3, 4 and 7 processes, and with two threads: the same hash and the same files,
# but for nothing. SE3D_RANKS: other numbers of processes; SE3D_DURATION: a longer run.
# Run with SE3D_MPI_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/mpi/support.sh"

few='1 2 3 7' # four: mpi.held
[ -z "${SE3D_LONG:-}" ] || few='1 2 3 4 7'
: "${SE3D_RANKS:=$few}"
for model in column drum hopper halves; do
    for ranks in $SE3D_RANKS; do
        share "$ranks" run "$source/tests/mpi/$model.yaml" -o "$dir/$model.$ranks" \
            ${SE3D_DURATION:+--set "analysis.duration=$SE3D_DURATION"}
        holds "$model runs on $ranks processes" test "$status" -eq 0
        sed -n 's/.*hash //p' "$dir/out" >"$dir/$model.$ranks/hash"
        holds "$model has a hash on $ranks processes" test -s "$dir/$model.$ranks/hash"
        sed -n 's/.* \([0-9]*\) changed hands.*/\1/p' "$dir/out" >>"$dir/changed"
        if [ "$ranks" -ne 1 ]; then
            holds "$model is the same on $ranks processes" \
                diff -r "$dir/$model.1" "$dir/$model.$ranks"
        fi
    done
done
holds "the shell is pressed" awk -F, 'NR > 1 && $5 > 0 {++n} END {exit !(n > 2)}' "$dir/drum.1/shell.csv"
holds "particles changed hands" grep -q '[1-9]' "$dir/changed"

share 2 run "$source/tests/mpi/column.yaml" -o "$dir/threads" --set contact.threads=2
sed -n 's/.*hash //p' "$dir/out" >"$dir/threads/hash"
holds "two threads in each of two processes give the same" diff -r "$dir/column.1" "$dir/threads"

finish
