/* SPDX-License-Identifier: BSD-3-Clause */
/* Modes of bodies that spin in what carries them, against closed forms: their axes turn, the
 * coefficients of small motions do not, if the right axes are taken; otherwise they are refused. */
#include "support/text_model.h"

#include "se3d/modes.h"

static void compute_roots(double a, double b, double c, double roots[2]) /* a x^2 + b x + c = 0 */
{
    const double root = sqrt(b * b - 4.0 * a * c);
    roots[0] = sqrt((-b - root) / (2.0 * a));
    roots[1] = sqrt((-b + root) / (2.0 * a));
}

/* The undamped frequencies among the modes; the others have none. */
static void check_frequencies(const text_model *m, const double *expected, size_t count)
{
    se3d_modes *modes = NULL;
    size_t found = 0;
    const se3d_status status = se3d_modes_create(m->system, NULL, &modes);
    CHECK(status == SE3D_OK);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(m->system));
        return;
    }
    for (size_t k = 0; k < se3d_modes_count(modes); ++k) {
        se3d_eigenvalue value;
        CHECK(!se3d_modes_get_eigenvalue(modes, k, &value));
        if (value.imaginary > 1e-3) {
            CHECK(found < count);
            CHECK_NEAR(value.imaginary, expected[found < count ? found : 0],
                       1e-7 * value.imaginary);
            CHECK_NEAR(value.real, 0.0, 1e-6);
            ++found;
        }
    }
    CHECK(found == count);
    se3d_modes_destroy(modes);
}

static text_model open_model(const char *text)
{
    text_model m = text_model_open(text, -1, -1, 0.0);
    return m;
}

/* Outer ring about x, inner ring about y, both on springs; the rotor spins about z with p. */
static text_model open_gimbal(double p, double Jy, double tilting)
{
    static const char format[] =
        "{se3d: 1, gravity: [0, 0, 0], bodies: ["
        "{name: outer, mass: 1, inertia: [0.03, 0.04, 0.05], angular_velocity: [%g, 0, 0]},"
        "{name: inner, mass: 1, inertia: [0.02, 0.015, 0.01], angular_velocity: [%g, 0, 0]},"
        "{name: rotor, mass: 3, inertia: [0.1, %g, 0.16], angular_velocity: [%g, 0, %g]}],"
        " joints: [{name: a, type: revolute, body_i: ground, body_j: outer, at: [0, 0, 0],"
        "  axis: [1, 0, 0]}, {name: b, type: revolute, body_i: outer, body_j: inner,"
        "  at: [0, 0, 0], axis: [0, 1, 0]}, {name: c, type: revolute, body_i: inner,"
        "  body_j: rotor, at: [0, 0, 0], axis: [0, 0, 1]}],"
        " forces: [{type: rsda, joint: a, k: 900}, {type: rsda, joint: b, k: 600}],"
        " analysis: {type: dynamics, duration: 1}}";
    char text[2000];
    snprintf(text, sizeof text, format, tilting, tilting, Jy, tilting, p);
    return open_model(text);
}

/* (k1 - Jx w^2) (k2 - Jy w^2) = H^2 w^2 */
static void a_rotor_in_a_gimbal_on_springs_whirls(void)
{
    static const double speeds[] = {1e-8, 5.0, 60.0, 400.0, -60.0};
    for (size_t k = 0; k < sizeof speeds / sizeof *speeds; ++k) {
        const double H = 0.16 * speeds[k], Jx = 0.1 + 0.03 + 0.02, Jy = 0.1 + 0.015;
        double expected[2];
        compute_roots(Jx * Jy, -(900.0 * Jy + 600.0 * Jx + H * H), 900.0 * 600.0, expected);
        text_model m = open_gimbal(speeds[k], 0.1, 0.0);
        check_frequencies(&m, expected, 2);
        text_model_close(&m);
    }
}

static void check_refused(text_model *m)
{
    se3d_modes *modes = NULL;
    CHECK(se3d_modes_create(m->system, NULL, &modes) == SE3D_ERR_STATE);
    CHECK(modes == NULL);
    CHECK_CONTAINS(se3d_system_get_error(m->system), "constant coefficients");
    text_model_close(m);
}

static void motions_without_constant_coefficients_are_refused(void)
{
    text_model unsymmetric = open_gimbal(60.0, 0.12, 0.0);
    check_refused(&unsymmetric);
    text_model tilting = open_gimbal(60.0, 0.1, 0.3);
    check_refused(&tilting);
}

static void a_refusal_leaves_the_state(void)
{
    text_model m = open_gimbal(60.0, 0.12, 0.0);
    se3d_modes *modes = NULL;
    text_model_run(&m, 0.0);
    const uint64_t hash = se3d_system_hash(m.system);
    CHECK(se3d_modes_create(m.system, NULL, &modes) == SE3D_ERR_STATE);
    CHECK(se3d_system_hash(m.system) == hash);
    text_model_close(&m);
    m = open_gimbal(60.0, 0.1, 0.0);
    text_model_run(&m, 0.0);
    const uint64_t before = se3d_system_hash(m.system);
    CHECK(!se3d_modes_create(m.system, NULL, &modes));
    CHECK(se3d_system_hash(m.system) == before);
    se3d_modes_destroy(modes);
    text_model_close(&m);
}

/* A table that turns with W about z carries a frame, hinged about its x, with a rotor about z:
 * (Jt + Jfx) w^2 = k + H W - (Jt + Jfy - Jfz) W^2, H = Jp (p + W). */
static void a_rotor_on_a_turning_table_nods(void)
{
    static const char format[] =
        "{se3d: 1, gravity: [0, 0, 0], bodies: ["
        "{name: table, mass: 9, inertia: [1, 2, 3], angular_velocity: [0, 0, %g]},"
        "{name: frame, mass: 1, inertia: [0.02, 0.03, 0.04], angular_velocity: [0, 0, %g]},"
        "{name: rotor, mass: 3, inertia: [0.1, 0.1, 0.16], angular_velocity: [0, 0, %g]}],"
        " joints: [{name: a, type: revolute, body_i: ground, body_j: table, at: [0, 0, 0],"
        "  axis: [0, 0, 1]}, {name: b, type: revolute, body_i: table, body_j: frame,"
        "  at: [0, 0, 0], axis: [1, 0, 0]}, {name: c, type: revolute, body_i: frame,"
        "  body_j: rotor, at: [0, 0, 0], axis: [0, 0, 1]}],"
        " drivers: [{joint: a, value: %g*t}], forces: [{type: rsda, joint: b, k: 50}],"
        " analysis: {type: dynamics, duration: 1}}";
    static const double cases[][2] = {{2.0, 40.0}, {7.0, 3.0}, {-3.0, 20.0}, {5.0, 0.0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        const double W = cases[k][0], p = cases[k][1];
        char text[2000];
        snprintf(text, sizeof text, format, W, W, p + W, W);
        text_model m = open_model(text);
        const double stiffness = 50.0 + 0.16 * (p + W) * W - (0.1 + 0.03 - 0.04) * W * W;
        const double expected = sqrt(stiffness / 0.12);
        check_frequencies(&m, &expected, 1);
        text_model_close(&m);
    }
}

/* A rotor in a bushing that is softer one way: constant in axes that do not turn. */
static void a_rotor_in_an_unequal_bushing_whirls(void)
{
    static const char format[] =
        "{se3d: 1, gravity: [0, 0, 0], bodies: [{name: rotor, mass: 3,"
        " inertia: [0.1, 0.1, 0.16], angular_velocity: [0, 0, %g]}],"
        " joints: [{name: j, type: spherical, body_i: ground, body_j: rotor, at: [0, 0, 0]}],"
        " forces: [%s], analysis: {type: dynamics, duration: 1}}";
    /* springs along x and y at the height .5 */
    static const char springs[] =
        "{type: tsda, body_i: ground, body_j: rotor, point_i: [10, 0, 0.5], point_j: [0, 0, 0.5],"
        " k: 4000, l0: 10}, {type: tsda, body_i: ground, body_j: rotor, point_i: [0, 10, 0.5],"
        " point_j: [0, 0, 0.5], k: 1500, l0: 10}";
    static const double speeds[] = {10.0, 100.0};
    for (size_t k = 0; k < 2; ++k) {
        char text[2000];
        double expected[2];
        const double H = 0.16 * speeds[k], kx = 4000.0 * 0.25, ky = 1500.0 * 0.25;
        compute_roots(0.01, -(0.1 * kx + 0.1 * ky + H * H), kx * ky, expected);
        snprintf(text, sizeof text, format, speeds[k], springs);
        text_model m = open_model(text);
        check_frequencies(&m, expected, 2);
        text_model_close(&m);
    }
}

/* Free, unequal inertias, about the largest: w^2 (J3 - J1) (J3 - J2) / (J1 J2). */
static void a_free_body_that_spins_wobbles(void)
{
    text_model m =
        open_model("{se3d: 1, gravity: [0, 0, 0], bodies: [{name: b, mass: 3,"
                   " inertia: [0.1, 0.2, 0.25], angular_velocity: [0, 0, 8]}],"
                   " joints: [{type: spherical, body_i: ground, body_j: b, at: [0, 0, 0]}],"
                   " analysis: {type: dynamics, duration: 1}}");
    se3d_modes *modes = NULL;
    CHECK(!se3d_modes_create(m.system, NULL, &modes));
    const double wobble = 8.0 * sqrt(0.15 * 0.05 / 0.02);
    int found = 0;
    for (size_t k = 0; k < se3d_modes_count(modes); ++k) {
        se3d_eigenvalue value;
        CHECK(!se3d_modes_get_eigenvalue(modes, k, &value));
        found += fabs(value.imaginary - wobble) < 1e-8 * wobble;
    }
    CHECK(found == 1);
    se3d_modes_destroy(modes);
    text_model_close(&m);
}

int main(void)
{
    RUN(a_rotor_in_a_gimbal_on_springs_whirls);
    RUN(motions_without_constant_coefficients_are_refused);
    RUN(a_refusal_leaves_the_state);
    RUN(a_rotor_on_a_turning_table_nods);
    RUN(a_rotor_in_an_unequal_bushing_whirls);
    RUN(a_free_body_that_spins_wobbles);
    return check_finish();
}
