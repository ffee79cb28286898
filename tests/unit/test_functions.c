/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions made of expressions that are compiled already. */
#include "check.h"
#include "se3d/se3d.h"

static se3d_expression *compile(const char *text, size_t count)
{
    static const char *const variables[] = {"t", "l", "ldot"};
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    def.text = text;
    def.variables = variables;
    def.variable_count = count;
    CHECK(se3d_expression_create(&def, &expression, NULL) == SE3D_OK);
    return expression;
}

static void a_compiled_expression_gives_what_its_text_gives(void)
{
    se3d_system *system = NULL;
    se3d_function from_text = {0, 0};
    se3d_function from_code = {0, 0};
    se3d_function_def def = se3d_function_def_default();
    double text[3];
    double code[3];
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_function_create_expression(system, "pi/4*cos(2*t)", &from_text) == SE3D_OK);
    se3d_expression *expression = compile("pi/4*cos(2*t)", 1);
    def.compiled = expression;
    CHECK(se3d_function_create(system, &def, &from_code) == SE3D_OK);
    se3d_expression_destroy(expression); /* the function has its own */
    for (double t = -1.0; t < 3.0; t += 0.37) {
        CHECK(se3d_function_eval(system, from_text, &t, text) == SE3D_OK);
        CHECK(se3d_function_eval(system, from_code, &t, code) == SE3D_OK);
        CHECK(memcmp(text, code, sizeof text) == 0);
    }
    se3d_system_destroy(system);
}

static void its_variables_must_be_those_of_the_function(void)
{
    se3d_system *system = NULL;
    se3d_function function = {1, 1};
    se3d_function_def def = se3d_function_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    se3d_expression *expression = compile("l*ldot", 3);
    def.compiled = expression;
    CHECK(se3d_function_create(system, &def, &function) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(function.index1 == 0);
    CHECK(strcmp(se3d_system_get_error_field(system), "compiled") == 0);
    CHECK_CONTAINS(se3d_system_get_error(system), "has 3 variables");
    def.variable_count = 3;
    CHECK(se3d_function_create(system, &def, &function) == SE3D_OK);
    def.expression = "t";
    CHECK(se3d_function_create(system, &def, &function) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "2 are given");
    se3d_expression_destroy(expression);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(a_compiled_expression_gives_what_its_text_gives);
    RUN(its_variables_must_be_those_of_the_function);
    return check_finish();
}
