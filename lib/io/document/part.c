/* SPDX-License-Identifier: BSD-3-Clause */
/* The places of parts. Reflections change signs only, so that a mirrored part has the bits of one
 * that is written out. */
#include "io/document/part.h"

#include <string.h>

#include "io/base/rotation.h"

se3di_placement se3di_placement_none(void)
{
    const se3di_placement none = {
        false, false, -1, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};
    return none;
}

bool se3di_component_is_mirrored(const se3di_component *part)
{
    while (part && part->place.mirror < 0) {
        part = part->parent;
    }
    return part != NULL;
}

bool se3di_placement_is_reflected(const se3di_placement *p)
{
    const double *M = p->M;
    return M[0] * (M[4] * M[8] - M[5] * M[7]) - M[1] * (M[3] * M[8] - M[5] * M[6]) +
               M[2] * (M[3] * M[7] - M[4] * M[6]) <
           0.0;
}

/* a * b, exact if a is 0, 1 or -1, and never -0. */
static double times(double a, double b)
{
    return a == 1.0 ? b : a == -1.0 ? 0.0 - b : a == 0.0 ? 0.0 : a * b;
}

static void apply(const double M[9], double v[3])
{
    const double u[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; ++i) {
        v[i] = times(M[3 * i], u[0]) + times(M[3 * i + 1], u[1]) + times(M[3 * i + 2], u[2]);
    }
}

se3di_placement se3di_placement_join(const se3di_placement *outer, const se3di_placement *inner)
{
    se3di_placement p = *inner;
    se3di_place_point(outer, p.r);
    for (int j = 0; j < 3; ++j) {
        double column[3] = {inner->M[j], inner->M[3 + j], inner->M[6 + j]};
        se3di_place_vector(outer, column);
        for (int i = 0; i < 3; ++i) {
            p.M[3 * i + j] = column[i];
        }
    }
    p.moves = outer->moves || inner->moves;
    p.turns = outer->turns || inner->turns;
    if (outer->mirror >= 0) {
        p.mirror = inner->mirror >= 0 ? -1 : outer->mirror;
    }
    return p;
}

void se3di_place_vector(const se3di_placement *p, double v[3])
{
    if (p->turns) {
        apply(p->M, v);
    }
}

void se3di_place_point(const se3di_placement *p, double v[3])
{
    se3di_place_vector(p, v);
    for (int k = 0; p->moves && k < 3; ++k) {
        v[k] += p->r[k];
    }
}

static void turn_round(double v[3])
{
    for (int k = 0; k < 3; ++k) {
        v[k] = 0.0 - v[k];
    }
}

void se3di_place_axial(const se3di_placement *p, double v[3])
{
    se3di_place_vector(p, v);
    if (p->mirror >= 0) {
        turn_round(v);
    }
}

/* D A D: the axis of the rotation is turned round but for its component along the mirrored axis. */
static void reflect(int axis, double e[4])
{
    for (int k = 0; k < 3; ++k) {
        if (k != axis) {
            e[k + 1] = 0.0 - e[k + 1];
        }
    }
}

/* Whether M is the reflection D alone. */
static bool is_reflection(const se3di_placement *p)
{
    for (int k = 0; k < 9; ++k) {
        const double wanted = k % 4 != 0 ? 0.0 : k / 4 == p->mirror ? -1.0 : 1.0;
        if (p->M[k] < wanted || p->M[k] > wanted) {
            return false;
        }
    }
    return p->mirror >= 0;
}

void se3di_place_orientation(const se3di_placement *p, double e[4])
{
    double A[9];
    double product[9];
    if (!p->turns) {
        return;
    }
    if (is_reflection(p)) {
        reflect(p->mirror, e);
        return;
    }
    se3di_rotation_to_matrix(e, A);
    for (int j = 0; j < 3; ++j) {
        double column[3] = {A[j], A[3 + j], A[6 + j]};
        apply(p->M, column);
        if (j == p->mirror) {
            turn_round(column);
        }
        for (int i = 0; i < 3; ++i) {
            product[3 * i + j] = column[i];
        }
    }
    se3di_rotation_from_matrix(product, e);
}

void se3di_flip_vector(const se3di_placement *p, double v[3])
{
    if (p->mirror >= 0) {
        v[p->mirror] = 0.0 - v[p->mirror];
    }
}

void se3di_flip_axial(const se3di_placement *p, double v[3])
{
    if (p->mirror >= 0) {
        se3di_flip_vector(p, v);
        turn_round(v);
    }
}

void se3di_flip_orientation(const se3di_placement *p, double e[4])
{
    if (p->mirror >= 0) {
        reflect(p->mirror, e);
    }
}

/* xx, yy, zz, xy, yz, xz: the products with the mirrored axis. */
void se3di_flip_inertia(const se3di_placement *p, double inertia[6])
{
    static const int first[3] = {0, 1, 0};
    static const int second[3] = {1, 2, 2};
    for (int k = 0; k < 3; ++k) {
        if (p->mirror >= 0 && (first[k] == p->mirror) != (second[k] == p->mirror)) {
            inertia[3 + k] = 0.0 - inertia[3 + k];
        }
    }
}
