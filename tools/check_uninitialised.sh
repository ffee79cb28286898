#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Variables that are read before they are set: the compiler sees them where it follows every call of
# a file, so functions are inlined without limit. Prints what it finds and fails. Files: those given,
# or all of the libraries and the program but the kernels at their instruction levels. With
# CMAKE_C_COMPILER_LAUNCHER=ccache what has not changed is not looked at again.
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
limit=4000 # beyond it a parser that calls itself takes hours
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046
    set -- $(find lib tools/se3d -name '*.c' | grep -Ev '_(avx2|avx512|fma|portable)\.c$' | sort)
fi
flags="-std=c11 -D_POSIX_C_SOURCE=200809L -O2 -fopenmp -ffp-contract=off -Iinclude -Ilib -Itools/se3d
-isystem /usr/include/suitesparse
-finline-functions -Werror=uninitialized -Werror=maybe-uninitialized"
for parameter in max-inline-insns-auto max-inline-insns-single large-function-growth large-function-insns \
    large-stack-frame-growth inline-unit-growth; do
    flags="$flags --param=$parameter=$limit"
done
jobs=$(nproc 2>/dev/null || echo 2)
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
export flags out
# shellcheck disable=SC2016
printf '%s\n' "$@" | xargs -P "$jobs" -I FILE sh -c \
    '${CMAKE_C_COMPILER_LAUNCHER:-} "${SE3D_GCC:-gcc}" $flags -c "$1" -o "$out/$(echo "$1" | tr / _).o"' sh FILE || exit 1
echo "uninitialised: $# files, 0 problems"
