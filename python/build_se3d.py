# SPDX-License-Identifier: BSD-3-Clause
"""Compiles the extension module `se3d._se3d` from the library's own headers.

The declarations are those of include/se3d, read by the C preprocessor, so that nothing is said
twice. Where the library is: SE3D_INCLUDE (a folder), SE3D_LIBRARIES (folders, separated by ":"), or
what pkg-config says of se3d-io. Folders with shared libraries are remembered in the module, or those
that SE3D_RUNPATH names (empty: none).

    python3 build_se3d.py        leaves the module beside the package, for use from the source tree
    pip install .                does the same by way of setup.py
"""

import os
import re
import shlex
import subprocess
import sys
import tempfile

from cffi import FFI

HERE = os.path.dirname(os.path.abspath(__file__))

# Functions of Python that C calls; what they are called with tells which object is meant.
CALLBACKS = """
extern "Python" se3d_status se3d_python_function(void *, const double *, double *, double *);
extern "Python" se3d_status se3d_python_force(void *, double, const se3d_body_motion *, double *,
                                              double *, double *);
extern "Python" se3d_status se3d_python_energy(void *, double, const se3d_body_motion *, double *,
                                               double *);
extern "Python" se3d_status se3d_python_constraint(void *, double, const se3d_body_motion *,
                                                   double *, double *, double *, double *);
extern "Python" se3d_status se3d_python_event_value(void *, const se3d_system *, double *);
extern "Python" se3d_status se3d_python_event(void *, se3d_system *, const se3d_event_record *);
extern "Python" void se3d_python_log(void *, se3d_log_level, se3d_log_kind,
                                     const char *);
extern "Python" int se3d_python_interrupt(void *);
extern "Python" int se3d_python_progress(void *, size_t, double, double);
extern "Python" void se3d_python_mistake(void *, const se3d_model_error *);
int se3d_python_signals(void *calls);
typedef struct se3d_python_watch { se3d_scene *scene; void *progress; } se3d_python_watch;
int se3d_python_row(void *watch, size_t, double, double);
"""

# Asks Python for signals (Ctrl-C) at one call of 256, so that short steps stay cheap.
SOURCE = """
#include <se3d/io.h>
#include <se3d/import.h>
#include <se3d/study.h>

static int se3d_python_signals(void *calls)
{
    uint32_t *count = calls;
    int stop = 0;
    if (++*count % 256 == 0) {
        const PyGILState_STATE state = PyGILState_Ensure();
        stop = PyErr_CheckSignals() != 0;
        PyErr_Clear();
        PyGILState_Release(state);
    }
    return stop;
}

typedef struct se3d_python_watch { se3d_scene *scene; void *progress; } se3d_python_watch;

static int se3d_python_progress(void *, size_t, double, double);

/* Of each row of a run; either may be NULL. A scene that fails once is no longer recorded. */
static int se3d_python_row(void *ctx, size_t analysis, double time, double fraction)
{
    se3d_python_watch *watch = ctx;
    if (watch->scene && SE3D_FAILED(se3d_scene_record(watch->scene))) {
        watch->scene = NULL;
    }
    return watch->progress ? se3d_python_progress(watch->progress, analysis, time, fraction) : 0;
}
"""


def _pkg_config(*arguments):
    command = ["pkg-config", *arguments, "se3d-io"]
    try:
        return shlex.split(subprocess.run(command, check=True, capture_output=True,
                                          text=True).stdout)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit("libse3d was not found: install it, or set SE3D_INCLUDE and "
                         f"SE3D_LIBRARIES ({' '.join(command)}: {error})") from error


def settings():
    """Return the folders of headers and libraries, and further arguments of the linker."""
    include = os.environ.get("SE3D_INCLUDE")
    if include:
        folders = os.environ.get("SE3D_LIBRARIES", "").split(os.pathsep)
        return [include], [folder for folder in folders if folder], ["-lse3d-io", "-lse3d"]
    flags = _pkg_config("--cflags", "--libs")
    includes = [flag[2:] for flag in flags if flag.startswith("-I")] or ["/usr/include"]
    folders = [flag[2:] for flag in flags if flag.startswith("-L")]
    return includes, folders, [flag for flag in flags if not flag.startswith(("-I", "-L"))]


def declarations(includes):
    """Return the public declarations as cffi takes them: without macros and inline functions."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    with tempfile.TemporaryDirectory() as folder:
        for name in ("stddef.h", "stdint.h", "math.h", "string.h"):
            with open(os.path.join(folder, name), "w", encoding="ascii"):
                pass
        source = os.path.join(folder, "all.c")
        with open(source, "w", encoding="ascii") as file:
            file.write("#include <se3d/io.h>\n#include <se3d/import.h>\n#include <se3d/study.h>\n")
        paths = [f"-I{path}" for path in (folder, *includes)]
        text = subprocess.run([*compiler, "-E", "-P", "-nostdinc", "-U__GNUC__", *paths, source],
                              check=True, capture_output=True, text=True).stdout
    # Inline functions have no blocks within their body.
    return re.sub(r"static inline [^;{]*\{[^{}]*\}", "", text)


def builder():
    """Return the FFI object that setuptools and the command line compile."""
    includes, folders, arguments = settings()
    ffi = FFI()
    ffi.cdef(declarations(includes))
    ffi.cdef(CALLBACKS)
    libraries = [argument[2:] for argument in arguments if argument.startswith("-l")]
    others = [argument for argument in arguments if not argument.startswith("-l")]
    shared = [folder for folder in os.environ.get("SE3D_RUNPATH", os.pathsep.join(folders)).split(os.pathsep)
              if folder and os.path.exists(os.path.join(folder, "libse3d.so"))]
    ffi.set_source("se3d._se3d", SOURCE,
                   include_dirs=includes, library_dirs=folders, libraries=libraries,
                   runtime_library_dirs=shared, extra_link_args=others)
    return ffi


if __name__ == "__main__":
    target = sys.argv[1] if len(sys.argv) > 1 else HERE
    print(builder().compile(tmpdir=target))
