/* SPDX-License-Identifier: BSD-3-Clause */
/* Every primitive of the table, in both formulations: Jacobian, gamma and curvature against central
 * differences, at random states with every datum of the term and of both bodies random.
 *
 * A difference D(h) of a smooth function has the error C h^2 + O(h^4). So three things are asked of
 * an analytic derivative: the extrapolated (4 D(h/2) - D(h))/3 equals it to rounding and O(h^4),
 * the error of D(h) is four times that of D(h/2) wherever it stands clear of rounding, and D is not
 * bitwise equal to it (a thing cannot be compared with itself). */
#include "check.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/euler_norm.h"
#include "primitive/primitive.h"

#define STATES   100
#define STEP     1e-3
#define MAX_SIZE 14
#define PI       3.14159265358979323846

typedef enum formulation { ROMEGA = 0, RP = 1 } formulation;
typedef enum arrangement {
    BOTH_MOVE = 0,
    I_IS_GROUND = 1,
    J_IS_GROUND = 2,
    ARRANGEMENTS
} arrangement;

/* A body's motion: r(t) and, in r-omega, A exp(theta(t)), in r-p p(t), each a cubic of which the
 * derivatives at t = 0 are given. q[1] is the velocity and q[2] the acceleration of the unknowns.
 */
typedef struct motion {
    double r[4][3];
    double p[4][4];     /* p[0] is the pose at t = 0 in both formulations */
    double theta[4][3]; /* theta[0] = 0 */
} motion;

typedef struct problem {
    const se3di_primitive *primitive;
    formulation kind;
    se3di_term term;
    motion i, j;
} problem;

typedef struct tally {
    int slopes;    /* errors that stood clear of rounding, and so had their slope checked */
    int identical; /* differences bitwise equal to the analytic derivative */
    int compared;
} tally;

static uint64_t seed = UINT64_C(0x853c49e6748fea9b);
static double worst; /* largest |extrapolated - analytic| of a test */

static void random_values(double *values, int count)
{
    for (int k = 0; k < count; ++k) {
        values[k] = check_random(&seed);
    }
}

static void random_unit(double *values, int count)
{
    double square = 0;
    while (square < 0.1 || square > 1) {
        random_values(values, count);
        square = 0;
        for (int k = 0; k < count; ++k) {
            square += values[k] * values[k];
        }
    }
    for (int k = 0; k < count; ++k) {
        values[k] /= sqrt(square);
    }
}

static int size_of(formulation kind)
{
    return kind == RP ? 7 : 6;
}

static double cubic(double c0, double c1, double c2, double c3, double t)
{
    return c0 + t * (c1 + t * (c2 / 2 + t * c3 / 6));
}

static double cubic_rate(double c1, double c2, double c3, double t)
{
    return c1 + t * (c2 + t * c3 / 2);
}

/* The frame at time t. A frame for r-omega has no pdot and one for r-p no w (NaN): what one
 * formulation's functions read, the other's must not need. */
static se3di_frame frame_at(const motion *m, formulation kind, double t)
{
    se3di_frame f;
    double theta[3];
    double theta_rate[3];
    for (int k = 0; k < 3; ++k) {
        f.r[k] = cubic(m->r[0][k], m->r[1][k], m->r[2][k], m->r[3][k], t);
        f.v[k] = cubic_rate(m->r[1][k], m->r[2][k], m->r[3][k], t);
        theta[k] = cubic(0.0, m->theta[1][k], m->theta[2][k], m->theta[3][k], t);
        theta_rate[k] = cubic_rate(m->theta[1][k], m->theta[2][k], m->theta[3][k], t);
        f.w[k] = (double)NAN;
    }
    for (int k = 0; k < 4; ++k) {
        f.p[k] = cubic(m->p[0][k], m->p[1][k], m->p[2][k], m->p[3][k], t);
        f.pdot[k] = kind == RP ? cubic_rate(m->p[1][k], m->p[2][k], m->p[3][k], t) : (double)NAN;
    }
    if (kind == ROMEGA) {
        double T[9];
        se3di_quat_rotate(m->p[0], theta, f.p);
        se3di_exp_tangent(theta, T);
        se3di_mul(T, theta_rate, f.w);
    }
    se3di_quat_to_matrix(f.p, f.A);
    if (kind == ROMEGA) {
        for (int k = 0; k < 4; ++k) {
            f.p[k] = (double)NAN;
        }
    }
    return f;
}

static motion ground_motion(void)
{
    motion m;
    memset(&m, 0, sizeof m);
    m.p[0][0] = 1.0;
    return m;
}

static motion random_motion(formulation kind)
{
    motion m;
    random_values(&m.r[0][0], 12);
    random_values(&m.p[0][0], 16);
    random_values(&m.theta[0][0], 12);
    random_unit(m.p[0], 4);
    if (kind == RP) { /* the derivatives with respect to p hold off the unit sphere, too */
        const double length = 1 + 0.2 * check_random(&seed);
        for (int k = 0; k < 4; ++k) {
            m.p[0][k] *= length;
        }
    }
    return m;
}

static se3di_term random_term(int type)
{
    se3di_term t;
    memset(&t, 0, sizeof t);
    t.type = type;
    t.angle = -1;
    t.body_i = 3;
    t.body_j = 5;
    t.coefficient = 1.0;
    random_values(t.a_i, 3);
    random_values(t.a_j, 3);
    random_values(t.s_i, 3);
    random_values(t.s_j, 3);
    random_values(t.c, 3);
    random_unit(t.b_i, 3);
    if (type == SE3DI_PRIMITIVE_ANGLE) {
        double any[3];
        random_unit(any, 3);
        se3di_cross(t.b_i, any, t.a_i);
        se3di_scale(1 / se3di_norm(t.a_i), t.a_i, t.a_i);
        random_unit(t.a_j, 3);
    }
    return t;
}

/* ANGLE: how far a_j is from the axis; the derivatives grow without bound near it. */
static int is_regular(const problem *x)
{
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double b[3];
    double h[3];
    double n[3];
    se3di_mul(i.A, x->term.b_i, b);
    se3di_mul(j.A, x->term.a_j, h);
    se3di_cross(b, h, n);
    return x->term.type != SE3DI_PRIMITIVE_ANGLE || se3di_norm(n) > 0.5;
}

static problem random_problem(int type, formulation kind, arrangement bodies)
{
    problem x;
    do {
        x.primitive = &se3di_primitives[type];
        x.kind = kind;
        x.term = random_term(type);
        x.i = bodies == I_IS_GROUND ? ground_motion() : random_motion(kind);
        x.j = bodies == J_IS_GROUND ? ground_motion() : random_motion(kind);
    } while (!is_regular(&x));
    return x;
}

/* The Jacobian as one row: body i, body j. */
static void row_of(const problem *x, const se3di_frame *i, const se3di_frame *j, double *row)
{
    if (x->kind == RP) {
        x->primitive->jacobian_rp(&x->term, i, j, row, row + 7);
    } else {
        x->primitive->jacobian_romega(&x->term, i, j, row, row + 6);
    }
}

static double gamma_of(const problem *x, const se3di_frame *i, const se3di_frame *j)
{
    return x->kind == RP ? x->primitive->gamma_rp(&x->term, i, j)
                         : x->primitive->gamma_romega(&x->term, i, j);
}

static void curvature_of(const problem *x, const se3di_frame *i, const se3di_frame *j,
                         double lambda, double *H)
{
    if (x->kind == RP) {
        x->primitive->curvature_rp(&x->term, i, j, lambda, H);
    } else {
        x->primitive->curvature_romega(&x->term, i, j, lambda, H);
    }
}

/* The order-th derivative (1: velocity, 2: acceleration) of the unknowns at t = 0. */
static void unknowns_rate(const problem *x, int order, double *q)
{
    const int size = size_of(x->kind);
    const motion *bodies[2] = {&x->i, &x->j};
    for (int b = 0; b < 2; ++b) {
        const motion *m = bodies[b];
        const double *turn = x->kind == RP ? m->p[order] : m->theta[order];
        memcpy(q + b * size, m->r[order], 3 * sizeof(double));
        memcpy(q + b * size + 3, turn, (size_t)(size - 3) * sizeof(double));
    }
}

static double product(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int k = 0; k < count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* Compare the differences `coarse` (step STEP) and `fine` (half of it) with `exact`. */
static void compare(const double *coarse, const double *fine, const double *exact, int count,
                    tally *sum)
{
    double error[2] = {0, 0};
    double scale = 1;
    for (int k = 0; k < count; ++k) {
        scale = fmax(scale, fabs(exact[k]));
    }
    for (int k = 0; k < count; ++k) {
        const double extrapolated = (4 * fine[k] - coarse[k]) / 3;
        CHECK_NEAR(extrapolated, exact[k], 1e-8 * scale);
        worst = fmax(worst, fabs(extrapolated - exact[k]) / scale);
        error[0] = fmax(error[0], fabs(coarse[k] - exact[k]));
        error[1] = fmax(error[1], fabs(fine[k] - exact[k]));
        if (exact[k] != 0.0) { /* a zero block is zero in differences, too */
            sum->identical += memcmp(&fine[k], &exact[k], sizeof(double)) == 0;
            ++sum->compared;
        }
    }
    CHECK(error[0] < 1e-2 * scale);
    if (error[0] > 2e-8 * scale) {
        CHECK(error[0] > 3 * error[1]);
        CHECK(error[0] < 5 * error[1]);
        ++sum->slopes;
    }
}

/* Frames in which unknown `column` of the pair is moved by `step`. */
static void moved_frames(const problem *x, int column, double step, se3di_frame frames[2])
{
    const int size = size_of(x->kind);
    motion at[2] = {x->i, x->j};
    motion *m = &at[column / size];
    const int c = column % size;
    memset(m->r[1], 0, 9 * sizeof(double));
    memset(m->p[1], 0, 12 * sizeof(double));
    memset(m->theta[1], 0, 9 * sizeof(double));
    if (c < 3) {
        m->r[1][c] = 1;
    } else if (x->kind == RP) {
        m->p[1][c - 3] = 1;
    } else {
        m->theta[1][c - 3] = 1;
    }
    for (int b = 0; b < 2; ++b) {
        frames[b] = frame_at(&at[b], x->kind, b == column / size ? step : 0.0);
    }
}

/* An angle's difference does not jump where the angle does. */
static double difference(const problem *x, const double values[2])
{
    const double change = values[1] - values[0];
    return x->term.type == SE3DI_PRIMITIVE_ANGLE ? remainder(change, 2 * PI) : change;
}

/* For every primitive, formulation, arrangement of bodies: `check` at random states; then: the
 * slope was seen at least so often, and the differences were differences. */
static void over_the_table(void (*check)(const problem *x, tally *sum), int least_slopes)
{
    worst = 0;
    for (int type = 0; type < SE3DI_PRIMITIVE_COUNT; ++type) {
        for (int kind = ROMEGA; kind <= RP; ++kind) {
            tally sum = {0, 0, 0};
            for (int bodies = BOTH_MOVE; bodies < ARRANGEMENTS; ++bodies) {
                for (int n = 0; n < STATES; ++n) {
                    const problem x = random_problem(type, (formulation)kind, (arrangement)bodies);
                    check(&x, &sum);
                }
            }
            CHECK(sum.slopes >= least_slopes);
            CHECK(2 * sum.identical < sum.compared);
        }
    }
    printf("%s: largest relative deviation after extrapolation %.1e\n", check_case, worst);
}

static void check_columns(const problem *x, tally *sum)
{
    const int n = 2 * size_of(x->kind);
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double exact[MAX_SIZE];
    double D[2][MAX_SIZE];
    row_of(x, &i, &j, exact);
    for (int c = 0; c < n; ++c) {
        for (int half = 0; half < 2; ++half) {
            const double h = half ? STEP / 2 : STEP;
            double values[2];
            for (int side = 0; side < 2; ++side) {
                se3di_frame f[2];
                moved_frames(x, c, side ? h : -h, f);
                values[side] = x->primitive->value(&x->term, &f[0], &f[1]);
            }
            D[half][c] = difference(x, values) / (2 * h);
        }
    }
    compare(D[0], D[1], exact, n, sum);
}

static void every_column_of_the_jacobian_is_a_derivative_of_the_value(void)
{
    over_the_table(check_columns,
                   0); /* in r-p, DP1 and CD are quadratic in each unknown: no slope */
}

static void check_path(const problem *x, tally *sum)
{
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double row[MAX_SIZE];
    double rate[MAX_SIZE];
    double D[2];
    row_of(x, &i, &j, row);
    unknowns_rate(x, 1, rate);
    const double exact = product(row, rate, 2 * size_of(x->kind));
    for (int half = 0; half < 2; ++half) {
        const double h = half ? STEP / 2 : STEP;
        double values[2];
        for (int side = 0; side < 2; ++side) {
            const double t = side ? h : -h;
            const se3di_frame f = frame_at(&x->i, x->kind, t);
            const se3di_frame g = frame_at(&x->j, x->kind, t);
            values[side] = x->primitive->value(&x->term, &f, &g);
        }
        D[half] = difference(x, values) / (2 * h);
    }
    compare(&D[0], &D[1], &exact, 1, sum);
}

static void the_jacobian_times_the_velocity_is_the_rate_of_the_value(void)
{
    over_the_table(check_path, 2 * STATES);
}

/* Phi_q qdot at time t of the motion. */
static double rate_at(const problem *x, double t)
{
    const int size = size_of(x->kind);
    se3di_frame f[2] = {frame_at(&x->i, x->kind, t), frame_at(&x->j, x->kind, t)};
    double row[MAX_SIZE];
    double rate[MAX_SIZE];
    row_of(x, &f[0], &f[1], row);
    for (int b = 0; b < 2; ++b) {
        const double *turn = x->kind == RP ? f[b].pdot : f[b].w;
        memcpy(rate + b * size, f[b].v, 3 * sizeof(double));
        memcpy(rate + b * size + 3, turn, (size_t)(size - 3) * sizeof(double));
    }
    return product(row, rate, 2 * size);
}

/* d/dt (Phi_q qdot) = Phi_q qddot - gamma. (At theta = 0, wdot is the second derivative of theta,
 * because dT/dt thetadot = -1/2 thetadot x thetadot = 0.) */
static void check_gamma(const problem *x, tally *sum)
{
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double row[MAX_SIZE];
    double acceleration[MAX_SIZE];
    row_of(x, &i, &j, row);
    unknowns_rate(x, 2, acceleration);
    const double exact = product(row, acceleration, 2 * size_of(x->kind)) - gamma_of(x, &i, &j);
    const double coarse = (rate_at(x, STEP) - rate_at(x, -STEP)) / (2 * STEP);
    const double fine = (rate_at(x, STEP / 2) - rate_at(x, -STEP / 2)) / STEP;
    compare(&coarse, &fine, &exact, 1, sum);
}

static void gamma_is_what_the_rate_changes_by_beyond_the_accelerations(void)
{
    over_the_table(check_gamma, 2 * STATES);
}

static void check_curvature_columns(const problem *x, tally *sum)
{
    const int n = 2 * size_of(x->kind);
    const double lambda = 2 + check_random(&seed);
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double H[MAX_SIZE * MAX_SIZE];
    memset(H, 0, sizeof H);
    curvature_of(x, &i, &j, lambda, H);
    for (int c = 0; c < n; ++c) {
        double D[2][MAX_SIZE];
        double exact[MAX_SIZE];
        for (int half = 0; half < 2; ++half) {
            const double h = half ? STEP / 2 : STEP;
            double rows[2][MAX_SIZE];
            for (int side = 0; side < 2; ++side) {
                se3di_frame f[2];
                moved_frames(x, c, side ? h : -h, f);
                row_of(x, &f[0], &f[1], rows[side]);
            }
            for (int k = 0; k < n; ++k) {
                D[half][k] = lambda * (rows[1][k] - rows[0][k]) / (2 * h);
            }
        }
        for (int k = 0; k < n; ++k) {
            exact[k] = H[n * k + c];
        }
        compare(D[0], D[1], exact, n, sum);
    }
}

static void every_column_of_the_curvature_is_a_derivative_of_the_jacobian(void)
{
    over_the_table(check_curvature_columns, 0);
}

static void check_curvature_path(const problem *x, tally *sum)
{
    const int n = 2 * size_of(x->kind);
    const double lambda = -2 + check_random(&seed);
    const se3di_frame i = frame_at(&x->i, x->kind, 0);
    const se3di_frame j = frame_at(&x->j, x->kind, 0);
    double H[MAX_SIZE * MAX_SIZE];
    double rate[MAX_SIZE];
    double exact[MAX_SIZE];
    double D[2][MAX_SIZE];
    memset(H, 0, sizeof H);
    curvature_of(x, &i, &j, lambda, H);
    unknowns_rate(x, 1, rate);
    for (int half = 0; half < 2; ++half) {
        const double h = half ? STEP / 2 : STEP;
        double rows[2][MAX_SIZE];
        for (int side = 0; side < 2; ++side) {
            const se3di_frame f = frame_at(&x->i, x->kind, side ? h : -h);
            const se3di_frame g = frame_at(&x->j, x->kind, side ? h : -h);
            row_of(x, &f, &g, rows[side]);
        }
        for (int k = 0; k < n; ++k) {
            exact[k] = product(H + n * k, rate, n);
            D[half][k] = lambda * (rows[1][k] - rows[0][k]) / (2 * h);
        }
    }
    /* Rotations only: the translational rows of CD, DP1 and ANGLE are constant. */
    const int size = size_of(x->kind);
    double parts[3][MAX_SIZE];
    int count = 0;
    for (int k = 0; k < n; ++k) {
        if (k % size >= 3) {
            parts[0][count] = D[0][k];
            parts[1][count] = D[1][k];
            parts[2][count++] = exact[k];
        } else {
            CHECK_NEAR((4 * D[1][k] - D[0][k]) / 3, exact[k], 1e-8);
        }
    }
    compare(parts[0], parts[1], parts[2], count, sum);
}

static void the_curvature_times_the_velocity_is_the_rate_of_the_jacobian(void)
{
    over_the_table(check_curvature_path, 2 * STATES);
}

/* A state of the two formulations at once: unit p, w and pdot that belong together. */
static se3di_frame consistent_frame(int ground)
{
    se3di_frame f;
    memset(&f, 0, sizeof f);
    f.p[0] = 1.0;
    if (!ground) {
        random_values(f.r, 3);
        random_values(f.v, 3);
        random_values(f.w, 3);
        random_unit(f.p, 4);
    }
    se3di_quat_rate(f.p, f.w, f.pdot);
    se3di_quat_to_matrix(f.p, f.A);
    return f;
}

/* Phi_p = 2 phi_theta G + rho p^T with rho = Phi_p p, and so, because pddot = 1/2 G^T wdot -
 * 1/4 (w.w) p, gamma_rp = gamma_romega - 1/4 sum (w.w) rho. */
static void check_relations(int type, arrangement bodies)
{
    const se3di_primitive *primitive = &se3di_primitives[type];
    const se3di_term t = random_term(type);
    const se3di_frame f[2] = {consistent_frame(bodies == I_IS_GROUND),
                              consistent_frame(bodies == J_IS_GROUND)};
    double romega[2][6];
    double rp[2][7];
    primitive->jacobian_romega(&t, &f[0], &f[1], romega[0], romega[1]);
    primitive->jacobian_rp(&t, &f[0], &f[1], rp[0], rp[1]);
    double gamma = primitive->gamma_romega(&t, &f[0], &f[1]);
    double scale = 1;
    for (int b = 0; b < 2; ++b) {
        double expected[4];
        const double rho = product(rp[b] + 3, f[b].p, 4);
        se3di_g_transposed_mul(f[b].p, romega[b] + 3, expected);
        scale = fmax(scale, se3di_norm(romega[b] + 3));
        for (int k = 0; k < 3; ++k) {
            CHECK_NEAR(rp[b][k], romega[b][k], 1e-15);
        }
        for (int k = 0; k < 4; ++k) {
            CHECK_NEAR(rp[b][3 + k], 2 * expected[k] + rho * f[b].p[k], 4e-14 * scale);
        }
        gamma -= 0.25 * se3di_dot(f[b].w, f[b].w) * rho;
    }
    CHECK_NEAR(primitive->gamma_rp(&t, &f[0], &f[1]), gamma, 1e-13 * scale * scale);
}

static void the_two_formulations_are_related_exactly(void)
{
    for (int type = 0; type < SE3DI_PRIMITIVE_COUNT; ++type) {
        for (int bodies = BOTH_MOVE; bodies < ARRANGEMENTS; ++bodies) {
            for (int n = 0; n < STATES; ++n) {
                check_relations(type, (arrangement)bodies);
            }
        }
    }
}

/* All numbers that the functions of a primitive return. */
#define ALL_RESULTS (1 + 12 + 14 + 2 + 144 + 196)

static void all_results(const se3di_term *t, const se3di_frame *i, const se3di_frame *j,
                        double *out)
{
    const se3di_primitive *primitive = &se3di_primitives[t->type];
    memset(out, 0, ALL_RESULTS * sizeof *out);
    out[0] = primitive->value(t, i, j);
    primitive->jacobian_romega(t, i, j, out + 1, out + 7);
    primitive->jacobian_rp(t, i, j, out + 13, out + 20);
    out[27] = primitive->gamma_romega(t, i, j);
    out[28] = primitive->gamma_rp(t, i, j);
    primitive->curvature_romega(t, i, j, 1.5, out + 29);
    primitive->curvature_rp(t, i, j, 1.5, out + 29 + 144);
}

static void coefficient_and_indices_do_not_matter(void)
{
    for (int type = 0; type < SE3DI_PRIMITIVE_COUNT; ++type) {
        const se3di_frame i = consistent_frame(0);
        const se3di_frame j = consistent_frame(0);
        se3di_term t = random_term(type);
        double before[ALL_RESULTS];
        double after[ALL_RESULTS];
        all_results(&t, &i, &j, before);
        t.coefficient = -7.5;
        t.angle = 2;
        t.body_i = 0;
        t.body_j = 1;
        all_results(&t, &i, &j, after);
        CHECK(memcmp(before, after, sizeof before) == 0);
        CHECK(before[0] != 0.0 && before[27] != 0.0);
    }
}

static void curvature_is_added_and_proportional_to_the_multiplier(void)
{
    for (int type = 0; type < SE3DI_PRIMITIVE_COUNT; ++type) {
        for (int kind = ROMEGA; kind <= RP; ++kind) {
            const problem x = random_problem(type, (formulation)kind, BOTH_MOVE);
            const se3di_frame i = frame_at(&x.i, x.kind, 0);
            const se3di_frame j = frame_at(&x.j, x.kind, 0);
            const int n = 2 * size_of(x.kind);
            double H[MAX_SIZE * MAX_SIZE];
            double once[MAX_SIZE * MAX_SIZE];
            memset(once, 0, sizeof once);
            for (int k = 0; k < n * n; ++k) {
                H[k] = k;
            }
            curvature_of(&x, &i, &j, 1.0, once);
            curvature_of(&x, &i, &j, -3.0, H);
            for (int k = 0; k < n * n; ++k) {
                CHECK_NEAR(H[k], k - 3 * once[k], 1e-12);
            }
        }
    }
}

static void curvature_of_rp_is_symmetric(void)
{
    for (int type = 0; type < SE3DI_PRIMITIVE_COUNT; ++type) {
        for (int n = 0; n < STATES; ++n) {
            const problem x = random_problem(type, RP, BOTH_MOVE);
            const se3di_frame i = frame_at(&x.i, x.kind, 0);
            const se3di_frame j = frame_at(&x.j, x.kind, 0);
            double H[196];
            memset(H, 0, sizeof H);
            curvature_of(&x, &i, &j, 1.0, H);
            for (int r = 0; r < 14; ++r) {
                for (int c = 0; c < r; ++c) {
                    CHECK_NEAR(H[14 * r + c], H[14 * c + r], 1e-13);
                }
            }
        }
    }
}

/* ANGLE on two frames of which j is turned about b_i by the angle, and j's direction tilted out of
 * the plane. */
static double angle_after_turn(double turn, double tilt)
{
    const se3di_frame i = consistent_frame(0);
    se3di_frame j = i;
    se3di_term t = random_term(SE3DI_PRIMITIVE_ANGLE);
    double theta[3];
    se3di_copy(t.a_i, t.a_j);
    se3di_add_scaled(tilt, t.b_i, t.a_j);
    se3di_scale(turn, t.b_i, theta);
    se3di_quat_rotate(i.p, theta, j.p);
    se3di_quat_to_matrix(j.p, j.A);
    return se3di_primitives[SE3DI_PRIMITIVE_ANGLE].value(&t, &i, &j);
}

static void the_angle_is_that_of_a_right_handed_turn(void)
{
    for (int n = 0; n < STATES; ++n) {
        const double turn = PI * check_random(&seed);
        CHECK_NEAR(angle_after_turn(turn, 0.0), turn, 4e-15);
        CHECK_NEAR(angle_after_turn(turn, 2.0), turn, 1e-14);
    }
}

static se3di_frame identity_frame(void)
{
    return consistent_frame(1);
}

static void half_a_turn_is_plus_pi(void)
{
    const se3di_frame ground = identity_frame();
    se3di_term t = random_term(SE3DI_PRIMITIVE_ANGLE);
    const double x[3] = {1, 0, 0};
    const double y[3] = {0, 1, 0};
    const double back[3] = {-1, -0.0, -0.0};
    se3di_copy(x, t.a_i);
    se3di_copy(back, t.a_j);
    for (int sign = -1; sign <= 1; sign += 2) { /* s is +0 for one sense and -0 for the other */
        se3di_scale(sign, y, t.b_i);
        CHECK_NEAR(se3di_primitives[SE3DI_PRIMITIVE_ANGLE].value(&t, &ground, &ground), PI, 0.0);
    }
}

static void exact_eighths_of_a_turn_are_found(void)
{
    const se3di_frame ground = identity_frame();
    se3di_term t = random_term(SE3DI_PRIMITIVE_ANGLE);
    const double x[3] = {1, 0, 0};
    const double z[3] = {0, 0, 1};
    static const double c[8] = {1, 1, 0, -1, -1, -1, 0, 1};
    se3di_copy(x, t.a_i);
    se3di_copy(z, t.b_i);
    for (int k = 0; k < 8; ++k) {
        const double direction[3] = {c[k], c[(k + 6) % 8], 0.5};
        const double expected = k <= 4 ? k * PI / 4 : (k - 8) * PI / 4;
        se3di_copy(direction, t.a_j);
        CHECK_NEAR(se3di_primitives[SE3DI_PRIMITIVE_ANGLE].value(&t, &ground, &ground), expected,
                   1e-15);
    }
}

static void an_angle_without_meaning_is_not_a_number(void)
{
    const se3di_frame ground = identity_frame();
    se3di_term t = random_term(SE3DI_PRIMITIVE_ANGLE);
    const double x[3] = {1, 0, 0};
    const double z[3] = {0, 0, 1};
    double out[ALL_RESULTS];
    se3di_copy(x, t.a_i);
    se3di_copy(z, t.b_i);
    se3di_copy(z, t.a_j);
    all_results(&t, &ground, &ground, out);
    static const int numbers[] = {0, 4, 10, 16, 23, 27, 28, 29 + 12 * 3 + 3, 29 + 144 + 14 * 3 + 3};
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; ++k) {
        CHECK(isnan(out[numbers[k]]));
    }
}

/* The driven pendulum of the ME751 course at t = 0, whose Jacobian Haug's formulas give as
 * combinations of L, sin(pi/8), cos(pi/8): i = the bar, j = the ground. */
static void the_pendulum_of_the_course_has_its_known_jacobian(void)
{
    const double c = 0.5 * sqrt(2 + sqrt(2.0)); /* cos(pi/8) */
    const double s = 0.5 * sqrt(2 - sqrt(2.0));
    const double h = sqrt(0.5);
    const double A[9] = {0, 0, 1, h, h, 0, -h, h, 0};
    const double expected[5][7] = {
        {-1, 0, 0, 2 * sqrt(2.0) * c, 2 * sqrt(2.0) * s, -2 * sqrt(2.0) * c, -2 * sqrt(2.0) * s},
        {0, -1, 0, 2 * sqrt(2.0) * s, 2 * sqrt(2.0) * c, 2 * sqrt(2.0) * s, 2 * sqrt(2.0) * c},
        {0, 0, -1, -2 * sqrt(2.0) * c, 2 * sqrt(2.0) * s, -2 * sqrt(2.0) * c, 2 * sqrt(2.0) * s},
        {0, 0, 0, sqrt(2.0) * c, sqrt(2.0) * s, -sqrt(2.0) * c, -sqrt(2.0) * s},
        {0, 0, 0, -sqrt(2.0) * s, sqrt(2.0) * c, sqrt(2.0) * s, -sqrt(2.0) * c},
    };
    const se3di_frame ground = identity_frame();
    se3di_frame bar = identity_frame();
    memcpy(bar.A, A, sizeof A);
    se3di_quat_from_matrix(A, bar.p);
    bar.r[1] = 2 * h;
    bar.r[2] = -2 * h;
    for (int k = 0; k < 5; ++k) {
        se3di_term t;
        double phi_i[7];
        double phi_j[7];
        memset(&t, 0, sizeof t);
        t.s_i[0] = -2;
        t.c[k % 3] = 1;
        t.a_i[k % 3] = 1; /* rows 3 and 4: x' and y' against X */
        t.a_j[0] = 1;
        const se3di_primitive *p =
            &se3di_primitives[k < 3 ? SE3DI_PRIMITIVE_CD : SE3DI_PRIMITIVE_DP1];
        CHECK_NEAR(p->value(&t, &bar, &ground), 0.0, 1e-15);
        p->jacobian_rp(&t, &bar, &ground, phi_i, phi_j);
        for (int n = 0; n < 7; ++n) {
            CHECK_NEAR(phi_i[n], expected[k][n], 1e-14);
        }
    }
}

static void the_normalisation_has_its_derivatives(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double pdot[4];
        double pddot[4];
        double phi_p[4];
        double sides[2];
        random_values(p, 4);
        random_values(pdot, 4);
        random_values(pddot, 4);
        for (int k = 0; k < 4; ++k) {
            phi_p[k] = 2.0 * p[k];
        }
        /* p(t) = p + pdot t + pddot t^2/2 makes a quartic: differences at t = +-1, less the odd
         * cubic term pdot.pddot and the quartic pddot.pddot/4, are exact. */
        for (int side = 0; side < 2; ++side) {
            const double t = side ? 1 : -1;
            double q[4];
            for (int k = 0; k < 4; ++k) {
                q[k] = p[k] + t * pdot[k] + 0.5 * pddot[k];
            }
            sides[side] = se3di_euler_norm_value(q);
        }
        CHECK_NEAR(0.5 * (sides[1] - sides[0]), product(phi_p, pdot, 4) + product(pdot, pddot, 4),
                   1e-14);
        CHECK_NEAR(sides[1] + sides[0] - 2 * se3di_euler_norm_value(p),
                   product(phi_p, pddot, 4) - se3di_euler_norm_gamma(pdot) +
                       0.5 * product(pddot, pddot, 4),
                   1e-14);
    }
    const double unit[4] = {0.5, -0.5, 0.5, 0.5};
    CHECK_NEAR(se3di_euler_norm_value(unit), 0.0, 0.0);
}

static void the_table_has_a_name_for_every_primitive(void)
{
    static const char *const names[SE3DI_PRIMITIVE_COUNT] = {"dp1", "dp2",   "d",
                                                             "cd",  "angle", "triple"};
    for (int k = 0; k < SE3DI_PRIMITIVE_COUNT; ++k) {
        CHECK(strcmp(se3di_primitives[k].name, names[k]) == 0);
    }
}

int main(void)
{
    RUN(every_column_of_the_jacobian_is_a_derivative_of_the_value);
    RUN(the_jacobian_times_the_velocity_is_the_rate_of_the_value);
    RUN(gamma_is_what_the_rate_changes_by_beyond_the_accelerations);
    RUN(every_column_of_the_curvature_is_a_derivative_of_the_jacobian);
    RUN(the_curvature_times_the_velocity_is_the_rate_of_the_jacobian);
    RUN(the_two_formulations_are_related_exactly);
    RUN(coefficient_and_indices_do_not_matter);
    RUN(curvature_is_added_and_proportional_to_the_multiplier);
    RUN(curvature_of_rp_is_symmetric);
    RUN(the_angle_is_that_of_a_right_handed_turn);
    RUN(half_a_turn_is_plus_pi);
    RUN(exact_eighths_of_a_turn_are_found);
    RUN(an_angle_without_meaning_is_not_a_number);
    RUN(the_pendulum_of_the_course_has_its_known_jacobian);
    RUN(the_normalisation_has_its_derivatives);
    RUN(the_table_has_a_name_for_every_primitive);
    return check_finish();
}
