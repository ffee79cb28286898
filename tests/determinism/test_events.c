/* SPDX-License-Identifier: BSD-3-Clause */
/* Looking for events changes no bit of the motion; the events themselves have the same bits from
 * run to run, from snapshots, and however often the run is interrupted. */
#include "check.h"
#include "support/analyses.h"
#include "support/counting.h"
#include "support/models.h"

/* What a getter tells of the first body. */
static se3d_status get_of_body(const se3d_system *system,
                               se3d_status (*get)(const se3d_system *, se3d_body, double *),
                               double x[3])
{
    se3d_body body;
    const se3d_status status = se3d_system_get_body(system, 1, &body);
    return status < 0 ? status : get(system, body, x);
}

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3] = {0.0, 0.0, 0.0};
    const se3d_status status = get_of_body(system, se3d_body_get_position, r);
    (void)ctx;
    *value = r[2] + 0.5 * r[1] + 0.25 * r[0];
    return status;
}

static se3d_status get_spin(void *ctx, const se3d_system *system, double *value)
{
    double a[3] = {0.0, 0.0, 0.0};
    const se3d_status status = get_of_body(system, se3d_body_get_angular_acceleration, a);
    (void)ctx;
    *value = a[0] + a[1] + a[2];
    return status;
}

/* Levels through which the motion of every row goes: between the values at its beginning and end.
 * */
typedef struct levels {
    double height[3], spin;
} levels;

static void add(se3d_solver *solver, se3d_event_value value, double level, int32_t action)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.value = value;
    def.level = level;
    def.action = action;
    def.motion_only = value == get_height;
    CHECK(se3d_event_create(solver, &def, &event) == SE3D_OK);
}

static void add_all(se3d_solver *solver, const levels *l, int32_t action)
{
    for (int k = 0; k < 3; ++k) {
        add(solver, get_height, l->height[k], action);
    }
    add(solver, get_spin, l->spin, action);
}

static se3d_solver *make_solver(se3d_system *system, const support_analysis *row,
                                int32_t formulation, double tolerance)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.analysis = row->analysis;
    def.formulation = formulation;
    def.method = row->method;
    def.step = tolerance > 0.0 ? 0.0 : row->step;
    def.tolerance = tolerance;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    return solver;
}

static levels find_levels(const support_analysis *row, int32_t formulation, double tolerance)
{
    support_model model;
    double h[2] = {0.0, 0.0}, s[2] = {0.0, 0.0};
    support_model_make(&model, row->mechanism, row->count);
    se3d_solver *solver = make_solver(model.system, row, formulation, tolerance);
    for (int k = 0; k < 2; ++k) {
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, k * row->t_end)));
        get_height(NULL, model.system, &h[k]);
        get_spin(NULL, model.system, &s[k]);
    }
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return (levels){{h[0], 0.7 * h[0] + 0.3 * h[1], 0.4 * h[0] + 0.6 * h[1]},
                    0.55 * s[0] + 0.45 * s[1]};
}

/* All bits of a run with its outputs, and of its events. */
typedef struct bits {
    uint64_t hash, steps, events;
    size_t count;
} bits;

static uint64_t mix(uint64_t hash, double number)
{
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    return (hash ^ word) * UINT64_C(1099511628211) + (hash >> 29);
}

static bits end(se3d_system *system, se3d_solver *solver, bits b)
{
    se3d_solver_stats stats;
    CHECK(se3d_solver_get_stats(solver, &stats) == SE3D_OK);
    b.steps = stats.steps + 1000 * stats.iterations + 1000000 * stats.rejected;
    b.count = se3d_solver_count_event_records(solver);
    for (size_t k = 0; k < b.count; ++k) {
        se3d_event_record record;
        CHECK(se3d_solver_get_event_record(solver, k, &record) == SE3D_OK);
        b.events = mix(mix(b.events, record.time), record.value);
    }
    (void)system;
    return b;
}

enum { PARTS = 12 };

static bits run_parts(const support_analysis *row, int32_t formulation, double tolerance,
                      const levels *l, int32_t action)
{
    support_model model;
    bits b = {0, 0, 0, 0};
    support_model_make(&model, row->mechanism, row->count);
    se3d_solver *solver = make_solver(model.system, row, formulation, tolerance);
    if (l) {
        add_all(solver, l, action);
    }
    for (int k = 1; k <= PARTS; ++k) {
        se3d_status status;
        do {
            status = se3d_solver_run(solver, row->t_end * k / PARTS);
        } while (status == SE3D_INFO_EVENT);
        if (status < 0) {
            fprintf(stderr, "%s: %s\n", row->mechanism, se3d_system_get_error(model.system));
        }
        CHECK(status >= 0);
        b.hash = b.hash * 31 + se3d_system_hash(model.system);
    }
    b = end(model.system, solver, b);
    se3d_solver_destroy(solver);
    support_model_destroy(&model);
    return b;
}

static int has_motion(const support_analysis *row)
{
    return row->analysis != SE3D_ANALYSIS_ASSEMBLY;
}

/* With step control where the method has it, then with fixed steps. */
static double tolerance_of(size_t k)
{
    return k % 4 < 2 ? 1e-7 : 0.0;
}

/* Each tolerance in one formulation, or with SE3D_LONG in both. */
static int is_wanted(size_t k)
{
    return check_is_long() || k % 4 == 0 || k % 4 == 3;
}

static int has_dense_output(const support_analysis *row)
{
    return row->analysis == SE3D_ANALYSIS_DYNAMICS &&
           (row->method == SE3D_METHOD_AUTO || row->method == SE3D_METHOD_DOP853 ||
            row->method == SE3D_METHOD_RK45 || row->method == SE3D_METHOD_RADAU ||
            row->method == SE3D_METHOD_BDF);
}

static void looking_for_events_changes_no_bit_of_the_motion(void)
{
    for (size_t k = 0; k < 4 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 4];
        const int32_t formulation = (int32_t)(k % 2);
        const double tolerance = tolerance_of(k);
        if (!has_motion(row) || !is_wanted(k)) {
            continue;
        }
        const levels l = find_levels(row, formulation, tolerance);
        const bits plain = run_parts(row, formulation, tolerance, NULL, 0);
        const bits first = run_parts(row, formulation, tolerance, &l, SE3D_EVENT_RECORD);
        const bits again = run_parts(row, formulation, tolerance, &l, SE3D_EVENT_RECORD);
        CHECK(plain.count == 0 && first.count >= 3);
        if (plain.hash != first.hash) {
            fprintf(stderr, "row %zu: %s\n", k, row->mechanism);
        }
        CHECK(plain.hash == first.hash && plain.steps == first.steps);
        CHECK(again.hash == first.hash && again.events == first.events);
        if (has_dense_output(row)) { /* a stop moves nothing either */
            const bits stops = run_parts(row, formulation, tolerance, &l, SE3D_EVENT_STOP);
            CHECK(stops.hash == plain.hash && stops.steps == plain.steps);
            CHECK(stops.count == first.count && stops.events == first.events);
        }
    }
}

/* The second half again from a snapshot, by the same solver and by a new one. */
static void events_after_a_snapshot_have_the_same_bits(void)
{
    for (size_t k = 0; k < 4 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 4];
        const int32_t formulation = (int32_t)(k % 2);
        const double tolerance = tolerance_of(k);
        support_model model;
        se3d_snapshot *snapshot = NULL;
        bits pass[3];
        if (!has_motion(row) || !is_wanted(k)) {
            continue;
        }
        const levels l = find_levels(row, formulation, tolerance);
        support_model_make(&model, row->mechanism, row->count);
        se3d_solver *solver = make_solver(model.system, row, formulation, tolerance);
        se3d_solver *fresh = make_solver(model.system, row, formulation, tolerance);
        add_all(solver, &l, SE3D_EVENT_RECORD);
        add_all(fresh, &l, SE3D_EVENT_RECORD);
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.21 * row->t_end)));
        CHECK(se3d_snapshot_create(model.system, &snapshot) == SE3D_OK);
        for (int n = 0; n < 3; ++n) {
            se3d_solver *used = n < 2 ? solver : fresh;
            CHECK(se3d_snapshot_restore(snapshot, model.system) == SE3D_OK);
            se3d_solver_clear_event_records(used);
            CHECK(!SE3D_FAILED(se3d_solver_run(used, row->t_end)));
            pass[n] = end(model.system, used, (bits){se3d_system_hash(model.system), 0, 0, 0});
            CHECK(pass[n].count >= 1);
            if (n < 2 || row->analysis == SE3D_ANALYSIS_DYNAMICS) { /* others begin anew */
                CHECK(pass[n].hash == pass[0].hash && pass[n].events == pass[0].events);
            }
        }
        se3d_snapshot_destroy(snapshot);
        se3d_solver_destroy(solver);
        se3d_solver_destroy(fresh);
        support_model_destroy(&model);
    }
}

static void steady_steps_with_events_allocate_nothing(void)
{
    for (size_t k = 0; k < 4 * SUPPORT_ANALYSES; ++k) {
        const support_analysis *row = &support_analyses[k / 4];
        support_counting counting = {0};
        se3d_allocator allocator = support_counting_allocator(&counting);
        support_plan plan;
        support_model model;
        if (!has_motion(row)) {
            continue;
        }
        support_plan_make(&plan, row->mechanism, row->count);
        CHECK(support_model_create(&model, &plan, &allocator, 0) == SE3D_OK);
        support_plan_destroy(&plan);
        se3d_solver *solver = make_solver(model.system, row, (int32_t)(k % 2), tolerance_of(k));
        add(solver, get_height, 1e3, SE3D_EVENT_RECORD);
        add(solver, get_spin, 1e9, SE3D_EVENT_STOP);
        CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.1 * row->t_end)));
        counting.calls = 0;
        for (int n = 11; n <= 100; ++n) {
            CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.01 * n * row->t_end)));
        }
        CHECK(counting.calls == 0);
        CHECK(se3d_solver_count_event_records(solver) == 0);
        se3d_solver_destroy(solver);
        support_model_destroy(&model);
    }
}

int main(void)
{
    RUN(looking_for_events_changes_no_bit_of_the_motion);
    RUN(events_after_a_snapshot_have_the_same_bits);
    RUN(steady_steps_with_events_allocate_nothing);
    return check_finish();
}
