/* SPDX-License-Identifier: BSD-3-Clause */
/* The rattleback of Kane and Levinson (International Journal of Non-Linear Mechanics 17, 1982,
 * 175-186): half an ellipsoid whose principal axes of inertia are turned against those of its
 * bottom. Spun one way it goes on, the other way it begins to rattle, stops and turns back.
 *
 * The reference rolls without slip and has no contact: with the normal n (upward) and the place of
 * contact r in the body frame, and v + w x r = 0,
 *
 *     n' = -w x n,     r' by the curvature of the ellipsoid,
 *     (J + m (r.r 1 - r r^T)) w' = -w x J w + m r x (-w x r' + w x v + g n)
 *
 * by the Runge-Kutta method of order 4. The stiffer contact is, the nearer is what touches to it.
 */
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/scene.h"

#define MASS   1.0
#define CENTRE 0.01 /* of the ellipsoid, above the centre of mass */

static const double semi_axes[3] = {0.2, 0.03, 0.02};
static const double inertia[6] = {2e-4, 1.6e-3, 1.7e-3, -2e-5, 0.0, 0.0};

typedef struct rolling {
    double n[3], w[3]; /* body frame */
} rolling;

static void inertia_times(const double x[3], double out[3])
{
    out[0] = inertia[0] * x[0] + inertia[3] * x[1];
    out[1] = inertia[3] * x[0] + inertia[1] * x[1];
    out[2] = inertia[2] * x[2];
}

/* The place of contact, from the centre of mass, and how fast that moves on as n does. */
static void find_place(const double n[3], const double dn[3], double r[3], double dr[3])
{
    double stretched = 0.0, along = 0.0;
    for (int a = 0; a < 3; ++a) {
        stretched += semi_axes[a] * semi_axes[a] * n[a] * n[a];
    }
    const double h = sqrt(stretched);
    for (int a = 0; a < 3; ++a) {
        r[a] = -semi_axes[a] * semi_axes[a] * n[a] / h;
        along += r[a] * dn[a];
    }
    for (int a = 0; a < 3; ++a) {
        dr[a] = -(semi_axes[a] * semi_axes[a] * dn[a] - r[a] * along) / h;
    }
    r[2] += CENTRE;
}

/* M x = b for a symmetric M, by Cramer's rule. */
static void solve3(const double M[3][3], const double b[3], double x[3])
{
    double c[3][3];
    for (int k = 0; k < 3; ++k) {
        se3di_cross(M[(k + 1) % 3], M[(k + 2) % 3], c[k]);
    }
    const double det = se3di_dot(M[0], c[0]);
    for (int a = 0; a < 3; ++a) {
        x[a] = (c[0][a] * b[0] + c[1][a] * b[1] + c[2][a] * b[2]) / det;
    }
}

static void eval_rates(const rolling *s, rolling *rate)
{
    double r[3], dr[3], v[3], x[3], push[3], b[3], M[3][3];
    se3di_cross(s->n, s->w, rate->n);
    find_place(s->n, rate->n, r, dr);
    se3di_cross(r, s->w, v);
    se3di_cross(s->w, v, push);
    se3di_cross(dr, s->w, x);
    se3di_add(push, x, push);
    se3di_add_scaled(G, s->n, push);
    se3di_cross(r, push, b);
    se3di_scale(MASS, b, b);
    inertia_times(s->w, x);
    se3di_cross(x, s->w, v);
    se3di_add(b, v, b);
    for (int a = 0; a < 3; ++a) {
        double unit[3] = {0.0, 0.0, 0.0};
        unit[a] = 1.0;
        inertia_times(unit, M[a]);
        M[a][a] += MASS * se3di_dot(r, r);
        se3di_add_scaled(-MASS * r[a], r, M[a]);
    }
    solve3((const double(*)[3])M, b, rate->w);
}

static void move(const rolling *from, double h, const rolling *rate, rolling *to)
{
    *to = *from;
    se3di_add_scaled(h, rate->n, to->n);
    se3di_add_scaled(h, rate->w, to->w);
}

static void roll_on(rolling *s, double span, int steps)
{
    const double h = span / steps;
    for (int k = 0; k < steps; ++k) {
        rolling rate[4], next;
        eval_rates(s, &rate[0]);
        move(s, 0.5 * h, &rate[0], &next);
        eval_rates(&next, &rate[1]);
        move(s, 0.5 * h, &rate[1], &next);
        eval_rates(&next, &rate[2]);
        move(s, h, &rate[2], &next);
        eval_rates(&next, &rate[3]);
        move(s, h / 6.0, &rate[0], s);
        move(s, h / 3.0, &rate[1], s);
        move(s, h / 3.0, &rate[2], s);
        move(s, h / 6.0, &rate[3], s);
    }
}

/* Turned by half a degree about x and then about y. */
static rolling begin_rolling(double spin, double p[4])
{
    const double c = cos(0.25 * PI / 180.0), h = sin(0.25 * PI / 180.0);
    const double turned[4] = {c * c, h * c, c * h, h * h};
    memcpy(p, turned, sizeof turned);
    const rolling s = {{2.0 * (p[1] * p[3] - p[0] * p[2]), 2.0 * (p[2] * p[3] + p[0] * p[1]),
                        1.0 - 2.0 * (p[1] * p[1] + p[2] * p[2])},
                       {0.0, 0.0, spin}};
    return s;
}

static double energy_of(const rolling *s)
{
    double r[3], dr[3], v[3], Jw[3];
    find_place(s->n, s->n, r, dr);
    se3di_cross(r, s->w, v);
    inertia_times(s->w, Jw);
    return 0.5 * se3di_dot(s->w, Jw) + 0.5 * MASS * se3di_dot(v, v) - MASS * G * se3di_dot(r, s->n);
}

static se3d_body add_stone(scene *s, double stiffness, double spin)
{
    double p[4], A[9], r[3], dr[3], v[3];
    const rolling start = begin_rolling(spin, p);
    se3d_body_def def = se3d_body_def_default();
    se3d_body stone;
    se3d_shape shape;
    find_place(start.n, start.n, r, dr);
    se3di_cross(r, start.w, v);
    def.mass = MASS;
    memcpy(def.inertia, inertia, sizeof inertia);
    memcpy(def.orientation, p, sizeof p);
    memcpy(def.angular_velocity, start.w, sizeof start.w);
    def.position[2] = -se3di_dot(r, start.n) - MASS * G / stiffness;
    se3di_quat_to_matrix(p, A);
    se3di_mul(A, v, def.velocity);
    CHECK(se3d_body_create(s->system, &def, &stone) == SE3D_OK);
    se3d_shape_def solid = scene_shape(s, stone);
    memcpy(solid.semi_axes, semi_axes, sizeof semi_axes);
    solid.position[2] = CENTRE;
    CHECK(se3d_shape_create_ellipsoid(s->system, &solid, &shape) == SE3D_OK);
    se3d_shape_def floor = scene_shape(s, scene_ground(s));
    CHECK(se3d_shape_create_plane(s->system, &floor, &shape) == SE3D_OK);
    return stone;
}

typedef struct trial {
    int32_t method;
    double stiffness, step, tolerance;
    double off, off_freely; /* the most that its spin may be off the reference [rad/s] */
} trial;

/* Its spin about the vertical follows the reference up to t_end. */
static double follow(const trial *t, double spin, double t_end, double most)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 10.0, 0.5, t->stiffness);
    double p[4], A[9], w[3], off = 0.0;
    rolling reference = begin_rolling(spin, p);
    const double energy = energy_of(&reference);
    se3d_body stone = add_stone(&s, t->stiffness, spin);
    scene_solve(&s, t->method, SE3D_FORMULATION_AUTO, t->step, t->tolerance);
    double last = 0.0;
    for (int k = 1; 0.25 * k <= t_end && scene_run(&s, 0.25 * k); ++k) {
        roll_on(&reference, 0.25, 1000);
        CHECK(se3d_body_get_angular_velocity(s.system, stone, w) == SE3D_OK);
        CHECK(se3d_body_get_orientation(s.system, stone, p) == SE3D_OK);
        se3di_quat_to_matrix(p, A);
        last = se3di_dot(A + 6, w);
        off = fmax(off, fabs(last - se3di_dot(reference.w, reference.n)));
    }
    CHECK_NEAR(energy_of(&reference), energy, 1e-7 * energy);
    CHECK(off < most);
    scene_end(&s);
    return last;
}

static const trial trials[] = {
    {SE3D_METHOD_DOP853, 1e7, 0.0, 1e-7, 0.1, 2e-3},
    {SE3D_METHOD_CONVEX, 1e7, 5e-5, 0.0, 0.25, 2e-3},
};

static void a_rattleback_turns_back(void)
{
    for (size_t k = 0; k < sizeof trials / sizeof *trials; ++k) {
        CHECK(follow(&trials[k], -3.0, 3.5, trials[k].off) > 1.5);
    }
}

static void the_other_way_it_goes_on(void)
{
    for (size_t k = 0; k < sizeof trials / sizeof *trials; ++k) {
        CHECK(follow(&trials[k], 3.0, 1.5, trials[k].off_freely) > 3.0);
    }
}

int main(void)
{
    RUN(a_rattleback_turns_back);
    RUN(the_other_way_it_goes_on);
    return check_finish();
}
