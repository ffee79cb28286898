/* SPDX-License-Identifier: BSD-3-Clause */
/* `parameters` and `table` of a study: which values its parameters have. */
#ifndef SE3D_IO_STUDY_VALUES_H
#define SE3D_IO_STUDY_VALUES_H

#include "io/channel/study.h"
#include "io/document/reader.h"

/* Those of the map under `parameters`. */
bool se3di_read_study_variables(se3di_reader *reader, const se3di_node *map,
                                se3di_study_entry *entry);
/* Parameters of which derivatives are taken: those that are listed, or all that vary. `node` may be
 * NULL. */
bool se3di_read_study_sensitivities(se3di_reader *reader, const se3di_node *node,
                                    se3di_study_entry *entry);
/* The parameter of the model that is meant. `place`: what a mistake is about. */
bool se3di_check_study_parameter(se3di_reader *reader, const se3di_node *place, const char *name);
/* Numbers of a map in one unit: what has none takes that of the others. `values` of keys that are
 * not there are as they were, and count too. */
bool se3di_read_study_amounts(se3di_reader *reader, const se3di_node *map, const char *const *keys,
                              size_t count, se3di_amount *values);
/* Columns of the CSV file under `table`: a line of names, then a line for each sample. */
bool se3di_read_study_table(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry);

#endif
