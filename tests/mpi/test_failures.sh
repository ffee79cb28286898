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

{ cat "$column" && echo 'flows: [{name: f, point: [0, 0, 0.01], normal: [0, 0, 1]}]'; } >"$dir/refused.yaml"
refuses flows
sed 's/^contact: {/contact: {audit: true, /' "$column" >"$dir/refused.yaml"
refuses audited
cp "$source/examples/models/oedometer.yaml" "$dir/refused.yaml"
sed -i 's/, audit: true//; s/dissipation.[a-z]*, //g' "$dir/refused.yaml"
refuses 'servo walls'
{
    sed 's/radius: \[[^]]*\], packing: lattice, jitter: [^,]*/clump: two, packing: lattice/' "$column"
    echo 'clumps: [{name: two, spheres: [{position: [0, 0, 0], radius: 0.002}, {position: [0.002, 0, 0], radius: 0.002}]}]'
} >"$dir/refused.yaml"
refuses clumps
{ cat "$column" && echo 'bonds: [{name: glue, gap: 0.001, young: 1e6}]'; } >"$dir/refused.yaml"
refuses bonded
cp "$source/examples/models/triaxial.yaml" "$dir/refused.yaml"
refuses 'in a cell'

# A bond that breaks before the run fails: who had bonds is refused, too.
cat >"$dir/refused.yaml" <<'END'
se3d: 1
gravity: [0, 0, 0]
materials: [{name: glass, density: 2500, stiffness: 100}]
contact: {law: hooke}
particles:
  - {name: up, material: glass, radius: 0.001, packing: lattice, spacing: 0.002, lower: [0, 0, 0.01], upper: [0.0021, 0.0021, 0.0121],
     velocity: [0, 0, 1]}
  - {name: down, material: glass, radius: 0.001, packing: lattice, spacing: 0.002, lower: [0, 0, 0.006], upper: [0.0021, 0.0021, 0.0081],
     velocity: [0, 0, -9]}
bonds: [{name: glue, gap: 0.01, young: 1e4, tensile_strength: 1}]
bodies: [{name: ground, shapes: [{type: plane, material: glass}]}]
analysis: {type: dynamics, duration: 0.1}
output: [{file: a.csv, every: 1e-4, channels: [glue.count]}]
END
"$SE3D_PROGRAM" run "$dir/refused.yaml" -o "$dir/refused" -q --checkpoint 0 2>"$dir/err"
holds "an overlap ends the run of one" grep -q 'overlap' "$dir/err"
holds "it leaves a checkpoint" test -s "$dir/refused/run.checkpoint"
share 2 run "$dir/refused.yaml" -o "$dir/refused" --resume
holds "refused: bonds that were" test "$status" -eq 2
holds "the message says so" grep -q 'share cannot be bonded' "$dir/err"

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
share 3 run "$column" -o "$dir/killed" --set $long --checkpoint 0 &
here=$!
own_processes() { # that may end meanwhile
    for entry in /proc/[0-9]*; do
        [ -r "$entry/cmdline" ] || continue
        case $(tr '\0' ' ' 2>/dev/null <"$entry/cmdline") in
        "$SE3D_MPI_PROGRAM run $column -o $dir/killed "*) echo "${entry#/proc/}" ;;
        esac
    done 2>/dev/null
}
tries=0
while [ ! -e "$dir/killed/run.checkpoint" ] && [ $tries -lt 1000 ]; do
    sleep 0.02
    tries=$((tries + 1))
done
victim=$(own_processes | tail -n 1)
holds "there is a process to kill" test -n "$victim"
kill -9 "$victim"
wait $here
holds "a killed process ends all" grep -q -i 'signal 9\|killed' "$dir/err"
holds "none is left" test -z "$(own_processes)"

share 2 run "$column" -o "$dir/killed" --set $long --resume
holds "two processes go on with what three had begun" test "$status" -eq 0
share 1 run "$column" -o "$dir/whole" --set $long
holds "the files are the same" diff -r "$dir/whole" "$dir/killed"

finish
