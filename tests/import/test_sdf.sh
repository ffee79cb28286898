#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# SDF against equations of motion of the same robot in URDF, and closed forms.
[ -n "$SE3D_HAS_EXPAT" ] || { echo "import.sdf: built without expat, nothing to test"; exit 0; }
exec python3 "$SE3D_SOURCE_DIR/tests/import/check_sdf.py"
