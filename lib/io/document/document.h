/* SPDX-License-Identifier: BSD-3-Clause */
/* A YAML text as a tree of scalars, lists and maps that know where they stand. */
#ifndef SE3D_IO_DOCUMENT_H
#define SE3D_IO_DOCUMENT_H

#include <stdio.h>

#include "io/base/pool.h"
#include "se3d/io.h"

/* Limits of a model file; what exceeds one is rejected with a message that names it. */
enum {
    SE3DI_DOCUMENT_DEPTH_MAX = 32,
    SE3DI_DOCUMENT_NODES_MAX = 1000000,
    SE3DI_DOCUMENT_BYTES_MAX = 64 * 1024 * 1024,
    SE3DI_DOCUMENT_SCALAR_MAX = 65536,
    SE3DI_DOCUMENT_KEYS_MAX = 4096 /* of one map */
};

typedef enum se3di_node_kind { SE3DI_NODE_SCALAR, SE3DI_NODE_LIST, SE3DI_NODE_MAP } se3di_node_kind;

typedef struct se3di_node {
    se3di_node_kind kind;
    bool plain;        /* scalar without quotes */
    bool incomplete;   /* a part of it was taken out, see recovery.h */
    bool flow;         /* map in braces */
    bool is_cut;       /* scalar without quotes that commas have cut: `text` is the whole */
    bool one_line;     /* scalar whose characters stand in the file as in `text`, on one line */
    size_t line;       /* 1-based; 0: not from the file (an option of the command line) */
    size_t column;     /* 1-based, in characters */
    size_t key_line;   /* of the key, if `key` is not NULL */
    size_t key_column; /* of the key */
    const char *text;  /* scalar */
    const char *key;   /* child of a map, or the name of an option */
    size_t index;      /* child of a list */
    size_t count;      /* children */
    const char *number_text; /* whose value is `number`; valid while it is `text` */
    double number;
    const char *file;            /* of the root of a document; NULL: another node */
    const struct se3di_key *row; /* of the table of its map; NULL: not checked yet, or in a list */
    struct se3di_node *parent;
    struct se3di_node *first;
    struct se3di_node *last;
    struct se3di_node *next; /* sibling */
} se3di_node;

/* Names that begin with one of these are formulas to spreadsheets, which open files of results. */
#define SE3DI_FORMULA_SIGNS "=+-@"

/* A file that a model file names. */
typedef struct se3di_attached_file {
    const char *path;
    const char *name; /* as the model file says it */
    const struct se3di_attached_file *next;
} se3di_attached_file;

/* Read a whole file into memory of `pool`, or more of it than a document may have.
 * @return OK, IO (errno may say why), NO_MEMORY. */
se3d_status se3di_document_read(se3di_iopool *pool, FILE *file, char **text, size_t *length);
/* Parse one document. @return OK, MODEL, NO_MEMORY, with `error` filled. */
se3d_status se3di_document_parse(se3di_iopool *pool, const char *file, const char *text,
                                 size_t length, se3di_node **root, se3d_model_error *error);

/* The same for a text of one value, which may also stand for nothing. */
se3d_status se3di_document_parse_value(se3di_iopool *pool, const char *name, const char *text,
                                       size_t length, se3di_node **root, se3d_model_error *error);

/* The child of a map, or NULL (also if `map` is NULL or not a map). */
se3di_node *se3di_node_get(const se3di_node *map, const char *key);
/* A text that no file holds, an option of the command line, copied; NULL: out of memory. */
se3di_node *se3di_node_of_text(se3di_iopool *pool, const char *key, const char *text);
/* True for a plain scalar that stands for nothing: empty, `~` or `null`. */
bool se3di_node_is_null(const se3di_node *node);
/* "a number", "a list", ...: what stands there, for messages. */
const char *se3di_node_describe(const se3di_node *node);
/* Write the path of a node, "bodies[0].mass" ("" for the root), cut to `size` bytes. */
void se3di_node_format_path(const se3di_node *node, char *path, size_t size);

/* Fill `error` with "file:line:column: path: text"; line 0 leaves the place out, an empty path is
 * left out. */
void se3di_document_report(se3d_model_error *error, const char *file, size_t line, size_t column,
                           const char *path, const char *text);

/* Bytes of the mark that some editors put at the beginning of a text in UTF-8; 0 if it has none. */
size_t se3di_byte_order_mark_length(const char *text, size_t length);

#endif
