/* SPDX-License-Identifier: BSD-3-Clause */
/* Every coefficient of the explicit Runge-Kutta methods is held by conditions of order: those of
 * quadratures (y' = t^q, of stages c^q) and those of chains (y' = y, of stages A^q 1), for the
 * steps, the differences that estimate errors, and the interpolation between the ends. */
#include "check.h"
#include "integrator/explicit_rk.h"
#include "integrator/integrator.h"

typedef struct row {
    const se3di_integrator *method;
    int order, error_order, error3_order, dense_order;
} row;

static const row rows[] = {{&se3di_integrator_dop853, 8, 5, 3, 7},
                           {&se3di_integrator_rk45, 5, 4, 0, 4},
                           {&se3di_integrator_rk4, 4, 3, 0, 3}};
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

/* Of a step from 0 of length 1: the head of explicit_rk.h. */
static double interpolate(const se3di_rk_tableau *m, const double *K, double s)
{
    const double F0 = weigh(m->a[m->stages], K, m->stages);
    double sum = 0.0;
    for (int k = m->dense_rows - 1; k >= 0; --k) {
        sum = (k % 2 == 0 ? 1.0 - s : s) * (weigh(m->d[k], K, m->total) + sum);
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
                    most = fmax(most, fabs(interpolate(m, K, s) - exact(kind, q, s)));
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

int main(void)
{
    RUN(stages_lie_where_their_coefficients_say);
    RUN(steps_errors_and_interpolations_have_their_orders);
    return check_finish();
}
