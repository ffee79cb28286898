#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Fetch the source of a Debian package, without touching the machine's own list of packages:
#
#     debian_source.sh PACKAGE FOLDER [PATTERN...]    unpacks its files, or those of the patterns
#
# Does nothing if FOLDER/done is there.
set -eu
. "$(dirname "$0")/setup.sh"
se3d_help "$@"
package=$1
mkdir -p "$2"
root=$(cd "$2" && pwd)
shift 2
[ ! -f "$root/done" ] || exit 0
mkdir -p "$root/parts" "$root/state/lists/partial" "$root/cache/archives/partial"
touch "$root/state/status"
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
    [ ! -f "$list" ] || sed -E 's/^Types: deb$/Types: deb-src/; s/^deb /deb-src /' \
        "$list" >"$root/parts/$(basename "$list")"
done
options="-o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$root/parts \
-o Dir::State=$root/state -o Dir::Cache=$root/cache -o APT::Sandbox::User=root"
# shellcheck disable=SC2086
apt-get -q $options update
# shellcheck disable=SC2086
(cd "$root" && apt-get -q $options source --download-only --tar-only "$package")
tar -xf "$root"/"$package"_*.orig.tar.* -C "$root" --strip-components=1 --wildcards "$@"
touch "$root/done"
