/* SPDX-License-Identifier: BSD-3-Clause */
/* Results for ParaView: a .pvd file that lists a .vtp file of the bodies and one of the particles
 * for each time. They lie in a folder beside it, of its name. */
#ifndef SE3D_IO_VTK_H
#define SE3D_IO_VTK_H

#include "base/coder.h"
#include "io/channel/sample.h"
#include "io/model/model.h"

typedef struct se3di_vtk se3di_vtk;

/* Begin a series in memory of `pool`; `path` ends with .pvd. @return NULL: out of memory. */
se3di_vtk *se3di_vtk_open(se3d_model *model, se3di_iopool *pool, const char *path);
/* Write the present state, that of the sample; at the time of the one before it takes its place.
 * After a failure nothing more is written. */
void se3di_vtk_record(se3di_vtk *vtk, se3di_sample *sample, double time);
/* The times so far; reading: the states of these times have been written before. */
void se3di_vtk_pack(se3di_vtk *vtk, se3di_coder *coder);
/* Write the list; on a full disk of as many states as there is room for. @return OK, NO_MEMORY, or
 * IO: errno of the first failure in *why. */
se3d_status se3di_vtk_close(se3di_vtk *vtk, int *why);
const char *se3di_vtk_get_path(const se3di_vtk *vtk);
/* How many times were written, and are in the list once it is closed. */
size_t se3di_vtk_count(const se3di_vtk *vtk);

#endif
