/* SPDX-License-Identifier: BSD-3-Clause */
/* `optimize` of a study: which parameters are sought, and what for. */
#ifndef SE3D_IO_STUDY_GOAL_H
#define SE3D_IO_STUDY_GOAL_H

#include "io/channel/study.h"
#include "io/document/reader.h"

/* After the measures. `map` NULL: nothing is sought. */
bool se3di_read_study_goal(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry);
/* The name of a method, "" behind the last. */
const char *se3di_study_goal_get_method(int32_t method);

#endif
