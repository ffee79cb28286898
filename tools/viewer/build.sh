#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Make three.js for the viewer in a folder (a cache of the user, or of a build): three.js, with its
# licence at its head. From npm, or from Debian's libjs-three. Does nothing where it is there.
#
#     sh build.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
mkdir -p -- "$folder"
stamp="three 0.187 $(cksum <"$here/three_entry.js")"
[ ! -f "$folder/three.js" ] || [ "$(cat "$folder/three.stamp" 2>/dev/null)" != "$stamp" ] || exit 0
debian=${SE3D_THREE:-/usr/share/javascript/three/three.min.js} # an older three.js will do
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "${SE3D_THREE:-}" ] && command -v npm >/dev/null 2>&1; then
    echo "making the viewer's three.js once (npm: three 0.187, esbuild)" >&2
    cp "$here/three_entry.js" "$work/"
    (cd "$work" && npm install --fetch-retries=1 --silent --no-audit --no-fund --no-save three@0.187 esbuild >&2 &&
        npx --no-install esbuild three_entry.js --bundle --minify --format=iife --global-name=THREE \
            --legal-comments=none --log-level=error --outfile=bundle.js)
    { echo '/*'; cat "$work/node_modules/three/LICENSE"; echo '*/'; cat "$work/bundle.js"; } >"$work/three.js"
elif [ -f "$debian" ]; then
    {
        echo '/* three.js, MIT licence, from libjs-three:'
        sed 's,\*/,* /,g' "${debian%/javascript/*}/doc/libjs-three/copyright" 2>/dev/null || true
        echo '*/'
        cat "$debian"
    } >"$work/three.js"
else
    echo 'three.js is missing; on Debian and Ubuntu: apt-get install npm (or libjs-three)' >&2
    exit 1
fi
mv -- "$work/three.js" "$folder/three.js"
echo "$stamp" >"$folder/three.stamp"
