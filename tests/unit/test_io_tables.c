/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of model files: lists and CSV files, the same to the last bit; units; hostile files. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "se3d/io.h"
#include "support/scratch.h"

#define PIN                                                                                        \
    "bodies: [{name: bar, mass: 1, inertia: [1, 1, 1]}]\njoints: [{name: pin, type: revolute, "    \
    "body_i: ground, body_j: bar, at: [0, 0, 0], axis: [0, 0, 1]}]\n"
#define CSV "se3d_test_table.csv"

/* Angles of a driver at some times. */
static void follow(const char *text, double angles[8])
{
    se3d_model_error error = {0};
    se3d_model *model = scratch_read_model(text, &error);
    se3d_constraint motor;
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    se3d_system *system = se3d_model_get_system(model);
    CHECK(!se3d_constraint_find(system, "motor", &motor));
    for (int k = 0; k < 8; ++k) {
        CHECK(!se3d_system_set_time(system, -0.3 + 0.5 * k));
        CHECK(!se3d_driver_get_value(system, motor, &angles[k]));
    }
    se3d_model_destroy(model);
}

static void a_file_is_what_its_list_is(void)
{
    static const char csv[] =
        "\xef\xbb\xbf# a cam\r\ntime, \"lift\" ,other\r\n0,10,7\r\n\r\n0.5 ; 35.5,8\r\n"
        "1.25\t-2e1,x\r\n2,10,9\r\n";
    static const char *const kinds[] = {"spline", "linear", "akima"};
    scratch_write(CSV, csv, sizeof csv - 1);
    for (int kind = 0; kind < 3; ++kind) {
        for (int periodic = 0; periodic < 2; ++periodic) {
            char text[800];
            double list[8], file[8], named[8];
            const char *tail = periodic ? ", periodic: true" : "";
            const char *head = "se3d: 1\nunits: {angle: deg, time: ms}\n" PIN
                               "drivers: [{name: motor, joint: pin, ";
            const char *key = kind == 1 ? "rate" : "value";
            snprintf(text, sizeof text,
                     "%s%s: {%s: [[0, 10], [0.5, 35.5], [1.25, -20], [2, 10]]%s}}]\n", head, key,
                     kinds[kind], tail);
            follow(text, list);
            snprintf(text, sizeof text, "%s%s: {%s: %s%s}}]\n", head, key, kinds[kind], CSV, tail);
            follow(text, file);
            snprintf(text, sizeof text, "%s%s: {%s: %s, columns: [time, lift]%s}}]\n", head, key,
                     kinds[kind], CSV, tail);
            follow(text, named);
            CHECK(memcmp(list, file, sizeof list) == 0);
            CHECK(memcmp(list, named, sizeof list) == 0);
        }
    }
    scratch_remove(CSV);
}

/* Milliseconds and degrees: the value is that at 1 ms. */
static void numbers_of_a_file_are_in_the_units_of_the_model(void)
{
    static const char csv[] = "0,0\n1000,90\n2000,0\n";
    double angle[8];
    scratch_write(CSV, csv, sizeof csv - 1);
    follow("se3d: 1\nunits: {angle: deg, time: ms}\n" PIN
           "drivers: [{name: motor, joint: pin, value: {akima: " CSV "}}]\n",
           angle);
    scratch_remove(CSV);
    double list[8];
    follow("se3d: 1\n" PIN
           "drivers: [{name: motor, joint: pin, value: {akima: [[0, 0], [1, \"pi/2\"],"
           " [2, 0]]}}]\n",
           list);
    for (int k = 0; k < 8; ++k) {
        CHECK_NEAR(angle[k], list[k], 1e-14);
    }
}

static void hostile_files_are_told_by_line_and_column(void)
{
    static const struct {
        const char *csv, *columns, *parts[3];
    } cases[] = {
        {"0,1\n1,2 m\n", "", {CSV ":2:3: `2 m` is not a number"}},
        {"0,1\n 1;\n", "", {CSV ":2:4: `` is not a number"}},
        {"0,1\n1\n", "", {CSV ":2:1: the line has 1 columns, must have 2"}},
        {"0,1\n1,nan\n", "", {CSV ":2:3: `nan` is not a number"}},
        {"0,1\n1,1e999\n", "", {CSV ":2:3: `1e999` is not a number"}},
        {"0,1\n1,1e50\n", "", {"at most 1e+40"}},
        {"0,1\n0,2\n", "", {CSV ":2:1: begins with 0 after 0, must increase"}},
        {"t,y\n0,2\n", "", {"has 1 points, must have at least two"}},
        {"\n# only words\n", "", {"has 0 points"}},
        {"root:x:0:0:a-very-long-secret-text-of-another-file\n0,1\nroot:x:0:0:a-very-long-secret\n",
         "",
         {CSV ":3:1: the line has 1 columns"}},
        {"0,1\n1,a-very-long-secret-text-of-another-file\n",
         "",
         {"`a-very-long-secret-text-` is not"}},
        {"time,lift\n0,1\n1,2\n", ", columns: [time, lifd]", {"columns[1]", "did you mean `lift`"}},
        {"0,1\n1,2\n", ", columns: [time, lift]", {CSV ":1:1: begins with numbers"}},
        {"time,lift\n0,1\n1,2\n", ", columns: [time]", {"a list of two names"}},
        {"time,lift\n0,1\n1,2\n", ", periodic: true", {"at least 3"}},
        {"time,lift\n0,1\n1,2\n2,2\n", ", periodic: true", {"must end with 1"}}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[800];
        se3d_model_error error = {0};
        scratch_write(CSV, cases[k].csv, strlen(cases[k].csv));
        snprintf(text, sizeof text,
                 "se3d: 1\n" PIN "drivers: [{name: motor, joint: pin, value: {spline: %s%s}}]\n",
                 CSV, cases[k].columns);
        se3d_model *model = scratch_read_model(text, &error);
        CHECK(!model);
        for (int n = 0; n < 3 && cases[k].parts[n]; ++n) {
            CHECK_CONTAINS(error.message, cases[k].parts[n]);
        }
        CHECK(!strstr(error.message, "secret-text-of"));
        se3d_model_destroy(model);
    }
    scratch_remove(CSV);
}

/* A spring by a table of its force, periodic in the angle: the torque that it tells. */
static void forces_take_tables_of_every_kind(void)
{
    se3d_model_error error = {0};
    se3d_model *model = scratch_read_model(
        "se3d: 1\n" PIN
        "forces:\n  - {name: cogs, type: rsda, joint: pin, spring: {linear: [[0, 0], "
        "[15 deg, 2], [45 deg, -2], [60 deg, 0]], periodic: true}, theta0: -370 deg}\n"
        "  - {name: damper, type: rsda, joint: pin, c: {akima: [[-1, -3], [0, 0], [1, 5]]}}\n",
        &error);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    se3d_force cogs;
    double angle, rate, torque;
    CHECK(!se3d_force_find(se3d_model_get_system(model), "cogs", &cogs));
    CHECK(!se3d_force_get_state(se3d_model_get_system(model), cogs, &angle, &rate, &torque));
    CHECK_NEAR(torque, 2.0 * 10.0 / 15.0, 1e-12); /* 370 deg is 10 deg behind six cogs */
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(a_file_is_what_its_list_is);
    RUN(numbers_of_a_file_are_in_the_units_of_the_model);
    RUN(hostile_files_are_told_by_line_and_column);
    RUN(forces_take_tables_of_every_kind);
    return check_finish();
}
