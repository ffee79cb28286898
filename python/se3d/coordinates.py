# SPDX-License-Identifier: BSD-3-Clause
"""Joint coordinates of a system: accelerations, efforts, matrices without a step."""

import numpy

from se3d._library import check, ffi, lib, pointer


class Coordinates:
    """A spanning tree of a system's joints; se3d/coordinates.h tells what the numbers are. It is
    for the present structure of the system."""

    def __init__(self, system):
        self.system = system
        out = ffi.new("se3d_coordinates **")
        check(lib.se3d_coordinates_create(system.pointer, out), system.pointer)
        self.pointer = ffi.gc(out[0], lib.se3d_coordinates_destroy)
        self.count = lib.se3d_coordinates_count(self.pointer)
        self.position_count = lib.se3d_coordinates_count_positions(self.pointer)

    def _check(self, status):
        return check(status, self.system.pointer)

    def _input(self, values, count, what):
        if values is None:
            return ffi.NULL
        return pointer(numpy.ascontiguousarray(values, dtype=float), what, count)

    def get(self):
        """Return q and qdot of the present state."""
        q, qdot = numpy.empty(self.position_count), numpy.empty(self.count)
        self._check(lib.se3d_coordinates_get(self.pointer, ffi.from_buffer("double[]", q),
                                             ffi.from_buffer("double[]", qdot)))
        return q, qdot

    def set(self, q=None, qdot=None):
        """Set the state of all bodies from coordinates."""
        self._check(lib.se3d_coordinates_set(
            self.pointer, self._input(q, self.position_count, "q"),
            self._input(qdot, self.count, "qdot")))

    def _compute(self, function, shape, *arguments):
        out = numpy.empty(shape)
        self._check(function(self.pointer, *arguments, ffi.from_buffer("double[]", out)))
        return out

    def accelerations(self, effort=None):
        """Return qddot under the forces of all elements and `effort` along the coordinates."""
        return self._compute(lib.se3d_coordinates_compute_accelerations, self.count,
                             self._input(effort, self.count, "effort"))

    def efforts(self, qddot=None):
        """Return the efforts that give accelerations: inverse dynamics of the tree."""
        return self._compute(lib.se3d_coordinates_compute_efforts, self.count,
                             self._input(qddot, self.count, "qddot"))

    def gravity(self):
        """Return the efforts that hold the weights."""
        return self._compute(lib.se3d_coordinates_compute_gravity, self.count)

    def mass_matrix(self):
        """Return M of M qddot + h = effort."""
        return self._compute(lib.se3d_coordinates_compute_mass_matrix, (self.count, self.count))

    def jacobian(self, marker):
        """Return J [6, velocities] of a marker: angular velocity, velocity; ground frame."""
        J = numpy.empty((6, self.count))
        self._check(lib.se3d_coordinates_compute_jacobian(
            self.pointer, marker.handle[0], ffi.from_buffer("double[]", J), ffi.NULL))
        return J
