# SPDX-License-Identifier: BSD-3-Clause
"""URDF: the efforts of a driven arm against Newton's and Euler's laws for the file itself, summed over the
links that a joint carries, and what else becomes of the file."""
import json
import math
import subprocess
import xml.etree.ElementTree as xml

import tool

G = (0.0, 0.0, -9.81)


def vector(text, default=(0.0, 0.0, 0.0)):
    return [float(x) for x in text.split()] if text else list(default)


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def scale(s, a):
    return [s * x for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turn(A, v):
    return [dot(row, v) for row in A]


def times(A, B):
    return [[dot(row, column) for column in zip(*B)] for row in A]


def transpose(A):
    return [list(column) for column in zip(*A)]


def about(axis, angle):
    """Rodrigues' formula."""
    n = scale(1.0 / math.sqrt(dot(axis, axis)), axis)
    c, s = math.cos(angle), math.sin(angle)
    K = [[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]]
    KK = times(K, K)
    return [[(i == j) + s * K[i][j] + (1 - c) * KK[i][j] for j in range(3)] for i in range(3)]


def origin(node):
    at = node.find("origin") if node is not None else None
    xyz = vector(at.get("xyz") if at is not None else None)
    r, p, y = vector(at.get("rpy") if at is not None else None)
    return xyz, times(about([0, 0, 1], y), times(about([0, 1, 0], p), about([1, 0, 0], r)))


def move(robot, q):
    """The state of each link: origin, axes, angular velocity and acceleration, acceleration of the origin; and
    of each joint: point and axis."""
    links, joints = {}, {}
    zero = [0.0, 0.0, 0.0]
    unit = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
    links["world"] = (zero, unit, zero, zero, zero, zero)
    todo = list(robot.findall("joint"))
    while todo:
        joint = todo.pop(0)
        parent = links.get(joint.find("parent").get("link"))
        if parent is None:
            todo.append(joint)
            continue
        r, A, w, al, v, a = parent
        xyz, R = origin(joint)
        d = turn(A, xyz)
        A = times(A, R)
        v = add(v, cross(w, d))
        a = add(a, add(cross(al, d), cross(w, cross(w, d))))
        r = add(r, d)
        x, xd, xdd = q.get(joint.get("name"), (0.0, 0.0, 0.0))
        n = [1.0, 0.0, 0.0]
        if joint.get("type") != "fixed":
            n = vector(joint.find("axis").get("xyz"))
            n = scale(1.0 / math.sqrt(dot(n, n)), n)
        e = turn(A, n)
        if joint.get("type") in ("revolute", "continuous"):
            A = times(A, about(n, x))
            al = add(al, add(scale(xdd, e), cross(w, scale(xd, e))))
            w = add(w, scale(xd, e))
        elif joint.get("type") == "prismatic":
            d = scale(x, e)
            a = add(a, add(cross(al, d), cross(w, cross(w, d))))
            a = add(a, add(scale(2 * xd, cross(w, e)), scale(xdd, e)))
            v = add(v, add(cross(w, d), scale(xd, e)))
            r = add(r, d)
        links[joint.find("child").get("link")] = (r, A, w, al, v, a)
        joints[joint.get("name")] = (r, e)
    return links, joints


def wrench(link, state, point):
    """Force and moment about a point that a link needs to move so."""
    inertial = link.find("inertial")
    if inertial is None:
        return [0.0] * 3, [0.0] * 3
    r, A, w, al, _, a = state
    xyz, R = origin(inertial)
    mass = float(inertial.find("mass").get("value"))
    k = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
    J = [[k["ixx"], k["ixy"], k["ixz"]], [k["ixy"], k["iyy"], k["iyz"]], [k["ixz"], k["iyz"], k["izz"]]]
    R = times(A, R)
    J = times(R, times(J, transpose(R)))
    c = turn(A, xyz)
    ac = add(a, add(cross(al, c), cross(w, cross(w, c))))
    force = scale(mass, add(ac, scale(-1.0, G)))
    arm = add(add(r, c), scale(-1.0, point))
    moment = add(add(turn(J, al), cross(w, turn(J, w))), cross(arm, force))
    return force, moment


def efforts(robot, q):
    links, joints = move(robot, q)
    children = {}
    for joint in robot.findall("joint"):
        children.setdefault(joint.find("parent").get("link"), []).append(joint.find("child").get("link"))
    by_name = {link.get("name"): link for link in robot.findall("link")}
    result = {}
    for joint in robot.findall("joint"):
        if joint.get("type") == "fixed":
            continue
        point, axis = joints[joint.get("name")]
        todo, total = [joint.find("child").get("link")], 0.0
        while todo:
            name = todo.pop()
            todo += children.get(name, [])
            force, moment = wrench(by_name[name], links[name], point)
            total += dot(axis, force if joint.get("type") == "prismatic" else moment)
        dynamics = joint.find("dynamics")
        if dynamics is not None:
            total += float(dynamics.get("damping", "0")) * q[joint.get("name")][1]
        result[joint.get("name")] = total
    return result


def drive(text, names, q):
    drivers = "".join(
        f"  - {{name: drive {n}, joint: {names.get(n, n)}, value: '{x!r} + ({v!r})*t + ({a!r})/2*t^2'}}\n"
        for n, (x, v, a) in q.items())
    channels = ", ".join(f"drive {n}.effort" for n in q).replace("elbow.1", "elbow_1")
    return tool.replace_analysis(
        text, "drivers:\n" + drivers.replace("drive elbow.1", "drive elbow_1") +
        "analysis: {type: inverse_dynamics, duration: 1e-4}\n"
        f"output: [{{file: results.csv, every: 1e-4, channels: [{channels}]}}]\n")


def compare(text, names, robot, q, what):
    """grip_b follows grip_a, so that the driver of grip_a carries both."""
    ratio, offset = -1.5, 0.1
    x, v, a = q["grip_a"]
    all_q = dict(q, grip_b=(ratio * x + offset, ratio * v, ratio * a))
    wanted = efforts(robot, all_q)
    wanted["grip_a"] += ratio * wanted.pop("grip_b")
    table = tool.run("urdf_" + what, drive(text, names, q))
    for name, value in wanted.items():
        column = f"drive {name.replace('.', '_')}.effort"
        tool.near(f"{what}: the effort of {name}", table[column][0], value, 1e-9)


def meshes():
    """A mesh of a package beside the file is found, and seen from the folder of the model."""
    folder = tool.WORK / "ws" / "arm_description"
    (folder / "urdf").mkdir(parents=True, exist_ok=True)
    (folder / "meshes").mkdir(exist_ok=True)
    mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
    (folder / "meshes" / "a.obj").write_text(mesh)
    path = folder / "urdf" / "part.urdf"
    visual = "<visual><geometry><mesh filename='package://arm_description/meshes/{}' scale='{}'/></geometry></visual>"
    path.write_text("<robot name='r'><link name='a'>" + visual.format("a.obj", "2 2 2") +
                    visual.format("a.obj", "1 2 1") + visual.format("b.obj", "1 1 1") +
                    visual.format("c.dae", "1 1 1") + "</link></robot>")
    text, notes = tool.convert(path, code=1)
    tool.check("type: mesh, file: ws/arm_description/meshes/a.obj, scale: 2" in text, f"the mesh: {text}")
    tool.check([n["kind"] for n in notes] == ["lost"] * 3, f"notes are {notes}")
    tool.check("assimp" in notes[2]["message"], "how to convert it")
    tool.convert(path, "--partial")
    (folder / "meshes" / "a.obj").write_text("v 0 0 0\n")
    out = tool.WORK / "broken.yaml"
    done = subprocess.run([tool.PROGRAM, "import", str(path), "-o", str(out), "--json", "--partial"],
                          capture_output=True, text=True, check=False)
    tool.check(done.returncode == 1, f"a broken mesh: exit code {done.returncode}, not 1")
    tool.check("no triangles" in json.loads(done.stdout)["message"], f"a broken mesh: {done.stdout}")
    tool.check("broken.yaml:" in done.stderr, f"the place of a broken mesh: {done.stderr}")
    (folder / "meshes" / "a.obj").write_text(mesh)
    tool.run("urdf_mesh", text + "output: [{file: results.csv, channels: [a.position]}]\n")


def gazebo():
    path = tool.WORK / "gazebo.urdf"
    path.write_text("<robot name='r'><link name='a'/>\n<gazebo reference='a'>\n<mu1>0.3</mu1>\n"
                    "<selfCollide>true</selfCollide></gazebo></robot>")
    _, notes = tool.convert(path)
    told = [(n["line"], n["message"]) for n in notes if "touch only" in n["message"]]
    tool.check([line for line, _ in told] == [3, 4] and "mu1 = 0.3" in told[0][1], f"gazebo: {notes}")


def main():
    gazebo()
    robot = xml.parse(tool.SOURCE / "arm.urdf").getroot()
    states = [{"shoulder": (0.0, 0, 0), "elbow.1": (0.0, 0, 0), "slide": (0.0, 0, 0), "grip_a": (0.0, 0, 0)},
              {"shoulder": (0.7, -1.3, 2.1), "elbow.1": (-1.1, 0.9, -3.0), "slide": (0.25, 0.6, -1.4),
               "grip_a": (0.3, -2.0, 5.0)},
              {"shoulder": (-2.2, 3.0, -7.0), "elbow.1": (2.9, -2.0, 4.0), "slide": (-0.5, -0.8, 2.0),
               "grip_a": (-0.4, 1.0, 9.0)}]
    for options in ((), ("--merge-fixed",)):
        text, notes = tool.convert("arm.urdf", *options)
        tool.check([n["kind"] for n in notes] == ["note", "named"], f"notes are {notes}")
        tool.check(notes[1]["line"] == 38 and "`elbow_1`" in notes[1]["message"], "the name is not told")
        names = {"elbow.1": "elbow_1"}
        for k, q in enumerate(states):
            compare(text, names, robot, q, f"{'merged' if options else 'apart'}{k}")
    tool.check("name: tool" in text and "name: camera" in text, "merged links are markers")
    tool.check("lower: -2.5, upper: 2.5, k: stop_k_angle" in text, "the stop")
    free, _ = tool.convert("arm.urdf", "--free-base")
    tool.check("fixed: true" in free, "a base on the world stays there")
    meshes()
    # it runs with what it has
    text, _ = tool.convert("arm.urdf")
    table = tool.run("urdf_free", text + "output: [{file: results.csv, channels: [energy.balance]}]\n",
                     "--tolerance", "1e-10")
    values = table["energy.balance"]
    tool.near("the energy", max(values) - min(values), 0.0, 1e-6)
    print("import.urdf: passed")


if __name__ == "__main__":
    main()
