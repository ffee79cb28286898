#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Builds the Python package on the shared libraries of the build folder and runs its tests, the
# program of docs/python.md and the examples of examples/python.
set -eu
python=
for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import cffi, numpy, sysconfig, os
assert os.path.exists(os.path.join(sysconfig.get_paths()["include"], "Python.h"))' 2>/dev/null; then
        python=$candidate
        break
    fi
done
if [ -z "$python" ]; then
    echo "SKIPPED: no Python with cffi, numpy and Python.h (Debian: python3-cffi python3-numpy python3-dev)"
    exit 77
fi
work=$SE3D_BUILD_DIR/python
rm -rf "$work"
mkdir -p "$work"
cp -r "$SE3D_SOURCE_DIR/python/." "$work"
SE3D_INCLUDE=$SE3D_SOURCE_DIR/include SE3D_LIBRARIES=$SE3D_BUILD_DIR/lib \
    "$python" "$work/build_se3d.py" >"$work/build.log" 2>&1 || {
    cat "$work/build.log"
    exit 1
}
export SE3D_PROGRAM="$SE3D_BUILD_DIR/bin/se3d"
export PYTHONPATH="$work" PYTHONDONTWRITEBYTECODE=1
"$python" -W error -m unittest discover -s "$SE3D_SOURCE_DIR/tests/python" -v
sed -n '/^```python$/,/^```$/{/^```/!p}' "$SE3D_SOURCE_DIR/docs/python.md" >"$work/page.py"
for example in "$work/page.py" "$SE3D_SOURCE_DIR"/examples/python/*.py; do
    echo "== $example"
    (cd "$work" && "$python" -W error "$example")
done
