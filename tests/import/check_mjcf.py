# SPDX-License-Identifier: BSD-3-Clause
"""MJCF: the efforts of a driven arm against the same arm in URDF, masses of geoms against closed forms, orientations,
classes, files that are included, equalities and tendons."""
import math
import re
import subprocess

import tool

MOTION = {"j1": (0.3, -0.7, 1.1), "j2": (-0.4, 0.9, 0.5), "j3": (0.05, 0.2, -0.3)}  # q, qdot, qddot

ARM = """<mujoco model="arm">
  <compiler angle="degree" eulerseq="XYZ"/>
  <default>
    <joint damping="0.5"/>
    <default class="big"><joint damping="0.25" armature="0.1"/></default>
  </default>
  <include file="rest.xml"/>
</mujoco>
"""

REST = """<mujocoinclude>
  <worldbody>
    <body name="a" pos="0 0 1" euler="10 20 30">
      <inertial pos="0.1 0.02 0" mass="3" fullinertia="0.1 0.2 0.25 0.01 0.02 0.03"/>
      <joint name="j1" axis="0 0 2" pos="0 0 0"/>
      <frame pos="0.5 0 0" euler="0 0 0">
        <body name="b" pos="0 0.1 0" quat="0.5 0.5 0.5 0.5" childclass="big">
          <inertial pos="0 0.1 0" euler="0 0 90" mass="2" diaginertia="0.02 0.03 0.04"/>
          <joint name="j2" axis="0 1 0" pos="0 0 0.2"/>
          <body name="c" pos="0 0 0.3">
            <inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
            <joint name="j3" class="main" type="slide" axis="1 0 0"/>
          </body>
        </body>
      </frame>
    </body>
  </worldbody>
</mujocoinclude>
"""

# euler XYZ about fixed axes is roll, pitch, yaw; the quaternion turns x to y, y to z, z to x; the joint 2 is 0.2 up
URDF = """<robot name="arm"><link name="w"/>
<link name="a"><inertial><origin xyz="0.1 0.02 0"/><mass value="3"/>
 <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0.01" ixz="0.02" iyz="0.03"/></inertial></link>
<link name="b"><inertial><origin xyz="0 0.1 -0.2"/><mass value="2"/>
 <inertia ixx="0.03" iyy="0.02" izz="0.04"/></inertial></link>
<link name="c"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>
<joint name="j1" type="continuous"><parent link="w"/><child link="a"/><axis xyz="0 0 1"/>
 <origin xyz="0 0 1" rpy="0.17453292519943295 0.3490658503988659 0.5235987755982988"/><dynamics damping="0.5"/></joint>
<joint name="j2" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
 <origin xyz="0.7 0.1 0" rpy="1.5707963267948966 0 1.5707963267948966"/><dynamics damping="0.25"/></joint>
<joint name="j3" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
 <origin xyz="0 0 0.1"/><dynamics damping="0.5"/></joint>
</robot>
"""


def convert(name, text, code=0):
    tool.WORK.mkdir(parents=True, exist_ok=True)
    path = tool.WORK / name
    path.write_text(text)
    return tool.convert(path, code=code)


def efforts(name, model):
    """The efforts at t = 0 of drivers that give the MOTION."""
    drivers = "".join(f"  - {{name: d{j}, joint: {j}, value: '{q} + ({v})*t + ({a / 2})*t^2'}}\n"
                      for j, (q, v, a) in MOTION.items())
    channels = ", ".join(f"d{j}.effort" for j in MOTION)
    table = tool.run(name, tool.replace_analysis(model, f"drivers:\n{drivers}"
                     "analysis: {type: inverse_dynamics, duration: 0.001, step: 0.001}\n"
                     f"output: [{{file: results.csv, every: 0.001, channels: [{channels}]}}]\n"))
    return {j: table[f"d{j}.effort"][0] for j in MOTION}


def arm_as_in_urdf():
    tool.WORK.mkdir(parents=True, exist_ok=True)
    (tool.WORK / "rest.xml").write_text(REST)
    model, notes = convert("arm_mjcf.xml", ARM)
    tool.check(not notes, f"notes are {notes}")
    own = efforts("mjcf_arm", model)
    other = efforts("mjcf_urdf", convert("arm_same.urdf", URDF)[0])
    other["j2"] += 0.1 * MOTION["j2"][2]  # the armature
    for j in MOTION:
        tool.near(f"effort of {j}", own[j], other[j], 1e-11 * max(map(abs, other.values())))


def masses_of_geoms():
    """Solids of 1000 kg/m^3, or of a mass: m and J about the centre."""
    r, l = 0.1, 0.6
    ball, rod = 4 / 3 * math.pi * r**3 * 1000, math.pi * r * r * l * 1000
    capsule = (ball + rod, 0.4 * ball * r * r + 0.5 * rod * r * r)
    geoms = {
        "sphere": ('type="sphere" size="0.1"', ball, 0.4 * ball * r * r),
        "capsule": (f'type="capsule" fromto="0 0 0 0 0 {l}" size="{r}"', *capsule),
        "cylinder": ('type="cylinder" size="0.1 0.3" mass="5"', 5, 0.5 * 5 * r * r),
        "ellipsoid": ('type="ellipsoid" size="0.1 0.2 0.3" density="500"', 500 * 4 / 3 * math.pi * 0.006,
                      500 * 4 / 3 * math.pi * 0.006 * 0.2 * (0.01 + 0.04)),
        "box": ('type="box" size="0.1 0.2 0.3"', 48, 48 / 3 * (0.01 + 0.04)),
    }
    text = "<mujoco><worldbody>" + "".join(
        f'<body name="{name}" pos="{k} 0 0"><freejoint/><geom contype="0" conaffinity="0" {geom[0]}/></body>'
        for k, (name, geom) in enumerate(geoms.items())) + "</worldbody></mujoco>"
    model, notes = convert("geoms.xml", text)
    tool.check(not notes, f"notes are {notes}")
    for name, (_, mass, axial) in geoms.items():
        found = re.search(rf"name: {name}\n    mass: (\S+)\n    inertia: \[\S+ \S+ ([^],]+)", model)
        tool.check(found, f"no body {name}")
        tool.near(f"mass of {name}", float(found[1]), mass, 1e-12 * mass)
        tool.near(f"inertia of {name}", float(found[2]), axial, 1e-12 * axial)


def start_and_range():
    """`ref` is the coordinate at the start; limits and springs are counted from the same zero."""
    text = """<mujoco><compiler angle="degree"/><worldbody>
      <body name="a"><joint name="h" axis="0 1 0" ref="30" range="-90 45" stiffness="2" springref="10"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
      <body name="b" pos="0 3 0"><joint name="s" type="slide" axis="0 0 1" ref="0.25"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>"""
    model, _ = convert("ref.xml", text)
    table = tool.run("mjcf_ref", tool.replace_analysis(
        model, "analysis: {type: dynamics, duration: 0.5, tolerance: 1e-10}\n"
        "output: [{file: results.csv, every: 0.1, channels: [h.angle, s.displacement]}]\n"))
    deg = math.pi / 180
    for t, h, s in zip(table["time"], table["h.angle"], table["s.displacement"]):
        tool.near(f"hinge at {t}", h, 10 * deg + 20 * deg * math.cos(math.sqrt(2) * t), 1e-8)
        tool.near(f"slide at {t}", s, 0.25 - 9.81 / 2 * t * t, 1e-8)
    tool.check("upper: 0.785398163397448" in model, "the range is in degrees")


def loops_couplings_and_tendons():
    """A parallelogram that a connect closes turns as one pendulum; two joints that are coupled; a spring of two sites."""
    def rod(name, x, joint, inner=""):
        return (f'<body name="{name}" pos="{x} 0 0"><joint name="{joint}" axis="0 1 0"/>'
                f'<inertial pos="0 0 -0.5" mass="1" diaginertia="0.01 0.01 0.01"/>'
                f'<site name="{name}_end" pos="0 0 -1"/>{inner}</body>')
    bar = ('<body name="bar" pos="0 0 -1"><joint name="e" axis="0 1 0"/>'
           '<inertial pos="1 0 0" mass="2" diaginertia="0.1 0.1 0.1"/></body>')
    text = f"""<mujoco><option gravity="0 0 -10"/><worldbody>{rod("l", 0, "jl", bar)}{rod("r", 2, "jr")}
      {rod("m", 5, "jm")}{rod("n", 7, "jn")}
      <body name="w" pos="0 9 1"><joint name="js" type="slide" axis="0 0 1"/>
        <inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/><site name="ws"/></body>
      <site name="top" pos="0 9 2"/></worldbody>
      <equality><connect name="loop" body1="bar" body2="r" anchor="2 0 0"/>
        <joint name="pair" joint1="jm" joint2="jn" polycoef="0 -2 0 0 0"/></equality>
      <tendon><spatial name="rope" stiffness="50" springlength="0.5"><site site="top"/><site site="ws"/></spatial>
      </tendon></mujoco>"""
    model, notes = convert("loops.xml", text)
    tool.check(not notes, f"notes are {notes}")
    tool.check(tool.freedoms("mjcf_loops", model) == 3, "freedoms")
    # a torque on one rod: its work is the energy of all that swings
    head, _, rest = model.partition("\nforces:\n")
    model = (head + "\nforces:\n  - {name: t1, type: effort, joint: jl, value: 3}\n"
             "  - {name: t2, type: effort, joint: jn, value: 3}\n" + rest)
    table = tool.run("mjcf_loops", tool.replace_analysis(
        model, "analysis: {type: dynamics, duration: 1, tolerance: 1e-10}\n"
        "output: [{file: results.csv, every: 0.1, channels: [l.angular_velocity, r.angular_velocity,"
        " bar.angular_velocity, jm.angle, jn.angle, js.displacement, jl.angle]}]\n"))
    J, weight = 2 * (0.01 + 0.25) + 2 * 1.0, (2 * 0.5 + 2 * 1.0) * 10
    for i, t in enumerate(table["time"]):
        w, q = table["l.angular_velocity.y"][i], table["jl.angle"][i]
        tool.near(f"both rods at {t}", table["r.angular_velocity.y"][i], w, 1e-7)
        tool.near(f"the bar at {t}", table["bar.angular_velocity.y"][i], 0, 1e-7)
        tool.near(f"energy at {t}", J * w * w / 2, 3 * q - weight * (1 - math.cos(q)), 1e-6)
        tool.near(f"coupled at {t}", table["jm.angle"][i], -2 * table["jn.angle"][i], 1e-7)
        # 50 (l - 0.5) = 20: it hangs at l = 0.9, and starts at l = 1
        tool.near(f"rope at {t}", table["js.displacement"][i], 0.1 - 0.1 * math.cos(5 * t), 1e-7)


def what_is_not_carried():
    text = """<mujoco><worldbody><body name="a"><joint name="h"/><geom size="0.1"/></body>
      <geom type="plane" size="1 1 1"/></worldbody>
      <equality><joint joint1="h" polycoef="0 1 1 0 0"/></equality>
      <actuator><motor joint="h"/><position name="servo" joint="h" kp="3"/></actuator></mujoco>"""
    model, notes = convert("lost.xml", text, code=1)
    said = [n["message"] for n in notes if n["kind"] == "lost"]
    tool.check(len(said) == 3, f"notes are {notes}")
    for word in ("contact", "polynomial", "servo"):
        tool.check(any(word in line for line in said), f"`{word}` is not told: {said}")
    tool.check(model.count("type: effort") == 2, "efforts for both actuators")


def touching():
    """Groups and masks let the same geoms touch as contype and conaffinity; single pairs are told by name."""
    bits = [(1, 1), (2, 1), (0, 2), (0, 0), (4, 6), (-1, 8), (8, 0), (1, 1)]
    bodies = "".join(f'<body name="b{k}" pos="{k} 0 0"><freejoint/><geom name="g{k}" size="0.1" contype="{c}" '
                     f'conaffinity="{a}"/></body>' for k, (c, a) in enumerate(bits))
    model, notes = convert("touching.xml", f"""<mujoco><worldbody>{bodies}</worldbody><contact>
      <exclude body1="b0" body2="b1"/><pair geom1="g2" geom2="g3"/></contact></mujoco>""", code=1)
    said = [n["message"] for n in notes if n["kind"] == "lost"]
    for one, other in (("b0", "b1"), ("g2", "g3")):
        tool.check(any(f"`{one}` and" in line and f"`{other}`" in line for line in said), f"{one}, {other}: {said}")
    shapes = re.findall(r"type: sphere, radius: 0.1(.*)}", model)
    tool.check(len(shapes) == len(bits), f"shapes: {shapes}")
    found = [[int(n) for n in re.findall(r": (\d+)", text)] or [0, 0] for text in shapes]
    tool.check(["contact: false" in text for text in shapes] == [k == 3 for k in range(len(bits))], f"none: {shapes}")
    for i, (c, a) in enumerate(bits):
        for j, (d, b) in enumerate(bits[:i]):
            wanted = bool(c & b) or bool(d & a)
            tool.check((bool(found[i][0] & found[j][1]) and bool(found[j][0] & found[i][1])) == wanted,
                       f"{i} and {j}: {found[i]}, {found[j]}")
    body = '<mujoco><worldbody><body name="b"><freejoint/><geom size="1" {}/></body></worldbody></mujoco>'
    model, _ = convert("plain.xml", body.format(""))
    tool.check("group" not in model, model)
    (tool.WORK / "bits.xml").write_text(body.format('contype="0.5"'))
    done = subprocess.run([tool.PROGRAM, "import", str(tool.WORK / "bits.xml")], capture_output=True, text=True,
                          check=False)
    tool.check(done.returncode == 2 and "contype must be a whole number" in done.stderr, done.stderr)


def what_flags_disable():
    """A flag that disables a part leaves it out; enabled, or said again, it is there."""
    text = """<mujoco><option><flag {}/></option><worldbody><geom type="plane" size="1 1 1"/>
      <body name="a" pos="0 0 1"><joint name="h" axis="0 1 0" range="-9 9" damping="0.2" stiffness="3" frictionloss="0.1"/>
        <geom size="0.1"/><site name="s"/>
        <body name="b" pos="0.5 0 0"><joint name="i" axis="0 1 0"/><geom size="0.1"/><site name="t"/></body></body>
      </worldbody><equality><connect body1="b" anchor="0 0 0"/></equality>
      <tendon><spatial name="rope" stiffness="4" damping="5"><site site="s"/><site site="t"/></spatial></tendon></mujoco>"""
    words = {"gravity": "-9.81", "limit": "type: stop", "frictionloss": "type: friction", "equality": "type: spherical",
             "spring": "k: 4", "damper": "0.2)*qdot", "contact": "# contact:"}
    parts = {"constraint": ["contact", "limit", "frictionloss", "equality"], "passive": ["spring", "damper"]}
    whole, _ = convert("flags.xml", text.format('gravity="enable"'), code=1)
    for flag in list(words) + list(parts):
        gone = parts.get(flag, [flag])
        code = 0 if "contact" in gone else 1
        model, notes = convert("flags.xml", text.format(f'{flag}="disable"'), code=code)
        for other, word in words.items():
            tool.check(word in whole, f"`{word}` is not in the whole: {whole}")
            tool.check((word in model) == (other not in gone), f"{flag}: `{word}`: {model} {notes}")


def materials():
    """A ball slides on a plane, with the larger friction of the two, once `contact` is no comment any more."""
    model, _ = convert("materials.xml", """<mujoco><worldbody><geom type="plane" size="9 9 1" friction="0.2"/>
      <body name="box" pos="0 0 0.05"><freejoint/><geom type="box" size="0.2 0.2 0.05" friction="0.4 0.01 0"/>
        <geom type="sphere" size="0.1" mass="0" contype="0" conaffinity="0"/></body>
      <body name="far" pos="0 3 1"><freejoint/><geom size="0.1" solref="0.02 0.5" friction="0.4"/></body>
      </worldbody></mujoco>""", code=1)
    tool.check(model.count("material: ") == 3 and model.count("contact: false") == 1, f"shapes: {model}")
    e = math.exp(-math.pi * 0.5 / math.sqrt(0.75))
    tool.check(any(abs(float(r) - e) < 1e-12 for r in re.findall(r"restitution: ([0-9.e-]+)", model)), model)
    touching_model = re.sub(r"(?m)^# (?=contact:| )", "", model).replace("position: [0, 0, 0.05]",
                                                                        "position: [0, 0, 0.05]\n    velocity: [1, 0, 0]")
    table = tool.run("mjcf_materials", tool.replace_analysis(touching_model, (
        "analysis: {type: dynamics, duration: 0.5}\n"
        "output: [{file: results.csv, every: 0.05, channels: [box.position]}]\n")))
    tool.near("the way", table["box.position.x"][-1], 1 / (2 * 0.4 * 9.81), 2e-3)


if __name__ == "__main__":
    arm_as_in_urdf()
    materials()
    masses_of_geoms()
    start_and_range()
    loops_couplings_and_tendons()
    what_is_not_carried()
    what_flags_disable()
    touching()
    print("import.mjcf: passed")
