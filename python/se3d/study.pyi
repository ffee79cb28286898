# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy
from numpy.typing import ArrayLike, NDArray

from se3d._library import Error
from se3d.model import Model

class Samples(NamedTuple):
    numbers: NDArray[numpy.int_]
    parameters: NDArray[numpy.float64]
    measures: NDArray[numpy.float64]
    failures: dict[int, Error]

class Study:
    model: Model
    pointer: Any
    parameters: tuple[str, ...]
    measures: tuple[str, ...]
    def __init__(self, model: Model) -> None: ...
    def __len__(self) -> int: ...
    def sample(self, number: int) -> NDArray[numpy.float64]: ...
    def samples(self, numbers: Iterable[int] | None = None) -> NDArray[numpy.float64]: ...
    def eval(self, parameters: ArrayLike) -> NDArray[numpy.float64]: ...
    def run(self, numbers: Iterable[int] | None = None, *,
            progress: Callable[[int, int], Any] | None = None) -> Samples: ...
    def sensitivities(self) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64],
                                     tuple[str, ...]]: ...
