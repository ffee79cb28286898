/* SPDX-License-Identifier: BSD-3-Clause */
/* Quaternions, rotation kernels, exponential map, inertia tensors. */
#include "check.h"

#include "base/floats.h"
#include "math/inertia.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/symmetric.h"
#include "math/vec3.h"

#include <string.h>

#define STATES 100
#define PI     3.14159265358979323846

static uint64_t seed = UINT64_C(0x9e3779b97f4a7c15);

static void random_values(double *values, int count)
{
    for (int k = 0; k < count; ++k) {
        values[k] = check_random(&seed);
    }
}

static void random_unit_quat(double p[4])
{
    random_values(p, 4);
    (void)se3di_quat_normalize(p, p);
}

static void check_values(const double *actual, const double *expected, int count, double tolerance)
{
    for (int k = 0; k < count; ++k) {
        CHECK_NEAR(actual[k], expected[k], tolerance);
    }
}

/* exp(tilde(theta)) by its power series after halving the angle ten times: knows no quaternion. */
static void exp_by_series(const double theta[3], double R[9])
{
    double S[9];
    double term[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double next[9];
    double small[3];
    se3di_scale(0x1p-10, theta, small);
    se3di_tilde(small, S);
    memcpy(R, term, sizeof term);
    for (int n = 1; n < 12; ++n) {
        se3di_mat_mul(term, S, next);
        for (int k = 0; k < 9; ++k) {
            term[k] = next[k] / n;
            R[k] += term[k];
        }
    }
    for (int n = 0; n < 10; ++n) {
        se3di_mat_mul(R, R, next);
        memcpy(R, next, sizeof next);
    }
}

static void a_quarter_turn_about_z_maps_x_to_y(void)
{
    const double z[3] = {0, 0, 1};
    const double expected[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    double p[4];
    double A[9];
    se3di_quat_from_axis_angle(z, PI / 2, p);
    se3di_quat_to_matrix(p, A);
    check_values(A, expected, 9, 1e-15);
}

static void the_matrix_is_the_exponential_of_the_rotation_vector(void)
{
    const double identity[4] = {1, 0, 0, 0};
    for (int n = 0; n < STATES; ++n) {
        double theta[3];
        double p[4];
        double A[9];
        double R[9];
        random_values(theta, 3);
        se3di_scale(3.0, theta, theta);
        se3di_quat_rotate(identity, theta, p);
        se3di_quat_to_matrix(p, A);
        exp_by_series(theta, R);
        check_values(A, R, 9, 1e-12);
        CHECK_NEAR(p[0] * p[0] + se3di_dot(p + 1, p + 1), 1.0, 1e-15);
    }
}

static void the_product_of_quaternions_is_the_product_of_matrices(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double q[4];
        double A[9];
        double B[9];
        double AB[9];
        double C[9];
        random_values(p, 4); /* not of unit length: A is homogeneous */
        random_values(q, 4);
        se3di_quat_to_matrix(p, A);
        se3di_quat_to_matrix(q, B);
        se3di_mat_mul(A, B, AB);
        se3di_quat_mul(p, q, q); /* aliased */
        se3di_quat_to_matrix(q, C);
        check_values(C, AB, 9, 1e-14);
    }
}

static void a_matrix_gives_back_its_euler_parameters(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double A[9];
        double q[4];
        random_unit_quat(p);
        if (n % 5 > 0) { /* near half turns about each axis, and no turn */
            const int large = n % 5 - 1;
            se3di_scale(1e-7, p + 1, p + 1);
            p[0] *= 1e-7;
            p[large] = 1.0;
            (void)se3di_quat_normalize(p, p);
        }
        se3di_quat_to_matrix(p, A);
        se3di_quat_from_matrix(A, q);
        CHECK(q[0] >= 0.0);
        const double sign = p[0] < 0.0 ? -1.0 : 1.0;
        for (int k = 0; k < 4; ++k) {
            CHECK_NEAR(sign * q[k], p[k], 1e-15);
        }
    }
}

static void exact_half_turns_are_found(void)
{
    for (int axis = 0; axis < 3; ++axis) {
        double A[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1};
        double p[4];
        A[4 * axis] = 1.0;
        se3di_quat_from_matrix(A, p);
        CHECK_NEAR(p[0], 0.0, 0.0);
        CHECK_NEAR(fabs(p[axis + 1]), 1.0, 0.0);
    }
}

static void log_undoes_rotate_up_to_half_a_turn(void)
{
    static const double lengths[] = {0.0, 1e-200, 1e-12, 1e-5, 1e-2, 1.0, 3.0, PI - 1e-7};
    for (int n = 0; n < STATES; ++n) {
        const double length = lengths[n % 8];
        double p[4];
        double q[4];
        double theta[3];
        double back[3];
        random_unit_quat(p);
        random_values(theta, 3);
        se3di_scale(length / se3di_norm(theta), theta, theta);
        se3di_quat_rotate(p, theta, q);
        if (n % 2) {
            for (int k = 0; k < 4; ++k) {
                q[k] = -q[k]; /* the same rotation */
            }
        }
        se3di_quat_log(p, q, back);
        check_values(back, theta, 3, 1e-15 + 4e-15 * length);
    }
}

static void normalize_returns_the_length(void)
{
    double p[4] = {1, -2, 4, -2};
    CHECK_NEAR(se3di_quat_normalize(p, p), 5.0, 0.0);
    const double expected[4] = {0.2, -0.4, 0.8, -0.4};
    check_values(p, expected, 4, 1e-16);
}

/* G, B and K as the textbook writes them, element by element. */
static void the_matrices_are_those_of_the_theory(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double a[3];
        double y[3];
        double e[9];
        double ta[9];
        double turned[9]; /* e0 I + tilde(e) */
        double product[9];
        double col[3];
        double n_ay[3];
        double G[12];
        double B[12];
        double K[16];
        random_values(p, 4);
        random_values(a, 3);
        random_values(y, 3);
        se3di_tilde(p + 1, e);
        se3di_tilde(a, ta);
        memcpy(turned, e, sizeof e);
        for (int k = 0; k < 3; ++k) {
            turned[4 * k] += p[0];
        }
        se3di_mul(turned, a, col);
        se3di_mat_mul(turned, ta, product);
        se3di_cross(a, y, n_ay);
        se3di_g_matrix(p, G);
        se3di_b_matrix(p, a, B);
        se3di_k_matrix(a, y, K);
        CHECK_NEAR(K[0], 2 * se3di_dot(a, y), 1e-15);
        for (int r = 0; r < 3; ++r) {
            CHECK_NEAR(G[4 * r], -p[r + 1], 0.0);
            CHECK_NEAR(B[4 * r], 2 * col[r], 1e-14);
            CHECK_NEAR(K[1 + r], 2 * n_ay[r], 1e-15);
            CHECK_NEAR(K[4 * (1 + r)], 2 * n_ay[r], 1e-15);
            for (int c = 0; c < 3; ++c) {
                const double delta = r == c ? 1.0 : 0.0;
                CHECK_NEAR(G[4 * r + 1 + c], -e[3 * r + c] + delta * p[0], 0.0);
                CHECK_NEAR(B[4 * r + 1 + c], 2 * (p[1 + r] * a[c] - product[3 * r + c]), 1e-14);
                CHECK_NEAR(K[4 * (1 + r) + 1 + c],
                           2 * (a[r] * y[c] + y[r] * a[c] - delta * se3di_dot(a, y)), 1e-14);
            }
        }
    }
}

static void products_equal_those_with_the_full_matrices(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double a[3];
        double x[4];
        double y[3];
        double G[12];
        double B[12];
        double K[16];
        double out3[3];
        double out4[4];
        double g4[4];
        double b3[3];
        double b4[4];
        random_values(p, 4);
        random_values(a, 3);
        random_values(x, 4);
        random_values(y, 3);
        se3di_g_matrix(p, G);
        se3di_b_matrix(p, a, B);
        se3di_k_matrix(a, y, K);
        se3di_g_mul(p, x, out3);
        se3di_b_mul(p, a, x, b3);
        for (int r = 0; r < 3; ++r) {
            double g = 0;
            double b = 0;
            for (int c = 0; c < 4; ++c) {
                g += G[4 * r + c] * x[c];
                b += B[4 * r + c] * x[c];
            }
            CHECK_NEAR(out3[r], g, 1e-14);
            CHECK_NEAR(b3[r], b, 1e-14);
        }
        se3di_g_transposed_mul(p, y, g4);
        se3di_b_transposed_mul(p, a, y, b4);
        for (int c = 0; c < 4; ++c) {
            out4[c] = 0;
            double g = 0;
            double b = 0;
            for (int r = 0; r < 3; ++r) {
                g += G[4 * r + c] * y[r];
                b += B[4 * r + c] * y[r];
            }
            for (int k = 0; k < 4; ++k) {
                out4[c] += K[4 * c + k] * p[k];
            }
            CHECK_NEAR(g4[c], g, 1e-14);
            CHECK_NEAR(b4[c], b, 1e-14);
            CHECK_NEAR(b4[c], out4[c], 1e-14); /* B^T y = K p */
        }
    }
}

/* A a is quadratic in p, so that the central difference with any step is exact. */
static void b_is_the_derivative_of_the_turned_vector(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double a[3];
        double dp[4];
        double expected[3];
        double plus[4];
        double minus[4];
        double A[9];
        double up[3];
        double down[3];
        random_values(p, 4);
        random_values(a, 3);
        random_values(dp, 4);
        for (int k = 0; k < 4; ++k) {
            plus[k] = p[k] + dp[k];
            minus[k] = p[k] - dp[k];
        }
        se3di_quat_to_matrix(plus, A);
        se3di_mul(A, a, up);
        se3di_quat_to_matrix(minus, A);
        se3di_mul(A, a, down);
        se3di_b_mul(p, a, dp, expected);
        for (int k = 0; k < 3; ++k) {
            CHECK_NEAR(0.5 * (up[k] - down[k]), expected[k], 1e-14);
        }
    }
}

static void angular_velocity_and_rate_are_inverse_and_tangent(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double w[3];
        double pdot[4];
        double back[3];
        random_unit_quat(p);
        random_values(w, 3);
        se3di_quat_rate(p, w, pdot);
        se3di_quat_angular_velocity(p, pdot, back);
        check_values(back, w, 3, 1e-15);
        CHECK_NEAR(p[0] * pdot[0] + se3di_dot(p + 1, pdot + 1), 0.0, 1e-15);
    }
}

/* p(t) = p exp(theta(t)) with theta = w t + wdot t^2/2: rates and accelerations by differences,
 * whose error falls as h^2. */
static void rates_are_those_of_a_turning_body(void)
{
    for (int n = 0; n < STATES; ++n) {
        double p[4];
        double w[3];
        double wdot[3];
        double pdot[4];
        double pddot[4];
        double error[2][2] = {{0, 0}, {0, 0}};
        random_unit_quat(p);
        random_values(w, 3);
        random_values(wdot, 3);
        se3di_quat_rate(p, w, pdot);
        se3di_quat_acceleration(p, w, wdot, pddot);
        for (int half = 0; half < 2; ++half) {
            const double h = half ? 1e-3 : 2e-3;
            double q[2][4];
            for (int side = 0; side < 2; ++side) {
                const double t = side ? h : -h;
                double theta[3];
                se3di_scale(t, w, theta);
                se3di_add_scaled(0.5 * t * t, wdot, theta);
                se3di_quat_rotate(p, theta, q[side]);
            }
            for (int k = 0; k < 4; ++k) {
                const double first = (q[1][k] - q[0][k]) / (2 * h) - pdot[k];
                const double second = (q[1][k] - 2 * p[k] + q[0][k]) / (h * h) - pddot[k];
                error[half][0] += first * first;
                error[half][1] += second * second;
            }
        }
        for (int order = 0; order < 2; ++order) {
            CHECK(error[0][order] < 1e-10);
            if (error[0][order] > 1e-14) {
                const double ratio = sqrt(error[0][order] / error[1][order]);
                CHECK_NEAR(ratio, 4.0, 0.1);
            }
        }
    }
}

/* A^T dA/ds = tilde(T(theta) dtheta/ds), dA/ds by the difference of a fourth-order formula. */
static void the_tangent_of_the_exponential_gives_the_body_rate(void)
{
    static const double lengths[] = {1e-9, 1e-3, 0.3, 0.499, 0.501, 1.5, 3.0, 5.5};
    const double identity[4] = {1, 0, 0, 0};
    const double h = 1e-3;
    for (int n = 0; n < STATES; ++n) {
        double theta[3];
        double direction[3];
        double T[9];
        double expected[3];
        double p[4];
        double at[4][4];
        double rate[4];
        double w[3];
        random_values(theta, 3);
        random_values(direction, 3);
        se3di_scale(lengths[n % 8] / se3di_norm(theta), theta, theta);
        se3di_exp_tangent(theta, T);
        se3di_mul(T, direction, expected);
        se3di_quat_rotate(identity, theta, p);
        static const double steps[4] = {-2, -1, 1, 2};
        for (int k = 0; k < 4; ++k) {
            double moved[3];
            se3di_copy(theta, moved);
            se3di_add_scaled(steps[k] * h, direction, moved);
            se3di_quat_rotate(identity, moved, at[k]);
        }
        for (int k = 0; k < 4; ++k) {
            rate[k] = (8 * (at[2][k] - at[1][k]) - (at[3][k] - at[0][k])) / (12 * h);
        }
        se3di_quat_angular_velocity(p, rate, w);
        check_values(w, expected, 3, 3e-12);
    }
}

static void the_inverse_tangent_inverts_the_tangent(void)
{
    static const double lengths[] = {0.0, 1e-9, 1e-3, 0.4999999, 0.5000001, 1.0, PI, 5.5};
    const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int n = 0; n < STATES; ++n) {
        double theta[3];
        double T[9];
        double Tinv[9];
        double product[9];
        random_values(theta, 3);
        se3di_scale(lengths[n % 8] / se3di_norm(theta), theta, theta);
        se3di_exp_tangent(theta, T);
        se3di_exp_tangent_inverse(theta, Tinv);
        se3di_mat_mul(T, Tinv, product);
        check_values(product, identity, 9, 2e-14);
    }
}

static void series_and_closed_form_meet_at_the_limit(void)
{
    const double below[3] = {0.0, 0.5 * (1 - 1e-15), 0.0};
    const double above[3] = {0.0, 0.5 * (1 + 1e-15), 0.0};
    double T[9];
    double U[9];
    se3di_exp_tangent(below, T);
    se3di_exp_tangent(above, U);
    check_values(T, U, 9, 2e-15);
    CHECK_NEAR(T[2], -0.2448348762192545, 1e-15); /* -(1 - cos 0.5)/0.5 */
    CHECK_NEAR(T[0], 0.958851077208406, 1e-15);   /* sin(0.5)/0.5 */
    se3di_exp_tangent_inverse(below, T);
    se3di_exp_tangent_inverse(above, U);
    check_values(T, U, 9, 2e-15);
    CHECK_NEAR(T[0], 0.979079341161485, 1e-15); /* 0.25 cot 0.25 */
}

static void the_inertia_matrix_has_its_elements_in_place(void)
{
    const double J[6] = {1, 2, 3, 4, 5, 6}; /* xx yy zz xy yz xz */
    const double expected[9] = {1, 4, 6, 4, 2, 5, 6, 5, 3};
    double M[9];
    se3di_inertia_matrix(J, M);
    check_values(M, expected, 9, 0.0);
}

/* R diag(m) R^T */
static void turned_inertia(const double m[3], double J[6])
{
    double p[4];
    double R[9];
    double M[9];
    random_unit_quat(p);
    se3di_quat_to_matrix(p, R);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            M[3 * r + c] = R[3 * r] * m[0] * R[3 * c] + R[3 * r + 1] * m[1] * R[3 * c + 1] +
                           R[3 * r + 2] * m[2] * R[3 * c + 2];
        }
    }
    const double elements[6] = {M[0], M[4], M[8], M[1], M[5], M[2]};
    memcpy(J, elements, sizeof elements);
}

static void principal_moments_are_found_in_any_frame(void)
{
    static const double cases[6][3] = {{1, 2, 3},      {2, 2, 2}, {0, 5, 5}, {0.0325, 104, 104.5},
                                       {1e-8, 1, 1e8}, {-3, 1, 2}};
    for (int n = 0; n < 60; ++n) {
        const double *m = cases[n % 6];
        double J[6];
        double moments[3];
        turned_inertia(m, J);
        se3di_inertia_principal(J, moments);
        check_values(moments, m, 3, 1e-14 * m[2]);
    }
}

static void principal_moments_of_sparse_tensors_are_exact(void)
{
    const double root = sqrt(2.0);
    const double J[3][6] = {{2, 2, 2, 1, 1, 0}, {2, 2, 2, 0, 1, 1}, {2, 2, 2, 1, 0, 1}};
    const double expected[3] = {2 - root, 2, 2 + root};
    for (int n = 0; n < 3; ++n) {
        double moments[3];
        se3di_inertia_principal(J[n], moments);
        check_values(moments, expected, 3, 2e-15);
    }
}

static void inertia_is_classified(void)
{
    const struct {
        double m[3];
        int verdict;
    } cases[] = {
        {{1, 2, 2.5}, SE3DI_INERTIA_PHYSICAL},
        {{0, 0, 0}, SE3DI_INERTIA_PHYSICAL}, /* point mass */
        {{0, 7, 7}, SE3DI_INERTIA_PHYSICAL}, /* thin rod */
        {{1, 2, 3}, SE3DI_INERTIA_PHYSICAL}, /* thin plate */
        {{1, 2, 3 + 1e-6}, SE3DI_INERTIA_NOT_TRIANGLE},
        {{1, 1, 10}, SE3DI_INERTIA_NOT_TRIANGLE},
        {{-1e-6, 1, 1}, SE3DI_INERTIA_NOT_POSITIVE},
        {{-2, -1, -1}, SE3DI_INERTIA_NOT_POSITIVE},
        {{-2, 1, 1}, SE3DI_INERTIA_NOT_POSITIVE},
    };
    for (int scale = -200; scale <= 200; scale += 100) {
        for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
            double J[6];
            turned_inertia(cases[n].m, J);
            for (int k = 0; k < 6; ++k) {
                J[k] = ldexp(J[k], 4 * scale);
            }
            CHECK_NEAR(se3di_inertia_is_physical(J), cases[n].verdict, 0);
        }
    }
}

static void inertia_that_is_not_finite_is_not_physical(void)
{
    for (int k = 0; k < 6; ++k) {
        double J[6] = {1, 1, 1, 0, 0, 0};
        J[k] = (double)NAN;
        CHECK(se3di_inertia_is_physical(J) == SE3DI_INERTIA_NOT_POSITIVE);
        J[k] = (double)INFINITY;
        CHECK(se3di_inertia_is_physical(J) == SE3DI_INERTIA_NOT_POSITIVE);
    }
}

/* |A| has the square of A, no negative diagonal in any axes, and commutes with A. */
static void absolute_values_of_symmetric_matrices(void)
{
    for (int n = 1; n <= SE3DI_SYMMETRIC_MAX; ++n) {
        double A[144], B[144], y[12];
        for (int k = 0; k < n * n; ++k) {
            A[k] = k % n < k / n ? A[n * (k % n) + k / n] : sin(3.0 * k + n);
        }
        memcpy(B, A, sizeof A);
        se3di_symmetric_abs(n, B);
        for (int k = 0; k < n * n; ++k) {
            double AA = 0.0, BB = 0.0, AB = 0.0, BA = 0.0;
            for (int e = 0; e < n; ++e) {
                AA += A[n * (k / n) + e] * A[n * e + k % n];
                BB += B[n * (k / n) + e] * B[n * e + k % n];
                AB += A[n * (k / n) + e] * B[n * e + k % n];
                BA += B[n * (k / n) + e] * A[n * e + k % n];
            }
            CHECK_NEAR(BB, AA, 1e-13 * n);
            CHECK_NEAR(AB, BA, 1e-13 * n);
        }
        for (int trial = 0; trial < 50; ++trial) {
            double form = 0.0;
            for (int k = 0; k < n; ++k) {
                y[k] = cos(7.0 * trial + 2.0 * k);
            }
            for (int k = 0; k < n * n; ++k) {
                form += y[k / n] * B[k] * y[k % n];
            }
            CHECK(form >= -1e-14);
        }
    }
    double scaled[4] = {1e150, 2e150, 2e150, 1e150}; /* 3 and -1: |.| is [2 1; 1 2] */
    se3di_symmetric_abs(2, scaled);
    CHECK_NEAR(scaled[0], 2e150, 1e136);
    CHECK_NEAR(scaled[1], 1e150, 1e136);
}

/* Wherever it stands among the numbers of which the largest is wanted. */
static void the_larger_one_keeps_what_is_not_a_number(void)
{
    for (int place = 0; place < 4; ++place) {
        double largest = 0.0;
        for (int k = 0; k < 4; ++k) {
            largest = se3di_larger(largest, k == place ? (double)NAN : 3.0 - k);
        }
        CHECK(isnan(largest));
    }
    CHECK_NEAR(se3di_larger(1.0, 2.0), 2.0, 0.0);
    CHECK_NEAR(se3di_larger(2.0, 1.0), 2.0, 0.0);
    CHECK(isinf(se3di_larger(HUGE_VAL, 1.0)));
    CHECK(isnan(se3di_larger(HUGE_VAL, (double)NAN)) && isnan(se3di_larger((double)NAN, HUGE_VAL)));
}

/* Of two that are as near the even one; x + 0.5 of the number below 0.5 is 1 by rounding. */
static void the_nearest_integer_is_found(void)
{
    static const double cases[][2] = {{0.0, 0.0},
                                      {0.5, 0.0},
                                      {0.49999999999999994, 0.0},
                                      {0.50000000000000011, 1.0},
                                      {1.5, 2.0},
                                      {2.5, 2.0},
                                      {-0.5, 0.0},
                                      {-1.5, -2.0},
                                      {-2.5, -2.0},
                                      {-0.75, -1.0},
                                      {4503599627370494.5, 4503599627370494.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        CHECK_NEAR(se3di_nearest(cases[k][0]), cases[k][1], 0.0);
    }
}

int main(void)
{
    RUN(a_quarter_turn_about_z_maps_x_to_y);
    RUN(the_matrix_is_the_exponential_of_the_rotation_vector);
    RUN(the_product_of_quaternions_is_the_product_of_matrices);
    RUN(a_matrix_gives_back_its_euler_parameters);
    RUN(exact_half_turns_are_found);
    RUN(log_undoes_rotate_up_to_half_a_turn);
    RUN(normalize_returns_the_length);
    RUN(the_matrices_are_those_of_the_theory);
    RUN(products_equal_those_with_the_full_matrices);
    RUN(b_is_the_derivative_of_the_turned_vector);
    RUN(angular_velocity_and_rate_are_inverse_and_tangent);
    RUN(rates_are_those_of_a_turning_body);
    RUN(the_tangent_of_the_exponential_gives_the_body_rate);
    RUN(the_inverse_tangent_inverts_the_tangent);
    RUN(series_and_closed_form_meet_at_the_limit);
    RUN(the_inertia_matrix_has_its_elements_in_place);
    RUN(principal_moments_are_found_in_any_frame);
    RUN(principal_moments_of_sparse_tensors_are_exact);
    RUN(inertia_is_classified);
    RUN(inertia_that_is_not_finite_is_not_physical);
    RUN(absolute_values_of_symmetric_matrices);
    RUN(the_larger_one_keeps_what_is_not_a_number);
    RUN(the_nearest_integer_is_found);
    return check_finish();
}
