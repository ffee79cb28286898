/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots of particles. */
#ifndef SE3D_IO_PARTICLE_LIST_H
#define SE3D_IO_PARTICLE_LIST_H

#include "io/model/model.h"
#include "io/write/csv.h"
#include "io/write/table_hdf5.h"

enum { SE3DI_PARTICLE_COLUMNS = 14 };

/* Particles as they are, in ascending order of the ids. */
typedef struct se3di_particle_rows {
    double *rows; /* [count * SE3DI_PARTICLE_COLUMNS]; the last two: what contacts do [N]; the
                   * clump, -1: none */
    uint32_t *tags;
    const char **materials; /* names */
    size_t count;
} se3di_particle_rows;

/* Columns of a snapshot: numbers, material, set ("": without a name), the size of the force of the
 * contacts in the last step, and if the model has clumps, of which one a sphere is. */
size_t se3di_tagged_count_columns(const se3d_model *model);
const char *se3di_tagged_get_column(size_t k);
/* Which of them are texts or whole numbers. */
se3di_table_columns se3di_tagged_get_kinds(void);
/* Copy all particles. */
se3d_status se3di_tagged_get_rows(const se3d_model *model, se3di_iopool *pool,
                                  se3di_particle_rows *rows);
/* Write a row for each particle of a set (-1: of all). */
se3d_status se3di_tagged_write(const se3d_model *model, se3di_iopool *pool, int32_t set,
                               se3di_csv *csv);

#endif
