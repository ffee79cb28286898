/* SPDX-License-Identifier: BSD-3-Clause */
/* The variables of a model as a functional mock-up unit has them: the time, what may be set between
 * steps, parameters, channels. The program that describes a unit and the object that runs in it
 * make the same list of the same files; the place in it is the value reference. */
#ifndef SE3D_IO_FMI_VARIABLES_H
#define SE3D_IO_FMI_VARIABLES_H

#include "io/base/pool.h"
#include "io/document/unit.h"
#include "io/model/model.h"

typedef enum se3di_fmi_role {
    SE3DI_FMI_TIME,
    SE3DI_FMI_INPUT,      /* number of an element that may change between steps */
    SE3DI_FMI_PARAMETER,  /* of the model, a number */
    SE3DI_FMI_CALCULATED, /* parameter that follows from others */
    SE3DI_FMI_OUTPUT,     /* number of a channel */
    SE3DI_FMI_STATE,      /* of model exchange: what the caller integrates, */
    SE3DI_FMI_DERIVATIVE, /* its derivative, */
    SE3DI_FMI_INDICATOR   /* what changes its sign where an event is */
} se3di_fmi_role;

typedef struct se3di_fmi_variable {
    const char *name;
    se3di_fmi_role role;
    double start;   /* of inputs, parameters and the time */
    double nominal; /* of a state: how large it is */
    bool jumps;     /* an input that must not change continuously */
    se3di_dimension dimension;
    bool has_unit;    /* `dimension` is known */
    size_t element;   /* of an input: index of the element; of a state and its derivative: which */
    size_t component; /* which of its numbers; of an output: column of the channel; of the
                         derivative of a position: the velocity that it is, and 1; 0: it is none */
    size_t output;    /* of an output: index of the results file and of the channel in it */
    size_t channel;
    const char *parameter; /* its own name */
} se3di_fmi_variable;

enum { SE3DI_FMI_VALUE_SIZE = 200, SE3DI_FMI_REASON_SIZE = 300 };

typedef struct se3di_fmi_variables {
    se3di_iopool pool;
    se3di_fmi_variable *list; /* the first is the time */
    size_t count, capacity;
    se3di_ionames names;
    /* Model exchange: states, derivatives and indicators are the last of the list. */
    size_t positions, velocities; /* of joint coordinates; the states begin with them, */
    size_t states;                /* 0: none, `reason` says why, */
    size_t state, indicator;      /* where they begin in the list, */
    size_t indicators;            /* how many there are, */
    size_t stops;                 /* and stops, whose impacts are remembered */
    bool projects;                /* constraints are left, which states may violate */
    char reason[SE3DI_FMI_REASON_SIZE];
} se3di_fmi_variables;

/* List the variables of any model, also of one that cannot be a unit, without those of model
 * exchange. @return OK, NO_MEMORY, UNSUPPORTED: two would have one name, as `problem` says; the
 * list has those before. se3di_fmi_variables_destroy is fine in any case. */
se3d_status se3di_fmi_variables_list(se3d_model *model, se3di_fmi_variables *variables,
                                     char *problem, size_t problem_size);
void se3di_fmi_variables_destroy(se3di_fmi_variables *variables);
/* Add a variable, whose name is copied; an output may be there already. @return OK, UNSUPPORTED
 * (with `problem`, another one has the name), NO_MEMORY. */
se3d_status se3di_fmi_variables_add(se3di_fmi_variables *variables, const se3di_fmi_variable *made,
                                    char *problem, size_t problem_size);
/* Set an input of the model that the list is of. */
se3d_status se3di_fmi_apply_input(const se3d_model *model, const se3di_fmi_variable *input,
                                  double value);
/* Write a value of a parameter as an expression, with its unit in SI. @return its length. */
size_t se3di_fmi_format_value(const se3di_fmi_variable *parameter, double value,
                              char text[SE3DI_FMI_VALUE_SIZE]);
/* Whether two lists have the same names in the same roles. */
bool se3di_fmi_variables_are_alike(const se3di_fmi_variables *a, const se3di_fmi_variables *b);
/* The analysis that a unit steps through: the last one in which time passes. @return false: there
 * is none. */
bool se3di_fmi_find_analysis(const se3d_model *model, size_t *index);
/* When it begins. */
double se3di_fmi_get_start(const se3d_model *model, size_t index);
/* Write the unit of a dimension, "kg.m.s-2"; "1" of a number. */
void se3di_fmi_format_unit(se3di_dimension dimension, char *text, size_t size);

/* What a unit is known by, "{xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx}": it follows from the files of
 * the model, the options, the variables and the version of the library. */
enum { SE3DI_FMI_TOKEN_SIZE = 40 };
void se3di_fmi_make_token(const se3d_model *model, const se3di_fmi_variables *variables,
                          char token[SE3DI_FMI_TOKEN_SIZE]);

#endif
