# SPDX-License-Identifier: BSD-3-Clause
"""Chrono YAML against closed forms: frames of bodies, functions of motors, springs, loads, gravity."""
import math
import subprocess

import tool

HEAD = "chrono-version: 10.0\nmodel:\n  name: a model\n  angle_degrees: true\n"
GROUND = "    - {name: ground, location: [0, 0, 0], fixed: true}\n"


def convert(name, text, code=0):
    """Write a file beside the results and import it; the model and the notes."""
    tool.WORK.mkdir(parents=True, exist_ok=True)
    path = tool.WORK / f"{name}.chrono.yaml"
    path.write_text(text)
    return tool.convert(path, code=code)


def run(name, model, analysis, columns, step=0.05):
    """Run another analysis of a model, with the channels that have these columns."""
    channels = dict.fromkeys(c[:-2] if c[-2:] in (".x", ".y", ".z", ".e") else c for c in columns)
    return tool.run("chrono_" + name, tool.replace_analysis(
        model, f"analysis: {{{analysis}}}\n"
        f"output: [{{file: results.csv, every: {step}, channels: [{', '.join(channels)}]}}]\n"))


def dynamics(duration):
    return f"type: dynamics, duration: {duration}, tolerance: 1e-10"


def body(name, place, more="", moments="[1, 1, 1]", mass=1):
    return (f"    - {{name: {name}, location: {place}, mass: {mass}, inertia: {{moments: {moments}}}"
            f"{', ' + more if more else ''}}}\n")


def clamp(x, a, b):
    return min(max(x, a), b)


FUNCTIONS = [
    ("{type: CONSTANT, value: 1.5}", lambda t: 1.5),
    ("{type: RAMP, slope: 2, intercept: -1}", lambda t: 2 * t - 1),
    ("{type: POLYNOMIAL, coefficients: [1, 0, -2, 0.5]}", lambda t: 1 - 2 * t * t + 0.5 * t**3),
    ("{type: SINE, amplitude: 2, frequency: 0.5, phase: 90, shift: 0.25}",
     lambda t: 2 * math.sin(math.pi * t + math.pi / 2) + 0.25),
    ("{type: SINE, amplitude: 1, frequency: 0, phase: 30}", lambda t: 0.5),
    ("{type: DATA, data: [[-1, 1], [0.5, -1], [2, 3], [3, 2.5]]}",
     lambda t: 1 - 2 / 1.5 * (clamp(t, -1, .5) + 1) + 4 / 1.5 * (clamp(t, .5, 2) - .5) - .5 * (clamp(t, 2, 3) - 2)),
    ("{type: RAMP, slope: 2, repeat: {start: 0.25, width: 1.5, shift: 2}}",
     lambda t: 2 * (0.25 + math.fmod(t + 2, 1.5))),
    ("{type: DATA, data: [[0, 0], [1, 1], [2, 0]], repeat: {start: 0, width: 2, shift: 2}}",
     lambda t: 1 - abs(math.fmod(t, 2) - 1)),
]


def integrals(f, times):
    """From 0 to each of the times, by Gauss and Legendre with three points on panels of 1/40 between them."""
    total, out = 0.0, []
    for a, b in zip([0.0, *times], times):
        panels = round((b - a) * 40)
        for n in range(panels):
            middle, half = a + (n + 0.5) * (b - a) / panels, (b - a) / panels / 2
            for x, w in ((-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9)):
                total += half * w * f(middle + half * x)
        out.append(total)
    return out


def motors_by_function():
    """Body 1 moves by the function, or by its integral, relative to body 2 along z of the motor."""
    text = HEAD + "  bodies:\n" + GROUND
    motors = "  motors:\n"
    channels = []
    for k, (function, _) in enumerate(FUNCTIONS):
        for acts in ("POSITION", "speed"):
            name = f"{acts[0].lower()}{k}"
            # a jump of a place is no motion: only the speed of the ramp that repeats is driven
            if name == "p6":
                continue
            text += body(name, [0, k, 0])
            motors += (f"    - {{name: m_{name}, type: LINEAR, body1: {name}, body2: ground, location: [0, {k}, 0], "
                       f"axis: [0, 0, 2], actuation_type: {acts}, actuation_function: {function}}}\n")
            channels.append(f"{name}.position.z")
    model, notes = convert("motors", text + motors)
    tool.check([n["kind"] for n in notes] == ["note"], f"notes are {notes}")
    table = run("motors", model, "type: kinematics, duration: 4, step: 0.1", channels, step=0.1)
    for k, (_, f) in enumerate(FUNCTIONS):
        travels = integrals(f, table["time"])
        for i, t in enumerate(table["time"]):
            if k != 6:
                tool.near(f"p{k} at {t}", table[f"p{k}.position.z"][i], f(t), 1e-12 * 30)
            tool.near(f"s{k} at {t}", table[f"s{k}.position.z"][i], travels[i], 1e-10)


def signs_of_motors():
    """Body 1 is pushed and turned about the axis, body 2 the other way; 200 N on 40 kg, 3 N m on 2 kg m^2."""
    for swap in (False, True):
        first, second = ("ground", "load") if swap else ("load", "ground")
        sign = -1 if swap else 1
        text = HEAD + "  bodies:\n" + GROUND + body("load", [0, 0, 0], mass=40, moments="[2, 2, 2]") + "  motors:\n"
        for kind, acts, value, channel, result in (
                ("LINEAR", "FORCE", 200, "load.position.x", lambda t: 2.5 * t * t),
                ("LINEAR", "SPEED", 2, "load.position.x", lambda t: 2 * t),
                ("ROTATION", "FORCE", 3, "load.angular_velocity.x", lambda t: 1.5 * t),
                ("ROTATION", "SPEED", 3, "load.angular_velocity.x", lambda t: 3.0)):
            model, _ = convert("sign", text + (
                f"    - {{name: m, type: {kind}, body1: {first}, body2: {second}, location: [1, 0, 0], axis: [1, 0, 0],"
                f" actuation_type: {acts}, actuation_function: {{type: CONSTANT, value: {value}}}}}\n"))
            table = run("sign", model, dynamics(1), [channel])
            for t, x in zip(table["time"], table[channel]):
                tool.near(f"{kind} {acts} at {t}", x, sign * result(t), 1e-10)


def guides_without_a_joint():
    """A motor with the guide FREE holds a distance along its axis, SPHERICAL a line, a spindle FREE turns only."""
    text = (HEAD + "  bodies:\n" + GROUND + body("a", [0, 0, 0]) + body("b", [0, 2, 0]) + body("c", [0, 4, 0]) +
            body("d", [0, 6, 0]) + "  joints:\n"
            "    - {name: hinge, type: REVOLUTE, body1: c, body2: ground, location: [0, 4, 0], axis: [0, 0, 1]}\n"
            "  motors:\n"
            "    - {name: free, type: LINEAR, guide: FREE, body1: a, body2: ground, location: [0, 0, 0], axis: [1, 0, 0],"
            " actuation_type: POSITION, actuation_function: {type: RAMP, slope: 0.5}}\n"
            "    - {name: line, type: LINEAR, guide: SPHERICAL, body1: b, body2: ground, location: [0, 2, 0],"
            " axis: [0, 0, 1], actuation_type: SPEED, actuation_function: {type: CONSTANT, value: 0.5}}\n"
            "    - {name: turn, type: ROTATION, spindle: FREE, body1: c, body2: ground, location: [0, 4, 0],"
            " axis: [0, 0, 1], actuation_type: FORCE, actuation_function: {type: CONSTANT, value: 2}}\n"
            "    - {name: helix, type: ROTATION, spindle: CYLINDRICAL, body1: d, body2: ground, location: [0, 6, 0],"
            " axis: [0, 0, 1], actuation_type: POSITION, actuation_function: {type: RAMP, slope: 3}}\n")
    model, _ = convert("guides", text)
    table = run("guides", model, dynamics(1), ["a.position", "b.position", "c.angular_velocity.z", "d.position.z",
                                     "d.angular_velocity.z"])
    for i, t in enumerate(table["time"]):
        tool.near(f"a.x at {t}", table["a.position.x"][i], 0.5 * t, 1e-10)
        tool.near(f"a.z at {t}", table["a.position.z"][i], -4.9 * t * t, 1e-9)
        tool.near(f"b.z at {t}", table["b.position.z"][i], 0.5 * t, 1e-10)
        tool.near(f"b.y at {t}", table["b.position.y"][i], 2, 1e-10)
        tool.near(f"c turns at {t}", table["c.angular_velocity.z"][i], 2 * t, 1e-10)
        tool.near(f"d falls at {t}", table["d.position.z"][i], -4.9 * t * t, 1e-9)
        tool.near(f"d turns at {t}", table["d.angular_velocity.z"][i], 3, 1e-10)


def frames_of_bodies():
    """A free body whose centre is turned and moved in its frame: its principal axis is the one it spins about."""
    # reference: yaw 90 about z; centre: 1 along x of it, turned 90 about y: its z is x of reference, y of the ground
    text = HEAD + "  bodies:\n" + (
        "    - {name: top, location: [1, 2, 3], orientation: [90, 0, 0], mass: 2,\n"
        "       com: {location: [1, 0, 0], orientation: [0, 90, 0]}, inertia: {moments: [1, 2, 2.5]},\n"
        "       initial_linear_velocity: [0.5, 0, 4], initial_angular_velocity: [0, 0, 7]}\n"
        "    - {name: tilted, location: [0, 0, 0], orientation: [0.5, 0.5, 0.5, 0.5], mass: 1,\n"
        "       inertia: {moments: [1, 2, 2.5], products: [0.1, 0.2, 0.3]}}\n")
    model, notes = convert("frames", text)
    tool.check(len(notes) == 1, f"notes are {notes}")
    tool.check("inertia: [2.5, 2, 1]" in model, "moments in the axes of reference")
    tool.check("inertia: [1, 2, 2.5, 0.1, 0.3, 0.2]" in model, "products xy, yz, zx")
    table = run("frames", model, dynamics(1), ["top.position", "top.angular_velocity", "tilted.orientation"])
    for i, t in enumerate(table["time"]):
        tool.near(f"x at {t}", table["top.position.x"][i], 1 + 0.5 * t, 1e-11)
        tool.near(f"y at {t}", table["top.position.y"][i], 3, 1e-11)
        tool.near(f"z at {t}", table["top.position.z"][i], 3 + 4 * t - 4.9 * t * t, 1e-11)
        tool.near(f"spin at {t}", math.hypot(table["top.angular_velocity.y"][i], table["top.angular_velocity.x"][i],
                                             table["top.angular_velocity.z"][i]), 7, 1e-10)
        for e in ("e0", "e1", "e2", "e3"):
            tool.near(f"{e} at {t}", table[f"tilted.orientation.{e}"][i], 0.5, 1e-12)


def springs():
    """m x'' = P - k (l - l0) - c x', and the same about an axis with angles in degrees; a curve of the same k."""
    text = (HEAD + "  bodies:\n" + GROUND + body("a", [1.3, 0, 0], mass=2) + body("b", [1.3, 2, 0], mass=2) +
            body("c", [1.3, 6, 0], mass=2) +
            body("w", [0, 4, 0], moments="[0.5, 0.5, 0.5]") + "  joints:\n"
            "    - {name: ja, type: PRISMATIC, body1: a, body2: ground, location: [0, 0, 0], axis: [1, 0, 0]}\n"
            "    - {name: jb, type: PRISMATIC, body1: ground, body2: b, location: [0, 2, 0], axis: [1, 0, 0]}\n"
            "    - {name: jc, type: PRISMATIC, body1: c, body2: ground, location: [0, 6, 0], axis: [1, 0, 0]}\n"
            "    - {name: jw, type: REVOLUTE, body1: ground, body2: w, location: [0, 4, 0], axis: [0, 0, 1]}\n"
            "  tsdas:\n"
            "    - {name: sa, type: TSDA, body1: ground, body2: a, point1: [0, 0, 0], point2: [1.3, 0, 0],"
            " spring_coefficient: 50, damping_coefficient: 3, free_length: 1, preload: 4}\n"
            "    - {name: sc, type: TSDA, body1: ground, body2: c, point1: [0, 6, 0], point2: [1.3, 6, 0],"
            " spring_coefficient: 50, damping_coefficient: 3, free_length: -0.5, preload: 79}\n"
            "    - {name: sb, body1: b, body2: ground, point1: [1.3, 2, 0], point2: [0, 2, 0], free_length: 1,"
            " spring_curve_data: [[-5, -250], [0, 0], [7, 350]], damping_curve_data: [[-10, -30], [10, 30]], preload: 4}\n"
            "  rsdas:\n"
            "    - {name: sw, body1: ground, body2: w, axis: [0, 0, 1], free_angle: 30, spring_coefficient: 8,"
            " damping_coefficient: 0.4, preload: 1}\n")
    model, notes = convert("springs", text)
    tool.check(len(notes) == 1, f"notes are {notes}")
    table = run("springs", model, dynamics(2), ["a.position.x", "b.position.x", "c.position.x", "jw.angle", "w.angular_velocity.z"])

    def oscillate(t, m, k, c, rest, start):
        s, w = c / (2 * m), math.sqrt(k / m - (c / (2 * m))**2)
        return rest + (start - rest) * math.exp(-s * t) * (math.cos(w * t) + s / w * math.sin(w * t))

    for i, t in enumerate(table["time"]):
        x = oscillate(t, 2, 50, 3, 1 + 4 / 50, 1.3)
        tool.near(f"a at {t}", table["a.position.x"][i], x, 1e-9)
        tool.near(f"b at {t}", table["b.position.x"][i], x, 1e-9)
        tool.near(f"c at {t}", table["c.position.x"][i], x, 1e-9)
        # the joint's angle is that of body 1 relative to body 2
        tool.near(f"w at {t}", -table["jw.angle"][i], oscillate(t, .5, 8, .4, math.pi / 6 + 1 / 8, 0), 1e-9)


def stops_and_degressive_dampers():
    """The force of a spring beyond its range, and of a damper that yields, on bodies that a motor moves."""
    text = (HEAD + "  bodies:\n" + GROUND + body("a", [1, 0, 0]) + body("d", [1, 2, 0]) + "  motors:\n" + "".join(
        f"    - {{name: m{n}, type: LINEAR, body1: {n}, body2: ground, location: [1, {y}, 0], axis: [1, 0, 0],"
        f" actuation_type: POSITION, actuation_function: {{type: SINE, amplitude: 0.03, frequency: 1}}}}\n"
        for n, y in (("a", 0), ("d", 2))) + "  tsdas:\n"
            "    - {name: s, body1: ground, body2: a, point1: [0, 0, 0], point2: [1, 0, 0], spring_coefficient: 100,"
            " free_length: 1, minimum_length: 0.99, maximum_length: 1.005}\n"
            "    - {name: d, body1: ground, body2: d, point1: [0, 2, 0], point2: [1, 2, 0], damping_coefficient: 10,"
            " degressivity_compression: 2, degressivity_expansion: 3}\n")
    model, _ = convert("stops", text)
    table = run("stops", model, "type: kinematics, duration: 1, step: 0.02", ["s.force", "d.force"], step=0.02)

    def beyond(x):
        points = [(0, 0), (.01, 1000), (.02, 2500), (.03, 4500)]
        for (a, f), (b, g) in zip(points, points[1:]):
            if a <= x <= b:
                return f + (g - f) * (x - a) / (b - a)
        return 0.0

    for i, t in enumerate(table["time"]):
        length = 1 + 0.03 * math.sin(2 * math.pi * t)
        speed = 0.06 * math.pi * math.cos(2 * math.pi * t)
        pull = 100 * (length - 1) - beyond(0.99 - length) + beyond(length - 1.005)
        tool.near(f"s at {t}", table["s.force"][i], pull, 1e-8)
        tool.near(f"d at {t}", table["d.force"][i], 10 * speed / (1 + (3 * speed if speed >= 0 else -2 * speed)), 1e-9)


def loads():
    """A force in the axes of a body that spins, a torque in those of the ground, and one that a program sets."""
    text = (HEAD + "  bodies:\n" + GROUND + body("a", [0, 0, 0], mass=2, more="initial_angular_velocity: [0, 0, 3]") +
            body("b", [0, 5, 0]) + body("c", [0, 9, 0]) + "  body_loads:\n"
            "    - {name: fa, type: FORCE, body: a, load: [4, 0, 0], local_load: true, point: [0, 0, 0], local_point: true}\n"
            "    - {name: tb, type: TORQUE, body: b, load: [0, 0, 2], local_load: false,"
            " modulation_function: {type: RAMP, slope: 3}}\n"
            "  load_controllers:\n"
            "    - {name: fc, type: FORCE, body: c, point: [0, 0, 0], local_point: true}\n")
    model, notes = convert("loads", text)
    tool.check([n["kind"] for n in notes] == ["note", "note"], f"notes are {notes}")
    table = run("loads", model, dynamics(1), ["a.velocity", "b.angular_velocity.z", "c.position.z"])
    for i, t in enumerate(table["time"]):
        tool.near(f"a.x at {t}", table["a.velocity.x"][i], 2 * math.sin(3 * t) / 3, 1e-10)
        tool.near(f"a.y at {t}", table["a.velocity.y"][i], 2 * (1 - math.cos(3 * t)) / 3, 1e-10)
        tool.near(f"b at {t}", table["b.angular_velocity.z"][i], 3 * t * t, 1e-10)
        tool.near(f"c at {t}", table["c.position.z"][i], -4.9 * t * t, 1e-10)


def joints_leave_what_they_should():
    """How many freedoms each joint leaves, and in which direction the points move."""
    bodies, joints, channels = "", "", []
    cases = [("LOCK", "", 0), ("REVOLUTE", "axis: [0, 1, 0]", 1), ("PRISMATIC", "axis: [0, 1, 0]", 1),
             ("SPHERICAL", "", 3), ("UNIVERSAL", "axis1: [1, 0, 0], axis2: [0, 1, 0]", 2), ("POINT_LINE", "", 4),
             ("POINT_PLANE", "", 5)]
    for k, (kind, more, _) in enumerate(cases):
        bodies += body(f"b{k}", [0, 3 * k, 0])
        joints += (f"    - {{name: j{k}, type: {kind}, body1: b{k}, body2: ground, location: [1, {3 * k}, 0]"
                   f"{', ' + more if more else ''}}}\n")
        channels.append(f"b{k}.position")
    distance = ("  constraints:\n    - {name: rod, type: DISTANCE, body1: ground, body2: end, point1: [0, -3, 2],"
                " point2: [0, -3, 0]}\n")
    model, _ = convert("joints", HEAD + "  bodies:\n" + GROUND + bodies + body("end", [0, -3, 0]) + "  joints:\n" +
                       joints + distance)
    report = tool.freedoms("chrono_joints", model)
    tool.check(report == sum(case[2] for case in cases) + 5, f"{report} freedoms")
    table = run("joints", model, dynamics(0.4), channels)
    for i, t in enumerate(table["time"]):
        tool.near(f"locked at {t}", table["b0.position.z"][i], 0, 1e-12)
        tool.near(f"prismatic at {t}", table["b2.position.z"][i], 0, 1e-12)
    last = -1
    tool.check(table["b1.position.z"][last] < -0.1, "the revolute falls")
    # the point of POINT_LINE stays on x, that of POINT_PLANE in the plane of z: both fall about it
    tool.check(table["b5.position.z"][last] < -0.1 and table["b6.position.z"][last] < -0.1, "points on lines fall")


def simulation_with_a_model():
    """Gravity, the end and the rows stand in a file that names the model."""
    tool.WORK.mkdir(parents=True, exist_ok=True)
    (tool.WORK / "falling.yaml").write_text(
        HEAD + "  bodies:\n" + body("ball", [0, 0, 0], more="colour: red"))
    model, notes = convert("simulation", (
        "chrono-version: 10.0\ntype: MBS\nmodel: falling.yaml\nsolver: none.yaml\n"
        "simulation: {time_step: 1e-3, end_time: 2, gravity: [0, 0, -1.6]}\noutput: {fps: 20}\n"))
    tool.check("gravity: [0, 0, -1.6]" in model and "duration: 2" in model and "every: 0.05" in model,
               "gravity, end and rows")
    tool.check(len(notes) == 1 and "falling.yaml:6" in notes[0]["message"] and "colour" in notes[0]["message"],
               f"notes are {notes}")


def touching(material, shape):
    return (f"contact: {{materials: [{{name: m, {material}}}], shapes: [{{type: BOX, material: m, {shape}}}]}}, "
            f"visualization: {{shapes: [{{type: SPHERE, radius: 0.1}}]}}")


def contacts():
    """A box slides on the ground until the smaller one of two frictions has stopped it."""
    hard = "physical_properties: {Youngs_modulus: 1e8, Poisson_ratio: 0.25}, "
    for law, more in (("hooke", ""), ("hertz_mindlin", hard)):
        floor = touching(more + "coefficient_of_friction: 0.6, coefficient_of_restitution: 0.3",
                         "dimensions: [8, 8, 1], location: [0, 0, -0.5]")
        text = HEAD + "  bodies:\n" + GROUND.replace("fixed: true", "fixed: true, " + floor) + body(
            "box", [0, 0, 0.05], moments="[0.01, 0.01, 0.01]", more="initial_linear_velocity: [1, 0, 0], " +
            touching(more + "coefficient_of_friction: 0.4", "dimensions: [0.4, 0.4, 0.1]"))
        model, notes = convert("contact", text)
        tool.check(f"law: {law}" in model and "friction: 0.4, restitution: 0.01}" in model, f"contact: {model}")
        tool.check(all(n["kind"] == "note" for n in notes), f"notes are {notes}")
        tool.check(model.count("contact: false") == 2, "what is only drawn touches nothing")
        table = run("contact", model, "type: dynamics, duration: 0.5", ["box.position.x"])
        tool.near("the way", table["box.position.x"][-1], 1 / (2 * 0.4 * 9.8), 2e-3)
    _, notes = convert("contact", text.replace("name: m,", "name: n,"), code=1)
    tool.check(all("is not there" in n["message"] for n in notes if n["kind"] == "lost"), f"notes are {notes}")


def machines_without_bodies():
    path = tool.WORK / "fluid.chrono.yaml"
    path.write_text(HEAD + "  fluid_properties: {density: 1000}\n")
    done = subprocess.run([tool.PROGRAM, "import", str(path)], capture_output=True, text=True, check=False)
    tool.check(done.returncode == 2 and "has no `bodies`" in done.stderr, f"a fluid: {done.stderr}")


if __name__ == "__main__":
    contacts()
    machines_without_bodies()
    motors_by_function()
    signs_of_motors()
    guides_without_a_joint()
    frames_of_bodies()
    springs()
    stops_and_degressive_dampers()
    loads()
    joints_leave_what_they_should()
    simulation_with_a_model()
    print("import.chrono: passed")
