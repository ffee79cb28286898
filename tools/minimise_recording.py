#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Take calls out of a recording as long as it fails in the same way.

    minimise_recording.py FROM TO [--program se3d] [--function NAME] [--seconds S]

The failure is what `se3d replay --unchecked --list` shows: the signal that it ends with and the call
that it ends in; else the last call that fails, or the last one of --function NAME, with its status. What
is left out besides: names of functions that are not called.
"""
import argparse
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

MAGIC = b"se3drec1"
CALL, RETURN, CALLBACK, ANSWER, FAIL, NOTE, HASH = range(7)


def read(data):
    """(version, names, pieces); a piece is (thread, kind, content)."""
    if data[:8] != MAGIC:
        sys.exit("minimise_recording.py: it is no recording")
    at = 8

    def text():
        nonlocal at
        length, = struct.unpack_from("<I", data, at)
        at += 4 + length
        return data[at - length:at]

    version = text()
    count, = struct.unpack_from("<I", data, at)
    at += 4
    names = [text() for _ in range(count)]
    pieces = []
    while at + 9 <= len(data):
        size, thread, kind = struct.unpack_from("<IIB", data, at)
        if at + 9 + size > len(data):
            break
        pieces.append((thread, kind, data[at + 9:at + 9 + size]))
        at += 9 + size
    return version, names, pieces


def write(version, names, groups):
    """The bytes of a recording, with the names of what it calls only."""
    pieces = [piece for group in groups for piece in group]
    used = sorted({struct.unpack_from("<I", content)[0] for _, kind, content in pieces if kind == CALL})
    new = {old: k for k, old in enumerate(used)}

    def text(value):
        return struct.pack("<I", len(value)) + value

    out = [MAGIC, text(version), struct.pack("<I", len(used))] + [text(names[old]) for old in used]
    for thread, kind, content in pieces:
        if kind == CALL:
            content = struct.pack("<I", new[struct.unpack_from("<I", content)[0]]) + content[4:]
        out += [struct.pack("<IIB", len(content), thread, kind), content]
    return b"".join(out)


def group_calls(pieces):
    """Each outermost call of a thread with all that stands in it; what stands alone is one, too."""
    groups, open_groups, depth = [], {}, {}
    for piece in pieces:
        thread, kind, _ = piece
        if depth.get(thread, 0) == 0:
            open_groups[thread] = []
            groups.append(open_groups[thread])
        open_groups[thread].append(piece)
        depth[thread] = depth.get(thread, 0) + {CALL: 1, RETURN: -1}.get(kind, 0)
    return [group for group in groups if group[0][1] not in (NOTE, HASH)]


class Player:
    """Says how a recording fails."""

    def __init__(self, o):
        self.program, self.function, self.seconds, self.runs = o.program, o.function, o.seconds, 0
        self.file = Path(tempfile.mkdtemp()) / "try.se3drec"

    def failure(self, data):
        self.runs += 1
        self.file.write_bytes(data)
        try:
            done = subprocess.run([self.program, "replay", "--unchecked", "--list", str(self.file)],
                                  capture_output=True, text=True, timeout=self.seconds, check=False)
            code, lines = done.returncode, done.stdout.splitlines()
        except subprocess.TimeoutExpired as late:
            code, lines = "timeout", (late.stdout or b"").decode().splitlines()
        calls = [line.split(" ", 1)[1] for line in lines if re.match(r"\d+ se3d_", line)]
        if code == "timeout" or code < 0 or code > 2:
            return code, calls[-1] if calls else ""
        failed = [call for call in calls if ": " in call]
        if self.function:
            failed = [call for call in failed if call.startswith(self.function + ":")]
        return (code, failed[-1]) if failed else None


def minimise(version, names, groups, player):
    """Delta debugging: try without each part, of half of all down to single calls."""
    wanted = player.failure(write(version, names, groups))
    if not wanted:
        sys.exit("minimise_recording.py: no call of it fails")
    size = max(1, len(groups) // 2)
    while True:
        at, before = 0, len(groups)
        while at < len(groups):
            fewer = groups[:at] + groups[at + size:]
            if player.failure(write(version, names, fewer)) == wanted:
                groups = fewer
            else:
                at += size
        if size == 1 and len(groups) == before:
            return wanted, groups
        size = max(1, size // 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("source")
    parser.add_argument("to")
    parser.add_argument("--program", default="se3d")
    parser.add_argument("--function", default="")
    parser.add_argument("--seconds", type=float, default=20.0)
    o = parser.parse_args()
    version, names, pieces = read(Path(o.source).read_bytes())
    groups, player = group_calls(pieces), Player(o)
    count = len(groups)
    wanted, groups = minimise(version, names, groups, player)
    Path(o.to).write_bytes(write(version, names, groups))
    print(f"{wanted[1]} (exit {wanted[0]}): {len(groups)} of {count} calls, {player.runs} runs")


if __name__ == "__main__":
    main()
