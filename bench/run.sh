#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The bench beside other engines, about three minutes: installs them where it can (Debian), builds
# this library (release) and the drivers, and prints the tables that bench/README.md explains.
#
#     sh bench/run.sh [SECTION...]      cost work fourbar pendulum implicit lanes batch query touch;
# all without arguments
#
# Without the other engines it still measures this library alone. SE3D_BENCH_DIR: the build folder
# (build/bench); SE3D_BENCH_INSTALL=0 installs nothing.
set -u
root=$(cd "$(dirname "$0")/.." && pwd) || exit 1
# shellcheck source=tools/setup.sh
. "$root/tools/setup.sh"
build=${SE3D_BENCH_DIR:-$root/build/bench}
peers=$root/bench/peers
bin=$build/bench

if [ "${SE3D_BENCH_INSTALL:-1}" != 0 ]; then
    # shellcheck disable=SC2086
    se3d_install $SE3D_BUILD_PACKAGES python3 g++ || exit 1
    for package in libmujoco-dev libsimbody-dev libbullet-dev libode-dev; do
        se3d_install "$package" || echo "!! $package could not be installed" >&2
    done
fi

mkdir -p "$build" || exit 1
{
    cd "$root" && cmake --preset release -B "$build" -DSE3D_BUILD_BENCH=ON \
        -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF &&
        cmake --build "$build" --target bench_bench_serve bench_bench_evaluation bench_bench_tree \
            bench_bench_batch bench_bench_query bench_bench_touch -j "$(se3d_jobs)"
} >"$build/build.log" 2>&1 || {
    cat "$build/build.log" >&2
    exit 1
}

# build_peer NAME COMPILER ARGUMENT...: a driver that does not build is left out, and said so.
build_peer() {
    name=$1
    shift
    rm -f "$bin/$name"
    if ! "$@" -o "$bin/$name" >"$bin/$name.log" 2>&1; then
        echo "!! no driver for $name ($bin/$name.log):" >&2
        head -n 2 "$bin/$name.log" >&2
    fi
}

# flags PACKAGE: what pkg-config says, nothing if it is missing
flags() {
    pkg-config --cflags --libs "$1" 2>/dev/null
}

# shellcheck disable=SC2046
{
    build_peer mujoco gcc -std=c11 -O2 "$peers/mujoco.c" -lmujoco -lm
    build_peer mujoco_batch gcc -std=c11 -O2 "$peers/mujoco_batch.c" -lmujoco -lm
    build_peer mujoco_query gcc -std=c11 -O2 "$peers/mujoco_query.c" -lmujoco -lm
    build_peer mujoco_touch gcc -std=c11 -O2 "$peers/mujoco_touch.c" -lmujoco -lm
    build_peer ode gcc -std=c11 -O2 "$peers/ode.c" $(flags ode) -lm
    build_peer bullet g++ -std=c++14 -O2 "$peers/bullet.cpp" $(flags bullet-float64) -lm
    build_peer simbody g++ "$peers/simbody.cpp" $(flags simbody) -std=c++14 -O2 -lm
    if pkg-config --exists pinocchio; then # not in Debian
        build_peer pinocchio_query g++ -std=c++17 -O3 -DNDEBUG "$peers/pinocchio_query.cpp" $(flags pinocchio) -lm
    fi
}

sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1
date -u '+%Y-%m-%d %H:%M UTC'
exec python3 "$root/bench/compare.py" "$bin" "$@"
