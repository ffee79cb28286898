# SPDX-License-Identifier: BSD-3-Clause
# Mock-up units of a model in which numbers of every kind can be set, with a part in another folder, names that XML must
# quote, and an equilibrium before the motion.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
. "$source/tests/support/fmi.sh"

mkdir -p "$dir/a/models" "$dir/a/parts"
cat >"$dir/a/parts/weight.yaml" <<'END_OF_YAML'
se3d: 1
bodies:
  - {name: "w<&>", mass: 2, inertia: [1, 1, 1], position: [0, 3, 0]}
joints:
  - {name: rail, type: prismatic, body_i: ground, body_j: "w<&>", at: [0, 3, 0], axis: [0, 0, 1]}
forces:
  - {name: hold, type: tsda, body_i: ground, body_j: "w<&>", point_i: [0, 3, 1], k: 500, c: 3, l0: 1}
END_OF_YAML
cat >"$dir/a/models/inputs.yaml" <<'END_OF_YAML'
se3d: 1
title: what can be set & <more>
parameters: {m: 3, arm: 500 mm, J: m*arm^2, tilt: 5*deg, stiff: 4 N*m/rad, spin: 2 rad/s}
include:
  - {file: ../parts/weight.yaml}
bodies:
  - {name: disc, mass: m, inertia: [1, 1, J/(1 m^2)], position: [0, 0, 0]}
  - {name: cart, mass: m, inertia: [1, 1, 1], position: [1, 0, 0]}
  - {name: wheel, mass: 1, inertia: [0.1, 0.1, 0.2], position: [4, 0, 0]}
joints:
  - {name: axle, type: revolute, body_i: ground, body_j: disc, at: [0, 0, 0], axis: [0, 0, 1]}
  - {name: slide, type: prismatic, body_i: ground, body_j: cart, at: [1, 0, 0], axis: [1, 0, 0]}
  - {name: pin, type: revolute, body_i: ground, body_j: wheel, at: [4, 0, 0], axis: [0, 0, 1]}
drivers:
  - {name: turn, joint: pin, rate: spin}
  - {name: place, joint: slide, value: 0.25}
forces:
  - {name: motor, type: effort, joint: axle, value: 0.5}
  - {name: twist, type: torque, body: disc, value: [0, 0, 0.1]}
  - {name: push, type: force, body: "w<&>", value: [0, "sin(t)", 1]}
  - {name: spring, type: rsda, joint: axle, k: stiff, c: 0.1}
analysis:
  - {type: equilibrium}
  - {type: dynamics, duration: 0.6, step: 0.01, method: METHOD}
output:
  - {file: inputs.csv, every: 0.02, channels: [axle.angle, axle.rate, axle.torque, cart.position, turn.effort,
     place.effort, rail.displacement, rail.force, pin.angle, energy.total, {"sum": axle.angle + pin.angle}]}
END_OF_YAML
for choice in 'auto 2 3' 'generalized_alpha 2' 'radau 3' 'rattle 2'; do
    method=${choice%% *}
    sed "s/METHOD/$method/; s/inputs.csv/$method.csv/" "$dir/a/models/inputs.yaml" >"$dir/a/models/$method.yaml"
    unit "${choice#* }" $method "$dir/a/models/$method.yaml"
done
has "$dir/auto.2/modelDescription.xml" 'description="what can be set &amp; &lt;more&gt;"'
has "$dir/auto.3/modelDescription.xml" '<Unit name="kg.m2.s-2">'
for input in motor.input twist.input.z push.input.x push.input.z turn.input place.input; do
    has "$dir/auto.2/modelDescription.xml" "name=\"$input\""
done
holds 'a component with a function can be set' sh -c "! grep -q push.input.y '$dir/auto.2/modelDescription.xml'"
holds 'the part is not among the resources' [ -f "$dir/auto.2/resources/parts/weight.yaml" ]

finish
