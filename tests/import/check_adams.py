# SPDX-License-Identifier: BSD-3-Clause
"""Adams data sets against closed forms: units, functions of time, springs, couplings, primitives."""
import json
import math
import subprocess

import tool

TONNE_MM = "UNITS/FORCE=NEWTON, MASS=TONNE, LENGTH=MILLIMETER, TIME=MILLISECOND\n"


def convert(name, text, code=0):
    """Write a data set beside the results and import it; the model and the notes."""
    tool.WORK.mkdir(parents=True, exist_ok=True)
    path = tool.WORK / f"{name}.adm"
    path.write_text("the title\n!\n" + text + "END\nnothing is read here\n")
    return tool.convert(path, code=code)


def slider(part, function, extra=""):
    """A part that slides along its own z by a function of time."""
    return (f"PART/{part}, MASS=1, CM={part}00, IP=1, 1, 1\nMARKER/{part}00, PART={part}\n"
            f"MARKER/{part}01, PART={part}\nMARKER/{part}02, PART=1\n"
            f"JOINT/{part}, TRANSLATIONAL, I={part}01\n, J={part}02\n"
            f"MOTION/{part}, JOINT={part}, TRANSLATION, FUNCTION={function}\n{extra}")


def functions_of_time():
    """Each function drives a slider, whose place is compared with the definition."""
    def ramp(x, a, b):
        return min(max((x - a) / (b - a), 0.0), 1.0)

    cases = [
        ("STEP(TIME, 0.2, 1, 0.8, 3)", lambda t: 1 + 2 * ramp(t, .2, .8)**2 * (3 - 2 * ramp(t, .2, .8))),
        ("STEP5(time,.2,1.0D0,.8,3)", lambda t: 1 + 2 * ramp(t, .2, .8)**3 *
         (10 - 15 * ramp(t, .2, .8) + 6 * ramp(t, .2, .8)**2)),
        ("HAVSIN(TIME, 0.1, 0, 1.9, 2)", lambda t: 1 - math.cos(math.pi * ramp(t, .1, 1.9))),
        ("SHF(TIME, 0.25, 2, 2*PI, 30D, 1)", lambda t: 2 * math.sin(2 * math.pi * (t - .25) - math.pi / 6) + 1),
        ("POLY(TIME, 0.5, 1, 2, 3, 4)", lambda t: 1 + 2 * (t - .5) + 3 * (t - .5)**2 + 4 * (t - .5)**3),
        ("FORSIN(TIME, 0.1, 3, 1, 2, 0.5)", lambda t: 1 + 2 * math.sin(3 * (t - .1)) + .5 * math.sin(6 * (t - .1))),
        ("FORCOS(TIME, 0.1, 3, 1, 2, 0.5)", lambda t: 1 + 2 * math.cos(3 * (t - .1)) + .5 * math.cos(6 * (t - .1))),
        ("-2**2*TIME**3 + 90D*TIME", lambda t: -4 * t**3 + math.pi / 2 * t),
        ("2*sin(TIME) &\n + cos(3*TIME) ! a comment", lambda t: 2 * math.sin(t) + math.cos(3 * t)),
        ("RTOD*DTOR*EXP(-TIME)\n, + SQRT(1 +\n, TIME**2)", lambda t: math.exp(-t) + math.sqrt(1 + t * t)),
        ("VARVAL(7)*2", lambda t: 2 * math.tanh(t)),
        ("MIN(1, 0.5)*MAX(2, 3)*ATAN2(TIME, 2)", lambda t: 1.5 * math.atan2(t, 2)),
        ("SIGN(2, -3)*TIME + ABS(-4) + MOD(-7, 4) + AINT(-2.5) + DIM(5, 3)", lambda t: -2 * t + 4 - 3 - 2 + 2),
        ("IF(TIME - 1: 3*TIME, 3, 3 + 3*(TIME-1))", lambda t: 3 * t),
    ]
    text = "PART/1, GROUND\nVARIABLE/7, FUNCTION=TANH(TIME)\n"
    text += "".join(slider(k + 2, case[0]) for k, case in enumerate(cases))
    model, notes = convert("functions", text)
    tool.check(not notes, f"notes are {notes}")
    channels = ", ".join(f"joint_{k + 2}.displacement" for k in range(len(cases)))
    table = tool.run("adams_functions", tool.replace_analysis(
        model, "analysis: {type: kinematics, duration: 1.5, step: 0.05}\n"
        f"output: [{{file: results.csv, every: 0.05, channels: [{channels}]}}]\n"))
    for k, (source, f) in enumerate(cases):
        for t, x in zip(table["time"], table[f"joint_{k + 2}.displacement"]):
            tool.near(f"{source} at {t}", x, f(t), 1e-12 * 40)


def oscillator_in_tonnes_and_millimetres():
    """2 t on 300 N/mm and 0.2 N s/mm, free length 400 mm, from rest at 500 mm: m x'' = -k (x - l) - c x' - m g."""
    model, notes = convert("oscillator", TONNE_MM.replace(", TIME=MILLISECOND", "") + (
        "ACCGRAV/KGRAV=-9806.65\n"
        "PART/1, GROUND\nMARKER/11, PART=1\n"
        "! adams_view_name='load'\nPART/2, MASS=2, QG=0, 0, 500, CM=21, IP=1E6, 1E6, 1E6\n"
        "MARKER/21, PART=2, QP=0,0,0\n"
        "JOINT/1, TRANS, I=21, J=11\n"
        "SPRINGDAMPER/1, TRANSLATION, I=21, J=11, C=0.2, K=300, LENGTH=400, FORCE=50\n"))
    tool.check(not notes, f"notes are {notes}")
    tool.check("name: load" in model and "mass: 2000" in model, "the name and the unit of the mass")
    table = tool.run("adams_oscillator", tool.replace_analysis(
        model, "analysis: {type: dynamics, duration: 2, tolerance: 1e-12}\n"
        "output: [{file: results.csv, every: 0.1, channels: [load.position]}]\n"))
    m, k, c, g = 2000.0, 300000.0, 200.0, 9.80665
    rest = 0.4 + (50.0 - m * g) / k
    s, w = c / (2 * m), math.sqrt(k / m - (c / (2 * m))**2)
    for t, x in zip(table["time"], table["load.position.z"]):
        a = 0.5 - rest
        wanted = rest + math.exp(-s * t) * a * (math.cos(w * t) + s / w * math.sin(w * t))
        tool.near(f"the load at {t}", x, wanted, 1e-9)


def force_by_a_function():
    """A mass of 4 kg that a GFORCE drives along x of its RM, which is y of the ground, in milliseconds and
    millimetres: y'' = F sin(w t)/m; and an SFORCE as a spring with a dead band, in the dead band."""
    model, _ = convert("gforce", (
        "UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=MILLISECOND\n"
        "PART/1, GROUND\nMARKER/11, PART=1, REULER=90D, 0, 0\nMARKER/12, PART=1, QP=500, 0, 0\n"
        "PART/2, MASS=4, CM=21, IP=1,1,1\nMARKER/21, PART=2\n"
        "GFORCE/1, I=21, JFLOAT=12, RM=11, FX=8*SIN(2E-3*TIME)\\FY=0\\FZ=0\\\n"
        "SFORCE/1, TRANSLATIONAL, I=21, J=12, FUNCTION=IF(DM(21,12) - 5E6: 0, 0, 5E6 - DM(21,12))\n"))
    table = tool.run("adams_gforce", tool.replace_analysis(
        model, "analysis: {type: dynamics, duration: 3, tolerance: 1e-12}\n"
        "output: [{file: results.csv, every: 0.25, channels: [part_2.position]}]\n"))
    for t, y in zip(table["time"], table["part_2.position.y"]):
        tool.near(f"the mass at {t}", y, 8.0 / 4.0 * (t / 2 - math.sin(2 * t) / 4), 1e-9)


def couplings():
    """Two wheels of radii 0.2 and 0.1 m that mesh, a rack on the second, a third that a coupler turns."""
    def wheel(part, x):
        return (f"PART/{part}, MASS=1, QG={x}, 0, 0, CM={part}1, IP=1, 1, 1\nMARKER/{part}1, PART={part}\n"
                f"MARKER/{part}2, PART=1, QP={x}, 0, 0\nJOINT/{part}, REVOLUTE, I={part}1, J={part}2\n")

    model, notes = convert("couplings", (
        "PART/1, GROUND\nMARKER/19, PART=1, QP=0.2, 0, 0, REULER=0, -90D, 0\n" +
        wheel(2, 0.0) + wheel(3, 0.3) + wheel(4, 1.0) +
        "PART/5, MASS=1, QG=0.3, -0.1, 0, CM=51, IP=1, 1, 1\nMARKER/51, PART=5, REULER=90D, 90D, 0\n"
        "MARKER/52, PART=1, QP=0.3, -0.1, 0, REULER=90D, 90D, 0\nJOINT/5, TRANSLATIONAL, I=51, J=52\n"
        "GEAR/1, JOINTS=2, 3, CV=19\nCOUPLER/1, JOINTS=2, 4, TYPE=R:R, SCALES=-3\n"
        "JOINT/6, RACKPIN, I=31, J=51, PD=0.2\n"
        "MOTION/1, JOINT=2, ROTATION, VELOCITY, FUNCTION=2.5\n"))
    tool.check(not notes, f"notes are {notes}")
    table = tool.run("adams_couplings", tool.replace_analysis(
        model, "analysis: {type: kinematics, duration: 2, step: 0.5}\n"
        "output: [{file: results.csv, every: 0.5, channels: [joint_2.angle, joint_3.angle, joint_4.angle, "
        "part_5.position]}]\n"))
    for n, t in enumerate(table["time"]):
        tool.near("the driven wheel", table["joint_2.angle"][n], 2.5 * t, 1e-12 * 20)
        tool.near("its neighbour", table["joint_3.angle"][n], -5.0 * t, 1e-12 * 20)
        tool.near("the coupled wheel", table["joint_4.angle"][n], 2.5 * t / 3, 1e-12 * 20)
        # z of marker 51 is x of the ground
        tool.near("the rack", table["part_5.position.x"][n], 0.3 - 0.1 * 5.0 * t, 1e-12 * 20)


def freedoms_of_primitives_and_joints():
    base = ("PART/1, GROUND\nMARKER/11, PART=1\nMARKER/12, PART=1, ZP=1, 0, 0\n"
            "PART/2, MASS=1, CM=21, IP=1, 1, 1\nMARKER/21, PART=2\n")
    for kind, freedoms in (("JPRIM/1, ATPOINT", 3), ("JPRIM/1, INLINE", 4), ("JPRIM/1, INPLANE", 5),
                           ("JPRIM/1, ORIENTATION", 3), ("JPRIM/1, PARALLEL_AXES", 4),
                           ("JOINT/1, REVOLUTE", 1), ("JOINT/1, CYLINDRICAL", 2), ("JOINT/1, SPHERICAL", 3),
                           ("JOINT/1, PLANAR", 3), ("JOINT/1, FIXED", 0), ("JOINT/1, HOOKE", 2),
                           ("JOINT/1, SCREW, PITCH=0.1", 1)):
        convert("freedoms", base + f"{kind}, I=21, J=11\n")
        done = subprocess.run([tool.PROGRAM, "check", "--json", str(tool.WORK / "freedoms.adm.yaml")],
                              capture_output=True, text=True, check=False)
        tool.check(done.returncode == 0, f"{kind}: {done.stdout}{done.stderr}")
        tool.near(kind, json.loads(done.stdout)["freedoms"], freedoms, 0)
    model, _ = convert("perpendicular", base + "JPRIM/1, PERPENDICULAR, I=21, J=12\n")
    tool.check("type: perpendicular" in model, "PERPENDICULAR")


def inertia_elsewhere():
    """A rod of 3 kg and 2 m, its inertia about its end in turned axes, swings about that end: the torque that
    holds a given motion is (m l^2/3) a."""
    J = 3.0 * 4.0 / 3.0
    model, _ = convert("rod", (
        "PART/1, GROUND\nMARKER/11, PART=1\n"
        f"PART/2, MASS=3, CM=21, IM=22, IP={J}, 1E-6, {J}\n"
        "MARKER/21, PART=2, QP=1, 0, 0, REULER=30D, 20D, 10D\nMARKER/22, PART=2, REULER=-90D, 0, 0\n"
        "MARKER/23, PART=2\nJOINT/1, REVOLUTE, I=23, J=11\nMOTION/1, JOINT=1, ROTATION, FUNCTION=TIME**2\n"))
    table = tool.run("adams_rod", tool.replace_analysis(
        model, "analysis: {type: inverse_dynamics, duration: 1}\n"
        "output: [{file: results.csv, every: 0.5, channels: [motion_1.effort]}]\n"))
    for value in table["motion_1.effort"]:
        tool.near("the torque", value, 2.0 * J, 1e-9)


def what_cannot_be_carried_is_listed():
    model, notes = convert("lost", (
        "PART/1, GROUND\nMARKER/11, PART=1\nPART/2, MASS=1, CM=21, IP=1,1,1\nMARKER/21, PART=2\n"
        "SFORCE/1, TRANSLATIONAL, I=21, J=11, FUNCTION=CUBSPL(TIME, 0, 1)\n"
        "JOINT/1, CONVEL, I=21, J=11\nCONTACT/1, IGEOM=1, JGEOM=2\nREQUEST/1, D, I=21, J=11\n"
        "MOTION/1, JOINT=1, ROTATION, FUNCTION=TIME\n"), code=1)
    tool.check([(n["kind"], n["line"]) for n in notes] ==
               [("lost", 8), ("lost", 11), ("lost", 7), ("lost", 9), ("note", 10)], f"notes are {notes}")
    tool.check("CUBSPL" in notes[2]["message"], "the function is named")
    tool.check("# Not carried, line 7" in model, "the list stands in the model")


def main():
    functions_of_time()
    oscillator_in_tonnes_and_millimetres()
    force_by_a_function()
    couplings()
    freedoms_of_primitives_and_joints()
    inertia_elsewhere()
    what_cannot_be_carried_is_listed()
    print("import.adams: passed")


main()
