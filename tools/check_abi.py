#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the promised binary interface; prints what is wrong and exits 1.

    check_abi.py symbols LIBRARY.so   headers, symbol map and exports agree
    check_abi.py globals ARCHIVE.a..  no writable global or thread-local data
    check_abi.py calls ARCHIVE.a..    nothing that prints, aborts, allocates past the allocator, or
                                      computes what libm rounds as it likes
    check_abi.py duplicates ARCHIVE.a..  no symbol defined twice, within or across archives
    check_abi.py padding              no padding in public structs (compiler's -Wpadded)
    check_abi.py soname LIBRARY.so..  the shared object's name has the major version only
    check_abi.py update               write the symbol maps from the headers

The compiler is $CC (cc where unset).
"""
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HEADERS = ROOT / "include" / "se3d"
# library name -> (map file, version node)
MAPS = {
    "se3d": (ROOT / "lib" / "se3d.map", "SE3D_0"),
    "se3d-io": (ROOT / "lib" / "io" / "se3d-io.map", "SE3D_IO_0"),
}
EXPORTED = '__attribute__((visibility("default")))'


def run(*command, text=None):
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return done.stdout


def compiler():
    return os.environ.get("CC") or "cc"


def preprocess(headers):
    source = "".join(f'#include "{header}"\n' for header in headers)
    return run(compiler(), "-std=c11", "-E", f"-I{ROOT / 'include'}", "-xc", "-", text=source)


def own_text(preprocessed):
    """The preprocessed lines that come from the public headers."""
    lines, own = [], False
    for line in preprocessed.splitlines():
        marker = re.match(r'# \d+ "([^"]*)"', line)
        if marker:
            own = str(HEADERS) in os.path.abspath(marker.group(1))
        elif own:
            lines.append(line)
    return "\n".join(lines)


def statements(text):
    """Top-level statements, with the text of braces left out; a function's body ends one too."""
    depth, current = 0, ""
    for char in text:
        if char == "{":
            depth += 1
        elif char == "}":
            depth -= 1
            if depth == 0 and re.search(r"\bstatic\b", current):
                current = ""
        elif depth == 0 and char == ";":
            yield " ".join(current.split())
            current = ""
        elif depth == 0:
            current += char


def declared(headers):
    """Names of the exported functions, and of those declared without SE3D_API."""
    exported, forgotten = set(), set()
    for statement in statements(own_text(preprocess(headers))):
        if statement.startswith("typedef") or "static" in statement.split():
            continue
        name = re.search(r"\b(se3d_\w+) ?\(", statement.replace(EXPORTED, ""))
        if name:
            (exported if EXPORTED in statement else forgotten).add(name.group(1))
    return exported, forgotten


IO_HEADERS = ("io.h", "import.h", "study.h")  # of libse3d-io


def public_functions():
    """Library -> its functions; and problems found on the way."""
    core_headers = sorted(h for h in HEADERS.glob("*.h") if h.name not in IO_HEADERS)
    core, forgotten = declared(core_headers)
    problems = [f"{name}: declared without SE3D_API" for name in sorted(forgotten)]
    functions = {"se3d": core}
    if (HEADERS / "io.h").exists():
        every, forgotten = declared([HEADERS / name for name in IO_HEADERS])
        functions["se3d-io"] = every - core
        problems += [f"{name}: declared without SE3D_API in {' or '.join(IO_HEADERS)}"
                     for name in sorted(forgotten) if name not in core]
    umbrella = HEADERS / "se3d.h"
    if umbrella.exists():
        text = umbrella.read_text()
        problems += [f"include/se3d/se3d.h does not include {h.name}" for h in core_headers
                     if h != umbrella and not re.search(rf'include\s+["<](se3d/)?{h.name}[">]', text)]
    return functions, problems


def map_text(node, names):
    body = "".join(f"        {name};\n" for name in sorted(names))
    head = "/* SPDX-License-Identifier: BSD-3-Clause */\n"
    globals_part = f"    global:\n{body}" if names else ""
    return f"{head}{node} {{\n{globals_part}    local:\n        *;\n}};\n"


def update():
    functions, problems = public_functions()
    for library, names in functions.items():
        path, node = MAPS[library]
        if path.parent.is_dir():
            path.write_text(map_text(node, names))
            print(f"{path.relative_to(ROOT)}: {len(names)} functions")
    return problems


def library_of(path):
    return re.match(r"lib(.+?)\.(so|a)", Path(path).name).group(1)


def symbols(path):
    functions, problems = public_functions()
    library = library_of(path)
    names = functions.get(library, set())
    map_path, node = MAPS[library]
    # A line of `nm -D`: [address] type name[@@version].
    exports, versions = set(), set()
    for line in run("nm", "-D", "--defined-only", path).splitlines():
        symbol = line.split()[-1]
        name, _, version = symbol.partition("@@")
        if line.split()[-2] == "A":
            continue  # the version node itself
        exports.add(name)
        versions.add(version)
    mapped = set(re.findall(r"^\s+(se3d_\w+);", map_path.read_text(), re.M))
    for title, left, right in (
            ("declared, but not exported", names, exports),
            ("exported, but not declared", exports, names),
            ("declared, but not in the symbol map", names, mapped),
            ("in the symbol map, but not declared", mapped, names)):
        problems += [f"{name}: {title}" for name in sorted(left - right)]
    if map_path.read_text() != map_text(node, names):
        problems.append(f"{map_path.relative_to(ROOT)} is out of date: sh tools/update_map.sh")
    if exports and versions != {node}:
        problems.append(f"symbols carry the versions {sorted(versions)}, expected {node}")
    print(f"{library}: {len(names)} functions declared, {len(exports)} exported")
    return problems


def global_data(paths):
    problems = []
    for path in paths:
        member = "?"
        for line in run("readelf", "-SW", path).splitlines():
            if line.startswith("File: "):
                member = line[6:]
            section = re.match(r"\s*\[ *\d+\]\s+(\.\S+)\s+\w+\s+\S+\s+\S+\s+([0-9a-f]+)", line)
            if not section or int(section.group(2), 16) == 0:
                continue
            name = section.group(1)
            if re.match(r"\.(data|bss|tdata|tbss)(\.|$)", name) and \
                    not name.startswith(".data.rel.ro"):
                problems.append(f"{member}: {name} has {int(section.group(2), 16)} bytes")
        for line in run("nm", "-A", "--defined-only", path).splitlines():
            if line.split()[-2] in "bBCG":  # D: .data.rel.ro holds const tables of pointers
                problems.append(f"writable: {line}")
    return problems


def duplicates(paths):
    """A program that links both archives must not depend on their order."""
    defined, problems = {}, []
    for path in paths:
        for line in run("nm", "-A", "-g", "--defined-only", path).splitlines():
            place, _, rest = line.rpartition(":")
            kind, name = rest.split()[-2:]
            member = f"{Path(path).name}({place.split(':')[-1]})"
            if name in defined:
                problems.append(f"{name} ({kind}) is defined by {defined[name]} and {member}")
            defined.setdefault(name, member)
    return problems


FORBIDDEN = ("abort exit _exit _Exit quick_exit atexit signal raise longjmp printf vprintf puts "
             "putchar putc perror stdout stderr stdin setlocale getenv setenv rand srand random time "
             "system popen").split()
# Their bits differ from one libm to the next: math/elementary.h has our own.
FORBIDDEN_LIBM = ("sin cos tan sincos asin acos atan atan2 exp exp2 exp10 expm1 log log2 log10 log1p pow sinh cosh "
                  "tanh asinh acosh atanh hypot cbrt erf erfc lgamma tgamma").split()
FORBIDDEN_CORE = ("clock fprintf vfprintf fputs fputc fwrite fopen fread open write read malloc calloc "
                  "realloc free strdup aligned_alloc posix_memalign").split()


def calls(paths):
    problems = []
    for path in paths:
        core = library_of(path) == "se3d"
        forbidden = set(FORBIDDEN + FORBIDDEN_LIBM + (FORBIDDEN_CORE if core else []))
        member = "?"
        for line in run("nm", path).splitlines():
            if line.endswith(":"):
                member = line[:-1]
            parts = line.split()
            if len(parts) == 2 and parts[0] == "U" and parts[1].split("@")[0] in forbidden:
                if member == "alloc.c.o" and parts[1] in ("malloc", "realloc", "free"):
                    continue  # the default allocator
                problems.append(f"{Path(path).name}({member}) uses {parts[1]}")
    return problems


def padding():
    source = "".join(f'#include "{header}"\n' for header in sorted(HEADERS.glob("*.h")))
    done = subprocess.run([compiler(), "-std=c11", "-Wpadded", f"-I{ROOT / 'include'}", "-c", "-xc",
                           "-", "-o", os.devnull],
                          input=uses(source), capture_output=True, text=True, check=False)
    text = done.stderr
    if done.returncode != 0:
        return [text]
    return [line for line in text.splitlines() if "-Wpadded" in line]


def uses(source):
    """clang lays out (and warns about) only structs that are used: take the size of each."""
    names = re.findall(r"typedef struct (\w+)\s*\{", own_text(preprocess(sorted(HEADERS.glob("*.h")))))
    sizes = "".join(f"+ sizeof(struct {name})" for name in names)
    return f"{source}\n#include <stddef.h>\nsize_t size_of_all(void);\n" \
           f"size_t size_of_all(void) {{ return 0 {sizes}; }}\n"


def soname(paths):
    problems = []
    version = re.search(r"SE3D_VERSION_MAJOR (\d+)", (HEADERS / "base.h").read_text()).group(1)
    for path in paths:
        name = re.search(r"\(SONAME\).*\[(.*)\]", run("readelf", "-dW", path))
        expected = f"lib{library_of(path)}.so.{version}"
        if not name or name.group(1) != expected:
            problems.append(f"{path}: SONAME {name and name.group(1)}, expected {expected}")
    return problems


def main():
    checks = {"symbols": lambda p: symbols(p[0]), "globals": global_data, "calls": calls,
              "duplicates": duplicates,
              "padding": lambda p: padding(), "soname": soname, "update": lambda p: update()}
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if len(sys.argv) < 2 or sys.argv[1] not in checks:
        sys.exit(__doc__)
    problems = checks[sys.argv[1]](sys.argv[2:])
    for problem in problems:
        print(problem)
    print(f"{sys.argv[1]}: {'ok' if not problems else f'{len(problems)} problems'}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
