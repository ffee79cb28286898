/* SPDX-License-Identifier: BSD-3-Clause */
/* The file `se3d.txt` among the resources of a mock-up unit: which of them is the model, and with
 * which options it is read. Lines of a word and the rest. */
#ifndef SE3D_IO_FMI_RECIPE_H
#define SE3D_IO_FMI_RECIPE_H

#include "io/base/pool.h"
#include "se3d/io.h"

#define SE3DI_FMI_RECIPE_FILE "se3d.txt"

typedef struct se3di_fmi_recipe {
    const char *model; /* relative to the resources */
    se3d_model_options options;
} se3di_fmi_recipe;

/* The text of the file, in memory of the pool. @return NULL: no memory. */
char *se3di_fmi_recipe_write(const se3di_fmi_recipe *recipe, se3di_iopool *pool);
/* Read it; texts point into `text`, which is changed. @return false: malformed, or no memory. */
bool se3di_fmi_recipe_read(se3di_fmi_recipe *recipe, char *text, se3di_iopool *pool);

#endif
