#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Debian packages of libse3d into build/deb, looked at by lintian where it is installed; tools/check_packages.sh tries
# them in a bare Debian. se3d-mpi is none of them: clusters have an MPI of their own, for which it is built.
#
#     sh tools/packages.sh
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
se3d_help "$@"
se3d_install $SE3D_BUILD_PACKAGES dpkg-dev
umask 022
cmake -S . -B build/deb -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DSE3D_DEBIAN=ON \
    -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF -DSE3D_MPI=OFF \
    "-DCMAKE_SHARED_LINKER_FLAGS=-Wl,-z,relro,-z,now" "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-z,relro,-z,now"
cmake --build build/deb -j "$(se3d_jobs)"
rm -f build/deb/*.deb
(cd build/deb && cpack -G DEB)
sh tools/python_package.sh
if command -v lintian >/dev/null 2>&1; then
    lintian --fail-on error,warning build/deb/*.deb
else
    echo 'lintian is not installed: the packages are not looked at'
fi
