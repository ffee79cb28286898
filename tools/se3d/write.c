/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d write MODEL: a model as one file in standard form. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "file.h"
#include "io/write/save_source.h"
#include "options.h"
#include "outcome.h"
#include "text.h"

static int print_model(const options *o, const se3d_model *model, const se3d_write_options *how)
{
    size_t length = 0;
    se3d_model_error error;
    char *text = NULL;
    se3d_status status = se3d_model_write_text(model, how, NULL, 0, &length, &error);
    if (status >= 0) {
        snprintf(error.message, sizeof error.message, "out of memory");
        text = malloc(length + 1);
        status = text ? se3d_model_write_text(model, how, text, length + 1, &length, &error)
                      : SE3D_ERR_NO_MEMORY;
    }
    if (status < 0) {
        report_failure(o, "", error.message);
        free(text);
        return EXIT_FAILED;
    }
    const int good = fwrite(text, 1, length, stdout) == length;
    free(text);
    return good ? EXIT_DONE : EXIT_FAILED;
}

static int write_model(const options *o, const se3d_model *model)
{
    se3d_write_options how = se3d_write_options_default();
    se3d_model_error error;
    how.partial = o->partial;
    if (!o->directory) {
        return print_model(o, model, &how);
    }
    if (SE3D_FAILED(se3d_model_write(model, o->directory, &how, &error))) {
        report_failure(o, "", error.message);
        return EXIT_FAILED;
    }
    outcome_add_file(o->directory, 1, "");
    return EXIT_DONE;
}

/* What a person wrote is not replaced: comments, expressions and parts would be gone. */
static int is_source(const options *o, const se3d_model *model)
{
    return o->directory &&
           (strcmp(o->directory, o->model) == 0 || se3di_file_is_same(o->directory, o->model) ||
            se3di_save_takes_source(model, o->directory));
}

static int command_write(int count, char *const *words)
{
    options o;
    se3d_model *model = NULL;
    int code = options_read(&o, &write_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    se3d_model_options how = options_get_model(&o);
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE && is_source(&o, model)) {
        report_failure(&o, o.directory,
                       "is a file of the model itself, whose comments and expressions would be "
                       "lost: give -o another name");
        code = EXIT_USAGE;
    } else if (code == EXIT_DONE) {
        code = write_model(&o, model);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry write_entry = {
    .name = "write",
    .run = command_write,
    .prints = 1,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "write a model as one file without parts and expressions",
    .text =
        "Writes a model in standard form: includes, instances, repeats, mirrored parts, points, "
        "units and expressions of parameters are resolved, names and numbers stand for what "
        "they became. Comments are not kept. Read again, the elements are the same to the bit. "
        "Analyses, results, events, `fmus` and particles are as the file says them. Of a file with "
        "`units`, analyses and results can be written whose only numbers are seconds; other "
        "such sections, and studies, cannot: --partial leaves them out.",
    .options =
        (const command_option[]){
            {"--output", "-o", "FILE.yaml", "the file; without it, or -, it is printed"},
            {"--partial", NULL, NULL, "leave out what a file cannot hold, with a comment"},
            COMMAND_OPTION_SET,
            {0}},
    .examples =
        (const command_example[]){
            {"write axle.yaml --partial -o whole.yaml", "what two mirrored corners are"},
            {"write pendulum.yaml --set L=2", "the model with another length"},
            {0}},
    .exits = "0 done; 1 it could not be written; 2 bad usage or malformed model.",
};
