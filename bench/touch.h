/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of boxes that touch, which bench_touch and peers/mujoco_touch.c run alike: boxes of one
 * density, a floor z = 0, gravity 9.81 m/s^2 in -z.
 *
 * heap: cubes of 10 cm in a grid with gaps, turned at random, fall; stack: cubes on each other;
 * dominoes: a row that the first one pushes over. */
#ifndef BENCH_TOUCH_H
#define BENCH_TOUCH_H

#include "clock.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define BENCH_TOUCH_DENSITY  1000.0
#define BENCH_TOUCH_FRICTION 0.5
#define BENCH_TOUCH_GRAVITY  9.81
#define BENCH_TOUCH_MOST     4096

typedef struct bench_box {
    double size[3]; /* [m] */
    double at[3];   /* [m] */
    double turn[4]; /* Euler parameters */
    double speed;   /* along x [m/s] */
} bench_box;

/* Uniform in -1 .. 1. */
static inline double bench_touch_random(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

static inline bench_box bench_touch_heap(int n, int k, uint64_t *seed)
{
    int side = 1;
    while (side * side * side < n) {
        ++side;
    }
    const int place[3] = {k % side, k / side % side, k / (side * side)};
    bench_box box = {.size = {0.1, 0.1, 0.1}, .turn = {1.0, 0.0, 0.0, 0.0}};
    double square = 1.0;
    for (int c = 0; c < 3; ++c) {
        box.at[c] = c < 2 ? 0.16 * (place[c] - 0.5 * (side - 1)) : 0.12 + 0.18 * place[c];
        box.at[c] += c < 2 ? 0.01 * bench_touch_random(seed) : 0.0;
        box.turn[c + 1] = 0.3 * bench_touch_random(seed);
        square += box.turn[c + 1] * box.turn[c + 1];
    }
    for (int c = 0; c < 4; ++c) {
        box.turn[c] /= sqrt(square);
    }
    return box;
}

/* Fill boxes[n]; returns 0 if there is no such scene. */
static inline int bench_touch_make(const char *scene, int n, bench_box *boxes)
{
    uint64_t seed = 1;
    for (int k = 0; k < n; ++k) {
        if (strcmp(scene, "heap") == 0) {
            boxes[k] = bench_touch_heap(n, k, &seed);
        } else if (strcmp(scene, "stack") == 0) {
            boxes[k] = (bench_box){.size = {0.1, 0.1, 0.1},
                                   .at = {0.0, 0.0, 0.05 + 0.1 * k},
                                   .turn = {1.0, 0.0, 0.0, 0.0}};
        } else if (strcmp(scene, "dominoes") == 0) {
            boxes[k] = (bench_box){
                .size = {0.02, 0.1, 0.2}, .at = {0.1 * k, 0.0, 0.1}, .turn = {1.0, 0.0, 0.0, 0.0}};
            if (k == 0) { /* it leans on the edge at x = .01 by .25 rad */
                boxes[k].at[0] = 0.01 - 0.01 * cos(0.25) + 0.1 * sin(0.25);
                boxes[k].at[2] = 0.01 * sin(0.25) + 0.1 * cos(0.25);
                boxes[k].turn[0] = cos(0.125);
                boxes[k].turn[2] = sin(0.125);
            }
        } else {
            return 0;
        }
    }
    return 1;
}

#endif
