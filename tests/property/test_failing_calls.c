/* SPDX-License-Identifier: BSD-3-Clause */
/* Whatever function of the library fails within an analysis, once on each path of calls: the
 * analysis goes on by other means, or the state is the last good one, from which it goes on to
 * where it had come without the failure. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"
#include "support/analyses.h"
#include "support/call_paths.h"
#include "support/counting.h"
#include "support/models.h"
#include "support/refusals.h"

static se3d_status failure; /* of the call that fails */
static int is_running;
static const char *failing;

/* What is left of a solution decides whether se3di_kkt_solve fails where it does not converge. */
se3d_status support_refusal(const char *function, se3d_status documented)
{
    const int is_solution = strcmp(function, "se3di_kkt_solve") == 0;
    (void)documented;
    if (!is_running || !is_refused()) {
        return SE3D_OK;
    }
    failing = function;
    return is_solution && failure == SE3D_ERR_NO_CONVERGENCE ? SE3D_ERR_NOT_FINITE : failure;
}

typedef struct pose {
    double r[3];
} pose;

enum { BODIES = 16 };

/* What is run: a mechanism of support/models.h, or a model file. */
typedef struct scene {
    const support_analysis *row;
    const char *text;
    int32_t method;
    double step, t_end;
} scene;

typedef struct world {
    support_counting counting;
    se3d_allocator allocator;
    support_model model;
    se3d_model *file;
    se3d_system *system;
    se3d_solver *solver;
} world;

static void read_scene(world *w, const scene *s)
{
    se3d_model_error error = {0, 0, ""};
    se3d_model_options options = se3d_model_options_default();
    se3d_solver_def def = se3d_solver_def_default();
    se3d_event event;
    options.allocator = &w->allocator;
    CHECK(se3d_model_read_text(s->text, strlen(s->text), "scene.yaml", &options, &w->file,
                               &error) == SE3D_OK);
    w->system = se3d_model_get_system(w->file);
    CHECK(se3d_model_get_solver(w->file, 0, &def) == SE3D_OK);
    def.method = s->method;
    def.step = s->step;
    CHECK(se3d_solver_create(w->system, &def, &w->solver) == SE3D_OK);
    se3d_event_def watch = se3d_event_def_default();
    watch.level = 0.01; /* the ball has been lower */
    CHECK(se3d_model_create_event(w->file, w->solver, "ball.velocity.z", &watch, &event, &error) ==
          SE3D_OK);
}

static void make_scene(world *w, const scene *s)
{
    memset(w, 0, sizeof *w);
    w->allocator = support_counting_allocator(&w->counting);
    if (s->row) {
        support_plan plan;
        support_plan_make(&plan, s->row->mechanism, s->row->count);
        CHECK(support_model_create(&w->model, &plan, &w->allocator, 0) == SE3D_OK);
        support_plan_destroy(&plan);
        w->system = w->model.system;
        CHECK(support_solver_create(w->system, s->row, SE3D_FORMULATION_ROMEGA, &w->solver) ==
              SE3D_OK);
    } else {
        read_scene(w, s);
    }
}

static void end_scene(world *w)
{
    se3d_solver_destroy(w->solver);
    support_model_destroy(&w->model);
    se3d_model_destroy(w->file);
    CHECK(w->counting.live == 0 && w->counting.bytes == 0 && w->counting.wrong == 0);
}

/* @return as the run, which went on after a failure */
static se3d_status attempt(const scene *s, size_t refused, pose poses[BODIES])
{
    world w;
    double time = 0.0;
    make_scene(&w, s);
    memset(poses, 0, BODIES * sizeof *poses);
    calls.count = calls.reached = 0;
    calls.refused = refused;
    is_running = 1;
    const se3d_status status = se3d_solver_run(w.solver, s->t_end);
    is_running = 0;
    if (status < 0) {
        CHECK(refused > 0);
        CHECK(se3d_system_get_time(w.system, &time) == SE3D_OK && time <= s->t_end);
        CHECK(se3d_solver_run(w.solver, s->t_end) >= 0);
    }
    const size_t count = se3d_system_count_bodies(w.system);
    CHECK(count <= BODIES);
    for (size_t k = 0; k < count; ++k) {
        se3d_body body;
        CHECK(se3d_system_get_body(w.system, k, &body) == SE3D_OK);
        CHECK(se3d_body_get_position(w.system, body, poses[k].r) == SE3D_OK);
    }
    end_scene(&w);
    return status;
}

static double distance(const pose *a, const pose *b)
{
    double apart = 0.0;
    for (int k = 0; k < BODIES; ++k) {
        for (int i = 0; i < 3; ++i) {
            apart = fmax(apart, fabs(a[k].r[i] - b[k].r[i]));
        }
    }
    return apart;
}

/* Each path fails in one of the three ways, or with SE3D_LONG in all.
 * @return how many calls failed, of those on paths that are new */
static size_t fail_each(const scene *s)
{
    static size_t chosen[CALLS];
    static pose whole[BODIES], poses[BODIES];
    calls.looks = 1;
    calls.fresh_count = 0;
    CHECK(attempt(s, 0, whole) >= 0);
    calls.looks = 0;
    const size_t count = calls.fresh_count, turn = check_is_long() ? 1 : 3;
    const size_t first = failure == SE3D_ERR_NO_MEMORY ? 0 : failure == SE3D_ERR_NOT_FINITE ? 1 : 2;
    memcpy(chosen, calls.fresh, count * sizeof *chosen);
    for (size_t k = first % turn; k < count; k += turn) {
        const int before = check_failures;
        const se3d_status status = attempt(s, chosen[k], poses);
        CHECK(calls.reached == 1);
        /* other steps */
        CHECK_NEAR(distance(poses, whole), 0.0, s->method == SE3D_METHOD_CONVEX ? 1e-3 : 1e-4);
        if (check_failures > before) {
            fprintf(stderr, "%s, method %d, %s failed by %d: %d\n",
                    s->row ? s->row->mechanism : "scene", (int)s->method, failing, (int)failure,
                    (int)status);
        }
    }
    return count;
}

#define BALL_OF(more)                                                                              \
    "se3d: 1\n"                                                                                    \
    "materials: [{name: m, density: 1000, stiffness: 1e5, friction: 0.3" more "}]\n"               \
    "contact: {}\n"                                                                                \
    "analysis: {type: dynamics, duration: 1}\n"                                                    \
    "bodies:\n"                                                                                    \
    "  - {name: floor, fixed: true, position: [0, 9, 0], shapes: [{type: plane, material: m}]}\n"  \
    "  - {name: ball, position: [0, 9, 0.1005], velocity: [1, 0, -0.1], shapes: [{type: sphere, "  \
    "radius: 0.1, material: m}]}\n"

#define BALL BALL_OF("")

/* The ball lands, the block comes to rest, the arm meets a stop. */
#define PARTS                                                                                      \
    BALL                                                                                           \
        "  - {name: arm, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0], "               \
        "angular_velocity: "                                                                       \
        "[0, 1, 0], velocity: [0, 0, -0.5]}\n"                                                     \
        "  - {name: block, mass: 1, inertia: [1, 1, 1], position: [0, 2, 0], velocity: [0.02, 0, " \
        "0]}\n"                                                                                    \
        "joints:\n"                                                                                \
        "  - {name: pin, type: revolute, body_i: ground, body_j: arm, at: [0, 0, 0], axis: [0, "   \
        "1, "                                                                                      \
        "0]}\n"                                                                                    \
        "  - {name: rail, type: prismatic, body_i: ground, body_j: block, at: [0, 2, 0], axis: "   \
        "[1, "                                                                                     \
        "0, 0]}\n"                                                                                 \
        "forces:\n"                                                                                \
        "  - {name: rub, type: friction, joint: rail, mu: 0.2}\n"                                  \
        "  - {name: hold, type: friction, joint: pin, mu: 0.1, radius: 0.02}\n"                    \
        "  - {name: spring, type: tsda, body_i: ground, body_j: arm, point_i: [0, 0, 1], "         \
        "point_j: "                                                                                \
        "[0.5, 0, 0], k: 50, l0: 1}\n"                                                             \
        "  - {name: end, type: stop, joint: pin, coordinate: angle, upper: 0.01, k: 1e3}\n"        \
        "  - {name: load, type: effort, joint: pin, value: sin(30*t)}\n"
#define MACHINE PARTS "states: [{name: lag, type: lag, input: pin.angle, time_constant: 0.1}]\n"

/* Rotors are a part of its mass. */
#define GEARED PARTS "  - {name: rotor, type: armature, joint: pin, inertia: 0.05}\n"

/* On a string, which is a contact of convex, as rolling is. */
#define TETHERED                                                                                   \
    BALL_OF(", rolling_friction: 0.01")                                                            \
    "forces: [{name: string, type: stop, body_i: floor, body_j: ball, upper: 0.1003, k: "          \
    "1e3}]"

static const scene scenes[] = {
    {NULL, MACHINE, SE3D_METHOD_AUTO, 0.0, 0.02},
    {NULL, MACHINE, SE3D_METHOD_RADAU, 0.0, 0.015},
    {NULL, MACHINE, SE3D_METHOD_BDF, 0.0, 0.015},
    {NULL, MACHINE, SE3D_METHOD_GENERALIZED_ALPHA, 1e-3, 0.015},
    {NULL, MACHINE, SE3D_METHOD_VERLET, 1e-4, 0.012},
    {NULL, MACHINE, SE3D_METHOD_RATTLE, 1e-4, 0.012},
    {NULL, TETHERED, SE3D_METHOD_CONVEX, 1e-3, 0.01},
    {NULL, PARTS, SE3D_METHOD_CONVEX, 1e-3, 0.012},
    {NULL, GEARED, SE3D_METHOD_CONVEX, 1e-3, 0.012},
};

static void fail_all(se3d_status how)
{
    size_t sum = 0;
    failure = how;
    calls.depth = 3;
    for (size_t k = 0; k < SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k];
        const scene s = {row, NULL, row->method, row->step, row->t_end};
        forget_paths();
        sum += fail_each(&s);
    }
    calls.depth = 2;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; ++k) {
        sum += fail_each(&scenes[k]);
    }
    CHECK(sum > 1000);
}

static void a_call_without_memory_leaves_the_last_good_state(void)
{
    fail_all(SE3D_ERR_NO_MEMORY);
}

static void a_call_that_does_not_converge_is_made_up_for_or_leaves_the_last_good_state(void)
{
    fail_all(SE3D_ERR_NO_CONVERGENCE);
}

static void a_call_that_meets_no_number_is_made_up_for_or_leaves_the_last_good_state(void)
{
    fail_all(SE3D_ERR_NOT_FINITE);
}

int main(void)
{
#ifdef SE3D_LETS_FAIL
    RUN(a_call_without_memory_leaves_the_last_good_state);
    RUN(a_call_that_does_not_converge_is_made_up_for_or_leaves_the_last_good_state);
    RUN(a_call_that_meets_no_number_is_made_up_for_or_leaves_the_last_good_state);
    return check_finish();
#else
    puts("python3 was missing for the build");
    return 0;
#endif
}
