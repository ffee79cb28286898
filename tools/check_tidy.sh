#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What clang-tidy finds (.clang-tidy): prints it and fails. It takes some minutes, so that it is run
# before a release. Files: those given, or all of the libraries and the program but the kernels at
# their instruction levels.
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
[ -f build/dev/compile_commands.json ] || cmake --preset dev >/dev/null || exit 1
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046
    set -- $(find lib tools/se3d -name '*.c' | grep -Ev '_(avx2|avx512|fma|portable)\.c$' | sort)
fi
tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || {
    echo 'clang-tidy is missing: apt-get install --no-install-recommends clang-tidy-14' >&2
    exit 1
}
printf '%s\n' "$@" | xargs -P "$(nproc 2>/dev/null || echo 2)" -I FILE "$tidy" --quiet -p build/dev FILE 2>/dev/null |
    grep -E 'warning:|error:' && exit 1
echo "tidy: $# files, 0 problems"
