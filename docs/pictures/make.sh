#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Make the pictures of the documents from results of the example models.
# Needs: apt-get install --no-install-recommends gnuplot-nox chromium ffmpeg nodejs npm
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

# look PICTURE MODEL PART [MORE]: what its page shows, from 0 at the start to 1 at the end; MORE of its address.
look() {
    "$program" view --quiet "$results/$2"
    node tests/viewer/page.js "$results/$2/scene.html#bare&part=$3${4:+&$4}" still "$results/$1.png" >/dev/null
    ffmpeg -v error -y -i "$results/$1.png" -vf scale=960:-1:flags=lanczos -frames:v 1 -q:v 3 "docs/pictures/$1.jpg"
}

"$program" sketch --quiet examples/models/suspension.yaml -o docs/pictures/suspension_sketch.svg
"$program" sketch --quiet examples/models/fourbar_kinematics.yaml -o docs/pictures/fourbar_sketch.svg

run pendulum
run spatial_slider_crank --duration 2 --step 0.02
plot pendulum pendulum -y bar.position.y -y bar.position.z -y bar.velocity.y -y bar.velocity.z \
    -y bar.acceleration.y -y bar.acceleration.z -y drive.effort
plot slider_crank spatial_slider_crank -y slider.position.x -y slider.velocity.x -y motor.effort
look slider_crank_3d spatial_slider_crank 0.35
for name in suspension flyball_governor quarter_car pushed_grains hopper landing_gear geared_arm gear_train rotating_drum; do
    run $name
done
plot suspension suspension -x travel.value -y rocker_pivot.angle -y coil.length -y travel.effort
look suspension suspension 0.3
"$program" run --quiet examples/fsae/car.yaml -o "$results/car"
look fsae car 0.5 show=solid
# For the first screen of the README: it moves.
"$program" run --quiet examples/fsae/four_post.yaml --set amplitude=15 --set roll=1 --duration 2.4 -o "$results/four_post"
"$program" video --quiet "$results/four_post" --hide title,time,plots --speed 0.6 -o docs/pictures/four_post.webp
look governor flyball_governor 0.508
look quarter_car quarter_car 0.25
look grains pushed_grains 0.8
look hopper hopper 0.55
look landing_gear landing_gear 0.4
look geared_arm geared_arm 0.3
look gears gear_train 0.3
look drum rotating_drum 0.9 colour=speed
