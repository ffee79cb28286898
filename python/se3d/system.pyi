# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable, Sequence
from os import PathLike
from types import TracebackType
from typing import Any, NamedTuple, TypeVar

from numpy.typing import ArrayLike

from se3d._library import Array, ArrayProperty, Element, FunctionLike, Motion, Word
from se3d.elements import Body, Constraint, Force, Function, Marker, Material, Shape

ElementType = TypeVar("ElementType", bound=Element)

JOINTS: tuple[str, ...]
SHAPES: tuple[str, ...]

class Energy(NamedTuple):
    kinetic: float
    potential: float
    total: float
    dissipated: float

class Work(NamedTuple):
    dissipated: float
    actuators: float
    drivers: float

class State(NamedTuple):
    r: Array
    p: Array
    v: Array
    w: Array

class Summary(NamedTuple):
    bodies: int
    equations: int
    rank: int
    redundant: int
    freedoms: int
    gruebler: int
    inconsistent: int

class Contact(NamedTuple):
    shape_i: Shape
    shape_j: Shape
    point: Array
    normal: Array
    overlap: float
    force: Array

class System:
    pointer: Any
    def __init__(self, *, gravity: ArrayLike = ..., time: float = ...,
                 log: Callable[[str, str], Any] | None = ..., _pointer: Any = ...,
                 _owner: Any = ...) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> System: ...
    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None: ...
    def __del__(self) -> None: ...
    def check(self, status: int) -> int: ...
    @staticmethod
    def variables_of(kind: str, name: str) -> dict[str, tuple[str, ...]]: ...
    @property
    def ground(self) -> Body: ...
    def body(self, *, inertia: ArrayLike | None = ..., name: str | None = ...,
             mass: float | None = ..., position: ArrayLike | None = ...,
             orientation: ArrayLike | None = ..., velocity: ArrayLike | None = ...,
             angular_velocity: ArrayLike | None = ..., fixed: bool | None = ...) -> Body: ...
    def marker(self, *, name: str | None = ..., body: Body | None = ...,
               position: ArrayLike | None = ..., orientation: ArrayLike | None = ...) -> Marker: ...
    def joint(self, type: str, body_i: Body, body_j: Body, *, at: ArrayLike | None = ...,
              axis: ArrayLike | None = ..., ref: ArrayLike | None = ..., name: str | None = ...,
              point_i: ArrayLike | None = ..., point_j: ArrayLike | None = ...,
              axis_i: ArrayLike | None = ..., axis_j: ArrayLike | None = ...,
              ref_i: ArrayLike | None = ..., ref_j: ArrayLike | None = ...,
              angle0: float | None = ..., pitch: float | None = ..., distance: float | None = ...,
              break_force: float | None = ..., break_moment: float | None = ...) -> Constraint: ...
    def driver(self, joint: Constraint, coordinate: Word = ..., function: FunctionLike | None = ...,
               *, name: str | None = ..., is_rate: bool | None = ...,
               value: float | None = ...) -> Constraint: ...
    def coupler(self, terms: Sequence[tuple[Constraint, Word, float]], *, value: float = ...,
                function: FunctionLike | None = ..., name: str | None = ...) -> Constraint: ...
    def gear(self, joint_1: Constraint, joint_2: Constraint, ratio: float, *,
             name: str | None = ...) -> Constraint: ...
    def rack_pinion(self, pinion: Constraint, rack: Constraint, radius: float, *,
                    name: str | None = ...) -> Constraint: ...
    def primitive(self, type: Word, body_i: Body, body_j: Body, *, name: str | None = ...,
                  a_i: ArrayLike | None = ..., a_j: ArrayLike | None = ...,
                  point_i: ArrayLike | None = ..., point_j: ArrayLike | None = ...,
                  c: ArrayLike | None = ..., value: float | None = ...,
                  function: FunctionLike | None = ...) -> Constraint: ...
    def user_constraint(self,
                        call: Callable[..., tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]],
                        bodies: Sequence[Body], equations: int = ..., *,
                        name: str | None = ...) -> Constraint: ...
    def tsda(self, body_i: Body, body_j: Body, *, name: str | None = ...,
             point_i: ArrayLike | None = ..., point_j: ArrayLike | None = ...,
             k: float | None = ..., c: float | None = ..., l0: float | None = ...,
             h: FunctionLike | None = ..., spring: FunctionLike | None = ...,
             damper: FunctionLike | None = ..., preload: float | None = ...) -> Force: ...
    def rsda(self, joint: Constraint | None = ..., *, name: str | None = ..., k: float | None = ...,
             c: float | None = ..., theta0: float | None = ..., h: FunctionLike | None = ...,
             spring: FunctionLike | None = ..., damper: FunctionLike | None = ...,
             preload: float | None = ..., body_i: Body | None = ..., body_j: Body | None = ...,
             axis_i: ArrayLike | None = ..., ref_i: ArrayLike | None = ...,
             ref_j: ArrayLike | None = ..., angle0: float | None = ...) -> Force: ...
    def force(self, body: Body, value: ArrayLike = ..., *, name: str | None = ...,
              point: ArrayLike | None = ..., function: Sequence[FunctionLike | None] | None = ...,
              in_body_frame: bool | None = ...) -> Force: ...
    def torque(self, body: Body, value: ArrayLike = ..., *, name: str | None = ...,
               point: ArrayLike | None = ..., function: Sequence[FunctionLike | None] | None = ...,
               in_body_frame: bool | None = ...) -> Force: ...
    def bushing(self, body_i: Body, body_j: Body, *, name: str | None = ...,
                point_i: ArrayLike | None = ..., point_j: ArrayLike | None = ...,
                orientation_i: ArrayLike | None = ..., orientation_j: ArrayLike | None = ...,
                K: ArrayLike | None = ..., C: ArrayLike | None = ...) -> Force: ...
    def friction(self, joint: Constraint, coordinate: Word = ..., *, name: str | None = ...,
                 mu: float | None = ..., mu_static: float | None = ..., radius: float | None = ...,
                 limit: float | None = ..., viscous: float | None = ...,
                 presliding: float | None = ..., length: float | None = ...,
                 width: float | None = ..., thrust_radius: float | None = ...) -> Force: ...
    def stop(self, joint: Constraint | None = ..., coordinate: Word = ..., *,
             name: str | None = ..., body_i: Body | None = ..., body_j: Body | None = ...,
             point_i: ArrayLike | None = ..., point_j: ArrayLike | None = ...,
             lower: float | None = ..., upper: float | None = ..., k: float | None = ...,
             restitution: float | None = ...) -> Force: ...
    def effort(self, joint: Constraint, coordinate: Word = ..., *, name: str | None = ...,
               value: float | None = ..., function: FunctionLike | None = ...) -> Force: ...
    def armature(self, joint: Constraint, coordinate: Word = ..., *, name: str | None = ...,
                 inertia: float | None = ...) -> Force: ...
    def force_callback(self, call: Callable[..., ArrayLike], body_i: Body, body_j: Body, *,
                       name: str | None = ..., has_jacobian: bool = ...,
                       energy: Callable[..., ArrayLike] | None = ...) -> Force: ...
    def function(self, what: str | float | tuple[ArrayLike, ArrayLike] | Callable[..., Any], *,
                 variables: Sequence[str] = ...) -> Function: ...
    def material(self, *, density: float | None = ..., friction: float | None = ...,
                 restitution: float | None = ..., rolling_friction: float | None = ...,
                 torsional_friction: float | None = ..., stiffness: float | None = ...,
                 tangential_ratio: float | None = ..., young: float | None = ...,
                 poisson: float | None = ..., cohesion: float | None = ...,
                 adhesion: float | None = ..., name: str | None = ...,
                 damping_ratio: float | None = ..., tangential_ratio_hertz: float | None = ...,
                 tangential_damping: float | None = ..., rolling_ratio: float | None = ...,
                 rolling_damping: float | None = ..., damping_rate: float | None = ...,
                 tangential_stiffness: float | None = ...,
                 rolling_stiffness: float | None = ...) -> Material: ...
    def contact(self, *, law: Word | None = ..., step: float | None = ...,
                overlap_limit: float | None = ...) -> None: ...
    def shape(self, type: str, *, vertices: ArrayLike | None = ...,
              triangles: ArrayLike | None = ..., heights: ArrayLike | None = ...,
              name: str | None = ..., body: Body | None = ..., material: Material | None = ...,
              position: ArrayLike | None = ..., orientation: ArrayLike | None = ...,
              normal: ArrayLike | None = ..., size: ArrayLike | None = ...,
              radius: float | None = ..., length: float | None = ..., group: int | None = ...,
              mask: int | None = ..., spacing: ArrayLike | None = ...,
              bottom_radius: float | None = ..., top_radius: float | None = ...,
              surface_velocity: ArrayLike | None = ...,
              surface_spin: ArrayLike | None = ...,
              semi_axes: ArrayLike | None = ...) -> Shape: ...
    @property
    def bodies(self) -> list[Body]: ...
    @property
    def markers(self) -> list[Marker]: ...
    @property
    def constraints(self) -> list[Constraint]: ...
    @property
    def forces(self) -> list[Force]: ...
    def find_body(self, name: str) -> Body: ...
    def find_constraint(self, name: str) -> Constraint: ...
    def find_force(self, name: str) -> Force: ...
    def find_material(self, name: str) -> Material: ...
    def find_shape(self, name: str) -> Shape: ...
    @property
    def time(self) -> float: ...
    @time.setter
    def time(self, value: float) -> None: ...
    gravity: ArrayProperty
    def get_state(self, out: State | None = ...) -> State: ...
    def set_state(self, r: ArrayLike | None = ..., p: ArrayLike | None = ...,
                  v: ArrayLike | None = ..., w: ArrayLike | None = ...) -> None: ...
    efforts: ArrayProperty
    def touch(self) -> None: ...
    @property
    def energy(self) -> Energy: ...
    @property
    def work(self) -> Work: ...
    @property
    def violation(self) -> Array: ...
    def hash(self) -> int: ...
    @property
    def contacts(self) -> list[Contact]: ...
    def clone(self) -> System: ...
    def element_of(self, element: ElementType) -> ElementType: ...
    def snapshot(self) -> Any: ...
    def restore(self, snapshot: Any) -> None: ...
    def save(self) -> bytes: ...
    def load(self, data: bytes) -> None: ...
    def report(self) -> tuple[Summary, list[str]]: ...
    def write(self, path: str | PathLike[str], *, partial: bool = ...) -> None: ...
    def _repr_html_(self) -> str: ...
