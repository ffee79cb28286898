/* SPDX-License-Identifier: BSD-3-Clause */
/* `auto` moves by gauss what nothing but constant gravity acts on, if its stages can be lanes, and
 * makes single steps of it by dop853; all else moves by dop853. */
#include "check.h"
#include "support/models.h"
#include "support/text_model.h"
#include "support/world.h"

#include <math.h>
#include <string.h>

static se3d_solver *make_solver(se3d_system *system, int32_t method, double tolerance)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(system, &def, &solver));
    return solver;
}

static int moves_by(const se3d_solver *solver, const char *name)
{
    const char *method = "";
    CHECK(!se3d_solver_get_method(solver, &method));
    const int same = strcmp(method, name) == 0;
    if (!same) {
        fprintf(stderr, "%s: %s, not %s\n", check_case, method, name);
    }
    return same;
}

/* Short steps beside bodies that touch are no reason for convex if a spring, a spin, the step that
 * is asked for, impacts that give all back or the user's own force make them short. */
static void contacts_that_do_not_hold_the_steps_are_followed(void)
{
#define BOX "shapes: [{type: box, size: [0.1, 0.1, 0.1], material: m}]}\n"
#define BOXES(e, k)                                                                                \
    "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.3, restitution: " e                 \
    ", stiffness: " k "}]\ncontact: {law: hooke}\nbodies:\n"                                       \
    "  - {name: floor, fixed: true, shapes: [{type: plane, material: m}]}\n"                       \
    "  - {name: a, position: [0, 0, 0.05], " BOX "  - {name: b, position: [0, 0, 0.151], " BOX     \
    "  - {name: c, position: [0, 0, 0.253], " BOX
    static const struct {
        const char *text;
        double step, until;
    } rows[] = {
        {BOXES("0.5", "1e4") "  - {name: fork, mass: 0.01, inertia: [1e-6, 1e-6, 1e-6], "
                             "position: [3, 0, 1.001]}\n"
                             "forces: [{type: tsda, body_i: ground, body_j: fork, point_i: [3, "
                             "0, 0], k: 4e7, l0: 1}]\n",
         0.0, 0.01},
        {BOXES("0.5", "1e4") "  - {name: fork, mass: 0.01, inertia: [1e-6, 2e-6, 2.5e-6], "
                             "position: [3, 0, 1], angular_velocity: [1e5, 1e4, 0]}\n",
         0.0, 0.01},
        {BOXES("0.5", "1e4"), 1e-5, 0.01},
        {BOXES("1", "1e9"), 0.0, 0.01},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        char text[2000];
        const char *left = "";
        double when;
        snprintf(text, sizeof text, "%sanalysis: {type: dynamics, duration: 1}\n", rows[k].text);
        text_model m = text_model_open(text, SE3D_METHOD_AUTO, -1, rows[k].step);
        CHECK(text_model_run(&m, rows[k].until));
        CHECK(moves_by(m.solver, "dop853"));
        CHECK(se3d_solver_get_switch(m.solver, &when, &left) < 0 || !*left);
        se3d_solver_stats stats;
        CHECK(!se3d_solver_get_stats(m.solver, &stats) && stats.steps > 256);
        text_model_close(&m);
    }
}

/* One body on a mesh has many points of contact, each a stiff spring; one on a plane is stiff. */
static void a_single_box_that_is_pressed_on_a_mesh_goes_on_by_convex(void)
{
    static const char *const floors[] = {
        "{type: plane, material: m}",
        "{type: heightfield, heights: [[0, 0], [0, 0]], spacing: 1, material: m}"};
    for (int k = 0; k < 2; ++k) {
        char text[1000];
        snprintf(text, sizeof text,
                 "se3d: 1\ngravity: [0, 0, -9.81]\nmaterials: [{name: m, density: 7800, friction: "
                 "0.2, restitution: 0.2, stiffness: 1e10}]\ncontact: {law: hooke}\nbodies:\n"
                 "  - {name: ground, shapes: [%s]}\n  - {name: box, mass: 0.1, inertia: [1e-5, "
                 "1e-5, 1e-5], position: [0, 0, 0.01], orientation: {axis: [1, 0, 0], angle: 0.05},"
                 " shapes: [{type: box, size: [0.02, 0.02, 0.02], material: m}]}\nforces: [{type: "
                 "force, body: box, value: [\"0\", \"0\", \"-3000\"]}]\n"
                 "analysis: {type: dynamics, duration: 1}\n",
                 floors[k]);
        text_model m = text_model_open(text, SE3D_METHOD_AUTO, -1, 0.0);
        CHECK(text_model_run(&m, 0.007));
        CHECK(moves_by(m.solver, k ? "convex" : "radau"));
        text_model_close(&m);
    }
}

/* Points of contact that come and go hold steps below a microsecond: 20 of these tell, and not the
 * 256 that end at 1.28 ms. */
static void tiny_steps_on_a_mesh_are_left_at_once(void)
{
    const char *text =
        "se3d: 1\ngravity: [0, 0, -9.81]\nmaterials: [{name: m, density: 7800, friction: 0.5, "
        "restitution: 0.2, stiffness: 1e7}]\ncontact: {law: hooke}\nbodies:\n"
        "  - {name: ground, shapes: [{type: heightfield, spacing: 0.02, rows: 9, columns: 9, "
        "heights: 0.004*cos(200*x)*cos(200*y), material: m}]}\n"
        "  - {name: bolt, mass: 0.15, inertia: [6e-5, 6e-5, 1e-5], position: [0.01, 0, 0.01395], "
        "orientation: {axis: [1, 0, 0], angle: 1.57}, shapes: [{type: cylinder, radius: 0.01, "
        "length: 0.06, material: m}]}\n"
        "forces: [{type: force, body: bolt, value: [\"0\", \"0\", \"-300\"]}]\n"
        "analysis: {type: dynamics, duration: 1}\n";
    const char *left = "";
    double when = 0.0;
    text_model m = text_model_open(text, SE3D_METHOD_AUTO, -1, 0.0);
    CHECK(text_model_run(&m, 0.002));
    CHECK(moves_by(m.solver, "convex"));
    CHECK(!se3d_solver_get_switch(m.solver, &when, &left) && when < 0.0012);
    text_model_close(&m);
}

/* A step of two meshes at each other is the work of many others, and fewer of them are waited for:
 * a pinion drives a wheel that stands, 256 steps end at 9.4 ms. */
static void steps_of_meshes_at_each_other_are_counted_by_their_work(void)
{
    char text[2000];
    const char *left = "", *source = getenv("SE3D_SOURCE_DIR");
    double when = 0.0;
    source = source ? source : ".";
    snprintf(text, sizeof text,
             "se3d: 1\nmaterials: [{name: m, density: 7800, friction: 0.1, restitution: 0.2, "
             "stiffness: 1e7}]\ncontact: {law: hooke}\nbodies:\n"
             "  - {name: pinion, shapes: [{type: mesh, file: %s/examples/models/gear18.obj, "
             "material: m}]}\n"
             "  - {name: wheel, position: [0.045, 0, 0], orientation: {axis: [0, 0, 1], angle: "
             "(180/27 + 180)*deg}, shapes: [{type: mesh, file: %s/examples/models/gear27.obj, "
             "material: m}]}\n"
             "joints:\n  - {name: a, type: revolute, body_i: ground, body_j: pinion, at: [0, 0, "
             "0], axis: [0, 0, 1]}\n"
             "  - {name: b, type: revolute, body_i: ground, body_j: wheel, at: [0.045, 0, 0], "
             "axis: [0, 0, 1]}\n"
             "drivers:\n  - {joint: a, coordinate: angle, value: 6.28*(t - 0.1*(1 - "
             "exp(-t/0.1)))}\nforces:\n  - {type: rsda, joint: b, c: 0.01}\n"
             "analysis: {type: dynamics, duration: 1}\n",
             source, source);
    text_model m = text_model_open(text, SE3D_METHOD_AUTO, -1, 0.0);
    CHECK(text_model_run(&m, 0.02));
    CHECK(moves_by(m.solver, "convex"));
    CHECK(!se3d_solver_get_switch(m.solver, &when, &left) && when < 0.006);
    text_model_close(&m);
}

/* Boxes that fall one after the other, of which few touch the floor at a time. Those of thirty are
 * left as soon as their steps are short, those of two never, nor where a step below 1 ms is asked
 * for or impacts give all back. */
static void few_that_touch_of_many_free_bodies_go_on_by_convex(void)
{
    static const struct {
        const char *restitution, *method;
        int count;
        double step;
    } rows[] = {{"0.1", "convex", 30, 0.0},
                {"0.1", "dop853", 2, 0.0},
                {"0.1", "dop853", 30, 5e-4},
                {"1", "dop853", 30, 0.0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        char text[8000];
        int length = snprintf(text, sizeof text,
                              "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.5, "
                              "restitution: %s, stiffness: 3e5}]\ncontact: {law: hooke}\nbodies:\n"
                              "  - {name: floor, fixed: true, shapes: [{type: plane, material: "
                              "m}]}\n",
                              rows[k].restitution);
        for (int body = 0; body < rows[k].count; ++body) {
            length += snprintf(text + length, sizeof text - (size_t)length,
                               "  - {name: b%d, position: [%d, 0, %g], orientation: {axis: [1, 1, "
                               "0], angle: 0.3}, " BOX,
                               body, body, 0.1 + 0.1 * body);
        }
        snprintf(text + length, sizeof text - (size_t)length,
                 "analysis: {type: dynamics, duration: 1}\n");
        text_model m = text_model_open(text, SE3D_METHOD_AUTO, -1, rows[k].step);
        CHECK(text_model_run(&m, 0.13));
        CHECK(moves_by(m.solver, rows[k].method));
        text_model_close(&m);
    }
}

static void it_depends_on_what_acts_and_on_the_loops(void)
{
    static const struct {
        const char *mechanism;
        int count;
        double tolerance;
        const char *method;
    } rows[] = {{"pendulum", 1, 0.0, "gauss"},
                {"chain_revolute", 5, 1e-12, "gauss"},
                {"chain_ball", 3, 0.1, "gauss"},
                {"four_bar", 1, 1e-6, "gauss"},
                {"four_bar", 3, 1e-3, "gauss"},
                {"four_bar", 1, 1e-10, "dop853"}, /* loops, with the least noise */
                {"driven_pendulum", 1, 0.0, "dop853"},
                {"driven_four_bar", 1, 0.0, "dop853"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        support_model model;
        support_model_make(&model, rows[k].mechanism, rows[k].count);
        se3d_solver *solver = make_solver(model.system, SE3D_METHOD_AUTO, rows[k].tolerance);
        CHECK(se3d_solver_run(solver, 0.01) >= 0);
        CHECK(moves_by(solver, rows[k].method));
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

/* Bodies without joints, other formulations and elements: one solver, decided again. */
static void it_is_decided_again_when_the_structure_changes(void)
{
    support_model model;
    se3d_force force;
    se3d_tsda_def spring = se3d_tsda_def_default();
    support_model_make(&model, "double_pendulum", 1);
    se3d_solver *solver = make_solver(model.system, SE3D_METHOD_AUTO, 0.0);
    CHECK(se3d_solver_run(solver, 0.1) >= 0 && moves_by(solver, "gauss"));
    CHECK(!se3d_system_get_ground(model.system, &spring.body_i));
    spring.body_j = model.bodies[1];
    spring.point_i[2] = 3.0;
    spring.k = 10.0;
    spring.l0 = 2.0;
    CHECK(!se3d_force_create_tsda(model.system, &spring, &force));
    CHECK(se3d_solver_run(solver, 0.2) >= 0 && moves_by(solver, "dop853"));
    CHECK(!se3d_force_destroy(model.system, force));
    CHECK(se3d_solver_run(solver, 0.3) >= 0 && moves_by(solver, "gauss"));
    se3d_solver_destroy(solver);
    solver = world_solver(model.system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO,
                          SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(se3d_solver_run(solver, 0.4) >= 0 && moves_by(solver, "dop853"));
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
}

static void look(const support_model *model, double r[3])
{
    CHECK(!se3d_body_get_position(model->system, model->bodies[model->body_count - 1], r));
}

static double part(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Runs and steps in turn, beside one exact run; what is written in between goes on alike. */
static void steps_between_runs_are_made_by_dop853(void)
{
    support_model model, same;
    double r[3], exact[3], other[3];
    unsigned char bytes[8192];
    size_t size = 0;
    support_model_make(&same, "double_pendulum", 1);
    se3d_solver *solver = make_solver(same.system, SE3D_METHOD_DOP853, 1e-12);
    CHECK(se3d_solver_run(solver, 0.62) >= 0);
    look(&same, exact);
    se3d_solver_destroy(solver);
    support_model_destroy(&same);

    support_model_make(&model, "double_pendulum", 1);
    solver = make_solver(model.system, SE3D_METHOD_AUTO, 1e-6);
    CHECK(se3d_solver_run(solver, 0.0) >= 0);
    for (int k = 0; k < 10; ++k) {
        CHECK(se3d_solver_step(solver, 0.001) >= 0 && moves_by(solver, "dop853"));
    }
    CHECK(se3d_solver_write(solver, bytes, sizeof bytes, &size) >= 0 && size <= sizeof bytes);
    se3d_system *clone = NULL;
    CHECK(!se3d_system_clone(model.system, &clone));
    se3d_solver *read = make_solver(clone, SE3D_METHOD_AUTO, 1e-6);
    CHECK(!se3d_solver_read(read, bytes, size) && moves_by(read, "dop853"));
    for (int k = 0; k < 2; ++k) {
        se3d_solver *const one = k ? read : solver;
        CHECK(se3d_solver_run(one, 0.3) >= 0 && moves_by(one, "gauss"));
        CHECK(se3d_solver_step(one, 0.02) >= 0 && moves_by(one, "dop853"));
        CHECK(se3d_solver_run(one, 0.62) >= 0 && moves_by(one, "gauss"));
    }
    look(&model, r);
    CHECK(part(r, exact) < 1e-6);
    CHECK(!se3d_body_get_position(clone, model.bodies[1], other));
    CHECK(memcmp(r, other, sizeof r) == 0);
    se3d_solver_destroy(read);
    se3d_solver_destroy(solver);
    se3d_system_destroy(clone);
    support_model_destroy(&model);
}

/* A solver on a clone of the system, which goes on from what `solver` has written. */
static se3d_solver *read_beside(const support_model *model, const se3d_solver *solver,
                                se3d_system **clone)
{
    unsigned char bytes[8192];
    size_t size = 0;
    CHECK(se3d_solver_write(solver, bytes, sizeof bytes, &size) >= 0 && size <= sizeof bytes);
    CHECK(!se3d_system_clone(model->system, clone));
    se3d_solver *read = make_solver(*clone, SE3D_METHOD_AUTO, 1e-6);
    CHECK(!se3d_solver_read(read, bytes, size));
    return read;
}

static void set_gravity(const support_model *model, const char *text)
{
    se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
    if (text) {
        CHECK(!se3d_function_create_expression(model->system, text, &gravity[2]));
    }
    CHECK(!se3d_system_set_gravity_function(model->system, gravity));
}

/* Gravity becomes a function of time, and a constant again: the solver, one that has read it and a
 * new one go on by the same method, to the same bits. */
static void it_is_decided_again_when_gravity_varies(void)
{
    static const struct {
        const char *gravity, *method;
        double t_end;
    } rows[] = {{"-9.81 + sin(t)", "dop853", 0.2}, {NULL, "gauss", 0.3}, {"-5 - t", "dop853", 0.4}};
    static const char *const mechanisms[] = {"double_pendulum", "four_bar"};
    for (size_t m = 0; m < sizeof mechanisms / sizeof *mechanisms; ++m) {
        support_model model;
        support_model_make(&model, mechanisms[m], 1);
        se3d_solver *solver = make_solver(model.system, SE3D_METHOD_AUTO, 1e-6);
        CHECK(se3d_solver_run(solver, 0.1) >= 0 && moves_by(solver, "gauss"));
        for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
            se3d_system *clones[2];
            set_gravity(&model, rows[k].gravity);
            se3d_solver *read = read_beside(&model, solver, &clones[0]);
            CHECK(!se3d_system_clone(model.system, &clones[1]));
            se3d_solver *fresh = make_solver(clones[1], SE3D_METHOD_AUTO, 1e-6);
            se3d_solver *const all[] = {solver, read, fresh};
            for (int s = 0; s < 3; ++s) {
                CHECK(se3d_solver_run(all[s], rows[k].t_end) >= 0);
                CHECK(moves_by(all[s], rows[k].method));
            }
            for (int c = 0; c < 2; ++c) {
                CHECK(se3d_system_hash(clones[c]) == se3d_system_hash(model.system));
            }
            se3d_solver_destroy(fresh);
            se3d_solver_destroy(read);
            se3d_system_destroy(clones[1]);
            se3d_system_destroy(clones[0]);
        }
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3];
    const se3d_status status = se3d_body_get_position(system, *(const se3d_body *)ctx, r);
    *value = r[2];
    return status;
}

static se3d_status vary_gravity(void *ctx, se3d_system *system, const se3d_event_record *record)
{
    (void)record;
    return se3d_system_set_gravity_function(system, ctx);
}

/* A solver with an event at a height of `body`, where gravity becomes that of `gravity`. */
static se3d_solver *make_solver_with_event(se3d_system *system, se3d_body *body, double height,
                                           se3d_function gravity[3])
{
    se3d_solver *solver = make_solver(system, SE3D_METHOD_AUTO, 1e-6);
    se3d_event event;
    se3d_event_def def = se3d_event_def_default();
    def.value = get_height;
    def.ctx = body;
    def.callback = vary_gravity;
    def.callback_ctx = gravity;
    def.level = height;
    CHECK(!se3d_event_create(solver, &def, &event));
    return solver;
}

/* In the middle of a run, and of a step, by the callback of an event. */
static void it_is_decided_again_within_a_run(void)
{
    for (int is_step = 0; is_step < 2; ++is_step) {
        support_model model;
        se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
        support_model_make(&model, "double_pendulum", 1);
        CHECK(!se3d_function_create_expression(model.system, "-9.81 + sin(t)", &gravity[2]));
        se3d_solver *solver = make_solver_with_event(model.system, &model.bodies[1], -1.1, gravity);
        CHECK(se3d_solver_run(solver, 0.05) >= 0 && moves_by(solver, "gauss"));
        CHECK((is_step ? se3d_solver_step(solver, 0.4) : se3d_solver_run(solver, 0.45)) >= 0);
        CHECK(se3d_solver_count_event_records(solver) == 1 && moves_by(solver, "dop853"));
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

/* A wheel measures: it comes and goes, and nothing moves in another way. */
static void a_wheel_has_no_say(void)
{
    for (int method = 0; method < 2; ++method) {
        uint64_t steps[2];
        double r[2][3];
        for (int has_wheel = 0; has_wheel < 2; ++has_wheel) {
            support_model model;
            se3d_wheel wheel;
            se3d_solver_stats stats;
            se3d_wheel_def def = se3d_wheel_def_default();
            support_model_make(&model, "double_pendulum", 1);
            se3d_solver *solver =
                make_solver(model.system, method ? SE3D_METHOD_DOP853 : SE3D_METHOD_AUTO, 1e-2);
            CHECK(se3d_solver_run(solver, 0.1) >= 0);
            if (has_wheel) {
                def.body = model.bodies[1];
                def.chassis = model.bodies[0];
                def.axis[0] = def.axis[2] = 1.0;
                def.radius = 0.3;
                world_must(model.system, se3d_wheel_create(model.system, &def, &wheel), "wheel");
            }
            CHECK(se3d_solver_run(solver, 0.5) >= 0);
            CHECK(moves_by(solver, method ? "dop853" : "gauss"));
            CHECK(!se3d_solver_get_stats(solver, &stats));
            se3d_solver_destroy(solver);
            solver = make_solver(model.system, SE3D_METHOD_AUTO, 1e-2);
            CHECK(se3d_solver_run(solver, 0.6) >= 0 && moves_by(solver, "gauss"));
            steps[has_wheel] = stats.steps;
            look(&model, r[has_wheel]);
            se3d_solver_destroy(solver);
            support_model_destroy(&model);
        }
        CHECK(steps[0] == steps[1] && part(r[0], r[1]) < 1e-13);
    }
}

/* Read into a solver that moved by radau, as its system had before: runs and single steps are those
 * of the writer, to the bit. */
static void what_is_read_goes_on_as_what_was_written(void)
{
    static const double steps[] = {0.0, 0.3}; /* the last call before writing is a run, a step */
    for (size_t k = 0; k < sizeof steps / sizeof *steps; ++k) {
        support_model model, other;
        se3d_snapshot *snapshot = NULL;
        unsigned char bytes[8192];
        size_t size = 0;
        support_model_make(&model, "chain_ball", 3);
        support_model_make(&other, "chain_ball", 3);
        se3d_solver *solver = make_solver(model.system, SE3D_METHOD_AUTO, 1e-6);
        CHECK(se3d_solver_run(solver, 0.1) >= 0 && moves_by(solver, "gauss"));
        CHECK(steps[k] == 0.0 || se3d_solver_step(solver, 0.01) >= 0);
        se3d_solver *before = make_solver(other.system, SE3D_METHOD_RADAU, 1e-6);
        CHECK(se3d_solver_run(before, 0.02) >= 0);
        se3d_solver *read = make_solver(other.system, SE3D_METHOD_AUTO, 1e-6);
        CHECK(se3d_solver_run(read, 0.05) >= 0 && moves_by(read, "radau"));
        CHECK(!se3d_snapshot_create(model.system, &snapshot));
        CHECK(!se3d_snapshot_restore(snapshot, other.system));
        CHECK(se3d_solver_write(solver, bytes, sizeof bytes, &size) >= 0 && size <= sizeof bytes);
        CHECK(!se3d_solver_read(read, bytes, size));
        CHECK(moves_by(read, steps[k] > 0.0 ? "dop853" : "gauss"));
        for (int m = 0; m < 2; ++m) {
            se3d_solver *const one = m ? read : solver;
            CHECK(se3d_solver_step(one, 0.3) >= 0 && moves_by(one, "dop853"));
            CHECK(se3d_solver_run(one, 0.6) >= 0 && moves_by(one, "gauss"));
        }
        CHECK(se3d_system_hash(model.system) == se3d_system_hash(other.system));
        se3d_snapshot_destroy(snapshot);
        se3d_solver_destroy(read);
        se3d_solver_destroy(before);
        se3d_solver_destroy(solver);
        support_model_destroy(&other);
        support_model_destroy(&model);
    }
}

/* They are those of a solver with an event. */
static void bytes_that_are_refused_leave_the_method(void)
{
    support_model model, other;
    se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
    unsigned char bytes[8192];
    size_t size = 0;
    support_model_make(&model, "double_pendulum", 1);
    support_model_make(&other, "double_pendulum", 1);
    se3d_solver *solver = make_solver_with_event(model.system, &model.bodies[1], -50.0, gravity);
    CHECK(se3d_solver_run(solver, 0.1) >= 0 && moves_by(solver, "gauss"));
    CHECK(se3d_solver_write(solver, bytes, sizeof bytes, &size) >= 0 && size <= sizeof bytes);
    se3d_solver *before = make_solver(other.system, SE3D_METHOD_RADAU, 1e-6);
    CHECK(se3d_solver_run(before, 0.02) >= 0);
    se3d_solver *read = make_solver(other.system, SE3D_METHOD_AUTO, 1e-6);
    CHECK(se3d_solver_run(read, 0.05) >= 0 && moves_by(read, "radau"));
    CHECK(se3d_solver_read(read, bytes, size) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(moves_by(read, "radau"));
    CHECK(se3d_solver_run(read, 0.1) >= 0 && moves_by(read, "radau"));
    se3d_solver_destroy(read);
    se3d_solver_destroy(before);
    se3d_solver_destroy(solver);
    support_model_destroy(&other);
    support_model_destroy(&model);
}

/* A bar, the last of those that hang, on the one before; all turn as one at `rate`. */
static void hang(se3d_system *system, se3d_body on, double top, double length, double rate,
                 se3d_body *bar)
{
    const double at[3] = {0.0, 0.0, top}, axis[3] = {0.0, 1.0, 0.0};
    se3d_body_def def = se3d_body_def_default();
    def.mass = length;
    def.position[2] = top - 0.5 * length;
    def.velocity[0] = rate * def.position[2];
    def.angular_velocity[1] = rate;
    for (int c = 0; c < 3; ++c) {
        def.inertia[c] = length * length * length / 12.0;
    }
    world_must(system, se3d_body_create(system, &def, bar), "se3d_body_create");
    world_join(system, se3d_joint_create_revolute, NULL, on, *bar, at, axis);
}

/* Oscillations far smaller than a turn are not stiff. */
static void small_motions_are_not_left(void)
{
    static const struct {
        double lengths[2], t_end;
    } rows[] = {{{1.0, 0.0}, 25.0}, {{1.0, 1e-3}, 2.0}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        const double *lengths = rows[k].lengths, rate = 1e-9;
        se3d_system *system = NULL;
        se3d_body on, bar;
        const char *left = "";
        double time;
        CHECK(!se3d_system_create(NULL, &system));
        CHECK(!se3d_system_get_ground(system, &on));
        hang(system, on, 0.0, lengths[0], rate, &bar);
        if (lengths[1] > 0.0) {
            hang(system, bar, -lengths[0], lengths[1], rate, &bar);
        }
        se3d_solver *solver = make_solver(system, SE3D_METHOD_AUTO, 0.0);
        CHECK(se3d_solver_run(solver, rows[k].t_end) >= 0 && moves_by(solver, "gauss"));
        CHECK(!se3d_solver_get_switch(solver, &time, &left) && *left == '\0');
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
}

/* It is faster by what it was taken for: no more steps, fewer evaluations of four stages at once,
 * errors within the tolerance. */
static void the_motion_is_within_the_tolerance(void)
{
    static const struct {
        const char *mechanism;
        int count;
    } rows[] = {{"pendulum", 1}, {"heavy_top", 1}, {"four_bar", 1}, {"chain_ball", 4}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (double tolerance = 1e-3; tolerance > 1e-10; tolerance *= 1e-3) {
            double r[2][3];
            uint64_t steps[2], evaluations[2];
            for (int m = 0; m < 2; ++m) {
                support_model model;
                se3d_solver_stats stats;
                support_model_make(&model, rows[k].mechanism, rows[k].count);
                se3d_solver *solver =
                    make_solver(model.system, m ? SE3D_METHOD_DOP853 : SE3D_METHOD_AUTO,
                                m ? 0.01 * tolerance : tolerance);
                CHECK(se3d_solver_run(solver, 0.5) >= 0);
                CHECK(!se3d_solver_get_stats(solver, &stats));
                steps[m] = stats.steps;
                evaluations[m] = stats.evaluations;
                look(&model, r[m]);
                se3d_solver_destroy(solver);
                support_model_destroy(&model);
            }
            CHECK(part(r[0], r[1]) < tolerance);
            CHECK(steps[0] <= steps[1] && evaluations[0] < 4 * evaluations[1]);
        }
    }
}

int main(void)
{
    RUN(it_depends_on_what_acts_and_on_the_loops);
    RUN(contacts_that_do_not_hold_the_steps_are_followed);
    RUN(a_single_box_that_is_pressed_on_a_mesh_goes_on_by_convex);
    RUN(tiny_steps_on_a_mesh_are_left_at_once);
    RUN(steps_of_meshes_at_each_other_are_counted_by_their_work);
    RUN(few_that_touch_of_many_free_bodies_go_on_by_convex);
    RUN(it_is_decided_again_when_the_structure_changes);
    RUN(steps_between_runs_are_made_by_dop853);
    RUN(it_is_decided_again_when_gravity_varies);
    RUN(it_is_decided_again_within_a_run);
    RUN(a_wheel_has_no_say);
    RUN(what_is_read_goes_on_as_what_was_written);
    RUN(bytes_that_are_refused_leave_the_method);
    RUN(small_motions_are_not_left);
    RUN(the_motion_is_within_the_tolerance);
    return check_finish();
}
