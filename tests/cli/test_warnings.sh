# SPDX-License-Identifier: BSD-3-Clause
# What the library warns of reaches the user of `se3d run`: once, on standard error or, with --json,
# in the report. Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

# A pendulum with more sections of a model file, with its analysis.
model()
{
    cat >"$dir/$1.yaml" <<EOF
se3d: 1
bodies:
  - {name: a, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]$3}
joints:
  - {name: s, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}
$2
output: [{file: o.csv, every: 0.05, channels: [a.position]}]
EOF
}
# How many lines of standard output and error hold a text.
lines() { cat "$dir/out" "$dir/err" | grep -c "$1"; }

dynamics='analysis: {type: dynamics, duration: 1}'
model kink "drivers:
  - {name: d, joint: s, coordinate: angle, value: \"max(0, t - 0.5)\"}
$dynamics" ''
expect 'a rate that jumps' 0 "$program" run "$dir/kink.yaml" -o "$dir/r" --method radau
has "$dir/err" "$dir/kink.yaml: warning: t = 0.5 s: the rate of d.angle jumps"
is "$(wc -l <"$dir/err" | tr -d ' ')" 1
expect 'quiet' 0 "$program" run "$dir/kink.yaml" -o "$dir/r" --method radau -q
is "$(cat "$dir/out" "$dir/err")" ''
expect 'json' 0 "$program" run "$dir/kink.yaml" -o "$dir/r" --method radau --json
has "$dir/out" '"warnings": ["t = 0.5 s: the rate of d.angle jumps'
is "$(cat "$dir/err")" ''
expect 'nothing to warn of' 0 "$program" run "$models/pendulum.yaml" -o "$dir/r" --json --duration 0.1
has "$dir/out" '"warnings": [], "more_warnings": 0'

# What equal steps err by.
coarse="run $models/incline.yaml -o $dir/r --method generalized_alpha --step 1e-3"
# shellcheck disable=SC2086
expect 'coarse steps' 0 "$program" $coarse
has "$dir/err" 'incline.yaml: warning: t = 2 s: equal steps of 0.001 s err by about 0.0'
has "$dir/out" 'equal steps of 0.001 s, by comparison with 0.002 s off by about 0.0'
# shellcheck disable=SC2086
expect 'coarse steps, strictly' 1 "$program" $coarse --strict -q
# shellcheck disable=SC2086
expect 'coarse steps as JSON' 0 "$program" $coarse --json
has "$dir/out" '"estimated_to": 2'
has "$dir/out" '"error_velocity": 0.0'
# shellcheck disable=SC2086
expect 'coarse steps, no estimate' 0 "$program" $coarse --no-estimate
is "$(lines 'err by\|by comparison')" 0
expect 'coarse steps of order 1' 0 "$program" run "$models/fourbar.yaml" -o "$dir/r" --method convex --step 4e-3
has "$dir/err" 'fourbar.yaml: warning: t = 10 s: equal steps of 0.004 s err by about 0.02'
expect 'steps amid contacts' 0 "$program" run "$models/conveyor.yaml" -o "$dir/r" --duration 0.1
has "$dir/out" 'equal steps of 0.002 s, whose error is not known: convex is compared until bodies touch'
expect 'fine steps' 0 "$program" run "$models/fourbar.yaml" -o "$dir/r" --duration 1
is "$(lines 'err by')" 0
is "$(lines 'by comparison with 0.002 s off by about')" 1
expect 'controlled steps' 0 "$program" run "$models/fourbar.yaml" -o "$dir/r" --duration 1 --method radau
is "$(lines 'by comparison')" 0
# A stop that steps of 10 ms can follow, but not those of 20 ms.
cat >"$dir/stop.yaml" <<EOF
se3d: 1
bodies: [{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 1]}]
joints: [{name: s, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}]
forces: [{name: e, type: stop, joint: s, coordinate: displacement, lower: -0.8, k: 5e3}]
gravity: [0, 0, -9.81]
analysis: {type: dynamics, duration: 1, method: rattle, step: 0.01}
output: [{file: o.csv, every: 0.05, channels: [a.position]}]
EOF
expect 'steps that cannot be twice as long' 0 "$program" run "$dir/stop.yaml" -o "$dir/r"
has "$dir/out" '(to t = 0.3 s); then steps of 0.02 s fail: t = 0.38 s: a step of 0.02 s is too large for the impact on the stop e'

model twice "analysis:
  - {type: dynamics, duration: 0.6, method: radau}
  - {type: dynamics, duration: 0.6, method: radau}
drivers:
  - {name: d, joint: s, coordinate: angle, value: \"0.1*abs(sin(pi*t/0.6))\"}" ''
expect 'two analyses that warn of the same' 0 "$program" run "$dir/twice.yaml" -o "$dir/r"
is "$(lines 'the rate of d.angle jumps')" 1

model long "analysis: {type: dynamics, duration: 0.2, method: rattle, tolerance: 1e-4}" ''
expect 'equal steps that are reported' 0 "$program" run "$dir/long.yaml" -o "$dir/r"
is "$(lines 'equal steps of ')" 1
expect 'and in the report' 0 "$program" run "$dir/long.yaml" -o "$dir/r" --json
has "$dir/out" '"step": '

model steps "analysis: {type: dynamics, duration: 0.01, method: convex}" ''
expect 'steps that nobody chose' 0 "$program" run "$dir/steps.yaml" -o "$dir/r"
is "$(lines 'no step is given: convex takes 0.001 s and estimates no error')" 1
expect 'a step that was given' 0 "$program" run "$dir/steps.yaml" -o "$dir/r" --step 1e-3
is "$(lines 'no step is given')" 0

# Particles beside bodies that cannot move; a lattice and a window with nothing in them.
model grains "drivers:
  - {name: d, joint: s, coordinate: angle, value: 0}
materials: [{name: sand, density: 2500, stiffness: 1e4}]
particles:
  - {material: sand, radius: 0.1, lower: [2, 2, 2], upper: [2.5, 2.5, 2.5]}
  - {material: sand, radius: 0.1, jitter: 0.01, lower: [4, 2, 2], upper: [4.21, 2.5, 2.5]}
analysis: {type: dynamics, duration: 0.01}" ''
sed 's/^output: \[/&{summary: s.csv, start: 3, stop: 4, channels: [a.position]}, {summary: t.csv, start: 3, channels: [a.position]}, /' \
    "$dir/grains.yaml" >"$dir/empty.yaml"
expect 'particles beside what is locked' 0 "$program" run "$dir/empty.yaml" -o "$dir/r"
is "$(lines 'nothing can move')" 0
has "$dir/err" 'particles[1]: holds no particle: none of radius 0.1 m, displaced by up to 0.01 m, fits'
has "$dir/err" 's.csv is empty: no row is from `start`, 3 s, to `stop`, 4 s'
has "$dir/err" 't.csv is empty: no row is from `start`, 3 s, on'
sed '/^particles/,/4.21/d' "$dir/grains.yaml" >"$dir/locked.yaml"
expect 'locked' 0 "$program" run "$dir/locked.yaml" -o "$dir/r"
is "$(lines 'nothing can move')" 1

# What the report shows anyway is not warned of beside it.
model start "$dynamics" ', velocity: [0, 0, 1]'
expect 'velocities that do not fit' 0 "$program" run "$dir/start.yaml" -o "$dir/r"
is "$(lines 'velocities do not fit')" 1
expect 'velocities that do not fit, json' 0 "$program" run "$dir/start.yaml" -o "$dir/r" --json
has "$dir/out" '"warnings": ["t = 0 s: the given velocities do not fit'
expect 'a tolerance that is not reached' 0 "$program" run "$models/pendulum_free.yaml" -o "$dir/r" \
    --tolerance 1e-14 --duration 0.1 --method dop853
is "$(lines 'is smaller than what')" 1
expect 'redundant constraints' 0 "$program" run "$models/andrews.yaml" -o "$dir/r" --duration 0.001
is "$(lines 'redundant')" 1
is "$(cat "$dir/err")" ''

# What a model says that is probably a mistake is told with its place; --strict makes it a failure.
cat >"$dir/doubtful.yaml" <<'END'
se3d: 1
parameters:
  used: 2
  length: 3
  chain: used*1
points:
  hub: [chain, 0, 0]
  spare: [0, 1, 0]
materials: [{name: steel, density: 7800, stiffness: 1e5}]
contact: {}
bodies:
  - {name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: hub}
  - {name: b, mass: 1e9, inertia: [1, 1, 1], shapes: [{type: sphere, radius: 1, material: steel}]}
  - {name: c, mass: 1, inertia: [1, 1, 1], shapes: [{type: sphere, radius: 1}, {type: sphere, radius: 2}]}
  - {name: d, mass: 1, inertia: [1, 1, 1], position: [9, 0, 0]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: tie, type: spherical, body_i: c, body_j: d, at: [5, 0, 0]}
drivers: [{name: m1, joint: pin, value: t}, {name: m2, joint: pin, value: t}]
analysis: {type: dynamics, duration: 0.01}
END
expect 'doubtful' 0 "$program" check "$dir/doubtful.yaml"
has "$dir/err" "warning: $dir/doubtful.yaml:4:11: parameters.length: the parameter is used nowhere"
has "$dir/err" ':8:10: points.spare: the point is used nowhere'
has "$dir/err" ':14:5: bodies[2]: nothing holds c: no joint, constraint, force or contact leads to the ground'
has "$dir/err" ': bodies[2].shapes[0]: has no material: nothing touches it'
has "$dir/err" ':19:45: drivers[1]: m2 drives what m1 drives already'
has "$dir/err" 'bodies[0].mass: a has 1 kg and b has 1e+09 kg'
is "$(wc -l <"$dir/err" | tr -d ' ')" 6
sed '/^contact/d' "$dir/doubtful.yaml" >"$dir/untouched.yaml"
expect 'materials alone' 0 "$program" check "$dir/untouched.yaml"
has "$dir/err" 'nothing holds b: no joint, constraint, force or contact leads to the ground, it falls; materials touch in a model with `contact: {}`'
expect 'strict' 1 "$program" check --strict "$dir/doubtful.yaml"
has "$dir/err" "$dir/doubtful.yaml: --strict: 6 warnings, must be none"
expect 'strict json' 1 "$program" check --strict --json "$dir/doubtful.yaml"
has "$dir/out" '"warnings": ["'
expect 'strict run' 1 "$program" run --strict "$dir/doubtful.yaml" -o "$dir/strict"
is "$(ls "$dir/strict" 2>/dev/null)" ''
sed -e '/length: 3/d' -e '/spare/d' -e 's/gravity.*//' -e 's/, {name: m2.*t}\]/]/' -e 's/1e9/1e8/' \
    -e 's/radius: 1}/radius: 1, contact: false}/' -e 's/name: c, mass: 1/name: c, fixed: true/' \
    -e 's/true, inertia: .1, 1, 1./true/' "$dir/doubtful.yaml" >"$dir/sound.yaml"
expect 'no warnings' 0 "$program" check --strict "$dir/sound.yaml"
is "$(cat "$dir/err")" ''
expect 'weightless, nothing falls' 0 "$program" check "$dir/doubtful.yaml" --set used=3
cat >"$dir/far.yaml" <<'END'
se3d: 1
bodies: [{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [9, 0, 0]}]
joints: [{name: pin, type: spherical, body_i: ground, body_j: a, point_i: [0, 0, 0], point_j: [0.5, 0, 0]}]
analysis: {type: dynamics, duration: 0.01}
END
for command in "check" "run -o $dir/far"; do
    expect 'moved far' 0 "$program" $command "$dir/far.yaml"
    has "$dir/err" 'body a was moved by 9.'
    has "$dir/err" 'more than its size, 1'
    expect 'moved far, strict' 1 "$program" $command "$dir/far.yaml" --strict
done

# Names that a spreadsheet takes for formulas.
for sign in = + - @; do
    cat >"$dir/formula.yaml" <<END
se3d: 1
bodies: [{name: a-=+@b, mass: 1, inertia: [1, 1, 1]}, {name: "${sign}1+1", mass: 1, inertia: [1, 1, 1]}]
gravity: [0, 0, 0]
analysis: {type: dynamics, duration: 0.01}
END
    expect "a name with $sign" 0 "$program" check "$dir/formula.yaml"
    has "$dir/err" ":2:62: bodies[1].name: a spreadsheet takes \`${sign}1+1\` for a formula in files of results"
    is "$(lines 'for a formula')" 1
    cat >"$dir/formula.xml" <<END
<mujoco><worldbody><body name="${sign}1+1"><freejoint/><geom size="1"/></body></worldbody></mujoco>
END
    if [ -n "${SE3D_HAS_EXPAT:-}" ]; then
        expect "an import with $sign" 0 "$program" import "$dir/formula.xml" -o "$dir/imported$sign.yaml"
        has "$dir/err" "is called \`_1+1\`"
        is "$(grep -c 'name: _1+1' "$dir/imported$sign.yaml")" 1
    fi
done
finish
