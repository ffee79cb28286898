/* SPDX-License-Identifier: BSD-3-Clause */
/* Which part of space is whose: recursive bisection by weights. */
#ifndef SE3DM_BOXES_H
#define SE3DM_BOXES_H

#include <stddef.h>
#include <stdint.h>

/* A point with what it costs. */
typedef struct boxes_point {
    double x[3], weight;
    uint32_t number;
    uint32_t reserved;
} boxes_point;

typedef struct boxes_cut {
    double at;
    int axis;      /* -1: a leaf, */
    int low, high; /* the cuts on both sides; of a leaf: low is the process */
} boxes_cut;

typedef struct boxes_box {
    double lower[3], upper[3];
} boxes_box;

typedef struct boxes {
    int count;
    int cut_count;
    boxes_cut *cuts;  /* [2 count - 1], the first is the root */
    boxes_box *box;   /* [count] */
    double period[3]; /* 0: none */
} boxes;

/* Memory for `count` boxes. @return 0: none */
int boxes_create(boxes *b, int count);
void boxes_destroy(boxes *b);
/* Divide `all` so that every process has about the same weight. The points are sorted on the way;
 * their order at first does not matter. */
void boxes_divide(boxes *b, const boxes_box *all, boxes_point *points, size_t count);
int boxes_find(const boxes *b, const double x[3]);
/* Least distances along the axes, over periods, squared and added up. */
double boxes_distance2(const boxes *b, const double lower[3], const double upper[3], int box);

#endif
