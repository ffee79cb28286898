/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibria of many bodies, against closed forms, and what is stable. */
#include "check.h"

#include "se3d/se3d.h"

#include <stdlib.h>
#include <string.h>

#define PI   3.14159265358979323846
#define G    9.81
#define LINK 0.1

static const double along_y[3] = {0.0, 1.0, 0.0};
static const double origin[3] = {0.0, 0.0, 0.0};

static uint64_t seed;

static double next(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) * 0x1p-53;
}

typedef struct scene {
    se3d_system *system;
    se3d_body ground;
    se3d_body last;           /* of a chain */
    se3d_constraint pin[512]; /* of a chain, from its start */
    size_t count;
    double end[3];
} scene;

static void begin(scene *s)
{
    const double gravity[3] = {0.0, 0.0, -G};
    memset(s, 0, sizeof *s);
    CHECK(se3d_system_create(NULL, &s->system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(s->system, gravity) == SE3D_OK);
    CHECK(se3d_system_get_ground(s->system, &s->ground) == SE3D_OK);
    s->last = s->ground;
}

/* A bar of mass m from a to b, which is its x axis. */
static se3d_body add_bar(scene *s, const double a[3], const double b[3], double m)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    double u[3], length = 0.0;
    for (int k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        length = hypot(length, u[k]);
        def.position[k] = 0.5 * (a[k] + b[k]);
    }
    const double across = hypot(u[1], u[2]), angle = atan2(across, u[0]);
    def.mass = m;
    def.inertia[0] = 0.01 * m * length * length;
    def.inertia[1] = def.inertia[2] = m * length * length / 12.0;
    def.orientation[0] = cos(0.5 * angle);
    def.orientation[2] = across > 0.0 ? -sin(0.5 * angle) * u[2] / across : 0.0;
    def.orientation[3] = across > 0.0 ? sin(0.5 * angle) * u[1] / across : sin(0.5 * angle);
    CHECK(se3d_body_create(s->system, &def, &body) == SE3D_OK);
    return body;
}

static se3d_constraint add_pin(scene *s, se3d_body i, se3d_body j, const double at[3], int ball)
{
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = i;
    def.body_j = j;
    CHECK(se3d_joint_def_set_frame(s->system, &def, at, along_y, NULL) == SE3D_OK);
    CHECK((ball ? se3d_joint_create_spherical(s->system, &def, &joint)
                : se3d_joint_create_revolute(s->system, &def, &joint)) == SE3D_OK);
    return joint;
}

/* One more link of the chain, up by theta and away from x by phi. */
static void add_link(scene *s, double theta, double phi, int ball)
{
    const double to[3] = {s->end[0] + LINK * cos(theta) * cos(phi),
                          s->end[1] + LINK * cos(theta) * sin(phi), s->end[2] + LINK * sin(theta)};
    se3d_body body = add_bar(s, s->end, to, 1.0);
    s->pin[s->count++] = add_pin(s, s->last, body, s->end, ball);
    s->last = body;
    memcpy(s->end, to, sizeof to);
}

static void add_spring(scene *s, se3d_constraint pin, double k, double theta0)
{
    se3d_force force;
    se3d_rsda_def def = se3d_rsda_def_default();
    def.joint = pin;
    def.k = k;
    def.theta0 = theta0;
    CHECK(se3d_force_create_rsda(s->system, &def, &force) == SE3D_OK);
}

static se3d_status equilibrate(scene *s, se3d_solver_stats *stats)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_EQUILIBRIUM;
    CHECK(se3d_solver_create(s->system, &def, &solver) == SE3D_OK);
    se3d_status status = se3d_solver_run(solver, 0.0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(s->system));
    }
    CHECK(se3d_solver_get_stats(solver, stats) == SE3D_OK);
    se3d_solver_destroy(solver);
    return status;
}

static void end(scene *s)
{
    se3d_system_destroy(s->system);
}

/* Whatever a chain is thrown down like, it hangs: every pin carries what is below it. The work
 * grows with the number of links only. */
static void chains_hang_from_any_start(void)
{
    static const size_t counts[] = {10, 40, 100, 200};
    for (int which = 0; which < 8; ++which) {
        const size_t count = counts[which / 2];
        const int ball = which % 2;
        se3d_solver_stats stats;
        scene s;
        begin(&s);
        seed = 1234567u + (uint64_t)which;
        while (s.count < count) {
            const double phi = 2.0 * PI * next();
            add_link(&s, PI * (2.0 * next() - 1.0), ball ? phi : 0.0, ball);
        }
        CHECK(equilibrate(&s, &stats) ==
              (ball ? SE3D_INFO_NEUTRAL : SE3D_OK)); /* links of ball joints spin */
        CHECK(stats.factorizations < 200 + 25 * count);
        for (size_t k = 0; k < count; ++k) {
            double force[3];
            CHECK(se3d_constraint_get_reaction(s.system, s.pin[k], force, NULL) == SE3D_OK);
            CHECK_NEAR(force[0], 0.0, 1e-7);
            CHECK_NEAR(force[1], 0.0, 1e-7);
            CHECK_NEAR(force[2], (double)(count - k) * G, 1e-7);
        }
        double r[3];
        CHECK(se3d_body_get_position(s.system, s.last, r) == SE3D_OK);
        CHECK_NEAR(r[2], -LINK * ((double)count - 0.5), 1e-9);
        end(&s);
    }
}

/* A chain between two points: the horizontal force H is the same everywhere, the vertical one
 * grows by a link's weight at each, and a link points along the mean of those at its ends. */
static void a_chain_between_two_points_is_a_catenary_of_links(void)
{
    static const size_t counts[] = {10, 61, 150};
    for (int which = 0; which < 3; ++which) {
        const size_t count = counts[which];
        se3d_solver_stats stats;
        double left[3], right[3], span = 0.0;
        scene s;
        begin(&s);
        while (s.count < count) {
            add_link(&s, s.count % 2 ? 0.7 : -0.7, 0.0, 0);
        }
        s.pin[count] = add_pin(&s, s.last, s.ground, s.end, 0);
        se3d_status status = equilibrate(&s, &stats);
        CHECK(status == SE3D_INFO_REDUNDANT); /* the loop is plane without its last pin */
        CHECK(se3d_constraint_get_reaction(s.system, s.pin[0], left, NULL) == SE3D_OK);
        CHECK(left[0] < -0.1 * G);
        for (size_t k = 1; k <= count; ++k) {
            CHECK(se3d_constraint_get_reaction(s.system, s.pin[k], right, NULL) == SE3D_OK);
            CHECK_NEAR(right[0], left[0], 1e-7);
            CHECK_NEAR(right[2], left[2] - G, 1e-7);
            span += LINK * cos(atan2(0.5 * (left[2] + right[2]), -left[0]));
            memcpy(left, right, sizeof left);
        }
        CHECK_NEAR(span, s.end[0], 1e-8);
        end(&s);
    }
}

/* A table of mass M from b to d on two posts of mass m, a to b and c to d, all hinged. Returns it,
 * and the hinge at a. */
static se3d_body add_table(scene *s, const double corners[4][3], double m, double M,
                           se3d_constraint *pin)
{
    const double *a = corners[0], *b = corners[1], *c = corners[2], *d = corners[3];
    se3d_body one = add_bar(s, a, b, m), two = add_bar(s, c, d, m);
    se3d_body top = add_bar(s, b, d, M);
    *pin = add_pin(s, s->ground, one, a, 0);
    (void)add_pin(s, s->ground, two, c, 0);
    (void)add_pin(s, one, top, b, 0);
    (void)add_pin(s, two, top, d, 0);
    return top;
}

/* A table on two posts that a spring holds upright: a loop in compression, with redundant pins.
 * Its potential (M + m) g h cos(theta) + k theta^2 / 2 is least upright if k > (M + m) g h. */
static void a_table_on_hinged_posts_stands_where_its_spring_is_stiff_enough(void)
{
    const double M = 40.0, m = 3.0, h = 0.8, width = 0.6;
    const double critical = (M + m) * G * h;
    for (int which = 0; which < 4; ++which) {
        static const double share[4] = {0.5, 0.999, 1.001, 2.0};
        const double corners[4][3] = {
            {0.0, 0.0, 0.0}, {0.0, 0.0, h}, {width, 0.0, 0.0}, {width, 0.0, h}};
        se3d_solver_stats stats;
        se3d_constraint pin;
        scene s;
        begin(&s);
        se3d_body top = add_table(&s, corners, m, M, &pin);
        add_spring(&s, pin, share[which] * critical, 0.0);
        se3d_status status = equilibrate(&s, &stats);
        CHECK(status == (share[which] > 1.0 ? SE3D_INFO_REDUNDANT : SE3D_INFO_UNSTABLE));
        double r[3];
        CHECK(se3d_body_get_position(s.system, top, r) == SE3D_OK);
        CHECK_NEAR(r[2], h, 1e-12);
        end(&s);
    }
}

/* From a little off, where the spring is too soft, it leans as far as
 * (M + m) g h sin(theta) = k theta. */
static void a_table_on_a_soft_spring_leans(void)
{
    const double M = 40.0, m = 3.0, h = 0.8, width = 0.6, lean = 1.0;
    const double k = (M + m) * G * h * sin(lean) / lean;
    const double x = h * sin(0.02), z = h * cos(0.02);
    const double corners[4][3] = {
        {0.0, 0.0, 0.0}, {x, 0.0, z}, {width, 0.0, 0.0}, {width + x, 0.0, z}};
    se3d_solver_stats stats;
    se3d_constraint pin;
    double theta, rate, acceleration;
    scene s;
    begin(&s);
    (void)add_table(&s, corners, m, M, &pin);
    add_spring(&s, pin, k, -0.02); /* at the present pose the angle is 0 */
    CHECK(equilibrate(&s, &stats) == SE3D_INFO_REDUNDANT);
    CHECK(se3d_joint_get_coordinate(s.system, pin, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                    &acceleration) == SE3D_OK);
    CHECK_NEAR(fabs(theta + 0.02), lean, 1e-9);
    end(&s);
}

/* A cloth of point masses on springs, held at its corners: many loops, no constraints. */
static void a_cloth_hangs_from_its_corners(void)
{
    enum { SIDE = 12 };
    const double m = 0.01, k = 200.0, pitch = 0.1;
    se3d_body knot[SIDE * SIDE];
    se3d_force corner[4];
    se3d_solver_stats stats;
    scene s;
    begin(&s);
    seed = 42;
    for (int e = 0; e < SIDE * SIDE; ++e) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = m;
        def.inertia[0] = def.inertia[1] = def.inertia[2] = 1e-6;
        def.position[0] = pitch * (e % SIDE) + 0.02 * (next() - 0.5);
        def.position[1] = pitch * (int)(e / SIDE) + 0.02 * (next() - 0.5);
        def.position[2] = 0.05 * (next() - 0.5);
        CHECK(se3d_body_create(s.system, &def, &knot[e]) == SE3D_OK);
    }
    se3d_tsda_def def = se3d_tsda_def_default();
    def.k = k;
    def.l0 = pitch;
    for (int e = 0; e < SIDE * SIDE; ++e) {
        se3d_force force;
        def.body_i = knot[e];
        if (e % SIDE < SIDE - 1) {
            def.body_j = knot[e + 1];
            CHECK(se3d_force_create_tsda(s.system, &def, &force) == SE3D_OK);
        }
        if (e / SIDE < SIDE - 1) {
            def.body_j = knot[e + SIDE];
            CHECK(se3d_force_create_tsda(s.system, &def, &force) == SE3D_OK);
        }
    }
    for (int e = 0; e < 4; ++e) {
        const int right = e % 2, back = e / 2;
        def.body_i = s.ground;
        def.body_j = knot[(SIDE - 1) * (right + SIDE * back)];
        def.point_i[0] = pitch * (right ? SIDE : -1);
        def.point_i[1] = pitch * (back ? SIDE : -1);
        def.point_i[2] = 0.3;
        CHECK(se3d_force_create_tsda(s.system, &def, &corner[e]) == SE3D_OK);
    }
    CHECK(equilibrate(&s, &stats) == SE3D_INFO_NEUTRAL); /* its balls turn */
    CHECK(stats.iterations < 100);
    double lift = 0.0;
    for (int e = 0; e < 4; ++e) {
        double wrench[6];
        CHECK(se3d_force_get_wrench(s.system, corner[e], 1, wrench) == SE3D_OK);
        lift += wrench[2];
    }
    CHECK_NEAR(lift, SIDE * SIDE * m * G, 1e-10);
    end(&s);
}

/* A force that turns with a bar has no potential: k theta = F l. */
static void a_following_force_is_balanced_in_few_steps(void)
{
    const double k = 30.0, F = 50.0, l = 0.4;
    const double tip[3] = {l, 0.0, 0.0};
    se3d_force force;
    se3d_solver_stats stats;
    double theta, rate, acceleration;
    scene s;
    begin(&s);
    CHECK(se3d_system_set_gravity(s.system, origin) == SE3D_OK);
    se3d_body bar = add_bar(&s, origin, tip, 1.0);
    se3d_constraint pin = add_pin(&s, s.ground, bar, origin, 0);
    add_spring(&s, pin, k, 0.0);
    se3d_load_def load = se3d_load_def_default();
    load.body = bar;
    load.point[0] = 0.5 * l;
    load.value[2] = -F;
    load.in_body_frame = 1;
    CHECK(se3d_force_create_load(s.system, &load, &force) == SE3D_OK);
    CHECK(equilibrate(&s, &stats) == SE3D_OK);
    CHECK(stats.iterations < 40);
    CHECK(se3d_joint_get_coordinate(s.system, pin, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                    &acceleration) == SE3D_OK);
    CHECK_NEAR(fabs(theta), F * l / k, 1e-12);
    end(&s);
}

/* Balls that are dropped on a plane press on it with their weight. */
static void balls_rest_on_a_plane(void)
{
    enum { BALLS = 12 };
    const double stiffness = 1e5;
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    se3d_shape shape;
    se3d_body ball[BALLS];
    se3d_solver_stats stats;
    scene s;
    begin(&s);
    seed = 9;
    def.density = 250.0;
    def.stiffness = stiffness;
    def.restitution = 0.3;
    CHECK(se3d_material_create(s.system, &def, &material) == SE3D_OK);
    se3d_shape_def solid = se3d_shape_def_default(), plane = solid;
    solid.material = plane.material = material;
    solid.radius = 0.1;
    plane.normal[2] = 1.0;
    CHECK(se3d_shape_create_plane(s.system, &plane, &shape) == SE3D_OK);
    for (int k = 0; k < BALLS; ++k) {
        se3d_body_def body = se3d_body_def_default();
        body.mass = 1.0 + k;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.004 * body.mass;
        body.position[0] = 0.5 * k;
        body.position[2] = 0.1 + 0.3 * next();
        CHECK(se3d_body_create(s.system, &body, &ball[k]) == SE3D_OK);
        solid.body = ball[k];
        CHECK(se3d_shape_create_sphere(s.system, &solid, &shape) == SE3D_OK);
    }
    CHECK(equilibrate(&s, &stats) == SE3D_INFO_NEUTRAL); /* they roll */
    for (int k = 0; k < BALLS; ++k) {
        double r[3];
        CHECK(se3d_body_get_position(s.system, ball[k], r) == SE3D_OK);
        CHECK_NEAR(r[2], 0.1 - (1.0 + k) * G / stiffness, 1e-9);
    }
    end(&s);
}

int main(void)
{
    RUN(chains_hang_from_any_start);
    RUN(a_chain_between_two_points_is_a_catenary_of_links);
    RUN(a_table_on_hinged_posts_stands_where_its_spring_is_stiff_enough);
    RUN(a_table_on_a_soft_spring_leans);
    RUN(a_cloth_hangs_from_its_corners);
    RUN(a_following_force_is_balanced_in_few_steps);
    RUN(balls_rest_on_a_plane);
    return check_finish();
}
