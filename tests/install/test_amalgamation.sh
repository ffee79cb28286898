# SPDX-License-Identifier: BSD-3-Clause
# The library as one source gives the same bits as the library that is installed.
set -eu
source=${SE3D_SOURCE_DIR:-.}
build=${SE3D_BUILD_DIR:?the build folder}
work=$build/tests/amalgamation
rm -rf "$work"
python3 "$source/tools/amalgamate.py" "$work"

deps=$(echo "$SE3D_AMD_INCLUDE" | sed 's/;/ -I/g')
for name in se3d se3d-io; do # kernels that are not inlined by force compile in a third of the time
    "$CC" -std=c11 -O0 -Dalways_inline=unused -ffp-contract=off -I"$work" ${deps:+-I$deps} \
        -c "$work/$name.c" -o "$work/$name.o" &
done
wait
"$CC" -std=c11 -DAMALGAMATED -I"$work" "$source/tests/install/amalgamated.c" "$work/se3d-io.o" \
    "$work/se3d.o" -o "$work/one" -lyaml -lexpat -lamd -lm
"$CC" -std=c11 -I"$source/include" "$source/tests/install/amalgamated.c" -o "$work/installed" \
    -L"$build/lib" -Wl,-rpath,"$build/lib" -lse3d-io -lse3d

models="fourbar double_pendulum heap pushed_grains flyball_governor quarter_car"
paths=
for model in $models; do
    [ ! -f "$source/examples/models/$model.yaml" ] || paths="$paths $source/examples/models/$model.yaml"
done
# shellcheck disable=SC2086
"$work/one" $paths >"$work/one.txt"
# shellcheck disable=SC2086
"$work/installed" $paths >"$work/installed.txt"
cmp "$work/one.txt" "$work/installed.txt"
echo "$(wc -l <"$work/one.txt") models: the same bits"
[ "$(wc -l <"$work/one.txt")" -ge 4 ]
