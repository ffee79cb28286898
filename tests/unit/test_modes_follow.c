/* SPDX-License-Identifier: BSD-3-Clause */
/* Modes of one system in another one: eigenvalues to second order in what the systems differ by,
 * with symmetric and unsymmetric matrices; derivatives of studies by them, which are those of runs.
 * docs/theory/modes.md */
#include "support/study_slopes.h"
#include "support/text_model.h"

#include "se3d/modes.h"
#include "se3d/study.h"

#include <math.h>
#include <stdio.h>

enum { PARAMETERS = 6, MEASURES = 5 };
static const char *const names[PARAMETERS] = {"m", "k", "c", "P", "L", "g"};
static const double at[PARAMETERS] = {2.0, 40.0, 0.3, 15.0, 0.4, 3.0};

/* A column of two bars, bent by a side wind; the force at its tip turns with it, so that the
 * stiffness is unsymmetric (Ziegler 1952). P = 0: it is symmetric. */
static const char column[] =
    "se3d: 1\n"
    "parameters: {m: %.17g, k: %.17g, c: %.17g, P: %.17g, L: %.17g, g: %.17g}\n"
    "gravity: [g, 0, -9.81]\n"
    "bodies:\n"
    "  - {name: a, mass: m, inertia: [0.02, 0.02, 0.001], position: [0, 0, L/2]}\n"
    "  - {name: b, mass: 1, inertia: [0.03, m*L^2/20, 0.03], position: [0, 0, 1.5*L]}\n"
    "joints:\n"
    "  - {name: O, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
    "  - {name: A, type: revolute, body_i: a, body_j: b, at: [0, 0, L], axis: [0, 1, 0]}\n"
    "forces:\n"
    "  - {name: s1, type: rsda, joint: O, k: k, c: c}\n"
    "  - {name: s2, type: rsda, joint: A, k: 0.8*k, c: %s}\n"
    "  - {name: tip, type: force, body: b, point: [0, 0, L/2], frame: body, value: [0, 0, -P]}\n"
    "analysis: [{type: %s}, {type: modes}]\n"
    "study:\n"
    "  parameters: {m: [2], k: [40], c: [0.3], P: [15], L: [0.4], g: [3]}\n"
    "  optimize: {minimize: f1, parameters: {m: {from: 1, to: 3}, k: {from: 20, to: 60},\n"
    "    c: {from: 0, to: 1}, P: {from: 0, to: 20}, L: {from: 0.2, to: 0.6}, g: {from: 0, to: "
    "5}}}\n"
    "  measures: {f1: {frequency: 1}, f2: {frequency: 2}, d1: {damping: 1},\n"
    "    all: f1*f2 + m, x: {final: b.position.x}}\n";

static void write(char *text, size_t size, const double *p, const char *c2, const char *first)
{
    snprintf(text, size, column, p[0], p[1], p[2], p[3], p[4], p[5], c2, first);
}

static text_model open_column(const double *p, const char *c2)
{
    char text[4000];
    write(text, sizeof text, p, c2, "equilibrium");
    text_model m = text_model_open(text, -1, -1, 0.0);
    CHECK(text_model_run(&m, 0.0));
    return m;
}

/* How far eigenvalues by the modes of the column are off those of one with another parameter, and
 * how far those are from the column's. */
static double follow(int is_loaded, const char *c2, int which, double share, double *moved)
{
    double p[PARAMETERS], re[4], im[4], off = 0.0;
    memcpy(p, at, sizeof p);
    p[3] = is_loaded ? p[3] : 0.0;
    p[2] = c2[0] == '0' ? 0.0 : p[2];
    text_model of = open_column(p, c2);
    p[which] += share * at[which];
    text_model to = open_column(p, c2);
    se3d_modes *modes = NULL, *own = NULL;
    CHECK(!se3d_modes_create(of.system, NULL, &modes) && !se3d_modes_create(to.system, NULL, &own));
    CHECK(se3d_modes_count(modes) == 2 && se3d_modes_count(own) == 2);
    CHECK(!se3d_modes_follow(modes, to.system, 2, re, im));
    *moved = 0.0;
    for (size_t k = 0; k < 2; ++k) {
        se3d_eigenvalue a, b;
        CHECK(!se3d_modes_get_eigenvalue(modes, k, &a) && !se3d_modes_get_eigenvalue(own, k, &b));
        const double size = hypot(a.real, a.imaginary);
        off = fmax(off, hypot(re[k] - b.real, im[k] - b.imaginary) / size);
        *moved = fmax(*moved, hypot(a.real - b.real, a.imaginary - b.imaginary) / size);
    }
    se3d_modes_destroy(modes);
    se3d_modes_destroy(own);
    text_model_close(&of);
    text_model_close(&to);
    return off;
}

static void what_is_left_is_of_second_order(void)
{
    for (int k = 0; k < 4 * PARAMETERS; ++k) {
        const int which = k % PARAMETERS, is_loaded = k / PARAMETERS % 2;
        const char *c2 = k / PARAMETERS / 2 ? "0" : "2*c"; /* that is not as K: complex shapes */
        double moved[2];
        const double first = follow(is_loaded, c2, which, 0.02, &moved[0]);
        const double second = follow(is_loaded, c2, which, 0.01, &moved[1]);
        if (getenv("SE3D_SHOW")) {
            fprintf(stderr, "%d %s %s: %.2g %.2g of %.2g\n", is_loaded, c2, names[which], first,
                    second, moved[0]);
        }
        CHECK(moved[0] > 1e-6);
        CHECK(first <= 0.2 * moved[0] && second <= first / 3.5 + 1e-11);
    }
}

static void derivatives_are_those_of_runs(void)
{
    static const char *const firsts[] = {"equilibrium", "assembly"};
    for (int run = 0; run < 2; ++run) {
        char text[4000];
        se3d_model *model = NULL;
        se3d_study *study = NULL;
        double y[MEASURES], search[PARAMETERS * MEASURES];
        write(text, sizeof text, at, "2*c", firsts[run]);
        CHECK(!se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, NULL));
        CHECK(!se3d_study_create(model, &study, NULL));
        CHECK(!se3d_study_eval_unknowns(study, at, y, search, NULL));
        for (int which = 0; which < PARAMETERS; ++which) {
            double value, slopes[MEASURES], errors[MEASURES], wanted[MEASURES];
            CHECK(!se3d_study_eval_sensitivity(study, (size_t)which, &value, slopes, errors, NULL));
            study_slopes(study, at, PARAMETERS, (size_t)which, wanted, MEASURES);
            for (size_t k = 0; k < MEASURES; ++k) {
                const double size = fabs(wanted[k]) + fabs(y[k]) / value + 1e-12;
                const double off = fabs(slopes[k] - wanted[k]) / size;
                const double other = fabs(search[(size_t)which * MEASURES + k] - wanted[k]) / size;
                if (getenv("SE3D_SHOW")) {
                    fprintf(stderr, "%s by %s: %.12g %.2g +- %.2g, %.2g\n",
                            se3d_study_get_measure_name(study, k), names[which], slopes[k], off,
                            errors[k] / size, other);
                }
                CHECK(off < 1e-9 && errors[k] < 1e-9 * size + 1e-12 && other < 1e-8);
            }
        }
        se3d_study_destroy(study);
        se3d_model_destroy(model);
    }
}

/* Two equal pendulums have a mode each of the same frequency, and what floats has 0: runs are taken
 * for these. Another number of freedoms, no matrices. */
static void what_cannot_be_followed_is_refused(void)
{
    static const char pair[] =
        "se3d: 1\n"
        "gravity: [0, 0, -9.81]\n"
        "bodies:\n"
        "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, -1]}\n"
        "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [3, 0, -1]}\n"
        "  - {name: c, mass: 1, inertia: [1, 1, 1], position: [6, 0, 0]}\n"
        "joints:\n"
        "  - {name: A, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
        "  - {name: B, type: revolute, body_i: ground, body_j: b, at: [3, 0, 0], axis: [0, 1, 0]}\n"
        "  - {name: C, type: revolute, body_i: ground, body_j: c, at: [6, 0, 0], axis: [0, 1, 0]}\n"
        "analysis: {type: equilibrium}\n";
    text_model twins = text_model_open(pair, -1, -1, 0.0), single = open_column(at, "c");
    se3d_modes *modes = NULL;
    double re[8], im[8];
    CHECK(!se3d_modes_create(twins.system, NULL, &modes));
    const size_t count = se3d_modes_count(modes);
    CHECK(count >= 3 && count <= 8);
    CHECK(!se3d_modes_follow(modes, twins.system, count, re, im));
    for (size_t k = 0; k < count; ++k) {
        CHECK(isnan(re[k]) && isnan(im[k]));
    }
    CHECK(se3d_modes_follow(modes, single.system, count, re, im) == SE3D_ERR_STATE);
    CHECK_CONTAINS(se3d_system_get_error(single.system), "2 bodies that move");
    CHECK(isnan(re[0]));
    CHECK(se3d_modes_follow(modes, single.system, count + 1, re, im) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(single.system), "must be the number of the modes");
    CHECK(se3d_modes_follow(NULL, single.system, count, re, im) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, NULL, count, re, im) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, single.system, count, NULL, im) == SE3D_ERR_NULL);
    CHECK(se3d_modes_follow(modes, single.system, count, re, NULL) == SE3D_ERR_NULL);
    se3d_modes_destroy(modes);
    text_model_close(&twins);
    text_model_close(&single);
}

int main(void)
{
    RUN(what_is_left_is_of_second_order);
    RUN(derivatives_are_those_of_runs);
    RUN(what_cannot_be_followed_is_refused);
    return check_finish();
}
