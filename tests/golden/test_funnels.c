/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on funnels: cones, truncated cones and tubes, from inside and outside, at the rims and
 * at the tip, against closed forms and against fine meshes. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>

#define PI 3.14159265358979323846
#define R  0.01

static const double none[3] = {0.0, 0.0, 0.0}, down[3] = {0.0, 0.0, -9.81};

static se3d_material_def smooth(void)
{
    se3d_material_def material = se3d_material_def_default();
    material.density = 2500.0;
    material.stiffness = 2e4;
    material.friction = 0.0;
    return material;
}

static void open_funnel(bed *b, const double gravity[3], const se3d_material_def *material,
                        const se3d_shape_def *funnel, int32_t portable)
{
    se3d_particles_def set = se3d_particles_def_default();
    se3d_shape_def def = *funnel;
    se3d_shape shape;
    set.portable = portable;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, gravity, &set, material);
    def.material = b->material;
    CHECK(se3d_shape_create_funnel(b->system, &def, &shape) == SE3D_OK);
}

static se3d_shape_def funnel_of(double bottom, double top, double length)
{
    se3d_shape_def def = se3d_shape_def_default();
    def.bottom_radius = bottom;
    def.top_radius = top;
    def.length = length;
    return def;
}

/* The distance of a centre from the circles that make up the surface: by trial. */
static double trial_distance(const se3d_shape_def *f, const double x[3])
{
    const double rho = hypot(x[0], x[1]);
    double least = HUGE_VAL;
    for (int k = 0; k <= 20000; ++k) {
        const double part = k / 20000.0;
        const double r = f->bottom_radius + part * (f->top_radius - f->bottom_radius);
        least = fmin(least, hypot(rho - r, x[2] - (part - 0.5) * f->length));
    }
    return least;
}

/* The force is the spring's along the way from the nearest point, whatever the kernels. */
static void push_is_that_of_the_nearest_point(void)
{
    static const double ends[4][2] = {{0.03, 0.08}, {0.06, 0.06}, {0.0, 0.07}, {0.07, 0.0}};
    uint64_t seed = 5;
    int touching = 0;
    for (int trial = 0; trial < 160; ++trial) {
        const se3d_shape_def f = funnel_of(ends[trial % 4][0], ends[trial % 4][1], 0.1);
        const double angle = PI * check_random(&seed), part = 0.65 * check_random(&seed);
        const double r = f.bottom_radius + (part + 0.5) * (f.top_radius - f.bottom_radius);
        const double rho = fmax(0.015, r) + 0.012 * check_random(&seed);
        const double x[3] = {rho * cos(angle), rho * sin(angle),
                             0.1 * part + 0.004 * check_random(&seed)};
        const double distance = trial_distance(&f, x);
        double force[2][3], size = 0.0;
        for (int32_t portable = 0; portable < 2; ++portable) {
            bed b;
            const se3d_material_def material = smooth();
            open_funnel(&b, none, &material, &f, portable);
            bed_add(&b, x, R, none, none);
            CHECK(se3d_particles_set_step(b.particles, 1e-9) == SE3D_OK);
            (void)se3d_particles_step(b.particles, 1); /* the overlap may be large */
            CHECK(se3d_particles_get_forces(b.particles, 1, force[portable], NULL) == SE3D_OK);
            CHECK(se3d_particles_count_contacts(b.particles) == (distance < R));
            bed_close(&b);
        }
        CHECK(memcmp(force[0], force[1], sizeof force[0]) == 0);
        for (int a = 0; a < 3; ++a) {
            size += force[0][a] * force[0][a];
        }
        CHECK_NEAR(sqrt(size), 2e4 * fmax(0.0, R - distance), 2e4 * 2e-7);
        CHECK_NEAR(force[0][0] * sin(angle), force[0][1] * cos(angle), 1e-9);
        touching += distance < R;
    }
    CHECK(touching > 60 && touching < 150);
}

/* Frictionless: v^2 = g h, with h the height above the tip of the cone that the centre is on. */
static void ball_goes_round_a_cone_as_a_conical_pendulum(void)
{
    const double slopes[3] = {0.5, 1.0, 2.0}; /* height over radius */
    for (int k = 0; k < 3; ++k) {
        const double s = slopes[k], rho = 0.08, length = 0.2, top = length / s;
        const double lift = R * sqrt(1.0 + s * s);
        const double height = s * rho, speed = sqrt(9.81 * height);
        const double sink = 2500.0 * 4.0 / 3.0 * PI * R * R * R * 9.81 * sqrt(1.0 + 1.0 / (s * s)) *
                            s / 2e4; /* overlap times the cosine of the slope, and up */
        bed b;
        se3d_material_def material = smooth();
        const se3d_shape_def f = funnel_of(0.0, top, length);
        open_funnel(&b, down, &material, &f, 0);
        const double lowered = sqrt(1.0 + s * s) * sink / s; /* of the cone of the centre */
        const double r[3] = {rho, 0.0, height + lift - lowered - 0.5 * length};
        const double v[3] = {0.0, speed, 0.0};
        bed_add(&b, r, R, v, none);
        const double period = 2.0 * PI * rho / speed;
        double least = HUGE_VAL, most = 0.0;
        for (int n = 1; n <= 24; ++n) {
            double x[3];
            CHECK(se3d_particles_run(b.particles, period * n / 8.0) == SE3D_OK);
            CHECK(se3d_particles_get_all(b.particles, 1, x, NULL, NULL) == SE3D_OK);
            least = fmin(least, hypot(x[0], x[1]));
            most = fmax(most, hypot(x[0], x[1]));
            CHECK(hypot(x[0] - rho * cos(PI * n / 4.0), x[1] - rho * sin(PI * n / 4.0)) <
                  0.02 * rho);
        }
        CHECK(least > 0.998 * rho && most < 1.002 * rho);
        bed_close(&b);
    }
}

/* On the axis a ball is held on both sides: it rests there, and the funnel bears its weight. */
static void ball_rests_in_the_mouth_and_in_the_tip(void)
{
    static const double mouths[2] = {0.006, 0.0};
    for (int k = 0; k < 2; ++k) {
        bed b;
        double x[3], v[3], force[3];
        se3d_material_def material = smooth();
        material.restitution = 0.2;
        material.friction = 0.3;
        const se3d_shape_def f = funnel_of(mouths[k], 0.08, 0.1);
        const double r[3] = {0.003, -0.002, -0.028};
        open_funnel(&b, down, &material, &f, 0);
        bed_add(&b, r, R, none, none);
        CHECK(se3d_particles_run(b.particles, 0.6) == SE3D_OK);
        CHECK(se3d_particles_count_contacts(b.particles) == 2);
        CHECK(se3d_particles_get_all(b.particles, 1, x, v, NULL) == SE3D_OK);
        CHECK(se3d_particles_get_forces(b.particles, 1, force, NULL) == SE3D_OK);
        CHECK(hypot(x[0], x[1]) < 2e-4);
        CHECK(hypot(hypot(v[0], v[1]), v[2]) < 2e-3);
        CHECK_NEAR(force[2], 9.81 * 2500.0 * 4.0 / 3.0 * PI * R * R * R, 1e-3);
        double on_wall[3], torque[3];
        se3d_body ground;
        CHECK(se3d_system_get_ground(b.system, &ground) == SE3D_OK);
        CHECK(se3d_particles_get_wrench(b.particles, ground, on_wall, torque) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(on_wall[a], -force[a], 1e-15);
        }
        bed_close(&b);
    }
}

/* Rims and the tip are touched once from outside. */
static void edges_count_once(void)
{
    static const double places[6][3] = {{0.06, 0.0, 0.055},  {0.066, 0.0, 0.053},
                                        {0.055, 0.0, 0.056}, {0.0, 0.06, -0.056},
                                        {0.067, 0.0, 0.0},   {0.054, 0.0, 0.049}};
    const se3d_shape_def tube = funnel_of(0.06, 0.06, 0.1), cone = funnel_of(0.06, 0.0, 0.1);
    for (int k = 0; k < 8; ++k) {
        bed b;
        const se3d_material_def material = smooth();
        const double on_tip[2][3] = {{0.0, 0.0, 0.058}, {1e-4, 2e-4, 0.058}};
        open_funnel(&b, none, &material, k < 6 ? &tube : &cone, 0);
        bed_add(&b, k < 6 ? places[k] : on_tip[k - 6], R, none, none);
        (void)se3d_particles_step(b.particles, 1);
        CHECK(se3d_particles_count_contacts(b.particles) == 1);
        bed_close(&b);
    }
}

/* In a cone of 2 degrees the second side counts where a foot is on it, the tip never does; on a
 * wire the side behind does not count. */
static void second_side_counts_between_the_sides(void)
{
    const double slope = tan(2.0 * PI / 180.0), away[3] = {0.0002, 0.001, 0.0096};
    for (int k = 0; k < 3; ++k) {
        bed b;
        const se3d_material_def material = smooth();
        const se3d_shape_def f =
            k < 2 ? funnel_of(0.0, 0.2, 0.2 * slope) : funnel_of(1e-4, 1e-4, 0.1);
        const double up = 0.0098 * sqrt(1.0 + slope * slope) + away[k] * slope - 0.1 * slope;
        const double r[3] = {0.6 * away[k], 0.8 * away[k], k < 2 ? up : 0.0};
        open_funnel(&b, none, &material, &f, 0);
        bed_add(&b, r, R, none, none);
        (void)se3d_particles_step(b.particles, 1);
        CHECK(se3d_particles_count_contacts(b.particles) == (k == 0 ? 2 : 1));
        double force[3];
        CHECK(se3d_particles_get_forces(b.particles, 1, force, NULL) == SE3D_OK);
        const double size = sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
        CHECK(k == 0 || fabs(size / (k == 1 ? 4.0 : 10.0) - 1.0) < 0.02);
        bed_close(&b);
    }
}

/* The force on a ball in a funnel less that in a mesh of n facets whose corners are on it. */
static double mesh_error(uint32_t n)
{
    enum { MOST = 1024 };
    static double corners[6 * MOST], force[2][3];
    static uint32_t triangles[6 * MOST];
    const double bottom = 0.03, top = 0.08, length = 0.1;
    double most = 0.0;
    for (uint32_t k = 0; k < n; ++k) {
        const double angle = 2.0 * PI * k / n;
        const uint32_t next = (k + 1) % n;
        const uint32_t facet[6] = {2 * k, 2 * next, 2 * k + 1, 2 * next + 1, 2 * k + 1, 2 * next};
        memcpy(triangles + 6 * (size_t)k, facet, sizeof facet);
        for (int end = 0; end < 2; ++end) {
            const double r = end ? top : bottom;
            corners[6 * k + 3 * (size_t)end] = r * cos(angle);
            corners[6 * k + 3 * (size_t)end + 1] = r * sin(angle);
            corners[6 * k + 3 * (size_t)end + 2] = (end - 0.5) * length;
        }
    }
    for (int trial = 0; trial < 12; ++trial) {
        const double angle = 0.1 + 0.5 * trial, side = trial % 2 ? 1.0 : -1.0;
        for (int mesh = 0; mesh < 2; ++mesh) {
            bed b;
            se3d_shape shape;
            const se3d_material_def material = smooth();
            se3d_shape_def def = funnel_of(bottom, top, length);
            const double rho = 0.055 + side * 0.008;
            const double r[3] = {rho * cos(angle), rho * sin(angle), 0.0};
            def.vertices = corners;
            def.vertex_count = 2 * (size_t)n;
            def.triangles = triangles;
            def.triangle_count = 2 * (size_t)n;
            bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
            def.material = b.material;
            CHECK((mesh ? se3d_shape_create_mesh : se3d_shape_create_funnel)(b.system, &def,
                                                                             &shape) == SE3D_OK);
            bed_add(&b, r, R, none, none);
            CHECK(se3d_particles_set_step(b.particles, 1e-9) == SE3D_OK);
            (void)se3d_particles_step(b.particles, 1);
            CHECK(se3d_particles_get_forces(b.particles, 1, force[mesh], NULL) == SE3D_OK);
            bed_close(&b);
        }
        most = fmax(most, hypot(hypot(force[1][0] - force[0][0], force[1][1] - force[0][1]),
                                force[1][2] - force[0][2]));
    }
    return most;
}

/* A facet is nearer to the axis by r (1 - cos(pi/n)), and its normal turned by up to pi/n. Coarser
 * ones are touched in two facets at a time. */
static void meshes_come_nearer_with_their_facets(void)
{
    const double coarse = mesh_error(192), fine = mesh_error(768);
    CHECK(coarse > 0.1 && coarse < 1.0); /* of 61 N */
    CHECK(fine > 0.0 && fine < 0.3 * coarse);
}

/* As on a plane: a ball that starts to roll on the side of a cone along its line. */
static void ball_rolls_down_a_line_as_on_a_plane(void)
{
    double height[2];
    for (int flat = 0; flat < 2; ++flat) {
        bed b;
        se3d_material_def material = smooth();
        material.friction = 0.6;
        material.rolling_friction = 0.02;
        const se3d_shape_def f = funnel_of(0.02, 0.22, 0.2);
        const double r[3] = {0.15 - R * sqrt(0.5), 0.0, 0.03 + R * sqrt(0.5)};
        const double normal[3] = {-1.0, 0.0, 1.0}, at[3] = {0.15, 0.0, 0.03};
        if (flat) {
            bed_open(&b, SE3D_CONTACT_LAW_HOOKE, down, NULL, &material);
            (void)bed_add_plane(&b, at, normal);
        } else {
            open_funnel(&b, down, &material, &f, 0);
        }
        bed_add(&b, r, R, none, none);
        CHECK(se3d_particles_run(b.particles, 0.12) == SE3D_OK);
        double x[3], w[3];
        CHECK(se3d_particles_get_all(b.particles, 1, x, NULL, w) == SE3D_OK);
        height[flat] = x[2];
        CHECK(fabs(w[1]) > 10.0);
        CHECK_NEAR(x[1], 0.0, 1e-12);
        bed_close(&b);
    }
    CHECK_NEAR(height[0], height[1], 1e-9);
}

/* A tube that turns takes a ball along at the speed of its side. */
static void tube_that_turns_takes_a_ball_along(void)
{
    bed b;
    se3d_material_def material = smooth();
    se3d_shape_def def = funnel_of(0.06, 0.06, 0.1);
    se3d_body_def drum = se3d_body_def_default();
    se3d_shape shape;
    material.friction = 0.5;
    bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, NULL, &material);
    drum.mass = drum.inertia[0] = drum.inertia[1] = drum.inertia[2] = 1e9;
    drum.angular_velocity[2] = 5.0;
    CHECK(se3d_body_create(b.system, &drum, &def.body) == SE3D_OK);
    def.material = b.material;
    CHECK(se3d_shape_create_funnel(b.system, &def, &shape) == SE3D_OK);
    const double r[3] = {0.05, 0.0, 0.0}, v[3] = {0.02, 0.25, 0.0}, w[3] = {0.0, 0.0, 5.0};
    bed_add(&b, r, R, v, w);
    se3d_solver_def solver = se3d_solver_def_default();
    se3d_solver *run;
    solver.method = SE3D_METHOD_VERLET;
    CHECK(se3d_solver_create(b.system, &solver, &run) == SE3D_OK);
    CHECK(se3d_solver_run(run, 0.3) == SE3D_OK);
    double x[3], u[3], spin[3];
    CHECK(se3d_particles_get_all(b.particles, 1, x, u, spin) == SE3D_OK);
    const double rho = hypot(x[0], x[1]), along = (x[0] * u[1] - x[1] * u[0]) / rho;
    CHECK(rho > 0.049 && rho < 0.051);
    CHECK_NEAR(along + R * spin[2], 5.0 * 0.06, 5e-3); /* where it touches */
    se3d_solver_destroy(run);
    bed_close(&b);
}

static void funnels_without_a_side_are_refused(void)
{
    se3d_system *system;
    se3d_shape shape;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    se3d_shape_def def = funnel_of(0.0, 0.0, 0.1);
    CHECK(se3d_shape_create_funnel(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "bottom_radius = 0 m and top_radius = 0 m");
    def = funnel_of(-0.1, 0.1, 0.1);
    CHECK(se3d_shape_create_funnel(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "bottom_radius = -0.1 m");
    def = funnel_of(0.1, 0.1, 0.0);
    CHECK(se3d_shape_create_funnel(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "length = 0 m");
    def = funnel_of(1e-170, 1e-170, 1e-170);
    CHECK(se3d_shape_create_funnel(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(push_is_that_of_the_nearest_point);
    RUN(ball_goes_round_a_cone_as_a_conical_pendulum);
    RUN(ball_rests_in_the_mouth_and_in_the_tip);
    RUN(edges_count_once);
    RUN(second_side_counts_between_the_sides);
    RUN(meshes_come_nearer_with_their_facets);
    RUN(ball_rolls_down_a_line_as_on_a_plane);
    RUN(tube_that_turns_takes_a_ball_along);
    RUN(funnels_without_a_side_are_refused);
    return check_finish();
}
