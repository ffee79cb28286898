# SPDX-License-Identifier: BSD-3-Clause
"""An arm of two links follows a circle: efforts by inverse dynamics and feedback at 1 kHz."""

import numpy

import se3d

with se3d.System() as system:
    links = [system.body(mass=2, inertia=(1e-3, 0.06, 0.06), position=(0.3 + 0.6 * k, 0, 0))
             for k in range(2)]
    joints = [system.joint("revolute", parent, link, at=(0.6 * k, 0, 0), axis=(0, 1, 0))
              for k, (parent, link) in enumerate(zip([system.ground, links[0]], links))]
    motors = [system.effort(joint) for joint in joints]
    tip = system.marker(name="tip", body=links[1], position=(0.3, 0, 0))
    tree = se3d.Coordinates(system)
    tree.set([-0.8, 1.4], [0.0, 0.0])

    solver = se3d.Solver(system)
    centre = tip.position - (0.15, 0, 0)
    largest = 0.0
    for k in range(2000):
        t = 1e-3 * k
        # A circle that is entered and run through smoothly once in two seconds.
        s = (t / 2) - numpy.sin(numpy.pi * t) / (2 * numpy.pi)
        rate = 0.5 - numpy.cos(numpy.pi * t) / 2
        angle, speed = 2 * numpy.pi * s, 2 * numpy.pi * rate
        wanted = centre + 0.15 * numpy.array((numpy.cos(angle), 0, numpy.sin(angle)))
        velocity = 0.15 * speed * numpy.array((-numpy.sin(angle), 0, numpy.cos(angle)))
        error = wanted - tip.position
        largest = max(largest, float(numpy.linalg.norm(error)))
        J = tree.jacobian(tip)[[3, 5], :]
        _, qdot = tree.get()
        target = numpy.linalg.solve(J, (velocity + 40 * error)[[0, 2]])
        # The motors have no value yet where the tree is asked: efforts beside those that act.
        system.efforts = (0, 0)
        system.efforts = tree.efforts(80 * (target - qdot))
        solver.step(1e-3)
    print(f"the tip left the circle by at most {1e3 * largest:.1f} mm")
    assert largest < 0.01
