/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files that list parts share. */
#ifndef SE3D_IO_DRAWING_PART_H
#define SE3D_IO_DRAWING_PART_H

#include "io/write/drawing.h"

/* The parts of one body, while they are listed. */
typedef struct se3di_lister {
    const se3d_model *model;
    se3di_iopool *pool;
    se3di_parts *parts;
    const se3di_sizes *sizes;
    const se3di_poses *poses;
    size_t body;
    double usual[3]; /* colour of the body */
    bool failed;     /* out of memory */
    bool unmarked;   /* links leave markers out */
} se3di_lister;

/* What a joint looks like. */
typedef enum se3di_joint_look {
    SE3DI_JOINT_NONE = 0, /* it has no point */
    SE3DI_JOINT_BLOCK = 1,
    SE3DI_JOINT_PIN = 2,
    SE3DI_JOINT_SLIDER = 3,
    SE3DI_JOINT_SLEEVE = 4,
    SE3DI_JOINT_SCREW = 5,
    SE3DI_JOINT_BALL = 6,
    SE3DI_JOINT_CROSS = 7,
    SE3DI_JOINT_PLATE = 8,    /* and a disc on it */
    SE3DI_JOINT_ON_LINE = 9,  /* a ball on a rail */
    SE3DI_JOINT_ON_PLANE = 10 /* a ball on a plate */
} se3di_joint_look;

/* The index of a body's entry. */
size_t se3di_drawing_find_body(const se3d_model *model, se3d_body body);
/* Whether `body` is that of entry `k`. */
bool se3di_drawing_is_body(const se3d_model *model, size_t k, se3d_body body);
se3di_part se3di_part_make(const char *name, se3di_unit_shape unit, const double color[3]);
void se3di_part_stretch(se3di_part *part, double a, double b, double c);
/* A turn from z to `v`. @return |v|. */
double se3di_part_turn(const double v[3], double p[4]);
/* Turn and stretch a part along z from `a` to `b`. */
void se3di_part_span(se3di_part *part, const double a[3], const double b[3], double radius);
void se3di_lister_add(se3di_lister *l, const se3di_part *part);
/* The point of a shape nearest to `at`, pulled a little inside, both in the body's frame.
 * @return its distance; infinity if the shape has no ends. */
double se3di_shape_reach(const se3di_shape_entry *entry, const double at[3], double near[3]);

/* How a joint or constraint is drawn: by its type. */
se3di_joint_look se3di_joint_get_look(const se3di_element_entry *entry);
/* A given shape of l->body. */
void se3di_lister_add_shape(se3di_lister *l, const se3di_shape_entry *entry);
/* What body l->body has of its joints. */
void se3di_lister_add_joints(se3di_lister *l);
/* The roads on l->body, as far as wheels come over them. */
void se3di_lister_add_roads(se3di_lister *l);
/* Discs with teeth on the body for its gears, and a rack. */
void se3di_lister_add_gears(se3di_lister *l);
/* Bars between the joints and markers of a body without shapes; `bare` false: from joints beside
 * the shapes of the body to these. */
void se3di_lister_add_links(se3di_lister *l, bool bare);

#endif
