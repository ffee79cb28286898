/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of a tyre in the road by physical models, with sigma = V_s / V_r, V_r the speed of
 * rolling, and f = Fz mu:
 *
 *     brush   psi = |(C_x sigma_x, C_y sigma_y)| / 3 f,   G = 1 - psi + psi^2/3 or 1/(3 psi)
 *             F = -(C_x sigma_x, C_y sigma_y) G           Mz = a/3 (1 - psi)^3 C_y sigma_y
 *     Fiala   Fx = C_x kappa or f - f^2 / (4 C_x |kappa|)
 *             Fy = -C_y tan(alpha) G(theta),  theta = C_y |tan(alpha)| / 3 f,  Mz as above
 *             mu = mu_max - (mu_max - mu_min) sqrt(kappa^2 + tan^2(alpha)), at least mu_min
 *
 * docs/theory/tyre.md */
#include "force/tyre.h"

/* G, and (1 - psi)^3 while something sticks. */
static void share(se3di_dual psi, se3di_dual *G, se3di_dual *cube)
{
    if (psi.v < 1.0) {
        const double stuck = 1.0 - psi.v;
        *G = se3di_dual_square(1.0, -1.0, 1.0 / 3.0, psi);
        *cube = se3di_dual_chain(stuck * stuck * stuck, -3.0 * stuck * stuck, psi);
    } else {
        *G = se3di_dual_chain(1.0 / (3.0 * psi.v), -1.0 / (3.0 * psi.v * psi.v), psi);
        *cube = se3di_dual_of(0.0);
    }
}

/* The resistance of rolling acts against the spin. */
static se3di_dual resist(const se3di_force *force, const se3di_tyre_slip *slip)
{
    const double f = force->tyre->rolling_resistance;
    const se3di_dual rolled = se3di_dual_sub(slip->speed, slip->slide[0]); /* spin r_e */
    const se3di_dual moment = se3di_dual_mul(slip->load, slip->rolling_radius);
    return se3di_dual_scale(-f, se3di_dual_mul(moment, se3di_dual_div(rolled, slip->roll)));
}

static se3di_dual length_of(se3di_dual x, se3di_dual y)
{
    return se3di_dual_sqrt(se3di_dual_add(se3di_dual_mul(x, x), se3di_dual_mul(y, y)));
}

void se3di_tyre_brush(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces)
{
    const se3di_tyre *tyre = force->tyre;
    const se3di_dual x = se3di_dual_scale(-tyre->slip_stiffness, slip->shear[0]);
    const se3di_dual y = se3di_dual_scale(-tyre->cornering_stiffness, slip->shear[1]);
    const se3di_dual psi =
        se3di_dual_div(length_of(x, y), se3di_dual_scale(3.0 * force->mu, slip->load));
    se3di_dual G, cube;
    share(psi, &G, &cube);
    forces->of[0] = se3di_dual_mul(x, G);
    forces->of[1] = se3di_dual_mul(y, G);
    forces->of[4] = resist(force, slip);
    forces->of[5] = se3di_dual_scale(-tyre->patch_length / 6.0, se3di_dual_mul(cube, y));
}

void se3di_tyre_fiala(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces)
{
    const se3di_tyre *tyre = force->tyre;
    const double C_x = tyre->slip_stiffness, C_y = tyre->cornering_stiffness;
    const se3di_dual whole = length_of(slip->ratio, slip->tangent);
    const double least = tyre->mu_min > 0.0 ? tyre->mu_min : force->mu;
    const se3di_dual mu =
        whole.v < 1.0 ? se3di_dual_line(force->mu, least - force->mu, whole) : se3di_dual_of(least);
    const se3di_dual f = se3di_dual_mul(mu, slip->load);
    const se3di_dual size = se3di_dual_abs(slip->ratio);
    const se3di_dual lateral = se3di_dual_scale(-C_y, slip->tangent);
    const se3di_dual theta = se3di_dual_div(se3di_dual_abs(lateral), se3di_dual_scale(3.0, f));
    se3di_dual G, cube;
    forces->of[0] = se3di_dual_scale(C_x, slip->ratio);
    if (size.v > 0.5 * f.v / C_x) {
        const se3di_dual less =
            se3di_dual_div(se3di_dual_mul(f, f), se3di_dual_scale(4.0 * C_x, size));
        forces->of[0] = se3di_dual_scale(slip->ratio.v > 0.0 ? 1.0 : -1.0, se3di_dual_sub(f, less));
    }
    share(theta, &G, &cube);
    forces->of[1] = se3di_dual_mul(lateral, G);
    forces->of[4] = resist(force, slip);
    forces->of[5] = se3di_dual_scale(-tyre->patch_length / 6.0, se3di_dual_mul(cube, lateral));
}
