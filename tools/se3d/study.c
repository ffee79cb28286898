/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d study MODEL: many runs of a model with other parameters. */
#define _XOPEN_SOURCE 700

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interrupt.h"
#include "options.h"
#include "outcome.h"
#include "se3d/study.h"
#include "study_derive.h"
#include "study_jobs.h"
#include "study_optimize.h"
#include "text.h"

enum { PATH_SIZE = 4200, JOBS_MAX = 1024 };

/* One study that is being run. */
typedef struct job {
    const options *o;
    se3d_study *study;
    se3d_study_table *table;
    char folder[PATH_SIZE - 100];
    char path[PATH_SIZE];
    uint32_t shard, shards;
    size_t jobs;
    size_t total, done, shown; /* samples of this shard; tenths that were shown */
    se3d_model_error error;
} job;

static int usage(const char *format, const char *text)
{
    complain("se3d study: %s `%s`; see `se3d help study`\n", format, text);
    return EXIT_USAGE;
}

static int fail(const job *j, const char *message)
{
    report_failure(j->o, "", message);
    return EXIT_FAILED;
}

/* ---- which shard -----------------------------------------------------------------------------*/

/* A whole number from 1 on that is all of the text. @return 0: it is none. */
static uint32_t parse_count(const char *text, uint32_t most)
{
    char *end = NULL;
    if (!text || text[0] < '0' || text[0] > '9') {
        return 0;
    }
    errno = 0;
    const unsigned long value = strtoul(text, &end, 10);
    return *end || errno || value > most ? 0 : (uint32_t)value;
}

/* The number of this task, from 1, as a scheduler says; 0: none does. */
static uint32_t find_task(void)
{
    static const char *const names[] = {"SLURM_ARRAY_TASK_ID", "PBS_ARRAY_INDEX", "PBS_ARRAYID",
                                        "HQ_TASK_ID", NULL};
    const char *least = getenv("SLURM_ARRAY_TASK_MIN");
    for (size_t k = 0; names[k]; ++k) {
        const char *text = getenv(names[k]);
        if (text && k == 0 && least) {
            return (uint32_t)(strtoul(text, NULL, 10) - strtoul(least, NULL, 10)) + 1;
        }
        if (text) {
            return parse_count(text, UINT32_MAX);
        }
    }
    return 0;
}

static int read_shard(job *j)
{
    enum { SHARDS_MAX = 100000000 };
    const char *text = j->o->shard;
    char first[24] = "";
    j->shard = j->shards = 1;
    if (!text) {
        return EXIT_DONE;
    }
    const char *slash = strchr(text, '/');
    const char *count = slash ? slash + 1 : getenv("SLURM_ARRAY_TASK_COUNT");
    const size_t length = slash ? (size_t)(slash - text) : strlen(text);
    if (length < sizeof first) {
        memcpy(first, text, length);
    }
    const int automatic = strcmp(first, "auto") == 0;
    j->shard = automatic ? find_task() : parse_count(first, SHARDS_MAX);
    j->shards = slash || automatic ? parse_count(count, SHARDS_MAX) : 0;
    if (automatic && j->shard == 0) {
        return usage("--shard auto needs a task from 1 on in SLURM_ARRAY_TASK_ID, PBS_ARRAY_INDEX "
                     "or HQ_TASK_ID, not",
                     text);
    }
    if (j->shards == 0 || j->shard == 0 || j->shard > j->shards) {
        return usage("--shard needs K/N with K from 1 to N, auto/N or, under Slurm, auto, not",
                     text);
    }
    return EXIT_DONE;
}

static int read_jobs(job *j)
{
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    j->jobs = 1;
    if (j->o->jobs && strcmp(j->o->jobs, "all") == 0) {
        j->jobs = cores > 0 ? (size_t)cores : 1;
    } else if (j->o->jobs) {
        j->jobs = parse_count(j->o->jobs, JOBS_MAX);
    }
    return j->jobs > 0 ? EXIT_DONE
                       : usage("--jobs needs a number from 1 to 1024, or all, not", j->o->jobs);
}

static int make_paths(job *j, const se3d_model *model)
{
    const char *name = se3d_model_get_name(model);
    char file[64] = "study.csv";
    const int length = j->o->directory
                           ? snprintf(j->folder, sizeof j->folder, "%s", j->o->directory)
                           : snprintf(j->folder, sizeof j->folder, "results/%s", name);
    if (j->shards > 1) {
        snprintf(file, sizeof file, "study.%" PRIu32 "-of-%" PRIu32 ".csv", j->shard, j->shards);
    }
    if (length < 0 || (size_t)length >= sizeof j->folder) {
        return fail(j, "the path of the results is too long");
    }
    snprintf(j->path, sizeof j->path, "%s/%s", j->folder, file);
    return EXIT_DONE;
}

/* ---- running ---------------------------------------------------------------------------------*/

/* A line at every tenth: it may go to a file. On a terminal it takes the place of the last one. */
static void show(job *j)
{
    const int terminal = isatty(STDERR_FILENO);
    const size_t parts = terminal ? 100 : 10;
    const size_t now = j->total > 0 ? parts * j->done / j->total : parts;
    if (j->o->quiet || now == j->shown) {
        return;
    }
    j->shown = now;
    fprintf(stderr, "%sstudy: %zu of %zu samples, %" PRIu64 " failed%s", terminal ? "\r" : "",
            j->done, j->total, se3d_study_table_count_failed(j->table), terminal ? "" : "\n");
    if (terminal && j->done == j->total) {
        fputc('\n', stderr);
    }
    fflush(stderr);
}

static int take(void *ctx, const char *row)
{
    job *j = ctx;
    if (SE3D_FAILED(se3d_study_table_append(j->table, row, &j->error))) {
        return 0;
    }
    ++j->done;
    show(j);
    return 1;
}

/* Samples of this shard that the table has not. */
static int list_missing(job *j, sample_list *list)
{
    const uint64_t count = se3d_study_count_samples(j->study);
    j->total = count >= j->shard ? (size_t)((count - j->shard) / j->shards + 1) : 0;
    list->samples = malloc((j->total + 1) * sizeof *list->samples);
    list->count = 0;
    if (!list->samples) {
        return 0;
    }
    for (uint64_t k = j->shard - 1; k < count; k += j->shards) {
        if (!se3d_study_table_has(j->table, k)) {
            list->samples[list->count++] = k;
        }
    }
    j->done = j->total - list->count;
    j->shown = (size_t)-1;
    return 1;
}

static void print_end(const job *j, const char *path, uint64_t samples, uint64_t failed)
{
    if (j->o->json) {
        outcome_tell();
        printf("{\"status\": \"%s\", \"file\": ", failed > 0 ? "failed" : "done");
        json_put_text(path);
        printf(", \"samples\": %" PRIu64 ", \"failed\": %" PRIu64 "}\n", samples, failed);
    } else if (!j->o->quiet) {
        fputs("wrote ", stdout);
        text_put_plain(stdout, path);
        fputs(": ", stdout);
        put_count(samples, "sample", "samples", "");
        printf(failed > 0 ? ", %" PRIu64 " failed, see the column status\n"
                          : ", %" PRIu64 " failed\n",
               failed);
    }
}

static int is_over(void *ctx)
{
    (void)ctx;
    return interrupt_came();
}

static int run_table(job *j)
{
    sample_list list;
    const char *why = "";
    if (!list_missing(j, &list)) {
        return fail(j, "out of memory");
    }
    interrupt_begin();
    se3d_study_set_interrupt(j->study, is_over, NULL);
    const int good = study_run_list(j->study, &list, j->jobs, take, j, &why);
    free(list.samples);
    const uint64_t failed = se3d_study_table_count_failed(j->table);
    if (!good) {
        char text[200];
        snprintf(text, sizeof text, "ended by the user after %zu of %zu samples: --resume goes on",
                 j->done, j->total);
        return fail(j, j->error.message[0] ? j->error.message : why[0] ? why : text);
    }
    print_end(j, j->path, j->total, failed);
    return failed > 0 ? EXIT_FAILED : EXIT_DONE;
}

static int run_study(job *j)
{
    se3d_study_table_def def = se3d_study_table_def_default();
    def.path = j->path;
    def.shard = j->shard;
    def.shards = j->shards;
    def.resume = j->o->resume;
    if (SE3D_FAILED(se3d_study_table_open(j->study, &def, &j->table, &j->error))) {
        return fail(j, j->error.message);
    }
    const int code = run_table(j);
    se3d_study_table_close(j->table);
    return code;
}

/* ---- merging ---------------------------------------------------------------------------------*/

typedef struct path_list {
    char **paths;
    size_t count;
} path_list;

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int is_shard(const char *name)
{
    unsigned shard = 0;
    unsigned shards = 0;
    int end = 0;
    return sscanf(name, "study.%9u-of-%9u.csv%n", &shard, &shards, &end) == 2 && end > 0 &&
           !name[end];
}

/* Shards in the folder of the results. @return false: errno says why. */
static int list_shards(const char *folder, path_list *list)
{
    DIR *dir = opendir(folder);
    if (!dir) {
        return 0;
    }
    for (const struct dirent *entry; errno = 0, (entry = readdir(dir)) != NULL;) {
        if (!is_shard(entry->d_name)) {
            continue;
        }
        const size_t size = strlen(folder) + strlen(entry->d_name) + 2;
        char **grown = realloc(list->paths, (list->count + 1) * sizeof *grown);
        char *path = malloc(size);
        list->paths = grown ? grown : list->paths;
        if (!grown || !path) {
            free(path);
            closedir(dir);
            errno = ENOMEM;
            return 0;
        }
        snprintf(path, size, "%s/%s", folder, entry->d_name);
        list->paths[list->count++] = path;
    }
    const int failure = errno;
    closedir(dir);
    if (list->count > 0) {
        qsort(list->paths, list->count, sizeof *list->paths, compare_paths);
    }
    errno = failure;
    return failure == 0;
}

static void put_problem(void *ctx, const se3d_model_error *error)
{
    (void)ctx;
    complain("%s\n", error->message);
}

/* The only part of one is the table itself: it is looked at, and if it is whole that is all.
 * @return false: errno says why; no table at all is none. */
static int list_table(const job *j, path_list *list)
{
    struct stat about;
    const size_t size = strlen(j->path) + 1;
    if (stat(j->path, &about) != 0) {
        return errno == ENOENT || errno == ENOTDIR;
    }
    list->paths = malloc(sizeof *list->paths);
    char *path = list->paths ? malloc(size) : NULL;
    if (!path) {
        errno = ENOMEM;
        return 0;
    }
    memcpy(path, j->path, size);
    list->paths[list->count++] = path;
    return 1;
}

static int merge(job *j)
{
    path_list list = {NULL, 0};
    se3d_study_merge_options how = se3d_study_merge_options_default();
    uint64_t failed = 0;
    char message[PATH_SIZE + 200];
    int code = EXIT_FAILED;
    int listed = list_shards(j->folder, &list);
    const int has_parts = list.count > 0;
    listed = listed && (has_parts || list_table(j, &list));
    const char *why = listed ? "has no shards, study.K-of-N.csv" : strerror(errno);
    how.report = put_problem;
    how.partial = j->o->partial && has_parts;
    if (!listed || list.count == 0) {
        snprintf(message, sizeof message, "%s: %s", j->folder, why);
        code = fail(j, message);
    } else {
        const se3d_status status = se3d_study_merge(j->study, (const char *const *)list.paths,
                                                    list.count, j->path, &how, &failed, &j->error);
        const int written = !SE3D_FAILED(status) || (status == SE3D_ERR_STATE && how.partial);
        if (written) {
            print_end(j, j->path, se3d_study_count_samples(j->study), failed);
            code = SE3D_FAILED(status) || failed > 0 ? EXIT_FAILED : EXIT_DONE;
        } else if (status == SE3D_ERR_STATE) {
            complain(has_parts ? "not merged; --partial writes what is there\n"
                               : "not whole; --resume goes on with it\n");
        } else {
            code = fail(j, j->error.message);
        }
    }
    for (size_t k = 0; k < list.count; ++k) {
        free(list.paths[k]);
    }
    free(list.paths);
    return code;
}

/* ---- serving ---------------------------------------------------------------------------------*/

/* A reply for each line, until there are no more. */
static int serve(job *j)
{
    char *line = NULL;
    size_t size = 0;
    int code = EXIT_DONE;
    interrupt_begin();
    se3d_study_set_interrupt(j->study, is_over, NULL);
    for (ssize_t length;
         code == EXIT_DONE && !interrupt_came() && (length = getline(&line, &size, stdin)) > 0;) {
        const char *reply = "";
        if (line[strspn(line, " \t\r\n")] == '\0') {
            continue;
        }
        if (SE3D_FAILED(se3d_study_answer(j->study, line, (size_t)length, &reply))) {
            code = fail(j, "out of memory");
        } else if (printf("%s\n", reply) < 0 || fflush(stdout) != 0) {
            code = EXIT_FAILED; /* told at the end */
        }
    }
    free(line);
    return code;
}

/* ---- the command -----------------------------------------------------------------------------*/

static int run_job(job *j, se3d_model *model)
{
    int code = make_paths(j, model);
    if (code != EXIT_DONE) {
        return code;
    }
    if (SE3D_FAILED(se3d_study_create(model, &j->study, &j->error))) {
        report_failure(j->o, "", j->error.message);
        return EXIT_USAGE;
    }
    const options *o = j->o;
    const int asked = o->server || o->merge || o->sensitivities || o->optimize;
    const int has_samples = asked || se3d_study_count_samples(j->study) > 0;
    if (o->optimize || (!has_samples && se3d_study_count_unknowns(j->study) > 0)) {
        code = study_optimize(o, j->study, j->jobs, j->folder);
    } else if (o->sensitivities || !has_samples) {
        code = study_derive(o, j->study, j->jobs, j->folder);
    } else {
        code = o->server ? serve(j) : o->merge ? merge(j) : run_study(j);
    }
    se3d_study_destroy(j->study);
    return code;
}

static int command_study(int count, char *const *words)
{
    options o;
    job j;
    se3d_model *model = NULL;
    int code = options_read(&o, &study_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    memset(&j, 0, sizeof j);
    j.o = &o;
    const int others = o.merge + o.server + o.sensitivities + o.optimize;
    if (others > 1 || (others > 0 && (o.shard || o.resume))) {
        complain(
            "se3d study: --merge, --server, --sensitivities and --optimize go with none of each "
            "other, --shard, --resume\n");
        return EXIT_USAGE;
    }
    if (o.jobs && (o.merge || o.server)) {
        complain("se3d study: --jobs goes with neither --merge nor --server\n");
        return EXIT_USAGE;
    }
    if (o.server && strcmp(o.model, "-") == 0) {
        complain("se3d study: standard input is for the requests of --server; give the model as a "
                 "file\n");
        return EXIT_USAGE;
    }
    code = read_shard(&j);
    code = code == EXIT_DONE ? read_jobs(&j) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    const se3d_model_options how = options_get_model(&o);
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE) {
        code = run_job(&j, model);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry study_entry = {
    .name = "study",
    .run = command_study,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "run a model many times with other parameters, one line a sample",
    .text = "Runs the samples that `study` of a model file asks for and writes a table, study.csv: "
            "parameters, measures, and ok or why the sample failed.\n\n"
            "Sample i is the same on every machine and in every process. With --shard, several "
            "machines run a part each, study.K-of-N.csv; --merge makes one table of them.\n\n"
            "With --server, each line of standard input is a request in JSON, {\"id\": 1, "
            "\"parameters\": {\"m\": 2}}, and each line of standard output its reply, {\"id\": 1, "
            "\"measures\": {\"top\": 0.5}}.",
    .options =
        (const command_option[]){
            {"--output", "-o", "DIR",
             "folder for the table, made if missing (default: results/<model>)"},
            {"--jobs", NULL, "N",
             "run by this many processes, or `all`: one for each processor; with --optimize, its "
             "derivatives"},
            {"--resume", NULL, NULL, "go on with the table that is there"},
            {"--shard", NULL, "K/N",
             "run part K of N; auto/N: K from SLURM_ARRAY_TASK_ID, PBS_ARRAY_INDEX or HQ_TASK_ID; "
             "auto: both from Slurm"},
            {"--merge", NULL, NULL, "make study.csv of the parts; tell what is missing"},
            {"--partial", NULL, NULL, "with --merge: also if samples are missing"},
            {"--server", NULL, NULL, "answer requests, one a line"},
            {"--sensitivities", NULL, NULL,
             "in place of samples: derivatives of the measures with respect to the parameters, "
             "where these are as in the model, with their estimated errors: sensitivities.csv"},
            {"--optimize", NULL, NULL,
             "in place of samples: seek the parameters under `optimize`; each evaluation is a line "
             "of optimize.csv"},
            COMMAND_OPTION_SET,
            {"--analysis", NULL, "T", "instead of those of the model: {analyses}"},
            COMMAND_OPTIONS_OF_SOLVERS,
            {"--json", NULL, NULL, "print the summary as JSON"},
            {0}},
    .examples =
        (const command_example[]){
            {"study damper.yaml --jobs all", "all samples, table in results/damper/study.csv"},
            {"study damper.yaml --shard 2/7 --resume", "the second of seven parts, or its rest"},
            {"study damper.yaml --merge", "one table of all parts"},
            {"study gears.yaml --optimize", "the best parameters, and how to run them"},
            {"study damper.yaml --sensitivities", "what each parameter does to each measure"},
            {0}},
    .exits = "0 done; 1 samples failed (their rows say why), not all were run, or parts are "
             "missing; 2 bad usage or model.",
};
