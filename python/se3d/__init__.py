# SPDX-License-Identifier: BSD-3-Clause
"""Constrained rigid multibody dynamics in 3-D: libse3d for Python.

    import se3d
    with se3d.System() as system:
        bar = system.body(mass=1, inertia=(0, 1 / 12, 1 / 12), position=(0.5, 0, 0))
        pin = system.joint("revolute", system.ground, bar, at=(0, 0, 0), axis=(0, 1, 0))
        se3d.Solver(system).run(1.0)
        print(pin.angle, system.energy.total)

Units are SI, orientations Euler parameters with the scalar first, as in the C headers.
"""

from se3d._library import STATUS, Error, EventRecord, ModelError, Motion, ffi, lib, text
from se3d.batch import Batch
from se3d.coordinates import Coordinates
from se3d.elements import (Body, Constraint, Force, Function, Marker, Material, Shape)
from se3d.model import Analysis, Model, Run, Statistics
from se3d.solver import Solver, Stats
from se3d.study import Samples, Study
from se3d.system import Contact, Energy, State, System, Work

__version__ = text(lib.se3d_version_get_text())
__all__ = ["Analysis", "Batch", "Body", "Constraint", "Contact", "Coordinates", "Energy", "Error",
           "EventRecord", "Force", "Function", "Marker", "Material", "Model", "ModelError",
           "Motion", "Run", "STATUS", "Samples", "Shape", "Solver", "State", "Statistics", "Stats",
           "Study", "System", "Work", "ffi", "lib"]
