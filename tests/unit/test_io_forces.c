/* SPDX-License-Identifier: BSD-3-Clause */
/* What the keys of force elements mean: models are read, and what the elements do at the given
 * state is compared with their definition. */
#include "check.h"
#include "io/document/guess.h"
#include "io/read/objects.h"
#include "se3d/io.h"

/* Two bodies in a general position; `b` turned about z by 0.3 and moving. */
#define BODIES                                                                                     \
    "se3d: 1\nparameters: {c: cos(0.3), s: sin(0.3)}\nbodies:\n"                                   \
    "  - {name: a, mass: 1, inertia: [1, 1, 1], position: [1, 2, 3], orientation: {axis: [0, 0, "  \
    "1], angle: 0.2}}\n"                                                                           \
    "  - {name: b, mass: 2, inertia: [1, 1, 1], position: [1.5, 2, 3], velocity: [0.7, 0, 0],\n"   \
    "     orientation: {axis: [0, 0, 1], angle: 0.5}, angular_velocity: [0, 0, 0.4]}\n"            \
    "joints:\n"                                                                                    \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: b, at: [1.5, 2, 3], axis: [1, 0, "  \
    "0]}\n"
#define CHANNELS(x) "output: [{file: x.csv, channels: [" x "]}]\n"

static se3d_model *read_model(const char *text)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    if (SE3D_FAILED(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error))) {
        fprintf(stderr, "%s\n", error.message);
    }
    CHECK(model != NULL);
    return model;
}

static double channel(const se3d_model *model, size_t k, size_t part)
{
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    size_t width = 0;
    CHECK(se3d_model_get_channel_value(model, 0, k, NULL, value, &width) == SE3D_OK);
    CHECK(part < width);
    return value[part];
}

static void spring_adds_coefficients_functions_tables_and_preload(void)
{
    static const struct {
        const char *keys;
        double force; /* at l - l0 = 0.1, ldot = 0.7 */
    } cases[] = {
        {"k: 100", 10.0},
        {"c: 10", 7.0},
        {"preload: -3", -3.0},
        {"spring: \"1000*x^2\"", 10.0},
        {"spring: 4", 4.0},
        {"damper: \"10*v^3\"", 3.43},
        {"h: \"l + 2*ldot\"", 1.9},
        {"h: 2.5", 2.5},
        {"k: {spline: [[0, 0], [1, 50]]}", 5.0},
        {"c: {spline: [[-1, -30], [1, 30]]}", 21.0},
        {"k: 100, spring: {spline: [[0, 1], [1, 1]]}, c: 10, damper: v, h: t, preload: 0.5", 19.2},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        snprintf(text, sizeof text,
                 BODIES
                 "forces: [{name: f, type: tsda, body_i: a, body_j: b, l0: 0.4, %s}]\n" CHANNELS(
                     "f.force, f.length, f.rate"),
                 cases[k].keys);
        se3d_model *model = read_model(text);
        CHECK_NEAR(channel(model, 0, 0), cases[k].force, 1e-12);
        CHECK_NEAR(channel(model, 1, 0), 0.5, 1e-15);
        CHECK_NEAR(channel(model, 2, 0), 0.7, 1e-15);
        se3d_model_destroy(model);
    }
}

/* theta is from ref_i to ref_j about the axis; angle0 is its value now, counted in turns. */
static void axis_of_a_torsion_spring_is_given_in_three_ways(void)
{
    static const struct {
        const char *keys;
        double angle;
    } cases[] = {
        {"axis: [0, 0, 2], angle0: 0.25", 0.25},
        {"axis_i: [0, 0, 1], angle0: 7", 7.0},
        {"axis_i: [0, 0, 1], ref_i: [1, 0, 0], ref_j: [1, 0, 0]", 0.3},
        {"axis_i: [0, 0, -1], ref_i: [0, 1, 0], ref_j: [0, 1, 0]", -0.3},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        snprintf(text, sizeof text,
                 BODIES "forces: [{name: f, type: rsda, body_i: a, body_j: b, k: 2, theta0: 0.1, "
                        "%s}]\n" CHANNELS("f.torque, f.angle, f.rate"),
                 cases[k].keys);
        se3d_model *model = read_model(text);
        const double sign = k == 3 ? -1.0 : 1.0;
        CHECK_NEAR(channel(model, 1, 0), cases[k].angle, 1e-14);
        CHECK_NEAR(channel(model, 0, 0), 2.0 * (cases[k].angle - 0.1), 1e-13);
        CHECK_NEAR(channel(model, 2, 0), 0.4 * sign, 1e-15);
        se3d_model_destroy(model);
    }
}

/* Placed by `at` the bushing is without force and torque; the local frames give what they say. */
static void bushing_frames_are_global_or_local(void)
{
    se3d_model *model = read_model(
        BODIES
        "forces:\n"
        "  - {name: f, type: bushing, body_i: a, body_j: b, at: [2, 2, 3], orientation: {rpy: "
        "[0.3, 0.2, 0.1]}, K: [100, 200, 300, 4, 5, 6]}\n"
        "  - {name: g, type: bushing, body_i: ground, body_j: b, point_i: [1.4, 1.8, 3], "
        "orientation_j: {axis: [0, 0, 1], angle: -0.1}, K: [100, 200, 300, 4, 5, 6],\n"
        "     C: [[10,0,0,0,0,0], [0,1,0,0,0,0], [0,0,1,0,0,0], [0,0,0,1,0,0], "
        "[0,0,0,0,1,0], [0,0,0,0,0,2]]}\n" CHANNELS("f.force, f.torque, g.force, g.torque"));
    for (size_t part = 0; part < 3; ++part) {
        CHECK_NEAR(channel(model, 0, part), 0.0, 1e-12);
        CHECK_NEAR(channel(model, 1, part), 0.0, 1e-12);
    }
    /* u = (0.1, 0.2, 0), udot = (0.7, 0, 0), theta = 0.5 - 0.1 about z with the rate 0.4. */
    CHECK_NEAR(channel(model, 2, 0), -(10.0 + 7.0), 1e-12);
    CHECK_NEAR(channel(model, 2, 1), -40.0, 1e-12);
    CHECK_NEAR(channel(model, 3, 2), -(6.0 * 0.4 + 2.0 * 0.4), 1e-12);
    se3d_model_destroy(model);
}

/* The torque of a force is about its point, so that it is zero there. */
static void loads_are_reported_at_their_point(void)
{
    se3d_model *model = read_model(
        BODIES "forces:\n"
               "  - {name: f, type: force, body: b, point: [0, 1, 0], value: [3, 4, 5]}\n"
               "  - {name: n, type: torque, body: b, frame: body, value: [1, 0, "
               "2]}\n" CHANNELS("f.force, f.torque, n.force, n.torque"));
    for (size_t part = 0; part < 3; ++part) {
        CHECK_NEAR(channel(model, 0, part), 3.0 + (double)part, 1e-14);
        CHECK_NEAR(channel(model, 1, part), 0.0, 1e-14);
        CHECK_NEAR(channel(model, 2, part), 0.0, 0.0);
    }
    CHECK_NEAR(channel(model, 3, 0), cos(0.5), 1e-15);
    CHECK_NEAR(channel(model, 3, 1), sin(0.5), 1e-15);
    CHECK_NEAR(channel(model, 3, 2), 2.0, 1e-15);
    se3d_model_destroy(model);
}

static void stop_pushes_beyond_its_range_only(void)
{
    static const struct {
        const char *keys;
        double force;
    } cases[] = {
        {"joint: rail, upper: 0.1", 0.0},
        {"joint: rail, upper: -0.1", 20.0},
        {"joint: rail, lower: 0.1", -20.0},
        {"joint: rail, lower: -0.1, upper: 0.1", 0.0},
        {"body_i: a, body_j: b, lower: 0.8", -60.0},
        {"body_i: a, body_j: b, point_j: [0, 0, 1.2], upper: 1", 60.0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        snprintf(text, sizeof text,
                 BODIES
                 "forces: [{name: f, type: stop, k: 200, %s}]\n" CHANNELS("f.force, f.coordinate"),
                 cases[k].keys);
        se3d_model *model = read_model(text);
        CHECK_NEAR(channel(model, 0, 0), cases[k].force, 1e-10);
        se3d_model_destroy(model);
    }
}

static void gravity_and_held_bodies_reach_the_system(void)
{
    static const char text[] = "se3d: 1\ngravity: [1, \"2*t\", {spline: [[0, -9], [1, -9]]}]\n"
                               "bodies:\n  - {name: a, mass: 1, inertia: [1, 1, 1], held: true}\n"
                               "  - {name: b, mass: 1, inertia: [1, 1, 1]}\n"
                               "analysis: {type: dynamics, duration: 1, start: 1}\n" CHANNELS(
                                   "a.velocity, b.acceleration");
    se3d_model *model = read_model(text);
    const se3d_system *system = se3d_model_get_system(model);
    se3d_body body;
    int32_t held = 0;
    CHECK(se3d_body_find(system, "a", &body) == SE3D_OK);
    CHECK(se3d_body_get_held(system, body, &held) == SE3D_OK && held != 0);
    CHECK(se3d_body_find(system, "b", &body) == SE3D_OK);
    CHECK(se3d_body_get_held(system, body, &held) == SE3D_OK && held == 0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    CHECK(se3d_model_get_solver(model, 0, &def) == SE3D_OK);
    CHECK(se3d_solver_create(se3d_model_get_system(model), &def, &solver) == SE3D_OK);
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 2.0)));
    CHECK_NEAR(channel(model, 0, 0), 2.0, 1e-9);
    CHECK_NEAR(channel(model, 0, 1), 4.0, 1e-6);
    CHECK_NEAR(channel(model, 1, 1), 4.0, 1e-9);
    CHECK_NEAR(channel(model, 1, 2), -9.0, 1e-9);
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static void what_is_in_the_wrong_place_is_told_where_it_belongs(void)
{
    static const struct {
        const char *text;
        const char *part;
    } cases[] = {
        {"  - {type: tsda, body_i: a, body_j: b}\n",
         "`tsda` is not a joint type, but a type of `forces`"},
        {"constraints: [{type: gear}]\n",
         "`gear` is not a constraint type, but a type of `joints`; allow"},
        {"forces: [{type: gravity}]\n", "`gravity` is not a force type, but a key of the model"},
        {"forces: [{type: driver}]\n", "`driver` is not a force type, but an entry of `drivers`"},
        {"forces: [{type: tsd}]\n", "did you mean `tsda`?"},
        {CHANNELS("a"), "`a` is not a channel, it has: position, orientation"},
        {CHANNELS("a."), "`a` is not a channel, it has: position, orientation"},
        {CHANNELS("rail"), "`rail` is not a channel, it has: "},
        {CHANNELS("energy"), "`energy` is not a channel, it has: kinetic"},
        {CHANNELS("steps."), "`steps.` is unknown, did you mean `steps`?"},
        {CHANNELS("d"), "`d` is unknown, did you mean `a`?"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        se3d_model *model = NULL;
        se3d_model_error error = {0};
        snprintf(text, sizeof text, BODIES "%s", cases[k].text);
        CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) ==
              SE3D_ERR_MODEL);
        CHECK_CONTAINS(error.message, cases[k].part);
    }
}

static void every_type_has_a_place(void)
{
    int count = 0;
    for (size_t k = 0; se3di_objects_get(k); ++k) {
        const se3di_object *o = se3di_objects_get(k);
        const int is_listed = strcmp(o->name, "joint") == 0 || strcmp(o->name, "force") == 0 ||
                              strcmp(o->name, "constraint") == 0 || strcmp(o->name, "state") == 0;
        for (const char *const *type = o->types; is_listed && *type; ++type, ++count) {
            const char *place = se3di_guess_place(*type);
            CHECK(place && strstr(place, o->name));
        }
    }
    CHECK(count > 30);
    CHECK(!se3di_guess_place("dsda") && !se3di_guess_place("") && !se3di_guess_place(" "));
}

int main(void)
{
    RUN(spring_adds_coefficients_functions_tables_and_preload);
    RUN(axis_of_a_torsion_spring_is_given_in_three_ways);
    RUN(bushing_frames_are_global_or_local);
    RUN(loads_are_reported_at_their_point);
    RUN(stop_pushes_beyond_its_range_only);
    RUN(gravity_and_held_bodies_reach_the_system);
    RUN(every_type_has_a_place);
    RUN(what_is_in_the_wrong_place_is_told_where_it_belongs);
    return check_finish();
}
