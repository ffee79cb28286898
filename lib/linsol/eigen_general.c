/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/eigen.h"
#include "linsol/householder.h"
#include "math/elementary.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define STEPS_MAX   60    /* Francis steps an eigenvalue; two or three are usual */
#define STEPS_STUCK 10    /* after so many, a shift of another kind */
#define LARGE       1e100 /* a vector that grows beyond is scaled */

typedef struct complex_number {
    double re, im;
} complex_number;

/* All matrices are column-major: A[c n + r]. */
typedef struct schur {
    size_t n;
    double *T;     /* A, then its Hessenberg form, then its real Schur form */
    double *Q;     /* A = Q T Q^T */
    double *scale; /* of the balancing */
    double norm;   /* largest |T| */
} schur;

static complex_number multiply(complex_number a, complex_number b)
{
    return (complex_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* a / b; a divisor of size `least` stands in for one below */
static complex_number divide(complex_number a, complex_number b, double least)
{
    double size = fmax(fabs(b.re), fabs(b.im));
    if (!(size >= least)) {
        return (complex_number){a.re / least, a.im / least};
    }
    double re = b.re / size;
    double im = b.im / size;
    double square = (re * re + im * im) * size;
    return (complex_number){(a.re * re + a.im * im) / square, (a.im * re - a.re * im) / square};
}

/* Sums of |A| without the diagonal over column and row k. */
static void sum_off_diagonal(const schur *s, size_t k, double *column, double *row)
{
    *column = 0.0;
    *row = 0.0;
    for (size_t j = 0; j < s->n; ++j) {
        if (j != k) {
            *column += fabs(s->T[k * s->n + j]);
            *row += fabs(s->T[j * s->n + k]);
        }
    }
}

/* A <- D^-1 A D with powers of two, until rows and columns are of like size (Parlett, Reinsch
 * 1969). */
static void balance(schur *s)
{
    size_t n = s->n;
    int changed = 1;
    for (size_t k = 0; k < n; ++k) {
        s->scale[k] = 1.0;
    }
    for (int sweep = 0; changed && sweep < 100; ++sweep) {
        changed = 0;
        for (size_t k = 0; k < n; ++k) {
            double column, row;
            sum_off_diagonal(s, k, &column, &row);
            if (!(column > 0.0) || !(row > 0.0)) {
                continue;
            }
            int exponent;
            (void)frexp(sqrt(row / column), &exponent);
            exponent = exponent < -300 ? -300 : exponent > 300 ? 300 : exponent;
            double factor = ldexp(1.0, exponent - 1);
            double next = s->scale[k] * factor;
            if (column * factor + row / factor >= .95 * (column + row) || next < 1e-150 ||
                next > 1e150) {
                continue;
            }
            changed = 1;
            s->scale[k] = next;
            for (size_t j = 0; j < n; ++j) {
                s->T[k * n + j] *= factor;
            }
            for (size_t j = 0; j < n; ++j) {
                s->T[j * n + k] /= factor;
            }
        }
    }
}

/* The reflection I - tau v v^T that turns column [count] into (length, 0 ..), which it becomes.
 * @return tau */
static double reflect(size_t count, double *column, double *v)
{
    double tau = se3di_householder_reflect(count, column);
    memcpy(v, column, count * sizeof *v);
    memset(column + 1, 0, (count - 1) * sizeof *column);
    v[0] = 1.0;
    return tau;
}

/* (I - tau v v^T) A on the rows row .. row + count - 1 and the columns first .. last - 1 */
static void reflect_rows(const schur *s, double *A, size_t row, size_t count, size_t first,
                         size_t last, const double *v, double tau)
{
    for (size_t c = first; c < last; ++c) {
        se3di_householder_mirror(count, tau, v, A + c * s->n + row);
    }
}

/* A (I - tau v v^T) on the columns column .. column + count - 1 and the rows 0 .. rows - 1; w
 * [rows] is work */
static void reflect_columns(const schur *s, double *A, size_t column, size_t count, size_t rows,
                            const double *v, double tau, double *w)
{
    memset(w, 0, rows * sizeof *w);
    for (size_t i = 0; i < count; ++i) {
        const double *a = A + (column + i) * s->n;
        for (size_t r = 0; r < rows; ++r) {
            w[r] += v[i] * a[r];
        }
    }
    for (size_t i = 0; i < count; ++i) {
        double *a = A + (column + i) * s->n;
        for (size_t r = 0; r < rows; ++r) {
            a[r] -= tau * v[i] * w[r];
        }
    }
}

/* T <- Q^T T Q of Hessenberg form. v, w [n] are work */
static void reduce_to_hessenberg(schur *s, double *v, double *w)
{
    size_t n = s->n;
    memset(s->Q, 0, n * n * sizeof *s->Q);
    for (size_t k = 0; k < n; ++k) {
        s->Q[k * n + k] = 1.0;
    }
    for (size_t k = 0; k + 2 < n; ++k) {
        size_t count = n - k - 1;
        double tau = reflect(count, s->T + k * n + k + 1, v);
        reflect_rows(s, s->T, k + 1, count, k + 1, n, v, tau);
        reflect_columns(s, s->T, k + 1, count, n, v, tau, w);
        reflect_columns(s, s->Q, k + 1, count, n, v, tau, w);
    }
}

/* The first column of (H - a I)(H - b I) but for a factor, where a + b = sum and a b = product. */
static void start_bulge(const schur *s, size_t first, double sum, double product, double *x)
{
    size_t n = s->n;
    const double *h = s->T + first * n + first;
    double size;
    x[0] = (h[0] * h[0] - sum * h[0] + product) / h[1] + h[n];
    x[1] = h[0] + h[n + 1] - sum;
    x[2] = h[n + 2];
    size = fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2])));
    for (size_t i = 0; i < 3; ++i) {
        x[i] = size > 0.0 ? x[i] / size : 0.0;
    }
}

/* A Francis step on the unreduced block first .. last of three rows or more. w [n] is work */
static void francis_step(schur *s, size_t first, size_t last, int32_t steps, double *w)
{
    size_t n = s->n;
    double *T = s->T;
    const double *h = T + (last - 1) * n + last - 1;
    double sum = h[0] + h[n + 1];
    double product = h[0] * h[n + 1] - h[n] * h[1];
    if (steps % STEPS_STUCK == 0) {
        double size = fabs(h[1]) + fabs(T[(last - 2) * n + last - 1]);
        sum = 1.5 * size;
        product = size * size;
    }
    double v[3], bulge[3];
    start_bulge(s, first, sum, product, bulge);
    for (size_t k = first; k < last; ++k) {
        size_t count = k + 2 <= last ? 3 : 2;
        double tau = reflect(count, k > first ? T + (k - 1) * n + k : bulge, v);
        size_t rows = k + 4 <= last ? k + 4 : last + 1;
        reflect_rows(s, T, k, count, k, n, v, tau);
        reflect_columns(s, T, k, count, rows, v, tau, w);
        reflect_columns(s, s->Q, k, count, n, v, tau, w);
    }
}

/* T <- G^T T G and Q <- Q G with the rotation G of the rows and columns k, k + 1 */
static void rotate(schur *s, size_t k, double cosine, double sine)
{
    size_t n = s->n;
    for (size_t c = k; c < n; ++c) {
        double *a = s->T + c * n + k;
        double kept = a[0];
        a[0] = cosine * kept + sine * a[1];
        a[1] = cosine * a[1] - sine * kept;
    }
    for (int which = 0; which < 2; ++which) {
        double *a = (which ? s->Q : s->T) + k * n;
        for (size_t r = 0; r < (which ? n : k + 2); ++r) {
            double kept = a[r];
            a[r] = cosine * kept + sine * a[n + r];
            a[n + r] = cosine * a[n + r] - sine * kept;
        }
    }
}

/* The block of the rows k, k + 1: real eigenvalues are split by a rotation. */
static void settle_pair(schur *s, size_t k, double *re, double *im)
{
    size_t n = s->n;
    double *h = s->T + k * n + k;
    double size = fmax(fmax(fabs(h[0]), fabs(h[1])), fmax(fabs(h[n]), fabs(h[n + 1])));
    double half = .5 * (h[0] - h[n + 1]) / size;
    double square = half * half + h[n] / size * (h[1] / size);
    if (square < 0.0) {
        re[0] = h[n + 1] + half * size;
        re[1] = re[0];
        im[0] = sqrt(-square) * size;
        im[1] = -im[0];
        return;
    }
    /* the eigenvector (x, h[1]) of the eigenvalue that is farther from h[n + 1] */
    double x = (half + (half < 0.0 ? -sqrt(square) : sqrt(square))) * size;
    double length = se3di_hypot(x, h[1]);
    rotate(s, k, x / length, h[1] / length);
    h[1] = 0.0;
    re[0] = h[0];
    re[1] = h[n + 1];
    im[0] = 0.0;
    im[1] = 0.0;
}

/* The first row of the unreduced block that ends at `last`; what is negligible below the diagonal
 * becomes zero. */
static size_t find_block(schur *s, size_t last)
{
    size_t first = last;
    for (; first > 0; --first) {
        double *below = s->T + (first - 1) * s->n + first;
        double size = fabs(below[-1]) + fabs(s->T[first * s->n + first]);
        if (fabs(*below) <= fmax(.5 * DBL_EPSILON * size, 1e-200 * s->norm)) {
            *below = 0.0;
            break;
        }
    }
    return first;
}

static se3d_status reduce_to_schur(schur *s, double *re, double *im, double *w)
{
    int32_t steps = 0;
    for (size_t end = s->n; end > 0;) {
        size_t last = end - 1;
        size_t first = find_block(s, last);
        if (first == last) {
            re[last] = s->T[last * s->n + last];
            im[last] = 0.0;
        } else if (first + 1 == last) {
            settle_pair(s, first, re + first, im + first);
        } else if (++steps > STEPS_MAX) {
            return SE3D_ERR_NO_CONVERGENCE;
        } else {
            francis_step(s, first, last, steps, w);
            continue;
        }
        end = first;
        steps = 0;
    }
    return SE3D_OK;
}

/* y[0 .. k - 1] -= T[.., k] y_k */
static void subtract_column(const schur *s, size_t k, size_t rows, complex_number *y)
{
    const double *t = s->T + k * s->n;
    for (size_t r = 0; r < rows; ++r) {
        y[r].re -= t[r] * y[k].re;
        y[r].im -= t[r] * y[k].im;
    }
}

static void shrink(size_t count, complex_number *y, double size)
{
    for (size_t k = 0; size > LARGE && k < count; ++k) {
        y[k].re /= size;
        y[k].im /= size;
    }
}

/* (T - s I) y = b of the single row k. */
static void solve_single(const schur *s, size_t k, complex_number value, complex_number *y)
{
    complex_number pivot = {s->T[k * s->n + k] - value.re, -value.im};
    y[k] = divide(y[k], pivot, DBL_EPSILON * s->norm);
}

/* (T - s I) y = b of the pair k - 1, k, by Cramer's rule. */
static void solve_pair(const schur *s, size_t k, complex_number value, complex_number *y)
{
    size_t n = s->n;
    const double *t = s->T + (k - 1) * n + k - 1;
    double size = fmax(fabs(t[1]), fabs(t[n]));
    complex_number a = {t[0] - value.re, -value.im};
    complex_number d = {t[n + 1] - value.re, -value.im};
    complex_number determinant = multiply(a, d);
    determinant.re -= t[n] * t[1];
    complex_number p = multiply(d, y[k - 1]);
    complex_number q = multiply(a, y[k]);
    p.re -= t[n] * y[k].re;
    p.im -= t[n] * y[k].im;
    q.re -= t[1] * y[k - 1].re;
    q.im -= t[1] * y[k - 1].im;
    double least = DBL_EPSILON * s->norm * fmax(size, DBL_EPSILON * s->norm);
    y[k - 1] = divide(p, determinant, least);
    y[k] = divide(q, determinant, least);
}

/* y [n] with T y = s y, for the eigenvalue of the single row k or of the pair k - 1, k */
static void solve_schur_vector(const schur *s, size_t k, complex_number value, complex_number *y)
{
    size_t n = s->n;
    size_t top = k;
    memset(y, 0, n * sizeof *y);
    if (value.im != 0.0) {
        double below = s->T[(k - 1) * n + k];
        double size = fmax(fabs(below), se3di_hypot(value.re - s->T[k * n + k], value.im));
        y[k].re = below / size;
        y[k - 1] = (complex_number){(value.re - s->T[k * n + k]) / size, value.im / size};
        subtract_column(s, k, k - 1, y);
        top = k - 1;
    } else {
        y[k].re = 1.0;
    }
    subtract_column(s, top, top, y);
    while (top > 0) {
        size_t row = top - 1;
        int is_pair = row > 0 && s->T[(row - 1) * n + row] != 0.0;
        if (is_pair) {
            solve_pair(s, row, value, y);
            top = row - 1;
        } else {
            solve_single(s, row, value, y);
            top = row;
        }
        double size = fmax(fabs(y[row].re), fabs(y[row].im));
        size = is_pair ? fmax(size, fmax(fabs(y[top].re), fabs(y[top].im))) : size;
        shrink(k + 1, y, size);
        for (size_t c = row + 1; c-- > top;) {
            subtract_column(s, c, top, y);
        }
    }
}

/* v_re, v_im [n] = D Q y, scaled; v_im NULL for a real vector */
static void turn_back(const schur *s, size_t k, const complex_number *y, double *v_re, double *v_im)
{
    size_t n = s->n;
    double size = 0.0;
    memset(v_re, 0, n * sizeof *v_re);
    if (v_im) {
        memset(v_im, 0, n * sizeof *v_im);
    }
    for (size_t c = 0; c <= k; ++c) {
        const double *q = s->Q + c * n;
        for (size_t r = 0; r < n; ++r) {
            v_re[r] += q[r] * y[c].re;
        }
        for (size_t r = 0; v_im && r < n; ++r) {
            v_im[r] += q[r] * y[c].im;
        }
    }
    for (size_t r = 0; r < n; ++r) {
        v_re[r] *= s->scale[r];
        if (v_im) {
            v_im[r] *= s->scale[r];
        }
        size = fmax(size, fabs(v_re[r]) + (v_im ? fabs(v_im[r]) : 0.0));
    }
    for (size_t r = 0; size > 0.0 && r < n; ++r) {
        v_re[r] /= size;
        if (v_im) {
            v_im[r] /= size;
        }
    }
}

static void compute_vectors(const schur *s, const double *re, const double *im, complex_number *y,
                            double *V)
{
    for (size_t k = 0; k < s->n; ++k) {
        if (im[k] > 0.0) {
            solve_schur_vector(s, k + 1, (complex_number){re[k], im[k]}, y);
            turn_back(s, k + 1, y, V + k * s->n, V + (k + 1) * s->n);
        } else if (im[k] == 0.0) {
            solve_schur_vector(s, k, (complex_number){re[k], 0.0}, y);
            turn_back(s, k, y, V + k * s->n, NULL);
        }
    }
}

/* The transpose of A, with numbers near one. @return the power of two taken out, -1 if a number is
 * not finite */
static double take_matrix(size_t n, double *A)
{
    double size = 0.0;
    for (size_t k = 0; k < n * n; ++k) {
        if (!isfinite(A[k])) {
            return -1.0;
        }
        size = fmax(size, fabs(A[k]));
    }
    int exponent;
    (void)frexp(size, &exponent);
    exponent = exponent < -1000 ? -1000 : exponent > 1000 ? 1000 : exponent;
    double scale = ldexp(1.0, exponent);
    for (size_t r = 0; r < n; ++r) {
        A[r * n + r] /= scale;
        for (size_t c = 0; c < r; ++c) {
            double kept = A[r * n + c];
            A[r * n + c] = A[c * n + r] / scale;
            A[c * n + r] = kept / scale;
        }
    }
    return scale;
}

se3d_status se3di_general_eigen(const se3d_allocator *allocator, int32_t n, double *A, double *re,
                                double *im, double *V)
{
    size_t count = (size_t)n;
    if (n == 0) {
        return SE3D_OK;
    }
    double scale = take_matrix(count, A);
    if (scale < 0.0) {
        return SE3D_ERR_NOT_FINITE;
    }
    size_t size = count * count + 5 * count;
    double *work = se3di_alloc(allocator, size, sizeof *work);
    if (!work) {
        return SE3D_ERR_NO_MEMORY;
    }
    double *w = work + count * count;
    schur s = {.n = count, .T = A, .Q = work, .scale = w + 2 * count};
    balance(&s);
    reduce_to_hessenberg(&s, w, w + count);
    for (size_t k = 0; k < count * count; ++k) {
        s.norm = fmax(s.norm, fabs(A[k]));
    }
    s.norm = s.norm > 0.0 ? s.norm : 1.0;
    se3d_status status = reduce_to_schur(&s, re, im, w);
    if (status >= 0) {
        compute_vectors(&s, re, im, (complex_number *)(void *)(w + 3 * count), V);
    }
    for (size_t k = 0; status >= 0 && k < count; ++k) {
        re[k] *= scale;
        im[k] *= scale;
    }
    se3di_free(allocator, work, size, sizeof *work);
    return status;
}
