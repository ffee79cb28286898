#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# usage: sh bench/granular/run.sh [--quick] [options of compare.py]
# Builds bench_granular, installs LAMMPS and LIGGGHTS where that may be done (Debian, root; without
# them only our own figures are told), and prints the table of README.md. On an idle machine: two
# threads or ranks that wait for a processor measure nothing. About an hour; --quick: minutes.
set -eu
here=$(dirname "$0")
source=$here/../..
. "$source/tools/setup.sh"
# shellcheck disable=SC2086
se3d_install $SE3D_BUILD_PACKAGES python3
for package in lammps liggghts openmpi-bin; do
    se3d_install "$package" || echo "!! $package could not be installed; going on without" >&2
done
cmake -S "$source" -B "$source/build/bench" -DCMAKE_BUILD_TYPE=Release -DSE3D_BUILD_BENCH=ON \
    -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF >/dev/null
cmake --build "$source/build/bench" --target bench_bench_granular -j2 >/dev/null
program=$source/build/bench/bench/bench_granular
python3 "$here/compare.py" "$program" "$@"
