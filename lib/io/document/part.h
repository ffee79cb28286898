/* SPDX-License-Identifier: BSD-3-Clause */
/* A file, or a part of one, that a model is made of: its names, and where it is put. */
#ifndef SE3D_IO_PART_H
#define SE3D_IO_PART_H

#include "io/document/document.h"
#include "io/document/scope.h"

/* x -> M x + r; M is a rotation or, if it mirrors, one with a reflection. Bodies that are mirrored
 * have the frames of the given ones, mirrored, with one axis turned round: A -> M A D, where D
 * turns round the axis `mirror`. So all that is said in such a frame changes by D. */
typedef struct se3di_placement {
    bool moves, turns; /* r is not 0, M is not 1 */
    int mirror;        /* 0, 1, 2: x, y, z; -1: it does not */
    double M[9];
    double r[3];
} se3di_placement;

typedef struct se3di_component {
    const se3di_node *root;
    const char *file;
    const char *prefix;                   /* of its names, with those of its callers */
    const struct se3di_component *parent; /* that it is included in; NULL: the model */
    const se3di_node *caller;             /* the entry of `include` or `instances` */
    se3di_scope *scope;
    size_t depth;
    se3di_placement place;
    struct se3di_component *next;
} se3di_component;

se3di_placement se3di_placement_none(void);
/* First `inner`, then `outer`. */
se3di_placement se3di_placement_join(const se3di_placement *outer, const se3di_placement *inner);
/* Whether it, or one that it is in, mirrors: also twice, which leaves the part as it is, but not in
 * the frames of the bodies between. */
bool se3di_component_is_mirrored(const se3di_component *part);
/* Whether left is right in it: mirrored an odd number of times. */
bool se3di_placement_is_reflected(const se3di_placement *p);

/* What is said in the ground frame of the part: points, directions, and what turns (angular
 * velocities, torques, axes by which angles count). Zeros stay 0, not -0. */
void se3di_place_point(const se3di_placement *p, double v[3]);
void se3di_place_vector(const se3di_placement *p, double v[3]);
void se3di_place_axial(const se3di_placement *p, double v[3]);
void se3di_place_orientation(const se3di_placement *p, double e[4]);

/* What is said in the frame of a body of the part. */
void se3di_flip_vector(const se3di_placement *p, double v[3]);
void se3di_flip_axial(const se3di_placement *p, double v[3]);
void se3di_flip_orientation(const se3di_placement *p, double e[4]);
void se3di_flip_inertia(const se3di_placement *p, double inertia[6]);

#endif
