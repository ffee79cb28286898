#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# test_install.sh tree | pkg_config | find_package (tests/install/CMakeLists.txt sets the environment)
set -eu
work=$SE3D_BUILD_DIR/tests/install/work
prefix=$work/moved
here=$SE3D_SOURCE_DIR/tests/install

fail() {
    echo "$*" >&2
    exit 1
}

# Install to one folder and move it to another: nothing in the tree may depend on where it lies.
tree() {
    rm -rf "$work"
    mkdir -p "$work"
    "$CMAKE" --install "$SE3D_BUILD_DIR" --prefix "$work/installed" >/dev/null
    mv "$work/installed" "$prefix"
    for header in "$SE3D_SOURCE_DIR"/include/se3d/*.h; do
        [ -f "$prefix/include/se3d/${header##*/}" ] || fail "not installed: ${header##*/}"
    done
    for document in LICENSE README.md CHANGELOG.md docs/api.md docs/model-file/reference.md examples/models/fourbar.yaml; do
        [ -f "$prefix/share/doc/se3d/$document" ] || fail "not installed: $document"
    done
    if grep -rl "$SE3D_SOURCE_DIR" "$prefix" --include=*.cmake --include=*.pc; then
        fail "installed files name the source folder"
    fi
    if [ -n "${SE3D_PROGRAM:-}" ]; then
        [ -x "$prefix/bin/se3d" ] || fail "the program is not installed"
        manual
        view
    fi
}

# What the program says of itself is installed with it.
manual() {
    [ -f "$prefix/share/se3d/se3d.schema.json" ] || fail "the schema is not installed"
    "$prefix/bin/se3d" help --man | cmp - "$prefix/share/man/man1/se3d.1" || fail "se3d(1) is another text"
    "$prefix/bin/se3d" explain --man | cmp - "$prefix/share/man/man5/se3d-model.5" || fail "se3d-model(5) is another text"
    for completion in bash-completion/completions/se3d zsh/vendor-completions/_se3d fish/vendor_completions.d/se3d.fish; do
        [ -s "$prefix/share/$completion" ] || fail "not installed: $completion"
    done
}

# An installed program finds the parts of its page, and needs nothing else where three.js lies beside them.
view() {
    for part in viewer.js viewer.html viewer.css build.sh; do
        [ -f "$prefix/share/se3d/viewer/$part" ] || fail "not installed: $part of the viewer"
    done
    if [ ! -f "$prefix/share/se3d/viewer/three.js" ]; then
        echo 'SKIPPED: no npm: the viewer has no three.js' >&2
        return
    fi
    "$prefix/bin/se3d" run -q "$SE3D_SOURCE_DIR/examples/models/pendulum.yaml" -o "$work/pendulum"
    (unset SE3D_VIEWER; PATH=/none SE3D_CACHE=/none "$prefix/bin/se3d" view -q "$work/pendulum")
    grep -q 'Permission is hereby granted\|MIT licen' "$work/pendulum/scene.html" || fail "a page without the licence of three.js"
}

library_folder() {
    pc=$(find "$prefix" -name se3d.pc)
    [ -n "$pc" ] || fail "se3d.pc is not installed"
    dirname "$(dirname "$pc")"
}

# build_and_run NAME STATIC-OPTION: consumer.c as C and as C++ by the flags of pkg-config and $link.
build_and_run() {
    define=
    [ "$1" = se3d ] || define=-DCONSUMER_IO
    flags=$("$PKG_CONFIG" --cflags --libs $2 "$1")
    strict="-Wall -Wextra -Wpedantic -Werror"
    # shellcheck disable=SC2086
    "$CC" -std=c11 $strict $define "$here/consumer.c" -o "$work/consumer_c" ${link:-} $flags
    "$work/consumer_c"
    # shellcheck disable=SC2086
    "$CXX" -std=c++11 $strict $define -x c++ "$here/consumer.c" -x none -o "$work/consumer_cpp" ${link:-} $flags
    "$work/consumer_cpp"
}

# The example of the README, by its command.
readme_command() {
    command=$(sed -n "s|^\(cc -std=c11 main.c .* -o main\).*|\1|p" "$SE3D_SOURCE_DIR/README.md" |
        sed "s|^cc|$CC|; s|pkg-config|$PKG_CONFIG|")
    [ -n "$command" ] || fail "the README has no command for cc"
    rm -rf "$work/readme"
    mkdir -p "$work/readme"
    cp "$SE3D_SOURCE_DIR/examples/pendulum.c" "$work/readme/main.c"
    cd "$work/readme"
    eval "$command" || fail "the README's command does not work: $command"
    LD_LIBRARY_PATH=$libraries ./main >main.txt || fail "the README's example fails"
}

# Every compiler's runtime of OpenMP is there as a shared library, not every one as an archive.
has_static_libraries() {
    echo 'int main(void) { return 0; }' >"$work/empty.c"
    openmp=$("$PKG_CONFIG" --static --libs "$1" | tr ' ' '\n' | grep -E '^-l(g|i)?omp' || true)
    # shellcheck disable=SC2086
    "$CC" -static "$work/empty.c" -o "$work/empty" $openmp 2>"$work/empty.log" && return
    echo "SKIPPED: a program without shared libraries: $(head -n 1 "$work/empty.log")"
    return 1
}

pkg_config() {
    libraries=$(library_folder)
    export PKG_CONFIG_PATH="$libraries/pkgconfig"
    names=se3d
    [ ! -f "$libraries/pkgconfig/se3d-io.pc" ] || names="se3d se3d-io"
    for name in $names; do
        LD_LIBRARY_PATH=$libraries build_and_run "$name" ""
    done
    (readme_command)
    # Static: the same tree without the shared libraries, so that -lse3d can only be the archive.
    rm -rf "$work/static"
    cp -r "$prefix" "$work/static"
    find "$work/static" -name 'libse3d*.so*' -exec rm {} +
    prefix=$work/static
    PKG_CONFIG_PATH="$(library_folder)/pkgconfig"
    for name in $names; do
        build_and_run "$name" --static
        if ldd "$work/consumer_c" | grep libse3d; then
            fail "$name: the static consumer needs a shared libse3d"
        fi
        if has_static_libraries "$name"; then
            link=-static build_and_run "$name" --static # no shared library at all
        fi
    done
}

find_package() {
    components="se3d;se3d_static"
    [ ! -f "$(library_folder)/pkgconfig/se3d-io.pc" ] || components="$components;io;io_static"
    rm -rf "$work/project"
    mkdir -p "$work/project"
    cp "$here/consumer.c" "$work/project/consumer.c"
    cp "$here/consumer.c" "$work/project/consumer.cpp"
    cp "$here/consumer_CMakeLists.txt" "$work/project/CMakeLists.txt"
    "$CMAKE" -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$prefix" \
        -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" "-DCOMPONENTS=$components" \
        >"$work/project/log" 2>&1 || { cat "$work/project/log"; exit 1; }
    "$CMAKE" --build "$work/project/build" >"$work/project/log" 2>&1 ||
        { cat "$work/project/log"; exit 1; }
    "$CMAKE" -E chdir "$work/project/build" ctest --output-on-failure --no-tests=error
    if grep -q '^Libs.private:.* -lz ' "$(library_folder)/pkgconfig/se3d-io.pc" 2>/dev/null; then
        without_zlib 'se3d;se3d_static;io' || { cat "$work/project/log"; fail "se3d_static needs zlib"; }
        grep -q 'No zlib: se3d::io_static needs it' "$work/project/log" || fail "it is not told what needs zlib"
        ! without_zlib io_static || fail "se3d::io_static is there without zlib"
    fi
}

# without_zlib COMPONENTS: whether a machine without zlib has them.
without_zlib() {
    "$CMAKE" -S "$work/project" -B "$work/project/without" -DCMAKE_PREFIX_PATH="$prefix" -DSE3D_zlib_LIBRARY= \
        -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" "-DCOMPONENTS=$1" >"$work/project/log" 2>&1
}

# The sources as a part of another project: only the libraries are built, and none of our options or settings leaks.
# Objects that this build has made by the same words are taken from it (take_object.sh).
add_subdirectory() {
    rm -rf "$work/embedded"
    mkdir -p "$work/embedded"
    cp "$here/consumer.c" "$work/embedded/consumer.c"
    cp "$here/embedded_CMakeLists.txt" "$work/embedded/CMakeLists.txt"
    export SE3D_TAKEN="$work/embedded/taken"
    "$CMAKE" -S "$work/embedded" -B "$work/embedded/build" -DCMAKE_C_COMPILER="$CC" \
        "-DCMAKE_C_COMPILER_LAUNCHER=sh;$here/take_object.sh" \
        -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG=-O0 "-DSE3D_SOURCE_DIR=$SE3D_SOURCE_DIR" \
        >"$work/embedded/log" 2>&1 || { cat "$work/embedded/log"; exit 1; }
    "$CMAKE" --build "$work/embedded/build" --parallel 2 >"$work/embedded/log" 2>&1 || { cat "$work/embedded/log"; exit 1; }
    echo "$(grep -c '^taken ' "$SE3D_TAKEN") objects were taken, $(grep -c '^compiled ' "$SE3D_TAKEN") compiled"
    "$CMAKE" -E chdir "$work/embedded/build" ctest --output-on-failure --no-tests=error
    "$CMAKE" --install "$work/embedded/build" --prefix "$work/embedded/installed" >"$work/embedded/log"
    if find "$work/embedded/installed" -name '*se3d*' 2>/dev/null | grep .; then
        fail "the project installs libse3d"
    fi
}

"$1"
