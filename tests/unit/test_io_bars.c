/* SPDX-License-Identifier: BSD-3-Clause */
/* Bars from point to point, arms of three points and plates: against closed forms, and the same as
 * what is written out. */
#include <math.h>

#include "check.h"
#include "io/model/model.h"
#include "se3d/io.h"
#include "support/read_text.h"

#define PI 3.14159265358979323846

typedef struct body_data {
    double r[3], p[4], mass, inertia[6];
} body_data;

static body_data get(se3d_model *model, const char *name)
{
    body_data d;
    se3d_body body;
    se3d_system *system = se3d_model_get_system(model);
    memset(&d, 0, sizeof d);
    CHECK(!se3d_body_find(system, name, &body));
    CHECK(!se3d_body_get_position(system, body, d.r));
    CHECK(!se3d_body_get_orientation(system, body, d.p));
    CHECK(!se3d_body_get_mass(system, body, &d.mass, d.inertia));
    return d;
}

static void check_same(const body_data *a, const body_data *b, double tolerance)
{
    CHECK_NEAR(a->mass, b->mass, tolerance);
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(a->r[k], b->r[k], tolerance);
    }
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(a->inertia[k], b->inertia[k], tolerance);
    }
}

/* The same solids by shapes with a density. */
static void bars_weigh_what_their_shapes_weigh(void)
{
    se3d_model *model = read_text(
        "se3d: 1\npoints: {a: [0.1, 0.2, 0.3], b: [0.5, -0.1, 0.3], m: \"mid(a, b)\"}\n"
        "materials: [{name: steel, density: 7850}]\nbodies:\n"
        "  - {name: rod, from: a, to: b, radius: 10 mm, material: steel}\n"
        "  - {name: flat, from: a, to: b, width: 40 mm, thickness: 8 mm, density: 2700}\n"
        "  - {name: tube, from: a, to: b, radius: 10 mm, wall: 2 mm, density: 7850}\n"
        "  - {name: heavy, from: a, to: b, radius: 10 mm, mass: 3}\n"
        "  - {name: box, from: a, to: b, width: 40 mm, thickness: 8 mm, wall: 1 mm, across: [0, 0, "
        "1], density: 2700}\n"
        "  - {name: rod_2, position: m, density: 7850, shapes: [{type: cylinder, radius: "
        "0.01, length: 0.5, orientation: {axis: [-0.3, -0.4, 0], angle: -pi/2}}]}\n"
        "  - {name: flat_2, position: m, density: 2700, shapes: [{type: box, size: [0.5, "
        "0.04, 0.008], orientation: {axis: [0, 0, 1], angle: \"atan2(-0.3, 0.4)\"}}]}\n"
        "  - {name: core, position: m, density: 7850, shapes: [{type: cylinder, radius: "
        "0.008, length: 0.5, orientation: {axis: [-0.3, -0.4, 0], angle: -pi/2}}]}\n"
        "  - {name: box_2, position: m, density: 2700, shapes: [{type: box, size: [0.5, "
        "0.008, 0.04], orientation: {axis: [0, 0, 1], angle: \"atan2(-0.3, 0.4)\"}}]}\n"
        "  - {name: box_3, position: m, density: 2700, shapes: [{type: box, size: [0.5, "
        "0.006, 0.038], orientation: {axis: [0, 0, 1], angle: \"atan2(-0.3, 0.4)\"}}]}\n");
    const body_data rod = get(model, "rod");
    const body_data rod_2 = get(model, "rod_2");
    const body_data flat = get(model, "flat");
    const body_data flat_2 = get(model, "flat_2");
    const body_data tube = get(model, "tube");
    const body_data heavy = get(model, "heavy");
    const body_data box = get(model, "box");
    body_data core = get(model, "core");
    body_data box_3 = get(model, "box_3");
    const body_data box_2 = get(model, "box_2");
    CHECK_NEAR(rod.mass, 7850.0 * PI * 1e-4 * 0.5, 1e-13);
    check_same(&rod, &rod_2, 1e-15);
    check_same(&flat, &flat_2, 1e-15);
    CHECK(heavy.mass == 3.0);
    CHECK_NEAR(heavy.inertia[0], 3.0 / rod.mass * rod.inertia[0], 1e-15);
    core.mass = rod.mass - core.mass;
    box_3.mass = box_2.mass - box_3.mass;
    for (int k = 0; k < 6; ++k) {
        core.inertia[k] = rod.inertia[k] - core.inertia[k];
        box_3.inertia[k] = box_2.inertia[k] - box_3.inertia[k];
    }
    check_same(&tube, &core, 1e-15);
    check_same(&box, &box_3, 1e-15);
    CHECK(se3d_model_count_shapes(model) == 10);
    se3d_model_destroy(model);
}

/* Upright: z of the leg is z of the ground, x of the section x. */
static void an_upright_bar_has_its_width_along_x(void)
{
    se3d_model *model =
        read_text("se3d: 1\nunits: {length: mm, mass: g}\nbodies: [{name: post, from: [0, 0, 100], "
                  "to: [0, 0, 500], width: 60, thickness: 20, mass: 2000}]\n");
    const body_data post = get(model, "post");
    CHECK_NEAR(post.mass, 2.0, 1e-15);
    CHECK_NEAR(post.r[2], 0.3, 1e-15);
    CHECK_NEAR(post.inertia[0], 2.0 / 12.0 * (0.02 * 0.02 + 0.16), 1e-15);
    CHECK_NEAR(post.inertia[1], 2.0 / 12.0 * (0.06 * 0.06 + 0.16), 1e-15);
    CHECK_NEAR(post.inertia[2], 2.0 / 12.0 * (0.06 * 0.06 + 0.02 * 0.02), 1e-15);
    se3d_model_destroy(model);
}

/* Both as one, by Steiner's theorem. */
static body_data join(const body_data *part)
{
    static const int row[6] = {0, 1, 2, 0, 1, 0};
    static const int column[6] = {0, 1, 2, 1, 2, 2};
    body_data sum;
    memset(&sum, 0, sizeof sum);
    sum.mass = part[0].mass + part[1].mass;
    for (int k = 0; k < 3; ++k) {
        sum.r[k] = (part[0].mass * part[0].r[k] + part[1].mass * part[1].r[k]) / sum.mass;
    }
    for (int n = 0; n < 2; ++n) {
        double d[3];
        for (int k = 0; k < 3; ++k) {
            d[k] = part[n].r[k] - sum.r[k];
        }
        const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        for (int k = 0; k < 6; ++k) {
            sum.inertia[k] += part[n].inertia[k] +
                              part[n].mass * ((k < 3 ? square : 0.0) - d[row[k]] * d[column[k]]);
        }
    }
    return sum;
}

static void an_arm_is_its_two_bars(void)
{
    se3d_model *model = read_text(
        "se3d: 1\npoints: {a: [0.2, 0, 0.3], b: [-0.2, 0.1, 0.3], c: [0, 0.6, 0.2]}\nbodies:\n"
        "  - {name: one, from: a, to: c, radius: 12 mm, wall: 2 mm, density: 7850}\n"
        "  - {name: two, from: b, to: c, radius: 12 mm, wall: 2 mm, density: 7850}\n"
        "  - {name: arm, from: a, from_2: b, to: c, radius: 12 mm, wall: 2 mm, density: 7850}\n");
    const body_data part[2] = {get(model, "one"), get(model, "two")};
    const body_data arm = get(model, "arm");
    const body_data sum = join(part);
    check_same(&arm, &sum, 1e-14);
    se3d_model_destroy(model);
}

/* A rectangle in any position is a box; a triangle is half of a parallelogram, with the closed form
 * of its second moments b h^3/36; four corners are two triangles. */
static void plates_weigh_as_closed_forms_say(void)
{
    se3d_model *model = read_text(
        "se3d: 1\nparameters: {u: \"[0.6, 0, 0.8]\", v: \"[0, 1, 0]\"}\n"
        "points: {o: [0.1, 0.2, 0.3], a: o + 0.3*u, b: o + 0.3*u + 0.2*v, c: o + 0.2*v}\nbodies:\n"
        "  - {name: rectangle, plate: [o, a, b, c], thickness: 10 mm, density: 2700}\n"
        "  - {name: backwards, plate: [c, b, a, o], thickness: 10 mm, density: 2700}\n"
        "  - {name: half, plate: [o, a, b], thickness: 10 mm, density: 2700}\n"
        "  - {name: other, plate: [o, b, c], thickness: 10 mm, density: 2700}\n"
        "  - {name: box, position: \"mid(o, b)\", density: 2700, shapes: [{type: box, size: [0.3, "
        "0.2, "
        "0.01], orientation: {axis: [0, 1, 0], angle: \"-atan2(0.8, 0.6)\"}}]}\n"
        "  - {name: right, plate: [[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0]], thickness: 0.01, density: "
        "1000}\n");
    const body_data rectangle = get(model, "rectangle");
    const body_data backwards = get(model, "backwards");
    const body_data box = get(model, "box");
    const body_data part[2] = {get(model, "half"), get(model, "other")};
    const body_data sum = join(part);
    const body_data right = get(model, "right");
    check_same(&rectangle, &box, 1e-14);
    check_same(&rectangle, &backwards, 1e-14);
    check_same(&rectangle, &sum, 1e-14);
    CHECK_NEAR(right.mass, 0.3, 1e-14);
    CHECK_NEAR(right.r[0], 0.1, 1e-15);
    CHECK_NEAR(right.r[1], 0.2 / 3.0, 1e-15);
    CHECK_NEAR(right.inertia[0], 10.0 * 0.3 * 0.008 / 36.0 + 0.3 * 1e-4 / 12.0, 1e-15);
    CHECK_NEAR(right.inertia[1], 10.0 * 0.2 * 0.027 / 36.0 + 0.3 * 1e-4 / 12.0, 1e-15);
    /* int x y = - b^2 h^2/72 about the centre; the entry of the matrix is its negative */
    CHECK_NEAR(right.inertia[3], 10.0 * 0.09 * 0.04 / 72.0, 1e-15);
    se3d_model_destroy(model);
}

/* The sum of the tetrahedra from the origin to the triangles. */
static double volume_of(const se3di_mesh *mesh)
{
    double volume = 0.0;
    for (size_t k = 0; k < mesh->triangle_count; ++k) {
        const double *a = mesh->points + 3 * (size_t)mesh->triangles[3 * k];
        const double *b = mesh->points + 3 * (size_t)mesh->triangles[3 * k + 1];
        const double *c = mesh->points + 3 * (size_t)mesh->triangles[3 * k + 2];
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6.0;
    }
    return volume;
}

/* The mesh of a plate bounds what the plate weighs: the sum of its tetrahedra, also mirrored. */
static void the_drawing_of_a_plate_is_closed(void)
{
    static const char *const names[] = {"l_gusset", "r_gusset"};
    se3d_model *model = read_text(
        "se3d: 1\nmaterials: [{name: steel, density: 7850, stiffness: 1e6}]\ncontact: {}\n"
        "parts:\n  side:\n    bodies: [{name: gusset, plate: [[0.1, 0.1, 0], [0.4, 0.1, 0.1], "
        "[0.4, 0.4, 0.1], [0.1, 0.5, 0]], thickness: 20 mm, material: steel}]\n"
        "instances: [{part: side, prefix: l_}, {part: side, prefix: r_, mirror: x}]\n");
    for (size_t k = 0; k < 2; ++k) {
        const body_data gusset = get(model, names[k]);
        const double side = sqrt(0.09 + 0.01);
        CHECK_NEAR(gusset.mass, 7850.0 * 0.02 * side * 0.5 * (0.4 + 0.3), 1e-12);
        CHECK_NEAR(fabs(gusset.r[0]), 0.1 + 0.3 * (0.4 + 2.0 * 0.3) / (3.0 * 0.7), 1e-14);
        CHECK((gusset.r[0] > 0.0) == (k == 0));
    }
    CHECK(se3d_model_count_shapes(model) == 2);
    for (size_t k = 0; k < 2; ++k) {
        const se3di_mesh *mesh = model->shapes[k].mesh;
        CHECK_NEAR(volume_of(mesh), 0.02 * sqrt(0.1) * 0.35, 1e-15);
    }
    se3d_model_destroy(model);
}

/* A bar on a mirrored side is the bar between the mirrored points. */
static void a_mirrored_bar_is_that_of_the_other_side(void)
{
    se3d_model *model = read_text(
        "se3d: 1\nparts:\n  side:\n    bodies:\n      - {name: rod, from: [0.1, 0.2, 0.3], to: "
        "[0.4, 0.7, 0.1], width: 30 mm, thickness: 5 mm, across: [0.1, 0.2, 1], density: 7850, "
        "body_to: ground}\n      - {name: web, plate: [[0.1, 0.2, 0.3], [0.4, 0.7, 0.1], [0, 1, "
        "0.2]], thickness: 4 mm, density: 2700}\ninstances:\n  - {part: side, prefix: l_}\n"
        "  - {part: side, prefix: r_, mirror: x}\nbodies:\n  - {name: rod, from: [-0.1, 0.2, 0.3], "
        "to: [-0.4, 0.7, 0.1], width: 30 mm, thickness: 5 mm, across: [-0.1, 0.2, 1], density: "
        "7850}\n  - {name: web, plate: [[-0.1, 0.2, 0.3], [-0.4, 0.7, 0.1], [0, 1, 0.2]], "
        "thickness: 4 mm, density: 2700}\n");
    static const char *const pairs[][2] = {{"r_rod", "rod"}, {"r_web", "web"}};
    for (size_t k = 0; k < 2; ++k) {
        const body_data right = get(model, pairs[k][0]);
        body_data same = get(model, pairs[k][1]);
        check_same(&right, &same, 1e-15); /* x is turned round: the axes stay those of the ground */
        CHECK(right.p[0] * right.p[0] == 1.0);
    }
    se3d_constraint ball;
    CHECK(!se3d_constraint_find(se3d_model_get_system(model), "r_rod_to", &ball));
    se3d_model_destroy(model);
}

static size_t count_equations(se3d_model *model, const char *name)
{
    se3d_constraint joint;
    size_t count = 0;
    CHECK(!se3d_constraint_find(se3d_model_get_system(model), name, &joint));
    CHECK(!se3d_constraint_count_equations(se3d_model_get_system(model), joint, &count));
    return count;
}

/* A slender bar on a ball swings like one on a universal joint: its spin hardly counts. */
static void ends_have_joints(void)
{
    static const char *const spins[] = {"removed", "kept"};
    double end[2][3];
    for (int k = 0; k < 2; ++k) {
        char text[1200];
        double r[3];
        se3d_body body;
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.tolerance = 1e-10;
        snprintf(text, sizeof text,
                 "se3d: 1\npoints: {a: [0, 0, 0], b: [0.3, 0.2, -0.4], c: [0.3, 0.9, -0.4]}\n"
                 "bodies:\n  - {name: bar, from: a, to: b, radius: 8 mm, density: 7850, body_from: "
                 "ground, body_to: next, spin: %s}\n  - {name: next, from: b, to: c, radius: 8 mm, "
                 "density: 7850}\n  - {name: arm, from: [1, 0, 0], from_2: [2, 0, 0], to: [1.5, 1, "
                 "0], radius: 8 mm, density: 7850, body_from: ground}\n",
                 spins[k]);
        se3d_model *model = read_text(text);
        se3d_system *system = se3d_model_get_system(model);
        CHECK(count_equations(model, "bar_from") == (k ? 3u : 4u));
        CHECK(count_equations(model, "bar_to") == 3);
        CHECK(count_equations(model, "arm_from") == 5);
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.7) >= 0);
        CHECK(!se3d_body_find(system, "next", &body));
        CHECK(!se3d_body_get_position(system, body, end[k]));
        CHECK(!se3d_body_find(system, "bar", &body));
        CHECK(!se3d_body_get_position(system, body, r));
        CHECK_NEAR(r[0] * r[0] + r[1] * r[1] + r[2] * r[2], 0.25 * 0.29, 1e-12);
        CHECK(!se3d_body_find(system, "arm", &body));
        CHECK(!se3d_body_get_position(system, body, r));
        CHECK_NEAR(r[0], 1.5, 1e-12);
        CHECK(r[2] < -0.1);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(end[0][k], end[1][k], 1e-3);
    }
}

/* A rod that falls on a plate stays there, unless it says that nothing touches it. */
static void bars_touch_by_their_material(void)
{
    static const char *const says[] = {"", ", contact: false"};
    for (int k = 0; k < 2; ++k) {
        char text[800];
        double r[3];
        se3d_body body;
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        snprintf(
            text, sizeof text,
            "se3d: 1\ncontact: {}\nmaterials: [{name: steel, density: 1000, stiffness: 1e5, "
            "restitution: 0.1}]\nbodies:\n  - {name: table, fixed: true, plate: [[-1, -1, 0], [1, "
            "-1, 0], [1, 1, 0], [-1, 1, 0]], thickness: 0.2, material: steel}\n"
            "  - {name: rod, from: [-0.5, 0, 0.21], to: [0.5, 0, 0.21], radius: 0.1, material: "
            "steel%s}\n",
            says[k]);
        se3d_model *model = read_text(text);
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.5) >= 0);
        CHECK(!se3d_body_find(system, "rod", &body));
        CHECK(!se3d_body_get_position(system, body, r));
        CHECK(k == 0 ? r[2] > 0.19 && r[2] < 0.22 : r[2] < -0.9);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

/* A chain of bars by number, each on the one before: names with braces, and prefixes. */
static void repeated_bars_find_each_other(void)
{
    se3d_model *model = read_text(
        "se3d: 1\nparts:\n  link:\n    bodies:\n      - {name: bar, from: [i, 0, 0], to: [i + 1, "
        "0, "
        "0], radius: 1 cm, density: 1000, body_from: \"link{i - 1}_bar\", spin: kept, when: i > "
        "0}\n"
        "      - {name: bar, from: [0, 0, 0], to: [1, 0, 0], radius: 1 cm, density: 1000, "
        "body_from: ground, when: i == 0}\ninstances: [{part: link, prefix: \"link{i}_\", repeat: "
        "4}]\n");
    CHECK(count_equations(model, "link0_bar_from") == 4);
    CHECK(count_equations(model, "link3_bar_from") == 3);
    se3d_model_destroy(model);
}

int main(void)
{
    RUN(bars_weigh_what_their_shapes_weigh);
    RUN(an_upright_bar_has_its_width_along_x);
    RUN(an_arm_is_its_two_bars);
    RUN(plates_weigh_as_closed_forms_say);
    RUN(the_drawing_of_a_plate_is_closed);
    RUN(a_mirrored_bar_is_that_of_the_other_side);
    RUN(ends_have_joints);
    RUN(bars_touch_by_their_material);
    RUN(repeated_bars_find_each_other);
    return check_finish();
}
