# SPDX-License-Identifier: BSD-3-Clause
# What the program says where a mechanism cannot do what it is asked to, or where a run leaves something out: it names
# the element, the time and what would help.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
slide='{name: slide, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, 0]}'
body='{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0]}'
prints() {
    has "$dir/out" "$1"
}

# A slider that drives a crank of 1 m and a rod of 2 m (cosines of 30 degrees) past the position in which they are in
# line: 3 m from the pin, at (3 - sqrt(3)) / 2 s.
cat >"$dir/slider.yaml" <<'END'
se3d: 1
gravity: [0, 0, 0]
parameters: {c: sqrt(3)}
bodies:
  - {name: crank, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.5, 0]}
  - {name: rod, mass: 1, inertia: [0.1, 0.1, 0.1], position: [c/2, 0.5, 0]}
  - {name: piston, mass: 1, inertia: [0.1, 0.1, 0.1], position: [c, 0, 0]}
joints:
  - {name: main, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 0, 1]}
  - {name: big, type: revolute, body_i: crank, body_j: rod, at: [0, 1, 0], axis: [0, 0, 1]}
  - {name: small, type: revolute, body_i: rod, body_j: piston, at: [c, 0, 0], axis: [0, 0, 1]}
  - {name: slide, type: prismatic, body_i: ground, body_j: piston, at: [0, 0, 0], axis: [1, 0, 0]}
drivers:
  - {name: push, joint: slide, coordinate: displacement, value: 2*t}
analysis: {type: kinematics, duration: 1, step: 0.01}
output: [{file: s.csv, channels: [piston.position]}]
END
for how in kinematics inverse_dynamics dynamics 'dynamics --method radau' 'dynamics --method rattle' \
    'dynamics --method generalized_alpha' 'kinematics --formulation rp'; do
    # shellcheck disable=SC2086
    expect "a slider beyond its dead point: $how" 1 "$program" run "$dir/slider.yaml" -o "$dir/o" --analysis $how
    says 'driver push has reached a dead point of the mechanism at t = 0.633975 s'
    says ', where its value is 1.26795'
done
sed 's/value: 2\*t/value: "if(t > 0.3, 9, t)"/' "$dir/slider.yaml" >"$dir/jump.yaml"
expect 'a jump is no dead point' 1 "$program" run "$dir/jump.yaml" -o "$dir/o"
holds 'it is called one' [ "$(grep -c 'dead point' "$dir/err")" = 0 ]

# An actuator of length sqrt(5) + t/2 from (2, 0) to a crank of 1 m is in line with it at 3 m: every method says when, also
# those that had come near it by then.
cat >"$dir/actuator.yaml" <<'END'
se3d: 1
bodies: [{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 1, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}]
constraints: [{name: piston, type: d, body_i: ground, body_j: a, point_i: [2, 0, 0], value: "(sqrt(5) + 0.5*t)^2"}]
analysis: {type: dynamics, duration: 5, step: 0.05}
output: [{file: a.csv, every: 0.05, channels: [a.position]}]
END
for method in dop853 rk45 rk4 gauss bdf radau rattle verlet generalized_alpha hht; do
    expect "an actuator beyond its dead point: $method" 1 "$program" run "$dir/actuator.yaml" -o "$dir/o" --method $method
    says 'd piston has reached a dead point of the mechanism at t = 1.52786 s, where its value is 9 m^2'
    steps=$(sed -n 's/.* s, \([0-9]*\) steps.*/\1/p' "$dir/out")
    holds "$steps steps" [ "${steps:-9999}" -lt 5000 ]
done

# A tolerance that the method does not reach.
printf 'se3d: 1\nbodies: [%s]\njoints: [%s]\nanalysis: {type: dynamics, duration: 1e-3}\n' "$body" "$slide" >"$dir/fine.yaml"
for row in 'bdf 1e-13 1e-11' 'dop853 1e-14 6.67e-12' 'auto 1e-14 6.67e-13' 'rk45 1e-14 6.67e-12'; do
    # shellcheck disable=SC2086
    set -- $row
    expect "$row" 0 "$program" run "$dir/fine.yaml" -o "$dir/o" --method "$1" --tolerance "$2"
    holds "$row is not told" grep -q "the tolerance $2 is smaller than what .* reaches; $3 was used" "$dir/out"
    expect "$row as JSON" 0 "$program" run "$dir/fine.yaml" -o "$dir/o" --method "$1" --tolerance "$2" --json
    holds "$row is not in JSON" grep -qE '"tolerance": [0-9.]*e-1[345], "tolerance_reached": (6\.66|9\.99|1e-12)' "$dir/out"
done
expect 'a tolerance that is reached' 0 "$program" run "$dir/fine.yaml" -o "$dir/o" --method bdf --tolerance 1e-11
holds 'says more than there is' [ "$(grep -c 'smaller than what' "$dir/out")" = 0 ]

# The square of a distance that goes to zero, and below.
for value in '1 - t' '(1 - t)^2 - 1e-3' '(1 - t)^2'; do
    printf 'se3d: 1\nbodies: [%s]\njoints: [%s]\nconstraints: [{name: reach, type: d, body_i: ground, body_j: a, value: "%s"}]\nanalysis: {type: kinematics, duration: 2, step: 0.01}\n' \
        "$body" "$slide" "$value" | sed 's/1 - t)^2 - 1e-3/1 - t)^2 - 1e-9/' >"$dir/d.yaml"
    for analysis in kinematics dynamics; do
        expect "$value: $analysis" 1 timeout 20 "$program" run "$dir/d.yaml" -o "$dir/o" --analysis $analysis
        holds "does not name the constraint: $(cat "$dir/err")" grep -qE 'reach|dead point' "$dir/err"
        holds 'shows what the user cannot know' [ "$(grep -cE 'least violation|the tolerance 3e' "$dir/err")" = 0 ]
    done
done

# A held body, and a driver that asks it to move.
printf 'se3d: 1\nbodies: [%s]\njoints: [%s]\ndrivers: [{name: push, joint: slide, coordinate: displacement, value: 3}]\nanalysis: {type: assembly}\n' \
    "$(echo "$body" | sed 's/}/, held: true}/')" "$slide" >"$dir/held.yaml"
expect 'a driver of a held body' 1 "$program" run "$dir/held.yaml" -o "$dir/o"
says 'push requires body a to move, but it is held'

# A body on springs.
printf 'se3d: 1\nbodies: [%s]\nforces: [{name: s, type: tsda, body_i: ground, body_j: a, k: 100, l0: 0.5}]\nanalysis: {type: equilibrium}\n' \
    "$body" >"$dir/spring.yaml"
expect 'a body on a spring' 0 "$program" check "$dir/spring.yaml"
prints 'only force elements hold a: no constraint leads to a fixed body'
prints '1 body, 0 constraints and drivers, 1 force'
sed '/^forces/d' "$dir/spring.yaml" >"$dir/free.yaml"
expect 'a body on nothing' 0 "$program" check "$dir/free.yaml"
prints 'nothing holds a: no constraint leads to a fixed body'

# Strict minima are stable; what turns about itself is neutral.
pendulum() {
    printf 'se3d: 1\n%s\nbodies: [{name: a, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, %s]}]\njoints: [{name: pin, type: %s, body_i: ground, body_j: a, at: [0, 0, 0]%s}]\nanalysis: {type: equilibrium}\n' \
        "$1" "$2" "$3" "$4" >"$dir/pendulum.yaml"
    expect "an equilibrium: $*" 0 "$program" run "$dir/pendulum.yaml" -o "$dir/o"
}
pendulum '' -1 revolute ', axis: [1, 0, 0]'
prints 'the equilibrium is stable'
prints 'wrote '
holds 'and more than stable' [ "$(grep -c neutral "$dir/out")" = 0 ]
pendulum '' 1 revolute ', axis: [1, 0, 0]'
prints 'the equilibrium is unstable'
pendulum '' -1 revolute ', axis: [0, 0, 1]'
prints 'the equilibrium is neutral: nothing holds some freedom'
pendulum 'gravity: [0, 0, 0]' -1 revolute ', axis: [1, 0, 0]'
prints 'the equilibrium is neutral'
pendulum '' -1 spherical ''
prints 'the equilibrium is neutral'
pendulum '' 1 fixed ''
prints 'the equilibrium is stable'
# A stiff spring beside a soft one: both count.
for soft in 1e-3 0; do
    printf 'se3d: 1\ngravity: [0, 0, 0]\nbodies: [%s, {name: b, mass: 1, inertia: [1, 1, 1], position: [0, 1, 0]}]\njoints: [%s, {name: t, type: prismatic, body_i: ground, body_j: b, at: [0, 1, 0], axis: [1, 0, 0]}]\nforces:\n  - {name: s, type: tsda, body_i: ground, body_j: a, k: 1e6, l0: 0.5}\n  - {name: u, type: tsda, body_i: ground, body_j: b, point_i: [1, 1, 0], k: %s, l0: 0.5}\nanalysis: {type: equilibrium}\n' \
        "$body" "$slide" $soft >"$dir/soft.yaml"
    expect "a spring of $soft N/m" 0 "$program" run "$dir/soft.yaml" -o "$dir/o"
    prints "$([ $soft = 0 ] && echo 'is neutral' || echo 'is stable')"
done

# Dimensions of four to six digits in a loop that has no freedom to spare: the diagonal of a square.
cat >"$dir/digits.yaml" <<'END'
se3d: 1
bodies:
  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}
  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0.5, 0.5, 0]}
joints:
  - {name: p, type: revolute, body_i: ground, body_j: a, point_j: [-0.5, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1]}
  - {name: q, type: revolute, body_i: a, body_j: b, point_i: [0.5, 0, 0], point_j: [0.707107, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1]}
  - {name: r, type: fixed, body_i: ground, body_j: b, point_i: [0, 1, 0], point_j: [-0.707107, 0, 0]}
analysis: {type: assembly}
END
sed -i 's/position: \[0.5, 0.5, 0\]}/position: [0.5, 0.5, 0], orientation: {axis: [0, 0, 1], angle: -pi\/4}}/; s/point_j: \[-0.707107, 0, 0\]}/point_j: [-0.707107, 0, 0], axis_i: [1, -1, 0], axis_j: [1, 0, 0]}/' "$dir/digits.yaml"
for length in 0.707107 0.70708 0.70700; do
    sed "s/0.707107/$length/g" "$dir/digits.yaml" >"$dir/few.yaml"
    expect "a diagonal of $length" 1 "$program" run "$dir/few.yaml" -o "$dir/o"
    says 'but not exactly'
    says 'more digits'
done
sed 's/0.707107/0.7/g' "$dir/digits.yaml" >"$dir/few.yaml"
expect 'a diagonal that is too short' 1 "$program" run "$dir/few.yaml" -o "$dir/o"
says 'cannot reach each other'

# What a run leaves out.
printf 'se3d: 1\nbodies: [%s]\njoints:\n  - {name: p, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}\n  - {name: q, type: revolute, body_i: ground, body_j: a, at: [1, 0, 0], axis: [0, 0, 1]}\nanalysis: {type: dynamics, duration: 0.1}\n' \
    "$body" >"$dir/locked.yaml"
expect 'a locked mechanism' 0 "$program" run "$dir/locked.yaml" -o "$dir/o"
prints 'note: nothing can move: the constraints leave no degree of freedom'
expect 'a locked mechanism in JSON' 0 "$program" run "$dir/locked.yaml" -o "$dir/o" --json
prints '"notes": ["nothing can move: '
sed 's/value: 2\*t/value: 0.1*t/' "$dir/slider.yaml" >"$dir/driven.yaml"
expect 'a driven mechanism is not locked' 0 "$program" run "$dir/driven.yaml" -o "$dir/o" --analysis dynamics
holds 'it says so' [ "$(grep -c 'note: ' "$dir/out")" = 0 ]
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n' >"$dir/t.stl"
cat >"$dir/meshes.yaml" <<'END'
se3d: 1
materials: [{name: steel, density: 7800, stiffness: 1e5}]
contact: {law: hooke}
bodies:
  - {name: a, mass: 1, inertia: [1, 1, 1], shapes: [{type: mesh, file: t.stl, material: steel}]}
  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1], shapes: [{type: mesh, file: t.stl, material: steel}]}
analysis: {type: dynamics, duration: 0.01}
END
expect 'meshes on meshes' 0 "$program" run "$dir/meshes.yaml" -o "$dir/o"
prints 'the meshes '
prints 'pass through each other'
cat >"$dir/grains.yaml" <<'END'
se3d: 1
materials: [{name: glass, density: 2500, stiffness: 1e4}]
bodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, -1]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, 0]}]
particles: [{name: sand, material: glass, radius: 0.01, lower: [0, 0, 0], upper: [0.1, 0.1, 0.03]}]
analysis: [{type: equilibrium}, {type: modes}]
END
expect 'grains beside an equilibrium' 0 "$program" run "$dir/grains.yaml" -o "$dir/o"
prints 'note: equilibrium: the particles and their forces on the bodies are left out'
prints 'note: modes: the particles and their forces on the bodies are left out'

# Events need what changes continuously, whatever it is called.
for channel in particles.count particles.lost particles.left sand.count sand.mass contacts.count steps; do
    sed "s/^analysis.*/events: [{name: e, channel: $channel, value: 0.5}]\\nanalysis: {type: dynamics, duration: 0.01, method: verlet}/" \
        "$dir/grains.yaml" >"$dir/event.yaml"
    expect "an event on $channel" 2 "$program" run "$dir/event.yaml" -o "$dir/o"
    says "\`$channel\` changes in jumps"
done
for channel in particles.energy sand.energy contacts.force_max energy.dissipated a.angular_velocity.x; do
    sed "s/^analysis.*/events: [{name: e, channel: $channel, value: 1e9}]\\nanalysis: {type: dynamics, duration: 0.01, method: verlet}/" \
        "$dir/grains.yaml" >"$dir/event.yaml"
    expect "an event on $channel" 0 "$program" run "$dir/event.yaml" -o "$dir/o"
done

# Kinematics knows no masses; two drivers of one coordinate are both named, and a time is told once.
cat >"$dir/light.yaml" <<'END'
se3d: 1
bodies: [{name: a}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}]
drivers: [{name: m1, joint: pin, rate: 60 rpm, start: 90 deg}]
analysis: {type: kinematics, duration: 1, step: 0.25}
output: [{file: r.csv, channels: [pin.angle]}]
END
expect 'kinematics without masses' 0 "$program" run "$dir/light.yaml" -o "$dir/o"
is "$(tail -1 "$dir/o/r.csv" | cut -c 1-10)" '1,7.853981'
expect 'dynamics without masses' 2 "$program" run "$dir/light.yaml" -o "$dir/o" --analysis dynamics
says 'bodies[0].mass: is missing'
sed 's/90 deg}/90 deg}, {name: m2, joint: pin, value: t}/' "$dir/light.yaml" >"$dir/both.yaml"
expect 'two drivers' 1 "$program" run "$dir/both.yaml" -o "$dir/o"
says 'm2 drives what m1 drives already'
says 'failed at t = 0 s: the constraints'

# A ball that is too soft for its speed sinks in as far as it may: steps that shrink towards that depth are no reason.
cat >"$dir/soft.yaml" <<'END'
se3d: 1
gravity: [0, 0, 0]
contact: {}
materials: [{name: soft, stiffness: 1e4, density: 1000}]
bodies:
  - {name: ball, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 1], velocity: [0, 0, -5],
     shapes: [{type: sphere, radius: 0.1, material: soft}]}
  - {name: floor, fixed: true, shapes: [{type: plane, material: soft}]}
analysis: {type: dynamics, duration: 1}
output: [{file: s.csv, channels: [ball.position]}]
END
for method in auto dop853 rk45 bdf radau generalized_alpha hht; do
    expect "too soft, $method" 1 "$program" run "$dir/soft.yaml" -o "$dir/o" --method "$method"
    says 'the shapes ball and floor overlap by 0.02 m, at most 0.2 of their size 0.1 m is allowed; try a stiffer'
    holds 'no step is blamed' [ "$(grep -c 'the step fell to' "$dir/err")" = 0 ]
done
# What overlaps from the start is no matter of materials or steps.
sed 's/\[0, 0, 1\], velocity/[0, 0, 0.05], velocity/' "$dir/soft.yaml" >"$dir/within.yaml"
for method in auto convex verlet radau; do
    expect "overlaps at the start, $method" 1 "$program" run "$dir/within.yaml" -o "$dir/o" --method "$method"
    says 'ball and floor overlap by 0.05 m, at most 0.2 of their size 0.1 m is allowed; move them apart'
    holds 'no step is blamed' [ "$(grep -c 'What to try' "$dir/err")" = 0 ]
    holds 'no method is named' [ "$(grep -c 'method convex' "$dir/err")" = 0 ]
done
# What particles will take is told before their run, and what their first steps meet.
cat >"$dir/sand.yaml" <<'END'
se3d: 1
gravity: [0, 0, -9.81]
contact: {law: hertz_mindlin}
materials: [{name: sand, young: 1e7, density: 2500}]
particles:
  - {material: sand, radius: [0.002, 0.003], packing: lattice, count: 40, lower: [0, 0, 0], upper: [0.05, 0.05, 0.05]}
bodies: [{name: ground, shapes: [{type: plane, material: sand}]}]
analysis:
  - {type: dynamics, duration: 0.5}
  - {type: dynamics, duration: 1.5}
output: [{file: s.csv, every: 0.1, channels: [particles.count]}]
END
expect 'particles that will run' 0 "$program" check "$dir/sand.yaml"
prints 'particles: 40 particles of radius 0.002'
prints ' s, 2.5 % of the time of a Rayleigh wave'
prints 'impacts below 3.16 m/s stay within the overlap_limit, 0.2 of the radius'
prints 'steps to the end, about '
expect 'adhesion that grains cannot hold' 0 "$program" check "$dir/sand.yaml" --set materials.sand.adhesion=1000
prints 'their attraction alone may press them in by more than the overlap_limit, 0.2 of the radius'
expect 'at half of the step' 0 "$program" check "$dir/sand.yaml" --set contact.step=1e-6
prints '; steps of 1e-06 s, '
prints '2e+06 steps to the end, about '
# The step of the analysis is the longest one; what contacts need, or their own step, holds beside it.
sed 's/, count: 40/, count: 4/; s/duration: 0.5/duration: 0.001, step: h/; s/^gravity.*/parameters: {h: 1}/; /1.5/d' "$dir/sand.yaml" >"$dir/few.yaml"
expect 'a step of the analysis' 0 "$program" check "$dir/few.yaml" --set h=1e-6
prints '; steps of 1e-06 s, '
expect 'and its run' 0 "$program" run "$dir/few.yaml" -o "$dir/o" --set h=1e-6
prints '1000 steps'
prints 'equal steps of 1e-06 s'
holds 'nothing to warn of' [ "$(wc -l <"$dir/err")" = 0 ]
expect 'one that contacts do not allow' 0 "$program" run "$dir/few.yaml" -o "$dir/o" --step 1e-3
says 'steps of 4.56e-06 s in place of 0.001 s, which contacts of particles do not allow; only the `step` of `contact`'
prints 'equal steps of 4.55707e-06'
expect 'of contacts' 0 "$program" run "$dir/few.yaml" -o "$dir/o" --set contact.step=1e-5
prints 'equal steps of 1e-05 s'
sed 's/lower: \[0, 0, 0\]/lower: [0, 0, -0.003]/' "$dir/sand.yaml" >"$dir/sunk.yaml"
expect 'particles that begin within a wall' 0 "$program" check "$dir/sunk.yaml"
prints 'the first steps fail: '
expect 'no particles' 0 "$program" check "$dir/soft.yaml"
holds 'nothing is told of particles' [ "$(grep -c 'particle' "$dir/out")" = 0 ]
# The speed that is told is the one that an impact without loss stands, with each law and with adhesion.
for law in hooke hertz_mindlin; do
    cat >"$dir/hit.yaml" <<END
se3d: 1
gravity: [0, 0, 0]
parameters: {v: 1, sticky: 0}
contact: {law: $law}
materials: [{name: sand, young: 1e7, stiffness: 1e4, density: 2500, restitution: 1, adhesion: sticky}]
particles:
  - {material: sand, radius: 0.002, lower: [0, 0, 0.001], upper: [0.004, 0.004, 0.005], velocity: [0, 0, -v]}
bodies: [{name: ground, shapes: [{type: plane, material: sand}]}]
analysis: {type: dynamics, duration: 2.5e-3/v}
output: [{file: s.csv, channels: [particles.count]}]
END
    for sticky in 0 10; do
        expect "stands a speed, $law" 0 "$program" check "$dir/hit.yaml" --set sticky=$sticky
        told=$(sed -n 's,^impacts below \(.*\) m/s.*,\1,p' "$dir/out")
        expect "slower, $law" 0 "$program" run "$dir/hit.yaml" -o "$dir/o" --set sticky=$sticky --set "v=$told*0.99"
        expect "faster, $law" 1 "$program" run "$dir/hit.yaml" -o "$dir/o" --set sticky=$sticky --set "v=$told*1.01"
        says '(overlap_limit: 0.2); try a stiffer material'
        holds 'one advice' [ "$(grep -c 'What to try' "$dir/err")" = 0 ]
    done
done
# One that rests almost as deep is no reason for what fails elsewhere, at the time that is told.
cat >"$dir/pole.yaml" <<'END'
se3d: 1
gravity: [0, 0, -9.81]
contact: {law: hooke}
materials: [{name: soft, stiffness: 492.96, density: 1000, restitution: 0.05}]
bodies:
  - {name: ball, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, 0.0801],
     shapes: [{type: sphere, radius: 0.1, material: soft}]}
  - {name: floor, fixed: true, shapes: [{type: plane, material: soft}]}
  - {name: slider, mass: 1, inertia: [0.01, 0.01, 0.01], position: [5, 0, 0]}
joints: [{name: way, type: prismatic, body_i: ground, body_j: slider, at: [5, 0, 0], axis: [1, 0, 0]}]
forces: [{name: pole, type: tsda, body_i: ground, body_j: slider, h: "1/(t - 0.5)^2"}]
analysis: {type: dynamics, duration: 1}
output: [{file: s.csv, every: 0.1, channels: [ball.position]}]
END
for method in auto bdf radau generalized_alpha; do
    expect "a pole beside a contact, $method" 1 "$program" run "$dir/pole.yaml" -o "$dir/o" --method "$method"
    says 'cannot be met here; the motion is not smooth'
    holds 'no depth is blamed' [ "$(grep -c 'overlap by' "$dir/err")" = 0 ]
done
# Rows far apart: the time is where the step failed, not that of the last row.
sed 's/output: .*/output: [{file: s.csv, every: 0.5, channels: [ball.position]}]/' "$dir/soft.yaml" >"$dir/rare.yaml"
for method in auto bdf radau generalized_alpha; do
    expect "too soft, rows far apart, $method" 1 "$program" run "$dir/rare.yaml" -o "$dir/o" --method "$method"
    says 'failed at t = 0.18466'
    is "$(grep -o 't = [0-9.e-]* s' "$dir/err" | cut -c 1-10 | sort -u | tr '\n' ' ')" 't = 0.1846 '
done
finish
