/* SPDX-License-Identifier: BSD-3-Clause */
/* Reports with place and path (reader.h). */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/document/document.h"
#include "io/document/reader.h"

static const se3di_node *root_of(const se3di_node *node, const se3di_node *stop)
{
    while (node->parent && node != stop) {
        node = node->parent;
    }
    return node;
}

/* Behind a message about a node of a part: where the part is included, and that where. */
static void append_chain(const se3di_reader *reader, const se3di_node *node, char *text,
                         size_t size)
{
    const se3di_component *part = reader->part;
    if (!part || root_of(node, part->root) != part->root) {
        return;
    }
    for (; part->caller; part = part->parent) {
        const size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%.200s:%zu:%zu",
                 part == reader->part ? "; included at " : ", ", part->parent->file,
                 part->caller->line, part->caller->column);
    }
}

bool se3di_reader_fail_at(se3di_reader *reader, const se3di_node *node, size_t line, size_t column,
                          const char *path, const char *text)
{
    char whole[900];
    const char *file = root_of(node, NULL)->file;
    reader->status = SE3D_ERR_MODEL;
    snprintf(whole, sizeof whole, "%s", text);
    append_chain(reader, node, whole, sizeof whole);
    se3di_document_report(reader->error, file ? file : reader->file, line, column, path, whole);
    return false;
}

bool se3di_reader_propose(se3di_reader *reader, const char *meant)
{
    reader->fault.meant = meant;
    return false;
}

/* About a key of a map, which may have it or not; NULL: about the node itself. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 0)))
#endif
static bool
fail_about(se3di_reader *reader, const se3di_node *node, const char *key, const char *format,
           va_list arguments)
{
    char path[256];
    char text[640];
    if (reader->pool->is_short) { /* what is wrong is that something is missing */
        return se3di_reader_fail_memory(reader);
    }
    vsnprintf(text, sizeof text, format, arguments);
    const se3di_node *child = key ? se3di_node_get(node, key) : NULL;
    const se3di_node *at = child ? child : node;
    reader->fault = se3di_fault_of(at);
    se3di_node_format_path(at, path, sizeof path);
    if (key && !child) {
        const size_t used = strlen(path);
        snprintf(path + used, sizeof path - used, "%s%.80s", used > 0 ? "." : "", key);
    }
    return se3di_reader_fail_at(reader, at, at->line, at->column, path, text);
}

bool se3di_reader_fail(se3di_reader *reader, const se3di_node *node, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fail_about(reader, node, NULL, format, arguments);
    va_end(arguments);
    return false;
}

bool se3di_reader_fail_key(se3di_reader *reader, const se3di_node *map, const char *key,
                           const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fail_about(reader, map, key, format, arguments);
    va_end(arguments);
    return false;
}

bool se3di_reader_fail_memory(se3di_reader *reader)
{
    reader->status = SE3D_ERR_NO_MEMORY;
    reader->fault = (se3di_fault){.node = NULL};
    se3di_document_report(reader->error, "", 0, 0, "", "out of memory");
    return false;
}

/* What is about the mass, "mass = -1 kg, must be > 0", at bodies[0] becomes "bodies[0].mass: is -1
 * kg, must be > 0". */
bool se3di_reader_fail_system(se3di_reader *reader, const se3di_node *map, se3d_status status)
{
    const char *message = se3d_system_get_error(reader->system);
    const char *field = se3d_system_get_error_field(reader->system);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(reader);
    }
    if (!se3di_node_get(map, field)) {
        return se3di_reader_fail(reader, map, "%s",
                                 message[0] ? message : se3d_status_get_text(status));
    }
    const char *rest = message + strlen(field);
    if (strncmp(rest, " = ", 3) == 0) {
        return se3di_reader_fail_key(reader, map, field, "is %s", rest + 3);
    }
    return se3di_reader_fail_key(reader, map, field, "%s", rest[0] == ' ' ? rest + 1 : message);
}

bool se3di_reader_check(se3di_reader *reader, const se3di_node *map, se3d_status status)
{
    return status < 0 ? se3di_reader_fail_system(reader, map, status) : true;
}
