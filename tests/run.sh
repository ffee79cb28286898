#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Build everything and run all tests, from a clean clone on a bare Debian 12. Missing packages are
# installed. Extra arguments go to ctest, e.g. `sh tests/run.sh -R unit`; SE3D_CONFIGURE has arguments
# for CMake, e.g. -DSE3D_WERROR=ON.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
# shellcheck disable=SC2086
se3d_install $SE3D_TEST_PACKAGES
jobs=$(se3d_jobs)
# shellcheck disable=SC2086
cmake --preset dev ${SE3D_CONFIGURE:-}
cmake --build --preset dev -j "$jobs"
exec ctest --preset dev -j "$jobs" "$@"
