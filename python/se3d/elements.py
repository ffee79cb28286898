# SPDX-License-Identifier: BSD-3-Clause
"""The parts of a system."""

import numpy

from se3d._library import (COORDINATES, FORMULATIONS, PARAMETERS, Element, ffi, lib, vector,
                           word)


class Body(Element):
    """A rigid body. Positions are of the centre of mass in the ground frame [m], orientations Euler
    parameters (scalar first), angular velocities in the body frame [rad/s]."""

    kind = "se3d_body"
    __slots__ = ()

    def _set(self, function, values, count, what):
        self._call(function, vector(values, count, what))

    @property
    def position(self):
        """Centre of mass, ground frame [m]."""
        return self._vector(lib.se3d_body_get_position, 3)

    @position.setter
    def position(self, value):
        self._set(lib.se3d_body_set_position, value, 3, "position")

    @property
    def orientation(self):
        """Euler parameters, body to ground, scalar first."""
        return self._vector(lib.se3d_body_get_orientation, 4)

    @orientation.setter
    def orientation(self, value):
        self._set(lib.se3d_body_set_orientation, value, 4, "orientation")

    @property
    def velocity(self):
        """Of the centre of mass, ground frame [m/s]."""
        return self._vector(lib.se3d_body_get_velocity, 3)

    @velocity.setter
    def velocity(self, value):
        self._set(lib.se3d_body_set_velocity, value, 3, "velocity")

    @property
    def angular_velocity(self):
        """Body frame [rad/s]."""
        return self._vector(lib.se3d_body_get_angular_velocity, 3)

    @angular_velocity.setter
    def angular_velocity(self, value):
        self._set(lib.se3d_body_set_angular_velocity, value, 3, "angular_velocity")

    @property
    def acceleration(self):
        """Of the centre of mass, by the last analysis, ground frame [m/s^2]."""
        return self._vector(lib.se3d_body_get_acceleration, 3)

    @property
    def angular_acceleration(self):
        """By the last analysis, body frame [rad/s^2]."""
        return self._vector(lib.se3d_body_get_angular_acceleration, 3)

    @property
    def mass(self):
        """[kg]; 0 for a fixed body."""
        return self._mass()[0]

    @property
    def inertia(self):
        """About the centre of mass, body frame [kg m^2]: xx yy zz xy yz xz."""
        return self._mass()[1]

    def _mass(self):
        mass, inertia = ffi.new("double *"), numpy.empty(6)
        self._call(lib.se3d_body_get_mass, mass, ffi.from_buffer("double[]", inertia))
        return mass[0], inertia

    def set_mass(self, mass, inertia):
        """Set mass [kg] and inertia [kg m^2] (xx yy zz xy yz xz, or the three moments)."""
        self._call(lib.se3d_body_set_mass, mass, inertia_of(inertia))

    @property
    def held(self):
        """Whether the assembly keeps its pose and velocity."""
        value = ffi.new("int32_t *")
        self._call(lib.se3d_body_get_held, value)
        return bool(value[0])

    @held.setter
    def held(self, value):
        self._call(lib.se3d_body_set_held, int(bool(value)))

    def point(self, local):
        """Map a point of the body frame to the ground frame [m]."""
        ground = numpy.empty(3)
        self._call(lib.se3d_body_get_point, vector(local, 3, "local"),
                   ffi.from_buffer("double[]", ground))
        return ground

    @property
    def contact_wrench(self):
        """Force [N] and torque [N m] of all contacts of the last step."""
        force, torque = numpy.empty(3), numpy.empty(3)
        self._call(lib.se3d_body_get_contact_wrench, ffi.from_buffer("double[]", force),
                   ffi.from_buffer("double[]", torque))
        return force, torque


class Marker(Element):
    """A point with a frame on a body."""

    kind = "se3d_marker"
    __slots__ = ()

    @property
    def position(self):
        """Of its origin, ground frame [m]."""
        return self._vector(lib.se3d_marker_get_position, 3)

    @property
    def velocity(self):
        """Of its origin, ground frame [m/s]."""
        return self._vector(lib.se3d_marker_get_velocity, 3)

    @property
    def acceleration(self):
        """Of its origin, by the last analysis, ground frame [m/s^2]."""
        return self._vector(lib.se3d_marker_get_acceleration, 3)

    @property
    def orientation(self):
        """Euler parameters, marker to ground, scalar first."""
        return self._vector(lib.se3d_marker_get_orientation, 4)


class Constraint(Element):
    """A joint, driver, coupler, primitive or user-defined constraint."""

    kind = "se3d_constraint"
    __slots__ = ()

    @property
    def type(self):
        """ "revolute", "driver", "dp1", ... as in a model file."""
        return self._text(lib.se3d_constraint_get_type)

    def _coordinate(self, name):
        values = [ffi.new("double *") for _ in range(3)]
        self._call(lib.se3d_joint_get_coordinate, COORDINATES[name], *values)
        return tuple(value[0] for value in values)

    @property
    def angle(self):
        """Angle [rad], counts turns."""
        return self._coordinate("angle")[0]

    @property
    def angle_rate(self):
        """[rad/s]"""
        return self._coordinate("angle")[1]

    @property
    def angle_acceleration(self):
        """By the last analysis [rad/s^2]."""
        return self._coordinate("angle")[2]

    @property
    def displacement(self):
        """Displacement [m]."""
        return self._coordinate("displacement")[0]

    @property
    def displacement_rate(self):
        """[m/s]"""
        return self._coordinate("displacement")[1]

    @property
    def displacement_acceleration(self):
        """By the last analysis [m/s^2]."""
        return self._coordinate("displacement")[2]

    @property
    def reaction(self):
        """Force [N] and torque [N m] on body j at its joint point, of the last analysis, ground
        frame."""
        force, torque = numpy.empty(3), numpy.empty(3)
        self._call(lib.se3d_constraint_get_reaction, ffi.from_buffer("double[]", force),
                   ffi.from_buffer("double[]", torque))
        return force, torque

    @property
    def effort(self):
        """What a driver or a constraint of one equation does, of the last analysis [N m or N]."""
        return self._number(lib.se3d_driver_get_effort)

    @property
    def value(self):
        """The value that a driver or a constraint of one equation prescribes now."""
        return self._number(lib.se3d_driver_get_value)

    @value.setter
    def value(self, value):
        self._call(lib.se3d_constraint_set_value, value)

    @property
    def equation_count(self):
        """Scalar equations."""
        count = ffi.new("size_t *")
        self._call(lib.se3d_constraint_count_equations, count)
        return count[0]

    @property
    def bodies(self):
        """The bodies that take part: i, j, ..."""
        count = ffi.new("size_t *")
        self._call(lib.se3d_constraint_count_bodies, count)
        found = []
        for slot in range(count[0]):
            handle = ffi.new("se3d_body *")
            self._call(lib.se3d_constraint_get_body, slot, handle)
            found.append(Body(self.system, handle))
        return found

    @property
    def multipliers(self):
        """Lagrange multipliers of the last analysis."""
        return self._vector(lib.se3d_constraint_get_multipliers, self.equation_count)

    def evaluate(self, formulation="romega"):
        """Return Phi, nu and gamma at the present state."""
        values = [numpy.empty(self.equation_count) for _ in range(3)]
        self._call(lib.se3d_constraint_eval, word(FORMULATIONS, formulation, "formulation"),
                   *[ffi.from_buffer("double[]", value) for value in values])
        return tuple(values)

    def jacobian(self, slot, formulation="romega"):
        """Return d Phi/d r [equations, 3] and d Phi/d p [equations, 4] (rp) or with respect to the
        virtual rotation [equations, 3] (romega) of the body in a slot, 0 for i, 1 for j."""
        rows = self.equation_count
        turn = 4 if formulation == "rp" else 3
        phi_r, phi_rotation = numpy.empty((rows, 3)), numpy.empty((rows, turn))
        self._call(lib.se3d_constraint_eval_jacobian,
                   word(FORMULATIONS, formulation, "formulation"), slot,
                   ffi.from_buffer("double[]", phi_r), ffi.from_buffer("double[]", phi_rotation))
        return phi_r, phi_rotation


class Force(Element):
    """A force element."""

    kind = "se3d_force"
    __slots__ = ()

    @property
    def type(self):
        """ "tsda", "rsda", "force", ... as in a model file."""
        return self._text(lib.se3d_force_get_type)

    def wrench(self, side):
        """Force [N] and torque about the centre of mass [N m] on body i (0) or j (1), ground
        frame."""
        values = numpy.empty(6)
        self._call(lib.se3d_force_get_wrench, side, ffi.from_buffer("double[]", values))
        return values[:3], values[3:]

    def _state(self):
        values = [ffi.new("double *") for _ in range(3)]
        self._call(lib.se3d_force_get_state, *values)
        return tuple(value[0] for value in values)

    @property
    def coordinate(self):
        """Length, displacement [m] or angle [rad]."""
        return self._state()[0]

    @property
    def rate(self):
        """Of the coordinate [m/s, rad/s]."""
        return self._state()[1]

    @property
    def force(self):
        """What acts against the coordinate, of an effort along it [N, N m]."""
        return self._state()[2]

    @property
    def value(self):
        """The value of an effort [N m, N], or the components of a force or torque."""
        if self.type == "effort":
            return self._number(lib.se3d_effort_get)
        return self._vector(lib.se3d_force_get_value, 3)

    @value.setter
    def value(self, value):
        if numpy.ndim(value) == 0:
            self._call(lib.se3d_effort_set, value)
        else:
            self._call(lib.se3d_force_set_value, vector(value, 3, "value"))

    def get(self, parameter):
        """Return "k", "c", "rest", "preload", "mu", ... of a tsda, rsda, stop or friction."""
        return self._number(lib.se3d_force_get_parameter, word(PARAMETERS, parameter, "parameter"))

    def set(self, parameter, value):
        """Set "k", "c", "rest", "preload", "mu", ... between steps."""
        self._call(lib.se3d_force_set_parameter, word(PARAMETERS, parameter, "parameter"), value)

    @property
    def power(self):
        """Stored energy [J], dissipated power [W] and power that is fed in [W]."""
        values = [ffi.new("double *") for _ in range(3)]
        self._call(lib.se3d_force_get_power, *values)
        return tuple(value[0] for value in values)


class Function(Element):
    """A function of time, or of the variables of a force element."""

    kind = "se3d_function"
    __slots__ = ()
    name = ""

    def __call__(self, *x):
        jet = numpy.empty(3)
        self._call(lib.se3d_function_eval, ffi.new("double[]", list(x) or [0.0]),
                   ffi.from_buffer("double[]", jet))
        return jet

    def set_constant(self, value):
        """Change the value of a constant between steps."""
        self._call(lib.se3d_function_set_constant, value)


class Material(Element):
    """What shapes and particles are made of."""

    kind = "se3d_material"
    __slots__ = ()


class Shape(Element):
    """A shape on a body, for contact."""

    kind = "se3d_shape"
    __slots__ = ()

    @property
    def wrench(self):
        """Force [N] and torque [N m] of all contacts of the last step."""
        force, torque = numpy.empty(3), numpy.empty(3)
        self._call(lib.se3d_shape_get_wrench, ffi.from_buffer("double[]", force),
                   ffi.from_buffer("double[]", torque))
        return force, torque

    def nearest(self, position):
        """Return the nearest point of the surface, the normal there and the signed distance."""
        point, normal, distance = numpy.empty(3), numpy.empty(3), ffi.new("double *")
        self._call(lib.se3d_shape_get_nearest, vector(position, 3, "position"),
                   ffi.from_buffer("double[]", point), ffi.from_buffer("double[]", normal),
                   distance)
        return point, normal, distance[0]


def inertia_of(value):
    """Return xx yy zz xy yz xz from them, from three moments, or from a matrix."""
    array = numpy.asarray(value, dtype=float)
    if array.shape == (3, 3):
        array = array[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    elif array.shape == (3,):
        array = numpy.concatenate([array, numpy.zeros(3)])
    return vector(array, 6, "inertia")
