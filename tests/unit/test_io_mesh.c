/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes of model files: STL in both forms and OBJ give the same surface; broken files are refused
 * with the place. */
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/scratch.h"

#define MODEL(file)                                                                                \
    "se3d: 1\ncontact: {}\nmaterials: [{name: m, density: 1, stiffness: 1}]\n"                     \
    "bodies: [{name: b, fixed: true, shapes: [{type: mesh, name: s, material: m, scale: 0.5, "     \
    "file: " file "}]}]\n"

static const char ascii[] =
    "solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 2\n   vertex 2.0e0 0 2\n"
    "   vertex 0 20E-1 +2.0\n  endloop\n endfacet\n facet normal 0 0 1\r\n  outer loop\n"
    "   vertex 2 0 2\n   vertex 2 2 2\n   vertex 0 2 2\n  endloop\n endfacet\nendsolid part\n";
static const char obj[] = "# a square\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\nvn 0 0 1\nvt 0 0\n"
                          "f 1//1 2/1/1 -2 4/1\n";

static size_t binary(unsigned char *bytes, float x)
{
    const float points[18] = {0, 0, 2, 2, 0, 2, 0, 2, 2, 2, 0, 2, x, 2, 2, 0, 2, 2};
    memset(bytes, 0, 184);
    bytes[80] = 2;
    for (int k = 0; k < 2; ++k) {
        memcpy(bytes + 84 + 50 * k + 12, points + 9 * k, 36);
    }
    return 184;
}

static void stl_and_obj_give_the_same_surface(void)
{
    unsigned char bytes[200];
    const char *const texts[3] = {MODEL("se3d_test_mesh.stl"), MODEL("se3d_test_mesh_b.STL"),
                                  MODEL("se3d_test_mesh.obj")};
    scratch_write("se3d_test_mesh.stl", ascii, sizeof ascii - 1);
    scratch_write("se3d_test_mesh_b.STL", bytes, binary(bytes, 2.0f));
    scratch_write("se3d_test_mesh.obj", obj, sizeof obj - 1);
    for (int k = 0; k < 3; ++k) {
        se3d_model_error error = {0, 0, ""};
        se3d_model *model = scratch_read_model(texts[k], &error);
        if (!model) {
            fprintf(stderr, "%s\n", error.message);
            CHECK(model != NULL);
            continue;
        }
        se3d_system *system = se3d_model_get_system(model);
        se3d_shape shape;
        const double above[3] = {0.3, 0.8, 1.25}, beside[3] = {1.5, 1.0, 1.0};
        double point[3], normal[3], distance;
        CHECK(se3d_shape_find(system, "s", &shape) == SE3D_OK);
        CHECK(se3d_shape_get_nearest(system, shape, above, point, normal, &distance) == SE3D_OK);
        CHECK_NEAR(distance, 0.25, 1e-15);
        CHECK_NEAR(normal[2], 1.0, 1e-15);
        CHECK(se3d_shape_get_nearest(system, shape, beside, point, normal, &distance) == SE3D_OK);
        CHECK_NEAR(distance, 0.5, 1e-15);
        CHECK_NEAR(point[0], 1.0, 1e-15);
        se3d_model_destroy(model);
    }
    scratch_remove("se3d_test_mesh.stl");
    scratch_remove("se3d_test_mesh_b.STL");
    scratch_remove("se3d_test_mesh.obj");
}

static void refuse(const char *name, const char *text, const void *bytes, size_t size,
                   const char *part)
{
    se3d_model_error error = {0, 0, ""};
    if (bytes) {
        scratch_write(name, bytes, size);
    }
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(!model);
    CHECK(error.line == 4);
    CHECK_CONTAINS(error.message, "shapes[0]");
    CHECK_CONTAINS(error.message, part);
    se3d_model_destroy(model);
    scratch_remove(name);
}

static void broken_files_are_refused_with_their_place(void)
{
    static const struct {
        const char *text, *part;
    } objects[] = {{"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: a face must name"},
                   {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "line 4"},
                   {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "line 4"},
                   {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "line 4"},
                   {"v 0 0 0\nv 1 0\nv 0 1 0\n", "line 2: must have three numbers"},
                   {"v 0 0 nan\n", "line 1: must have three numbers"},
                   {"v 0 0 1e999\n", "line 1: a coordinate is not a finite"},
                   {"v 0 0 0\nf 1 1\n", "line 2: a face must have three"},
                   {"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "area"},
                   {"# nothing\n", "no triangles"}};
    const char *model = MODEL("se3d_test_bad.obj");
    for (size_t k = 0; k < sizeof objects / sizeof *objects; ++k) {
        refuse("se3d_test_bad.obj", model, objects[k].text, strlen(objects[k].text),
               objects[k].part);
    }
    refuse("se3d_test_bad.obj", model, NULL, 0, "cannot be opened");
    refuse("se3d_test_bad.obj", model, "", 0, "is empty");
    model = MODEL("se3d_test_bad.stl");
    refuse("se3d_test_bad.stl", model, ascii, 100, "ends in a facet");
    refuse("se3d_test_bad.stl", model, "solid\nvertex 1 2 3\nendloop\n", 27, "line 3: a facet");
    refuse("se3d_test_bad.stl", model, "something", 9, "neither");
    unsigned char bytes[200];
    size_t size = binary(bytes, 2.0f);
    refuse("se3d_test_bad.stl", model, bytes, size - 1, "neither"); /* truncated */
    memset(bytes + 80, 0xff, 4);
    refuse("se3d_test_bad.stl", model, bytes, size, "neither"); /* a huge count */
    size = binary(bytes, HUGE_VALF);
    refuse("se3d_test_bad.stl", model, bytes, size, "line 2: a coordinate is not a finite");
    refuse("se3d_test_bad.txt", MODEL("se3d_test_bad.txt"), "v", 1, "must end in .stl or .obj");
}

static void a_mesh_that_only_is_seen_is_read_with_the_model(void)
{
    static const char text[] = "se3d: 1\nbodies:\n  - name: b\n    shapes: [{type: mesh, file: "
                               "se3d_test_seen.obj, scale: 1e40}]\n";
    static const struct {
        const char *obj, *part;
    } files[] = {
        {NULL, "`se3d_test_seen.obj`: the file cannot be opened"},
        {"v 0 0 0\nv 1 0 0\nv 0 1e280 0\nf 1 2 3\n", "line 3: a coordinate is not a finite"},
        {"v 0 0 0\nv 1 0 0\nf 1 2 3\n", "line 3: a face must name"}};
    for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
        refuse("se3d_test_seen.obj", text, files[k].obj, files[k].obj ? strlen(files[k].obj) : 0,
               files[k].part);
    }
}

static const char cube[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/* A cube of 2 kg on a larger one that is fixed. */
static se3d_model *cubes(const char *below, const char *above)
{
    char text[900];
    se3d_model_error error = {0};
    snprintf(
        text, sizeof text,
        "se3d: 1\ngravity: [0, 0, -10]\ncontact: {}\n"
        "materials: [{name: m, density: 1000, stiffness: 1e5, restitution: 0.3}]\n"
        "bodies:\n  - {name: table, fixed: true, shapes: [{type: mesh, name: low, material: m, "
        "file: se3d_test_cube.obj, scale: 4, position: [-2, -2, -4]%s}]}\n"
        "  - {name: b, mass: 2, inertia: [0.5, 0.5, 0.5], position: [0, 0, 0.49995], shapes: "
        "[{type: mesh, name: high, material: m, file: se3d_test_cube.obj, position: "
        "[-0.5, -0.5, -0.5]%s}]}\n"
        "analysis: {type: dynamics, duration: 0.5}\n",
        below, above);
    se3d_model *model = scratch_read_model(text, &error);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
    }
    return model;
}

/* The hull of a mesh rests on a mesh and on a hull, and convex meshes on each other; others pass
 * each other (those of five faces, the last), and a check says so. */
static void convex_meshes_touch_meshes(void)
{
    static const char *const keys[5][2] = {{", convex: true", ", convex: true"},
                                           {", convex: true", ""},
                                           {"", ", convex: true"},
                                           {"", ""},
                                           {"", ""}};
    for (int k = 0; k < 5; ++k) {
        const size_t last = sizeof "f 2 4 8 6\n" - 1;
        scratch_write("se3d_test_cube.obj", cube, sizeof cube - 1 - (k == 4 ? last : 0));
        se3d_model *model = cubes(keys[k][0], keys[k][1]);
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        se3d_check *check = NULL;
        se3d_body body;
        double force[3], torque[3];
        const char *message = "";
        CHECK(model != NULL);
        se3d_system *system = model ? se3d_model_get_system(model) : NULL;
        if (!system) {
            break;
        }
        CHECK(se3d_check_create(system, &check) >= 0);
        for (size_t n = 0; n < se3d_check_count_messages(check); ++n) {
            const char *text = "";
            CHECK(se3d_check_get_message(check, n, &text) == SE3D_OK);
            message = strstr(text, "pass through") ? text : message;
        }
        if (k == 4) {
            CHECK_CONTAINS(message, "the meshes low and high pass through each other");
        } else {
            CHECK(strlen(message) == 0);
        }
        se3d_check_destroy(check);
        CHECK(se3d_body_find(system, "b", &body) == SE3D_OK);
        CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.5) >= 0);
        CHECK(se3d_body_get_contact_wrench(system, body, force, torque) == SE3D_OK);
        CHECK_NEAR(force[2], k < 4 ? 20.0 : 0.0, 1e-2);
        CHECK(se3d_system_count_contacts(system) == (k < 4 ? 4 : 0));
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
    scratch_remove("se3d_test_cube.obj");
}

int main(void)
{
    RUN(convex_meshes_touch_meshes);
    RUN(a_mesh_that_only_is_seen_is_read_with_the_model);
    RUN(stl_and_obj_give_the_same_surface);
    RUN(broken_files_are_refused_with_their_place);
    return check_finish();
}
