# SPDX-License-Identifier: BSD-3-Clause
# What the tests of mock-up units share. Sourced after cli.sh; ends the test if the build has none.
if [ -z "${SE3D_CHECK_FMU:-}" ]; then
    echo 'this build has no mock-up units'
    exit 0
fi

# unpack ARCHIVE FOLDER
unpack() {
    mkdir "$2"
    if command -v unzip >/dev/null; then
        unzip -q "$1" -d "$2"
    else
        python3 -m zipfile -e "$1" "$2"
    fi
}

# unit VERSIONS NAME MODEL OPTION...: run a model, make units of it, unpack and check them
unit() {
    versions=$1
    case=$2
    model=$3
    shift 3
    expect "$case" 0 "$program" run -q "$model" "$@" -o "$dir/$case.run"
    results=$(ls "$dir/$case.run/"*.csv | grep -v -e events.csv -e ride.csv | head -1)
    for fmi in $versions; do
        folder=$dir/$case.$fmi
        expect "$case" 0 "$program" fmu "$model" "$@" --fmi "$fmi" -o "$folder.fmu"
        holds "$case: cannot be unpacked" unpack "$folder.fmu" "$folder"
        expect "$case, FMI $fmi" 0 "$SE3D_CHECK_FMU" "$folder" "$results"
        cat "$dir/err" >&2
    done
}
