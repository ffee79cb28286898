/* SPDX-License-Identifier: BSD-3-Clause */
/* What a snapshot holds, for snapshot.c and snapshot_bytes.c. */
#ifndef SE3DI_SYSTEM_SNAPSHOT_H
#define SE3DI_SYSTEM_SNAPSHOT_H

#include "model/saved.h"
#include "particles/chain.h"
#include "se3d/system.h"

/* The list of pairs of shapes that may touch, as in se3di_body_contacts; empty: none was made. */
typedef struct se3di_snapshot_near {
    se3di_saved_array pairs;     /* uint32_t [2 * pairs] */
    se3di_saved_array reference; /* double [3 * shapes] */
    se3di_saved_array order;     /* uint32_t [shapes] */
    double margin;
} se3di_snapshot_near;

struct se3d_snapshot {
    se3d_allocator allocator;
    uint64_t topology_version;
    uint64_t inputs_version, values_version; /* of the model, then */
    uint64_t structure;                      /* of the model: se3di_snapshot_structure */
    se3di_saved state;
    se3di_snapshot_near near;
    se3di_particles *sets; /* copies of the particle sets */
};

/* A hash of what elements there are, of which type and between which bodies, in their order. */
uint64_t se3di_snapshot_structure(const se3di_model *model);

#endif
