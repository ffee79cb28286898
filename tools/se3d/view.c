/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d view DIR: one HTML file with the scene, its results and all that shows them. */
#define _XOPEN_SOURCE 700

#include "view.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "child.h"
#include "file.h"
#include "interrupt.h"
#include "options.h"
#include "process.h"
#include "snapshots.h"
#include "table.h"
#include "text.h"

enum { RESULTS_SIZE = 120 * 1024, PATH_SIZE = 4096 };

static char *read_whole(const char *path, size_t *size)
{
    FILE *file = se3di_file_open(path);
    char *data = NULL;
    *size = 0;
    if (file && fseek(file, 0, SEEK_END) == 0) {
        const long length = ftell(file);
        rewind(file);
        data = length >= 0 ? malloc((size_t)length + 1) : NULL;
        if (data) {
            *size = fread(data, 1, (size_t)length, file);
            data[*size] = '\0';
        }
    }
    if (file) {
        fclose(file);
    }
    return data;
}

/* True if a file begins with a column of times. */
static int has_times(const char *path)
{
    char head[5] = "";
    FILE *file = se3di_file_open(path);
    const int has = file && fread(head, 1, 5, file) == 5 && memcmp(head, "time,", 5) == 0;
    if (file) {
        fclose(file);
    }
    return has;
}

/* The first results file of a folder, by name: of channels over time (spectra of plots left out),
 * or of particles. */
static int find_results(const char *folder, int particles, char *path, size_t size)
{
    char best[300] = "";
    DIR *list = opendir(folder);
    for (const struct dirent *d; list && (d = readdir(list)) != NULL;) {
        const size_t length = strlen(d->d_name);
        if (length <= 4 || length >= sizeof best || strcmp(d->d_name + length - 4, ".csv") != 0 ||
            strstr(d->d_name, ".fft.csv") || (best[0] && strcmp(d->d_name, best) > 0)) {
            continue;
        }
        snprintf(path, size, "%s/%s", folder, d->d_name);
        if (has_times(path) && snapshots_is(path) == particles) {
            strcpy(best, d->d_name);
        }
    }
    if (list) {
        closedir(list);
    }
    snprintf(path, size, "%s/%s", folder, best);
    return best[0] != '\0';
}

static int put_table(FILE *file, const table *t)
{
    char unit[60];
    if (t->count == 0) {
        fputs("{\"names\":[],\"units\":[],\"data\":\"\"}", file);
        return 1;
    }
    const size_t room = RESULTS_SIZE / (4 * t->count);
    const size_t most = room < 50 ? 50 : room;
    const size_t stride = (t->rows + most - 1) / most;
    double *values = malloc((most + 1) * t->count * sizeof *values);
    float *single = malloc((most + 1) * t->count * sizeof *single);
    const size_t rows = values && single ? table_read_rows(t, stride, values, most + 1) : 0;
    for (size_t k = 0; k < rows * t->count; ++k) {
        single[k] = (float)values[k];
    }
    fputs("{\"names\":[", file);
    for (size_t k = 0; k < t->count; ++k) {
        fputs(k > 0 ? "," : "", file);
        text_put_script(file, t->names[k]);
    }
    fputs("],\"units\":[", file);
    for (size_t k = 0; k < t->count; ++k) {
        fputs(k > 0 ? "," : "", file);
        text_put_script(file, table_get_unit(t, t->names[k], unit, sizeof unit));
    }
    fputs("],\"data\":\"", file);
    if (rows > 0) {
        base64_put(file, single, rows * t->count * sizeof *single);
    }
    fputs("\"}", file);
    free(values);
    free(single);
    return rows > 0;
}

/* The folder of the page's parts: SE3D_VIEWER, beside an installed program, or in the sources. */
static int find_viewer(char *folder, size_t size)
{
    static const char *const places[] = {"../share/se3d/viewer", "../../../tools/viewer",
                                         "../../tools/viewer"};
    char program[PATH_SIZE];
    char self[PATH_SIZE];
    char file[PATH_SIZE + 64];
    const char *given = getenv("SE3D_VIEWER");
    if (given) {
        snprintf(folder, size, "%s", given);
        return 1;
    }
    if (!path_get_absolute("/proc/self/exe", self, sizeof self) ||
        !path_get_folder(self, program, sizeof program)) {
        return 0;
    }
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        const int used = snprintf(folder, size, "%s/%s", program, places[k]);
        snprintf(file, sizeof file, "%.4000s/viewer.js", folder);
        if (used > 0 && (size_t)used < size && access(file, R_OK) == 0) {
            return 1;
        }
    }
    return 0;
}

/* The place where three.js is kept. @return false: the user has no place for it. */
static int find_cache(char *folder, size_t size)
{
    const char *given = getenv("SE3D_CACHE");
    const char *user = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    const int used = given               ? snprintf(folder, size, "%s", given)
                     : (user && user[0]) ? snprintf(folder, size, "%s/se3d", user)
                     : (home && home[0]) ? snprintf(folder, size, "%s/.cache/se3d", home)
                                         : 0;
    return used > 0 && (size_t)used < size;
}

static int put_file(FILE *out, const char *folder, const char *name)
{
    char path[PATH_SIZE + 64];
    size_t size = 0;
    snprintf(path, sizeof path, "%.4000s/%s", folder, name);
    char *data = read_whole(path, &size);
    if (!data) {
        fprintf(stderr, "se3d: %s: cannot be read\n", path);
        return 0;
    }
    fwrite(data, 1, size, out);
    free(data);
    return 1;
}

typedef struct page {
    char viewer[PATH_SIZE];
    char cache[PATH_SIZE];
    int is_passing; /* the cache is a folder of this page alone */
    char *glb;
    size_t glb_size;
    table results;                   /* empty: there are none */
    char particles[PATH_SIZE + 300]; /* file of snapshots; "": none */
    const char *command;
} page;

static int put_page(FILE *file, const page *p)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width\">"
          "<link rel=\"icon\" href=\"data:,\">\n<title>se3d</title>\n<style>\n",
          file);
    int good = put_file(file, p->viewer, "viewer.css");
    fputs("</style></head><body>\n", file);
    good = good && put_file(file, p->viewer, "viewer.html");
    fputs("<script type=\"text/plain\" id=\"glb\">", file);
    base64_put(file, p->glb, p->glb_size);
    fputs("</script>\n<script type=\"application/json\" id=\"results\">", file);
    good = good && put_table(file, &p->results);
    fputs("</script>\n<script type=\"application/json\" id=\"grains\">", file);
    if (p->particles[0]) {
        good = good && snapshots_put(file, p->command, p->particles);
    } else {
        fputs("null", file);
    }
    fputs("</script>\n<script>\n", file);
    good = good && put_file(file, p->cache, "three.js");
    fputs("\n</script>\n<script>\n", file);
    good = good && put_file(file, p->viewer, "viewer.js");
    fputs("</script>\n</body></html>\n", file);
    return good;
}

static int write_page(const page *p, const char *path)
{
    FILE *file = se3di_partial_open(path);
    if (!file || !file_end(file, path, put_page(file, p) && !interrupt_came())) {
        fprintf(stderr, "se3d %s: %s: cannot be written: %s\n", p->command, path,
                interrupt_came() ? "interrupted" : strerror(errno ? errno : ENOSPC));
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

/* Whether what is at `path` may be run or shown: if not, says so. */
static int check_own(const page *p, const char *path)
{
    if (file_is_own(path)) {
        return 1;
    }
    fprintf(stderr,
            "se3d %s: %s belongs to another user, or others can change it; set SE3D_CACHE to a "
            "folder of your own\n",
            p->command, path);
    return 0;
}

/* Make three.js in the cache, if it is not. What others could have put there is not taken, and
 * nothing is run where they could. */
static int make_three(const page *p)
{
    char script[PATH_SIZE + 64];
    snprintf(script, sizeof script, "%.4000s/build.sh", p->viewer);
    const char *const words[] = {"sh", script, p->cache, NULL};
    if (!file_is_missing(p->cache) && !check_own(p, p->cache)) {
        return EXIT_FAILED;
    }
    if (process_run(NULL, words) != 0) {
        fprintf(stderr, "se3d %s: three.js could not be made, see above\n", p->command);
        return EXIT_FAILED;
    }
    snprintf(script, sizeof script, "%.4000s/three.js", p->cache);
    return check_own(p, p->cache) && check_own(p, script) ? EXIT_DONE : EXIT_FAILED;
}

static int prepare(page *p, const char *command)
{
    char script[PATH_SIZE + 64];
    if (!find_viewer(p->viewer, sizeof p->viewer)) {
        fprintf(stderr,
                "se3d %s: the parts of the page are not found; set SE3D_VIEWER to the folder "
                "tools/viewer of the source\n",
                command);
        return EXIT_FAILED;
    }
    snprintf(script, sizeof script, "%.4000s/three.js", p->viewer);
    if (access(script, R_OK) == 0) { /* installed with the program */
        strcpy(p->cache, p->viewer);
        return EXIT_DONE;
    }
    if (!find_cache(p->cache, sizeof p->cache)) {
        p->is_passing = folder_make_temporary(p->cache, sizeof p->cache);
        if (!p->is_passing) {
            fprintf(stderr, "se3d %s: no temporary folder: %s\n", command, strerror(errno));
            return EXIT_FAILED;
        }
    }
    return make_three(p);
}

int view_write(const char *command, const char *folder, const char *path)
{
    char name[PATH_SIZE + 300];
    page *p = calloc(1, sizeof *p);
    int code = EXIT_FAILED;
    if (!p) {
        return EXIT_FAILED;
    }
    p->command = command;
    snprintf(name, sizeof name, "%.4000s/scene.glb", folder);
    p->glb = read_whole(name, &p->glb_size);
    if (!p->glb || p->glb_size < 28) {
        fprintf(stderr, "se3d %s: %s: cannot be read; `se3d run MODEL -o %s` makes it\n", command,
                name, folder);
    } else if (!find_results(folder, 0, name, sizeof name) ||
               table_read(&p->results, command, name)) {
        if (!find_results(folder, 1, p->particles, sizeof p->particles)) {
            p->particles[0] = '\0';
        }
        code = prepare(p, command);
        code = code == EXIT_DONE ? write_page(p, path) : code;
        table_destroy(&p->results);
        if (p->is_passing) {
            folder_remove(p->cache);
        }
    }
    free(p->glb);
    free(p);
    return code;
}

static int command_view(int count, char *const *words)
{
    char folder[PATH_SIZE];
    char path[PATH_SIZE + 64];
    options o;
    interrupt_begin();
    int code = options_read(&o, &view_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    code = run_for_view("view", o.model, o.quiet, folder, sizeof folder);
    if (code != EXIT_DONE) {
        return code;
    }
    snprintf(path, sizeof path, "%.4000s/scene.html", folder);
    code = view_write("view", folder, o.directory ? o.directory : path);
    if (code == EXIT_DONE && !o.quiet) {
        printf("wrote %s\n", o.directory ? o.directory : path);
    }
    return code;
}

const command_entry view_entry = {
    .name = "view",
    .run = command_view,
    .operands = "DIR|MODEL",
    .files = "yaml yml json",
    .summary = "make one HTML file that shows results in 3-D",
    .text = "Writes one HTML file (default DIR/scene.html) that shows the results in "
            "DIR, as `se3d run` left them, in any browser and without a network: the "
            "motion in 3-D beside a plot of a channel. A model is run first, into "
            "results/<model>. Keys: space plays, arrows step, + "
            "and - change the speed, b follows a body, f shows frames, r reactions, t "
            "traces, d is for dark; drag turns, shift-drag moves, the wheel zooms.",
    .options = (const command_option[]){{"--output", "-o", "FILE.html",
                                         "where to (default: DIR/scene.html)"},
                                        COMMAND_OPTION_QUIET,
                                        {0}},
    .examples = (const command_example[]){{"view results/pendulum", "results/pendulum/scene.html"},
                                          {"view pendulum.yaml", "run, then show"},
                                          {"view results/pendulum -o page.html", "another file"},
                                          {0}},
    .exits = "0 done; 1 a file or program failed; 2 bad usage.",
};
