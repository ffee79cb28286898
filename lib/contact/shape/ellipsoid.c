/* SPDX-License-Identifier: BSD-3-Clause */
/* An ellipsoid about its centre, sum (x_a / e_a)^2 = 1. With D = diag(e), where the normal is n
 *
 *     h = |D n|,   x = D^2 n / h,   dx/dn = (D^2 - x x^T) / h
 *
 * and the two radii of curvature, the eigenvalues of dx/dn across n, have the product
 * (e_1 e_2 e_3)^2 / h^4. The place nearest to y is x_a = e_a^2 y_a / (e_a^2 + s): one equation for
 * s, solved by Newton's method.                                           docs/theory/shapes.md */
#include "contact/shape/shape.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define NEWTONS 60

static const se3di_dimension dimensions[] = {
    {"semi_axes", offsetof(se3d_shape_def, semi_axes), offsetof(se3di_shape, half), 1.0, 3, 0},
    {.name = NULL}};

/* The radius of curvature that stands for all places: at the ends of the axes those of the sphere
 * that bends as much, e_2 e_3 / e_1 and so on, have this geometric mean. */
static se3d_status define_ellipsoid(const se3d_shape_def *def, const se3d_allocator *allocator,
                                    se3di_shape *s, se3di_error *error)
{
    const double *e = s->half;
    (void)def;
    (void)allocator;
    (void)error;
    s->radius = e[0] * se3di_pow(e[1] / e[0] * (e[2] / e[0]), 1.0 / 3.0);
    return SE3D_OK;
}

static double bound_ellipsoid(const se3di_shape *s)
{
    return fmax(s->half[0], fmax(s->half[1], s->half[2]));
}

static double size_ellipsoid(const se3di_shape *s)
{
    return fmin(s->half[0], fmin(s->half[1], s->half[2]));
}

/* y in the frame of the axes, beyond the shortest of which, m, the others go: with lengths in units
 * of that, t = 1 + s and q_a = e_a^2 - 1 all t + q_a are sums of what is not negative. */
typedef struct foot {
    int m;
    double r[3], q[3]; /* e_a^2 and less 1, in units of the shortest */
    double z[3];       /* |y_a| / e_a */
} foot;

static void begin(const double e[3], const double y[3], foot *f)
{
    f->m = e[1] < e[0] ? 1 : 0;
    f->m = e[2] < e[f->m] ? 2 : f->m;
    const double least = e[f->m];
    for (int a = 0; a < 3; ++a) {
        const double ratio = e[a] / least;
        f->r[a] = ratio * ratio;
        f->q[a] = (ratio - 1.0) * (ratio + 1.0);
        f->z[a] = fabs(y[a]) / e[a];
    }
}

/* G = sum (r z / (t + q))^2, and minus half of its slope. */
static double eval_foot(const foot *f, double t, double *slope)
{
    double sum = 0.0;
    *slope = 0.0;
    for (int a = 0; a < 3; ++a) {
        if (f->z[a] > 0.0) {
            const double part = f->r[a] * f->z[a] / (t + f->q[a]);
            sum += part * part;
            *slope += part * part / (t + f->q[a]);
        }
    }
    return sum;
}

/* The root of G = 1; 0: there is none, y is between the two sides and as near to both. 1/sqrt(G) is
 * concave, so that from below Newton's steps for 1/sqrt(G) = 1 never go too far. */
static double solve_foot(const foot *f)
{
    double t = 0.0, slope;
    for (int a = 0; a < 3; ++a) {
        t = fmax(t, f->r[a] * f->z[a] - f->q[a]);
    }
    for (int k = 0; k < NEWTONS; ++k) {
        const double G = eval_foot(f, t, &slope);
        const double next = G > 1.0 ? t + G * (sqrt(G) - 1.0) / slope : t;
        if (!(next > t)) {
            break;
        }
        t = next;
    }
    return t;
}

static void normal_at(const double e[3], const double x[3], double n[3])
{
    for (int a = 0; a < 3; ++a) {
        n[a] = x[a] / e[a] / e[a];
    }
    se3di_scale(1.0 / se3di_norm(n), n, n);
}

static void nearest_ellipsoid(const se3di_shape *s, const double local[3], double point[3],
                              double normal[3], double *distance)
{
    const double *e = s->half;
    foot f;
    double rest = 1.0, d[3];
    begin(e, local, &f);
    const double t = solve_foot(&f);
    for (int a = 0; a < 3; ++a) {
        point[a] = f.z[a] > 0.0 ? f.r[a] * local[a] / (t + f.q[a]) : 0.0;
        rest -= point[a] / e[a] * (point[a] / e[a]);
    }
    if (!(t > 0.0)) {
        point[f.m] = e[f.m] * sqrt(fmax(rest, 0.0));
    }
    normal_at(e, point, normal);
    se3di_sub(local, point, d);
    *distance = se3di_dot(d, normal);
}

static void support_ellipsoid(const se3di_shape *s, const double d[3], double out[3])
{
    const double *e = s->half;
    const double stretched[3] = {e[0] * d[0], e[1] * d[1], e[2] * d[2]};
    const double h = se3di_norm(stretched);
    for (int a = 0; a < 3; ++a) {
        out[a] = h > 0.0 ? e[a] * (stretched[a] / h) : 0.0;
    }
}

static void turn_ellipsoid(const se3di_shape *s, const double n[3], const double u[3],
                           double out[3])
{
    const double *e = s->half;
    const double stretched[3] = {e[0] * n[0], e[1] * n[1], e[2] * n[2]};
    const double h = se3di_norm(stretched);
    double x[3];
    support_ellipsoid(s, n, x);
    const double along = se3di_dot(x, u);
    for (int a = 0; a < 3; ++a) {
        out[a] = (e[a] * e[a] * u[a] - x[a] * along) / h;
    }
}

static int bend_ellipsoid(const se3di_shape *s, const double local[3], double u[3], double r[2])
{
    const double *e = s->half;
    double x[3], n[3], distance, v[2][3], moved[2][3];
    nearest_ellipsoid(s, local, x, n, &distance);
    se3di_perpendicular(n, v[0]);
    se3di_cross(n, v[0], v[1]);
    for (int k = 0; k < 2; ++k) {
        turn_ellipsoid(s, n, v[k], moved[k]);
    }
    const double h = se3di_dot(n, x);
    const double area = e[0] / h * (e[1] / h) * e[2];
    const double half = 0.5 * (se3di_dot(v[0], moved[0]) - se3di_dot(v[1], moved[1]));
    const double cross = se3di_dot(v[0], moved[1]);
    const double apart = se3di_hypot(half, cross);
    r[0] = 0.5 * (se3di_dot(v[0], moved[0]) + se3di_dot(v[1], moved[1])) + apart;
    r[1] = area * (area / r[0]);
    const double c = half > 0.0 ? apart + half : cross; /* along v[0] and v[1] */
    const double w = half > 0.0 ? cross : apart - half;
    const double size = se3di_hypot(c, w);
    se3di_scale(size > 0.0 ? c / size : 1.0, v[0], u);
    se3di_add_scaled(size > 0.0 ? w / size : 0.0, v[1], u);
    return 1;
}

const se3di_shape_class se3di_shape_class_ellipsoid = {
    .name = "ellipsoid",
    .dimensions = dimensions,
    .define = define_ellipsoid,
    .bound = bound_ellipsoid,
    .size = size_ellipsoid,
    .nearest = nearest_ellipsoid,
    .support = support_ellipsoid,
    .turn = turn_ellipsoid,
    .bend = bend_ellipsoid,
};
