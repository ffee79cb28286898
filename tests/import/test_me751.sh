#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Models of the course ME751 against the closed form of its pendulum.
exec python3 "$SE3D_SOURCE_DIR/tests/import/check_me751.py"
