/* SPDX-License-Identifier: BSD-3-Clause */
/* `output`: results files, and the pictures that are made of them. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "io/base/deflate.h"
#include "io/base/pool.h"
#include "io/channel/channel.h"
#include "io/channel/combine.h"
#include "io/channel/output.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/field_grid.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"
#include "io/read/sections.h"

/* What an entry makes: the key that says so and names the file. */
enum {
    KIND_FILE = 0,
    KIND_VTK = 1,
    KIND_SUMMARY = 2,
    KIND_AVERAGE = 3,
    KIND_WALL_MAP = 4, /* pictures follow */
    KIND_COUNT = 8
};
static const char *const output_types[KIND_COUNT + 1] = {[KIND_FILE] = "file",
                                                         [KIND_VTK] = "vtk",
                                                         [KIND_SUMMARY] = "summary",
                                                         [KIND_AVERAGE] = "average",
                                                         [KIND_WALL_MAP] = "wall_map",
                                                         "plot",
                                                         "scene",
                                                         "video",
                                                         NULL};
static const char *const examples[KIND_COUNT] = {"results.csv", "motion.pvd", "summary.csv",
                                                 "average.csv", "wall.csv",   "results.svg",
                                                 "motion.html", "motion.mp4"};
static const char *const vtk_endings[] = {".pvd", ".vtkhdf", NULL};
static const char *const plot_endings[] = {".svg", ".png", ".pdf", NULL};
static const char *const scene_endings[] = {".html", ".glb", NULL};
static const char *const video_endings[] = {".mp4", NULL};

/* clang-format off */
static const se3di_key output_keys[] = {
    {"file", SE3DI_KIND_FILE, .types = " file ",
     .text = "results as CSV, or, if it ends with .h5, as [HDF5](../hdf5.md)"},
    {"every", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_output_entry, every),
     .types = " file vtk summary average wall_map ",
     .standard = "the step; without one a 500th of the duration",
     .text = "time between rows [s]"},
    {"compression", SE3DI_KIND_COUNT, .most = 9.0,
     .types = " file vtk summary average wall_map ", .standard = "0: none",
     .text = "of .h5, .vtkhdf, .vtp, .vti and .pvd: 1 is fast, 9 is small"},
    {"channels", SE3DI_KIND_CHANNELS, .types = " file summary ",
     .standard = "every channel of up to 100 bodies",
     .text = "what is written, a row each time: channels, components of them, and "
         "[expressions](#expressions-of-channels)"},
    {"channels", SE3DI_KIND_CHANNELS, .types = " plot ", .standard = "the usual ones",
     .text = "channels, components of them, or elements"},
    {"particles", SE3DI_KIND_SNAPSHOTS, .types = " file ", .standard = "false",
     .text = "all particles, or the set of this name, in place of channels"},
    {"contacts", SE3DI_KIND_BOOL, .types = " file ", .standard = "false",
     .text = "all contacts, in place of channels"},
    {"vtk", SE3DI_KIND_FILE, .types = " vtk ", .words = vtk_endings,
     .text = "surfaces of the bodies and points of the particles for ParaView: motion.pvd, or "
         "motion.vtkhdf for HDF5, see [VTK](../scene.md#vtk)"},
    {"fields", SE3DI_KIND_OBJECT, .object = "fields", .types = " vtk average ",
     .text = "density, velocity, temperature and stress of the particles on a grid: beside the "
         "rest, or what is averaged"},
    {"summary", SE3DI_KIND_FILE, .types = " summary ",
     .text = "minimum, maximum, mean, rms and integral of each channel over the rows, as CSV or "
         ".h5"},
    {"average", SE3DI_KIND_FILE, .types = " average ",
     .text = "means of `fields` over the rows, a line for each cell, as CSV or .h5, or as an "
         "image, .vti or .vtkhdf"},
    {"wall_map", SE3DI_KIND_FILE, .types = " wall_map ",
     .text = "means of what particles do to each patch of a wall over the rows, as CSV or .h5, or "
             "as a surface, .vtp or .vtkhdf"},
    {"shape", SE3DI_KIND_TEXT, .types = " wall_map ",
     .text = "the name of that wall, a mesh, heightfield or funnel, also of the ground's"},
    {"start", SE3DI_KIND_NUMBER, SE3DI_INTO(se3di_output_entry, start),
     .types = " summary average wall_map ",
     .standard = "the first row", .text = "rows from this time on count [s]"},
    {"stop", SE3DI_KIND_NUMBER, SE3DI_INTO(se3di_output_entry, stop),
     .types = " summary average wall_map ",
     .standard = "the last row", .text = "rows up to this time count [s]"},
    {"plot", SE3DI_KIND_FILE, .types = " plot ", .words = plot_endings,
     .text = "SVG, PNG and the script .gp, as [se3d plot](../plots.md)"},
    {"from", SE3DI_KIND_TEXT, .types = " plot ", .standard = "the first with channels",
     .text = "the results of a plot"},
    {"x", SE3DI_KIND_TEXT, .types = " plot ", .standard = "time",
     .text = "the horizontal axis of a plot"},
    {"fft", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_model_picture, fft), .types = " plot ",
     .standard = "false", .text = "amplitudes over frequency"},
    {"scene", SE3DI_KIND_FILE, .types = " scene ", .words = scene_endings,
     .text = "a page for browsers, as [se3d view](../viewer.md), or glTF; scene.glb is left by "
         "every run"},
    {"video", SE3DI_KIND_FILE, .types = " video ", .words = video_endings,
     .text = "a film, as [se3d video](../video.md)"},
    {"speed", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_model_picture, speed),
     .types = " video ", .standard = "1", .text = "seconds of motion in one of film"},
    {.key = NULL}};
const se3di_object se3di_object_output = {
    "output",
    "A file of results, or a picture of them. Its first key says which.",
    output_keys, output_types,
    "\"oneOf\": [{\"required\": [\"file\"]}, {\"required\": [\"vtk\"]}, {\"required\": "
         "[\"summary\"]}, {\"required\": [\"average\", \"fields\"]}, {\"required\": "
         "[\"wall_map\", \"shape\"]}, {\"required\": [\"plot\"]}, {\"required\": "
         "[\"scene\"]}, {\"required\": [\"video\"]}]"};
/* clang-format on */

/* {name: expression} */
static bool read_named(se3di_reader *reader, const se3di_node *node, se3di_channel *channel)
{
    const se3di_node *child = node->first;
    const char *name = NULL;
    if (node->count != 1) {
        return se3di_reader_fail(reader, node,
                                 "has %zu keys, must be a channel, an expression, or a name with "
                                 "one: {load: 2*pin.angle}",
                                 node->count);
    }
    se3di_node key = *child;
    key.kind = SE3DI_NODE_SCALAR;
    key.text = child->key;
    if (!se3di_read_name(reader, &key, &name)) {
        return false;
    }
    if (strcmp(name, "time") == 0) {
        return se3di_reader_fail(reader, child, "`time` is the first column, use another name");
    }
    return se3di_combination_read(reader, child, name, channel);
}

/* The name of a column, in which a comma would end it. */
static const char *without_commas(se3di_reader *reader, const char *text)
{
    char *copy = se3di_iopool_copy(reader->pool, text, strlen(text));
    size_t k = 0;
    for (const char *at = text; copy && *at; ++at) {
        if (*at != ',' && *at != '"' && *at != '\n') {
            copy[k++] = *at;
        }
    }
    if (copy) {
        copy[k] = '\0';
    }
    return copy ? copy : text;
}

/* A channel, a component of one, or an expression, which may have a name: {load: 2*pin.angle}. */
static bool find_channel(se3di_reader *reader, const se3di_node *node, se3di_channel *channel)
{
    se3d_model *model = reader->model;
    char problem[480] = "";
    const char *name = NULL;
    if (node->kind == SE3DI_NODE_MAP) {
        return read_named(reader, node, channel);
    }
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    if (se3di_text_is_combination(model, name)) {
        return se3di_combination_read(reader, node, without_commas(reader, name), channel);
    }
    if (strlen(name) > 310) {
        return se3di_reader_fail(reader, node, "is longer than any channel's name");
    }
    if (se3di_channel_find(model, name, channel, problem, sizeof problem)) {
        return true;
    }
    char unused[480];
    return se3di_component_find(model, name, channel, unused, sizeof unused) ||
           se3di_reader_fail(reader, node, "%s", problem);
}

static bool read_channel(se3di_reader *reader, const se3di_node *node, se3di_output_entry *output)
{
    se3di_channel *channel = &output->channels[output->count];
    if (!find_channel(reader, node, channel)) {
        return false;
    }
    for (size_t k = 0; k < output->count; ++k) {
        if (strcmp(output->channels[k].name, channel->name) == 0) {
            return se3di_reader_fail(reader, node, "`%s` is listed twice", channel->name);
        }
    }
    ++output->count;
    return true;
}

static bool read_channels(se3di_reader *reader, const se3di_node *node, se3di_output_entry *output)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, node, "channels", &list)) {
        return false;
    }
    if (!list) {
        output->channels = se3di_channel_list_all(model, SE3DI_CHANNEL_ELEMENTS, &output->count);
        return output->channels ? true : se3di_reader_fail_memory(reader);
    }
    output->channels = se3di_iopool_array(&model->pool, list->count, sizeof *output->channels);
    if (!output->channels) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *child = list->first; child; child = child->next) {
        if (!read_channel(reader, child, output)) {
            return false;
        }
    }
    return true;
}

/* particles: true for all, or the name of a set. */
static bool read_snapshots(se3di_reader *reader, const se3di_node *node, se3di_output_entry *output)
{
    const se3di_node *child = se3di_node_get(node, "particles");
    const se3d_model *model = reader->model;
    int32_t wanted = 0;
    output->set = -1;
    if (child && child->kind == SE3DI_NODE_SCALAR && model->particles) {
        const size_t set = se3di_tagged_find(model->particles, SE3DI_TAGGED_SET, child->text);
        output->set = set == SIZE_MAX ? -1 : (int32_t)set;
        wanted = output->set >= 0;
    }
    if (child && !wanted && !se3di_read_bool(reader, child, &wanted)) {
        return false;
    }
    if (wanted && !model->particles) {
        return se3di_reader_fail(reader, child, "is true, but the model has no `particles`");
    }
    output->particles = wanted != 0;
    return true;
}

/* contacts: true. */
static bool read_contacts(se3di_reader *reader, const se3di_node *node, se3di_output_entry *output)
{
    const se3di_node *child = se3di_node_get(node, "contacts");
    int32_t wanted = 0;
    if (!se3di_read_key(reader, node, &se3di_object_output, NULL, "contacts", &wanted)) {
        return false;
    }
    if (wanted && !se3di_node_get(reader->model->root, "contact") && !reader->model->particles) {
        return se3di_reader_fail(reader, child,
                                 "is true, but the model has no `contact` and no `particles`");
    }
    output->contacts = wanted != 0;
    return true;
}

/* A file has rows of one kind. */
static bool check_kind_of_rows(se3di_reader *reader, const se3di_node *node,
                               const se3di_output_entry *output)
{
    const char *what = output->particles ? "particles" : "contacts";
    if (output->particles && output->contacts) {
        return se3di_reader_fail_key(reader, node, "contacts",
                                     "cannot be combined with `particles`: give each its own file");
    }
    if ((output->particles || output->contacts) && se3di_node_get(node, "channels")) {
        return se3di_reader_fail_key(reader, node, "channels",
                                     "cannot be combined with `%s`: give each its own file", what);
    }
    return true;
}

static bool ends_with(const char *text, const char *ending)
{
    const size_t length = strlen(text);
    const size_t tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

/* What an entry writes beside its file: a plot has a picture of each kind and a script, rows of
 * what is not CSV stand in a file beside it while the model runs. */
static bool writes(const char *type, const char *file, const char *name)
{
    static const char *const endings[] = {".svg", ".png", ".pdf", ".gp"};
    const char *dot = strrchr(file, '.');
    static const char *const made[] = {".h5", ".hdf5", ".vtp", ".vti", ".vtkhdf"};
    const size_t length = strlen(file);
    const bool beside = strncmp(file, name, length) == 0 && strcmp(name + length, ".csv") == 0;
    for (size_t k = 0; beside && k < sizeof made / sizeof *made; ++k) {
        if (ends_with(file, made[k])) {
            return true;
        }
    }
    if (strcmp(type, "plot") != 0 || !dot) {
        return strcmp(file, name) == 0;
    }
    const size_t base = (size_t)(dot - file);
    for (size_t k = 0; k < sizeof endings / sizeof *endings; ++k) {
        if (strncmp(file, name, base) == 0 && strcmp(name + base, endings[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether two entries write a file of the same name. */
static bool collide(const char *type, const char *file, const char *other_type, const char *other)
{
    const bool both = strcmp(type, "plot") == 0 && strcmp(other_type, "plot") == 0;
    if (both) {
        const size_t base = strlen(file) - strlen(strrchr(file, '.'));
        const size_t second = strlen(other) - strlen(strrchr(other, '.'));
        return base == second && strncmp(file, other, base) == 0;
    }
    return writes(type, file, other) || writes(other_type, other, file);
}

/* A name that nothing else in the folder of the results has. */
static bool read_file_name(se3di_reader *reader, const se3di_node *node, size_t kind,
                           const char **file)
{
    const char *key = output_types[kind];
    const char *const *endings = se3di_object_find(&se3di_object_output, NULL, key)->words;
    const se3d_model *model = reader->model;
    if (!se3di_read_file_name(reader, node, file)) {
        return false;
    }
    const char *name = *file;
    bool taken = strcmp(name, "scene.glb") == 0 && strcmp(key, "scene") != 0;
    if (endings && !ends_with(name, endings[0]) && !(endings[1] && ends_with(name, endings[1]))) {
        return se3di_reader_fail(reader, node, "`%.60s` must end with %s%s%s, such as %s", name,
                                 endings[0], endings[1] ? " or " : "", endings[1] ? endings[1] : "",
                                 examples[kind]);
    }
    for (size_t k = 0; k < model->output_count; ++k) {
        taken = taken || collide(key, name, "file", model->outputs[k].file);
    }
    for (size_t k = 0; k < model->picture_count; ++k) {
        taken = taken || collide(key, name, model->pictures[k].type, model->pictures[k].file);
    }
    if (taken) {
        return se3di_reader_fail(reader, node, "`%.60s` is written by two outputs", name);
    }
    for (size_t k = 0; k < model->analysis_count; ++k) {
        const char *other = model->analyses[k].modes.file;
        if (other && strcmp(other, name) == 0) {
            return se3di_reader_fail(reader, node, "`%.60s` is written by the modes", name);
        }
    }
    return true;
}

/* Which kind an entry is: exactly one of their keys is there. */
static bool find_kind(se3di_reader *reader, const se3di_node *node, size_t *kind)
{
    size_t found = KIND_COUNT;
    if (!se3di_read_keys(reader, node, &se3di_object_output)) {
        return false;
    }
    for (size_t k = 0; k < KIND_COUNT; ++k) {
        if (!se3di_node_get(node, output_types[k])) {
            continue;
        }
        if (found < KIND_COUNT) {
            return se3di_reader_fail_key(reader, node, output_types[k],
                                         "cannot be combined with `%s`: give each its own entry",
                                         output_types[found]);
        }
        found = k;
    }
    if (found == KIND_COUNT) {
        return se3di_reader_fail_key(reader, node, "file",
                                     "is missing, such as results.csv (or one of vtk, summary, "
                                     "average, wall_map, plot, scene, video)");
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_object_find(&se3di_object_output, output_types[found], child->key)) {
            char list[480];
            se3di_object_list(&se3di_object_output, output_types[found], ", ", list, sizeof list);
            return se3di_reader_fail(reader, child, "has no effect with `%s`, which takes: %s",
                                     output_types[found], list);
        }
    }
    *kind = found;
    return true;
}

/* A summary has some time to be of. */
static bool check_window(se3di_reader *reader, const se3di_node *node,
                         const se3di_output_entry *output)
{
    return output->stop > output->start ||
           se3di_reader_fail_key(reader, node, "stop", "is %g s, must be after `start`, %g s",
                                 output->stop, output->start);
}

/* Whose triangles a map of a wall is of. */
static bool read_wall(se3di_reader *reader, const se3di_node *node, se3d_shape *wall)
{
    const se3di_node *name = se3di_node_get(node, "shape");
    int32_t type = SE3D_SHAPE_PLANE;
    if (!reader->model->particles) {
        return se3di_reader_fail(reader, node, "needs `particles`, which the model does not have");
    }
    if (!name) {
        return se3di_reader_fail_key(reader, node, "shape",
                                     "is missing: the name of the wall to map");
    }
    return se3di_read_shape_name(reader, name, wall) &&
           ((se3d_shape_get_type(reader->system, *wall, &type) >= 0 &&
             (type == SE3D_SHAPE_MESH || type == SE3D_SHAPE_HEIGHTFIELD ||
              type == SE3D_SHAPE_FUNNEL)) ||
            se3di_reader_fail(reader, name,
                              "`%.60s` must be a heightfield, a funnel, or a mesh that is not "
                              "`convex`",
                              name->text));
}

static bool check_average(se3di_reader *reader, const se3di_node *node,
                          const se3di_output_entry *output)
{
    return !output->average || output->grid ||
           se3di_reader_fail_key(reader, node, "fields", "is missing: what to average");
}

/* What rows are of that have no channels. */
static bool read_particle_rows(se3di_reader *reader, const se3di_node *node, size_t kind,
                               se3di_output_entry *output)
{
    return read_snapshots(reader, node, output) && read_contacts(reader, node, output) &&
           se3di_read_field_grid(reader, node, &output->grid) &&
           (kind == KIND_WALL_MAP ? read_wall(reader, node, &output->wall)
                                  : check_average(reader, node, output)) &&
           check_kind_of_rows(reader, node, output);
}

/* Surfaces are .vtp, images .vti. */
static bool check_picture_of_average(se3di_reader *reader, const se3di_node *file, size_t kind)
{
    const char *other = kind == KIND_WALL_MAP ? ".vti" : kind == KIND_AVERAGE ? ".vtp" : NULL;
    return !other || !ends_with(file->text, other) ||
           se3di_reader_fail(reader, file, "`%.60s` must end with %s, .vtkhdf, .h5 or .csv",
                             file->text, kind == KIND_WALL_MAP ? ".vtp" : ".vti");
}

static bool read_compression(se3di_reader *reader, const se3di_node *node, size_t kind,
                             se3di_output_entry *output)
{
    if (!se3di_read_key(reader, node, &se3di_object_output, output_types[kind], "compression",
                        &output->compression)) {
        return false;
    }
    if (!(output->compression > 0.0)) {
        return true;
    }
    if (!output->vtk && se3di_output_get_format(output) == SE3DI_OUTPUT_CSV) {
        return se3di_reader_fail_key(reader, node, "compression",
                                     "has no effect on `%.60s`: CSV is not compressed; .h5 is",
                                     output->file);
    }
    return se3di_deflate_is_there() ||
           se3di_reader_fail_key(reader, node, "compression",
                                 "must be 0 here: this build of libse3d-io has no zlib");
}

static bool read_output(se3di_reader *reader, const se3di_node *node, size_t kind)
{
    se3d_model *model = reader->model;
    se3di_output_entry *output = &model->outputs[model->output_count];
    const se3di_node *file = se3di_node_get(node, output_types[kind]);
    output->vtk = kind == KIND_VTK;
    output->summary = kind == KIND_SUMMARY;
    output->average = kind == KIND_AVERAGE || kind == KIND_WALL_MAP;
    output->start = -HUGE_VAL;
    output->stop = HUGE_VAL;
    output->node = node;
    if (!read_file_name(reader, file, kind, &output->file) ||
        !check_picture_of_average(reader, file, kind) ||
        !se3di_read_fields(reader, node, &se3di_object_output, NULL, "se3di_output_entry",
                           output) ||
        !check_window(reader, node, output) || !read_compression(reader, node, kind, output) ||
        !read_particle_rows(reader, node, kind, output) ||
        (!output->particles && !output->contacts && !output->vtk && !output->average &&
         !read_channels(reader, node, output))) {
        return false;
    }
    ++model->output_count;
    return true;
}

/* True if `part` is `whole` or a part of it: pin.force of pin, pin.force.x of pin.force. */
static bool is_part(const char *part, const char *whole)
{
    const size_t length = strlen(whole);
    return strncmp(part, whole, length) == 0 && (part[length] == '\0' || part[length] == '.');
}

/* A channel of a plot: one of its results, all of an element's, or a component. */
static bool read_plot_channel(se3di_reader *reader, const se3di_node *node,
                              const se3di_output_entry *from, const char **name)
{
    if (!se3di_read_text(reader, node, name)) {
        return false;
    }
    bool found = strcmp(*name, "time") == 0;
    for (size_t k = 0; k < from->count; ++k) {
        found = found || is_part(*name, from->channels[k].name) ||
                is_part(from->channels[k].name, *name);
    }
    return found || se3di_reader_fail(reader, node, "`%.100s` is not a channel of %.100s", *name,
                                      from->file);
}

/* The results that a plot shows: `from`, or the first that have channels. */
static bool find_results(se3di_reader *reader, const se3di_node *node,
                         const se3di_output_entry **from)
{
    const se3d_model *model = reader->model;
    const se3di_node *child = se3di_node_get(node, "from");
    const char *name = NULL;
    if (child && !se3di_read_text(reader, child, &name)) {
        return false;
    }
    for (size_t k = 0; k < model->output_count; ++k) {
        const se3di_output_entry *output = &model->outputs[k];
        const bool csv = se3di_output_get_format(output) == SE3DI_OUTPUT_CSV;
        const bool named = name && strcmp(output->file, name) == 0;
        if (output->channels && !output->summary && (named || (!name && csv))) {
            *from = output;
            return csv || se3di_reader_fail(reader, child,
                                            "`%.60s` is HDF5: plots are made of CSV files", name);
        }
    }
    return se3di_reader_fail(reader, child ? child : node,
                             "names no results file with channels, must be one of `output`");
}

static bool read_plot(se3di_reader *reader, const se3di_node *node, se3d_model_picture *picture)
{
    const se3di_node *list = NULL;
    const se3di_output_entry *from = NULL;
    const se3di_node *x = se3di_node_get(node, "x");
    if (!find_results(reader, node, &from) || !se3di_read_list(reader, node, "channels", &list) ||
        (x && !read_plot_channel(reader, x, from, &picture->x))) {
        return false;
    }
    picture->results = from->file;
    const size_t count = list ? list->count : 0;
    const char **channels = se3di_iopool_array(reader->pool, count + 1, sizeof *channels);
    if (!channels) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *child = list ? list->first : NULL; child; child = child->next) {
        if (!read_plot_channel(reader, child, from, &channels[picture->channel_count++])) {
            return false;
        }
    }
    picture->channels = channels;
    return true;
}

static bool read_picture(se3di_reader *reader, const se3di_node *node, size_t kind)
{
    se3d_model *model = reader->model;
    se3d_model_picture *picture = &model->pictures[model->picture_count];
    picture->type = output_types[kind];
    picture->speed = 1.0;
    if (!read_file_name(reader, se3di_node_get(node, picture->type), kind, &picture->file) ||
        !se3di_read_fields(reader, node, &se3di_object_output, NULL, "se3d_model_picture",
                           picture) ||
        (strcmp(picture->type, "plot") == 0 && !read_plot(reader, node, picture))) {
        return false;
    }
    ++model->picture_count;
    return true;
}

/* So many rows that they would fill the disk are a slip. */
static bool check_rows(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->output_count; ++k) {
        const se3di_output_entry *output = &model->outputs[k];
        const double most = output->vtk ? 1e5 : 1e8;
        for (size_t i = 0; i < model->analysis_count; ++i) {
            const se3di_analysis_entry *analysis = &model->analyses[i];
            double every;
            const double count = se3di_output_count_rows(output, analysis, &every);
            if (count > most) {
                const bool own = output->every > 0.0;
                const se3di_node *node = own || !analysis->node ? output->node : analysis->node;
                return se3di_reader_fail_key(
                    reader, node ? node : model->root, own ? "every" : "step",
                    "is %g s, which asks for %.3g %s of `%.60s`, must ask for at most %g%s", every,
                    count, output->vtk ? "files" : "rows", output->file, most,
                    own ? "" : ": give the output an `every`");
            }
        }
    }
    return true;
}

/* Without a list of results: every channel. */
static bool add_default(se3di_reader *reader)
{
    se3d_model *model = reader->model;
    se3di_output_entry *output = &model->outputs[model->output_count];
    output->file = "results.csv";
    output->channels = se3di_channel_list_all(model, SE3DI_CHANNEL_ELEMENTS, &output->count);
    ++model->output_count;
    return output->channels ? true : se3di_reader_fail_memory(reader);
}

static bool read_entries(se3di_reader *reader, const se3di_node *list, bool pictures)
{
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        size_t kind = 0;
        if (!find_kind(reader, node, &kind)) {
            return false;
        }
        if ((kind > KIND_WALL_MAP) == pictures &&
            !(pictures ? read_picture(reader, node, kind) : read_output(reader, node, kind))) {
            return false;
        }
    }
    return true;
}

bool se3di_read_outputs(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "output", &list)) {
        return false;
    }
    const size_t count = list ? list->count : 0;
    model->outputs = se3di_iopool_array(&model->pool, count + 1, sizeof *model->outputs);
    model->pictures = se3di_iopool_array(&model->pool, count + 1, sizeof *model->pictures);
    if (!model->outputs || !model->pictures) {
        return se3di_reader_fail_memory(reader);
    }
    if (!read_entries(reader, list, false)) {
        return false;
    }
    bool results = false;
    for (size_t k = 0; k < model->output_count; ++k) {
        const se3di_output_entry *output = &model->outputs[k];
        results = results || !(output->vtk || output->summary || output->average);
    }
    return (results || add_default(reader)) && check_rows(reader) &&
           read_entries(reader, list, true);
}
