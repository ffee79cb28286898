# SPDX-License-Identifier: BSD-3-Clause
# Results as HDF5, plain and for VTK, and averages of walls and fields for VTK: h5py and VTK read the numbers that the
# CSV files have, names of other formats are refused, and a full disk leaves the rows. Run with SE3D_PROGRAM set.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
cat >"$dir/bed.yaml" <<'END_OF_YAML'
se3d: 1
contact: {law: hooke}
materials: [{name: glass, density: 2500, stiffness: 1e4, restitution: 0.5, friction: 0.5}]
bodies:
  - name: ground
    shapes:
      - {name: cone, type: funnel, bottom_radius: 0.02, top_radius: 0.08, length: 0.1, position: [0, 0, 0.05],
         material: glass}
      - {name: hill, type: heightfield, spacing: 0.2, heights: [[0, -0.05, 0], [-0.05, -0.02, -0.05], [0, -0.05, 0]],
         material: glass}
particles:
  - {name: beads, material: glass, radius: 0.006, lower: [-0.04, -0.04, 0.06], upper: [0.04, 0.04, 0.16], count: 100,
     seed: 2}
analysis: {type: dynamics, duration: 0.2}
output:
END_OF_YAML
fields='fields: {lower: [-0.1, -0.1, 0], upper: [0.1, 0.1, 0.2], cells: [3, 4, 5], width: 0.05}'
cp "$dir/bed.yaml" "$dir/all.yaml"
for end in csv h5; do
    cat >>"$dir/all.yaml" <<END_OF_YAML
  - {file: r.$end, every: 1e-3, channels: [energy.kinetic, {half: energy.kinetic/2}, "energy.kinetic/(1 + t)"]}
  - {file: p.$end, every: 0.1, particles: true}
  - {file: c.$end, every: 0.05, contacts: true}
  - {summary: s.$end, every: 0.01, channels: [energy.kinetic, energy.potential]}
  - {wall_map: cone.$end, shape: cone, every: 0.01, start: 0.1}
  - {average: a.$end, every: 0.1, $fields}
END_OF_YAML
done
cat >>"$dir/all.yaml" <<END_OF_YAML
  - {wall_map: hill.csv, shape: hill, every: 0.01}
  - {wall_map: hill.vtp, shape: hill, every: 0.01}
  - {wall_map: cone.vtp, shape: cone, every: 0.01, start: 0.1}
  - {wall_map: cone.vtkhdf, shape: cone, every: 0.01, start: 0.1}
  - {average: a.vti, every: 0.1, $fields}
  - {average: a.vtkhdf, every: 0.1, $fields}
  - {vtk: x.pvd, every: 0.1, $fields}
  - {vtk: h.vtkhdf, every: 0.1, $fields}
END_OF_YAML
run=$dir/run
expect 'all formats' 0 "$program" run "$dir/all.yaml" -o "$run"
has "$dir/out" "wrote $run/p.h5: 300 rows, 15 columns"
has "$dir/out" "wrote $run/h_bodies.vtkhdf.series: 3 times"
for file in $(sed -n 's/^wrote \([^:]*\):.*/\1/p' "$dir/out"); do
    holds "$file is not there" [ -s "$file" ]
done
is "$(ls "$run" | grep -c -e partial -e 'h5.csv' -e 'vt.*csv')" 0
holds 'nothing presses on the cone' awk -F, 'NR > 1 && $5 > 0 {++n} END {exit !(n > 20)}' "$run/cone.csv"
expect 'once more' 0 "$program" run -q "$dir/all.yaml" -o "$dir/again"
for file in r.h5 p.h5 cone.vtkhdf h/grains_00002.vtkhdf cone.vtp; do
    holds "$file has other bytes" cmp "$run/$file" "$dir/again/$file"
done

# The same compressed: less of it, and the same numbers.
if [ -n "${SE3D_HAS_ZLIB:-}" ]; then
    sed '/file:\|vtk:\|summary:\|wall_map:\|average:/{/\.csv/!s/}$/, compression: 6}/}' "$dir/all.yaml" >"$dir/packed.yaml"
    is "$(grep -c 'compression: 6' "$dir/packed.yaml")" 13
    expect 'compressed' 0 "$program" run -q "$dir/packed.yaml" -o "$dir/packed"
    expect 'compressed once more' 0 "$program" run -q "$dir/packed.yaml" -o "$dir/again"
    for file in r.h5 p.h5 cone.vtkhdf h/grains_00002.vtkhdf cone.vtp; do
        holds "$file, compressed, has other bytes" cmp "$dir/packed/$file" "$dir/again/$file"
    done
    for file in cone.vtp x/bodies_00000.vtp; do
        holds "$file is not smaller" [ "$(wc -c <"$dir/packed/$file")" -lt "$(($(wc -c <"$run/$file") * 3 / 4))" ]
    done
    cat >"$dir/long.yaml" <<'END_OF_YAML'
se3d: 1
bodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]
analysis: {type: dynamics, duration: 0.1, step: 1e-5}
output: [{file: long.h5, every: 1e-5, channels: [a.position.z], compression: 1}]
END_OF_YAML
    expect 'more than a piece' 0 "$program" run -q "$dir/long.yaml" -o "$dir/packed"
    [ ! -x "$SE3D_BUILD_DIR/tests/test_unit_hdf5_pieces" ] || "$SE3D_BUILD_DIR/tests/test_unit_hdf5_pieces" "$dir/packed/pieces.h5"
fi

# Names that are alike without slashes; outputs that are CSV among others.
cat >"$dir/alike.yaml" <<'END_OF_YAML'
se3d: 1
gravity: [0, 0, 0]
bodies:
  - {name: a/b, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}
  - {name: "a:b", mass: 1, inertia: [1, 1, 1], velocity: [2, 0, 0]}
analysis: {type: dynamics, duration: 0.1, step: 0.01}
output:
  - {file: r.h5, every: 0.1, channels: [a/b.velocity, "a:b.velocity", {h/t: energy.kinetic},
     {"h:t": 2*energy.kinetic}, {"h:t:": 3*energy.kinetic}]}
  - {file: r.csv, every: 0.1, channels: [{half: energy.kinetic/2}]}
END_OF_YAML
expect 'names that are alike' 0 "$program" run -q "$dir/alike.yaml" -o "$dir/alike"
expect 'rows of the CSV file' 0 "$program" run "$dir/alike.yaml" -o "$dir/alike" --print -
is "$(head -n 1 "$dir/out")" time,half
expect 'a report beside HDF5' 0 "$program" report "$dir/alike.yaml" -o "$dir/page"
has "$dir/page/report.html" r.csv
if command -v gnuplot >/dev/null 2>&1; then
    expect 'a plot beside HDF5' 0 sh -c 'cd "$2" && "$1" plot alike.yaml -y half -o half' sh "$program" "$dir"
    holds 'no plot' [ -s "$dir/half.svg" ]
fi
grep -v r.csv "$dir/alike.yaml" >"$dir/none.yaml"
expect 'rows of no CSV file' 2 "$program" run "$dir/none.yaml" -o "$dir/none" --print -
says 'no CSV file of channels'
expect 'a report of HDF5 alone' 0 "$program" report "$dir/none.yaml" -o "$dir/page"
expect 'a plot of HDF5 alone' 2 "$program" plot "$dir/none.yaml"
says 'nothing to run and draw'
expect 'a report of what is not CSV' 1 sh -c 'cp "$2/alike/r.h5" "$2/not.csv" && "$1" report "$2/not.csv"' sh "$program" "$dir"
is "$(wc -l <"$dir/err")" 1
says 'is HDF5, must be CSV'

cat >"$dir/plain.py" <<'END_OF_PYTHON'
import csv, sys, h5py
checks = 0
for name in "r", "p", "c", "s", "cone", "a":
    with open(sys.argv[1] + "/%s.csv" % name) as file:
        head, *rows = csv.reader(file)
    data = h5py.File(sys.argv[1] + "/%s.h5" % name)["/"]
    assert list(data) == [c.replace("/", ":") for c in head], (list(data), head)  # in their order
    for k, column in enumerate(data):
        values, wanted = data[column][:], [r[k] for r in rows]
        texts = head[k] in ("material", "set", "kind", "channel") or name == "c" and head[k] in ("a", "b")
        assert values.dtype.kind == ("S" if texts else "i" if name == "p" and head[k] == "id" else "f"), column
        if texts:
            assert [v.decode() for v in values] == wanted, column
        else:
            assert values.tolist() == [float(w) for w in wanted], column  # to the bit
        checks += len(values)
grid = h5py.File(sys.argv[1] + "/h/grains_00002.vtkhdf")["VTKHDF"]
assert grid.attrs["Type"] == b"UnstructuredGrid" and grid.attrs["Version"].tolist() == [1, 0]
assert grid["Points"].shape == (100, 3) and grid["PointData/radius"].shape == (100,)
assert checks > 1000, checks
alike = h5py.File(sys.argv[1] + "/../alike/r.h5")["/"]
wanted = {"a:b.velocity.x": 1, "a:b.velocity.x:": 2, "h:t": 2.5, "h:t:": 5, "h:t::": 7.5}
import os
import numpy as np
packed = sys.argv[1] + "/../packed/"
for name in "r", "p", "c", "s", "cone", "a":
    if os.path.exists(packed):
        a, b = h5py.File(sys.argv[1] + "/%s.h5" % name), h5py.File(packed + "%s.h5" % name)
        assert list(a) == list(b) and all(a[k].dtype == b[k].dtype and np.array_equal(a[k][:], b[k][:]) for k in a), name
        assert name != "r" or not b["half"].chunks or b["half"].compression == "gzip" and b["half"].shuffle
if os.path.exists(packed):
    long = h5py.File(packed + "long.h5")
    times = long["time"][:]
    assert long["time"].chunks == (8192,) and times.shape == (10001,)  # 64 kB
    assert np.abs(times - 1e-5 * np.arange(10001)).max() < 1e-12
    assert np.abs(long["a.position.z"][:] + 0.5 * 9.81 * times**2).max() < 1e-9
if os.path.exists(packed + "pieces.h5"):
    file = h5py.File(packed + "pieces.h5")
    table = 10.0 * np.arange(5000)[:, None] + np.arange(3)
    for name, piece in ("one", 1), ("some", 64), ("all", 5000), ("chosen", 2730):
        assert file[name].chunks == (piece, 3), file[name].chunks
        assert np.array_equal(file[name][:], table) and np.array_equal(file[name][4097:4099, 1], table[4097:4099, 1]), name
    assert file["small"][:].tolist() == [1, 2, 3] and file["small"].chunks is None
assert len(alike) == 10 and all(abs(alike[c][1] - wanted[c]) < 1e-12 for c in wanted), list(alike)
END_OF_PYTHON
cat >"$dir/pictures.py" <<'END_OF_PYTHON'
import csv, json, sys, vtk
folder = sys.argv[1] + "/"
def read(name):
    reader = (vtk.vtkHDFReader() if name.endswith("vtkhdf") else
              vtk.vtkXMLImageDataReader() if name.endswith("vti") else vtk.vtkXMLPolyDataReader())
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append(name))
    reader.SetFileName(folder + name)
    assert reader.CanReadFile(folder + name), name
    reader.Update()
    assert not problems, problems
    return reader.GetOutput()
def same(a, b):
    assert a.GetNumberOfArrays() == b.GetNumberOfArrays()
    for k in range(b.GetNumberOfArrays()):
        x, y = b.GetArray(k), a.GetArray(b.GetArrayName(k))
        assert x.GetNumberOfValues() == y.GetNumberOfValues() and x.GetNumberOfComponents() == y.GetNumberOfComponents()
        assert all(x.GetValue(n) == y.GetValue(n) for n in range(x.GetNumberOfValues())), x.GetName()
def compare(hdf, xml):
    import os
    for name in hdf, xml:  # the same, compressed
        if os.path.exists(folder + "../packed/"):
            a, b = read(name), read("../packed/" + name)
            assert a.GetNumberOfPoints() == b.GetNumberOfPoints() and a.GetNumberOfCells() == b.GetNumberOfCells(), name
            same(a.GetPointData(), b.GetPointData())
            same(a.GetCellData(), b.GetCellData())
    a, b = read(hdf), read(xml)
    if xml.endswith("vti"):  # its cells are the points of the other
        same(a.GetPointData(), b.GetCellData())
        for k in range(3):
            low, high = b.GetBounds()[2 * k], b.GetBounds()[2 * k + 1]
            half = b.GetSpacing()[k] / 2
            assert abs(a.GetBounds()[2 * k] - low - half) + abs(a.GetBounds()[2 * k + 1] - high + half) < 1e-12
        return 1
    assert a.GetNumberOfPoints() == b.GetNumberOfPoints() and a.GetNumberOfCells() == b.GetNumberOfCells()
    if a.GetNumberOfPoints() > 0:
        same(a.GetPointData(), b.GetPointData())
        same(a.GetCellData(), b.GetCellData())
    for k in range(0, a.GetNumberOfCells(), 7):
        assert a.GetCell(k).GetBounds() == b.GetCell(k).GetBounds() and a.GetCellType(k) == b.GetCellType(k)
    return a.GetNumberOfCells()
cells = compare("cone.vtkhdf", "cone.vtp") + compare("a.vtkhdf", "a.vti")
for part in "bodies", "grains", "contacts", "fields":
    listed = json.load(open(folder + "h_%s.vtkhdf.series" % part))["files"]
    assert [f["time"] for f in listed] == [0, 0.1, 0.2]
    for k, file in enumerate(listed):
        cells += compare(file["name"], "x/%s_%05d.%s" % (part, k, "vti" if part == "fields" else "vtp"))
assert cells > 1000, cells
for name in "cone", "hill":
    wall, rows = read(name + ".vtp"), list(csv.DictReader(open(folder + name + ".csv")))
    assert wall.GetNumberOfCells() == len(rows)
    for k, row in enumerate(rows):
        points = wall.GetCell(k).GetPoints()
        n = points.GetNumberOfPoints()
        middle = [sum(points.GetPoint(i)[c] for i in range(n)) / n for c in range(3)]
        assert n == (4 if name == "cone" else 3)
        assert max(abs(m - float(row[c])) for m, c in zip(middle, "xyz")) < 8e-4, (middle, row)
        for column in "area", "pressure", "sliding":
            value = wall.GetCellData().GetArray(column).GetValue(k)
            assert abs(value - float(row[column])) <= 1e-6 * abs(float(row[column])), (column, row)
END_OF_PYTHON
for module in h5py vtk; do
    script=plain.py
    [ $module = h5py ] || script=pictures.py
    python=
    for candidate in python3 /usr/bin/python3; do
        "$candidate" -c "import $module" 2>/dev/null && python=$candidate
    done
    if [ -n "$python" ]; then
        name=$script
        holds 'does not read the files back' "$python" "$dir/$script" "$run"
    else
        echo "SKIPPED: no python3-$module: the files were not read back" >&2
    fi
done

# What does not fit is named.
bad() {
    cp "$dir/bed.yaml" "$dir/bad.yaml"
    printf '  - %s\n' "$@" | sed '$d' >>"$dir/bad.yaml"
    expect "$1" 2 "$program" check "$dir/bad.yaml"
    shift $(($# - 1))
    says "$1"
}
bad "{wall_map: a.vti, shape: cone}" 'must end with .vtp, .vtkhdf, .h5 or .csv'
bad "{average: a.vtp, $fields}" 'must end with .vti, .vtkhdf, .h5 or .csv'
bad "{vtk: a.h5}" 'must end with .pvd or .vtkhdf'
bad "{file: a.csv, compression: 1}" 'compression: has no effect on `a.csv`: CSV is not compressed; .h5 is'
bad "{file: a.h5, compression: 10}" 'must be a whole number from 0 to 9'
[ -n "${SE3D_HAS_ZLIB:-}" ] || bad "{file: a.h5, compression: 1}" 'this build of libse3d-io has no zlib'
bad "{file: a.h5}" "{file: a.h5.csv}" 'written by two outputs'
bad "{file: a.h5}" "{plot: a.svg, from: a.h5}" 'is HDF5: plots are made of CSV files'
expect 'a plot of HDF5' 1 "$program" plot "$run/r.h5"
says 'r.h5: is HDF5, must be CSV'
for file in p.h5 cone.vtp; do
    mkdir -p "$dir/taken/$file"
    expect "a folder in the place of $file" 1 "$program" run "$dir/all.yaml" -o "$dir/taken"
    says "taken/$file: cannot be written: Is a directory"
    holds 'it was run' [ -z "$(find "$dir/taken" -name '*.csv*')" ]
    rmdir "$dir/taken/$file"
done
mkdir -p "$dir/full/p.h5.partial"
expect 'a folder in the place of a file, later' 1 "$program" run "$dir/all.yaml" -o "$dir/full"
says "full/p.h5: cannot be written: File exists; its rows are in $dir/full/p.h5.csv"
is "$(wc -l <"$dir/full/p.h5.csv")" 301
if [ -n "${SE3D_HAS_ZLIB:-}" ]; then
    expect 'a full disk, compressed' 1 sh -c 'trap "" XFSZ; ulimit -f 40; exec "$@"' sh "$program" run "$dir/packed.yaml" -o "$dir/limit"
    says 'File too large'
    holds 'something unfinished is left' [ -z "$(find "$dir/limit" -name '*.partial')" ]
fi
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 40; exec "$@"' sh "$program" run "$dir/all.yaml" -o "$dir/limit"
says 'File too large'
holds 'something unfinished is left' [ -z "$(find "$dir/limit" -name '*.partial')" ]
finish
