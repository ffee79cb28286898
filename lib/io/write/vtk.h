/* SPDX-License-Identifier: BSD-3-Clause */
/* Results for ParaView: a .pvd file that lists, for each time, a .vtp file of the bodies, one of
 * the particles, one of the contacts and a .vti file of fields. They lie in a folder beside it, of
 * its name. Or all as .vtkhdf files, with a list for each of these parts. */
#ifndef SE3D_IO_VTK_H
#define SE3D_IO_VTK_H

#include "base/coder.h"
#include "io/channel/sample.h"
#include "io/model/model.h"
#include "io/write/vtk_file.h"
#include "se3d/field.h"

typedef struct se3di_vtk se3di_vtk;

/* Begin a series in memory of `pool`; `path` ends with .pvd or .vtkhdf; `grid`: of fields of the
 * particles, NULL: none. @return NULL: out of memory. */
se3di_vtk *se3di_vtk_open(se3d_model *model, se3di_iopool *pool, const char *path,
                          const se3d_field_grid *grid, int compression);
/* Write the present state, that of the sample; at the time of the one before it takes its place.
 * After a failure nothing more is written. */
void se3di_vtk_record(se3di_vtk *vtk, se3di_sample *sample, double time);
/* The times so far; reading: the states of these times have been written before. */
void se3di_vtk_pack(se3di_vtk *vtk, se3di_coder *coder);
/* Write the list; on a full disk of as many states as there is room for. @return OK, NO_MEMORY, or
 * IO: errno of the first failure in *why. */
se3d_status se3di_vtk_close(se3di_vtk *vtk, int *why);
/* The list, or the first of several. */
const char *se3di_vtk_get_path(const se3di_vtk *vtk);
/* How many times were written, and are in the list once it is closed. */
size_t se3di_vtk_count(const se3di_vtk *vtk);

/* Write fields alone, SE3D_FIELD_VALUES of each cell, as .vti or .vtkhdf. @return false: errno says
 * why. */
bool se3di_vtk_write_fields(const se3d_field_grid *grid, const double *values, size_t cells,
                            const se3di_vtk_target *to);

#endif
