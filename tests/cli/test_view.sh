# SPDX-License-Identifier: BSD-3-Clause
# se3d view: messages, and the page in a real browser where Chromium and node are installed.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
export SE3D_VIEWER="$source/tools/viewer" SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer"
expect 'help' 0 "$program" view --help
expect 'no folder' 2 "$program" view
expect 'no scene' 1 "$program" view "$dir"
has "$dir/err" 'scene.glb: cannot be read; `se3d run MODEL -o '
# Where others can write nothing is run, and nothing is taken from there.
mkdir -m 777 "$dir/open" && mkdir "$dir/shown"
"$program" run -q "$source/examples/models/tsda_mass.yaml" -o "$dir/shown"
expect 'a cache that others can change' 1 env SE3D_CACHE="$dir/open" "$program" view "$dir/shown"
has "$dir/err" 'set SE3D_CACHE to a folder of your own'
holds 'something was made in it' [ -z "$(ls -A "$dir/open")" ]
printf '/* three 0.187 uplot 1.6.32 1 1\nthree.js of another version: */\nwindow.se3dReady = 0;\n' >"$dir/other.js"
mkdir "$dir/given"
expect 'a three.js that is something else' 1 env SE3D_CACHE="$dir/given" SE3D_THREE="$dir/other.js" "$program" view "$dir/shown"
has "$dir/err" 'other.js was not made by tools/viewer/build.sh of this version'
holds 'it was taken' [ ! -e "$dir/given/three.js" ]
if ! command -v npm >/dev/null 2>&1; then
    echo 'SKIPPED: no npm: no page was tested' >&2
    finish
fi
# Pages are opened at the end, in one browser: words of tests/viewer/page.js, one a line.
opens() {
    printf '%s\n' "$@" -- >>"$dir/jobs"
}
expect 'a model is run first' 0 sh -c 'cd "$1" && "$0" view "$2" -q' "$program" "$dir" \
    "$source/examples/models/tsda_mass.yaml"
holds 'its page is there' [ -s "$dir/results/tsda_mass/scene.html" ]
brief=
for pair in pendulum:bar spatial_slider_crank:rod tsda_mass:block; do
    model=${pair%:*}
    "$program" run -q "$source/examples/models/$model.yaml" -o "$dir/$model"
    expect "$model" 0 "$program" view "$dir/$model"
    has "$dir/$model/scene.html" 'Copyright © 2010-20'
    [ "$(wc -c <"$dir/$model/scene.html")" -lt 1000000 ] || fail "$model is too large"
    [ "$model" = pendulum ] || opens $brief "$dir/$model/scene.html" "$dir/$model/$model.csv" "${pair#*:}"
    [ "$model" = pendulum ] || [ -n "${SE3D_LONG:-}" ] || brief=brief # keys and mouse once
done
# Events are no results, though their file comes first.
"$program" run -q "$source/examples/models/pendulum_events.yaml" -o "$dir/events"
expect 'beside a file of events' 0 "$program" view -q "$dir/events"
has "$dir/events/scene.html" '"names":["time","pin.angle"'
# 20 bodies over 10 s, more rows than a scene has samples: still exact, still small.
{
    printf 'se3d: 1\ntitle: <script>alert("x")</script> & \047twenty\047\nbodies:\n'
    for k in $(seq 20); do echo "  - {name: b$k, mass: 1, inertia: [1, 1, 1], position: [1, $k, 0]}"; done
    echo 'joints:'
    for k in $(seq 20); do echo "  - {name: j$k, type: revolute, body_i: ground, body_j: b$k, at: [0, $k, 0], axis: [0, 1, 0]}"; done
    echo 'drivers:'
    for k in $(seq 20); do echo "  - {name: d$k, joint: j$k, coordinate: angle, value: \"sin($k*t)\"}"; done
    echo 'analysis: {type: kinematics, duration: 10, step: 0.005}'
} >"$dir/twenty.yaml"
expect 'a run of 20 bodies' 0 "$program" run -q "$dir/twenty.yaml" -o "$dir/twenty"
expect '20 bodies' 0 "$program" view -q "$dir/twenty"
size=$(wc -c <"$dir/twenty/scene.html")
echo "20 bodies over 10 s: $size bytes"
checks=$((checks + 1))
[ "$size" -lt 1500000 ] || fail "20 bodies: $size bytes"
opens $brief "$dir/twenty/scene.html" "$dir/twenty/results.csv" b2
# 10,000 grains, or 1,200 if there is not much time: some come late, some leave early.
many=1200
[ -z "${SE3D_LONG:-}" ] || many=10000
"$program" run -q "$source/examples/models/pushed_grains.yaml" -o "$dir/grains" --duration 0.1
opens_grains() {
    expect "$1 grains" 0 "$program" view -q "$dir/grains" -o "$dir/$1.html"
    cp "$dir/grains/grains.csv" "$dir/$1.csv"
    opens $brief "$dir/$1.html" "$dir/$1.csv" grains
}
opens_grains few
awk -v many=$many 'BEGIN {
    print "time,id,radius,x,y,z,vx,vy,vz,wx,wy,wz"
    for (s = 0; s < 5; ++s) for (k = 0; k < many; ++k)
        if (!(s == 1 && k < 3) && !(s == 4 && k > many - 10))
            printf "%.17g,%d,0.006,%.17g,%.17g,%.17g,0,0,0,0,0,0\n", 0.15 * s, k + 7, 0.012 * (k % 25) + 0.01 * s, 0.012 * (int(k / 25) % 20), 0.012 * int(k / 500) - 0.2 - 0.002 * s
}' >"$dir/grains/grains.csv"
opens_grains many
# Shapes of modes are in the page, and move in it.
cat >"$dir/modes.yaml" <<'END_OF_YAML'
se3d: 1
gravity: [0, 0, 0]
bodies:
  - {name: a, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}
  - {name: b, mass: 1, inertia: [1, 1, 1], position: [2, 0, 0]}
joints:
  - {name: ra, type: prismatic, body_i: ground, body_j: a, at: [1, 0, 0], axis: [1, 0, 0]}
  - {name: rb, type: prismatic, body_i: ground, body_j: b, at: [2, 0, 0], axis: [1, 0, 0]}
forces:
  - {name: s1, type: tsda, body_i: ground, body_j: a, point_i: [0, 0, 0], k: 100, l0: 1}
  - {name: s2, type: tsda, body_i: a, body_j: b, k: 100, l0: 1, c: 0.2}
analysis: {type: modes}
END_OF_YAML
expect 'a run of modes' 0 "$program" run -q "$dir/modes.yaml" -o "$dir/modes"
expect 'modes' 0 "$program" view -q "$dir/modes"
has "$dir/modes/scene.html" '{"names":["mode","real","imag","frequency","damping","a.x",'
if [ -n "${SE3D_LONG:-}" ]; then
    opens "$dir/modes/scene.html" modes "$dir/modes/modes.csv"
fi
# Of a suspension every joint is seen, of a hopper a third of the beads.
for pair in suspension:joints hopper:beads; do
    model=${pair%:*}
    "$program" run -q "$source/examples/models/$model.yaml" -o "$dir/$model" --duration 0.05
    expect "$model" 0 "$program" view -q "$dir/$model"
    opens $brief "$dir/$model/scene.html" "${pair#*:}"
done
# Two runs in one page.
sed 's/mass: 1,/mass: 30,/; s/\[0.02, 0, 0\]/[3, 0, 0]/; s/duration: 4/duration: 0.5/' "$source/examples/models/tsda_mass.yaml" >"$dir/far.yaml"
expect 'a run that goes far' 0 "$program" run -q "$dir/far.yaml" -o "$dir/other"
expect 'a run that stands still' 0 "$program" run -q "$source/examples/models/tsda_mass.yaml" --analysis equilibrium -o "$dir/still"
expect 'no second scene' 1 "$program" view -q "$dir/tsda_mass" --with "$dir/none"
has "$dir/err" 'none/scene.glb: cannot be read'
expect 'two runs' 0 "$program" view -q "$dir/still" --with "$dir/other" -o "$dir/two.html"
opens $brief "$dir/two.html" second "$dir/other/tsda_mass.csv" block
# Khronos' own validator has nothing against the scenes.
expect 'a kerb' 0 "$program" run -q "$source/examples/fsae/kerb.yaml" -o "$dir/kerb" --duration 0.1
holds 'no scene of the kerb' [ -s "$dir/kerb/scene.glb" ]
if command -v node >/dev/null 2>&1 && npm install --prefix "$dir/khronos" --fetch-retries=1 --prefer-offline --silent --no-audit --no-fund \
    --no-save gltf-validator@2.0.0-dev.3.10 >/dev/null 2>&1; then
    cat >"$dir/khronos/check.js" <<'END_OF_SCRIPT'
const validator = require("gltf-validator"), fs = require("fs");
(async () => {
  for (const file of process.argv.slice(2)) {
    const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    if (issues.numErrors + issues.numWarnings > 0) { console.error(file, JSON.stringify(issues.messages.slice(0, 5))); process.exitCode = 1; }
  }
  console.log(`${process.argv.length - 2} scenes`);
})();
END_OF_SCRIPT
    expect 'the glTF validator' 0 node "$dir/khronos/check.js" "$dir"/*/scene.glb
    has "$dir/out" ' scenes'
else
    echo 'SKIPPED: no gltf-validator from npm: the scenes were not validated' >&2
fi
expect 'a scene alone' 0 sh -c 'mkdir "$2" && cp "$1/scene.glb" "$2" && "$0" view -q "$2"' "$program" "$dir/pendulum" "$dir/alone"
opens $brief "$dir/alone/scene.html" none
if command -v chromium >/dev/null 2>&1 && command -v node >/dev/null 2>&1; then
    tr '\n' '\0' <"$dir/jobs" >"$dir/words"
    expect 'in Chromium' 0 xargs -0 -x node "$source/tests/viewer/page.js" <"$dir/words"
    grep ' grains: ' "$dir/out" || true
else
    echo 'SKIPPED: no chromium or no node: the pages were not opened' >&2
fi
echo 'time,bar.position.x' >"$dir/alone/empty.csv"
expect 'a CSV file without rows' 1 "$program" view "$dir/alone"
has "$dir/err" 'has no rows'
expect 'a folder that cannot be written' 1 "$program" view "$dir/pendulum" -o "$dir/none/scene.html"
has "$dir/err" 'cannot be written'
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 64; exec "$@"' sh "$program" view "$dir/pendulum" -o "$dir/full.html"
[ ! -e "$dir/full.html" ] && [ ! -e "$dir/full.html.partial" ] || fail 'a broken page is left'
finish
