/* SPDX-License-Identifier: BSD-3-Clause */
/* `particles` of a model: the set, and how it goes along with the analyses. */
#ifndef SE3D_IO_GRAINS_H
#define SE3D_IO_GRAINS_H

#include "io/reader.h"

/* All particles of a model are one set, so that they touch each other; what the file calls a set is
 * a tag in it: sets[0] are those without a name. */
struct se3di_grains {
    se3d_particles *set;
    bool moving_walls; /* some shape is on a body that is not fixed */
    const char *sets[SE3D_PARTICLES_TAGS];
    size_t set_count;
    uint32_t *source_tags; /* of the sources */
    size_t source_count, source_capacity;
    const char **sinks;
    size_t sink_count;
};

enum { SE3DI_GRAIN_COLUMNS = 12 };

/* Particles as they are, in ascending order of the ids. */
typedef struct se3di_grain_rows {
    double *rows; /* [count * SE3DI_GRAIN_COLUMNS] */
    uint32_t *tags;
    const char **materials; /* names */
    size_t count;
} se3di_grain_rows;

/* Bring the particles of a model to `time` with `solver`, which is made from `def` and
 * moves the bodies, in dynamics the particles too; otherwise walls
 * that move are followed at every step of the particles. Ends before where an event
 * stops the bodies. @return as
 * se3d_solver_run and se3d_particles_run. */
se3d_status se3di_grains_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time);
/* Names of the columns of a snapshot; after the numbers the material. */
const char *se3di_grains_get_column(size_t k);
/* Copy all particles. */
se3d_status se3di_grains_get_rows(const se3d_model *model, se3di_iopool *pool,
                                  se3di_grain_rows *rows);
struct se3di_csv;
/* Write a row for each particle of a set (-1: of all). */
se3d_status se3di_grains_write(const se3d_model *model, se3di_iopool *pool, int32_t set,
                               struct se3di_csv *csv);
/* The particles of a file: x, y, z, radius and more, see docs/model-file/reference.md. */
bool se3di_read_grain_table(se3di_reader *reader, const se3di_node *node, se3d_material material,
                            uint32_t tag);
/* What became of the particles of every name, for the summary of a run. @return OK, NO_MEMORY. */
se3d_status se3di_grains_sum_up(const se3di_grains *grains, se3di_iopool *pool,
                                se3d_run_particles **out, size_t *count);
/* The index of a name, SIZE_MAX: none. */
size_t se3di_grains_find_set(const se3di_grains *grains, const char *name);
size_t se3di_grains_find_sink(const se3di_grains *grains, const char *name);
/* Quantities of a set or of a sink. */
se3d_status se3di_grains_eval(const se3di_channel *channel, double *value);

#endif
