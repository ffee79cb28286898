/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyre property files (.tir) of the Magic Formula. */
#ifndef SE3D_IO_TIR_H
#define SE3D_IO_TIR_H

#include "io/document/reader.h"

/* Read the file that `file` of a tyre names, relative to the model, into the definition, whose
 * coefficients [SE3D_TYRE_COEFFICIENTS] are `coefficients`. Law, side, radius, vertical stiffness
 * and damping, and low speed are set as far as the file has them. */
bool se3di_read_tir(se3di_reader *reader, const se3di_node *tyre, const char *file,
                    double *coefficients, se3d_tyre_def *def);

#endif
