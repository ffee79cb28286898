/* SPDX-License-Identifier: BSD-3-Clause */
/* KKT solver on chains: nanoseconds per link for factor and solve, minimum of several runs. */
#define _POSIX_C_SOURCE 200112L /* clock_gettime */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "linsol/kkt.h"
#include "linsol/kkt_lanes.h"

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static uint64_t seed = 88172645463325252;

static double uniform(void)
{
    seed ^= seed >> 12;
    seed ^= seed << 25;
    seed ^= seed >> 27;
    return (double)((seed * UINT64_C(2685821657736338717)) >> 11) * 0x1p-52 - 1.0;
}

typedef struct chain {
    se3di_kkt_pattern pattern;
    int32_t *rows, *begin, *body_of;
    double *body, *joint, *b, *c, *x, *l;
    se3di_kkt_values values;
} chain;

static void *take(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (!memory) {
        exit(1);
    }
    return memory;
}

/* Bodies in a row, each with a joint of `rows` equations to the one before it. */
static void chain_init(chain *s, int32_t links, int32_t rows, int32_t n, bool mass, bool symmetric)
{
    size_t count = (size_t)links, entries = 2 * count - 1, size = (size_t)n;
    *s = (chain){.rows = take(count, sizeof(int32_t)),
                 .begin = take(count + 1, sizeof(int32_t)),
                 .body_of = take(2 * count, sizeof(int32_t)),
                 .body = take(count * 64, sizeof(double)),
                 .joint = take(entries * (size_t)rows * size, sizeof(double)),
                 .b = take(count * size, sizeof(double)),
                 .c = take(count * (size_t)rows, sizeof(double)),
                 .x = take(count * size, sizeof(double)),
                 .l = take(count * (size_t)rows, sizeof(double))};
    int32_t end = 0;
    for (int32_t i = 0; i < links; ++i) {
        s->rows[i] = rows;
        if (i > 0) {
            s->body_of[end++] = i - 1;
        }
        s->body_of[end++] = i;
        s->begin[i + 1] = end;
        double *H = s->body + n * n * i;
        for (int32_t r = 0; r < (n == 8 ? 7 : n); ++r) {
            H[r * (n + 1)] = mass && r < 3 ? 1.0 : 1.0 + 0.2 * r;
        }
        if (n == 8) {
            H[3 * 8 + 7] = H[7 * 8 + 3] = 1.0;
        }
    }
    for (size_t i = 0; i < entries * (size_t)rows * size; ++i) {
        size_t c = i % size, r = i / size % (size_t)rows;
        size_t free = n == 8 && r >= 3 ? r + 1 : r; /* r-p: not along p */
        s->joint[i] = c == 7 ? 0.0 : 0.3 * uniform() + (c == free);
    }
    for (size_t i = 0; i < count * size; ++i) {
        s->b[i] = uniform();
    }
    s->pattern = (se3di_kkt_pattern){.body_count = count,
                                     .joint_count = count,
                                     .joint_rows = s->rows,
                                     .joint_begin = s->begin,
                                     .joint_body = s->body_of,
                                     .body_size = n,
                                     .symmetric = symmetric,
                                     .body_kind = mass ? SE3DI_KKT_BODY_MASS : SE3DI_KKT_BODY_FULL};
    s->values = (se3di_kkt_values){.body = s->body, .joint = s->joint, .joint_b = s->joint};
}

static void chain_free(chain *s)
{
    free(s->rows);
    free(s->begin);
    free(s->body_of);
    free(s->body);
    free(s->joint);
    free(s->b);
    free(s->c);
    free(s->x);
    free(s->l);
}

static void measure(const char *name, int32_t links, int32_t rows, int32_t n, bool mass,
                    bool symmetric, se3di_kkt_level level)
{
    chain s;
    chain_init(&s, links, rows, n, mass, symmetric);
    s.pattern.level = level;
    se3d_allocator allocator = se3di_alloc_default();
    se3di_kkt *kkt;
    if (SE3D_FAILED(se3di_kkt_create(&allocator, &s.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt))) {
        exit(1);
    }
    double best[2] = {1e300, 1e300};
    se3di_kkt_solve_info info = {0};
    int repeat = 4096 / links + 1;
    for (int run = 0; run < 15; ++run) {
        double start = now_ns();
        for (int k = 0; k < repeat; ++k) {
            se3di_kkt_factor(kkt, &s.values, NULL);
        }
        double middle = now_ns();
        for (int k = 0; k < repeat; ++k) {
            se3di_kkt_solve(kkt, &s.values, s.b, s.c, s.x, s.l, &info);
        }
        double times[2] = {middle - start, now_ns() - middle};
        for (int k = 0; k < 2; ++k) {
            double each = times[k] / repeat / links;
            best[k] = each < best[k] ? each : best[k];
        }
    }
    printf("%-22s %5d links: factor %6.1f  solve %6.1f  both %6.1f ns/link (refinements %d)\n",
           name, (int)links, best[0], best[1], best[0] + best[1], (int)info.refinements);
    se3di_kkt_destroy(kkt);
    chain_free(&s);
}

/* The same numbers of `width` states, each a little other than the one before. */
static double *spread(const double *from, size_t count, int32_t width)
{
    const size_t w = (size_t)width;
    double *to = aligned_alloc(64, (count * w * sizeof *to + 64) / 64 * 64);
    if (!to) {
        exit(1);
    }
    for (size_t i = 0; i < count * w; ++i) {
        to[i] = from[i / w] * (1.0 + 0.01 * (double)(i % w));
    }
    return to;
}

/* Factor and solve of as many states at once as fit, nanoseconds per link and state. */
static void measure_lanes(const char *name, int32_t links, int32_t rows, bool mass, int32_t width)
{
    chain s;
    chain_init(&s, links, rows, 6, mass, true);
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_kkt *kkt;
    se3di_kkt_lanes *lanes;
    if (SE3D_FAILED(se3di_kkt_create(&allocator, &s.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt)) ||
        SE3D_FAILED(se3di_kkt_lanes_create(&allocator, kkt, width, &lanes))) {
        exit(1);
    }
    const size_t count = (size_t)links, m = (size_t)rows;
    double *wide[] = {
        spread(s.body, count * 36, width), spread(s.joint, (2 * count - 1) * m * 6, width),
        spread(s.b, count * 6, width),     spread(s.c, count * m, width),
        spread(s.x, count * 6, width),     spread(s.l, count * m, width)};
    const se3di_kkt_values values = {.body = wide[0], .joint = wide[1]};
    se3di_kkt_lanes_info info;
    double best = 1e300;
    const int repeat = 4096 / links / width + 1;
    for (int run = 0; run < 25; ++run) {
        const double start = now_ns();
        for (int k = 0; k < repeat; ++k) {
            se3di_kkt_lanes_solve(lanes, &values, wide[2], wide[3], wide[4], wide[5], &info);
        }
        const double each = (now_ns() - start) / repeat / links / width;
        best = each < best ? each : best;
    }
    int alone = 0;
    for (int32_t k = 0; k < width; ++k) {
        alone += info.is_alone[k];
    }
    printf("%-22s %5d links: %d states at once, both %6.1f ns/link and state (%d alone)\n", name,
           (int)links, (int)width, best, alone);
    for (size_t k = 0; k < sizeof wide / sizeof *wide; ++k) {
        free(wide[k]);
    }
    se3di_kkt_lanes_destroy(lanes);
    se3di_kkt_destroy(kkt);
    chain_free(&s);
}

int main(void)
{
    const int32_t lengths[] = {1, 8, 64, 512};
    for (int k = 0; k < 4; ++k) {
        int32_t n = lengths[k];
        measure("mass, 5 rows", n, 5, 6, true, true, SE3DI_KKT_LEVEL_AUTO);
        measure("mass, 3 rows", n, 3, 6, true, true, SE3DI_KKT_LEVEL_AUTO);
        measure("full, 5 rows", n, 5, 6, false, true, SE3DI_KKT_LEVEL_AUTO);
        measure("full, 5 rows, avx2", n, 5, 6, false, true, SE3DI_KKT_LEVEL_AVX2);
        measure("full, 5 rows, portable", n, 5, 6, false, true, SE3DI_KKT_LEVEL_PORTABLE);
        measure("r-p, 5 rows", n, 5, 8, false, true, SE3DI_KKT_LEVEL_AUTO);
        measure("unsymmetric, 5 rows", n, 5, 6, false, false, SE3DI_KKT_LEVEL_AUTO);
        measure("unsymmetric r-p", n, 5, 8, false, false, SE3DI_KKT_LEVEL_AUTO);
        for (int32_t width = se3di_kkt_lanes_widest(); width >= 4; width /= 2) {
            measure_lanes("mass, 5 rows", n, 5, true, width);
            measure_lanes("full, 5 rows", n, 5, false, width);
        }
    }
    return 0;
}
