# SPDX-License-Identifier: BSD-3-Clause
# se3d live: messages, and the server as a page, and as others, would ask it. With SE3D_LONG, 10,000 requests that are
# wrong in places. The page in a real browser where Chromium and node are installed, and cli.view has made three.js.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
export SE3D_VIEWER="$source/tools/viewer"
expect 'help' 0 "$program" live --help
has "$dir/out" '--port'
expect 'no model' 2 "$program" live
expect 'a port in words' 2 "$program" live "$models/pendulum.yaml" --port http
says 'must be 0 to 65535'
expect 'a port that is too large' 2 "$program" live "$models/pendulum.yaml" --port 65536
expect 'no file' 2 "$program" live -
says 'give a file'
mkdir "$dir/cache" "$dir/live"
printf '/* three.js */\n' >"$dir/cache/three.js"
printf 'three 0.187 uplot 1.6.32 %s\n' "$(cksum <"$source/tools/viewer/three_entry.js")" >"$dir/cache/three.stamp"
export SE3D_CACHE="$dir/cache"
if [ -z "${SE3D_HAS_MICROHTTPD:-}" ]; then
    expect 'built without a server' 1 "$program" live "$models/pendulum.yaml"
    says 'built without libmicrohttpd'
    finish
fi
expect 'no such model' 2 "$program" live "$dir/none.yaml"
says 'none.yaml'
printf 'se3d: 1\nbodies: [{name: b, mas: 1}]\n' >"$dir/wrong.yaml"
expect 'a wrong model' 2 "$program" live "$dir/wrong.yaml"
says 'wrong.yaml:2:'
expect 'standard output is closed' 1 sh -c "\"$program\" live \"$models/pendulum.yaml\" >&-"
says 'the address cannot be written'
if [ -w /dev/full ]; then
    expect 'standard output is full' 1 sh -c "\"$program\" live \"$models/pendulum.yaml\" >/dev/full"
    says 'the address cannot be written'
fi
requests=300
[ -z "${SE3D_LONG:-}" ] || requests=10000
expect 'the server' 0 python3 "$source/tests/cli/live.py" "$program" "$dir/live" $requests
grep ' ms from ' "$dir/out"
if [ -z "${SE3D_LONG:-}" ] && [ ! -f "${SE3D_BUILD_DIR:-$dir}/viewer/three.js" ]; then
    echo 'SKIPPED: cli.view has not made three.js, and SE3D_LONG is not set: the page was not opened' >&2
    finish
fi
if ! command -v chromium >/dev/null 2>&1 || ! command -v node >/dev/null 2>&1 || ! command -v npm >/dev/null 2>&1; then
    echo 'SKIPPED: no chromium, node or npm: the page was not opened' >&2
    finish
fi
cat >"$dir/page.yaml" <<'END_OF_YAML'
se3d: 1
title: A block on a spring
parameters: {weight: 2, k: 50 N/m}
bodies:
  - {name: block, mass: weight, inertia: [1, 1, 1], position: [0.3, 0, 0]}
joints:
  - {name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}
forces:
  - {name: spring, type: tsda, body_i: ground, body_j: block, point_i: [-1, 0, 0], k: k, l0: 1}
analysis: {type: dynamics, duration: 10}
END_OF_YAML
SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer" "$program" live "$dir/page.yaml" >"$dir/address" 2>"$dir/err" &
server=$!
for _ in $(seq 300); do
    grep -q http "$dir/address" && break
    sleep 0.1
done
expect 'in Chromium' 0 node "$source/tests/viewer/page.js" "$(head -1 "$dir/address")" live "$dir/page.yaml"
grep ' ms from ' "$dir/out"
kill -INT $server
wait $server
is $? 0
finish
