# SPDX-License-Identifier: BSD-3-Clause
# Sourced by tests/run.sh, examples/run.sh and .ci/run: installs what is missing.
#
#     se3d_install PACKAGE...      on Debian and Ubuntu, as root or with sudo; does nothing where all
#                                  is there, and only says what is needed on other systems; fails
#                                  if one could not be had, after installing the others
#     se3d_make_locales            locales that tests try, once the package `locales` is there
#     se3d_jobs                    prints the number of processors
#     se3d_help "$@"               with --help first: prints the head of the script and ends

SE3D_BUILD_PACKAGES="gcc libc6-dev make cmake pkg-config libsuitesparse-dev libyaml-dev libexpat1-dev \
zlib1g-dev libmicrohttpd-dev libnlopt-dev"
SE3D_TEST_PACKAGES="$SE3D_BUILD_PACKAGES g++ binutils python3"
SE3D_PYTHON_PACKAGES="python3-cffi python3-numpy python3-dev mypy"
SE3D_PICTURE_PACKAGES="gnuplot-nox chromium ffmpeg nodejs npm python3-vtk9 python3-h5py"
SE3D_CI_PACKAGES="$SE3D_TEST_PACKAGES ninja-build strace abigail-tools clang clang-format-14 valgrind libmpfr-dev libopenmpi-dev \
openmpi-bin mkdocs doxygen gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user-static locales $SE3D_PYTHON_PACKAGES \
ruby $SE3D_PICTURE_PACKAGES"

se3d_help() {
    case ${1:-} in
    -h | --help)
        script=tools/$(basename "$0")
        [ -f "$script" ] || script=$0
        sed -n '1,2d; /^#/!q; s/^# \{0,1\}//p' "$script"
        exit 0
        ;;
    esac
}

se3d_jobs() {
    nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2
}

# A package is there if dpkg says so, or if its program is: Node.js from elsewhere brings npm along and
# conflicts with Debian's.
se3d_has() {
    case $1 in
    nodejs) command -v node >/dev/null 2>&1 && return ;;
    npm | chromium | ffmpeg) command -v "$1" >/dev/null 2>&1 && return ;;
    esac
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

se3d_missing() {
    for se3d_package in "$@"; do
        se3d_has "$se3d_package" || printf '%s ' "$se3d_package"
    done
}

se3d_as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null 2>&1; then
        sudo "$@"
    else
        echo "se3d: not root and no sudo; as root, run: $*" >&2
        return 1
    fi
}

se3d_apt() {
    se3d_as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

# Locales with a decimal comma and with one of two bytes, which tests try.
se3d_make_locales() {
    for se3d_locale in de_DE ps_AF; do
        locale -a 2>/dev/null | grep -qi "^$se3d_locale.utf" ||
            se3d_as_root localedef -i "$se3d_locale" -f UTF-8 "$se3d_locale.UTF-8" || return
    done
}

se3d_install() {
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "se3d: no apt-get here; the Debian names of what is needed: $*" >&2
        return 0
    fi
    se3d_needed=$(se3d_missing "$@")
    [ -n "$se3d_needed" ] || return 0
    echo "se3d: installing $se3d_needed"
    se3d_as_root apt-get update -q || return 1
    # shellcheck disable=SC2086
    se3d_apt $se3d_needed && return
    # apt installs all or none: one that cannot be had must not keep the others away
    se3d_result=0
    for se3d_package in $se3d_needed; do
        se3d_apt "$se3d_package" || {
            echo "se3d: $se3d_package could not be installed" >&2
            se3d_result=1
        }
    done
    return $se3d_result
}
