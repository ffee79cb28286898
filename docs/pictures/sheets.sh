#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Run every example and put what one sees of it on sheets, to be looked at: pages in both themes and on a telephone,
# plots, sketches. Fails if a picture is cut off, wider than the screen, or its page says an error.
# Needs: apt-get install --no-install-recommends gnuplot-nox chromium ffmpeg nodejs npm librsvg2-bin
#
#     sh docs/pictures/sheets.sh FOLDER [NAME...]   examples by name, default all; results that are there are kept.
#                                                   SE3D_PROGRAM: default build/release/bin/se3d
set -eu
cd "$(dirname "$0")/../.."
program=${SE3D_PROGRAM:-build/release/bin/se3d}
folder=$1
shift
mkdir -p "$folder/shots"
failed=
: >"$folder/jobs"
for model in examples/models/*.yaml examples/fsae/*.yaml; do
    name=$(basename "$model" .yaml)
    grep -q '^analys' "$model" || continue # a part of others, or one to evaluate
    case " $* " in
    '  ' | *" $name "*) ;;
    *) continue ;;
    esac
    if [ ! -f "$folder/$name/scene.glb" ]; then
        "$program" run --quiet "$model" -o "$folder/$name" || failed="$failed $name"
    fi
    [ -f "$folder/$name/scene.glb" ] || continue
    "$program" view --quiet "$folder/$name" -o "$folder/$name/scene.html" || failed="$failed $name"
    "$program" sketch --quiet "$model" -o "$folder/shots/$name-sketch.svg" || failed="$failed $name"
    ! command -v rsvg-convert >/dev/null || rsvg-convert -w 900 -b white "$folder/shots/$name-sketch.svg" -o "$folder/shots/$name-sketch.png"
    if [ -f "$folder/$name/$name.csv" ]; then
        "$program" plot --quiet "$folder/$name/$name.csv" -o "$folder/shots/$name-plot.svg" || failed="$failed $name"
    fi
    echo "$folder/$name/scene.html shots $folder/shots/$name --" >>"$folder/jobs"
done
# Some pages a browser.
xargs -n 24 node tests/viewer/page.js <"$folder/jobs" || failed="$failed pages"
for kind in light dark narrow plot sketch; do
    rm -f "$folder/$kind"-*.png
    set -- "$folder"/shots/*-"$kind".png
    [ -f "$1" ] || continue
    across=4 down=4 box=640:360
    case $kind in
    narrow) across=8 down=2 box=320:534 ;;
    plot | sketch) across=3 down=3 box=853:640 ;;
    esac
    rm -f "$folder"/boxed-*.png
    number=0
    for picture in "$@"; do # of one size: sketches and plots have their own
        number=$((number + 1))
        ffmpeg -v error -y -i "$picture" -frames:v 1 -vf "scale=$box:force_original_aspect_ratio=decrease,pad=$box:-1:-1:gray" \
            -pix_fmt rgb24 "$folder/boxed-$number.png" || failed="$failed $picture"
    done
    ffmpeg -v error -y -framerate 1 -start_number 1 -i "$folder/boxed-%d.png" -vf "tile=${across}x${down}:padding=4" \
        "$folder/$kind-%d.png" || failed="$failed $kind"
    rm -f "$folder"/boxed-*.png
done
ls "$folder"/*.png
[ -z "$failed" ] || { echo "failed:$failed" >&2; exit 1; }
