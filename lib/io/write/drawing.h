/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model looks like: the parts of every body, in its frame. Scenes and VTK files show them.
 */
#ifndef SE3D_IO_DRAWING_H
#define SE3D_IO_DRAWING_H

#include "io/model/model.h"
#include "io/write/unit_mesh.h"

/* How a road goes up and down as a whole: from its heights at three places. */
typedef struct se3di_rise {
    se3d_function height; /* over (t, x, y) */
    double places[3][2];
    double first[3]; /* heights; NaN: it has none there */
    double tolerance;
    size_t index; /* of the roads with such heights, in the order of the model */
} se3di_rise;

/* A mesh, stretched, turned and moved. */
typedef struct se3di_part {
    const char *name;
    se3di_unit_shape unit;
    const se3di_mesh *mesh; /* in place of the unit; NULL: none */
    double position[3];     /* body frame */
    double orientation[4];  /* Euler parameters, to the body frame */
    double scale[3];
    double color[4]; /* red, green, blue, of light (linear); opacity: 0 to 1 */
    int32_t style;   /* se3di_style */
    int32_t reserved;
    size_t element1; /* the element that it shows, from 1 in the order of the model; 0: none */
    double along[3];
    const double *lift;     /* [samples] how far it has moved along this at each [m]; NULL: not */
    const se3di_rise *rise; /* how far at any time; NULL: never */
} se3di_part;

typedef struct se3di_parts {
    se3di_part *list;
    size_t count, capacity;
} se3di_parts;

/* Poses of all bodies at some times: values[sample][body][7], r and p. */
typedef struct se3di_poses {
    double *values;
    size_t bodies;
    size_t count;        /* of samples */
    const double *times; /* of them; NULL: the time of the system */
} se3di_poses;

/* How large what is seen is, and how large things without a size of their own are drawn [m]. */
typedef struct se3di_sizes {
    double extent; /* half of its diagonal, > 0 */
    double radius; /* of a pin */
    double floor;  /* height where a floor belongs */
} se3di_sizes;

enum { SE3DI_POSE = 7 };

/* Get the present poses of all bodies: one sample, to `pose`. */
se3d_status se3di_drawing_get_poses(const se3d_model *model, double *pose);
void se3di_drawing_measure(const se3d_model *model, const se3di_poses *poses, se3di_sizes *sizes);
/* The parts of body `k`: its shapes and joints, and bars to what lies beside its shapes. `poses`
 * tell how far its joints move. @return false: out of memory. */
bool se3di_drawing_list(const se3d_model *model, size_t k, const se3di_sizes *sizes,
                        const se3di_poses *poses, se3di_iopool *pool, se3di_parts *parts);
/* Parts that an element has between two bodies: springs, dampers and rods. */
size_t se3di_drawing_count_between(const se3di_element_entry *entry);
/* One of them at the given poses of all bodies, in the ground frame. */
se3di_part se3di_drawing_get_between(const se3d_model *model, size_t element, size_t which,
                                     const se3di_sizes *sizes, const double *poses);
/* Roads whose heights are functions. */
size_t se3di_drawing_count_rises(const se3d_model *model);
/* What they rise by from the first of `poses` on, one after the other, to rises[count]; those that
 * are not drawn stand still. */
void se3di_drawing_list_rises(const se3d_model *model, const se3di_sizes *sizes,
                              const se3di_poses *poses, se3di_rise *rises);
/* How far such a road has risen [m]; 0 if it changes its form. */
double se3di_rise_get(const se3d_model *model, const se3di_rise *rise, double time);
/* origin + A local; ground may be local */
void se3di_drawing_turn(const double origin[3], const double A[9], const double local[3],
                        double ground[3]);
/* A point of a body in the ground frame. */
void se3di_drawing_to_ground(const double pose[SE3DI_POSE], const double local[3],
                             double ground[3]);

#endif
