/* SPDX-License-Identifier: BSD-3-Clause */
/* What runs in a functional mock-up unit: a model that goes from one communication point to the
 * next, whatever the version of the standard. Value references are places in the list of
 * io/fmi/variables.h. */
#ifndef SE3D_IO_FMI_UNIT_H
#define SE3D_IO_FMI_UNIT_H

#include "io/fmi/variables.h"

typedef struct se3di_fmi_unit se3di_fmi_unit;

/* How far an instance is in its life. */
typedef enum se3di_fmi_mode {
    SE3DI_FMI_INSTANTIATED,
    SE3DI_FMI_INITIALIZING,
    SE3DI_FMI_STEPPING,
    SE3DI_FMI_ENDED,      /* an event of the model has stopped it: no step is possible */
    SE3DI_FMI_EVENT,      /* model exchange: what jumps may be set, */
    SE3DI_FMI_CONTINUOUS, /* the caller integrates */
    SE3DI_FMI_FAILED,     /* a step has failed */
    SE3DI_FMI_TERMINATED, /* by the caller */
    SE3DI_FMI_MODES
} se3di_fmi_mode;

/* Gets what is to be told: one sentence. */
typedef void (*se3di_fmi_tell)(void *ctx, se3d_log_level level, const char *message);

/* Make an instance of the unit whose resources are in `folder`.
 * @param[in] token      NULL: any; otherwise it must be that of the resources
 * @param[in] exchanges  the caller integrates; else the unit makes steps
 * @return NULL: `tell` was told why */
se3di_fmi_unit *se3di_fmi_unit_create(const char *folder, const char *token, bool exchanges,
                                      se3di_fmi_tell tell, void *ctx);
void se3di_fmi_unit_destroy(se3di_fmi_unit *unit);
se3di_fmi_mode se3di_fmi_unit_get_mode(const se3di_fmi_unit *unit);
double se3di_fmi_unit_get_time(const se3di_fmi_unit *unit);

/* All functions below return false after `tell` was told why. Calls in a wrong mode, unknown value
 * references and numbers that are not finite change nothing. */

/* Before the initialization. `stop` and `tolerance` NaN: not known. */
bool se3di_fmi_unit_begin(se3di_fmi_unit *unit, double start, double stop, double tolerance);
/* Go into the mode INITIALIZING, and from it into STEPPING. */
bool se3di_fmi_unit_enter(se3di_fmi_unit *unit);
bool se3di_fmi_unit_start(se3di_fmi_unit *unit);
bool se3di_fmi_unit_terminate(se3di_fmi_unit *unit);
/* As it was when it was made. */
bool se3di_fmi_unit_reset(se3di_fmi_unit *unit);
bool se3di_fmi_unit_get(se3di_fmi_unit *unit, size_t reference, double *value);
/* Set inputs and parameters, all or none. */
bool se3di_fmi_unit_set(se3di_fmi_unit *unit, const uint32_t *references, size_t count,
                        const double *values);
/* Go from `time`, the present one, to time + h. It ends earlier if an event stops the model, which
 * then is ENDED. */
bool se3di_fmi_unit_step(se3di_fmi_unit *unit, double time, double h);

/* Model exchange. If a function has failed and this is true, states or time were too far away: the
 * caller may try others. */
bool se3di_fmi_unit_discards(const se3di_fmi_unit *unit);
size_t se3di_fmi_unit_count_states(const se3di_fmi_unit *unit);
size_t se3di_fmi_unit_count_indicators(const se3di_fmi_unit *unit);
bool se3di_fmi_unit_set_time(se3di_fmi_unit *unit, double time);
/* `count` must be that of the states, or of the indicators. */
bool se3di_fmi_unit_set_states(se3di_fmi_unit *unit, const double *x, size_t count);
bool se3di_fmi_unit_get_states(se3di_fmi_unit *unit, double *x, size_t count);
bool se3di_fmi_unit_get_nominals(se3di_fmi_unit *unit, double *x, size_t count);
bool se3di_fmi_unit_get_derivatives(se3di_fmi_unit *unit, double *dx, size_t count);
bool se3di_fmi_unit_get_indicators(se3di_fmi_unit *unit, double *values, size_t count);
/* What the next trial states begin from is the present state. *event: constraints are violated so
 * much that an event is to mend them. */
bool se3di_fmi_unit_complete_step(se3di_fmi_unit *unit, bool *event);
bool se3di_fmi_unit_enter_event(se3di_fmi_unit *unit);
/* See what has happened. *ends: an event of the model ends it; *moved: the states were brought back
 * onto the constraints. */
bool se3di_fmi_unit_update_event(se3di_fmi_unit *unit, bool *ends, bool *moved);
bool se3di_fmi_unit_enter_continuous(se3di_fmi_unit *unit);

/* How unknowns (outputs, derivatives, indicators) change along `seed` of knowns (inputs, and states
 * in model exchange). In the initialization knowns are inputs and parameters, and calculated
 * parameters and states are unknowns, too. Derivatives of positions are exact if there are no
 * constraints, all others differences whose error is of the fourth order in a thousandth of what
 * is nominal.
 * @param[in] seed  [known_count]
 * @param[out] out  [unknown_count] */
bool se3di_fmi_unit_derive(se3di_fmi_unit *unit, const uint32_t *unknowns, size_t unknown_count,
                           const uint32_t *knowns, size_t known_count, const double *seed,
                           double *out);

/* The whole state as bytes; `bytes` NULL: *size is told only. */
bool se3di_fmi_unit_write(se3di_fmi_unit *unit, unsigned char *bytes, size_t *size);
/* Go on from such a state, with the same bits. If that fails halfway the unit has FAILED. */
bool se3di_fmi_unit_read(se3di_fmi_unit *unit, const unsigned char *bytes, size_t size);

#endif
