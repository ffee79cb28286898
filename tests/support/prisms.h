/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed meshes with hollows, for tests of contact: prisms whose profiles boxes make up. */
#ifndef SE3D_TESTS_PRISMS_H
#define SE3D_TESTS_PRISMS_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define PRISM_MOST  16
#define PRISM_BOXES 4

/* A profile in the x-z plane, counter-clockwise seen from -y, and boxes that make it up; it is as
 * thick as it says along y, from -half to half. The second half of a frame's corners is its hole.
 */
typedef struct prism {
    const char *name;
    size_t corners;
    double at[PRISM_MOST][2];
    size_t pieces;                /* 0: convex */
    double boxes[PRISM_BOXES][4]; /* low x, low z, high x, high z */
} prism;

enum { L, T, U, CROSS, STAIRS, FRAME, BLOCK, PRISMS };
static const prism prisms[PRISMS] = {
    {"L", 6, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 2, {{0, 0, 2, 1}, {0, 0, 1, 3}}},
    {"T",
     8,
     {{1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}, {0, 2}, {1, 2}},
     2,
     {{1, 0, 2, 3}, {0, 2, 3, 3}}},
    {"U",
     8,
     {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
     3,
     {{0, 0, 3, 1}, {0, 0, 1, 2}, {2, 0, 3, 2}}},
    {"cross",
     12,
     {{1, 0},
      {2, 0},
      {2, 1},
      {3, 1},
      {3, 2},
      {2, 2},
      {2, 3},
      {1, 3},
      {1, 2},
      {0, 2},
      {0, 1},
      {1, 1}},
     2,
     {{1, 0, 2, 3}, {0, 1, 3, 2}}},
    {"stairs",
     8,
     {{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 3}, {0, 3}},
     3,
     {{0, 0, 3, 1}, {0, 0, 2, 2}, {0, 0, 1, 3}}},
    {"frame",
     8,
     {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {3, 1}, {3, 3}, {1, 3}},
     4,
     {{0, 0, 4, 1}, {0, 3, 4, 4}, {0, 0, 1, 4}, {3, 0, 4, 4}}},
    {"block", 4, {{0, 0}, {3, 0}, {3, 1}, {0, 1}}, 0, {{0, 0, 3, 1}}}};

typedef struct prism_mesh {
    double points[6 * PRISM_MOST];
    uint32_t faces[12 * PRISM_MOST];
    size_t point_count, face_count;
} prism_mesh;

static inline double prism_turn(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Ears of the profile, cut off one after the other. */
static inline void prism_fill(const prism *p, prism_mesh *t)
{
    uint32_t left[PRISM_MOST];
    size_t count = p->corners;
    for (uint32_t k = 0; k < count; ++k) {
        left[k] = k;
    }
    while (count > 2) {
        for (size_t k = 0; k < count; ++k) {
            const uint32_t a = left[(k + count - 1) % count], b = left[k],
                           c = left[(k + 1) % count];
            int is_ear = prism_turn(p->at[a], p->at[b], p->at[c]) > 0.0;
            for (size_t o = 0; o < count && is_ear; ++o) {
                const double *x = p->at[left[o]];
                is_ear = left[o] == a || left[o] == b || left[o] == c ||
                         prism_turn(p->at[a], p->at[b], x) < 0.0 ||
                         prism_turn(p->at[b], p->at[c], x) < 0.0 ||
                         prism_turn(p->at[c], p->at[a], x) < 0.0;
            }
            if (is_ear) {
                const uint32_t n = (uint32_t)p->corners;
                const uint32_t ends[6] = {a, b, c, c + n, b + n, a + n};
                memcpy(t->faces + 3 * t->face_count, ends, sizeof ends);
                t->face_count += 2;
                memmove(&left[k], &left[k + 1], (count - k - 1) * sizeof *left);
                --count;
                break;
            }
        }
    }
}

/* The same of a frame, between its profile and its hole. */
static inline void prism_fill_frame(const prism *p, prism_mesh *t)
{
    const uint32_t half = (uint32_t)p->corners / 2, n = (uint32_t)p->corners;
    for (uint32_t k = 0; k < half; ++k) {
        const uint32_t b = (k + 1) % half;
        const uint32_t ends[12] = {k,        b,        b + half,     k,
                                   b + half, k + half, k + n,        b + half + n,
                                   b + n,    k + n,    k + half + n, b + half + n};
        memcpy(t->faces + 3 * t->face_count, ends, sizeof ends);
        t->face_count += 4;
    }
}

/* Between corners a and b of the profile, the body on the left. */
static inline void prism_side(uint32_t a, uint32_t b, uint32_t n, prism_mesh *t)
{
    const uint32_t sides[6] = {a, a + n, b, b, a + n, b + n};
    memcpy(t->faces + 3 * t->face_count, sides, sizeof sides);
    t->face_count += 2;
}

/* Scaled, about its reference corner moved to -`shift`. `turned`: clockwise seen from outside. */
static inline prism_mesh prism_make(const prism *p, double scale, double half,
                                    const double shift[2], int turned)
{
    const int is_frame = p == &prisms[FRAME];
    const uint32_t n = (uint32_t)p->corners, outer = is_frame ? n / 2 : n;
    prism_mesh t = {.point_count = 2 * p->corners};
    for (uint32_t k = 0; k < 2 * n; ++k) {
        t.points[3 * k] = scale * p->at[k % n][0] - shift[0];
        t.points[3 * k + 1] = k < n ? -half : half;
        t.points[3 * k + 2] = scale * p->at[k % n][1] - shift[1];
    }
    if (is_frame) {
        prism_fill_frame(p, &t);
    } else {
        prism_fill(p, &t);
    }
    for (uint32_t k = 0; k < outer; ++k) {
        prism_side(k, (k + 1) % outer, n, &t);
        if (is_frame) {
            prism_side(outer + (k + 1) % outer, outer + k, n, &t);
        }
    }
    for (size_t k = 0; k < t.face_count && turned; ++k) {
        const uint32_t a = t.faces[3 * k];
        t.faces[3 * k] = t.faces[3 * k + 1];
        t.faces[3 * k + 1] = a;
    }
    return t;
}

#endif
