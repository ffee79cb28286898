#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Oblique elastic impacts of a sphere on a rigid plane after Maw, Barber and Fawcett (Wear 38, 1976):
rings of the contact stick or slip by Coulomb's law, tractions are sums of sqrt(b^2 - r^2). Prints the
slip before and after over mu times the normal speed, which docs/theory/contact-laws.md shows.

    impact_reference.py [POISSON [FRICTION]]        (needs numpy)
"""
import sys

import numpy as np

RINGS, STEPS = 40, 600


class Contact:
    """Radius, mass and Young's modulus 1; slow, so that the arm stays the radius."""

    def __init__(self, poisson, friction):
        self.friction, self.speed = friction, 1e-3
        self.modulus = 1.0 / (1.0 - poisson ** 2)
        self.deepest = (15.0 * self.speed ** 2 / (16.0 * self.modulus)) ** 0.4
        self.step = 2.943 * self.deepest / self.speed / STEPS
        self.width = np.sqrt(self.deepest) / RINGS
        self.b = np.arange(1, RINGS + 1) * self.width
        self.r = (np.arange(RINGS) + 0.5) * self.width
        b, r = np.meshgrid(self.b, self.r)
        inside = r < b
        self.traction = np.sqrt(np.where(inside, b ** 2 - r ** 2, 0.0))
        beyond = (2.0 * b ** 2 - r ** 2) * np.arcsin(np.minimum(b / r, 1.0))
        beyond += b * np.sqrt(np.where(inside, 0.0, r ** 2 - b ** 2))
        compliance = np.pi * (2.0 - poisson) * (1.0 + poisson) / 8.0  # pi (2 - nu)/(16 G)
        self.sway = compliance * np.where(inside, 2.0 * b ** 2 - r ** 2, 2.0 / np.pi * beyond)
        self.force = 2.0 * np.pi / 3.0 * self.b ** 3
        self.slipped, self.state = np.zeros(RINGS), np.zeros(RINGS, int)

    def push(self, overlap, shift):
        """Normal and tangential force after the sphere has come to `overlap` and `shift`."""
        normal = 4.0 / 3.0 * self.modulus * overlap ** 1.5
        k = min(int(round(np.sqrt(overlap) / self.width)), RINGS)
        if k == 0:
            self.slipped[:] = shift
            return normal, 0.0
        most = 1.5 * normal / (np.pi * overlap) * np.sqrt(1.0 - (self.r[:k] / self.b[k - 1]) ** 2)
        most *= self.friction
        state = self.state[:k].copy()
        for _ in range(60):
            rows = np.where((state == 0)[:, None], self.sway[:k, :k], self.traction[:k, :k])
            q = np.linalg.solve(rows, np.where(state == 0, shift - self.slipped[:k], state * most))
            tau = self.traction[:k, :k] @ q
            moved = shift - self.sway[:k, :k] @ q - self.slipped[:k]
            new = np.where((state == 0) & (np.abs(tau) > most * (1.0 + 1e-9)), np.sign(tau), state)
            new = np.where((state != 0) & (moved * state < -1e-15), 0, new).astype(int)
            if (new == state).all():
                break
            state = new
        sticks = np.zeros(RINGS, bool)
        sticks[:k] = state == 0
        self.state[:] = 0
        self.state[:k] = state
        self.slipped = np.where(sticks, self.slipped, shift - self.sway[:, :k] @ q)
        return normal, self.force[:k] @ q


def slip_after(poisson, friction, slip):
    """Slips over the normal speed; the point of contact of a solid sphere weighs 2/7 of it."""
    c = Contact(poisson, friction)
    overlap = shift = normal = tangential = 0.0
    into, along = c.speed, slip * c.speed
    while True:
        into -= c.step * normal
        along -= c.step * 3.5 * tangential
        overlap += c.step * into
        shift += c.step * along
        if overlap <= 0.0:
            return along / c.speed
        normal, tangential = c.push(overlap, shift)


def main():
    poisson, friction = (list(map(float, sys.argv[1:])) + [0.3, 0.3][len(sys.argv) - 1:])[:2]
    for before in (0.3, 0.6, 0.9, 1.2, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0):
        print(f"{before:.1f} {slip_after(poisson, friction, before * friction) / friction:.3f}")


if __name__ == "__main__":
    main()
