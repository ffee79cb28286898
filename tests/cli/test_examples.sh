# SPDX-License-Identifier: BSD-3-Clause
# Every example model begins to run by the program, with all its outputs.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
for model in "$models"/*.yaml; do
    name=$(basename "$model" .yaml)
    duration=0.06
    [ "$name" != agglomerate ] || [ -n "${SE3D_LONG:-}" ] || duration=0.002 # else 20 s
    [ "$name" = me751_jacobian ] || # to evaluate, not to run
        expect "$name" 0 "$program" run -q "$model" --duration "$duration" -o "$dir/$name"
done
for name in kerb washboard four_post one_wheel two_wheels; do
    expect "$name" 0 "$program" run -q "$models/../fsae/$name.yaml" --duration 0.01 -o "$dir/$name"
done
finish
