#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Granular beds here, in LAMMPS and in LIGGGHTS, in turn, from the same settled states.

    compare.py BENCH [--edges 20 32 50] [--laws hooke hertz] [--repeats 3] [--processes 1 2]
               [--keep FOLDER]

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


def run(command, **more):
    """Output and CPU seconds of a command and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env=dict(os.environ, OMP_NUM_THREADS="1"), check=False, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\n{done.stdout[-2000:]}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Case:
    """A bed: edge^3 spheres, law, tilt of gravity in degrees."""

    def __init__(self, options, edge, law, tilt):
        self.edge, self.law, self.tilt = edge, law, tilt
        self.count = edge ** 3
        self.lead = 10000 if tilt else 300 if edge < 30 else 50
        self.steps = max(100, round(options.work / self.count))
        self.state = os.path.join(options.keep, f"column_{edge}_{law}.data")
        self.bench = options.bench

    def settle(self):
        if not os.path.exists(self.state):
            run([self.bench, f"edge={self.edge}", f"law={self.law}", "steps=1", "threads=2",
                 f"state={self.state}"])
        with open(self.state, encoding="ascii") as source, \
                open(self.state + ".plain", "w", encoding="ascii") as target:
            target.write(source.read().replace("Atoms # sphere", "Atoms"))

    def ours(self, threads):
        """(M particle-steps per CPU second, per second, the program's words)"""
        text, _ = run([self.bench, f"edge={self.edge}", f"law={self.law}", f"state={self.state}",
                       f"threads={threads}", f"tilt={self.tilt}", f"lead={self.lead}",
                       f"steps={3 * self.steps}"])
        rates = re.search(r"([\d.]+) M particle-steps per CPU second, ([\d.]+) per second", text)
        return float(rates[1]), float(rates[2]), text

    def peer(self, program, ranks):
        angle = math.radians(self.tilt)
        name = "liggghts" if program == "liggghts" else "lammps"
        state = self.state + (".plain" if program == "liggghts" else "")
        command = [program, "-in", f"{HERE}/{name}_{self.law}.in", "-log", "none",
                   "-var", "data", state, "-var", "w", repr(self.edge * PITCH),
                   "-var", "gx", repr(math.sin(angle)), "-var", "gz", repr(-math.cos(angle)),
                   "-var", "lead", str(self.lead), "-var", "steps"]
        if ranks > 1:
            command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(ranks)] + command
        with tempfile.TemporaryDirectory() as work:
            _, lead = run(command + ["0"], cwd=work) if ranks == 1 else ("", 0.0)
            text, total = run(command + [str(self.steps)], cwd=work)
        wall = float(re.findall(r"Loop time of ([\d.e+-]+)", text)[-1])
        done = 1e-6 * self.count * self.steps
        lost = self.count - int(re.findall(r"steps with (\d+) atoms", text)[-1])
        return done / max(total - lead, 1e-9), done / wall, f"{lost} lost"


def measure(case, programs, options):
    """Best rates by (program, processes); column 0: per CPU second, 1: per second."""
    best = {}
    for _ in range(options.repeats):
        for processes in options.processes:
            for program in programs:
                result = (case.ours(processes) if program == "se3d"
                          else case.peer(program, processes))
                key = (program, processes)
                old = best.get(key, (0.0, 0.0, ""))
                best[key] = (max(old[0], result[0]), max(old[1], result[1]), result[2])
    return best


def report(case, best, programs, processes):
    name = "avalanche" if case.tilt else "column"
    print(f"| {name} {case.count} {case.law} |", end="")
    for number in processes:
        column = 0 if number == 1 else 1
        for program in programs:
            rate = best[program, number][column]
            ratio = best["se3d", number][column] / rate
            print(f" {rate:.1f}" + (f" ({ratio:.1f}) |" if program != "se3d" else " |"), end="")
    if 1 in processes and 2 in processes:
        print(f" {best['se3d', 2][1] / best['se3d', 1][1]:.2f} |", end="")
    print()
    words = best["se3d", processes[0]][2].splitlines()
    for program in programs:
        if program != "se3d" and best[program, processes[0]][2] != "0 lost":
            words.append(f"{program}: {best[program, processes[0]][2]}")
    print("\n".join("    " + line.strip() for line in words[1:]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("--edges", type=int, nargs="*", default=[20, 32, 50])
    parser.add_argument("--laws", nargs="*", default=["hooke", "hertz"])
    parser.add_argument("--avalanche", type=int, nargs="*", default=[20], help="edges")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--work", type=float, default=24e6, help="particle-steps of a peer")
    parser.add_argument("--processes", type=int, nargs="*", default=[1, 2],
                        help="1 and 2: two are threads here, ranks there")
    parser.add_argument("--keep", help="folder of the settled states")
    options = parser.parse_args()
    options.bench = os.path.abspath(options.bench)
    options.keep = os.path.abspath(options.keep or tempfile.mkdtemp())
    programs = ["se3d"] + [p for p in ("lmp", "liggghts") if shutil.which(p)]
    heads = [f"{p} x{n}" for n in options.processes for p in programs]
    both = int(1 in options.processes and 2 in options.processes)
    print("M particle-steps per CPU second on one core, per second on two (threads or MPI ranks); "
          "in brackets: how many times as many here")
    print("| bed | " + " | ".join(heads) + " |" + " x2 over x1 |" * both)
    print("|---" * (len(heads) + 1 + both) + "|", flush=True)
    cases = [(e, l, 0.0) for e in options.edges for l in options.laws]
    cases += [(e, l, 45.0) for e in options.avalanche for l in options.laws]
    for edge, law, tilt in cases:
        case = Case(options, edge, law, tilt)
        case.settle()
        report(case, measure(case, programs, options), programs, options.processes)


if __name__ == "__main__":
    main()
