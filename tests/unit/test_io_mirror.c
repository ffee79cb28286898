/* SPDX-License-Identifier: BSD-3-Clause */
/* Mirrored parts with the joints, forces and shapes that know left and right: they move as
 * a mirror shows the given ones, without contacts to the last bit. */
#define _POSIX_C_SOURCE 200809L

#include <sys/stat.h>

#include "check.h"
#include "se3d/io.h"
#include "support/scratch.h"

static const char machine[] =
    "se3d: 1\n"
    "parameters: {g: 1}\n"
    "points: {a: [0.3, 0.2, 0.1], b: [0.5, -0.4, 0.7], c: [-0.2, 0.6, 0.4]}\n"
    "bodies:\n"
    "  - {name: b1, mass: 2, inertia: [0.3, 0.4, 0.5, 0.01, 0.02, -0.03], position:\n"
    "      a, orientation: {rpy: [0.3, -0.5, 0.7]}, velocity: [0.1, 0.2, 0.3],\n"
    "      angular_velocity: [0.4, -0.2, 0.6], markers: [{name: m, position: [0.1,\n"
    "      0.2, 0.3], orientation: {rpy: [0.1, 0.2, 0.3]}}, {name: n, at: b}]}\n"
    "  - {name: b2, mass: 3, inertia: [0.5, 0.4, 0.6, 0.03, -0.02, 0.01], position:\n"
    "      b, orientation: {axis: [1, 2, 3], angle: 0.8}, velocity: [-0.1, 0.1,\n"
    "      0.2]}\n"
    "  - {name: b3, mass: 1, inertia: [0.5, 0.4, 0.6], position: c, orientation:\n"
    "      {rpy: [1, 0.4, -0.2]}}\n"
    "  - {name: b4, mass: 1, inertia: [0.5, 0.4, 0.6], position: [2, 1, 0],\n"
    "      orientation: {rpy: [1, 0.4, -0.2]}}\n"
    "  - {name: b5, mass: 1, inertia: [0.5, 0.4, 0.6], position: [3, 1, 0],\n"
    "      orientation: {rpy: [0.2, 0.4, -0.2]}}\n"
    "  - {name: b6, mass: 1, inertia: [0.2, 0.3, 0.4], position: [2, 1, 1]}\n"
    "  - {name: b7, mass: 1, inertia: [0.2, 0.3, 0.4], position: [2, 2, 1]}\n"
    "  - {name: b8, mass: 1, inertia: [0.2, 0.3, 0.4], position: [4, 2, 1],\n"
    "      orientation: {rpy: [0.2, 0.4, -0.2]}}\n"
    "  - {name: b9, mass: 1, inertia: [0.2, 0.3, 0.4], position: [4, 3, 1],\n"
    "      orientation: {rpy: [0.5, 0.1, -0.2]}}\n"
    "joints:\n"
    "  - {name: uni, type: universal, body_i: b4, body_j: b5, at: [2.5, 1, 0],\n"
    "      axis: [0, 1, 0], axis_2: [0, 0, 1]}\n"
    "  - {name: rev, type: revolute, body_i: ground, body_j: b4, at: [2, 1.3, 0.2],\n"
    "      axis: [1, 2, 0.5], ref: [2, -1, 0], angle0: 0.2}\n"
    "  - {name: scr, type: screw, body_i: ground, body_j: b6, at: [2, 1, 1.2],\n"
    "      axis: [1, 1, 2], pitch: 0.05}\n"
    "  - {name: cyl, type: cylindrical, body_i: ground, body_j: b7, at: [2, 2.1,\n"
    "      1.2], axis: [0.3, 1, 2]}\n"
    "  - {name: uc, type: revolute_cylindrical, body_i: ground, body_j: b8, at: [4,\n"
    "      2, 1.5], axis: [1, 0, 0], at_2: [4, 2.5, 1.5], axis_2: [0, 0, 1],\n"
    "      distance: 0.5}\n"
    "  - {name: fx, type: fixed, body_i: b8, body_j: b9, point_i: [0.1, 0.2, 0.3],\n"
    "      axis_i: [1, 2, 3], point_j: [0.4, 0.1, 0.1], axis_j: [0, 0.2, 1], ref_i:\n"
    "      [2, -1, 0], ref_j: [1, 0, 0]}\n"
    "constraints:\n"
    "  - {name: d1, type: dp1, body_i: b1, body_j: b3, a_i: [1, 0.2, 0], a_j: [0.1,\n"
    "      0.1, 1], value: -0.1996780432050989}\n"
    "forces:\n"
    "  - {name: bu, type: bushing, body_i: ground, body_j: b1, at: a, orientation:\n"
    "      {rpy: [0.2, 0.3, 0.4]}, K: [[100, 10, 20, 5, 6, 7], [10, 150, 30, 8, 9,\n"
    "      4], [20, 30, 200, 3, 2, 1], [5, 8, 3, 50, 2, 4], [6, 9, 2, 2, 60, 5],\n"
    "      [7, 4, 1, 4, 5, 70]], C: [[1, 0.1, 0.2, 0.3, 0.4, 0.5], [0.1, 2, 0.1,\n"
    "      0.2, 0.3, 0.4], [0.1, 0.2, 3, 0.1, 0.2, 0.3], [0.3, 0.1, 0.2, 1, 0.2,\n"
    "      0.1], [0.1, 0.3, 0.2, 0.1, 2, 0.1], [0.2, 0.1, 0.2, 0.3, 0.1, 1]]}\n"
    "  - {name: bv, type: bushing, body_i: b1, body_j: b2, point_i: [0.1, 0.2,\n"
    "      0.3], point_j: [0.3, 0.2, 0.1], orientation_i: {rpy: [0.2, 0.1, 0.3]},\n"
    "      orientation_j: {rpy: [0.1, 0.4, 0.3]}, K: [[100, 10, 20, 5, 6, 7], [10,\n"
    "      150, 30, 8, 9, 4], [20, 30, 200, 3, 2, 1], [5, 8, 3, 50, 2, 4], [6, 9,\n"
    "      2, 2, 60, 5], [7, 4, 1, 4, 5, 70]]}\n"
    "  - {name: rs, type: rsda, body_i: b1, body_j: b3, axis: [1, 0, 0.3], k: 5, c:\n"
    "      0.3, theta0: 0.1, h: \"sin(3*t)\"}\n"
    "  - {name: rt, type: rsda, joint: rev, k: 5, c: 0.3, theta0: 0.1}\n"
    "  - {name: fr, type: friction, joint: rev, mu: 0.2, radius: 0.1}\n"
    "  - {name: ef, type: effort, joint: scr, coordinate: displacement, value: \"3 -\n"
    "      2*q + sin(t)\"}\n"
    "  - {name: eg, type: effort, joint: cyl, coordinate: displacement, value: \"3 -\n"
    "      2*q\"}\n"
    "  - {name: st, type: stop, joint: rev, k: 100, upper: 0.25}\n"
    "  - {name: lo, type: force, body: b2, frame: body, point: [0.1, 0.2, 0.3],\n"
    "      value: [1, \"2*t\", 3]}\n"
    "  - {name: to, type: torque, body: b3, value: [\"sin(t)\", 1, 2]}\n"
    "  - {name: tp, type: torque, body: b2, frame: body, value: [\"sin(t)\", 1, 2]}\n"
    "  - {name: ts, type: tsda, body_i: b2, point_i: [0.1, 0.3, 0.2], body_j: b9,\n"
    "      at_2: [4, 3.5, 1.2], k: 30, c: 1}\n";
static const char shapes[] =
    "se3d: 1\n"
    "parameters: {g: 1}\n"
    "bodies:\n"
    "  - {name: ground, shapes: [{type: plane, position: [0, 0, -1], orientation:\n"
    "      {rpy: [0.1, 0.2, 0.3]}, group: g, mask: g, material: m}, {type: mesh,\n"
    "      file: se3d_tet.obj, position: [1, 0.3, 0], orientation: {rpy: [0.3,\n"
    "      -0.4, 0.5]}, group: g, mask: g, material: m}, {type: plane, position:\n"
    "      [0, -2, 0], normal: [0.2, 1, 0.1], group: g, mask: g, material: m}]}\n"
    "  - {name: s, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.1, -1.6, -0.3],\n"
    "      velocity: [1, -1, -1], angular_velocity: [3, 2, 1], shapes: [{type: box,\n"
    "      size: [0.3, 0.2, 0.5], position: [0.1, 0.05, 0], orientation: {rpy:\n"
    "      [0.2, 0.3, 0.1]}, group: g, mask: g, material: m}]}\n"
    "  - {name: u, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1.1, 0.4, 1],\n"
    "      velocity: [0, 0, -3], shapes: [{type: sphere, radius: 0.2, group: g,\n"
    "      mask: g, material: m}]}\n"
    "  - {name: v, position: [5, 5, 5], velocity: [1, 0, 0], angular_velocity: [1,\n"
    "      2, 0.4], shapes: [{type: mesh, file: se3d_tetc.obj, density: 100,\n"
    "      convex: true, group: g, mask: g, material: m}]}\n"
    "  - {name: w, mass: 1, inertia: [0.1, 0.1, 0.1], position: [5.6, 5.1, 5.05],\n"
    "      shapes: [{type: capsule, radius: 0.1, length: 0.3, orientation: {rpy:\n"
    "      [0.7, 0.2, 0]}, group: g, mask: g, material: m}]}\n";
static const char tet[] = "v 0 0 0\n"
                          "v 1 0.2 0\n"
                          "v 0.1 0.8 0\n"
                          "v 0.2 0.3 0.6\n"
                          "f 1 3 2\n"
                          "f 1 2 4\n"
                          "f 2 3 4\n"
                          "f 3 1 4\n";
static const char tetc[] = "v -0.32500000000000001 -0.32500000000000001 -0.14999999999999999\n"
                           "v 0.67500000000000004 -0.125 -0.14999999999999999\n"
                           "v -0.22500000000000001 0.47500000000000003 -0.14999999999999999\n"
                           "v -0.125 -0.025000000000000022 0.44999999999999996\n"
                           "f 1 3 2\n"
                           "f 1 2 4\n"
                           "f 2 3 4\n"
                           "f 3 1 4\n";

enum { CHANNELS_MAX = 20 };

static void run(const char *text, double duration, size_t count, double values[][4])
{
    se3d_model_error error = {0};
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(model != NULL);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    CHECK(!se3d_model_get_solver(model, 0, &def));
    CHECK(!se3d_solver_create(se3d_model_get_system(model), &def, &solver));
    CHECK(se3d_solver_run(solver, duration) >= 0);
    for (size_t k = 0; k < count; ++k) {
        size_t width = 0;
        CHECK(!se3d_model_get_channel_value(model, 0, k, NULL, values[k], &width));
    }
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

/* Positions of bodies, then numbers that the mirror does not change; first of the given part. */
static void check_mirrored(const char *middle, const char *const channels[], size_t bodies,
                           size_t count, double tolerance)
{
    for (size_t axis = 0; axis < 3; ++axis) {
        char text[4000];
        double values[2 * CHANNELS_MAX][4] = {{0.0}};
        int used =
            snprintf(text, sizeof text,
                     "se3d: 1\ngravity: [0, 0, 0]\n%sinclude:\n"
                     "  - {file: se3d_zoo.yaml, prefix: l_}\n"
                     "  - {file: se3d_zoo.yaml, prefix: r_, mirror: %c, parameters: {g: 2}}\n"
                     "analysis: {type: dynamics, duration: 0.4}\n"
                     "output: [{file: x.csv, channels: [",
                     middle, "xyz"[axis]);
        for (size_t k = 0; k < 2 * count; ++k) {
            used += snprintf(text + used, sizeof text - (size_t)used, "%s%s_%s", k > 0 ? ", " : "",
                             k < count ? "l" : "r", channels[k % count]);
        }
        snprintf(text + used, sizeof text - (size_t)used, "]}]\n");
        run(text, 0.4, 2 * count, values);
        for (size_t k = 0; k < count; ++k) {
            double *mirrored = values[count + k];
            if (k < bodies) {
                mirrored[axis] = 0.0 - mirrored[axis];
            }
            for (size_t i = 0; i < (k < bodies ? 3 : 1); ++i) {
                CHECK_NEAR(mirrored[i], values[k][i], tolerance);
            }
            CHECK(fabs(values[k][0]) > 1e-6);
        }
    }
}

static void mirrored_joints_and_forces_act_as_the_given_ones(void)
{
    static const char *const channels[] = {
        "b1.position", "b2.position",   "b3.position",      "b4.position",
        "b5.position", "b6.position",   "b7.position",      "b8.position",
        "b9.position", "b1.m.position", "b1.n.position",    "rev.angle",
        "rs.torque",   "fr.force",      "scr.displacement", "cyl.displacement",
    };
    scratch_write("se3d_zoo.yaml", machine, sizeof machine - 1);
    check_mirrored("", channels, 11, sizeof channels / sizeof *channels, 0.0);
}

static void mirrored_planes_and_meshes_touch_as_the_given_ones(void)
{
    static const char *const channels[] = {"s.position", "u.position", "v.position", "w.position"};
    scratch_write("se3d_zoo.yaml", shapes, sizeof shapes - 1);
    scratch_write("se3d_tet.obj", tet, sizeof tet - 1);
    scratch_write("se3d_tetc.obj", tetc, sizeof tetc - 1);
    check_mirrored("materials: [{name: m, density: 1000, stiffness: 1e4, friction: 0.3}]\n"
                   "contact: {}\n",
                   channels, 4, 4, 1e-12);
}

/* Densities of materials are in the units and over the parameters of the model. */
static void materials_are_those_of_the_model(void)
{
    static const char part[] = "se3d: 1\nunits: {length: mm}\nparameters: {rho: 1}\nbodies:\n"
                               "  - {name: b, shapes: [{type: box, size: [100, 100, 100],\n"
                               "     material: steel}]}\n";
    static const char text[] = "se3d: 1\nparameters: {rho: 7850}\n"
                               "materials: [{name: steel, density: rho}]\n"
                               "include: [{file: se3d_zoo.yaml}]\n";
    se3d_model_error error = {0};
    se3d_body body;
    double mass = 0.0;
    double inertia[6];
    scratch_write("se3d_zoo.yaml", part, sizeof part - 1);
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(model != NULL);
    if (model) {
        CHECK(!se3d_body_find(se3d_model_get_system(model), "b", &body));
        CHECK(!se3d_body_get_mass(se3d_model_get_system(model), body, &mass, inertia));
        CHECK_NEAR(mass, 7.85, 1e-14);
    }
    se3d_model_destroy(model);
}

/* Not in those of the file that uses it. */
static void a_part_has_the_units_of_its_own_file(void)
{
    static const char user[] = "se3d: 1\ninstances: [{part: link}]\n";
    static const char text[] = "se3d: 1\nunits: {length: mm}\nparts: {link: {bodies: [\n"
                               "  {name: b, fixed: true, position: [500, 0, 0]}]}}\n"
                               "include: [{file: se3d_zoo.yaml}]\n";
    se3d_model_error error = {0};
    se3d_body body;
    double r[3] = {0.0};
    scratch_write("se3d_zoo.yaml", user, sizeof user - 1);
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(model != NULL);
    if (model) {
        CHECK(!se3d_body_find(se3d_model_get_system(model), "b", &body));
        CHECK(!se3d_body_get_position(se3d_model_get_system(model), body, r));
        CHECK_NEAR(r[0], 0.5, 1e-16);
    }
    se3d_model_destroy(model);
}

#define FREE "bodies: [{name: o, mass: 1, inertia: [1, 1, 1]}]\n"
#define B    "  {name: b, mass: 1, inertia: [1, 1, 1]}]\n"

static void what_a_mirror_or_a_limit_forbids_is_told(void)
{
    static const struct {
        const char *part, *text, *wanted;
    } table[] = {
        {"bodies: [\n" B "joints: [{name: c, type: cylindrical, body_i: ground, body_j: b,\n"
         "  at: [0, 0, 0], axis: [1, 0, 0]}]\nforces: [{type: rsda, joint: c, k: 1}]\n",
         "include: [{file: se3d_zoo.yaml, mirror: y}]", "uses the angle of `c`"},
        {"forces: [{type: force, body: o, frame: body, value: [1, 0, 0]}]\n",
         FREE "include: [{file: se3d_zoo.yaml, mirror: y}]", "is said in the frame of `o`"},
        {"bodies: [\n" B "forces: [{type: bushing, body_i: o, body_j: b, K: [1, 1, 1, 1, 1, 1]}]\n",
         FREE "include: [{file: se3d_zoo.yaml, mirror: y}]", "is said in the frame of `o`"},
        {"bodies: [\n" B "parts: {p: {forces: [{type: force, body: b, point: [0, 1, 0],\n"
         "  value: [1, 0, 0]}]}}\ninstances: [{part: p, mirror: x}]\n",
         "include: [{file: se3d_zoo.yaml, mirror: y}]", "is said in the frame of `b`"},
        {"bodies: [\n" B "forces: [{type: force, body: b, value: [0, 0, no(t)]}]\n",
         "include: [{file: se3d_zoo.yaml, mirror: y}]", "zoo.yaml:4:47: forces[0].value[2]"},
        {"bodies: [{name: ound, fixed: true}]\n", "include: [{file: se3d_zoo.yaml, prefix: gr}]",
         "is that of the ground"},
        {"include: [{file: se3d_zoo/../se3d_zoo.yaml}]\n", "include: [{file: se3d_zoo.yaml}]",
         "17 levels deep, at most 16"},
        {"include: [{file: se3d_zoo/../se3d_zoo.yaml}, {file: ./se3d_zoo.yaml}]\n",
         "include: [{file: se3d_zoo.yaml}]", "more than 1000 files"},
        {"", "parts: {p: {}}\ninstances: [{part: p, repeat: 1e5}, {part: p}]",
         "instances[1]: makes more than 100000 parts"},
        {"",
         "parts: {q: {}, p: {instances: [{part: q, index: j, repeat: 1e5, when: false}]}}\n"
         "instances: [{part: p, repeat: 9e4}]",
         "makes more than 100000 parts"},
    };
    (void)mkdir(scratch_path("se3d_zoo"), 0700);
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        char text[800];
        se3d_model_error error = {0};
        snprintf(text, sizeof text, "se3d: 1\n%s", table[k].part);
        scratch_write("se3d_zoo.yaml", text, strlen(text));
        snprintf(text, sizeof text, "se3d: 1\n%s\n", table[k].text);
        se3d_model *model = scratch_read_model(text, &error);
        CHECK(model == NULL);
        CHECK_CONTAINS(error.message, table[k].wanted);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(mirrored_joints_and_forces_act_as_the_given_ones);
    RUN(mirrored_planes_and_meshes_touch_as_the_given_ones);
    RUN(materials_are_those_of_the_model);
    RUN(a_part_has_the_units_of_its_own_file);
    RUN(what_a_mirror_or_a_limit_forbids_is_told);
    scratch_remove("se3d_zoo.yaml");
    scratch_remove("se3d_zoo");
    scratch_remove("se3d_tet.obj");
    scratch_remove("se3d_tetc.obj");
    return check_finish();
}
