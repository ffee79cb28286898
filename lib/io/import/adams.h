/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of adams*.c share. */
#ifndef SE3D_IO_IMPORT_ADAMS_H
#define SE3D_IO_IMPORT_ADAMS_H

#include "io/import/machine.h"

/* "KEY = a, b": the values up to the next key. A flag has none. */
typedef struct se3di_adams_value {
    const char *key; /* "" for values before the first key */
    const char *text;
    char *end;    /* of the text */
    bool is_list; /* its values are separated by commas */
    struct se3di_adams_value *next;
} se3di_adams_value;

typedef struct se3di_adams_statement {
    const char *word; /* in capitals, in full */
    long id;          /* -1: none */
    const char *name; /* adams_view_name, or NULL */
    size_t line;
    se3di_adams_value *first, *last;
    const char *made;   /* the element of the machine that it became, or NULL */
    bool turns, slides; /* a joint whose angle or displacement that element has */
    size_t index;       /* of a part: body of the machine; of a marker: in the list of markers */
    struct se3di_adams_statement *next;
} se3di_adams_statement;

typedef struct se3di_adams_marker {
    const se3di_adams_statement *statement;
    size_t body;       /* of the machine */
    se3di_frame frame; /* in the ground */
    const char *name;  /* on the body; NULL: it is not there */
} se3di_adams_marker;

typedef struct se3di_adams {
    se3di_machine *m;
    se3di_adams_statement *first, *last;
    se3di_ionames statements; /* "MARKER/12" -> index */
    se3di_adams_statement **by_index;
    size_t count, room;
    se3di_adams_marker *markers;
    size_t marker_count, marker_room;
    double force, mass, length, time; /* units of the file in SI */
} se3di_adams;

/* adams_text.c */
bool se3di_adams_read(se3di_adams *a, const char *text, size_t length);
se3di_adams_statement *se3di_adams_find(const se3di_adams *a, const char *word, long id);
/* The values of a key; its beginning is enough if it has three letters. NULL: it is not there. */
const char *se3di_adams_get(const se3di_adams_statement *s, const char *key);
bool se3di_adams_has(const se3di_adams_statement *s, const char *flag);
/* Read numbers, "30D" in radians; *count: how many. */
bool se3di_adams_numbers(se3di_adams *a, const se3di_adams_statement *s, const char *key,
                         double *values, int room, int *count);
bool se3di_adams_number(se3di_adams *a, const se3di_adams_statement *s, const char *key,
                        double scale, double *value);
/* The marker that a key names. @return NULL: failed. */
const se3di_adams_marker *se3di_adams_marker_of(se3di_adams *a, const se3di_adams_statement *s,
                                                const char *key);
const se3di_adams_marker *se3di_adams_marker_at(se3di_adams *a, long id);

/* adams_function.c: what an expression may mean beside the time. */
typedef struct se3di_adams_meaning {
    long i, j;            /* markers; -1: the function is of time only */
    const char *distance; /* what DM(i, j) is, NULL: not allowed */
    const char *speed;    /* VR */
    const char *angle;    /* AZ */
    const char *turning;  /* WZ */
} se3di_adams_meaning;

/* An expression of a model file. @return NULL: it cannot be said (*why says what), or no memory. */
const char *se3di_adams_translate(se3di_adams *a, const char *text,
                                  const se3di_adams_meaning *meaning, const char **why);

/* adams_parts.c, adams_joints.c, adams_forces.c */
bool se3di_adams_parts(se3di_adams *a);
bool se3di_adams_joint(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_jprim(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_gcon(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_motion(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_coupler(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_gear(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_rackpin(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_sforce(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_springdamper(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_bushing(se3di_adams *a, se3di_adams_statement *s);
bool se3di_adams_gforce(se3di_adams *a, se3di_adams_statement *s);
/* Note that a statement is not carried. @return true. */
bool se3di_adams_lose(se3di_adams *a, const se3di_adams_statement *s, const char *why);
/* A name of the machine for it: that of the file, or its word and number. */
const char *se3di_adams_name(se3di_adams *a, se3di_adams_statement *s);

#endif
