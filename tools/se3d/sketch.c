/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d sketch MODEL: one picture of a model as engineers draw it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "io/write/sketch.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "view.h"

enum { PATH_SIZE = 4096 };

#define RADIAN 0.017453292519943295 /* of a degree */

/* The folder is the one that is worked in: "dir/arm.yaml" becomes "arm.svg"; what comes from
 * standard input goes to standard output. */
static int make_path(const options *o, char *path, size_t size)
{
    if (o->directory) {
        return snprintf(path, size, "%s", o->directory) < (int)size;
    }
    if (strcmp(o->model, "-") == 0) {
        return snprintf(path, size, "-") > 0;
    }
    const char *name = path_get_name(o->model);
    const char *dot = strrchr(name, '.');
    const int length = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    return length < (int)size - 8 && snprintf(path, size, "%.*s.svg", length, name) > 0;
}

static int write_sketch(const options *o, se3d_model *model, const double *view, const char *path)
{
    const int prints = strcmp(path, "-") == 0;
    FILE *file = prints ? stdout : se3di_partial_open(path);
    const se3d_status status = file ? se3di_sketch_put(model, view, file) : SE3D_ERR_IO;
    errno = file && SE3D_FAILED(status) ? EINVAL : errno;
    const int good = file && !SE3D_FAILED(status) && !ferror(file);
    if (prints ? good && fflush(stdout) == 0 : file && file_end(file, path, good)) {
        if (!prints) {
            outcome_add_file(path, o->quiet, "\n");
        }
        return EXIT_DONE;
    }
    if (file && SE3D_FAILED(status)) {
        const char *why = se3d_system_get_error(se3d_model_get_system(model));
        complain("se3d sketch: %s: %s\n", o->model, why[0] ? why : se3d_status_get_text(status));
    } else {
        complain("se3d sketch: %s: cannot be written: %s\n", path, strerror(errno));
    }
    return EXIT_FAILED;
}

static int command_sketch(int count, char *const *words)
{
    char path[PATH_SIZE];
    double view[2] = {0.0, 0.0};
    options o;
    se3d_model *model = NULL;
    int code = options_read(&o, &sketch_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    if (!view_read_angles("sketch", o.view, view) || !make_path(&o, path, sizeof path)) {
        return EXIT_USAGE;
    }
    view[0] *= RADIAN;
    view[1] *= RADIAN;
    se3d_model_options how = options_get_model(&o);
    how.mass_optional = 1; /* nothing moves */
    code = options_read_model(&o, &how, &model);
    if (code == EXIT_DONE) {
        code = write_sketch(&o, model, o.view ? view : NULL, path);
    }
    se3d_model_destroy(model);
    return code;
}

const command_entry sketch_entry = {
    .name = "sketch",
    .run = command_sketch,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "draw a model as an engineer's sketch",
    .text = "Writes one picture (SVG) of a model where its file puts it: bodies as links with "
            "numbers, joints as the symbols of kinematic diagrams with letters, springs, dampers, "
            "ground, frames; beside it the list of all, and the degrees of freedom. A planar "
            "mechanism is seen along its pins, another one from where its joints are seen apart.",
    .options =
        (const command_option[]){
            {"--output", "-o", "FILE.svg",
             "where to (default: MODEL.svg, here), - for standard output"},
            {"--view", NULL, "A,E", "azimuth and elevation of the eye [degrees]"},
            COMMAND_OPTION_SET,
            {0}},
    .examples =
        (const command_example[]){{"sketch fourbar.yaml", "fourbar.svg"},
                                  {"sketch car.yaml --view 30,20 -o car.svg", "from another side"},
                                  {"sketch - <arm.yaml >arm.svg", "within a pipe"},
                                  {0}},
    .exits = "0 done; 1 the file cannot be written; 2 bad usage or model.",
    .prints = COMMAND_PRINTS_GIVEN,
};
