/* SPDX-License-Identifier: BSD-3-Clause */
/* Values of elements that are set between steps: they act from the start of the next step, in every
 * method, by step and by run, and what is computed at the present time sees them. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/methods.h"
#include "support/parts.h"

#define STEPS 40
#define H     1e-3
#define SHORT 1e-4 /* of stiff bars */

/* How a callback learns of its value: by the user, who says so. */
static double pushed;

static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)K, (void)D;
    wrench[6] = pushed;
    wrench[11] = pushed;
    return SE3D_OK;
}

/* What is set. */
typedef enum input {
    INPUT_LOAD,      /* force and torque */
    INPUT_GRAVITY,   /* acceleration along x, no torque */
    INPUT_PRELOAD,   /* of an rsda about the pin */
    INPUT_CONSTANT,  /* function of an rsda */
    INPUT_EFFORT,    /* along the angle of the pin */
    INPUT_EFFORTS,   /* all at once */
    INPUT_HELD,      /* function of an effort */
    INPUT_CALLBACK,  /* force and torque, and se3d_system_touch */
    INPUT_FUNCTIONS, /* of a force and a torque */
    INPUTS
} input;

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    se3d_body body;
    se3d_constraint pin;
    se3d_force force, torque;
    se3d_function function;
    input kind;
} world;

static int is_on_pin(input kind)
{
    return kind >= INPUT_PRELOAD && kind <= INPUT_HELD;
}

static void add_effort(world *w, int has_function)
{
    se3d_effort_def def = se3d_effort_def_default();
    def.joint = w->pin;
    def.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    if (has_function) {
        def.function = w->function;
    }
    CHECK(!se3d_force_create_effort(w->system, &def, &w->torque));
}

static void add_actuator(world *w)
{
    se3d_joint_def pin = se3d_joint_def_default();
    CHECK(!se3d_system_get_ground(w->system, &pin.body_i));
    pin.body_j = w->body;
    CHECK(!se3d_joint_create_revolute(w->system, &pin, &w->pin));
    static const char *const names[3] = {"t", "theta", "rate"};
    se3d_function_def h = se3d_function_def_default();
    h.variables = names;
    h.variable_count = 3;
    CHECK(!se3d_function_create(w->system, &h, &w->function));
    if (w->kind == INPUT_EFFORT || w->kind == INPUT_EFFORTS || w->kind == INPUT_HELD) {
        add_effort(w, w->kind == INPUT_HELD);
        return;
    }
    se3d_rsda_def def = se3d_rsda_def_default();
    def.joint = w->pin;
    def.h = w->function;
    CHECK(!se3d_force_create_rsda(w->system, &def, &w->torque));
}

static void add_loads(world *w)
{
    se3d_load_def load = se3d_load_def_default();
    load.body = w->body;
    if (w->kind == INPUT_FUNCTIONS) {
        se3d_function_def constant = se3d_function_def_default();
        CHECK(!se3d_function_create(w->system, &constant, &w->function));
        load.function[0] = w->function;
        CHECK(!se3d_force_create_load(w->system, &load, &w->force));
        load.function[0] = (se3d_function){0, 0};
        load.function[2] = w->function;
        CHECK(!se3d_force_create_torque(w->system, &load, &w->torque));
        return;
    }
    CHECK(!se3d_force_create_load(w->system, &load, &w->force));
    CHECK(!se3d_force_create_torque(w->system, &load, &w->torque));
}

/* A body of 1 kg and 1 kg m^2, free or on a pin along z. */
static int make(world *w, input kind, int32_t method, int32_t formulation, int controls)
{
    const double none[3] = {0.0, 0.0, 0.0};
    *w = (world){.kind = kind};
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_set_gravity(w->system, none));
    se3d_body_def body = se3d_body_def_default();
    body.mass = body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    CHECK(!se3d_body_create(w->system, &body, &w->body));
    if (is_on_pin(kind)) {
        add_actuator(w);
    } else if (kind == INPUT_CALLBACK) {
        se3d_force_callback_def def = se3d_force_callback_def_default();
        CHECK(!se3d_system_get_ground(w->system, &def.body_i));
        def.body_j = w->body;
        def.callback = push;
        pushed = 0.0;
        CHECK(!se3d_force_create_callback(w->system, &def, &w->force));
    } else {
        add_loads(w);
    }
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.tolerance = method == SE3D_METHOD_BDF ? 1e-8 : 1e-9;
    def.step = controls ? 0.0 : H;
    const se3d_status status = se3d_solver_create(w->system, &def, &w->solver);
    CHECK(status == SE3D_OK || status == SE3D_ERR_UNSUPPORTED);
    return status == SE3D_OK;
}

static void destroy(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
}

static void set_input(world *w, double u)
{
    const double along[3] = {u, 0.0, 0.0}, about[3] = {0.0, 0.0, u};
    switch (w->kind) {
    case INPUT_LOAD:
        CHECK(!se3d_force_set_value(w->system, w->force, along));
        CHECK(!se3d_force_set_value(w->system, w->torque, about));
        break;
    case INPUT_GRAVITY:
        CHECK(!se3d_system_set_gravity(w->system, along));
        break;
    case INPUT_PRELOAD:
        CHECK(!se3d_force_set_parameter(w->system, w->torque, SE3D_FORCE_PARAMETER_PRELOAD, -u));
        break;
    case INPUT_CONSTANT:
        CHECK(!se3d_function_set_constant(w->system, w->function, -u));
        break;
    case INPUT_EFFORT:
        CHECK(!se3d_effort_set(w->system, w->torque, u));
        break;
    case INPUT_EFFORTS:
        CHECK(!se3d_effort_set_all(w->system, 1, &u));
        break;
    case INPUT_HELD:
    case INPUT_FUNCTIONS:
        CHECK(!se3d_function_set_constant(w->system, w->function, u));
        break;
    default:
        pushed = u;
        CHECK(!se3d_system_touch(w->system));
        break;
    }
}

/* The state is that of accelerations that were constant in each step. */
static void check_motion(const world *w, double rate, double way)
{
    const int moves = !is_on_pin(w->kind);
    const int turns = w->kind != INPUT_GRAVITY;
    double v[3], r[3], p[4], omega[3];
    CHECK(!se3d_body_get_position(w->system, w->body, r));
    CHECK(!se3d_body_get_velocity(w->system, w->body, v));
    CHECK(!se3d_body_get_orientation(w->system, w->body, p));
    CHECK(!se3d_body_get_angular_velocity(w->system, w->body, omega));
    CHECK_NEAR(v[0], moves ? rate : 0.0, 1e-15);
    CHECK_NEAR(r[0], moves ? way : 0.0, 1e-15);
    CHECK_NEAR(omega[2], turns ? rate : 0.0, 2e-14);
    CHECK_NEAR(2.0 * atan2(p[3], p[0]), turns ? way : 0.0, 1e-12);
}

/* A load that is held over each step, and another one in the next. */
static void hold_and_change(input kind, int32_t method, int32_t formulation, int by_run)
{
    world w;
    uint64_t seed = 12345;
    double rate = 0.0, way = 0.0;
    if (make(&w, kind, method, formulation, by_run)) {
        /* of order 1 at its start: without a load it is exact, too */
        CHECK(se3d_solver_step(w.solver, H) >= 0);
        const int before = check_failures;
        for (int k = 1; k <= STEPS; ++k) {
            const double u = check_random(&seed);
            double t;
            set_input(&w, u);
            CHECK(!se3d_system_get_time(w.system, &t));
            CHECK((by_run ? se3d_solver_run(w.solver, t + H) : se3d_solver_step(w.solver, H)) >= 0);
            way += H * (rate + 0.5 * H * u);
            rate += H * u;
            check_motion(&w, rate, way);
        }
        if (check_failures > before) {
            fprintf(stderr, "  %s, formulation %d, input %d, by %s\n", se3d_method_get_name(method),
                    (int)formulation, (int)kind, by_run ? "run" : "step");
        }
    }
    destroy(&w);
}

static void held_inputs_are_exact_in_every_method(void)
{
    for (int kind = 0; kind < INPUTS; ++kind) {
        for (int32_t method = 0; method < method_count(); ++method) {
            for (int k = 0; k < 6; ++k) {
                hold_and_change((input)kind, method, k / 2, k % 2);
            }
        }
    }
}

/* Runs that end within a step which the method has made already: it is made again. */
static void inputs_may_be_set_within_a_step_made_ahead(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        world w;
        uint64_t seed = 99;
        double rate = 0.0, way = 0.0, u = 0.0, t = 0.0;
        const double angle = method == SE3D_METHOD_BDF ? 1e-6 : 1e-8; /* by their tolerances */
        if (!make(&w, INPUT_LOAD, method, SE3D_FORMULATION_ROMEGA, 1)) {
            destroy(&w);
            continue;
        }
        for (int k = 0; k < 60; ++k) {
            double v[3], p[4], omega[3];
            const double h = 0.01 + 0.005 * check_random(&seed);
            if (k % 3 == 0) {
                u = check_random(&seed);
                set_input(&w, u);
            }
            t += h;
            CHECK(se3d_solver_run(w.solver, t) >= 0);
            way += h * (rate + 0.5 * h * u);
            rate += h * u;
            CHECK(!se3d_body_get_velocity(w.system, w.body, v));
            CHECK(!se3d_body_get_orientation(w.system, w.body, p));
            CHECK(!se3d_body_get_angular_velocity(w.system, w.body, omega));
            CHECK_NEAR(v[0], rate, 1e-13);
            CHECK_NEAR(omega[2], rate, 1e-13);
            CHECK_NEAR(2.0 * atan2(p[3], p[0]), way, angle);
        }
        destroy(&w);
    }
}

/* A double pendulum of a bar on a pin and a bar on a spring, a bushing and a load: everything has
 * values. */
typedef struct bars {
    se3d_system *system;
    se3d_body a, b;
    se3d_constraint pin;
    se3d_force spring, damper, bushing, stop, load;
} bars;

static void add_elements(bars *w, se3d_body ground)
{
    se3d_tsda_def spring = se3d_tsda_def_default();
    spring.name = "spring";
    spring.body_i = ground;
    spring.body_j = w->b;
    spring.point_i[0] = 2.5;
    spring.k = 40.0;
    spring.c = 0.5;
    spring.l0 = 1.0;
    CHECK(!se3d_force_create_tsda(w->system, &spring, &w->spring));
    se3d_rsda_def damper = se3d_rsda_def_default();
    damper.joint = w->pin;
    damper.k = 3.0;
    damper.c = 0.2;
    CHECK(!se3d_force_create_rsda(w->system, &damper, &w->damper));
    se3d_bushing_def bushing = se3d_bushing_def_default();
    bushing.body_i = w->a;
    bushing.body_j = w->b;
    bushing.point_i[0] = 0.5;
    bushing.point_j[0] = -0.5;
    for (int k = 0; k < 6; ++k) {
        bushing.K[7 * k] = k < 3 ? 2000.0 : 30.0;
        bushing.C[7 * k] = k < 3 ? 20.0 : 0.3;
    }
    CHECK(!se3d_force_create_bushing(w->system, &bushing, &w->bushing));
    se3d_stop_def stop = se3d_stop_def_default();
    stop.joint = w->pin;
    stop.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    stop.upper = -0.01; /* it has been passed */
    stop.k = 50.0;
    CHECK(!se3d_force_create_stop(w->system, &stop, &w->stop));
    se3d_load_def load = se3d_load_def_default();
    load.body = w->b;
    load.point[0] = 0.5;
    load.value[2] = 1.0;
    load.in_body_frame = 1;
    CHECK(!se3d_force_create_load(w->system, &load, &w->load));
}

static void make_bars(bars *w)
{
    se3d_body ground;
    se3d_body_def body = se3d_body_def_default();
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &ground));
    body.mass = 1.0;
    body.inertia[0] = 0.01;
    body.inertia[1] = body.inertia[2] = 0.1;
    body.position[0] = 0.5;
    CHECK(!se3d_body_create(w->system, &body, &w->a));
    body.position[0] = 1.5;
    body.velocity[1] = 0.3;
    CHECK(!se3d_body_create(w->system, &body, &w->b));
    w->pin = part_hinge(w->system, NULL, w->a, -0.5);
    add_elements(w, ground);
}

#define CHANGES 14

/* The k-th of all values that there are. */
static void change(const bars *w, se3d_system *system, int k, double u)
{
    static const struct {
        int32_t parameter;
        int32_t is_stop;
        double value;
    } table[] = {{SE3D_FORCE_PARAMETER_K, 0, 90.0},      {SE3D_FORCE_PARAMETER_C, 0, 3.0},
                 {SE3D_FORCE_PARAMETER_REST, 0, 1.2},    {SE3D_FORCE_PARAMETER_PRELOAD, 0, 5.0},
                 {SE3D_FORCE_PARAMETER_K, 1, 500.0},     {SE3D_FORCE_PARAMETER_UPPER, 1, -0.02},
                 {SE3D_FORCE_PARAMETER_LOWER, 1, -100.0}};
    const double inertia[6] = {0.01 * u, 0.1 * u, 0.1 * u, 0.0, 0.0, 0.0};
    const double g[3] = {1.0, 2.0 * u, -9.0 * u}, value[3] = {u, 2.0, 3.0 * u};
    double K[36], C[36];
    if (k < 7) {
        CHECK(!se3d_force_set_parameter(system, table[k].is_stop ? w->stop : w->spring,
                                        table[k].parameter, table[k].value * u));
    } else if (k < 11) {
        CHECK(
            !se3d_force_set_parameter(system, w->damper, SE3D_FORCE_PARAMETER_K + k - 7, 2.0 * u));
    } else if (k == 11) {
        CHECK(!se3d_force_get_bushing(system, w->bushing, K, C));
        K[14] *= u;
        C[14] *= u;
        CHECK(!se3d_force_set_bushing(system, w->bushing, K, C));
    } else if (k == 12) {
        CHECK(!se3d_system_set_gravity(system, g));
        CHECK(!se3d_force_set_value(system, w->load, value));
    } else {
        CHECK(!se3d_body_set_mass(system, w->b, u, inertia));
    }
}

static void get_numbers(const bars *w, const se3d_system *system, double x[24])
{
    const se3d_body both[2] = {w->a, w->b};
    for (int k = 0; k < 2; ++k) {
        double *y = x + 12 * k;
        CHECK(!se3d_body_get_velocity(system, both[k], y));
        CHECK(!se3d_body_get_angular_velocity(system, both[k], y + 3));
        CHECK(!se3d_body_get_acceleration(system, both[k], y + 6));
        CHECK(!se3d_body_get_angular_acceleration(system, both[k], y + 9));
    }
}

static void compare(const bars *w, const se3d_system *twin, int count, double tolerance)
{
    double x[24], y[24];
    get_numbers(w, w->system, x);
    get_numbers(w, twin, y);
    for (int k = 0; k < 24; ++k) {
        if (k % 12 < count) {
            CHECK_NEAR(x[k], y[k], tolerance * (1.0 + fabs(y[k])));
        }
    }
}

/* After a change the accelerations of run(now) are those of another method that begins there, and
 * the next step is the right one, to the method's own error of one step. */
static void change_and_compare(const bars *w, se3d_solver *solver, const se3d_solver_def *def,
                               int k, double u)
{
    double t;
    se3d_system *twin = NULL, *now = NULL;
    se3d_solver *exact = NULL, *same = NULL;
    se3d_solver_def other = se3d_solver_def_default();
    other.method = SE3D_METHOD_RK45;
    other.tolerance = 1e-11;
    change(w, w->system, k, u);
    CHECK(!se3d_system_clone(w->system, &twin));
    CHECK(!se3d_system_clone(w->system, &now));
    CHECK(!se3d_system_get_time(w->system, &t));
    CHECK(!se3d_solver_create(twin, &other, &exact));
    CHECK(se3d_solver_run(exact, t) >= 0);
    CHECK(!se3d_solver_create(now, def, &same));
    CHECK(se3d_solver_run(same, t) >= 0);
    const bars there = {.system = now, .a = w->a, .b = w->b};
    compare(&there, twin, 12, 1e-7);
    CHECK(se3d_solver_step(exact, SHORT) >= 0);
    CHECK(se3d_solver_step(solver, SHORT) >= 0);
    compare(w, twin, 6, def->method == SE3D_METHOD_CONVEX ? 2e-5 : 5e-6); /* of order 1 */
    se3d_solver_destroy(exact);
    se3d_solver_destroy(same);
    se3d_system_destroy(twin);
    se3d_system_destroy(now);
}

static void all_values_act_from_the_next_step_on(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int32_t formulation = 0; formulation < 3; ++formulation) {
            bars w;
            se3d_solver *solver = NULL;
            se3d_solver_def def = se3d_solver_def_default();
            const int before = check_failures;
            make_bars(&w);
            def.method = method;
            def.formulation = formulation;
            def.tolerance = 1e-8;
            def.step = SHORT;
            CHECK(!se3d_solver_create(w.system, &def, &solver));
            for (int k = 0; k < CHANGES && check_failures == before; ++k) {
                for (int n = 0; n < 4; ++n) {
                    CHECK(se3d_solver_step(solver, SHORT) >= 0);
                }
                change_and_compare(&w, solver, &def, k, 1.3);
                change_and_compare(&w, solver, &def, k, 1.0);
                if (check_failures > before) {
                    fprintf(stderr, "  %s, formulation %d, change %d\n",
                            se3d_method_get_name(method), (int)formulation, k);
                }
            }
            se3d_solver_destroy(solver);
            se3d_system_destroy(w.system);
        }
    }
}

/* A driver and a primitive without a function: the state follows, and rests there. */
static void prescribed_values_are_met_from_the_next_step_on(void)
{
    for (int k = 0; k < 4 * method_count(); ++k) {
        world w = {.kind = INPUT_LOAD};
        const int by_function = k % 2, by_run = k / 2 % 2;
        se3d_constraint driver;
        se3d_driver_def def = se3d_driver_def_default();
        se3d_solver_def solver = se3d_solver_def_default();
        CHECK(make(&w, INPUT_PRELOAD, k / 4, SE3D_FORMULATION_ROMEGA, by_run));
        se3d_function_def constant = se3d_function_def_default();
        CHECK(!se3d_function_create(w.system, &constant, &w.function));
        def.joint = w.pin;
        def.function = by_function ? w.function : def.function;
        CHECK(!se3d_driver_create(w.system, &def, &driver));
        for (int n = 1; n <= 5; ++n) {
            const double wanted = 0.1 * n * n;
            double t, angle, rate, effort;
            CHECK(!(by_function ? se3d_function_set_constant(w.system, w.function, wanted)
                                : se3d_constraint_set_value(w.system, driver, wanted)));
            CHECK(!se3d_force_set_parameter(w.system, w.torque, SE3D_FORCE_PARAMETER_PRELOAD,
                                            2.0 * n));
            CHECK(!se3d_system_get_time(w.system, &t));
            CHECK((by_run ? se3d_solver_run(w.solver, t + H) : se3d_solver_step(w.solver, H)) >= 0);
            CHECK(!se3d_joint_get_coordinate(w.system, w.pin, SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                             &rate, NULL));
            CHECK(!se3d_driver_get_effort(w.system, driver, &effort));
            CHECK_NEAR(angle, wanted, 1e-12);
            CHECK_NEAR(rate, 0.0, 1e-12);
            CHECK_NEAR(effort, 2.0 * n, 1e-7);
        }
        solver.analysis = by_run ? SE3D_ANALYSIS_KINEMATICS : SE3D_ANALYSIS_INVERSE_DYNAMICS;
        se3d_solver_destroy(w.solver);
        CHECK(!se3d_solver_create(w.system, &solver, &w.solver));
        for (int n = 1; n <= 3; ++n) {
            double t, angle;
            CHECK(!se3d_system_get_time(w.system, &t));
            CHECK(!(by_function ? se3d_function_set_constant(w.system, w.function, -0.3 * n)
                                : se3d_constraint_set_value(w.system, driver, -0.3 * n)));
            CHECK(!se3d_solver_run(w.solver, n < 3 ? t + 0.1 : t));
            CHECK(!se3d_joint_get_coordinate(w.system, w.pin, SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                             NULL, NULL));
            CHECK_NEAR(angle, -0.3 * n, 1e-12);
        }
        destroy(&w);
    }
}

/* A ball and a particle on a plane, pressed in by 1e-4 m, without gravity. */
static void materials_act_from_the_next_step_on(void)
{
    const double none[3] = {0.0, 0.0, 0.0}, depth = 1e-4, k0 = 1e4,
                 mass = 4.0 / 3.0 * 3.14159265358979324;
    for (int particle = 0; particle < 2; ++particle) {
        for (int pair = 0; pair < 2; ++pair) {
            se3d_system *system = NULL;
            se3d_solver *solver = NULL;
            se3d_particles *set = NULL;
            se3d_material material;
            se3d_body ball;
            se3d_shape shape;
            double x[3] = {0.0, 0.0, 1.0 - depth}, v[3], radius = 1.0;
            CHECK(!se3d_system_create(NULL, &system));
            CHECK(!se3d_system_set_gravity(system, none));
            se3d_material_def def = se3d_material_def_default();
            def.density = 1.0;
            def.stiffness = k0;
            def.restitution = 1.0;
            CHECK(!se3d_material_create(system, &def, &material));
            se3d_shape_def plane = se3d_shape_def_default();
            plane.material = material;
            CHECK(!se3d_shape_create_plane(system, &plane, &shape));
            if (particle) {
                se3d_particles_def make_set = se3d_particles_def_default();
                CHECK(!se3d_particles_create(system, &make_set, &set));
                CHECK(!se3d_particles_add(set, material, 1, x, &radius, NULL, NULL, NULL));
            } else {
                se3d_body_def body = se3d_body_def_default();
                body.mass = mass;
                body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.4 * mass;
                body.position[2] = x[2];
                CHECK(!se3d_body_create(system, &body, &ball));
                plane.body = ball;
                plane.radius = 1.0;
                CHECK(!se3d_shape_create_sphere(system, &plane, &shape));
            }
            se3d_solver_def verlet = se3d_solver_def_default();
            verlet.method = SE3D_METHOD_VERLET;
            CHECK(!se3d_solver_create(system, &verlet, &solver));
            double z = x[2], speed = 0.0, k = k0;
            const double h = 1e-5;
            for (int n = 0; n < 20; ++n) {
                se3d_material_pair_def both = se3d_material_pair_def_default();
                k = k0 * (1.0 + 0.5 * (n % 3));
                both.stiffness = def.stiffness = k;
                CHECK(!(pair ? se3d_material_set_pair(system, material, material, &both)
                             : se3d_material_set(system, material, &def)));
                CHECK(se3d_solver_step(solver, h) >= 0);
                const double a0 = k * (1.0 - z) / mass;
                z += h * speed + 0.5 * h * h * a0;
                speed += 0.5 * h * (a0 + k * (1.0 - z) / mass);
                if (particle) {
                    CHECK(!se3d_particles_get_all(set, 1, x, v, NULL));
                } else {
                    CHECK(!se3d_body_get_position(system, ball, x));
                    CHECK(!se3d_body_get_velocity(system, ball, v));
                }
                CHECK_NEAR(x[2], z, 1e-15);
                CHECK_NEAR(v[2], speed, 1e-15);
            }
            se3d_solver_destroy(solver);
            se3d_system_destroy(system);
        }
    }
}

/* A snapshot of a clone on which other loads act: those of the system that it is restored on act
 * from its very start. */
static void states_of_a_clone_go_on_under_the_loads_of_the_system(void)
{
    static const double weak[3] = {0.0, 0.0, -1.0}, strong[3] = {0.0, 0.0, -20.0};
    for (int32_t method = 0; method < method_count(); ++method) {
        se3d_system *from = NULL, *to = NULL;
        se3d_snapshot *state = NULL;
        se3d_solver *solver[2] = {NULL, NULL};
        se3d_solver_def def = se3d_solver_def_default();
        se3d_body_def stuff = se3d_body_def_default();
        se3d_body body = {0, 0};
        double before[3], after[3];
        stuff.mass = stuff.inertia[0] = stuff.inertia[1] = stuff.inertia[2] = 1.0;
        def.method = method;
        CHECK(!se3d_system_create(NULL, &from) && !se3d_body_create(from, &stuff, &body));
        CHECK(!se3d_solver_create(from, &def, &solver[0]) && !se3d_solver_run(solver[0], 0.1));
        CHECK(!se3d_system_clone(from, &to));
        CHECK(!se3d_system_set_gravity(from, weak) && !se3d_system_set_gravity(to, strong));
        CHECK(!se3d_solver_run(solver[0], 0.2) && !se3d_snapshot_create(from, &state));
        CHECK(!se3d_snapshot_restore(state, to) && !se3d_solver_create(to, &def, &solver[1]));
        CHECK(!se3d_body_get_velocity(to, body, before) && !se3d_solver_run(solver[1], 0.3));
        CHECK(!se3d_body_get_velocity(to, body, after));
        CHECK_NEAR(after[2] - before[2], -2.0, 1e-12);
        for (int k = 0; k < 2; ++k) {
            se3d_solver_destroy(solver[k]);
        }
        se3d_snapshot_destroy(state);
        se3d_system_destroy(from);
        se3d_system_destroy(to);
    }
}

int main(void)
{
    RUN(prescribed_values_are_met_from_the_next_step_on);
    RUN(materials_act_from_the_next_step_on);
    RUN(all_values_act_from_the_next_step_on);
    RUN(held_inputs_are_exact_in_every_method);
    RUN(states_of_a_clone_go_on_under_the_loads_of_the_system);
    RUN(inputs_may_be_set_within_a_step_made_ahead);
    return check_finish();
}
