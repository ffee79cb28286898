/* SPDX-License-Identifier: BSD-3-Clause */
/* `roads` of model files: lists, files and units say the same; what is wrong is told. */
#include "support/scratch.h"

#include <math.h>

#define CSV "se3d_test_road.csv"
#define OBJ "se3d_test_road.obj"

/* Height and slopes of the only road at a point. */
static void look(const char *roads, const char *more, double x, double y, double at[4])
{
    char text[1500];
    se3d_model_error error = {0, 0, ""};
    se3d_road road;
    snprintf(text, sizeof text, "se3d: 1\n%sroads: [%s]\n", more, roads);
    se3d_model *model = scratch_read_model(text, &error);
    memset(at, 0, 4 * sizeof *at);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    CHECK(!se3d_system_get_road(se3d_model_get_system(model), 0, &road));
    CHECK(!se3d_road_get_height(se3d_model_get_system(model), road, x, y, at));
    se3d_model_destroy(model);
}

static void the_same_road_is_the_same_however_it_is_said(void)
{
    static const char csv[] = "\xef\xbb\xbf# heights\n0; 0.1;0.4\r\n\n0.2;0.3; 0.2\n";
    static const char in_mm[] = "0,100,400\n200,300,200";
    static const char mm[] = "units: {length: mm}\n";
    double at[5][4];
    scratch_write(CSV, csv, strlen(csv));
    look("{type: heightfield, spacing: 2, row_spacing: 1, heights: [[0, 0.1, 0.4], [0.2, 30 cm, "
         "0.2]]}",
         "", 0.7, -0.1, at[0]);
    look("{type: heightfield, spacing: 2, row_spacing: 1, file: " CSV "}", "", 0.7, -0.1, at[1]);
    look("{type: heightfield, spacing: 2000, row_spacing: 1 m, heights: [[0, 100, 400], [200, 300, "
         "200]]}",
         mm, 0.7, -0.1, at[2]);
    scratch_write(CSV, in_mm, strlen(in_mm));
    look("{type: heightfield, spacing: 2000, row_spacing: 1000, file: " CSV "}", mm, 0.7, -0.1,
         at[3]);
    scratch_remove(CSV);
    CHECK(at[0][0] > 0.1 && at[0][1] > 0.01 && at[0][2] > 0.01);
    for (int k = 1; k < 4; ++k) {
        for (int c = 0; c < 4; ++c) {
            CHECK_NEAR(at[k][c], at[0][c], 1e-14);
        }
    }
    look("{type: height, height: 0.01*x*y + 0.002*t}", "", 3.0, 2.0, at[0]);
    look("{type: height, height: 0.01*x*y/(1 m) + 2 mm*t/(1 s)}", "", 3.0, 2.0, at[1]);
    look("{type: height, height: 1e-5*x*y + 2*t}", mm, 3.0, 2.0, at[2]);
    CHECK_NEAR(at[0][0], 0.06, 1e-15);
    CHECK_NEAR(at[0][3], 0.002, 1e-15);
    for (int c = 0; c < 4; ++c) {
        CHECK_NEAR(at[1][c], at[0][c], 1e-14);
        CHECK_NEAR(at[2][c], at[0][c], 1e-14);
    }
    look("{type: height, height: 0.25}", "", 3.0, 2.0, at[0]);
    CHECK_NEAR(at[0][0], 0.25, 0.0);
    look("{type: plane, at: [1, 2, 3]}", "", 3.0, 2.0, at[0]);
    CHECK_NEAR(at[0][0], 0.0, 0.0);
}

static void a_mesh_is_as_high_as_its_highest_triangle(void)
{
    static const char obj[] = "v 0 0 100\nv 4000 0 100\nv 0 4000 500\nv 0 0 50\nv 4000 0 50\n"
                              "v 0 4000 0\nf 1 2 3\nf 6 5 4\n";
    double at[4];
    scratch_write(OBJ, obj, strlen(obj));
    look("{type: mesh, scale: 0.001, file: " OBJ "}", "", 1.0, 1.0, at);
    CHECK_NEAR(at[0], 0.2, 1e-12);
    CHECK_NEAR(at[2], 0.1, 1e-12);
    look("{type: mesh, scale: 0.001, file: " OBJ "}", "", 3.0, 3.0, at);
    CHECK_NEAR(at[0], 0.0, 0.0);
    scratch_remove(OBJ);
}

#define BODY "bodies: [{name: rim, mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.3]}]\n"
#define TYRE(more)                                                                                 \
    BODY "roads: [{name: way, type: height, height: 0.1*x}]\nforces: [{type: tyre, body: rim, "    \
         "radius: 0.3, k: 1e5, mu: 1, slip_stiffness: 1e4, cornering_stiffness: 1e4" more "}]\n"

static void what_is_wrong_with_a_road_is_told(void)
{
    static const struct {
        const char *text, *told;
    } cases[] = {
        {"roads: [{type: heigth, height: 1}]", "did you mean `height`"},
        {"roads: [{type: height}]", "height: is missing, must be z over t, x and y"},
        {"roads: [{type: height, height: sin(z)}]", "roads[0].height"},
        {"roads: [{type: height, height: 1 kg}]", "must be"},
        {"roads: [{type: height, height: x, spacing: 1}]", "spacing"},
        {"roads: [{type: heightfield, heights: [[0, 1], [1, 1]]}]", "spacing: is missing"},
        {"roads: [{type: heightfield, spacing: 0, heights: [[0, 1], [1, 1]]}]", "spacing"},
        {"roads: [{type: heightfield, spacing: 1}]", "heights: must be given, or file"},
        {"roads: [{type: heightfield, spacing: 1, file: a.csv, heights: [[0, 1], [1, 1]]}]",
         "not both"},
        {"roads: [{type: heightfield, spacing: 1, heights: [[0, 1], [1]]}]",
         "must be a list of 2 numbers"},
        {"roads: [{type: heightfield, spacing: 1, heights: [[0, 1]]}]", "at least two rows"},
        {"roads: [{type: heightfield, spacing: 1, heights: [0, 1]}]", "at least two rows"},
        {"roads: [{type: heightfield, spacing: 1, heights: [[0, a], [1, 1]]}]", "heights[0][1]"},
        {"roads: [{type: heightfield, spacing: 1, file: nowhere.csv}]", "nowhere.csv"},
        {"roads: [{type: mesh}]", "file: is missing"},
        {"parts: {p: {roads: [{type: height, height: 0.1*x*y}]}}\n"
         "instances: [{part: p, mirror: y}]",
         "height: has y in a part that is mirrored"},
        {"roads: [{type: plane, normal: [1, 0, 0]}]", "are parallel"},
        {"roads: [{type: plane, body: nobody}]", "nobody"},
        {"roads: [{name: a, type: plane}, {name: a, type: plane}]", "the name of two elements"},
        {TYRE(", road: waay"), "no road and no body is named `waay`, did you mean `way`"},
        {TYRE(", road: way, normal: [0, 0, 1]"), "normal: is of a plane"},
        {TYRE(", road: way, road_point: [0, 0, 1]"), "road_point: is of a plane"},
        {TYRE(", envelope: 0.1"), "envelope: needs a road of `roads`"},
        {TYRE(", road: way, envelope: 0"), "envelope"},
        {TYRE(", road: rim"), "must be another one"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[1500];
        se3d_model_error error = {0, 0, ""};
        snprintf(text, sizeof text, "se3d: 1\n%s", cases[k].text);
        se3d_model *model = scratch_read_model(text, &error);
        CHECK(!model);
        CHECK_CONTAINS(error.message, cases[k].told);
        CHECK_CONTAINS(error.message, "se3d_test.yaml:");
        se3d_model_destroy(model);
    }
}

static void files_of_heights_that_are_none_are_refused(void)
{
    static const char *const files[][2] = {{"0,1\n1,x\n", "road.csv:2: `x` is not a number"},
                                           {"0,1\n1\n", "road.csv:2: has 1 heights"},
                                           {"0,1\n1,,2\n", "`` is not a number"},
                                           {"0,1\n1,nan\n", "not a number"},
                                           {"# none\n", "has 0 rows"}};
    for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
        se3d_model_error error = {0, 0, ""};
        scratch_write(CSV, files[k][0], strlen(files[k][0]));
        CHECK(!scratch_read_model(
            "se3d: 1\nroads: [{type: heightfield, spacing: 1, file: " CSV "}]\n", &error));
        CHECK_CONTAINS(error.message, files[k][1]);
    }
    scratch_write(CSV, "0,1\0001\n", 6);
    se3d_model_error error = {0, 0, ""};
    CHECK(!scratch_read_model("se3d: 1\nroads: [{type: heightfield, spacing: 1, file: " CSV "}]\n",
                              &error));
    CHECK_CONTAINS(error.message, "is not a text");
    scratch_remove(CSV);
}

/* A road of a part that is mirrored, turned and moved is the road of the part at the mirrored
 * place, also twice. */
static void a_mirrored_road_is_the_road_mirrored(void)
{
    static const char obj[] = "v 0 0 0.1\nv 4 0 0.1\nv 0 4 0.5\nf 1 2 3\n";
    static const char *const roads[] = {
        "{type: heightfield, spacing: 2, row_spacing: 1, at: [1, 2, 0], forward: [1, 0.5, 0], "
        "heights: [[0, 0.1, 0.4], [0.2, 0.3, 0.2], [0, 0.7, 0.1]]}",
        "{type: mesh, file: " OBJ ", at: [1, 2, 0], forward: [1, 0.5, 0]}",
        "{type: height, height: 0.1*sin(x), at: [1, 2, 0], forward: [1, 0.5, 0]}"};
    static const char *const signs[] = {"mirror: y", "mirror: x",
                                        "mirror: z, orientation: {rpy: "
                                        "[180 deg, 0, 0]}"};
    scratch_write(OBJ, obj, strlen(obj));
    for (size_t k = 0; k < sizeof roads / sizeof *roads; ++k) {
        for (size_t m = 0; m < sizeof signs / sizeof *signs; ++m) {
            char more[1500];
            double given[4], at[4], twice[4];
            /* x and y in the frames of the roads, whose y is the other way round */
            look(roads[k], "", 0.7, 0.4, given);
            snprintf(more, sizeof more,
                     "parts: {p: {roads: [%s]}, q: {instances: [{part: p, %s}]}}\n"
                     "instances: [{part: p, %s}]\n",
                     roads[k], signs[m], signs[m]);
            look("", more, 0.7, -0.4, at);
            snprintf(more, sizeof more,
                     "parts: {p: {roads: [%s]}, q: {instances: [{part: p, %s}]}}\n"
                     "instances: [{part: q, %s}]\n",
                     roads[k], signs[m], signs[m]);
            look("", more, 0.7, 0.4, twice);
            CHECK(fabs(given[0]) > 0.01);
            for (int c = 0; c < 3; ++c) {
                CHECK_NEAR(at[c], c == 2 ? -given[c] : given[c], 1e-12);
                CHECK_NEAR(twice[c], given[c], 1e-12);
            }
        }
    }
    scratch_remove(OBJ);
}

int main(void)
{
    RUN(the_same_road_is_the_same_however_it_is_said);
    RUN(a_mirrored_road_is_the_road_mirrored);
    RUN(a_mesh_is_as_high_as_its_highest_triangle);
    RUN(what_is_wrong_with_a_road_is_told);
    RUN(files_of_heights_that_are_none_are_refused);
    return check_finish();
}
