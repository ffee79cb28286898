/* SPDX-License-Identifier: BSD-3-Clause */
/* Spheres on every kind of shape: restitution, slip to roll, action and reaction, meshes as the
 * planes that they are, corners. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <stdlib.h>

#define R 0.01

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 1e6;
    def.young = 1e9;
    return def;
}

/* Gravity g downwards. */
static void open_bed(bed *b, se3d_contact_law law, double g, const se3d_material_def *material)
{
    const double down[3] = {0.0, 0.0, -g};
    bed_open(b, (int32_t)law, down, NULL, material);
}

enum { PLANE, BOX, HULL, MESH, CYLINDER, SPHERE, CAPSULE, KINDS };

#define GRID 9
static double mesh_points[3 * GRID * GRID];
static uint32_t mesh_faces[6 * (GRID - 1) * (GRID - 1)];

/* A square from -0.4 to 0.4 in z = 0, triangles of uneven sizes with both diagonals. */
static void fill_mesh(void)
{
    for (int k = 0; k < GRID * GRID; ++k) {
        int i = k % GRID, j = k / GRID, edge = i == 0 || j == 0 || i == GRID - 1 || j == GRID - 1;
        mesh_points[3 * k] = 0.1 * (i - 4) + (edge ? 0.0 : 0.03 * sin(7.0 * k));
        mesh_points[3 * k + 1] = 0.1 * (j - 4) + (edge ? 0.0 : 0.03 * cos(5.0 * k));
    }
    uint32_t *t = mesh_faces;
    for (uint32_t k = 0; k < (GRID - 1) * (GRID - 1); ++k) {
        uint32_t a = k / (GRID - 1) * GRID + k % (GRID - 1);
        const uint32_t quad[2][6] = {{a, a + 1, a + GRID, a + 1, a + GRID + 1, a + GRID},
                                     {a, a + 1, a + GRID + 1, a, a + GRID + 1, a + GRID}};
        memcpy(t + 6 * k, quad[k % 2], sizeof quad[0]);
    }
}

/* A shape whose top is at z = 0 (the round ones': their highest point or line along x). */
static se3d_shape shape_under(bed *b, int kind)
{
    static const double corners[24] = {-0.4, -0.4, 0.0,  0.4, -0.4, 0.0,  -0.4, 0.4,
                                       0.0,  0.4,  0.4,  0.0, -0.4, -0.4, -0.2, 0.4,
                                       -0.4, -0.2, -0.4, 0.4, -0.2, 0.4,  0.4,  -0.2};
    se3d_status (*const create[KINDS])(se3d_system *, const se3d_shape_def *, se3d_shape *) = {
        se3d_shape_create_plane,  se3d_shape_create_box,      se3d_shape_create_hull,
        se3d_shape_create_mesh,   se3d_shape_create_cylinder, se3d_shape_create_sphere,
        se3d_shape_create_capsule};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    fill_mesh();
    def.material = b->material;
    def.size[0] = def.size[1] = 0.8;
    def.size[2] = 0.2;
    def.radius = 0.3;
    def.length = 0.4;
    def.position[2] = kind == BOX ? -0.1 : kind == CYLINDER ? -0.2 : kind >= SPHERE ? -0.3 : 0.0;
    if (kind == CAPSULE) {
        def.orientation[0] = def.orientation[2] = sqrt(0.5);
    }
    def.vertices = kind == HULL ? corners : mesh_points;
    def.vertex_count = kind == HULL ? 8 : GRID * GRID;
    def.triangles = mesh_faces;
    def.triangle_count = 2 * (GRID - 1) * (GRID - 1);
    CHECK(create[kind](b->system, &def, &shape) == SE3D_OK);
    return shape;
}

static double rebound(int kind, se3d_contact_law law, double e, double speed)
{
    se3d_material_def def = stuff();
    def.restitution = e;
    def.stiffness = 1e6 * (speed > 1.0 ? 20.0 : 1.0);
    def.young = 1e9 * (speed > 1.0 ? 20.0 : 1.0);
    bed b;
    open_bed(&b, law, 0.0, &def);
    (void)shape_under(&b, kind);
    const double r[3] = {0.013, 0.0, R + 1e-6}, v[3] = {0.0, 0.0, -speed}, radius = R;
    const double over[3] = {0.0, 0.0, R + 1e-6};
    CHECK(se3d_particles_add(b.particles, b.material, 1, kind == SPHERE ? over : r, &radius, v,
                             NULL, NULL) == SE3D_OK);
    double at[3], now[3] = {0.0, 0.0, 0.0}, step;
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.particles, 0.25 * step) == SE3D_OK);
    for (int k = 0; k < 4000 && !(now[2] > 0.0 && se3d_particles_count_contacts(b.particles) == 0);
         ++k) {
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        CHECK(se3d_particles_get_all(b.particles, 1, at, now, NULL) == SE3D_OK);
    }
    bed_close(&b);
    return now[2] / speed;
}

static void restitution_is_what_was_typed_on_every_shape(void)
{
    const double e[4] = {0.3, 0.5, 0.7, 0.9};
    for (int kind = 0; kind < KINDS; ++kind) {
        for (int k = 0; k < 16; ++k) {
            se3d_contact_law law = k & 4 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
            CHECK_NEAR(rebound(kind, law, e[k % 4], k & 8 ? 10.0 : 0.1), e[k % 4], 1e-3);
        }
    }
}

/* A sphere that slides rolls with 5/7 of its speed in the end. */
static void sliding_spheres_roll_in_the_end_on_flat_shapes(void)
{
    double end[MESH + 1][2];
    for (int kind = PLANE; kind <= MESH; ++kind) {
        se3d_material_def def = stuff();
        def.restitution = 0.1;
        def.stiffness = 1e5;
        def.friction = 0.3;
        bed b;
        open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 9.81, &def);
        se3d_shape shape = shape_under(&b, kind);
        double weight = 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * R * R * R * 9.81;
        const double r[3] = {-0.3, -0.15, R - weight / 1e5}, v[3] = {0.5, 0.3, 0.0}, radius = R;
        CHECK(se3d_particles_add(b.particles, b.material, 1, r, &radius, v, NULL, NULL) == SE3D_OK);
        double at[3], now[3], force[3], torque[3];
        for (int k = 0; k < 80; ++k) { /* one contact wherever it is */
            CHECK(se3d_particles_run(b.particles, 0.01 * (k + 1)) == SE3D_OK);
            CHECK(se3d_particles_count_contacts(b.particles) == 1);
        }
        CHECK(se3d_shape_get_wrench(b.system, shape, force, torque) == SE3D_OK);
        CHECK(se3d_particles_get_all(b.particles, 1, at, now, NULL) == SE3D_OK);
        double arm = 1.0 - weight / 1e5 / R; /* over R: 5/7 if it is 1 */
        CHECK_NEAR(now[0], 0.5 / (1.0 + 0.4 / (arm * arm)), 1e-7);
        CHECK_NEAR(now[1], 0.3 / (1.0 + 0.4 / (arm * arm)), 1e-7);
        CHECK_NEAR(force[2] / weight, -1.0, 1e-6);
        CHECK_NEAR(torque[0], at[1] * force[2], 1e-7 * weight);
        CHECK(at[0] > -0.05); /* it went over many edges of the mesh */
        memcpy(end[kind], at, sizeof end[kind]);
        for (int a = 0; a < 2; ++a) {
            CHECK_NEAR(end[kind][a], end[PLANE][a], 1e-11);
        }
        bed_close(&b);
    }
}

/* One sphere rolls, one spins on the spot: both are slowed as on a plane, also if nothing but a
 * mesh is touched. */
static void rolling_and_spinning_are_resisted_on_flat_shapes(void)
{
    for (int kind = PLANE; kind <= MESH; ++kind) {
        se3d_material_def def = stuff();
        def.restitution = 0.1;
        def.stiffness = 1e5;
        def.rolling_friction = 0.02;
        def.torsional_friction = 0.03;
        bed b;
        open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 9.81, &def);
        (void)shape_under(&b, kind);
        const double depth = 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * R * R * R * 9.81 / 1e5;
        const double r[6] = {-0.3, -0.15, R - depth, 0.2, 0.17, R - depth};
        const double v[6] = {0.5, 0.0, 0.0, 0.0, 0.0, 0.0};
        const double w[6] = {0.0, 0.5 / R, 0.0, 0.0, 0.0, 50.0}, radius[2] = {R, R};
        double now[6], spin[6];
        CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, v, w, NULL) == SE3D_OK);
        CHECK(se3d_particles_run(b.particles, 0.5) == SE3D_OK);
        CHECK(se3d_particles_get_all(b.particles, 2, NULL, now, spin) == SE3D_OK);
        CHECK_NEAR(now[0], 0.5 - 5.0 / 7.0 * 0.02 * 9.81 * 0.5, 2e-4);
        CHECK_NEAR(spin[5], 50.0 - 0.03 * 9.81 / (0.4 * R) * 0.5, 0.02);
        bed_close(&b);
    }
}

/* Several shapes on a body that moves and turns: what the particles feel, the body does. */
static void body_feels_the_opposite_of_what_the_particles_do(void)
{
    se3d_material_def def = stuff();
    def.rolling_friction = 0.05;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HERTZ_MINDLIN, 9.81, &def);
    se3d_body_def body = se3d_body_def_default();
    se3d_body tray;
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.orientation[0] = cos(0.1);
    body.orientation[1] = sin(0.1);
    body.angular_velocity[2] = 1.0;
    body.velocity[0] = 0.2;
    CHECK(se3d_body_create(b.system, &body, &tray) == SE3D_OK);
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape made[4];
    shape.body = tray;
    shape.material = b.material;
    shape.size[0] = shape.size[1] = 0.4;
    shape.size[2] = 0.02;
    shape.position[2] = -0.01;
    CHECK(se3d_shape_create_box(b.system, &shape, &made[0]) == SE3D_OK);
    shape.radius = 0.03;
    shape.length = 0.1;
    shape.position[0] = 0.04;
    CHECK(se3d_shape_create_cylinder(b.system, &shape, &made[1]) == SE3D_OK);
    shape.position[0] = -0.04;
    shape.orientation[0] = cos(0.3);
    shape.orientation[1] = sin(0.3);
    CHECK(se3d_shape_create_capsule(b.system, &shape, &made[2]) == SE3D_OK);
    fill_mesh();
    shape.position[0] = 0.0;
    shape.position[2] = 0.004;
    shape.orientation[0] = 1.0;
    shape.orientation[1] = 0.0;
    shape.vertices = mesh_points;
    shape.vertex_count = GRID * GRID;
    shape.triangles = mesh_faces;
    shape.triangle_count = 2 * (GRID - 1) * (GRID - 1);
    CHECK(se3d_shape_create_mesh(b.system, &shape, &made[3]) == SE3D_OK);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b.material;
    fill.lower[0] = fill.lower[1] = -0.08;
    fill.upper[0] = fill.upper[1] = 0.08;
    fill.lower[2] = 0.06;
    fill.upper[2] = 0.15;
    fill.radius_min = 0.004;
    fill.radius_max = 0.006;
    fill.seed = 3;
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, NULL) == SE3D_OK);
    size_t most = 0;
    for (int k = 0; k < 12; ++k) {
        CHECK(se3d_particles_run(b.particles, 0.015 * (k + 1)) == SE3D_OK);
        size_t n = se3d_particles_count_contacts(b.particles);
        se3d_particles_contact *list = malloc((n + 1) * sizeof *list);
        CHECK(n == 0 || se3d_particles_get_contacts(b.particles, n, list) == SE3D_OK);
        double sum[4][3] = {{0.0}}, total[3] = {0.0, 0.0, 0.0}, scale = 1e-9;
        size_t on_shapes = 0;
        for (size_t c = 0; c < n; ++c) {
            for (int s = 0; s < 4; ++s) {
                if (list[c].shape.index1 == made[s].index1) {
                    ++on_shapes;
                    for (int a = 0; a < 3; ++a) {
                        sum[s][a] -= list[c].force[a];
                        scale += fabs(list[c].force[a]);
                    }
                }
            }
        }
        double force[3], torque[3], together[3];
        for (int s = 0; s < 4; ++s) {
            CHECK(se3d_shape_get_wrench(b.system, made[s], force, torque) == SE3D_OK);
            for (int a = 0; a < 3; ++a) {
                total[a] += force[a];
                CHECK_NEAR(force[a] / scale, sum[s][a] / scale, 2e-2);
            }
        }
        CHECK(se3d_body_get_contact_wrench(b.system, tray, together, torque) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(together[a] / scale, total[a] / scale, 1e-12);
        }
        most = on_shapes > most ? on_shapes : most;
        free(list);
    }
    CHECK(most > 20);
    bed_close(&b);
}

/* In the corner of three triangles a sphere has three contacts, and stays. */
static void sphere_rests_in_a_corner_of_a_mesh(void)
{
    const double points[12] = {0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.2};
    const uint32_t faces[9] = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    se3d_material_def def = stuff();
    def.restitution = 0.1;
    def.stiffness = 1e5;
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 9.81, &def);
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape corner;
    shape.material = b.material;
    shape.vertices = points;
    shape.vertex_count = 4;
    shape.triangles = faces;
    shape.triangle_count = 3;
    /* turn (1,1,1) upwards */
    const double angle = acos(1.0 / sqrt(3.0)), half = sqrt(0.5);
    shape.orientation[0] = cos(0.5 * angle);
    shape.orientation[1] = sin(0.5 * angle) * half;
    shape.orientation[2] = -sin(0.5 * angle) * half;
    CHECK(se3d_shape_create_mesh(b.system, &shape, &corner) == SE3D_OK);
    const double r[3] = {1e-3, 0.0, 1.9 * R}, radius = R;
    CHECK(se3d_particles_add(b.particles, b.material, 1, r, &radius, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.6) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) == 3);
    double before[3], after[3], force[3], torque[3];
    double weight = 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * R * R * R * 9.81;
    CHECK(se3d_particles_get_all(b.particles, 1, before, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.9) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, after, NULL, NULL) == SE3D_OK);
    CHECK(se3d_shape_get_wrench(b.system, corner, force, torque) == SE3D_OK);
    CHECK_NEAR(force[2] / weight, -1.0, 1e-9);
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(after[a], before[a], 1e-12);
        CHECK_NEAR(after[a], a == 2 ? sqrt(3.0) * R - weight / 1e5 : 0.0,
                   1e-6); /* friction bears a part */
    }
    /* a copy in the middle, and one after an edit elsewhere, go on alike */
    se3d_particles *copy;
    CHECK(se3d_particles_clone(b.particles, &copy) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 0.91) == SE3D_OK);
    CHECK(se3d_particles_run(copy, 0.91) == SE3D_OK);
    CHECK(se3d_particles_hash(copy) == se3d_particles_hash(b.particles));
    se3d_particles_destroy(copy);
    bed_close(&b);
}

/* Filters, and shapes that go while particles lie on them. */
static void filters_and_destroyed_shapes_are_obeyed(void)
{
    se3d_material_def def = stuff();
    bed b;
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, 9.81, &def);
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape plane, other;
    shape.material = b.material;
    shape.mask = 6; /* particles are of group 1 */
    CHECK(se3d_shape_create_plane(b.system, &shape, &plane) == SE3D_OK);
    const double r[3] = {0.0, 0.0, R}, radius = R;
    CHECK(se3d_particles_add(b.particles, b.material, 1, r, &radius, NULL, NULL, NULL) == SE3D_OK);
    double at[3];
    CHECK(se3d_particles_run(b.particles, 0.05) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, at, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(at[2], R - 0.5 * 9.81 * 0.0025, 1e-9);
    shape.mask = 7;
    shape.position[2] = -0.05;
    CHECK(se3d_shape_create_plane(b.system, &shape, &other) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 2.0) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) == 1);
    CHECK(se3d_shape_destroy(b.system, plane) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) == 0); /* none known after an edit */
    CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
    CHECK(se3d_particles_count_contacts(b.particles) == 1);
    CHECK(se3d_shape_destroy(b.system, other) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 2.5) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.particles, 1, at, NULL, NULL) == SE3D_OK);
    CHECK(at[2] < -1.0);
    CHECK(se3d_material_destroy(b.system, b.material) == SE3D_ERR_IN_USE);
    bed_close(&b);
}

int main(void)
{
    RUN(restitution_is_what_was_typed_on_every_shape);
    RUN(sliding_spheres_roll_in_the_end_on_flat_shapes);
    RUN(rolling_and_spinning_are_resisted_on_flat_shapes);
    RUN(body_feels_the_opposite_of_what_the_particles_do);
    RUN(sphere_rests_in_a_corner_of_a_mesh);
    RUN(filters_and_destroyed_shapes_are_obeyed);
    return check_finish();
}
