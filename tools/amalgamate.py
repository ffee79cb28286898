#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Write the library as one source and one header: se3d.c, se3d.h, and se3d-io.c, se3d-io.h.

    python3 tools/amalgamate.py FOLDER

    cc -O2 -std=c11 -ffp-contract=off -c se3d.c         link with -lamd -lm; -fopenmp for threads

All headers stand before all sources. What a source defines for itself (static functions, types,
macros) gets the source's number behind its name, as another source may have the same name. What
libse3d-io shares with libse3d in internal headers that are complete in themselves stands in both.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIB, PUBLIC = ROOT / "lib", ROOT / "include"
IO_HEADERS = ("se3d/io.h", "se3d/import.h", "se3d/study.h")
TOKEN = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|\\\n|\w+|\.\.\.|->|.|\n', re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"[^\n]*\n', re.M)
GUARD = re.compile(r"^#ifndef (\w+_H)\n#define \1\n", re.M)
FEATURE = re.compile(r"^[ \t]*#[ \t]*define[ \t]+_\w+_SOURCE[^\n]*\n", re.M)
WORD = re.compile(r"[A-Za-z_]\w*$")
OURS = ("_", "se3d", "SE3D")
NO_NAMES = {"__attribute__", "_Alignas", "_Static_assert", "struct", "union", "enum"}


def path_of(name, folder):
    """The file that #include "name" means, None for one that is not ours."""
    for place in (LIB / name, PUBLIC / name, folder / name):
        if place.is_file():
            return place.resolve()
    return None


def visit(header, order, seen):
    """Append `header` after what it includes."""
    if header in seen:
        return
    seen.add(header)
    for name in INCLUDE.findall(header.read_text()):
        found = path_of(name, header.parent)
        if found and found.suffix == ".h":
            visit(found, order, seen)
    order.append(header)


def body_of(path, order, seen):
    """The text of a source with its .inc files in place and without its own headers."""
    def replace(match):
        found = path_of(match.group(1), path.parent)
        if found is None:
            return match.group(0)
        if found.suffix == ".h":
            visit(found, order, seen)
            return "\n"
        return body_of(found, order, seen)
    return INCLUDE.sub(replace, FEATURE.sub("", path.read_text()))


def solid(tokens):
    """The tokens that are neither space nor comment, with their places."""
    return [(k, t) for k, t in enumerate(tokens) if not t.isspace() and not t.startswith("/*") and t != "\\\n"]


def own_names(text):
    """What a source defines for itself at file scope: tags, types, constants, functions, macros."""
    names = set(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", text, re.M))
    statics = {"static"} | set(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)[ \t]+static\b", text, re.M))
    plain = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    plain = re.sub(r"__attribute__\s*\(\(.*?\)\)", " ", plain)
    plain = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", " ", plain, flags=re.M)
    names |= set(re.findall(r"\b(?:struct|union|enum)\s+(\w+)\s*\{", plain))
    for inside in re.findall(r"\benum\b[^{};]*\{([^}]*)\}", plain):
        names |= {part.split("=")[0].strip() for part in inside.split(",")}
    depth, statement, is_body = 0, [], False
    for _, token in solid(TOKEN.findall(plain)):
        if depth == 0:
            statement.append(token)
        if token == "{":
            is_body = statement[-2:-1] == [")"] if depth == 0 else is_body
            depth += 1
        elif token == "}":
            depth -= 1
            if depth == 0 and is_body:
                names |= declared(statement, statics)
                statement = []
        elif token == ";" and depth == 0:
            names |= declared(statement, statics)
            statement = []
    return {n for n in names if WORD.match(n) and not n.startswith(OURS)}


def declared(statement, statics):
    """The names that a statement at file scope declares, if they are the source's own."""
    words = statement
    if "typedef" in words:
        pointer = [words[k + 2] for k in range(len(words) - 2) if words[k:k + 2] == ["(", "*"]]
        last = [w for w in words if WORD.match(w)][-1:]
        return set(pointer[:1] or last)
    if not statics & set(words):
        return set()
    words = [w for w in words if not w.startswith("SE3DI_")]
    for k, word in enumerate(words):
        after = words[k + 1] if k + 1 < len(words) else ""
        if WORD.match(word) and after in ("(", "[", "=", ";", "{", ",") and word not in NO_NAMES:
            return {word} if after in ("(", "{") else {word} | further(words[k + 1:])
    return set()


def further(words):
    """The other names of a declaration of several: those behind a comma outside parentheses."""
    names, depth = set(), 0
    for before, word in zip(words, words[1:]):
        depth += (before == "(") - (before == ")")
        if before == "," and depth == 0 and WORD.match(word):
            names.add(word)
    return names


def rename(text, number):
    """Give the names of a source's own its number; members of structs keep theirs."""
    names = own_names(text)
    tokens = TOKEN.findall(text)
    places = solid(tokens)
    scopes = []
    for k, (at, token) in enumerate(places):
        before = places[k - 1][1] if k else ""
        after = places[k + 1][1] if k + 1 < len(places) else ""
        if token == "{":
            heads = [t for _, t in places[max(0, k - 3):k]]
            scopes.append(any(h in ("struct", "union") for h in heads) and before not in (")", "="))
        elif token == "}" and scopes:
            scopes.pop()
        elif token in names and before not in (".", "->"):
            is_member = scopes and scopes[-1] and after in (";", ",", "[", ":") or (
                scopes and scopes[-1] and before == "*" and after == ")")
            if not is_member:
                tokens[at] = "%s_%d" % (token, number)
    return "".join(tokens)


def plain_header(path):
    """A header without the headers of ours, its .inc files in place."""
    def replace(match):
        found = path_of(match.group(1), path.parent)
        if found is None:
            return match.group(0)
        return found.read_text() if found.suffix == ".inc" else ""
    return INCLUDE.sub(replace, path.read_text())


def write(folder, name, sources, title):
    """Write `name`.c and `name`.h out of `sources`."""
    public, order, seen, bodies = [], [], set(), []
    for header in sorted((PUBLIC / "se3d").glob("*.h")):
        is_io = "se3d/" + header.name in IO_HEADERS
        if is_io == (name != "se3d"):
            visit(header, public, seen)
    if name != "se3d":
        public = [h for h in public if "se3d/" + h.name in IO_HEADERS]
    features = set()
    for number, source in enumerate(sources):
        features |= {line.strip() for line in FEATURE.findall(source.read_text())}
        bodies.append((source, rename(body_of(source, order, seen), number)))
    head = "/* SPDX-License-Identifier: BSD-3-Clause */\n/* %s\n * Written by tools/amalgamate.py. */\n" % title
    header = head + ('#include "se3d.h"\n' if name != "se3d" else "")
    (folder / (name + ".h")).write_text(header + "".join(map(plain_header, public)))
    text = [head, "#ifndef SE3D_BUILD\n#define SE3D_BUILD\n#endif\n"]
    for line in sorted(features):
        text.append("#ifndef %s\n%s\n#endif\n" % (line.split()[1], line))
    text.append('#include "%s.h"\n' % name)
    text += [plain_header(h) for h in order if PUBLIC not in h.parents]
    for source, body in bodies:
        text.append("\n/* ---- %s ---- */\n%s" % (source.relative_to(ROOT), body))
    (folder / (name + ".c")).write_text("".join(text))


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    layers = re.search(r"set\(se3d_layers ([^)]*)\)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    core = [p for layer in layers.split() for p in sorted((LIB / layer).rglob("*.c"))]
    write(folder, "se3d", core, "libse3d: constrained rigid multibody dynamics.")
    write(folder, "se3d-io", sorted((LIB / "io").rglob("*.c")), "libse3d-io: model files and results.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
