/* SPDX-License-Identifier: BSD-3-Clause */
/* `particles` of a model. */
#ifndef SE3D_IO_PARTICLES_H
#define SE3D_IO_PARTICLES_H

#include <stdbool.h>

#include "se3d/particles.h"

/* A box whose particles are averaged over. */
typedef struct se3di_region_entry {
    const char *name;
    double lower[3], upper[3];
    int32_t tag; /* of the set that counts; -1: all */
} se3di_region_entry;

/* All particles of a model are one set, so that they touch each other; what the file calls a set is
 * a tag in it: sets[0] are those without a name. */
typedef struct se3di_tagged {
    se3d_particles *set;
    bool moving_walls; /* some shape is on a body that is not fixed */
    const char *sets[SE3D_PARTICLES_TAGS];
    size_t set_count;
    uint32_t *source_tags; /* of the sources */
    size_t source_count, source_capacity;
    const char **sinks;
    size_t sink_count;
    se3di_region_entry *regions;
    size_t region_count;
    const char **flows;
    size_t flow_count;
    const char **servos;
    size_t servo_count;
    const char **bonds; /* names of the groups */
    size_t bond_count;
    bool cell;           /* the domain strains */
    bool audit;          /* where energy goes is told */
    const char **clumps; /* names of the templates of clumps */
    size_t clump_count;
    struct se3di_clump_entry *clump_entries; /* [clump_count], see read/particle_clumps.h */
    double period[3];                        /* of the axes; 0: none */
} se3di_tagged;

/* X(NAME, number, member): what has names, whose number is member_count. Those before clumps are
 * asked for as channels: no two of them share a name. */
#define SE3DI_TAGGED_LIST(X)                                                                       \
    X(SET, 0, set)                                                                                 \
    X(SINK, 1, sink)                                                                               \
    X(REGION, 2, region)                                                                           \
    X(FLOW, 3, flow)                                                                               \
    X(SERVO, 4, servo)                                                                             \
    X(BOND, 5, bond)                                                                               \
    X(CLUMP, 6, clump)

typedef enum se3di_tagged_kind {
#define SE3DI_TAGGED(NAME, number, member) SE3DI_TAGGED_##NAME = number,
    SE3DI_TAGGED_LIST(SE3DI_TAGGED)
#undef SE3DI_TAGGED
} se3di_tagged_kind;

/* The index of a name, SIZE_MAX: none. `particles` NULL: there are none. */
size_t se3di_tagged_find(const se3di_tagged *particles, se3di_tagged_kind kind, const char *name);

#endif
