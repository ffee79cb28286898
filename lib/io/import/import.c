/* SPDX-License-Identifier: BSD-3-Clause */
/* Importing: which format a text has, and what became of it. */
#include "se3d/import.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/floats.h"
#include "io/base/file.h"
#include "io/base/sized.h"
#include "io/document/document.h"
#include "io/import/formats.h"
#include "io/import/scan.h"
#include "io/import/yaml.h"

struct se3d_model_import {
    se3di_iopool pool; /* holds the import itself, too */
    const char *text;
    size_t length;
    const char *format;
    se3di_machine_note *notes;
    size_t note_count; /* that are kept */
    size_t lost_count;
};

/* XML by the name of its root. */
typedef struct xml_format {
    const char *option;
    const char *format;
    const char *root;
    bool (*import)(se3di_machine *m, se3di_xml *root);
} xml_format;

static const xml_format xml_formats[] = {{"urdf", "URDF", "robot", se3di_import_urdf},
                                         {"sdf", "SDF", "sdf", se3di_import_sdf},
                                         {"mjcf", "MJCF", "mujoco", se3di_import_mjcf}};

#define FORMATS                                                                                    \
    "urdf (.urdf), sdf (.sdf), mjcf (.xml), adams (.adm), chrono (.yaml) or me751 (.mdl)"

void se3d_model_import_options_init(se3d_model_import_options *options, size_t size)
{
    if (options && size >= sizeof options->struct_size) {
        memset(options, 0, size);
        options->struct_size = size;
    }
}

static bool import_xml(se3di_machine *m, const char *text, size_t length)
{
    se3di_xml *root = NULL;
    if (!se3di_xml_parse(m, text, length, &root)) {
        return false;
    }
    for (size_t k = 0; k < sizeof xml_formats / sizeof *xml_formats; ++k) {
        const xml_format *f = &xml_formats[k];
        if (se3di_xml_is(root, f->root)) {
            m->format = f->format;
            return f->import(m, root);
        }
    }
    return se3di_machine_fail(
        m, root->line, root->column,
        "<%.60s> begins no format that is known: it must be <robot> (URDF), <sdf> or "
        "<mujoco> (MJCF)",
        root->name);
}

/* The first character that is no blank, '\0' if there is none. */
static char first_character(const char *text, size_t length)
{
    for (size_t k = se3di_byte_order_mark_length(text, length); k < length; ++k) {
        if (!strchr(" \t\r\n", text[k]) && text[k]) {
            return text[k];
        }
    }
    return '\0';
}

static bool has_ending(const char *name, const char *ending)
{
    const size_t length = strlen(name);
    const size_t size = strlen(ending);
    return length > size && se3di_scan_equal(name + length - size, ending);
}

/* A YAML text, which says itself what it is. */
static bool import_document(se3di_machine *m, const char *text, size_t length)
{
    se3di_node *root = NULL;
    const se3d_status status =
        se3di_document_parse(m->pool, m->file, text, length, &root, m->error);
    if (status < 0) {
        m->status = status;
        return false;
    }
    if (m->options->format ? se3di_scan_equal(m->options->format, "me751")
                           : se3di_import_is_me751(root)) {
        m->format = "ME751";
        return se3di_import_me751(m, root);
    }
    if (se3di_import_is_chrono(root) || m->options->format) {
        m->format = "Chrono";
        return se3di_import_chrono(m, root);
    }
    return se3di_machine_fail(
        m, 1, 1, "%s",
        se3di_node_get(root, "se3d")
            ? "this is a model file already"
            : "this has no `chrono-version`, nor `bodies` and "
              "`constraints`: it is no format that is known, which are " FORMATS);
}

static bool is_known(const char *format)
{
    static const char *const others[] = {"adams", "chrono", "me751"};
    bool known = !format;
    for (size_t k = 0; k < sizeof others / sizeof *others; ++k) {
        known = known || se3di_scan_equal(format, others[k]);
    }
    for (size_t k = 0; k < sizeof xml_formats / sizeof *xml_formats; ++k) {
        known = known || se3di_scan_equal(format, xml_formats[k].option);
    }
    return known;
}

static bool is_format(const se3di_machine *m, const char *format, const char *ending)
{
    return m->options->format ? se3di_scan_equal(m->options->format, format)
                              : has_ending(m->file, ending);
}

static bool import_any(se3di_machine *m, const char *text, size_t length)
{
    const char *format = m->options->format;
    if (!is_known(format)) {
        return se3di_machine_fail(m, 0, 0, "the format `%.40s` is not known, must be " FORMATS,
                                  format);
    }
    const bool is_json = !format && first_character(text, length) == '{';
    if (is_json || is_format(m, "me751", ".mdl")) {
        return import_document(m, text, length);
    }
    if (is_format(m, "adams", ".adm")) {
        m->format = "Adams";
        return se3di_import_adams(m, text, length);
    }
    if (is_format(m, "chrono", ".yaml") || is_format(m, "chrono", ".yml")) {
        return import_document(m, text, length);
    }
    if (first_character(text, length) == '<' || format) {
        return import_xml(m, text, length);
    }
    return se3di_machine_fail(m, 1, 1, "this is no format that is known, which are " FORMATS);
}

/* What of the machine is kept: its notes and the text. */
static se3d_status finish(se3d_model_import *import, se3di_machine *m)
{
    import->format = m->format;
    import->notes = m->notes;
    import->lost_count = m->lost_count;
    for (const se3di_machine_note *at = m->notes; at; at = at->next) {
        ++import->note_count;
    }
    return se3di_machine_write(m, &import->text, &import->length);
}

static se3d_status fill(se3d_model_import *import, const se3d_model_import_options *options,
                        const char *text, size_t length, const char *name, se3d_model_error *error)
{
    se3di_machine m = {.pool = &import->pool,
                       .options = options,
                       .file = name,
                       .format = "",
                       .error = error,
                       .gravity = {0.0, 0.0, -9.81},
                       .ground = {.name = "ground"},
                       .duration = 1.0};
    m.ground.frame = se3di_frame_identity();
    if (length > SE3DI_DOCUMENT_BYTES_MAX) {
        se3di_machine_fail(&m, 0, 0, "the file has more than 64 MB");
        return m.status;
    }
    if (!import_any(&m, text, length) || m.status < 0) {
        if (m.status >= 0) {
            se3di_machine_fail_memory(&m);
        }
        return m.status;
    }
    if (m.title) {
        char *title = se3di_iopool_copy(m.pool, m.title, strlen(m.title));
        if (title) {
            se3di_machine_clean(title);
        }
        m.title = title;
    }
    return finish(import, &m);
}

static se3d_status fail_early(se3d_model_error *error, se3d_status status, const char *path,
                              const char *text)
{
    se3di_document_report(error, "", 0, 0, path, text);
    return status;
}

se3d_status se3d_model_import_text(const char *text, size_t length, const char *name,
                                   const se3d_model_import_options *options,
                                   se3d_model_import **out, se3d_model_error *error)
{
    se3d_model_import_options used = se3d_model_import_options_default();
    se3d_model_error own;
    se3di_iopool pool;
    error = error ? error : &own;
    memset(error, 0, sizeof *error);
    if (out) {
        *out = NULL;
    }
    if (options && !se3di_io_take(options, &used, sizeof used)) {
        return fail_early(error, SE3D_ERR_INVALID_ARGUMENT, "", "options: " SE3DI_IO_SIZE_TEXT);
    }
    if (!text || !name || !out) {
        return fail_early(error, SE3D_ERR_NULL, "", "text, name or out is NULL");
    }
    se3di_iopool_init(&pool, used.allocator);
    se3d_model_import *import = se3di_iopool_alloc(&pool, sizeof *import);
    if (!import) {
        se3di_iopool_destroy(&pool);
        return fail_early(error, SE3D_ERR_NO_MEMORY, "", "out of memory");
    }
    import->pool = pool;
    const se3di_floats host = se3di_floats_set();
    const se3d_status status = fill(import, &used, text, length, name, error);
    se3di_floats_restore(host);
    if (status < 0) {
        se3d_model_import_destroy(import);
        return status;
    }
    *out = import;
    return SE3D_OK;
}

bool se3di_import_read(se3di_machine *m, const char *path, char **text, size_t *length)
{
    FILE *file = se3di_file_open(path);
    if (!file) {
        return se3di_machine_fail(m, 0, 0, "%.300s: %s", path, strerror(errno));
    }
    const se3d_status status = se3di_document_read(m->pool, file, text, length);
    fclose(file);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_machine_fail_memory(m);
    }
    if (status < 0 || *length > SE3DI_DOCUMENT_BYTES_MAX) {
        return se3di_machine_fail(m, 0, 0, "%.300s: %s", path,
                                  status < 0 ? "cannot be read" : "has more than 64 MB");
    }
    return true;
}

bool se3di_import_document(se3di_machine *m, const char *path, se3di_node **root)
{
    char *text = NULL;
    size_t length = 0;
    if (!se3di_import_read(m, path, &text, &length)) {
        return false;
    }
    const se3d_status status = se3di_document_parse(m->pool, path, text, length, root, m->error);
    m->status = status < 0 ? status : m->status;
    return status >= 0;
}

se3d_status se3d_model_import_file(const char *path, const se3d_model_import_options *options,
                                   se3d_model_import **out, se3d_model_error *error)
{
    se3d_model_import_options used = se3d_model_import_options_default();
    se3di_iopool pool;
    char *text = NULL;
    size_t length = 0;
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (out) {
        *out = NULL;
    }
    if (options && !se3di_io_take(options, &used, sizeof used)) {
        return fail_early(error, SE3D_ERR_INVALID_ARGUMENT, "", "options: " SE3DI_IO_SIZE_TEXT);
    }
    if (!path || !out) {
        return fail_early(error, SE3D_ERR_NULL, "", "path or out is NULL");
    }
    FILE *file = se3di_file_open(path);
    if (!file) {
        return fail_early(error, SE3D_ERR_IO, path, strerror(errno));
    }
    se3di_iopool_init(&pool, used.allocator);
    se3d_status status = se3di_document_read(&pool, file, &text, &length);
    fclose(file);
    if (status < 0) {
        fail_early(error, status, path, status == SE3D_ERR_IO ? "cannot be read" : "out of memory");
    } else {
        status = se3d_model_import_text(text, length, path, options, out, error);
    }
    se3di_iopool_destroy(&pool);
    return status;
}

void se3d_model_import_destroy(se3d_model_import *import)
{
    if (import) {
        se3di_iopool pool = import->pool;
        se3di_iopool_destroy(&pool);
    }
}

const char *se3d_model_import_get_text(const se3d_model_import *import, size_t *length)
{
    if (length) {
        *length = import ? import->length : 0;
    }
    return import ? import->text : "";
}

const char *se3d_model_import_get_format(const se3d_model_import *import)
{
    return import ? import->format : "";
}

size_t se3d_model_import_count_notes(const se3d_model_import *import)
{
    return import ? import->note_count : 0;
}

size_t se3d_model_import_count_lost(const se3d_model_import *import)
{
    return import ? import->lost_count : 0;
}

se3d_status se3d_model_import_get_note_sized(const se3d_model_import *import, size_t index,
                                             se3d_model_import_note *note, size_t size)
{
    if (!import || !note) {
        return SE3D_ERR_NULL;
    }
    if (index >= import->note_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_machine_note *at = import->notes;
    while (index-- > 0) {
        at = at->next;
    }
    const se3d_model_import_note value = {.line = at->line, .kind = at->kind, .message = at->text};
    return se3di_io_give(note, size, &value, sizeof value);
}
