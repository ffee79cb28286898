/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model looks like: the parts of every body, in its frame. Scenes and VTK files show them.
 */
#ifndef SE3D_IO_DRAWING_H
#define SE3D_IO_DRAWING_H

#include "io/model/model.h"
#include "io/write/unit_mesh.h"

/* A mesh, stretched, turned and moved. */
typedef struct se3di_part {
    const char *name;
    se3di_unit unit;
    const se3di_mesh *mesh; /* in place of the unit; NULL: none */
    double position[3];     /* body frame */
    double orientation[4];  /* Euler parameters, to the body frame */
    double scale[3];
    double color[4]; /* red, green, blue, opacity: 0 to 1 */
} se3di_part;

typedef struct se3di_parts {
    se3di_part *list;
    size_t count, capacity;
} se3di_parts;

/* Poses of all bodies at some times: values[sample][body][7], r and p. */
typedef struct se3di_poses {
    double *values;
    size_t bodies;
    size_t count; /* of samples */
} se3di_poses;

enum { SE3DI_POSE = 7 };

/* Get the present poses of all bodies: one sample, to `pose`. */
se3d_status se3di_drawing_get_poses(const se3d_model *model, double *pose);
/* Half the size of what is seen, > 0, and where a floor belongs. */
double se3di_drawing_measure(const se3d_model *model, const se3di_poses *poses, double *floor);
/* The parts of body `k`: its shapes and joints; bars to its joints if it has no shapes.
 * @return false: out of memory. */
bool se3di_drawing_list(const se3d_model *model, size_t k, double extent, se3di_iopool *pool,
                        se3di_parts *parts);
/* A spring at the given poses of all bodies, in the ground frame. */
se3di_part se3di_drawing_get_spring(const se3d_model *model, const se3di_element_entry *spring,
                                    double extent, const double *poses);
/* A point of a body in the ground frame. */
void se3di_drawing_to_ground(const double pose[SE3DI_POSE], const double local[3],
                             double ground[3]);

#endif
