# SPDX-License-Identifier: BSD-3-Clause
"""Model files and their results."""

import csv
import os
import tempfile
from collections import namedtuple

import numpy

from se3d._library import Definition, check, failure, ffi, lib, text
from se3d.page import escape, show
from se3d.system import System

Analysis = namedtuple("Analysis", "type formulation method status start end cpu_time steps")
Statistics = namedtuple("Statistics", "min min_time max max_time mean rms integral last")


def _optional(value):
    return None if value is None else str(value)


def _write_scene(scene, path):
    error = ffi.new("se3d_model_error *")
    status = lib.se3d_scene_write(scene, os.fsencode(path), error)
    if status < 0:
        raise failure(status, error)


class Model:
    """A model file (YAML or JSON) that was read, with its system.

    Model("pendulum.yaml", parameters={"mass": 2}, method="radau"): parameters, analysis,
    formulation, method, step, duration, tolerance and threads replace those of the file; numbers or
    expressions. Model(text=...) reads a text.
    """

    def __init__(self, path=None, *, text=None, name="model", parameters=None, **values):
        for key in ("step", "duration", "tolerance", "threads"):
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

    def run(self, directory="results", *, progress=None, scene=True):
        """Run every analysis and write the results into a folder. progress(analysis, time,
        fraction) is called after each row and may return True to stop. scene: keep the motion at each
        row, for pictures of the run. Return a Run; if an analysis fails, ModelError is raised and the
        rows so far are in the folder."""
        options = Definition("se3d_run_options", {"directory": os.fspath(directory),
                                                  "temporary": tempfile.gettempdir()})
        watch = ffi.new("se3d_python_watch *")
        handle = ffi.new_handle(progress) if progress else None
        if handle:
            watch.progress = handle
        motion = self._create_scene() if scene else None
        if motion:
            watch.scene = motion
        options.pointer.progress = ffi.addressof(lib, "se3d_python_row")
        options.pointer.ctx = watch
        calls = ffi.new("uint32_t *")
        options.pointer.interrupt = ffi.addressof(lib, "se3d_python_signals")
        options.pointer.interrupt_ctx = calls
        out, error = ffi.new("se3d_run **"), ffi.new("se3d_model_error *")
        status = lib.se3d_model_run(self.pointer, options.pointer, out, error)
        run = (Run(self, ffi.gc(out[0], lib.se3d_run_destroy), directory, motion)
               if out[0] else None)
        if status < 0:
            reason = failure(status, error)
            if not (progress and isinstance(reason, KeyboardInterrupt)):
                raise reason
        return run

    def write(self, path, *, partial=False):
        """Write the model as one file, with its system as it is now. partial: what a file cannot hold
        is left out, else it is an error."""
        options = Definition("se3d_write_options", {"partial": int(partial)})
        error = ffi.new("se3d_model_error *")
        status = lib.se3d_model_write(self.pointer, os.fsencode(path), options.pointer, error)
        if status < 0:
            raise failure(status, error)

    def _create_scene(self):
        out, model = ffi.new("se3d_scene **"), self.pointer
        check(lib.se3d_scene_create(model, out))
        # The model outlives its scenes.
        return ffi.gc(out[0], lambda scene, _model=model: lib.se3d_scene_destroy(scene))

    def write_scene(self, path):
        """Write the present poses as binary glTF."""
        _write_scene(self._create_scene(), path)

    def _get_head(self):
        return f"<h4>{escape(self.title or self.name)}</h4>"

    def _repr_html_(self):
        return (self._get_head() + show(lambda path: self.write(path, partial=True),
                                        self.write_scene) + self.system._get_table())


class Run:
    """The results of a model: analyses, files, tables."""

    def __init__(self, model, pointer, directory, scene=None):
        self.model = model
        self.pointer = pointer
        self.directory = directory
        self._scene = scene

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
        """Return the columns of a results file, the first one by default: name -> array. HDF5 is
        read by h5py."""
        path = self.files[0] if file is None else os.path.join(self.directory, file)
        if path.endswith((".h5", ".hdf5")):
            import h5py
            with h5py.File(path) as source:
                return {name: column[:] for name, column in source["/"].items()}
        with open(path, encoding="utf-8", newline="") as source:
            names = next(csv.reader(source))
            rows = numpy.loadtxt(source, delimiter=",", ndmin=2)
        if rows.size == 0:
            rows = rows.reshape(0, len(names))
        return {name: rows[:, k] for k, name in enumerate(names)}

    def write_scene(self, path):
        """Write the motion as binary glTF; a run without one has the present poses."""
        _write_scene(self._scene or self.model._create_scene(), path)

    def _repr_html_(self):
        rows = "".join(
            f"<tr><td>{escape(one.type)}</td><td>{escape(one.method)}</td><td>{one.start:g}</td>"
            f"<td>{one.end:g}</td><td>{one.steps}</td></tr>" for one in self.analyses)
        return (self.model._get_head() + show(lambda path: self.model.write(path, partial=True),
                                              self.write_scene, self.files)
                + "<table><tr><th>analysis</th><th>method</th><th>from [s]</th><th>to [s]</th>"
                f"<th>steps</th></tr>{rows}</table>")
