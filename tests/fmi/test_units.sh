# SPDX-License-Identifier: BSD-3-Clause
# Mock-up units that `se3d fmu` makes: the archive, what the shared object needs, and what the checker finds of models
# with and without inputs, parts in other folders, and an end.
set -u
if [ -z "${SE3D_CHECK_FMU:-}" ]; then
    echo 'this build has no mock-up units'
    exit 0
fi
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

# unit NAME MODEL OPTION...: make, unpack, run and check it with both versions of the standard
unit() {
    case=$1
    model=$2
    shift 2
    expect "$case" 0 "$program" run -q "$model" "$@" -o "$dir/$case.run"
    results=$(ls "$dir/$case.run/"*.csv | grep -v -e events.csv -e ride.csv | head -1)
    for fmi in $versions; do
        folder=$dir/$case.$fmi
        expect "$case" 0 "$program" fmu "$model" "$@" --fmi $fmi -o "$folder.fmu"
        holds "$case: python finds the archive damaged" python3 -m zipfile -t "$folder.fmu"
        mkdir "$folder"
        holds "$case: cannot be unpacked" python3 -m zipfile -e "$folder.fmu" "$folder"
        expect "$case, FMI $fmi" 0 "$SE3D_CHECK_FMU" "$folder" "$results"
        cat "$dir/err" >&2
    done
}
versions=2

unit pendulum "$models/pendulum.yaml" --duration 3
unit fourbar "$models/fourbar.yaml" --duration 1.5
unit quarter_car "$models/quarter_car.yaml" --duration 1 --set ks=21000

# What can be set, of every kind; a part in a folder beside; names that XML and YAML must quote; an equilibrium before.
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
parameters: {m: 3, arm: 500 mm, J: m*arm^2, tilt: 5*deg}
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
  - {name: turn, joint: pin, rate: 2}
  - {name: place, joint: slide, value: 0.25}
forces:
  - {name: motor, type: effort, joint: axle, value: 0.5}
  - {name: twist, type: torque, body: disc, value: [0, 0, 0.1]}
  - {name: push, type: force, body: "w<&>", value: [0, "sin(t)", 1]}
  - {name: spring, type: rsda, joint: axle, k: 4, c: 0.1}
analysis:
  - {type: equilibrium}
  - {type: dynamics, duration: 1, step: 0.01, method: METHOD}
output:
  - {file: inputs.csv, every: 0.02, channels: [axle.angle, axle.rate, axle.torque, cart.position, turn.effort,
     place.effort, rail.displacement, rail.force, pin.angle, energy.total, {"sum": axle.angle + pin.angle}]}
END_OF_YAML
for method in auto generalized_alpha radau rattle; do
    sed "s/METHOD/$method/; s/inputs.csv/$method.csv/" "$dir/a/models/inputs.yaml" >"$dir/a/models/$method.yaml"
    unit $method "$dir/a/models/$method.yaml"
done
has "$dir/auto.2/modelDescription.xml" 'description="what can be set &amp; &lt;more&gt;"'
has "$dir/auto.2/modelDescription.xml" '<Unit name="kg.m2.s-2">'
for input in motor.input twist.input.z push.input.x push.input.z turn.input place.input; do
    has "$dir/auto.2/modelDescription.xml" "name=\"$input\""
done
holds 'a component with a function can be set' sh -c "! grep -q push.input.y '$dir/auto.2/modelDescription.xml'"
holds 'the part is not among the resources' [ -f "$dir/auto.2/resources/parts/weight.yaml" ]

# An event that ends the model, in the last step of the results.
sed 's/^analysis:.*/events: [{name: low, channel: pin.angle, value: 0, direction: falling, action: stop}]\n&/' \
    "$models/pendulum_free.yaml" >"$dir/ends.yaml"
unit ends "$dir/ends.yaml" --duration 3

# The same model makes the same bytes, wherever it lies; nothing but libc and libm is needed.
cp "$models/pendulum.yaml" "$dir/pendulum.yaml"
expect 'again' 0 "$program" fmu "$dir/pendulum.yaml" --duration 3 -o "$dir/again.fmu"
holds 'the same model makes another unit' cmp "$dir/again.fmu" "$dir/pendulum.2.fmu"
if command -v ldd >/dev/null && [ -z "${UBSAN_OPTIONS:-}" ]; then
    needed=$(ldd "$SE3D_FMU_OBJECT" | grep -v -e linux-vdso -e 'libc\.so' -e 'libm\.so' -e ld-linux)
    is "$needed" ''
fi

# What cannot be a unit.
expect 'particles' 2 "$program" fmu "$models/hopper.yaml" -o "$dir/no.fmu"
says 'the model has particles'
expect 'nothing moves' 2 "$program" fmu "$models/bar_equilibrium.yaml" -o "$dir/no.fmu"
says 'no analysis in which time passes'
expect 'version' 2 "$program" fmu "$models/pendulum.yaml" --fmi 1 -o "$dir/no.fmu"
says 'must be 2 or 3'
sed "s|../parts|$dir/a/parts|" "$dir/a/models/auto.yaml" >"$dir/root.yaml"
expect 'a path from the root' 2 "$program" fmu "$dir/root.yaml" -o "$dir/no.fmu"
says 'name it from the model'
expect 'no object' 1 env SE3D_FMU_OBJECT="$dir/none.so" "$program" fmu "$models/pendulum.yaml" -o "$dir/no.fmu"
says 'none.so'
holds 'something is left of a unit that could not be made' [ -z "$(ls "$dir" | grep '^no\.fmu')" ]
finish
