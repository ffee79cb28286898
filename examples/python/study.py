# SPDX-License-Identifier: BSD-3-Clause
"""How a parameter of a model file changes a result: the period of a pendulum over its length."""

import tempfile

import numpy

import se3d

TEXT = """se3d: 1
parameters: {L: 1}
bodies: [{name: bob, mass: 1, inertia: [1e-9, 1e-9, 1e-9], position: [L*sin(0.1), 0, -L*cos(0.1)]}]
joints:
  - {name: pin, type: revolute, body_i: ground, body_j: bob, at: [0, 0, 0], axis: [0, -1, 0],
     angle0: 0.1}
analysis: {type: dynamics, duration: 6, tolerance: 1e-9}
output: [{file: swing.csv, every: 0.01, channels: [pin.angle]}]
"""

with tempfile.TemporaryDirectory() as folder:
    for length in (0.5, 1.0, 2.0):
        table = se3d.Model(text=TEXT, parameters={"L": length}).run(folder).table()
        angle, time = table["pin.angle"], table["time"]
        k = numpy.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0))[:2]
        zeros = time[k] - angle[k] * (time[k + 1] - time[k]) / (angle[k + 1] - angle[k])
        period = zeros[1] - zeros[0] if len(zeros) > 1 else numpy.nan
        exact = 2 * numpy.pi * numpy.sqrt(length / 9.81) * (1 + 0.1**2 / 16)
        print(f"L = {length} m: {period:.5f} s, small-angle series {exact:.5f} s")
        assert abs(period - exact) < 1e-4
