#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The hashes of tests/determinism/hashes.txt must come out of other builds than those of the presets:
#
#     tools/check_bits.sh gcc-O0        native, gcc -O0: plain loops, no registers kept
#     tools/check_bits.sh clang-O3      native, clang -O3
#     tools/check_bits.sh arm64         aarch64-linux-gnu-gcc, run by qemu-user
#     tools/check_bits.sh arm64 FILE    writes the hashes there instead
#
# Works in build/bits-<name>, compiles what is newer than its object only. arm64 takes libamd from
# Debian's package for that machine, unpacked into build/sysroot-arm64.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
name=$1
out=build/bits-$name
flags="-std=c11 -ffp-contract=off -Ilib -Iinclude -Itests"
libraries="-lamd -lsuitesparseconfig -lm"
run=

# Debian's libamd for arm64, without touching the machine's own list of packages.
sysroot() {
    root=$PWD/build/sysroot-arm64
    if [ ! -f "$root/usr/lib/aarch64-linux-gnu/libamd.a" ]; then
        mkdir -p "$root/state/lists/partial" "$root/cache/archives/partial" "$root/packages"
        touch "$root/state/status"
        options="-o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State=$root/state \
-o Dir::State::status=$root/state/status -o Dir::Cache=$root/cache -o APT::Sandbox::User=root"
        # shellcheck disable=SC2086
        apt-get -q $options update
        # shellcheck disable=SC2086
        (cd "$root/packages" && apt-get -q $options download libsuitesparse-dev)
        dpkg-deb -x "$root"/packages/libsuitesparse-dev_*_arm64.deb "$root"
    fi
    flags="$flags -I$root/usr/include/suitesparse"
    libraries="-L$root/usr/lib/aarch64-linux-gnu $libraries"
}

case $name in
gcc-O0) compile="gcc -O0" ;;
clang-O3) compile="clang -O3" ;;
arm64)
    compile="aarch64-linux-gnu-gcc -O2 -static"
    run=$(command -v qemu-aarch64-static || command -v qemu-aarch64)
    sysroot
    ;;
*)
    echo "check_bits.sh gcc-O0 | clang-O3 | arm64" >&2
    exit 2
    ;;
esac
[ "$name" = arm64 ] || flags="$flags -I/usr/include/suitesparse"

mkdir -p "$out"
sources="tests/determinism/test_hashes.c tests/support/models.c
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
rm -f "$out/libse3d.a"
ar rc "$out/libse3d.a" "$out"/lib_*.o
wraps=
for symbol in kkt_core_avx2 kkt_core_avx512 particle_kernels_avx2 particle_kernels_avx512; do
    wraps="$wraps -Wl,--wrap=se3di_$symbol"
done
# shellcheck disable=SC2086
$compile $wraps "$out"/tests_*.o "$out/libse3d.a" $libraries -o "$out/hashes"
# shellcheck disable=SC2086
$run "$out/hashes" ${2:-}
