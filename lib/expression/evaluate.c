/* SPDX-License-Identifier: BSD-3-Clause */
/* The evaluators of bytecode: of values, alone or of several points side by side, and of jets.
 *
 * A jet carries a value and derivatives through every operation by the chain rule:
 *
 *     y = f(u):     y_i = f_u u_i,              y'' = f_u u'' + f_uu u'^2
 *     y = f(a, b):  y_i = f_a a_i + f_b b_i,    y'' = f_a a'' + f_b b'' + f_aa a'^2 + 2 f_ab a' b'
 *                                                     + f_bb b'^2
 *
 * with first derivatives along all variables (struct slope) or first and second along a direction,
 * that of the time or another (struct jet). The masks of an instruction say on which variables an
 * operand depends: a term that is zero for that reason stays zero also if f_u is infinite. */
#include "expression/functions.h"
#include "expression/program.h"
#include "math/over.h"
#include "se3d/expression.h"

#include <math.h>
#include <string.h>

/* A condition that is NaN takes no branch: the result becomes NaN. */
static inline uint32_t branch(double condition, uint32_t jump, double *poison)
{
    if (isnan(condition)) {
        *poison = condition;
    }
    return condition == 0.0 ? jump : 0;
}

/* ---- values ---------------------------------------------------------------------------------*/

/* x, x0, h0, x1, h1 */
static inline double step_value(double x, double x0, double h0, double x1, double h1)
{
    double d[3];
    const double u = se3di_over(x - x0, x1 - x0);
    if (!isfinite(u)) {
        return (double)NAN;
    }
    if (u <= 0.0) {
        return h0;
    }
    if (u >= 1.0) {
        return h1;
    }
    se3di_function_smooth_step(u, d);
    return h0 + (h1 - h0) * d[0];
}

static inline double unary_value(const se3di_instruction *in, double u)
{
    double d[3];
    se3di_functions[in->function].unary(u, d);
    return d[0];
}

static inline double power_value(const se3di_instruction *in, double u)
{
    double d[3];
    se3di_function_power(u, in->value, d);
    return d[0];
}

static inline double binary_value(const se3di_instruction *in, double a, double b)
{
    se3di_partials d;
    se3di_functions[in->function].binary(a, b, &d);
    return d.f;
}

/* Functions are evaluated once if all points agree. */
static inline int are_same(const double *values, size_t points)
{
    return points > 1 && memcmp(values, values + 1, (points - 1) * sizeof *values) == 0;
}

static inline void fill(double *values, size_t points, double value)
{
    for (size_t k = 0; k < points; ++k) {
        values[k] = value;
    }
}

static inline void unary_values(const se3di_instruction *in, double *u, size_t points)
{
    const int same = are_same(u, points);
    for (size_t k = 0; k < (same ? 1 : points); ++k) {
        u[k] = unary_value(in, u[k]);
    }
    if (same) {
        fill(u, points, u[0]);
    }
}

/* top = (what `next`, an expression in k, says of each point); `pops` operands less. */
#define EACH(pops, next)                                                                           \
    top -= (ptrdiff_t)(pops) * (ptrdiff_t)points;                                                  \
    for (size_t k = 0; k < points; ++k) {                                                          \
        top[k] = (next);                                                                           \
    }                                                                                              \
    break
#define OPERAND(number) top[(size_t)(number)*points + k]

/* Of `points` points: x [variables][points]. @return 0: a jump may part them */
static inline __attribute__((always_inline)) int eval_values(const se3di_instruction *code,
                                                             size_t count, const double *x,
                                                             const size_t points, double *values)
{
    /* values begin at the second place */
    double stack[(SE3DI_PROGRAM_STACK + 1) * SE3DI_EXPRESSION_POINTS];
    double *top = stack, poison = 0.0;
    for (const se3di_instruction *in = code, *end = code + count; in != end; ++in) {
        switch ((se3di_op)in->op) { /* unreached: no other operation is compiled */
        case SE3DI_OP_CONSTANT:
            EACH(-1, in->value);
        case SE3DI_OP_VARIABLE:
            EACH(-1, x[in->function * points + k]);
        case SE3DI_OP_ADD:
            EACH(1, OPERAND(0) + OPERAND(1));
        case SE3DI_OP_SUBTRACT:
            EACH(1, OPERAND(0) - OPERAND(1));
        case SE3DI_OP_MULTIPLY:
            EACH(1, OPERAND(0) * OPERAND(1));
        case SE3DI_OP_DIVIDE:
            EACH(1, se3di_over(OPERAND(0), OPERAND(1)));
        case SE3DI_OP_SHIFT:
            EACH(0, OPERAND(0) + in->value);
        case SE3DI_OP_SCALE:
            EACH(0, OPERAND(0) * in->value);
        case SE3DI_OP_POWER:
            EACH(0, power_value(in, OPERAND(0)));
        case SE3DI_OP_UNARY:
            unary_values(in, top, points);
            break;
        case SE3DI_OP_BINARY:
        case SE3DI_OP_SELECT:
            EACH(1, binary_value(in, OPERAND(0), OPERAND(1)));
        case SE3DI_OP_STEP:
            EACH(4, step_value(OPERAND(0), OPERAND(1), OPERAND(2), OPERAND(3), OPERAND(4)));
        case SE3DI_OP_JUMP:
            in += in->jump;
            break;
        case SE3DI_OP_JUMP_IF_ZERO:
            if (points > 1) {
                return 0;
            }
            in += branch(*top--, in->jump, &poison);
            break;
        }
    }
    for (size_t k = 0; k < points; ++k) {
        values[k] = top[k] + poison;
    }
    return 1;
}

void se3di_program_eval_points(const se3di_instruction *code, size_t count, const double *x,
                               size_t variable_count, double values[SE3DI_EXPRESSION_POINTS])
{
    if (eval_values(code, count, x, SE3DI_EXPRESSION_POINTS, values)) {
        return;
    }
    for (size_t point = 0; point < SE3DI_EXPRESSION_POINTS; ++point) {
        double at[SE3D_EXPRESSION_VARIABLE_MAX];
        for (size_t k = 0; k < variable_count; ++k) {
            at[k] = x[k * SE3DI_EXPRESSION_POINTS + point];
        }
        (void)eval_values(code, count, at, 1, values + point);
    }
}

/* ---- value, first and second derivative along a direction of the variables --------------------*/

/* A derivative along variables: their bits, and the direction's components. */
typedef struct way {
    unsigned mask;
    const double *components; /* of the variables in the mask */
} way;

typedef struct jet {
    double f, t, tt;
} jet;

static inline jet jet_subtract(jet a, jet b)
{
    return (jet){a.f - b.f, a.t - b.t, a.tt - b.tt};
}

static inline jet jet_multiply(jet a, jet b)
{
    return (jet){a.f * b.f, a.t * b.f + a.f * b.t, a.tt * b.f + 2.0 * a.t * b.t + a.f * b.tt};
}

static inline jet jet_divide(jet a, jet b)
{
    jet q;
    q.f = se3di_over(a.f, b.f);
    q.t = se3di_over(a.t - q.f * b.t, b.f);
    q.tt = se3di_over(a.tt - 2.0 * q.t * b.t - q.f * b.tt, b.f);
    return q;
}

static inline void jet_chain(jet *u, const double d[3], unsigned mask)
{
    int depends = mask != 0;
    u->tt = depends ? d[1] * u->tt + d[2] * u->t * u->t : 0.0;
    u->t = depends ? d[1] * u->t : 0.0;
    u->f = d[0];
}

static void jet_chain2(jet *a, jet b, const se3di_partials *d, unsigned mask_a, unsigned mask_b)
{
    double t = 0.0, tt = 0.0;
    if (mask_a) {
        t = d->a * a->t;
        tt = d->a * a->tt + d->aa * a->t * a->t;
    }
    if (mask_b) {
        t += d->b * b.t;
        tt += d->b * b.tt + d->bb * b.t * b.t;
    }
    if (mask_a && mask_b) {
        tt += 2.0 * d->ab * a->t * b.t;
    }
    *a = (jet){d->f, t, tt};
}

/* s = x, x0, h0, x1, h1; the result replaces x. */
static void jet_step(jet s[5])
{
    jet u = jet_divide(jet_subtract(s[0], s[1]), jet_subtract(s[3], s[1]));
    if (!isfinite(u.f)) {
        s[0] = (jet){(double)NAN, (double)NAN, (double)NAN};
    } else if (u.f <= 0.0) {
        s[0] = s[2];
    } else if (u.f >= 1.0) {
        s[0] = s[4];
    } else {
        double d[3];
        se3di_function_smooth_step(u.f, d);
        jet_chain(&u, d, 1u);
        jet rise = jet_multiply(jet_subtract(s[4], s[2]), u);
        s[0] = (jet){s[2].f + rise.f, s[2].t + rise.t, s[2].tt + rise.tt};
    }
}

static void jet_binary(jet *a, const se3di_instruction *in, unsigned mask)
{
    se3di_partials d;
    se3di_functions[in->function].binary(a[0].f, a[1].f, &d);
    jet_chain2(a, a[1], &d, in->mask_a & mask, in->mask_b & mask);
}

/* At zero, abs has the derivatives of what is on the way ahead. */
static inline void jet_unary(jet *u, const se3di_instruction *in, unsigned mask)
{
    double d[3];
    se3di_functions[in->function].unary(u->f, d);
    if (u->f == 0.0 && se3di_functions[in->function].unary == se3di_function_abs) {
        d[1] = u->t < 0.0 || (u->t == 0.0 && u->tt < 0.0) ? -1.0 : 1.0;
    }
    jet_chain(u, d, mask);
}

/* Of two equal values that one counts which is the smaller, or larger, on the way ahead. */
static int leads(const jet *a, const jet *b, const se3di_instruction *in)
{
    se3di_partials d;
    const double rise = b->t != a->t ? b->t - a->t : b->tt - a->tt;
    se3di_functions[in->function].binary(0.0, rise, &d);
    return d.b != 0.0;
}

static void jet_select(jet *a, const se3di_instruction *in)
{
    se3di_partials d;
    se3di_functions[in->function].binary(a[0].f, a[1].f, &d);
    if (d.b != 0.0 || (a[0].f == a[1].f && leads(&a[0], &a[1], in))) {
        a[0] = a[1];
    }
    a[0].f = d.f; /* NaN if either is */
}

static inline void eval_along(const se3di_instruction *code, size_t count, const double *x, way w,
                              double out[3])
{
    jet stack[SE3DI_PROGRAM_STACK + 1]; /* values begin at stack[1] */
    jet *top = stack;
    double poison = 0.0, d[3];
    for (const se3di_instruction *in = code, *end = code + count; in != end; ++in) {
        switch ((se3di_op)in->op) { /* unreached: no other operation is compiled */
        case SE3DI_OP_CONSTANT:
            *++top = (jet){in->value, 0.0, 0.0};
            break;
        case SE3DI_OP_VARIABLE:
            *++top =
                (jet){x[in->function], in->mask_a & w.mask ? w.components[in->function] : 0.0, 0.0};
            break;
        case SE3DI_OP_ADD:
            --top;
            *top = (jet){top[0].f + top[1].f, top[0].t + top[1].t, top[0].tt + top[1].tt};
            break;
        case SE3DI_OP_SUBTRACT:
            --top;
            *top = jet_subtract(top[0], top[1]);
            break;
        case SE3DI_OP_MULTIPLY:
            --top;
            *top = jet_multiply(top[0], top[1]);
            break;
        case SE3DI_OP_DIVIDE:
            --top;
            *top = jet_divide(top[0], top[1]);
            break;
        case SE3DI_OP_SHIFT:
            top->f += in->value;
            break;
        case SE3DI_OP_SCALE:
            *top = (jet){top->f * in->value, top->t * in->value, top->tt * in->value};
            break;
        case SE3DI_OP_POWER:
            se3di_function_power(top->f, in->value, d);
            jet_chain(top, d, in->mask_a & w.mask);
            break;
        case SE3DI_OP_UNARY:
            jet_unary(top, in, in->mask_a & w.mask);
            break;
        case SE3DI_OP_BINARY:
            jet_binary(--top, in, w.mask);
            break;
        case SE3DI_OP_SELECT:
            jet_select(--top, in);
            break;
        case SE3DI_OP_STEP:
            jet_step(top -= 4);
            break;
        case SE3DI_OP_JUMP:
            in += in->jump;
            break;
        case SE3DI_OP_JUMP_IF_ZERO:
            in += branch((top--)->f, in->jump, &poison);
            break;
        }
    }
    out[0] = top->f + poison;
    out[1] = top->t + poison;
    out[2] = top->tt + poison;
}

void se3di_program_eval_time(const se3di_instruction *code, size_t count, const double *x,
                             double out[3])
{
    static const double time[1] = {1.0};
    eval_along(code, count, x, (way){1u, time}, out);
}

void se3di_program_eval_along(const se3di_instruction *code, size_t count, const double *x,
                              const double *direction, unsigned mask, double out[3])
{
    eval_along(code, count, x, (way){mask, direction}, out);
}

/* ---- value and first derivatives with respect to all variables ------------------------------*/

typedef struct slope {
    double f, x[SE3D_EXPRESSION_VARIABLE_MAX];
} slope;

/* a_k = da a_k + db b_k */
static inline void slope_combine(slope *a, const slope *b, double da, double db, size_t n)
{
    for (size_t k = 0; k < n; ++k) {
        a->x[k] = da * a->x[k] + db * b->x[k];
    }
}

static inline void slope_chain(slope *u, const double d[3], unsigned mask, size_t n)
{
    u->f = d[0];
    for (size_t k = 0; k < n; ++k) {
        u->x[k] = mask >> k & 1u ? d[1] * u->x[k] : 0.0;
    }
}

static void slope_divide(slope *a, const slope *b, size_t n)
{
    a->f = se3di_over(a->f, b->f);
    for (size_t k = 0; k < n; ++k) {
        a->x[k] = se3di_over(a->x[k] - a->f * b->x[k], b->f);
    }
}

static void slope_binary(slope *a, const se3di_instruction *in, size_t n)
{
    se3di_partials d;
    se3di_functions[in->function].binary(a[0].f, a[1].f, &d);
    a->f = d.f;
    for (size_t k = 0; k < n; ++k) {
        double y = in->mask_a >> k & 1u ? d.a * a[0].x[k] : 0.0;
        a->x[k] = in->mask_b >> k & 1u ? y + d.b * a[1].x[k] : y;
    }
}

static void slope_select(slope *a, const se3di_instruction *in)
{
    se3di_partials d;
    se3di_functions[in->function].binary(a[0].f, a[1].f, &d);
    if (d.b != 0.0) {
        a[0] = a[1];
    }
    a[0].f = d.f;
}

/* As jet_step. */
static void slope_step(slope s[5], size_t n)
{
    slope u = s[0], width = s[3], rise = s[4];
    double d[3];
    u.f -= s[1].f;
    slope_combine(&u, &s[1], 1.0, -1.0, n);
    width.f -= s[1].f;
    slope_combine(&width, &s[1], 1.0, -1.0, n);
    slope_divide(&u, &width, n);
    if (!isfinite(u.f)) {
        d[0] = d[1] = (double)NAN;
        slope_chain(s, d, ~0u, n);
    } else if (u.f <= 0.0) {
        s[0] = s[2];
    } else if (u.f >= 1.0) {
        s[0] = s[4];
    } else {
        se3di_function_smooth_step(u.f, d);
        slope_chain(&u, d, ~0u, n);
        rise.f -= s[2].f;
        slope_combine(&rise, &s[2], 1.0, -1.0, n);
        slope_combine(&rise, &u, u.f, rise.f, n);
        s[0].f = s[2].f + rise.f * u.f;
        for (size_t k = 0; k < n; ++k) {
            s[0].x[k] = s[2].x[k] + rise.x[k];
        }
    }
}

static inline void slope_push(slope *top, double f, unsigned mask, size_t n)
{
    top->f = f;
    for (size_t k = 0; k < n; ++k) {
        top->x[k] = mask >> k & 1u;
    }
}

static void eval_slopes(const se3di_instruction *code, size_t count, const double *x,
                        const size_t n, double *result)
{
    slope stack[SE3DI_PROGRAM_STACK + 1]; /* values begin at stack[1] */
    slope *top = stack;
    double poison = 0.0, d[3];
    for (const se3di_instruction *in = code, *end = code + count; in != end; ++in) {
        switch ((se3di_op)in->op) { /* unreached: no other operation is compiled */
        case SE3DI_OP_CONSTANT:
            slope_push(++top, in->value, 0u, n);
            break;
        case SE3DI_OP_VARIABLE:
            slope_push(++top, x[in->function], in->mask_a, n);
            break;
        case SE3DI_OP_ADD:
            --top;
            top->f += top[1].f;
            slope_combine(top, top + 1, 1.0, 1.0, n);
            break;
        case SE3DI_OP_SUBTRACT:
            --top;
            top->f -= top[1].f;
            slope_combine(top, top + 1, 1.0, -1.0, n);
            break;
        case SE3DI_OP_MULTIPLY:
            --top;
            slope_combine(top, top + 1, top[1].f, top[0].f, n);
            top->f *= top[1].f;
            break;
        case SE3DI_OP_DIVIDE:
            --top;
            slope_divide(top, top + 1, n);
            break;
        case SE3DI_OP_SHIFT:
            top->f += in->value;
            break;
        case SE3DI_OP_SCALE:
            top->f *= in->value;
            for (size_t k = 0; k < n; ++k) {
                top->x[k] *= in->value;
            }
            break;
        case SE3DI_OP_POWER:
            se3di_function_power(top->f, in->value, d);
            slope_chain(top, d, in->mask_a, n);
            break;
        case SE3DI_OP_UNARY:
            se3di_functions[in->function].unary(top->f, d);
            slope_chain(top, d, in->mask_a, n);
            break;
        case SE3DI_OP_BINARY:
            slope_binary(--top, in, n);
            break;
        case SE3DI_OP_SELECT:
            slope_select(--top, in);
            break;
        case SE3DI_OP_STEP:
            slope_step(top -= 4, n);
            break;
        case SE3DI_OP_JUMP:
            in += in->jump;
            break;
        case SE3DI_OP_JUMP_IF_ZERO:
            in += branch((top--)->f, in->jump, &poison);
            break;
        }
    }
    result[0] = top->f + poison;
    for (size_t k = 0; k < n; ++k) {
        result[1 + k] = top->x[k] + poison;
    }
}

void se3di_program_eval(const se3di_instruction *code, size_t count, const double *x, size_t n,
                        double *result)
{
    if (n == 0) {
        (void)eval_values(code, count, x, 1, result);
    } else {
        eval_slopes(code, count, x, n, result);
    }
}
