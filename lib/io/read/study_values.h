/* SPDX-License-Identifier: BSD-3-Clause */
/* `parameters` and `table` of a study: which values its parameters have. */
#ifndef SE3D_IO_STUDY_VALUES_H
#define SE3D_IO_STUDY_VALUES_H

#include "io/channel/study.h"
#include "io/document/reader.h"

/* Those of the map under `parameters`. */
bool se3di_read_study_variables(se3di_reader *reader, const se3di_node *map,
                                se3di_study_entry *entry);
/* Columns of the CSV file under `table`: a line of names, then a line for each sample. */
bool se3di_read_study_table(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry);

#endif
