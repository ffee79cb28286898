# SPDX-License-Identifier: BSD-3-Clause
"""Models of the course ME751: the driven pendulum against its closed form, by two ways of its names, and what is
wrong or cannot be carried."""
import json
import math
import subprocess

import tool

L, MASS, WIDTH = 2.0, 78.0, 0.05
JOINT = [("CD", [1, 0, 0], None), ("CD", [0, 1, 0], None), ("CD", [0, 0, 1], None),
         ("DP1", [0, 0, 1], [0, 1, 0]), ("DP1", [0, 0, 1], [0, 0, 1])]
DRIVE = "cos(pi/4*cos(2*t)-pi/2)"


def theta(t):
    """The angle of the bar from -z, in the plane y z, and its first two derivatives."""
    a = math.pi / 4 * math.cos(2 * t)
    return a, -math.pi / 2 * math.sin(2 * t), -math.pi * math.cos(2 * t)


def start():
    """Euler parameters of the bar at t = 0: its x along the bar, its z along x of the ground."""
    a = theta(0.0)[0]
    x, z = (0.0, math.sin(a), -math.cos(a)), (1.0, 0.0, 0.0)
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    A = [[x[k], y[k], z[k]] for k in range(3)]
    e0 = math.sqrt(1 + A[0][0] + A[1][1] + A[2][2]) / 2
    p = [e0, (A[2][1] - A[1][2]) / (4 * e0), (A[0][2] - A[2][0]) / (4 * e0), (A[1][0] - A[0][1]) / (4 * e0)]
    return [L * c for c in x], p


def matlab():
    """Names of one program of the course; the functions are MATLAB's."""
    r, p = start()
    J = [MASS / 6 * WIDTH ** 2] + 2 * [MASS / 12 * ((2 * L) ** 2 + WIDTH ** 2)]
    constraints = []
    for k, (kind, a, b) in enumerate(JOINT):
        one = {"name": f"c.{k}", "id": k + 1, "type": "cons_" + kind.lower(), "body1": 1, "body2": "ground",
               "fun": "@(t)(0.*t)"}
        one.update({"c": a, "sPiBAR": [-L, 0, 0], "sQjBAR": [0, 0, 0]} if kind == "CD" else {"aiBAR": a, "ajBAR": b})
        constraints.append(one)
    constraints.append({"name": "drive", "id": 6, "type": "cons_dp1", "body1": 1, "aiBAR": [1, 0, 0],
                        "body2": "ground", "ajBAR": [0, 1, 0], "fun": f"@(t)({DRIVE.replace('*', '.*')})"})
    return {"name": "revJoint", "gravity": [0, 0, -9.81], "constraints": constraints,
            "bodies": [{"name": "bar", "id": 1, "mass": MASS, "jbar": J, "q0": r + p, "qd0": [0] * 7}]}


def python():
    """Names of another one: body i is the ground, with the id 0; Euler parameters of any length."""
    model = matlab()
    r, p = start()
    bar = model["bodies"][0]
    J = bar["jbar"]
    model["bodies"] = [{"name": "ground", "id": 0},
                       {"name": "bar", "id": 1, "mass": MASS, "J": [[J[0], 0, 0], [0, J[1], 0], [0, 0, J[2]]],
                        "r": r, "p": [3 * e for e in p], "dr": [0] * 3, "dp": [0] * 4}]
    out = []
    for one in model["constraints"]:
        kind = one["type"][5:].upper()
        new = {"name": one["name"], "type": kind, "body_i": 0, "body_j": 1, "f": 0, "df": 0, "ddf": 0}
        if kind == "CD":
            new.update({"c": one["c"], "sj": one["sPiBAR"], "si": [0, 0, 0]})
        else:
            new.update({"ai": one["ajBAR"], "aj": one["aiBAR"]})
        out.append(new)
    out[-1]["f"] = "lambda t: np." + DRIVE.replace("cos(2", "np.cos(2").replace("pi", "np.pi")
    model["constraints"] = out
    return model


def write(name, model):
    tool.WORK.mkdir(parents=True, exist_ok=True)
    path = tool.WORK / name
    path.write_text(model if isinstance(model, str) else json.dumps(model, indent=4))
    return path


def pendulum(name, model):
    text, notes = tool.convert(write(name, model))
    tool.check(all(n["kind"] in ("named", "note") for n in notes), f"{name}: notes are {notes}")
    analysis = ("analysis: {type: inverse_dynamics, duration: 2, step: 0.25}\n"
                "output: [{file: results.csv, every: 0.25, channels: [bar.position, bar.acceleration, drive.torque]}]\n")
    table = tool.run("me751_" + name, tool.replace_analysis(text, analysis))
    about = MASS * L ** 2 + MASS / 12 * ((2 * L) ** 2 + WIDTH ** 2)
    for k, t in enumerate(table["time"]):
        a, v, acc = theta(t)
        tool.near("y", table["bar.position.y"][k], L * math.sin(a), 1e-9)
        tool.near("z", table["bar.position.z"][k], -L * math.cos(a), 1e-9)
        tool.near("the acceleration", table["bar.acceleration.y"][k],
                  L * (acc * math.cos(a) - v * v * math.sin(a)), 1e-7)
        torque = about * acc + MASS * 9.81 * L * math.sin(a)
        tool.near("the torque", abs(table["drive.torque.x"][k]), abs(torque), 1e-6)


def refused(what, model):
    done = subprocess.run([tool.PROGRAM, "import", str(write("me751_bad.mdl", model))], capture_output=True,
                          text=True, check=False)
    tool.check(done.returncode == 2 and what in done.stderr, f"{what}: {done.returncode}: {done.stderr}")


def mistakes():
    def change(**values):
        model = matlab()
        model["constraints"][0].update(values)
        return model
    refused("must be DP1, DP2, D, CD or a joint", change(type="cons_dp3"))
    refused("no body 7", change(body1=7))
    refused("one body and itself", change(body2=1))
    refused("c must be 3 numbers", change(c=[1, 0]))
    refused("must be a list", dict(matlab(), constraints=3))
    refused("two bodies", dict(matlab(), bodies=matlab()["bodies"] * 2))
    refused("needs a `fun` > 0", change(type="d", fun="none"))
    refused("needs a `fun` > 0", change(type="d", fun=0))
    refused("a direction that is not 0", change(c=[0, 0, 0]))
    refused("`bodies`", {"bodies": []})
    for value in ("@(t)(system('ls'))", "t +", "@(t)q(1)"):
        text, notes = tool.convert(write("me751_lost.mdl", change(fun=value)), code=1)
        tool.check([n["kind"] for n in notes if "no expression" in n["message"]] == ["lost"], f"{value}: {notes}")
    text, _ = tool.convert(write("me751_jet.adm", change(fun=0.5, df=2, ddf=3)))
    tool.check("value: '0.5 + (2)*t + (3)/2*t^2'" in text, f"a jet: {text}")
    for what, force in {"two bodies": {"k": 1}, "itself": {"k": 1, "body1": 1, "body2": 1},
                        "no expression": None, "no axis": {"type": "RSDA", "body1": 1, "body2": 0},
                        "on the ground": {"type": "force", "body": 0, "F": [1, 2, 3]},
                        "three numbers": {"type": "torque", "body": 1, "torque": [1, 2]},
                        "must be TSDA": {"type": "magnet"}}.items():
        force = force or {"body1": 1, "body2": "ground", "h": "@(l, ldot, t)(l)"}
        _, notes = tool.convert(write("me751_tsda.mdl", dict(matlab(), TSDAs=[force])), code=1)
        tool.check([n["kind"] for n in notes if "TSDAs[0]" in n["message"]] == ["lost"], f"{what}: {notes}")
    refused("k must be a number", dict(matlab(), TSDAs=[{"body1": 1, "body2": "ground", "k": "soft"}]))


def forces():
    """The same pendulum with springs, a force and torques: what the driver has to hold against them."""
    k, c, l0, actuator = 30.0, 4.0, 1.5, 7.0
    kr, cr, load, torque = 25.0, 3.0, [0.5, -20.0, 11.0], 9.0
    model = matlab()
    model["TSDAs"] = [{"name": "spring", "body1": "ground", "body2": 1, "sPiBAR": [0, 3, 1], "sQjBAR": [L, 0, 0],
                       "k": k, "c": c, "l_0": l0, "h": f"@(t)({actuator}.*t)"}]
    model["forces"] = [{"type": "RSDA", "body1": "ground", "body2": 1, "aiBAR": [1, 0, 0], "k": kr, "c": cr},
                       {"type": "PointForce", "body": 1, "sBAR": [L, 0, 0], "F": load},
                       {"type": "torque", "name": "turn", "body": 1, "nBAR": [0, 0, f"@(t)({torque}.*t)"]}]
    text, notes = tool.convert(write("me751_forces.mdl", model))
    tool.check(all(n["kind"] in ("named", "note") for n in notes), f"forces: notes are {notes}")
    analysis = ("analysis: {type: inverse_dynamics, duration: 2, step: 0.25}\n"
                "output: [{file: results.csv, every: 0.25, channels: [drive.torque, spring.length]}]\n")
    table = tool.run("me751_forces", tool.replace_analysis(text, analysis))
    about = MASS * L ** 2 + MASS / 12 * ((2 * L) ** 2 + WIDTH ** 2)
    first = theta(0.0)[0]
    for n, t in enumerate(table["time"]):
        a, v, acc = theta(t)
        tip = (2 * L * math.sin(a), -2 * L * math.cos(a))
        rate = (2 * L * math.cos(a) * v, 2 * L * math.sin(a) * v)
        d = (tip[0] - 3, tip[1] - 1)
        length = math.hypot(*d)
        pull = k * (length - l0) + c * (d[0] * rate[0] + d[1] * rate[1]) / length + actuator * t
        push = [load[1] - pull * d[0] / length, load[2] - pull * d[1] / length]
        moment = tip[0] * push[1] - tip[1] * push[0] - kr * (a - first) - cr * v + torque * t
        needed = about * acc + MASS * 9.81 * L * math.sin(a) - moment
        tool.near("the length", table["spring.length"][n], length, 1e-9)
        tool.near("the torque against forces", abs(table["drive.torque.x"][n]), abs(needed), 1e-6)


def markers(flipped):
    """The same pendulum on a joint of two markers, which the function drives; the second may look the other way."""
    r, p = start()
    J = [MASS / 6 * WIDTH ** 2] + 2 * [MASS / 12 * ((2 * L) ** 2 + WIDTH ** 2)]
    z, sign = (-1, "-") if flipped else (1, "")
    model = {"name": "markers", "gravity": [0, 0, -9.81],
             "bodies": [{"name": "bar", "id": 1, "mass": MASS, "CG": [0, 0, 0], "MOI": J, "q0": r + p, "qd0": [0] * 7,
                         "points": [[0, 0, 0]]}],
             "constraints": [{"name": "Rev", "id": 1, "type": "Revolute", "body1": 0, "body2": 1,
                              "marker1": [{"P": [0, 0, 0], "Q": [1, 0, 0], "R": [0, 0, -1]}],
                              "marker2": [{"P": [-L, 0, 0], "Q": [-L, 0, z], "R": [0, 0, 0]}],
                              "fun": sign + "pi()/4*cos(2*t)"}],
             "forces": [{"name": "push", "type": "PointForce", "body1": 1, "sP1": [L, 0, 0], "frame": "GRF",
                         "funX": "0", "funY": "3*t", "funZ": "0"}],
             "simulation": [{"Type": "Dynamics", "tend": 2, "outputSteps": 8}]}
    text, notes = tool.convert(write("markers.mdl", model))
    tool.check(not notes, f"markers: notes are {notes}")
    tool.check("duration: 2" in text and "every: 0.25" in text, f"markers: {text}")
    analysis = ("analysis: {type: inverse_dynamics, duration: 2, step: 0.25}\n"
                "output: [{file: results.csv, every: 0.25, channels: [bar.position, Rev_driver.effort]}]\n")
    table = tool.run("me751_markers", tool.replace_analysis(text, analysis))
    about = MASS * L ** 2 + MASS / 12 * ((2 * L) ** 2 + WIDTH ** 2)
    for k, t in enumerate(table["time"]):
        a, _, acc = theta(t)
        tool.near("y of markers", table["bar.position.y"][k], L * math.sin(a), 1e-9)
        tool.near("z of markers", table["bar.position.z"][k], -L * math.cos(a), 1e-9)
        needed = about * acc + MASS * 9.81 * L * math.sin(a) - 2 * L * math.cos(a) * 3 * t
        tool.near("the effort", table["Rev_driver.effort"][k], needed, 1e-6)
    return model


def joints():
    """Joints of each kind, and what is wrong with markers."""
    model = markers(False)
    for kind, made in (("Spherical", "spherical"), ("Translational", "prismatic"), ("cylindrical", "cylindrical"),
                       ("Fixed", "fixed")):
        for one in (model["constraints"][0],):
            one.update(type=kind, fun="None")
        text, _ = tool.convert(write("kinds.mdl", model))
        tool.check(f"type: {made}," in text, f"{kind}: {text}")
    model["constraints"][0].update(type="Spherical", fun="t")
    _, notes = tool.convert(write("kinds.mdl", model), code=1)
    tool.check(["one of several" in n["message"] for n in notes] == [True], f"a driven ball: {notes}")
    model["constraints"][0].update(type="Revolute", fun="q(1)")
    _, notes = tool.convert(write("kinds.mdl", model), code=1)
    tool.check(["nothing drives" in n["message"] for n in notes] == [True], f"a strange function: {notes}")
    model["constraints"][0].update(fun="None")
    model["bodies"][0]["CG"] = [0, 1, 0]
    _, notes = tool.convert(write("kinds.mdl", model), code=1)
    tool.check(["centre of mass" in n["message"] for n in notes] == [True], f"a centre: {notes}")
    model["constraints"][0]["marker2"] = {"P": [0, 0, 0], "Q": [1, 0, 0], "R": [2, 0, 0]}
    refused("three points not in one line", model)
    del model["constraints"][0]["marker2"]
    refused("no `marker2` of P, Q and R", model)


def main():
    markers(True)
    joints()
    pendulum("matlab.mdl", matlab())
    pendulum("python.adm", python())
    mistakes()
    forces()
    print("import.me751: passed")


if __name__ == "__main__":
    main()
