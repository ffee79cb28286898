#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Chrono YAML against closed forms.
exec python3 "$SE3D_SOURCE_DIR/tests/import/check_chrono.py"
