/* SPDX-License-Identifier: BSD-3-Clause */
#include "nonlinear/friction_box.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define CENTRES  8     /* proximal steps */
#define ROUNDS   20    /* of all at once */
#define ACCURACY 1e-13 /* of n between two of the first; of a against its parts */

typedef se3di_friction_box box_problem;

typedef struct workspace {
    double *A;      /* [count * count]: factors of what is inside */
    double *x;      /* [count]: n where all that is inside is at its least */
    double *centre; /* [count] */
    double *rest;   /* [count]: a - S (n - centre) */
    double *size;   /* [count]: of the parts of rest */
} workspace;

static workspace workspace_of(const box_problem *p)
{
    const size_t m = p->count;
    return (workspace){p->work, p->work + m * m, p->work + m * m + m, p->work + m * m + 2 * m,
                       p->work + m * m + 3 * m};
}

static int is_inside(const box_problem *p, uint32_t k)
{
    return !p->fixed[k] && p->at[k] == 0;
}

/* x of those not inside; of those inside the equations, their right-hand side in rest. */
static void set_up(const box_problem *p, const workspace *w)
{
    const uint32_t m = p->count;
    for (uint32_t r = 0; r < m; ++r) {
        const double end = p->at[r] > 0 ? p->limit[r] : -p->limit[r];
        w->x[r] = p->fixed[r] || p->at[r] == 0 ? p->n[r] : end;
    }
    for (uint32_t r = 0; r < m; ++r) {
        double *row = w->A + (size_t)r * m;
        w->rest[r] = p->a[r] + p->share[r] * w->centre[r];
        for (uint32_t c = 0; c < m; ++c) {
            row[c] = p->P[(size_t)r * m + c] + (r == c ? p->share[r] : 0.0);
            w->rest[r] -= is_inside(p, c) ? 0.0 : row[c] * w->x[c];
        }
    }
}

/* A row of Cholesky's factor, and of the solution with it. */
static void factor_row(const box_problem *p, const workspace *w, uint32_t r)
{
    double *row = w->A + (size_t)r * p->count;
    for (uint32_t c = 0; c <= r; ++c) {
        const double *other = w->A + (size_t)c * p->count;
        double sum = row[c];
        for (uint32_t k = 0; k < c && is_inside(p, c); ++k) {
            sum -= is_inside(p, k) ? row[k] * other[k] : 0.0;
        }
        if (c == r) {
            row[c] = sqrt(fmax(sum, 0.5 * p->share[r])); /* what is below is rounding */
            w->rest[r] /= row[c];
        } else if (is_inside(p, c)) {
            row[c] = sum / other[c];
            w->rest[r] -= row[c] * w->rest[c];
        }
    }
}

/* (P + S) x = a_0 + S centre - P (others) of those inside, the others where they are. */
static void minimise(const box_problem *p, const workspace *w)
{
    set_up(p, w);
    for (uint32_t r = 0; r < p->count; ++r) {
        if (is_inside(p, r)) {
            factor_row(p, w, r);
        }
    }
    for (uint32_t r = p->count; r-- > 0;) {
        const double *row = w->A + (size_t)r * p->count;
        if (is_inside(p, r)) {
            w->x[r] = w->rest[r] / row[r];
            for (uint32_t c = 0; c < r; ++c) {
                w->rest[c] -= is_inside(p, c) ? row[c] * w->x[r] : 0.0;
            }
        }
    }
}

/* What is left of the acceleration at x, and of which parts. */
static void eval_rest(const box_problem *p, const workspace *w)
{
    for (uint32_t r = 0; r < p->count; ++r) {
        const double *row = p->P + (size_t)r * p->count;
        const double spring = p->share[r] * (w->x[r] - w->centre[r]);
        double sum = p->a[r] - spring, size = fabs(p->a[r]) + fabs(spring);
        for (uint32_t c = 0; c < p->count; ++c) {
            sum -= row[c] * w->x[c];
            size += fabs(row[c] * w->x[c]);
        }
        w->rest[r] = sum;
        w->size[r] = size;
    }
}

/* How much an element at its limit is driven back from there. */
static double eval_return(const box_problem *p, const workspace *w, uint32_t k)
{
    const double back = p->fixed[k] ? 0.0 : -p->at[k] * w->rest[k];
    return back > ACCURACY * w->size[k] ? back / w->size[k] : 0.0;
}

/* All that contradicts at once. @return whether nothing did */
static int solve_at_once(const box_problem *p, const workspace *w)
{
    for (int round = 0; round < ROUNDS; ++round) {
        uint32_t changes = 0;
        minimise(p, w);
        eval_rest(p, w);
        for (uint32_t k = 0; k < p->count; ++k) {
            int32_t at = p->at[k];
            if (is_inside(p, k) && fabs(w->x[k]) > p->limit[k]) {
                at = w->x[k] > 0.0 ? 1 : -1;
            } else if (eval_return(p, w, k) > 0.0) {
                at = 0;
            }
            changes += at != p->at[k];
            p->at[k] = at;
        }
        if (changes == 0) {
            memcpy(p->n, w->x, p->count * sizeof *p->n);
            return 1;
        }
    }
    return 0;
}

/* n goes towards x until the first element meets its limit. @return whether it came to x */
static int go(const box_problem *p, const workspace *w)
{
    uint32_t first = p->count;
    double way = 1.0;
    for (uint32_t k = 0; k < p->count; ++k) {
        if (is_inside(p, k) && fabs(w->x[k]) > p->limit[k]) {
            const double end = w->x[k] > 0.0 ? p->limit[k] : -p->limit[k];
            const double part = fmax(0.0, (end - p->n[k]) / (w->x[k] - p->n[k]));
            first = part < way ? k : first;
            way = fmin(way, part);
        }
    }
    for (uint32_t k = 0; k < p->count; ++k) {
        p->n[k] += is_inside(p, k) ? way * (w->x[k] - p->n[k]) : 0.0;
    }
    if (first < p->count) {
        p->at[first] = w->x[first] > 0.0 ? 1 : -1;
        p->n[first] = p->at[first] > 0 ? p->limit[first] : -p->limit[first];
    }
    return first == p->count;
}

/* One after the other, from any n within the limits: the objective falls with every return, so no
 * set comes twice; rounding ends it, too. */
static void solve_in_turn(const box_problem *p, const workspace *w)
{
    const uint32_t most = 20 * p->count + 20;
    for (uint32_t k = 0; k < p->count; ++k) {
        if (!p->fixed[k]) {
            p->n[k] = fmin(fmax(p->n[k], -p->limit[k]), p->limit[k]);
            p->at[k] = 0;
        }
    }
    for (uint32_t round = 0; round < most; ++round) {
        uint32_t worst = p->count;
        double back = 0.0;
        minimise(p, w);
        if (!go(p, w)) {
            continue;
        }
        eval_rest(p, w);
        for (uint32_t k = 0; k < p->count; ++k) {
            const double returns = eval_return(p, w, k);
            worst = returns > back ? k : worst;
            back = fmax(back, returns);
        }
        if (worst == p->count) {
            return;
        }
        p->at[worst] = 0;
    }
}

void se3di_friction_box_solve(const box_problem *p)
{
    const workspace w = workspace_of(p);
    double change = HUGE_VAL;
    for (uint32_t k = 0; k < p->count; ++k) {
        w.centre[k] = p->fixed[k] ? p->n[k] : 0.0;
        p->n[k] = w.centre[k];
        p->at[k] = p->fixed[k] ? p->at[k] : 0;
    }
    for (int step = 0; step < CENTRES && change > ACCURACY; ++step) {
        if (!solve_at_once(p, &w)) {
            solve_in_turn(p, &w);
        }
        change = 0.0;
        for (uint32_t k = 0; k < p->count; ++k) {
            const double scale = fmax(fabs(p->n[k]), fabs(w.centre[k]));
            change = fmax(change, scale > 0.0 ? fabs(p->n[k] - w.centre[k]) / scale : 0.0);
            w.centre[k] = p->n[k];
        }
    }
}
