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
  - {name: tube, from: [0, 0, 0], to: [0, 1, 0], radius: 0.02, wall: 0.002, density: 7850}
analysis: {type: dynamics, duration: 0.1}
END_OF_MODEL
"$program" run -q "$dir/looks.yaml" -o "$dir/looks"
# Gears side by side, in a ring and at a right angle, a pinion on a rack; a kerb, and a post that goes up and down.
cat >"$dir/gears.yaml" <<'END_OF_MODEL'
se3d: 1
gravity: [0, 0, 0]
bodies:
  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}
  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0.3, 0, 0]}
  - {name: ring, mass: 1, inertia: [1, 1, 1], position: [0.1, 0, 0.3]}
  - {name: planet, mass: 1, inertia: [1, 1, 1], position: [0.2, 0, 0.3]}
  - {name: bevel, mass: 1, inertia: [1, 1, 1], position: [0.3, 0.15, -0.1]}
  - {name: bar, mass: 1, inertia: [1, 1, 1], position: [0, 0, -0.4]}
  - {name: crown, mass: 1, inertia: [1, 1, 1], position: [2, 0, 0.3]}
  - {name: flat, mass: 1, inertia: [1, 1, 1], position: [2, 0, 0.3]}
  - {name: cone, mass: 1, inertia: [1, 1, 1], position: [2.2598076, 0, -0.15]}
  - {name: small, mass: 1, inertia: [1, 1, 1], position: [0, -1, 0]}
  - {name: long, mass: 1, inertia: [1, 1, 1], position: [0, -1, 0]}
joints:
  - {name: ja, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: jb, type: revolute, body_i: b, body_j: ground, at: [0.3, 0, 0], axis: [0, 1, 0]}
  - {name: jr, type: revolute, body_i: ground, body_j: ring, at: [0.1, 0, 0.4], axis: [0, 1, 0]}
  - {name: jp, type: revolute, body_i: ground, body_j: planet, at: [0.2, 0.01, 0.4], axis: [0, -1, 0]}
  - {name: jv, type: revolute, body_i: ground, body_j: bevel, at: [0.3, 0.15, -0.15], axis: [0, 0, 1]}
  - {name: jc, type: prismatic, body_i: ground, body_j: bar, at: [0, 0, -0.4], axis: [1, 0, 0]}
  - {name: jk, type: revolute, body_i: ground, body_j: crown, at: [2, 0, 0.3], axis: [0, 0, 1]}
  - {name: jf, type: revolute, body_i: ground, body_j: flat, at: [2, 0, 0.3], axis: [0, 0, 1]}
  - {name: jw, type: revolute, body_i: ground, body_j: cone, at: [2.25980762113533, 0, -0.15], axis: [0.866025403784439, 0, -0.5]}
  - {name: js, type: revolute, body_i: ground, body_j: small, at: [0, -1, 0], axis: [0, 1, 0]}
  - {name: jl, type: prismatic, body_i: ground, body_j: long, at: [0, -1, 0], axis: [1, 0, 0]}
  - {name: obtuse, type: gear, joint_1: jw, joint_2: jk, ratio: 2.5}
  - {name: right_flat, type: gear, joint_1: jw, joint_2: jf, ratio: 2}
  - {name: far_rack, type: rack_pinion, pinion: js, rack: jl, radius: 0.02}
  - {name: outside, type: gear, joint_1: ja, joint_2: jb, ratio: -2}
  - {name: inside, type: gear, joint_1: jp, joint_2: jr, ratio: 0.5}
  - {name: right, type: gear, joint_1: jb, joint_2: jv, ratio: 1.5}
  - {name: rack, type: rack_pinion, pinion: ja, rack: jc, radius: 0.12}
  - {name: link, type: coupler, terms: [{joint: ja}, {joint: jp, ratio: -1}]}
drivers: [{joint: ja, value: sin(t)}, {joint: jw, value: t}, {joint: jl, value: 2*t}]
analysis: {type: kinematics, duration: 1, step: 0.02}
END_OF_MODEL
"$program" run -q "$dir/gears.yaml" -o "$dir/gears"
cat >"$dir/far.yaml" <<'END_OF_MODEL'
se3d: 1
gravity: [0, 0, 0]
bodies:
  - {name: front, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [100, 0, 0]}
  - {name: rear, mass: 1, inertia: [1, 1, 1], position: [-1, 0, 0], velocity: [100, 0, 0]}
joints: [{name: hitch, type: revolute, body_i: front, body_j: rear, at: [0, 0, 0], axis: [0, 0, 1]}]
analysis: {type: dynamics, duration: 10}
END_OF_MODEL
"$program" run -q "$dir/far.yaml" -o "$dir/far"
cat >"$dir/roads.yaml" <<'END_OF_MODEL'
se3d: 1
bodies: [{name: wheel, mass: 10, inertia: [1, 1, 1], position: [0, 0, 0.3]}, {name: still, mass: 10, inertia: [1, 1, 1], position: [0, 3, 0.3]},
  {name: flat, mass: 10, inertia: [1, 1, 1], position: [0, -3, 0.3]}, {name: ending, mass: 10, inertia: [1, 1, 1], position: [0, 6, 0.3]}]
joints:
  - {name: way, type: prismatic, body_i: ground, body_j: wheel, at: [0, 0, 0.3], axis: [1, 0, 0]}
  - {name: held, type: fixed, body_i: ground, body_j: still, at: [0, 3, 0.3]}
  - {name: other, type: fixed, body_i: ground, body_j: flat, at: [0, -3, 0.3]}
  - {name: third, type: fixed, body_i: ground, body_j: ending, at: [0, 6, 0.3]}
drivers: [{joint: way, value: 4*t}]
roads:
  - {name: kerb, type: height, height: "0.05*step(x, 1, 0, 1.01, 1)*step(x, 2, 1, 2.01, 0)", at: [0, 0, 0.01]}
  - {name: post, type: height, height: 0.02*sin(3*t)}
  - {name: ends, type: height, height: 0*sqrt(x + 0.2)}
forces:
  - {name: t1, type: tyre, body: wheel, road: kerb, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
  - {name: t2, type: tyre, body: still, road: post, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
  - {name: t5, type: tyre, body: ending, road: ends, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
  - {name: t3, type: tyre, body: flat, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
  - {name: t4, type: tyre, body: flat, radius: 0.31, k: 1e4, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4}
analysis: {type: kinematics, duration: 1, step: 0.1}
output: [{vtk: motion.pvd, every: 0.5}]
END_OF_MODEL
"$program" run -q "$dir/roads.yaml" -o "$dir/roads"
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
    code, scale = {5126: ("f", 1.0), 5122: ("h", 1 / 32767), 5123: ("H", 1)}[a["componentType"]]
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
# A mesh: a point for each of its normals at sharp edges, unit normals that point out; shapes of one
# file and scale share them.
doc, binary = load(sys.argv[1] + "/bracket/scene.glb")
def drawn(body):
    node = next(n for n in doc["nodes"] if n["name"] == body)
    shapes = [doc["nodes"][k] for k in node["children"] if doc["nodes"][k]["name"] == "shape"]
    return [doc["meshes"][n["mesh"]]["primitives"][0] for n in shapes], shapes
(first,), nodes = drawn("bracket")
(second, third), _ = drawn("twin")
assert nodes[0]["scale"] == [1, 1, 1] and "mode" not in first
assert first["attributes"] == second["attributes"] != third["attributes"]
order = [k for k, in values(doc, binary, first["indices"])]
points, normals = ([values(doc, binary, first["attributes"][name])[k] for k in order] for name in ("POSITION", "NORMAL"))
assert len(points) == 60 and max(order) < 40 and set(order) == set(range(max(order) + 1)), order
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
# Gears: their radii, their places, and a gap of one where a tooth of the other is.
doc, binary = load(sys.argv[1] + "/gears/scene.glb")
nodes = doc["nodes"]
kinds = {e["name"]: e["type"] for e in doc["scenes"][0]["extras"]["elements"]}
def turn(q, v):
    x, y, z, w = q
    c = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    u = c([x, y, z], v)
    return [p + 2 * (w * s + r) for p, s, r in zip(v, u, c([x, y, z], u))]
def corners(body, name):
    """Of its part with teeth, in the ground frame at the first pose."""
    parent = next(n for n in nodes if n["name"] == body)
    node = next(n for n in (nodes[k] for k in parent["children"]) if n.get("extras", {}).get("element") == list(kinds).index(name))
    points = values(doc, binary, doc["meshes"][node["mesh"]]["primitives"][0]["attributes"]["POSITION"])
    place = lambda n, p: [a + b for a, b in zip(turn(n["rotation"], p), n["translation"])]
    return [place(parent, place(node, p)) for p in points]
def radii(points, at):
    return sorted({round(((p[0] - at[0]) ** 2 + (p[2] - at[2]) ** 2) ** 0.5, 6) for p in points})
def pitch(points, at, inside=False):
    """Radius of the pitch circle, from tips 1 and roots 1.2 modules away; teeth."""
    all = radii(points, at)
    few = all[:-1] if inside else all[1:] # not what is behind the teeth
    tip, root = (few[0], few[-1]) if inside else (few[-1], few[0])
    module = abs(tip - root) / 2.2
    return tip + module if inside else tip - module, module
for body, name, at, radius, inside in (("a", "outside", [0, 0, 0], .2, False), ("b", "outside", [.3, 0, 0], .1, False),
                                       ("planet", "inside", [.2, 0, .4], .1, False), ("ring", "inside", [.1, 0, .4], .2, True),
                                       ("a", "rack", [0, 0, 0], .12, False)):
    found, module = pitch(corners(body, name), at, inside)
    assert abs(found - radius) < 1e-5 and abs(2 * radius / module - round(2 * radius / module)) < 1e-3, (body, name, found, module)
    checks += 1
tips = lambda body, name, at, r: [p for p in corners(body, name) if abs(((p[0] - at[0]) ** 2 + (p[2] - at[2]) ** 2) ** .5 - r) < 1e-5]
assert all(abs(p[1]) < .05 for body in ("ring", "planet") for p in corners(body, "inside")), "not side by side"
# Tooth of a at x = 0.2, z = 0; none of b there.
_, module = pitch(corners("a", "outside"), [0, 0, 0])
assert min(abs(p[2]) for p in tips("a", "outside", [0, 0, 0], .2 + module) if p[0] > 0) < .2 * 3.15 * module
assert min(abs(p[2]) for p in tips("b", "outside", [.3, 0, 0], .1 + module) if p[0] < .3) > .3 * 3.14 * module
# Bevel gears: both cones have their tips where the axes meet, (0.3, 0, -0.15)... of b the axis is y, of the other one z.
b, v = corners("b", "right"), corners("bevel", "right")
assert b and v and "gear" in {n["name"] for n in nodes} and not any(n["name"] == "link" and "extras" in n for n in nodes)
rack = corners("bar", "rack")
assert max(p[0] for p in rack) - min(p[0] for p in rack) > .12 * .84 + .4 and abs(min(abs(p[2]) for p in rack) - (.12 - .12 / 9)) < 1e-3, "the rack"
# One that is longer than it has teeth; bevel gears whose cones are flat or hollow, with their faces outwards.
far = corners("long", "far_rack")
assert max(p[0] for p in far) > .01 and min(p[0] for p in far) < -2 and len(far) < 30000, (min(p[0] for p in far), len(far))
def volume(body, name):
    parent = next(n for n in nodes if n["name"] == body)
    made = next(n for n in (nodes[k] for k in parent["children"]) if n.get("extras", {}).get("element") == list(kinds).index(name))
    p = doc["meshes"][made["mesh"]]["primitives"][0]
    at = values(doc, binary, p["attributes"]["POSITION"])
    at = [at[k] for k, in values(doc, binary, p["indices"])]
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
               for a, b, c in zip(at[::3], at[1::3], at[2::3])) / 6
for body, name in (("crown", "obtuse"), ("flat", "right_flat"), ("cone", "obtuse"), ("bevel", "right"), ("a", "outside"), ("ring", "inside")):
    assert volume(body, name) > 1e-6, (body, name, volume(body, name))
    checks += 1
# The joints of a vehicle are not larger because it goes far.
doc, _ = load(sys.argv[1] + "/far/scene.glb")
pin = next(n for n in doc["nodes"] if n["name"] == "hitch")
assert .01 < pin["scale"][0] < .1, pin
# Roads: a kerb with its faces and little else, a post that moves, a plane.
doc, binary = load(sys.argv[1] + "/roads/scene.glb")
nodes = doc["nodes"]
roads = [n for n in nodes if n["name"] == "road"]
assert len(roads) == 4, [n["name"] for n in nodes]
surface = lambda n: values(doc, binary, doc["meshes"][n["mesh"]]["primitives"][0]["attributes"]["POSITION"])
kerb, post, ends, plane = roads
height = lambda x: .05 * (x > 1.005) * (x < 2.005)
points = surface(kerb)
assert all(abs(p[2] - height(p[0])) < 1e-6 or abs(p[0] - 1.005) < .011 or abs(p[0] - 2.005) < .011 for p in points), points
assert min(p[0] for p in points) < -.3 and max(p[0] for p in points) > 4.3 and len({p[0] for p in points}) < 16 and len({p[1] for p in points}) == 2
assert abs(kerb["translation"][2] - .01) < 1e-7 and all(abs(p[2]) < 1e-12 for p in surface(plane)) and len(surface(plane)) == 4
moves = [c for c in doc["animations"][0]["channels"] if nodes[c["target"]["node"]] in roads]
assert len(moves) == 1 and nodes[moves[0]["target"]["node"]] is post
sampler = doc["animations"][0]["samplers"][moves[0]["sampler"]]
import math
for (time,), place in zip(values(doc, binary, sampler["input"]), values(doc, binary, sampler["output"])):
    assert abs(place[2] - .02 * math.sin(3 * time)) < 1e-6, (time, place)
    checks += 1
# A road that ends within the rectangle of its wheels is drawn as far as it goes.
p = doc["meshes"][ends["mesh"]]["primitives"][0]
at = surface(ends)
drawn_to = min(at[k][0] for k, in values(doc, binary, p["indices"]))
assert -.2 <= drawn_to < -.19 and max(q[0] for q in at) > .5, drawn_to
# In VTK files the post goes up and down, too.
import re
def vtk_points(path):
    data = open(path, "rb").read()
    tag = re.search(rb'<DataArray[^>]*Name="points"[^>]*>', data).group(0)
    start = data.index(b"_", data.index(b"<AppendedData")) + 1 + int(re.search(rb'offset="(\d+)"', tag).group(1))
    width = 8 if b'header_type="UInt64"' in data else 4
    flat = struct.unpack_from("<%df" % (int.from_bytes(data[start:start + width], "little") // 4), data, start + width)
    return [flat[k:k + 3] for k in range(0, len(flat), 3)]
before, after = (vtk_points(sys.argv[1] + "/roads/motion/bodies_0000%d.vtp" % k) for k in (0, 1))
up = [q[2] - p[2] for p, q in zip(before, after) if p[:2] == q[:2] and p[2] != q[2]]
assert len(up) == 4 and all(abs(z - .02 * math.sin(1.5)) < 1e-6 for z in up), up
# Colours are light, as glTF wants it; opacity and style.
doc, binary = load(sys.argv[1] + "/looks/scene.glb")
made = [doc["materials"][k] for k in range(len(doc["materials"]))]
red = next(m for m in made if m["pbrMetallicRoughness"]["baseColorFactor"][3] == .25)
assert abs(red["pbrMetallicRoughness"]["baseColorFactor"][0] - .214041) < 1e-5 and red["alphaMode"] == "BLEND", red
tube = next(n for n in doc["nodes"] if n["name"] == "tube")
for k in tube["children"]:
    assert made[doc["meshes"][doc["nodes"][k]["mesh"]]["primitives"][0]["material"]]["pbrMetallicRoughness"]["baseColorFactor"][3] == 1, "a tube is not seen"
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
