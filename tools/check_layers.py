#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A file includes only its own folder, those before it, and public headers.

The folders of lib/ are layers, those of lib/io and lib/contact their rooms. LAYERS and ROOMS give
their orders, and the tables of docs/architecture.md must give the same. No headers include each
other in a circle, and no files call each other in one but those of CIRCLES, where a sentence says
why. A function is defined in the folder of the header that declares it. libse3d-io, the programs in
tools/ and the examples see public headers only. With a folder as argument, that tree is checked
instead of this one.
"""
import argparse
import re
import sys
from pathlib import Path

LAYERS = ("base math expression model primitive joint force contact particles formulation assembly "
          "linsol tree nonlinear integrator analysis system").split()
# Folders that have folders of their own, in their order.
ROOMS = {"contact": "shape narrow bodies".split(),
         "io": "base document model channel read write run study import fmi live".split()}
# What the program in tools/se3d shares with libse3d-io, to whose static library it is linked.
SHARED = ("io/base/file.h", "io/document/guess.h", "io/document/layout.h", "io/read/objects.h",
          "io/fmi/package.h", "io/live/live.h", "io/study/derive.h", "io/write/save_source.h",
          "io/write/sketch.h", "io/write/svg.h", "player.h")  # the last of record/
# Functions that are complete in a header, which libse3d-io may have too: nothing is linked.
INLINE = ("base/hash.h", "base/coder.h", "base/floats.h", "base/shortest.h", "math/over.h",
          "math/vec3.h")
# Files that call each other, and why they are not one after the other.
CIRCLES = {
    "primitive/scale primitive/turn_counter":
        "an accepted state is looked at for rows left out, whose gap is measured as every row's",
    "contact/narrow/flush contact/narrow/hollow contact/narrow/mesh contact/narrow/outlines contact/narrow/pieces contact/narrow/surfaces contact/narrow/ways":
        "a mesh is taken apart into pieces, which are meshes, and the whole judges their ways out",
    "tree/loop_points tree/loop_rows tree/loop_turns tree/loops":
        "which rows of a loop are kept, and how they are turned, is found by evaluating all of them",
    "nonlinear/equations nonlinear/friction_system nonlinear/position":
        "solving with friction, and for positions, is solving the equations several times",
    "analysis/kinematics analysis/singular":
        "a singular position is passed by the steps that could not pass it, made shorter",
    "analysis/events analysis/run analysis/run_failure analysis/run_prepare":
        "a run looks for events after each step, and a search for events makes steps",
    "io/document/reader io/document/reference io/document/value":
        "a text may hold numbers in braces, and a number may be written as a text",
    "io/fmi/exchange io/fmi/unit":
        "a unit whose caller integrates is one that lives as others do, with other steps",
    "io/import/chrono io/import/import io/import/mjcf io/import/mjcf_acts io/import/mjcf_body "
    "io/import/mjcf_geom":
        "formats include files by the function that chose them; a tree of bodies is read as it is "
        "written, body in body",
    "io/read/load io/read/mistakes":
        "the mistakes behind the first one are found by reading the model again without it",
}
HEAD = r"^(?!static\b|typedef\b)[A-Za-z][\w *]*?\b(se3di?_\w+)\([^;{}]*\)"
DEFINITION = re.compile(HEAD + r"\s*\{", re.M)
DECLARATION = re.compile(HEAD + ";", re.M)
NAME = re.compile(r"\bse3di?_\w+")
NOISE = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
TABLE_ROW = re.compile(r"^\| `([\w/]+)` \|", re.M)


def complaint(folder, place, quoted, name):
    """Why `name` may not be included from `folder`, None if it may.

    `place` is the folder below lib/ as parts, [] outside of it.
    """
    parts = name.split("/")
    if parts[0] == "se3d" and len(parts) > 1:
        if name in ("se3d/io.h", "se3d/import.h", "se3d/study.h") and place and place[0] != "io":
            return "libse3d does not know libse3d-io"
        return None
    if not quoted or (len(parts) == 1 and (folder / name).exists()):
        return None
    if ".." in parts:
        return "write paths from lib/"
    if not place and folder.name == "se3d" and name in SHARED:
        return None
    if place and place[0] == "io" and name in INLINE:
        return None
    if not place or (place[0] == "io" and parts[0] != "io"):
        return "only public headers (se3d/...) may be included here"
    if parts[0] != place[0]:
        if parts[0] not in LAYERS:
            return "neither a layer nor a public header"
        before, after, order = parts[0], place[0], LAYERS
    elif place[0] in ROOMS:
        before, after, order = parts[1], place[1], ROOMS[place[0]]
        if before not in order:
            return "in none of the folders"
    else:
        return None
    return f"`{before}` comes after `{after}`" if order.index(before) > order.index(after) else None


def find_circles(headers):
    """The circles of includes, each as the list of its files, among {name: included names}."""
    circles, state = [], {}

    def visit(name, path):
        if state.get(name) == "done":
            return
        if name in path:
            circles.append(path[path.index(name):] + [name])
            return
        for other in headers.get(name, ()):
            visit(other, path + [name])
        state[name] = "done"

    for name in sorted(headers):
        visit(name, [])
    return circles


def read_code(root):
    """{name below lib/: its text without comments and literals} of all C files and headers."""
    return {path.relative_to(root / "lib").as_posix(): NOISE.sub("", path.read_text())
            for path in sorted((root / "lib").rglob("*.[ch]"))}


def join_callers(calls):
    """Sets of files that call each other, directly or through others, among {file: files}."""
    index, low, stack, found = {}, {}, [], []

    def visit(name):
        index[name] = low[name] = len(index)
        stack.append(name)
        for other in sorted(calls.get(name, ())):
            if other not in index:
                visit(other)
                low[name] = min(low[name], low[other])
            elif other in stack:
                low[name] = min(low[name], index[other])
        if low[name] == index[name]:
            at = stack.index(name)
            found.append(sorted(stack[at:]))
            del stack[at:]

    for name in sorted(calls):
        if name not in index:
            visit(name)
    return sorted(group for group in found if len(group) > 1)


def check_calls(code):
    """Circles of calls between files, and functions that another folder declares."""
    owner, calls, problems = {}, {}, []
    for name, text in code.items():
        if name.endswith(".c"):
            owner.update({function: name for function in DEFINITION.findall(text)})
    for name, text in code.items():
        if name.endswith(".c"):
            used = {owner[word] for word in NAME.findall(text) if word in owner} - {name}
            calls[name[:-2]] = {other[:-2] for other in used}
            continue
        for function in DECLARATION.findall(text):
            place = owner.get(function, name)
            if place.rpartition("/")[0] != name.rpartition("/")[0]:
                problems.append(f"{name}: declares {function}, which {place} defines")
    circles = {" ".join(group) for group in join_callers(calls)}
    problems += [f"files call each other: {circle}" for circle in sorted(circles - set(CIRCLES))]
    problems += [f"CIRCLES lists files that do not call each other: {circle}"
                 for circle in sorted(set(CIRCLES) - circles) if circle.split()[0] in calls]
    return problems


def check_documents(root):
    """The tables of layers and rooms against the orders above."""
    path = root / "docs" / "architecture.md"
    if not path.exists():
        return []
    names = TABLE_ROW.findall(path.read_text())
    wanted = {"layers": LAYERS} | {room: [f"{room}/{name}" for name in order]
                                   for room, order in ROOMS.items()}
    listed = {"layers": [name for name in names if name in LAYERS or "/" not in name]}
    for room in ROOMS:
        listed[room] = [name for name in names if name.startswith(room + "/")]
    return [f"docs/architecture.md lists {' '.join(listed[key])}, the tree has {' '.join(order)}"
            for key, order in wanted.items() if listed[key] != order]


def list_folders(root):
    """Every folder with sources: its path and its parts below lib/, or why it may not be there."""
    for layer in sorted(p for p in (root / "lib").iterdir() if p.is_dir()):
        for folder in [layer] + sorted(p for p in layer.rglob("*") if p.is_dir()):
            place = list(folder.relative_to(root / "lib").parts)
            known = place[0] in LAYERS or place[0] in ROOMS
            if place[0] in ROOMS:
                known = len(place) == 1 or (len(place) == 2 and place[1] in ROOMS[place[0]])
            yield folder, place, known
    for folder in (root / "tools" / "se3d", root / "examples", root / "mpi" / "program"):
        if folder.is_dir():
            yield folder, [], True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    root = parser.parse_args().folder
    count, problems, headers = 0, check_documents(root), {}
    for folder, place, known in list_folders(root):
        if not known:
            problems.append(f"{folder.relative_to(root)}: in no list of tools/check_layers.py")
            continue
        for path in sorted(folder.glob("*.[ch]")):
            where = path.relative_to(root)
            if len(place) == 1 and place[0] in ROOMS:
                problems.append(f"{where}: must stand in one of the folders")
                continue
            text = re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S)
            found = INCLUDE.findall(text)
            count += len(found)
            if place and path.suffix == ".h":
                headers[path.relative_to(root / "lib").as_posix()] = [name for _, name in found]
            for bracket, name in found:
                why = complaint(folder, place, bracket == '"', name)
                if why:
                    problems.append(f'{where}: #include "{name}": {why}')
    problems += check_calls(read_code(root))
    problems += [f"includes in a circle: {' -> '.join(circle)}" for circle in find_circles(headers)]
    for path in sorted((root / "include" / "se3d").glob("*.h")):
        for bracket, name in INCLUDE.findall(path.read_text()):
            count += 1
            if bracket == '"' and not name.startswith("se3d/"):
                problems.append(f'include/se3d/{path.name}: #include "{name}": write "se3d/..."')
    print("\n".join(problems + [f"layers: {count} includes, {len(problems)} problems"]))
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
