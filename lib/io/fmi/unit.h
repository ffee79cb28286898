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
    SE3DI_FMI_FAILED,     /* a step has failed */
    SE3DI_FMI_TERMINATED, /* by the caller */
    SE3DI_FMI_MODES
} se3di_fmi_mode;

/* Gets what is to be told: one sentence. */
typedef void (*se3di_fmi_tell)(void *ctx, se3d_log_level level, const char *message);

/* Make an instance of the unit whose resources are in `folder`.
 * @param[in] token  NULL: any; otherwise it must be that of the resources
 * @return NULL: `tell` was told why */
se3di_fmi_unit *se3di_fmi_unit_create(const char *folder, const char *token, se3di_fmi_tell tell,
                                      void *ctx);
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

/* The whole state as bytes; `bytes` NULL: *size is told only. */
bool se3di_fmi_unit_write(se3di_fmi_unit *unit, unsigned char *bytes, size_t *size);
/* Go on from such a state, with the same bits. If that fails halfway the unit has FAILED. */
bool se3di_fmi_unit_read(se3di_fmi_unit *unit, const unsigned char *bytes, size_t size);

#endif
