# SPDX-License-Identifier: BSD-3-Clause
# What the `output` of a model asks for: VTK series that VTK itself reads, plots, scenes; one that fails does not
# lose the others.
set -u
. "${SE3D_SOURCE_DIR:-.}/tests/support/cli.sh"
export SE3D_VIEWER="$source/tools/viewer" SE3D_CACHE="${SE3D_BUILD_DIR:-$dir}/viewer" SE3D_CHROMIUM="$dir/none"
cat >"$dir/head.yaml" <<'END_OF_YAML'
se3d: 1
title: A bar, a block on a spring
bodies:
  - name: bar
    mass: 2
    inertia: [0.1, 1, 1]
    position: [1, 0, 0]
    shapes: [{type: box, size: [2, 0.1, 0.2]}, {type: sphere, radius: 0.2, position: [1, 0, 0]}]
  - {name: block, mass: 1, inertia: [1, 1, 1], position: [0, 2, -1], shapes: [{type: box, size: [0.5, 0.5, 0.5]}]}
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 1, 0]}
  - {name: slide, type: prismatic, body_i: ground, body_j: block, at: [0, 2, 0], axis: [0, 0, 1]}
forces:
  - {name: spring, type: tsda, body_i: ground, body_j: block, point_i: [0, 2, 0], k: 100, l0: 1}
END_OF_YAML
model() { { cat "$dir/head.yaml"; echo 'analysis: {type: dynamics, duration: 1, step: 0.01}'; echo 'output:'; cat; } >"$dir/$1.yaml"; }

model vtk <<'END_OF_YAML'
  - {file: all.csv, channels: [bar.position, bar.orientation, bar.velocity, block.position, spring.length]}
  - {vtk: motion.pvd, every: 0.125}
END_OF_YAML
expect 'a series' 0 "$program" run "$dir/vtk.yaml" -o "$dir/vtk"
holds "no word of it in $(cat "$dir/out")" grep -qF "wrote $dir/vtk/motion.pvd: 9 times" "$dir/out"
holds 'something unfinished is left' [ -z "$(find "$dir/vtk" -name '*.partial')" ]
"$program" run -q "$source/examples/models/pushed_grains.yaml" -o "$dir/grains.csv.run"
sed 's/^output:/output:\n  - {vtk: "g\&1.pvd", every: 0.25, fields: {lower: [-9, -9, -9], upper: [9, 9, 9.5], cells: [4, 5, 6], width: 0.1}}\n  - {average: mean.csv, every: 0.25, start: 0.25, stop: 0.75, fields: {lower: [-9, -9, -9], upper: [9, 9, 9.5], cells: [4, 5, 6], width: 0.1}}/' "$source/examples/models/pushed_grains.yaml" >"$dir/grains.yaml"
expect 'grains' 0 "$program" run "$dir/grains.yaml" -o "$dir/grains"
cat >"$dir/read.py" <<'END_OF_PYTHON'
import csv, os, sys, vtk
import xml.etree.ElementTree as xml
folder = sys.argv[1]
def read(path):
    reader = vtk.vtkXMLImageDataReader() if path.endswith(".vti") else vtk.vtkXMLPolyDataReader()
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append(path))
    reader.SetFileName(path)
    reader.Update()
    assert not problems, problems
    return reader.GetOutput()
def sets(path):
    return [(float(d.get("timestep")), d.get("name"), os.path.join(os.path.dirname(path), d.get("file")))
            for d in xml.parse(path).getroot().iter("DataSet")]
series = sets(folder + "/vtk/motion.pvd")
assert [s[0] for s in series] == [k * 0.125 for k in range(9)], series
rows = {round(float(r["time"]), 9): r for r in csv.DictReader(open(folder + "/vtk/all.csv"))}
sphere, ball, box, cylinder, cone, spring = 17 * 33, 11 * 21, 24, 2 * 33 + 2 * 32, 2 * 33 + 32, 131 * 6
round_faces, cone_faces = 2 * 32 + 2 * 30, 2 * 32 + 30
ground = 2 * cylinder + 3 * (cone + box)
checks = 0
for time, name, path in series:
    data = read(path)
    # ground: eye, rail and three feet; bar: box, sphere, pin; block: box, slide, and a bar with a round end, a small
    # sphere, from one to the other; the spring: a wire of rings of 6
    assert data.GetNumberOfPoints() == ground + 3 * box + sphere + ball + 2 * cylinder + spring, data.GetNumberOfPoints()
    assert data.GetNumberOfLines() == data.GetNumberOfVerts() == 0
    assert data.GetNumberOfPolys() == 6 * 12 + 2 * 16 * 32 + 2 * 10 * 20 + 4 * round_faces + 3 * cone_faces + 130 * 12, data.GetNumberOfPolys()
    bodies = [data.GetCellData().GetArray("body").GetValue(k) for k in range(data.GetNumberOfCells())]
    assert set(bodies) == {-1, 0, 1, 2} and bodies.count(2) == 2 * 12 + round_faces + 2 * 10 * 20 and bodies.count(-1) == 130 * 12, bodies.count(2)
    points = data.GetPoints()
    near = [r for t, r in rows.items() if abs(t - time) < 1e-9]
    if near:  # the bar's box is first: its corners' middle is the bar's origin, its first corner turns with it
        r = {k: float(v) for k, v in near[0].items()}
        middle = [sum(points.GetPoint(ground + k)[i] for k in range(box)) / box for i in range(3)]
        assert max(abs(a - r["bar.position." + c]) for a, c in zip(middle, "xyz")) < 1e-5, (time, middle)
        speed = data.GetPointData().GetArray("velocity")
        mean = [sum(speed.GetTuple(ground + k)[i] for k in range(box)) / box for i in range(3)]
        assert max(abs(a - r["bar.velocity." + c]) for a, c in zip(mean, "xyz")) < 1e-5, (time, mean)
        pin = range(ground + box + sphere, ground + box + sphere + cylinder)  # it stands still
        assert all(abs(sum(speed.GetTuple(k)[i] for k in pin)) / cylinder < 0.02 for i in range(3)), time
        ends = [[sum(points.GetPoint(data.GetNumberOfPoints() - spring + k + i)[c] for i in range(6)) / 6 for c in range(3)]
                for k in (0, 130 * 6)]
        length = sum((a - b) ** 2 for a, b in zip(*ends)) ** 0.5
        assert abs(length - r["spring.length"]) < 1e-5, (time, length)
        checks += 3
assert checks >= 9, checks
series = sets(folder + "/grains/g&1.pvd")
snapshots = [n for n in os.listdir(folder + "/grains") if n.endswith(".csv")]
table = next(list(csv.DictReader(open(folder + "/grains/" + n))) for n in sorted(snapshots)
             if open(folder + "/grains/" + n).readline().startswith("time,id,radius"))
# Averages over time: of mass, momentum and its flux, from the fields of three times.
pairs = (0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)
sums = [[0.0] * 18 for _ in range(120)]
used = 0
for time, name, path in series:
    if name == "fields" and 0.25 - 1e-9 < time < 0.75 + 1e-9:
        arrays = read(path).GetCellData()
        used += 1
        for k in range(120):
            get = lambda n: arrays.GetArray(n).GetTuple(k)
            rho, u = get("density")[0], get("velocity")
            kinetic = [a + rho * u[i] * u[j] for a, (i, j) in zip(get("kinetic_stress"), pairs)]
            for n, a in enumerate([rho, *get("solid_fraction"), *(rho * c for c in u), 0, *kinetic, *get("contact_stress")]):
                sums[k][n] += a / 3
assert used == 3, used
lines = list(csv.reader(open(folder + "/grains/mean.csv")))
assert len(lines) == 121 and lines[0][:5] == ["x", "y", "z", "density", "solid_fraction"], lines[0]
assert max(abs(float(a) - b) for a, b in zip(lines[2], (-2.25, -7.2, -9 + 18.5 / 12))) < 1e-12, lines[2]
moving = 0
for line, s in zip(lines[1:], sums):
    rho, u = s[0], [c / s[0] if s[0] > 0 else 0 for c in s[2:5]]
    kinetic = [a - rho * u[i] * u[j] for a, (i, j) in zip(s[6:12], pairs)]
    warm = sum(kinetic[:3]) / 3 / rho if rho > 0 else 0
    for a, b in zip(line[3:], [rho, s[1], *u, warm, *kinetic, *s[12:]]):
        assert abs(float(a) - b) < 1e-5 * abs(b) + 1e-7 * (1 + max(map(abs, s))), (line, s)
    moving += rho > 0 and max(map(abs, u)) > 1e-3
assert moving > 0
checks += moving
for time, name, path in series:
    if name not in ("grains", "fields"):
        continue
    data = read(path)
    now = [r for r in table if abs(float(r["time"]) - time) < 1e-9]
    if name == "fields":  # sums over the cells are those over the particles
        assert data.GetDimensions() == (5, 6, 7) and data.GetOrigin() == (-9, -9, -9), data.GetOrigin()
        cell = data.GetSpacing()[0] * data.GetSpacing()[1] * data.GetSpacing()[2]
        assert abs(cell - 18 * 18 * 18.5 / 120) < 1e-12, cell
        arrays = data.GetCellData()
        assert arrays.GetArray("contact_stress").GetNumberOfComponents() == 6
        solid = sum(arrays.GetArray("solid_fraction").GetValue(k) for k in range(120)) * cell
        volumes = [4 / 3 * 3.141592653589793 * float(r["radius"]) ** 3 for r in now]
        assert not now or abs(solid / sum(volumes) - 1) < 1e-6, (solid, sum(volumes))
        checks += len(now) > 0
        continue
    if now:
        assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == len(now), (time, len(now))
        for k in range(0, len(now), 7):
            place = data.GetPoints().GetPoint(k)
            assert max(abs(a - float(now[k][c])) for a, c in zip(place, "xyz")) < 1e-6
            assert abs(data.GetPointData().GetArray("radius").GetValue(k) - float(now[k]["radius"])) < 1e-8
            assert data.GetPointData().GetArray("id").GetValue(k) == int(now[k]["id"])
            w = data.GetPointData().GetArray("angular_velocity").GetTuple(k)
            assert max(abs(a - float(now[k]["w" + c])) for a, c in zip(w, "xyz")) < 1e-4
            checks += 4
assert checks > 30, checks
END_OF_PYTHON
name='VTK'
python=
for candidate in python3 /usr/bin/python3; do
    "$candidate" -c 'import vtk' 2>/dev/null && python=$candidate
done
if [ -n "$python" ]; then
    holds 'does not read it back as it was' "$python" "$dir/read.py" "$dir"
else
    echo 'SKIPPED: no python3-vtk9: the series were not read back' >&2
fi

# The map of a wall, of the contacts of its five rows: triangle 1 is where y < x in the frame of the tray.
printf 'v %s 0\n' '-0.1 -0.1' '0.1 -0.1' '0.1 0.1' '-0.1 0.1' >"$dir/floor.obj"
printf 'f %s\n' '1 2 3' '1 3 4' >>"$dir/floor.obj"
cat >"$dir/wall.yaml" <<'END_OF_YAML'
se3d: 1
contact: {law: hooke}
materials: [{name: stone, density: 2500, stiffness: 2e4, friction: 0.3}]
particles:
  - {material: stone, radius: [0.008, 0.014], lower: [-0.08, -0.08, 0.01], upper: [0.08, 0.08, 0.06], count: 40, seed: 2}
bodies:
  - {name: tray, position: [0, 0, 0.5], mass: 1, inertia: [1, 1, 1],
     shapes: [{name: floor, type: mesh, file: floor.obj, position: [0, 0, -0.5], material: stone}]}
joints: [{name: rail, type: prismatic, body_i: ground, body_j: tray, at: [0, 0, 0], axis: [1, 0, 0]}]
drivers: [{name: shake, joint: rail, value: 0.01*sin(20*t)}]
analysis: {type: dynamics, duration: 0.4}
output:
  - {file: contacts.csv, every: 0.05, contacts: true}
  - {wall_map: wall.csv, shape: floor, every: 0.05, start: 0.1, stop: 0.3}
END_OF_YAML
expect 'the map of a wall' 0 "$program" run -q "$dir/wall.yaml" -o "$dir/wall"
cat >"$dir/wall.awk" <<'END_OF_AWK'
function differs(a, b) { return (a - b) ^ 2 > 1e-18 * b ^ 2 }
FILENAME ~ /contacts.csv/ && $4 == "floor" && $1 > 0.0999 && $1 < 0.3001 {
    t = $6 < $5 - 0.01 * sin(20 * $1) ? 2 : 3
    pressure[t] += $12 / 0.02 / 5
    shear[t] += $13 / 0.02 / 5
    ++contacts
}
FILENAME ~ /wall.csv/ && FNR == 1 { head = $0 }
FILENAME ~ /wall.csv/ && FNR > 1 {
    bad += differs($1, 0.1 / 3 * (5 - 2 * FNR)) || differs($3, -0.5) || differs($4, 0.02)
    bad += differs($5, pressure[FNR]) || differs($6, shear[FNR]) || $9 <= 0
    ++lines
}
END { exit !(head == "x,y,z,area,pressure,shear.x,shear.y,shear.z,sliding" && lines == 2 && contacts > 40 && !bad) }
END_OF_AWK
holds "is not the mean of its contacts: $(cat "$dir/wall/wall.csv")" \
    awk -F, -f "$dir/wall.awk" "$dir/wall/contacts.csv" "$dir/wall/wall.csv"
expect 'the chute' 0 "$program" run -q "$source/examples/models/chute.yaml" -o "$dir/chute"
holds 'the stream does not gain speed' awk -F, 'NR > 1 && $4 > 40 && $3 < 0.06 && $6 < 0.5 {++slow}
    NR > 1 && $4 > 40 && $6 > 0.95 && $1 > 0.05 {++fast} END {exit !(slow == 1 && fast >= 1)}' "$dir/chute/flow.csv"
holds 'the floor does not wear below the source' awk -F, 'NR > 1 {sum[$1 < -0.05 && $1 > -0.1] += $9 * ($1 > 0.075 || $1 < -0.05 && $1 > -0.1)}
    END {exit !(NR == 41 && sum[1] > 5 * sum[0] && sum[0] > 0)}' "$dir/chute/wear.csv"
mkdir "$dir/blocked"
: >"$dir/blocked/motion"
expect 'a folder of a series that cannot be made' 1 "$program" run "$dir/vtk.yaml" -o "$dir/blocked"
says 'blocked/motion.pvd: cannot be written: Not a directory'
holds 'the CSV file is lost' [ "$(wc -l <"$dir/blocked/all.csv")" -eq 102 ]
holds 'a list of nothing' [ ! -e "$dir/blocked/motion.pvd" ]
expect 'a full disk' 1 sh -c 'trap "" XFSZ; ulimit -f 30; exec "$@"' sh "$program" run "$dir/vtk.yaml" -o "$dir/full"
says 'File too large'
holds 'something unfinished is left' [ -z "$(find "$dir/full" -name '*.partial')" ]
mkdir "$dir/small"
if mount -t tmpfs -o size=600k tmpfs "$dir/small" 2>/dev/null; then
    trap 'umount "$dir/small"; rm -rf "$dir"' EXIT
    expect 'a full file system' 1 "$program" run "$dir/vtk.yaml" -o "$dir/small/run"
    says 'No space left on device'
    holds 'something unfinished is left' [ -z "$(find "$dir/small" -name '*.partial')" ]
    list=$dir/small/run/motion.pvd
    sed -n 's/.* file="\([^"]*\)".*/\1/p' "$list" | sort >"$dir/listed"
    (cd "$dir/small/run" && find motion -type f | sort) >"$dir/kept"
    holds 'the list of a series is lost' [ -s "$dir/listed" ]
    holds 'the list is not that of the files' cmp -s "$dir/listed" "$dir/kept"
    holds 'the list is not whole' [ "$(tail -n 1 "$list")" = '</VTKFile>' ]
else
    echo 'SKIPPED: no file system can be mounted: only limits of files were tested' >&2
fi

model plots <<'END_OF_YAML'
  - {plot: angle.svg, from: b.csv}
  - {file: a.csv, channels: [bar.position, pin.force]}
  - {file: b.csv, channels: [pin.angle, pin.rate]}
  - {plot: phase.png, from: b.csv, x: pin.angle, channels: [pin.rate]}
  - {plot: parts.svg, channels: [pin, bar.position.z]}
  - {scene: motion.glb}
  - {video: motion.mp4, speed: 4}
END_OF_YAML
if command -v gnuplot >/dev/null 2>&1; then
    expect 'a film that cannot be made' 1 "$program" run "$dir/plots.yaml" -o "$dir/plots"
    says 'apt-get install --no-install-recommends chromium'
    for file in angle.svg angle.png phase.svg phase.png parts.svg parts.png motion.glb scene.glb a.csv b.csv; do
        holds "no $file" [ -s "$dir/plots/$file" ]
    done
    holds 'the phase plot has another axis' grep -qF "set xlabel 'pin.angle [rad]'" "$dir/plots/phase.gp"
    holds 'the default results are not the first' grep -qF "'a.csv'" "$dir/plots/parts.gp"
    holds 'not all of the pin' grep -qF "'pin: force [N]'" "$dir/plots/parts.gp"
    holds 'a film is left' [ ! -e "$dir/plots/motion.mp4" ]
    (cd "$dir" && "$program" plot -q plots.yaml >out 2>err)
    name='a plot straight from a model'
    holds 'fails' [ $? -eq 0 ]
    holds 'lacks what the model asks for' [ -s "$dir/results/plots/parts.svg" ]
    (cd "$dir" && "$program" plot -q vtk.yaml -y spring.length -o direct.svg >out 2>err)
    holds 'with a channel fails' [ -s "$dir/direct.png" ]
else
    echo 'SKIPPED: no gnuplot: no plots were drawn' >&2
fi
model only <<'END_OF_YAML'
  - {scene: motion.glb}
END_OF_YAML
expect 'a scene alone' 0 "$program" run --json "$dir/only.yaml" -o "$dir/only"
holds 'has no results beside it' [ -s "$dir/only/results.csv" -a -s "$dir/only/motion.glb" ]
holds "JSON says otherwise: $(cat "$dir/out")" grep -qF '"pictures": ["motion.glb"]' "$dir/out"
finish
