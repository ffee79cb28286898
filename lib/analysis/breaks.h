/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints that break: events of a run of dynamics that are there without being asked for, where the
 * reaction of a joint with limits passes one of them. The rows of what breaks are left out from
 * then on, and so are those of drivers and couplers of its coordinates; force elements on them do
 * nothing any more. docs/theory/events.md */
#ifndef SE3DI_BREAKS_H
#define SE3DI_BREAKS_H

#include "analysis/run.h"

/* Whether the analysis can follow joints that may break. @return OK, UNSUPPORTED */
se3d_status se3di_breaks_check(const se3di_run *run);
/* List them behind the user's events. @return OK, NO_MEMORY */
se3d_status se3di_breaks_list(se3di_events *events);
/* The reaction in parts of its limits, the larger of force and moment: it breaks at 1. */
double se3di_break_measure(const se3di_model *model, uint32_t joint);
/* The method's forces are means over steps, or its steps cannot be made in parts: what breaks does
 * so at their ends. */
int se3di_breaks_end_steps(const se3di_events *events);
/* The name of a record as long as it lasts. @return OK, NO_MEMORY */
se3d_status se3di_breaks_keep_name(se3di_events *events, const char *name, const char **kept);
/* A record is of this joint, under its name. @return OK, NO_MEMORY */
se3d_status se3di_breaks_name_record(se3di_events *events, uint32_t joint,
                                     se3d_event_record *record);
/* In the present state some joint is loaded to its limit: the one that is loaded most breaks, with
 * its equals, and the run starts anew from there. @return OK, NO_MEMORY, or as potentials */
se3d_status se3di_breaks_happen(se3di_events *events);

#endif
