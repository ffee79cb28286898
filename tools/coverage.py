#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Branch coverage by folder of lib/, of what the programs of build/coverage have run so far.

    cmake --preset coverage && cmake --build --preset coverage -j && ctest --preset coverage -j
    python3 tools/coverage.py [--missing] [FOLDER...]    folders of lib/, default all

A line with `unreached: <reason>` in a comment on it, or on the line before it, counts as reached:
what guards against damage that cannot be made in a test. --missing prints the branches that are
left. Branches of `assert` count as reached, and those that ask for the processor; kernels at their
instruction levels do not count. The preset takes force from `always_inline`: a kernel that is made
once for each size or kind counts once, not once a copy. Files must be as they were compiled."""
import argparse
import gzip
import json
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEVELS = re.compile(r"_(avx2|avx512|fma|portable)\.c$")


def read_counts(build):
    """{file: {line: [taken, ...]}} and {file: {line: count}} of all that stands in the libraries."""
    branches, lines = defaultdict(dict), defaultdict(dict)
    notes = list(build.glob("**/*.gcda"))  # tests too: they have inline functions of the library
    if not notes:
        sys.exit(f"coverage.py: nothing in {build} has run")
    with tempfile.TemporaryDirectory() as folder:
        for note in notes:
            subprocess.run(["gcov", "-b", "-c", "-j", str(note)], cwd=folder, capture_output=True, check=False)
            for path in Path(folder).glob("*.gz"):
                add_file(json.loads(gzip.decompress(path.read_bytes())), branches, lines)
                path.unlink()
    return branches, lines


def add_file(data, branches, lines):
    for source in data["files"]:
        path = Path(data["current_working_directory"], source["file"]).resolve()
        if ROOT / "lib" not in path.parents or LEVELS.search(path.name):
            continue
        for line in source["lines"]:
            number = line["line_number"]
            lines[path][number] = lines[path].get(number, 0) + line["count"]
            counts = [b["count"] for b in line["branches"] if not b.get("throw")]
            before = branches[path].get(number, [])
            if len(before) == len(counts):
                counts = [a + b for a, b in zip(before, counts)]
            elif before:  # an inline function of which copies have other branches
                counts = max(before, counts, key=sum)
            if counts:
                branches[path][number] = counts


def explained(text, number):
    return any("unreached: " in text[k] for k in (number - 1, number - 2) if 0 <= k < len(text)) or \
        re.search(r"^\s*(static_)?assert\(|__builtin_cpu_supports", text[number - 1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--build", default="build/coverage")
    parser.add_argument("--missing", action="store_true")
    parser.add_argument("folders", nargs="*")
    o = parser.parse_args()
    branches, _ = read_counts(Path(o.build).resolve())
    total = defaultdict(lambda: [0, 0])
    for path in sorted(branches):
        folder = path.relative_to(ROOT / "lib").parts[0]
        if o.folders and folder not in o.folders:
            continue
        text = path.read_text().split("\n")
        for number, counts in sorted(branches[path].items()):
            fine = explained(text, number)
            for key in (folder, "all"):
                total[key][0] += len(counts) if fine else sum(c > 0 for c in counts)
                total[key][1] += len(counts)
            if o.missing and not fine and min(counts) == 0:
                missed = sum(c == 0 for c in counts)
                print(f"{path.relative_to(ROOT)}:{number}: {missed} of {len(counts)}: {text[number - 1].strip()}")
    for folder, (reached, count) in total.items():
        if folder != "all":
            print(f"{folder:12} {100 * reached / count:6.2f} % of {count} branches")
    reached, count = total["all"]
    print(f"coverage: {100 * reached / count:.2f} % of {count} branches")


if __name__ == "__main__":
    main()
