/* SPDX-License-Identifier: BSD-3-Clause */
/* Every example that moves, at its defaults: no method, tolerance or step given, against the same
 * model at a tight tolerance. The gap is at most 1e-5 of the largest value of each column.
 *
 * Left out: particle sets and heaps, whose motion is chaotic (golden.granular_examples,
 * golden.example_models), and kinematics and inverse dynamics, which solve each output by itself.
 */
#define _POSIX_C_SOURCE 200809L

#include "support/examples.h"
#include "support/text_model.h"

enum { SAMPLES = 40, COLUMNS_MAX = 200 };

typedef struct table {
    double value[SAMPLES + 1][COLUMNS_MAX];
    char name[COLUMNS_MAX][80];
    int columns;
} table;

/* Examples that need another reference: stiff ones, and contacts that slip and stick, whose springs
 * are of the ends of steps: these must be short (`step`: the longest one, 0: any). At the defaults
 * a spring may be off by the tolerance times the length of the model when it begins to stick: what
 * the box on the incline dissipates was found off by 1e-5 to 4e-4 of it, by where its steps end. */
static const struct special {
    const char *name;
    int32_t method;
    int32_t reserved;
    double tolerance, step, accuracy;
} specials[] = {
    {"", SE3D_METHOD_DOP853, 0, 1e-11, 0.0, 1e-5},
    {"suspension_kerb.yaml", SE3D_METHOD_RADAU, 0, 1e-9, 0.0, 1e-5},
    {"incline.yaml", SE3D_METHOD_DOP853, 0, 1e-8, 3e-5, 1e-3},
};

static const struct special defaults = {"", SE3D_METHOD_AUTO, 0, 0.0, 0.0, 0.0};

static const struct special *special_of(const char *name)
{
    for (size_t k = 1; k < sizeof specials / sizeof *specials; ++k) {
        if (strcmp(specials[k].name, name) == 0) {
            return &specials[k];
        }
    }
    return &specials[0];
}

static void sample(const se3d_model *model, table *t, int row)
{
    t->columns = 0;
    for (size_t output = 0; output < se3d_model_count_outputs(model); ++output) {
        se3d_model_output about;
        CHECK(!se3d_model_get_output(model, output, &about));
        for (size_t k = 0; k < about.channel_count; ++k) {
            const char *name;
            double value[4];
            size_t width = 0;
            CHECK(!se3d_model_get_channel(model, output, k, &name));
            if (strncmp(name, "violation", 9) == 0 || strcmp(name, "steps") == 0 ||
                strcmp(name, "iterations") == 0 || strcmp(name, "energy.balance") == 0) {
                continue; /* of the method */
            }
            CHECK(!se3d_model_get_channel_value(model, output, k, NULL, value, &width));
            for (size_t c = 0; c < width && t->columns < COLUMNS_MAX; ++c) {
                snprintf(t->name[t->columns], sizeof t->name[0], "%.70s[%d]", name, (int)c);
                t->value[row][t->columns++] = value[c];
            }
        }
    }
}

/* The analyses before the one at `index` as they are, that one as `how` says. */
static void run_model(const char *path, size_t index, const struct special *how, table *t)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    CHECK(!se3d_model_read_file(path, NULL, &model, &error));
    double begin = 0.0;
    for (size_t k = 0; k <= index; ++k) {
        se3d_model_analysis analysis;
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        CHECK(!se3d_model_get_analysis(model, k, &analysis));
        if (strcmp(analysis.type, "modes") == 0) {
            continue;
        }
        CHECK(!se3d_model_get_solver(model, k, &def));
        if (k == index) {
            def.method = how->method;
            def.tolerance = how->tolerance;
            def.step = how->step;
        }
        CHECK(!se3d_solver_create(se3d_model_get_system(model), &def, &solver));
        begin = isnan(analysis.start) ? begin : analysis.start;
        for (int row = 0; row <= SAMPLES; ++row) {
            const double end = begin + (k == index ? analysis.duration * row / SAMPLES : 0.0);
            const se3d_status status = se3d_solver_run(solver, end);
            CHECK(status >= 0);
            if (status < 0) {
                fprintf(stderr, "%s\n", se3d_system_get_error(se3d_model_get_system(model)));
                break;
            }
            sample(model, t, row);
            if (k < index) {
                break;
            }
        }
        begin += k == index ? 0.0 : analysis.duration;
        se3d_solver_destroy(solver);
    }
    se3d_model_destroy(model);
}

static double compare(const char *name, const table *a, const table *b, double accuracy)
{
    double worst = 0.0;
    for (int c = 0; c < a->columns; ++c) {
        double largest = 0.0, gap = 0.0;
        for (int row = 0; row <= SAMPLES; ++row) {
            largest = fmax(largest, fabs(b->value[row][c]));
            gap = fmax(gap, fabs(a->value[row][c] - b->value[row][c]));
        }
        if (gap > accuracy * largest && largest > 1e-9) {
            fprintf(stderr, "  %s: %s off by %.1e of %.3g\n", name, a->name[c], gap / largest,
                    largest);
        }
        worst = fmax(worst, largest > 1e-9 ? gap / largest : 0.0);
    }
    return worst;
}

static int check_example(const char *path, const char *name)
{
    static table got, truth;
    const struct special *special = special_of(name);
    se3d_model *model = NULL;
    se3d_model_error error;
    int compared = 0;
    if (se3d_model_read_file(path, NULL, &model, &error) < 0) {
        return 0;
    }
    for (size_t k = 0; k < se3d_model_count_analyses(model); ++k) {
        se3d_model_analysis analysis;
        CHECK(!se3d_model_get_analysis(model, k, &analysis));
        if (strcmp(analysis.type, "dynamics") == 0 && !support_is_chaotic_example(model, k)) {
            run_model(path, k, &defaults, &got);
            run_model(path, k, special, &truth);
            const double worst = compare(name, &got, &truth, special->accuracy);
            printf("%-30s %.1e\n", name, worst);
            CHECK(worst <= special->accuracy);
            ++compared;
        }
    }
    se3d_model_destroy(model);
    return compared;
}

static void every_example_is_right_at_its_defaults(void)
{
    CHECK(support_visit_examples(check_example) >= 15);
}

int main(void)
{
    RUN(every_example_is_right_at_its_defaults);
    return check_finish();
}
