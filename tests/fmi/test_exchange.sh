# SPDX-License-Identifier: BSD-3-Clause
# Model exchange of a model with every kind of coordinate, with states, inputs and events, and what it is refused for.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
. "$source/tests/support/fmi.sh"

cat >"$dir/kinds.yaml" <<'END_OF_YAML'
se3d: 1
bodies:
  - {name: free, mass: 2, inertia: [0.1, 0.2, 0.3], position: [0, 0, 1], angular_velocity: [1, 2, 0.5]}
  - {name: ball, mass: 1, inertia: [0.2, 0.3, 0.1], position: [2, 0, -1], angular_velocity: [0.3, 0, 1]}
  - {name: tube, mass: 1, inertia: [0.2, 0.3, 0.1], position: [4, 0, 0], velocity: [0, 0, 0.4], angular_velocity: [0, 0, 2]}
  - {name: cross, mass: 1, inertia: [0.2, 0.3, 0.1], position: [6, 0, -1]}
  - {name: plate, mass: 1, inertia: [0.2, 0.3, 0.1], position: [8, 0, 0], velocity: [0.2, 0.1, 0], angular_velocity: [0, 0, 1]}
  - {name: arm, mass: 1, inertia: [0.1, 0.1, 0.1], position: [10, 0, -1]}
joints:
  - {name: socket, type: spherical, body_i: ground, body_j: ball, at: [2, 0, 0]}
  - {name: sleeve, type: cylindrical, body_i: ground, body_j: tube, at: [4, 0, 0], axis: [0, 0, 1]}
  - {name: knuckle, type: universal, body_i: ground, body_j: cross, point_i: [6, 0, 0], point_j: [0, 0, 1],
     axis_i: [1, 0, 0], axis_j: [0, 1, 0]}
  - {name: table, type: planar, body_i: ground, body_j: plate, at: [8, 0, 0], axis: [0, 0, 1]}
  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [10, 0, 0], axis: [0, 1, 0]}
forces:
  - {name: rope, type: tsda, body_i: ground, body_j: free, point_i: [0, 0, 3], point_j: [0.1, 0, 0], k: 40, c: 1, l0: 1}
  - {name: hang, type: tsda, body_i: ground, body_j: tube, point_i: [4, 0, 3], k: 30, l0: 2}
  - {name: motor, type: effort, joint: pin, value: 2*lag.value}
  - {name: push, type: force, body: plate, value: [0.5, 0, 0]}
states:
  - {name: lag, type: lag, input: 0.3 - pin.angle, time_constant: 0.1}
events:
  - {name: up, channel: free.velocity.z, value: 0}
analysis: {type: dynamics, duration: 0.5, tolerance: 1e-8}
output:
  - {file: kinds.csv, every: 0.05, channels: [free.position, free.orientation, ball.position, sleeve.angle,
     sleeve.displacement, cross.position, plate.velocity, plate.acceleration, pin.angle, pin.force, energy.total]}
END_OF_YAML
unit '2 3' kinds "$dir/kinds.yaml"
has "$dir/kinds.3/modelDescription.xml" 'name="der(state.free.e2)"'
has "$dir/kinds.2/modelDescription.xml" 'numberOfEventIndicators="1"'
if command -v xmllint >/dev/null; then
    holds 'the description is no XML' xmllint --noout "$dir/kinds.2/modelDescription.xml"
fi

cat >"$dir/level.yaml" <<'END_OF_YAML'
se3d: 1
gravity: [0, 0, 0]
bodies: [{name: block, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]
joints: [{name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]
forces: [{name: drag, type: force, body: block, value: [-0.1*t, 0, 0]}]
events: [{name: mark, channel: rail.displacement, value: 0.3125, action: stop}]
analysis: {type: dynamics, duration: 0.5, tolerance: 1e-8}
output: [{file: level.csv, every: 0.05, channels: [rail.displacement]}]
END_OF_YAML
unit '2 3' level "$dir/level.yaml"

# What remembers more than states is for co-simulation only, and the program says why.
refused() {
    expect "$1" 0 "$program" fmu "$2" -o "$dir/$1.fmu"
    holds "$1: no word of model exchange" grep -q "not for model exchange: $3" "$dir/out"
    unpack "$dir/$1.fmu" "$dir/$1.2"
    holds "$1: has model exchange" sh -c "! grep -q ModelExchange '$dir/$1.2/modelDescription.xml'"
}
sed 's/^forces:/&\n  - {name: brake, type: friction, joint: pin, mu: 0.3, radius: 0.1}/' "$dir/kinds.yaml" >"$dir/friction.yaml"
sed 's/energy.total/energy.dissipated/' "$dir/kinds.yaml" >"$dir/sums.yaml"
refused friction "$dir/friction.yaml" 'brake sticks'
refused sums "$dir/sums.yaml" 'energy.dissipated is summed up'
finish
