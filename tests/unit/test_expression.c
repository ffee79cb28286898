/* SPDX-License-Identifier: BSD-3-Clause */
/* Expressions: values, exact derivatives, conventions, limits, messages. */
#include "check.h"
#include "expression/expression.h"

#include <locale.h>
#include <stdlib.h>

static const char *const variables[] = {"t", "l", "ld"};
static const se3d_expression_symbol symbols[] = {{"L", 2.0},    {"w", 0.05}, {"rho", 7800.0},
                                                 {"zero", 0.0}, {"e", 7.0},  {"_k1", -3.0}};

static se3d_expression_def define(const char *text)
{
    se3d_expression_def def = se3d_expression_def_default();
    def.text = text;
    def.variables = variables;
    def.variable_count = 3;
    def.symbols = symbols;
    def.symbol_count = sizeof symbols / sizeof symbols[0];
    return def;
}

static se3d_expression *compile(const char *text)
{
    se3d_expression_def def = define(text);
    se3d_expression *expression = NULL;
    se3d_expression_error error;
    CHECK(se3d_expression_create(&def, &expression, &error) == SE3D_OK);
    if (!expression) {
        fprintf(stderr, "    %s:%zu: %s\n", text, error.column, error.message);
    }
    return expression;
}

static double value_at(const char *text, double t)
{
    double x[3] = {t, 0.5, -0.25}, value = 0.0;
    se3d_expression *expression = compile(text);
    CHECK(se3d_expression_eval(expression, x, &value) == SE3D_OK);
    se3d_expression_destroy(expression);
    return value;
}

static se3d_status jet_at(const char *text, double t, double jet[3])
{
    double x[3] = {t, 0.5, -0.25};
    se3d_expression *expression = compile(text);
    se3d_status status = se3d_expression_eval_time(expression, x, jet);
    se3d_expression_destroy(expression);
    return status;
}

static void check_jet(const char *text, double t, double f, double f1, double f2)
{
    double jet[3];
    int before = check_failures;
    CHECK(jet_at(text, t, jet) == SE3D_OK);
    CHECK_NEAR(jet[0], f, 4e-15 * (1.0 + fabs(f)));
    CHECK_NEAR(jet[1], f1, 8e-15 * (1.0 + fabs(f1)));
    CHECK_NEAR(jet[2], f2, 2e-14 * (1.0 + fabs(f2)));
    if (check_failures > before) {
        fprintf(stderr, "    in %s at %g\n", text, t);
    }
}

/* ---- values ---------------------------------------------------------------------------------*/

static void operators_bind_as_in_mathematics(void)
{
    static const struct {
        const char *text;
        double value;
    } rows[] = {
        {"1+2*3", 7},
        {"(1+2)*3", 9},
        {"8-4-2", 2},
        {"8/4/2", 1},
        {"8-4+2", 6},
        {"8/4*2", 4},
        {"2^3^2", 512},
        {"(2^3)^2", 64},
        {"-2^2", -4},
        {"(-2)^2", 4},
        {"2^-1", 0.5},
        {"2^-1^2", 0.5},
        {"-2^-2", -0.25},
        {"2*-3", -6},
        {"2--3", 5},
        {"--3", 3},
        {"-+-3", 3},
        {"+4", 4},
        {"-3^3", -27},
        {"1<2", 1},
        {"2<1", 0},
        {"2<2", 0},
        {"2<=2", 1},
        {"3<=2", 0},
        {"3>2", 1},
        {"2>2", 0},
        {"2>=2", 1},
        {"1>=2", 0},
        {"2==2", 1},
        {"2==1", 0},
        {"2!=1", 1},
        {"2!=2", 0},
        {"1+1==2", 1},
        {"3*(1<2)+1", 4},
        {"t+l*ld", 3 - 0.125},
        {"t*l-ld", 1.75},
        {"L*w^2/e", 2 * 0.05 * 0.05 / 7},
        {"_k1", -3},
        {"90*deg", 3.14159265358979323846 / 2},
        {"\t 2 *\n3\r\n", 6},
        {"sin (\t0 )+ cos\n(0)", 1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        int before = check_failures;
        CHECK_NEAR(value_at(rows[k].text, 3.0), rows[k].value, 1e-15);
        if (check_failures > before) {
            fprintf(stderr, "    in %s\n", rows[k].text);
        }
    }
}

static void numbers_are_rounded_correctly(void)
{
    CHECK(value_at("1", 0) == 1.0);
    CHECK(value_at(".5", 0) == 0.5);
    CHECK(value_at("5.", 0) == 5.0);
    CHECK(value_at("1e-3", 0) == 1e-3);
    CHECK(value_at("1E+3", 0) == 1e3);
    CHECK(value_at("0.1", 0) == 0.1);
    CHECK(value_at("9007199254740993", 0) == 9007199254740992.0);
    CHECK(value_at("2.2250738585072011e-308", 0) == 2.2250738585072011e-308);
    CHECK(value_at("1.7976931348623157e308", 0) == 1.7976931348623157e308);
    CHECK(value_at("1e-400", 0) == 0.0);
    CHECK(value_at("pi", 0) == 3.14159265358979323846);
    CHECK(value_at("123456.789e-2", 0) == 1234.56789);
}

static void numbers_are_read_alike_in_a_locale_with_decimal_commas(void)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    int found = 0;
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !found; ++k) {
        found = setlocale(LC_NUMERIC, names[k]) && localeconv()->decimal_point[0] == ',';
    }
    printf("locale with a decimal comma: %s\n", found ? "tested" : "none installed");
    CHECK(value_at("1.5 + .25", 0) == 1.75);
    CHECK(value_at("max(1,5)", 0) == 5.0);
    setlocale(LC_NUMERIC, "C");
}

static void every_function_has_its_value(void)
{
    CHECK_NEAR(value_at("if(t>1,10,20)", 2), 10, 0);
    CHECK_NEAR(value_at("if(t>1,10,20)", 1), 20, 0);
    CHECK_NEAR(value_at("if(t,10,20)", -0.1), 10, 0);
    CHECK_NEAR(value_at("min(4,t,3,9)", 7), 3, 0);
    CHECK_NEAR(value_at("max(4,t,3,9)", 7), 9, 0);
    CHECK_NEAR(value_at("max(t,4)", 7), 7, 0);
    CHECK_NEAR(value_at("log10(1000)", 0), 3, 1e-15);
    CHECK_NEAR(value_at("atan2(1,-1)", 0), 3 * atan(1.0), 1e-15);
    CHECK_NEAR(value_at("hypot(3,4)", 0), 5, 0);
    CHECK_NEAR(value_at("mod(7,3)", 0), 1, 0);
    CHECK_NEAR(value_at("mod(-7,3)", 0), 2, 0);
    CHECK_NEAR(value_at("mod(7,-3)", 0), -2, 0);
    CHECK_NEAR(value_at("mod(-6,3)", 0), 0, 0);
    CHECK_NEAR(value_at("mod(t,2.5)", 11), 1, 0);
    CHECK_NEAR(value_at("floor(t)", -1.5), -2, 0);
    CHECK_NEAR(value_at("ceil(t)", -1.5), -1, 0);
    CHECK_NEAR(value_at("round(t)", -1.5), -2, 0);
    CHECK_NEAR(value_at("round(t)", 2.4), 2, 0);
    CHECK_NEAR(value_at("sign(t)", -3), -1, 0);
    CHECK_NEAR(value_at("sign(t)", 0), 0, 0);
    CHECK_NEAR(value_at("sign(t)", 3), 1, 0);
    CHECK_NEAR(value_at("step(t,1,10,3,20)", 0.5), 10, 0);
    CHECK_NEAR(value_at("step(t,1,10,3,20)", 2), 15, 0);
    CHECK_NEAR(value_at("step(t,1,10,3,20)", 1.5), 10 + 10 * (3.0 / 16 - 2.0 / 64), 1e-14);
    CHECK(value_at("step(t,1,0.1,3,0.3)", 3) == 0.3);
    CHECK_NEAR(value_at("step(t,3,20,1,10)", 1.5), 10 + 10 * (3.0 / 16 - 2.0 / 64), 1e-14);
}

/* ---- derivatives ----------------------------------------------------------------------------*/

/* One argument u = t^2 - 3 t + c exercises both terms of f'' = g'' u'^2 + g' u''. */
static void check_composed(const char *name, double t, double c, const double g[3])
{
    char text[64];
    double u1 = 2 * t - 3, u2 = 2;
    snprintf(text, sizeof text, "%s(t^2-3*t+%.17g)", name, c);
    check_jet(text, t, g[0], g[1] * u1, g[2] * u1 * u1 + g[1] * u2);
}

static void every_function_has_its_closed_form_derivatives(void)
{
    const double t = 0.75, u0 = t * t - 3 * t;
    const double u = 0.375, c = u - u0, s = sqrt(1 - u * u);
    const double q = 1 + u * u, ta = tan(u), th = tanh(u), ln10 = log(10.0);
    check_composed("sqrt", t, c, (double[]){sqrt(u), 0.5 / sqrt(u), -0.25 / (u * sqrt(u))});
    check_composed("exp", t, c, (double[]){exp(u), exp(u), exp(u)});
    check_composed("log", t, c, (double[]){log(u), 1 / u, -1 / u / u});
    check_composed("log10", t, c, (double[]){log(u) / ln10, 1 / u / ln10, -1 / u / u / ln10});
    check_composed("sin", t, c, (double[]){sin(u), cos(u), -sin(u)});
    check_composed("cos", t, c, (double[]){cos(u), -sin(u), -cos(u)});
    check_composed("tan", t, c, (double[]){ta, 1 + ta * ta, 2 * ta * (1 + ta * ta)});
    check_composed("asin", t, c, (double[]){asin(u), 1 / s, u / (s * s * s)});
    check_composed("acos", t, c, (double[]){acos(u), -1 / s, -u / (s * s * s)});
    check_composed("atan", t, c, (double[]){atan(u), 1 / q, -2 * u / q / q});
    check_composed("sinh", t, c, (double[]){sinh(u), cosh(u), sinh(u)});
    check_composed("cosh", t, c, (double[]){cosh(u), sinh(u), cosh(u)});
    check_composed("tanh", t, c, (double[]){th, 1 - th * th, -2 * th * (1 - th * th)});
    check_composed("abs", t, c, (double[]){u, 1, 0});
    check_composed("abs", t, -u - u0, (double[]){u, -1, 0});
    check_composed("floor", t, c, (double[]){0, 0, 0});
    check_composed("ceil", t, c, (double[]){1, 0, 0});
    check_composed("round", t, c, (double[]){0, 0, 0});
    check_composed("sign", t, c, (double[]){1, 0, 0});
    check_jet("tanh(30*t)", 1, 1, 0, 0);
}

static void functions_of_two_arguments_have_their_closed_form_derivatives(void)
{
    const double t = 0.7;
    /* On the spiral (exp(t) cos t, exp(t) sin t) the angle is t and the radius exp(t). */
    check_jet("atan2(exp(t)*sin(t), exp(t)*cos(t))", t, t, 1, 0);
    check_jet("hypot(exp(t)*sin(t), exp(t)*cos(t))", t, exp(t), exp(t), exp(t));
    check_jet("atan2(3, t)", t, atan2(3, t), -3 / (9 + t * t), 6 * t / pow(9 + t * t, 2));
    check_jet("atan2(t, 3)", t, atan2(t, 3), 3 / (9 + t * t), -6 * t / pow(9 + t * t, 2));
    check_jet("hypot(t, 3)", t, sqrt(9 + t * t), t / sqrt(9 + t * t), 9 / pow(9 + t * t, 1.5));
    check_jet("hypot(3, t)", t, sqrt(9 + t * t), t / sqrt(9 + t * t), 9 / pow(9 + t * t, 1.5));
    double f = pow(t, t), g = log(t) + 1;
    check_jet("t^t", t, f, f * g, f * (g * g + 1 / t));
    check_jet("2^t", t, pow(2, t), pow(2, t) * log(2), pow(2, t) * log(2) * log(2));
    check_jet("t^2.5", t, pow(t, 2.5), 2.5 * pow(t, 1.5), 3.75 * pow(t, 0.5));
    check_jet("mod(t^2, 0.2)", t, 0.09, 2 * t, 2);
    check_jet("mod(3, t)", t, 3 - 4 * t, -4, 0);
    check_jet("min(t^2, t^3)", t, t * t * t, 3 * t * t, 6 * t);
    check_jet("max(t^2, t^3)", t, t * t, 2 * t, 2);
    check_jet("t^2 < t^3", t, 0, 0, 0);
    check_jet("t*t^2", t, t * t * t, 3 * t * t, 6 * t);
    check_jet("1/t", t, 1 / t, -1 / t / t, 2 / t / t / t);
    /* t^3/(1+t) = t^2 - t + 1 - 1/(1+t) */
    check_jet("t^3/(1+t)", t, t * t * t / (1 + t), 2 * t - 1 + pow(1 + t, -2),
              2 - 2 * pow(1 + t, -3));
    check_jet("pi/4*cos(2*t)", t, atan(1) * cos(2 * t), -2 * atan(1) * sin(2 * t),
              -4 * atan(1) * cos(2 * t));
}

static void a_step_is_a_cubic_with_all_its_arguments_differentiated(void)
{
    double u = 0.25; /* of step(t, 1, 10, 3, 20) at t = 1.5 */
    check_jet("step(t, 1, 10, 3, 20)", 1.5, 10 + 10 * u * u * (3 - 2 * u), 30 * u * (1 - u),
              15 * (1 - 2 * u));
    check_jet("step(t, 1, 10, 3, 20)", 1, 10, 0, 0);
    check_jet("step(t, 1, 10, 3, 20)", 3, 20, 0, 0);
    check_jet("step(t, 1, t^2, 3, 20)", 0.5, 0.25, 1, 2);
    check_jet("step(t, 1, 10, 6*l, 20)", 3, 20, 0, 0);
    check_jet("step(t, 1, 10, l, 20)", 2, 10, 0, 0); /* l = 0.5: downwards */
    check_jet("step(t, 1, 10, 3, t^3)", 4, 64, 48, 24);
    /* All five arguments move: against the same cubic written out. */
    static const char *const written =
        "sin(t) + (cos(t)-sin(t))*(3*((t^2-t/5)/(2+t-t/5))^2 - 2*((t^2-t/5)/(2+t-t/5))^3)";
    double jet[3], x[3] = {0.9, 0, 0}, g[3], h[3], f;
    CHECK(jet_at(written, 0.9, jet) == SE3D_OK);
    check_jet("step(t^2, t/5, sin(t), 2+t, cos(t))", 0.9, jet[0], jet[1], jet[2]);
    se3d_expression *a = compile("step(t^2+l, l*ld, sin(t), 2+ld, l+ld)");
    se3d_expression *b = compile("sin(t) + (l+ld-sin(t))*(3*((t^2+l-l*ld)/(2+ld-l*ld))^2 - "
                                 "2*((t^2+l-l*ld)/(2+ld-l*ld))^3)");
    x[1] = 0.3;
    x[2] = 0.4;
    CHECK(se3d_expression_eval_gradient(a, x, &f, g) == SE3D_OK);
    CHECK(se3d_expression_eval_gradient(b, x, &f, h) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(g[k], h[k], 1e-14);
        CHECK(fabs(g[k]) > 0.01);
    }
    se3d_expression_destroy(a);
    se3d_expression_destroy(b);
}

static void gradients_are_exact_in_all_variables(void)
{
    double x[3] = {0.5, 1.25, -2.0}, f, g[3];
    se3d_expression *e = compile("t^2*l + sin(l)/ld - 3*hypot(t, ld) + atan2(l, ld)*mod(l, ld)");
    double h = hypot(0.5, 2.0), r2 = 1.25 * 1.25 + 4, m = -0.75, angle = atan2(1.25, -2.0);
    CHECK(se3d_expression_eval_gradient(e, x, &f, g) == SE3D_OK);
    CHECK_NEAR(f, 0.25 * 1.25 - sin(1.25) / 2 - 3 * h + angle * m, 1e-14);
    CHECK_NEAR(g[0], 2 * 0.5 * 1.25 - 3 * 0.5 / h, 1e-14);
    CHECK_NEAR(g[1], 0.25 - cos(1.25) / 2 + angle - 2.0 / r2 * m, 1e-14);
    CHECK_NEAR(g[2], -sin(1.25) / 4 + 3 * 2.0 / h - 1.25 / r2 * m + angle, 1e-14);
    se3d_expression_destroy(e);
}

static void gradients_of_a_choice_are_those_of_the_argument_chosen(void)
{
    double x[3] = {2.0, 3.0, 5.0}, f, g[3];
    se3d_expression *e = compile("max(t*l, l*ld, t) - min(7*t, 3*ld, t*t) + if(t > l, t, l^3)");
    CHECK(se3d_expression_eval_gradient(e, x, &f, g) == SE3D_OK);
    CHECK_NEAR(f, 15 - 4 + 27, 0);
    CHECK_NEAR(g[0], -4, 0);
    CHECK_NEAR(g[1], 5 + 27, 0);
    CHECK_NEAR(g[2], 3, 0);
    se3d_expression_destroy(e);
}

static void four_variables_have_four_derivatives(void)
{
    static const char *const four[] = {"a", "b", "c", "d"};
    se3d_expression_def def = define("3 + a*b - c/d + 2*(a + d^2)");
    def.variables = four;
    def.variable_count = 4;
    se3d_expression *e = NULL;
    double x[4] = {2, 3, 5, 0.5}, f, g[5] = {0, 0, 0, 0, 99};
    CHECK(se3d_expression_create(&def, &e, NULL) == SE3D_OK);
    CHECK(se3d_expression_eval_gradient(e, x, &f, g) == SE3D_OK);
    CHECK_NEAR(f, 3.5, 1e-15);
    CHECK_NEAR(g[0], 5, 1e-15);
    CHECK_NEAR(g[1], 2, 1e-15);
    CHECK_NEAR(g[2], -2, 1e-15);
    CHECK_NEAR(g[3], 22, 1e-15);
    CHECK(g[4] == 99.0);
    se3d_expression_destroy(e);
}

static void integer_powers_are_exact_at_zero_and_below(void)
{
    check_jet("t^2", 0, 0, 0, 2);
    check_jet("t^2", -3, 9, -6, 2);
    check_jet("t^1", 0, 0, 1, 0);
    check_jet("t^0", 0, 1, 0, 0);
    check_jet("t^3", 0, 0, 0, 0);
    check_jet("t^3", -2, -8, 12, -12);
    check_jet("t^4", -2, 16, -32, 48);
    check_jet("t^5", -2, -32, 80, -160);
    check_jet("t^5", 0, 0, 0, 0);
    check_jet("t^(1+1)", -3, 9, -6, 2);
    check_jet("t^-1", -2, -0.5, -0.25, -0.25);
    check_jet("t^-2", 2, 0.25, -0.25, 0.375);
    check_jet("t^2.5", 0, 0, 0, 0);
    check_jet("t^(2+0*l)", 0, 0, 0, 2);
    check_jet("t^(1+0*l)", 0, 0, 1, 0);
    check_jet("(t-l)^(3*l+0.5)", 0.5, 0, 0, 2);
    CHECK(value_at("(-8)^3", 0) == -512.0);
    CHECK(value_at("(-2)^(6*l)", 0) == -8.0);
    double jet[3];
    CHECK(jet_at("t^0.5", 0, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet[0] == 0.0);
    CHECK(jet_at("t^0.5", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("t^-1", 0, jet) == SE3D_ERR_NOT_FINITE);
}

static void kinks_follow_the_documented_conventions(void)
{
    double jet[3];
    check_jet("abs(t)", 0, 0, 1, 0); /* rates in time are those from there on */
    check_jet("abs(-t)", 0, 0, 1, 0);
    check_jet("abs(3*t - t^2)", 0, 0, 3, -2);
    check_jet("abs(-t^2)", 0, 0, 0, 2);
    check_jet("sign(t)", 0, 0, 0, 0);
    check_jet("hypot(t, 0)", 0, 0, 0, 0);
    check_jet("min(t, 2*t)", 0, 0, 1, 0);
    check_jet("min(2*t, t)", 0, 0, 1, 0);
    check_jet("max(t, 2*t)", 0, 0, 2, 0);
    check_jet("max(t, t + t^2)", 0, 0, 1, 2);
    check_jet("max(2*t, t)", 0, 0, 2, 0);
    check_jet("mod(t, 2)", 4, 0, 1, 0);
    check_jet("floor(t)", 4, 4, 0, 0);
    check_jet("max(1, sqrt(t))", 0, 1, 0, 0); /* the other's infinite derivative stays out */
    CHECK(jet_at("sqrt(t)", 0, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet[0] == 0.0 && isinf(jet[1]));
    CHECK(jet_at("asin(t)", 1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("log(t)", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("1/t", 0, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("atan2(t, 0*t)", 0, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("step(t, t, 0, t, 1)", 0.5, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("exp(t)", 1000, jet) == SE3D_ERR_NOT_FINITE);
}

static void singular_derivatives_along_other_variables_do_not_matter(void)
{
    double x[3] = {2.0, 0.0, 1.0}, jet[3], f, g[3];
    se3d_expression *e = compile("t^2 + sqrt(l) + l^0.5 + hypot(sqrt(l), ld) + l^ld");
    CHECK(se3d_expression_eval_time(e, x, jet) == SE3D_OK);
    CHECK_NEAR(jet[0], 5, 0);
    CHECK_NEAR(jet[1], 4, 0);
    CHECK_NEAR(jet[2], 2, 0);
    CHECK(se3d_expression_eval_gradient(e, x, &f, g) == SE3D_ERR_NOT_FINITE);
    CHECK(g[0] == 4.0 && !isfinite(g[1]));
    se3d_expression_destroy(e);
}

static void only_the_branch_taken_counts(void)
{
    double jet[3];
    check_jet("if(t > 0, sqrt(t), 0)", 0, 0, 0, 0);
    check_jet("if(t == 0, 1, sin(t)/t)", 0, 1, 0, 0);
    check_jet("1 + if(t < 0, 1/(t-t), t^2)*2", 3, 19, 12, 4);
    check_jet("if(t < 1, if(t < 0, 1, 2), if(t < 2, t^2, 4)) + t", 1.5, 3.75, 4, 2);
    check_jet("if(zero != 0, 1/zero, 5*t)", 1, 5, 5, 0); /* dropped when compiled */
    check_jet("if(zero == 0, 5*t, log(zero)+1/zero)", 1, 5, 5, 0);
    check_jet("t*if(1, t, 0)", 3, 9, 6, 2);
    check_jet("if(0, step(1,2,3,2,4)/0, 1)", 3, 1, 0, 0);
    CHECK(jet_at("if(sqrt(t) > 1, 1, 2)", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(isnan(jet[0]) && isnan(jet[1]) && isnan(jet[2]));
    CHECK(jet_at("if(1 > sqrt(t), 1, 2)", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("min(1, sqrt(t))", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("max(sqrt(t), 1)", -1, jet) == SE3D_ERR_NOT_FINITE);
    CHECK(jet_at("sign(sqrt(t))", -1, jet) == SE3D_ERR_NOT_FINITE);
}

static void check_all(const char *const *texts, size_t count, int (*holds)(const se3d_expression *),
                      int expected)
{
    for (size_t k = 0; k < count; ++k) {
        se3d_expression *e = compile(texts[k]);
        CHECK(holds(e) == expected);
        se3d_expression_destroy(e);
    }
}

static void what_may_have_kinks_is_known(void)
{
    static const char *const smooth[] = {"3", "pi/4*cos(2*t)", "t^3 - 2*t/(1 + t)",
                                         "exp(-t)*tanh(1e4*t)"};
    static const char *const kinked[] = {"abs(t)",        "sqrt(t^2)",       "(t^2)^0.5",
                                         "if(t<1,0,t-1)", "max(t, 1)",       "mod(t, 1)",
                                         "acos(cos(t))",  "step(t,0,2,3,4)", "hypot(t, L-2)"};
    check_all(smooth, sizeof smooth / sizeof *smooth, se3di_expression_is_smooth, 1);
    check_all(kinked, sizeof kinked / sizeof *kinked, se3di_expression_is_smooth, 0);
}

static void what_may_jump_is_known(void)
{
    static const char *const continuous[] = {
        "3",          "abs(t) + sqrt(t)^1.5",  "if(1 < 2, t, 0)", "max(t, 1, min(l, 2))",
        "hypot(t,l)", "step(t, 0, 2, 3, 4)/l", "atan2(t, l)"};
    static const char *const jumping[] = {"if(t<1,0,t-1)", "mod(t, 1)", "floor(t)", "ceil(2*t)",
                                          "sign(t)",       "round(t)",  "t < 1",    "(t != 2)*l"};
    check_all(continuous, sizeof continuous / sizeof *continuous, se3di_expression_is_continuous,
              1);
    check_all(jumping, sizeof jumping / sizeof *jumping, se3di_expression_is_continuous, 0);
}

static void what_may_not_be_finite_is_known(void)
{
    static const char *const total[] = {"3",
                                        "pi/4*cos(2*t)",
                                        "t^3 - 2*t",
                                        "if(t<1,0,t-1)",
                                        "max(abs(t), floor(2*t))",
                                        "2*pi*t/20",
                                        "0.06*step(t, 0.2, 0, 0.25, 1)",
                                        "step(t, 1, 3, 0, 2)/3",
                                        "(t-1)/(1-3)"};
    static const char *const partial[] = {"1/t",
                                          "sqrt(1-t)",
                                          "t^-1",
                                          "log(t)",
                                          "tan(t)",
                                          "exp(t)",
                                          "t/1e-200",
                                          "1/if(t<1,t,2)",
                                          "step(t, 0, 0, t, 1)",
                                          "step(1, t, 0, 2, 1)",
                                          "step(t, t, 0, 1, 2)/2"};
    check_all(total, sizeof total / sizeof *total, se3di_expression_is_total, 1);
    check_all(partial, sizeof partial / sizeof *partial, se3di_expression_is_total, 0);
}

static void constants_are_folded(void)
{
    static const struct {
        const char *text;
        int constant;
    } rows[] = {{"3", 1},
                {"L*2+sin(pi/4)", 1},
                {"-e^2", 1},
                {"step(1,0,2,3,4)", 1},
                {"min(1,2,3)<4", 1},
                {"if(L==2,1,t)", 1},
                {"if(L!=2,1,t)", 0},
                {"t", 0},
                {"2+t", 0},
                {"if(t,1,2)", 0}};
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        se3d_expression *e = compile(rows[k].text);
        CHECK(se3d_expression_is_constant(e) == rows[k].constant);
        CHECK(strcmp(se3d_expression_get_text(e), rows[k].text) == 0);
        se3d_expression_destroy(e);
    }
    se3d_expression_def def = define("2*L");
    def.variables = NULL;
    def.variable_count = 0;
    se3d_expression *e = NULL;
    double jet[3], f = 0;
    CHECK(se3d_expression_create(&def, &e, NULL) == SE3D_OK);
    CHECK(se3d_expression_eval_time(e, NULL, jet) == SE3D_OK);
    CHECK(jet[0] == 4.0 && jet[1] == 0.0 && jet[2] == 0.0);
    CHECK(se3d_expression_eval_gradient(e, NULL, &f, NULL) == SE3D_OK && f == 4.0);
    se3d_expression_destroy(e);
}

/* ---- messages -------------------------------------------------------------------------------*/

static void every_bad_text_is_named_with_its_column(void)
{
    static const struct {
        const char *text;
        size_t column;
        const char *message;
    } rows[] = {
        {"", 1, "empty"},
        {"  \t", 1, "empty"},
        {"1 +", 4, "the end of the text"},
        {"1 + * 2", 5, "'*', expected a number"},
        {"2 t", 3, "unexpected 't', expected an operator"},
        {"(1 + 2", 7, "expected an operator or ')'"},
        {"1 + 2)", 6, "no '(' is open"},
        {"()", 2, "unexpected ')'"},
        {"sin", 1, "'sin' is a function, expected sin(x)"},
        {"1+sin()", 3, "sin(x) takes 1 argument, found 0"},
        {"sin(1, 2)", 1, "takes 1 argument, found 2"},
        {"atan2(t)", 1, "atan2(y, x) takes 2 arguments, found 1"},
        {"min(t)", 1, "takes at least 2 arguments, found 1"},
        {"step(t,1,2,3)", 1, "takes 5 arguments, found 4"},
        {"step(t,1,2,3,4,5)", 1, "takes 5 arguments, found 6"},
        {"step(t,1,2,1,4)", 1, "'step' is not finite"},
        {"if(t)", 1, "takes 3 arguments, found 1"},
        {"if(t, 1)", 1, "takes 3 arguments, found 2"},
        {"if(t, 1, 2, 3)", 1, "takes 3 arguments, found 4"},
        {"if(t 1, 2)", 6, "unexpected '1'"},
        {"sin(t", 6, "expected an operator, ',' or ')'"},
        {"2*sinn(t)", 3, "unknown function 'sinn', did you mean 'sin'?"},
        {"2*Sin(t)", 3, "did you mean 'sin'?"},
        {"2*rh", 3, "unknown name 'rh', did you mean 'rho'?"},
        {"PI", 1, "did you mean 'pi'?"},
        {"3*qqqq", 3, "allowed are t, l, ld, the parameters, pi, deg"},
        {"qqqqqqq(1)", 1, "unknown function 'qqqqqqq'; allowed are if min max"},
        {"L(3)", 2, "'L' is not a function"},
        {"1 $ 2", 3, "unexpected character '$'"},
        {"[1]", 1, "unexpected character '['"},
        {"1 \x7F", 3, "unexpected byte 0x7F"},
        {"1 \xE2\x28", 3, "unexpected byte 0xE2"},
        {"1 \xF0\x9F\x98\x80", 3, "unexpected character '\xF0\x9F\x98\x80'"},
        {"1 \xF8", 3, "unexpected byte 0xF8"},
        {"1234567890123456789012345678901234567890123e", 1,
         "exponent of '1234567890123456789012345678901234567890' has no digits"},
        {"1234567890123456789012345678901234567890123e999", 1,
         "number '1234567890123456789012345678901234567890' is too large"},
        {"1 \xC3\x97 2", 3, "unexpected character '\xC3\x97'"},
        {"1 \xFF 2", 3, "unexpected byte 0xFF"},
        {"1 \x01", 3, "unexpected byte 0x01"},
        {"t = 2", 3, "did you mean '=='"},
        {"!t", 1, "did you mean '!='"},
        {"1 < t < 2", 7, "parentheses around"},
        {"t ** 2", 4, "unexpected '*'"},
        {"1 + .", 5, "'.' without digits"},
        {"2e", 1, "the exponent of '2e' has no digits"},
        {"1 + 3e+", 5, "has no digits"},
        {"1.2.3", 4, "unexpected '.3'"},
        {"0x10", 2, "unexpected 'x10'"},
        {"1+1e999", 3, "'1e999' is too large"},
        {"1/0", 2, "'/' is not finite: division by zero"},
        {"t/(1-1)", 2, "division by zero"},
        {"1 + log(0)", 5, "'log' is not finite"},
        {"sqrt(-1)", 1, "'sqrt' is not finite"},
        {"2*(-8)^0.5", 7, "'^' is not finite"},
        {"1e308*10", 6, "'*' is not finite"},
        {"if(0, foo, 1)", 7, "unknown name 'foo'"},
        {"inf", 1, "did you mean"},
        {"t,l", 2, "unexpected ','"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        int before = check_failures;
        se3d_expression_def def = define(rows[k].text);
        se3d_expression_error error = {0};
        se3d_expression *e = (se3d_expression *)&def;
        CHECK(se3d_expression_create(&def, &e, &error) == SE3D_ERR_EXPRESSION);
        CHECK(e == NULL);
        CHECK(error.column == rows[k].column);
        CHECK_CONTAINS(error.message, rows[k].message);
        CHECK(se3d_expression_create(&def, &e, NULL) == SE3D_ERR_EXPRESSION);
        if (check_failures > before) {
            fprintf(stderr, "    %s:%zu: %s\n", rows[k].text, error.column, error.message);
        }
    }
}

/* `open` n times, then `middle`, then `close` n times. */
static char *nest(const char *open, const char *middle, const char *close, size_t n)
{
    size_t size = n * (strlen(open) + strlen(close)) + strlen(middle) + 1;
    char *text = malloc(size), *at = text;
    for (size_t k = 0; k < n; ++k) {
        at += snprintf(at, size - (size_t)(at - text), "%s", open);
    }
    at += snprintf(at, size - (size_t)(at - text), "%s", middle);
    for (size_t k = 0; k < n; ++k) {
        at += snprintf(at, size - (size_t)(at - text), "%s", close);
    }
    return text;
}

static se3d_status try_text(const char *text, se3d_expression_error *error)
{
    se3d_expression_def def = define(text);
    se3d_expression *e = NULL;
    se3d_status status = se3d_expression_create(&def, &e, error);
    if (e) {
        double x[3] = {0.5, 0.25, 2.0}, jet[3], f, g[3];
        se3d_status a = se3d_expression_eval_time(e, x, jet);
        se3d_status b = se3d_expression_eval_gradient(e, x, &f, g);
        CHECK(a == SE3D_OK || a == SE3D_ERR_NOT_FINITE);
        CHECK(b == SE3D_OK || b == SE3D_ERR_NOT_FINITE);
        CHECK(memcmp(&jet[0], &f, sizeof f) == 0 || (isnan(f) && isnan(jet[0])));
    }
    se3d_expression_destroy(e);
    return status;
}

static void check_nesting(const char *open, const char *close, size_t levels, se3d_status expected,
                          const char *message)
{
    se3d_expression_error error = {0};
    char *text = nest(open, "t", close, levels);
    CHECK(try_text(text, &error) == expected);
    CHECK_CONTAINS(error.message, message);
    free(text);
}

static void limits_are_kept(void)
{
    check_nesting("(", ")", 64, SE3D_OK, "");
    check_nesting("(", ")", 65, SE3D_ERR_EXPRESSION, "nested too deeply, at most 64");
    check_nesting("sin(", ")", 64, SE3D_OK, "");
    check_nesting("sin(", ")", 65, SE3D_ERR_EXPRESSION, "nested too deeply");
    check_nesting("t^", "", 64, SE3D_OK, "");
    check_nesting("t^", "", 65, SE3D_ERR_EXPRESSION, "nested too deeply");
    check_nesting("if(t,1,", ")", 65, SE3D_ERR_EXPRESSION, "nested too deeply");
    check_nesting("t+t*(", ")", 63, SE3D_OK, "");
    check_nesting("t<t+t*(", ")", 64, SE3D_ERR_EXPRESSION, "more than 128 operands");
    check_nesting("-", "", 4000, SE3D_OK, "");
    check_nesting("t+", "", 2047, SE3D_OK, "");
    check_nesting("t+", "", 2048, SE3D_ERR_EXPRESSION, "longer than 4096");
    se3d_expression_error error = {0};
    char *text = nest("t<t+t*(", "t+t", ")", 42); /* 3*42 + 2 = 128 values */
    CHECK(try_text(text, &error) == SE3D_OK);
    free(text);
    text = nest("t<t+t*(", "t+t*t", ")", 42);
    CHECK(try_text(text, &error) == SE3D_ERR_EXPRESSION);
    CHECK_CONTAINS(error.message, "more than 128 operands");
    free(text);
    text = nest("1", "", "", 600);
    CHECK(try_text(text, &error) == SE3D_ERR_EXPRESSION);
    CHECK_CONTAINS(error.message, "number of 600 characters");
    free(text);
    text = nest("min(t,", "t", ")", 60); /* as many arguments as fit */
    CHECK(try_text(text, &error) == SE3D_OK);
    free(text);
    char many[1300] = "min(t";
    for (int k = 0; k < 600; ++k) {
        strcat(many, ",t");
    }
    CHECK(try_text(strcat(many, ")"), &error) == SE3D_OK);
    char name[100] = ""; /* too long for a guess */
    text = nest("a", "", "", 70);
    snprintf(name, sizeof name, "%s", text);
    CHECK(try_text(name, &error) == SE3D_ERR_EXPRESSION);
    CHECK(!strstr(error.message, "did you mean"));
    const se3d_expression_symbol symbol = {name, 1.0};
    se3d_expression_def def = define("zzzzz");
    se3d_expression *e = NULL;
    def.symbols = &symbol;
    def.symbol_count = 1;
    CHECK(se3d_expression_create(&def, &e, &error) == SE3D_ERR_EXPRESSION);
    CHECK(!strstr(error.message, "did you mean"));
    free(text);
}

/* ---- misuse ---------------------------------------------------------------------------------*/

static void check_definition(se3d_expression_def def, se3d_status expected, const char *message)
{
    se3d_expression_error error = {.column = 9};
    se3d_expression *e = (se3d_expression *)&def;
    CHECK(se3d_expression_create(&def, &e, &error) == expected);
    CHECK(e == NULL);
    CHECK(error.column == 0);
    CHECK_CONTAINS(error.message, message);
}

static void bad_variables_are_rejected(void)
{
    static const char *const seventeen[] = {"a", "b", "c", "d", "f", "g", "h", "i", "j",
                                            "k", "l", "m", "n", "o", "p", "q", "r"};
    static const char *const twice[] = {"a", "b", "a"};
    static const char *const reserved[] = {"t", "step", "x"};
    static const char *const empty[] = {"t", "", NULL};
    se3d_expression_def def = define("1");
    def.symbol_count = 0;
    def.variables = seventeen;
    def.variable_count = 17;
    check_definition(def, SE3D_ERR_INVALID_ARGUMENT, "17 variables, at most 16");
    def.variables = NULL;
    def.variable_count = 1;
    check_definition(def, SE3D_ERR_NULL, "list of variables");
    def.variable_count = 3;
    def.variables = twice;
    check_definition(def, SE3D_ERR_INVALID_ARGUMENT, "two variables are called 'a'");
    def.variables = reserved;
    check_definition(def, SE3D_ERR_INVALID_ARGUMENT, "variable 'step': the name is reserved");
    def.variables = empty;
    check_definition(def, SE3D_ERR_INVALID_ARGUMENT, "letters, digits");
    def.variables = &empty[2];
    def.variable_count = 1;
    check_definition(def, SE3D_ERR_NULL, "name of a variable");
}

static void check_symbol(const char *name, double value, se3d_status expected, const char *message)
{
    se3d_expression_symbol symbol = {name, value};
    se3d_expression_def def = define("1");
    def.symbols = &symbol;
    def.symbol_count = 1;
    check_definition(def, expected, message);
}

static void bad_definitions_are_rejected(void)
{
    check_symbol("pi", 3, SE3D_ERR_INVALID_ARGUMENT, "symbol 'pi': the name is reserved");
    check_symbol("deg", 3, SE3D_ERR_INVALID_ARGUMENT, "symbol 'deg': the name is reserved");
    check_symbol("if", 3, SE3D_ERR_INVALID_ARGUMENT, "reserved");
    check_symbol("t", 3, SE3D_ERR_INVALID_ARGUMENT, "'t': a variable has this name");
    check_symbol("2a", 3, SE3D_ERR_INVALID_ARGUMENT, "letters, digits");
    check_symbol("a-b", 3, SE3D_ERR_INVALID_ARGUMENT, "'a-b'");
    check_symbol("^", 3, SE3D_ERR_INVALID_ARGUMENT, "letters, digits");
    check_symbol(NULL, 3, SE3D_ERR_NULL, "name of a symbol");
    check_symbol("a", (double)NAN, SE3D_ERR_INVALID_ARGUMENT, "must be finite");
    check_symbol("a", (double)INFINITY, SE3D_ERR_INVALID_ARGUMENT, "must be finite");
    se3d_expression_def def = define(NULL);
    check_definition(def, SE3D_ERR_NULL, "text is NULL");
    def = define("1");
    def.symbols = NULL;
    check_definition(def, SE3D_ERR_NULL, "list of symbols");
    def = define("1");
    def.struct_size = 0;
    check_definition(def, SE3D_ERR_INVALID_ARGUMENT, "struct_size = 0");
    for (int k = 0; k < 3; ++k) {
        se3d_allocator allocator = se3di_alloc_default();
        allocator.alloc = k == 0 ? NULL : allocator.alloc;
        allocator.realloc = k == 1 ? NULL : allocator.realloc;
        allocator.free = k == 2 ? NULL : allocator.free;
        def = define("1");
        def.allocator = &allocator;
        check_definition(def, SE3D_ERR_NULL, "allocator");
    }
}

static void definitions_of_a_later_version_are_read_where_they_ask_nothing_new(void)
{
    struct {
        se3d_expression_def def;
        double later;
    } grown;
    se3d_expression_def_init(&grown.def, sizeof grown);
    CHECK(grown.def.struct_size == sizeof grown && grown.later == 0.0);
    grown.def.text = "2+3";
    se3d_expression *e = NULL;
    double f = 0;
    CHECK(se3d_expression_create(&grown.def, &e, NULL) == SE3D_OK);
    CHECK(se3d_expression_eval(e, NULL, &f) == SE3D_OK && f == 5.0);
    se3d_expression_destroy(e);
    grown.later = 1.0;
    CHECK(se3d_expression_create(&grown.def, &e, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_expression_def_init(NULL, 8);
}

static void null_and_non_finite_arguments_are_rejected(void)
{
    se3d_expression_def def = define("t");
    se3d_expression *e = NULL;
    se3d_expression_error error;
    CHECK(se3d_expression_create(NULL, &e, &error) == SE3D_ERR_NULL);
    CHECK_CONTAINS(error.message, "def is NULL");
    CHECK(se3d_expression_create(&def, NULL, &error) == SE3D_ERR_NULL);
    CHECK_CONTAINS(error.message, "out is NULL");
    CHECK(se3d_expression_create(NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_expression_create(&def, &e, &error) == SE3D_OK);
    CHECK(error.column == 0 && error.message[0] == '\0');
    double x[3] = {1, 2, 3}, v = 0, r[3];
    CHECK(se3d_expression_eval(NULL, x, &v) == SE3D_ERR_NULL && isnan(v));
    CHECK(se3d_expression_eval(e, NULL, &v) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval(e, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_time(NULL, x, r) == SE3D_ERR_NULL && isnan(r[2]));
    CHECK(se3d_expression_eval_time(e, NULL, r) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_time(e, x, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_gradient(NULL, x, &v, r) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_gradient(e, NULL, &v, r) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_gradient(e, x, NULL, r) == SE3D_ERR_NULL);
    CHECK(se3d_expression_eval_gradient(e, x, &v, NULL) == SE3D_ERR_NULL);
    x[2] = (double)NAN;
    v = 0;
    CHECK(se3d_expression_eval(e, x, &v) == SE3D_ERR_INVALID_ARGUMENT && isnan(v));
    CHECK(se3d_expression_eval_time(e, x, r) == SE3D_ERR_INVALID_ARGUMENT && isnan(r[0]));
    x[2] = (double)INFINITY;
    CHECK(se3d_expression_eval_gradient(e, x, &v, r) == SE3D_ERR_INVALID_ARGUMENT && isnan(r[1]));
    se3d_expression_destroy(e);
    se3d_expression_destroy(NULL);
    CHECK(se3d_expression_is_constant(NULL) == 0);
    CHECK(strcmp(se3d_expression_get_text(NULL), "") == 0);
}

/* ---- many variables, writing ------------------------------------------------------------------*/

static void derivatives_exist_for_as_many_variables_as_are_allowed(void)
{
    static const char *const many[] = {"t",  "x1", "x2", "x3", "x4", "x5", "x6", "x7",
                                       "x8", "x9", "xa", "xb", "xc", "xd", "xe", "xf"};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    double x[16], gradient[16], value = 0.0;
    def.text = "t*x1 + x2*x3 + x4*x5 + x6*x7 + x8*x9 + xa*xb + hypot(xc, 0)*xd + sin(xe)*xf^2";
    def.variables = many;
    def.variable_count = 16;
    for (int k = 0; k < 16; ++k) {
        x[k] = 0.5 + 0.1 * k;
    }
    CHECK(!se3d_expression_create(&def, &expression, NULL));
    CHECK(!se3d_expression_eval_gradient(expression, x, &value, gradient));
    for (int k = 0; k < 14; ++k) {
        CHECK_NEAR(gradient[k], x[k % 2 == 0 ? k + 1 : k - 1], 1e-15);
    }
    CHECK_NEAR(gradient[14], cos(x[14]) * x[15] * x[15], 1e-15);
    CHECK_NEAR(gradient[15], 2.0 * sin(x[14]) * x[15], 1e-15);
    se3d_expression_destroy(expression);
}

/* A text in standard form, and that of what is compiled from it. */
static void check_written(const char *text, const char *want)
{
    char first[512], second[512];
    size_t length = 0;
    const double x[3] = {0.75, 0.5, -0.25};
    double before[4], after[4];
    se3d_expression *expression = compile(text);
    CHECK(!se3d_expression_write(expression, variables, first, sizeof first, &length));
    CHECK(strlen(first) == length);
    se3d_expression *again = compile(first);
    CHECK(!se3d_expression_write(again, variables, second, sizeof second, &length));
    if (want && strcmp(first, want) != 0) {
        fprintf(stderr, "    %s is written as %s\n", text, first);
    }
    CHECK(!want || strcmp(first, want) == 0);
    CHECK(strcmp(first, second) == 0);
    CHECK(!se3d_expression_eval_gradient(expression, x, before, before + 1));
    CHECK(!se3d_expression_eval_gradient(again, x, after, after + 1));
    CHECK(memcmp(before, after, sizeof before) == 0);
    CHECK(!se3d_expression_eval_time(expression, x, before));
    CHECK(!se3d_expression_eval_time(again, x, after));
    CHECK(memcmp(before, after, 3 * sizeof *before) == 0);
    se3d_expression_destroy(expression);
    se3d_expression_destroy(again);
}

static void what_is_written_is_compiled_to_the_same(void)
{
    check_written("0.1", "0.1");
    check_written("-3", "-3");
    check_written("3e-300", "3e-300");
    check_written("123456789012345678", "1.2345678901234568e17");
    check_written("pi*L", "6.283185307179586");
    check_written("t", "t");
    check_written("L*t", "2*t");
    check_written("t*-L", "-2*t");
    check_written("-(t + l)", "-(t + l)");
    check_written("-t^2", "-t^2");
    check_written("(-t)^2", "(-t)^2");
    check_written("t^-2", "t^(-2)");
    check_written("2^t^l", "2^(t^l)");
    check_written("(2^t)^l", "(2^t)^l");
    check_written("t - (l - ld)", "t - (l - ld)");
    check_written("t - l - ld", "t - l - ld");
    check_written("t/(l*ld)", "t/(l*ld)");
    check_written("t/l*ld", "t/l*ld");
    check_written("t*(l/ld)", "t*(l/ld)");
    check_written("1 - t", "1 - t");
    check_written("t - 1", "t - 1");
    check_written("t + 1", "t + 1");
    check_written("1.5 + t", "t + 1.5");
    check_written("-2/t", "-2/t");
    check_written("t - L^l", "t - 2^l");
    check_written("3/t/2", "3/t/2");
    check_written("2*(3*t)", "2*(3*t)");
    check_written("3*(t*l)", "3*(t*l)");
    check_written("t + -3*l", "t + -3*l");
    check_written("-(-t)", "-(-t)");
    check_written("l - -t", "l - -t");
    check_written("min(t, l, ld, 3)", NULL);
    check_written("max(0, step(t, 0, 0, 1, 1)) + atan2(l, t)", NULL);
    check_written("if(t > 0.5, l^2, if(l <= 1, ld, -ld)) * 2", NULL);
    check_written("(t < l) + (t != 3)*l", NULL);
    check_written("sin(2*pi*t)*exp(-t/2) + abs(ld)^1.5", NULL);
    check_written("mod(t, 0.3) + hypot(l, ld) - sign(t)*floor(l)", NULL);
    char text[8];
    size_t length = 1;
    se3d_expression *e = compile("1/4"), *t = compile("t");
    CHECK(!se3d_expression_write(e, variables, text, sizeof text, &length) && length == 4);
    CHECK(se3d_expression_write(e, variables, text, sizeof text, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_expression_write(t, NULL, text, sizeof text, &length) == SE3D_ERR_NULL);
    CHECK(se3d_expression_write(NULL, NULL, text, sizeof text, &length) == SE3D_ERR_NULL);
    se3d_expression_destroy(e);
    se3d_expression_destroy(t);
    se3d_expression_def def = define("1/4"); /* without variables */
    def.variables = NULL;
    def.variable_count = 0;
    CHECK(!se3d_expression_create(&def, &e, NULL));
    CHECK(!se3d_expression_write(e, NULL, text, sizeof text, &length) && length == 4);
    CHECK(se3d_expression_write(e, NULL, text, 3, &length) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(length == 4 && strcmp(text, "0.") == 0); /* cut */
    CHECK(!se3d_expression_write(e, NULL, NULL, 3, &length) && length == 4);
    se3d_expression_destroy(e);
}

int main(void)
{
    RUN(operators_bind_as_in_mathematics);
    RUN(numbers_are_rounded_correctly);
    RUN(numbers_are_read_alike_in_a_locale_with_decimal_commas);
    RUN(every_function_has_its_value);
    RUN(every_function_has_its_closed_form_derivatives);
    RUN(functions_of_two_arguments_have_their_closed_form_derivatives);
    RUN(a_step_is_a_cubic_with_all_its_arguments_differentiated);
    RUN(gradients_are_exact_in_all_variables);
    RUN(gradients_of_a_choice_are_those_of_the_argument_chosen);
    RUN(four_variables_have_four_derivatives);
    RUN(integer_powers_are_exact_at_zero_and_below);
    RUN(kinks_follow_the_documented_conventions);
    RUN(singular_derivatives_along_other_variables_do_not_matter);
    RUN(only_the_branch_taken_counts);
    RUN(what_may_have_kinks_is_known);
    RUN(what_may_jump_is_known);
    RUN(what_may_not_be_finite_is_known);
    RUN(constants_are_folded);
    RUN(every_bad_text_is_named_with_its_column);
    RUN(limits_are_kept);
    RUN(bad_variables_are_rejected);
    RUN(bad_definitions_are_rejected);
    RUN(definitions_of_a_later_version_are_read_where_they_ask_nothing_new);
    RUN(null_and_non_finite_arguments_are_rejected);
    RUN(derivatives_exist_for_as_many_variables_as_are_allowed);
    RUN(what_is_written_is_compiled_to_the_same);
    return check_finish();
}
