#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run the blocks of a page: run_tutorial.py PAGE. YAML goes into the file that its first line names,
`sh` is run, and each line of a `text` block must be found in what the commands before it printed."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)


def main(page):
    source = pathlib.Path(os.environ["SE3D_SOURCE_DIR"])
    path = os.path.dirname(os.environ["SE3D_PROGRAM"]) + os.pathsep + os.environ["PATH"]
    said, counts, failed = "", {"yaml": 0, "sh": 0, "text": 0}, 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "examples").symlink_to(source / "examples")
        for kind, text in FENCE.findall((source / page).read_text()):
            counts[kind] += 1
            if kind == "yaml":
                (folder / text.split("\n")[0].removeprefix("# ")).write_text(text)
            elif kind == "sh":
                done = subprocess.run(["sh", "-ec", text], cwd=folder, env={**os.environ, "PATH": path},
                                      capture_output=True, text=True)
                said = done.stdout + done.stderr
                if done.returncode != 0:
                    failed += 1
                    print(f"{page}: exit code {done.returncode}:\n{text}{said}")
            else:
                for line in text.splitlines():
                    if line not in said:
                        failed += 1
                        print(f"{page}: no `{line}` in:\n{said}")
    print(f"{page}: {counts}, {failed} failed")
    return failed > 0 or min(counts.values()) == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
