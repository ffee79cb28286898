/* SPDX-License-Identifier: BSD-3-Clause */
/* The files of a model keep the places that they have to each other: where one is named "../x" the
 * model itself lies so many folders down among the resources. */
#include "io/fmi/package.h"

#include <errno.h>
#include <string.h>

#include "io/base/file.h"
#include "io/document/document.h"
#include "io/fmi/description.h"
#include "io/fmi/recipe.h"
#include "io/fmi/states.h"
#include "io/fmi/variables.h"
#include "io/fmi/zip.h"

enum { PATH_SIZE = 2048, UP_MAX = 32 };

#if defined(__x86_64__)
#define PLATFORM2 "linux64"
#define PLATFORM3 "x86_64-linux"
#elif defined(__i386__)
#define PLATFORM2 "linux32"
#define PLATFORM3 "x86-linux"
#elif defined(__aarch64__)
#define PLATFORM2 "aarch64-linux"
#define PLATFORM3 "aarch64-linux"
#else
#define PLATFORM2 "linux"
#define PLATFORM3 "linux"
#endif

/* A file that is in the archive, and where the model has it. */
typedef struct packed {
    const char *name;
    const char *path; /* from the model's folder, and so many folders above it */
    size_t up;
    struct packed *next;
} packed;

typedef struct packer {
    se3di_fmi_package *p;
    se3di_iopool pool;
    se3di_zip zip;
    se3d_model_error *error;
    size_t up; /* folders that the model lies down among the resources */
    packed *resources;
} packer;

static se3d_status fail(packer *k, se3d_status status, const char *path, const char *text)
{
    if (k->pool.is_short) { /* whatever came of that */
        status = SE3D_ERR_NO_MEMORY;
        path = "";
        text = "out of memory";
    }
    se3di_document_report(k->error, "", 0, 0, path, text);
    return status;
}

static se3d_status fail_memory(packer *k)
{
    return fail(k, SE3D_ERR_NO_MEMORY, "", "out of memory");
}

static size_t length_of_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* A path from the model's folder without "." and "..", but for *up of them at its beginning. */
static bool normalize(const char *path, char *out, size_t *up)
{
    size_t used = 0;
    *up = 0;
    while (*path) {
        const size_t length = strcspn(path, "/");
        const bool is_up = length == 2 && path[0] == '.' && path[1] == '.';
        if (is_up && used == 0) {
            ++*up;
        } else if (is_up) {
            out[used - 1] = '\0';
            used = length_of_folder(out);
        } else if (length > 0 && !(length == 1 && path[0] == '.')) {
            if (used + length + 2 > PATH_SIZE) {
                return false;
            }
            memcpy(out + used, path, length);
            used += length;
            out[used++] = '/';
        }
        path += length + (path[length] == '/');
    }
    out[used > 0 ? used - 1 : 0] = '\0';
    return used > 0 && *up <= UP_MAX;
}

/* The path of a file of the model from the model's folder. */
static se3d_status place(packer *k, const se3di_attached_file *f, char *out, size_t *up)
{
    const size_t folder = length_of_folder(k->p->path);
    if (f->name[0] == '/') {
        return fail(k, SE3D_ERR_UNSUPPORTED, f->path,
                    "the model names this file by a path from the root, which another machine does "
                    "not have; name it from the model's folder");
    }
    if (strncmp(f->path, k->p->path, folder) != 0 || !normalize(f->path + folder, out, up)) {
        return fail(k, SE3D_ERR_UNSUPPORTED, f->path, "the path is too long or has too many `..`");
    }
    return SE3D_OK;
}

/* ---- files ----------------------------------------------------------------------------------*/

static se3d_status add_file(packer *k, const char *path, const char *name)
{
    char *bytes = NULL;
    size_t size = 0;
    errno = 0;
    FILE *file = se3di_file_open(path);
    const long length = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (length >= 0 && fseek(file, 0, SEEK_SET) == 0) {
        size = (size_t)length;
        bytes = se3di_iopool_alloc(&k->pool, size + 1);
    }
    const bool good = bytes && fread(bytes, 1, size, file) == size;
    const int why = errno;
    if (file) {
        fclose(file);
    }
    if (!good) {
        return fail(k, SE3D_ERR_IO, path, why ? strerror(why) : "cannot be read");
    }
    se3di_zip_add(&k->zip, name, bytes, size);
    return SE3D_OK;
}

/* The name of a file of the model in the archive, `up` folders above the model's. */
static void name_resource(const packer *k, const char *path, size_t up, char *name, size_t size)
{
    size_t used = (size_t)snprintf(name, size, "resources/");
    for (size_t n = up; n < k->up; ++n) {
        used += (size_t)snprintf(name + used, size - used, "model/");
    }
    snprintf(name + used, size - used, "%s", path);
}

/* Note that a name is taken. *again: by the same file. */
static se3d_status take_name(packer *k, const char *name, const char *path, size_t up, bool *again)
{
    *again = false;
    for (const packed *p = k->resources; p; p = p->next) {
        if (strcmp(p->name, name) == 0) {
            *again = p->up == up && strcmp(p->path, path) == 0;
            return *again ? SE3D_OK
                          : fail(k, SE3D_ERR_UNSUPPORTED, path,
                                 "another file would have its place among the resources; give one "
                                 "of the two another name");
        }
    }
    packed *p = se3di_iopool_alloc(&k->pool, sizeof *p);
    if (!p) {
        return fail_memory(k);
    }
    *p = (packed){se3di_iopool_copy(&k->pool, name, strlen(name)),
                  se3di_iopool_copy(&k->pool, path, strlen(path)), up, k->resources};
    if (!p->name || !p->path) {
        return fail_memory(k);
    }
    k->resources = p;
    return SE3D_OK;
}

static se3d_status add_attached(packer *k)
{
    char path[PATH_SIZE] = "";
    char name[PATH_SIZE + 400];
    for (const se3di_attached_file *f = k->p->model->attached; f; f = f->next) {
        bool again = false;
        size_t up = 0;
        se3d_status status = place(k, f, path, &up);
        if (status >= 0) {
            name_resource(k, path, up, name, sizeof name);
            status = take_name(k, name, path, up, &again);
        }
        if (status >= 0 && !again) {
            status = add_file(k, f->path, name);
        }
        if (status < 0) {
            return status;
        }
    }
    return SE3D_OK;
}

/* How far down the model must lie. */
static se3d_status find_depth(packer *k)
{
    char path[PATH_SIZE] = "";
    for (const se3di_attached_file *f = k->p->model->attached; f; f = f->next) {
        size_t up = 0;
        const se3d_status status = place(k, f, path, &up);
        if (status < 0) {
            return status;
        }
        k->up = up > k->up ? up : k->up;
    }
    return SE3D_OK;
}

/* Texts of the recipe are lines. */
static bool is_line(const char *text)
{
    return !text || !strpbrk(text, "\n\r");
}

static bool are_lines(const se3d_model_options *o)
{
    bool good = is_line(o->analysis) && is_line(o->formulation) && is_line(o->method) &&
                is_line(o->step) && is_line(o->duration) && is_line(o->tolerance);
    for (size_t k = 0; k < o->setting_count; ++k) {
        good = good && is_line(o->settings[k].name) && is_line(o->settings[k].value);
    }
    return good;
}

static se3d_status add_model(packer *k)
{
    char name[PATH_SIZE + 400];
    const char *file = k->p->path + length_of_folder(k->p->path);
    se3di_fmi_recipe recipe = {.options = *k->p->options};
    se3d_status status = find_depth(k);
    if (status < 0) {
        return status;
    }
    if (strlen(file) >= PATH_SIZE || !is_line(file) || !are_lines(k->p->options)) {
        return fail(k, SE3D_ERR_UNSUPPORTED, k->p->path,
                    "the name of the model or an option is too long or has several lines");
    }
    name_resource(k, file, 0, name, sizeof name);
    recipe.model = name + strlen("resources/");
    const char *text = se3di_fmi_recipe_write(&recipe, &k->pool);
    if (!text) {
        return fail_memory(k);
    }
    bool again = false;
    status = take_name(k, "resources/" SE3DI_FMI_RECIPE_FILE, "", SIZE_MAX, &again);
    status = status < 0 ? status : take_name(k, name, file, 0, &again);
    se3di_zip_add(&k->zip, "resources/" SE3DI_FMI_RECIPE_FILE, text, strlen(text));
    status = status < 0 ? status : add_file(k, k->p->path, name);
    return status < 0 ? status : add_attached(k);
}

/* ---- the whole ------------------------------------------------------------------------------*/

static void count(se3di_fmi_package *p, const se3di_fmi_variables *variables)
{
    p->states = variables->states;
    memcpy(p->reason, variables->reason, sizeof p->reason);
    for (size_t k = 0; k < variables->count; ++k) {
        const se3di_fmi_role role = variables->list[k].role;
        p->inputs += role == SE3DI_FMI_INPUT;
        p->parameters += role == SE3DI_FMI_PARAMETER;
        p->outputs += role == SE3DI_FMI_OUTPUT;
    }
}

/* Those of all that the shared object has in it, which lie beside it. */
static se3d_status add_licenses(packer *k)
{
    static const char file[] = "se3d_fmu_licenses.txt";
    const size_t folder = length_of_folder(k->p->object);
    char *path = se3di_iopool_alloc(&k->pool, folder + sizeof file);
    if (!path) {
        return fail_memory(k);
    }
    memcpy(path, k->p->object, folder);
    memcpy(path + folder, file, sizeof file);
    return add_file(k, path, "documentation/licenses/license.txt");
}

static se3d_status add_all(packer *k, const se3di_fmi_variables *variables)
{
    char name[SE3DI_FMI_IDENTIFIER_SIZE + 60];
    size_t size = 0;
    se3di_fmi_description d = {
        .model = k->p->model, .variables = variables, .version = k->p->version};
    se3di_fmi_make_identifier(k->p->model->name, d.identifier);
    const char *text = se3di_fmi_description_write(&d, &k->pool, &size);
    if (!text) {
        return fail_memory(k);
    }
    se3di_zip_add(&k->zip, "modelDescription.xml", text, size);
    snprintf(name, sizeof name, "binaries/%s/%s.so", k->p->version == 3 ? PLATFORM3 : PLATFORM2,
             d.identifier);
    se3d_status status = add_file(k, k->p->object, name);
    status = status < 0 ? status : add_licenses(k);
    return status < 0 ? status : add_model(k);
}

se3d_status se3di_fmi_package_write(se3di_fmi_package *package, FILE *file, se3d_model_error *error)
{
    char problem[500];
    se3di_fmi_variables variables;
    packer k = {.p = package, .error = error};
    memset(error, 0, sizeof *error);
    se3di_iopool_init(&k.pool, NULL);
    k.zip = se3di_zip_begin(file, &k.pool);
    se3d_status status =
        se3di_fmi_variables_create(package->model, &variables, problem, sizeof problem);
    if (status < 0) {
        fail(&k, status, "", problem);
    } else {
        count(package, &variables);
        status = add_all(&k, &variables);
    }
    const char *why = status >= 0 ? se3di_zip_end(&k.zip) : NULL;
    if (why) {
        char text[200];
        snprintf(text, sizeof text, "cannot be written: %.150s", why);
        status = fail(&k, SE3D_ERR_IO, package->target, text);
    }
    se3di_fmi_variables_destroy(&variables);
    se3di_iopool_destroy(&k.pool);
    return status;
}
