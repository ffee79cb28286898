#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make the documentation as a site: make.py FOLDER [PLAYGROUND]. Needs mkdocs and doxygen, no
network. Pages are those of docs/; links to files that are no pages become their names. The C reference
is made from the public headers, whose comments doxygen gets in its own form. Formulas of the theory
are typeset (formulas.py)."""
import pathlib
import re
import shutil
import subprocess
import sys

import formulas

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTSIDE = ("CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "RELEASING.md", "bench/README.md",
           "bench/granular/README.md", "packaging/README.md")
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#\s]*)(#[^)\s]*)?\)")


def find_pages():
    """Source of each file of the site, by its path there."""
    pages = {"index.md": ROOT / "README.md"}
    for path in sorted((ROOT / "docs").rglob("*")):
        if path.suffix in (".md", ".png", ".jpg", ".svg", ".gif", ".webp") and "site" not in path.parts:
            pages[str(path.relative_to(ROOT / "docs"))] = path
    for name in OUTSIDE:
        pages[name] = ROOT / name
    return pages


def rewrite(text, name, source, pages):
    """Links from where the page stands in the repository to where it stands in the site."""
    places = {path.resolve(): target for target, path in pages.items()}
    up = "../" * name.count("/")

    def change(match):
        mark, words, target, anchor = match.groups()
        if "://" in target or not target:
            return match.group(0)
        place = places.get((source.parent / target).resolve())
        if place is None:
            return words
        return f"{mark}[{words}]({up}{place}{anchor or ''})"

    return LINK.sub(change, text)


def stage_pages(folder):
    pages = find_pages()
    for name, source in pages.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".md":
            target.write_text(rewrite(source.read_text(), name, source, pages))
        else:
            shutil.copy(source, target)


def convert_header(name, text):
    """`/* ... */` before a declaration, and behind a member, as doxygen wants them."""
    lines, depth = [], 0
    for number, line in enumerate(text.splitlines()):
        if number == 1 and line.startswith("/* "):
            line = f"/** @file {name}\n * @brief " + line[3:]
        elif line.startswith("/* ") and number > 1:
            line = "/** " + line[3:]
        elif re.match(r"\s+/\* ", line) and depth:
            line = line.replace("/* ", "/** ", 1)
        elif depth and re.search(r"[;,\w] +/\* ", line):
            line = line.replace("/* ", "/**< ", 1)
        depth += line.count("{") - line.count("}")
        lines.append(line)
    return "\n".join(lines) + "\n"


def stage_headers(folder):
    folder.mkdir(parents=True)
    for path in sorted((ROOT / "include/se3d").glob("*.h")):
        (folder / path.name).write_text(convert_header(path.name, path.read_text()))


def typeset_formulas(folder):
    for path in sorted((folder / "theory").glob("*.html")):
        path.write_text(formulas.typeset(path.read_text()))


def run(words, folder):
    if shutil.which(words[0]) is None:
        sys.exit(f"make.py: {words[0]} is missing: apt-get install --no-install-recommends {words[0]}")
    if subprocess.run(words, cwd=folder).returncode != 0:
        sys.exit(f"make.py: {words[0]} failed")


def main(words):
    if len(words) not in (2, 3):
        sys.exit("use: make.py FOLDER [PLAYGROUND]")
    if len(words) == 3 and not pathlib.Path(words[2]).is_file():
        sys.exit(f"make.py: {words[2]} is missing: python3 tools/playground/make.py {words[2]}")
    folder = pathlib.Path(words[1]).resolve()
    work = folder.with_name(folder.name + ".work")
    shutil.rmtree(work, ignore_errors=True)
    stage_headers(work / "include/se3d")
    stage_pages(work / "pages")
    shutil.copy(ROOT / "docs/site/site.css", work / "pages")
    for name in ("mkdocs.yml", "Doxyfile"):
        shutil.copy(ROOT / "docs/site" / name, work)
    (work / "c").mkdir()
    run(["doxygen", "Doxyfile"], work)
    shutil.move(work / "c", work / "pages/c")
    run(["mkdocs", "build", "--strict", "--clean", "-q", "-d", str(folder)], work)
    typeset_formulas(folder)
    shutil.rmtree(work)
    if len(words) == 3:
        shutil.copy(words[2], folder / "playground.html")
    print(f"wrote {folder}/index.html")


if __name__ == "__main__":
    main(sys.argv)
