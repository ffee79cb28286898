#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run the bench: compare.py FOLDER [SECTION...]

FOLDER holds the drivers: bench_serve and bench_evaluation (this library), and what there is of
mujoco, bullet, simbody, ode.
SECTION: cost work fourbar pendulum implicit lanes batch query touch; all by default. Times are CPU times that the
drivers measure inside; engines take turns, and the least of several runs counts.
"""
import math
import os
import select
import subprocess
import sys

ROUNDS = 4  # turns of each engine where times are compared
SLICE = 0.02  # [s] of CPU in one turn
LIMIT = 0.35  # [s] of CPU: longer runs are extrapolated in the search
TARGETS = (1e-3, 1e-5, 1e-7, 1e-9)

# Tips at t = 1 s (one bar: 5 s). Minimal coordinates in quadruple precision; the chains of 2 and 32
# with balls: this library at tolerance 1e-13, and Simbody at 1e-12 alike to 3e-12 m.
TIPS = {
    ("a", 1): (-0.980009892555, -0.198948763489, 0.0),
    ("a", 2): (-1.66276411813259669, -1.0412475169057369, 0.0),
    ("a", 8): (5.18365835706, -4.87899149535, 0.0),
    ("a", 32): (30.5302553705, -4.90500000005, 0.0),
    ("b", 1): (-0.980008964342, -0.198948832257, -0.00133863856),
    ("b", 2): (-1.6627641423916, -1.0412474732072, -0.000113661228113),
    ("b", 8): (5.18365835455, -4.87899147099, -1.7493042e-5),
    ("b", 32): (30.5302553705665, -4.9050000000543, 0.0),
}
# Top of the first bar at t = 10 s: theta'' = g ((n + 1)/2 + n)/((n + 1)/3 + n) sin theta.
FOURBAR_TIPS = {
    1: (0.47838505776097056, 0.8781501787912093, 0.0),
    5: (0.23578913584525585, 0.97180424130446533, 0.0),
    40: (0.18051222668672839, 0.98357274058231157, 0.0),
}
WORK_RATIOS = {  # allowed share of the best peer's time, per target
    ("a", 1): (0.25, 0.15, 0.1, 0.06),
    ("b", 1): (0.4, 0.1, 0.1, 0.1),
}


class Engine:
    """A driver that runs and answers; None answers where it fails or takes too long."""

    def __init__(self, folder, name):
        self.name = name
        self.path = os.path.join(folder, name)
        self.process = None

    def exists(self):
        return os.access(self.path, os.X_OK)

    def start(self):
        environment = dict(os.environ, OMP_NUM_THREADS="1")
        self.process = subprocess.Popen(
            [self.path], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, env=environment, bufsize=0)

    def stop(self):
        if self.process:
            self.process.kill()
            self.process.wait()
            self.process = None

    def ask(self, kind, n, method, setting, duration, samples=1, repeats=1, wall=15.0):
        if not self.process:
            self.start()
        line = f"{kind} {n} {method} {setting!r} {duration!r} {samples} {repeats}\n"
        try:
            self.process.stdin.write(line.encode())
            ready, _, _ = select.select([self.process.stdout], [], [], wall)
            answer = self.process.stdout.readline().decode().split() if ready else []
        except OSError:
            answer = []
        if not answer:
            self.stop()  # hangs or died
            return None
        if answer[0] != "ok":
            return None
        values = [float(x) for x in answer[1:]]
        keys = ("seconds", "x", "y", "z", "drift", "gap", "steps", "evaluations", "iterations",
                "factorizations")
        return dict(zip(keys, values))


class Way:
    """An engine with a method; `fixed`: its setting is the step, else the tolerance."""

    def __init__(self, engine, method, fixed, label):
        self.engine, self.method, self.fixed, self.label = engine, method, fixed, label

    def run(self, kind, n, setting, duration, **options):
        return self.engine.ask(kind, n, self.method, setting, duration, **options)

    def ladder(self, duration):
        """Settings from coarse to fine."""
        if self.fixed:
            return [duration / 2**k for k in range(1, 22)]
        return [0.5] + [10.0**-k for k in range(1, 13)]


def tip_error(answer, tip):
    size = math.sqrt(sum(x * x for x in tip))
    return math.dist((answer["x"], answer["y"], answer["z"]), tip) / size


def search(way, kind, n, duration, error, targets, samples=1, limit=LIMIT):
    """For each target the coarsest setting from which on the error stays below it, as (setting,
    seconds, answer); setting None: seconds are extrapolated; None: it was not reached."""
    points = []
    for setting in way.ladder(duration):
        answer = way.run(kind, n, setting, duration, samples=samples, wall=6 * limit + 5)
        if answer is None:
            if points and not way.fixed:
                break
            continue
        points.append((setting, error(answer), answer))
        if points[-1][1] <= targets[-1] and len(points) > 1 and points[-2][1] <= targets[-1]:
            break
        if answer["seconds"] > limit:
            break
    return [find_setting(way, kind, n, duration, error, target, points, samples)
            for target in targets]


def find_setting(way, kind, n, duration, error, target, points, samples):
    good = len(points)
    while good > 0 and points[good - 1][1] <= target:
        good -= 1
    if good == len(points):
        return extrapolate(way, target, points)
    fine, answer = points[good][0], points[good][2]
    if good > 0:
        coarse = points[good - 1][0]
        for _ in range(3):  # to within an eighth of the rung, on a logarithmic scale
            middle = math.sqrt(coarse * fine)
            trial = way.run(kind, n, middle, duration, samples=samples)
            if trial is not None and error(trial) <= target:
                fine, answer = middle, trial
            else:
                coarse = middle
    return fine, answer["seconds"], answer


def extrapolate(way, target, points):
    """By the observed order; fixed steps only."""
    if not way.fixed or len(points) < 3:
        return None
    (_, e0, _), (_, e1, answer) = points[-2:]
    if not 0 < e1 < e0 or math.log2(e0 / e1) < 0.7:
        return None
    return None, answer["seconds"] * (e1 / target) ** (1 / math.log2(e0 / e1)), answer


def time_in_turn(kind, n, duration, choices):
    """choices: [(way, setting, guess)] -> the least seconds of each, measured in turns."""
    least = [guess for _, _, guess in choices]
    for _ in range(ROUNDS):
        for k, (way, setting, guess) in enumerate(choices):
            repeats = max(1, min(200, int(SLICE / max(guess, 1e-6))))
            answer = way.run(kind, n, setting, duration, repeats=repeats)
            if answer:
                least[k] = min(least[k], answer["seconds"])
    return least


def best_at(results, kind, n, duration, index):
    """Time what each way found for target `index` -> {way: (seconds, extrapolated)}."""
    times, choices = {}, []
    for way, found in results.items():
        if found[index] is None:
            continue
        if found[index][0] is None:
            times[way] = (found[index][1], True)
        else:
            choices.append((way, *found[index][:2]))
    for (way, _, _), seconds in zip(choices, time_in_turn(kind, n, duration, choices)):
        times[way] = (seconds, False)
    return times


def evaluations(ways, times, results, index):
    """Accelerations that the fastest of the ways needed; peers: stages times steps."""
    found = [way for way in ways if way in times and not times[way][1]]
    if not found:
        return "-"
    way = min(found, key=lambda w: times[w][0])
    answer = results[way][index][2]
    stages = 5 if way.label == "Simbody" else 4
    return f"{answer['evaluations'] or stages * answer['steps']:.0f} ({way.label})"


def show_time(entry):
    if entry is None:
        return "-"
    return ("~" if entry[1] else "") + f"{1e3 * entry[0]:.3g}"


class Bench:
    def __init__(self, folder):
        self.folder = folder
        self.ours = Engine(folder, "bench_serve")
        self.inside = Engine(folder, "bench_evaluation")
        self.peers = {name: Engine(folder, name)
                      for name in ("mujoco", "bullet", "simbody", "ode")}
        for name, engine in list(self.peers.items()):
            if not engine.exists():
                print(f"!! {name} is missing: its columns are left out")
                del self.peers[name]

    def close(self):
        for engine in [self.ours, self.inside, *self.peers.values()]:
            engine.stop()

    def peer_ways(self, rows):
        return [Way(self.peers[name], method, fixed, label)
                for name, method, fixed, label in rows if name in self.peers]

    def cost(self):
        """Nanoseconds per link of one acceleration; of peers, per step at h = 1e-3 s."""
        ways = self.peer_ways([
            ("mujoco", "euler", True, "MuJoCo Euler"), ("mujoco", "rk4", True, "MuJoCo RK4 / 4"),
            ("bullet", "euler", True, "Bullet Euler"), ("bullet", "rk4", True, "Bullet RK4 / 4"),
            ("simbody", "euler", True, "Simbody Euler"), ("ode", "direct", True, "ODE direct")])
        print("\n## Cost of one acceleration evaluation, ns per link")
        print("(ours: alone, and everything that dop853 spends in a run of tolerance 1e-6, per evaluation;")
        print(" peers: one step of 1 ms; Runge-Kutta: a quarter of it; ratio: joint alone / best)")
        names = ["ours romega", "ours rp", "ours joint", "in dop853", "rp/romega"] + [way.label for way in ways] + ["ratio"]
        print(f"{'chain':>8} " + " ".join(f"{name:>14}" for name in names))
        for kind in "ab":
            before = {}
            for n in (1, 2, 8, 32, 128, 512):
                self.cost_row(kind, n, ways, before)

    def cost_row(self, kind, n, ways, before):
        ours, peers = {}, {}
        for _ in range(ROUNDS):
            for formulation in ("/romega", "/rp", "/joint"):
                answer = self.inside.ask(kind, n, "evaluation" + formulation, 0.0, 0.0)
                if answer:
                    each = answer["seconds"] / answer["evaluations"]
                    ours[formulation] = min(each, ours.get(formulation, 1e300))
            answer = self.ours.ask(kind, n, "dop853", 1e-6, 0.2, repeats=max(1, 64 // n))
            if answer:
                each = answer["seconds"] / answer["evaluations"]
                ours["run"] = min(each, ours.get("run", 1e300))
            for way in ways:
                last, seconds = before.get(way.label, (1, 2e-6))
                guess = seconds * (n / last) ** (3 if seconds > 1e-4 else 1)
                if guess > 0.1:
                    continue  # grows with the cube: it would take minutes
                steps = max(2, min(1000, int(SLICE / guess)))
                answer = way.run(kind, n, 1e-3, 1e-3 * steps)
                if answer:
                    each = answer["seconds"] / steps
                    peers[way.label] = min(each, peers.get(way.label, 1e300))
        before.update({label: (n, seconds) for label, seconds in peers.items()})
        shares = {label: s / (4 if "/ 4" in label else 1) for label, s in peers.items()}
        cells = [f"{1e9 * ours[f] / n:14.0f}" if f in ours else f"{'-':>14}" for f in ("/romega", "/rp", "/joint", "run")]
        cells.append(f"{ours['/rp'] / ours['/romega']:14.2f}" if len(ours) == 4 else f"{'-':>14}")
        cells += [f"{1e9 * shares[way.label] / n:14.0f}" if way.label in shares else f"{'-':>14}"
                  for way in ways]
        if shares and "/joint" in ours:
            cells.append(f"{ours['/joint'] / min(shares.values()):14.2f}")
        print(f"{kind + ' ' + str(n):>8} " + " ".join(cells), flush=True)

    def work(self):
        """Work and precision on chains."""
        peers = self.peer_ways([("mujoco", "rk4", True, "MuJoCo RK4"),
                                ("bullet", "rk4", True, "Bullet RK4"),
                                ("simbody", "merson", False, "Simbody")])
        ours = [Way(self.ours, "auto", False, "auto"), Way(self.ours, "dop853", False, "dop853"),
                Way(self.ours, "rk45", False, "rk45"),
                Way(self.ours, "step_dop853", True, "dop853 h"),
                Way(self.ours, "step_rk45", True, "rk45 h"), Way(self.ours, "rk4", False, "rk4"),
                Way(self.ours, "step_rk4", True, "rk4 h")]
        print("\n## Work and precision: CPU ms for 1 s (one bar: 5 s) to a relative tip error")
        print("(dop853 h, rk45 h, rk4 h: equal steps without error control, as both RK4; ratio: the best"
              "\n of ours / the best peer; mark: the aim; ~ extrapolated)")
        names = [way.label for way in ours + peers]
        print(f"{'chain':>6} {'error':>6} " + " ".join(f"{name:>10.10}" for name in names) +
              f" {'ratio':>7} {'mark':>5}  evaluations: ours, best peer")
        for kind in "ab":
            for n in (1, 2, 8, 32):
                self.work_case(kind, n, ours, peers)

    def work_case(self, kind, n, ours, peers):
        duration = 5.0 if n == 1 else 1.0
        tip = TIPS[kind, n]
        results = {way: search(way, kind, n, duration, lambda a: tip_error(a, tip), TARGETS)
                   for way in ours + peers}
        for index, target in enumerate(TARGETS):
            times = best_at(results, kind, n, duration, index)
            row = f"{kind + ' ' + str(n):>6} {target:6.0e} "
            row += " ".join(f"{show_time(times.get(way)):>10}" for way in ours + peers)
            mine = [times[way][0] for way in ours if way in times]
            theirs = [times[way][0] for way in peers if way in times]
            if mine and theirs:
                ratio, mark = min(mine) / min(theirs), WORK_RATIOS[kind, 1][index]
                row += f" {ratio:7.3f} {mark:5.2f}  "
                row += ", ".join(evaluations(w, times, results, index) for w in (ours, peers))
                row += "" if ratio <= mark else "  short"
            print(row, flush=True)

    def fourbar(self):
        """Closed loops through singular positions, 10 s."""
        peers = self.peer_ways([("mujoco", "rk4/2/.9999", True, "MuJoCo 2h"),
                                ("mujoco", "rk4/1/.9999", True, "MuJoCo 1h"),
                                ("mujoco", "rk4/.5/.9999", True, "MuJoCo h/2")])
        ours = [Way(self.ours, "auto", False, "auto"), Way(self.ours, "dop853", False, "dop853")]
        exact = [Way(self.ours, "auto", False, "tip 1e-6"),
                 Way(self.ours, "dop853", False, "dop853 1e-6")]
        print("\n## Four-bar windows, 10 s, plain revolutes: CPU ms to a drift of energy")
        print("(on the right branch: tip within .01 m; 'tip 1e-6', 'dop853 1e-6': also tip within 1e-6 m,")
        print(" gap within 1e-10; MuJoCo RK4, Newton, loops by `connect`: time constant 2 h (its safe")
        print(" least), 1 h and h/2 (its safeguard off), impedance .9999; ratios: best of ours to drift,")
        print(" and to drift and tip, over the best of MuJoCo to drift)")
        names = [way.label for way in ours + exact + peers]
        print(f"{'n':>4} {'drift':>6} " + " ".join(f"{name:>11}" for name in names) +
              f" {'ratio':>7} {'with tip':>8} {'mark':>6}")
        for n in (1, 5, 40):
            self.fourbar_case(n, ours, exact, peers)
        print("\n## Four-bar windows: every tolerance (tip [m] at 10 s, largest drift [J] and gap)")
        print(f"{'method':>7} {'n':>4} {'tolerance':>9} {'CPU ms':>9} {'tip':>9} {'drift':>9} {'gap':>9} "
              f"{'steps':>6} {'evaluations':>11}")
        for n in (1, 5, 40):
            for way in ours:
                self.fourbar_tolerances(n, way)

    def fourbar_case(self, n, ours, exact, peers):
        tip = FOURBAR_TIPS[n]

        def drift(answer):
            return answer["drift"] if tip_error(answer, tip) < 0.01 else 1e300

        def drift_and_tip(answer):
            is_exact = tip_error(answer, tip) <= 1e-6 and answer["gap"] <= 1e-10
            return answer["drift"] if is_exact else 1e300

        targets = (1e-3, 1e-5)
        results = {way: search(way, "f", n, 10.0, error, targets, samples=20, limit=0.7)
                   for ways, error in ((ours, drift), (exact, drift_and_tip), (peers, drift))
                   for way in ways}
        for index, target in enumerate(targets):
            times = best_at(results, "f", n, 10.0, index)
            row = f"{n:>4} {target:6.0e} "
            row += " ".join(f"{show_time(times.get(way)):>11}" for way in ours + exact + peers)
            least = [min((times[way][0] for way in ways if way in times), default=None)
                     for ways in (ours, exact, peers)]
            mark = (0.15, 0.05)[index]
            if None not in least:
                ratios = [time / least[2] for time in least[:2]]
                row += (f" {ratios[0]:7.4f} {ratios[1]:8.4f} {mark:6.2f}"
                        f" {'' if ratios[0] <= mark else 'short'}")
            print(row, flush=True)

    def fourbar_tolerances(self, n, ours):
        for k in range(3, 12):
            answer = ours.run("f", n, 10.0**-k, 10.0, samples=20, wall=30.0)
            if answer is None:
                print(f"{ours.label:>7} {n:>4} {10.0**-k:9.0e}   failed, or took more than 30 s")
                continue
            print(f"{ours.label:>7} {n:>4} {10.0**-k:9.0e} {1e3 * answer['seconds']:9.3g} "
                  f"{tip_error(answer, FOURBAR_TIPS[n]):9.1e} {answer['drift']:9.1e} "
                  f"{answer['gap']:9.1e} {answer['steps']:6.0f} {answer['evaluations']:11.0f}",
                  flush=True)

    def pendulum(self):
        """IFToMM A01."""
        ways = [Way(self.ours, "dop853", False, "ours dop853"),
                Way(self.ours, "rk45", False, "ours rk45")]
        ways += self.peer_ways([("mujoco", "rk4", True, "MuJoCo RK4")])
        print("\n## A01: point mass on a rod, 10 s, largest drift of energy below 5e-5 J (mark: 1 ms)")
        results = {way: search(way, "p", 1, 10.0, lambda a: a["drift"], (5e-5,), samples=100)
                   for way in ways}
        times = best_at(results, "p", 1, 10.0, 0)
        for way in ways:
            print(f"{way.label:>14} {show_time(times.get(way))} ms", flush=True)

    def show_program(self, name, *arguments):
        """The output of a program that searches nothing."""
        path = os.path.join(self.folder, name)
        if os.path.exists(path):
            print(subprocess.run([path, *arguments], text=True, check=False,
                                 stdout=subprocess.PIPE).stdout, end="", flush=True)

    def lanes(self):
        print("\n## Recursions of joint coordinates, ns a link: one state, and 4 or 8 in lanes",
              flush=True)
        self.show_program("bench_tree", "1", "2", "8", "32", "512")

    def batch(self):
        print("\n## Batches: arms of six revolutes, 1 ms steps with new efforts", flush=True)
        self.show_program("bench_batch", "4096", "1")
        self.show_program("mujoco_batch", "64")
        self.show_program("bench_batch", "4096", "1", "plane")
        self.show_program("mujoco_batch", "64", "plane")

    def touch(self):
        print("\n## Boxes that touch, 3 s at steps of 2 ms (1000 boxes: .5 s), about the same overlap at rest",
              flush=True)
        for scene, n, duration in (("heap", 27, 3), ("heap", 100, 3), ("heap", 1000, .5),
                                   ("stack", 30, 3), ("dominoes", 20, 3), ("pyramid", 55, 3),
                                   ("wall", 37, 3), ("cards", 15, 3)):
            stiffness = "1e6" if scene == "stack" else "3e5"  # softer ones of 3 m buckle
            for _ in range(2 if n < 1000 else 1):
                self.show_program("bench_touch", scene, str(n), ".002", str(duration), stiffness)
                if n < 1000:  # its data for 1000 do not fit into its memory
                    self.show_program("mujoco_touch", scene, str(n), ".002", str(duration), "2", "Newton")

    def query(self):
        print("\n## Queries of one robot: set the state, forward or inverse dynamics", flush=True)
        for _ in range(2):
            self.show_program("bench_query")
            self.show_program("mujoco_query")
            self.show_program("pinocchio_query")

    def implicit(self):
        """Implicit methods on a long chain."""
        print("\n## Implicit methods, chain of 400 bars (revolutes), 1 ms steps: us per link")
        print("(mark per link and Newton iteration: romega .6, rp 1.2; published: Exudyn 2)")
        print(f"{'method':>22} {'iteration':>10} {'step':>7} {'iterations/step':>16}"
              f" {'factorizations/step':>20}")
        for method in ("generalized_alpha", "hht", "bdf", "radau", "rattle"):
            for formulation in ("", "/rp"):
                self.implicit_row(method, formulation)

    def implicit_row(self, method, formulation):
        links, best = 400, None
        setting = 1e-4 if method in ("bdf", "radau") else 1e-3
        for _ in range(3):
            answer = self.ours.ask("a", links, method + formulation, setting, 0.03)
            if answer is None or answer["iterations"] == 0:
                return
            best = answer if best is None or answer["seconds"] < best["seconds"] else best
        each = 1e6 * best["seconds"] / links
        print(f"{method + formulation:>22} {each / best['iterations']:10.2f} "
              f"{each / best['steps']:7.2f} {best['iterations'] / best['steps']:16.2f} "
              f"{best['factorizations'] / best['steps']:20.2f}", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    bench = Bench(sys.argv[1])
    try:
        for section in sys.argv[2:] or ("cost", "work", "fourbar", "pendulum", "implicit",
                                        "lanes", "batch", "query", "touch"):
            getattr(bench, section)()
    finally:
        bench.close()


if __name__ == "__main__":
    main()
