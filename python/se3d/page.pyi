# SPDX-License-Identifier: BSD-3-Clause
from collections.abc import Callable, Iterable

LIMIT: int
LINES: int
WAIT: float

def escape(value: str) -> str: ...
def show(write_model: Callable[[str], None], write_scene: Callable[[str], None] | None = ...,
         tables: Iterable[str] = ...) -> str: ...
