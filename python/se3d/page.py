# SPDX-License-Identifier: BSD-3-Clause
"""Pictures in notebooks: what the program `se3d` draws of a model or of results, as HTML.

The program is SE3D_PROGRAM, or `se3d` of the path. A page above LIMIT bytes would make a notebook
heavy: a sketch takes its place.
"""

import base64
import contextlib
import os
import shutil
import signal
import subprocess
import tempfile

from se3d._library import Error

LIMIT = 4_000_000
LINES = 3  # of what the program says when it fails
WAIT = 60  # s, for the program: the page's parts are made on first use, from the network


def escape(value):
    """Escape a text for HTML."""
    for character, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        value = value.replace(character, entity)
    return value


def _call(*words):
    """Run the program; return why it failed, "" if it did not."""
    program = os.environ.get("SE3D_PROGRAM") or shutil.which("se3d")
    if not program:
        return "the program se3d is not found: put it on PATH, or name it by SE3D_PROGRAM"
    with tempfile.TemporaryFile() as told:
        try:
            process = subprocess.Popen([program, *words], stdin=subprocess.DEVNULL, stdout=told,
                                       stderr=told, start_new_session=True)
        except OSError as error:
            return f"{program}: {error.strerror}"
        try:
            code = process.wait(WAIT)
        except BaseException as error:
            with contextlib.suppress(OSError):
                if hasattr(os, "killpg"):
                    os.killpg(process.pid, signal.SIGKILL)  # with what it has started
                else:
                    process.kill()
            process.wait()
            if not isinstance(error, subprocess.TimeoutExpired):
                raise
            return f"se3d {words[0]} took longer than {WAIT} s"
        told.seek(0)
        said = told.read().decode(errors="replace").strip() or f"se3d {words[0]} failed"
        return "; ".join(said.splitlines()[-LINES:]) if code else ""


def _read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def _page(folder, write_scene, tables):
    """Return the page as a frame and why there is none."""
    write_scene(os.path.join(folder, "scene.glb"))
    for table in tables:
        with contextlib.suppress(OSError):
            shutil.copy(table, folder)
    path = os.path.join(folder, "page.html")
    reason = _call("view", "-q", folder, "-o", path)
    if reason:
        return "", reason
    if os.path.getsize(path) > LIMIT:
        return "", f"the page has {os.path.getsize(path)} bytes, a notebook gets at most {LIMIT}"
    page = _read(path).replace("&", "&amp;").replace('"', "&quot;")
    return (f'<iframe srcdoc="{page}" style="width:100%;height:480px;border:0" '
            'title="the model in 3-D" allowfullscreen></iframe>'), ""


def _sketch(folder, write_model):
    """Return the sketch and why there is none."""
    model, path = os.path.join(folder, "model.yaml"), os.path.join(folder, "sketch.svg")
    write_model(model)
    reason = _call("sketch", "-q", model, "-o", path)
    if reason:
        return "", reason
    data = base64.b64encode(_read(path).encode()).decode()
    return f'<img src="data:image/svg+xml;base64,{data}" alt="sketch of the model"/>', ""


def _try(draw, *arguments):
    """A picture that fails tells why: a notebook shows the rest all the same."""
    try:
        return draw(*arguments)
    except (OSError, ValueError, Error) as error:
        return "", str(error)


def show(write_model, write_scene=None, tables=()):
    """Return HTML of a scene beside its tables: the page of `se3d view`, else a sketch, else why there
    is neither. Both are functions of a path; without a scene it is a sketch."""
    reasons = []
    with tempfile.TemporaryDirectory() as folder:
        if write_scene:
            page, reason = _try(_page, folder, write_scene, tables)
            if page:
                return page
            reasons.append(f"no scene: {reason}")
        sketch, reason = _try(_sketch, folder, write_model)
    if not sketch:
        reasons.append(f"no sketch: {reason}")
    return sketch + "".join(f"<p><small>{escape(text)}</small></p>" for text in reasons)
