/* SPDX-License-Identifier: BSD-3-Clause */
/* What equal steps err by, as a run estimates it, against a run at a tight tolerance: of the same
 * order, and told to the log where it is much. */
#define _POSIX_C_SOURCE 200809L

#include "check.h"
#include "se3d/io.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 100, BODIES_MAX = 24, STATES_MAX = 8 };
enum { PLACE, SPEED, SPIN, STATE, KINDS };

#define FACTOR  10.0 /* of an estimate, up or down, */
#define NOTHING 1e-8 /* if it is not below this */

typedef struct rows {
    double r[ROWS + 1][3 * BODIES_MAX], v[ROWS + 1][3 * BODIES_MAX], w[ROWS + 1][3 * BODIES_MAX];
    double z[ROWS + 1][STATES_MAX];
    size_t bodies, states;
} rows;

typedef struct told {
    int count;
    char text[400];
} told;

static void tell(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    told *t = ctx;
    if (level == SE3D_LOG_WARNING && kind == SE3D_LOG_STEP && strstr(message, " err by about ")) {
        ++t->count;
        snprintf(t->text, sizeof t->text, "%s", message);
    }
}

static se3d_model *read_model(const char *name, const char *method, const char *step, told *log)
{
    const char *root = getenv("SE3D_SOURCE_DIR");
    char path[700];
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    se3d_model_options options = se3d_model_options_default();
    options.method = method;
    options.step = step;
    options.log = tell;
    options.log_ctx = log;
    snprintf(path, sizeof path, "%.500s/examples/models/%s.yaml", root ? root : ".", name);
    if (se3d_model_read_file(path, &options, &model, &error) < 0) {
        fprintf(stderr, "%s\n", error.message);
        exit(EXIT_FAILURE);
    }
    return model;
}

static void note_row(const se3d_system *system, rows *to, int row)
{
    to->bodies = se3d_system_count_bodies(system);
    to->states = se3d_system_count_states(system);
    CHECK(to->bodies <= BODIES_MAX && to->states <= STATES_MAX);
    CHECK(!se3d_body_get_all(system, to->bodies, to->r[row], NULL, to->v[row], to->w[row]));
    for (size_t k = 0; k < to->states; ++k) {
        se3d_state state;
        CHECK(!se3d_system_get_state(system, k, &state));
        CHECK(!se3d_state_get_value(system, state, SE3D_STATE_VALUE, &to->z[row][k]));
    }
}

/* The motion of the model's first analysis; by dop853 at 1e-10 if it is to be the true one. */
static void run_rows(const char *name, const char *method, const char *step, rows *to)
{
    told unused = {0};
    se3d_model *model = read_model(name, method, step, &unused);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_model_analysis analysis;
    se3d_solver *solver = NULL;
    CHECK(!se3d_model_get_analysis(model, 0, &analysis));
    CHECK(!se3d_model_get_solver(model, 0, &def));
    if (!method) {
        def.method = SE3D_METHOD_DOP853;
        def.step = 0.0;
        def.tolerance = 1e-10;
    }
    CHECK(!se3d_solver_create(se3d_model_get_system(model), &def, &solver));
    for (int row = 0; row <= ROWS; ++row) {
        CHECK(se3d_solver_run(solver, analysis.duration * row / ROWS) >= 0);
        note_row(se3d_model_get_system(model), to, row);
    }
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static double norm_of_gap(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* The largest errors, relative to the largest values. */
static void measure(const rows *got, const rows *truth, double error[KINDS])
{
    static const double zero[3];
    double gap[KINDS] = {0.0}, largest[KINDS] = {0.0};
    for (int row = 0; row <= ROWS; ++row) {
        for (size_t k = 0; k < 3 * truth->bodies; k += 3) {
            gap[PLACE] = fmax(gap[PLACE], norm_of_gap(got->r[row] + k, truth->r[row] + k));
            gap[SPEED] = fmax(gap[SPEED], norm_of_gap(got->v[row] + k, truth->v[row] + k));
            gap[SPIN] = fmax(gap[SPIN], norm_of_gap(got->w[row] + k, truth->w[row] + k));
            largest[PLACE] = fmax(largest[PLACE], norm_of_gap(truth->r[row] + k, truth->r[0] + k));
            largest[SPEED] = fmax(largest[SPEED], norm_of_gap(truth->v[row] + k, zero));
            largest[SPIN] = fmax(largest[SPIN], norm_of_gap(truth->w[row] + k, zero));
        }
    }
    for (size_t q = 0; q < STATE; ++q) {
        error[q] = largest[q] > 1e-9 ? gap[q] / largest[q] : 0.0;
    }
    error[STATE] = 0.0;
    for (size_t k = 0; k < truth->states; ++k) {
        double most = 1e-3, off = 0.0;
        for (int row = 0; row <= ROWS; ++row) {
            most = fmax(most, fabs(truth->z[row][k]));
            off = fmax(off, fabs(got->z[row][k] - truth->z[row][k]));
        }
        error[STATE] = fmax(error[STATE], off / most);
    }
}

/* What a run says of itself. */
static se3d_run_analysis estimate(const char *name, const char *method, const char *step, told *log)
{
    char folder[] = "/tmp/se3d-estimates-XXXXXX", command[80];
    se3d_run_options how = se3d_run_options_default();
    se3d_run_analysis done;
    se3d_run *run = NULL;
    se3d_model_error error = {0};
    se3d_model *model = read_model(name, method, step, log);
    CHECK(mkdtemp(folder) != NULL);
    how.directory = folder;
    how.estimate = 1;
    CHECK(se3d_model_run(model, &how, &run, &error) >= 0);
    CHECK(!se3d_run_get_analysis(run, 0, &done));
    CHECK(strcmp(done.unestimated, "") == 0);
    se3d_run_destroy(run);
    se3d_model_destroy(model);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    CHECK(system(command) == 0);
    done.unestimated = ""; /* it was the run's */
    return done;
}

static int is_over(void *ctx)
{
    int *left = ctx;
    return --*left < 0;
}

/* It ends within a step of the run or of the copy. */
static void an_interrupt_is_no_failure_of_steps(void)
{
    int within_copy = 0;
    for (int calls = 1; calls < 12; ++calls) {
        char folder[] = "/tmp/se3d-estimates-XXXXXX", command[80];
        int left = calls;
        told log = {0};
        se3d_run_options how = se3d_run_options_default();
        se3d_run_analysis done;
        se3d_run *run = NULL;
        se3d_model_error error = {0};
        se3d_model *model = read_model("fourbar", "rattle", "4e-3", &log);
        CHECK(mkdtemp(folder) != NULL);
        how.directory = folder;
        how.estimate = 1;
        how.interrupt = is_over;
        how.interrupt_ctx = &left;
        const se3d_status status = se3d_model_run(model, &how, &run, &error);
        CHECK(status == SE3D_ERR_INTERRUPTED || status >= 0);
        if (run && !se3d_run_get_analysis(run, 0, &done) && done.unestimated[0]) {
            CHECK(strcmp(done.unestimated, "the run was interrupted") == 0);
            ++within_copy;
        }
        se3d_run_destroy(run);
        se3d_model_destroy(model);
        snprintf(command, sizeof command, "rm -rf %s", folder);
        CHECK(system(command) == 0);
    }
    CHECK(within_copy > 0);
}

static void estimates_are_of_the_order_of_the_errors(void)
{
    static const struct {
        const char *name, *method, *step;
    } table[] = {{"fourbar", "generalized_alpha", "2e-3"},
                 {"fourbar", "rattle", "4e-3"},
                 {"bracket", "hht", "1e-3"},
                 {"bracket", "verlet", "5e-3"},
                 {"andrews", "rattle", "1e-3"},
                 {"andrews", "generalized_alpha", "1e-4"},
                 {"controller", "hht", "1e-3"},
                 {"controller", "verlet", "2e-3"},
                 {"double_pendulum", "rattle", "1e-3"},
                 {"servo", "generalized_alpha", "1e-3"},
                 {"tsda_mass", "verlet", "1e-2"},
                 {"quarter_car", "hht", "2e-3"},
                 {"bricard", "generalized_alpha", "1e-3"},
                 {"pendulum_events", "hht", "5e-3"},
                 {"fourbar", "convex", "4e-3"},
                 {"double_pendulum", "convex", "1e-3"},
                 {"servo", "convex", "1e-3"},
                 {"tsda_mass", "convex", "1e-3"},
                 {"controller", "convex", "1e-3"}};
    static rows got, truth;
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        static const char *const kinds[KINDS] = {"travel", "velocity", "spin", "state"};
        double error[KINDS];
        told log = {0};
        if (k == 0 || strcmp(table[k].name, table[k - 1].name) != 0) {
            run_rows(table[k].name, NULL, NULL, &truth);
        }
        run_rows(table[k].name, table[k].method, table[k].step, &got);
        measure(&got, &truth, error);
        const se3d_run_analysis done =
            estimate(table[k].name, table[k].method, table[k].step, &log);
        const double said[KINDS] = {done.error_position, done.error_velocity,
                                    done.error_angular_velocity, done.error_state};
        double most = 0.0;
        for (size_t q = 0; q < KINDS; ++q) {
            const int is_near =
                said[q] < FACTOR * error[q] + NOTHING && error[q] < FACTOR * said[q] + NOTHING;
            CHECK(is_near);
            if (!is_near) {
                fprintf(stderr, "  %s, %s: %s off by %.2e, %.2e is said\n", table[k].name,
                        table[k].method, kinds[q], error[q], said[q]);
            }
            most = fmax(most, said[q]);
        }
        most = fmax(most, done.error_work);
        CHECK(done.estimated_to > 0.0);
        CHECK((most > 1e-3) == (log.count == 1));
    }
}

int main(void)
{
    RUN(estimates_are_of_the_order_of_the_errors);
    RUN(an_interrupt_is_no_failure_of_steps);
    return check_finish();
}
