#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Forces of tyres by the formulas of docs/theory/tyre.md, written without regard to lib/force:

    python3 tests/golden/tyre_reference.py > tests/golden/tyre_reference.h

A state is what the wheel's centre does over the road z = 0: height h, inclination g (about x), speed
u ahead and v to the left, spin W."""
from math import atan, cos, pi, sin, sqrt, tan

BRUSH = dict(law=0, R=0.31, k=1.8e5, c=400.0, mu=1.1, mu_min=0.0, Cx=4.5e4, Cy=3.2e4, L=0.14, f=0.012)
FIALA = dict(law=1, R=0.31, k=1.8e5, c=400.0, mu=1.1, mu_min=0.7, Cx=4.5e4, Cy=3.2e4, L=0.14, f=0.012)
STATES = [  # h, g, u, v, W
    (0.300, 0.00, 20.0, 0.0, 20.0 / 0.30667),
    (0.300, 0.00, 20.0, 0.3, 64.0),
    (0.295, 0.00, 20.0, -0.6, 66.5),
    (0.295, 0.05, 15.0, 0.9, 49.0),
    (0.290, -0.08, 25.0, -2.0, 60.0),
    (0.298, 0.00, 30.0, 6.0, 98.0),
    (0.298, 0.02, 12.0, 0.4, 0.0),
    (0.298, 0.00, 12.0, 0.0, 80.0),
    (0.300, 0.00, 0.2, 0.02, 0.5),
    (0.300, 0.00, 0.0, 0.0, 0.0),
    (0.300, 0.00, -8.0, 0.3, -25.0),
    (0.320, 0.00, 20.0, 1.0, 60.0),
]


def speed(x, low=1.0):
    return abs(x) if abs(x) >= low else (x * x + low * low) / (2 * low)


def sign(x):
    return (x > 0) - (x < 0)


def bristles(t, fz, sx, sy):
    """Forces along (sx, sy), the theoretical slip, by adhesion up to where the parabola of the
    pressure ends it."""
    ex, ey = t['Cx'] * sx, t['Cy'] * sy
    elastic = sqrt(ex * ex + ey * ey)
    if elastic == 0:
        return 0.0, 0.0, 0.0
    limit = t['mu'] * fz
    theta = elastic / (3 * limit)
    if theta >= 1:
        return limit * ex / elastic, limit * ey / elastic, 0.0
    total = limit * (1 - (1 - theta) ** 3)
    trail = t['L'] / 6 * (1 - theta) ** 3 / (1 - theta + theta ** 2 / 3)
    return total * ex / elastic, total * ey / elastic, trail * total * ey / elastic


def fiala(t, fz, kappa, tangent):
    low = t['mu_min'] or t['mu']
    mu = t['mu'] - (t['mu'] - low) * min(1.0, sqrt(kappa ** 2 + tangent ** 2))
    critical = mu * fz / (2 * t['Cx'])
    if abs(kappa) < critical:
        fx = t['Cx'] * kappa
    else:
        fx = sign(kappa) * (mu * fz - (mu * fz) ** 2 / (4 * abs(kappa) * t['Cx']))
    H = 1 - t['Cy'] * abs(tangent) / (3 * mu * fz)
    if H > 0:
        return fx, -mu * fz * (1 - H ** 3) * sign(tangent), mu * fz * t['L'] / 2 * (1 - H) * H ** 3 * sign(tangent)
    return fx, -mu * fz * sign(tangent), 0.0


def forces(t, state):
    h, g, u, v, W = state
    loaded = h / cos(g)
    rho = t['R'] - loaded
    if rho <= 0:
        return [0.0] * 6
    # the wheel neither rises nor leans, so that the contact point moves as the centre
    fz = t['k'] * rho / cos(g)
    re = t['R'] - rho / 3
    # the side speed of the wheel's own point at the road: the spin's part is along x
    vsx = u - W * re
    if t['law'] == 0:
        r = speed(W * re)
        fx, fy, m = bristles(t, fz, -vsx / r, -v / r)
        mz = -m
    else:
        fx, fy, mz = fiala(t, fz, -vsx / speed(u), v / speed(u))
    my = -t['f'] * fz * re * W * re / speed(W * re) + fx * (loaded - re)
    return [fx, fy, fz, 0.0, my, mz]


def row(numbers):
    return '{' + ',\n     '.join('%.17g' % x for x in numbers) + '}'


def table(name, t):
    print('static const double %s[TYRE_STATES][6] = {' % name)
    for state in STATES:
        print('    ' + row(forces(t, state)) + ',')
    print('};')


print('/* SPDX-License-Identifier: BSD-3-Clause */')
print('/* Written by tests/golden/tyre_reference.py: Fx, Fy, Fz, Mx, My, Mz. */')
print('/* clang-format off */')
print('#define TYRE_STATES %d' % len(STATES))
print('static const double tyre_states[TYRE_STATES][5] = { /* h, g, u, v, W */')
for state in STATES:
    print('    ' + row(state) + ',')
print('};')
table('tyre_brush', BRUSH)
table('tyre_fiala', FIALA)
print('/* clang-format on */')
