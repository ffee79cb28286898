/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of urdf*.c share. */
#ifndef SE3D_IO_IMPORT_URDF_H
#define SE3D_IO_IMPORT_URDF_H

#include "io/import/links.h"
#include "io/import/xml.h"

/* q = ratio * q of `joint` + offset. */
typedef struct se3di_urdf_mimic {
    size_t joint; /* SE3DI_GROUND: none */
    double ratio, offset;
} se3di_urdf_mimic;

/* The <origin> of an element. */
bool se3di_urdf_origin(se3di_machine *m, const se3di_xml *node, se3di_frame *frame);
/* What a link looks like: its <visual>s, or without any its <collision>s. */
bool se3di_urdf_shapes(se3di_links *links, size_t link, const se3di_xml *root,
                       const se3di_xml *node);
/* Limits, damping and friction of a joint. */
bool se3di_urdf_dynamics(se3di_machine *m, const se3di_xml *node, se3di_link_joint *joint);
/* The coupler of a joint that mimics another. */
bool se3di_urdf_couple(se3di_machine *m, const se3di_link_joint *joint,
                       const se3di_link_joint *other, const se3di_urdf_mimic *mimic);
/* Elements beside links and joints: what they are is noted; xacro is refused. */
bool se3di_urdf_others(se3di_machine *m, const se3di_xml *root);

#endif
