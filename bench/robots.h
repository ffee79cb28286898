/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees of revolutes for bench_query and peers/mujoco_query.c: an arm, a quadruped and a humanoid
 * with free bases. Links are listed along the branches, as both programs number them; at zero all
 * frames are parallel to the ground's. */
#ifndef BENCH_ROBOTS_H
#define BENCH_ROBOTS_H

#include "arm.h"

#include <string.h>

enum { BENCH_ROBOT_LINKS = 31, BENCH_ROBOT_STATE = BENCH_ROBOT_LINKS + 6 };

typedef struct bench_robot {
    const char *name;
    int count;                     /* links, a free base included */
    int is_free;                   /* the first one is */
    int parent[BENCH_ROBOT_LINKS]; /* -1: the ground */
    bench_link link[BENCH_ROBOT_LINKS];
} bench_robot;

static inline int bench_add_link(bench_robot *r, int parent, const double at[3], int axis,
                                 double length, double mass)
{
    bench_link *l = &r->link[r->count];
    *l = (bench_link){.mass = mass, .centre = {0.0, 0.0, -0.5 * length}};
    memcpy(l->at, at, sizeof l->at);
    l->axis[axis] = 1.0;
    for (int c = 0; c < 3; ++c) {
        l->inertia[c] = mass * ((c < 2 ? length * length : 0.0) + 0.01 * (1 + 0.1 * c)) / 12.0;
    }
    r->parent[r->count] = parent;
    return r->count++;
}

/* Links one under the other about the given axes (0, 1, 2), of equal lengths and masses. */
static inline int bench_add_limb(bench_robot *r, int parent, double x, double y, double z,
                                 const char *axes, double length, double mass)
{
    double at[3] = {x, y, z};
    for (; *axes; ++axes) {
        parent = bench_add_link(r, parent, at, *axes - '0', length, mass);
        at[0] = at[1] = 0.0;
        at[2] = -length;
    }
    return parent;
}

static inline void bench_add_base(bench_robot *r, double mass)
{
    r->is_free = 1;
    r->count = 1;
    r->parent[0] = -1;
    r->link[0] = (bench_link){.mass = mass, .inertia = {0.2, 0.5, 0.6}};
}

/* 0: an arm of 6; 1: a quadruped, 4 legs of 3; 2: a humanoid, 30 revolutes. */
static inline bench_robot bench_make_robot(int which)
{
    bench_robot r = {.name = which == 0 ? "arm" : which == 1 ? "quadruped" : "humanoid"};
    if (which == 0) {
        r.count = BENCH_ARM_LINKS;
        for (int k = 0; k < r.count; ++k) {
            r.parent[k] = k - 1;
            r.link[k] = bench_arm[k];
        }
        return r;
    }
    bench_add_base(&r, 10.0);
    for (int k = 0; which == 1 && k < 4; ++k) {
        (void)bench_add_limb(&r, 0, k < 2 ? 0.25 : -0.25, k % 2 ? 0.1 : -0.1, 0.0, "011", 0.25,
                             1.0);
    }
    for (int k = 0; which == 2 && k < 2; ++k) {
        (void)bench_add_limb(&r, 0, 0.0, k ? 0.1 : -0.1, 0.0, "201110", 0.2, 2.0);
    }
    if (which == 2) {
        const int chest = bench_add_limb(&r, 0, 0.0, 0.0, 0.2, "012", 0.1, 4.0);
        for (int k = 0; k < 2; ++k) {
            (void)bench_add_limb(&r, chest, 0.0, k ? 0.2 : -0.2, 0.2, "1021201", 0.15, 1.0);
        }
        (void)bench_add_limb(&r, chest, 0.0, 0.0, 0.4, "1", 0.1, 3.0);
    }
    return r;
}

#endif
