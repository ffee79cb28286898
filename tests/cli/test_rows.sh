# SPDX-License-Identifier: BSD-3-Clause
# Rows of results: those whose channels follow from the motion are interpolated, accelerations are
# solved for only if a row at that time asks for them. Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"

# A closed chain of two balls and two pins with a spring; $2: its output.
model()
{
    cat >"$dir/$1.yaml" <<EOF
se3d: 1
bodies:
  - {name: a, mass: 1, inertia: [0.03, 0.02, 0.01], position: [0, 0, 0.25]}
  - {name: b, mass: 2, inertia: [0.03, 0.02, 0.01], position: [0.5, 0.1, 0.5]}
  - {name: c, mass: 3, inertia: [0.03, 0.02, 0.01], position: [1, 0.2, 0.25]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: ball, type: spherical, body_i: a, body_j: b, at: [0, 0, 0.5]}
  - {name: joint, type: spherical, body_i: b, body_j: c, at: [1, 0.2, 0.5]}
  - {name: hinge, type: revolute, body_i: ground, body_j: c, at: [1, 0.2, 0], axis: [0.2, 1, 0]}
forces:
  - {name: spring, type: tsda, body_i: ground, body_j: c, at: [2, 0, 0], at_2: [1, 0.2, 0.25], k: 30, c: 0.7, l0: 1}
analysis: {type: dynamics, duration: 1}
output: [$2]
EOF
}
motion='b.position, b.velocity, pin.angle, pin.rate, spring.force, energy.total, energy.balance'
model motion "{file: o.csv, every: 0.001953125, channels: [$motion]}"
model some "{file: o.csv, every: 0.001953125, channels: [$motion]}, {file: s.csv, every: 0.125, channels: [b.acceleration, pin.force]}"
model all "{file: o.csv, every: 0.001953125, channels: [$motion, b.acceleration, pin.force]}"
for kind in motion some all; do
    expect "rows of $kind" 0 "$program" run "$dir/$kind.yaml" -o "$dir/$kind" --json
    cp "$dir/out" "$dir/$kind.json"
done
expect 'the same motion, by fewer evaluations' 0 python3 - "$dir" <<'EOF'
import csv, json, sys
folder = sys.argv[1]
names = ('motion', 'some', 'all')
done = {n: json.load(open(f'{folder}/{n}.json'))['analyses'][0] for n in names}
rows = {n: list(csv.DictReader(open(f'{folder}/{n}/o.csv'))) for n in names}
solved = list(csv.DictReader(open(f'{folder}/some/s.csv')))
assert len({d['steps'] for d in done.values()}) == 1, done
counts = [done[n]['evaluations'] for n in names]
assert counts[1] - counts[0] == 7 and counts[2] - counts[0] == 511, counts # the last one is whole
for name in names[:2]:
    assert len(rows[name]) == 513
    for row, other in zip(rows[name], rows['all']):
        for column, value in row.items():
            assert abs(float(value) - float(other[column])) < 1e-5, (name, column, value, other[column])
assert len(solved) == 9
for k, row in enumerate(solved):
    assert all(row[c] == rows['all'][64 * k][c] for c in row), (row, rows['all'][64 * k])
EOF
# What an armature takes needs accelerations, whatever else a row shows.
cat >"$dir/rotor.yaml" <<'EOF'
se3d: 1
bodies: [{name: b, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: b, at: [0, 0, 0], axis: [0, 1, 0]}]
forces: [{name: rotor, type: armature, joint: pin, inertia: 0.4}]
gravity: [0, 0, -9.81]
analysis: {type: dynamics, duration: 1}
output:
  - {file: all.csv, every: 0.01, channels: [rotor.effort, rotor.rate, b.angular_acceleration]}
EOF
sed 's/, b.angular_acceleration//' "$dir/rotor.yaml" >"$dir/alone.yaml"
for kind in rotor alone; do
    expect "an armature: $kind" 0 "$program" run -q "$dir/$kind.yaml" -o "$dir/$kind"
done
expect 'the same effort' 0 python3 - "$dir" <<'EOF'
import csv, sys
rotor, alone = (list(csv.DictReader(open(f'{sys.argv[1]}/{n}/all.csv'))) for n in ('rotor', 'alone'))
assert len(rotor) == len(alone) == 101
for a, b in zip(rotor, alone):
    assert a['rotor.effort'] == b['rotor.effort'] and a['rotor.rate'] == b['rotor.rate']
    assert abs(float(a['rotor.effort']) + 0.4 * float(a['b.angular_acceleration.y'])) < 1e-12
EOF
finish
