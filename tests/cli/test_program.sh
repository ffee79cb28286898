# SPDX-License-Identifier: BSD-3-Clause
# The se3d program: exit codes, messages, files. Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

expect 'no arguments' 2 "$program"
expect 'help' 0 "$program" --help
has "$dir/out" 'se3d run MODEL'
expect 'version' 0 "$program" --version
has "$dir/out" 'se3d '
expect 'unknown command' 2 "$program" fly
has "$dir/err" 'unknown command `fly`; there are: run, check, evaluate'
for command in run check evaluate; do
    expect "$command --help" 0 "$program" $command --help
    has "$dir/out" "se3d $command MODEL"
    expect "$command without a model" 2 "$program" $command
    has "$dir/err" 'which model?'
    expect "$command with an unknown option" 2 "$program" $command --wings x.yaml
    has "$dir/err" 'unknown option `--wings`'
    expect "$command with a missing file" 2 "$program" $command "$dir/none.yaml"
    has "$dir/err" "$dir/none.yaml: "
done
expect 'two models' 2 "$program" run a.yaml b.yaml
expect 'an option without its value' 2 "$program" run a.yaml --step
expect '--set without a value' 2 "$program" run a.yaml --set L
expect '--time is not an option of run' 2 "$program" run a.yaml --time 1

expect 'pendulum' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p"
has "$dir/out" 'inverse_dynamics, romega: success'
has "$dir/out" "wrote $dir/p/pendulum.csv: 1001 rows, 28 columns"
is "$(wc -c <"$dir/err" | tr -d ' ')" 0
is "$(wc -l <"$dir/p/pendulum.csv" | tr -d ' ')" 1002
is "$(head -1 "$dir/p/pendulum.csv" | cut -d, -f1-9)" \
    'time,bar.position.x,bar.position.y,bar.position.z,bar.orientation.e0,bar.orientation.e1,bar.orientation.e2,bar.orientation.e3,bar.velocity.x'
is "$(tail -1 "$dir/p/pendulum.csv" | cut -d, -f1)" 10
is "$(ls "$dir/p" | tr '\n' ' ')" 'pendulum.csv scene.glb '

printf 'se3d:  1\nbodies:\n- {name: a,mass: 1}   # one\n' >"$dir/messy.yaml"
cp "$dir/messy.yaml" "$dir/kept.yaml"
expect 'fmt --check of a mess' 1 "$program" fmt --check "$dir/messy.yaml"
has "$dir/out" 'messy.yaml: its layout would change'
is "$(cmp "$dir/messy.yaml" "$dir/kept.yaml")" ''
expect 'fmt of standard input' 0 "$program" fmt - <"$dir/messy.yaml"
cp "$dir/out" "$dir/made.yaml"
is "$(cat "$dir/made.yaml")" "$(printf 'se3d: 1\nbodies:\n  - {name: a, mass: 1}  # one')"
expect 'fmt' 0 "$program" fmt "$dir/messy.yaml"
has "$dir/out" "laid out $dir/messy.yaml"
is "$(cmp "$dir/messy.yaml" "$dir/made.yaml")" ''
expect 'fmt of what is laid out' 0 "$program" fmt --check "$dir/messy.yaml"
is "$(cat "$dir/out" "$dir/err")" ''
printf 'a: [1\n' >"$dir/open.yaml"
expect 'fmt of what is no YAML' 2 "$program" fmt "$dir/open.yaml"
has "$dir/err" 'open.yaml:2:1: syntax error'

expect 'quiet' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p2" --quiet --duration 0.1
if ! command -v script >/dev/null || ! script -qec true /dev/null >/dev/null 2>&1; then
    echo 'SKIPPED: no script or no terminals here: what a terminal shows was not looked at' >&2
else
    script -qec "$program run $models/pendulum.yaml -o $dir/p2 --duration 0.1" /dev/null >"$dir/out"
    has "$dir/out" "se3d view $dir/p2"
fi
expect 'every' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p2" -q --duration 0.1 --every 0.05
holds 'rows at other times' [ "$(grep -c . "$dir/p2/pendulum.csv")" = 4 ]
is "$(cat "$dir/out" "$dir/err")" ''
expect 'no folder -' 2 sh -c 'cd "$2" && "$0" run "$1" -o - -q' "$program" "$models/pendulum.yaml" "$dir"
says 'results are not for standard output'
says '--print -'
holds 'a folder -' [ ! -e "$dir/-" ]
expect 'rows printed' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p3" --duration 0.1 --print -
holds 'other rows' cmp "$dir/out" "$dir/p3/pendulum.csv"
holds 'more than rows' [ ! -s "$dir/err" ]
expect 'rows printed' 0 sh -c '"$0" run - -o "$2" --duration 0.1 --print pendulum.csv <"$1"' "$program" \
    "$models/pendulum.yaml" "$dir/p3"
holds 'other rows' cmp "$dir/out" "$dir/p3/pendulum.csv"
expect 'no such file' 2 "$program" run "$models/pendulum.yaml" -o "$dir/p4" --print none.csv
says 'has no such file'
holds 'it ran' [ ! -e "$dir/p4" ]
expect 'both' 2 "$program" run "$models/pendulum.yaml" -o "$dir/p4" --print - --json
says 'not for both'
expect 'a model to standard output' 0 "$program" write "$models/pendulum.yaml" -o -
has "$dir/out" 'se3d: 1'
expect 'threads' 0 "$program" run "$source/tests/mpi/column.yaml" -q --duration 0.01 --threads 1 -o "$dir/t1"
expect 'threads' 0 "$program" run "$source/tests/mpi/column.yaml" -q --duration 0.01 --threads 2 -o "$dir/t2"
holds 'other results' cmp "$dir/t1/column.csv" "$dir/t2/column.csv"
expect 'no threads' 2 "$program" run "$source/tests/mpi/column.yaml" -q --threads 0 -o "$dir/t1"
says '--threads: is 0, must be a whole number from 1 to 1024'
expect 'threads of no particles' 0 "$program" run "$models/pendulum.yaml" -q --duration 0.01 --threads 2 -o "$dir/t1"
expect 'no threads of no particles' 2 "$program" run "$models/pendulum.yaml" -q --threads 1.5 -o "$dir/t1"
says '--threads: is 1.5'
expect 'the same bits on every run' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p3" -q
is "$(cksum <"$dir/p/pendulum.csv")" "$(cksum <"$dir/p3/pendulum.csv")"
expect 'json' 0 "$program" run "$models/pendulum.yaml" -o "$dir/p4" --json --duration=0.1 --formulation rp
has "$dir/out" '"status": "done"'
has "$dir/out" '"formulation": "rp"'
has "$dir/out" '"rows": 11'
if command -v python3 >/dev/null 2>&1; then
    cp "$dir/out" "$dir/summary.json"
    expect 'json is json' 0 python3 -c 'import json,sys; json.load(open(sys.argv[1]))' "$dir/summary.json"
fi
(cd "$dir" && expect 'default folder' 0 "$program" run "$models/pendulum.yaml" -q --duration 0.1)
is "$(ls "$dir/results/pendulum" | tr '\n' ' ')" 'pendulum.csv scene.glb '

expect 'parameters' 0 "$program" run "$models/pendulum_free.yaml" -o "$dir/f" \
    --set theta0=30*deg --set L=1 --step 0.01 --duration 0.055
is "$(sed -n 2p "$dir/f/pendulum_free.csv" | cut -d, -f2)" 0.52359877559829882
is "$(tail -1 "$dir/f/pendulum_free.csv" | cut -d, -f1)" 0.055
expect 'a place of the document' 0 "$program" run "$models/fourbar.yaml" -o "$dir/s" -q \
    --set bodies.coupler.mass='2 kg' --set 'bodies[1].inertia=[1/10, 1e-3, 1/10]' \
    --set analysis.duration=0.05 --set analysis.step=2e-3
sed -e '/name: coupler/s/mass: 1,/mass: 2,/' -e '/name: right/s|\[1/12, 1e-3, 1/12\]|[1/10, 1e-3, 1/10]|' \
    -e 's/duration: 10, step: 0.001/duration: 0.05, step: 2e-3/' \
    "$models/fourbar.yaml" >"$dir/fourbar.yaml"
expect 'the same written out' 0 "$program" run "$dir/fourbar.yaml" -o "$dir/w" -q
is "$(cat "$dir/s/fourbar.csv")" "$(cat "$dir/w/fourbar.csv")"
expect 'a model from standard input' 0 sh -c '"$0" run - -o "$2" -q <"$1"' "$program" \
    "$dir/fourbar.yaml" "$dir/i"
is "$(cat "$dir/i/fourbar.csv")" "$(cat "$dir/w/fourbar.csv")"
expect 'a wrong one' 2 sh -c 'echo "se3d: 2" | "$0" check -' "$program"
has "$dir/err" 'stdin:1:7: se3d: is 2, must be 1'
expect 'an empty one' 2 sh -c '"$0" check - </dev/null' "$program"
has "$dir/err" 'stdin:1:1: is empty'

expect 'a file for fmu' 2 "$program" fmu -
has "$dir/err" 'the model must be a file, which is packed, not standard input'

expect 'channels' 0 "$program" channels "$models/fourbar.yaml" --match coupler
has "$dir/out" 'coupler.acceleration          [m/s^2]  x, y, z'
is "$(grep -vc coupler "$dir/out")" 0
for kind in pendulum slider-crank contact; do
    expect "a new $kind" 0 "$program" new "$dir/$kind.yaml" --kind $kind
    expect "runs" 0 "$program" run "$dir/$kind.yaml" -o "$dir/$kind" --strict
done
expect 'what is there stays' 1 "$program" new "$dir/pendulum.yaml"
has "$dir/err" 'pendulum.yaml: is there already'
expect 'no such kind' 2 "$program" new "$dir/other.yaml" --kind car
has "$dir/err" 'the kind is `car`, must be pendulum, slider-crank or contact'
expect 'no model' 2 "$program" new "$dir/other.txt"
has "$dir/err" 'must end with .yaml or .yml'
expect 'write prints the model' 0 "$program" write "$models/pendulum.yaml" --set L=3
has "$dir/out" 'type: revolute'
cp -R "$models/axle.yaml" "$models/parts" "$dir"
{
    cat "$models/axle.yaml"
    printf 'events:\n  - {name: up, channel: left_wheel.travel, value: 1 mm}\n'
} >"$dir/stopped.yaml"
expect 'write a file with units' 1 "$program" write "$dir/stopped.yaml" -o "$dir/written.yaml"
has "$dir/err" 'cannot be written: events (of a file with units); `--partial` leaves it out'
expect 'write' 0 "$program" write "$dir/stopped.yaml" --partial -o "$dir/written.yaml"
is "$(tail -1 "$dir/written.yaml")" '# Left out: events (of a file with units)'
expect 'what is written is a model' 0 "$program" write "$dir/written.yaml" -o "$dir/again.yaml"
sed '$d' "$dir/written.yaml" >"$dir/whole.yaml"
expect 'and is written as itself' 0 cmp "$dir/whole.yaml" "$dir/again.yaml"
expect 'write over the model' 2 "$program" write "$dir/axle.yaml" -o "$dir/axle.yaml"
has "$dir/err" 'comments and expressions would be lost'
ln -s axle.yaml "$dir/link.yaml"
ln "$dir/parts/corner.yaml" "$dir/hard.yaml"
for target in ./axle.yaml link.yaml parts/corner.yaml hard.yaml; do
    expect "write over a source by $target" 2 "$program" write "$dir/axle.yaml" -o "$dir/$target"
    has "$dir/err" "$target: is a file of the model itself"
done
is "$(cat "$dir/axle.yaml")" "$(cat "$models/axle.yaml")"
is "$(cat "$dir/parts/corner.yaml")" "$(cat "$models/parts/corner.yaml")"
mkfifo "$dir/pipe.yaml"
expect 'write over a pipe' 1 "$program" write "$models/pendulum.yaml" -o "$dir/pipe.yaml"
has "$dir/err" 'pipe.yaml: cannot be written: is no regular file'
[ -p "$dir/pipe.yaml" ] || fail 'the pipe is gone'
cp "$models/bracket.obj" "$dir"
cat >"$dir/mirrored.yaml" <<'END_OF_YAML'
se3d: 1
parts: {half: {bodies: [{name: plate, mass: 1, inertia: [1, 1, 1], shapes: [{type: mesh, file: bracket.obj}]}]}}
instances: [{part: half, prefix: right_, mirror: y}]
END_OF_YAML
expect 'print a mesh that is mirrored' 1 "$program" write "$dir/mirrored.yaml"
has "$dir/err" 'a shape of body right_plate, file bracket.obj: a mesh that is mirrored has no file'
expect 'write to nowhere' 1 "$program" write "$models/pendulum.yaml" -o /dev/null/axle.yaml
expect 'import without a file' 2 "$program" import
has "$dir/err" 'which model? Give a file'
expect 'JSON, line by line' 0 "$program" run "$dir/pendulum.yaml" -o "$dir/pendulum" --json-lines
is "$(head -1 "$dir/out")" '{"analysis": 0, "time": 0, "fraction": 0}'
is "$(wc -l <"$dir/out" | awk '{ print ($1 > 90 && $1 < 110) }')" 1
is "$(tail -1 "$dir/out" | cut -c1-18)" '{"status": "done",'

expect 'an unknown parameter' 2 "$program" run "$models/pendulum_free.yaml" --set theta=1
has "$dir/err" 'did you mean `theta0`?'
expect 'an event stops' 0 "$program" run "$models/pendulum_events.yaml" -o "$dir/e"
has "$dir/out" 'stopped by event tired at t = 17.41005'
has "$dir/out" '20 events, see events.csv'
is "$(head -1 "$dir/e/events.csv")" 'time,event,channel,value,direction'
is "$(tail -1 "$dir/e/events.csv" | cut -d, -f2,3,5)" 'tired,energy.total,falling'
is "$(tail -1 "$dir/e/events.csv" | cut -d, -f1)" "$(tail -1 "$dir/e/pendulum_events.csv" | cut -d, -f1)"
expect 'events in json' 0 "$program" run "$models/pendulum_events.yaml" -o "$dir/e" --json
has "$dir/out" '"event": "tired", "channel": "energy.total", "value": '
has "$dir/out" '"direction": "falling", "stopped": true}'
cat >"$dir/flow.yaml" <<'END'
se3d: 1
materials: [{name: glass, density: 2500, stiffness: 1e4}]
particles:
  - {name: sand, material: glass, radius: 0.01, lower: [0, 0, 0], upper: [0.1, 0.1, 0.03]}
  - {name: rain, material: glass, radius: 0.01, lower: [0, 0, 1], upper: [0.1, 0.1, 1.1], source: {rate: 100}}
sinks: [{point: [0, 0, -0.1], normal: [0, 0, 1]}]
analysis: {type: dynamics, duration: 0.2}
END
expect 'what left' 0 "$program" run "$dir/flow.yaml" -o "$dir/flow"
has "$dir/out" 'particles sand: 0 at the end, 16 left'
has "$dir/out" 'particles rain: 20 at the end, 0 left, 20 inserted (0 had to wait for room)'
expect 'what left in json' 0 "$program" run "$dir/flow.yaml" -o "$dir/flow" --json
has "$dir/out" '{"name": "sand", "count": 0, "left": 16, "inserted": 0, "deferred": 0}'
sed '/^events:/,/name: tired/d' "$models/pendulum_events.yaml" >"$dir/plain.yaml"
grep -v 'name: tired' "$models/pendulum_events.yaml" >"$dir/recorded.yaml"
expect 'without events' 0 "$program" run "$dir/plain.yaml" -o "$dir/plain" --duration 5
expect 'with recorded events' 0 "$program" run "$dir/recorded.yaml" -o "$dir/recorded" --duration 5
expect 'recording changes no bit' 0 cmp "$dir/plain/pendulum_events.csv" \
    "$dir/recorded/pendulum_events.csv"
is "$(ls "$dir/plain" "$dir/recorded" | grep -c events.csv)" 3

cat >"$dir/stiffens.yaml" <<'MODEL'
se3d: 1
bodies: [{name: bar, mass: 10, inertia: [0.01, 10/12, 10/12], position: [0.5, 0, 0]}]
gravity: [0, -9.81, 0]
joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 0, 1]}]
forces: [{name: damper, type: rsda, joint: pin, h: "exp(6*t)*thetadot"}]
analysis: {type: dynamics, duration: 3}
MODEL
expect 'auto says when it changes' 0 "$program" run "$dir/stiffens.yaml" -o "$dir/stiffens"
has "$dir/out" 'dynamics, romega, radau: success'
has "$dir/out" 'auto left dop853 for radau at t = 1.3'
expect 'auto says it in json' 0 "$program" run "$dir/stiffens.yaml" -o "$dir/stiffens" --json
has "$dir/out" '"left": "dop853", "left_at": 1.3'

cat >"$dir/crank.yaml" <<'MODEL'
se3d: 1
bodies:
  - {name: crank, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0], angular_velocity: [0, 0, 6], velocity: [0, 3, 0]}
  - {name: rod, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1.5, 0, 0]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 0, 1]}
  - {name: knee, type: revolute, body_i: crank, body_j: rod, at: [1, 0, 0], axis: [0, 0, 1]}
analysis: {type: dynamics, duration: 0.01}
MODEL
expect 'a start that does not fit is told' 0 "$program" run "$dir/crank.yaml" -o "$dir/crank"
has "$dir/out" 'the given velocities do not fit: changed by '
expect 'a start that does not fit is told in json' 0 "$program" run "$dir/crank.yaml" -o "$dir/crank" --json
has "$dir/out" '"start_change": {"moved": "", "deflected": "'

expect 'another analysis' 0 "$program" run "$models/pendulum_free.yaml" -o "$dir/a" --analysis assembly
is "$(wc -l <"$dir/a/pendulum_free.csv" | tr -d ' ')" 2

cat >"$dir/plain.yaml" <<'END'
se3d: 1
bodies: [{name: ball, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
END
expect 'nothing to run' 2 "$program" run "$dir/plain.yaml"
has "$dir/err" 'there is nothing to run'
expect 'default output' 0 "$program" run "$dir/plain.yaml" -o "$dir/d" --analysis dynamics \
    --duration 1 --step 0.1
is "$(head -1 "$dir/d/results.csv" | cut -d, -f1-4)" 'time,ball.position.x,ball.position.y,ball.position.z'
is "$(wc -l <"$dir/d/results.csv" | tr -d ' ')" 12

cat >"$dir/two.yaml" <<'END'
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: ball, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
analysis:
  - {type: dynamics, duration: 1, step: 0.1}
  - {type: dynamics, duration: 1, step: 0.2}
output:
  - {file: sub/a.csv, channels: [ball.position]}
  - {file: b.csv, every: 0.3, channels: [ball.velocity]}
END
expect 'two analyses, two files' 0 "$program" run "$dir/two.yaml" -o "$dir/t"
is "$(cut -d, -f1 "$dir/t/sub/a.csv" | wc -l | tr -d ' ')" 17
is "$(tail -1 "$dir/t/sub/a.csv" | cut -c1-2)" '2,'
is "$(awk -F, 'NR > 1 { printf "%.6g ", $1 }' "$dir/t/b.csv")" '0 0.3 0.6 0.9 1 1.3 1.6 1.9 2 '

cat >"$dir/bad.yaml" <<'END'
se3d: 1
bodies:
  - name: bar
    mass: -1
END
expect 'a bad model' 2 "$program" run "$dir/bad.yaml"
is "$(cat "$dir/err")" "$dir/bad.yaml:4:11: bodies[0].mass: is -1, must be finite and > 0
     4 |     mass: -1
       |           ^"
cat >"$dir/worse.yaml" <<'END'
se3d: 1
bodies:
	- {name: bar}
END
expect 'a tab' 2 "$program" check "$dir/worse.yaml"
has "$dir/err" '3:1: syntax error'
cat >"$dir/worse.yaml" <<'END'
se3d: 1
bodies: [{name: größe, mass: 1, inertia: [1, 1]}, {name: b, mass: 1, inertia: [1, 1, 1], omega: 3}]
joints: [{type: hinge, body_i: ground, body_j: größe, at: [0, 0, 0], axis: [0, 0, 1]}]
END
expect 'several mistakes' 2 "$program" check --json "$dir/worse.yaml"
has "$dir/err" ':2:42: bodies[0].inertia: must be'
has "$dir/err" ':2:90: bodies[1]: the key `omega` is unknown, did you mean `angular_velocity`?'
has "$dir/err" ':3:17: joints[0].type: the joint type `hinge` is not supported, did you mean `revolute`?'
has "$dir/err" '       |                 ^'
has "$dir/err" '4 mistakes'
has "$dir/out" "\"mistakes\": [{\"file\": \"$dir/worse.yaml\", \"line\": 2, \"column\": 42, \"message\": "
has "$dir/out" '"path": "bodies[1]", "suggestion": "angular_velocity"}'
has "$dir/out" '"path": "joints[0].type", "suggestion": "revolute"}'
printf '\357\273\277se3d: 2\n' >"$dir/worse.yaml"
expect 'a mark of the byte order' 2 "$program" check "$dir/worse.yaml"
has "$dir/err" '     1 | se3d: 2'
printf 'se3d: 1\r# other\302\205# ends\342\200\250bodies: [{name: a, mass: foo}]\r\n' >"$dir/worse.yaml"
expect 'other ends of lines' 2 "$program" check "$dir/worse.yaml"
has "$dir/err" ':4:26: bodies[0].mass: '
has "$dir/err" '     4 | bodies: [{name: a, mass: foo}]'
if mkfifo "$dir/pipe" 2>/dev/null; then
    cat "$dir/worse.yaml" >"$dir/pipe" &
    expect 'a pipe, which is read once' 2 "$program" check "$dir/pipe"
    has "$dir/err" ':4:26: bodies[0].mass: '
fi

# From t = 0.95 s on the constraint asks for more than the rod can reach.
cat >"$dir/reach.yaml" <<'END'
se3d: 1
bodies: [{name: rod, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: rod, at: [0, 0, 0], axis: [0, 0, 1]}]
constraints:
  - {name: height, type: cd, body_i: ground, body_j: rod, c: [0, 1, 0], value: "if(t > 0.95, 2, 0)"}
analysis: {type: kinematics, duration: 4, step: 0.1}
output: [{file: r.csv, channels: [rod.position]}]
END
expect 'a locked position' 1 "$program" run "$dir/reach.yaml" -o "$dir/r"
has "$dir/err" 'the kinematics analysis failed at t = '
has "$dir/err" 'What to try: '
has "$dir/out" "wrote $dir/r/r.csv: "
is "$(ls "$dir/r" | tr '\n' ' ')" 'r.csv scene.glb '

expect 'a folder that cannot be made' 1 "$program" run "$models/pendulum.yaml" -o "$dir/bad.yaml/x"
has "$dir/err" 'cannot be written'
# A full disk, played by a limit on the size of files.
# rows_are_whole FILE: as many columns in each row as names, and at least 3 rows
rows_are_whole() {
    holds "rows of $1 are cut" awk -F, 'NR == 1 { n = NF } NF != n { bad = 1 } END { exit bad || NR < 4 }' "$1"
}
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 16; exec "$@"' sh \
    "$program" run "$models/pendulum.yaml" -o "$dir/full"
has "$dir/err" 'pendulum.csv: cannot be written: File too large; the first '
has "$dir/err" "$(($(wc -l <"$dir/full/pendulum.csv") - 1)) rows are kept"
has "$dir/out" "wrote $dir/full/pendulum.csv: $(($(wc -l <"$dir/full/pendulum.csv") - 1)) rows, 28 columns"
rows_are_whole "$dir/full/pendulum.csv"
is "$(ls "$dir/full")" 'pendulum.csv'
# A scene that has no room: the results stay, the error names the scene, and the next one is tried.
cat >"$dir/drawn.yaml" <<EOF
se3d: 1
bodies:
  - {name: a, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0], shapes: [{type: sphere, radius: 0.1}]}
joints: [{name: s, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}]
analysis: {type: dynamics, duration: 1}
output: [{file: a.csv, every: 0.05, channels: [s.angle]}, {scene: other.glb}]
EOF
expect 'a scene on a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 4; exec "$@"' sh \
    "$program" run "$dir/drawn.yaml" -o "$dir/drawn"
has "$dir/err" "$dir/drawn/scene.glb: cannot be written: File too large"
has "$dir/err" "$dir/drawn/other.glb: cannot be written: File too large"
has "$dir/out" "wrote $dir/drawn/a.csv: 21 rows, 2 columns"
is "$(ls "$dir/drawn")" 'a.csv'
expect 'a limit that nobody asked to survive' 1 sh -c 'ulimit -f 16; exec "$@"' sh \
    "$program" run "$models/pendulum.yaml" -o "$dir/limit"
rows_are_whole "$dir/limit/pendulum.csv"
mkdir -p "$dir/taken/pendulum.csv/x"
expect 'a folder in the place of the results' 1 "$program" run "$models/pendulum.yaml" -o "$dir/taken"
has "$dir/err" 'pendulum.csv: cannot be written: Is a directory'

# Files of the results stay in their folder.
mkdir -p "$dir/links/away" "$dir/links/r"
ln -s ../away "$dir/links/r/sub"
ln -s ../away/b.csv "$dir/links/r/b.csv.partial"
sed 's/a.csv/sub\/a.csv/' >"$dir/away.yaml" <<'END'
se3d: 1
bodies: [{name: ball, mass: 1, inertia: [1, 1, 1]}]
analysis: {type: dynamics, duration: 0.1}
output: [{file: b.csv, channels: [ball.position]}, {file: a.csv, channels: [ball.position]}]
END
expect 'a folder that is a link' 1 "$program" run "$dir/away.yaml" -o "$dir/links/r"
has "$dir/err" 'sub/a.csv: cannot be written: a symbolic link leads out'
is "$(ls "$dir/links/away")" ''
rm "$dir/links/r/sub"
expect 'a link in the place of a file' 0 "$program" run "$dir/away.yaml" -o "$dir/links/r"
is "$(ls "$dir/links/away")" ''

# Ended in the middle: the rows so far are on disk.
cat >"$dir/long.yaml" <<'END'
se3d: 1
bodies: [{name: ball, mass: 1, inertia: [1, 1, 1]}]
analysis: {type: dynamics, duration: 1e6, step: 0.01, method: rattle}
output: [{file: l.csv, channels: [ball.position]}]
END
"$program" run "$dir/long.yaml" -o "$dir/l" >/dev/null 2>"$dir/err.long" &
child=$!
until [ -s "$dir/l/l.csv.partial" ]; do kill -0 $child || break; done
kill -TERM $child
expect 'ended by a signal' 1 wait $child
has "$dir/err.long" 'ended by the user at t = '
is "$(ls "$dir/l" | tr '\n' ' ')" 'l.csv scene.glb '
is "$(awk -F, 'NF != 4 { print "cut" }' "$dir/l/l.csv")" ''

"$program" run "$dir/long.yaml" -o "$dir/hup" >/dev/null 2>"$dir/err.long" &
child=$!
until [ -s "$dir/hup/l.csv.partial" ]; do kill -0 $child || break; done
kill -HUP $child
kill -HUP $child
expect 'ended with its terminal, which is told twice' 1 wait $child
has "$dir/err.long" 'ended by the user at t = '
is "$(ls "$dir/hup" | tr '\n' ' ')" 'l.csv scene.glb '
sh -c 'trap "" HUP; exec "$@"' sh "$program" run "$dir/long.yaml" -o "$dir/nohup" >/dev/null 2>"$dir/err.long" &
child=$!
until [ -s "$dir/nohup/l.csv.partial" ]; do kill -0 $child || break; done
kill -HUP $child
sleep 0.2
expect 'who asks to survive the terminal does' 0 kill -TERM $child
expect 'and is ended by another signal' 1 wait $child
is "$(ls "$dir/nohup" | tr '\n' ' ')" 'l.csv scene.glb '

# Without memory for the scene the run has its rows, and says what it lacks.
awk 'BEGIN {
    print "se3d: 1\nbodies:"
    for (k = 0; k < 12000; ++k) print "  - {name: b" k ", mass: 1, inertia: [1, 1, 1], position: [" k ", 0, 0]}"
    print "analysis: {type: dynamics, duration: 0.02, step: 0.01, method: verlet}\noutput: [{file: m.csv, channels: [b0.position]}]"
}' >"$dir/many.yaml"
if grep -q __asan_init "$program"; then
    echo 'SKIPPED: runs in little address space; AddressSanitizer needs 16 TB of it'
else
    expect 'no memory for the scene' 1 sh -c 'ulimit -v 750000; exec "$@"' sh "$program" run "$dir/many.yaml" -o "$dir/many" --json
    has "$dir/err" 'many/scene.glb: cannot be made: out of memory'
    has "$dir/out" '"status": "failed"'
    rows_are_whole "$dir/many/m.csv"
    # Nothing that is linked starts threads or takes memory when it is loaded.
    expect 'a run in 60 MB' 0 sh -c 'ulimit -v 60000; exec "$@"' sh "$program" run "$models/pendulum.yaml" -o "$dir/small" -q
fi

# Ended in the middle of a row that nobody would wait for, in every method: the rows end there.
cat >"$dir/row.yaml" <<'END'
se3d: 1
bodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]
joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}]
drivers: [{name: d, joint: j, value: 1e6*t}]
analysis: {type: dynamics, duration: 50}
output: [{file: row.csv, every: 50, channels: [a.angular_velocity]}]
END
# --tolerance replaces that of the file: the tighter, the more steps
cat >"$dir/swing.yaml" <<'END'
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}]
forces: [{type: force, body: a, value: ["1 - exp(t)", 0, 0]}]
analysis: {type: dynamics, duration: 4, method: bdf, tolerance: 1e-3}
output: [{file: row.csv, every: 4, channels: [a.position]}]
END
for tolerance in 1e-3 1e-5 1e-9; do
    expect 'run with a tolerance' 0 "$program" run "$dir/swing.yaml" -o "$dir/swing" --tolerance $tolerance
    steps=$(sed -n 's/.* s, \([0-9]*\) steps.*/\1/p' "$dir/out")
    is "$([ "$steps" -gt "${fewer:-0}" ] && echo more)" more
    fewer=$steps
done
expect 'a tolerance of zero' 2 "$program" run "$dir/swing.yaml" -o "$dir/swing" --tolerance 0
expect 'a tolerance that is too large' 2 "$program" run "$dir/swing.yaml" -o "$dir/swing" --tolerance 2

for method in radau bdf dop853 'rk45 --step 1e-7' 'rk4 --step 1e-7' 'hht --step 1e-7' \
    'generalized_alpha --step 1e-7' 'rattle --step 1e-7' 'verlet --step 1e-7'; do
    for signal in INT TERM; do
        rm -rf "$dir/row"
        # shellcheck disable=SC2086
        "$program" run "$dir/row.yaml" -o "$dir/row" --method $method >"$dir/out" 2>"$dir/err.row" &
        child=$!
        until [ -e "$dir/row/row.csv.partial" ]; do kill -0 $child || break; done
        sleep 0.1
        kill -$signal $child
        expect "$method ended by $signal" 1 wait $child
        has "$dir/err.row" 'ended by the user at t = '
        is "$(ls "$dir/row" | tr '\n' ' ')" 'row.csv scene.glb '
        # The last row is the end, or the start if the first step was not made yet.
        rows='3 4 1'
        ! grep -q 'ended by the user at t = 0 s' "$dir/err.row" || rows='2 4 0'
        is "$(awk -F, 'END { print NR, NF, ($1 > 0 && $1 < 50) }' "$dir/row/row.csv")" "$rows"
    done
done

# Nobody reads what is printed.
name='a reader that goes away'
(sleep 1; "$program" run "$models/pendulum.yaml" -o "$dir/gone" --duration 0.1 2>"$dir/err"; echo $? >"$dir/code") | :
is "$(cat "$dir/code")" 1
has "$dir/err" 'standard output cannot be written'
is "$(ls "$dir/gone" | tr '\n' ' ')" 'pendulum.csv scene.glb '

# Names with blanks and letters of any script become headers and names of files as they are.
cat >"$dir/names.yaml" <<'END'
se3d: 1
bodies: [{name: 'Körper 1 ☃', mass: 1, inertia: [1, 1, 1]}]
analysis: {type: dynamics, duration: 0.1}
output: [{file: 'Ordner mit Platz/Lauf ☃ (1).csv', channels: ['Körper 1 ☃.position']}]
END
expect 'names of any script' 0 "$program" run "$dir/names.yaml" -o "$dir/n n"
is "$(head -1 "$dir/n n/Ordner mit Platz/Lauf ☃ (1).csv")" \
    'time,Körper 1 ☃.position.x,Körper 1 ☃.position.y,Körper 1 ☃.position.z'
# A mark of the byte order, CR LF.
{ printf '\357\273\277'; sed 's/$/\r/' "$dir/long.yaml"; } >"$dir/crlf.yaml"
expect 'a byte order mark and CR LF' 0 "$program" run "$dir/crlf.yaml" -o "$dir/crlf" -q --duration 0.1
# Rubbish, too deep, too long.
head -c 100000 "$program" >"$dir/rubbish.yaml"
expect 'binary rubbish' 2 "$program" run "$dir/rubbish.yaml"
awk 'BEGIN { printf "se3d: 1\nbodies: "; for (k = 0; k < 100000; ++k) printf "[" }' >"$dir/deep.yaml"
expect 'deep nesting' 2 "$program" run "$dir/deep.yaml"
has "$dir/err" 'deep.yaml:2:'
awk 'BEGIN { print "se3d: 1"; for (k = 0; k < 2000000; ++k) print "# 0123456789012345678901234567890" }' \
    >"$dir/large.yaml"
expect 'a file of 72 MB' 2 "$program" run "$dir/large.yaml"
has "$dir/err" 'large.yaml'
rm "$dir/large.yaml"
# A folder that cannot be written; what is there already.
if [ "$(id -u)" -ne 0 ]; then
    mkdir -m 500 "$dir/locked"
    expect 'a folder without permission' 1 "$program" run "$models/pendulum.yaml" -o "$dir/locked"
    has "$dir/err" 'cannot be written'
fi
echo kept >"$dir/p/notes.txt"
cp "$dir/p/pendulum.csv" "$dir/before.csv"
printf 'se3d: 1\nbodies: [{name: b%090d, mass: 1, inertia: [1, 1, 1]}]\nanalysis: {type: dynamics, duration: 0.1}\n' 0 >"$dir/wide.yaml"
cp "$dir/before.csv" "$dir/p/results.csv"
expect 'a disk without room for a row' 1 sh -c 'ulimit -f 1; exec "$@"' sh "$program" run "$dir/wide.yaml" -o "$dir/p"
has "$dir/err" 'results.csv: cannot be written: File too'
expect 'old results stay where new ones have no row' 0 cmp "$dir/before.csv" "$dir/p/results.csv"
is "$(cat "$dir/p/notes.txt")" kept

expect 'evaluate' 0 "$program" evaluate "$models/me751_jacobian.yaml" --csv
is "$(wc -l <"$dir/out" | tr -d ' ')" 8
has "$dir/out" 'bar,normalization,euler_norm,'
cat >"$dir/jacobian.awk" <<'END'
# Columns of the ME751 notes: Phi_r and Phi_p of the bar.
BEGIN {
    split("-1 0 0 2.613126 1.082392 -2.613126 -1.082392 " \
          "0 -1 0 1.082392 2.613126 1.082392 2.613126 " \
          "0 0 -1 -2.613126 1.082392 -2.613126 1.082392 " \
          "0 0 0 1.306563 0.541196 -1.306563 -0.541196 " \
          "0 0 0 -0.541196 1.306563 0.541196 -1.306563 " \
          "0 0 0 -0.541196 -1.306563 -0.541196 -1.306563 " \
          "0 0 0 1.306563 0.541196 1.306563 0.541196", want, " ")
}
NR > 1 {
    for (k = 1; k <= 7; ++k) {
        off = $(8 + k) - want[(NR - 2) * 7 + k]
        if (off > 5e-7 || off < -5e-7) {
            print "row " NR - 1 ", column " k ": " $(8 + k); bad = 1
        }
    }
    if ($4 > 1e-14 || $4 < -1e-14 || $5 != 0) { print "row " NR - 1 ": Phi " $4 ", nu " $5; bad = 1 }
    gamma = NR == 7 ? 2.2214415 : 0
    if ($6 - gamma > 5e-8 || $6 - gamma < -5e-8) { print "row " NR - 1 ": gamma " $6; bad = 1 }
}
END { exit bad || NR != 8 }
END
cp "$dir/out" "$dir/jacobian.csv"
expect 'the ME751 Jacobian' 0 awk -F, -f "$dir/jacobian.awk" "$dir/jacobian.csv"
is "$(cat "$dir/out")" ''
expect 'evaluate at another time' 0 "$program" evaluate "$models/me751_jacobian.yaml" --csv --time 0.5
expect 'the Jacobian test can fail' 1 awk -F, -f "$dir/jacobian.awk" "$dir/out"
expect 'evaluate at no time' 2 "$program" evaluate "$models/me751_jacobian.yaml" --time soon
expect 'evaluate as a table' 0 "$program" evaluate "$models/pendulum.yaml"
has "$dir/out" 'Phi_pi'

expect 'check' 0 "$program" check "$models/fourbar.yaml"
has "$dir/out" '3 redundant'
has "$dir/out" '1 degree of freedom (Gruebler'
has "$dir/out" '3 bodies, '
printf 'se3d: 1\nbodies: [{name: a}]\njoints: [{name: j, type: fixed, body_i: ground, body_j: a, at: [0, 0, 0]}]\n' >"$dir/one.yaml"
expect 'check of one' 0 "$program" check "$dir/one.yaml"
has "$dir/out" '1 body, 1 constraint or driver, 0 forces'
has "$dir/out" '0 degrees of freedom'
expect 'check without masses' 0 "$program" check "$models/me751_jacobian.yaml"
has "$dir/out" '6 equations, rank 6'
expect 'check --json' 0 "$program" check "$models/fourbar.yaml" --json
has "$dir/out" '"freedoms": 1'

# Coordinates and loads have the units of what they turn or push.
"$program" channels "$models/quarter_car.yaml" >"$dir/units"
"$program" channels "$models/pendulum_rsda.yaml" >>"$dir/units"
"$program" channels "$models/pendulum.yaml" >>"$dir/units"
for row in 'bump.effort *\[N\]' 'spring.length *\[m\]' 'spring.rate *\[m/s\]' 'tyre.force *\[N\]' 'spring.torque *\[N m\]' 'drive.effort *\[N m\]'; do
    holds "no unit: $row" grep -q "^$row" "$dir/units"
done
finish
