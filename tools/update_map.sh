#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Write lib/se3d.map and lib/io/se3d-io.map from the SE3D_API declarations of the public headers.
exec python3 "$(dirname "$0")/check_abi.py" update
