/* SPDX-License-Identifier: BSD-3-Clause */
/* `include`, `instances` and `parts`: every entry makes one part, or as many as `repeat` says, with
 * the names, the parameters and the place that it gives. */
#include "io/read/include.h"

#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/amount.h"
#include "io/document/attachment.h"
#include "io/document/guess.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/parameters.h"
#include "io/read/sections.h"

enum { DEPTH_MAX = 16, PARTS_MAX = 100000, BYTES_MAX = 64 * 1024 * 1024, FILES_MAX = 1000 };

typedef struct se3di_library_entry {
    const char *file;
    se3di_node *root;
    size_t bytes;
    struct se3di_library_entry *next;
} se3di_library_entry;

/* clang-format off */
static const char *const mirrors[] = {"x", "y", "z", NULL};
static const se3di_key instance_keys[] = {
    {"file", SE3DI_KIND_TEXT,
     .text = "another model file, relative to this one; its points, bodies, joints, constraints, "
         "drivers, forces and wheels are taken"},
    {"part", SE3DI_KIND_TEXT, .text = "in place of a file: one of `parts`"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"repeat", SE3DI_KIND_COUNT, .most = 100000.0, .standard = "1", .text = "how many there are"},
    {"index", SE3DI_KIND_TEXT, .standard = "i",
     .text = "name of the number that counts them from 0, for the expressions of this entry and of "
         "the part"},
    {"prefix", SE3DI_KIND_TEXT, .standard = "none",
     .text = "before the names of the part; `link{i}_` has the number in it"},
    {"parameters", SE3DI_KIND_VALUES,
     .text = "values for parameters and points of the part in place of its own"},
    {"mirror", SE3DI_KIND_WORD, .words = mirrors, .standard = "not mirrored",
     .text = "the axis that is turned round: y makes a right side of a left one"},
    {"position", SE3DI_KIND_VECTOR, .standard = "[0, 0, 0]",
     .text = "where the part's origin is put [m], after it was mirrored"},
    {"orientation", SE3DI_KIND_ORIENTATION, .standard = "as it is",
     .text = "how the part is turned, after it was mirrored"},
    {.key = NULL}};
const se3di_object se3di_object_instance = {
    "instance",
    "A part of the model that is said elsewhere.",
    instance_keys, NULL,
    NULL};
static const se3di_key part_keys[] = {
    {"parameters", SE3DI_KIND_PARAMETERS, .text = "as of a model"},
    {"points", SE3DI_KIND_NAMED_POINTS, .text = "as of a model [m]"},
    {"bodies", SE3DI_KIND_LIST, .object = "body", .text = "as of a model"},
    {"joints", SE3DI_KIND_LIST, .object = "joint", .text = "as of a model"},
    {"drivers", SE3DI_KIND_LIST, .object = "driver", .text = "as of a model"},
    {"constraints", SE3DI_KIND_LIST, .object = "constraint", .text = "as of a model"},
    {"forces", SE3DI_KIND_LIST, .object = "force", .text = "as of a model"},
    {"roads", SE3DI_KIND_LIST, .object = "road", .text = "as of a model"},
    {"wheels", SE3DI_KIND_LIST, .object = "wheel", .text = "as of a model"},
    {"include", SE3DI_KIND_LIST, .object = "instance", .text = "as of a model"},
    {"instances", SE3DI_KIND_LIST, .object = "instance", .text = "as of a model"},
    {.key = NULL}};
const se3di_object se3di_object_part = {
    "part",
    "A part of a model, for `instances`.",
    part_keys, NULL,
    NULL};
/* clang-format on */

typedef struct expansion {
    se3di_reader *reader;
    se3di_library *library;
    se3di_component *last;
    size_t count;
} expansion;

void se3di_reader_enter(se3di_reader *reader, const se3di_component *part)
{
    reader->part = part;
    reader->scope = part->scope;
    reader->file = part->file;
    reader->alternative = 0;
}

bool se3di_read_main_part(se3di_reader *reader, const se3di_node *root)
{
    se3di_component *part = se3di_iopool_alloc(reader->pool, sizeof *part);
    if (!part) {
        return se3di_reader_fail_memory(reader);
    }
    *part = (se3di_component){
        .root = root, .file = reader->file, .prefix = "", .place = se3di_placement_none()};
    reader->model->parts = part;
    reader->part = part;
    if (!se3di_read_parameters(reader, part, NULL)) {
        return false;
    }
    se3di_reader_enter(reader, part);
    reader->model->scope = reader->scope;
    return true;
}

/* ---- what is included -----------------------------------------------------------------------*/

static bool parse(expansion *x, const se3di_node *node, const char *file, const char *text,
                  size_t length, se3di_library_entry **entry)
{
    se3di_reader *reader = x->reader;
    se3di_iopool *pool = x->library->pool;
    se3di_library_entry *made = se3di_iopool_alloc(pool, sizeof *made);
    const char *path = se3di_iopool_copy(pool, file, strlen(file)); /* it outlives the reading */
    if (!made || !path) {
        return se3di_reader_fail_memory(reader);
    }
    if (length > BYTES_MAX - x->library->bytes) {
        return se3di_reader_fail(reader, node, "all included files are larger than %d bytes",
                                 (int)BYTES_MAX);
    }
    if (x->library->count >= FILES_MAX) {
        return se3di_reader_fail(reader, node, "more than %d files are included", (int)FILES_MAX);
    }
    reader->status = se3di_document_parse(pool, path, text, length, &made->root, reader->error);
    if (reader->status < 0) {
        reader->fault = se3di_fault_of(node);
        return false;
    }
    made->file = path;
    made->bytes = length;
    made->next = x->library->first;
    x->library->first = made;
    x->library->bytes += length;
    ++x->library->count;
    *entry = made;
    return true;
}

/* The document of a file, parsed once. */
static bool find_file(expansion *x, const se3di_node *map, const se3di_node *node,
                      se3di_library_entry **entry)
{
    se3di_reader *reader = x->reader;
    const char *file = NULL;
    char *text = NULL;
    size_t length = 0;
    if (!se3di_read_reference(reader, node, &file)) {
        return false;
    }
    const char *path = se3di_find_attachment(reader, reader->pool, file);
    if (!path) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_component *part = reader->part; part; part = part->parent) {
        if (strcmp(part->file, path) == 0 && !part->root->parent) {
            return se3di_reader_fail(reader, node, "`%.200s` includes itself", path);
        }
    }
    for (*entry = x->library->first; *entry; *entry = (*entry)->next) {
        if (strcmp((*entry)->file, path) == 0) {
            reader->attached += (*entry)->bytes;
            return true;
        }
    }
    return se3di_read_attachment(reader, map, "file", file, x->library->pool, &text, &length) &&
           parse(x, node, path, text, length, entry);
}

/* `parts` of the file, or of those that include it. */
static bool find_part(se3di_reader *reader, const se3di_node *node, se3di_component *made)
{
    const char *name = NULL;
    se3di_guess guess;
    if (!se3di_read_reference(reader, node, &name)) {
        return false;
    }
    guess = se3di_guess_begin(name);
    for (const se3di_component *part = reader->part; part; part = part->parent) {
        const se3di_node *parts = se3di_node_get(part->root, "parts");
        made->root = se3di_node_get(parts, name);
        made->file = part->file;
        if (made->root) {
            break;
        }
        for (const se3di_node *p = parts ? parts->first : NULL; p; p = p->next) {
            se3di_guess_offer(&guess, p->key);
        }
    }
    const char *meant = se3di_guess_get(&guess);
    if (!made->root) {
        se3di_reader_fail(reader, node, "no part is named `%.60s`%s%s%s", name,
                          meant ? ", did you mean `" : "; list it under `parts`",
                          meant ? meant : "", meant ? "`?" : "");
        return se3di_reader_propose(reader, meant);
    }
    for (const se3di_component *part = reader->part; part; part = part->parent) {
        if (part->root == made->root) {
            return se3di_reader_fail(reader, node, "`%.60s` includes itself", name);
        }
    }
    return true;
}

static bool check_part(se3di_reader *reader, const se3di_node *root)
{
    return se3di_read_keys(reader, root, root->parent ? &se3di_object_part : &se3di_object_model);
}

static bool find_root(expansion *x, const se3di_node *map, se3di_component *made)
{
    se3di_reader *reader = x->reader;
    const se3di_node *file = se3di_node_get(map, "file");
    const se3di_node *part = se3di_node_get(map, "part");
    se3di_library_entry *entry = NULL;
    if ((file != NULL) == (part != NULL)) {
        return se3di_reader_fail_key(
            reader, map, "file", file ? "and `part` exclude each other" : "is missing, or `part`");
    }
    if (part) {
        return find_part(reader, part, made);
    }
    if (!find_file(x, map, file, &entry) || !entry) {
        return false;
    }
    made->root = entry->root;
    made->file = entry->file;
    return true;
}

/* ---- entries --------------------------------------------------------------------------------*/

static bool read_prefix(se3di_reader *reader, const se3di_node *map, const char **prefix)
{
    const se3di_node *node = se3di_node_get(map, "prefix");
    const char *text = "";
    if (node && !se3di_read_reference(reader, node, &text)) {
        return false;
    }
    if (node && (strlen(text) > 60 || text[strcspn(text, ".,;\"'`[]{}")] || text[0] == ' ')) {
        return se3di_reader_fail(reader, node,
                                 "the prefix `%.60s` is not allowed: at most 60 characters, none "
                                 "of . , ; \" ' ` [ ] { } and no blank at its beginning",
                                 text);
    }
    *prefix = se3di_reader_prefix(reader, text);
    return *prefix != NULL;
}

static bool read_place(se3di_reader *reader, const se3di_node *map, se3di_placement *place)
{
    se3di_placement own = se3di_placement_none();
    const se3di_node *mirror = se3di_node_get(map, "mirror");
    const se3di_node *orientation = se3di_node_get(map, "orientation");
    double p[4] = {1.0, 0.0, 0.0, 0.0};
    size_t axis = 0;
    if ((mirror && !se3di_read_word(reader, mirror, mirrors, &axis)) ||
        !se3di_read_key_vector(reader, map, "position", own.r) ||
        !se3di_read_orientation(reader, orientation, p)) {
        return false;
    }
    own.moves = se3di_node_get(map, "position") != NULL;
    own.turns = mirror || orientation;
    if (orientation) {
        se3di_rotation_to_matrix(p, own.M);
    }
    if (mirror) {
        own.mirror = (int)axis;
        for (size_t i = 0; i < 3; ++i) {
            own.M[3 * i + axis] = 0.0 - own.M[3 * i + axis];
        }
    }
    *place = se3di_placement_join(&reader->part->place, &own);
    return true;
}

/* The values that the entry gives, in the scope of the caller. */
static bool read_given(se3di_reader *reader, const se3di_node *map, const char *index, double i,
                       se3di_given *given)
{
    const se3di_node *values = se3di_node_get(map, "parameters");
    if (values && values->kind != SE3DI_NODE_MAP) {
        return se3di_reader_fail(reader, values, "is %s, must be a map such as {L: 2}",
                                 se3di_node_describe(values));
    }
    given->node = values;
    given->index = index;
    given->values =
        se3di_iopool_array(reader->pool, values ? values->count + 1 : 1, sizeof *given->values);
    if (!given->values) {
        return se3di_reader_fail_memory(reader);
    }
    given->count = 0;
    for (const se3di_node *node = values ? values->first : NULL; node; node = node->next) {
        if (!se3di_read_value(reader, node, &given->values[given->count++])) {
            return false;
        }
    }
    given->i = (se3di_amount){.rank = 1, .v = {i}};
    return true;
}

static bool add_part(expansion *x, const se3di_node *map, const char *index, double i)
{
    se3di_reader *reader = x->reader;
    se3di_component *part = se3di_iopool_alloc(reader->pool, sizeof *part);
    se3di_given given;
    if (!part) {
        return se3di_reader_fail_memory(reader);
    }
    part->parent = reader->part;
    part->caller = map;
    part->depth = reader->part->depth + 1;
    if (part->depth > DEPTH_MAX) {
        return se3di_reader_fail(reader, map, "is included %d levels deep, at most %d are allowed",
                                 (int)part->depth, (int)DEPTH_MAX);
    }
    if (!read_prefix(reader, map, &part->prefix) || !read_place(reader, map, &part->place) ||
        !read_given(reader, map, index, i, &given) || !find_root(x, map, part)) {
        return false;
    }
    const se3di_component *caller = reader->part;
    reader->part = part;
    reader->file = part->file;
    if (!check_part(reader, part->root) || !se3di_read_parameters(reader, part, &given)) {
        return false;
    }
    se3di_reader_enter(reader, caller);
    x->last->next = part;
    x->last = part;
    return true;
}

/* Also of those that `when` leaves out: they take time and memory, too. */
static bool count_part(expansion *x, const se3di_node *map)
{
    return ++x->count <= PARTS_MAX ||
           se3di_reader_fail(x->reader, map, "makes more than %d parts", (int)PARTS_MAX);
}

/* The scope of the caller with the number of the part. */
static bool add_index(se3di_reader *reader, const se3di_scope *outer, const char *name, double i,
                      se3di_scope *scope)
{
    const se3di_amount value = {.rank = 1, .v = {i}};
    *scope = (se3di_scope){.units = outer->units};
    for (size_t k = 0; k < outer->count; ++k) {
        if (!se3di_scope_add(scope, reader->pool, outer->list[k].name, &outer->list[k].value)) {
            return se3di_reader_fail_memory(reader);
        }
    }
    return se3di_scope_add(scope, reader->pool, name, &value) || se3di_reader_fail_memory(reader);
}

static bool read_index(se3di_reader *reader, const se3di_node *map, const char **name)
{
    const se3di_node *node = se3di_node_get(map, "index");
    *name = "i";
    if (node && !se3di_read_text(reader, node, name)) {
        return false;
    }
    if (!se3di_text_is_identifier(*name) || se3di_scope_find(reader->scope, *name)) {
        return se3di_reader_fail_key(reader, map, node ? "index" : "repeat",
                                     "counts by `%.60s`, which must be a name that no parameter or "
                                     "point has: give another one under `index`",
                                     *name);
    }
    return true;
}

static bool read_entry(expansion *x, const se3di_node *map)
{
    se3di_reader *reader = x->reader;
    double count = 1.0;
    const char *index = NULL;
    if (!se3di_read_keys(reader, map, &se3di_object_instance) ||
        !se3di_read_key_count(reader, map, "repeat", 100000.0, &count)) {
        return false;
    }
    if (!se3di_node_get(map, "repeat")) {
        bool wanted = true;
        return count_part(x, map) && se3di_read_when(reader, map, &wanted) &&
               (!wanted || add_part(x, map, NULL, 0.0));
    }
    if (!read_index(reader, map, &index)) {
        return false;
    }
    const se3di_scope *outer = reader->scope;
    for (double i = 0.0; i < count; i += 1.0) {
        se3di_scope scope;
        bool wanted = true;
        if (!count_part(x, map) || !add_index(reader, outer, index, i, &scope)) {
            return false;
        }
        reader->scope = &scope;
        const bool good =
            se3di_read_when(reader, map, &wanted) && (!wanted || add_part(x, map, index, i));
        reader->scope = outer;
        if (!good) {
            return false;
        }
    }
    return true;
}

static bool read_list(expansion *x, const char *key)
{
    se3di_reader *reader = x->reader;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, reader->part->root, key, &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!read_entry(x, node)) {
            return false;
        }
    }
    return true;
}

bool se3di_read_parts(se3di_reader *reader, se3di_library *library)
{
    expansion x = {.reader = reader, .library = library, .last = reader->model->parts};
    for (const se3di_component *part = reader->model->parts; part; part = part->next) {
        se3di_reader_enter(reader, part);
        if (!read_list(&x, "include") || !read_list(&x, "instances")) {
            return false;
        }
    }
    se3di_reader_enter(reader, reader->model->parts);
    return true;
}
