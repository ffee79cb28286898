# SPDX-License-Identifier: BSD-3-Clause
# Mock-up units that `se3d fmu` makes: the archive, what the shared object needs, what the checker finds of models without
# inputs, and what cannot be a unit.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
. "$source/tests/support/fmi.sh"

unit '2 3' pendulum "$models/pendulum.yaml" --duration 3
unit '2 3' fourbar "$models/fourbar.yaml" --duration 0.5
unit '2 3' quarter_car "$models/quarter_car.yaml" --duration 0.6 --set ks=21000

# An event that ends the model, in the last step of the results.
sed 's/^analysis:.*/events: [{name: low, channel: pin.angle, value: 0, direction: falling, action: stop}]\n&/' \
    "$models/pendulum_free.yaml" >"$dir/ends.yaml"
unit '2 3' ends "$dir/ends.yaml" --duration 3

# An event that ends the analysis before the one of the unit.
cat >"$dir/before.yaml" <<'END_OF_YAML'
se3d: 1
bodies:
  - {name: block, mass: 2, inertia: [1, 1, 1], position: [0.3, 0, 0]}
joints:
  - {name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}
forces:
  - {name: spring, type: tsda, body_i: ground, body_j: block, point_i: [-1, 0, 0], point_j: [0, 0, 0], k: 50, l0: 1}
events: [{name: stop, channel: block.position.x, value: 0.1, action: stop}]
analysis: [{type: dynamics, duration: 1}, {type: dynamics, start: 1, duration: 0.3}]
output: [{file: a.csv, every: 0.1, channels: [block.position.x, block.velocity.x]}]
END_OF_YAML
expect 'an event before' 0 "$program" run -q "$dir/before.yaml" -o "$dir/before.run"
awk -F, 'NR == 1 || $1 >= 1' "$dir/before.run/a.csv" >"$dir/before.csv"
expect 'an event before' 0 "$program" fmu "$dir/before.yaml" -o "$dir/before.fmu"
unpack "$dir/before.fmu" "$dir/before"
expect 'an event before, as a unit' 0 "$SE3D_CHECK_FMU" "$dir/before" "$dir/before.csv"

holds 'python finds the archive damaged' python3 -m zipfile -t "$dir/pendulum.3.fmu" >/dev/null

has "$dir/pendulum.3/documentation/licenses/license.txt" 'Kirill Simonov'

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
printf 'se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1]}]\n' >"$dir/part.yaml"
printf 'se3d: 1\ninclude: [{file: %s/part.yaml}]\nanalysis: {type: dynamics, duration: 1}\n' "$dir" >"$dir/root.yaml"
expect 'a path from the root' 2 "$program" fmu "$dir/root.yaml" -o "$dir/no.fmu"
says 'name it from the model'
# A file that is named in two ways lies there once; two that would lie at one place do not.
mkdir -p "$dir/c/model" "$dir/c/other"
for folder in model other; do cp "$dir/part.yaml" "$dir/c/$folder/x.yaml"; done
motion='analysis: {type: dynamics, duration: 1}'
printf 'se3d: 1\ninclude: [{file: x.yaml, prefix: p_}, {file: ./x.yaml, prefix: q_}]\n%s\n' "$motion" >"$dir/c/other/twice.yaml"
expect 'a file that is named in two ways' 0 "$program" fmu "$dir/c/other/twice.yaml" -o "$dir/twice.fmu"
is "$(python3 -m zipfile -l "$dir/twice.fmu" | grep -c x.yaml)" 1
printf 'se3d: 1\ninclude: [{file: x.yaml, prefix: p_}, {file: ../model/x.yaml, prefix: q_}]\n%s\n' "$motion" >"$dir/c/other/one.yaml"
expect 'two files for one place' 2 "$program" fmu "$dir/c/other/one.yaml" -o "$dir/no.fmu"
says 'another file would have its place'
expect 'no object' 1 env SE3D_FMU_OBJECT="$dir/none.so" "$program" fmu "$models/pendulum.yaml" -o "$dir/no.fmu"
says 'none.so'
holds 'something is left of a unit that could not be made' [ -z "$(ls "$dir" | grep '^no\.fmu')" ]
finish
