#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Make the pictures of the documents from results of the example models.
# Needs gnuplot: apt-get install --no-install-recommends gnuplot-nox
#
#     sh docs/pictures/make.sh [PROGRAM]      the se3d program, default build/release/bin/se3d
set -eu
cd "$(dirname "$0")/../.."
program=${1:-build/release/bin/se3d}
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
"$program" run --quiet --duration 5 examples/models/pendulum.yaml -o "$results"
"$program" run --quiet --duration 2 --step 0.02 examples/models/spatial_slider_crank.yaml -o "$results"
for picture in pendulum slider_crank; do
    gnuplot -e "folder='$results'" "docs/pictures/$picture.gp" > "$results/$picture.svg"
    mv "$results/$picture.svg" "docs/pictures/$picture.svg"
done
