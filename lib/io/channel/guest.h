/* SPDX-License-Identifier: BSD-3-Clause */
/* Mock-up units of other programs (FMI) that a run steps beside the model: what `fmus` says. */
#ifndef SE3D_IO_GUEST_H
#define SE3D_IO_GUEST_H

#include "io/channel/event.h"

/* A number of the model that goes to a variable of the unit. */
typedef struct se3di_guest_input {
    const char *variable;
    const char *channel;
    se3di_event_source source;
} se3di_guest_input;

/* A variable that goes to a number of an element. */
typedef struct se3di_guest_output {
    const char *variable;
    const char *element;
    size_t index; /* of the element */
    size_t component;
} se3di_guest_output;

typedef struct se3di_guest_parameter {
    const char *variable;
    double value;
} se3di_guest_parameter;

typedef struct se3di_guest_entry {
    const char *name;
    const char *file; /* as it is written */
    const char *path; /* the folder */
    double step;      /* between communication points [s] */
    se3di_guest_input *inputs;
    size_t input_count;
    se3di_guest_output *outputs;
    size_t output_count;
    se3di_guest_parameter *parameters;
    size_t parameter_count;
} se3di_guest_entry;

#endif
