# SPDX-License-Identifier: BSD-3-Clause
# A run that is killed at random moments and resumed leaves the same files as one that is not, and
# the same report; what does not fit is refused and stays as it is. SE3D_KILLS: how often (3).
# Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

kills=${SE3D_KILLS:-3}
seed=${SE3D_SEED:-$$}
w=$dir/whole
c=$dir/cut

cat >"$dir/swing.yaml" <<'END'
se3d: 1
bodies:
  - {name: bar, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}
  - {name: rod, mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: knee, type: revolute, body_i: bar, body_j: rod, at: [1, 0, 0], axis: [0, 1, 0]}
events:
  - {name: low, channel: bar.position.x, value: 0.1}
analysis:
  - {type: equilibrium}
  - {type: dynamics, duration: 2, start: 1}
  - {type: dynamics, duration: 20, method: generalized_alpha, step: 5e-4}
output:
  - {file: a.csv, every: 0.01, channels: [bar.position, rod.velocity]}
  - {file: b.csv, every: 0.037, channels: [steps, rod.position.z]}
  - {file: deep/c.pvd, every: 5}
  - {summary: s.csv, every: 0.01, channels: [rod.position, energy.kinetic]}
END

printf 'v -0.1 %s %s\n' -1 0 1 0 1 0.1 1 1 -1 1 >"$dir/side.obj"
printf 'f %s\n' '1 2 3' '1 3 4' '1 4 5' >>"$dir/side.obj"
cat >"$dir/heap.yaml" <<'END'
se3d: 1
contact: {law: hooke}
materials: [{name: stone, density: 2500, stiffness: 2e4, rolling_friction: 0.05}]
particles:
  - {material: stone, radius: [0.008, 0.014], lower: [-0.1, -0.1, 0], upper: [0.1, 0.1, 0.15],
     packing: lattice, jitter: 1e-3}
  - {clump: rod, material: stone, lower: [-0.1, -0.1, 0.15], upper: [0.1, 0.1, 0.25], count: 10}
clumps:
  - {name: rod, spheres: [{position: [-0.008, 0, 0], radius: 0.009}, {position: [0.008, 0, 0], radius: 0.01}]}
bonds:
  - {name: glue, gap: 6e-3, young: 3e5, damping: 0.1, tensile_strength: 1.5e4, shear_strength: 1.5e4}
bodies:
  - {name: ground, shapes: [{type: plane, material: stone}, {name: side, type: mesh, file: side.obj, material: stone}]}
  - {name: box, mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [0, 0, 0.3],
     shapes: [{type: box, size: [0.06, 0.06, 0.06], material: stone}]}
analysis: {type: dynamics, duration: 0.6}
output:
  - {file: a.csv, every: 0.002, channels: [box.position, energy.kinetic, glue.dissipated, glue.count, glue.broken]}
  - {file: p.csv, every: 0.05, particles: true}
  - {file: p.pvd, every: 0.1}
  - {average: m.csv, every: 0.01, start: 0.05, fields: {lower: [-0.1, -0.1, 0], upper: [0.1, 0.1, 0.2], cells: [2, 3, 4],
     width: 0.02}}
  - {wall_map: w.csv, every: 0.01, start: 0.05, shape: side}
  - {wall_map: w.vtp, every: 0.01, start: 0.05, shape: side}
  - {file: q.h5, every: 0.05, particles: true}
  - {vtk: h.vtkhdf, every: 0.2}
END

sed 's/samples: 70/samples: 200/' "$source/examples/study/damper.yaml" >"$dir/sweep.yaml"

# Joints that break, a cell that strains, what convex remembers of contacts and of what sleeps.
sed 's/hold: 400/hold: 150/; s/duration: 3.5}/duration: 3.5, method: generalized_alpha, step: 4e-4}/' \
    "$source/examples/models/breaking_chain.yaml" >"$dir/chain.yaml"
sed 's/duration: 0.9}/duration: 0.12}/' "$source/examples/models/triaxial.yaml" >"$dir/cell.yaml"
sed 's/duration: 3,/duration: 2,/' "$source/examples/models/heap.yaml" >"$dir/boxes.yaml"

# The report without what depends on the machine and the folder.
report() { sed 's/"cpu_time": [^,]*,//g; s#"path": "[^"]*/\([^/"]*\)"#\1#g' "$1"; }

random() { awk -v s="$1" 'BEGIN {srand(s); printf "0.%03d", 40 + int(460 * rand())}'; }

# go_on WORDS...: the command, killed at random moments until it ends by itself or all kills are done,
# and then once more in peace. What it wrote at last is in $dir/out.
go_on() {
    code=137
    while [ $hit -lt "$kills" ] && [ $code -eq 137 ]; do
        tries=$((tries + 1))
        "$@" >"$dir/out" 2>"$dir/err" &
        sleep "$(random $((seed + tries)))"
        kill -9 $! 2>/dev/null
        wait $!
        code=$?
        [ $code -ne 137 ] || hit=$((hit + 1))
    done 2>/dev/null
    if [ $code -eq 137 ]; then
        expect "$1 at last" 0 "$@"
        code=0
    fi
    is "$code" 0
}

# try_model MODEL: killed as often as asked, it leaves the same files
try_model() {
    rm -rf "$w"
    expect "$1 as a whole" 0 "$program" run "$dir/$1" -o "$w" --json --no-estimate
    cp "$dir/out" "$dir/whole.json"
    report "$dir/whole.json" >"$dir/1"
    hit=0
    tries=0
    while [ $hit -lt "$kills" ] && [ $tries -lt $((4 * kills + 4)) ]; do
        rm -rf "$c"
        go_on "$program" run "$dir/$1" -o "$c" --json --checkpoint 0.05 --resume
        holds "$1 with seed $seed: not the same after $hit kills" diff -r "$w" "$c"
        report "$dir/out" >"$dir/2"
        holds "$1 with seed $seed: another report after $hit kills" cmp "$dir/1" "$dir/2"
    done
    echo "$1: $hit kills"
}

# The same of a study, whose table has all its rows.
try_study() {
    rm -rf "$w"
    expect "$1 as a whole" 0 "$program" study "$dir/$1" -o "$w" -q
    hit=0
    tries=0
    while [ $hit -lt "$kills" ] && [ $tries -lt $((4 * kills + 4)) ]; do
        rm -rf "$c"
        go_on "$program" study "$dir/$1" -o "$c" -q --resume
        holds "$1 with seed $seed: not the same after $hit kills" diff -r "$w" "$c"
    done
    echo "$1: $hit kills"
}

try_model swing.yaml
try_model heap.yaml
holds 'some bonds broke, some hold' awk -F, 'END {exit !($NF > 0 && $(NF - 1) > 0)}' "$w/a.csv"
holds 'the wall is pressed' awk -F, 'NR > 1 && $5 > 0 {++n} END {exit !n}' "$w/w.csv"
try_study sweep.yaml
kills=$(((kills + 2) / 3))
for model in chain.yaml cell.yaml boxes.yaml; do
    try_model $model
done

# cut_short MODEL [OPTIONS]: leave a run that was killed, with a checkpoint
cut_short() {
    file=$1
    shift
    rm -rf "$c"
    "$program" run "$dir/$file" -o "$c" -q --checkpoint 0 "$@" 2>/dev/null &
    tries=0
    while [ ! -s "$c/run.checkpoint" ] && [ $tries -lt 200 ]; do
        sleep 0.05
        tries=$((tries + 1))
    done
    kill -9 $! 2>/dev/null
    wait $! 2>/dev/null
    holds 'there is a checkpoint' [ -s "$c/run.checkpoint" ]
    cp -r "$c" "$dir/before"
}

# refused TEXT COMMAND...: with this reason, and nothing is touched
refused() {
    reason=$1
    shift
    expect "refused: $reason" 1 "$@"
    says "$reason"
    holds "something was touched: $reason" diff -r "$dir/before" "$c"
}

cut_short swing.yaml
resume="$program run $dir/swing.yaml -o $c -q --resume"
refused 'other options' $resume --method rattle
refused 'other options' $resume --step 1e-4
cp "$dir/swing.yaml" "$dir/kept.yaml"
sed -i.bak 's/mass: 1,/mass: 1.5,/' "$dir/swing.yaml"
refused 'another model' $resume
cp "$dir/kept.yaml" "$dir/swing.yaml"
for size in 0 10 100 1000; do
    head -c $size "$dir/before/run.checkpoint" >"$dir/short"
    cp "$dir/short" "$c/run.checkpoint"
    rm -rf "$dir/kept" && cp -r "$dir/before" "$dir/kept"
    cp "$dir/short" "$dir/before/run.checkpoint"
    refused 'damaged or cut' $resume
    rm -rf "$dir/before" && mv "$dir/kept" "$dir/before"
done
cp "$dir/before/run.checkpoint" "$dir/short"
printf '\001' | dd of="$dir/short" bs=1 seek=8 conv=notrunc 2>/dev/null
cp "$dir/short" "$c/run.checkpoint"
cp "$dir/short" "$dir/before/run.checkpoint"
refused 'it has another format, of another version of the program' $resume
printf 'nothing of the kind, but long enough to be read as a frame' >"$c/run.checkpoint"
cp "$c/run.checkpoint" "$dir/before/run.checkpoint"
refused 'it is no checkpoint' $resume

rm -rf "$dir/before"
cut_short swing.yaml
printf 'x' | dd of="$c/a.csv.partial" bs=1 seek=3 conv=notrunc 2>/dev/null
cp "$c/a.csv.partial" "$dir/before/a.csv.partial"
refused 'a.csv: cannot be resumed: it is not as the checkpoint has left it' $resume
: >"$c/a.csv.partial"
cp "$c/a.csv.partial" "$dir/before/a.csv.partial"
refused 'a.csv: cannot be resumed' $resume

# Ended by the user: the files have their names, and are gone on with all the same.
rm -rf "$c" "$dir/before"
"$program" run "$dir/swing.yaml" -o "$c" -q --checkpoint 0.01 2>"$dir/err" &
sleep 0.5
kill -TERM $! 2>/dev/null
wait $!
if [ -f "$c/run.checkpoint" ]; then
    says '--resume goes on'
    holds 'files have their names' [ -f "$c/a.csv" ]
fi
expect 'resumed after an end by the user' 0 $resume
rm -rf "$w"
"$program" run "$dir/swing.yaml" -o "$w" -q
holds 'the same after an end by the user' diff -r "$w" "$c"

# A checkpoint that cannot be written ends nothing; a plain run begins anew and takes it away.
rm -rf "$c"
mkdir -p "$c/run.checkpoint"
expect 'a folder is in the way' 0 "$program" run "$dir/swing.yaml" -o "$c" --checkpoint 0 --duration 0.5
says 'run.checkpoint cannot be written: Is a directory'
rm -rf "$c" "$dir/before"
cut_short swing.yaml
expect 'a run without --resume' 0 "$program" run "$dir/swing.yaml" -o "$c" -q
holds 'the checkpoint is gone' [ ! -e "$c/run.checkpoint" ]
holds 'the same, anew' diff -r "$w" "$c"

for wrong in -1 x 1s nan; do
    expect "--checkpoint $wrong" 2 "$program" run "$dir/swing.yaml" "--checkpoint=$wrong"
    says 'must be a number of seconds, 0 or more'
done

# Rows can be seen while a run goes on.
rm -rf "$c"
"$program" run "$dir/swing.yaml" -o "$c" -q --duration 1000 2>/dev/null &
tries=0
while [ "$(wc -l 2>/dev/null <"$c/a.csv.partial" || echo 0)" -lt 10 ] && [ $tries -lt 100 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
holds 'rows are there within seconds' [ $tries -lt 100 ]
kill -9 $! 2>/dev/null
wait $! 2>/dev/null
finish
