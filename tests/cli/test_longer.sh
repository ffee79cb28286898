# SPDX-License-Identifier: BSD-3-Clause
# A run that is gone on with and takes longer than it was to leaves the files of one in one go, be it
# over (--keep) or ended before its time; what would not be the same is refused and stays as it is.
# Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

w=$dir/whole
c=$dir/cut

printf 'v -0.1 %s %s\n' -1 0 1 0 1 0.1 1 1 -1 1 >"$dir/side.obj"
printf 'f %s\n' '1 2 3' '1 3 4' '1 4 5' >>"$dir/side.obj"
cat >"$dir/heap.yaml" <<'END'
se3d: 1
contact: {law: hooke}
materials: [{name: stone, density: 2500, stiffness: 1e5, rolling_friction: 0.05}]
particles:
  - {material: stone, radius: [0.008, 0.014], lower: [-0.1, -0.1, 0], upper: [0.1, 0.1, 0.1],
     packing: lattice, jitter: 1e-3}
bodies:
  - {name: ground, shapes: [{type: plane, material: stone}, {name: side, type: mesh, file: side.obj, material: stone}]}
  - {name: box, mass: 0.5, inertia: [1e-3, 1e-3, 1e-3], position: [0, 0, 0.3],
     shapes: [{type: box, size: [0.06, 0.06, 0.06], material: stone}]}
analysis: {type: dynamics, duration: 0.3}
output:
  - {file: a.csv, every: 0.002, channels: [box.position, energy.kinetic, steps]}
  - {file: p.csv, every: 0.05, particles: true}
  - {file: p.pvd, every: 0.1}
  - {average: m.csv, every: 0.01, start: 0.05, fields: {lower: [-0.1, -0.1, 0], upper: [0.1, 0.1, 0.2], cells: [2, 3, 4],
     width: 0.02}}
  - {wall_map: w.vtp, every: 0.01, start: 0.05, shape: side}
  - {summary: s.csv, every: 0.01, channels: [box.position]}
  - {file: q.h5, every: 0.05, particles: true}
  - {vtk: h.vtkhdf, every: 0.2}
END

cat >"$dir/swing.yaml" <<'END'
se3d: 1
parameters: {long: 2}
bodies:
  - {name: bar, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}
  - {name: rod, mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: knee, type: revolute, body_i: bar, body_j: rod, at: [1, 0, 0], axis: [0, 1, 0]}
events:
  - {name: "höher", channel: bar.position.x, value: 0.1}
analysis:
  - {type: dynamics, duration: "2", start: 1}
  - {type: dynamics, method: METHOD, duration: LENGTH}
output:
  - {file: a.csv, every: 0.01, channels: [bar.position, rod.velocity]}
  - {file: b.csv, every: 0.037, channels: [steps, rod.position.z]}
END

# length METHOD TEXT: the model with this method and duration of its last analysis
length() { sed "s/METHOD/$1/; s|LENGTH|$2|" "$dir/swing.yaml" >"$dir/s.yaml"; }

# same WHAT: both runs left the same files
same() {
    holds "$1: a checkpoint stays" [ ! -e "$c/run.checkpoint" ]
    holds "$1: not the same" diff -r "$w" "$c"
}

run() { "$program" run "$dir/$1" -q --no-estimate --json "$2" "$3" $4 >"$dir/json"; }

# Grains beside a body: the end is no row of every file.
run heap.yaml -o "$w" '--duration 0.3'
for before in 0.123 0.2 0.151; do
    rm -rf "$c"
    run heap.yaml -o "$c" "--duration $before --keep"
    holds "a checkpoint at $before s" [ -s "$c/run.checkpoint" ]
    holds "rows of q.h5 at $before s" [ -s "$c/q.h5.csv" ]
    expect "heap from $before" 0 "$program" run "$dir/heap.yaml" -o "$c" -q --duration 0.3 --resume
    same "heap from $before"
done

# Once more with the same duration; then longer, by the path; then shorter than was asked for.
rm -rf "$c"
run heap.yaml -o "$c" '--duration 0.2 --keep'
cp -r "$c" "$dir/before"
run heap.yaml -o "$c" '--duration 0.2 --keep --resume'
for file in a.csv m.csv p.csv q.h5 w.vtp; do
    holds "complete again: $file" cmp "$dir/before/$file" "$c/$file"
done
run heap.yaml -o "$c" '--set analysis.duration=0.25 --keep --resume'
run heap.yaml -o "$c" '--resume'
same 'heap in three parts'
rm -rf "$c" "$dir/before"
run heap.yaml -o "$c" '--duration 0.22 --keep'
cp -r "$c" "$dir/before"

# refused TEXT WORDS...: with this reason, and nothing is touched
refused() {
    reason=$1
    shift
    expect "refused: $reason" 1 "$program" run "$@" -o "$c" -q --no-estimate --resume
    says "$reason"
    holds "something was touched: $reason" diff -r "$dir/before" "$c"
}
refused 'it is of t = 0.218 s, the run is to end at t = 0.218 s' "$dir/heap.yaml" --duration 0.218
refused 'of a run with other options' "$dir/heap.yaml" --duration 0.3 --step 1e-5
refused 'of a run with other options' "$dir/heap.yaml" --duration 0.3 --set materials.stone.density=2600
sed -i.bak 's/duration: 0.3}/duration: 0.3, start: 1}/' "$dir/heap.yaml"
refused 'another model, or of one that was changed' "$dir/heap.yaml"

# Mechanisms, whose file says another duration, each with its method.
for method in auto dop853 rk45 radau bdf "generalized_alpha, step: 1e-3" "rattle, step: 1e-3"; do
    rm -rf "$w" "$c"
    length "$method" 3
    expect "long: $method" 0 "$program" run "$dir/s.yaml" -o "$w" -q --no-estimate
    length "$method" '"1.105"'
    expect "short: $method" 0 "$program" run "$dir/s.yaml" -o "$c" -q --no-estimate --keep
    length "$method" '"3"'
    expect "longer: $method" 0 "$program" run "$dir/s.yaml" -o "$c" -q --no-estimate --resume
    same "swing by $method"
done

# Killed before its end, and longer then.
rm -rf "$w" "$c"
length 'generalized_alpha, step: 2e-4' 30
expect 'long' 0 "$program" run "$dir/s.yaml" -o "$w" -q --no-estimate
length 'generalized_alpha, step: 2e-4' 20
"$program" run "$dir/s.yaml" -o "$c" -q --no-estimate --checkpoint 0 2>/dev/null &
tries=0
while [ ! -s "$c/run.checkpoint" ] && [ $tries -lt 200 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
kill -9 $! 2>/dev/null
wait $! 2>/dev/null
length 'generalized_alpha, step: 2e-4' 30
expect 'longer after a kill' 0 "$program" run "$dir/s.yaml" -o "$c" -q --no-estimate --resume
same 'killed'

# What depends on the end: steps that are chosen by the whole run, rows by its duration, what is over.
again() {
    rm -rf "$c" "$dir/before"
    "$program" run "$1" -o "$c" -q --no-estimate --keep 2>"$dir/err"
    cp -r "$c" "$dir/before"
}
length rattle 1
again "$dir/s.yaml"
length rattle 2
refused 'steps were chosen for an end at t = 4 s, not at 5 s: only with a `step`' "$dir/s.yaml"
length dop853 1
sed -i.bak 's/every: 0.037, //' "$dir/s.yaml"
again "$dir/s.yaml"
sed -i.bak 's/, duration: 1}/, duration: 2}/' "$dir/s.yaml"
refused 'rows of `b.csv` are a 500th of the duration apart' "$dir/s.yaml"
length dop853 1
again "$dir/s.yaml"
sed -i.bak 's/duration: "2"/duration: "2.5"/' "$dir/s.yaml"
refused 'analysis 1 is over and took 2 s, its duration is 2.5 s now' "$dir/s.yaml"
length dop853 long/2
sed -i.bak 's/long: 2/long: 3/' "$dir/s.yaml"
refused 'another model, or of one that was changed' "$dir/s.yaml"

# Nothing to keep.
length dop853 2
sed -i.bak 's/value: 0.1}/value: 0.1, action: stop}/' "$dir/s.yaml"
rm -rf "$c"
expect 'an event ends it' 0 "$program" run "$dir/s.yaml" -o "$c" --no-estimate --keep
says 'no checkpoint is kept'
finish
