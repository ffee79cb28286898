/* SPDX-License-Identifier: BSD-3-Clause */
/* convex with a tolerance (docs/theory/convex.md): its steps follow the error. */
#include "se3d/se3d.h"
#include "support/text_model.h"

#include <stdio.h>
#include <string.h>

#define CONTACT(material)                                                                          \
    "contact: {}\nmaterials: [{name: s, density: 1000, friction: 0.4, " material "}]\n"
#define PLANE(z) "{name: ground, shapes: [{type: plane, material: s, position: [0, 0, " z "]}]}"
#define LAST(channels, more)                                                                       \
    "analysis: {type: dynamics, duration: 2}\noutput: [{file: r.csv, channels: [" channels         \
    "]}]\n" more

#define BOX                                                                                        \
    "se3d: 1\ngravity: [0, 0, 0]\n" CONTACT(                                                       \
        "stiffness: 1.0e+5, restitution: 0.6") "bodies:\n  - " PLANE("0") "\n  - {name: a, "       \
                                                                          "density: 1000, "        \
                                                                          "position: [0, 0, "      \
                                                                          "0.2], velocity: [0.7, " \
                                                                          "0.2, -1], "             \
                                                                          "angular_velocity: [1, " \
                                                                          "-1, 0.5], shapes: "     \
                                                                          "[{type: box, size: "    \
                                                                          "[0.3, 0.2, 0.1], "      \
                                                                          "material: s}]}\n"
#define BALLS                                                                                      \
    "se3d: 1\ngravity: [0, 0, 0]\n" CONTACT(                                                       \
        "stiffness: 1.0e+5, restitution: 0.6") "bodies:\n  - {name: b, density: 1000, shapes: "    \
                                               "[{type: sphere, radius: 0.1, material: s}]}\n  - " \
                                               "{name: a, density: 1000, position: [0.05, 0, "     \
                                               "0.22], velocity: [0.7, 0.2, -1], "                 \
                                               "angular_velocity: [1, -3, 2], shapes: [{type: "    \
                                               "sphere, radius: 0.1, material: s}]}\n"
#define ARM                                                                                        \
    "se3d: 1\n" CONTACT("stiffness: 5.0e+4, restitution: 0.5") "bodies:\n  - " PLANE(              \
        "-0.3") "\n  - {name: a, mass: 2, inertia: [0.01, 0.2, 0.2], position: [0.5, 0, 0], "      \
                "shapes: [{type: sphere, radius: 0.05, position: [0.5, 0, 0], material: s}]}\n"    \
                "joints: [{type: revolute, name: j, body_i: ground, body_j: a, at: [0, 0, 0], "    \
                "axis: [0, 1, 0]}]\n"
#define ROTOR "forces: [{type: armature, joint: j, inertia: 2}]\n"
#define STOP  "forces: [{type: stop, joint: j, upper: 0.2, k: 2.0e+4, restitution: 0.6}]\n"

static text_model open_at(const char *text, int32_t method, double tolerance)
{
    text_model m = text_model_open(text, method, SE3D_FORMULATION_AUTO, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver_destroy(m.solver);
    m.solver = NULL;
    def.method = method;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    return m;
}

/* The largest distance from dop853 in rows of 5 ms. */
static double distance(const char *text, double until, double tolerance)
{
    text_model m = open_at(text, SE3D_METHOD_CONVEX, tolerance);
    text_model other = open_at(text, SE3D_METHOD_DOP853, 1e-10);
    double most = 0.0;
    for (int k = 1; 5e-3 * k <= until; ++k) {
        double sum = 0.0;
        CHECK(text_model_run(&m, 5e-3 * k) && text_model_run(&other, 5e-3 * k));
        for (size_t e = 0; e < 3; ++e) {
            const double d = text_model_get(&m, 0, e) - text_model_get(&other, 0, e);
            sum += d * d;
        }
        most = fmax(most, sqrt(sum));
    }
    text_model_close(&m);
    text_model_close(&other);
    return most;
}

static void errors_fall_with_the_tolerance(void)
{
    static const struct {
        const char *text;
        double until, loose, tight; /* at 1e-4, 1e-6 */
    } cases[] = {{BOX LAST("a.position", ""), 0.3, 3e-4, 4e-5},
                 {BALLS LAST("a.position", ""), 0.2, 2e-4, 2e-5},
                 {ARM ROTOR LAST("a.position", ""), 1.2, 1.5e-3, 2e-4},
                 {ARM STOP LAST("a.position", ""), 0.9, 1e-3, 1e-4}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        CHECK(distance(cases[k].text, cases[k].until, 1e-4) < cases[k].loose);
        CHECK(distance(cases[k].text, cases[k].until, 1e-6) < cases[k].tight);
    }
}

static double steps_of(const text_model *m)
{
    se3d_solver_stats stats = {0};
    CHECK(!se3d_solver_get_stats(m->solver, &stats));
    return (double)stats.steps;
}

/* Steps are as long as the error allows: few where nothing happens, more where a tolerance is
 * tighter; the least tolerance is told. */
static void steps_follow_the_error(void)
{
    double steps[3];
    const double tolerances[3] = {1e-3, 1e-5, 1e-9};
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_at(BOX LAST("a.position", ""), SE3D_METHOD_CONVEX, tolerances[k]);
        double used = 0.0;
        CHECK(text_model_run(&m, 0.05));
        CHECK(steps_of(&m) < 150.0);
        CHECK(text_model_run(&m, 0.3));
        steps[k] = steps_of(&m);
        CHECK(!se3d_solver_get_tolerance(m.solver, &used));
        CHECK_NEAR(used, fmax(tolerances[k], 1e-6), 1e-12);
        text_model_close(&m);
    }
    CHECK(steps[1] > 2.0 * steps[0] && steps[2] > 2.0 * steps[1]);
}

static se3d_status get_place(void *ctx, const se3d_system *system, double *value)
{
    double r[3] = {0.0, 0.0, 0.0};
    const se3d_status status = se3d_body_get_position(system, *(const se3d_body *)ctx, r);
    *value = r[0];
    return status;
}

/* Clones go on with the same bits; events, for which steps are made once more, change none. */
static void clones_and_events_change_nothing(void)
{
    static const char *const text = BOX LAST("a.position", "");
    text_model m = open_at(text, SE3D_METHOD_CONVEX, 1e-5);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_event_def event = se3d_event_def_default();
    se3d_system *copy = NULL;
    se3d_solver *solver = NULL;
    se3d_event added;
    se3d_body body;
    double here[3], there[3];
    CHECK(text_model_run(&m, 0.107)); /* within the impact */
    CHECK(!se3d_system_clone(m.system, &copy));
    def.method = SE3D_METHOD_CONVEX;
    def.tolerance = 1e-5;
    CHECK(!se3d_solver_create(copy, &def, &solver));
    CHECK(!se3d_body_find(m.system, "a", &body));
    event.value = get_place;
    event.ctx = &body;
    event.level = 0.12;
    CHECK(!se3d_event_create(solver, &event, &added));
    CHECK(text_model_run(&m, 0.25));
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.25)));
    CHECK(!se3d_body_get_position(m.system, body, here));
    CHECK(!se3d_body_get_position(copy, body, there));
    CHECK(memcmp(here, there, sizeof here) == 0);
    CHECK(se3d_solver_count_event_records(solver) == 1);
    se3d_solver_destroy(solver);
    se3d_system_destroy(copy);
    text_model_close(&m);
}

/* Joints that break end a step, also where the step ends by itself. */
static void joints_break(void)
{
    for (int k = 0; k < 8; ++k) {
        char text[1200];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\nbodies:\n  - {name: a, mass: 1, inertia: [0.02, 0.02, 0.01], "
            "position: [0.5, 0, 2]}\n  - {name: b, mass: 1, inertia: [0.02, 0.02, 0.01], "
            "position: [1, 0, 2]}\njoints:\n  - {type: revolute, name: j, body_i: ground, "
            "body_j: a, at: [0, 0, 2], axis: [0, 1, 0], break: {force: %g}}\n  - {type: "
            "revolute, body_i: a, body_j: b, at: [0.8, 0, 2], axis: [0, 1, 0]}\n" LAST("a.position",
                                                                                       ""),
            12.0 + 1.5 * k);
        CHECK(distance(text, 0.6, 1e-5) < 3e-3); /* it breaks at the end of a half of .5 ms */
    }
}

typedef struct faulty {
    int calls, bad;
} faulty;

static se3d_status fail_once(void *ctx, double t, const se3d_body_motion motion[2],
                             double wrench[12], double *K, double *D)
{
    faulty *f = ctx;
    (void)t, (void)motion, (void)wrench, (void)K, (void)D;
    return ++f->calls == f->bad ? SE3D_ERR_CALLBACK : SE3D_OK;
}

static int ask(void *ctx)
{
    faulty *f = ctx;
    return ++f->calls == f->bad;
}

/* The box at 0.15 s after a run that was to end at the k-th question, or where the k-th
 * call of a force fails, and another one; negative: none is. */
static void run_in_two(int k, int ends, double r[3])
{
    faulty of = {0, k};
    text_model m =
        text_model_open(BOX LAST("a.position", ""), SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 0.0);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_force_callback_def law = se3d_force_callback_def_default();
    se3d_force force;
    se3d_solver_destroy(m.solver);
    m.solver = NULL;
    def.method = SE3D_METHOD_CONVEX;
    def.tolerance = 1e-4;
    CHECK(!se3d_system_get_ground(m.system, &law.body_i));
    CHECK(!se3d_body_find(m.system, "a", &law.body_j));
    if (ends) {
        def.interrupt = ask;
        def.interrupt_ctx = &of;
    } else {
        law.callback = fail_once;
        law.ctx = &of;
        CHECK(!se3d_force_create_callback(m.system, &law, &force));
    }
    CHECK(!se3d_solver_create(m.system, &def, &m.solver));
    const se3d_status status = se3d_solver_run(m.solver, 0.15);
    CHECK(status == (k < 0 ? SE3D_OK : ends ? SE3D_ERR_INTERRUPTED : SE3D_ERR_CALLBACK));
    CHECK(!SE3D_FAILED(se3d_solver_run(m.solver, 0.15)));
    CHECK(!se3d_body_get_position(m.system, law.body_j, r));
    text_model_close(&m);
}

/* Wherever it is in a step, the run ends at an accepted state, and what goes on from there comes to
 * where it would have come: to the bit, but for callbacks, after which steps begin anew. */
static void failures_and_ends_lose_nothing(void)
{
    for (int ends = 0; ends < 2; ++ends) {
        double whole[3], r[3];
        run_in_two(-1, ends, whole);
        for (int k = 1; k < 400; k += 13) {
            run_in_two(k, ends, r);
            CHECK_NEAR(r[0], whole[0], ends ? 0.0 : 5e-6);
            CHECK_NEAR(r[2], whole[2], ends ? 0.0 : 5e-6);
        }
    }
}

/* An island is another one than its neighbour, whichever comes first; and far from the start. */
static void bodies_may_have_any_order(void)
{
#define ROLLS(name, x)                                                                             \
    "  - {name: " name ", density: 1000, position: [" x ", 0, 0.0999], velocity: [0, 1, 0], "      \
    "angular_velocity: [-10, 0, 0], shapes: [{type: sphere, radius: 0.1, material: s}]}\n"
#define FALLS(name, x)                                                                             \
    "  - {name: " name ", density: 1000, position: [" x ", 0, 0.4], angular_velocity: [1, 2, 0], " \
    "shapes: [{type: box, size: [0.2, 0.2, 0.1], material: s}]}\n"
#define PAIR(first, second)                                                                        \
    "se3d: 1\n" CONTACT("stiffness: 1.0e+8, restitution: 0.6") "bodies:\n  - " PLANE(              \
        "0") "\n" first second "analysis: {type: dynamics, duration: 2, start: 5.0e+8}\n"          \
             "output: [{file: r.csv, channels: [a.position, b.position]}]\n"
    static const char *const texts[2] = {PAIR(ROLLS("a", "0"), FALLS("b", "5")),
                                         PAIR(FALLS("b", "5"), ROLLS("a", "0"))};
    double steps[2];
    for (int k = 0; k < 2; ++k) {
        text_model m = open_at(texts[k], SE3D_METHOD_CONVEX, 1e-3);
        double t = 0.0;
        CHECK(!se3d_system_get_time(m.system, &t));
        CHECK(text_model_run(&m, t + 0.4));
        steps[k] = steps_of(&m);
        text_model_close(&m);
    }
    CHECK_NEAR(steps[0], steps[1], 0.5);
}

int main(void)
{
    RUN(errors_fall_with_the_tolerance);
    RUN(steps_follow_the_error);
    RUN(clones_and_events_change_nothing);
    RUN(joints_break);
    RUN(failures_and_ends_lose_nothing);
    RUN(bodies_may_have_any_order);
    return check_finish();
}
