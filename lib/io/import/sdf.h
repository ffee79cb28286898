/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of sdf*.c share. */
#ifndef SE3D_IO_IMPORT_SDF_H
#define SE3D_IO_IMPORT_SDF_H

#include "io/import/links.h"
#include "io/import/xml.h"

typedef enum se3di_sdf_kind { SE3DI_SDF_FRAME, SE3DI_SDF_LINK, SE3DI_SDF_JOINT } se3di_sdf_kind;

/* Something with a pose: a frame, a link or a joint of a model. */
typedef struct se3di_sdf_place {
    const char *name;
    const se3di_xml *node;
    se3di_sdf_kind kind;
    size_t link;       /* its index, or that of what it is attached to where that is known */
    bool is_attached;  /* that is known */
    int32_t state;     /* 0: not resolved, 1: being resolved, 2: done */
    se3di_frame frame; /* in the model */
} se3di_sdf_place;

/* A model of the file. */
typedef struct se3di_sdf_model {
    se3di_links *links;
    const se3di_xml *node;
    const char *prefix; /* of the names of its links and joints, "" if it is the only one */
    bool is_old;        /* the file is of a version before 1.5 */
    size_t world;       /* the link that is the ground */
    se3di_frame frame;  /* in the ground */
    se3di_sdf_place *places;
    size_t count, room;
    se3di_ionames names; /* to places */
    size_t canonical;    /* the link that the model's frame is attached to */
    size_t first_link, first_joint;
} se3di_sdf_model;

/* The pose that an element says, in what it is relative to; a pose of another kind is refused. */
bool se3di_sdf_pose(se3di_machine *m, const se3di_xml *node, se3di_frame *frame);
/* The characters of a child element, without blanks at the ends; NULL: it is not there. */
const char *se3di_sdf_text(se3di_machine *m, const se3di_xml *node, const char *child);
/* A number that a child element holds, left alone without it; "inf" and "-inf" are +-1e16. */
bool se3di_sdf_number(se3di_machine *m, const se3di_xml *node, const char *child, double *value);
bool se3di_sdf_flag(const se3di_xml *node, const char *child, bool standard);

/* Add a place of the model. @return NULL: the machine has failed. */
se3di_sdf_place *se3di_sdf_add_place(se3di_sdf_model *s, const se3di_xml *node,
                                     se3di_sdf_kind kind);
/* The frame of a name in the model: "" and "__model__" are its own. */
bool se3di_sdf_find_frame(se3di_sdf_model *s, const se3di_xml *node, const char *name,
                          se3di_frame *frame);
/* Find all frames of the model. */
bool se3di_sdf_resolve(se3di_sdf_model *s);
/* The link that a name is attached to, of a joint's parent or child. */
bool se3di_sdf_find_link(se3di_sdf_model *s, const se3di_xml *node, const char *name, size_t *link);

/* Mass of a link, and what it looks like. */
bool se3di_sdf_inertial(se3di_machine *m, const se3di_xml *node, se3di_mass *mass);
bool se3di_sdf_shapes(se3di_links *links, size_t link, const se3di_xml *node);
/* The joints of a model whose frames are known. */
bool se3di_sdf_joints(se3di_sdf_model *s);
bool se3di_sdf_mimics(se3di_sdf_model *s);

#endif
