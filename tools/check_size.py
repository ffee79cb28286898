#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Limits of size and complexity of every C file; prints the largest and fails beyond the limits.

    function      100 lines (160 after the comment `/* kernel: why */` on the line before it)
    complexity    20 decisions + 1 (if for while case && || ?)
    parameters    8; functions of the FMI standard have its own
    file          1000 lines; an example 120
    line          100 columns
Every C file also begins with its SPDX line.
"""
import argparse
import re
import sys
from pathlib import Path

LINES, KERNEL_LINES, COMPLEXITY, PARAMETERS, FILE_LINES, EXAMPLE_LINES = 100, 160, 20, 8, 1000, 120
COLUMNS = 100
STANDARD = ("fmi2", "fmi3") # functions whose parameters a standard has chosen
FOLDERS = ("include", "lib", "tools", "examples", "tests", "fuzz", "bench", "fmi", "record", "mpi")
TOKEN = re.compile(r"[A-Za-z_]\w*|\n|&&|\|\||\.?\d(?:[eEpP][+-]|[\w.])*|\S")
NOISE = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.S)
DECISIONS = {"if", "for", "while", "case", "&&", "||", "?"}
NOT_FUNCTIONS = {"if", "for", "while", "switch", "return", "sizeof", "do", "else", "__attribute__",
                 "_Alignas", "_Static_assert"}


def without_noise(text):
    """Comments, literals and preprocessor lines blanked (only the first branch of an #if stays);
    the number of lines is kept."""
    def blank(match):
        kept = "\n" * match.group().count("\n")
        return kept if match.group()[0] == "/" else '""' + kept
    lines, skipping, continued, depth = [], [], False, 0
    for line in NOISE.sub(blank, text).split("\n"):
        directive = re.match(r"\s*#\s*(\w*)", line)
        if continued or directive:
            if directive and not continued:
                word = directive.group(1)
                if word in ("if", "ifdef", "ifndef"):
                    skipping.append("__cplusplus" in line)
                elif word in ("else", "elif") and skipping:
                    skipping[-1] = True
                elif word == "endif" and skipping:
                    skipping.pop()
            continued = line.endswith("\\")
            lines.append("")
        else:
            lines.append("" if any(skipping) else line)
    return "\n".join(lines)


def tokens(text):
    line = 1
    for match in TOKEN.finditer(text):
        if match.group() == "\n":
            line += 1
        else:
            yield match.group(), line


def parameter_count(inside):
    depth, count = 0, 1
    for token in inside:
        depth += (token in "([{") - (token in ")]}")
        count += token == "," and depth == 0
    return 0 if inside in ([], ["void"]) else count


def head_of(statement):
    """(name, parameter tokens) if the tokens before a `{` are a function's head."""
    words = [token for token, _ in statement]
    for at in range(len(words) - 1):
        if words[at + 1] == "(" and re.match(r"[A-Za-z_]", words[at]) and \
                words[at] not in NOT_FUNCTIONS and at > 0:
            depth = 0
            for end in range(at + 1, len(words)):
                depth += (words[end] == "(") - (words[end] == ")")
                if depth == 0:
                    return words[at], words[at + 2:end]
    return None


def functions(text):
    """Yield (name, first line, last line, complexity, parameters)."""
    statement, depth, head, complexity = [], 0, None, 0
    for token, line in tokens(without_noise(text)):
        if depth == 0 and token == "{":
            head = None if any(t in ("=", "typedef") for t, _ in statement) else head_of(statement)
            first, complexity, depth = statement[0][1] if statement else line, 1, 1
            if not head:
                statement.append((token, line))
        elif depth > 0:
            depth += (token == "{") - (token == "}")
            complexity += token in DECISIONS
            if depth == 0:
                if head:
                    yield head[0], first, line, complexity, parameter_count(head[1])
                    statement = []
                else:
                    statement.append((token, line))
        elif token == ";":
            statement = []
        else:
            statement.append((token, line))


def is_kernel(lines, first):
    """A comment beginning `kernel:` ends on the line before the function."""
    at = first - 2
    if at < 0 or not lines[at].rstrip().endswith("*/"):
        return False
    while at > 0 and "/*" not in lines[at]:
        at -= 1
    return re.match(r"\s*/\*\s*kernel:\s*\w", lines[at]) is not None


def check_columns(lines, name, problems):
    problems.extend(f"{name}:{k}: {len(line)} columns, at most {COLUMNS}"
                    for k, line in enumerate(lines, 1) if len(line) > COLUMNS)


def check_file(path, name, found, problems):
    text = path.read_text()
    lines = text.split("\n")
    count = len(lines) - 1
    limit = EXAMPLE_LINES if name.startswith("examples/") else FILE_LINES
    if count > limit:
        problems.append(f"{name}: {count} lines, at most {limit}")
    if "SPDX-License-Identifier: BSD-3-Clause" not in lines[0]:
        problems.append(f"{name}: the first line is not the SPDX line")
    check_columns(lines, name, problems)
    for function, first, last, complexity, parameters in functions(text):
        length = last - first + 1
        found.append((length, complexity, parameters, f"{name}:{first} {function}"))
        limit = KERNEL_LINES if is_kernel(lines, first) else LINES
        for what, value, most in (("lines", length, limit), ("complexity", complexity, COMPLEXITY),
                                  ("parameters", 0 if function.startswith(STANDARD) else parameters,
                                   PARAMETERS)):
            if value > most:
                problems.append(f"{name}:{first}: {function}: {what} {value}, at most {most}")
    return count


def self_test():
    """The scanner itself: a check that finds no function would pass everything."""
    text = ('#define X(a) \\\n    if (a) {\nstruct s { int a; };\nstatic const int t[] = {1, 2};\n'
            'static inline int f(int a, int (*g)(int, int))\n{\n    /* if */\n'
            '    if (a && a > 0x1p-3) { return \'{\'; }\n    return a ? 1 : "}"[0];\n}\n'
            '#ifdef Y\nint h(void)\n{\n#else\nint h2(void) {\n#endif\n}\n')
    expected = [("f", 5, 10, 4, 2), ("h", 12, 17, 1, 0)]
    actual = list(functions(text))
    if actual != expected:
        sys.exit(f"check_size.py: the scanner is broken: {actual}")


def main():
    self_test()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    root = parser.parse_args().folder
    found, problems, files = [], [], []
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.[ch]")):
            name = str(path.relative_to(root))
            files.append((check_file(path, name, found, problems), name))
    for path in sorted((root / "lib").rglob("*.inc")):
        check_columns(path.read_text().split("\n"), str(path.relative_to(root)), problems)
    shown = [f for f in found if not f[3].startswith(("tests/", "bench/"))]
    for title, key in (("longest functions", 0), ("most complex functions", 1)):
        print(f"{title} (lines, complexity, parameters), tests left out:")
        for row in sorted(shown, key=lambda f: (-f[key], f[3]))[:10]:
            print(f"  {row[0]:4} {row[1]:3} {row[2]:3}  {row[3]}")
    print("longest files:")
    for lines, name in sorted(files, key=lambda f: (-f[0], f[1]))[:10]:
        print(f"  {lines:4}  {name}")
    over = sum(1 for f in shown if f[0] > 40), sum(1 for f in shown if f[1] > 10)
    print(f"{len(files)} files, {sum(f[0] for f in files)} lines, {len(found)} functions; beyond the "
          f"aims (40 lines, complexity 10), tests left out: {over[0]}, {over[1]}")
    print("\n".join(problems + [f"size and complexity: {len(problems)} problems"]))
    return 1 if problems or not found else 0


if __name__ == "__main__":
    sys.exit(main())
