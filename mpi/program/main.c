/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d-mpi run MODEL: as `se3d run`, the particles spread over the processes of mpirun.
 *
 * Every process runs the model; what moves particles and what reads them is done by all. The first
 * one writes the results, the others write theirs to a folder that they remove.      docs/mpi.md */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <inttypes.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "folder.h"
#include "se3d/io.h"
#include "se3d/mpi.h"

#define SETTINGS_MOST 64

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

typedef struct job {
    int rank, size;
    const char *path;
    const char *directory; /* NULL: results/<name of the model> */
    const char *checkpoint;
    int resume, quiet;
    se3d_model_setting settings[SETTINGS_MOST];
    size_t setting_count;
    char *texts[SETTINGS_MOST]; /* names of settings */
    se3d_model *model;
    char folder[4200]; /* of this process */
} job;

static int usage(const job *j, const char *why, const char *what)
{
    if (j->rank == 0) {
        if (why) {
            fprintf(stderr, "se3d-mpi: %s%s\n", why, what);
        }
        fputs("usage: mpirun -np N se3d-mpi run MODEL [-o DIR] [--set NAME=VALUE]... [--checkpoint "
              "T] [--resume] [--quiet]\n"
              "The same results as `se3d run MODEL`, the particles spread over N processes.\n",
              why ? stderr : stdout);
    }
    return why ? EXIT_USAGE : EXIT_DONE;
}

static int fail(const job *j, const char *message)
{
    if (j->rank == 0) {
        fflush(stdout);
        fprintf(stderr, "%s: %s\n", j->path, message);
    }
    return EXIT_FAILED;
}

/* What one process lacks or cannot write, the others do not know: they would wait for it. */
static int is_lonely(se3d_status status)
{
    return status == SE3D_ERR_IO || status == SE3D_ERR_NO_MEMORY;
}

static void end_all(const job *j, const char *message)
{
    fflush(stdout);
    fprintf(stderr, "%s: %s (process %d of %d; all processes end)\n", j->path, message, j->rank,
            j->size);
    if (j->rank != 0) {
        folder_remove(j->folder);
    }
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILED);
}

/* NAME=VALUE. */
static int add_setting(job *j, const char *text)
{
    const char *sign = strchr(text, '=');
    if (!sign || sign == text || j->setting_count == SETTINGS_MOST) {
        return 0;
    }
    char *name = strndup(text, (size_t)(sign - text));
    if (!name) {
        return 0;
    }
    j->texts[j->setting_count] = name;
    j->settings[j->setting_count++] = (se3d_model_setting){.name = name, .value = sign + 1};
    return 1;
}

/* The value of an option, which may be the next word. */
static const char *value_of(const char *name, char **words, int *k)
{
    const size_t length = strlen(name);
    if (strncmp(words[*k], name, length) == 0 && words[*k][length] == '=') {
        return words[*k] + length + 1;
    }
    return strcmp(words[*k], name) == 0 && words[*k + 1] ? words[++*k] : NULL;
}

static int read_word(job *j, char **words, int *k)
{
    const char *value;
    if ((value = value_of("-o", words, k)) || (value = value_of("--output", words, k))) {
        j->directory = value;
    } else if ((value = value_of("--set", words, k))) {
        return add_setting(j, value);
    } else if ((value = value_of("--checkpoint", words, k))) {
        char *end = NULL;
        j->checkpoint = value;
        return strtod(value, &end) >= 0.0 && end != value && !*end;
    } else if (strcmp(words[*k], "--resume") == 0) {
        j->resume = 1;
    } else if (strcmp(words[*k], "--quiet") == 0 || strcmp(words[*k], "-q") == 0) {
        j->quiet = 1;
    } else if (words[*k][0] != '-' && !j->path) {
        j->path = words[*k];
    } else {
        return 0;
    }
    return 1;
}

/* The folder of the results; that of the other processes is for a short time. */
static int choose_folder(job *j)
{
    const char *base = getenv("TMPDIR");
    const char *name = se3d_model_get_name(j->model);
    if (j->rank == 0) {
        const int length = j->directory ? snprintf(j->folder, sizeof j->folder, "%s", j->directory)
                                        : snprintf(j->folder, sizeof j->folder, "results/%s", name);
        return length > 0 && (size_t)length < sizeof j->folder;
    }
    snprintf(j->folder, sizeof j->folder, "%.4000s/se3d-mpi-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(j->folder) != NULL;
}

/* What a run is gone on with must be in every process's folder. */
static int copy_results(const job *j)
{
    char name[4200] = "";
    if (j->rank == 0) {
        snprintf(name, sizeof name, "%s", j->folder);
    }
    MPI_Bcast(name, sizeof name, MPI_CHAR, 0, MPI_COMM_WORLD);
    return j->rank == 0 || folder_copy(name, j->folder);
}

static int all_agree(int good)
{
    int all = good;
    MPI_Allreduce(&good, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all;
}

static int watch(void *ctx, size_t analysis, double time, double fraction)
{
    (void)analysis;
    (void)time;
    (void)fraction;
    (void)se3d_scene_record(ctx);
    return 0;
}

static void report_log(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    const job *j = ctx;
    (void)kind;
    if (j->rank == 0 && level == SE3D_LOG_WARNING) {
        fprintf(stderr, "warning: %s\n", message);
    }
}

static void print_shares(const job *j)
{
    se3d_particles *set;
    se3d_system *system = se3d_model_get_system(j->model);
    for (size_t k = 0; se3d_system_get_particles(system, k, &set) == SE3D_OK; ++k) {
        se3d_mpi_stats own;
        (void)se3d_mpi_get_stats(set, &own);
        double times[2] = {own.elapsed, own.waited};
        uint64_t sums[3] = {own.ghosts, own.moved, own.bytes}, most = own.owned, least = own.owned;
        MPI_Allreduce(MPI_IN_PLACE, times, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
        MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
        if (j->rank == 0 && !j->quiet) {
            printf("%d processes: %" PRIu64 " to %" PRIu64 " particles each, %" PRIu64
                   " ghosts in all, %" PRIu64 " changed hands\n"
                   "  %.3g s moving, %.3g %% of it in messages and waiting; hash %016" PRIx64 "\n",
                   j->size, least, most, sums[0], sums[1], times[0] / j->size,
                   times[0] > 0.0 ? 100.0 * times[1] / times[0] : 0.0, se3d_particles_hash(set));
        }
    }
}

static void print_run(const job *j, const se3d_run *run)
{
    for (size_t k = 0; j->rank == 0 && !j->quiet && k < se3d_run_count_files(run); ++k) {
        se3d_run_file file;
        if (!SE3D_FAILED(se3d_run_get_file(run, k, &file))) {
            printf("wrote %s: %" PRIu64 " rows\n", file.path, file.rows);
        }
    }
}

static int write_scene(const job *j, se3d_scene *scene)
{
    char path[4300];
    se3d_model_error error;
    snprintf(path, sizeof path, "%s/scene.glb", j->folder);
    return j->rank != 0 || !SE3D_FAILED(se3d_scene_write(scene, path, &error));
}

static int run_attached(job *j)
{
    se3d_scene *scene = NULL;
    se3d_run *run = NULL;
    se3d_model_error error = {.message = ""};
    se3d_run_options how = se3d_run_options_default();
    if (SE3D_FAILED(se3d_scene_create(j->model, &scene))) {
        end_all(j, "out of memory");
        return EXIT_FAILED;
    }
    how.directory = j->folder;
    how.progress = watch;
    how.ctx = scene;
    how.scene = scene;
    how.resume = j->resume;
    how.checkpoint = j->checkpoint ? strtod(j->checkpoint, NULL) : 0.0;
    if (j->checkpoint && how.checkpoint < 1e-9) {
        how.checkpoint = 1e-9;
    }
    const se3d_status status = se3d_model_run(j->model, &how, &run, &error);
    const int good = !SE3D_FAILED(status);
    if (is_lonely(status) && j->size > 1) {
        end_all(j, error.message);
    }
    if (!good) {
        (void)fail(j, error.message);
    }
    int code = good ? EXIT_DONE : status == SE3D_ERR_UNSUPPORTED ? EXIT_USAGE : EXIT_FAILED;
    if (good && !all_agree(write_scene(j, scene))) {
        code = fail(j, "scene.glb cannot be written");
    }
    print_run(j, run);
    if (good) {
        print_shares(j);
    }
    se3d_run_destroy(run);
    se3d_scene_destroy(scene);
    return code;
}

static int run_model(job *j)
{
    int code = EXIT_FAILED;
    if (!all_agree(choose_folder(j))) {
        code = fail(j, "a folder for results cannot be made");
    } else if (j->resume && !all_agree(copy_results(j))) {
        code = fail(j, "the results to go on with cannot be copied for all processes");
    } else if (SE3D_FAILED(se3d_mpi_attach(se3d_model_get_system(j->model), MPI_COMM_WORLD))) {
        code = fail(j, se3d_system_get_error(se3d_model_get_system(j->model)));
    } else {
        code = run_attached(j);
    }
    if (j->rank != 0) {
        folder_remove(j->folder);
    }
    return code;
}

static int command_run(job *j, char **words)
{
    for (int k = 0; words[k]; ++k) {
        if (!read_word(j, words, &k)) {
            return usage(j, "this is not understood, or lacks its value: ", words[k]);
        }
    }
    if (!j->path) {
        return usage(j, "which model?", "");
    }
    se3d_model_error error = {.message = ""};
    se3d_model_options how = se3d_model_options_default();
    how.settings = j->settings;
    how.setting_count = j->setting_count;
    how.log = report_log;
    how.log_ctx = j;
    const int good = !SE3D_FAILED(se3d_model_read_file(j->path, &how, &j->model, &error));
    int first = good ? j->size : j->rank; /* that could not read it: one says why */
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first < j->size) {
        if (j->rank == first) {
            fprintf(stderr, "%s\n", error.message);
        }
        return EXIT_USAGE;
    }
    return run_model(j);
}

int main(int argc, char **argv)
{
    job j = {.rank = 0};
    int given = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &j.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &j.size);
    int code;
    if (argc > 1 && strcmp(argv[1], "run") == 0) {
        code = command_run(&j, argv + 2);
    } else if (argc > 1 && strcmp(argv[1], "--version") == 0) {
        code = EXIT_DONE;
        if (j.rank == 0) {
            printf("se3d-mpi %s\n", se3d_version_get_text());
        }
    } else {
        const int asked = argc > 1 && strcmp(argv[1], "--help") == 0;
        code = usage(&j, asked ? NULL : "there is one command: run", "");
    }
    se3d_model_destroy(j.model);
    for (size_t k = 0; k < j.setting_count; ++k) {
        free(j.texts[k]);
    }
    fflush(stdout);
    MPI_Finalize();
    return code;
}
