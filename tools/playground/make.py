#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make the playground: make.py [--quick] PAGE. One page with the library as WebAssembly in it, which
needs no server and asks for nothing: a model file on the left, what it does on the right. Needs
emscripten (emcc), npm, and on Debian the sources of AMD, libyaml and expat, which are fetched.
Compiles what is newer than its object only, in build/playground. With --quick, for tests: the
library as two sources, not optimised."""
import base64
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build/playground"
VIEWER = ROOT / "tools/viewer"
PLAYED = (ROOT / "tools/playground/sources.txt").read_text().split()
SOURCES = {  # Debian's packages, what is unpacked of them, what is compiled
    "suitesparse": (["*/AMD/Source/*", "*/AMD/Include/*", "*/SuiteSparse_config/*.h"],
                    [f"AMD/Source/amd_{part}.c" for part in ("2", "defaults", "postorder", "post_tree")]),
    "libyaml": (["*/src/*", "*/include/*"],
                [f"src/{part}.c" for part in ("api", "dumper", "emitter", "loader", "parser", "reader",
                                              "scanner", "writer")]),
    "expat": (["*/lib/*"], [f"expat/lib/{part}.c" for part in ("xmlparse", "xmlrole", "xmltok")]),
}
FLAGS = ["-O2", "-std=c11", "-D_GNU_SOURCE", "-ffp-contract=off", "-Iinclude", "-Ilib", "-Itools/se3d",
         '-DYAML_VERSION_STRING="0.2.5"', "-DYAML_VERSION_MAJOR=0", "-DYAML_VERSION_MINOR=2",
         "-DYAML_VERSION_PATCH=5", "-DYAML_DECLARE_STATIC", "-DXML_STATIC", "-DXML_NS=1", "-DXML_DTD=1",
         "-DXML_CONTEXT_BYTES=1024", "-DBYTEORDER=1234", "-DXML_POOR_ENTROPY", "-w"]
CALLS = ["open", "save", "watch", "say", "turn", "take_scene", "take_state"]
LINK = ["-O1", "-sMODULARIZE=1", "-sEXPORT_NAME=se3dEngine", "-sSINGLE_FILE=1", "-sALLOW_MEMORY_GROWTH=1",
        "-sENVIRONMENT=worker,node", "-sFORCE_FILESYSTEM=1", "-sTOTAL_STACK=4MB",
        "-sEXPORTED_RUNTIME_METHODS=ccall,FS", "-sEXPORTED_FUNCTIONS=" +
        ",".join(f"_se3d_play_{name}" for name in CALLS)]


def run(words):
    if subprocess.run(words, cwd=ROOT).returncode != 0:
        sys.exit(f"make.py: failed: {shlex.join(map(str, words))[-300:]}")


def find_sources(is_quick):
    """What is compiled, and the folders of headers."""
    sources = sorted((ROOT / "lib").rglob("*.c"))
    if is_quick:
        run([sys.executable, "tools/amalgamate.py", WORK])
        sources = [WORK / "se3d.c", WORK / "se3d-io.c"]
        # browsers take no functions with as many variables as kernels have that are not optimised
        sources[0].write_text(sources[0].read_text().replace("__attribute__((always_inline))", ""))
    sources += [ROOT / name for name in PLAYED]
    headers = []
    for package, (patterns, names) in SOURCES.items():
        folder = ROOT / "build" / ("amd" if package == "suitesparse" else package)
        run(["sh", "tools/debian_source.sh", package, folder, *patterns])
        sources += [folder / name for name in names]
        headers += [folder / name for name in ("AMD/Include", "SuiteSparse_config", "include", "expat/lib", "src")
                    if (folder / name).is_dir()]
    (WORK / "expat_config.h").touch()  # FLAGS say what it would
    return sources, [f"-I{path}" for path in [*headers, WORK]]


def compile_all(sources, headers, flags):
    newest = max(path.stat().st_mtime for folder in ("include", "lib", "tools/se3d")
                 for ending in ("*.h", "*.inc") for path in (ROOT / folder).rglob(ending))
    objects, due = [], []
    for source in sources:
        made = WORK / (str(source.relative_to(ROOT)).replace("/", "_") + ".o")
        objects.append(made)
        if not made.exists() or made.stat().st_mtime < max(newest, source.stat().st_mtime):
            due.append(["emcc", *flags, *headers, "-c", source, "-o", made])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 2) as pool:
        for _ in pool.map(run, due):
            pass
    return objects


def find_models():
    """The text of every example model, and of what it reads, by its name."""
    files = {}
    for path in sorted((ROOT / "examples/models").rglob("*")):
        if path.is_file():
            files[str(path.relative_to(ROOT / "examples/models"))] = path.read_text()
    return files


def find_scripts():
    """Those of every page, in their order, as the program has them."""
    page = (ROOT / "tools/se3d/page.c").read_text()
    return re.findall(r'"(\w+\.js)"', re.search(r"scripts\[\] = \{(.*?)\}", page, re.S)[1])


def make_live_page(three):
    """The page of `se3d live`, which asks what holds it."""
    read = lambda name: (VIEWER / name).read_text()
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n<title>se3d</title>\n<style>\n' +
            read("viewer.css") + "</style></head><body>\n" + read("viewer.html") + read("live.html") +
            "<script>window.se3dAsk = parent.se3dAsk;</script>\n<script>\n" + three + "\n" +
            "".join(f"</script>\n<script>\n{read(name)}" for name in [*find_scripts(), "live.js"]) +
            "</script>\n</body></html>\n")


def make_page(engine, three):
    read = lambda name: (ROOT / "tools/playground" / name).read_text()
    files = json.dumps(find_models()).replace("<", "\\u003c")
    live = base64.b64encode(make_live_page(three).encode()).decode()  # nothing in it ends a script
    page = read("playground.html")
    for name, text in (("engine", f"{engine}\nconst se3dFiles = {files};\n{read('worker.js')}"),
                       ("live", live), ("files", files)):
        if "</script" in text.lower():
            sys.exit(f"make.py: the {name} would end its script")
        page += f'<script type="text/plain" id="{name}">{text}</script>\n'
    return page + f"<script>\n{read('playground.js')}</script>\n</body></html>\n"


def main(words):
    global WORK
    is_quick = "--quick" in words[1:2]
    if len(words) != 2 + is_quick:
        sys.exit("use: make.py [--quick] PAGE")
    if shutil.which("emcc") is None:
        sys.exit("make.py: emcc is missing: apt-get install --no-install-recommends emscripten")
    if is_quick:
        WORK = WORK.with_name("playground-quick")
    WORK.mkdir(parents=True, exist_ok=True)
    objects = compile_all(*find_sources(is_quick), [*FLAGS, *["-O0"] * is_quick])  # the last one counts
    run(["emcc", *LINK, *objects, "-o", WORK / "engine.js"])
    run(["sh", VIEWER / "build.sh", WORK])
    page = pathlib.Path(words[-1]).resolve()
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(make_page((WORK / "engine.js").read_text(), (WORK / "three.js").read_text()))
    print(f"wrote {page}, {page.stat().st_size} bytes")


if __name__ == "__main__":
    main(sys.argv)
