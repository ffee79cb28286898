/* SPDX-License-Identifier: BSD-3-Clause */
/* Mass, centre and inertia of closed meshes against closed forms; surfaces that enclose no solid
 * are refused with the edge. */
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/scratch.h"

#define FILE_NAME(end) "se3d_test_solid" end
#define BODY(shape, file)                                                                          \
    "se3d: 1\nbodies:\n  - name: b\n    density: 3\n    shapes: [{type: mesh, file: " file         \
    ", " shape "}]\n"

static const double pi = 3.14159265358979323846;

static void write_obj(const char *text)
{
    scratch_write(FILE_NAME(".obj"), text, strlen(text));
}

static void remove_files(void)
{
    scratch_remove(FILE_NAME(".obj"));
    scratch_remove(FILE_NAME(".stl"));
}

static void expect(const char *text, double mass, const double inertia[6], double tolerance)
{
    se3d_model_error error = {0, 0, ""};
    se3d_body body;
    double m = 0.0;
    double J[6] = {0.0};
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(model != NULL);
    if (!model) {
        fprintf(stderr, "%s\n", error.message);
        return;
    }
    CHECK(se3d_body_find(se3d_model_get_system(model), "b", &body) == SE3D_OK);
    CHECK(se3d_body_get_mass(se3d_model_get_system(model), body, &m, J) == SE3D_OK);
    CHECK_NEAR(m, mass, tolerance * mass);
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(J[k], inertia[k], tolerance * inertia[0]);
    }
    se3d_model_destroy(model);
}

static void refuse(const char *obj, const char *shape, const char *part)
{
    char text[400];
    se3d_model_error error = {0, 0, ""};
    write_obj(obj);
    snprintf(text, sizeof text, BODY("%s", FILE_NAME(".obj")), shape);
    se3d_model *model = scratch_read_model(text, &error);
    CHECK(!model);
    CHECK(error.line == 5);
    CHECK_CONTAINS(error.message, part);
    se3d_model_destroy(model);
    remove_files();
}

#define BOX_POINTS "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 4\nv 1 0 4\nv 1 2 4\nv -0 2 4\n"
#define BOX_SIDES  "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
#define BOX        BOX_POINTS "f 4 3 2 1\nf 5 6 7 8\n" BOX_SIDES

/* 1 x 2 x 4 of density 3: 24 kg. */
static const double box_inertia[6] = {
    24.0 * 20.0 / 12.0, 24.0 * 17.0 / 12.0, 24.0 * 5.0 / 12.0, 0.0, 0.0, 0.0};

static void a_box_of_triangles_weighs_what_the_box_does(void)
{
    write_obj(BOX);
    expect(BODY("position: [-0.5, -1, -2]", FILE_NAME(".obj")), 24.0, box_inertia, 1e-14);
    /* Turned: the file's x is the body's y, y is z, z is x. */
    expect(BODY("position: [-2, -0.5, -1], orientation: {euler_parameters: [0.5, 0.5, 0.5, 0.5]}",
                FILE_NAME(".obj")),
           24.0, (double[6]){box_inertia[2], box_inertia[0], box_inertia[1], 0.0, 0.0, 0.0}, 1e-14);
    /* A tenth as long: a thousandth of the mass. */
    expect(BODY("position: [-0.05, -0.1, -0.2], scale: 0.1", FILE_NAME(".obj")), 0.024,
           (double[6]){4e-4, 3.4e-4, 1e-4, 0.0, 0.0, 0.0}, 1e-13);
    /* The shape's density comes before the body's. */
    expect(BODY("position: [-0.5, -1, -2], density: 6", FILE_NAME(".obj")), 48.0,
           (double[6]){80.0, 68.0, 20.0, 0.0, 0.0, 0.0}, 1e-14);
    /* All inside out: it bounds the same solid. */
    write_obj(BOX_POINTS "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n");
    expect(BODY("position: [-0.5, -1, -2]", FILE_NAME(".obj")), 24.0, box_inertia, 1e-14);
    remove_files();
}

static void solids_add_up_about_the_origin(void)
{
    /* Two boxes that touch along an edge, in one file: 24 kg each, 1 m and 2 m off on x and y. */
    write_obj(BOX
              "v 2 4 0\nv 2 2 4\nv 2 4 4\nv 1 4 0\nv 1 4 4\nv 2 2 0\n"
              "f 12 9 14 3\nf 7 10 11 13\nf 3 14 10 7\nf 14 9 11 10\nf 9 12 13 11\nf 12 3 7 13\n");
    expect(BODY("position: [-1, -2, -2]", FILE_NAME(".obj")), 48.0,
           (double[6]){80.0 + 48.0, 68.0 + 12.0, 20.0 + 60.0, -24.0, 0.0, 0.0}, 1e-14);
    /* With a sphere of its own on each side of a box. */
    write_obj(BOX);
    const double ball = 4.0 * pi * 0.001;
    expect(
        "se3d: 1\nbodies:\n  - name: b\n    density: 3\n    shapes: [{type: mesh, file: " FILE_NAME(
            ".obj") ", position: [-0.5, -1, -2]}, {type: sphere, radius: 0.1, position: "
                    "[3, 0, 0]}, {type: sphere, radius: 0.1, position: [-3, 0, 0]}]\n",
        24.0 + 2.0 * ball,
        (double[6]){box_inertia[0] + 0.008 * ball, box_inertia[1] + 18.008 * ball,
                    box_inertia[2] + 18.008 * ball, 0.0, 0.0, 0.0},
        1e-14);
    /* A hollow whose surface looks inwards: 24 kg less 3 kg. */
    write_obj(BOX "v 0.25 0.5 1\nv 0.75 0.5 1\nv 0.75 1.5 1\nv 0.25 1.5 1\nv 0.25 0.5 3\n"
                  "v 0.75 0.5 3\nv 0.75 1.5 3\nv 0.25 1.5 3\nf 9 10 11 12\nf 16 15 14 13\n"
                  "f 13 14 10 9\nf 14 15 11 10\nf 15 16 12 11\nf 16 13 9 12\n");
    expect(BODY("position: [-0.5, -1, -2]", FILE_NAME(".obj")), 21.0,
           (double[6]){box_inertia[0] * 31 / 32, box_inertia[1] * 31 / 32, box_inertia[2] * 31 / 32,
                       0.0, 0.0, 0.0},
           1e-14);
    remove_files();
}

/* Corners 0, a ex, b ey, c ez: m = rho a b c / 6, centre (a, b, c)/4, products of inertia about it
 * int x x = 3/80 m a^2, int x y = -m a b / 80. */
static void a_tetrahedron_follows_its_closed_form(void)
{
    const double a = 1.0, b = 2.0, c = 3.0, m = 3.0;
    const double J[6] = {m * 3 / 80 * (b * b + c * c),
                         m * 3 / 80 * (c * c + a * a),
                         m * 3 / 80 * (a * a + b * b),
                         m / 80 * a * b,
                         m / 80 * b * c,
                         m / 80 * a * c};
    write_obj("v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    expect(BODY("position: [-0.25, -0.5, -0.75]", FILE_NAME(".obj")), m, J, 1e-14);
    /* A part far from the origin of its file loses digits of its coordinates only. */
    write_obj("v 1000 0 0\nv 1001 0 0\nv 1000 2 0\nv 1000 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
              "f 3 1 4\n");
    expect(BODY("position: [-1000.25, -0.5, -0.75]", FILE_NAME(".obj")), m, J, 1e-12);
    refuse("v 1 0 0\nv 2 0 0\nv 1 2 0\nv 1 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", "scale: 1",
           "centre of mass at [1.25, 0.5, 0.75], must");
    remove_files();
}

static void ring_point(int ring, int at, int rings, float p[3])
{
    const double polar = pi * ring / rings, around = pi * at / rings;
    const int pole = ring == 0 || ring == rings; /* sin(pi) is not 0 */
    p[0] = pole ? 0.0f : (float)(sin(polar) * cos(around));
    p[1] = pole ? 0.0f : (float)(sin(polar) * sin(around));
    p[2] = (float)cos(polar);
}

/* A sphere of radius 1 as STL, binary, with triangles of no area at the poles. */
static size_t write_sphere(int rings)
{
    static unsigned char bytes[84 + 50 * 4 * 64 * 64];
    const size_t count = 4 * (size_t)rings * (size_t)rings;
    unsigned char *record = bytes + 84;
    memset(bytes, 0, sizeof bytes);
    for (int k = 0; k < 4; ++k) {
        bytes[80 + k] = (unsigned char)(count >> 8 * k);
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int at = 0; at < 2 * rings; ++at) {
            const int next = (at + 1) % (2 * rings);
            float corner[4][3];
            ring_point(ring, at, rings, corner[0]);
            ring_point(ring + 1, at, rings, corner[1]);
            ring_point(ring + 1, next, rings, corner[2]);
            ring_point(ring, next, rings, corner[3]);
            memcpy(record + 12, corner, 36);
            memcpy(record + 62, corner[0], 12);
            memcpy(record + 74, corner[2], 24);
            record += 100;
        }
    }
    scratch_write(FILE_NAME(".stl"), bytes, 84 + 50 * count);
    return count;
}

/* The error of mass and inertia falls with the square of the edges, to 1e-3 and less. */
static void a_fine_sphere_comes_near_the_ball(void)
{
    double error[2] = {0.0, 0.0};
    for (int fine = 0; fine < 2; ++fine) {
        se3d_model_error message = {0, 0, ""};
        double m = 0.0, J[6] = {0.0};
        se3d_body body;
        write_sphere(fine ? 64 : 32);
        se3d_model *model = scratch_read_model(BODY("scale: 1", FILE_NAME(".stl")), &message);
        CHECK(model != NULL);
        if (!model) {
            fprintf(stderr, "%s\n", message.message);
            return;
        }
        CHECK(se3d_body_find(se3d_model_get_system(model), "b", &body) == SE3D_OK);
        CHECK(se3d_body_get_mass(se3d_model_get_system(model), body, &m, J) == SE3D_OK);
        error[fine] = 1.0 - m / (4.0 * pi);
        CHECK_NEAR(J[2], 0.4 * m, 8.0 * error[fine]);
        CHECK_NEAR(J[0], J[1], 1e-6);
        CHECK_NEAR(J[3], 0.0, 1e-6);
        se3d_model_destroy(model);
    }
    CHECK(error[1] > 0.0 && error[1] < 2e-3);
    CHECK_NEAR(error[0] / error[1], 4.0, 0.05);
    remove_files();
}

static void surfaces_that_enclose_nothing_name_the_edge(void)
{
    refuse(BOX_POINTS "f 4 3 2 1\n" BOX_SIDES, "scale: 1", "has one triangle only");
    refuse(BOX_POINTS "f 4 3 2 1\n" BOX_SIDES, "scale: 10",
           "the edge from [0, 0, 40] to [10, 0, 40]");
    refuse(BOX_POINTS "f 4 3 2 1\nf 8 7 6 5\n" BOX_SIDES, "scale: 1", "is inverted");
    refuse(BOX "f 1 2 7\n", "scale: 1", "equally often in both directions");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", "scale: 1",
           "does not enclose a volume");
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 3 2 1\nf 1 2 4\nf 4 2 1\n", "scale: 1",
           "does not enclose a volume");
}

/* Drawn, or of a body that has its mass: nobody asks. */
static void an_open_mesh_without_density_is_drawn(void)
{
    se3d_model_error error = {0, 0, ""};
    write_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect("se3d: 1\nbodies:\n  - name: b\n    shapes: [{type: mesh, file: " FILE_NAME(
               ".obj") "}, {type: box, size: [1, 2, 4], density: 3}]\n",
           24.0, box_inertia, 1e-14);
    se3d_model *model = scratch_read_model(
        "se3d: 1\nbodies:\n  - name: b\n    mass: 1\n    inertia: [1, "
        "1, 1]\n    density: 3\n    shapes: [{type: mesh, file: " FILE_NAME(".obj") "}]\n",
        &error);
    CHECK(model != NULL);
    se3d_model_destroy(model);
    remove_files();
}

int main(void)
{
    RUN(a_box_of_triangles_weighs_what_the_box_does);
    RUN(solids_add_up_about_the_origin);
    RUN(a_tetrahedron_follows_its_closed_form);
    RUN(a_fine_sphere_comes_near_the_ball);
    RUN(surfaces_that_enclose_nothing_name_the_edge);
    RUN(an_open_mesh_without_density_is_drawn);
    return check_finish();
}
