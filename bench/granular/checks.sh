#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# usage: sh bench/granular/checks.sh [static] [avalanche] [hopper] [drum] [million]    (none: all)
# Long checks of granular beds, whose figures README.md records: about half an hour of one core.
set -eu
here=$(dirname "$0")
source=$here/../..
. "$source/tools/setup.sh"
# shellcheck disable=SC2086
se3d_install $SE3D_BUILD_PACKAGES
cmake -S "$source" -B "$source/build/bench" -DCMAKE_BUILD_TYPE=Release -DSE3D_BUILD_BENCH=ON \
    -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF >/dev/null
cmake --build "$source/build/bench" --target bench_bench_granular bench_bench_granular_checks -j2 >/dev/null
bench=$source/build/bench/bench/bench_granular
check=$source/build/bench/bench/bench_granular_checks
for what in ${*:-static avalanche hopper drum million}; do
    case $what in
    static)
        "$check" static edge=12 rolling=0.02 settle=200000
        "$check" static edge=20
        ;;
    avalanche)
        "$check" avalanche
        "$check" avalanche law=hertz rolling=0.05 steps=300000
        ;;
    hopper)
        for opening in 5 6 8 10; do
            "$check" hopper opening=$opening d=0.006
        done
        "$check" hopper opening=6 d=0.003
        "$check" hopper opening=6 d=0.012
        "$check" hopper opening=6 d=0.006 friction=0.3
        "$check" hopper opening=6 d=0.006 rolling=0.1
        ;;
    drum)
        for rate in 0.5 1 2 4 6; do
            "$check" drum edge=12 rate=$rate
        done
        "$check" drum edge=12 rate=2 rolling=0.1
        "$check" drum edge=12 rate=2 friction=0.2
        ;;
    million)
        state=$(mktemp -u)
        "$bench" edge=20 state="$state" steps=1
        "$bench" edge=100 tiles=5 state="$state" settle=4000 steps=60 repeats=3
        "$bench" edge=100 tiles=5 state="$state" settle=4000 steps=60 repeats=3 threads=2
        rm -f "$state"
        ;;
    *)
        echo "what is $what?" >&2
        exit 2
        ;;
    esac
done
