/* SPDX-License-Identifier: BSD-3-Clause */
/* `auto` moves by gauss what nothing but constant gravity acts on, if its stages can be lanes, and
 * makes single steps of it by dop853; all else moves by dop853. */
#include "check.h"
#include "support/models.h"
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

/* It is faster by what it was taken for: fewer steps, errors within the tolerance. */
static void the_motion_is_within_the_tolerance(void)
{
    static const struct {
        const char *mechanism;
        int count;
    } rows[] = {{"pendulum", 1}, {"heavy_top", 1}, {"four_bar", 1}, {"chain_ball", 4}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (double tolerance = 1e-3; tolerance > 1e-10; tolerance *= 1e-3) {
            double r[2][3];
            uint64_t steps[2];
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
                look(&model, r[m]);
                se3d_solver_destroy(solver);
                support_model_destroy(&model);
            }
            CHECK(part(r[0], r[1]) < tolerance);
            CHECK(steps[0] < steps[1]);
        }
    }
}

int main(void)
{
    RUN(it_depends_on_what_acts_and_on_the_loops);
    RUN(it_is_decided_again_when_the_structure_changes);
    RUN(steps_between_runs_are_made_by_dop853);
    RUN(the_motion_is_within_the_tolerance);
    return check_finish();
}
