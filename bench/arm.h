/* SPDX-License-Identifier: BSD-3-Clause */
/* The arm of bench_batch and peers/mujoco_batch.c: six revolutes, the size and masses of a robot
 * of 18 kg with a reach of .9 m; at zero all frames are parallel to the ground's. */
#ifndef BENCH_ARM_H
#define BENCH_ARM_H

typedef struct bench_link {
    double at[3];   /* joint, from the joint before [m] */
    double axis[3]; /* of the joint */
    double mass;
    double centre[3];  /* of mass, from the joint */
    double inertia[3]; /* about it, principal */
} bench_link;

enum { BENCH_ARM_LINKS = 6 };

static const bench_link bench_arm[BENCH_ARM_LINKS] = {
    {{0, 0, .0892}, {0, 0, 1}, 3.7, {0, 0, 0}, {.0103, .0103, .0067}},
    {{0, .1358, 0}, {0, 1, 0}, 8.393, {.28, 0, 0}, {.0151, .2269, .2269}},
    {{.425, -.1197, 0}, {0, 1, 0}, 2.275, {.25, 0, 0}, {.0041, .0494, .0494}},
    {{.3923, 0, 0}, {0, 1, 0}, 1.219, {0, .093, 0}, {.1112, .1112, .2194}},
    {{0, .093, 0}, {0, 0, 1}, 1.219, {0, 0, .0946}, {.1112, .1112, .2194}},
    {{0, 0, .0946}, {0, 1, 0}, .1879, {0, .0823, 0}, {.0171, .0338, .0171}},
};

/* An effort [N m] that changes from step to step. */
static inline double bench_effort(unsigned long *seed)
{
    *seed = *seed * 6364136223846793005ul + 1442695040888963407ul;
    return (double)(*seed >> 40) * 0x1p-23 - 1.0;
}

#define BENCH_ARM_STEP 1e-3 /* [s] */

#endif
