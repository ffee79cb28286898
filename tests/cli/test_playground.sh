# SPDX-License-Identifier: BSD-3-Clause
# The playground in a real browser; it takes minutes to make. tests/playground tests what is behind the page.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
expect 'no page named' 1 python3 "$source/tools/playground/make.py"
says 'use: make.py PAGE'
if [ -z "${SE3D_LONG:-}" ]; then
    echo 'SKIPPED: the playground takes minutes to make; SE3D_LONG=1 makes it and opens it' >&2
    finish
fi
for tool in emcc node chromium; do
    command -v "$tool" >/dev/null 2>&1 || {
        echo "SKIPPED: no $tool: the playground was not opened" >&2
        finish
    }
done
expect 'the playground is made' 0 python3 "$source/tools/playground/make.py" "$dir/playground.html"
expect 'the playground in Chromium' 0 node "$source/tests/viewer/page.js" "$dir/playground.html" playground
finish
