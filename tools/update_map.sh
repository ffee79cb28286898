#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Write lib/se3d.map and lib/io/se3d-io.map from the SE3D_API declarations of the public headers.
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
exec python3 tools/check_abi.py update
