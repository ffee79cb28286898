# SPDX-License-Identifier: BSD-3-Clause
# Recipes of package managers: every place is filled, each is a text of its kind, and the options
# that they give exist, and its manager finds in it what it asks for.
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

# Each recipe is asked by stand-ins for its manager.
here=$source/tests/install
PYTHONDONTWRITEBYTECODE=1 python3 "$here/recipes.py" "$work" "$source"
cmake -DFOLDER="$work" -P "$here/vcpkg.cmake" 2>"$work/vcpkg.txt"
for words in 'URLS;https://example.org/libse3d.tar.gz;FILENAME;libse3d-[0-9.]*.tar.gz;SHA512;[0-9a-f]\{128\}$' \
    'ARCHIVE;/archive$' 'SOURCE_PATH;/source;OPTIONS;-DSE3D_BUILD_TESTS=OFF' 'CONFIG_PATH;lib/cmake/se3d$' \
    'FILE_LIST;/source/LICENSE$'; do
    grep -q "$words" "$work/vcpkg.txt" || {
        cat "$work/vcpkg.txt"
        echo "no step of vcpkg gets $words" >&2
        exit 1
    }
done
if command -v ruby >/dev/null; then
    ruby -W1 "$here/formula.rb" "$work/homebrew/se3d.rb" "$work"
    "${CC:-cc}" -std=c11 -fsyntax-only -I"$source/include" "$work/test.c" # the program that it tries
else
    echo 'no ruby: the formula of Homebrew was not read'
fi
options=$(grep -rhoE 'SE3D_[A-Z_]+' "$work" | sort -u)
[ "$(echo "$options" | wc -l)" -ge 5 ]
for option in $options; do
    [ "$option" = SE3D_FAILED ] ||
        grep -q "option($option " "$source/CMakeLists.txt" "$source"/cmake/*.cmake || {
        echo "$option: no such option" >&2
        exit 1
    }
done
