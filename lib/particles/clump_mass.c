/* SPDX-License-Identifier: BSD-3-Clause */
/* Mass, centre and inertia of a union of spheres. What overlaps counts once: the union is cut by
 * lines along the longest axis of its box, of which each is exact, in the middles of a grid of
 * LINES x LINES over the other two. Spheres that do not overlap are added up exactly.
 *                                                                         docs/theory/clumps.md */
#include "particles/clump.h"

#include "math/inertia.h"
#include "math/quaternion.h"

#include <math.h>

#define PI    3.1415926535897932384626433832795
#define LINES 256
/* Products of inertia below this part of the moments are rounding. */
#define ROUNDING 1e-13
/* Of the largest moment: spheres are never thinner, but given moments may be. */
#define MOMENT_LEAST 1e-12

/* The integrals of 1, x_a, x_a x_b (xx, yy, zz, xy, yz, xz) over the union. */
typedef struct integrals {
    double volume, first[3], moments[6];
} integrals;

static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};

static int overlap(const se3di_clump_ball *balls, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j < i; ++j) {
            double d[3];
            se3di_sub(balls[i].r, balls[j].r, d);
            if (se3di_norm(d) < (balls[i].radius + balls[j].radius) * (1.0 - 1e-12)) {
                return 1;
            }
        }
    }
    return 0;
}

static integrals sum_apart(const se3di_clump_ball *balls, uint32_t count)
{
    integrals sum = {0.0, {0.0}, {0.0}};
    for (uint32_t i = 0; i < count; ++i) {
        const double R = balls[i].radius, volume = 4.0 / 3.0 * PI * R * R * R;
        sum.volume += volume;
        for (int a = 0; a < 3; ++a) {
            sum.first[a] += volume * balls[i].r[a];
        }
        for (int k = 0; k < 6; ++k) {
            const double own = k < 3 ? 0.2 * R * R : 0.0;
            sum.moments[k] += volume * (balls[i].r[row[k]] * balls[i].r[column[k]] + own);
        }
    }
    return sum;
}

/* The part of a line that is in a ball. */
typedef struct span {
    double from, to;
} span;

/* Insert in ascending order of `from`: a line meets few balls. */
static size_t insert(span *spans, size_t count, span s)
{
    size_t k = count;
    for (; k > 0 && spans[k - 1].from > s.from; --k) {
        spans[k] = spans[k - 1];
    }
    spans[k] = s;
    return count + 1;
}

/* One line along axis u, of cross-section `area`, at y along v and z along w. */
typedef struct line {
    int u, v, w;
    double y, z, area;
} line;

static void add_span(const line *at, span s, integrals *sum)
{
    const double length = at->area * (s.to - s.from), middle = 0.5 * (s.from + s.to);
    const double square =
        (s.from * s.from + s.from * s.to + s.to * s.to) / 3.0; /* the mean of x_u^2 */
    double x[3];
    x[at->u] = middle;
    x[at->v] = at->y;
    x[at->w] = at->z;
    sum->volume += length;
    for (int a = 0; a < 3; ++a) {
        sum->first[a] += length * x[a];
    }
    for (int k = 0; k < 6; ++k) {
        const int same = row[k] == at->u && column[k] == at->u;
        sum->moments[k] += length * (same ? square : x[row[k]] * x[column[k]]);
    }
}

static void add_line(const se3di_clump_ball *balls, uint32_t count, const line *at, span *spans,
                     integrals *sum)
{
    size_t met = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const double *r = balls[i].r, dy = at->y - r[at->v], dz = at->z - r[at->w];
        const double square = balls[i].radius * balls[i].radius - dy * dy - dz * dz;
        if (square > 0.0) {
            const double half = sqrt(square);
            met = insert(spans, met, (span){r[at->u] - half, r[at->u] + half});
        }
    }
    for (size_t k = 0; k < met;) {
        span whole = spans[k++];
        for (; k < met && spans[k].from <= whole.to; ++k) {
            whole.to = fmax(whole.to, spans[k].to);
        }
        add_span(at, whole, sum);
    }
}

static void enclose(const se3di_clump_ball *balls, uint32_t count, double low[3], double high[3])
{
    for (int a = 0; a < 3; ++a) {
        low[a] = HUGE_VAL;
        high[a] = -HUGE_VAL;
        for (uint32_t i = 0; i < count; ++i) {
            low[a] = fmin(low[a], balls[i].r[a] - balls[i].radius);
            high[a] = fmax(high[a], balls[i].r[a] + balls[i].radius);
        }
    }
}

static se3d_status sum_lines(const se3d_allocator *allocator, const se3di_clump_ball *balls,
                             uint32_t count, integrals *sum)
{
    double low[3], high[3];
    line at = {.u = 0};
    span *spans = se3di_alloc(allocator, count, sizeof *spans);
    if (!spans) {
        return SE3D_ERR_NO_MEMORY;
    }
    enclose(balls, count, low, high);
    for (int a = 1; a < 3; ++a) {
        at.u = high[a] - low[a] > high[at.u] - low[at.u] ? a : at.u;
    }
    at.v = (at.u + 1) % 3;
    at.w = (at.u + 2) % 3;
    const double dy = (high[at.v] - low[at.v]) / LINES, dz = (high[at.w] - low[at.w]) / LINES;
    at.area = dy * dz;
    *sum = (integrals){0.0, {0.0}, {0.0}};
    for (int j = 0; j < LINES; ++j) {
        at.y = low[at.v] + dy * (j + 0.5);
        for (int k = 0; k < LINES; ++k) {
            at.z = low[at.w] + dz * (k + 0.5);
            add_line(balls, count, &at, spans, sum);
        }
    }
    se3di_free(allocator, spans, count, sizeof *spans);
    return SE3D_OK;
}

/* Inertia about the centre of mass from the integrals. */
static void take_integrals(const integrals *sum, se3di_clump_template *out, double J[6])
{
    double m[6];
    out->volume = sum->volume;
    for (int a = 0; a < 3; ++a) {
        out->centre[a] = sum->first[a] / sum->volume;
    }
    for (int k = 0; k < 6; ++k) {
        m[k] = sum->moments[k] - sum->volume * out->centre[row[k]] * out->centre[column[k]];
    }
    const double least = ROUNDING * (m[0] + m[1] + m[2]);
    for (int k = 0; k < 3; ++k) {
        J[k] = m[(k + 1) % 3] + m[(k + 2) % 3];
        J[3 + k] = fabs(m[3 + k]) < least ? 0.0 : -m[3 + k];
    }
    out->mass = sum->volume;
}

/* What a unit force on the ball moves it by, along and about all axes. */
static void set_mobility(const se3di_clump_template *out, se3di_clump_ball *ball)
{
    double turned[3][3], moments[3];
    for (int a = 0; a < 3; ++a) {
        const double axis[3] = {a == 0, a == 1, a == 2};
        se3di_cross(ball->r, axis, turned[a]);
    }
    for (int k = 0; k < 6; ++k) {
        ball->mobility[k] = k < 3 ? 1.0 / out->mass : 0.0;
        for (int a = 0; a < 3; ++a) {
            ball->mobility[k] += turned[row[k]][a] * turned[column[k]][a] / out->inertia[a];
        }
    }
    se3di_inertia_principal(ball->mobility, moments);
    ball->most = moments[2];
}

/* The balls in the principal axes, and what they are at most. */
static void turn_balls(se3di_clump_template *out, se3di_clump_ball *balls, const double R[9])
{
    out->bound = out->most = 0.0;
    out->smallest = HUGE_VAL;
    for (uint32_t k = 0; k < out->count; ++k) {
        double d[3];
        se3di_sub(balls[k].r, out->centre, d);
        se3di_mul_transposed(R, d, balls[k].r);
        set_mobility(out, &balls[k]);
        out->bound = fmax(out->bound, se3di_norm(d) + balls[k].radius);
        out->smallest = fmin(out->smallest, balls[k].radius);
        out->most = fmax(out->most, balls[k].most);
    }
}

se3d_status se3di_clump_weigh(const se3d_allocator *allocator, se3di_clump_template *out,
                              se3di_clump_ball *balls, const double J[6])
{
    integrals sum = sum_apart(balls, out->count);
    double own[6], R[9];
    if (overlap(balls, out->count)) {
        SE3DI_TRY(sum_lines(allocator, balls, out->count, &sum));
    }
    if (out->given) {
        out->volume = sum.volume;
    } else {
        take_integrals(&sum, out, own);
    }
    se3di_inertia_axes(out->given ? J : own, out->inertia, R);
    const double largest = fmax(out->inertia[0], fmax(out->inertia[1], out->inertia[2]));
    for (int a = 0; a < 3; ++a) {
        if (!(out->inertia[a] > MOMENT_LEAST * largest)) {
            return SE3D_ERR_INVALID_ARGUMENT;
        }
    }
    se3di_quat_from_matrix(R, out->axes);
    turn_balls(out, balls, R);
    return SE3D_OK;
}
