#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The Debian package and the wheel of the Python package, for the libraries of a build folder, beside these.
#
#     sh tools/python_package.sh [BUILD]       default: build/deb, as tools/packages.sh makes it
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
build=$(cd "${1:-build/deb}" && pwd)
# shellcheck disable=SC2086
se3d_install $SE3D_PYTHON_PACKAGES python3-pip python3-setuptools python3-wheel dpkg-dev binutils
umask 022
python=/usr/bin/python3
part() { sed -n "s/^#define SE3D_VERSION_$1 \([0-9]*\).*/\1/p" include/se3d/base.h; }
version=$(part MAJOR).$(part MINOR).$(part PATCH)
work=$build/python
rm -rf "$work"
mkdir -p "$work/source" "$work/wheel"
cp -r python/. "$work/source"
find "$work/source" \( -name '_se3d.*' ! -name '_se3d.pyi' -o -name __pycache__ \) -prune -exec rm -rf {} +

# The wheel finds the installed library: no path of this machine stays in it.
export SE3D_INCLUDE="$PWD/include" SE3D_LIBRARIES="$build/lib" SE3D_RUNPATH=
"$python" -m pip wheel -q --no-deps --no-build-isolation --no-index -w "$work/wheel" "$work/source"
wheel=$(ls "$work"/wheel/*.whl)

root=$work/root
package=python3-se3d
modules=$root/usr/lib/python3/dist-packages
mkdir -p "$modules" "$root/usr/share/doc/$package" "$root/DEBIAN"
"$python" -m zipfile -e "$wheel" "$modules"
rm -f "$modules"/*.dist-info/RECORD
strip --strip-unneeded "$modules"/se3d/_se3d.*.so
cp LICENSE "$root/usr/share/doc/$package/copyright"
gzip -9 -n -c >"$root/usr/share/doc/$package/changelog.gz" <<EOF
se3d ($version) unstable; urgency=medium

  * See the file CHANGELOG.md of se3d-doc.

 -- libse3d maintainers <maintainers@libse3d.invalid>  $(date -R -u)
EOF
here=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
cat >"$root/DEBIAN/control" <<EOF
Package: $package
Source: se3d
Version: $version
Architecture: $(dpkg --print-architecture)
Maintainer: libse3d maintainers <maintainers@libse3d.invalid>
Installed-Size: $(du -ks "$root/usr" | cut -f1)
Depends: libc6 (>= 2.34), libse3d$(part MAJOR) (= $version), python3 (>= $here), python3-cffi-backend,
 python3-numpy
Section: python
Priority: optional
Description: constrained rigid multibody dynamics (Python 3)
 libse3d computes the motion of constrained rigid bodies in three dimensions:
 kinematics, inverse dynamics, dynamics, equilibria and vibration modes of
 mechanisms, with contact and friction up to granular flows.
 .
 This package has the module se3d for Python 3, with type stubs.
EOF
sed -i ':a; /,$/{N; s/,\n /, /; ta}' "$root/DEBIAN/control"
find "$root" -type f ! -name '*.so' -exec chmod 644 {} +
cat >"$root/DEBIAN/postinst" <<'EOF'
#!/bin/sh
set -e
if [ "$1" = configure ] && command -v py3compile >/dev/null; then
    py3compile -p python3-se3d
fi
EOF
cat >"$root/DEBIAN/prerm" <<'EOF'
#!/bin/sh
set -e
if command -v py3clean >/dev/null; then
    py3clean -p python3-se3d
fi
EOF
chmod 755 "$root/DEBIAN/postinst" "$root/DEBIAN/prerm"
(cd "$root" && find usr -type f -exec md5sum {} + >DEBIAN/md5sums)
dpkg-deb --root-owner-group -b "$root" "$build" >/dev/null
cp "$wheel" "$build"
ls "$build/${package}_$version"_*.deb "$build"/*.whl
