# SPDX-License-Identifier: BSD-3-Clause
# se3d study: the same bytes however the samples are divided and whatever is killed on the way, what --merge tells,
# the server, and folders and disks that take nothing.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
unset SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_MIN SLURM_ARRAY_TASK_COUNT PBS_ARRAY_INDEX PBS_ARRAYID HQ_TASK_ID
model=$dir/damper.yaml
cp "$source/examples/study/damper.yaml" "$model"
study() { "$program" study "$model" "$@"; }
study_of() { "$program" study "$@" -q; }

expect 'one process' 0 study -o "$dir/one"
has "$dir/out" "wrote $dir/one/study.csv: 70 samples, 0 failed"
has "$dir/err" 'study: 70 of 70 samples, 0 failed'
whole=$(cksum <"$dir/one/study.csv")
is "$(sed -n 2p "$dir/one/study.csv")" 'sample,m,k,c,overshoot,settled,crossing,speed,force,ratio,status'
is "$(grep -c ',ok$' "$dir/one/study.csv")" 70
expect 'three processes' 0 study -o "$dir/jobs" --jobs 3 -q
is "$(cksum <"$dir/jobs/study.csv")" "$whole"
is "$(cat "$dir/out" "$dir/err")" ''
expect 'all processors' 0 study -o "$dir/all" --jobs all --json
has "$dir/out" '"samples": 70, "failed": 0}'
is "$(cksum <"$dir/all/study.csv")" "$whole"

# Shards that are killed again and again, each time later, and go on.
for shards in 1 3 7; do
    folder=$dir/of$shards
    shard=1
    while [ $shard -le $shards ]; do
        limit=0.02
        until timeout -s KILL "$limit" "$program" study "$model" -o "$folder" --shard $shard/$shards --resume -q \
            --jobs $((shard % 2 + 1)) 2>"$dir/err"; do
            limit=$(awk "BEGIN {print $limit < 0.09 ? $limit + 0.01 : 4 * $limit}") # ever longer: slow machines
        done
        shard=$((shard + 1))
    done
    expect "merge $shards" 0 study -o "$folder" --merge
    is "$(cksum <"$folder/study.csv")" "$whole"
done

# What is missing, torn, twice and foreign.
bad=$dir/bad
cp -r "$dir/of7" "$bad"
rm "$bad/study.csv" "$bad/study.2-of-7.csv"
head -c 700 "$dir/of7/study.5-of-7.csv" >"$bad/study.5-of-7.csv"
expect 'holes' 1 study -o "$bad" --merge
says 'sample 1 is missing'
says 'sample 67 is missing'
says 'not merged'
holds 'a table of a part' [ ! -e "$bad/study.csv" ]
expect 'a part of it' 1 study -o "$bad" --merge --partial
holds 'no table' [ -s "$bad/study.csv" ]
expect 'a torn line' 0 study -o "$bad" --shard 5/7 --resume -q
is "$(cksum <"$bad/study.5-of-7.csv")" "$(cksum <"$dir/of7/study.5-of-7.csv")"
cp "$dir/of3/"study.*-of-3.csv "$bad"
expect 'twice the same is no harm' 0 study -o "$bad" --merge -q
is "$(cksum <"$bad/study.csv")" "$whole"
sed 's/^1,1/1,2/' "$dir/of3/study.2-of-3.csv" >"$bad/study.2-of-3.csv"
sed 's/^1,2/1,3/' "$dir/of7/study.2-of-7.csv" >"$bad/study.2-of-7.csv"
expect 'twice, different' 1 study -o "$bad" --merge
says 'sample 1 is there twice, and different'
sed 's/model ....../model 000000/' "$dir/of7/study.2-of-7.csv" >"$bad/study.2-of-7.csv"
rm "$bad"/study.*-of-3.csv
expect 'foreign' 1 study -o "$bad" --merge
says 'study.2-of-7.csv: is of another model, study or version of se3d'
expect 'a foreign one is not gone on with' 1 study -o "$bad" --shard 2/7 --resume
says 'is of another model, study or version of se3d'
printf 'no table\n' >"$bad/study.2-of-7.csv"
expect 'no table' 1 study -o "$bad" --shard 2/7 --resume
says 'is no table of a study'
cp "$dir/of7/study.3-of-7.csv" "$bad/study.2-of-7.csv"
expect 'another shard' 1 study -o "$bad" --shard 2/7 --resume
says 'is another shard'
expect 'what is there is not overwritten' 1 study -o "$dir/one"
says 'is there already: --resume goes on with it'
expect 'all of it is there' 0 study -o "$dir/one" --resume -q
is "$(cksum <"$dir/one/study.csv")" "$whole"
expect 'other parameters are another study' 1 study -o "$dir/one" --resume --set m=3
# A part that is all of it.
expect 'nothing to merge' 0 study -o "$dir/one" --merge
has "$dir/out" "wrote $dir/one/study.csv: 70 samples, 0 failed"
is "$(cksum <"$dir/one/study.csv")" "$whole"
mkdir "$dir/piece"
head -c 700 "$dir/one/study.csv" >"$dir/piece/study.csv"
for how in -q --partial; do
    expect "a piece of it, $how" 1 study -o "$dir/piece" --merge $how
    says 'samples 3 to 69 are missing'
    says 'not whole; --resume goes on with it'
    is "$(wc -c <"$dir/piece/study.csv")" 700
done
expect 'the rest of it' 0 study -o "$dir/piece" --shard 1/1 --resume -q
is "$(cksum <"$dir/piece/study.csv")" "$whole"
mkdir "$dir/empty"
expect 'no shards' 1 study -o "$dir/empty" --merge
says 'has no shards'
ln -s study.csv "$dir/empty/study.csv"
expect 'a table that cannot be looked at' 1 study -o "$dir/empty" --merge
says 'Too many levels of symbolic links'

# The lock of a process that was killed lives as long as it does: it is waited for, not for ever.
hold() {
    python3 -c "import fcntl, time
f = open('$dir/held/study.csv', 'r+b')
fcntl.lockf(f, fcntl.LOCK_EX)
open('$dir/held/now', 'w').close()
time.sleep($1)" &
    until [ -e "$dir/held/now" ]; do sleep 0.02; done
    rm "$dir/held/now"
}
cp -r "$dir/piece" "$dir/held"
head -c 700 "$dir/one/study.csv" >"$dir/held/study.csv"
hold 0.5
expect 'after a kill' 0 study -o "$dir/held" --resume -q
is "$(cksum <"$dir/held/study.csv")" "$whole"
wait
hold 4
expect 'beside another' 1 study -o "$dir/held" --resume -q
says 'another program is writing it'
expect 'no folder' 1 study -o "$dir/none" --merge
says 'No such file'

# Shards from schedulers.
expect 'Slurm' 0 env SLURM_ARRAY_TASK_ID=5 SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_COUNT=7 "$program" study "$model" \
    -o "$dir/slurm" --shard auto -q
is "$(cksum <"$dir/slurm/study.3-of-7.csv")" "$(cksum <"$dir/of7/study.3-of-7.csv")"
expect 'PBS' 0 env PBS_ARRAY_INDEX=3 "$program" study "$model" -o "$dir/pbs" --shard auto/7 -q
is "$(cksum <"$dir/pbs/study.3-of-7.csv")" "$(cksum <"$dir/of7/study.3-of-7.csv")"
expect 'HyperQueue' 0 env HQ_TASK_ID=3 "$program" study "$model" -o "$dir/hq" --shard auto/7 -q
is "$(cksum <"$dir/hq/study.3-of-7.csv")" "$(cksum <"$dir/of7/study.3-of-7.csv")"
for wrong in 0/3 4/3 1 1/0 /3 1/ x/3 1/3/3 -1/3 auto auto/3 1/99999999999; do
    expect "the shard $wrong" 2 study --shard "$wrong" -o "$dir/wrong"
done
for wrong in 0 -1 x 2x 99999; do
    expect "$wrong jobs" 2 study --jobs "$wrong" -o "$dir/wrong"
done
expect 'two commands' 2 study --merge --server
expect 'no study' 2 "$program" study "$models/pendulum.yaml"
says 'the model has no `study`'
holds 'files of nothing' [ ! -e "$dir/wrong" ]

# Samples that fail are rows.
sed 's/m: normal.*/m: [2, -1]/; s/method:.*/method: monte_carlo/' "$model" >"$dir/fails.yaml"
expect 'failures' 1 "$program" study "$dir/fails.yaml" -o "$dir/fails" --jobs 2
has "$dir/out" 'failed, see the column status'
good=$(grep -c '^[0-9]*,2,.*,ok$' "$dir/fails/study.csv")
bad=$(grep -c '^[0-9]*,-1,.*,,,,,,,"fails.yaml:.*mass.*must be' "$dir/fails/study.csv")
is "$((good + bad))" 70
holds "$good good" [ "$good" -gt 20 -a "$bad" -gt 20 ]

# Derivatives.
expect 'derivatives' 0 study --sensitivities -o "$dir/slopes"
has "$dir/out" "wrote $dir/slopes/sensitivities.csv"
has "$dir/err" 'study: derivatives by c, 3 of 3'
is "$(grep -c . "$dir/slopes/sensitivities.csv")" 19
is "$(sed -n 's/^force,k,\([^,]*,[^,]*,0.1000000\|[^,]*,[^,]*,0.0999999\).*/ok/p' "$dir/slopes/sensitivities.csv")" ok
expect 'derivatives as JSON' 0 study --sensitivities -o "$dir/slopes" --json
is "$(cat "$dir/out")" "{\"status\": \"done\", \"file\": \"$dir/slopes/sensitivities.csv\", \"measures\": 6, \"parameters\": 3}"
slopes=$(cksum <"$dir/slopes/sensitivities.csv")
expect 'derivatives by two processes' 0 study --sensitivities -o "$dir/slopes" --jobs 2
is "$(cksum <"$dir/slopes/sensitivities.csv")" "$slopes"
has "$dir/err" 'study: derivatives by c, 3 of 3'
expect 'a server of two processes' 2 study --server --jobs 2
expect 'derivatives in parts' 2 study --sensitivities --shard 1/2
sed '/^  parameters:/,/^  seed/d; s/^study:/study:\n  sensitivities: [k]/; s/band: 2 mm/band: 1e-9/' "$model" >"$dir/only.yaml"
expect 'a study of derivatives, with a measure that has no value' 1 "$program" study "$dir/only.yaml" -o "$dir/only"
says '`settled` has not settled at the end'
is "$(grep -c '^settled,k,,800,,,$' "$dir/only/sensitivities.csv")" 1
is "$(grep -c '^crossing,k,.*,-0.55' "$dir/only/sensitivities.csv")" 1
expect 'derivatives into a file' 1 study --sensitivities -o "$model/x"
says 'cannot be written'

# The server.
printf '{"id": 1, "sample": 0}\n\n{"id": 2, "parameters": {"m": 2}}\nnonsense\n' >"$dir/requests"
expect 'requests' 0 sh -c "'$program' study '$model' --server <'$dir/requests'"
is "$(grep -c '^{"id": [12], "measures": {"overshoot": -0.0' "$dir/out")" 2
is "$(grep -c '^{"id": null, "error": ' "$dir/out")" 1

# Places that take nothing.
mkdir "$dir/closed"
chmod 555 "$dir/closed"
if ! touch "$dir/closed/x" 2>/dev/null; then
    expect 'a folder that is closed' 1 study -o "$dir/closed"
    says 'cannot be written: Permission denied'
fi
expect 'a file in the way' 1 study -o "$model/x"
says 'cannot be written'
expect 'a full disk' 1 sh -c "ulimit -f 4; exec '$program' study '$model' -o '$dir/full' -q"
says 'cannot be written: File too large'
expect 'with room again' 0 study -o "$dir/full" --resume -q
is "$(cksum <"$dir/full/study.csv")" "$whole"
mkdir "$dir/piped"
mkfifo "$dir/piped/study.csv"
expect 'a pipe' 1 study -o "$dir/piped"
says 'cannot be written'

# Names of parameters that hold what numbers hold.
for word in e ee E1 gap; do
    cat >"$dir/named.yaml" <<END_OF_YAML
se3d: 1
parameters: {$word: 0.1}
gravity: [0, 0, 0]
bodies: [{name: b, mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
joints: [{name: slide, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: s, type: stop, joint: slide, upper: $word, k: 1000}]
analysis: {type: dynamics, duration: 0.3}
study: {parameters: {$word: [0.1, 0.11]}, every: 0.01, measures: {last: {final: b.position.x}}}
END_OF_YAML
    expect "a parameter $word" 0 study_of "$dir/named.yaml" -o "$dir/named.$word"
    is "$(sed '1,2d' "$dir/named.$word/study.csv" | cut -d, -f3 | sort -u | wc -l)" 2
    is "$(sed '1,2d' "$dir/named.$word/study.csv")" "$(sed '1,2d' "$dir/named.e/study.csv")"
done
finish
