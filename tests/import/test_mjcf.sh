#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# MJCF against closed forms, and against the same arm as URDF.
[ -n "$SE3D_HAS_EXPAT" ] || { echo "import.mjcf: built without expat, nothing to test"; exit 0; }
exec python3 "$SE3D_SOURCE_DIR/tests/import/check_mjcf.py"
