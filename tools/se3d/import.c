/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d import FILE: a model of another program as a model file. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "file.h"
#include "options.h"
#include "outcome.h"
#include "se3d/import.h"
#include "text.h"

static const char *const kinds[] = {"", "not carried", "changed", "named", "note"};
static const char *const json_kinds[] = {"", "lost", "changed", "named", "note"};

static void print_text(const options *o, const se3d_model_import *import)
{
    for (size_t k = 0; k < se3d_model_import_count_notes(import); ++k) {
        se3d_model_import_note note;
        if (SE3D_FAILED(se3d_model_import_get_note(import, k, &note)) ||
            (o->quiet && note.kind != SE3D_IMPORT_LOST)) {
            continue;
        }
        text_put_plain(stderr, o->model);
        if (note.line > 0) {
            fprintf(stderr, ":%zu", note.line);
        }
        fprintf(stderr, ": %s: ", kinds[note.kind]);
        text_put_plain(stderr, note.message);
        fputc('\n', stderr);
    }
    const size_t lost = se3d_model_import_count_lost(import);
    if (lost > 0 && !o->partial) {
        fprintf(stderr, "%zu could not be carried; --partial makes it no failure\n", lost);
    }
}

static void print_json(const se3d_model_import *import)
{
    printf("{\"status\": \"done\", \"format\": ");
    json_put_text(se3d_model_import_get_format(import));
    printf(", \"lost\": %zu, \"notes\": [", se3d_model_import_count_lost(import));
    for (size_t k = 0; k < se3d_model_import_count_notes(import); ++k) {
        se3d_model_import_note note;
        if (SE3D_FAILED(se3d_model_import_get_note(import, k, &note))) {
            continue;
        }
        printf("%s{\"line\": %zu, \"kind\": \"%s\", \"message\": ", k > 0 ? ", " : "", note.line,
               json_kinds[note.kind]);
        json_put_text(note.message);
        putchar('}');
    }
    fputs("]}\n", stdout);
}

/* The folder that a path of a file names. @return NULL: no memory. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + (slash == path) : 1;
    char *folder = malloc(length + 1);
    if (folder) {
        memcpy(folder, slash ? path : ".", length);
        folder[length] = '\0';
    }
    return folder;
}

static int write_model(const options *o, const se3d_model_import *import)
{
    size_t length = 0;
    const char *text = se3d_model_import_get_text(import, &length);
    if (!o->directory) {
        return fwrite(text, 1, length, stdout) == length ? EXIT_DONE : EXIT_FAILED;
    }
    FILE *file = se3di_partial_open(o->directory);
    const int good = file && fwrite(text, 1, length, file) == length;
    if (!file || !file_end(file, o->directory, good)) {
        return report_unwritten(o, o->directory);
    }
    return EXIT_DONE;
}

/* Read what was made, with its meshes: a file that cannot be read is no import. */
static int read_back(const options *o, const se3d_model_import *import)
{
    size_t length = 0;
    const char *text = se3d_model_import_get_text(import, &length);
    const char *name = o->directory ? o->directory : "model.yaml";
    se3d_model *model = NULL;
    se3d_model_error error;
    if (SE3D_FAILED(se3d_model_read_text(text, length, name, NULL, &model, &error))) {
        complain("what was made cannot be read, change it by hand:\n");
        report_failure(o, "", error.message);
        return EXIT_FAILED;
    }
    se3d_model_destroy(model);
    return EXIT_DONE;
}

static se3d_status read_source(const options *o, const se3d_model_import_options *how,
                               se3d_model_import **import, se3d_model_error *error)
{
    size_t length = 0;
    if (strcmp(o->model, "-") != 0) {
        return se3d_model_import_file(o->model, how, import, error);
    }
    char *text = options_read_input(&length);
    if (!text) {
        memset(error, 0, sizeof *error);
        snprintf(error->message, sizeof error->message, "stdin: %s", strerror(errno));
        return SE3D_ERR_IO;
    }
    const se3d_status status = se3d_model_import_text(text, length, "stdin", how, import, error);
    free(text);
    return status;
}

static int import_model(const options *o, const char *folder)
{
    se3d_model_import_options how = se3d_model_import_options_default();
    se3d_model_import *import = NULL;
    se3d_model_error error;
    how.folder = folder;
    how.format = o->format;
    how.merge_fixed = o->merge_fixed;
    how.free_base = o->free_base;
    if (SE3D_FAILED(read_source(o, &how, &import, &error))) {
        report_failure(o, "", error.message);
        return EXIT_USAGE;
    }
    int code = write_model(o, import);
    if (code == EXIT_DONE) {
        print_text(o, import);
        code = read_back(o, import);
    }
    if (code == EXIT_DONE) {
        if (o->json) {
            outcome_tell();
            print_json(import);
        }
        code = se3d_model_import_count_lost(import) > 0 && !o->partial ? EXIT_FAILED : EXIT_DONE;
    }
    se3d_model_import_destroy(import);
    return code;
}

static int command_import(int count, char *const *words)
{
    options o;
    int code = options_read(&o, &import_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    char *folder = o.directory ? folder_of(o.directory) : NULL;
    if (o.directory && !folder) {
        report_failure(&o, o.directory, "out of memory");
        return EXIT_FAILED;
    }
    code = import_model(&o, folder);
    free(folder);
    return code;
}

const command_entry import_entry = {
    .name = "import",
    .run = command_import,
    .prints = 1,
    .operands = "FILE",
    .files = "urdf adm",
    .summary = "make a model file of a model of another program",
    .text = "Makes a model file of a robot in URDF, SDF or MJCF, of an Adams data set or a Chrono "
            "model. What cannot be carried, "
            "was changed or has "
            "another name is listed with its line, and stands at the beginning of the model file, "
            "too. docs/import.md says what becomes of what.",
    .options =
        (const command_option[]){
            {"--output", "-o", "MODEL.yaml", "the model file; without it, or -, it is printed"},
            {"--partial", NULL, NULL, "exit code 0 although something could not be carried"},
            {"--format", NULL, "FORMAT", "urdf, sdf, mjcf, adams, chrono or me751, if not told"},
            {"--merge-fixed", NULL, NULL, "links on fixed joints become one body"},
            {"--free-base", NULL, NULL, "the root of a robot may move; otherwise it is fixed"},
            {"--quiet", "-q", NULL, "list only what could not be carried"},
            {"--json", NULL, NULL, "print the list as JSON; needs -o"},
            {0}},
    .examples =
        (const command_example[]){
            {"import robot.urdf -o robot.yaml", "a robot, and what is different from its file"},
            {"import car.adm -o car.yaml --partial", "an Adams model, whatever is missing"},
            {"import robot.urdf --merge-fixed -o robot.yaml", "with fewer bodies"},
            {0}},
    .exits = "0 done; 1 something could not be carried (the model file is written all the same), "
             "or the model file could not be written, or not be read again; 2 bad usage or "
             "malformed file.",
};
