# SPDX-License-Identifier: BSD-3-Clause
"""Analyses of a system, and events."""

from collections import namedtuple

from se3d._library import (Definition, EventRecord, check, ffi, lib, text)

Stats = namedtuple("Stats", "steps rejected iterations evaluations factorizations solves")

_step = lib.se3d_solver_step  # found once: a step takes less than a microsecond


class Solver:
    """An analysis of one system: "dynamics", "kinematics", "inverse_dynamics", "assembly",
    "equilibrium".

    Keywords are those of se3d_solver_def: method, formulation, step, tolerance, ...; `interrupt` is
    asked before every step whether the run is to end. Ctrl-C ends a run, too.
    """

    def __init__(self, system, analysis="dynamics", *, interrupt=None, **values):
        self.system = system
        definition = Definition("se3d_solver_def", dict(values, analysis=analysis))
        if interrupt:
            self._interrupt = ffi.new_handle(interrupt)
            definition.pointer.interrupt = lib.se3d_python_interrupt
        else:
            self._interrupt = ffi.new("uint32_t *")
            definition.pointer.interrupt = ffi.addressof(lib, "se3d_python_signals")
        self._is_asked = interrupt is not None
        definition.pointer.interrupt_ctx = self._interrupt
        out = ffi.new("se3d_solver **")
        check(lib.se3d_solver_create(system.pointer, definition.pointer, out), system.pointer)
        self.pointer = ffi.gc(out[0], lib.se3d_solver_destroy)
        self._kept = []

    def run(self, end):
        """Run to a time [s]; at the present time the state is only made consistent. Return the
        status: > 0 tells of events or redundant constraints."""
        return self._check(lib.se3d_solver_run(self.pointer, end))

    def step(self, length):
        """Make one step [s]."""
        status = _step(self.pointer, length)
        return self._check(status) if status else status

    def _check(self, status):
        if status == lib.SE3D_ERR_INTERRUPTED and not self._is_asked:
            raise KeyboardInterrupt
        return check(status, self.system.pointer)

    def _number(self, function):
        value = ffi.new("double *")
        check(function(self.pointer, value), self.system.pointer)
        return value[0]

    @property
    def tolerance(self):
        """To which steps are controlled; 0: they are not."""
        return self._number(lib.se3d_solver_get_tolerance)

    @property
    def method(self):
        """The method in use; of "auto" the one that it picked."""
        name = ffi.new("char const **")
        check(lib.se3d_solver_get_method(self.pointer, name), self.system.pointer)
        return text(name[0])

    @property
    def stats(self):
        """Counters since creation."""
        value = ffi.new("se3d_solver_stats *")
        check(lib.se3d_solver_get_stats_sized(self.pointer, value, ffi.sizeof(value[0])))
        return Stats(*[getattr(value, name) for name in Stats._fields])

    def event(self, value, *, callback=None, **values):
        """Look for crossings of value(), which reads the system and sets nothing, during runs:
        name, level, direction ("rising", "falling", "any"), action ("record", "stop"),
        motion_only, hysteresis. callback(record) is called at each; if it returns True the run
        stops."""
        definition = Definition("se3d_event_def", values)
        definition.pointer.value = lib.se3d_python_event_value
        definition.pointer.ctx = self._keep(value)
        if callback:
            definition.pointer.callback = lib.se3d_python_event
            definition.pointer.callback_ctx = self._keep(callback)
        out = ffi.new("se3d_event *")
        check(lib.se3d_event_create(self.pointer, definition.pointer, out), self.system.pointer)

    def _keep(self, what):
        handle = ffi.new_handle(what)
        self._kept.append((handle, what))
        return handle

    @property
    def events(self):
        """The events that happened, in their order."""
        found = []
        for k in range(lib.se3d_solver_count_event_records(self.pointer)):
            record = ffi.new("se3d_event_record *")
            check(lib.se3d_solver_get_event_record_sized(self.pointer, k, record,
                                                         ffi.sizeof(record[0])))
            found.append(EventRecord(record))
        return found
