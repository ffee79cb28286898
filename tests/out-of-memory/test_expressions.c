/* SPDX-License-Identifier: BSD-3-Clause */
/* Every allocation of an expression fails once, and from then on: it is reported, nothing leaks. */
#include "check.h"
#include "expression/expression.h"
#include "support/counting.h"

#include <string.h>

static const char *const variables[] = {"t", "l", "ld"};

static se3d_expression_def define(const char *text, const se3d_allocator *allocator)
{
    se3d_expression_def def = se3d_expression_def_default();
    def.text = text;
    def.variables = variables;
    def.variable_count = 3;
    def.allocator = allocator;
    return def;
}

static se3d_status create_and_clone(const char *text, support_counting *counting)
{
    const se3d_allocator allocator = support_counting_allocator(counting);
    const se3d_expression_def def = define(text, &allocator);
    se3d_expression *e = NULL, *copy = NULL;
    se3d_expression_error error;
    se3d_status status = se3d_expression_create(&def, &e, &error);
    if (status == SE3D_OK) {
        status = se3di_expression_clone(e, &allocator, &copy);
    } else {
        CHECK_CONTAINS(error.message, "out of memory");
    }
    CHECK(status == SE3D_OK || copy == NULL);
    se3d_expression_destroy(e);
    if (copy) {
        const size_t calls = counting->calls;
        const double x[3] = {0.5, 0.25, 0.125};
        double jet[3];
        CHECK(se3d_expression_eval_time(copy, x, jet) == SE3D_OK);
        CHECK(counting->calls == calls); /* evaluation allocates nothing */
        CHECK(strcmp(se3d_expression_get_text(copy), def.text) == 0);
        CHECK(se3di_expression_variable_count(copy) == 3);
        se3d_expression_destroy(copy);
    }
    return status;
}

/* @return how many allocations there are */
static size_t fail_each(const char *text)
{
    size_t k = 0;
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        se3d_status status = SE3D_ERR_NO_MEMORY;
        for (k = 1; status != SE3D_OK && k < 100; ++k) {
            support_counting counting = {.fail_at = k, .for_ever = for_ever};
            status = create_and_clone(text, &counting);
            CHECK(status == SE3D_OK || status == SE3D_ERR_NO_MEMORY);
            CHECK(counting.live == 0 && counting.wrong == 0);
        }
        CHECK(status == SE3D_OK);
    }
    return k;
}

static void every_failing_allocation_is_reported_and_nothing_leaks(void)
{
    CHECK(fail_each("if(t<1, sin(t)*l+2*t, t^2/ld) - step(t,l,ld,2,min(t,l,ld))"
                    "+ if(l, 1/t, hypot(t, atan2(l, ld)))") > 5);
}

/* Room is made in doublings: with a sum of any length before it, each instruction is one for which
 * there is none. */
static void memory_may_end_at_every_instruction(void)
{
    static const char *const texts[] = {"-t",         "sin(t)",           "if(t, l, ld)",
                                        "min(t, l)",  "step(t,0,1,2,3)",  "if(t < 1, 2, 3)",
                                        "atan2(t,l)", "max(1, t, 2, ld)", "if(1, t, l)"};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        for (int terms = 0; terms < 40; ++terms) {
            char text[200] = "";
            for (int n = 0; n < terms; ++n) {
                strcat(text, "t+");
            }
            (void)fail_each(strcat(text, texts[k]));
        }
    }
}

static void writing_may_have_no_memory(void)
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    const se3d_expression_def def = define("t*l", &allocator);
    se3d_expression *e = NULL;
    char text[8] = "";
    size_t length = 9;
    CHECK(!se3d_expression_create(&def, &e, NULL));
    counting.fail_at = counting.calls + 1;
    CHECK(se3d_expression_write(e, variables, text, sizeof text, &length) == SE3D_ERR_NO_MEMORY);
    CHECK(length == 0 && strcmp(text, "") == 0);
    CHECK(!se3d_expression_write(e, variables, text, sizeof text, &length));
    CHECK(strcmp(text, "t*l") == 0);
    se3d_expression_destroy(e);
    CHECK(counting.live == 0);
}

static void failed_texts_leak_nothing(void)
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    const se3d_expression_def def = define("t + sin(l) * (2 + foo)", &allocator);
    se3d_expression *e = NULL;
    CHECK(se3d_expression_create(&def, &e, NULL) == SE3D_ERR_EXPRESSION);
    CHECK(counting.calls > 0 && counting.live == 0);
}

int main(void)
{
    RUN(every_failing_allocation_is_reported_and_nothing_leaks);
    RUN(memory_may_end_at_every_instruction);
    RUN(writing_may_have_no_memory);
    RUN(failed_texts_leak_nothing);
    return check_finish();
}
