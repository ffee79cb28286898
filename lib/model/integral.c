/* SPDX-License-Identifier: BSD-3-Clause */
/* F(t) = start + integral of f from `origin` to t, a pure function of t.
 *
 * A constant and a table have closed forms. Anything else is integrated by the Gauss-Kronrod rule
 * of 15 points over panels whose ends depend on the origin only: of 1/64 s up to 256 s from it,
 * then twice as long in each doubling of the distance. Within a panel a rule is halved until it
 * agrees with the Gauss rule of its 7 points to rounding, so that jumps and kinks of f cost time
 * and not digits. The sums over whole panels are kept, as high and low parts; what is not kept is
 * computed in the same order, with the same bits.                    docs/theory/functions.md */
#include "model/integral.h"

#include "base/floats.h"
#include "expression/expression.h"
#include "model/function.h"

#include <math.h>
#include <string.h>

#define PANEL       0.015625 /* s, the first ones */
#define BLOCK       16384    /* panels of one length */
#define BLOCK_LOG2  14
#define SPAN        256.0 /* PANEL * BLOCK */
#define PIECES_LOG2 3     /* at most 8 pieces of a panel to begin with */
#define REACH       1e6   /* s, from the origin; beyond it F would be long in coming */
#define DEPTH_MAX   60
#define PARTS_MAX   4000  /* of a piece: f is noise, or far too fast */
#define AGREEMENT   1e-14 /* of a piece: what two rules may differ by over the integral of |f| */
#define NOISE       1e-15 /* relative, of times */

se3di_function se3di_integral_rate(const se3di_function *function)
{
    se3di_function rate = *function;
    rate.integral = NULL;
    return rate;
}

static int eval_rate(const se3di_function *function, double t, double *value)
{
    double jet[3] = {0.0, 0.0, 0.0};
    se3d_status status;
    if (function->expression) {
        status = se3d_expression_eval(function->expression, &t, value);
    } else {
        status = function->callback(function->ctx, &t, jet, NULL);
        se3di_floats_resume();
        *value = jet[0];
    }
    return status >= 0 && isfinite(*value);
}

/* What a rule gives over a part. */
typedef struct rule {
    double whole, inner; /* the integral by 15 points, and by 7 of them */
    double size;         /* integral of |f| */
    double least, most;  /* of f */
} rule;

static int apply_rule(const se3di_function *function, double a, double b, rule *r)
{
    static const double x[8] = {
        0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
        0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
        0.586087235467691130294144838258730, 0.405845151377397166906606412076961,
        0.207784955007898467600689403773245, 0.0};
    static const double kronrod[8] = {
        0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
        0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
        0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
        0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
    static const double gauss[4] = {
        0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
        0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
    const double middle = a + 0.5 * (b - a);
    const double half = 0.5 * (b - a);
    *r = (rule){.least = HUGE_VAL, .most = -HUGE_VAL};
    for (int point = 0; point < 15; ++point) {
        const int k = point < 8 ? point : point - 8;
        double value;
        if (!eval_rate(function, point < 8 ? middle - half * x[k] : middle + half * x[k], &value)) {
            return 0;
        }
        r->whole += half * kronrod[k] * value;
        r->size += fabs(half) * kronrod[k] * fabs(value);
        r->inner += k % 2 == 1 ? half * gauss[k / 2] * value : 0.0;
        r->least = fmin(r->least, value);
        r->most = fmax(r->most, value);
    }
    return 1;
}

/* Whether the rules agree, to a part of `size` or to what the rounding of times makes of f. */
static int agrees(const rule *r, double size, double t)
{
    const double noise = NOISE * fabs(t) * (r->most - r->least);
    return fabs(r->whole - r->inner) <= fmax(AGREEMENT * size, noise);
}

/* Add the integral over one piece: parts on which the rules do not agree are halved. */
static int add_piece(const se3di_function *function, double a, double b, se3di_sum *s)
{
    double ends[DEPTH_MAX + 1]; /* of the parts that are to come */
    double size = 0.0;
    int depth = 0;
    ends[0] = b;
    for (int parts = 0; depth >= 0; ++parts) {
        const double end = ends[depth];
        const double middle = a + 0.5 * (end - a);
        rule r;
        if (!apply_rule(function, a, end, &r)) {
            return 0;
        }
        size = parts == 0 ? r.size : size;
        if (agrees(&r, size, end) || depth == DEPTH_MAX || parts > PARTS_MAX || middle == a ||
            middle == end) {
            se3di_sum_add(s, r.whole);
            a = end;
            --depth;
        } else {
            ends[++depth] = middle;
        }
    }
    return 1;
}

static double panel_begin(size_t k)
{
    const int block = (int)(k >> BLOCK_LOG2);
    const double place = (double)(k & (BLOCK - 1));
    return block == 0 ? place * PANEL : ldexp(SPAN + place * PANEL, block - 1);
}

/* The panel that holds the distance s >= 0 from the origin. */
static size_t panel_of(double s)
{
    if (s < SPAN) {
        return (size_t)(s / PANEL);
    }
    const int block = ilogb(s / SPAN) + 1;
    return ((size_t)block << BLOCK_LOG2) + (size_t)((ldexp(s, 1 - block) - SPAN) / PANEL);
}

/* Add the integral of f over distances from `a` to `b` <= the end of panel k, on the side of
 * `sign`. */
static int add_part(const se3di_function *function, size_t k, double b, double sign, se3di_sum *s)
{
    const int block = (int)(k >> BLOCK_LOG2);
    const int halvings = block <= 1 ? 0 : block - 1 < PIECES_LOG2 ? block - 1 : PIECES_LOG2;
    const double origin = function->integral->origin;
    const double a = panel_begin(k);
    const double piece = ldexp(panel_begin(k + 1) - a, -halvings);
    for (int j = 0; j < 1 << halvings; ++j) {
        const double from = a + j * piece;
        const double to = fmin(from + piece, b);
        if (to > from && !add_piece(function, origin + sign * from, origin + sign * to, s)) {
            return 0;
        }
    }
    return 1;
}

static int eval_panels(const se3di_function *function, double t, double *value)
{
    const se3di_integral *integral = function->integral;
    const double s = fabs(t - integral->origin);
    const double sign = t < integral->origin ? -1.0 : 1.0;
    if (s > REACH) {
        return 0;
    }
    const se3di_panel_sums *side = &integral->side[sign < 0.0];
    const size_t last = panel_of(s);
    size_t k = last < side->count ? last : side->count;
    se3di_sum total = {0.0, 0.0};
    if (k > 0) {
        total = side->sums[k - 1];
    }
    for (; k <= last; ++k) {
        if (!add_part(function, k, fmin(s, panel_begin(k + 1)), sign, &total)) {
            return 0;
        }
    }
    se3di_sum_add(&total, integral->start);
    *value = total.high + total.low;
    return 1;
}

int se3di_integral_eval(const se3di_function *function, double t, double *value)
{
    const se3di_integral *integral = function->integral;
    if (!isfinite(t)) {
        return 0;
    }
    if (function->expression || function->callback) {
        return eval_panels(function, t, value);
    }
    if (function->table) {
        const se3di_spline table = se3di_function_table(function);
        *value =
            integral->start + (se3di_spline_integral(&table, integral->knots, t) -
                               se3di_spline_integral(&table, integral->knots, integral->origin));
    } else {
        *value = integral->start + function->constant * (t - integral->origin);
    }
    return 1;
}

void se3di_integral_move(se3di_function *function, double t)
{
    double value;
    if (se3di_integral_eval(function, t, &value)) {
        function->integral->start = value;
        function->integral->origin = t;
    }
}

static se3d_status make_knots(const se3d_allocator *allocator, const se3di_function *function)
{
    se3di_integral *integral = function->integral;
    const size_t n = function->table_count;
    integral->knots = se3di_alloc(allocator, n, sizeof(double));
    if (!integral->knots) {
        return SE3D_ERR_NO_MEMORY;
    }
    integral->knot_count = n;
    const se3di_spline table = se3di_function_table(function);
    se3di_spline_integrate(&table, integral->knots);
    return SE3D_OK;
}

se3d_status se3di_integral_create(const se3d_allocator *allocator, se3di_function *function,
                                  double start, double origin)
{
    function->integral = se3di_alloc(allocator, 1, sizeof *function->integral);
    if (!function->integral) {
        return SE3D_ERR_NO_MEMORY;
    }
    *function->integral = (se3di_integral){.start = start, .origin = origin};
    return function->table ? make_knots(allocator, function) : SE3D_OK;
}

void se3di_integral_release(const se3d_allocator *allocator, se3di_integral *integral)
{
    if (!integral) {
        return;
    }
    for (int k = 0; k < 2; ++k) {
        se3di_free(allocator, integral->side[k].sums, integral->side[k].capacity,
                   sizeof(se3di_sum));
    }
    se3di_free(allocator, integral->knots, integral->knot_count, sizeof(double));
    se3di_free(allocator, integral, 1, sizeof *integral);
}

se3d_status se3di_integral_clone(const se3d_allocator *allocator, const se3di_integral *integral,
                                 se3di_integral **out)
{
    *out = se3di_alloc(allocator, 1, sizeof **out);
    if (!*out) {
        return SE3D_ERR_NO_MEMORY;
    }
    **out = (se3di_integral){.start = integral->start, .origin = integral->origin};
    if (integral->knots) {
        (*out)->knots = se3di_alloc(allocator, integral->knot_count, sizeof(double));
        if (!(*out)->knots) {
            return SE3D_ERR_NO_MEMORY;
        }
        (*out)->knot_count = integral->knot_count;
        memcpy((*out)->knots, integral->knots, integral->knot_count * sizeof(double));
    }
    return SE3D_OK;
}

static int has_panels(const se3di_function *function)
{
    return function->integral && (function->expression || function->callback);
}

se3d_status se3di_integrals_reserve(se3di_model *model, double t)
{
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        se3di_function *function = &model->functions[k];
        if (!has_panels(function) || !isfinite(t)) {
            continue;
        }
        const double s = t - function->integral->origin;
        se3di_panel_sums *side = &function->integral->side[s < 0.0];
        const size_t wanted = panel_of(fmin(fabs(s), REACH)) + 1;
        void *sums = side->sums;
        const se3d_status status = se3di_array_reserve(&model->allocator, &sums, &side->capacity,
                                                       wanted, sizeof(se3di_sum));
        side->sums = sums;
        SE3DI_TRY(status);
    }
    return SE3D_OK;
}

static void advance(se3di_function *function, double t)
{
    const double sign = t < function->integral->origin ? -1.0 : 1.0;
    const double s = fmin(fabs(t - function->integral->origin), REACH);
    se3di_panel_sums *side = &function->integral->side[sign < 0.0];
    const size_t last = panel_of(s);
    while (side->count < last && side->count < side->capacity) {
        const size_t k = side->count;
        se3di_sum total = {0.0, 0.0};
        if (k > 0) {
            total = side->sums[k - 1];
        }
        if (!add_part(function, k, panel_begin(k + 1), sign, &total)) {
            return; /* whoever evaluates it there is told */
        }
        side->sums[k] = total;
        side->count = k + 1;
    }
}

void se3di_integrals_advance(se3di_model *model, double t)
{
    for (size_t k = 0; k < model->function_slots.count && isfinite(t); ++k) {
        if (has_panels(&model->functions[k])) {
            advance(&model->functions[k], t);
        }
    }
}
