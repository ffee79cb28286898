/* SPDX-License-Identifier: BSD-3-Clause */
/* Binary glTF 2.0: growing parts of a file, the accessors and the unit meshes in it. */
#ifndef SE3D_IO_GLB_H
#define SE3D_IO_GLB_H

#include <stdio.h>

#include "io/base/pool.h"
#include "io/write/drawing.h"

typedef enum se3di_glb_type {
    SE3DI_GLB_SCALAR = 1,
    SE3DI_GLB_VEC3 = 3,
    SE3DI_GLB_VEC4 = 4
} se3di_glb_type;

typedef struct se3di_glb {
    se3di_iopool *pool;
    se3di_iobytes binary;
    se3di_iobytes views;
    se3di_iobytes accessors;
    se3di_iobytes meshes;
    se3di_iobytes materials;
    size_t accessor_count;
    size_t mesh_count;
    /* accessors of the unit meshes: positions, normals, indices; -1: not made yet or none */
    long unit[SE3DI_UNIT_COUNT][3];
    struct se3di_glb_surface {
        const se3di_mesh *mesh;
        long accessors[3]; /* as of a unit mesh */
    } * surfaces;
    size_t surface_count, surface_capacity;
    struct se3di_glb_look {
        long surface; /* accessor of its positions */
        double color[4];
        int32_t style, reserved;
    } * looks; /* of the meshes, in their order */
    size_t look_capacity;
    bool failed; /* out of memory */
} se3di_glb;

void se3di_glb_init(se3di_glb *glb, se3di_iopool *pool);
/* Append formatted text. */
void se3di_glb_put(se3di_glb *glb, se3di_iobytes *bytes, const char *format, ...)
    SE3DI_IO_FORMAT(3, 4);
void se3di_glb_put_bytes(se3di_glb *glb, se3di_iobytes *bytes, const void *data, size_t size);
/* Append a text as a JSON string. */
void se3di_glb_put_text(se3di_glb *glb, se3di_iobytes *bytes, const char *text);
/* Append a number with a point in every locale. */
void se3di_glb_put_number(se3di_glb *glb, se3di_iobytes *bytes, double value);

/* Add values as floats; `target` is the buffer's use: 34962 vertices, 0 other. @return accessor. */
long se3di_glb_add_floats(se3di_glb *glb, const double *values, size_t count, se3di_glb_type type,
                          int target);
/* Add unit quaternions (x, y, z, w) as normalised 16-bit integers. */
long se3di_glb_add_rotations(se3di_glb *glb, const double *values, size_t count);
/* Add a part's mesh in its colour. @return its index. */
size_t se3di_glb_add_mesh(se3di_glb *glb, const se3di_part *part);

/* Write all to a file that is open: `rest` is the JSON besides buffers, meshes and materials,
 * beginning with a comma. @return false: errno says why, unless the file does (ferror). */
bool se3di_glb_write(se3di_glb *glb, const se3di_iobytes *rest, FILE *file);

#endif
