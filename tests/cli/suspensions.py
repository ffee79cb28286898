#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Eight suspensions by their hardpoints alone, in bump and steer at once, beside a computation of their own.

    python3 suspensions.py SE3D FOLDER

The reference knows points and distances only: three points of the upright are sought whose distances from the chassis
and from each other are as given, by Newton's method with derivatives by complex steps; what else is on the upright goes
with them. Hardpoints are invented, of the kinds that cars have [mm]; the left wheel. Places and lengths must agree to
1e-6 mm, angles to 1e-6 degrees.
"""
import csv
import math
import subprocess
import sys

CARS = {
    "pushrod on the lower arm": dict(
        kind="wishbones", hub=(0, 600, 228), upper=(-8, 552, 320), lower=(4, 572, 130), upper_pin=((130, 282, 277), (-130, 282, 291)),
        lower_pin=((140, 195, 118), (-150, 195, 124)), tie=((68, 213, 152.6), (68, 586, 170)), camber=-1.2, toe=0.1,
        rod=dict(on="lower", outer=(4, 540, 146), inner=(0, 312, 402), pin=(0, 258, 372), axis=(1, 0, 0)),
        spring=((0, 56, 452), (0, 262, 446)), travel=30, rack=20),
    "pullrod on the upper arm": dict(
        kind="wishbones", hub=(3, 612, 254), upper=(-9.3, 571, 351), lower=(6.1, 590, 151), upper_pin=((118, 287, 302), (-141, 291, 316)),
        lower_pin=((161, 182, 133), (-122, 179, 139)), tie=((-61, 190, 173), (-72, 588, 189)), camber=-0.8, toe=-0.2,
        rod=dict(on="upper", outer=(-6, 540, 339), inner=(-11, 258, 121), pin=(-14, 231, 158), axis=(0.97, 0.05, -0.12)),
        spring=((-18, 190, 402), (-16, 183, 129)), travel=28, rack=18),
    "coil-over on the lower arm": dict(
        kind="wishbones", hub=(0, 780, 330), upper=(-21, 702, 471), lower=(9, 741, 201), upper_pin=((162, 431, 452), (-151, 447, 431)),
        lower_pin=((203, 372, 188), (-246, 381, 196)), tie=((131, 361, 239), (139, 733, 246)), camber=-1.9, toe=0.15,
        spring=((-8, 470, 688), (2, 640, 214)), travel=60, rack=45),
    "tall upright": dict(
        kind="wishbones", hub=(0, 810, 372), upper=(-38, 706, 752), lower=(14, 771, 251), upper_pin=((92, 470, 741), (-168, 468, 719)),
        lower_pin=((218, 392, 262), (-262, 402, 248)), tie=((-148, 381, 301), (-161, 758, 308)), camber=-0.3, toe=0.05,
        spring=((-14, 548, 861), (12, 652, 268)), travel=90, rack=70),
    "long arms": dict(
        kind="wishbones", hub=(0, 921, 412), upper=(-42, 851, 539), lower=(16, 880, 291), upper_pin=((141, 301, 588), (-189, 312, 541)),
        lower_pin=((262, 181, 361), (-211, 172, 318)), tie=((148, 171, 402), (131, 861, 399)), camber=0, toe=0,
        spring=((-61, 411, 958), (8, 700, 330)), travel=200, rack=60),
    "pushrod on the upright": dict(
        kind="wishbones", hub=(0, 790, 330), upper=(-12, 698, 452), lower=(4, 721, 212), upper_pin=((301, 242, 421), (-262, 238, 463)),
        lower_pin=((342, 131, 229), (-301, 128, 251)), tie=((121, 139, 300), (109, 702, 341)), camber=-3.2, toe=-0.1,
        rod=dict(on="upright", outer=(2, 690, 233), inner=(12, 251, 561), pin=(10, 202, 519), axis=(0.99, 0, 0.141)),
        spring=((31, 40, 558), (13, 181, 569)), travel=25, rack=15),
    "strut": dict(
        kind="strut", hub=(0, 742, 300), top=(-31, 571, 861), low=(-9, 601, 470), lower=(11, 719, 189),
        lower_pin=((24, 381, 203), (-298, 372, 211)), tie=((-131, 322, 259), (-139, 688, 251)), camber=-0.6, toe=0.1,
        spring=((-31, 571, 861), (-9, 601, 470)), travel=70, rack=60),
    "five links": dict(
        kind="links", hub=(0, 771, 318), links=(((181, 402, 421), (38, 682, 441)), ((-121, 421, 431), (-42, 691, 451)),
        ((221, 361, 201), (31, 701, 189)), ((-171, 281, 229), (-18, 711, 211)), ((-241, 441, 271), (-121, 702, 288))),
        camber=-1.1, toe=0.15, spring=((-31, 531, 671), (-14, 641, 221)), travel=60, rack=0),
}
ROWS = 40


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def plus(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def square(a, b):
    return dot(minus(a, b), minus(a, b))


def turn(axis, angle, v):
    a, c, s = unit(axis), math.cos(angle), math.sin(angle)
    side, along = cross(a, v), dot(a, v)
    return [v[k] * c + side[k] * s + a[k] * along * (1.0 - c) for k in range(3)]


def solve(rows, right):
    """Gaussian elimination with pivots."""
    m = [list(r) + [b] for r, b in zip(rows, right)]
    n = len(m)
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(m[i][k]))
        m[k], m[p] = m[p], m[k]
        for i in range(k + 1, n):
            f = m[i][k] / m[k][k]
            m[i] = [x - f * y for x, y in zip(m[i], m[k])]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (m[k][n] - sum(m[k][j] * x[j] for j in range(k + 1, n))) / m[k][k]
    return x


def newton(f, x):
    for _ in range(30):
        columns = []
        for j in range(len(x)):
            z = [complex(v) for v in x]
            z[j] += 1e-30j
            columns.append([v.imag / 1e-30 for v in f(z)])
        step = solve(list(zip(*columns)), [-v for v in f(x)])
        x = plus(x, step)
        if max(map(abs, step)) < 1e-10:
            return x
    sys.exit("the reference does not converge")


def place_of(base, point):
    """A point in the oblique axes of three points."""
    e, g = minus(base[1], base[0]), minus(base[2], base[0])
    return solve(list(zip(e, g, cross(e, g))), minus(point, base[0]))


def follow(base, place):
    e, g = minus(base[1], base[0]), minus(base[2], base[0])
    out = plus(base[0], e, place[0])
    return plus(plus(out, g, place[1]), cross(e, g), place[2])


def spin_of(car):
    return turn((0, 0, 1), math.radians(-car["toe"]), turn((1, 0, 0), math.radians(-car["camber"]), (0, 1, 0)))


def equations(car, base, lift, rack):
    """What the three points of the upright must satisfy."""
    hub, pairs, lines = place_of(base, car["hub"]), [], []
    where = {k: place_of(base, p) for k, p in enumerate(base)}
    if car["kind"] == "links":
        pairs = [(place_of(base, outer), inner, inner, outer) for inner, outer in car["links"]]
    else:
        if car["kind"] == "wishbones":
            pairs += [(where[0], pin, pin, car["upper"]) for pin in car["upper_pin"]]
        else:
            lines = [place_of(base, plus(car["low"], unit(minus(car["top"], car["low"])), 100.0))]
        pairs += [(where[1], pin, pin, car["lower"]) for pin in car["lower_pin"]]
        inner, outer = car["tie"]
        pairs.append((where[2], plus(inner, (0, rack, 0)), inner, outer))

    def f(x):
        points = [x[:3], x[3:6], x[6:]]
        out = [square(follow(points, place), now) - square(a, b) for place, now, a, b in pairs]
        out += [square(points[i], points[j]) - square(base[i], base[j]) for i, j in ((0, 1), (0, 2), (1, 2))]
        for place in lines: # the strut's axis meets the top
            out += cross(minus(follow(points, place), points[0]), minus(car["top"], points[0]))[:2]
        return out + [follow(points, hub)[2] - car["hub"][2] - lift]
    return f


def swing(rod, point, angle):
    """The angle of a rocker whose rod ends at `point`."""
    length = square(rod["outer"], rod["inner"])
    arm = minus(rod["inner"], rod["pin"])
    for _ in range(30):
        inner = plus(rod["pin"], turn(rod["axis"], angle, arm))
        rate = 2.0 * dot(minus(inner, point), cross(unit(rod["axis"]), minus(inner, rod["pin"])))
        step = (length - square(inner, point)) / rate
        angle += step
        if abs(step) < 1e-14:
            return angle
    sys.exit("the rocker does not converge")


def reference(car, lift, rack, memory):
    """Hub [mm], camber and toe [degrees], length of the spring [mm]."""
    base = [car["upper"], car["lower"], car["tie"][1]] if car["kind"] == "wishbones" else \
        [car["low"], car["lower"], car["tie"][1]] if car["kind"] == "strut" else [outer for _, outer in car["links"][:3]]
    x = newton(equations(car, base, lift, rack), memory.get("x") or [c for p in base for c in p])
    memory["x"] = x
    now = [x[:3], x[3:6], x[6:]]
    hub = follow(now, place_of(base, car["hub"]))
    a = minus(follow(now, place_of(base, plus(car["hub"], spin_of(car)))), hub)
    bodies = {"upright": (base, now)}
    for name, k in (("upper", 0), ("lower", 1)):
        if name + "_pin" in car:
            pin = list(car[name + "_pin"])
            bodies[name] = (pin + [base[k]], pin + [now[k]])
    top, low = car["spring"]
    if "rod" in car:
        rod = car["rod"]
        before, after = bodies[rod["on"]]
        memory["angle"] = swing(rod, follow(after, place_of(before, rod["outer"])), memory.get("angle", 0.0))
        low = plus(rod["pin"], turn(rod["axis"], memory["angle"], minus(low, rod["pin"])))
    else:
        before, after = bodies["lower" if car["kind"] == "wishbones" else "upright"]
        low = follow(after, place_of(before, low))
    return hub + [math.degrees(math.asin(-a[2])), math.degrees(math.atan2(a[0], a[1])), math.sqrt(square(top, low))]


def text_of(v):
    return "[" + ", ".join(repr(float(c)) for c in v) + "]"


def body(name, at):
    return "{name: %s, mass: 2, inertia: [2e4, 2e4, 2e4], position: %s}" % (name, text_of(at))


def link(name, i, at, j, at_2):
    return "{name: %s, type: distance, body_i: %s, body_j: %s, at: %s, at_2: %s}" % (name, i, j, text_of(at), text_of(at_2))


def model_of(car):
    """The model file: points as they are, no length, no local frame."""
    bodies = ["{name: chassis, mass: 100, inertia: [1e7, 1e7, 1e7], fixed: true}", body("upright", car["hub"])]
    joints, rows = [], []
    rack = "rack" if car["rack"] else "chassis"
    if car["rack"]:
        bodies.append(body("rack", (0, 0, 300)))
        joints.append("{name: guide, type: prismatic, body_i: chassis, body_j: rack, at: [0, 0, 300], axis: [0, 1, 0]}")
        rows.append("drivers: [{name: hands, joint: guide, value: \"%r*sin(360 deg/s*t)\"}]" % float(car["rack"]))
    for name in ("upper", "lower"):
        if name + "_pin" in car:
            front, rear = car[name + "_pin"]
            bodies.append(body(name, front))
            joints.append("{name: %s_pin, type: revolute, body_i: chassis, body_j: %s, at: %s, axis: %s}" % (
                name, name, text_of(front), text_of(minus(front, rear))))
            joints.append("{name: %s_ball, type: spherical, body_i: %s, body_j: upright, at: %s}" % (name, name, text_of(car[name])))
    if "tie" in car:
        joints.append(link("tie", rack, car["tie"][0], "upright", car["tie"][1]))
    for k, (inner, outer) in enumerate(car.get("links", ())):
        joints.append(link("link%d" % k, "chassis", inner, "upright", outer))
    spring_on = "lower" if car["kind"] == "wishbones" else "upright"
    if "rod" in car:
        rod, spring_on = car["rod"], "rocker"
        bodies.append(body("rocker", rod["pin"]))
        joints.append("{name: rocker_pin, type: revolute, body_i: chassis, body_j: rocker, at: %s, axis: %s}" % (
            text_of(rod["pin"]), text_of(rod["axis"])))
        joints.append(link("rod", rod["on"], rod["outer"], "rocker", rod["inner"]))
    if car["kind"] == "strut":
        bodies.append(body("piston", car["top"]))
        joints.append("{name: mount, type: spherical, body_i: chassis, body_j: piston, at: %s}" % text_of(car["top"]))
        joints.append("{name: strut, type: prismatic, body_i: upright, body_j: piston, at: %s, axis: %s}" % (
            text_of(car["low"]), text_of(minus(car["top"], car["low"]))))
    top, low = car["spring"]
    rows.append("forces: [{name: spring, type: tsda, body_i: chassis, body_j: %s, at: %s, at_2: %s, k: 30}]" % (
        spring_on, text_of(top), text_of(low)))
    rows.append("constraints: [{name: road, type: cd, body_i: ground, body_j: upright, c: [0, 0, 1], at_2: %s, "
                "value: \"%r + %r*sin(180 deg/s*t)\"}]" % (text_of(car["hub"]), float(car["hub"][2]), float(car["travel"])))
    rows.append("wheels: [{name: hub, body: upright, chassis: chassis, at: %s, axis: %s, radius: %r, spring: spring}]" % (
        text_of(car["hub"]), text_of(spin_of(car)), float(car["hub"][2])))
    rows.append("analysis: {type: kinematics, duration: 2, step: %r}" % (2.0 / ROWS))
    rows.append("output: [{file: out.csv, channels: [upright.position, hub.camber, hub.toe, spring.length]}]")
    return "\n".join(["se3d: 1", "units: {length: mm, force: N, mass: kg, time: s, angle: deg}", "bodies:"] +
                     ["  - " + b for b in bodies] + ["joints:"] + ["  - " + j for j in joints] + rows) + "\n"


def check(program, folder, name, car):
    path = "%s/%s.yaml" % (folder, name.replace(" ", "_"))
    with open(path, "w") as file:
        file.write(model_of(car))
    run = subprocess.run([program, "run", path, "-o", path + ".run"], capture_output=True, text=True)
    if run.returncode:
        return "%s: %s" % (name, run.stderr)
    worst, memory, most = [0.0] * 6, {}, 0.0
    with open(path + ".run/out.csv") as file:
        rows = list(csv.reader(file))[1:]
    scale = [1e3, 1e3, 1e3, 180.0 / math.pi, 180.0 / math.pi, 1e3]
    for row in rows:
        t, *values = map(float, row)
        expected = reference(car, car["travel"] * math.sin(math.pi * t), car["rack"] * math.sin(2.0 * math.pi * t), memory)
        worst = [max(w, abs(v * s - e)) for w, v, s, e in zip(worst, values, scale, expected)]
        most = max(most, abs(expected[4] - car["toe"]))
    print("%-28s %d rows, off by %s" % (name, len(rows), " ".join("%.1e" % w for w in worst)))
    fine = len(rows) == ROWS + 1 and most > 1.0 and all(w < 1e-6 for w in worst)
    return None if fine else "%s: %d rows, off by %s, toe changes by %g" % (name, len(rows), worst, most)


def main():
    problems = [p for p in (check(sys.argv[1], sys.argv[2], *item) for item in CARS.items()) if p]
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
