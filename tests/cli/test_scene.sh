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
"$program" run -q "$models/suspension.yaml" -o "$dir/suspension"
"$program" run -q "$models/flyball_governor.yaml" -o "$dir/flyball_governor" --duration 1
cat >"$dir/looks.yaml" <<'END_OF_MODEL'
se3d: 1
bodies:
  - {name: block, mass: 1, inertia: [1, 1, 1], shapes: [{type: box, size: [1, 1, 1], color: [0.5, 0, 0, 0.25]},
     {type: sphere, radius: 1, style: steel}, {type: sphere, radius: 2, style: wire}]}
analysis: {type: dynamics, duration: 0.1}
END_OF_MODEL
"$program" run -q "$dir/looks.yaml" -o "$dir/looks"
for pair in 'color: [0.5, 0, 0, 1.5]|color: has 1.5, must be red, green, blue and' 'color: [0.5, 0]|has 2' 'style: brass|style: '; do
    sed "s/color: [^}]*}/${pair%|*}}/" "$dir/looks.yaml" >"$dir/bad.yaml"
    ! "$program" check "$dir/bad.yaml" >"$dir/out" 2>&1 || { echo "${pair%|*} is taken" >&2; exit 1; }
    grep -qF "${pair#*|}" "$dir/out" || { cat "$dir/out" >&2; exit 1; }
done
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
# Bars of bodies without shapes: an arm is an A, through its eyes and to what is on it; nothing has a name twice but what
# moves between two bodies. A joint is drawn as what it is.
doc, binary = load(sys.argv[1] + "/suspension/scene.glb")
nodes = doc["nodes"]
def children(body):
    return [nodes[k] for k in next(n for n in nodes if n["name"] == body)["children"]]
def turned(n, z):
    x, y, u, w = n["rotation"]
    return [p + z * q for p, q in zip(n["translation"], (2 * (x * u + w * y), 2 * (y * u - w * x), 1 - 2 * (x * x + y * y)))]
def bars(body):
    """Both ends of every bar: those that are long along z."""
    found = []
    for n in children(body):
        if n["name"] == "link" and abs(n["scale"][2] - n["scale"][0]) > 1e-9:
            found.append([turned(n, s * n["scale"][2]) for s in (-0.5, 0.5)])
    return found
def near(p, q):
    return max(abs(a - b) for a, b in zip(p, q)) < 1e-5
def joined(body, p, q):
    return any(near(a, p) and near(b, q) or near(a, q) and near(b, p) for a, b in bars(body))
front, rear, ball = [.13, -.15, 0], [-.14, -.15, 0], [.006, .225, 0]
assert joined("lower_arm", front, ball) and joined("lower_arm", rear, ball) and joined("lower_arm", front, rear), bars("lower_arm")
assert any(near(a, [0, .17, .025]) or near(b, [0, .17, .025]) for a, b in bars("lower_arm")), "the pushrod has no seat"
assert len(bars("lower_arm")) == 4 and len(bars("tie_rod")) == 1, (bars("lower_arm"), bars("tie_rod"))
assert all("link" not in n["name"] for n in children("wheel"))
kinds = {e["name"]: e["type"] for e in doc["scenes"][0]["extras"]["elements"]}
def drawn_as(name):
    return [n for n in nodes if n.get("extras", {}).get("element") == list(kinds).index(name)]
for name, kind in kinds.items():
    if kind in ("revolute", "spherical", "universal", "prismatic"):
        assert sum(n["name"] == name for n in drawn_as(name)) == 1, name
        checks += 1
unit = lambda n: doc["meshes"][n["mesh"]]["primitives"][0]["attributes"]["POSITION"]
ball, pin = (next(n for n in nodes if n["name"] == name) for name in ("lower_ball", "lower_pivot"))
assert ball["scale"][0] == ball["scale"][2] and unit(ball) != unit(pin)
assert pin["scale"][2] > .27, "the pin does not go through both eyes"
assert len(drawn_as("tie_inner")) == 2 and len({tuple(n["rotation"]) for n in drawn_as("tie_inner")}) == 2, "no cross"
assert len(drawn_as("rack_guide")) == 2 and max(n["scale"][2] for n in drawn_as("rack_guide")) > .04, "the rail is too short"
assert len(drawn_as("coil")) == 3, "a coil, the tube of a damper and its rod"
assert any(n["name"] == "foot" for n in children("ground")), "nothing stands on the ground"
# Also beside given shapes: the balls of the governor hang on arms, and a link is a rod.
doc, binary = load(sys.argv[1] + "/flyball_governor/scene.glb")
nodes = doc["nodes"]
assert len(bars("right")) == 2 and max(abs(b[i]) for a in bars("right") for b in a for i in range(3)) > .25, bars("right")
kinds = {e["name"]: e["type"] for e in doc["scenes"][0]["extras"]["elements"]}
assert any(abs(n["scale"][2] - .2) < 1e-6 for n in drawn_as("link_right")), "a link of its length"
assert not [n for n in drawn_as("dashpot") if n["scale"][0] == n["scale"][1] and len(drawn_as("dashpot")) != 2], "a damper is no coil"
# Colours are light, as glTF wants it; opacity and style.
doc, binary = load(sys.argv[1] + "/looks/scene.glb")
made = [doc["materials"][k] for k in range(len(doc["materials"]))]
red = next(m for m in made if m["pbrMetallicRoughness"]["baseColorFactor"][3] == .25)
assert abs(red["pbrMetallicRoughness"]["baseColorFactor"][0] - .214041) < 1e-5 and red["alphaMode"] == "BLEND", red
assert [m for m in made if m["pbrMetallicRoughness"]["metallicFactor"] > .7] and [m for m in made if m.get("extras") == {"style": "wire"}]
checks += 20
print(checks, "checks, 0 failed")
END_OF_PYTHON
python3 "$dir/check.py" "$dir"
# Three times 12 points and 20 triangles, the pin, its eye, and the foot: a cone and a box.
grep -aq 'NumberOfPoints="418".*NumberOfPolys="414"' "$dir/bracket/motion/bodies_00000.vtp" || {
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
