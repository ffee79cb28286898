#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The binary interface against that of the last release, by libabigail (Debian: abigail-tools).

    check_baseline.py compare LIBRARY.so..  nothing is gone, nothing has another type or layout
    check_baseline.py write LIBRARY.so..    take the libraries as the release: tests/abi/NAME.abi.xz

Functions may come, definition structs may grow at their end, enumerations by new values: that is
how the interface grows (tests/abi/growth.suppr). The libraries need their debug information.
"""
import lzma
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "tests" / "abi"


def baseline_of(library):
    return FOLDER / (re.sub(r"\.so.*", "", Path(library).name) + ".abi.xz")


def describe(library, path):
    subprocess.run(["abidw", "--headers-dir", str(ROOT / "include"), "--drop-private-types",
                    "--no-comp-dir-path", "--no-corpus-path", "--no-show-locs", "--type-id-style",
                    "hash", library, "--out-file", path], check=True)


def write(library):
    """One that was taken of the same library is the same file."""
    with tempfile.NamedTemporaryFile(suffix=".abi") as out:
        describe(library, out.name)
        baseline_of(library).write_bytes(lzma.compress(Path(out.name).read_bytes(), preset=9))
    return []


def compare(library):
    """Both as descriptions: of a library itself abidiff takes what is in headers for private."""
    baseline = baseline_of(library)
    if not baseline.exists():
        return [f"{library}: there is no {baseline.name}"]
    with tempfile.NamedTemporaryFile(suffix=".abi") as old, \
            tempfile.NamedTemporaryFile(suffix=".abi") as new:
        old.write(lzma.decompress(baseline.read_bytes()))
        old.flush()
        describe(library, new.name)
        done = subprocess.run(["abidiff", "--no-added-syms", "--suppressions",
                               str(FOLDER / "growth.suppr"), old.name, new.name],
                              capture_output=True, text=True, check=False)
    return [f"{library}:\n{done.stdout}{done.stderr}"] if done.returncode else []


def has_debug_information(library):
    found = subprocess.run(["readelf", "-S", "-W", library], capture_output=True, text=True,
                           check=False)
    return ".debug_info" in found.stdout


def main(words):
    checks = {"compare": compare, "write": write}
    if words[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if len(words) < 3 or words[1] not in checks:
        sys.exit(__doc__)
    if shutil.which("abidiff") is None:
        print("left out: abidiff is missing (Debian: abigail-tools)")
        return 1 if words[1] == "write" else 0
    problems = []
    for library in words[2:]:
        if has_debug_information(library):
            problems += checks[words[1]](library)
        elif words[1] == "write":
            problems.append(f"{library}: has no debug information")
        else:
            print(f"left out: {library} has no debug information")
    for problem in problems:
        print(problem)
    print(f"{words[1]}: {'ok' if not problems else f'{len(problems)} problems'}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
