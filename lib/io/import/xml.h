/* SPDX-License-Identifier: BSD-3-Clause */
/* An XML text as a tree of elements that know their lines. Entities, which can make a small file
 * large, are refused; size, depth and number of elements are bounded. Needs expat: without it every
 * text is refused with a message. */
#ifndef SE3D_IO_IMPORT_XML_H
#define SE3D_IO_IMPORT_XML_H

#include "io/import/machine.h"

enum {
    SE3DI_XML_DEPTH_MAX = 64,
    SE3DI_XML_NODES_MAX = 100000,
    SE3DI_XML_TEXT_MAX = 65536 /* of one element */
};

typedef struct se3di_attribute {
    const char *name, *value;
} se3di_attribute;

typedef struct se3di_xml {
    const char *name;
    const char *text; /* all its characters; "" if there are none */
    se3di_attribute *attributes;
    size_t attribute_count;
    size_t line, column;
    struct se3di_xml *parent, *first, *last, *next;
} se3di_xml;

bool se3di_xml_parse(se3di_machine *m, const char *text, size_t length, se3di_xml **root);

/* The value of an attribute, or NULL (also of NULL). */
const char *se3di_xml_get(const se3di_xml *node, const char *name);
/* The first child of this name, or NULL (also of NULL). */
se3di_xml *se3di_xml_child(const se3di_xml *node, const char *name);
/* The next one of the same name after `node`. */
se3di_xml *se3di_xml_again(const se3di_xml *node);
bool se3di_xml_is(const se3di_xml *node, const char *name);

/* Read `count` numbers of an attribute into `values`, which stay what they are without it. @return
 * false: it is something else, and the machine has failed. */
bool se3di_xml_numbers(se3di_machine *m, const se3di_xml *node, const char *name, double *values,
                       int count);
/* The same of the characters of an element. */
bool se3di_xml_text_numbers(se3di_machine *m, const se3di_xml *node, double *values, int count);
/* An attribute that must be there. @return NULL: the machine has failed. */
const char *se3di_xml_need(se3di_machine *m, const se3di_xml *node, const char *name);
/* An element without children of this name and text, beside a tree. @return NULL: no memory. */
se3di_xml *se3di_xml_create(se3di_machine *m, const char *name);

#endif
