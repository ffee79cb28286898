# SPDX-License-Identifier: BSD-3-Clause
# Calls go down the layers: what is called upward is given by the caller, who has the library report, watch or interrupt,
# or by the maker of a thing on a shelf, which has it destroyed with its last user.
# Counted by tools/count_walk.py. Run with SE3D_PROGRAM and SE3D_SOURCE_DIR set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
if ! command -v valgrind >/dev/null 2>&1 || grep -q -e __asan_init -e __tsan_init -e __msan_init "$program"; then
    echo 'SKIPPED: no valgrind, or a sanitizer in its place' >&2
    exit 0
fi

# What `se3d run` of the model $1 calls upward; $2: how the run ends.
walk()
{
    valgrind -q --tool=callgrind --dump-line=no --compress-strings=no --compress-pos=no \
        --callgrind-out-file="$dir/walk" "$program" run "$dir/$1.yaml" -q -o "$dir/results" >"$dir/said" 2>&1
    is $? "$2"
    expect "$1 is counted" 0 python3 "$source/tools/count_walk.py" "$dir/walk"
    mv "$dir/out" "$dir/upward"
    has "$dir/upward" '-> program/'
    expect "$1: all that is called upward is given" 1 grep -v -e '-> program/' -e '^base/shelf.c: ' -e ' upward$' "$dir/upward"
}

cat >"$dir/mass.yaml" <<EOF
se3d: 1
bodies: [{name: b, mass: 0/0, inertia: [1, 1, 1]}]
EOF
walk mass 2
has "$dir/said" 'bodies[0].mass'
cat >"$dir/driven.yaml" <<EOF
se3d: 1
bodies: [{name: b, mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}]
joints: [{name: pin, type: revolute, body_i: ground, body_j: b, at: [0, 0, 0], axis: [0, 1, 0]}]
drivers: [{name: turn, joint: pin, value: "pi/4*cos(2*t)"}]
analysis: {type: inverse_dynamics, duration: 0.1}
output: [{file: a.csv, every: 0.05, channels: [turn.effort]}]
EOF
walk driven 0
finish
