#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes wrappers that a test can let fail, of all functions of headers that return a status.

    refusals.py OUT HEADER...    OUT.c, and OUT.txt: options of the linker that put them in front

Each asks support_refusal() of support/refusals.h, and fails with what that returns in place of
calling the function. It tells the worst status that is documented for the function and that is no
mistake of the caller."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from check_headers import comment_before, parameters, return_part, statuses  # noqa: E402

FUNCTION = re.compile(r"^(?:SE3D_API )?se3d_status\s+(se3di?_\w+)\(((?:[^()]|\([^()]*\))*)\);", re.M)
FAILURES = "NO_MEMORY NOT_FINITE NO_CONVERGENCE INCONSISTENT SINGULAR STEP_SIZE CALLBACK UNSUPPORTED".split()
SETTER = re.compile(r"_set(_|$)")  # values may be wrong at any time, not handles and pointers only


def documented(name, comments):
    """The worst failure that the description of a function tells, SE3D_OK if it tells none."""
    worst = FAILURES + ["INVALID_ARGUMENT"] * bool(SETTER.search(name))
    listed, comment = set(), comments[name]
    while comment is not None:
        listed |= statuses(comment)
        other = re.search(r"\bas (se3di?_\w+)", return_part(comment) or "")
        comment = comments.pop(other.group(1), None) if other else None
    return next((f"SE3D_ERR_{status}" for status in worst if {status, f"SE3D_ERR_{status}"} & listed), "SE3D_OK")


def wrapper(name, inside, failure):
    names = [word for _, word in parameters(inside)]
    # What a function would have made is NULL if it fails: so it is documented.
    made = [word for kind, word in parameters(inside) if re.fullmatch(r"(const )?se3d_\w+ \*\*", kind)]
    lines = [f"se3d_status __real_{name}({inside});", f"se3d_status __wrap_{name}({inside});",
             f"se3d_status __wrap_{name}({inside})", "{",
             f"    const se3d_status refused = support_refusal(\"{name}\", {failure});"]
    for word in made:
        lines += [f"    if (refused < 0 && {word}) {{", f"        *{word} = NULL;", "    }"]
    return "\n".join(lines + [f"    return refused < 0 ? refused : __real_{name}({', '.join(names)});", "}", ""])


def main():
    out, *headers = sys.argv[1:]
    found, code = [], ["/* Made by tests/support/refusals.py. */"]
    code += [f'#include "{header}"' for header in headers] + ['#include "support/refusals.h"', ""]
    for header in headers:
        text = next(p for p in (ROOT / "include" / header, ROOT / "lib" / header) if p.exists()).read_text()
        functions = [(m.group(1), m.group(2), comment_before(text, m.start())) for m in FUNCTION.finditer(text)]
        comments = {name: comment for name, _, comment in functions}
        for name, inside, _ in functions:
            found.append(name)
            code.append(wrapper(name, inside, documented(name, dict(comments))))
    Path(out + ".c").write_text("\n".join(code))
    Path(out + ".txt").write_text("".join(f"--wrap={name}\n" for name in found))


if __name__ == "__main__":
    main()
