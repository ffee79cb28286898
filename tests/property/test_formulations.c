/* SPDX-License-Identifier: BSD-3-Clause */
/* r-p and r-omega give the same motion, accelerations and reactions for every example model:
 * over its whole duration, to 1e-10 of the largest value of each quantity. Dynamics runs dop853
 * with a tight tolerance; where bodies touch, with 1e-7 and to 1e-5. */
#define _POSIX_C_SOURCE 200809L

#include "model/model.h"
#include "se3d/io.h"
#include "support/examples.h"
#include "system/system_internal.h"

enum { SAMPLES = 25, PER_BODY = 19, PER_CONSTRAINT = 6 };

/* The columns of one run, [SAMPLES * width]. */
typedef struct record {
    double *values;
    size_t width, bodies;
    double bound; /* of the relative difference */
    se3d_status status;
    char message[200];
} record;

static void observe(const se3d_system *system, double *row)
{
    const se3di_model *model = &system->model;
    for (size_t k = 1; k < model->body_slots.count; ++k, row += PER_BODY) {
        const se3di_frame *frame = &model->frames[k];
        memcpy(row, frame->r, 3 * sizeof *row);
        for (int c = 0; c < 4; ++c) { /* p and -p are one orientation */
            int largest = 0;
            for (int e = 1; e < 4; ++e) {
                largest = fabs(frame->p[e]) > 0.1 + fabs(frame->p[largest]) ? e : largest;
            }
            row[3 + c] = frame->p[largest] < 0.0 ? -frame->p[c] : frame->p[c];
        }
        memcpy(row + 7, frame->v, 3 * sizeof *row);
        memcpy(row + 10, frame->w, 3 * sizeof *row);
        memcpy(row + 13, model->acceleration + 6 * k, 6 * sizeof *row);
    }
    for (uint32_t k = 0; k < model->constraint_slots.count; ++k, row += PER_CONSTRAINT) {
        se3di_handle handle = se3di_slots_handle(&model->constraint_slots, k);
        se3d_constraint constraint = {handle.index1, handle.generation};
        CHECK(!se3d_constraint_get_reaction(system, constraint, row, row + 3));
    }
}

/* Stops, or controllers with limits. */
static int has_kinks(const se3di_model *model)
{
    int found = model->state_count > 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        found |= model->forces[k].type == SE3DI_FORCE_STOP;
    }
    return found;
}

/* In joint coordinates the steps are others. Those of r-omega alone, of other lengths, differ as
 * much where forces have a kink: 1e-6 in quarter_car, which has a stop; 5e-4 in the angular
 * acceleration of incline between the tolerances 1e-7 and 1.1e-7. */
static double bound_of(const se3di_model *model, int touches, int32_t formulation)
{
    if (formulation != SE3D_FORMULATION_JOINT) {
        return touches ? 1e-5 : 1e-10;
    }
    return touches ? 1e-3 : has_kinks(model) ? 1e-6 : 1e-10;
}

static int is_dynamics(const char *type)
{
    return strcmp(type, "dynamics") == 0;
}

/* Run analysis `index` of a model in one formulation. */
static void run(const char *path, size_t index, int32_t formulation, record *out)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_solver *solver = NULL;
    se3d_model_analysis analysis;
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(se3d_model_read_file(path, NULL, &model, &error) == SE3D_OK);
    se3d_system *system = se3d_model_get_system(model);
    CHECK(!se3d_model_get_analysis(model, index, &analysis));
    CHECK(!se3d_model_get_solver(model, index, &def));
    def.formulation = formulation;
    double duration = analysis.duration;
    /* stiff friction holds explicit steps down if bodies touch */
    const int touches = is_dynamics(analysis.type) && system->model.shape_slots.count > 0 &&
                        !strstr(path, "breaking_chain");
    if (is_dynamics(analysis.type)) {
        def.method = SE3D_METHOD_DOP853;
        def.step = 0.0;
        def.tolerance = touches ? 1e-7 : 1e-12;
    }
    out->bound = bound_of(&system->model, touches, formulation);
    out->width = PER_BODY * (system->model.body_slots.count - 1) +
                 PER_CONSTRAINT * system->model.constraint_slots.count;
    out->bodies = system->model.body_slots.count - 1;
    out->values = calloc(SAMPLES * (out->width + 1), sizeof *out->values);
    out->status = se3d_solver_create(system, &def, &solver);
    double start = system->model.time;
    for (int k = 0; k < SAMPLES && out->status >= 0; ++k) {
        out->status = se3d_solver_run(solver, start + duration * k / (SAMPLES - 1));
        observe(system, out->values + (size_t)k * out->width);
    }
    snprintf(out->message, sizeof out->message, "%.199s", se3d_system_get_error(system));
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

/* The columns of one vector: begin and count. Returns where the next one begins. */
static size_t vector_at(size_t column, size_t bodies, size_t *count)
{
    static const size_t counts[6] = {3, 4, 3, 3, 3, 3};
    size_t body_columns = bodies * PER_BODY, within = column % PER_BODY, part = 0;
    *count = 3;
    if (column < body_columns) {
        for (size_t k = 0; k < within; k += counts[part++]) {
        }
        *count = counts[part];
    }
    return column + *count;
}

static double largest(const record *a, size_t column, size_t count)
{
    double value = 0.0;
    for (size_t k = 0; k < SAMPLES; ++k) {
        for (size_t c = column; c < column + count; ++c) {
            value = fmax(value, fabs(a->values[k * a->width + c]));
        }
    }
    return value;
}

/* The largest component of this kind of vector of any body. */
static double largest_of_kind(const record *a, size_t column, size_t count)
{
    double value = 0.0;
    for (size_t k = 0; k < a->bodies && column < a->bodies * PER_BODY; ++k) {
        value = fmax(value, largest(a, k * PER_BODY + column % PER_BODY, count));
    }
    return value;
}

/* Every vector is measured by its largest component in the run; one that vanishes by those of the
 * other bodies, torques by forces too (on 1 m). */
static void compare(const record *a, const record *b, const char *name)
{
    double worst = 0.0;
    size_t bad = 0, count, next, where = 0;
    for (size_t column = 0; column < a->width; column = next) {
        next = vector_at(column, a->bodies, &count);
        double scale = fmax(1e-2, largest(a, column, count)), off = 0.0;
        scale = fmax(scale, 1e-2 * largest_of_kind(a, column, count));
        if (column >= a->bodies * PER_BODY && (column - a->bodies * PER_BODY) % 6 == 3) {
            scale = fmax(scale, largest(a, column - 3, 3));
        }
        for (size_t k = 0; k < SAMPLES; ++k) {
            for (size_t c = column; c < next; ++c) {
                double gap = fabs(a->values[k * a->width + c] - b->values[k * b->width + c]);
                off = gap <= off ? off : gap;
            }
        }
        bad += !(off / scale <= b->bound);
        where = off / scale <= worst ? where : column;
        worst = off / scale <= worst ? worst : off / scale;
    }
    printf("%-44s %3zu columns, worst %.1e (column %zu)\n", name, a->width, worst, where);
    CHECK(bad == 0);
}

static void compare_analysis(const char *path, const char *name, size_t index, const char *type)
{
    record romega = {0};
    char label[120];
    run(path, index, SE3D_FORMULATION_ROMEGA, &romega);
    for (int32_t k = SE3D_FORMULATION_RP; k <= SE3D_FORMULATION_JOINT; ++k) {
        record other = {0};
        snprintf(label, sizeof label, "%.80s %s %s", name, type, se3d_formulation_get_name(k));
        run(path, index, k, &other);
        CHECK((romega.status < 0) == (other.status < 0));
        if (romega.status < 0 || other.status < 0) {
            printf("%-34s skipped: %s\n", label, romega.message);
        } else {
            compare(&romega, &other, label);
        }
        free(other.values);
    }
    free(romega.values);
}

static int compare_model(const char *path, const char *name)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    int compared = 0;
    if (se3d_model_read_file(path, NULL, &model, &error) < 0) {
        printf("%-34s skipped: %.100s\n", name, error.message);
        return 0;
    }
    for (size_t k = 0; k < se3d_model_count_analyses(model); ++k) {
        se3d_model_analysis analysis;
        CHECK(!se3d_model_get_analysis(model, k, &analysis));
        if (strcmp(analysis.type, "modes") == 0) {
            printf("%-34s skipped: modes have one formulation\n", name);
        } else if (strcmp(analysis.type, "dynamics") == 0 && support_is_chaotic_example(model, k)) {
            printf("%-34s skipped: grains that roll over each other and heaps are chaotic\n", name);
        } else {
            compare_analysis(path, name, k, analysis.type);
            ++compared;
        }
    }
    se3d_model_destroy(model);
    return compared;
}

static void all_formulations_agree_on_every_example(void)
{
    CHECK(support_visit_examples(compare_model) >= 16);
}

/* The four-bar that folds flat: a parallelogram, so that the angle alpha of its links obeys
 * alpha'' = -11.772 cos(alpha) /s^2. At the distance s = |sin alpha| from flat, rounding u of the
 * positions is u/s across the motion, u/s^2 in the velocities, u/s^3 in the accelerations and u/s^4
 * in the reactions of whoever computes them from positions: the bounds follow that. */
static double measure_flat(const se3d_system *system, double *speed, double *acceleration)
{
    const se3di_frame *left = &system->model.frames[1];
    double s = fabs(left->r[1]) / hypot(left->r[0], left->r[1]);
    *speed = 1.0 + 2.0 * 11.772 * (1.0 - left->r[1] / 0.5) - left->w[2] * left->w[2];
    *acceleration = system->model.acceleration[6 + 5] + 11.772 * left->r[0] / 0.5;
    return s;
}

static void near_flat_positions_only_rounding_is_magnified(void)
{
    const char *root = getenv("SE3D_SOURCE_DIR");
    char path[700];
    snprintf(path, sizeof path, "%.500s/examples/models/fourbar.yaml", root ? root : ".");
    for (int32_t formulation = 0; formulation < 3; ++formulation) {
        se3d_model *model = NULL;
        se3d_model_error error;
        se3d_solver *solver = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        int near = 0;
        def.analysis = SE3D_ANALYSIS_DYNAMICS;
        def.formulation = formulation;
        def.method = SE3D_METHOD_DOP853;
        def.tolerance = 1e-12;
        CHECK(se3d_model_read_file(path, NULL, &model, &error) == SE3D_OK);
        se3d_system *system = se3d_model_get_system(model);
        CHECK(!se3d_solver_create(system, &def, &solver));
        for (int k = 1; k <= 1000; ++k) {
            double speed, acceleration;
            CHECK(se3d_solver_run(solver, 0.01 * k) >= 0);
            double s = measure_flat(system, &speed, &acceleration);
            CHECK_NEAR(speed, 0.0, 1e-10 + 3e-14 / (s * s));
            CHECK_NEAR(acceleration, 0.0, 1e-10 + 1e-13 / (s * s * s));
            near += s < 0.1;
        }
        CHECK(near > 20);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

int main(void)
{
    RUN(near_flat_positions_only_rounding_is_magnified);
    RUN(all_formulations_agree_on_every_example);
    return check_finish();
}
