/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of measures with respect to parameters: closed forms in every kind of analysis, and
 * estimates of errors that are true. docs/theory/sensitivities.md */
#include <stdlib.h>

#include "check.h"
#include "se3d/study.h"

typedef struct opened {
    se3d_model *model;
    se3d_study *study;
} opened;

static opened open_study(const char *text)
{
    opened s = {NULL, NULL};
    se3d_model_error error = {.message = ""};
    if (se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &s.model, &error) < 0 ||
        se3d_study_create(s.model, &s.study, &error) < 0) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(s.study != NULL);
    return s;
}

static void close_study(opened s)
{
    se3d_study_destroy(s.study);
    se3d_model_destroy(s.model);
}

/* All derivatives with respect to one parameter, which must be within `tolerance` of `wanted` and
 * within their own estimates, but for what is rounded in `wanted` itself. */
static void check_derivatives(opened s, size_t index, const double *wanted, double tolerance)
{
    double value = 0.0, slopes[8], errors[8];
    se3d_model_error error;
    CHECK(se3d_study_eval_sensitivity(s.study, index, &value, slopes, errors, &error) == SE3D_OK);
    for (size_t k = 0; k < se3d_study_count_measures(s.study); ++k) {
        const double off = fabs(slopes[k] - wanted[k]);
        CHECK_NEAR(slopes[k], wanted[k], tolerance * fmax(1e-3, fabs(wanted[k])));
        if (getenv("SE3D_SHOW")) {
            fprintf(stderr, "%s by %s: %.15g, off %.2g, estimate %.2g\n",
                    se3d_study_get_measure_name(s.study, k),
                    se3d_study_get_sensitivity_name(s.study, index), slopes[k], off, errors[k]);
        }
        CHECK(off <= errors[k] + 1e-13 * fabs(wanted[k]));
        CHECK(errors[k] <= 100.0 * tolerance * fmax(1e-3, fabs(wanted[k])));
    }
}

/* The mass hangs at z = -(l0 + m g / k). */
static void of_an_equilibrium(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {m: 2, k: 800 N/m, g: 9.81, z0: 0, a: 0}\ngravity: [0, 0, -g]\n"
        "bodies: [{name: block, mass: m, inertia: [1, 1, 1], position: [0, 0, -0.31]}]\n"
        "joints: [{name: guide, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], "
        "axis: [0, 0, 1]}]\n"
        "forces: [{name: spring, type: tsda, body_i: ground, body_j: block, k: k, l0: 0.3 + z0}]\n"
        "analysis: {type: equilibrium}\n"
        "study: {sensitivities: [k, m, z0, a], measures: {z: {final: block.position.z}, "
        "f: {final: spring.force}, e: z*g + m^2}}\n");
    const double m = 2.0, k = 800.0, g = 9.81;
    const double by_k[] = {m * g / (k * k), 0.0, m * g * g / (k * k)};
    const double by_m[] = {-g / k, g, -g * g / k + 2.0 * m};
    const double by_length[] = {-1.0, 0.0, -g};
    const double by_none[] = {0.0, 0.0, 0.0};
    CHECK(se3d_study_count_samples(s.study) == 0 && se3d_study_count_sensitivities(s.study) == 4);
    check_derivatives(s, 0, by_k, 1e-10);
    check_derivatives(s, 1, by_m, 1e-10);
    check_derivatives(s, 2, by_length, 1e-9);
    check_derivatives(s, 3, by_none, 1e-9);
    close_study(s);
}

/* Two equal masses between three springs: omega^2 = k/m and 3 k/m, dampers c/m and 3 c/m. */
static void of_modes(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {m: 2, k: 800, c: 6}\ngravity: [0, 0, 0]\n"
        "bodies:\n"
        "  - {name: a, mass: m, inertia: [1, 1, 1], position: [1, 0, 0]}\n"
        "  - {name: b, mass: m, inertia: [1, 1, 1], position: [2, 0, 0]}\n"
        "joints:\n"
        "  - {name: ja, type: prismatic, body_i: ground, body_j: a, at: [1, 0, 0], axis: [1, 0, "
        "0]}\n"
        "  - {name: jb, type: prismatic, body_i: ground, body_j: b, at: [2, 0, 0], axis: [1, 0, "
        "0]}\n"
        "forces:\n"
        "  - {name: s1, type: tsda, body_i: ground, body_j: a, k: k, c: c, l0: 1}\n"
        "  - {name: s2, type: tsda, body_i: a, body_j: b, k: k, c: c, l0: 1}\n"
        "  - {name: s3, type: tsda, body_i: b, body_j: ground, point_j: [3, 0, 0], k: k, c: c, l0: "
        "1}\n"
        "analysis: [{type: equilibrium}, {type: modes}]\n"
        "study: {sensitivities: [m, k, c], measures: {f1: {frequency: 1}, f2: {frequency: 2}, "
        "d1: {damping: 1}, d2: {damping: 2}}}\n");
    const double m = 2.0, k = 800.0, c = 6.0, pi = acos(-1.0);
    const double f1 = sqrt(k / m) / (2.0 * pi), f2 = sqrt(3.0) * f1;
    const double d1 = 0.5 * c / sqrt(k * m), d2 = sqrt(3.0) * d1;
    const double by_m[] = {-0.5 * f1 / m, -0.5 * f2 / m, -0.5 * d1 / m, -0.5 * d2 / m};
    const double by_k[] = {0.5 * f1 / k, 0.5 * f2 / k, -0.5 * d1 / k, -0.5 * d2 / k};
    const double by_c[] = {0.0, 0.0, d1 / c, d2 / c};
    double y[4];
    CHECK(se3d_study_eval_nominal(s.study, y, NULL) == SE3D_OK);
    CHECK_NEAR(y[0], f1, 1e-12 * f1);
    CHECK_NEAR(y[3], d2, 1e-12);
    check_derivatives(s, 0, by_m, 1e-9);
    check_derivatives(s, 1, by_k, 1e-9);
    check_derivatives(s, 2, by_c, 1e-9);
    close_study(s);
}

/* Two bars meet: |B - A| = b, |B - C| = c, so (B - A) . dB = b db, (B - C) . dB = 0. */
static void of_a_four_bar(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {a: 0.1, b: 0.4, c: 0.3, d: 0.35, q: 0.7, u: 0.1}\n"
        "gravity: [0, 0, 0]\n"
        "bodies:\n"
        "  - {name: crank, mass: 1, inertia: [1, 1, 1], position: [0.04, 0.03, 0]}\n"
        "  - {name: coupler, mass: 1, inertia: [1, 1, 1], position: [0.25, 0.2, 0],\n"
        "     orientation: {axis: [0, 0, 1], angle: 0.7}, markers: [{name: tip, position: [0, u, "
        "0]},"
        " {name: end, position: [b/2, 0, 0]}]}\n"
        "  - {name: rocker, mass: 1, inertia: [1, 1, 1], position: [0.38, 0.15, 0],\n"
        "     orientation: {axis: [0, 0, 1], angle: 1.2}}\n"
        "joints:\n"
        "  - {name: O, type: revolute, body_i: ground, body_j: crank, point_i: [0, 0, 0],"
        " point_j: [-a/2, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1], ref_i: [1, 0, 0], "
        "ref_j: [1, 0, 0]}\n"
        "  - {name: A, type: revolute, body_i: crank, body_j: coupler, point_i: [a/2, 0, 0],"
        " point_j: [-b/2, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1]}\n"
        "  - {name: B, type: revolute, body_i: coupler, body_j: rocker, point_i: [b/2, 0, 0],"
        " point_j: [c/2, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1]}\n"
        "  - {name: C, type: revolute, body_i: ground, body_j: rocker, point_i: [d, 0, 0],"
        " point_j: [-c/2, 0, 0], axis_i: [0, 0, 1], axis_j: [0, 0, 1]}\n"
        "drivers: [{name: motor, joint: O, value: q + 0.5*t}]\n"
        "analysis: {type: kinematics, duration: 1, step: 0.1}\n"
        "study: {parameters: {b: {from: 0.38, to: 0.42, count: 3}}, "
        "measures: {x: {initial: coupler.end.position.x}, "
        "y: {initial: coupler.end.position.y}, px: {initial: coupler.tip.position.x}, "
        "py: {initial: coupler.tip.position.y}}}\n");
    const double a = 0.1, b = 0.4, c = 0.3, d = 0.35, q = 0.7, u = 0.1;
    const double ax = a * cos(q), ay = a * sin(q), dx = d - ax, dy = -ay;
    const double r = hypot(dx, dy), along = (b * b - c * c + r * r) / (2.0 * r);
    const double high = sqrt(b * b - along * along);
    const double bx = ax + (along * dx - high * dy) / r, by = ay + (along * dy + high * dx) / r;
    const double e[2] = {bx - ax, by - ay}, f[2] = {bx - d, by};
    const double det = e[0] * f[1] - e[1] * f[0];
    const double dbx = b * f[1] / det, dby = -b * f[0] / det;
    /* P = A + (B - A) / 2 + u n, n = (-ey, ex) / b */
    const double px = 0.5 * dbx + u * (-dby / b + e[1] / (b * b));
    const double py = 0.5 * dby + u * (dbx / b - e[0] / (b * b));
    const double wanted[] = {dbx, dby, px, py};
    double y[4];
    CHECK(se3d_study_eval_nominal(s.study, y, NULL) == SE3D_OK);
    CHECK_NEAR(y[0], bx, 1e-12);
    CHECK_NEAR(y[1], by, 1e-12);
    check_derivatives(s, 0, wanted, 1e-9);
    close_study(s);
}

/* A quarter of the period from 60 deg: sqrt(l (1 + i) / g) K(sin 30 deg), K by Gauss. */
static void of_a_period(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {L: 0.8, g: 9.81, i: 0.1, start: 60 deg}\ngravity: [0, 0, -g]\n"
        "bodies: [{name: bar, mass: 2, inertia: [2*i*L^2, 2*i*L^2, 2*i*L^2], "
        "position: [L*sin(start), 0, -L*cos(start)]}]\n"
        "joints: [{name: pin, type: revolute, body_i: ground, body_j: bar, at: [0, 0, 0], "
        "axis: [0, 1, 0]}]\n"
        "events: [{name: low, channel: bar.position.x, value: 0}]\n"
        "analysis: {type: dynamics, duration: 0.8}\n"
        "study: {sensitivities: [L, g, start], measures: {quarter: {time_of: low}, "
        "energy: {final: energy.kinetic}, total: {final: energy.total}, period: 4*quarter}}\n");
    const double L = 0.8, g = 9.81, pi = acos(-1.0);
    double x = 1.0, y = cos(pi / 6.0);
    for (int k = 0; k < 8; ++k) {
        const double mean = 0.5 * (x + y);
        y = sqrt(x * y);
        x = mean;
    }
    const double quarter = sqrt(L * 1.1 / g) * pi / (2.0 * x);
    double value, slopes[4], errors[4];
    CHECK(se3d_study_eval_sensitivity(s.study, 0, &value, slopes, errors, NULL) == SE3D_OK);
    if (getenv("SE3D_SHOW")) {
        for (int k = 0; k < 4; ++k) {
            fprintf(stderr, "L %d: %.15g %.2g\n", k, slopes[k], errors[k]);
        }
        fprintf(stderr, "%.15g\n", 0.5 * quarter / L);
    }
    CHECK_NEAR(value, L, 0.0);
    CHECK_NEAR(slopes[0], 0.5 * quarter / L, 1e-8);
    CHECK_NEAR(slopes[3], 2.0 * quarter / L, 4e-8);
    CHECK(fabs(slopes[0] - 0.5 * quarter / L) <= errors[0] && errors[0] < 1e-7);
    CHECK_NEAR(slopes[2], -2.0 * g * 0.5, 1e-8);
    CHECK(se3d_study_eval_sensitivity(s.study, 1, &value, slopes, errors, NULL) == SE3D_OK);
    CHECK_NEAR(slopes[0], -0.5 * quarter / g, 1e-8);
    close_study(s);
}

/* A body comes back from a stop at 0.5 m with half of its speed, after a time t_c that does not
 * depend on it: x = 0.75 m - v (T - t_c) / 2. When it comes depends on v. */
static void of_an_impact(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {v: 1}\ngravity: [0, 0, 0]\n"
        "bodies: [{name: b, mass: 2, inertia: [1, 1, 1], position: [0, 0, 0], velocity: [v, 0, "
        "0]}]\n"
        "joints: [{name: rail, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], "
        "axis: [1, 0, 0]}]\n"
        "forces: [{name: s, type: stop, joint: rail, upper: 0.5, k: 2e4, restitution: 0.5}]\n"
        "analysis: {type: dynamics, duration: 0.7}\n"
        "study: {sensitivities: [v], measures: {x: {final: b.position.x}, u: {final: "
        "b.velocity.x}}}\n");
    double y[2];
    CHECK(se3d_study_eval_nominal(s.study, y, NULL) == SE3D_OK);
    const double wanted[] = {y[0] - 0.75, -0.5};
    check_derivatives(s, 0, wanted, 1e-8);
    close_study(s);
}

/* |p - 1| at p = 1: there is no derivative, and the estimate says so. */
static void a_corner_is_told(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {p: 1}\n"
        "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [p, 0, 0]}]\n"
        "analysis: {type: assembly}\n"
        "study: {sensitivities: [p], measures: {x: {final: block.position.x}, v: abs(x - 1), "
        "w: \"max(x, 1)\", one_sided: \"sqrt(1 - x)\", square: (x - 1)^2}}\n");
    double value, slopes[5], errors[5];
    CHECK(se3d_study_eval_sensitivity(s.study, 0, &value, slopes, errors, NULL) == SE3D_OK);
    CHECK_NEAR(slopes[0], 1.0, 1e-12);
    CHECK(errors[0] < 1e-12);
    CHECK_NEAR(errors[1], 1.0, 1e-6);
    CHECK_NEAR(errors[2], 0.5, 1e-6);
    CHECK(isnan(slopes[3]) && isnan(errors[3]));
    CHECK(fabs(slopes[4]) < 1e-12 && errors[4] < 1e-10);
    close_study(s);
}

/* What has values on one side only has the derivative of that side; no root and no jump has one. */
static void one_side_is_enough(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {p: 1}\n"
        "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [p, 4 - p, 0]}]\n"
        "analysis: {type: assembly}\n"
        "study: {sensitivities: [p], measures: {x: {final: block.position.x}, "
        "u: {final: block.position.y}, below: x^3 + 0*sqrt(1 - x), above: exp(x) + 0*sqrt(3 - u), "
        "still: 7 + 0*sqrt(1 - x), root: 5 + sqrt(3 - u), "
        "jump: \"min(1, 1e9*(3 - u)) + 0*sqrt(3 - u)\", "
        "none: x + 0*sqrt(-(x - 1)^2*(x - 0.8))}}\n");
    double value, slopes[8], errors[8];
    const double wanted[] = {1.0, -1.0, 3.0, exp(1.0), 0.0};
    CHECK(se3d_study_eval_sensitivity(s.study, 0, &value, slopes, errors, NULL) == SE3D_OK);
    for (size_t k = 0; k < 8; ++k) {
        if (getenv("SE3D_SHOW")) {
            fprintf(stderr, "%zu: %.15g %.2g\n", k, slopes[k], errors[k]);
        }
        if (k < 5) {
            CHECK_NEAR(slopes[k], wanted[k], 1e-10);
            CHECK(fabs(slopes[k] - wanted[k]) <= errors[k] + 1e-13 && errors[k] < 1e-9);
        } else {
            CHECK(isnan(slopes[k]) && isnan(errors[k]));
        }
    }
    close_study(s);
}

/* At the bounds of what is sought nothing beyond them is run; what fails leaves no derivative. */
static void bounds_are_kept(void)
{
    const opened s = open_study(
        "se3d: 1\nparameters: {p: 1, q: 1}\n"
        "bodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [p, q, 0]}]\n"
        "analysis: {type: assembly}\n"
        "study: {optimize: {parameters: {p: {from: 0, to: 2}, q: {from: 0, to: 3}}, minimize: f}, "
        "measures: {x: {final: block.position.x}, y: {final: block.position.y}, "
        "f: \"x^4 + 3*x*y + 1e6*max(0, x - 2) - 1e6*min(0, x)\", "
        "g: \"y + 0*sqrt(2.5 - y)\"}}\n");
    static const double places[] = {0.0, 2.0, 1e-3, 0.5};
    double y[4], slopes[8];
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        const double at[] = {places[k], 2.5};
        CHECK(se3d_study_eval_unknowns(s.study, at, y, slopes, NULL) == SE3D_OK);
        CHECK_NEAR(slopes[2], 4.0 * pow(at[0], 3.0) + 7.5, 1e-9);
        CHECK_NEAR(slopes[6], 3.0 * at[0], 1e-9);
        CHECK_NEAR(slopes[3], 0.0, 1e-9);
        CHECK_NEAR(slopes[7], 1.0, 1e-9);
    }
    const double beyond[] = {1.0, 2.6};
    CHECK(se3d_study_eval_unknowns(s.study, beyond, y, slopes, NULL) == SE3D_ERR_NOT_FINITE);
    CHECK(isnan(slopes[7]) && isnan(slopes[3]));
    CHECK_NEAR(slopes[2], 4.0 + 7.8, 1e-9);
    close_study(s);
}

int main(void)
{
    RUN(of_an_equilibrium);
    RUN(of_modes);
    RUN(of_a_four_bar);
    RUN(of_a_period);
    RUN(of_an_impact);
    RUN(a_corner_is_told);
    RUN(one_side_is_enough);
    RUN(bounds_are_kept);
    return check_finish();
}
