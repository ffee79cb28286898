# SPDX-License-Identifier: BSD-3-Clause
# The scene that se3d run leaves: a glTF file whose poses are those of the CSV file.
set -eu
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
"$program" run -q "$models/pendulum.yaml" -o "$dir/pendulum"
"$program" run -q "$models/spatial_slider_crank.yaml" -o "$dir/spatial_slider_crank"
"$program" run -q "$models/tsda_mass.yaml" -o "$dir/tsda_mass"
sed "s/^  - {file: bracket.csv/  - {vtk: motion.pvd, every: 0.1}\n&/
s/^joints:/  - {name: twin, fixed: true, position: [0, 1, 0], shapes: [{type: mesh, file: bracket.obj, scale: 0.001},\n     {type: mesh, file: bracket.obj, scale: 0.1, position: [0, 0, 1]}]}\n&/" \
    "$models/bracket.yaml" >"$dir/bracket.yaml"
cp "$models/bracket.obj" "$dir"
"$program" run -q "$dir/bracket.yaml" -o "$dir/bracket"
cat >"$dir/check.py" <<'END_OF_PYTHON'
import csv, json, struct, sys
def load(path):
    data = open(path, "rb").read()
    magic, version, size, length, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON"), path
    return json.loads(data[20:20 + length]), data[28 + length:]
def values(doc, binary, index):
    a = doc["accessors"][index]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
    code, scale = {5126: ("f", 1.0), 5122: ("h", 1 / 32767)}[a["componentType"]]
    start = doc["bufferViews"][a["bufferView"]]["byteOffset"]
    flat = struct.unpack_from("<%d%s" % (a["count"] * width, code), binary, start)
    return [[v * scale for v in flat[k:k + width]] for k in range(0, len(flat), width)]
checks = 0
for folder, bodies in (("pendulum", ["bar"]), ("spatial_slider_crank", ["crank", "rod"]), ("tsda_mass", ["block"])):
    name = folder.split("/")[-1]
    base = sys.argv[1] + "/" + folder + "/"
    doc, binary = load(base + "scene.glb")
    rows = list(csv.DictReader(open(base + name + ".csv")))
    samplers = doc["animations"][0]["samplers"]
    seen = set()
    for channel in doc["animations"][0]["channels"]:
        node = doc["nodes"][channel["target"]["node"]]["name"]
        sampler = samplers[channel["sampler"]]
        times = values(doc, binary, sampler["input"])
        out = values(doc, binary, sampler["output"])
        path = channel["target"]["path"]
        seen.add((node, path))
        for row, time, value in zip(rows, times, out):
            assert abs(float(row["time"]) - time[0]) < 1e-5
            if path == "translation" and node in bodies:
                want = [float(row[node + ".position." + c]) for c in "xyz"]
                assert max(abs(a - b) for a, b in zip(want, value)) < 1e-5, (node, time, want, value)
            elif path == "rotation" and node + ".orientation.e0" in row:
                e = [float(row[node + ".orientation.e%d" % k]) for k in (1, 2, 3, 0)]
                sign = 1 if sum(a * b for a, b in zip(e, value)) > 0 else -1
                assert max(abs(sign * a - b) for a, b in zip(e, value)) < 2e-5, (node, time, e, value)
            elif path == "scale" and node == "spring":
                assert abs(value[2] - float(row["spring.length"])) < 1e-5
        assert len(out) == len(rows)
        checks += 1
    assert all((body, "translation") in seen for body in bodies), seen
    if folder == "tsda_mass":
        assert ("spring", "scale") in seen
    names = [node["name"] for node in doc["nodes"]]
    assert "ground" in names and "grid" in names
# A mesh: points of its own for every triangle, with unit normals that point out; shapes of one file
# and scale share them.
doc, binary = load(sys.argv[1] + "/bracket/scene.glb")
def drawn(body):
    node = next(n for n in doc["nodes"] if n["name"] == body)
    shapes = [doc["nodes"][k] for k in node["children"] if doc["nodes"][k]["name"] == "shape"]
    return [doc["meshes"][n["mesh"]]["primitives"][0] for n in shapes], shapes
(first,), nodes = drawn("bracket")
(second, third), _ = drawn("twin")
assert nodes[0]["scale"] == [1, 1, 1] and "indices" not in first and "mode" not in first
assert first["attributes"] == second["attributes"] != third["attributes"]
points = values(doc, binary, first["attributes"]["POSITION"])
normals = values(doc, binary, first["attributes"]["NORMAL"])
assert len(points) == len(normals) == 60
volume = 0.0
for k in range(0, 60, 3):
    a, b, c = points[k:k + 3]
    n = normals[k]
    assert normals[k + 1] == normals[k + 2] == n and abs(sum(v * v for v in n) - 1) < 1e-6
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    area = sum(p * p for p in cross) ** 0.5
    assert abs(sum(p * q for p, q in zip(cross, n)) - area) < 1e-6 * area
    volume += sum(p * q for p, q in zip(a, cross)) / 6
    checks += 1
assert abs(volume - 8e-5) < 1e-10, volume
box = doc["accessors"][first["attributes"]["POSITION"]]
assert max(abs(a - b) for a, b in zip(box["min"] + box["max"], [-.022, -.02, -.022, .038, .02, .038])) < 1e-8
# What is seen has the large twin in it: from -1.2 to 4.8 m in z.
grid = next(n for n in doc["nodes"] if n["name"] == "grid")
assert grid["scale"][0] == 1 and grid["translation"][2] == -2, grid
print(checks, "checks, 0 failed")
END_OF_PYTHON
python3 "$dir/check.py" "$dir"
# Three times 12 points and 20 triangles, and the pin.
grep -aq 'NumberOfPoints="166".*NumberOfPolys="184"' "$dir/bracket/motion/bodies_00000.vtp" || {
    grep -a NumberOf "$dir/bracket/motion/bodies_00000.vtp" >&2
    exit 1
}
if "$program" run -q "$models/pendulum.yaml" -o "$dir" --duration 1 && rm "$dir/scene.glb" && mkdir "$dir/scene.glb" &&
    "$program" run -q "$models/pendulum.yaml" -o "$dir" --duration 1 2>"$dir/err"; then
    echo 'a scene that cannot be written went unnoticed' >&2
    exit 1
fi
grep -q 'scene.glb: cannot be written' "$dir/err"
[ ! -e "$dir/scene.glb.partial" ]
