/* SPDX-License-Identifier: BSD-3-Clause */
/* A system as a model file: the text under construction, and what its sections share. An entry of a
 * section is one map, broken at 110 characters; numbers are the shortest that are read as the same.
 *
 * What a file cannot say (a callback) is a failure that names the element, or, if the caller wants
 * what can be said, a comment in its place; what depends on it goes with it. */
#ifndef SE3D_IO_SAVE_H
#define SE3D_IO_SAVE_H

#include "io/base/pool.h"
#include "io/model/model.h"
#include "se3d/io.h"

/* Names in the file, by index1 of handles; NULL: it is not in the file. */
typedef struct se3di_save_names {
    const char **names;
    uint32_t count;
} se3di_save_names;

typedef struct se3di_save {
    se3di_iopool pool;
    const se3d_system *system;
    const se3d_model *model; /* whose system it is; NULL: none */
    const char *path;        /* of the file to be; NULL: none */
    bool wants_document;     /* what only the model knows, too */
    bool partial;            /* what cannot be said becomes a comment */
    se3di_iotext out;
    bool is_first; /* the next pair is the first of its map */
    const char *indent;
    bool in_files;       /* `file` of the document's nodes is one that the model reads */
    const char *section; /* whose title is due before the next entry; NULL: none */
    se3d_status status;  /* < 0: the writing ends */
    char problem[500];   /* why the entry at hand cannot be written; "": it can */
    se3di_save_names bodies, constraints, forces, materials, roads, wheels; /* states are forces */
} se3di_save;

/* ---- text: nothing happens after a failure ---- */

void se3di_save_put(se3di_save *s, const char *text);
void se3di_save_line(se3di_save *s, const char *text);
void se3di_save_comment(se3di_save *s, const char *indent, const char *text);
/* A scalar that is read as this text. */
void se3di_save_put_text(se3di_save *s, const char *text);
void se3di_save_put_quoted(se3di_save *s, const char *text);
/* `key: value` of the map at hand. */
void se3di_save_word(se3di_save *s, const char *key, const char *word);
void se3di_save_text(se3di_save *s, const char *key, const char *text);
void se3di_save_number(se3di_save *s, const char *key, double value);
void se3di_save_vector(se3di_save *s, const char *key, const double *values, size_t count);
void se3di_save_orientation(se3di_save *s, const char *key, const double p[4]);
/* Numbers in brackets, without a key. */
void se3di_save_put_numbers(se3di_save *s, const double *values, size_t count);
void se3di_save_put_row(se3di_save *s, const double *values, size_t count);
/* The same unless it is this value, or zero. */
void se3di_save_number_but(se3di_save *s, const char *key, double value, double standard);
void se3di_save_vector_but_zero(se3di_save *s, const char *key, const double *values, size_t count);

/* ---- entries ---- */

/* The title of a section comes before its first entry. */
void se3di_save_begin_section(se3di_save *s, const char *title);
/* An entry of the section; between the two, se3di_save_refuse may be called. @return of the end:
 * whether it is in the file */
typedef struct se3di_save_entry {
    size_t used, column;
    const char *section;
} se3di_save_entry;
se3di_save_entry se3di_save_open(se3di_save *s);
bool se3di_save_close(se3di_save *s, const se3di_save_entry *entry);
SE3DI_IO_FORMAT(2, 3)
void se3di_save_refuse(se3di_save *s, const char *format, ...);
bool se3di_save_is_zero(const double *values, size_t count);

/* ---- what entries refer to: refused if it is not in the file ---- */

void se3di_save_body(se3di_save *s, const char *key, se3d_body body);
void se3di_save_constraint(se3di_save *s, const char *key, se3d_constraint constraint);
/* joint, coordinate */
void se3di_save_coordinate(se3di_save *s, se3d_constraint joint, int32_t coordinate);
/* A function of the variables `own` (NULL at the end), or of time; its signals become channels. */
void se3di_save_function(se3di_save *s, const char *key, se3d_function function,
                         const char *const *own);
/* The same in a list: a function, or the number if it is null. */
void se3di_save_put_function(se3di_save *s, se3d_function function, double value,
                             const char *const *own);
/* The name of a channel for a number of the state; refused if there is none. */
const char *se3di_save_channel(se3di_save *s, const se3d_signal *signal);

/* Heights, each `stride` numbers behind the one before it, in rows; and how far these are apart. */
void se3di_save_heights(se3di_save *s, const double *heights, size_t stride, size_t rows,
                        size_t columns);
void se3di_save_spacing(se3di_save *s, const double spacing[2]);
/* Let what is wrong with the entry at hand say whose it is. */
void se3di_save_name_problem(se3di_save *s, const char *what, const char *name);

/* Whether numbers without a unit are metres in the file of a part that are lengths: those of tables
 * of heights. */
bool se3di_save_is_in_metres(const se3di_component *part);
/* A file that a part of the model names (NULL: the model itself), as the file to be has to say it:
 * from its own folder. */
const char *se3di_save_get_file(se3di_save *s, const se3di_component *part, const char *file);

/* ---- sections, in the order of the file ---- */

/* Names of all elements; NO_MEMORY, or names that a file cannot have. */
bool se3di_save_name_all(se3di_save *s);
void se3di_save_head(se3di_save *s);
void se3di_save_materials(se3di_save *s);
void se3di_save_bodies(se3di_save *s);
void se3di_save_shapes(se3di_save *s, se3d_body body);
void se3di_save_constraints(se3di_save *s);
void se3di_save_states(se3di_save *s);
void se3di_save_forces(se3di_save *s);
void se3di_save_wheels(se3di_save *s);
void se3di_save_contact(se3di_save *s);
/* What the model's file says there, in braces and brackets. */
void se3di_save_put_node(se3di_save *s, const se3di_node *node);
/* Whether that is in units of its own. */
bool se3di_save_has_units(const se3di_save *s);
void se3di_save_roads(se3di_save *s);
/* What only the model knows: analyses, results, events, particles. */
void se3di_save_document(se3di_save *s);
/* What of that is not written: a refusal, or a comment at the end. */
void se3di_save_losses(se3di_save *s);
/* Of `contact`, as the file says them; NULL at the end. */
extern const char *const se3di_save_domain_keys[];

#endif
