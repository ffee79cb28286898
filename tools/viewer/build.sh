#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Make three.js for the viewer in a folder (a cache of the user, or of a build): three.js with its
# controls and uPlot, from npm, packed, with their licences at its head. Does nothing where it is there.
#
#     sh build.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
mkdir -p -- "$folder"
stamp="three 0.187 uplot 1.6.32 $(cksum <"$here/three_entry.js")"
[ ! -f "$folder/three.js" ] || [ "$(cat "$folder/three.stamp" 2>/dev/null)" != "$stamp" ] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -n "${SE3D_THREE:-}" ]; then # one that this script made elsewhere
    grep -qF -e "/* $stamp" -- "$SE3D_THREE" || {
        echo "SE3D_THREE: $SE3D_THREE was not made by tools/viewer/build.sh of this version" >&2
        exit 1
    }
    cp -- "$SE3D_THREE" "$work/three.js"
elif command -v npm >/dev/null 2>&1; then
    echo "making the viewer's three.js once (npm: three 0.187, uplot 1.6.32, esbuild)" >&2
    cp "$here/three_entry.js" "$work/"
    (cd "$work" && npm install --fetch-retries=1 --silent --no-audit --no-fund --no-save three@0.187 uplot@1.6.32 esbuild >&2 &&
        npx --no-install esbuild three_entry.js --bundle --minify --format=iife --global-name=THREE --loader:.css=text \
            --legal-comments=none --log-level=error --outfile=bundle.js)
    {
        printf '/* %s\nthree.js:\n' "$stamp"
        cat "$work/node_modules/three/LICENSE"
        printf '\nuPlot:\n'
        cat "$work/node_modules/uplot/LICENSE"
        echo '*/'
        # A quarter as long as it is; browsers unpack it themselves.
        printf 'window.se3dReady = new Response(new Blob([Uint8Array.from(atob("'
        gzip -9n <"$work/bundle.js" | base64 | tr -d '\n'
        printf '"), (c) => c.charCodeAt(0))]).stream().pipeThrough(new DecompressionStream("gzip"))).text().then((code) => {\n'
        printf '  const script = document.createElement("script");\n  script.textContent = code;\n  document.head.append(script);\n});\n'
    } >"$work/three.js"
else
    echo 'npm is missing; on Debian and Ubuntu: apt-get install npm' >&2
    exit 1
fi
mv -- "$work/three.js" "$folder/three.js"
echo "$stamp" >"$folder/three.stamp"
