/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of boxes that touch, which bench_touch and peers/mujoco_touch.c run alike: boxes of one
 * density, a floor z = 0, gravity 9.81 m/s^2 in -z.
 *
 * heap: cubes of 10 cm in a grid with gaps, turned at random, fall; stack: cubes on each other;
 * dominoes: a row that the first one pushes over; pyramid: cubes in rows that become shorter, n all
 * together; wall: bricks in six layers and, last, a ball of 4 kg that hits it at 6 m/s; cards: a
 * house of three storeys, six pairs that lean on each other at 20 degrees and three that lie on
 * them. */
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
    double ball;    /* radius of a ball in place of the box [m] */
} bench_box;

static inline double bench_touch_mass(const bench_box *box)
{
    const double *s = box->size, r = box->ball, pi = 3.14159265358979323846;
    return BENCH_TOUCH_DENSITY * (r > 0.0 ? 4.0 / 3.0 * pi * r * r * r : s[0] * s[1] * s[2]);
}

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

/* Box k of rows of `first`, first - 1, ... cubes with gaps of 5 mm. */
static inline bench_box bench_touch_pyramid(int first, int k)
{
    int row = 0;
    while (k >= first - row) {
        k -= first - row++;
    }
    return (bench_box){.size = {0.1, 0.1, 0.1},
                       .at = {0.105 * (k + 0.5 * row), 0.0, 0.05 + 0.1 * row},
                       .turn = {1.0, 0.0, 0.0, 0.0}};
}

/* Brick k of n - 1, or the ball. */
static inline bench_box bench_touch_wall(int n, int k)
{
    const int side = (n + 4) / 6, row = k / side;
    bench_box box = {.size = {0.1, 0.2, 0.1},
                     .at = {0.0, 0.2 * (k % side) + 0.05 * (row % 2), 0.05 + 0.1 * row},
                     .turn = {1.0, 0.0, 0.0, 0.0}};
    if (k == n - 1) {
        box = (bench_box){.at = {-0.5, 0.1 * side, 0.35},
                          .turn = {1.0, 0.0, 0.0, 0.0},
                          .speed = 6.0,
                          .ball = 0.0984745021843};
    }
    return box;
}

/* A card of a storey: `place` counts them from the middle, `lean` is 0 for one that lies. */
static inline bench_box bench_touch_card(int storey, double place, double lean)
{
    const double length = 0.1, thick = 0.002, angle = 0.349, s = sin(angle), c = cos(angle);
    const double high = length * c + thick * s + thick,
                 apart = 2.0 * (length * s + thick * c) + 0.01;
    bench_box box = {.size = {thick, 0.15, length},
                     .at = {apart * place, 0.0, storey * high},
                     .turn = {cos(0.5 * angle), 0.0, sin(0.5 * lean * angle), 0.0}};
    if (lean == 0.0) {
        box.size[0] = 0.081;
        box.size[2] = thick;
        box.at[2] += high - 0.5 * thick;
        box.turn[0] = 1.0;
    } else { /* its upper edge is on that of the other one */
        box.at[0] -= lean * 0.5 * (length * s + thick * c);
        box.at[2] += 0.5 * (length * c + thick * s);
    }
    return box;
}

static inline void bench_touch_cards(bench_box *boxes)
{
    for (int storey = 0; storey < 3; ++storey) {
        for (int k = 0; k < 3 - storey; ++k) {
            const double place = k + 0.5 * storey;
            *boxes++ = bench_touch_card(storey, place, 1.0);
            *boxes++ = bench_touch_card(storey, place, -1.0);
            if (k > 0) {
                *boxes++ = bench_touch_card(storey, place - 0.5, 0.0);
            }
        }
    }
}

/* Fill boxes[n]; returns 0 if there is no such scene. */
static inline int bench_touch_make(const char *scene, int n, bench_box *boxes)
{
    uint64_t seed = 1;
    int first = 1;
    while (first * (first + 1) / 2 < n) {
        ++first;
    }
    if (strcmp(scene, "cards") == 0) {
        bench_touch_cards(boxes);
        return n == 15;
    }
    for (int k = 0; k < n; ++k) {
        if (strcmp(scene, "heap") == 0) {
            boxes[k] = bench_touch_heap(n, k, &seed);
        } else if (strcmp(scene, "pyramid") == 0) {
            boxes[k] = bench_touch_pyramid(first, k);
        } else if (strcmp(scene, "wall") == 0) {
            boxes[k] = bench_touch_wall(n, k);
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
