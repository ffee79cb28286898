/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model that was read without mistakes says that is probably one: told to the log. */
#ifndef SE3D_IO_WARN_H
#define SE3D_IO_WARN_H

#include "io/document/reader.h"

/* After all sections. @return false: out of memory */
bool se3di_warn_of_model(se3di_reader *reader);

#endif
