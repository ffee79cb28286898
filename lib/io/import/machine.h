/* SPDX-License-Identifier: BSD-3-Clause */
/* A machine that is imported, in no format: bodies with their frames and masses, entries of the
 * sections of a model file, and notes on what could not be carried. The importers fill it, yaml.c
 * writes it. SI units; frames are those at the start. */
#ifndef SE3D_IO_IMPORT_MACHINE_H
#define SE3D_IO_IMPORT_MACHINE_H

#include "io/base/pool.h"
#include "io/import/frame.h"
#include "se3d/import.h"

#define SE3DI_GROUND ((size_t)-1)

typedef struct se3di_machine_shape {
    const char *type; /* as in a model file */
    double size[3];   /* box: edges; ellipsoid: semi-axes */
    double radius;
    double length;
    double scale;         /* mesh */
    const char *file;     /* mesh */
    se3di_frame frame;    /* in the body */
    double color[3];      /* color[0] < 0: none */
    uint32_t group, mask; /* bits, as in a model file; group 0: not said */
    bool passes;          /* it touches nothing */
    const char *material; /* NULL: none */
    struct se3di_machine_shape *next;
} se3di_machine_shape;

typedef struct se3di_machine_marker {
    const char *name; /* unique on its body */
    se3di_frame frame;
    struct se3di_machine_marker *next;
} se3di_machine_marker;

/* What is on a body, in the order of the file. */
typedef struct se3di_machine_parts {
    se3di_machine_shape *shapes, *last_shape;
    se3di_machine_marker *markers, *last_marker;
} se3di_machine_parts;

typedef struct se3di_machine_body {
    const char *name;
    const char *comment; /* NULL: none */
    bool fixed;
    double mass;
    double J[9];
    se3di_frame frame; /* at the centre of mass, in the ground */
    double v[3];       /* ground frame */
    double w[3];       /* body frame */
    se3di_machine_parts parts;
    se3di_ionames marker_names; /* that are taken */
} se3di_machine_body;

typedef enum se3di_section {
    SE3DI_SECTION_JOINTS,
    SE3DI_SECTION_DRIVERS,
    SE3DI_SECTION_CONSTRAINTS,
    SE3DI_SECTION_FORCES,
    SE3DI_SECTION_COUNT
} se3di_section;

typedef struct se3di_pair {
    const char *key;
    const char *value; /* as it stands in the file */
    struct se3di_pair *next;
} se3di_pair;

/* One element of a section. */
typedef struct se3di_entry {
    const char *comment; /* NULL: none */
    se3di_pair *first, *last;
    struct se3di_entry *next;
} se3di_entry;

typedef struct se3di_machine_note {
    int32_t kind; /* se3d_model_import_note_kind */
    size_t line;
    const char *text;
    struct se3di_machine_note *next;
} se3di_machine_note;

typedef struct se3di_machine {
    se3di_iopool *pool;
    const se3d_model_import_options *options;
    const char *file; /* for messages */
    const char *part; /* the file that the lines are of, if it is another one */
    const char *format;
    const char *title;
    se3d_status status; /* of the first failure */
    se3d_model_error *error;
    double gravity[3];
    se3di_machine_body *bodies;
    size_t body_count, body_room;
    se3di_machine_body ground; /* its shapes and markers */
    se3di_entry *entries[SE3DI_SECTION_COUNT], *last_entries[SE3DI_SECTION_COUNT];
    se3di_pair *parameters, *last_parameter;
    se3di_machine_note *notes, *last_note;
    size_t note_count, lost_count;
    struct se3di_machine_material *materials, *last_material; /* material.h */
    int32_t mixing;                                           /* of two: se3di_mixing */
    bool touches_later; /* `contact` is written as a comment, which its reader may take away */
    se3di_ionames body_names, names; /* that are taken */
    size_t counter;                  /* of names that are made up */
    double duration;                 /* of the analysis [s] */
    double step;                     /* of the rows of results [s], 0: none given */
} se3di_machine;

/* Fail with "file:line:column: text". @return false. */
bool se3di_machine_fail(se3di_machine *m, size_t line, size_t column, const char *format, ...)
    SE3DI_IO_FORMAT(4, 5);
bool se3di_machine_fail_memory(se3di_machine *m);
/* Note something; after a thousand notes they are only counted. */
void se3di_machine_note_of(se3di_machine *m, int32_t kind, size_t line, const char *format, ...)
    SE3DI_IO_FORMAT(4, 5);

/* Replace what cannot be shown by '?': it would break the comment or the message that holds it. */
void se3di_machine_clean(char *text);
/* A text of the machine. @return NULL: no memory. */
const char *se3di_machine_text(se3di_machine *m, const char *format, ...) SE3DI_IO_FORMAT(2, 3);
/* A number as it is written: at most 15 digits, "." in every locale. */
const char *se3di_machine_number(se3di_machine *m, double value);
/* "[a, b, c]"; what is only rounding beside the largest is 0. */
const char *se3di_machine_numbers(se3di_machine *m, const double *values, size_t count);
/* An orientation: angles, those of whole degrees as such where that is what they are. */
const char *se3di_machine_turn_text(se3di_machine *m, const double A[9]);
/* A text in quotes, if it needs them. */
const char *se3di_machine_quote(se3di_machine *m, const char *text);

/* A name that the model file allows and nothing has yet: of bodies, or of joints, drivers,
 * constraints and forces. `text` NULL or empty: one is made from `kind`. A changed one is noted. */
const char *se3di_machine_name_body(se3di_machine *m, const char *text, const char *kind,
                                    size_t line);
const char *se3di_machine_name(se3di_machine *m, const char *text, const char *kind, size_t line);

/* A name with an end, which stays whole: a long name is cut. */
const char *se3di_machine_extend(se3di_machine *m, const char *name, const char *end);

/* Each returns NULL if there is no memory, after the machine has failed. A body is valid until the
 * next is added. */
se3di_machine_body *se3di_machine_add_body(se3di_machine *m, const char *name);
/* SE3DI_GROUND is the ground. */
se3di_machine_body *se3di_machine_body_at(se3di_machine *m, size_t index);
const char *se3di_machine_body_name(se3di_machine *m, size_t index);
se3di_machine_shape *se3di_machine_add_shape(se3di_machine *m, size_t body);
/* The same for lists that are no body's yet; the name is taken as it is. */
se3di_machine_shape *se3di_parts_add_shape(se3di_machine *m, se3di_machine_parts *parts);
se3di_machine_marker *se3di_parts_add_marker(se3di_machine *m, se3di_machine_parts *parts,
                                             const char *name, const se3di_frame *frame);
/* Its name is made valid and unique on the body. */
se3di_machine_marker *se3di_machine_add_marker(se3di_machine *m, size_t body, const char *name,
                                               const se3di_frame *frame);
se3di_entry *se3di_machine_add(se3di_machine *m, se3di_section section);
/* A force element of that name, which is free; no name: nothing.  @return NULL: none was added */
se3di_entry *se3di_machine_add_force(se3di_machine *m, const char *name, const char *type);
/* Add a key to an entry; NULL is fine for an entry that could not be had. */
void se3di_entry_put(se3di_machine *m, se3di_entry *entry, const char *key, const char *value);
void se3di_entry_put_text(se3di_machine *m, se3di_entry *entry, const char *key, const char *text);
void se3di_entry_put_number(se3di_machine *m, se3di_entry *entry, const char *key, double value);
void se3di_entry_put_vector(se3di_machine *m, se3di_entry *entry, const char *key,
                            const double v[3]);
/* A parameter of the model, once; it is written before the bodies. */
void se3di_machine_parameter(se3di_machine *m, const char *name, const char *value);

/* A joint of two frames, given in the ground at the start: z is the axis, x the zero direction, and
 * each moves with its body. It is written by one point and axis if the frames allow it. */
typedef struct se3di_machine_joint {
    const char *name; /* of se3di_machine_name */
    const char *type;
    size_t body_i, body_j;
    se3di_frame frame_i, frame_j;
    double angle0; /* is added to the angle between x of i and x of j */
} se3di_machine_joint;

se3di_entry *se3di_machine_add_joint(se3di_machine *m, const se3di_machine_joint *joint);

#endif
