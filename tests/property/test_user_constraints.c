/* SPDX-License-Identifier: BSD-3-Clause */
/* User-defined constraints: a distance by callback is the distance joint in every analysis, with
 * every method, in both formulations; equations whose Phi_t depends on positions against a closed
 * form; callbacks that fail. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/world.h"

#include <stdlib.h>

/* d.d - f(t) with f = (length + rate sin(2 t))^2, d = A_1 s_1 + r_1 - A_0 s_0 - r_0 */
typedef struct distance {
    double s[2][3], length, rate;
    int fail_after, calls;
    int wrong_number; /* 1 phi, 2 nu, 3 gamma, 4 the Jacobian is not finite */
    int bent;         /* > 0: the call, of those for the Jacobian alone, that fails */
} distance;

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void rotate(const double p[4], const double s[3], double out[3])
{
    const double *e = p + 1;
    double once[3], twice[3];
    cross(e, s, once);
    cross(e, once, twice);
    for (int k = 0; k < 3; ++k) {
        out[k] = s[k] + 2.0 * (p[0] * once[k] + twice[k]);
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A^T y */
static void rotate_back(const double p[4], const double y[3], double out[3])
{
    const double back[4] = {p[0], -p[1], -p[2], -p[3]};
    rotate(back, y, out);
}

/* What is to be wrong. */
static se3d_status spoil(distance *c, double *phi, double *jacobian, double *nu, double *gamma)
{
    double *const wrong[] = {NULL, phi, nu, gamma, jacobian ? jacobian + 11 : NULL};
    if (wrong[c->wrong_number]) {
        *wrong[c->wrong_number] = c->wrong_number % 2 ? (double)NAN : HUGE_VAL;
    }
    return jacobian && !phi && !nu && !gamma && c->bent > 0 && --c->bent == 0 ? -78 : SE3D_OK;
}

static se3d_status distance_eval(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                                 double *jacobian, double *nu, double *gamma)
{
    distance *c = ctx;
    double d[3] = {0}, ddot[3] = {0}, turned[3] = {0};
    double f = c->length + c->rate * sin(2.0 * t), f1 = 2.0 * c->rate * cos(2.0 * t);
    double f2 = -4.0 * c->rate * sin(2.0 * t);
    if (c->fail_after > 0 && ++c->calls > c->fail_after) {
        return -77;
    }
    for (int k = 0; k < 2; ++k) {
        const se3d_body_motion *b = &bodies[k];
        double sign = k ? 1.0 : -1.0, arm[3], wxs[3], rate[3], wxwxs[3], twice[3];
        rotate(b->p, c->s[k], arm);
        cross(b->w, c->s[k], wxs);
        cross(b->w, wxs, wxwxs);
        rotate(b->p, wxs, rate);
        rotate(b->p, wxwxs, twice);
        for (int x = 0; x < 3; ++x) {
            d[x] += sign * (b->r[x] + arm[x]);
            ddot[x] += sign * (b->v[x] + rate[x]);
            turned[x] += sign * twice[x];
        }
    }
    for (int k = 0; jacobian && k < 2; ++k) {
        double sign = k ? 2.0 : -2.0, local[3];
        rotate_back(bodies[k].p, d, local);
        cross(c->s[k], local, jacobian + 6 * k + 3);
        for (int x = 0; x < 3; ++x) {
            jacobian[6 * k + x] = sign * d[x];
            jacobian[6 * k + 3 + x] *= sign;
        }
    }
    if (phi) {
        phi[0] = dot(d, d) - f * f;
    }
    if (nu) {
        nu[0] = 2.0 * f * f1;
    }
    if (gamma) {
        gamma[0] = 2.0 * (f1 * f1 + f * f2) - 2.0 * dot(ddot, ddot) - 2.0 * dot(d, turned);
    }
    return spoil(c, phi, jacobian, nu, gamma);
}

typedef struct world {
    se3d_system *system;
    se3d_body body[2];
    se3d_constraint link, pin;
    distance data;
} world;

/* A bar on a pin; a second bar that hangs on it by a distance. Driven: the pin turns and a second
 * distance and two planes leave nothing free. */
static void open_world(world *w, int by_callback, double rate)
{
    *w = (world){.data = {.s = {{1.0, 0.1, 0.0}, {-0.5, 0.2, 0.1}}, .length = 1.3, .rate = rate}};
    se3d_body ground;
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &ground));
    for (int k = 0; k < 2; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = 2.0 + k;
        def.inertia[0] = 0.3;
        def.inertia[1] = 0.4 + 0.1 * k;
        def.inertia[2] = 0.55;
        def.position[0] = k ? 2.6 : 1.0;
        def.position[2] = k ? -1.0 : 0.0;
        if (k) {
            def.orientation[0] = 0.8;
            def.orientation[2] = 0.6;
            def.angular_velocity[0] = 0.4;
        }
        CHECK(!se3d_body_create(w->system, &def, &w->body[k]));
    }
    const double at[3] = {0, 0, 0}, axis[3] = {0, 1, 0};
    w->pin = world_join(w->system, se3d_joint_create_revolute, NULL, ground, w->body[0], at, axis);
    if (by_callback) {
        se3d_user_constraint_def def = se3d_user_constraint_def_default();
        def.name = "link";
        def.callback = distance_eval;
        def.ctx = &w->data;
        def.bodies[0] = w->body[0];
        def.bodies[1] = w->body[1];
        def.body_count = 2;
        CHECK(!se3d_user_constraint_create(w->system, &def, &w->link));
    } else {
        se3d_primitive_def def = se3d_primitive_def_default();
        def.name = "link";
        def.type = SE3D_PRIMITIVE_D;
        def.body_i = w->body[0];
        def.body_j = w->body[1];
        memcpy(def.point_i, w->data.s[0], sizeof def.point_i);
        memcpy(def.point_j, w->data.s[1], sizeof def.point_j);
        def.value = 1.69;
        if (rate != 0.0) {
            char text[64];
            snprintf(text, sizeof text, "(1.3+%.17g*sin(2*t))^2", rate);
            CHECK(!se3d_function_create_expression(w->system, text, &def.function));
        }
        CHECK(!se3d_primitive_create(w->system, &def, &w->link));
    }
}

/* Hold the rest: the bar is driven, the other one slides along z. */
static void drive(world *w)
{
    se3d_joint_def slide = se3d_joint_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_constraint made;
    const double at[3] = {2.6, 0, -1}, axis[3] = {0, 0, 1};
    CHECK(!se3d_system_get_ground(w->system, &slide.body_i));
    slide.body_j = w->body[1];
    CHECK(!se3d_joint_def_set_frame(w->system, &slide, at, axis, NULL));
    CHECK(!se3d_joint_create_prismatic(w->system, &slide, &made));
    driver.joint = w->pin;
    driver.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    CHECK(!se3d_function_create_expression(w->system, "0.3*sin(t)", &driver.function));
    CHECK(!se3d_driver_create(w->system, &driver, &made));
}

/* Everything there is to see, of both bodies and the link: 2 * 19 + 8 numbers. */
static void observe(const world *w, double out[46])
{
    memset(out, 0, 46 * sizeof *out);
    for (int k = 0; k < 2; ++k, out += 19) {
        CHECK(!se3d_body_get_position(w->system, w->body[k], out));
        CHECK(!se3d_body_get_orientation(w->system, w->body[k], out + 3));
        CHECK(!se3d_body_get_velocity(w->system, w->body[k], out + 7));
        CHECK(!se3d_body_get_angular_velocity(w->system, w->body[k], out + 10));
        CHECK(!se3d_body_get_acceleration(w->system, w->body[k], out + 13));
        CHECK(!se3d_body_get_angular_acceleration(w->system, w->body[k], out + 16));
    }
    const double point[3] = {0.3, -0.2, 0.7};
    CHECK(!se3d_constraint_get_reaction_at(w->system, w->link, 0, point, (se3d_marker){0, 0}, out));
    CHECK(!se3d_constraint_get_multipliers(w->system, w->link, out + 6));
    se3d_work work = {0.0, 0.0, 0.0}; /* kinematics has none */
    se3d_status status = se3d_system_get_work(w->system, &work);
    CHECK(!status || status == SE3D_ERR_STATE);
    out[7] = work.drivers;
}

static void compare(se3d_solver_def def, double rate, int driven, double t_end, double tolerance)
{
    double seen[2][46], violation[3];
    for (int by_callback = 0; by_callback < 2; ++by_callback) {
        world w;
        se3d_solver *solver;
        open_world(&w, by_callback, rate);
        if (driven) {
            drive(&w);
        }
        CHECK(!se3d_solver_create(w.system, &def, &solver));
        CHECK(se3d_solver_run(solver, t_end) == SE3D_OK);
        CHECK(!se3d_system_get_violation(w.system, violation));
        CHECK_NEAR(violation[0], 0.0, 1e-7);
        observe(&w, seen[by_callback]);
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
    for (int k = 0; k < 46; ++k) {
        CHECK_NEAR(seen[1][k], seen[0][k], tolerance * (1.0 + fabs(seen[0][k])));
    }
}

static void a_distance_by_callback_is_the_joint_in_every_analysis(void)
{
    static const int32_t analyses[] = {SE3D_ANALYSIS_ASSEMBLY, SE3D_ANALYSIS_KINEMATICS,
                                       SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_ANALYSIS_EQUILIBRIUM};
    for (int f = 0; f < 2; ++f) {
        for (int a = 0; a < 4; ++a) {
            se3d_solver_def def = se3d_solver_def_default();
            def.analysis = analyses[a];
            def.formulation = f ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
            int driven = a > 0;
            def.step = 0.05;
            compare(def, driven ? 0.2 : 0.0, driven, a == 1 || a == 2 ? 1.5 : 0.0,
                    a == 3 ? 1e-8 : 1e-12);
        }
    }
}

static void a_distance_by_callback_is_the_joint_with_every_method(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT,
                                      SE3D_METHOD_RATTLE};
    for (int f = 0; f < 2; ++f) {
        for (int m = 0; m < 5; ++m) {
            se3d_solver_def def = se3d_solver_def_default();
            int newton = m == 2 || m == 3;
            def.method = methods[m];
            def.formulation = f ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
            def.step = 0.01;
            compare(def, 0.0, 0, 0.3, newton ? 1e-8 : 1e-11);
            compare(def, 0.2, 0, 0.3, newton ? 1e-8 : 1e-11);
        }
    }
}

static void equations_and_jacobians_are_those_of_the_primitive(void)
{
    for (int f = 0; f < 2; ++f) {
        se3d_formulation formulation = f ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
        double value[2][3], phi_r[2][3], phi_turn[2][4] = {{0}};
        for (int by_callback = 0; by_callback < 2; ++by_callback) {
            world w;
            open_world(&w, by_callback, 0.2);
            double *v = value[by_callback];
            CHECK(!se3d_constraint_eval(w.system, w.link, formulation, v, v + 1, v + 2));
            CHECK(!se3d_constraint_eval_jacobian(w.system, w.link, formulation, 1,
                                                 phi_r[by_callback], phi_turn[by_callback]));
            se3d_system_destroy(w.system);
        }
        double along = 0.0; /* of p: where p.p = 1 is kept, the part along p means nothing */
        const double p[4] = {0.8, 0.0, 0.6, 0.0};
        for (int k = 0; k < 4; ++k) {
            along += f ? p[k] * (phi_turn[0][k] - phi_turn[1][k]) : 0.0;
        }
        for (int k = 0; k < 3; ++k) { /* p.pddot = -w.w / 4 */
            double part = k == 2 ? -along * 0.25 * 0.4 * 0.4 : 0.0;
            CHECK_NEAR(value[1][k] + part, value[0][k], 1e-14);
            CHECK_NEAR(phi_r[1][k], phi_r[0][k], 1e-14);
        }
        for (int k = 0; k < 4; ++k) {
            CHECK_NEAR(phi_turn[1][k] + along * p[k], phi_turn[0][k], 1e-14);
        }
    }
}

/* A bead on a line through the origin that turns with the rate `omega` about z, Phi = y cos - x
 * sin: Phi_t depends on the position. */
static se3d_status line_eval(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                             double *jacobian, double *nu, double *gamma)
{
    double omega = *(const double *)ctx, c = cos(omega * t), s = sin(omega * t);
    double x = bodies->r[0], y = bodies->r[1];
    if (phi) {
        phi[0] = y * c - x * s;
        phi[1] = bodies->r[2];
    }
    if (jacobian) {
        jacobian[0] = -s;
        jacobian[1] = c;
        jacobian[6 + 2] = 1.0;
    }
    if (nu) {
        nu[0] = omega * (y * s + x * c);
    }
    if (gamma) {
        gamma[0] =
            2.0 * omega * (bodies->v[1] * s + bodies->v[0] * c) + omega * omega * (y * c - x * s);
    }
    return SE3D_OK;
}

static void a_bead_on_a_turning_line_moves_as_the_hyperbolic_cosine(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RATTLE,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    static const double tolerances[] = {1e-9, 1e-9, 1e-4, 1e-4, 1e-4};
    double omega = 1.5, r[3], torque[3], force[3];
    for (int run = 0; run < 10; ++run) {
        int m = run / 2;
        se3d_system *system;
        se3d_solver *solver;
        se3d_constraint line;
        se3d_system_def empty = se3d_system_def_default();
        memset(empty.gravity, 0, sizeof empty.gravity);
        CHECK(!se3d_system_create(&empty, &system));
        se3d_body_def body = se3d_body_def_default();
        body.mass = 2.0;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        body.position[0] = 0.5;
        body.velocity[1] = omega * 0.5;
        se3d_user_constraint_def def = se3d_user_constraint_def_default();
        def.callback = line_eval;
        def.ctx = &omega;
        def.equation_count = 2;
        CHECK(!se3d_body_create(system, &body, &def.bodies[0]));
        CHECK(!se3d_user_constraint_create(system, &def, &line));
        se3d_solver_def how = se3d_solver_def_default();
        how.method = methods[m];
        how.formulation = run % 2 ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
        how.step = m < 2 ? 0.0 : 1e-3;
        how.tolerance = m < 2 ? 1e-11 : 0.0;
        CHECK(!se3d_solver_create(system, &how, &solver));
        CHECK(se3d_solver_run(solver, 1.0) == SE3D_OK);
        CHECK(!se3d_body_get_position(system, def.bodies[0], r));
        CHECK_NEAR(r[0], 0.5 * cosh(omega) * cos(omega), tolerances[m]);
        CHECK_NEAR(r[1], 0.5 * cosh(omega) * sin(omega), tolerances[m]);
        /* the line pushes with 2 m omega rdot across itself; one body: it is body j */
        CHECK(!se3d_constraint_get_reaction(system, line, force, torque));
        double across = force[1] * cos(omega) - force[0] * sin(omega);
        CHECK_NEAR(across, 2.0 * 2.0 * omega * 0.5 * omega * sinh(omega), 40.0 * tolerances[m]);
        /* and does the work that the energy gains */
        se3d_work work;
        double kinetic =
            0.25 * omega * omega * (sinh(omega) * sinh(omega) + cosh(omega) * cosh(omega));
        CHECK(!se3d_system_get_work(system, &work));
        CHECK_NEAR(work.drivers, kinetic - 0.25 * omega * omega, 1e-3);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

static void a_callback_that_fails_stops_the_analysis_with_its_name(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RATTLE,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    for (int m = 0; m < 5; ++m) {
        for (int after = 1; after < 60; after += 7) {
            world w;
            se3d_solver *solver;
            open_world(&w, 1, 0.2);
            w.data.fail_after = after;
            se3d_solver_def def = se3d_solver_def_default();
            def.method = methods[m];
            def.step = 0.01;
            CHECK(!se3d_solver_create(w.system, &def, &solver));
            CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_CALLBACK);
            CHECK_CONTAINS(se3d_system_get_error(w.system), "link");
            CHECK_CONTAINS(se3d_system_get_error(w.system), "t = ");
            CHECK(w.data.calls < after + 8);
            w.data.fail_after = 0;
            CHECK(se3d_solver_run(solver, 1.0) == SE3D_OK); /* the state is a good one */
            se3d_solver_destroy(solver);
            se3d_system_destroy(w.system);
        }
    }
}

/* The curvature of a constraint is differences of its Jacobian, each of which may fail. */
static void a_jacobian_that_fails_stops_exact_newton_steps(void)
{
    for (int at = 1; at <= 25; ++at) {
        world w;
        se3d_solver *solver;
        open_world(&w, 1, 0.2);
        se3d_solver_def def = se3d_solver_def_default();
        def.method = SE3D_METHOD_RADAU;
        CHECK(!se3d_solver_create(w.system, &def, &solver));
        CHECK(!se3d_solver_run(solver, 0.01));
        w.data.bent = at;
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_ERR_CALLBACK && w.data.bent == 0);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "link");
        CHECK(!se3d_solver_run(solver, 0.5));
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
}

/* A spring to the ground that fails in one of its calls. */
static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    int *left = ctx;
    (void)t, (void)K, (void)D;
    for (int k = 0; k < 3; ++k) {
        wrench[6 + k] = -50.0 * motion[1].r[k];
    }
    return *left > 0 && --*left == 0 ? -80 : SE3D_OK;
}

/* Also where the force is differentiated for the matrix of Newton's method. One call is of
 * the audit of work, which says so. */
static void a_force_that_fails_in_newton_steps_is_named(void)
{
    int named = 0;
    for (int at = 1; at <= 60; ++at) {
        int left = 0;
        world w;
        se3d_force force;
        se3d_solver *solver;
        se3d_force_callback_def def = se3d_force_callback_def_default();
        se3d_solver_def settings = se3d_solver_def_default();
        open_world(&w, 0, 0.0);
        def.name = "push";
        def.body_j = w.body[1];
        def.callback = push;
        def.ctx = &left;
        CHECK(!se3d_system_get_ground(w.system, &def.body_i));
        CHECK(!se3d_force_create_callback(w.system, &def, &force));
        settings.method = SE3D_METHOD_RADAU;
        CHECK(!se3d_solver_create(w.system, &settings, &solver));
        CHECK(!se3d_solver_run(solver, 0.01));
        left = at;
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_ERR_CALLBACK && left == 0);
        named += strstr(se3d_system_get_error(w.system), "force element push (callback)") != NULL;
        CHECK(!se3d_solver_run(solver, 0.5));
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
    CHECK(named >= 59);
}

/* Says nothing about its bodies; fails in one of its calls. */
static se3d_status nothing_eval(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                                double *jacobian, double *nu, double *gamma)
{
    int *left = ctx;
    (void)t, (void)bodies, (void)phi, (void)jacobian, (void)nu, (void)gamma;
    return *left > 0 && --*left == 0 ? -79 : SE3D_OK;
}

/* 0 = 0 is left out, and what is left out has no gap that counts, also if it cannot be asked. */
static void an_equation_without_content_is_left_out(void)
{
    int refused = 0, passed = 0;
    for (int at = 0; at < 100; ++at) {
        int left = 0;
        world w;
        se3d_constraint nothing;
        se3d_solver *solver;
        open_world(&w, 0, 0.0);
        se3d_user_constraint_def def = se3d_user_constraint_def_default();
        def.name = "nothing";
        def.callback = nothing_eval;
        def.ctx = &left;
        def.body_count = 2;
        def.bodies[0] = w.body[0];
        def.bodies[1] = w.body[1];
        CHECK(!se3d_user_constraint_create(w.system, &def, &nothing));
        const se3d_solver_def settings = se3d_solver_def_default();
        CHECK(se3d_solver_create(w.system, &settings, &solver) >= 0);
        left = at;
        const se3d_status status = se3d_solver_run(solver, 0.02);
        CHECK(status == SE3D_ERR_CALLBACK || status >= 0);
        CHECK(at > 0 || status >= 0);
        refused += status < 0;
        passed += status >= 0 && at > 0 && left == 0;
        left = 0;
        CHECK(se3d_solver_run(solver, 0.05) >= 0);
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
    CHECK(refused > 0 && passed > 0);
}

static void numbers_that_are_not_finite_are_refused(void)
{
    for (int wrong = 1; wrong <= 4; ++wrong) {
        world w;
        se3d_solver *solver;
        open_world(&w, 1, 0.0);
        const se3d_solver_def def = se3d_solver_def_default();
        CHECK(!se3d_solver_create(w.system, &def, &solver));
        w.data.wrong_number = wrong;
        CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_NOT_FINITE);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "link");
        w.data.wrong_number = 0;
        CHECK(!se3d_solver_run(solver, 1.0));
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
}

static void a_reader_gives_zeros_for_what_is_not_finite(void)
{
    world w;
    se3d_solver *solver;
    double phi = 1.0, nu = 1.0, violation[3];
    open_world(&w, 1, 0.0);
    w.data.wrong_number = 1;
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_solver_create(w.system, &def, &solver));
    CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_NOT_FINITE);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "link");
    CHECK(se3d_constraint_eval(w.system, w.link, SE3D_FORMULATION_RP, &phi, &nu, NULL) ==
          SE3D_ERR_NOT_FINITE);
    CHECK(phi == 0.0 && nu == 0.0);
    CHECK(se3d_system_get_violation(w.system, violation) == SE3D_ERR_NOT_FINITE);
    se3d_solver_destroy(solver);
    se3d_system_destroy(w.system);
}

static void definitions_out_of_range_are_refused(void)
{
    world w;
    se3d_constraint made;
    se3d_body ground;
    open_world(&w, 1, 0.0);
    CHECK(!se3d_system_get_ground(w.system, &ground));
    se3d_user_constraint_def good = se3d_user_constraint_def_default();
    good.callback = distance_eval;
    good.ctx = &w.data;
    good.body_count = 2;
    good.bodies[0] = w.body[0];
    good.bodies[1] = w.body[1];
    se3d_user_constraint_def def = good;
    def.callback = NULL;
    CHECK(se3d_user_constraint_create(w.system, &def, &made) == SE3D_ERR_NULL);
    static const int32_t counts[] = {-1, 0, 5, 7};
    for (int k = 0; k < 4; ++k) {
        def = good;
        def.body_count = counts[k];
        CHECK(se3d_user_constraint_create(w.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
        def = good;
        def.equation_count = k == 2 ? 7 : counts[k];
        CHECK(se3d_user_constraint_create(w.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    }
    def = good;
    def.bodies[1] = def.bodies[0];
    CHECK(se3d_user_constraint_create(w.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "different");
    def = good;
    def.body_count = 1;
    def.bodies[0] = ground;
    CHECK(se3d_user_constraint_create(w.system, &def, &made) == SE3D_ERR_INVALID_ARGUMENT);
    def = good;
    def.name = "link";
    CHECK(se3d_user_constraint_create(w.system, &def, &made) < 0);
    CHECK(se3d_body_destroy(w.system, w.body[1]) == SE3D_ERR_IN_USE);
    CHECK(!se3d_constraint_destroy(w.system, w.link));
    CHECK(!se3d_body_destroy(w.system, w.body[1]));
    se3d_system_destroy(w.system);
}

static void clones_and_runs_agree_bit_by_bit(void)
{
    world w, again;
    se3d_system *clone;
    se3d_solver *solver;
    open_world(&w, 1, 0.2);
    open_world(&again, 1, 0.2);
    CHECK(!se3d_system_clone(w.system, &clone));
    se3d_system *systems[3] = {w.system, again.system, clone};
    uint64_t hash[3];
    for (int k = 0; k < 3; ++k) {
        se3d_solver_def def = se3d_solver_def_default();
        CHECK(!se3d_solver_create(systems[k], &def, &solver));
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_OK);
        hash[k] = se3d_system_hash(systems[k]);
        se3d_solver_destroy(solver);
    }
    CHECK(hash[0] == hash[1] && hash[0] == hash[2]);
    se3d_system_destroy(clone);
    se3d_system_destroy(again.system);
    se3d_system_destroy(w.system);
}

/* A copy of the link: `check` names it as redundant. */
static void a_copy_of_a_constraint_is_named_as_redundant(void)
{
    world w;
    se3d_constraint made;
    se3d_check *check = NULL;
    open_world(&w, 0, 0.0);
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    def.name = "copy";
    def.callback = distance_eval;
    def.ctx = &w.data;
    def.body_count = 2;
    def.bodies[0] = w.body[0];
    def.bodies[1] = w.body[1];
    CHECK(!se3d_user_constraint_create(w.system, &def, &made));
    CHECK(se3d_check_create(w.system, &check) == SE3D_INFO_REDUNDANT);
    se3d_check_destroy(check);
    w.data.fail_after = 1;
    CHECK(se3d_check_create(w.system, &check) == SE3D_ERR_CALLBACK);
    se3d_system_destroy(w.system);
}

/* A copy that is left out, and fails from some call on: the analysis says so, and goes on from a
 * good state when it does not any more. */
static void a_copy_that_fails_stops_the_analysis_with_its_name(void)
{
    for (int after = 1; after < 80; ++after) {
        world w;
        se3d_constraint made;
        se3d_solver *solver;
        open_world(&w, 0, 0.0);
        se3d_user_constraint_def def = se3d_user_constraint_def_default();
        def.name = "copy";
        def.callback = distance_eval;
        def.ctx = &w.data;
        def.body_count = 2;
        def.bodies[0] = w.body[0];
        def.bodies[1] = w.body[1];
        CHECK(!se3d_user_constraint_create(w.system, &def, &made));
        se3d_solver_def settings = se3d_solver_def_default();
        settings.method = after % 2 ? SE3D_METHOD_HHT : SE3D_METHOD_DOP853;
        settings.step = 0.01;
        CHECK(se3d_solver_create(w.system, &settings, &solver) >= 0);
        w.data.fail_after = after;
        CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_CALLBACK);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "copy");
        w.data.fail_after = 0;
        CHECK(se3d_solver_run(solver, 1.0) >= 0);
        se3d_solver_destroy(solver);
        se3d_system_destroy(w.system);
    }
}

int main(void)
{
    RUN(a_distance_by_callback_is_the_joint_in_every_analysis);
    RUN(a_distance_by_callback_is_the_joint_with_every_method);
    RUN(equations_and_jacobians_are_those_of_the_primitive);
    RUN(a_bead_on_a_turning_line_moves_as_the_hyperbolic_cosine);
    RUN(a_callback_that_fails_stops_the_analysis_with_its_name);
    RUN(a_jacobian_that_fails_stops_exact_newton_steps);
    RUN(a_force_that_fails_in_newton_steps_is_named);
    RUN(an_equation_without_content_is_left_out);
    RUN(numbers_that_are_not_finite_are_refused);
    RUN(a_reader_gives_zeros_for_what_is_not_finite);
    RUN(definitions_out_of_range_are_refused);
    RUN(clones_and_runs_agree_bit_by_bit);
    RUN(a_copy_of_a_constraint_is_named_as_redundant);
    RUN(a_copy_that_fails_stops_the_analysis_with_its_name);
    return check_finish();
}
