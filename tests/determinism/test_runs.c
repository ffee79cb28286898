/* SPDX-License-Identifier: BSD-3-Clause */
/* The same bits from run to run, on a clone and from a snapshot; the same physics however the
 * bodies are numbered. */
#include "check.h"
#include "support/analyses.h"
#include "support/models.h"

static void run_to(se3d_system *system, const support_analysis *row, int32_t formulation, double t)
{
    se3d_solver *solver = NULL;
    CHECK(support_solver_create(system, row, formulation, &solver) == SE3D_OK);
    se3d_status status = se3d_solver_run(solver, t);
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", row->mechanism, se3d_system_get_error(system));
    }
    CHECK(status >= 0);
    se3d_solver_destroy(solver);
}

/* In two parts, as all runs here, so that their steps are the same. */
static uint64_t run_whole(const support_analysis *row, int32_t formulation)
{
    support_model model;
    support_model_make(&model, row->mechanism, row->count);
    uint64_t start = se3d_system_hash(model.system);
    run_to(model.system, row, formulation, 0.5 * row->t_end);
    uint64_t middle = se3d_system_hash(model.system);
    run_to(model.system, row, formulation, row->t_end);
    uint64_t hash = se3d_system_hash(model.system);
    CHECK(start != middle && middle != hash);
    support_model_destroy(&model);
    return hash;
}

static void every_run_gives_the_same_bits(void)
{
    for (size_t k = 0; k < SUPPORT_ANALYSES; ++k) {
        for (int32_t formulation = 0; formulation < 3; ++formulation) {
            uint64_t first = run_whole(&support_analyses[k], formulation);
            CHECK(first == run_whole(&support_analyses[k], formulation));
        }
        CHECK(run_whole(&support_analyses[k], 0) != run_whole(&support_analyses[k], 1));
    }
}

static support_model run_half(const support_analysis *row, int32_t formulation)
{
    support_model model;
    support_model_make(&model, row->mechanism, row->count);
    run_to(model.system, row, formulation, 0.5 * row->t_end);
    return model;
}

static void clones_continue_with_the_same_bits(void)
{
    for (size_t k = 0; k < 3 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 3];
        int32_t formulation = (int32_t)(k % 3);
        se3d_system *clone = NULL;
        support_model model = run_half(row, formulation);
        CHECK(se3d_system_clone(model.system, &clone) == SE3D_OK);
        CHECK(se3d_system_hash(clone) == se3d_system_hash(model.system));
        run_to(clone, row, formulation, row->t_end);
        CHECK(se3d_system_hash(clone) == run_whole(row, formulation));
        CHECK(se3d_system_hash(clone) != se3d_system_hash(model.system));
        run_to(model.system, row, formulation, row->t_end);
        CHECK(se3d_system_hash(clone) == se3d_system_hash(model.system));
        se3d_system_destroy(clone);
        support_model_destroy(&model);
    }
}

static void snapshots_continue_with_the_same_bits(void)
{
    for (size_t k = 0; k < 3 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 3];
        int32_t formulation = (int32_t)(k % 3);
        se3d_snapshot *snapshot = NULL;
        support_model model = run_half(row, formulation);
        uint64_t middle = se3d_system_hash(model.system);
        CHECK(se3d_snapshot_create(model.system, &snapshot) == SE3D_OK);
        for (int pass = 0; pass < 2; ++pass) {
            run_to(model.system, row, formulation, row->t_end);
            CHECK(se3d_system_hash(model.system) == run_whole(row, formulation));
            CHECK(se3d_snapshot_restore(snapshot, model.system) == SE3D_OK);
            CHECK(se3d_system_hash(model.system) == middle);
        }
        se3d_snapshot_destroy(snapshot);
        support_model_destroy(&model);
    }
}

/* A snapshot in the middle of one solver's run: the solver itself must not carry state. */
static void solvers_carry_no_state_of_their_own(void)
{
    for (size_t k = 0; k < 3 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 3];
        support_model model;
        se3d_snapshot *snapshot = NULL;
        se3d_solver *solver = NULL;
        uint64_t hash[2];
        support_model_make(&model, row->mechanism, row->count);
        CHECK(support_solver_create(model.system, row, (int32_t)(k % 2), &solver) == SE3D_OK);
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.3 * row->t_end)));
        CHECK(se3d_snapshot_create(model.system, &snapshot) == SE3D_OK);
        for (int pass = 0; pass < 2; ++pass) {
            for (int step = 0; step < 20; ++step) {
                CHECK(!SE3D_FAILED(se3d_solver_step(solver, row->step > 0.0 ? row->step : 0.01)));
            }
            hash[pass] = se3d_system_hash(model.system);
            CHECK(se3d_snapshot_restore(snapshot, model.system) == SE3D_OK);
        }
        CHECK(hash[0] == hash[1]);
        se3d_snapshot_destroy(snapshot);
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

/* Relative to the largest value of its kind. */
static void check_same_motion(const support_model *a, const support_model *b, double tolerance)
{
    for (int k = 0; k < a->body_count; ++k) {
        double x[2][3], v[2][3], w[2][3], scale = 1.0;
        for (int side = 0; side < 2; ++side) {
            const support_model *model = side ? b : a;
            CHECK(!se3d_body_get_position(model->system, model->bodies[k], x[side]));
            CHECK(!se3d_body_get_velocity(model->system, model->bodies[k], v[side]));
            CHECK(!se3d_body_get_angular_velocity(model->system, model->bodies[k], w[side]));
        }
        for (int c = 0; c < 3; ++c) {
            scale = fmax(scale, fmax(fabs(v[0][c]), fabs(w[0][c])));
        }
        for (int c = 0; c < 3; ++c) {
            CHECK_NEAR(x[0][c], x[1][c], tolerance);
            CHECK_NEAR(v[0][c], v[1][c], tolerance * scale);
            CHECK_NEAR(w[0][c], w[1][c], tolerance * scale);
        }
    }
}

static void check_same_reactions(const support_model *a, const support_model *b, double tolerance)
{
    double scale = 1.0, wrench[2][6];
    for (int pass = 0; pass < 2; ++pass) { /* the scale first */
        for (int k = 0; k < a->joint_count; ++k) {
            for (int side = 0; side < 2; ++side) {
                const support_model *model = side ? b : a;
                CHECK(!se3d_constraint_get_reaction(model->system, model->joints[k], wrench[side],
                                                    wrench[side] + 3));
            }
            for (int c = 0; c < 6; ++c) {
                scale = fmax(scale, fabs(wrench[0][c]));
                if (pass == 1) {
                    CHECK_NEAR(wrench[0][c], wrench[1][c], tolerance * scale);
                }
            }
        }
    }
}

/* Numbering changes the order of sums, hence rounding, which the motion amplifies: analyses without
 * integration agree to 1e-12, integrations over a short time to 1e-9. Index-3 methods divide the
 * rounding of positions by the square of the step, and redundant rows (four_bar) amplify it. */
static void numbering_does_not_change_the_physics(void)
{
    for (size_t k = 0; k < 3 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 3];
        support_plan plan;
        support_model model[2];
        support_plan_make(&plan, row->mechanism, row->count);
        for (int reversed = 0; reversed < 2; ++reversed) {
            CHECK(support_model_create(&model[reversed], &plan, NULL, reversed) == SE3D_OK);
            run_to(model[reversed].system, row, (int32_t)(k % 2), row->t_end);
        }
        int integrates = row->analysis == SE3D_ANALYSIS_DYNAMICS;
        int redundant = strcmp(row->mechanism, "four_bar") == 0;
        double tolerance = redundant ? 3e-8 : 1e-9;
        check_same_motion(&model[0], &model[1], integrates ? tolerance : 1e-12);
        if (row->analysis != SE3D_ANALYSIS_KINEMATICS) {
            check_same_reactions(&model[0], &model[1], integrates ? 1e-5 : 1e-10);
        }
        for (int reversed = 0; reversed < 2; ++reversed) {
            support_model_destroy(&model[reversed]);
        }
        support_plan_destroy(&plan);
    }
}

int main(void)
{
    RUN(every_run_gives_the_same_bits);
    RUN(clones_continue_with_the_same_bits);
    RUN(snapshots_continue_with_the_same_bits);
    RUN(solvers_carry_no_state_of_their_own);
    RUN(numbering_does_not_change_the_physics);
    return check_finish();
}
