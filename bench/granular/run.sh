#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# usage: sh bench/granular/run.sh [--quick] [options of compare.py]
# Builds bench_granular, installs LAMMPS and LIGGGHTS where that may be done (Debian, root; without
# them only our own figures are told), and prints the table of README.md. On an idle machine: two
# threads or ranks that wait for a processor measure nothing. About an hour; --quick: minutes.
set -eu
here=$(dirname "$0")
source=$here/../..
for program in lmp:lammps liggghts:liggghts; do
    command -v "${program%:*}" >/dev/null || { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null &&
        apt-get install -y -qq "${program#*:}" >/dev/null 2>&1; } ||
        echo "${program#*:} is not here; going on without"
done
cmake -S "$source" -B "$source/build/bench" -DCMAKE_BUILD_TYPE=Release -DSE3D_BUILD_BENCH=ON \
    -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF >/dev/null
cmake --build "$source/build/bench" --target bench_bench_granular -j2 >/dev/null
program=$source/build/bench/bench/bench_granular
python3 "$here/compare.py" "$program" "$@"
