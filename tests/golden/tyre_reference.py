#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Forces of tyres by the formulas of docs/theory/tyre.md, written without regard to lib/force:

    python3 tests/golden/tyre_reference.py > tests/golden/tyre_reference.h

A state is what the wheel's centre does over the road z = 0: height h, inclination g (about x), speed
u ahead and v to the left, spin W."""
from math import acos, atan, cos, pi, sin, sqrt, tan

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
RATES = [0.5, -0.8, 2.0, 1.0, -3.0, 4.0, 0.0, -1.5, 0.6, -0.7, 1.2, 1.0]  # about the road's normal [rad/s]


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


def forces(t, state, rate=None):
    h, g, u, v, W = state
    loaded = h / cos(g)
    rho = t['R'] - loaded
    if rho <= 0:
        return [0.0] * 6
    # the wheel neither rises nor leans, so that the contact point moves as the centre
    fz = t['k'] * rho / cos(g)
    if t['law'] >= 2:
        return magic(t, MAGIC, fz, rho, g, u, v, W, loaded, rate)
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


# An invented set with every coefficient of both versions, of the size that they have for a racing tyre.
MAGIC = dict(
    FNOMIN=1100, LONGVL=16.7, NOMPRES=9e4, INFLPRES=8e4, BREFF=8.4, DREFF=0.27, FREFF=0.07, QRE0=0.999, QV1=7e-4,
    LFZO=0.98, LCX=1.02, LMUX=0.95, LEX=1.03, LKX=0.97, LHX=1.1, LVX=0.9, LGAX=1.05, LXAL=1.04, LCY=0.99, LMUY=0.93,
    LEY=1.01, LKY=0.96, LHY=1.2, LVY=0.8, LGAY=1.0, LKYC=1.06, LYKA=0.98, LVYKA=1.07, LTR=0.94, LRES=1.08, LGAZ=1.0,
    LKZC=0.91, LS=1.09, LMX=0.92, LVMX=1.11, LMY=0.89,
    PCX1=1.62, PDX1=1.48, PDX2=-0.12, PDX3=3.1, PEX1=0.1, PEX2=0.2, PEX3=-0.05, PEX4=0.02, PKX1=34.0, PKX2=-2.0,
    PKX3=0.18, PHX1=-0.0012, PHX2=0.0008, PVX1=0.01, PVX2=-0.004, PPX1=-0.35, PPX2=0.34, PPX3=-0.09, PPX4=0.06,
    RBX1=13.0, RBX2=11.0, RBX3=4.0, RCX1=1.02, REX1=0.1, REX2=-0.2, RHX1=0.004,
    PCY1=1.43, PDY1=1.52, PDY2=-0.16, PDY3=2.6, PEY1=-0.1, PEY2=-0.3, PEY3=0.12, PEY4=-1.3, PEY5=-20.0, PKY1=-24.0,
    PKY2=1.7, PKY3=0.6, PKY4=1.9, PKY5=3.0, PKY6=-0.9, PKY7=-0.25, PHY1=0.0024, PHY2=-0.0011, PHY3=0.032, PVY1=0.021,
    PVY2=-0.011, PVY3=-0.22, PVY4=-0.13, PPY1=-0.5, PPY2=-0.06, PPY3=-0.07, PPY4=-0.02, PPY5=-0.2,
    RBY1=14.0, RBY2=9.0, RBY3=-0.02, RBY4=1.6, RCY1=1.04, REY1=0.2, REY2=-0.1, RHY1=0.009, RHY2=0.004, RVY1=0.03,
    RVY2=-0.02, RVY3=-0.3, RVY4=12.0, RVY5=1.9, RVY6=-10.0,
    QBZ1=8.6, QBZ2=-1.5, QBZ3=-0.4, QBZ4=0.4, QBZ5=-0.6, QBZ9=16.0, QBZ10=0.2, QCZ1=1.1, QDZ1=0.11, QDZ2=-0.01,
    QDZ3=-0.3, QDZ4=0.4, QDZ6=-0.005, QDZ7=-0.002, QDZ8=-0.17, QDZ9=-0.02, QDZ10=0.15, QDZ11=0.04, QEZ1=-1.6, QEZ2=0.3,
    QEZ3=0.1, QEZ4=0.15, QEZ5=-2.0, QHZ1=0.006, QHZ2=-0.003, QHZ3=0.12, QHZ4=0.06, PPZ1=-0.4, PPZ2=-0.5, SSZ1=0.02,
    SSZ2=0.005, SSZ3=0.6, SSZ4=0.2,
    QSX1=-0.008, QSX2=1.2, QSX3=0.09, QSX4=0.05, QSX5=1.3, QSX6=0.7, QSX7=0.8, QSX8=0.3, QSX9=1.9, QSX10=0.4, QSX11=0.6,
    QSX12=0.3, QSX13=0.01, QSX14=0.2, PPMX1=0.1,
    QSY1=0.011, QSY2=0.04, QSY3=0.001, QSY4=0.0002, QSY5=0.3, QSY6=0.5, QSY7=0.85, QSY8=-0.4,
    PDXP1=0.4, PDXP2=0.1, PDXP3=0.7, PKYP1=1.1, PDYP1=0.6, PDYP2=0.15, PDYP3=0.3, PDYP4=0.2, PHYP1=1.05, PHYP2=0.16,
    PHYP3=0.02, PHYP4=-3.0, PECP1=0.45, PECP2=0.08, QDTP1=9.0, QCRP1=0.22, QCRP2=0.12, QBRP1=0.3, QDRP1=1.1, QDRP2=-1.4,
    LMP=0.97)
MF52 = dict(BRUSH, law=2)
MF61 = dict(BRUSH, law=3)


def bow(B, C, E, x):
    return C * atan(B * x - E * (B * x - atan(B * x)))


def pacejka(t, c, fz, kappa, alpha, gamma, way, u, rolled, turn=None):
    """(Fx, Fy, Mx, My, Mz) of version 5.2 (law 2) or 6.1 (law 3); turn: rate about the road's normal and spin times
    the sine of the inclination, over the speed, with the factors zeta of Pacejka (2012), section 4.3.3."""
    new = t['law'] == 3
    p = c['INFLPRES'] / c['NOMPRES']
    dp = p - 1
    f0 = c['LFZO'] * c['FNOMIN']
    df = (fz - f0) / f0
    lx, ly = t['mu'] * c['LMUX'], t['mu'] * c['LMUY']
    cosine = way * cos(alpha)
    fade = way * way  # shifts end where the wheel stands
    z = [1.0] * 8
    phi = phi_t = 0.0
    if turn:
        left_over = 1 - c['PECP1'] * (1 + c['PECP2'] * df)  # 1 - epsilon_gamma
        phi_t, phi = turn[0], turn[0] + left_over * turn[1]
        x = t['R'] * abs(phi)
        z[0] = 0.0
        z[1] = cos(atan(c['PDXP1'] * (1 + c['PDXP2'] * df) * cos(atan(c['PDXP3'] * kappa)) * t['R'] * phi))
        z[2] = cos(atan(c['PDYP1'] * (1 + c['PDYP2'] * df) * cos(atan(c['PDYP3'] * tan(alpha))) * (
            x + c['PDYP4'] * sqrt(x))))
        z[3] = cos(atan(c['PKYP1'] * t['R'] ** 2 * phi ** 2))
        z[5] = cos(atan(c['QDTP1'] * t['R'] * phi))
        z[6] = cos(atan(c['QBRP1'] * t['R'] * phi))

    # longitudinal
    k = kappa + fade * (c['PHX1'] + c['PHX2'] * df) * c['LHX']
    mu = (c['PDX1'] + c['PDX2'] * df) * (1 - c['PDX3'] * (gamma * c['LGAX']) ** 2) * lx
    mu *= 1 + c['PPX3'] * dp + c['PPX4'] * dp ** 2
    Kx = fz * (c['PKX1'] + c['PKX2'] * df) * 2.718281828459045 ** (c['PKX3'] * df) * c['LKX']
    Kx *= 1 + c['PPX1'] * dp + c['PPX2'] * dp ** 2
    C = c['PCX1'] * c['LCX']
    E = min(1, (c['PEX1'] + c['PEX2'] * df + c['PEX3'] * df ** 2) * (1 - c['PEX4'] * sign(k)) * c['LEX'])
    Dx = mu * fz * z[1]
    fx0 = Dx * sin(bow(Kx / (C * Dx), C, E, k)) + fade * fz * (c['PVX1'] + c['PVX2'] * df) * c['LVX'] * lx

    # lateral, at a camber
    def side(g, z):
        Ky = c['PKY1'] * f0 * (1 + c['PPY1'] * dp) * (1 - c['PKY3'] * abs(g)) * c['LKY'] * sin(
            c['PKY4'] * atan(fz / f0 / ((c['PKY2'] + c['PKY5'] * g ** 2) * (1 + c['PPY2'] * dp))))
        upright = c['PKY1'] * f0 * (1 + c['PPY1'] * dp) * c['LKY'] * sin(
            c['PKY4'] * atan(fz / f0 / (c['PKY2'] * (1 + c['PPY2'] * dp))))
        Ky *= z[3]
        svg = fz * (c['PVY3'] + c['PVY4'] * df) * g * c['LKYC'] * ly * z[2]
        sv = fz * (c['PVY1'] + c['PVY2'] * df) * c['LVY'] * ly * z[2] + svg
        sh = (c['PHY1'] + c['PHY2'] * df) * c['LHY']
        shift = 0.0
        if z[0] == 0:
            if new:
                Kg = fz * (c['PKY6'] + c['PKY7'] * df) * (1 + c['PPY5'] * dp) * c['LKYC']
            else:
                Kg = c['PHY3'] * c['LKYC'] * upright + fz * (c['PVY3'] + c['PVY4'] * df) * c['LKYC'] * ly
            C, D = c['PHYP1'], c['PHYP2'] + c['PHYP3'] * df
            shift = way * D * sin(bow(Kg / left_over / (C * D * upright), C, c['PHYP4'], t['R'] * phi))
            sh -= svg / Ky
        elif new:
            sh += (fz * (c['PKY6'] + c['PKY7'] * df) * (1 + c['PPY5'] * dp) * c['LKYC'] * g - svg) / Ky
        else:
            sh += c['PHY3'] * g * c['LKYC']
        sh, sv = fade * sh + shift, fade * sv
        mu = (c['PDY1'] + c['PDY2'] * df) * (1 - c['PDY3'] * g ** 2) * ly
        mu *= 1 + c['PPY3'] * dp + c['PPY4'] * dp ** 2
        C = c['PCY1'] * c['LCY']
        a = alpha + sh
        E = min(1, (c['PEY1'] + c['PEY2'] * df) * (
            1 + c['PEY5'] * g ** 2 - (c['PEY3'] + c['PEY4'] * g) * sign(a)) * c['LEY'])
        D = mu * fz * z[2]
        B = Ky / (C * D)
        return D * sin(bow(B, C, E, a)) + sv, Ky, B * C, mu, sh, sv

    fy0, Ky, BC, muy, sh, sv = side(gamma, z)

    # combined
    def weigh(B, C, E, x, shift):
        return cos(bow(B, C, E, x + shift)) / cos(bow(B, C, E, shift))

    gx = weigh((c['RBX1'] + c['RBX3'] * gamma ** 2) * cos(atan(c['RBX2'] * kappa)) * c['LXAL'], c['RCX1'],
               min(1, c['REX1'] + c['REX2'] * df), alpha, c['RHX1'])
    gy = weigh((c['RBY1'] + c['RBY4'] * gamma ** 2) * cos(atan(c['RBY2'] * (alpha - c['RBY3']))) * c['LYKA'],
               c['RCY1'], min(1, c['REY1'] + c['REY2'] * df), kappa, c['RHY1'] + c['RHY2'] * df)
    ply = muy * z[2] * fz * (c['RVY1'] + c['RVY2'] * df + c['RVY3'] * gamma) * cos(atan(c['RVY4'] * alpha))
    ply *= sin(c['RVY5'] * atan(c['RVY6'] * kappa)) * c['LVYKA']
    ply *= fade
    fx, fy = gx * fx0, gy * fy0 + ply

    # aligning moment
    def whole(a):
        return sign(a) * atan(sqrt(tan(a) ** 2 + (Kx / Ky * kappa) ** 2))

    at = alpha + c['QHZ1'] + c['QHZ2'] * df + (c['QHZ3'] + c['QHZ4'] * df) * gamma
    Bt = (c['QBZ1'] + c['QBZ2'] * df + c['QBZ3'] * df ** 2) * (1 + c['QBZ4'] * gamma + c['QBZ5'] * abs(gamma))
    Bt *= c['LKY'] / ly
    Dt = (c['QDZ1'] + c['QDZ2'] * df) * (1 - c['PPZ1'] * dp) * (1 + c['QDZ3'] * gamma + c['QDZ4'] * gamma ** 2)
    Dt *= fz * t['R'] / c['FNOMIN'] * c['LTR'] * z[5]
    Et = (c['QEZ1'] + c['QEZ2'] * df + c['QEZ3'] * df ** 2) * (
        1 + (c['QEZ4'] + c['QEZ5'] * gamma) * 2 / pi * atan(Bt * c['QCZ1'] * at))
    trail = Dt * cos(bow(Bt, c['QCZ1'], min(1, Et), whole(at))) * cosine
    Dr = (c['QDZ6'] + c['QDZ7'] * df) * c['LRES'] * z[2] + (
        (c['QDZ8'] + c['QDZ9'] * df) * (1 + c['PPZ2'] * dp) * gamma +
        (c['QDZ10'] + c['QDZ11'] * df) * gamma * abs(gamma)) * c['LKZC'] * z[0]
    Br = c['QBZ9'] * c['LKY'] / ly + c['QBZ10'] * BC
    Dr *= fz * t['R'] * ly * cosine
    if turn:
        most = c['QCRP1'] * muy * t['R'] * fz * sqrt(fz / f0) * c['LMP']
        C = c['QDRP1']
        D = most / sin(pi / 2 * C)
        Kz = fz * t['R'] * (c['QDZ8'] + c['QDZ9'] * df + (c['QDZ10'] + c['QDZ11'] * df) * abs(gamma)) * c['LKZC']
        Drp = D * sin(bow(Kz / left_over / (C * D), C, c['QDRP2'], t['R'] * phi))
        across = most * 2 / pi * atan(c['QCRP2'] * t['R'] * abs(phi_t)) * gy
        z[7] = 2 / pi * acos(min(1.0, across / (abs(Drp) + 1e-3)))
        Dr += Drp
        Br *= z[6]
    rest = Dr * cos(z[7] * atan(Br * whole(alpha + sh + sv / Ky)))
    arm = t['R'] * (c['SSZ1'] + c['SSZ2'] * fy / c['FNOMIN'] + (c['SSZ3'] + c['SSZ4'] * df) * gamma) * c['LS']
    mz = -trail * (gy * side(0.0, [1.0] * 8)[0] if new else fy - ply) + rest + arm * fx

    # overturning and rolling
    n = fz / c['FNOMIN']
    mx = -c['QSX2'] * gamma * (1 + c['PPMX1'] * dp) - c['QSX12'] * gamma * abs(gamma) + c['QSX3'] * fy / c['FNOMIN']
    mx += c['QSX4'] * cos(c['QSX5'] * atan((c['QSX6'] * n) ** 2)) * sin(
        c['QSX7'] * gamma + c['QSX8'] * atan(c['QSX9'] * fy / c['FNOMIN']))
    mx += c['QSX10'] * atan(c['QSX11'] * n) * gamma
    mx = t['R'] * fz * (c['QSX1'] * c['LVMX'] * (c['LMX'] if new else 1) + mx * c['LMX'])
    mx += t['R'] * fy * c['LMX'] * (c['QSX13'] + c['QSX14'] * abs(gamma))
    v = u / c['LONGVL']
    my = c['QSY1'] + c['QSY2'] * fx / c['FNOMIN'] + c['QSY3'] * abs(v) + c['QSY4'] * v ** 4
    if new:
        my += (c['QSY5'] + c['QSY6'] * n) * gamma ** 2
        my *= c['FNOMIN'] * n ** c['QSY7'] * p ** c['QSY8']
    else:
        my *= fz
    return fx, fy, mx, -t['R'] * c['LMY'] * my * rolled, mz


def magic(t, c, fz, rho, g, u, v, W, loaded, rate):
    part = c['FNOMIN'] / t['k']
    re = t['R'] * (c['QRE0'] + c['QV1'] * (W * t['R'] / c['LONGVL']) ** 2)
    re -= part * (c['DREFF'] * atan(c['BREFF'] * rho / part) + c['FREFF'] * rho / part)
    kappa, tangent = -(u - W * re) / speed(u), v / speed(u)
    turn = None if rate is None else (rate / speed(u), W * sin(g) / speed(u))
    fx, fy, mx, my, mz = pacejka(t, c, fz, kappa, atan(tangent), g, u / speed(u), u, W * re / speed(W * re), turn)
    return [fx, fy, fz, mx, my + fx * (loaded - re), mz]


def row(numbers):
    return '{' + ',\n     '.join('%.17g' % x for x in numbers) + '}'


def table(name, t, rates=None):
    print('static const double %s[TYRE_STATES][6] = {' % name)
    for state, rate in zip(STATES, rates or [None] * len(STATES)):
        print('    ' + row(forces(t, state, rate)) + ',')
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
table('tyre_mf52', MF52)
table('tyre_mf61', MF61)
print('static const double tyre_rates[TYRE_STATES] =\n    %s;' % row(RATES))
table('tyre_turning52', MF52, RATES)
table('tyre_turning61', MF61, RATES)
print('static const struct {')
print('    int at;')
print('    double value;')
print('} tyre_coefficients[] = {')
for name, value in MAGIC.items():
    print('    {SE3D_TYRE_%s, %.17g},' % (name, value))
print('};')
print('/* clang-format on */')
