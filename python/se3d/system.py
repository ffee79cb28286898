# SPDX-License-Identifier: BSD-3-Clause
"""A system: its elements, its state, its energies."""

import os
from collections import namedtuple

import numpy

from se3d._library import Definition, check, failure, ffi, lib, pointer, text, vector
from se3d.elements import (Body, Constraint, Force, Function, Marker, Material, Shape, inertia_of)
from se3d.page import escape, show

Energy = namedtuple("Energy", "kinetic potential total dissipated")
Work = namedtuple("Work", "dissipated actuators drivers")
State = namedtuple("State", "r p v w")
Summary = namedtuple("Summary", "bodies equations rank redundant freedoms gruebler inconsistent")
Contact = namedtuple("Contact", "shape_i shape_j point normal overlap force")


def _types_of(beginning, definition):
    """What the library creates by functions of that beginning from a definition."""
    pointer_type = ffi.typeof(f"{definition} *")
    return tuple(name[len(beginning):] for name in dir(lib) if name.startswith(beginning) and
                 ffi.typeof(getattr(lib, name)).args[1] is pointer_type)


JOINTS = _types_of("se3d_joint_create_", "se3d_joint_def")
SHAPES = _types_of("se3d_shape_create_", "se3d_shape_def")

# The variables of functions of force elements; all others are functions of the time.
_VARIABLES = {
    ("se3d_tsda_def", "h"): ("t", "l", "ldot"),
    ("se3d_tsda_def", "spring"): ("x",),
    ("se3d_tsda_def", "damper"): ("v",),
    ("se3d_rsda_def", "h"): ("t", "theta", "thetadot"),
    ("se3d_rsda_def", "spring"): ("x",),
    ("se3d_rsda_def", "damper"): ("v",),
    ("se3d_effort_def", "function"): ("t", "q", "qdot"),
}


class System:
    """A model with its state.

    Definitions are given by keywords, with the names and units of the C headers: `system.body(
    mass=1, inertia=(1, 1, 1), position=(0, 0, 1))`. Where a function is asked for, an expression in
    a text, a number, or a callable that returns (value, first derivative, second derivative) stand
    for it. Use it in a `with` block, or close it.
    """

    def __init__(self, *, gravity=(0.0, 0.0, -9.81), time=0.0, log=None, _pointer=None,
                 _owner=None):
        self._owner = _owner
        self._kept = []  # what callbacks need
        if _pointer is None:
            definition = Definition("se3d_system_def", {"gravity": gravity, "time": time})
            if log:
                definition.pointer.log = lib.se3d_python_log
                definition.pointer.log_ctx = self._keep(log)
            out = ffi.new("se3d_system **")
            check(lib.se3d_system_create(definition.pointer, out))
            _pointer = out[0]
        self.pointer = _pointer

    def close(self):
        """Destroy the system with its elements."""
        if self.pointer and self._owner is None:
            lib.se3d_system_destroy(self.pointer)
        self.pointer = ffi.NULL

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "pointer", None):
            self.close()

    def _keep(self, what):
        handle = ffi.new_handle(what)
        self._kept.append((handle, what))
        return handle

    def check(self, status):
        """Raise Error if a status is a failure; return it."""
        return check(status, self.pointer)

    @staticmethod
    def variables_of(kind, name):
        """Tell what a function of a definition depends on."""
        return {"variables": _VARIABLES.get((kind, name), ("t",))}

    def _make(self, cls, create, kind, values):
        definition = Definition(kind, values, self)
        handle = ffi.new(f"{cls.kind} *")
        self.check(create(self.pointer, definition.pointer, handle))
        return cls(self, handle)

    # ---- elements ----

    @property
    def ground(self):
        """The immovable body."""
        handle = ffi.new("se3d_body *")
        self.check(lib.se3d_system_get_ground(self.pointer, handle))
        return Body(self, handle)

    def body(self, *, inertia=None, **values):
        """Create a body: name, mass, inertia (xx yy zz xy yz xz, three moments or a matrix),
        position, orientation, velocity, angular_velocity, fixed."""
        if inertia is not None:
            values["inertia"] = list(inertia_of(inertia))
        return self._make(Body, lib.se3d_body_create, "se3d_body_def", values)

    def marker(self, **values):
        """Create a marker: name, body, position, orientation."""
        return self._make(Marker, lib.se3d_marker_create, "se3d_marker_def", values)

    def joint(self, type, body_i, body_j, *, at=None, axis=None, ref=None, **values):
        """Create a joint: by a point `at` and an `axis` in the ground frame at the present poses,
        or by point_i, point_j, axis_i, axis_j in the frames of the bodies."""
        definition = Definition("se3d_joint_def", {"body_i": body_i, "body_j": body_j, **values},
                                self)
        if type not in JOINTS:
            raise ValueError(f"type is {type!r}, must be one of {', '.join(JOINTS)}")
        if at is not None or axis is not None or ref is not None:
            self.check(lib.se3d_joint_def_set_frame(
                self.pointer, definition.pointer, vector((0, 0, 0) if at is None else at, 3, "at"),
                vector((0, 0, 1) if axis is None else axis, 3, "axis"),
                ffi.NULL if ref is None else vector(ref, 3, "ref")))
        handle = ffi.new("se3d_constraint *")
        self.check(getattr(lib, f"se3d_joint_create_{type}")(self.pointer, definition.pointer,
                                                             handle))
        return Constraint(self, handle)

    def driver(self, joint, coordinate="angle", function=None, **values):
        """Create a driver of a joint coordinate, "angle" or "displacement"."""
        values.update(joint=joint, coordinate=coordinate, function=function)
        return self._make(Constraint, lib.se3d_driver_create, "se3d_driver_def", values)

    def coupler(self, terms, *, value=0.0, function=None, name=None):
        """Create a linear relation of joint coordinates: terms are (joint, coordinate, ratio)."""
        joints, coordinates, ratios = zip(*terms)
        definition = Definition("se3d_coupler_def", {
            "joint": joints, "coordinate": coordinates, "value": value, "function": function,
            "name": name, "count": len(terms)}, self)
        for k, ratio in enumerate(ratios):
            definition.pointer.ratio[k] = ratio
        handle = ffi.new("se3d_constraint *")
        self.check(lib.se3d_joint_create_coupler(self.pointer, definition.pointer, handle))
        return Constraint(self, handle)

    def gear(self, joint_1, joint_2, ratio, *, name=None):
        """Create a pair of gears."""
        return self._couple(lib.se3d_joint_create_gear, joint_1, joint_2, ratio, name)

    def rack_pinion(self, pinion, rack, radius, *, name=None):
        """Create a rack and pinion."""
        return self._couple(lib.se3d_joint_create_rack_pinion, pinion, rack, radius, name)

    def _couple(self, create, joint_1, joint_2, number, name):
        handle = ffi.new("se3d_constraint *")
        title = ffi.NULL if name is None else ffi.new("char[]", name.encode())
        self.check(create(self.pointer, title, joint_1.handle[0], joint_2.handle[0], number,
                          handle))
        return Constraint(self, handle)

    def primitive(self, type, body_i, body_j, **values):
        """Create a constraint of one primitive: "dp1", "dp2", "d" or "cd"."""
        values.update(type=type, body_i=body_i, body_j=body_j)
        return self._make(Constraint, lib.se3d_primitive_create, "se3d_primitive_def", values)

    def user_constraint(self, call, bodies, equations=1, *, name=None):
        """Create a constraint from call(time, *motions) -> (phi, jacobian, nu, gamma), with the
        meanings of se3d_constraint_callback."""
        definition = Definition("se3d_user_constraint_def", {
            "name": name, "bodies": bodies, "body_count": len(bodies),
            "equation_count": equations}, self)
        definition.pointer.callback = lib.se3d_python_constraint
        definition.pointer.ctx = self._keep((call, len(bodies), equations))
        handle = ffi.new("se3d_constraint *")
        self.check(lib.se3d_user_constraint_create(self.pointer, definition.pointer, handle))
        return Constraint(self, handle)

    def _force(self, create, kind, values):
        return self._make(Force, create, kind, values)

    def tsda(self, body_i, body_j, **values):
        """Create a spring-damper between two points: k, c, l0, h(t, l, ldot), ..."""
        values.update(body_i=body_i, body_j=body_j)
        return self._force(lib.se3d_force_create_tsda, "se3d_tsda_def", values)

    def rsda(self, joint=None, **values):
        """Create a rotational spring-damper on a joint: k, c, theta0, h(t, theta, thetadot), ..."""
        return self._force(lib.se3d_force_create_rsda, "se3d_rsda_def", dict(values, joint=joint))

    def force(self, body, value=(0.0, 0.0, 0.0), **values):
        """Create a force at a point of a body: components, or function (three of them)."""
        values.update(body=body, value=value)
        return self._force(lib.se3d_force_create_load, "se3d_load_def", values)

    def torque(self, body, value=(0.0, 0.0, 0.0), **values):
        """Create a torque on a body."""
        values.update(body=body, value=value)
        return self._force(lib.se3d_force_create_torque, "se3d_load_def", values)

    def bushing(self, body_i, body_j, **values):
        """Create an elastic connection of two frames: K and C are 6 x 6, or their diagonals."""
        for name in ("K", "C"):
            if name in values and numpy.size(values[name]) == 6:
                values[name] = numpy.diag(numpy.asarray(values[name], dtype=float).reshape(6))
        values.update(body_i=body_i, body_j=body_j)
        return self._force(lib.se3d_force_create_bushing, "se3d_bushing_def", values)

    def friction(self, joint, coordinate="angle", **values):
        """Create friction on a joint coordinate: mu, mu_static, radius, limit, viscous, ..."""
        values.update(joint=joint, coordinate=coordinate)
        return self._force(lib.se3d_force_create_friction, "se3d_friction_def", values)

    def stop(self, joint=None, coordinate="angle", **values):
        """Create a stop at the ends of a range: lower, upper, k, restitution."""
        values.update(joint=joint, coordinate=coordinate)
        return self._force(lib.se3d_force_create_stop, "se3d_stop_def", values)

    def effort(self, joint, coordinate="angle", **values):
        """Create an effort along a joint coordinate: value, or function of (t, q, qdot)."""
        values.update(joint=joint, coordinate=coordinate)
        return self._force(lib.se3d_force_create_effort, "se3d_effort_def", values)

    def armature(self, joint, coordinate="angle", **values):
        """Create an armature on a joint coordinate: inertia."""
        values.update(joint=joint, coordinate=coordinate)
        return self._force(lib.se3d_force_create_armature, "se3d_armature_def", values)

    def force_callback(self, call, body_i, body_j, *, name=None, has_jacobian=False, energy=None):
        """Create an element from call(time, motion_i, motion_j) -> 12 numbers: force (ground
        frame) and torque (body frame) on i and on j. With has_jacobian it gets K and D, arrays of
        12 x 12 or None, to fill. energy(time, motion_i, motion_j) gives the energy that it stores
        [J], or that and the power that it dissipates [W]; without it all is work of an actuator.
        They must be pure functions: call touch() if they change."""
        definition = Definition("se3d_force_callback_def", {
            "name": name, "body_i": body_i, "body_j": body_j, "has_jacobian": has_jacobian}, self)
        definition.pointer.callback = lib.se3d_python_force
        definition.pointer.ctx = self._keep((call, has_jacobian, energy))
        if energy:
            definition.pointer.energy = lib.se3d_python_energy
        handle = ffi.new("se3d_force *")
        self.check(lib.se3d_force_create_callback(self.pointer, definition.pointer, handle))
        return Force(self, handle)

    def function(self, what, *, variables=("t",)):
        """Create a function: a text (expression of the variables), a number, a pair of arrays (a
        cubic spline through a table), or a callable of the variables that returns (value, first
        and second derivative with respect to the first one, gradient if there are several)."""
        definition = Definition("se3d_function_def", {})
        d = definition.pointer
        names = [definition.keep(ffi.new("char[]", name.encode())) for name in variables]
        d.variables = definition.keep(ffi.new("char const *[]", names))
        d.variable_count = len(names)
        if isinstance(what, str):
            d.expression = definition.keep(ffi.new("char[]", what.encode()))
        elif callable(what):
            d.callback = lib.se3d_python_function
            d.ctx = self._keep((what, len(names)))
        elif numpy.ndim(what) == 0:
            d.constant = what
        else:
            x, y = (definition.keep(ffi.new("double[]", list(map(float, axis)))) for axis in what)
            if len(x) != len(y):
                raise ValueError(f"the table has {len(x)} places and {len(y)} values")
            d.table_x, d.table_y, d.table_count = x, y, len(x)
        handle = ffi.new("se3d_function *")
        self.check(lib.se3d_function_create(self.pointer, d, handle))
        return Function(self, handle)

    def material(self, **values):
        """Create a material: density, friction, restitution, stiffness, young, ..."""
        return self._make(Material, lib.se3d_material_create, "se3d_material_def", values)

    def contact(self, **values):
        """Set the law of contact: law ("hooke", "hertz_mindlin"), step, overlap_limit."""
        definition = Definition("se3d_contact_settings", values, self)
        self.check(lib.se3d_system_set_contact(self.pointer, definition.pointer))

    def shape(self, type, *, vertices=None, triangles=None, heights=None, **values):
        """Create a shape, one of SHAPES: body, material, position, orientation, normal, size,
        radius, length, semi_axes, bottom_radius, top_radius, vertices, triangles; heights (rows along x) and
        their spacing."""
        if type not in SHAPES:
            raise ValueError(f"type is {type!r}, must be one of {', '.join(SHAPES)}")
        definition = Definition("se3d_shape_def", values, self)
        if vertices is not None:
            array = definition.keep(numpy.ascontiguousarray(vertices, dtype=float))
            definition.pointer.vertices = definition.keep(ffi.from_buffer("double[]", array))
            definition.pointer.vertex_count = array.size // 3
        if triangles is not None:
            array = definition.keep(numpy.ascontiguousarray(triangles, dtype=numpy.uint32))
            definition.pointer.triangles = definition.keep(ffi.from_buffer("uint32_t[]", array))
            definition.pointer.triangle_count = array.size // 3
        if heights is not None:
            array = definition.keep(numpy.ascontiguousarray(heights, dtype=float))
            definition.pointer.heights = definition.keep(ffi.from_buffer("double[]", array))
            definition.pointer.row_count, definition.pointer.column_count = array.shape
        handle = ffi.new("se3d_shape *")
        self.check(getattr(lib, f"se3d_shape_create_{type}")(self.pointer, definition.pointer,
                                                             handle))
        return Shape(self, handle)

    # ---- what is there ----

    def _all(self, cls, noun, count):
        found = []
        for k in range(count(self.pointer)):
            handle = ffi.new(f"{cls.kind} *")
            self.check(getattr(lib, f"se3d_system_get_{noun}")(self.pointer, k, handle))
            found.append(cls(self, handle))
        return found

    @property
    def bodies(self):
        """All bodies, the ground first."""
        return self._all(Body, "body", lib.se3d_system_count_bodies)

    @property
    def markers(self):
        """All markers."""
        return self._all(Marker, "marker", lib.se3d_system_count_markers)

    @property
    def constraints(self):
        """Joints, drivers, couplers, primitives and user-defined constraints."""
        return self._all(Constraint, "constraint", lib.se3d_system_count_constraints)

    @property
    def forces(self):
        """All force elements."""
        return self._all(Force, "force", lib.se3d_system_count_forces)

    def _find(self, cls, name):
        handle = ffi.new(f"{cls.kind} *")
        self.check(getattr(lib, f"{cls.kind}_find")(self.pointer, name.encode(), handle))
        return cls(self, handle)

    def find_body(self, name):
        """Find a body by its name."""
        return self._find(Body, name)

    def find_constraint(self, name):
        """Find a joint, driver or another constraint by its name."""
        return self._find(Constraint, name)

    def find_force(self, name):
        """Find a force element by its name."""
        return self._find(Force, name)

    def find_material(self, name):
        """Find a material by its name."""
        return self._find(Material, name)

    def find_shape(self, name):
        """Find a shape by its name."""
        return self._find(Shape, name)

    # ---- state ----

    @property
    def time(self):
        """[s]"""
        value = ffi.new("double *")
        self.check(lib.se3d_system_get_time(self.pointer, value))
        return value[0]

    @time.setter
    def time(self, value):
        self.check(lib.se3d_system_set_time(self.pointer, value))

    @property
    def gravity(self):
        """Ground frame [m/s^2]."""
        value = numpy.empty(3)
        self.check(lib.se3d_system_get_gravity(self.pointer, ffi.from_buffer("double[]", value)))
        return value

    @gravity.setter
    def gravity(self, value):
        self.check(lib.se3d_system_set_gravity(self.pointer, vector(value, 3, "gravity")))

    def get_state(self, out=None):
        """Return r [n, 3], p [n, 4], v [n, 3], w [n, 3] of all bodies, the ground first; `out`, a
        State of an earlier call, is filled in place."""
        count = lib.se3d_system_count_bodies(self.pointer)
        if out is None:
            out = State(*[numpy.empty((count, width)) for width in (3, 4, 3, 3)])
        self.check(lib.se3d_body_get_all(self.pointer, count, *self._columns(out, count)))
        return out

    def set_state(self, r=None, p=None, v=None, w=None):
        """Set what is given for all bodies; the ground and fixed bodies are skipped."""
        count = lib.se3d_system_count_bodies(self.pointer)
        arrays = [None if a is None else numpy.ascontiguousarray(a, dtype=float)
                  for a in (r, p, v, w)]
        self.check(lib.se3d_body_set_all(self.pointer, count, *self._columns(arrays, count)))

    @staticmethod
    def _columns(arrays, count):
        return [ffi.NULL if array is None else pointer(array, name, count * width)
                for array, name, width in zip(arrays, "rpvw", (3, 4, 3, 3))]

    @property
    def efforts(self):
        """The values of all efforts, in the order of creation [N m, N]."""
        return numpy.array([force.value for force in self.forces if force.type == "effort"])

    @efforts.setter
    def efforts(self, values):
        array = numpy.ascontiguousarray(values, dtype=float)
        self.check(lib.se3d_effort_set_all(self.pointer, array.size,
                                           ffi.from_buffer("double[]", array)))

    def touch(self):
        """Say that what callbacks compute has changed since the last step."""
        self.check(lib.se3d_system_touch(self.pointer))

    @property
    def energy(self):
        """Kinetic, potential, total, and dissipated since the start of the run [J]."""
        value = ffi.new("se3d_energy *")
        self.check(lib.se3d_system_get_energy_sized(self.pointer, value, ffi.sizeof(value[0])))
        return Energy(value.kinetic, value.potential, value.total, value.dissipated)

    @property
    def work(self):
        """Dissipated, by actuators, by drivers since the start of the run [J]."""
        value = ffi.new("se3d_work *")
        self.check(lib.se3d_system_get_work_sized(self.pointer, value, ffi.sizeof(value[0])))
        return Work(value.dissipated, value.actuators, value.drivers)

    @property
    def violation(self):
        """The largest violations of positions, velocities and accelerations."""
        value = numpy.empty(3)
        self.check(lib.se3d_system_get_violation(self.pointer, ffi.from_buffer("double[]", value)))
        return value

    def hash(self):
        """Equal bits of the state, equal hash."""
        return lib.se3d_system_hash(self.pointer)

    @property
    def contacts(self):
        """The points where bodies touch."""
        count = lib.se3d_system_count_contacts(self.pointer)
        if count == 0:
            return []
        found = ffi.new("se3d_contact[]", count)
        self.check(lib.se3d_system_get_contacts_sized(self.pointer, count, found,
                                                      ffi.sizeof("se3d_contact")))
        return [Contact(Shape(self, ffi.new("se3d_shape *", c.shape_i)),
                        Shape(self, ffi.new("se3d_shape *", c.shape_j)), numpy.array(list(c.point)),
                        numpy.array(list(c.normal)), c.overlap, numpy.array(list(c.force)))
                for c in found]

    def clone(self):
        """Return an independent copy. Callbacks are shared; elements are found by their names or
        by element_of."""
        out = ffi.new("se3d_system **")
        self.check(lib.se3d_system_clone(self.pointer, out))
        copy = System(_pointer=out[0])
        copy._kept = list(self._kept)
        return copy

    def element_of(self, element):
        """Return what an element of a clone, or of what this was cloned from, is here."""
        return type(element)(self, element.handle)

    def snapshot(self):
        """Save the state."""
        out = ffi.new("se3d_snapshot **")
        self.check(lib.se3d_snapshot_create(self.pointer, out))
        return ffi.gc(out[0], lib.se3d_snapshot_destroy)

    def restore(self, snapshot):
        """Put a saved state back: what follows has the same bits."""
        self.check(lib.se3d_snapshot_restore(snapshot, self.pointer))

    def save(self):
        """Return the state as bytes, for another run of a program that builds the same system."""
        snapshot, size = self.snapshot(), ffi.new("size_t *")
        check(lib.se3d_snapshot_write(snapshot, ffi.NULL, 0, size))
        data = bytearray(size[0])
        check(lib.se3d_snapshot_write(snapshot, ffi.from_buffer(data), len(data), size))
        return bytes(data)

    def load(self, data):
        """Put back what `save` returned: what follows has the same bits."""
        out = ffi.new("se3d_snapshot **")
        self.check(lib.se3d_snapshot_read(self.pointer, data, len(data), out))
        self.restore(ffi.gc(out[0], lib.se3d_snapshot_destroy))

    def report(self):
        """Return counts and findings of the constraints: rank, redundant ones, contradictions."""
        out = ffi.new("se3d_check **")
        self.check(lib.se3d_check_create(self.pointer, out))
        found = ffi.gc(out[0], lib.se3d_check_destroy)
        summary = ffi.new("se3d_check_summary *")
        summary.struct_size = ffi.sizeof(summary[0])
        check(lib.se3d_check_get_summary(found, summary))
        messages = []
        for k in range(lib.se3d_check_count_messages(found)):
            message = ffi.new("char const **")
            check(lib.se3d_check_get_message(found, k, message))
            messages.append(text(message[0]))
        return Summary(*[getattr(summary, name) for name in Summary._fields]), messages

    def write(self, path, *, partial=False):
        """Write the system as a model file. partial: what a file cannot hold (callbacks) is left out,
        else it is an error."""
        options = Definition("se3d_write_options", {"partial": int(partial)})
        error = ffi.new("se3d_model_error *")
        status = lib.se3d_system_write(self.pointer, os.fsencode(path), options.pointer, error)
        if status < 0:
            raise failure(status, error)

    def _repr_html_(self):
        return show(lambda path: self.write(path, partial=True)) + self._get_table()

    def _get_table(self):
        """Return counts and poses as HTML."""
        rows = "".join(
            f"<tr><td>{escape(body.name)}</td><td>{body.mass:g}</td>"
            f"<td>{', '.join(f'{x:.4g}' for x in body.position)}</td></tr>"
            for body in self.bodies[1:])
        return (f"<p>{lib.se3d_system_count_bodies(self.pointer) - 1} bodies, "
                f"{lib.se3d_system_count_constraints(self.pointer)} constraints, "
                f"{lib.se3d_system_count_forces(self.pointer)} force elements, "
                f"t = {self.time:g} s</p><table><tr><th>body</th><th>mass [kg]</th>"
                f"<th>position [m]</th></tr>{rows}</table>")
