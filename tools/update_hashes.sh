#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Write tests/determinism/hashes.txt anew, from the program of a build folder (build/dev where none
# is named). For commits that change results on purpose: they say which and why.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
build=${1:-build/dev}
cmake --build "$build" --target test_determinism_hashes
"$build/tests/test_determinism_hashes" tests/determinism/hashes.txt
git diff --stat -- tests/determinism/hashes.txt
