#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The hashes of tests/determinism/hashes.txt must come out of other builds than those of the presets:
#
#     tools/check_bits.sh NAME          builds for NAME in build/bits-NAME and compares
#     tools/check_bits.sh NAME FILE     writes the hashes there instead
#     tools/check_bits.sh all           every name, and a table of what came out
#
#     gcc-O0, gcc-O3, clang-O0, clang-O3   native
#     arm64, armhf, ppc64el, riscv64,      cross compilers of Debian, run by qemu-user; s390x stores
#     s390x, i386                          the highest byte first, armhf and i386 have addresses of 32 bits
#     windows                              mingw-w64, run by wine
#     wasm                                 emscripten, run by node
#
# Compiles what is newer than its object only. For other machines AMD is compiled from Debian's
# source package, unpacked into build/amd. docs/determinism.md
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
names="gcc-O0 gcc-O3 clang-O0 clang-O3 arm64 armhf ppc64el riscv64 s390x i386 windows wasm"
name=${1:-}

# Every name, one after the other; those whose tools are missing are said to be.
check_all() {
    mkdir -p build
    bad=0
    table=
    for each in $names; do
        if sh tools/check_bits.sh "$each" >"build/bits-$each.log" 2>&1; then
            result=$(sed -n 's/ checks, 0 failed/ hashes equal/p' "build/bits-$each.log")
        elif grep -q '^MISSING' "build/bits-$each.log"; then
            result=$(sed -n 's/^MISSING: /not checked: /p' "build/bits-$each.log")
        else
            result="FAILED: build/bits-$each.log"
            bad=1
        fi
        printf '%-9s %s\n' "$each" "$result"
    done
    exit $bad
}

# needs PROGRAM PACKAGE: ends with a word if it is not there
needs() {
    command -v "$1" >/dev/null 2>&1 || {
        echo "MISSING: $1 (package $2)" >&2
        exit 3
    }
}

# Debian's source of AMD
unpack_amd() {
    root=$PWD/build/amd
    sh tools/debian_source.sh suitesparse "$root" \
        '*/AMD/Source/*' '*/AMD/Include/*' '*/SuiteSparse_config/*.h'
    flags="$flags -I$root/AMD/Include -I$root/SuiteSparse_config"
    libraries=-lm
    amd="$root/AMD/Source/amd_2.c $root/AMD/Source/amd_defaults.c
$root/AMD/Source/amd_postorder.c $root/AMD/Source/amd_post_tree.c"
}

# cross TRIPLET EMULATOR PACKAGE [FLAG]
cross() {
    needs "$1-gcc" "gcc-$3"
    needs "qemu-$2-static" qemu-user-static
    echo '#include <stdint.h>' | "$1-gcc" -E - >/dev/null 2>&1 || {
        echo "MISSING: headers of libc for $1 (package libc6-dev-*-cross)" >&2
        exit 3
    }
    compile="$1-gcc -O2 -static ${4:-}"
    run=qemu-$2-static
    unpack_amd
}

out=build/bits-$name
flags="-std=c11 -ffp-contract=off -Ilib -Iinclude -Itests"
libraries="-lamd -lsuitesparseconfig -lm"
amd=
run=
program=$out/hashes
case $name in
gcc-O[0-3] | clang-O[0-3])
    needs "${name%-*}" "${name%-*}"
    compile="${name%-*} -${name#*-}"
    flags="$flags -I/usr/include/suitesparse"
    ;;
arm64) cross aarch64-linux-gnu aarch64 aarch64-linux-gnu ;;
armhf) cross arm-linux-gnueabihf arm arm-linux-gnueabihf -mfpu=vfpv4 ;;
ppc64el) cross powerpc64le-linux-gnu ppc64le powerpc64le-linux-gnu ;;
riscv64) cross riscv64-linux-gnu riscv64 riscv64-linux-gnu ;;
s390x) cross s390x-linux-gnu s390x s390x-linux-gnu ;;
i386) cross i686-linux-gnu i386 i686-linux-gnu "-msse2 -mfpmath=sse" ;;
windows)
    needs x86_64-w64-mingw32-gcc gcc-mingw-w64-x86-64
    needs wine wine64
    compile="x86_64-w64-mingw32-gcc -O2 -static -DSE3D_STATIC"
    run=wine
    program=$out/hashes.exe
    unpack_amd
    ;;
wasm)
    needs emcc emscripten
    needs node nodejs
    compile="emcc -O2"
    run="node --no-experimental-fetch" # this emscripten would fetch a path
    program=$out/hashes.js
    unpack_amd
    libraries="$libraries -O1 -sNODERAWFS=1 -sALLOW_MEMORY_GROWTH=1" # -O1: node-acorn is not needed
    ;;
all) check_all ;;
*)
    echo "check_bits.sh all | $(echo $names | sed 's/ / | /g') [FILE]" >&2
    exit 2
    ;;
esac

mkdir -p "$out"
sources="tests/determinism/test_hashes.c tests/support/models.c
$amd
$(find lib -path lib/io -prune -o -name '*.c' -print | sort)"
# shellcheck disable=SC2086
printf '%s\n' $sources >"$out/sources"
newest=$(find lib include tests/support tests/check.h -newer "$out/done" \( -name '*.h' -o -name '*.inc' \) 2>/dev/null |
    head -n 1)
if [ -n "$newest" ] || [ ! -f "$out/done" ]; then
    rm -f "$out"/*.o
fi
# shellcheck disable=SC2016
xargs -P "$(se3d_jobs)" -I@ sh -c '
    object='"$out"'/$(echo @ | tr / _).o
    [ "$object" -nt @ ] || '"${CMAKE_C_COMPILER_LAUNCHER:-} $compile $flags"' -c @ -o "$object"' <"$out/sources"
touch "$out/done"
wraps=$(find lib -name '*.c' -exec sed -n \
    's/^SE3DI_TARGET_FINDER([a-z0-9_]*, *\(se3di_[a-z0-9_]*\),.*/-Wl,--wrap=\1/p' {} +)
# shellcheck disable=SC2086
$compile $wraps "$out"/*.o $libraries -o "$program"
# shellcheck disable=SC2086
$run "$program" ${2:-}
