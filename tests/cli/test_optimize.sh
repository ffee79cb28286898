# SPDX-License-Identifier: BSD-3-Clause
# se3d study --optimize: every method finds what is known, limits hold, the same bytes twice, and what is printed runs.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
cat >"$dir/seek.yaml" <<'END'
se3d: 1
parameters: {x: 0.5, y: 2 mm}
bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [x, y, 0]}]
analysis: {type: assembly}
output: [{file: at.csv, channels: [block.position]}]
study:
  optimize:
    parameters: {x: {from: -2, to: 2}, y: {from: -1 m, to: 2 m}}
    minimize: f
    method: cobyla
  seed: 3
  measures:
    px: {final: block.position.x}
    py: {final: block.position.y}
    f: (1 - px)^2 + (py - 0.5)^2 + 0*sqrt(3 - px)
    sum: px + py
END
if [ "${SE3D_HAS_NLOPT:-0}" != 1 ]; then
    expect 'without NLopt' 1 "$program" study "$dir/seek.yaml" --optimize
    says 'was built without NLopt'
    finish
fi

# near FILE COLUMN WANTED TOLERANCE: of the row with the least aim whose limits hold
near() {
    found=$(awk -F, -v c="$2" 'NR > 1 && $8 == "ok" && $7 < 2e-6 && (b == "" || $6 < b) { b = $6; v = $c } END { print v }' b= "$1")
    holds "$found in column $2, expected $3" awk "BEGIN { exit !(($found - ($3))^2 <= ($4)^2) }"
}
order='s/^\([^,]*,[^,]*,[^,]*,[^,]*,[^,]*\),\([^,]*\),\([^,]*\),\([^,]*\),/\1,\2,\4,/'
for method in cobyla bobyqa slsqp mma crs direct isres; do
    sed "s/method: cobyla/method: $method/" "$dir/seek.yaml" >"$dir/$method.yaml"
    expect "$method" 0 "$program" study "$dir/$method.yaml" -o "$dir/$method" --json
    sed "$order" "$dir/$method/optimize.csv" >"$dir/rows"
    wide=0.002
    [ $method = isres ] && wide=0.1
    near "$dir/rows" 2 1 $wide
    near "$dir/rows" 3 0.5 $wide
    expect "$method again, by three processes" 0 "$program" study "$dir/$method.yaml" -o "$dir/again" --optimize -q --jobs 3
    is "$(cksum <"$dir/$method/optimize.csv")" "$(cksum <"$dir/again/optimize.csv")"
done
is "$(sed -n 1p "$dir/slsqp/optimize.csv")" 'evaluation,x,y,px,py,f,sum,violation,status'

# px + py <= 1 and = 1: the foot of the perpendicular from (1, 0.5), at (0.75, 0.25); px + py >= 2 is at (1.25, 0.75).
for row in 'cobyla to: 1 0.75' 'slsqp to: 1 0.75' 'mma to: 1 0.75' 'cobyla equal: 1 0.75' 'slsqp equal: 1 0.75' \
    'slsqp from: 2 1.25' 'cobyla from: 2 1.25'; do
    set -- $row
    sed "s/method: cobyla/method: $1\\n    tolerance: 1e-7\\n    constraints: {sum: {$2 $3}}/" "$dir/seek.yaml" >"$dir/limit.yaml"
    expect "$row" 0 "$program" study "$dir/limit.yaml" -o "$dir/limit" --optimize
    sed "$order" "$dir/limit/optimize.csv" >"$dir/rows"
    near "$dir/rows" 2 "$4" 1e-4
done

# The greatest, from another start, with runs that fail on the way, and what is printed runs.
sed 's/minimize: f/maximize: sum/; s/ to: 2 m}/ to: 2 m, start: 1 m}/; s/3 - px/1.5 - px/' "$dir/seek.yaml" >"$dir/most.yaml"
expect 'the greatest' 0 "$program" study "$dir/most.yaml" -o "$dir/most" --set x=0.25
has "$dir/err" 'study: evaluation 1: sum = 1.25'
has "$dir/out" "wrote $dir/most/optimize.csv"
command=$(grep '^se3d run ' "$dir/out")
expect 'what is printed' 0 sh -c "cd '$dir' && '$program' ${command#se3d }"
is "$(tail -1 "$dir/results/most/at.csv" | cut -d, -f3)" 2

# 0.1 exp(-pi z / sqrt(1 - z^2)) is 1 mm, stiffness at its greatest: c = 2 z sqrt(1600*2).
expect 'a damper that settles soonest' 0 "$program" study "$source/examples/study/settle.yaml" -o "$dir/settle" --json
holds 'the damper' awk 'BEGIN { l = log(100); z = l/sqrt(l^2 + 3.14159265358979^2); c = '"$(sed 's/.*"c": "\([0-9.]*\).*/\1/' "$dir/out")"'
    exit !((c - 2*z*sqrt(3200))^2 < 0.1^2) }'

# The first place that direct tries fails; it counts as the worst.
sed 's/method: cobyla/method: direct/; s/3 - px/px^2 - 0.01/' "$dir/seek.yaml" >"$dir/hole.yaml"
expect 'a hole in the middle' 0 "$program" study "$dir/hole.yaml" -o "$dir/hole" --json
holds 'the middle fails' sh -c "sed -n 2p '$dir/hole/optimize.csv' | grep -q '^1,0,.*not finite'"
sed "$order" "$dir/hole/optimize.csv" >"$dir/rows"
near "$dir/rows" 2 1 0.002
near "$dir/rows" 3 0.5 0.002

# No friction is below 0: at 0 the derivative is that of the side above. A root has none: the search ends there.
cat >"$dir/brake.yaml" <<'END'
se3d: 1
parameters: {mu: 0}
gravity: [0, 0, -10]
bodies: [{name: block, mass: 2, inertia: [1, 1, 1], position: [0, 0, 0], velocity: [3, 0, 0]}]
joints: [{name: guide, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: brake, type: friction, joint: guide, mu: mu}]
analysis: {type: dynamics, duration: 0.1}
study:
  optimize: {parameters: {mu: {from: 0, to: 1}}, minimize: vx, method: slsqp}
  sensitivities: [mu]
  measures: {vx: {final: block.velocity.x}}
END
expect 'a bound that nothing passes' 0 "$program" study "$dir/brake.yaml" -o "$dir/brake" --optimize --json
holds 'all of the friction' awk "BEGIN { exit !($(sed 's/.*"mu": "\([0-9.]*\).*/\1/' "$dir/out") > 0.9999) }"

# What is printed has all that was given, whole, but for what is sought.
long=$(printf '+ 0*%040d ' 1 2 3 4 5 6)
{ cat "$dir/brake.yaml" && echo 'output: [{file: at.csv, channels: [block.velocity.x]}]'; } >"$dir/-it's.yaml"
expect 'options' 0 sh -c "cd '$dir' && '$program' study --optimize --duration 0.2 --step=0.05 --method rk4 \\
    --set mu=0.25 --set 'bodies.block.velocity=[4 $long, 0, 0]' --analysis dynamics --tolerance 1e-5 -- \"-it's.yaml\""
command=$(grep '^se3d run ' "$dir/out")
has "$dir/out" "se3d run './-it'\\''s.yaml' --analysis=dynamics --method=rk4 --step=0.05 --tolerance=1e-5 --duration=0.2 --set '"
is "$(echo "$command" | grep -o 'mu=' | wc -l | tr -d ' ')" 1
best=$(sed -n 's/^vx  *[^ ]*  *//p' "$dir/out")
expect 'what is printed, with options' 0 sh -c "cd '$dir' && '$program' ${command#se3d }"
holds "$best" awk "BEGIN { exit !(($best - $(tail -1 "$dir/results/-it's/at.csv" | cut -d, -f2))^2 < 1e-12 && ($best - 2)^2 < 1e-6) }"

expect 'its derivative' 0 "$program" study "$dir/brake.yaml" -o "$dir/brake" --sensitivities -q
near_slope=$(sed -n 's/^vx,mu,[^,]*,0,\([^,]*\),.*/\1/p' "$dir/brake/sensitivities.csv")
holds "the slope $near_slope" awk "BEGIN { exit !(($near_slope + 1)^2 < 1e-8) }"
sed 's/measures: .*/measures: {v: {final: block.velocity.x}, x: {final: block.position.x}, vx: sqrt(3 - v)}/; s/minimize/maximize/' "$dir/brake.yaml" >"$dir/root.yaml"
for method in slsqp mma; do
    sed "s/slsqp/$method/" "$dir/root.yaml" >"$dir/$method.yaml"
    expect "a root, $method" 1 "$program" study "$dir/$method.yaml" -o "$dir/root" --optimize
    says 'no derivative of `vx` by `mu` at mu = 0'
done
expect 'the derivative of a root' 1 "$program" study "$dir/root.yaml" -o "$dir/root" --sensitivities
says 'no derivative of `vx` by `mu` at mu = 0'
is "$(grep -c '^vx,mu,0,0,,,$' "$dir/root/sensitivities.csv")" 1

# What cannot be.
sed 's/method: cobyla/constraints: {sum: {from: 9}}/' "$dir/seek.yaml" >"$dir/never.yaml"
expect 'limits that nothing meets' 1 "$program" study "$dir/never.yaml" -o "$dir/never"
has "$dir/out" 'and it passes limits'
sed 's/3 - px/0.9 - px/' "$dir/seek.yaml" >"$dir/bad.yaml"
expect 'a start that fails' 1 "$program" study "$dir/bad.yaml" -o "$dir/bad" --set x=0.95
says '`f` is not finite'
holds 'a table of nothing' [ ! -e "$dir/bad/optimize.csv" ]
expect 'a file in the way' 1 "$program" study "$dir/seek.yaml" -o "$dir/seek.yaml/x"
says 'cannot be written'
expect 'nothing is sought' 2 "$program" study "$source/examples/study/damper.yaml" --optimize
says 'has no `optimize`'
expect 'two commands' 2 "$program" study "$dir/seek.yaml" --optimize --server
finish
