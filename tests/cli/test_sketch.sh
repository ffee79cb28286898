# SPDX-License-Identifier: BSD-3-Clause
# se3d sketch: what the picture has of a model, by its structure; names that are not for XML.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
expect 'help' 0 "$program" sketch --help
expect 'no model' 2 "$program" sketch
expect 'a wrong model' 2 "$program" sketch "$dir/none.yaml"
expect 'a view in words' 2 "$program" sketch "$models/fourbar.yaml" --view above
says 'must be AZIMUTH,ELEVATION'
expect 'no folder' 1 "$program" sketch "$models/fourbar.yaml" -o "$dir/none/a.svg"
says 'cannot be written'
expect 'a file' 0 "$program" sketch -q "$models/fourbar.yaml" -o "$dir/fourbar.svg"
"$program" sketch "$models/fourbar.yaml" -o - >"$dir/printed.svg" || holds 'printed' false
holds 'another picture on standard output' cmp -s "$dir/fourbar.svg" "$dir/printed.svg"
(cd "$dir" && "$program" sketch - <"$models/fourbar.yaml" >piped.svg)
holds 'no picture through a pipe' grep -q '^</svg>' "$dir/piped.svg"
holds 'a file of that name' [ ! -e "$dir/-.svg" ]
cat >"$dir/look.py" <<'END_OF_PYTHON'
import re, subprocess, sys, xml.dom.minidom as xml
program, models, folder = sys.argv[1:]
checks = failures = 0


def check(holds, text):
    global checks, failures
    checks += 1
    if not holds:
        failures += 1
        print("failed:", text, file=sys.stderr)


def draw(path, *words):
    out = folder + "/out.svg"
    code = subprocess.run([program, "sketch", "-q", path, "-o", out, *words]).returncode
    check(code == 0, f"{path}: exit code {code}")
    return xml.parse(out)


def groups(page, kind):
    return [g for g in page.getElementsByTagName("g") if kind in g.getAttribute("class").split()]


def titles(list):
    return [g.getElementsByTagName("title")[0].firstChild.data for g in list]


def texts(page, kind):
    return [t.firstChild.data for t in page.getElementsByTagName("text") if t.getAttribute("class") == kind]


def center(group, kind="circle"):
    c = group.getElementsByTagName(kind)[0]
    return float(c.getAttribute("cx")), float(c.getAttribute("cy"))


# A square of four bars in the plane x, y, seen along its pins: x to the right, y upwards.
page = draw(models + "/fourbar.yaml")
joints = groups(page, "revolute")
check(titles(groups(page, "body")) == ["left", "right", "coupler"], "bodies")
check(titles(joints) == ["O", "Q", "A", "B"] and texts(page, "letter") == ["A", "B", "C", "D"], "joints have letters")
check(texts(page, "number") == ["1", "2", "3"], "bodies have numbers")
places = dict(zip(titles(joints), map(center, joints)))
check(abs(places["O"][1] - places["Q"][1]) < 0.1 and places["O"][0] < places["Q"][0], f"the ground is level: {places}")
check(abs(places["O"][0] - places["A"][0]) < 0.1 and places["A"][1] < places["O"][1], "A is above O")
check(abs((places["Q"][0] - places["O"][0]) - (places["O"][1] - places["A"][1])) < 0.1, "a square is one")
check(all(abs(x) <= 760 and abs(y) <= 620 for x, y in places.values()), "all is on the sheet")
check("Degrees of freedom: 1" in texts(page, "head"), f"{texts(page, 'head')}")
check(any("20 equations of rank 17" in t for t in texts(page, "small")), "equations")
check(any(t.startswith("C") and "A: revolute 1-3, leaves 1" in t for t in texts(page, "small")), f"{texts(page, 'small')}")
check([len([g for g in j.getElementsByTagName("line") if g.getAttribute("class") == "hatch"]) for j in joints] == [5, 5, 0, 0], "two joints on the ground")
# From the side its pins are bearings along an axis, and nothing is a circle with a point.
side = draw(models + "/fourbar.yaml", "--view", "-90,0")
check(all(j.getElementsByTagName("path") and not j.getElementsByTagName("circle") for j in groups(side, "revolute")), "bearings")

page = draw(models + "/suspension.yaml")
check(len(groups(page, "joint")) == 12 == len(texts(page, "letter")), "every joint of a suspension")
check(len(groups(page, "body")) == 9 and len(groups(page, "force")) == 1, "its bodies and spring")
check({"Constraints", "Drivers", "Forces"} <= set(texts(page, "head")), "lists")
spots = [t for t in page.getElementsByTagName("text") if t.getAttribute("class") == "letter"]
check(len({(t.getAttribute("x"), t.getAttribute("y")) for t in spots}) == 12, "no letter upon another")

# Every joint and pair has a symbol; a body alone, masses of nothing, numbers that are large.
kinds = ["fixed", "revolute", "prismatic", "cylindrical", "spherical", "universal", "planar", "screw", "point_on_line", "point_on_plane", "distance"]
hostile = ["<b>&amp", "a>b", "-->", "é字", "--><script>", "x" * 100, "&#0", "%s%n", "a b", "1", "#"]
with open(folder + "/kinds.yaml", "w") as file:
    file.write("se3d: 1\ntitle: '</title><script>alert(1)</script>'\nbodies:\n")
    for k, _ in enumerate(kinds):
        file.write(f"  - {{name: b{k}, mass: 1, inertia: [1, 1, 1], position: [{k}e3, 0, 1]}}\n")
    file.write("joints:\n")
    for k, kind in enumerate(kinds):
        more = {"distance": f"point_i: [{k}e3, 0, 0], point_j: [0, 0, 0], distance: 1", "screw": f"at: [{k}e3, 0, 0], axis: [0, 0, 1], pitch: 0.1",
                "universal": f"point_i: [{k}e3, 0, 0], point_j: [0, 0, -1], axis_i: [1, 0, 0], axis_j: [0, 1, 0]", "spherical": f"at: [{k}e3, 0, 0]", "fixed": f"at: [{k}e3, 0, 0]",
                "point_on_line": f"point_i: [{k}e3, 0, 0], axis_i: [1, 0, 0], point_j: [0, 0, -1]",
                "point_on_plane": f"point_i: [{k}e3, 0, 0], axis_i: [0, 0, 1], point_j: [0, 0, -1]"}.get(kind, f"at: [{k}e3, 0, 0], axis: [0, 0, 1]")
        name = hostile[k].replace("'", "''")
        file.write(f"  - {{name: '{name}', type: {kind}, body_i: ground, body_j: b{k}, {more}}}\n")
page = draw(folder + "/kinds.yaml")
check(titles(groups(page, "joint")) and sorted(titles(groups(page, "joint"))) == sorted(hostile), f"names: {titles(groups(page, 'joint'))}")
for kind in kinds:
    check(len(groups(page, kind)) == 1 and len(groups(page, kind)[0].childNodes) > 3, f"a symbol of {kind}")
check(not page.getElementsByTagName("script") and page.getElementsByTagName("title")[0].firstChild.data.startswith("</title>"), "no script")
# Nothing lies outside of the sheet or below its lists; shapes have outlines; long lists have columns.
for name, shapes in [("models/pendulum_events", 1), ("models/heap", 12), ("models/hopper", 2), ("models/rotating_drum", 1), ("models/fourbar", 0), ("fsae/four_post", 20)]:
    page = draw(models + "/../" + name + ".yaml")
    sheet = page.documentElement
    columns = {float(t.getAttribute("x")) for t in page.getElementsByTagName("text") if t.getAttribute("class") in ("head", "small")} - {
        float(t.getAttribute("x")) for g in page.getElementsByTagName("g") for t in g.getElementsByTagName("text")}
    width, height = float(sheet.getAttribute("width")), float(sheet.getAttribute("height"))
    spots = []
    for line in page.getElementsByTagName("line"):
        spots += [(float(line.getAttribute("x" + k)), float(line.getAttribute("y" + k))) for k in "12"]
    for path in page.getElementsByTagName("path"):
        numbers = [float(x) for x in re.findall(r"-?[0-9.]+", path.getAttribute("d"))]
        spots += list(zip(numbers[::2], numbers[1::2]))
    check(len(spots) > 10 and all(0 < x < min(columns) and 0 < y < height for x, y in spots), f"{name}: {min(spots)} to {max(spots)}, {columns}")
    lowest = max(float(t.getAttribute("y")) for t in page.getElementsByTagName("text"))
    check(lowest < height and max(columns) + 300 < width, f"{name}: the lists end at {max(columns)}, {lowest}")
    check(len(columns) == (3 if "fsae" in name else 1), f"{name}: columns {columns}")
    check(len(groups(page, "shape")) >= shapes and bool(groups(page, "shape")) == (shapes > 0), f"{name}: {len(groups(page, 'shape'))} bodies with shapes")
with open(folder + "/alone.yaml", "w") as file:
    file.write("se3d: 1\nbodies: [{name: alone, mass: 1, inertia: [1, 1, 1]}]\n")
check("Degrees of freedom: 6" in texts(draw(folder + "/alone.yaml"), "head"), "a body alone")
print(f"{checks} checks, {failures} failed")
sys.exit(failures > 0)
END_OF_PYTHON
expect 'pictures' 0 python3 "$dir/look.py" "$program" "$models" "$dir"
cat "$dir/err" >&2
expect 'its own name' 0 sh -c 'cd "$1" && "$0" sketch alone.yaml' "$program" "$dir"
has "$dir/out" 'wrote alone.svg'
finish
