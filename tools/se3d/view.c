/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d view DIR: one HTML file with the scene, its results and all that shows them. */
#define _XOPEN_SOURCE 700

#include "view.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "interrupt.h"
#include "options.h"
#include "outcome.h"
#include "page.h"
#include "snapshots.h"
#include "table.h"
#include "text.h"

enum { RESULTS_SIZE = 120 * 1024, PATH_SIZE = 4096, MODES_MAX = 60 };

/* What a results file may hold. */
enum { CHANNELS, PARTICLES, MODES };

static const char modes_head[] = "mode,real,imag,frequency,damping,";
static const char events_head[] = "time,event,";

/* True if a file begins with these columns. */
static int has_head(const char *path, const char *columns)
{
    char head[40] = "";
    const size_t length = strlen(columns);
    FILE *file = se3di_file_open(path);
    const int has =
        file && fread(head, 1, length, file) == length && memcmp(head, columns, length) == 0;
    if (file) {
        fclose(file);
    }
    return has;
}

/* The first results file of a folder, by name: of channels over time (events and spectra of plots
 * left out), of particles, or of modes. */
static int find_results(const char *folder, int kind, char *path, size_t size)
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
        const int is_kind = kind == MODES
                                ? has_head(path, modes_head)
                                : has_head(path, "time,") && !has_head(path, events_head) &&
                                      snapshots_is(path) == (kind == PARTICLES);
        if (is_kind) {
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

typedef struct page {
    page_parts parts;
    char *glb;
    size_t glb_size;
    char *other; /* the scene of another run; NULL: none */
    size_t other_size;
    table results;                   /* empty: there are none */
    char particles[PATH_SIZE + 300]; /* file of snapshots; "": none */
    char modes[PATH_SIZE + 300];     /* "": none */
} page;

/* The modes of a file: one row each, eigenvalue and shape, as docs/viewer.md has them. */
static int put_modes(FILE *file, const page *p)
{
    table t;
    if (!table_read(&t, p->parts.command, p->modes)) {
        return 0;
    }
    const size_t most = t.rows < MODES_MAX ? t.rows : MODES_MAX;
    double *values = malloc((t.rows + 1) * t.count * sizeof *values);
    const size_t rows = values ? table_read_rows(&t, 1, values, t.rows + 1) : 0;
    fputs("{\"names\":[", file);
    for (size_t k = 0; k < t.count; ++k) {
        fputs(k > 0 ? "," : "", file);
        text_put_script(file, t.names[k]);
    }
    fputs("],\"rows\":[", file);
    for (size_t row = 0; row < rows && row < most; ++row) {
        for (size_t k = 0; k < t.count; ++k) {
            const double value = values[row * t.count + k];
            fputs(k > 0 ? "," : row > 0 ? "],[" : "[", file);
            fprintf(file, isfinite(value) ? "%.9g" : "0", value);
        }
    }
    fputs(rows > 0 ? "]]}" : "]}", file);
    free(values);
    table_destroy(&t);
    return rows > 0;
}

static int put_page(FILE *file, const page *p)
{
    int good = page_put_begin(file, &p->parts, 1);
    fputs("<script type=\"text/plain\" id=\"glb\">", file);
    base64_put(file, p->glb, p->glb_size);
    fputs("</script>\n<script type=\"text/plain\" id=\"other\">", file);
    if (p->other) {
        base64_put(file, p->other, p->other_size);
    }
    fputs("</script>\n<script type=\"application/json\" id=\"results\">", file);
    good = good && put_table(file, &p->results);
    fputs("</script>\n<script type=\"application/json\" id=\"grains\">", file);
    if (p->particles[0]) {
        good = good && snapshots_put(file, p->parts.command, p->particles);
    } else {
        fputs("null", file);
    }
    fputs("</script>\n<script type=\"application/json\" id=\"modes\">", file);
    if (p->modes[0]) {
        good = good && put_modes(file, p);
    } else {
        fputs("null", file);
    }
    fputs("</script>\n", file);
    return good && page_put_end(file, &p->parts, NULL);
}

static int write_page(const page *p, const char *path)
{
    FILE *file = se3di_partial_open(path);
    if (!file || !file_end(file, path, put_page(file, p) && !interrupt_came())) {
        complain("se3d %s: %s: cannot be written: %s\n", p->parts.command, path,
                 interrupt_came() ? "interrupted" : strerror(errno ? errno : ENOSPC));
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

/* The scene of a folder. @return NULL, after a message: there is none. */
static char *read_scene(const char *command, const char *folder, size_t *size)
{
    char name[PATH_SIZE + 300];
    snprintf(name, sizeof name, "%.4000s/scene.glb", folder);
    char *glb = page_read_whole(name, size);
    if (glb && *size >= 28) {
        return glb;
    }
    complain("se3d %s: %s: cannot be read; `se3d run MODEL -o %s` makes it\n", command, name,
             folder);
    free(glb);
    return NULL;
}

int view_write(const char *command, const char *folder, const char *other, const char *path)
{
    char name[PATH_SIZE + 300];
    page *p = calloc(1, sizeof *p);
    int code = EXIT_FAILED;
    if (!p) {
        return EXIT_FAILED;
    }
    p->glb = read_scene(command, folder, &p->glb_size);
    p->other = p->glb && other ? read_scene(command, other, &p->other_size) : NULL;
    if (!p->glb || (other && !p->other)) {
        code = EXIT_FAILED;
    } else if (!find_results(folder, CHANNELS, name, sizeof name) ||
               table_read(&p->results, command, name)) {
        if (!find_results(folder, PARTICLES, p->particles, sizeof p->particles)) {
            p->particles[0] = '\0';
        }
        if (!find_results(folder, MODES, p->modes, sizeof p->modes)) {
            p->modes[0] = '\0';
        }
        code = page_begin(&p->parts, command);
        code = code == EXIT_DONE ? write_page(p, path) : code;
        table_destroy(&p->results);
        page_end(&p->parts);
    }
    free(p->glb);
    free(p->other);
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
    o.quiet = o.quiet || o.json;
    code = run_for_view("view", o.model, o.quiet, folder, sizeof folder);
    if (code != EXIT_DONE) {
        return code;
    }
    snprintf(path, sizeof path, "%.4000s/scene.html", folder);
    code = view_write("view", folder, o.with, o.directory ? o.directory : path);
    if (code == EXIT_DONE) {
        outcome_add_file(o.directory ? o.directory : path, o.quiet, "\n");
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
    .options =
        (const command_option[]){
            {"--output", "-o", "FILE.html", "where to (default: DIR/scene.html)"},
            {"--with", NULL, "DIR", "results of another run, as a ghost or beside (key g)"},
            {0}},
    .examples = (const command_example[]){{"view results/pendulum", "results/pendulum/scene.html"},
                                          {"view pendulum.yaml", "run, then show"},
                                          {"view results/pendulum -o page.html", "another file"},
                                          {"view results/soft --with results/stiff", "two runs"},
                                          {0}},
    .exits = "0 done; 1 a file or program failed; 2 bad usage.",
};
