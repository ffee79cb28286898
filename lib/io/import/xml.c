/* SPDX-License-Identifier: BSD-3-Clause */
/* An XML text as a tree: what expat calls back with is copied into the machine's memory. */
#include "io/import/xml.h"

#include <string.h>

#include "io/import/scan.h"

const char *se3di_xml_get(const se3di_xml *node, const char *name)
{
    for (size_t k = 0; node && k < node->attribute_count; ++k) {
        if (strcmp(node->attributes[k].name, name) == 0) {
            return node->attributes[k].value;
        }
    }
    return NULL;
}

bool se3di_xml_is(const se3di_xml *node, const char *name)
{
    return strcmp(node->name, name) == 0;
}

static se3di_xml *find(se3di_xml *node, const char *name)
{
    while (node && strcmp(node->name, name) != 0) {
        node = node->next;
    }
    return node;
}

se3di_xml *se3di_xml_child(const se3di_xml *node, const char *name)
{
    return node ? find(node->first, name) : NULL;
}

se3di_xml *se3di_xml_again(const se3di_xml *node)
{
    return find(node->next, node->name);
}

bool se3di_xml_numbers(se3di_machine *m, const se3di_xml *node, const char *name, double *values,
                       int count)
{
    double read[36];
    const char *text = se3di_xml_get(node, name);
    if (!text) {
        return true;
    }
    if (se3di_scan_numbers(text, read, count) != count) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "<%.60s %s=\"%.60s\">: must be %d number%s", node->name, name,
                                  text, count, count == 1 ? "" : "s");
    }
    memcpy(values, read, (size_t)count * sizeof *values);
    return true;
}

bool se3di_xml_text_numbers(se3di_machine *m, const se3di_xml *node, double *values, int count)
{
    double read[36];
    if (!node) {
        return true;
    }
    if (se3di_scan_numbers(node->text, read, count) != count) {
        return se3di_machine_fail(m, node->line, node->column,
                                  "<%.60s>%.60s</>: must be %d number%s", node->name, node->text,
                                  count, count == 1 ? "" : "s");
    }
    memcpy(values, read, (size_t)count * sizeof *values);
    return true;
}

const char *se3di_xml_need(se3di_machine *m, const se3di_xml *node, const char *name)
{
    const char *value = se3di_xml_get(node, name);
    if (!value || !value[0]) {
        se3di_machine_fail(m, node->line, node->column, "<%.60s> has no `%s`", node->name, name);
        return NULL;
    }
    return value;
}

se3di_xml *se3di_xml_create(se3di_machine *m, const char *name)
{
    se3di_xml *node = se3di_iopool_alloc(m->pool, sizeof *node);
    if (!node) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    node->name = name;
    node->text = "";
    return node;
}

#if defined(SE3D_HAS_EXPAT)
#include <expat.h>

typedef struct builder {
    se3di_machine *m;
    XML_Parser parser;
    se3di_xml *root;
    se3di_xml *at;
    size_t depth, count;
    char *characters; /* of `at`, [SE3DI_XML_TEXT_MAX] */
    size_t used;
} builder;

static void stop(builder *b, const char *why)
{
    se3di_machine_fail(b->m, XML_GetCurrentLineNumber(b->parser),
                       XML_GetCurrentColumnNumber(b->parser) + 1, "%s", why);
    XML_StopParser(b->parser, XML_FALSE);
}

static void stop_memory(builder *b)
{
    se3di_machine_fail_memory(b->m);
    XML_StopParser(b->parser, XML_FALSE);
}

static void add_attributes(builder *b, se3di_xml *node, const XML_Char **list)
{
    size_t count = 0;
    while (list[2 * count]) {
        ++count;
    }
    node->attributes = se3di_iopool_array(b->m->pool, count + 1, sizeof *node->attributes);
    for (size_t k = 0; node->attributes && k < count; ++k) {
        se3di_attribute *to = &node->attributes[k];
        to->name = se3di_iopool_copy(b->m->pool, list[2 * k], strlen(list[2 * k]));
        to->value = se3di_iopool_copy(b->m->pool, list[2 * k + 1], strlen(list[2 * k + 1]));
        if (!to->name || !to->value) {
            stop_memory(b);
            return;
        }
        node->attribute_count = k + 1;
    }
    if (!node->attributes) {
        stop_memory(b);
    }
}

/* The characters before a child or the end belong to the element; only those of elements without
 * children are used. */
static void keep_text(builder *b)
{
    if (b->at && b->used > 0) {
        const char *text = se3di_iopool_copy(b->m->pool, b->characters, b->used);
        b->at->text = text ? text : "";
        if (!text) {
            stop_memory(b);
        }
    }
    b->used = 0;
}

static void XMLCALL begin(void *data, const XML_Char *name, const XML_Char **list)
{
    builder *b = data;
    if (b->m->status < 0) {
        return; /* expat may call once more after it was stopped */
    }
    b->used = 0;
    if (++b->depth > SE3DI_XML_DEPTH_MAX) {
        stop(b, "elements are nested deeper than 64");
        return;
    }
    if (++b->count > SE3DI_XML_NODES_MAX) {
        stop(b, "there are more than 100000 elements");
        return;
    }
    const char *copy = se3di_iopool_copy(b->m->pool, name, strlen(name));
    se3di_xml *node = copy ? se3di_xml_create(b->m, copy) : NULL;
    if (!node) {
        stop_memory(b);
        return;
    }
    node->line = XML_GetCurrentLineNumber(b->parser);
    node->column = XML_GetCurrentColumnNumber(b->parser) + 1;
    node->parent = b->at;
    if (!b->at) {
        b->root = node;
    } else if (b->at->last) {
        b->at->last->next = node;
        b->at->last = node;
    } else {
        b->at->first = b->at->last = node;
    }
    b->at = node;
    add_attributes(b, node, list);
}

static void XMLCALL end(void *data, const XML_Char *name)
{
    builder *b = data;
    (void)name;
    if (b->m->status < 0 || !b->at) {
        return;
    }
    keep_text(b);
    b->at = b->at->parent;
    --b->depth;
}

static void XMLCALL characters(void *data, const XML_Char *text, int length)
{
    builder *b = data;
    const size_t size = (size_t)length;
    if (b->m->status < 0) {
        return;
    }
    if (b->used + size > SE3DI_XML_TEXT_MAX) {
        stop(b, "an element has more than 65536 characters");
        return;
    }
    memcpy(b->characters + b->used, text, size);
    b->used += size;
}

/* Entities can be declared there only: files outside are never read. */
static void XMLCALL refuse_entities(void *data, const XML_Char *name, const XML_Char *system,
                                    const XML_Char *public_id, int has_declarations)
{
    (void)name, (void)system, (void)public_id;
    if (has_declarations) {
        stop(data, "entities are not allowed: the document type has declarations");
    }
}

static bool parse_all(builder *b, const char *text, size_t length)
{
    XML_SetUserData(b->parser, b);
    XML_SetElementHandler(b->parser, begin, end);
    XML_SetCharacterDataHandler(b->parser, characters);
    XML_SetStartDoctypeDeclHandler(b->parser, refuse_entities);
    /* pieces: expat takes an int, and its buffer does not grow to the size of the file */
    for (size_t at = 0;; at += 65536) {
        const size_t size = length - at < 65536 ? length - at : 65536;
        const bool last = at + size == length;
        if (XML_Parse(b->parser, text + at, (int)size, last) != XML_STATUS_OK) {
            break;
        }
        if (last) {
            return b->m->status >= 0;
        }
    }
    const enum XML_Error why = XML_GetErrorCode(b->parser);
    if (why == XML_ERROR_NO_MEMORY) {
        return se3di_machine_fail_memory(b->m);
    }
    return se3di_machine_fail(b->m, XML_GetCurrentLineNumber(b->parser),
                              XML_GetCurrentColumnNumber(b->parser) + 1, "no valid XML: %s",
                              XML_ErrorString(why));
}

bool se3di_xml_parse(se3di_machine *m, const char *text, size_t length, se3di_xml **root)
{
    builder b = {.m = m};
    b.characters = se3di_iopool_alloc(m->pool, SE3DI_XML_TEXT_MAX);
    b.parser = b.characters ? XML_ParserCreate(NULL) : NULL;
    if (!b.parser) {
        return se3di_machine_fail_memory(m);
    }
    /* a seed of its own would make expat ask for random numbers: names are few, and bounded */
    XML_SetHashSalt(b.parser, 0x5e3d);
    const bool good = parse_all(&b, text, length);
    XML_ParserFree(b.parser);
    *root = b.root;
    if (good && !b.root) {
        return se3di_machine_fail(m, 1, 1, "there is no element");
    }
    return good;
}
#else
bool se3di_xml_parse(se3di_machine *m, const char *text, size_t length, se3di_xml **root)
{
    (void)text, (void)length;
    *root = NULL;
    return se3di_machine_fail(m, 0, 0,
                              "this is XML, which needs expat: this se3d was built without it "
                              "(Debian: libexpat1-dev)");
}
#endif
