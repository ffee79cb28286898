/* SPDX-License-Identifier: BSD-3-Clause */
/* Which values the parameters of a study have in sample i: a function of the study and i. */
#ifndef SE3D_IO_STUDY_DESIGN_H
#define SE3D_IO_STUDY_DESIGN_H

#include <stdint.h>

#include "io/channel/study.h"

/* Number of samples. */
uint64_t se3di_design_count(const se3di_study_entry *entry);
/* The values of sample `index`, below the count: [variable_count], in the units of the file or, if
 * they have one, in SI. */
void se3di_design_get(const se3di_study_entry *entry, uint64_t index, double *values);
/* Point `index` of Sobol's sequence in dimension `k` < 21, from 0: 32 bits of a number below 1. */
uint32_t se3di_design_sobol(size_t k, uint32_t index);

#endif
