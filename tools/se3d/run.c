/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d run MODEL: every analysis of a model, results into files. */
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interrupt.h"
#include "io/base/file.h"
#include "notes.h"
#include "options.h"
#include "outcome.h"
#include "pictures.h"
#include "print_rows.h"
#include "process.h"
#include "warnings.h"

#define EVERY_ROW 1e-9 /* s between checkpoints: less than a row takes */

static const char *outcome(const se3d_run_analysis *a)
{
    if (a->status < 0) {
        return "FAILED";
    }
    const int known = a->status == SE3D_INFO_UNSTABLE || a->status == SE3D_INFO_NEUTRAL;
    if (strcmp(a->type, "equilibrium") == 0 && !known) {
        return "the equilibrium is stable";
    }
    return se3d_status_get_text((se3d_status)a->status);
}

static const char *direction(const se3d_run_event *event)
{
    return event->direction > 0 ? "rising" : "falling";
}

/* The events of analysis `index`. */
static void print_events(const se3d_run *run, size_t index)
{
    size_t count = 0;
    for (size_t k = 0; k < se3d_run_count_events(run); ++k) {
        se3d_run_event event;
        if (SE3D_FAILED(se3d_run_get_event(run, k, &event)) || event.analysis != index) {
            continue;
        }
        ++count;
        if (event.stopped) {
            printf("  stopped by event %s at t = %.12g s: %s = %.9g, %s\n", event.name, event.time,
                   event.channel, event.value, direction(&event));
        }
    }
    if (count > 0) {
        fputs("  ", stdout);
        put_count(count, "event", "events", ", see events.csv\n");
    }
}

/* What of the given start did not fit. */
static void print_start(const se3d_run_analysis *a)
{
    const double *d = a->start_change;
    if (a->moved[0]) {
        printf(
            "  the given positions do not fit: moved by %.3g m and %.3g rad in all, body %s most, "
            "by %.3g m and %.3g rad\n",
            d[0], d[1], a->moved, d[4], d[5]);
    }
    if (a->deflected[0]) {
        printf(
            "  the given velocities do not fit: changed by %.3g m/s and %.3g rad/s in all, of body "
            "%s most, by %.3g m/s and %.3g rad/s\n",
            d[2], d[3], a->deflected, d[6], d[7]);
    }
}

/* Equal steps, and what they err by. */
static void print_step(const se3d_run_analysis *a)
{
    if (a->step > 0.0) {
        printf("  equal steps of %.6g s", a->step);
    }
    if (a->estimated_to > a->start) {
        printf(", by comparison with %.6g s off by about %.1g of the largest travel, %.1g of "
               "velocities, %.1g of angular velocities, %.1g of works",
               2.0 * a->step, a->error_position, a->error_velocity, a->error_angular_velocity,
               a->error_work);
        if (a->error_state > 0.0) {
            printf(", %.1g of states", a->error_state);
        }
    }
    if (a->estimated_to > a->start && a->estimated_to < a->end) {
        printf(" (to t = %.6g s)", a->estimated_to);
    }
    if (a->unestimated && a->unestimated[0]) {
        printf("%s", a->estimated_to > a->start ? "; then " : ", whose error is not known: ");
        fputs(a->unestimated, stdout);
    }
    if (a->step > 0.0) {
        putchar('\n');
    }
}

static void print_analysis(const se3d_run_analysis *a)
{
    printf("%s, %s%s%s: %s\n", a->type, a->formulation, a->method[0] ? ", " : "", a->method,
           outcome(a));
    printf("  from %.9g s to %.9g s, ", a->start, a->end);
    put_count(a->stats.steps, "step", "steps", "");
    printf(" (%" PRIu64 " rejected), ", a->stats.rejected);
    put_count(a->stats.iterations, "iteration", "iterations", "");
    printf(", CPU time %.3g s\n", a->cpu_time);
    if (a->left[0]) {
        printf("  auto left %s for %s at t = %.9g s: %s\n", a->left, a->method, a->left_at,
               strcmp(a->method, "convex") != 0 ? strcmp(a->left, "radau") == 0
                                                      ? "the motion is stiff no more"
                                                      : "the motion became stiff"
               : strcmp(a->left, "radau") == 0
                   ? "bodies that touch made it slower than what happens"
                   : "bodies that touch held its steps short, or are many");
    }
    print_step(a);
    if (a->reached > a->tolerance) {
        printf("  the tolerance %g is smaller than what %s reaches; %.3g was used\n", a->tolerance,
               a->method, a->reached);
    }
    print_start(a);
    if (a->left_out && a->left_out[0]) {
        printf("  equations that are redundant but for the digits of their data, left out: %s\n",
               a->left_out);
    }
}

/* If particles came or went. */
static void print_particles(const se3d_run *run)
{
    for (size_t k = 0; k < se3d_run_count_particles(run); ++k) {
        se3d_run_particles p;
        if (SE3D_FAILED(se3d_run_get_particles(run, k, &p)) || p.left + p.inserted == 0) {
            continue;
        }
        printf("%s%s: %" PRIu64 " at the end, %" PRIu64 " left",
               strcmp(p.name, "particles") == 0 ? "" : "particles ", p.name, p.count, p.left);
        if (p.inserted > 0) {
            printf(", %" PRIu64 " inserted (%" PRIu64 " had to wait for room)", p.inserted,
                   p.deferred);
        }
        putchar('\n');
    }
}

static const char *shape_name(const se3d_system *system, se3d_shape shape)
{
    const char *name = "";
    se3d_body body;
    (void)se3d_shape_get_name(system, shape, &name);
    if (!name[0] && se3d_shape_get_body(system, shape, &body) == SE3D_OK) {
        (void)se3d_body_get_name(system, body, &name);
    }
    return name;
}

/* Meshes that do not touch each other. */
static void print_passing(const se3d_model *model)
{
    const se3d_system *system = se3d_model_get_system((se3d_model *)(uintptr_t)model);
    se3d_shape i, j;
    const size_t pairs = se3d_system_count_passing_meshes(system, &i, &j);
    if (pairs > 0) {
        printf("the meshes %s and %s", shape_name(system, i), shape_name(system, j));
        if (pairs > 1) {
            printf(" (and %zu more pairs)", pairs - 1);
        }
        puts(" pass through each other: close one of them, make it simpler, or build it from other "
             "shapes");
    }
}

static void print_file(const se3d_run_file *file)
{
    printf("wrote %s: ", file->path);
    if (file->columns > 0) {
        put_count(file->rows, "row", "rows", ", ");
        put_count(file->columns, "column", "columns", "\n");
    } else {
        put_count(file->rows, "time", "times", "\n");
    }
}

static void print_text(const se3d_model *model, const se3d_run *run)
{
    for (size_t k = 0; k < se3d_run_count_analyses(run); ++k) {
        se3d_run_analysis analysis;
        if (!SE3D_FAILED(se3d_run_get_analysis(run, k, &analysis))) {
            print_analysis(&analysis);
            print_events(run, k);
        }
    }
    print_particles(run);
    print_passing(model);
    for (size_t k = 0; k < se3d_run_count_files(run); ++k) {
        se3d_run_file file;
        if (!SE3D_FAILED(se3d_run_get_file(run, k, &file))) {
            print_file(&file);
        }
    }
}

static void json_put_count(const char *name, uint64_t value)
{
    printf(", \"%s\": %" PRIu64, name, value);
}

static void json_put_start(const se3d_run_analysis *a)
{
    static const char *const names[4] = {"position", "rotation", "velocity", "angular_velocity"};
    if (!a->moved[0] && !a->deflected[0]) {
        return;
    }
    fputs(", \"start_change\": {\"moved\": ", stdout);
    json_put_text(a->moved);
    fputs(", \"deflected\": ", stdout);
    json_put_text(a->deflected);
    for (int k = 0; k < 8; ++k) {
        printf(", \"%s%s\": ", k < 4 ? "" : "most_", names[k % 4]);
        json_put_number(a->start_change[k]);
    }
    fputs("}", stdout);
}

static void json_put_left_out(const se3d_run_analysis *a)
{
    if (a->left_out && a->left_out[0]) {
        fputs(", \"left_out\": ", stdout);
        json_put_text(a->left_out);
    }
}

static void json_put_value(const char *name, double value)
{
    printf(", \"%s\": ", name);
    json_put_number(value);
}

static void json_put_estimate(const se3d_run_analysis *a)
{
    if (a->estimated_to > a->start) {
        json_put_value("error_position", a->error_position);
        json_put_value("error_velocity", a->error_velocity);
        json_put_value("error_angular_velocity", a->error_angular_velocity);
        json_put_value("error_work", a->error_work);
        json_put_value("error_state", a->error_state);
        json_put_value("estimated_to", a->estimated_to);
    }
    if (a->unestimated && a->unestimated[0]) {
        fputs(", \"unestimated\": ", stdout);
        json_put_text(a->unestimated);
    }
}

static void json_put_analysis(const se3d_run_analysis *a)
{
    fputs("{\"type\": ", stdout);
    json_put_text(a->type);
    fputs(", \"formulation\": ", stdout);
    json_put_text(a->formulation);
    fputs(", \"method\": ", stdout);
    json_put_text(a->method);
    printf(", \"status\": %d, \"text\": ", (int)a->status);
    json_put_text(se3d_status_get_text((se3d_status)a->status));
    fputs(", \"start\": ", stdout);
    json_put_number(a->start);
    fputs(", \"end\": ", stdout);
    json_put_number(a->end);
    fputs(", \"cpu_time\": ", stdout);
    json_put_number(a->cpu_time);
    if (a->left[0]) {
        fputs(", \"left\": ", stdout);
        json_put_text(a->left);
        fputs(", \"left_at\": ", stdout);
        json_put_number(a->left_at);
    }
    if (a->reached > 0.0) {
        fputs(", \"tolerance\": ", stdout);
        json_put_number(a->tolerance);
        fputs(", \"tolerance_reached\": ", stdout);
        json_put_number(a->reached);
    }
    if (a->step > 0.0) {
        fputs(", \"step\": ", stdout);
        json_put_number(a->step);
    }
    json_put_estimate(a);
    json_put_start(a);
    json_put_left_out(a);
    json_put_count("steps", a->stats.steps);
    json_put_count("rejected", a->stats.rejected);
    json_put_count("iterations", a->stats.iterations);
    json_put_count("evaluations", a->stats.evaluations);
    json_put_count("factorizations", a->stats.factorizations);
    json_put_count("solves", a->stats.solves);
    putchar('}');
}

static void json_put_events(const se3d_run *run)
{
    fputs("], \"events\": [", stdout);
    for (size_t k = 0; k < se3d_run_count_events(run); ++k) {
        se3d_run_event event;
        if (SE3D_FAILED(se3d_run_get_event(run, k, &event))) {
            continue;
        }
        printf("%s{\"analysis\": %zu, \"time\": ", k > 0 ? ", " : "", event.analysis);
        json_put_number(event.time);
        fputs(", \"event\": ", stdout);
        json_put_text(event.name);
        fputs(", \"channel\": ", stdout);
        json_put_text(event.channel);
        fputs(", \"value\": ", stdout);
        json_put_number(event.value);
        printf(", \"direction\": \"%s\", \"stopped\": %s}", direction(&event),
               event.stopped ? "true" : "false");
    }
}

static void json_put_particles(const se3d_run *run)
{
    fputs("], \"particles\": [", stdout);
    for (size_t k = 0; k < se3d_run_count_particles(run); ++k) {
        se3d_run_particles p;
        if (SE3D_FAILED(se3d_run_get_particles(run, k, &p))) {
            continue;
        }
        fputs(k > 0 ? ", {\"name\": " : "{\"name\": ", stdout);
        json_put_text(p.name);
        json_put_count("count", p.count);
        json_put_count("left", p.left);
        json_put_count("inserted", p.inserted);
        json_put_count("deferred", p.deferred);
        putchar('}');
    }
}

static void json_put_summaries(const se3d_run *run)
{
    fputs("], \"summary\": [", stdout);
    for (size_t k = 0; k < se3d_run_count_summaries(run); ++k) {
        se3d_run_summary s;
        if (SE3D_FAILED(se3d_run_get_summary(run, k, &s))) {
            continue;
        }
        fputs(k > 0 ? ", {\"channel\": " : "{\"channel\": ", stdout);
        json_put_text(s.channel);
        fputs(", \"file\": ", stdout);
        json_put_text(s.file);
        json_put_value("min", s.min);
        json_put_value("min_time", s.min_time);
        json_put_value("max", s.max);
        json_put_value("max_time", s.max_time);
        json_put_value("mean", s.mean);
        json_put_value("rms", s.rms);
        json_put_value("integral", s.integral);
        json_put_value("last", s.last);
        putchar('}');
    }
}

/* The pictures that come afterwards. */
static void json_put_pictures(const se3d_model *model)
{
    fputs("], \"pictures\": [", stdout);
    for (size_t k = 0; k < se3d_model_count_pictures(model); ++k) {
        se3d_model_picture picture;
        se3d_model_get_picture(model, k, &picture);
        fputs(k > 0 ? ", " : "", stdout);
        json_put_text(picture.file);
    }
}

/* What the user should know beside results. */
typedef struct told {
    notes notes;
    const warnings *warnings;
} told;

static void print_json(const options *o, const se3d_model *model, const se3d_run *run,
                       const char *message, const told *n)
{
    char strict[WARNING_SIZE];
    const char *why = message[0] ? message : warnings_get_verdict(n->warnings, strict);
    outcome_tell();
    printf("{\"status\": \"%s\", \"model\": ", why[0] ? "failed" : "done");
    json_put_text(o->model);
    fputs(", \"message\": ", stdout);
    json_put_text(why);
    fputs(", \"analyses\": [", stdout);
    for (size_t k = 0; k < se3d_run_count_analyses(run); ++k) {
        se3d_run_analysis analysis;
        if (!SE3D_FAILED(se3d_run_get_analysis(run, k, &analysis))) {
            fputs(k > 0 ? ", " : "", stdout);
            json_put_analysis(&analysis);
        }
    }
    fputs("], \"files\": [", stdout);
    for (size_t k = 0; k < se3d_run_count_files(run); ++k) {
        se3d_run_file file;
        if (!SE3D_FAILED(se3d_run_get_file(run, k, &file))) {
            fputs(k > 0 ? ", {\"path\": " : "{\"path\": ", stdout);
            json_put_text(file.path);
            printf(", \"rows\": %" PRIu64 ", \"columns\": %zu}", file.rows, file.columns);
        }
    }
    json_put_events(run);
    json_put_particles(run);
    json_put_summaries(run);
    json_put_pictures(model);
    fputs("]", stdout);
    json_put_count("passing_meshes",
                   se3d_system_count_passing_meshes(
                       se3d_model_get_system((se3d_model *)(uintptr_t)model), NULL, NULL));
    fputs(", \"notes\": [", stdout);
    for (size_t k = 0; k < n->notes.count; ++k) {
        fputs(k > 0 ? ", " : "", stdout);
        json_put_text(n->notes.text[k]);
    }
    fputs("], \"warnings\": [", stdout);
    for (size_t k = 0; k < n->warnings->count; ++k) {
        fputs(k > 0 ? ", " : "", stdout);
        json_put_text(n->warnings->text[k]);
    }
    fputs("]", stdout);
    json_put_count("more_warnings", n->warnings->more);
    fputs("}\n", stdout);
}

/* The folder for the results; free it. */
static char *results_folder(const options *o, const se3d_model *model)
{
    const char *name = se3d_model_get_name(model);
    const size_t size = strlen("results/") + strlen(name) + 1;
    char *folder = o->directory ? NULL : malloc(size);
    if (folder) {
        snprintf(folder, size, "results/%s", name);
    }
    return folder;
}

/* Shows the progress and records the motion. */
typedef struct watcher {
    progress *bar;
    se3d_scene *scene;
    se3d_status status; /* of the scene: the first failure */
} watcher;

static int watch(void *ctx, size_t analysis, double time, double fraction)
{
    watcher *w = ctx;
    if (!SE3D_FAILED(w->status)) {
        w->status = se3d_scene_record(w->scene);
    }
    return progress_show(w->bar, analysis, time, fraction) || interrupt_came();
}

/* Also asked between two rows, which may be far from each other. */
static int is_over(void *ctx)
{
    const watcher *w = ctx;
    progress_wait(w->bar);
    return interrupt_came();
}

/* The time that the last analysis has come to. */
static double end_of(const se3d_run *run)
{
    se3d_run_analysis analysis;
    const size_t count = se3d_run_count_analyses(run);
    return count > 0 && !SE3D_FAILED(se3d_run_get_analysis(run, count - 1, &analysis))
               ? analysis.end
               : 0.0;
}

/* The scene is left beside the results. @return false: `error` says why. */
static int write_scene(const watcher *w, const char *folder, se3d_model_error *error)
{
    char path[4200];
    const int length = snprintf(path, sizeof path, "%s/scene.glb", folder);
    const int fits = length > 0 && (size_t)length < sizeof path;
    if (!SE3D_FAILED(w->status) && fits) {
        return !SE3D_FAILED(se3d_scene_write(w->scene, path, error));
    }
    memset(error, 0, sizeof *error);
    snprintf(error->message, sizeof error->message, "%.200s/scene.glb: cannot be made: %s", folder,
             fits ? se3d_status_get_text(w->status) : "the path is too long");
    return 0;
}

static void print_result(const warnings *warned, se3d_model *model, const se3d_run *run,
                         const char *message)
{
    const options *o = warned->o;
    told n = {.warnings = warned};
    if (o->json || !o->quiet) {
        notes_collect(&n.notes, model, run);
    }
    warnings_conclude(warned);
    if (o->json) {
        print_json(o, model, run, message, &n);
    } else if (!o->quiet) {
        print_text(model, run);
        for (size_t k = 0; k < n.notes.count; ++k) {
            printf("note: %s\n", n.notes.text[k]);
        }
    }
}

static const char *advice_to_resume(const options *o)
{
    return o->checkpoint ? "; --resume goes on" : "";
}

/* What is asked for beside the results. */
static void ask(const options *o, se3d_scene *scene, se3d_run_options *how)
{
    how->checkpoint = o->checkpoint ? fmax(strtod(o->checkpoint, NULL), EVERY_ROW) : 0.0;
    how->resume = o->resume;
    how->keep = o->keep;
    how->scene = scene;
    how->temporary = getenv("TMPDIR");
    how->estimate = !o->no_estimate && (o->json || o->strict || !o->quiet);
}

/* Run, and leave the results and the scene in `folder`. */
static int run_into(const warnings *warned, se3d_model *model, const char *folder,
                    se3d_scene **scene)
{
    const options *o = warned->o;
    se3d_run_options how = se3d_run_options_default();
    se3d_run *run = NULL;
    se3d_model_error error = {.message = ""};
    progress bar;
    progress_begin(&bar, o->quiet || o->json, se3d_model_count_analyses(model));
    bar.is_lines = o->json_lines;
    how.directory = folder;
    watcher w = {&bar, NULL, SE3D_OK};
    w.status = se3d_scene_create(model, scene);
    w.scene = *scene;
    interrupt_begin();
    how.progress = watch;
    how.ctx = &w;
    how.interrupt = is_over;
    how.interrupt_ctx = &w;
    ask(o, *scene, &how);
    const se3d_status status = se3d_model_run(model, &how, &run, &error);
    const int ended = (!SE3D_FAILED(status) || status == SE3D_ERR_INTERRUPTED) && interrupt_came();
    progress_end(&bar);
    if (ended) {
        snprintf(error.message, sizeof error.message,
                 "ended by the user at t = %.9g s; the results so far are in %.200s%s", end_of(run),
                 folder, advice_to_resume(o));
    }
    const int failed = SE3D_FAILED(status) || ended;
    const int nothing = se3d_run_count_files(run) == 0;
    se3d_model_error lost;
    const int drawn = nothing || write_scene(&w, folder, failed ? &lost : &error);
    print_result(warned, model, run, error.message);
    if (failed || !drawn) {
        fflush(stdout);
        complain("%s: %s\n", o->model, error.message);
    }
    if (failed && !drawn) {
        complain("%s: %s\n", o->model, lost.message);
    }
    se3d_run_destroy(run);
    if (status == SE3D_ERR_UNSUPPORTED || (SE3D_FAILED(status) && nothing) || ended) {
        se3d_scene_destroy(*scene); /* no pictures of nothing, or nobody waits for them */
        *scene = NULL;
    }
    return status == SE3D_ERR_UNSUPPORTED ? EXIT_USAGE : failed || !drawn ? EXIT_FAILED : EXIT_DONE;
}

/* `pictures`: the type of those to make, "" for none, NULL for all. */
static int run_model(const warnings *warned, se3d_model *model, const char *pictures)
{
    const options *o = warned->o;
    char *made = results_folder(o, model);
    const char *folder = o->directory ? o->directory : made;
    se3d_scene *scene = NULL;
    if (!folder) {
        report_failure(o, o->model, "out of memory");
        return EXIT_FAILED;
    }
    int code = run_into(warned, model, folder, &scene);
    if (o->print && code != EXIT_USAGE) {
        const int printed = print_rows(folder, print_rows_find(o, model));
        code = code == EXIT_DONE ? printed : code;
    }
    if (scene && pictures_make(model, scene, folder, pictures, o->quiet || o->json) != EXIT_DONE) {
        code = code == EXIT_DONE ? EXIT_FAILED : code;
    }
    se3d_scene_destroy(scene);
    free(made);
    return code;
}

/* The first CSV file of results that has channels. */
static int find_csv(const options *o, const se3d_model *model, char *csv, size_t size)
{
    for (size_t k = 0; k < se3d_model_count_outputs(model); ++k) {
        se3d_model_output output;
        se3d_model_get_output(model, k, &output);
        if (output.channel_count > 0 && !se3di_file_is_hdf5(output.file)) {
            char *folder = results_folder(o, model);
            const int length = folder ? snprintf(csv, size, "%s/%s", folder, output.file) : -1;
            free(folder);
            return length > 0 && (size_t)length < size;
        }
    }
    return 0;
}

static int has_plots(const se3d_model *model)
{
    for (size_t k = 0; k < se3d_model_count_pictures(model); ++k) {
        se3d_model_picture picture;
        se3d_model_get_picture(model, k, &picture);
        if (strcmp(picture.type, "plot") == 0) {
            return 1;
        }
    }
    return 0;
}

/* Read a model for another command; `warned` and what it points to outlive it. */
static int read_for(const char *path, int quiet, options *o, warnings *warned, se3d_model **model)
{
    memset(o, 0, sizeof *o);
    o->model = path;
    o->quiet = quiet || outcome_wants_json();
    o->json = outcome_wants_json();
    *warned = (warnings){.o = o};
    se3d_model_options how = options_get_model(o);
    how.log = warnings_add;
    how.log_ctx = warned;
    const int code = options_read_model(o, &how, model);
    o->json = 0; /* what follows is the other command's */
    return code;
}

static int fail_nothing(const char *command, const char *path)
{
    complain("se3d %s: %s: there is nothing to run and draw\n", command, path);
    return EXIT_USAGE;
}

int run_for_plots(const char *path, int quiet, int draw, char *csv, size_t size)
{
    options o;
    warnings warned;
    se3d_model *model = NULL;
    int code = read_for(path, quiet, &o, &warned, &model);
    if (code != EXIT_DONE) {
        return code;
    }
    const int asked = draw && has_plots(model);
    if (se3d_model_count_analyses(model) == 0 || !find_csv(&o, model, csv, size)) {
        code = fail_nothing("plot", path);
    } else {
        code = run_model(&warned, model, asked ? "plot" : "");
    }
    if (asked) {
        csv[0] = '\0'; /* drawn already */
    }
    se3d_model_destroy(model);
    return code;
}

int run_for_view(const char *command, const char *path, int quiet, char *folder, size_t size)
{
    options o;
    warnings warned;
    se3d_model *model = NULL;
    if (!path_is_model(path)) {
        snprintf(folder, size, "%s", path);
        return EXIT_DONE;
    }
    int code = read_for(path, quiet, &o, &warned, &model);
    if (code != EXIT_DONE) {
        return code;
    }
    char *made = results_folder(&o, model);
    const int length = made ? snprintf(folder, size, "%s", made) : -1;
    free(made);
    if (se3d_model_count_analyses(model) == 0) {
        code = fail_nothing(command, path);
    } else if (length < 0 || (size_t)length >= size) {
        report_failure(&o, path, "out of memory, or the name is too long");
        code = EXIT_FAILED;
    } else {
        code = run_model(&warned, model, "");
    }
    se3d_model_destroy(model);
    return code;
}

/* The seconds between checkpoints. @return false, after a message: it is no such number */
static int is_checkpoint(const options *o)
{
    char *end = NULL;
    const double seconds = o->checkpoint ? strtod(o->checkpoint, &end) : 0.0;
    if (!o->checkpoint || (end != o->checkpoint && !*end && seconds >= 0.0 && seconds <= DBL_MAX)) {
        return 1;
    }
    complain("se3d run: --checkpoint %s: must be a number of seconds, 0 or more\n", o->checkpoint);
    return 0;
}

static int command_run(int count, char *const *words)
{
    options o;
    se3d_model *model = NULL;
    int code = options_read(&o, &run_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    if (!is_checkpoint(&o)) {
        return EXIT_USAGE;
    }
    if (o.print && o.json) {
        return options_refuse_both(&run_entry, "--print");
    }
    o.quiet = o.quiet || o.print; /* of what is not an error or a warning */
    warnings warned = {.o = &o};
    se3d_model_options how = options_get_model(&o);
    how.log = warnings_add;
    how.log_ctx = &warned;
    code = options_read_model(&o, &how, &model);
    if (code != EXIT_DONE) {
        return code;
    }
    if (se3d_model_count_analyses(model) == 0) {
        report_failure(&o, o.model,
                       "there is nothing to run: add `analysis: {type: dynamics, duration: 1}` to "
                       "the model, or give --analysis and --duration");
        code = EXIT_USAGE;
    } else {
        code = o.print && !print_rows_find(&o, model) ? EXIT_USAGE
                                                      : warnings_forbid(&warned, EXIT_DONE);
        code = code == EXIT_DONE ? warnings_forbid(&warned, run_model(&warned, model, NULL)) : code;
    }
    if (code == EXIT_DONE) {
        char *made = results_folder(&o, model);
        report_next(&o, o.directory ? o.directory : made ? made : "results");
        free(made);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry run_entry = {
    .name = "run",
    .run = command_run,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "run the analyses of a model, write results as CSV",
    .text = "Runs the analyses of a model file one after the other and writes its "
            "results as CSV files.",
    .options =
        (const command_option[]){
            {"--output", "-o", "DIR",
             "folder for the results, made if missing (default: results/<model>)"},
            COMMAND_OPTION_SET,
            {"--analysis", NULL, "T", "instead of those of the model: {analyses}, modes"},
            COMMAND_OPTIONS_OF_SOLVERS,
            {"--every", NULL, "T", "time between rows of the first of `output` [s]"},
            {"--threads", NULL, "N", "threads of particles; results stay the same"},
            {"--print", NULL, "FILE",
             "print the rows of this file of `output` (-: of the first CSV file with channels) "
             "instead of the summary"},
            {"--checkpoint", NULL, "T",
             "every T seconds of the clock, write all that is needed to go on to run.checkpoint, "
             "beside the results; 0: at every row"},
            {"--resume", NULL, NULL,
             "go on with a run that was ended, from its last checkpoint, or begin if there is "
             "none: the results are the same to the byte; --duration may be longer than before"},
            {"--keep", NULL, NULL,
             "leave a checkpoint when the run is complete, to --resume with a longer --duration"},
            {"--no-estimate", NULL, NULL,
             "do not estimate the error of a given step of methods that control none, which takes "
             "half as much time again"},
            COMMAND_OPTION_STRICT,
            {"--json", NULL, NULL, "print the summary as JSON, with the warnings"},
            {"--json-lines", NULL, NULL,
             "print JSON, an object a line: how far the run is, at last the summary"},
            {0}},
    .examples =
        (const command_example[]){
            {"run pendulum.yaml", "results in results/pendulum"},
            {"run fourbar.yaml --set l=0.3 -o short", "another length, results in short"},
            {"run fourbar.yaml --set bodies.coupler.mass=\"30 g\"",
             "another mass, whatever the file says there"},
            {"run car.yaml --method radau --tolerance 1e-8 --json",
             "another method and tolerance, a summary for programs"},
            {"run pendulum.yaml --print - | head", "the first rows, for other programs"},
            {"run hopper.yaml --checkpoint 60 --resume",
             "a long run: the same command again goes on with it"},
            {0}},
    .exits = "0 done; 1 the analysis failed or was ended by Ctrl-C or SIGTERM (results so "
             "far are on disk); 2 bad usage or model.",
};
