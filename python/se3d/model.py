# SPDX-License-Identifier: BSD-3-Clause
"""Model files and their results."""

import csv
import os
import tempfile
from collections import namedtuple

import numpy

from se3d._library import Definition, check, failure, ffi, lib, text
from se3d.system import System, escape

Analysis = namedtuple("Analysis", "type formulation method status start end cpu_time steps")
Statistics = namedtuple("Statistics", "min min_time max max_time mean rms integral last")


def _optional(value):
    return None if value is None else str(value)


class Model:
    """A model file (YAML or JSON) that was read, with its system.

    Model("pendulum.yaml", parameters={"mass": 2}, method="radau"): parameters, analysis,
    formulation, method, step, duration and tolerance replace those of the file; numbers or
    expressions. Model(text=...) reads a text.
    """

    def __init__(self, path=None, *, text=None, name="model", parameters=None, **values):
        for key in ("step", "duration", "tolerance"):
            values[key] = _optional(values.get(key))
        for key in ("analysis", "formulation", "method"):
            value = values.pop(key, None)
            if value is not None:
                values[key] = value
        texts = {key: values.pop(key) for key in ("analysis", "formulation", "method")
                 if key in values}
        options = Definition("se3d_model_options", values)
        for key, value in texts.items():
            setattr(options.pointer, key, options.keep(ffi.new("char[]", str(value).encode())))
        self._set_parameters(options, parameters or {})
        mistakes = []
        handle = ffi.new_handle(mistakes)
        options.pointer.report = lib.se3d_python_mistake
        options.pointer.report_ctx = handle
        out, error = ffi.new("se3d_model **"), ffi.new("se3d_model_error *")
        if text is None:
            status = lib.se3d_model_read_file(os.fsencode(path), options.pointer, out, error)
        else:
            content = text.encode()
            status = lib.se3d_model_read_text(content, len(content), name.encode(),
                                              options.pointer, out, error)
        if status < 0:
            raise failure(status, error, mistakes)
        self.pointer = ffi.gc(out[0], lib.se3d_model_destroy)
        self.system = System(_pointer=lib.se3d_model_get_system(self.pointer), _owner=self.pointer)

    @staticmethod
    def _set_parameters(options, parameters):
        settings = options.keep(ffi.new("se3d_model_setting[]", max(len(parameters), 1)))
        for setting, (name, value) in zip(settings, parameters.items()):
            setting.name = options.keep(ffi.new("char[]", name.encode()))
            number = repr(float(value)) if not isinstance(value, str) else value
            setting.value = options.keep(ffi.new("char[]", number.encode()))
        options.pointer.settings = settings
        options.pointer.setting_count = len(parameters)

    @property
    def name(self):
        """The file's name without folder and extension."""
        return text(lib.se3d_model_get_name(self.pointer))

    @property
    def title(self):
        """The title, "" if it has none."""
        return text(lib.se3d_model_get_title(self.pointer))

    def parameter(self, name):
        """Return the value of a parameter."""
        value = ffi.new("double *")
        check(lib.se3d_model_get_parameter(self.pointer, name.encode(), value),
              self.system.pointer)
        return value[0]

    def run(self, directory="results", *, progress=None):
        """Run every analysis and write the results into a folder. progress(analysis, time,
        fraction) is called after each row and may return True to stop. Return a Run; if an analysis
        fails, ModelError is raised and the rows so far are in the folder."""
        options = Definition("se3d_run_options", {"directory": os.fspath(directory),
                                                  "temporary": tempfile.gettempdir()})
        handle = None
        if progress:
            handle = ffi.new_handle(progress)
            options.pointer.progress = lib.se3d_python_progress
            options.pointer.ctx = handle
        calls = ffi.new("uint32_t *")
        options.pointer.interrupt = ffi.addressof(lib, "se3d_python_signals")
        options.pointer.interrupt_ctx = calls
        out, error = ffi.new("se3d_run **"), ffi.new("se3d_model_error *")
        status = lib.se3d_model_run(self.pointer, options.pointer, out, error)
        run = Run(self, ffi.gc(out[0], lib.se3d_run_destroy), directory) if out[0] else None
        if status < 0:
            reason = failure(status, error)
            if not (progress and isinstance(reason, KeyboardInterrupt)):
                raise reason
        return run

    def write_scene(self, path):
        """Write the present poses as binary glTF."""
        out, error = ffi.new("se3d_scene **"), ffi.new("se3d_model_error *")
        check(lib.se3d_scene_create(self.pointer, out))
        scene = ffi.gc(out[0], lib.se3d_scene_destroy)
        status = lib.se3d_scene_write(scene, os.fsencode(path), error)
        if status < 0:
            raise failure(status, error)

    def _repr_html_(self):
        return f"<h4>{escape(self.title or self.name)}</h4>" + self.system._repr_html_()


class Run:
    """The results of a model: analyses, files, tables."""

    def __init__(self, model, pointer, directory):
        self.model = model
        self.pointer = pointer
        self.directory = directory

    @property
    def analyses(self):
        """What each analysis did."""
        found = []
        for k in range(lib.se3d_run_count_analyses(self.pointer)):
            value = ffi.new("se3d_run_analysis *")
            check(lib.se3d_run_get_analysis_sized(self.pointer, k, value, ffi.sizeof(value[0])))
            found.append(Analysis(text(value.type), text(value.formulation), text(value.method),
                                  value.status, value.start, value.end, value.cpu_time,
                                  value.stats.steps))
        return found

    @property
    def files(self):
        """The paths of the tables that were written."""
        found = []
        for k in range(lib.se3d_run_count_files(self.pointer)):
            value = ffi.new("se3d_run_file *")
            check(lib.se3d_run_get_file_sized(self.pointer, k, value, ffi.sizeof(value[0])))
            found.append(text(value.path))
        return found

    @property
    def summary(self):
        """Columns of the summaries that the model asks for: name -> Statistics."""
        found = {}
        for k in range(lib.se3d_run_count_summaries(self.pointer)):
            value = ffi.new("se3d_run_summary *")
            check(lib.se3d_run_get_summary_sized(self.pointer, k, value, ffi.sizeof(value[0])))
            found[text(value.channel)] = Statistics(
                *[getattr(value, name) for name in Statistics._fields])
        return found

    def table(self, file=None):
        """Return the columns of a results file, the first one by default: name -> array."""
        path = self.files[0] if file is None else os.path.join(self.directory, file)
        with open(path, encoding="utf-8", newline="") as source:
            names = next(csv.reader(source))
            rows = numpy.loadtxt(source, delimiter=",", ndmin=2)
        if rows.size == 0:
            rows = rows.reshape(0, len(names))
        return {name: rows[:, k] for k, name in enumerate(names)}
