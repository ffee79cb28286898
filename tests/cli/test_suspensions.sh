# SPDX-License-Identifier: BSD-3-Clause
# Suspensions by their hardpoints alone: double wishbones with and without rods, a strut, five links, beside a
# computation of their own.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
expect 'eight suspensions' 0 python3 "$source/tests/cli/suspensions.py" "$program" "$dir"
holds "not eight: $(cat "$dir/out")" [ "$(grep -c '41 rows' "$dir/out")" = 8 ]
finish
