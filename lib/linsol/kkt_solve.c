/* SPDX-License-Identifier: BSD-3-Clause */
/* Factorisation with the regularisation that the system needs, and iterative refinement.
 *
 * E = eps w: uniform, w the geometric mean of the smallest and largest diag(C H^-1 B), so that the
 * limit of the refined multipliers is the solution of least 2-norm; only a row whose own weight is
 * more than 1e4 away from w gets a nearer E. The rounding of c is amplified by 1 / eps in the
 * dependent directions of l; solving with the right-hand side (0, -E l) gives just that part, which
 * is subtracted.                                                             docs/theory/kkt.md */
#include <math.h>

#include "linsol/kkt_internal.h"

static const double pivot_vanishes = 1e-12; /* relative; then E = 0 is given up */
static const double pivot_is_good = 1e-4;   /* relative; then a solve with E = 0 needs no check */
static const double pivot_is_safe = 1e-11;  /* the same if bodies go before their joints */
static const double row_rounding = 4e-16;   /* of the terms of a row */
static const double noise_matters = 1e3;    /* times the tolerance of solutions: rounding / pivot */
static const double part_noise = 1e-14;     /* of multipliers, in the dependent directions */
static const double raised_residual = 1e-9; /* of forces, with bodies that are raised */
static const int32_t raised_refinements = 12;
static const double wide_eps = 1e-7; /* where rows are known to be redundant */
static const double stays = 1.01;    /* a residual, from a refinement to the next */

/* ---- factor ---- */

static double middle_weight(se3di_kkt *kkt)
{
    double low = HUGE_VAL, high = 0.0;
    kkt->has_zero_weight = false;
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        double w = kkt->weight[i];
        kkt->has_zero_weight = kkt->has_zero_weight || !(w > 0.0);
        low = w > 0.0 && w < low ? w : low;
        high = w > high ? w : high;
    }
    return high > 0.0 && high < HUGE_VAL ? sqrt(low) * sqrt(high) : 1.0;
}

static void weigh(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    for (size_t i = 0; values->weight && i < kkt->layout.row_count; ++i) {
        kkt->weight[i] = values->weight[i];
    }
    if (!values->weight) {
        kkt->core->weigh(kkt, values);
    }
    kkt->middle = middle_weight(kkt);
}

/* (b, c) in the caller's order into kkt->z in the order of elimination; gather: back. */
static void scatter(se3di_kkt *kkt, const double *b, const double *c)
{
    int32_t n = kkt->pattern.body_size, bodies = (int32_t)kkt->pattern.body_count;
    for (int32_t node = 0; node < kkt->node_count; ++node) {
        double *z = kkt->z + (size_t)kkt->position_of[node] * KKT_LANES;
        const double *from = b ? b + (size_t)node * (size_t)n : NULL;
        if (node >= bodies) {
            from = c ? c + kkt->row_offset[kkt->node_joint[node]] + kkt->node_row[node] : NULL;
        }
        for (int32_t r = 0; r < KKT_LANES; ++r) {
            z[r] = from && r < kkt->node_size[node] ? from[r] : 0.0;
        }
    }
}

/* E = eps w */
static void set_regularisation(se3di_kkt *kkt, double eps)
{
    if (!(eps > 0.0) && !(kkt->eps > 0.0)) { /* it was zero already, as when it was allocated */
        return;
    }
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        double w = kkt->weight[i], e = kkt->middle;
        if (w > 0.0) {
            e = e < w / SE3DI_KKT_WEIGHT_RANGE ? w / SE3DI_KKT_WEIGHT_RANGE : e;
            e = e > w * SE3DI_KKT_WEIGHT_RANGE ? w * SE3DI_KKT_WEIGHT_RANGE : e;
        }
        kkt->e[i] = eps * e;
    }
}

/* `again`: after a factorisation of the same values with a larger eps > 0. */
static void factor_once(se3di_kkt *kkt, const se3di_kkt_values *values, double eps, bool again)
{
    set_regularisation(kkt, eps);
    /* the pivot of a dependent row is proportional to eps, another one is not */
    kkt->ratio_bound = again && kkt->has_ratio ? 30.0 * eps / kkt->eps : 0.0;
    kkt->eps = eps;
    kkt->finite = true;
    kkt->min_pivot = kkt->min_sigma = kkt->least_clear = 1.0;
    kkt->dependent_rows = kkt->near_dependent = kkt->negative_pivots = kkt->positive_rows = 0;
    kkt->far_rows = 0;
    kkt->least_far = 1.0;
    ++kkt->factorisations;
    if (kkt->kind == SE3DI_KKT_DENSE) {
        se3di_kkt_dense_factor(kkt, values);
    } else {
        if (kkt->expected) {
            scatter(kkt, kkt->expected, kkt->expected_c);
        }
        kkt->core->factor(kkt, values);
    }
}

static bool plain_is_enough(const se3di_kkt *kkt)
{
    return kkt->finite && kkt->dependent_rows == 0 && kkt->min_pivot >= pivot_vanishes;
}

/* If eps stays what it is, nearly dependent rows are filtered: part of what they ask for, by
 * eps / sigma and the count of refinements, is left out. The count must then not hang on how fast
 * the residual falls, or the solution would jump where that passes the bound. */
static bool is_filter(const se3di_kkt_settings *s)
{
    return s->eps_min >= s->eps;
}

/* Rows that depend on the others only where loops are closed are independent, by the square of the
 * gap, in the stages of an explicit method, which are a little open. What they then ask for is not
 * the motion: a wider filter leaves it out, if all other rows are far from dependent. */
static bool may_widen(const se3di_kkt *kkt)
{
    const se3di_kkt_settings *s = &kkt->settings;
    const bool is_known =
        s->redundant_rows > 0 && s->redundant_rows < (int32_t)kkt->layout.row_count;
    return s->wide && is_known && is_filter(s) && s->eps < wide_eps &&
           kkt->kind == SE3DI_KKT_STRUCTURED;
}

/* Returns whether all rows but those known to be redundant are far from dependent. */
static bool factor_widely(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    factor_once(kkt, values, wide_eps, false);
    const int32_t rest = (int32_t)kkt->layout.row_count - kkt->far_rows;
    if (!kkt->finite || !kkt->has_ratio || rest > kkt->settings.redundant_rows) {
        return false;
    }
    kkt->dependent_rows = rest;
    kkt->near_dependent = 0;
    kkt->least_clear = kkt->least_far;
    return true;
}

/* Whether E = 0 is tried first. */
static bool begins_plainly(const se3di_kkt *kkt)
{
    const se3di_kkt_settings *s = &kkt->settings;
    const bool late = s->regularise == SE3DI_KKT_REGULARISE_LATE ||
                      (s->regularise == SE3DI_KKT_REGULARISE_AUTO && !kkt->has_loop);
    return late && kkt->kind == SE3DI_KKT_STRUCTURED;
}

double se3di_kkt_first_eps(const se3di_kkt *kkt)
{
    return begins_plainly(kkt) ? 0.0 : may_widen(kkt) ? -1.0 : kkt->settings.eps;
}

static void factor_suitably(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    const se3di_kkt_settings *s = &kkt->settings;
    if (begins_plainly(kkt)) {
        factor_once(kkt, values, 0.0, false);
        if (plain_is_enough(kkt)) {
            return;
        }
    }
    const bool widens = may_widen(kkt);
    if (widens && factor_widely(kkt, values)) {
        return;
    }
    factor_once(kkt, values, s->eps, widens);
    if (!kkt->finite || kkt->near_dependent == 0 || kkt->min_sigma > 1e3 * s->eps) {
        return;
    }
    /* Nearly dependent rows: refinement gains eps / (eps + sigma) a step, rounding u / eps. */
    double eps = sqrt(kkt->min_sigma * 2.2e-16);
    eps = eps < s->eps_min ? s->eps_min : eps;
    if (eps < 0.5 * s->eps) {
        factor_once(kkt, values, eps, true);
    }
}

static bool all_finite(const double *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(values[i])) {
            return false;
        }
    }
    return true;
}

static bool values_are_finite(const se3di_kkt *kkt, const se3di_kkt_values *v)
{
    const se3di_kkt_pattern *p = &kkt->pattern;
    size_t block = (size_t)(p->body_size * p->body_size);
    bool finite = all_finite(v->body, p->body_count * block) &&
                  all_finite(v->coupling_upper, p->coupling_count * block) &&
                  all_finite(v->joint, kkt->layout.joint_value_count);
    if (finite && !p->symmetric) {
        finite = all_finite(v->coupling_lower, p->coupling_count * block) &&
                 all_finite(v->joint_b, kkt->layout.joint_value_count);
    }
    return finite;
}

void se3di_kkt_hold(se3di_kkt *kkt, bool hold)
{
    kkt->hold = hold ? KKT_HOLD_NEXT : KKT_FREE;
}

void se3di_kkt_expect(se3di_kkt *kkt, const double *b, const double *c)
{
    /* symmetric blocks of r-p shift the right-hand side: these solve in one go */
    bool fits = !(kkt->pattern.symmetric && kkt->pattern.body_size == 8) &&
                kkt->kind == SE3DI_KKT_STRUCTURED;
    kkt->expected = fits ? b : NULL;
    kkt->expected_c = c;
}

/* Some row that is not known to be redundant seems to be nearly dependent. */
static bool has_doubtful_row(const se3di_kkt *kkt)
{
    return !kkt->finite || kkt->near_dependent > 0 ||
           kkt->dependent_rows > kkt->settings.redundant_rows;
}

/* If light bodies may be why, factor with heavier ones. */
static void factor_raised(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    se3di_kkt_values raised;
    const kkt_hold hold = kkt->hold;
    if (kkt->kind != SE3DI_KKT_STRUCTURED || values->weight || !has_doubtful_row(kkt) ||
        !se3di_kkt_has_light(kkt) || !se3di_kkt_raise(kkt, values, &raised)) {
        return;
    }
    kkt->hold = KKT_FREE;
    weigh(kkt, &raised);
    factor_suitably(kkt, &raised);
    kkt->is_raised = true;
    kkt->hold = hold == KKT_FREE ? KKT_FREE : KKT_HOLD_NEXT; /* these are not kept */
}

/* Factor the caller's values, whatever they are. */
static void factor_given(se3di_kkt *kkt, const se3di_kkt_values *values)
{
    kkt->is_raised = false;
    if (kkt->hold != KKT_HELD) {
        weigh(kkt, values);
    }
    factor_suitably(kkt, values);
    kkt->hold = kkt->hold != KKT_FREE && kkt->finite ? KKT_HELD : kkt->hold;
}

se3d_status se3di_kkt_factor(se3di_kkt *kkt, const se3di_kkt_values *values,
                             se3di_kkt_factor_info *info)
{
    kkt->factorisations = 0;
    factor_given(kkt, values);
    factor_raised(kkt, values);
    if (info) {
        *info =
            (se3di_kkt_factor_info){.factorisations = kkt->factorisations,
                                    .dependent_rows = kkt->dependent_rows,
                                    .near_dependent = kkt->near_dependent,
                                    .negative_pivots = kkt->negative_pivots,
                                    .negative_freedoms = kkt->negative_pivots - kkt->positive_rows,
                                    .eps = kkt->eps,
                                    .min_pivot = kkt->min_pivot};
    }
    if (!kkt->finite) {
        kkt->expected = NULL;
        return values_are_finite(kkt, values) ? SE3D_ERR_SINGULAR : SE3D_ERR_NOT_FINITE;
    }
    return kkt->dependent_rows > 0 ? SE3D_INFO_REDUNDANT : SE3D_OK;
}

/* ---- solve ---- */

static void gather(const se3di_kkt *kkt, double *x, double *l)
{
    int32_t n = kkt->pattern.body_size, bodies = (int32_t)kkt->pattern.body_count;
    for (int32_t node = 0; node < kkt->node_count; ++node) {
        const double *z = kkt->z + (size_t)kkt->position_of[node] * KKT_LANES;
        double *to = x + (size_t)node * (size_t)n;
        if (node >= bodies) {
            to = l + kkt->row_offset[kkt->node_joint[node]] + kkt->node_row[node];
        }
        for (int32_t r = 0; r < kkt->node_size[node]; ++r) {
            to[r] = z[r];
        }
    }
}

/* One solve with the factored, regularised system. b or c may be NULL for zero. */
static void solve_once(se3di_kkt *kkt, const double *b, const double *c, double *x, double *l)
{
    if (kkt->kind == SE3DI_KKT_DENSE) {
        se3di_kkt_dense_solve(kkt, b, c, x, l);
        return;
    }
    scatter(kkt, b, c);
    kkt->core->solve(kkt);
    gather(kkt, x, l);
}

/* The same for the first right-hand side after a factorisation, which may have been expected. */
static void solve_first(se3di_kkt *kkt, const double *b, const double *c, double *x, double *l)
{
    if (kkt->expected && kkt->expected == b && kkt->expected_c == c) {
        kkt->core->solve(kkt);
        gather(kkt, x, l);
        kkt->expected = NULL;
    } else {
        kkt->expected = NULL;
        solve_once(kkt, b, c, x, l);
    }
}

static double largest_entry(const double *v, size_t count)
{
    double top = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double size = fabs(v[i]);
        top = size > top || !(size <= HUGE_VAL) ? size : top; /* NaN stays */
    }
    return top;
}

/* The larger of both relative residuals. */
static double measure(se3di_kkt *kkt, se3di_kkt_solve_info *info)
{
    double b = largest_entry(kkt->residual_b, kkt->layout.unknown_count);
    double c = largest_entry(kkt->residual_c, kkt->layout.row_count);
    info->residual_b = b > 0.0 ? b / kkt->scale_b : b;
    info->residual_c = c > 0.0 ? c / kkt->scale_c : c;
    info->checked = true;
    return info->residual_b >= info->residual_c ? info->residual_b : info->residual_c;
}

static void add_correction(se3di_kkt *kkt, double sign, double *x, double *l)
{
    for (size_t i = 0; i < kkt->layout.unknown_count; ++i) {
        x[i] += sign * kkt->correction_x[i];
    }
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        l[i] += sign * kkt->correction_l[i];
    }
}

typedef struct kkt_problem {
    const se3di_kkt_values *values;
    const double *b, *c;
} kkt_problem;

typedef enum kkt_ending { KKT_CONVERGED, KKT_STAGNATED, KKT_EXHAUSTED } kkt_ending;

/* The largest term C_rc x_c of the motion that b would make without constraints. Rounding of x is
 * of its size where they hold nearly all of it: at rest, or in steady motion. */
static double find_unheld(const se3di_kkt *kkt, const kkt_problem *p)
{
    const se3di_kkt_pattern *pattern = &kkt->pattern;
    const size_t n = (size_t)pattern->body_size;
    double top = 0.0;
    for (size_t j = 0; j < pattern->joint_count; ++j) {
        const size_t rows = (size_t)pattern->joint_rows[j];
        for (int32_t e = pattern->joint_begin[j]; e < pattern->joint_begin[j + 1]; ++e) {
            const size_t body = (size_t)pattern->joint_body[e];
            const double *C = p->values->joint + kkt->block_offset[e];
            const double *b = p->b + body * n, *mobility = kkt->mobility + body * KKT_LANES;
            for (size_t k = 0; k < rows * n; ++k) {
                top = fmax(top, fabs(C[k] * mobility[k % n] * b[k % n]));
            }
        }
    }
    return top;
}

/* What is left of the rows is rounding: that of the motion that they hold, and no part of what a
 * filter leaves out. Another solution would only replace it by other rounding. */
static bool is_rounding(const se3di_kkt *kkt, const kkt_problem *p,
                        const se3di_kkt_solve_info *info)
{
    return is_filter(&kkt->settings) && !kkt->settings.iterated && p->b && !p->values->weight &&
           !(info->residual_b > kkt->settings.tolerance) &&
           info->residual_c * kkt->scale_c <= row_rounding * find_unheld(kkt, p);
}

/* Rows that are known to be redundant contradict each other by the rounding of c at least, and keep
 * that residual, up or down by its own rounding. The last refinement took its part of the others
 * all the same: without it, now and then, a filter would leave much more than it does. */
static bool keeps_last(const se3di_kkt *kkt, double before, double now)
{
    const bool is_known = kkt->near_dependent == 0 && kkt->dependent_rows > 0 &&
                          kkt->dependent_rows <= kkt->settings.redundant_rows;
    return is_known && is_filter(&kkt->settings) && now > before && now < stays * before;
}

/* Refine until the residual is small or no longer falls. */
static kkt_ending refine(se3di_kkt *kkt, const kkt_problem *p, double *x, double *l,
                         se3di_kkt_solve_info *info)
{
    double before = 0.0;
    for (int32_t step = 0;; ++step) {
        kkt->core->residual(kkt, p->values, p->b, p->c, x, l);
        se3di_kkt_solve_info previous = *info;
        double now = measure(kkt, info);
        if (step > 0) {
            info->rate = before > 0.0 ? now / before : 0.0;
        }
        if (!(now > kkt->settings.tolerance) || is_rounding(kkt, p, info)) {
            return KKT_CONVERGED;
        }
        if (step > 0 && keeps_last(kkt, before, now)) {
            return KKT_STAGNATED;
        }
        if (step > 0 && now > before) { /* take back what made it worse */
            add_correction(kkt, -1.0, x, l);
            info->residual_b = previous.residual_b;
            info->residual_c = previous.residual_c;
            return KKT_STAGNATED;
        }
        if (step > 1 && info->rate > 0.3 && !is_filter(&kkt->settings)) {
            return KKT_STAGNATED;
        }
        if (info->refinements >= kkt->settings.max_refinements) {
            return KKT_EXHAUSTED;
        }
        solve_once(kkt, kkt->residual_b, kkt->residual_c, kkt->correction_x, kkt->correction_l);
        add_correction(kkt, 1.0, x, l);
        ++info->refinements;
        before = now;
    }
}

/* Those of joints without bodies, which no solution touches. */
static void clear_multipliers(se3di_kkt *kkt, double *l)
{
    for (size_t i = 0; i < kkt->layout.row_count && kkt->has_unbound; ++i) {
        l[i] = kkt->correction_l[i] = 0.0;
    }
}

/* With the factors of raised bodies, until forces balance: rows may contradict each other. Returns
 * whether they do; else the caller's values are factored, if they can be. */
static bool refine_raised(se3di_kkt *kkt, const kkt_problem *p, double *x, double *l,
                          se3di_kkt_solve_info *info)
{
    const double least = fmin(kkt->settings.tolerance, raised_residual);
    double size = 0.0, before = HUGE_VAL, before_c = HUGE_VAL, scale = 0.0;
    for (int32_t step = 0;; ++step) {
        kkt->core->residual(kkt, p->values, p->b, p->c, x, l);
        (void)measure(kkt, info);
        size = info->residual_b * kkt->scale_b;
        scale = fmax(scale, kkt->scale_b);
        if (!(info->residual_b > least) || size > 0.3 * before || step == raised_refinements) {
            break;
        }
        /* what rows contradict each other by would only raise their multipliers */
        const bool falls = info->residual_c < 0.3 * before_c;
        before = size;
        before_c = info->residual_c;
        solve_once(kkt, kkt->residual_b, falls ? kkt->residual_c : NULL, kkt->correction_x,
                   kkt->correction_l);
        add_correction(kkt, 1.0, x, l);
        ++info->refinements;
    }
    /* that of the multipliers at first, which heavier bodies take: their rounding is left */
    info->residual_b = scale > 0.0 ? size / scale : info->residual_b;
    if (info->residual_b <= raised_residual) {
        return true;
    }
    factor_given(kkt, p->values);
    return false;
}

/* Above it a solution with E = 0 needs no check. */
static double least_good_pivot(const se3di_kkt *kkt)
{
    const se3di_kkt_settings *s = &kkt->settings;
    if (s->iterated) {
        return pivot_is_safe;
    }
    if (!kkt->bodies_first || !kkt->pattern.symmetric) {
        return pivot_is_good;
    }
    return fmin(pivot_is_good, fmax(pivot_is_safe, 2.2e-16 / (noise_matters * s->tolerance)));
}

/* How many refinements reach the tolerance for certain, -1 if only a look at the residual can
 * tell. With E = 0 and bodies before their joints, S = C H^-1 C^T is factored as Cholesky does: the
 * residual of l is at rounding whatever the pivots, that of x at rounding / pivot if C^T l
 * nearly cancels (a lever that is long beside the radius of gyration). With E > 0 a solution leaves
 * eps / sigma of the error. A row that is not known to be redundant and seems dependent is nearly
 * so: sigma is small. */
int32_t se3di_kkt_count_refinements(const se3di_kkt *kkt, const se3di_kkt_pivots *pivots)
{
    const se3di_kkt_settings *s = &kkt->settings;
    if (s->always_check || pivots->negative > 0 || kkt->kind == SE3DI_KKT_DENSE) {
        return -1;
    }
    if (!(pivots->eps > 0.0)) {
        return pivots->least > least_good_pivot(kkt) ? 0 : -1;
    }
    if (pivots->dependent > (s->any_multipliers ? s->redundant_rows : 0) ||
        !(s->any_multipliers || is_filter(s))) {
        return -1;
    }
    double rate = pivots->eps / pivots->least_clear, error = rate;
    for (int32_t count = 0; count <= s->max_refinements; ++count) {
        if (error <= s->tolerance) {
            return count;
        }
        error *= rate;
    }
    return -1;
}

static int32_t count_refinements(const se3di_kkt *kkt)
{
    const se3di_kkt_pivots pivots = {kkt->eps, kkt->min_pivot, kkt->least_clear,
                                     kkt->dependent_rows + kkt->near_dependent,
                                     kkt->negative_pivots};
    return se3di_kkt_count_refinements(kkt, &pivots);
}

/* Rows that are dependent at eps may be nearly dependent only; then refinement is slow, and a
 * smaller eps tells them apart and is fast. */
static void refine_suitably(se3di_kkt *kkt, const kkt_problem *p, double *x, double *l,
                            se3di_kkt_solve_info *info)
{
    kkt_ending ending = refine(kkt, p, x, l, info);
    double residual = info->residual_b > info->residual_c ? info->residual_b : info->residual_c;
    double eps = 1e-3 * kkt->eps > kkt->settings.eps_min ? 1e-3 * kkt->eps : kkt->settings.eps_min;
    if (ending == KKT_CONVERGED || residual < 1e-14 || is_filter(&kkt->settings) ||
        !(eps < 0.5 * kkt->eps)) {
        return;
    }
    factor_once(kkt, p->values, eps, true);
    clear_multipliers(kkt, l);
    solve_once(kkt, p->b, p->c, x, l);
    (void)refine(kkt, p, x, l, info);
}

/* In r-p the multipliers of the normalisations belong to l: a dependence of rows involves them. */
static void add_to_multipliers(se3di_kkt *kkt, double sign, double *x, double *l)
{
    const size_t n = (size_t)kkt->pattern.body_size;
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        l[i] += sign * kkt->correction_l[i];
    }
    for (size_t i = 7; n == 8 && i < kkt->layout.unknown_count; i += 8) {
        x[i] += sign * kkt->correction_x[i];
    }
}

/* Returns whether once more is needed: the part itself is known to about u / eps. *most: the
 * largest number of the last one, which falls until eps times the rest of l is left. */
static bool project_once(se3di_kkt *kkt, double *x, double *l, double *most)
{
    const size_t m = kkt->layout.row_count;
    for (size_t i = 0; i < m; ++i) {
        kkt->residual_c[i] = -kkt->e[i] * l[i];
    }
    solve_once(kkt, NULL, kkt->residual_c, kkt->correction_x, kkt->correction_l);
    add_to_multipliers(kkt, -1.0, x, l);
    const double before = *most;
    *most = largest_entry(kkt->correction_l, m);
    const double left = 2.2e-16 * *most / kkt->eps;
    return *most < 0.5 * before && left > part_noise * largest_entry(l, m);
}

static void save_multipliers(se3di_kkt *kkt, const double *x, const double *l)
{
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        kkt->saved_l[i] = l[i];
    }
    for (size_t i = 7; kkt->pattern.body_size == 8 && i < kkt->layout.unknown_count; i += 8) {
        kkt->saved_x[i / 8] = x[i];
    }
}

static void restore_multipliers(const se3di_kkt *kkt, double *x, double *l)
{
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        l[i] = kkt->saved_l[i];
    }
    for (size_t i = 7; kkt->pattern.body_size == 8 && i < kkt->layout.unknown_count; i += 8) {
        x[i] = kkt->saved_x[i / 8];
    }
}

/* What rounding leaves of a dependent part that was subtracted, over what remains; a part in the
 * direction of nearly dependent rows, sigma >= 1e-14, leaves 1e-7 of itself and more. */
static double allowed_imbalance(const se3di_kkt *kkt, const double *l)
{
    double subtracted = 0.0;
    for (size_t i = 0; i < kkt->layout.row_count; ++i) {
        subtracted = fmax(subtracted, fabs(kkt->saved_l[i] - l[i]));
    }
    const double part = 1e-12 * subtracted, rest = largest_entry(l, kkt->layout.row_count);
    return part < 1e-8 * rest ? part / rest : 1e-8;
}

/* Subtract the part of l in the dependent directions, and restore the balance of forces. */
static void project(se3di_kkt *kkt, const kkt_problem *p, double *x, double *l,
                    se3di_kkt_solve_info *info)
{
    double before = HUGE_VAL, most = HUGE_VAL;
    const se3di_kkt_solve_info unprojected = *info;
    save_multipliers(kkt, x, l);
    info->projected = true;
    for (int32_t step = 0; step < 8 && project_once(kkt, x, l, &most); ++step) {
    }
    const double limit = 1e-14 + 10.0 * unprojected.residual_b + allowed_imbalance(kkt, l);
    for (int32_t step = 0;; ++step) {
        kkt->core->residual(kkt, p->values, p->b, p->c, x, l);
        (void)measure(kkt, info);
        if (!(info->residual_b > kkt->settings.tolerance) || info->residual_b > 0.3 * before ||
            step == 4) {
            break;
        }
        before = info->residual_b;
        solve_once(kkt, kkt->residual_b, NULL, kkt->correction_x, kkt->correction_l);
        add_to_multipliers(kkt, 1.0, x, l);
    }
    /* If the balance is lost, the rows were nearly dependent only: keep the refined l. */
    if (info->residual_b > limit && !(unprojected.residual_c > 1e-8)) {
        restore_multipliers(kkt, x, l);
        *info = unprojected;
    }
}

static se3d_status judge(const se3di_kkt *kkt, const double *x, const double *l,
                         se3di_kkt_solve_info *info)
{
    if (!all_finite(x, kkt->layout.unknown_count) || !all_finite(l, kkt->layout.row_count)) {
        return SE3D_ERR_NOT_FINITE;
    }
    if (info->projected) {
        info->inconsistent = info->residual_c > 1e-8;
        return SE3D_INFO_REDUNDANT;
    }
    bool failed = info->checked && (info->residual_b > 1e-6 || info->residual_c > 1e-6);
    return failed ? SE3D_ERR_NO_CONVERGENCE : SE3D_OK;
}

se3d_status se3di_kkt_solve(se3di_kkt *kkt, const se3di_kkt_values *values, const double *b,
                            const double *c, double *x, double *l, se3di_kkt_solve_info *info)
{
    se3di_kkt_solve_info own = {0};
    const kkt_problem problem = {values, b, c};
    clear_multipliers(kkt, l);
    solve_first(kkt, b, c, x, l);
    if (kkt->is_raised && !refine_raised(kkt, &problem, x, l, &own)) {
        own = (se3di_kkt_solve_info){0};
        clear_multipliers(kkt, l);
        solve_once(kkt, b, c, x, l);
    }
    const int32_t count = kkt->is_raised ? -1 : count_refinements(kkt);
    for (; own.refinements < count; ++own.refinements) {
        kkt->core->residual(kkt, values, b, c, x, l);
        solve_once(kkt, kkt->residual_b, kkt->residual_c, kkt->correction_x, kkt->correction_l);
        add_correction(kkt, 1.0, x, l);
    }
    if (count < 0 && !kkt->is_raised) {
        refine_suitably(kkt, &problem, x, l, &own);
    }
    if (kkt->dependent_rows > 0 && !kkt->settings.any_multipliers) {
        project(kkt, &problem, x, l, &own);
    }
    se3d_status status = judge(kkt, x, l, &own);
    if (info) {
        *info = own;
    }
    return status;
}
