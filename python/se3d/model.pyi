# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any, NamedTuple

from se3d._library import Array
from se3d.system import System

class Analysis(NamedTuple):
    type: str
    formulation: str
    method: str
    status: int
    start: float
    end: float
    cpu_time: float
    steps: int

class Statistics(NamedTuple):
    min: float
    min_time: float
    max: float
    max_time: float
    mean: float
    rms: float
    integral: float
    last: float

class Model:
    pointer: Any
    system: System
    def __init__(self, path: str | PathLike[str] | None = ..., *, text: str | None = ...,
                 name: str = ..., parameters: Mapping[str, float | str] | None = ...,
                 analysis: str | None = ..., formulation: str | None = ...,
                 method: str | None = ..., step: float | str | None = ...,
                 duration: float | str | None = ..., mass_optional: int | None = ...,
                 tolerance: float | str | None = ...,
                 threads: int | str | None = ...) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    def parameter(self, name: str) -> float: ...
    def run(self, directory: str | PathLike[str] = ..., *,
            progress: Callable[[int, float, float], Any] | None = ...,
            scene: bool = ...) -> Run: ...
    def write(self, path: str | PathLike[str], *, partial: bool = ...) -> None: ...
    def write_scene(self, path: str | PathLike[str]) -> None: ...
    def _repr_html_(self) -> str: ...

class Run:
    model: Model
    pointer: Any
    directory: str | PathLike[str]
    def __init__(self, model: Model, pointer: Any, directory: str | PathLike[str],
                 scene: Any = ...) -> None: ...
    @property
    def analyses(self) -> list[Analysis]: ...
    @property
    def files(self) -> list[str]: ...
    @property
    def summary(self) -> dict[str, Statistics]: ...
    def table(self, file: str | PathLike[str] | None = ...) -> dict[str, Array]: ...
    def write_scene(self, path: str | PathLike[str]) -> None: ...
    def _repr_html_(self) -> str: ...
