# SPDX-License-Identifier: BSD-3-Clause
# se3d view: messages, and the page in a real browser where Chromium and node are installed.
set -u
program=${SE3D_PROGRAM:?the path of the se3d program}
source=${SE3D_SOURCE_DIR:-.}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
export SE3D_VIEWER="$source/tools/viewer" SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer"
failures=0
checks=0
expect() {
    name=$1
    code=$2
    shift 2
    "$@" >"$dir/out" 2>"$dir/err"
    actual=$?
    checks=$((checks + 1))
    if [ $actual -ne "$code" ]; then
        echo "$name: exit code $actual, expected $code: $(head -3 "$dir/err")" >&2
        failures=$((failures + 1))
    fi
}
has() {
    checks=$((checks + 1))
    grep -qF -e "$2" "$1" || { echo "$name: \`$2\` not found in $1" >&2; failures=$((failures + 1)); }
}
expect 'help' 0 "$program" view --help
expect 'no folder' 2 "$program" view
expect 'no scene' 1 "$program" view "$dir"
has "$dir/err" 'scene.glb: cannot be read; `se3d run MODEL -o '
if ! command -v npm >/dev/null 2>&1 && [ ! -f /usr/share/javascript/three/three.min.js ]; then
    echo 'SKIPPED: neither npm nor libjs-three: no page was tested' >&2
    echo "$checks checks, $failures failed"
    [ $failures -eq 0 ]
    exit
fi
for pair in pendulum:bar spatial_slider_crank:rod tsda_mass:block; do
    model=${pair%:*}
    "$program" run -q "$source/examples/models/$model.yaml" -o "$dir/$model"
    expect "$model" 0 "$program" view "$dir/$model"
    has "$dir/$model/scene.html" 'Copyright © 2010-20'
    [ "$(wc -c <"$dir/$model/scene.html")" -lt 1000000 ] || { echo "$model: too large" >&2; failures=$((failures + 1)); }
    if command -v chromium >/dev/null 2>&1 && command -v node >/dev/null 2>&1; then
        expect "$model in Chromium" 0 node "$source/tests/viewer/page.js" "$dir/$model/scene.html" "$dir/$model/$model.csv" "${pair#*:}"
    else
        echo "SKIPPED: no chromium or no node: the page of $model was not opened" >&2
    fi
done
expect 'a folder that cannot be written' 1 "$program" view "$dir/pendulum" -o "$dir/none/scene.html"
has "$dir/err" 'cannot be written'
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 64; exec "$@"' sh "$program" view "$dir/pendulum" -o "$dir/full.html"
[ ! -e "$dir/full.html" ] && [ ! -e "$dir/full.html.partial" ] || { echo 'a broken page is left' >&2; failures=$((failures + 1)); }
echo "$checks checks, $failures failed"
[ $failures -eq 0 ]
