/* SPDX-License-Identifier: BSD-3-Clause */
/* Reports with place and path, keys, words and names: every function of a reader returns false
 * after it has reported why. The first error ends the reading; recovery.h finds the next ones. */
#ifndef SE3D_IO_READER_H
#define SE3D_IO_READER_H

#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/document/part.h"
#include "io/document/recovery.h"
#include "io/document/scope.h"

/* Variables of an expression that stand for channels, see io/channel/combine.h. */
typedef struct se3di_measured {
    const char *const *names;          /* NULL at the end */
    const se3di_dimension *dimensions; /* of each */
    const char *written; /* the text before its channels became variables, of the same length */
} se3di_measured;

/* Entries of the lists of a part. */
typedef struct se3di_again {
    const se3di_node **nodes; /* [count] */
    size_t count, capacity;
} se3di_again;

typedef struct se3di_reader {
    se3d_model *model; /* what the sections fill; below only what values need of it */
    se3di_iopool *pool;
    const char *file;
    se3d_system *system;         /* NULL: not made yet */
    const se3di_component *part; /* where it stands; NULL: not known yet */
    const se3di_again *again;    /* [parts] the model was read before, and these entries are read
                                  * again: the system replaces what has their names; NULL: all */
    const se3di_again *wanted;   /* those of the part where it stands; NULL: all */
    const se3di_scope *scope;    /* names and units of the file */
    int alternative;             /* of the units of a key, "[m, rad]": 0, 1, ...; negative: any */
    se3di_measured measured;     /* in the expression at hand; names NULL: none */
    const se3d_model_options *options;
    se3d_model_error *error;
    se3d_status status;
    se3di_fault fault;                /* what the report is about */
    size_t attached;                  /* bytes of other files that were read */
    uint64_t content, timeless;       /* hash of them, behind those of the document */
    const se3di_attached_file *files; /* these, the last first; one may be there several times */
    const se3di_named *values;        /* [value_count] in place of parameters of the model */
    size_t value_count;
    bool is_geometric;                     /* nothing that is asked for depends on masses */
    const struct se3di_study_entry *study; /* that the model is a sample of: outputs and `study`
                                              itself are passed over; NULL: it is none */
} se3di_reader;

/* Report about a node: "file:line:column: path: text". Always false. */
SE3DI_IO_FORMAT(3, 4)
bool se3di_reader_fail(se3di_reader *reader, const se3di_node *node, const char *format, ...);
/* Report about a key of a map: where the key is, or where the map begins if it has no such key. */
SE3DI_IO_FORMAT(4, 5)
bool se3di_reader_fail_key(se3di_reader *reader, const se3di_node *map, const char *key,
                           const char *format, ...);
/* Report about a place in the file of a node, under a path of its own. */
bool se3di_reader_fail_at(se3di_reader *reader, const se3di_node *node, size_t line, size_t column,
                          const char *path, const char *text);
/* Say what was meant in place of the text of the node that was reported; NULL: not known. Always
 * false. */
bool se3di_reader_propose(se3di_reader *reader, const char *meant);
bool se3di_reader_fail_memory(se3di_reader *reader);
/* Report the system's message about the element that `map` describes, at the key it names. */
bool se3di_reader_fail_system(se3di_reader *reader, const se3di_node *map, se3d_status status);
/* The same if `status` is one of a failure, else true. */
bool se3di_reader_check(se3di_reader *reader, const se3di_node *map, se3d_status status);

/* `node` must be a map whose keys are those of `object` (and, if it has types, of its type). */
bool se3di_read_keys(se3di_reader *reader, const se3di_node *node, const se3di_object *object);
/* Refuse a value that YAML has cut at its commas. */
bool se3di_check_whole(se3di_reader *reader, const se3di_node *node);
/* The `type` of a map, one of `types`; `what` is "a joint type", ... */
bool se3di_read_type(se3di_reader *reader, const se3di_node *node, const se3di_object *object,
                     const char **type);
/* Whether an entry of a list is to be read, which it is but where only some are read again. */
bool se3di_reader_wants(const se3di_reader *reader, const se3di_node *node);
/* A list, or nothing (NULL or empty: *list is NULL). */
bool se3di_read_list(se3di_reader *reader, const se3di_node *map, const char *key,
                     const se3di_node **list);
/* A text that is one of `words` (NULL at the end): its index. */
bool se3di_read_word(se3di_reader *reader, const se3di_node *node, const char *const *words,
                     size_t *index);
bool se3di_read_text(se3di_reader *reader, const se3di_node *node, const char **text);
bool se3di_read_bool(se3di_reader *reader, const se3di_node *node, int32_t *value);
/* A name that other things refer to: not empty, without blanks at its ends, dots, commas, ... */
bool se3di_read_name(se3di_reader *reader, const se3di_node *node, const char **name);
/* Whether an expression can have a symbol of this name: an identifier of at most 60 characters that
 * is not a constant or function of expressions. @return false: out of memory. */
bool se3di_reader_try_symbol(se3di_reader *reader, const char *name, bool *is_good);

/* A text in which expressions in braces stand for whole numbers: "link{i - 1}". */
bool se3di_read_reference(se3di_reader *reader, const se3di_node *node, const char **name);
/* Whether the condition under `when` holds, or there is none. */
bool se3di_read_when(se3di_reader *reader, const se3di_node *map, bool *wanted);
/* The name of an element of a part: with the prefix of the part. */
bool se3di_read_part_name(se3di_reader *reader, const se3di_node *node, const char **name);
const char *se3di_reader_prefix(se3di_reader *reader, const char *name);
/* What is called `name` by those of a part: a thing of it, else of those that include it. */
bool se3di_reader_find(se3di_reader *reader, const se3di_ionames *names, const char *name,
                       size_t *index);

/* The name of a file inside the results folder: relative, without "..", "." and "//". */
bool se3di_read_file_name(se3di_reader *reader, const se3di_node *node, const char **name);

/* True for letters, digits and '_', not beginning with a digit. */
bool se3di_text_is_identifier(const char *text);

#endif
