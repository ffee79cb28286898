# SPDX-License-Identifier: BSD-3-Clause
# examples/study/corner.yaml, fewer of its samples: sweeps of a corner give the same bytes from 1, 3 and 7 parts that
# are killed again and again, go on and are merged, from several processes and from the server.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
unset SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_MIN SLURM_ARRAY_TASK_COUNT PBS_ARRAY_INDEX PBS_ARRAYID HQ_TASK_ID
samples=70
study() { "$program" study "$source/examples/study/corner.yaml" --set study.samples=$samples "$@"; }

expect 'the whole' 0 study -o "$dir/whole"
has "$dir/out" "wrote $dir/whole/study.csv: $samples samples, 0 failed"
table=$dir/whole/study.csv
whole=$(cksum <"$table")
is "$(sed -n 2p "$table" | cut -d, -f15-)" 'bump_steer,camber,scrub,ratio,status'
is "$(grep -c ',ok$' "$table")" $samples
expect 'three processes' 0 study -o "$dir/jobs" --jobs 3 -q
is "$(cksum <"$dir/jobs/study.csv")" "$whole"

kills=0
for shards in 1 3 7; do
    folder=$dir/of$shards
    for shard in $(seq $shards); do
        limit=0.02
        until timeout -s KILL "$limit" "$program" study "$source/examples/study/corner.yaml" \
            --set study.samples=$samples -o "$folder" --shard "$shard/$shards" --resume -q 2>"$dir/err"; do
            kills=$((kills + 1))
            limit=$(awk "BEGIN {print $limit < 0.09 ? $limit + 0.01 : 4 * $limit}") # ever longer: slow machines
        done
    done
    expect "merge $shards" 0 study -o "$folder" --merge
    is "$(cksum <"$folder/study.csv")" "$whole"
done
holds 'nothing was killed' [ $kills -gt 0 ]

# A sample by itself, and the corner as it is drawn: its angles stay within what the hardpoints allow.
printf '{"id": 1, "sample": 7}\n{"id": 2}\n' | study --server -q >"$dir/replies" 2>"$dir/err"
value() { sed -n "$1p" "$dir/replies" | sed "s/.*\"$2\": \([^,}]*\).*/\1/"; }
row() { awk -F, -v s="$1" -v c="$2" '$1 == s {print $c}' "$table"; }
is "$(value 1 bump_steer)" "$(row 7 15)"
is "$(value 1 ratio)" "$(row 7 18)"
holds 'half a millimetre changes bump steer, in radians' awk -F, -v one="$(value 2 bump_steer)" '
    NR > 2 {n += 1; sum += $15; square += $15 * $15; if ($15 < 0 || $15 > 0.02) {bad = 1}}
    END {mean = sum / n; spread = square / n - mean * mean; exit bad || !(one > 0) || !(spread > 1e-8) || mean < one}' "$table"
holds 'motion ratios are those of the corner' awk -F, -v one="$(value 2 ratio)" '
    NR > 2 {n += 1; sum += $18; if ($18 < 0.95 * one || $18 > 1.05 * one) {bad = 1}}
    END {exit bad || sum / n < one - 0.003 || sum / n > one + 0.003}' "$table"
finish
