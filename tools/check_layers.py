#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A file of lib/<layer>/ includes only its own layer, those before it, and public headers.

libse3d-io, the programs in tools/ and the examples see public headers only. With a folder as
argument, that tree is checked instead of this one.
"""
import re
import sys
from pathlib import Path

LAYERS = ("base math expression model primitive joint force contact particles formulation assembly "
          "linsol nonlinear integrator analysis system").split()
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)


def complaint(folder, layer, quoted, name):
    """Why `name` may not be included from `folder` (of layer `layer` or None); None if it may."""
    first = name.split("/")[0] if "/" in name else ""
    if first == "se3d":
        if name == "se3d/io.h" and layer is not None:
            return "libse3d does not know libse3d-io"
        return None
    if not quoted or (not first and (folder / name).exists()):
        return None
    if ".." in name.split("/"):
        return "write paths from lib/"
    if layer is None:
        own = folder.name == first == "io"
        return None if own else "only public headers (se3d/...) may be included here"
    if first in LAYERS:
        return None if LAYERS.index(first) <= LAYERS.index(layer) else \
            f"layer `{first}` comes after `{layer}`"
    return "neither a layer nor a public header"


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    count, problems = 0, []
    folders = [p for p in sorted((root / "lib").iterdir()) if p.is_dir()]
    folders += [p for p in (root / "tools" / "se3d", root / "examples") if p.is_dir()]
    for folder in folders:
        layer = folder.name if folder.parent.name == "lib" and folder.name != "io" else None
        if layer is not None and layer not in LAYERS:
            problems.append(f"{folder.relative_to(root)}: not a layer of DESIGN's list")
            continue
        for path in sorted(folder.rglob("*.[ch]")):
            text = re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S)
            for bracket, name in INCLUDE.findall(text):
                count += 1
                why = complaint(path.parent, layer, bracket == '"', name)
                if why:
                    problems.append(f'{path.relative_to(root)}: #include "{name}": {why}')
    for path in sorted((root / "include" / "se3d").glob("*.h")):
        for bracket, name in INCLUDE.findall(path.read_text()):
            count += 1
            if bracket == '"' and not name.startswith("se3d/"):
                problems.append(f'include/se3d/{path.name}: #include "{name}": write "se3d/..."')
    print("\n".join(problems + [f"layers: {count} includes, {len(problems)} problems"]))
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
