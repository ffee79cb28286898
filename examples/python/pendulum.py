# SPDX-License-Identifier: BSD-3-Clause
"""A bar swings about a hinge: its angle, its reaction and its energy."""

import se3d

with se3d.System() as system:
    bar = system.body(name="bar", mass=1, inertia=(1e-4, 1 / 12, 1 / 12), position=(0.5, 0, 0))
    pin = system.joint("revolute", system.ground, bar, at=(0, 0, 0), axis=(0, 1, 0))
    solver = se3d.Solver(system)
    for k in range(11):
        solver.run(0.1 * k)
        force, _ = pin.reaction
        print(f"t = {system.time:.1f} s  angle = {pin.angle:8.5f} rad  rate = {pin.angle_rate:8.5f}"
              f" rad/s  vertical reaction = {force[2]:8.4f} N")
    print(f"energy changed by {system.energy.total:.1e} J")
