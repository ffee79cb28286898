/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of contacts: of particles with each other, with walls, and of bodies. */
#ifndef SE3D_IO_CONTACT_LIST_H
#define SE3D_IO_CONTACT_LIST_H

#include "io/channel/sample.h"
#include "io/model/model.h"
#include "io/write/csv.h"
#include "io/write/table_hdf5.h"

enum { SE3DI_CONTACT_COLUMNS = 15, SE3DI_CONTACT_NUMBERS = 12 };

typedef struct se3di_contact_rows {
    double *rows; /* [count * SE3DI_CONTACT_NUMBERS]: time, point, normal, overlap, normal force,
                     tangential force */
    const char **kinds, **a, **b;
    double *id_a, *id_b; /* if the names are NULL */
    size_t count;
} se3di_contact_rows;

/* Copy all contacts of the state of the sample. */
se3d_status se3di_contacts_get_rows(const se3d_model *model, se3di_sample *sample,
                                    se3di_iopool *pool, se3di_contact_rows *rows);
const char *se3di_contacts_get_column(size_t k);
/* Which of them are texts. */
se3di_table_columns se3di_contacts_get_kinds(void);
se3d_status se3di_contacts_write(const se3d_model *model, se3di_sample *sample, se3di_iopool *pool,
                                 se3di_csv *csv);

#endif
