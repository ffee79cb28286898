# SPDX-License-Identifier: BSD-3-Clause
# Recipes of package managers: every place is filled, each is a text of its kind, and the options
# that they give exist.
set -eu
source=${SE3D_SOURCE_DIR:-.}
work=${SE3D_BUILD_DIR:?the build folder}/tests/recipes
rm -rf "$work"
mkdir -p "$work"
echo archive >"$work/archive"
python3 "$source/packaging/fill.py" https://example.org/libse3d.tar.gz "$work/archive" "$work"
for bad in 'https://example.org/a b' 'ftp://example.org/a' 'https://example.org/"a'; do
    ! python3 "$source/packaging/fill.py" "$bad" "$work/archive" "$work/bad" 2>"$work/err"
    grep -q 'must be https' "$work/err"
done
! grep -rn '@[A-Z0-9]*@' "$work"
python3 - "$work" <<'E'
import ast, json, pathlib, sys
work = pathlib.Path(sys.argv[1])
ast.parse((work / "conan/conanfile.py").read_text())
assert json.loads((work / "vcpkg/se3d/vcpkg.json").read_text())["version"].count(".") == 2
E
options=$(grep -rhoE 'SE3D_[A-Z_]+' "$work" | sort -u)
[ "$(echo "$options" | wc -l)" -ge 5 ]
for option in $options; do
    [ "$option" = SE3D_FAILED ] ||
        grep -q "option($option " "$source/CMakeLists.txt" "$source"/cmake/*.cmake || {
        echo "$option: no such option" >&2
        exit 1
    }
done
