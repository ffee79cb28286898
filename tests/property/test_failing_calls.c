/* SPDX-License-Identifier: BSD-3-Clause */
/* Whatever function of the library fails within an analysis, once on each path of calls: the
 * analysis goes on by other means, or the state is the last good one, from which it goes on to
 * where it had come without the failure. */
#define _POSIX_C_SOURCE 200809L
#include "check.h"
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

/* @return as the run, which went on after a failure */
static se3d_status attempt(const support_analysis *row, size_t refused, pose poses[BODIES])
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    support_plan plan;
    support_model model;
    se3d_solver *solver = NULL;
    double time = 0.0;
    support_plan_make(&plan, row->mechanism, row->count);
    CHECK(support_model_create(&model, &plan, &allocator, 0) == SE3D_OK);
    CHECK(support_solver_create(model.system, row, SE3D_FORMULATION_ROMEGA, &solver) == SE3D_OK);
    memset(poses, 0, BODIES * sizeof *poses);
    calls.count = calls.reached = 0;
    calls.refused = refused;
    is_running = 1;
    const se3d_status status = se3d_solver_run(solver, row->t_end);
    is_running = 0;
    if (status < 0) {
        CHECK(refused > 0);
        CHECK(se3d_system_get_time(model.system, &time) == SE3D_OK && time <= row->t_end);
        CHECK(se3d_solver_run(solver, row->t_end) >= 0);
    }
    CHECK(se3d_system_get_time(model.system, &time) == SE3D_OK);
    for (int k = 0; k < model.body_count; ++k) {
        CHECK(se3d_body_get_position(model.system, model.bodies[k], poses[k].r) == SE3D_OK);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    support_plan_destroy(&plan);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
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

/* @return how many calls failed */
static size_t fail_each(const support_analysis *row)
{
    static size_t chosen[CALLS];
    static pose whole[BODIES], poses[BODIES];
    calls.looks = 1;
    calls.fresh_count = 0;
    forget_paths();
    CHECK(attempt(row, 0, whole) >= 0);
    calls.looks = 0;
    const size_t count = calls.fresh_count;
    memcpy(chosen, calls.fresh, count * sizeof *chosen);
    for (size_t k = 0; k < count; ++k) {
        const int before = check_failures;
        const se3d_status status = attempt(row, chosen[k], poses);
        CHECK(calls.reached == 1);
        CHECK_NEAR(distance(poses, whole), 0.0, 1e-4); /* other steps */
        if (check_failures > before) {
            fprintf(stderr, "%s, method %d, %s failed by %d: %d\n", row->mechanism,
                    (int)row->method, failing, (int)failure, (int)status);
        }
    }
    return count;
}

static void fail_all(se3d_status how)
{
    size_t sum = 0;
    failure = how;
    calls.depth = 3;
    for (size_t k = 0; k < SUPPORT_ANALYSES; ++k) {
        sum += fail_each(&support_analyses[k]);
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

static void a_call_that_is_interrupted_leaves_the_last_good_state(void)
{
    fail_all(SE3D_ERR_INTERRUPTED);
}

int main(void)
{
#ifdef SE3D_LETS_FAIL
    RUN(a_call_without_memory_leaves_the_last_good_state);
    RUN(a_call_that_does_not_converge_is_made_up_for_or_leaves_the_last_good_state);
    RUN(a_call_that_meets_no_number_is_made_up_for_or_leaves_the_last_good_state);
    RUN(a_call_that_is_interrupted_leaves_the_last_good_state);
    return check_finish();
#else
    puts("python3 was missing for the build");
    return 0;
#endif
}
