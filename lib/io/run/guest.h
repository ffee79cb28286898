/* SPDX-License-Identifier: BSD-3-Clause */
/* The units of `fmus` in an analysis. At each of its communication points a unit has gone on from
 * the one before with what it was told there; what it says then acts on the model up to the next
 * point. Both therefore know of each other one step late. */
#ifndef SE3D_IO_RUN_GUEST_H
#define SE3D_IO_RUN_GUEST_H

#include "io/channel/guest.h"
#include "io/channel/sample.h"

enum { SE3DI_GUEST_PROBLEM = 600 };

typedef struct se3di_guests se3di_guests;

/* Load and set up the units of a model for an analysis from `span[0]` to `span[1]`; those that are
 * packed are unpacked within the folder `temporary` (NULL: /tmp) until they are closed. If `keeps`,
 * each must be able to write its state. `problem` gets why not. @return OK, IO, UNSUPPORTED,
 * INVALID_ARGUMENT, NO_MEMORY; *guests is NULL then. */
se3d_status se3di_guests_open(se3d_model *model, const double span[2], const char *temporary,
                              bool keeps, se3di_guests **guests, char problem[SE3DI_GUEST_PROBLEM]);
void se3di_guests_close(se3di_guests *guests);
/* The earlier of `time` and the next communication point; all are fine with NULL. */
double se3di_guests_limit(const se3di_guests *guests, double time);
bool se3di_guests_are_due(const se3di_guests *guests, double time);
/* A unit has failed: the run ends. */
bool se3di_guests_have_failed(const se3di_guests *guests);
/* At a communication point, at which the sample is. @return OK, or a failure with `problem`. */
se3d_status se3di_guests_meet(se3di_guests *guests, se3di_sample *sample, double time,
                              char problem[SE3DI_GUEST_PROBLEM]);
/* The states of all units after a communication point, as bytes in memory of the pool, and back
 * into units that have just been opened. NULL: no bytes. @return OK, or a failure with
 * `problem`. */
se3d_status se3di_guests_write(se3di_guests *guests, se3di_iopool *pool,
                               const unsigned char **bytes, size_t *size,
                               char problem[SE3DI_GUEST_PROBLEM]);
se3d_status se3di_guests_read(se3di_guests *guests, const unsigned char *bytes, size_t size,
                              char problem[SE3DI_GUEST_PROBLEM]);

#endif
