#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Join the files of changes/ with the part "Unreleased" of CHANGELOG.md.

    python3 tools/changelog.py                    print what is not released yet
    python3 tools/changelog.py release 2026-12-01 write it as the version of base.h, remove the files

A file holds list items: lines that begin with "- ", or with two blanks where an item goes on, of at
most 120 columns.
"""
import datetime
import re
import sys
from pathlib import Path

HEAD = "## Unreleased\n"


def fragments(root):
    return sorted(p for p in (root / "changes").glob("*.md") if p.name != "README.md")


def problems(path):
    """What is wrong in a file, a line each."""
    lines = path.read_text(encoding="utf-8").split("\n")
    if lines[-1] == "":
        lines.pop()
    if not lines or not lines[0].startswith("- "):
        yield f"{path.name}:1: must begin with an item, `- `"
    for number, line in enumerate(lines, 1):
        if not re.match(r"(- |  )\S", line):
            yield f"{path.name}:{number}: must begin with `- `, or with two blanks within an item"
        if len(line) > 120:
            yield f"{path.name}:{number}: has {len(line)} columns, must be at most 120"


def version(root):
    header = (root / "include/se3d/base.h").read_text(encoding="utf-8")
    return ".".join(re.search(rf"SE3D_VERSION_{part} (\d+)", header).group(1)
                    for part in ("MAJOR", "MINOR", "PATCH"))


def unreleased(text):
    """(before, items, after) of the change log."""
    before, found, rest = text.partition(HEAD)
    if not found:
        raise ValueError("CHANGELOG.md has no part `## Unreleased`")
    end = rest.find("\n## ")
    return before, rest[:end + 1] if end >= 0 else rest, rest[end + 1:] if end >= 0 else ""


def joined(items, root):
    own = "".join(p.read_text(encoding="utf-8") for p in fragments(root))
    return items.strip("\n") + ("\n" if items.strip() else "") + own


def release(root, date):
    log = root / "CHANGELOG.md"
    before, items, after = unreleased(log.read_text(encoding="utf-8"))
    name = version(root)
    if f"\n## {name} " in after or f"## {name} " in after[:40]:
        raise ValueError(f"CHANGELOG.md has {name} already: raise the version in include/se3d/base.h")
    text = f"{before}{HEAD}\n## {name} ({date})\n\n{joined(items, root).strip()}\n"
    log.write_text(text + (f"\n{after}" if after else ""), encoding="utf-8")
    for path in fragments(root):
        path.unlink()


def main(words, root):
    if words in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0
    if words and not (len(words) == 2 and words[0] == "release"):
        print(f"changelog.py: unknown words {' '.join(words)}; see --help", file=sys.stderr)
        return 2
    wrong = [line for path in fragments(root) for line in problems(path)]
    for line in wrong:
        print(f"changes/{line}", file=sys.stderr)
    if wrong:
        return 1
    try:
        if words:
            release(root, datetime.date.fromisoformat(words[1]))
        else:
            items = unreleased((root / "CHANGELOG.md").read_text(encoding="utf-8"))[1]
            print(joined(items, root), end="")
    except ValueError as error:
        print(f"changelog.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path(__file__).resolve().parent.parent))
