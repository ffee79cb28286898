# SPDX-License-Identifier: BSD-3-Clause
"""Studies: many runs of one model with other parameters, measured."""

from collections import namedtuple

import numpy

from se3d._library import check, failure, ffi, lib, pointer, text

Samples = namedtuple("Samples", "numbers parameters measures failures")


class Study:
    """The `study` of a model file: Study(Model("damper.yaml")). Values are in SI units.

    len(study) samples; `parameters` and `measures` are names, in the order of the columns of all
    arrays. A study is used by one thread at a time, a model of its own for each.
    """

    def __init__(self, model):
        out, error = ffi.new("se3d_study **"), ffi.new("se3d_model_error *")
        status = lib.se3d_study_create(model.pointer, out, error)
        if status < 0:
            raise failure(status, error)
        self.model = model  # which must outlive it
        self.pointer = ffi.gc(out[0], lib.se3d_study_destroy)
        self._calls = ffi.new("uint32_t *")
        check(lib.se3d_study_set_interrupt(self.pointer,
                                           ffi.addressof(lib, "se3d_python_signals"), self._calls))
        self.parameters = self._names(lib.se3d_study_count_parameters,
                                      lib.se3d_study_get_parameter_name)
        self.measures = self._names(lib.se3d_study_count_measures,
                                    lib.se3d_study_get_measure_name)

    def _names(self, count, name):
        return tuple(text(name(self.pointer, k)) for k in range(count(self.pointer)))

    def __len__(self):
        return lib.se3d_study_count_samples(self.pointer)

    def sample(self, number):
        """Return the parameters of a sample [parameters]."""
        values = numpy.empty(len(self.parameters))
        check(lib.se3d_study_get_sample(self.pointer, number, pointer(values, "values")))
        return values

    def samples(self, numbers=None):
        """Return the parameters of samples (default: of all), a row for each."""
        numbers = range(len(self)) if numbers is None else numbers
        rows = [self.sample(int(number)) for number in numbers]
        return numpy.array(rows, dtype=float).reshape(len(rows), len(self.parameters))

    def _eval(self, parameters, measures):
        error = ffi.new("se3d_model_error *")
        status = lib.se3d_study_eval(self.pointer, pointer(parameters, "parameters"),
                                     pointer(measures, "measures"), error)
        if status in (lib.SE3D_ERR_INTERRUPTED, lib.SE3D_ERR_NO_MEMORY, lib.SE3D_ERR_STATE):
            raise failure(status, error)
        return failure(status, error) if status < 0 else None

    def eval(self, parameters):
        """Run the model with other parameters [parameters] and return the measures [measures]; of
        rows [n, parameters], rows [n, measures]. A measure without a value is NaN; a single run
        that fails raises ModelError, in rows all its measures are NaN."""
        given = numpy.ascontiguousarray(parameters, dtype=float)
        if given.ndim not in (1, 2) or given.shape[-1] != len(self.parameters):
            raise ValueError(f"parameters has the shape {given.shape}, must have "
                             f"{len(self.parameters)} columns: {', '.join(self.parameters)}")
        made = numpy.empty(given.shape[:-1] + (len(self.measures),))
        for row, out in zip(numpy.atleast_2d(given), numpy.atleast_2d(made)):
            failed = self._eval(row, out)
            if failed and failed.status != lib.SE3D_ERR_NOT_FINITE and given.ndim == 1:
                raise failed
        return made

    def run(self, numbers=None, *, progress=None):
        """Run samples (default: all): their numbers, parameters [n, parameters], measures
        [n, measures], and failures, a dictionary from the number of a sample to its exception.
        progress(done, of) is called after each and may return True to stop: the rows so far are
        returned."""
        numbers = numpy.array(range(len(self)) if numbers is None else list(numbers), dtype=int)
        parameters = self.samples(numbers)
        measures = numpy.full((len(numbers), len(self.measures)), numpy.nan)
        failures, done = {}, 0
        for number, row, out in zip(numbers, parameters, measures):
            failed = self._eval(row, out)
            if failed:
                failures[int(number)] = failed
            done += 1
            if progress and progress(done, len(numbers)):
                break
        return Samples(numbers[:done], parameters[:done], measures[:done], failures)

    def sensitivities(self):
        """Return the measures with the model's own parameters [measures], their derivatives
        [measures, sensitivity parameters] and the names of these parameters."""
        names = self._names(lib.se3d_study_count_sensitivities,
                            lib.se3d_study_get_sensitivity_name)
        error = ffi.new("se3d_model_error *")
        nominal = numpy.empty(len(self.measures))
        status = lib.se3d_study_eval_nominal(self.pointer, pointer(nominal, "nominal"), error)
        if status < 0 and status != lib.SE3D_ERR_NOT_FINITE:
            raise failure(status, error)
        columns = numpy.empty((len(names), len(self.measures)))
        value = ffi.new("double *")
        for k, column in enumerate(columns):
            status = lib.se3d_study_eval_sensitivity(self.pointer, k, value,
                                                     pointer(column, "column"), ffi.NULL, error)
            if status < 0 and status != lib.SE3D_ERR_NOT_FINITE:
                raise failure(status, error)
        return nominal, columns.T.copy(), names
