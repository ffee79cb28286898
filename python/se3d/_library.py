# SPDX-License-Identifier: BSD-3-Clause
"""What all classes share: statuses, definitions filled by keywords, callbacks."""

import threading

import numpy

from se3d._se3d import ffi, lib


class Error(Exception):
    """A call failed; the text is the library's message.

    status: the number of the status, such as se3d.STATUS["NO_CONVERGENCE"]; field: the argument
    that the call was about, "" if there is none.
    """

    def __init__(self, message, status, field=""):
        super().__init__(message)
        self.status = status
        self.field = field


class ModelError(Error):
    """A model file is malformed; line and column count from 1, 0 if there is none; mistakes: the
    messages of all that were found."""

    def __init__(self, message, status, line=0, column=0, mistakes=()):
        super().__init__(message, status)
        self.line = line
        self.column = column
        self.mistakes = tuple(mistakes)


def _names(prefix, enumeration):
    values = ffi.typeof(enumeration).relements
    return {name[len(prefix):].lower(): value for name, value in values.items()
            if name.startswith(prefix)}


STATUS = {name[5:]: value for name, value in ffi.typeof("se3d_status").relements.items()}
STATUS.update({name[4:]: value for name, value in STATUS.items() if name.startswith("ERR_")})

COORDINATES = _names("SE3D_JOINT_COORDINATE_", "se3d_joint_coordinate")
PARAMETERS = _names("SE3D_FORCE_PARAMETER_", "se3d_force_parameter")
FORMULATIONS = {"romega": lib.SE3D_FORMULATION_ROMEGA, "rp": lib.SE3D_FORMULATION_RP,
                "joint": lib.SE3D_FORMULATION_JOINT, "auto": lib.SE3D_FORMULATION_AUTO}

# Members of definitions that a name may stand for.
_WORDS = {
    "coordinate": COORDINATES,
    "analysis": _names("SE3D_ANALYSIS_", "se3d_analysis"),
    "formulation": FORMULATIONS,
    "method": _names("SE3D_METHOD_", "se3d_method"),
    "direction": {"falling": -1, "any": 0, "rising": 1},
    "action": _names("SE3D_EVENT_", "se3d_event_action"),
    "law": _names("SE3D_CONTACT_LAW_", "se3d_contact_law"),
    "type": _names("SE3D_PRIMITIVE_", "se3d_primitive_type"),
}

HANDLES = ("se3d_body", "se3d_marker", "se3d_function", "se3d_constraint", "se3d_force",
           "se3d_material", "se3d_shape", "se3d_event")


def text(pointer):
    """Return a text of the library."""
    return ffi.string(pointer).decode("utf-8", "replace") if pointer else ""


def word(words, value, what):
    """Return the number that a name stands for; a number stands for itself."""
    if not isinstance(value, str):
        return int(value)
    if value not in words:
        raise ValueError(f"{what} is {value!r}, must be one of {', '.join(sorted(words))}")
    return words[value]


def method_number(method):
    """Return the number of a method that is named."""
    return word(_WORDS["method"], method, "method")


def vector(values, count, what):
    """Return `count` numbers as an array of C."""
    array = numpy.ascontiguousarray(values, dtype=float).reshape(-1)
    if array.size != count:
        raise ValueError(f"{what} has {array.size} numbers, must have {count}")
    return ffi.new(f"double[{count}]", array.tolist())


def pointer(array, what, count=None):
    """Return the address of the numbers of an array that is contiguous, which is not copied."""
    if array.dtype != float or not array.flags.c_contiguous:
        raise ValueError(f"{what} must be a contiguous array of float64")
    if count is not None and array.size != count:
        raise ValueError(f"{what} has {array.size} numbers, must have {count}")
    return ffi.from_buffer("double[]", array)


# ---- callbacks ----

class _Raised(threading.local):
    """What callbacks raised in this thread's call: it is raised again when the call is over."""

    def __init__(self):
        super().__init__()
        self.list = []   # (exception, whether a call that goes well did without what failed)
        self.depth = 0   # of callbacks under way

    def take(self, failed=True):
        """Return the first one that is to be raised after a call, and forget all; None if there is
        none. One that goes well within a callback forgets nothing: the outer call may fail."""
        first = next((raised for raised, spared in self.list if failed or not spared), None)
        if failed or first or self.depth == 0:
            self.list.clear()
        return first


_raised = _Raised()


def _guard(call):
    """Keep the exceptions of a callback; the library is told by a status."""
    def guarded(*arguments):
        _raised.depth += 1
        try:
            return call(*arguments)
        except BaseException as exception:  # pylint: disable=broad-exception-caught
            _raised.list.append((exception, isinstance(exception, Exception)))
            return lib.SE3D_ERR_CALLBACK
        finally:
            _raised.depth -= 1
    guarded.__name__ = call.__name__
    return guarded


def check(status, system=ffi.NULL):
    """Raise Error if a status is a failure, or what a callback raised; return the status."""
    exception = _raised.take(status < 0)
    if exception:
        raise exception
    if status < 0:
        if system:
            message = text(lib.se3d_system_get_error(system))
            field = text(lib.se3d_system_get_error_field(system))
        else:
            message, field = "", ""
        raise Error(message or text(lib.se3d_status_get_text(status)), status, field)
    return status


def failure(status, error, mistakes=()):
    """Return the exception that a se3d_model_error tells of."""
    exception = _raised.take()
    if exception:
        return exception
    if status == lib.SE3D_ERR_INTERRUPTED:
        return KeyboardInterrupt()
    message = text(error.message) or text(lib.se3d_status_get_text(status))
    return ModelError(message, status, error.line, error.column, mistakes)


def _array(address, count):
    return numpy.frombuffer(ffi.buffer(address, count * 8), dtype=float)


def _motions(address, count):
    whole = _array(ffi.cast("double *", address), 13 * count).reshape(count, 13)
    return [Motion(row) for row in whole]


class Motion:
    """The motion of a body as callbacks see it: r [m], p (Euler parameters, scalar first), v [m/s]
    in the ground frame, w [rad/s] in the body frame. Valid during the call."""

    __slots__ = ("r", "p", "v", "w")

    def __init__(self, row):
        row.flags.writeable = False
        self.r, self.p, self.v, self.w = row[0:3], row[3:7], row[7:10], row[10:13]


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_function(ctx, x, jet, gradient):
    call, count = ffi.from_handle(ctx)
    values = call(*[x[k] for k in range(count)])
    if numpy.ndim(values) == 0:
        raise TypeError("a function must return (value, first derivative, second derivative), or "
                        "those and the gradient")
    jet[0], jet[1], jet[2] = values[0], values[1], values[2]
    if gradient != ffi.NULL:
        slopes = values[3] if len(values) > 3 else [values[1]]
        for k in range(count):
            gradient[k] = slopes[k]
    return lib.SE3D_OK


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_force(ctx, time, motion, wrench, K, D):
    call, has_jacobian, _energy = ffi.from_handle(ctx)
    i, j = _motions(motion, 2)
    if has_jacobian:
        matrices = [None if m == ffi.NULL else _array(m, 144).reshape(12, 12) for m in (K, D)]
        values = call(time, i, j, *matrices)
    else:
        values = call(time, i, j)
    _array(wrench, 12)[:] = numpy.asarray(values, dtype=float).reshape(12)
    return lib.SE3D_OK


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_energy(ctx, time, motion, potential, dissipated):
    values = ffi.from_handle(ctx)[2](time, *_motions(motion, 2))
    potential[0], dissipated[0] = values if numpy.ndim(values) else (values, 0.0)
    return lib.SE3D_OK


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_constraint(ctx, time, bodies, phi, jacobian, nu, gamma):
    call, count, equations = ffi.from_handle(ctx)
    values = call(time, *_motions(bodies, count))
    shapes = (equations, equations * count * 6, equations, equations)
    for address, value, size in zip((phi, jacobian, nu, gamma), values, shapes):
        if address != ffi.NULL:
            _array(address, size)[:] = numpy.asarray(value, dtype=float).reshape(size)
    return lib.SE3D_OK


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_event_value(ctx, _system, value):
    value[0] = ffi.from_handle(ctx)()
    return lib.SE3D_OK


@ffi.def_extern(error=lib.SE3D_ERR_CALLBACK)
@_guard
def se3d_python_event(ctx, _system, record):
    stop = ffi.from_handle(ctx)(EventRecord(record))
    return lib.SE3D_INFO_EVENT if stop else lib.SE3D_OK


@ffi.def_extern()
def se3d_python_log(ctx, level, _kind, message):
    try:
        ffi.from_handle(ctx)(("info", "warning", "error")[level], text(message))
    except BaseException as exception:  # pylint: disable=broad-exception-caught
        _raised.list.append((exception, False))


def _asked(call):
    """What asks whether to go on: an exception ends the run, Ctrl-C too."""
    try:
        return 1 if call() else 0
    except BaseException as exception:  # pylint: disable=broad-exception-caught
        _raised.list.append((exception, False))
        return 1


@ffi.def_extern(error=1)
def se3d_python_interrupt(ctx):
    return _asked(ffi.from_handle(ctx))


@ffi.def_extern(error=1)
def se3d_python_progress(ctx, analysis, time, fraction):
    return _asked(lambda: ffi.from_handle(ctx)(analysis, time, fraction))


@ffi.def_extern()
def se3d_python_mistake(ctx, error):
    ffi.from_handle(ctx).append(text(error.message))


class EventRecord:
    """An event that happened: time [s], value, name, direction ("rising" or "falling"), stopped."""

    __slots__ = ("time", "value", "name", "direction", "stopped")

    def __init__(self, record):
        self.time = record.time
        self.value = record.value
        self.name = text(record.name)
        self.direction = "rising" if record.direction > 0 else "falling"
        self.stopped = record.action == lib.SE3D_EVENT_STOP

    def __repr__(self):
        return f"<event {self.name!r} at {self.time:g} s, {self.direction}>"


# ---- definitions ----

class Definition:
    """A structure of the library, filled from keywords. It keeps what it points to."""

    def __init__(self, kind, values, system=None):
        self.kind = kind
        self.pointer = ffi.new(f"{kind} *")
        getattr(lib, f"{kind}_init")(self.pointer, ffi.sizeof(kind))
        self.system = system
        self.kept = []
        fields = {name: field.type for name, field in ffi.typeof(kind).fields}
        allowed = [name for name in fields if name != "struct_size" and not name.startswith("reserved")]
        for name, value in values.items():
            if name not in allowed:
                raise TypeError(f"{name} is unknown, allowed are: {', '.join(allowed)}")
            if value is not None:
                self._set(name, fields[name], value)

    def keep(self, value):
        """Keep an object as long as this definition."""
        self.kept.append(value)
        return value

    def _element(self, kind, value, name):
        if kind == "se3d_function" and not isinstance(value, Element):
            value = self.system.function(value, **self.system.variables_of(self.kind, name))
        if not isinstance(value, Element) or value.kind != kind:
            raise TypeError(f"{name} is {value!r}, must be a {kind[5:]}")
        if value.system is not self.system:
            raise ValueError(f"{name} is of another system")
        return value.handle

    def _set(self, name, field, value):
        if field.kind == "struct":
            setattr(self.pointer, name, self._element(field.cname.split()[-1], value, name)[0])
        elif field.kind == "array" and field.item.cname == "double":
            setattr(self.pointer, name, vector(value, field.length, name))
        elif field.kind == "array" and field.item.kind == "struct":
            values = list(value)
            if len(values) > field.length:
                raise ValueError(f"{name} has {len(values)} entries, may have {field.length}")
            for k, entry in enumerate(values):
                if entry is not None:
                    getattr(self.pointer, name)[k] = self._element(
                        field.item.cname.split()[-1], entry, name)[0]
        elif field.kind == "array":
            words = _WORDS.get(name, {})
            for k, entry in enumerate(value):
                getattr(self.pointer, name)[k] = word(words, entry, name)
        elif field.kind == "pointer" and field.item.cname == "char":
            setattr(self.pointer, name, self.keep(ffi.new("char[]", str(value).encode())))
        elif field.kind == "primitive" and name in _WORDS:
            setattr(self.pointer, name, word(_WORDS[name], value, name))
        else:
            setattr(self.pointer, name, value)


class Element:
    """A part of a system. Parts that were destroyed are always detected."""

    kind = ""
    __slots__ = ("system", "handle")

    def __init__(self, system, handle):
        self.system = system
        self.handle = handle  # a pointer to its own copy of the handle

    def _call(self, function, *arguments):
        return check(function(self.system.pointer, self.handle[0], *arguments), self.system.pointer)

    def _vector(self, function, count):
        values = numpy.empty(count)
        self._call(function, ffi.from_buffer("double[]", values))
        return values

    def _number(self, function, *arguments):
        value = ffi.new("double *")
        self._call(function, *arguments, value)
        return value[0]

    def _text(self, function):
        value = ffi.new("char const **")
        self._call(function, value)
        return text(value[0])

    @property
    def name(self):
        """Its name, "" if it has none."""
        return self._text(getattr(lib, f"{self.kind}_get_name"))

    def destroy(self):
        """Take it out of its system."""
        self._call(getattr(lib, f"{self.kind}_destroy"))

    def __eq__(self, other):
        return (isinstance(other, Element) and other.kind == self.kind
                and other.system is self.system and other.handle.index1 == self.handle.index1
                and other.handle.generation == self.handle.generation)

    def __hash__(self):
        return hash((self.kind, self.handle.index1, self.handle.generation))

    def __repr__(self):
        try:
            return f"<{type(self).__name__} {self.name!r}>"
        except (Error, AttributeError):
            return f"<{type(self).__name__}>"
