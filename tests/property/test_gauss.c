/* SPDX-License-Identifier: BSD-3-Clause */
/* gauss: what its theory page says of it. The error follows the tolerance on mechanisms of all
 * kinds, also between the ends of steps, with few rejected steps; it steps back to where it came
 * from; the energy does not drift; a stiff motion is reported; stages in lanes are the same.
 */
#include "check.h"
#include "support/models.h"
#include "support/text_model.h"
#include "support/tree_world.h"
#include "support/world.h"

#include <math.h>
#include <string.h>

#define OUTPUTS 23
#define BODIES  8

typedef struct track {
    double r[OUTPUTS][BODIES][3];
    se3d_solver_stats stats;
} track;

static const struct {
    const char *name;
    int count;
    double duration;
} mechanisms[] = {{"pendulum", 1, 2.0},     {"double_pendulum", 1, 1.0},
                  {"heavy_top", 1, 0.3},    {"four_bar", 1, 0.6},
                  {"slider_crank", 1, 0.6}, {"chain_revolute", 5, 0.7},
                  {"chain_ball", 4, 0.7},   {"driven_double_pendulum", 1, 1.0}};
#define MECHANISMS ((int)(sizeof mechanisms / sizeof mechanisms[0]))

static se3d_solver *make_solver(const support_model *model, int32_t method, int32_t formulation,
                                double tolerance)
{
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.tolerance = tolerance;
    def.order = tolerance > 0.0 || method != SE3D_METHOD_GAUSS ? 0 : 8;
    CHECK(se3d_solver_create(model->system, &def, &solver) == SE3D_OK);
    return solver;
}

static void run(int mechanism, int32_t method, int32_t formulation, double tolerance, track *out)
{
    support_model model;
    support_model_make(&model, mechanisms[mechanism].name, mechanisms[mechanism].count);
    se3d_solver *solver = make_solver(&model, method, formulation, tolerance);
    CHECK(model.body_count <= BODIES);
    memset(out, 0, sizeof *out);
    for (int k = 0; k < OUTPUTS; ++k) {
        CHECK(se3d_solver_run(solver, mechanisms[mechanism].duration * (k + 1) / OUTPUTS) >= 0);
        for (int b = 0; b < model.body_count; ++b) {
            CHECK(!se3d_body_get_position(model.system, model.bodies[b], out->r[k][b]));
        }
    }
    CHECK(!se3d_solver_get_stats(solver, &out->stats));
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
}

/* The largest difference of positions, relative to the largest position. */
static double compare(const track *a, const track *b)
{
    const double *x = &a->r[0][0][0], *y = &b->r[0][0][0];
    double worst = 0.0, size = 0.0;
    for (int k = 0; k < OUTPUTS * BODIES * 3; ++k) {
        worst = fmax(worst, fabs(x[k] - y[k]));
        size = fmax(size, fabs(y[k]));
    }
    return worst / size;
}

static void errors_follow_the_tolerance_and_few_steps_are_rejected(void)
{
    static track exact, out;
    double steps = 0.0, rejected = 0.0;
    for (int m = 0; m < MECHANISMS; ++m) {
        for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; f += 2) {
            double error[2] = {1.0, 1.0};
            run(m, SE3D_METHOD_DOP853, f, 7e-12, &exact);
            for (int k = 3; k <= 12; ++k) {
                const double tolerance = pow(10.0, -k);
                run(m, SE3D_METHOD_GAUSS, f, tolerance, &out);
                const double now = compare(&out, &exact);
                CHECK(now < 10.0 * tolerance + 1e-12);
                CHECK(now < error[0] || now < 1e-11); /* two decades apart */
                error[0] = error[1];
                error[1] = now;
                steps += (double)out.stats.steps;
                rejected += (double)out.stats.rejected;
                if (getenv("SE3D_TEST_VERBOSE")) {
                    fprintf(stderr,
                            "%s %d 1e-%d: error %.1e, steps %d, rejected %d, %d evaluations\n",
                            mechanisms[m].name, (int)f, k, now, (int)out.stats.steps,
                            (int)out.stats.rejected, (int)out.stats.evaluations);
                }
            }
        }
    }
    CHECK(rejected < 0.1 * steps);
}

/* What the iterations leave at a loose tolerance is not magnified by the prediction: with all terms
 * of the last polynomial this took 66 steps. */
static void a_loose_tolerance_takes_few_steps(void)
{
    support_model model;
    se3d_solver_stats stats;
    support_model_make(&model, "chain_revolute", 8);
    se3d_solver *solver = make_solver(&model, SE3D_METHOD_GAUSS, SE3D_FORMULATION_JOINT, 0.1);
    CHECK(se3d_solver_run(solver, 1.0) >= 0);
    CHECK(!se3d_solver_get_stats(solver, &stats));
    CHECK(stats.steps < 20 && stats.evaluations < 500);
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
}

static double get_energy(const support_model *model)
{
    se3d_energy energy;
    CHECK(se3d_system_get_energy(model->system, &energy) == SE3D_OK);
    return energy.kinetic + energy.potential;
}

/* Turn all velocities round. */
static void reverse(const support_model *model)
{
    for (int b = 0; b < model->body_count; ++b) {
        double v[3], w[3];
        CHECK(!se3d_body_get_velocity(model->system, model->bodies[b], v));
        CHECK(!se3d_body_get_angular_velocity(model->system, model->bodies[b], w));
        for (int c = 0; c < 3; ++c) {
            v[c] = -v[c];
            w[c] = -w[c];
        }
        CHECK(!se3d_body_set_velocity(model->system, model->bodies[b], v));
        CHECK(!se3d_body_set_angular_velocity(model->system, model->bodies[b], w));
    }
}

/* How far ten steps forth and ten back end from the start, of what one step is in error by. */
static double go_forth_and_back(int32_t method, int32_t formulation, double h)
{
    support_model model;
    double before[3], after[3];
    support_model_make(&model, "double_pendulum", 1);
    se3d_solver *solver = make_solver(&model, method, formulation, 0.0);
    CHECK(!se3d_body_get_position(model.system, model.bodies[1], before));
    for (int k = 0; k < 20; ++k) {
        if (k == 10) {
            reverse(&model);
        }
        CHECK(se3d_solver_step(solver, h) >= 0);
    }
    CHECK(!se3d_body_get_position(model.system, model.bodies[1], after));
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return hypot(hypot(after[0] - before[0], after[1] - before[1]), after[2] - before[2]);
}

/* Evaluations of `order`, and where the last body is then. */
static uint64_t run_order(const char *name, int count, int32_t order, double tolerance, double r[3])
{
    support_model model;
    se3d_solver_stats stats;
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    support_model_make(&model, name, count);
    def.method = SE3D_METHOD_GAUSS;
    def.formulation = SE3D_FORMULATION_JOINT;
    def.tolerance = tolerance;
    def.order = order;
    CHECK(se3d_solver_create(model.system, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 0.5) >= 0);
    CHECK(!se3d_solver_get_stats(solver, &stats));
    CHECK(!se3d_body_get_position(model.system, model.bodies[model.body_count - 1], r));
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return stats.evaluations;
}

/* Without an order: four stages at loose tolerances, which few freedoms need looser, and eight
 * elsewhere. */
static void freedoms_and_tolerance_choose_the_stages(void)
{
    static const struct {
        const char *name;
        int count;
        double tolerance;
        int32_t order;
    } rows[] = {{"chain_revolute", 8, 1e-2, 8},  {"chain_revolute", 8, 1e-5, 8},
                {"chain_revolute", 8, 1e-6, 16}, {"chain_ball", 3, 7e-4, 8},
                {"chain_revolute", 7, 1e-2, 8},  {"chain_revolute", 7, 1e-4, 16},
                {"chain_ball", 2, 1e-2, 8},      {"chain_ball", 2, 1e-4, 16},
                {"four_bar", 3, 1e-2, 16}};
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        double r[3], chosen[3];
        const uint64_t evaluations =
            run_order(rows[k].name, rows[k].count, rows[k].order, rows[k].tolerance, r);
        CHECK(run_order(rows[k].name, rows[k].count, 0, rows[k].tolerance, chosen) == evaluations);
        CHECK(memcmp(r, chosen, sizeof r) == 0);
        const int32_t other = rows[k].order == 8 ? 16 : 8;
        const uint64_t otherwise =
            run_order(rows[k].name, rows[k].count, other, rows[k].tolerance, chosen);
        CHECK(otherwise != evaluations);
        if (rows[k].order == 8) { /* fewer lanes, and fewer of them */
            CHECK((double)evaluations < 0.8 * (double)otherwise);
        }
    }
}

static void steps_back_lead_to_where_it_came_from(void)
{
    for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; ++f) {
        const double gauss = go_forth_and_back(SE3D_METHOD_GAUSS, f, 0.1);
        const double dop853 = go_forth_and_back(SE3D_METHOD_DOP853, f, 0.1);
        CHECK(dop853 > 1e-7);
        CHECK(gauss < (f == SE3D_FORMULATION_JOINT ? 1e-12 : 0.1 * dop853)); /* projection */
    }
}

/* The largest deviation of the energy in each half of many steps of a pendulum. */
static void swing(int32_t method, int32_t formulation, double h, int steps, double worst[2])
{
    support_model model;
    support_model_make(&model, "pendulum", 1);
    se3d_solver *solver = make_solver(&model, method, formulation, 0.0);
    CHECK(se3d_solver_step(solver, h) >= 0);
    const double first = get_energy(&model);
    worst[0] = worst[1] = 0.0;
    for (int k = 0; k < steps; ++k) {
        CHECK(se3d_solver_step(solver, h) >= 0);
        double *half = &worst[2 * k / steps];
        *half = fmax(*half, fabs(get_energy(&model) - first));
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
}

static void the_energy_does_not_drift(void)
{
    double gauss[2], dop853[2];
    swing(SE3D_METHOD_GAUSS, SE3D_FORMULATION_JOINT, 0.25, 4000, gauss);
    swing(SE3D_METHOD_DOP853, SE3D_FORMULATION_JOINT, 0.25, 4000, dop853);
    if (getenv("SE3D_TEST_VERBOSE")) {
        fprintf(stderr, "gauss %.3e %.3e J, dop853 %.3e %.3e J\n", gauss[0], gauss[1], dop853[0],
                dop853[1]);
    }
    CHECK(gauss[0] > 1e-9); /* it is not rounding that is compared */
    CHECK(gauss[1] < 1.05 * gauss[0]);
    CHECK(dop853[1] > 1.5 * dop853[0]);
}

static void a_step_that_does_not_converge_is_refused(void)
{
    text_model m = text_model_open(
        "{se3d: 1, gravity: [0, 0, 0], bodies: [{name: a, mass: 1, inertia: [1, 1, 1]}],"
        " forces: [{type: tsda, body_i: ground, point_i: [-1, 0, 0], body_j: a, k: 1e4, l0: 0.9}],"
        " analysis: {type: dynamics, duration: 1}}",
        SE3D_METHOD_GAUSS, 0, 0.0);
    double t = -1.0;
    CHECK(se3d_solver_step(m.solver, 0.5) == SE3D_ERR_NO_CONVERGENCE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "a step of 0.5 s");
    CHECK(!se3d_system_get_time(m.system, &t));
    CHECK(t == 0.0);
    CHECK(se3d_solver_step(m.solver, 0.002) >= 0);
    text_model_close(&m);
}

static int warnings;
static char last_warning[512];

static void note(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    (void)ctx;
    CHECK(level != SE3D_LOG_WARNING || kind != SE3D_LOG_FAILURE);
    if (level == SE3D_LOG_WARNING) {
        ++warnings;
        (void)snprintf(last_warning, sizeof last_warning, "%s", message);
    }
}

/* A body on a spring whose damper decays 1e4 times faster than it moves. */
static void a_stiff_motion_is_told_of_once(void)
{
    const double J[3] = {1.0, 1.0, 1.0}, r[3] = {0.0, 0.0, 0.0};
    se3d_system_def def = se3d_system_def_default();
    se3d_tsda_def damper = se3d_tsda_def_default();
    se3d_system *system;
    se3d_force force;
    def.log = note;
    CHECK(!se3d_system_create(&def, &system));
    CHECK(!se3d_system_get_ground(system, &damper.body_i));
    damper.body_j = world_add_body(system, 1.0, J, r);
    damper.point_i[0] = -1.0;
    damper.k = 1e3;
    damper.c = 1e4;
    damper.l0 = 0.9;
    CHECK(!se3d_force_create_tsda(system, &damper, &force));
    se3d_solver *solver = world_solver(system, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GAUSS,
                                       SE3D_FORMULATION_ROMEGA, 0.0);
    warnings = 0;
    CHECK(!se3d_solver_run(solver, 0.5));
    CHECK(!se3d_solver_run(solver, 1.0));
    CHECK(warnings == 1);
    CHECK_CONTAINS(last_warning, "stiff");
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* A random tree on which nothing but gravity acts, moving as its joints allow. */
static void make_bare(tree_world *w, uint64_t seed)
{
    se3d_coordinates *c;
    se3d_force force;
    double q[7 * TREE_BODIES_MAX], qdot[6 * TREE_BODIES_MAX];
    tree_world_init(w, seed, 1 + (int)(seed % TREE_BODIES_MAX), 0);
    while (se3d_system_count_forces(w->system) > 0) {
        CHECK(!se3d_system_get_force(w->system, 0, &force));
        CHECK(!se3d_force_destroy(w->system, force));
    }
    CHECK(!se3d_coordinates_create(w->system, &c));
    CHECK(!se3d_coordinates_get(c, q, qdot));
    CHECK(!se3d_coordinates_set(c, q, qdot));
    se3d_coordinates_destroy(c);
}

static void run_tree(uint64_t seed, int32_t method, double tolerance, double r[][3],
                     se3d_solver_stats *stats)
{
    tree_world w;
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    make_bare(&w, seed);
    def.method = method;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(w.system, &def, &solver));
    CHECK(se3d_solver_run(solver, 2.0) >= 0);
    CHECK(!se3d_solver_get_stats(solver, stats));
    for (int k = 1; k < w.count; ++k) {
        CHECK(!se3d_body_get_position(w.system, w.bodies[k], r[k]));
    }
    se3d_solver_destroy(solver);
    tree_world_destroy(&w);
}

/* Of what the control of errors was not tuned on. */
static void errors_follow_the_tolerance_on_random_trees(void)
{
    static double exact[TREE_BODIES_MAX + 1][3], out[TREE_BODIES_MAX + 1][3];
    double steps = 0.0, rejected = 0.0;
    for (uint64_t seed = 0; seed < 16; ++seed) {
        se3d_solver_stats stats;
        memset(exact, 0, sizeof exact);
        memset(out, 0, sizeof out);
        run_tree(seed, SE3D_METHOD_DOP853, 1e-12, exact, &stats);
        for (int k = 3; k <= 11; k += 2) {
            double error = 0.0, size = 1.0;
            run_tree(seed, SE3D_METHOD_AUTO, pow(10.0, -k), out, &stats);
            for (int b = 0; b < 3 * (TREE_BODIES_MAX + 1); ++b) {
                error = fmax(error, fabs(out[b / 3][b % 3] - exact[b / 3][b % 3]));
                size = fmax(size, fabs(exact[b / 3][b % 3]));
            }
            steps += (double)stats.steps;
            rejected += (double)stats.rejected;
            if (getenv("SE3D_TEST_VERBOSE")) {
                fprintf(stderr, "tree %d 1e-%d: error %.1e, steps %d, rejected %d\n", (int)seed, k,
                        error / size, (int)stats.steps, (int)stats.rejected);
            }
            CHECK(error < (10.0 * pow(10.0, -k) + 1e-11) * size);
        }
    }
    CHECK(rejected < 0.2 * steps);
}

static uint64_t run_bare(se3d_system *system, int32_t order, double tolerance)
{
    se3d_solver *solver;
    se3d_solver_stats stats;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_GAUSS;
    def.formulation = SE3D_FORMULATION_JOINT;
    def.order = order;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(system, &def, &solver));
    CHECK(se3d_solver_run(solver, 0.3) >= 0);
    CHECK(!se3d_solver_get_stats(solver, &stats));
    se3d_solver_destroy(solver);
    return stats.evaluations;
}

/* An effort of nothing on some joint; 0: none has a coordinate for it. */
static int add_effort(se3d_system *system, const tree_world *w)
{
    static const int32_t coordinates[] = {SE3D_JOINT_COORDINATE_ANGLE,
                                          SE3D_JOINT_COORDINATE_DISPLACEMENT};
    se3d_effort_def def = se3d_effort_def_default();
    se3d_force force;
    for (int k = 0; k < 2 * w->joint_count; ++k) {
        def.joint = w->joints[k / 2];
        def.coordinate = coordinates[k % 2];
        if (se3d_force_create_effort(system, &def, &force) >= 0) {
            return 1;
        }
    }
    return 0;
}

/* How far the bodies of two systems are apart, and their velocities. */
static double compare_worlds(const tree_world *w, const se3d_system *other)
{
    double largest = 0.0;
    for (int k = 1; k < w->count; ++k) {
        const se3di_frame *a = &w->system->model.frames[k], *b = &other->model.frames[k];
        for (int c = 0; c < 3; ++c) {
            largest = fmax(largest, fabs(a->r[c] - b->r[c]) + fabs(a->p[c] - b->p[c]));
            largest = fmax(largest, fabs(a->v[c] - b->v[c]) + fabs(a->w[c] - b->w[c]));
        }
    }
    return largest;
}

/* A force element, though it does nothing, has the stages computed one after the other, and the
 * scale of errors found from the frames of bodies, which is rounded otherwise. */
static void stages_in_lanes_are_those_one_by_one(void)
{
    int compared = 0;
    for (uint64_t seed = 0; seed < 24; ++seed) {
        tree_world w;
        se3d_system *other;
        const double tolerance = seed % 4 < 2 ? 1e-4 : 1e-8;
        const int32_t order = seed % 2 ? 8 : 16;
        make_bare(&w, seed);
        CHECK(!se3d_system_clone(w.system, &other));
        const int differs = add_effort(other, &w);
        compared += differs;
        CHECK(run_bare(w.system, order, tolerance) == run_bare(other, order, tolerance));
        CHECK(!(compare_worlds(&w, other) > 1e-10));
        se3d_system_destroy(other);
        tree_world_destroy(&w);
    }
    CHECK(compared > 15);
}

int main(void)
{
    RUN(errors_follow_the_tolerance_and_few_steps_are_rejected);
    RUN(errors_follow_the_tolerance_on_random_trees);
    RUN(a_loose_tolerance_takes_few_steps);
    RUN(freedoms_and_tolerance_choose_the_stages);
    RUN(steps_back_lead_to_where_it_came_from);
    RUN(the_energy_does_not_drift);
    RUN(a_step_that_does_not_converge_is_refused);
    RUN(a_stiff_motion_is_told_of_once);
    RUN(stages_in_lanes_are_those_one_by_one);
    return check_finish();
}
