/* SPDX-License-Identifier: BSD-3-Clause */
/* Flows of particles through planes, disks and rectangles: what has passed, and how fast it does.
 *
 * Threads: the rule of se3d/se3d.h; what needs a set for itself needs its system, too. */
#ifndef SE3D_FLOW_H
#define SE3D_FLOW_H

#include "se3d/particles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Flows of a set at most. @since 0.1 */
#define SE3D_PARTICLES_FLOWS 32

/* The definition of a flow: a plane, or a disk or rectangle in it, at rest. A particle passes when
 * its centre comes from behind the plane to its front (or back) in a step, where the straight line
 * between the two meets it; a clump is one particle, at its centre of mass. Sources, sinks, edits
 * and the jump from one side of a period to the other do not count. In a period, a particle counts
 * at its image nearest to the point: a flow may be at the border, or reach across it. @since 0.1 */
typedef struct se3d_flow_def {
    size_t struct_size;
    double point[3];  /* of the plane, the centre of disk and rectangle, ground frame [m] */
    double normal[3]; /* direction that counts forward, ground frame; not zero */
    double radius;    /* of a disk [m] >= 0; 0: none */
    double size[2];   /* of a rectangle, along `along` and normal x along [m] >= 0; 0: none */
    double along[3];  /* direction of size[0], ground frame; what is along the normal is left out */
    double window;    /* over which rates are taken [s] > 0; default 0.1 */
    int32_t tag;      /* of the particles that count; default -1: all */
    int32_t reserved;
} se3d_flow_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_flow_def_default. @since 0.1 */
SE3D_API void se3d_flow_def_init(se3d_flow_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_flow_def se3d_flow_def_default(void)
{
    se3d_flow_def def;
    se3d_flow_def_init(&def, sizeof def);
    return def;
}

/* Add a flow: it counts from now on.
 * @param[out] flow  its number, from 0; NULL: not wanted
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_particles_add_flow(se3d_particles *particles, const se3d_flow_def *def,
                                             uint32_t *flow);

/* What has passed. Sums count what passes back as negative. Rates are means over the last whole
 * window; before the first one, since the flow was added. @since 0.1 */
typedef struct se3d_flow_stats {
    uint64_t forward;        /* particles that passed along the normal, */
    uint64_t backward;       /* and against it */
    double mass;             /* net [kg] */
    double momentum[3];      /* net, ground frame [kg m/s] */
    double count_rate;       /* net [1/s] */
    double mass_rate;        /* net [kg/s] */
    double momentum_rate[3]; /* net, ground frame [N] */
} se3d_flow_stats;

/* As se3d_particles_get_flow, told the size of *stats in bytes. @return as se3d_particles_get_flow,
 * and INVALID_ARGUMENT (size). @since 0.1 */
SE3D_API se3d_status se3d_particles_get_flow_sized(const se3d_particles *particles, uint32_t flow,
                                                   se3d_flow_stats *stats, size_t size);

/* Get what has passed through a flow.
 * @param[in] flow  its number
 * @return OK, NULL, INVALID_ARGUMENT (no such flow).
 * @since 0.1 */
static inline se3d_status se3d_particles_get_flow(const se3d_particles *particles, uint32_t flow,
                                                  se3d_flow_stats *stats)
{
    return se3d_particles_get_flow_sized(particles, flow, stats, sizeof *stats);
}

#ifdef __cplusplus
}
#endif
#endif
