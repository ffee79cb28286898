# SPDX-License-Identifier: BSD-3-Clause
"""SDF: the arm of arm.urdf, said in several ways of SDF, against equations of motion that are written from the
URDF file; a four-bar against its closed form; the types of joints, and what cannot be carried."""
import math
import subprocess
import xml.etree.ElementTree as xml

import check_urdf
import tool


def numbers(values):
    return " ".join(repr(float(x)) for x in values)


def rpy_of(A):
    return [math.atan2(A[2][1], A[2][2]), math.asin(-A[2][0]), math.atan2(A[1][0], A[0][0])]


def quaternion_of(A):
    w = math.sqrt(1.0 + A[0][0] + A[1][1] + A[2][2]) / 2.0
    return [(A[2][1] - A[1][2]) / (4 * w), (A[0][2] - A[2][0]) / (4 * w), (A[1][0] - A[0][1]) / (4 * w), w]


def pose(r, A, how, attributes=""):
    if how == "degrees":
        return f"<pose {attributes} degrees='true'>{numbers(r + [math.degrees(x) for x in rpy_of(A)])}</pose>"
    if how == "quaternion":
        return f"<pose {attributes} rotation_format='quat_xyzw'>{numbers(r + quaternion_of(A))}</pose>"
    return f"<pose {attributes}>{numbers(r + rpy_of(A))}</pose>"


def inertial_of(link):
    node = link.find("inertial")
    if node is None:
        return "<inertial><mass>0</mass><inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia></inertial>"
    moments = "".join(f"<{k}>{v}</{k}>" for k, v in node.find("inertia").attrib.items())
    return (f"<inertial>{pose(*check_urdf.origin(node), 'rpy')}<mass>{node.find('mass').get('value')}</mass>"
            f"<inertia>{moments}</inertia></inertial>")


def axis_of(joint, A, how):
    node = joint.find("axis")
    if node is None or joint.get("type") == "fixed":
        return ""
    v = check_urdf.vector(node.get("xyz"))
    parts = f"<xyz>{numbers(check_urdf.turn(A, v) if how == 'old' else v)}</xyz>"
    if how == "expressed":
        parts = f"<xyz expressed_in='__model__'>{numbers(check_urdf.turn(A, v))}</xyz>"
    limit, dynamics, mimic = (joint.find(k) for k in ("limit", "dynamics", "mimic"))
    if limit is not None:
        parts += "<limit>" + "".join(f"<{k}>{v}</{k}>" for k, v in limit.attrib.items()) + "</limit>"
    if dynamics is not None:
        parts += f"<dynamics><damping>{dynamics.get('damping')}</damping></dynamics>"
    if mimic is not None:
        parts += (f"<mimic joint='{mimic.get('joint')}' axis='axis'><multiplier>{mimic.get('multiplier')}</multiplier>"
                  f"<offset>{float(mimic.get('offset')) - 0.3}</offset><reference>0.2</reference></mimic>")
    return f"<axis>{parts}</axis>"


def sdf_of(robot, how):
    """Poses in the model, each in its own way; or from link to joint to link."""
    links, _ = check_urdf.move(robot, {})
    of_child = {j.find("child").get("link"): j for j in robot.findall("joint")}
    text = ""
    for link in robot.findall("link"):
        name = link.get("name")
        if name == "world":
            continue
        r, A = links[name][:2]
        at = f"<pose relative_to='{of_child[name].get('name')}'/>" if how == "chain" else pose(r, A, how)
        text += f"<link name='{name}'>{at}{inertial_of(link)}</link>\n"
    for joint in robot.findall("joint"):
        parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
        at = ""
        if how == "chain":
            base = "__model__" if parent == "world" else parent
            at = pose(*check_urdf.origin(joint), "rpy", f"relative_to='{base}'")
        kind = joint.get("type")
        text += (f"<joint name='{joint.get('name')}' type='{kind}'>{at}<parent>{parent}</parent>"
                 f"<child>{child}</child>{axis_of(joint, links[child][1], how)}</joint>\n")
    version = "1.4" if how == "old" else "1.11"
    return (f"<sdf version='{version}'><world name='w'><gravity>0 0 -9.81</gravity>"
            f"<model name='arm'>{text}</model></world></sdf>")


def arm():
    robot = xml.parse(tool.SOURCE / "arm.urdf").getroot()
    q = {"shoulder": (0.7, -1.3, 2.1), "elbow.1": (-1.1, 0.9, -3.0), "slide": (0.25, 0.6, -1.4),
         "grip_a": (0.3, -2.0, 5.0)}
    tool.WORK.mkdir(parents=True, exist_ok=True)
    for how in ("rpy", "degrees", "quaternion", "chain", "expressed", "old"):
        path = tool.WORK / f"arm_{how}.sdf"
        path.write_text(sdf_of(robot, how))
        text, notes = tool.convert(path)
        tool.check([n["kind"] for n in notes] == ["named"], f"{how}: notes are {notes}")
        check_urdf.compare(text, {"elbow.1": "elbow_1"}, robot, q, "sdf_" + how)
    tool.check("lower: -2.5, upper: 2.5, k: stop_k_angle" in text, "the stop")


def four_bar():
    """The angle of the rocker from the triangles of the four points of the file."""
    text, notes = tool.convert("loop.sdf")
    tool.check(all(n["kind"] == "note" for n in notes), f"notes are {notes}")
    tool.check("name: floor_link" in text and "type: plane" in text, "the floor")
    tool.check("name: B" in text, "frames are markers")
    A, B, C, D = (0.0, 0.0), (0.05, 0.0866), (0.36, 0.28), (0.4, 0.0)
    a, b, c, d = math.dist(A, B), math.dist(B, C), math.dist(C, D), math.dist(A, D)

    def rocker(crank):
        x, y = a * math.cos(crank), a * math.sin(crank)
        e = math.hypot(d - x, y)
        beta = math.atan2(y, x - d)
        return beta - math.acos((c * c + e * e - b * b) / (2 * c * e))

    start = math.atan2(B[1], B[0])
    analysis = ("drivers: [{name: motor, joint: bars_A_pin, value: 3*t}]\n"
                "analysis: {type: kinematics, duration: 2, step: 0.1}\n"
                "output: [{file: results.csv, every: 0.1, channels: [bars_D_pin.angle, bars_rocker.position]}]\n")
    table = tool.run("sdf_loop", tool.replace_analysis(text, analysis))
    tool.near("the first angle", rocker(start), math.atan2(C[1] - D[1], C[0] - D[0]), 1e-14)
    for t, angle in zip(table["time"], table["bars_D_pin.angle"]):
        off = angle - (rocker(start + 3 * t) - rocker(start))
        tool.near(f"the rocker at {t} s", math.remainder(off, 2 * math.pi), 0.0, 1e-9)
    # the rocker's origin in the ground: the quaternion of the model by Hamilton's product
    x, y, z, w = (k / math.sqrt(0.95) for k in (0.1, -0.2, 0.3, 0.9))
    v = (0.38, 0.14, 0.0)
    u = [2 * s for s in (y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0])]
    turned = [v[0] + w * u[0] + y * u[2] - z * u[1], v[1] + w * u[1] + z * u[0] - x * u[2],
              v[2] + w * u[2] + x * u[1] - y * u[0]]
    for k, axis in enumerate("xyz"):
        tool.near("the rocker's place", table[f"bars_rocker.position.{axis}"][0], (1, 2, 3)[k] + turned[k], 1e-14)


BODY = ("<inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia></inertial>")
AXIS = "<axis><xyz>0 0 1</xyz></axis>"
SECOND = "<axis2><xyz>1 0 0</xyz></axis2>"
SLOW = "<axis2><xyz>1 0 0</xyz><dynamics><damping>0.5</damping></dynamics></axis2>"


def one(name, parts, attributes="", more="", code=0):
    path = tool.WORK / f"{name}.sdf"
    path.write_text(f"<sdf version='1.10'><model name='m' {attributes}>{more}<link name='a'>{BODY}</link>{parts}"
                    "</model></sdf>")
    return tool.convert(path, code=code)


def joint(kind, parts):
    return f"<joint name='j' type='{kind}'><parent>world</parent><child>a</child>{parts}</joint>"


def joint_types():
    cases = {"revolute": (AXIS, 1), "continuous": (AXIS, 1), "prismatic": (AXIS, 1), "ball": ("", 3),
             "universal": (AXIS + SECOND, 2), "revolute2": (AXIS + SLOW, 2),
             "screw": (AXIS + "<screw_thread_pitch>0.05</screw_thread_pitch>", 1), "fixed": ("", 0)}
    for kind, (parts, wanted) in cases.items():
        text, notes = one("sdf_" + kind, joint(kind, parts))
        tool.check(not notes, f"{kind}: notes are {notes}")
        found = tool.freedoms("sdf_" + kind, text)
        tool.check(found == wanted, f"{kind}: {found} freedoms, not {wanted}")
    tool.check(tool.freedoms("sdf_free", one("sdf_free", "")[0]) == 6, "a model stands free")
    for pitch, advance in (("<screw_thread_pitch>0.05</screw_thread_pitch>", 0.05),
                           ("<thread_pitch>8</thread_pitch>", -2 * math.pi / 8)):
        text, _ = one("sdf_pitch", joint("screw", AXIS + pitch))
        table = tool.run("sdf_pitch", tool.replace_analysis(
            text, "drivers: [{joint: j, coordinate: angle, value: 2*pi*t}]\n"
                  "analysis: {type: kinematics, duration: 1, step: 0.25}\n"
                  "output: [{file: results.csv, every: 0.25, channels: [a.position]}]\n"))
        tool.near("the advance of a turn", table["a.position.z"][-1], advance, 1e-12)
    # a pendulum with a spring and a damper along its axis, by the forces that the file has
    text, _ = one("sdf_spring", joint("revolute", "<axis><xyz>0 1 0</xyz><dynamics><damping>0.3</damping><friction>0.1"
                  "</friction><spring_stiffness>4</spring_stiffness><spring_reference>0.2</spring_reference></dynamics>"
                  "<limit><lower>-1</lower><upper>inf</upper></limit></axis>"))
    tool.check("'-(4)*(q - (0.2)) - (0.3)*qdot'" in text, f"the spring: {text}")
    tool.check("limit: 0.1" in text and "lower: -1" in text and "upper" not in text, f"the friction: {text}")


def placements():
    """The pose of a model is that of its placement frame; static models stay, joints of theirs too."""
    text, _ = one("sdf_placed", "", "placement_frame='p'", "<pose>1 0 0 0 0 0</pose><frame name='p' attached_to='a'>"
                  "<pose>0.5 0 0 0 0 1.5707963267948966</pose></frame>")
    table = tool.run("sdf_placed", text + "output: [{file: results.csv, channels: [a.position]}]\n")
    tool.near("x of the model", table["a.position.x"][0], 1.0, 1e-15)
    tool.near("y of the model", table["a.position.y"][0], 0.5, 1e-15)
    text, notes = one("sdf_static", joint("revolute", AXIS), more="<static>1</static>")
    tool.check(not notes and "fixed: true" in text and "joints:" not in text, f"a static model: {text}")


def names():
    """Names of 100 characters stay; the ends of those that are made of them, too."""
    name = "j" * 100
    text, notes = one("sdf_names", joint("revolute", "<axis><limit><lower>-1</lower></limit></axis>").replace(
        "name='j'", f"name='{name}'"))
    tool.check(f"name: {name}," in text and f"joint: {name}," in text, f"the name of the joint: {text}")
    tool.check(f"name: {'j' * 95}_stop," in text, f"the name of the stop: {text}")
    tool.check(not notes, f"notes are {notes}")


def lost():
    for what, parts in {"gearbox": joint("gearbox", AXIS), "gravity": "<link name='b'>" + BODY +
                        "<gravity>false</gravity></link>", "velocity_decay": "<link name='b'>" + BODY +
                        "<velocity_decay><linear>0.1</linear></velocity_decay></link>",
                        "heightmap": "<link name='b'>" + BODY + "<visual name='v'><geometry><heightmap/></geometry>"
                        "</visual></link>"}.items():
        _, notes = one("sdf_lost", parts, code=1)
        tool.check([n["kind"] for n in notes if what in n["message"]] == ["lost"], f"{what}: notes are {notes}")
    _, notes = one("sdf_bits", "<link name='b'>" + BODY + "<collision name='foot'><surface><contact><collide_bitmask>"
                   "0x02</collide_bitmask></contact></surface></collision></link>")
    tool.check(any("`foot`" in n["message"] and "0x02" in n["message"] and n["kind"] == "note" for n in notes),
               f"a bitmask: {notes}")
    _, notes = one("sdf_no_mass", "<link name='b'/>")
    tool.check("1 kg" in notes[0]["message"], f"a link without a mass: {notes}")
    for what, parts in {"not followed": "<include><uri>model://x</uri></include>",
                        "a model in a model": "<model name='n'><link name='l'/></model>"}.items():
        path = tool.WORK / "sdf_refused.sdf"
        path.write_text(f"<sdf version='1.10'>\n<model name='m'><link name='a'/>\n{parts}</model></sdf>")
        done = subprocess.run([tool.PROGRAM, "import", str(path)], capture_output=True, text=True, check=False)
        tool.check(done.returncode == 2 and what in done.stderr and ":3:" in done.stderr, f"{what}: {done.stderr}")


def surfaces():
    """What a surface says of contact is told with its line, and that a model touches itself."""
    _, notes = one("surface", """<self_collide>true</self_collide><link name='s'><collision name='c'>
      <geometry><sphere><radius>1</radius></sphere></geometry><surface>
      <friction><ode><mu>0.3</mu></ode></friction>
      <bounce><restitution_coefficient>0.6</restitution_coefficient></bounce></surface></collision></link>""")
    texts = [n["message"] for n in notes]
    for what in ("friction of 0.3", "restitution of 0.6", "self_collide"):
        tool.check(any(what in text for text in texts), f"{what}: {texts}")


def main():
    arm()
    surfaces()
    four_bar()
    joint_types()
    placements()
    names()
    lost()
    print("import.sdf: passed")


if __name__ == "__main__":
    main()
