# SPDX-License-Identifier: BSD-3-Clause
"""Batches: many states of one system, stepped side by side."""

import numpy

from se3d._library import Error, check, ffi, lib, method_number, pointer, text


class Batch:
    """Many states of one system whose joints form a tree, each with its own time, efforts, gravity
    and masses; se3d/batch.h tells what the numbers are. It is independent of its system. Arrays
    have one row for each state."""

    def __init__(self, system, count, threads=1):
        out = ffi.new("se3d_batch **")
        check(lib.se3d_batch_create(system.pointer, count, threads, out), system.pointer)
        self.pointer = ffi.gc(out[0], lib.se3d_batch_destroy)
        self.count = count
        self.velocity_count = lib.se3d_batch_count_velocities(self.pointer)
        self.position_count = lib.se3d_batch_count_positions(self.pointer)
        self.lanes = lib.se3d_batch_count_lanes(self.pointer)

    def _check(self, status):
        try:
            return check(status)
        except Error as error:
            raise Error(text(lib.se3d_batch_get_error(self.pointer)) or str(error),
                        status) from None

    def _rows(self, values, size, what):
        """Return an array with rows of `size` numbers as a pointer, and the count of rows."""
        array = numpy.ascontiguousarray(values, dtype=float)
        if array.size % size:
            raise ValueError(f"{what} has {array.size} numbers, must have {size} for each state")
        return pointer(array, what), array.size // size

    def _set(self, function, values, size, what, first):
        array, count = self._rows(values, size, what)
        self._check(function(self.pointer, first, count, array))

    def get(self, first=0, count=None):
        """Return q and qdot of states."""
        count = self.count - first if count is None else count
        q = numpy.empty((count, self.position_count))
        qdot = numpy.empty((count, self.velocity_count))
        self._check(lib.se3d_batch_get_state(self.pointer, first, count,
                                             ffi.from_buffer("double[]", q),
                                             ffi.from_buffer("double[]", qdot)))
        return q, qdot

    def set(self, q=None, qdot=None, first=0):
        """Set states from `first` on, which go on from there even if they had failed."""
        if q is not None:
            array, count = self._rows(q, self.position_count, "q")
            self._check(lib.se3d_batch_set_state(self.pointer, first, count, array, ffi.NULL))
        if qdot is not None:
            array, count = self._rows(qdot, self.velocity_count, "qdot")
            self._check(lib.se3d_batch_set_state(self.pointer, first, count, ffi.NULL, array))

    @property
    def time(self):
        """The times of all states."""
        out = numpy.empty(self.count)
        self._check(lib.se3d_batch_get_time(self.pointer, 0, self.count,
                                            ffi.from_buffer("double[]", out)))
        return out

    @time.setter
    def time(self, values):
        self._set(lib.se3d_batch_set_time, numpy.broadcast_to(values, self.count), 1, "time", 0)

    @property
    def status(self):
        """Statuses of all states, 0: it has not failed."""
        out = numpy.empty(self.count, dtype=numpy.int32)
        self._check(lib.se3d_batch_get_status(self.pointer, 0, self.count,
                                              ffi.from_buffer("int32_t[]", out)))
        return out

    def set_efforts(self, effort, first=0):
        """Set what acts along the coordinates of states from `first` on."""
        self._set(lib.se3d_batch_set_efforts, effort, self.velocity_count, "effort", first)

    def set_gravity(self, gravity, first=0):
        """Set the gravity of states from `first` on."""
        self._set(lib.se3d_batch_set_gravity, gravity, 3, "gravity", first)

    def set_mass(self, body, mass, inertia, first=0):
        """Set a body's mass and inertia (xx, yy, zz, xy, yz, xz) in states from `first` on."""
        masses, count = self._rows(mass, 1, "mass")
        inertias = pointer(numpy.ascontiguousarray(inertia, dtype=float), "inertia", 6 * count)
        self._check(lib.se3d_batch_set_mass(self.pointer, body.handle[0], first, count, masses,
                                            inertias))

    def step(self, h, steps=1, method="rk4"):
        """Take equal steps (rk4, rk45, dop853) with all states that have not failed."""
        return self._check(lib.se3d_batch_step(self.pointer, method_number(method), h, steps))

    def accelerations(self):
        """Return qddot of all states."""
        out = numpy.empty((self.count, self.velocity_count))
        self._check(lib.se3d_batch_compute_accelerations(self.pointer,
                                                         ffi.from_buffer("double[]", out)))
        return out

    def efforts(self, qddot=None):
        """Return the efforts that give accelerations (None: zero): inverse dynamics."""
        out = numpy.empty((self.count, self.velocity_count))
        wanted = ffi.NULL
        if qddot is not None:
            wanted = pointer(numpy.ascontiguousarray(qddot, dtype=float), "qddot", out.size)
        self._check(lib.se3d_batch_compute_efforts(self.pointer, wanted,
                                                   ffi.from_buffer("double[]", out)))
        return out
