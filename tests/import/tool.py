# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of `se3d import` share: import a file, run what came of it, read the results."""
import csv
import json
import os
import subprocess
import sys
from pathlib import Path

PROGRAM = os.environ["SE3D_PROGRAM"]
SOURCE = Path(os.environ["SE3D_SOURCE_DIR"]) / "tests" / "import"
WORK = Path(os.environ["SE3D_BUILD_DIR"]) / "import"


def fail(text):
    print(f"FAILED: {text}")
    sys.exit(1)


def check(condition, text):
    if not condition:
        fail(text)


def convert(file, *options, code=0):
    """Import a file beside this one; the text of the model and the notes."""
    WORK.mkdir(parents=True, exist_ok=True)
    out = WORK / (Path(file).name + ".yaml")
    if out.exists():
        out.unlink()
    done = subprocess.run([PROGRAM, "import", str(SOURCE / file), "-o", str(out), "--json", *options],
                          capture_output=True, text=True, check=False)
    check(done.returncode == code, f"{file}: exit code {done.returncode}, not {code}: {done.stderr}")
    return out.read_text(), json.loads(done.stdout)["notes"]


def run(name, text, *options):
    """Run a model; its results.csv as {column: values}, of the file that its output names."""
    path = WORK / f"{name}.yaml"
    path.write_text(text)
    out = WORK / name
    done = subprocess.run([PROGRAM, "run", "-q", str(path), "-o", str(out), *options],
                          capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"{name}: the run failed: {done.stderr}")
    with open(out / "results.csv", encoding="ascii") as file:
        rows = list(csv.reader(file))
    return {head: [float(row[k]) for row in rows[1:]] for k, head in enumerate(rows[0])}


def replace_analysis(text, analysis):
    """The model with another analysis, which ends the file with its outputs."""
    head, found, _ = text.partition("\nanalysis:")
    check(found, "the model has no analysis")
    return head + "\n" + analysis


def near(what, value, wanted, tolerance):
    check(abs(value - wanted) <= tolerance, f"{what} is {value!r}, not {wanted!r}")


def freedoms(name, text):
    """How many degrees of freedom the program finds in a model."""
    path = WORK / f"{name}.yaml"
    path.write_text(text)
    done = subprocess.run([PROGRAM, "check", str(path), "--json"], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"{name}: the check failed: {done.stderr}")
    return json.loads(done.stdout)["freedoms"]
