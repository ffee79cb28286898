/* SPDX-License-Identifier: BSD-3-Clause */
/* gauss: collocation at the zeros of Legendre's polynomials, with 4 stages (order 8) or 8 (order
 * 16). The stages are found by fixed-point iterations that begin with the continuation of the last
 * step's polynomial:
 *
 *     Y_i = y + h sum_j a_ij K_j,   K_i = y'(t + c_i h, Y_i),   y_1 = y + h sum_i b_i K_i
 *
 * Positions follow from the velocities of the same iteration, so that an iteration gains as much as
 * one of the equations of second order. Symmetric, and symplectic where the iterations are
 * converged. The derivatives at both ends say what the polynomial lacks: its error, the step, and
 * an interpolation of two orders more. Stages of a tree without force elements, open or with loops,
 * are computed in the lanes of registers (gauss_lanes.h).  docs/theory/gauss.md */
#include "integrator/explicit_step.h"
#include "integrator/gauss_lanes.h"
#include "integrator/gauss_rule.h"
#include "math/elementary.h"

#include <math.h>
#include <string.h>

#define MANY_FROM       1e-6 /* 8 stages for tolerances below, if they come one by one, */
#define MANY_IN_LANES   3e-6 /* in lanes, on open trees of this many freedoms, */
#define LARGE           8
#define MANY_OF_FEW     1e-3 /* and on those of fewer; of loops in lanes always */
#define CONTRACTION_AIM 0.3  /* of the iterations: fewer, longer steps cost more iterations */
#define ITERATIONS_MAX  12
#define EXACT_MAX       100   /* iterations to rounding, for a step that is not controlled */
#define ROUNDING        1e-14 /* a relative change that is only noise */
#define NOISE           0.5   /* the same of a change that does not get less */
#define GROWTH          2.0
#define EASY            0.01 /* an error that would allow far longer steps */
#define SHORT           0.02 /* step times that rate: singular positions are not avoided by less */
#define ASIDE           0.8  /* the part of a step that avoids one, */
#define ASIDE_MAX       6    /* if it is not tried for longer */
#define SLOW_MAX        0.05 /* step times the rate of the motion, if stiffness holds it */
#define STATES          (SE3DI_GAUSS_MAX + 1) /* first vector of work for the states of stages */
#define END             SE3DI_GAUSS_FORMS     /* the form that is the derivative at the end */

/* What steps are held to. */
typedef struct control {
    double part;            /* of the local tolerance: what the estimate of the error may be, */
    double left;            /* and of that, what may be left of the iterations */
    double safety;          /* of the length that the error allows */
    double contraction_max; /* of the iterations; above, the step is given up, */
    double first_max;       /* above this by the first two changes: one is that of the guess */
    double guess;           /* contraction of a step that nothing is known of */
    double far;             /* into a step: where its prediction is to be at its best */
} control;

static const control careful = {1.0, 0.1, 0.8, 0.7, 1.2, 0.5, 0.6};
static const control eager = {4.0, 0.05, 0.75, 0.9, 1.5, 0.3, 0.5};

/* The estimates of four stages are the farther above the error, and where nothing but plain forces
 * act steps that are longer stay within the tolerance. */
static int is_eager(const se3di_explicit *m)
{
    return m->is_plain && m->stages == 4;
}

static const control *get_control(const se3di_explicit *m)
{
    return is_eager(m) ? &eager : &careful;
}

static double *stage_rate(const se3di_explicit *m, int i)
{
    return m->K + (size_t)i * m->count;
}

static double *stage_state(const se3di_explicit *m, int i)
{
    return m->K + (size_t)(STATES + i) * m->count;
}

/* Of the polynomial of this step, in the place of the states, which are no longer needed. */
static double *get_form(const se3di_explicit *m, int k)
{
    return stage_state(m, k);
}

/* More rows are dependent at the end of the step than are all along. */
static int is_lost(const se3di_explicit *m)
{
    return m->motion->count_dependent(m->equations) > m->past->redundant;
}

/* [1/s] of the motion so far. */
static double rate_of_motion(const se3di_explicit *m)
{
    return fmax(m->past->scale.speed / m->past->scale.length, m->past->scale.spin);
}

/* A step that meets a singular position with a stage or its end is better made shorter, so that it
 * meets none; not if it begins at one, or is short in units of the motion. */
static int may_be_shorter(const se3di_explicit *m, double h)
{
    return isfinite(m->tolerance) && m->past->lost == 0.0 && h * rate_of_motion(m) > SHORT;
}

/* Tolerances below are met with less work by 8 stages than by 4. Of many freedoms some are fast and
 * limit the steps by the contraction of the iterations, so that stages gain less there. */
static double many_from(const se3di_explicit *m)
{
    if (!se3di_gauss_lanes_suit(m)) {
        return MANY_FROM;
    }
    if (!m->equations->is_open_tree) {
        return HUGE_VAL;
    }
    return m->equations->tree->v_count >= LARGE ? MANY_IN_LANES : MANY_OF_FEW;
}

/* The stages of the next step; the history decides, so that clones go on alike. */
static int choose_stages(const se3di_explicit *m)
{
    const se3di_integrator_settings *settings = &m->step.integration->settings;
    if (settings->order > 0) {
        return settings->order / 2;
    }
    return settings->tolerance < many_from(m) && m->past->lost == 0.0 ? 8 : 4;
}

/* The motion goes on as in the last step: nothing that acts has jumped. */
static int is_continued(const se3di_explicit *m)
{
    const double *end = m->forms + END * m->count;
    return m->past->stages > 0.0 && m->past->at.time > m->past->at.begin &&
           memcmp(end, m->f1, m->count * sizeof *end) == 0;
}

/* Of a vector of rates but those of the works; to compare such vectors with each other. */
static double length_of(const se3di_explicit *m, const double *rates)
{
    double sum = 0.0;
    for (size_t k = 0; k < m->count - SE3DI_STATE_WORK; ++k) {
        sum += rates[k] * rates[k];
    }
    return sqrt(sum);
}

/* How many forms of the last step's polynomial tell of the motion until some time, where they are
 * multiplied by basis[form * SE3DI_GAUSS_POINTS]: those after the least part of the sum there are
 * what the iterations have left, which grows with the degree. */
static int count_forms(const se3di_explicit *m, const se3di_gauss_rule *last, const double *basis)
{
    double least = HUGE_VAL;
    int count = 1;
    for (int k = 1; k < last->stages + 2; ++k) {
        const double part =
            (basis[k * SE3DI_GAUSS_POINTS] - 1.0) * length_of(m, m->forms + (size_t)k * m->count);
        if (part <= least) {
            least = part;
            count = k + 1;
        }
    }
    return count;
}

static void find_prediction(const se3di_explicit *m, const se3di_gauss_rule *rule, double h,
                            se3di_gauss_prediction *prediction)
{
    prediction->forms = 0;
    if (!is_continued(m)) {
        return;
    }
    const int s = rule->stages;
    const double part = h / (m->past->at.time - m->past->at.begin);
    const se3di_gauss_rule *last = se3di_gauss_find((int)m->past->stages);
    double x[SE3DI_GAUSS_POINTS], bases[SE3DI_GAUSS_FORMS * SE3DI_GAUSS_POINTS];
    for (int i = 0; i < s; ++i) {
        x[i] = 1.0 + part * rule->c[i];
    }
    x[s] = 1.0 + get_control(m)->far * part;
    se3di_gauss_bases(last, s + 1, x, bases);
    const int count = count_forms(m, last, bases + s);
    prediction->forms = count - 1;
    for (int k = 1; k < count; ++k) {
        for (int i = 0; i < s; ++i) {
            prediction->weights[(k - 1) * SE3DI_GAUSS_MAX + i] =
                bases[k * SE3DI_GAUSS_POINTS + i] - 1.0;
        }
    }
}

/* The derivatives of the stages by it. */
static void predict(const se3di_explicit *m, const se3di_gauss_rule *rule,
                    const se3di_gauss_prediction *prediction)
{
    for (int i = 0; i < rule->stages; ++i) {
        double weights[SE3DI_GAUSS_FORMS];
        for (int k = 0; k < prediction->forms; ++k) {
            weights[k] = prediction->weights[k * SE3DI_GAUSS_MAX + i];
        }
        se3di_explicit_combine(m, m->forms + m->count, m->f1, 1.0, weights, prediction->forms,
                               stage_rate(m, i));
    }
}

static void place_stages(se3di_explicit *m, const se3di_gauss_rule *rule, double h)
{
    for (int i = 0; i < rule->stages; ++i) {
        se3di_explicit_combine(m, m->K, m->y1, h, rule->A + i * rule->stages, rule->stages,
                               stage_state(m, i));
    }
}

/* States of the stages from the derivatives: positions from velocities that are new already. */
static void renew_stages(se3di_explicit *m, const se3di_gauss_rule *rule, double h)
{
    place_stages(m, rule, h);
    for (int i = 0; i < rule->stages; ++i) {
        m->motion->move(m->equations, stage_state(m, i), stage_rate(m, i));
    }
}

/* All derivatives at the present states; *change, relative to the scales, of a step by them. */
static se3d_status sweep(se3di_explicit *m, const se3di_gauss_rule *rule, double h, double *change)
{
    double sum = 0.0;
    for (int i = 0; i < rule->stages; ++i) {
        double *rate = stage_rate(m, i);
        memcpy(m->sum, rate, m->count * sizeof *rate);
        SE3DI_TRY(
            se3di_explicit_evaluate(m, m->past->at.time + rule->c[i] * h, stage_state(m, i), rate));
        for (size_t k = 0; k < m->count; ++k) {
            m->sum[k] = h * (rate[k] - m->sum[k]);
        }
        const double size = se3di_explicit_size(m, m->sum);
        sum += rule->b[i] * size * size;
    }
    *change = sqrt(sum);
    return SE3D_OK;
}

/* What an iteration says: 1 converged, -1 it will not, 0 go on. `rate`: of its change to that of
 * the one before. */
static int judge(const se3di_explicit *m, int iteration, double change, double rate)
{
    const int is_controlled = isfinite(m->tolerance);
    const control *own = get_control(m);
    const double tolerance = own->part * m->tolerance;
    if (!isfinite(change)) {
        return -1;
    }
    if (!is_controlled) {
        const int has_settled =
            iteration > 0 && (change == 0.0 || (change < ROUNDING && rate > 0.5));
        return has_settled ? 1 : iteration + 1 < EXACT_MAX ? 0 : -1;
    }
    const double left = rate < 0.9 ? change * rate / (1.0 - rate) : HUGE_VAL;
    if (left <= own->left * tolerance || change <= ROUNDING) {
        return 1;
    }
    if (iteration > 0 && rate > (iteration == 1 ? own->first_max : own->contraction_max)) {
        return change <= NOISE * tolerance ? 1 : -1;
    }
    return iteration + 1 >= ITERATIONS_MAX ? -1 : 0;
}

/* What the contraction of the first iteration is likely to be. */
static double guess_rate(const se3di_explicit *m, double h)
{
    const double guess = get_control(m)->guess;
    if (is_continued(m) && m->past->contraction > 0.0) {
        const double part = h / (m->past->at.time - m->past->at.begin);
        return fmin(guess, m->past->contraction * part * part);
    }
    return guess;
}

/* Iteration k has made `change`. */
static void follow(se3di_explicit *m, int k, double change, double *before, double *rate)
{
    if (k > 0) {
        *rate = *before > 0.0 ? change / *before : 0.0;
        m->contraction = *before > ROUNDING ? fmax(m->contraction, *rate) : m->contraction;
    }
    *before = change;
}

/* *judgement as above. */
static se3d_status iterate(se3di_explicit *m, const se3di_gauss_rule *rule, double h,
                           int *judgement)
{
    double change, before = 0.0, rate = guess_rate(m, h);
    m->contraction = 0.0;
    *judgement = 0;
    for (int k = 0; *judgement == 0; ++k) {
        renew_stages(m, rule, h);
        place_stages(m, rule, h);
        SE3DI_TRY(sweep(m, rule, h, &change));
        follow(m, k, change, &before, &rate);
        *judgement = judge(m, k, change, rate);
    }
    renew_stages(m, rule, h);
    for (int k = 0; k < rule->stages; ++k) {
        se3di_explicit_combine(m, m->K, NULL, 1.0, rule->values + (size_t)k * (size_t)rule->stages,
                               rule->stages, get_form(m, k));
    }
    return SE3D_OK;
}

/* The same with the stages in lanes; 0 if a stage fails: nothing has changed then. */
static int iterate_lanes(se3di_explicit *m, const se3di_gauss_rule *rule, double h,
                         const se3di_gauss_prediction *prediction, se3di_gauss_lanes *lanes,
                         int *judgement)
{
    double change = 0.0, before = 0.0, rate = guess_rate(m, h);
    se3di_gauss_lanes_begin(lanes, m, h, prediction);
    m->contraction = 0.0;
    *judgement = 0;
    for (int k = 0; *judgement == 0; ++k) {
        if (!se3di_gauss_lanes_sweep(lanes, m, rule, k, h, &change)) {
            return 0;
        }
        follow(m, k, change, &before, &rate);
        *judgement = judge(m, k, change, rate);
    }
    se3di_gauss_lanes_end(lanes, m, get_form(m, 0));
    return 1;
}

/* In lanes, if they can be. What cannot be is done one after the other, with four stages, whose
 * iterations contract better at singular positions. */
static se3d_status find_stages(se3di_explicit *m, double h, int *judgement)
{
    se3di_gauss_prediction prediction;
    const se3di_gauss_rule *rule = se3di_gauss_find(m->stages);
    m->is_closed = m->is_met = 0;
    find_prediction(m, rule, h, &prediction);
    se3di_gauss_lanes *lanes = se3di_gauss_lanes_find(m, rule);
    if (lanes) {
        if (iterate_lanes(m, rule, h, &prediction, lanes, judgement)) {
            m->is_closed = lanes->has_loops;
            return SE3D_OK;
        }
        m->is_met = lanes->has_loops && may_be_shorter(m, h);
        *judgement = -1;
        if (m->is_met) {
            return SE3D_OK;
        }
        if (lanes->has_loops && m->step.integration->settings.order == 0) {
            m->stages = 4;
            rule = se3di_gauss_find(m->stages);
            find_prediction(m, rule, h, &prediction);
        }
    }
    predict(m, rule, &prediction);
    return iterate(m, rule, h, judgement);
}

static se3d_status make_stages(se3di_explicit *m, double h, double *error)
{
    int judgement;
    m->stages = choose_stages(m);
    se3di_state_begin_step(m->equations, m->past->redundant, m->past->wide > 0.0);
    SE3DI_TRY(find_stages(m, h, &judgement));
    if (judgement < 0 && !isfinite(m->tolerance)) {
        return se3di_error_set(m->equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: the stages of a step of %g s do not converge; take a "
                               "shorter one, or radau if the motion is stiff",
                               m->past->at.time, h);
    }
    *error = judgement < 0 ? HUGE_VAL : 0.0;
    return SE3D_OK;
}

static void arrive(se3di_explicit *m, double h)
{
    static const double whole = 1.0;
    se3di_explicit_combine(m, get_form(m, 0), m->y1, h, &whole, 1, m->y);
}

static int find_end(se3di_explicit *m, double t)
{
    se3di_gauss_lanes *lanes = se3di_gauss_lanes_find(m, se3di_gauss_find(m->stages));
    return lanes && se3di_gauss_lanes_differentiate(lanes, m, t, se3di_explicit_end(m), m->squares);
}

/* Of so many stages, which the compiler knows. */
static inline void subtract_ends(const se3di_explicit *m, const int stages, double *restrict begin,
                                 double *restrict end)
{
    const double *f0 = m->f1, *f1 = se3di_explicit_end(m), *a = get_form(m, 0);
    const size_t count = m->count;
    for (size_t c = 0; c < count; ++c) {
        double even = 0.0, odd = 0.0;
        for (int k = 0; k < stages; k += 2) {
            even += a[(size_t)k * count + c];
            odd += a[(size_t)(k + 1) * count + c];
        }
        begin[c] = f0[c] - (even - odd);
        end[c] = f1[c] - (even + odd);
    }
}

/* d_0 and d_1: what u' lacks at both ends. */
static void find_defects(const se3di_explicit *m, double *begin, double *end)
{
    if (m->stages == 4) {
        subtract_ends(m, 4, begin, end);
    } else {
        subtract_ends(m, 8, begin, end);
    }
}

/* Of the coefficients of the polynomial, of which the last and first are in the ratio of `part`: by
 * one degree. */
static double find_decay(const se3di_explicit *m, double part)
{
    return is_eager(m) ? sqrt(sqrt(part)) : se3di_pow(part, 1.0 / (m->stages + 1));
}

/* The defects at both ends, integrated, are the error of u within the step, of local order s + 1;
 * that of the interpolation through both ends is less by a factor that their size tells. */
static double estimate_end(se3di_explicit *m, double h, double error)
{
    (void)error;
    if (m->is_closed && is_lost(m) && may_be_shorter(m, h)) {
        m->is_met = 1;
        return HUGE_VAL;
    }
    const se3di_gauss_rule *rule = se3di_gauss_find(m->stages);
    find_defects(m, m->sum, m->sum3);
    const double begin = length_of(m, m->sum), end = length_of(m, m->sum3);
    const double defect = fmax(begin, end), whole = length_of(m, get_form(m, 0));
    const double *const defects[2] = {m->sum, m->sum3};
    double sizes[2];
    if (m->is_bare) {
        se3di_gauss_lanes_sizes(se3di_gauss_lanes_find(m, rule), defects, sizes);
    } else {
        se3di_explicit_sizes(m, defects, sizes);
    }
    const double size = h * fmax(sizes[0], sizes[1]);
    const double part = defect < whole ? defect / whole : 1.0;
    if (!(size > 0.0)) {
        return size == 0.0 ? 0.0 : HUGE_VAL;
    }
    return rule->largest * size * find_decay(m, part) / (get_control(m)->part * m->tolerance);
}

/* What the next step is predicted and this one interpolated from. */
static void accept(se3di_explicit *m, double h)
{
    (void)h;
    double *forms = m->forms, *half = forms + (size_t)m->stages * m->count, *skew = half + m->count;
    memcpy(m->y0, m->y1, m->count * sizeof *m->y0);
    memcpy(forms, get_form(m, 0), (size_t)m->stages * m->count * sizeof *forms);
    if (!m->is_bare) { /* else they still are where the error was estimated from */
        find_defects(m, m->sum, m->sum3);
    }
    for (size_t c = 0; c < m->count; ++c) {
        const double begin = m->sum[c], end = m->sum3[c];
        half[c] = 0.5 * (begin + end);
        skew[c] = 0.5 * (end - begin);
    }
    memcpy(forms + END * m->count, se3di_explicit_end(m), m->count * sizeof *forms);
    m->past->stages = m->stages;
    m->past->contraction = m->contraction;
    m->past->lost = is_lost(m);
}

static int get_order(const se3di_explicit *m)
{
    return choose_stages(m) + 2;
}

static int get_end(const se3di_explicit *m)
{
    (void)m;
    return SE3DI_GAUSS_MAX;
}

/* The factor for a step whose iterations contract by `rate` to one by CONTRACTION_AIM. */
static double contract(double rate)
{
    return rate > 0.0 ? sqrt(CONTRACTION_AIM / rate) : HUGE_VAL;
}

/* By what the step may change as the error allows, but no more than `most`. */
static double follow_error(const se3di_explicit *m, double error, double most)
{
    const int order = m->stages + 2;
    const double safety = get_control(m)->safety, ratio = most / safety;
    double power = error;
    for (int k = 0; k < order; ++k) {
        power *= ratio;
    }
    return power < 1.0 ? most : fmin(most, fmax(0.2, safety * se3di_pow(error, -1.0 / order)));
}

static double next_step(const se3di_explicit *m, double h, double error)
{
    const double largest = m->past->at.rejected != 0.0 ? 1.0 : GROWTH;
    h *= follow_error(m, error, fmin(largest, fmax(0.3, contract(m->contraction))));
    return se3di_adaptive_limit(m->step.integration, h);
}

static double shrink(const se3di_explicit *m, se3d_status status, double error)
{
    if (status < 0) {
        return 0.25;
    }
    if (m->is_met && m->step.tries <= ASIDE_MAX) {
        return ASIDE;
    }
    const double factor = isfinite(error) && error > 0.0
                              ? get_control(m)->safety * se3di_pow(error, -1.0 / (m->stages + 2))
                              : fmin(0.6, contract(m->contraction));
    return fmax(0.2, fmin(0.8, factor));
}

/* Contraction limits the steps to far below what errors allow, and what the motion asks for. A
 * small oscillation looks like that, too; where only gravity acts all that is fast is one. */
static void watch_stability(se3di_explicit *m, double h)
{
    const int is_held = m->contraction > 0.5 * CONTRACTION_AIM &&
                        h * rate_of_motion(m) < SLOW_MAX && m->past->at.error < EASY;
    se3di_explicit_count_sign(m, is_held && !se3di_gauss_lanes_suit_model(m->assembly->model));
}

static se3d_status build_dense(se3di_explicit *m)
{
    m->past->dense = 1.0;
    return SE3D_OK;
}

/* At the end it is y_1 after the projection. */
static void interpolate(const se3di_explicit *m, double t, double *y)
{
    const se3di_gauss_rule *rule = se3di_gauss_find((int)m->past->stages);
    const double h = m->past->at.time - m->past->at.begin, x = (t - m->past->at.begin) / h;
    const double ramp = x * x * (3.0 - 2.0 * x);
    double integral[SE3DI_GAUSS_FORMS];
    se3di_gauss_integral(rule, x, integral);
    integral[0] -= ramp;
    for (size_t k = 0; k < m->count; ++k) {
        m->sum[k] = m->y0[k] + ramp * (m->y1[k] - m->y0[k]);
    }
    se3di_explicit_combine(m, m->forms, m->sum, h, integral, rule->stages + 2, y);
}

static const se3di_explicit_class gauss_class = {
    .make_stages = make_stages,
    .arrive = arrive,
    .is_bare = se3di_gauss_lanes_are_bare,
    .find_end = find_end,
    .estimate_end = estimate_end,
    .accept = accept,
    .next_step = next_step,
    .shrink = shrink,
    .watch_stability = watch_stability,
    .build_dense = build_dense,
    .interpolate = interpolate,
    .get_order = get_order,
    .get_end = get_end,
    .is_watched = 1,
    .keeps_end = 1,
};

const se3di_integrator se3di_integrator_gauss = {
    .name = "gauss",
    .tag = SE3D_METHOD_GAUSS,
    SE3DI_EXPLICIT_METHOD_WITH(se3di_gauss_work_count),
    .explicit_class = &gauss_class,
    .get_reach = se3di_gauss_get_reach,
    .is_held = se3di_explicit_is_held,
    .orders = 1u << 8 | 1u << 16,
    .takes_lanes = 1,
};
