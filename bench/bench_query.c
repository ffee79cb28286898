/* SPDX-License-Identifier: BSD-3-Clause */
/* What a controller asks of one robot (bench/robots.h): set the state, forward dynamics from
 * efforts; set the state, inverse dynamics from accelerations. CPU time of a query, by the public
 * interface; peers/mujoco_query.c asks MuJoCo the same, and prints the same accelerations. Then a
 * loop of control: a step of rk4 of 1 ms with new efforts against its four evaluations alone. */
#define _POSIX_C_SOURCE 200809L
#include "clock.h"
#include "robots.h"

#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROUNDS = 15, QUERIES = 2000 };

static void need(se3d_status status, const se3d_system *system)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
        exit(1);
    }
}

typedef struct robot {
    bench_robot of;
    se3d_system *system;
    se3d_coordinates *c;
    se3d_solver *solver;
    size_t n, positions;
    double q[BENCH_ROBOT_STATE + 1], qdot[BENCH_ROBOT_STATE], effort[BENCH_ROBOT_STATE];
    double qddot[BENCH_ROBOT_STATE];
    double efforts[BENCH_ROBOT_STATE]; /* of the elements */
    unsigned long seed;
} robot;

static void add_link(robot *r, int k, se3d_body *bodies, double (*at)[3])
{
    const bench_link *link = &r->of.link[k];
    const int parent = r->of.parent[k];
    static const double none[3] = {0.0, 0.0, 0.0};
    const double *base = parent < 0 ? none : at[parent];
    const double *centre = parent < 0 ? none : r->of.link[parent].centre;
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def def = se3d_joint_def_default();
    se3d_effort_def drive = se3d_effort_def_default();
    se3d_force force;
    body.mass = link->mass;
    need(parent < 0 ? se3d_system_get_ground(r->system, &def.body_i) : SE3D_OK, r->system);
    def.body_i = parent < 0 ? def.body_i : bodies[parent];
    for (int c = 0; c < 3; ++c) {
        at[k][c] = base[c] + link->at[c];
        body.position[c] = at[k][c] + link->centre[c];
        body.inertia[c] = link->inertia[c];
        def.point_i[c] = link->at[c] - centre[c];
        def.point_j[c] = -link->centre[c];
        def.axis_i[c] = def.axis_j[c] = link->axis[c];
    }
    need(se3d_body_create(r->system, &body, &bodies[k]), r->system);
    def.body_j = bodies[k];
    if (!(r->of.is_free && k == 0)) {
        need(se3d_joint_create_revolute(r->system, &def, &drive.joint), r->system);
        need(se3d_force_create_effort(r->system, &drive, &force), r->system);
    }
}

static void begin(robot *r, int which)
{
    se3d_body bodies[BENCH_ROBOT_LINKS];
    double at[BENCH_ROBOT_LINKS][3];
    se3d_solver_def def = se3d_solver_def_default();
    *r = (robot){.of = bench_make_robot(which), .seed = 1};
    need(se3d_system_create(NULL, &r->system), r->system);
    for (int k = 0; k < r->of.count; ++k) {
        add_link(r, k, bodies, at);
    }
    need(se3d_coordinates_create(r->system, &r->c), r->system);
    def.method = SE3D_METHOD_RK4;
    def.step = BENCH_ARM_STEP;
    need(se3d_solver_create(r->system, &def, &r->solver), r->system);
    r->n = se3d_coordinates_count(r->c);
    r->positions = se3d_coordinates_count_positions(r->c);
    need(se3d_coordinates_get(r->c, r->q, NULL), r->system);
    for (size_t k = r->of.is_free ? 7 : 0; k < r->positions; ++k) {
        r->q[k] = 0.1 * (double)(k % 7) - 0.3;
    }
    for (size_t k = 0; k < r->n; ++k) {
        r->qdot[k] = 0.1 * (double)(k % 5) - 0.2;
        r->effort[k] = 0.2 * (double)(k % 3);
    }
}

static void end(robot *r)
{
    se3d_coordinates_destroy(r->c);
    se3d_solver_destroy(r->solver);
    se3d_system_destroy(r->system);
}

static void forward(robot *r)
{
    need(se3d_coordinates_set(r->c, r->q, r->qdot), r->system);
    need(se3d_coordinates_compute_accelerations(r->c, r->effort, r->qddot), r->system);
}

static void inverse(robot *r)
{
    double effort[BENCH_ROBOT_STATE];
    need(se3d_coordinates_set(r->c, r->q, r->qdot), r->system);
    need(se3d_coordinates_compute_efforts(r->c, r->qddot, effort), r->system);
}

static void step(robot *r)
{
    const size_t efforts = (size_t)(r->of.count - r->of.is_free);
    for (size_t k = 0; k < efforts; ++k) {
        r->efforts[k] = 0.01 * bench_effort(&r->seed);
    }
    need(se3d_effort_set_all(r->system, efforts, r->efforts), r->system);
    need(se3d_solver_step(r->solver, BENCH_ARM_STEP), r->system);
}

/* Least CPU time of one [ns]. */
static double measure(robot *r, void (*ask)(robot *))
{
    double least = HUGE_VAL;
    for (int round = 0; round < ROUNDS; ++round) {
        const double start = bench_clock();
        for (int k = 0; k < QUERIES / ROUNDS; ++k) {
            ask(r);
        }
        least = fmin(least, bench_clock() - start);
    }
    return 1e9 * least / (QUERIES / ROUNDS);
}

/* One robot and one kind of query, many times, for callgrind: `arm forward 10000`. */
static int repeat(int which, const char *what, int count)
{
    robot r;
    begin(&r, which);
    void (*const ask)(robot *) = *what == 'f' ? forward : *what == 'i' ? inverse : step;
    for (int k = 0; k < count; ++k) {
        ask(&r);
    }
    end(&r);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 3) {
        return repeat(atoi(argv[1]), argv[2], atoi(argv[3]));
    }
    for (int which = 0; which < 3; ++which) {
        robot r;
        begin(&r, which);
        forward(&r);
        printf("se3d   %-10s qddot %.7g %.7g %.7g;", r.of.name, r.qddot[0], r.qddot[r.n / 2],
               r.qddot[r.n - 1]);
        const double f = measure(&r, forward), i = measure(&r, inverse);
        printf(" forward %7.0f ns, inverse %7.0f ns,", f, i);
        printf(" rk4 step with new efforts %7.0f ns\n", measure(&r, step));
        end(&r);
    }
    return 0;
}
