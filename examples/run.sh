#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Build the `se3d` program and run the example models, from a clean clone on a bare Debian 12.
# Missing packages are installed. The results are written to results/<model>/.
set -eu
cd "$(dirname "$0")/.."
. tools/setup.sh
# shellcheck disable=SC2086
se3d_install $SE3D_BUILD_PACKAGES
cmake --preset release -DSE3D_BUILD_TESTS=OFF -DSE3D_BUILD_EXAMPLES=OFF
cmake --build --preset release -j "$(se3d_jobs)" --target se3d_program # the picture first
program=build/release/bin/se3d

# The main job: one model, all that it leaves; the plot and the page where their tools are there.
show_main() {
    name=$1
    folder=results/$name
    mkdir -p "$folder"
    "$program" sketch -q "examples/models/$name.yaml" -o "$folder/sketch.svg" || return 1
    echo "picture: $(pwd)/$folder/sketch.svg (any browser)"
    echo "== $name: se3d run examples/models/$name.yaml -o $folder"
    "$program" run "examples/models/$name.yaml" -o "$folder" || return 1
    echo "results: $(pwd)/$folder/$name.csv"
    echo "scene:   $(pwd)/$folder/scene.glb (Blender, any glTF viewer)"
    if command -v gnuplot >/dev/null 2>&1; then
        "$program" plot -q "$folder/$name.csv" && echo "plot:    $(pwd)/$folder/$name.svg and .png" ||
            echo "plot:    not made, see above"
    else
        echo "plot:    se3d plot $folder/$name.csv (after: apt-get install --no-install-recommends gnuplot-nox)"
    fi
    if command -v npm >/dev/null 2>&1; then
        SE3D_CACHE=build/release/viewer "$program" view -q "$folder" &&
            echo "page:    $(pwd)/$folder/scene.html (any browser)" || echo "page:    not made, see above"
    else
        echo "page:    se3d view $folder (after: apt-get install --no-install-recommends npm)"
    fi
}

# The first rows of a CSV file, wide lines cut.
show() {
    echo "The first rows of $1:"
    head -n 4 "$1" | cut -c 1-110 | sed 's/^/    /'
}

failed=
show_main suspension || failed=" suspension"
for model in examples/models/pendulum.yaml examples/models/*.yaml; do
    name=$(basename "$model" .yaml)
    # The suspension has been run; the pendulum goes first, and only once.
    case $name in
    suspension) continue ;;
    pendulum) [ -z "${pendulum_done:-}" ] || continue; pendulum_done=1 ;;
    esac
    echo
    if [ "$name" = me751_jacobian ]; then # a model to evaluate, not to run
        mkdir -p "results/$name"
        echo "se3d evaluate $model --csv > results/$name/jacobian.csv"
        "$program" evaluate "$model" --csv > "results/$name/jacobian.csv" || failed="$failed $model"
        continue
    fi
    echo "se3d run $model -o results/$name"
    if "$program" run "$model" -o "results/$name"; then
        echo "The results of $model are in results/$name:"
        ls "results/$name" | sed 's/^/    /'
        for csv in "results/$name"/*.csv; do
            [ ! -f "$csv" ] || show "$csv"
        done
    else
        failed="$failed $model"
    fi
done

# The Formula SAE car: rigs of its suspension, its modes on linear tyres, and braking on tyres that slip.
for name in travel roll steer car brake; do
    echo
    echo "se3d run examples/fsae/$name.yaml -o results/fsae_$name"
    if "$program" run "examples/fsae/$name.yaml" -o "results/fsae_$name"; then
        show "results/fsae_$name/$name.csv"
    else
        failed="$failed fsae/$name"
    fi
done

# What the program does without: shared libraries, recorder.
cmake --build --preset release -j "$(se3d_jobs)"

echo
if [ -n "$failed" ]; then
    echo "These models failed:$failed"
    exit 1
fi
echo "All results are in $(pwd)/results; run another model with: $program run MODEL.yaml -o DIR"
