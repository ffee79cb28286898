/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a model that was read depends on some of its parameters, and must be read again for other
 * values of them. */
#ifndef SE3D_IO_STUDY_DEPENDENCE_H
#define SE3D_IO_STUDY_DEPENDENCE_H

#include "io/base/pool.h"
#include "io/document/reader.h"
#include "io/model/model.h"

/* A parameter or point of a part that depends on the varied ones. */
typedef struct se3di_renewal {
    const se3di_node *node;  /* its own entry */
    const se3di_node *given; /* what the caller gives for it; NULL: nothing */
    size_t value;            /* number of the varied parameter that it is, SIZE_MAX: it is none */
    bool is_point;
} se3di_renewal;

typedef struct se3di_dependent_part {
    se3di_component *part;
    const struct se3di_dependent_part *parent; /* NULL: the model */
    se3di_renewal *renewals;                   /* each after those that it is made of */
    size_t renewal_count;
    const char **names; /* [renewal_count] */
    se3di_again again;  /* entries of its lists */
} se3di_dependent_part;

typedef struct se3di_dependence {
    se3di_dependent_part *parts; /* [part_count], in the order of the model */
    se3di_again *again;          /* [part_count] of them */
    size_t part_count;
    bool has_wheels;
} se3di_dependence;

/* Find what depends on `names`, `count` parameters of the model, which has been read for a sample
 * of a study.
 * @param[out] is_all  whether reading these entries again is enough; false: the model is to be read
 * @return OK, NO_MEMORY */
se3d_status se3di_dependence_find(const se3d_model *model, const char *const *names, size_t count,
                                  se3di_iopool *pool, se3di_dependence *dependence, bool *is_all);

#endif
