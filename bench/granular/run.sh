#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh GRANULAR [EDGE]...: our bench and LAMMPS (lmp) in turn, from the same settled state.
bench=$1
shift
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1
for edge in "${@:-20}"; do
    width=$(awk "BEGIN { printf \"%.17g\", $edge * 0.011 }")
    steps=$(awk "BEGIN { printf \"%d\", 24e6 / ($edge * $edge * $edge) }")
    for law in hooke hertz; do
        "$bench" "$edge" "$law" "$((steps * 3))" "${SETTLE:-60000}" 1 "$work/column.data"
        lmp -in "$here/lammps_$law.in" -var data "$work/column.data" -var w "$width" \
            -var steps "$steps" -log none > "$work/out"
        awk -v n="$((edge * edge * edge))" '/^Loop time/ { t = $4; s = $9 }
            /CPU use/ { c = $1 + 0 } END {
            printf "  LAMMPS %.2f M particle-steps per CPU second (%.0f %% CPU)\n",
                   1e-6 * n * s / (t * c / 100), c }' "$work/out"
    done
done
