# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable
from typing import Any, NamedTuple

from se3d._library import EventRecord, Word
from se3d.system import System

class Stats(NamedTuple):
    steps: int
    rejected: int
    iterations: int
    evaluations: int
    factorizations: int
    solves: int

class Solver:
    system: System
    pointer: Any
    def __init__(self, system: System, analysis: Word = ..., *,
                 interrupt: Callable[[], Any] | None = ..., formulation: Word | None = ...,
                 method: Word | None = ..., order: int | None = ..., step: float | None = ...,
                 tolerance: float | None = ..., spectral_radius: float | None = ...,
                 alpha: float | None = ..., iterations_max: int | None = ...,
                 steps_max: int | None = ..., horizon: float | None = ...,
                 sleep: bool | None = ...) -> None: ...
    def run(self, end: float) -> int: ...
    def step(self, length: float) -> int: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def method(self) -> str: ...
    @property
    def stats(self) -> Stats: ...
    def event(self, value: Callable[[], float], *,
              callback: Callable[[EventRecord], Any] | None = ..., name: str | None = ...,
              level: float | None = ..., direction: Word | None = ..., action: Word | None = ...,
              motion_only: bool | None = ..., hysteresis: float | None = ...) -> None: ...
    @property
    def events(self) -> list[EventRecord]: ...
