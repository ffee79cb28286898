#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mutants: change one sign, factor, operand or call of a source file and see that a test fails.

    tools/mutate.py [--build build/dev] [--count 100] [--seed 1] [--seconds S] --tests TEST[,TEST...] FILE...

TEST is a program of the tests (test_finite-difference_primitives). Only the changed file is compiled,
and linked in place of its object; nothing of the build folder is changed. Prints the mutants that
all tests let pass, with what was changed; those that the compiler refuses are left out. With
--seconds no mutant is begun after that time. A test that takes far longer than without a change has
failed."""
import argparse
import json
import os
import random
import re
import shlex
import subprocess
import sys
import tempfile
import time

RULES = [  # what is searched in code, what takes its place, what it is called
    (re.compile(r" \+ (?!1\b|2\b|3\b)"), " - ", "sign"),
    (re.compile(r" - (?!1\b|2\b|3\b)"), " + ", "sign"),
    (re.compile(r" \+= "), " -= ", "sign"),
    (re.compile(r" -= "), " += ", "sign"),
    (re.compile(r"(?<=[(,=] )-(?=[a-z0-9(])|(?<=\()-(?=[a-z0-9(])|(?<=return )-(?=[a-z0-9(])"), "", "sign"),
    (re.compile(r"\b2\.0 \* "), "", "factor"),
    (re.compile(r"\b0\.5 \* "), "", "factor"),
    (re.compile(r"\bse3di_add\("), "se3di_sub(", "call"),
    (re.compile(r"\bse3di_sub\("), "se3di_add(", "call"),
    (re.compile(r"\bse3di_mul\("), "se3di_mul_transposed(", "call"),
    (re.compile(r"\bse3di_mul_transposed\("), "se3di_mul(", "call"),
    (re.compile(r"\bs_i\b"), "s_j", "operand"),
    (re.compile(r"\bs_j\b"), "s_i", "operand"),
    (re.compile(r"\ba_i\b"), "a_j", "operand"),
    (re.compile(r"\bphi_i\b"), "phi_j", "operand"),
    (re.compile(r"^\s+(se3di_\w+_add_\w+|add_\w+)\(.*\);$"), "", "term left out"),
]
PASSED_OVER = re.compile(r"^\s*(/?\*|#|for \(|static_assert|assert\()|//")


def code_of(line):
    """The line without its comment, texts and indices, with blanks in their place."""
    line = re.sub(r"/\*.*?(\*/|$)", lambda m: " " * len(m.group()), line)
    line = re.sub(r'"[^"]*"', lambda m: "\0" * len(m.group()), line)
    return re.sub(r"\[[^\]]*\]", lambda m: "[" + "\0" * (len(m.group()) - 2) + "]", line)


def mutants_of(path):
    """All of a file: (line number, the changed line, what)."""
    found, comment = [], False
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    for number, line in enumerate(lines):
        begins = line.lstrip().startswith("/*")
        comment = comment or begins
        if not comment and line.startswith("    ") and not PASSED_OVER.search(line):
            for pattern, text, what in RULES:
                for match in pattern.finditer(code_of(line)):
                    changed = line[: match.start()] + text + line[match.end():]
                    found.append((number, changed, what))
        if comment and "*/" in line:
            comment = False
    return lines, found


class Bench:
    def __init__(self, build, tests, folder):
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            self.commands = {entry["file"]: entry for entry in json.load(file)}
        self.build, self.folder, self.checked = build, folder, set()
        self.environment = {**os.environ, "SE3D_SOURCE_DIR": os.getcwd(), "SE3D_BUILD_DIR": build,
                            "SE3D_SCRATCH_DIR": folder}
        times = {test: self.time(test) for test in tests}
        self.tests = sorted(tests, key=times.get)  # quick ones kill most
        self.longest = {test: max(60.0, 10.0 * times[test]) for test in tests}

    def time(self, test):
        """For how long a test runs; without a change it must pass."""
        begun = time.monotonic()
        if subprocess.run([os.path.join(self.build, "tests", test)], capture_output=True, check=False,
                          env=self.environment).returncode:
            sys.exit(f"{test} fails without any change")
        return time.monotonic() - begun

    def compile(self, path, text):
        entry = self.commands[os.path.abspath(path)]
        source = os.path.join(self.folder, "mutant.c")
        self.object = os.path.join(self.folder, "mutant.o")
        with open(source, "w", encoding="utf-8") as file:
            file.write(text)
        words = shlex.split(entry["command"])
        words = [w for w in words if not w.endswith("ccache")]
        words[words.index("-o") + 1] = self.object
        words[words.index("-c") + 1] = source
        words += ["-w", "-iquote", os.path.dirname(os.path.abspath(path))]
        return subprocess.run(words, cwd=entry["directory"], capture_output=True, check=False).returncode == 0

    def check(self, path, text, test=None):
        """Once a file and test. Objects of tests may be older than the library: what is not changed must pass."""
        if (path, test) in self.checked:
            return
        self.checked.add((path, test))
        if not self.compile(path, text):
            sys.exit(f"{path} is not compiled without any change")
        if test and self.dies(test):
            sys.exit(f"{test} fails without any change: build it again")

    def link_command(self, test):
        """By which make or ninja links a test, and where."""
        place = os.path.join(self.build, "tests")
        try:
            with open(os.path.join(place, "CMakeFiles", test + ".dir", "link.txt"), encoding="utf-8") as file:
                return shlex.split(file.read()), place
        except FileNotFoundError:
            said = subprocess.run(["ninja", "-t", "commands", "tests/" + test], cwd=self.build, check=True,
                                  capture_output=True, text=True).stdout.splitlines()[-1]
            return shlex.split(said.removeprefix(": && ").removesuffix(" && :")), self.build

    def dies(self, test):
        words, place = self.link_command(test)
        words = [w for w in words if not w.endswith("ccache")]
        program = os.path.join(self.folder, test)
        words[words.index("-o") + 1] = program
        words[1:1] = [self.object, "-Wl,--strip-debug"]
        linked = subprocess.run(words, cwd=place, capture_output=True, text=True, check=False)
        if linked.returncode:
            sys.exit(f"{test} was not linked:\n{linked.stderr}")
        try:
            return subprocess.run([program], capture_output=True, check=False, timeout=self.longest[test],
                                  env=self.environment).returncode != 0
        except subprocess.TimeoutExpired:
            return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--build", default="build/dev")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--tests", required=True)
    parser.add_argument("files", nargs="+")
    options = parser.parse_args()
    every = []
    for path in options.files:
        lines, found = mutants_of(path)
        every += [(path, lines, mutant) for mutant in found]
    random.Random(options.seed).shuffle(every)
    killed, passed, begun = 0, 0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(os.path.abspath(options.build), options.tests.split(","), folder)
        for path, lines, (number, changed, what) in every:
            if killed + passed == options.count or time.monotonic() - begun > options.seconds:
                break
            if not bench.compile(path, "\n".join(lines[:number] + [changed] + lines[number + 1:])):
                bench.check(path, "\n".join(lines))
                continue
            killer = next((test for test in bench.tests if bench.dies(test)), None)
            if killer:
                bench.check(path, "\n".join(lines), killer)
                killed += 1
                continue
            passed += 1
            print(f"{path}:{number + 1}: {what}\n  - {lines[number].strip()}\n  + {changed.strip()}", flush=True)
    print(f"{killed + passed} mutants of {len(every)}: {killed} killed, {passed} not")
    return passed > 0


if __name__ == "__main__":
    sys.exit(main())
