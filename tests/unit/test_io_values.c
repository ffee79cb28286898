/* SPDX-License-Identifier: BSD-3-Clause */
/* What the reader makes of orientations, shapes, parameters and inertia, and how numbers are
 * written. */
#include <locale.h>
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "io/base/number.h"
#include "se3d/io.h"

/* A model with one body `b` made of `keys`. */
static se3d_model *read_body(const char *keys, se3d_body *body)
{
    char text[1000];
    se3d_model *model = NULL;
    se3d_model_error error;
    snprintf(text, sizeof text,
             "se3d: 1\nparameters: {c: 2*b, b: a + 1, a: 0.5}\nbodies: [{name: b, %s}]\n", keys);
    if (SE3D_FAILED(se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error)) ||
        SE3D_FAILED(se3d_body_find(se3d_model_get_system(model), "b", body))) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(model != NULL);
    return model;
}

static void four_ways_to_say_an_orientation_agree(void)
{
    /* 120 degrees about (1, 1, 1): x -> y -> z -> x. */
    static const char *const ways[] = {
        "{matrix: [[0, 0, 1], [1, 0, 0], [0, 1, 0]]}", "{euler_parameters: [0.5, 0.5, 0.5, 0.5]}",
        "{axis: [2, 2, 2], angle: 120*deg}", "{rpy: [pi/2, 0, pi/2]}"};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
        char keys[200];
        se3d_body body;
        double p[4] = {0.0, 0.0, 0.0, 0.0};
        snprintf(keys, sizeof keys, "mass: 1, inertia: [1, 1, 1], orientation: %s", ways[k]);
        se3d_model *model = read_body(keys, &body);
        se3d_body_get_orientation(se3d_model_get_system(model), body, p);
        for (int i = 0; i < 4; ++i) {
            CHECK_NEAR(p[i], 0.5, 1e-15);
        }
        se3d_model_destroy(model);
    }
}

/* Of all lengths and places of the point, beside what the C library reads. */
static void decimal_numbers_are_read_to_the_last_bit(void)
{
    uint64_t seed = 7;
    for (int k = 0; k < 400; ++k) {
        char number[40], keys[80];
        se3d_body body;
        double mass = 0.0, J[6];
        snprintf(number, sizeof number, "%.*f", k % 19, (1.5 + check_random(&seed)) * (1 + k * k));
        snprintf(keys, sizeof keys, "mass: %s, inertia: [1, 1, 1]", number);
        se3d_model *model = read_body(keys, &body);
        CHECK(se3d_body_get_mass(se3d_model_get_system(model), body, &mass, J) == SE3D_OK);
        const double wanted = strtod(number, NULL);
        CHECK(memcmp(&mass, &wanted, sizeof mass) == 0);
        se3d_model_destroy(model);
    }
}

/* A = Rz(yaw) Ry(pitch) Rx(roll): its first column and last row in closed form. */
static void roll_pitch_yaw_are_about_fixed_axes_in_this_order(void)
{
    se3d_body body;
    double x[3];
    double y[3];
    const double ex[3] = {1.0, 0.0, 0.0};
    const double ey[3] = {0.0, 1.0, 0.0};
    se3d_model *model =
        read_body("mass: 1, inertia: [1, 1, 1], orientation: {rpy: [0.3, -0.4, 0.5]}", &body);
    se3d_body_get_point(se3d_model_get_system(model), body, ex, x);
    se3d_body_get_point(se3d_model_get_system(model), body, ey, y);
    CHECK_NEAR(x[0], cos(0.5) * cos(0.4), 1e-15);
    CHECK_NEAR(x[1], sin(0.5) * cos(0.4), 1e-15);
    CHECK_NEAR(x[2], sin(0.4), 1e-15);
    CHECK_NEAR(y[2], cos(0.4) * sin(0.3), 1e-15);
    se3d_model_destroy(model);
}

static void matrices_near_half_turns_are_read_exactly(void)
{
    uint64_t seed = 7;
    for (int k = 0; k < 200; ++k) {
        char keys[600];
        double e[4];
        double p[4] = {0.0, 0.0, 0.0, 0.0};
        double length = 0.0;
        se3d_body body;
        for (int i = 0; i < 4; ++i) {
            e[i] = i == k % 4 ? 1.0 : 1e-3 * check_random(&seed);
            length += e[i] * e[i];
        }
        for (int i = 0; i < 4; ++i) {
            e[i] /= sqrt(length);
        }
        const double sign = e[0] < 0.0 ? -1.0 : 1.0;
        snprintf(keys, sizeof keys,
                 "mass: 1, inertia: [1, 1, 1], orientation: {matrix: [[%.17g, %.17g, %.17g], "
                 "[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]]}",
                 1 - 2 * (e[2] * e[2] + e[3] * e[3]), 2 * (e[1] * e[2] - e[0] * e[3]),
                 2 * (e[1] * e[3] + e[0] * e[2]), 2 * (e[1] * e[2] + e[0] * e[3]),
                 1 - 2 * (e[1] * e[1] + e[3] * e[3]), 2 * (e[2] * e[3] - e[0] * e[1]),
                 2 * (e[1] * e[3] - e[0] * e[2]), 2 * (e[2] * e[3] + e[0] * e[1]),
                 1 - 2 * (e[1] * e[1] + e[2] * e[2]));
        se3d_model *model = read_body(keys, &body);
        se3d_body_get_orientation(se3d_model_get_system(model), body, p);
        for (int i = 0; i < 4; ++i) {
            CHECK_NEAR(p[i], sign * e[i], 1e-13);
        }
        se3d_model_destroy(model);
    }
}

static void expect_mass(const char *keys, double mass, const double inertia[6])
{
    se3d_body body;
    double m = 0.0;
    double J[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    se3d_model *model = read_body(keys, &body);
    se3d_body_get_mass(se3d_model_get_system(model), body, &m, J);
    CHECK_NEAR(m, mass, 1e-12 * mass);
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(J[k], inertia[k], 1e-12 * fabs(inertia[0]));
    }
    se3d_model_destroy(model);
}

static void shapes_give_mass_and_inertia(void)
{
    const double pi = acos(-1.0);
    const double ball = 4.0 / 3.0 * pi * 8.0; /* r = 2 */
    const double tube = pi * 4.0 * 6.0;       /* r = 2, length 6 */
    expect_mass("density: 3, shapes: [{type: box, size: [1, 2, 4]}]", 24.0,
                (double[6]){24.0 * 20.0 / 12.0, 24.0 * 17.0 / 12.0, 24.0 * 5.0 / 12.0});
    expect_mass("shapes: [{type: sphere, radius: 2, density: 1}]", ball,
                (double[6]){1.6 * ball, 1.6 * ball, 1.6 * ball});
    expect_mass("density: 1, shapes: [{type: cylinder, radius: 2, length: 6}]", tube,
                (double[6]){tube * 4.0, tube * 4.0, tube * 2.0});
    /* Two hemispheres with their centres of mass 3 + 3/8 r from the middle. */
    const double cap = ball * (0.4 * 4.0 - 0.75 * 0.75 + 3.75 * 3.75);
    expect_mass("density: 1, shapes: [{type: capsule, radius: 2, length: 6}]", tube + ball,
                (double[6]){tube * 4.0 + cap, tube * 4.0 + cap, tube * 2.0 + 1.6 * ball});
    /* Turned by 90 degrees about x: its axis is -y; shifted pairs add m s^2. */
    expect_mass(
        "density: 1, shapes: [{type: cylinder, radius: 2, length: 6, orientation: {axis: [1, "
        "0, 0], angle: pi/2}}]",
        tube, (double[6]){tube * 4.0, tube * 2.0, tube * 4.0});
    expect_mass(
        "density: 1, shapes: [{type: sphere, radius: 2, position: [3, 1, 0]}, {type: sphere, "
        "radius: 2, position: [-3, -1, 0]}]",
        2.0 * ball,
        (double[6]){2 * ball * 2.6, 2 * ball * 10.6, 2 * ball * 11.6, -6.0 * ball, 0.0, 0.0});
}

static void inertia_is_read_in_three_forms(void)
{
    expect_mass("mass: 1, inertia: [2, 3, 4, 0.1, 0.2, 0.3]", 1.0,
                (double[6]){2.0, 3.0, 4.0, 0.1, 0.2, 0.3});
    expect_mass("mass: 1, inertia: [[2, 0.1, 0.3], [0.1, 3, 0.2], [0.3, 0.2, 4]]", 1.0,
                (double[6]){2.0, 3.0, 4.0, 0.1, 0.2, 0.3});
    /* Parameters stand in any order: c = 2 (a + 1) = 3. */
    expect_mass("mass: c, inertia: [a, a, a]", 3.0, (double[6]){0.5, 0.5, 0.5});
}

static void expect_number(double value, const char *text)
{
    char written[64];
    written[se3di_number_format(value, written)] = '\0';
    CHECK(strcmp(written, text) == 0);
    if (strcmp(written, text) != 0) {
        fprintf(stderr, "%s, expected %s\n", written, text);
    }
}

static void numbers_have_a_point_in_every_locale(void)
{
    static const char *const locales[] = {"C", "de_DE.UTF-8", "fr_FR.UTF-8", "ps_AF.UTF-8"};
    for (size_t k = 0; k < sizeof locales / sizeof *locales; ++k) {
        if (setlocale(LC_ALL, locales[k])) {
            expect_number(0.1, "0.10000000000000001");
            expect_number(-2.5e-300, "-2.5e-300");
            expect_number(1.5e300, "1.5000000000000001e+300");
            expect_number(1e22, "1e+22");
            expect_number(-7.0, "-7");
            expect_number(0.0, "0");
            expect_number(-0.0, "-0");
            expect_number(HUGE_VAL, "inf");
        }
    }
    setlocale(LC_ALL, "C");
}

/* The same as printf, for numbers of all sizes: random bits, few digits, powers of ten and of two,
 * middles between numbers of 17 digits, and what is next to all of them. */
static void numbers_are_written_as_printf_does(void)
{
    uint64_t seed = 88172645463325252u;
    for (int k = 0; k < 120000; ++k) {
        char expected[64];
        double value = 0.0;
        uint64_t bits = seed ^= seed << 13;
        seed ^= seed >> 7;
        bits = seed ^= seed << 17;
        memcpy(&value, &bits, sizeof value);
        if (k % 6 == 1) {
            value = (double)(bits >> 44) / 1000.0;
        } else if (k % 6 == 2) {
            value = pow(10.0, (double)(int)(bits % 640) - 320.0);
        } else if (k % 6 == 3) {
            value = ldexp((double)(bits % 65536), (int)(bits >> 40) % 64 - 80);
        } else if (k % 6 == 4) {
            value = (check_random(&seed) - 0.5) * 100.0;
        } else if (k % 6 == 5) {
            value = nextafter(pow(10.0, (double)(int)(bits % 50) - 25.0), k % 4 < 2 ? 0.0 : 1e300);
        }
        if (isfinite(value)) {
            snprintf(expected, sizeof expected, "%.17g", value);
            expect_number(value, expected);
        }
    }
    for (int k = -1100; k < 1024; ++k) {
        char expected[64];
        snprintf(expected, sizeof expected, "%.17g", -ldexp(1.0, k));
        expect_number(-ldexp(1.0, k), expected);
    }
}

/* Limits of a controller and a law in a part that is turned are put together from numbers. */
static void laws_are_put_together_alike_in_every_locale(void)
{
    static const char text[] =
        "se3d: 1\n"
        "bodies: [{name: b, mass: 1, inertia: [1, 1, 1]}]\n"
        "states:\n"
        "  - {name: s, type: pid, input: t + 9, kp: 1.5, ki: 0.5, lower: -1.5, upper: 2.5}\n"
        "parts:\n"
        "  p:\n"
        "    bodies: [{name: c, mass: 1, inertia: [1, 1, 1]}]\n"
        "    forces: [{name: f, type: force, body: c, value: [1.5*t, 2*t, 0]}]\n"
        "instances: [{part: p, prefix: q_, orientation: {axis: [0, 0, 1], angle: 0.3}}]\n";
    static const char *const locales[] = {"C", "de_DE.UTF-8", "fr_FR.UTF-8", "ps_AF.UTF-8"};
    for (size_t k = 0; k < sizeof locales / sizeof *locales; ++k) {
        se3d_model *model = NULL;
        se3d_model_error error = {0, 0, ""};
        se3d_state state;
        double value = 0.0;
        if (!setlocale(LC_ALL, locales[k])) {
            continue;
        }
        if (SE3D_FAILED(se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error))) {
            fprintf(stderr, "%s: %s\n", locales[k], error.message);
        }
        CHECK(model != NULL);
        if (model) {
            const se3d_system *system = se3d_model_get_system(model);
            CHECK(!se3d_state_find(system, "s", &state));
            CHECK(!se3d_state_get_value(system, state, SE3D_STATE_OUTPUT, &value));
            CHECK_NEAR(value, 2.5, 0.0);
        }
        se3d_model_destroy(model);
    }
    setlocale(LC_ALL, "C");
}

static void missing_arguments_are_named(void)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    CHECK(se3d_model_read_text(NULL, 0, "x", NULL, &model, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_read_text("a", 1, NULL, NULL, &model, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_read_text("a", 1, "x", NULL, NULL, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_read_file(NULL, NULL, &model, &error) == SE3D_ERR_NULL);
    CHECK(se3d_model_read_file("/nonexistent/x.yaml", NULL, &model, &error) == SE3D_ERR_IO);
    CHECK_CONTAINS(error.message, "/nonexistent/x.yaml: ");
    CHECK(se3d_model_read_text("", 0, "x", NULL, &model, NULL) == SE3D_ERR_MODEL);
    se3d_model_destroy(NULL);
}

/* What the caller gave may be gone once the model is read. */
static void texts_of_the_caller_are_copied(void)
{
    const char *model_text = "se3d: 1\nparameters: {L: 500 mm, a: 2*L}\n"
                             "bodies: [{name: b, mass: 1, inertia: [1, 1, 1]}]\n";
    char given[6][16] = {"L", "700 mm", "dynamics", "rk4", "0.01", "1"};
    se3d_model_setting setting = {given[0], given[1]};
    se3d_model_options options = se3d_model_options_default();
    se3d_model *model = NULL;
    se3d_model_error error;
    options.settings = &setting;
    options.setting_count = 1;
    options.analysis = given[2];
    options.method = given[3];
    options.step = given[4];
    options.duration = given[5];
    CHECK(se3d_model_read_text(model_text, strlen(model_text), "m", &options, &model, &error) ==
          SE3D_OK);
    memset(given, 'x', sizeof given);
    double value = 0.0;
    CHECK(se3d_model_get_parameter(model, "L", &value) == SE3D_OK);
    CHECK_NEAR(value, 0.7, 1e-15);
    CHECK(se3d_model_get_parameter(model, "a", &value) == SE3D_OK);
    CHECK_NEAR(value, 1.4, 1e-15);
    CHECK(se3d_model_get_parameter(model, "xxx", &value) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(four_ways_to_say_an_orientation_agree);
    RUN(decimal_numbers_are_read_to_the_last_bit);
    RUN(roll_pitch_yaw_are_about_fixed_axes_in_this_order);
    RUN(matrices_near_half_turns_are_read_exactly);
    RUN(shapes_give_mass_and_inertia);
    RUN(inertia_is_read_in_three_forms);
    RUN(numbers_have_a_point_in_every_locale);
    RUN(numbers_are_written_as_printf_does);
    RUN(laws_are_put_together_alike_in_every_locale);
    RUN(missing_arguments_are_named);
    RUN(texts_of_the_caller_are_copied);
    return check_finish();
}
