/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibria and small motions against closed forms. */
#include "check.h"

#include "se3d/modes.h"
#include "se3d/se3d.h"
#include "support/world.h"

#include <stdlib.h>

#define PI 3.14159265358979323846

static const double along_x[3] = {1.0, 0.0, 0.0};
static const double along_z[3] = {0.0, 0.0, 1.0};
static const double down_y[3] = {0.0, -9.81, 0.0};
static const double origin[3] = {0.0, 0.0, 0.0};

static se3d_system *begin(const double gravity[3], se3d_body *ground)
{
    se3d_system *system = NULL;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(system, gravity) == SE3D_OK);
    CHECK(se3d_system_get_ground(system, ground) == SE3D_OK);
    return system;
}

/* A bar in the x, y plane with its centre at (x, y), turned by theta about z. */
static se3d_body add_bar(se3d_system *system, double mass, double inertia, double x, double y,
                         double theta)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.mass = mass;
    def.inertia[0] = 0.5 * inertia;
    def.inertia[1] = def.inertia[2] = inertia;
    def.position[0] = x;
    def.position[1] = y;
    def.orientation[0] = cos(0.5 * theta);
    def.orientation[3] = sin(0.5 * theta);
    CHECK(se3d_body_create(system, &def, &body) == SE3D_OK);
    return body;
}

static se3d_constraint add_hinge(se3d_system *system, se3d_body i, se3d_body j, double x, double y,
                                 double angle)
{
    const double at[3] = {x, y, 0.0};
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = i;
    def.body_j = j;
    def.angle0 = angle;
    CHECK(se3d_joint_def_set_frame(system, &def, at, along_z, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(system, &def, &joint) == SE3D_OK);
    return joint;
}

static se3d_status equilibrate(se3d_system *system, se3d_solver_stats *stats)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_EQUILIBRIUM;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    se3d_status status = se3d_solver_run(solver, 0.0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    if (stats) {
        CHECK(se3d_solver_get_stats(solver, stats) == SE3D_OK);
    }
    se3d_solver_destroy(solver);
    return status;
}

static se3d_modes *linearise(se3d_system *system, const se3d_modes_def *def)
{
    se3d_modes *modes = NULL;
    se3d_status status = se3d_modes_create(system, def, &modes);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    CHECK(status == SE3D_OK);
    return modes;
}

static void check_frequency(const se3d_modes *modes, size_t k, double w)
{
    se3d_eigenvalue value;
    CHECK(se3d_modes_get_eigenvalue(modes, k, &value) == SE3D_OK);
    CHECK_NEAR(value.imaginary, w, 1e-10 * w);
    CHECK_NEAR(2.0 * PI * value.frequency, w, 1e-10 * w);
    CHECK_NEAR(value.damping, 0.0, 1e-12);
    CHECK(!signbit(value.damping) || value.damping < 0.0); /* not printed as -0 */
}

/* tests/data: theta = -0.28098791701246252. */
static void a_bar_on_two_springs_rests_where_the_reference_does(void)
{
    se3d_body ground;
    se3d_force force;
    double theta, rate, acceleration;
    se3d_system *system = begin(down_y, &ground);
    se3d_body bar = add_bar(system, 10.0, 10.0 / 12.0, 0.5, 0.0, 0.0);
    se3d_constraint pin = add_hinge(system, ground, bar, 0.0, 0.0, 0.0);
    se3d_rsda_def rsda = se3d_rsda_def_default();
    rsda.joint = pin;
    rsda.k = 20.0;
    rsda.c = 1.5;
    CHECK(se3d_force_create_rsda(system, &rsda, &force) == SE3D_OK);
    se3d_tsda_def tsda = se3d_tsda_def_default();
    tsda.body_i = bar;
    tsda.body_j = ground;
    tsda.point_i[0] = 0.5;
    tsda.point_j[0] = 1.5;
    tsda.point_j[1] = 0.5;
    tsda.k = 300.0;
    tsda.c = 5.0;
    tsda.l0 = 0.8;
    CHECK(se3d_force_create_tsda(system, &tsda, &force) == SE3D_OK);
    se3d_solver_stats stats;
    CHECK(equilibrate(system, &stats) == SE3D_OK);
    CHECK(stats.iterations < 30); /* a few of Newton, each put back on the joint */
    CHECK(se3d_joint_get_coordinate(system, pin, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                    &acceleration) == SE3D_OK);
    CHECK_NEAR(theta, -0.28098791701246252, 1e-12);
    /* the pin carries what is left of weight and spring */
    double reaction[3], pull[6];
    CHECK(se3d_constraint_get_reaction(system, pin, reaction, NULL) == SE3D_OK);
    CHECK(se3d_force_get_wrench(system, force, 0, pull) == SE3D_OK);
    CHECK_NEAR(reaction[0], -pull[0], 1e-10);
    CHECK_NEAR(reaction[1], 98.1 - pull[1], 1e-10);
    se3d_system_destroy(system);
}

/* A body that hangs on three springs in space, from a bad guess: forces and moments balance. */
static void a_body_on_three_springs_comes_to_rest_from_a_bad_guess(void)
{
    se3d_body ground, body;
    se3d_force spring[3];
    const double gravity[3] = {0.0, 0.0, -9.81};
    const double anchor[3][3] = {{1.0, 0.0, 2.0}, {-0.6, 0.9, 2.2}, {-0.5, -0.8, 1.9}};
    const double eye[3][3] = {{0.3, 0.0, 0.1}, {-0.2, 0.2, 0.1}, {-0.2, -0.2, 0.1}};
    se3d_system *system = begin(gravity, &ground);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 5.0;
    def.inertia[0] = 0.1;
    def.inertia[1] = 0.15;
    def.inertia[2] = 0.2;
    def.position[0] = 1.5;
    def.position[2] = 3.0;
    def.orientation[0] = cos(1.2);
    def.orientation[1] = sin(1.2);
    CHECK(se3d_body_create(system, &def, &body) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        se3d_tsda_def tsda = se3d_tsda_def_default();
        tsda.body_i = ground;
        tsda.body_j = body;
        memcpy(tsda.point_i, anchor[k], sizeof anchor[k]);
        memcpy(tsda.point_j, eye[k], sizeof eye[k]);
        tsda.k = 100.0 + 20.0 * k;
        tsda.l0 = 1.0;
        CHECK(se3d_force_create_tsda(system, &tsda, &spring[k]) == SE3D_OK);
    }
    CHECK(equilibrate(system, NULL) == SE3D_OK);
    double sum[6] = {0.0, 0.0, -5.0 * 9.81, 0.0, 0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
        double wrench[6];
        CHECK(se3d_force_get_wrench(system, spring[k], 1, wrench) == SE3D_OK);
        for (int c = 0; c < 6; ++c) {
            sum[c] += wrench[c];
        }
    }
    for (int c = 0; c < 6; ++c) {
        CHECK_NEAR(sum[c], 0.0, 1e-10);
    }
    se3d_system_destroy(system);
}

static void an_unstable_equilibrium_is_reported(void)
{
    for (int upright = 0; upright < 2; ++upright) {
        se3d_body ground;
        double r[3], reaction[3];
        se3d_system *system = begin(down_y, &ground);
        double side = upright ? 0.5 : -0.5;
        se3d_body bar = add_bar(system, 10.0, 1.0, 0.0, side, 0.5 * PI);
        se3d_constraint pin = add_hinge(system, ground, bar, 0.0, 0.0, 0.0);
        CHECK(equilibrate(system, NULL) == (upright ? SE3D_INFO_UNSTABLE : SE3D_OK));
        CHECK(se3d_body_get_position(system, bar, r) == SE3D_OK);
        CHECK_NEAR(r[1], side, 1e-14);
        CHECK(se3d_constraint_get_reaction(system, pin, reaction, NULL) == SE3D_OK);
        CHECK_NEAR(reaction[1], 98.1, 1e-11);
        se3d_system_destroy(system);
    }
}

/* From a little off the unstable position it goes to the stable one. */
static void the_stable_equilibrium_is_found_from_near_the_unstable_one(void)
{
    se3d_body ground;
    double r[3];
    se3d_system *system = begin(down_y, &ground);
    se3d_body bar = add_bar(system, 10.0, 1.0, 0.5 * sin(0.1), 0.5 * cos(0.1), 0.0);
    (void)add_hinge(system, ground, bar, 0.0, 0.0, 0.0);
    CHECK(equilibrate(system, NULL) == SE3D_OK);
    CHECK(se3d_body_get_position(system, bar, r) == SE3D_OK);
    CHECK_NEAR(r[1], -0.5, 1e-14);
    CHECK_NEAR(r[0], 0.0, 1e-12);
    se3d_system_destroy(system);
}

static void where_nothing_holds_a_body_there_is_no_equilibrium(void)
{
    se3d_body ground;
    se3d_solver *solver = NULL;
    se3d_system *system = begin(down_y, &ground);
    (void)add_bar(system, 1.0, 1.0, 0.0, 0.0, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_EQUILIBRIUM;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 0.0) == SE3D_ERR_NO_CONVERGENCE);
    CHECK_CONTAINS(se3d_system_get_error(system), "no equilibrium");
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void a_pendulum_swings_at_its_frequency(void)
{
    se3d_body ground;
    se3d_system *system = begin(down_y, &ground);
    se3d_body bar = add_bar(system, 78.0, 104.01625, 1.9, -0.3, 0.0);
    (void)add_hinge(system, ground, bar, 0.0, 0.0, 0.0);
    CHECK(equilibrate(system, NULL) == SE3D_OK);
    double L = sqrt(1.9 * 1.9 + 0.09);
    se3d_modes *modes = linearise(system, NULL);
    CHECK(se3d_modes_count(modes) == 1);
    CHECK(se3d_modes_count_freedoms(modes) == 1);
    check_frequency(modes, 0, sqrt(78.0 * 9.81 * L / (104.01625 + 78.0 * L * L)));
    double shape[6];
    CHECK(se3d_modes_get_shape(modes, 0, 1, shape, NULL) == SE3D_OK);
    CHECK_NEAR(shape[0], 1.0, 1e-12); /* it hangs: the centre moves along x */
    CHECK_NEAR(shape[1], 0.0, 1e-10);
    CHECK_NEAR(shape[5], 1.0 / L, 1e-10);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

/* Two bars: det(K - w^2 M) = 0 with M = [J1 + m1 a1^2 + m2 l1^2, m2 l1 a2; ., J2 + m2 a2^2]. */
static void a_double_pendulum_swings_at_its_frequencies(void)
{
    const double m1 = 3.0, J1 = 0.7, a1 = 0.5, l1 = 1.0, m2 = 2.0, J2 = 0.4, a2 = 0.6;
    const double g = 9.81;
    se3d_body ground;
    se3d_system *system = begin(down_y, &ground);
    se3d_body one = add_bar(system, m1, J1, 0.0, -a1, 0.0);
    se3d_body two = add_bar(system, m2, J2, 0.0, -l1 - a2, 0.0);
    (void)add_hinge(system, ground, one, 0.0, 0.0, 0.0);
    (void)add_hinge(system, one, two, 0.0, -l1, 0.0);
    double M11 = J1 + m1 * a1 * a1 + m2 * l1 * l1;
    double M12 = m2 * l1 * a2;
    double M22 = J2 + m2 * a2 * a2;
    double K1 = (m1 * a1 + m2 * l1) * g;
    double K2 = m2 * a2 * g;
    double A = M11 * M22 - M12 * M12;
    double B = -(K1 * M22 + K2 * M11);
    double root = sqrt(B * B - 4.0 * A * K1 * K2);
    se3d_modes *modes = linearise(system, NULL);
    CHECK(se3d_modes_count(modes) == 2);
    check_frequency(modes, 0, sqrt((-B - root) / (2.0 * A)));
    check_frequency(modes, 1, sqrt((-B + root) / (2.0 * A)));
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

/* An upright bar falls: two real eigenvalues. */
static void an_upright_bar_has_a_growing_and_a_fading_mode(void)
{
    se3d_body ground;
    se3d_eigenvalue value[2];
    se3d_system *system = begin(down_y, &ground);
    se3d_body bar = add_bar(system, 2.0, 0.5, 0.0, 0.5, 0.0);
    (void)add_hinge(system, ground, bar, 0.0, 0.0, 0.0);
    se3d_modes *modes = linearise(system, NULL);
    CHECK(se3d_modes_count(modes) == 2);
    CHECK(se3d_modes_get_eigenvalue(modes, 0, &value[0]) == SE3D_OK);
    CHECK(se3d_modes_get_eigenvalue(modes, 1, &value[1]) == SE3D_OK);
    double s = sqrt(2.0 * 9.81 * 0.5 / (0.5 + 2.0 * 0.25));
    CHECK_NEAR(value[0].real * value[1].real, -s * s, 1e-9);
    CHECK_NEAR(fabs(value[0].real), s, 1e-10);
    CHECK_NEAR(value[0].imaginary, 0.0, 0.0);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

/* n masses between n + 1 equal springs: w_k = 2 sqrt(k/m) sin(k pi / (2 (n + 1))). With dampers in
 * proportion b to the stiffness the damping ratio is b w_k / 2. */
static void spring_mass_chains_vibrate_at_their_frequencies(void)
{
    enum { N = 6 };
    for (int damped = 0; damped < 2; ++damped) {
        se3d_body ground, mass[N + 2];
        double b = damped ? 0.004 : 0.0;
        se3d_system *system = begin(origin, &ground);
        mass[0] = mass[N + 1] = ground;
        for (int k = 1; k <= N; ++k) {
            mass[k] = add_bar(system, 2.0, 0.1, k, 0.0, 0.3 * k);
            const double at[3] = {k, 0.0, 0.0};
            (void)world_join(system, se3d_joint_create_prismatic, NULL, ground, mass[k], at,
                             along_x);
        }
        for (int k = 0; k <= N; ++k) {
            se3d_force force;
            se3d_tsda_def spring = se3d_tsda_def_default();
            spring.body_i = mass[k];
            spring.body_j = mass[k + 1];
            spring.point_j[0] = k == N ? N + 1 : 0.0;
            spring.k = 5000.0;
            spring.c = b * 5000.0;
            spring.l0 = 1.0;
            CHECK(se3d_force_create_tsda(system, &spring, &force) == SE3D_OK);
        }
        CHECK(equilibrate(system, NULL) == SE3D_OK);
        se3d_modes *modes = linearise(system, NULL);
        CHECK(se3d_modes_count(modes) == N);
        for (int k = 1; k <= N; ++k) {
            se3d_eigenvalue value;
            double w = 2.0 * sqrt(2500.0) * sin(k * PI / (2.0 * (N + 1)));
            CHECK(se3d_modes_get_eigenvalue(modes, (size_t)k - 1, &value) == SE3D_OK);
            CHECK_NEAR(2.0 * PI * value.frequency, w, 1e-9 * w);
            CHECK_NEAR(value.damping, 0.5 * b * w, 1e-10);
            CHECK_NEAR(value.imaginary, w * sqrt(1.0 - 0.25 * b * b * w * w), 1e-9 * w);
            for (int j = 1; j <= N; ++j) { /* sines */
                double shape[6], first[6];
                CHECK(se3d_modes_get_shape(modes, (size_t)k - 1, (size_t)j, shape, NULL) ==
                      SE3D_OK);
                CHECK(se3d_modes_get_shape(modes, (size_t)k - 1, 1, first, NULL) == SE3D_OK);
                CHECK_NEAR(shape[0] * sin(k * PI / (N + 1)), first[0] * sin(j * k * PI / (N + 1)),
                           1e-9);
            }
        }
        se3d_modes_destroy(modes);
        se3d_system_destroy(system);
    }
}

/* A cantilever of n rigid links with springs EI / (L / n) between them (twice that at the wall, as
 * half a link bends there): to the first frequency of Euler and Bernoulli. */
static double beam_frequency(int n)
{
    const double EI = 120.0, L = 2.0, mass = 3.0;
    double l = L / n;
    double m = mass / n;
    se3d_body ground;
    se3d_eigenvalue value;
    se3d_system *system = begin(origin, &ground);
    se3d_body before = ground;
    for (int k = 0; k < n; ++k) {
        se3d_force force;
        se3d_body link = add_bar(system, m, m * l * l / 12.0, (k + 0.5) * l, 0.0, 0.0);
        se3d_constraint hinge = add_hinge(system, before, link, k * l, 0.0, 0.0);
        se3d_rsda_def spring = se3d_rsda_def_default();
        spring.joint = hinge;
        spring.k = (k == 0 ? 2.0 : 1.0) * EI / l;
        CHECK(se3d_force_create_rsda(system, &spring, &force) == SE3D_OK);
        before = link;
    }
    se3d_modes *modes = linearise(system, NULL);
    CHECK(se3d_modes_count(modes) == (size_t)n);
    CHECK(se3d_modes_get_eigenvalue(modes, 0, &value) == SE3D_OK);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
    return value.imaginary;
}

static void a_beam_of_links_converges_to_euler_and_bernoulli(void)
{
    const double root = 1.87510406871196117;
    double exact = root * root * sqrt(120.0 * 2.0 / 3.0) / 4.0; /* sqrt(EI L/m)/L^2 */
    double coarse = fabs(beam_frequency(8) - exact) / exact;
    double middle = fabs(beam_frequency(16) - exact) / exact;
    double fine = fabs(beam_frequency(32) - exact) / exact;
    CHECK(fine < 2e-3);
    CHECK_NEAR(coarse / middle, 4.0, 0.3);
    CHECK_NEAR(middle / fine, 4.0, 0.15);
}

/* A sleeping top that turns with w about the vertical: J1 z'' - i J3 w z' - m g l z = 0 for its
 * tilt z in a fixed frame, s = i (J3 w +- sqrt(J3^2 w^2 - 4 J1 m g l)) / (2 J1); in its own axes s
 * - i w. */
static void a_spinning_top_precesses_and_nutates(void)
{
    const double m = 2.0, l = 0.3, Jt = 0.05, J3 = 0.04, w = 60.0;
    const double gravity[3] = {0.0, 0.0, -9.81};
    const double J1 = Jt + m * l * l;
    se3d_body ground, top;
    se3d_system *system = begin(gravity, &ground);
    se3d_body_def def = se3d_body_def_default();
    def.mass = m;
    def.inertia[0] = def.inertia[1] = Jt;
    def.inertia[2] = J3;
    def.position[2] = l;
    def.angular_velocity[2] = w;
    CHECK(se3d_body_create(system, &def, &top) == SE3D_OK);
    (void)world_join(system, se3d_joint_create_spherical, NULL, ground, top, origin, along_z);
    se3d_modes *modes = linearise(system, NULL);
    double root = sqrt(J3 * J3 * w * w - 4.0 * J1 * m * 9.81 * l);
    CHECK(J3 * J3 * w * w < 4.0 * J1 * m * 9.81 * l || root > 0.0);
    double a = fabs((J3 * w - root) / (2.0 * J1) - w);
    double b = fabs((J3 * w + root) / (2.0 * J1) - w);
    int found = 0;
    for (size_t k = 0; k < se3d_modes_count(modes); ++k) {
        se3d_eigenvalue value;
        CHECK(se3d_modes_get_eigenvalue(modes, k, &value) == SE3D_OK);
        found += fabs(value.imaginary - a) < 1e-8 * a && fabs(value.real) < 1e-7;
        found += fabs(value.imaginary - b) < 1e-8 * b && fabs(value.real) < 1e-7;
    }
    CHECK(found == 2);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

/* m x'' + c x' + k x = F: 1/(k - m w^2 + i c w), and the matrices that belong to it. */
static void transfer_functions_and_matrices_of_an_oscillator(void)
{
    const double m = 2.0, c = 3.0, k = 50.0;
    se3d_body ground;
    se3d_force force;
    se3d_system *system = begin(origin, &ground);
    se3d_body mass = add_bar(system, m, 0.1, 0.0, 0.0, 0.0);
    (void)world_join(system, se3d_joint_create_prismatic, NULL, ground, mass, origin, along_x);
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.body_i = ground;
    spring.body_j = mass;
    spring.point_i[0] = -1.0;
    spring.k = k;
    spring.c = c;
    spring.l0 = 1.0;
    CHECK(se3d_force_create_tsda(system, &spring, &force) == SE3D_OK);
    se3d_modes_input input = {.body = mass, .direction = {2.0, 0.0, 0.0}};
    se3d_modes_output output[3] = {
        {.body = mass, .quantity = SE3D_MODES_POSITION, .direction = {1.0, 0.0, 0.0}},
        {.body = mass, .quantity = SE3D_MODES_VELOCITY, .direction = {1.0, 0.0, 0.0}},
        {.body = mass, .quantity = SE3D_MODES_ACCELERATION, .direction = {1.0, 0.0, 0.0}}};
    se3d_modes_def def = se3d_modes_def_default();
    def.inputs = &input;
    def.input_count = 1;
    def.outputs = output;
    def.output_count = 3;
    se3d_modes *modes = linearise(system, &def);
    for (int step = 1; step < 10; ++step) {
        double frequency = 0.2 * step;
        double w = 2.0 * PI * frequency;
        double square = (k - m * w * w) * (k - m * w * w) + c * c * w * w;
        double re = (k - m * w * w) / square;
        double im = -c * w / square;
        double got[2];
        CHECK(se3d_modes_get_transfer(modes, 0, 0, frequency, &got[0], &got[1]) == SE3D_OK);
        CHECK_NEAR(got[0], re, 1e-14);
        CHECK_NEAR(got[1], im, 1e-14);
        CHECK(se3d_modes_get_transfer(modes, 0, 1, frequency, &got[0], &got[1]) == SE3D_OK);
        CHECK_NEAR(got[0], -w * im, 1e-13);
        CHECK_NEAR(got[1], w * re, 1e-13);
        CHECK(se3d_modes_get_transfer(modes, 0, 2, frequency, &got[0], &got[1]) == SE3D_OK);
        CHECK_NEAR(got[0], -w * w * re, 1e-12);
        CHECK_NEAR(got[1], -w * w * im, 1e-12);
    }
    size_t rows, columns;
    double A[4], B[2], C[6], D[3];
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_A, &rows, &columns, A, 4) == SE3D_OK);
    CHECK(rows == 2 && columns == 2);
    CHECK_NEAR(A[0], 0.0, 0.0);
    CHECK_NEAR(A[1], 1.0, 0.0);
    CHECK_NEAR(A[2], -k / m, 1e-13);
    CHECK_NEAR(A[3], -c / m, 1e-14);
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_B, &rows, &columns, B, 2) == SE3D_OK);
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_C, &rows, &columns, C, 6) == SE3D_OK);
    CHECK(rows == 3 && columns == 2);
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_D, &rows, &columns, D, 3) == SE3D_OK);
    CHECK_NEAR(C[0] * B[1], 1.0 / m, 1e-14); /* the sign of y is free */
    CHECK_NEAR(fabs(C[3]), 1.0, 1e-14);
    CHECK_NEAR(C[0] * C[4], -k / m, 1e-13);
    CHECK_NEAR(D[2], 1.0 / m, 1e-14);
    CHECK_NEAR(D[0], 0.0, 0.0);
    CHECK(se3d_modes_get_matrix(modes, SE3D_MODES_A, &rows, &columns, A, 3) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_modes_get_matrix(modes, 9, &rows, &columns, NULL, 0) == SE3D_ERR_INVALID_ARGUMENT);
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

enum { MASSES = 2 };
static const double masses[MASSES] = {2.0, 3.0};
static const double stiff[MASSES][MASSES] = {{50.0, 7.0}, {-4.0, 80.0}};
static const double damp[MASSES][MASSES] = {{1.0, -0.5}, {0.8, 2.0}};

/* Forces along x that belong to no potential: -stiff x - damp v. */
static se3d_status skew_spring(void *ctx, double t, const se3d_body_motion motion[2],
                               double wrench[12], double *K, double *D)
{
    (void)ctx;
    (void)t;
    for (int r = 0; r < MASSES; ++r) {
        wrench[6 * r] = 0.0;
        for (int c = 0; c < MASSES; ++c) {
            wrench[6 * r] -= stiff[r][c] * motion[c].r[0] + damp[r][c] * motion[c].v[0];
            if (K) {
                K[12 * (6 * r) + 6 * c] = -stiff[r][c];
                D[12 * (6 * r) + 6 * c] = -damp[r][c];
            }
        }
    }
    return SE3D_OK;
}

/* Two bodies on rails along x, tied by those forces. */
static se3d_system *make_skew_pair(int has_jacobian, se3d_body body[MASSES])
{
    se3d_body ground;
    se3d_system *system = begin(origin, &ground);
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_force force;
    for (int k = 0; k < MASSES; ++k) {
        body[k] = add_bar(system, masses[k], 0.1, 0.0, k, 0.3 * k);
        const double at[3] = {0.0, k, 0.0};
        (void)world_join(system, se3d_joint_create_prismatic, NULL, ground, body[k], at, along_x);
    }
    def.body_i = body[0];
    def.body_j = body[1];
    def.callback = skew_spring;
    def.has_jacobian = has_jacobian;
    CHECK(se3d_force_create_callback(system, &def, &force) == SE3D_OK);
    return system;
}

/* Element (output, input) of (stiff + i w damp - w^2 masses)^-1. */
static void skew_compliance(double w, int output, int input, double got[2])
{
    double re[MASSES][MASSES], im[MASSES][MASSES];
    for (int r = 0; r < MASSES; ++r) {
        for (int c = 0; c < MASSES; ++c) {
            re[r][c] = stiff[r][c] - (r == c ? w * w * masses[r] : 0.0);
            im[r][c] = w * damp[r][c];
        }
    }
    const double det[2] = {
        re[0][0] * re[1][1] - im[0][0] * im[1][1] - re[0][1] * re[1][0] + im[0][1] * im[1][0],
        re[0][0] * im[1][1] + im[0][0] * re[1][1] - re[0][1] * im[1][0] - im[0][1] * re[1][0]};
    const int same = output == input;
    const int row = same ? 1 - output : output;
    const int column = same ? 1 - input : input;
    const double sign = same ? 1.0 : -1.0;
    const double square = det[0] * det[0] + det[1] * det[1];
    const double a = sign * re[row][column];
    const double b = sign * im[row][column];
    got[0] = (a * det[0] + b * det[1]) / square;
    got[1] = (b * det[0] - a * det[1]) / square;
}

static void a_pair_that_is_not_symmetric_answers_from_each_side_as_it_should(void)
{
    for (int has_jacobian = 0; has_jacobian < 2; ++has_jacobian) {
        const double tolerance = has_jacobian ? 1e-13 : 1e-9;
        se3d_body body[MASSES];
        se3d_system *system = make_skew_pair(has_jacobian, body);
        se3d_modes_input input[MASSES] = {{.body = body[0], .direction = {1.0, 0.0, 0.0}},
                                          {.body = body[1], .direction = {1.0, 0.0, 0.0}}};
        se3d_modes_output output[MASSES] = {
            {.body = body[0], .quantity = SE3D_MODES_POSITION, .direction = {1.0, 0.0, 0.0}},
            {.body = body[1], .quantity = SE3D_MODES_POSITION, .direction = {1.0, 0.0, 0.0}}};
        se3d_modes_def def = se3d_modes_def_default();
        def.inputs = input;
        def.outputs = output;
        def.input_count = def.output_count = MASSES;
        se3d_modes *modes = linearise(system, &def);
        for (size_t k = 0; k < 3 * MASSES * MASSES; ++k) {
            const size_t from = k % MASSES, to = k / MASSES % MASSES;
            const double frequency = 0.5 * (double)(k / (MASSES * MASSES));
            double got[2], expected[2];
            CHECK(se3d_modes_get_transfer(modes, from, to, frequency, &got[0], &got[1]) == SE3D_OK);
            skew_compliance(2.0 * PI * frequency, (int)to, (int)from, expected);
            CHECK_NEAR(got[0], expected[0], tolerance);
            CHECK_NEAR(got[1], expected[1], tolerance);
        }
        se3d_modes_destroy(modes);
        se3d_system_destroy(system);
    }
}

/* |r_2 - r_1|^2 - 1, or |r_1|^2 - 1 of one body. */
static se3d_status unit_link(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                             double *jacobian, double *nu, double *gamma)
{
    const int is_pair = ctx != NULL;
    double square = 0.0;
    double fast = 0.0;
    (void)t;
    for (int c = 0; c < 3; ++c) {
        const double d = bodies[is_pair].r[c] - (is_pair ? bodies[0].r[c] : 0.0);
        const double v = bodies[is_pair].v[c] - (is_pair ? bodies[0].v[c] : 0.0);
        square += d * d;
        fast += v * v;
        if (jacobian) {
            jacobian[6 * is_pair + c] = 2.0 * d;
            jacobian[6 * is_pair + 3 + c] = 0.0;
        }
        if (jacobian && is_pair) {
            jacobian[c] = -2.0 * d;
            jacobian[3 + c] = 0.0;
        }
    }
    if (phi) {
        phi[0] = square - 1.0;
    }
    if (nu) {
        nu[0] = 0.0;
    }
    if (gamma) {
        gamma[0] = -2.0 * fast;
    }
    return SE3D_OK;
}

/* Two masses on strings that callbacks keep at 1 m: all of their stiffness is the second derivative
 * of the constraints, w^2 = (2 -+ sqrt 2) g, each in two directions. */
static void strings_by_callback_swing_at_their_frequencies(void)
{
    int pair = 1;
    se3d_body ground;
    se3d_constraint joint;
    se3d_system *system = begin(down_y, &ground);
    se3d_body body[2];
    for (int k = 0; k < 2; ++k) {
        se3d_user_constraint_def def = se3d_user_constraint_def_default();
        body[k] = add_bar(system, 2.0, 0.1, 0.0, -1.0 - k, 0.0);
        se3d_joint_def turned = se3d_joint_def_default();
        turned.body_i = ground;
        turned.body_j = body[k];
        CHECK(se3d_joint_create_orientation(system, &turned, &joint) == SE3D_OK);
        def.callback = unit_link;
        def.ctx = k == 1 ? &pair : NULL;
        def.body_count = k + 1;
        memcpy(def.bodies, body, (size_t)(k + 1) * sizeof *body);
        CHECK(se3d_user_constraint_create(system, &def, &joint) == SE3D_OK);
    }
    se3d_modes *modes = linearise(system, NULL);
    CHECK(se3d_modes_count(modes) == 4);
    for (size_t k = 0; k < 4; ++k) {
        se3d_eigenvalue value;
        const double w = sqrt(9.81 * (2.0 + (k < 2 ? -sqrt(2.0) : sqrt(2.0))));
        CHECK(se3d_modes_get_eigenvalue(modes, k, &value) == SE3D_OK);
        CHECK_NEAR(value.imaginary, w, 1e-7 * w); /* that derivative is by differences */
    }
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(a_pair_that_is_not_symmetric_answers_from_each_side_as_it_should);
    RUN(strings_by_callback_swing_at_their_frequencies);
    RUN(a_bar_on_two_springs_rests_where_the_reference_does);
    RUN(a_body_on_three_springs_comes_to_rest_from_a_bad_guess);
    RUN(an_unstable_equilibrium_is_reported);
    RUN(the_stable_equilibrium_is_found_from_near_the_unstable_one);
    RUN(where_nothing_holds_a_body_there_is_no_equilibrium);
    RUN(a_pendulum_swings_at_its_frequency);
    RUN(a_double_pendulum_swings_at_its_frequencies);
    RUN(an_upright_bar_has_a_growing_and_a_fading_mode);
    RUN(spring_mass_chains_vibrate_at_their_frequencies);
    RUN(a_beam_of_links_converges_to_euler_and_bernoulli);
    RUN(a_spinning_top_precesses_and_nutates);
    RUN(transfer_functions_and_matrices_of_an_oscillator);
    return check_finish();
}
