#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Granular beds here, in LAMMPS and in LIGGGHTS, in turn, from the same settled states; dimers, as
they fall into a box and settle, from lattices here and at random there.

    compare.py BENCH [--quick] [--edges 20 32 50] [--laws hooke hertz] [--avalanche 20] [--drum 20]
               [--funnel 21] [--drain 22] [--silo 19] [--clump 14] [--repeats 3]
               [--processes 1 2] [--keep FOLDER]

BENCH is bench_granular of a release build. Every round runs each program once; the least CPU time
of all rounds counts. A peer's time is that of lead and steps less that of the lead alone, so that
reading and setting up is not counted. Peers that are not installed are left out.
"""
import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
PITCH = 0.011
PLANES = 24  # of the drum
SIDES = 32  # of the hopper, a cylinder, a cone and a tube
RINGS = ((0.75, 1.5), (0.75, 0.0), (0.15, -0.6), (0.15, -0.7))  # radius and height over the width


def run(command, **more):
    """Output and CPU seconds of a command and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env=dict(os.environ, OMP_NUM_THREADS="1"), check=False, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout[-2000:]}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def write_triangles(name, triangles):
    with open(name, "w", encoding="ascii") as target:
        print("solid shell", file=target)
        for corners in triangles:
            print("facet normal 0 0 0\nouter loop", file=target)
            for vertex in corners:
                print("vertex %.9g %.9g %.9g" % vertex, file=target)
            print("endloop\nendfacet", file=target)
        print("endsolid shell", file=target)


def write_funnel(name, width):
    """The triangles of the hopper, as bench_granular has them."""
    def at(ring, k):
        angle = 2.0 * math.pi * (k % SIDES) / SIDES
        radius, height = RINGS[ring]
        return (width * (0.5 + radius * math.cos(angle)),
                width * (0.5 + radius * math.sin(angle)), width * height)
    triangles = []
    for ring in range(len(RINGS) - 1):
        for k in range(SIDES):
            triangles.append((at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)))
            triangles.append((at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)))
    write_triangles(name, triangles)


def write_shell(name, radius, width):
    """The planes of the drum about the z axis, two triangles each, a little longer than it is."""
    angles = [2.0 * math.pi * (k + 0.5) / PLANES for k in range(PLANES + 1)]
    corner = radius / math.cos(math.pi / PLANES)
    at = [(corner * math.cos(angle), corner * math.sin(angle)) for angle in angles]
    triangles = []
    for (x0, y0), (x1, y1) in zip(at, at[1:]):
        low, high = -0.009, 1.2 * width  # the bed is from 0 to width, the file's box from -0.01
        triangles.append(((x0, y0, low), (x1, y1, low), (x1, y1, high)))
        triangles.append(((x0, y0, low), (x1, y1, high), (x0, y0, high)))
    write_triangles(name, triangles)


class Case:
    """A bed of edge^3 spheres: a column, an avalanche (gravity is tilted), a drum that turns, of
    planes or of triangles, a hopper of triangles that empties, for a short time or for a second
    with what has left it counted, or a silo, which is one that does not."""

    LEADS = {"avalanche": 10000, "drum": 20000, "shell": 20000, "funnel": 5000, "silo": 300,
             "clump": 40000, "drain": 0}
    DRAINED = 100000  # steps
    DEPTH = 0.8  # over the width: who is deeper has left the hopper
    TILT = 45.0
    RATE = 2.0  # of the drum [rad/s]

    def __init__(self, options, kind, edge, law):
        self.kind, self.edge, self.law = kind, edge, law
        self.count = edge ** 3
        self.lead = self.LEADS.get(kind, 300 if edge < 30 else 50)
        self.steps = max(100, self.LEADS.get(kind, 0) // 2, round(options.work / self.count))
        if kind == "drain":
            self.steps = self.DRAINED
        self.has_state = kind != "clump"
        self.drum, self.hopper = kind in ("drum", "shell"), kind in ("funnel", "drain", "silo")
        bed = "drum" if self.drum else "funnel" if self.hopper else "column"
        self.state = os.path.join(options.keep, f"{bed}_{edge}_{law}.data")
        self.own = [options.bench, f"edge={edge}", f"law={law}"]
        self.own += [f"state={self.state}"] if self.has_state else ["clump=1", "settle=0"]
        self.own += [f"drum={self.RATE}"] if self.drum else []
        self.own += ["mesh=1"] if kind == "shell" else []
        self.own += ["funnel=1"] if self.hopper else []
        self.own += ["gate=1"] if kind == "silo" else []
        self.own += ["drain=1"] if kind == "drain" else []

    def settle(self):
        if not self.has_state:
            return
        if not os.path.exists(self.state):
            more = ["settle=120000"] if self.hopper else []
            run(self.own + more + ["steps=1", "lead=0"])
        with open(self.state, encoding="ascii") as source, \
                open(self.state + ".plain", "w", encoding="ascii") as target:
            text = source.read().replace("Atoms # sphere", "Atoms")
            if self.kind == "drain":  # who leaves the box is deleted there
                bottom = f"{-self.DEPTH * self.edge * PITCH} \\1 zlo zhi"
                text = re.sub(r"\S+ (\S+) zlo zhi", bottom, text)
            target.write(text)

    def ours(self, threads):
        """CPU seconds, those of the lead, seconds, and the program's words."""
        tilt = self.TILT if self.kind == "avalanche" else 0.0
        text, _ = run(self.own + [f"threads={threads}", f"tilt={tilt}", f"lead={self.lead}",
                                  f"steps={self.steps}", f"repeats={1 if self.kind in self.LEADS else 3}"])
        rates = re.search(r"([\d.]+) M particle-steps per CPU second, ([\d.]+) per second", text)
        work = 1e-6 * self.count * self.steps
        return work / float(rates[1]), 0.0, work / float(rates[2]), text

    def peer_inputs(self, program):
        """Name of the input, and its variables."""
        width = self.edge * PITCH
        if self.drum and program == "lammps":
            # the round shell about the places that our planes leave to the centres
            radius = 0.005 + (0.75 * width - 0.005) / math.cos(math.pi / PLANES)
            return "drum", ["-var", "radius", repr(radius), "-var", "rate", repr(-self.RATE)]
        if self.drum:
            shell = self.state + ".stl"
            write_shell(shell, 0.75 * width, width)
            return "drum", ["-var", "shell", shell, "-var", "period",
                            repr(-2.0 * math.pi / self.RATE)]
        if self.hopper:
            shell = self.state + ".stl"
            gate = ["-var", "gate", repr(RINGS[-1][1] * width)] if self.kind == "silo" else []
            write_funnel(shell, width)
            return "funnel", ["-var", "shell", shell] + gate
        if not self.has_state:
            dimer = self.state + ".dimer"
            with open(dimer, "w", encoding="ascii") as target:
                target.write("-0.0025 0 0 0.005\n0.0025 0 0 0.005\n")
            return "clump", ["-var", "count", str(self.count // 2), "-var", "dimer", dimer]
        angle = math.radians(self.TILT if self.kind == "avalanche" else 0.0)
        return self.law, ["-var", "gx", repr(math.sin(angle)), "-var", "gz",
                          repr(-math.cos(angle))]

    def peer(self, program, ranks):
        """The same of a peer, whose CPU seconds hold the lead."""
        name = "liggghts" if program == "liggghts" else "lammps"
        what, more = self.peer_inputs(name)
        state = self.state + (".plain" if program == "liggghts" else "")
        command = [program, "-in", f"{HERE}/{name}_{what}.in", "-log", "none",
                   "-var", "w", repr(self.edge * PITCH)] + more
        command += ["-var", "data", state] if self.has_state else []
        command += ["-var", "lead", str(self.lead), "-var", "steps"]
        if ranks > 1:
            command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)] + command
        with tempfile.TemporaryDirectory() as work:
            _, lead = run(command + ["0"], cwd=work) if ranks == 1 else ("", 0.0)
            text, total = run(command + [str(self.steps)], cwd=work)
        wall = float(re.findall(r"Loop time of ([\d.e+-]+)", text)[-1])
        lost = self.count - int(re.findall(r"steps with (\d+) atoms", text)[-1])
        word = "have left the hopper" if self.kind == "drain" else "lost"
        return total, lead, wall, f"{lost} {word}"


def measure(case, programs, options):
    """By (program, processes): M particle-steps per CPU second, per second, and words. Of the times
    of all rounds the least count, of what is subtracted too."""
    times = {}
    for _ in range(options.repeats):
        for processes in options.processes:
            for program in programs:
                result = (case.ours(processes) if program == "se3d"
                          else case.peer(program, processes))
                key = (program, processes)
                old = times.get(key, result)
                times[key] = tuple(map(min, result[:3], old[:3])) + result[3:]
    work = 1e-6 * case.count * case.steps
    return {key: (work / max(total - lead, 1e-9), work / wall, text)
            for key, (total, lead, wall, text) in times.items()}


def report(case, best, programs, processes):
    print(f"| {case.kind} {case.count} {case.law} |", end="")
    for number in processes:
        column = 0 if number == 1 else 1
        for program in programs:
            if (program, number) not in best:
                print(" |", end="")
                continue
            rate = best[program, number][column]
            ratio = best["se3d", number][column] / rate
            print(f" {rate:.1f}" + (f" ({ratio:.1f}) |" if program != "se3d" else " |"), end="")
    if 1 in processes and 2 in processes:
        print(f" {best['se3d', 2][1] / best['se3d', 1][1]:.2f} |", end="")
    print()
    words = best["se3d", processes[0]][2].splitlines()
    for program in programs:
        said = best.get((program, processes[0]), (0.0, 0.0, "0 lost"))[2]
        if program != "se3d" and said != "0 lost":
            words.append(f"{program}: {said}")
    print("\n".join("    " + line.strip() for line in words[1:]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("--edges", type=int, nargs="*", default=[20, 32, 50])
    parser.add_argument("--laws", nargs="*", default=["hooke", "hertz"])
    parser.add_argument("--avalanche", type=int, nargs="*", default=[20], help="edges")
    parser.add_argument("--drum", type=int, nargs="*", default=[20], help="edges")
    parser.add_argument("--funnel", type=int, nargs="*", default=[21], help="edges")
    parser.add_argument("--drain", type=int, nargs="*", default=[22], help="edges")
    parser.add_argument("--silo", type=int, nargs="*", default=[19], help="edges")
    parser.add_argument("--clump", type=int, nargs="*", default=[14], help="edges")
    parser.add_argument("--quick", action="store_true",
                        help="8,000 spheres only, each program once, for a short time")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--work", type=float, default=24e6, help="particle-steps of a peer")
    parser.add_argument("--processes", type=int, nargs="*", default=[1, 2],
                        help="1 and 2: two are threads here, ranks there")
    parser.add_argument("--keep", help="folder of the settled states")
    options = parser.parse_args()
    if options.quick:
        options.edges, options.repeats, options.work = [20], 1, 4e6
    options.bench = os.path.abspath(options.bench)
    options.keep = os.path.abspath(options.keep or tempfile.mkdtemp())
    programs = ["se3d"] + [p for p in ("lmp", "liggghts") if shutil.which(p)]
    heads = [f"{p} x{n}" for n in options.processes for p in programs]
    both = int(1 in options.processes and 2 in options.processes)
    print("M particle-steps per CPU second on one core, per second on two (threads or MPI ranks); "
          "in brackets: how many times as many here")
    print("| bed | " + " | ".join(heads) + " |" + " x2 over x1 |" * both)
    print("|---" * (len(heads) + 1 + both) + "|", flush=True)
    cases = [("column", e, l) for e in options.edges for l in options.laws]
    cases += [("avalanche", e, l) for e in options.avalanche for l in options.laws]
    cases += [(kind, e, "hooke") for kind in ("drum", "shell") for e in options.drum]
    cases += [("funnel", e, "hooke") for e in options.funnel]
    cases += [("drain", e, "hooke") for e in options.drain]
    cases += [("silo", e, "hooke") for e in options.silo]
    cases += [("clump", e, "hooke") for e in options.clump]
    for kind, edge, law in cases:
        case = Case(options, kind, edge, law)
        case.settle()
        may = [p for p in programs if p != "lmp" or not (case.hopper or kind == "clump")]
        report(case, measure(case, may, options), programs, options.processes)


if __name__ == "__main__":
    main()
