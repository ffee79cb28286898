#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Tests under MemorySanitizer: reads of memory that was never written, anywhere in the libraries.
#
#     tools/check_msan.sh [CTEST ARGUMENTS...]     build, and run the tests of the preset `msan`
#
# Whatever writes memory must be built for it. So AMD, libyaml and expat are built from Debian's
# sources (apt-get source, with a list of its own: neither root nor a change of the system is needed),
# into build/msan/deps. Only the portable kernels are built, as clang does not know what some
# instructions of AVX-512 leave unset. SE3D_DEBIAN_MIRROR: another mirror of Debian; its release is
# SE3D_DEBIAN_RELEASE (bookworm).
set -u
cd "$(dirname "$0")/.." || exit 1
. tools/setup.sh
se3d_help "$@"
deps=$(pwd)/build/msan/deps
jobs=$(se3d_jobs)

fetch() {
    mkdir -p "$deps/lists/partial" "$deps/cache"
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg]" \
        "${SE3D_DEBIAN_MIRROR:-http://deb.debian.org/debian} ${SE3D_DEBIAN_RELEASE:-bookworm} main" \
        >"$deps/sources.list"
    options="-q -o Dir::Etc::sourcelist=$deps/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$deps/lists
        -o Dir::Cache=$deps/cache"
    # shellcheck disable=SC2086
    (cd "$deps" && apt-get $options update && apt-get $options source suitesparse libyaml expat)
}

# library NAME FLAGS SOURCE...: lib<name>.a of sources in $deps
library() {
    name=$1
    flags=$2
    shift 2
    mkdir -p "$deps/$name" "$deps/lib"
    # shellcheck disable=SC2086
    (cd "$deps/$name" && printf '%s\n' "$@" |
        xargs -P "$jobs" -n 1 clang -O1 -g1 -w -fPIC -fno-omit-frame-pointer -fsanitize=memory $flags -c) &&
        rm -f "$deps/lib/lib$name.a" && ar rcs "$deps/lib/lib$name.a" "$deps/$name"/*.o
}

libraries() {
    suite=$(echo "$deps"/suitesparse-*/SuiteSparse_config)
    amd=$(echo "$deps"/suitesparse-*/AMD)
    yaml=$(echo "$deps"/libyaml-*)
    expat=$(echo "$deps"/expat-*/expat/lib)
    include=$deps/include
    version='-DYAML_VERSION_MAJOR=0 -DYAML_VERSION_MINOR=2 -DYAML_VERSION_PATCH=5 -DYAML_VERSION_STRING="0.2.5"'
    mkdir -p "$include" &&
        cp "$suite/SuiteSparse_config.h" "$amd/Include/amd.h" "$yaml/include/yaml.h" "$expat"/expat*.h "$include" &&
        library suitesparseconfig "-DNTIMER" "$suite/SuiteSparse_config.c" &&
        library amd "-DDINT -I$include -I$amd/Include" "$amd"/Source/*.c &&
        library yaml "$version -I$include" "$yaml"/src/*.c &&
        library expat "-DXML_NS -DXML_DTD -DXML_CONTEXT_BYTES=1024 -DHAVE_GETRANDOM -DBYTEORDER=1234" \
            "$expat/xmlparse.c" "$expat/xmlrole.c" "$expat/xmltok.c" &&
        touch "$deps/built"
}

command -v clang >/dev/null 2>&1 || {
    echo "check_msan.sh: clang is missing (Debian: clang libclang-rt-14-dev)" >&2
    exit 3
}
[ -e "$deps/built" ] || { mkdir -p "$deps" && { fetch && libraries; } >"$deps/log" 2>&1; } || {
    tail -n 20 "$deps/log" >&2
    exit 1
}
set -- -j "$jobs" "$@"
for name in amd suitesparseconfig yaml expat; do
    settings="${settings:-} -DSE3D_${name}_LIBRARY=$deps/lib/lib$name.a -DSE3D_${name}_INCLUDE=$deps/include"
done
# shellcheck disable=SC2086
cmake --preset msan $settings -DSE3D_ZLIB=OFF && cmake --build --preset msan -j "$jobs" && ctest --preset msan "$@"
