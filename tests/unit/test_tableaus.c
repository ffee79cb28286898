/* SPDX-License-Identifier: BSD-3-Clause */
/* Every coefficient of the explicit Runge-Kutta methods is held by conditions of order: those of
 * quadratures (y' = t^q, of stages c^q) and those of chains (y' = y, of stages A^q 1), for the
 * steps, the differences that estimate errors, and the interpolation between the ends. */
#include "check.h"
#include "integrator/explicit_rk.h"
#include "integrator/integrator.h"

typedef struct row {
    const se3di_integrator *method;
    int order, error_order, error3_order, dense_order, free_order;
} row;

static const row rows[] = {{&se3di_integrator_dop853, 8, 5, 3, 7, 6},
                           {&se3di_integrator_rk45, 5, 4, 0, 4, 0},
                           {&se3di_integrator_rk4, 4, 3, 0, 3, 0}};
#define ROWS (sizeof rows / sizeof *rows)

static const char *const kinds[] = {"quadrature", "chain"};

/* The derivatives K of the stages for the condition of order q + 1, and the value at s of what they
 * are derivatives of. */
static void make_stages(const se3di_rk_tableau *m, int kind, int q, double *K)
{
    for (int i = 0; i < m->total; ++i) {
        K[i] = kind == 0 ? pow(m->c[i], q) : 1.0;
    }
    for (int times = 0; kind == 1 && times < q; ++times) {
        double next[SE3DI_RK_MAX] = {0.0};
        for (int i = 0; i < m->total; ++i) {
            for (int j = 0; j < i; ++j) {
                next[i] += m->a[i][j] * K[j];
            }
        }
        memcpy(K, next, sizeof next);
    }
}

static double exact(int kind, int q, double s)
{
    return pow(s, q + 1) / (kind == 0 ? q + 1 : tgamma(q + 2));
}

static double weigh(const double *weights, const double *K, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        sum += weights[i] * K[i];
    }
    return sum;
}

/* Of a step from 0 of length 1, by rows d: the head of explicit_rk.h. */
static double interpolate(const se3di_rk_tableau *m, const double (*d)[SE3DI_RK_MAX],
                          const double *K, double s)
{
    const double F0 = weigh(m->a[m->stages], K, m->stages);
    double sum = 0.0;
    for (int k = m->dense_rows - 1; k >= 0; --k) {
        sum = (k % 2 == 0 ? 1.0 - s : s) * (weigh(d[k], K, m->total) + sum);
    }
    const double F2 = 2.0 * F0 - K[0] - K[m->stages];
    return s * (F0 + (1.0 - s) * (K[0] - F0 + s * (F2 + sum)));
}

static void stages_lie_where_their_coefficients_say(void)
{
    for (size_t r = 0; r < ROWS; ++r) {
        const se3di_rk_tableau *m = rows[r].method->tableau;
        for (int i = 0; i < m->total; ++i) {
            CHECK_NEAR(
                weigh(m->a[i],
                      (const double[SE3DI_RK_MAX]){1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
                      i),
                m->c[i], 1e-13);
        }
    }
}

static void steps_errors_and_interpolations_have_their_orders(void)
{
    for (size_t r = 0; r < ROWS; ++r) {
        const se3di_rk_tableau *m = rows[r].method->tableau;
        double most = 0.0, largest3 = 0.0, largest = 0.0;
        for (int q = 0; q < rows[r].order; ++q) {
            for (int kind = 0; kind < 2; ++kind) {
                double K[SE3DI_RK_MAX] = {0.0};
                make_stages(m, kind, q, K);
                const double end = weigh(m->a[m->stages], K, m->stages);
                CHECK_NEAR(end, exact(kind, q, 1.0), 2e-14);
                const double error = fabs(weigh(m->error, K, m->stages + m->uses_end));
                const double error3 = m->error3 ? fabs(weigh(m->error3, K, m->stages)) : 0.0;
                CHECK(q >= rows[r].error_order || error < 2e-14);
                CHECK(q >= rows[r].error3_order || error3 < 2e-14);
                largest = q == rows[r].error_order ? fmax(largest, error) : largest;
                largest3 = q == rows[r].error3_order ? fmax(largest3, error3) : largest3;
                for (double s = 0.125; q < rows[r].dense_order && s < 1.0; s += 0.25) {
                    most = fmax(most, fabs(interpolate(m, m->d, K, s) - exact(kind, q, s)));
                }
                if (check_failures) {
                    fprintf(stderr, "%s: %s %d\n", rows[r].method->name, kinds[kind], q);
                }
            }
        }
        CHECK(largest > 1e-5); /* an error is seen */
        CHECK(!m->error3 || largest3 > 1e-5);
        CHECK_NEAR(most, 0.0, 1e-12);
    }
}

/* The other conditions of order q + 1 than quadratures and chains, of the form y' = t^i x,
 * x' = t^(q - i - 1), where stages see x by their own sums. */
static double mix_stages(const se3di_rk_tableau *m, int q, int i, double *K)
{
    for (int k = 0; k < m->total; ++k) {
        double x = 0.0;
        for (int j = 0; j < k; ++j) {
            x += m->a[k][j] * pow(m->c[j], q - i - 1);
        }
        K[k] = pow(m->c[k], i) * x;
    }
    return 1.0 / (q - i) / (q + 1);
}

/* The last of the rows is zero for motions that they follow, and not for those of the next order:
 * their error is the part of it that the table says. */
static void free_interpolations_have_their_order_and_know_their_error(void)
{
    for (size_t r = 0; r < ROWS; ++r) {
        const se3di_rk_tableau *m = rows[r].method->tableau;
        for (int q = 0; m->free && q <= rows[r].free_order; ++q) {
            for (int i = -2; i < q; ++i) {
                double K[SE3DI_RK_MAX] = {0.0}, factor = 0.0, most = 0.0;
                if (i < 0) {
                    make_stages(m, i + 2, q, K);
                } else {
                    factor = mix_stages(m, q, i, K);
                }
                for (double s = 0.0625; s < 1.0; s += 0.125) {
                    const double wanted = i < 0 ? exact(i + 2, q, s) : factor * pow(s, q + 1);
                    most = fmax(most, fabs(interpolate(m, m->free, K, s) - wanted));
                }
                const double last = fabs(weigh(m->free[m->dense_rows - 1], K, m->total));
                CHECK(q == rows[r].free_order || (most < 1e-12 && last < 1e-11));
                CHECK(q < rows[r].free_order || most < m->free_error * last + 1e-6);
                for (int k = m->stages + 1; k < m->total; ++k) {
                    CHECK(m->free[0][k] == 0.0 && m->free[m->dense_rows - 1][k] == 0.0);
                }
                if (q == rows[r].free_order) {
                    printf("%s: %d %g of %g\n", rows[r].method->name, i, most, last);
                }
            }
        }
    }
}

int main(void)
{
    RUN(stages_lie_where_their_coefficients_say);
    RUN(steps_errors_and_interpolations_have_their_orders);
    RUN(free_interpolations_have_their_order_and_know_their_error);
    return check_finish();
}
