#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Count what a reader of one call passes: files, functions, and calls upward in the layers.

    valgrind --tool=callgrind --dump-line=no --compress-strings=no --compress-pos=no \\
        --callgrind-out-file=walk build/dev/bin/se3d run model.yaml
    python3 tools/count_walk.py walk [FUNCTION]

With FUNCTION only what is called below it counts. A call is upward if the folder of the function that
is called comes after that of its caller in the layers and rooms of tools/check_layers.py, of which
the program's come last; each pair of functions counts once, and what the compiler has put into its
caller does not. Both builds that are compared must have the same options.
"""
import collections
import re
import sys

from check_layers import LAYERS, ROOMS

ORDER = [f"{layer}/{room}" if layer in ROOMS else layer
         for layer in LAYERS + ["io"] for room in ROOMS.get(layer, [""])] + ["program"]


def place_of(path):
    """(the number of its folder in ORDER, its name), None for a file that is not ours."""
    found = re.search(r"/(lib|tools/se3d)/((?:\w+/)*)(\w+\.\w+)$", path)
    if not found:
        return None
    folder = "program" if found.group(1) != "lib" else found.group(2).rstrip("/")
    return (ORDER.index(folder), f"{folder}/{found.group(3)}") if folder in ORDER else None


def read(path):
    """{(caller, callee): calls} of functions, each (file, name)."""
    calls = collections.Counter()
    caller_file = callee_file = callee = caller = None
    with open(path, errors="replace") as lines:
        for line in lines:
            key, _, value = line.strip().partition("=")
            if key == "fl":
                caller_file = value
            elif key == "fn":
                caller, callee_file = (caller_file, value), None
            elif key in ("cfi", "cfl"):
                callee_file = value
            elif key == "cfn":
                callee = (callee_file or caller_file, value)
            elif key == "calls":
                calls[caller, callee] += int(value.split()[0])
                callee_file = None
    return calls


def below(calls, name):
    """The calls that `name` leads to."""
    following = collections.defaultdict(set)
    for caller, callee in calls:
        following[caller].add(callee)
    waiting = [f for f in following if f[1] == name]
    seen = set(waiting)
    while waiting:
        for f in following[waiting.pop()] - seen:
            seen.add(f)
            waiting.append(f)
    return {pair: n for pair, n in calls.items() if pair[0] in seen}


def main():
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        return
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    calls = read(sys.argv[1])
    if len(sys.argv) == 3:
        calls = below(calls, sys.argv[2])
    ours = {(a, b) for a, b in calls if place_of(a[0]) and place_of(b[0])}
    functions = {f for pair in ours for f in pair}
    upward = sorted((place_of(a[0])[1], a[1], place_of(b[0])[1], b[1]) for a, b in ours
                    if place_of(b[0])[0] > place_of(a[0])[0])
    for where, caller, there, callee in upward:
        print(f"{where}: {caller} -> {there}: {callee}")
    print(f"{len({f[0] for f in functions})} files, {len(functions)} functions, {len(ours)} pairs, "
          f"{len(upward)} upward")


main()
