/* SPDX-License-Identifier: BSD-3-Clause */
/* The Magic Formula, y = D sin(C atan(B x - E (B x - atan(B x)))), of longitudinal and lateral
 * force, with cosines of the same form for the pneumatic trail and what combined slip takes away:
 * version 5.2 (Pacejka 2002, PAC2002) and 6.1 (Besselink, Schmeitz & Pacejka 2010). Letters and
 * names of coefficients are theirs. 6.1 holds 5.2 but for
 *
 *     S_Hy     5.2: P_HY3 gamma     6.1: (K_y_gamma gamma - S_Vy_gamma) / K_y_alpha
 *     Mz       5.2: -t (Fy - S_Vyk) 6.1: -t G_yk Fy0 at gamma = 0
 *     My       5.2: Fz (...)        6.1: F0 (...) (Fz / F0)^Q_SY7 (p / p0)^Q_SY8
 *     lambda of mu in S_V           6.1: 10 lambda / (1 + 9 lambda)
 *
 * Relaxation lengths: by PTX1 ... PTY2 (5.2), else stiffness in the road over that of the carcass.
 *
 * docs/theory/tyre.md */
#include "force/tyre.h"

#define HALF_PI 1.57079632679489661923

typedef se3di_dual dual;

/* What the groups of formulas share. */
typedef struct magic {
    const double *c;         /* coefficients */
    double F0, R0, dpi;      /* nominal load, radius, dp */
    double mu_x, mu_y;       /* scales of friction */
    double shift_x, shift_y; /* of what is proportional to friction at no slip */
    int is61;
    int reserved;
    dual load, dfz, kappa, alpha, gamma;
    dual cosine;          /* of the slip angle, negative on the way back */
    dual fade;            /* of shifts: 1, at a stand 0 */
    dual K_x, K_y, mu_fz; /* dFx/dkappa, dFy/dalpha, mu_y Fz */
    dual S_Vyk;
} magic;

#define C(name) (m->c[SE3D_TYRE_##name])

/* a + b dfz */
static dual by_load(const magic *m, double a, double b)
{
    return se3di_dual_line(a, b, m->dfz);
}

/* s Fz (a + b dfz) */
static dual with_load(const magic *m, double s, double a, double b)
{
    return se3di_dual_scale(s, se3di_dual_mul(m->load, by_load(m, a, b)));
}

/* E is at most 1. */
static dual limit_curvature(dual E)
{
    return E.v > 1.0 ? se3di_dual_of(1.0) : E;
}

/* C atan(B x - E (B x - atan(B x))) */
static dual find_angle(dual B, double shape, dual E, dual x)
{
    const dual bx = se3di_dual_mul(B, x);
    const dual bend = se3di_dual_mul(E, se3di_dual_sub(bx, se3di_dual_atan(bx)));
    return se3di_dual_scale(shape, se3di_dual_atan(se3di_dual_sub(bx, bend)));
}

static double sign_of(double x)
{
    return x < 0.0 ? -1.0 : 1.0;
}

/* 1 + a dp + b dp^2 */
static double pressure(const magic *m, double a, double b)
{
    return 1.0 + (a + b * m->dpi) * m->dpi;
}

static dual clamp(dual x, double low, double high)
{
    if (low < high && x.v < low) {
        return se3di_dual_of(low);
    }
    return low < high && x.v > high ? se3di_dual_of(high) : x;
}

/* ---- Pure slip -----------------------------------------------------------------------------*/

/* dFx/dkappa */
static dual find_slip_stiffness(const magic *m)
{
    return se3di_dual_mul(with_load(m, C(LKX) * pressure(m, C(PPX1), C(PPX2)), C(PKX1), C(PKX2)),
                          se3di_dual_exp(se3di_dual_scale(C(PKX3), m->dfz)));
}

static dual find_fx0(magic *m)
{
    const dual k = se3di_dual_add(
        m->kappa, se3di_dual_mul(m->fade, by_load(m, C(LHX) * C(PHX1), C(LHX) * C(PHX2))));
    const dual camber = se3di_dual_square(1.0, 0.0, -C(PDX3) * C(LGAX) * C(LGAX), m->gamma);
    const double grip = m->mu_x * pressure(m, C(PPX3), C(PPX4));
    const dual D = se3di_dual_mul(with_load(m, grip, C(PDX1), C(PDX2)), camber);
    const dual bend = se3di_dual_square(C(PEX1), C(PEX2), C(PEX3), m->dfz);
    const dual E = limit_curvature(se3di_dual_scale((1.0 - C(PEX4) * sign_of(k.v)) * C(LEX), bend));
    const double shape = C(PCX1) * C(LCX);
    m->K_x = find_slip_stiffness(m);
    const dual B = se3di_dual_div(m->K_x, se3di_dual_scale(shape, D));
    const dual wave = se3di_dual_sin(find_angle(B, shape, E, k));
    const dual shift = se3di_dual_mul(m->fade, with_load(m, C(LVX) * m->shift_x, C(PVX1), C(PVX2)));
    return se3di_dual_add(se3di_dual_mul(D, wave), shift);
}

/* Of the lateral force: B C is dFy/dalpha over mu Fz. */
typedef struct lateral {
    dual B, K, D, S_H, S_V, force; /* K: dFy/dalpha, D: mu Fz */
} lateral;

static dual find_stiffness(const magic *m, dual g)
{
    const double base = C(PKY2) * m->F0 * pressure(m, C(PPY2), 0.0);
    const double more = C(PKY5) * m->F0 * pressure(m, C(PPY2), 0.0);
    const dual reach = se3di_dual_square(base, 0.0, more, g);
    const dual bent = se3di_dual_scale(C(PKY4), se3di_dual_atan(se3di_dual_div(m->load, reach)));
    const double size = C(PKY1) * m->F0 * C(LKY) * pressure(m, C(PPY1), 0.0);
    return se3di_dual_mul(se3di_dual_scale(size, se3di_dual_sin(bent)),
                          se3di_dual_line(1.0, -C(PKY3), se3di_dual_abs(g)));
}

/* S_Hy and S_Vy */
static void find_shifts(const magic *m, dual g, lateral *y)
{
    const dual camber = se3di_dual_mul(with_load(m, C(LKYC) * m->shift_y, C(PVY3), C(PVY4)), g);
    y->S_V = se3di_dual_add(with_load(m, C(LVY) * m->shift_y, C(PVY1), C(PVY2)), camber);
    y->S_H = by_load(m, C(LHY) * C(PHY1), C(LHY) * C(PHY2));
    if (m->is61) {
        const dual K_g = with_load(m, C(LKYC) * pressure(m, C(PPY5), 0.0), C(PKY6), C(PKY7));
        const dual thrust = se3di_dual_sub(se3di_dual_mul(K_g, g), camber);
        y->S_H = se3di_dual_add(y->S_H, se3di_dual_div(thrust, y->K));
    } else {
        y->S_H = se3di_dual_add(y->S_H, se3di_dual_scale(C(PHY3) * C(LKYC), g));
    }
    y->S_H = se3di_dual_mul(m->fade, y->S_H);
    y->S_V = se3di_dual_mul(m->fade, y->S_V);
}

static void find_fy0(const magic *m, dual gamma, lateral *y)
{
    const dual g = se3di_dual_scale(C(LGAY), gamma);
    const double shape = C(PCY1) * C(LCY);
    const double grip = m->mu_y * pressure(m, C(PPY3), C(PPY4));
    y->K = find_stiffness(m, g);
    find_shifts(m, g, y);
    const dual a = se3di_dual_add(m->alpha, y->S_H);
    y->D = se3di_dual_mul(with_load(m, grip, C(PDY1), C(PDY2)),
                          se3di_dual_square(1.0, 0.0, -C(PDY3), g));
    const double side = sign_of(a.v);
    const dual bend = se3di_dual_square(1.0 - C(PEY3) * side, -C(PEY4) * side, C(PEY5), g);
    const dual E = limit_curvature(
        se3di_dual_scale(C(LEY), se3di_dual_mul(by_load(m, C(PEY1), C(PEY2)), bend)));
    y->B = se3di_dual_div(y->K, se3di_dual_scale(shape, y->D));
    const dual wave = se3di_dual_sin(find_angle(y->B, shape, E, a));
    y->force = se3di_dual_add(se3di_dual_mul(y->D, wave), y->S_V);
}

/* ---- Combined slip -------------------------------------------------------------------------*/

/* cos(angle(x + S_H)) / cos(angle(S_H)) */
static dual weigh(dual B, double shape, dual E, dual x, dual S_H)
{
    const dual reached = se3di_dual_cos(find_angle(B, shape, E, se3di_dual_add(x, S_H)));
    return se3di_dual_div(reached, se3di_dual_cos(find_angle(B, shape, E, S_H)));
}

/* (a + b gamma^2) cos(atan(s x)) scale */
static dual find_slope(const magic *m, double a, double b, dual sx, double scale)
{
    const dual size = se3di_dual_square(scale * a, 0.0, scale * b, m->gamma);
    return se3di_dual_mul(size, se3di_dual_cos(se3di_dual_atan(sx)));
}

static dual weigh_fx(const magic *m)
{
    const dual B = find_slope(m, C(RBX1), C(RBX3), se3di_dual_scale(C(RBX2), m->kappa), C(LXAL));
    const dual E = limit_curvature(by_load(m, C(REX1), C(REX2)));
    return weigh(B, C(RCX1), E, m->alpha, se3di_dual_of(C(RHX1)));
}

static dual weigh_fy(const magic *m)
{
    const dual turned = se3di_dual_line(-C(RBY2) * C(RBY3), C(RBY2), m->alpha);
    const dual B = find_slope(m, C(RBY1), C(RBY4), turned, C(LYKA));
    const dual E = limit_curvature(by_load(m, C(REY1), C(REY2)));
    return weigh(B, C(RCY1), E, m->kappa, by_load(m, C(RHY1), C(RHY2)));
}

/* S_Vyk: what kappa adds to the lateral force. */
static dual find_ply(const magic *m)
{
    const dual part =
        se3di_dual_add(by_load(m, C(RVY1), C(RVY2)), se3di_dual_scale(C(RVY3), m->gamma));
    const dual D =
        se3di_dual_mul(se3di_dual_mul(m->mu_fz, part),
                       se3di_dual_cos(se3di_dual_atan(se3di_dual_scale(C(RVY4), m->alpha))));
    const dual turn = se3di_dual_atan(se3di_dual_scale(C(RVY6), m->kappa));
    const dual wave = se3di_dual_sin(se3di_dual_scale(C(RVY5), turn));
    return se3di_dual_scale(C(LVYKA), se3di_dual_mul(m->fade, se3di_dual_mul(D, wave)));
}

/* ---- Moments -------------------------------------------------------------------------------*/

/* atan(sqrt(tan^2 a + (K_x kappa / K_y)^2)) with the sign of a */
static dual find_whole(const magic *m, dual a)
{
    const dual tangent = se3di_dual_div(se3di_dual_sin(a), se3di_dual_cos(a));
    const dual other = se3di_dual_div(se3di_dual_mul(m->K_x, m->kappa), m->K_y);
    const dual sum = se3di_dual_add(se3di_dual_mul(tangent, tangent), se3di_dual_mul(other, other));
    return se3di_dual_scale(sign_of(a.v), se3di_dual_atan(se3di_dual_sqrt(sum)));
}

static dual find_trail(const magic *m, dual g)
{
    const dual shift = se3di_dual_add(by_load(m, C(QHZ1), C(QHZ2)),
                                      se3di_dual_mul(by_load(m, C(QHZ3), C(QHZ4)), g));
    const dual a = se3di_dual_add(m->alpha, shift);
    const dual size = se3di_dual_abs(g);
    const dual leaning =
        se3di_dual_add(se3di_dual_line(1.0, C(QBZ4), g), se3di_dual_scale(C(QBZ5), size));
    const dual B = se3di_dual_scale(
        C(LKY) / m->mu_y,
        se3di_dual_mul(se3di_dual_square(C(QBZ1), C(QBZ2), C(QBZ3), m->dfz), leaning));
    const double arm = m->R0 / C(FNOMIN) * C(LTR) * (1.0 - C(PPZ1) * m->dpi);
    const dual D = se3di_dual_mul(with_load(m, arm, C(QDZ1), C(QDZ2)),
                                  se3di_dual_square(1.0, C(QDZ3), C(QDZ4), g));
    const dual bent = se3di_dual_atan(se3di_dual_scale(C(QCZ1), se3di_dual_mul(B, a)));
    const dual lean = se3di_dual_line(C(QEZ4), C(QEZ5), g);
    const dual curve = se3di_dual_line(1.0, 1.0 / HALF_PI, se3di_dual_mul(lean, bent));
    const dual E = limit_curvature(
        se3di_dual_mul(se3di_dual_square(C(QEZ1), C(QEZ2), C(QEZ3), m->dfz), curve));
    const dual wave = se3di_dual_cos(find_angle(B, C(QCZ1), E, find_whole(m, a)));
    return se3di_dual_mul(se3di_dual_mul(D, wave), m->cosine);
}

/* Mzr */
static dual find_residual(const magic *m, const lateral *y, dual g)
{
    const dual a = se3di_dual_add(m->alpha, se3di_dual_add(y->S_H, se3di_dual_div(y->S_V, y->K)));
    const dual B = se3di_dual_line(C(QBZ9) * C(LKY) / m->mu_y, C(QBZ10) * C(PCY1) * C(LCY), y->B);
    const dual lean =
        se3di_dual_add(se3di_dual_scale(1.0 + C(PPZ2) * m->dpi, by_load(m, C(QDZ8), C(QDZ9))),
                       se3di_dual_mul(by_load(m, C(QDZ10), C(QDZ11)), se3di_dual_abs(g)));
    const dual part = se3di_dual_add(by_load(m, C(LRES) * C(QDZ6), C(LRES) * C(QDZ7)),
                                     se3di_dual_scale(C(LKZC), se3di_dual_mul(lean, g)));
    const dual D = se3di_dual_mul(se3di_dual_scale(m->R0 * m->mu_y, m->load), part);
    const dual turn = se3di_dual_atan(se3di_dual_mul(B, find_whole(m, a)));
    return se3di_dual_mul(se3di_dual_mul(D, se3di_dual_cos(turn)), m->cosine);
}

static dual find_mz(const magic *m, const lateral *y, const dual of[6])
{
    const dual g = se3di_dual_scale(C(LGAZ), m->gamma);
    dual force = se3di_dual_sub(of[1], m->S_Vyk);
    if (m->is61) {
        lateral upright;
        find_fy0(m, se3di_dual_of(0.0), &upright);
        force = se3di_dual_mul(weigh_fy(m), upright.force);
    }
    const dual moment =
        se3di_dual_sub(find_residual(m, y, g), se3di_dual_mul(find_trail(m, g), force));
    const dual lean = se3di_dual_mul(by_load(m, C(SSZ3), C(SSZ4)), m->gamma);
    const dual arm = se3di_dual_add(se3di_dual_line(C(SSZ1), C(SSZ2) / C(FNOMIN), of[1]), lean);
    return se3di_dual_add(moment, se3di_dual_scale(m->R0 * C(LS), se3di_dual_mul(arm, of[0])));
}

static dual find_mx(const magic *m, dual fy)
{
    const dual ratio = se3di_dual_scale(1.0 / C(FNOMIN), m->load);
    const dual side = se3di_dual_scale(1.0 / C(FNOMIN), fy), g = m->gamma;
    const dual size = se3di_dual_abs(g);
    const dual square = se3di_dual_square(0.0, 0.0, C(QSX6) * C(QSX6), ratio);
    const dual mixed = se3di_dual_mul(
        se3di_dual_cos(se3di_dual_scale(C(QSX5), se3di_dual_atan(square))),
        se3di_dual_sin(se3di_dual_add(
            se3di_dual_scale(C(QSX7), g),
            se3di_dual_scale(C(QSX8), se3di_dual_atan(se3di_dual_scale(C(QSX9), side))))));
    const dual upon =
        se3di_dual_scale(C(QSX10), se3di_dual_atan(se3di_dual_scale(C(QSX11), ratio)));
    const dual lean = se3di_dual_add(
        se3di_dual_line(-C(QSX2) * (1.0 + C(PPMX1) * m->dpi), -C(QSX12), size), upon);
    const double first = C(QSX1) * C(LVMX) * (m->is61 ? C(LMX) : 1.0);
    const dual rest =
        se3di_dual_add(se3di_dual_add(se3di_dual_mul(lean, g), se3di_dual_scale(C(QSX3), side)),
                       se3di_dual_scale(C(QSX4), mixed));
    const dual by_fz = se3di_dual_mul(m->load, se3di_dual_line(first, C(LMX), rest));
    const dual by_fy =
        se3di_dual_mul(fy, se3di_dual_line(C(LMX) * C(QSX13), C(LMX) * C(QSX14), size));
    return se3di_dual_scale(m->R0, se3di_dual_add(by_fz, by_fy));
}

/* Against the spin. */
static dual find_my(const magic *m, const se3di_tyre_slip *slip, dual fx)
{
    const dual v = se3di_dual_scale(1.0 / C(LONGVL), slip->speed);
    const dual square = se3di_dual_mul(v, v);
    const dual rolled = se3di_dual_sub(slip->speed, slip->slide[0]);
    dual sum = se3di_dual_line(C(QSY1), C(QSY2) / C(FNOMIN), fx);
    sum = se3di_dual_add(sum, se3di_dual_scale(C(QSY3), se3di_dual_abs(v)));
    sum = se3di_dual_add(sum, se3di_dual_scale(C(QSY4), se3di_dual_mul(square, square)));
    dual load = m->load;
    if (m->is61) {
        const dual lean = se3di_dual_line(C(QSY5), C(QSY6) / C(FNOMIN), m->load);
        sum = se3di_dual_add(sum, se3di_dual_mul(lean, se3di_dual_mul(m->gamma, m->gamma)));
        const double exponent = C(QSY7), ratio = m->load.v / C(FNOMIN);
        const double size =
            C(FNOMIN) * se3di_pow(1.0 + m->dpi, C(QSY8)) * se3di_pow(ratio, exponent);
        load = se3di_dual_chain(size, exponent * size / m->load.v, m->load);
    }
    const dual way = se3di_dual_div(rolled, slip->roll);
    return se3di_dual_scale(-m->R0 * C(LMY), se3di_dual_mul(way, se3di_dual_mul(load, sum)));
}

/* ---- All of it -----------------------------------------------------------------------------*/

/* lambda, or lambda' of 6.1, by which shifts follow friction. */
static double degrade(const magic *m, double lambda)
{
    return m->is61 ? 10.0 * lambda / (1.0 + 9.0 * lambda) : lambda;
}

static dual limit_angle(dual x, double low, double high)
{
    return clamp(se3di_dual_atan(x), low, high);
}

static void prepare(const se3di_force *force, const se3di_tyre_slip *slip, magic *m)
{
    const double *c = force->tyre->coefficients;
    m->c = c;
    m->is61 = force->tyre->law == SE3D_TYRE_MF61;
    m->R0 = force->rest;
    m->F0 = C(FNOMIN) * C(LFZO);
    m->dpi = C(NOMPRES) > 0.0 && C(INFLPRES) > 0.0 ? C(INFLPRES) / C(NOMPRES) - 1.0 : 0.0;
    m->mu_x = force->mu * C(LMUX);
    m->mu_y = force->mu * C(LMUY);
    m->shift_x = degrade(m, m->mu_x);
    m->shift_y = degrade(m, m->mu_y);
    m->load = slip->load;
    if (C(FZMIN) > 0.0 && m->load.v < C(FZMIN)) {
        m->load = se3di_dual_of(C(FZMIN));
    } else if (C(FZMAX) > 0.0 && m->load.v > C(FZMAX)) {
        m->load = se3di_dual_of(C(FZMAX));
    }
    m->fade = se3di_dual_mul(slip->way, slip->way);
    m->dfz = se3di_dual_line(-1.0, 1.0 / m->F0, m->load);
    m->kappa = clamp(slip->ratio, C(KPUMIN), C(KPUMAX));
    m->alpha = limit_angle(slip->tangent, C(ALPMIN), C(ALPMAX));
    const double sine = fmax(-1.0, fmin(1.0, slip->sine.v)); /* not 1: it would not touch */
    m->gamma = clamp(se3di_dual_chain(se3di_asin(sine), 1.0 / sqrt(1.0 - sine * sine), slip->sine),
                     C(CAMMIN), C(CAMMAX));
    m->cosine = se3di_dual_mul(slip->way, se3di_dual_cos(se3di_dual_atan(slip->tangent)));
}

void se3di_tyre_magic(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces)
{
    magic m;
    lateral y;
    dual *of = forces->of;
    prepare(force, slip, &m);
    const dual fx0 = find_fx0(&m);
    find_fy0(&m, m.gamma, &y);
    m.K_y = y.K;
    m.mu_fz = y.D;
    m.S_Vyk = find_ply(&m);
    of[0] = se3di_dual_mul(weigh_fx(&m), fx0);
    of[1] = se3di_dual_add(se3di_dual_mul(weigh_fy(&m), y.force), m.S_Vyk);
    of[3] = find_mx(&m, of[1]);
    of[4] = find_my(&m, slip, of[0]);
    of[5] = find_mz(&m, &y, of);
    if (slip->load.v < m.load.v) { /* below FZMIN: in proportion */
        const dual part = se3di_dual_scale(1.0 / m.load.v, slip->load);
        for (int k = 0; k < 6; ++k) {
            of[k] = k == 2 ? of[k] : se3di_dual_mul(part, of[k]);
        }
    }
}

/* ---- Relaxation lengths --------------------------------------------------------------------*/

/* A stiffness of the carcass [N/m]. */
static dual find_carcass(const magic *m, double stiffness, const double by[3])
{
    return se3di_dual_square(stiffness * (1.0 + by[2] * m->dpi),
                             stiffness * by[0] * (1.0 + by[2] * m->dpi),
                             stiffness * by[1] * (1.0 + by[2] * m->dpi), m->dfz);
}

static dual find_relaxation_x(const magic *m)
{
    if (fabs(C(PTX1)) > 0.0) {
        const dual fall = se3di_dual_exp(se3di_dual_scale(-C(PTX3), m->dfz));
        return se3di_dual_mul(with_load(m, m->R0 / C(FNOMIN) * C(LSGKP), C(PTX1), C(PTX2)), fall);
    }
    return se3di_dual_div(find_slip_stiffness(m),
                          find_carcass(m, C(LONGITUDINAL_STIFFNESS), &C(PCFX1)));
}

static dual find_relaxation_y(const magic *m)
{
    const dual g = se3di_dual_scale(C(LGAY), m->gamma);
    if (fabs(C(PTY1)) > 0.0) {
        const dual reach = se3di_dual_atan(se3di_dual_scale(1.0 / (C(PTY2) * m->F0), m->load));
        const dual bent = se3di_dual_sin(se3di_dual_scale(2.0, reach));
        const double size = C(PTY1) * m->R0 * C(LFZO) * C(LSGAL);
        return se3di_dual_mul(se3di_dual_scale(size, bent),
                              se3di_dual_line(1.0, -C(PKY3), se3di_dual_abs(g)));
    }
    return se3di_dual_div(se3di_dual_abs(find_stiffness(m, g)),
                          find_carcass(m, C(LATERAL_STIFFNESS), &C(PCFY1)));
}

void se3di_tyre_magic_relaxation(const se3di_force *force, const se3di_tyre_slip *slip,
                                 dual length[2])
{
    magic m;
    prepare(force, slip, &m);
    length[0] = find_relaxation_x(&m);
    length[1] = find_relaxation_y(&m);
}

dual se3di_tyre_magic_radius(const se3di_force *force, dual deflection, dual spin)
{
    const magic only = {.c = force->tyre->coefficients}, *m = &only;
    const double static_part = C(FNOMIN) / force->k, growth = force->rest / C(LONGVL);
    const dual rho = se3di_dual_scale(1.0 / static_part, deflection);
    const dual free =
        se3di_dual_square(force->rest * C(QRE0), 0.0, force->rest * C(QV1) * growth * growth, spin);
    if (!(fabs(C(DREFF)) > 0.0 || fabs(C(FREFF)) > 0.0)) {
        return se3di_dual_sub(free, se3di_dual_scale(1.0 / 3.0, deflection));
    }
    const dual bent = se3di_dual_atan(se3di_dual_scale(C(BREFF), rho));
    const dual sunk =
        se3di_dual_add(se3di_dual_scale(C(DREFF), bent), se3di_dual_scale(C(FREFF), rho));
    return se3di_dual_sub(free, se3di_dual_scale(static_part, sunk));
}
