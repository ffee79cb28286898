#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the words of model files, keys and choices, as a dictionary for libFuzzer: those of
docs/se3d.schema.json, which follows the tables of the reader."""
import argparse
import json
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SIGNS = ["- ", ": ", "[", "]", "{", "}", "&a ", "*a", "!!int ", "|\\x0a", "1e999", ".nan", "~",
         "\\xef\\xbb\\xbf", "ground", "pi/4*cos(2*t)", " mm", " kN", " deg", "{1 + 1}"]


def words(node):
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "properties":
                yield from (name + ": " for name in value)
            elif key in ("enum", "const"):
                yield from (v for v in (value if isinstance(value, list) else [value])
                            if isinstance(v, str))
            yield from words(value)
    elif isinstance(node, list):
        for value in node:
            yield from words(value)


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter).parse_args()
    schema = json.loads((ROOT / "docs" / "se3d.schema.json").read_text())
    for word in sorted(set(words(schema))) + SIGNS:
        if '"' not in word:
            print(f'"{word}"')


if __name__ == "__main__":
    main()
