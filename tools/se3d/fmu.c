/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d fmu MODEL: a functional mock-up unit for other simulation programs. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#include <unistd.h>
#endif

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "file.h"
#include "io/fmi/package.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "text.h"

enum { PATH_SIZE = 4096 };

/* From the folder of the program, where both are installed. */
#if !defined(SE3D_FMU_PLACE)
#define SE3D_FMU_PLACE "../lib/se3d"
#endif

/* The shared object: SE3D_FMU_OBJECT, beside an installed program, or where it is built. */
static int find_object(char *path, size_t size)
{
#if defined(_WIN32)
    (void)path;
    (void)size;
    return 0;
#else
    static const char *const places[] = {SE3D_FMU_PLACE, "../lib"};
    char program[PATH_SIZE];
    const char *given = getenv("SE3D_FMU_OBJECT");
    if (given) {
        snprintf(path, size, "%s", given);
        return 1;
    }
    if (!process_get_own_folder(program, sizeof program)) {
        return 0;
    }
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
        const int used = snprintf(path, size, "%s/%s/se3d_fmu.so", program, places[k]);
        if (used > 0 && (size_t)used < size && access(path, R_OK) == 0) {
            return 1;
        }
    }
    return 0;
#endif
}

static int read_version(const options *o, int *version)
{
    const char *text = o->fmi ? o->fmi : "2";
    if (strcmp(text, "2") == 0 || strcmp(text, "2.0") == 0) {
        *version = 2;
    } else if (strcmp(text, "3") == 0 || strcmp(text, "3.0") == 0) {
        *version = 3;
    } else {
        complain("se3d fmu: --fmi is `%s`, must be 2 or 3\n", text);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static void print_done(const options *o, const se3di_fmi_package *p, const char *target)
{
    if (o->json) {
        outcome_tell();
        printf("{\"status\": \"done\", \"file\": ");
        json_put_text(target);
        printf(", \"fmi\": \"%d.0\", \"inputs\": %zu, \"parameters\": %zu, \"outputs\": %zu, "
               "\"states\": %zu}\n",
               p->version, p->inputs, p->parameters, p->outputs, p->states);
    } else if (!o->quiet) {
        fputs("wrote ", stdout);
        text_put_plain(stdout, target);
        printf(": FMI %d.0 for co-simulation%s, ", p->version,
               p->states > 0 ? " and model exchange" : "");
        put_count(p->inputs, "input", "inputs", ", ");
        put_count(p->parameters, "parameter", "parameters", ", ");
        put_count(p->outputs, "output", "outputs", p->states > 0 ? ", " : "\n");
        if (p->states > 0) {
            put_count(p->states, "state", "states", "\n");
        } else {
            fputs("not for model exchange: ", stdout);
            text_put_plain(stdout, p->reason);
            fputs("\n", stdout);
        }
    }
}

/* The unit under a temporary name first. */
static int write_unit(const options *o, se3di_fmi_package *p, const char *target)
{
    se3d_model_error error = {.message = ""};
    FILE *file = se3di_partial_open(target);
    if (!file) {
        return report_unwritten(o, target);
    }
    const se3d_status status = se3di_fmi_package_write(p, file, &error);
    if (status < 0) {
        se3di_partial_abandon(file, target);
        report_failure(o, "", error.message);
        return status == SE3D_ERR_UNSUPPORTED ? EXIT_USAGE : EXIT_FAILED;
    }
    if (!file_end(file, target, 1)) {
        return report_unwritten(o, target);
    }
    print_done(o, p, target);
    return EXIT_DONE;
}

static int make_unit(const options *o, const char *object, int version)
{
    char target[PATH_SIZE];
    se3d_model *model = NULL;
    const se3d_model_options how = options_get_model(o);
    int code = options_read_model(o, &how, &model);
    if (code != EXIT_DONE) {
        return code;
    }
    snprintf(target, sizeof target, "%s%s",
             o->directory ? o->directory : se3d_model_get_name(model), o->directory ? "" : ".fmu");
    se3di_fmi_package package = {.model = model,
                                 .path = o->model,
                                 .options = &how,
                                 .object = object,
                                 .target = target,
                                 .version = version};
    code = write_unit(o, &package, target);
    se3d_model_destroy(model);
    return code;
}

static int command_fmu(int count, char *const *words)
{
    options o;
    char object[PATH_SIZE];
    int version = 2;
    int code = options_read(&o, &fmu_entry, count, words);
    if (code != EXIT_DONE || o.help) {
        return code;
    }
    code = options_check_file(&o, &fmu_entry);
    code = code == EXIT_DONE ? read_version(&o, &version) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (!find_object(object, sizeof object)) {
        report_failure(&o, "se3d_fmu.so",
                       "what runs in a unit is missing: this se3d was built without it (CMake "
                       "option SE3D_FMU, which needs libyaml.a and libamd.a), or it lies "
                       "elsewhere (SE3D_FMU_OBJECT)");
        return EXIT_FAILED;
    }
    return make_unit(&o, object, version);
}

const command_entry fmu_entry = {
    .name = "fmu",
    .run = command_fmu,
    .operands = "MODEL",
    .files = "yaml yml json",
    .summary = "make a functional mock-up unit (FMI) of a model",
    .text =
        "Makes a functional mock-up unit for co-simulation and model exchange: an archive with a "
        "description, the files of the model and all that runs it, for other simulation programs "
        "on machines of this kind. Inputs are the numbers of forces, torques, efforts and drivers, "
        "parameters "
        "those of the model, outputs the channels of its `output`. The last analysis in which time "
        "passes is stepped through; those before it are run when the unit is initialized. "
        "docs/fmi.md says more.",
    .options =
        (const command_option[]){
            {"--output", "-o", "FILE.fmu", "the unit; without it, the model's name in this folder"},
            {"--fmi", NULL, "2|3", "version of the standard, 2.0 if not told"},
            COMMAND_OPTION_SET,
            {"--analysis", NULL, "T", "run only this one: {analyses}"},
            COMMAND_OPTIONS_OF_SOLVERS,
            {"--json", NULL, NULL, "print what was made as JSON"},
            {0}},
    .examples = (const command_example[]){{"fmu model.yaml -o model.fmu", "a unit of FMI 2.0"},
                                          {"fmu model.yaml --fmi 3 --set k=2e4",
                                           "of FMI 3.0, with another parameter"},
                                          {0}},
    .exits = "0 done; 1 the unit could not be written; 2 bad usage or bad model, or one that "
             "cannot be a unit.",
};
