/* SPDX-License-Identifier: BSD-3-Clause */
/* Models made of parts: files that are included, mirrored, moved and repeated. */
#include "check.h"
#include "se3d/io.h"
#include "support/scratch.h"

#define CHASSIS "  - {name: chassis, mass: 300, inertia: [20, 60, 70], position: [0, 0, 0.4]}\n"
#define RAIL                                                                                       \
    "  - {name: rail, type: prismatic, body_i: ground, body_j: chassis, at: [0, 0, 0],\n"          \
    "     axis: [0, 0, 1]}\n"
#define RUN_IT                                                                                     \
    "analysis: {type: dynamics, duration: 0.25}\n"                                                 \
    "output: [{file: x.csv, channels: [left_upright.position, right_upright.position,\n"           \
    "  left_uca.orientation, right_uca.orientation, left_upright.angular_velocity,\n"              \
    "  right_upright.angular_velocity, left_pin.angle, right_pin.angle, right_spring.force,\n"     \
    "  right_pin.force, right_uca.ball.position]}]\n"
enum { CHANNELS = 11 };

/* One corner: `y` is the side, `s` a prefix, `a` and `b` the ends of the axis in the sense in which
 * its angle counts. */
#define CORNER_POINTS(s, y)                                                                        \
    "  " s "hub: [0, " y "0.7, 0.3]\n"                                                             \
    "  " s "upper: \"[0, " y "0.64, " s "hub.z + 0.12]\"\n"                                        \
    "  " s "lower: \"[0, " y "0.66, " s "hub.z - 0.12]\"\n"                                        \
    "  " s "uf: [150 mm, " y "350 mm, 400 mm]\n"                                                   \
    "  " s "ur: [-150 mm, " y "350 mm, 400 mm]\n"                                                  \
    "  " s "low: [0, " y "0.3, 0.17]\n"
#define CORNER_BODIES(s, y, inertia)                                                               \
    "  - {name: " s "upright, mass: 12, inertia: " inertia ", position: " s "hub}\n"               \
    "  - {name: " s "uca, mass: 3, inertia: [0.02, 0.02, 0.03],\n"                                 \
    "     position: \"mid(mid(" s "uf, " s "ur), " s "upper)\",\n"                                 \
    "     markers: [{name: ball, at: " s "upper}, {name: own, position: [0, " y "0.01, 0.02]}]}\n" \
    "  - {name: " s "lca, mass: 4, inertia: [0.03, 0.02, 0.04],\n"                                 \
    "     position: \"mid(" s "low, " s "lower)\"}\n"
#define CORNER_JOINTS(s, y, axis)                                                                  \
    "  - {name: " s "pin, type: revolute, body_i: chassis, body_j: " s "uca,\n"                    \
    "     at: \"mid(" s "uf, " s "ur)\", axis: " axis "}\n"                                        \
    "  - {name: " s "lpin, type: revolute, body_i: chassis, body_j: " s "lca, at: " s "low,\n"     \
    "     axis: " axis "}\n"                                                                       \
    "  - {name: " s "uball, type: spherical, body_i: " s "uca, body_j: " s "upright,\n"            \
    "     at: " s "upper}\n"                                                                       \
    "  - {name: " s "lball, type: spherical, body_i: " s "lca, body_j: " s "upright,\n"            \
    "     at: " s "lower}\n"                                                                       \
    "  - {name: " s "toe, type: distance, body_i: chassis, body_j: " s "upright,\n"                \
    "     at: [0.1, " y "0.3, 0.2], at_2: [0.1, " y "0.7, 0.3],\n"                                 \
    "     distance: \"hypot(0.4, 0.1)\"}\n"
#define CORNER_FORCES(s, y, f, m)                                                                  \
    "  - {name: " s "spring, type: tsda, body_i: chassis, body_j: " s "lca,\n"                     \
    "     at: [0, " y "0.35, 0.6], at_2: " s "lower, k: 40 N/mm, c: 1500, l0: 0.5}\n"              \
    "  - {name: " s "twist, type: rsda, joint: " s "pin, k: 100, theta0: 0.1}\n"                   \
    "  - {name: " s "push, type: force, body: " s "upright, at: " s "hub, value: " f "}\n"         \
    "  - {name: " s "turn, type: torque, body: " s "upright, frame: body, value: " m "}\n"

#define LEFT(s)                                                                                    \
    CORNER_POINTS(s, ""), CORNER_BODIES(s, "", "[0.3, 0.2, 0.3, 0.01, 0.02, -0.01]"),              \
        CORNER_JOINTS(s, "", s "uf - " s "ur"),                                                    \
        CORNER_FORCES(s, "", "[10, 20*t, 30]", "[t, 2, 3]")
#define RIGHT(s)                                                                                   \
    CORNER_POINTS(s, "-"), CORNER_BODIES(s, "-", "[0.3, 0.2, 0.3, -0.01, -0.02, -0.01]"),          \
        CORNER_JOINTS(s, "-", s "ur - " s "uf"),                                                   \
        CORNER_FORCES(s, "-", "[10, -20*t, 30]", "[-t, 2, -3]")

static const char *const corner[] = {LEFT("")};
static const char *const left[] = {LEFT("left_")};
static const char *const right[] = {RIGHT("right_")};

static void write_corner(void)
{
    char text[6000];
    snprintf(text, sizeof text, "se3d: 1\npoints:\n%sbodies:\n%sjoints:\n%sforces:\n%s", corner[0],
             corner[1], corner[2], corner[3]);
    scratch_write("se3d_corner.yaml", text, strlen(text));
}

static void run(const char *text, double values[CHANNELS][4])
{
    se3d_model_error error = {0};
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    se3d_model *model = scratch_read_model(text, &error);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    CHECK(!se3d_model_get_solver(model, 0, &def));
    CHECK(!se3d_solver_create(se3d_model_get_system(model), &def, &solver));
    CHECK(se3d_solver_run(solver, 0.25) >= 0);
    for (size_t k = 0; k < CHANNELS; ++k) {
        size_t width = 0;
        CHECK(!se3d_model_get_channel_value(model, 0, k, NULL, values[k], &width));
    }
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static void a_mirrored_corner_has_the_bits_of_one_written_out(void)
{
    char text[12000];
    double included[CHANNELS][4] = {{0.0}};
    double written[CHANNELS][4] = {{0.0}};
    write_corner();
    run("se3d: 1\nbodies:\n" CHASSIS "joints:\n" RAIL "include:\n"
        "  - {file: se3d_corner.yaml, prefix: left_}\n"
        "  - {file: se3d_corner.yaml, prefix: right_, mirror: y}\n" RUN_IT,
        included);
    snprintf(text, sizeof text,
             "se3d: 1\npoints:\n%s%sbodies:\n" CHASSIS "%s%sjoints:\n" RAIL
             "%s%sforces:\n%s%s" RUN_IT,
             left[0], right[0], left[1], right[1], left[2], right[2], left[3], right[3]);
    run(text, written);
    CHECK(memcmp(included, written, sizeof included) == 0);
    /* Mirrored: y changes sign, angular velocities but about y, angles not. */
    CHECK_NEAR(included[0][1], -included[1][1], 1e-12);
    CHECK_NEAR(included[4][0], -included[5][0], 1e-10);
    CHECK_NEAR(included[4][1], included[5][1], 1e-10);
    CHECK_NEAR(included[6][0], included[7][0], 1e-11);
    CHECK(fabs(included[6][0]) > 0.01);
}

/* Turned by 90 degrees about z and moved: as the same turned by hand. */
static void a_part_may_be_turned_and_moved(void)
{
    static const char part[] =
        "se3d: 1\nparameters: {m: 1}\npoints: {a: [1, 0, 0]}\n"
        "bodies: [{name: b, mass: m, inertia: [2, 3, 4, 0.1, 0.2, 0.3], position: a,\n"
        "  velocity: [1, 2, 3], angular_velocity: [4, 5, 6], markers: [{name: m, at: [2, 0, "
        "0]}]},\n"
        "  {name: ground, markers: [{name: g, position: [0, 1, 0]}]}]\n"
        "forces: [{name: f, type: force, body: b, value: [1, \"2*t\", 3]}]\n";
    static const char text[] =
        "se3d: 1\nparameters: {w: 7}\ninclude:\n"
        "  - {file: se3d_part.yaml, prefix: p_, position: [0, 0, 5],\n"
        "     orientation: {axis: [0, 0, 1], angle: 90 deg}, parameters: {m: w, a: [3, 0, 1]}}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: x.csv, channels: [p_b.position, p_b.velocity, p_b.angular_velocity,\n"
        "  p_b.m.position, p_f.force, ground.g.position]}]\n";
    static const double wanted[6][3] = {{0, 3, 6}, {-2, 1, 3}, {4, 5, 6},
                                        {0, 2, 5}, {0, 1, 3},  {-1, 0, 5}};
    se3d_model_error error = {0};
    se3d_body body;
    double mass = 0.0;
    double inertia[6];
    scratch_write("se3d_part.yaml", part, sizeof part - 1);
    se3d_model *model = scratch_read_model(text, &error);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    CHECK(!se3d_body_find(se3d_model_get_system(model), "p_b", &body));
    CHECK(!se3d_body_get_mass(se3d_model_get_system(model), body, &mass, inertia));
    CHECK_NEAR(mass, 7.0, 0.0);
    for (size_t k = 0; k < 6; ++k) {
        double value[4] = {0.0};
        size_t width = 0;
        CHECK(!se3d_model_get_channel_value(model, 0, k, NULL, value, &width));
        for (size_t i = 0; i < 3; ++i) {
            CHECK_NEAR(value[i], wanted[k][i], 1e-15);
        }
    }
    se3d_model_destroy(model);
}

static void a_chain_is_one_part_repeated(void)
{
    static const char text[] =
        "se3d: 1\nparameters: {n: 4}\nparts:\n"
        "  link:\n"
        "    parameters: {L: 0.5}\n"
        "    bodies: [{name: bar, mass: 1, inertia: [0.1, 0.1, 0.1], position: \"[(i + 0.5)*L, 0,\n"
        "      0]\"}]\n"
        "    joints:\n"
        "      - {name: pin, type: revolute, body_i: \"link{i - 1}_bar\", body_j: bar, when: i > "
        "0,\n"
        "         at: \"[i*L, 0, 0]\", axis: [0, 1, 0]}\n"
        "      - {name: pin, type: revolute, body_i: ground, body_j: bar, when: i == 0,\n"
        "         at: [0, 0, 0], axis: [0, 1, 0]}\n"
        "instances: [{part: link, repeat: n, prefix: \"link{i}_\", parameters: {L: 0.25}},\n"
        "  {part: link, when: false, prefix: no}]\n"
        "analysis: {type: dynamics, duration: 1}\n";
    se3d_model_error error = {0};
    se3d_body body;
    se3d_constraint pin;
    double r[3];
    se3d_model *model = scratch_read_model(text, &error);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    const se3d_system *system = se3d_model_get_system(model);
    CHECK(!se3d_body_find(system, "link3_bar", &body));
    CHECK(!se3d_constraint_find(system, "link3_pin", &pin));
    CHECK(SE3D_FAILED(se3d_body_find(system, "link4_bar", &body)) && body.index1 == 0);
    CHECK(!se3d_body_find(system, "link3_bar", &body));
    CHECK(!se3d_body_get_position(system, body, r));
    CHECK_NEAR(r[0], 3.5 * 0.25, 1e-16);
    se3d_model_destroy(model);
}

static void mistakes_in_parts_name_the_file_and_the_chain(void)
{
    static const struct {
        const char *file; /* of se3d_part.yaml */
        const char *text;
        const char *parts[3];
    } table[] = {
        {"se3d: 1\nbodies: [{name: b, mass: -1, inertia: [1, 1, 1]}]\n",
         "include: [{file: se3d_part.yaml}]",
         {"se3d_part.yaml:2:26: bodies[0].mass: is -1", "; included at ", "se3d_test.yaml:2:11"}},
        {"se3d: 1\ninclude: [{file: se3d_part.yaml}]\n",
         "include: [{file: se3d_part.yaml}]",
         {"se3d_part.yaml:2:18: include[0].file: `", "se3d_part.yaml` includes itself",
          "included at"}},
        {"se3d: 1\n", "include: [{file: se3d_test.yaml}]", {"includes itself"}},
        {"se3d: 1\n", "include: [{file: nowhere.yaml}]", {"test.yaml:2:18", "cannot be opened"}},
        {"se3d: 1\n", "include: [{file: /dev/zero}]", {"a regular file"}},
        {"se3d: 1\n", "include: [{prefix: a}]", {"file: is missing, or `part`"}},
        {"se3d: 1\n", "include: [{file: a, part: b}]", {"exclude each other"}},
        {"se3d: 1\n", "instances: [{part: b}]", {"no part is named `b`"}},
        {"se3d: 1\n", "parts: {bar: {}}\ninstances: [{part: baz}]", {"did you mean `bar`"}},
        {"se3d: 1\n",
         "parts: {bar: {instances: [{part: bar}]}}\ninstances: [{part: bar}]",
         {"`bar` includes itself"}},
        {"se3d: [\n", "include: [{file: se3d_part.yaml}]", {"se3d_part.yaml:2:1: syntax error"}},
        {"se3d: 1\nparameters: {width: 1}\n",
         "include: [{file: se3d_part.yaml, parameters: {wdth: 2}}]",
         {"test.yaml:2:53", "no such parameter or point, did you mean `width`?"}},
        {"se3d: 1\npoints: {a: [0, 0, 0]}\n",
         "include: [{file: se3d_part.yaml, parameters: {a: 2}}]",
         {"is a point, but what is given for it is not"}},
        {"se3d: 1\n", "include: [{file: se3d_part.yaml, mirror: w}]", {"Allowed are: x, y, z"}},
        {"se3d: 1\n", "include: [{file: se3d_part.yaml, repeat: 1e6}]", {"whole number from 0 to"}},
        {"se3d: 1\n",
         "include: [{file: se3d_part.yaml, repeat: 2, prefix: \"a{j}\"}]",
         {"unknown name 'j'"}},
        {"se3d: 1\nbodies: [{name: b, fixed: true}]\n",
         "include: [{file: se3d_part.yaml, repeat: 2}]",
         {"`b` is the name of two bodies", "included at"}},
        {"se3d: 1\nbodies: [{name: b, fixed: true}]\nforces: [{type: tsda, body_i: other, "
         "point_i: [0, 1, 0], body_j: b}]\n",
         "bodies: [{name: other, fixed: true}]\ninclude: [{file: se3d_part.yaml, mirror: y}]",
         {"se3d_part.yaml:3:47: forces[0].point_i: is said in the frame of `other`"}},
        {"se3d: 1\nbodies: [{name: b, mass: 1, inertia: [1, 1, 1], when: 2 mm}]\n",
         "include: [{file: se3d_part.yaml}]",
         {"when: `2 mm` must be true, false"}},
    };
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        char text[600];
        se3d_model_error error = {0};
        scratch_write("se3d_part.yaml", table[k].file, strlen(table[k].file));
        snprintf(text, sizeof text, "se3d: 1\n%s\n", table[k].text);
        se3d_model *model = scratch_read_model(text, &error);
        CHECK(model == NULL);
        for (size_t i = 0; i < 3 && table[k].parts[i]; ++i) {
            CHECK_CONTAINS(error.message, table[k].parts[i]);
        }
        se3d_model_destroy(model);
    }
}

typedef struct mistakes {
    size_t count;
    char text[2000];
} mistakes;

static void note(void *ctx, const se3d_model_error *error)
{
    mistakes *m = ctx;
    const size_t used = strlen(m->text);
    ++m->count;
    snprintf(m->text + used, sizeof m->text - used, "%s\n", error->message);
}

/* One report for each, however often the file is included. */
static void all_mistakes_of_parts_are_reported_once(void)
{
    static const char part[] = "se3d: 1\npoints: {a: [0, 0, 1 kg]}\n"
                               "bodies:\n  - {name: b, mas: 1, inertia: [1, 1, 1]}\n"
                               "  - {name: c, mass: 2, inertia: [1, 1, 1], position: here}\n";
    static const char text[] = "se3d: 1\ninclude:\n  - {file: se3d_part.yaml, prefix: a_}\n"
                               "  - {file: se3d_part.yaml, prefix: b_, mirror: q}\n"
                               "bodies: [{name: d, mass: -2, inertia: [1, 1, 1]}]\n";
    static const char *const wanted[] = {"points.a[2]: `1 kg` is a mass", "did you mean `mass`",
                                         "unknown name 'here'", "is `q`, did you mean",
                                         "bodies[0].mass: is -2"};
    mistakes m = {0};
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_model_options options = se3d_model_options_default();
    options.report = note;
    options.report_ctx = &m;
    scratch_write("se3d_part.yaml", part, sizeof part - 1);
    CHECK(SE3D_FAILED(se3d_model_read_text(text, strlen(text), scratch_path("se3d_test.yaml"),
                                           &options, &model, &error)));
    CHECK(m.count == 5);
    for (size_t k = 0; k < 5; ++k) {
        CHECK_CONTAINS(m.text, wanted[k]);
    }
}

static void clean(void)
{
    scratch_remove("se3d_part.yaml");
    scratch_remove("se3d_corner.yaml");
}

int main(void)
{
    RUN(a_mirrored_corner_has_the_bits_of_one_written_out);
    RUN(a_part_may_be_turned_and_moved);
    RUN(a_chain_is_one_part_repeated);
    RUN(mistakes_in_parts_name_the_file_and_the_chain);
    RUN(all_mistakes_of_parts_are_reported_once);
    clean();
    return check_finish();
}
