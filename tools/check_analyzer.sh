#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What `gcc -fanalyzer` finds: prints it and fails. It takes minutes, so that it is run before a release.
# Findings in tools/analyzer_reviewed.txt are passed over. Variables that are not set are left to
# check_uninitialised.sh, valgrind and MemorySanitizer: gcc 12 does not follow loops that fill arrays.
# Files: those given, or all of the libraries, the program and the recorder but the kernels at their
# instruction levels.
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046
    set -- $(find lib tools/se3d record -name '*.c' | grep -Ev '_(avx2|avx512|fma|portable)\.c$' | sort)
fi
flags="-std=c11 -D_POSIX_C_SOURCE=200809L -O1 -fopenmp -ffp-contract=off -Iinclude -Ilib -Itools/se3d -Irecord
-isystem /usr/include/suitesparse -fanalyzer -Wno-analyzer-too-complex -Wno-analyzer-use-of-uninitialized-value"
export LC_ALL=C.UTF-8 # quotes in messages
log=$(mktemp) || exit 1
found=$(mktemp) || exit 1
trap 'rm -f "$log" "$found"' EXIT
# shellcheck disable=SC2086
printf '%s\n' "$@" | xargs -P "$(nproc 2>/dev/null || echo 2)" -I FILE "${SE3D_GCC:-gcc}" $flags -c FILE -o /dev/null \
    2>"$log" || cat "$log"
grep -E 'warning: .*\[-Wanalyzer' "$log" | sort -u | while IFS= read -r line; do
    known=$(printf '%s\n' "$line" | sed -E 's/:[0-9]+:[0-9]+: warning: /: /; s/ \[CWE.*//')
    grep -qxF "$known" tools/analyzer_reviewed.txt || printf '%s\n' "$line"
done >"$found"
cat "$found"
problems=$(wc -l <"$found")
echo "analyzer: $# files, $problems problems"
[ "$problems" -eq 0 ]
