# SPDX-License-Identifier: BSD-3-Clause
# The extension module that cffi compiles: every function and type of the headers.
from typing import Any

ffi: Any
lib: Any
