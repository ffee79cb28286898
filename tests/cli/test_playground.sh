# SPDX-License-Identifier: BSD-3-Clause
# The playground in a real browser, made quickly: with SE3D_LONG as it is for readers, which takes minutes.
# tests/playground tests what is behind the page.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
expect 'no page named' 1 python3 "$source/tools/playground/make.py"
says 'use: make.py [--quick] PAGE'
for tool in emcc node chromium npm; do
    command -v "$tool" >/dev/null 2>&1 || {
        echo "SKIPPED: no $tool: the playground was not opened" >&2
        finish
    }
done
quick=--quick
[ -z "${SE3D_LONG:-}" ] || quick=
[ ! -f "${SE3D_BUILD_DIR:-$dir}/viewer/three.js" ] || export SE3D_THREE="$SE3D_BUILD_DIR/viewer/three.js"
# shellcheck disable=SC2086
expect 'the playground is made' 0 python3 "$source/tools/playground/make.py" $quick "$dir/playground.html"
expect 'the playground in Chromium' 0 node "$source/tests/viewer/page.js" "$dir/playground.html" playground
finish
