/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of mjcf*.c share. */
#ifndef SE3D_IO_IMPORT_MJCF_H
#define SE3D_IO_IMPORT_MJCF_H

#include "io/import/links.h"
#include "io/import/xml.h"

/* A class of defaults: its element <default>, and the class it is in. */
typedef struct se3di_mjcf_class {
    const char *name;
    const se3di_xml *node;
    const struct se3di_mjcf_class *outer;
    struct se3di_mjcf_class *next;
} se3di_mjcf_class;

typedef struct se3di_mjcf_place {
    const char *name;
    size_t link;
    se3di_frame frame; /* in the link */
} se3di_mjcf_place;

/* contype and conaffinity of geoms: two touch if the one of either has a bit of the other's. */
typedef struct se3di_mjcf_touch {
    uint32_t type, affinity;
} se3di_mjcf_touch;

/* What <flag> of <option> disables. */
typedef struct se3di_mjcf_disabled {
    bool gravity, contact, limits, friction, equality, springs, dampers;
} se3di_mjcf_disabled;

enum { SE3DI_MJCF_KINDS_MAX = 32 }; /* different ones, a bit of a model file for each */

typedef struct se3di_mjcf {
    se3di_links links;
    const se3di_xml *root;
    se3di_mjcf_class *classes, *last_class;
    double angle; /* what an angle of the file is in radians */
    char eulerseq[4];
    bool inertia_from_geoms;
    double total_mass; /* > 0: masses are scaled to it */
    bool autolimits;
    se3di_mjcf_disabled disabled;
    const char *mesh_folder;
    se3di_ionames body_names;  /* -> link */
    se3di_ionames site_names;  /* -> sites */
    se3di_ionames joint_names; /* -> joint of the links */
    se3di_mjcf_place *sites;
    size_t site_count, site_room;
    size_t touching; /* links whose geoms may touch */
    se3di_mjcf_touch kinds[SE3DI_MJCF_KINDS_MAX];
    size_t kind_count;
    bool has_more_kinds; /* than that; the others touch as anything */
} se3di_mjcf;

/* An element with the class that its defaults come from. */
typedef struct se3di_mjcf_element {
    const se3di_xml *node;
    const char *class_name; /* of the body around it; NULL: main */
} se3di_mjcf_element;

/* An attribute of the element, of its class, or of an outer one; NULL. */
const char *se3di_mjcf_get(const se3di_mjcf *f, const se3di_mjcf_element *e, const char *name);
/* Read up to `room` numbers; *count says how many there were, 0: the attribute is not there. */
bool se3di_mjcf_numbers(se3di_mjcf *f, const se3di_mjcf_element *e, const char *name,
                        double *values, int room, int *count);
bool se3di_mjcf_number(se3di_mjcf *f, const se3di_mjcf_element *e, const char *name, double *value);
bool se3di_mjcf_is(const se3di_mjcf *f, const se3di_mjcf_element *e, const char *name,
                   const char *value);
/* pos, quat, axisangle, xyaxes, zaxis, euler. */
bool se3di_mjcf_frame(se3di_mjcf *f, const se3di_mjcf_element *e, se3di_frame *frame);

/* mjcf_body.c: all that is in <worldbody>. */
bool se3di_mjcf_bodies(se3di_mjcf *f, const se3di_xml *world);
/* Place a name, unless it is empty or taken: then nothing can refer to it. */
bool se3di_mjcf_name(se3di_mjcf *f, se3di_ionames *names, const char *name, size_t index);
/* The value of an element's own attribute as an index of `names`; *found. */
bool se3di_mjcf_find(se3di_mjcf *f, const se3di_xml *node, const char *attribute,
                     const se3di_ionames *names, size_t *index, bool *found);
/* mjcf_geom.c: a geom as a shape, and its mass if the link has none of its own. */
bool se3di_mjcf_geom(se3di_mjcf *f, size_t link, const se3di_mjcf_element *e,
                     const se3di_frame *around, bool weighs);
/* mjcf_acts.c: equality as joints of links; couplers, tendons and actuators once those are made. */
bool se3di_mjcf_close(se3di_mjcf *f);
bool se3di_mjcf_acts(se3di_mjcf *f);

/* mjcf_geom.c: groups and masks of all shapes, from what their geoms may touch. */
void se3di_mjcf_sort_shapes(se3di_mjcf *f);

#endif
