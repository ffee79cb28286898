/* SPDX-License-Identifier: BSD-3-Clause */
/* What the checker knows of a mock-up unit: its description, and its functions behind one table,
 * whatever the version of the standard. */
#ifndef SE3D_TESTS_FMI_UNIT_H
#define SE3D_TESTS_FMI_UNIT_H

#include <stddef.h>
#include <stdint.h>

enum { NAME_SIZE = 200, VARIABLES_MAX = 2000 };

typedef struct variable {
    char name[NAME_SIZE], causality[40], variability[40], unit[60];
    uint32_t reference;
    int has_start;
    double start;
    double nominal;    /* 0: not told */
    size_t derivative; /* number of the state, from 1; 0: it is none */
} variable;

typedef struct description {
    char version[20], token[80], identifier[NAME_SIZE], model[NAME_SIZE];
    variable variables[VARIABLES_MAX];
    size_t count;
    size_t outputs[VARIABLES_MAX], output_count; /* indices of variables */
    size_t unknowns[VARIABLES_MAX], unknown_count;
    size_t derivatives[VARIABLES_MAX], derivative_count;
    size_t indicators[VARIABLES_MAX], indicator_count; /* 3.0 only; 2.0 has how many */
    size_t constants[VARIABLES_MAX]; /* of a derivative: number of the state that it is, from 1 */
    char units[100][60];
    size_t unit_count, category_count;
    double start, stop;
    int can_save, can_serialize, has_derivatives, exchanges;
    int malformed;
} description;

/* Read modelDescription.xml of an unpacked unit. @return 0: it cannot be read. */
int description_read(const char *path, description *d);

enum { GOOD = 0, DISCARD = 2, BAD = 3 };

/* Statuses as in the standard; GOOD, BAD and DISCARD have the same numbers in both versions. */
typedef struct functions {
    void *object;
    void *(*instantiate)(const char *name, const char *token, const char *folder, int logging);
    void (*free)(void *c);
    int (*setup)(void *c, int has_tolerance, double tolerance, double start, int has_stop,
                 double stop);
    int (*enter)(void *c);
    int (*leave)(void *c);
    int (*terminate)(void *c);
    int (*reset)(void *c);
    int (*get)(void *c, const uint32_t *vr, size_t count, double *values);
    int (*set)(void *c, const uint32_t *vr, size_t count, const double *values);
    /* *reached: where it ended; *ended: the unit goes no further */
    int (*step)(void *c, double time, double h, double *reached, int *ended);
    int (*get_state)(void *c, void **state);
    int (*set_state)(void *c, void *state);
    int (*free_state)(void *c, void **state);
    int (*state_size)(void *c, void *state, size_t *size);
    int (*write_state)(void *c, void *state, unsigned char *bytes, size_t size);
    int (*read_state)(void *c, const unsigned char *bytes, size_t size, void **state);
    int (*other_type)(void *c, size_t count);      /* get integers */
    int (*logging)(void *c, const char *category); /* switch one on */
    int (*directional)(void *c, const uint32_t *unknowns, size_t unknown_count,
                       const uint32_t *knowns, size_t known_count, const double *seed, double *out);
    /* Model exchange. */
    int (*enter_event)(void *c);
    int (*update)(void *c, int *ends, int *moved, int *more);
    int (*go_on)(void *c); /* enter the continuous time mode */
    int (*complete)(void *c, int *event, int *ends);
    int (*set_time)(void *c, double time);
    int (*set_states)(void *c, const double *x, size_t count);
    int (*get_states)(void *c, double *x, size_t count);
    int (*get_nominals)(void *c, double *x, size_t count);
    int (*get_derivatives)(void *c, double *dx, size_t count);
    int (*get_indicators)(void *c, double *values, size_t count);
} functions;

/* What the next instances are made for: 1: model exchange. */
extern int unit_exchanges;

/* What the units have told, since the last `told_clear`. */
extern int told_errors;
extern char told_last[2000];
void told_clear(void);
extern void (*told_meddle)(void); /* called from within, unless NULL */

/* Functions that cannot be found are counted. @return the number missing, -1: no such object. */
int functions_load_2(functions *f, const char *object);
int functions_load_3(functions *f, const char *object);

/* A run of the same model: rows of numbers, of which the first is the time. */
typedef struct run {
    const description *d;
    const functions *f;
    const char *resources;
    const double *rows;
    size_t stride, row_count;
    const uint32_t *references; /* of the columns */
    size_t column_count;
} run;

/* exchange.c: what a caller that integrates meets; check.h counts in each file. @return 1: failed
 */
int exchange_check(const run *results);

#endif
