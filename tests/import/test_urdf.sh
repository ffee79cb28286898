#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# URDF against equations of motion that are written from the file itself.
[ -n "$SE3D_HAS_EXPAT" ] || { echo "import.urdf: built without expat, nothing to test"; exit 0; }
exec python3 "$SE3D_SOURCE_DIR/tests/import/check_urdf.py"
