/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of chrono*.c share. */
#ifndef SE3D_IO_IMPORT_CHRONO_H
#define SE3D_IO_IMPORT_CHRONO_H

#include "io/document/document.h"
#include "io/import/machine.h"

typedef struct se3di_chrono {
    se3di_machine *m;
    bool degrees;
    const char *folder;  /* of meshes */
    se3di_ionames names; /* of bodies, as in the file -> index in `list` */
    struct se3di_chrono_body *list;
    size_t count, room;
} se3di_chrono;

typedef struct se3di_chrono_body {
    size_t body; /* of the machine */
    bool fixed;
    se3di_frame frame; /* of reference, in the ground */
    se3di_frame mass;  /* at the centre of mass, in the ground */
} se3di_chrono_body;

/* chrono_values.c: each leaves the value alone if there is no such key. @return false: failed. */
bool se3di_chrono_number(se3di_chrono *c, const se3di_node *map, const char *key, double *value);
bool se3di_chrono_numbers(se3di_chrono *c, const se3di_node *map, const char *key, double *values,
                          size_t count);
bool se3di_chrono_bool(se3di_chrono *c, const se3di_node *map, const char *key, bool *value);
/* Angles [yaw, pitch, roll], or Euler parameters. */
bool se3di_chrono_turn(se3di_chrono *c, const se3di_node *map, const char *key, double A[9]);
/* `location` and `orientation`. */
bool se3di_chrono_frame(se3di_chrono *c, const se3di_node *map, se3di_frame *frame);
/* Axes with z along a direction; `frame->A` stays what it is without the key. */
bool se3di_chrono_axis(se3di_chrono *c, const se3di_node *map, const char *key, double A[9]);
/* A text; NULL: there is none, or the machine has failed. */
const char *se3di_chrono_text(se3di_chrono *c, const se3di_node *map, const char *key);
/* A text that must be there. NULL: the machine has failed. */
const char *se3di_chrono_need(se3di_chrono *c, const se3di_node *map, const char *key);
/* Fail at a map that lacks a key. @return whether it is there. */
bool se3di_chrono_has(se3di_chrono *c, const se3di_node *map, const char *key);
/* The first entry of the list under a key; NULL: none, or the machine has failed. */
const se3di_node *se3di_chrono_list(se3di_chrono *c, const se3di_node *map, const char *key);
/* Note the keys that are not among `known`, separated by blanks. */
void se3di_chrono_keys(se3di_chrono *c, const se3di_node *map, const char *known);
/* The body that a key names. NULL: the machine has failed. */
const se3di_chrono_body *se3di_chrono_body_of(se3di_chrono *c, const se3di_node *map,
                                              const char *key);
/* body1 and body2; *differ: something can move between them, else that is noted. */
bool se3di_chrono_bodies_of(se3di_chrono *c, const se3di_node *map,
                            const se3di_chrono_body *bodies[2], bool *differ);
/* Note that an element is not carried. @return true. */
bool se3di_chrono_lose(se3di_chrono *c, const se3di_node *map, const char *what, const char *why);

/* chrono_function.c */
typedef enum se3di_chrono_function_kind {
    SE3DI_CHRONO_POLYNOMIAL,
    SE3DI_CHRONO_SINE,
    SE3DI_CHRONO_DATA,
    SE3DI_CHRONO_CONTROLLER
} se3di_chrono_function_kind;

typedef struct se3di_chrono_function {
    se3di_chrono_function_kind kind;
    double *values; /* coefficients in ascending order, or pairs x, y */
    size_t count;
    double amplitude, rate, phase, shift;
    bool repeats;
    double start, width, offset;
} se3di_chrono_function;

bool se3di_chrono_function_read(se3di_chrono *c, const se3di_node *map,
                                se3di_chrono_function *function);
/* Points [x, y] in ascending order, linear between them and constant beyond. */
bool se3di_chrono_points(se3di_chrono *c, const se3di_node *map, const char *key,
                         se3di_chrono_function *function);
/* Expressions in `variable`, and of its integral from 0 in t. NULL: it is too long for an
 * expression, or there is no memory. */
const char *se3di_chrono_expression(se3di_chrono *c, const se3di_chrono_function *function,
                                    const char *variable);
const char *se3di_chrono_integral(se3di_chrono *c, const se3di_chrono_function *function);

/* chrono_bodies.c, chrono_joints.c, chrono_motors.c, chrono_forces.c: one entry of a list */
bool se3di_chrono_body_read(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_joint(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_constraint(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_motor(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_tsda(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_rsda(se3di_chrono *c, const se3di_node *map);
bool se3di_chrono_load(se3di_chrono *c, const se3di_node *map);

#endif
