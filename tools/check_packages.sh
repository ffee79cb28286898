#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The packages of tools/packages.sh in a bare Debian: installed there, used by programs, looked at by lintian, removed.
#
#     sh tools/check_packages.sh ROOT      as root; ROOT is made by debootstrap if it is not there, and packages are
#                                          installed into it (network). Packages: build/deb/*.deb
set -eu
root=${1:?a folder for a bare Debian}
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
set -- build/deb/*.deb
[ -e "$1" ] || { echo 'no packages: sh tools/packages.sh' >&2; exit 2; }
[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase bookworm "$root"
work=$root/tmp/se3d-packages
rm -rf "$work"
mkdir -p "$work"
cp "$@" tests/install/consumer.c "$work"
cp tests/install/consumer_CMakeLists.txt "$work/CMakeLists.txt"
cp examples/models/pendulum.yaml "$work"
cp /etc/resolv.conf "$root/etc/resolv.conf"
cat >"$work/inside.sh" <<'END'
set -eu
cd "$(dirname "$0")"
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
apt="apt-get -o Dpkg::Options::=--path-include=/usr/share/man/* -qq -y --no-install-recommends"
step() { echo "== $1"; }

step 'what a user of packages has'
apt-get -qq update
$apt install gcc g++ libc6-dev make cmake pkg-config man-db bash-completion lintian >log 2>&1 || { cat log; exit 1; }

step 'install'
$apt install ./*.deb >log 2>&1 || { cat log; exit 1; }
ldconfig -p | grep -q 'libse3d-io\.so\.0'

consume() { # WHAT, then arguments of the compiler
    what=$1
    shift
    gcc -std=c11 -Wall -Wextra -Werror -DCONSUMER_IO consumer.c -o consumer "$@"
    ./consumer
    echo "$what: $(ldd consumer 2>/dev/null | grep -c libse3d || true) libraries of ours are loaded"
}
step 'pkg-config'
# shellcheck disable=SC2046
consume shared $(pkg-config --cflags --libs se3d-io)
step 'pkg-config --static'
mkdir hidden
mv /usr/lib/*/libse3d*.so hidden
places=$(dirname "$(find /usr/lib -name libse3d.a)")
consume static $(pkg-config --static --cflags --libs se3d-io)
! ldd consumer | grep -q libse3d
consume 'fully static' -static $(pkg-config --static --cflags --libs se3d-io)
! ldd consumer >/dev/null 2>&1
mv hidden/* "$places"
step 'CMake'
cp consumer.c consumer.cpp
cmake -S . -B made '-DCOMPONENTS=se3d;se3d_static;io;io_static' >log 2>&1 && cmake --build made >>log 2>&1 || { cat log; exit 1; }
(cd made && ctest --output-on-failure --no-tests=error >log 2>&1) || { cat made/log; exit 1; }

step 'Python'
/usr/bin/python3 - <<'PYTHON'
import se3d
with se3d.System() as system:
    bar = system.body(mass=1, inertia=(1, 1, 1), position=(0.5, 0, 0))
    pin = system.joint("revolute", system.ground, bar, at=(0, 0, 0), axis=(0, 1, 0))
    se3d.Solver(system).run(0.1)
    print(f"{se3d.__file__}: {pin.angle:.6f} rad")
PYTHON
step 'program'
se3d run -q pendulum.yaml -o results --duration 0.1
[ "$(wc -l <results/pendulum.csv)" = 12 ]
se3d fmu pendulum.yaml -o pendulum.fmu >log
step 'manual'
for page in '1 se3d' '5 se3d-model'; do
    # shellcheck disable=SC2086
    man --warnings -E UTF-8 $page 2>warnings >page
    [ ! -s warnings ] && [ "$(wc -l <page)" -gt 50 ] || { cat warnings; exit 1; }
done
step 'completion'
bash -ec '. /usr/share/bash-completion/bash_completion
. /usr/share/bash-completion/completions/se3d
call=$(complete -p se3d | sed "s/.* -F \([^ ]*\) .*/\1/")
COMP_WORDS=(se3d ru) COMP_CWORD=1 COMP_LINE="se3d ru" COMP_POINT=7
"$call" se3d ru se3d
[ "${COMPREPLY[*]%% *}" = run ]'
for file in /usr/share/zsh/vendor-completions/_se3d /usr/share/fish/vendor_completions.d/se3d.fish; do
    [ -s "$file" ]
done

step 'lintian'
lintian --allow-root --fail-on error,warning ./*.deb
step 'removal'
apt-get -qq -y purge "*se3d*" >log 2>&1 || { cat log; exit 1; }
left=$(find /usr /etc -name '*se3d*')
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo 'packages: 0 problems'
END
if [ ! -e "$root/proc/self" ]; then # the program finds what belongs to it by its own place
    mount -t proc proc "$root/proc"
    trap 'umount "$root/proc"' EXIT
fi
chroot "$root" sh /tmp/se3d-packages/inside.sh
