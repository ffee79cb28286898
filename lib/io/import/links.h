/* SPDX-License-Identifier: BSD-3-Clause */
/* Links and joints as robots' formats have them: links have their own frames, masses anywhere, or
 * none. What they become: bodies at the centres of mass, in which links without mass are merged. */
#ifndef SE3D_IO_IMPORT_LINKS_H
#define SE3D_IO_IMPORT_LINKS_H

#include "io/import/machine.h"
#include "io/import/xml.h"

typedef enum se3di_link_joint_type {
    SE3DI_LINK_FIXED,
    SE3DI_LINK_REVOLUTE,
    SE3DI_LINK_PRISMATIC,
    SE3DI_LINK_CYLINDRICAL,
    SE3DI_LINK_SPHERICAL,
    SE3DI_LINK_UNIVERSAL,
    SE3DI_LINK_PLANAR,
    SE3DI_LINK_SCREW,
    SE3DI_LINK_FREE
} se3di_link_joint_type;

typedef struct se3di_link {
    const char *name; /* NULL: one is made up */
    const char *comment;
    size_t line;
    bool anchored;             /* does not move */
    bool between;              /* two joints of one body: has no mass by intent */
    bool is_ground;            /* is the ground itself */
    se3di_frame frame;         /* in the ground */
    se3di_mass mass;           /* in the link */
    double v[3], w[3];         /* of its origin, ground frame */
    se3di_machine_parts parts; /* frames in the link */
    size_t group;              /* the link that it is merged into; its own index: none */
    size_t body; /* index in the machine, when they are made; SE3DI_GROUND for the ground */
} se3di_link;

typedef struct se3di_link_joint {
    const char *name;
    const char *comment;
    size_t line;
    se3di_link_joint_type type;
    size_t parent, child;         /* indices of links */
    se3di_frame frame_i, frame_j; /* in the ground: z is the axis; moves with parent, with child */
    double pitch;                 /* screw: advance per turn */
    double angle0;                /* revolute: is added to the angle between the frames */
    bool has_lower, has_upper;
    double lower, upper;
    double damping, friction, stiffness, rest; /* spring: -stiffness (q - rest) */
    double armature;
    const char *made; /* its name in the machine; NULL: it became none */
} se3di_link_joint;

typedef struct se3di_links {
    se3di_machine *m;
    se3di_link *list;
    size_t count, room;
    se3di_link_joint *joints;
    size_t joint_count, joint_room;
} se3di_links;

/* Each returns NULL if there is no memory; valid until the next is added. */
se3di_link *se3di_links_add(se3di_links *links, const char *name, size_t line);
/* Add a shape to a link. */
bool se3di_links_add_shape(se3di_links *links, size_t link, const se3di_machine_shape *shape);
/* Read what a format says of a geometry: *good if it is a shape that we have. */
typedef bool se3di_read_geometry(se3di_machine *m, const se3di_xml *node,
                                 se3di_machine_shape *shape, bool *good);
/* Add what is in a geometry (NULL: nothing) to a link. `shape`: what is known of it. */
bool se3di_links_read_shape(se3di_links *links, size_t link, const se3di_xml *geometry,
                            se3di_read_geometry *read, se3di_machine_shape *shape);
se3di_link_joint *se3di_links_join(se3di_links *links, const char *name, size_t line);
/* Make bodies, joints, stops, dampers and friction of all. */
bool se3di_links_emit(se3di_links *links);

#endif
