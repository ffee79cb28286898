/* SPDX-License-Identifier: BSD-3-Clause */
/* Models of the course ME751: what the files of their reader share. */
#ifndef SE3D_IO_IMPORT_ME751_H
#define SE3D_IO_IMPORT_ME751_H

#include "io/document/document.h"
#include "io/import/machine.h"

enum { SE3DI_ME751_NAMES_MAX = 8, SE3DI_ME751_KEY_MAX = 64 };

/* What a member may be called; letters and digits alone count, not their case. */
typedef struct se3di_me751_member {
    const char *names[SE3DI_ME751_NAMES_MAX];
} se3di_me751_member;

typedef struct se3di_me751_reader {
    se3di_machine *m;
    se3di_ionames ids; /* of bodies, as in the file -> index in `bodies` */
    size_t *bodies;    /* of the machine, SE3DI_GROUND: the ground */
    size_t count;
} se3di_me751_reader;

extern const se3di_me751_member se3di_me751_body_names[2];
extern const se3di_me751_member se3di_me751_direction_names[2];
extern const se3di_me751_member se3di_me751_point_names[2];
extern const se3di_me751_member se3di_me751_value_names;

/* Letters and digits in lower case, cut to SE3DI_ME751_KEY_MAX - 1. */
void se3di_me751_plain_text(const char *text, char plain[SE3DI_ME751_KEY_MAX]);
const se3di_node *se3di_me751_find(const se3di_node *map, const se3di_me751_member *wanted);
bool se3di_me751_expect(se3di_machine *m, const se3di_node *node, const char *what);
bool se3di_me751_read_number(se3di_machine *m, const se3di_node *node, double *value);
bool se3di_me751_read_numbers(se3di_machine *m, const se3di_node *node, double *values,
                              size_t count);
bool se3di_me751_read_member(se3di_machine *m, const se3di_node *map,
                             const se3di_me751_member *wanted, double *values, size_t count);
const char *se3di_me751_text_of(const se3di_node *node);
/* 0 is the ground, unless a body is called so. */
bool se3di_me751_find_body(se3di_me751_reader *r, const se3di_node *map,
                           const se3di_me751_member *wanted, size_t *body);
/* The text of a function of t as ours: without "@(t)", "lambda t:", the "()" of pi(), and the dots
 * of operators that go element by element. */
const char *se3di_me751_expression_of(se3di_machine *m, const char *text);
bool se3di_me751_compiles(const char *text);
/* Numbers f, f', f'' are those at t = 0. *value NULL: it is 0. */
bool se3di_me751_read_value(se3di_machine *m, const se3di_node *map, const char *name,
                            const char **value);
/* Note that something is not carried. */
bool se3di_me751_lose(se3di_machine *m, const se3di_node *node, const char *why);
/* Three numbers of a member as those of a key; `needed`: it is a direction, and must be there. */
bool se3di_me751_put_vector(se3di_machine *m, const se3di_node *map,
                            const se3di_me751_member *wanted, const char *key, bool needed,
                            se3di_entry *entry);

/* Whether a list is one of force elements. */
bool se3di_me751_has_forces(const se3di_node *list);
bool se3di_me751_read_forces(se3di_me751_reader *r, const se3di_node *root);

#endif
