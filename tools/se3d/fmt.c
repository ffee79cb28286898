/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d fmt MODEL: the layout of a model file made anew. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "file.h"
#include "io/document/layout.h"
#include "options.h"
#include "outcome.h"
#include "text.h"

/* Whether the file stays as it is is known; write it if not. */
static int write_layout(const options *o, const char *text, size_t length)
{
    FILE *file = se3di_partial_open(o->model);
    const int good = file && fwrite(text, 1, length, file) == length;
    if (!file || !file_end(file, o->model, good)) {
        return report_unwritten(o, o->model);
    }
    if (!o->quiet && !o->json) {
        fputs("laid out ", stdout);
        text_put_plain(stdout, o->model);
        putchar('\n');
    }
    outcome_add_file(o->model, 1, "");
    return EXIT_DONE;
}

static int report_change(const options *o)
{
    if (o->json) {
        complain("%s: its layout would change\n", o->model);
    } else if (!o->quiet) {
        text_put_plain(stdout, o->model);
        puts(": its layout would change");
    }
    return EXIT_FAILED;
}

static int lay_out(const options *o, se3di_iopool *pool, const char *text, size_t length)
{
    se3d_model_error error = {0};
    char *made = NULL;
    size_t made_length = 0;
    const int is_input = strcmp(o->model, "-") == 0;
    const se3d_status status = se3di_layout_make(pool, is_input ? "standard input" : o->model, text,
                                                 length, &made, &made_length, &error);
    if (status < 0) {
        report_failure(o, "", error.message);
        return status == SE3D_ERR_MODEL ? EXIT_USAGE : EXIT_FAILED;
    }
    const int is_same = made_length == length && memcmp(made, text, length) == 0;
    if (o->check) {
        return is_same ? EXIT_DONE : report_change(o);
    }
    if (is_input) {
        return fwrite(made, 1, made_length, stdout) == made_length ? EXIT_DONE : EXIT_FAILED;
    }
    return is_same ? EXIT_DONE : write_layout(o, made, made_length);
}

static int command_fmt(int count, char *const *words)
{
    options o;
    const int code = options_read(&o, &fmt_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    const int is_input = strcmp(o.model, "-") == 0;
    if (is_input && o.json && !o.check) {
        complain("se3d fmt: standard output is for the model or for --json, not for both\n");
        return EXIT_USAGE;
    }
    se3di_iopool pool;
    char *text = NULL;
    size_t length = 0;
    FILE *file = is_input ? stdin : fopen(o.model, "rb");
    if (!file) {
        report_failure(&o, o.model, strerror(errno));
        return EXIT_USAGE;
    }
    se3di_iopool_init(&pool, NULL);
    const se3d_status status = se3di_document_read(&pool, file, &text, &length);
    if (!is_input) {
        fclose(file);
    }
    int result = EXIT_FAILED;
    if (status < 0) {
        report_failure(&o, o.model, status == SE3D_ERR_IO ? "cannot be read" : "out of memory");
    } else {
        result = lay_out(&o, &pool, text, length);
    }
    se3di_iopool_destroy(&pool);
    return result;
}

const command_entry fmt_entry = {
    .name = "fmt",
    .run = command_fmt,
    .operands = "MODEL",
    .files = "yaml yml",
    .summary = "lay a model file out in the usual way",
    .text = "Makes indents, spaces and empty lines of a model file as in the examples, and writes "
            "it in its place if that changes it; a model from standard input (-) goes to standard "
            "output. Lines stay lines, comments, order and the characters of all values stay as "
            "they are, so the model is the same. The file has to be YAML; it may be a wrong model, "
            "which `se3d check` tells.",
    .options =
        (const command_option[]){
            {"--check", NULL, NULL, "change nothing; exit 1 if the layout would change"}, {0}},
    .examples = (const command_example[]){{"fmt car.yaml", "lay it out"},
                                          {"fmt --check car.yaml", "only look"},
                                          {"fmt - < a.yaml > b.yaml", "from one file to another"},
                                          {0}},
    .exits = "0 done; 1 with --check: its layout would change, or it cannot be written; 2 it "
             "cannot be read or is not YAML.",
};
