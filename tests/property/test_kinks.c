/* SPDX-License-Identifier: BSD-3-Clause */
/* Prescribed rates that jump: an impulse acts, which is told, and its work is that of the drivers,
 * under inverse dynamics and under dynamics by every method. */
#include "support/methods.h"
#include "support/text_model.h"

typedef struct notes {
    int count;
    double impulse, work; /* of all that was told */
    char text[600];
} notes;

static void note(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    notes *n = ctx;
    if (level == SE3D_LOG_WARNING && kind == SE3D_LOG_KINK) {
        double impulse = 0.0, work = 0.0;
        CHECK(sscanf(strstr(message, "impulse of"), "impulse of %lf", &impulse) == 1);
        CHECK(sscanf(strstr(message, "the work"), "the work %lf", &work) == 1);
        n->impulse += impulse;
        n->work += work;
        ++n->count;
        snprintf(n->text, sizeof n->text, "%s", message);
    }
}

/* A cart of 2 kg with a bob of 1 kg below it, which swings if it is not held, at rest until the
 * cart moves on. */
static se3d_system *make_cart(notes *said, const char *value, int is_held)
{
    se3d_system *system = NULL;
    se3d_body ground, cart, bob;
    se3d_constraint slide, pin, push;
    se3d_function function;
    se3d_system_def world = se3d_system_def_default();
    const double origin[3] = {0.0, 0.0, 0.0}, x[3] = {1.0, 0.0, 0.0}, y[3] = {0.0, 1.0, 0.0};
    world.log = note;
    world.log_ctx = said;
    CHECK(!se3d_system_create(&world, &system));
    CHECK(!se3d_system_get_ground(system, &ground));
    se3d_body_def body = se3d_body_def_default();
    body.name = "cart";
    body.mass = 2.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_body_create(system, &body, &cart));
    body.name = "bob";
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.position[2] = -1.0;
    CHECK(!se3d_body_create(system, &body, &bob));
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = ground;
    joint.body_j = cart;
    CHECK(!se3d_joint_def_set_frame(system, &joint, origin, x, NULL));
    CHECK(!se3d_joint_create_prismatic(system, &joint, &slide));
    joint = se3d_joint_def_default();
    joint.body_i = cart;
    joint.body_j = bob;
    CHECK(!se3d_joint_def_set_frame(system, &joint, origin, y, NULL));
    CHECK(!se3d_joint_create_revolute(system, &joint, &pin));
    se3d_driver_def driver = se3d_driver_def_default();
    CHECK(!se3d_function_create_expression(system, value, &function));
    driver.name = "push";
    driver.joint = slide;
    driver.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    driver.function = function;
    CHECK(!se3d_driver_create(system, &driver, &push));
    driver = se3d_driver_def_default();
    driver.joint = pin;
    CHECK(!is_held || !se3d_driver_create(system, &driver, &push));
    return system;
}

static double get_gap(const se3d_system *system, double start)
{
    se3d_energy energy;
    se3d_work work;
    CHECK(!se3d_system_get_energy(system, &energy));
    CHECK(!se3d_system_get_work(system, &work));
    return energy.total + work.dissipated - work.drivers - start;
}

/* Inverse dynamics over the kink: the bob is held to the cart, 3 kg get 1 m/s. */
static void check_cart(int32_t formulation, double step, int outputs)
{
    notes said = {0};
    se3d_system *system = make_cart(&said, "if(t < 0.3, 0, t - 0.3)", 1);
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_energy before;
    def.analysis = SE3D_ANALYSIS_INVERSE_DYNAMICS;
    def.formulation = formulation;
    def.step = step;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(!se3d_solver_run(solver, 0.0));
    CHECK(!se3d_system_get_energy(system, &before));
    for (int k = 1; k <= outputs; ++k) {
        CHECK(!se3d_solver_run(solver, 0.5 * k / outputs));
    }
    CHECK(said.count == 1);
    CHECK_CONTAINS(said.text, "the rate of push.");
    CHECK_CONTAINS(said.text, "t = 0.3 s");
    CHECK_CONTAINS(said.text, "an impulse of 3 N s");
    CHECK_CONTAINS(said.text, "the work 1.5 J");
    CHECK_NEAR(get_gap(system, before.total), 0.0, 1e-9);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void the_impulse_of_a_rate_that_jumps_is_told_and_its_work_counted(void)
{
    static const double steps[] = {0.0, 0.01, 0.07};
    for (int32_t f = 0; f < 2; ++f) {
        for (size_t k = 0; k < 3; ++k) {
            check_cart(f, steps[k], 1);
            check_cart(f, steps[k], 5); /* an output at the kink */
        }
    }
}

/* Dynamics by one method over the kink at .5 s: the swinging bob follows as if it had
 * 1 kg - (1 kg)^2 (1 m)^2/(1.1 kg m^2), the impulse is (2 + .0909) N s. */
typedef struct crossing {
    int32_t method, formulation;
    int steps; /* not 0: by so many steps of the caller */
    int runs;  /* or by so many runs */
    double step;
} crossing;

static void cross(const crossing *c, const char *value)
{
    const int before = check_failures;
    notes said = {0};
    se3d_system *system = make_cart(&said, value, 0);
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    se3d_energy start;
    double t;
    def.method = c->method;
    def.formulation = c->formulation;
    def.step = c->step;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(!se3d_solver_run(solver, 0.0));
    CHECK(!se3d_system_get_energy(system, &start));
    for (int k = 1; k <= c->runs; ++k) {
        CHECK(!se3d_solver_run(solver, 0.7 * k / c->runs));
    }
    for (int k = 1; k <= c->steps; ++k) {
        CHECK(!se3d_solver_step(solver, 0.7 / c->steps));
    }
    CHECK(!se3d_system_get_time(system, &t));
    CHECK_NEAR(t, 0.7, 1e-15);
    CHECK(said.count == 1);
    CHECK_CONTAINS(said.text, "t = 0.5 s: the rate of push.");
    CHECK_NEAR(said.impulse, 2.0 + 1.0 / 11.0, 1e-5);
    CHECK_NEAR(said.work, 1.0 + 0.5 / 11.0, 1e-5);
    const double most = c->step > 0.0 || c->steps > 0 ? 2e-4 : 2e-5;
    CHECK_NEAR(get_gap(system, start.total), 0.0,
               c->method == SE3D_METHOD_CONVEX ? 2.0 * most : most); /* of order 1 */
    if (check_failures > before) {
        fprintf(stderr, "  %s, formulation %d, %d steps, %d runs, step %g\n",
                se3d_method_get_name(c->method), (int)c->formulation, c->steps, c->runs, c->step);
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void dynamics_pass_a_rate_that_jumps_in_every_method(void)
{
    static const crossing ways[] = {{.runs = 1},
                                    {.runs = 7}, /* an output at the kink */
                                    {.runs = 90},
                                    {.runs = 1, .step = 0.004},
                                    {.runs = 7, .step = 0.0071},
                                    {.steps = 100}};
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int32_t formulation = 0; formulation < 2; ++formulation) {
            for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
                crossing c = ways[k];
                c.method = method;
                c.formulation = formulation;
                cross(&c, k % 2 ? "if(t < 0.5, 0, t - 0.5)" : "max(0, t - 0.5)");
            }
        }
    }
}

/* A value that jumps together with its rate is refused all the same. */
static void values_that_jump_with_their_rates_are_refused(void)
{
    static const char *const values[] = {"if(t < 0.33333, 0, 1 + t)", "floor(3*t)*t"};
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        notes said = {0};
        se3d_system *system = make_cart(&said, values[k], 1);
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.analysis = SE3D_ANALYSIS_INVERSE_DYNAMICS;
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_ERR_INCONSISTENT);
        CHECK_CONTAINS(se3d_system_get_error(system), "jumps from");
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

static void smooth_rates_make_no_impulse(void)
{
    static const char *const values[] = {"0.1*sin(20*t)", "0.01*tanh(200*(t-0.3))",
                                         "max(0, t - 0.3)^2", "0.1*abs(t-0.31)^1.5"};
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        notes said = {0};
        se3d_system *system = make_cart(&said, values[k], 1);
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.analysis = k % 2 ? SE3D_ANALYSIS_INVERSE_DYNAMICS : SE3D_ANALYSIS_DYNAMICS;
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(se3d_solver_run(solver, 0.5) >= 0);
        CHECK(said.count == 0);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

int main(void)
{
    RUN(the_impulse_of_a_rate_that_jumps_is_told_and_its_work_counted);
    RUN(dynamics_pass_a_rate_that_jumps_in_every_method);
    RUN(values_that_jump_with_their_rates_are_refused);
    RUN(smooth_rates_make_no_impulse);
    return check_finish();
}
