/* SPDX-License-Identifier: BSD-3-Clause */
/* Models from texts and files: the sections in their order. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/floats.h"
#include "base/hash.h"
#include "io/base/pool.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/document/function.h"
#include "io/document/omitted.h"
#include "io/document/reader.h"
#include "io/document/setting.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bars.h"
#include "io/read/include.h"
#include "io/read/mistakes.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "io/read/warn.h"

void se3d_model_options_init(se3d_model_options *options, size_t size)
{
    if (options && size >= sizeof options->struct_size) {
        memset(options, 0, size);
        options->struct_size = size;
    }
}

/* The file's name without folder and extension. */
static const char *base_name(se3di_iopool *pool, const char *file)
{
    const char *start = file;
    for (const char *c = file; *c; ++c) {
        if (*c == '/' || *c == '\\') {
            start = c + 1;
        }
    }
    const char *dot = strrchr(start, '.');
    const size_t length = dot && dot > start ? (size_t)(dot - start) : strlen(start);
    return length > 0 ? se3di_iopool_copy(pool, start, length) : "model";
}

/* clang-format off */
static const se3di_key model_keys[] = {
    {"se3d", SE3DI_KIND_VERSION, .required = true, .text = "version of the format"},
    {"title", SE3DI_KIND_TITLE, .text = "text"},
    {"parameters", SE3DI_KIND_PARAMETERS,
     .text = "names and their values or expressions, in any order; replaced by --set NAME=VALUE"},
    {"points", SE3DI_KIND_NAMED_POINTS,
     .text = "names and their coordinates [m], ground frame: a list of three or an expression, in "
         "any order, also over the parameters; used by their names"},
    {"point_table", SE3DI_KIND_TEXT,
     .text = "CSV file of points, relative to the model file: columns name, x, y, z [m]"},
    {"units", SE3DI_KIND_OBJECT, .object = "units",
     .text = "what numbers without a unit are in"},
    {"gravity", SE3DI_KIND_FUNCTIONS, .standard = "[0, 0, -9.81]",
     .text = "ground frame [m/s^2], numbers or functions of t"},
    {"materials", SE3DI_KIND_LIST, .object = "material",
     .text = "what bodies and particles are made of"},
    {"include", SE3DI_KIND_LIST, .object = "instance",
     .text = "other files as parts of this model"},
    {"parts", SE3DI_KIND_PARTS, .object = "part", .text = "parts by their names, for instances"},
    {"instances", SE3DI_KIND_LIST, .object = "instance", .text = "where these parts are"},
    {"bodies", SE3DI_KIND_LIST, .object = "body",
     .text = "moving and fixed bodies; ground is always there"},
    {"joints", SE3DI_KIND_LIST, .object = "joint", .text = "joints"},
    {"drivers", SE3DI_KIND_LIST, .object = "driver",
     .text = "joint coordinates that follow a function of time or of other positions"},
    {"constraints", SE3DI_KIND_LIST, .object = "constraint", .text = "constraint primitives"},
    {"forces", SE3DI_KIND_LIST, .object = "force",
     .text = "springs, dampers, friction, stops, loads"},
    {"states", SE3DI_KIND_LIST, .object = "state",
     .text = "numbers that are integrated with the motion: filters, controllers"},
    {"roads", SE3DI_KIND_LIST, .object = "road", .text = "surfaces that tyres name"},
    {"wheels", SE3DI_KIND_LIST, .object = "wheel", .text = "what measures a suspension"},
    {"contact", SE3DI_KIND_OBJECT, .object = "contact",
     .text = "how shapes and particles touch; may be empty"},
    {"particles", SE3DI_KIND_LIST, .object = "particles",
     .text = "spheres that touch each other and the walls: regions filled with them, tables, "
         "sources"},
    {"clumps", SE3DI_KIND_LIST, .object = "clump",
     .text = "templates of particles of several spheres, which `particles` name"},
    {"sinks", SE3DI_KIND_LIST, .object = "sink",
     .text = "regions that remove particles and count them"},
    {"regions", SE3DI_KIND_LIST, .object = "region",
     .text = "boxes whose particles are averaged over"},
    {"flows", SE3DI_KIND_LIST, .object = "flow",
     .text = "planes, disks and rectangles through which particles are counted"},
    {"servos", SE3DI_KIND_LIST, .object = "servo",
     .text = "walls that move so that particles press them with a given force or stress"},
    {"bonds", SE3DI_KIND_LIST, .object = "bond",
     .text = "beams between particles, or from them to shapes, that may break"},
    {"cell", SE3DI_KIND_LIST, .object = "stage",
     .text = "how a domain that is periodic along all axes strains, one stage after the other"},
    {"analysis", SE3DI_KIND_ONE_OR_LIST, .object = "analysis",
     .text = "one analysis, or several that run one after the other"},
    {"events", SE3DI_KIND_LIST, .object = "event",
     .text = "crossings of levels, looked for in every step"},
    {"fmus", SE3DI_KIND_LIST, .object = "fmu",
     .text = "mock-up units of other programs (FMI) that a run steps beside the model"},
    {"output", SE3DI_KIND_LIST, .object = "output", .text = "results files and pictures"},
    {"study", SE3DI_KIND_OBJECT, .object = "study",
     .text = "many runs with other parameters, for `se3d study`"},
    {.key = NULL}};
const se3di_object se3di_object_model = {
    "model",
    "A model.",
    model_keys, NULL,
    NULL};
/* clang-format on */

static bool read_head(se3di_reader *reader, const se3di_node *root)
{
    double version = 0.0;
    if (root->kind != SE3DI_NODE_MAP) {
        return se3di_reader_fail(reader, root, "is %s, must be a map that begins with `se3d: 1`",
                                 se3di_node_describe(root));
    }
    const se3di_node *node = se3di_node_get(root, "se3d");
    if (!node) {
        return se3di_reader_fail_key(reader, root, "se3d",
                                     "is missing, must be 1: the version of the file format");
    }
    if (!se3di_read_number(reader, node, SE3DI_ANY, &version)) {
        return false;
    }
    if (version < 1.0 || version > 1.0) {
        return se3di_reader_fail(reader, node, "is %s, must be 1: the version of the file format",
                                 node->text);
    }
    if (!se3di_read_keys(reader, root, &se3di_object_model)) {
        return false;
    }
    const se3di_node *title = se3di_node_get(root, "title");
    return !title || se3di_read_text(reader, title, &reader->model->title);
}

/* Three components, each a number or a function of time. */
static bool read_gravity(se3di_reader *reader, const se3di_node *root)
{
    static const char *const time_only[] = {"t", NULL};
    const se3di_node *node = se3di_node_get(root, "gravity");
    se3d_system *system = reader->system;
    se3d_function function[3] = {{0, 0}, {0, 0}, {0, 0}};
    double value[3] = {0.0, 0.0, 0.0};
    size_t k = 0;
    if (!node) {
        return true;
    }
    if (node->kind != SE3DI_NODE_LIST || node->count != 3) {
        return se3di_read_vector(reader, node, 3, value); /* says why not */
    }
    for (const se3di_node *part = node->first; part; part = part->next, ++k) {
        if (!se3di_read_function(reader, part, time_only, &value[k], &function[k])) {
            return false;
        }
    }
    se3d_status status = se3d_system_set_gravity(system, value);
    if (status >= 0) {
        status = se3d_system_set_gravity_function(system, function);
    }
    return se3di_reader_check(reader, node, status);
}

static bool create_system(se3di_reader *reader, const se3di_node *root)
{
    se3d_system_def def = se3d_system_def_default();
    reader->model->log = reader->options->log;
    reader->model->log_ctx = reader->options->log_ctx;
    def.log = reader->options->log;
    def.log_ctx = reader->options->log_ctx;
    def.allocator = se3di_iopool_lend(reader->pool);
    if (SE3D_FAILED(se3d_system_create(&def, &reader->model->system))) {
        return se3di_reader_fail_memory(reader);
    }
    reader->system = reader->model->system;
    return read_gravity(reader, root);
}

/* A section of every part. */
static bool read_section(se3di_reader *reader,
                         bool (*read)(se3di_reader *reader, const se3di_node *root))
{
    size_t index = 0;
    bool good = true;
    for (const se3di_component *part = reader->model->parts; part && good; part = part->next) {
        reader->wanted = reader->again ? &reader->again[index++] : NULL;
        if (!reader->wanted || reader->wanted->count > 0) {
            se3di_reader_enter(reader, part);
            good = read(reader, part->root);
        }
    }
    if (good) {
        reader->wanted = NULL;
        se3di_reader_enter(reader, reader->model->parts);
    }
    return good;
}

/* What moves and what acts on it. */
static bool read_mechanism(se3di_reader *reader)
{
    return read_section(reader, se3di_read_bodies) && read_section(reader, se3di_read_bar_joints) &&
           read_section(reader, se3di_read_joints) &&
           read_section(reader, se3di_read_constraints) &&
           read_section(reader, se3di_read_drivers) && read_section(reader, se3di_read_states) &&
           read_section(reader, se3di_read_roads) && read_section(reader, se3di_read_forces) &&
           read_section(reader, se3di_read_followers) && se3di_read_state_laws(reader) &&
           read_section(reader, se3di_read_rate_followers) &&
           read_section(reader, se3di_read_wheels);
}

/* Whether the analyses, of which there is one, compute motions from constraints alone. */
static bool is_geometric(const se3di_reader *reader, const se3di_node *root)
{
    static const char kinds[] = " assembly kinematics ";
    const se3di_node *all = se3di_node_get(root, "analysis");
    const bool is_list = all && all->kind == SE3DI_NODE_LIST;
    if (reader->options->analysis) {
        return se3di_keys_contain(kinds, reader->options->analysis);
    }
    for (const se3di_node *one = is_list ? all->first : all; one;
         one = is_list ? one->next : NULL) {
        const se3di_node *type = one->kind == SE3DI_NODE_MAP ? se3di_node_get(one, "type") : NULL;
        if (!type || !type->text || !se3di_keys_contain(kinds, type->text)) {
            return false;
        }
    }
    return is_list ? all->count > 0 : all != NULL;
}

bool se3di_read_mechanism_again(se3di_reader *reader, const se3di_node *root)
{
    reader->is_geometric = is_geometric(reader, root);
    return read_section(reader, se3di_read_bodies) && read_section(reader, se3di_read_joints) &&
           read_section(reader, se3di_read_constraints) &&
           read_section(reader, se3di_read_drivers) && read_section(reader, se3di_read_forces) &&
           read_section(reader, se3di_read_followers) && read_section(reader, se3di_read_wheels);
}

static bool read_model(se3di_reader *reader, se3di_library *library, const se3di_node *root)
{
    reader->is_geometric = is_geometric(reader, root);
    return read_head(reader, root) && se3di_read_main_part(reader, root) &&
           create_system(reader, root) && se3di_read_materials(reader, root) &&
           se3di_read_parts(reader, library) && read_mechanism(reader) &&
           se3di_read_analyses(reader, root) && se3di_read_contact(reader, root) &&
           se3di_read_particles(reader, root) &&
           (reader->study || se3di_read_outputs(reader, root)) && se3di_read_events(reader, root) &&
           se3di_read_guests(reader, root) &&
           (reader->study ? se3di_read_measured(reader, reader->study)
                          : se3di_read_study(reader, root));
}

se3d_status se3di_model_fill(se3di_attempt *attempt)
{
    se3d_model *model = attempt->model;
    const se3di_scope nothing = {.units = se3di_units_si()};
    se3di_reader reader = {.model = model,
                           .scope = &nothing,
                           .pool = &model->pool,
                           .file = model->file,
                           .options = attempt->options,
                           .error = attempt->error,
                           .content = model->content,
                           .timeless = model->timeless[0],
                           .values = attempt->values,
                           .value_count = attempt->value_count,
                           .study = attempt->study};
    const bool good = read_model(&reader, attempt->library, model->root) &&
                      (!attempt->warns || se3di_warn_of_model(&reader)) &&
                      (!model->pool.is_short || se3di_reader_fail_memory(&reader));
    attempt->fault = reader.fault;
    attempt->attached = reader.attached;
    (void)se3d_system_set_kept(model->system, 1); /* who is handed it does not destroy it */
    model->content = reader.content;
    model->timeless[0] = reader.timeless;
    model->attached = reader.files;
    return good ? SE3D_OK : reader.status < 0 ? reader.status : SE3D_ERR_MODEL;
}

se3d_model *se3di_model_create(const se3d_allocator *allocator)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, allocator);
    se3d_model *model = se3di_iopool_alloc(&pool, sizeof *model);
    if (!model) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    model->pool = pool;
    model->title = "";
    return model;
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
    return text ? se3di_hash_bytes(hash, text, strlen(text) + 1) : se3di_hash_bytes(hash, "\1", 1);
}

/* Of what makes another model of the same files. */
static uint64_t hash_options(const se3d_model_options *o, bool durations)
{
    const char *const texts[] = {
        o->analysis, o->formulation, o->method, o->step, durations ? o->duration : NULL,
        o->tolerance};
    const char *const mass = o->mass_optional ? "mass" : NULL;
    uint64_t hash = hash_text(SE3DI_HASH_START, mass);
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        hash = hash_text(hash, texts[k]);
    }
    for (size_t k = 0; k < o->setting_count; ++k) {
        if (durations || !se3di_setting_is_duration(&o->settings[k])) {
            hash = hash_text(hash_text(hash, o->settings[k].name), o->settings[k].value);
        }
    }
    return hash;
}

static bool has_settings(const se3d_model_options *o)
{
    for (size_t k = 0; k < o->setting_count; ++k) {
        if (!o->settings || !o->settings[k].name || !o->settings[k].value) {
            return false;
        }
    }
    return true;
}

/* Replace in the tree what the options name by path. */
static se3d_status apply_paths(se3d_model *model, const se3d_model_options *o,
                               se3d_model_error *error)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < o->setting_count && status >= 0; ++k) {
        if (se3di_setting_is_path(&o->settings[k])) {
            status = se3di_setting_apply(&model->pool, model->root, &o->settings[k], error);
        }
    }
    return status;
}

static se3d_status fail_early(se3d_model_error *error, se3d_status status, const char *path,
                              const char *text)
{
    se3di_document_report(error, "", 0, 0, path, text);
    return status;
}

/* Takes the options over the defaults in `used`. */
static int take_options(const se3d_model_options *options, se3d_model_options *used)
{
    *used = se3d_model_options_default();
    return !options || se3di_io_take(options, used, sizeof *used);
}

static se3d_status read_text(const char *text, size_t length, const char *name,
                             const se3d_model_options *options, se3d_model **out,
                             se3d_model_error *error)
{
    se3d_model_options used;
    se3d_model_error own; /* reports are made of it */
    error = error ? error : &own;
    memset(error, 0, sizeof *error);
    if (out) {
        *out = NULL;
    }
    if (!take_options(options, &used)) {
        return fail_early(error, SE3D_ERR_INVALID_ARGUMENT, "", "options: " SE3DI_IO_SIZE_TEXT);
    }
    if (!text || !name || !out || !has_settings(&used)) {
        return fail_early(error, SE3D_ERR_NULL, "", "text, name, out or a setting is NULL");
    }
    se3d_model *model = se3di_model_create(used.allocator);
    if (!model) {
        return fail_early(error, SE3D_ERR_NO_MEMORY, "", "out of memory");
    }
    model->file = se3di_iopool_copy(&model->pool, name, strlen(name));
    model->name = base_name(&model->pool, name);
    se3d_status status = model->file && model->name ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    if (status < 0) {
        fail_early(error, status, "", "out of memory");
    } else {
        status = se3di_document_parse(&model->pool, model->file, text, length, &model->root, error);
        if (status >= 0) {
            model->timeless[0] = se3di_hash_without_durations(text, length, model->root);
            status = apply_paths(model, &used, error);
        }
    }
    model->library = se3di_iopool_alloc(&model->pool, sizeof *model->library);
    if (status >= 0 && !model->library) {
        status = fail_early(error, SE3D_ERR_NO_MEMORY, "", "out of memory");
    }
    se3di_attempt attempt = {
        .model = model, .options = &used, .error = error, .library = model->library, .warns = true};
    if (model->library) {
        model->library->pool = &model->pool;
    }
    model->content = se3di_hash_bytes(SE3DI_HASH_START, text, length);
    model->asked = hash_options(&used, true);
    model->timeless[1] = hash_options(&used, false);
    if (status < 0) {
        se3di_mistakes_report_one(&attempt, status);
    } else {
        status = se3di_model_fill(&attempt);
        if (status == SE3D_ERR_MODEL && used.report) {
            se3di_mistakes_report_all(&attempt, length);
        }
    }
    if (status < 0) {
        se3d_model_destroy(model);
        return status;
    }
    *out = model;
    return SE3D_OK;
}

se3d_status se3d_model_read_text(const char *text, size_t length, const char *name,
                                 const se3d_model_options *options, se3d_model **out,
                                 se3d_model_error *error)
{
    const se3di_floats host = se3di_floats_set();
    const se3d_status status = read_text(text, length, name, options, out, error);
    se3di_floats_restore(host);
    return status;
}

se3d_status se3d_model_read_file(const char *path, const se3d_model_options *options,
                                 se3d_model **out, se3d_model_error *error)
{
    se3d_model_options used;
    char *text = NULL;
    size_t length = 0;
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (out) {
        *out = NULL;
    }
    if (!take_options(options, &used)) {
        return fail_early(error, SE3D_ERR_INVALID_ARGUMENT, "", "options: " SE3DI_IO_SIZE_TEXT);
    }
    if (!path || !out) {
        return fail_early(error, SE3D_ERR_NULL, "", "path or out is NULL");
    }
    FILE *file = fopen(path, "rb");
    if (!file) {
        return fail_early(error, SE3D_ERR_IO, path, strerror(errno));
    }
    se3di_iopool pool;
    se3di_iopool_init(&pool, used.allocator);
    errno = 0;
    se3d_status status = se3di_document_read(&pool, file, &text, &length);
    if (status == SE3D_ERR_IO) {
        fail_early(error, status, path, errno ? strerror(errno) : "cannot be read");
    } else if (status < 0) {
        fail_early(error, status, path, "out of memory");
    } else {
        status = se3d_model_read_text(text, length, path, options, out, error);
    }
    fclose(file);
    se3di_iopool_destroy(&pool);
    return status;
}
