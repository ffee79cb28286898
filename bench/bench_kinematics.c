/* SPDX-License-Identifier: BSD-3-Clause */
/* The cost of setting up and of one kinematic step of 1 to 1000 driven four-bars in a row, each on
 * its own revolutes: both must be flat per four-bar.   bench_kinematics [COUNT]... */
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void note(se3d_system *system, se3d_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
        exit(1);
    }
}

static se3d_body add_bar(se3d_system *system, const char *name, int k, const double a[3],
                         const double b[3])
{
    char text[32];
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    double angle = atan2(b[1] - a[1], b[0] - a[0]);
    snprintf(text, sizeof text, "%s_%d", name, k);
    def.name = text;
    def.mass = 1.0;
    def.inertia[0] = 0.01;
    def.inertia[1] = def.inertia[2] = 0.1;
    for (int c = 0; c < 3; ++c) {
        def.position[c] = 0.5 * (a[c] + b[c]);
    }
    def.orientation[0] = cos(0.5 * angle);
    def.orientation[3] = sin(0.5 * angle);
    note(system, se3d_body_create(system, &def, &body));
    return body;
}

static se3d_constraint add_pin(se3d_system *system, const char *name, int k, se3d_body i,
                               se3d_body j, const double at[3])
{
    const double axis[3] = {0.0, 0.0, 1.0};
    char text[32];
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    snprintf(text, sizeof text, "%s_%d", name, k);
    def.name = text;
    def.body_i = i;
    def.body_j = j;
    note(system, se3d_joint_def_set_frame(system, &def, at, axis, NULL));
    note(system, se3d_joint_create_revolute(system, &def, &joint));
    return joint;
}

/* Crank 1, coupler 2, rocker 2, base 2.2 m; the crank turns at its own rate. */
static void add_four_bar(se3d_system *system, int k)
{
    const double angle = 1.1 + 0.01 * (k % 7), z = 0.5 * k;
    const double O[3] = {0.0, 0.0, z}, Q[3] = {2.2, 0.0, z}, A[3] = {cos(angle), sin(angle), z};
    const double dx = Q[0] - A[0], dy = Q[1] - A[1], d = sqrt(dx * dx + dy * dy);
    const double h = sqrt(4.0 - 0.25 * d * d) / d;
    const double B[3] = {A[0] + 0.5 * dx - h * dy, A[1] + 0.5 * dy + h * dx, z};
    se3d_body ground;
    note(system, se3d_system_get_ground(system, &ground));
    se3d_body crank = add_bar(system, "crank", k, O, A);
    se3d_body coupler = add_bar(system, "coupler", k, A, B);
    se3d_body rocker = add_bar(system, "rocker", k, Q, B);
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_constraint made;
    driver.joint = add_pin(system, "O", k, ground, crank, O);
    add_pin(system, "A", k, crank, coupler, A);
    add_pin(system, "B", k, coupler, rocker, B);
    add_pin(system, "Q", k, ground, rocker, Q);
    driver.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    note(system, se3d_function_create_expression(system, "1.5*t+0.2*sin(3*t)", &driver.function));
    note(system, se3d_driver_create(system, &driver, &made));
}

static void measure(int count)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_stats stats;
    double begin = now();
    if (se3d_system_create(NULL, &system) < 0) {
        exit(1);
    }
    for (int k = 0; k < count; ++k) {
        add_four_bar(system, k);
    }
    double built = now();
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = SE3D_ANALYSIS_KINEMATICS;
    note(system, se3d_solver_create(system, &def, &solver));
    note(system, se3d_solver_run(solver, 0.01));
    double started = now();
    const int steps = count < 50 ? 200 : 20;
    for (int k = 1; k <= steps; ++k) {
        note(system, se3d_solver_run(solver, 0.01 + 0.01 * k));
    }
    double ended = now();
    note(system, se3d_solver_get_stats(solver, &stats));
    printf("%6d four-bars: build %8.2f us, first step %8.2f us, step %8.2f us per four-bar "
           "(%.1f iterations a step)\n",
           count, 1e6 * (built - begin) / count, 1e6 * (started - built) / count,
           1e6 * (ended - started) / count / steps, (double)stats.iterations / (steps + 1));
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

int main(int argc, char **argv)
{
    static const int counts[] = {1, 3, 10, 30, 100, 300, 1000};
    for (int k = 1; k < argc; ++k) {
        measure(atoi(argv[k]));
    }
    for (size_t k = 0; argc < 2 && k < sizeof counts / sizeof counts[0]; ++k) {
        measure(counts[k]);
    }
    return 0;
}
