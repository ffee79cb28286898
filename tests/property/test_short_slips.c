/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction that breaks loose and sticks again between the ends of steps that would be far longer:
 * one freedom under a load a sin(w t) + b and a limit that swings, against the law itself,
 *
 *     u' = f(t) - d mu N(t) while it slips to d,  u = 0 while |f| <= mu_s N
 *
 * by small steps that end where it sticks and slips. */
#include "support/text_model.h"

#include <stdio.h>

#define PI  3.14159265358979323846
#define END 6.0

typedef struct slider {
    double amplitude, w, constant; /* f(t) */
    double pull, pulse;            /* N(t) = pull - swing sin(pulse t) */
    double mu, mu_static;
    double swing, start; /* the velocity that it begins with */
} slider;

static double load(const slider *s, double t)
{
    return s->amplitude * sin(s->w * t) + s->constant;
}

static double normal(const slider *s, double t)
{
    return s->pull - s->swing * sin(s->pulse * t);
}

static double way_it_breaks(const slider *s, double t)
{
    const double f = load(s, t);
    return fabs(f) > s->mu_static * normal(s, t) ? copysign(1.0, f) : 0.0;
}

static double accelerate(const slider *s, double t, double way)
{
    return load(s, t) - way * s->mu * normal(s, t);
}

/* The velocity after h from u. */
static double go_on(const slider *s, double t, double h, double way, double u)
{
    return u + h / 6.0 *
                   (accelerate(s, t, way) + 4.0 * accelerate(s, t + 0.5 * h, way) +
                    accelerate(s, t + h, way));
}

/* The part of h after which the sign of what is looked at differs. */
static double find_change(const slider *s, double t, double h, double way, double u)
{
    double before = 0.0, after = h;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (before + after);
        const int has = way != 0.0 ? way * go_on(s, t, middle, way, u) < 0.0
                                   : way_it_breaks(s, t + middle) != 0.0;
        before = has ? before : middle;
        after = has ? middle : after;
    }
    return after;
}

/* The way in `end` from a velocity u. */
static double solve(const slider *s, double u, double end)
{
    const double h = 5e-4;
    double x = 0.0, way = u > 0.0 ? 1.0 : 0.0;
    for (double t = 0.0, to; t < end - 1e-12; t = to) {
        to = fmin(end, h * (floor(t / h + 1e-9) + 1.0));
        const double rest = to - t, next = go_on(s, t, rest, way, u);
        const int changes = way != 0.0 ? way * next < 0.0 : way_it_breaks(s, to) != 0.0;
        to = changes ? t + find_change(s, t, rest, way, u) : to;
        const double part = to - t;
        if (way != 0.0) {
            x += part * u + part * part / 6.0 *
                                (accelerate(s, t, way) + 2.0 * accelerate(s, t + 0.5 * part, way));
            u = changes ? 0.0 : next;
        }
        way = changes ? way_it_breaks(s, to) : way;
    }
    return x;
}

#define SLIDERS 8

/* The last ones under a constant load: the limit alone swings, below it a part of each period. */
static const slider sliders[SLIDERS] = {{3.0, 9.0, 1.0, 9.81, 3.0, 0.3, 0.3, 3.0, 1.0},
                                        {3.0, 23.0, 0.5, 9.81, 5.0, 0.3, 0.3, 3.0, 1.0},
                                        {2.8, 7.3, -0.7, 9.81, 2.0, 0.3, 0.33, 3.0, 1.0},
                                        {2.5, 3.1, 0.3, 9.81, 17.0, 0.3, 0.3, 3.0, 1.0},
                                        {0.0, 1.0, 0.5, 5.0, 2.0 * PI, 1.0, 1.0, 4.9, 0.0},
                                        {0.0, 1.0, 0.6, 5.0, 2.0 * PI, 1.0, 1.0, 4.5, 0.0},
                                        {0.0, 1.0, -0.9, 5.0, 7.0, 0.8, 1.0, -4.8, 0.0},
                                        {0.0, 1.0, 2.0, 5.0, 2.0 * PI, 1.0, 1.0, 4.9, 0.0}};

/* On a slide, with the load of its weight. */
static void write_slide(const slider *s, const char *joint, char *text, size_t size)
{
    (void)snprintf(
        text, size,
        "se3d: 1\ngravity: [0, 0, %.9g]\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], "
        "velocity: [%.9g, 0, 0]}]\n"
        "joints: [{name: j, type: %s, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, 0]}]\n"
        "forces:\n  - {name: f, type: friction, joint: j, coordinate: displacement, mu: %.9g, "
        "mu_static: %.9g}\n"
        "  - {type: force, body: a, value: [\"%.9g*sin(%.9g*t)+%.9g\", 0, \"%.9g*sin(%.9g*t)\"]}\n"
        "analysis: {type: dynamics, duration: 6}\n"
        "output: [{file: r.csv, channels: [j.displacement, j.rate]}]\n",
        -s->pull, s->start, joint, s->mu, s->mu_static, s->amplitude, s->w, s->constant, s->swing,
        s->pulse);
}

/* On a pin: the moment is mu radius N, the inertia the radius. */
static void write_pin(const slider *s, char *text, size_t size)
{
    (void)snprintf(
        text, size,
        "se3d: 1\ngravity: [0, 0, %.9g]\nbodies: [{name: a, mass: 1, inertia: [0.2, 1, 1], "
        "angular_velocity: [%.9g, 0, 0]}]\n"
        "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "
        "0]}]\n"
        "forces:\n  - {name: f, type: friction, joint: j, mu: %.9g, mu_static: %.9g, radius: 0.2}\n"
        "  - {type: force, body: a, value: [0, 0, \"%.9g*sin(%.9g*t)\"]}\n"
        "  - {type: torque, body: a, value: [\"0.2*(%.9g*sin(%.9g*t)+%.9g)\", 0, 0]}\n"
        "analysis: {type: dynamics, duration: 6}\n"
        "output: [{file: r.csv, channels: [j.angle, j.rate]}]\n",
        -s->pull, s->start, s->mu, s->mu_static, s->swing, s->pulse, s->amplitude, s->w,
        s->constant);
}

typedef struct method {
    int32_t tag;
    double tolerance, accuracy; /* of the way, relative to its size */
} method;

static void try_method(const char *text, const method *with, double truth, int which)
{
    text_model m = text_model_open(text, with->tag, -1, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver_destroy(m.solver);
    CHECK(!se3d_model_get_solver(m.model, 0, &def));
    def.method = with->tag;
    def.tolerance = with->tolerance;
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    if (text_model_run(&m, END)) {
        const double x = text_model_get(&m, 0, 0);
        CHECK_NEAR(x, truth, with->accuracy * fmax(0.1, fabs(truth)));
        if (!(fabs(x - truth) <= with->accuracy * fmax(0.1, fabs(truth)))) {
            fprintf(stderr, "slider %d, method %d, tolerance %g\n", which, (int)with->tag,
                    with->tolerance);
        }
    }
    text_model_close(&m);
}

static void what_breaks_loose_within_a_step_is_seen(void)
{
    static const method methods[] = {
        {SE3D_METHOD_DOP853, 1e-4, 2e-3},
        {SE3D_METHOD_DOP853, 1e-6, 1e-6},
        {SE3D_METHOD_RK45, 1e-6, 1e-6},
        {SE3D_METHOD_GAUSS, 1e-6, 1e-6},
        {SE3D_METHOD_RADAU, 1e-4, 1e-2},
        {SE3D_METHOD_RADAU, 1e-6, 5e-4},
        {SE3D_METHOD_BDF, 1e-6, 5e-4},
        {SE3D_METHOD_AUTO, 1e-6, 1e-6},
        /* others of the same size: nothing is met by chance */
        {SE3D_METHOD_DOP853, 0.99e-6, 1e-6},
        {SE3D_METHOD_RK45, 1.02e-6, 1e-6},
        {SE3D_METHOD_GAUSS, 1.03e-6, 1e-6},
        {SE3D_METHOD_RADAU, 0.9e-6, 5e-4},
    };
    for (int k = 0; k < SLIDERS; ++k) {
        const double truth = solve(&sliders[k], sliders[k].start, END);
        for (size_t i = 0; i < sizeof methods / sizeof *methods; ++i) {
            char text[1200];
            const int kind = (int)(i + (size_t)k) % 3; /* each method sees each kind of joint */
            if (kind == 2) {
                write_pin(&sliders[k], text, sizeof text);
            } else {
                write_slide(&sliders[k], kind ? "cylindrical" : "prismatic", text, sizeof text);
            }
            try_method(text, &methods[i], truth, k);
        }
    }
}

int main(void)
{
    RUN(what_breaks_loose_within_a_step_is_seen);
    return check_finish();
}
