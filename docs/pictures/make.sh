#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Make the pictures of the documents from results of the example models.
# Needs: apt-get install --no-install-recommends gnuplot-nox chromium ffmpeg npm
#
#     sh docs/pictures/make.sh [PROGRAM]      the se3d program, default build/release/bin/se3d
set -eu
cd "$(dirname "$0")/../.."
program=${1:-build/release/bin/se3d}
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

run() {
    model=$1
    shift
    "$program" run --quiet "$@" "examples/models/$model.yaml" -o "$results/$model"
}

# plot PICTURE MODEL OPTION...: what `se3d plot` draws.
plot() {
    picture=$1
    csv=$results/$2/$2.csv
    shift 2
    "$program" plot --quiet "$csv" "$@" -o "$results/$picture.svg"
    mv "$results/$picture.png" "docs/pictures/$picture.png"
}

# look PICTURE MODEL PART SPEED VIEW: a picture of its film, from 0 at the start to 1 at the end.
look() {
    "$program" video --quiet "$results/$2" -o "$results/$2.mp4" --speed "$4" --view "${5:--52,20}"
    count=$(ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=nb_read_frames "$results/$2.mp4" | tr -d ,)
    frame=$(awk -v n="$count" -v part="$3" 'BEGIN { print int(part * (n - 1)) }')
    ffmpeg -v error -y -i "$results/$2.mp4" -vf "select=eq(n\\,$frame),scale=640:-1" -frames:v 1 -q:v 5 "docs/pictures/$1.jpg"
}

run pendulum
run spatial_slider_crank --duration 2 --step 0.02
plot pendulum pendulum -y bar.position.y -y bar.position.z -y bar.velocity.y -y bar.velocity.z \
    -y bar.acceleration.y -y bar.acceleration.z -y drive.effort
plot slider_crank spatial_slider_crank -y slider.position.x -y slider.velocity.x -y motor.effort
look slider_crank_3d spatial_slider_crank 0.35 0.5
for name in suspension flyball_governor quarter_car pushed_grains; do
    run $name
done
plot suspension suspension -x travel.value -y rocker_pivot.angle -y coil.length -y travel.effort
look suspension suspension 0.3 0.5 62,22
"$program" run --quiet examples/fsae/car.yaml -o "$results/car"
look fsae car 0.5 8
look governor flyball_governor 0.5 10
look quarter_car quarter_car 0.25 1
look grains pushed_grains 0.8 0.1
