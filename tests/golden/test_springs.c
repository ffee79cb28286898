/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs against reference answers (tests/data): a mass on a TSDA (closed form), a bar with an
 * RSDA and a TSDA and a pendulum with an RSDA (minimal coordinates, 1e-13). The implicit methods to
 * their order, both formulations. */
#include "check.h"

#include "se3d/se3d.h"

#include <stdlib.h>

#define ROWS_MAX 400
#define COLUMNS  30

typedef struct table {
    double value[ROWS_MAX][COLUMNS];
    int rows;
} table;

static table data;

static void read_table(const char *name)
{
    char path[256];
    char line[4096];
    snprintf(path, sizeof path, "tests/data/%s.csv", name);
    FILE *file = fopen(path, "r");
    CHECK(file != NULL);
    data.rows = 0;
    if (!file) {
        return;
    }
    CHECK(fgets(line, sizeof line, file) != NULL);
    while (data.rows < ROWS_MAX && fgets(line, sizeof line, file)) {
        char *text = line;
        for (int c = 0; c < COLUMNS && *text && *text != '\n'; ++c) {
            data.value[data.rows][c] = strtod(text, &text);
            text += *text == ',';
        }
        ++data.rows;
    }
    fclose(file);
    CHECK(data.rows > 10);
}

typedef struct problem {
    se3d_system *system;
    se3d_body ground, body;
    se3d_constraint joint;
    se3d_force rsda, tsda;
} problem;

typedef void (*build_problem)(problem *p);

static void begin(problem *p, const double gravity[3])
{
    CHECK(se3d_system_create(NULL, &p->system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(p->system, gravity) == SE3D_OK);
    CHECK(se3d_system_get_ground(p->system, &p->ground) == SE3D_OK);
}

static void hinge(problem *p, const double axis[3], double angle0)
{
    const double at[3] = {0.0, 0.0, 0.0};
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = p->ground;
    def.body_j = p->body;
    def.angle0 = angle0;
    CHECK(se3d_joint_def_set_frame(p->system, &def, at, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(p->system, &def, &p->joint) == SE3D_OK);
}

static void build_tsda_mass(problem *p)
{
    const double none[3] = {0.0, 0.0, 0.0};
    const double axis[3] = {1.0, 0.0, 0.0};
    begin(p, none);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 1.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.1;
    def.position[0] = 0.02;
    CHECK(se3d_body_create(p->system, &def, &p->body) == SE3D_OK);
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = p->ground;
    joint.body_j = p->body;
    CHECK(se3d_joint_def_set_frame(p->system, &joint, none, axis, NULL) == SE3D_OK);
    joint.point_j[0] = 0.0; /* the displacement counts from the origin */
    CHECK(se3d_joint_create_prismatic(p->system, &joint, &p->joint) == SE3D_OK);
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.body_i = p->ground;
    spring.body_j = p->body;
    spring.point_i[0] = -1.0;
    spring.k = 100.0;
    spring.c = 2.0;
    spring.l0 = 1.0;
    CHECK(se3d_force_create_tsda(p->system, &spring, &p->tsda) == SE3D_OK);
}

static void build_bar(problem *p)
{
    const double gravity[3] = {0.0, -9.81, 0.0};
    const double axis[3] = {0.0, 0.0, 1.0};
    begin(p, gravity);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 10.0;
    def.inertia[0] = 0.01;
    def.inertia[1] = def.inertia[2] = 10.0 / 12.0;
    def.position[0] = 0.5;
    CHECK(se3d_body_create(p->system, &def, &p->body) == SE3D_OK);
    hinge(p, axis, 0.0);
    se3d_rsda_def rsda = se3d_rsda_def_default();
    rsda.joint = p->joint;
    rsda.k = 20.0;
    rsda.c = 1.5;
    CHECK(se3d_force_create_rsda(p->system, &rsda, &p->rsda) == SE3D_OK);
    se3d_tsda_def tsda = se3d_tsda_def_default();
    tsda.body_i = p->body;
    tsda.body_j = p->ground;
    tsda.point_i[0] = 0.5;
    tsda.point_j[0] = 1.5;
    tsda.point_j[1] = 0.5;
    tsda.k = 300.0;
    tsda.c = 5.0;
    tsda.l0 = 0.8;
    CHECK(se3d_force_create_tsda(p->system, &tsda, &p->tsda) == SE3D_OK);
}

static void build_pendulum(problem *p)
{
    const double gravity[3] = {0.0, 0.0, -9.81};
    const double axis[3] = {1.0, 0.0, 0.0};
    const double pose[4] = {.65328148243818829, .27059805007309851, .65328148243818829,
                            .27059805007309851};
    begin(p, gravity);
    se3d_body_def def = se3d_body_def_default();
    def.mass = 78.0;
    def.inertia[0] = 0.0325;
    def.inertia[1] = def.inertia[2] = 104.01625;
    def.position[1] = sqrt(2.0);
    def.position[2] = -sqrt(2.0);
    memcpy(def.orientation, pose, sizeof pose);
    CHECK(se3d_body_create(p->system, &def, &p->body) == SE3D_OK);
    hinge(p, axis, 0.25 * 3.14159265358979324);
    se3d_rsda_def rsda = se3d_rsda_def_default();
    rsda.joint = p->joint;
    rsda.k = 25.0;
    rsda.c = 10.0;
    CHECK(se3d_force_create_rsda(p->system, &rsda, &p->rsda) == SE3D_OK);
}

static se3d_solver *make_solver(problem *p, int32_t method, int32_t formulation, double step)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.step = step;
    if (method == SE3D_METHOD_DOP853) {
        def.step = 0.0;
        def.tolerance = 1e-11;
    }
    CHECK(se3d_solver_create(p->system, &def, &solver) == SE3D_OK);
    return solver;
}

/* The largest error of coordinate, rate and acceleration over the table's first `rows` rows. */
static double trajectory_error(build_problem build, se3d_joint_coordinate coordinate, int columns,
                               int32_t method, int32_t formulation, double step)
{
    problem p = {0};
    double worst = 0.0;
    build(&p);
    se3d_solver *solver = make_solver(&p, method, formulation, step);
    for (int row = 0; row < data.rows && data.value[row][0] <= 2.0 + 1e-9; ++row) {
        double x[3];
        se3d_status status = se3d_solver_run(solver, data.value[row][0]);
        if (status < 0) {
            fprintf(stderr, "%s\n", se3d_system_get_error(p.system));
        }
        CHECK(status == SE3D_OK);
        CHECK(se3d_joint_get_coordinate(p.system, p.joint, coordinate, &x[0], &x[1], &x[2]) ==
              SE3D_OK);
        for (int c = 0; c < columns; ++c) {
            worst = fmax(worst, fabs(x[c] - data.value[row][1 + c]));
        }
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(p.system);
    return worst;
}

static void check_order(build_problem build, se3d_joint_coordinate coordinate, int columns,
                        double size)
{
    for (int32_t formulation = 0; formulation < 3; ++formulation) {
        for (int32_t method = SE3D_METHOD_GENERALIZED_ALPHA; method <= SE3D_METHOD_HHT; ++method) {
            double coarse = trajectory_error(build, coordinate, columns, method, formulation, 2e-3);
            double fine = trajectory_error(build, coordinate, columns, method, formulation, 1e-3);
            CHECK(coarse < size);
            CHECK_NEAR(coarse / fine, 4.0, 0.4);
        }
        double exact =
            trajectory_error(build, coordinate, columns, SE3D_METHOD_DOP853, formulation, 0.0);
        CHECK(exact < 1e-9);
    }
}

static void a_mass_on_a_tsda_moves_as_the_closed_form(void)
{
    read_table("tsda_mass");
    check_order(build_tsda_mass, SE3D_JOINT_COORDINATE_DISPLACEMENT, 3, 2e-3);
}

static void a_bar_with_rsda_and_tsda_moves_as_the_reference(void)
{
    read_table("bar_rsda_tsda");
    check_order(build_bar, SE3D_JOINT_COORDINATE_ANGLE, 2, 2e-3);
}

static void a_pendulum_with_rsda_moves_as_the_reference(void)
{
    read_table("pendulum_rsda");
    check_order(build_pendulum, SE3D_JOINT_COORDINATE_ANGLE, 3, 2e-4);
}

static void tsda_force_and_rsda_torque_follow_their_definition(void)
{
    problem p = {0};
    double l, ldot, f, theta, rate, n, wrench[6];
    build_bar(&p);
    CHECK(se3d_force_get_state(p.system, p.tsda, &l, &ldot, &f) == SE3D_OK);
    CHECK_NEAR(l, sqrt(0.5), 1e-15);
    CHECK_NEAR(f, 300.0 * (sqrt(0.5) - 0.8), 1e-12);
    /* compressed: it pushes the tip away from the anchor, down and left */
    CHECK(se3d_force_get_wrench(p.system, p.tsda, 0, wrench) == SE3D_OK);
    CHECK_NEAR(wrench[0], f * sqrt(0.5), 1e-12);
    CHECK_NEAR(wrench[1], f * sqrt(0.5), 1e-12);
    CHECK_NEAR(wrench[5], 0.5 * f * sqrt(0.5), 1e-12);
    CHECK(se3d_force_get_state(p.system, p.rsda, &theta, &rate, &n) == SE3D_OK);
    CHECK_NEAR(n, 0.0, 1e-15);
    se3d_system_destroy(p.system);
    build_pendulum(&p);
    read_table("pendulum_rsda");
    CHECK(se3d_force_get_state(p.system, p.rsda, &theta, &rate, &n) == SE3D_OK);
    CHECK_NEAR(theta, 0.25 * 3.14159265358979324, 1e-15);
    CHECK_NEAR(n, -data.value[0][26], 1e-12);
    CHECK(se3d_force_get_wrench(p.system, p.rsda, 1, wrench) == SE3D_OK);
    CHECK_NEAR(wrench[3], data.value[0][26], 1e-12);
    se3d_system_destroy(p.system);
}

/* kinetic + potential + dissipated - actuators - drivers stays, to the order of the method. */
static double audit_gap(int32_t method, double step)
{
    problem p = {0};
    se3d_energy energy;
    se3d_work work;
    build_bar(&p);
    se3d_solver *solver = make_solver(&p, method, 0, step);
    CHECK(se3d_solver_run(solver, 0.0) == SE3D_OK);
    CHECK(se3d_system_get_energy(p.system, &energy) == SE3D_OK);
    double start = energy.total;
    CHECK(se3d_solver_run(solver, 1.0) == SE3D_OK);
    CHECK(se3d_system_get_energy(p.system, &energy) == SE3D_OK);
    CHECK(se3d_system_get_work(p.system, &work) == SE3D_OK);
    CHECK(energy.dissipated > 1.0);
    CHECK_NEAR(energy.dissipated, work.dissipated, 0.0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(p.system);
    return fabs(energy.total + work.dissipated - work.actuators - work.drivers - start);
}

static void the_energy_audit_closes_to_the_order_of_the_method(void)
{
    double coarse = audit_gap(SE3D_METHOD_GENERALIZED_ALPHA, 2e-3);
    double fine = audit_gap(SE3D_METHOD_GENERALIZED_ALPHA, 1e-3);
    CHECK(fine < 2e-4);
    CHECK_NEAR(coarse / fine, 4.0, 0.5);
    CHECK(audit_gap(SE3D_METHOD_DOP853, 0.0) < 1e-8);
}

/* A driven, loaded, damped pendulum in gravity that changes: every account is in use. */
static void the_energy_audit_closes_with_drivers_loads_and_actuators(void)
{
    problem p = {0};
    se3d_force force;
    se3d_energy start, end;
    se3d_work work;
    const char *const variables[3] = {"t", "theta", "rate"};
    se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
    build_pendulum(&p);
    CHECK(se3d_function_create_expression(p.system, "-9.81 - 3*sin(2*t)", &gravity[2]) == SE3D_OK);
    CHECK(se3d_system_set_gravity_function(p.system, gravity) == SE3D_OK);
    se3d_load_def load = se3d_load_def_default();
    load.body = p.body;
    load.point[0] = 1.0;
    CHECK(se3d_function_create_expression(p.system, "50*cos(3*t)", &load.function[1]) == SE3D_OK);
    CHECK(se3d_force_create_load(p.system, &load, &force) == SE3D_OK);
    se3d_rsda_def motor = se3d_rsda_def_default();
    se3d_function_def h = se3d_function_def_default();
    h.expression = "20*sin(t) + rate*theta";
    h.variables = variables;
    h.variable_count = 3;
    motor.joint = p.joint;
    CHECK(se3d_function_create(p.system, &h, &motor.h) == SE3D_OK);
    CHECK(se3d_force_create_rsda(p.system, &motor, &force) == SE3D_OK);
    /* a second bar at the tip, driven */
    se3d_body_def body = se3d_body_def_default();
    se3d_body tip;
    const double at[3] = {0.0, 2.0 * sqrt(2.0), -2.0 * sqrt(2.0)};
    const double axis[3] = {1.0, 0.0, 0.0};
    body.mass = 20.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 2.0;
    memcpy(body.position, at, sizeof at);
    body.position[1] += 1.0;
    CHECK(se3d_body_create(p.system, &body, &tip) == SE3D_OK);
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_constraint elbow, drive;
    joint.body_i = p.body;
    joint.body_j = tip;
    CHECK(se3d_joint_def_set_frame(p.system, &joint, at, axis, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(p.system, &joint, &elbow) == SE3D_OK);
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = elbow;
    CHECK(se3d_function_create_expression(p.system, "0.5*(1 - cos(2*t))", &driver.function) ==
          SE3D_OK);
    CHECK(se3d_driver_create(p.system, &driver, &drive) == SE3D_OK);
    se3d_solver *solver = make_solver(&p, SE3D_METHOD_DOP853, 0, 0.0);
    CHECK(se3d_solver_run(solver, 0.0) == SE3D_OK);
    CHECK(se3d_system_get_energy(p.system, &start) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 2.0) == SE3D_OK);
    CHECK(se3d_system_get_energy(p.system, &end) == SE3D_OK);
    CHECK(se3d_system_get_work(p.system, &work) == SE3D_OK);
    CHECK(fabs(work.drivers) > 1.0 && fabs(work.actuators) > 1.0 && work.dissipated > 1.0);
    double gap = end.total - start.total + work.dissipated - work.actuators - work.drivers;
    CHECK_NEAR(gap, 0.0, 1e-8 * fabs(start.total));
    se3d_solver_destroy(solver);
    se3d_system_destroy(p.system);
}

int main(void)
{
    RUN(a_mass_on_a_tsda_moves_as_the_closed_form);
    RUN(a_bar_with_rsda_and_tsda_moves_as_the_reference);
    RUN(a_pendulum_with_rsda_moves_as_the_reference);
    RUN(tsda_force_and_rsda_torque_follow_their_definition);
    RUN(the_energy_audit_closes_to_the_order_of_the_method);
    RUN(the_energy_audit_closes_with_drivers_loads_and_actuators);
    return check_finish();
}
