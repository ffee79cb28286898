/* SPDX-License-Identifier: BSD-3-Clause */
/* Armatures on joint coordinates: closed forms, the same answers in all formulations on random
 * trees and loops, the mass matrix of the tree, all methods, energy, modes. */
#include "support/methods.h"
#include "support/tree_world.h"
#include "support/world.h"

#include "assembly/energy.h"
#include "se3d/coordinates.h"
#include "se3d/modes.h"

enum { MECHANISMS = 24, NUMBERS = 7 * TREE_BODIES_MAX, PER_CONSTRAINT = 6 };

static const int32_t formulations[] = {SE3D_FORMULATION_ROMEGA, SE3D_FORMULATION_RP,
                                       SE3D_FORMULATION_JOINT};
enum { FORMULATIONS = 3 };

static se3d_force add_armature(se3d_system *system, se3d_constraint joint, int32_t coordinate,
                               double inertia)
{
    se3d_armature_def def = se3d_armature_def_default();
    se3d_force force;
    def.joint = joint;
    def.coordinate = coordinate;
    def.inertia = inertia;
    world_must(system, se3d_force_create_armature(system, &def, &force), "armature");
    return force;
}

/* ---- one pendulum ---- */

#define MASS    2.0
#define INERTIA 0.3 /* about the axis through the centre */
#define LENGTH  0.5 /* to the centre */
#define ROTOR   1.7
#define GRAVITY 9.81

typedef struct pendulum {
    se3d_system *system;
    se3d_body body;
    se3d_constraint pin;
    se3d_force rotor;
} pendulum;

/* At rest, horizontal: along x, gravity down y, turning about z. */
static pendulum begin_pendulum(double inertia)
{
    const double J[3] = {0.1, INERTIA, INERTIA}, r[3] = {LENGTH, 0.0, 0.0};
    const double at[3] = {0.0}, z[3] = {0.0, 0.0, 1.0}, g[3] = {0.0, -GRAVITY, 0.0};
    pendulum p = {.system = NULL};
    se3d_body ground;
    CHECK(!se3d_system_create(NULL, &p.system));
    CHECK(!se3d_system_set_gravity(p.system, g));
    CHECK(!se3d_system_get_ground(p.system, &ground));
    p.body = world_add_body(p.system, MASS, J, r);
    p.pin = world_join(p.system, se3d_joint_create_revolute, "pin", ground, p.body, at, z);
    p.rotor = add_armature(p.system, p.pin, SE3D_JOINT_COORDINATE_ANGLE, inertia);
    return p;
}

static double angular_acceleration(const pendulum *p)
{
    double theta, rate, second;
    CHECK(!se3d_joint_get_coordinate(p->system, p->pin, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                     &second));
    return second;
}

static void a_pendulum_with_a_rotor_falls_by_the_closed_form(void)
{
    const double about_pin = INERTIA + MASS * LENGTH * LENGTH;
    const double expected = -MASS * GRAVITY * LENGTH / (about_pin + ROTOR);
    for (int k = 0; k < FORMULATIONS; ++k) {
        double force[3], torque[3], x, rate, effort;
        pendulum p = begin_pendulum(ROTOR);
        se3d_solver *solver = world_solver(p.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                                           formulations[k], 0.0);
        CHECK(se3d_solver_run(solver, 0.0) >= 0);
        CHECK_NEAR(angular_acceleration(&p), expected, 1e-13 * -expected);
        /* the pin carries what gravity and inertia of the body leave, and the rotor's torque */
        CHECK(!se3d_constraint_get_reaction(p.system, p.pin, force, torque));
        CHECK_NEAR(force[1], MASS * (GRAVITY + LENGTH * expected), 1e-12);
        CHECK(!se3d_force_get_state(p.system, p.rotor, &x, &rate, &effort));
        CHECK_NEAR(effort, -ROTOR * expected, 1e-12);
        CHECK(se3d_solver_run(solver, 1.0) >= 0);
        CHECK(!se3d_force_get_state(p.system, p.rotor, &x, &rate, &effort));
        const double kinetic = 0.5 * (about_pin + ROTOR) * rate * rate;
        CHECK_NEAR(se3di_kinetic_energy(&p.system->model), kinetic, 1e-13 * kinetic);
        CHECK_NEAR(kinetic, -MASS * GRAVITY * LENGTH * sin(x), 1e-6 * kinetic);
        se3d_solver_destroy(solver);
        se3d_system_destroy(p.system);
    }
}

/* Two bodies in space turn against each other: the rotor has no momentum. */
static void bodies_in_space_share_the_effort_of_a_rotor(void)
{
    const double J[2][3] = {{1.0, 1.0, 2.0}, {1.0, 1.0, 0.5}}, at[3] = {0.0};
    const double z[3] = {0.0, 0.0, 1.0}, none[3] = {0.0}, effort = 3.0;
    const double reduced = J[0][2] * J[1][2] / (J[0][2] + J[1][2]);
    for (int k = 0; k < FORMULATIONS; ++k) {
        se3d_system *system = NULL;
        double w[2][3], theta, rate, second;
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_set_gravity(system, none));
        const se3d_body a = world_add_body(system, 1.0, J[0], at);
        const se3d_body b = world_add_body(system, 3.0, J[1], at);
        const se3d_constraint pin =
            world_join(system, se3d_joint_create_revolute, "pin", a, b, at, z);
        (void)add_armature(system, pin, SE3D_JOINT_COORDINATE_ANGLE, ROTOR);
        se3d_effort_def drive = se3d_effort_def_default();
        se3d_force force;
        drive.joint = pin;
        drive.value = effort;
        CHECK(!se3d_force_create_effort(system, &drive, &force));
        se3d_solver *solver =
            world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, formulations[k], 0.0);
        CHECK(se3d_solver_run(solver, 1.0) >= 0);
        CHECK(!se3d_joint_get_coordinate(system, pin, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                         &second));
        CHECK_NEAR(second, effort / (reduced + ROTOR), 1e-12);
        CHECK_NEAR(rate, effort / (reduced + ROTOR), 1e-10);
        CHECK(!se3d_body_get_angular_velocity(system, a, w[0]));
        CHECK(!se3d_body_get_angular_velocity(system, b, w[1]));
        CHECK_NEAR(J[0][2] * w[0][2] + J[1][2] * w[1][2], 0.0, 1e-12);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* If the drive alone decides on the motion too; its power is that of both. */
static void a_drive_turns_the_rotor_too(void)
{
    static const int32_t analyses[] = {SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_ANALYSIS_DYNAMICS};
    for (int k = 0; k < 2 * FORMULATIONS; ++k) {
        pendulum p = begin_pendulum(ROTOR);
        const double g[3] = {0.0, 0.0, 0.0};
        se3d_driver_def def = se3d_driver_def_default();
        se3d_constraint driver;
        double effort;
        CHECK(!se3d_system_set_gravity(p.system, g));
        CHECK(!se3d_function_create_expression(p.system, "t^2", &def.function));
        def.joint = p.pin;
        CHECK(!se3d_driver_create(p.system, &def, &driver));
        se3d_solver *solver = world_solver(p.system, analyses[k % 2], SE3D_METHOD_DOP853,
                                           formulations[k / 2], k % 2 ? 0.0 : 0.1);
        CHECK(se3d_solver_run(solver, 0.5) >= 0);
        CHECK(!se3d_driver_get_effort(p.system, driver, &effort));
        const double all = INERTIA + MASS * LENGTH * LENGTH + ROTOR;
        CHECK_NEAR(effort, 2.0 * all, 1e-11);
        if (k % 2) {
            CHECK_NEAR(p.system->model.work[2], 0.5 * all * 1.0 * 1.0, 1e-6);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(p.system);
    }
}

static int is_refused(int32_t method)
{
    return method == SE3D_METHOD_RATTLE || method == SE3D_METHOD_VERLET;
}

/* ---- a chain that swings in space, by all methods ---- */

static se3d_system *begin_chain(se3d_body *last)
{
    const double J[3] = {0.02, 0.03, 0.04}, y[3] = {0.0, 1.0, 0.0}, x[3] = {0.6, 0.0, 0.8};
    const double *const axes[3] = {y, x, y};
    se3d_system *system = NULL;
    se3d_body before;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_get_ground(system, &before));
    for (int k = 0; k < 3; ++k) {
        const double r[3] = {0.3 + 0.6 * k, 0.0, 0.0}, at[3] = {0.6 * k, 0.0, 0.0};
        *last = world_add_body(system, 1.0, J, r);
        const se3d_constraint joint =
            world_join(system, se3d_joint_create_revolute, NULL, before, *last, at, axes[k]);
        (void)add_armature(system, joint, SE3D_JOINT_COORDINATE_ANGLE, 0.2 + 0.1 * k);
        before = *last;
    }
    return system;
}

/* The place of the last body at .3 s; the change of energy. */
static double swing(int32_t method, int32_t formulation, double step, double r[3])
{
    se3d_body last;
    se3d_system *system = begin_chain(&last);
    se3d_solver *solver = world_solver(system, SE3D_ANALYSIS_DYNAMICS, method, formulation, step);
    se3d_energy before, after;
    CHECK(!se3d_system_get_energy(system, &before));
    const se3d_status status = se3d_solver_run(solver, 0.3);
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", se3d_method_get_name(method), se3d_system_get_error(system));
    }
    CHECK(status >= 0);
    CHECK(!se3d_body_get_position(system, last, r));
    CHECK(!se3d_system_get_energy(system, &after));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return fabs(after.kinetic + after.potential - before.kinetic - before.potential);
}

static double distance(const double a[3], const double b[3])
{
    double d[3];
    se3di_sub(a, b, d);
    return se3di_norm(d);
}

static void all_methods_take_armatures_or_say_that_they_do_not(void)
{
    double exact[3];
    (void)swing(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, exact);
    for (int32_t method = 1; method < method_count(); ++method) {
        for (int k = 0; k < FORMULATIONS; ++k) {
            double r[3];
            if (is_refused(method)) {
                se3d_body last;
                se3d_system *system = begin_chain(&last);
                se3d_solver *solver =
                    world_solver(system, SE3D_ANALYSIS_DYNAMICS, method, formulations[k], 0.01);
                CHECK(se3d_solver_run(solver, 0.3) == SE3D_ERR_UNSUPPORTED);
                CHECK_CONTAINS(se3d_system_get_error(system), "takes no armatures");
                CHECK_CONTAINS(se3d_system_get_error(system), se3d_method_get_name(method));
                se3d_solver_destroy(solver);
                se3d_system_destroy(system);
                continue;
            }
            const int is_coarse = method == SE3D_METHOD_GENERALIZED_ALPHA ||
                                  method == SE3D_METHOD_HHT || method == SE3D_METHOD_RK4 ||
                                  method == SE3D_METHOD_CONVEX;
            const double change = swing(method, formulations[k], is_coarse ? 0.002 : 0.0, r);
            CHECK_NEAR(distance(r, exact), 0.0, is_coarse ? 2e-5 : 2e-6);
            CHECK_NEAR(change, 0.0, is_coarse ? 1e-4 : 1e-5);
        }
    }
}

/* Of order two: the error of a half step is a quarter. */
static void steps_keep_their_order(void)
{
    static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_CONVEX};
    double exact[3], r[3];
    (void)swing(SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, exact);
    for (int k = 0; k < 2 * FORMULATIONS; ++k) {
        double error[2];
        for (int half = 0; half < 2; ++half) {
            (void)swing(methods[k % 2], formulations[k / 2], 0.02 / (1 + half), r);
            error[half] = distance(r, exact);
        }
        CHECK_NEAR(log2(error[0] / error[1]), 2.0, 0.2);
    }
}

/* ---- random mechanisms ---- */

static void add_armatures(tree_world *w)
{
    for (int k = 0; k < w->joint_count; ++k) {
        for (int32_t c = 0; c < 2; ++c) {
            double x, rate, second;
            const char *type;
            CHECK(!se3d_constraint_get_type(w->system, w->joints[k], &type));
            const int is_screw = strcmp(type, "screw") == 0 && c != SE3D_JOINT_COORDINATE_ANGLE;
            if (!is_screw &&
                se3d_joint_get_coordinate(w->system, w->joints[k], (se3d_joint_coordinate)c, &x,
                                          &rate, &second) >= 0) {
                (void)add_armature(w->system, w->joints[k], c, tree_uniform(w, 0.0, 10.0));
            }
        }
    }
}

/* Accelerations of all bodies and what constraints exert. */
static size_t observe(const tree_world *w, double *out)
{
    const se3di_model *model = &w->system->model;
    size_t count = 0;
    for (size_t k = 1; k < model->body_slots.count; ++k, count += 6) {
        memcpy(out + count, model->acceleration + 6 * k, 6 * sizeof *out);
    }
    for (int k = 0; k < w->joint_count; ++k, count += PER_CONSTRAINT) {
        CHECK(!se3d_constraint_get_reaction(w->system, w->joints[k], out + count, out + count + 3));
    }
    return count;
}

static double largest(const double *x, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(x[k]));
    }
    return most;
}

static void formulations_agree_on_random_mechanisms(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        static double seen[FORMULATIONS][(6 + 2 * PER_CONSTRAINT) * 2 * TREE_BODIES_MAX];
        const int bodies = 1 + (int)(seed % TREE_BODIES_MAX), loops = seed % 3 == 2 ? 2 : 0;
        size_t count = 0;
        int runs = 1;
        for (int k = 0; k < FORMULATIONS; ++k) {
            tree_world w;
            tree_world_init(&w, seed, bodies, loops);
            add_armatures(&w);
            se3d_solver *solver = world_solver(w.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                                               formulations[k], 0.0);
            runs &= se3d_solver_run(solver, 0.0) >= 0;
            count = observe(&w, seen[k]);
            se3d_solver_destroy(solver);
            tree_world_destroy(&w);
        }
        CHECK(runs);
        for (int k = 1; k < FORMULATIONS; ++k) {
            const double size = largest(seen[0], count);
            for (size_t e = 0; e < count; ++e) {
                seen[k][e] -= seen[0][e];
            }
            CHECK_NEAR(largest(seen[k], count), 0.0, 1e-11 * size);
        }
    }
}

/* Without a step: M gains the inertias on its diagonal, accelerations are those of the bodies. */
static void the_mass_matrix_of_the_tree_has_them_on_its_diagonal(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        static double M[2][NUMBERS * NUMBERS];
        tree_world w;
        se3d_coordinates *c;
        double sum = 0.0, gained = 0.0, q[NUMBERS], qddot[NUMBERS], x[NUMBERS], effort[2][NUMBERS];
        size_t n = 0;
        tree_world_init(&w, seed, 1 + (int)(seed % TREE_BODIES_MAX), 0);
        for (int with = 0; with < 2; ++with) {
            if (with) {
                add_armatures(&w);
            }
            CHECK(!se3d_coordinates_create(w.system, &c));
            n = se3d_coordinates_count(c);
            for (size_t k = 0; k < n; ++k) {
                x[k] = 1.0 + (double)k;
            }
            CHECK(!se3d_coordinates_get(c, q, NULL));
            CHECK(!se3d_coordinates_set(c, q, x));
            CHECK(!se3d_coordinates_compute_mass_matrix(c, M[with]));
            CHECK(!se3d_coordinates_compute_accelerations(c, NULL, qddot));
            CHECK(!se3d_coordinates_compute_efforts(c, qddot, effort[with]));
            CHECK_NEAR(largest(effort[with], n), 0.0, 1e-9 * largest(M[with], n * n));
            CHECK(!se3d_coordinates_compute_efforts(c, x, effort[with]));
            se3d_coordinates_destroy(c);
        }
        const double size = largest(M[0], n * n);
        for (size_t k = 0; k < n * n; ++k) {
            const double more = M[1][k] - M[0][k];
            gained += more;
            CHECK_NEAR(k % (n + 1) == 0 ? fmin(more, 0.0) : more, 0.0, 1e-12 * size);
            if (k % (n + 1) == 0) {
                const double added = effort[1][k / n] - effort[0][k / n];
                CHECK_NEAR(added, more * x[k / n], 1e-9 * (1.0 + largest(effort[0], n)));
            }
        }
        const se3di_model *model = &w.system->model;
        for (size_t k = 0; k < model->force_slots.count; ++k) {
            sum += model->forces[k].type == SE3DI_FORCE_ARMATURE ? model->forces[k].value[0] : 0.0;
        }
        CHECK_NEAR(gained, sum, 1e-9 * (1.0 + sum));
        tree_world_destroy(&w);
    }
}

/* ---- loops ---- */

/* A four-bar in a plane, armatures on the joints of `mask`. */
static se3d_system *begin_four_bar(uint32_t mask, se3d_body links[3])
{
    const double x[3] = {0.05, 1.0, 1.0}, z[3] = {0.0, 0.0, 1.0}, down[3] = {0.0, -9.81, 0.0};
    const double points[4][3] = {
        {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {2.8, 2.1, 0.0}, {3.0, 0.0, 0.0}};
    se3d_system *system = NULL;
    se3d_body ground;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_set_gravity(system, down));
    CHECK(!se3d_system_get_ground(system, &ground));
    for (int k = 0; k < 3; ++k) {
        double r[3];
        se3di_add(points[k], points[k + 1], r);
        se3di_scale(0.5, r, r);
        links[k] = world_add_body(system, 1.0 + k, x, r);
    }
    for (int k = 0; k < 4; ++k) {
        const se3d_body i = k == 0 ? ground : links[k - 1], j = k == 3 ? ground : links[k];
        const se3d_constraint pin =
            world_join(system, se3d_joint_create_revolute, NULL, i, j, points[k], z);
        if (mask & (1u << k)) {
            (void)add_armature(system, pin, SE3D_JOINT_COORDINATE_ANGLE, 0.5 + k);
        }
    }
    return system;
}

/* Whichever joint of a loop has one, and also if all have. */
static void loops_have_armatures_on_any_joint(void)
{
    for (uint32_t mask = 1; mask < 16; ++mask) {
        double a[FORMULATIONS][18], v[FORMULATIONS][3];
        se3d_body links[3];
        se3d_coordinates *c = NULL;
        se3d_system *system = begin_four_bar(mask, links);
        const se3d_status status = se3d_coordinates_create(system, &c);
        CHECK(status == (mask == 15 ? SE3D_ERR_UNSUPPORTED : SE3D_OK));
        if (status < 0) {
            CHECK_CONTAINS(se3d_system_get_error(system), "closes a loop");
        }
        se3d_coordinates_destroy(c);
        se3d_system_destroy(system);
        for (int k = 0; k < FORMULATIONS; ++k) {
            system = begin_four_bar(mask, links);
            se3d_solver *solver = world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                                               formulations[k], 0.0);
            CHECK(se3d_solver_run(solver, 0.0) >= 0);
            memcpy(a[k], system->model.acceleration + 6, sizeof a[k]);
            CHECK(se3d_solver_run(solver, 0.2) >= 0);
            CHECK(!se3d_body_get_velocity(system, links[1], v[k]));
            CHECK_NEAR(largest(a[k], 18), largest(a[0], 18), 1e-11 * largest(a[0], 18));
            CHECK_NEAR(distance(v[k], v[0]), 0.0, 1e-6);
            se3d_solver_destroy(solver);
            se3d_system_destroy(system);
        }
        CHECK(largest(a[0], 18) > 0.1);
    }
}

/* ---- values ---- */

static void a_new_inertia_acts_at_once_and_is_audited(void)
{
    for (int k = 0; k < FORMULATIONS; ++k) {
        pendulum p = begin_pendulum(ROTOR);
        se3d_solver *solver = world_solver(p.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853,
                                           formulations[k], 0.0);
        se3d_energy energy;
        double x, rate, effort, inertia;
        CHECK(se3d_solver_run(solver, 0.3) >= 0);
        const double before = p.system->model.work[1];
        CHECK(!se3d_force_get_state(p.system, p.rotor, &x, &rate, &effort));
        CHECK(!se3d_force_set_parameter(p.system, p.rotor, SE3D_FORCE_PARAMETER_INERTIA, 0.0));
        CHECK(!se3d_force_get_parameter(p.system, p.rotor, SE3D_FORCE_PARAMETER_INERTIA, &inertia));
        CHECK_NEAR(inertia, 0.0, 0.0);
        CHECK_NEAR(p.system->model.work[1] - before, -0.5 * ROTOR * rate * rate, 1e-12);
        CHECK(se3d_solver_run(solver, 0.3) >= 0);
        const double about_pin = INERTIA + MASS * LENGTH * LENGTH;
        const double expected = -MASS * GRAVITY * LENGTH * cos(x) / about_pin;
        CHECK_NEAR(angular_acceleration(&p), expected, 1e-12 * fabs(expected));
        CHECK(!se3d_system_get_energy(p.system, &energy));
        CHECK_NEAR(energy.kinetic, 0.5 * about_pin * rate * rate, 1e-12 * energy.kinetic);
        CHECK(se3d_force_set_parameter(p.system, p.rotor, SE3D_FORCE_PARAMETER_INERTIA, -1.0) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(p.system), "inertia = -1");
        se3d_solver_destroy(solver);
        se3d_system_destroy(p.system);
    }
}

static void a_rotor_lowers_the_frequency(void)
{
    const double none[3] = {0.0}, k = 50.0;
    pendulum p = begin_pendulum(ROTOR);
    se3d_rsda_def spring = se3d_rsda_def_default();
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes *modes = NULL;
    se3d_eigenvalue value;
    se3d_force force;
    CHECK(!se3d_system_set_gravity(p.system, none));
    spring.joint = p.pin;
    spring.k = k;
    CHECK(!se3d_force_create_rsda(p.system, &spring, &force));
    CHECK(!se3d_modes_create(p.system, &def, &modes));
    CHECK(!se3d_modes_get_eigenvalue(modes, 0, &value));
    const double w = sqrt(k / (INERTIA + MASS * LENGTH * LENGTH + ROTOR));
    CHECK_NEAR(value.imaginary, w, 1e-12 * w);
    se3d_modes_destroy(modes);
    se3d_system_destroy(p.system);
}

/* Two discs on one axis, the second on the first, whose rotor turns by the difference:
 *
 *     M = [J1 + I, -I; -I, J2 + I],  K = [k1 + k2, -k2; -k2, k2] */
static void a_rotor_between_bodies_couples_their_modes(void)
{
    const double none[3] = {0.0}, z[3] = {0.0, 0.0, 1.0};
    const double J[2][3] = {{1.0, 1.0, 0.7}, {1.0, 1.0, 0.4}}, k[2] = {30.0, 50.0};
    se3d_system *system = NULL;
    se3d_body before;
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes *modes = NULL;
    CHECK(!se3d_system_create(NULL, &system));
    CHECK(!se3d_system_set_gravity(system, none));
    CHECK(!se3d_system_get_ground(system, &before));
    for (int b = 0; b < 2; ++b) {
        se3d_rsda_def spring = se3d_rsda_def_default();
        se3d_force force;
        const se3d_body disc = world_add_body(system, 2.0, J[b], none);
        spring.joint =
            world_join(system, se3d_joint_create_revolute, b ? "b" : "a", before, disc, none, z);
        spring.k = k[b];
        CHECK(!se3d_force_create_rsda(system, &spring, &force));
        if (b) {
            (void)add_armature(system, spring.joint, SE3D_JOINT_COORDINATE_ANGLE, ROTOR);
        }
        before = disc;
    }
    CHECK(!se3d_modes_create(system, &def, &modes));
    const double m = J[0][2] + ROTOR, n = J[1][2] + ROTOR;
    const double a = m * n - ROTOR * ROTOR;
    const double b = m * k[1] + n * (k[0] + k[1]) - 2.0 * ROTOR * k[1];
    const double root = sqrt(b * b - 4.0 * a * k[0] * k[1]);
    for (int mode = 0; mode < 2; ++mode) {
        se3d_eigenvalue value;
        const double w = sqrt(0.5 * (mode ? b + root : b - root) / a);
        CHECK(!se3d_modes_get_eigenvalue(modes, (size_t)mode, &value));
        CHECK_NEAR(value.imaginary, w, 1e-12 * w);
    }
    se3d_modes_destroy(modes);
    se3d_system_destroy(system);
}

/* Its displacement goes with the angle. */
static void a_screw_has_it_on_its_angle(void)
{
    const double J[3] = {1.0, 1.0, 1.0}, at[3] = {0.0}, z[3] = {0.0, 0.0, 1.0};
    const double lead = 0.1; /* [m/rad] */
    for (int k = 0; k < FORMULATIONS; ++k) {
        se3d_system *system = NULL;
        se3d_body ground;
        se3d_constraint screw;
        double theta, rate, second;
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_get_ground(system, &ground));
        const se3d_body nut = world_add_body(system, 2.0, J, at);
        se3d_joint_def def = se3d_joint_def_default();
        def.body_i = ground;
        def.body_j = nut;
        def.pitch = lead * 2.0 * 3.14159265358979323846;
        CHECK(!se3d_joint_def_set_frame(system, &def, at, z, NULL));
        CHECK(!se3d_joint_create_screw(system, &def, &screw));
        se3d_armature_def rotor = se3d_armature_def_default();
        se3d_force force;
        rotor.joint = screw;
        rotor.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
        rotor.inertia = ROTOR;
        CHECK(se3d_force_create_armature(system, &rotor, &force) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "coordinate");
        (void)add_armature(system, screw, SE3D_JOINT_COORDINATE_ANGLE, ROTOR);
        se3d_solver *solver =
            world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, formulations[k], 0.0);
        CHECK(se3d_solver_run(solver, 0.0) >= 0);
        CHECK(!se3d_joint_get_coordinate(system, screw, SE3D_JOINT_COORDINATE_ANGLE, &theta, &rate,
                                         &second));
        CHECK_NEAR(second, -2.0 * 9.81 * lead / (1.0 + 2.0 * lead * lead + ROTOR), 1e-11);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

int main(void)
{
    RUN(a_pendulum_with_a_rotor_falls_by_the_closed_form);
    RUN(bodies_in_space_share_the_effort_of_a_rotor);
    RUN(a_drive_turns_the_rotor_too);
    RUN(all_methods_take_armatures_or_say_that_they_do_not);
    RUN(steps_keep_their_order);
    RUN(formulations_agree_on_random_mechanisms);
    RUN(the_mass_matrix_of_the_tree_has_them_on_its_diagonal);
    RUN(loops_have_armatures_on_any_joint);
    RUN(a_new_inertia_acts_at_once_and_is_audited);
    RUN(a_rotor_lowers_the_frequency);
    RUN(a_rotor_between_bodies_couples_their_modes);
    RUN(a_screw_has_it_on_its_angle);
    return check_finish();
}
