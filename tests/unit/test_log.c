/* SPDX-License-Identifier: BSD-3-Clause */
/* The log: failures, redundant constraints, changes of method, starts that were projected; each
 * once, none with an effect on results. And how much of a start was changed. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/parts.h"
#include "support/world.h"

typedef struct sheet {
    se3d_system *system;
    int lines[3]; /* of each level */
    int refused;  /* calls from within that were */
    int meddles;
    char last[3][600];
    se3d_log_kind kind[3];
} sheet;

static void write_line(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    sheet *s = ctx;
    ++s->lines[level];
    s->kind[level] = kind;
    snprintf(s->last[level], sizeof s->last[level], "%s", message);
    if (s->meddles) {
        se3d_body body;
        se3d_energy energy;
        const se3d_body_def def = se3d_body_def_default();
        const double g[3] = {0.0, 0.0, 0.0};
        s->refused += se3d_body_create(s->system, &def, &body) == SE3D_ERR_STATE;
        s->refused += se3d_system_set_gravity(s->system, g) == SE3D_ERR_STATE;
        s->refused += se3d_system_get_energy(s->system, &energy) == SE3D_ERR_STATE;
        se3d_system_destroy(s->system);
    }
}

static void open_sheet(sheet *s, int silent)
{
    se3d_system_def def = se3d_system_def_default();
    *s = (sheet){.system = NULL};
    def.log = silent ? NULL : write_line;
    def.log_ctx = s;
    CHECK(!se3d_system_create(&def, &s->system));
}

static se3d_body add_bar(const sheet *s, const char *name, double x)
{
    return part_body(s->system, name, x, 0.0);
}

static se3d_constraint add_pin(const sheet *s, se3d_body body, const char *name)
{
    const double at[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 1.0, 0.0};
    se3d_body ground;
    CHECK(!se3d_system_get_ground(s->system, &ground));
    return world_join(s->system, se3d_joint_create_revolute, name, ground, body, at, axis);
}

static se3d_solver *solver_of(const sheet *s, int32_t analysis)
{
    return world_solver(s->system, analysis, SE3D_METHOD_AUTO, SE3D_FORMULATION_ROMEGA, 0.0);
}

static int total(const sheet *s)
{
    return s->lines[0] + s->lines[1] + s->lines[2];
}

static void every_failure_is_logged_once(void)
{
    sheet s;
    se3d_body body;
    se3d_function function;
    open_sheet(&s, 0);
    se3d_body_def def = se3d_body_def_default();
    def.mass = -1.0;
    CHECK(se3d_body_create(s.system, &def, &body) < 0);
    CHECK(s.lines[SE3D_LOG_ERROR] == 1 && total(&s) == 1);
    CHECK(strcmp(s.last[SE3D_LOG_ERROR], se3d_system_get_error(s.system)) == 0);
    CHECK_CONTAINS(s.last[SE3D_LOG_ERROR], "mass = -1");
    CHECK(s.kind[SE3D_LOG_ERROR] == SE3D_LOG_FAILURE);
    CHECK(se3d_function_create_expression(s.system, "cos(t", &function) < 0);
    CHECK(s.lines[SE3D_LOG_ERROR] == 2 && total(&s) == 2);
    add_pin(&s, add_bar(&s, "bar", 1.0), "pin");
    se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_KINEMATICS);
    CHECK(se3d_solver_run(solver, 1.0) == SE3D_ERR_SINGULAR);
    CHECK(s.lines[SE3D_LOG_ERROR] == 3 && total(&s) == 3);
    CHECK(strcmp(s.last[SE3D_LOG_ERROR], se3d_system_get_error(s.system)) == 0);
    CHECK(se3d_solver_run(solver, -1.0) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(s.lines[SE3D_LOG_ERROR] == 4);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
}

static void redundant_constraints_are_logged_once(void)
{
    sheet s;
    open_sheet(&s, 0);
    const se3d_body bar = add_bar(&s, "bar", 1.0);
    add_pin(&s, bar, "a");
    add_pin(&s, bar, "b");
    se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
    CHECK(se3d_solver_run(solver, 0.1) == SE3D_INFO_REDUNDANT);
    CHECK(se3d_solver_run(solver, 0.2) == SE3D_INFO_REDUNDANT);
    CHECK(s.lines[SE3D_LOG_WARNING] == 1 && total(&s) == 1);
    CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "redundant");
    CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_REDUNDANT);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
}

static void a_method_without_joint_coordinates_is_logged_once(void)
{
    static const struct {
        int32_t method;
        int warnings;
    } cases[] = {{SE3D_METHOD_DOP853, 0}, {SE3D_METHOD_RK4, 0},   {SE3D_METHOD_GAUSS, 0},
                 {SE3D_METHOD_BDF, 1},    {SE3D_METHOD_RADAU, 1}, {SE3D_METHOD_HHT, 1},
                 {SE3D_METHOD_RATTLE, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        sheet s;
        open_sheet(&s, 0);
        add_pin(&s, add_bar(&s, "bar", 1.0), "pin");
        se3d_solver *solver = world_solver(s.system, SE3D_ANALYSIS_DYNAMICS, cases[k].method,
                                           SE3D_FORMULATION_JOINT, 0.0);
        CHECK(!se3d_solver_run(solver, 0.01));
        CHECK(!se3d_solver_run(solver, 0.02));
        CHECK(s.lines[SE3D_LOG_WARNING] == cases[k].warnings);
        if (cases[k].warnings) {
            CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "works with the coordinates of bodies");
            CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_METHOD);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(s.system);
    }
}

/* What is used is told once, and so is that errors are not controlled. */
static void a_tolerance_that_is_not_reached_is_logged_once(void)
{
    static const struct {
        int32_t method;
        double asked, step, used;
        const char *name; /* in the log, NULL: nothing */
    } rows[] = {{SE3D_METHOD_AUTO, 1e-13, 0.0, 2e-13 / 0.3, "gauss"},
                {SE3D_METHOD_DOP853, 1e-14, 0.0, 2e-13 / 0.03, "dop853"},
                {SE3D_METHOD_DOP853, 1e-14, 1e-3, 2e-13 / 0.03, "dop853"},
                {SE3D_METHOD_RK45, 1e-12, 0.0, 2e-13 / 0.03, "rk45"},
                {SE3D_METHOD_RK4, 1e-12, 0.0, 2e-13 / 0.03, "rk4"},
                {SE3D_METHOD_GAUSS, 1e-13, 0.0, 2e-13 / 0.3, "gauss"},
                {SE3D_METHOD_GAUSS, 1e-12, 0.0, 1e-12, NULL},
                {SE3D_METHOD_BDF, 1e-12, 0.0, 1e-11, "bdf"},
                {SE3D_METHOD_RADAU, 1e-14, 0.0, 1e-13, "radau"},
                {SE3D_METHOD_GENERALIZED_ALPHA, 1e-12, 0.0, 1e-11, "generalized_alpha"},
                {SE3D_METHOD_HHT, 1e-12, 0.0, 1e-11, "hht"},
                {SE3D_METHOD_DOP853, 1e-11, 0.0, 1e-11, NULL},
                {SE3D_METHOD_BDF, 0.0, 0.0, 1e-6, NULL},
                {SE3D_METHOD_RADAU, 1e-12, 0.0, 1e-12, NULL},
                {SE3D_METHOD_GENERALIZED_ALPHA, 1e-12, 1e-4, 0.0, NULL},
                {SE3D_METHOD_RATTLE, 1e-14, 0.0, 1e-10, "rattle"},
                {SE3D_METHOD_VERLET, 1e-14, 0.0, 1e-10, "verlet"},
                {SE3D_METHOD_RATTLE, 1e-9, 0.0, 1e-9, NULL},
                {SE3D_METHOD_RATTLE, 1e-14, 1e-4, 0.0, NULL},
                {SE3D_METHOD_VERLET, 1e-14, 1e-4, 0.0, NULL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        sheet s;
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        double used = -1.0;
        open_sheet(&s, 0);
        add_pin(&s, add_bar(&s, "bar", 1.0), "pin");
        def.method = rows[k].method;
        def.tolerance = rows[k].asked;
        def.step = rows[k].step;
        CHECK(!se3d_solver_create(s.system, &def, &solver));
        CHECK(!se3d_solver_run(solver, 1e-3) && !se3d_solver_run(solver, 2e-3));
        CHECK(!se3d_solver_get_tolerance(solver, &used));
        CHECK_NEAR(used / fmax(rows[k].used, 1e-300), rows[k].used > 0.0 ? 1.0 : 0.0, 1e-12);
        CHECK(total(&s) == (rows[k].name != NULL));
        if (rows[k].name) {
            CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], rows[k].name);
            CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_TOLERANCE);
            CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "tolerance");
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(s.system);
    }
}

static se3d_status damp(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)ctx, (void)t, (void)K, (void)D;
    for (int k = 0; k < 3; ++k) {
        wrench[6 + k] = -1e5 * motion[1].v[k] * (1.0 + motion[1].v[k] * motion[1].v[k]);
    }
    return SE3D_OK;
}

static void a_change_of_method_is_logged(void)
{
    sheet s;
    const char *left = NULL;
    double at = 0.0;
    se3d_force force;
    se3d_force_callback_def def = se3d_force_callback_def_default();
    open_sheet(&s, 0);
    def.body_j = add_bar(&s, "bar", 1.0);
    CHECK(!se3d_system_get_ground(s.system, &def.body_i));
    def.callback = damp;
    CHECK(!se3d_force_create_callback(s.system, &def, &force));
    se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
    CHECK(!se3d_solver_run(solver, 1.0));
    CHECK(!se3d_solver_get_switch(solver, &at, &left));
    CHECK(strcmp(left, "dop853") == 0);
    CHECK(s.lines[SE3D_LOG_INFO] == 1 && total(&s) == 1);
    CHECK_CONTAINS(s.last[SE3D_LOG_INFO], "radau");
    CHECK(s.kind[SE3D_LOG_INFO] == SE3D_LOG_METHOD);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
}

/* A bar that spins about its pin, with its centre at rest. */
static void velocities_that_do_not_fit_are_told(void)
{
    sheet s;
    double v[3], w[3];
    const double given[3] = {0.0, 6.0, 0.0};
    se3d_start_change change;
    open_sheet(&s, 0);
    const se3d_body bar = add_bar(&s, "bar", 1.0);
    add_pin(&s, bar, "pin");
    CHECK(!se3d_body_set_angular_velocity(s.system, bar, given));
    se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
    CHECK(!se3d_solver_run(solver, 0.0));
    CHECK(!se3d_body_get_velocity(s.system, bar, v));
    CHECK(!se3d_body_get_angular_velocity(s.system, bar, w));
    CHECK(!se3d_solver_get_start_change(solver, &change));
    CHECK(fabs(v[2]) > 0.1 && change.deflected.index1 == bar.index1 && change.moved.index1 == 0);
    CHECK_NEAR(change.velocity, fabs(v[2]), 1e-12);
    CHECK_NEAR(change.most_velocity, fabs(v[2]), 1e-12);
    CHECK_NEAR(change.angular_velocity, 6.0 - w[1], 1e-12);
    CHECK(!(change.position > 0.0) && !(change.rotation > 0.0));
    CHECK(s.lines[SE3D_LOG_WARNING] == 1 && total(&s) == 1);
    CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "given velocities");
    CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_START);
    CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "body bar");
    CHECK(!se3d_solver_run(solver, 0.1)); /* the same start: nothing new */
    CHECK(!se3d_solver_get_start_change(solver, &change) && change.velocity > 0.1);
    CHECK(total(&s) == 1);
    CHECK(!se3d_body_set_velocity(s.system, bar, v)); /* a new one, that does not fit either */
    CHECK(!se3d_solver_run(solver, 0.2) && s.lines[SE3D_LOG_WARNING] == 2);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
}

static void positions_that_do_not_fit_are_told(void)
{
    sheet s;
    double r[3];
    se3d_constraint link;
    se3d_start_change change;
    se3d_joint_def def = se3d_joint_def_default();
    open_sheet(&s, 0);
    def.body_j = add_bar(&s, NULL, 1.0);
    CHECK(!se3d_system_get_ground(s.system, &def.body_i));
    def.distance = 3.0;
    CHECK(!se3d_joint_create_distance(s.system, &def, &link));
    se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
    CHECK(!se3d_solver_run(solver, 0.01));
    CHECK(!se3d_solver_get_start_change(solver, &change));
    CHECK(change.moved.index1 == def.body_j.index1 && !(change.time > 0.0));
    CHECK_NEAR(change.position, 2.0, 1e-9);
    CHECK_NEAR(change.most_position, 2.0, 1e-9);
    CHECK(s.lines[SE3D_LOG_WARNING] == 1 && total(&s) == 1);
    CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "moved by 2 m");
    CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_MOVED);
    CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "number 1");
    se3d_solver_destroy(solver);
    solver = solver_of(&s, SE3D_ANALYSIS_ASSEMBLY); /* is meant to move: information */
    CHECK(!se3d_body_get_position(s.system, def.body_j, r));
    r[0] += 0.1;
    CHECK(!se3d_body_set_position(s.system, def.body_j, r));
    CHECK(!se3d_solver_run(solver, 0.01) && s.lines[SE3D_LOG_INFO] > 0);
    CHECK(s.lines[SE3D_LOG_WARNING] == 1 && s.lines[SE3D_LOG_ERROR] == 0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
}

/* Rounding, of a start as a file with twelve digits has it, and one in metres far away. */
static void rounding_is_no_change(void)
{
    for (int k = 0; k < 3; ++k) {
        sheet s;
        se3d_start_change change;
        open_sheet(&s, 0);
        const se3d_body bar = add_bar(&s, "bar", k == 2 ? 1e4 : 1.0);
        const double r[3] = {(k == 2 ? 1e4 : 1.0) * (k == 1 ? 1.0 + 1e-12 : 1.0), 0.0, 0.0};
        const double w[3] = {0.0, 2.0, 0.0}, v[3] = {0.0, 0.0, -2.0 * r[0] * (1.0 + 1e-13)};
        add_pin(&s, bar, "pin");
        CHECK(!se3d_body_set_position(s.system, bar, r));
        CHECK(!se3d_body_set_velocity(s.system, bar, v));
        CHECK(!se3d_body_set_angular_velocity(s.system, bar, w));
        se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
        CHECK(!se3d_solver_run(solver, 0.01));
        CHECK(!se3d_solver_get_start_change(solver, &change));
        CHECK(change.moved.index1 == 0 && change.deflected.index1 == 0 && total(&s) == 0);
        CHECK(!(change.position > 0.0) && !(change.velocity > 0.0));
        se3d_solver_destroy(solver);
        se3d_system_destroy(s.system);
    }
}

/* rattle and verlet have chosen their steps under a gravity that then grows. */
static void equal_steps_that_are_too_long_are_told(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};
    for (int run = 0; run < 4; ++run) {
        const double strong[3] = {0.0, 0.0, -4e4};
        const int is_given = run >= 2;
        double chosen = 0.0, told = 0.0;
        sheet s;
        open_sheet(&s, 0);
        add_pin(&s, add_bar(&s, "bar", 1.0), "a");
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.method = methods[run % 2];
        def.step = is_given ? 1e-4 : 0.0;
        CHECK(!se3d_solver_create(s.system, &def, &solver));
        CHECK(!se3d_solver_run(solver, 0.1) && total(&s) == 0);
        CHECK(!se3d_solver_get_step(solver, &chosen));
        CHECK(!se3d_system_set_gravity(s.system, strong));
        CHECK(!se3d_solver_run(solver, 0.3));
        CHECK(total(&s) == s.lines[SE3D_LOG_WARNING] && total(&s) <= 3);
        CHECK((total(&s) > 0) == (run < 2));
        if (run < 2) {
            const char *size = strstr(s.last[SE3D_LOG_WARNING], "the step of ");
            CHECK(size && sscanf(size, "the step of %lf s", &told) == 1);
            CHECK(told > 0.0 && told <= chosen * (1.0 + 1e-3));
            CHECK_CONTAINS(s.last[SE3D_LOG_WARNING], "is too long here: the error of a step is ");
            CHECK(s.kind[SE3D_LOG_WARNING] == SE3D_LOG_STEP);
        }
        se3d_solver_destroy(solver);
        se3d_system_destroy(s.system);
    }
}

static void the_log_has_no_effect(void)
{
    uint64_t hash[3];
    for (int k = 0; k < 3; ++k) {
        sheet s;
        const double given[3] = {0.0, 6.0, 0.0};
        se3d_body body;
        se3d_body_def bad = se3d_body_def_default();
        open_sheet(&s, k == 0);
        const se3d_body bar = add_bar(&s, "bar", 1.0);
        add_pin(&s, bar, "a");
        add_pin(&s, bar, "b");
        CHECK(!se3d_body_set_angular_velocity(s.system, bar, given));
        s.meddles = k == 2;
        CHECK(se3d_body_create(s.system, &bad, &body) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(s.system), "mass = 0");
        CHECK(!se3d_system_is_busy(s.system));
        se3d_solver *solver = solver_of(&s, SE3D_ANALYSIS_DYNAMICS);
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_INFO_REDUNDANT);
        CHECK(k == 0 || (total(&s) == 3 && s.refused == (k == 2 ? 9 : 0)));
        hash[k] = se3d_system_hash(s.system);
        s.meddles = 0;
        se3d_solver_destroy(solver);
        se3d_system_destroy(s.system);
    }
    CHECK(hash[0] == hash[1] && hash[0] == hash[2]);
}

int main(void)
{
    RUN(every_failure_is_logged_once);
    RUN(redundant_constraints_are_logged_once);
    RUN(a_change_of_method_is_logged);
    RUN(a_method_without_joint_coordinates_is_logged_once);
    RUN(a_tolerance_that_is_not_reached_is_logged_once);
    RUN(velocities_that_do_not_fit_are_told);
    RUN(positions_that_do_not_fit_are_told);
    RUN(rounding_is_no_change);
    RUN(equal_steps_that_are_too_long_are_told);
    RUN(the_log_has_no_effect);
    return check_finish();
}
