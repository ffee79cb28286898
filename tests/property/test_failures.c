/* SPDX-License-Identifier: BSD-3-Clause */
/* A callback that fails at any of its calls: the state is that of the last accepted step, to the
 * bit, and the run goes on from it as if nothing had happened. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/ball_on_floor.h"
#include "support/methods.h"
#include "support/parts.h"

/* Counts the calls of all callbacks, and fails at one of them, or from it on; or what it writes is
 * not finite. */
static long calls, fails_at;
static int for_ever, spoils;
static double call_end; /* of the call under way [s] */
static int is_beyond;   /* the failure was at a time after it */

/* `t`: what is asked for; of a state 0. */
static se3d_status may_fail(double t, double *value)
{
    ++calls;
    if (!(fails_at > 0 && (calls == fails_at || (for_ever && calls > fails_at)))) {
        return SE3D_OK;
    }
    if (spoils) {
        *value = (double)NAN;
    }
    is_beyond = t > call_end;
    return spoils ? SE3D_OK : SE3D_ERR_CALLBACK;
}

static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    (void)ctx, (void)motion, (void)K, (void)D;
    wrench[6] = 0.3 * sin(3.0 * t);
    wrench[8] = 0.5;
    return may_fail(t, &wrench[6]);
}

static se3d_status store(void *ctx, double t, const se3d_body_motion motion[2], double *potential,
                         double *dissipated)
{
    (void)ctx, (void)motion;
    *dissipated = 0.0;
    *potential = 0.25;
    return may_fail(t, potential);
}

static se3d_status wave(void *ctx, const double *x, double jet[3], double *gradient)
{
    (void)ctx;
    jet[0] = 0.2 * sin(2.0 * x[0]);
    jet[1] = 0.4 * cos(2.0 * x[0]);
    jet[2] = -0.8 * sin(2.0 * x[0]);
    if (gradient) {
        gradient[0] = jet[1];
    }
    return may_fail(x[0], &jet[0]);
}

/* z of the second body is that of the ground. */
static se3d_status level(void *ctx, double t, const se3d_body_motion *bodies, double *phi,
                         double *jacobian, double *nu, double *gamma)
{
    (void)ctx;
    if (phi) {
        phi[0] = bodies[0].r[1];
    }
    if (jacobian) {
        jacobian[1] = 1.0;
    }
    return may_fail(t, phi ? phi : jacobian ? jacobian : nu ? nu : gamma);
}

/* Which callbacks there are, and what has a memory. */
enum {
    SCENE_FORCE,
    SCENE_DRIVER,
    SCENE_CONSTRAINT,
    SCENE_MEMORY,
    SCENE_CONTACT,
    SCENE_EVENT,
    SCENES,         /* of dynamics */
    SCENE_DRIVEN,   /* the bar alone, its motion determined */
    SCENE_PARTICLES /* particles on the bar, for verlet */
};

typedef struct world {
    se3d_system *system;
    se3d_solver *solver;
    se3d_body a, b;
    se3d_constraint pin;
    se3d_particles *particles; /* NULL: none */
} world;

static void add_push(const world *w, se3d_body ground)
{
    se3d_force_callback_def force = se3d_force_callback_def_default();
    se3d_force made;
    force.body_i = ground;
    force.body_j = w->b;
    force.callback = push;
    force.energy = store;
    CHECK(!se3d_force_create_callback(w->system, &force, &made));
}

static void add_driver(const world *w)
{
    se3d_function_def function = se3d_function_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    se3d_constraint made;
    function.callback = wave;
    CHECK(!se3d_function_create(w->system, &function, &driver.function));
    driver.joint = w->pin;
    CHECK(!se3d_driver_create(w->system, &driver, &made));
}

static void add_level(const world *w)
{
    se3d_user_constraint_def user = se3d_user_constraint_def_default();
    se3d_constraint made;
    user.callback = level;
    user.bodies[0] = w->b;
    CHECK(!se3d_user_constraint_create(w->system, &user, &made));
}

static void add_memories(const world *w)
{
    se3d_friction_def friction = se3d_friction_def_default();
    se3d_stop_def stop = se3d_stop_def_default();
    se3d_force made;
    friction.joint = w->pin;
    friction.mu = 0.1;
    friction.radius = 0.01;
    friction.presliding = 1e-4;
    CHECK(!se3d_force_create_friction(w->system, &friction, &made));
    stop.joint = w->pin;
    stop.upper = 0.1;
    stop.k = 100.0;
    stop.restitution = 0.8;
    CHECK(!se3d_force_create_stop(w->system, &stop, &made));
}

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    const world *w = ctx;
    double r[3];
    CHECK(!se3d_body_get_position(system, w->b, r));
    *value = r[2];
    return may_fail(0.0, value);
}

static void add_event(world *w)
{
    se3d_event_def event = se3d_event_def_default();
    se3d_event made;
    event.value = get_height;
    event.ctx = w;
    event.level = -0.02;
    CHECK(!se3d_event_create(w->solver, &event, &made));
}

/* A floor under the second body, which it meets in the run. */
static void add_floor(const world *w)
{
    add_sphere_on(w->system, w->b, add_floor_of(w->system, 1.0, 1e4, -0.3), 0.2);
}

/* Particles in two layers on the bar, which they leave in the run, and a mesh beside it. */
static void add_particles(world *w)
{
    static const double corners[9] = {0.0, -1.0, -0.06, 2.0, -1.0, -0.06, 1.0, 2.0, -0.06};
    static const uint32_t corner[3] = {0, 1, 2};
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_particles_def def = se3d_particles_def_default();
    se3d_shape made;
    double r[20][3], radii[20];
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    stuff.rolling_friction = 0.1;
    CHECK(!se3d_material_create(w->system, &stuff, &shape.material));
    shape.vertices = corners;
    shape.vertex_count = 3;
    shape.triangles = corner;
    shape.triangle_count = 1;
    CHECK(!se3d_shape_create_mesh(w->system, &shape, &made));
    shape.body = w->a;
    shape.size[0] = 1.0;
    shape.size[1] = 0.2;
    shape.size[2] = 0.1;
    CHECK(!se3d_shape_create_box(w->system, &shape, &made));
    for (int k = 0; k < 20; ++k) {
        radii[k] = 0.02;
        r[k][0] = 0.3 + 0.041 * (k % 10) + 0.003 * (k / 10);
        r[k][1] = 0.0;
        r[k][2] = 0.0699 + 0.0395 * (k / 10);
    }
    CHECK(!se3d_particles_create(w->system, &def, &w->particles));
    CHECK(!se3d_particles_add(w->particles, shape.material, 20, r[0], radii, NULL, NULL, NULL));
}

/* Of a step. */
static double length_of(int scene)
{
    return scene == SCENE_PARTICLES ? 1.0 / 16384.0 : 1.0 / 256.0;
}

static int has_driver(int scene)
{
    return scene == SCENE_DRIVER || scene == SCENE_DRIVEN;
}

/* By the error; the others have a fixed one here. */
static int chooses_steps(int32_t method)
{
    return method == SE3D_METHOD_DOP853 || method == SE3D_METHOD_RK45 ||
           method == SE3D_METHOD_RK4 || method == SE3D_METHOD_GAUSS || method == SE3D_METHOD_BDF ||
           method == SE3D_METHOD_RADAU;
}

static void add_solver(world *w, int scene, int32_t analysis, int32_t method)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.method = method;
    def.tolerance = 1e-5;
    def.step =
        (method != SE3D_METHOD_AUTO && !chooses_steps(method)) || analysis != SE3D_ANALYSIS_DYNAMICS
            ? length_of(scene)
            : 0.0;
    CHECK(!se3d_solver_create(w->system, &def, &w->solver));
    if (scene == SCENE_EVENT) {
        add_event(w);
    }
}

/* A bar on a pin, and a body on a spring at its end. */
static void make(world *w, int scene, int32_t analysis, int32_t method)
{
    se3d_body ground;
    se3d_body_def body = se3d_body_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force made;
    calls = fails_at = 0;
    for_ever = spoils = 0;
    w->particles = NULL;
    CHECK(!se3d_system_create(NULL, &w->system));
    CHECK(!se3d_system_get_ground(w->system, &ground));
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.position[0] = 0.5;
    CHECK(!se3d_body_create(w->system, &body, &w->a));
    body.position[0] = 1.25;
    w->b = w->a;
    if (scene != SCENE_DRIVEN) {
        CHECK(!se3d_body_create(w->system, &body, &w->b));
    }
    w->pin = part_hinge(w->system, NULL, w->a, -0.5);
    spring.body_i = scene == SCENE_DRIVEN ? ground : w->a;
    spring.body_j = w->b;
    spring.point_i[0] = 0.5;
    spring.point_i[2] = scene == SCENE_DRIVEN ? 1.0 : 0.0;
    spring.k = 30.0;
    spring.c = 0.5;
    spring.l0 = 0.25;
    CHECK(!se3d_force_create_tsda(w->system, &spring, &made));
    if (has_driver(scene)) {
        add_driver(w);
    }
    if (scene == SCENE_DRIVER) {
        ; /* no other callbacks */
    } else if (scene == SCENE_CONSTRAINT) {
        add_level(w);
    } else {
        add_push(w, ground);
    }
    if (scene == SCENE_MEMORY) {
        add_memories(w);
    } else if (scene == SCENE_CONTACT) {
        add_floor(w);
    } else if (scene == SCENE_PARTICLES) {
        add_particles(w);
    }
    add_solver(w, scene, analysis, method);
}

static void destroy(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_particles_destroy(w->particles);
    se3d_system_destroy(w->system);
}

/* The calls of a short run: a time to run to, or a step. */
#define CALLS 5
static const double ends[CALLS] = {0.0, 0.0625, 0.0, 0.125, 0.1484375};

static double end_of(const world *w, int k)
{
    return w->particles ? 0.25 * ends[k] : ends[k];
}

/* Of bodies and particles. */
static uint64_t hash_of(const world *w)
{
    const uint64_t bodies = se3d_system_hash(w->system);
    return w->particles ? 31 * bodies + se3d_particles_hash(w->particles) : bodies;
}

/* The k-th call is to be made again, or to go on, where it has come to t. */
static int is_to_do(const world *w, int k, double t)
{
    return k == 0 || k == 2 || t < end_of(w, k);
}

static double time_of(const world *w)
{
    double t = -1.0;
    CHECK(!se3d_system_get_time(w->system, &t));
    return t;
}

static se3d_status call(const world *w, int k)
{
    const double h = length_of(w->particles ? SCENE_PARTICLES : SCENE_FORCE);
    call_end = k == 2 ? time_of(w) + h : end_of(w, k);
    return k == 2 ? se3d_solver_step(w->solver, h) : se3d_solver_run(w->solver, end_of(w, k));
}

typedef struct undisturbed {
    uint64_t hash[2]; /* at t and at the end */
    double height;    /* of the second body, at t */
} undisturbed;

static double height_of(const world *w)
{
    double r[3];
    CHECK(!se3d_body_get_position(w->system, w->b, r));
    return r[2];
}

/* Near contacts steps end where runs do: a run to t has other ones. */
static int is_cut(int scene, int32_t analysis, int32_t method)
{
    return scene == SCENE_CONTACT && analysis == SE3D_ANALYSIS_DYNAMICS &&
           (method == SE3D_METHOD_AUTO || chooses_steps(method));
}

/* An undisturbed run of the same calls before the k-th, to t, and then on. */
static undisturbed run_undisturbed(int scene, int32_t analysis, int32_t method, int k, double t)
{
    world w;
    undisturbed u;
    make(&w, scene, analysis, method);
    for (int n = 0; n < k; ++n) {
        CHECK(call(&w, n) >= 0);
    }
    if (t > time_of(&w)) {
        CHECK(se3d_solver_run(w.solver, t) >= 0);
    }
    u.hash[0] = hash_of(&w);
    u.height = height_of(&w);
    for (int n = k; n < CALLS; ++n) {
        if (n != k || is_to_do(&w, n, t)) {
            CHECK(call(&w, n) >= 0);
        }
    }
    u.hash[1] = hash_of(&w);
    destroy(&w);
    return u;
}

/* What a clone of the system comes to with a solver of its own by the k-th call. */
static uint64_t run_clone(const world *w, int scene, int32_t analysis, int32_t method, int k)
{
    world other = *w;
    CHECK(!se3d_system_clone(w->system, &other.system));
    add_solver(&other, scene, analysis, method);
    CHECK(call(&other, k) >= 0);
    const uint64_t hash = hash_of(&other);
    se3d_solver_destroy(other.solver);
    se3d_system_destroy(other.system);
    return hash;
}

/* The run with a failure at call n of a callback; the number of calls that have failed. */
static int run_with_failure(int scene, int32_t analysis, int32_t method, long n, int ever)
{
    world w;
    int failures = 0;
    undisturbed u = {{0, 0}, 0.0};
    const int compares = !is_cut(scene, analysis, method);
    make(&w, scene, analysis, method);
    fails_at = n;
    for_ever = ever;
    is_beyond = 0;
    for (int k = 0; k < CALLS; ++k) {
        if (call(&w, k) >= 0) {
            continue;
        }
        ++failures;
        const double t = time_of(&w);
        const uint64_t here = hash_of(&w);
        CHECK(se3d_system_get_error_status(w.system) == SE3D_ERR_CALLBACK);
        fails_at = 0;
        u = run_undisturbed(scene, analysis, method, k, t);
        CHECK_NEAR(height_of(&w), u.height, compares ? 0.0 : 1e-6);
        CHECK(!compares || here == u.hash[0]);
        fails_at = 0;
        if (is_to_do(&w, k, t)) {
            const int clones = !w.particles; /* they are the system's own, and not in hash_of */
            const uint64_t clone = clones ? run_clone(&w, scene, analysis, method, k) : 0;
            CHECK(call(&w, k) >= 0);
            CHECK(!clones || hash_of(&w) == clone);
        }
    }
    CHECK(failures == 0 || !compares || hash_of(&w) == u.hash[1]);
    destroy(&w);
    return failures;
}

static void fail_everywhere(int scene, int32_t analysis, int32_t method)
{
    world w;
    int failed = 0;
    const int before = check_failures;
    make(&w, scene, analysis, method);
    for (int k = 0; k < CALLS; ++k) {
        CHECK(call(&w, k) >= 0);
    }
    const long count = calls;
    destroy(&w);
    const long tries = check_is_long() ? 200 : 6;
    const long stride = count / tries + 1; /* not a divisor of the calls of a step */
    for (long n = 1; n <= count; n += stride) {
        for (int ever = 0; ever < 2 && check_failures == before; ++ever) {
            const int failures = run_with_failure(scene, analysis, method, n, ever);
            /* also if the same call would be well the next time; but prescribed values are looked
             * at ahead, too, and no step has to go past the end of a call */
            CHECK(failures == 1 || (!ever && failures == 0 && (has_driver(scene) || is_beyond)));
            failed += failures;
            if (check_failures > before) {
                fprintf(stderr, "  %s, scene %d, analysis %d, call %ld of %ld %s\n",
                        se3d_method_get_name(method), scene, (int)analysis, n, count,
                        ever ? "on" : "");
            }
        }
    }
    CHECK(failed > 0);
}

static void a_failure_leaves_the_last_accepted_step_in_every_method(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int scene = 0; scene < SCENES; ++scene) {
            fail_everywhere(scene, SE3D_ANALYSIS_DYNAMICS, method);
        }
    }
}

/* The calls until one fails, with a number that is not finite at call n of a callback; how many
 * went well although one was met. A message is that of a call that failed. */
static int run_with_spoilt(int scene, int32_t method, long n)
{
    world w;
    int mended = 0;
    make(&w, scene, SE3D_ANALYSIS_DYNAMICS, method);
    fails_at = n;
    spoils = 1;
    for (int k = 0; k < CALLS; ++k) {
        const long before = calls;
        const se3d_status status = call(&w, k);
        CHECK(status >= 0 || status == SE3D_ERR_NOT_FINITE || status == SE3D_ERR_STEP_SIZE ||
              status == SE3D_ERR_NO_CONVERGENCE);
        CHECK((se3d_system_get_error_status(w.system) < 0) == (status < 0));
        CHECK((se3d_system_get_error(w.system)[0] != '\0') == (status < 0));
        if (status < 0) {
            break;
        }
        mended += before < n && n <= calls;
    }
    destroy(&w);
    return mended;
}

static void a_call_that_went_well_leaves_no_message(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        int mended = 0;
        for (int scene = 0; scene < SCENES; ++scene) {
            for (long n = 11; n < 400; n += 67) {
                if (method != SE3D_METHOD_CONVEX || scene != SCENE_MEMORY) {
                    mended += run_with_spoilt(scene, method, n);
                }
            }
        }
        CHECK(!chooses_steps(method) || mended > 5);
    }
}

static void particles_come_back_with_the_bodies(void)
{
    fail_everywhere(SCENE_PARTICLES, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_VERLET);
}

static void so_it_does_in_every_analysis(void)
{
    static const int32_t analyses[] = {SE3D_ANALYSIS_ASSEMBLY, SE3D_ANALYSIS_KINEMATICS,
                                       SE3D_ANALYSIS_INVERSE_DYNAMICS};
    for (size_t k = 0; k < sizeof analyses / sizeof analyses[0]; ++k) {
        fail_everywhere(SCENE_DRIVEN, analyses[k], SE3D_METHOD_AUTO);
    }
}

/* The bar on its pin, held by the spring and pushed, comes to rest: what fails on the way leaves
 * the position that it began at. */
static void so_it_does_on_the_way_to_an_equilibrium(void)
{
    for (int scene = 0; scene < SCENES; ++scene) {
        if (scene != SCENE_DRIVER && scene != SCENE_EVENT) { /* the first is driven */
            fail_everywhere(scene, SE3D_ANALYSIS_EQUILIBRIUM, SE3D_METHOD_AUTO);
        }
    }
}

/* What a change of values does is work of actuators. If a callback fails before or after it, it
 * is not known: the audit begins anew there. */
static void the_audit_closes_over_a_change_of_values_or_begins_anew(void)
{
    static const double gravity[3] = {0.0, 0.0, -3.0};
    for (int run = 0; run < 3 * method_count(); ++run) {
        const int failing = run / method_count(); /* evaluation of the energy; 0: none */
        world w;
        se3d_work work;
        make(&w, SCENE_FORCE, SE3D_ANALYSIS_DYNAMICS, run % method_count());
        CHECK(se3d_solver_run(w.solver, 0.0625) >= 0);
        double before = part_balance(w.system);
        fails_at = failing > 0 ? calls + failing : 0;
        CHECK(!se3d_system_set_gravity(w.system, gravity));
        fails_at = 0;
        CHECK(!se3d_system_get_work(w.system, &work));
        CHECK((fabs(work.actuators) > 0.0) == (failing == 0));
        before = failing > 0 ? part_balance(w.system) : before;
        CHECK_NEAR(part_balance(w.system), before, 1e-12);
        CHECK(se3d_solver_run(w.solver, 0.125) >= 0);
        CHECK_NEAR(part_balance(w.system), before, 1e-4);
        destroy(&w);
    }
}

/* Methods that step ahead have a step under the old loads: it is not gone on in. */
static void a_failure_after_a_change_of_loads_stays_where_they_changed(void)
{
    static const double gravity[3] = {0.0, 0.0, -3.0};
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int with_event = 0; with_event < 2; ++with_event) {
            world w;
            make(&w, with_event ? SCENE_EVENT : SCENE_FORCE, SE3D_ANALYSIS_DYNAMICS, method);
            CHECK(se3d_solver_run(w.solver, 0.0625) >= 0);
            CHECK(!se3d_system_set_gravity(w.system, gravity));
            const uint64_t hash = se3d_system_hash(w.system);
            fails_at = calls + 1;
            CHECK(se3d_solver_run(w.solver, 0.5) == SE3D_ERR_CALLBACK);
            CHECK(!(time_of(&w) > 0.0625));
            CHECK(se3d_system_hash(w.system) == hash);
            fails_at = 0;
            CHECK(se3d_solver_run(w.solver, 0.5) >= 0);
            destroy(&w);
        }
    }
}

int main(void)
{
    RUN(a_call_that_went_well_leaves_no_message);
    RUN(particles_come_back_with_the_bodies);
    RUN(so_it_does_in_every_analysis);
    RUN(so_it_does_on_the_way_to_an_equilibrium);
    RUN(the_audit_closes_over_a_change_of_values_or_begins_anew);
    RUN(a_failure_after_a_change_of_loads_stays_where_they_changed);
    RUN(a_failure_leaves_the_last_accepted_step_in_every_method);
    return check_finish();
}
